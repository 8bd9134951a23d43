//! Rendered pictures of the land on a graphics card.
//!
//! A compute shader draws a [`Scene`], the same as `orogen render`, in place of [`Scene::paint`]; the card can also
//! compute the skylight. The shader has the same files as that renderer, and takes colors, tables and all numbers of
//! the scene from it. Pictures look the same, but are not bit-equal.

mod shader;
mod skylight;

use std::cell::Cell;
use std::ops::Range;

use crate::failure::Failure;
use crate::gpu::Gpu;
use crate::job::{Dispatch, GROUP, Job};
use orogen_grid::error::Result as Outcome;
use orogen_grid::progress::Progress;
use orogen_output::render::camera::Camera;
use orogen_output::render::device::{Painted, RenderDevice};
use orogen_output::render::scene::Scene;
use orogen_output::render::skylight::{Shed, SkylightDevice, SkylightInput};
use shader::Encoded;
pub use skylight::skylight;

/// Maximum number of rays of a dispatch: less than a second on a slow card, and enough to use a fast one fully.
const RAYS: usize = 1 << 20;

/// Maximum number of pixels that are copied back at once.
const PIXELS: usize = 1 << 22;

/// Renders some rows of a picture of `size` pixels as sRGB bytes, three per pixel, like [`Scene::paint`].
/// `is_cancelled` is called before each part of the work with the finished share, 0 to 1. Returns `Ok(None)` if the
/// work was cancelled.
///
/// # Errors
/// If the scene does not fit into a buffer of the card, or the card fails. The processor can then paint.
pub fn render(
    gpu: &Gpu,
    scene: &Scene,
    camera: &Camera,
    size: [usize; 2],
    rows: Range<usize>,
    is_cancelled: impl Fn(f64) -> bool,
) -> Result<Option<Vec<u8>>, Failure> {
    let data = scene.encode(camera, size);
    let encoded = Encoded::new(&data);
    let words = (gpu.buffer_limit() / 4) as usize;
    let room = words.saturating_sub(encoded.samples).min(3 * PIXELS.max(size[0])) / (3 * size[0].max(1));
    if room == 0 {
        let [needed, limit] = [encoded.samples + 3 * size[0], words].map(|words| words.div_ceil(1 << 18));
        return Err(Failure::Memory(format!("the scene takes {needed} MiB, and a buffer has at most {limit} MiB")));
    }
    let mut bytes = Vec::with_capacity(3 * size[0] * rows.len());
    for first in rows.clone().step_by(room) {
        let band = first..(first + room).min(rows.end);
        let share = |done: f64| ((band.start - rows.start) as f64 + done * band.len() as f64) / rows.len() as f64;
        let Some(colors) = draw_band(gpu, &encoded, size[0], band.clone(), |done| is_cancelled(share(done)))? else {
            return Ok(None);
        };
        bytes.extend(colors.chunks_exact(3).flat_map(|color| scene.bytes([color[0], color[1], color[2]])));
    }
    Ok(Some(bytes))
}

/// Draws some rows that fit into a buffer: their pixels in linear light.
fn draw_band(
    gpu: &Gpu,
    encoded: &Encoded,
    width: usize,
    rows: Range<usize>,
    is_cancelled: impl Fn(f64) -> bool,
) -> Result<Option<Vec<f32>>, Failure> {
    let mut data = encoded.words.clone();
    data.push(rows.start as u32);
    let tiles = tiles(width, rows.clone(), encoded.rays_per_pixel);
    let dispatches = tiles.iter().map(|tile| {
        let base = data.len() as u32;
        data.extend(tile.start);
        Dispatch { text: &encoded.text, base, size: tile.size, ..Dispatch::default() }
    });
    let dispatches: Vec<Dispatch> = dispatches.collect();
    let count = 3 * width * rows.len();
    let job = Job {
        data,
        samples: encoded.samples + count,
        uploads: encoded.uploads.iter().map(|(at, grid)| (*at, (*grid).into())).collect(),
        dispatches,
        downloads: vec![(encoded.samples, count)],
        ..Job::default()
    };
    let asked = Cell::new(0);
    let back = job.run_in_parts(gpu, 1, || {
        let done = asked.replace(asked.get() + 1);
        is_cancelled(f64::from(done) / tiles.len() as f64)
    })?;
    Ok(back.and_then(|mut grids| grids.pop()))
}

/// A part of a picture that one dispatch draws.
struct Tile {
    /// Its first column and row.
    start: [u32; 2],
    size: [u32; 2],
}

/// Bands of rows, split further where a band would have too many rays.
fn tiles(width: usize, rows: Range<usize>, rays_per_pixel: usize) -> Vec<Tile> {
    let group = GROUP as usize;
    let pixels = RAYS / rays_per_pixel.max(1);
    let high = (pixels / width.max(1) / group * group).max(group);
    let wide = (pixels / high / group * group).clamp(group, width.max(group));
    let wide = if high > group { width.max(1) } else { wide };
    let across = |first: usize| {
        let rows = rows.clone();
        (0..width).step_by(wide).map(move |column| Tile {
            start: [column as u32, first as u32],
            size: [wide.min(width - column) as u32, high.min(rows.end - first) as u32],
        })
    };
    rows.clone().step_by(high).flat_map(across).collect()
}

impl RenderDevice for Gpu {
    fn paint(
        &self,
        scene: &Scene,
        camera: &Camera,
        size: [usize; 2],
        rows: Range<usize>,
        bytes: &mut [u8],
        progress: &Progress,
    ) -> Outcome<Painted> {
        progress.check()?;
        progress.expect(1.0);
        let before = Cell::new(0.0);
        let painted = render(self, scene, camera, size, rows, |done| {
            progress.advance(done - before.replace(done));
            progress.is_cancelled()
        });
        match painted {
            Ok(Some(painted)) if painted.len() == bytes.len() => {
                bytes.copy_from_slice(&painted);
                progress.finish();
                Ok(Painted::Done)
            }
            Ok(Some(_)) => Ok(Painted::Refused("the rows and their bytes differ in number".to_string())),
            Ok(None) => progress.check().map(|()| Painted::Refused("the work was cancelled".to_string())),
            Err(failure) => Ok(Painted::Refused(failure.to_string())),
        }
    }
}

impl SkylightDevice for Gpu {
    fn skylight(&self, input: &SkylightInput, progress: &Progress) -> Outcome<Option<Vec<Shed>>> {
        progress.check()?;
        let directions = input.directions.len() as f64;
        progress.expect(directions + 1.0);
        let lit = skylight(self, input, || {
            progress.advance(1.0);
            progress.is_cancelled()
        });
        progress.check()?;
        // If the card cannot do it, the processor does. Painting, which follows, returns the reason.
        Ok(lit.unwrap_or_default())
    }
}
