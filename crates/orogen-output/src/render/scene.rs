//! The land with its light, prepared for rendering.

use orogen_grid::parallel;

use super::camera::{Camera, CameraSpec, Frame, folded};
pub use super::ground::Colors;
use super::ground::{Dress, GroundCover};
use super::lighting::Lighting;
use super::march::{Hit, Ray, Surface};
use super::relief::{Land, Relief};
use super::sky::Haze;
use super::skylight::{Skylight, SkylightDevice};
use super::tone::tone_map;
use super::vector::Vector;
use super::water::Water;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_grid::progress::Progress;
use orogen_io::palette::color::{Encoder, Light};
use orogen_io::palette::palette::Palette;
use orogen_io::palette::tint::Tint;

/// The surroundings of the land in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// The land as a cut block on a table.
    Cut,
    /// The open sea, if most of the edge is in the sea; otherwise the land repeats mirrored at its edges and fades into
    /// haze.
    Haze,
}

/// The style of a scene.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Style<'a> {
    /// The factor of heights.
    pub exaggeration: f64,
    /// The sun: degrees clockwise from north, and degrees above the horizon.
    pub sun: [f64; 2],
    /// Density of the haze: 0 is none, 1 is a clear day, independent of the size of the land.
    pub haze: f64,
    /// The surroundings; by default the sea if most of the edge is in it, otherwise a cut block.
    pub edge: Option<Edge>,
    /// The coloring of the ground.
    pub colors: Colors,
    /// The palette of [`Colors::Map`]; by default that of the relief map.
    pub palette: Option<&'a Palette>,
    /// The heights at the ends of the palette; by default the lowest and the highest of the land.
    pub range: Option<[f64; 2]>,
    /// Albedo (red, green and blue in linear light) and roughness for [`Colors::Surfaces`], over the land's window.
    pub cover: Option<[&'a Grid; 4]>,
    /// Height of a surface that the layers of rock follow, in metres, over the land's window; by default they are
    /// level.
    pub bedding: Option<&'a Grid>,
    /// Height at which snow starts, in metres; by default chosen by the relief.
    pub snow_line: Option<f64>,
    /// Number of samples per pixel.
    pub samples: u32,
}

impl Default for Style<'_> {
    fn default() -> Self {
        Style {
            exaggeration: 1.0,
            sun: [265.0, 27.0],
            haze: 1.0,
            edge: None,
            colors: Colors::Natural,
            palette: None,
            range: None,
            cover: None,
            bedding: None,
            snow_line: None,
            samples: 5,
        }
    }
}

/// The surroundings of the land, with positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Around {
    /// A table at this z.
    Table(f64),
    /// The sea at this z.
    Sea(f64),
    /// The mirrored land.
    Mirrors,
}

/// Maximum number of mirrored copies along a ray.
pub(super) const MIRRORS: usize = 12;

/// Optical depth of green light over the diagonal of land that continues, at a haze of 1.
const CLEAR_AROUND: f64 = 1.0;

/// The land with its light.
#[derive(Debug, Clone)]
pub struct Scene {
    pub(super) relief: Relief,
    pub(super) ground: GroundCover,
    pub(super) water: Water,
    pub(super) lighting: Lighting,
    pub(super) skylight: Skylight,
    pub(super) haze: Haze,
    pub(super) around: Around,
    /// The z of the lowest drawn point.
    pub(super) floor: f64,
    pub(super) samples: u32,
    encoder: Encoder,
}

/// An intersection of a ray, in the land's own coordinates, mirrored or not.
pub(super) struct Met {
    /// The distance from the ray's origin.
    pub distance: f64,
    pub place: Vector,
    /// The direction of the ray, mirrored like the land.
    pub along: Vector,
    /// East and south: 1, or -1 where the land is mirrored.
    pub flip: [f64; 2],
    pub surface: Seen,
    pub normal: Vector,
}

/// What a ray can meet.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Seen {
    Land(Surface),
    Table,
}

impl Scene {
    /// The tint of [`Colors::Map`].
    #[must_use]
    pub fn tint(&self) -> &Tint {
        &self.ground.tint
    }

    /// Prepares a scene.
    ///
    /// # Errors
    /// The errors of [`Relief::new`], or cancellation.
    pub fn new(land: &Land, style: &Style, progress: &Progress) -> Result<Scene> {
        Scene::prepared(land, style, None, progress)
    }

