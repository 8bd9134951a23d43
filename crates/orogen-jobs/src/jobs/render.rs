//! A rendered picture as one job.

use std::io::{self, Write};
use std::ops::{Range, RangeInclusive};
use std::sync::{Arc, OnceLock};

use super::color_bar::ColorBar;
use super::finite;
use crate::export::derived::layer::Derived;
use crate::export::derived::rows::Rows;
use crate::export::derived::{albedo, list, roughness};
use crate::options::Options;
use orogen_engine::budget::Reservation;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::words::number;
use orogen_io::file::cancellable::CancellableWriter;
use orogen_io::file::{self, Output};
use orogen_io::format::levels::{NO_SAMPLES, extremes};
use orogen_io::format::notes::SOFTWARE;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::palette::palette::Palette;
use orogen_output::proportions;
use orogen_output::render::camera::{Camera, CameraSpec, View};
use orogen_output::render::device::{Painted, RenderDevice};
use orogen_output::render::relief::Land;
use orogen_output::render::scene::{Colors, Edge, Scene, Style};
use orogen_output::render::skylight::SkylightDevice;

/// Angles of view along the longer side, in degrees.
pub const FOV: RangeInclusive<f64> = 1.0..=150.0;

/// Vertical exaggerations.
pub const EXAGGERATION: RangeInclusive<f64> = 0.01..=100.0;

/// Densities of the haze.
pub const HAZE: RangeInclusive<f64> = 0.0..=100.0;

/// Elevations of the sun in degrees: below them the picture would be black.
pub const SUN: RangeInclusive<f64> = -6.0..=90.0;

/// Elevations of a camera around the land, in degrees.
pub const ELEVATION: RangeInclusive<f64> = 0.0..=90.0;

/// Numbers of samples per pixel.
pub const SAMPLES: RangeInclusive<u32> = 1..=256;

/// Maximum number of pixels along a side.
pub const MAX_SIDE: usize = 32_768;

/// A perspective picture of a world.
///
/// [`prepare`](RenderJob::prepare) a recipe, open its world, then write [to a file](RenderJob::to_file); or make the
/// [scene](RenderJob::scene), and paint pictures of it yourself.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RenderJob {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// The camera: by default slightly west of south, looking slightly down, at the distance that shows everything.
    pub view: View,
    /// Angle of view along the longer side, in degrees.
    pub fov: f64,
    /// The sun: degrees clockwise from north, and degrees above the horizon.
    pub sun: [f64; 2],
    /// Density of the haze: 0 is none, 1 is a clear day.
    pub haze: f64,
    /// Vertical exaggeration.
    pub exaggeration: f64,
    /// What is shown beyond the edge of the land; by default haze if most of the edge is sea, otherwise a cut.
    pub edge: Option<Edge>,
    /// Colors of the ground.
    pub colors: Colors,
    /// The palette of [`Colors::Map`]; by default that of the relief map.
    pub palette: Option<Palette>,
    /// The heights at the ends of the palette of [`Colors::Map`]; by default the lowest and the highest.
    pub range: Option<[f64; 2]>,
    /// Whether a color bar of [`Colors::Map`] is in the lower left corner.
    pub color_bar: bool,
    /// Height of the snow line in metres; by default chosen by the relief.
    pub snow_line: Option<f64>,
    /// Number of samples per pixel.
    pub samples: u32,
    /// The window; by default the whole world at its own cell, which must then be bounded.
    pub window: Option<Window>,
    /// The device that paints; by default the processor, which also paints what the device refuses.
    pub device: Option<Arc<dyn RenderDevice>>,
}

/// The view around the center of the land: azimuth and elevation in degrees, and the distance in metres, if it is
/// given.
///
/// # Errors
/// If there are other numbers, the elevation is not above the horizon, or the distance is not greater than 0.
pub fn around(camera: &[f64]) -> Result<View> {
    let refused = |message: String| Err(Error::new(ErrorKind::Request, message));
    let (azimuth, elevation, distance) = match *camera {
        [azimuth, elevation] => (azimuth, elevation, None),
        [azimuth, elevation, distance] => (azimuth, elevation, Some(distance)),
        _ => return refused("--camera must be AZIMUTH,ELEVATION[,DISTANCE], such as 200,24".into()),
    };
    if !(-90.0..=90.0).contains(&elevation) {
        return refused(format!(
            "the elevation of --camera must be from -90 to 90 degrees, not {elevation} (with --look, --camera is a \
             position)"
        ));
    }
    if elevation < 0.0 {
        return refused(format!(
            "the elevation of --camera must be above the horizon, not {} degrees below it",
            -elevation
        ));
    }
    match distance.filter(|distance| *distance <= 0.0) {
        Some(distance) => refused(format!("the distance of --camera must be greater than 0 m, not {distance}")),
        None => Ok(View::Around { azimuth, elevation, distance }),
    }
}

