//! Requirements for every command, tested command by command. The table in docs/development.md lists them; the test
//! compares it with the results, and `OROGEN_BLESS=1` updates it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use orogen::export::derived::layer::Nature;
use orogen::export::derived::list as derived;
use orogen::export::registry;
use orogen::jobs::{BlocksJob, MapJob, RenderJob};
use orogen::options::{Condition, OptionSpec, ValueKind};
use orogen::tilemap::TilemapJob;

use crate::commands::{WRITERS, Writer, prepare, workplace};
use crate::harness::{Folder, Running, SMALL, bless, slow};
use crate::memory::{MOST, Watched, watched};

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
    // A graph only reads the recipe; only the files of heights that the recipe names take memory.
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

/// Interrupts a command that has done part of its work. Returns the time until it ended; `None` for commands that are
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
    // On a busy machine a command may end before the signal arrives.
    (0..10).find_map(|_| interrupted_in_time(writer, &arguments)).or_else(|| panic!("{arguments:?} always ends first"))
}

/// `None` if the command had done all its work.
fn interrupted_in_time(writer: &Writer, arguments: &[&str]) -> Option<Duration> {
    let folder = ready(writer);
    // Writing the pictures of `generate` is not interrupted, only the work before it.
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
            "0,0,9,9",
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
    // All other options.
    (
        "",
        &[
            "",
            "0",
            "1",
            "-1",
            "nan",
            "inf",
            "-1e300",
            "1e300",
            "1e-300",
            "1e9",
            "65536",
            "18446744073709551616",
            "0,0",
            "1e9,1e9",
            "1e9,1e9,1e9",
            "\u{7}",
        ],
    ),
];

/// Options whose values are not numbers, or that only affect where and how the work is done.
const NO_NUMBERS: [&str; 5] = ["--out", "--memory", "--cache", "--title", "--set"];

/// The options with a value that a command lists, except for those that its job, formats and layers declare.
fn options(folder: &Folder, command: &str) -> Vec<String> {
    let help = folder.good(&[command, "--help"]).text().to_string();
    let named = |line: &str| {
        let (_, rest) = line.split_once("--").filter(|(before, _)| before.trim().len() <= 3)?;
        rest.split_once(" <").map(|(name, _)| format!("--{name}"))
    };
    let is_of = |commands: &[String]| commands.iter().any(|words| words.split(' ').next() == Some(command));
    let declared = declared().into_iter().filter(|(_, commands)| is_of(commands));
    let declared: Vec<&str> = declared.map(|(spec, _)| spec.name).collect();
    let is_own = |name: &String| !NO_NUMBERS.contains(&name.as_str()) && !declared.contains(&&name[2..]);
    help.lines().filter_map(named).filter(is_own).collect()
}

/// The options of jobs, formats and layers, each with the arguments of a command for every job, format or layer that
/// declares it.
fn declared() -> Vec<(&'static OptionSpec, Vec<String>)> {
    let formats = registry::options().into_iter().map(|(spec, all)| {
        let arguments = all.iter().map(|format| format!("export small.toml -o option.{}", format.name));
        (spec, arguments.collect())
    });
    let of_layer = |name: &&str| {
        let is_picture = derived::named(name).is_some_and(|layer| layer.nature() != Nature::Numbers);
        let needed = match *name {
            "viewshed" => "--observer 320,240",
            "watershed" => "--outlet 320,240",
            _ => "",
        };
        format!("export small.toml --layer {name} {needed} -o option.{}", if is_picture { "png" } else { "tif" })
    };
    let layers = derived::options().into_iter().map(|(spec, all)| (spec, all.iter().map(of_layer).collect()));
    let maps = MapJob::OPTIONS.iter().map(|spec| (spec, vec!["map small.toml --size 100 -o option.png".to_string()]));
    let renders = RenderJob::OPTIONS.iter().map(|spec| {
        let needed = match spec.condition {
            Condition::Given("camera") => "--camera 1,2,300",
            Condition::Given(_) => "--time 12:00",
            Condition::Is(..) => "--color map",
            _ => "",
        };
        (spec, vec![format!("render small.toml --size 40x30 {needed} -o option.png")])
    });
    let blocks =
        BlocksJob::OPTIONS.iter().map(|spec| (spec, vec!["blocks small.toml --size 20 -o option.png".to_string()]));
    let tilemaps =
        TilemapJob::OPTIONS.iter().map(|spec| (spec, vec!["tilemap small.toml --size 20 -o option".to_string()]));
    formats.chain(layers).chain(maps).chain(renders).chain(blocks).chain(tilemaps).collect()
}

