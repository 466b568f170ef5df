//! The command line: the same engine, options and report as the service.

mod arguments;
mod check;
mod colours;
mod command;
mod exit;
mod figures;
mod files;
mod flags;
mod manual;
mod migrate;
mod model;
mod settings;
mod several;
mod summary;
mod watch;
mod work;

use crate::config::{Config, ConfigError, Loaded};
use crate::formats::Format;
use crate::jobs::{LostStore, Migrated, RUN_JOB, run_job};
use crate::pipeline::{self, Operation};
use arguments::{Arguments, Command, SettingsCommand};
use clap::FromArgMatches as _;
use exit::Exit;
use std::ffi::OsString;
use std::process::ExitCode;

/// What `main` brings from the service, so that this module knows no HTTP.
#[derive(Debug, Clone, Copy)]
pub struct ServiceHooks {
    /// Serves until it is told to stop.
    pub serve: fn(&Loaded, LostStore) -> anyhow::Result<()>,
    /// Finds the setting with which it would not serve.
    pub check: fn(&Loaded) -> Result<(), ConfigError>,
    /// Fails unless the service of this configuration is ready.
    pub healthcheck: fn(&Config) -> anyhow::Result<()>,
    /// Carries what is in the data directory over to the stores that several servers share.
    pub migrate: fn(&Loaded) -> anyhow::Result<Migrated>,
}

/// Runs the command line `args`, the program's name first.
///
/// Exit codes: 0 did what was asked; 1 no certified result, or the file is not valid; 2 unreadable or wrong usage;
/// 3 limit, deadline or cancelled; 4 internal.
pub fn run(args: impl IntoIterator<Item = OsString>, service: ServiceHooks) -> ExitCode {
    let args: Vec<OsString> = args.into_iter().collect();
    if args.get(1).is_some_and(|command| command == RUN_JOB) {
        // Before anything else: a job's process has nothing to do with flags, settings and logs.
        return run_job(pipeline::run);
    }
    let parsed = command::command().try_get_matches_from(with_default_command(args));
    let exit = match parsed.and_then(|matches| Arguments::from_arg_matches(&matches)) {
        Ok(arguments) => execute(arguments.command, service),
        Err(error) => {
            // A closed pipe is all that can go wrong here, and then nobody reads on.
            let _ = error.print();
            if error.use_stderr() { Exit::Usage } else { Exit::Done }
        }
    };
    exit.into()
}

/// `serve` is meant when the command line is empty or begins with one of its flags.
fn with_default_command(args: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut args: Vec<OsString> = args.into_iter().collect();
    let is_own = |flag: &OsString| ["-h", "--help", "-V", "--version"].iter().any(|own| flag == own);
    let is_flag = |arg: &OsString| arg.to_string_lossy().starts_with('-') && !is_own(arg);
    if args.get(1).is_none_or(is_flag) {
        args.insert(1.min(args.len()), "serve".into());
    }
    args
}

fn execute(command: Command, service: ServiceHooks) -> Exit {
    match command {
        Command::Serve(given) => {
            let lost_store = given.lost_store();
            settings::with_loaded(&given.sources(), |loaded| (service.serve)(loaded, lost_store))
        }
        Command::Healthcheck(given) => {
            match settings::with_loaded(&given.sources(), |loaded| (service.healthcheck)(&loaded.config)) {
                // Container runtimes know 0 and 1 only.
                Exit::Done => Exit::Done,
                _ => Exit::Negative,
            }
        }
        Command::Migrate(given) => migrate::run(&given.sources(), service.migrate),
        Command::Config(SettingsCommand::Show(given)) => settings::show(&given.sources()),
        Command::Config(SettingsCommand::Check { given, strict }) => {
            settings::check(&given.sources(), strict, service.check)
        }
        Command::Completions { shell } => manual::print_completions(shell),
        Command::Man { folder } => manual::write_pages(&folder),
        Command::Analyze(given) => several::run(&given.request(Operation::Analyze)),
        Command::Plan(given) => several::run(&given.request(Operation::Plan)),
        Command::Verify(given) => several::run(&given.into()),
        Command::Repair(given) => several::run(&given.into()),
        Command::Convert(given) => several::run(&given.into()),
        Command::Simplify(given) => several::run(&given.into()),
        Command::CutStitch(given) => several::run(&given.into()),
        Command::FillHoles(given) => several::run(&given.into()),
        Command::Modeller(given) => several::run(&given.into()),
        Command::Boolean(given) => several::run(&given.into()),
        Command::Render(given) => several::run(&given.into()),
        Command::Check { input, format } => {
            check::run(&input, format.and_then(|word| Format::from_name(&word)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(args: &[&str]) -> Vec<String> {
        let args = with_default_command(args.iter().map(OsString::from));
        args.into_iter().map(|arg| arg.into_string().unwrap()).collect()
    }

    #[test]
    fn serve_is_the_default_command() {
        assert_eq!(words(&["meshmend"]), ["meshmend", "serve"]);
        assert_eq!(words(&["meshmend", "--listen", "[::1]:1"]), ["meshmend", "serve", "--listen", "[::1]:1"]);
        assert_eq!(words(&["meshmend", "--help"]), ["meshmend", "--help"]);
        assert_eq!(words(&["meshmend", "verify", "-"]), ["meshmend", "verify", "-"]);
    }
}
