//! Edits of texts.

use orogen::declare::Input;
use orogen::presets;
use orogen::value::Value;

use super::document::Document;
use super::drawing;
use super::edit::Edit;

const TEXT: &str = r#"# A land.
orogen = 1

[parameters]
relief = 900.0        # the height

[world]
seed = 7   # lucky
size = [4000, 4000]
cell = 10

# The hills.
[nodes.hills]
op = "fbm"
wavelength = 800.0 # metres
octaves = 5

[nodes.damp]
op = "perlin"

[nodes.land]
op = "expr"
expr = "hills * relief" # in metres
relief = "= relief"

[nodes.soft]
op = "blur"
source = "land"
radius = 30
mask = "damp"

[outputs]
height = "soft"
moisture = "damp"

[[surface]]
name = "grass"
color = "green"

[[surface]]
name = "mud"
color = "brown"
layers = { damp = { min = 0.2 } }
"#;

fn document() -> Document {
    Document::new("test", TEXT.into()).unwrap()
}

fn node(name: &str) -> Input {
    Input::Node(name.into())
}

/// Applies an edit, and checks that the text changes from `before` to `after`, and only there.
fn check(edit: Edit, before: &str, after: &str) {
    let mut document = document();
    document.apply(&edit).unwrap_or_else(|error| panic!("{edit:?}: {error}"));
    assert_eq!(document.text(), TEXT.replacen(before, after, 1), "{edit:?}");
    assert!(document.is_valid());
    assert!(document.undo());
    assert_eq!(document.text(), TEXT);
}

#[test]
fn values_change_and_comments_stay() {
    let param = |key: &str, value: Value| Edit::Param { node: "hills".into(), key: key.into(), value };
    check(Edit::Seed(12), "seed = 7 ", "seed = 12 ");
    check(Edit::World("cell", 20.0), "cell = 10", "cell = 20.0");
    check(Edit::Size([5000.0, 3000.0]), "size = [4000, 4000]", "size = [5000.0, 3000.0]");
    check(Edit::Default { parameter: "relief".into(), value: 1200.0 }, "relief = 900.0 ", "relief = 1200.0 ");
    check(param("wavelength", Value::Number(500.0)), "wavelength = 800.0 #", "wavelength = 500.0 #");
    check(param("octaves", Value::Integer(3)), "octaves = 5\n", "octaves = 3\n");
    check(param("gain", Value::Number(0.4)), "octaves = 5\n", "octaves = 5\ngain = 0.4\n");
    check(Edit::Reset { node: "hills".into(), key: "octaves".into() }, "octaves = 5\n", "");
    check(Edit::World("sea_level", 5.0), "cell = 10\n", "cell = 10\nsea_level = 5.0\n");
}

#[test]
fn connections_change() {
    let connect = |input: &str, source: Input| Edit::Connect { node: "soft".into(), input: input.into(), source };
    check(connect("source", node("hills")), "source = \"land\"", "source = \"hills\"");
    check(connect("source", Input::Value(3.0)), "source = \"land\"", "source = 3.0");
    check(connect("mask", Input::None), "mask = \"damp\"\n", "");
    let output = |source: Input| Edit::Output { name: "moisture".into(), source };
    check(output(node("land")), "moisture = \"damp\"", "moisture = \"land\"");
    check(output(Input::None), "moisture = \"damp\"\n", "");
}

#[test]
fn a_node_is_renamed_wherever_it_is_named() {
    let mut document = document();
    document.apply(&Edit::Rename { from: "damp".into(), to: "wet".into() }).unwrap();
    let expect = TEXT
        .replace("[nodes.damp]", "[nodes.wet]")
        .replace("mask = \"damp\"", "mask = \"wet\"")
        .replace("moisture = \"damp\"", "moisture = \"wet\"")
        .replace("{ damp = {", "{ wet = {");
    assert_eq!(document.text().replace("{wet =", "{ wet ="), expect);
    // An expression keeps its own name for the node.
    document.apply(&Edit::Rename { from: "hills".into(), to: "base".into() }).unwrap();
    assert!(document.text().contains("# The hills.\n[nodes.base]"), "{}", document.text());
    assert!(document.text().contains("hills = \"base\""), "{}", document.text());
    assert!(document.apply(&Edit::Rename { from: "base".into(), to: "wet".into() }).is_err());
}

#[test]
fn what_reads_a_removed_node_reads_its_source() {
    let mut document = document();
    document.apply(&Edit::Delete(vec!["soft".into()])).unwrap();
    assert!(document.text().contains("height = \"land\"") && !document.text().contains("[nodes.soft]"));
    document.apply(&Edit::Delete(vec!["damp".into(), "hills".into()])).unwrap();
    assert!(document.text().contains("hills = 0.0"), "{}", document.text());
    assert!(!document.text().contains("damp ="), "{}", document.text());
    assert!(document.is_valid());
    assert!(document.undo() && document.undo());
    assert_eq!(document.text(), TEXT);
}

