//! Triangles that meet beyond the vertices and edges they share: they pass through each other, overlap in one plane, or
//! touch. Degenerate triangles and repeats of earlier ones are left out; they are told as such.

use super::duplicate_faces::Repeat;
use super::meeting_features::{FeatureMeeting, PolygonSides, meetings};
use super::meeting_point::meeting_point;
use super::welded::{Welded, indices_where};
use super::{Context, DefectCode, Finding, ProximityTest};
use crate::budget::{Budget, Stopped};
use crate::spatial::{Bvh, ContactKind, Contacts, Search, TriangleContact, self_contacts};

/// Most pairs kept of a search, 12 bytes each; more are counted.
const KEEP: usize = 1 << 16;

/// Searches the contacts of `mesh`, as triangles of its soup.
pub(super) fn search(
    mesh: &Welded<'_>,
    collinear: &[u32],
    repeats: &[Repeat],
    budget: &Budget,
) -> Result<Contacts, Stopped> {
    let is_left_out = |t: u32| {
        collinear.binary_search(&t).is_ok() || repeats.binary_search_by_key(&t, |r| r.triangle).is_ok()
    };
    let sound = indices_where(mesh.triangles.len(), budget, |t| !is_left_out(t as u32))?;
    let positions = &mesh.soup.positions;
    let ids = (sound.len() < mesh.triangles.len()).then_some(sound.as_slice());
    let bvh = Bvh::build(positions, &mesh.triangles, ids, budget)?;
    let mut contacts =
        self_contacts(positions, &mesh.triangles, &bvh, None, Search::Most { keep: KEEP }, budget)?;
    for contact in &mut contacts.list {
        (contact.a, contact.b) = (mesh.source(contact.a), mesh.source(contact.b));
    }
    Ok(contacts)
}

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let soup = cx.mesh.soup;
    let found = |code, kind| {
        let pairs = || cx.contacts.list.iter().filter(|c| c.kind == kind).take(cx.samples);
        let sides = PolygonSides::of(cx, pairs());
        let witness = |pair: &TriangleContact| {
            let faces = [pair.a, pair.b].map(|t| soup.face_of(t));
            // The lowest one in which they meet.
            let lowest = meetings(cx, &sides, pair).into_iter().next();
            let vertices: Vec<u32> = match &lowest {
                Some(meeting) if meeting.test != ProximityTest::FaceFace => meeting.vertices().collect(),
                _ => soup.triangles[pair.a as usize].to_vec(),
            };
            let place = match lowest {
                Some(FeatureMeeting {
                    test: ProximityTest::VertexEdge | ProximityTest::VertexFace, ..
                }) => soup.positions[vertices[0] as usize],
                _ => meeting_point(soup.corners(pair.a), soup.corners(pair.b)),
            };
            let mut witness = cx.mesh.names().witness(faces, vertices, place);
            witness.test = lowest.map(|meeting| meeting.test);
            witness
        };
        let count = cx.contacts.count_by_kind[kind as usize];
        let mut found = Finding::with(code, count, pairs().map(witness).collect());
        found.iter_mut().for_each(|finding| finding.is_at_least = cx.contacts.is_cut_short);
        found
    };
    Ok([
        found(DefectCode::SelfIntersection, ContactKind::Cross),
        found(DefectCode::Overlap, ContactKind::Overlap),
        found(DefectCode::Touch, ContactKind::Touch),
    ]
    .concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{joined, searched, tetrahedron};
    use crate::geom::DVec3;
    use crate::mesh::Soup;

    /// Number of pairs that cross, overlap, touch, and the first witness of them.
    fn told(mesh: &Soup) -> [u64; 3] {
        let told = searched(mesh);
        let codes = [DefectCode::SelfIntersection, DefectCode::Overlap, DefectCode::Touch];
        let counts = codes.map(|code| told.findings.iter().find(|f| f.code == code).map_or(0, |f| f.count));
        assert_eq!(told.properties.is_embedded, Some(counts == [0; 3]));
        counts
    }

    #[test]
    fn a_tip_crosses_a_face_or_touches_it_or_stays_below() {
        let floor = tetrahedron(DVec3::ZERO, 10.0);
        for (height, wanted) in [(1.0, [3, 0, 0]), (0.0, [0, 0, 3]), (-1.0, [0, 0, 0])] {
            let mut tip = tetrahedron(DVec3::new(2.0, 2.0, -10.0), 1.0);
            tip.positions[3] = DVec3::new(2.0, 2.0, height);
            assert_eq!(told(&joined(&[floor.clone(), tip])), wanted, "height {height}");
        }
    }

    #[test]
    fn a_crossing_is_shown_by_both_faces_at_a_place_in_both() {
        let mesh = joined(&[tetrahedron(DVec3::ZERO, 10.0), tetrahedron(DVec3::new(1.0, 1.0, -1.0), 3.0)]);
        let crossing =
            searched(&mesh).findings.into_iter().find(|f| f.code == DefectCode::SelfIntersection).unwrap();
        let witness = &crossing.witnesses[0];
        assert_eq!(witness.faces.len(), 2);
        assert_eq!((witness.faces[0].index, witness.faces[1].index), (0, 5));
        assert!(witness.position.unwrap().z.abs() < 1e-9, "{witness:?}");
    }

    #[test]
    fn repeats_and_degenerate_faces_are_told_as_such_only() {
        let mut mesh = tetrahedron(DVec3::ZERO, 1.0);
        mesh.triangles.extend([[0, 1, 3], [2, 2, 3]]);
        mesh.face_count += 2;
        let told = searched(&mesh);
        assert!(told.findings.iter().all(|f| f.code < DefectCode::SelfIntersection), "{told:?}");
        assert_eq!(told.properties.is_embedded, Some(false));
    }
}
