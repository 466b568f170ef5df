//! Gives open sheets a wall: the sheet stays one side of it, bit for bit, a copy behind it is the other.

use super::{Changes, Draft, NEW};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::figures::figure;
use crate::geom::{DVec3, print_pitch};
use crate::mesh::{EdgeGroups, edge_of, triangle_of};

/// Steps of the print lattice that a wall has at least.
const STEPS_MIN: f64 = 64.0;

/// How much farther than the wall a vertex at a crease may be drawn, so that its planes stay as far from each other.
const MITRE_MAX: f64 = 3.0;

/// Thickens every part of `draft` that has a boundary to `wall`, in the unit of the file, against the direction of its
/// faces. The draft must be a manifold with boundary (see [`cut`](super::cut::cut)).
///
/// ```text
///     a ─────── b            the rim of the sheet, as a triangle of it runs from a to b,
///     │ ╲       │            and the wall that joins it to the copy behind
///     a'─────── b'
/// ```
///
/// Where a sheet is narrower than its wall, the copy behind it is folded: it turns around what it bounds, which would be taken out of
/// a body that is there. So folded walls beside closed parts are made sound by themselves, with `unite`: they become what they
/// wind around at least once.
///
/// # Errors
/// When the budget stops the run.
pub fn thicken(
    draft: &mut Draft,
    wall: f64,
    unite: impl Fn(&mut Draft, &Budget) -> Result<Changes, Stopped>,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    let reach = draft.positions.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach)) + wall;
    let pitch = print_pitch(reach).filter(|pitch| wall >= STEPS_MIN * pitch);
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let (mut is_open, count) = open_parts(&groups, budget)?;
    let (Some(pitch), false) = (pitch, count == 0) else {
        return Ok(counted(0, 0));
    };
    let behind = places_behind(draft, &is_open, wall, budget)?;
    let mut copy = vec![u32::MAX; draft.positions.len()];
    for (v, place) in behind.into_iter().enumerate() {
        let Some(place) = place else { continue };
        copy[v] = draft.positions.len() as u32;
        draft.positions.push(place.map(|x| (x / pitch).round_ties_even() * pitch));
        draft.vertex_origin.push(draft.vertex_origin[v]);
    }
    let rims = groups.iter().filter_map(|group| if let [h] = *group { Some(h) } else { None });
    let walls: Vec<[u32; 3]> = rims
        .flat_map(|h| {
            let [a, b] = edge_of(&draft.triangles, h);
            let [a_behind, b_behind] = [a, b].map(|v| copy[v as usize]);
            [[b, a, a_behind], [b, a_behind, b_behind]]
        })
        .collect();
    let sheets = draft.triangles.iter().zip(&is_open).filter(|&(_, &is_open)| is_open);
    let copies = sheets.map(|(&[a, b, c], _)| [a, c, b].map(|v| copy[v as usize]));
    let added: Vec<[u32; 3]> = copies.chain(walls).collect();
    let triangles = added.len();
    draft.triangles.extend(added);
    draft.triangle_origin.extend(std::iter::repeat_n(NEW, triangles));
    if is_open.contains(&false) && has_folds(draft, &is_open) {
        is_open.resize(draft.triangles.len(), true);
        unite_apart(draft, &is_open, unite, budget)?;
    }
    let reason = format!("open parts are read as sheets and given walls of {} behind them", figure(wall));
    Ok(Changes { reason, ..counted(count, triangles as u64) })
}

/// Whether the copy of a marked triangle turns the other way than the triangle. The copies come after all triangles that
/// `is_marked` knows, in their order.
fn has_folds(draft: &Draft, is_marked: &[bool]) -> bool {
    let normal_of = |t: usize| {
        let [a, b, c] = draft.corners(t);
        (b - a).cross(c - a)
    };
    let marked = (0..is_marked.len()).filter(|&t| is_marked[t]);
    marked.zip(is_marked.len()..).any(|(t, copy)| normal_of(t).dot(normal_of(copy)) >= 0.0)
}

