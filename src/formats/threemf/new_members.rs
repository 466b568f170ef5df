//! New members of property groups: what is between those at the corners of a face.

use super::model::{Group, Groups, MIXED_MAX, Property};
use super::read::Body;
use super::regions::{MemberValue, VALUE_BYTES};
use crate::budget::{Budget, Charge, Stopped};
use crate::formats::decimals::Text;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Most bytes of a new member beside its numbers, and of each of these.
const MEMBER_BYTES_MAX: usize = 60;
const NUMBER_BYTES_MAX: usize = 30;

/// What the corners of a triangle have that is no face of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Between {
    /// Places in the picture of the face behind it.
    Points([[f64; 2]; 3]),
    /// For each corner a face, and the shares of the corners of this face, which are not negative and have the sum 1. The
    /// faces have members of one group.
    Shares([(u32, [f64; 3]); 3]),
}

/// The members of the groups of a part, and new ones.
pub(super) struct NewMembers<'g> {
    groups: &'g Groups,
    /// Numbers of members by what they are, of groups that were asked for.
    known: FxHashMap<u32, FxHashMap<MemberValue, u32>>,
    new: BTreeMap<u32, Vec<MemberValue>>,
    charges: Vec<Charge<'g>>,
    /// Bytes that are not charged yet.
    uncharged: usize,
}

/// Bytes up to which what is new is charged later.
const UNCHARGED_MAX: usize = 1 << 20;

impl<'g> NewMembers<'g> {
    pub(super) fn of(groups: &'g Groups) -> Self {
        Self { groups, known: FxHashMap::default(), new: BTreeMap::new(), charges: Vec::new(), uncharged: 0 }
    }

    /// Charges what was noted since.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn charge(&mut self, budget: &'g Budget) -> Result<(), Stopped> {
        if self.uncharged > UNCHARGED_MAX {
            self.charges.push(budget.charge(std::mem::take(&mut self.uncharged) as u64)?);
        }
        Ok(())
    }

    /// The members at the corners of a triangle of `body` that takes over what is `between` corners of faces, of which `face`
    /// is the one behind it.
    pub(super) fn at_corners(&mut self, body: &Body, face: u32, between: &Between) -> [u32; 3] {
        let Property { group, .. } = body.property_of(face);
        match between {
            Between::Points(points) => {
                points.map(|point| self.number(group, MemberValue::Point(point.map(f64::to_bits))))
            }
            Between::Shares(corners) => corners.map(|(face, shares)| {
                let members = body.property_of(face).members;
                let parts: Vec<(u32, f64)> =
                    members.into_iter().zip(shares).filter(|&(_, share)| share > 0.0).collect();
                self.mixed(group, &parts, true)
            }),
        }
    }

    /// The member of a group that is a mixture of `parts`: members with their shares.
    fn mixed(&mut self, group: u32, parts: &[(u32, f64)], has_layers: bool) -> u32 {
        let share = |member| parts.iter().filter(|part| part.0 == member).map(|part| part.1).sum::<f64>();
        let members = parts.iter().map(|part| part.0);
        let Some(largest) = members.reduce(|a, b| if share(b) > share(a) { b } else { a }) else { return 0 };
        if parts.iter().all(|&(member, _)| member == largest) {
            return largest;
        }
        let groups = self.groups;
        let value = match groups.mixable(group) {
            Some(Group::Colors(colors)) => mean_color(colors, parts),
            Some(Group::Places(points)) => mean_point(points, parts),
            Some(Group::Mixtures { shares, .. }) => mean_shares(shares, parts),
            Some(Group::Layers { of, members }) if has_layers => {
                let layer = |(i, &group): (usize, &u32)| {
                    let index = |member: u32| members.get(member as usize)?.get(i).copied();
                    let of_layer: Vec<(u32, f64)> =
                        parts.iter().map(|&(member, share)| (index(member).unwrap_or(0), share)).collect();
                    MemberValue::Member(self.mixed(group, &of_layer, false))
                };
                Some(MemberValue::Layers(of.iter().enumerate().map(layer).collect()))
            }
            _ => None,
        };
        value.map_or(largest, |value| self.number(group, value))
    }

    /// The number of the member that is `value`, a new one if there is none yet.
    fn number(&mut self, group: u32, value: MemberValue) -> u32 {
        let groups = self.groups;
        let count = groups.get(group).map_or(0, Group::len);
        let known = self.known.entry(group).or_insert_with(|| {
            self.uncharged += count * VALUE_BYTES;
            members_of(groups, group)
        });
        if let Some(&number) = known.get(&value) {
            return number;
        }
        self.uncharged += 2 * VALUE_BYTES;
        let new = self.new.entry(group).or_default();
        let number = (count + new.len()) as u32;
        new.push(value.clone());
        known.insert(value, number);
        number
    }

    /// The elements of new members, and where they belong in the text of the part.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn edits(&self, text: &str, budget: &Budget) -> Result<Vec<(usize, Vec<u8>)>, Stopped> {
        let mut edits = Vec::new();
        for (&group, values) in &self.new {
            let Some(span) = self.groups.span(group) else { continue };
            let Some(end) = text[span.clone()].rfind("</").map(|at| span.start + at) else { continue };
            let name = text[end + 2..span.end].split(|c: char| c.is_ascii_whitespace() || c == '>');
            let name = name.into_iter().next().unwrap_or_default();
            let prefix = name.find(':').map_or("", |colon| &name[..=colon]);
            let mut new = Text::new(budget);
            for (i, value) in values.iter().enumerate() {
                new.before_item(i, MEMBER_BYTES_MAX + prefix.len() + NUMBER_BYTES_MAX * MIXED_MAX)?;
                write_member(&mut new, prefix, value);
            }
            edits.push((end, new.into_bytes()));
        }
        Ok(edits)
    }
}

