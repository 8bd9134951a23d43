//! Strokes in recipes.

use orogen_engine::Recipe;
use orogen_engine::declare::Param;
use orogen_engine::declare::point_lists::MAX_POINTS;
use orogen_engine::declare::strokes::{MAX_STROKES, Stroke, Strokes};

fn recipe(strokes: &str) -> String {
    format!("orogen = 1\n[nodes.painted]\nop = \"paint\"\nstrokes = {strokes}\n[outputs]\nheight = \"painted\"\n")
}

fn parse(text: &str) -> Recipe {
    Recipe::parse(text, "t").unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn strokes_are_read_and_written_with_a_line_for_each() {
    let text = recipe(
        "[{ points = [[0, 0], [1.5, -2]], radius = 20, value = -3, mode = \"set\", strength = 0.25 }, { radius = 5, points = [[7, 8]], hardness = 1 }]",
    );
    let read = parse(&text);
    let toml = read.to_toml();
    let expect = "strokes = [\n  { points = [[0, 0], [1.5, -2]], radius = 20, hardness = 0.5, mode = \"set\", value = -3, strength = 0.25 },\n  \
        { points = [[7, 8]], radius = 5, hardness = 1, mode = \"add\", value = 1, strength = 1 },\n]\n";
    assert!(toml.contains(expect), "{toml}");
    assert_eq!(parse(&toml), read);
    // As separate tables, and as JSON.
    let tables = "orogen = 1\n[nodes.painted]\nop = \"paint\"\n[[nodes.painted.strokes]]\npoints = [[0, 0], [1.5, -2]]\nradius = 20\nvalue = -3\nmode = \"set\"\nstrength = 0.25\n\
        [[nodes.painted.strokes]]\npoints = [[7, 8]]\nradius = 5\nhardness = 1\n[outputs]\nheight = \"painted\"\n";
    assert_eq!(parse(tables), read);
    let json = r#"{ "orogen": 1, "nodes": { "painted": { "op": "paint", "strokes": [
        { "points": [[0, 0], [1.5, -2]], "radius": 20, "value": -3, "mode": "set", "strength": 0.25 },
        { "points": [[7, 8]], "radius": 5, "hardness": 1 } ] } }, "outputs": { "height": "painted" } }"#;
    assert_eq!(parse(json), read);
    assert!(parse(&recipe("[]")).to_toml().contains("strokes = []\n"));
}

#[test]
fn the_short_table_leaves_out_defaults() {
    let stroke = Stroke { points: vec![[1.0, 2.0]], radius: 100.0, value: 3.0, ..Stroke::default() };
    assert_eq!(stroke.short_table().to_toml(), "{ points = [[1, 2]], radius = 100, value = 3 }");
    let strokes = parse(&recipe(&format!("[{}]", stroke.short_table().to_toml()))).nodes()[0].node.param(0);
    assert_eq!(strokes, Strokes::from(vec![stroke]).write());
}

#[test]
fn numbers_of_strokes_may_be_formulas() {
    let text = recipe("[{ points = [[\"= reach\", 0]], radius = \"= reach / 2\" }]")
        .replace("[nodes", "[parameters]\nreach = 500\n[nodes");
    let read = parse(&text);
    assert!(read.to_toml().contains("points = [[\"= reach\", 0]], radius = \"= reach / 2\""), "{}", read.to_toml());
    let read = Recipe::parse_with(&text, "t", &[("reach".into(), 800.0)]).unwrap();
    let stroke = Stroke { points: vec![[800.0, 0.0]], radius: 400.0, ..Stroke::default() };
    assert_eq!(read.nodes()[0].node.param(0), Strokes::from(vec![stroke]).write());
}

