//! Lists of points in recipes.

use orogen_engine::Recipe;
use orogen_engine::declare::point_lists::MAX_POINTS;
use orogen_engine::declare::{AreaPoints, LinePoints, OutlineOptions, Param};
use orogen_engine::node::Node;
use orogen_engine::value::Value;
use orogen_io::dem::file_ref::FileRef;

fn recipe(op: &str, rest: &str) -> String {
    format!("orogen = 1\n[nodes.drawn]\nop = \"{op}\"\n{rest}\n[outputs]\nheight = \"drawn\"\n")
}

/// The points of the only node.
fn read(op: &str, points: &str) -> (Value, String) {
    let read = Recipe::parse(&recipe(op, &format!("points = {points}")), "t").unwrap_or_else(|error| panic!("{error}"));
    let node: &Node = &read.nodes()[0].node;
    let index = node.spec().param_named("points").unwrap();
    assert_eq!(Recipe::parse(&read.to_toml(), "again").unwrap(), read, "{}", read.to_toml());
    (node.param(index), read.to_toml())
}

#[test]
fn points_are_written_as_they_were_read() {
    for (points, written) in [
        ("[[0, 0], [1.5, -2]]", "[[0.0, 0.0], [1.5, -2.0]]"),
        ("[[0, 0, 7], [1, 2, 8]]", "[[0.0, 0.0, 7.0], [1.0, 2.0, 8.0]]"),
        ("[[[0, 0], [1, 2]]]", "[[[0.0, 0.0], [1.0, 2.0]]]"),
        (
            "[[[0, 0], [1, 2]], [[3, 4], [5, 6], [7, 8]]]",
            "[[[0.0, 0.0], [1.0, 2.0]], [[3.0, 4.0], [5.0, 6.0], [7.0, 8.0]]]",
        ),
    ] {
        let (value, toml) = read("path", points);
        assert_eq!(value.to_toml(), written, "{points}");
        assert!(toml.contains(&format!("points = {written}\n")), "{toml}");
    }
    let json =
        r#"{ "orogen": 1, "nodes": { "drawn": { "op": "path", "points": [[0, 0], [1e3, 5, 6]] } }, "outputs": {} }"#;
    let error = Recipe::parse(json, "t.json").unwrap_err().to_string();
    assert!(error.contains("point 2 has 3 numbers, and the points before have 2"), "{error}");
}

#[test]
fn points_may_be_formulas() {
    let text = recipe("path", "points = [[0, 0], [\"= reach\", \"= reach / 2\"]]")
        .replace("[nodes", "[parameters]\nreach = 500\n[nodes");
    let read = Recipe::parse_with(&text, "t", &[("reach".into(), 800.0)]).unwrap();
    assert_eq!(read.nodes()[0].node.param(0).to_toml(), "[[0.0, 0.0], [800.0, 400.0]]");
    assert!(read.to_toml().contains("[[0.0, 0.0], [\"= reach\", \"= reach / 2\"]]"), "{}", read.to_toml());
    // A formula without a value is reported once.
    let error = Recipe::parse(&text.replace("= reach / 2", "= raech"), "t").unwrap_err();
    assert_eq!(error.diagnostics().len(), 1, "{error}");
}

#[test]
fn from_lists_of_a_program() {
    let line = LinePoints::from(vec![[0.0, 1.0], [2.0, 3.0]]);
    assert_eq!(line.write().to_toml(), "[[0.0, 1.0], [2.0, 3.0]]");
    assert_eq!(LinePoints::from(vec![[0.0, 1.0, 5.0]]).write().to_toml(), "[[0.0, 1.0, 5.0]]");
    let two = AreaPoints::from(vec![vec![[0.0, 1.0]], vec![[2.0, 3.0]]]);
    assert_eq!(two.write().to_toml(), "[[[0.0, 1.0]], [[2.0, 3.0]]]");
    assert_eq!((two.lists().len(), two.is_empty(), LinePoints::default().is_empty()), (2, false, true));
    assert_eq!(LinePoints::default().write().to_toml(), "[]");
    assert!(!two.within([-1e9, 1e9]), "an area of one point");
    assert!(!LinePoints::from(vec![[0.0, 1.0], [f64::NAN, 3.0]]).within([-1e9, 1e9]));
}

