//! Coarse land with ever smaller valleys.

use super::drained::Drained;
use super::drained_op::drained_op;
use orogen_grid::multiscale::drawn_ridges::DrawnRidges;
use orogen_grid::multiscale::drawn_rivers::DrawnRivers;
use std::sync::Arc;

drained_op! {
    /// Coarse land refined level by level: its rivers keep their course, area and fall, and ever smaller valleys and
    /// slopes grow between them.
    ///
    /// The heights and drainage areas of the coarsest level are those of the source, usually a `stream-power` solved
    /// over the whole world at a cell of about a kilometre, which takes a moment. Each finer level has half the cell.
    /// Rivers are led through it, branches grow up from them, and slopes follow the steady state of the stream power
    /// law, S = (U/K) A^-m, limited on hillslopes. A window of a level depends on the coarser level around it only, so
    /// any window is made independently, and a larger cell shows the same land coarsely. Where the coarse land has no
    /// receiver, in depressions and beyond its border, there is standing water. Ground below sea level is refined like
    /// land, unless `sea` is set.
    ///
    /// Related: terrain amplification (Schott and others 2024), hydrology-based terrain (Génevaux and others 2013).
    pub struct Amplify = "amplify", levelled, revision 5;
    inputs {
        /// Heights of the coarse land without depressions. It is read at the coarsest cell, `cell` times 2 to the power
        /// of `halvings`: solve it there.
        source: required,
        /// Drainage area of the coarse land in m^2.
        flow: required,
        /// Flow direction of the coarse land, clockwise from east (0) to north-east (7); 8 where it has no receiver.
        /// Default: the steepest descent.
        receiver: optional,
        /// Uplift over erodibility: about 1.5 in high mountains, 0.5 in hills, 0.1 in plains. Default: 1.
        uplift: optional,
        /// Factor of the stable slope of hillsides, greater where rock is harder. Default: 1.
        stability_factor: optional,
        /// Factor of the creep of soil, up to 1.25. Default: 1.
        creep_factor: optional,
        /// Factor of the width of valley floors. Default: 1.
        floor_factor: optional,
        /// Factor of the rain: `flow` and the slopes of rivers follow the discharge, which grows with the rain. The
        /// `flow` of the source should contain it. Default: 1.
        rain: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Cell of the finest level of valleys.
        cell: f64 = 60.0, unit "m", range 1e-2 to 1e4;
        /// Number of times the coarsest cell is halved.
        halvings: u32 = 4, range 1 to 24;
        /// Factor of the uplift, and so of the slopes that grow.
        relief: f64 = 1.0, range 0.01 to 10.0;
        /// Distance over which soil creep rounds hillsides at `cell`, in cells. Detail levels have creep, too, unless
        /// it is 0.
        creep: f64 = 1.0, range 0.0 to 5.0;
        /// Factor of the variation of the rock, which each level adds to: 0 makes even slopes and straight side
        /// valleys.
        variation: f64 = 1.0, range 0.0 to 4.0;
        /// Drainage area from which on there is a river, for `width` and `depth`.
        stream: f64 = 1e6, unit "m^2", range 0.0 to 1e15;
        /// Runoff from the ground: a river with discharge Q (m^3/s) is 5 Q^0.5 m wide and 0.3 Q^0.4 m deep (Leopold and
        /// Maddock 1953).
        runoff: f64 = 0.5, unit "m/yr", range 0.0 to 1000.0;
        /// How far the rivers of the source are displaced within its cells: 1 places them at random, so that the grid
        /// does not show; 0 places them in the source's valleys, by 3 x 3 heights around each sample, which suits real
        /// land.
        jitter: f64 = 1.0, range 0.0 to 1.0;
        /// Number of further halvings, below `cell`. Their slopes are those of the finest valleys, with gullies on
        /// them, rough rock where they are steep, and beds and banks of rivers that are wider than a sample. Finer
        /// samples are interpolated.
        details: u32 = 0, range 0 to 10;
        /// Frequency of lakes with an outlet along rivers, from none (0) to many (1). They are frequent in
        /// regions of about 500 km, as where ice was, more often in mountains, and rare elsewhere and in plains. They
        /// begin at cells of 5 km to 400 m: levels that begin with a smaller cell have none.
        lakes: f64 = 0.0, range 0.0 to 1.0;
        /// Whether there is a sea where the source is at or below the world's sea level. It is as deep as the source,
        /// up to 4944 m, and rivers end at the shore of this sea.
        sea: bool = false;
    }
}

impl Amplify {
    /// The land with what only this op has.
    fn completed(&self, land: Drained) -> Drained {
        Drained { refinement: land.refinement.with_jitter(self.jitter).with_sea(self.sea), ..land }
    }

    /// The ridges are those of the source.
    fn drawn_ridges(&self) -> Option<Arc<DrawnRidges>> {
        None
    }

    /// The rivers are those of the source.
    fn drawn_rivers(&self) -> Option<Arc<DrawnRivers>> {
        None
    }
}
