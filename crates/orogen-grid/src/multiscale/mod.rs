//! Unbounded eroded terrain, level by level.
//!
//! The terrain is a pyramid of lattices. A node of a level has a position in its cell, a height, a drainage area and a
//! receiver. The coarsest level is a function of hashes. Each finer level has half the cell size and is a function of
//! hashes and of the next coarser level over the same area, grown by a fixed [reach](refinement::Refinement::reach).
//! Any window of any level therefore has the same bits, whichever windows were computed before, and rivers keep their
//! course, area and fall through all levels.
//!
//! Related work: J.-D. Génevaux et al., "Terrain generation using procedural models based on hydrology" (2013); M.
//! Gaillard et al., "Dendry: a procedural model for dendritic patterns" (2019); H. Schott et al., "Terrain
//! amplification using multi-scale erosion" (2024).

mod alluvium;
mod banks;
mod carve;
mod channels;
mod children;
pub mod coarse;
mod coarsest;
pub mod continents;
mod creep;
mod detail;
mod distances;
mod drainage;
#[doc(hidden)]
pub mod drawn_ridges;
pub mod drawn_rivers;
mod drowned;
mod floods;
mod geography;
pub mod given;
pub(crate) mod gradient_noise;
mod growth;
mod growth_row;
pub(crate) mod hash;
mod lake_shores;
mod lakes;
mod law;
pub mod level;
mod links;
#[doc(hidden)]
pub mod lowered;
mod mouths;
mod nearest;
mod passages;
mod refine;
pub mod refinement;
mod ridges;
mod rock;
mod routes;
#[doc(hidden)]
pub mod schedule;
mod scree;
mod shores;
mod stencil;
mod straighten;
pub mod surface;
mod valley;

#[cfg(test)]
mod tests;
