//! Recipes with parameters, formulas and expressions.

use orogen::ids::Id;
use orogen::plan::program::Instruction;
use orogen::plan::steps::Step;
use orogen::{Recipe, Window, World};

const HILLS: &str = r#"
orogen = 1

[parameters]
seed = 7
octaves = { default = 3, range = [1, 8], help = "How rough" }

[parameters.relief]
default = 400
unit = "m"
range = [10, 2000]
help = "Height of the hills"

[world]
seed = "= seed"
size = ["= relief * 10", 3000]
cell = "= relief / 10"

[nodes.noise]
op = "fbm"
wavelength = "=relief*2"
octaves = "= octaves"
seed = "= seed + 1"

[nodes.bent]
op = "curve"
source = "noise"
points = [[-1, "= -relief"], [0, 0], [1, "= relief"]]
mask = "= min(relief / 400, 1)"

[nodes.land]
op = "expr"
expr = "max(bent, low) + relief * 0.5"
low = "= -relief / 4"

[outputs]
height = "land"
flat = "= relief ^ 2"

[[surface]]
name = "rock"
color = "gray"
[[surface]]
name = "grass"
color = "green"
height = { max = "= relief / 2", fade = "= relief / 10" }
"#;

/// The same recipe with plain numbers.
fn plain(relief: f64) -> String {
    let minus = -relief;
    format!(
        r#"
orogen = 1
[world]
seed = 7
size = [{}, 3000]
cell = {}
[nodes.noise]
op = "fbm"
wavelength = {}
octaves = 3
seed = 8
[nodes.bent]
op = "curve"
source = "noise"
points = [[-1, {minus}], [0, 0], [1, {relief}]]
mask = {}
[nodes.land]
op = "expr"
expr = "max(bent, low) + relief * 0.5"
low = {}
relief = {relief}
[outputs]
height = "land"
flat = {}
[[surface]]
name = "rock"
color = "gray"
[[surface]]
name = "grass"
color = "green"
height = {{ max = {}, fade = {} }}
"#,
        relief * 10.0,
        relief / 10.0,
        relief * 2.0,
        (relief / 400.0).min(1.0),
        -relief / 4.0,
        relief * relief,
        relief / 2.0,
        relief / 10.0
    )
}

fn set(values: &[(&str, f64)]) -> Vec<(String, f64)> {
    values.iter().map(|(name, value)| (name.to_string(), *value)).collect()
}

#[test]
fn formulas_are_numbers_wherever_they_stand() {
    for relief in [400.0, 150.0] {
        let recipe =
            Recipe::parse_with(HILLS, "hills", &set(&[("relief", relief)])).unwrap_or_else(|error| panic!("{error}"));
        let plain = Recipe::parse(&plain(relief), "plain").unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((recipe.nodes(), recipe.world), (plain.nodes(), plain.world));
        assert_eq!((recipe.output_inputs(), recipe.surfaces()), (plain.output_inputs(), plain.surfaces()));
        let window = Window::new(20, 20, 30.0);
        let [one, other] =
            [recipe, plain].map(|recipe| World::open(recipe).unwrap().window("height", &window).unwrap());
        assert_eq!(one.data(), other.data());
    }
}

#[test]
fn what_is_written_back_keeps_parameters_and_formulas() {
    let recipe = Recipe::parse_with(HILLS, "hills", &set(&[("relief", 150.0)])).unwrap();
    let written = recipe.to_toml();
    for line in [
        "[parameters.relief]\ndefault = 150.0\nunit = \"m\"\nrange = [10.0, 2000.0]\nhelp = \"Height of the hills\"",
        "seed = \"= seed\"",
        "size = [\"= relief * 10\", 3000.0]",
        "cell = \"= relief / 10\"",
        "wavelength = \"=relief*2\"",
        "octaves = \"= octaves\"",
        "points = [[-1.0, \"= -relief\"], [0.0, 0.0], [1.0, \"= relief\"]]",
        "mask = \"= min(relief / 400, 1)\"",
        "expr = \"max(bent, low) + relief * 0.5\"\nlow = \"= -relief / 4\"\n\n",
        "flat = \"= relief ^ 2\"",
    ] {
        assert!(written.contains(line), "{line}\n{written}");
    }
    assert!(!written.contains("bent = \"bent\""), "what names mean by themselves is not written:\n{written}");
    let again = Recipe::parse(&written, "again").unwrap_or_else(|error| panic!("{error}\n{written}"));
    assert_eq!(again, recipe);
    // A recipe that is written back keeps its program: other values give the same result as with the first text.
    let values = set(&[("relief", 700.0), ("seed", 2.0)]);
    let [one, other] = [HILLS, &written].map(|text| Recipe::parse_with(text, "one", &values).unwrap());
    assert_eq!(one, other);
    // A node changed in code keeps its number.
    let mut changed = recipe.clone();
    changed.change(|node| {
        if let orogen::node::Node::Fbm(fbm) = node {
            fbm.wavelength = 77.0;
        }
    });
    let written = changed.to_toml();
    assert!(written.contains("wavelength = 77.0") && written.contains("octaves = \"= octaves\""), "{written}");
}

