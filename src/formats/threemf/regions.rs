//! The regions in which the faces of a body are the same, and the values at the corners of those that are not.

use super::model::{Group, Groups, NO_NUMBER, Property};
use super::read::Body;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{NO_POINT, NO_VALUE, Regions, Texture};
use rustc_hash::FxHashMap;

/// What a member of a property group is. Members that are alike in it are the same.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum MemberValue {
    /// One that cannot be mixed with others, by its number.
    Member(u32),
    Color([u8; 4]),
    /// The bits of a place in a picture.
    Point([u64; 2]),
    /// The bits of the shares of materials.
    Shares(Vec<u64>),
    Layers(Vec<MemberValue>),
}

impl Groups {
    /// What a member of a group is; layers may lie on each other once.
    pub(super) fn value(&self, group: u32, member: u32) -> MemberValue {
        match self.mixable(group) {
            Some(Group::Layers { of, members }) => match members.get(member as usize) {
                Some(indices) => {
                    let of_layer = |(i, &group): (usize, &u32)| {
                        self.plain_value(group, indices.get(i).copied().unwrap_or(0))
                    };
                    MemberValue::Layers(of.iter().enumerate().map(of_layer).collect())
                }
                None => MemberValue::Member(member),
            },
            _ => self.plain_value(group, member),
        }
    }

    fn plain_value(&self, group: u32, member: u32) -> MemberValue {
        let value = match self.mixable(group) {
            Some(Group::Colors(colors)) => {
                colors.get(member as usize).copied().flatten().map(MemberValue::Color)
            }
            Some(Group::Places(points)) => {
                points.get(member as usize).map(|point| MemberValue::Point(point.map(f64::to_bits)))
            }
            Some(Group::Mixtures { shares, .. }) => shares
                .get(member as usize)
                .map(|shares| MemberValue::Shares(shares.iter().map(|share| share.to_bits()).collect())),
            _ => None,
        };
        value.unwrap_or(MemberValue::Member(member))
    }
}

impl Body {
    /// What face `face` is made of, each corner with a member; [`NO_NUMBER`] where nothing is stated.
    pub(super) fn property_of(&self, face: u32) -> Property {
        let Property { group, members } = self.attributes.property_of(self.property, face as usize);
        let [first, ..] = members;
        Property { group, members: members.map(|member| if member == NO_NUMBER { first } else { member }) }
    }

    /// True when other things are stated at the corners of face `face`, so that it has what is between them inside.
    pub fn is_mixed(&self, face: u32) -> bool {
        let Property { group, members: [a, b, c] } = self.property_of(face);
        let value = |member: u32| self.groups.value(group, member);
        [b, c] != [a, a] && (value(a) != value(b) || value(a) != value(c))
    }

    /// True when the corners of both faces have members of one group.
    pub fn are_of_one_group(&self, face: u32, other: u32) -> bool {
        self.property_of(face).group == self.property_of(other).group
    }

    /// True when the corners of face `face` are places in a picture.
    pub fn is_in_picture(&self, face: u32) -> bool {
        matches!(self.groups.get(self.property_of(face).group), Some(Group::Places(_)))
    }

    /// True when all corners that are places in a picture are places in the same one.
    pub fn has_one_picture(&self) -> bool {
        self.groups.have_one_picture()
    }

    /// Where the corners of triangles are in pictures.
    pub(super) fn places(&self, budget: &Budget) -> Result<Texture, Stopped> {
        let mut texture = Texture::default();
        if self.attributes.properties.is_empty() || !self.groups.have_places() {
            return Ok(texture);
        }
        // Three numbers for each triangle; for each place two coordinates, twice while the list grows, and an entry in a table.
        const PER_PLACE: u64 = 2 * 16 + 64;
        let triangles = self.soup.triangles.len() as u64;
        let places = (3 * triangles).min(self.groups.count_of_places());
        let _charge = budget.charge(12 * triangles + PER_PLACE * places)?;
        let mut numbers: FxHashMap<[u64; 2], u32> = FxHashMap::default();
        let mut number = |point: [f64; 2]| {
            *numbers.entry(point.map(f64::to_bits)).or_insert_with(|| {
                texture.points.push(point);
                texture.points.len() as u32 - 1
            })
        };
        let mut of_triangle = |t: usize| {
            let Property { group, members } = self.property_of(self.soup.face_of(t as u32));
            let Some(Group::Places(points)) = self.groups.get(group) else { return [NO_POINT; 3] };
            let [a, b, c] = members.map(|member| points.get(member as usize).copied());
            match (a, b, c) {
                (Some(a), Some(b), Some(c)) => [a, b, c].map(&mut number),
                _ => [NO_POINT; 3],
            }
        };
        let corners: Vec<[u32; 3]> = (0..self.soup.triangles.len()).map(&mut of_triangle).collect();
        Ok(match texture.points.is_empty() {
            true => Texture::default(),
            false => Texture { corners, ..texture },
        })
    }

    /// The regions of its surface: triangles of one region have the same property and the same other attributes, or
    /// have corners of one group and the same other attributes.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn regions(&self, budget: &Budget) -> Result<Regions, Stopped> {
        let attributes = &self.attributes;
        let mut regions = Regions::default();
        if attributes.properties.is_empty() && attributes.others.is_empty() {
            return Ok(regions);
        }
        let mut numbers = ValueNumbers::default();
        let mut of_key: FxHashMap<[u32; 4], u32> = FxHashMap::default();
        let is_divided: Vec<bool> =
            (0..attributes.texts.len() as u32).map(|number| attributes.is_divided(number)).collect();
        let (mut charges, mut charged) = (Vec::new(), 0);
        let mut is_mixed = false;
        for t in 0..self.soup.triangles.len() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
                let bytes = numbers.of_value.len() * VALUE_BYTES;
                charges.push(budget.charge((bytes - charged) as u64)?);
                charged = bytes;
            }
            let face = self.soup.face_of(t as u32);
            let Property { group, members } = self.property_of(face);
            let values = members.map(|member| numbers.of(&self.groups, group, member));
            let is_uniform = values == [values[0]; 3];
            let other = attributes.others.get(face as usize).copied().unwrap_or(NO_NUMBER);
            // What is painted inside of a triangle can go on with this triangle only.
            let alone = is_divided.get(other as usize).is_some_and(|&is_divided| is_divided);
            let alone = if alone { t as u32 } else { NO_NUMBER };
            let key = [group, if is_uniform { values[0] } else { NO_VALUE }, other, alone];
            let next = of_key.len() as u32;
            regions.of_triangle.push(*of_key.entry(key).or_insert(next));
            is_mixed |= !is_uniform;
            regions.at_corners.push(if is_uniform { [NO_VALUE; 3] } else { values });
        }
        if !is_mixed {
            regions.at_corners = Vec::new();
        }
        if of_key.len() < 2 && !is_mixed {
            regions.of_triangle = Vec::new();
        }
        Ok(regions)
    }
}

/// Bytes of a value of as many layers as are mixed, in a list that finds it.
pub(super) const VALUE_BYTES: usize = 1024;

/// Numbers of values: the same for members of a group that are alike.
#[derive(Default)]
struct ValueNumbers {
    of_member: FxHashMap<[u32; 2], u32>,
    of_value: FxHashMap<(u32, MemberValue), u32>,
}

impl ValueNumbers {
    fn of(&mut self, groups: &Groups, group: u32, member: u32) -> u32 {
        let Self { of_member, of_value } = self;
        *of_member.entry([group, member]).or_insert_with(|| {
            let next = of_value.len() as u32;
            *of_value.entry((group, groups.value(group, member))).or_insert(next)
        })
    }
}
