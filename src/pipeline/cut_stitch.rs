//! Cutting and stitching: a manifold with boundary from any mesh, written and judged as it is.

use super::input::Input;
use super::output::{Made, unchanged};
use super::plan::{Attempt, Step};
use super::{Action, Answer, Failure, Operation, Options, Outcome, Report};
use crate::budget::{Budget, CHECK_EVERY, Stage, Stopped};
use crate::formats::{Encoding, Format};
use crate::mesh::{ChosenEdges, CutMethod, Soup, UnionFind, Validity, triangle_of};
use crate::repair::cut::CutOptions;
use crate::repair::duplicates::OppositePairs;
use crate::repair::polygons::DegenerateFaces;
use crate::repair::snap::SnapOptions;
use crate::repair::{Draft, Faced};
use crate::spatial::coincident_f64;

/// How a mesh is cut and stitched.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CutStitchChoices {
    /// Vertices at one position stay apart unless the file gives them one number.
    pub keeps_copies: bool,
    /// How the cut is made; `None`: whichever costs less. The result is the same.
    pub method: Option<CutMethod>,
    /// Which boundary edges are joined.
    pub stitching: Stitching,
    /// Largest distance of vertices that snapping joins, in the unit of the file; `None`: 1e-5 of the diagonal.
    pub epsilon: Option<f64>,
    /// When two edges may be joined.
    pub validity: Validity,
    /// What becomes of faces that pass a vertex more than once.
    pub degenerate: DegenerateFaces,
    /// Edges to be cut besides those that must be, by the numbers of their vertices in the file. They stay cut.
    pub chosen: Vec<[u32; 2]>,
}

/// Which boundary edges are joined after a cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Stitching {
    /// None.
    None,
    /// Those that the cut has parted, along each boundary from where it turns back on itself.
    #[default]
    Pinch,
    /// All whose ends are close to each other.
    Snap,
}

impl CutStitchChoices {
    /// The steps, in their order; `chosen` are the edges as [`Step::Weld`] leaves them, where it is one of them.
    fn steps(&self, chosen: ChosenEdges) -> Vec<Step> {
        let split = Step::SplitPolygons(self.degenerate);
        let weld = (!self.keeps_copies).then_some(Step::Weld);
        let clear = [Step::DropDegenerate, Step::DropDuplicates(OppositePairs::KeepFirst)];
        let before = [split].into_iter().chain(weld).chain(clear);
        let cut = Step::Cut(CutOptions { method: self.method, chosen: chosen.clone() });
        let snap = SnapOptions {
            epsilon: self.epsilon,
            validity: self.validity,
            chosen: chosen.clone(),
            keeps_winding: false,
        };
        let (insert, join) = match self.stitching {
            Stitching::None => (None, None),
            Stitching::Pinch => (None, Some(Step::Pinch(chosen, self.validity))),
            Stitching::Snap => (Some(Step::SplitTVertices), Some(Step::Snap(snap))),
        };
        before.chain(insert).chain([Step::Orient, cut]).chain(join).collect()
    }

    /// The chosen edges by the vertices that stand for theirs after the weld, if there is one: of those at one position, the
    /// first that a triangle of `whole` uses. Edges of other vertices are left out.
    fn chosen_of(&self, whole: &Draft, budget: &Budget) -> Result<ChosenEdges, Stopped> {
        if self.chosen.is_empty() {
            return Ok(ChosenEdges::default());
        }
        let places = coincident_f64(&whole.positions, budget)?;
        let find = |v: u32| {
            // Ascending: vertices that no triangle uses are left out and the others keep their order.
            let used = whole.vertex_origin.binary_search(&v).ok()?;
            let first =
                if self.keeps_copies { used as u32 } else { places.first[places.group[used] as usize] };
            Some(whole.vertex_origin[first as usize])
        };
        Ok(ChosenEdges::of(self.chosen.iter().filter_map(|&[a, b]| Some([find(a)?, find(b)?]))))
    }
}

/// Cuts and stitches `input`; one that this does not change comes back as it is.
pub(super) fn cut_stitch(input: &Input, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let report = input.report(Operation::CutStitch, budget)?;
    let before = report.before.as_ref();
    let mut attempt = Attempt::start_with_polygons(&input.soup, before);
    let _charge = budget.charge(3 * attempt.draft.bytes())?;
    let (whole, _) = Draft::with_polygons(&input.soup);
    let steps = options.cut_stitch.steps(options.cut_stitch.chosen_of(&whole, budget)?);
    budget.stage(Stage::Repair, || attempt.run(&steps, &input.soup, before, budget))?;
    let Attempt { draft, mut actions, .. } = attempt;
    let has_changed = draft != whole || !input.soup.face_faults.is_empty();
    drop(whole);
    let encoding = input.output_encoding(options);
    if !has_changed && input.may_come_back_as(encoding) {
        let report = Report { actions, ..report };
        return Ok(unchanged(input, options, report, Outcome::CutStitched));
    }
    let (faced, restored) = faces_of(draft, &input.soup, encoding, budget)?;
    actions.extend(restored);
    let report = Report { actions, ..report };
    let made = Made { soup: faced.soup, origins: &faced.origins, outcome: |_| Outcome::CutStitched };
    made.returned(input, options, report, budget)
}

/// The draft as what a file of this `encoding` holds, and what is told of it when the `source` has polygons.
fn faces_of(
    draft: Draft,
    source: &Soup,
    encoding: Encoding,
    budget: &Budget,
) -> Result<(Faced, Option<Action>), Stopped> {
    if draft.polygons.is_empty() {
        let soup = draft.to_soup(source);
        return Ok((Faced { soup, origins: draft.triangle_origin, polygons_split: 0 }, None));
    }
    let faces = draft.face_count() as u64;
    let components = components(&draft, budget)?;
    let (faced, polygons, reason) = match encoding.format() {
        Format::Stl => {
            let soup = draft.to_soup(source);
            let polygons_split = draft.polygons.polygon_count();
            let faced = Faced { soup, origins: draft.triangle_origin, polygons_split };
            (faced, 0, "STL holds triangles alone")
        }
        Format::Obj | Format::Off | Format::Ply => {
            let faced = draft.to_faces(source, budget)?;
            let polygons = faced.soup.polygons.faces.len() as u64;
            let reason = match faced.polygons_split {
                0 => "",
                _ => {
                    "polygons that are not flat any more, and that readers would split into another surface, are triangles"
                }
            };
            (faced, polygons, reason)
        }
    };
    let changes = vec![
        ("faces", faces),
        ("components", components),
        ("polygons", polygons),
        ("polygons_split", faced.polygons_split),
    ];
    let (step, reason) = ("restore-polygons", reason.to_owned());
    let action = Action { step, causes: Vec::new(), changes, move_max: 0.0, reason, stitches: None };
    Ok((faced, Some(action)))
}

/// Number of parts that edges of faces connect.
fn components(draft: &Draft, budget: &Budget) -> Result<u64, Stopped> {
    let groups = draft.edge_groups(budget)?;
    let mut parts = UnionFind::new(draft.triangles.len());
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        for pair in group.windows(2) {
            parts.unite(triangle_of(pair[0]), triangle_of(pair[1]));
        }
    }
    Ok(u64::from(parts.into_components().count))
}
