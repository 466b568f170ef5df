//! What a misspelt word was probably meant to be.

/// The candidate that `word` was probably meant to be. The threshold is that of common command-line parsers: below a
/// Jaro similarity of 0.7 suggestions are noise.
pub(in crate::wire) fn nearest<'w>(word: &str, candidates: impl Iterator<Item = &'w str>) -> Option<&'w str> {
    let word = word.to_ascii_lowercase().replace('-', "_");
    candidates
        .map(|candidate| (strsim::jaro(&word, candidate), candidate))
        .filter(|&(similarity, _)| similarity > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}
