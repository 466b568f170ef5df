//! The names of objects and groups of an OBJ file.
//!
//! They say nothing of the shape, so nothing in them makes a file unreadable: what cannot be used is taken as absent.

use super::material_names::put_name;
use crate::budget::{Budget, Charge, Stopped};
use crate::formats::decimals::Text;
use crate::mesh::{NAME_BYTES_MAX, NO_OBJECT, OBJECTS_MAX, ObjectName, Objects, Soup};
use std::collections::HashMap;

/// What `o` and `g` say, each until it comes again.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
struct CurrentNames<'a> {
    object: &'a [u8],
    group: &'a [u8],
}

/// The `o` and `g` statements of a part of a file.
#[derive(Debug, Default)]
pub(super) struct ObjectStatements<'a> {
    /// The number of faces of the part before each, ascending, with the new object or group.
    changes: Vec<(u32, [Option<&'a [u8]>; 2])>,
}

impl<'a> ObjectStatements<'a> {
    /// Notes that the faces after the first `faces` belong to this object.
    pub(super) fn object_from(&mut self, faces: u32, name: &'a [u8]) {
        self.last_before(faces)[0] = Some(usable(name));
    }

    /// Notes that the faces after the first `faces` belong to this group.
    pub(super) fn group_from(&mut self, faces: u32, name: &'a [u8]) {
        self.last_before(faces)[1] = Some(usable(name));
    }

    fn last_before(&mut self, faces: u32) -> &mut [Option<&'a [u8]>; 2] {
        if self.changes.last().is_none_or(|last| last.0 != faces) {
            self.changes.push((faces, [None; 2]));
        }
        let last = self.changes.len() - 1;
        &mut self.changes[last].1
    }
}

fn usable(name: &[u8]) -> &[u8] {
    if name.len() > NAME_BYTES_MAX { &[] } else { name }
}

/// The objects of a whole file, part by part.
#[derive(Debug, Default)]
pub(super) struct ObjectsOfFile<'a> {
    /// Seeded, since the file chooses the names.
    numbers: HashMap<CurrentNames<'a>, u32>,
    of_face: Vec<u32>,
    current: CurrentNames<'a>,
}

impl<'a> ObjectsOfFile<'a> {
    /// Adds a part of `faces` faces.
    pub(super) fn append(&mut self, part: &ObjectStatements<'a>, faces: usize) {
        let (begin, end) = (self.of_face.len(), self.of_face.len() + faces);
        for &(before, [object, group]) in &part.changes {
            self.go_on_to(begin + before as usize);
            self.current.object = object.unwrap_or(self.current.object);
            self.current.group = group.unwrap_or(self.current.group);
        }
        self.go_on_to(end);
    }

    /// The faces before number `end` belong to the current object.
    fn go_on_to(&mut self, end: usize) {
        if end > self.of_face.len() {
            let next = self.numbers.len() as u32;
            let is_none = self.current == CurrentNames::default();
            let number = if is_none { NO_OBJECT } else { *self.numbers.entry(self.current).or_insert(next) };
            self.of_face.resize(end, number);
        }
    }

    /// The objects, and how many there are beside them: all, if there are too many.
    pub(super) fn into_objects(self, budget: &Budget) -> Result<(Objects, u64), Stopped> {
        let count = self.numbers.len();
        if count == 0 || count > OBJECTS_MAX {
            return Ok((Objects::default(), count as u64));
        }
        let bytes = |names: &CurrentNames<'_>| names.object.len() + names.group.len();
        let _charge = budget.charge(self.numbers.keys().map(bytes).sum::<usize>() as u64)?;
        let mut names: Vec<(u32, CurrentNames<'_>)> =
            self.numbers.into_iter().map(|(names, number)| (number, names)).collect();
        names.sort_unstable_by_key(|&(number, _)| number);
        let name = |names: CurrentNames<'_>| ObjectName {
            object: names.object.to_vec(),
            group: names.group.to_vec(),
        };
        let names = names.into_iter().map(|(_, names)| name(names)).collect();
        Ok((Objects { names, of_face: self.of_face }, 0))
    }
}

/// A face as [`Soup::faces`] gives it.
pub(super) type Face<'s> = (u32, &'s [u32]);

/// The faces of `soup`, those of each object together; those that belong to none are the first.
pub(super) fn faces_by_object<'s, 'b>(
    soup: &'s Soup,
    budget: &'b Budget,
) -> Result<(Vec<Face<'s>>, Charge<'b>), Stopped> {
    let (mut faces, charge) = budget.vec(soup.triangles.len())?;
    faces.extend(soup.faces());
    faces.sort_by_key(|&(t, _)| rank(soup, t));
    Ok((faces, charge))
}

/// The order in which the triangles of `soup` are written; `None`: their own.
pub(in crate::formats) fn stored_order(soup: &Soup) -> Option<Vec<u32>> {
    let triangles = 0..soup.triangles.len() as u32;
    if soup.objects.is_empty() || triangles.clone().is_sorted_by_key(|t| rank(soup, t)) {
        return None;
    }
    let mut order: Vec<u32> = triangles.collect();
    order.sort_by_key(|&t| rank(soup, t));
    Some(order)
}

fn rank(soup: &Soup, t: u32) -> u32 {
    soup.objects.of(soup.face_of(t)).map_or(0, |object| object + 1)
}

/// Writes changes of the object and the group from face to face.
#[derive(Default)]
pub(super) struct ObjectWriter<'s> {
    current: Option<u32>,
    names: CurrentNames<'s>,
    changes: usize,
}

impl<'s> ObjectWriter<'s> {
    /// To be called before each face, in the order of [`faces_by_object`].
    pub(super) fn before_face(
        &mut self,
        text: &mut Text<'_>,
        objects: &'s Objects,
        face: u32,
    ) -> Result<(), Stopped> {
        const NAME_LINES_BYTES_MAX: usize = 2 * (NAME_BYTES_MAX + 3);
        let object = objects.of(face);
        let Some(names) = object.and_then(|object| objects.names.get(object as usize)) else { return Ok(()) };
        if object == self.current {
            return Ok(());
        }
        text.before_item(self.changes, NAME_LINES_BYTES_MAX)?;
        self.changes += 1;
        self.current = object;
        let names = CurrentNames { object: &names.object, group: &names.group };
        for (word, name, was) in
            [("o", names.object, self.names.object), ("g", names.group, self.names.group)]
        {
            if name != was {
                text.word(word);
                if !name.is_empty() {
                    text.word(" ");
                    put_name(text, name);
                }
                text.word("\n");
            }
        }
        self.names = names;
        Ok(())
    }
}
