//! The options of every operation: one table for query parameters, JSON members and command-line flags.

#![allow(rustdoc::broken_intra_doc_links, reason = "the sentences are those of the help, which are no links")]

mod error;
mod lookup;
mod nearest;
#[macro_use]
mod row;
mod parse;
mod table;
#[cfg(test)]
mod tests;
mod value;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::holes::{BAND_RINGS_MAX, ChosenHole, Holes, may_fit_a_field};
use super::input_ref::InputRef;
use super::modeller::{DualEmbedding, EditSpec, RangeSpec};
use super::plan::PlanRequest;
use super::printing::{BuildDirection, PolicyInfo, PolicyName};
use super::target::TargetSpec;
use super::words::{
    ConstraintValues, Contact, Criterion, Cut, Degenerate, DrawnEdges, Effort, Extract, FillHoles,
    FillMethod, Format, Kernel, LambdaFrom, Mode, Nesting, OpenShells, Operation, PictureFormat, Placement,
    Projection, Reader, Require, SetOperation, Shade, SolidParts, Stitch, StitchValidity, Units,
    VertexColors, Views, Weld,
};
use crate::formats::{ReadLimits, ReadOptions};
use crate::implicit::RbfOptions;
use crate::repair::fill::FillOptions;
use crate::{pipeline, simplify};
pub use error::OptionError;
pub(super) use nearest::nearest;
pub use table::{OptionKind, OptionSpec};

const REPAIR: &[Operation] = &[Operation::Repair];
const SIMPLIFY: &[Operation] = &[Operation::Simplify];
/// Operations that can end with fewer triangles.
const FEWER: &[Operation] = &[Operation::Simplify, Operation::Repair];
const CUT_STITCH: &[Operation] = &[Operation::CutStitch];
const FILL_HOLES: &[Operation] = &[Operation::FillHoles];
const MODELLER: &[Operation] = &[Operation::Modeller];
const BOOLEAN: &[Operation] = &[Operation::Boolean];
/// Operations whose result may touch itself.
const TOUCHING: &[Operation] = &[Operation::Repair, Operation::Boolean];
const RENDER: &[Operation] = &[Operation::Render];
/// Most pixels in all pictures of a full turn.
const TURN_PIXELS_MAX: u64 = 64_000_000;
const SHARE: OptionKind = OptionKind::Number { min: 0.0, max: 1.0 };

