//! The options of every operation: one table for query parameters, JSON members and command-line flags.

use std::fmt;

use serde_json::{Map, Value};

use super::problem::{Problem, ProblemCode};
use super::request::InputRef;
use super::target::{self, TargetSpec};
use super::words::{
    Criterion, FillHoles, Format, Mode, Nesting, OpenShells, Placement, Reader, Require, Units,
};
use crate::formats::{ReadLimits, ReadOptions};
use crate::{pipeline, simplify};

/// What values an option takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OptionKind {
    /// One of these words.
    Word(&'static [&'static str]),
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
    /// A list of targets of a simplification.
    Targets,
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
    /// What it does, and what holds when it is absent.
    pub about: &'static str,
    /// It has no meaning on the command line.
    pub is_for_service_only: bool,
}

const fn option(name: &'static str, kind: OptionKind, about: &'static str) -> OptionSpec {
    OptionSpec { name, kind, about, is_for_service_only: false }
}

/// Every option.
pub const SPECS: &[OptionSpec] = &[
    option("format", OptionKind::Word(Format::WORDS), "Format of the input. Default: told by the content."),
    option(
        "output_format",
        OptionKind::Word(Format::WORDS),
        "Format of the output. Default: that of the input.",
    ),
    option("reader", OptionKind::Word(Reader::WORDS), "Reader of OBJ files. Default: own."),
    option(
        "units",
        OptionKind::Word(Units::WORDS),
        "Unit of the coordinates. Default: mm, reported as assumed.",
    ),
    option(
        "require",
        OptionKind::Word(Require::WORDS),
        "What the result must be. Default: printable for repair, none for the other operations.",
    ),
    option(
        "fill_holes",
        OptionKind::Word(FillHoles::WORDS),
        "Whether repair fills simple holes. Default: simple.",
    ),
    option(
        "open_shells",
        OptionKind::Word(OpenShells::WORDS),
        "How open shells are read where repair must rebuild the surface. Default: auto.",
    ),
    option(
        "wrap_cells",
        OptionKind::Integer { min: 16, max: 1024 },
        "Cells along the longest side of a surface that repair must rebuild. Default: up to 256, by its area.",
    ),
    option(
        "nesting",
        OptionKind::Word(Nesting::WORDS),
        "How shells inside shells are taken. Default: as_oriented.",
    ),
    option(
        "faces",
        OptionKind::Integer { min: 1, max: u32::MAX as u64 },
        "Simplify to at most this many faces. At most one of faces, ratio, error_mm and targets.",
    ),
    option(
        "ratio",
        OptionKind::Number { min: 0.0, max: 1.0 },
        "Simplify to at most this share of the faces. Default of simplify: 0.5.",
    ),
    option(
        "error_mm",
        OptionKind::Number { min: 0.0, max: 1e30 },
        "Simplify as far as no collapse has an error above this, in millimetres.",
    ),
    option(
        "targets",
        OptionKind::Targets,
        "Several results from one run: [{\"ratio\":0.5},{\"faces\":1000},{\"error_mm\":0.1}].",
    ),
    option(
        "mode",
        OptionKind::Word(Mode::WORDS),
        "How a simplification works. Default: guarded, which a repair always uses.",
    ),
    option(
        "criterion",
        OptionKind::Word(Criterion::WORDS),
        "What the collapse of an edge costs. Default: quadric.",
    ),
    option(
        "placement",
        OptionKind::Word(Placement::WORDS),
        "Where the vertex goes that an edge becomes. Default: optimal.",
    ),
    option(
        "samples",
        OptionKind::Integer { min: 0, max: 10_000 },
        "Witnesses that the report keeps of each defect. Default: 16.",
    ),
    OptionSpec {
        is_for_service_only: true,
        ..option(
            "result_ttl",
            OptionKind::Integer { min: 1, max: 31_536_000 },
            "Seconds for which the result is kept, at most the server's own limit. Default: that limit.",
        )
    },
    OptionSpec {
        is_for_service_only: true,
        ..option("input", OptionKind::Input, "An earlier job whose upload is used again: {\"job\":\"ID\"}.")
    },
];

