//! Traits of ops: fields, filters, levelled ops and solvers, and their inputs.

pub use crate::coord_map::{Affine, CoordMap, Stencil};
use crate::declare::Declared;
use crate::expression::term::{self, Term};
pub use crate::inputs::{GridInputs, Inputs};
use crate::layer::LayerKind;
use crate::lower::{Lowering, Passes};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::random::{STEP, mix64};
use orogen_io::format::dem::Georeference;
use orogen_io::raster::Raster;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

/// Properties of the world that every op receives.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WorldParams {
    /// The world's seed.
    pub seed: u64,
    /// The world's extent in metres, east and south; `None` if it is unbounded.
    pub size: Option<[f64; 2]>,
    /// Distance between samples of the world's own lattice, in metres.
    pub cell: f64,
    /// Sea level in metres.
    pub sea_level: f64,
}

impl WorldParams {
    /// The seed of a node in this world: both seeds are hashed together, so that consecutive seeds give independent
    /// results (splitmix64's finalizer, Steele, Lea and Flood 2014, over both).
    #[must_use]
    pub fn seed_of(&self, node_seed: u64) -> u64 {
        let world = mix64(self.seed.wrapping_add(STEP));
        mix64(world ^ node_seed.wrapping_mul(0xD1B5_4A32_D192_ED03))
    }

    /// The samples of the world on the lattice with a cell in metres; `None` if it is unbounded.
    #[must_use]
    pub fn window(&self, cell: f64) -> Option<Window> {
        self.size.map(|size| world_window(size, cell))
    }
}

/// The samples of a world of this size on the lattice with a cell in metres.
#[doc(hidden)]
#[must_use]
pub fn world_window(size: [f64; 2], cell: f64) -> Window {
    let [width, height] = size.map(|length| whole_cells(length, cell, f64::floor) + 1);
    Window::new(width, height, cell)
}

/// A length in whole cells. A length that is a whole number of cells up to rounding errors gives that number: 1000 /
/// 0.1 is 10 000 cells.
#[doc(hidden)]
#[must_use]
pub fn whole_cells(length: f64, cell: f64, round: impl Fn(f64) -> f64) -> usize {
    let cells = length / cell;
    let near = cells.round();
    let whole = if (cells - near).abs() < 1e-6 { near } else { round(cells) };
    whole.max(0.0) as usize
}

/// A field prepared for many blocks of points: everything that depends on neither points nor inputs is computed once.
#[doc(hidden)]
pub type Evaluator = Box<dyn Fn(&Points, &Inputs, &mut [f32]) -> Result<()> + Send + Sync>;

