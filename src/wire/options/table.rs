//! What a row of the table of options says: its name, its values, who takes it, and what it does.

use crate::figures::figure;
use crate::wire::words::Operation;

/// What values an option takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OptionKind {
    /// One word.
    Word {
        /// Name of their type.
        name: &'static str,
        /// All of them.
        words: &'static [&'static str],
        /// What each of them means, in the same order.
        abouts: &'static [&'static str],
    },
    /// A whole number in this range.
    Integer {
        /// Smallest value.
        min: u64,
        /// Largest value.
        max: u64,
    },
    /// A number in this range.
    Number {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// `true` or `false`.
    Flag,
    /// A list of targets of a simplification.
    Targets,
    /// A list of edges by the numbers of their vertices.
    Edges,
    /// Which holes are filled: `all`, or a list.
    Holes,
    /// A list of operators of the modeller.
    Edits,
    /// A list of faces of a polyhedron, or of faces together.
    Ranges,
    /// A plan, as `plan` and `repair` report it.
    Plan,
    /// An earlier job: `{"job":"ID"}`.
    Input,
}

/// One option.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OptionSpec {
    /// Name in queries and JSON; as a flag with hyphens.
    pub name: &'static str,
    /// Values.
    pub kind: OptionKind,
    /// Operations that take it.
    pub operations: &'static [Operation],
    /// What it does, and what holds when it is absent.
    pub about: &'static str,
    /// It has no meaning on the command line.
    pub is_for_service_only: bool,
}

impl OptionSpec {
    /// True when `operation` takes it.
    pub fn is_taken_by(&self, operation: Operation) -> bool {
        self.operations.contains(&operation)
    }

    /// The option's name as a command-line flag, without the leading hyphens.
    pub fn flag(&self) -> String {
        self.name.replace('_', "-")
    }

    /// The words it takes; empty when it takes something else.
    pub fn words(&self) -> &'static [&'static str] {
        match self.kind {
            OptionKind::Word { words, .. } => words,
            _ => &[],
        }
    }

    pub(super) fn expected(&self) -> String {
        match self.kind {
            OptionKind::Word { words, .. } => words.join(", "),
            OptionKind::Integer { min, max } => format!("a whole number from {min} to {max}"),
            OptionKind::Number { min, max } => format!("a number from {} to {}", figure(min), figure(max)),
            OptionKind::Flag => "true or false".to_owned(),
            OptionKind::Edges => "1 to 100000 pairs of different vertex numbers in a list".to_owned(),
            OptionKind::Holes => {
                "`all`, or 1 to 10000 of N and {\"number\":N,\"method\":WORD,\"band_rings\":N} in a list, N from 0 to 9999"
                    .to_owned()
            }
            OptionKind::Edits => {
                "a list of up to 1000 of {\"shift\":…}, {\"split\":…}, {\"merge\":…}, {\"flip\":…} and {\"undo\":{}}".to_owned()
            }
            OptionKind::Ranges => {
                "a list of up to 1000 of N, {\"normal\":[x,y,z],\"at\":[x,y,z]}, {\"ray\":{\"from\":[x,y,z],\"direction\":[x,y,z]}} and {\"together\":[{\"face\":…,\"rate\":X}]}"
                    .to_owned()
            }
            OptionKind::Plan => "a plan as /v1/plan answers it, edited".to_owned(),
            OptionKind::Targets => {
                "1 to 16 of {\"faces\":N}, {\"ratio\":X} and {\"error_mm\":X} in a list".to_owned()
            }
            OptionKind::Input => "{\"job\":\"ID\"} or {\"upload\":\"ID\"}".to_owned(),
        }
    }
}
