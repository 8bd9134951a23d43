//! Recipes of clients.

use std::io;
use std::ops::Range;
use std::sync::Mutex;

use orogen::options::ValueKind;
use orogen::{Node, Recipe};
use orogen_codec::fs::objects::{ObjectEntry, ObjectInfo, ObjectStore, mount};

use super::client::{Reply, Running, parsed, start, start_within};
use super::{HILLS, PLAIN};
use crate::sent;

const ALLOWED: [(&str, &str); 1] = [("allow-recipes", "")];

fn post(server: &Running, text: &str) -> Reply {
    let head =
        format!("POST /recipes HTTP/1.1\r\nHost: a\r\nConnection: close\r\nContent-Length: {}\r\n\r\n", text.len());
    parsed(&server.send(&[head.as_bytes(), text.as_bytes()].concat())).unwrap()
}

fn error(reply: &Reply) -> String {
    reply.json()["error"].as_str().unwrap().to_string()
}

#[test]
fn a_recipe_is_served_like_other_worlds() {
    let server = start(&[("plain", PLAIN)], &ALLOWED);
    let other = start(&[("hills", HILLS)], &[]);
    let reply = post(&server, HILLS);
    assert_eq!(reply.status, 201, "{reply:?}");
    let about = reply.json();
    let name = about["name"].as_str().unwrap();
    assert_eq!((name, reply.header("location")), (sent::name(HILLS).as_str(), format!("{name}/").as_str()));
    assert_eq!(about["url"], format!("http://a/{name}/"));
    assert!(about["layers"].as_array().unwrap().contains(&"slope".into()), "{about}");
    for path in [
        "/tiles/height/0/0/0.png?grid=world",
        "/tiles/slope/0/0/0.png?grid=world",
        "/terrarium/0/0/0.png?grid=world",
        "/vector/0/0/0.mvt?grid=world",
        "/window.npy?width=64&seed=7",
        "/height?x=5&y=-5",
        "/zarr/height/c/0/0",
        "/mesh/0/0/0.terrain",
        "/recipe.toml",
    ] {
        let found = server.get(&format!("/{name}{path}"));
        assert_eq!(found.status, 200, "{path}: {}", String::from_utf8_lossy(&found.body));
        assert!(found.body == other.get(&format!("/hills{path}")).body, "{path}");
    }
    let tiles = server.get(&format!("/{name}/tilejson/height.json")).json();
    let link = tiles["tiles"][0].as_str().unwrap();
    assert!(link.starts_with(&format!("http://{}/{name}/tiles/height/", server.address)), "{link}");
    assert!(server.get(&format!("/{name}/")).text().contains("<html"));
    // The same text is the same world, without any work.
    let made = server.metric("orogen_work_total");
    assert_eq!(post(&server, HILLS).status, 200);
    assert_eq!(server.metric("orogen_work_total"), made);
    // The only world of the command line keeps its short paths.
    assert_eq!(server.get("/recipe.json").json()["name"], "plain");
    let json = r#"{"orogen":1,"world":{"cell":10},"nodes":{"n":{"op":"fbm"}},"outputs":{"height":"n"}}"#;
    assert_eq!(post(&server, json).status, 201);
    assert!(server.get("/addresses").text().contains("/recipes"));
    assert!(server.get("/openapi.json").json()["paths"]["/recipes"]["post"].is_object());
}

#[test]
fn only_the_last_recipes_are_kept_and_copies_stay_valid() {
    let server = start(&[("plain", PLAIN)], &ALLOWED);
    let name = sent::name(HILLS);
    assert_eq!(post(&server, HILLS).status, 201);
    let path = format!("/{name}/height?x=5&y=-5");
    let tag = server.get(&path).header("etag").to_string();
    for seed in 0..sent::MAX_KEPT {
        assert_eq!(post(&server, &PLAIN.replace("cell = 10", &format!("cell = 10\nseed = {seed}"))).status, 201);
    }
    let gone = server.get(&path);
    assert_eq!(gone.status, 404);
    assert!(error(&gone).contains("send it to /recipes again"), "{}", error(&gone));
    assert_eq!(post(&server, HILLS).status, 201);
    assert_eq!(server.ask("GET", &path, &[&format!("If-None-Match: {tag}")]).status, 304);
}

