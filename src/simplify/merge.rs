//! What becomes of the two ends of a collapsed edge.

use super::blend::blend;
use super::criterion::CollapseCriterion;
use super::marks::LINE;
use super::report::SimplifyRefusal;
use super::surface::{CollapseSurface, MergeRule, NEW};
use crate::geom::DVec3;
use crate::mesh::Color;
use crate::mesh::corner_table::{EdgeRings, NONE, next, prev};

impl<S: Copy + Default> CollapseSurface<S> {
    /// The very position for the vertex that the edge of `h` becomes, and the input's vertex there, if there is one.
    #[inline]
    pub(super) fn landing(
        &self,
        h: u32,
        rule: MergeRule,
        position: DVec3,
        round: bool,
    ) -> Result<(DVec3, u32), SimplifyRefusal> {
        let [a, b] = self.ends(h);
        let kept = match rule {
            MergeRule::OntoOrigin => Some(a),
            MergeRule::OntoDestination => Some(b),
            MergeRule::Anywhere => [b, a].into_iter().find(|end| end.position == position),
        };
        if let Some(end) = kept {
            return Ok((end.position, end.origin));
        }
        let position = if round { self.on_lattice(position) } else { position };
        if position.is_finite() { Ok((position, NEW)) } else { Err(SimplifyRefusal::NotFinite) }
    }

    /// Gives the destination of `h` the colour of both ends, mixed as near as `position` is to them. `colors` are those
    /// of all vertices, or none.
    pub(super) fn merge_colors(&self, h: u32, position: DVec3, colors: &mut [Option<Color>]) {
        if colors.is_empty() {
            return;
        }
        let ends = [h, next(h)].map(|g| self.table.origin(g));
        let [from, to] = ends.map(|v| colors[v as usize]);
        colors[ends[1] as usize] = blend(from, to, self.share(h, position));
    }

    /// Gives the corners around both ends of `h` the texture coordinates of `position`, as near as it is to the ends.
    pub(super) fn merge_wedges(&mut self, h: u32, rings: &EdgeRings, position: DVec3) {
        if !self.wedges.0.is_empty() {
            let share = self.share(h, position);
            self.wedges.merge(&self.table, rings, h, share);
        }
    }

    /// How far along the edge of `h` a position is: 0 at its origin and before, 1 at its destination and beyond.
    fn share(&self, h: u32, position: DVec3) -> f64 {
        let [a, b] = self.ends(h).map(|end| end.position);
        let length_squared = a.distance_squared(b);
        let share = if length_squared > 0.0 { (position - a).dot(b - a) / length_squared } else { 0.5 };
        share.clamp(0.0, 1.0)
    }

    /// Makes the destination of `h` what both ends become.
    #[inline]
    pub(super) fn merge_vertices<C: CollapseCriterion<State = S>>(
        &mut self,
        criterion: &C,
        h: u32,
        position: DVec3,
        origin: u32,
    ) {
        let [a, b] = self.ends(h);
        let is_line = |h: u32| self.table.marks(h) & LINE != 0;
        let mut merged = *b;
        merged.position = position;
        merged.origin = origin;
        merged.state = criterion.merged([a, b], position);
        merged.is_held |= a.is_held;
        merged.has_aside |= a.has_aside;
        if a.lines != 0 || b.lines != 0 {
            merged.lines += a.lines;
            merged.lines -= if is_line(h) { 2 } else { 0 };
            // Two lines that become one are one less, at both their ends.
            let sides = [h, self.table.twin(h)];
            let doubled = |&side: &u32| side != NONE && is_line(next(side)) && is_line(prev(side));
            let apexes = sides.map(|side| doubled(&side).then(|| self.table.origin(prev(side))));
            for apex in apexes.into_iter().flatten() {
                merged.lines -= 1;
                self.vertices[apex as usize].lines -= 1;
            }
        }
        let b = self.table.destination(h);
        self.vertices[b as usize] = merged;
    }
}
