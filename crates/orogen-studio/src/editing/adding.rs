//! New nodes: what they read, what reads them, and parameters that suit the land.

use orogen::declare::{Input, Spec};
use orogen::grid::contour::round_interval;
use orogen::layer::Interpolation;
use orogen::node::Node;
use orogen::recipe::Recipe;
use orogen::value::Value;
use orogen::world::HEIGHT;

use super::edit::Edit;
use super::reader::{Reader, read_by};
use super::{drawing, names};

/// Maximum number of steps within the relief of a land.
const LEVELS: usize = 20;

/// The op that evaluates a node once for the whole world.
const BAKE: &str = "bake";

/// Where a new node goes.
#[derive(Debug, Clone, Copy)]
pub enum After<'a> {
    /// Nowhere: it reads nothing.
    Nothing,
    /// After a node.
    Node(&'a str),
    /// Into the wire to a reader.
    Wire(&'a Reader),
}

/// The edit that adds a node. A node that goes into a wire reads what the reader read, and the reader reads the node.
/// After a node that nothing but outputs reads, a node that changes its heights is read by these outputs: what is added
/// at the end is seen. `range` is the range of the land's heights in metres.
#[must_use]
pub fn edit(recipe: &Recipe, name: String, op: &str, after: After, range: Option<[f64; 2]>) -> Edit {
    let spec = Node::named(op).map(|node| node.spec());
    let key = spec.and_then(|spec| spec.inputs.first().map(|input| input.name).or(spec.named_inputs.then_some("a")));
    let source = match after {
        After::Nothing => None,
        After::Node(node) => Some(node.to_owned()),
        After::Wire(reader) => read_by(recipe, reader),
    };
    let Some((source, key)) = source.zip(key) else {
        let readers = first_land(recipe, spec.is_some_and(makes_heights));
        return Edit::Add { name, op: op.to_owned(), inputs: Vec::new(), params: Vec::new(), readers };
    };
    let ends = ends_at(recipe, source.split('.').next().unwrap_or(&source));
    let is_land = spec.is_some_and(changes_heights);
    let readers = match after {
        After::Wire(reader) => vec![reader.clone()],
        _ if is_land => ends.iter().cloned().map(Reader::Output).collect(),
        _ => Vec::new(),
    };
    let is_of_land = !ends.is_empty() || readers.iter().any(|reader| matches!(reader, Reader::Output(_)));
    let params = range.filter(|_| is_of_land).map(|range| suiting(op, range)).unwrap_or_default();
    let params = params.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    Edit::Add { name, op: op.to_owned(), inputs: vec![(key.to_owned(), source)], params, readers }
}

/// The edit that bakes a node: a node of the op `bake` is between it and all that reads it. `None` if the world has no
/// sides, or the node is one.
#[must_use]
pub fn baked(recipe: &Recipe, name: &str) -> Option<Edit> {
    let named = recipe.nodes().iter().find(|named| named.name == name)?;
    if recipe.world.size.is_none() || named.node.spec().op == BAKE {
        return None;
    }
    let is_it = |input: &Input| matches!(input, Input::Node(read) if read == name);
    let mut readers = Vec::new();
    for other in recipe.nodes() {
        let inputs = other.node.inputs();
        let keys = inputs.iter().enumerate().filter(|(i, _)| is_it(other.node.input(*i)));
        let mask = is_it(&other.mask).then_some("mask");
        let keys = keys.map(|(_, input)| input.name).chain(mask);
        readers.extend(keys.map(|key| Reader::Input { node: other.name.clone(), key: key.to_string() }));
    }
    let outputs = recipe.output_inputs().iter().filter(|(_, input)| is_it(input));
    readers.extend(outputs.map(|(output, _)| Reader::Output(output.clone())));
    let taken = recipe.nodes().iter().map(|named| named.name.as_str()).collect();
    Some(Edit::Add {
        name: names::free(&format!("{name}_baked"), &taken),
        op: BAKE.to_owned(),
        inputs: vec![("source".to_owned(), name.to_owned())],
        params: Vec::new(),
        readers,
    })
}

/// The output of heights, if it is a number, as in an empty recipe: the first node is the land.
fn first_land(recipe: &Recipe, is_land: bool) -> Vec<Reader> {
    let outputs = recipe.output_inputs().iter().filter(|(name, _)| is_land && name == HEIGHT);
    outputs
        .filter(|(_, input)| matches!(input, Input::Value(_)))
        .map(|(name, _)| Reader::Output(name.clone()))
        .collect()
}

/// The outputs that read a node, if no node does.
fn ends_at(recipe: &Recipe, name: &str) -> Vec<String> {
    let is_it = |input: &Input| matches!(input, Input::Node(read) if read.split('.').next() == Some(name));
    let is_read = recipe
        .nodes()
        .iter()
        .any(|named| is_it(&named.mask) || (0..named.node.inputs().len()).any(|i| is_it(named.node.input(i))));
    let outputs = recipe.output_inputs().iter().filter(|(_, input)| !is_read && is_it(input));
    outputs.map(|(output, _)| output.clone()).collect()
}

/// Whether an op makes heights. Masks and measurements, such as slopes, are not land.
fn makes_heights(spec: &Spec) -> bool {
    let is_mask = spec.op.starts_with("select-") || matches!(spec.op, "paint" | "image");
    let is_land = spec.layers.first().is_some_and(|layer| {
        matches!(layer.name, "height" | "filled") || layer.interpolation == Interpolation::AsSource
    });
    is_land && !is_mask && !matches!(spec.op, "height-above-drainage" | "label")
}

/// Whether an op makes heights from heights, such as an erosion.
fn changes_heights(spec: &Spec) -> bool {
    makes_heights(spec) || spec.op == "paint"
}

/// Parameters of an op for land in a range of heights: their defaults are for values of about 1, or for mountains.
fn suiting(op: &str, [low, high]: [f64; 2]) -> Vec<(&'static str, Value)> {
    let relief = high - low;
    if !(relief.is_finite() && relief > 0.0) {
        return Vec::new();
    }
    let step = round_interval(relief, LEVELS);
    // Round numbers around the range.
    let [low, high] = [(low / step).floor() * step, (high / step).ceil() * step];
    let pair = |a: f64, b: f64| drawing::numbers(&[a, b]);
    match op {
        "terrace" => vec![("step", Value::Number(step))],
        "clamp" => vec![("low", Value::Number(low)), ("high", Value::Number(high))],
        "select-height" => {
            let middle = ((low + high) / 2.0 / step).round() * step;
            vec![("range", pair(middle, high)), ("falloff", pair(step, step))]
        }
        "remap" => vec![("from", pair(low, high)), ("to", pair(low, high))],
        "curve" => vec![("points", drawing::value(&[[low, low], [high, high]]))],
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editing::document::Document;

    const TEXT: &str = "orogen = 1\n[world]\nsize = 1000\n[nodes.hills]\nop = \"fbm\"\n[nodes.soft]\nop = \"blur\"\nsource = \"hills\"\n\
        [outputs]\nheight = \"soft\"\nmoisture = \"soft\"\nbase = \"hills\"\n";

    fn text_after(op: &str, selected: Option<&str>, range: Option<[f64; 2]>) -> String {
        text_with(op, selected.map_or(After::Nothing, After::Node), range)
    }

    fn text_with(op: &str, after: After, range: Option<[f64; 2]>) -> String {
        let mut document = Document::new("test", TEXT.into()).unwrap();
        let edit = edit(document.recipe(), "new".into(), op, after, range);
        document.apply(&edit).unwrap();
        let text = document.text().to_owned();
        assert!(document.undo() && document.text() == TEXT, "one step of undo");
        text
    }

    #[test]
    fn what_is_added_at_the_end_is_the_terrain() {
        let range = Some([-12.0, 1890.0]);
        let text = text_after("terrace", Some("soft"), range);
        assert!(text.contains("source = \"soft\"\nstep = 100.0"), "{text}");
        assert!(text.contains("height = \"new\"\nmoisture = \"new\"\nbase = \"hills\""), "{text}");
        // In the middle it is a branch; masks and measurements are not land.
        for (op, selected) in
            [("terrace", "hills"), ("slope", "soft"), ("select-height", "soft"), ("hillshade", "soft")]
        {
            let text = text_after(op, Some(selected), range);
            assert!(text.contains("height = \"soft\"\nmoisture = \"soft\"\nbase = \"hills\""), "{text}");
        }
        for op in ["pipes", "thermal", "stream-power", "curve", "clamp", "add", "expr", "blur", "fill", "paint", "mix"]
        {
            let text = text_after(op, Some("soft"), range);
            assert!(text.contains("height = \"new\""), "{op}: {text}");
        }
        assert!(!text_after("perlin", Some("soft"), range).contains("\"new\""));
        assert!(!text_after("terrace", None, None).contains("\"new\""));
    }

    #[test]
    fn the_first_land_of_an_empty_recipe_is_its_terrain() {
        let mut document = Document::empty("empty").unwrap();
        assert!(document.is_valid() && !document.is_changed());
        let add =
            |document: &Document, name: &str, op: &str| edit(document.recipe(), name.into(), op, After::Nothing, None);
        document.apply(&add(&document, "spots", "paint")).unwrap();
        assert!(document.text().contains("height = 0\n"), "a mask is no land: {}", document.text());
        document.apply(&add(&document, "hills", "fbm")).unwrap();
        assert!(document.text().contains("height = \"hills\"\n"), "{}", document.text());
        document.apply(&add(&document, "more", "perlin")).unwrap();
        assert!(document.text().contains("height = \"hills\"\n"), "{}", document.text());
    }

    #[test]
    fn a_node_goes_into_a_wire() {
        let input = Reader::Input { node: "soft".into(), key: "source".into() };
        let text = text_with("warp", After::Wire(&input), None);
        assert!(text.contains("[nodes.new]\nop = \"warp\"\nsource = \"hills\""), "{text}");
        assert!(text.contains("op = \"blur\"\nsource = \"new\"") && text.contains("base = \"hills\""), "{text}");
        let text = text_with("terrace", After::Wire(&Reader::Output("height".into())), Some([0.0, 500.0]));
        assert!(text.contains("source = \"soft\"\nstep = 50.0"), "{text}");
        assert!(text.contains("height = \"new\"\nmoisture = \"soft\""), "{text}");
        // A wire that is gone.
        let gone = Reader::Input { node: "none".into(), key: "source".into() };
        assert!(text_with("blur", After::Wire(&gone), None).contains("source = 0"));
    }

    #[test]
    fn a_baked_node_is_read_by_what_read_it() {
        let mut document = Document::new("test", TEXT.into()).unwrap();
        document.apply(&baked(document.recipe(), "hills").unwrap()).unwrap();
        let text = document.text();
        assert!(text.contains("[nodes.hills_baked]\nop = \"bake\"\nsource = \"hills\""), "{text}");
        assert!(text.contains("source = \"hills_baked\"") && text.contains("base = \"hills_baked\""), "{text}");
        assert_eq!(baked(document.recipe(), "hills_baked"), None);
        let endless = Document::new("test", TEXT.replace("size = 1000\n", "")).unwrap();
        assert_eq!(baked(endless.recipe(), "hills"), None);
    }

    #[test]
    fn parameters_suit_the_land() {
        let range = Some([-12.0, 1890.0]);
        for (op, expect) in [
            ("clamp", "low = -100.0\nhigh = 1900.0"),
            ("select-height", "range = [900.0, 1900.0]\nfalloff = [100.0, 100.0]"),
            ("remap", "from = [-100.0, 1900.0]\nto = [-100.0, 1900.0]"),
            ("curve", "points = [[-100.0, -100.0], [1900.0, 1900.0]]"),
        ] {
            let text = text_after(op, Some("soft"), range);
            assert!(text.contains(expect), "{text}");
        }
        // Without a picture, or with level land, they have their defaults.
        for range in [None, Some([3.0, 3.0]), Some([f64::INFINITY, f64::NEG_INFINITY])] {
            assert!(!text_after("terrace", Some("soft"), range).contains("step"));
        }
    }
}
