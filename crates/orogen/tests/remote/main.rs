//! Object stores: builds, caches, exports and elevation models by URL have the bits of local ones, also through
//! failures.

#![allow(clippy::unwrap_used, reason = "a failure is a failed test")]

mod server;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use orogen::builder::run::Start;
use orogen::builder::{Build, BuildSpec, Form, Report};
use orogen::io::dem::PreparedDem;
use orogen::io::file::{Existing, OutputPolicy, write_whole};
use orogen::io::fs;
use orogen::io::test_folder::TestFolder;
use orogen::{Export, FolderStore, Options, Progress, Result, Session, Window, World, presets};
use server::{Failure, Server};

const FAILURES: [Failure; 4] = [Failure::Status(500), Failure::Silence, Failure::Status(503), Failure::Half];

/// The store of this process; every test has a bucket of its own.
fn server() -> &'static Server {
    static SERVER: OnceLock<Server> = OnceLock::new();
    SERVER.get_or_init(|| {
        let server = Server::start();
        let setting = |name: &str, value: &str| (name.to_string(), value.to_string());
        orogen::remote::mount_with([
            setting("AWS_ENDPOINT_URL", &format!("http://{}", server.address)),
            setting("AWS_ALLOW_HTTP", "true"),
            setting("AWS_REGION", "nowhere"),
            setting("AWS_ACCESS_KEY_ID", "somebody"),
            setting("AWS_SECRET_ACCESS_KEY", "secret"),
        ]);
        server.fail(&FAILURES);
        server
    })
}

fn world(preset: &str) -> World {
    World::open(presets::find(preset).unwrap().recipe().unwrap()).unwrap()
}

fn build(world: &World, spec: &BuildSpec, out: impl AsRef<Path>, start: Start) -> Result<Report> {
    let output = OutputPolicy::default().output(out.as_ref())?;
    Build::new(world, spec, &output)?.run(start, &Progress::none())
}

/// The files in a folder, or one file, by their paths within it.
fn files(out: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut left = vec![out.to_path_buf()];
    while let Some(path) = left.pop() {
        match path.is_dir() {
            true => left.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path())),
            false => {
                let name = path.strip_prefix(out).unwrap().to_string_lossy().replace('\\', "/");
                let name = if name.is_empty() { name } else { format!("/{name}") };
                found.insert(name, std::fs::read(&path).unwrap());
            }
        }
    }
    found
}

/// The objects of a result, and whether temporary ones are left.
fn objects(name: &str) -> (BTreeMap<String, Vec<u8>>, bool) {
    let all = server().objects(name);
    let beside: Vec<&String> = all.keys().filter(|name| name.starts_with(".build/")).collect();
    let are_left = beside.iter().any(|name| *name != ".build/journal");
    (all.into_iter().filter(|(name, _)| !name.starts_with(".build/")).collect(), are_left)
}

