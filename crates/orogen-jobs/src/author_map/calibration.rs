//! The uplift with which the heights of the world follow those of the map.
//!
//! The height of a place is the sum of the slopes along its river, and these grow with the uplift. So there is no
//! formula of one height for the uplift of the other: the world is made coarsely, compared with the map's cells, and
//! the uplift is multiplied by the ratio of the heights, smoothed, again and again. Finer levels raise the mean height,
//! because ridges grow between the rivers; by how much is found around a few cells.

use std::ops::RangeInclusive;
use std::sync::Arc;

use orogen_engine::recipe::document::Recipe;
use orogen_engine::session;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::scattered::{Scattered, means_above, multiplied};
use orogen_io::dem::PreparedDem;
use orogen_io::format::dem::Dem;
use orogen_io::format::drawing::{Drawing, Format};
use orogen_io::format::features::FeatureLayer;
use orogen_io::format::fmg::FmgMap;
use orogen_io::format::outlines::DrawingKind;

use super::rasters::{LENGTH, Rasters};
use super::recipe::Template;
use super::{files, layers};

/// Number of corrections, before and after finer levels are compared.
const CORRECTIONS: usize = 5;

/// Share of the logarithm of the ratio by which the uplift is corrected.
const SHARE: f64 = 0.8;

/// Added to both heights of a ratio, in metres.
const OFFSET: f64 = 30.0;

/// Maximum logarithm of a ratio.
const MAX_LOGARITHM: f64 = 1.5;

/// Range of the uplift for a kilometre of height.
const UPLIFTS: RangeInclusive<f32> = 0.01..=300.0;

/// The distance over which heights of the world are averaged around a cell, in distances between cells.
const AROUND: f64 = 0.5;

/// Samples of the world per distance between cells, at least.
const SAMPLES: f64 = 3.0;

/// Samples per distance between cells where finer levels are compared with coarser ones, at least.
const FINE_SAMPLES: f64 = 100.0;

/// Number of cells of the map around which levels are compared.
const WINDOWS: usize = 16;

/// The work for it, relative to that of a correction.
const WINDOWS_WORK: f64 = 5.0;

/// Maximum logarithm of the change from one level to others.
const MAX_TREND: f64 = 0.8;

/// Maximum number of samples of the world.
const MAX_SAMPLES: f64 = 4e6;

/// How the heights of a world follow those of the map's cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration {
    /// Correlation of the heights.
    pub correlation: f64,
    /// Median of the ratios of the heights.
    pub ratio: f64,
    /// Root of the mean square of the logarithms of the ratios.
    pub error: f64,
}

/// Corrects the uplift of the rasters.
pub fn calibrated(
    map: &FmgMap,
    rasters: &mut Rasters,
    template: &Template,
    limits: &session::Options,
    progress: &Progress,
) -> Result<Calibration> {
    let land = map.sites.iter().filter(|site| site.water.is_none());
    let (at, wanted): (Vec<[f64; 2]>, Vec<f64>) = land.map(|site| (site.at, site.height)).unzip();
    let recipe = draft(map, rasters, template)?;
    let limits = session::Options { store: None, ..limits.clone() };
    let coarse = level(template, map.size, map.spacing / SAMPLES, MAX_SAMPLES);
    let mut work =
        Work { map, at, wanted, recipe, limits, coarse, uplift: rasters.uplift.clone(), trend: Trend::default() };
    progress.expect((2 * CORRECTIONS + 2) as f64 + WINDOWS_WORK);
    work.correct(progress)?;
    let fine = level(template, map.size, map.spacing / FINE_SAMPLES, f64::INFINITY);
    work.trend = work.trend_at(fine, &progress.part(WINDOWS_WORK))?;
    let calibration = work.correct(progress)?;
    rasters.uplift = work.uplift;
    Ok(calibration)
}

/// The change of heights from the compared level to finer ones: its logarithm is linear in that of the height.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Trend {
    /// At the height [`OFFSET`] above the sea, and for each factor e of the height.
    start: f64,
    slope: f64,
}

impl Trend {
    /// The logarithm of the change.
    fn at(&self, height: f64) -> f64 {
        (self.start + self.slope * scale(height)).clamp(-MAX_TREND, MAX_TREND)
    }

    /// The least squares of pairs of a height and the logarithm of its change.
    fn of(pairs: &[(f64, f64)]) -> Trend {
        let n = pairs.len().max(1) as f64;
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / n;
        let (x, y) = (mean(&|pair| scale(pair.0)), mean(&|pair| pair.1));
        let spread = mean(&|pair| (scale(pair.0) - x) * (scale(pair.0) - x));
        let slope = mean(&|pair| (scale(pair.0) - x) * (pair.1 - y)) / spread;
        let slope = if spread > 1e-6 { slope } else { 0.0 };
        Trend { start: y - slope * x, slope }
    }
}

