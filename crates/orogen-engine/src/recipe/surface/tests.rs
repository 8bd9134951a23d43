use super::document::{Along, Coloring, Quantity};
use super::expand::expand;
use crate::recipe::document::Recipe;
use crate::recipe::graph::Graph;

fn recipe(size: &str, surfaces: &str) -> String {
    format!(
        "orogen = 1\n[world]\nseed = 5\n{size}\ncell = 20\nsea_level = 40\n[nodes.hills]\nop = \"fbm\"\n[nodes.land]\nop = \"remap\"\nsource = \"hills\"\n\
         to = [0, 900]\n[outputs]\nheight = \"land\"\n{surfaces}"
    )
}

const SIZE: &str = "size = [6000, 8000]";

const SURFACES: &str = r##"
[[surface]]
name = "grass"
color = "#4d5a2a"
[[surface]]
name = "rock"
gradient = ["#333", "gray80", "khaki"]
along = "height"
span = [0, 1000]
roughness = 0.7
opacity = 0.9
slope = { min = 20, fade = 5 }
noise = { min = -0.2, max = 1.0, fade = [0.1, 0], wavelength = 300, seed = 4 }
layers = { hills = { min = 0 }, "land.a" = [0, 5] }
mask = "hills"
[[surface]]
name = "snow"
picture = "snow.png"
grain = 50
any = [{ height = { min = 600, fade = 100 } }, { curvature = { max = 0, scale = 80 }, flow = [1e5, 1e9] }]
"##;

#[test]
fn surfaces_read_back_as_they_were_written() {
    // `land.a` is no layer; the text is still valid.
    let text = recipe(SIZE, &SURFACES.replace(", \"land.a\" = [0, 5]", ""));
    let first = Recipe::parse(&text, "test").unwrap();
    let again = Recipe::parse(&first.to_toml(), "again").unwrap();
    assert_eq!(first, again);
    let [grass, rock, snow] = first.surfaces() else { panic!("three surfaces") };
    assert_eq!(grass.color, Coloring::Plain([0x4d, 0x5a, 0x2a]));
    assert!(matches!(&rock.color, Coloring::Gradient(colors, Along::Height([0.0, 1000.0])) if colors.len() == 3));
    assert!(matches!(&snow.color, Coloring::Picture(file, Along::Noise(50.0)) if file.text() == "snow.png"));
    assert_eq!((rock.all.len(), rock.opacity, snow.any.len(), snow.any[1].len()), (3, 0.9, 2, 2));
    assert_eq!(rock.all[0].of, Quantity::Slope);
    // The nodes that compute them are not listed.
    let mut expanded = first.clone();
    expand(&mut expanded);
    assert_eq!(expanded.to_toml(), first.to_toml());
    assert!(expanded.nodes().len() > first.nodes().len() + 8);
}

#[test]
fn faults_stand_at_their_keys() {
    for (from, to, column, expect) in [
        ("\"#4d5a2a\"", "\"#4d5\"\nslope = [0, 5]", "slope", "the first surface is everywhere and cannot have `slope`"),
        ("name = \"rock\"", "name = \"r k\"", "\"r k\"", "`name` must be 1 to 64 letters"),
        ("name = \"rock\"\n", "", "[[surface]]", "a surface needs a `name`"),
        ("\"gray80\"", "\"gray180\"", "\"gray180\"", "a color must be \"#rrggbb\" or a name"),
        ("span = [0, 1000]", "span = [3, 3]", "[3, 3]", "two different numbers"),
        ("span = [0, 1000]\n", "", "along", "needs `span = [FROM, TO]`"),
        ("opacity = 0.9", "opacity = 1.9", "1.9", "`opacity` must be a number from 0 to 1"),
        ("min = 20, fade", "min = 120, fade", "120", "from 0 to 90"),
        ("fade = 5", "fad = 5", "fad", "did you mean `fade`?"),
        ("wavelength = 300, ", "", "{ min = -0.2", "`noise` needs a `wavelength`"),
        ("scale = 80", "octaves = 8", "octaves", "unknown key `octaves` in `curvature`"),
        ("grain = 50", "grain = 50\ncolor = \"red\"", "color", "one of `color`, `gradient` and `picture`"),
        ("picture = \"snow.png\"\ngrain = 50", "", "[[surface]]", "a surface needs a `color`"),
        ("any = [{", "any = [{}, {", "{}", "an alternative needs a condition"),
        ("roughness = 0.7", "rougness = 0.7", "rougness", "did you mean `roughness`?"),
        ("hills = { min = 0 }", "hils = { min = 0 }", "hils", "unknown node `hils`; did you mean `hills`?"),
        ("mask = \"hills\"", "mask = \"zz.x\"", "\"zz.x\"", "unknown node `zz`; available: `"),
        ("mask = \"hills\"", "mask = true", "true", "`mask` must name a node"),
    ] {
        let surfaces = SURFACES.replace(", \"land.a\" = [0, 5]", "");
        assert!(surfaces.contains(from), "{from}");
        let text = recipe(SIZE, &surfaces.replacen(from, to, 1));
        let error = Recipe::parse(&text, "test").unwrap_err();
        let diagnostic = error.diagnostics().iter().find(|diagnostic| diagnostic.message.contains(expect));
        let diagnostic = diagnostic.unwrap_or_else(|| panic!("{expect}: {error}"));
        let place = diagnostic.place.as_ref().unwrap();
        let from: String = place.text.chars().skip(place.column - 1).collect();
        assert!(from.starts_with(column), "{from} / {column}: {error}");
    }
    // A mask that is the only condition.
    let alone =
        "[[surface]]\nname = \"a\"\ncolor = \"red\"\n[[surface]]\nname = \"b\"\ncolor = \"blue\"\nmask = \"zz\"\n";
    let error = Recipe::parse(&recipe(SIZE, alone), "test").unwrap_err();
    let place = error.diagnostics()[0].place.as_ref().unwrap();
    assert_eq!((place.text.as_str(), place.column), ("mask = \"zz\"", 8), "{error}");
    assert!(error.to_string().contains("surface `b`: unknown node `zz`; available: `"), "{error}");
    let unbounded = recipe("", &SURFACES.replace(", \"land.a\" = [0, 5]", ""));
    assert!(Recipe::parse(&unbounded, "test").unwrap_err().to_string().contains("`flow` needs a bounded world"));
    let missing = Recipe::parse(&recipe(SIZE, SURFACES), "test").unwrap_err().to_string();
    assert!(missing.contains("surface `rock`: the node `land` has no layer `a`"), "{missing}");
}

#[test]
fn every_recipe_can_be_expanded() {
    for size in [SIZE, ""] {
        let text = recipe(size, "")
            .replace("nodes.hills", "nodes.surface-1-position")
            .replace("\"hills\"", "\"surface-1-position\"");
        let mut recipe = Recipe::parse(&text, "test").unwrap();
        expand(&mut recipe);
        let count = recipe.nodes().len();
        Graph::resolve(&recipe).unwrap();
        expand(&mut recipe);
        assert_eq!((recipe.nodes().len(), recipe.expanded().len()), (count, 8), "once is enough");
    }
}
