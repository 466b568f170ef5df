//! `migrate`: what was carried over, in words.

use super::exit::{Exit, print, say};
use super::settings::with_loaded;
use crate::config::{Loaded, Sources};
use crate::jobs::Migrated;

/// Carries over, and says what. The exit is negative when files were lost or damaged before.
pub(super) fn run(sources: &Sources, migrate: fn(&Loaded) -> anyhow::Result<Migrated>) -> Exit {
    let mut has_lost = false;
    let exit = with_loaded(sources, |loaded| {
        let migrated = migrate(loaded)?;
        for key in &migrated.unsound {
            say(&format!(
                "the file {key} is lost or damaged in the data directory; its job is carried over without it"
            ));
        }
        has_lost = !migrated.unsound.is_empty();
        print(&told(&migrated));
        Ok(())
    });
    if exit == Exit::Done && has_lost { Exit::Negative } else { exit }
}

fn told(migrated: &Migrated) -> String {
    let Migrated { jobs, files, bytes, files_of_earlier_tries, unsound } = migrated;
    let earlier = match files_of_earlier_tries {
        0 => String::new(),
        number => format!(", {number} of them by an earlier try"),
    };
    let without = match unsound.len() {
        0 => String::new(),
        number => format!("; {number} files were lost or damaged before"),
    };
    format!("{jobs} jobs and {files} files ({bytes} bytes) are carried over{earlier}{without}\n")
}
