//! Properties of windows, texts and files over generated values. A failure is shrunk to a small case. The cases are the
//! same in every run.

#![allow(clippy::field_reassign_with_default, reason = "options may get more fields")]

use orogen::expression::Expression;
use orogen::io::format::crs::{Crs, keys};
use orogen::io::format::geotiff::Options as Layout;
use orogen::io::format::geotiff::writer as geotiff;
use orogen::io::format::levels::Levels;
use orogen::io::format::{Sidecar, asc, exr, import, npy, png, raw};
use orogen::io::palette::fitted::Fitted;
use orogen::io::palette::{color, read};
use orogen::io::spool::Spool;
use orogen::{Grid, Recipe, Window};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseResult, TestRng, TestRunner};
use std::fmt::Debug;
use std::io::Cursor;

/// Runs this number of cases, the same in every run.
fn check<S: Strategy>(cases: u32, strategy: S, test: impl Fn(S::Value) -> TestCaseResult)
where
    S::Value: Debug,
{
    let config = Config { cases, failure_persistence: None, max_shrink_iters: 2000, ..Config::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    TestRunner::new_with_rng(config, rng).run(&strategy, test).unwrap_or_else(|failure| panic!("{failure}"));
}

/// Positions near the origin, and far on both sides.
fn position() -> impl Strategy<Value = i64> {
    prop_oneof![-60i64..60, -(1i64 << 52)..(1 << 52), Just(-(1i64 << 52)), Just(1 << 52)]
}

fn window() -> impl Strategy<Value = Window> {
    (position(), position(), 1usize..40, 1usize..40).prop_map(|(x, y, w, h)| Window::new(w, h, 2.5).at(x, y))
}

/// A window, and another one that may overlap it.
fn neighbors() -> impl Strategy<Value = (Window, Window)> {
    (window(), -50i64..50, -50i64..50, 1usize..40, 1usize..40)
        .prop_map(|(a, dx, dy, w, h)| (a, Window::new(w, h, a.cell).at(a.x + dx, a.y + dy)))
}

/// A number that identifies a position.
fn mark(x: i64, y: i64) -> i64 {
    x.wrapping_mul(1_000_003).wrapping_add(y)
}

/// A grid whose samples identify their positions.
fn marked(window: Window) -> Grid<i64> {
    let at = |k: usize| mark(window.x + (k % window.width) as i64, window.y + (k / window.width) as i64);
    Grid::from_data(window, (0..window.len()).map(at).collect()).unwrap()
}

#[test]
fn windows_obey_the_algebra_of_sets() {
    check(2000, neighbors(), |(a, b)| {
        let (both, all) = (a.intersection(&b), a.union(&b));
        prop_assert_eq!(both.len(), b.intersection(&a).len());
        prop_assert!(all.contains(&a) && all.contains(&b));
        if !both.is_empty() {
            prop_assert!(a.contains(&both) && b.contains(&both));
            prop_assert_eq!(both, b.intersection(&a));
        }
        // Every sample, counted one by one.
        let inside = |window: &Window, x: i64, y: i64| {
            (window.x..window.right()).contains(&x) && (window.y..window.bottom()).contains(&y)
        };
        let count =
            (a.y..a.bottom()).flat_map(|y| (a.x..a.right()).map(move |x| (x, y))).filter(|(x, y)| inside(&b, *x, *y));
        prop_assert_eq!(count.count(), both.len());
        prop_assert_eq!(a.contains(&b), both == b);
        prop_assert_eq!(a.intersection(&all), a);
        Ok(())
    });
}

#[test]
fn a_window_is_grown_and_shrunk_back() {
    check(500, (window(), 0usize..50), |(window, halo)| {
        let grown = window.grown(halo);
        prop_assert_eq!(grown.shrunk(halo), window);
        prop_assert!(grown.contains(&window));
        prop_assert_eq!((grown.right() - window.right(), grown.bottom() - window.bottom()), (halo as i64, halo as i64));
        Ok(())
    });
}

#[test]
fn tiles_cover_every_sample_once() {
    check(500, (window(), 1usize..45), |(window, side)| {
        let tiles: Vec<Window> = window.tiles(side).collect();
        prop_assert_eq!(tiles.iter().map(Window::len).sum::<usize>(), window.len());
        for (k, tile) in tiles.iter().enumerate() {
            prop_assert!(window.contains(tile) && !tile.is_empty());
            prop_assert!(tile.width <= side && tile.height <= side);
            prop_assert!(tiles[..k].iter().all(|other| other.intersection(tile).is_empty()));
        }
        Ok(())
    });
}

#[test]
fn crops_of_crops_are_crops_and_pasted_tiles_are_the_whole() {
    check(300, (neighbors(), 1usize..20), |((a, b), side)| {
        let whole = marked(a.union(&b));
        let (cut, direct) = (whole.crop(&a).unwrap(), a.intersection(&b));
        prop_assert!(cut == marked(a));
        if !direct.is_empty() {
            prop_assert!(cut.crop(&direct) == whole.crop(&direct));
        }
        prop_assert_eq!(cut.crop(&b).is_some(), a.contains(&b));
        let mut pasted = Grid::filled(a, 0);
        for tile in a.tiles(side) {
            pasted.paste(&whole.crop(&tile).unwrap());
        }
        prop_assert!(pasted == cut);
        // Samples outside are not pasted.
        let mut other = Grid::filled(b, 7);
        other.paste(&cut);
        let right = (0..b.len()).all(|k| {
            let (x, y) = (b.x + (k % b.width) as i64, b.y + (k / b.width) as i64);
            let inside = (a.x..a.right()).contains(&x) && (a.y..a.bottom()).contains(&y);
            other.data()[k] == if inside { mark(x, y) } else { 7 }
        });
        prop_assert!(right);
        Ok(())
    });
}

/// Finite numbers of all magnitudes.
fn number() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    prop_oneof![(-2000i32..2000).prop_map(|n| f64::from(n) / 8.0), NORMAL | SUBNORMAL | ZERO | POSITIVE | NEGATIVE]
}

