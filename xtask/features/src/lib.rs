//! No code: Cargo.toml selects features of dependencies.
#![forbid(unsafe_code)]
