//! The polyhedral modeller against brute force.

mod edits;
mod laws;
mod oracle;
mod parts;
mod zoo;
