//! What must hold of any bytes. Run one target with `cargo fuzz run read_obj`.

use meshmend::budget::{Budget, StopFlag};
use meshmend::formats::{Format, ReadErrorKind, ReadOptions, read, sniff, write};

/// Reads `bytes` as a file of `format`: no panic, no more memory than the size allows, a sound soup, and the same
/// triangles again after writing it.
pub fn check_reader(bytes: &[u8], format: Format) {
    let Ok(encoding) = sniff(bytes, Some(format)) else { return };
    let budget = Budget::new(StopFlag::default(), u64::MAX, (1 << 20) + 64 * bytes.len() as u64);
    let soup = match read(bytes, encoding, &ReadOptions::default(), &budget) {
        Ok(soup) => soup,
        Err(error) => {
            // Instances of a mesh make more triangles than a file has bytes; the budget is what holds them.
            let has_instances = matches!(format, Format::Glb | Format::Gltf);
            assert!(has_instances || !matches!(error.kind, ReadErrorKind::Stopped(_)), "{error}");
            return;
        }
    };
    assert_eq!(soup.check(), Vec::<String>::new());
    let unlimited = Budget::unlimited();
    if let Ok(written) = write(&soup, encoding, &unlimited) {
        let back = match read(&written, encoding, &ReadOptions::default(), &unlimited) {
            Ok(back) => back,
            // A soup without triangles is nothing in STL.
            Err(error) if error.kind == ReadErrorKind::Empty => return,
            Err(error) => panic!("what was written cannot be read: {error}"),
        };
        assert_eq!(back.triangles.len(), soup.triangles.len());
        assert!(back.face_faults.is_empty());
    }
}
