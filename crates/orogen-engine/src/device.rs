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

/// Computes steps of plans in place of the processor. The results are close to the processor's, but not bit-equal. A
/// [session](crate::Session) therefore does not keep them for later requests, and does not pass them to solvers and
/// levelled ops.
///
/// The processor computes whatever the device declines. An error ends the request. The result of a step may stay on the
/// device until the processor [reads](Device::read) it.
pub trait Device: Send + Sync {
    /// Whether the device is a software driver that runs on the processor; it is then slower than computing without it.
    fn is_software(&self) -> bool {
        false
    }

    /// Computes the outputs of a program over a window. `grids` are the grids that the program reads.
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

    /// Runs passes one after the other and computes the wanted layers of the last one.
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

/// The result of work that a device may decline.
#[derive(Debug, Clone, PartialEq)]
pub enum Computed<T> {
    /// This.
    Done(T),
    /// No result: the device cannot do this work, or has failed.
    Declined,
    /// No result: the device has lost a grid that it had made. The processor computes everything again.
    Lost,
}

impl<T> Computed<T> {
    /// The computed value; `None` if the work was declined or lost.
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

    /// The grid, if it is in the processor's memory; drops any copy on the device.
    #[must_use]
    pub fn into_memory(self) -> Option<Grid> {
        self.memory
    }

    /// The grid, if it is on the device.
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
    /// A grid over a window. `samples` is the device's handle for its samples, such as a buffer.
    #[must_use]
    pub fn new<T: Any + Send + Sync>(window: Window, samples: T) -> DeviceGrid {
        DeviceGrid { window, samples: Arc::new(samples) }
    }

    /// The window.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The device's handle for the samples; `None` if it has another type.
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

/// Passes to be run one after the other.
#[derive(Debug, Clone, Copy)]
pub struct PassRun<'a> {
    /// The passes: of a filter, of a solver, or of levels followed by the layers of the last level. Each level reads
    /// the layers of the level before it, which cover the samples that it needs.
    pub steps: &'a [PassStep<'a>],
    /// The planes of the level above the first, over exactly the samples that `Levelled::refine` gets.
    pub above: &'a [Grid],
    /// Whether the result may stay on the device; otherwise it must be returned in memory.
    pub stays: bool,
}

/// Passes with their inputs and the window of their result.
#[derive(Debug, Clone)]
pub struct PassStep<'a> {
    /// The passes.
    pub passes: Passes,
    /// The op's inputs, each covering at least the samples that the op reads.
    pub inputs: Vec<Option<Cow<'a, PlanGrid>>>,
    /// The window of the result.
    pub window: Window,
}

/// A program for a device. Instruction `i` computes value `i`, and each coordinate set is written once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LoweredProgram {
    /// The instructions, in order.
    pub instructions: Vec<Lowered>,
    /// The coordinate sets. The first is the block itself.
    pub coord_sets: Vec<LoweredCoords>,
    /// The values that are the program's results, by number.
    pub outputs: Vec<usize>,
}

/// An instruction for a device. It refers to values and coordinate sets by number.
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
        /// The values of its inputs at the coordinate set; a missing input is 0.
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
    /// A value, by number.
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
    /// The values that an instruction reads, including the values that displace its coordinate set.
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
