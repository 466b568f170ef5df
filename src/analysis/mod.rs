//! Read-only description of a mesh as it is: counts, measures and findings with witnesses. Never fails on content.

mod around;
mod best_plane;
mod boundary_loops;
mod closed;
mod coincident_corners;
mod collinear_faces;
mod defect;
mod double_skins;
mod duplicate_faces;
mod duplicate_vertices;
mod folded_edges;
mod isolated_edges;
mod isolated_faces;
mod isolated_vertices;
mod measures;
mod meeting_features;
mod meeting_point;
mod members;
mod names;
mod nested_shells;
mod noise_shells;
mod non_manifold_edges;
mod non_manifold_vertices;
mod non_orientable;
mod open_sheets;
mod orientation_conflicts;
mod polygons;
mod proximity;
mod proximity_test;
mod self_intersections;
mod shells;
mod sum;
mod thin_faces;
mod unusable;
mod volume_interval;
mod watertight;
mod welded;

pub use boundary_loops::{HoleClass, HoleCounts, HoleGuess};
pub use defect::{DefectCode, Element, Finding, Severity, Witness};
pub use proximity::{Proximity, TestCounts};
pub use proximity_test::ProximityTest;
pub use volume_interval::VolumeInterval;
pub use watertight::Watertight;

use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, are_collinear};
use crate::mesh::{Soup, singular_vertices};
use crate::par;
use crate::spatial::{Contacts, NearPairs};
use boundary_loops::BoundaryLoops;
use duplicate_faces::{Repeat, repeats};
use members::Members;
use names::middle;
use shells::{OrientedShell, shells};
use std::borrow::Cow;
use welded::{Welded, indices_where, used_vertices};

/// Numbers of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Vertices in the file (for STL: distinct positions).
    pub vertices: u64,
    /// Faces in the file.
    pub faces: u64,
    /// Triangles after polygons are split.
    pub triangles: u64,
    /// Distinct positions that a triangle uses. From here on, triangles with coincident corners do not count.
    pub welded_vertices: u64,
    /// Undirected edges after welding.
    pub edges: u64,
    /// Parts connected by edges after welding.
    pub components: u64,
    /// Components without boundary and without non-manifold edges.
    pub closed_components: u64,
    /// Loops of boundary edges.
    pub boundary_loops: u64,
    /// Edges with one triangle.
    pub boundary_edges: u64,
}

/// Sizes, in the unit of the file, after the weld and without triangles with coincident corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Box of the positions that a triangle uses; `None` without triangles.
    pub bounds: Option<Aabb>,
    /// Sum of the faces' areas; that of a face of more than three corners is half the norm of the sum of the cross products
    /// of neighbouring corners about its centroid.
    pub area: f64,
    /// Enclosed volume; `None` unless every component is closed and coherently oriented, and when it is out of range.
    pub volume: Option<f64>,
    /// V - E + F after welding.
    pub euler_characteristic: i64,
}

/// Properties that tools and customers ask for by name, after the weld and without triangles with coincident corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Properties {
    /// Every edge has exactly two triangles.
    pub is_closed: bool,
    /// No edge has three triangles or more.
    pub is_edge_manifold: bool,
    /// Every vertex has one fan.
    pub is_vertex_manifold: bool,
    /// No edge is run through twice in one direction.
    pub is_oriented: bool,
    /// No two triangles meet beyond common vertices and edges, degenerate ones left out; `None` when the search was not
    /// made.
    pub is_embedded: Option<bool>,
}

/// The description of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// Numbers of elements.
    pub counts: Counts,
    /// Sizes.
    pub measures: Measures,
    /// Where the volume lies; `None`: nothing bounds one, or it is not defined and an estimate was not asked for.
    pub volume_interval: Option<VolumeInterval>,
    /// Properties by name.
    pub properties: Properties,
    /// Watertightness under several definitions.
    pub watertight: Watertight,
    /// What meets or is near, by features; `None`: not asked for, or given up.
    pub proximity: Option<Proximity>,
    /// How many boundary loops are of which class.
    pub holes: HoleCounts,
    /// Defects, by code.
    pub findings: Vec<Finding>,
    /// Half-edges of the soup with the number of the boundary loop that each is in, ascending; empty unless asked for.
    pub loop_edges: Vec<[u32; 2]>,
}

impl Analysis {
    /// True when a finding says that the file is not a valid solid.
    pub fn has_errors(&self) -> bool {
        self.findings.iter().any(|finding| finding.severity == Severity::Error)
    }
}

/// What to find out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnalyzeOptions {
    /// Most witnesses to keep of each defect.
    pub samples: usize,
    /// Witnesses to keep of boundary loops where these are to be more.
    pub loop_samples: usize,
    /// Whether the edges of boundary loops are listed.
    pub loop_edges: bool,
    /// Whether features are searched that are near each other.
    pub near: NearSearch,
    /// Whether a volume that is not defined is estimated.
    pub volume_interval: bool,
}