#[test]
fn without_the_option_no_recipe_is_taken() {
    let server = start(&[("plain", PLAIN)], &[]);
    let reply = post(&server, HILLS);
    assert_eq!(
        (reply.status, error(&reply).as_str()),
        (403, "this server takes no recipes; start it with --allow-recipes")
    );
    assert!(server.get("/openapi.json").json()["paths"]["/recipes"].is_null());
    assert!(!server.get("/addresses").text().contains("/recipes"));
    assert!(!server.ask("OPTIONS", "/recipes", &[]).header("access-control-allow-methods").contains("POST"));
    let token = "abcdefgh-01234567";
    let server = start(&[("plain", PLAIN)], &[("allow-recipes", ""), ("token", token)]);
    assert_eq!(post(&server, HILLS).status, 401);
    assert!(server.ask("OPTIONS", "/recipes", &[]).header("access-control-allow-methods").contains("POST"));
}

#[test]
fn what_is_wrong_is_a_sentence_with_its_place() {
    let server = start(&[("plain", PLAIN)], &ALLOWED);
    let nodes = |count: usize| (0..count).map(|k| format!("[nodes.n{k}]\nop = \"fbm\"\n")).collect::<String>();
    let uses = |count: usize| (0..count).map(|k| format!("[use.n{k}]\nrecipe = \"alpine\"\n")).collect::<String>();
    let head = "orogen = 1\n[world]\ncell = 10\n";
    let whole = |nodes: &str, height: &str| format!("{head}{nodes}[outputs]\nheight = \"{height}\"\n");
    let expr = |text: &str| whole(&format!("[nodes.e]\nop = \"expr\"\nexpr = \"{text}\"\n"), "e");
    for (text, status, expect) in [
        (String::new(), 400, "recipe is empty"),
        ("\u{0}".into(), 400, "recipe:1:"),
        ("hello".into(), 400, "recipe:1:"),
        (HILLS.replace("\"fbm\"", "\"fmb\""), 400, "recipe:9:6: unknown op `fmb`; did you mean `fbm`?"),
        (HILLS.replace("source", "sauce"), 400, "recipe:13:1: unknown key `sauce`"),
        ("[".repeat(100_000), 400, "recipe:1:"),
        (format!("orogen = {}1{}", "[".repeat(100_000), "]".repeat(100_000)), 400, "recipe:1:"),
        (format!("{{\"a\":{}", "[".repeat(100_000)), 400, "nested more than 64 levels deep"),
        (format!("a{} = 1", ".a".repeat(50_000)), 400, "recipe:1:"),
        (format!("x = \"{}\"", "x".repeat(sent::MAX_BYTES)), 413, "a recipe may have 262144 bytes"),
        (whole(&nodes(sent::MAX_NODES + 1), "n0"), 400, "at most 512 are allowed"),
        (whole(&uses(200), "n0"), 400, "more than 512 nodes"),
        (
            format!("{head}[nodes.n]\nop = \"fbm\"\n[outputs]\n")
                + &(0..65).map(|k| format!("h{k} = \"n\"\n")).collect::<String>(),
            400,
            "65 outputs; recipes of clients have at most 64",
        ),
        (
            whole(
                &(0..50)
                    .map(|k| {
                        let names: Vec<String> = (0..50).map(|j| format!("x{j}")).collect();
                        let given: String = names.iter().map(|name| format!("{name} = 1\n")).collect();
                        format!("[nodes.n{k}]\nop = \"expr\"\nexpr = \"{}\"\n{given}", names.join("+"))
                    })
                    .collect::<String>(),
                "n0",
            ),
            400,
            "2500 inputs of nodes; recipes of clients have at most 2048",
        ),
        (expr(&format!("{}1{}", "(".repeat(30_000), ")".repeat(30_000))), 400, "recipe:6:"),
        (expr(&"-".repeat(60_000)), 400, "recipe:6:"),
        (expr(&format!("1{}", "+1".repeat(30_000))), 400, "recipe:6:"),
        (expr(&"x".repeat(60_000)), 400, "recipe:6:"),
        (HILLS.replace("[nodes.noise]", &format!("[nodes.{}]", "n".repeat(200_000))), 400, "recipe:8:8: "),
        (HILLS.replace("cell = 10", "cell = 1e999"), 400, "recipe:6:8: "),
        (HILLS.replace("cell = 10", "cell = 1e-300"), 400, "recipe:6:8: "),
        (HILLS.replace("cell = 10", &format!("cell = {}", "9".repeat(100_000))), 400, "recipe:6:8: "),
        (HILLS.replace("[5120, 2560]", "[1e12, 1e12]"), 400, ""),
        (PLAIN.replace("wavelength = 900", "wavelength = \"= 1 / 0\""), 400, "recipe:7:16: "),
        (super::watered().replace("[5120, 2560]", "[400000, 400000]"), 413, "recipes of clients may have"),
    ] {
        let shown: String = text.chars().take(60).collect();
        let reply = post(&server, &text);
        assert_eq!(reply.status, status, "{shown}: {}", error(&reply));
        assert!(error(&reply).contains(expect), "{shown}: {}", error(&reply));
        assert!(reply.body.len() < 1 << 20, "{shown}: {}", reply.body.len());
    }
    let ask = |request: &[u8]| parsed(&server.send(request)).unwrap();
    let not_text = ask(b"POST /recipes HTTP/1.1\r\nHost: a\r\nConnection: close\r\nContent-Length: 3\r\n\r\na\xff\xfe");
    assert_eq!((not_text.status, error(&not_text).contains("byte 1 is not UTF-8")), (400, true));
    let large = ask(b"POST /recipes HTTP/1.1\r\nHost: a\r\nContent-Length: 99999999999\r\n\r\n");
    assert_eq!(large.status, 413);
    let mut chunked = b"POST /recipes HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n".to_vec();
    for _ in 0..5 {
        chunked.extend(b"10000\r\n");
        chunked.extend([b'#'; 1 << 16]);
        chunked.extend(b"\r\n");
    }
    assert_eq!(ask(&chunked).status, 413);
    let got = server.get("/recipes");
    assert_eq!((got.status, error(&got).contains("body of a POST")), (405, true));
    assert_eq!(server.get("/healthz").text(), "ok\n");
}

