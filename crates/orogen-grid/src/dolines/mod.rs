//! Dolines (sinkholes): closed hollows where rock was dissolved, or where cover sank into caves.
//!
//! Places, sizes and forms are hashed from the cells of a lattice in metres. Each doline reads the ground at its
//! center, and the ground within its reach is lowered by the deepest of the dolines there: neighbors merge to uvalas,
//! whose inside has no rims.

mod doline;
mod scatter;

use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::parallel;
use crate::progress::Progress;
use crate::resample::split;

/// How dolines are distributed, and their forms.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Dolines {
    /// Mean number on a square kilometre.
    pub density: f64,
    /// Minimum and maximum diameter, in metres: two standard deviations of the logarithm from the median.
    pub diameters: [f64; 2],
    /// Minimum and maximum depth, as a share of the diameter.
    pub depths: [f64; 2],
    /// Minimum and maximum length over width.
    pub elongations: [f64; 2],
    /// Direction of the length, clockwise from north, in degrees.
    pub direction: f64,
    /// Share of the dolines that are funnels.
    pub funnels: f64,
    /// Share of the dolines with a level floor.
    pub floors: f64,
    /// How much the density varies, 0 to 1.
    pub clustering: f64,
    /// Distance between clusters, in metres.
    pub cluster_distance: f64,
    /// Slope from which on there are none, in degrees.
    pub max_slope: f64,
    /// Seed of the places and forms.
    pub seed: u64,
}

impl Default for Dolines {
    /// The defaults of the op `dolines`.
    fn default() -> Dolines {
        Dolines {
            density: 10.0,
            diameters: [10.0, 300.0],
            depths: [0.1, 0.3],
            elongations: [1.0, 1.8],
            direction: 45.0,
            funnels: 0.3,
            floors: 0.2,
            clustering: 0.8,
            cluster_distance: 1500.0,
            max_slope: 20.0,
            seed: 0,
        }
    }
}

orogen_noise::builder!(
    Dolines:
    with_density(density: f64),
    with_diameters(diameters: [f64; 2]),
    with_depths(depths: [f64; 2]),
    with_elongations(elongations: [f64; 2]),
    with_direction(direction: f64),
    with_funnels(funnels: f64),
    with_floors(floors: f64),
    with_clustering(clustering: f64),
    with_cluster_distance(cluster_distance: f64),
    with_max_slope(max_slope: f64),
    with_seed(seed: u64)
);

/// Samples along the sides of a tile whose dolines are found together.
const TILE: usize = 64;

impl Dolines {
    /// Number of samples around a window that [`Dolines::hollow`] reads: to the center of a doline, and from there as
    /// far as its slope is measured.
    #[must_use]
    pub fn halo(&self, cell: f64) -> usize {
        ((self.reach() + 0.5 * self.diameters[1]) / cell).ceil() as usize + 2
    }

    /// Maximum distance from the center to the edge of a doline, in metres.
    fn reach(&self) -> f64 {
        0.5 * self.diameters[1] * self.elongations[1].sqrt() * (1.0 + doline::OUTLINE)
    }

    /// How deep dolines lower the ground, in metres, over a window that is smaller by [`Dolines::halo`] on each side.
    /// `density` is the share of the density at the centers, 1 if it is absent. Dolines fade out between diameters of
    /// two cells and one.
    ///
    /// # Errors
    /// If the grids have different windows, or the work is cancelled.
    pub fn hollow(&self, ground: &Grid, density: Option<&Grid>, progress: &Progress) -> Result<Grid> {
        let window = *ground.window();
        if density.is_some_and(|density| *density.window() != window) {
            return Err(Error::new(ErrorKind::Request, "the ground and the density must have the same window"));
        }
        let inner = window.shrunk(self.halo(window.cell));
        let mut hollow = Grid::filled(inner, 0.0);
        if self.density <= 0.0 || self.diameters[1] <= window.cell {
            return Ok(hollow);
        }
        let tiles: Vec<Window> = inner.tiles(TILE).collect();
        progress.expect(tiles.len() as f64);
        let made = parallel::try_map(tiles, |tile| {
            progress.step(1.0)?;
            self.tile(&tile, ground, density)
        })?;
        made.iter().for_each(|tile| hollow.paste(tile));
        Ok(hollow)
    }

