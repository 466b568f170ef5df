//! Flags made from the tables of options and settings, so that names and values cannot differ from theirs.

use crate::config::{SETTINGS, Setting};
use crate::wire::{OptionKind, OptionSpec, SPECS};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Arg, ArgMatches, Command};
use std::fs::File;
use std::io::Read as _;

/// Settings that mean something without a service.
pub(super) const ENGINE_SETTINGS: [&str; 7] = [
    "triangles_max",
    "vertices_max",
    "polygon_corners_max",
    "deadline_max",
    "engine_bytes_max",
    "engine_work_max",
    "engine_threads",
];

/// Every option of the engine, as given: names and values.
#[derive(Debug, Clone, Default)]
pub(super) struct OptionFlags(pub Vec<(String, String)>);

/// Every setting, as given: names and values.
#[derive(Debug, Clone, Default)]
pub(super) struct SettingFlags(pub Vec<(String, String)>);

/// The settings that mean something without a service.
#[derive(Debug, Clone, Default)]
pub(super) struct EngineSettingFlags(pub Vec<(String, String)>);

pub(super) fn options() -> impl Iterator<Item = &'static OptionSpec> {
    SPECS.iter().filter(|spec| !spec.is_for_service_only)
}

pub(super) fn engine_settings() -> impl Iterator<Item = &'static Setting> {
    SETTINGS.iter().filter(|setting| ENGINE_SETTINGS.contains(&setting.name))
}

/// What an option does; where the service answers on a path, a command or a page says the same.
fn about(spec: &OptionSpec) -> String {
    spec.about.replace("/v1/plan", "`meshmend plan`").replace("/v1/policies", "docs/printing.md")
}

/// `text` with options in the words of the command line: `--wall-mm` for `wall_mm`, if that stands between such signs.
pub(super) fn with_flags(text: &str) -> String {
    let worded = |(place, piece): (usize, &str)| {
        let (name, value) = piece.split_once('=').map_or((piece, None), |(name, value)| (name, Some(value)));
        match options().find(|spec| spec.name == name).filter(|_| place % 2 == 1) {
            Some(spec) => {
                format!("--{}{}", spec.flag(), value.map_or_else(String::new, |value| format!("={value}")))
            }
            None => piece.to_owned(),
        }
    };
    text.split('`').enumerate().map(worded).collect::<Vec<_>>().join("`")
}

fn option_flag(spec: &'static OptionSpec) -> Arg {
    let flag = Arg::new(spec.name).long(spec.flag()).help(about(spec)).help_heading("Mesh options");
    // The name as it stands in JSON is understood as well.
    let flag = if spec.name.contains('_') { flag.alias(spec.name) } else { flag };
    // As the command says what is done, so that this cannot be another operation.
    let flag = if spec.name == "set_operation" { flag.visible_alias("operation") } else { flag };
    match spec.kind {
        OptionKind::Word { words, abouts, .. } => {
            let value = |(&word, about): (&&'static str, &&'static str)| {
                PossibleValue::new(word).help(about.trim().trim_end_matches('.'))
            };
            let values = words.iter().zip(abouts).map(value);
            flag.value_name("WORD").value_parser(PossibleValuesParser::new(values))
        }
        // A negative number is a value out of range, not a flag of that name.
        OptionKind::Integer { .. } | OptionKind::Number { .. } => {
            flag.value_name("NUMBER").allow_negative_numbers(true)
        }
        OptionKind::Flag => {
            flag.value_name("true|false").value_parser(PossibleValuesParser::new(["true", "false"]))
        }
        OptionKind::Input
        | OptionKind::Targets
        | OptionKind::Edges
        | OptionKind::Holes
        | OptionKind::Edits
        | OptionKind::Ranges
        | OptionKind::Plan => flag.value_name("JSON|@FILE").value_parser(text_or_file),
    }
}

/// Most bytes of a value that stands in a file.
const VALUE_BYTES_MAX: u64 = 64 << 20;

/// The value itself, or after `@` the file that holds it. No JSON begins with `@`.
fn text_or_file(text: &str) -> Result<String, String> {
    let Some(path) = text.strip_prefix('@') else { return Ok(text.to_owned()) };
    let told = |error: std::io::Error| format!("cannot read {path}: {error}");
    let mut value = String::new();
    File::open(path).map_err(told)?.take(VALUE_BYTES_MAX + 1).read_to_string(&mut value).map_err(told)?;
    let is_small = value.len() as u64 <= VALUE_BYTES_MAX;
    if is_small { Ok(value) } else { Err(format!("{path} is over {VALUE_BYTES_MAX} bytes")) }
}

fn setting_flag(setting: &'static Setting) -> Arg {
    let default = if setting.default.is_empty() { "none" } else { setting.default };
    let flag = Arg::new(setting.name)
        .long(setting.flag())
        .value_name("VALUE")
        .help(format!("{} [{}: {default}]", setting.about, setting.variable()))
        .help_heading("Settings")
        .hide_short_help(true);
    match (setting.name, setting.expected) {
        ("engine_threads", _) => flag.alias("threads"),
        // A switch needs no value.
        (_, "true or false") => flag.num_args(0..=1).require_equals(true).default_missing_value("true"),
        _ => flag,
    }
}

/// The values of the flags `names` that were given.
pub(super) fn given(
    matches: &ArgMatches,
    names: impl Iterator<Item = &'static str>,
) -> Vec<(String, String)> {
    let value = |name: &str| matches.get_one::<String>(name).cloned();
    names.filter_map(|name| Some((name.to_owned(), value(name)?))).collect()
}

/// Implements clap's traits for a list of flags.
macro_rules! flags {
    ($type:ident, $rows:expr, $flag:expr) => {
        impl clap::Args for $type {
            fn augment_args(command: Command) -> Command {
                $rows.map($flag).fold(command, Command::arg)
            }

            fn augment_args_for_update(command: Command) -> Command {
                Self::augment_args(command)
            }
        }

        impl clap::FromArgMatches for $type {
            fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
                Ok(Self(given(matches, $rows.map(|row| row.name))))
            }

            fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
                self.0.extend(given(matches, $rows.map(|row| row.name)));
                Ok(())
            }
        }
    };
}

flags!(OptionFlags, options(), option_flag);
flags!(SettingFlags, SETTINGS.iter(), setting_flag);
flags!(EngineSettingFlags, engine_settings(), setting_flag);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_in_a_sentence_are_named_as_flags() {
        for (text, want) in [
            ("`max_deviation_mm` allows 0.5 mm", "`--max-deviation-mm` allows 0.5 mm"),
            ("set `recenter=true`", "set `--recenter=true`"),
            ("`/v1/plan` and units", "`/v1/plan` and units"),
        ] {
            assert_eq!(with_flags(text), want);
        }
    }

    #[test]
    fn no_help_sends_to_a_path_of_the_service() {
        for spec in options() {
            assert!(!about(spec).contains("/v1/"), "{}", about(spec));
        }
    }
}
