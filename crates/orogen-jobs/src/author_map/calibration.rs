//! The uplift with which the heights of the world follow those of the map.
//!
//! The height of a place is the sum of the slopes along its river, and these grow with the uplift. So there is no
//! formula of one height for the uplift of the other: the world is made coarsely, compared with the map's cells, and
//! the uplift is multiplied by the ratio of the heights, smoothed, again and again.

use std::ops::RangeInclusive;
use std::sync::Arc;

use orogen_engine::recipe::document::Recipe;
use orogen_engine::session;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;
use orogen_grid::progress::Progress;
use orogen_grid::scattered::{Scattered, means_above, multiplied};
use orogen_io::dem::PreparedDem;
use orogen_io::format::dem::Dem;
use orogen_io::format::drawing::{Drawing, Format};
use orogen_io::format::fmg::FmgMap;
use orogen_io::format::outlines::DrawingKind;

use super::job::internal;
use super::rasters::{LENGTH, Rasters};
use super::recipe::Template;
use super::{files, layers};

/// Number of corrections.
const CORRECTIONS: usize = 8;

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
    let cell = cell(map, template);
    let mut best: Option<(Calibration, Grid)> = None;
    progress.expect((CORRECTIONS + 1) as f64);
    for round in 0..=CORRECTIONS {
        let mut recipe = recipe.clone();
        hold(&mut recipe, files::UPLIFT, &rasters.uplift)?;
        let world = World::with_options(recipe, session::Options { store: None, ..limits.clone() })?;
        let window = world.full_window(cell)?;
        let mut grids = world.grids(&[HEIGHT], &window, &progress.part(1.0))?;
        let heights = grids.pop().ok_or_else(|| internal("a plan of a layer made none"))?;
        let made = world.install(|| means_above(&heights, 0.0, &at, AROUND * map.spacing));
        let pairs: Vec<(f64, f64)> =
            made.iter().zip(&wanted).filter(|(made, _)| made.is_finite()).map(|(made, wanted)| (*made, *wanted)).collect();
        let found = Calibration::of(&pairs);
        if best.as_ref().is_none_or(|(best, _)| found.error < best.error) {
            best = Some((found, rasters.uplift.clone()));
        }
        if round == CORRECTIONS || pairs.is_empty() {
            break;
        }
        let known = at.iter().zip(made.iter().zip(&wanted)).filter(|(_, (made, _))| made.is_finite());
        let (at, ratios): (Vec<[f64; 2]>, Vec<f64>) =
            known.map(|(at, (made, wanted))| (*at, SHARE * logarithm(*made, *wanted))).unzip();
        let correction = Scattered::new(&at, LENGTH * map.spacing).interpolated(&ratios, rasters.uplift.window(), 0);
        rasters.uplift = multiplied(&rasters.uplift, &correction, UPLIFTS);
    }
    let (calibration, uplift) = best.ok_or_else(|| internal("no calibration was made"))?;
    rasters.uplift = uplift;
    Ok(calibration)
}

/// The recipe with its files in memory, without detail of the coast: the heights are those of the drawn land.
fn draft(map: &FmgMap, rasters: &Rasters, template: &Template) -> Result<Recipe> {
    let mut recipe = Recipe::parse_with(&template.text(map), "the new recipe", &[(super::recipe::DETAIL.into(), 0.0)])?;
    let coast = layers::coast(map);
    let mut text = Vec::new();
    files::write_geojson(&mut text, &coast).map_err(|cause| internal(&cause.to_string()))?;
    let text = String::from_utf8(text).map_err(|cause| internal(&cause.to_string()))?;
    let drawing = Drawing::parse(&text, Format::GeoJson, DrawingKind::Areas).map_err(|why| internal(&why))?;
    let drawing = Arc::new(drawing);
    recipe.change(|node| {
        for file in node.files().into_iter().filter(|file| file.path().ends_with(files::COAST)) {
            file.hold_drawing(Arc::clone(&drawing));
        }
    });
    hold(&mut recipe, files::HEIGHTS, &rasters.heights)?;
    if let Some(rain) = &rasters.rain {
        hold(&mut recipe, files::RAIN, rain)?;
    }
    Ok(recipe)
}

/// Puts a raster in place of a file.
fn hold(recipe: &mut Recipe, name: &str, grid: &Grid) -> Result<()> {
    let window = grid.window();
    let dem = Dem::new([window.width, window.height], grid.data().to_vec(), None).map_err(|why| internal(&why.to_string()))?;
    let ground = PreparedDem::of(dem, Some(window.cell), u64::MAX).map_err(|why| internal(&why))?;
    let ground = Arc::new(ground);
    recipe.change(|node| {
        for file in node.files().into_iter().filter(|file| file.path().ends_with(name)) {
            file.hold(Arc::clone(&ground));
        }
    });
    Ok(())
}

/// The cell of the compared heights: that of a level.
fn cell(map: &FmgMap, template: &Template) -> f64 {
    let mut cell = template.coarsest();
    while cell > map.spacing / SAMPLES && cell > template.cell() {
        cell /= 2.0;
    }
    while (map.size[0] / cell) * (map.size[1] / cell) > MAX_SAMPLES {
        cell *= 2.0;
    }
    cell.min(map.size[0]).min(map.size[1])
}

fn logarithm(made: f64, wanted: f64) -> f64 {
    libm::log((wanted + OFFSET) / (made.max(0.0) + OFFSET)).clamp(-MAX_LOGARITHM, MAX_LOGARITHM)
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