#[test]
fn recipes_are_written_as_they_were_read() {
    let world = (0u64..=i64::MAX as u64, 1.0..1e6f64, 1.0..1e6f64, 0.5..100.0f64, number());
    let nodes = vec((0usize..6, number(), any::<u32>(), "[a-z_][a-z0-9_]{0,8}"), 1..6);
    check(400, (world, nodes, ".{0,60}"), |((seed, width, height, cell, level), nodes, about)| {
        let mut text = format!(
            "orogen = 1\nabout = {}\n[world]\nseed = {seed}\nsize = [{width:?}, {height:?}]\ncell = {cell:?}\nsea_level = {:?}\n",
            serde_json::to_string(&about).unwrap().replace('\u{7f}', "?"),
            level.clamp(-1e6, 1e6)
        );
        let mut last = String::from("1.5");
        for (k, (kind, value, whole, name)) in nodes.iter().enumerate() {
            let name = format!("{name}{k}");
            let value = value.clamp(-1e6, 1e6);
            text.push_str(&format!("[nodes.{name}]\n"));
            text.push_str(&match kind {
                0 => format!("op = \"fbm\"\nwavelength = {:?}\noctaves = {}\n", value.abs().max(0.1), 1 + whole % 16),
                1 => format!("op = \"add\"\na = {last}\nb = {value:?}\n"),
                2 => format!("op = \"clamp\"\nsource = {last}\nlow = -0.25\nhigh = {:?}\n", value.abs()),
                3 => format!("op = \"blur\"\nsource = {last}\nradius = {:?}\n", value.abs().clamp(0.1, 900.0)),
                4 => format!("op = \"expr\"\nexpr = \"a * {:?} + {whole}\"\na = {last}\n", value.abs()),
                _ => format!("op = \"multiply\"\na = {last}\nb = {value:?}\nmask = 0.5\n"),
            });
            last = format!("\"{name}\"");
        }
        text.push_str(&format!("[outputs]\nheight = {last}\n"));
        let recipe =
            Recipe::parse(&text, "generated").map_err(|error| TestCaseError::fail(format!("{error}\n{text}")))?;
        prop_assert_eq!(&recipe.about, &about.replace('\u{7f}', "?"));
        let written = recipe.to_toml();
        let again =
            Recipe::parse(&written, "written").map_err(|error| TestCaseError::fail(format!("{error}\n{written}")))?;
        prop_assert!(again == recipe, "{written}");
        prop_assert_eq!(again.to_toml(), written);
        Ok(())
    });
}

