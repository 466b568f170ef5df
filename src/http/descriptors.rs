//! File descriptors: as many as the connections need, as far as the system allows.

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

/// Descriptors of a connection: its socket, and the file that its upload goes to.
const PER_CONNECTION: u64 = 2;
/// Descriptors for all the rest.
const BESIDE: u64 = 256;

/// Raises the soft limit of this process so that `connections` fit; gives the number that does.
pub(super) fn make_room(connections: usize) -> usize {
    let limit = getrlimit(Resource::Nofile);
    let (soft, hard) = (limit.current.unwrap_or(u64::MAX), limit.maximum.unwrap_or(u64::MAX));
    let wanted = (connections as u64).saturating_mul(PER_CONNECTION).saturating_add(BESIDE);
    let mut granted = soft;
    if soft < wanted {
        let raised = Rlimit { current: Some(wanted.min(hard)), maximum: limit.maximum };
        if setrlimit(Resource::Nofile, raised).is_ok() {
            granted = wanted.min(hard);
        }
    }
    fitting(connections, granted)
}

/// How many of `connections` fit into `descriptors`; one always does.
fn fitting(connections: usize, descriptors: u64) -> usize {
    let room = descriptors.saturating_sub(BESIDE) / PER_CONNECTION;
    connections.min(usize::try_from(room).unwrap_or(usize::MAX)).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn connections_are_cut_to_what_the_descriptors_allow() {
        assert_eq!(fitting(4096, 10_000), 4096);
        assert_eq!(fitting(4096, 1024), 384);
        assert_eq!(fitting(4096, 10), 1);
    }

    #[test]
    fn the_soft_limit_is_raised_when_there_is_need() {
        let before = getrlimit(Resource::Nofile).current.unwrap_or(u64::MAX);
        assert_eq!(make_room(1), 1);
        assert!(getrlimit(Resource::Nofile).current.unwrap_or(u64::MAX) >= before);
    }
}
