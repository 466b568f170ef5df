//! `openapi.yaml` in the repository is the contract that the routes and types make.

use std::path::Path;

#[test]
fn the_committed_contract_is_the_one_that_the_code_makes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("openapi.yaml");
    let made = meshmend::http::openapi_yaml();
    if std::env::var_os("MESHMEND_BLESS").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap();
    assert!(
        committed == made,
        "openapi.yaml is not what the code makes: run this test with MESHMEND_BLESS=1"
    );
}