    /// The hollows of a tile.
    fn tile(&self, tile: &Window, ground: &Grid, density: Option<&Grid>) -> Result<Grid> {
        let mut hollow = Grid::filled(*tile, 0.0f32);
        let dolines = scatter::gather(self, tile, &Land { ground, density })?;
        let inside = |metres: f64, first: i64, count: usize| {
            ((metres / tile.cell).ceil() - first as f64).clamp(0.0, count as f64) as usize
        };
        for doline in &dolines {
            let [east, south] = doline.center;
            let rows = [-1.0, 1.0].map(|side| inside(south + side * doline.reach, tile.y, tile.height));
            let columns = [-1.0, 1.0].map(|side| inside(east + side * doline.reach, tile.x, tile.width));
            for j in rows[0]..rows[1] {
                let y = tile.south(j) - south;
                for i in columns[0]..columns[1] {
                    let from = [tile.east(i) - east, y];
                    let here = (tile.x + i as i64 - ground.window().x, tile.y + j as i64 - ground.window().y);
                    let Some(height) = at(ground, here.0, here.1) else { continue };
                    let depth = doline.depth(from, height) as f32;
                    // The deepest of all: no order of the dolines changes it.
                    let deepest = hollow.row(j)[i].max(depth);
                    hollow.row_mut(j)[i] = deepest;
                }
            }
        }
        Ok(hollow)
    }
}

/// What dolines depend on.
struct Land<'a> {
    ground: &'a Grid,
    density: Option<&'a Grid>,
}

impl Land<'_> {
    /// The height at a position in metres; `None` beyond the grid or without a value.
    fn height(&self, position: [f64; 2]) -> Option<f64> {
        between(self.ground, position)
    }

    /// The share of the density at a position, 0 to 1.
    fn share(&self, position: [f64; 2]) -> f64 {
        let Some(density) = self.density else { return 1.0 };
        between(density, position).map_or(0.0, |share| share.clamp(0.0, 1.0))
    }

    /// The tangent of the slope over `distance` metres to each side.
    fn slope(&self, [east, south]: [f64; 2], distance: f64) -> Option<f64> {
        let distance = distance.max(self.ground.window().cell);
        let rise = |[x, y]: [f64; 2]| {
            let after = self.height([east + x, south + y])?;
            Some((after - self.height([east - x, south - y])?) / (2.0 * distance))
        };
        let (x, y) = (rise([distance, 0.0])?, rise([0.0, distance])?);
        Some((x * x + y * y).sqrt())
    }
}

/// A sample by its place in the grid; `None` beyond the grid or without a value.
fn at(grid: &Grid, i: i64, j: i64) -> Option<f64> {
    let (i, j) = (usize::try_from(i).ok()?, usize::try_from(j).ok()?);
    grid.get(i, j).filter(|value| value.is_finite()).map(f64::from)
}

/// The value at a position in metres, linear between samples.
fn between(grid: &Grid, [east, south]: [f64; 2]) -> Option<f64> {
    let window = grid.window();
    let ((i, x), (j, y)) = (split(east, window.cell), split(south, window.cell));
    let (i, j) = (i.checked_sub(window.x)?, j.checked_sub(window.y)?);
    let along = |j: i64| {
        let west = at(grid, i, j)?;
        Some(west + (at(grid, i.saturating_add(1), j)? - west) * f64::from(x))
    };
    let north = along(j)?;
    Some(north + (along(j.saturating_add(1))? - north) * f64::from(y))
}

#[cfg(test)]
mod tests;