/// The members of a group, by what they are as [`NewMembers`] sees it: layers by the numbers of their members.
fn members_of(groups: &Groups, group: u32) -> FxHashMap<MemberValue, u32> {
    let count = groups.get(group).map_or(0, Group::len) as u32;
    let mut known = FxHashMap::default();
    for member in 0..count {
        let value = match groups.mixable(group) {
            Some(Group::Layers { of, members }) => {
                let indices = &members[member as usize];
                let index = |i: usize| MemberValue::Member(indices.get(i).copied().unwrap_or(0));
                MemberValue::Layers((0..of.len()).map(index).collect())
            }
            _ => groups.value(group, member),
        };
        known.entry(value).or_insert(member);
    }
    known
}

fn mean_color(colors: &[Option<[u8; 4]>], parts: &[(u32, f64)]) -> Option<MemberValue> {
    let mut mean = [0.0; 4];
    for &(member, share) in parts {
        let color = (*colors.get(member as usize)?)?;
        for (sum, channel) in mean.iter_mut().zip(color) {
            *sum += share * f64::from(channel);
        }
    }
    Some(MemberValue::Color(mean.map(|channel| channel.round() as u8)))
}

fn mean_point(points: &[[f64; 2]], parts: &[(u32, f64)]) -> Option<MemberValue> {
    let mut mean = [0.0; 2];
    for &(member, share) in parts {
        let [u, v] = *points.get(member as usize)?;
        mean = [mean[0] + share * u, mean[1] + share * v];
    }
    mean.iter().all(|x| x.is_finite()).then(|| MemberValue::Point(mean.map(f64::to_bits)))
}

/// Members state shares of what sum they like, so that each counts by its own.
fn mean_shares(all: &[Vec<f64>], parts: &[(u32, f64)]) -> Option<MemberValue> {
    let mut mean: Vec<f64> = Vec::new();
    for &(member, share) in parts {
        let shares = all.get(member as usize)?;
        let whole: f64 = shares.iter().sum();
        if whole <= 0.0 || !whole.is_finite() {
            return None;
        }
        mean.resize(mean.len().max(shares.len()), 0.0);
        for (sum, of_material) in mean.iter_mut().zip(shares) {
            *sum += share * of_material / whole;
        }
    }
    Some(MemberValue::Shares(mean.into_iter().map(f64::to_bits).collect()))
}