/// A field depends on one position, the seed, and its inputs there. It is a pure function: points can be evaluated in
/// any order and any number of times.
pub trait Field: Declared + Send + Sync {
    /// Computes one value per point. A field with [`Field::terms`] need not implement it.
    ///
    /// # Errors
    /// If a required input is missing, which is an internal error.
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) -> Result<()> {
        match (self.prepare(world_params), self.terms()) {
            (Some(evaluate), _) => evaluate(at, inputs, out)?,
            (None, Some(terms)) => term::evaluate(&terms, |input| inputs.slots.get(input).copied().flatten(), out),
            (None, None) => {
                let message = format!("`{}` has no values of its own", self.spec().op);
                return Err(Error::new(ErrorKind::Internal, message));
            }
        }
        Ok(())
    }

    /// Computes one value of a layer per point. A field that declares several layers implements it; others implement
    /// only [`Field::eval`].
    ///
    /// # Errors
    /// As for [`Field::eval`].
    fn eval_layer(
        &self,
        layer: usize,
        at: &Points,
        inputs: &Inputs,
        world_params: &WorldParams,
        out: &mut [f32],
    ) -> Result<()> {
        let _ = layer;
        self.eval(at, inputs, world_params, out)
    }

    /// The field prepared for many blocks, if that saves work. The engine then never calls [`Field::eval`].
    #[doc(hidden)]
    fn prepare(&self, world_params: &WorldParams) -> Option<Evaluator> {
        let _ = world_params;
        None
    }

    /// The field as an expression of its inputs, if it depends on nothing else. Inputs are named by their indices. The
    /// engine then evaluates these terms, and never calls [`Field::eval`].
    fn terms(&self) -> Option<Vec<Term>> {
        None
    }

    /// The coordinate map of a field that reads its source at other positions. Such a field need not implement
    /// [`Field::eval`]: the engine moves the points and evaluates the source there.
    fn coord_map(&self) -> Option<CoordMap> {
        None
    }

    /// The stencil of a field that also reads a source around each position, to compute its slope.
    fn stencil(&self) -> Option<Stencil> {
        None
    }

    /// For a field that interpolates its first input between samples at its own cell: that cell, for the requested cell
    /// and the world's cell, all in metres. Such a field need not implement [`Field::eval`]: the engine computes and
    /// interpolates the samples.
    fn source_cell(&self, requested: f64, world_cell: f64) -> Option<f64> {
        let _ = (requested, world_cell);
        None
    }

    /// Whether the field needs a bounded world.
    fn needs_bounds(&self) -> bool {
        false
    }

    /// Whether the result depends on the world's sea level. A field that returns false must not read it, because the
    /// content key would be wrong.
    fn reads_sea_level(&self) -> bool {
        false
    }

    /// Whether the result depends on the [altitude](Inputs::altitude) at which the field is evaluated, other than
    /// through its inputs. The engine evaluates a field that returns false once for all altitudes. An op with `space;`
    /// in its declaration need not implement it.
    fn reads_altitude(&self) -> bool {
        false
    }

    /// Memory of the files that it keeps while its world is open, in bytes.
    fn memory(&self) -> u64 {
        0
    }

    /// The computation of a layer in the plane on a graphics card. A field with terms, a coordinate map or its own cell
    /// need not implement it.
    #[doc(hidden)]
    fn lower(&self, layer: usize, world_params: &WorldParams) -> Lowering<Shader> {
        let _ = (layer, world_params);
        Lowering::Missing
    }

    /// The position of the world on a map, if the field is a georeferenced real place.
    fn georeference(&self) -> Option<Georeference> {
        None
    }

    /// Approximate nanoseconds per sample: expensive fields are computed once and kept instead of computed repeatedly.
    fn cost(&self) -> f64 {
        0.2
    }

    /// Approximate nanoseconds per sample on a lattice, for a field without inputs.
    fn cost_in_rows(&self) -> f64 {
        self.cost() * IN_ROWS
    }
}

/// Cost of a field without inputs on a lattice, where rows share work, relative to its cost at arbitrary points.
const IN_ROWS: f64 = 0.15;

/// The context of a filter or solver.
pub struct Context<'a> {
    /// Properties of the world.
    pub world_params: &'a WorldParams,
    /// Progress and cancellation of the work.
    pub progress: &'a Progress,
    /// The observer of a solver with steps.
    pub observer: Option<&'a (dyn StepObserver + Sync)>,
}

/// Receives the solutions of a solver after some of its steps. Each equals the solution of a shorter run with the same
/// steps.
pub trait StepObserver {
    /// Whether the solution after this many steps is wanted; 0 is the solution after one step of zero duration. It is
    /// not called for the last step.
    fn wants(&self, step: u32) -> bool;

    /// Whether a layer of these solutions is read. If only the first layer is read, the solver may omit the others.
    fn reads(&self, layer: usize) -> bool;

    /// Receives a wanted solution.
    ///
    /// # Errors
    /// An error ends the solver's work with that error.
    fn take(&self, step: u32, solution: Solution) -> Result<()>;
}

/// A filter depends on a finite halo. Its inputs are extended by that halo; its results do not depend on the window.
pub trait Filter: Declared + Send + Sync {
    /// Halo on each side of the window, in samples, for a cell in metres.
    fn halo(&self, cell: f64) -> usize;

    /// Scratch memory for `window` in bytes, excluding inputs and layers.
    fn scratch(&self, window: &Window) -> u64 {
        let _ = window;
        0
    }

    /// Computes layers over `window`; each given input covers `window.grown(halo)`. `out` has an element per declared
    /// layer: a grid of zeros over `window` if the layer is requested, otherwise `None`.
    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()>;

    /// The computation of the filter on a graphics card, at this cell in metres.
    #[doc(hidden)]
    fn lower(&self, cell: f64, world_params: &WorldParams) -> Lowering<Passes> {
        let _ = (cell, world_params);
        Lowering::Missing
    }