#[test]
fn nodes_are_added_and_copied() {
    let mut document = document();
    let add = |name: &str, op: &str, inputs: &[(&str, &str)]| Edit::Add {
        name: name.into(),
        op: op.into(),
        inputs: inputs.iter().map(|(key, source)| ((*key).into(), (*source).into())).collect(),
        params: Vec::new(),
        readers: Vec::new(),
    };
    document.apply(&add("bent", "warp", &[("source", "hills")])).unwrap();
    document.apply(&add("sum", "expr", &[("a", "bent")])).unwrap();
    document.apply(&add("alone", "thermal", &[])).unwrap();
    assert!(document.apply(&add("sum", "add", &[])).is_err());
    document.apply(&Edit::Duplicate(vec!["bent".into(), "sum".into()])).unwrap();
    let recipe = document.recipe();
    let names: Vec<&str> = recipe.nodes().iter().map(|named| named.name.as_str()).collect();
    for name in ["bent", "sum", "alone", "bent2", "sum2"] {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
    let sum = recipe.nodes().iter().find(|named| named.name == "sum2").unwrap();
    assert_eq!(*sum.node.input(0), node("bent2"));
    assert!(document.text().starts_with("# A land.") && document.text().contains("# The hills."));
}

#[test]
fn a_line_is_drawn_and_moved() {
    let mut document = document();
    let points = |points: &[[f64; 2]]| drawing::value(points);
    let add = |points: Value| Edit::Add {
        name: "road".into(),
        op: "path".into(),
        inputs: Vec::new(),
        params: vec![("points".into(), points)],
        readers: Vec::new(),
    };
    assert!(document.apply(&add(points(&[[0.0, 0.0]]))).is_err(), "a line has two points");
    document.apply(&add(points(&[[100.0, 200.0], [900.0, 350.5]]))).unwrap();
    assert!(document.text().contains("points = [[100.0, 200.0], [900.0, 350.5]]"), "{}", document.text());
    let road = |document: &Document| {
        let named = document.recipe().nodes().iter().find(|named| named.name == "road").unwrap().clone();
        drawing::points_of(&named.node).unwrap()
    };
    assert_eq!(road(&document), [[100.0, 200.0], [900.0, 350.5]]);
    let moved = points(&[[100.0, 250.0], [900.0, 350.5]]);
    document.apply(&Edit::Param { node: "road".into(), key: "points".into(), value: moved }).unwrap();
    assert_eq!(road(&document)[0], [100.0, 250.0]);
}

#[test]
fn an_edit_that_leads_to_no_valid_recipe_changes_nothing() {
    let mut document = document();
    for edit in [
        Edit::Connect { node: "land".into(), input: "hills".into(), source: node("soft") },
        Edit::Connect { node: "soft".into(), input: "source".into(), source: Input::None },
        Edit::Param { node: "hills".into(), key: "octaves".into(), value: Value::Integer(99) },
        Edit::Param { node: "none".into(), key: "octaves".into(), value: Value::Integer(9) },
        Edit::Default { parameter: "none".into(), value: 1.0 },
        Edit::Seed(u64::MAX),
    ] {
        assert!(document.apply(&edit).is_err(), "{edit:?}");
        assert_eq!(document.text(), TEXT);
    }
    assert!(!document.undo());
}

#[test]
fn a_broken_text_keeps_the_last_recipe() {
    let mut document = document();
    let before = document.recipe().clone();
    document.type_text(TEXT.replace("op = \"fbm\"", "op = \"fbn\""));
    assert!(!document.is_valid() && *document.recipe() == before);
    let place = document.diagnostics()[0].place.as_ref().unwrap();
    assert_eq!(place.line, 14);
    assert!(document.apply(&Edit::Seed(1)).is_err());
    document.type_text(TEXT.to_owned());
    assert!(document.is_valid());
}

/// Every parameter of every node of every preset can be set to its own value without changing the recipe.
#[test]
fn presets_survive_edits_of_all_their_parameters() {
    for preset in presets::all() {
        let mut document = Document::of_preset(preset).unwrap();
        let before = document.recipe().clone();
        for named in before.nodes() {
            for (i, param) in named.node.spec().params.iter().enumerate() {
                let edit = Edit::Param { node: named.name.clone(), key: param.name.into(), value: named.node.param(i) };
                document.apply(&edit).unwrap_or_else(|error| panic!("{}: {edit:?}: {error}", preset.name));
            }
        }
        let nodes = |recipe: &orogen::Recipe| format!("{:?}", recipe.nodes());
        assert_eq!(nodes(document.recipe()), nodes(&before), "{}", preset.name);
        for named in before.nodes() {
            let to = format!("{}_b", named.name);
            document
                .apply(&Edit::Rename { from: named.name.clone(), to })
                .unwrap_or_else(|error| panic!("{}: {}: {error}", preset.name, named.name));
        }
        let keys = |recipe: orogen::Recipe| {
            let session = orogen::Session::new(orogen::Options { threads: Some(1), ..Default::default() }).unwrap();
            session.open(recipe).unwrap().key("height").unwrap()
        };
        assert_eq!(keys(document.recipe().clone()), keys(before), "{}", preset.name);
    }
}
