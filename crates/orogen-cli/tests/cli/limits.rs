//! Requirements for every command, tested command by command. The table in docs/development.md lists them; the test
//! compares it with the results, and `OROGEN_BLESS=1` updates it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::commands::{WRITERS, Writer, prepare, workplace};
use crate::harness::{Folder, Running, SMALL, bless, slow};

/// One requirement, in the order of the table's columns.
struct Promise {
    name: &'static str,
    /// Tests one variant of a command. False if the requirement does not apply.
    check: fn(&Writer) -> bool,
}

const PROMISES: [Promise; 6] = [
    Promise { name: "memory", check: memory },
    Promise { name: "cancel", check: cancel },
    Promise { name: "full disk", check: full_disk },
    Promise { name: "existing output", check: existing },
    Promise { name: "stdin", check: stdin },
    Promise { name: "bad input", check: bad_input },
];

/// The file with the table, and the lines around it.
const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/development.md");
const BEGIN: &str = "<!-- commands and limits: begin -->\n";
const END: &str = "<!-- commands and limits: end -->\n";

#[test]
fn every_command_keeps_every_promise() {
    let mut kept: BTreeMap<&str, [bool; PROMISES.len()]> = BTreeMap::new();
    let mut broken = Vec::new();
    for writer in WRITERS {
        let row = kept.entry(writer.arguments[0]).or_default();
        for (cell, promise) in row.iter_mut().zip(&PROMISES) {
            match std::panic::catch_unwind(|| (promise.check)(writer)) {
                Ok(applies) => *cell |= applies,
                // All failures are reported at once.
                Err(_) => broken.push(format!("{}: {}", writer.arguments.join(" "), promise.name)),
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
    let names: Vec<&str> = PROMISES.iter().map(|promise| promise.name).collect();
    let mut table = format!("| command | {} |\n|---{}|\n", names.join(" | "), "|---".repeat(names.len()));
    for (command, row) in kept {
        let cells = row.map(|kept| if kept { "yes" } else { "-" });
        table.push_str(&format!("| `{command}` | {} |\n", cells.join(" | ")));
    }
    let text = std::fs::read_to_string(TABLE).unwrap();
    let (before, rest) = text.split_once(BEGIN).expect("docs/development.md has the table's first line");
    let (written, after) = rest.split_once(END).expect("docs/development.md has the table's last line");
    if bless() {
        std::fs::write(TABLE, format!("{before}{BEGIN}{table}{END}{after}")).unwrap();
    } else {
        assert_eq!(written, table, "OROGEN_BLESS=1 cargo test -p orogen-cli --test cli limits writes the table");
    }
}

/// A folder in which a command can run.
fn ready(writer: &Writer) -> Folder {
    let folder = workplace();
    prepare(&folder, writer);
    folder
}

/// The arguments with replacements.
fn with(writer: &Writer, change: impl Fn(&'static str) -> &'static str) -> Vec<&'static str> {
    writer.arguments.iter().map(|argument| change(argument)).collect()
}

/// The recipe that a command reads.
fn recipe(writer: &Writer) -> Option<&'static str> {
    // Outputs come last.
    let inputs = &writer.arguments[..writer.arguments.len() - 1];
    inputs.iter().copied().find(|argument| argument.ends_with(".toml"))
}

/// The files below a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { files.extend(self::files(&path)) } else { files.push(path) }
    }
    files.sort();
    files
}

/// A command with a limit of 64 KiB rejects the request with a message that names the limit, and writes nothing.
/// memory.rs measures larger limits.
fn memory(writer: &Writer) -> bool {
    let folder = ready(writer);
    let help = folder.good(&[writer.arguments[0], "--help"]).text().to_string();
    // A graph only reads the recipe: only the files of heights that it names take memory.
    if !help.contains("--memory") || writer.arguments[0] == "graph" {
        return false;
    }
    let before = files(&folder.0);
    let refused = folder.run(&[writer.arguments, &["--memory", "64KiB"]].concat());
    assert!(refused.code != 0 && refused.err.contains("memory"), "{:?}: {}", writer.arguments, refused.err);
    assert_eq!(files(&folder.0), before, "{:?}", writer.arguments);
    true
}