/// The options of a request; `None`: not given.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// Format of the input.
    pub format: Option<Format>,
    /// Format of the output.
    pub output_format: Option<Format>,
    /// Reader of OBJ files.
    pub reader: Option<Reader>,
    /// Unit of the coordinates.
    pub units: Option<Units>,
    /// What the result must be.
    pub require: Option<Require>,
    /// Whether repair fills simple holes.
    pub fill_holes: Option<FillHoles>,
    /// How open shells are read where a surface is rebuilt.
    pub open_shells: Option<OpenShells>,
    /// Cells along the longest side of a surface that is rebuilt.
    pub wrap_cells: Option<u32>,
    /// How shells inside shells are taken.
    pub nesting: Option<Nesting>,
    /// Faces to simplify to.
    pub faces: Option<u32>,
    /// Share of the faces to simplify to.
    pub ratio: Option<f64>,
    /// Error to simplify up to, in millimetres.
    pub error_mm: Option<f64>,
    /// Several targets of a simplification.
    pub targets: Option<Vec<TargetSpec>>,
    /// How a simplification works.
    pub mode: Option<Mode>,
    /// What the collapse of an edge costs.
    pub criterion: Option<Criterion>,
    /// Where the vertex goes that an edge becomes.
    pub placement: Option<Placement>,
    /// Witnesses to keep of each defect.
    pub samples: Option<u32>,
    /// Seconds for which the result is kept.
    pub result_ttl: Option<u64>,
    /// An earlier job whose upload is used again.
    pub input: Option<InputRef>,
}

/// An option that cannot be taken.
#[derive(Debug, Clone, PartialEq)]
pub enum OptionError {
    /// There is no such option.
    Unknown {
        /// The name that was given.
        name: String,
        /// The nearest name there is.
        suggestion: Option<&'static str>,
    },
    /// The value is not one of the option's.
    Invalid {
        /// The option.
        spec: &'static OptionSpec,
        /// The value that was given.
        value: String,
    },
    /// It does not go with another one that is given.
    Excluded {
        /// The option.
        spec: &'static OptionSpec,
        /// The other one.
        by: &'static str,
    },
    /// It is given twice with different values.
    Contradictory {
        /// The option.
        spec: &'static OptionSpec,
    },
}

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
            OptionKind::Targets => put(&mut self.targets, target::targets_from_json(value)),
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
            (OptionKind::Input, Value::Object(_)) | (OptionKind::Targets, Value::Array(_)) => {
                value.to_string()
            }
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
            ("nesting", put_if_given(&mut self.nesting, other.nesting)),
            ("faces", put_if_given(&mut self.faces, other.faces)),
            ("ratio", put_if_given(&mut self.ratio, other.ratio)),
            ("error_mm", put_if_given(&mut self.error_mm, other.error_mm)),
            ("targets", put_if_given(&mut self.targets, other.targets)),
            ("mode", put_if_given(&mut self.mode, other.mode)),
            ("criterion", put_if_given(&mut self.criterion, other.criterion)),
            ("placement", put_if_given(&mut self.placement, other.placement)),
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
            "nesting" => put(&mut self.nesting, Nesting::from_word(value)),
            "mode" => put(&mut self.mode, Mode::from_word(value)),
            "criterion" => put(&mut self.criterion, Criterion::from_word(value)),
            "placement" => put(&mut self.placement, Placement::from_word(value)),
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
            "error_mm" => put(&mut self.error_mm, Some(value)),
            _ => Taken::Invalid,
        }
    }

    /// What no single option can say: that options go together.
    ///
    /// # Errors
    /// Two options that exclude each other.
    pub fn check(&self) -> Result<(), OptionError> {
        let given = [
            ("faces", self.faces.is_some()),
            ("ratio", self.ratio.is_some()),
            ("error_mm", self.error_mm.is_some()),
            ("targets", self.targets.is_some()),
        ];
        let mut given = given.into_iter().filter(|&(_, is_given)| is_given).map(|(name, _)| name);
        match (given.next(), given.next()) {
            (Some(by), Some(name)) => Err(OptionError::Excluded { spec: spec_of(name)?, by }),
            _ => Ok(()),
        }
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

    /// Both ask the engine for the same; how long the result is kept and where the bytes come from do not matter.
    pub fn give_the_same_as(&self, other: &Self) -> bool {
        let essence = |options: &Self| Self { result_ttl: None, input: None, ..options.clone() };
        essence(self) == essence(other)
    }

    /// The engine's options, under the configured limits on counts.
    pub fn to_engine(&self, limits: ReadLimits) -> pipeline::Options {
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
            },
            simplify: pipeline::SimplifyChoices {
                targets: self.targets(),
                mode: self.mode.map(Into::into),
                criterion: self.criterion.unwrap_or(Criterion::Quadric).into(),
                placement: self.placement.unwrap_or(Placement::Optimal).into(),
            },
            samples: self.samples.map(|n| n as usize),
            material: None,
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

fn spec_of(name: &str) -> Result<&'static OptionSpec, OptionError> {
    let names = || SPECS.iter().map(|spec| spec.name);
    SPECS
        .iter()
        .find(|spec| spec.name == name)
        .ok_or_else(|| OptionError::Unknown { name: name.to_owned(), suggestion: nearest(name, names()) })
}