    /// Prepares a scene. `device` does the part of the work that it supports.
    ///
    /// # Errors
    /// The errors of [`Scene::new`].
    pub fn prepared(
        land: &Land,
        style: &Style,
        device: Option<&dyn SkylightDevice>,
        progress: &Progress,
    ) -> Result<Scene> {
        let [raising, shedding, painting] = progress.parts([1.0, 8.0, 2.0]);
        let relief = Relief::new(land, style.exaggeration)?;
        raising.finish();
        progress.check()?;
        let lighting = Lighting::new(style.sun);
        progress.check()?;
        let skylight = Skylight::new(&relief, &lighting.sky, device, &shedding)?;
        let cover = style.cover.into_iter().flatten().all(|layer| layer.window() == land.heights.window());
        if !cover || (style.colors == Colors::Surfaces && style.cover.is_none()) {
            let message = "a picture of surfaces needs their albedo and roughness over the window of the heights";
            return Err(Error::new(ErrorKind::Request, message));
        }
        if style.bedding.is_some_and(|bedding| bedding.window() != land.heights.window()) {
            let message = "bedding and heights of a picture must have the same window";
            return Err(Error::new(ErrorKind::Request, message));
        }
        let Style { colors, palette, range, cover, bedding, snow_line, .. } = *style;
        let dress = Dress { colors, palette, range, cover, bedding, snow_line };
        let ground = GroundCover::new(land, &relief, &dress);
        painting.finish();
        progress.check()?;
        let [east, south] = relief.reach();
        let across = (east * east + south * south).sqrt();
        let wet = wet_edge(&relief);
        let edge = style.edge.unwrap_or(if wet > 0.6 { Edge::Haze } else { Edge::Cut });
        let floor = -0.022 * across;
        let around = match (edge, relief.sea()) {
            (Edge::Cut, _) => Around::Table(floor),
            (Edge::Haze, Some(sea)) if wet > 0.6 => Around::Sea(sea),
            (Edge::Haze, _) => Around::Mirrors,
        };
        let haze = match around {
            Around::Mirrors => {
                Haze::new(style.haze * CLEAR_AROUND, across, (2.2 * relief.highest()).max(0.02 * across))
            }
            _ => Haze::of_block(style.haze, across, relief.highest()),
        };
        Ok(Scene {
            water: Water::new(relief.cell()),
            relief,
            ground,
            lighting,
            skylight,
            haze,
            around,
            floor: if matches!(around, Around::Table(_)) { floor } else { 0.0 },
            samples: style.samples.max(1),
            encoder: Encoder::new(),
        })
    }

    /// The land.
    #[must_use]
    pub fn relief(&self) -> &Relief {
        &self.relief
    }

    /// The box that a picture of the whole scene must show: the block, or the land above the sea.
    #[must_use]
    pub fn frame(&self) -> Frame {
        let ([east, south], highest) = (self.relief.reach(), self.relief.highest());
        let floor = if let Around::Sea(sea) = self.around { sea } else { self.floor };
        let mirrored = self.around == Around::Mirrors;
        let whole = Frame { low: Vector::new(0.0, 0.0, floor), high: Vector::new(east, south, highest), mirrored };
        let Around::Sea(sea) = self.around else {
            return whole;
        };
        let mut frame = Frame { low: whole.high, high: whole.low, mirrored };
        let columns = self.relief.samples()[0];
        for (at, _) in self.relief.bed().iter().enumerate().filter(|(_, z)| f64::from(**z) > sea) {
            let (x, y) = ((at % columns) as f64, (at / columns) as f64);
            frame.low = Vector::new(frame.low.x.min(x), frame.low.y.min(y), sea);
            frame.high = Vector::new(frame.high.x.max(x), frame.high.y.max(y), highest);
        }
        if frame.low.x < frame.high.x && frame.low.y < frame.high.y { frame } else { whole }
    }

    /// A camera in this scene. A distance that is chosen automatically shows all of the scene.
    #[must_use]
    pub fn camera(&self, spec: &CameraSpec) -> Camera {
        Camera::new(spec, &self.relief, &self.frame())
    }

    /// The distance, in metres, from which all of the scene is visible from each of these directions (azimuth and
    /// elevation in degrees): for a series of pictures around it at a constant distance.
    pub fn distance(&self, sides: impl Iterator<Item = [f64; 2]>, spec: &CameraSpec) -> f64 {
        Camera::distance(sides, spec, &self.relief, &self.frame())
    }

