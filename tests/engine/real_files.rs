//! Real meshes from many programs are read.

use crate::support::corpus_files;
use meshmend::budget::Budget;
use meshmend::formats::{Format, ReadOptions, read, sniff};

#[test]
fn every_real_file_is_read_by_its_content_alone() {
    let Some(files) = corpus_files(&Format::ALL.map(Format::name)) else { return };
    let mut problems = Vec::new();
    for path in files {
        let name = path.display();
        let bytes = std::fs::read(&path).unwrap();
        let result = sniff(&bytes, None).and_then(|encoding| {
            let extension = path.extension().unwrap().to_str().unwrap();
            assert_eq!(Some(encoding.format()), Format::from_name(extension), "{name}");
            read(&bytes, encoding, &ReadOptions::default(), &Budget::unlimited())
        });
        match result {
            Ok(soup) => problems.extend(soup.check().into_iter().map(|broken| format!("{name}: {broken}"))),
            Err(error) => problems.push(format!("{name}: {error}")),
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
