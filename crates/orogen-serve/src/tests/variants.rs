//! Variants of worlds have the bits of worlds with another seed and other numbers.

use orogen::Window;
use serde_json::json;

use super::client::{start, world};
use super::{HILLS, PLAIN};

/// A recipe with parameters.
fn parameters() -> String {
    let text = HILLS.replace("to = [0, 300]", "to = [0, \"=relief\"]");
    text + "[parameters.relief]\ndefault = 300\nrange = [10, 4000]\nunit = \"m\"\nhelp = \"Height of the hills.\"\n"
}

#[test]
fn answers_are_those_of_the_changed_recipe() {
    let text = parameters();
    let changed = text.replace("cell = 10", "cell = 10\nseed = 7").replace("= 900", "= 450").replace("= 300", "= 1500");
    let (server, world) = (start(&[("hills", &text)], &[]), world(&changed));
    let other = start(&[("hills", &changed)], &[]);
    let set = "seed=7&set=relief=1500&set=noise.wavelength%3D450";
    let heights = server.get(&format!("/window.npy?{set}")).body;
    let expect = world.window("height", &Window::new(512, 256, 10.0)).unwrap();
    let samples = heights[heights.len() - 4 * 512 * 256..].chunks_exact(4);
    assert!(samples.map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).eq(expect.data().iter().copied()));
    for path in [
        "/tiles/height/0/0/0.png?grid=world",
        "/tiles/slope/0/0/0.png?grid=world",
        "/terrarium/14/8192/8192.png?",
        "/window.tif?width=64",
        "/height?x=5&y=-5",
        "/profile?points=0,0;900,-900&samples=9",
        "/locate?where=height%3E700",
    ] {
        let found = server.get(&format!("{path}&{set}"));
        assert_eq!(found.status, 200, "{path}: {}", String::from_utf8_lossy(&found.body));
        assert!(found.body == other.get(path).body, "{path}");
        let own = server.get(path);
        assert!(own.body != found.body && own.header("etag") != found.header("etag"), "{path}");
    }
    // Links lead to the variant, with its own version.
    let tiles = server.get(&format!("/tilejson/height.json?{set}")).json();
    let link = tiles["tiles"][0].as_str().unwrap().replace("{z}/{x}/{y}", "14/8192/8192");
    assert!(link.contains("&seed=7&set=relief%3D1500&set=noise.wavelength%3D450"), "{link}");
    let tile = server.follow(&link);
    assert!(tile.header("cache-control").contains("immutable"), "{link}");
    assert!(tile.body == other.get("/tiles/height/14/8192/8192.png").body);
    // The same numbers in another order are the same variant.
    let again = server.get("/recipe.json?set=noise.wavelength=450&seed=7&set=relief=1500").json();
    assert_eq!(again["version"], server.get(&format!("/recipe.json?{set}")).json()["version"]);
}

#[test]
fn the_recipe_lists_what_can_be_set() {
    let server = start(&[("hills", &parameters())], &[]);
    let recipe = server.get("/recipe.json").json();
    assert_eq!((&recipe["seed"], &recipe["size"]), (&json!(0), &json!([5120.0, 2560.0])));
    let relief =
        json!({ "set": "relief", "value": 300.0, "range": [10.0, 4000.0], "unit": "m", "doc": "Height of the hills." });
    assert_eq!(recipe["parameters"], json!([relief]));
    let nodes = recipe["nodes"].as_array().unwrap();
    let octaves = nodes.iter().find(|node| node["set"] == "noise.octaves").unwrap();
    assert_eq!((&octaves["op"], &octaves["whole"]), (&json!("fbm"), &json!(true)));
    // Every one can be set to its own value, which changes nothing but the address.
    for node in nodes {
        let (name, value) = (node["set"].as_str().unwrap(), &node["value"]);
        let own = server.get(&format!("/recipe.json?set={name}={value}"));
        assert_eq!(own.json()["version"], recipe["version"], "{name}");
    }
    let variant = server.get("/recipe.json?seed=3&set=relief=20").json();
    assert_eq!((&variant["seed"], &variant["parameters"][0]["value"]), (&json!(3), &json!(20.0)));
}

#[test]
fn variants_are_bounded_and_what_cannot_be_set_is_refused() {
    let server = start(&[("hills", &parameters()), ("plain", PLAIN)], &[]);
    for (path, status, expect) in [
        ("/hills/height?x=1&y=-1&set=relief=5", 400, "from 10 to 4000 (m), not 5"),
        ("/hills/height?x=1&y=-1&set=releif=50", 400, "did you mean `relief`"),
        ("/hills/height?x=1&y=-1&set=noise.octaves=1e9", 400, "`noise.octaves` must be"),
        ("/hills/height?x=1&y=-1&set=noise.wavelength=0", 400, "`noise.wavelength` must be"),
        ("/hills/height?x=1&y=-1&set=land.source=5", 400, "no parameter `land.source`"),
        ("/hills/height?x=1&y=-1&set=world.cell=5", 400, "no parameter `world.cell`"),
        ("/plain/height?x=1&y=-1&set=relief=5", 400, "this recipe has none"),
        ("/hills/height?x=1&y=-1&seed=1.5", 400, "`seed` must be a whole number"),
        ("/hills/height?x=1&y=-1&set=relief", 400, "a name and a number"),
        ("/hills/zarr/zarr.json?set=relief=50", 400, "no parameter `set`"),
        ("/nothing/recipe.json?seed=1", 404, "no world"),
    ] {
        let reply = server.get(path);
        let error = reply.json()["error"].as_str().unwrap_or_default().to_string();
        assert_eq!(reply.status, status, "{path}: {error}");
        assert!(error.contains(expect), "{path}: {error}");
    }
    let mut heights = std::collections::BTreeSet::new();
    for seed in 0..40 {
        let value = server.get(&format!("/hills/height?x=1000&y=-1000&seed={seed}")).json()["value"].clone();
        heights.insert(value.to_string());
    }
    assert!(heights.len() > 30, "{heights:?}");
}