impl Default for RenderJob {
    fn default() -> RenderJob {
        let style = Style::default();
        RenderJob {
            size: [1920, 1080],
            view: View::Around { azimuth: 200.0, elevation: 24.0, distance: None },
            fov: 40.0,
            sun: style.sun,
            haze: style.haze,
            exaggeration: style.exaggeration,
            edge: style.edge,
            colors: style.colors,
            palette: None,
            range: None,
            color_bar: false,
            snow_line: style.snow_line,
            samples: style.samples,
            window: None,
            device: None,
        }
    }
}

/// Memory per sample of the land beside its layers, in bytes: the pyramid, slopes, bedding, and light twice while it is
/// computed.
const LAND: u64 = 120;

/// Layers that a picture uses if the recipe has them.
const LAYERS: [&str; 4] = [HEIGHT, "surface", "flow", "bedding"];

/// The layers that show surfaces.
const COVER: [&Derived; 2] = [&albedo::LAYER, &roughness::LAYER];

/// Approximate time for preparing a sample of the land, and for a ray of a pixel, in nanoseconds.
const PREPARING: f64 = 1600.0;
const RAY: f64 = 500.0;

impl RenderJob {
    /// The same over this window.
    #[must_use]
    pub fn with_window(self, window: Window) -> RenderJob {
        RenderJob { window: Some(window), ..self }
    }

    /// The same, painted by this device.
    #[must_use]
    pub fn with_device(self, device: Arc<dyn RenderDevice>) -> RenderJob {
        RenderJob { device: Some(device), ..self }
    }

