//! Leftovers of killed commands: the next command that writes there removes them, and nothing else.

use std::process::{Child, Stdio};

use crate::harness::{Folder, SMALL, until};

fn start(folder: &Folder, arguments: &[&str]) -> Child {
    folder.command(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// The temporary files of this process in a folder.
fn files_of(folder: &Folder, child: &Child) -> Vec<String> {
    let mut names = folder.names("");
    names.retain(|name| name.starts_with(&format!(".orogen-{}-", child.id())) && name.ends_with(".tmp"));
    names
}

/// Starts a command and waits until it has a temporary file.
fn busy(folder: &Folder, arguments: &[&str]) -> Child {
    let mut child = start(folder, arguments);
    until("a temporary file", || {
        assert!(child.try_wait().unwrap().is_none(), "{arguments:?} ended before it was killed");
        !files_of(folder, &child).is_empty()
    });
    child
}

#[test]
fn files_of_killed_commands_go_and_those_of_the_living_stay() {
    for arguments in [
        &["export", "wide.toml", "-o", "a.asc"][..],
        &["noise", "perlin", "--size", "20000", "--octaves", "20", "-o", "a.npy"],
        &["render", "small.toml", "--turntable", "500", "-o", "a.gif"],
    ] {
        let folder = Folder::with_small();
        folder.write("wide.toml", SMALL.replace("cell = 10", "cell = 0.05"));
        let foreign = [".orogen-mine.tmp", ".orogen-1.tmp", "notes.tmp"];
        foreign.iter().for_each(|name| folder.write(name, "mine"));
        let mut killed = busy(&folder, arguments);
        killed.kill().unwrap();
        killed.wait().unwrap();
        assert!(!files_of(&folder, &killed).is_empty(), "{arguments:?}: {:?}", folder.names(""));
        // Another process is running while a third process writes.
        let mut living = busy(&folder, arguments);
        folder.good(&["export", "small.toml", "-o", "b.npy", "-q"]);
        assert!(files_of(&folder, &killed).is_empty(), "{arguments:?}: {:?}", folder.names(""));
        // What its first file was, a check of the folder or the target itself, depends on when it was seen. A file that
        // was removed does not come back.
        until("the file of the living", || !files_of(&folder, &living).is_empty());
        living.kill().unwrap();
        living.wait().unwrap();
        folder.good(&["export", "small.toml", "-o", "b.npy", "-q"]);
        let mut left = folder.names("");
        left.retain(|name| name.starts_with(".orogen"));
        assert_eq!(left, [".orogen-1.tmp", ".orogen-mine.tmp"], "{arguments:?}");
        foreign.iter().for_each(|name| assert_eq!(folder.text(name), "mine"));
    }
}
