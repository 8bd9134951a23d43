//! The terrain that features are made from: the heights of a window, and the water of the world around it.

use super::options::FeatureOptions;
use orogen_engine::plan::domain::world_windows;
use orogen_engine::recipe::network::OwnNetwork;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrography::clip::Rectangle;
use orogen_grid::hydrography::given::{GivenWater, Nodes, snapped};
use orogen_grid::hydrography::rivers::{River, rivers, rivers_within};
use orogen_grid::hydrography::shores::{LakeArea, Shores};
use orogen_grid::hydrography::water::{Frame, Least, MEMORY, Water};
use orogen_grid::progress::Progress;

/// Heights and water.
pub struct FeatureSource {
    /// The water of the whole terrain that was processed.
    pub water: Water,
    /// The requested part of the water.
    pub frame: Frame,
    /// The shores within the frame, including their crossings with rivers.
    pub shores: Shores,
    /// The reaches within the frame, numbered from 1 in this order.
    pub rivers: Vec<River>,
    /// The lakes within the frame, numbered from 1 in this order.
    pub lakes: Vec<LakeArea>,
    /// The window of the water's grid.
    window: Window,
    /// The requested window.
    pub requested: Window,
    /// The heights of the requested window, if its cell differs from that of the water's grid.
    ground: Option<Grid>,
}

/// Memory per sample for features in addition to the water, in bytes.
const FEATURES: u64 = 16;

/// Memory per sample for the water of a given network and its features in addition to the layers that are read, in
/// bytes.
const OWN_MEMORY: u64 = 56;

/// Width of the border of a window, in samples, in which smoothed lines and crossings with shores may differ from those
/// of other windows.
const HALO: usize = 24;

/// Maximum number of samples of a lake that is counted completely across the side of a window.
const MAX_LAKE: usize = 64;

/// The layers of a level's nodes (which are not at its samples), in addition to height, flow, lake and surface.
const NODES: [&str; 5] = ["node_height", "node_flow", "node_receiver", "node_east", "node_south"];

/// Number of samples of a window; fails if there are too many.
fn affordable(all: &Window) -> Result<u64> {
    let samples = (all.width as u64).saturating_mul(all.height as u64);
    if samples > u64::from(u32::MAX) {
        let message = format!(
            "rivers and lakes can be found on at most 2^32 samples, and there are {} x {}; use a larger cell",
            all.width, all.height
        );
        return Err(Error::new(ErrorKind::Request, message));
    }
    Ok(samples)
}

/// The window at another cell that covers a window; at the same cell, the window itself.
fn covering(window: &Window, cell: f64) -> Window {
    if cell == window.cell {
        return *window;
    }
    let span = |first: i64, count: usize| {
        let start = ((first as f64 - 0.5) * window.cell / cell).floor() as i64;
        let end = ((first as f64 + count as f64 - 0.5) * window.cell / cell).ceil() as i64;
        (start, (end - start + 1).max(1) as usize)
    };
    let ((x, width), (y, height)) = (span(window.x, window.width), span(window.y, window.height));
    Window { x, y, width, height, cell }
}

/// The water of a level from its layers: the recipe's height, then height, flow, lake and surface of the levelled node,
/// then the layers of its nodes. Where the recipe changes the heights, water levels change by the same amount.
fn given(grids: Vec<Grid>, at_samples: bool, is_height: bool) -> Result<GivenWater> {
    let missing = || Error::new(ErrorKind::Internal, "a layer of the network is missing");
    let mut grids = grids.into_iter();
    let mut next = || grids.next().ok_or_else(missing);
    let (heights, land, flow, lake, surface) = (next()?, next()?, next()?, next()?, next()?);
    let window = *heights.window();
    let receiver_or_height = next()?;
    let (mut standing, change) = (surface, |k: usize| match is_height {
        true => 0.0,
        false => heights.data()[k] - land.data()[k],
    });
    for (k, level) in standing.data_mut().iter_mut().enumerate() {
        // At the finest level, water at a shore has no depth.
        let is_wet = lake.data()[k] > 0.0 || at_samples && receiver_or_height.data()[k] >= WATER && *level > 0.0;
        *level = if is_wet { *level + change(k) } else { f32::NAN };
    }
    let nodes = if at_samples {
        let mut height = heights.clone();
        let levels = height.data_mut().iter_mut().zip(standing.data());
        levels.filter(|(_, level)| level.is_finite()).for_each(|(height, level)| *height = *level);
        Nodes { height, flow, receiver: receiver_or_height, offset: None }
    } else {
        let (flow, receiver, mut east, mut south) = (next()?, next()?, next()?, next()?);
        for offset in [&mut east, &mut south] {
            offset.data_mut().iter_mut().for_each(|metres| *metres = (f64::from(*metres) / window.cell) as f32);
        }
        let mut height = receiver_or_height;
        if !is_height {
            for j in 0..window.height {
                for i in 0..window.width {
                    let at = [east[(i, j)], south[(i, j)]];
                    // The change of the heights at the node, between the samples around it.
                    let sample =
                        |x: usize, y: usize| change(y.min(window.height - 1) * window.width + x.min(window.width - 1));
                    let [north, below] = [j, j + 1].map(|y| sample(i, y) * (1.0 - at[0]) + sample(i + 1, y) * at[0]);
                    height[(i, j)] += north * (1.0 - at[1]) + below * at[1];
                }
            }
        }
        Nodes { height, flow, receiver, offset: Some([east, south]) }
    };
    drop(lake);
    Ok(GivenWater { heights, standing, nodes })
}

