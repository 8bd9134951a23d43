//! Running other programs, and paths of the project.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

use crate::failure::{Failure, Result, on_file};
use crate::output;

/// The root of the repository.
pub fn root() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here)
}

/// The target folder of this program, wherever the user has configured it.
pub fn target_dir() -> PathBuf {
    let exe = std::env::current_exe().ok();
    let dir = exe.as_deref().and_then(Path::parent).and_then(Path::parent).map(Path::to_path_buf);
    dir.unwrap_or_else(|| root().join("target"))
}

/// A program that runs at the root of the repository.
pub fn program(name: impl AsRef<std::ffi::OsStr>) -> Command {
    let mut command = Command::new(name);
    // No task may read solutions that an earlier build of the program has cached.
    command.current_dir(root()).env("OROGEN_CACHE", "");
    command
}

/// The cargo that runs us, with arguments split at blanks.
pub fn cargo(args: &str) -> Command {
    let mut command = program(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(args.split_whitespace());
    // The Python package has one binary for all versions of Python with a lock, and needs none to compile. Whoever
    // builds the free-threaded one chooses its Python, so this does not stand in the settings of cargo.
    command.env("PYO3_NO_PYTHON", "1");
    command
}

/// The default target of the compiler.
pub fn host() -> Result<String> {
    let version = capture(program("rustc").arg("-vV"))?;
    let host = version.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| Failure::new("`rustc -vV` names no host"))
}

/// Runs a program with the step's output and without input.
pub fn run(command: &mut Command) -> Result {
    let status = status(command)?;
    if status.success() { Ok(()) } else { Err(Failure::new(format!("`{}` ended with {status}", shown(command)))) }
}

/// [`run`] whose output is shown only if the program fails.
pub fn run_silently(command: &mut Command) -> Result {
    let made = command.stdin(Stdio::null()).output().map_err(|e| cannot_start(command, &e))?;
    if made.status.success() {
        return Ok(());
    }
    output::line(format_args!("{}", String::from_utf8_lossy(&made.stderr).trim_end()));
    Err(Failure::new(format!("`{}` ended with {}", shown(command), made.status)))
}

/// [`run`] that returns the exit status.
pub fn status(command: &mut Command) -> Result<ExitStatus> {
    output::connect(command).stdin(Stdio::null()).status().map_err(|e| cannot_start(command, &e))
}

/// Runs a program and returns its output; its errors go to the step's output.
pub fn capture(command: &mut Command) -> Result<String> {
    let output =
        output::connect_errors(command).stdin(Stdio::null()).output().map_err(|e| cannot_start(command, &e))?;
    if !output.status.success() {
        return Err(Failure::new(format!("`{}` ended with {}", shown(command), output.status)));
    }
    String::from_utf8(output.stdout).map_err(|_| Failure::new(format!("`{}` printed no UTF-8", shown(command))))
}

/// Runs a program without output; returns whether it succeeds.
pub fn succeeds(command: &mut Command) -> bool {
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok_and(|s| s.success())
}

/// The command line, for messages.
pub fn shown(command: &Command) -> String {
    let name = Path::new(command.get_program());
    let name = name.file_name().unwrap_or(name.as_os_str()).to_string_lossy().into_owned();
    std::iter::once(name)
        .chain(command.get_args().map(|a| {
            let a = a.to_string_lossy();
            if a.contains(' ') { format!("'{a}'") } else { a.into_owned() }
        }))
        .collect::<Vec<_>>()
        .join(" ")
}

/// Reads a text file.
pub fn read(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).map_err(|e| on_file("read", path, &e))
}

/// Writes a text file.
pub fn write(path: &Path, text: &str) -> Result {
    std::fs::write(path, text).map_err(|e| on_file("write", path, &e))
}

/// Creates an empty folder at this path, removing an existing one.
pub fn empty_dir(path: &Path) -> Result {
    if path.exists() {
        std::fs::remove_dir_all(path).map_err(|e| on_file("clear", path, &e))?;
    }
    std::fs::create_dir_all(path).map_err(|e| on_file("create", path, &e))
}

/// A path relative to the root of the repository, for messages.
pub fn relative(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

fn cannot_start(command: &Command, error: &std::io::Error) -> Failure {
    Failure::new(format!("cannot start `{}`: {error}", shown(command)))
}
