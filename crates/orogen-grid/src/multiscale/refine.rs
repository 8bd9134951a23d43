//! One level from the level above.

use super::banks::raise_banks;
use super::carve::carve;
use super::children::Children;
use super::creep::{Hillsides, Kept, creep, creep_passes, steepest};
use super::drainage::{self, WATER};
use super::given::{self, Given};
use super::growth::{Growth, Spacing, least_rise};
use super::law::{Law, has_floors};
use super::level::{LAKE, Level, cropped, invalid};
use super::links::Links;
use super::refinement::Refinement;
use super::shores::standing_water;
use super::straighten::{self, straighten};
use super::{detail, lake_shores, lakes, mouths};
use crate::error::Result;
use crate::grid::Window;
use crate::progress::Progress;

/// Cells at the edge of the children whose rivers and shores are not exact.
pub const CARVED: usize = 7;

/// Passes of heights before drainage areas change, and rounds of areas and heights after.
pub const FIRST_PASSES: usize = 3;
pub const ROUNDS: usize = 5;

/// Passes of areas in a round.
pub const AREA_PASSES: usize = 2;

/// The work before growth and on banks and creep, in passes of growth.
const CARVING_WORK: [f64; 4] = [1.0, 1.0, 0.5, 0.5];
const FINEST_WORK: f64 = 2.0;

/// The largest factor of creep: the average of the neighbors takes the place of a height.
const MAX_CREEP_FACTOR: f32 = 1.25;

/// Passes of areas at the end of each level, and on the finest level, where nodes have just chosen their receivers
/// again.
const LAST_AREA_PASSES: usize = 3;
const FINEST_AREA_PASSES: usize = 6;

/// Passes that keep areas from falling downstream: they rise along the receivers, then fall against them.
pub const RAISE_PASSES: usize = 6;
pub const LIMIT_PASSES: usize = 3;

/// Passes that raise banks on the finest level, and rounds of them: nodes that drained to a bank choose their receivers
/// again after each.
pub const BANK_PASSES: usize = 3;
pub const BANK_ROUNDS: usize = 2;

/// Drainage area, in cells, below which nodes of rivers of the level above choose their receivers again.
pub const FREE_AREA: f32 = 64.0;

pub fn last_area_passes(finest: bool) -> usize {
    if finest { FINEST_AREA_PASSES } else { LAST_AREA_PASSES }
}

impl Refinement {
    /// Samples of level `depth - 1` that [`Refinement::refine`] to `depth` reads beyond each side of the halved window,
    /// which extends from half the first sample, rounded down, to half the last, rounded up.
    #[must_use]
    pub fn reach(&self, depth: usize) -> usize {
        self.inset(depth).div_ceil(2)
    }

    /// Cells at the edge of the children whose values are not exact.
    fn inset(&self, depth: usize) -> usize {
        let finest = self.is_finest(depth);
        let growth = CARVED + FIRST_PASSES + ROUNDS * (AREA_PASSES + 1);
        let growth = growth + last_area_passes(finest) + RAISE_PASSES + LIMIT_PASSES;
        let above = depth.saturating_sub(1);
        let growth = growth + if lakes::begin_at(self, above) { 2 * lakes::REACH } else { 0 };
        let growth = growth + if self.lakes > 0.0 { lake_shores::RIM + 1 } else { 0 };
        if finest {
            growth + straighten::REACH + creep_passes(self.creep) + BANK_ROUNDS * (BANK_PASSES + 1)
        } else if self.is_detail(depth) {
            growth + detail::creep_passes(self)
        } else {
            growth
        }
    }

    /// Samples of level `depth`, at least 1, beyond a window that [`Refinement::refine`] reads of what is given.
    #[must_use]
    pub fn given_reach(&self, depth: usize) -> usize {
        2 * self.reach(depth) + 1
    }

