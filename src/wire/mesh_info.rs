//! A mesh described as JSON: counts, sizes, properties and defects.

use serde::Serialize;
use utoipa::ToSchema;

use super::finite::{finite, point};
use super::mesh_answers::{Proximity, VolumeInterval, Watertight};
use super::unit_hypothesis::UnitHypothesis;
use super::words::{DefectCode, HoleClass, ProximityTest, Severity};
use crate::{analysis, pipeline};

/// A mesh described.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct MeshInfo {
    /// Numbers of elements.
    pub counts: Counts,
    /// Sizes.
    pub measures: Measures,
    /// Properties by name.
    pub properties: Properties,
    /// Whether it is watertight, under the definitions that tools use.
    pub watertight: Watertight,
    /// Which unit its size speaks for; null: it has no size. Nothing is rescaled.
    #[schema(required)]
    pub unit_hypothesis: Option<UnitHypothesis>,
    /// What meets or is near, by vertices, edges and faces; null: not searched (see option `near_mm`),
    /// or given up around vertices with very many faces.
    #[schema(required)]
    pub proximity: Option<Proximity>,
    /// What the boundary loops most likely are.
    pub holes: HoleCounts,
    /// Defects by kind.
    pub defects: Vec<Defect>,
}

/// Numbers of elements.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Counts {
    /// Vertices in the file; for STL: distinct positions.
    pub vertices: u64,
    /// Faces in the file.
    pub faces: u64,
    /// Triangles after polygons are split.
    pub triangles: u64,
    /// Distinct positions that a triangle uses.
    pub welded_vertices: u64,
    /// Edges after welding.
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

/// A box.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: [f64; 3],
    /// Largest coordinates.
    pub max: [f64; 3],
}

/// Sizes, in the unit of the file.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Measures {
    /// Box of the positions that a triangle uses; null: no triangles, or several parts, each in coordinates of its own.
    #[schema(required)]
    pub bounds: Option<Bounds>,
    /// Sum of the triangles' areas.
    #[schema(required)]
    pub area: Option<f64>,
    /// Enclosed volume; null unless every component is closed and coherently oriented.
    #[schema(required)]
    pub volume: Option<f64>,
    /// Where the volume lies; null: nothing bounds one, or `volume` is null and it was not estimated (see `near_mm`).
    #[schema(required)]
    pub volume_interval: Option<VolumeInterval>,
    /// V - E + F after welding.
    pub euler_characteristic: i64,
}

/// Properties that hold after welding.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Properties {
    /// Every edge has exactly two triangles.
    pub closed: bool,
    /// No edge has three triangles or more.
    pub edge_manifold: bool,
    /// Every vertex has one fan.
    pub vertex_manifold: bool,
    /// No edge is run through twice in one direction.
    pub oriented: bool,
    /// No two triangles meet beyond common vertices and edges; null: not searched.
    #[schema(required)]
    pub embedded: Option<bool>,
}

/// Boundary loops by what they most likely are, see `docs/holes.md`.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct HoleCounts {
    /// Two rims that nearly coincide, or a loop with next to nothing inside.
    pub crack: u64,
    /// One face is missing.
    pub missing_face: u64,
    /// Flat holes of more edges.
    pub planar_cut: u64,
    /// Holes that are not flat.
    pub missing_region: u64,
    /// Borders of sheets, mouths of vessels and ends of pipes.
    pub intended_opening: u64,
    /// Chains that do not close, because they meet an edge of three triangles or more.
    pub open_chain: u64,
}

/// All defects of one kind.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Defect {
    /// The kind.
    pub code: DefectCode,
    /// How bad.
    pub severity: Severity,
    /// How many.
    pub count: u64,
    /// There may be more: the search for pairs ended at its bound of work.
    pub is_at_least: bool,
    /// How many of them the result has no longer; null: there is no result to compare with.
    #[schema(required)]
    pub fixed: Option<u64>,
    /// The first ones, at most `samples`.
    pub witnesses: Vec<Witness>,
}

/// Where a defect is.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Witness {
    /// Faces of the file that show it.
    pub faces: Vec<Element>,
    /// Vertices of the file that show it; empty for STL.
    pub vertices: Vec<Element>,
    /// A point of it, in the unit of the file; null: not finite.
    #[schema(required)]
    pub position: Option<[f64; 3]>,
    /// Its own measures.
    pub figures: Vec<Figure>,
    /// Which features meet or are near each other; null: the defect is not of a pair.
    #[schema(required)]
    pub test: Option<ProximityTest>,
    /// What a boundary loop most likely is; its figure `confidence` says how sure that is. Null: another defect, or a chain
    /// that does not close.
    #[schema(required)]
    pub hole: Option<HoleClass>,
}

