//! Recipes that use other recipes.

use orogen::io::test_folder::TestFolder;
use orogen::{Recipe, Window, World};
use std::fs;

/// A temporary folder.
struct Folder(TestFolder);

impl Folder {
    fn new(name: &str) -> Folder {
        let folder = TestFolder::new(&format!("uses-{name}")).unwrap();
        fs::create_dir(folder.join("parts")).unwrap();
        Folder(folder)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    fn read(&self, name: &str) -> Result<Recipe, String> {
        Recipe::read(&self.0.join(name)).map_err(|error| error.to_string())
    }
}

/// A part of a recipe: hills on a given base, with two outputs.
const HILLS: &str = r#"
orogen = 1
[parameters]
relief = { default = 100, range = [0, 1000] }
width = 400
[world]
size = 1000
[nodes.flat]
op = "constant"
value = 5
[nodes.base]
op = "input"
source = "flat"
[nodes.noise]
op = "fbm"
seed = 3
wavelength = "= width / 2"
[nodes.land]
op = "expr"
expr = "base + noise * relief"
[outputs]
rough = "noise"
height = "land"
"#;

const WHOLE: &str = r#"
orogen = 1
[parameters]
scale = 2
[world]
seed = 9
size = 1000
[use.hills]
recipe = "parts/hills.toml"
inputs = { base = "plain" }
parameters = { relief = "= scale * 50", width = 800 }
[use.other]
recipe = "parts/hills.toml"
seed = 4
[nodes.plain]
op = "ramp"
length = 1000
[nodes.all]
op = "expr"
expr = "hills * 0.5 + other.rough + hills.rough"
mask = "other.rough"
[outputs]
height = "all"
hills = "hills"
rough = "hills.rough"
"#;

/// The same world with all nodes in one recipe.
const BY_HAND: &str = r#"
orogen = 1
[world]
seed = 9
size = 1000
[nodes.plain]
op = "ramp"
length = 1000
[nodes.noise]
op = "fbm"
seed = 3
wavelength = 400
[nodes.scaled]
op = "multiply"
a = "noise"
b = 100
[nodes.hills]
op = "add"
a = "plain"
b = "scaled"
[outputs]
hills = "hills"
rough = "noise"
"#;

fn bits(world: &World, layer: &str) -> Vec<u32> {
    let window = Window::new(60, 50, 10.0).at(3, 4);
    world.window(layer, &window).unwrap().data().iter().map(|sample| sample.to_bits()).collect()
}

#[test]
fn a_used_recipe_makes_what_its_nodes_make() {
    let folder = Folder::new("same");
    folder.write("parts/hills.toml", HILLS);
    folder.write("whole.toml", WHOLE);
    let recipe = folder.read("whole.toml").unwrap_or_else(|error| panic!("{error}"));
    assert!(recipe.files().iter().any(|file| file.ends_with("parts/hills.toml")), "{:?}", recipe.files());
    let names: Vec<&str> = recipe.nodes().iter().map(|named| named.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "plain",
            "all",
            "hills/flat",
            "hills/base",
            "hills/noise",
            "hills/land",
            "other/flat",
            "other/base",
            "other/noise",
            "other/land"
        ]
    );
    let (world, by_hand) =
        (World::open(recipe.clone()).unwrap(), World::open(Recipe::parse(BY_HAND, "b").unwrap()).unwrap());
    for layer in ["hills", "rough"] {
        assert_eq!(bits(&world, layer), bits(&by_hand, layer), "{layer}");
    }
    // Another seed gives different noise.
    let other = folder.read("parts/hills.toml").unwrap();
    assert_ne!(recipe.nodes()[8].node, other.nodes()[2].node);
    // A recipe that is written back needs no other file, and its parameters still apply to the parts.
    let written = recipe.to_toml();
    assert!(written.contains("relief = \"= (scale * 50)\"") && written.contains("[nodes.\"hills/land\"]"), "{written}");
    let again = Recipe::parse(&written, "again").unwrap_or_else(|error| panic!("{error}\n{written}"));
    assert_eq!(again, recipe);
    let set = [("scale".to_string(), 3.0)];
    let one = Recipe::parse_with(&written, "again", &set).unwrap();
    let other = Recipe::read_with(&folder.0.join("whole.toml"), &set).unwrap();
    assert_eq!(one, other);
    assert_ne!(one, recipe);
}

