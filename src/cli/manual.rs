//! What shells and `man` know of the commands, made from the same flags.

use super::command;
use super::exit::{Exit, print, say};
use super::files::FileOrStream;
use clap_complete::Shell;
use clap_mangen::Man;
use std::fs;
use std::io;
use std::path::Path;

/// Prints the completions of `shell`.
pub(super) fn print_completions(shell: Shell) -> Exit {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command::command(), "meshmend", &mut script);
    print(&String::from_utf8_lossy(&script));
    Exit::Done
}

/// Writes `meshmend.1`, `meshmend-repair.1` and so on into `folder`.
pub(super) fn write_pages(folder: &Path) -> Exit {
    match pages().and_then(|pages| write_all(folder, &pages)) {
        Ok(()) => Exit::Done,
        Err(error) => {
            say(&format!("the manual pages cannot be written into {}: {error}", folder.display()));
            Exit::Internal
        }
    }
}

/// Names of files and their text.
fn pages() -> io::Result<Vec<(String, Vec<u8>)>> {
    let mut program = command::command();
    program.build();
    let mut pages = Vec::new();
    let mut waiting = vec![("meshmend".to_owned(), program)];
    while let Some((name, command)) = waiting.pop() {
        for inner in command.get_subcommands().filter(|inner| inner.get_name() != "help") {
            waiting.push((format!("{name}-{}", inner.get_name()), inner.clone()));
        }
        let mut page = Vec::new();
        // Pages are found by names that clap keeps for the life of the program; there are a dozen.
        let known: &'static str = String::leak(name.clone());
        Man::new(command.name(known)).render(&mut page)?;
        pages.push((format!("{name}.1"), page));
    }
    pages.sort();
    Ok(pages)
}

fn write_all(folder: &Path, pages: &[(String, Vec<u8>)]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    pages.iter().try_for_each(|(name, page)| FileOrStream::File(folder.join(name)).write(page))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_a_page_for_every_command_with_its_options() {
        let pages = pages().unwrap();
        let page = |name: &str| {
            let (_, text) = pages.iter().find(|(found, _)| found == name).unwrap();
            String::from_utf8(text.clone()).unwrap()
        };
        assert!(page("meshmend.1").contains("meshmend\\-repair(1)"), "{}", page("meshmend.1"));
        assert!(page("meshmend-repair.1").contains("\\-\\-wall\\-mm"));
        assert!(!page("meshmend-verify.1").contains("\\-\\-wall\\-mm"));
        assert!(page("meshmend-config-show.1").contains("\\-\\-listen"));
    }
}