#[test]
fn numbers_are_readable_and_near_what_they_say() {
    check(3000, number(), |value| {
        let text = orogen::grid::words::number(value);
        let read: f64 = text.parse().map_err(|_| TestCaseError::fail(text.clone()))?;
        let error = (read - value).abs();
        prop_assert!(error <= value.abs() * 5.1e-6 || error <= 0.5 && value.abs() >= 1e5, "{} for {:e}", text, value);
        prop_assert!(text.len() <= 24, "{}", text);
        Ok(())
    });
    check(1000, any::<u64>(), |n| {
        let text = orogen::grid::words::bytes(n);
        let (digits, unit) = text.split_once(' ').ok_or_else(|| TestCaseError::fail(text.clone()))?;
        let units = ["bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
        let power = units.iter().position(|known| *known == unit || n == 1 && unit == "byte");
        let power = power.ok_or_else(|| TestCaseError::fail(text.clone()))?;
        let read =
            digits.parse::<f64>().map_err(|_| TestCaseError::fail(text.clone()))? * (1u64 << (10 * power)) as f64;
        prop_assert!((read - n as f64).abs() <= n as f64 * 0.051, "{} for {}", text, n);
        Ok(())
    });
}

/// Stops at ascending heights, each with a color.
fn stops() -> impl Strategy<Value = Vec<(i32, [u8; 3])>> {
    vec((1i32..500, any::<[u8; 3]>()), 2..12).prop_map(|steps| {
        let mut height = -900;
        steps
            .into_iter()
            .map(|(step, rgb)| {
                height += step;
                (height, rgb)
            })
            .collect()
    })
}

#[test]
fn palettes_have_their_colors_at_their_stops() {
    check(300, stops(), |stops| {
        let gdaldem: String = stops.iter().rev().map(|(height, [r, g, b])| format!("{height} {r} {g} {b}\n")).collect();
        let cpt: String = stops
            .windows(2)
            .map(|pair| {
                let line = |(height, [r, g, b]): (i32, [u8; 3])| format!("{height} {r}/{g}/{b}");
                format!("{} {}\n", line(pair[0]), line(pair[1]))
            })
            .collect();
        let own: Vec<String> =
            stops.iter().map(|(height, [r, g, b])| format!("[{height}, \"#{r:02x}{g:02x}{b:02x}\"]")).collect();
        let own = format!("name = \"A\"\nunit = \"m\"\nstops = [{}]\n", own.join(", "));
        for (extension, text) in [("txt", &gdaldem), ("cpt", &cpt), ("toml", &own)] {
            let palette =
                read::parse("it", extension, text).map_err(|why| TestCaseError::fail(format!("{why}\n{text}")))?;
            let fitted = Fitted::new(&palette, -1000.0, 6000.0, 0.0);
            for (height, rgb) in &stops {
                // The table of a palette has entries between its stops, so colors are interpolated there too. In linear
                // light.
                let shown = fitted.at(*height as f32);
                let off = shown.iter().zip(rgb).map(|(light, byte)| (light - color::decode(*byte)).abs());
                let off = off.fold(0.0f32, f32::max);
                prop_assert!(off <= 0.04, "{} at {}: {:?}, not {:?}\n{}", extension, height, shown, rgb, text);
            }
            for height in [-1e9, f32::NAN, 1e9, 12.25] {
                prop_assert!(fitted.at(height).iter().all(|part| (-0.001..=1.001).contains(part)));
            }
        }
        Ok(())
    });
}

#[test]
fn coordinate_systems_are_known_by_code_and_by_text() {
    let code = prop_oneof![
        32601u16..=32660,
        32701u16..=32760,
        25828u16..=25838,
        Just(4326u16),
        Just(3857),
        Just(2056),
        1000u16..33000
    ];
    check(400, code, |code| {
        let Ok(crs) = Crs::from_epsg(code) else { return Ok(()) };
        for text in [
            format!("EPSG:{code}"),
            format!(" epsg::{code} "),
            format!("urn:ogc:def:crs:EPSG::{code}"),
            code.to_string(),
        ] {
            prop_assert_eq!(text.parse::<Crs>(), Ok(crs), "{}", text);
        }
        let named = keys::of_text(&format!("EPSG:{code}"));
        if let Ok(named) = named {
            prop_assert_eq!(keys::epsg(&named), Some(code));
        }
        // A definition is read, or rejected with a reason; what is read can be written and read again.
        if let Ok(told) = keys::of_wkt(crs.wkt())
            && let Ok(wkt) = keys::to_wkt(&told)
        {
            let again = keys::of_wkt(&wkt).map_err(TestCaseError::fail)?;
            prop_assert_eq!(keys::epsg(&again), keys::epsg(&told), "{}", wkt);
        }
        Ok(())
    });
}

/// An expression as a tree.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    Name(usize),
    Negative(Box<Tree>),
    Binary(&'static str, Box<Tree>, Box<Tree>),
    Call(&'static str, Vec<Tree>),
}

const NAMES: [&str; 3] = ["a", "b.c", "x2"];

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        prop_oneof![Just(0.0), Just(0.5), Just(1.0), Just(2.0), Just(3.0), Just(4.0), 0.0..100.0f64]
            .prop_map(Tree::Number),
        (0..NAMES.len()).prop_map(Tree::Name),
    ];
    leaf.prop_recursive(5, 40, 3, |inner| {
        let signs = proptest::sample::select(vec!["+", "-", "*", "/", "%", "^", "<", "<=", ">", ">=", "==", "!="]);
        let pair = (signs, inner.clone(), inner.clone());
        let calls = proptest::sample::select(vec![
            ("abs", 1),
            ("sign", 1),
            ("floor", 1),
            ("ceil", 1),
            ("round", 1),
            ("fract", 1),
            ("sqrt", 1),
            ("exp", 1),
            ("sin", 1),
            ("min", 2),
            ("max", 4),
            ("step", 2),
            ("hypot", 2),
            ("pow", 2),
            ("clamp", 3),
            ("mix", 3),
            ("lerp", 3),
            ("smoothstep", 3),
        ]);
        prop_oneof![
            inner.clone().prop_map(|tree| Tree::Negative(Box::new(tree))),
            pair.prop_map(|(sign, left, right)| Tree::Binary(sign, Box::new(left), Box::new(right))),
            (calls, vec(inner, 4)).prop_map(|((name, arity), all)| Tree::Call(name, all[..arity].to_vec())),
        ]
    })
}

