//! Computation of one level from the next coarser one.

use super::banks::raise_banks;
use super::carve::{Carved, UNKNOWN, carve};
use super::children::Children;
use super::creep::{Hillsides, Kept, creep, steepest};
use super::distances::Distances;
use super::drainage::{self, WATER};
use super::given::{self, Given};
use super::growth::{Growth, Spacing};
use super::law::{Law, has_floors};
use super::level::{LAKE, Level, cropped, invalid};
use super::links::Links;
use super::passages::Drawn;
use super::refinement::Refinement;
use super::ridges::{self, Ridges};
use super::schedule::{LevelPass, Schedule};
use super::shores::standing_water;
use super::stencil::Extent;
use super::straighten::straighten;
use super::{detail, lake_shores, lakes, mouths};
use crate::error::Result;
use crate::grid::Window;
use crate::progress::Progress;

/// The work before the passes, relative to a pass of growth.
const CARVING_WORK: [f64; 4] = [1.0, 1.0, 0.5, 0.5];

/// Maximum factor of creep, at which a height is replaced with the average of its neighbors.
const MAX_CREEP_FACTOR: f32 = 1.25;

/// Drainage area, in cells, below which river nodes of the coarser level choose their receivers again.
pub const FREE_AREA: f32 = 64.0;

/// The work of a pass, relative to a pass of growth with its areas.
fn work(pass: LevelPass) -> f64 {
    match pass {
        LevelPass::Grow => 1.0,
        LevelPass::Creep | LevelPass::RaiseBanks | LevelPass::Descend => 0.2,
        _ => 0.0,
    }
}

impl Refinement {
    /// Peak memory of [`Refinement::refine`], in bytes per sample of the window grown by twice the
    /// [reach](Refinement::reach). It includes the result, but not the parent.
    #[must_use]
    pub fn bytes_per_sample() -> u64 {
        // Planes of 4 bytes: children 5, rivers 4, distances 4, the law 3, growth 4. In bytes: the result 29, and a
        // quarter of the parent 8.
        120
    }

    /// The nodes of `window` on the level below `parent`, which must cover [`Refinement::parent_window`]; its other
    /// nodes are not read. `given` covers the window grown by [`Refinement::given_reach`]; detail levels use only
    /// its rivers and, if they [read it](Refinement::reads_shore), its shore.
    ///
    /// # Errors
    /// If the parent covers too little, a parameter is out of range, the window does not belong to the level, or the
    /// work is cancelled.
    pub fn refine(&self, parent: &Level, given: &Given, window: &Window, progress: &Progress) -> Result<Level> {
        let depth = parent.depth + 1;
        let shore = given.shore.filter(|_| self.reads_shore(depth));
        // The samples of detail levels are at the corners of their cells.
        let sample = if self.is_detail(depth) { 0.0 } else { self.half_finest(depth) };
        let binding = shore.filter(|_| self.is_shore_binding()).map(|_| sample);
        let given = &match self.is_detail(depth) {
            true => Given { rivers: given.rivers, ridges: given.ridges, shore, binding, ..Given::default() },
            false => Given { binding, ..*given },
        };
        self.check(depth, window)?;
        let needed = self.parent_window(depth, window);
        if !parent.window.contains(&needed) {
            return Err(invalid(format!(
                "level {depth} over {window:?} needs its parent over {needed:?}, not {:?}",
                parent.window
            )));
        }
        let schedule = self.schedule(depth);
        let mut parent = parent.crop(&needed)?;
        if schedule.begins_details {
            detail::begin(self, &mut parent);
        }
        let above = given.passages(self, depth - 1, &parent.window);
        above.place(&mut parent.east, &mut parent.south);
        let new_lakes = if schedule.lakes > 0 { lakes::begin(self, &mut parent, &above) } else { Vec::new() };
        mouths::lead(&mut parent, given);
        progress.expect(CARVING_WORK.into_iter().chain(schedule.passes.iter().copied().map(work)).sum());
        let mut children = Children::new(self, &parent, given, progress)?;
        lake_shores::shape(&new_lakes, &parent, &mut children);
        progress.step(CARVING_WORK[0])?;
        let crests = given.crests(self, depth, &children.window);
        let ridges = ridges::marks(&crests, children.window.width, children.window.len());
        let drawn = Drawn { below: given.passages(self, depth, &children.window), above, ridges };
        if children.is_irregular() {
            for crest in &crests {
                (children.east[crest.q], children.south[crest.q]) = (crest.east, crest.south);
            }
            drawn.below.place(&mut children.east, &mut children.south);
        }
        let carved = self.carved((&parent, given), &mut children, &drawn, &schedule, progress)?;
        let ridges = Ridges::new(self, &children, given.ridges, &crests, &carved);
        let mut growing = Growing::new(self, &children, carved, (given, ridges), &schedule);
        for (done, pass) in (1..).zip(schedule.passes.iter().copied()) {
            growing.run(pass);
            progress.step(work(pass))?;
            if done == schedule.grown && schedule.ridges > 0 {
                growing.bind_ridges(&children, schedule.ridges);
            }
        }
        Ok(growing.finish(&children, window))
    }

