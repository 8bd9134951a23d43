//! Exact shares: in memory, on disk, with ties and without values.

use orogen_engine::field::{Expr, Fbm, Multiply};
use orogen_engine::solver::SelectShare;
use orogen_engine::{Budget, Options, Progress, Recipe, Window, World, WorldSpec};

/// A world of 300 x 230 samples at 10 m with a mask of a share of the node `land`.
fn recipe(seed: u64, land: Expr, share: SelectShare) -> Recipe {
    let spec = WorldSpec::default().with_seed(seed).with_size(Some([3000.0, 2300.0])).with_cell(10.0);
    let mut recipe = Recipe::new(spec);
    recipe.add("noise", Fbm { wavelength: 400.0, octaves: 4, ..Fbm::default() });
    recipe.add("hills", Multiply { a: "noise".into(), b: 200.0.into() });
    recipe.add("land", land);
    recipe.add("place", Expr::new("hills > 0"));
    recipe.add("share", share);
    recipe.output("height", "land").output("share", "share").output("place", "place");
    recipe
}

/// The mask, the values and the positions of all samples at a cell.
fn samples(recipe: &Recipe, cell: f64) -> [Vec<f32>; 3] {
    let world = World::open(recipe.clone()).unwrap();
    let window = world.full_window(cell).unwrap();
    let grids = world.grids(&["share", "height", "place"], &window, &Progress::none()).unwrap();
    [0, 1, 2].map(|k| grids[k].data().to_vec())
}

fn select(share: f64, highest: bool) -> SelectShare {
    SelectShare { source: "land".into(), share, highest, ..SelectShare::default() }
}

fn plain() -> Expr {
    Expr::new("hills")
}

/// The samples with the lowest or highest values; of equal values the first ones, row by row.
fn expected(values: &[f32], candidate: impl Fn(usize) -> bool, share: f64, highest: bool) -> Vec<f32> {
    let known = values.iter().filter(|value| !value.is_nan()).count();
    let mut order: Vec<usize> = (0..values.len()).filter(|k| !values[*k].is_nan() && candidate(*k)).collect();
    order.sort_by(|a, b| {
        let by_value = (values[*a] + 0.0).total_cmp(&(values[*b] + 0.0));
        if highest { by_value.reverse() } else { by_value }.then(a.cmp(b))
    });
    let mut mask = vec![0.0; values.len()];
    order.iter().take((share * known as f64).round() as usize).for_each(|k| mask[*k] = 1.0);
    mask
}

#[test]
fn a_share_is_exact_at_its_cell() {
    for (seed, cell) in [(1, 0.0), (2, 0.0), (3, 20.0), (4, 25.0), (5, 10.0)] {
        for (share, highest) in [(0.4, false), (0.1, true), (0.0, false), (1.0, true), (0.333, false)] {
            let recipe = recipe(seed, plain(), SelectShare { cell, ..select(share, highest) });
            let [mask, values, _] = samples(&recipe, if cell > 0.0 { cell } else { 10.0 });
            assert_eq!(mask, expected(&values, |_| true, share, highest), "{share} at {cell} m");
        }
    }
}

#[test]
fn ties_are_decided_row_by_row_and_samples_without_a_value_do_not_count() {
    // Steps of 40 m with infinities and holes.
    let land = Expr::new(
        "(floor(hills / 40) * 40 + 1 / (hills <= 70) - 1) * 0^(hills < -60) + 0 / (1 - (hills > 20) * (hills < 25))",
    );
    for (share, highest) in [(0.4, false), (0.25, true), (0.9, false), (0.02, true)] {
        let [mask, values, _] = samples(&recipe(7, land.clone(), select(share, highest)), 10.0);
        assert!(values.iter().any(|value| value.is_nan()) && values.iter().any(|value| value.is_infinite()));
        assert_eq!(mask, expected(&values, |_| true, share, highest), "{share}");
    }
}

#[test]
fn a_share_is_selected_among_candidates() {
    for share in [0.2, 0.8] {
        let select = SelectShare { among: "place".into(), ..select(share, true) };
        let [mask, values, places] = samples(&recipe(8, plain(), select), 10.0);
        assert_eq!(mask, expected(&values, |k| places[k] == 1.0, share, true));
    }
}

#[test]
fn on_disk_it_is_the_same() {
    let land = Expr::new("floor(hills / 10) * 10");
    for select in [select(0.4, false), SelectShare { among: "place".into(), ..select(0.1, true) }] {
        let mut recipe = recipe(9, land.clone(), select);
        // 6 million samples, 24 MB.
        recipe.world.size = Some([30_000.0, 20_000.0]);
        let window = Window::new(300, 200, 10.0).at(1200, 700);
        let grids = [None, Some(20 << 20)].map(|memory| {
            let options = Options { memory: Budget::of(memory), ..Options::default() };
            let world = World::with_options(recipe.clone(), options).unwrap();
            let plan = world.plan(&["share"], &window).unwrap();
            let on_disk = plan.solves().iter().any(|solve| solve.on_disk);
            assert_eq!(on_disk, memory.is_some(), "{}", world.explain(&plan).unwrap());
            world.run(&plan, &Progress::none()).unwrap().remove(0)
        });
        assert_eq!(grids[0].data(), grids[1].data());
    }
}
