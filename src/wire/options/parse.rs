//! Options out of names and values.

use serde_json::{Map, Value};

use super::table::{OptionKind, OptionSpec, spec_of};
use super::{OptionError, Options};
use crate::wire::edges::edges_from_json;
use crate::wire::plan::PlanRequest;
use crate::wire::printing::{BuildDirection, PolicyName};
use crate::wire::target;
use crate::wire::words::{
    Contact, Criterion, Cut, Degenerate, Effort, FillHoles, Format, Mode, Nesting, OpenShells, Placement,
    Reader, Require, Stitch, StitchValidity, Units, VertexColors,
};

impl Options {
    /// Options from names and values, as in a query.
    ///
    /// # Errors
    /// The first one that cannot be taken.
    pub fn from_pairs<N: AsRef<str>, V: AsRef<str>>(
        pairs: impl IntoIterator<Item = (N, V)>,
    ) -> Result<Self, OptionError> {
        let mut options = Self::default();
        for (name, value) in pairs {
            options.set(name.as_ref(), value.as_ref())?;
        }
        Ok(options)
    }

    /// Options from the members of a JSON object.
    ///
    /// # Errors
    /// The first one that cannot be taken.
    pub fn from_json(members: &Map<String, Value>) -> Result<Self, OptionError> {
        let mut options = Self::default();
        for (name, value) in members {
            options.set_json(name, value)?;
        }
        Ok(options)
    }

