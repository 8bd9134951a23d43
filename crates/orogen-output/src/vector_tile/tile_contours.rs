//! Contours of the heights of a tile.

use orogen_grid::contour::levels::{is_index, levels_every};
use orogen_grid::contour::trace;
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;
use orogen_io::format::features::Value;
use orogen_io::format::levels::{NO_SAMPLES, extremes};
use orogen_io::format::mvt::{TileFeature, TileGeometry};

use super::frame::lines_of;

/// Minimum distance of contours on ground with a slope of 1, in samples.
const APART: f64 = 2.5;

/// The default contour interval of tiles whose samples are `cell` metres apart: 1, 2 or 5 times a power of ten, so that
/// contours on ground with a slope of 45 degrees are at least 2.5 samples apart.
#[must_use]
pub fn default_interval(cell: f64) -> f64 {
    let least = APART * cell;
    let power = libm::pow(10.0, libm::log10(least).floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|step| step * power)
        .find(|step| *step >= least * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

/// The contours of a grid as features, one per height: the height, and whether it is an index contour. Columns and rows
/// of the grid's window are in samples from the north-west corner of the tile, with `unit` units of the tile per
/// sample, and the first sample `shift` samples from the corner.
///
/// # Errors
/// If the interval gives too many contours.
pub fn contours(heights: &Grid, interval: f64, unit: f64, shift: f64) -> Result<Vec<TileFeature>> {
    let range = extremes(NO_SAMPLES, heights.data());
    let levels = levels_every(interval, f64::from(range[0]), f64::from(range[1]))?;
    let found = trace::contours(heights, &levels)?;
    let mut features = Vec::new();
    for lines in found.chunk_by(|a, b| a.level == b.level) {
        let path = |line: &orogen_grid::contour::line::Line| {
            line.path().map(|[x, y]| [(x + shift) * unit, (y + shift) * unit]).collect::<Vec<_>>()
        };
        let whole: Vec<_> = lines.iter().flat_map(|line| lines_of(&path(line))).collect();
        let Some(height) = lines.first().map(|line| line.elevation).filter(|_| !whole.is_empty()) else { continue };
        features.push(TileFeature {
            geometry: TileGeometry::Lines(whole),
            values: vec![Value::Real(height), Value::Boolean(is_index(height, interval))],
        });
    }
    Ok(features)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    #[test]
    fn intervals_are_round_and_grow_with_the_cell() {
        for (cell, expect) in [(4.78, 20.0), (2.0, 5.0), (2.1, 10.0), (0.2, 0.5), (9.55, 50.0), (150.0, 500.0)] {
            assert!((default_interval(cell) / expect - 1.0).abs() < 1e-9, "{cell}: {}", default_interval(cell));
        }
    }

    #[test]
    fn contours_of_adjacent_tiles_meet() {
        // Rolling ground, far from the origin of its tiles.
        let height = |i: i64, j: i64| 40.0 * libm::sin(i as f64 / 23.0) * libm::cos(j as f64 / 17.0) + j as f64 / 8.0;
        let tile = |column: i64, shift: f64| {
            let window = Window::new(530, 530, 1.0).at(-9, -9);
            let data = (0..530 * 530).map(|k| height(column * 512 + k % 530 - 9, k / 530 - 9) as f32).collect();
            contours(&Grid::from_data(window, data).unwrap(), 10.0, 8.0, shift).unwrap()
        };
        for shift in [0.0, 0.5] {
            let border = |features: Vec<TileFeature>, side: i32| -> Vec<(String, i32)> {
                let mut found: Vec<(String, i32)> = Vec::new();
                for feature in features {
                    let TileGeometry::Lines(lines) = feature.geometry else { panic!() };
                    for three in lines.iter().flat_map(|line| line.windows(3)) {
                        // A point that only rounds to the side is in one of the tiles.
                        let [before, at, after] = [0, 1, 2].map(|k| (three[k][0] - side).signum());
                        if at == 0 && before * after < 0 && (0..4096).contains(&three[1][1]) {
                            found.push((format!("{:?}", feature.values), three[1][1]));
                        }
                    }
                }
                found.sort();
                found
            };
            let (west, east) = (border(tile(0, shift), 4096), border(tile(1, shift), 0));
            assert!(west.len() > 10, "{}", west.len());
            assert_eq!(west, east);
        }
    }
}
