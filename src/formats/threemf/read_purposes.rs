//! What parts are for, as Bambu Studio and its kin note it beside the model.

use super::model_reader::number;
use super::package::Package;
use super::read_volumes::VolumePurpose;
use super::xml::{Document, Scanner, XmlEvent, value};
use crate::budget::Budget;
use crate::formats::{ReadError, ReadErrorKind};
use rustc_hash::FxHashMap;

/// The part that notes it.
const SETTINGS: &str = "/Metadata/model_settings.config";

/// By the ids of the object of a build item and of a component of it: what the component is for.
pub(super) type Purposes = FxHashMap<[u32; 2], VolumePurpose>;

/// The purposes of components, as far as they are no material. A part that cannot be read, which is none of the model, says nothing
/// of them, and `remarks` tell that.
///
/// # Errors
/// A part that is too large; the budget stops the run.
pub(super) fn read_purposes(
    package: &mut Package<'_>,
    remarks: &mut Vec<String>,
    budget: &Budget,
) -> Result<Purposes, ReadError> {
    let Some(entry) = package.find(SETTINGS) else { return Ok(Purposes::default()) };
    let (bytes, _charge) = package.inflate(entry, budget)?;
    match purposes_in(&bytes, budget) {
        Err(ReadError { kind: ReadErrorKind::Unparseable { .. }, .. }) => {
            remarks.push(format!("{SETTINGS} cannot be read: every part is taken as material."));
            Ok(Purposes::default())
        }
        read => read,
    }
}

fn purposes_in(bytes: &[u8], budget: &Budget) -> Result<Purposes, ReadError> {
    let document = Document::of(SETTINGS, bytes)?;
    let mut scanner = Scanner::new(&document, budget);
    let (mut purposes, mut object) = (Purposes::default(), None);
    loop {
        match scanner.next()? {
            XmlEvent::Open(element) if element.local == "object" => {
                object = value(&scanner.attributes(&element)?, "id").and_then(number);
            }
            XmlEvent::Open(element) if element.local == "part" => {
                let attributes = scanner.attributes(&element)?;
                let part = value(&attributes, "id").and_then(number);
                let purpose =
                    value(&attributes, "subtype").map_or(VolumePurpose::Material, VolumePurpose::of_word);
                if let (Some(object), Some(part), true) = (object, part, purpose != VolumePurpose::Material) {
                    purposes.insert([object, part], purpose);
                }
            }
            XmlEvent::Open(_) | XmlEvent::Close => {}
            XmlEvent::End => return Ok(purposes),
        }
    }
}
