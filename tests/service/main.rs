//! One linked binary for this folder; each module is a group of tests that drive the built binary.

#[path = "../support/mod.rs"]
#[allow(dead_code, reason = "each folder uses a part of it")]
mod support;

mod about;
mod access;
mod cli;
mod connections;
mod contract;
mod isolation;
mod killed;
mod lifecycle;
mod listing;
mod meshes;
mod operations;
mod printing;
mod problems;
mod restarts;
mod server;
mod uploads;
