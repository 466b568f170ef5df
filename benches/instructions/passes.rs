//! The passes, each with the preparation of its input, which is not counted.
//!
//! The body looks whether there was work: a pass that gives up at once is no cheaper pass.

use crate::meshes::{apart, damaged, halves, moved, overlapping, soup, sphere, with_holes};
use meshmend::analysis::{AnalyzeOptions, NearSearch, analyze};
use meshmend::budget::Budget;
use meshmend::certificate::{Depth, certify};
use meshmend::distance::{DistanceOptions, Surface, surface_distance};
use meshmend::formats::{Encoding, ReadOptions, read, write};
use meshmend::geom::DVec3;
use meshmend::mesh::{Boundary, EdgeGroups, Soup, singular_vertices, twins};
use meshmend::pipeline::{Operation, Options, Outcome, run};
use meshmend::printing::{PrintingPolicy, measure};
use meshmend::render::{
    Camera, DrawnEdges, FramedScene, Projection, Scene, SceneFrame, Shade, Style, View, draw, picture,
};
use meshmend::repair::Draft;
use meshmend::repair::fill::{FillOptions, Method, fill};
use meshmend::repair::round::{round_to_coarser, round_where_it_matters};
use meshmend::repair::snap::{SnapOptions, gap_between_rims, snap};
use meshmend::repair::unite::unite;
use meshmend::repair::weld::weld;
use meshmend::simplify::{Mode, SimplifyInput, SimplifyOptions, Target, simplify};
use meshmend::spatial::{Bvh, Search, self_contacts};
use meshmend::wrap::{WrapOptions, wrap};
use std::any::Any;

/// What is counted; its result is dropped after the count.
pub(crate) type Body = Box<dyn FnOnce() -> Box<dyn Any>>;

/// A pass.
pub(crate) struct Pass {
    pub(crate) name: &'static str,
    /// Makes the input and gives what is to be counted.
    pub(crate) prepare: fn() -> Body,
}

/// All of them, in the order of the table.
pub(crate) const PASSES: &[Pass] = &[
    Pass { name: "read-stl", prepare: || reading(Encoding::StlBinary) },
    Pass { name: "read-stl-text", prepare: || reading(Encoding::StlAscii) },
    Pass { name: "read-obj", prepare: || reading(Encoding::Obj) },
    Pass { name: "write-obj", prepare: writing },
    Pass { name: "weld", prepare: welding },
    Pass { name: "edges", prepare: edges },
    Pass { name: "contacts", prepare: || contacts(sphere(128, 52), false) },
    Pass { name: "contacts-crossing", prepare: || contacts(overlapping(64, 26), true) },
    Pass { name: "certificate", prepare: certificate },
    Pass { name: "analysis", prepare: analysis },
    Pass { name: "volume-interval", prepare: volume_interval },
    Pass { name: "printing", prepare: printing },
    Pass { name: "cut-stitch", prepare: cut_stitch },
    Pass { name: "simplify-fast", prepare: || simplifying(Mode::Fast) },
    Pass { name: "simplify-strict", prepare: || simplifying(Mode::Strict) },
    Pass { name: "simplify-guarded", prepare: || simplifying(Mode::Guarded) },
    Pass { name: "fill-minimal", prepare: || filling(Method::Minimal) },
    Pass { name: "fill-smooth", prepare: || filling(Method::Smooth) },
    Pass { name: "fill-rbf", prepare: || filling(Method::Rbf) },
    Pass { name: "unite", prepare: uniting },
    Pass { name: "snap-corners", prepare: || snapping(&apart(&sphere(32, 26), 0.05)) },
    Pass { name: "snap-divided-edges", prepare: || snapping(&halves(64)) },
    Pass { name: "wrap", prepare: wrapping },
    Pass { name: "round", prepare: rounding },
    Pass { name: "round-coarser", prepare: rounding_coarser },
    Pass { name: "distance", prepare: distance },
    Pass { name: "render", prepare: rendering },
    Pass { name: "verify", prepare: verify },
    Pass { name: "repair-damaged", prepare: || repair(&damaged(sphere(64, 26))) },
    Pass { name: "repair-overlapping", prepare: || repair(&overlapping(32, 13)) },
];

fn unlimited() -> Budget {
    Budget::unlimited()
}

/// A body that gives `T`.
fn body<T: 'static>(run: impl FnOnce() -> T + 'static) -> Body {
    Box::new(move || Box::new(run()))
}

fn draft(mesh: &Soup) -> Draft {
    Draft::from_soup(mesh).0
}

