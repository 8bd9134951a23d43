//! The position of the terrain of levelled ops, and its rivers.

use orogen_engine::{Grid, Options, Progress, Recipe, Window, World};

/// Mountains solved at 480 m and refined `halvings` times, and `details` times further.
fn ranges(halvings: u32, details: u32) -> World {
    let cell = 480.0 / f64::from(1 << halvings);
    let text = format!(
        r#"
orogen = 1
world = {{ seed = 3, size = 46080.0, cell = {cell} }}
[nodes.lift]
op = "fbm"
wavelength = 20000.0
octaves = 2
[nodes.uplift]
op = "expr"
expr = "exp(lift * 2.0)"
[nodes.ranges]
op = "stream-power"
source = 300.0
uplift_factor = "uplift"
cell = 480.0
margin = 9600.0
years = 5e6
steps = 40
erodibility = 6e-6
uplift = 0.7
talus_angle = 45.0
jitter = 0.0
[nodes.terrain]
op = "amplify"
source = "ranges"
flow = "ranges.flow"
uplift = "uplift"
cell = {cell}
halvings = {halvings}
details = {details}
[outputs]
height = "terrain"
ranges = "ranges"
"#
    );
    World::open(Recipe::parse(&text, "ranges").unwrap()).unwrap()
}

/// The shift of `land` against `reference`, in samples: the least squares fit of reference - shift * gradient, with a
/// factor and an offset of heights.
fn shift(land: &Grid, reference: &Grid) -> [f64; 2] {
    let (width, height) = (land.width(), land.height());
    // Sums for the normal equations of the unknowns shift east, shift south, factor and offset.
    let mut sums = [[0.0f64; 5]; 4];
    for j in 1..height - 1 {
        for i in 1..width - 1 {
            let at = |i: usize, j: usize| f64::from(reference[(i, j)]);
            let east = (at(i + 1, j) - at(i - 1, j)) / 2.0;
            let south = (at(i, j + 1) - at(i, j - 1)) / 2.0;
            let row = [-east, -south, at(i, j), 1.0, f64::from(land[(i, j)])];
            for (sums, left) in sums.iter_mut().zip(row) {
                sums.iter_mut().zip(row).for_each(|(sum, right)| *sum += left * right);
            }
        }
    }
    for pivot in 0..4 {
        let of = sums[pivot];
        for row in sums.iter_mut().skip(pivot + 1) {
            let factor = row[pivot] / of[pivot];
            row.iter_mut().zip(of).for_each(|(sum, of)| *sum -= factor * of);
        }
    }
    let mut solved = [0.0; 4];
    for row in (0..4).rev() {
        let known: f64 = (row + 1..4).map(|k| sums[row][k] * solved[k]).sum();
        solved[row] = (sums[row][4] - known) / sums[row][row];
    }
    [solved[0], solved[1]]
}

#[test]
fn every_level_lies_where_its_source_lies() {
    for (halvings, details) in [(1u32, 0u32), (2, 1), (3, 0), (1, 2)] {
        let world = ranges(halvings, details);
        for level in 0..=halvings + details {
            let cell = 480.0 / f64::from(1 << level);
            let samples = 96 << level;
            let window = Window::new(samples, samples, cell);
            let grids = world.grids(&["height", "ranges"], &window, &Progress::none()).unwrap();
            let [east, south] = shift(&grids[0], &grids[1]).map(|samples| samples * cell / 480.0);
            assert!(
                east.abs() < 0.06 && south.abs() < 0.06,
                "{halvings} halvings, {details} details, level {level}: {east:.3}, {south:.3}"
            );
        }
    }
}

