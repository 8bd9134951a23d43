//! Laws: properties that every op must have, tested for one op. They apply to built-in ops and to ops of programs.
//!
//! | law | statement |
//! |---|---|
//! | [`Law::TileEqualsCrop`] | a tile has the bits of the crop of the whole, for any size, offset and number of threads, with a new or a filled store; a point has the bits of the sample at its position |
//! | [`Law::Finite`] | finite inputs give finite results |
//! | [`Law::Levels`] | every SIMD level gives the same bits |
//! | [`Law::Stored`] | solutions on disk, and sources computed in tiles of any size, change no bit |
//! | [`Law::Warped`] | a tile equals the crop if a warp and a rotation read the op, and a warp by 0 changes no bit |
//! | [`Law::Unbounded`] | a tile equals the crop at large and at negative positions |
//! | [`Law::Resolutions`] | a field has the same bits where the samples of two cells coincide |
//! | [`Law::ContentKeys`] | every change of the world that changes samples changes the content key |
//! | [`Law::Margin`] | a solver's margin obeys tile == crop, also beyond the world, changes no bit on disk, and is part of the content key |
//! | [`Law::Cancel`] | work stops within [`LONGEST_CANCEL`] after a request to cancel |
//!
//! ```
//! use orogen_engine::filter::blur::Blur;
//! use orogen_engine::laws::Laws;
//!
//! let violations = Laws::of(|cell| Blur { radius: 2.5 * cell, ..Blur::default() }).check();
//! assert!(violations.is_empty(), "{violations:#?}");
//! ```

use crate::declare::{Input, MARGIN};
use crate::field::{add::Add, fbm::Fbm, perlin::Perlin, transform::Transform, warp::Warp};
use crate::filter::blur::Blur;
use crate::node::Node;
use crate::op::Op;
use crate::recipe::document::{Recipe, WorldSpec};
use crate::session::Options;
use crate::solver::bake::Bake;
use crate::value::Value;
use crate::world::World;
use orogen_grid::error::{ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::random::Random;
use orogen_noise::Level;
use std::fmt;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The cells at which [`Laws::check`] computes tiles. None of them is exact in binary.
pub const CELLS: [f64; 3] = [10.24, 0.1, 1.0 / 3.0];

/// Maximum time for which work may continue after a request to cancel.
pub const LONGEST_CANCEL: Duration = Duration::from_millis(100);

/// The name of the node under test in the recipes of [`recipe_of`] and [`Laws::in_recipes`].
pub const NODE: &str = "node";

/// Samples along the sides of the worlds of [`world_of`], their far edges included.
const SIDES: [usize; 2] = [97, 81];

/// A law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// A tile has the bits of the crop of the whole.
    TileEqualsCrop,
    /// Finite inputs give finite results.
    Finite,
    /// Every SIMD level gives the same bits.
    Levels,
    /// Solutions on disk and sources in tiles change no bit.
    Stored,
    /// A tile equals the crop if warps and rotations read the op.
    Warped,
    /// A tile equals the crop at large and at negative positions.
    Unbounded,
    /// A field has the same bits where the samples of two cells coincide.
    Resolutions,
    /// Every change of the world that changes samples changes the content key.
    ContentKeys,
    /// A solver with a margin has these properties, too.
    Margin,
    /// Work stops after a request to cancel.
    Cancel,
}

/// A violation of a law by an op.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// The op.
    pub op: String,
    /// The law.
    pub law: Law,
    /// The samples that were computed.
    pub window: Option<Window>,
    /// Description of the violation.
    pub message: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "`{}` breaks the law {:?}", self.op, self.law)?;
        if let Some(Window { x, y, width, height, cell }) = self.window {
            write!(formatter, " in {width} x {height} samples at ({x}, {y}), cell {cell} m")?;
        }
        write!(formatter, ": {}", self.message)
    }
}

impl std::error::Error for Violation {}

/// Whether a law holds.
pub type Verdict = std::result::Result<(), Violation>;

