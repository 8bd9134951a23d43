use super::document::End;
use super::expand::{expand, expand_at};
use crate::recipe::document::Recipe;
use crate::recipe::graph::Graph;
use crate::world::World;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_ops::declare::Input;

fn recipe(classes: &str) -> String {
    format!(
        "orogen = 1\n[parameters]\nwater = 0.4\n[world]\nseed = 5\nsize = [640, 480]\ncell = 10\n[nodes.hills]\nop = \"fbm\"\nwavelength = 200\n[nodes.land]\n\
         op = \"remap\"\nsource = \"hills\"\nto = [-300, 900]\n[outputs]\nheight = \"land\"\n{classes}"
    )
}

const CLASSES: &str = r##"
[[class]]
name = "grass"
color = "#4d5a2a"
[[class]]
name = "rock"
height = { min = 300, fade = 40 }
[[class]]
name = "wood"
any = [{ slope = [0, 30] }, { layers = { hills = { min = 0.2 } } }]
mask = 0.9
share = { of = "hills", highest = 0.125 }
[[class]]
name = "water"
share = { of = "height", lowest = "= water" }
"##;

#[test]
fn classes_read_back_as_they_were_written() {
    let first = Recipe::parse(&recipe(CLASSES), "test").unwrap();
    let again = Recipe::parse(&first.to_toml(), "again").unwrap();
    assert_eq!(first, again);
    assert!(first.to_toml().contains("lowest = \"= water\""), "{}", first.to_toml());
    let [grass, rock, wood, water] = first.classes() else { panic!("four classes") };
    assert_eq!((grass.color(0), rock.color(1)), ([0x4d, 0x5a, 0x2a], [0x86, 0x80, 0x7a]));
    assert_eq!((rock.all.len(), wood.any.len(), wood.mask.clone()), (1, 2, Input::Value(0.9)));
    let share = wood.share.as_ref().unwrap();
    assert_eq!((share.of.as_str(), share.end, share.part), ("hills", End::Highest, 0.125));
    assert_eq!(water.share.as_ref().unwrap().part, 0.4);
    // Neither the nodes that compute them nor their output are listed.
    let mut expanded = first.clone();
    expand(&mut expanded).unwrap();
    Graph::resolve(&expanded).unwrap();
    assert_eq!(expanded.to_toml(), first.to_toml());
    assert!(expanded.outputs().any(|name| name == "class"));
    let count = expanded.nodes().len();
    expand_at(&mut expanded, 20.0, &[3, 2, 1, 0]).unwrap();
    assert_eq!(expanded.nodes().len(), count, "once is enough");
}

/// The codes of all cells of a map.
fn codes(recipe: Recipe, cell: f64) -> Vec<f32> {
    let world = World::open(recipe).unwrap();
    let window = world.full_window(cell).unwrap();
    world.grids(&["class"], &window, &Progress::none()).unwrap().remove(0).data().to_vec()
}

#[test]
fn shares_are_exact_and_classes_cover_those_before() {
    for (cell, seed) in [(10.0, 5), (10.0, 6), (20.0, 5), (4.0, 9)] {
        for water in [0.0, 0.123, 0.4, 1.0] {
            let mut recipe = Recipe::parse_with(&recipe(CLASSES), "test", &[("water".into(), water)]).unwrap();
            recipe.world.seed = seed;
            expand_at(&mut recipe, cell, &[10, 20, 30, 40]).unwrap();
            let codes = codes(recipe, cell);
            let count = |code: f32| codes.iter().filter(|other| **other == code).count();
            assert_eq!(count(40.0), (water * codes.len() as f64).round() as usize, "{cell} m, seed {seed}");
            assert_eq!(count(10.0) + count(20.0) + count(30.0) + count(40.0), codes.len());
            if water < 0.2 {
                assert!(count(10.0) > 0 && count(20.0) > 0 && count(30.0) > 0);
            }
        }
    }
}

#[test]
fn a_part_of_the_classes_is_that_of_the_whole() {
    let recipe = Recipe::parse(&recipe(CLASSES), "test").unwrap();
    let whole = codes(recipe.clone(), 10.0);
    let part = Window::new(20, 15, 10.0).at(31, 17);
    let part = World::open(recipe).unwrap().grids(&["class"], &part, &Progress::none()).unwrap().remove(0);
    for (j, row) in part.data().chunks(20).enumerate() {
        assert_eq!(row, &whole[(j + 17) * 64 + 31..][..20]);
    }
}

