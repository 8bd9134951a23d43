//! `orogen refine`: real places at a smaller cell.

use crate::harness::{Folder, npy};
use orogen::Grid;

/// An eroded range at a cell of 60 m, on the map.
const RANGE: &str = r#"
orogen = 1
[world]
size = [7200, 6000]
cell = 60
crs = "EPSG:32632"
origin = [500000, 5200000]
[nodes.noise]
op = "fbm"
wavelength = 5000
[nodes.land]
op = "remap"
source = "noise"
to = [200, 600]
[nodes.range]
op = "stream-power"
source = "land"
years = 2e6
steps = 40
uplift = 0.6
jitter = 0
[nodes.rivers]
op = "drainage"
source = "range"
[outputs]
height = "range"
flow = "rivers.flow"
"#;

const HALVINGS: usize = 3;
const FINE: usize = 1 << HALVINGS;

fn with_place() -> Folder {
    let folder = Folder::with_solutions();
    folder.write("range.toml", RANGE);
    folder.good(&["export", "range.toml", "-o", "place.tif", "-q"]);
    folder
}

#[test]
fn a_refined_place_keeps_its_heights_and_its_rivers() {
    let folder = with_place();
    for (layer, name) in [("height", "coarse.npy"), ("flow", "coarse-flow.npy")] {
        folder.good(&["export", "range.toml", "--layer", layer, "-o", name, "-q"]);
        let name = name.replace("coarse", "fine");
        folder.good(&["refine", "place.tif", "--layer", layer, "-o", &name, "-q"]);
    }
    let [coarse, fine, coarse_flow, fine_flow] =
        ["coarse.npy", "fine.npy", "coarse-flow.npy", "fine-flow.npy"].map(|name| npy(&folder.read(name)));
    let (columns, rows) = (coarse.width(), coarse.height());
    assert_eq!((fine.width(), fine.height()), (FINE * columns, FINE * rows));
    // The mean of the new heights around each sample, and the largest new drainage area around each river.
    let (mut squares, mut count, mut kept, mut rivers) = (0.0, 0.0, 0, 0);
    for j in 3..rows - 3 {
        for i in 3..columns - 3 {
            let around = |reach: usize| {
                let rows = FINE * j - reach..=FINE * j + reach;
                rows.flat_map(move |y| (FINE * i - reach..=FINE * i + reach).map(move |x| (x, y)))
            };
            let mean = around(FINE / 2).map(|q| f64::from(fine[q])).sum::<f64>() / ((FINE + 1) * (FINE + 1)) as f64;
            let error = mean - f64::from(coarse[(i, j)]);
            squares += error * error;
            count += 1.0;
            if coarse_flow[(i, j)] > 5e5 {
                rivers += 1;
                let largest = around(FINE).map(|q| fine_flow[q]).fold(0.0, f32::max);
                kept += usize::from((0.5..2.0).contains(&(largest / coarse_flow[(i, j)])));
            }
        }
    }
    let relief =
        coarse.data().iter().copied().fold(f32::MIN, f32::max) - coarse.data().iter().copied().fold(f32::MAX, f32::min);
    let error = (squares / count).sqrt();
    assert!(error < 0.02 * f64::from(relief), "heights differ by {error} m on average; the relief is {relief} m");
    assert!(rivers > 200 && kept * 10 >= rivers * 9, "{kept} of {rivers} samples of rivers have a river");
}

#[test]
fn a_refined_place_lies_where_it_was() {
    let folder = with_place();
    folder.good(&["refine", "place.tif", "--cell", "15", "-o", "fine.asc", "-q"]);
    folder.good(&["export", "place.tif", "--cell", "15", "-o", "same.asc", "-q"]);
    let head = |name: &str| folder.text(name).lines().take(5).map(String::from).collect::<Vec<_>>();
    assert_eq!(head("fine.asc"), head("same.asc"));
    assert_eq!(folder.text("fine.prj"), folder.text("same.prj"));
    // Windows have the same heights as the whole.
    folder.good(&["refine", "place.tif", "--cell", "15", "-o", "whole.npy", "-q"]);
    let part = ["--window", "33,50,40,20"];
    folder.good(&[&["refine", "place.tif", "--cell", "15", "-o", "part.npy", "-q"], &part[..]].concat());
    let (whole, part) = (npy(&folder.read("whole.npy")), npy(&folder.read("part.npy")));
    for j in 0..20 {
        assert_eq!(part.row(j), &whole.row(50 + j)[33..73]);
    }
}

