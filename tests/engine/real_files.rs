//! Real meshes from many programs are read.

use crate::support::corpus_files;
use meshmend::budget::Budget;
use meshmend::formats::{Format, ReadOptions, read, sniff};

/// Ends of the names of files that were made to be refused, with what is wrong with them.
const REFUSED: [(&str, &str); 2] = [
    ("_DuplicatedColorGroupId.3mf", "a second resource with the id 3"),
    ("_RequiredExtensions_Unsupported.3mf", "which is not known here"),
];

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
        let fault =
            REFUSED.iter().find(|(end, _)| path.to_string_lossy().ends_with(end)).map(|(_, fault)| fault);
        match result {
            Err(error) if fault.is_some_and(|fault| error.to_string().contains(fault)) => {}
            Ok(_) if fault.is_some() => problems.push(format!("{name}: is read")),
            Ok(soup) => problems.extend(soup.check().into_iter().map(|broken| format!("{name}: {broken}"))),
            Err(error) => problems.push(format!("{name}: {error}")),
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