fn bytes_of(mesh: &Soup, encoding: Encoding) -> Vec<u8> {
    write(mesh, encoding, &unlimited()).expect("float32")
}

fn reading(encoding: Encoding) -> Body {
    let bytes = bytes_of(&sphere(128, 78), encoding);
    body(move || read(&bytes, encoding, &ReadOptions::default(), &unlimited()).expect("what was written"))
}

fn writing() -> Body {
    let mesh = sphere(128, 78);
    body(move || bytes_of(&mesh, Encoding::Obj))
}

fn welding() -> Body {
    let mut draft = draft(&apart(&sphere(128, 78), 0.0));
    body(move || {
        let changes = weld(&mut draft, &unlimited()).expect("no limit");
        assert!(changes.count("vertices_joined") > 0, "nothing was joined");
        draft
    })
}

fn edges() -> Body {
    let Soup { triangles, positions, .. } = with_holes(sphere(128, 78), 9.0);
    body(move || {
        let (budget, vertices) = (unlimited(), positions.len());
        let groups = EdgeGroups::build(&triangles, vertices, &budget).expect("no limit");
        let boundary = Boundary::trace(&triangles, vertices, &groups, &budget).expect("no limit");
        assert_eq!(boundary.loops.len(), 4, "the holes");
        let twins = twins(&groups, triangles.len(), &budget).expect("no limit");
        let singular = singular_vertices(&triangles, vertices, &twins, &budget).expect("no limit");
        (groups, boundary, singular)
    })
}

fn contacts(mesh: Soup, are_there: bool) -> Body {
    body(move || {
        let (budget, all) = (unlimited(), Search::All { keep: 100 });
        let tree = Bvh::build(&mesh.positions, &mesh.triangles, None, &budget).expect("no limit");
        let found = self_contacts(&mesh.positions, &mesh.triangles, &tree, None, all, &budget);
        let found = found.expect("no limit");
        assert_eq!(found.count > 0, are_there, "{} contacts", found.count);
        found
    })
}

fn certificate() -> Body {
    let bytes = bytes_of(&sphere(64, 52), Encoding::StlBinary);
    body(move || {
        let (options, depth) = (ReadOptions::default(), Depth::Count { samples: 16 });
        let found = certify(&bytes, Encoding::StlBinary, &options, depth, &unlimited()).expect("readable");
        assert!(found.is_printable(), "the sphere is a solid");
        found
    })
}

fn analysis() -> Body {
    let mesh = with_holes(damaged(sphere(64, 52)), 12.0);
    let options = AnalyzeOptions { near: NearSearch::ByDiagonal, ..AnalyzeOptions::default() };
    body(move || {
        let found = analyze(&mesh, None, &options, &unlimited()).expect("no limit");
        assert!(found.has_errors() && found.proximity.is_some(), "all of the report");
        found
    })
}

/// The estimate of a volume that is not defined, by far the dearest part of a report that has one.
fn volume_interval() -> Body {
    let mut mesh = sphere(6, 13);
    mesh.triangles.truncate(138);
    let options = AnalyzeOptions { volume_interval: true, ..AnalyzeOptions::default() };
    body(move || {
        let found = analyze(&mesh, None, &options, &unlimited()).expect("no limit");
        assert!(found.volume_interval.is_some(), "no estimate");
        found
    })
}

fn printing() -> Body {
    let mesh = sphere(32, 26);
    body(move || {
        measure(&mesh, &PrintingPolicy::default(), true, 16, &unlimited()).expect("no limit").expect("a mesh")
    })
}

fn run_on(mesh: &Soup, operation: Operation, is_as_expected: fn(Option<Outcome>) -> bool) -> Body {
    let bytes = bytes_of(mesh, Encoding::Off);
    body(move || {
        let answer = run(operation, &bytes, &Options::default(), &unlimited()).expect("readable");
        assert!(is_as_expected(answer.report.outcome), "{:?}", answer.report.outcome);
        answer
    })
}

fn cut_stitch() -> Body {
    run_on(&damaged(sphere(64, 52)), Operation::CutStitch, |outcome| outcome == Some(Outcome::CutStitched))
}

fn verify() -> Body {
    run_on(&sphere(64, 52), Operation::Verify, |outcome| outcome.is_none())
}

fn repair(mesh: &Soup) -> Body {
    run_on(mesh, Operation::Repair, |outcome| outcome == Some(Outcome::Repaired))
}