#[test]
fn objects_are_written_read_listed_and_removed_through_failures() {
    server();
    let at = |name: &str| Path::new("s3://things").join(name);
    let bytes: Vec<u8> = (0..20_000_000_u32).map(|n| (n.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    for (name, length) in
        [("a/empty", 0), ("a/one", 1), ("a/b/some more", 70_000), ("a/höhe+%23", 5000), ("big", bytes.len())]
    {
        fs::write(at(name), &bytes[..length]).unwrap();
        assert!(fs::read(at(name)).unwrap() == bytes[..length], "{name}");
        assert!(fs::is_file(&at(name)) && fs::metadata(at(name)).unwrap().len() == length as u64);
    }
    assert_eq!(server().parts(), 0, "large objects are sent in parts, of which none is left");
    let names = |folder: &str| {
        let entries = fs::read_dir(at(folder)).unwrap().map(|entry| entry.unwrap());
        let pair =
            |entry: fs::DirEntry| (entry.file_name().into_string().unwrap(), entry.file_type().unwrap().is_dir());
        entries.map(pair).collect::<BTreeMap<String, bool>>()
    };
    let expect: BTreeMap<String, bool> =
        [("b", true), ("empty", false), ("höhe+%23", false), ("one", false)].map(|(n, d)| (n.to_string(), d)).into();
    assert_eq!(names("a"), expect);
    assert!(fs::is_dir(&at("a")) && !fs::is_file(&at("a")) && !fs::is_present(&at("b")));
    // Read in pieces of any length, forwards and backwards.
    use std::io::{Read, Seek, SeekFrom};
    let mut file = fs::File::open(at("big")).unwrap();
    for (start, length) in [(0, 10), (5, 100_000), (19_999_990, 10), (7_000_000, 9_000_000), (100, 1)] {
        let mut part = vec![0; length];
        file.seek(SeekFrom::Start(start as u64)).unwrap();
        file.read_exact(&mut part).unwrap();
        assert!(part == bytes[start..start + length], "{start}");
    }
    let missing = fs::read(at("none")).unwrap_err();
    assert_eq!(
        (missing.kind(), missing.to_string().as_str()),
        (std::io::ErrorKind::NotFound, "there is no such object or bucket")
    );
    fs::remove_dir_all(at("a")).unwrap();
    assert_eq!(server().objects("things/").keys().collect::<Vec<_>>(), ["big"]);
}

#[test]
fn an_object_that_exists_is_replaced_only_where_a_file_would_be() {
    server();
    let path = Path::new("s3://policy/a.npy");
    let put = |existing: Existing, bytes: &'static [u8]| {
        write_whole(&OutputPolicy::new(existing).output(path)?, |out| out.write_all(bytes))
    };
    put(Existing::Keep, b"\x93NUMPY 1").unwrap();
    assert!(put(Existing::Keep, b"\x93NUMPY 2").unwrap_err().to_string().contains("it already exists"));
    put(Existing::SameKind, b"\x93NUMPY 3").unwrap();
    assert_eq!(server().objects("policy/")["a.npy"], b"\x93NUMPY 3");
    fs::write(path, b"orogen = 1\n").unwrap();
    assert!(put(Existing::Replace, b"\x93NUMPY 4").unwrap_err().to_string().contains("by hand"));
    let error = OutputPolicy::default().output("https://example.org/a.npy").unwrap_err().to_string();
    assert!(error.contains("files on HTTP servers are only read"), "{error}");
    // What fails while it is written is not there.
    let policy = OutputPolicy::default().output("s3://policy/b.npy").unwrap();
    assert!(write_whole(&policy, |_| Err(std::io::Error::other("enough"))).is_err());
    assert_eq!(server().objects("policy/").len(), 1);
}

#[test]
fn builds_have_the_bytes_of_local_ones_in_every_form_and_any_number_of_parts() {
    server();
    let folder = TestFolder::new("remote").unwrap();
    let hills = world("hills");
    let window = Window::new(300, 200, 30.0).at(20, 7);
    for form in Form::ALL {
        let spec = BuildSpec::new(form, window).with_tile(match form {
            Form::Tiles(_) => 65,
            Form::Xyz(_) | Form::Pmtiles(_) => 256,
            _ => 64,
        });
        let name = form.name();
        let local = folder.join(name);
        build(&hills, &spec, &local, Start::Fresh).unwrap();
        for parts in [0, 1, 3] {
            let out = format!("s3://builds/{name}-{parts}");
            match parts {
                0 => drop(build(&hills, &spec, &out, Start::Fresh).unwrap()),
                _ => (1..=parts).rev().for_each(|n| {
                    let report = build(&hills, &spec.clone().with_part(n, parts), &out, Start::Resume).unwrap();
                    assert_eq!(report.left.len(), n - 1, "{name}");
                }),
            }
            let (made, are_left) = objects(&format!("builds/{name}-{parts}"));
            assert!(made == files(&local), "{name} in {parts} parts: {:?}", made.keys());
            assert!(!are_left, "{name} in {parts} parts");
            // It is complete: nothing is made again.
            assert_eq!(build(&hills, &spec, &out, Start::Resume).unwrap().made, 0, "{name}");
        }
    }
}

#[test]
fn interrupted_builds_go_on_and_other_ones_are_refused() {
    server();
    let folder = TestFolder::new("remote-again").unwrap();
    let hills = world("hills");
    let spec = BuildSpec::new(Form::Zarr, Window::new(400, 300, 30.0)).with_tile(32);
    let (local, out) = (folder.join("a.zarr"), "s3://again/a.zarr");
    build(&hills, &spec, &local, Start::Fresh).unwrap();
    // Cancelled after some tiles.
    let output = OutputPolicy::default().output(out).unwrap();
    let flag = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&flag);
    let progress = Progress::new(move |share| set.store(share > 0.5, Ordering::Relaxed)).stopped_by(flag);
    Build::new(&hills, &spec, &output).unwrap().run(Start::Fresh, &progress).unwrap_err();
    let error = build(&hills, &spec, out, Start::Fresh).unwrap_err().to_string();
    assert!(error.contains("is an unfinished build; use --resume"), "{error}");
    let other = spec.clone().with_tile(64);
    let error = build(&hills, &other, out, Start::Resume).unwrap_err().to_string();
    assert!(error.contains("cannot be resumed"), "{error}");
    // A tile was lost.
    let lost = server().objects("again/a.zarr/height/").into_keys().find(|name| name.starts_with("c/")).unwrap();
    fs::remove_file(Path::new(out).join("height").join(lost)).unwrap();
    let report = build(&hills, &spec, out, Start::Resume).unwrap();
    assert!(report.made > 0 && report.kept > 0, "{report:?}");
    assert!(objects("again/a.zarr") == (files(&local), false));
    // Again from the start, over what is there.
    build(&hills, &other, out, Start::Force).unwrap();
    build(&hills, &other, folder.join("b.zarr"), Start::Fresh).unwrap();
    assert!(objects("again/a.zarr") == (files(&folder.join("b.zarr")), false));
    // Parts at the same time, without locks between them.
    let out = "s3://again/c.zarr";
    std::thread::scope(|scope| {
        let run = |n: usize| build(&hills, &spec.clone().with_part(n, 4), out, Start::Resume).unwrap();
        let parts: Vec<_> = (1..=4).map(|n| scope.spawn(move || run(n))).collect();
        let left = parts.into_iter().map(|part| part.join().unwrap().left.len()).min();
        assert_eq!(left, Some(0));
    });
    assert!(objects("again/c.zarr").0 == files(&local));
    // A file that no build made.
    let out = "s3://again/d.tif";
    fs::write(out, b"II*\0").unwrap();
    let spec = BuildSpec::new(Form::Cog, Window::new(64, 64, 30.0));
    for spec in [spec.clone(), spec.with_part(1, 2)] {
        let error = build(&hills, &spec, out, Start::Fresh).unwrap_err().to_string();
        assert!(error.contains("already exists"), "{error}");
    }
    assert_eq!(server().objects("again/d.tif").len(), 1, "nothing is left beside it");
}

