//! `orogen serve`. What the server answers is tested in orogen-serve.

use crate::harness::Folder;

#[cfg(not(feature = "serve"))]
#[test]
fn without_the_server_it_is_said_how_to_get_it() {
    let folder = Folder::new();
    for arguments in [&["serve"][..], &["serve", "hills", "--port", "0"], &["serve", "--token", "x", "a.toml"]] {
        folder.bad(
            arguments,
            2,
            "this program was built without the server; `cargo build --release -p orogen-cli --features serve`",
        );
    }
}

#[cfg(feature = "serve")]
mod with_server {
    use std::io::{BufRead, BufReader, Read, Write};
    use std::net::TcpStream;
    use std::process::{Child, Stdio};

    use super::Folder;

    /// A running server, and its first line of output. It is killed when dropped.
    struct Serving {
        child: Child,
        line: String,
    }

    fn serve(folder: &Folder, arguments: &[&str]) -> Serving {
        let all = [&["serve", "--port", "0"], arguments].concat();
        let mut child = folder.command(&all).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        Serving { child, line }
    }

    impl Serving {
        fn get(&self, path: &str) -> String {
            let address = self
                .line
                .split("http://")
                .nth(1)
                .unwrap_or_else(|| panic!("{}", self.line))
                .trim_end_matches(['/', '\n']);
            let mut stream = TcpStream::connect(address).unwrap();
            write!(stream, "GET {path} HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n").unwrap();
            let mut answer = Vec::new();
            stream.read_to_end(&mut answer).unwrap();
            String::from_utf8_lossy(&answer).into_owned()
        }
    }

    impl Drop for Serving {
        fn drop(&mut self) {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }

    #[test]
    fn recipes_presets_files_of_heights_and_folders_are_served() {
        let folder = Folder::with_small();
        std::fs::create_dir(folder.path("worlds")).unwrap();
        folder.write("worlds/one two.toml", folder.read("small.toml"));
        folder.write("worlds/broken.toml", "orogen = 1\n[nodes.a]\nop = \"nothing\"\n");
        folder.write("worlds/notes.txt", "no world");
        folder.good(&["export", "small.toml", "-o", "worlds/place.tif", "-q"]);
        let serving = serve(&folder, &["hills", "small.toml", "worlds"]);
        assert!(
            serving.line.starts_with("serving hills, small, one-two, place at http://127.0.0.1:"),
            "{}",
            serving.line
        );
        for (path, expect) in [
            ("/", "href=\"/one-two/\""),
            ("/hills/height?x=100&y=-100", "\"unit\":\"m\""),
            ("/place/window.png?width=32", "image/png"),
            ("/small/terrarium/0/0/0.png?grid=world", "image/png"),
        ] {
            let answer = serving.get(path);
            assert!(answer.starts_with("HTTP/1.1 200") && answer.contains(expect), "{path}: {answer}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_signal_ends_it_in_peace_and_its_log_has_a_line_for_each_request() {
        let folder = Folder::with_small();
        let mut serving = serve(&folder, &["small.toml"]);
        assert!(serving.get("/healthz").ends_with("ok\n"));
        let signalled =
            std::process::Command::new("kill").args(["-TERM", &serving.child.id().to_string()]).status().unwrap();
        assert!(signalled.success());
        let mut log = String::new();
        serving.child.stderr.take().unwrap().read_to_string(&mut log).unwrap();
        assert_eq!(serving.child.wait().unwrap().code(), Some(0), "{log}");
        assert!(log.contains("method=GET path=\"/healthz\" status=200"), "{log}");
    }

    #[test]
    fn what_cannot_be_served_is_a_sentence() {
        let folder = Folder::with_small();
        std::fs::create_dir(folder.path("empty")).unwrap();
        for (arguments, code, expect) in [
            (&["serve", "hils"][..], 2, "did you mean `hills`?"),
            (&["serve", "empty"], 2, "has no recipe (.toml) and no file of heights"),
            (&["serve", "small.toml", "./small.toml"], 2, "two worlds have the name `small`"),
            (&["serve", "small.toml", "--host", "0.0.0.0"], 2, "set --token TOKEN"),
            (&["serve", "small.toml", "--port", "70000"], 2, "--port"),
            (&["serve", "small.toml", "--queue", "0"], 2, "--queue"),
        ] {
            folder.bad(arguments, code, expect);
        }
        let help = folder.good(&["serve", "--help"]).text().to_string();
        for option in ["--port", "--host", "--token", "--queue", "--max-samples", "--timeout", "--memory", "--cache"] {
            assert!(help.contains(option), "{option}: {help}");
        }
    }
}