#[test]
fn faults_stand_at_their_keys() {
    for (from, to, column, expect) in [
        ("color = \"#4d5a2a\"", "height = [0, 5]", "height", "the first class is everywhere and cannot have `height`"),
        ("color = \"#4d5a2a\"", "share = {}", "share", "the first class is everywhere and cannot have `share`"),
        ("color = \"#4d5a2a\"", "color = 3", "3", "a color must be \"#rrggbb\" or a name"),
        ("name = \"wood\"", "name = \"rock\"", "[[class]]", "there are two classes `rock`"),
        ("name = \"wood\"\n", "", "[[class]]", "a class needs a `name`, such as \"water\""),
        ("fade = 40", "max = 200", "{ min = 300", "the lower bound of `height` must not be greater"),
        ("height = {", "hight = {", "hight", "did you mean `height`?"),
        ("highest = 0.125", "highest = 1.125", "1.125", "`highest` must be a number from 0 to 1"),
        ("highest = 0.125", "highst = 0.125", "highst", "unknown key `highst` in `share`; did you mean `highest`?"),
        ("highest = 0.125", "highest = 0.125, lowest = 0.5", "{ of", "needs either `lowest` or `highest`"),
        (", highest = 0.125", "", "{ of", "needs either `lowest` or `highest`"),
        ("of = \"hills\", highest", "highest", "{ highest", "`share` needs `of`, what cells are ordered by"),
        ("of = \"hills\"", "of = 3", "3", "`of` must be \"height\" or name a node or a layer"),
        ("of = \"hills\"", "of = \"hils\"", "\"hils\"", "class `wood`: unknown node `hils`; did you mean `hills`?"),
        ("of = \"hills\"", "of = \"zz\"", "\"zz\"", "class `wood`: unknown node `zz`; available: `hills` and `land`"),
        ("share = { of = \"hills\", highest = 0.125 }", "share = 0.125", "0.125", "`share` must be a table such as"),
    ] {
        assert!(CLASSES.contains(from), "{from}");
        let error = Recipe::parse(&recipe(&CLASSES.replacen(from, to, 1)), "test").unwrap_err();
        let diagnostic = error.diagnostics().iter().find(|diagnostic| diagnostic.message.contains(expect));
        let diagnostic = diagnostic.unwrap_or_else(|| panic!("{expect}: {error}"));
        let place = diagnostic.place.as_ref().unwrap();
        let from: String = place.text.chars().skip(place.column - 1).collect();
        assert!(from.starts_with(column), "{from} / {column}: {error}");
    }
}

#[test]
fn a_class_may_have_many_conditions() {
    let nodes: String = (0..100).map(|k| format!("[nodes.n{k}]\nop = \"constant\"\nvalue = {k}\n")).collect();
    let layers: Vec<String> = (0..100).map(|k| format!("n{k} = {{ min = {k} }}")).collect();
    let classes =
        format!("{nodes}[[class]]\nname = \"a\"\n[[class]]\nname = \"b\"\nlayers = {{ {} }}\n", layers.join(", "));
    let mut recipe = Recipe::parse(&recipe(&classes), "test").unwrap();
    expand_at(&mut recipe, 10.0, &[1, 2]).unwrap();
    assert!(codes(recipe, 10.0).iter().all(|code| *code == 2.0), "all conditions hold");
}

#[test]
fn recipes_that_cannot_have_classes_are_told_why() {
    let error = |text: String| Recipe::parse(&text, "test").unwrap_err().to_string();
    let unbounded = error(recipe(CLASSES).replace("size = [640, 480]\n", ""));
    assert!(unbounded.contains("`share` needs a bounded world; set `size` in `world`"), "{unbounded}");
    let both = error(recipe(CLASSES).replace("height = \"land\"\n", "height = \"land\"\nclass = \"land\"\n"));
    assert!(both.contains("tables `[[class]]` and an output `class`; remove one of them"), "{both}");
    let none = error(recipe(CLASSES).replace("height = \"land\"\n", "other = \"land\"\n"));
    assert!(none.contains("`[[class]]` needs an output `height`"), "{none}");
    let list = |value: &str| error(recipe("").replacen('\n', &format!("\nclass = {value}\n"), 1));
    assert!(list("3").contains("`class` must be a list of tables"), "{}", list("3"));
    assert!(list("[]").contains("`class` needs at least one entry"), "{}", list("[]"));
    let many: String = (0..256).map(|k| format!("[[class]]\nname = \"c{k}\"\n")).collect();
    assert!(error(recipe(&many)).contains("there are 256 tables `[[class]]`; a recipe has at most 255"));
    // The same for classes that are added in code.
    let mut whole = Recipe::parse(&recipe(CLASSES), "test").unwrap();
    whole.output("class", "land");
    assert!(World::open(whole).is_err_and(|error| error.to_string().contains("remove one of them")));
}