/// The laws of one op.
pub struct Laws<'a> {
    node: Node,
    recipe: Box<dyn Fn(WorldSpec, bool) -> Recipe + 'a>,
}

impl<'a> Laws<'a> {
    /// The laws of the op that `op` returns for a cell size. Each input is a noise. The worlds have 97 x 81 samples, so parameters that are
    /// lengths should be a few cells: effects wider than the world or narrower than a sample are not tested.
    pub fn of<T: Into<Node>>(op: impl Fn(f64) -> T + 'a) -> Laws<'a> {
        let node = op(CELLS[0]).into();
        Laws::in_recipes(node, move |world, masked| recipe_of(&op(world.cell).into(), world, masked))
    }

    /// The laws of an op that cannot read an arbitrary noise. `recipe` returns a recipe for a world, with or without a mask. In it the op is the
    /// node [`NODE`], and the outputs are its layers, the first one named `height`. `node` is the op itself.
    pub fn in_recipes(node: Node, recipe: impl Fn(WorldSpec, bool) -> Recipe + 'a) -> Laws<'a> {
        Laws { node, recipe: Box::new(recipe) }
    }

    /// All laws. [`Law::Levels`] forces SIMD levels for the whole process while it runs.
    pub fn check(&self) -> Vec<Violation> {
        let at_cells = CELLS
            .into_iter()
            .flat_map(|cell| [self.tiles(cell, false), self.tiles(cell, true), self.resolutions(cell)]);
        let others = [
            self.levels(),
            self.stored(CELLS[2]),
            self.warped(30.0),
            self.unbounded(),
            self.content_keys().map(drop),
            self.margin(CELLS[0]),
            self.cancel(CANCELLED_SIDE).map(drop),
        ];
        at_cells.chain(others).filter_map(|verdict| verdict.err()).collect()
    }

    fn case(&self, law: Law) -> Case {
        Case { op: self.node.spec().op.to_string(), law, window: None }
    }

    /// [`Law::TileEqualsCrop`] and [`Law::Finite`], for all layers.
    ///
    /// # Errors
    /// The first difference.
    pub fn tiles(&self, cell: f64, masked: bool) -> Verdict {
        let recipe = (self.recipe)(world_of(cell), masked);
        let what = if masked { "masked, " } else { "" };
        tiles_equal_crop(&self.case(Law::TileEqualsCrop), what, &recipe, cell)?;
        let case = self.case(Law::Finite).in_window(full(cell));
        for (layer, grid) in recipe.outputs().zip(case.layers(&recipe, &full(cell))?) {
            if let Some(k) = grid.data().iter().position(|sample| !sample.is_finite()) {
                let (i, j) = (k % grid.width(), k / grid.width());
                return case.breaks(format!("{what}layer `{layer}`: {} at ({i}, {j})", grid[(i, j)]));
            }
        }
        Ok(())
    }

    /// [`Law::Levels`]. It forces SIMD levels for the whole process and restores the previous one at the end.
    ///
    /// # Errors
    /// The first difference.
    pub fn levels(&self) -> Verdict {
        let window = Window::new(75, 63, CELLS[0]).at(5, 9);
        let case = self.case(Law::Levels).in_window(window);
        let recipe = (self.recipe)(world_of(CELLS[0]), false);
        let _forced = FORCED.lock().unwrap_or_else(PoisonError::into_inner);
        let before = Level::current();
        let made: std::result::Result<Vec<_>, Violation> = Level::available()
            .into_iter()
            .map(|level| {
                Level::force(level).map_err(|error| case.violation(error.to_string()))?;
                Ok((level, case.layers(&recipe, &window)?))
            })
            .collect();
        Level::force(before).map_err(|error| case.violation(error.to_string()))?;
        let made = made?;
        for pair in made.windows(2) {
            for ((layer, one), other) in recipe.outputs().zip(&pair[0].1).zip(&pair[1].1) {
                case.same(&format!("layer `{layer}`, {:?} and {:?}", pair[0].0, pair[1].0), one, other)?;
            }
        }
        Ok(())
    }

    /// [`Law::Stored`]. The test edits the plan, which is plain data: all solutions are on disk, and their sources use tiny tiles.
    ///
    /// # Errors
    /// The first difference.
    pub fn stored(&self, cell: f64) -> Verdict {
        let mut recipe = without_outputs(&(self.recipe)(world_of(cell), false));
        // Warps that read filters that read solvers that read the node.
        let noise = Fbm { seed: 8, wavelength: 20.0 * cell, octaves: 2, ..Default::default() };
        recipe.add("move", noise).add("kept", Bake { source: NODE.into(), cell: 0.7 * cell, ..Bake::default() });
        recipe.add("soft2", Blur { source: "kept".into(), radius: 1.1 * cell });
        recipe.add("last", Warp { source: "soft2".into(), x: "move".into(), y: "move".into(), strength: 9.0 * cell });
        recipe.output("height", "last").output("node", NODE);
        let window = Window::new(60, 50, cell).at(30, 29);
        let layers = ["height", "node"];
        let case = self.case(Law::Stored).in_window(window);
        let expect = case.layers(&recipe, &window)?;
        for (side, threads, tile) in
            [(1 << 20, 1, window), (33, 2, window), (50, 2, Window::new(7, 1, cell).at(41, 77))]
        {
            let case = self.case(Law::Stored).in_window(tile);
            let world = case.open(&recipe, threads)?;
            let mut plan = case.of(world.plan(&layers, &tile))?;
            plan.solve_on_disk(side);
            let made = case.of(world.run(&plan, &Progress::none()))?;
            for (whole, made) in expect.iter().zip(&made) {
                case.same(&format!("in tiles of {side}, on disk"), whole, made)?;
            }
            // In memory again, read from the files.
            case.same("in memory again", &expect[0], &case.of(world.window("height", &tile))?)?;
        }
        Ok(())
    }

    /// [`Law::Warped`], for all layers.
    ///
    /// # Errors
    /// The first difference.
    pub fn warped(&self, cell: f64) -> Verdict {
        let from = (self.recipe)(world_of(cell), false);
        let mut recipe = without_outputs(&from);
        let noise = |seed| Fbm { seed, wavelength: 10.0 * cell, octaves: 2, ..Default::default() };
        recipe.add("wx", noise(1)).add("wy", noise(2));
        for layer in self.node.layers() {
            let [warped, turned, sum] = ["warped", "turned", "sum"].map(|what| format!("{what}-{}", layer.name));
            let source = Input::Node(format!("{NODE}.{}", layer.name));
            recipe.add(&warped, Warp { source, x: "wx".into(), y: "wy".into(), strength: 3.2 * cell });
            let (source, offset) = (Input::from(&warped), [6.7 * cell, -2.6 * cell]);
            recipe.add(&turned, Transform { source, offset, scale: 1.5, angle: 25.0 });
            recipe.add(&sum, Add { a: (&turned).into(), b: (&warped).into() });
            recipe.output(layer.name, &sum);
        }
        tiles_equal_crop(&self.case(Law::Warped), "warped, ", &recipe, cell)?;
        let mut still = without_outputs(&from);
        still.add("still", Warp { source: NODE.into(), x: 0.0.into(), y: 0.0.into(), strength: 10.0 });
        still.output(NODE, NODE).output("still", "still");
        let window = Window::new(50, 40, cell).at(3, 5);
        let case = self.case(Law::Warped).in_window(window);
        let made = case.layers(&still, &window)?;
        case.same("a warp by nothing", &made[0], &made[1])
    }

    /// [`Law::Unbounded`], unless the op needs a world with bounds.
    ///
    /// # Errors
    /// The first difference.
    pub fn unbounded(&self) -> Verdict {
        if self.needs_bounds() {
            return Ok(());
        }
        let recipe = (self.recipe)(WorldSpec { seed: 3, size: None, cell: 10.24, ..WorldSpec::default() }, false);
        for (x, y) in [(-40, -17), (1_000_003, -999_999_937), (97_656_250, 5)] {
            let window = Window::new(40, 30, 10.24).at(x, y);
            let whole = self.case(Law::Unbounded).in_window(window).layers(&recipe, &window)?;
            let tile = Window::new(9, 11, 10.24).at(x + 21, y + 6);
            let case = self.case(Law::Unbounded).in_window(tile);
            let world = case.open(&recipe, 1)?;
            let layers: Vec<&str> = recipe.outputs().collect();
            let made = case.of(world.grids(&layers, &tile, &Progress::none()))?;
            for ((layer, whole), made) in layers.iter().zip(&whole).zip(&made) {
                case.same(&format!("layer `{layer}`"), whole, made)?;
            }
        }
        Ok(())
    }

    fn needs_bounds(&self) -> bool {
        match self.node.op() {
            Op::Solver(_) => true,
            Op::Field(field) => field.needs_bounds(),
            Op::Filter(_) => false,
        }
    }

    /// [`Law::Resolutions`], for a field. The results of filters and solvers depend on their cell.
    ///
    /// # Errors
    /// The first difference.
    pub fn resolutions(&self, cell: f64) -> Verdict {
        if !matches!(self.node.op(), Op::Field(_)) {
            return Ok(());
        }
        for (ratio, masked) in [(2usize, false), (4, true), (8, false)] {
            let sized = unsoftened(&(self.recipe)(world_of(cell), masked));
            let mut free = sized.clone();
            let mut origins = vec![(&sized, 0, 0)];
            if !self.needs_bounds() {
                free.world.size = None;
                origins.extend([(&free, -3, -11), (&free, 1_000_003, -999_999_937), (&free, -97_656_250, 5)]);
            }
            for (recipe, x, y) in origins {
                let coarse = Window::new(9, 9, cell).at(x, y);
                let side = 8 * ratio + 1;
                let fine = Window::new(side, side, cell / ratio as f64).at(x * ratio as i64, y * ratio as i64);
                let case = self.case(Law::Resolutions).in_window(fine);
                let world = case.open(recipe, 2)?;
                let [coarse, fine] =
                    [case.of(world.window("height", &coarse))?, case.of(world.window("height", &fine))?];
                for (i, j) in (0..9).flat_map(|j| (0..9).map(move |i| (i, j))) {
                    let (a, b) = (fine[(ratio * i, ratio * j)], coarse[(i, j)]);
                    if a.to_bits() != b.to_bits() {
                        return case.breaks(format!(
                            "{a}, but {b} at a cell of {cell} m, at its sample ({x} + {i}, {y} + {j})"
                        ));
                    }
                }
            }
        }
        Ok(())
    }

    /// [`Law::ContentKeys`]. Returns how many of five changes of the world left the key and the samples unchanged.
    ///
    /// # Errors
    /// The first change that changes a sample but not the key.
    pub fn content_keys(&self) -> std::result::Result<usize, Violation> {
        let window = Window::new(24, 20, 30.0).at(20, 18);
        let case = self.case(Law::ContentKeys).in_window(window);
        let world = world_of(30.0);
        let recipe = (self.recipe)(world, false);
        let made = |recipe: &Recipe| {
            let world = case.open(recipe, 1)?;
            let layers: Vec<&str> = recipe.outputs().collect();
            Ok((case.of(world.key(NODE))?, case.of(world.grids(&layers, &window, &Progress::none()))?))
        };
        let (key, grids) = made(&recipe)?;
        let [width, height] = world.size.unwrap_or_default();
        let mut kept = 0;
        for (what, changed) in [
            ("the seed", WorldSpec { seed: 43, ..world }),
            ("the sea level", WorldSpec { sea_level: 0.25, ..world }),
            ("the width", WorldSpec { size: Some([width + 300.0, height]), ..world }),
            ("the height", WorldSpec { size: Some([width, height + 600.0]), ..world }),
            ("the cell", WorldSpec { cell: 60.0, ..world }),
        ] {
            let mut recipe = recipe.clone();
            recipe.world = changed;
            let (changed_key, changed_grids) = made(&recipe)?;
            if key == changed_key {
                kept += 1;
                for (one, other) in grids.iter().zip(&changed_grids) {
                    case.same(
                        &format!("the world with {what} changed, which its content key does not hold"),
                        one,
                        other,
                    )?;
                }
            }
        }
        Ok(kept)
    }

    /// [`Law::Margin`], if the op has a margin: for all layers, read inside the world and beyond it.
    ///
    /// # Errors
    /// The first difference.
    pub fn margin(&self, cell: f64) -> Verdict {
        if self.node.margin().is_none() {
            return Ok(());
        }
        let case = self.case(Law::Margin);
        let mut recipe = (self.recipe)(world_of(cell), false);
        let without = case.of(case.open(&recipe, 1)?.key(NODE))?;
        // Not a whole number of cells.
        case.set_margin(&mut recipe, 5.3 * cell)?;
        if case.of(case.open(&recipe, 1)?.key(NODE))? == without {
            return case.breaks("the content key does not hold the margin".to_string());
        }
        for layer in self.node.layers() {
            for (side, metres) in [("before", -4.0 * cell), ("behind", 4.5 * cell)] {
                let name = format!("{side}-{}", layer.name);
                let source = Input::Node(format!("{NODE}.{}", layer.name));
                recipe.add(&name, Transform { source, offset: [metres; 2], ..Transform::default() });
                recipe.output(&name, Input::from(&name));
            }
        }
        tiles_equal_crop(&case, "with a margin, ", &recipe, cell)?;
        let (window, layers) = (full(cell), recipe.outputs().collect::<Vec<&str>>());
        let case = case.in_window(window);
        let in_memory = case.layers(&recipe, &window)?;
        let world = case.open(&recipe, 2)?;
        let mut plan = case.of(world.plan(&layers, &window))?;
        plan.solve_on_disk(33);
        for ((layer, one), other) in layers.iter().zip(&in_memory).zip(&case.of(world.run(&plan, &Progress::none()))?) {
            case.same(&format!("with a margin, layer `{layer}`, in memory and on disk"), one, other)?;
        }
        Ok(())
    }

    /// [`Law::Cancel`], in a world of `side` x `side` samples. Cancels the work at five different times and returns the longest time for which it
    /// continued. For fields the engine checks between blocks.
    ///
    /// # Errors
    /// If it continued for longer than [`LONGEST_CANCEL`] in three runs, or did not end with [`ErrorKind::Cancelled`].
    pub fn cancel(&self, side: usize) -> std::result::Result<Duration, Violation> {
        let length = (side.max(2) - 1) as f64 * 10.0;
        let window = Window::new(side, side, 10.0);
        let case = self.case(Law::Cancel).in_window(window);
        let recipe = (self.recipe)(WorldSpec { size: Some([length, length]), ..world_of(10.0) }, false);
        let layers: Vec<&str> = recipe.outputs().collect();
        let begun = Instant::now();
        case.layers(&recipe, &window)?;
        let all = begun.elapsed();
        let mut longest = Duration::ZERO;
        for share in [0.05, 0.27, 0.48, 0.71, 0.93] {
            // Other processes can delay a run, so the best of three counts.
            let mut late = Duration::MAX;
            for _ in 0..3 {
                let world = case.open(&recipe, 2)?;
                let progress = Progress::none();
                let (made, ended, asked) = std::thread::scope(|scope| {
                    let stopper = scope.spawn(|| {
                        std::thread::sleep(all.mul_f64(share));
                        progress.cancel();
                        Instant::now()
                    });
                    let made = world.grids(&layers, &window, &progress);
                    let ended = Instant::now();
                    (made, ended, stopper.join())
                });
                if let Err(error) = made
                    && error.kind() != ErrorKind::Cancelled
                {
                    return case.breaks(format!("cancelled work ended with another error: {error}"));
                }
                late = late.min(asked.map_or(Duration::ZERO, |asked| ended.saturating_duration_since(asked)));
                if late < LONGEST_CANCEL {
                    break;
                }
            }
            longest = longest.max(late);
        }
        match longest < LONGEST_CANCEL {
            true => Ok(longest),
            false => {
                case.breaks(format!("it went on for {longest:.1?} after it was asked to stop, of {all:.1?} in all"))
            }
        }
    }
}

/// Samples along the sides of the world that [`Laws::check`] cancels.
const CANCELLED_SIDE: usize = 384;

/// Locked while SIMD levels are forced, because they apply to the whole process.
static FORCED: Mutex<()> = Mutex::new(());

/// A law during its test.
struct Case {
    op: String,
    law: Law,
    window: Option<Window>,
}

impl Case {
    fn in_window(&self, window: Window) -> Case {
        Case { op: self.op.clone(), law: self.law, window: Some(window) }
    }

    fn violation(&self, message: String) -> Violation {
        Violation { op: self.op.clone(), law: self.law, window: self.window, message }
    }

    fn breaks<T>(&self, message: String) -> std::result::Result<T, Violation> {
        Err(self.violation(message))
    }

    fn of<T>(&self, result: Result<T>) -> std::result::Result<T, Violation> {
        result.map_err(|error| self.violation(error.to_string()))
    }

    fn open(&self, recipe: &Recipe, threads: usize) -> std::result::Result<World, Violation> {
        self.of(World::with_options(recipe.clone(), Options { threads: Some(threads), ..Options::default() }))
    }

    /// Sets the margin of the op's nodes.
    fn set_margin(&self, recipe: &mut Recipe, metres: f64) -> Verdict {
        let mut refused = None;
        recipe.change(|node| {
            let param = node.spec().params.iter().position(|param| param.name == MARGIN);
            if let (true, Some(param)) = (node.spec().op == self.op, param) {
                refused = node.set_param(param, &Value::Number(metres)).err();
            }
        });
        refused.map_or(Ok(()), |message| self.breaks(message))
    }

    /// All layers, from a new world.
    fn layers(&self, recipe: &Recipe, window: &Window) -> std::result::Result<Vec<Grid>, Violation> {
        let layers: Vec<&str> = recipe.outputs().collect();
        self.of(self.open(recipe, 2)?.grids(&layers, window, &Progress::none()))
    }

    /// Whether a tile has the bits of the part of the whole that it covers.
    fn same(&self, what: &str, whole: &Grid, tile: &Grid) -> Verdict {
        let Some(crop) = whole.crop(tile.window()) else {
            return self.breaks(format!("{what}: {:?} is not part of {:?}", tile.window(), whole.window()));
        };
        let differs = |(a, b): (&f32, &f32)| a.to_bits() != b.to_bits();
        match crop.data().iter().zip(tile.data()).position(differs) {
            Some(k) => {
                let (i, j) = (k % tile.width(), k / tile.width());
                self.breaks(format!("{what}: {} and {} at ({i}, {j})", crop[(i, j)], tile[(i, j)]))
            }
            None => Ok(()),
        }
    }
}

/// The whole of [`world_of`], its far edges included.
fn full(cell: f64) -> Window {
    Window::new(SIDES[0], SIDES[1], cell)
}

/// Tile == crop for every layer of one recipe: the whole against tiles of several sizes and offsets, thread counts, fresh and warm.
fn tiles_equal_crop(case: &Case, what: &str, recipe: &Recipe, cell: f64) -> Verdict {
    let whole = full(cell);
    let layers: Vec<&str> = recipe.outputs().collect();
    let wholes = case.in_window(whole).layers(recipe, &whole)?;
    let warm = case.open(recipe, 1)?;
    let mut random = Random::of_state(case.op.len() as u64);
    let mut tiles = vec![(Window::new(31, 17, cell).at(13, 44), true), (whole, true), (whole, false)];
    for size in [1usize, 2, 7, 33, 64] {
        for _ in 0..2 {
            let [x, y] = SIDES.map(|side| (random.draw() % ((side - size) as u64 + 1)) as i64);
            tiles.push((Window::new(size, size, cell).at(x, y), false));
        }
    }
    for (tile, fresh) in tiles {
        let case = case.in_window(tile);
        let made = match fresh {
            true => case.layers(recipe, &tile)?,
            false => case.of(warm.grids(&layers, &tile, &Progress::none()))?,
        };
        for ((layer, whole), made) in layers.iter().zip(&wholes).zip(&made) {
            case.same(&format!("{what}layer `{layer}`, the whole and the tile"), whole, made)?;
        }
    }
    // A point on the lattice is the sample there.
    let [i, j] = SIDES.map(|side| (random.draw() % side as u64) as usize);
    let case = case.in_window(Window::new(1, 1, cell).at(i as i64, j as i64));
    for (layer, grid) in layers.iter().zip(&wholes) {
        let points = case.of(warm.points(layer, &[whole.east(i)], &[whole.south(j)]))?;
        if points.first().is_none_or(|point| point.to_bits() != grid[(i, j)].to_bits()) {
            return case
                .breaks(format!("{what}layer `{layer}`: {} in the whole, {points:?} at that point", grid[(i, j)]));
        }
    }
    Ok(())
}

/// The nodes of a recipe.
fn without_outputs(from: &Recipe) -> Recipe {
    let mut recipe = Recipe::new(from.world);
    for named in from.nodes() {
        recipe.add_masked(&named.name, named.node.clone(), named.mask.clone());
    }
    recipe
}

/// The node and its inputs without the blur below them, because the result of a filter depends on the cell.
fn unsoftened(from: &Recipe) -> Recipe {
    let mut recipe = Recipe::new(from.world);
    for named in from.nodes().iter().filter(|named| named.name != SOFT) {
        let mut node = named.node.clone();
        for i in 0..node.inputs().len() {
            if *node.input(i) == Input::from(SOFT) {
                node.set_input(i, Input::Node(format!("in{i}")));
            }
        }
        recipe.add_masked(&named.name, node, named.mask.clone());
    }
    recipe.output("height", NODE);
    recipe
}

/// The node that a `source` is read through.
const SOFT: &str = "soft";

/// A bounded world of 97 x 81 samples at a cell.
#[must_use]
pub fn world_of(cell: f64) -> WorldSpec {
    let size = SIDES.map(|side| (side - 1) as f64 * cell);
    WorldSpec { seed: 42, size: Some(size), cell, ..WorldSpec::default() }
}

/// A recipe with the node as [`NODE`]. Each input is a separate noise, about -1 to 1 with a wavelength of nine cells. An input called `source` reads
/// it through a blur, so that halos add up. The outputs are the node's layers, the first one named `height`.
#[must_use]
pub fn recipe_of(node: &Node, world: WorldSpec, masked: bool) -> Recipe {
    let mut node = node.clone();
    let mut recipe = Recipe::new(world);
    let inputs: Vec<String> = node.inputs().iter().map(|input| input.name.to_string()).collect();
    for (i, input) in inputs.iter().enumerate() {
        let name = format!("in{i}");
        recipe.add(&name, Fbm { seed: i as u64, wavelength: 9.0 * world.cell, octaves: 3, ..Default::default() });
        if input == "source" {
            recipe.add(SOFT, Blur { source: Input::from(&name), radius: 1.2 * world.cell });
            node.set_input(i, Input::from(SOFT));
        } else {
            node.set_input(i, Input::Node(name));
        }
    }
    let layers = node.layers();
    if masked {
        recipe.add("mask", Perlin { seed: 99, wavelength: 7.0 * world.cell });
        recipe.add_masked(NODE, node, "mask");
    } else {
        recipe.add(NODE, node);
    }
    recipe.output("height", NODE);
    for layer in layers.iter().skip(1) {
        recipe.output(layer.name, Input::Node(format!("{NODE}.{}", layer.name)));
    }
    recipe
}
