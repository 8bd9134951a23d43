//! The tests of the laws.

use super::case::{Case, tiles_equal_crop};
use super::forced::at_level;
use super::law::{LONGEST_CANCEL, Law, Verdict, Violation};
use super::recipes::{NODE, full, recipe_of, unsoftened, without_outputs, world_of};
use crate::recipe::document::{Recipe, WorldSpec};
use orogen_grid::error::ErrorKind;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_noise::Level;
use orogen_ops::declare::Input;
use orogen_ops::field::{Add, Fbm, Transform, Warp};
use orogen_ops::filter::Blur;
use orogen_ops::node::Node;
use orogen_ops::op::Op;
use orogen_ops::solver::Bake;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The cells at which [`Laws::check`] computes tiles. None of them is exact in binary.
pub const CELLS: [f64; 3] = [10.24, 0.1, 1.0 / 3.0];

/// The laws of one op.
pub struct Laws<'a> {
    pub(super) node: Node,
    pub(super) recipe: Box<dyn Fn(WorldSpec, bool) -> Recipe + 'a>,
}

impl<'a> Laws<'a> {
    /// The laws of the op that `op` returns for a cell size. Each input is a noise. The worlds have 97 x 81 samples, so
    /// parameters that are lengths should be a few cells: effects wider than the world or narrower than a sample are
    /// not tested.
    pub fn of<T: Into<Node>>(op: impl Fn(f64) -> T + 'a) -> Laws<'a> {
        let node = op(CELLS[0]).into();
        Laws::in_recipes(node, move |world, masked| recipe_of(&op(world.cell).into(), world, masked))
    }

    /// The laws of an op that cannot read an arbitrary noise. `recipe` returns a recipe for a world, with or without a
    /// mask. In it the op is the node [`NODE`], and the outputs are its layers, the first one named `height`. `node` is
    /// the op itself.
    pub fn in_recipes(node: Node, recipe: impl Fn(WorldSpec, bool) -> Recipe + 'a) -> Laws<'a> {
        Laws { node, recipe: Box::new(recipe) }
    }

    /// All laws, without [`Laws::cancel`], which measures time. [`Law::Levels`] forces SIMD levels for the whole
    /// process while it runs.
    pub fn check(&self) -> Vec<Violation> {
        let at_cells = CELLS
            .into_iter()
            .flat_map(|cell| [self.tiles(cell, false), self.tiles(cell, true), self.resolutions(cell)]);
        let others = [
            self.pieces(),
            self.levels(),
            self.altitudes(CELLS[0]),
            self.stored(CELLS[2]),
            self.warped(30.0),
            self.unbounded(),
            self.content_keys().map(drop),
            self.margin(CELLS[0]),
            self.stops(CANCELLED_SIDE).map(drop),
        ];
        at_cells.chain(others).filter_map(|verdict| verdict.err()).collect()
    }

    pub(super) fn case(&self, law: Law) -> Case {
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

    /// [`Law::TileEqualsCrop`] for windows of a levelled op that are too large for tiles of their last levels: those
    /// levels are made over the window itself, so a halo that is too small shows at its edges.
    ///
    /// # Errors
    /// The first difference.
    pub fn pieces(&self) -> Verdict {
        let recipe = (self.recipe)(WorldSpec { seed: 3, size: None, cell: CELLS[0], ..WorldSpec::default() }, false);
        let node = recipe.nodes().iter().find(|named| named.name == NODE);
        let Some(Op::Levelled(op)) = node.map(|named| named.node.op()) else { return Ok(()) };
        let finest = op.levels().finest;
        let layers: Vec<&str> = recipe.outputs().collect();
        for cell in [finest, 2.0 * finest] {
            let whole = Window::new(301, 230, cell).at(-77, 1003);
            let wholes = self.case(Law::TileEqualsCrop).in_window(whole).layers(&recipe, &whole)?;
            for part in
                [Window::new(133, 101, cell).at(-77 + 42, 1003 + 52), Window::new(100, 157, cell).at(5, 1003 + 37)]
            {
                let case = self.case(Law::TileEqualsCrop).in_window(part);
                for ((layer, whole), made) in layers.iter().zip(&wholes).zip(&case.layers(&recipe, &part)?) {
                    case.same(&format!("layer `{layer}`, a larger window and this one"), whole, made)?;
                }
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
        let made: Result<Vec<_>, Violation> = Level::available()
            .into_iter()
            .map(|level| {
                let made = at_level(level, || case.layers(&recipe, &window));
                Ok((level, made.map_err(|error| case.violation(error.to_string()))??))
            })
            .collect();
        let made = made?;
        for pair in made.windows(2) {
            for ((layer, one), other) in recipe.outputs().zip(&pair[0].1).zip(&pair[1].1) {
                case.same(&format!("layer `{layer}`, {:?} and {:?}", pair[0].0, pair[1].0), one, other)?;
            }
        }
        Ok(())
    }

    /// [`Law::Stored`], unless the op reads the altitude, so that no solver may read it. The test edits the plan, which
    /// is plain data: all solutions are on disk, and their sources use tiny tiles.
    ///
    /// # Errors
    /// The first difference.
    pub fn stored(&self, cell: f64) -> Verdict {
        if self.node.reads_altitude() {
            return Ok(());
        }
        let mut recipe = without_outputs(&(self.recipe)(world_of(cell), false));
        // A chain: a warp reads a filter, which reads a solver, which reads the node.
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
            Op::Filter(_) | Op::Levelled(_) => false,
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
    pub fn content_keys(&self) -> Result<usize, Violation> {
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

    /// [`Law::Cancel`] without a clock, in a world of `side` x `side` samples on one thread: the result does not depend
    /// on how busy the machine is. Times are computed from the costs that the ops state. Cancels the work at five
    /// different shares of it. Returns the longest time for which it continued, or the longest time between two reports
    /// of progress, if that is longer.
    ///
    /// # Errors
    /// If the time is longer than [`LONGEST_CANCEL`], or if the work ended with another error than
    /// [`ErrorKind::Cancelled`].
    pub fn stops(&self, side: usize) -> Result<Duration, Violation> {
        let (case, recipe, window) = self.cancelled(side);
        let layers: Vec<&str> = recipe.outputs().collect();
        let world = case.open(&recipe, 1)?;
        let work = case.of(world.work(&case.of(world.plan(&layers, &window))?))?;
        let time = |share: f64| Duration::from_secs_f64(share * work * 1e-9);
        // The reported shares and the result of work that is cancelled at the first report of `moment` or more.
        let run = |moment: f64| {
            let (stop, told) = (Arc::new(AtomicBool::new(false)), Arc::new(Mutex::new(Vec::new())));
            let (stopped, heard) = (Arc::clone(&stop), Arc::clone(&told));
            let progress = Progress::new(move |share| {
                heard.lock().unwrap_or_else(PoisonError::into_inner).push(share);
                stop.fetch_or(share >= moment, Ordering::Relaxed);
            });
            let made = case.open(&recipe, 1)?.grids(&layers, &window, &progress.stopped_by(stopped));
            let shares = std::mem::take(&mut *told.lock().unwrap_or_else(PoisonError::into_inner));
            match made {
                Err(error) if error.kind() != ErrorKind::Cancelled => {
                    case.breaks(format!("cancelled work ended with another error: {error}"))
                }
                made => Ok((made.is_ok(), shares)),
            }
        };
        let (_, shares) = run(f64::INFINITY)?;
        let ends = || shares.iter().copied().chain([1.0]);
        let step = std::iter::once(0.0).chain(ends()).zip(ends()).map(|(one, next)| next - one).fold(0.0, f64::max);
        if time(step) > LONGEST_CANCEL {
            let (step, all) = (time(step), time(1.0));
            return case
                .breaks(format!("{step:.1?} of {all:.1?} pass without a report, by the costs that the ops state"));
        }
        let mut longest = step;
        for moment in MOMENTS {
            let (is_made, shares) = run(moment)?;
            let asked = shares.iter().copied().find(|share| *share >= moment).unwrap_or(1.0);
            let ended = if is_made { 1.0 } else { shares.last().copied().unwrap_or(1.0) };
            longest = f64::max(longest, ended - asked);
        }
        match time(longest) {
            late if late <= LONGEST_CANCEL => Ok(late),
            late => case.breaks(format!(
                "it went on for {late:.1?} of {:.1?} after it was asked to stop, by the costs that the ops state",
                time(1.0)
            )),
        }
    }

    /// The case, the recipe and the window of work that is cancelled.
    fn cancelled(&self, side: usize) -> (Case, Recipe, Window) {
        let length = (side.max(2) - 1) as f64 * 10.0;
        let window = Window::new(side, side, 10.0);
        let recipe = (self.recipe)(WorldSpec { size: Some([length, length]), ..world_of(10.0) }, false);
        (self.case(Law::Cancel).in_window(window), recipe, window)
    }

    /// [`Law::Cancel`], in a world of `side` x `side` samples, by the clock. Cancels the work at five different times
    /// and returns the longest time for which it continued. For fields the engine checks between blocks. Other work on
    /// the machine may break this law: [`Laws::stops`] does not depend on it.
    ///
    /// # Errors
    /// If it continued for longer than [`LONGEST_CANCEL`] in three runs, or did not end with [`ErrorKind::Cancelled`].
    pub fn cancel(&self, side: usize) -> Result<Duration, Violation> {
        let (case, recipe, window) = self.cancelled(side);
        let layers: Vec<&str> = recipe.outputs().collect();
        let begun = Instant::now();
        case.layers(&recipe, &window)?;
        let all = begun.elapsed();
        let mut longest = Duration::ZERO;
        for share in MOMENTS {
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

/// The shares of the work after which it is cancelled.
const MOMENTS: [f64; 5] = [0.05, 0.27, 0.48, 0.71, 0.93];

/// Samples along the sides of the world that [`Laws::check`] cancels.
const CANCELLED_SIDE: usize = 384;
