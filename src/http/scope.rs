//! What a key may be used for.

use std::fmt;

use axum::http::Method;

use crate::wire::{Problem, ProblemCode};

/// What paths of uploads begin with.
const UPLOADS: &str = "/v1/uploads";

/// What a key may be used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scopes {
    can_read: bool,
    can_submit: bool,
}

/// One of the things that a key may be used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scope {
    /// Ask for what is there.
    Read,
    /// Send meshes, make, cancel and delete jobs.
    Submit,
}

impl Scope {
    /// What a request needs. Who sends an upload asks where it stands.
    fn of(method: &Method, path: &str) -> Self {
        let is_of_upload = path.starts_with(UPLOADS);
        if method.is_safe() && !is_of_upload { Self::Read } else { Self::Submit }
    }
}

impl fmt::Display for Scope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Read => "read",
            Self::Submit => "submit",
        })
    }
}

impl Scopes {
    /// All of them: those of a key without a list, and of everybody where there are no keys.
    pub(super) const ALL: Self = Self { can_read: true, can_submit: true };

    /// Reads `read`, `submit` or both with a comma.
    pub(super) fn parse(list: &str) -> Option<Self> {
        let mut scopes = Self { can_read: false, can_submit: false };
        for word in list.split(',') {
            match word.trim() {
                "read" => scopes.can_read = true,
                "submit" => scopes.can_submit = true,
                _ => return None,
            }
        }
        Some(scopes)
    }

    /// Refuses a request that needs a scope which is not there.
    pub(super) fn check(self, method: &Method, path: &str) -> Result<(), Problem> {
        let scope = Scope::of(method, path);
        let is_there = match scope {
            Scope::Read => self.can_read,
            Scope::Submit => self.can_submit,
        };
        if is_there {
            return Ok(());
        }
        Err(Problem::new(ProblemCode::Forbidden, format!("the key has no scope `{scope}`")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_method_that_changes_something_needs_submit_and_any_other_read() {
        let on = |list: &str, method, path| Scopes::parse(list).unwrap().check(&method, path).is_ok();
        let is_allowed = |list: &str, method| on(list, method, "/v1/jobs");
        assert!(is_allowed("read", Method::GET) && is_allowed("read", Method::HEAD));
        assert!(!is_allowed("read", Method::POST) && !is_allowed("read", Method::DELETE));
        assert!(is_allowed("submit", Method::POST) && !is_allowed("submit", Method::GET));
        assert!(on("submit", Method::HEAD, "/v1/uploads/7") && !on("read", Method::HEAD, "/v1/uploads/7"));
        assert!(is_allowed("read, submit", Method::DELETE) && is_allowed("submit,read", Method::GET));
    }

    #[test]
    fn a_word_that_is_no_scope_is_refused() {
        for list in ["", "all", "read,", "read submit"] {
            assert_eq!(Scopes::parse(list), None, "{list}");
        }
    }
}
