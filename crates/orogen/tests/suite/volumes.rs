//! Layers in space: their samples, which nodes may read the altitude, and their memory.

use crate::support::open;
use orogen::declare::VERTICAL;
use orogen::node::Node;
use orogen::op::WorldParams;
use orogen::value::Value;
use orogen::{Budget, ErrorKind, Options, Recipe, Sampler, Window, World};
use orogen_noise::{Basis, Depth, Fractal, Kind, Perlin, Points};

/// Ground with caves: a filter and a warp in the plane, and noise in space.
const CAVES: &str = r#"
orogen = 1
[world]
seed = 5
cell = 2

[nodes.ground]
op = "fbm"
wavelength = 400
[nodes.soft]
op = "blur"
source = "ground"
radius = 8
[nodes.altitude]
op = "altitude"
[nodes.caves]
op = "ridged"
seed = 3
wavelength = 40
octaves = 3
vertical = 0.5
[nodes.bend]
op = "perlin"
seed = 8
wavelength = 60
vertical = 1
[nodes.bent]
op = "warp"
source = "ground"
x = "bend"
y = "bend"
strength = 20
[nodes.steep]
op = "slope"
source = "soft"
[nodes.density]
op = "expr"
expr = "100 * soft + 10 * bent - altitude + 30 * caves + steep"
[nodes.masked]
op = "blur"
source = "ground"
radius = 6
mask = "caves"
# Values that are made once, are read early, and whose registers later instructions could take.
[nodes.low]
op = "add"
a = "soft"
b = "altitude"
[nodes.high]
op = "multiply"
a = "bend"
b = "caves"
[nodes.higher]
op = "multiply"
a = "high"
b = "altitude"
[nodes.both]
op = "max"
a = "low"
b = "higher"

[outputs]
height = "soft"
density = "density"
both = "both"
masked = "masked"
"#;

/// The density without filters.
fn fields() -> String {
    let text = CAVES.replace("op = \"blur\"\nsource = \"ground\"\nradius = 8", "op = \"input\"\nsource = \"ground\"");
    text.replace("op = \"slope\"", "op = \"gullies\"")
}

fn world(text: &str) -> World {
    open(&Recipe::parse(text, "caves").unwrap(), 2)
}

const ALTITUDES: [f64; 5] = [-30.0, -4.5, 0.0, 17.25, 240.0];

#[test]
fn noise_in_space_is_that_of_the_noise_library() {
    let text = "orogen = 1\nworld.seed = 9\nnodes.n = { op = \"ridged\", seed = 4, wavelength = 70, vertical = 0.25, basis = \"simplex\" }\n\
        nodes.p = { op = \"perlin\", wavelength = 90, vertical = 1 }\noutputs.n = \"n\"\noutputs.p = \"p\"";
    let world = world(text);
    let window = Window::new(37, 21, 3.0).at(-1000, 77);
    let seed_of = |seed| WorldParams { seed: 9, size: None, cell: 1.0, sea_level: 0.0 }.seed_of(seed);
    let ridged = Fractal::new(seed_of(4), 70.0).with_kind(Kind::Ridged).with_basis(Basis::Simplex);
    let perlin = Perlin::new(seed_of(0), 90.0);
    let [n, p] = ["n", "p"].map(|layer| world.volume(layer, &window, &ALTITUDES).unwrap());
    let (xs, ys) = (window.eastings(), window.southings());
    for (k, altitude) in ALTITUDES.into_iter().enumerate() {
        let mut made = vec![0.0; window.len()];
        let points = Points::Lattice { xs: &xs, ys: &ys };
        ridged.fill3(&points, &Depth::Slice(altitude / 0.25), &mut made).unwrap();
        assert_eq!(made, n.slice(k));
        perlin.fill3(&points, &Depth::Slice(altitude), &mut made).unwrap();
        assert_eq!(made, p.slice(k));
        assert_eq!(p[(30, 11, k)], perlin.sample3(xs[30], ys[11], altitude));
    }
    assert!(n.slice(5).is_empty());
}

#[test]
fn a_part_of_a_volume_has_the_bits_of_the_whole() {
    for text in [CAVES.to_string(), fields()] {
        let world = world(&text);
        for layer in ["density", "both", "masked", "height"] {
            let window = Window::new(70, 50, 2.0).at(-41, 13);
            let whole = world.volume(layer, &window, &ALTITUDES).unwrap();
            assert_eq!(whole.slice(2), world.window(layer, &window).unwrap().data(), "{layer}");
            let sampler = Sampler::new(&world, layer).unwrap();
            for (x, y, width, height) in [(0, 0, 70, 50), (13, 7, 1, 1), (31, 22, 16, 16), (69, 0, 1, 50)] {
                let part = Window::new(width, height, 2.0).at(window.x + x as i64, window.y + y as i64);
                for altitudes in [vec![3, 1], vec![4], vec![0, 1, 2, 3, 4]] {
                    let metres: Vec<f64> = altitudes.iter().map(|k| ALTITUDES[*k]).collect();
                    let made = world.volume(layer, &part, &metres).unwrap();
                    assert_eq!((made.window(), made.altitudes()), (&part, &metres[..]));
                    assert_eq!(sampler.volume(&part, &metres).unwrap(), made, "{layer}");
                    for (at, &k) in altitudes.iter().enumerate() {
                        for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
                            assert_eq!(made[(i, j, at)].to_bits(), whole[(x + i, y + j, k)].to_bits(), "{layer}");
                        }
                    }
                }
            }
            let varies = whole.slice(0) != whole.slice(3);
            assert_eq!(
                (varies, world.reads_altitude(layer).unwrap()),
                (layer != "height", layer != "height"),
                "{layer}"
            );
        }
    }
}

