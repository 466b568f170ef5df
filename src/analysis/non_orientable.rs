//! Non-orientable parts: no way of turning their faces makes all of them agree (a Möbius band, a Klein bottle).

use super::welded::Welded;
use super::{Context, DefectCode, Finding};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{NO_TWIN, ParityUnionFind, edge_of, triangle_of};

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    // Without a conflict as the faces are, they agree.
    if mesh.irregular_where(|triangles| triangles == 2).is_empty() {
        return Ok(Vec::new());
    }
    let (_, twists) = sides(mesh, cx.budget)?;
    Ok(Finding::of(DefectCode::NonOrientable, &twists, cx.samples, |&h| {
        let faces = [h, mesh.twins[h as usize]].map(|h| mesh.face_of(triangle_of(h)));
        let ends = edge_of(&mesh.triangles, h);
        let middle = mesh.position(ends[0]) / 2.0 + mesh.position(ends[1]) / 2.0;
        mesh.names().witness(faces, ends, middle)
    }))
}

/// Which triangles must be turned so that those on both sides of edges of two agree, relative to each other; and a half-edge
/// across which they cannot, for each part that has one.
pub(super) fn sides(mesh: &Welded<'_>, budget: &Budget) -> Result<(ParityUnionFind, Vec<u32>), Stopped> {
    let mut sides = ParityUnionFind::new(mesh.triangles.len());
    let mut is_twisted = vec![false; mesh.parts.len()];
    let mut twists = Vec::new();
    for (h, &twin) in mesh.twins.iter().enumerate() {
        if h % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let h = h as u32;
        if twin == NO_TWIN || twin < h {
            continue;
        }
        let are_opposite = edge_of(&mesh.triangles, h)[0] == edge_of(&mesh.triangles, twin)[0];
        let part = mesh.components.of[triangle_of(h) as usize] as usize;
        if !sides.relate(triangle_of(h), triangle_of(twin), are_opposite) && !is_twisted[part] {
            is_twisted[part] = true;
            twists.push(h);
        }
    }
    Ok((sides, twists))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    #[test]
    fn a_moebius_band_of_five_faces_cannot_be_oriented() {
        let band: Vec<[u32; 3]> = (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect();
        assert_eq!(found(&soup(5, &band), DefectCode::NonOrientable).unwrap().count, 1);
    }

    #[test]
    fn a_face_turned_over_can_be_turned_back() {
        let turned = soup(4, &[[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        assert_eq!(found(&turned, DefectCode::NonOrientable), None);
    }
}
