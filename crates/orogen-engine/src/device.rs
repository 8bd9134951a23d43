//! Devices that compute steps of plans where exact bits are not needed, such as graphics cards.

use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_noise::shader::function::Shader;
use orogen_ops::expression::function::Function;
use orogen_ops::layer::LayerKind;
use orogen_ops::lower::Passes;
use orogen_ops::op::Affine;
use std::any::Any;
use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

/// Computes steps of plans in place of the processor. Its results are close to those of the processor, and not the
/// same: a [session](crate::Session) keeps none of them for later requests, and gives nothing of them to solvers and
/// levelled ops.
///
/// What the device does not compute, the processor does. An error ends the request. What a step makes may stay on the
/// device until the processor [asks](Device::read) for it.
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
    ) -> Result<Computed<Vec<PlanGrid>>> {
        let _ = (program, window, grids, progress);
        Ok(Computed::Declined)
    }

    /// Computes the wanted layers of the last of some passes.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn run(&self, run: &PassRun, progress: &Progress) -> Result<Computed<Vec<PlanGrid>>> {
        let _ = (run, progress);
        Ok(Computed::Declined)
    }

    /// Copies grids that the device made to the processor's memory.
    ///
    /// # Errors
    /// If the work was cancelled.
    fn read(&self, grids: &[&DeviceGrid], progress: &Progress) -> Result<Computed<Vec<Grid>>> {
        let _ = (grids, progress);
        Ok(Computed::Lost)
    }
}

/// What comes of work.
#[derive(Debug, Clone, PartialEq)]
pub enum Computed<T> {
    /// This.
    Done(T),
    /// Nothing, because it cannot be done here, or has failed.
    Declined,
    /// Nothing, because the device has lost a grid that it had made: the processor makes all again.
    Lost,
}

impl<T> Computed<T> {
    /// What was computed, if it was.
    #[must_use]
    pub fn done(self) -> Option<T> {
        match self {
            Computed::Done(made) => Some(made),
            Computed::Declined | Computed::Lost => None,
        }
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

/// Passes one after the other.
#[derive(Debug, Clone, Copy)]
pub struct PassRun<'a> {
    /// The passes: those of a filter or a solver, or of levels, each from the layers of the one before, and of layers
    /// of the last level. Each level covers the samples that the next one reads.
    pub steps: &'a [PassStep<'a>],
    /// The planes of the level above the first, over exactly the samples that `Levelled::refine` gets.
    pub above: &'a [Grid],
    /// Whether the result may stay on the device. Otherwise it is in memory.
    pub stays: bool,
}

/// Passes with what they are run on.
#[derive(Debug, Clone)]
pub struct PassStep<'a> {
    /// The passes.
    pub passes: Passes,
    /// The op's inputs, which cover at least what it reads of them.
    pub inputs: Vec<Option<Cow<'a, PlanGrid>>>,
    /// The window of the result.
    pub window: Window,
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
