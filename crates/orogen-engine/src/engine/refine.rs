//! Making windows of levelled ops: tiles of the coarse levels, coarsest first, then each piece of the window from them.

use super::run::Engine;
use crate::device::{PassStep, PlanGrid};
use crate::plan::levels::{self, Serving};
use crate::recipe::graph::LayerRef;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;
use orogen_grid::progress::Progress;
use orogen_grid::resample::{self, LayerKind};
use orogen_noise::Points;
use orogen_ops::ids::{Id, NodeId};
use orogen_ops::op::{Context, GridInputs, Levelled, Op, WorldParams};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// The planes of the tiles of one level, by column and row.
pub(super) type Planes = BTreeMap<(i64, i64), Vec<Grid>>;

/// Approximate time for making the layers of a sample, in nanoseconds.
const LAYER_COST: f64 = 50.0;

/// A levelled op, its inputs and the layers to make.
pub(super) struct Refining<'a> {
    pub op: &'a dyn Levelled,
    pub node: NodeId,
    /// Its inputs at each level from the coarsest; empty if it has none.
    inputs: Vec<Vec<Option<&'a Grid>>>,
    /// Which layers are read.
    pub wanted: &'a [bool],
    world_params: &'a WorldParams,
    pub progress: &'a Progress,
    /// Whether each input is given.
    given: Vec<bool>,
}

/// A part of a window.
pub(super) struct Piece<'a> {
    /// The levels that it is made from: from tiles of the first one, level by level, to its own.
    pub levels: RangeInclusive<usize>,
    pub window: &'a Window,
    /// The tiles of the first of these levels.
    pub tiles: &'a Planes,
}

impl Engine<'_> {
    /// Computes the wanted layers of a levelled op over a window; they may be on a device. Work runs on the threads of
    /// the pool; the calling thread waits for tiles that other requests make.
    pub(super) fn refine(
        &self,
        node: NodeId,
        inputs: Vec<Vec<Option<&Grid>>>,
        wanted: &[bool],
        window: &Window,
        progress: &Progress,
    ) -> Result<Vec<Option<PlanGrid>>> {
        let Op::Levelled(op) = self.resolved.recipe.nodes()[node.index()].node.op() else {
            return Err(internal("a node that is not levelled was to be refined"));
        };
        let given = self.resolved.given(node);
        let refining =
            Refining { op, node, inputs, wanted, world_params: &self.resolved.world_params, progress, given };
        let serving = Serving::of(&op.levels(), window);
        let is_between = serving.samples.cell != window.cell;
        let made = match self.preview.filter(|preview| preview.is_read_by(node)) {
            Some(preview) => Engine { kept: preview.kept, ..*self }.samples(&refining, &serving, !is_between)?,
            None => self.samples(&refining, &serving, !is_between)?,
        };
        if !is_between {
            return Ok(made);
        }
        let between = |(layer, grid): (usize, Option<PlanGrid>)| {
            let kind = self.resolved.graph.layer_kind(&self.resolved.recipe, LayerRef { node, layer });
            let made = |grid: Grid| interpolated(&grid, kind, window, progress).map(PlanGrid::from);
            grid.and_then(PlanGrid::into_memory).map(made).transpose()
        };
        self.pool.install(|| made.into_iter().enumerate().map(between).collect())
    }

    /// The layers over samples of a level, which may stay on a device if `may_stay`.
    fn samples(&self, refining: &Refining, serving: &Serving, may_stay: bool) -> Result<Vec<Option<PlanGrid>>> {
        let Serving { level, samples } = *serving;
        let in_memory = |layers: Vec<Option<Grid>>| layers.into_iter().map(|layer| layer.map(PlanGrid::from)).collect();
        if samples.is_empty() {
            return Ok(in_memory(refining.layers(&samples)));
        }
        // A device is most efficient with one piece at a time.
        let threads = if self.device().is_some() { 1 } else { self.pool.threads() };
        let pieces: Vec<Window> = serving.pieces(threads).collect();
        let levels = levels::tiled(refining.op, refining.wanted, serving)..=level;
        let tiles = self.level_tiles(refining, levels.clone(), &pieces)?;
        let is_whole = pieces == [samples];
        let make = |window: &Window| {
            let piece = Piece { levels: levels.clone(), window, tiles: &tiles };
            let made = self.execute(may_stay && is_whole, |executor| executor.layers(refining, &piece))?;
            made.done().ok_or_else(|| internal("a piece of a window was not made"))
        };
        let mut made: Vec<Vec<Option<PlanGrid>>> = self.pool.install(|| parallel::try_map(&pieces, make))?;
        if is_whole && let Some(whole) = made.pop() {
            return Ok(whole);
        }
        let mut layers = refining.layers(&samples);
        for piece in made {
            for (layer, part) in layers.iter_mut().zip(piece) {
                if let (Some(layer), Some(part)) = (layer, part.as_ref().and_then(PlanGrid::memory)) {
                    layer.paste(part);
                }
            }
        }
        Ok(in_memory(layers))
    }
}

