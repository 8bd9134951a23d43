//! Meandering rivers and their floodplains.

use super::positions::{SEGMENT_COST, each};
use crate::declare::{LineFile, LinePoints, OutlineOptions};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::meanders::{Floodplain, Meanders as Law};
use orogen_grid::polylines::segments::Segments;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;
use std::sync::Arc;

op! {
    /// Rivers that meander over their floodplain: heights in metres to be added to the floor of a valley, with the
    /// channel, oxbow lakes, scroll bars and natural levees, exact at any position.
    ///
    /// The lines of `points` or of a `file`, as for `path`, are the first courses, from the source to the mouth; each
    /// is a river of its own, and its ends stay where they are. A river moves by the curvature of its bends and, more,
    /// by that upstream, whose effect falls by a factor of e over `depth` / (2 `friction`) (Howard and Knutson 1984).
    /// Where a bend comes back to itself the river cuts through the neck, and the bend becomes an oxbow lake, which
    /// fills from its ends. Where the river moved on, it leaves scroll bars.
    ///
    /// The bed is `depth` below the banks everywhere. For a bed that falls along the river, make the floor of the
    /// valley fall with `position`.
    pub struct Meanders = "meanders", field, revision 1;
    params {
        /// Points of one river or of several, from the source to the mouth, at most 100 000.
        points: LinePoints = LinePoints::default(), unit "m", range -1e9 to 1e9;
        /// Path of an SVG, GeoJSON or GeoPackage file with lines, in place of `points`. A relative path is resolved
        /// against the folder of the recipe.
        file: LineFile = LineFile::default();
        /// Metres per unit of the file, east and south.
        scale: [f64; 2] = [1.0, 1.0], range -1e6 to 1e6;
        /// Position of the file's origin: metres east, metres south.
        offset: [f64; 2] = [0.0, 0.0], unit "m", range -1e9 to 1e9;
        /// Seed of the first bends, hashed with the world's seed.
        seed: u64 = 0;
        /// Width of the channel.
        width: f64 = 60.0, unit "m", range 0.1 to 1e5;
        /// Depth of the channel. Deeper rivers have longer bends.
        depth: f64 = 3.0, unit "m", range 0.01 to 1e4;
        /// Friction of the bed: the square of the shear velocity over that of the flow. Rough beds make shorter bends.
        friction: f64 = 0.015, range 1e-4 to 1.0;
        /// How far the river has moved: the distance, in widths, by which a bend with a radius of one width would have
        /// moved without the effect of other bends. At 0 there are only its first small bends, at 30 wide ones, from
        /// about 50 on also oxbow lakes.
        migration: f64 = 200.0, range 0.0 to 1000.0;
        /// Width of the floor of the valley, around the first course. The river does not leave it. 0 stands for a plain
        /// without sides.
        valley: f64 = 0.0, unit "m", range 0.0 to 1e9;
    }
    layers {
        /// Height over the floor of the valley: below 0 in the channel and in oxbow lakes.
        height: height, unit "m";
        /// A mask of the channel: 1 in it, falling to 0 over a tenth of its width.
        inside: height;
        /// A mask of the water of oxbow lakes.
        oxbow: height;
        /// Time since the river was here, as a share of the whole time: 0 in the channel, 1 where it never was.
        age: height;
        /// Distance to the middle of the channel.
        distance: height, unit "m";
        /// Position along the river of the nearest point: 0 at its source, 1 at its mouth.
        position: height;
    }
    check |op| match (op.points.is_empty(), op.file.0.is_empty()) {
        (true, true) => Err(("points", "`meanders` needs a river: write `points`, such as `points = [[0, 0], [5000, 200]]`, or name an .svg, .geojson or .gpkg as `file`".to_string())),
        (false, false) => Err(("file", "`points` and `file` are both given; leave out one of them".to_string())),
        _ if op.scale.contains(&0.0) => Err(("scale", "`scale` must not be 0; it is metres per unit of the file".to_string())),
        _ => Ok(()),
    };
}

/// The layers by their index.
const HEIGHT: usize = 0;
const INSIDE: usize = 1;
const OXBOW: usize = 2;
const AGE: usize = 3;
const DISTANCE: usize = 4;

/// Distance between a drawn curve and the first course, in widths.
const TOLERANCE: f64 = 0.05;

impl Meanders {
    fn options(&self) -> OutlineOptions {
        let Meanders { scale, offset, width, .. } = *self;
        OutlineOptions { smooth: true, closed: false, tolerance: TOLERANCE * width, scale, offset }
    }

    fn law(&self) -> Law {
        Law::default()
            .with_width(self.width)
            .with_depth(self.depth)
            .with_friction(self.friction)
            .with_migration(self.migration)
            .with_valley(self.valley)
    }

    fn floodplain(&self, seed: u64) -> Arc<Floodplain> {
        self.points.floodplain(&self.file.0, self.options(), self.law().with_seed(seed))
    }
}

impl Field for Meanders {
    fn eval_layer(
        &self,
        layer: usize,
        at: &Points,
        _: &Inputs,
        world_params: &WorldParams,
        out: &mut [f32],
    ) -> Result<()> {
        let floodplain = self.floodplain(world_params.seed_of(self.seed));
        each(at, out, |x, y| {
            if !(x.is_finite() && y.is_finite()) {
                return f32::NAN;
            }
            let nearest = || floodplain.nearest([x, y]);
            let value = match layer {
                HEIGHT => floodplain.at([x, y]).height,
                INSIDE => floodplain.at([x, y]).inside,
                OXBOW => floodplain.at([x, y]).oxbow,
                AGE => floodplain.at([x, y]).age,
                // A world is not opened without its files. A plan that runs without a world has no values here.
                DISTANCE => nearest().map_or(f64::NAN, |nearest| nearest.distance()),
                _ => nearest().map_or(0.0, |nearest| nearest.position()),
            };
            value as f32
        });
        Ok(())
    }

    fn cost(&self) -> f64 {
        // Most positions are near few of the earlier courses.
        3000.0 + 8.0 * SEGMENT_COST
    }

    fn cost_in_rows(&self) -> f64 {
        self.cost()
    }

    fn memory(&self) -> u64 {
        let length = self.points.with_segments(&self.file.0, self.options(), Segments::length);
        self.law().memory(length) + self.file.0.drawing().map_or(0, |drawing| drawing.memory())
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("earlier courses are searched in trees of boxes")
    }
}
