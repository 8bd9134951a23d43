//! Temporary folders, and helpers for running the program in them.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

use orogen::io::test_folder::TestFolder;

/// A world of 64 x 48 samples that takes almost no time.
pub const SMALL: &str = r#"
orogen = 1
about = "a test"
[world]
seed = 3
size = [640, 480]
cell = 10
[nodes.noise]
op = "fbm"
wavelength = 300
octaves = 4
[nodes.land]
op = "normalise"
source = "noise"
low = -50
high = 200
[outputs]
height = "land"
noise = "noise"
"#;

/// [`SMALL`] with noise that takes a hundred times as long per sample.
pub fn slow() -> String {
    let fractal = |k| format!("[nodes.n{k}]\nop = \"fbm\"\nseed = {k}\nwavelength = 300\noctaves = 24\n");
    let fractals: String = (0..16).map(fractal).collect();
    let sum = (0..16).map(|k| format!("n{k}")).collect::<Vec<_>>().join(" + ");
    let noise = format!("{fractals}[nodes.noise]\nop = \"expr\"\nexpr = \"{sum}\"\n");
    SMALL.replace("[nodes.noise]\nop = \"fbm\"\nwavelength = 300\noctaves = 4\n", &noise)
}

/// Whether the tests write the expected values instead of comparing with them: `OROGEN_BLESS=1`.
pub fn bless() -> bool {
    let value = std::env::var_os("OROGEN_BLESS");
    assert!(
        value.as_ref().is_none_or(|value| value == "1"),
        "only OROGEN_BLESS=1 rewrites the committed files: set it to that, or unset it to compare with them"
    );
    value.is_some()
}

/// A new, empty folder, removed when dropped.
pub struct Folder(pub TestFolder, Option<Arc<TestFolder>>);

/// The cache of all folders [`with_solutions`](Folder::with_solutions). It exists as long as one of them does.
static SOLUTIONS: Mutex<Weak<TestFolder>> = Mutex::new(Weak::new());

impl Folder {
    pub fn new() -> Folder {
        Folder(TestFolder::new("cli-test").unwrap(), None)
    }

    /// A folder whose commands find the solutions that commands of other such folders made, for tests of what is done
    /// with a terrain of slow nodes.
    pub fn with_solutions() -> Folder {
        let mut shared = SOLUTIONS.lock().unwrap();
        let cache = shared.upgrade().unwrap_or_else(|| Arc::new(TestFolder::new("cli-solutions").unwrap()));
        *shared = Arc::downgrade(&cache);
        Folder(Folder::new().0, Some(cache))
    }

    /// A folder with [`SMALL`] as `small.toml`.
    pub fn with_small() -> Folder {
        let folder = Folder::new();
        folder.write("small.toml", SMALL);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    /// Replaces a file atomically: readers see either the old content or the new one.
    pub fn replace(&self, name: &str, content: impl AsRef<[u8]>) {
        let other = format!("{name}.new");
        self.write(&other, content);
        fs::rename(self.path(&other), self.path(name)).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).unwrap()
    }

    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// The names of all files in a subfolder, including hidden files.
    pub fn names(&self, within: &str) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(self.path(within))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// The program as a command with this folder as working directory.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_orogen"));
        command.args(arguments).current_dir(&self.0).stdin(Stdio::null()).env_remove("NO_COLOR");
        // No test may use or leave solutions in the user's cache.
        command.env("OROGEN_CACHE", self.1.as_deref().map_or(Path::new(""), |cache| cache));
        command
    }

    /// Runs the command.
    pub fn run(&self, arguments: &[&str]) -> Outcome {
        Outcome::of(&self.command(arguments).output().unwrap())
    }

    /// Runs the command and checks that it succeeds.
    pub fn good(&self, arguments: &[&str]) -> Outcome {
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, 0, "{arguments:?}: {}", outcome.err);
        outcome
    }

    /// Runs the command and checks that it exits with `code`, prints nothing on standard output, and prints an error
    /// that contains `expect`.
    pub fn bad(&self, arguments: &[&str], code: i32, expect: &str) -> Outcome {
        let outcome = self.run(arguments);
        assert!(outcome.err.contains(expect), "{arguments:?}: {} / {expect}", outcome.err);
        assert!(outcome.err.starts_with("error: "), "{arguments:?}: {}", outcome.err);
        assert_eq!((outcome.code, outcome.out.len()), (code, 0), "{arguments:?}: {}", outcome.err);
        outcome
    }
}

/// Deadline for everything that a test waits for. It only ends a test that would hang, on the busiest machine.
pub const DEADLINE: Duration = Duration::from_secs(300);

/// Waits until a condition is true.
pub fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < DEADLINE, "{what}: not after {DEADLINE:?}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A running command whose lines on standard error are read. It is killed when dropped.
pub struct Running {
    pub child: Child,
    lines: Receiver<String>,
}

