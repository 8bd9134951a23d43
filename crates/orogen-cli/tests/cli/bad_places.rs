//! Output paths that cannot be written, or only partly: there is an error message, and there are no partial files.

use crate::harness::Folder;

#[test]
fn a_folder_that_is_a_file() {
    let folder = Folder::with_small();
    folder.write("file", "x");
    folder.bad(&["generate", "small.toml", "-o", "file"], 1, "cannot write into file: it is not a folder");
    folder.bad(&["generate", "small.toml", "-o", "file/below"], 1, "cannot make the folder file/below: ");
    folder.bad(&["export", "small.toml", "-o", "file/a.npy"], 1, "cannot write into file: it is not a folder");
    std::fs::create_dir(folder.path("a.npy")).unwrap();
    folder.bad(&["export", "small.toml", "-o", "a.npy"], 1, "cannot write a.npy: it is a folder");
    assert_eq!(folder.names(""), ["a.npy", "file", "small.toml"]);
    assert_eq!(folder.text("file"), "x");
}

/// A path that even root cannot write to.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files() {
    let folder = Folder::with_small();
    folder.bad(&["generate", "small.toml", "-o", "/proc"], 1, "cannot write into /proc: it does not allow new files");
    folder.bad(&["generate", "small.toml", "-o", "/proc/new"], 1, "cannot make the folder /proc/new: ");
    folder.bad(
        &["export", "small.toml", "-o", "/proc/a.npy"],
        1,
        "cannot write into /proc: it does not allow new files",
    );
    folder.bad(&["new", "/proc/a"], 1, "cannot write into /proc: it does not allow new files");
}

#[test]
fn a_file_in_the_way_leaves_the_old_set_as_it_was() {
    let folder = Folder::with_small();
    folder.good(&["generate", "small.toml"]);
    let old: Vec<Vec<u8>> =
        ["height.png", "height8.png", "map.png"].map(|name| folder.read(&format!("out/{name}"))).into();
    std::fs::remove_file(folder.path("out/summary.json")).unwrap();
    std::fs::create_dir(folder.path("out/summary.json")).unwrap();
    folder.bad(&["generate", "small.toml", "--size", "16"], 1, "cannot write out/summary.json: it is a folder");
    let new: Vec<Vec<u8>> =
        ["height.png", "height8.png", "map.png"].map(|name| folder.read(&format!("out/{name}"))).into();
    assert!(old == new);
    assert_eq!(folder.names("out"), ["height.png", "height8.png", "map.png", "recipe.toml", "summary.json"]);
}

#[cfg(unix)]
mod full {
    use crate::harness::{Folder, Outcome, is_whole};
    use std::process::{Command, Stdio};

    /// Runs the program with a file size limit of `blocks` of 512 bytes. Writing then fails half way, as on a full
    /// disk, but for any user and on any file system.
    fn limited(folder: &Folder, blocks: u32, arguments: &[&str]) -> Outcome {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
        let output = Command::new("sh")
            .args(["-c", &script, env!("CARGO_BIN_EXE_orogen")])
            .args(arguments)
            .current_dir(&folder.0)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        Outcome::of(&output)
    }

    #[test]
    fn a_writer_that_fails_half_way_leaves_nothing() {
        let folder = Folder::with_small();
        for blocks in [0, 1, 2, 4, 8] {
            for arguments in [&["generate", "small.toml"][..], &["export", "small.toml", "-o", "a.npy"]] {
                let outcome = limited(&folder, blocks, arguments);
                assert_eq!((outcome.code, outcome.out.len()), (1, 0), "{blocks} {arguments:?}: {}", outcome.err);
                assert!(outcome.err.starts_with("error: cannot write "), "{}", outcome.err);
            }
            assert_eq!(folder.names(""), ["small.toml"], "{blocks}");
        }
    }

    #[test]
    fn a_writer_that_fails_half_way_leaves_the_old_set() {
        let folder = Folder::with_small();
        folder.good(&["generate", "small.toml"]);
        let names = folder.names("out");
        let old: Vec<Vec<u8>> = names.iter().map(|name| folder.read(&format!("out/{name}"))).collect();
        for blocks in [0, 2, 8] {
            assert_eq!(limited(&folder, blocks, &["generate", "small.toml", "--seed", "9"]).code, 1);
            assert_eq!(folder.names("out"), names);
            assert!(names.iter().zip(&old).all(|(name, old)| folder.read(&format!("out/{name}")) == *old), "{blocks}");
        }
    }

    /// Simulates a full disk, if this user is allowed to mount file systems.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_leaves_the_old_set() {
        let folder = Folder::with_small();
        let disk = folder.path("disk");
        std::fs::create_dir(&disk).unwrap();
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=64k", "tmpfs"])
            .arg(&disk)
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success());
        if !mounted {
            return;
        }
        let small = folder.run(&["generate", "small.toml", "-o", "disk", "--size", "32"]);
        let names = folder.names("disk");
        let old: Vec<Vec<u8>> = names.iter().map(|name| folder.read(&format!("disk/{name}"))).collect();
        let full = folder.run(&["generate", "small.toml", "-o", "disk", "--size", "512"]);
        let (after, whole) = (folder.names("disk"), names.iter().all(|name| is_whole(&disk.join(name))));
        let same = names.iter().zip(&old).all(|(name, old)| folder.read(&format!("disk/{name}")) == *old);
        let unmounted = Command::new("umount").arg(&disk).status().unwrap();
        assert!(unmounted.success());
        assert_eq!((small.code, names.len(), full.code), (0, 5, 1), "{}", full.err);
        assert!(full.err.contains("no space left on device"), "{}", full.err);
        assert_eq!(after, names);
        assert!(whole && same);
    }

    #[test]
    fn a_program_that_is_killed_leaves_no_half_file() {
        let folder = Folder::with_small();
        for pause in [0, 5, 10, 20, 40, 80, 160] {
            let mut child = folder
                .command(&["generate", "small.toml", "--size", "600"])
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            std::thread::sleep(std::time::Duration::from_millis(pause));
            let _ = child.kill();
            child.wait().unwrap();
            if folder.path("out").is_dir() {
                for name in folder.names("out").iter().filter(|name| !name.starts_with(".orogen-")) {
                    assert!(is_whole(&folder.path("out").join(name)), "{name} after {pause} ms");
                }
            }
        }
    }
}