/// A recipe of one node with these lines.
fn recipe(parameters: &str, node: &str) -> String {
    format!(
        "orogen = 1\n{parameters}\n[world]\nsize = 900\n[nodes.a]\nop = \"fbm\"\n[nodes.n]\n{node}\n[outputs]\nheight = \"n\"\n"
    )
}

#[test]
fn what_is_wrong_is_told_where_it_is_wrong() {
    for (parameters, node, line, column, length, expect) in [
        (
            "",
            "op = \"fbm\"\nwavelength = \"= 2 * relief\"",
            9,
            21,
            6,
            "there is no parameter `relief`; none is available",
        ),
        ("parameters.relief = 3", "op = \"fbm\"\nwavelength = \"= 2 * relif\"", 9, 21, 5, "did you mean `relief`?"),
        ("parameters.a = 3", "op = \"fbm\"\nwavelength = '= 2 * (a'", 9, 21, 1, "the `)` that closes this"),
        ("parameters.a = 3", "op = \"fbm\"\nwavelength = \"= a - 3\"", 9, 14, 9, "`wavelength` must be"),
        ("parameters.a = 3", "op = \"fbm\"\noctaves = \"= a / 2\"", 9, 11, 9, "a whole number"),
        ("parameters.a = 3", "op = \"fbm\"\noctaves = \"= 1 / (a - 3)\"", 9, 13, 12, "is not finite"),
        ("", "op = \"expr\"\nexpr = \"a * (2 + a\"", 9, 13, 1, "the `)` that closes this"),
        ("", "op = \"expr\"\nexpr = \"smothstep(0, 1, a)\"", 9, 9, 9, "did you mean `smoothstep`?"),
        ("", "op = \"expr\"\nexpr = \"\"\"\na +\n  sin(1, 2)\"\"\"", 11, 3, 3, "takes 1 argument"),
        ("", "op = \"expr\"\nexpr = \"a + \\u00e9\"", 9, 8, 12, "unknown symbol"),
        ("", "op = \"expr\"\nexpr = \"a + b\"", 9, 13, 1, "unknown node `b`"),
        ("", "op = \"expr\"\nexpr = \"a\"\nb = 3", 10, 1, 1, "unknown key `b`"),
        ("", "op = \"expr\"\nexpr = 3", 9, 8, 1, "an expression in quotes"),
        ("", "op = \"expr\"", 7, 8, 1, "the expression is empty"),
        ("", "op = \"expr\"\nexpr = \"n\"", 9, 9, 1, "the node reads itself"),
        ("parameters.a = \"x\"", "op = \"fbm\"", 2, 16, 3, "`a` must be a finite number"),
        ("parameters.sin = 1", "op = \"fbm\"", 2, 12, 3, "cannot be a parameter's name"),
        ("parameters.a-b = 1", "op = \"fbm\"", 2, 12, 3, "cannot be a parameter's name"),
        (
            "parameters.a = { default = 9, range = [0, 5] }",
            "op = \"fbm\"",
            2,
            28,
            1,
            "`a` must be a finite number from 0 to 5, not 9",
        ),
        (
            "parameters.a = { default = 9, range = [5, 0] }",
            "op = \"fbm\"",
            2,
            39,
            6,
            "the first number of `range` must not be greater",
        ),
        ("parameters.a = { range = [0, 5] }", "op = \"fbm\"", 2, 12, 1, "the parameter `a` needs a `default`"),
        ("parameters.a = { default = 1, units = \"m\" }", "op = \"fbm\"", 2, 31, 5, "did you mean `unit`?"),
        ("parameters.a = { default = nan }", "op = \"fbm\"", 2, 28, 3, "a finite number"),
        ("parameters = 3", "op = \"fbm\"", 2, 14, 1, "must be a table of parameters"),
    ] {
        let text = recipe(parameters, node);
        let error = Recipe::parse(&text, "r").map(|_| ()).unwrap_err();
        assert_eq!(error.diagnostics().len(), 1, "{text}\n{error}");
        let diagnostic = &error.diagnostics()[0];
        assert!(diagnostic.message.contains(expect), "{text}\n{error}");
        let place = diagnostic.place.as_ref().unwrap();
        assert_eq!((place.line, place.column, place.length), (line, column, length), "{text}\n{error}");
    }
}

