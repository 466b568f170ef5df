//! `tests/meshopt_files` is a good first corpus: `cargo fuzz run read_gltf fuzz/corpus/read_gltf tests/meshopt_files`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use meshmend::formats::Format;

fuzz_target!(|bytes: &[u8]| {
    meshmend_fuzz::check_reader(bytes, Format::Glb);
    meshmend_fuzz::check_reader(bytes, Format::Gltf);
});