fn scale(height: f64) -> f64 {
    libm::log((height.max(0.0) + OFFSET) / OFFSET)
}

/// What is corrected.
struct Work<'a> {
    map: &'a FmgMap,
    /// The cells of the land, and their heights.
    at: Vec<[f64; 2]>,
    wanted: Vec<f64>,
    recipe: Recipe,
    limits: session::Options,
    /// The cell of the compared heights.
    coarse: f64,
    uplift: Grid,
    trend: Trend,
}

impl Work<'_> {
    fn world(&self) -> Result<World> {
        let mut recipe = self.recipe.clone();
        hold(&mut recipe, files::UPLIFT, &self.uplift)?;
        World::with_options(recipe, self.limits.clone())
    }

    /// The mean heights of a world around the cells, on the compared level; NaN where there is little land.
    fn means(&self, world: &World, progress: &Progress) -> Result<Vec<f64>> {
        let heights = heights(world, &world.full_window(self.coarse)?, progress)?;
        Ok(world.install(|| means_above(&heights, 0.0, &self.at, AROUND * self.map.spacing)))
    }

    /// Corrects the uplift several times, and keeps the best one.
    fn correct(&mut self, progress: &Progress) -> Result<Calibration> {
        let mut best: Option<(Calibration, Grid)> = None;
        for round in 0..=CORRECTIONS {
            let mut made = self.means(&self.world()?, &progress.part(1.0))?;
            made.iter_mut().zip(&self.wanted).for_each(|(made, wanted)| *made *= libm::exp(self.trend.at(*wanted)));
            let all = made.iter().zip(&self.wanted).zip(&self.at).filter(|((made, _), _)| made.is_finite());
            let (pairs, at): (Vec<(f64, f64)>, Vec<[f64; 2]>) =
                all.map(|((made, wanted), at)| ((*made, *wanted), *at)).unzip();
            let found = Calibration::of(&pairs);
            if best.as_ref().is_none_or(|(best, _)| found.error < best.error) {
                best = Some((found, self.uplift.clone()));
            }
            if round == CORRECTIONS || pairs.is_empty() {
                break;
            }
            let ratios: Vec<f64> = pairs.iter().map(|(made, wanted)| SHARE * logarithm(*made, *wanted)).collect();
            let scattered = Scattered::new(&at, LENGTH * self.map.spacing);
            self.uplift = multiplied(&self.uplift, &scattered.interpolated(&ratios, self.uplift.window(), 0), UPLIFTS);
        }
        let (calibration, uplift) = best.ok_or_else(|| internal("no calibration was made"))?;
        self.uplift = uplift;
        Ok(calibration)
    }

    /// The change from the compared level to that of the cell `fine`, around some cells of the map: from the lowest to
    /// the highest.
    fn trend_at(&self, fine: f64, progress: &Progress) -> Result<Trend> {
        let world = self.world()?;
        let made = self.means(&world, &progress.part(1.0))?;
        let mut order: Vec<usize> = (0..made.len()).filter(|&k| made[k].is_finite()).collect();
        order.sort_by(|a, b| self.wanted[*a].total_cmp(&self.wanted[*b]).then(a.cmp(b)));
        let chosen = (0..WINDOWS).filter_map(|k| order.get((2 * k + 1) * order.len() / (2 * WINDOWS)));
        let (all, length) = (world.full_window(fine)?, AROUND * self.map.spacing);
        progress.expect((WINDOWS + 1) as f64);
        let mut pairs = Vec::new();
        for &k in chosen {
            let [x, y] = self.at[k].map(|metres| (metres / fine) as i64);
            let around = Window::new(1, 1, fine).at(x, y).grown((2.5 * length / fine) as usize);
            let heights = heights(&world, &around.intersection(&all), &progress.part(1.0))?;
            if let [mean] = *means_above(&heights, 0.0, &[self.at[k]], length)
                && mean.is_finite()
            {
                let change = libm::log((mean + OFFSET) / (made[k].max(0.0) + OFFSET));
                pairs.push((self.wanted[k], change.clamp(-MAX_TREND, MAX_TREND)));
            }
        }
        Ok(Trend::of(&pairs))
    }
}

/// The heights of a window.
fn heights(world: &World, window: &Window, progress: &Progress) -> Result<Grid> {
    world.grids(&[HEIGHT], window, progress)?.pop().ok_or_else(|| internal("a plan of a layer made none"))
}

