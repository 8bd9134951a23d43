//! Nothing is built: this file exists for the table `build-dependencies` of Cargo.toml.

fn main() {}