    /// Approximate nanoseconds per sample at this cell.
    fn cost(&self, cell: f64) -> f64 {
        let _ = cell;
        5.0
    }

    /// Whether the result depends on the world's sea level. A filter that returns false must not read it, because the
    /// content key would be wrong.
    fn reads_sea_level(&self) -> bool {
        false
    }

    /// Whether the result depends on the world's extent. A filter that returns false must not read it, because the
    /// content key would be wrong.
    fn reads_size(&self) -> bool {
        false
    }
}

/// The grid of a filter with one layer, from the `out` of [`Filter::apply`].
///
/// # Errors
/// If there is not exactly one grid. This is an internal error, because plans always provide it.
pub fn only_layer(out: &mut [Option<Grid>]) -> Result<&mut Grid> {
    match out {
        [Some(out)] => Ok(out),
        _ => Err(wrong_layers()),
    }
}

/// The internal error for a filter that does not get the grids of its layers.
pub(crate) fn wrong_layers() -> Error {
    Error::new(ErrorKind::Internal, "a filter was given grids for other layers than its own")
}

/// The lattices of a levelled op: each has half the cell of the one above it, and all have a sample at the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// The cell of the finest level, in metres.
    pub finest: f64,
    /// Number of levels, 1 to 64. Level 0 is the coarsest.
    pub count: usize,
}

impl Levels {
    /// The cell of a level, in metres: a power of two times the finest.
    #[must_use]
    pub fn cell(&self, level: usize) -> f64 {
        let halvings = self.count.saturating_sub(1).saturating_sub(level).min(63);
        self.finest * (1u64 << halvings) as f64
    }

    /// The level from which a window with this cell is read: the coarsest level with the same or a smaller cell,
    /// otherwise the finest level.
    #[must_use]
    pub fn serving(&self, cell: f64) -> usize {
        (0..self.count).find(|level| self.cell(*level) <= cell).unwrap_or(self.count.saturating_sub(1))
    }
}

/// A levelled op is a pyramid of lattices. Each level over a window depends only on the coarser level over that window
/// and a finite halo. A coarse level is therefore a preview of the finer ones, and no window depends on the extent of
/// the world. Level 0 depends only on the op's inputs, positions and the seed.
///
/// The data of a level are *planes*: grids over its window whose meaning only the op knows. The layers are computed
/// from the planes at the end.
pub trait Levelled: Declared + Send + Sync {
    /// The lattices.
    fn levels(&self) -> Levels;

    /// Number of planes of each level.
    fn planes(&self) -> usize;

    /// Number of samples of the level above that [`Levelled::refine`] to `level` reads beyond the halved window.
    fn halo(&self, level: usize) -> usize;

    /// Number of samples of the op's inputs that a level reads beyond the window.
    fn source_halo(&self, level: usize) -> usize {
        let _ = level;
        0
    }

    /// The level whose data are at the samples of its lattice; the data of other levels may be between the samples.
    fn level_at_samples(&self) -> usize {
        self.levels().count.saturating_sub(1)
    }

    /// Whether a level reads an input, by its number. Levels get only the inputs that they read.
    fn reads_input(&self, level: usize, input: usize) -> bool {
        let _ = (level, input);
        true
    }

    /// The planes of level 0 over `window`. Each given input covers `window.grown(source_halo(0))`.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn coarsest(&self, inputs: &GridInputs, window: &Window, context: &Context) -> Result<Vec<Grid>>;