impl Tree {
    /// The text, with parentheses everywhere if `all`, otherwise only where precedence requires them.
    fn text(&self, all: bool) -> String {
        let part = |tree: &Tree, least: u8| {
            let text = tree.text(all);
            if all || tree.precedence() < least { format!("({text})") } else { text }
        };
        match self {
            Tree::Number(number) => number.to_string(),
            Tree::Name(name) => NAMES[*name].to_string(),
            Tree::Negative(tree) => format!("-{}", part(tree, 3)),
            Tree::Call(name, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(|tree| tree.text(all)).collect();
                format!("{name}({})", arguments.join(", "))
            }
            // Right associative; a sign in the exponent needs no parentheses.
            Tree::Binary("^", left, right) => format!("{} ^ {}", part(left, 5), part(right, 3)),
            Tree::Binary(sign, left, right) => {
                let own = self.precedence();
                // Comparisons do not chain.
                let least = if own == 0 { 1 } else { own };
                format!("{} {sign} {}", part(left, least), part(right, own + 1))
            }
        }
    }

    fn precedence(&self) -> u8 {
        match self {
            Tree::Number(_) | Tree::Name(_) | Tree::Call(..) => 5,
            Tree::Binary("^", ..) => 4,
            Tree::Negative(_) => 3,
            Tree::Binary("*" | "/" | "%", ..) => 2,
            Tree::Binary("+" | "-", ..) => 1,
            Tree::Binary(..) => 0,
        }
    }

    /// The number, including signs; `None` if the tree is not a number.
    fn literal(&self) -> Option<f64> {
        match self {
            Tree::Number(number) => Some(*number),
            Tree::Negative(tree) => tree.literal().map(|number| -number),
            _ => None,
        }
    }

