//! The mesh as every defect sees it: bit-equal positions joined, edges grouped, parts told apart.

use super::names::{ElementNames, middle};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::{Components, EdgeGroups, Soup, edge_of, prev_corner, triangle_of, twins};
use crate::par;
use crate::spatial::coincident_f64;
use std::borrow::Cow;

/// Triangles that one thread handles at a time.
const CHUNK: usize = 4 * CHECK_EVERY;

/// A soup after the exact weld. Triangles with two corners at one position have no part in its edges: they cover
/// nothing, and without them their neighbours meet.
#[derive(Debug)]
pub(super) struct Welded<'s> {
    /// The file's own words.
    pub(super) soup: &'s Soup,
    /// Triangles with corners at three positions. A corner is the first vertex of the file at its position.
    pub(super) triangles: Cow<'s, [[u32; 3]]>,
    /// The soup's triangle behind each; empty: the same one.
    source: Vec<u32>,
    /// The soup's triangles with two or three corners at one position.
    pub(super) coincident: Vec<u32>,
    /// First vertex at the position of each vertex; empty when all positions differ.
    first_at: Vec<u32>,
    /// Edges of `triangles`.
    pub(super) edges: EdgeGroups,
    /// The other half-edge of each edge with exactly two triangles.
    pub(super) twins: Vec<u32>,
    /// Edges other than those with exactly two triangles that run in opposite directions.
    pub(super) irregular: Vec<u32>,
    /// Parts of `triangles` connected by edges.
    pub(super) components: Components,
    /// What is known of each part.
    pub(super) parts: Vec<WeldedPart>,
}

/// A part connected by edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct WeldedPart {
    /// Its first triangle.
    pub(super) first: u32,
    /// Number of triangles.
    pub(super) len: u32,
    /// Every edge has exactly two triangles.
    pub(super) is_closed: bool,
    /// No edge is run through twice in one direction.
    pub(super) is_oriented: bool,
}

impl<'s> Welded<'s> {
    pub(super) fn of(soup: &'s Soup, budget: &Budget) -> Result<Self, Stopped> {
        let first_at = first_at_position(soup, budget)?;
        let weld = |t: [u32; 3]| if first_at.is_empty() { t } else { t.map(|v| first_at[v as usize]) };
        let coincident =
            indices_where(soup.triangles.len(), budget, |t| has_repeated_corner(weld(soup.triangles[t])))?;
        let mut source = Vec::new();
        if !coincident.is_empty() {
            let mut left_out = coincident.iter().peekable();
            source.extend((0..soup.triangles.len() as u32).filter(|t| left_out.next_if_eq(&t).is_none()));
        }
        budget.check()?;
        let triangles = match (first_at.is_empty(), coincident.is_empty()) {
            (true, true) => Cow::Borrowed(soup.triangles.as_slice()),
            (false, true) => Cow::Owned(soup.triangles.iter().map(|&t| weld(t)).collect()),
            (_, false) => Cow::Owned(source.iter().map(|&t| weld(soup.triangles[t as usize])).collect()),
        };
        let edges = EdgeGroups::build(&triangles, soup.positions.len(), budget)?;
        let (components, (twins, irregular)) = par::join(
            || edges.components(budget),
            || {
                (
                    twins(&edges, triangles.len(), budget),
                    indices_where(edges.len(), budget, |e| !is_regular(&triangles, edges.group(e))),
                )
            },
        );
        let (components, twins, irregular) = (components?, twins?, irregular?);
        let parts = parts(&components, &triangles, &edges, &irregular, budget)?;
        Ok(Self { soup, triangles, source, coincident, first_at, edges, twins, irregular, components, parts })
    }

    /// The soup's triangle behind triangle `t`.
    pub(super) fn source(&self, t: u32) -> u32 {
        if self.source.is_empty() { t } else { self.source[t as usize] }
    }

    /// The first vertex of the file at the position of vertex `v`.
    pub(super) fn first_at(&self, v: u32) -> u32 {
        if self.first_at.is_empty() { v } else { self.first_at[v as usize] }
    }

    /// True when no two vertices of the file have one position.
    pub(super) fn has_distinct_positions(&self) -> bool {
        self.first_at.is_empty()
    }