/// The density of [`fields`] cut at an altitude, and nodes that read the slice.
const CUT: &str = r#"
[nodes.slice]
op = "slice"
source = "density"
altitude = ALTITUDE
[nodes.beside]
op = "transform"
source = "slice"
offset = [40, -10]
[nodes.bent_slice]
op = "warp"
source = "slice"
x = "bend"
y = "bend"
strength = 20
[nodes.over]
op = "add"
a = "slice"
b = "altitude"
[nodes.soft_slice]
op = "blur"
source = "slice"
radius = 4
[nodes.full]
op = "fill"
source = "slice"

[outputs]
slice = "slice"
beside = "beside"
bent = "bent_slice"
over = "over"
soft_slice = "soft_slice"
full = "full"
"#;

#[test]
fn a_slice_is_its_source_at_one_altitude_wherever_it_is_read() {
    let plain = world(&fields());
    for altitude in ALTITUDES {
        let cut = CUT.replace("ALTITUDE", &altitude.to_string());
        let cut = world(&fields().replace("[outputs]\n", &cut).replace("[world]", "[world]\nsize = [240, 200]"));
        let window = Window::new(60, 40, 2.0).at(10, 20);
        let at = |world: &World, layer: &str, window: &Window, altitude: f64| {
            world.volume(layer, window, &[altitude]).unwrap().slice(0).to_vec()
        };
        let source = at(&plain, "density", &window, altitude);
        assert_eq!(cut.window("slice", &window).unwrap().data(), source);
        assert_eq!(cut.points("slice", &[window.east(7)], &[window.south(9)]).unwrap()[0], source[9 * 60 + 7]);
        assert_eq!(at(&cut, "slice", &window, 17.0), source, "the same at all altitudes");
        let beside = Window { x: window.x + 20, y: window.y - 5, ..window };
        assert_eq!(cut.window("beside", &window).unwrap().data(), at(&plain, "density", &beside, altitude));
        let over = at(&cut, "over", &window, 17.0);
        assert!(over.iter().zip(&source).all(|(over, source)| *over == source + 17.0));
        // The warp depends on the altitude; the layer that it reads does not.
        let [low, high] = [-30.0, 240.0].map(|other| at(&cut, "bent", &window, other));
        assert_ne!(low, high);
        let inside = |made: &[f32]| made.iter().all(|made| source.iter().any(|s| (s - made).abs() < 60.0));
        assert!(inside(&low) && inside(&high));
        // Only its own layers are in space.
        for (layer, varies) in
            [("slice", false), ("soft_slice", false), ("full", false), ("bent", true), ("over", true)]
        {
            assert_eq!(cut.reads_altitude(layer).unwrap(), varies, "{layer}");
        }
        let soft = cut.window("soft_slice", &window).unwrap();
        assert!(soft.data() != source && soft.data().iter().all(|made| made.is_finite()));
        let full = cut.window("full", &window).unwrap();
        assert!(full.data().iter().zip(&source).all(|(full, source)| full >= source));
    }
}

#[test]
fn every_noise_can_be_one_of_space() {
    let noises = Node::all().into_iter().filter(|node| node.spec().params.iter().any(|param| param.name == VERTICAL));
    let mut seen = 0;
    for mut node in noises {
        let op = node.spec().op;
        let window = Window::new(9, 9, 77.0);
        let made = |node: &Node| {
            let mut recipe = Recipe::new(orogen::WorldSpec::default());
            recipe.add("noise", node.clone()).output("height", "noise");
            let world = open(&recipe, 1);
            let volume = world.volume("height", &window, &[0.0, 333.0]).unwrap();
            (world.key("height").unwrap(), world.reads_altitude("height").unwrap(), volume)
        };
        let (plane, reads, volume) = made(&node);
        assert!(!reads && volume.slice(0) == volume.slice(1), "{op}");
        let vertical = node.spec().param_named(VERTICAL).unwrap();
        node.set_param(vertical, &Value::Number(0.5)).unwrap();
        let (space, reads, volume) = made(&node);
        assert!(reads && volume.slice(0) != volume.slice(1) && plane != space, "{op}");
        seen += 1;
    }
    assert_eq!(seen, 16);
}