    fn value(&self, names: &[f64; 3]) -> f64 {
        let truth = |is: bool| if is { 1.0 } else { 0.0 };
        let power = |left: &Tree, right: &Tree| {
            let base = left.value(names);
            match right.literal() {
                Some(1.0) => base,
                Some(2.0) => base * base,
                Some(3.0) => base * base * base,
                Some(4.0) => (base * base) * (base * base),
                Some(0.5) => base.sqrt(),
                Some(-1.0) => 1.0 / base,
                _ => libm::pow(base, right.value(names)),
            }
        };
        match self {
            Tree::Number(number) => *number,
            Tree::Name(name) => names[*name],
            Tree::Negative(tree) => -tree.value(names),
            Tree::Binary("^", left, right) => power(left, right),
            Tree::Binary(sign, left, right) => {
                let (a, b) = (left.value(names), right.value(names));
                match *sign {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a / b,
                    "%" => a - b * (a / b).floor(),
                    "<" => truth(a < b),
                    "<=" => truth(a <= b),
                    ">" => truth(a > b),
                    ">=" => truth(a >= b),
                    "==" => truth(a == b),
                    _ => truth(a != b),
                }
            }
            Tree::Call("pow", arguments) => power(&arguments[0], &arguments[1]),
            Tree::Call(name, arguments) => {
                let given: Vec<f64> = arguments.iter().map(|tree| tree.value(names)).collect();
                match (*name, given.as_slice()) {
                    ("abs", [a]) => a.abs(),
                    ("sign", [a]) if *a > 0.0 => 1.0,
                    ("sign", [a]) if *a < 0.0 => -1.0,
                    ("sign", _) => 0.0,
                    ("floor", [a]) => a.floor(),
                    ("ceil", [a]) => a.ceil(),
                    ("round", [a]) => a.round(),
                    ("fract", [a]) => a - a.floor(),
                    ("sqrt", [a]) => a.sqrt(),
                    ("exp", [a]) => libm::exp(*a),
                    ("sin", [a]) => libm::sin(*a),
                    ("min", all) => {
                        all[1..].iter().fold(all[0], |least, next| if least < *next { least } else { *next })
                    }
                    ("max", all) => all[1..].iter().fold(all[0], |most, next| if most > *next { most } else { *next }),
                    ("step", [edge, x]) => truth(x >= edge),
                    ("hypot", [a, b]) => libm::hypot(*a, *b),
                    ("clamp", [a, low, high]) => {
                        let raised = if a < low { *low } else { *a };
                        if raised > *high { *high } else { raised }
                    }
                    ("mix", [a, b, t]) => a + (b - a) * t.clamp(0.0, 1.0),
                    ("lerp", [a, b, t]) => a + (b - a) * t,
                    ("smoothstep", [low, high, x]) => {
                        let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
                        t * t * (3.0 - 2.0 * t)
                    }
                    (other, _) => panic!("{other} is not known here"),
                }
            }
        }
    }
}

#[test]
fn expressions_are_what_a_naive_evaluator_makes_of_them() {
    let values = [(); 3].map(|()| prop_oneof![Just(0.0), Just(-1.0), -50.0..50.0f64]);
    check(1500, (tree(), values), |(tree, values)| {
        let expected = tree.value(&values);
        for all in [false, true] {
            let text = tree.text(all);
            let expression = Expression::from(text.as_str());
            prop_assert!(expression.error().is_none(), "{}: {:?}", text, expression.error());
            let given: Vec<f64> = expression
                .names()
                .iter()
                .map(|name| values[NAMES.iter().position(|known| known == name).unwrap()])
                .collect();
            let value = expression.value(&given).unwrap();
            let same = value == expected || value.is_nan() && expected.is_nan();
            prop_assert!(same, "{}: {} instead of {}", text, value, expected);
        }
        Ok(())
    });
}

/// Any text is an expression, or gives an error at a position within the text.
#[test]
fn errors_of_expressions_are_within_their_text() {
    check(2000, "[-+*/^%(),<=> a-c0-9.éx]{0,24}", |text| {
        let expression = Expression::from(text.as_str());
        match expression.error() {
            None => prop_assert!(expression.value(&vec![0.5; expression.names().len()]).is_some()),
            Some(error) => {
                prop_assert!(!error.message.is_empty());
                prop_assert!(error.span.start <= error.span.end && error.span.start <= text.len(), "{:?}", error);
            }
        }
        Ok(())
    });
}

/// Grids of odd sizes with samples of all magnitudes.
fn grid(sample: impl Strategy<Value = f32> + Clone) -> impl Strategy<Value = Grid> {
    let side = || prop_oneof![Just(1usize), Just(2), 1usize..70, Just(64), Just(65)];
    (side(), side()).prop_flat_map(move |(width, height)| {
        let data = vec(sample.clone(), width * height);
        data.prop_map(move |data| Grid::from_data(Window::new(width, height, 10.0), data).unwrap())
    })
}