#[test]
fn what_cannot_be_set() {
    for (values, expect) in [
        (&[("relif", 3.0)][..], "hills: there is no parameter `relif`; did you mean `relief`?"),
        (&[("relief", 9.0)], "`relief` must be a finite number from 10 to 2000 (m), not 9"),
        (&[("relief", f64::NAN)], "not NaN"),
        (&[("octaves", 2.5)], "a whole number"),
        (&[("seed", -1.0)], "`seed`"),
    ] {
        let error = Recipe::parse_with(HILLS, "hills", &set(values)).unwrap_err().to_string();
        assert!(error.contains(expect), "{error}");
    }
    let error = Recipe::parse_with(&recipe("", "op = \"fbm\""), "r", &set(&[("a", 1.0)])).unwrap_err().to_string();
    assert!(error.contains("this recipe has none"), "{error}");
}

/// A world with the node `n` and two noises.
fn world(nodes: &str) -> World {
    let text = format!(
        "orogen = 1\n[world]\nseed = 3\n[nodes.a]\nop = \"fbm\"\nwavelength = 300\n[nodes.b]\nop = \"ridged\"\nwavelength = 500\n\
         {nodes}\n[outputs]\nheight = \"n\"\n"
    );
    World::open(Recipe::parse(&text, "r").unwrap_or_else(|error| panic!("{error}"))).unwrap()
}

/// The instructions that compute the height, without registers: functions by name, all others by kind.
fn instructions(world: &World) -> Vec<String> {
    let plan = world.plan(&["height"], &Window::new(64, 64, 10.0)).unwrap();
    let [Step::Fill { program, .. }] = plan.steps() else { panic!("one fill") };
    let mut names: Vec<String> = (program.instructions.iter())
        .map(|instruction| match instruction {
            Instruction::Apply { function, .. } => function.name().to_string(),
            Instruction::Field { node, .. } => format!("node {}", node.index()),
            other => format!("{other:?}"),
        })
        .collect();
    names.sort();
    names
}

/// Pairs of an expression and the equivalent nodes.
const PAIRS: [(&str, &str); 8] = [
    ("a + b", "[nodes.n]\nop = \"add\"\na = \"a\"\nb = \"b\""),
    ("a * 14", "[nodes.n]\nop = \"multiply\"\na = \"a\"\nb = 14"),
    ("mix(a, b, 0.7)", "[nodes.n]\nop = \"mix\"\na = \"a\"\nb = \"b\"\namount = 0.7"),
    ("min(a, b)", "[nodes.n]\nop = \"min\"\na = \"a\"\nb = \"b\""),
    ("smax(a, b, 0.3)", "[nodes.n]\nop = \"max\"\na = \"a\"\nb = \"b\"\nsmooth = 0.3"),
    ("smin(b, a, 0.1)", "[nodes.n]\nop = \"min\"\na = \"b\"\nb = \"a\"\nsmooth = 0.1"),
    ("clamp(a, -0.1, 0.2)", "[nodes.n]\nop = \"clamp\"\nsource = \"a\"\nlow = -0.1\nhigh = 0.2"),
    (
        "mix(max(a * 300 + b, b), clamp(a, 0, 1), b) + a",
        "[nodes.p]\nop = \"multiply\"\na = \"a\"\nb = 300\n[nodes.q]\nop = \"add\"\na = \"p\"\nb = \"b\"\n\
         [nodes.r]\nop = \"max\"\na = \"q\"\nb = \"b\"\n[nodes.s]\nop = \"clamp\"\nsource = \"a\"\n\
         [nodes.t]\nop = \"mix\"\na = \"r\"\nb = \"s\"\namount = \"b\"\n[nodes.n]\nop = \"add\"\na = \"t\"\nb = \"a\"",
    ),
];

#[test]
fn an_expression_is_the_very_instructions_of_the_nodes_it_stands_for() {
    for (expression, nodes) in PAIRS {
        let [one, other] = [world(&format!("[nodes.n]\nop = \"expr\"\nexpr = \"{expression}\"")), world(nodes)];
        assert_eq!(instructions(&one), instructions(&other), "{expression}");
        let window = Window::new(100, 90, 7.3).at(-31, 17);
        let [one, other] = [one, other].map(|world| world.window("height", &window).unwrap());
        let bits = |grid: &orogen::Grid| grid.data().iter().map(|sample| sample.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&one), bits(&other), "{expression}");
    }
}