#[test]
fn rivers_have_a_width_and_a_depth_that_follow_from_their_area() {
    let text = r#"
orogen = 1
world = { seed = 3, cell = 240.0 }
[nodes.land]
op = "continents"
cell = 240.0
halvings = 9
stream = 4e6
runoff = 0.8
[outputs]
height = "land"
flow = "land.flow"
surface = "land.surface"
width = "land.width"
depth = "land.depth"
"#;
    let world = World::open(Recipe::parse(text, "rivers").unwrap()).unwrap();
    let window = Window::new(200, 200, 240.0).at(-100, -100);
    let names = ["height", "flow", "surface", "width", "depth"];
    let grids = world.grids(&names, &window, &Progress::none()).unwrap();
    let [height, flow, surface, width, depth] = [0, 1, 2, 3, 4].map(|k| grids[k].data());
    let mut rivers = 0;
    for q in 0..window.len() {
        let discharge = f64::from(flow[q]) * 0.8 / 31_557_600.0;
        let is_river = flow[q] >= 4e6 && surface[q] == height[q];
        rivers += usize::from(is_river);
        let wanted = if is_river { [5.0 * discharge.sqrt(), 0.3 * libm::pow(discharge, 0.4)] } else { [0.0; 2] };
        for (value, wanted) in [(width[q], wanted[0]), (depth[q], wanted[1])] {
            assert!((f64::from(value) - wanted).abs() <= 1e-5 * wanted, "{value} m, not {wanted}");
        }
    }
    assert!((100..window.len() / 2).contains(&rivers), "{rivers} cells of rivers");
}

#[test]
fn windows_of_detail_levels_are_crops_of_larger_ones_with_inputs_read_down_to_the_cell_of_valleys() {
    let text = r#"
orogen = 1
world = { seed = 3, cell = 60.0 }
[nodes.swells]
op = "fbm"
wavelength = 90000.0
octaves = 3
[nodes.shore]
op = "expr"
expr = "swells * 20000 + 30000"
[nodes.land]
op = "continents"
shore = "shore"
uplift = 1.5
halvings = 8
details = 5
[outputs]
height = "land"
flow = "land.flow"
receiver = "land.receiver"
"#;
    let names = ["height", "flow", "receiver"];
    let open = |threads: usize| {
        let options = Options { threads: Some(threads), ..Options::default() };
        World::with_options(Recipe::parse(text, "details").unwrap(), options).unwrap()
    };
    // A cell of a level and a cell between two levels, near the origin and far away, with an odd size.
    for (cell, at) in [(3.75, (-91, 33)), (2.0, (1_000_000_007, -2_000_000_011))] {
        let whole = Window::new(153, 131, cell).at(at.0, at.1);
        let grids = open(2).grids(&names, &whole, &Progress::none()).unwrap();
        let part = Window::new(40, 37, cell).at(at.0 + 101, at.1 + 60);
        let alone = open(1).grids(&names, &part, &Progress::none()).unwrap();
        for (grid, alone) in grids.iter().zip(&alone) {
            assert_eq!(grid.crop(&part).unwrap(), *alone, "{cell} m");
        }
        assert!(grids[0].data().iter().all(|height| height.is_finite()));
    }
}

#[test]
fn a_binding_shore_holds_on_detail_levels_in_every_window() {
    let text = r#"
orogen = 1
world = { seed = 3, cell = 60.0 }
[nodes.swells]
op = "fbm"
wavelength = 90000.0
octaves = 3
[nodes.shore]
op = "expr"
expr = "swells * 20000"
[nodes.land]
op = "continents"
shore = "shore"
uplift = 1.5
halvings = 8
details = 5
shore_details = 4
[outputs]
height = "land"
surface = "land.surface"
receiver = "land.receiver"
shore = "shore"
"#;
    let open = |threads: usize| {
        let options = Options { threads: Some(threads), ..Options::default() };
        World::with_options(Recipe::parse(text, "details").unwrap(), options).unwrap()
    };
    let world = open(2);
    // The first shore on the line y = 0, east of the origin.
    let line = world.grids(&["shore"], &Window::new(2000, 1, 60.0), &Progress::none()).unwrap();
    let is_land = |i: usize| line[0][(i, 0)] > 0.0;
    let coast = (1..2000).find(|&i| is_land(i) != is_land(i - 1)).unwrap() as f64 * 60.0;
    // Cells of levels and a cell between two levels.
    for cell in [60.0, 15.0, 5.0, 3.75] {
        let whole = Window::new(143, 121, cell).at((coast / cell) as i64 - 71, -60);
        let names = ["surface", "height", "receiver", "shore"];
        let grids = world.grids(&names, &whole, &Progress::none()).unwrap();
        let (mut land, mut wrong) = (0, 0);
        for (surface, shore) in grids[0].data().iter().zip(grids[3].data()) {
            land += usize::from(*surface > 0.0);
            // The shore changes by at most 1.4 m a metre.
            wrong += usize::from((*surface > 0.0) != (*shore > 0.0) && f64::from(shore.abs()) > 2.0 * cell);
        }
        assert!((100..whole.len() - 100).contains(&land) && wrong * 500 < whole.len(), "{cell} m: {land}, {wrong}");
        let part = Window::new(40, 37, cell).at(whole.x + 51, whole.y + 47);
        let alone = open(1).grids(&names, &part, &Progress::none()).unwrap();
        for (grid, alone) in grids.iter().zip(&alone) {
            assert_eq!(grid.crop(&part).unwrap(), *alone, "{cell} m");
        }
    }
}

