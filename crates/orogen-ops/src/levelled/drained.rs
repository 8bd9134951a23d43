//! What the levelled ops that make drained land have in common.

use crate::op::{Context, GridInputs, Levels, halved};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::rivers::Channel;
use orogen_grid::multiscale::continents::Continents;
use orogen_grid::multiscale::given::Given;
use orogen_grid::multiscale::level::{Level, direction};
use orogen_grid::multiscale::refinement::Refinement;

/// Approximate time for a sample of a level below the coarsest, in nanoseconds.
pub const COST: f64 = 300.0;

/// The lattices of a refinement.
#[must_use]
pub fn levels(refinement: &Refinement) -> Levels {
    Levels {
        finest: refinement.cell_of(refinement.levels + refinement.details),
        count: refinement.levels + refinement.details + 1,
    }
}

/// Number of levels that read inputs: detail levels take over what the finest level of valleys has.
#[must_use]
pub fn levels_with_inputs(refinement: &Refinement) -> usize {
    refinement.levels + 1
}

/// The levels of an op, and where their nodes are relative to the samples of windows.
pub struct Lattices<'a> {
    /// The levels.
    pub refinement: Refinement,
    /// Number of samples that the lattice of a level is ahead of those of windows.
    pub ahead: fn(usize) -> i64,
    /// The land whose geography decides where inputs have no value.
    pub continents: Option<&'a Continents>,
}

impl Lattices<'_> {
    /// The nodes of a level at the samples of a window.
    #[must_use]
    pub fn nodes_at(&self, level: usize, window: &Window) -> Window {
        let ahead = (self.ahead)(level);
        self.refinement.nodes_at(level, &window.at(window.x + ahead, window.y + ahead))
    }

    /// The inverse of [`Lattices::nodes_at`].
    fn samples_at(&self, level: usize, nodes: &Window) -> Window {
        let (window, ahead) = (self.refinement.samples_at(level, nodes), (self.ahead)(level));
        window.at(window.x - ahead, window.y - ahead)
    }

    /// The window of the level above that a window is made from.
    #[must_use]
    pub fn parent(&self, level: usize, window: &Window) -> Window {
        let above = level.saturating_sub(1);
        let nodes = halved(&self.nodes_at(level, window), self.refinement.cell_of(above));
        self.samples_at(above, &nodes).grown(self.refinement.reach(level))
    }

    /// The planes of a level from those of the level above. `given` names the inputs.
    ///
    /// # Errors
    /// If the planes are not those of a level, or the work was cancelled.
    pub fn refine(
        &self,
        level: usize,
        parent: &[Grid],
        inputs: &GridInputs,
        given: impl for<'a> Fn(&GridInputs<'a>) -> Given<'a>,
        window: &Window,
        context: &Context,
    ) -> Result<Vec<Grid>> {
        let mut above = level_of(level - 1, parent)?;
        above.window = self.nodes_at(level - 1, &above.window);
        let nodes = self.nodes_at(level, window);
        let moved: Vec<Option<Grid>> = inputs.all().iter().map(|input| self.input_at_nodes(level, (*input)?)).collect();
        let moved: Vec<Option<&Grid>> = moved.iter().map(Option::as_ref).collect();
        let given = Given { continents: self.continents, ..given(&inputs.with(&moved)) };
        let mut made = self.refinement.refine(&above, &given, &nodes, context.progress)?;
        made.window = *window;
        Ok(made.into_planes())
    }

    /// An input of a level with the window of its nodes.
    fn input_at_nodes(&self, level: usize, input: &Grid) -> Option<Grid> {
        Grid::from_data(self.nodes_at(level, input.window()), input.data().to_vec())
    }
}

/// How layers are read from a level.
pub struct Reading {
    /// Where samples of coarser levels are in their cells, as a share of the sides.
    pub share: f32,
    /// Drainage area of rivers, in m^2.
    pub stream: f64,
    /// Runoff in metres per year.
    pub runoff: f64,
    /// Height of the sea, above which the heights of the levels are.
    pub sea_level: f32,
}

