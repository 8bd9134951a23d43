//! Output to a file, or with `-` to standard output.

use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::Path;

use orogen::io::file::{self, Output, OutputPolicy};
use orogen::output::map::canvas::Canvas;

use crate::failure::Failure;
use crate::interrupt::Stoppable;
use crate::{interrupt, say};

/// The output for a single file.
#[derive(Debug, Clone)]
pub enum Sink {
    /// A file, written atomically.
    File(Output),
    /// Standard output.
    Stdout,
}

/// The name of standard output, and of standard input where a recipe is read.
pub const DASH: &str = "-";

/// Whether a path is a name of standard output. Names have no extension: see [`kind`].
pub fn is_stdout(path: &Path) -> bool {
    const NAMES: [&str; 4] = [DASH, "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];
    NAMES.iter().any(|name| path == Path::new(name))
}

#[cfg(unix)]
mod stdout {
    use rustix::fs::{FileType, OFlags, Stat, fcntl_getfl, fstat, stat};
    use std::io;
    use std::path::Path;

    /// Whether a path leads to the pipe or device of standard output, such as a link to `/dev/stdout`.
    pub fn is_behind(path: &Path) -> bool {
        let is_stream = |there: &Stat| {
            let kind = FileType::from_raw_mode(there.st_mode);
            !matches!(kind, FileType::RegularFile | FileType::Directory)
        };
        match (stat(path), fstat(io::stdout())) {
            (Ok(there), Ok(ours)) => is_stream(&there) && (there.st_dev, there.st_ino) == (ours.st_dev, ours.st_ino),
            _ => false,
        }
    }

    /// Whether the process was started without standard output. Rust's runtime then opens the null device for reading
    /// and writing, whereas shells open it for writing only.
    pub fn is_closed() -> bool {
        let is_null = |ours: Stat| stat("/dev/null").is_ok_and(|null| null.st_rdev == ours.st_rdev);
        let is_opened_for_both = |flags: OFlags| flags & OFlags::RWMODE == OFlags::RDWR;
        fstat(io::stdout()).is_ok_and(is_null) && fcntl_getfl(io::stdout()).is_ok_and(is_opened_for_both)
    }
}

#[cfg(not(unix))]
mod stdout {
    pub fn is_behind(_: &std::path::Path) -> bool {
        false
    }

    pub fn is_closed() -> bool {
        false
    }
}

impl Sink {
    /// The output for `out`.
    ///
    /// # Errors
    /// If it is a file that may not be replaced, or a terminal, which cannot show binary data, or if standard output is
    /// closed.
    pub fn new(out: &Path, policy: &OutputPolicy) -> Result<Sink, Failure> {
        match is_stdout(out) || stdout::is_behind(out) {
            false => Ok(Sink::File(policy.output(out)?)),
            true if io::stdout().is_terminal() => Err(Failure::Usage(
                "standard output is a terminal, which cannot show binary data; name a file with -o, or redirect the output"
                    .into(),
            )),
            true if stdout::is_closed() => Err(Failure::stdout(&io::Error::other(
                "it is closed, so the data would be lost; redirect it, or name a file with -o",
            ))),
            true => Ok(Sink::Stdout),
        }
    }

    /// Writes the output with `body`; fails after an interruption.
    pub fn write<T>(&self, body: impl FnOnce(&mut dyn Write) -> io::Result<T>) -> Result<T, Failure> {
        match self {
            Sink::File(output) => {
                let mut made = None;
                file::write_whole(output, |out| body(&mut Stoppable(out)).map(|value| made = Some(value)))
                    .map_err(|error| interrupt::explain(error.into(), "nothing was written"))?;
                made.ok_or_else(|| Failure::Usage("nothing was written".into()))
            }
            Sink::Stdout => {
                let mut out = BufWriter::new(Piped { out: io::stdout().lock(), broken: false });
                let written = body(&mut Stoppable(&mut out)).and_then(|value| out.flush().map(|()| value));
                // Buffered data must not be written again after a failure.
                let (piped, _) = out.into_parts();
                written.map_err(|cause| match (interrupt::asked(), piped.broken) {
                    (true, _) => interrupt::stopped("interrupted: the output is incomplete"),
                    (false, true) => Failure::BrokenPipe,
                    (false, false) => Failure::stdout(&cause),
                })
            }
        }
    }

    /// Writes a picture, with the program's name in it.
    pub fn picture(&self, picture: &Canvas) -> Result<(), Failure> {
        self.write(|out| picture.write_png(out, &[("Software", say::SOFTWARE)]))
    }

    /// Prints a message about the output on standard output, unless `quiet` is set or standard output contains the
    /// file.
    pub fn tell(&self, quiet: bool, words: &str) -> Result<(), Failure> {
        match self {
            Sink::File(_) if !quiet => say::out(words),
            _ => Ok(()),
        }
    }
}

/// Standard output, and whether its pipe was closed; errors of encoders do not always show this.
struct Piped {
    out: io::StdoutLock<'static>,
    broken: bool,
}

impl Write for Piped {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes).inspect_err(|cause| self.broken |= cause.kind() == io::ErrorKind::BrokenPipe)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush().inspect_err(|cause| self.broken |= cause.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// Checks that the output is a PNG file or standard output; `what` names it in the message.
pub fn check_png(out: &Path, what: &str) -> Result<(), Failure> {
    match is_stdout(out) || out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        true => Ok(()),
        false => {
            let message = format!("{what} is written as PNG; use the extension .png instead of {}", out.display());
            Err(Failure::Usage(message))
        }
    }
}

/// The kind of file: from `--format`, otherwise from the extension of `out`, otherwise (on standard output) the first
/// of `kinds`, which are pairs of a kind and its extension.
///
/// # Errors
/// If neither matches one of `kinds`, or they contradict each other; `what` names the output in messages, such as "a
/// map is a".
pub fn kind<K: Copy + PartialEq>(out: &Path, asked: Option<K>, kinds: &[(K, &str)], what: &str) -> Result<K, Failure> {
    if is_stdout(out) {
        let first = kinds.first().map(|(kind, _)| *kind);
        return asked.or(first).ok_or_else(|| Failure::Usage("standard output needs --format".into()));
    }
    let extension = out.extension().unwrap_or_default();
    let told = kinds.iter().find(|(_, name)| extension.eq_ignore_ascii_case(name)).map(|(kind, _)| *kind);
    match (asked, told) {
        (Some(asked), Some(told)) if asked != told => {
            Err(Failure::Usage(format!("--format does not match the extension of {}", out.display())))
        }
        (Some(kind), _) | (None, Some(kind)) => Ok(kind),
        (None, None) => {
            let names: Vec<&str> = kinds.iter().map(|(_, name)| *name).collect();
            let names = names.join(", .");
            let names = names.rsplit_once(", ").map_or(names.clone(), |(init, last)| format!("{init} or {last}"));
            Err(Failure::Usage(format!("{}: {what} .{names}; name a file that ends so", out.display())))
        }
    }
}