#[test]
fn floods_and_sediment_are_along_rivers_and_not_in_standing_water() {
    let text = r#"
orogen = 1
world = { seed = 3, cell = 60.0 }
[nodes.land]
op = "continents"
details = 3
[outputs]
height = "land"
flow = "land.flow"
surface = "land.surface"
depth = "land.depth"
floodplain = "land.floodplain"
sediment = "land.sediment"
"#;
    let world = World::open(Recipe::parse(text, "floods").unwrap()).unwrap();
    let names = ["height", "flow", "surface", "depth", "floodplain", "sediment"];
    // At the sea: at a coarse cell, at the cell of valleys and at a fine one.
    for (cell, x, y) in [(960.0, -400, -300), (60.0, 10, -40), (7.5, 80, -320)] {
        let window = Window::new(300, 300, cell).at(x, y);
        let grids = world.grids(&names, &window, &Progress::none()).unwrap();
        let [height, flow, surface, depth, flood, sediment] = [0, 1, 2, 3, 4, 5].map(|k| grids[k].data());
        let (mut flooded, mut water) = (0, 0);
        for q in 0..window.len() {
            assert!(
                flood[q] >= 4.0 * depth[q] * 0.999 && flood[q] < 80.0,
                "{} m of flood at {} m",
                flood[q],
                height[q]
            );
            assert!((0.0..100.0).contains(&sediment[q]), "{} m of sediment", sediment[q]);
            flooded += usize::from(flood[q] > 0.0 && flow[q] < 1e6);
            if surface[q] > height[q] || height[q] < 0.0 {
                water += 1;
                assert_eq!([flood[q], sediment[q]], [0.0; 2], "floods or sediment in water at {cell} m");
            }
        }
        assert!(flooded > 0 || cell > 60.0, "{flooded} samples beside rivers are flooded, {water} are water");
        // A window on its own.
        let part = Window::new(70, 50, cell).at(x + 111, y + 90);
        for (whole, part) in grids.iter().zip(world.grids(&names, &part, &Progress::none()).unwrap()) {
            assert!(whole.crop(part.window()).unwrap() == part, "a crop differs at {cell} m");
        }
    }
}

/// An island by `stream-power` at 480 m, refined to 60 m with a sea, at a sea level of 120 m.
fn island(details: u32) -> World {
    let text = format!(
        r#"
orogen = 1
world = {{ seed = 5, size = 61440.0, cell = 60.0, sea_level = 120.0 }}
[nodes.dome]
op = "radial"
center = [30720.0, 30720.0]
radius = 30000.0
[nodes.ragged]
op = "fbm"
wavelength = 24000.0
octaves = 7
[nodes.lift]
op = "expr"
expr = "clamp(dome * 1.6 - 0.5 + 0.5 * ragged, 0.02, 1)"
[nodes.start]
op = "expr"
expr = "900 * dome - 250 + 300 * ragged"
[nodes.ranges]
op = "stream-power"
source = "start"
uplift_factor = "lift"
cell = 480.0
years = 4e6
steps = 60
erodibility = 6e-6
uplift = 0.7
talus_angle = 45.0
jitter = 0.0
[nodes.terrain]
op = "amplify"
source = "ranges"
flow = "ranges.flow"
uplift = "lift"
cell = 60.0
halvings = 3
details = {details}
sea = true
[outputs]
height = "terrain"
surface = "terrain.surface"
receiver = "terrain.receiver"
lake = "terrain.lake"
flow = "terrain.flow"
ranges = "ranges"
"#
    );
    World::open(Recipe::parse(&text, "island").unwrap()).unwrap()
}