    /// Checks all options.
    ///
    /// # Errors
    /// If a value is out of its range, or options contradict each other.
    pub fn check(&self) -> Result<()> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        let [width, height] = self.size;
        if width.min(height) == 0 || width.max(height) > MAX_SIDE {
            return refuse(format!(
                "a picture of {width} x {height} pixels is not possible; a side has 1 to {MAX_SIDE} pixels"
            ));
        }
        let mut numbers = vec![
            ("the angle of view in degrees", self.fov, FOV),
            ("the vertical exaggeration", self.exaggeration, EXAGGERATION),
            ("the haze", self.haze, HAZE),
            ("the elevation of the sun in degrees", self.sun[1], SUN),
            ("the number of samples per pixel", f64::from(self.samples), 1.0..=256.0),
        ];
        if let View::Around { elevation, distance, .. } = self.view {
            numbers.push(("the elevation of the camera in degrees", elevation, ELEVATION));
            if distance.is_some_and(|distance| distance.is_nan() || distance <= 0.0) {
                return refuse("the distance of the camera must be greater than 0 m".into());
            }
        }
        for (what, value, range) in numbers {
            if !range.contains(&value) {
                return refuse(format!("{what} must be from {} to {}, not {value}", range.start(), range.end()));
            }
        }
        if self.snow_line.is_some_and(|line| !line.is_finite()) {
            return refuse("the snow line must be a height in metres".into());
        }
        if self.palette.is_some() && self.colors != Colors::Map {
            return refuse("a palette applies to the colors of the map only".into());
        }
        if self.color_bar && self.colors != Colors::Map {
            return refuse("a color bar applies to the colors of the map only".into());
        }
        match self.range {
            Some(_) if self.colors != Colors::Map => {
                return refuse("the ends of a palette apply to the colors of the map only".into());
            }
            Some([low, high]) if !(low.is_finite() && high.is_finite() && low < high) => {
                return refuse("the ends of the palette must be two heights, the lower first".into());
            }
            _ => {}
        }
        Ok(())
    }

    /// Appends to a recipe the nodes that the picture needs; call it before the world is opened.
    ///
    /// # Errors
    /// If the recipe has no heights.
    pub fn prepare(&self, recipe: &mut Recipe) -> Result<()> {
        match self.colors {
            Colors::Surfaces => {
                COVER.iter().try_for_each(|layer| list::prepare(recipe, layer.name, &Options::default()))
            }
            _ => Ok(()),
        }
    }

    /// Renders the picture and writes it to a PNG file, atomically.
    ///
    /// # Errors
    /// The errors of [`scene`](RenderJob::scene), or if the file cannot be written.
    pub fn to_file(&self, world: &World, output: &Output, progress: &Progress) -> Result<Rendering> {
        file::check_folder(file::folder(output.path()))?;
        let rendering = self.scene(world, 1.0, RenderJob::writing(self.size), progress)?;
        rendering.to_file(output)?;
        Ok(rendering)
    }

    /// Memory for writing a PNG of this size beside its pixels, in bytes: the filtered and the compressed picture.
    fn writing([width, height]: [usize; 2]) -> u64 {
        (width as u64).saturating_mul(height as u64).saturating_mul(6)
    }

    /// Makes the scene of a world of a [prepared](RenderJob::prepare) recipe. Painting is the rest of `progress`: that
    /// of `pictures` pictures, which take `writing` bytes of memory to write, beside their pixels.
    ///
    /// # Errors
    /// The errors of [`check`](RenderJob::check); if the world cannot make the window or no sample is finite; if memory
    /// does not suffice (then nothing was started); or the work was cancelled.
    pub fn scene(&self, world: &World, pictures: f64, writing: u64, progress: &Progress) -> Result<Rendering> {
        self.check()?;
        let window = match self.window {
            Some(window) => window,
            None => world.full_window(world.recipe().world.cell)?,
        };
        let pixels = (self.size[0] * self.size[1]) as u64;
        let land = (window.len() as u64).saturating_mul(LAND);
        // A device's picture is whole before it is copied.
        let copies = if self.device.is_some() { 2 } else { 1 };
        let has = |layer: &&str| world.recipe().outputs().any(|name| name == *layer);
        let layers: Vec<&str> = LAYERS.into_iter().filter(|layer| *layer == HEIGHT || has(layer)).collect();
        let held = land.saturating_add(copies * 3 * pixels).saturating_add(writing);
        let (plan, reserved) = world.plan_beside(&layers, &window, held)?;
        let [making, preparing, painting] = progress.parts([
            world.work(&plan)?,
            PREPARING * window.len() as f64,
            pictures * pixels as f64 * RAY * f64::from(self.samples),
        ]);
        let grids = world.run(&plan, &making)?;
        let mut warnings = Vec::new();
        layers.iter().zip(&grids).try_for_each(|(layer, grid)| finite::check(layer, grid, &mut warnings))?;
        let layer = |name: &str| layers.iter().position(|layer| *layer == name).and_then(|at| grids.get(at));
        let ends = layer(HEIGHT).map(|heights| extremes(NO_SAMPLES, heights.data()));
        if let Some([low, high]) = ends {
            let width = window.width.max(window.height) as f64 * window.cell;
            warnings.extend(proportions::warning(f64::from(high) - f64::from(low), width, self.exaggeration));
        }
        let nothing = Grid::filled(window, 0.0);
        let land = Land {
            heights: layer(HEIGHT).unwrap_or(&nothing),
            surface: layer("surface"),
            flow: layer("flow"),
            sea_level: Some(world.recipe().world.sea_level),
        };
        let cover = self.cover(world, &window, progress)?;
        let mut style = Style::default();
        style.exaggeration = self.exaggeration;
        style.sun = self.sun;
        style.haze = self.haze;
        style.edge = self.edge;
        style.colors = self.colors;
        style.palette = self.palette.as_ref();
        style.range = self.range;
        style.bedding = layer("bedding");
        style.snow_line = self.snow_line;
        style.samples = self.samples;
        if let [red, green, blue, roughness] = cover.as_slice() {
            style.cover = Some([red, green, blue, roughness]);
        }
        let scene = Scene::prepared(
            &land,
            &style,
            self.device.as_deref().map(|device| device as &dyn SkylightDevice),
            &preparing,
        )?;
        preparing.finish();
        let ends = self.range.or(ends.map(|ends| ends.map(f64::from))).unwrap_or([0.0; 2]);
        let color_bar = self.color_bar.then(|| ColorBar::new(scene.tint(), ends)).transpose()?;
        let spec = CameraSpec::new(self.view, self.size).with_fov(self.fov);
        Ok(Rendering {
            scene,
            spec,
            window,
            warnings,
            painting,
            color_bar,
            device: self.device.clone(),
            refused: OnceLock::new(),
            _reserved: reserved,
        })
    }

    /// Albedo and roughness of the surfaces, if they are shown.
    fn cover(&self, world: &World, window: &Window, progress: &Progress) -> Result<Vec<Grid>> {
        if self.colors != Colors::Surfaces {
            return Ok(Vec::new());
        }
        let layers = COVER
            .iter()
            .filter_map(|layer| layer.channels())
            .map(|channels| Rows::new(channels, world, window, 0, &progress.part(0.0))?.whole());
        Ok(layers.collect::<Result<Vec<Vec<Grid>>>>()?.concat())
    }
}

