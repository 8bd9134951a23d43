//! `orogen build`: killed, interrupted, or without disk space, it has the same bytes in the end.

use crate::harness::{Folder, Outcome, Running, until};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::Instant;

/// The builds: a name and the options.
const BUILDS: [(&str, &[&str]); 7] = [
    ("a.tif", &["small.toml", "--tile", "64", "--cell", "0.7"]),
    ("a.zarr", &["small.toml", "--tile", "100", "--layers", "height,noise", "--cell", "0.9"]),
    ("png", &["small.toml", "--tiles", "png", "--tile", "65", "--cell", "0.9"]),
    ("r16", &["hills", "--tiles", "r16", "--tile", "129", "--cell", "20"]),
    ("r32", &["archipelago", "--tiles", "r32", "--tile", "129", "--cell", "40"]),
    ("map", &["hills", "--tiles", "terrarium"]),
    ("a.pmtiles", &["hills", "--tiles", "terrain-rgb", "--cell", "40"]),
];

/// The arguments that build `name`.
fn arguments<'a>(name: &'a str, asked: &'a [&'a str], more: &'a [&'a str]) -> Vec<&'a str> {
    [&["build"][..], asked, &["-o", name], more].concat()
}

/// All files of a result, by relative path.
fn files(path: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut left = vec![path.to_path_buf()];
    while let Some(next) = left.pop() {
        if next.is_dir() {
            left.extend(fs::read_dir(&next).unwrap().map(|entry| entry.unwrap().path()));
        } else {
            found.insert(next.strip_prefix(path).unwrap().to_path_buf(), fs::read(&next).unwrap());
        }
    }
    found
}

