//! The nodes of a level before rivers are carved: positions, rock and the shape of the shore, from the next coarser
//! level and from hashes.

use super::geography::Geography;
use super::given::Given;
use super::hash::{self, jittered};
use super::level::Level;
use super::refinement::Refinement;
use super::stencil::Extent;
use super::{lakes, rock};
use crate::error::Result;
use crate::grid::Window;
use crate::progress::Progress;
use crate::random::mix64;

/// Variation of the rock that each level adds; the last value is for all further levels.
const VARIATION: [f32; 12] = [0.0, 0.3, 0.35, 0.45, 0.5, 0.5, 0.4, 0.4, 0.4, 0.3, 0.2, 0.2];

/// The smallest cell, in km, at which geography is evaluated. Finer levels interpolate it.
pub const FINEST_GEOGRAPHY: f64 = 3.0;

/// The node that a parent becomes moves this share of the distance to a random position in its cell.
const WANDER: f32 = 0.5;

/// The children of all nodes of a parent level: cell (i, j) of the parent has the children (2 i, 2 j) to
/// (2 i + 1, 2 j + 1).
pub struct Children {
    pub depth: usize,
    pub window: Window,
    pub extent: Extent,
    /// Positions in the cells; empty on the finest level, where all nodes are in the middle of their cells.
    pub east: Vec<f32>,
    pub south: Vec<f32>,
    pub variation: Vec<f32>,
    pub uplift: Vec<f32>,
    pub shore: Vec<f32>,
    /// Irregularity of the shore that this level adds, in km.
    pub indent: f32,
}

/// The child that the node of a cell becomes (its heir), of the four children of the cell: bit 0 is set in the east,
/// bit 1 in the south.
#[inline(always)]
pub fn heir(parent: &Level, q: usize) -> u8 {
    u8::from(parent.east[q] >= 0.5) | u8::from(parent.south[q] >= 0.5) << 1
}

/// Irregularity of the shore that a level adds, in km, such that the shore becomes a fractal line.
pub fn indent(land: &Refinement, depth: usize) -> f32 {
    (0.5 * 61.44 * libm::pow(land.kilometres(depth) / 61.44, 0.92)) as f32
}

/// Standard deviation of the variation of the rock that a level adds.
pub fn amplitude(land: &Refinement, depth: usize) -> f32 {
    land.variation as f32 * VARIATION[depth.min(VARIATION.len() - 1)]
}

/// Share of the change over a cell that counts as the slope of the shore. The rest is due to irregularities of coarser
/// levels.
const SHORE_SLOPE: f32 = 0.5;

/// Change of the distance to the shore per kilometre near the shore, at least 1. `falls` are the changes over a cell to
/// the east and to the south. Irregularities are multiplied by it, so that they move every shore by the same distance.
fn steepness(shore: f32, falls: [f32; 2], cell: f32) -> f32 {
    let steep = SHORE_SLOPE * (falls[0] * falls[0] + falls[1] * falls[1]).sqrt() / cell;
    let near = (2.0 - shore.abs() / (3.0 * cell * steep.max(1.0))).clamp(0.0, 1.0);
    1.0 + near * (steep - 1.0).max(0.0)
}

impl Children {
    /// The children of `parent`. Rock and shores are exact except for one parent at the edge.
    pub fn new(land: &Refinement, parent: &Level, given: &Given, progress: &Progress) -> Result<Children> {
        let (depth, from) = (parent.depth + 1, parent.window);
        let (width, height) = (2 * from.width, 2 * from.height);
        let window = Window { x: 2 * from.x, y: 2 * from.y, width, height, cell: land.cell_of(depth) };
        let cells = width * height;
        let mut children = Children {
            depth,
            window,
            extent: Extent { width, height, inset: 0 },
            east: vec![0.5; if land.is_finest(depth) { 0 } else { cells }],
            south: vec![0.5; if land.is_finest(depth) { 0 } else { cells }],
            variation: vec![0.0; cells],
            uplift: vec![0.0; cells],
            shore: vec![0.0; cells],
            indent: indent(land, depth),
        };
        let coarse = land.kilometres(depth) >= FINEST_GEOGRAPHY;
        let geography = given.continents.filter(|_| coarse).map(Geography::new);
        let geography = geography.as_ref();
        for j in 0..height {
            if j % 32 == 0 || geography.is_some() {
                progress.check()?;
            }
            if children.is_irregular() {
                children.place_row(land, parent, j);
            }
            if (2..height - 2).contains(&j) {
                children.inherit_row(land, parent, j, given, geography);
            }
        }
        Ok(children)
    }

    /// Whether the nodes can be outside the middle of their cells.
    pub fn is_irregular(&self) -> bool {
        !self.east.is_empty()
    }

