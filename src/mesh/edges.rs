//! Half-edges of a triangle list, grouped by undirected edge.
//!
//! Half-edge `h = 3 t + c` runs from corner `c` of triangle `t` to the next corner. No coordinates here.

use super::corners::{edge_of, triangle_of};
use super::{Components, Outlines, UnionFind};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::par;

/// All half-edges grouped by undirected edge, edges ordered by (smaller vertex, larger vertex), half-edges inside a
/// group by id. Any number of triangles may share an edge; a triangle with a repeated corner gives an edge with two
/// equal ends. After the edges come the diagonals of polygons, if there are some: each a group of its two half-edges.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EdgeGroups {
    half_edges: Vec<u32>,
    starts: Vec<u32>,
    /// Groups at the end that are diagonals.
    diagonals: usize,
}

/// Most parts of the vertex range, which are grouped at the same time.
const PARTS_MAX: usize = 16;
/// Parts whose keys are charged, the longest: more threads than this are rare.
const PARTS_AT_A_TIME: usize = 4;
/// Triangles in a block, of which it is known which parts their edges are of.
const BLOCK: usize = 64;

impl EdgeGroups {
    /// Groups the half-edges of `triangles`, whose indices must be below `vertex_count`. O(n) by counting sort on the
    /// smaller vertex, then a sort inside each vertex.
    ///
    /// # Errors
    /// When the budget stops the run.
    ///
    /// # Panics
    /// With 2^32 / 3 triangles or more; the readers' limits keep counts below.
    pub fn build(triangles: &[[u32; 3]], vertex_count: usize, budget: &Budget) -> Result<Self, Stopped> {
        assert!(triangles.len() < (u32::MAX / 3) as usize, "too many triangles for 32-bit half-edges");
        // Half-edges, group starts of the parts and of all, and where each vertex begins, twice.
        let _charge = budget.charge(triangles.len() as u64 * 3 * 8 + vertex_count as u64 * 8)?;
        let (offsets, blocks) = offsets_by_smaller_vertex(triangles, vertex_count, budget)?;
        let mut half_edges = vec![0u32; triangles.len() * 3];
        let mut parts = Vec::with_capacity(PARTS_MAX);
        let mut rest = &mut half_edges[..];
        for first in (0..vertex_count).step_by(1 << blocks.shift) {
            let offsets = &offsets[first..=(first + (1 << blocks.shift)).min(vertex_count)];
            let (part, others) = rest.split_at_mut((offsets[offsets.len() - 1] - offsets[0]) as usize);
            parts.push((offsets, part));
            rest = others;
        }
        let mut lengths: Vec<u64> = parts.iter().map(|(_, part)| part.len() as u64).collect();
        lengths.sort_unstable_by_key(|&len| std::cmp::Reverse(len));
        let _keys_charge = budget.charge(8 * lengths.iter().take(PARTS_AT_A_TIME).sum::<u64>())?;
        let starts_of_parts = par::map_items(parts, |part, (offsets, half_edges)| {
            group_part(triangles, &blocks, part, offsets, half_edges, budget)
        });
        let mut starts = Vec::with_capacity(triangles.len() * 3 / 2 + 2);
        for part in starts_of_parts {
            starts.extend(part?);
        }
        starts.push(half_edges.len() as u32);
        Ok(Self { half_edges, starts, diagonals: 0 })
    }

