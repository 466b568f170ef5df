//! Whether a mesh is watertight, under the definitions that tools use; they differ in which vertices are one.

use super::closed::is_closed;
use super::welded::indices_where;
use super::{Context, proximity};
use crate::budget::Stopped;
use crate::spatial::coincident_f32;

/// Whether every edge has exactly two triangles, under four definitions of what a vertex is. Triangles with two equal
/// vertices are left out; a mesh without others is not watertight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Watertight {
    /// By the vertex numbers as written; `None` for formats without any.
    pub by_index: Option<bool>,
    /// With vertices at bit-equal positions joined.
    pub after_exact_weld: bool,
    /// With vertices joined that are near each other; `None` when that was not searched.
    pub after_epsilon_weld: Option<bool>,
    /// With coordinates rounded to float32, and equal ones joined.
    pub in_float32: bool,
}

impl Watertight {
    pub(super) fn of(cx: &Context<'_>) -> Result<Self, Stopped> {
        let mesh = &cx.mesh;
        let after_exact_weld = !mesh.triangles.is_empty() && mesh.parts.iter().all(|part| part.is_closed);
        Ok(Self {
            by_index: by_index(cx, after_exact_weld)?,
            after_exact_weld,
            after_epsilon_weld: proximity::is_closed_when_joined(cx)?,
            in_float32: in_float32(cx, after_exact_weld)?,
        })
    }
}

fn by_index(cx: &Context<'_>, after_exact_weld: bool) -> Result<Option<bool>, Stopped> {
    let soup = cx.mesh.soup;
    if soup.is_welded_by_format {
        return Ok(None);
    }
    if cx.mesh.has_distinct_positions() {
        return Ok(Some(after_exact_weld));
    }
    is_closed(&soup.triangles, |v| v, cx.budget).map(Some)
}

fn in_float32(cx: &Context<'_>, after_exact_weld: bool) -> Result<bool, Stopped> {
    let mesh = &cx.mesh;
    let rounded = |v: usize| mesh.position(v as u32).to_array().map(|x| x as f32);
    let used = &cx.used;
    let mut group = vec![0; used.len()];
    let _charge = cx.budget.charge(used.len() as u64 * 8)?;
    let is_beyond = |i: usize| rounded(used[i] as usize).iter().any(|x| !x.is_finite());
    if !indices_where(used.len(), cx.budget, is_beyond)?.is_empty() {
        return Ok(false);
    }
    let first = coincident_f32(|i| rounded(used[i] as usize), &mut group, cx.budget)?;
    if first.len() == used.len() {
        return Ok(after_exact_weld);
    }
    let mut of_vertex = vec![0; mesh.soup.positions.len()];
    for (&v, &group) in used.iter().zip(&group) {
        of_vertex[v as usize] = group;
    }
    is_closed(&mesh.triangles, |v| of_vertex[v as usize], cx.budget)
}

#[cfg(test)]
mod tests {
    use crate::analysis::tests::{described, soup, tetrahedron};
    use crate::analysis::{AnalyzeOptions, NearSearch, Watertight, analyze};
    use crate::budget::Budget;
    use crate::geom::DVec3;
    use crate::mesh::Soup;
    use crate::spatial::Contacts;

    fn told(mesh: &Soup) -> [Option<bool>; 4] {
        let options = AnalyzeOptions { near: NearSearch::ByDiagonal, ..AnalyzeOptions::default() };
        let told = analyze(mesh, Some(&Contacts::default()), &options, &Budget::unlimited()).unwrap();
        let Watertight { by_index, after_exact_weld, after_epsilon_weld, in_float32 } = told.watertight;
        [by_index, Some(after_exact_weld), after_epsilon_weld, Some(in_float32)]
    }

    /// A tetrahedron one face of which has a last corner of its own, `apart` from the others'.
    fn torn(apart: f64) -> Soup {
        let mut mesh = tetrahedron(DVec3::ZERO, 1.0);
        mesh.positions.push(mesh.positions[3] + DVec3::Z * apart);
        mesh.triangles[1] = [0, 1, 4];
        mesh
    }

    #[test]
    fn each_definition_joins_more_than_the_one_before() {
        let [yes, no] = [Some(true), Some(false)];
        assert_eq!(told(&tetrahedron(DVec3::ZERO, 1.0)), [yes, yes, yes, yes]);
        assert_eq!(told(&torn(0.0)), [no, yes, yes, yes]);
        assert_eq!(told(&torn(1e-9)), [no, no, yes, yes]);
        assert_eq!(told(&torn(1e-6)), [no, no, yes, no]);
        assert_eq!(told(&torn(1e-3)), [no, no, no, no]);
        assert_eq!(told(&soup(3, &[[0, 1, 2]])), [no, no, no, no]);
    }

    #[test]
    fn a_format_without_vertices_has_no_answer_by_index_nor_one_by_epsilon_without_a_search() {
        let mut mesh = tetrahedron(DVec3::ZERO, 1.0);
        mesh.is_welded_by_format = true;
        assert_eq!(told(&mesh)[0], None);
        assert_eq!(described(&mesh).watertight.after_epsilon_weld, None);
        assert!(!described(&Soup::default()).watertight.after_exact_weld);
    }

    #[test]
    fn a_thin_solid_closes_up_in_float32() {
        let mut thin = tetrahedron(DVec3::splat(1.0), 1.0);
        thin.positions[3] = DVec3::new(1.0, 1.0, 1.0 + 1e-10);
        assert_eq!(told(&thin)[3], Some(true), "two faces on each other");
        let far = tetrahedron(DVec3::splat(1e300), 1e299);
        assert_eq!(told(&far)[3], Some(false), "no such float32");
    }
}
