//! Files of a child, by landlock: it may read those in one folder, make files in another, and open nothing else by name.

use std::io;

use landlock::{
    ABI, Access, AccessFs, AccessNet, LandlockStatus, PathBeneath, PathFd, Ruleset, RulesetAttr,
    RulesetCreatedAttr, RulesetStatus, Scope,
};

use super::workspace::Rooms;

/// Confines this thread and those that it starts; files that are open stay so. The version of the kernel's interface, or
/// `None` where it has none.
pub(super) fn confine_to(rooms: &Rooms) -> io::Result<Option<u32>> {
    let given = PathFd::new(rooms.given()).map_err(io::Error::other)?;
    let made = PathFd::new(rooms.all_made()).map_err(io::Error::other)?;
    // Of later rights than the kernel knows, the crate asks for none.
    let status = Ruleset::default()
        .handle_access(AccessFs::from_all(ABI::V5))
        .and_then(|rules| rules.handle_access(AccessNet::from_all(ABI::V4)))
        .and_then(|rules| rules.scope(Scope::from_all(ABI::V6)))
        .and_then(Ruleset::create)
        .and_then(|rules| rules.add_rule(PathBeneath::new(given, AccessFs::ReadFile)))
        .and_then(|rules| rules.add_rule(PathBeneath::new(made, AccessFs::MakeReg | AccessFs::WriteFile)))
        .and_then(landlock::RulesetCreated::restrict_self)
        .map_err(io::Error::other)?;
    let is_enforced = status.ruleset != RulesetStatus::NotEnforced;
    Ok(match status.landlock {
        LandlockStatus::Available { effective_abi, .. } if is_enforced => Some(effective_abi as u32),
        _ => None,
    })
}