    /// Groups the half-edges of the faces with these `outlines` that `triangles` make: as [`EdgeGroups::build`] when all are
    /// triangles, otherwise with the diagonals apart from whatever edge joins the same vertices.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn of_faces(
        triangles: &[[u32; 3]],
        outlines: &Outlines,
        vertex_count: usize,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let all = Self::build(triangles, vertex_count, budget)?;
        if !outlines.has_polygons() {
            return Ok(all);
        }
        let _charge = budget.charge(triangles.len() as u64 * 3 * 8)?;
        let mut edges =
            Self { half_edges: Vec::with_capacity(all.half_edges.len()), starts: vec![0], diagonals: 0 };
        let mut diagonals: Vec<u32> = Vec::new();
        for (e, group) in all.iter().enumerate() {
            if e % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let before = edges.half_edges.len();
            edges.half_edges.extend(group.iter().filter(|&&h| !outlines.is_diagonal(h)));
            if edges.half_edges.len() > before {
                edges.starts.push(edges.half_edges.len() as u32);
            }
            // A face has a diagonal between two vertices once, and its triangles follow each other: so do the two halves.
            diagonals.extend(group.iter().filter(|&&h| outlines.is_diagonal(h)));
        }
        edges.diagonals = diagonals.len() / 2;
        let first = edges.half_edges.len() as u32;
        edges.starts.extend((1..=edges.diagonals as u32).map(|i| first + 2 * i));
        edges.half_edges.extend(diagonals);
        Ok(edges)
    }

    /// The triangles connected by edges, and by diagonals.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn components(&self, budget: &Budget) -> Result<Components, Stopped> {
        let mut sets = UnionFind::new(self.half_edges.len() / 3);
        for (e, group) in self.iter().enumerate() {
            if e % CHECK_EVERY == 0 {
                budget.check()?;
            }
            for pair in group.windows(2) {
                sets.unite(triangle_of(pair[0]), triangle_of(pair[1]));
            }
        }
        Ok(sets.into_components())
    }

    /// Number of undirected edges, with diagonals.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// True when there is no edge.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The half-edges of edge `e`.
    pub fn group(&self, e: usize) -> &[u32] {
        &self.half_edges[self.starts[e] as usize..self.starts[e + 1] as usize]
    }

    /// The edge with these ends (the smaller first) of the `triangles` it was built from, if there is one; a diagonal is
    /// none. O(log n).
    pub fn find(&self, triangles: &[[u32; 3]], ends: [u32; 2]) -> Option<usize> {
        let (mut low, mut high) = (0, self.len() - self.diagonals);
        while low < high {
            let middle = low + (high - low) / 2;
            let [a, b] = edge_of(triangles, self.group(middle)[0]);
            match [a.min(b), a.max(b)].cmp(&ends) {
                std::cmp::Ordering::Less => low = middle + 1,
                std::cmp::Ordering::Equal => return Some(middle),
                std::cmp::Ordering::Greater => high = middle,
            }
        }
        None
    }

    /// The half-edges of every edge, in edge order, without diagonals.
    pub fn edges(&self) -> impl Iterator<Item = &[u32]> {
        self.iter().take(self.len() - self.diagonals)
    }

    /// The half-edges of every diagonal.
    pub fn diagonals(&self) -> impl Iterator<Item = &[u32]> {
        self.iter().skip(self.len() - self.diagonals)
    }

    /// The half-edges of every edge, in edge order, then those of every diagonal.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|w| &self.half_edges[w[0] as usize..w[1] as usize])
    }
}

/// Which parts of the vertex range the smaller vertices of edges are in: part `p` begins at vertex `p << shift`.
struct Blocks {
    shift: u32,
    /// For each [`BLOCK`] triangles, a bit for each part.
    parts: Vec<u16>,
}

/// Where the half-edges of each smaller vertex begin, and the end.
fn offsets_by_smaller_vertex(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    budget: &Budget,
) -> Result<(Vec<u32>, Blocks), Stopped> {
    let shift = vertex_count.div_ceil(PARTS_MAX).next_power_of_two().ilog2();
    let mut offsets = vec![0u32; vertex_count + 1];
    let mut parts = Vec::with_capacity(triangles.len().div_ceil(BLOCK));
    for (i, block) in triangles.chunks(BLOCK).enumerate() {
        if i % (CHECK_EVERY / BLOCK) == 0 {
            budget.check()?;
        }
        let mut parts_here = 0;
        for &[a, b, c] in block {
            for min in [a.min(b), b.min(c), c.min(a)] {
                offsets[min as usize + 1] += 1;
                parts_here |= 1 << (min >> shift);
            }
        }
        parts.push(parts_here);
    }
    for v in 0..vertex_count {
        offsets[v + 1] += offsets[v];
    }
    Ok((offsets, Blocks { shift, parts }))
}