impl Refining<'_> {
    /// A grid of zeros per wanted layer.
    fn layers(&self, window: &Window) -> Vec<Option<Grid>> {
        self.wanted.iter().map(|wanted| wanted.then(|| Grid::filled(*window, 0.0))).collect()
    }

    /// The planes of a level over a window, from tiles of the level above.
    pub fn planes(&self, level: usize, window: &Window, above: &Planes) -> Result<Vec<Grid>> {
        self.progress.check()?;
        if level > 0 {
            return self.refined(level, &self.mosaic(level - 1, &self.op.parent(level, window), above)?, window);
        }
        let part = self.progress.part(self.work(level, window));
        let context = self.context(&part);
        let planes = self.with_inputs(level, window, |inputs| self.op.coarsest(inputs, window, &context))?;
        part.finish();
        self.checked(planes, window)
    }

    fn context<'b>(&'b self, progress: &'b Progress) -> Context<'b> {
        Context { world_params: self.world_params, progress, observer: None }
    }

    /// The window of a tile.
    pub fn tile(&self, level: usize, at: (i64, i64)) -> Window {
        levels::tile(level, at, self.op.levels().cell(level))
    }

    /// Approximate time for making a tile from the level above, in nanoseconds.
    pub fn work_of_tile(&self, level: usize) -> f64 {
        self.work(level, &self.tile(level, (0, 0)))
    }

    /// Approximate time for making a level over a window from the level above, in nanoseconds.
    pub fn work(&self, level: usize, window: &Window) -> f64 {
        self.op.cost(level) * window.len() as f64
    }

    /// Approximate time for making a piece from tiles, in nanoseconds.
    pub fn work_of_piece(&self, direct: RangeInclusive<usize>, piece: &Window) -> f64 {
        let windows = levels::windows(self.op, self.wanted, *direct.start(), *direct.end(), piece);
        let made = direct.zip(&windows).skip(1);
        made.map(|(level, window)| self.work(level, window)).sum::<f64>() + LAYER_COST * piece.len() as f64
    }

    /// The planes of a level over a window, from exactly the samples of the level above that it may read.
    pub fn refined(&self, level: usize, parent: &[Grid], window: &Window) -> Result<Vec<Grid>> {
        let part = self.progress.part(self.work(level, window));
        let context = self.context(&part);
        let refine = |inputs: &GridInputs| self.op.refine(level, parent, inputs, window, &context);
        let planes = self.with_inputs(level, window, refine)?;
        part.finish();
        self.checked(planes, window)
    }

    /// The passes by which a device makes a level from the level above it; `None` if the processor makes it.
    pub fn level_step(&self, level: usize, window: &Window) -> Result<Option<PassStep<'static>>> {
        let lowered = self.op.lower(level, &self.given, self.world_params).shader();
        let Some(passes) = lowered else { return Ok(None) };
        let inputs = self.inputs_over(level, window)?.into_iter();
        let inputs = inputs.map(|input| input.map(|grid| Cow::Owned(grid.into()))).collect();
        Ok(Some(PassStep { passes, inputs, window: *window }))
    }

    /// Passes the op's inputs over exactly the samples that it may read.
    fn with_inputs<T>(&self, level: usize, window: &Window, work: impl FnOnce(&GridInputs) -> Result<T>) -> Result<T> {
        let inputs = self.inputs_over(level, window)?;
        let inputs: Vec<Option<&Grid>> = inputs.iter().map(Option::as_ref).collect();
        work(&GridInputs::new(self.op.spec(), &inputs))
    }

    /// The op's inputs over exactly the samples that it may read.
    fn inputs_over(&self, level: usize, window: &Window) -> Result<Vec<Option<Grid>>> {
        let Some(inputs) = self.inputs.get(level) else { return Ok(vec![None; self.op.spec().inputs.len()]) };
        let read = window.grown(self.op.source_halo(level));
        let crop = |grid: &Grid| grid.crop(&read).ok_or_else(|| internal("an input of a level is too small"));
        inputs.iter().map(|input| input.map(crop).transpose()).collect()
    }

    /// The layers over a piece in memory, from levels that a device may make.
    pub fn piece(&self, engine: &Engine, piece: &Piece) -> Result<Vec<Option<PlanGrid>>> {
        let (first, level) = (*piece.levels.start(), *piece.levels.end());
        let windows = levels::windows(self.op, self.wanted, first, level, piece.window);
        let mut planes = match windows.first() {
            Some(window) => self.mosaic(first, window, piece.tiles)?,
            None => Vec::new(),
        };
        let mut levels: Vec<(usize, &Window)> = piece.levels.clone().zip(&windows).skip(1).collect();
        while !levels.is_empty() {
            let made = engine.execute(true, |executor| executor.levels(self, &levels, &planes))?;
            let (made, count) = made.done().ok_or_else(|| internal("a level was not made"))?;
            planes = made;
            levels.drain(..count);
        }
        let mut layers = self.layers(piece.window);
        let part = self.progress.part(LAYER_COST * piece.window.len() as f64);
        self.op.layers_of(level, &planes, piece.window, &mut layers, &self.context(&part))?;
        part.finish();
        Ok(layers.into_iter().map(|layer| layer.map(PlanGrid::from)).collect())
    }

    /// The planes over a window that tiles cover.
    pub fn mosaic(&self, level: usize, window: &Window, tiles: &Planes) -> Result<Vec<Grid>> {
        let mut planes: Vec<Grid> = (0..self.op.planes()).map(|_| Grid::filled(*window, 0.0)).collect();
        for at in levels::tiles(level, window) {
            let tile = tiles.get(&at).ok_or_else(|| internal("a tile of a level was not made"))?;
            for (plane, part) in planes.iter_mut().zip(tile) {
                plane.paste(part);
            }
        }
        Ok(planes)
    }

    /// Checks the planes: an op of another crate may return grids over another window.
    pub fn checked(&self, planes: Vec<Grid>, window: &Window) -> Result<Vec<Grid>> {
        let fits = planes.len() == self.op.planes() && planes.iter().all(|plane| plane.window() == window);
        if fits {
            return Ok(planes);
        }
        let message = format!(
            "the op `{}` made {} planes where {} over {} x {} samples at ({}, {}) were to be made",
            self.op.spec().op,
            planes.len(),
            self.op.planes(),
            window.width,
            window.height,
            window.x,
            window.y
        );
        Err(Error::new(ErrorKind::Internal, message))
    }
}

/// A layer interpolated to the samples of a window with another cell.
fn interpolated(grid: &Grid, kind: LayerKind, window: &Window, progress: &Progress) -> Result<Grid> {
    let mut out = Grid::filled(*window, 0.0f32);
    let (xs, ys) = (window.eastings(), window.southings());
    const ROWS: usize = 16;
    parallel::try_for_each(out.data_mut().chunks_mut(ROWS * window.width.max(1)).zip(ys.chunks(ROWS)), |(out, ys)| {
        progress.check()?;
        resample::read(grid, kind, &Points::Lattice { xs: &xs, ys }, out);
        Ok::<(), Error>(())
    })?;
    Ok(out)
}

fn internal(message: &str) -> Error {
    Error::new(ErrorKind::Internal, message)
}
