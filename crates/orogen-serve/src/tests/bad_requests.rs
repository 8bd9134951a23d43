//! Requests that are wrong have an answer that says why, and never harm the server.

use super::client::{options, parsed, recipe, session, start};
use super::{HILLS, PLAIN};
use crate::Server;

#[test]
fn what_is_wrong_is_a_sentence() {
    let server = start(&[("hills", HILLS)], &[("max-samples", "100000")]);
    for (path, status, expect) in [
        ("/nothing/here", 404, "there is no such request"),
        ("/hils/", 404, "did you mean `hills`?"),
        ("/tiles/height/1/2/3", 404, "is not a tile"),
        ("/tiles/height/1/2/3.jpg", 404, "is not a tile"),
        ("/tiles/height/-1/0/0.png", 404, "is not a tile"),
        ("/tiles/height/99/0/0.png", 404, "the zoom must be 0 to 24"),
        ("/tiles/height/3/8/0.png", 404, "columns and rows are 0 to 7"),
        ("/tiles/height/3/99999999999999999999/0.png", 404, "is not a tile"),
        ("/tiles/height/3/%20/0.png", 404, "is not a tile"),
        ("/tiles/height/14/0/0.png", 404, "outside the world; at zoom 14 it has the columns 8192 to"),
        ("/tiles/heigth/14/8192/8192.png", 404, "`height`"),
        ("/tiles/a%00b%2f..%2f/14/8192/8192.png", 404, "unknown layer"),
        ("/tiles/splat/0/0/0.png?grid=world", 400, "channels"),
        ("/tiles/viewshed/0/0/0.png?grid=world", 404, "viewshed"),
        ("/tiles/height/0/0/0.png?grid=mars", 400, "`grid` must be web"),
        ("/tiles/height/0/0/0.png?gird=world", 400, "did you mean `grid`?"),
        ("/tiles/height/0/0/0.png?grid=world&grid=web", 400, "given twice"),
        ("/tiles/height/0/0/0.png?grid=%f", 400, "percent-encoded"),
        ("/%ff/", 400, "percent-encoded"),
        ("/vector/0/0/0.png?grid=world", 404, "such as 12/2048/2050.mvt"),
        ("/vector/0/0/0@2x.mvt?grid=world", 404, "is not a tile"),
        ("/vector/14/0/0.mvt", 404, "outside the world"),
        ("/vector/0/0/0.mvt?grid=world&layers=contour", 404, "did you mean `contours`?"),
        ("/vector/0/0/0.mvt?grid=world&layers=contours,rivers", 404, "nothing drains its land"),
        ("/vector/0/0/0.mvt?grid=world&layers=objects", 404, "no table `[[scatter]]`"),
        ("/vector/0/0/0.mvt?grid=world&interval=0", 400, "`interval` must be 0.001 to 100000 m, not 0"),
        ("/vector/0/0/0.mvt?grid=world&interval=0.001", 400, "use a larger interval"),
        ("/vector/0/0/0.mvt?grid=world&intervall=5", 400, "did you mean `interval`?"),
        ("/tilejson/height", 404, "/tilejson/height.json"),
        ("/tilejson/nothing.json", 404, "no layer `nothing`"),
        ("/wmts?REQUEST=GetTile&LAYER=height", 400, "no request `GetTile`"),
        ("/wmts?SERVICE=WMTS&REQUEST=GetCapabilities&layer=height", 400, "no parameter `layer`"),
        ("/wmts?requst=GetCapabilities", 400, "did you mean `request`?"),
        ("/window.tif?bbox=1,2,3", 400, "is not W,S,E,N"),
        ("/window.tif?bbox=5,0,1,9", 400, "the west, 5, must be less"),
        ("/window.tif?bbox=0,0,100,100", 400, "the whole world is 0,-2560,5120,0"),
        ("/window.tif?width=0", 400, "`width` must be a whole number from 1"),
        ("/window.tif?width=1e3", 400, "`width` must be a whole number"),
        ("/window.tif?width=100&height=70", 400, "nearest sizes that do"),
        ("/window.tif?width=100&cell=5", 400, "leave out `cell`"),
        ("/window.tif?cell=-1", 400, "cell size must be"),
        ("/window.tif?cell=nan", 400, "`cell` must be a number"),
        ("/window.tif?cell=1e-300", 400, "cell size must be"),
        ("/window.tif?cell=1e9", 400, "no samples"),
        ("/window.tif?cell=1", 413, "13107200, more than the 100000"),
        ("/window.npy?layer=nothing&cell=100", 404, "no layer `nothing`"),
        ("/window.tif?layer=normal&cell=100", 400, "3 channels"),
        ("/window.png?bits=7&cell=100", 400, "bits"),
        ("/window.png?no-sidecar=1", 400, "no parameter `no-sidecar`"),
        ("/window.png?azimuth=7&cell=100", 400, "no parameter `azimuth`"),
        ("/window.jpg", 404, "no world or request is called `window.jpg`"),
        ("/objects.geojson?cell=100", 400, "no objects"),
        ("/objects.geojson?layer=river", 404, "did you mean `rivers`?"),
        ("/objects.geojson?layer=rivers&interval=5", 400, "no parameter `interval`"),
        ("/objects.geojson?layer=contours&interval=5&levels=7&cell=100", 400, "exclude each other"),
        ("/objects.geojson?layer=contours&outlets=%2Fetc%2Fpasswd", 400, "no parameter `outlets`"),
        ("/objects.geojson?layer=contours&cell=1", 413, "more than the 100000"),
        ("/objects.geojson?layer=contours&bbox=0,0,9,9", 400, "the whole world is 0,-2560,5120,0"),
        ("/height", 400, "give `x` and `y`"),
        ("/height?x=1", 400, "give `x` and `y`"),
        ("/height?x=a&y=1", 400, "`x` must be a number"),
        ("/height?x=1&y=1", 400, "outside the world"),
        ("/height?x=1&y=-1&layer=normal", 400, "several channels"),
        ("/profile", 400, "`points` must be 2 to 256"),
        ("/profile?points=0,0;9,-9&samples=1", 400, "from 2 to 4096"),
        ("/profile?points=0,0;9,-9&samples=99999", 400, "from 2 to 4096"),
        ("/locate?where=height", 400, "such as `height > 3000`"),
        ("/locate?where=hieght%3E3", 404, "did you mean `height`?"),
        ("/locate?find=lakes&where=aera%3E3", 400, "did you mean `area`?"),
        ("/locate?find=caves", 400, "caves"),
        ("/locate?cell=-1", 400, "cell size must be"),
        ("/locate?cell=0.001", 400, "a larger cell"),
        ("/locate?counts=2", 400, "did you mean `count`?"),
        ("/metrics?x=1", 400, "this request has none"),
    ] {
        let reply = server.get(path);
        let error = reply.json()["error"].as_str().unwrap_or_default().to_string();
        assert_eq!(reply.status, status, "{path}: {error}");
        assert!(error.contains(expect), "{path}: {error}");
        assert!(!error.contains("--") || error.contains("--max"), "{path}: {error}");
        assert_eq!(reply.header("cache-control"), "no-store", "{path}");
    }
    let reply = server.ask("POST", "/height", &["Content-Length: 3"]);
    assert_eq!((reply.status, reply.json()["error"].as_str().unwrap()), (405, "requests are GET or HEAD"));
    let unbounded = start(&[("plain", PLAIN)], &[]);
    assert!(unbounded.get("/window.tif").json()["error"].as_str().unwrap().contains("give a `bbox`"));
    assert_eq!(unbounded.get("/window.npy?bbox=-500,-500,500,500").status, 200);
    assert_eq!(unbounded.get("/tiles/drainage-area/14/8192/8192.png").status, 404);
}

