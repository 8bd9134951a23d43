//! Water in `alpine`, checked with heights and layers only: all land drains, lakes are valid lakes, rivers descend.

use orogen::{Grid, Progress, Recipe, Window, World, presets};

/// Offsets and distances of the eight neighbors.
const AROUND: [(i64, i64, f32); 8] = [
    (1, 0, 1.0),
    (1, 1, std::f32::consts::SQRT_2),
    (0, 1, 1.0),
    (-1, 1, std::f32::consts::SQRT_2),
    (-1, 0, 1.0),
    (-1, -1, std::f32::consts::SQRT_2),
    (0, -1, 1.0),
    (1, -1, std::f32::consts::SQRT_2),
];

struct Land {
    height: Grid,
    lake: Grid,
    surface: Grid,
    flow: Grid,
    sea_level: f32,
}

impl Land {
    /// The world of a recipe at its own cell, with this seed.
    fn of(recipe: &str, seed: u64) -> Land {
        let mut recipe = Recipe::parse(recipe, "the recipe").unwrap();
        recipe.world.seed = seed;
        let (size, cell) = (recipe.world.size.unwrap(), recipe.world.cell);
        let window = Window::new((size[0] / cell) as usize + 1, (size[1] / cell) as usize + 1, cell);
        let sea_level = recipe.world.sea_level as f32;
        let layers = ["height", "lakes", "surface", "flow"];
        let mut grids = World::open(recipe).unwrap().grids(&layers, &window, &Progress::none()).unwrap().into_iter();
        let mut next = || grids.next().unwrap();
        Land { height: next(), lake: next(), surface: next(), flow: next(), sea_level }
    }

    fn cells(&self) -> impl Iterator<Item = (usize, usize)> {
        let (width, height) = (self.height.width(), self.height.height());
        (0..height).flat_map(move |j| (0..width).map(move |i| (i, j)))
    }

    fn lake(&self, (i, j): (usize, usize)) -> u32 {
        self.lake[(i, j)] as u32
    }

    /// Returns whether water leaves the map here: in the sea, or at the border.
    fn is_outside(&self, (i, j): (usize, usize)) -> bool {
        let border = i == 0 || j == 0 || i + 1 == self.height.width() || j + 1 == self.height.height();
        border || self.height[(i, j)] <= self.sea_level
    }

    fn neighbors(&self, (i, j): (usize, usize)) -> impl Iterator<Item = ((usize, usize), f32)> {
        let (width, height) = (self.height.width() as i64, self.height.height() as i64);
        AROUND.into_iter().filter_map(move |(x, y, distance)| {
            let (x, y) = (i as i64 + x, j as i64 + y);
            ((0..width).contains(&x) && (0..height).contains(&y)).then_some(((x as usize, y as usize), distance))
        })
    }

    /// The D8 receiver over `heights`, if there is a lower neighbor.
    fn receiver(&self, heights: &Grid, (i, j): (usize, usize)) -> Option<(usize, usize)> {
        let here = heights[(i, j)];
        let mut best = (0.0, None);
        for (cell, distance) in self.neighbors((i, j)) {
            let slope = (here - heights[(cell.0, cell.1)]) / distance;
            if slope > best.0 {
                best = (slope, Some(cell));
            }
        }
        best.1
    }

    /// Checks that every land cell outside lakes drains to the sea, the border or a lake. Each step goes strictly down,
    /// so it is sufficient that each cell has a lower neighbor.
    fn drains(&self) {
        for cell in self.cells().filter(|cell| !self.is_outside(*cell) && self.lake(*cell) == 0) {
            assert!(self.receiver(&self.height, cell).is_some(), "{cell:?} is a pit");
        }
    }

    /// Checks that each lake is level, has at least four cells, and has an outlet at its edge. Returns the share of the
    /// land that lakes cover.
    fn lakes_are_lakes(&self) -> f64 {
        let count = self.cells().map(|cell| self.lake(cell)).max().unwrap_or(0) as usize;
        let mut cells = vec![0usize; count + 1];
        let mut level = vec![f32::NAN; count + 1];
        let mut spills = vec![false; count + 1];
        let mut cut = vec![false; count + 1];
        for (i, j) in self.cells().filter(|cell| self.lake(*cell) > 0) {
            let lake = self.lake((i, j)) as usize;
            cells[lake] += 1;
            let surface = self.surface[(i, j)];
            assert!(level[lake].is_nan() || level[lake] == surface, "lake {lake} is level");
            level[lake] = surface;
            assert!(surface >= self.height[(i, j)], "water is above its bed");
            for (shore, _) in self.neighbors((i, j)).filter(|(cell, _)| self.lake(*cell) as usize != lake) {
                // The outlet must not be at a shore from which water flows back.
                let low = self.surface[(shore.0, shore.1)] <= surface;
                let on = || self.receiver(&self.surface, shore).is_some_and(|to| self.lake(to) as usize != lake);
                spills[lake] |= low && (self.is_outside(shore) || on());
            }
            // A lake at the border is partly outside, and its outlet may be outside too.
            cut[lake] |= self.is_outside((i, j));
        }
        for lake in (1..=count).filter(|lake| cells[*lake] > 0 && !cut[*lake]) {
            assert!(cells[lake] >= 4, "lake {lake} has {} cells", cells[lake]);
            assert!(spills[lake], "lake {lake} has no outlet");
        }
        let land = self.cells().filter(|(i, j)| self.height[(*i, *j)] > self.sea_level).count();
        cells.iter().sum::<usize>() as f64 / land as f64
    }

    /// Checks that from each cell with a drainage area of 1 km² or more, water flows down to a cell with a larger area.
    fn rivers_fall(&self) -> usize {
        let mut rivers = 0;
        for (i, j) in self.cells().filter(|cell| !self.is_outside(*cell) && self.flow[(cell.0, cell.1)] >= 1e6) {
            let (flow, surface) = (self.flow[(i, j)], self.surface[(i, j)]);
            let on = |(x, y): (usize, usize)| self.flow[(x, y)] > flow && self.surface[(x, y)] <= surface;
            assert!(self.neighbors((i, j)).any(|(cell, _)| on(cell)), "the river at ({i}, {j}) ends or would rise");
            rivers += 1;
        }
        rivers
    }
}

fn check(recipe: &str, seeds: &[u64]) {
    for seed in seeds {
        let land = Land::of(recipe, *seed);
        land.drains();
        let (share, rivers) = (land.lakes_are_lakes(), land.rivers_fall());
        println!("seed {seed}: lakes cover {:.2} % of the land, {rivers} cells of rivers", share * 100.0);
        assert!(share > 0.0 && share < 0.03, "seed {seed}: lakes cover {:.2} % of the land", share * 100.0);
        assert!(rivers > 100);
    }
}

fn alpine() -> &'static str {
    presets::find("alpine").unwrap().text
}

#[test]
fn water_in_a_small_alpine() {
    // A quarter of the length and width.
    let whole = "[61440.0, 61440.0]";
    assert!(alpine().contains(whole));
    check(&alpine().replace(whole, "[15360.0, 15360.0]"), &[1, 2, 3]);
}

#[test]
#[ignore = "long: the whole preset with four seeds"]
fn water_in_the_whole_of_alpine() {
    check(alpine(), &[3, 11, 12, 13]);
}
