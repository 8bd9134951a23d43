//! Flood plains: land whose height above the river that it drains to (height above nearest drainage; Rennó and others
//! 2008, Nobre and others 2011) is less than the rise of a flood in that river.

use super::level::Level;
use super::refinement::Refinement;
use super::surface::Surface;
use crate::error::Result;
use crate::grid::Grid;
use crate::hydrology::rivers::Channel;
use crate::progress::Progress;

/// Height of a flood above the bed, as a multiple of the river's depth at its mean discharge. A river fills its banks
/// at about five times that discharge and is then 5^0.4 = 1.9 times as deep. Land up to twice as high is prone to
/// floods (Rosgen 1994).
const STAGE: f64 = 4.0;

/// Longest path from land to its river, in metres and in links between nodes.
const FURTHEST: f64 = 4000.0;
const MAX_LINKS: usize = 96;

/// The last part of the longest path, as a share, in which floods become shallower, so that a flood plain does not end
/// in a step.
const THINNING: f32 = 0.25;

/// The path leads to no river.
const NOWHERE: usize = usize::MAX;

/// The river is not known yet.
const UNKNOWN: usize = usize::MAX - 1;

/// The rivers of a level and their floods.
struct Floods<'a> {
    level: &'a Level,
    square_metres: f32,
    least_area: f64,
    channel: &'a Channel,
    links: usize,
    backwater: usize,
    /// The first river node on the path down from each node, and the number of links to it.
    river: Vec<usize>,
    way: Vec<u16>,
    /// The height of the flood at river nodes; NaN until it is computed.
    height: Vec<f32>,
    path: Vec<usize>,
}

impl Refinement {
    /// Number of samples of a level beyond a window that [`Refinement::floodplain`] reads.
    #[must_use]
    pub fn floods_reach(&self, depth: usize) -> usize {
        let links = self.flood_links(depth);
        Refinement::SURFACE_REACH + links + backwater_links(links) + 1
    }

    fn flood_links(&self, depth: usize) -> usize {
        self.cells_in(depth, FURTHEST, MAX_LINKS)
    }

    /// Depth in metres of the flood at the points of a surface of this level; 0 where there is none. `share` is the
    /// position within cells at which the surface was made (see [`Refinement::surface_at`]), and `least_area` the
    /// minimum drainage area of rivers in m^2. In a river the flood is four times as deep as the river. It reaches all
    /// land below its height that drains to the river within 4000 m or 96 links along the receivers. In the last
    /// quarter of that distance the flood becomes shallower. The flood of a river also backs up into its tributaries.
    ///
    /// # Errors
    /// If the level does not cover the surface's window grown by [`Refinement::floods_reach`], or the work is
    /// cancelled.
    pub fn floodplain(
        &self,
        share: f32,
        level: &Level,
        surface: &Surface,
        least_area: f64,
        channel: &Channel,
        progress: &Progress,
    ) -> Result<Grid> {
        let window = surface.height.window();
        let nodes = self.nodes_at(level.depth, window);
        level.check_covers("a flood plain", &nodes, self.floods_reach(level.depth))?;
        let cell = self.cell_of(level.depth);
        let links = self.flood_links(level.depth);
        let mut floods = Floods {
            level,
            square_metres: (cell * cell) as f32,
            least_area,
            channel,
            links,
            backwater: backwater_links(links),
            river: vec![UNKNOWN; level.window.len()],
            way: vec![0; level.window.len()],
            height: vec![f32::NAN; level.window.len()],
            path: Vec::new(),
        };
        let mut depth = Grid::filled(*window, 0.0f32);
        for j in 0..window.height {
            progress.check()?;
            for i in 0..window.width {
                if !surface.water_level[(i, j)].is_nan() {
                    continue;
                }
                let q = self.nearest_node(share, level, level.row(&nodes, j) + i);
                // On detail levels points lie on the smooth ground between nodes. On coarser levels that ground is
                // smoother than the valleys, so the height of the node is used.
                let ground = if self.is_detail(level.depth) { surface.height[(i, j)] } else { level.height[q] };
                depth[(i, j)] = floods.depth(q, ground);
            }
        }
        Ok(depth)
    }
}

/// Number of links up a river over which a flood backs up.
fn backwater_links(links: usize) -> usize {
    links.div_ceil(3)
}

impl Floods<'_> {
    /// Depth of the flood at a node above ground of this height.
    fn depth(&mut self, q: usize, ground: f32) -> f32 {
        if self.is_large(q) {
            // A point on land may be nearest to a node in the water that a river enters.
            let own = (STAGE * self.depth_of(q)) as f32;
            return if self.level.is_water(q) { own } else { own.max(self.height_at(q) - ground) };
        }
        self.find_river(q);
        let (river, way) = (self.river[q], self.way[q]);
        if river == NOWHERE {
            return 0.0;
        }
        let left = (self.links - usize::from(way)) as f32 / (THINNING * self.links as f32);
        let bed = self.level.height[river];
        (bed + (self.height_at(river) - bed) * left.min(1.0) - ground).max(0.0)
    }

    fn is_river(&self, q: usize) -> bool {
        self.is_large(q) && !self.level.is_water(q)
    }

    /// Whether the drainage area is large enough for a river.
    fn is_large(&self, q: usize) -> bool {
        f64::from(self.level.area[q] * self.square_metres) >= self.least_area
    }

    /// Depth of the river at a node, from bank to bed.
    fn depth_of(&self, q: usize) -> f64 {
        self.channel.depth_of(self.channel.discharge(f64::from(self.level.area[q] * self.square_metres)))
    }

    /// Finds the first river on the path down from a node, and from all nodes on that path.
    fn find_river(&mut self, start: usize) {
        self.path.clear();
        let mut at = start;
        let (mut river, mut way) = (NOWHERE, 0);
        loop {
            if self.river[at] != UNKNOWN {
                (river, way) = (self.river[at], self.way[at]);
                break;
            }
            if self.is_river(at) {
                river = at;
                break;
            }
            self.path.push(at);
            // Given receivers may form a cycle. There is no river on such a path.
            self.river[at] = NOWHERE;
            match self.level.downstream(at) {
                Some(to) => at = to,
                None => break,
            }
        }
        for &at in self.path.iter().rev() {
            way += 1;
            if usize::from(way) > self.links {
                river = NOWHERE;
            }
            if river == NOWHERE {
                break;
            }
            (self.river[at], self.way[at]) = (river, way);
        }
    }

    /// Height of the flood at a river node: the flood of the river there, or the flood further downstream if it backs
    /// up higher. Backing up decreases with the distance. Nodes are as high as the banks, which are above the bed by
    /// the depth of the river.
    fn height_at(&mut self, river: usize) -> f32 {
        if self.height[river].is_nan() {
            let rise = |at: usize| ((STAGE - 1.0) * self.depth_of(at)) as f32;
            let mut flood = self.level.height[river] + rise(river);
            let mut at = river;
            for link in 1..self.backwater {
                match self.level.downstream(at) {
                    Some(to) if self.is_river(to) => at = to,
                    _ => break,
                }
                let share = 1.0 - link as f32 / self.backwater as f32;
                flood = flood.max(self.level.height[at] + rise(at) * share);
            }
            self.height[river] = flood;
        }
        self.height[river]
    }
}
