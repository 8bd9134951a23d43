//! Valid windows, points and cells of a world.

use super::world::World;
use crate::plan::domain::world_windows;
use crate::recipe::graph::MAX_SAMPLES;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::words::number;

/// The smallest and the largest distance between samples, in metres.
pub const CELLS: [f64; 2] = [1e-6, 1e12];

/// Checks a distance between samples.
///
/// # Errors
/// If it is not in the range of [`CELLS`].
pub fn check_cell(cell: f64) -> Result<()> {
    let [least, most] = CELLS;
    if (least..=most).contains(&cell) {
        return Ok(());
    }
    let message = format!("the cell size must be {} to {} m, not {}", number(least), number(most), cell);
    Err(Error::new(ErrorKind::Request, message))
}

impl World {
    /// The window of the whole world with a cell of `cell` metres: a world of length L has round(L / cell) samples
    /// along that side; the sample at its far edge belongs to the neighbor.
    ///
    /// # Errors
    /// If the world is unbounded, or has no samples or more than 2^31 along a side at that cell.
    pub fn full_window(&self, cell: f64) -> Result<Window> {
        let size = self.bounds()?;
        let samples = size.map(|length| (length / cell).round());
        let fault = |why: &str, other: &str| {
            let [width, height] = size;
            let message = format!(
                "the world of {} x {} m has {why} at a cell size of {} m; use a {other} cell",
                number(width),
                number(height),
                number(cell)
            );
            Err(Error::new(ErrorKind::Request, message))
        };
        if !samples.iter().all(|samples| *samples >= 1.0) {
            return fault("no samples", "smaller");
        }
        if samples.iter().any(|samples| *samples > MAX_SAMPLES) {
            return fault("more than 2^31 samples along a side", "larger");
        }
        Ok(Window::new(samples[0] as usize, samples[1] as usize, cell))
    }

    /// The window of the whole world with `samples` along its longer side.
    ///
    /// # Errors
    /// If the world is unbounded, or `samples` is 0.
    pub fn window_fitting(&self, samples: usize) -> Result<Window> {
        let size = self.bounds()?;
        if samples == 0 {
            return Err(Error::new(ErrorKind::Request, "the longer side of the world must have at least 1 sample"));
        }
        let cell = size[0].max(size[1]) / samples as f64;
        let [width, height] = size.map(|length| ((length / cell).round() as usize).max(1));
        Ok(Window::new(width, height, cell))
    }

    pub(super) fn bounds(&self) -> Result<[f64; 2]> {
        let message = "this world is unbounded; specify a window";
        self.resolved.world_params.size.ok_or_else(|| Error::new(ErrorKind::Request, message))
    }

    /// A window extended by `reach` samples on each side, clipped to the world.
    #[doc(hidden)]
    pub fn surroundings(&self, window: &Window, reach: usize) -> Window {
        let wide = window.grown(reach);
        let wide = match self.resolved.world_params.size {
            Some(size) => wide.intersection(&world_windows(size, window.cell).0),
            None => wide,
        };
        // An unbounded world ends where positions are no longer exact.
        if self.check(&wide).is_ok() { wide } else { *window }
    }

    /// The samples at the world's cell that the interpolating cubic reads around points.
    pub(crate) fn around(&self, x: &[f64], y: &[f64]) -> Window {
        let cell = self.resolved.world_params.cell;
        let span = |values: &[f64]| {
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let first = ((low / cell).floor() as i64).saturating_sub(2);
            let last = ((high / cell).ceil() as i64).saturating_add(2);
            (first, last.saturating_sub(first).saturating_add(1) as usize)
        };
        let ((x, width), (y, height)) = (span(x), span(y));
        Window { x, y, width, height, cell }
    }

    /// Checks that a window is valid for this world.
    #[doc(hidden)]
    pub fn check(&self, window: &Window) -> Result<()> {
        let fault = |message: String| Err(Error::new(ErrorKind::Request, message));
        check_cell(window.cell)?;
        if window.is_empty() {
            return fault(format!("a window of {} x {} samples is empty", window.width, window.height));
        }
        if window.width.max(window.height) as f64 > MAX_SAMPLES {
            return fault(format!(
                "a window of {} x {} samples is too large: it may have {MAX_SAMPLES:.0} along a side; use a smaller window or a larger cell",
                window.width, window.height
            ));
        }
        const FAR: i64 = 1 << 53;
        let inside = |start: i64, count: usize| (-FAR..=FAR).contains(&start) && start + count as i64 <= FAR;
        if !(inside(window.x, window.width) && inside(window.y, window.height)) {
            return fault(format!(
                "the window of {} x {} samples at ({}, {}) is more than 2^53 samples, {} m, from the origin, where positions are no longer exact",
                window.width,
                window.height,
                window.x,
                window.y,
                number(FAR as f64 * window.cell)
            ));
        }
        if let Some(size) = self.resolved.world_params.size {
            let (world, _) = world_windows(size, window.cell);
            if !world.contains(window) {
                return fault(format!(
                    "the window of {} x {} samples at ({}, {}) is not inside the world, which at a cell of {} m has samples \
                     (0, 0) to ({}, {})",
                    window.width,
                    window.height,
                    window.x,
                    window.y,
                    number(window.cell),
                    world.width - 1,
                    world.height - 1
                ));
            }
        }
        Ok(())
    }

    /// Checks that a point is in this world.
    pub(crate) fn check_point(&self, x: f64, y: f64) -> Result<()> {
        let fault = |message: String| Err(Error::new(ErrorKind::Request, message));
        if !(x.is_finite() && y.is_finite()) {
            return fault(format!("({x}, {y}) is not a position: coordinates must be finite"));
        }
        match self.resolved.world_params.size {
            Some([w, h]) if !((0.0..=w).contains(&x) && (0.0..=h).contains(&y)) => {
                fault(format!("({x}, {y}) is outside the world, which extends from (0, 0) to ({w}, {h}) metres"))
            }
            _ => Ok(()),
        }
    }
}
