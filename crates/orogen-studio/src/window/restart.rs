//! Restarting the program, because a window cannot get another graphics device.

use std::path::Path;
use std::process::Command;

/// Replaces this program by a new instance. Returns only if that fails, with the reason.
#[must_use]
pub fn again(recipe: Option<&Path>) -> String {
    let lost = "the graphics device was lost. Changes that were not saved are kept, and offered at the next start";
    match std::env::current_exe() {
        Ok(program) => {
            let mut command = Command::new(program);
            command.arg("--after-loss").args(recipe);
            format!("{lost}; the studio could not start again: {}", in_place(command))
        }
        Err(cause) => format!("{lost}; the studio could not start again: {cause}"),
    }
}

/// Replaces this process by another one.
#[cfg(unix)]
fn in_place(mut command: Command) -> std::io::Error {
    std::os::unix::process::CommandExt::exec(&mut command)
}

/// Starts another process, and ends this one.
#[cfg(not(unix))]
fn in_place(mut command: Command) -> std::io::Error {
    match command.spawn() {
        Ok(_) => std::process::exit(0),
        Err(cause) => cause,
    }
}