/// The ends of the range of an option, and values beyond them.
fn ends(kind: ValueKind) -> Vec<String> {
    let all = |values: &[&str]| values.iter().map(|value| value.to_string()).collect::<Vec<String>>();
    match kind {
        ValueKind::Nothing => Vec::new(),
        ValueKind::Whole(low, high) => {
            let beyond = [low.saturating_sub(1), low, high, high.saturating_add(1)].map(|whole| whole.to_string());
            [&beyond[..], &["1.5".into(), "-1".into(), "18446744073709551616".into()]].concat()
        }
        ValueKind::Number(low, high) => {
            let ends = [low, high, low + 1e-9, high - 1e-9, low - 1.0, high * 2.0 + 1.0];
            [&ends.map(|number| format!("{number:e}"))[..], &["nan".into(), "".into()]].concat()
        }
        ValueKind::Range => all(&["1,1", "1,0", "-1e300,1e300", "0,1e-300", "-1e30,1e30", "nan,1", "0"]),
        ValueKind::Point => all(&["320,240", "0,0", "1e300,0", "-1e9,1e9", "nan,0", "0"]),
        ValueKind::Positive | ValueKind::Automatic => all(&["1e-300", "1e300", "0", "-1", "nan", "auto", ""]),
        ValueKind::Tuple(..) => all(&["0,0", "1,100", "200,24,1e300", "1e300,-1", "nan,0", "0,0,0,0", ""]),
        ValueKind::Size(most) => {
            [&all(&["0", "1x1", "64x", "nan", ""])[..], &[format!("{}", most + 1), format!("{most}x1")]].concat()
        }
        ValueKind::Part(most) => {
            [&all(&["1/1", "0/1", "2/1", "1", "/", "-1/2", ""])[..], &[format!("1/{}", most + 1)]].concat()
        }
        ValueKind::Clock => all(&["00:00", "23:59", "24:00", "12", ""]),
        ValueKind::Numbers => all(&["1e300", "-1e300,1e300", "0,0", "1,,2", "nan", ""]),
        ValueKind::Choice(choices) => {
            choices.iter().map(|choice| choice.name).chain(["", "wrong"]).map(str::to_string).collect()
        }
        ValueKind::Color => all(&["ivory", "#fff", "#12345", ""]),
        ValueKind::Layer => all(&["slope", "flow", "normal", "wrong", "\u{7}", ""]),
        ValueKind::Palette => all(&["viridis", "wrong", "absent.cpt", "small.toml", ""]),
        ValueKind::Paper => all(&["a5", "50x50mm", "2000x2000mm", "0x0mm", "nanxnanmm", ""]),
        ValueKind::Word(words) => words.iter().copied().chain(["", "wrong"]).map(str::to_string).collect(),
        ValueKind::Text => all(&["", "0", "1,2,3", "1e300", "nan", "\u{e9}", "a=1e300,b=0"]),
        ValueKind::File | ValueKind::Tileset => all(&["", "absent.txt", "small.toml", "."]),
    }
}

/// Commands with an unbounded world or without a world: the valid windows of a bounded world are known.
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
                // Few samples, so that valid requests are done at once.
                let few: &[&str] = if option == "--cell" { &["--window", "0,0,9,9"] } else { &[] };
                answered(&folder, arguments, few, option, value);
            }
        }
    }
}

/// How long a command may work before it is interrupted, and how soon it must then end.
const PATIENCE: Duration = Duration::from_secs(2);
const PROMPT: Duration = Duration::from_millis(300);