#[test]
fn by_itself_an_input_is_its_source() {
    let world = World::open(Recipe::parse(HILLS, "hills").unwrap()).unwrap();
    let without = HILLS.replace("op = \"input\"\nsource = \"flat\"", "op = \"constant\"\nvalue = 5");
    assert_ne!(without, HILLS);
    assert_eq!(
        bits(&world, "height"),
        bits(&World::open(Recipe::parse(&without, "hills").unwrap()).unwrap(), "height")
    );
}

#[test]
fn presets_by_name_and_recipes_in_recipes() {
    let folder = Folder::new("nested");
    folder.write("parts/hills.toml", HILLS);
    // A path is relative to the folder of the recipe that names it.
    folder.write(
        "parts/middle.toml",
        "orogen = 1\n[use.inner]\nrecipe = \"hills.toml\"\n[world]\nsize = 1000\n[outputs]\nheight = \"inner\"\n",
    );
    folder.write(
        "top.toml",
        "orogen = 1\n[world]\nsize = 1000\n[use.middle]\nrecipe = \"parts/middle.toml\"\n[use.rolling]\nrecipe = \"hills\"\n\
         [nodes.sum]\nop = \"add\"\na = \"middle\"\nb = \"rolling.height\"\n[outputs]\nheight = \"sum\"\ninner = \"middle/inner/noise\"\n",
    );
    let recipe = folder.read("top.toml").unwrap_or_else(|error| panic!("{error}"));
    assert!(recipe.nodes().iter().any(|named| named.name == "middle/inner/land"));
    assert_eq!(recipe.files().len(), 2, "{:?}", recipe.files());
    assert_eq!(Recipe::parse(&recipe.to_toml(), "again").unwrap(), recipe);
    World::open(recipe).unwrap().window("height", &Window::new(8, 8, 50.0)).unwrap();
}

#[test]
fn what_is_wrong_with_a_use() {
    let folder = Folder::new("wrong");
    folder.write("parts/hills.toml", HILLS);
    folder.write("parts/broken.toml", "orogen = 1\n[nodes.a]\nop = \"fbn\"\n[outputs]\nheight = \"a\"\n");
    folder.write(
        "parts/solver.toml",
        "orogen = 1\n[world]\nsize = 100\n[nodes.a]\nop = \"normalise\"\nsource = 0.5\n[outputs]\nheight = \"a\"\n",
    );
    folder.write("self.toml", "orogen = 1\n[use.me]\nrecipe = \"./parts/../self.toml\"\n[outputs]\nheight = \"me\"\n");
    folder.write("one.toml", "orogen = 1\n[use.two]\nrecipe = \"two.toml\"\n[outputs]\nheight = \"two\"\n");
    folder.write("two.toml", "orogen = 1\n[use.one]\nrecipe = \"one.toml\"\n[outputs]\nheight = \"one\"\n");
    let hills = "recipe = \"parts/hills.toml\"";
    for (node, line, column, expect) in [
        ("recipe = \"hils\"", 3, 10, "did you mean `hills`?"),
        ("recipe = \"parts/none.toml\"", 3, 10, "none.toml"),
        ("recipe = \"parts/broken.toml\"", 3, 6, "did you mean `fbm`?"),
        ("recipe = \"parts/solver.toml\"", 2, 6, "this world is unbounded"),
        ("recipe = \"self.toml\"", 3, 10, "in a circle"),
        ("recipe = \"one.toml\"", 3, 10, "in a circle"),
        ("recipe = 3", 3, 10, "`recipe` must be a string"),
        ("seed = 1", 2, 6, "the used recipe `part` needs a `recipe`"),
        (&format!("{hills}\nfile = 1"), 4, 1, "unknown key `file`"),
        (&format!("{hills}\nseed = -1"), 4, 8, "a whole number from 0"),
        (&format!("{hills}\ninputs = {{ land = 1 }}"), 4, 12, "has no input `land`"),
        (&format!("{hills}\ninputs = {{ base = \"nothing\" }}"), 2, 6, "unknown node `nothing`"),
        (&format!("{hills}\ninputs = {{ base = true }}"), 4, 19, "must name a node"),
        (&format!("{hills}\nparameters = {{ relif = 1 }}"), 3, 10, "did you mean `relief`?"),
        (&format!("{hills}\nparameters = {{ relief = 5000 }}"), 3, 10, "from 0 to 1000"),
        (&format!("{hills}\nparameters = {{ relief = \"high\" }}"), 4, 25, "must be a finite number"),
        (&format!("{hills}\n[nodes.part]\nop = \"fbm\""), 2, 6, "already a node"),
    ] {
        folder.write("top.toml", &format!("orogen = 1\n[use.part]\n{node}\n[outputs]\nheight = \"part\"\n"));
        let error = Recipe::read(&folder.0.join("top.toml")).map(|_| ()).unwrap_err();
        let diagnostic = &error.diagnostics()[0];
        assert!(diagnostic.message.contains(expect), "{node}\n{error}");
        let place = diagnostic.place.as_ref().unwrap_or_else(|| panic!("{error}"));
        assert_eq!((place.line, place.column), (line, column), "{node}\n{error}");
    }
    folder.write("top.toml", &format!("orogen = 1\n[use.part]\n{hills}\n[outputs]\nheight = \"part.deep\"\n"));
    assert!(folder.read("top.toml").unwrap_err().contains("unknown node `part`"));
}