impl Default for AnalyzeOptions {
    fn default() -> Self {
        Self {
            samples: 16,
            loop_samples: 0,
            loop_edges: false,
            near: NearSearch::Off,
            volume_interval: false,
        }
    }
}

/// Whether features are searched that are near each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NearSearch {
    /// They are not.
    Off,
    /// Those within 1e-5 of the diagonal.
    ByDiagonal,
    /// Those within this distance, in the unit of the file.
    Within(f64),
}

/// Describes `soup`. `known_contacts` are its self-contacts where a certificate has found them already (counted as by
/// [`Search::Most`](crate::spatial::Search::Most), at least `samples` of each kind kept where there are that many); otherwise they are searched here.
///
/// # Errors
/// Only when the budget stops the run.
pub fn analyze(
    soup: &Soup,
    known_contacts: Option<&Contacts>,
    options: &AnalyzeOptions,
    budget: &Budget,
) -> Result<Analysis, Stopped> {
    let _memory = budget.charge(
        soup.triangles.len() as u64 * BYTES_PER_TRIANGLE + soup.positions.len() as u64 * BYTES_PER_VERTEX,
    )?;
    let cx = Context::of(soup, known_contacts, options, budget)?;
    let (measures, findings) =
        par::join(|| Measures::of(&cx), || par::map_items(CHECKS.to_vec(), |_, find| find(&cx)));
    let findings = findings.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
    let measures = measures?;
    let estimate = || volume_interval::volume_interval(&cx, measures.volume, options.volume_interval);
    let estimate = budget.within(ESTIMATE_WORK.min(budget.work_left() / ESTIMATE_PART), estimate)?;
    Ok(Analysis {
        counts: Counts::of(&cx, &findings),
        volume_interval: estimate.flatten(),
        measures,
        properties: Properties::of(&cx),
        watertight: Watertight::of(&cx)?,
        proximity: Proximity::of(&cx)?,
        holes: cx.loops.counts(),
        loop_edges: if options.loop_edges { cx.loops.edges(&cx) } else { Vec::new() },
        findings,
    })
}

/// Units of work of an estimate of the volume, at most, and at most one of so many parts of what is left; where that is not
/// enough there is none. Most meshes take a tenth.
const ESTIMATE_WORK: u64 = 1 << 27;
const ESTIMATE_PART: u64 = 4;

/// Edges 18, twins 12, components 4 and members 4, and 8 for lists that come and go.
const BYTES_PER_TRIANGLE: u64 = 46;

/// First vertex at each position 4, use 5, and 8 for lists that come and go.
const BYTES_PER_VERTEX: u64 = 17;

/// What is near by default, as a share of the diagonal of the box around all.
const NEAR_SHARE: f64 = 1e-5;

/// Looks for defects of one kind, or a few that go together.
type DefectDetector = fn(&Context<'_>) -> Result<Vec<Finding>, Stopped>;

/// Every check, in the order of [`DefectCode`].
const CHECKS: [DefectDetector; 21] = [
    unusable::find,
    polygons::find,
    coincident_corners::find,
    collinear_faces::find,
    thin_faces::find,
    duplicate_faces::find,
    isolated_vertices::find,
    isolated_edges::find,
    duplicate_vertices::find,
    isolated_faces::find,
    boundary_loops::find,
    non_manifold_edges::find,
    non_manifold_vertices::find,
    orientation_conflicts::find,
    non_orientable::find,
    folded_edges::find,
    nested_shells::find,
    open_sheets::find,
    noise_shells::find,
    self_intersections::find,
    proximity::find,
];

/// What the checks share, found once.
struct Context<'a> {
    mesh: Welded<'a>,
    /// Vertices that the mesh uses, ascending.
    used: Vec<u32>,
    /// Triangles of the mesh with three corners on one line, ascending.
    collinear: Vec<u32>,
    /// Triangles of the mesh that are there already, ascending.
    repeats: Vec<Repeat>,
    /// Vertices of the mesh with more than one fan, ascending.
    singular: Vec<u32>,
    members: Members,
    shells: Vec<OrientedShell>,
    /// Parts with a rim that bound no volume, ascending; `None`: not known.
    sheets: Option<Vec<u32>>,
    /// The boundary loops, classified.
    loops: BoundaryLoops,
    /// Box of the used vertices.
    bounds: Option<Aabb>,
    /// Sides and features closer than this are near, in the unit of the file.
    epsilon: f64,
    /// Pairs of the soup's triangles.
    contacts: Cow<'a, Contacts>,
    /// Features that are near each other; `None` where they were not searched.
    near: Option<NearPairs>,
    samples: usize,
    loop_samples: usize,
    budget: &'a Budget,
}

