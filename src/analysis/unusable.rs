//! What cannot be used: coordinates that are not finite, faces with vertices that are not there or with too few corners,
//! which the readers found and which here get their names; and files in which no triangle is left at all.

use super::names::ElementNames;
use super::{Context, DefectCode, Finding};
use crate::budget::Stopped;
use crate::geom::DVec3;
use crate::mesh::{FaceFault, FaceFaultReason};

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let soup = cx.mesh.soup;
    let names = ElementNames::of(soup);
    let nothing = Finding::with(DefectCode::NoTriangle, u64::from(cx.mesh.triangles.is_empty()), Vec::new());
    let vertices = Finding::of(DefectCode::NonFiniteVertex, &soup.non_finite_vertices, cx.samples, |&v| {
        names.witness([], [v], DVec3::NAN)
    });
    let faces =
        [FaceFaultReason::NonFinite, FaceFaultReason::IndexOutOfRange, FaceFaultReason::TooFewCorners].map(
            |reason| {
                let faults: Vec<FaceFault> =
                    soup.face_faults.iter().copied().filter(|f| f.reason == reason).collect();
                Finding::of(code(reason), &faults, cx.samples, |fault| {
                    names.witness([fault.face], [], DVec3::NAN)
                })
            },
        );
    Ok([nothing, vertices, faces.concat()].concat())
}

fn code(reason: FaceFaultReason) -> DefectCode {
    match reason {
        FaceFaultReason::NonFinite => DefectCode::NonFiniteFace,
        FaceFaultReason::IndexOutOfRange => DefectCode::IndexOutOfRange,
        FaceFaultReason::TooFewCorners => DefectCode::TooFewCorners,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};
    use crate::mesh::Soup;

    #[test]
    fn a_mesh_without_a_triangle_of_three_positions_is_nothing() {
        assert_eq!(found(&Soup::default(), DefectCode::NoTriangle).unwrap().count, 1);
        assert_eq!(found(&soup(2, &[[0, 1, 1]]), DefectCode::NoTriangle).unwrap().count, 1);
        assert_eq!(found(&soup(3, &[[0, 1, 2]]), DefectCode::NoTriangle), None);
    }

    #[test]
    fn each_unusable_face_is_told_with_its_reason() {
        let mut mesh = soup(3, &[[0, 1, 2]]);
        mesh.face_count = 4;
        let reasons =
            [FaceFaultReason::TooFewCorners, FaceFaultReason::NonFinite, FaceFaultReason::IndexOutOfRange];
        mesh.face_faults = reasons
            .into_iter()
            .enumerate()
            .map(|(i, reason)| FaceFault { face: i as u32 + 1, reason })
            .collect();
        for (face, wanted) in
            [(1, DefectCode::TooFewCorners), (2, DefectCode::NonFiniteFace), (3, DefectCode::IndexOutOfRange)]
        {
            let finding = found(&mesh, wanted).unwrap();
            assert_eq!((finding.count, finding.witnesses[0].faces[0].index), (1, face));
        }
    }
}