fn simplifying(mode: Mode) -> Body {
    let mesh = sphere(64, 26);
    body(move || {
        let input = SimplifyInput::new(&mesh.positions, &mesh.triangles);
        let options = SimplifyOptions { targets: vec![Target::Ratio(0.25)], ..SimplifyOptions::default() };
        let levels = simplify(&input, mode, &options, &unlimited()).expect("a manifold");
        assert!(levels[0].triangles.len() < mesh.triangles.len() / 3, "few triangles are left");
        levels
    })
}

fn filling(method: Method) -> Body {
    let mesh = with_holes(sphere(64, 52), 12.0);
    let mut draft = draft(&mesh);
    let options = FillOptions { method, falls_back: false, ..FillOptions::default() };
    body(move || {
        let before = draft.triangles.len();
        let filled = fill(&mut draft, &mesh, &options, &unlimited()).expect("no limit");
        assert!(draft.triangles.len() > before, "nothing was filled");
        (draft, filled)
    })
}

fn uniting() -> Body {
    let mut draft = draft(&overlapping(64, 26));
    body(move || {
        let changes = unite(&mut draft, &unlimited()).expect("no limit");
        assert!(changes.coverage.is_some(), "not united");
        (draft, changes)
    })
}

/// Finds how far apart the rims are and joins them.
fn snapping(mesh: &Soup) -> Body {
    let mut draft = draft(mesh);
    body(move || {
        let budget = unlimited();
        let epsilon = gap_between_rims(&draft, 0.35, &budget).expect("no limit");
        assert!(epsilon.is_some(), "no rims side by side");
        let options = SnapOptions { epsilon, by_edge: true, ..SnapOptions::default() };
        let before = draft.positions.len();
        let changes = snap(&mut draft, &options, &budget).expect("no limit");
        assert!(draft.positions.len() < before, "nothing was joined");
        (draft, changes)
    })
}

fn wrapping() -> Body {
    let mesh = sphere(64, 26);
    body(move || {
        let options = WrapOptions { cells: 24, ..WrapOptions::default() };
        wrap(&mesh.positions, &mesh.triangles, &options, &unlimited()).expect("a wrap")
    })
}

/// Coordinates that no float32 holds, of a sphere on another one that is a thousandth of a step of float32 larger.
fn doubles() -> Draft {
    let mesh = sphere(64, 26);
    let scaled = |by: f64| mesh.positions.iter().map(move |&p| p / 3.0 * by).collect::<Vec<DVec3>>();
    let shells = [scaled(1.0), scaled(1.0 + 1e-10)];
    let [outer, inner] = shells.map(|positions| soup(positions, mesh.triangles.clone()));
    draft(&crate::meshes::together(outer, &inner))
}

fn rounding() -> Body {
    let mut draft = doubles();
    body(move || {
        let changes = round_where_it_matters(&mut draft, &unlimited()).expect("no limit");
        assert!(changes.count("vertices_moved") > 0, "nothing was rounded");
        draft
    })
}

fn rounding_coarser() -> Body {
    let mut draft = doubles();
    body(move || {
        let changes = round_to_coarser(&mut draft, 32, &unlimited()).expect("no limit");
        assert!(changes.count("vertices_moved") > 0, "nothing was rounded");
        draft
    })
}

fn distance() -> Body {
    let (fine, coarse) = (sphere(96, 52), moved(sphere(32, 26), DVec3::new(0.1, 0.2, 0.3)));
    body(move || {
        let [a, b] = [&fine, &coarse].map(|m| Surface { positions: &m.positions, triangles: &m.triangles });
        let options = DistanceOptions { samples: 4096, ..DistanceOptions::default() };
        surface_distance(a, b, &options, &unlimited()).expect("no limit").expect("two meshes")
    })
}

fn rendering() -> Body {
    let mesh = sphere(64, 52);
    body(move || {
        let budget = unlimited();
        let palette = [[185, 194, 203]];
        let scene = Scene {
            positions: &mesh.positions,
            triangles: &mesh.triangles,
            palette: &palette,
            ..Scene::default()
        };
        let frame = SceneFrame::around([scene.bounds()]);
        let model = FramedScene::of(scene, frame, Shade::Smooth, &budget).expect("no limit");
        let direction = View::Iso.direction();
        let camera = Camera::at(&[&model], direction, Projection::Orthographic, 4.0 / 3.0, &budget);
        let style = Style { edges: DrawnEdges::Creases, background: [255; 3], back: Some([207, 63, 54]) };
        let canvas = draw(&model, &camera.expect("no limit"), 320, 240, &style, &budget).expect("no limit");
        picture(&canvas)
    })
}