#[test]
fn recipes_that_multiply_are_refused() {
    let folder = Folder::new("many");
    // Each recipe uses the next one twice: 2^n recipes.
    for k in 0..12 {
        let text = format!(
            "orogen = 1\n[use.a]\nrecipe = \"r{0}.toml\"\n[use.b]\nrecipe = \"r{0}.toml\"\n[nodes.n]\nop = \"add\"\na = \"a\"\nb = \"b\"\n[outputs]\nheight = \"n\"\n",
            k + 1
        );
        folder.write(&format!("r{k}.toml"), &text);
    }
    folder.write("r12.toml", "orogen = 1\n[nodes.n]\nop = \"fbm\"\n[outputs]\nheight = \"n\"\n");
    let error = folder.read("r0.toml").unwrap_err();
    assert!(error.contains("more than 256 recipes") && error.len() < 20_000, "{error}");
    assert_eq!(folder.read("r6.toml").unwrap().nodes().len(), 64 + 63);
    // A long chain.
    for k in 0..40 {
        folder.write(
            &format!("c{k}.toml"),
            &format!("orogen = 1\n[use.a]\nrecipe = \"c{}.toml\"\n[outputs]\nheight = \"a\"\n", k + 1),
        );
    }
    folder.write("c40.toml", "orogen = 1\n[nodes.n]\nop = \"fbm\"\n[outputs]\nheight = \"n\"\n");
    assert!(folder.read("c0.toml").unwrap_err().contains("16 levels deep"));
    assert_eq!(folder.read("c30.toml").unwrap().nodes().len(), 1);
    // A large text.
    let long = format!("orogen = 1\n# {}\n[nodes.n]\nop = \"fbm\"\n[outputs]\nheight = \"n\"\n", "x".repeat(6 << 20));
    folder.write("long.toml", &long);
    let uses: String = (0..4).map(|k| format!("[use.u{k}]\nrecipe = \"long.toml\"\n")).collect();
    folder.write("top.toml", &format!("orogen = 1\n{uses}[outputs]\nheight = \"u0\"\n"));
    assert!(folder.read("top.toml").unwrap_err().contains("16 MiB of text together"));
}

#[test]
fn groups_are_names_only() {
    let text = "orogen = 1\n[parameters]\nrelief = 90\n[world]\nsize = 1000\n[nodes.noise]\nop = \"fbm\"\nwavelength = \"= relief * 4\"\n\
                [nodes.land]\nop = \"expr\"\nexpr = \"noise * relief\"\n[outputs]\nheight = \"land\"\n";
    let grouped = text
        .replace("[nodes.noise]", "[nodes.\"hills/noise\"]")
        .replace("[nodes.land]", "[nodes.\"hills/rocks/land\"]\nnoise = \"hills/noise\"")
        .replace("\"land\"", "\"hills/rocks/land\"");
    let [plain, grouped] = [text, &grouped].map(|text| Recipe::parse(text, "test").unwrap());
    assert_eq!(grouped.formula("hills/noise", "wavelength"), Some(" relief * 4"));
    assert_eq!((grouped.formula("hills/noise", "octaves"), plain.formula("hills/noise", "wavelength")), (None, None));
    let written = grouped.to_toml();
    assert_eq!(Recipe::parse(&written, "again").unwrap(), grouped, "{written}");
    let [one, other] = [plain, grouped].map(|recipe| World::open(recipe).unwrap());
    assert_eq!(one.key("height").unwrap(), other.key("height").unwrap());
    assert_eq!(bits(&one, "height"), bits(&other, "height"));
    // Errors have a position and the full name of the node.
    let wrong = written.replace("fbm", "fbn");
    let error = Recipe::parse(&wrong, "test").unwrap_err();
    assert!(error.diagnostics()[0].place.is_some() && error.to_string().contains("fbn"), "{error}");
}