#[test]
fn messages_say_what_is_wrong_and_where() {
    // The mark `|` is before the part that is wrong.
    for (strokes, message) in [
        ("|5", "`strokes` must be a list of strokes [{ points = [[x, y], ...], radius = 100 }, ...], not 5"),
        ("[{ points = [[1, 2]], radius = 5 }, |[1, 2]]", "`strokes`: stroke 2 is [1, 2]; write it as { points ="),
        ("[|{ points = [[1, 2]] }]", "`strokes`: stroke 1 has no `radius`"),
        ("[|{}]", "stroke 1 has no `points` and `radius`"),
        ("[{ points = |[], radius = 5 }]", "`strokes`: stroke 1 has 0 points; a stroke needs at least 1"),
        ("[{ points = |5, radius = 5 }]", "the points of stroke 1 must be a list [[x, y], ...], not 5"),
        ("[{ points = [[1, 2], |[1, 2, 3]], radius = 5 }]", "point 2 of stroke 1 has 3 numbers; a point is [x, y]"),
        (
            "[{ points = [[1, |2e9]], radius = 5 }]",
            "y of point 1 of stroke 1 must be a finite number from -1e9 to 1e9 (m), not 2000000000",
        ),
        (
            "[{ points = [[1, 2]], radius = |0 }]",
            "in stroke 1 `radius` must be a finite number from 0.001 to 1e9 (m), not 0",
        ),
        (
            "[{ points = [[1, 2]], radius = 1, hardness = |2 }]",
            "in stroke 1 `hardness` must be a finite number from 0 to 1, not 2",
        ),
        ("[{ points = [[1, 2]], radius = 1, mode = |\"ad\" }]", "did you mean \"add\"?"),
        ("[{ points = [[1, 2]], radius = 1, value = |nan }]", "in stroke 1 `value` must be"),
        (
            "[{ points = [[1, 2]], radius = 1, |radios = 2 }]",
            "unknown key `radios` in stroke 1; did you mean `radius`?",
        ),
    ] {
        let marked = recipe(strokes);
        let error = Recipe::parse(&marked.replace('|', ""), "t").unwrap_err();
        assert!(error.to_string().contains(message), "{strokes}: {error}");
        let (at, place) = (marked.find('|').unwrap(), error.diagnostics()[0].place.clone().unwrap());
        let start = marked[..at].rfind('\n').map_or(0, |newline| newline + 1);
        assert_eq!(place.column, at - start + 1, "{strokes}: {error}");
    }
    let error = |strokes: String| Recipe::parse(&recipe(&strokes), "t").unwrap_err().to_string();
    let stroke = "{ points = [[1, 2]], radius = 1 }, ";
    let many = error(format!("[{}]", stroke.repeat(MAX_STROKES + 1)));
    assert!(many.contains("more than 10000 strokes; paint the others in a node of their own"), "{many:.300}");
    let half = format!("{{ points = [{}], radius = 1 }}", "[1, 2], ".repeat(MAX_POINTS / 2 + 1));
    let many = error(format!("[{half}, {half}]"));
    assert!(many.contains("more than 100000 points; paint the others in a node of their own"), "{many:.300}");
}

#[test]
fn strokes_of_a_program_are_checked() {
    let good = Stroke { points: vec![[1.0, 2.0]], ..Stroke::default() };
    let within = |stroke: &Stroke| Strokes::from(vec![good.clone(), stroke.clone()]).within([0.0; 2]);
    assert!(within(&good));
    for bad in [
        Stroke { points: Vec::new(), ..good.clone() },
        Stroke { points: vec![[f64::NAN, 0.0]], ..good.clone() },
        Stroke { radius: 0.0, ..good.clone() },
        Stroke { hardness: 1.5, ..good.clone() },
        Stroke { value: f64::INFINITY, ..good.clone() },
        Stroke { strength: -0.1, ..good.clone() },
    ] {
        assert!(!within(&bad), "{bad:?}");
    }
    assert!(!Strokes::from(vec![good; MAX_STROKES + 1]).within([0.0; 2]));
}

#[test]
fn buffers_are_made_once() {
    let strokes = Strokes::from(vec![Stroke { points: vec![[1.0, 2.0]], ..Stroke::default() }]);
    let address = |strokes: &Strokes| strokes.with_buffers(std::ptr::from_ref);
    assert_eq!(address(&strokes), address(&strokes));
    assert_eq!(address(&strokes.clone()), address(&strokes), "copies share them");
    assert!(strokes.memory() > 100);
}