#[test]
fn paths_lead_nowhere_else() {
    let server = start(&[("hills", HILLS), ("plain", PLAIN)], &[]);
    for path in [
        "/../../../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/..%2f..%2fetc%2fpasswd",
        "/hills/../../etc/passwd",
        "/hills/..%2f..%2fetc/passwd",
        "//etc/passwd",
        "/hills/tiles/..%2f..%2f..%2fetc%2fpasswd/0/0/0.png",
        "/hills/window.tif?layer=../../../../etc/passwd",
        "/hills/window.tif?layer=/etc/passwd",
        "/hills/tilejson/..%2f..%2fCargo.toml",
        "/hills.toml",
        "/Cargo.toml",
        "/C:\\Windows\\win.ini",
        "/\\..\\..\\etc\\passwd",
    ] {
        let reply = server.get(path);
        assert!((400..500).contains(&reply.status), "{path}: {}", reply.status);
        assert!(!String::from_utf8_lossy(&reply.body).contains("root:"), "{path}");
    }
}

/// Random numbers (Knuth's 64-bit linear congruential generator).
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % count as u64) as usize
    }
}

#[test]
fn random_requests_have_an_answer_and_the_server_lives_on() {
    const WORDS: [&str; 55] = [
        "hills",
        "plain",
        "tiles",
        "terrarium",
        "terrain-rgb",
        "vector",
        "0.mvt",
        "8192.mvt",
        "tilejson",
        "wmts",
        "window.tif",
        "window.png",
        "window.npy",
        "height",
        "profile",
        "locate",
        "objects.geojson",
        "zarr",
        "mesh",
        "layer.json",
        "0.terrain",
        "zarr.json",
        "c",
        "height.json",
        "slope",
        "0",
        "1",
        "3",
        "13",
        "14",
        "8192",
        "0.png",
        "8192.png",
        "8193@2x.png",
        "..",
        ".",
        "",
        "%00",
        "%2f",
        "%ff",
        "é",
        "🌋",
        "a b",
        "-1",
        "1e9",
        "nan",
        "99999999999999999999",
        "metrics",
        "openapi.json",
        "healthz",
        "noise.value",
        "normal",
        "@2x.png",
        ".png",
        "{z}",
    ];
    const QUERIES: [&str; 27] = [
        "grid=web",
        "grid=world",
        "grid=",
        "bbox=0,-100,100,0",
        "bbox=,,,",
        "bbox=1e308,-1e308,1e309,1",
        "width=9",
        "height=9",
        "width=99999999999",
        "cell=1e-6",
        "cell=500",
        "layer=slope",
        "layer=",
        "x=10",
        "y=-10",
        "x=inf",
        "points=0,0;9,-9",
        "samples=2",
        "layers=contours",
        "layer=rivers",
        "interval=1e-3",
        "v=1",
        "seed=3",
        "set=noise.octaves=2",
        "set=noise.wavelength=-1",
        "set=",
        "&&=&",
    ];
    let server = start(&[("hills", HILLS), ("plain", PLAIN)], &[("max-samples", "4096")]);
    let mut random = Random(7);
    for _ in 0..400 {
        let mut path = String::new();
        for _ in 0..random.below(8) {
            path.push('/');
            path.push_str(WORDS[random.below(WORDS.len())]);
        }
        for k in 0..random.below(4) {
            path.push(if k == 0 { '?' } else { '&' });
            path.push_str(QUERIES[random.below(QUERIES.len())]);
        }
        if path.is_empty() {
            path.push('/');
        }
        let head = format!("GET {path} HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n");
        let reply = parsed(&server.send(head.as_bytes()));
        let status = reply.map(|reply| reply.status);
        assert!(status.is_some_and(|status| status < 500), "{path}: {status:?}");
    }
    // What is no request at all.
    for _ in 0..60 {
        let mut bytes: Vec<u8> = (0..random.below(200)).map(|_| random.below(256) as u8).collect();
        bytes.extend(b"\r\n\r\n");
        server.send_all(&bytes);
    }
    let many: String = (0..200).map(|k| format!("X-{k}: y\r\n")).collect();
    let flood = server.send(format!("GET / HTTP/1.1\r\nHost: a\r\n{many}\r\n").as_bytes());
    assert_eq!(parsed(&flood).map(|reply| reply.status), Some(431));
    let long = server.send(format!("GET /{} HTTP/1.1\r\nHost: a\r\n\r\n", "a".repeat(1 << 20)).as_bytes());
    assert!(parsed(&long).is_none_or(|reply| (400..500).contains(&reply.status)));
    assert_eq!(server.get("/healthz").text(), "ok\n");
}