    /// Renders some rows of a picture of `size` pixels as sRGB bytes, three per pixel, on all threads of the pool.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn paint(
        &self,
        camera: &Camera,
        size: [usize; 2],
        rows: std::ops::Range<usize>,
        bytes: &mut [u8],
        progress: &Progress,
    ) -> Result<()> {
        let [width, height] = size;
        let pixel = camera.pixel(width);
        progress.expect(rows.len() as f64);
        parallel::try_for_each(bytes.chunks_exact_mut(3 * width).zip(rows), |(bytes, j)| {
            progress.check()?;
            for (i, bytes) in bytes.chunks_exact_mut(3).enumerate() {
                let mut sum = [0.0f32; 3];
                for k in 0..self.samples {
                    let [u, v] = spot(k);
                    let ray = camera.ray((i as f64 + u) / width as f64, (j as f64 + v) / height as f64);
                    let light = self.light(&ray, pixel);
                    let shown = tone_map(std::array::from_fn(|c| light[c] * self.lighting.exposure[c]));
                    sum.iter_mut().zip(shown).for_each(|(sum, c)| *sum += c);
                }
                bytes.copy_from_slice(&self.encoder.bytes(sum.map(|c| c / self.samples as f32)));
            }
            progress.advance(1.0);
            Ok(())
        })
    }

    /// The sRGB bytes of a pixel's tone-mapped color in linear light.
    #[doc(hidden)]
    #[must_use]
    pub fn bytes(&self, color: Light) -> [u8; 3] {
        self.encoder.bytes(color)
    }

    /// The light along a ray.
    fn light(&self, ray: &Ray, pixel: f64) -> Light {
        match self.meet(ray, 0.0) {
            Some(met) => {
                let light = self.shade(&met, pixel, true);
                self.through_haze(ray, &met, light)
            }
            None => self.lighting.sky.seen(ray.along),
        }
    }

    /// The first intersection of a ray.
    fn meet(&self, ray: &Ray, nearest: f64) -> Option<Met> {
        let met = |hit: Hit| Met {
            distance: hit.distance,
            place: ray.at(hit.distance),
            along: ray.along,
            flip: [1.0; 2],
            surface: Seen::Land(hit.surface),
            normal: hit.normal,
        };
        let level = |z: f64, surface: Seen| {
            let distance = (z - ray.from.z) / ray.along.z;
            (ray.along.z < 0.0 && distance > nearest).then(|| Met {
                distance,
                place: ray.at(distance),
                along: ray.along,
                flip: [1.0; 2],
                surface,
                normal: Vector::UP,
            })
        };
        match self.around {
            Around::Mirrors => self.meet_mirrored(ray, nearest),
            Around::Table(z) => {
                let table = level(z, Seen::Table);
                let hit = self.relief.hit(ray, nearest).map(met).filter(|hit| hit.place.z > z);
                hit.or(table)
            }
            Around::Sea(z) => {
                let sea = level(z, Seen::Land(Surface::Water));
                match (self.relief.hit(ray, nearest).map(met), sea) {
                    // The ground below the sea is not drawn beyond the land's edge; the sea surface hides it.
                    (Some(hit), Some(sea)) if sea.distance < hit.distance && !self.inside(sea.place) => Some(sea),
                    (hit, sea) => hit.or(sea),
                }
            }
        }
    }

    pub(super) fn inside(&self, place: Vector) -> bool {
        let [east, south] = self.relief.reach();
        (0.0..=east).contains(&place.x) && (0.0..=south).contains(&place.y)
    }

    /// The first intersection of a ray with the land and its mirrored copies: at an edge the ray is mirrored instead.
    fn meet_mirrored(&self, ray: &Ray, nearest: f64) -> Option<Met> {
        let reach = self.relief.reach();
        let ([x, y], mut flip) = ([0, 1].map(|axis| [ray.from.x, ray.from.y][axis]), [1.0; 2]);
        let mut from = ray.from;
        (from.x, flip[0]) = folded(x, reach[0]);
        (from.y, flip[1]) = folded(y, reach[1]);
        let mut along = Vector::new(ray.along.x * flip[0], ray.along.y * flip[1], ray.along.z);
        let (mut gone, mut nearest) = (0.0, nearest);
        for _ in 0..MIRRORS {
            let ray = Ray { from, along };
            if let Some(hit) = self.relief.hit(&ray, nearest) {
                return Some(Met {
                    distance: gone + hit.distance,
                    place: ray.at(hit.distance),
                    along,
                    flip,
                    surface: Seen::Land(hit.surface),
                    normal: hit.normal,
                });
            }
            let way = |from: f64, along: f64, reach: f64| match along {
                along if along > 0.0 => (reach - from) / along,
                along if along < 0.0 => -from / along,
                _ => f64::INFINITY,
            };
            let (x, y) = (way(from.x, along.x, reach[0]), way(from.y, along.y, reach[1]));
            let way = x.min(y).max(0.0);
            let at = ray.at(way);
            if !way.is_finite() || along.z >= 0.0 && at.z > self.relief.highest() {
                return None;
            }
            from = Vector { x: at.x.clamp(0.0, reach[0]), y: at.y.clamp(0.0, reach[1]), ..at };
            match x <= y {
                true => (along.x, flip[0]) = (-along.x, -flip[0]),
                false => (along.y, flip[1]) = (-along.y, -flip[1]),
            }
            gone += way;
            nearest = 0.0;
        }
        None
    }
}

/// The share of the land's edge that the sea covers.
fn wet_edge(relief: &Relief) -> f64 {
    let Some(sea) = relief.sea() else {
        return 0.0;
    };
    let [columns, rows] = relief.samples();
    let wet = |i: usize, j: usize| usize::from(f64::from(relief.bed()[j * columns + i]) <= sea);
    let across: usize = (0..columns).map(|i| wet(i, 0) + wet(i, rows - 1)).sum();
    let down: usize = (0..rows).map(|j| wet(0, j) + wet(columns - 1, j)).sum();
    (across + down) as f64 / (2 * (columns + rows)) as f64
}

/// The k-th sample position in a pixel: evenly distributed for any number of samples (M. Roberts' sequence of the
/// plastic number, 2018).
pub(super) fn spot(k: u32) -> [f64; 2] {
    let k = f64::from(k);
    [(0.5 + k * 0.754_877_666_246_693) % 1.0, (0.5 + k * 0.569_840_290_998_053_3) % 1.0]
}