    /// Takes one option. The same value twice is no contradiction.
    ///
    /// # Errors
    /// There is no such option, it does not take this value, or it has another value already.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), OptionError> {
        let spec = spec_of(name)?;
        let taken = match spec.kind {
            OptionKind::Word(_) => self.set_word(spec, value),
            OptionKind::Integer { min, max } => match parse_digits(value).filter(|n| (min..=max).contains(n))
            {
                Some(number) => self.set_integer(spec, number),
                None => Taken::Invalid,
            },
            OptionKind::Number { min, max } => {
                match parse_number(value).filter(|n| (min..=max).contains(n)) {
                    Some(number) => self.set_number(spec, number),
                    None => Taken::Invalid,
                }
            }
            OptionKind::Flag => self.set_flag(spec, value),
            OptionKind::Targets => put(&mut self.targets, target::targets_from_json(value)),
            OptionKind::Edges => put(&mut self.cut_edges, edges_from_json(value)),
            OptionKind::Plan => put(&mut self.plan, PlanRequest::from_json(value)),
            OptionKind::Input => match serde_json::from_str(value) {
                Ok(input) => put(&mut self.input, Some(input)),
                Err(_) => Taken::Invalid,
            },
        };
        taken.into_result(spec, value)
    }

    /// Takes one option whose value is JSON of the option's own type.
    ///
    /// # Errors
    /// As [`set`](Self::set).
    pub fn set_json(&mut self, name: &str, value: &Value) -> Result<(), OptionError> {
        let spec = spec_of(name)?;
        let text = match (spec.kind, value) {
            (OptionKind::Word(_), Value::String(word)) => word.clone(),
            (OptionKind::Integer { .. }, Value::Number(number)) => {
                number.to_string().trim_end_matches(".0").to_owned()
            }
            (OptionKind::Number { .. }, Value::Number(number)) => number.to_string(),
            (OptionKind::Flag, Value::Bool(flag)) => flag.to_string(),
            (OptionKind::Input | OptionKind::Plan, Value::Object(_))
            | (OptionKind::Targets | OptionKind::Edges, Value::Array(_)) => value.to_string(),
            _ => return Err(OptionError::Invalid { spec, value: value.to_string() }),
        };
        self.set(name, &text)
    }

    /// The options of two places, such as query and body, together.
    ///
    /// # Errors
    /// An option that has different values in them.
    pub fn join(mut self, other: Self) -> Result<Self, OptionError> {
        let taken = [
            ("format", put_if_given(&mut self.format, other.format)),
            ("output_format", put_if_given(&mut self.output_format, other.output_format)),
            ("reader", put_if_given(&mut self.reader, other.reader)),
            ("units", put_if_given(&mut self.units, other.units)),
            ("require", put_if_given(&mut self.require, other.require)),
            ("fill_holes", put_if_given(&mut self.fill_holes, other.fill_holes)),
            ("open_shells", put_if_given(&mut self.open_shells, other.open_shells)),
            ("wrap_cells", put_if_given(&mut self.wrap_cells, other.wrap_cells)),
            ("effort", put_if_given(&mut self.effort, other.effort)),
            ("wall_mm", put_if_given(&mut self.wall_mm, other.wall_mm)),
            ("recenter", put_if_given(&mut self.recenter, other.recenter)),
            ("max_deviation_mm", put_if_given(&mut self.max_deviation_mm, other.max_deviation_mm)),
            ("max_volume_change", put_if_given(&mut self.max_volume_change, other.max_volume_change)),
            ("nesting", put_if_given(&mut self.nesting, other.nesting)),
            ("contact", put_if_given(&mut self.contact, other.contact)),
            ("plan", put_if_given(&mut self.plan, other.plan)),
            ("faces", put_if_given(&mut self.faces, other.faces)),
            ("ratio", put_if_given(&mut self.ratio, other.ratio)),
            ("error_mm", put_if_given(&mut self.error_mm, other.error_mm)),
            ("targets", put_if_given(&mut self.targets, other.targets)),
            ("mode", put_if_given(&mut self.mode, other.mode)),
            ("criterion", put_if_given(&mut self.criterion, other.criterion)),
            ("placement", put_if_given(&mut self.placement, other.placement)),
            ("vertex_colors", put_if_given(&mut self.vertex_colors, other.vertex_colors)),
            ("cut", put_if_given(&mut self.cut, other.cut)),
            ("stitch", put_if_given(&mut self.stitch, other.stitch)),
            ("snap_epsilon_mm", put_if_given(&mut self.snap_epsilon_mm, other.snap_epsilon_mm)),
            ("stitch_validity", put_if_given(&mut self.stitch_validity, other.stitch_validity)),
            ("degenerate", put_if_given(&mut self.degenerate, other.degenerate)),
            ("cut_edges", put_if_given(&mut self.cut_edges, other.cut_edges)),
            ("policy", put_if_given(&mut self.policy, other.policy)),
            ("build_direction", put_if_given(&mut self.build_direction, other.build_direction)),
            ("near_mm", put_if_given(&mut self.near_mm, other.near_mm)),
            ("samples", put_if_given(&mut self.samples, other.samples)),
            ("result_ttl", put_if_given(&mut self.result_ttl, other.result_ttl)),
            ("input", put_if_given(&mut self.input, other.input)),
        ];
        for (name, taken) in taken {
            taken.into_result(spec_of(name)?, "")?;
        }
        Ok(self)
    }

    fn set_word(&mut self, spec: &OptionSpec, value: &str) -> Taken {
        match spec.name {
            "format" => put(&mut self.format, Format::from_word(value)),
            "output_format" => put(&mut self.output_format, Format::from_word(value)),
            "reader" => put(&mut self.reader, Reader::from_word(value)),
            "units" => put(&mut self.units, Units::from_word(value)),
            "require" => put(&mut self.require, Require::from_word(value)),
            "fill_holes" => put(&mut self.fill_holes, FillHoles::from_word(value)),
            "open_shells" => put(&mut self.open_shells, OpenShells::from_word(value)),
            "effort" => put(&mut self.effort, Effort::from_word(value)),
            "nesting" => put(&mut self.nesting, Nesting::from_word(value)),
            "contact" => put(&mut self.contact, Contact::from_word(value)),
            "mode" => put(&mut self.mode, Mode::from_word(value)),
            "criterion" => put(&mut self.criterion, Criterion::from_word(value)),
            "placement" => put(&mut self.placement, Placement::from_word(value)),
            "vertex_colors" => put(&mut self.vertex_colors, VertexColors::from_word(value)),
            "cut" => put(&mut self.cut, Cut::from_word(value)),
            "stitch" => put(&mut self.stitch, Stitch::from_word(value)),
            "stitch_validity" => put(&mut self.stitch_validity, StitchValidity::from_word(value)),
            "degenerate" => put(&mut self.degenerate, Degenerate::from_word(value)),
            "policy" => put(&mut self.policy, PolicyName::from_word(value)),
            "build_direction" => put(&mut self.build_direction, BuildDirection::from_word(value)),
            _ => Taken::Invalid,
        }
    }

    fn set_flag(&mut self, spec: &OptionSpec, value: &str) -> Taken {
        match spec.name {
            "recenter" => put(&mut self.recenter, value.parse().ok()),
            _ => Taken::Invalid,
        }
    }

    fn set_integer(&mut self, spec: &OptionSpec, value: u64) -> Taken {
        match spec.name {
            "faces" => put(&mut self.faces, u32::try_from(value).ok()),
            "wrap_cells" => put(&mut self.wrap_cells, u32::try_from(value).ok()),
            "samples" => put(&mut self.samples, u32::try_from(value).ok()),
            "result_ttl" => put(&mut self.result_ttl, Some(value)),
            _ => Taken::Invalid,
        }
    }

    fn set_number(&mut self, spec: &OptionSpec, value: f64) -> Taken {
        match spec.name {
            "ratio" => put(&mut self.ratio, Some(value)),
            "wall_mm" => put(&mut self.wall_mm, Some(value)),
            "max_deviation_mm" => put(&mut self.max_deviation_mm, Some(value)),
            "max_volume_change" => put(&mut self.max_volume_change, Some(value)),
            "error_mm" => put(&mut self.error_mm, Some(value)),
            "near_mm" => put(&mut self.near_mm, Some(value)),
            "snap_epsilon_mm" => put(&mut self.snap_epsilon_mm, Some(value)),
            _ => Taken::Invalid,
        }
    }
}

/// What became of a value.
enum Taken {
    Yes,
    Invalid,
    Contradictory,
}

impl Taken {
    fn into_result(self, spec: &'static OptionSpec, value: &str) -> Result<(), OptionError> {
        match self {
            Self::Yes => Ok(()),
            Self::Invalid => Err(OptionError::Invalid { spec, value: value.to_owned() }),
            Self::Contradictory => Err(OptionError::Contradictory { spec }),
        }
    }
}

fn put<T: PartialEq>(place: &mut Option<T>, value: Option<T>) -> Taken {
    match (&place, &value) {
        (_, None) => return Taken::Invalid,
        (Some(old), Some(new)) if old != new => return Taken::Contradictory,
        _ => *place = value,
    }
    Taken::Yes
}

fn put_if_given<T: PartialEq>(place: &mut Option<T>, value: Option<T>) -> Taken {
    if value.is_none() { Taken::Yes } else { put(place, value) }
}

/// A plain decimal number: no sign, no blank, no words such as `inf`.
fn parse_number(text: &str) -> Option<f64> {
    let is_plain = text.starts_with(|c: char| c.is_ascii_digit()) && !text.contains(' ');
    text.parse().ok().filter(|number: &f64| is_plain && number.is_finite())
}

/// A number written in digits only: no sign, no blank.
fn parse_digits(text: &str) -> Option<u64> {
    text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}