// One row: name, type, range where it is not all of the type's, who takes it, what it does.
options! {
    /// The options of a request; `None`: not given.
    ///
    /// As JSON it is an object of those that are given, by the names of [`SPECS`]; it is read back as it was written.
    format: Format, in Operation::ALL,
        "Format of the input. Default: found from the content.";
    output_format: Format, in Operation::WITH_MESH,
        "Format of the output. Default: that of the input.";
    output_units: Units, in Operation::WITH_MESH,
        "Unit of the coordinates of the output. Default: mm for STL, which names no unit; m for glTF made of another format; that of the input otherwise.";
    reader: Reader, in Operation::ALL,
        "Reader of OBJ files. Default: own.";
    units: Units, in Operation::ALL,
        "Unit of the coordinates; a 3MF states its own. Default: m for glTF, which says so; mm otherwise, reported as assumed.";
    parts: SolidParts, in Operation::ALL,
        "What of a 3MF of several parts is one solid; a result in a format that holds one mesh takes all parts together. Default: separate.";
    require: Require, in Operation::WITH_MESH,
        "What the result must be. Default: printable for repair, none for the other operations; boolean returns what is printable or nothing.";
    fill_holes: FillHoles, in REPAIR,
        "Whether repair fills simple holes. Default: simple.";
    open_shells: OpenShells, in REPAIR,
        "How surfaces are read that holes are left in, or that must be rebuilt: as closed, or as walls; auto goes by whether each of them mostly bounds a volume. The remedy thicken of a plan makes walls of open surfaces in the first place. Default: auto.";
    wrap_cells: u32 = OptionKind::Integer { min: 16, max: 1024 }, in REPAIR,
        "Cells along the longest side of a surface that repair must rebuild. Default: by the effort and its area.";
    effort: Effort, in REPAIR,
        "How fine and so how long to try where repair must rebuild the surface. Default: normal.";
    wall_mm: f64 = OptionKind::Number { min: 1e-6, max: 1e30 }, in TOUCHING,
        "Thickness of the walls that open surfaces become in a repair, and of the necks of contact=join, in millimetres. Default: 0.4 % of the diagonal.";
    recenter: bool, in REPAIR,
        "Move a mesh that is too far from the origin for float32 there, instead of refusing it. Default: false.";
    max_deviation_mm: f64, in REPAIR,
        "Refuse a repair that is or may be farther than this from the file, in millimetres. Default: no limit.";
    max_volume_change: f64 = SHARE, in REPAIR,
        "Refuse a repair that changes a defined volume by more than this share. Default: no limit.";
    nesting: Nesting, in REPAIR,
        "How shells inside shells are taken. Default: as_oriented.";
    contact: Contact, in TOUCHING,
        "What repair and boolean do with bodies that touch in vertices or edges: draw them apart, or join them by necks of wall_mm. Default: open.";
    plan: PlanRequest, in REPAIR,
        "What repair does about each defect: the plan that /v1/plan proposes, edited, or that of an earlier repair, whose steps then run again. Default: as /v1/plan proposes.";
    faces: u32 = OptionKind::Integer { min: 1, max: u32::MAX as u64 }, in FEWER,
        "Simplify to at most this many triangles; a polygon counts as the triangles it is divided into. At most one of faces, ratio, error_mm and targets.";
    ratio: f64 = SHARE, in FEWER,
        "Simplify to at most this share of the triangles. Default of simplify: 0.5.";
    error_mm: f64, in FEWER,
        "Simplify as far as no collapse has an error above this, in millimetres.";
    targets: Vec<TargetSpec>, in FEWER,
        "Several results from one call, each within its own target: [{\"ratio\":0.5},{\"faces\":1000},{\"error_mm\":0.1}].";
    mode: Mode, in SIMPLIFY,
        "How a simplification works. Default: guarded, which a repair always uses.";
    criterion: Criterion, in FEWER,
        "What the collapse of an edge costs. Default: quadric.";
    placement: Placement, in FEWER,
        "Where the vertex goes that an edge becomes. Default: optimal.";
    vertex_colors: VertexColors, in FEWER,
        "Colours of the vertices of a simplified mesh; priority needs format or output_format off, ply, glb or gltf. Default: kept.";
    normal_turn_max: f64 = OptionKind::Number { min: 0.0, max: 180.0 }, in FEWER,
        "Largest angle in degrees by which a collapse may turn the normal of a face; 180 lets it turn as it will. Default: 78.46.";
    weld: Weld, in CUT_STITCH,
        "Which vertices cut-stitch takes as one. Default: exact.";
    cut: Cut, in CUT_STITCH,
        "How cut-stitch makes its cut; the result is the same. Default: auto.";
    stitch: Stitch, in CUT_STITCH,
        "Which boundary edges cut-stitch joins after the cut. Default: pinch.";
    snap_epsilon_mm: f64, in &[Operation::Repair, Operation::CutStitch],
        "Largest distance of vertices of rims that repair and stitch=snap join, in millimetres; never more than half the shortest boundary edge; 0: only where they coincide. Default: 1e-5 of the diagonal for cut-stitch; for repair as far as rims that lie side by side are apart, at most 0.2 % of the diagonal, after edges are divided where a vertex of another rim lies beside them.";
    stitch_validity: StitchValidity, in CUT_STITCH,
        "When cut-stitch may join two boundary edges. Default: exact.";
    degenerate: Degenerate, in CUT_STITCH,
        "What cut-stitch does with faces that pass a vertex more than once. Default: split.";
    cut_edges: Vec<[u32; 2]>, in CUT_STITCH,
        "Edges that cut-stitch cuts besides those that must be, by the numbers of their vertices from 0: [[0,1],[1,2]].";
    holes: Holes, in FILL_HOLES,
        "Which holes fill-holes closes: all, or a list of the numbers under which analyze lists them, each perhaps with choices of its own: [0,{\"number\":3,\"method\":\"rbf\",\"band_rings\":1}]. Default: all.";
    method: FillMethod, in FILL_HOLES,
        "How fill-holes closes holes. Default: auto.";
    band_rings: u32 = OptionKind::Integer { min: 0, max: BAND_RINGS_MAX as u64 }, in FILL_HOLES,
        "Rings of neighbours around a rim that a surface of method=rbf is fitted to. Default: 2.";
    extract: Extract, in FILL_HOLES,
        "How fill-holes makes triangles of a surface of method=rbf. Default: project.";
    kernel: Kernel, in FILL_HOLES,
        "The radial function of a surface of method=rbf. Default: cubic, and thin-plate where that does not fit.";
    lambda_mm: f64 = OptionKind::Number { min: 1e-30, max: 1e30 }, in FILL_HOLES,
        "How far the offset constraints of method=rbf are from their points, in millimetres; halved where the surface is nearer to another place. Default: 0.5 % of the diagonal that lambda_from names.";
    lambda_from: LambdaFrom, in FILL_HOLES,
        "Whose box gives the distance of the offset constraints of method=rbf, where lambda_mm does not. Default: hole.";
    constraint_values: ConstraintValues, in FILL_HOLES,
        "The values of the field of method=rbf at its offset constraints. Default: distance.";
    constraints: f64 = OptionKind::Number { min: 0.01, max: 1.0 }, in FILL_HOLES,
        "Share of the points of method=rbf that have offset constraints. Default: 0.2.";
    operators: Vec<EditSpec>, in MODELLER,
        "What modeller does, one operator after the other, such as [{\"shift\":{\"faces\":[{\"face\":3,\"by_mm\":0.4}]}}]; see docs/modeller.md. Default: nothing.";
    ranges: Vec<RangeSpec>, in MODELLER,
        "Faces whose allowed intervals modeller tells after the operators, by number, by normal and place, by a ray, or several that move together: [3,{\"together\":[{\"face\":1},{\"face\":2,\"rate\":-1}]}]. Default: none.";
    list_faces: bool, in MODELLER,
        "Whether modeller lists the faces of the polyhedron with their numbers and planes, after the operators. Default: false.";
    coplanar_mm: f64, in MODELLER,
        "Within which distance of one plane neighbours are one face to modeller, in millimetres; 0: exactly. Default: eight float32 steps at the largest coordinate.";
    dual: DualEmbedding, in MODELLER,
        "Where the dual has its vertices that modeller returns instead of the polyhedron. Default: no dual is made.";
    dual_recenter: bool, in MODELLER,
        "Whether the middle of the part is the origin of the dual, instead of that of the file. Default: false.";
    polygons: bool, in MODELLER,
        "Whether modeller writes faces of OBJ and OFF as polygons where every reader splits them alike; others, and those with interior loops, become triangles. Default: false.";
    set_operation: SetOperation, in BOOLEAN,
        "What boolean makes of its solids. Default: union.";
    views: Views, in RENDER,
        "From which sides render draws the mesh. Default: iso.";
    width: u32 = OptionKind::Integer { min: 16, max: 2048 }, in RENDER,
        "Width of each view that render draws, in pixels. Default: 640.";
    height: u32 = OptionKind::Integer { min: 16, max: 2048 }, in RENDER,
        "Height of each view that render draws, in pixels, with its share of the text below. Default: 480.";
    shade: Shade, in RENDER,
        "How render shades faces. Default: smooth.";
    edges: DrawnEdges, in RENDER,
        "Which edges render draws. Default: creases.";
    projection: Projection, in RENDER,
        "How depth changes what render draws; a turntable is always orthographic. Default: orthographic.";
    defects: bool, in RENDER,
        "Whether render colours and marks defects. Default: true.";
    turntable: u32 = OptionKind::Integer { min: 2, max: 120 }, in RENDER,
        "Number of pictures of a full turn, which render returns as an animated PNG instead of views; at most 64 million pixels in all. Default: none.";
    picture_format: PictureFormat, in RENDER,
        "What render returns: a picture, or a mesh (GLB) that viewers turn, which has the colours and marks of the picture, and defects as the only choice. Default: png.";
    thumbnail: bool, in Operation::BESIDE_PICTURE, of the service,
        "Whether a picture of the mesh with its defects, and of the result with its new triangles, is made and kept with the job. Default: false.";
    policy: PolicyName, in Operation::ALL,
        "Process whose limits the result, or else the file, is measured against; see /v1/policies. Default: none.";
    build_direction: BuildDirection, in Operation::ALL,
        "Direction of the file that is up in the machine; matters with policy. Default: z.";
    near_mm: f64, in Operation::DESCRIBING,
        "Largest distance of vertices, edges and faces that are reported as near, in millimetres; never more than half the edges around them. Default: 1e-5 of the diagonal for analyze of up to 100000 triangles; otherwise nothing near is looked for.";
    samples: u32 = OptionKind::Integer { min: 0, max: 10_000 }, in Operation::ALL,
        "Witnesses that the report keeps of each defect. Default: 16.";
    result_ttl: u64 = OptionKind::Integer { min: 1, max: 31_536_000 }, in Operation::ALL, of the service,
        "Seconds for which the result is kept, at most the server's own limit. Default: that limit.";
    input: InputRef, in Operation::ALL, of the service,
        "A mesh that is there already: the upload of an earlier job, {\"job\":\"ID\"}, or one made beforehand at /v1/uploads, {\"upload\":\"ID\"}.";
}

