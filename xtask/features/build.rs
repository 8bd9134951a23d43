//! Builds nothing. The file is required by the table `build-dependencies` of Cargo.toml.

fn main() {}