/// Unites the marked triangles as if there were no others.
fn unite_apart(
    draft: &mut Draft,
    is_marked: &[bool],
    unite: impl Fn(&mut Draft, &Budget) -> Result<Changes, Stopped>,
    budget: &Budget,
) -> Result<(), Stopped> {
    let _charge = budget.charge(draft.bytes())?;
    let mut marked = draft.clone();
    marked.retain_triangles(is_marked);
    unite(&mut marked, budget)?;
    draft.retain_triangles(&is_marked.iter().map(|is_marked| !is_marked).collect::<Vec<bool>>());
    draft.drop_unused_vertices();
    let first = draft.positions.len() as u32;
    draft.positions.extend(marked.positions);
    draft.vertex_origin.extend(marked.vertex_origin);
    draft.triangles.extend(marked.triangles.into_iter().map(|corners| corners.map(|v| v + first)));
    draft.triangle_origin.extend(marked.triangle_origin);
    draft.blends = marked.blends;
    Ok(())
}

fn counted(sheets: u64, triangles: u64) -> Changes {
    Changes::counted([("sheets_thickened", sheets), ("triangles_added", triangles)])
}

/// Whether each triangle is of a part with a boundary, and the number of such parts.
fn open_parts(groups: &EdgeGroups, budget: &Budget) -> Result<(Vec<bool>, u64), Stopped> {
    let parts = groups.components(budget)?;
    let mut is_open = vec![false; parts.count as usize];
    for group in groups.iter() {
        if let &[h] = group {
            is_open[parts.of[triangle_of(h) as usize] as usize] = true;
        }
    }
    let count = is_open.iter().filter(|&&is_open| is_open).count() as u64;
    Ok((parts.of.iter().map(|&part| is_open[part as usize]).collect(), count))
}