impl TryFrom<Map<String, Value>> for Options {
    type Error = OptionError;

    /// A member that is null is one that was not given.
    fn try_from(members: Map<String, Value>) -> Result<Self, OptionError> {
        let given = members.into_iter().filter(|(_, value)| !value.is_null());
        Self::from_json(&given.collect())
    }
}

impl Options {
    /// That `operation` takes each option that is given.
    ///
    /// # Errors
    /// The first one that it does not take.
    pub fn check_taken_by(&self, operation: Operation) -> Result<(), OptionError> {
        match self.given().find(|spec| !spec.is_taken_by(operation)) {
            Some(spec) => Err(OptionError::NotTaken { spec, operation }),
            None => Ok(()),
        }
    }

    /// What no single option can say: that `operation` takes them, and that they go together.
    ///
    /// # Errors
    /// An option that the operation does not take, two options that exclude each other, or one that lacks another.
    pub fn check(&self, operation: Operation) -> Result<(), OptionError> {
        self.check_taken_by(operation)?;
        let given = [
            ("faces", self.faces.is_some()),
            ("ratio", self.ratio.is_some()),
            ("error_mm", self.error_mm.is_some()),
            ("targets", self.targets.is_some()),
        ];
        let mut given = given.into_iter().filter(|&(_, is_given)| is_given).map(|(name, _)| name);
        if let (Some(by), Some(name)) = (given.next(), given.next()) {
            return Err(OptionError::Excluded { spec: lookup::spec_of(name)?, by });
        }
        let written = self.output_format.or(self.format);
        let shows_colors = matches!(written, Some(Format::Off | Format::Ply | Format::Glb | Format::Gltf));
        if self.vertex_colors == Some(VertexColors::Priority) && !shows_colors {
            let needs = "a `format` or `output_format` of off, ply, glb or gltf";
            return Err(OptionError::Lacking { spec: lookup::spec_of("vertex_colors")?, needs });
        }
        self.check_turntable()?;
        self.check_model()?;
        self.check_filling()
    }

