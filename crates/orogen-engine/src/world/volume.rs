//! Blocks of samples in space.

use super::world::World;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use std::ops::Index;

/// A layer in space: the samples of a window at several altitudes.
#[derive(Debug, Clone, PartialEq)]
pub struct Volume {
    window: Window,
    altitudes: Vec<f64>,
    data: Vec<f32>,
}

impl Volume {
    pub(crate) fn new(window: Window, altitudes: &[f64], data: Vec<f32>) -> Volume {
        Volume { window, altitudes: altitudes.to_vec(), data }
    }

    /// The columns.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The altitudes of the slices in metres, in the requested order.
    #[must_use]
    pub fn altitudes(&self) -> &[f64] {
        &self.altitudes
    }

    /// All samples, slice by slice in the order of the altitudes, each row-major from the north-west.
    #[must_use]
    pub fn data(&self) -> &[f32] {
        &self.data
    }

    /// All samples, in the order of [`Volume::data`].
    #[must_use]
    pub fn into_data(self) -> Vec<f32> {
        self.data
    }

    /// The samples at altitude number `k`, row-major from the north-west; empty if there is no such altitude.
    #[must_use]
    pub fn slice(&self, k: usize) -> &[f32] {
        let samples = self.window.len();
        self.data.chunks_exact(samples.max(1)).nth(k).unwrap_or(&[])
    }
}

impl Index<(usize, usize, usize)> for Volume {
    type Output = f32;

    /// The sample in column i and row j at altitude number k.
    ///
    /// # Panics
    /// If it is not in the volume.
    fn index(&self, (i, j, k): (usize, usize, usize)) -> &f32 {
        assert!(i < self.window.width && j < self.window.height, "({i}, {j}) is not in the window of the volume");
        &self.data[(k * self.window.height + j) * self.window.width + i]
    }
}

impl World {
    /// Whether a layer depends on the altitude at which it is sampled. In the plane, where windows and points are, the
    /// altitude is 0.
    ///
    /// # Errors
    /// If there is no such layer.
    pub fn reads_altitude(&self, layer: &str) -> Result<bool> {
        Ok(self.depends_on_altitude(&self.target(layer)?))
    }

    /// A layer in space: the samples of a window at each of the altitudes, which are in metres and may be in any order.
    /// Everything that does not depend on the altitude is computed once per column: filters, levels, solutions, and
    /// fields that do not read the altitude.
    ///
    /// Any part of the window and of the altitudes has the same bits, and the slice at altitude 0 equals
    /// [`World::window`].
    ///
    /// ```
    /// use orogen_engine::{Recipe, Window, World};
    ///
    /// let recipe = Recipe::parse(
    ///     r#"
    ///     orogen = 1
    ///     [nodes.ground]
    ///     op = "fbm"
    ///     wavelength = 500
    ///     [nodes.caves]
    ///     op = "ridged"
    ///     wavelength = 40
    ///     octaves = 2
    ///     vertical = 0.5
    ///     [nodes.altitude]
    ///     op = "altitude"
    ///     [nodes.density]
    ///     op = "expr"
    ///     expr = "60 * ground - altitude + 30 * caves"
    ///     [outputs]
    ///     density = "density"
    ///     "#,
    ///     "example",
    /// )?;
    /// let world = World::open(recipe)?;
    /// let altitudes: Vec<f64> = (-64..64).map(f64::from).collect();
    /// let chunk = world.volume("density", &Window::new(16, 16, 1.0).at(320, -160), &altitudes)?;
    /// let (bottom, top) = (chunk[(3, 5, 0)], chunk[(3, 5, 127)]);
    /// assert!(bottom > top && chunk.slice(64) == world.window("density", chunk.window())?.data());
    /// # Ok::<(), orogen_engine::Error>(())
    /// ```
    ///
    /// # Errors
    /// If there is no such layer, the window is not valid for this world, there is no altitude or one is not finite, or
    /// the volume needs more memory than allowed.
    pub fn volume(&self, layer: &str, window: &Window, altitudes: &[f64]) -> Result<Volume> {
        let target = self.target(layer)?;
        self.check_volume(window, altitudes)?;
        let data = self.in_space(target, window, altitudes, bytes(window, altitudes))?;
        Ok(Volume::new(*window, altitudes, data))
    }

    /// Checks that a window and altitudes are valid for this world.
    pub(crate) fn check_volume(&self, window: &Window, altitudes: &[f64]) -> Result<()> {
        self.check(window)?;
        let message = match altitudes.iter().find(|altitude| !altitude.is_finite()) {
            Some(altitude) => format!("{altitude} is not an altitude: it must be finite"),
            None if altitudes.is_empty() => "no altitudes were given; a volume needs at least one".to_string(),
            None => return Ok(()),
        };
        Err(Error::new(ErrorKind::Request, message))
    }
}

/// Memory of the samples of a volume, in bytes.
pub(crate) fn bytes(window: &Window, altitudes: &[f64]) -> u64 {
    (window.width as u64).saturating_mul(window.height as u64).saturating_mul(altitudes.len() as u64).saturating_mul(4)
}