    /// The planes of `level`, at least 1, over `window`, from the planes of the level above over [the window's
    /// parent](Levelled::parent). Each given input covers `window.grown(source_halo(level))` at the cell of the level.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn refine(
        &self,
        level: usize,
        parent: &[Grid],
        inputs: &GridInputs,
        window: &Window,
        context: &Context,
    ) -> Result<Vec<Grid>>;

    /// Number of samples of a level that [`Levelled::layers_of`] reads beyond the window. `wanted` says for each
    /// declared layer whether it is requested.
    fn surface_halo(&self, level: usize, wanted: &[bool]) -> usize;

    /// Computes layers over `window` from the planes of `level` over `window` grown by the [halo of the wanted
    /// layers](Levelled::surface_halo). `out` is as in [`Filter::apply`].
    ///
    /// # Errors
    /// If the work was cancelled.
    fn layers_of(
        &self,
        level: usize,
        planes: &[Grid],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()>;

    /// The computation of [`Levelled::refine`] on a graphics card. `given` says for each input whether it is given.
    #[doc(hidden)]
    fn lower(&self, level: usize, given: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let _ = (level, given, world_params);
        Lowering::Missing
    }

    /// The computation of [`Levelled::layers_of`] on a graphics card, for the wanted layers, from a level that it has
    /// made.
    #[doc(hidden)]
    fn lower_layers(&self, level: usize, wanted: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let _ = (level, wanted, world_params);
        Lowering::Missing
    }

    /// Memory for making a level over `window` in addition to planes and layers, in bytes.
    fn scratch(&self, level: usize, window: &Window) -> u64 {
        let _ = (level, window);
        0
    }

    /// Approximate nanoseconds per sample of a level.
    fn cost(&self, level: usize) -> f64 {
        let _ = level;
        1000.0
    }

    /// Whether the result depends on the world's sea level. An op that returns false must not read it, because the
    /// content key would be wrong.
    fn reads_sea_level(&self) -> bool {
        false
    }

    /// The samples of the level above from which `level` over `window` is made: from half the first index, rounded
    /// down, to half the last index, rounded up, and the halo around them.
    fn parent(&self, level: usize, window: &Window) -> Window {
        halved(window, self.levels().cell(level.saturating_sub(1))).grown(self.halo(level))
    }
}

/// The samples of the lattice with `cell`, twice the window's cell, from half the window's first index, rounded down,
/// to half its last index, rounded up.
#[must_use]
pub fn halved(window: &Window, cell: f64) -> Window {
    let halved = |first: i64, end: i64| (first.div_euclid(2), end.div_euclid(2) + 1);
    let ((x, right), (y, bottom)) = (halved(window.x, window.right()), halved(window.y, window.bottom()));
    let (width, height) = ((right - x).max(0) as usize, (bottom - y).max(0) as usize);
    Window { x, y, width, height, cell }
}

/// The solution of a solver, which is read like a field.
#[derive(Debug)]
pub struct Solution {
    /// One raster per layer; empty if the solution consists of numbers only.
    pub layers: Vec<Raster>,
    /// Numbers, whose meaning is defined by the solver.
    pub scalars: Vec<f64>,
}

impl Solution {
    /// Memory of the solution, in bytes.
    pub fn memory(&self) -> u64 {
        self.layers.iter().map(Raster::memory).sum::<u64>() + self.scalars.len() as u64 * 8
    }

    /// Interpolates the raster of a layer.
    pub(crate) fn read(&self, asked: &Reading, out: &mut [f32]) -> Result<()> {
        match self.layers.get(asked.layer) {
            Some(raster) => raster.read(asked.kind, asked.at, out),
            None => Err(Error::new(ErrorKind::Internal, format!("a solution has no layer {}", asked.layer))),
        }
    }

    /// Interpolates the raster of a layer. Layers with these numbers are never negative: the cubic may undershoot 0
    /// beside what has a thickness.
    pub(crate) fn read_positive(&self, layers: &[usize], asked: &Reading, out: &mut [f32]) -> Result<()> {
        self.read(asked, out)?;
        if layers.contains(&asked.layer) {
            out.iter_mut().for_each(|value| *value = value.max(0.0));
        }
        Ok(())
    }
}

/// A solver's inputs over its whole domain, computed tile by tile on request, and rasters for intermediate data.
pub trait Sources {
    /// The samples of the domain: the world, 0 ..= extent / cell on both axes, and the solver's
    /// [margin](crate::declare::Declared::margin) beyond each side.
    fn domain(&self) -> &Window;

    /// The domain with the two samples beyond its edge that readers may need. A solution's layers must cover it.
    fn padded(&self) -> &Window;

    /// Whether the input with this name is given.
    fn given(&self, name: &str) -> bool;

    /// Computes the input with this name over each tile of `window` in a fixed order, and passes it to `visit`. The
    /// tiles cover the window once.
    ///
    /// # Errors
    /// If the input is not given or not declared, which is an internal error; the errors of `visit`; or if the work was
    /// cancelled.
    fn each_tile(&self, name: &str, window: &Window, visit: &mut dyn FnMut(&Grid) -> Result<()>) -> Result<()>;

