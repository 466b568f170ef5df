//! What each process can do: data files of the repository, read once for each request.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::words::{BoundKind, BuildDirection, CheckCode, PolicyName, PrintingUnit};
use crate::printing;

/// The limits of a printing process, with where they are from. Lengths are in millimetres, angles in degrees.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct PolicyInfo {
    /// Name in options.
    pub name: PolicyName,
    /// Name for people.
    pub title: String,
    /// Grows with every change of a limit.
    pub version: u32,
    /// Limits of single figures.
    pub limits: Vec<PolicyLimit>,
    /// Largest part.
    pub build_volume: PolicyVolume,
}

/// The limits of one figure.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct PolicyLimit {
    /// What is checked.
    pub check: CheckCode,
    /// Which side of the limits is wrong.
    pub bound: BoundKind,
    /// Unit of the limits.
    pub unit: PrintingUnit,
    /// Beyond it the check is a warning; null: never.
    #[schema(required)]
    pub warning: Option<f64>,
    /// Beyond it the check is an error; null: never.
    #[schema(required)]
    pub error: Option<f64>,
    /// Who says so.
    pub source: String,
}

/// Sides of the largest box that can be printed, in millimetres, the last one up.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct PolicyVolume {
    /// Larger parts are a warning; null: never.
    #[schema(required)]
    pub warning: Option<[f64; 3]>,
    /// Larger parts are an error; null: never.
    #[schema(required)]
    pub error: Option<[f64; 3]>,
    /// Who says so.
    pub source: String,
}

/// A policy as its file has it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PolicyFile {
    name: String,
    title: String,
    version: u32,
    wall: Option<Row>,
    gap: Option<Row>,
    feature: Option<Row>,
    overhang: Option<Row>,
    sharp_edge: Option<Row>,
    cavities: Option<Row>,
    build_volume: VolumeLimitRow,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    warning: Option<f64>,
    error: Option<f64>,
    source: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct VolumeLimitRow {
    warning: Option<[f64; 3]>,
    error: Option<[f64; 3]>,
    source: String,
}

/// The text of each policy, in the order of [`PolicyName::ALL`].
const FILES: [&str; 5] = [
    include_str!("../../../policies/fdm.toml"),
    include_str!("../../../policies/sla.toml"),
    include_str!("../../../policies/sls.toml"),
    include_str!("../../../policies/mjf.toml"),
    include_str!("../../../policies/metal.toml"),
];

/// Every policy: the answer of `/v1/policies`. A test shows that all of them are there.
pub fn policies() -> Vec<PolicyInfo> {
    FILES.iter().filter_map(|text| read(text).ok()).collect()
}

fn read(text: &str) -> Result<PolicyInfo, String> {
    let file: PolicyFile = toml::from_str(text).map_err(|error| error.to_string())?;
    let name = PolicyName::from_word(&file.name).ok_or("no such policy")?;
    let rows = [
        (CheckCode::Wall, file.wall),
        (CheckCode::Gap, file.gap),
        (CheckCode::Feature, file.feature),
        (CheckCode::Overhang, file.overhang),
        (CheckCode::SharpEdge, file.sharp_edge),
        (CheckCode::Cavity, file.cavities),
    ];
    let limit = |(check, row): (CheckCode, Option<Row>)| {
        let Row { warning, error, source } = row?;
        let bound = if check == CheckCode::Cavity { BoundKind::AtMost } else { BoundKind::AtLeast };
        Some(PolicyLimit { check, bound, unit: check.unit(), warning, error, source })
    };
    let VolumeLimitRow { warning, error, source } = file.build_volume;
    Ok(PolicyInfo {
        name,
        title: file.title,
        version: file.version,
        limits: rows.into_iter().filter_map(limit).collect(),
        build_volume: PolicyVolume { warning, error, source },
    })
}

impl PolicyInfo {
    /// The policy of this name.
    pub fn of(name: PolicyName) -> Option<Self> {
        policies().into_iter().find(|policy| policy.name == name)
    }

    /// The engine's policy, lengths in the unit of a file of which one unit is so many millimetres.
    pub fn to_engine(&self, millimetres: f64, build_direction: BuildDirection) -> printing::PrintingPolicy {
        let limit = |check: CheckCode| {
            let unit = if check.unit() == PrintingUnit::Millimetres { millimetres } else { 1.0 };
            let row = self.limits.iter().find(|limit| limit.check == check);
            row.map_or_else(printing::Limit::default, |row| printing::Limit {
                warning: row.warning.map(|limit| limit / unit),
                error: row.error.map(|limit| limit / unit),
            })
        };
        let sides = |sides: Option<[f64; 3]>| sides.map(|sides| sides.map(|side| side / millimetres));
        printing::PrintingPolicy {
            name: self.name.word(),
            version: self.version,
            wall: limit(CheckCode::Wall),
            gap: limit(CheckCode::Gap),
            feature: limit(CheckCode::Feature),
            overhang: limit(CheckCode::Overhang),
            sharp_edge: limit(CheckCode::SharpEdge),
            cavities: limit(CheckCode::Cavity),
            build_volume: printing::BuildVolume {
                warning: sides(self.build_volume.warning),
                error: sides(self.build_volume.error),
            },
            build_direction: build_direction.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_policy_is_there_and_every_limit_has_a_source() {
        for text in FILES {
            read(text).unwrap();
        }
        let names: Vec<PolicyName> = policies().iter().map(|policy| policy.name).collect();
        assert_eq!(names, PolicyName::ALL);
        for policy in policies() {
            assert!(policy.version >= 1 && !policy.title.is_empty());
            for limit in &policy.limits {
                assert!(limit.source.len() > 20, "{limit:?}");
                assert!(limit.warning.is_some() || limit.error.is_some(), "{limit:?}");
                if let (BoundKind::AtLeast, Some(warning), Some(error)) =
                    (limit.bound, limit.warning, limit.error)
                {
                    assert!(error <= warning, "{limit:?}");
                }
            }
        }
    }

    #[test]
    fn lengths_become_the_unit_of_the_file_and_angles_stay() {
        let fdm = PolicyInfo::of(PolicyName::Fdm).unwrap().to_engine(25.4, BuildDirection::MinusY);
        assert_eq!(fdm.wall.error, Some(0.8 / 25.4));
        assert_eq!(fdm.overhang.warning, Some(45.0));
        assert_eq!(fdm.build_volume.warning, Some([200.0 / 25.4; 3]));
        assert_eq!(fdm.build_direction, printing::BuildDirection::MinusY);
        assert_eq!(fdm.cavities, printing::Limit::default());
    }
}
