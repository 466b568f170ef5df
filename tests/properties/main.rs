//! One linked binary for this folder; each module is a group of tests.

#[path = "../support/mod.rs"]
#[allow(dead_code, reason = "each folder uses a part of it")]
mod support;

#[path = "../../benches/support/dented_sphere.rs"]
mod dented_sphere;

mod analysis;
mod certificate_exponents;
mod certificate_mutations;
mod certificate_nesting;
mod certificate_prisms;
mod certificate_readings;
mod certificate_soups;
mod closed_meshes;
mod contacts;
mod cut_and_stitch;
mod distance;
mod fill;
mod half_edge;
mod holes;
mod hubs;
mod injected_defects;
mod meeting_features;
mod modeller;
mod naive;
mod near;
mod obj_readers;
mod oracle;
mod patch_judge;
mod polygon_cut_and_stitch;
mod polygon_meshes;
mod predicates;
mod printing;
mod random;
mod random_holes;
mod rational;
mod raw_files;
mod rbf;
mod render;
mod repair_pipeline;
mod repair_steps;
mod round_trip;
mod simplify;
mod simplify_guarded;
mod simplify_seams;
mod solids;
mod step_lists;
mod touching_bodies;
mod wrap;
