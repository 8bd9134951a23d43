//! Devices that compute steps of plans where exact bits are not needed, such as graphics cards.

use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_noise::shader::function::Shader;
use orogen_ops::expression::function::Function;
use orogen_ops::layer::LayerKind;
use orogen_ops::lower::{LayerPasses, LevelPasses, Passes};
use orogen_ops::op::Affine;
use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// Computes steps of plans in place of the processor. Its results are close to those of the processor, and not the
/// same: a [session](crate::Session) keeps none of them for later requests, and gives nothing of them to solvers and
/// levelled ops.
///
/// A step that returns `None` is computed by the processor: because the device cannot do it, or has failed. An error
/// ends the request. What a step makes may stay on the device until the processor [asks](Device::read) for it.
pub trait Device: Send + Sync {
    /// Whether it is the processor itself, by a software driver: then it is slower than without it.
    fn is_software(&self) -> bool {
        false
    }

    /// Computes the outputs of a program over a window. `grids` are those that the program reads.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn fill(
        &self,
        program: &LoweredProgram,
        window: &Window,
        grids: &[&PlanGrid],
        progress: &Progress,
    ) -> Result<Option<Vec<PlanGrid>>>;

    /// Computes the wanted layers of a filter over a window; the inputs cover at least the window grown by the halo.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn apply(
        &self,
        passes: &Passes,
        inputs: &[Option<&PlanGrid>],
        extent: &FilterExtent,
        progress: &Progress,
    ) -> Result<Option<Vec<Option<PlanGrid>>>>;

    /// Copies grids that the device made to the processor's memory. `None` if the device has lost one of them: the
    /// processor then makes all again.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn read(&self, grids: &[&DeviceGrid], progress: &Progress) -> Result<Option<Vec<Grid>>> {
        let _ = (grids, progress);
        Ok(None)
    }

    /// Grids that the device made, in the processor's memory; `None` if it has lost one of them.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn fetch(&self, grids: Vec<PlanGrid>, progress: &Progress) -> Result<Option<Vec<Grid>>> {
        let away: Vec<&DeviceGrid> =
            grids.iter().filter(|grid| grid.memory.is_none()).filter_map(PlanGrid::on_device).collect();
        let read = if away.is_empty() { Some(Vec::new()) } else { self.read(&away, progress)? };
        let Some(mut read) = read.map(Vec::into_iter) else { return Ok(None) };
        Ok(grids.into_iter().map(|grid| grid.memory.or_else(|| read.next())).collect())
    }

    /// Computes the planes of the last of some levels, each from those of the level above it. Those above the first are
    /// given over exactly the samples that `Levelled::refine` gets, and each level covers those that the next one
    /// reads.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn refine(&self, levels: &[LevelStep], above: &[Grid], progress: &Progress) -> Result<Option<Vec<Grid>>> {
        let _ = (levels, above, progress);
        Ok(None)
    }

    /// Computes layers from the last of some levels, which are made as by [`Device::refine`].
    ///
    /// # Errors
    /// If the work was cancelled.
    fn layers(
        &self,
        levels: &[LevelStep],
        layers: &LayerStep,
        above: &[Grid],
        progress: &Progress,
    ) -> Result<Option<Vec<PlanGrid>>> {
        let _ = (levels, layers, above, progress);
        Ok(None)
    }

    /// Computes the layers of a solution over a window from the solver's inputs over the same window.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn solve(
        &self,
        passes: &Passes,
        inputs: &[Option<&Grid>],
        window: &Window,
        progress: &Progress,
    ) -> Result<Option<Vec<Grid>>> {
        let _ = (passes, inputs, window, progress);
        Ok(None)
    }
}

/// A grid that a step of a plan makes: in the processor's memory, on the device that made it, or both.
#[derive(Debug, Clone)]
pub struct PlanGrid {
    memory: Option<Grid>,
    on_device: Option<DeviceGrid>,
    window: Window,
}

impl PlanGrid {
    /// The window.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The grid, if it is in the processor's memory.
    #[must_use]
    pub fn memory(&self) -> Option<&Grid> {
        self.memory.as_ref()
    }

    /// The grid in the processor's memory, if it is there.
    #[must_use]
    pub fn into_memory(self) -> Option<Grid> {
        self.memory
    }

    /// The grid on the device, if it is there.
    #[must_use]
    pub fn on_device(&self) -> Option<&DeviceGrid> {
        self.on_device.as_ref()
    }

    /// The same grid, also in the processor's memory.
    #[must_use]
    pub fn with_memory(self, grid: Grid) -> PlanGrid {
        PlanGrid { memory: Some(grid), ..self }
    }
}

impl From<Grid> for PlanGrid {
    fn from(grid: Grid) -> PlanGrid {
        PlanGrid { window: *grid.window(), memory: Some(grid), on_device: None }
    }
}

impl From<DeviceGrid> for PlanGrid {
    fn from(grid: DeviceGrid) -> PlanGrid {
        PlanGrid { window: grid.window, memory: None, on_device: Some(grid) }
    }
}