#[test]
fn expressions_compute_what_they_say() {
    let window = Window::new(40, 30, 11.0);
    let of = |expression: &str| {
        world(&format!("[nodes.n]\nop = \"expr\"\nexpr = \"{expression}\"")).window("height", &window).unwrap()
    };
    let (a, b) = (of("a"), of("b"));
    let made = of("smoothstep(-0.2, 0.4, a) * b^3 - sin(a) / 2 + (a > b) * 10 + pi");
    for ((made, a), b) in made.data().iter().zip(a.data()).zip(b.data()) {
        let (a, b) = (f64::from(*a), f64::from(*b));
        let t = ((a + 0.2) / 0.6).clamp(0.0, 1.0);
        let over = if a > b { 10.0 } else { 0.0 };
        let expect = t * t * (3.0 - 2.0 * t) * b * b * b - libm_sin(a) / 2.0 + over + std::f64::consts::PI;
        assert!((f64::from(*made) - expect).abs() < 1e-5, "{made}, {expect}");
    }
    // An expression of constants leaves nothing to compute.
    let still = world("[nodes.n]\nop = \"expr\"\nexpr = \"2 ^ 10 + c\"\nc = 1");
    assert_eq!(still.height(5.0, 5.0).unwrap(), 1025.0);
    assert_eq!(instructions(&still).len(), 1);
    // NaN and infinity are valid samples.
    assert!(of("sqrt(a - 10)").data().iter().all(|sample| sample.is_nan()));
    assert!(of("1 / (a - a)").data().iter().all(|sample| *sample == f32::INFINITY));
}

/// The sine of a small angle as a series, because the platform's function differs between machines.
fn libm_sin(x: f64) -> f64 {
    let square = x * x;
    x * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))))
}

#[test]
fn layers_masks_and_names_in_expressions() {
    let text = "orogen = 1\n[nodes.a-b]\nop = \"fbm\"\n[nodes.steep]\nop = \"slope\"\nsource = \"a-b\"\n\
                [nodes.n]\nop = \"expr\"\nexpr = \"ab + steep.east\"\nab = \"a-b\"\nmask = 0.5\n[outputs]\nheight = \"n\"\n";
    let recipe = Recipe::parse(text, "r").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(Recipe::parse(&recipe.to_toml(), "again").unwrap(), recipe);
    let world = World::open(recipe).unwrap();
    assert!(world.window("height", &Window::new(8, 8, 10.0)).is_ok());
    // The same in code.
    use orogen::field::{Expr, Fbm};
    let mut recipe = Recipe::new(orogen::WorldSpec::default());
    recipe.add("base", Fbm::default()).add("n", Expr::new("base * gain").with("gain", 3.0)).output("height", "n");
    let thrice = World::open(recipe.clone()).unwrap().height(50.0, 50.0).unwrap();
    recipe.add("m", Expr::new("base")).output("base", "m");
    let window = Window::new(1, 1, 10.0).at(5, 5);
    let once = World::open(recipe).unwrap().window("base", &window).unwrap()[(0, 0)];
    assert_eq!(thrice, once * 3.0);
}

#[test]
fn long_and_deep_texts_end_in_a_sentence_soon() {
    let begun = std::time::Instant::now();
    for text in
        ["(".repeat(1 << 20), "a+".repeat(1 << 19), "-".repeat(60_000), "a^".repeat(30_000), "sin(".repeat(16_000)]
    {
        for node in [format!("op = \"expr\"\nexpr = \"{text}\""), format!("op = \"fbm\"\nwavelength = \"={text}\"")] {
            let error = Recipe::parse(&recipe("parameters.a = 1", &node), "r").unwrap_err();
            assert!(error.to_string().len() < 30_000 && error.diagnostics()[0].place.is_some());
        }
    }
    let many: String = (0..300).map(|k| format!("p{k} = {k}\n")).collect();
    let error = Recipe::parse(&recipe(&format!("[parameters]\n{many}"), "op = \"fbm\""), "r").unwrap_err();
    assert!(error.to_string().contains("more than 256 parameters"), "{error}");
    // Work that grows with the square of the length would take hours.
    assert!(begun.elapsed().as_secs() < 300, "{:?}", begun.elapsed());
}