    /// The random bits of a node, for all its hashes.
    #[inline(always)]
    fn bits(&self, land: &Refinement, i: usize, j: usize) -> u64 {
        hash::node(land.seed, self.depth, self.window.x + i as i64, self.window.y + j as i64, 0)
    }

    /// Positions of the nodes of row `j`. The heir of a parent stays near the parent's position.
    fn place_row(&mut self, land: &Refinement, parent: &Level, j: usize) {
        let width = self.extent.width;
        for i in 0..width {
            let p = j / 2 * (width / 2) + i / 2;
            let child = (i & 1) as u8 | ((j & 1) as u8) << 1;
            let bits = self.bits(land, i, j);
            let (draw_east, draw_south) = (hash::unit(bits), hash::unit(bits << 24));
            let (east, south) = if heir(parent, p) == child {
                let near = |share: f32, bit: usize, draw: f32| {
                    let share = 2.0 * share - bit as f32;
                    share + WANDER * (draw - share)
                };
                (near(parent.east[p], i & 1, draw_east), near(parent.south[p], j & 1, draw_south))
            } else {
                (jittered(draw_east), jittered(draw_south))
            };
            (self.east[j * width + i], self.south[j * width + i]) = (east, south);
        }
    }

    /// Rock and shore of the inner nodes of row `j`, interpolated from the four nearest parents.
    fn inherit_row(
        &mut self,
        land: &Refinement,
        parent: &Level,
        j: usize,
        given: &Given,
        geography: Option<&Geography>,
    ) {
        let width = self.extent.width;
        let parents = width / 2;
        let near_row = j / 2 * parents;
        let far_row = if j & 1 == 1 { near_row + parents } else { near_row - parents };
        let (has_lakes, beside) = (land.lakes > 0.0, lakes::beside(land, parent.depth));
        let kilometres = land.kilometres(self.depth) as f32;
        let amplitude = amplitude(land, self.depth);
        for i in 2..width - 2 {
            let near = i / 2;
            let far = if i & 1 == 1 { near + 1 } else { near - 1 };
            let blend = |plane: &[f32]| {
                0.5625 * plane[near_row + near]
                    + 0.1875 * plane[near_row + far]
                    + 0.1875 * plane[far_row + near]
                    + 0.0625 * plane[far_row + far]
            };
            let (q, bits) = (j * width + i, self.bits(land, i, j));
            self.variation[q] = blend(&parent.variation) + amplitude * hash::normal(mix64(bits ^ 0x5555));
            let (x, y) = (self.window.x + i as i64, self.window.y + j as i64);
            self.uplift[q] = match (given.uplift(x, y), geography) {
                _ if land.is_detail(self.depth) => {
                    let uplift = blend(&parent.uplift);
                    uplift + amplitude * rock::roughness(uplift) * hash::normal(mix64(bits ^ 0x3333))
                }
                (Some(uplift), _) => uplift,
                (None, Some(geography)) => geography
                    .uplift(land.metres(self.depth, x, self.east[q]), land.metres(self.depth, y, self.south[q])),
                (None, None) => blend(&parent.uplift),
            };
            let parents = [near_row + near, near_row + far, far_row + near, far_row + far];
            let beside_lake = has_lakes && parents.into_iter().any(|p| lakes::is_lake(parent.receiver[p]));
            // Coasts of mountains are more indented than those of plains.
            let rugged = 0.45 + 0.9 * ((self.uplift[q] + 3.0) / 3.2).clamp(0.0, 1.0);
            let steepness = || {
                let here = parent.shore[near_row + near];
                let falls = [here - parent.shore[near_row + far], here - parent.shore[far_row + near]];
                steepness(blend(&parent.shore), falls, 2.0 * kilometres)
            };
            let irregular = self.indent * rugged * if land.sea { steepness() } else { 1.0 };
            let irregular = irregular * hash::normal(mix64(bits ^ 0xAAAA));
            // Land is near the shore of a lake, even if it is far from the sea.
            let beside_water = || {
                let shares = [0.5625, 0.1875, 0.1875, 0.0625].into_iter().zip(parents);
                shares.map(|(share, p)| share * parent.shore[p].min(beside)).sum::<f32>()
            };
            let (east, south) = if self.is_irregular() { (self.east[q], self.south[q]) } else { (0.5, 0.5) };
            self.shore[q] = match given.shore_at((x, y), east, south) {
                _ if beside_lake => beside_water() + lakes::SHORE_IRREGULARITY * irregular,
                Some(shore) if parents.into_iter().any(|p| parent.is_inland(p)) => {
                    shore.min(beside_water() + irregular)
                }
                Some(shore) => shore,
                None => blend(&parent.shore) + irregular,
            };
        }
    }
}