    pub(super) fn names(&self) -> ElementNames<'s> {
        ElementNames::of(self.soup)
    }

    /// The face of the file behind triangle `t`.
    pub(super) fn face_of(&self, t: u32) -> u32 {
        self.soup.face_of(self.source(t))
    }

    /// The triangle that triangle `source` of the soup is here, if it takes part.
    pub(super) fn triangle_of_source(&self, source: u32) -> Option<u32> {
        if self.source.is_empty() {
            Some(source)
        } else {
            self.source.binary_search(&source).ok().map(|t| t as u32)
        }
    }

    /// The corners of triangle `t`.
    pub(super) fn corners(&self, t: u32) -> [DVec3; 3] {
        self.triangles[t as usize].map(|v| self.position(v))
    }

    /// The corner of the triangle of half-edge `h` that is not on the half-edge.
    pub(super) fn apex(&self, h: u32) -> DVec3 {
        self.position(edge_of(&self.triangles, prev_corner(h))[0])
    }

    pub(super) fn position(&self, v: u32) -> DVec3 {
        self.soup.positions[v as usize]
    }

    /// The ends of edge `e`, in the direction of its first triangle, and the middle between them.
    pub(super) fn edge(&self, e: u32) -> ([u32; 2], DVec3) {
        let ends = edge_of(&self.triangles, self.edges.group(e as usize)[0]);
        (ends, middle(ends.map(|v| self.position(v))))
    }

    /// The faces of the file at edge `e`.
    pub(super) fn faces_at(&self, e: u32) -> impl Iterator<Item = u32> {
        self.edges.group(e as usize).iter().map(|&h| self.face_of(triangle_of(h)))
    }

    /// The part of edge `e`.
    pub(super) fn part_at(&self, e: u32) -> u32 {
        self.components.of[triangle_of(self.edges.group(e as usize)[0]) as usize]
    }

    /// Irregular edges whose number of triangles is as asked.
    pub(super) fn irregular_where(&self, is_asked: impl Fn(usize) -> bool) -> Vec<u32> {
        self.irregular.iter().copied().filter(|&e| is_asked(self.edges.group(e as usize).len())).collect()
    }
}

/// First vertex at the position of each vertex; empty when all positions differ.
fn first_at_position(soup: &Soup, budget: &Budget) -> Result<Vec<u32>, Stopped> {
    if soup.is_welded_by_format {
        return Ok(Vec::new());
    }
    let coincident = coincident_f64(&soup.positions, budget)?;
    if coincident.first.len() == soup.positions.len() {
        return Ok(Vec::new());
    }
    let mut first_at = coincident.group;
    par::for_each_chunk_mut(&mut first_at, CHUNK, |_, groups| {
        for group in groups {
            *group = coincident.first[*group as usize];
        }
    });
    Ok(first_at)
}

fn has_repeated_corner([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// The numbers below `len` for which `is_meant` holds, ascending.
pub(super) fn indices_where(
    len: usize,
    budget: &Budget,
    is_meant: impl Fn(usize) -> bool + Sync,
) -> Result<Vec<u32>, Stopped> {
    let parts = par::try_map_ranges(len, CHECK_EVERY, |range| {
        budget.check()?;
        Ok(range.filter(|&i| is_meant(i)).map(|i| i as u32).collect::<Vec<_>>())
    })?;
    Ok(parts.concat())
}

/// True when exactly two triangles meet at the edge, in opposite directions.
pub(super) fn is_regular(triangles: &[[u32; 3]], group: &[u32]) -> bool {
    matches!(group, &[a, b] if edge_of(triangles, a)[0] != edge_of(triangles, b)[0])
}

fn parts(
    components: &Components,
    triangles: &[[u32; 3]],
    edges: &EdgeGroups,
    irregular: &[u32],
    budget: &Budget,
) -> Result<Vec<WeldedPart>, Stopped> {
    let unseen = WeldedPart { first: u32::MAX, len: 0, is_closed: true, is_oriented: true };
    let mut parts = vec![unseen; components.count as usize];
    for (t, &part) in components.of.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let part = &mut parts[part as usize];
        part.first = part.first.min(t as u32);
        part.len += 1;
    }
    for (i, &e) in irregular.iter().enumerate() {
        if i % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let group = edges.group(e as usize);
        let part = &mut parts[components.of[triangle_of(group[0]) as usize] as usize];
        part.is_closed &= group.len() == 2;
        part.is_oriented &= !runs_twice_in_one_direction(triangles, group);
    }
    Ok(parts)
}

fn runs_twice_in_one_direction(triangles: &[[u32; 3]], group: &[u32]) -> bool {
    let [from, _] = edge_of(triangles, group[0]);
    let along = group.iter().filter(|&&h| edge_of(triangles, h)[0] == from).count();
    along > 1 || group.len() - along > 1
}

/// For each vertex, whether one of `triangles` uses it.
pub(super) fn used_vertices(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    budget: &Budget,
) -> Result<Vec<bool>, Stopped> {
    let mut is_used = vec![false; vertex_count];
    for block in triangles.chunks(CHECK_EVERY) {
        budget.check()?;
        for &v in block.iter().flatten() {
            is_used[v as usize] = true;
        }
    }
    Ok(is_used)
}
