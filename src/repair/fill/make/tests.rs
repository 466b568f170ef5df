//! What the areas of plates are limited to.

use super::*;

/// The area of the faired patch in a round rim, as a share of the disk, where the surface around stands `height` above
/// the middles of the rim's edges.
fn share(height: f64, limit: f64) -> f64 {
    let corners = 24u32;
    let at = |i: f64, radius: f64, z: f64| {
        let turn = i * std::f64::consts::TAU / f64::from(corners);
        DVec3::new(radius * turn.cos(), radius * turn.sin(), z)
    };
    let rim = (0..corners).map(|i| at(f64::from(i), 1.0, 0.0)).collect();
    let mut mesh = PatchMesh::new(rim, (1..corners - 1).map(|i| [0, i, i + 1]).collect()).unwrap();
    let disk = mesh.area();
    let next: Vec<u32> = (0..corners).map(|i| (i + 1) % corners).collect();
    let around = PatchSurroundings {
        points: (0..corners).map(|i| at(f64::from(i) + 0.5, 1.02, height)).collect(),
        triangles: (0..corners).map(|i| [(i + 1) % corners, i, corners + i]).collect(),
        is_clamped: vec![true; corners as usize],
    };
    let unlimited = Budget::unlimited();
    assert!(refine_and_fair(&mut mesh, &next, &around, limit * disk, &|_, _| true, &unlimited).unwrap());
    mesh.area() / disk
}

#[test]
fn a_plate_that_swings_out_without_long_edges_is_drawn_in_where_its_area_tells() {
    let [free, drawn] = [f64::INFINITY, 1.02].map(|limit| share(1.0, limit));
    assert!(free > 1.04, "{free}");
    assert!(drawn < 0.99 * free, "{drawn}");
}

#[test]
fn a_plate_that_stays_small_is_the_same_with_and_without_a_limit() {
    let [free, drawn] = [f64::INFINITY, AreaLimits::OF_AUTO.plate].map(|limit| share(0.2, limit));
    assert_eq!(free, drawn);
}

#[test]
fn auto_takes_half_a_ball_and_no_balloon_and_who_asks_gets_both() {
    // A cone over a square with an apex at this height, beside the square.
    let admit = |limits: AreaLimits, height: f64| {
        let rim = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let mut mesh = PatchMesh::new(rim.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap();
        let base_area = mesh.area();
        let diagonal = (0..6).find(|&h| mesh.twin(h).is_some()).unwrap();
        mesh.split(diagonal, DVec3::new(0.0, 0.0, height)).unwrap();
        limits.admit(&mesh, base_area)
    };
    // The area is that of the square times the root of 1 + 2 h².
    for (height, is_taken) in [(0.0, true), (1.2, true), (1.45, false), (5.0, false)] {
        assert_eq!(admit(AreaLimits::OF_AUTO, height), is_taken, "{height}");
        assert!(admit(AreaLimits::NONE, height), "{height}");
    }
}
