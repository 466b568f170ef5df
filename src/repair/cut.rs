//! Cuts marked edges and singular vertices. The copies stay at their positions, so a reader that welds joins them again.

use super::{Changes, Draft, Effects};
use crate::budget::{Budget, Stopped};
use crate::mesh::{self, ChosenEdges, CutMarks, CutMethod};

/// How to cut.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CutOptions {
    /// `None`: whichever costs less. The result is the same.
    pub method: Option<CutMethod>,
    /// Cut besides those that must be.
    pub chosen: ChosenEdges,
}

/// Makes the draft a coherently oriented manifold with boundary by copying singular vertices.
///
/// # Errors
/// When the budget stops the run.
pub fn cut(draft: &mut Draft, options: &CutOptions, budget: &Budget) -> Result<Changes, Stopped> {
    let vertex_count = draft.positions.len();
    let groups = draft.edge_groups(budget)?;
    let chosen = chosen_in(draft, &options.chosen);
    let marks = CutMarks::find(&draft.triangles, vertex_count, &groups, &chosen, budget)?;
    drop(groups);
    let method = options.method.unwrap_or_else(|| CutMethod::cheaper(&marks, draft.triangles.len()));
    let copies = mesh::cut(&mut draft.triangles, vertex_count, &marks, method, budget)?;
    for &v in &copies {
        draft.positions.push(draft.positions[v as usize]);
        draft.vertex_origin.push(draft.vertex_origin[v as usize]);
    }
    let changes = Changes::counted([
        ("singular_edges", marks.singular_edges),
        ("edges_in_conflict", marks.conflicting_edges),
        ("chosen_edges", marks.chosen_edges),
        ("isolated_singular_vertices", marks.isolated_vertices),
        ("vertices_copied", copies.len() as u64),
    ]);
    let effects = Effects { copied_vertices: !copies.is_empty(), ..Effects::default() };
    Ok(Changes { reason: reason(&marks, method, options.method.is_some(), vertex_count), effects, ..changes })
}

/// The chosen edges as vertices of the draft.
fn chosen_in(draft: &Draft, chosen: &ChosenEdges) -> ChosenEdges {
    if *chosen == ChosenEdges::default() {
        return ChosenEdges::default();
    }
    let mut places: Vec<(u32, u32)> = draft.vertex_origin.iter().copied().zip(0..).collect();
    places.sort_unstable();
    let find = |origin: u32| {
        let at = places.partition_point(|&(o, _)| o < origin);
        places.get(at).filter(|&&(o, _)| o == origin).map(|&(_, v)| v)
    };
    ChosenEdges::of(chosen.iter().filter_map(|[a, b]| Some([find(a)?, find(b)?])))
}

fn reason(marks: &CutMarks, method: CutMethod, is_asked: bool, vertex_count: usize) -> String {
    let singular = marks.vertices().len();
    if singular == 0 {
        return String::new();
    }
    let name = match method {
        CutMethod::Global => "globally",
        CutMethod::Local => "locally",
    };
    let why = if is_asked { "as asked" } else { "which costs less here" };
    format!("cut {name}, {why}: {singular} of {vertex_count} vertices come apart")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    fn two_fans() -> Draft {
        Draft {
            positions: (0..5).map(|i| DVec3::splat(f64::from(i))).collect(),
            vertex_origin: vec![10, 11, 12, 13, 14],
            triangles: vec![[0, 1, 2], [0, 3, 4]],
            triangle_origin: vec![0, 1],
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    #[test]
    fn copies_keep_position_and_origin() {
        let mut draft = two_fans();
        let changes = cut(&mut draft, &CutOptions::default(), &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("vertices_copied"), changes.count("isolated_singular_vertices")), (1, 1));
        assert_eq!((draft.positions[5], draft.vertex_origin[5]), (DVec3::ZERO, 10));
        assert!(draft.check().is_empty());
    }

    #[test]
    fn what_ran_is_said() {
        for (method, words) in [
            (Some(CutMethod::Global), "cut globally, as asked: 1 of 5 vertices come apart"),
            (Some(CutMethod::Local), "cut locally, as asked: 1 of 5 vertices come apart"),
            (None, "cut locally, which costs less here: 1 of 5 vertices come apart"),
        ] {
            let options = CutOptions { method, ..CutOptions::default() };
            assert_eq!(cut(&mut two_fans(), &options, &Budget::unlimited()).unwrap().reason, words);
        }
    }

    #[test]
    fn chosen_edges_are_named_by_the_vertices_of_the_file() {
        let mut draft = Draft { triangles: vec![[0, 1, 2], [2, 1, 3], [3, 1, 4]], ..two_fans() };
        draft.triangle_origin = vec![0, 1, 2];
        let chosen = ChosenEdges::of([[12, 11], [99, 11], [11, 12]]);
        let options = CutOptions { chosen, ..CutOptions::default() };
        let changes = cut(&mut draft, &options, &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("chosen_edges"), 1);
        assert_eq!(draft.triangles, [[0, 1, 2], [5, 6, 3], [3, 6, 4]]);
    }
}
