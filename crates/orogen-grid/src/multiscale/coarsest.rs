//! The coarsest level: geography at hashed nodes, and rivers along the cheapest paths to the sea.

use super::continents::Continents;
use super::drawn_ridges::{Crest, DrawnRidges, Near};
use super::geography::Geography;
use super::given::Given;
use super::hash::{self, jittered};
use super::level::{Level, cropped};
use super::passages::Passages;
use super::ridges::{self, Flanks};
use super::routes::{self, UNREACHED};
use super::stencil::Extent;
use super::{drainage, law};
use crate::erosion::power::power;
use crate::error::Result;
use crate::grid::Window;
use crate::hydrology::direction::{NONE, STEPS};
use crate::progress::Progress;

/// Number of links over which heights and areas spread, which is the maximum length of a river of the coarsest level.
const LINKS: usize = 36;

/// Number of cells beyond a window that its nodes depend on: two rounds of links, routing and areas, and the inner
/// basins.
const REACH: usize = 4 * LINKS + 4;

/// Drainage area that the first round assumes, in km^2.
const TYPICAL_AREA: f64 = 2e4;

/// Approximate relative times for placing the nodes and for draining them in the two rounds.
const TIMES: [f64; 3] = [3.0, 1.0, 1.0];

/// Rise of a link to a ridge, in metres, where rivers first look for ways around them.
const RIDGE_COST: f32 = 2e4;

/// Minimum height of the bed of a drawn river above the sea, in metres.
const LEAST_BED: f32 = 0.01;

/// Logarithm of uplift over erodibility where no land is near.
const OFFSHORE: f32 = -2.25;

/// The kind of base at a node, from which heights rise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Base {
    None,
    Basin,
    /// A drawn river.
    River,
    Sea,
}

/// Working planes of the coarsest level.
struct Coarsest<'a> {
    land: &'a Continents,
    window: Window,
    extent: Extent,
    east: Vec<f32>,
    south: Vec<f32>,
    shore: Vec<f32>,
    uplift: Vec<f32>,
    /// Factor of the cost of links to each node.
    detour: Vec<f32>,
    base: Vec<Base>,
    /// Heights of bases; elsewhere [`UNREACHED`].
    start: Vec<f32>,
    area: Vec<f32>,
    rain: Option<Vec<f32>>,
    receiver: Vec<f32>,
    drawn: Passages,
    /// Drawn ridges.
    crests: Vec<Crest>,
    near: Vec<Near>,
    /// What ridges add to the logarithm of uplift over erodibility.
    added: Vec<f32>,
}

impl Continents {
    /// Number of samples of the coarsest level beyond a window that [`Continents::coarsest`] computes.
    pub const COARSEST_REACH: usize = REACH;

    /// The same for this land, which is more with drawn ridges.
    #[must_use]
    pub fn coarsest_reach(&self) -> usize {
        REACH + if self.refinement.ridges { ridges::edge(LINKS) } else { 0 }
    }

    /// The coarsest level over `window`. Needs about 60 bytes per sample of the window grown by
    /// [`Continents::coarsest_reach`], which `given` must cover.
    ///
    /// # Errors
    /// If a parameter is out of range, the window does not belong to the level, or the work is cancelled.
    pub fn coarsest(&self, given: &Given, window: &Window, progress: &Progress) -> Result<Level> {
        self.check()?;
        self.refinement.check(0, window)?;
        given.ridges.map_or(Ok(()), DrawnRidges::check)?;
        let [placing, first, second] = progress.parts(TIMES);
        let mut coarsest = Coarsest::new(self, given, window.grown(self.coarsest_reach()), &placing)?;
        let costs = coarsest.first_costs();
        let mut heights = coarsest.drain(&costs, RIDGE_COST, &first)?;
        coarsest.open_gaps(&mut heights);
        coarsest.choose_basins(&heights);
        let costs = coarsest.second_costs();
        let mut heights = coarsest.drain(&costs, UNREACHED, &second)?;
        coarsest.bind_ridges(&mut heights);
        Ok(coarsest.finish(heights, window))
    }

    /// Like [`Refinement::refine`](super::refinement::Refinement::refine). The geography of this land provides what is
    /// not given.
    ///
    /// # Errors
    /// The errors of [`Refinement::refine`](super::refinement::Refinement::refine).
    pub fn refine(&self, parent: &Level, given: &Given, window: &Window, progress: &Progress) -> Result<Level> {
        self.check()?;
        self.refinement.refine(parent, &Given { continents: Some(self), ..*given }, window, progress)
    }
}

