//! What an op is: a field, a filter or a solver, and what each is given.

use crate::declare::Declared;
use crate::expression::term::{self, Term};
use crate::layer::LayerKind;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::format::dem::Georeference;
use orogen_io::raster::Raster;
use orogen_noise::Points;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

/// What the world tells every op.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WorldParams {
    /// The world's seed.
    pub seed: u64,
    /// The world's extent in metres, east and south; `None` if it has no bounds.
    pub size: Option<[f64; 2]>,
    /// Metres from one sample of the world's own lattice to the next.
    pub cell: f64,
    /// Height of the sea's surface in metres.
    pub sea_level: f64,
}

impl WorldParams {
    /// A node's seed within this world: two numbers hashed to one, so that worlds and nodes with neighbouring seeds have
    /// nothing in common (splitmix64's finaliser, Steele, Lea and Flood 2014, over both).
    pub fn seed_of(&self, node_seed: u64) -> u64 {
        let mix = |mut z: u64| {
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            z ^ (z >> 31)
        };
        let world = mix(self.seed.wrapping_add(0x9E37_79B9_7F4A_7C15));
        mix(world ^ node_seed.wrapping_mul(0xD1B5_4A32_D192_ED03))
    }
}

/// A node's inputs evaluated at the points asked for: one block of samples each.
pub struct Inputs<'a> {
    slots: &'a [Option<&'a [f32]>],
}

impl<'a> Inputs<'a> {
    /// Over the inputs in the order of their declaration.
    pub fn new(slots: &'a [Option<&'a [f32]>]) -> Inputs<'a> {
        Inputs { slots }
    }

    /// Input `i` where it is given.
    pub fn get(&self, i: usize) -> Option<&'a [f32]> {
        self.slots.get(i).copied().flatten()
    }

    /// Input `i`, which the declaration requires: a plan is never made without it.
    pub fn required(&self, i: usize) -> &'a [f32] {
        self.get(i).unwrap_or(&[])
    }
}

/// A field looks at one position and the seed, and at its inputs there. It is pure: any point, any order, any number of
/// times.
pub trait Field: Send + Sync {
    /// Makes one value a point. A field that has [`Field::terms`] need not say how.
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        let _ = (at, world_params);
        term::evaluate(&self.terms().unwrap_or_default(), |input| inputs.get(input), out);
    }

    /// What it computes, where that is functions of its inputs alone: each input by its index as a name. The engine then computes it by these
    /// terms, and never calls [`Field::eval`].
    fn terms(&self) -> Option<Vec<Term>> {
        None
    }

    /// Where a field's source is read elsewhere than at the position asked for. Such a field's [`Field::eval`] is never
    /// called: the engine moves the points and evaluates the source there.
    fn coord_map(&self) -> Option<CoordMap> {
        None
    }

    /// Whether the field also reads a source around the position asked for, to know its slope.
    fn stencil(&self) -> Option<Stencil> {
        None
    }

    /// Whether the field only makes sense in a world with bounds.
    fn needs_bounds(&self) -> bool {
        false
    }

    /// Bytes of memory that it holds of files, for as long as its world is open.
    fn memory(&self) -> u64 {
        0
    }

    /// How the world's metres lie on a map, if this is a real place that says so.
    fn georeference(&self) -> Option<Georeference> {
        None
    }

    /// About how many nanoseconds a sample takes: what is dear is made once and kept rather than made again.
    fn cost(&self) -> f64 {
        0.2
    }

    /// The same of a field without inputs where all samples stand in columns and rows.
    fn cost_in_rows(&self) -> f64 {
        self.cost() * IN_ROWS
    }
}

/// What is made of nothing but the position takes this share of its cost where rows share what they have in common.
const IN_ROWS: f64 = 0.15;

/// A source that a field also reads around its position. The field is given, behind its inputs, that source `step` metres to the
/// east, the west, the south and the north. The engine makes the four places and evaluates the source there, so a field's slope
/// is known at any point, and nothing is made of neighbouring samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stencil {
    /// Index of the input.
    pub source: usize,
    /// Metres from the position to each of the four.
    pub step: f64,
}

impl Stencil {
    /// The maps to the four places: east, west, south, north.
    pub fn maps(&self) -> [Affine; 4] {
        [[self.step, 0.0], [-self.step, 0.0], [0.0, self.step], [0.0, -self.step]].map(|offset| Affine {
            turn: [1.0, 0.0],
            scale: 1.0,
            offset,
        })
    }
}

