//! A rendered picture.

use orogen::jobs::render::RenderJob;
use orogen::render::camera::View;
use orogen::render::scene::{Colors, Edge};
use orogen::{Result, WorldSpec};

use super::command_line::CommandLine;
use super::layer::ending;
use super::map::palette;
use super::samples::Samples;
use super::work::{Work, lines};
use crate::preview::region::Region;

/// Colors of the ground: the name on the command line, and the key of the name.
pub const COLORS: [(Colors, &str, &str); 5] = [
    (Colors::Natural, "natural", "export.ground_natural"),
    (Colors::Desert, "desert", "export.ground_desert"),
    (Colors::Surfaces, "surfaces", "export.color_surfaces"),
    (Colors::Map, "map", "export.ground_map"),
    (Colors::Clay, "clay", "export.ground_clay"),
];

/// What is beyond the edge of the land, likewise.
pub const EDGES: [(Edge, &str, &str); 2] =
    [(Edge::Cut, "cut", "export.edge_cut"), (Edge::Haze, "haze", "export.edge_haze")];

/// The choices of a rendered picture.
#[derive(Debug, Clone)]
pub struct RenderExport {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Samples of the land along its longer side; `None` for the world's own cell.
    pub samples: Option<usize>,
    /// The camera: degrees clockwise from north, and degrees above the horizon.
    pub camera: [f64; 2],
    /// Distance of the camera from the middle of the land in metres; all of it is shown if `None`.
    pub distance: Option<f64>,
    /// Angle of view along the longer side, in degrees.
    pub fov: f64,
    /// The sun: degrees clockwise from north, and degrees above the horizon.
    pub sun: [f64; 2],
    /// Density of the haze.
    pub haze: f64,
    /// Vertical exaggeration.
    pub exaggeration: f64,
    /// What is beyond the edge of the land.
    pub edge: Option<Edge>,
    /// Colors of the ground.
    pub colors: Colors,
    /// The palette of [`Colors::Map`], by name.
    pub palette: Option<&'static str>,
    /// Whether its colors are not mixed.
    pub nearest_color: bool,
    /// The heights at its ends.
    pub range: Option<[f64; 2]>,
    /// Whether the picture has a color bar of them.
    pub color_bar: bool,
    /// Height of the snow line in metres.
    pub snow_line: Option<f64>,
    /// Samples of a pixel.
    pub rays: u32,
}

impl Default for RenderExport {
    fn default() -> RenderExport {
        let job = RenderJob::default();
        let camera = match job.view {
            View::Around { azimuth, elevation, .. } => [azimuth, elevation],
            View::At { .. } => [200.0, 24.0],
        };
        RenderExport {
            size: job.size,
            samples: None,
            camera,
            distance: None,
            fov: job.fov,
            sun: job.sun,
            haze: job.haze,
            exaggeration: job.exaggeration,
            edge: job.edge,
            colors: job.colors,
            palette: None,
            nearest_color: false,
            range: None,
            color_bar: false,
            snow_line: job.snow_line,
            rays: job.samples,
        }
    }
}

impl RenderExport {
    /// Other colors; only those of the map have a palette.
    pub fn set_colors(&mut self, colors: Colors) {
        self.colors = colors;
        if colors != Colors::Map {
            (self.palette, self.nearest_color, self.range, self.color_bar) = (None, false, None, false);
        }
    }

    fn job(&self) -> Result<RenderJob> {
        let mut job = RenderJob::default();
        job.size = self.size;
        let [azimuth, elevation] = self.camera;
        job.view = View::Around { azimuth, elevation, distance: self.distance };
        job.fov = self.fov;
        job.sun = self.sun;
        job.haze = self.haze;
        job.exaggeration = self.exaggeration;
        job.edge = self.edge;
        job.colors = self.colors;
        job.palette = palette(self.palette, self.nearest_color);
        job.range = self.range;
        job.color_bar = self.color_bar;
        job.snow_line = self.snow_line;
        job.samples = self.rays;
        job.check()?;
        Ok(job)
    }

    /// Adds the options of `orogen render`.
    pub fn words(&self, region: Region, world: &WorldSpec, line: &mut CommandLine) {
        let own = RenderExport::default();
        let pair = |[a, b]: [f64; 2]| format!("{a},{b}");
        let [width, height] = self.size;
        line.differing("size", format!("{width}x{height}"), &format!("{}x{}", own.size[0], own.size[1]));
        match self.distance {
            Some(distance) => line.option("camera", format!("{},{distance}", pair(self.camera))),
            None => line.differing("camera", pair(self.camera), &pair(own.camera)),
        }
        line.differing("fov", self.fov, &own.fov);
        line.differing("sun", pair(self.sun), &pair(own.sun));
        line.differing("haze", self.haze, &own.haze);
        line.differing("exaggeration", self.exaggeration, &own.exaggeration);
        if let Some((_, name, _)) = EDGES.iter().find(|(edge, ..)| Some(*edge) == self.edge) {
            line.option("edge", name);
        }
        if let Some((_, name, _)) = COLORS.iter().find(|(colors, ..)| *colors == self.colors) {
            line.differing("color", *name, &"natural");
        }
        if let Some(palette) = self.palette {
            line.option("palette", palette);
            if self.nearest_color {
                line.flag("nearest-color");
            }
        }
        if let Some(ends) = self.range {
            line.option("range", pair(ends));
        }
        if self.color_bar {
            line.flag("color-bar");
        }
        if let Some(metres) = self.snow_line {
            line.option("snow-line", metres);
        }
        line.differing("samples", self.rays, &own.rays);
        Samples::of(region, self.samples, world).unsized_for(world, line);
    }

    /// Makes the file. Returns a description.
    ///
    /// # Errors
    /// If options are not valid, or the export fails; then there is no file, or that which was there.
    pub fn make(&self, mut work: Work, region: Region) -> Result<String> {
        if !work.path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            return Err(ending(&work.path, "a render", &["png"]));
        }
        let job = self.job()?;
        job.prepare(&mut work.recipe)?;
        let world = work.open()?;
        let window = Samples::of(region, self.samples, &work.recipe.world).window(&world)?;
        let rendering = job.with_window(window).to_file(&world, &work.output()?, work.progress)?;
        let lifted = rendering.lifted();
        let lifted = lifted.map(|metres| format!("the camera was below the ground and was raised by {metres:.0} m"));
        Ok(lines(&rendering.words(), rendering.warnings.iter().cloned().chain(lifted)))
    }
}
