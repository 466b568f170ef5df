//! What parts are for, as Bambu Studio and its kin note it beside the model.

use super::model_reader::number;
use super::package::Package;
use super::read_volumes::Purpose;
use super::xml::{Document, Node, Scanner, value};
use crate::budget::Budget;
use crate::formats::ReadError;
use rustc_hash::FxHashMap;

/// The part that notes it.
const SETTINGS: &str = "/Metadata/model_settings.config";

/// The purposes of components by the ids of their object in the build and of their own object, as far as they are no material.
///
/// # Errors
/// A part that is no XML.
pub(super) fn read_purposes(
    package: &mut Package<'_>,
    budget: &Budget,
) -> Result<FxHashMap<[u32; 2], Purpose>, ReadError> {
    let mut purposes = FxHashMap::default();
    let Some(entry) = package.find(SETTINGS) else { return Ok(purposes) };
    let (bytes, _charge) = package.inflate(entry, budget)?;
    let document = Document::of(SETTINGS, &bytes)?;
    let mut scanner = Scanner::new(&document, budget);
    let mut object = None;
    loop {
        match scanner.next()? {
            Node::Open(element) if element.local == "object" => {
                object = value(&scanner.attributes(&element)?, "id").and_then(number);
            }
            Node::Open(element) if element.local == "part" => {
                let attributes = scanner.attributes(&element)?;
                let part = value(&attributes, "id").and_then(number);
                let purpose = value(&attributes, "subtype").map_or(Purpose::Material, Purpose::of_word);
                if let (Some(object), Some(part), true) = (object, part, purpose != Purpose::Material) {
                    purposes.insert([object, part], purpose);
                }
            }
            Node::Open(_) | Node::Close => {}
            Node::End => return Ok(purposes),
        }
    }
}
