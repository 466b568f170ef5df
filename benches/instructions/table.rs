//! The committed counts, and the comparison with them.

use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Percent by which a pass may be dearer when its row does not say.
const TOLERANCE_PERCENT: f64 = 5.0;

/// What was counted for a pass.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) instructions: u64,
    /// How many percent more are no fault.
    pub(crate) tolerance_percent: f64,
    /// Why the tolerance is not the usual one.
    pub(crate) reason: Option<String>,
}

/// How a count compares with the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Word {
    Same,
    /// By more than the tolerance.
    Dearer,
    /// By more than the tolerance.
    Cheaper,
}

impl Row {
    pub(crate) fn ratio(&self, now: u64) -> f64 {
        now as f64 / self.instructions as f64
    }

    pub(crate) fn judge(&self, now: u64) -> Word {
        let percent = (self.ratio(now) - 1.0) * 100.0;
        match percent {
            _ if percent > self.tolerance_percent => Word::Dearer,
            _ if percent < -self.tolerance_percent => Word::Cheaper,
            _ => Word::Same,
        }
    }
}

/// The rows by the names of the passes, in their order.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Table(pub(crate) Vec<(String, Row)>);

impl Table {
    /// The table in this file; an empty one when there is none.
    pub(crate) fn read(path: &str) -> Self {
        let Ok(text) = std::fs::read_to_string(path) else { return Self::default() };
        let rows: Map<String, Value> = serde_json::from_str(&text).expect("a table of passes");
        let row = |value: &Value| Row {
            instructions: value["instructions"].as_u64().expect("a count"),
            tolerance_percent: value["tolerance_percent"].as_f64().unwrap_or(TOLERANCE_PERCENT),
            reason: value["reason"].as_str().map(str::to_owned),
        };
        Self(rows.iter().map(|(name, value)| (name.clone(), row(value))).collect())
    }

    pub(crate) fn write(&self, path: &str) {
        let lines: Vec<String> = self.0.iter().map(|(name, row)| line(name, row)).collect();
        let text = format!("{{\n{}\n}}\n", lines.join(",\n"));
        std::fs::write(path, text).expect("the table can be written");
    }

    pub(crate) fn row(&self, name: &str) -> Option<&Row> {
        self.0.iter().find(|(other, _)| other == name).map(|(_, row)| row)
    }

    /// Names of rows that are not among `names`.
    pub(crate) fn names_beside(&self, names: &[&str]) -> Vec<&str> {
        self.0.iter().map(|(name, _)| name.as_str()).filter(|name| !names.contains(name)).collect()
    }

    /// The rows of these passes, with the counts that were taken now where there are any, and with their tolerances.
    pub(crate) fn blessed(&self, names: &[&str], counts: &BTreeMap<String, u64>) -> Self {
        let row = |name: &&str| {
            let old = self.row(name);
            let instructions = counts.get(*name).copied().or_else(|| old.map(|row| row.instructions))?;
            let tolerance_percent = old.map_or(TOLERANCE_PERCENT, |row| row.tolerance_percent);
            let reason = old.and_then(|row| row.reason.clone());
            Some(((*name).to_owned(), Row { instructions, tolerance_percent, reason }))
        };
        Self(names.iter().filter_map(row).collect())
    }
}

fn line(name: &str, row: &Row) -> String {
    let mut value = json!({ "instructions": row.instructions, "tolerance_percent": row.tolerance_percent });
    if let Some(reason) = &row.reason {
        value["reason"] = json!(reason);
    }
    format!("  {}: {value}", json!(name))
}