#[test]
fn rivers_of_amplified_land_end_at_the_shore_of_its_sea() {
    const SIDE: usize = 1000;
    let window = Window::new(SIDE, SIDE, 60.0).at(12, 12);
    let names = ["height", "surface", "receiver", "lake", "ranges"];
    let grids = island(0).grids(&names, &window, &Progress::none()).unwrap();
    let [height, surface, receiver, lake, ranges] = [0, 1, 2, 3, 4].map(|k| grids[k].data());
    let is_water = |q: usize| surface[q] > height[q];
    let (mut land, mut sea) = (0, 0);
    for q in 0..window.len() {
        if is_water(q) {
            assert_eq!(receiver[q], 8.0);
            sea += usize::from(lake[q] == 0.0);
            assert!(lake[q] > 0.0 || surface[q] == 120.0, "a sea at {} m", surface[q]);
            continue;
        }
        land += 1;
        assert!(height[q] >= 120.0, "land at {} m", height[q]);
        let (mut at, mut links) = (q, 0);
        while !is_water(at) {
            let code = receiver[at] as usize;
            assert!(code < 8 && links < 20_000, "a pit at {} m", height[at]);
            let (x, y) = ((at % SIDE) as i64, (at / SIDE) as i64);
            let [east, south] = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]][code];
            let (x, y) = (x + east, y + south);
            if !(0..SIDE as i64).contains(&x) || !(0..SIDE as i64).contains(&y) {
                break;
            }
            (at, links) = (y as usize * SIDE + x as usize, links + 1);
        }
    }
    assert!(land > 200_000 && sea > 200_000, "{land} samples of land, {sea} of sea");

    // The shore is within a coarse cell of the source's shore, and the sea is as deep.
    let (mut far, mut deep, mut error) = (0, 0.0f64, 0.0f64);
    for j in (8..SIDE - 8).step_by(3) {
        for i in (8..SIDE - 8).step_by(3) {
            let q = j * SIDE + i;
            let sea = is_water(q) && lake[q] == 0.0;
            let mut around = (j - 8..=j + 8).flat_map(|j| (i - 8..=i + 8).map(move |i| j * SIDE + i));
            far += usize::from(!around.any(|q| (ranges[q] <= 120.0) == sea));
            if ranges[q] < 80.0 {
                deep += 1.0;
                error += f64::from(height[q] - ranges[q]).abs() / f64::from(120.0 - ranges[q]);
            }
        }
    }
    assert!(far < 100, "{far} samples are further than a cell of the source from its shore");
    assert!(error < 0.1 * deep, "the sea differs by {} of its depth", error / deep);
}

#[test]
fn windows_of_amplified_land_with_a_sea_are_crops_of_larger_ones() {
    let names = ["height", "surface", "flow", "receiver"];
    for (cell, x, y) in [(240.0, 15, 20), (60.0, 100, 300), (15.0, 600, 1500)] {
        let whole = Window::new(220, 230, cell).at(x, y);
        let part = Window::new(80, 60, cell).at(x + 91, y + 120);
        let [whole, part] = [whole, part].map(|window| island(2).grids(&names, &window, &Progress::none()).unwrap());
        for (whole, part) in whole.iter().zip(&part) {
            assert!(whole.crop(part.window()).as_ref() == Some(part), "a crop differs at {cell} m");
        }
    }
}
