//! Property groups: materials, colours, places in pictures, mixtures and layers of them.

use super::model::Group;
use super::model_reader::{ModelReader, number};
use super::package::{resolve, shortened};
use super::xml::{Namespace, XmlElement, value};
use crate::formats::{Precision, ReadError, numbers};

/// A group whose members `<member …>` have a colour in the attribute `key`.
pub(super) fn colors<'x>(
    reader: &mut ModelReader<'x>,
    group: &XmlElement<'x>,
    member: &str,
    key: &str,
) -> Result<Group, ReadError> {
    let mut colors = Vec::new();
    each(reader, group, member, |reader, element| {
        let attributes = reader.scanner.attributes(element)?;
        let text = value(&attributes, key);
        let color = text.and_then(color);
        if color.is_none() && (text.is_some() || member == "color") {
            let found =
                text.map_or("no colour".to_owned(), |text| format!("the colour {:?}", shortened(text)));
            reader.remark(element.at, &format!("<{}> has {found}", element.name));
        }
        colors.push(color);
        Ok(())
    })?;
    Ok(Group::Colors(colors))
}

/// Places in a picture.
pub(super) fn places<'x>(reader: &mut ModelReader<'x>, group: &XmlElement<'x>) -> Result<Group, ReadError> {
    let attributes = reader.scanner.attributes(group)?;
    if value(&attributes, "texid").and_then(number).is_none() {
        reader.remark(group.at, &format!("<{}> names no texture", group.name));
    }
    let mut points = Vec::new();
    each(reader, group, "tex2coord", |reader, element| {
        let attributes = reader.scanner.attributes(element)?;
        let number = |key: &str| {
            let number =
                numbers::coordinate(value(&attributes, key)?.trim_ascii().as_bytes(), Precision::F64);
            number.filter(|number| number.is_finite())
        };
        points.push([number("u").unwrap_or(0.0), number("v").unwrap_or(0.0)]);
        Ok(())
    })?;
    Ok(Group::Places(points))
}

/// That a texture names a picture that may be one; whether it is there, the package knows.
pub(super) fn check_texture<'x>(
    reader: &mut ModelReader<'x>,
    texture: &XmlElement<'x>,
) -> Result<(), ReadError> {
    let attributes = reader.scanner.attributes(texture)?;
    match value(&attributes, "path") {
        None => reader.remark(texture.at, "a texture names no picture"),
        Some(path) if resolve(&reader.model.part, path).is_none() => {
            reader.remark(texture.at, &format!("a texture has the path {:?}", shortened(path)));
        }
        Some(_) => {}
    }
    let kind = value(&attributes, "contenttype").unwrap_or_default();
    if !matches!(kind, "image/png" | "image/jpeg") {
        reader.remark(texture.at, &format!("a texture has the content type {:?}", shortened(kind)));
    }
    Ok(())
}

/// Mixtures of base materials.
pub(super) fn mixtures<'x>(reader: &mut ModelReader<'x>, group: &XmlElement<'x>) -> Result<Group, ReadError> {
    let attributes = reader.scanner.attributes(group)?;
    let of = value(&attributes, "matid").and_then(number);
    let members = value(&attributes, "matindices").map(indices).unwrap_or_default();
    if of.is_none() || members.is_empty() {
        reader.remark(group.at, &format!("<{}> does not say which materials it mixes", group.name));
    }
    if let Some(of) = of {
        match reader.model.groups.get(of) {
            Some(Group::Colors(colors))
                if reader.is_material(of) && members.iter().all(|&m| (m as usize) < colors.len()) => {}
            Some(Group::Colors(_)) if !reader.is_material(of) => {
                let text = format!("<{}> mixes the members of {of}, which are no base materials", group.name);
                reader.remark(group.at, &text);
            }
            _ => {
                let text = format!("<{}> mixes materials {of}, which are not there", group.name);
                reader.remark(group.at, &text);
            }
        }
    }
    let mut shares = Vec::new();
    each(reader, group, "composite", |reader, element| {
        let attributes = reader.scanner.attributes(element)?;
        let number = |word: &str| {
            let number = numbers::coordinate(word.as_bytes(), Precision::F64)?;
            (number.is_finite() && number >= 0.0).then_some(number)
        };
        let words = value(&attributes, "values").unwrap_or_default().split_ascii_whitespace();
        shares.push(words.map(|word| number(word).unwrap_or(0.0)).collect());
        Ok(())
    })?;
    Ok(Group::Mixtures { of: of.unwrap_or(0), members, shares })
}

