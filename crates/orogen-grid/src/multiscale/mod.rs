//! Eroded terrain without bounds, level by level.
//!
//! The terrain is a pyramid of lattices. A node of a level has a position in its cell, a height, a drainage area and a receiver. The coarsest level
//! is a function of hashes. Each finer level, at half the cell, is a function of the level above over the same area grown by a fixed
//! [reach](continents::Continents::reach), and of hashes. Any window of any level therefore has the same bits, whichever windows were computed
//! before, and rivers keep their course, area and fall through all levels.
//!
//! Related work: J.-D. Génevaux et al., "Terrain generation using procedural models based on hydrology" (2013); M. Gaillard et al., "Dendry: a
//! procedural model for dendritic patterns" (2019); H. Schott et al., "Terrain amplification using multi-scale erosion" (2024).

pub mod level;
pub mod continents;
mod hash;
mod gradient_noise;
mod stencil;
mod distances;
mod drainage;
mod law;
mod geography;
mod routes;
mod coarsest;
mod children;
mod links;
mod shores;
mod carve;
mod straighten;
mod growth;
mod creep;
mod refine;
pub mod surface;

#[cfg(test)]
mod tests;
