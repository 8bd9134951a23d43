//! A part of the graph computed at its own cell, whatever cell is requested.

use crate::op::Field;

op! {
    /// The source, computed at a fixed cell and interpolated, whatever cell is requested.
    ///
    /// A filter is computed at the requested cell, so its result differs from cell to cell. After `resample` it is the
    /// same at all cells: finer samples are interpolated as the source's layer is (heights by a cubic), and coarser
    /// ones are samples of the fixed cell, bit for bit where the two lattices coincide. `bake` does the same for a
    /// whole bounded world; this op computes only what a window needs, also in unbounded worlds. A request with a
    /// larger cell computes (requested cell / cell)^2 samples of the source for each of its own, until `max_ratio` is
    /// reached. Detail finer than the cell is lost.
    pub struct Resample = "resample", field, revision 1;
    inputs {
        /// The values to compute at the fixed cell.
        source: required,
    }
    params {
        /// The cell at which the source is computed; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
        /// Maximum ratio of the requested cell and the one at which the source is computed. At larger requested cells
        /// the source is computed at 2, 4, 8 ... times `cell`, the smallest that keeps this ratio.
        max_ratio: f64 = 8.0, range 1.0 to 64.0;
    }
    layers {
        /// The interpolated source.
        resampled: source;
    }
}

impl Field for Resample {
    fn source_cell(&self, requested: f64, world_cell: f64) -> Option<f64> {
        let mut cell = if self.cell > 0.0 { self.cell } else { world_cell };
        while requested > cell * self.max_ratio {
            cell *= 2.0;
        }
        Some(cell)
    }

    fn cost(&self) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cell_grows_only_where_the_ratio_would_be_too_large() {
        let op = Resample { cell: 20.0, ..Resample::default() };
        for (requested, cell) in
            [(1e-6, 20.0), (20.0, 20.0), (33.0, 20.0), (160.0, 20.0), (160.1, 40.0), (320.0, 40.0), (7680.0, 1280.0)]
        {
            assert_eq!(op.source_cell(requested, 30.0), Some(cell), "{requested}");
        }
        assert_eq!(Resample::default().source_cell(240.0, 30.0), Some(30.0));
        let op = Resample { max_ratio: 1.0, ..op };
        assert_eq!([19.0, 20.0, 21.0].map(|cell| op.source_cell(cell, 1.0)), [20.0, 20.0, 40.0].map(Some));
        // A cell that is not finite is rejected with its window; planning only has to terminate.
        assert_eq!(op.source_cell(f64::INFINITY, 1.0), Some(f64::INFINITY));
    }
}
