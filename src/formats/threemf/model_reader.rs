//! What the readers of a model part share: the scanner, the model so far, errors and remarks with their place.

use super::model::{Groups, ModelDocument, NO_NUMBER};
use super::xml::{Document, Scanner, XmlElement, XmlEvent};
use crate::budget::Budget;
use crate::formats::{ReadError, ReadOptions};
use crate::mesh::Units;
use rustc_hash::{FxHashMap, FxHashSet};

/// Most remarks on one part; more are only counted.
const REMARKS_MAX: usize = 20;

/// A model part that is being read.
pub(super) struct ModelReader<'x> {
    pub(super) scanner: Scanner<'x>,
    pub(super) model: ModelDocument,
    /// Ids of resources that are neither objects nor groups.
    pub(super) other_ids: FxHashSet<u32>,
    /// Names of metadata so far.
    pub(super) metadata: Vec<String>,
    more_remarks: usize,
    pub(super) options: &'x ReadOptions,
    pub(super) budget: &'x Budget,
}

impl<'x> ModelReader<'x> {
    pub(super) fn new(document: &'x Document<'x>, options: &'x ReadOptions, budget: &'x Budget) -> Self {
        let model = ModelDocument {
            part: document.part.to_owned(),
            units: Units::Millimetre,
            objects: Vec::new(),
            numbers: FxHashMap::default(),
            groups: Groups::default(),
            items: Vec::new(),
            remarks: Vec::new(),
        };
        Self {
            scanner: Scanner::new(document, budget),
            model,
            other_ids: FxHashSet::default(),
            metadata: Vec::new(),
            more_remarks: 0,
            options,
            budget,
        }
    }

    pub(super) fn into_model(self) -> ModelDocument {
        let (mut model, more) = (self.model, self.more_remarks);
        if more > 0 {
            model.remarks.push(format!("{more} more breaches of rules in {}.", model.part));
        }
        model
    }

    /// The next element at `depth`, whose parent is open; `None` at the end of the parent.
    pub(super) fn next_child(&mut self, depth: usize) -> Result<Option<XmlElement<'x>>, ReadError> {
        loop {
            match self.scanner.next()? {
                XmlEvent::Open(element) => return Ok(Some(element)),
                XmlEvent::Close if self.scanner.depth < depth => return Ok(None),
                XmlEvent::Close => {}
                XmlEvent::End => return Ok(None),
            }
        }
    }

    /// True when the group is one of base materials.
    pub(super) fn is_material(&self, group: u32) -> bool {
        self.model.groups.is_material(group)
    }

    /// Notes that the part uses an extension whose content is not judged, and where it is `kept`.
    pub(super) fn note_extension(&mut self, what: &str, kept: &str) {
        let text = format!("{} holds {what}: kept {kept}, and not judged.", self.model.part);
        if !self.model.remarks.contains(&text) {
            self.model.remarks.push(text);
        }
    }

    /// Notes a rule of 3MF that is broken where that does no harm here.
    pub(super) fn remark(&mut self, at: usize, what: &str) {
        if self.model.remarks.len() >= REMARKS_MAX {
            self.more_remarks += 1;
            return;
        }
        let text = self.scanner.document.text.as_bytes();
        let line = memchr::memchr_iter(b'\n', text.get(..at).unwrap_or(text)).count() + 1;
        self.model
            .remarks
            .push(format!("The file breaks a rule of 3MF: {what} ({}, line {line}).", self.model.part));
    }

    pub(super) fn error(&self, at: usize, found: &str, expected: impl Into<String>) -> ReadError {
        self.scanner.document.error(at, found, expected)
    }
}

/// A whole number as XML writes it.
pub(super) fn number(text: &str) -> Option<u32> {
    let text = text.trim_ascii();
    let digits = text.strip_prefix('+').unwrap_or(text);
    let is_number = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
    digits.parse().ok().filter(|&number: &u32| is_number && number != NO_NUMBER)
}
