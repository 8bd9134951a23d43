//! The terrain that features are made of: the heights of a window, and the water of the world around it.

use super::options::FeatureOptions;
use orogen_engine::plan::domain::world_windows;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrography::rivers::{River, rivers};
use orogen_grid::hydrography::shores::{LakeArea, Shores};
use orogen_grid::hydrography::water::{Frame, Least, MEMORY, Water};
use orogen_grid::progress::Progress;

/// Heights and water.
pub struct FeatureSource {
    /// The water of the whole terrain that was processed.
    pub water: Water,
    /// The requested part of it.
    pub frame: Frame,
    /// The shores within the frame, including their crossings with rivers.
    pub shores: Shores,
    /// The reaches within the frame, numbered from 1 in this order.
    pub rivers: Vec<River>,
    /// The lakes within the frame, numbered from 1 in this order.
    pub lakes: Vec<LakeArea>,
    /// The window of the water's grid.
    window: Window,
}

/// Memory per sample for features, beside the water, in bytes.
const FEATURES: u64 = 16;

/// The window whose water must be computed for `window`. At the world's cell or a larger one it is the whole world, so
/// that the rivers of a window are those of the world; at a smaller cell, and in unbounded worlds, it is the window
/// itself.
fn extent(world: &World, window: &Window) -> Window {
    let spec = &world.recipe().world;
    match spec.size {
        // With the margin of the recipe's own solvers.
        Some(size) if window.cell >= spec.cell => world_windows(size, window.cell).1.union(window),
        _ => *window,
    }
}

impl FeatureSource {
    /// The terrain of a window; the caller holds `beside` bytes.
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
        let all = extent(world, window);
        let samples = (all.width as u64).saturating_mul(all.height as u64);
        if samples > u64::from(u32::MAX) {
            let message = format!(
                "rivers and lakes can be found on at most 2^32 samples, and there are {} x {}; use a larger cell",
                all.width, all.height
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        // The heights are counted by their plan.
        let held = samples.saturating_mul(MEMORY - 4 + FEATURES).saturating_add(reserved);
        let heights = world.grid_beside(HEIGHT, &all, held, progress)?;
        world.install(|| {
            FeatureSource::from_heights(heights, world.recipe().world.sea_level as f32, window, options, progress)
        })
    }

    /// The same for given heights, which must contain the window.
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
        Ok(FeatureSource { water, frame, shores, rivers, lakes, window: all })
    }

    /// Distance between samples, in metres.
    #[must_use]
    pub fn cell(&self) -> f64 {
        self.window.cell
    }

    /// Metres east and south of the world's origin of a column and row.
    #[must_use]
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(self.window.x as f64 + x) * self.window.cell, (self.window.y as f64 + y) * self.window.cell]
    }

    /// The parts of a polygon, in metres.
    #[must_use]
    pub fn parts(&self, parts: &[Vec<Vec<[f64; 2]>>]) -> Vec<Vec<Vec<[f64; 2]>>> {
        let ring = |ring: &Vec<[f64; 2]>| ring.iter().map(|at| self.place(*at)).collect();
        parts.iter().map(|part| part.iter().map(ring).collect()).collect()
    }

    /// The heights of the frame.
    #[must_use]
    pub fn heights(&self) -> Option<Grid> {
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