#[test]
#[ignore = "long: every option of every command at the ends of its range and beyond, its memory and the time until it ends"]
fn no_value_of_any_option_ends_a_command_without_a_sentence() {
    let folder = workplace();
    WRITERS.iter().for_each(|writer| prepare(&folder, writer));
    let writers = WRITERS.iter().map(|writer| writer.arguments);
    let mut broken = 0;
    // Numbers of runs that did their work, were refused, and were interrupted.
    let mut runs = [0; 3];
    let mut watch = |arguments: &[&str], option: &str, value: &str| {
        let ended = watched_with(&folder, arguments, option, value);
        runs[if ended.late.is_some() { 2 } else { usize::from(ended.code != Some(0)) }] += 1;
        if let Some(fault) = fault(&ended) {
            println!("{} {option}={value:?}: {fault}", arguments.join(" "));
            broken += 1;
        }
        ended.said
    };
    for arguments in UNBOUNDED.into_iter().chain(writers) {
        let is_endless = arguments.contains(&"endless");
        for option in options(&folder, arguments[0]) {
            let few: &[&str] = if option == "--cell" && is_endless { &["--window", "0,0,9,9"] } else { &[] };
            let all = [arguments, few].concat();
            let values = HOSTILE.iter().filter(|(name, _)| *name == option || name.is_empty());
            let values: Vec<&str> = values.flat_map(|(_, values)| *values).copied().collect();
            let said: String = values.iter().map(|value| watch(&all, &option, value)).collect();
            limits_named(&said).iter().for_each(|value| _ = watch(&all, &option, value));
        }
        let values =
            |option| HOSTILE.iter().filter(move |(name, _)| is_endless && *name == option).flat_map(|(_, all)| *all);
        for (cell, window) in values("--cell").flat_map(|cell| values("--window").map(move |window| (cell, window))) {
            watch(&[arguments, &["--window", window]].concat(), "--cell", cell);
        }
    }
    for (spec, commands) in declared() {
        for command in commands {
            // Without the arguments that are given only for this option.
            let option = format!("--{}", spec.name);
            let words: Vec<&str> = command.split_whitespace().collect();
            let own = words.iter().position(|word| *word == option);
            let kept = |at: &usize| own.is_none_or(|own| *at != own && *at != own + 1);
            let arguments: Vec<&str> = (0..words.len()).filter(kept).map(|at| words[at]).collect();
            ends(spec.kind).iter().for_each(|value| _ = watch(&arguments, &option, value));
        }
    }
    println!("{runs:?} runs");
    assert!(broken == 0, "{broken} of {runs:?} runs");
}

/// The limits that refusals name: "must be 1 to 1000", "at most 64".
fn limits_named(said: &str) -> BTreeSet<String> {
    let words: Vec<&str> = said.split_whitespace().map(|word| word.trim_matches([',', ';', '.', '(', ')'])).collect();
    let is_limit = |at: &usize| {
        let before = at.checked_sub(1).map_or("", |before| words[before]);
        words[*at].parse::<f64>().is_ok()
            && (matches!(before, "to" | "most" | "least" | "than" | "below") || words.get(at + 1) == Some(&"to"))
    };
    (0..words.len()).filter(is_limit).map(|at| words[at].to_string()).collect()
}

/// Runs a command with a value of an option, under a memory limit of 64 MiB.
fn watched_with(folder: &Folder, arguments: &[&str], option: &str, value: &str) -> Watched {
    let option = format!("{option}={value}");
    let mut all = [arguments, &[&option]].concat();
    if !matches!(arguments[0], "palettes" | "graph") {
        all.extend(["--memory", "64MiB"]);
    }
    remove_output(folder, arguments);
    watched(folder.command(&all), Some(PATIENCE))
}

/// The fault of such a run, if any. A run must do its work or say why not, respect its memory limit, and end at once
/// when it is interrupted.
fn fault(ended: &Watched) -> Option<String> {
    const LIMIT: u64 = 64 << 20;
    let said = ended.said.trim_end();
    let is_told = said.lines().any(|line| line.starts_with("error: "));
    let fault = match (ended.code, ended.late) {
        _ if said.contains("panicked") => Some("a panic".to_string()),
        (Some(0), None) => None,
        (Some(1 | 2), None) if is_told => None,
        (Some(0 | 1 | 130), Some(late)) => (late > PROMPT).then(|| format!("{late:?} after the interruption")),
        (code, _) => Some(format!("{code:?}")),
    };
    let peak = (ended.peak as f64 > MOST * LIMIT as f64).then(|| format!("{} MiB", ended.peak >> 20));
    fault.or(peak).map(|fault| format!("{fault}: {said}"))
}

/// Removes the files that a previous run has written.
fn remove_output(folder: &Folder, arguments: &[&str]) {
    if let Some(at) = arguments.iter().position(|argument| *argument == "-o") {
        let out = folder.path(arguments[at + 1]);
        let _ = if out.is_dir() { std::fs::remove_dir_all(out) } else { std::fs::remove_file(out) };
    }
}

/// Runs a command with a value of an option, and checks that it does its work, or reports why not.
fn answered(folder: &Folder, arguments: &[&str], more: &[&str], option: &str, value: &str) {
    let option = format!("{option}={value}");
    let all = [arguments, more, &[&option], &["--memory", "64MiB"]].concat();
    remove_output(folder, arguments);
    let mut running = Running::start(folder, &all);
    let (code, said) = running.ended();
    // Exit codes 2 and 1 come with a message; anything else is an abort or a panic.
    let is_told = said.iter().any(|line| line.starts_with("error: "));
    assert!(code == Some(0) || matches!(code, Some(1 | 2)) && is_told, "{all:?}: {code:?} {said:?}");
}