    /// The children with the rivers and the water of the coarser level.
    fn carved(
        &self,
        (parent, given): (&Level, &Given),
        children: &mut Children,
        drawn: &Drawn,
        schedule: &Schedule,
        progress: &Progress,
    ) -> Result<Carved> {
        let links = Links::new(self, parent, children, drawn, progress)?;
        progress.step(CARVING_WORK[1])?;
        let water = standing_water(parent, &links, &drawn.below, children, given);
        progress.step(CARVING_WORK[2])?;
        children.extent = children.extent.shrunk(schedule.lakes);
        let mut carved = carve(self, parent, &links, children, water, drawn);
        progress.step(CARVING_WORK[3])?;
        if schedule.is_finest {
            let extent = children.extent.shrunk(schedule.carved + schedule.straightened);
            straighten(extent, &children.window, &mut carved);
            progress.check()?;
        }
        Ok(carved)
    }
}

/// A level whose heights and areas are being computed.
struct Growing<'a> {
    land: &'a Refinement,
    depth: usize,
    extent: Extent,
    growth: Growth,
    law: Law,
    /// `None` on the finest level, where nodes are on the lattice.
    distances: Option<Distances>,
    rims: Vec<f32>,
    /// The same, with those of rivers beside drawn ridges.
    least: Vec<f32>,
    ridges: Option<Ridges>,
    rain: Option<Vec<f32>>,
    creep_factor: Vec<f32>,
    /// Cells of drawn rivers, and their areas by the drawing.
    drawn: Vec<(usize, f32)>,
}

