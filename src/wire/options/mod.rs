//! The options of every operation: one table for query parameters, JSON members and command-line flags.

mod error;
mod parse;
mod table;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::plan::PlanRequest;
use super::printing::{BuildDirection, PolicyInfo, PolicyName};
use super::request::InputRef;
use super::target::TargetSpec;
use super::words::{
    Contact, Criterion, Cut, Degenerate, Effort, FillHoles, Format, Mode, Nesting, OpenShells, Placement,
    Reader, Require, Stitch, StitchValidity, Units, VertexColors,
};
use crate::formats::{ReadLimits, ReadOptions};
use crate::{pipeline, simplify};
pub use error::OptionError;
pub(super) use table::nearest;
pub use table::{OptionKind, OptionSpec, SPECS};

/// The options of a request; `None`: not given.
///
/// As JSON it is an object of those that are given, by the names of [`SPECS`]; it is read back as it was written.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Map<String, Value>")]
pub struct Options {
    /// Format of the input.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub format: Option<Format>,
    /// Format of the output.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output_format: Option<Format>,
    /// Reader of OBJ files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reader: Option<Reader>,
    /// Unit of the coordinates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub units: Option<Units>,
    /// What the result must be.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub require: Option<Require>,
    /// Whether repair fills simple holes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fill_holes: Option<FillHoles>,
    /// How open shells are read where a surface is rebuilt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub open_shells: Option<OpenShells>,
    /// Cells along the longest side of a surface that is rebuilt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wrap_cells: Option<u32>,
    /// How fine and so how long a surface is rebuilt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effort: Option<Effort>,
    /// Thickness of the walls that sheets become, in millimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wall_mm: Option<f64>,
    /// Whether a mesh too far from the origin for float32 may be moved there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recenter: Option<bool>,
    /// Largest distance between the file and the result of a repair, in millimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_deviation_mm: Option<f64>,
    /// Largest share by which a repair may change the volume.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_volume_change: Option<f64>,
    /// How shells inside shells are taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nesting: Option<Nesting>,
    /// What becomes of bodies that touch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<Contact>,
    /// What repair is to do about each defect.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plan: Option<PlanRequest>,
    /// Faces to simplify to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faces: Option<u32>,
    /// Share of the faces to simplify to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<f64>,
    /// Error to simplify up to, in millimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_mm: Option<f64>,
    /// Several targets of a simplification.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub targets: Option<Vec<TargetSpec>>,
    /// How a simplification works.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode: Option<Mode>,
    /// What the collapse of an edge costs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub criterion: Option<Criterion>,
    /// Where the vertex goes that an edge becomes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub placement: Option<Placement>,
    /// What colours the vertices of a simplified mesh have.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertex_colors: Option<VertexColors>,
    /// How a cut is made.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut: Option<Cut>,
    /// Which boundary edges are joined after a cut.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stitch: Option<Stitch>,
    /// Largest distance of vertices that a stitch joins, in millimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snap_epsilon_mm: Option<f64>,
    /// When two boundary edges may be joined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stitch_validity: Option<StitchValidity>,
    /// What becomes of faces that pass a vertex more than once.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degenerate: Option<Degenerate>,
    /// Edges to be cut besides those that must be.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut_edges: Option<Vec<[u32; 2]>>,
    /// Process that the mesh is to be printed with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub policy: Option<PolicyName>,
    /// What is up in the machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub build_direction: Option<BuildDirection>,
    /// Largest distance of features that are reported as near, in millimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub near_mm: Option<f64>,
    /// Witnesses to keep of each defect.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples: Option<u32>,
    /// Seconds for which the result is kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub result_ttl: Option<u64>,
    /// An earlier job whose upload is used again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input: Option<InputRef>,
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
    /// What no single option can say: that options go together.
    ///
    /// # Errors
    /// Two options that exclude each other, or one that lacks another.
    pub fn check(&self) -> Result<(), OptionError> {
        let given = [
            ("faces", self.faces.is_some()),
            ("ratio", self.ratio.is_some()),
            ("error_mm", self.error_mm.is_some()),
            ("targets", self.targets.is_some()),
        ];
        let mut given = given.into_iter().filter(|&(_, is_given)| is_given).map(|(name, _)| name);
        if let (Some(by), Some(name)) = (given.next(), given.next()) {
            return Err(OptionError::Excluded { spec: table::spec_of(name)?, by });
        }
        let written = self.output_format.or(self.format);
        let shows_colors = matches!(written, Some(Format::Off | Format::Ply));
        if self.vertex_colors == Some(VertexColors::Priority) && !shows_colors {
            let needs = "a `format` or `output_format` of off or ply";
            return Err(OptionError::Lacking { spec: table::spec_of("vertex_colors")?, needs });
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

    /// The limits of the process, in the unit of the file.
    fn policy(&self, millimetres: f64) -> Option<crate::printing::Policy> {
        let up = self.build_direction.unwrap_or(BuildDirection::Z);
        Some(PolicyInfo::of(self.policy?)?.to_engine(millimetres, up))
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
            read: ReadOptions {
                limits,
                obj_reader: self.reader.map(Into::into).unwrap_or_default(),
                ..ReadOptions::default()
            },
            units: self.units.map(Into::into),
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
            limits: pipeline::Limits {
                deviation_max: self.max_deviation_mm.map(|length| length / millimetres),
                volume_change_max: self.max_volume_change,
            },
            simplify: pipeline::SimplifyChoices {
                targets: self.targets(),
                mode: self.mode.map(Into::into),
                criterion: self.criterion.unwrap_or(Criterion::Quadric).into(),
                placement: self.placement.unwrap_or(Placement::Optimal).into(),
                vertex_colors: self.vertex_colors.map(Into::into).unwrap_or_default(),
            },
            cut_stitch: pipeline::CutStitchChoices {
                method: self.cut.and_then(Into::into),
                stitching: self.stitch.map(Into::into).unwrap_or_default(),
                epsilon: self.snap_epsilon_mm.map(|length| length / millimetres),
                validity: self.stitch_validity.map(Into::into).unwrap_or_default(),
                degenerate: self.degenerate.map(Into::into).unwrap_or_default(),
                chosen: self.cut_edges.clone().unwrap_or_default(),
            },
            near: self.near_mm.map(|length| length / millimetres),
            samples: self.samples.map(|n| n as usize),
            policy: self.policy(millimetres),
            material: None,
        }
    }
}
