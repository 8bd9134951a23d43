use super::document::{InWater, Turn};
use super::expand::expand;
use crate::recipe::document::Recipe;
use crate::recipe::graph::Graph;
use orogen_ops::declare::Input;

fn recipe(scatter: &str) -> String {
    format!(
        "orogen = 1\n[parameters]\nshare = 0.4\n[world]\nseed = 5\ncell = 20\n[nodes.hills]\nop = \"fbm\"\n[nodes.land]\nop = \"remap\"\n\
         source = \"hills\"\nto = [0, 900]\n[outputs]\nheight = \"land\"\n{scatter}"
    )
}

const SCATTER: &str = r#"
[[scatter]]
name = "house"
spacing = 60
turn = 90
water = "any"
density = "= share / 2"
[[scatter]]
name = "tree"
spacing = 5.5
density = "hills"
size = [0.8, 1.3]
clearance = 12
cell = 4
seed = 33
slope = { max = 30, fade = 5 }
any = [{ height = [100, 700] }, { layers = { hills = { min = 0.2 } } }]
mask = "hills"
"#;

#[test]
fn a_mask_that_is_the_only_condition_names_a_node() {
    let alone = "[[scatter]]\nname = \"tree\"\nspacing = 5\nmask = \"zz\"\n";
    let error = Recipe::parse(&recipe(alone), "test").unwrap_err();
    let place = error.diagnostics()[0].place.as_ref().unwrap();
    assert_eq!((place.text.as_str(), place.column), ("mask = \"zz\"", 8), "{error}");
    assert!(error.to_string().contains("scatter `tree`: unknown node `zz`"), "{error}");
    Recipe::parse(&recipe(&alone.replace("zz", "hills")), "test").unwrap();
}

#[test]
fn scatter_reads_back_as_it_was_written() {
    let first = Recipe::parse(&recipe(SCATTER), "test").unwrap();
    let again = Recipe::parse(&first.to_toml(), "again").unwrap();
    assert_eq!(first, again);
    assert!(first.to_toml().contains("share / 2\""), "{}", first.to_toml());
    let [house, tree] = first.scatter() else { panic!("two entries") };
    assert_eq!((house.density.clone(), house.turn, house.water), (Input::Value(0.2), Turn::Fixed(90.0), InWater::Any));
    assert_eq!((house.clearance, house.seed, house.cell, house.size), (60.0, 0, None, [1.0; 2]));
    assert_eq!((tree.turn, tree.water, tree.clearance, tree.cell), (Turn::Random, InWater::Avoid, 12.0, Some(4.0)));
    assert_eq!((tree.all.len(), tree.any.len(), tree.seed), (1, 2, 33));
    // The nodes that compute densities are not listed.
    let mut expanded = first.clone();
    expand(&mut expanded);
    Graph::resolve(&expanded).unwrap();
    assert_eq!(expanded.to_toml(), first.to_toml());
    let count = expanded.nodes().len();
    assert!(count > first.nodes().len() + 4);
    expand(&mut expanded);
    assert_eq!(expanded.nodes().len(), count, "once is enough");
}

#[test]
fn faults_stand_at_their_keys() {
    for (from, to, column, expect) in [
        ("spacing = 5.5\n", "", "[[scatter]]", "needs a `spacing`"),
        ("spacing = 5.5", "spacing = 0", "0", "`spacing` must be a number from 0.01"),
        ("name = \"tree\"", "name = \"t r\"", "\"t r\"", "`name` must be 1 to 64 letters"),
        ("name = \"tree\"\n", "", "[[scatter]]", "needs a `name`, such as \"tree\""),
        ("density = \"hills\"", "density = 1.5", "1.5", "`density` must be a number from 0 to 1"),
        (
            "density = \"hills\"",
            "density = \"hils\"",
            "\"hils\"",
            "scatter `tree`: unknown node `hils`; did you mean `hills`?",
        ),
        ("density = \"hills\"", "densty = 1", "densty", "did you mean `density`?"),
        ("[0.8, 1.3]", "[1.8, 1.3]", "[1.8", "the first number of `size` must not be greater"),
        ("[0.8, 1.3]", "[1.3]", "[1.3]", "[SMALLEST, LARGEST]"),
        ("turn = 90", "turn = 360", "360", "`turn` must be \"random\" or"),
        ("turn = 90", "turn = \"north\"", "\"north\"", "`turn` must be \"random\" or"),
        ("water = \"any\"", "water = \"yes\"", "\"yes\"", "\"avoid\", \"any\" or \"only\""),
        ("seed = 33", "flow = [1, 2]", "[1, 2]", "`flow` needs a bounded world"),
        ("min = 0.2", "", "{", "needs a `min` or a `max`"),
    ] {
        assert!(SCATTER.contains(from), "{from}");
        let text = recipe(&SCATTER.replacen(from, to, 1));
        let error = Recipe::parse(&text, "test").unwrap_err();
        let diagnostic = error.diagnostics().iter().find(|diagnostic| diagnostic.message.contains(expect));
        let diagnostic = diagnostic.unwrap_or_else(|| panic!("{expect}: {error}"));
        let place = diagnostic.place.as_ref().unwrap();
        let from: String = place.text.chars().skip(place.column - 1).collect();
        assert!(from.starts_with(column), "{from} / {column}: {error}");
    }
    let error = Recipe::parse(&recipe("").replacen('\n', "\nscatter = 3\n", 1), "test").unwrap_err();
    assert!(error.to_string().contains("`scatter` must be a list of tables"), "{error}");
}

#[test]
fn all_values_of_repeated_keys_are_checked() {
    let text = r#"{ "orogen": 1, "parameters": { "p": { "default": 1, "unit": "m", "unit": 5 } }, "world": { "cell": 1, "cell": -1 },
        "nodes": { "a": { "op": "fbm", "gain": 0.5, "gain": 7, "op": 5 } }, "outputs": { "height": "a", "height": true },
        "scatter": [{ "name": "tree", "spacing": 2, "spacing": 0 }], "scatter": 3,
        "use": { "b": { "recipe": "hills", "seed": 1, "seed": -1, "recipe": 4 } } }"#;
    let error = Recipe::parse(text, "test").unwrap_err().to_string();
    for key in ["unit", "cell", "gain", "op", "height", "spacing", "scatter", "seed", "recipe"] {
        assert!(error.contains(&format!("the key `{key}` appears twice")), "{key}: {error}");
        assert!(error.contains(&format!("`{key}` must")), "{key}: {error}");
    }
}
