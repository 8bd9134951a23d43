//! A layer of a world prepared for many requests.

use super::volume::{self, Volume};
use super::world::World;
use crate::engine::inline::PreparedProgram;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_ops::interpreter::Buffers;
use std::borrow::Borrow;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A layer of a world prepared for many requests, for use in games and servers.
///
/// [`World::window`] and [`World::height`] plan each request; a sampler plans and solves once. It runs on the calling
/// thread, and any number of threads may use it at once. Its results have the same bits as the world's own windows and
/// points.
///
/// For a layer without filters it does not allocate, except for the first requests of a size on a number of threads.
/// For a layer with filters it keeps some patches of terrain around the last requested points.
///
/// A sampler holds its world: a reference, a [`World`], or an [`Arc`] if it is shared.
///
/// ```
/// use orogen_engine::{Sampler, Window, World, presets};
///
/// let world = World::open(presets::find("hills").ok_or("no such preset")?.recipe()?)?;
/// let ground = Sampler::new(&world, "height")?;
///
/// // The heights along a path.
/// for step in 0..100 {
///     let (x, y) = (4000.0 + 0.7 * f64::from(step), 5000.0);
///     assert_eq!(ground.at(x, y)?, world.height(x, y)?);
/// }
///
/// // A tile into a buffer that is used again and again.
/// let tile = Window::new(65, 65, 2.0).at(2000, 2500);
/// let mut heights = vec![0.0; tile.len()];
/// ground.fill(&tile, &mut heights)?;
/// assert_eq!(heights, world.window("height", &tile)?.data());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Sampler<W: Borrow<World>> {
    world: W,
    layer: String,
    /// The program for all points and windows, if a single one suffices.
    everywhere: Option<PreparedProgram>,
    patches: Mutex<Vec<Patch>>,
    /// Buffers that no thread is using.
    idle: Mutex<Vec<Buffers>>,
    /// A progress without a listener, kept because creating one allocates.
    silence: Progress,
}

/// Terrain prepared for points within it.
struct Patch {
    /// Its column and row.
    at: [i64; 2],
    ready: Arc<PreparedProgram>,
}

/// Side of a patch, in cells of the world.
const PATCH: i64 = 64;

/// Number of patches that are kept.
const PATCHES: usize = 16;

impl<W: Borrow<World>> Sampler<W> {
    /// Prepares a layer: plans it and solves its solvers, which for some recipes takes as long as making the whole
    /// world.
    ///
    /// # Errors
    /// If there is no such layer, or solving needs more memory than the options of the world allow.
    pub fn new(world: W, layer: &str) -> Result<Sampler<W>> {
        let everywhere = {
            let world = world.borrow();
            let ready = world.ready(layer, world.around(&[0.0], &[0.0]))?;
            ready.anywhere().then_some(ready)
        };
        Ok(Sampler {
            world,
            layer: layer.to_string(),
            everywhere,
            patches: Mutex::default(),
            idle: Mutex::default(),
            silence: Progress::none(),
        })
    }

    /// The world.
    pub fn world(&self) -> &World {
        self.world.borrow()
    }

    /// The layer's name.
    pub fn layer(&self) -> &str {
        &self.layer
    }

    /// The layer's value at x metres east and y metres south of the origin.
    ///
    /// # Errors
    /// If the position is not finite or is outside the world.
    pub fn at(&self, x: f64, y: f64) -> Result<f32> {
        let mut value = [f32::NAN];
        self.points(&[x], &[y], &mut value)?;
        Ok(value[0])
    }