/// The candidate that `word` was probably meant to be. The threshold is that of common command-line parsers: below a
/// Jaro similarity of 0.7 suggestions are noise.
pub(super) fn nearest(word: &str, candidates: impl Iterator<Item = &'static str>) -> Option<&'static str> {
    let word = word.to_ascii_lowercase().replace('-', "_");
    candidates
        .map(|candidate| (strsim::jaro(&word, candidate), candidate))
        .filter(|&(similarity, _)| similarity > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

impl OptionSpec {
    /// The option's name as a command-line flag, without the leading hyphens.
    pub fn flag(&self) -> String {
        self.name.replace('_', "-")
    }

    /// The words it takes; empty when it takes something else.
    pub fn words(&self) -> &'static [&'static str] {
        match self.kind {
            OptionKind::Word(words) => words,
            _ => &[],
        }
    }

    fn expected(&self) -> String {
        match self.kind {
            OptionKind::Word(words) => words.join(", "),
            OptionKind::Integer { min, max } => format!("a whole number from {min} to {max}"),
            OptionKind::Number { min, max } => format!("a number from {min} to {max:e}"),
            OptionKind::Targets => {
                "1 to 16 of {\"faces\":N}, {\"ratio\":X} and {\"error_mm\":X} in a list".to_owned()
            }
            OptionKind::Input => "{\"job\":\"ID\"}".to_owned(),
        }
    }
}

impl fmt::Display for OptionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { name, suggestion: Some(near) } => {
                write!(f, "unknown option `{name}`; did you mean `{near}`?")
            }
            Self::Unknown { name, suggestion: None } => write!(f, "unknown option `{name}`"),
            Self::Invalid { spec, value } => {
                write!(f, "`{}` cannot be `{value}`; expected {}", spec.name, spec.expected())?;
                match nearest(value, spec.words().iter().copied()) {
                    Some(near) => write!(f, "; did you mean `{near}`?"),
                    None => Ok(()),
                }
            }
            Self::Excluded { spec, by } => write!(f, "`{}` does not go with `{by}`", spec.name),
            Self::Contradictory { spec } => write!(f, "`{}` is given twice with different values", spec.name),
        }
    }
}

impl std::error::Error for OptionError {}

impl From<&OptionError> for Problem {
    fn from(error: &OptionError) -> Self {
        let of = |code, parameter: &str| Self {
            parameter: Some(parameter.to_owned()),
            ..Self::new(code, error.to_string())
        };
        match error {
            OptionError::Unknown { name, suggestion } => {
                Self { suggestion: *suggestion, ..of(ProblemCode::UnknownParameter, name) }
            }
            OptionError::Invalid { spec, value } => Self {
                allowed: spec.words().to_vec(),
                expected: Some(spec.expected()),
                suggestion: nearest(value, spec.words().iter().copied()),
                ..of(ProblemCode::InvalidParameter, spec.name)
            },
            OptionError::Contradictory { spec } | OptionError::Excluded { spec, .. } => {
                of(ProblemCode::InvalidParameter, spec.name)
            }
        }
    }
}