#[test]
fn messages_say_what_is_wrong_and_where() {
    // The mark `|` is before the part that is wrong.
    for (op, rest, message) in [
        ("path", "points = |[[0, 0]]", "`points`: it has 1 point; a line needs at least 2"),
        ("polygon", "points = |[[0, 0], [1, 1]]", "`points`: it has 2 points; an area needs at least 3"),
        ("path", "points = [[[0, 0], [1, 1]], |[[2, 2]]]", "`points`: list 2 has 1 point; a line needs at least 2"),
        ("path", "points = [[0, 0], |[1]]", "`points`: point 2 has 1 number; a point is [x, y] or [x, y, height]"),
        ("path", "points = [[0, 0], |5]", "`points`: point 2 is 5; a point is [x, y] or [x, y, height]"),
        ("path", "points = [[0, 0], [1, |nan]]", "the y of point 2"),
        (
            "path",
            "points = [[0, 0], [1, |2e9]]",
            "y of point 2 must be a finite number from -1e9 to 1e9 (m), not 2000000000",
        ),
        ("path", "points = [[0, 0, |\"high\"], [1, 2, 3]]", "the height of point 1 must be a finite number"),
        (
            "path",
            "points = [[[0, 0], [1, 1]], [[2, 2], |[3, 3, 3]]]",
            "point 2 of list 2 has 3 numbers, and the points before have 2",
        ),
        ("path", "points = [[[0, 0], [1, 1]], |7]", "list 2 is 7; write each line or ring as a list of points"),
        ("path", "points = |5", "`points` must be a list of points [[x, y], ...], not 5"),
        ("path", "smooth = true", "`path` needs a line: write `points`, such as"),
        ("polygon", "smooth = true", "`polygon` needs an area: write `points`, such as"),
        (
            "path",
            "points = [[0, 0], [1, 1]]\nfile = |\"a.svg\"",
            "`points` and `file` are both given; leave out one of them",
        ),
        ("path", "file = \"a.svg\"\nscale = |[1, 0]", "`scale` must not be 0"),
    ] {
        let marked = recipe(op, rest);
        let text = marked.replace('|', "");
        let error = Recipe::parse(&text, "t").unwrap_err();
        assert!(
            error.to_string().replace("the y of", "y of").contains(&message.replace("the y of", "y of")),
            "{rest}: {error}"
        );
        if let Some(at) = marked.find('|') {
            let place = error.diagnostics()[0].place.clone().unwrap();
            let before = &marked[..at];
            let (line, start) = (before.matches('\n').count() + 1, before.rfind('\n').map_or(0, |newline| newline + 1));
            assert_eq!((place.line, place.column), (line, at - start + 1), "{rest}: {error}");
        }
    }
    let many = vec!["[1, 2]"; MAX_POINTS + 1].join(", ");
    let error = Recipe::parse(&recipe("path", &format!("points = [{many}]")), "t").unwrap_err().to_string();
    assert!(
        error.contains("more than 100000 points; write larger drawings to a file, and name it as `file`"),
        "{error:.300}"
    );
}

#[test]
fn segments_are_made_once_for_the_same_options() {
    let points = LinePoints::from(vec![[0.0, 0.0], [30.0, 40.0], [70.0, 10.0]]);
    let options = OutlineOptions { smooth: false, closed: false, tolerance: 1.0, scale: [1.0; 2], offset: [0.0; 2] };
    let address = |points: &LinePoints, options: OutlineOptions| {
        points.with_segments(&FileRef::default(), options, |segments| (std::ptr::from_ref(segments), segments.len()))
    };
    let first = address(&points, options);
    assert_eq!((first, first.1), (address(&points, options), 2));
    assert_eq!(address(&points.clone(), options), first, "copies share them");
    let closed = address(&points, OutlineOptions { closed: true, ..options });
    assert_eq!(closed.1, 3);
    assert!(address(&points, OutlineOptions { smooth: true, tolerance: 0.01, ..options }).1 > 10);
}