/// A scene that is ready to be painted.
pub struct Rendering {
    /// The land with its light.
    pub scene: Scene,
    /// The camera of the job.
    pub spec: CameraSpec,
    /// Messages about samples that are NaN or infinite, and about land that is higher than wide.
    pub warnings: Vec<String>,
    /// Progress of painting.
    pub painting: Progress,
    window: Window,
    color_bar: Option<ColorBar>,
    device: Option<Arc<dyn RenderDevice>>,
    refused: OnceLock<String>,
    _reserved: Reservation,
}

impl Rendering {
    /// The samples of the land, as text.
    #[must_use]
    pub fn samples(&self) -> String {
        let Window { width, height, cell, .. } = self.window;
        format!("{width} x {height} samples of {} m", number(cell))
    }

    /// How many metres the camera was raised, because it was below the ground.
    #[must_use]
    pub fn lifted(&self) -> Option<f64> {
        self.scene.camera(&self.spec).lifted()
    }

    /// A description: size and samples.
    #[must_use]
    pub fn words(&self) -> String {
        let [width, height] = self.spec.size;
        format!("{width} x {height} pixels, of {}", self.samples())
    }

    /// The description of a picture, for files of it or of several.
    #[must_use]
    pub fn picture(&self) -> Picture<'static> {
        let [width, height] = self.spec.size;
        Picture::new(width, height, Pixel::Rgb8).with_notes(&[("Software", SOFTWARE)])
    }

    /// Why the device did not paint, so that the processor did; `None` if it painted, or nothing was painted yet.
    #[must_use]
    pub fn refused(&self) -> Option<&str> {
        self.refused.get().map(String::as_str)
    }

    /// Paints some rows of a picture of `size` pixels, like [`Scene::paint`], with the job's device. If the device
    /// refuses, the processor paints this picture and all later ones, and [`refused`](Rendering::refused) says why.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn paint(
        &self,
        camera: &Camera,
        size: [usize; 2],
        rows: Range<usize>,
        bytes: &mut [u8],
        progress: &Progress,
    ) -> Result<()> {
        let top = rows.start;
        self.paint_land(camera, size, rows, bytes, progress)?;
        if let Some(bar) = &self.color_bar {
            bar.draw(size, top, bytes);
        }
        Ok(())
    }

    fn paint_land(
        &self,
        camera: &Camera,
        size: [usize; 2],
        rows: Range<usize>,
        bytes: &mut [u8],
        progress: &Progress,
    ) -> Result<()> {
        if let (Some(device), None) = (&self.device, self.refused.get()) {
            match device.paint(&self.scene, camera, size, rows.clone(), bytes, progress)? {
                Painted::Done => return Ok(()),
                // The first reason remains.
                Painted::Refused(why) => drop(self.refused.set(why)),
            }
        }
        self.scene.paint(camera, size, rows, bytes, progress)
    }

    /// Paints the picture of the job: three bytes for each pixel.
    ///
    /// # Errors
    /// If the work was cancelled.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let [width, height] = self.spec.size;
        let mut bytes = vec![0; 3 * width * height];
        let camera = self.scene.camera(&self.spec);
        self.painting.expect(height as f64);
        self.paint(&camera, self.spec.size, 0..height, &mut bytes, &self.painting.part(height as f64))?;
        Ok(bytes)
    }

    /// Paints the picture of the job and writes it to a PNG file, atomically.
    ///
    /// # Errors
    /// If the file cannot be written, or the work was cancelled.
    pub fn to_file(&self, output: &Output) -> Result<()> {
        file::write_whole(output, |out| self.to_stream(out))
    }

    /// Paints the picture of the job and writes it to a stream, as PNG.
    ///
    /// # Errors
    /// If the stream fails, or the work was cancelled.
    pub fn to_stream(&self, out: &mut dyn Write) -> io::Result<()> {
        let stopping = &mut CancellableWriter { out, progress: &self.painting };
        if self.device.is_some() {
            // At once: a device receives the scene for each call.
            let bytes = self.to_bytes()?;
            return png::write_through(stopping, &self.picture(), |out| out.write_all(&bytes));
        }
        let camera = self.scene.camera(&self.spec);
        self.painting.expect(self.spec.size[1] as f64);
        png::write(stopping, &self.picture(), |rows, bytes| {
            let part = self.painting.part(rows.len() as f64);
            Ok(self.paint(&camera, self.spec.size, rows, bytes, &part)?)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_output::render::skylight::{Shed, SkylightInput};

    /// A device that paints all pixels in one gray, or refuses.
    struct Device(Option<u8>);

    impl SkylightDevice for Device {
        fn skylight(&self, _input: &SkylightInput, _progress: &Progress) -> Result<Option<Vec<Shed>>> {
            Ok(None)
        }
    }

    impl RenderDevice for Device {
        fn paint(
            &self,
            _scene: &Scene,
            _camera: &Camera,
            _size: [usize; 2],
            _rows: Range<usize>,
            bytes: &mut [u8],
            _progress: &Progress,
        ) -> Result<Painted> {
            Ok(match self.0 {
                Some(grey) => {
                    bytes.fill(grey);
                    Painted::Done
                }
                None => Painted::Refused("it was lost".to_string()),
            })
        }
    }

    /// The picture as PNG, and why the device refused.
    fn picture(device: Option<Device>) -> (Vec<u8>, Option<String>) {
        let recipe = orogen_engine::presets::find("hills").unwrap().recipe().unwrap();
        let job = RenderJob { size: [40, 24], samples: 1, ..RenderJob::default() };
        let mut job = job.with_window(Window::new(50, 40, 40.0));
        if let Some(device) = device {
            job = job.with_device(Arc::new(device));
        }
        let rendering = job.scene(&World::open(recipe).unwrap(), 1.0, 0, &Progress::none()).unwrap();
        let mut bytes = Vec::new();
        rendering.to_stream(&mut bytes).unwrap();
        (bytes, rendering.refused().map(str::to_string))
    }

    #[test]
    fn a_color_bar_is_in_the_lower_left_corner() {
        let recipe = || orogen_engine::presets::find("hills").unwrap().recipe().unwrap();
        let mut job = RenderJob { size: [400, 240], samples: 1, colors: Colors::Map, ..RenderJob::default() };
        job = job.with_window(Window::new(50, 40, 40.0)).with_device(Arc::new(Device(Some(0))));
        job.range = Some([0.0, 500.0]);
        let picture = |job: &RenderJob| {
            let world = World::open(recipe()).unwrap();
            job.scene(&world, 1.0, 0, &Progress::none()).unwrap().to_bytes().unwrap()
        };
        let plain = picture(&job);
        job.color_bar = true;
        let bar = picture(&job);
        let differs = |x: usize, y: usize| plain[3 * (400 * y + x)..][..3] != bar[3 * (400 * y + x)..][..3];
        let inside: Vec<(usize, usize)> =
            (0..240).flat_map(|y| (0..400).map(move |x| (x, y))).filter(|(x, y)| differs(*x, *y)).collect();
        let [left, right] = [inside.iter().map(|p| p.0).min().unwrap(), inside.iter().map(|p| p.0).max().unwrap()];
        let [top, bottom] = [inside.iter().map(|p| p.1).min().unwrap(), inside.iter().map(|p| p.1).max().unwrap()];
        assert!(
            left < 20 && (300..380).contains(&right) && top > 150 && (220..235).contains(&bottom),
            "{left} {right} {top} {bottom}"
        );
        // In bands as at once.
        let world = World::open(recipe()).unwrap();
        let rendering = job.scene(&world, 1.0, 0, &Progress::none()).unwrap();
        let camera = rendering.scene.camera(&rendering.spec);
        let mut rows = vec![0; 3 * 400 * 240];
        for (k, band) in rows.chunks_mut(3 * 400 * 48).enumerate() {
            rendering.paint(&camera, [400, 240], 48 * k..48 * (k + 1), band, &Progress::none()).unwrap();
        }
        assert!(rows == bar);
        job.colors = Colors::Clay;
        job.range = None;
        assert!(job.check().unwrap_err().to_string().contains("a color bar applies to the colors of the map only"));
    }

    #[test]
    fn a_device_paints_and_the_processor_paints_what_it_refuses() {
        let (plain, none) = picture(None);
        assert_eq!(none, None);
        let (grey, none) = picture(Some(Device(Some(99))));
        assert!(grey != plain && none.is_none());
        let (fallen_back, why) = picture(Some(Device(None)));
        assert!(fallen_back == plain && why.as_deref() == Some("it was lost"));
    }
}