/// An element of the uploaded file, in its own numbering.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Element {
    /// Number in the file, from 0.
    pub index: u32,
    /// Line in the file, from 1; null: the format has no lines.
    #[schema(required)]
    pub line: Option<u32>,
}

/// A measure by name.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Figure {
    /// What is measured.
    pub name: &'static str,
    /// The value.
    #[schema(required)]
    pub value: Option<f64>,
}

impl MeshInfo {
    /// `remaining`: the mesh that is returned, against which fixed defects are counted.
    pub(super) fn new(inner: &analysis::Analysis, remaining: Option<&analysis::Analysis>) -> Self {
        let defect = |finding: &analysis::Finding| Defect {
            code: finding.code.into(),
            severity: finding.severity.into(),
            count: finding.count,
            is_at_least: finding.is_at_least,
            fixed: remaining.map(|mesh| finding.count.saturating_sub(count_of(mesh, finding.code))),
            witnesses: finding.witnesses.iter().map(Witness::from).collect(),
        };
        Self {
            counts: Counts::from(&inner.counts),
            measures: Measures::of(inner),
            properties: Properties::from(&inner.properties),
            watertight: Watertight::from(&inner.watertight),
            unit_hypothesis: inner.measures.bounds.and_then(UnitHypothesis::of),
            proximity: inner.proximity.as_ref().map(Proximity::from),
            holes: HoleCounts::from(&inner.holes),
            defects: inner.findings.iter().map(defect).collect(),
        }
    }
}

impl MeshInfo {
    /// The uploaded mesh, with a question where its unit is not known. No hypothesis where lengths are not in that unit.
    pub(super) fn with_units_of(mut self, input: &pipeline::InputFacts) -> Self {
        let is_in_file_units = input.units == input.result_units;
        let told = self.unit_hypothesis.take().filter(|_| is_in_file_units);
        self.unit_hypothesis = told.map(|told| told.asking(!input.units_are_stated));
        self
    }
}

fn count_of(mesh: &analysis::Analysis, code: analysis::DefectCode) -> u64 {
    mesh.findings.iter().filter(|finding| finding.code == code).map(|finding| finding.count).sum()
}

impl From<&analysis::HoleCounts> for HoleCounts {
    fn from(inner: &analysis::HoleCounts) -> Self {
        Self {
            crack: inner.cracks,
            missing_face: inner.missing_faces,
            planar_cut: inner.planar_cuts,
            missing_region: inner.missing_regions,
            intended_opening: inner.intended_openings,
            open_chain: inner.open_chains,
        }
    }
}

impl From<&analysis::Counts> for Counts {
    fn from(inner: &analysis::Counts) -> Self {
        Self {
            vertices: inner.vertices,
            faces: inner.faces,
            triangles: inner.triangles,
            welded_vertices: inner.welded_vertices,
            edges: inner.edges,
            components: inner.components,
            closed_components: inner.closed_components,
            boundary_loops: inner.boundary_loops,
            boundary_edges: inner.boundary_edges,
        }
    }
}

impl Measures {
    fn of(analysis: &analysis::Analysis) -> Self {
        let inner = &analysis.measures;
        let bounds = inner.bounds.and_then(|b| Some(Bounds { min: point(&b.min)?, max: point(&b.max)? }));
        Self {
            bounds,
            area: finite(inner.area),
            volume: inner.volume.and_then(finite),
            volume_interval: analysis.volume_interval.as_ref().and_then(VolumeInterval::of),
            euler_characteristic: inner.euler_characteristic,
        }
    }
}

impl From<&analysis::Properties> for Properties {
    fn from(inner: &analysis::Properties) -> Self {
        Self {
            closed: inner.is_closed,
            edge_manifold: inner.is_edge_manifold,
            vertex_manifold: inner.is_vertex_manifold,
            oriented: inner.is_oriented,
            embedded: inner.is_embedded,
        }
    }
}

impl From<&analysis::Witness> for Witness {
    fn from(inner: &analysis::Witness) -> Self {
        let elements = |list: &[analysis::Element]| list.iter().copied().map(Element::from).collect();
        Self {
            faces: elements(&inner.faces),
            vertices: elements(&inner.vertices),
            position: inner.position.and_then(|p| point(&p)),
            figures: inner
                .figures
                .iter()
                .map(|&(name, value)| Figure { name, value: finite(value) })
                .collect(),
            test: inner.test.map(ProximityTest::from),
            hole: inner.hole.map(|guess| guess.class.into()),
        }
    }
}

impl From<analysis::Element> for Element {
    fn from(inner: analysis::Element) -> Self {
        Self { index: inner.index, line: inner.line }
    }
}
