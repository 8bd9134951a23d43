//! Documents that are made from declarations.

use crate::harness::Folder;
use std::path::Path;

#[test]
fn the_schema_and_the_reference_are_what_the_program_prints() {
    let folder = Folder::new();
    for (arguments, document) in
        [(&["schema"][..], "crates/orogen-engine/recipes/orogen.schema.json"), (&["ops", "--markdown"], "docs/ops.md")]
    {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(document);
        let is_current = std::fs::read_to_string(path).unwrap() == folder.good(arguments).text();
        assert!(is_current, "{document} is not current: run `cargo xtask codegen`");
    }
}