fn finite() -> impl Strategy<Value = f32> + Clone {
    use proptest::num::f32::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    // Larger numbers mean "no data" to readers.
    let any = (NORMAL | SUBNORMAL | ZERO | POSITIVE | NEGATIVE).prop_filter("heights", |number| number.abs() < 1e30);
    prop_oneof![-2000.0f32..2000.0, any]
}

fn heights_of(bytes: &[u8], extension: &str, sidecar: &Sidecar) -> Result<(usize, usize, Vec<f32>), TestCaseError> {
    let dem = import::parse(&mut Cursor::new(bytes), "it", extension, Some(sidecar.clone()), 1 << 24);
    let dem = dem.map_err(|error| TestCaseError::fail(error.to_string()))?;
    Ok((dem.width, dem.height, dem.heights))
}

fn same_bits(grid: &Grid, read: &(usize, usize, Vec<f32>)) -> TestCaseResult {
    prop_assert_eq!((grid.width(), grid.height()), (read.0, read.1));
    let differ = grid.data().iter().zip(&read.2).position(|(a, b)| a.to_bits() != b.to_bits());
    prop_assert_eq!(differ.map(|k| (grid.data()[k], read.2[k])), None);
    Ok(())
}

fn sidecar(grid: &Grid) -> Sidecar {
    let mut sidecar = Sidecar::default();
    (sidecar.width, sidecar.height) = (Some(grid.width() as u64), Some(grid.height() as u64));
    sidecar.cell = Some(10.0);
    sidecar
}

#[test]
fn files_of_floats_have_the_same_bits() {
    check(60, grid(finite()), |grid| {
        let told = sidecar(&grid);
        let mut bytes = Vec::new();
        npy::write(&mut bytes, &grid).unwrap();
        same_bits(&grid, &heights_of(&bytes, "npy", &told)?)?;
        bytes.clear();
        raw::write_r32(&mut bytes, &grid).unwrap();
        same_bits(&grid, &heights_of(&bytes, "r32", &told)?)?;
        bytes.clear();
        let picture = exr::Picture {
            width: grid.width(),
            height: grid.height(),
            channels: vec!["height".into()],
            sample: exr::Sample::Float,
            comments: String::new(),
        };
        let mut writer = exr::Writer::new(picture, Spool::in_memory()).unwrap();
        writer.rows(&[grid.data()]).unwrap();
        writer.finish(&mut bytes).unwrap();
        same_bits(&grid, &heights_of(&bytes, "exr", &told)?)?;
        for (tile, big) in [(None, false), (Some(16), false), (Some(32), true)] {
            bytes.clear();
            let mut layout = Layout::default();
            (layout.tile, layout.big) = (tile, big);
            geotiff::write(&mut bytes, &grid, &layout, Spool::in_memory()).unwrap();
            same_bits(&grid, &heights_of(&bytes, "tif", &Sidecar::default())?)?;
        }
        // The nodata value is a number that heights cannot have in this format.
        if grid.data().iter().all(|height| *height != -9999.0) {
            bytes.clear();
            asc::write(&mut bytes, &grid).unwrap();
            same_bits(&grid, &heights_of(&bytes, "asc", &Sidecar::default())?)?;
        }
        Ok(())
    });
}

#[test]
fn files_of_whole_numbers_have_the_same_levels() {
    check(80, (grid(-2000.0f32..2000.0), -2000.0f32..0.0, 100.0f32..2000.0), |(grid, low, span)| {
        let levels = Levels::new(low, low + span);
        let mut told = sidecar(&grid);
        (told.low, told.high) = (Some(f64::from(levels.low())), Some(f64::from(levels.high())));
        let (mut r16, mut picture) = (Vec::new(), Vec::new());
        raw::write_r16(&mut r16, &grid, &levels).unwrap();
        png::write_grey16(&mut picture, &grid, &levels, &[("Title", "a")]).unwrap();
        for (extension, bytes) in [("r16", &r16), ("png", &picture)] {
            let (width, height, read) = heights_of(bytes, extension, &told)?;
            prop_assert_eq!((width, height), (grid.width(), grid.height()));
            let differ = grid.data().iter().zip(&read).position(|(a, b)| levels.to_u16(*a) != levels.to_u16(*b));
            prop_assert_eq!(differ, None, "{}", extension);
        }
        Ok(())
    });
}