    /// The input with this name over all of `window` at once, for solvers that cannot work tile by tile. Include it in
    /// [`Solver::scratch`].
    ///
    /// # Errors
    /// The errors of [`Sources::each_tile`].
    fn whole(&self, name: &str, window: &Window) -> Result<Grid> {
        let mut grid = Grid::filled(*window, 0.0f32);
        self.each_tile(name, window, &mut |tile| {
            grid.paste(tile);
            Ok(())
        })?;
        Ok(grid)
    }

    /// A raster of zeros over [`Sources::padded`], for intermediate data or for the result, in memory or on disk
    /// depending on the budget.
    fn raster(&self) -> Result<Raster>;

    /// Whether rasters are on disk because memory is short.
    fn on_disk(&self) -> bool;

    /// Converts a grid over [`Sources::padded`] into a raster of the result, which may be moved to disk.
    fn keep(&self, grid: Grid) -> Result<Raster>;
}

/// A request for values of a solution.
pub struct Reading<'a> {
    /// Index of the layer.
    pub layer: usize,
    /// The interpolation of the layer.
    pub kind: LayerKind,
    /// The points.
    pub at: &'a Points<'a>,
    /// The solver's inputs at those points, if it reads them.
    pub inputs: &'a Inputs<'a>,
}

/// A solver depends on the whole bounded world, or a domain that extends beyond it by the solver's
/// [margin](crate::declare::Declared::margin), and runs once, at its own cell.
pub trait Solver: Declared + Send + Sync {
    /// The cell of the solver's lattice, in metres.
    fn cell(&self, world_cell: f64) -> f64 {
        world_cell
    }

    /// Maximum number of rasters of its domain that it holds at once, for layers of the solution and intermediate data.
    fn rasters(&self) -> usize {
        self.spec().layers.len()
    }

    /// Memory for solving in addition to the rasters, in bytes, for [`Sources::padded`]. 0 for a solver that works tile
    /// by tile. A solver that needs whole grids counts all grids that it holds at once, including those that become
    /// layers.
    fn scratch(&self, padded: &Window) -> u64 {
        let _ = padded;
        0
    }

    /// [`Solver::scratch`] if its rasters are on disk, for a solver that then works tile by tile, with the same bits.
    /// The solver calls [`Sources::on_disk`] to choose.
    fn scratch_on_disk(&self, padded: &Window) -> u64 {
        self.scratch(padded)
    }

    /// Whether [`Solver::read`] receives the inputs at the requested points.
    fn reads_inputs(&self) -> bool {
        false
    }

    /// Solves the world. The result must not depend on how the sources are split into tiles.
    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution>;

    /// Computes one value per point from the solution; by default, interpolates the layer's raster.
    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        solution.read(asked, out)
    }

    /// The computation of [`Solver::solve`] on a graphics card over `padded`, the window of [`Sources::padded`].
    /// `given` says for each input whether it is given. The result is the layers of the solution, without numbers.
    #[doc(hidden)]
    fn lower(&self, padded: &Window, given: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let _ = (padded, given, world_params);
        Lowering::Missing
    }

    /// The computation of [`Solver::read`] on a graphics card.
    #[doc(hidden)]
    fn lower_read(&self, layer: usize, solution: &Solution) -> Lowering<Shader> {
        let _ = (layer, solution);
        Lowering::Processor("rasters of solutions are interpolated by the processor")
    }

    /// Approximate nanoseconds per sample of its domain for solving, without its sources.
    fn cost(&self) -> f64 {
        1.0
    }

    /// Whether the solution depends on the world's sea level. A solver that returns false must not read it, because the
    /// content key would be wrong.
    fn reads_sea_level(&self) -> bool {
        false
    }
}

/// A type that is an op. [`op!`](crate::op!) implements it according to the declared locality.
pub trait OpType: Declared + Debug + Default + Clone + PartialEq + Send + Sync + 'static {
    /// The op, by its locality.
    fn as_op(&self) -> Op<'_>;
}

/// An op, by its locality.
pub enum Op<'a> {
    /// Depends on one position.
    Field(&'a dyn Field),
    /// Depends on a halo.
    Filter(&'a dyn Filter),
    /// Depends on a halo of the next coarser level.
    Levelled(&'a dyn Levelled),
    /// Depends on the whole world.
    Solver(&'a dyn Solver),
}