impl<'a> Context<'a> {
    fn of(
        soup: &'a Soup,
        known_contacts: Option<&'a Contacts>,
        options: &AnalyzeOptions,
        budget: &'a Budget,
    ) -> Result<Self, Stopped> {
        let mesh = Welded::of(soup, budget)?;
        let vertex_count = soup.positions.len();
        let vertices = || {
            let is_used = used_vertices(&mesh.triangles, vertex_count, budget)?;
            let used = indices_where(vertex_count, budget, |v| is_used[v])?;
            Ok((used, singular_vertices(&mesh.triangles, vertex_count, &mesh.twins, budget)?))
        };
        let faces = || {
            let is_collinear = |t: usize| {
                let [a, b, c] = mesh.corners(t as u32);
                are_collinear(a, b, c)
            };
            Ok((indices_where(mesh.triangles.len(), budget, is_collinear)?, repeats(&mesh, budget)?))
        };
        let solids = || {
            let members = Members::of(&mesh, budget)?;
            let shells = shells(&mesh, &members, budget)?;
            Ok((members, shells))
        };
        let (vertices, (faces, solids)) = par::join(vertices, || par::join(faces, solids));
        let ((used, singular), (collinear, repeats), (members, shells)) = (vertices?, faces?, solids?);
        let contacts = match known_contacts {
            Some(known) => Cow::Borrowed(known),
            None => Cow::Owned(self_intersections::search(&mesh, &collinear, &repeats, budget)?),
        };
        let contacts = duplicate_faces::without_copies(contacts, &mesh, &repeats);
        let bounds = measures::bounds(&mesh, &used, budget)?;
        let epsilon = match options.near {
            NearSearch::Within(epsilon) => epsilon,
            NearSearch::Off | NearSearch::ByDiagonal => NEAR_SHARE * bounds.map_or(0.0, Aabb::diagonal),
        };
        let mut cx = Self {
            mesh,
            used,
            collinear,
            repeats,
            singular,
            members,
            shells,
            sheets: None,
            loops: BoundaryLoops::default(),
            bounds,
            epsilon,
            contacts,
            near: None,
            samples: options.samples,
            loop_samples: options.samples.max(options.loop_samples),
            budget,
        };
        cx.sheets = open_sheets::search(&cx)?;
        cx.loops = boundary_loops::search(&cx)?;
        cx.near = proximity::search(&cx, options.near)?;
        Ok(cx)
    }

    /// Whether part `p` is known to be an open sheet.
    fn is_sheet(&self, p: u32) -> bool {
        self.sheets.as_ref().is_some_and(|sheets| sheets.binary_search(&p).is_ok())
    }

    /// A witness of part `p`: its first faces, and how many triangles it has.
    fn part_witness(&self, p: u32) -> Witness {
        let (mesh, members) = (&self.mesh, self.members.part(p));
        let faces = members.iter().map(|&t| mesh.face_of(t));
        let first = members[0];
        let mut witness =
            mesh.names().witness(faces, mesh.triangles[first as usize], middle(mesh.corners(first)));
        witness.figures = vec![("triangles", members.len() as f64)];
        witness.anchor = Some(3 * mesh.source(first));
        witness
    }
}

impl Counts {
    fn of(cx: &Context<'_>, findings: &[Finding]) -> Self {
        let mesh = &cx.mesh;
        let count = |code| findings.iter().find(|f| f.code == code).map_or(0, |f| f.count);
        Self {
            vertices: mesh.soup.positions.len() as u64,
            faces: u64::from(mesh.soup.face_count),
            triangles: mesh.soup.triangles.len() as u64,
            welded_vertices: cx.used.len() as u64,
            edges: mesh.edges.len() as u64,
            components: mesh.parts.len() as u64,
            closed_components: mesh.parts.iter().filter(|part| part.is_closed).count() as u64,
            boundary_loops: count(DefectCode::BoundaryLoop),
            boundary_edges: mesh.irregular_where(|triangles| triangles == 1).len() as u64,
        }
    }
}

impl Properties {
    fn of(cx: &Context<'_>) -> Self {
        let mesh = &cx.mesh;
        Self {
            is_closed: mesh.parts.iter().all(|part| part.is_closed),
            is_edge_manifold: mesh.irregular_where(|triangles| triangles > 2).is_empty(),
            is_vertex_manifold: cx.singular.is_empty(),
            is_oriented: mesh.parts.iter().all(|part| part.is_oriented),
            is_embedded: Some(cx.contacts.count == 0 && cx.repeats.is_empty()),
        }
    }
}

#[cfg(test)]
mod tests;