/// A grid in the memory of a device. Clones share it.
#[derive(Clone)]
pub struct DeviceGrid {
    window: Window,
    samples: Arc<dyn Any + Send + Sync>,
}

impl DeviceGrid {
    /// A grid over a window; `samples` is what the device knows its samples by.
    #[must_use]
    pub fn new<T: Any + Send + Sync>(window: Window, samples: T) -> DeviceGrid {
        DeviceGrid { window, samples: Arc::new(samples) }
    }

    /// The window.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// What the device knows its samples by; `None` if that has another type.
    #[must_use]
    pub fn samples<T: Any>(&self) -> Option<&T> {
        self.samples.downcast_ref()
    }
}

impl fmt::Debug for DeviceGrid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DeviceGrid").field("window", &self.window).finish_non_exhaustive()
    }
}

/// A level that is made from the one above it.
#[derive(Debug, Clone)]
pub struct LevelStep {
    /// How.
    pub passes: LevelPasses,
    /// The op's inputs, which cover at least what it reads of them.
    pub inputs: Vec<Option<Grid>>,
    /// The window of the level.
    pub window: Window,
}

/// Layers that are made from a level.
#[derive(Debug, Clone)]
pub struct LayerStep {
    /// How.
    pub passes: LayerPasses,
    /// The window of the layers.
    pub window: Window,
    /// Samples around it that the level covers.
    pub halo: usize,
}

/// What of a filter is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterExtent {
    /// The window of the result.
    pub window: Window,
    /// Samples beyond it on each side that the inputs have.
    pub halo: usize,
    /// Which layers are wanted.
    pub wanted: Vec<bool>,
}

/// A program for a device: each instruction makes the value of its index, and each coordinate set is written once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LoweredProgram {
    /// The instructions, in order.
    pub instructions: Vec<Lowered>,
    /// The coordinate sets. The first is the block itself.
    pub coord_sets: Vec<LoweredCoords>,
    /// The values that are the results.
    pub outputs: Vec<usize>,
}

/// An instruction for a device. Numbers name values and coordinate sets.
#[derive(Debug, Clone, PartialEq)]
pub enum Lowered {
    /// A constant.
    Constant(f32),
    /// A field.
    Field {
        /// The function that computes it.
        shader: Shader,
        /// The coordinate set.
        coords: usize,
        /// Its inputs there; a missing one is 0.
        inputs: Vec<Option<usize>>,
    },
    /// A function of numbers.
    Apply {
        /// The function.
        function: Function,
        /// Its arguments.
        arguments: Vec<LoweredOperand>,
    },
    /// A grid at a coordinate set.
    Grid {
        /// Index of the grid.
        grid: usize,
        /// The interpolation.
        kind: LayerKind,
        /// The coordinate set.
        coords: usize,
    },
    /// source + (result - source) * mask, with the mask clamped to 0 ..= 1; a missing source is 0.
    Mask {
        /// The value where the mask is 0.
        source: Option<usize>,
        /// The value where the mask is 1.
        result: usize,
        /// The mask.
        mask: usize,
    },
}

/// An argument of a function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoweredOperand {
    /// A constant.
    Number(f32),
    /// A value.
    Value(usize),
}

/// A coordinate set for a device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoweredCoords {
    /// The block itself.
    Block,
    /// Displaced by two values times a strength, each clamped to the reach.
    Displaced {
        /// The coordinate set that is displaced.
        from: usize,
        /// Displacement east.
        east: usize,
        /// Displacement south.
        south: usize,
        /// Metres per unit of the values.
        strength: f64,
        /// Maximum displacement along an axis, in metres.
        reach: f64,
    },
    /// Mapped by a similarity.
    Mapped {
        /// The coordinate set that is mapped.
        from: usize,
        /// The map.
        map: Affine,
    },
}

impl LoweredProgram {
    /// The values that an instruction reads, with those of its coordinate set.
    #[must_use]
    pub fn reads(&self, instruction: usize) -> Vec<usize> {
        let Some(lowered) = self.instructions.get(instruction) else { return Vec::new() };
        let (mut values, coords) = match lowered {
            Lowered::Constant(_) => (Vec::new(), 0),
            Lowered::Field { inputs, coords, .. } => (inputs.iter().flatten().copied().collect(), *coords),
            Lowered::Apply { arguments, .. } => {
                let value = |argument: &LoweredOperand| match argument {
                    LoweredOperand::Value(value) => Some(*value),
                    LoweredOperand::Number(_) => None,
                };
                (arguments.iter().filter_map(value).collect(), 0)
            }
            Lowered::Grid { coords, .. } => (Vec::new(), *coords),
            Lowered::Mask { source, result, mask } => (source.iter().copied().chain([*result, *mask]).collect(), 0),
        };
        let mut coords = coords;
        while let Some(set) = self.coord_sets.get(coords) {
            match *set {
                LoweredCoords::Block => break,
                LoweredCoords::Displaced { from, east, south, .. } => {
                    values.extend([east, south]);
                    coords = from;
                }
                LoweredCoords::Mapped { from, .. } => coords = from,
            }
        }
        values
    }
}