orogen::op! {
    /// A fractal of a program.
    pub struct Rough = "test.rough", field, revision 1;
    octaves |_| Kind::Ridged;
}

orogen::op! {
    /// A noise of a program.
    pub struct Deep = "test.deep", field, revision 1;
    params {
        /// Wavelength.
        wavelength: f64 = 100.0, unit "m", range 1.0 to 1e6;
    }
    noise |op, _| Perlin::new(3, op.wavelength);
    cost |_| [1.0, 0.15];
}

#[test]
fn ops_of_a_program_may_be_noises_of_space() {
    let window = Window::new(9, 9, 77.0);
    let varies = |node: Node| {
        let mut recipe = Recipe::new(orogen::WorldSpec::default());
        recipe.add("noise", node).output("height", "noise");
        let world = open(&recipe, 1);
        let volume = world.volume("height", &window, &[0.0, 333.0]).unwrap();
        assert_eq!(volume.slice(0), world.window("height", &window).unwrap().data());
        (world.reads_altitude("height").unwrap(), volume.slice(0) != volume.slice(1))
    };
    assert_eq!(varies(Rough::default().into()), (false, false));
    assert_eq!(varies(Rough { vertical: 2.0, ..Rough::default() }.into()), (true, true));
    assert_eq!(varies(Deep::default().into()), (false, false));
    assert_eq!(varies(Deep { vertical: 2.0, ..Deep::default() }.into()), (true, true));
    let laws = orogen::laws::Laws::of(|cell| Deep { vertical: 0.5, wavelength: 9.0 * cell.max(1.0) });
    assert_eq!(laws.check(), []);
}

#[test]
fn content_keys_of_noise_in_the_plane_are_those_of_before() {
    let mut recipe = Recipe::new(orogen::WorldSpec::default());
    recipe.add("noise", Node::named("fbm").unwrap()).output("height", "noise");
    let key: String = open(&recipe, 1).key("height").unwrap().iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(key, "021a59d6c025e419695dda92d2cdf10c09d4dc3c52be414d92f6087737866151");
}

#[test]
fn only_fields_may_read_the_altitude() {
    let refused = |nodes: &str, expect: &str| {
        let text = format!(
            "orogen = 1\nworld.size = 640\nworld.cell = 10\nnodes.altitude = {{ op = \"altitude\" }}\nnodes.deep = {{ op = \"add\", a = \"altitude\", b = 2 }}\n{nodes}\noutputs.height = \"made\""
        );
        let error = Recipe::parse(&text, "r").and_then(World::open).map(drop).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Recipe);
        let said = error.to_string();
        assert!(
            said.contains(expect) && said.contains("depends on the altitude") && said.contains("computed in the plane"),
            "{said}"
        );
    };
    refused("nodes.made = { op = \"blur\", source = \"deep\" }", "node `made`, `source`: `deep`");
    refused("nodes.made = { op = \"resample\", source = \"deep\" }", "node `made`, `source`: `deep`");
    refused("nodes.made = { op = \"bake\", source = \"altitude\" }", "node `made`, `source`: `altitude`");
    refused("nodes.made = { op = \"normalise\", source = \"deep\" }", "the op `normalise`");
    refused("nodes.made = { op = \"continents\", uplift = \"deep\" }", "node `made`, `uplift`: `deep`");
    let caves = "nodes.caves = { op = \"worley\", vertical = 2 }\nnodes.made = { op = \"slope\", source = \"caves\" }";
    refused(caves, "node `made`, `source`: `caves`");
}

#[test]
fn what_cannot_be_is_said() {
    let world = world(&fields());
    let window = Window::new(5, 4, 2.0);
    let said = |layer: &str, altitudes: &[f64]| world.volume(layer, &window, altitudes).unwrap_err().to_string();
    assert!(said("densty", &[0.0]).contains("did you mean `density`?"));
    assert!(said("density", &[]).contains("no altitudes"));
    assert!(said("density", &[0.0, f64::NAN]).contains("NaN is not an altitude"));
    assert!(world.reads_altitude("densty").is_err());
    let sampler = Sampler::new(&world, "density").unwrap();
    let short = sampler.fill_volume(&window, &[1.0, 2.0], &mut [0.0; 39]).unwrap_err().to_string();
    assert!(short.contains("5 x 4 samples at 2 altitudes") && short.contains("buffer of 39"), "{short}");
    let options = Options { threads: Some(1), memory: Budget::of(64 << 20), ..Options::default() };
    let world = World::with_options(Recipe::parse(&fields(), "r").unwrap(), options).unwrap();
    let (large, altitudes) = (Window::new(1024, 1024, 2.0), vec![0.0; 1000]);
    assert_eq!(world.volume("density", &large, &altitudes).unwrap_err().kind(), ErrorKind::Memory);
    let sampler = Sampler::new(&world, "density").unwrap();
    assert_eq!(sampler.volume(&large, &altitudes).unwrap_err().kind(), ErrorKind::Memory);
}
