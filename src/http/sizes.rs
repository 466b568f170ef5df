//! Sizes that the server sets and the operator does not.

/// Largest request head, in bytes.
pub(super) const HEAD_BYTES_MAX: u64 = 32 << 10;
/// Largest body that is JSON, in bytes.
pub(super) const JSON_BYTES_MAX: u64 = 1 << 20;
/// Largest `material` part, in bytes.
pub(super) const MATERIAL_BYTES_MAX: u64 = 4 << 20;
/// What a form may have beside the mesh: the other parts, and the lines between them.
pub(super) const FORM_EXTRA_BYTES_MAX: u64 = MATERIAL_BYTES_MAX + JSON_BYTES_MAX + (64 << 10);
/// Most jobs on a page of a list.
pub(super) const PAGE_MAX: usize = 200;