impl Running {
    pub fn start(folder: &Folder, arguments: &[&str]) -> Running {
        let mut child = folder.command(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let stderr = BufReader::new(child.stderr.take().unwrap());
        let (sender, lines) = channel();
        std::thread::spawn(move || stderr.lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
        Running { child, lines }
    }

    /// Starts a command with `--progress json`, and waits until it has done a part of its work.
    pub fn start_and_wait(folder: &Folder, arguments: &[&str]) -> Running {
        let running = Running::start(folder, &[arguments, &["--progress", "json"]].concat());
        running.wait_for("progress", |line| share(line).is_some_and(|share| share > 0.0));
        running
    }

    /// Waits for a line.
    pub fn wait_for(&self, what: &str, is_it: impl Fn(&str) -> bool) {
        let until = Instant::now() + DEADLINE;
        let mut said = Vec::new();
        while let Ok(line) = self.lines.recv_timeout(until.saturating_duration_since(Instant::now())) {
            assert!(!line.contains("panicked"), "{line}");
            if is_it(&line) {
                return;
            }
            said.push(line);
        }
        panic!("never said {what:?}, but {said:?}");
    }

    /// Waits for a line that contains `expect`.
    pub fn says(&self, expect: &str) {
        self.wait_for(expect, |line| line.contains(expect));
    }

    /// Sends a signal, such as `-INT`, which Ctrl-C sends.
    #[cfg(unix)]
    pub fn signal(&self, signal: &str) {
        let status = Command::new("kill").args([signal, &self.child.id().to_string()]).status().unwrap();
        assert!(status.success());
    }

    /// Waits until it ends. Returns its exit code, if it was not killed by a signal, and the remaining lines.
    pub fn ended(&mut self) -> (Option<i32>, Vec<String>) {
        let (until, mut lines) = (Instant::now() + DEADLINE, Vec::new());
        loop {
            match self.lines.recv_timeout(until.saturating_duration_since(Instant::now())) {
                Ok(line) => lines.push(line),
                Err(RecvTimeoutError::Disconnected) => return (self.child.wait().unwrap().code(), lines),
                Err(RecvTimeoutError::Timeout) => panic!("it has not ended after {DEADLINE:?}: {lines:?}"),
            }
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The share of the work in a line of `--progress json`.
pub fn share(line: &str) -> Option<f64> {
    let line = Some(line).filter(|line| line.starts_with('{'))?;
    serde_json::from_str::<serde_json::Value>(line).ok()?.get("share")?.as_f64()
}

/// The outcome of a run.
pub struct Outcome {
    pub code: i32,
    pub out: Vec<u8>,
    pub err: String,
}

impl Outcome {
    /// Checks that the program exited by itself and without a panic.
    pub fn of(output: &Output) -> Outcome {
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!err.contains("panicked"), "{err}");
        let code = output.status.code().unwrap_or_else(|| panic!("ended by a signal: {err}"));
        assert!((0..=2).contains(&code), "{code}: {err}");
        Outcome { code, out: output.stdout.clone(), err }
    }

    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.out).unwrap()
    }
}

/// Reads the samples of a .npy file.
pub fn npy(bytes: &[u8]) -> orogen::Grid {
    orogen::io::format::npy::read(&mut &bytes[..], "test.npy", 1.0).unwrap()
}

/// A decoded PNG.
pub struct Picture {
    pub width: usize,
    pub height: usize,
    pub bits: u8,
    pub channels: usize,
    pub data: Vec<u8>,
}

pub fn png(bytes: &[u8]) -> Picture {
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    Picture {
        width: info.width as usize,
        height: info.height as usize,
        bits: info.bit_depth as u8,
        channels: info.color_type.samples(),
        data,
    }
}

impl Picture {
    /// The levels of a 16-bit gray picture.
    pub fn grey16(&self) -> Vec<u16> {
        assert_eq!((self.bits, self.channels), (16, 1));
        self.data.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect()
    }
}

/// Returns whether `path` is a complete picture, array or JSON file, depending on its extension.
pub fn is_whole(path: &Path) -> bool {
    let bytes = fs::read(path).unwrap();
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("png") => bytes.ends_with(b"IEND\xae\x42\x60\x82"),
        Some("json") => serde_json::from_slice::<serde_json::Value>(&bytes).is_ok(),
        _ => !bytes.is_empty(),
    }
}

/// The arguments of a command line; those in double quotes may contain spaces.
pub fn words(line: &str) -> Vec<String> {
    let quoted = line.split('"').enumerate();
    let pieces = quoted.flat_map(|(n, text)| match n % 2 {
        0 => text.split_whitespace().map(str::to_owned).collect(),
        _ => vec![text.to_owned()],
    });
    pieces.collect()
}
