//! One linked binary for this folder; each module is a group of tests.

#[path = "../support/mod.rs"]
#[allow(dead_code, reason = "each folder uses a part of it")]
mod support;

#[path = "../properties/oracle.rs"]
#[allow(dead_code, reason = "only the plain soup is used here")]
mod oracle;
#[path = "../properties/random.rs"]
#[allow(dead_code, reason = "solids are made by it")]
mod random;
#[path = "../properties/rational.rs"]
#[allow(dead_code, reason = "the second opinion calculates with it")]
mod rational;
#[path = "../properties/raw_files.rs"]
#[allow(dead_code, reason = "not every encoding is used")]
mod raw_files;
#[path = "../properties/solids.rs"]
#[allow(dead_code, reason = "not every solid is used")]
mod solids;

mod attributes;
mod bad_input;
mod boolean;
mod bridges;
mod cavities;
mod chordal_gaps;
mod cut_stitch;
mod enclosed;
mod fidelity;
mod fill_holes;
#[cfg(feature = "server")]
mod fixtures;
mod gltf;
mod hostile;
mod meshopt;
mod modeller;
mod near_rims;
mod objects;
mod one_mesh_of_parts;
mod operations;
mod pieces;
mod pinched_rims;
mod plan;
mod polygon_copies;
mod project_seams;
mod real_files;
mod rebuild;
mod repair;
mod simplify;
mod simplify_real_files;
mod small_holes;
mod standing_parts;
mod stray_faces;
mod threemf;
mod units;
mod winding_of_parts;