    /// The window of level `depth - 1` that [`Refinement::refine`] needs for `window` of level `depth`.
    #[must_use]
    pub fn parent_window(&self, depth: usize, window: &Window) -> Window {
        let (x, y) = (window.x >> 1, window.y >> 1);
        let last = |end: i64| (end - 1) - ((end - 1) >> 1);
        let (right, bottom) = (last(window.right()), last(window.bottom()));
        let (width, height) = ((right - x + 1) as usize, (bottom - y + 1) as usize);
        Window { x, y, width, height, cell: self.cell_of(depth.saturating_sub(1)) }.grown(self.reach(depth))
    }

    /// Bytes that [`Refinement::refine`] holds at its peak per sample of the window grown by twice the
    /// [reach](Refinement::reach), including the result and without the parent.
    #[must_use]
    pub fn bytes_per_sample() -> u64 {
        // Planes of 4 bytes: children 5, rivers 4, distances 4, the law 3, growth 4; the result 29 bytes, a quarter of
        // the parent 8.
        120
    }

    /// Exactly `window` of the level below `parent`, which must cover [`Refinement::parent_window`]. Other nodes of the
    /// parent are not read. What is given covers the window grown by [`Refinement::given_reach`]; detail levels read
    /// nothing of it.
    ///
    /// # Errors
    /// If the parent covers too little, a parameter is out of range, the window is not one of the level, or the work is
    /// cancelled.
    pub fn refine(&self, parent: &Level, given: &Given, window: &Window, progress: &Progress) -> Result<Level> {
        let depth = parent.depth + 1;
        let given = if self.is_detail(depth) { &Given::default() } else { given };
        self.check(depth, window)?;
        let needed = self.parent_window(depth, window);
        if !parent.window.contains(&needed) {
            return Err(invalid(format!(
                "level {depth} over {window:?} needs its parent over {needed:?}, not {:?}",
                parent.window
            )));
        }
        let mut parent = parent.crop(&needed)?;
        if self.is_finest(parent.depth) {
            detail::begin(self, &mut parent);
        }
        let may_begin = lakes::begin_at(self, parent.depth);
        let new_lakes = if may_begin { lakes::begin(self, &mut parent) } else { Vec::new() };
        mouths::lead(&mut parent, given);
        let parent = &parent;
        let finest = self.is_finest(depth);
        let growing = (FIRST_PASSES + ROUNDS) as f64 + if finest { FINEST_WORK } else { 0.0 };
        progress.expect(CARVING_WORK.iter().sum::<f64>() + growing);
        let mut children = Children::new(self, parent, given, progress)?;
        lake_shores::shape(&new_lakes, parent, &mut children);
        progress.step(CARVING_WORK[0])?;
        let links = Links::new(self, parent, &children, progress)?;
        progress.step(CARVING_WORK[1])?;
        let water = standing_water(parent, &links, &mut children);
        progress.step(CARVING_WORK[2])?;
        if may_begin {
            children.extent = children.extent.shrunk(2 * lakes::REACH);
        }
        let mut carved = carve(parent, &links, &children, water);
        drop(links);
        progress.step(CARVING_WORK[3])?;
        let mut extent = children.extent.shrunk(CARVED);
        if finest {
            extent = extent.shrunk(straighten::REACH);
            straighten(extent, &children.window, &mut carved);
            progress.check()?;
        }
        let rain = given.rain(&children.window);
        let mut law = Law::new(self, &children, given);
        if self.is_detail(depth) {
            detail::free_rivers(self, depth, &mut carved, children.extent, &mut law);
        } else {
            carved.free(FREE_AREA);
        }
        if self.lakes > 0.0 {
            // Water that keeps apart depends on one more cell.
            extent = extent.shrunk(1);
        }
        let rims = lake_shores::rims(self, depth, extent, &carved);
        if self.lakes > 0.0 {
            extent = extent.shrunk(lake_shores::RIM);
        }
        let spacing = match &carved.distances {
            Some(distances) => Spacing::Irregular(distances),
            None => Spacing::Regular,
        };
        let mut growth =
            Growth::new(carved.height, carved.area, carved.receiver, carved.fixed, has_floors(self, depth));
        for pass in 0..FIRST_PASSES + ROUNDS {
            if pass == FIRST_PASSES {
                // What is not a river yet has drained nothing: the areas of rivers contain it.
                growth.area.iter_mut().filter(|area| **area <= 1.0).for_each(|area| *area = 0.0);
            }
            for _ in 0..if pass < FIRST_PASSES { 0 } else { AREA_PASSES } {
                progress.check()?;
                extent = extent.shrunk(1);
                drainage::step(extent, rain.as_deref(), &growth.receiver, &mut growth.area, &mut growth.spare);
            }
            extent = extent.shrunk(1);
            growth.pass(extent, &law, spacing, &rims, self, depth);
            progress.step(1.0)?;
        }
        if finest {
            let factor = given::factor(given.creep_factor, &children.window, 0.0..=MAX_CREEP_FACTOR);
            for _ in 0..creep_passes(self.creep) {
                progress.check()?;
                extent = extent.shrunk(1);
                let slopes =
                    Hillsides { area: &growth.area, receiver: &growth.receiver, fixed: &growth.fixed, factor: &factor };
                creep(extent, &mut growth.height, &mut growth.spare, slopes, Kept::VALLEYS);
                lake_shores::hold(&rims, &growth.spare, &mut growth.height);
            }
            for _ in 0..BANK_ROUNDS {
                for _ in 0..BANK_PASSES {
                    progress.check()?;
                    extent = extent.shrunk(1);
                    let Growth { height, spare, area, receiver, fixed, .. } = &mut growth;
                    raise_banks(extent, height, spare, area, receiver, fixed);
                }
                extent = extent.shrunk(1);
                steepest(extent, &growth.height, &growth.fixed, &mut growth.receiver);
            }
            progress.step(FINEST_WORK)?;
        }
        if self.is_detail(depth) {
            let kept = Kept::details(least_rise(self, depth));
            let factor = detail::creep_factors(&law);
            for _ in 0..detail::creep_passes(self) {
                progress.check()?;
                extent = extent.shrunk(1);
                let slopes =
                    Hillsides { area: &growth.area, receiver: &growth.receiver, fixed: &growth.fixed, factor: &factor };
                creep(extent, &mut growth.height, &mut growth.spare, slopes, kept);
                lake_shores::hold(&rims, &growth.spare, &mut growth.height);
            }
        }
        for _ in 0..last_area_passes(finest) {
            progress.check()?;
            extent = extent.shrunk(1);
            drainage::step(extent, rain.as_deref(), &growth.receiver, &mut growth.area, &mut growth.spare);
        }
        for _ in 0..RAISE_PASSES {
            progress.check()?;
            extent = extent.shrunk(1);
            drainage::raise(extent, &growth.receiver, &mut growth.area, &mut growth.spare);
        }
        for _ in 0..LIMIT_PASSES {
            progress.check()?;
            extent = extent.shrunk(1);
            drainage::limit(extent, &growth.receiver, &mut growth.area, &mut growth.spare);
        }
        let offset = ((window.x - children.window.x) as usize, (window.y - children.window.y) as usize);
        let size = (window.width, window.height);
        let part = |plane: &[f32]| cropped(plane, children.extent.width, offset, size);
        let lake = |fixed: f32, code: f32| if fixed == WATER && code < WATER { LAKE } else { 0 };
        let codes = part(&growth.receiver).into_iter().zip(part(&growth.fixed));
        let receiver = codes.map(|(code, fixed)| code as u8 + lake(fixed, code)).collect();
        let position = |plane: &[f32]| if finest { vec![0.5; window.len()] } else { part(plane) };
        Ok(Level {
            depth,
            window: *window,
            east: position(&children.east),
            south: position(&children.south),
            height: part(&growth.height),
            area: part(&growth.area),
            receiver,
            variation: part(&children.variation),
            uplift: part(&children.uplift),
            shore: part(&children.shore),
        })
    }
}
