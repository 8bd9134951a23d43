//! Resampling of degrees and oblong cells to square cells in metres.

use crate::format::crs::keys::{self, USER_DEFINED};
use crate::format::crs::unit::Unit;
use crate::format::dem::{Dem, Georeference, Part, Placement};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::resample;
use orogen_grid::resample::LayerKind;
use orogen_noise::Points;

/// Steps that differ by less than this share count as equal.
const SQUARE: f64 = 1e-3;

/// Metres per degree of longitude and of latitude at a latitude in degrees, on the WGS 84 ellipsoid (the common cosine
/// series, accurate to a centimetre).
#[must_use]
pub fn metres_of_degrees(latitude: f64) -> [f64; 2] {
    let phi = latitude.clamp(-89.0, 89.0).to_radians();
    let cos = |n: f64| libm::cos(n * phi);
    let longitude = 111_412.84 * cos(1.0) - 93.5 * cos(3.0) + 0.118 * cos(5.0);
    let latitude = 111_132.92 - 559.82 * cos(2.0) + 1.175 * cos(4.0) - 0.0023 * cos(6.0);
    [longitude, latitude]
}

/// Distance between columns and between rows, in metres, at the middle row of `rows`.
#[must_use]
pub fn steps(place: &Placement, rows: usize) -> [f64; 2] {
    match place.unit {
        Unit::Metres(unit) => place.step.map(|step| step * unit),
        Unit::Degrees | Unit::Grads if let Some(cell) = place.cell => [cell; 2],
        Unit::Degrees | Unit::Grads => {
            let degrees = place.unit.degrees().unwrap_or(1.0);
            let middle = place.origin[1] - 0.5 * place.step[1] * (rows as f64 - 1.0);
            let [east, south] = metres_of_degrees(middle * degrees).map(|metres| metres * degrees);
            [place.step[0] * east, place.step[1] * south]
        }
    }
}

/// The resampling of a DEM to a lattice of square cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    /// Columns and rows of the lattice.
    pub size: [usize; 2],
    /// Distance between samples, in metres.
    pub cell: f64,
    /// Columns and rows of the DEM per sample of the lattice.
    pub ratio: [f64; 2],
}

impl Layout {
    /// The lattice for `size` samples with these steps in metres. Its cell is the smaller step, so that no detail is
    /// lost; the other axis is interpolated. Steps that differ by less than a thousandth count as equal.
    #[must_use]
    pub fn new(size: [usize; 2], steps: [f64; 2]) -> Layout {
        let [east, south] = steps;
        if (east - south).abs() <= SQUARE * south {
            return Layout { size, cell: south, ratio: [1.0; 2] };
        }
        let cell = east.min(south);
        let ratio = [cell / east, cell / south];
        let count = |samples: usize, ratio: f64| ((samples as f64 - 1.0) / ratio + 1e-9) as usize + 1;
        Layout { size: [count(size[0], ratio[0]), count(size[1], ratio[1])], cell, ratio }
    }

    /// Map units per metre of the lattice, for a DEM with these steps in map units and in metres. Sides that count as
    /// equal keep their own sizes, so that samples keep their positions on the map; only differences below a thousandth
    /// of a cell over the whole raster are ignored.
    #[must_use]
    pub fn per_metre(&self, steps: [f64; 2], metres: [f64; 2]) -> [f64; 2] {
        let longest = self.size[0].max(self.size[1]) as f64;
        let exact = !self.is_square() || (metres[0] - metres[1]).abs() * longest < 1e-3 * metres[1];
        match exact {
            true => [steps[0] / metres[0], steps[1] / metres[1]],
            false => steps.map(|step| step / self.cell),
        }
    }

    /// The position of the lattice on a map, for a DEM at `place` with these steps in metres.
    #[must_use]
    pub fn georeference(&self, place: &Placement, metres: [f64; 2]) -> Georeference {
        Georeference {
            origin: place.origin,
            per_metre: self.per_metre(place.step, metres),
            // Degrees remain degrees, even if their datum is unknown.
            keys: place.keys.clone().or((place.unit == Unit::Degrees).then(|| keys::of_epsg(USER_DEFINED, true))),
        }
    }