/// A world that takes a long time.
const LONG: &str = "size = [60000, 40000]";

/// A command that is interrupted while it works exits with code 130 before the work is done, and leaves no files.
fn cancel(writer: &Writer) -> bool {
    interrupted(writer).is_some()
}

#[test]
#[ignore = "long: every command is interrupted, and the time until it ends"]
fn every_command_ends_within_seconds_of_an_interruption() {
    for writer in WRITERS {
        let late = interrupted(writer).unwrap_or_default();
        println!("{late:7.1?} {}", writer.arguments.join(" "));
        assert!(late < Duration::from_secs(10), "{:?}: {late:?}", writer.arguments);
    }
}

/// Interrupts a command that has done a part of its work. Returns the time until it ended; `None` for commands that are
/// not tested.
fn interrupted(writer: &Writer) -> Option<Duration> {
    let mut arguments = with(writer, |argument| match argument {
        "12" if writer.arguments[0] == "fit" => "10000",
        "15" if writer.arguments[0] == "refine" => "0.25",
        "32" if writer.arguments[0] == "noise" => "1024",
        "64x36" => "4000x3000",
        "32x24" if writer.arguments[0] == "blocks" => "1998x1332",
        "32x24" => "6000x4000",
        "30" if writer.arguments[0] == "map" => "300",
        "64" if writer.arguments[0] == "variants" => "2000",
        "2" if writer.arguments[0] == "variants" => "60",
        argument => argument,
    });
    match writer.arguments[0] {
        // Pages of fixed size take almost no time; a build keeps its progress, which build.rs tests.
        "compare" | "palettes" | "graph" | "build" => return None,
        // A recipe is written without work.
        "refine" if arguments.contains(&"fine.toml") => return None,
        // One variant of export represents all.
        "export" if !arguments.contains(&"a.tif") => return None,
        // A picture of so many blocks is too large.
        "blocks" if arguments.contains(&"b.png") => return None,
        "noise" if !arguments.contains(&"block.npy") => return None,
        "noise" => arguments.iter_mut().filter(|argument| **argument == "3").for_each(|argument| *argument = "1000"),
        _ => {}
    }
    // On a busy machine a command may have ended before the signal comes.
    (0..10).find_map(|_| interrupted_in_time(writer, &arguments)).or_else(|| panic!("{arguments:?} always ends first"))
}

/// `None` if the command had done all its work.
fn interrupted_in_time(writer: &Writer, arguments: &[&str]) -> Option<Duration> {
    let folder = ready(writer);
    // Pictures of `generate` are written to their end: only the work before can be interrupted.
    let small = if arguments[0] == "generate" { slow() } else { SMALL.to_string() };
    folder.write("small.toml", small.replace("size = [640, 480]", LONG));
    let rivers = folder.text("rivers.toml");
    folder.write("rivers.toml", rivers.replace("size = [600, 400]", LONG));
    let before = files(&folder.0);
    let mut running = Running::start_and_wait(&folder, arguments);
    running.signal("-INT");
    let asked = Instant::now();
    let (code, said) = running.ended();
    let late = asked.elapsed();
    if code == Some(0) {
        return None;
    }
    assert_eq!(code, Some(130), "{arguments:?}: {said:?}");
    assert_eq!(files(&folder.0), before, "{arguments:?}");
    Some(late)
}

/// A full disk is reported, and no other file of the same run remains.
fn full_disk(writer: &Writer) -> bool {
    // A build checks the free space before it starts; build.rs tests full disks.
    if !Path::new("/dev/full").exists() || writer.arguments[0] == "build" {
        return false;
    }
    let folder = ready(writer);
    let first = folder.path(writer.files[0]);
    std::fs::create_dir_all(first.parent().unwrap()).unwrap();
    std::os::unix::fs::symlink("/dev/full", &first).unwrap();
    let before = files(&folder.0);
    let ended = folder.run(writer.arguments);
    assert!(ended.code == 1 && ended.err.contains("cannot write"), "{:?}: {}", writer.arguments, ended.err);
    assert_eq!(files(&folder.0), before, "{:?}", writer.arguments);
    true
}

