//! The part of a mesh where a value at its vertices is at least some level.

use super::track::Tracked;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use rustc_hash::FxHashMap;

/// Values closer to the level than this share of the cell count as it, so that no sliver is cut off.
const SNAP_SHARE: f64 = 0.2;

/// The part of `mesh` where `values` is at least `level`, its vertices numbered anew. Triangles that the level crosses
/// are cut.
pub(super) fn clip(
    mesh: &Tracked,
    values: &[f64],
    level: f64,
    cell: f64,
    budget: &Budget,
) -> Result<Tracked, Stopped> {
    let above = |v: u32| {
        let rest = values[v as usize] - level;
        if rest.abs() <= SNAP_SHARE * cell { 0.0 } else { rest }
    };
    let mut clipped =
        Clipped { from: mesh, out: Tracked::default(), old: FxHashMap::default(), new: FxHashMap::default() };
    for (n, &t) in mesh.triangles.iter().enumerate() {
        if n.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        let rests = t.map(above);
        if rests.iter().all(|&r| r <= 0.0) {
            continue;
        }
        let mut corners = Vec::with_capacity(4);
        for c in 0..3 {
            let (v, w) = (t[c], t[(c + 1) % 3]);
            let (r, s) = (rests[c], rests[(c + 1) % 3]);
            if r >= 0.0 {
                corners.push(clipped.keep(v));
            }
            if r * s < 0.0 {
                corners.push(clipped.cut(v, w, r / (r - s)));
            }
        }
        clipped
            .out
            .triangles
            .extend((1..corners.len() - 1).map(|k| [corners[0], corners[k], corners[k + 1]]));
    }
    Ok(clipped.out)
}

struct Clipped<'m> {
    from: &'m Tracked,
    out: Tracked,
    old: FxHashMap<u32, u32>,
    new: FxHashMap<(u32, u32), u32>,
}

impl Clipped<'_> {
    fn keep(&mut self, v: u32) -> u32 {
        *self.old.entry(v).or_insert_with(|| {
            self.out.points.push(self.from.points[v as usize]);
            self.out.points.len() as u32 - 1
        })
    }

    fn cut(&mut self, v: u32, w: u32, share: f64) -> u32 {
        *self.new.entry((v.min(w), v.max(w))).or_insert_with(|| {
            let [a, b] = [v, w].map(|v| self.from.points[v as usize]);
            self.out.points.push(a + (b - a) * share);
            self.out.points.len() as u32 - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    #[test]
    fn a_square_is_cut_at_the_level() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let mesh = Tracked { points: points.clone(), triangles: vec![[0, 1, 2], [0, 2, 3]] };
        let values: Vec<f64> = points.iter().map(|p| p.x).collect();
        let half = clip(&mesh, &values, 0.5, 0.1, &Budget::unlimited()).unwrap();
        let area: f64 = half
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| half.points[v as usize]);
                0.5 * (b - a).cross(c - a).z
            })
            .sum();
        assert!((area - 0.5).abs() < 1e-15);
        assert_eq!(half.points.len(), 5, "the two corners kept and the three cut edges");
    }
}
