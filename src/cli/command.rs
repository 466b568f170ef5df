//! The command line as a whole.

use super::arguments::Arguments;
use super::flags::options;
use crate::wire::Operation;
use clap::{Command, CommandFactory as _};

/// What `boolean` takes in the place of files that are taken one after the other.
const MESHES: &str = "Two or more mesh files. The difference is the first without all others.";

/// The command line, on which the help of each operation lists the options that it takes. The others are understood, so
/// that the answer is who takes them.
pub(super) fn command() -> Command {
    Operation::ALL.iter().fold(Arguments::command(), |command, &operation| {
        command.mut_subcommand(operation.word(), |command| {
            let foreign = options().filter(|spec| !spec.is_taken_by(operation));
            let command =
                foreign.fold(command, |command, spec| command.mut_arg(spec.name, |flag| flag.hide(true)));
            match operation {
                Operation::Boolean => command.mut_arg("inputs", |inputs| inputs.help(MESHES)),
                _ => command,
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::super::flags::{ENGINE_SETTINGS, engine_settings, given};
    use super::*;
    use crate::config::SETTINGS;

    fn has_flag(command: &Command, flag: &str) -> bool {
        command.get_arguments().any(|arg| arg.get_long() == Some(flag))
    }

    #[test]
    fn the_help_of_an_operation_lists_the_options_that_it_takes_and_no_other() {
        let command = command();
        for &operation in Operation::ALL {
            let subcommand = command.find_subcommand(operation.word()).unwrap();
            for spec in options() {
                let name = format!("{operation} --{}", spec.flag());
                let flag = subcommand.get_arguments().find(|arg| arg.get_long() == Some(&spec.flag()));
                assert_eq!(flag.expect(&name).is_hide_set(), !spec.is_taken_by(operation), "{name}");
            }
        }
    }

    #[test]
    fn a_negative_number_is_a_value() {
        let line = ["meshmend", "repair", "a.stl", "-o", "b.stl", "--wall-mm", "-1"];
        let matches = command().try_get_matches_from(line).unwrap();
        let (_, repair) = matches.subcommand().unwrap();
        assert_eq!(given(repair, options().map(|spec| spec.name)), [("wall_mm".to_owned(), "-1".to_owned())]);
    }

    #[test]
    fn every_setting_is_a_flag_of_serve_and_config() {
        let command = Arguments::command();
        let config = command.find_subcommand("config").unwrap();
        for subcommand in [
            command.find_subcommand("serve").unwrap(),
            command.find_subcommand("healthcheck").unwrap(),
            config.find_subcommand("show").unwrap(),
            config.find_subcommand("check").unwrap(),
        ] {
            for setting in SETTINGS {
                assert!(
                    has_flag(subcommand, &setting.flag()),
                    "{} --{}",
                    subcommand.get_name(),
                    setting.flag()
                );
            }
        }
        assert_eq!(engine_settings().count(), ENGINE_SETTINGS.len());
    }

    #[test]
    fn the_command_line_is_put_together_well() {
        command().debug_assert();
    }
}