/// The layers height, flow, lake, surface, receiver, width, depth, floodplain and sediment, and those of the nodes, if
/// the op has them: height, flow, receiver, east and south.
///
/// # Errors
/// If the planes are not those of a level, or the work was cancelled.
pub fn layers_of(
    refinement: &Refinement,
    reading: &Reading,
    level: usize,
    planes: &[Grid],
    window: &Window,
    out: &mut [Option<Grid>],
    context: &Context,
) -> Result<()> {
    let mut level = level_of(level, planes)?;
    level.window = refinement.nodes_at(level.depth, &level.window);
    let [height, flow, lake, surface, receiver, width, depth, floodplain, sediment, nodes @ ..] = out else {
        return Ok(());
    };
    nodes_of(refinement, &level, window, nodes);
    let of_samples = [&height, &flow, &lake, &surface, &receiver, &width, &depth, &floodplain, &sediment];
    if of_samples.iter().all(|layer| layer.is_none()) {
        return Ok(());
    }
    let channel = Channel::default().with_runoff(reading.runoff);
    let mut made = refinement.surface_at(reading.share, &level, window, context.progress)?;
    refinement.cut_rivers(&level, &mut made, reading.stream, &channel, context.progress)?;
    if let Some(floodplain) = floodplain {
        let (share, stream) = (reading.share, reading.stream);
        *floodplain = refinement.floodplain(share, &level, &made, stream, &channel, context.progress)?;
    }
    if let Some(sediment) = sediment {
        *sediment = refinement.sediment(reading.share, &level, &made, context.progress)?;
    }
    if let Some(surface) = surface {
        *surface = made.height.clone();
        for (surface, water) in surface.data_mut().iter_mut().zip(made.water_level.data()) {
            *surface = if water.is_nan() { *surface } else { *water };
        }
    }
    if reading.sea_level != 0.0 {
        for grid in [Some(&mut made.height), surface.as_mut()].into_iter().flatten() {
            grid.data_mut().iter_mut().for_each(|height| *height += reading.sea_level);
        }
    }
    if let Some(receiver) = receiver {
        let codes = receiver.data_mut().iter_mut().zip(made.receiver.data());
        codes.for_each(|(out, code)| *out = f32::from(direction(*code)));
    }
    let write = |layer: &mut Option<Grid>, of: &dyn Fn(f64) -> f64| {
        let Some(layer) = layer else { return };
        for ((size, area), water) in layer.data_mut().iter_mut().zip(made.flow.data()).zip(made.water_level.data()) {
            let area = f64::from(*area);
            let is_river = area >= reading.stream && water.is_nan();
            *size = if is_river { of(channel.discharge(area)) as f32 } else { 0.0 };
        }
    };
    write(width, &|discharge| channel.width_of(discharge));
    write(depth, &|discharge| channel.depth_of(discharge));
    let layers = [(height, made.height), (flow, made.flow), (lake, made.lake_depth)];
    layers.into_iter().for_each(|(out, made)| *out = out.take().map(|_| made));
    Ok(())
}

/// The nodes of a level's cells.
fn nodes_of(refinement: &Refinement, level: &Level, window: &Window, out: &mut [Option<Grid>]) {
    let cell = refinement.cell_of(level.depth);
    // The nodes of the finest level of valleys are at the samples; cells of detail levels begin at theirs.
    let first = if level.depth > refinement.levels { 0.0 } else { -0.5 * refinement.cell };
    let metres = |share: f32| (f64::from(share) * cell + first) as f32;
    let nodes = refinement.nodes_at(level.depth, window);
    let (left, top) = ((nodes.x - level.window.x) as usize, (nodes.y - level.window.y) as usize);
    let fill = |out: &mut Option<Grid>, value: &dyn Fn(usize) -> f32| {
        for j in 0..out.as_ref().map_or(0, Grid::height) {
            let first = (top + j) * level.window.width + left;
            let row = out.as_mut().map(|out| out.row_mut(j)).into_iter().flatten();
            row.enumerate().for_each(|(i, sample)| *sample = value(first + i));
        }
    };
    let [height, flow, receiver, east, south] = out else { return };
    fill(height, &|node| level.height[node]);
    fill(flow, &|node| level.area[node] * (cell * cell) as f32);
    fill(receiver, &|node| f32::from(level.receiver[node]));
    fill(east, &|node| metres(level.east[node]));
    fill(south, &|node| metres(level.south[node]));
}

/// Index of the layer of floods among the layers, and of sediment. They read more of a level than others.
const FLOODPLAIN: usize = 7;
const SEDIMENT: usize = 8;

/// Samples of a level beyond a window that the wanted layers read.
#[must_use]
pub fn surface_halo(refinement: &Refinement, level: usize, wanted: &[bool]) -> usize {
    let reach = |layer: usize, reach: usize| if wanted.get(layer) == Some(&true) { reach } else { 0 };
    Refinement::SURFACE_REACH
        .max(refinement.rivers_reach(level))
        .max(reach(FLOODPLAIN, refinement.floods_reach(level)))
        .max(reach(SEDIMENT, refinement.sediment_reach(level)))
}

/// Memory for making a level over a window whose children extend by `halo` beyond it, in bytes.
#[must_use]
pub fn scratch(window: &Window, halo: usize, inputs: usize) -> u64 {
    let samples = window.grown(halo + 1);
    // Inputs are copied to the windows of the nodes.
    let bytes = Refinement::bytes_per_sample().saturating_add(4 * inputs as u64);
    bytes.saturating_mul(samples.width as u64).saturating_mul(samples.height as u64)
}

/// The level of these planes.
///
/// # Errors
/// If the planes are not those of a level.
pub fn level_of(depth: usize, planes: &[Grid]) -> Result<Level> {
    Level::from_planes(depth, &planes.iter().collect::<Vec<_>>())
}