fn start(folder: &Folder, arguments: &[&str]) -> Child {
    folder.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn what_is_built_and_what_is_said() {
    let folder = Folder::with_small();
    for (name, asked) in BUILDS {
        let outcome = folder.good(&arguments(name, asked, &[]));
        assert!(outcome.err.contains(" tiles of ") && outcome.err.contains(" of disk"), "{}", outcome.err);
        assert!(outcome.text().starts_with(&format!("{name}: height")), "{}", outcome.text());
        assert!(outcome.text().contains(" tiles made in "), "{}", outcome.text());
        let again = folder.good(&arguments(name, asked, &["--resume", "-q"]));
        assert!(again.out.is_empty() && again.err.is_empty());
        folder.bad(
            &arguments(name, asked, &["-q"]),
            1,
            "is already complete; use --resume to check it, or --force to build it again",
        );
        folder.bad(
            &arguments(name, asked, &["-q", "--resume", "--seed", "99"]),
            1,
            "it was started from another recipe or seed",
        );
    }
    folder.good(&["export", "small.toml", "--cell", "0.7", "-o", "b.tif"]);
    folder.good(&["build", "small.toml", "--cell", "0.7", "-o", "c.tif"]);
    assert!(folder.read("b.tif") == folder.read("c.tif"), "build and export write the same file");
    // Tiles with shared edges include the far edge; other builds leave it to the neighbor.
    assert_eq!(folder.json("r16/manifest.json")["window"]["width"], 769);
    assert_eq!(folder.json("a.zarr/height/zarr.json")["shape"][1], 711);
    assert_eq!(folder.json("map/tiles.json")["map_metres_per_metre"], 1.0);
}

#[test]
fn what_cannot_be_built_is_usage() {
    let folder = Folder::with_small();
    for (options, code, expect) in [
        (
            &["-o", "a"][..],
            2,
            "a does not determine what to build: use the extension .tif, .zarr or .pmtiles, or --tiles",
        ),
        (&["-o", "a.tif", "--tiles", "png"], 2, "--tiles writes a folder, but a.tif has the extension of a file"),
        (&["-o", "a", "--tiles", "bmp"], 2, "invalid value"),
        (&["-o", "a.tif", "--layers", "height,noise"], 2, "a GeoTIFF holds one layer, and 2 were chosen"),
        (&["-o", "a.zarr", "--layers", "hieght"], 2, "did you mean `height`?"),
        (&["-o", "a.pmtiles", "--tiles", "r16"], 2, "a .pmtiles file holds terrarium or terrain-rgb tiles"),
        (&["-o", "a.pmtiles", "--size", "100"], 2, "tiles of web maps have fixed cell sizes"),
        (&["-o", "a.pmtiles", "--layers", "height,noise"], 2, "a .pmtiles file holds one layer"),
        (&["-o", "a.zarr", "--window", "60,0,10,10"], 2, "not inside the world"),
        (&["-o", "a.zarr", "--tile", "0"], 2, "invalid value"),
        (&["-o", "a.tif", "--tile", "100"], 2, "a multiple of 16"),
        (&["-o", "a.tif", "--resume", "--no-clobber"], 2, "cannot be used with"),
        (&["-o", "a.tif", "--part", "0/4"], 2, "parts are counted from 1: the first of 64 parts is 1/64"),
        (&["-o", "a.tif", "--part", "5/4"], 2, "there is no part 5 of 4: the last is 4/4"),
        (&["-o", "a.tif", "--part", "all"], 2, "it must be K/N, such as 3/64 for the third of 64 parts"),
        (&["-o", "a.tif", "--part", "1/4", "--force"], 2, "--part cannot be used with --force"),
        (&["-o", "a.tif", "--part", "1/4", "--no-clobber"], 2, "leave out --no-clobber"),
        (&["-o", "none/a.tif"], 1, "cannot write into none: the folder does not exist"),
        (&["-o", "a.zarr", "--memory", "1kB"], 1, "of memory"),
        (&["-o", "small.toml", "--tiles", "png"], 1, "this command reads that file"),
    ] {
        folder.bad(&[&["build", "small.toml", "-q"][..], options].concat(), code, expect);
        assert_eq!(folder.names(""), ["small.toml"], "{options:?}");
    }
    folder.write("wide.toml", crate::harness::SMALL.replace("size = [640, 480]", "size = [1e9, 1e9]"));
    folder.bad(
        &["build", "wide.toml", "-q", "-o", "a.zarr", "--cell", "1"],
        1,
        "not enough disk space for a.zarr: up to ",
    );
    assert_eq!(folder.names(""), ["small.toml", "wide.toml"]);
}

#[test]
fn killed_at_any_moment_it_ends_with_the_same_bytes() {
    kill_builds(8);
}

#[test]
#[ignore = "long: 300 kills"]
fn killed_at_many_moments_it_ends_with_the_same_bytes() {
    kill_builds(300);
}

fn kill_builds(kills: u32) {
    let mut references = Vec::new();
    for (name, asked) in &BUILDS[..3] {
        let folder = Folder::with_small();
        let begun = Instant::now();
        folder.good(&arguments(name, asked, &[]));
        references.push((files(&folder.path(name)), begun.elapsed()));
    }
    let (mut killed, mut state) = (0, 88_172_645_463_325_252u64);
    // A kill that comes too late for a build does not count. The required result of each build does not depend on that.
    for ((name, asked), (expect, usual)) in BUILDS.iter().zip(&references).cycle().take(4 * kills as usize) {
        let folder = Folder::with_small();
        // Killed repeatedly until it completes, on average at most once per build.
        let mut left = 1 + kills / BUILDS.len() as u32;
        loop {
            let mut child = start(&folder, &arguments(name, asked, &["--resume", "-q"]));
            if left > 0 {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                std::thread::sleep(usual.mul_f64((state >> 11) as f64 / (1u64 << 53) as f64));
                child.kill().unwrap();
                left -= 1;
            }
            let output = child.wait_with_output().unwrap();
            if output.status.success() {
                break;
            }
            assert_eq!(output.status.code(), None, "{name}: {}", String::from_utf8_lossy(&output.stderr));
            killed += 1;
        }
        assert!(files(&folder.path(name)) == *expect, "{name} is another after a kill");
        let beside = folder.names(&format!("{name}.build"));
        assert_eq!(beside, ["journal", "lock"], "{name}");
        if killed >= kills {
            break;
        }
    }
}

#[test]
fn what_parts_say() {
    let folder = Folder::with_small();
    let (name, asked) = BUILDS[1];
    folder.good(&arguments("whole.zarr", asked, &["-q"]));
    let part = |part: &str, more: &[&str]| {
        let outcome = folder.good(&arguments(name, asked, &[&["--part", part], more].concat()));
        (outcome.text().to_string(), outcome.err)
    };
    let (out, err) = part("2/3", &[]);
    assert!(err.starts_with("part 2 of 3: 16 tiles of 0.3 million samples"), "{err}");
    assert!(out.contains("\n16 tiles made in "), "{out}");
    assert!(
        out.ends_with(" s\npart 2 of 3 is complete; parts 1 and 3 are not, and the last part finishes the result\n"),
        "{out}"
    );
    folder.bad(&arguments(name, asked, &["-q", "--part", "1/4"]), 1, "was started in 3 parts, not in 4");
    let other = ["--part", "1/3", "-q", "--seed", "9"];
    folder.bad(&arguments(name, asked, &other), 1, "it was started from another recipe or seed");
    let (out, _) = part("2/3", &["--resume"]);
    assert!(out.contains("\nnothing was left to make in "), "{out}");
    assert_eq!(part("1/3", &["-q"]), (String::new(), String::new()));
    assert!(!folder.path("a.zarr/zarr.json").exists());
    let (out, _) = part("3/3", &[]);
    assert!(out.ends_with(" s\nthe result is complete\n"), "{out}");
    assert!(files(&folder.path(name)) == files(&folder.path("whole.zarr")));
    let (out, _) = part("1/3", &[]);
    assert!(out.ends_with(" s\nthe result is complete\n"), "{out}");
    assert_eq!(folder.names("a.zarr.build"), ["journal", "lock"]);
}

#[test]
fn killed_parts_end_with_the_same_bytes() {
    let mut state = 362_436_069u32;
    for (name, asked) in &BUILDS[..3] {
        let folder = Folder::with_small();
        let begun = Instant::now();
        folder.good(&arguments(name, asked, &["-q"]));
        let (expect, usual) = (files(&folder.path(name)), begun.elapsed());
        let folder = Folder::with_small();
        // In each of two rounds, all parts are started and two of them are killed. Nothing is killed in the last one.
        for round in 0..3 {
            let part = |number: usize| {
                let part = format!("{number}/3");
                start(&folder, &arguments(name, asked, &["-q", "--threads", "1", "--part", &part]))
            };
            let mut parts: Vec<Child> = [2, 3, 1].map(part).into();
            for killed in parts.iter_mut().take(if round < 2 { 2 } else { 0 }) {
                state ^= state << 13;
                state ^= state >> 17;
                state ^= state << 5;
                std::thread::sleep(usual.mul_f64(f64::from(state) / f64::from(u32::MAX)));
                killed.kill().unwrap();
            }
            for part in parts {
                let output = part.wait_with_output().unwrap();
                let said = String::from_utf8_lossy(&output.stderr);
                assert!(output.status.success() || round < 2 && output.status.code().is_none(), "{name}: {said}");
            }
        }
        assert!(files(&folder.path(name)) == expect, "{name}");
        assert_eq!(folder.names(&format!("{name}.build")), ["journal", "lock"], "{name}");
    }
}

/// A build that takes one thread a minute.
const SLOW: [&str; 9] = ["slow.toml", "--cell", "0.1", "--tile", "64", "--memory", "22MiB", "--threads", "1"];

/// A folder with the recipe of [`SLOW`].
fn with_slow() -> Folder {
    let folder = Folder::new();
    folder.write("slow.toml", crate::harness::slow());
    folder
}

/// Options that messages suggest work.
#[cfg(unix)]
#[test]
fn a_build_over_a_file_of_another_kind_can_be_resumed() {
    let folder = with_slow();
    folder.write("a.tif", "a text");
    folder.bad(
        &arguments("a.tif", &SLOW, &["--resume", "-q"]),
        1,
        "it exists and is text, not a TIFF picture; choose another name, or replace it with --force",
    );
    let mut running = Running::start_and_wait(&folder, &arguments("a.tif", &SLOW, &["--force"]));
    running.signal("-INT");
    let (code, said) = running.ended();
    assert_eq!(code, Some(130), "{said:?}");
    assert_eq!(said.last().unwrap(), "stopped: run the same command with --resume to continue", "{said:?}");
    assert_eq!(folder.text("a.tif"), "a text");
    let mut running = Running::start_and_wait(&folder, &arguments("a.tif", &SLOW, &["--force", "--resume"]));
    running.signal("-TERM");
    let (code, said) = running.ended();
    assert_eq!(code, Some(143), "it goes on: {said:?}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_cleanly() {
    let folder = with_slow();
    for (signal, expect) in [("-INT", 130), ("-TERM", 143)] {
        let mut build = Running::start_and_wait(&folder, &arguments("a.zarr", &SLOW, &["--resume"]));
        until("the folder of the layer", || folder.path("a.zarr/height").exists());
        build.signal(signal);
        let (code, said) = build.ended();
        assert_eq!(code, Some(expect), "{said:?}");
        assert_eq!(said.last().unwrap(), "stopped: run the same command with --resume to continue", "{said:?}");
        fs::remove_dir_all(folder.path("a.zarr")).unwrap();
    }
    for arguments in [
        &["export", "slow.toml", "--cell", "0.1", "-o", "a.npy"][..],
        &["generate", "slow.toml", "--cell", "0.1", "-o", "made"],
    ] {
        let mut running = Running::start_and_wait(&folder, arguments);
        running.signal("-INT");
        let (code, said) = running.ended();
        assert_eq!((code, said.last().unwrap().as_str()), (Some(130), "stopped: nothing was written"), "{arguments:?}");
        assert_eq!(folder.names(""), ["a.zarr.build", "slow.toml"], "{arguments:?}");
    }
}

/// Sets file size limits: the system ends the process in the middle of a write.
#[cfg(unix)]
#[test]
fn a_limit_on_files_leaves_a_build_to_go_on_with() {
    let folder = Folder::with_small();
    let asked = ["small.toml", "--cell", "0.7", "-q", "-o"];
    folder.good(&[&["build"][..], &asked, &["whole.tif"]].concat());
    let line = format!("ulimit -f 300; exec {} build {} a.tif", env!("CARGO_BIN_EXE_orogen"), asked.join(" "));
    let mut shell = std::process::Command::new("sh");
    let output = shell.arg("-c").arg(&line).current_dir(&folder.0).output().unwrap();
    assert!(!output.status.success(), "{output:?}");
    assert!(!folder.path("a.tif").exists(), "no half file");
    Outcome::of(&folder.command(&[&["build"][..], &asked, &["a.tif", "--resume"]].concat()).output().unwrap());
    assert!(folder.read("a.tif") == folder.read("whole.tif"));
}

#[test]
fn two_builds_do_not_work_on_one_place() {
    let folder = with_slow();
    let mut build = Running::start_and_wait(&folder, &arguments("a.zarr", &SLOW, &[]));
    for more in [&["-q"][..], &["-q", "--resume"], &["-q", "--force"]] {
        folder.bad(&arguments("a.zarr", &SLOW, more), 1, "another build of ");
    }
    assert!(build.child.try_wait().unwrap().is_none(), "the first build still works");
    drop(build);
    // The lock was released when its process ended.
    folder.bad(&arguments("a.zarr", &SLOW, &["-q"]), 1, "is an unfinished build; use --resume to continue it");
}

#[test]
fn a_part_is_not_built_twice_at_the_same_time() {
    let folder = with_slow();
    let mut part = Running::start_and_wait(&folder, &arguments("a.zarr", &SLOW, &["--part", "1/2"]));
    folder.bad(&arguments("a.zarr", &SLOW, &["-q", "--part", "1/2"]), 1, "part 1 of 2 of ");
    folder.bad(&arguments("a.zarr", &SLOW, &["-q", "--part", "1/3"]), 1, "was started in 2 parts, not in 3");
    folder.bad(&arguments("a.zarr", &SLOW, &["-q", "--resume"]), 1, "another build of ");
    let other = Running::start_and_wait(&folder, &arguments("a.zarr", &SLOW, &["--part", "2/2"]));
    assert!(part.child.try_wait().unwrap().is_none(), "the first part still works");
    drop(other);
    #[cfg(unix)]
    {
        part.signal("-INT");
        let (code, said) = part.ended();
        assert_eq!(code, Some(130), "{said:?}");
        assert_eq!(said.last().unwrap(), "stopped: run the same command to continue", "{said:?}");
    }
}

#[test]
fn force_removes_a_builds_own_files_and_no_others() {
    let folder = Folder::with_small();
    for (n, (name, asked)) in BUILDS.iter().filter(|(name, _)| !["a.tif", "a.pmtiles"].contains(name)).enumerate() {
        folder.good(&arguments(name, asked, &["-q"]));
        let expect = files(&folder.path(name));
        let mut own = vec!["notes.txt".to_string(), "mine/photo.png".to_string(), "0/0/mine.png".to_string()];
        if n % 2 == 0 {
            own.push("height_x99_y99.png".to_string());
        }
        for file in &own {
            fs::create_dir_all(folder.path(&format!("{name}/{file}")).parent().unwrap()).unwrap();
            folder.write(&format!("{name}/{file}"), "mine");
        }
        let outcome = folder.good(&arguments(name, asked, &["--force"]));
        assert!(
            outcome.err.contains("notes.txt") && outcome.err.contains("which were not made by a build"),
            "{}",
            outcome.err
        );
        for file in &own {
            assert_eq!(folder.text(&format!("{name}/{file}")), "mine", "{name}");
            fs::remove_file(folder.path(&format!("{name}/{file}"))).unwrap();
        }
        assert!(files(&folder.path(name)) == expect, "{name}");
        // A conflict with the new files stops the build before it removes anything.
        let other = ["small.toml", "--tiles", "r16", "--tile", "33"];
        if *name == "png" {
            folder.write("png/height_x0_y0.r16", "mine");
            folder.bad(
                &arguments(name, &other, &["--force", "-q"]),
                1,
                "was not made by a build and would be overwritten",
            );
            assert_eq!(files(&folder.path(name)).len(), expect.len() + 1, "nothing was removed");
            fs::remove_file(folder.path("png/height_x0_y0.r16")).unwrap();
            folder.good(&arguments(name, &other, &["--force", "-q"]));
            assert!(
                folder.names("png").iter().all(|file| !file.ends_with(".png")),
                "nothing is left of the other form"
            );
        }
    }
    // A recipe in the folder of its own result, and a user's folder at the build's working path.
    folder.write("map/small.toml", crate::harness::SMALL);
    folder.good(&["build", "map/small.toml", "--tiles", "r32", "--tile", "33", "-o", "map", "--force", "-q"]);
    assert_eq!(folder.text("map/small.toml"), crate::harness::SMALL);
    fs::create_dir(folder.path("b.zarr.build")).unwrap();
    folder.write("b.zarr.build/thesis.txt", "mine");
    folder.bad(
        &["build", "small.toml", "-o", "b.zarr", "--force", "-q"],
        1,
        "b.zarr.build holds thesis.txt, which was not made by a build",
    );
    assert_eq!(folder.names("b.zarr.build"), ["thesis.txt"]);
}

#[test]
fn resuming_after_damage_says_what_was_made() {
    let folder = Folder::with_small();
    let (name, asked) = ("map", &["hills", "--tiles", "terrarium"][..]);
    folder.good(&arguments(name, asked, &["-q"]));
    let expect = files(&folder.path(name));
    let tiles = expect.keys().filter(|path| path.extension().is_some_and(|extension| extension == "png")).count();
    // The lowest zoom is computed from all others.
    let zoom = |path: &&PathBuf| path.iter().next().unwrap().to_string_lossy().parse::<u32>().unwrap_or(u32::MAX);
    let top = expect.keys().min_by_key(zoom).unwrap();
    fs::write(folder.path(name).join(top), "tampered").unwrap();
    let told = folder.good(&arguments(name, asked, &["--resume"])).text().to_string();
    assert!(told.contains(&format!("1 tile made, {0} kept ({0} of them computed again", tiles - 1)), "{told}");
    assert!(files(&folder.path(name)) == expect);
}
