//! The studio of Orogen.
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    orogen_studio::window::run::run()
}
