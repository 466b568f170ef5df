//! The comparison of instruction counts says which pass became dearer, and the committed table is one that it reads.

#[path = "../../benches/instructions/table.rs"]
mod table;

use std::collections::BTreeMap;
use table::{Row, Table, Word};

const COMMITTED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.json");

fn row(instructions: u64) -> Row {
    Row { instructions, tolerance_percent: 5.0, reason: None }
}

#[test]
fn six_percent_more_are_a_fault_and_four_are_none() {
    let words = [1_060, 1_040, 960, 940].map(|now| row(1_000).judge(now));
    assert_eq!(words, [Word::Dearer, Word::Same, Word::Same, Word::Cheaper]);
}

#[test]
fn a_blessed_table_has_the_new_counts_the_old_tolerances_and_no_other_passes() {
    let wide = Row { tolerance_percent: 8.0, reason: Some("why".to_owned()), ..row(20) };
    let rows = [("gone", row(5)), ("kept", row(10)), ("wide", wide.clone())];
    let table = Table(rows.map(|(name, row)| (name.to_owned(), row)).to_vec());
    let counts = BTreeMap::from([("wide".to_owned(), 21), ("new".to_owned(), 30)]);
    let blessed = table.blessed(&["wide", "kept", "new"], &counts);
    let expected = [("wide", Row { instructions: 21, ..wide }), ("kept", row(10)), ("new", row(30))];
    assert_eq!(blessed, Table(expected.map(|(name, row)| (name.to_owned(), row)).to_vec()));
    assert_eq!(table.names_beside(&["wide", "kept"]), ["gone"]);
}

#[test]
fn the_committed_table_is_as_it_would_be_written_and_gives_a_reason_for_each_wider_tolerance() {
    let table = Table::read(COMMITTED);
    assert!(table.row("weld").is_some(), "the table was not found");
    let written = concat!(env!("CARGO_TARGET_TMPDIR"), "/instructions.json");
    table.write(written);
    let [written, committed] = [written, COMMITTED].map(|path| std::fs::read_to_string(path).expect(path));
    assert_eq!(written, committed);
    let is_bare = |row: &Row| row.tolerance_percent > 5.0 && row.reason.is_none();
    assert!(!table.0.iter().any(|(_, row)| is_bare(row)), "a wider tolerance has no reason");
}
