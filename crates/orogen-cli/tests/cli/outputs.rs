//! Files that exist before a command writes: inputs, user files, files of other kinds, and its own earlier output.

use std::fs;

use crate::commands::{WRITERS, Writer, prepare, workplace};
use crate::harness::{Folder, SMALL, share};

/// Options to overwrite nothing or everything.
const FLAGS: [&str; 2] = ["--no-clobber", "--force"];

/// The arguments of a command with additional ones.
fn with<'a>(writer: &Writer, more: &[&'a str]) -> Vec<&'a str> {
    let asked = writer.arguments.iter().copied().filter(|argument| !FLAGS.contains(argument));
    asked.chain(more.iter().copied()).collect()
}

/// The options for writing over an existing build.
fn again(writer: &Writer) -> &'static [&'static str] {
    if writer.arguments[0] == "build" { &["--force"] } else { &[] }
}

fn no_temporaries(folder: &Folder) {
    assert!(!folder.names("").iter().any(|name| name.starts_with(".orogen")), "{:?}", folder.names(""));
}

#[test]
fn a_run_replaces_its_own_output_and_nothing_else() {
    for writer in WRITERS {
        let folder = workplace();
        prepare(&folder, writer);
        let name = writer.arguments.join(" ");
        folder.good(&with(writer, &[]));
        let first: Vec<Vec<u8>> = writer.files.iter().map(|file| folder.read(file)).collect();
        folder.good(&with(writer, again(writer)));
        // --no-clobber stops the command in every case.
        let kept = folder.run(&with(writer, &["-n"]));
        assert_eq!(kept.code, 1, "{name}: {}", kept.err);
        // A user's file at the path of any of the outputs is kept.
        for (file, own) in writer.files.iter().zip(&first) {
            folder.write(file, "My notes on the walk to the lake.\n");
            let refused = folder.run(&with(writer, &[]));
            // A sidecar may be written next to the other file instead.
            let elsewhere = file.ends_with(".json") && writer.arguments[0] == "export";
            assert_eq!(refused.code, i32::from(!elsewhere), "{name}: {file}: {}", refused.err);
            assert_eq!(folder.text(file), "My notes on the walk to the lake.\n", "{name}: {file}");
            if !elsewhere {
                assert!(refused.err.contains(file), "{name}: {file}: {}", refused.err);
                folder.good(&with(writer, &["--force"]));
                assert_ne!(folder.read(file), b"My notes on the walk to the lake.\n", "{name}: {file}");
            }
            folder.write(file, own);
        }
        no_temporaries(&folder);
    }
}

#[test]
fn a_recipe_by_hand_is_replaced_by_no_command() {
    for writer in WRITERS {
        let folder = workplace();
        prepare(&folder, writer);
        for file in writer.files {
            if let Some(within) = folder.path(file).parent() {
                fs::create_dir_all(within).unwrap();
            }
            folder.write(file, SMALL);
            for more in [&[][..], &["--force"], &["--no-clobber"]] {
                let refused = folder.run(&with(writer, more));
                // A sidecar may be written next to the other file instead.
                let elsewhere = file.ends_with(".json") && writer.arguments[0] == "export";
                assert!(elsewhere || refused.code == 1, "{file} {more:?}: {}", refused.err);
                assert_eq!(folder.text(file), SMALL, "{file} {more:?}");
            }
            fs::remove_file(folder.path(file)).unwrap();
        }
    }
}

