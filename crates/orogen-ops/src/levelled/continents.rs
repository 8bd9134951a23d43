//! Continents with rivers, without bounds.

use super::drained::Drained;
use super::drained_op::drained_op;
use crate::declare::{LineFile, LinePoints, RidgeFile};
use orogen_grid::multiscale::continents::Continents as Land;
use orogen_grid::multiscale::drawn_ridges::DrawnRidges;
use orogen_grid::multiscale::drawn_rivers::DrawnRivers;
use std::sync::Arc;

drained_op! {
    /// Eroded land without bounds: continents with ranges, plains and plateaus, coasts, inland basins with lakes, and
    /// rivers from their sources to the sea.
    ///
    /// The land is made level by level. The coarsest level places sea, uplift and the courses of the largest rivers by
    /// noise. Each finer level has half the cell: rivers keep their course, area and fall, and new branches grow
    /// between them, with slopes by the steady state of the stream power law, S = (U/K) A^-m, limited on hillslopes. A
    /// window of a level depends on the coarser level around it only, so any window is made independently, a river of
    /// 4000 km runs through tiles that are made independently, and a larger cell shows the same land coarsely. Sea
    /// level is at 0.
    ///
    /// Related: hydrology-based terrain (Génevaux and others 2013), Dendry (Gaillard and others 2019), multi-scale
    /// terrain amplification (Schott and others 2024).
    pub struct Continents = "continents", levelled, revision 6;
    inputs {
        /// Distance to the shore in metres, positive on land, in place of the op's own continents. Lakes and rivers
        /// keep their own water; rivers end in its sea or, where a coarse level saw a sea that is not there, in a lake.
        /// Where it is NaN, the op's own is used.
        shore: optional,
        /// Uplift over erodibility in place of the op's own ranges and plains: about 1.5 in high mountains, 0.5 in
        /// hills, 0.1 in plains. Where it is NaN, the op's own is used.
        uplift: optional,
        /// Factor of the stable slope of hillsides, greater where rock is harder. Default: 1.
        stability_factor: optional,
        /// Factor of the creep of soil, up to 1.25. Default: 1.
        creep_factor: optional,
        /// Factor of the width of valley floors. Default: 1.
        floor_factor: optional,
        /// Factor of the rain: `flow` and the slopes of rivers follow the discharge, which grows with the rain.
        /// Default: 1.
        rain: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Cell of the finest level of valleys.
        cell: f64 = 60.0, unit "m", range 1e-2 to 1e4;
        /// Number of times the coarsest cell is halved. Continents and ranges are placed at the coarsest cell: 122.88
        /// km by default.
        halvings: u32 = 11, range 1 to 24;
        /// Share of land, about.
        land: f64 = 0.37, range 0.05 to 0.95;
        /// Factor of the uplift, and so of heights and slopes.
        relief: f64 = 1.0, range 0.01 to 10.0;
        /// Distance over which soil creep rounds hillsides at `cell`, in cells. Detail levels have creep, too, unless
        /// it is 0.
        creep: f64 = 1.0, range 0.0 to 5.0;
        /// Factor of the variation of the rock, which each level adds to: 0 makes even slopes and straight side
        /// valleys.
        variation: f64 = 1.0, range 0.0 to 4.0;
        /// Factor of the size of continents and ranges.
        size: f64 = 1.0, range 0.01 to 100.0;
        /// Share of the suitable inland basins that hold a lake without an outlet. All other land drains to the sea.
        basins: f64 = 0.8, range 0.0 to 1.0;
        /// Drainage area from which on there is a river, for `width` and `depth`.
        stream: f64 = 1e6, unit "m^2", range 0.0 to 1e15;
        /// Runoff from the ground: a river with discharge Q (m^3/s) is 5 Q^0.5 m wide and 0.3 Q^0.4 m deep (Leopold and
        /// Maddock 1953).
        runoff: f64 = 0.5, unit "m/yr", range 0.0 to 1000.0;
        /// Number of further halvings, below `cell`: 6 make levels from 30 m to 0.94 m. Their slopes are those of the
        /// finest valleys, with gullies on them, rough rock where they are steep, and beds and banks of rivers that are
        /// wider than a sample. Finer samples are interpolated.
        details: u32 = 0, range 0 to 10;
        /// Number of detail levels that read `shore`, from the coarsest one: their shore is the given one within a
        /// cell. Finer levels take over the shore of the level above and make it irregular. Use it where `shore` has
        /// detail below `cell`, for example a drawn coast.
        shore_details: u32 = 0, range 0 to 10;
        /// Frequency of lakes with an outlet along rivers, from none (0) to many (1). They are frequent in
        /// regions of about 500 km, as where ice was, more often in mountains, and rare elsewhere and in plains. They
        /// begin at cells of 5 km to 400 m: levels that begin with a smaller cell have none.
        lakes: f64 = 0.0, range 0.0 to 1.0;
        /// Rivers drawn on the map, each a line from its source to its mouth, as in `path`. Every level leads them
        /// through exactly the cells that their lines cross. They end in the sea or on another river. A third number of
        /// the points is the height of the bed, which should fall; without it rivers rise from their mouths by the law
        /// of slopes, with uplift over erodibility of 0.4. Their drainage area is that of their length (Hack 1957) and
        /// of their tributaries, or of the land, if it is larger.
        rivers: LinePoints = LinePoints::default(), unit "m", range -1e9 to 1e9;
        /// Path of an SVG, GeoJSON or GeoPackage file with further rivers, as `file` of `path`, in metres of the world.
        rivers_file: LineFile = LineFile::default();
        /// Ridges drawn on the map, each a line of points with a third number, the height of the crest. Every level has
        /// nodes on them with these heights, within 1 %: no river crosses a ridge, and the land beside it rises to it.
        /// Ridges lie on land, above the rivers beside them, and a few coarsest cells apart. A very short line is a
        /// summit.
        ridges: LinePoints = LinePoints::default(), unit "m", range -1e9 to 1e9;
        /// Path of an SVG, GeoJSON or GeoPackage file with further ridges and with summits, which are points, in metres
        /// of the world. Their heights are the third coordinates or, without them, the number `height` or `elevation`
        /// of the feature, in metres (in SVG `data-height`; circles are summits).
        ridges_file: RidgeFile = RidgeFile::default();
        /// Whether drawn rivers and ridges are smooth curves through their points. Lines of a file that have curves
        /// stay as they are.
        smooth: bool = false;
    }
    layers {
        /// Height of the node in the cell south-east of the sample; the water level of water. It falls from each node
        /// to its receiver. At `cell` nodes are at the samples; on other levels the other layers are interpolated
        /// between them, or are those of the nearest one.
        node_height: label, unit "m";
        /// Drainage area of this node, including its cell.
        node_flow: label, unit "m^2";
        /// Flow direction of this node, to the node in the next cell; 8 in water, 16 more than the direction in lakes
        /// with an outlet.
        node_receiver: label;
        /// Distance of this node east of the sample.
        node_east: label, unit "m";
        /// Distance of this node south of the sample.
        node_south: label, unit "m";
    }
}

impl Continents {
    /// The land with what only this op has.
    fn completed(&self, land: Drained) -> Drained {
        let continents = Land::default().with_land(self.land).with_size(self.size).with_basins(self.basins);
        let refinement = land
            .refinement
            .with_drawn(!(self.rivers.is_empty() && self.rivers_file.0.is_empty()))
            .with_ridges(self.has_ridges())
            .with_shore_details(self.shore_details as usize);
        Drained { continents: Some(continents), refinement, ..land }
    }

    fn has_ridges(&self) -> bool {
        !(self.ridges.is_empty() && self.ridges_file.0.is_empty())
    }

    /// The drawn ridges and summits.
    fn drawn_ridges(&self) -> Option<Arc<DrawnRidges>> {
        self.has_ridges().then(|| self.ridges.drawn_ridges(&self.ridges_file.0, self.smooth))
    }

    /// The drawn rivers.
    fn drawn_rivers(&self) -> Option<Arc<DrawnRivers>> {
        let is_drawn = !(self.rivers.is_empty() && self.rivers_file.0.is_empty());
        is_drawn.then(|| self.rivers.drawn_rivers(&self.rivers_file.0, self.smooth, self.cell))
    }
}