/// The code of receivers in water.
const WATER: f32 = 8.0;

/// The window whose water must be computed for `window`. At the world's cell or a larger one it is the whole world, so
/// that the rivers of a window are the rivers of the world. At a smaller cell, and in unbounded worlds, it is the
/// window itself.
fn extent(world: &World, window: &Window) -> Window {
    let spec = &world.recipe().world;
    match spec.size {
        // With the same margin as the recipe's own solvers.
        Some(size) if window.cell >= spec.cell => world_windows(size, window.cell).1.union(window),
        _ => *window,
    }
}

impl FeatureSource {
    /// The terrain of a window; the caller already uses `beside` bytes.
    ///
    /// # Errors
    /// If the world has no heights, memory does not suffice, or the work was cancelled.
    pub fn of(
        world: &World,
        window: &Window,
        options: &FeatureOptions,
        reserved: u64,
        progress: &Progress,
    ) -> Result<FeatureSource> {
        let own = OwnNetwork::of(world.recipe());
        if let Some((network, cell)) = own.and_then(|own| own.cell_for(window.cell).map(|cell| (own, cell))) {
            return FeatureSource::of_network(world, &network, cell, window, options, reserved, progress);
        }
        let all = extent(world, window);
        let held = affordable(&all)?.saturating_mul(MEMORY - 4 + FEATURES).saturating_add(reserved);
        // The memory for heights is counted by their plan.
        let heights = world.grid_beside(HEIGHT, &all, held, progress)?;
        world.install(|| {
            FeatureSource::from_heights(heights, world.recipe().world.sea_level as f32, window, options, progress)
        })
    }

    /// The terrain of a window of a world with its own network, from the level whose rivers the window shows.
    fn of_network(
        world: &World,
        network: &OwnNetwork,
        cell: f64,
        window: &Window,
        options: &FeatureOptions,
        reserved: u64,
        progress: &Progress,
    ) -> Result<FeatureSource> {
        world.check(window)?;
        let [spring, fewest] = options.fewest(cell);
        let [even, cut] = options.rounds();
        let samples = covering(window, cell);
        // At this distance from the border, lines are the same as in every other window, and a small lake at a side
        // does not reach it.
        let halo = HALO + even + (fewest as usize).min(MAX_LAKE);
        let all = samples.grown(halo);
        let held = affordable(&all)?.saturating_mul(OWN_MEMORY).saturating_add(reserved);
        let at_samples = network.is_at_samples(cell);
        let mut layers = vec![HEIGHT.to_string()];
        let nodes: &[&str] = if at_samples { &["receiver"] } else { &NODES };
        let own = ["height", "flow", "lake", "surface"].into_iter().chain(nodes.iter().copied());
        layers.extend(own.map(|name| network.layer(name)));
        let layers: Vec<&str> = layers.iter().map(String::as_str).collect();
        let grids = world.grids_beside(&layers, &all, held, progress)?;
        let ground = match cell == window.cell {
            true => None,
            false => Some(world.grid_beside(HEIGHT, window, held.saturating_add(all.len() as u64 * 40), progress)?),
        };
        world.install(|| {
            let given = given(grids, at_samples, network.is_height())?;
            let least = Least::new(spring, fewest);
            let sea_level = options.sea.then_some(world.recipe().world.sea_level as f32);
            let water = Water::given(given, sea_level, least, progress)?;
            let side = |first: i64, count: usize, origin: i64| {
                // Snapped before the origin is subtracted, so that adjacent windows agree.
                let side = |sample: f64| snapped(sample * window.cell / cell) - origin as f64;
                [side(first as f64 - 0.5), side(first as f64 + count as f64 - 0.5)]
            };
            let [[west, east], [north, south]] =
                [side(window.x, window.width, all.x), side(window.y, window.height, all.y)];
            let rectangle = Rectangle { sides: [west, north, east, south] };
            let frame = Frame { columns: halo..halo + samples.width, rows: halo..halo + samples.height };
            let mut shores = Shores::of(&water, &Frame::whole(&water), cut)?;
            progress.check()?;
            let rivers = rivers_within(&water, &frame, &rectangle, even, &mut shores);
            let lakes = shores.areas_within(&water, &rectangle);
            let shores = shores.coasts_within(&rectangle);
            progress.check()?;
            Ok(FeatureSource { water, frame, shores, rivers, lakes, window: all, requested: *window, ground })
        })
    }