/// A user's file at the output path is kept. outputs.rs tests all cases.
fn existing(writer: &Writer) -> bool {
    let folder = ready(writer);
    let file = writer.files[0];
    std::fs::create_dir_all(folder.path(file).parent().unwrap()).unwrap();
    folder.write(file, "by hand");
    let kept: Vec<&str> = writer.arguments.iter().copied().filter(|argument| *argument != "--force").collect();
    let refused = folder.run(&kept);
    assert!(refused.code == 1 && refused.err.contains(file), "{:?}: {}", writer.arguments, refused.err);
    assert_eq!(folder.text(file), "by hand", "{:?}", writer.arguments);
    true
}

/// A recipe on standard input yields the same files.
fn stdin(writer: &Writer) -> bool {
    let Some(name) = recipe(writer) else { return false };
    let folder = ready(writer);
    folder.good(writer.arguments);
    let first: Vec<Vec<u8>> = writer.files.iter().map(|file| folder.read(file)).collect();
    let other = ready(writer);
    let mut command = other.command(&with(writer, |argument| if argument == name { "-" } else { argument }));
    let input = std::fs::File::open(other.path(name)).unwrap();
    let ended = command.stdin(input).output().unwrap();
    let said = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success(), "{:?}: {said}", writer.arguments);
    for (file, first) in writer.files.iter().zip(&first) {
        // Summaries contain the elapsed time, sheets and reports the name of the recipe.
        let named = file.ends_with(".json") || matches!(writer.arguments[0], "map" | "analyze" | "variants");
        assert!(named || other.read(file) == *first, "{:?}: {file}", writer.arguments);
    }
    true
}

/// Invalid recipes are rejected with a message, and no file is written.
fn bad_input(writer: &Writer) -> bool {
    let Some(name) = writer.arguments[1..]
        .iter()
        .copied()
        .find(|argument| argument.ends_with(".toml") && Some(*argument) == recipe(writer) || *argument == "place.tif")
    else {
        return false;
    };
    let folder = ready(writer);
    for garbage in
        [&b"\xff\xfe\x00garbage"[..], b"", b"orogen = 1\n[nodes.a]\nop = \"fmb\"\n[outputs]\nheight = \"a\"\n"]
    {
        folder.write(name, garbage);
        let before = files(&folder.0);
        let refused = folder.run(writer.arguments);
        assert!(refused.code != 0 && refused.err.starts_with("error: "), "{:?}: {}", writer.arguments, refused.err);
        assert!(refused.err.contains(name), "{:?}: {}", writer.arguments, refused.err);
        assert_eq!(files(&folder.0), before, "{:?}", writer.arguments);
    }
    true
}

/// Values at and beyond the ends of the ranges of options.
const HOSTILE: [(&str, &[&str]); 8] = [
    (
        "--window",
        &[
            "0,0,1000000000,1000000000",
            "4503599627370496,0,9,9",
            "-4503599627370496,-4503599627370496,9,9",
            "0m,0m,1000000000km,1000000000km",
            "1000000000km,0m,1km,1km",
        ],
    ),
    ("--bounds", &["0,-1e300,1e300,0", "-1e12,-1e12,1e12,1e12", "1e15,1e15,2e15,2e15"]),
    ("--size", &["0", "1000000000", "1000000000x1000000000", "18446744073709551616"]),
    ("--observer", &["1e300,0", "nan,0"]),
    ("--range", &["1,1", "nan,1"]),
    ("--camera", &["nan,0", "0,0,-1"]),
    ("--cell", &["1e300", "1e-300", "1e12", "1e-6", "0", "nan"]),
    // All others.
    ("", &["nan", "-1e300", "18446744073709551616"]),
];