#[test]
fn other_machines_need_a_token() {
    let refused = |given: &[(&'static str, &str)]| Server::new(session(), &options(given)).err().unwrap().to_string();
    assert!(refused(&[("host", "0.0.0.0")]).contains("set --token TOKEN"));
    assert!(refused(&[("host", "::")]).contains("set --token TOKEN"));
    assert!(refused(&[("host", "example.org")]).contains("set --token TOKEN"));
    assert!(refused(&[("token", "short")]).contains("at least 16"));
    assert!(refused(&[("token", "with spaces and more")]).contains("only letters"));
    assert!(Server::new(session(), &options(&[("host", "::1")])).is_ok());
    let token = "abcdefgh-01234567";
    let server = start(&[("hills", HILLS)], &[("token", token), ("host", "0.0.0.0")]);
    for (path, header, status) in [
        ("/height?x=1&y=-1", "X: y", 401),
        ("/height?x=1&y=-1&token=abcdefgh-01234568", "X: y", 401),
        ("/height?x=1&y=-1", "Authorization: Bearer wrong", 401),
        ("/nothing/at/all", "X: y", 401),
        ("/metrics", "X: y", 401),
        ("/healthz", "X: y", 200),
        ("/height?x=1&y=-1&token=abcdefgh-01234567", "X: y", 200),
        ("/height?x=1&y=-1", "Authorization: Bearer abcdefgh-01234567", 200),
    ] {
        let reply = server.ask("GET", path, &[header]);
        assert_eq!(reply.status, status, "{path} {header}");
        assert_eq!(reply.header("www-authenticate") == "Bearer", status == 401);
    }
    // Links pass the token on, and the log never has it.
    let tiles = server.get(&format!("/tilejson/height.json?token={token}")).json();
    assert!(tiles["tiles"][0].as_str().unwrap().ends_with(&format!("&token={token}")), "{tiles}");
    let reply = server.get(&format!("/tiles/height/0/0/0.png?grid=world&token={token}"));
    assert_eq!(reply.header("cache-control"), "private, no-cache");
    assert!(server.lines.lock().unwrap().iter().all(|line| !line.contains(token)));
}

#[test]
fn names_that_cannot_be_served_are_refused() {
    let mut server = Server::new(session(), &options(&[])).unwrap();
    server.add("hills", recipe(HILLS), false).unwrap();
    for (name, expect) in [
        ("hills", "two worlds have the name `hills`"),
        ("tiles", "are requests"),
        ("", "1 to 100 letters"),
        ("a/b", "1 to 100 letters"),
        ("..", "1 to 100 letters"),
        ("ä", "1 to 100 letters"),
    ] {
        let error = server.add(name, recipe(HILLS), false).unwrap_err().to_string();
        assert!(error.contains(expect), "{name}: {error}");
    }
    let address = server.bind().unwrap();
    let mut other = Server::new(session(), &options(&[("port", &address.port().to_string())])).unwrap();
    assert!(other.bind().unwrap_err().to_string().contains("choose another --port"));
    let empty = Server::new(session(), &options(&[])).unwrap();
    let stop = std::sync::Arc::default();
    assert!(empty.run(&stop, |_| ()).unwrap_err().to_string().contains("no world to serve"));
}
