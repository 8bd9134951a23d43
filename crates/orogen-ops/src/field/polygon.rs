//! Areas drawn on the map.

use super::positions::{SEGMENT_COST, each, smoothstep};
use crate::declare::{AreaFile, AreaPoints, OutlineOptions};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::polylines::segments::Segments;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// Areas drawn on the map, such as lakes, forests or mountains: a mask of them, the distance to their boundary, and
    /// its height.
    ///
    /// The boundaries are rings of `points` in metres of the world, with x to the east and y to the south, or those of
    /// a `file`. `points = [[x, y], ...]` is one ring, `points = [[[x, y], ...], [[x, y], ...]]` are several; a third
    /// number of each point is the height of the boundary there. The last point is joined to the first. What is inside
    /// follows from the even-odd rule over all rings: a ring within a ring is a hole, a third one an island in it.
    /// Where two areas overlap, their common part is outside.
    ///
    /// Files: SVG (.svg), GeoJSON (.geojson, .json) and GeoPackage (.gpkg), as for `path`. Of SVG the elements `path`,
    /// `polygon`, `rect`, `circle` and `ellipse` are read, whatever their fill; of GeoJSON and GeoPackage `Polygon` and
    /// `MultiPolygon`. For rings that touch, such as those of neighboring countries, the boundary is also where they
    /// touch.
    ///
    /// With `smooth` each ring is a curve through its points: a centripetal Catmull-Rom spline. Curves become straight
    /// segments that keep within `tolerance`; a drawing that would have more than 1 048 576 of them gets a larger
    /// tolerance. Time per sample depends on the segments nearby, not on their total number.
    pub struct Polygon = "polygon", field, revision 1;
    params {
        /// Corners of one ring or of several, at most 100 000.
        points: AreaPoints = AreaPoints::default(), unit "m", range -1e9 to 1e9;
        /// Path of an SVG, GeoJSON or GeoPackage file with areas, in place of `points`. A relative path is resolved
        /// against the folder of the recipe.
        file: AreaFile = AreaFile::default();
        /// Metres per unit of the file, east and south.
        scale: [f64; 2] = [1.0, 1.0], range -1e6 to 1e6;
        /// Position of the file's origin: metres east, metres south.
        offset: [f64; 2] = [0.0, 0.0], unit "m", range -1e9 to 1e9;
        /// Whether each ring is a smooth curve through its points. Rings of a file that have curves stay as they are.
        smooth: bool = false;
        /// Maximum distance between a curve and the straight segments that replace it.
        tolerance: f64 = 0.1, unit "m", range 1e-3 to 1e6;
        /// Width of the transition of the layer `inside`, half of it on each side of the boundary. With 0 the edge is
        /// sharp.
        falloff: f64 = 0.0, unit "m", range 0.0 to 1e9;
    }
    layers {
        /// A mask: 1 inside, 0 outside. With a `falloff` it is 0.5 on the boundary.
        inside: height;
        /// Signed distance to the boundary: negative inside, positive outside.
        distance: height, unit "m";
        /// Height of the boundary at the nearest point; 0 if the points have no heights.
        height: height, unit "m";
    }
    check |polygon| match (polygon.points.is_empty(), polygon.file.0.is_empty()) {
        (true, true) => Err(("points", "`polygon` needs an area: write `points`, such as `points = [[0, 0], [500, 0], [250, 400]]`, or name an .svg, .geojson or .gpkg as `file`".to_string())),
        (false, false) => Err(("file", "`points` and `file` are both given; leave out one of them".to_string())),
        _ if polygon.scale.contains(&0.0) => Err(("scale", "`scale` must not be 0; it is metres per unit of the file".to_string())),
        _ => Ok(()),
    };
}

/// The layers by their index.
const INSIDE: usize = 0;
const DISTANCE: usize = 1;

impl Polygon {
    fn with_segments<T>(&self, read: impl FnOnce(&Segments) -> T) -> T {
        let Polygon { smooth, tolerance, scale, offset, .. } = *self;
        let options = OutlineOptions { smooth, closed: true, tolerance, scale, offset };
        self.points.with_segments(&self.file.0, options, read)
    }

    fn inside(&self, segments: &Segments, at: [f64; 2]) -> f64 {
        let is_inside = segments.is_inside(at);
        let nearest = match self.falloff > 0.0 {
            true => segments.nearest(at, 0.5 * self.falloff),
            false => None,
        };
        match nearest {
            Some(nearest) => smoothstep(0.5 - signed(nearest.distance(), is_inside) / self.falloff),
            None => f64::from(u8::from(is_inside)),
        }
    }
}

fn signed(distance: f64, is_inside: bool) -> f64 {
    if is_inside { -distance } else { distance }
}

impl Field for Polygon {
    fn eval_layer(&self, layer: usize, at: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        self.with_segments(|segments| {
            each(at, out, |x, y| {
                let at = [x, y];
                let nearest = || segments.nearest(at, f64::INFINITY);
                let value = match layer {
                    INSIDE => self.inside(segments, at),
                    // A world is not opened without its files. A plan that runs without a world has no values here.
                    DISTANCE => {
                        nearest().map_or(f64::NAN, |nearest| signed(nearest.distance(), segments.is_inside(at)))
                    }
                    _ => nearest().map_or(0.0, |nearest| nearest.height()),
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
        Lowering::Processor("outlines are searched in a tree of boxes")
    }
}