    /// The message that samples are resampled; `None` if they are not.
    #[must_use]
    pub fn note(&self, steps: [f64; 2], degrees: bool) -> Option<String> {
        let what = if degrees { "its degrees, at the middle latitude cells" } else { "its cells" };
        (!self.is_square()).then(|| {
            let [east, south] = steps;
            format!("{what} of {east:.2} x {south:.2} m, were resampled to squares of {:.2} m", self.cell)
        })
    }

    /// Whether samples need no resampling.
    #[must_use]
    pub fn is_square(&self) -> bool {
        self.ratio == [1.0; 2]
    }

    /// The samples of a DEM of `size` columns and rows that a part of the lattice is computed from.
    #[must_use]
    pub fn sources(&self, size: [usize; 2], part: Part) -> Part {
        if self.is_square() {
            return part;
        }
        // The cubic reads one sample before and two after a position.
        let first = |k: usize| ((part.from[k] as f64 * self.ratio[k]) as usize).saturating_sub(2);
        let end = |k: usize| ((part.end()[k] as f64 * self.ratio[k]) as usize).saturating_add(4).min(size[k]);
        let from = [first(0), first(1)];
        Part { from, size: [end(0) - from[0], end(1) - from[1]] }
    }

    /// The heights of a DEM without holes on this lattice, from its north-west corner.
    #[must_use]
    pub fn apply(&self, dem: Dem) -> Option<Grid> {
        self.apply_part(dem, [0; 2], Part::whole(self.size))
    }

    /// The heights of a part of the lattice, from a part of a DEM without holes that starts at column and row `from`.
    #[must_use]
    pub fn apply_part(&self, dem: Dem, from: [usize; 2], part: Part) -> Option<Grid> {
        let at = |[x, y]: [usize; 2]| [x as i64, y as i64];
        let ([x, y], [width, height]) = (at(part.from), part.size);
        let window = Window::new(width, height, self.cell).at(x, y);
        if self.is_square() {
            return Grid::from_data(window, dem.heights);
        }
        let [left, top] = at(from);
        let own = Grid::from_data(Window::new(dem.width, dem.height, 1.0).at(left, top), dem.heights)?;
        let xs: Vec<f64> = (0..width).map(|i| (part.from[0] + i) as f64 * self.ratio[0]).collect();
        let ys: Vec<f64> = (0..height).map(|j| (part.from[1] + j) as f64 * self.ratio[1]).collect();
        let mut out = Grid::filled(window, 0.0);
        resample::read(&own, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, out.data_mut());
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_are_as_long_as_tables_say() {
        for (latitude, east, north) in
            [(0.0, 111_319.5, 110_574.3), (45.0, 78_846.8, 111_131.8), (60.0, 55_800.0, 111_412.2)]
        {
            let [e, n] = metres_of_degrees(latitude);
            assert!((e - east).abs() < 1.0 && (n - north).abs() < 1.0, "{latitude}: {e} {n}");
        }
    }

    #[test]
    fn oblong_cells_become_square_and_a_plane_stays_a_plane() {
        let heights = (0..21 * 11).map(|k| 3.0 * (k % 21) as f32 - 5.0 * (k / 21) as f32).collect();
        let dem = Dem { width: 21, height: 11, heights, place: None, notes: Vec::new() };
        let layout = Layout::new([21, 11], [20.0, 30.0]);
        assert_eq!((layout.size, layout.cell), ([21, 16], 20.0));
        let grid = layout.apply(dem).unwrap();
        for (i, j) in [(0, 0), (20, 0), (7, 9), (13, 12), (20, 15)] {
            let expect = 3.0 * i as f32 - 5.0 * j as f32 * 20.0 / 30.0;
            assert!((grid[(i, j)] - expect).abs() < 0.6, "{i} {j}: {} {expect}", grid[(i, j)]);
        }
        assert!(Layout::new([5, 5], [30.0, 30.01]).is_square());
        // Column 2993 of 3000 is 27 m further east than with cells of 10 m.
        let nearly = Layout::new([3000, 4], [10.009, 10.0]);
        let per_metre = nearly.per_metre([10.009, 10.0], [10.009, 10.0]);
        assert!(nearly.is_square() && (2993.0 * nearly.cell * per_metre[0] - 2993.0 * 10.009).abs() < 1e-6);
        assert_eq!(per_metre[1], 1.0);
        let equal = Layout::new([30, 4], [10.000_000_001, 10.0]);
        assert_eq!(equal.per_metre([10.000_000_001, 10.0], [10.000_000_001, 10.0]), [1.0; 2]);
    }
}