/// Members of several groups on each other.
pub(super) fn layers<'x>(reader: &mut ModelReader<'x>, group: &XmlElement<'x>) -> Result<Group, ReadError> {
    let attributes = reader.scanner.attributes(group)?;
    let of = value(&attributes, "pids").map(indices).unwrap_or_default();
    if of.is_empty() {
        reader.remark(group.at, &format!("<{}> names no property groups", group.name));
    }
    let (mut materials, mut colors) = (0, 0);
    for (i, id) in of.iter().enumerate() {
        let problem = match reader.model.groups.get(*id) {
            None => Some("is not there"),
            Some(Group::Layers { .. }) => Some("is one of layers itself"),
            Some(Group::Mixtures { .. }) => {
                materials += 1;
                (materials > 1).then_some("is a second one of materials")
            }
            Some(Group::Colors(_)) if reader.is_material(*id) => {
                materials += 1;
                (materials > 1).then_some("is a second one of materials")
            }
            Some(Group::Colors(_)) => {
                colors += 1;
                (colors > 1).then_some("is a second one of colours")
            }
            Some(Group::Places(_)) => None,
        };
        if let Some(problem) = problem {
            let text = format!("<{}> has in layer {i} the property group {id}, which {problem}", group.name);
            reader.remark(group.at, &text);
        }
    }
    let mut members = Vec::new();
    each(reader, group, "multi", |reader, element| {
        let attributes = reader.scanner.attributes(element)?;
        members.push(indices(value(&attributes, "pindices").unwrap_or_default()));
        Ok(())
    })?;
    Ok(Group::Layers { of, members })
}

/// Runs `body` on each element `name` in `group`, and passes over all others.
fn each<'x>(
    reader: &mut ModelReader<'x>,
    group: &XmlElement<'x>,
    name: &str,
    mut body: impl FnMut(&mut ModelReader<'x>, &XmlElement<'x>) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    if group.is_empty {
        return Ok(());
    }
    let depth = reader.scanner.depth;
    while let Some(element) = reader.next_child(depth)? {
        let is_known = matches!(element.namespace, Namespace::Core | Namespace::Material);
        if is_known && element.local == name {
            body(reader, &element)?;
        }
        reader.scanner.skip(&element)?;
    }
    Ok(())
}

/// Red, green, blue and alpha of `#RRGGBB` or `#RRGGBBAA`.
fn color(text: &str) -> Option<[u8; 4]> {
    let digits = text.trim_ascii().strip_prefix('#')?;
    let is_hex = digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let byte = |i: usize| u8::from_str_radix(digits.get(2 * i..2 * i + 2)?, 16).ok();
    match digits.len() {
        6 if is_hex => Some([byte(0)?, byte(1)?, byte(2)?, 255]),
        8 if is_hex => Some([byte(0)?, byte(1)?, byte(2)?, byte(3)?]),
        _ => None,
    }
}

fn indices(text: &str) -> Vec<u32> {
    text.split_ascii_whitespace().map(|word| number(word).unwrap_or(u32::MAX)).collect()
}

#[cfg(test)]
mod tests {
    use super::color;

    #[test]
    fn colours_have_six_or_eight_digits() {
        assert_eq!(color("#FF8000"), Some([255, 128, 0, 255]));
        assert_eq!(color("#ff800010"), Some([255, 128, 0, 16]));
        for text in ["", "FF8000", "#FF80", "#FF80000", "#GG8000", "red"] {
            assert_eq!(color(text), None, "{text}");
        }
    }
}