    /// Like [`of`](FeatureSource::of), from given heights that contain the window.
    ///
    /// # Errors
    /// If the work was cancelled.
    pub fn from_heights(
        heights: Grid,
        sea_level: f32,
        window: &Window,
        options: &FeatureOptions,
        progress: &Progress,
    ) -> Result<FeatureSource> {
        let all = *heights.window();
        let [spring, lake] = options.fewest(all.cell);
        let least = Least::new(spring, lake).with_depth(0.0).with_scattered(false);
        let water = Water::of(heights, options.sea.then_some(sea_level), least, progress)?;
        let (left, top) = ((window.x - all.x) as usize, (window.y - all.y) as usize);
        let frame = Frame { columns: left..left + window.width, rows: top..top + window.height };
        let [even, cut] = options.rounds();
        let mut shores = Shores::of(&water, &frame, cut)?;
        progress.check()?;
        let rivers = rivers(&water, &frame, even, &mut shores);
        let lakes = shores.areas();
        progress.check()?;
        Ok(FeatureSource { water, frame, shores, rivers, lakes, window: all, requested: *window, ground: None })
    }

    /// Distance between samples, in metres.
    #[must_use]
    pub fn cell(&self) -> f64 {
        self.window.cell
    }

    /// The position, in metres east and south of the world's origin, of a column and row.
    #[must_use]
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(self.window.x as f64 + x) * self.window.cell, (self.window.y as f64 + y) * self.window.cell]
    }

    /// The column and row, with fractions, at a position in metres east and south of the world's origin.
    #[must_use]
    pub fn sample_at(&self, [east, south]: [f64; 2]) -> [f64; 2] {
        [east / self.window.cell - self.window.x as f64, south / self.window.cell - self.window.y as f64]
    }

    /// The parts of a polygon, in metres.
    #[must_use]
    pub fn parts(&self, parts: &[Vec<Vec<[f64; 2]>>]) -> Vec<Vec<Vec<[f64; 2]>>> {
        let ring = |ring: &Vec<[f64; 2]>| ring.iter().map(|at| self.place(*at)).collect();
        parts.iter().map(|part| part.iter().map(ring).collect()).collect()
    }

    /// Converts a column and row of the water's grid to the requested window.
    #[must_use]
    pub fn to_window(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (all, window) = (&self.window, &self.requested);
        let to = |first: i64, at: f64, origin: i64| match window.cell == all.cell {
            true => at - (origin - first) as f64,
            false => (first as f64 + at) * all.cell / window.cell - origin as f64,
        };
        [to(all.x, x, window.x), to(all.y, y, window.y)]
    }

    /// The sample of the water's grid that is nearest to a sample of the requested window.
    #[must_use]
    pub fn nearest(&self, i: usize, j: usize) -> usize {
        let (all, window) = (&self.window, &self.requested);
        self.near([window.y, all.y], j, all.height) * all.width + self.near([window.x, all.x], i, all.width)
    }

    /// The columns and rows of the water's grid that are nearest to the columns and rows of the requested window.
    #[must_use]
    pub fn nearest_lines(&self) -> [Vec<usize>; 2] {
        let (all, window) = (&self.window, &self.requested);
        [
            (0..window.width).map(|i| self.near([window.x, all.x], i, all.width)).collect(),
            (0..window.height).map(|j| self.near([window.y, all.y], j, all.height)).collect(),
        ]
    }

    fn near(&self, [first, origin]: [i64; 2], at: usize, count: usize) -> usize {
        if self.requested.cell == self.window.cell {
            return (first + at as i64 - origin) as usize;
        }
        let near = ((first as f64 + at as f64) * self.requested.cell / self.window.cell - origin as f64).round();
        (near.max(0.0) as usize).min(count.saturating_sub(1))
    }

    /// The heights of the requested window.
    #[must_use]
    pub fn heights(&self) -> Option<Grid> {
        if self.ground.is_some() {
            return self.ground.clone();
        }
        let window = Window {
            x: self.window.x + self.frame.columns.start as i64,
            y: self.window.y + self.frame.rows.start as i64,
            width: self.frame.columns.len(),
            height: self.frame.rows.len(),
            cell: self.window.cell,
        };
        self.water.heights.crop(&window)
    }

    /// The number of a lake within the frame, from 1.
    #[must_use]
    pub fn lake_id(&self, lake: u32) -> Option<u32> {
        self.lakes.binary_search_by_key(&lake, |area| area.lake).ok().map(|k| k as u32 + 1)
    }
}