/// The recipe with its files in memory, without detail of the coast: the heights are those of the drawn land.
fn draft(map: &FmgMap, rasters: &Rasters, template: &Template) -> Result<Recipe> {
    let mut recipe = Recipe::parse_with(&template.text(map), "the new recipe", &[(super::recipe::DETAIL.into(), 0.0)])?;
    draw(&mut recipe, files::COAST, &layers::coast(map), DrawingKind::Areas)?;
    if !map.rivers.is_empty() {
        draw(&mut recipe, files::RIVERS, &layers::rivers(map, &rasters.heights), DrawingKind::Lines)?;
    }
    hold(&mut recipe, files::HEIGHTS, &rasters.heights)?;
    if let Some(rain) = &rasters.rain {
        hold(&mut recipe, files::RAIN, rain)?;
    }
    Ok(recipe)
}

/// Puts features in place of a file.
fn draw(recipe: &mut Recipe, name: &str, layer: &FeatureLayer, kind: DrawingKind) -> Result<()> {
    let mut text = Vec::new();
    files::write_geojson(&mut text, layer).map_err(|cause| internal(&cause.to_string()))?;
    let text = String::from_utf8(text).map_err(|cause| internal(&cause.to_string()))?;
    let drawing = Arc::new(Drawing::parse(text.as_bytes(), Format::GeoJson, None, kind).map_err(|why| internal(&why))?);
    recipe.change(|node| {
        for file in node.files().into_iter().filter(|file| file.path().ends_with(name)) {
            file.hold_drawing(Arc::clone(&drawing));
        }
    });
    Ok(())
}

/// Puts a raster in place of a file.
fn hold(recipe: &mut Recipe, name: &str, grid: &Grid) -> Result<()> {
    let window = grid.window();
    let dem = Dem::new([window.width, window.height], grid.data().to_vec(), None)
        .map_err(|why| internal(&why.to_string()))?;
    let ground = PreparedDem::of(dem, Some(window.cell), u64::MAX).map_err(|why| internal(&why))?;
    let ground = Arc::new(ground);
    recipe.change(|node| {
        for file in node.files().into_iter().filter(|file| file.path().ends_with(name)) {
            file.hold(Arc::clone(&ground));
        }
    });
    Ok(())
}

/// The cell of the first level that is not above `most`, or of one before it if the whole world had more than
/// `samples`.
fn level(template: &Template, size: [f64; 2], most: f64, samples: f64) -> f64 {
    let most = most.min(size[0] / 2.0).min(size[1] / 2.0);
    let mut cell = template.coarsest();
    while cell > most && cell > template.cell() && (size[0] / cell) * (size[1] / cell) * 4.0 <= samples {
        cell /= 2.0;
    }
    cell
}

fn logarithm(made: f64, wanted: f64) -> f64 {
    libm::log((wanted + OFFSET) / (made.max(0.0) + OFFSET)).clamp(-MAX_LOGARITHM, MAX_LOGARITHM)
}

/// The error for what cannot happen.
fn internal(why: &str) -> Error {
    Error::new(ErrorKind::Internal, why)
}

impl Calibration {
    /// Of pairs of heights, of the world and of the map.
    fn of(pairs: &[(f64, f64)]) -> Calibration {
        let n = pairs.len().max(1) as f64;
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / n;
        let means = (mean(&|pair| pair.0), mean(&|pair| pair.1));
        let apart = |pair: &(f64, f64)| (pair.0 - means.0, pair.1 - means.1);
        let product = mean(&|pair| apart(pair).0 * apart(pair).1);
        let [made, wanted] = [mean(&|pair| apart(pair).0 * apart(pair).0), mean(&|pair| apart(pair).1 * apart(pair).1)];
        let correlation = product / (made * wanted).sqrt();
        let mut ratios: Vec<f64> = pairs.iter().map(|(made, wanted)| made / wanted.max(1.0)).collect();
        ratios.sort_by(f64::total_cmp);
        let error = mean(&|(made, wanted)| logarithm(*made, *wanted) * logarithm(*made, *wanted)).sqrt();
        Calibration {
            correlation: if correlation.is_finite() { correlation } else { 1.0 },
            ratio: ratios.get(ratios.len() / 2).copied().unwrap_or(1.0),
            error,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_heights_correlate() {
        let found = Calibration::of(&[(100.0, 100.0), (300.0, 300.0), (200.0, 200.0)]);
        assert!((found.correlation - 1.0).abs() < 1e-12 && found.ratio == 1.0 && found.error == 0.0);
        let half = Calibration::of(&[(50.0, 100.0), (150.0, 300.0), (100.0, 200.0)]);
        assert!((half.correlation - 1.0).abs() < 1e-12 && half.ratio == 0.5 && half.error > 0.3);
        assert_eq!(Calibration::of(&[]), Calibration { correlation: 1.0, ratio: 1.0, error: 0.0 });
    }
}
