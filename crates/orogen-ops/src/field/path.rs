//! Lines drawn on the map.

use super::positions::{SEGMENT_COST, each, smoothstep};
use crate::declare::{LineFile, LinePoints, OutlineOptions};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::polylines::segments::Segments;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// Lines drawn on the map, such as rivers, roads or ridges: the distance to them, the position along them, their
    /// height, and a mask.
    ///
    /// The lines are `points` in metres of the world, with x to the east and y to the south, or those of a `file`.
    /// `points = [[x, y], ...]` is one line, `points = [[[x, y], ...], [[x, y], ...]]` are several; a third number of
    /// each point is the height of the line there. Each layer is that of the nearest point of all lines; of several at
    /// the same distance it is the first.
    ///
    /// Files: SVG (.svg), GeoJSON (.geojson, .json) and GeoPackage (.gpkg). Of SVG the elements `path`, `polyline` and
    /// `line` are read, with the transforms of elements and groups; `use`, style sheets and units other than px are
    /// not. Coordinates are in the user space of the document (that of its `viewBox`), with y to the south. Of GeoJSON
    /// and GeoPackage `LineString` and `MultiLineString` are read, also in features and collections; properties are
    /// ignored, and the third coordinate is the height. If several layers of a GeoPackage have lines, the name of one
    /// follows that of the file: `map.gpkg|layername=roads`. In both y points north and is negated. A position in the
    /// file is multiplied by `scale`, then `offset` is added.
    ///
    /// With `smooth` the line is a curve through the points: a centripetal Catmull-Rom spline (Yuksel, Schaefer and
    /// Keyser 2011). Curves become straight segments that keep within `tolerance`; a drawing that would have more than
    /// 1 048 576 of them gets a larger tolerance. Heights are linear along the line from point to point. Time per
    /// sample depends on the segments nearby, not on their total number.
    pub struct Path = "path", field, revision 1;
    params {
        /// Points of one line or of several, at most 100 000.
        points: LinePoints = LinePoints::default(), unit "m", range -1e9 to 1e9;
        /// Path of an SVG, GeoJSON or GeoPackage file with lines, in place of `points`. A relative path is resolved
        /// against the folder of the recipe.
        file: LineFile = LineFile::default();
        /// Metres per unit of the file, east and south.
        scale: [f64; 2] = [1.0, 1.0], range -1e6 to 1e6;
        /// Position of the file's origin: metres east, metres south.
        offset: [f64; 2] = [0.0, 0.0], unit "m", range -1e9 to 1e9;
        /// Whether each line is a smooth curve through its points. Lines of a file that have curves stay as they are.
        smooth: bool = false;
        /// Whether each line returns to its first point.
        closed: bool = false;
        /// Maximum distance between a curve and the straight segments that replace it.
        tolerance: f64 = 0.1, unit "m", range 1e-3 to 1e6;
        /// Width of the line in the layer `inside`.
        width: f64 = 10.0, unit "m", range 0.0 to 1e9;
        /// Distance from the sides of the line over which the layer `inside` falls to 0.
        falloff: f64 = 10.0, unit "m", range 0.0 to 1e9;
    }
    layers {
        /// Distance to the line. The width does not matter.
        distance: height, unit "m";
        /// Position along the line of the nearest point: 0 at its start, 1 at its end.
        position: height;
        /// Distance along the line from its start to the nearest point (chainage).
        chainage: height, unit "m";
        /// Height of the line at the nearest point; 0 if the points have no heights.
        height: height, unit "m";
        /// A mask: 1 up to half the `width` from the line, falling smoothly to 0 over `falloff`.
        inside: height;
    }
    check |path| match (path.points.is_empty(), path.file.0.is_empty()) {
        (true, true) => Err(("points", "`path` needs a line: write `points`, such as `points = [[0, 0], [500, 200]]`, or name an .svg, .geojson or .gpkg as `file`".to_string())),
        (false, false) => Err(("file", "`points` and `file` are both given; leave out one of them".to_string())),
        _ if path.scale.contains(&0.0) => Err(("scale", "`scale` must not be 0; it is metres per unit of the file".to_string())),
        _ => Ok(()),
    };
}

/// The layers by their index.
const DISTANCE: usize = 0;
const POSITION: usize = 1;
const CHAINAGE: usize = 2;
const HEIGHT: usize = 3;

impl Path {
    fn with_segments<T>(&self, read: impl FnOnce(&Segments) -> T) -> T {
        let Path { smooth, closed, tolerance, scale, offset, .. } = *self;
        self.points.with_segments(&self.file.0, OutlineOptions { smooth, closed, tolerance, scale, offset }, read)
    }

    fn inside(&self, segments: &Segments, at: [f64; 2]) -> f64 {
        let half = 0.5 * self.width;
        let Some(nearest) = segments.nearest(at, half + self.falloff) else { return 0.0 };
        let beyond = nearest.distance() - half;
        match beyond <= 0.0 {
            true => 1.0,
            false if self.falloff > 0.0 => smoothstep(1.0 - beyond / self.falloff),
            false => 0.0,
        }
    }
}

impl Field for Path {
    fn eval_layer(&self, layer: usize, at: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        self.with_segments(|segments| {
            each(at, out, |x, y| {
                let nearest = || segments.nearest([x, y], f64::INFINITY);
                let value = match layer {
                    // A world is not opened without its files. A plan that runs without a world has no values here.
                    DISTANCE => nearest().map_or(f64::NAN, |nearest| nearest.distance()),
                    POSITION => nearest().map_or(0.0, |nearest| nearest.position()),
                    CHAINAGE => nearest().map_or(0.0, |nearest| nearest.chainage()),
                    HEIGHT => nearest().map_or(0.0, |nearest| nearest.height()),
                    _ => self.inside(segments, [x, y]),
                };
                value as f32
            });
        });
        Ok(())
    }

    fn cost(&self) -> f64 {
        (SEGMENT_COST * self.with_segments(Segments::visits)).max(300.0)
    }

    fn cost_in_rows(&self) -> f64 {
        self.cost()
    }

    fn memory(&self) -> u64 {
        self.with_segments(Segments::memory) + self.file.0.drawing().map_or(0, |drawing| drawing.memory())
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("lines are searched in a tree of boxes")
    }
}
