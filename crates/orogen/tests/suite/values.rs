//! Compares the values of each op with its documentation, computed independently.

use crate::support::open;
use orogen::field::{Corners, Edge, Radial, Ramp, Transform, Warp};
use orogen::filter::{Blur, Slope, SlopeUnit};
use orogen::node::Node;
use orogen::{Recipe, Window, World, WorldSpec};

const SIZE: f64 = 1000.0;

fn world() -> WorldSpec {
    WorldSpec::default().with_seed(5).with_size(Some([SIZE, SIZE])).with_cell(10.0)
}

/// A world of these nodes; the last one is the output.
fn of(nodes: Vec<(&str, Node)>) -> World {
    let mut recipe = Recipe::new(world());
    let last = nodes.last().map(|(name, _)| name.to_string()).unwrap();
    for (name, node) in nodes {
        recipe.add(name, node);
    }
    recipe.output("height", last.as_str());
    open(&recipe, 1)
}

fn text(nodes: &str) -> World {
    let text = format!("orogen = 1\n[world]\nsize = {SIZE}\ncell = 10\nseed = 5\n{nodes}\n[outputs]\nheight = \"z\"\n");
    World::open(Recipe::parse(&text, "t").unwrap_or_else(|error| panic!("{error}"))).unwrap()
}

fn near(world: &World, points: &[(f64, f64, f32)]) {
    for (x, y, expect) in points {
        let made = world.height(*x, *y).unwrap();
        assert!((made - expect).abs() <= 1e-5 * expect.abs().max(1.0), "({x}, {y}): {made}, expected {expect}");
    }
}

#[test]
fn ramps_rise_where_they_say() {
    let ramp = |azimuth| of(vec![("r", Ramp { azimuth, length: 100.0, origin: [500.0, 500.0] }.into())]);
    near(&ramp(90.0), &[(600.0, 500.0, 1.0), (600.0, 0.0, 1.0), (450.0, 9.0, -0.5)]);
    near(&ramp(0.0), &[(0.0, 400.0, 1.0), (7.0, 550.0, -0.5)]);
    near(&ramp(180.0), &[(0.0, 600.0, 1.0)]);
    near(&ramp(-90.0), &[(400.0, 0.0, 1.0)]);
    near(&ramp(45.0), &[(600.0, 400.0, std::f32::consts::SQRT_2)]);
}

#[test]
fn radial_and_edge_fall_off() {
    let hill = of(vec![("r", Radial { center: [500.0, 400.0], radius: 200.0, inner: 100.0 }.into())]);
    near(&hill, &[(500.0, 400.0, 1.0), (590.0, 400.0, 1.0), (500.0, 550.0, 0.5), (500.0, 600.0, 0.0), (0.0, 0.0, 0.0)]);
    let rim = |corners| of(vec![("e", Edge { width: 200.0, corners }.into())]);
    let square = rim(Corners::Square);
    near(
        &square,
        &[(0.0, 500.0, 0.0), (1000.0, 1000.0, 0.0), (100.0, 500.0, 0.5), (100.0, 100.0, 0.5), (500.0, 800.0, 1.0)],
    );
    let round = rim(Corners::Round);
    near(&round, &[(100.0, 500.0, 0.5), (500.0, 500.0, 1.0), (0.0, 0.0, 0.0), (200.0, 500.0, 1.0)]);
    assert!(round.height(100.0, 100.0).unwrap() < 0.5, "corners are rounded off");
}

#[test]
fn arithmetic_does_what_it_says() {
    let cases = [
        ("op = \"add\"\na = 3\nb = -1.5", 1.5),
        ("op = \"multiply\"\na = 3\nb = -1.5", -4.5),
        ("op = \"mix\"\na = 2\nb = 6\namount = 0.25", 3.0),
        ("op = \"mix\"\na = 2\nb = 6\namount = 7", 6.0),
        ("op = \"min\"\na = 3\nb = 4", 3.0),
        ("op = \"max\"\na = 3\nb = 4", 4.0),
        ("op = \"min\"\na = 3\nb = 3\nsmooth = 2", 2.5),
        ("op = \"max\"\na = 3\nb = 3\nsmooth = 2", 3.5),
        ("op = \"min\"\na = 3\nb = 5\nsmooth = 2", 3.0),
        ("op = \"clamp\"\nsource = 7\nlow = -1\nhigh = 2", 2.0),
        ("op = \"remap\"\nsource = 5\nfrom = [0, 10]\nto = [100, 200]", 150.0),
        ("op = \"remap\"\nsource = 20\nfrom = [0, 10]\nto = [200, 100]", 0.0),
        ("op = \"remap\"\nsource = 20\nfrom = [0, 10]\nto = [200, 100]\nclamp = true", 100.0),
        ("op = \"curve\"\nsource = 0.2\npoints = [[-1, 0], [0.4, 0], [1, 1]]", 0.0),
        ("op = \"terrace\"\nsource = 10\nstep = 4\noffset = 2", 10.0),
        ("op = \"terrace\"\nsource = 10.9\nstep = 4\noffset = 2\nsharpness = 0.9", 10.0),
        ("op = \"terrace\"\nsource = 12\nstep = 4\noffset = 2\nsharpness = 0.9", 12.0),
        ("op = \"terrace\"\nsource = 13.1\nstep = 4\noffset = 2\nsharpness = 0.9", 14.0),
        ("op = \"constant\"\nvalue = -2.25", -2.25),
        ("op = \"add\"\na = 3\nb = 10\nmask = 0.5", 8.0),
        ("op = \"constant\"\nvalue = 8\nmask = 0.25", 2.0),
        ("op = \"constant\"\nvalue = 8\nmask = 9", 8.0),
        ("op = \"blur\"\nsource = 4\nmask = 0.5", 4.0),
        ("op = \"slope\"\nsource = 4", 0.0),
        ("op = \"bake\"\nsource = 4", 4.0),
        ("op = \"normalise\"\nsource = 4\nlow = 70", 70.0),
    ];
    for (node, expect) in cases {
        near(&text(&format!("[nodes.z]\n{node}")), &[(500.0, 500.0, expect)]);
    }
}