#[test]
fn the_recipe_of_a_refined_place_makes_the_same_land() {
    let folder = with_place();
    folder.good(&["refine", "place.tif", "--cell", "15", "-o", "fine.npy", "-q"]);
    let told = folder.good(&["refine", "place.tif", "--cell", "15", "-o", "fine.toml"]);
    assert!(told.text().contains("orogen export fine.toml"), "{}", told.text());
    folder.good(&["check", "fine.toml", "-q"]);
    folder.good(&["export", "fine.toml", "-o", "again.npy", "-q"]);
    assert!(folder.read("again.npy") == folder.read("fine.npy"));
}

#[test]
fn learned_detail_is_drained_and_depends_on_noise_and_seed() {
    let folder = with_place();
    let learned = |name: &str, more: &[&str]| {
        folder
            .good(&[&["refine", "place.tif", "--detail", "learned", "--cell", "30", "-o", name, "-q"], more].concat());
        npy(&folder.read(name))
    };
    let [draw, again, other, likely] = [
        learned("a.npy", &[]),
        learned("b.npy", &["--noise", "1", "--threads", "1"]),
        learned("c.npy", &["--seed", "5"]),
        learned("d.npy", &["--noise", "0"]),
    ];
    assert!(draw == again);
    let apart = |a: &Grid, b: &Grid| {
        let sum: f64 = a.data().iter().zip(b.data()).map(|(a, b)| f64::from((a - b).abs())).sum();
        sum / a.data().len() as f64
    };
    assert!(apart(&draw, &other) > apart(&draw, &likely) && apart(&draw, &likely) > 0.2);
    // Inside there is no sample below all its neighbors.
    let is_pit = |i: usize, j: usize| {
        let mut around = (j - 1..=j + 1).flat_map(|y| (i - 1..=i + 1).map(move |x| (x, y))).filter(|at| *at != (i, j));
        around.all(|at| draw[at] > draw[(i, j)])
    };
    for j in 1..draw.height() - 1 {
        assert!((1..draw.width() - 1).all(|i| !is_pit(i, j)), "row {j} has a depression");
    }
    folder.good(&["refine", "place.tif", "--detail", "learned", "--cell", "30", "-o", "fine.toml", "-q"]);
    folder.good(&["export", "fine.toml", "-o", "e.npy", "-q"]);
    assert!(folder.read("e.npy") == folder.read("a.npy"));
}

#[test]
fn other_networks_are_read_and_broken_ones_refused() {
    let folder = with_place();
    let network = include_bytes!("../../../../fuzz/corpus/network/small.network");
    std::fs::write(folder.path("small.network"), network).unwrap();
    std::fs::write(folder.path("short.network"), &network[..400]).unwrap();
    let learned = ["refine", "place.tif", "--detail", "learned", "--cell", "30", "-q"];
    folder.good(&[&learned[..], &["--network", "small.network", "-o", "small.npy"]].concat());
    folder.good(&[&learned[..], &["-o", "own.npy"]].concat());
    assert!(folder.read("small.npy") != folder.read("own.npy"));
    for (network, expect) in [
        ("short.network", "short.network: not a network for learned detail: it has"),
        ("place.tif", "not a network for learned detail"),
        ("none.network", "none.network"),
    ] {
        folder.bad(&[&learned[..], &["--network", network, "-o", "a.npy"]].concat(), 1, expect);
    }
    folder.bad(&[&learned[..], &["--noise", "3", "-o", "a.npy"]].concat(), 2, "it must be a number from 0 to 2");
    for option in [["--noise", "0"], ["--network", "small.network"]] {
        let rivers = [&["refine", "place.tif", "-o", "a.npy"], &option[..]].concat();
        folder.bad(&rivers, 2, &format!("{} applies to --detail learned", option[0]));
    }
}

#[test]
fn what_cannot_be_refined_is_refused() {
    let folder = with_place();
    for (arguments, code, expect) in [
        (&["range.toml", "-o", "a.tif"][..], 2, "`refine` needs a file of heights"),
        (&["hills", "-o", "a.tif"], 2, "`refine` needs a file of heights"),
        (&["-", "-o", "a.tif"], 2, "`refine` needs a file of heights"),
        (&["place.tif", "-o", "a.tif", "--cell", "60"], 2, "can be refined to cells of"),
        (&["place.tif", "-o", "a.tif", "--cell", "0.01"], 2, "can be refined to cells of"),
        (&["place.tif", "-o", "a.tif", "--set", "relief=2"], 2, "which has no parameters to set"),
        (&["place.tif", "-o", "a.tif", "--layer", "nonsense"], 2, "nonsense"),
        (&["place.tif", "-o", "place.tif"], 1, "this command reads that file"),
    ] {
        folder.bad(&[&["refine"], arguments].concat(), code, expect);
    }
    assert!(!folder.path("a.tif").exists());
}