/// Fills `half_edges` with those whose smaller vertices are in `part`, of which `offsets` tell where each begins among all; gives
/// where each group starts among all.
fn group_part(
    triangles: &[[u32; 3]],
    blocks: &Blocks,
    part: usize,
    offsets: &[u32],
    half_edges: &mut [u32],
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let (begin, len) = (offsets[0], offsets.len() - 1);
    let first = (part << blocks.shift) as u32;
    // The larger vertex of each half-edge above its id.
    let mut keys = vec![0u64; half_edges.len()];
    let mut cursor = offsets[..len].to_vec();
    for (i, block) in triangles.chunks(BLOCK).enumerate() {
        if i % (CHECK_EVERY / BLOCK) == 0 {
            budget.check()?;
        }
        if blocks.parts[i] & 1 << part == 0 {
            continue;
        }
        for (t, &[a, b, c]) in (i * BLOCK..).zip(block) {
            for (k, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
                let v = from.min(to).wrapping_sub(first) as usize;
                if v < len {
                    let key = u64::from(from.max(to)) << 32 | (3 * t + k) as u64;
                    keys[(cursor[v] - begin) as usize] = key;
                    cursor[v] += 1;
                }
            }
        }
    }
    let mut starts = Vec::with_capacity(half_edges.len() / 2 + 1);
    for (v, range) in offsets.windows(2).enumerate() {
        if v % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let of_vertex = (range[0] - begin) as usize..(range[1] - begin) as usize;
        let star = &mut keys[of_vertex.clone()];
        star.sort_unstable();
        let mut last = None;
        for ((place, at), &key) in half_edges[of_vertex].iter_mut().zip(range[0]..).zip(&*star) {
            *place = key as u32;
            if last.replace(key >> 32) != Some(key >> 32) {
                starts.push(at);
            }
        }
    }
    Ok(starts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{next_corner, prev_corner};
    use std::collections::BTreeMap;

    fn by_map(triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
        let mut groups: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
        for h in 0..triangles.len() as u32 * 3 {
            let [a, b] = edge_of(triangles, h);
            groups.entry((a.min(b), a.max(b))).or_default().push(h);
        }
        groups.into_values().collect()
    }

    #[test]
    fn groups_equal_those_of_an_ordered_map_on_random_soups() {
        let mut state = 7u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        for round in 0..500 {
            // Several blocks of triangles in each fourth round, whose vertices are all over the range or near each other.
            let (vertex_count, count) = match round % 4 {
                0 => (1 + random(600), 64 + random(300)),
                _ => (1 + random(30), random(60)),
            };
            let window = if round % 8 == 0 { 8 } else { vertex_count };
            let triangles: Vec<[u32; 3]> = (0..count)
                .map(|t| std::array::from_fn(|_| (t * vertex_count / count + random(window)) % vertex_count))
                .collect();
            let groups = EdgeGroups::build(&triangles, vertex_count as usize, &Budget::unlimited()).unwrap();
            let listed: Vec<Vec<u32>> = groups.iter().map(<[u32]>::to_vec).collect();
            assert_eq!(listed, by_map(&triangles), "round {round}: {triangles:?}");
            assert_eq!(groups.len(), listed.len());
            for (e, group) in listed.iter().enumerate() {
                let [a, b] = edge_of(&triangles, group[0]);
                assert_eq!(groups.find(&triangles, [a.min(b), a.max(b)]), Some(e));
            }
            assert_eq!(groups.find(&triangles, [vertex_count, vertex_count]), None);
        }
    }

    #[test]
    fn corners_turn_around_their_triangle() {
        for h in 0..9 {
            assert_eq!(triangle_of(next_corner(h)), triangle_of(h));
            assert_eq!(prev_corner(next_corner(h)), h);
        }
    }
}