#[test]
fn worlds_of_clients_have_smaller_limits() {
    let server = start_within(&[("hills", HILLS)], &ALLOWED, 256 << 20);
    let name = post(&server, HILLS).json()["name"].as_str().unwrap().to_string();
    let path = "/window.npy?bbox=0,-2560,5120,0&width=4096";
    assert_eq!(server.get(&format!("/hills{path}")).status, 200);
    let reply = server.get(&format!("/{name}{path}"));
    assert_eq!(reply.status, 413);
    assert!(error(&reply).contains("more than the 4194304"), "{}", error(&reply));
    assert_eq!(server.get(&format!("/{name}/world.json")).json()["max_samples"], sent::MAX_SAMPLES);
    // A variant has the same limits as the recipe.
    let text = super::watered().replace("stream = 40000", "stream = 40000\ncell = 80");
    let name = post(&server, &text).json()["name"].as_str().unwrap_or_else(|| panic!("{text}")).to_string();
    assert_eq!(server.get(&format!("/{name}/height?x=5&y=-5&set=rivers.cell=40")).status, 200);
}

/// A store that notes each use.
#[derive(Debug)]
struct Spy;

static USES: Mutex<Vec<String>> = Mutex::new(Vec::new());

fn seen<T>(url: &str) -> io::Result<T> {
    USES.lock().unwrap().push(url.to_string());
    Err(io::ErrorKind::NotFound.into())
}

impl ObjectStore for Spy {
    fn info(&self, url: &str) -> io::Result<ObjectInfo> {
        seen(url)
    }
    fn read(&self, url: &str, _: Option<Range<u64>>, _: Option<&str>) -> io::Result<Vec<u8>> {
        seen(url)
    }
    fn list(&self, url: &str) -> io::Result<Vec<ObjectEntry>> {
        seen(url)
    }
    fn write(&self, url: &str, _: &mut dyn io::Read, _: u64, _: bool) -> io::Result<()> {
        seen(url)
    }
    fn remove(&self, url: &str) -> io::Result<()> {
        seen(url)
    }
    fn remove_all(&self, url: &str) -> io::Result<()> {
        seen(url)
    }
}

/// A name of a file that [`Spy`] notes.
const FILE: &str = "s3://spy/file.tif";

/// Reads a recipe as one of a client, and opens it if it is valid. The error is that of reading.
fn opened(text: &str) -> String {
    match sent::read(text) {
        Ok(recipe) => {
            // It may be refused for another reason, but it must not read a file.
            let _ = super::client::session().open(recipe);
            String::new()
        }
        Err(error) => error.to_string(),
    }
}

/// The keys of the tables of a list or of a table in the schema of recipes.
fn keys(table: &str) -> Vec<String> {
    let schema = orogen::recipe::schema::json_schema();
    let mut at = &schema["properties"][table];
    while at["properties"].is_null() {
        at = [&at["items"], &at["additionalProperties"], &at["anyOf"][0], &at["oneOf"][0], &at["allOf"][0]]
            .into_iter()
            .find(|inner| inner.is_object())
            .unwrap_or_else(|| panic!("{table}: {at}"));
        if let Some(name) = at["$ref"].as_str().and_then(|name| name.strip_prefix("#/definitions/")) {
            at = &schema["definitions"][name];
        }
    }
    at["properties"].as_object().unwrap().keys().cloned().collect()
}