#[test]
fn transform_looks_elsewhere() {
    let ramp: Node = Ramp { azimuth: 90.0, length: 1.0, origin: [0.0, 0.0] }.into();
    let seen = |offset, scale, angle| {
        of(vec![("r", ramp.clone()), ("t", Transform { source: "r".into(), offset, scale, angle }.into())])
    };
    near(&seen([30.0, 0.0], 1.0, 0.0), &[(100.0, 0.0, 130.0)]);
    near(&seen([0.0, 0.0], 4.0, 0.0), &[(100.0, 0.0, 25.0)]);
    // Rotated by 90 degrees clockwise, a rise to the east becomes a rise to the south.
    near(&seen([0.0, 0.0], 1.0, 90.0), &[(0.0, 100.0, 100.0), (70.0, 100.0, 100.0)]);
    near(&seen([0.0, 0.0], 1.0, 45.0), &[(100.0, 0.0, 70.710_68), (0.0, 100.0, 70.710_68)]);
}

#[test]
fn warp_reads_the_source_where_it_is_sent() {
    let ramp: Node = Ramp { azimuth: 90.0, length: 1.0, origin: [0.0, 0.0] }.into();
    let sent = |x: f64, y: f64| Warp { source: "r".into(), x: x.into(), y: y.into(), strength: 40.0 };
    near(&of(vec![("r", ramp.clone()), ("w", sent(0.5, 0.9).into())]), &[(100.0, 0.0, 120.0)]);
    near(&of(vec![("r", ramp.clone()), ("w", sent(-1.0, 0.0).into())]), &[(100.0, 0.0, 60.0)]);
    // The displacement is never larger than its strength.
    near(&of(vec![("r", ramp), ("w", sent(-7.0, 0.0).into())]), &[(100.0, 0.0, 60.0)]);
}

#[test]
fn blur_is_the_gaussian_mean() {
    let noise = orogen::field::White { seed: 3, wavelength: 10.0, ..Default::default() };
    let sharp = of(vec![("n", noise.clone().into())]);
    let radius = 23.0;
    let soft = of(vec![("n", noise.into()), ("b", Blur { source: "n".into(), radius }.into())]);
    let reach = 7i64; // 3 * 23 / 10, rounded up
    let from = sharp.window("height", &Window::new(41, 41, 10.0).at(20, 20)).unwrap();
    let made = soft.window("height", &Window::new(5, 4, 10.0).at(38, 39)).unwrap();
    for j in 0..4i64 {
        for i in 0..5i64 {
            let (mut sum, mut weights) = (0.0f64, 0.0f64);
            for dy in -reach..=reach {
                for dx in -reach..=reach {
                    let weight = libm::exp(-((dx * dx + dy * dy) as f64) / (2.0 * (radius / 10.0) * (radius / 10.0)));
                    sum += weight * f64::from(from[((18 + i + dx) as usize, (19 + j + dy) as usize)]);
                    weights += weight;
                }
            }
            let expect = sum / weights;
            assert!((f64::from(made[(i as usize, j as usize)]) - expect).abs() < 1e-6, "({i}, {j})");
        }
    }
}

#[test]
fn slope_of_a_plane_is_its_slope() {
    let plane = Ramp { azimuth: 137.0, length: 2.0, origin: [0.0, 0.0] };
    let told = |unit| of(vec![("r", plane.clone().into()), ("s", Slope { source: "r".into(), unit }.into())]);
    let close = |world: World, expect: f32| {
        let made = world.height(500.0, 500.0).unwrap();
        assert!((made - expect).abs() < 1e-3, "{made}, expected {expect}");
    };
    close(told(SlopeUnit::Ratio), 0.5);
    close(told(SlopeUnit::Degrees), 26.565_05);
}

#[test]
fn fractals_read_their_parameters() {
    // Each parameter of the noises changes the result.
    for op in ["fbm", "ridged", "billow", "weighted-fbm", "perlin", "value", "white", "classic"] {
        let base = Node::named(op).unwrap();
        let make = |node: Node| of(vec![("n", node)]).window("height", &Window::new(20, 20, 10.0)).unwrap();
        let before = make(base.clone());
        for (i, param) in base.spec().params.iter().enumerate() {
            let other = match (param.name, base.param(i)) {
                ("basis", _) => orogen::value::Value::Text("value".into()),
                ("fade", _) => orogen::value::Value::Text("linear".into()),
                ("variant", _) => orogen::value::Value::Text("eight".into()),
                ("falloff", _) => orogen::value::Value::Text("exponential".into()),
                (_, orogen::value::Value::Integer(n)) => orogen::value::Value::Integer(n + 1),
                (_, value) => orogen::value::Value::Number(value.number().unwrap() * 0.7 + 0.11),
            };
            let mut node = base.clone();
            node.set_param(i, &other).unwrap_or_else(|error| panic!("{error}"));
            if param.name != "k" || op == "weighted-fbm" {
                assert_ne!(make(node), before, "{op}: `{}` changes nothing", param.name);
            }
        }
    }
}
