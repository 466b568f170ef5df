//! Counts for people.

/// So many things of that name.
pub(super) fn counted(count: u64, name: &str) -> String {
    let plural = match name.strip_suffix("vertex") {
        Some(which) => format!("{which}vertices"),
        None => format!("{name}s"),
    };
    if count == 1 { format!("1 {name}") } else { format!("{count} {plural}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_not_a_plural() {
        assert_eq!(counted(1, "vertex"), "1 vertex");
        assert_eq!(counted(0, "triangle"), "0 triangles");
        assert_eq!(counted(8, "vertex"), "8 vertices");
        assert_eq!(counted(4, "new vertex"), "4 new vertices");
    }
}
