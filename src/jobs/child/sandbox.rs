//! What a child gives up before it looks at bytes that others sent.

use std::fmt;
use std::io;

use rustix::io::Errno;
use rustix::thread::{CapabilitySet, CapabilitySets};
use serde::{Deserialize, Serialize};

use super::workspace::Rooms;
use super::{calls, files};

/// How much of the sandbox there must be.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sandbox {
    /// What the kernel has.
    #[default]
    Auto,
    /// All of it, or no job runs.
    Require,
    /// None.
    Off,
}

/// What holds a process.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Protections {
    /// Version of landlock's interface: it reads and writes in its own folder and reaches no other file; `None`: not so.
    pub(super) landlock_abi: Option<u32>,
    /// It may make the system calls of a computation only.
    pub(super) is_filtered: bool,
    /// It has capabilities of root, which a container does not let it give up.
    pub(super) keeps_capabilities: bool,
}

impl Protections {
    /// Nothing is missing.
    pub(super) fn are_complete(self) -> bool {
        self.landlock_abi.is_some() && self.is_filtered && !self.keeps_capabilities
    }
}

impl fmt::Display for Protections {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.landlock_abi {
            Some(abi) => write!(f, "landlock (ABI {abi})")?,
            None => f.write_str("no landlock")?,
        }
        f.write_str(if self.is_filtered { ", seccomp filter" } else { ", no seccomp filter" })?;
        f.write_str(if self.keeps_capabilities { ", capabilities of root" } else { "" })
    }
}

impl Sandbox {
    /// Confines this process, which has one thread, to its folder.
    pub(super) fn enter(self, rooms: &Rooms) -> io::Result<Protections> {
        if self == Self::Off {
            return Ok(Protections::default());
        }
        rustix::thread::set_no_new_privs(true)?;
        let keeps_capabilities = !drop_capabilities()?.is_empty();
        let landlock_abi = files::confine_to(rooms)?;
        let is_filtered = calls::confine()?;
        let protections = Protections { landlock_abi, is_filtered, keeps_capabilities };
        if self == Self::Require && !protections.are_complete() {
            return Err(io::Error::new(
                io::ErrorKind::Unsupported,
                format!("the kernel does not give the whole sandbox: {protections}"),
            ));
        }
        Ok(protections)
    }
}

/// Gives up all that root may do beyond other users, for good, and gives what is left of it. A process of another user has none of it
/// to give up.
fn drop_capabilities() -> io::Result<CapabilitySet> {
    let as_far_as_allowed = |result| match result {
        // A process of another user, a container that forbids the call, or an older kernel.
        Err(Errno::PERM | Errno::NOSYS | Errno::INVAL) => Ok(()),
        result => result,
    };
    for capability in CapabilitySet::all().iter() {
        as_far_as_allowed(rustix::thread::remove_capability_from_bounding_set(capability))?;
    }
    let none = CapabilitySet::empty();
    let sets = CapabilitySets { effective: none, permitted: none, inheritable: none };
    as_far_as_allowed(rustix::thread::set_capabilities(None, sets))?;
    Ok(rustix::thread::capabilities(None)?.permitted)
}