#[test]
fn no_text_of_a_client_makes_the_server_read_a_file() {
    mount(Box::new(Spy));
    let (mut files, mut checked) = (0, 0);
    let head = "orogen = 1\n[world]\nsize = 100\ncell = 10\n[outputs]\nheight = \"n\"\n";
    for node in Node::all() {
        let spec = node.spec();
        for param in spec.params {
            let text = format!("{head}[nodes.n]\nop = \"{}\"\n{} = \"{FILE}\"\n", spec.op, param.name);
            let (mut open, error) = (node.clone(), opened(&text));
            let i = spec.param_named(param.name).unwrap();
            let is_file = open.set_param(i, &orogen::value::Value::Text(FILE.into())).is_ok() && open.names_file(i);
            assert_eq!(error.contains("is a file; this recipe may use presets, but no file"), is_file, "{text}{error}");
            files += usize::from(is_file);
            checked += 1;
        }
        for input in node.inputs() {
            opened(&format!("{head}[nodes.n]\nop = \"{}\"\n{} = \"{FILE}\"\n", spec.op, input.name));
        }
    }
    assert!(files > 3 && checked > 200, "{files} of {checked}");
    let with = |more: &str| opened(&format!("{head}[nodes.n]\nop = \"fbm\"\n{more}\n"));
    for list in ["surface", "scatter", "class"] {
        let all = keys(list);
        assert!(all.len() > 3, "{all:?}");
        for key in all {
            let named = if key == "name" { "" } else { "name = \"a\"\n" };
            with(&format!("[[{list}]]\n{named}{key} = \"{FILE}\""));
            with(&format!("[[{list}]]\n{named}{key} = [\"{FILE}\"]"));
            with(&format!("[[{list}]]\nname = \"b\"\n[[{list}]]\n{named}{key} = {{ path = \"{FILE}\" }}"));
        }
    }
    assert!(with(&format!("[[surface]]\nname = \"a\"\npicture = \"{FILE}\"")).contains("`picture` is a file"));
    for table in ["world", "parameters", "use", "studio"] {
        opened(&format!("orogen = 1\n[{table}]\na = \"{FILE}\"\n[nodes.n]\nop = \"fbm\"\n[outputs]\nheight = \"n\"\n"));
        with(&format!("[{table}.a]\nrecipe = \"{FILE}\"\ndefault = \"{FILE}\"\npath = \"{FILE}\""));
    }
    for file in [FILE, "a.toml", "/etc/passwd", "../a.toml", "C:\\a.toml", "recipes/alpine.toml"] {
        let error = with(&format!("[use.a]\nrecipe = {file:?}"));
        assert!(error.contains("is a file; this recipe may use presets"), "{file}: {error}");
    }
    assert_eq!(with("[use.a]\nrecipe = \"alpine\""), "");
    // Requests cannot name files either.
    let server = start(&[("plain", PLAIN)], &ALLOWED);
    let formats: Vec<_> = crate::windows::formats().collect();
    let derived = orogen::export::derived::list::options();
    let options = formats.iter().flat_map(|format| format.options.iter().map(|spec| (format.name, spec)));
    let options = options.chain(derived.into_iter().map(|(spec, _)| ("npy", spec)));
    let mut names = 0;
    for (format, spec) in options {
        if matches!(spec.kind, ValueKind::File | ValueKind::Palette | ValueKind::Tileset | ValueKind::Text) {
            let path = format!("/window.{format}?bbox=0,-90,90,0&layer=slope&{}={FILE}", spec.name);
            let status = server.get(&path).status;
            assert!(spec.kind == ValueKind::Text || (400..500).contains(&status), "{path}: {status}");
            names += 1;
        }
    }
    assert!(names > 0);
    for path in ["/tiles/height/14/8192/8192.png?palette", "/locate?where", "/objects.geojson?outlets", "/height?layer"]
    {
        let status = server.get(&format!("{path}={FILE}")).status;
        assert!((400..500).contains(&status), "{path}: {status}");
    }
    assert_eq!(*USES.lock().unwrap(), Vec::<String>::new());
    // The store would have noted it.
    let own = format!("{head}[nodes.n]\nop = \"dem\"\npath = \"{FILE}\"\n");
    assert!(super::client::session().open(Recipe::parse(&own, "own").unwrap()).is_err());
    assert!(!USES.lock().unwrap().is_empty());
}
