//! What a cut has to part: marked edges, and the vertices at which more than one fan is left.

use super::ChosenEdges;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{EdgeGroups, NO_TWIN, edge_of, singular_vertices};

/// The edges of a triangle list across which a cut goes, and the stars that come apart by it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CutMarks {
    /// Edges with more than two triangles.
    pub singular_edges: u64,
    /// Edges whose two triangles run in the same direction.
    pub conflicting_edges: u64,
    /// Other edges, with one triangle or two, that the caller chose.
    pub chosen_edges: u64,
    /// Vertices with more than one fan at which no marked edge ends.
    pub isolated_vertices: u64,
    /// Across the edges that stay: see [`CutMarks::twins`].
    twins: Vec<u32>,
    /// Vertices with more than one fan, ascending.
    vertices: Vec<u32>,
    /// Where the corners of vertex `i` of `vertices` begin; one more than vertices.
    starts: Vec<u32>,
    /// The corners at these vertices, ascending for each.
    corners: Vec<u32>,
}

impl CutMarks {
    /// Marks the edges of `triangles` that have more than two triangles, those with two in the same direction, and the
    /// `chosen` ones, of which those that are not there are passed over. No triangle may have a repeated vertex.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn find(
        triangles: &[[u32; 3]],
        vertex_count: usize,
        groups: &EdgeGroups,
        chosen: &ChosenEdges,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let _charge = budget.charge(triangles.len() as u64 * 12 + vertex_count as u64 * 5)?;
        let mut marks = Self {
            singular_edges: 0,
            conflicting_edges: 0,
            chosen_edges: 0,
            isolated_vertices: 0,
            twins: vec![NO_TWIN; triangles.len() * 3],
            vertices: Vec::new(),
            starts: Vec::new(),
            corners: Vec::new(),
        };
        let mut is_end = vec![false; vertex_count];
        for (e, group) in groups.iter().enumerate() {
            if e % CHECK_EVERY == 0 {
                budget.check()?;
            }
            if marks.note(triangles, group) {
                edge_of(triangles, group[0]).into_iter().for_each(|v| is_end[v as usize] = true);
            }
        }
        for ends in chosen.iter() {
            budget.spend(1)?;
            if let Some(e) = groups.find(triangles, ends) {
                marks.choose(groups.group(e));
                ends.into_iter().for_each(|v| is_end[v as usize] = true);
            }
        }
        marks.vertices = singular_vertices(triangles, vertex_count, &marks.twins, budget)?;
        marks.isolated_vertices = marks.vertices.iter().filter(|&&v| !is_end[v as usize]).count() as u64;
        marks.collect_stars(triangles, vertex_count, budget)?;
        Ok(marks)
    }

    /// The marks of a cut across all half-edges that `twins` does not join: two that it joins must run in opposite
    /// directions along one edge. Counts no edges.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn across(
        triangles: &[[u32; 3]],
        vertex_count: usize,
        twins: Vec<u32>,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let _charge = budget.charge(triangles.len() as u64 * 12 + vertex_count as u64 * 5)?;
        let vertices = singular_vertices(triangles, vertex_count, &twins, budget)?;
        let mut marks = Self {
            singular_edges: 0,
            conflicting_edges: 0,
            chosen_edges: 0,
            isolated_vertices: 0,
            twins,
            vertices,
            starts: Vec::new(),
            corners: Vec::new(),
        };
        marks.collect_stars(triangles, vertex_count, budget)?;
        Ok(marks)
    }

    /// Counts or joins the edge of `group`; true when it is marked.
    fn note(&mut self, triangles: &[[u32; 3]], group: &[u32]) -> bool {
        match *group {
            [_] => return false,
            [g, h] if edge_of(triangles, g)[0] != edge_of(triangles, h)[0] => {
                self.twins[g as usize] = h;
                self.twins[h as usize] = g;
                return false;
            }
            [_, _] => self.conflicting_edges += 1,
            _ => self.singular_edges += 1,
        }
        true
    }

    fn choose(&mut self, group: &[u32]) {
        let is_whole = group.len() == 1 || self.twins[group[0] as usize] != NO_TWIN;
        self.chosen_edges += u64::from(is_whole);
        for &h in group {
            self.twins[h as usize] = NO_TWIN;
        }
    }

    fn collect_stars(
        &mut self,
        triangles: &[[u32; 3]],
        vertex_count: usize,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        if self.vertices.is_empty() {
            self.starts = vec![0];
            return Ok(());
        }
        let mut slot = vec![u32::MAX; vertex_count];
        for (i, &v) in self.vertices.iter().enumerate() {
            slot[v as usize] = i as u32;
        }
        let mut placed = Vec::new();
        for (corner, &v) in triangles.as_flattened().iter().enumerate() {
            if corner % CHECK_EVERY == 0 {
                budget.check()?;
            }
            if slot[v as usize] != u32::MAX {
                placed.push((slot[v as usize], corner as u32));
            }
        }
        placed.sort_unstable();
        let starts = (0..=self.vertices.len() as u32).map(|i| placed.partition_point(|&(s, _)| s < i) as u32);
        self.starts = starts.collect();
        self.corners = placed.into_iter().map(|(_, corner)| corner).collect();
        Ok(())
    }

    /// For each half-edge the other one of its edge where that stays whole: not marked, and with two triangles in
    /// opposite directions. [`NO_TWIN`] elsewhere.
    pub fn twins(&self) -> &[u32] {
        &self.twins
    }

    /// The vertices that have more than one fan across edges that stay, ascending: of these the cut makes copies.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// Number of corners at those vertices.
    pub fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// The corners at each of those vertices, ascending.
    pub(super) fn stars(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|w| &self.corners[w[0] as usize..w[1] as usize])
    }
}
