//! Values that sentences repeat.

/// Most characters of a value that a sentence repeats.
const REPEATED_MAX: usize = 60;

/// The value as a sentence repeats it: of a long one the beginning.
pub(super) fn shortened(value: &str) -> String {
    match value.char_indices().nth(REPEATED_MAX) {
        Some((end, _)) => format!("{}…", &value[..end]),
        None => value.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_long_value_the_beginning_is_repeated() {
        assert_eq!(shortened("weld"), "weld");
        assert_eq!(shortened(&"ü".repeat(100)), format!("{}…", "ü".repeat(60)));
    }
}