#[test]
fn worlds_share_solutions_in_a_store() {
    server();
    let window = Window::new(64, 48, 480.0);
    let open = || {
        let cache = FolderStore { slower_than: std::time::Duration::ZERO, ..FolderStore::new("s3://cache/solutions") };
        let session = Session::new(Options { store: Some(Arc::new(cache)), ..Options::default() }).unwrap();
        session.open(presets::find("alpine").unwrap().recipe().unwrap()).unwrap()
    };
    let expect = world("alpine").window("height", &window).unwrap();
    let first = open();
    assert!(first.window("height", &window).unwrap() == expect);
    let kept = server().objects("cache/solutions/");
    assert!(!kept.is_empty());
    let second = open();
    assert!(second.window("height", &window).unwrap() == expect);
    assert!(server().objects("cache/solutions/") == kept);
}

#[test]
fn heights_are_read_in_parts_from_s3_and_http() {
    let store = server();
    let folder = TestFolder::new("remote-dem").unwrap();
    let local = folder.join("land.tif");
    let hills = world("hills");
    let spec = BuildSpec::new(Form::Cog, Window::new(1500, 1500, 10.0)).with_tile(256);
    build(&hills, &spec, &local, Start::Fresh).unwrap();
    let bytes = std::fs::read(&local).unwrap();
    store.put("dem/land.tif", bytes.clone());
    let web = Server::start();
    web.put("maps/land.tif", bytes.clone());
    let web_url = format!("http://{}/maps/land.tif", web.address);
    let expect = orogen::open(local.to_str().unwrap()).unwrap();
    let window = Window::new(150, 100, 10.0).at(700, 500);
    let expect = expect.window("height", &window).unwrap();
    for url in ["s3://dem/land.tif", &web_url] {
        let world = orogen::open(url).unwrap();
        assert!(world.window("height", &window).unwrap() == expect, "{url}");
        let part = PreparedDem::part(Path::new(url), &window, u64::MAX).unwrap().unwrap();
        assert!(part.grid.data() == expect.data(), "{url}");
    }
    assert!(web.sent() < bytes.len() as u64 / 4, "{} of {} bytes", web.sent(), bytes.len());
    // In a recipe, in whatever folder it is.
    let text = format!(
        "orogen = 1\n[world]\nsize = 14990\ncell = 10\n[nodes.land]\nop = \"dem\"\npath = \"{web_url}\"\n[outputs]\nheight = \"land\"\n"
    );
    std::fs::write(folder.join("recipe.toml"), text).unwrap();
    let recipe = orogen::open(folder.join("recipe.toml")).unwrap();
    assert!(recipe.window("height", &window).unwrap().data() == expect.data());
    // Another file under the same name while it is read.
    let world = orogen::open(&web_url).unwrap();
    web.put("maps/land.tif", bytes[..bytes.len() - 1].to_vec());
    let error = world.window("height", &window).unwrap_err().to_string();
    assert!(error.contains("it was changed"), "{error}");
    let error = orogen::open(format!("http://{}/maps/none.tif", web.address)).err().unwrap().to_string();
    assert!(error.contains("there is no such object"), "{error}");
}

#[test]
fn files_are_exported_into_a_store() {
    server();
    let folder = TestFolder::new("remote-export").unwrap();
    let hills = world("hills");
    let window = Window::new(90, 60, 100.0);
    for name in ["a.tif", "a.png", "a.npy", "a.obj"] {
        hills.export("height", &window, Path::new("s3://exports").join(name)).unwrap();
        hills.export("height", &window, folder.join(name)).unwrap();
        assert!(server().objects("exports/")[name] == std::fs::read(folder.join(name)).unwrap(), "{name}");
    }
}

#[test]
fn a_store_that_does_not_exist_is_named_in_a_sentence() {
    server();
    for (path, expect) in [
        ("s3:///a.tif", "the URL names no bucket"),
        ("s3://a/b//c.tif", "its name is not that of an object"),
        ("https://127.0.0.1/a.tif?key=1", "URLs with a query"),
    ] {
        let error = fs::read(path).unwrap_err().to_string();
        assert!(error.contains(expect), "{path}: {error}");
    }
}
