//! Heights, rain and uplift of a map as rasters.

use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::polylines::outline::Outline;
use orogen_grid::polylines::segments::Segments;
use orogen_grid::progress::Progress;
use orogen_grid::scattered::{Scattered, chosen};
use orogen_io::dem::fill::fill;
use orogen_io::format::fmg::{FmgMap, Water};

/// The distance at which the weight of a cell has fallen to 1/e, in distances between cells.
pub const LENGTH: f64 = 0.8;

/// Samples per distance between cells.
const SAMPLES: f64 = 2.0;

/// Number of samples beyond the map on each side.
const MARGIN: usize = 4;

/// Heights between the highest sea bed and the lowest land, in metres.
const SHORE: f32 = 1.0;

/// The rasters of a map.
#[derive(Debug)]
pub struct Rasters {
    /// Heights in metres.
    pub heights: Grid,
    /// Factors of the rain, if the map has them.
    pub rain: Option<Grid>,
    /// Uplift over erodibility, for a kilometre of height.
    pub uplift: Grid,
    /// The shore of the map.
    pub shore: Segments,
}

impl Rasters {
    /// The rasters; the uplift is that before any calibration.
    pub fn new(map: &FmgMap, progress: &Progress) -> Result<Rasters> {
        let shore = Segments::new(&outlines(map), 1.0);
        let window = window(map);
        progress.expect(3.0);
        let surface = |is_land: bool, corrections| {
            let sites = map.sites.iter().filter(|site| match site.water {
                None => is_land,
                Some(Water::Sea) => !is_land,
                // The beds of lakes are not those of the file.
                Some(Water::Lake) => false,
            });
            let (at, heights): (Vec<[f64; 2]>, Vec<f64>) = sites.map(|site| (site.at, site.height)).unzip();
            let made = Scattered::new(&at, LENGTH * map.spacing).interpolated(&heights, &window, corrections);
            filled(made, if is_land { SHORE } else { -SHORE })
        };
        let land = surface(true, 2);
        progress.step(1.0)?;
        let sea = surface(false, 1);
        progress.step(1.0)?;
        let heights = chosen(&shore, (&land, SHORE..=f32::MAX), (&sea, f32::MIN..=-SHORE));
        let rain = (!map.rain.is_empty()).then(|| {
            let (at, rain): (Vec<[f64; 2]>, Vec<f64>) = map.rain.iter().copied().unzip();
            filled(Scattered::new(&at, LENGTH * map.spacing).interpolated(&rain, &window, 0), 1.0)
        });
        progress.step(1.0)?;
        Ok(Rasters { heights, rain, uplift: Grid::filled(window, 1.0), shore })
    }
}

/// The window of the rasters.
fn window(map: &FmgMap) -> Window {
    // Three digits: the cell is a number in the recipe.
    let step = map.spacing / SAMPLES;
    let unit = libm::pow(10.0, libm::log10(step).floor() - 2.0);
    let cell = ((step / unit).round() * unit * 1e3).round() / 1e3;
    let [width, height] = map.size.map(|length| (length / cell).ceil() as usize + 1 + 2 * MARGIN);
    Window::new(width, height, cell).at(-(MARGIN as i64), -(MARGIN as i64))
}

/// The boundaries of the land.
fn outlines(map: &FmgMap) -> Vec<Outline> {
    let rings = map.coast.iter().flatten();
    rings
        .map(|ring| Outline::of_points(&ring.iter().map(|at| [at[0], at[1], 0.0]).collect::<Vec<_>>()).closed())
        .collect()
}

/// A raster without missing samples; `other` everywhere if there are no others.
fn filled(grid: Grid, other: f32) -> Grid {
    let window = *grid.window();
    let mut samples = grid.into_data();
    fill(&mut samples, window.width, window.height);
    let is_missing = samples.iter().all(|sample| sample.is_nan());
    match Grid::from_data(window, samples) {
        Some(grid) if !is_missing => grid,
        _ => Grid::filled(window, other),
    }
}