/// Options whose values are no numbers, or that say where and how the work is done.
const NO_NUMBERS: [&str; 5] = ["--out", "--memory", "--cache", "--title", "--set"];

/// The options with a value that a command lists.
fn options(folder: &Folder, command: &str) -> Vec<String> {
    let help = folder.good(&[command, "--help"]).text().to_string();
    let named = |line: &str| {
        let (_, rest) = line.split_once("--").filter(|(before, _)| before.trim().len() <= 3)?;
        rest.split_once(" <").map(|(name, _)| format!("--{name}"))
    };
    help.lines().filter_map(named).filter(|name| !NO_NUMBERS.contains(&name.as_str())).collect()
}

/// Commands with an unbounded world, or without one: what a window of a bounded one may be is known.
const UNBOUNDED: [&[&str]; 10] = [
    &["export", "endless", "-o", "e.tif"],
    &["map", "endless", "-o", "m.png"],
    &["render", "endless", "-o", "r.png"],
    &["generate", "endless", "-o", "made"],
    &["blocks", "endless", "-o", "b.glb"],
    &["blocks", "endless", "-o", "b.png"],
    &["tilemap", "endless", "-o", "tiles"],
    &["analyze", "endless", "-o", "a.png"],
    &["build", "endless", "-o", "b.tif"],
    &["explain", "endless"],
];

#[test]
fn no_value_of_an_option_ends_a_command_without_a_sentence() {
    let folder = workplace();
    for arguments in UNBOUNDED {
        for option in ["--cell", "--window", "--bounds", "--size"] {
            let values = HOSTILE.iter().find(|(name, _)| *name == option).map_or(&[][..], |(_, values)| *values);
            if !options(&folder, arguments[0]).iter().any(|name| name == option) {
                continue;
            }
            for value in values {
                // Few samples, so that what is allowed is done at once.
                let few: &[&str] = if option == "--cell" { &["--window", "0,0,9,9"] } else { &[] };
                answered(&folder, arguments, few, option, value);
            }
        }
    }
}

#[test]
#[ignore = "long: every option of every command at the ends of its range and beyond"]
fn no_value_of_any_option_ends_a_command_without_a_sentence() {
    let folder = workplace();
    WRITERS.iter().for_each(|writer| prepare(&folder, writer));
    let writers = WRITERS.iter().map(|writer| writer.arguments);
    for arguments in UNBOUNDED.into_iter().chain(writers) {
        for option in options(&folder, arguments[0]) {
            let known = HOSTILE.iter().find(|(name, _)| *name == option || name.is_empty());
            for value in known.map_or(&[][..], |(_, values)| *values) {
                let few: &[&str] =
                    if option == "--cell" && arguments.contains(&"endless") { &["--window", "0,0,9,9"] } else { &[] };
                answered(&folder, arguments, few, &option, value);
            }
        }
    }
}

/// Runs a command with a value of an option: it does its work, or says in a sentence why not.
fn answered(folder: &Folder, arguments: &[&str], more: &[&str], option: &str, value: &str) {
    let option = format!("{option}={value}");
    let all = [arguments, more, &[&option], &["--memory", "64MiB"]].concat();
    let takes_memory = !matches!(arguments[0], "palettes" | "graph");
    // What a run before has written.
    if let Some(at) = arguments.iter().position(|argument| *argument == "-o") {
        let out = folder.path(arguments[at + 1]);
        let _ = if out.is_dir() { std::fs::remove_dir_all(out) } else { std::fs::remove_file(out) };
    }
    let mut running = Running::start(folder, if takes_memory { &all } else { &all[..all.len() - 2] });
    let (code, said) = running.ended();
    // 2 and 1 come with a sentence, anything else is an abort or a panic.
    let is_told = said.iter().any(|line| line.starts_with("error: "));
    assert!(code == Some(0) || matches!(code, Some(1 | 2)) && is_told, "{all:?}: {code:?} {said:?}");
}
