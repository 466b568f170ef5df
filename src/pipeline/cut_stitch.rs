//! Cutting and stitching: a manifold with boundary from any mesh, written and judged as it is.

use super::input::Input;
use super::output::{OperationMesh, unchanged};
use super::plan::Attempt;
use super::step::Step;
use super::{Action, Answer, Failure, Operation, Options, Outcome, Report};
use crate::budget::{Budget, Stage, Stopped};
use crate::formats::Format;
use crate::mesh::{ChosenEdges, CutMethod, StitchValidity};
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
    pub validity: StitchValidity,
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
            by_edge: false,
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
    check_chosen(&options.cut_stitch.chosen, input.soup.positions.len())?;
    let report = input.report(Operation::CutStitch, budget)?;
    let before = report.before.as_ref();
    let mut attempt = Attempt::start_with_polygons(&input.soup, before);
    let _charge = budget.charge(3 * attempt.draft.bytes())?;
    let (whole, _) = Draft::with_polygons(&input.soup);
    let steps = options.cut_stitch.steps(options.cut_stitch.chosen_of(&whole, budget)?);
    budget.stage(Stage::Repair, || attempt.run(&steps, &input.soup, before, budget))?;
    let Attempt { draft, actions, .. } = attempt;
    let has_changed = draft != whole || !input.soup.face_faults.is_empty();
    drop(whole);
    let encoding = input.output_encoding(options);
    if !has_changed && input.may_come_back_as(encoding) {
        let report = Report { actions, ..report };
        return Ok(unchanged(input, options, report, Outcome::CutStitched));
    }
    let form = match encoding.format() {
        _ if draft.polygons.is_empty() => Form::Triangles,
        Format::Stl => Form::Split("STL holds triangles alone"),
        Format::Glb | Format::Gltf => Form::Split("glTF holds triangles alone"),
        Format::ThreeMf => Form::Split("3MF holds triangles alone"),
        Format::Obj | Format::Off | Format::Ply => Form::Polygons,
    };
    written(&draft, form, input, options, Report { actions, ..report }, budget)
}

/// Edges can only be cut between vertices that the file has.
fn check_chosen(chosen: &[[u32; 2]], vertices: usize) -> Result<(), Failure> {
    let unknown = chosen.as_flattened().iter().find(|&&v| v as usize >= vertices);
    unknown.map_or(Ok(()), |v| {
        let reason =
            format!("cut_edges names vertex {v}, but the file has {vertices} vertices, numbered from 0");
        Err(Failure::NotApplicable { option: "cut_edges", reason })
    })
}

/// What becomes of polygons in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    /// There are none.
    Triangles,
    /// They stay as far as a reader makes the same surface of them.
    Polygons,
    /// All become triangles, for this reason.
    Split(&'static str),
}

/// The draft written and judged.
fn written(
    draft: &Draft,
    form: Form,
    input: &Input,
    options: &Options,
    mut report: Report,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let as_triangles = |polygons_split| Faced {
        soup: draft.to_soup(&input.soup),
        origins: draft.triangle_origin.clone(),
        polygons_split,
    };
    let (faced, reason) = match form {
        Form::Triangles => (as_triangles(0), ""),
        Form::Split(reason) => (as_triangles(draft.polygons.polygon_count()), reason),
        Form::Polygons => {
            let faced = draft.to_faces(&input.soup, budget)?;
            let reason = match faced.polygons_split {
                0 => "",
                _ => "polygons are triangles where readers would split them into another surface",
            };
            (faced, reason)
        }
    };
    if form != Form::Triangles {
        report.actions.push(restored(draft, &faced, reason, budget)?);
    }
    let made = OperationMesh { soup: faced.soup, origins: &faced.origins, outcome: |_| Outcome::CutStitched };
    made.returned(input, options, report, budget)
}

/// What is told of the faces that are written of a file with polygons.
fn restored(draft: &Draft, faced: &Faced, reason: &str, budget: &Budget) -> Result<Action, Stopped> {
    let changes = vec![
        ("faces", draft.face_count() as u64),
        ("components", u64::from(draft.edge_groups(budget)?.components(budget)?.count)),
        ("polygons", faced.soup.polygons.faces.len() as u64),
        ("polygons_split", faced.polygons_split),
    ];
    let (step, reason) = ("restore-polygons", reason.to_owned());
    Ok(Action { step, causes: Vec::new(), changes, move_max: 0.0, reason, stitches: None })
}