    /// Writes the layer's values at points, in metres, to `out`.
    ///
    /// # Errors
    /// If a point is not finite or is outside the world, or the lengths differ.
    pub fn points(&self, x: &[f64], y: &[f64], out: &mut [f32]) -> Result<()> {
        if x.len() != y.len() || x.len() != out.len() {
            let message = format!(
                "{} eastings, {} southings and a buffer of {} values do not have the same length",
                x.len(),
                y.len(),
                out.len()
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        x.iter().zip(y).try_for_each(|(x, y)| self.world().check_point(*x, *y))?;
        if let Some(ready) = &self.everywhere {
            return self.ask(ready, x, y, out);
        }
        // Consecutive points on one patch are evaluated together.
        let mut start = 0;
        while let (Some(first_x), Some(first_y)) = (x.get(start), y.get(start)) {
            let patch = self.patch_of(*first_x, *first_y);
            let run = x[start..].iter().zip(&y[start..]).take_while(|(x, y)| self.patch_of(**x, **y) == patch).count();
            let end = start + run;
            let ready = self.patch(patch)?;
            self.ask(&ready, &x[start..end], &y[start..end], &mut out[start..end])?;
            start = end;
        }
        Ok(())
    }

    /// Makes the samples of a window.
    ///
    /// # Errors
    /// The errors of [`Sampler::fill`].
    pub fn window(&self, window: &Window) -> Result<Grid> {
        if self.everywhere.is_none() {
            return self.world().window(&self.layer, window);
        }
        self.world().check(window)?;
        self.world().afford_grid(window)?;
        let mut grid = Grid::filled(*window, 0.0);
        self.fill(window, grid.data_mut())?;
        Ok(grid)
    }

    /// Writes the samples of a window, row-major from the north-west, to `out`.
    ///
    /// # Errors
    /// If the window is not valid for this world, `out` has another length, or a layer with filters needs more memory
    /// than the options of the world allow.
    pub fn fill(&self, window: &Window, out: &mut [f32]) -> Result<()> {
        self.world().check(window)?;
        if out.len() != window.len() {
            let message = format!(
                "a window of {} x {} samples does not fit a buffer of {}: it needs {}",
                window.width,
                window.height,
                out.len(),
                window.len()
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        match &self.everywhere {
            Some(ready) => {
                self.with_buffers(|buffers| self.world().engine(&self.silence).fill_inline(ready, window, buffers, out))
            }
            None => {
                out.copy_from_slice(self.world().window(&self.layer, window)?.data());
                Ok(())
            }
        }
    }

    /// Makes the samples of a window at each of the altitudes, in metres, as [`World::volume`] does.
    ///
    /// # Errors
    /// The errors of [`World::volume`].
    pub fn volume(&self, window: &Window, altitudes: &[f64]) -> Result<Volume> {
        if self.everywhere.is_none() {
            return self.world().volume(&self.layer, window, altitudes);
        }
        self.world().check_volume(window, altitudes)?;
        self.world().budget().afford(volume::bytes(window, altitudes))?;
        let mut data = vec![0.0; window.len() * altitudes.len()];
        self.fill_volume(window, altitudes, &mut data)?;
        Ok(Volume::new(*window, altitudes, data))
    }

    /// Writes the samples of a window at each of the altitudes, in metres, to `out`: slice by slice in the order of the
    /// altitudes, each row-major from the north-west. Like [`Sampler::fill`], it works on the calling thread without
    /// allocation once warm, if the layer has no filters.
    ///
    /// # Errors
    /// The errors of [`World::volume`], or `out` has another length.
    pub fn fill_volume(&self, window: &Window, altitudes: &[f64], out: &mut [f32]) -> Result<()> {
        self.world().check_volume(window, altitudes)?;
        if Some(out.len()) != window.len().checked_mul(altitudes.len()) {
            let message = format!(
                "a window of {} x {} samples at {} altitudes does not fit a buffer of {}",
                window.width,
                window.height,
                altitudes.len(),
                out.len()
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        match &self.everywhere {
            Some(ready) => self.with_buffers(|buffers| {
                self.world().engine(&self.silence).volume_inline(ready, (window, altitudes), buffers, out)
            }),
            None => {
                out.copy_from_slice(self.world().volume(&self.layer, window, altitudes)?.data());
                Ok(())
            }
        }
    }

    fn ask(&self, ready: &PreparedProgram, x: &[f64], y: &[f64], out: &mut [f32]) -> Result<()> {
        self.with_buffers(|buffers| self.world().engine(&self.silence).points_inline(ready, (x, y), buffers, out))
    }

    /// Provides buffers that no other thread is using.
    fn with_buffers(&self, work: impl FnOnce(Buffers) -> Result<Buffers>) -> Result<()> {
        let buffers = lock(&self.idle).pop().unwrap_or_default();
        let buffers = work(buffers)?;
        lock(&self.idle).push(buffers);
        Ok(())
    }

    /// The column and row of the patch that contains a point.
    fn patch_of(&self, x: f64, y: f64) -> [i64; 2] {
        [x, y].map(|metres| ((metres / self.world().recipe().world.cell).floor() as i64).div_euclid(PATCH))
    }

    /// A patch, cached or new; the least recently used one is dropped.
    fn patch(&self, at: [i64; 2]) -> Result<Arc<PreparedProgram>> {
        let mut patches = lock(&self.patches);
        if let Some(place) = patches.iter().position(|patch| patch.at == at) {
            let patch = patches.remove(place);
            let ready = Arc::clone(&patch.ready);
            patches.push(patch);
            return Ok(ready);
        }
        // Released, because making a patch takes time and threads.
        drop(patches);
        let spec = &self.world().recipe().world;
        let corners = [0, 1].map(|axis| {
            let last = spec.size.map_or(f64::INFINITY, |size| size[axis]);
            let start = at[axis] as f64 * PATCH as f64;
            [start, start + PATCH as f64].map(|column| (column * spec.cell).min(last))
        });
        let ready = Arc::new(self.world().ready(&self.layer, self.world().around(&corners[0], &corners[1]))?);
        let mut patches = lock(&self.patches);
        if patches.iter().all(|patch| patch.at != at) {
            if patches.len() >= PATCHES {
                patches.remove(0);
            }
            patches.push(Patch { at, ready: Arc::clone(&ready) });
        }
        Ok(ready)
    }
}

/// The data under these locks is consistent at any time, also after a panic of another thread.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