impl<'a> Growing<'a> {
    fn new(
        land: &'a Refinement,
        children: &Children,
        mut carved: Carved,
        (given, ridges): (&Given, Option<Ridges>),
        schedule: &Schedule,
    ) -> Growing<'a> {
        let depth = children.depth;
        let mut law = Law::new(land, children, given);
        if land.is_detail(depth) {
            detail::free_rivers(land, depth, &mut carved, children.extent, &mut law);
        } else {
            carved.free(FREE_AREA);
        }
        let edge = schedule.edge() - schedule.lakes;
        let mut rims = schedule
            .rims
            .map_or(Vec::new(), |rim| lake_shores::rims(land, depth, children.extent.shrunk(edge - rim), &carved));
        carved.hold_drawn(&mut rims, lake_shores::ANYTHING);
        let drawn = carved.drawn_areas();
        let mut least = rims.clone();
        if let Some(ridges) = &ridges {
            ridges.hold(&carved, &mut least, lake_shores::ANYTHING);
        }
        let creep_factor = if schedule.is_finest {
            given::factor(given.creep_factor, &children.window, 0.0..=MAX_CREEP_FACTOR)
        } else if land.is_detail(depth) {
            detail::creep_factors(&law)
        } else {
            Vec::new()
        };
        let Carved { height, area, receiver, fixed, distances, .. } = carved;
        Growing {
            land,
            depth,
            extent: children.extent.shrunk(edge),
            growth: Growth::new(height, area, receiver, fixed, has_floors(land, depth)),
            law,
            distances,
            rims,
            least,
            ridges,
            rain: given.rain(&children.window),
            creep_factor,
            drawn,
        }
    }

    fn run(&mut self, pass: LevelPass) {
        self.extent = self.extent.shrunk(1);
        let extent = self.extent;
        let Growth { height, area, receiver, fixed, spare, .. } = &mut self.growth;
        match pass {
            LevelPass::FirstAreas | LevelPass::AddAreas => {
                if pass == LevelPass::FirstAreas {
                    area.iter_mut().filter(|area| **area <= 1.0).for_each(|area| *area = 0.0);
                }
                drainage::step(extent, self.rain.as_deref(), receiver, area, spare);
            }
            LevelPass::Grow => {
                let spacing = self.distances.as_ref().map_or(Spacing::Regular, Spacing::Irregular);
                self.growth.pass(extent, &self.law, spacing, &self.least, self.land, self.depth);
                if let Some(ridges) = &mut self.ridges {
                    ridges.hide(&mut self.growth.height);
                }
            }
            LevelPass::Creep => {
                let slopes = Hillsides { area, receiver, fixed, factor: &self.creep_factor };
                creep(extent, height, spare, slopes, Kept::on(self.land, self.depth));
                lake_shores::hold(&self.rims, spare, height);
                self.drawn.iter().for_each(|&(q, _)| height[q] = spare[q]);
                if let Some(ridges) = &self.ridges {
                    ridges.keep(spare, height);
                }
            }
            LevelPass::RaiseBanks => raise_banks(extent, height, spare, area, receiver, fixed),
            LevelPass::Descend => match &mut self.ridges {
                Some(ridges) => {
                    ridges.hide(height);
                    steepest(extent, height, fixed, receiver);
                    ridges.descend(height, receiver, extent.width);
                    ridges.show(height);
                }
                None => steepest(extent, height, fixed, receiver),
            },
            LevelPass::RaiseAreas => {
                // The sums of the passes reach a few cells upstream.
                self.drawn.iter().for_each(|&(q, least)| area[q] = area[q].max(least));
                drainage::raise(extent, receiver, area, spare);
            }
            LevelPass::LimitAreas => drainage::limit(extent, receiver, area, spare),
        }
    }

    /// Gives drawn ridges their heights.
    fn bind_ridges(&mut self, children: &Children, edge: usize) {
        let first = self.extent;
        self.extent = first.shrunk(edge);
        let Some(ridges) = &mut self.ridges else { return };
        let spacing = self.distances.as_ref().map_or(Spacing::Regular, Spacing::Irregular);
        ridges.show(&mut self.growth.height);
        for pass in 1..=ridges::POCKET_PASSES {
            let (height, receiver) = (self.growth.height.clone(), self.growth.receiver.clone());
            self.growth.pass(first.shrunk(pass), &self.law, spacing, &self.least, self.land, self.depth);
            for (q, height) in height.into_iter().enumerate().filter(|(_, height)| *height < UNKNOWN) {
                (self.growth.height[q], self.growth.receiver[q]) = (height, receiver[q]);
            }
        }
        let Growth { height, receiver, fixed, .. } = &mut self.growth;
        ridges.bind(self.land, children, height, receiver, fixed);
    }

    /// The level over `window`.
    fn finish(&self, children: &Children, window: &Window) -> Level {
        let growth = &self.growth;
        let part = |plane: &[f32]| cropped(plane, &children.window, window);
        let lake = |fixed: f32, code: f32| if fixed == WATER && code < WATER { LAKE } else { 0 };
        let codes = part(&growth.receiver).into_iter().zip(part(&growth.fixed));
        let receiver = codes.map(|(code, fixed)| code as u8 + lake(fixed, code)).collect();
        let position = |plane: &[f32]| if children.is_irregular() { part(plane) } else { vec![0.5; window.len()] };
        Level {
            depth: self.depth,
            window: *window,
            east: position(&children.east),
            south: position(&children.south),
            height: part(&growth.height),
            area: part(&growth.area),
            receiver,
            variation: match self.ridges.as_ref().filter(|ridges| !ridges.added.is_empty()) {
                Some(ridges) => {
                    let sum = |(own, added): (&f32, &f32)| own + added;
                    part(&children.variation.iter().zip(&ridges.added).map(sum).collect::<Vec<_>>())
                }
                None => part(&children.variation),
            },
            uplift: part(&children.uplift),
            shore: part(&children.shore),
        }
    }
}