/// How a field moves the points at which its source is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CoordMap {
    /// By two inputs times `strength` metres; each displacement is clamped to -reach ..= reach.
    Displaced {
        /// Index of the input that is read elsewhere.
        source: usize,
        /// Index of the input that moves it east.
        east: usize,
        /// Index of the input that moves it south.
        south: usize,
        /// Metres moved for an input of 1.
        strength: f64,
        /// The farthest it may be moved along each axis, in metres.
        reach: f64,
    },
    /// By an affine map of the position.
    Mapped {
        /// Index of the input that is read elsewhere.
        source: usize,
        /// The map from the position asked for to the one that is read.
        map: Affine,
    },
}

/// A similarity of the plane: p -> turn(p) * scale + offset.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Affine {
    /// Cosine and sine of the turn; [1, 0] is none.
    pub turn: [f64; 2],
    /// Factor.
    pub scale: f64,
    /// Metres added, east and south.
    pub offset: [f64; 2],
}

impl Affine {
    /// Whether columns stay columns and rows stay rows.
    pub fn is_separable(&self) -> bool {
        self.turn == [1.0, 0.0]
    }

    /// Where a position is read. Without a turn the result is x * scale + offset bit for bit, so lattices stay lattices.
    pub fn apply(&self, x: f64, y: f64) -> (f64, f64) {
        let (tx, ty) = if self.is_separable() {
            (x, y)
        } else {
            (self.turn[0] * x - self.turn[1] * y, self.turn[1] * x + self.turn[0] * y)
        };
        (tx * self.scale + self.offset[0], ty * self.scale + self.offset[1])
    }
}

/// What a filter or solver is given beside its inputs.
pub struct Context<'a> {
    /// The world's facts.
    pub world_params: &'a WorldParams,
    /// Where to report how far the work has come, and to ask whether it is still wanted.
    pub progress: &'a Progress,
    /// Who wants to know what a solver that goes step by step would end with earlier.
    pub observer: Option<&'a (dyn StepObserver + Sync)>,
}

/// Takes what a solver that goes step by step would end with after some of its steps: the solution of a shorter run of the same steps.
pub trait StepObserver {
    /// Whether the solution after so many steps is wanted: 0 is that of one step that takes no time. It is not asked about the last.
    fn wants(&self, step: u32) -> bool;

    /// Whether a layer of those solutions is read. If none after the first is, the solver may leave them out.
    fn reads(&self, layer: usize) -> bool;

    /// Takes that solution.
    ///
    /// # Errors
    /// Any error ends the solver's work with it.
    fn take(&self, step: u32, solution: Solution) -> Result<()>;
}

/// A filter looks at a finite halo. Its inputs arrive grown by that halo; what it makes is the same whatever window it is
/// made in.
pub trait Filter: Declared + Send + Sync {
    /// Samples that an input is read beyond the window on each side, at this cell.
    fn halo(&self, cell: f64) -> usize;

    /// Bytes needed beside inputs and layers to make `window`.
    fn scratch(&self, window: &Window) -> u64 {
        let _ = window;
        0
    }

    /// Makes layers over `window`; each input given covers `window.grown(halo)`. `out` has a place for each declared layer:
    /// a grid of zeros over `window` where the layer is wanted, nothing where nobody reads it.
    fn apply(
        &self,
        inputs: &[Option<&Grid>],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()>;

    /// About how many nanoseconds a sample takes at this cell.
    fn cost(&self, cell: f64) -> f64 {
        let _ = cell;
        5.0
    }

    /// Whether the result depends on the world's sea level. A filter that says no and reads it nevertheless breaks content keys.
    fn reads_sea_level(&self) -> bool {
        false
    }
}

/// What a solver found: read like a field ever after.
#[derive(Debug)]
pub struct Solution {
    /// One raster a layer, or none if the solution is numbers alone.
    pub layers: Vec<Raster>,
    /// Numbers, their meaning known to the solver.
    pub scalars: Vec<f64>,
}

impl Solution {
    /// Bytes of memory it takes.
    pub fn memory(&self) -> u64 {
        self.layers.iter().map(Raster::memory).sum::<u64>() + self.scalars.len() as u64 * 8
    }
}

/// A solver's inputs over the whole world, made tile by tile as it asks, and rasters to work in.
pub trait Sources {
    /// The samples of the world: 0 ..= extent / cell on both axes.
    fn world(&self) -> &Window;

