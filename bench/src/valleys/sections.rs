//! Cross sections of valleys: the exponent b of height = a distance^b (Svensson 1959), 1 in a V and 2 in a parabola.

use orogen::Grid;

use super::network::Network;

/// Drainage areas, in km², of the rivers whose valleys are measured.
const AREAS: [f64; 2] = [5.0, 300.0];

/// Every how many-th cell of a river is measured.
const EVERY: usize = 4;

/// Distance, in metres, over which the direction of a river is measured, up and down.
const REACH: f64 = 400.0;

/// Maximum length of a wall, in metres.
const LONGEST: f64 = 3000.0;

/// Minimum height of a wall, in metres.
const LOWEST: f64 = 60.0;

/// Ratio between the distances at which a wall is sampled.
const STEP: f64 = 1.2;

/// Minimum number of samples of a wall.
const SAMPLES: usize = 5;

/// The exponents of all walls.
pub fn exponents(heights: &Grid, network: &Network) -> Vec<f64> {
    let rivers = (0..network.area.len()).filter(|cell| (AREAS[0]..AREAS[1]).contains(&network.area[*cell]));
    let chosen = rivers.filter(|cell| (cell % network.width + cell / network.width).is_multiple_of(EVERY));
    chosen.flat_map(|cell| walls(heights, network, cell)).flatten().collect()
}

/// The exponents of the two walls of a valley.
fn walls(heights: &Grid, network: &Network, cell: usize) -> [Option<f64>; 2] {
    let ends = [&network.donor, &network.receiver].map(|links| network.along(links, cell, REACH));
    let [Some((up, _)), Some((down, _))] = ends else { return [None, None] };
    let ([ux, uy], [dx, dy]) = (network.place(up), network.place(down));
    let length = (dx - ux).hypot(dy - uy);
    // A river that turns back has no direction.
    if length * network.cell < REACH {
        return [None, None];
    }
    let across = [-(dy - uy) / length, (dx - ux) / length];
    let place = network.place(cell);
    [1.0, -1.0].map(|side| {
        let at = |metres: f64| {
            let cells = side * metres / network.cell;
            sample(heights, [place[0] + across[0] * cells, place[1] + across[1] * cells])
        };
        exponent(at, network.cell)
    })
}

/// The exponent of a wall whose height is a function of the distance from the river, both in metres.
fn exponent(at: impl Fn(f64) -> Option<f64>, cell: f64) -> Option<f64> {
    let bed = at(0.0)?;
    let mut points = Vec::new();
    let mut highest = (0.0, 0);
    let mut distance = cell;
    while distance <= LONGEST {
        let Some(height) = at(distance).map(|height| height - bed) else { break };
        // Beyond a ridge is another valley.
        if height < 0.9 * highest.0 - 5.0 {
            break;
        }
        points.push((distance, height));
        if height > highest.0 {
            highest = (height, points.len());
        }
        distance *= STEP;
    }
    points.truncate(highest.1);
    // A step of a metre is no part of the form.
    let logarithms: Vec<(f64, f64)> =
        points.into_iter().filter(|(_, height)| *height >= 1.0).map(|(x, height)| (x.ln(), height.ln())).collect();
    if highest.0 < LOWEST || logarithms.len() < SAMPLES {
        return None;
    }
    Some(slope(&logarithms))
}

/// The slope of the line of least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / n, y + point.1 / n));
    let sums = points
        .iter()
        .fold((0.0, 0.0), |(xy, xx), point| (xy + (point.0 - x) * (point.1 - y), xx + (point.0 - x) * (point.0 - x)));
    sums.0 / sums.1
}

/// A height between samples, bilinear; none beyond the grid.
fn sample(heights: &Grid, [x, y]: [f64; 2]) -> Option<f64> {
    if x < 0.0 || y < 0.0 {
        return None;
    }
    let (i, j) = (x as usize, y as usize);
    if i + 1 >= heights.width() || j + 1 >= heights.height() {
        return None;
    }
    let (u, v) = (x - i as f64, y - j as f64);
    let at = |i: usize, j: usize| f64::from(heights[(i, j)]);
    let rows = [0, 1].map(|row| at(i, j + row) * (1.0 - u) + at(i + 1, j + row) * u);
    let height = rows[0] * (1.0 - v) + rows[1] * v;
    height.is_finite().then_some(height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::Window;

    #[test]
    fn the_exponent_of_a_valley_is_found() {
        for b in [1.0, 1.5, 2.0] {
            let found = exponent(|x| Some(100.0 + 400.0 * (x / 1500.0).powf(b)), 30.0).expect("a high wall");
            assert!((found - b).abs() < 0.01, "{found} for {b}");
        }
        assert_eq!(exponent(|x| Some(x * 0.01), 30.0), None);
    }

    #[test]
    fn a_river_in_a_valley_of_a_known_form() {
        // It falls to the south along the middle column, and its sources lie beyond the northern border.
        let window = Window::new(121, 200, 50.0);
        let height = |cell: usize| {
            let (i, j) = (cell % window.width, cell / window.width);
            let x = (i as f64 - 60.0).abs() * 50.0;
            (500.0 * (x / 2000.0).powf(1.5) + (200 - j) as f64 * 0.5) as f32
        };
        let heights = Grid::from_data(window, (0..window.len()).map(height).collect()).expect("a sample for each cell");
        let found = exponents(&heights, &Network::new(&heights));
        assert!(found.len() > 20, "{}", found.len());
        assert!(found.iter().all(|b| (b - 1.5).abs() < 0.1), "{found:?}");
    }
}
