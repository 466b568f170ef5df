//! Small meshes for the tests of the defects, and tests of the description as a whole.

use super::*;
use crate::geom::DVec3;
use crate::mesh::Polygons;

/// A soup of `triangles` over `vertex_count` vertices in general position: no three on a line, no four in a plane.
pub(super) fn soup(vertex_count: u32, triangles: &[[u32; 3]]) -> Soup {
    let on_moment_curve = |i: u32| DVec3::new(f64::from(i), f64::from(i * i), f64::from(i * i * i));
    Soup {
        positions: (0..vertex_count).map(on_moment_curve).collect(),
        triangles: triangles.to_vec(),
        face_count: triangles.len() as u32,
        ..Soup::default()
    }
}

/// A tetrahedron with legs along the axes from `corner`, outward.
pub(super) fn tetrahedron(corner: DVec3, size: f64) -> Soup {
    let mut mesh = soup(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    mesh.positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|leg| corner + leg * size).to_vec();
    mesh
}

/// The soup inside out.
pub(super) fn turned(mut soup: Soup) -> Soup {
    soup.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    soup
}

/// Several soups in one, each with vertices of its own.
pub(super) fn joined(soups: &[Soup]) -> Soup {
    let mut all = Soup::default();
    for soup in soups {
        let first = all.positions.len() as u32;
        all.positions.extend(&soup.positions);
        all.triangles.extend(soup.triangles.iter().map(|t| t.map(|v| first + v)));
        all.face_count += soup.face_count;
    }
    all
}

/// One polygon with these corners, split as a fan.
pub(super) fn polygon(corners: &[DVec3]) -> Soup {
    let n = corners.len() as u32;
    Soup {
        positions: corners.to_vec(),
        triangles: (2..n).map(|i| [0, i - 1, i]).collect(),
        triangle_face: vec![0; corners.len() - 2],
        face_count: 1,
        polygons: Polygons {
            faces: vec![0],
            starts: vec![0, n],
            corners: (0..n).collect(),
            first_triangles: vec![0],
            not_fans: Vec::new(),
        },
        ..Soup::default()
    }
}

/// What is said of `soup` where no two triangles are known to meet.
pub(super) fn described(soup: &Soup) -> Analysis {
    assert_eq!(soup.check(), Vec::<String>::new());
    analyze(soup, Some(&Contacts::default()), &AnalyzeOptions::default(), &Budget::unlimited()).unwrap()
}

/// What is said of `soup` after a search for triangles that meet.
pub(super) fn searched(soup: &Soup) -> Analysis {
    assert_eq!(soup.check(), Vec::<String>::new());
    analyze(soup, None, &AnalyzeOptions::default(), &Budget::unlimited()).unwrap()
}

/// The finding of this kind, if there is one.
pub(super) fn found(soup: &Soup, code: DefectCode) -> Option<Finding> {
    described(soup).findings.into_iter().find(|f| f.code == code)
}

#[test]
fn a_tetrahedron_has_nothing_to_be_told_and_every_property() {
    let told = searched(&tetrahedron(DVec3::ZERO, 1.0));
    assert_eq!(told.findings, []);
    let counts = Counts {
        vertices: 4,
        faces: 4,
        triangles: 4,
        welded_vertices: 4,
        edges: 6,
        components: 1,
        closed_components: 1,
        boundary_loops: 0,
        boundary_edges: 0,
    };
    assert_eq!(told.counts, counts);
    let properties = Properties {
        is_closed: true,
        is_edge_manifold: true,
        is_vertex_manifold: true,
        is_oriented: true,
        is_embedded: Some(true),
    };
    assert_eq!(told.properties, properties);
}

#[test]
fn findings_come_in_the_order_of_their_codes() {
    let mut mesh = joined(&[tetrahedron(DVec3::ZERO, 1.0), turned(tetrahedron(DVec3::splat(0.5), 3.0))]);
    mesh.positions.extend([DVec3::NAN, DVec3::splat(9.0)]);
    mesh.non_finite_vertices = vec![8];
    mesh.triangles.extend([[0, 1, 3], [1, 1, 2]]);
    mesh.face_count += 2;
    let codes: Vec<DefectCode> = searched(&mesh).findings.iter().map(|f| f.code).collect();
    assert!(codes.is_sorted(), "{codes:?}");
    assert!(codes.len() > 5, "{codes:?}");
}

#[test]
fn an_empty_soup_is_described_too() {
    let told = searched(&Soup::default());
    assert_eq!(told.counts, Counts::default());
    assert_eq!(told.measures.bounds, None);
    assert_eq!(told.findings.iter().map(|f| f.code).collect::<Vec<_>>(), [DefectCode::NoTriangle]);
}

#[test]
fn as_many_witnesses_are_kept_as_asked() {
    let pages: Vec<[u32; 3]> = (0..40).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    for samples in [0, 3, 100] {
        let told = analyze(
            &soup(120, &pages),
            Some(&Contacts::default()),
            &AnalyzeOptions { samples, ..AnalyzeOptions::default() },
            &Budget::unlimited(),
        );
        let finding =
            told.unwrap().findings.into_iter().find(|f| f.code == DefectCode::IsolatedFace).unwrap();
        assert_eq!((finding.count, finding.witnesses.len()), (40, samples.min(40)));
    }
}

#[test]
fn a_stopped_budget_ends_the_description() {
    let budget = Budget::unlimited();
    let stop = crate::budget::StopFlag::default();
    stop.cancel();
    let stopped = Budget::new(stop, u64::MAX, u64::MAX);
    let mesh = tetrahedron(DVec3::ZERO, 1.0);
    assert!(analyze(&mesh, None, &AnalyzeOptions::default(), &budget).is_ok());
    assert_eq!(analyze(&mesh, None, &AnalyzeOptions::default(), &stopped), Err(Stopped::Cancelled));
}
