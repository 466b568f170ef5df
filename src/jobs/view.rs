//! A job as others see it: the public view of its row, and its files to send.

use super::live::Live;
use super::store::{JobRow, ResultRef};
use crate::wire::{self, Encoding, Job, JobState, Links, Outcome, PictureFormat, Progress};

/// A mesh that can be sent.
#[derive(Debug)]
pub struct StoredFile {
    /// The open file. It stays readable although the job is deleted meanwhile.
    pub file: tokio::fs::File,
    /// Number of bytes.
    pub bytes: u64,
    /// SHA-256 of the bytes.
    pub sha256: [u8; 32],
    /// How the mesh is laid out.
    pub encoding: Encoding,
    /// Name to save it under: letters, digits, dots, hyphens and underscores only.
    pub file_name: String,
}

impl StoredFile {
    pub(super) fn of(file: std::fs::File, result: &ResultRef, file_name: String) -> Self {
        let ResultRef { blob, encoding } = result;
        Self { file: file.into(), bytes: blob.bytes, sha256: blob.sha256, encoding: *encoding, file_name }
    }
}

/// The public view of `row`; `live` is what this process knows of a running job.
pub(super) fn job(row: &JobRow, live: Option<&Live>) -> Job {
    let id = row.id.to_string();
    let ending = row.ending.as_ref();
    let has_files = row.state != JobState::Expired;
    let has_report = has_files && ending.is_some_and(|ending| ending.report.is_some());
    let has_result = has_files && ending.is_some_and(|ending| ending.result.is_some());
    let has_picture = has_files && ending.is_some_and(|ending| ending.picture.is_some());
    let picture = has_picture.then(|| row.options.picture_format.unwrap_or(PictureFormat::Png));
    let links = Links::new(&id, has_report, has_result, picture);
    Job {
        state: row.state,
        operation: row.operation,
        created_at: row.created_at,
        started_at: row.started_at,
        finished_at: row.finished_at,
        expires_at: row.expires_at,
        progress: progress(row, live),
        outcome: ending.and_then(|ending| ending.outcome),
        fidelity: ending.and_then(|ending| ending.fidelity),
        problem: ending
            .and_then(|ending| ending.problem.clone())
            .map(|problem| problem.with_instance(&links.this)),
        timing_ms: ending.and_then(|ending| ending.timing_ms),
        attempts: row.attempts,
        labels: row.labels.clone(),
        cached: row.is_cached,
        id,
        links,
    }
}

fn progress(row: &JobRow, live: Option<&Live>) -> Progress {
    let clock = live.and_then(|live| live.clock.as_ref());
    match (&row.ending, clock) {
        (Some(ending), _) => ending.progress,
        (None, Some(clock)) => clock.progress(),
        (None, None) => Progress { stage: None, fraction: 0.0 },
    }
}

/// Name for a mesh of a job: that of the upload, marked when it was changed, with a number when there are several.
pub(super) fn result_name(row: &JobRow, encoding: Encoding, level: usize) -> String {
    let ending = row.ending.as_ref();
    let mark = match ending.and_then(|ending| ending.outcome) {
        Some(Outcome::Simplified) => "-simplified",
        Some(Outcome::CutStitched) => "-cut-stitched",
        Some(Outcome::Filled) => "-filled",
        Some(Outcome::Modelled) => "-modelled",
        Some(Outcome::Combined) => "-combined",
        Some(Outcome::Repaired) => "-repaired",
        Some(Outcome::Rebuilt) => "-rebuilt",
        Some(Outcome::Partial) => "-partial",
        _ => "",
    };
    let format = crate::formats::Encoding::from(encoding).format().into();
    let has_levels = ending.is_some_and(|ending| !ending.levels.is_empty());
    let number = if has_levels { format!("-{}", level + 1) } else { String::new() };
    format!("{}{mark}{number}.{}", stem(row), wire::extension_of(format))
}

/// The uploaded file's name without directories and extension; marks that some system forbids in names, or that hide how a
/// name reads, become `_`.
fn stem(row: &JobRow) -> String {
    let name = row.file_name.as_deref().unwrap_or_default();
    let base = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = base.rsplit_once('.').map_or(base, |(stem, _)| stem);
    let stem = without_forbidden(stem);
    if stem.is_empty() { format!("mesh-{}", row.id) } else { stem }
}

/// Most bytes of the beginning of a name: file systems take 255 in all.
const STEM_BYTES_MAX: usize = 200;

/// The first 100 letters of `stem`, without what some system forbids in a name and what hides how it reads.
fn without_forbidden(stem: &str) -> String {
    let is_forbidden = |c: char| c.is_control() || "<>:\"/\\|?*".contains(c);
    let is_unseen = |c: char| matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{e0000}'..='\u{e007f}');
    let told = |c: char| if is_forbidden(c) || is_unseen(c) { '_' } else { c };
    let mut stem: String = stem.chars().take(100).map(told).collect();
    while stem.len() > STEM_BYTES_MAX {
        stem.pop();
    }
    stem.trim_start_matches(['.', ' ']).trim_end_matches(['.', ' ']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_all_marks_but_those_that_a_system_forbids_or_that_hide_how_they_read() {
        assert_eq!(
            without_forbidden("Kapsel & Deckel; 50 % 'neu' e\u{301}"),
            "Kapsel & Deckel; 50 % 'neu' e\u{301}"
        );
        assert_eq!(without_forbidden("..a<b>:\"c|d?*\r\n\u{202e}lts "), "a_b___c_d_____lts");
        assert_eq!(without_forbidden(" . "), "");
        assert_eq!(without_forbidden(&"ä".repeat(300)).chars().count(), 100);
        assert_eq!(without_forbidden(&"部".repeat(300)).len(), 198);
    }
}
