//! One linked binary for this folder; each module is a group of tests that drive the built binary.

#[path = "../support/mod.rs"]
#[allow(dead_code, reason = "each folder uses a part of it")]
mod support;

mod about;
mod access;
mod boolean;
mod cli;
mod connections;
mod contract;
mod cors;
mod curl;
mod heads;
mod isolation;
mod killed;
mod lanes;
mod lifecycle;
mod listing;
mod meshes;
mod migrated;
mod neighbours;
mod operations;
mod ordering;
mod pictures;
mod presigned;
mod printing;
mod privacy;
mod problems;
#[allow(dead_code, reason = "the tests of faults use the rest")]
mod processes;
mod rates;
mod receiver;
mod restarts;
mod resumable;
mod roles;
mod server;
mod stored;
mod town;
mod uploads;
mod webhooks;
