//! Making windows of levelled ops: tiles of the coarse levels, coarsest first, then each piece of the window from them.

use super::preview::{Preview, Previews};
use super::run::Engine;
use crate::device::{Device, LayerStep, LevelStep, PlanGrid};
use crate::plan::levels::{self, Serving};
use crate::recipe::graph::LayerRef;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;
use orogen_grid::progress::Progress;
use orogen_grid::resample::{self, LayerKind};
use orogen_noise::Points;
use orogen_ops::ids::{Id, NodeId};
use orogen_ops::lower::Lowering;
use orogen_ops::op::{Context, Levelled, Op, WorldParams};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// The planes of the tiles of one level, by column and row.
pub(super) type Planes = BTreeMap<(i64, i64), Vec<Grid>>;

/// Approximate time for making the layers of a sample, in nanoseconds.
const LAYER_COST: f64 = 50.0;

/// A levelled op at work.
pub(super) struct Refining<'a> {
    pub op: &'a dyn Levelled,
    pub node: NodeId,
    /// Its inputs at each level from the coarsest; empty if it has none.
    inputs: Vec<Vec<Option<&'a Grid>>>,
    /// Which layers are read.
    pub wanted: &'a [bool],
    world_params: &'a WorldParams,
    pub progress: &'a Progress,
    /// The device that makes levels over pieces, where it can, and whether each input is given.
    device: Option<(&'a dyn Device, Vec<bool>)>,
}