    /// That each hole is listed once, and that choices about a field come with a method that may fit one.
    fn check_filling(&self) -> Result<(), OptionError> {
        let listed: &[ChosenHole] = match &self.holes {
            Some(Holes::Listed(holes)) => holes,
            _ => &[],
        };
        let mut numbers: Vec<u32> = listed.iter().map(|hole| hole.number).collect();
        numbers.sort_unstable();
        if numbers.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(OptionError::Lacking { spec: lookup::spec_of("holes")?, needs: "each number once" });
        }
        let usual = self.method.unwrap_or(FillMethod::Auto);
        let of_hole = |hole: &ChosenHole| hole.method.unwrap_or(usual);
        if listed.iter().any(|hole| hole.band_rings.is_some() && !may_fit_a_field(of_hole(hole))) {
            let needs = "the method rbf or auto for each hole with `band_rings`";
            return Err(OptionError::Lacking { spec: lookup::spec_of("holes")?, needs });
        }
        let is_fitted = match listed {
            [] => may_fit_a_field(usual),
            _ => listed.iter().any(|hole| may_fit_a_field(of_hole(hole))),
        };
        if is_fitted {
            return Ok(());
        }
        let of_fields = [
            "extract",
            "kernel",
            "lambda_mm",
            "lambda_from",
            "constraint_values",
            "constraints",
            "band_rings",
        ];
        match self.given().find(|spec| of_fields.contains(&spec.name)) {
            Some(spec) => Err(OptionError::Lacking { spec, needs: "the method rbf or auto" }),
            None => Ok(()),
        }
    }

    /// That a mesh in place of a picture has no choice that it would leave out.
    fn check_model(&self) -> Result<(), OptionError> {
        if self.picture_format != Some(PictureFormat::Glb) {
            return Ok(());
        }
        let of_pixels = ["views", "width", "height", "shade", "edges", "projection", "turntable"];
        match self.given().find(|spec| of_pixels.contains(&spec.name)) {
            Some(spec) => Err(OptionError::OfPixels { spec }),
            None => Ok(()),
        }
    }

    /// That a full turn has no choice that it would leave out, and is no file of any size.
    fn check_turntable(&self) -> Result<(), OptionError> {
        let Some(pictures) = self.turntable else { return Ok(()) };
        let spec = lookup::spec_of("turntable")?;
        let others = [
            ("views", self.views.is_some()),
            ("projection", self.projection == Some(Projection::Perspective)),
        ];
        if let Some((by, _)) = others.into_iter().find(|&(_, is_given)| is_given) {
            return Err(OptionError::Excluded { spec, by });
        }
        let (width, height) = pipeline::PictureChoices::RENDERED;
        let [width, height] = [self.width.unwrap_or(width), self.height.unwrap_or(height)].map(u64::from);
        if width * height * u64::from(pictures) > TURN_PIXELS_MAX {
            let needs = "`width` and `height` of at most 64 million pixels in all its pictures";
            return Err(OptionError::Lacking { spec, needs });
        }
        Ok(())
    }

    /// The targets of a simplification, errors in the unit of the file.
    fn targets(&self) -> Vec<simplify::Target> {
        let single = [
            self.faces.map(TargetSpec::Faces),
            self.ratio.map(TargetSpec::Ratio),
            self.error_mm.map(TargetSpec::ErrorMm),
        ];
        let millimetres = self.units.unwrap_or(Units::Millimetre).millimetres();
        let all = single.into_iter().flatten().chain(self.targets.iter().flatten().copied());
        all.map(|target| target.to_engine(millimetres)).collect()
    }

    /// How holes are filled, lengths in the unit of the file.
    fn filling(&self, millimetres: f64) -> pipeline::FillHolesChoices {
        let usual = FillOptions::default();
        pipeline::FillHolesChoices {
            holes: self.holes.as_ref().and_then(Holes::to_engine),
            fill: FillOptions {
                method: self.method.map(Into::into).unwrap_or_default(),
                band_rings: self.band_rings.unwrap_or(usual.band_rings),
                extract: self.extract.map(Into::into).unwrap_or_default(),
                rbf: RbfOptions {
                    kernel: self.kernel.map(Into::into).unwrap_or_default(),
                    lambda: self.lambda_mm.map(|length| length / millimetres),
                    lambda_from: self.lambda_from.map(Into::into).unwrap_or_default(),
                    values: self.constraint_values.map(Into::into).unwrap_or_default(),
                    share: self.constraints.unwrap_or(usual.rbf.share),
                    ..usual.rbf
                },
                ..usual
            },
        }
    }

    /// What the modeller does, lengths in the unit of the file.
    fn modelling(&self, millimetres: f64) -> pipeline::ModellerChoices {
        pipeline::ModellerChoices {
            operators: self.operators.iter().flatten().map(|edit| edit.to_engine(millimetres)).collect(),
            ranges: self.ranges.iter().flatten().map(RangeSpec::to_engine).collect(),
            tolerance: self.coplanar_mm.map(|length| length / millimetres),
            lists_faces: self.list_faces.unwrap_or(false),
            dual: self.dual.map(Into::into),
            is_dual_recentered: self.dual_recenter.unwrap_or(false),
            writes_polygons: self.polygons.unwrap_or(false),
        }
    }

    /// The limits of the process, in the unit of the file.
    fn policy(&self, millimetres: f64) -> Option<crate::printing::PrintingPolicy> {
        let up = self.build_direction.unwrap_or(BuildDirection::Z);
        Some(PolicyInfo::of(self.policy?)?.to_engine(millimetres, up))
    }

    /// The picture that is asked for.
    fn picture(&self) -> Option<pipeline::PictureChoices> {
        let thumbnail = pipeline::PictureChoices::default();
        if self.thumbnail == Some(true) {
            return Some(thumbnail);
        }
        let wishes = [
            self.views.is_some(),
            self.width.is_some(),
            self.height.is_some(),
            self.shade.is_some(),
            self.edges.is_some(),
            self.projection.is_some(),
            self.defects.is_some(),
            self.turntable.is_some(),
            self.picture_format.is_some(),
        ];
        wishes.contains(&true).then(|| pipeline::PictureChoices {
            views: self.views.map_or(thumbnail.views, Views::to_engine),
            width: self.width.unwrap_or(pipeline::PictureChoices::RENDERED.0),
            height: self.height.unwrap_or(pipeline::PictureChoices::RENDERED.1),
            shade: self.shade.map(Into::into).unwrap_or_default(),
            edges: self.edges.map(Into::into).unwrap_or_default(),
            projection: self.projection.map(Into::into).unwrap_or_default(),
            shows_defects: self.defects.unwrap_or(true),
            turn_pictures: self.turntable.unwrap_or(0),
            format: self.picture_format.map(Into::into).unwrap_or_default(),
        })
    }

    /// Both ask the engine for the same; how long the result is kept and where the bytes come from do not matter.
    pub fn give_the_same_as(&self, other: &Self) -> bool {
        let essence = |options: &Self| Self { result_ttl: None, input: None, ..options.clone() };
        essence(self) == essence(other)
    }

    /// The engine's options, under the configured limits on counts.
    pub fn to_engine(&self, limits: ReadLimits) -> pipeline::Options {
        let millimetres = self.units.unwrap_or(Units::Millimetre).millimetres();
        pipeline::Options {
            format: self.format.map(Into::into),
            output_format: self.output_format.map(Into::into),
            parts: self.parts.map(Into::into).unwrap_or_default(),
            read: ReadOptions {
                limits,
                obj_reader: self.reader.map(Into::into).unwrap_or_default(),
                ..ReadOptions::default()
            },
            units: self.units.map(Into::into),
            output_units: self.output_units.map(Into::into),
            require: self.require.map(Into::into),
            fill_holes: self.fill_holes.map(Into::into).unwrap_or_default(),
            wrap: pipeline::WrapChoices {
                open_shells: self.open_shells.map(Into::into).unwrap_or_default(),
                cells: self.wrap_cells,
                effort: self.effort.map(Into::into).unwrap_or_default(),
                wall: self.wall_mm.map(|length| length / millimetres),
                may_recenter: self.recenter.unwrap_or(false),
            },
            nesting: self.nesting.map(Into::into).unwrap_or_default(),
            contact: self.contact.map(Into::into).unwrap_or_default(),
            plan: self.plan.as_ref().map(PlanRequest::to_engine),
            limits: pipeline::FidelityLimits {
                deviation_max: self.max_deviation_mm.map(|length| length / millimetres),
                volume_change_max: self.max_volume_change,
            },
            simplify: pipeline::SimplifyChoices {
                targets: self.targets(),
                mode: self.mode.map(Into::into),
                criterion: self.criterion.unwrap_or(Criterion::Quadric).into(),
                placement: self.placement.unwrap_or(Placement::Optimal).into(),
                vertex_colors: self.vertex_colors.map(Into::into).unwrap_or_default(),
                normal_turn_max: self.normal_turn_max,
            },
            cut_stitch: pipeline::CutStitchChoices {
                keeps_copies: self.weld == Some(Weld::None),
                method: self.cut.and_then(Into::into),
                stitching: self.stitch.map(Into::into).unwrap_or_default(),
                epsilon: self.snap_epsilon_mm.map(|length| length / millimetres),
                validity: self.stitch_validity.map(Into::into).unwrap_or_default(),
                degenerate: self.degenerate.map(Into::into).unwrap_or_default(),
                chosen: self.cut_edges.clone().unwrap_or_default(),
            },
            filling: self.filling(millimetres),
            modeller: self.modelling(millimetres),
            set_operation: self.set_operation.map(Into::into).unwrap_or_default(),
            file_sizes: Vec::new(),
            near: self.near_mm.map(|length| length / millimetres),
            samples: self.samples.map(|n| n as usize),
            policy: self.policy(millimetres),
            material: None,
            picture: self.picture(),
            after: None,
        }
    }
}