#[test]
fn no_command_writes_over_what_it_reads() {
    let folder = workplace();
    folder.good(&["export", "small.toml", "--cell", "5", "-o", "dem.tif", "-q"]);
    let dem = folder.read("dem.tif");
    folder.write(
        "land.toml",
        "orogen = 1\n[world]\nsize = [600, 400]\n[nodes.a]\nop = \"dem\"\npath = \"dem.tif\"\n[nodes.b]\n\
         op = \"stream-power\"\nsource = \"a\"\nsteps = 2\n[outputs]\nheight = \"b\"\n",
    );
    // All paths of the same file.
    fs::hard_link(folder.path("dem.tif"), folder.path("hard.tif")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("dem.tif", folder.path("soft.tif")).unwrap();
    let names = if cfg!(unix) { &["dem.tif", "./dem.tif", "hard.tif", "soft.tif"][..] } else { &["dem.tif"] };
    for name in names {
        for source in ["dem.tif", "land.toml"] {
            for more in [&[][..], &["--force"]] {
                for command in ["export", "build", "refine"] {
                    if command == "refine" && source != "dem.tif" {
                        continue;
                    }
                    let out = [&[command, source, "-o", name][..], more].concat();
                    folder.bad(&out, 1, "this command reads that file");
                }
            }
        }
    }
    // Output paths with another extension: the path is a link to an input.
    #[cfg(unix)]
    for (command, more, name) in [
        ("map", &[][..], "l.png"),
        ("map", &[], "l.pdf"),
        ("render", &["--size", "64x36"], "l.png"),
        ("analyze", &[], "l.png"),
        ("grow", &["--frames", "2"], "l.gif"),
        ("grow", &["--frames", "2"], "l-%d.png"),
        ("fit", &[], "l.toml"),
        ("refine", &[], "l.toml"),
        ("refine", &[], "l.png"),
        ("generate", &[], "made"),
    ] {
        fs::create_dir_all(folder.path("made")).unwrap();
        for link in ["l.png", "l.pdf", "l.gif", "l-1.png", "l.toml", "made/map.png"] {
            let _ = std::os::unix::fs::symlink(folder.path("dem.tif"), folder.path(link));
        }
        let source = if matches!(command, "grow") { "land.toml" } else { "dem.tif" };
        for force in [&[][..], &["--force"]] {
            folder.bad(
                &[&[command, source, "-o", name, "-q"][..], more, force].concat(),
                1,
                "this command reads that file",
            );
        }
    }
    // Palettes are inputs too.
    folder.write("tint.gpl", "GIMP Palette\n0 0 0 a\n255 255 255 b\n");
    fs::hard_link(folder.path("tint.gpl"), folder.path("tint.png")).unwrap();
    for arguments in [
        &["map", "small.toml", "--palette", "tint.gpl", "-o", "tint.png"][..],
        &["render", "small.toml", "--color", "map", "--palette", "tint.gpl", "-o", "tint.png"],
        &["palettes", "tint.gpl", "-o", "tint.png"],
    ] {
        folder.bad(&[arguments, &["--force"]].concat(), 1, "this command reads that file");
    }
    assert!(folder.read("dem.tif") == dem, "untouched");
}

#[test]
fn a_users_recipe_in_the_folder_of_the_result_is_kept() {
    let folder = Folder::new();
    fs::create_dir(folder.path("w")).unwrap();
    let mine = format!("# My own comment.\n{SMALL}");
    folder.write("w/recipe.toml", &mine);
    folder.bad(&["generate", "w/recipe.toml", "-o", "w"], 1, "this command reads that file");
    folder.bad(&["generate", "hills", "--size", "16", "-o", "w", "--force"], 1, "written or edited by hand");
    assert_eq!(folder.text("w/recipe.toml"), mine);
    assert_eq!(folder.names("w"), ["recipe.toml"]);
    // A recipe written by Orogen may be overwritten until someone changes it.
    folder.good(&["generate", "w/recipe.toml", "-o", "v", "-q"]);
    folder.good(&["generate", "w/recipe.toml", "-o", "v", "-q"]);
    let changed = folder.text("v/recipe.toml").replace("octaves = 4", "octaves = 5");
    folder.write("v/recipe.toml", &changed);
    folder.bad(&["generate", "w/recipe.toml", "-o", "v", "-q"], 1, "written or edited by hand");
    assert_eq!(folder.text("v/recipe.toml"), changed);
}

#[test]
fn what_may_not_be_replaced_is_refused_before_the_work() {
    let folder = Folder::new();
    // Worlds that take hours.
    folder.write("vast.toml", SMALL.replace("size = [640, 480]", "size = [400000, 400000]"));
    folder.write(
        "rivers.toml",
        "orogen = 1\n[world]\nsize = [400000, 400000]\n[nodes.a]\nop = \"fbm\"\n[nodes.b]\nop = \"stream-power\"\nsource = \"a\"\n\
         [outputs]\nheight = \"b\"\n",
    );
    folder.write("a.png", "mine");
    for arguments in [
        &["export", "vast.toml", "-o", "a.png"][..],
        &["map", "vast.toml", "-o", "a.png"],
        &["render", "vast.toml", "-o", "a.png"],
        &["analyze", "vast.toml", "-o", "a.png"],
        &["grow", "rivers.toml", "-o", "a.png"],
        &["noise", "perlin", "--size", "200000", "-o", "a.png"],
        &["export", "vast.toml", "--target", "unity", "-o", "a.png", "--layer", "slope"],
    ] {
        let outcome = folder.run(&[arguments, &["--progress", "json", "--memory", "60GiB"]].concat());
        assert!(outcome.code == 1 && outcome.err.contains("a.png: it exists and is text"), "{}", outcome.err);
        let done = outcome.err.lines().filter_map(share).fold(0.0, f64::max);
        assert_eq!(done, 0.0, "{arguments:?}: {}", outcome.err);
    }
    assert_eq!(folder.text("a.png"), "mine");
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_written_through() {
    let folder = Folder::with_small();
    for more in [&[][..], &["-n"], &["--force"]] {
        folder.good(&[&["export", "small.toml", "--format", "png", "-o", "/dev/null", "-q"][..], more].concat());
    }
}

/// The output of a shell command line in which `$0` is the program.
#[cfg(target_os = "linux")]
fn shell(folder: &Folder, line: &str) -> std::process::Output {
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", line, env!("CARGO_BIN_EXE_orogen")]).current_dir(&folder.0).env("OROGEN_CACHE", "");
    shell.output().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_by_any_name_holds_the_data_alone() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "a.png", "-q"]);
    let expect = folder.read("a.png");
    std::os::unix::fs::symlink("/dev/stdout", folder.path("link.png")).unwrap();
    for out in ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "link.png"] {
        let found = folder.good(&["export", "small.toml", "--format", "png", "-o", out]).out;
        assert!(found == expect, "{out}: {} bytes, not {}", found.len(), expect.len());
    }
    for line in ["-o /dev/stdout >b.png", "-o - >b.png", "-o /dev/stdout | cat >b.png"] {
        let output = shell(&folder, &format!("\"$0\" export small.toml --format png {line}"));
        assert!(output.status.success() && folder.read("b.png") == expect, "{line}: {output:?}");
        fs::remove_file(folder.path("b.png")).unwrap();
    }
    folder.bad(&["export", "small.toml", "--seed", "1,2", "-o", "/dev/stdout"], 2, "cannot be written to one stream");
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_takes_nothing_is_an_error() {
    let folder = Folder::with_small();
    for line in ["--help", "--version", "export --help", "presets", "export small.toml -o -"] {
        let output = shell(&folder, &format!("exec \"$0\" {line} >/dev/full"));
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{line}: {said}");
        assert!(said.contains("error: cannot write to standard output: no space left on device"), "{line}: {said}");
    }
    let output = shell(&folder, "exec \"$0\" export small.toml -o - >&-");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("error: cannot write to standard output: it is closed"), "{said}");
    assert!(shell(&folder, "exec \"$0\" export small.toml -o - >/dev/null").status.success());
    assert!(shell(&folder, "exec \"$0\" export small.toml -o a.npy >&-").status.success(), "nothing is lost");
}