fn write_member(text: &mut Text<'_>, prefix: &str, value: &MemberValue) {
    let mut begin = |words: [&str; 2]| ["<", prefix, words[0], words[1]].map(|word| text.word(word));
    match value {
        // Those that cannot be mixed are never new.
        MemberValue::Member(_) => return,
        MemberValue::Color([r, g, b, a]) => {
            begin(["color", " color=\"#"]);
            text.word(&format!("{r:02X}{g:02X}{b:02X}{a:02X}"));
        }
        MemberValue::Point([u, v]) => {
            begin(["tex2coord", " u=\""]);
            text.coordinate(f64::from_bits(*u));
            text.word("\" v=\"");
            text.coordinate(f64::from_bits(*v));
        }
        MemberValue::Shares(shares) => {
            begin(["composite", " values=\""]);
            for (i, share) in shares.iter().enumerate() {
                text.word(if i > 0 { " " } else { "" });
                text.coordinate(f64::from_bits(*share));
            }
        }
        MemberValue::Layers(layers) => {
            begin(["multi", " pindices=\""]);
            for (i, layer) in layers.iter().enumerate() {
                text.word(if i > 0 { " " } else { "" });
                if let MemberValue::Member(member) = layer {
                    text.integer((*member).into());
                }
            }
        }
    }
    text.word("\"/>\n");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups() -> Groups {
        let mut groups = Groups::default();
        let black_and_red = vec![Some([0, 0, 0, 255]), Some([200, 0, 0, 255]), Some([0, 0, 0, 255])];
        groups.insert(1, Group::Colors(black_and_red.clone()), true, 0..0);
        groups.insert(2, Group::Colors(black_and_red), false, 0..30);
        groups.insert(3, Group::Places(vec![[0.0, 0.0], [1.0, 0.5]]), false, 30..60);
        let members = vec![vec![0, 0, 1], vec![1, 1, 1]];
        groups.insert(4, Group::Layers { of: vec![1, 2, 3], members }, false, 60..90);
        groups.insert(
            5,
            Group::Mixtures { of: 1, members: vec![0, 1], shares: vec![vec![2.0], vec![0.0, 1.0]] },
            false,
            0..0,
        );
        groups
    }

    #[test]
    fn what_is_between_two_members_is_one_new_member() {
        let groups = groups();
        let mut new = NewMembers::of(&groups);
        assert_eq!(new.mixed(2, &[(0, 0.5), (1, 0.5)], true), 3);
        assert_eq!(new.mixed(2, &[(1, 0.5), (2, 0.5)], true), 3, "the same colour");
        assert_eq!(new.mixed(2, &[(0, 0.5), (2, 0.5)], true), 0, "one that is there");
        assert_eq!(new.mixed(3, &[(0, 0.25), (1, 0.75)], true), 2);
        assert_eq!(new.mixed(1, &[(0, 0.25), (1, 0.75)], true), 1, "materials are not mixed");
        assert_eq!(new.mixed(1, &[(0, 0.3), (1, 0.4), (0, 0.3)], true), 0, "both shares of a material count");
        assert_eq!(new.mixed(5, &[(0, 0.25), (1, 0.75)], true), 2);
        assert_eq!(new.new[&5], [MemberValue::Shares([0.25f64, 0.75].map(f64::to_bits).to_vec())]);
        assert_eq!(new.mixed(4, &[(0, 0.5), (1, 0.5)], true), 2);
        assert_eq!(new.new[&4], [MemberValue::Layers([0, 3, 1].map(MemberValue::Member).to_vec())]);
    }

    #[test]
    fn new_members_stand_at_the_end_of_their_group() {
        let text = "<m:colorgroup></m:colorgroup >";
        let mut groups = Groups::default();
        groups.insert(2, Group::Colors(vec![Some([0; 4]), Some([255; 4])]), false, 0..text.len());
        let mut new = NewMembers::of(&groups);
        new.mixed(2, &[(0, 0.5), (1, 0.5)], true);
        let edits = new.edits(text, &Budget::unlimited()).unwrap();
        assert_eq!(edits, [(14, b"<m:color color=\"#80808080\"/>\n".to_vec())]);
    }
}