    /// The world with its margin for readers: what a solution's layers cover.
    fn padded(&self) -> &Window;

    /// Whether input `i` is given.
    fn given(&self, i: usize) -> bool;

    /// Makes input `i` over each tile of `window` in a fixed order and hands it on. The tiles cover the window once; there is
    /// none if the input is not given.
    fn each_tile(&self, i: usize, window: &Window, visit: &mut dyn FnMut(&Grid) -> Result<()>) -> Result<()>;

    /// Input `i` over all of `window` at once, zero if it is not given: for solvers that cannot work tile by tile. Count it in
    /// [`Solver::scratch`].
    fn whole(&self, i: usize, window: &Window) -> Result<Grid> {
        let mut grid = Grid::filled(*window, 0.0f32);
        self.each_tile(i, window, &mut |tile| {
            grid.paste(tile);
            Ok(())
        })?;
        Ok(grid)
    }

    /// A raster of zeros over [`Sources::padded`], to solve in or to return: in memory or on disk, as the budget says.
    fn raster(&self) -> Result<Raster>;

    /// Whether rasters are on disk, because memory is short.
    fn on_disk(&self) -> bool;

    /// A grid over [`Sources::padded`] as a raster to return: it may leave memory for the disk.
    fn keep(&self, grid: Grid) -> Result<Raster>;
}

/// What is asked of a solution.
pub struct Reading<'a> {
    /// Index of the layer.
    pub layer: usize,
    /// How the layer is read between its samples.
    pub kind: LayerKind,
    /// Where.
    pub at: &'a Points<'a>,
    /// The solver's inputs at those points, if it reads them.
    pub inputs: &'a Inputs<'a>,
}

/// A solver looks at the whole bounded world, once, at a cell of its own.
pub trait Solver: Declared + Send + Sync {
    /// Metres from one sample to the next of the lattice it is solved on.
    fn cell(&self, world_cell: f64) -> f64 {
        world_cell
    }

    /// How many rasters of the world it holds at once at most: the layers of the solution and those it works in.
    fn rasters(&self) -> usize {
        self.spec().layers.len()
    }

    /// Bytes of memory that solving takes beside those rasters, when the world with its margin has this window. A solver that
    /// works tile by tile takes none; one that needs whole grids counts all it holds at once, those that it then keeps as
    /// layers included.
    fn scratch(&self, padded: &Window) -> u64 {
        let _ = padded;
        0
    }

    /// The same when its rasters are on disk, for a solver that then works another way: tile by tile, its result the same to the
    /// bit. It asks [`Sources::on_disk`] which way to take.
    fn scratch_on_disk(&self, padded: &Window) -> u64 {
        self.scratch(padded)
    }

    /// Whether [`Solver::read`] is given the inputs at the points it is asked for.
    fn reads_inputs(&self) -> bool {
        false
    }

    /// Solves the world. The result must not depend on how the sources are cut into tiles.
    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution>;

    /// Makes one value a point from the solution: unless said otherwise, what the layer's raster shows there.
    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        match solution.layers.get(asked.layer) {
            Some(raster) => raster.read(asked.kind, asked.at, out),
            None => Err(Error::new(ErrorKind::Internal, format!("a solution has no layer {}", asked.layer))),
        }
    }

    /// About how many nanoseconds a sample of the world takes to solve, its sources not counted.
    fn cost(&self) -> f64 {
        1.0
    }

    /// Whether the solution depends on the world's sea level. A solver that says no and reads it nevertheless breaks content keys.
    fn reads_sea_level(&self) -> bool {
        false
    }
}

/// A type that is an op. [`op!`](crate::op!) implements it, by the locality that it declares.
pub trait OpType: Declared + Debug + Default + Clone + PartialEq + Send + Sync + 'static {
    /// The op as what it is.
    fn as_op(&self) -> Op<'_>;
}

/// A node as what it is.
pub enum Op<'a> {
    /// Looks at one position.
    Field(&'a dyn Field),
    /// Looks at a halo.
    Filter(&'a dyn Filter),
    /// Looks at the whole world.
    Solver(&'a dyn Solver),
}