impl From<OptionError> for Problem {
    fn from(error: OptionError) -> Self {
        Self::from(&error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// A value that the option takes, as JSON.
    fn some_value(spec: &OptionSpec) -> Value {
        match spec.kind {
            OptionKind::Word(words) => json!(words[words.len() - 1]),
            OptionKind::Integer { min, .. } => json!(min),
            OptionKind::Number { max, .. } => json!(max),
            OptionKind::Targets => json!([{"ratio": 0.5}, {"faces": 10}]),
            OptionKind::Input => json!({"job": "x"}),
        }
    }

    #[test]
    fn every_option_reads_the_same_from_a_query_and_from_json() {
        let members: Map<_, _> = SPECS.iter().map(|spec| (spec.name.to_owned(), some_value(spec))).collect();
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let pairs = members.iter().map(|(name, value)| (name.clone(), text(value)));
        let from_query = Options::from_pairs(pairs).unwrap();
        assert_eq!(from_query, Options::from_json(&members).unwrap());
        for spec in SPECS {
            let one = Options::from_pairs([(spec.name, text(&members[spec.name]))]).unwrap();
            assert_ne!(one, Options::default(), "{} is taken and kept", spec.name);
        }
    }

    #[test]
    fn every_word_of_an_option_is_taken_and_no_other() {
        for spec in SPECS {
            for word in spec.words() {
                assert!(Options::from_pairs([(spec.name, word)]).is_ok(), "{}={word}", spec.name);
            }
            assert!(matches!(Options::from_pairs([(spec.name, "xyzzy")]), Err(OptionError::Invalid { .. })));
        }
    }

    #[test]
    fn an_unknown_option_is_named_with_the_nearest_one() {
        let error = Options::from_pairs([("outptu-format", "stl")]).unwrap_err();
        assert_eq!(
            error,
            OptionError::Unknown { name: "outptu-format".into(), suggestion: Some("output_format") }
        );
        let problem = Problem::from(&error);
        assert_eq!(problem.code, ProblemCode::UnknownParameter);
        assert_eq!(problem.suggestion, Some("output_format"));
        let error = Options::from_pairs([("qqq", "1")]).unwrap_err();
        assert_eq!(error, OptionError::Unknown { name: "qqq".into(), suggestion: None });
    }

    #[test]
    fn a_wrong_value_is_answered_with_the_allowed_ones() {
        let error = Options::from_pairs([("require", "printible")]).unwrap_err();
        let problem = Problem::from(&error);
        assert_eq!(problem.allowed, Require::WORDS);
        assert_eq!(problem.suggestion, Some("printable"));
        assert_eq!(problem.parameter.as_deref(), Some("require"));
    }

    #[test]
    fn numbers_out_of_range_or_not_in_digits_are_refused() {
        for value in ["-1", "+1", "", " 1", "1.5", "10001", "99999999999999999999"] {
            assert!(Options::from_pairs([("samples", value)]).is_err(), "samples={value}");
        }
        for value in [json!(-1), json!("1"), json!(1.5), json!(null), json!(10001)] {
            assert!(Options::default().set_json("samples", &value).is_err(), "{value}");
        }
        assert!(Options::default().set_json("samples", &json!(16.0)).is_ok());
    }

    #[test]
    fn an_option_may_be_repeated_but_not_contradicted() {
        assert!(Options::from_pairs([("units", "cm"), ("units", "cm")]).is_ok());
        let error = Options::from_pairs([("units", "cm"), ("units", "mm")]).unwrap_err();
        assert!(matches!(error, OptionError::Contradictory { spec } if spec.name == "units"));
    }

    #[test]
    fn options_of_two_places_are_joined_unless_they_contradict_each_other() {
        for spec in SPECS {
            let mut one = Options::default();
            one.set_json(spec.name, &some_value(spec)).unwrap();
            assert_eq!(one.clone().join(Options::default()).unwrap(), one);
            assert_eq!(Options::default().join(one.clone()).unwrap(), one, "{} is joined", spec.name);
        }
        let of = |units| Options::from_pairs([("units", units)]).unwrap();
        let error = of("cm").join(of("mm")).unwrap_err();
        assert!(matches!(error, OptionError::Contradictory { spec } if spec.name == "units"));
    }

    #[test]
    fn one_target_excludes_the_others_and_errors_are_in_the_unit_of_the_file() {
        let of = |pairs: &[(&str, &str)]| Options::from_pairs(pairs.iter().copied()).unwrap();
        let both = of(&[("faces", "10"), ("targets", r#"[{"ratio":0.5}]"#)]);
        assert!(
            matches!(both.check(), Err(OptionError::Excluded { spec, by: "faces" }) if spec.name == "targets")
        );
        let inches = of(&[("error_mm", "2.54"), ("units", "in")]);
        assert!(inches.check().is_ok());
        let targets = inches.to_engine(ReadLimits::default()).simplify.targets;
        assert!(matches!(targets[..], [simplify::Target::Error(e)] if (e - 0.1).abs() < 1e-12));
        for wrong in
            ["[]", "[{}]", r#"[{"ratio":2}]"#, r#"[{"faces":0}]"#, r#"[{"ratio":0.5,"faces":1}]"#, "[5]"]
        {
            assert!(Options::from_pairs([("targets", wrong)]).is_err(), "{wrong}");
        }
        for wrong in ["nan", "inf", "-1", "1e400", "0x1", ""] {
            assert!(Options::from_pairs([("error_mm", wrong)]).is_err(), "{wrong}");
        }
    }

    #[test]
    fn options_reach_the_engine() {
        let options =
            Options::from_pairs([("reader", "tobj"), ("samples", "3"), ("output_format", "ply")]).unwrap();
        let engine = options.to_engine(ReadLimits { triangles_max: 7, ..ReadLimits::default() });
        assert_eq!(engine.read.obj_reader, crate::formats::ObjReader::Tobj);
        assert_eq!(engine.read.limits.triangles_max, 7);
        assert_eq!(engine.samples, Some(3));
        assert_eq!(engine.output_format, Some(crate::formats::Format::Ply));
    }
}