impl Engine<'_> {
    /// Computes the wanted layers of a levelled op over a window; they may be on a device if `keeps` allows it. Work is
    /// done on the threads of the pool, and the calling thread waits for tiles that other requests make.
    pub(super) fn refine(
        &self,
        node: NodeId,
        inputs: Vec<Vec<Option<&Grid>>>,
        wanted: &[bool],
        (window, keeps): (&Window, bool),
        progress: &Progress,
    ) -> Result<Vec<Option<PlanGrid>>> {
        let Op::Levelled(op) = self.recipe.nodes()[node.index()].node.op() else {
            return Err(internal("a node that is not levelled was to be refined"));
        };
        let device = self.preview.map(|preview| (preview.device, self.nodes().given(node)));
        let refining = Refining { op, node, inputs, wanted, world_params: self.world_params, progress, device };
        let serving = Serving::of(&op.levels(), window);
        let is_between = serving.samples.cell != window.cell;
        let keeps = keeps && !is_between;
        let made = match self.preview.filter(|preview| preview.is_read_by(node)) {
            Some(Preview { kept: Previews { store, level_tiles, .. }, .. }) => {
                Engine { store, level_tiles, ..*self }.samples(&refining, &serving, keeps)?
            }
            None => self.samples(&refining, &serving, keeps)?,
        };
        if !is_between {
            return Ok(made);
        }
        let between = |(layer, grid): (usize, Option<PlanGrid>)| {
            let kind = self.graph.layer_kind(self.recipe, LayerRef { node, layer });
            let made = |grid: Grid| interpolated(&grid, kind, window, progress).map(PlanGrid::from);
            grid.and_then(PlanGrid::into_memory).map(made).transpose()
        };
        self.pool.install(|| made.into_iter().enumerate().map(between).collect())
    }

    /// The layers over samples of a level, which may be on a device if `keeps` allows it.
    fn samples(&self, refining: &Refining, serving: &Serving, keeps: bool) -> Result<Vec<Option<PlanGrid>>> {
        let Serving { level, samples } = *serving;
        let in_memory = |layers: Vec<Option<Grid>>| layers.into_iter().map(|layer| layer.map(PlanGrid::from)).collect();
        if samples.is_empty() {
            return Ok(in_memory(refining.layers(&samples)));
        }
        // A device is best used by one piece at a time.
        let threads = if refining.device.is_some() { 1 } else { self.pool.threads() };
        let pieces: Vec<Window> = serving.pieces(threads).collect();
        let tiled = levels::tiled(refining.op, refining.wanted, serving);
        let tiles = self.level_tiles(refining, tiled..=level, &pieces)?;
        if let ([piece], true) = (pieces.as_slice(), keeps)
            && *piece == samples
            && let Some(made) = self.pool.install(|| refining.layers_on_device(tiled..=level, piece, &tiles))?
        {
            return Ok(made);
        }
        let make = |piece: &Window| refining.piece(tiled..=level, piece, &tiles);
        let made: Vec<Vec<Option<Grid>>> = self.pool.install(|| parallel::try_map(&pieces, make))?;
        let mut layers = refining.layers(&samples);
        for piece in made {
            for (layer, part) in layers.iter_mut().zip(piece) {
                if let (Some(layer), Some(part)) = (layer, part) {
                    layer.paste(&part);
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
    fn work(&self, level: usize, window: &Window) -> f64 {
        self.op.cost(level) * window.len() as f64
    }

    /// Approximate time for making a piece from tiles, in nanoseconds.
    pub fn work_of_piece(&self, direct: RangeInclusive<usize>, piece: &Window) -> f64 {
        let windows = levels::windows(self.op, self.wanted, *direct.start(), *direct.end(), piece);
        let made = direct.zip(&windows).skip(1);
        made.map(|(level, window)| self.work(level, window)).sum::<f64>() + LAYER_COST * piece.len() as f64
    }

    /// The planes of a level over a window, from exactly the samples of the level above that it may read.
    fn refined(&self, level: usize, parent: &[Grid], window: &Window) -> Result<Vec<Grid>> {
        let part = self.progress.part(self.work(level, window));
        let context = self.context(&part);
        let refine = |inputs: &[Option<&Grid>]| self.op.refine(level, parent, inputs, window, &context);
        let planes = self.with_inputs(level, window, refine)?;
        part.finish();
        self.checked(planes, window)
    }

    /// As many of these levels as the device makes one from the other, and their number; `None` if there is no device,
    /// or the processor is to make the first.
    fn on_device(&self, levels: &[(usize, &Window)], above: &[Grid]) -> Result<Option<(Vec<Grid>, usize)>> {
        let Some((device, given)) = &self.device else { return Ok(None) };
        let mut steps = Vec::new();
        for &(level, window) in levels {
            let Some(step) = self.level_step(level, window, given)? else { break };
            steps.push(step);
        }
        let Some((_, last)) = steps.len().checked_sub(1).and_then(|last| levels.get(last)) else { return Ok(None) };
        let work = levels.iter().take(steps.len()).map(|(level, window)| self.work(*level, window)).sum();
        let part = self.progress.part(work);
        let Some(made) = device.refine(&steps, above, &part)? else { return Ok(None) };
        part.finish();
        Ok(Some((self.checked(made, last)?, steps.len())))
    }

    /// How a device makes a level from the one above it; `None` if the processor is to do it.
    fn level_step(&self, level: usize, window: &Window, given: &[bool]) -> Result<Option<LevelStep>> {
        let Lowering::Shader(passes) = self.op.lower(level, given, self.world_params) else { return Ok(None) };
        Ok(Some(LevelStep { passes, inputs: self.inputs_over(level, window)?, window: *window }))
    }

    /// The layers of the last of the `direct` levels over a piece, which a device makes with all levels from tiles of
    /// the first; `None` if it does not.
    fn layers_on_device(
        &self,
        direct: RangeInclusive<usize>,
        piece: &Window,
        tiles: &Planes,
    ) -> Result<Option<Vec<Option<PlanGrid>>>> {
        let Some((device, given)) = &self.device else { return Ok(None) };
        let level = *direct.end();
        let Lowering::Shader(passes) = self.op.lower_layers(level, self.wanted, self.world_params) else {
            return Ok(None);
        };
        let windows = levels::windows(self.op, self.wanted, *direct.start(), level, piece);
        let mut steps = Vec::new();
        for (level, window) in direct.clone().zip(&windows).skip(1) {
            let Some(step) = self.level_step(level, window, given)? else { return Ok(None) };
            steps.push(step);
        }
        let (Some(first), false) = (windows.first(), steps.is_empty()) else { return Ok(None) };
        let layers = LayerStep { passes, window: *piece, halo: self.op.surface_halo(level, self.wanted) };
        let part = self.progress.part(self.work_of_piece(direct.clone(), piece));
        let above = self.mosaic(*direct.start(), first, tiles)?;
        let Some(made) = device.layers(&steps, &layers, &above, &part)? else { return Ok(None) };
        part.finish();
        let mut made = made.into_iter();
        Ok(Some(self.wanted.iter().map(|wanted| if *wanted { made.next() } else { None }).collect()))
    }

    /// Passes the op's inputs over exactly the samples that it may read.
    fn with_inputs<T>(
        &self,
        level: usize,
        window: &Window,
        work: impl FnOnce(&[Option<&Grid>]) -> Result<T>,
    ) -> Result<T> {
        work(&self.inputs_over(level, window)?.iter().map(Option::as_ref).collect::<Vec<_>>())
    }

    /// The op's inputs over exactly the samples that it may read.
    fn inputs_over(&self, level: usize, window: &Window) -> Result<Vec<Option<Grid>>> {
        let Some(inputs) = self.inputs.get(level) else { return Ok(vec![None; self.op.spec().inputs.len()]) };
        let read = window.grown(self.op.source_halo(level));
        let crop = |grid: &Grid| grid.crop(&read).ok_or_else(|| internal("an input of a level is too small"));
        inputs.iter().map(|input| input.map(crop).transpose()).collect()
    }

    /// The layers of the last of the `direct` levels over a piece, from tiles of the first.
    fn piece(&self, direct: RangeInclusive<usize>, piece: &Window, tiles: &Planes) -> Result<Vec<Option<Grid>>> {
        let level = *direct.end();
        let windows = levels::windows(self.op, self.wanted, *direct.start(), level, piece);
        let mut planes = match windows.first() {
            Some(first) => self.mosaic(*direct.start(), first, tiles)?,
            None => Vec::new(),
        };
        let mut levels: Vec<(usize, &Window)> = direct.zip(&windows).skip(1).collect();
        while let Some((level, window)) = levels.first().copied() {
            let (made, count) = match self.on_device(&levels, &planes)? {
                Some(made) => made,
                None => (self.refined(level, &planes, window)?, 1),
            };
            planes = made;
            levels.drain(..count);
        }
        let mut layers = self.layers(piece);
        let part = self.progress.part(LAYER_COST * piece.len() as f64);
        self.op.layers_of(level, &planes, piece, &mut layers, &self.context(&part))?;
        part.finish();
        Ok(layers)
    }

    /// The planes over a window that tiles cover.
    fn mosaic(&self, level: usize, window: &Window, tiles: &Planes) -> Result<Vec<Grid>> {
        let mut planes: Vec<Grid> = (0..self.op.planes()).map(|_| Grid::filled(*window, 0.0)).collect();
        for at in levels::tiles(level, window) {
            let tile = tiles.get(&at).ok_or_else(|| internal("a tile of a level was not made"))?;
            for (plane, part) in planes.iter_mut().zip(tile) {
                plane.paste(part);
            }
        }
        Ok(planes)
    }

    /// An op of another crate may return other grids than it was asked for.
    fn checked(&self, planes: Vec<Grid>, window: &Window) -> Result<Vec<Grid>> {
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

/// A layer at the samples of a window with another cell.
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
