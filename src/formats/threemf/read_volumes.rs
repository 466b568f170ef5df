//! The volumes of objects, which PrusaSlicer and its kin note as ranges of triangles beside the model.

use super::model_reader::number;
use super::package::Package;
use super::xml::{Document, Scanner, XmlElement, XmlEvent, value};
use crate::budget::Budget;
use crate::formats::ReadError;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// The part that notes them.
pub(super) const VOLUMES: &str = "/Metadata/Slic3r_PE_model.config";

/// What a part of an object is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum VolumePurpose {
    /// It is printed.
    Material,
    /// It is taken away from what is printed.
    Negative,
    /// Where it is, others are printed with other settings.
    Modifier,
    /// Where it is, supports are printed or not.
    Support,
}

impl VolumePurpose {
    /// By its word in the files of PrusaSlicer, or of Bambu Studio and OrcaSlicer.
    pub(super) fn of_word(word: &str) -> Self {
        match word {
            "NegativeVolume" | "negative_part" => Self::Negative,
            "ParameterModifier" | "modifier_part" => Self::Modifier,
            "SupportBlocker" | "SupportEnforcer" | "support_blocker" | "support_enforcer" => Self::Support,
            _ => Self::Material,
        }
    }

    /// Under which name those are counted that one mesh leaves out; `None`: it does not.
    pub(super) fn left_out_as(self) -> Option<&'static str> {
        match self {
            Self::Material => None,
            Self::Negative => Some("negative_parts"),
            Self::Modifier => Some("modifier_parts"),
            Self::Support => Some("support_parts"),
        }
    }
}

/// A range of triangles of an object of the first model.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ObjectVolume {
    /// Id of the object.
    pub(super) object: u32,
    /// Its triangles.
    pub(super) triangles: Range<u32>,
    /// Its name; empty when it has none.
    pub(super) name: String,
    /// What it is for.
    pub(super) purpose: VolumePurpose,
    /// Bytes of its start tag in the text of the part.
    pub(super) tag: Range<usize>,
}

/// The volumes that `package` notes, in the order of the part; none when it is no such project.
///
/// # Errors
/// A part that is no XML.
pub(super) fn read_volumes(
    package: &mut Package<'_>,
    budget: &Budget,
) -> Result<Vec<ObjectVolume>, ReadError> {
    let Some(entry) = package.find(VOLUMES) else { return Ok(Vec::new()) };
    let (bytes, _charge) = package.inflate(entry, budget)?;
    let document = Document::of(VOLUMES, &bytes)?;
    let mut scanner = Scanner::new(&document, budget);
    let mut volumes: Vec<ObjectVolume> = Vec::new();
    // The object and the volume that are open, by their depths.
    let (mut object, mut is_in_volume) = (None, false);
    loop {
        match scanner.next()? {
            XmlEvent::Open(element) => match element.local {
                "object" => object = value(&scanner.attributes(&element)?, "id").and_then(number),
                "volume" => {
                    let tag = element.at..scanner.position();
                    let volume = object.map(|object| volume(&scanner, &element, object, tag)).transpose()?;
                    is_in_volume = !element.is_empty && volume.as_ref().is_some_and(Option::is_some);
                    volumes.extend(volume.flatten());
                }
                "metadata" if is_in_volume => {
                    let attributes = scanner.attributes(&element)?;
                    let noted = (value(&attributes, "key"), value(&attributes, "value"));
                    if let (Some(volume), (Some(key), Some(value))) = (volumes.last_mut(), noted) {
                        match (key, value) {
                            ("name", name) => volume.name = name.to_owned(),
                            ("volume_type", word) => volume.purpose = VolumePurpose::of_word(word),
                            // As older programs note it.
                            ("modifier", "1") => volume.purpose = VolumePurpose::Modifier,
                            _ => {}
                        }
                    }
                }
                _ => {}
            },
            // `config` is at depth 1, objects at 2, volumes at 3.
            XmlEvent::Close => is_in_volume &= scanner.depth >= 3,
            XmlEvent::End => return Ok(volumes),
        }
    }
}

fn volume(
    scanner: &Scanner<'_>,
    element: &XmlElement<'_>,
    object: u32,
    tag: Range<usize>,
) -> Result<Option<ObjectVolume>, ReadError> {
    let attributes = scanner.attributes(element)?;
    let of = |name| value(&attributes, name).and_then(number);
    let (Some(first), Some(last)) = (of("firstid"), of("lastid")) else { return Ok(None) };
    let triangles = first..last.saturating_add(1);
    Ok(Some(ObjectVolume { object, triangles, name: String::new(), purpose: VolumePurpose::Material, tag }))
}

/// The volumes of each object, in their order.
pub(super) fn by_object(volumes: &[ObjectVolume]) -> FxHashMap<u32, Vec<&ObjectVolume>> {
    let mut by_object: FxHashMap<u32, Vec<&ObjectVolume>> = FxHashMap::default();
    for volume in volumes {
        by_object.entry(volume.object).or_default().push(volume);
    }
    by_object
}

/// True when `volumes`, in their order, are all of `count` triangles.
pub(super) fn are_all(volumes: &[&ObjectVolume], count: u32) -> bool {
    let mut next = 0;
    let goes_on = |volume: &&ObjectVolume| {
        let follows = volume.triangles.start == next && volume.triangles.end > next;
        next = volume.triangles.end;
        follows
    };
    volumes.iter().all(goes_on) && volumes.last().is_some_and(|last| last.triangles.end == count)
}