impl<'a> Coarsest<'a> {
    /// The nodes with their geography.
    fn new(land: &'a Continents, given: &Given, window: Window, progress: &Progress) -> Result<Coarsest<'a>> {
        let extent = Extent { width: window.width, height: window.height, inset: 0 };
        let cells = extent.len();
        let mut made = Coarsest {
            land,
            window,
            extent,
            east: Vec::with_capacity(cells),
            south: Vec::with_capacity(cells),
            shore: Vec::with_capacity(cells),
            uplift: vec![OFFSHORE; cells],
            detour: Vec::with_capacity(cells),
            base: vec![Base::None; cells],
            start: vec![UNREACHED; cells],
            area: vec![1.0; cells],
            rain: given.rain(&window),
            receiver: vec![f32::from(NONE); cells],
            drawn: given.passages(&land.refinement, 0, &window),
            crests: given.crests(&land.refinement, 0, &window),
            near: Vec::new(),
            added: vec![0.0; cells],
        };
        let geography = Geography::new(land);
        let mut crests = made.crests.iter().peekable();
        progress.expect(2.0 * window.height as f64);
        for y in window.y..window.bottom() {
            progress.step(1.0)?;
            for x in window.x..window.right() {
                let draw = |stream| hash::unit(hash::node(land.refinement.seed, 0, x, y, stream));
                let crest = crests.next_if(|crest| crest.q == made.shore.len());
                let (east, south) = match (made.drawn.at(made.shore.len()), crest) {
                    (Some(passage), _) => (passage.east, passage.south),
                    (None, Some(crest)) => (crest.east, crest.south),
                    (None, None) => (jittered(draw(0)), jittered(draw(1))),
                };
                let (metres_east, metres_south) =
                    (land.refinement.metres(0, x, east), land.refinement.metres(0, y, south));
                made.shore.push(given.shore_or((x, y), &geography, metres_east, metres_south));
                made.east.push(east);
                made.south.push(south);
                made.detour.push(0.5 + draw(2));
            }
        }
        // The uplift is only read on land and next to it.
        for j in extent.shrunk(1).rows() {
            progress.step(1.0)?;
            for i in extent.shrunk(1).columns() {
                let q = j * extent.width + i;
                let near = [q - extent.width, q, q + extent.width];
                if near.iter().any(|&middle| made.shore[middle - 1..middle + 2].iter().any(|&shore| shore >= 0.0)) {
                    let (x, y) = (window.x + i as i64, window.y + j as i64);
                    let (east, south) =
                        (land.refinement.metres(0, x, made.east[q]), land.refinement.metres(0, y, made.south[q]));
                    made.uplift[q] = given.uplift_or((x, y), &geography, east, south);
                }
            }
        }
        for (q, &shore) in made.shore.iter().enumerate() {
            if shore < 0.0 {
                (made.base[q], made.start[q]) = (Base::Sea, 0.0);
            }
        }
        made.extent.inset = 1;
        made.place_rivers();
        made.crests.retain(|crest| made.base[crest.q] == Base::None);
        if let Some(ridges) = given.ridges.filter(|_| !made.crests.is_empty()) {
            let place = |q: usize| [made.east[q], made.south[q]];
            made.near = ridges.near(&land.refinement, 0, &made.window, ridges::REACH, place);
        }
        Ok(made)
    }

    /// Makes the land that drawn rivers cross bases at the heights of their beds. A river that ends on land next to the
    /// sea flows into it; others end in an inner basin.
    fn place_rivers(&mut self) {
        let sea = self.base.clone();
        let drawn = std::mem::take(&mut self.drawn);
        for (q, passage) in drawn.left().filter(|(q, _)| sea[*q] != Base::Sea) {
            (self.base[q], self.start[q]) = (Base::River, passage.height.max(LEAST_BED));
        }
        for (q, passage) in drawn.ended().filter(|(q, _)| sea[*q] != Base::Sea) {
            let (i, j) = (q % self.extent.width, q / self.extent.width);
            let is_inner = self.extent.columns().contains(&i) && self.extent.rows().contains(&j);
            let ends_at_sea = is_inner && self.way_to_sea(q).is_some();
            self.base[q] = if ends_at_sea { Base::River } else { Base::Basin };
            self.start[q] = passage.height.max(LEAST_BED);
        }
        self.drawn = drawn;
    }

    /// The direction from a cell to a neighbor in the sea.
    fn way_to_sea(&self, q: usize) -> Option<u8> {
        let width = self.extent.width as isize;
        [0u8, 2, 4, 6, 1, 3, 5, 7].into_iter().find(|code| {
            let (east, south) = STEPS[usize::from(*code)];
            self.base[q.wrapping_add_signed(south * width + east)] == Base::Sea
        })
    }

    /// Directs drawn rivers along their lines.
    fn lead_rivers(&mut self) {
        let area = self.land.refinement.kilometres(0) * self.land.refinement.kilometres(0);
        let drawn = std::mem::take(&mut self.drawn);
        for (q, passage) in drawn.left().chain(drawn.ended()).filter(|(q, _)| self.base[*q] == Base::River) {
            let code = if passage.code < NONE { Some(passage.code) } else { self.way_to_sea(q) };
            self.receiver[q] = f32::from(code.unwrap_or(NONE));
            self.area[q] = self.area[q].max((passage.area / area) as f32);
        }
        self.drawn = drawn;
    }

    /// Rise per cell of distance if the drainage area is the same everywhere.
    fn first_costs(&self) -> Vec<f32> {
        let rise = (law::river_slope(&self.land.refinement, TYPICAL_AREA) * self.land.refinement.cell_of(0)) as f32;
        self.uplift.iter().map(|&uplift| rise * power(std::f32::consts::E, uplift)).collect()
    }

    /// Rise per cell of distance with the drainage areas of the first round.
    fn second_costs(&self) -> Vec<f32> {
        let kilometres = self.land.refinement.kilometres(0);
        let rise =
            (law::river_slope(&self.land.refinement, kilometres * kilometres) * self.land.refinement.cell_of(0)) as f32;
        let cost =
            |(&uplift, &area): (&f32, &f32)| rise * power(std::f32::consts::E, uplift) * power(area, -law::CONCAVITY);
        self.uplift.iter().zip(&self.area).map(cost).collect()
    }

    /// Routes all land to the bases along the cheapest links, and adds up the areas. Links to the nodes of ridges rise
    /// by `ridge_cost` in addition. Returns the heights.
    fn drain(&mut self, cost: &[f32], ridge_cost: f32, progress: &Progress) -> Result<Vec<f32>> {
        let nodes = routes::Nodes { east: &self.east, south: &self.south, cost, detour: &self.detour };
        let links = routes::links(self.extent, &nodes);
        let mut heights = self.start.clone();
        let mut spare = heights.clone();
        // Cheap paths from other bases do not lower the beds of drawn rivers.
        let pinned: Vec<usize> = (0..self.base.len()).filter(|&q| self.base[q] == Base::River).collect();
        progress.expect(2.0 * LINKS as f64);
        let mut natural = vec![UNREACHED; self.crests.len()];
        for _ in 0..LINKS {
            progress.step(1.0)?;
            self.extent = self.extent.shrunk(1);
            routes::relax(self.extent, &links, &mut heights, &mut spare);
            pinned.iter().for_each(|&q| heights[q] = self.start[q]);
            for (crest, natural) in self.crests.iter().zip(&mut natural) {
                *natural = heights[crest.q].min(*natural);
                heights[crest.q] = (*natural + ridge_cost).min(UNREACHED);
            }
        }
        self.extent = self.extent.shrunk(1);
        routes::route(self.extent, &links, &heights, &self.start, &mut self.receiver);
        for (crest, natural) in self.crests.iter().zip(&natural) {
            heights[crest.q] = *natural;
        }
        self.lead_rivers();
        for _ in 0..LINKS {
            progress.step(1.0)?;
            self.extent = self.extent.shrunk(1);
            drainage::step(self.extent, self.rain.as_deref(), &self.receiver, &mut self.area, &mut spare);
        }
        self.lead_rivers();
        Ok(heights)
    }

    /// Lets rivers through ridges from where there is no other way, and lowers the land behind.
    fn open_gaps(&mut self, heights: &mut [f32]) {
        let width = self.extent.width;
        let is_fed = |crest: &Crest| {
            let mut around = (0..).zip(STEPS);
            around.any(|(code, (east, south)): (u8, _)| {
                let donor = crest.q.checked_add_signed(south * width as isize + east);
                let back = f32::from((code + 4) & 7);
                donor.and_then(|donor| self.receiver.get(donor)).is_some_and(|receiver| *receiver == back)
            })
        };
        let crests = std::mem::take(&mut self.crests);
        self.crests = crests.iter().filter(|crest| !is_fed(crest)).copied().collect();
        if !crests.is_empty() {
            let is_behind = |height: &&mut f32| (RIDGE_COST..UNREACHED).contains(*height);
            heights.iter_mut().filter(is_behind).for_each(|height| *height %= RIDGE_COST);
        }
    }

    /// Gives ridges their heights, and raises the land to them.
    fn bind_ridges(&mut self, heights: &mut Vec<f32>) {
        if self.crests.is_empty() {
            return;
        }
        let place = |q: usize| [self.east[q], self.south[q]];
        let mut flanks = Flanks {
            land: &self.land.refinement,
            depth: 0,
            width: self.extent.width,
            receiver: &mut self.receiver,
            near: &self.near,
            links: LINKS,
            place: &place,
            is_known: &|q| self.base[q] != Base::None,
            logarithm: &|q| self.uplift[q],
        };
        flanks.turn_to_lowest(heights, &self.crests);
        let (bound, added) = flanks.bind(heights, &self.crests);
        *heights = flanks.above_receivers(bound, &|q| self.base[q] == Base::None);
        self.added = added;
    }

    /// Chooses inner basins: high and gentle land behind steep land, where rivers could not cut a path to the sea, and
    /// places that no path to the sea reaches.
    fn choose_basins(&mut self, heights: &[f32]) {
        let (relief, width) = (self.land.refinement.relief as f32, self.extent.width);
        let score = |q: usize| match heights[q] {
            height if self.base[q] == Base::Sea => height + UNREACHED,
            height if height >= UNREACHED => 1000.0 + self.detour[q],
            height => self.uplift[q] - 0.8 * logarithm(height.max(1.0)),
        };
        let scores: Vec<f32> = (0..heights.len()).map(score).collect();
        let mut found = Vec::new();
        for j in self.extent.rows() {
            for i in self.extent.columns() {
                let (q, height) = (j * width + i, heights[j * width + i]);
                let unreached = height >= UNREACHED && self.base[q] == Base::None;
                let suitable = self.base[q] == Base::None
                    && self.shore[q] >= 200.0
                    && height >= 250.0 * relief
                    && self.uplift[q] <= -0.9;
                let bits =
                    hash::node(self.land.refinement.seed, 0, self.window.x + i as i64, self.window.y + j as i64, 4);
                let chosen = suitable && height < UNREACHED && f64::from(hash::unit(bits)) < self.land.basins;
                if !(unreached || chosen) {
                    continue;
                }
                let mut rows = (j - 2..=j + 2).map(|row| row * width + i - 2..row * width + i + 3);
                let alone =
                    rows.all(|row| row.into_iter().all(|o| o == q || (scores[o] > scores[q] && self.shore[o] >= 0.0)));
                if alone && self.crests.binary_search_by_key(&q, |crest| crest.q).is_err() {
                    let height = if unreached { 1500.0 * relief } else { height };
                    found.push((q, height * (0.08 + 0.3 * hash::unit(bits << 24))));
                }
            }
        }
        for (q, height) in found {
            (self.base[q], self.start[q]) = (Base::Basin, height);
        }
    }

    /// The level over `window`.
    fn finish(mut self, mut heights: Vec<f32>, window: &Window) -> Level {
        let width = self.window.width;
        for (q, height) in heights.iter_mut().enumerate() {
            let drains = self.receiver[q] < f32::from(NONE);
            self.shore[q] = match self.base[q] {
                Base::Sea => self.shore[q].min(-4.0),
                _ if drains => self.shore[q].clamp(4.0, 100.0),
                _ => {
                    let (x, y) = (self.window.x + (q % width) as i64, self.window.y + (q / width) as i64);
                    -15.0 - 60.0 * hash::unit(hash::node(self.land.refinement.seed, 0, x, y, 5))
                }
            };
            if *height >= UNREACHED {
                *height = 0.0;
            }
        }
        let part = |plane: &[f32]| cropped(plane, &self.window, window);
        Level {
            depth: 0,
            window: *window,
            east: part(&self.east),
            south: part(&self.south),
            height: part(&heights),
            area: part(&self.area),
            receiver: part(&self.receiver).into_iter().map(|code| code as u8).collect(),
            variation: part(&self.added),
            uplift: part(&self.uplift),
            shore: part(&self.shore),
        }
    }
}

fn logarithm(x: f32) -> f32 {
    libm::log(f64::from(x)) as f32
}