/// For each vertex of the marked triangles, the place at the distance `wall` behind their planes: exactly so where they lie
/// in two planes at most, and between them where there are more.
fn places_behind(
    draft: &Draft,
    is_marked: &[bool],
    wall: f64,
    budget: &Budget,
) -> Result<Vec<Option<DVec3>>, Stopped> {
    let marked = || (0..draft.triangles.len()).filter(|&t| is_marked[t]);
    let mut sum = vec![DVec3::ZERO; draft.positions.len()];
    let mut facing = vec![(0.0, 0.0); draft.positions.len()];
    let mut is_used = vec![false; draft.positions.len()];
    let normal_of = |t: usize| {
        let [a, b, c] = draft.corners(t);
        (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()).normalize_or_zero()
    };
    let angle_at = |t: usize, k: usize| {
        let corners = draft.corners(t);
        let sides = [corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]];
        let [a, b] = sides.map(DVec3::normalize_or_zero);
        libm::atan2(a.cross(b).length(), a.dot(b))
    };
    for (i, t) in marked().enumerate() {
        if i % CHECK_EVERY == 0 {
            budget.check()?;
        }
        for k in 0..3 {
            sum[draft.triangles[t][k] as usize] += normal_of(t) * angle_at(t, k);
        }
    }
    for (i, t) in marked().enumerate() {
        if i % CHECK_EVERY == 0 {
            budget.check()?;
        }
        for k in 0..3 {
            let v = draft.triangles[t][k] as usize;
            let (cosine, weight) = &mut facing[v];
            let angle = angle_at(t, k);
            is_used[v] = true;
            *cosine += angle * normal_of(t).dot(sum[v].normalize_or_zero());
            *weight += angle;
        }
    }
    let place = |v: usize| {
        let (cosine, weight) = facing[v];
        let mitre = if cosine > 0.0 { (weight / cosine).clamp(1.0, MITRE_MAX) } else { MITRE_MAX };
        is_used[v].then(|| draft.positions[v] - sum[v].normalize_or_zero() * (wall * mitre))
    };
    Ok((0..draft.positions.len()).map(place).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the volume.
    fn volume(draft: &Draft) -> f64 {
        (0..draft.triangles.len())
            .map(|t| {
                let [a, b, c] = draft.corners(t);
                a.dot(b.cross(c))
            })
            .sum::<f64>()
    }

    fn leave(_: &mut Draft, _: &Budget) -> Result<Changes, Stopped> {
        Ok(Changes::default())
    }

    fn is_closed(draft: &Draft) -> bool {
        let groups =
            EdgeGroups::build(&draft.triangles, draft.positions.len(), &Budget::unlimited()).unwrap();
        groups.iter().all(|group| match *group {
            [g, h] => edge_of(&draft.triangles, g)[0] != edge_of(&draft.triangles, h)[0],
            _ => false,
        })
    }

    #[test]
    fn a_triangle_becomes_a_prism_whose_top_is_the_triangle() {
        let mut mesh = Draft::of(&[[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]], &[[0, 1, 2]]);
        let changes = thicken(&mut mesh, 0.25, leave, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("sheets_thickened"), changes.count("triangles_added")), (1, 7));
        assert_eq!((mesh.triangles[0], mesh.triangles.len()), ([0, 1, 2], 8));
        assert!(is_closed(&mesh) && mesh.check().is_empty());
        assert_eq!(volume(&mesh), 0.75, "an eighth");
    }

    #[test]
    fn both_leaves_of_a_fold_get_the_same_wall() {
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 1.0, 1.0],
        ];
        // The floor points up, the back points to +x: behind them is the outside of the corner.
        let mut mesh = Draft::of(&points, &[[0, 1, 2], [0, 2, 3], [0, 3, 5], [0, 5, 4]]);
        thicken(&mut mesh, 0.125, leave, &Budget::unlimited()).unwrap();
        assert!(is_closed(&mesh));
        let corner = mesh.positions[6];
        assert!((corner - DVec3::new(-0.125, 0.0, -0.125)).length() < 1e-6, "{corner}");
    }

    #[test]
    fn a_triangle_with_a_repeated_or_no_own_side_does_not_matter() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
        let mut mesh = Draft::of(&points, &[[0, 1, 2], [1, 3, 4], [2, 2, 0]]);
        thicken(&mut mesh, 0.25, leave, &Budget::unlimited()).unwrap();
        assert!(mesh.check().is_empty());
    }

    #[test]
    fn what_is_closed_or_would_get_no_wall_stays() {
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut closed = Draft::of(&points, &tetrahedron);
        assert_eq!(
            thicken(&mut closed, 0.1, leave, &Budget::unlimited()).unwrap().count("sheets_thickened"),
            0
        );
        assert_eq!(closed.triangles, tetrahedron);
        let mut thin = Draft::of(&points, &[[0, 2, 1]]);
        assert_eq!(
            thicken(&mut thin, 1e-7, leave, &Budget::unlimited()).unwrap().count("sheets_thickened"),
            0
        );
    }

    #[test]
    fn only_walls_that_are_folded_beside_closed_parts_are_united_by_themselves() {
        // A tetrahedron, and a lid of two steep sides, each 0.1 from the ridge between them.
        let points = [
            [5.0, 0.0, 0.0],
            [6.0, 0.0, 0.0],
            [5.0, 1.0, 0.0],
            [5.0, 0.0, 1.0],
            [-0.1, 0.0, 0.0],
            [0.1, 0.0, 0.0],
            [-0.1, 1.0, 0.0],
            [0.1, 1.0, 0.0],
            [0.0, 0.0, 0.2],
            [0.0, 1.0, 0.2],
        ];
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let lid = [[4, 8, 9], [4, 9, 6], [5, 7, 9], [5, 9, 8], [4, 5, 8], [6, 9, 7]];
        let united = std::cell::Cell::new(0);
        let count = |walls: &mut Draft, _: &Budget| {
            united.set(walls.triangles.len());
            Ok(Changes::default())
        };
        let mut beside = Draft::of(&points, &[&tetrahedron[..], &lid].concat());
        thicken(&mut beside, 0.5, count, &Budget::unlimited()).unwrap();
        assert_eq!(united.take(), beside.triangles.len() - 4, "the walls and nothing else");
        assert!(is_closed(&beside) && beside.check().is_empty());
        let mut thin = Draft::of(&points, &[&tetrahedron[..], &lid].concat());
        thicken(&mut thin, 0.01, count, &Budget::unlimited()).unwrap();
        let mut alone = Draft::of(&points, &lid);
        thicken(&mut alone, 0.5, count, &Budget::unlimited()).unwrap();
        assert_eq!(united.get(), 0, "no fold, or nothing beside");
    }
}
