//! Affine transforms from columns and rows of a raster to coordinates.

/// East = a column + b row + c, north = d column + e row + f, for sample positions (pixel centers).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Affine(pub [f64; 6]);

/// Larger coordinates are treated as damage: the circumference of the Earth is 4e10 mm.
const MAX_COORDINATE: f64 = 1e12;

/// The samples of a north-up raster.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// East and north of the north-west sample.
    pub origin: [f64; 2],
    /// Distance between columns eastward and between rows southward, in map units; both positive.
    pub step: [f64; 2],
    /// Whether the file's first row is the southernmost.
    pub from_south: bool,
}

impl Affine {
    /// Creates a transform from six numbers in GDAL's order, which refer to pixel corners: west, column step, 0, north,
    /// 0, row step (negative if rows run southward).
    #[must_use]
    pub fn of_geotransform([c, a, b, f, d, e]: [f64; 6]) -> Affine {
        Affine([a, b, c + 0.5 * (a + b), d, e, f + 0.5 * (d + e)])
    }

    /// The six numbers in GDAL's order, which refer to pixel corners.
    #[must_use]
    pub fn geotransform(&self) -> [f64; 6] {
        let [a, b, c, d, e, f] = self.0;
        [c - 0.5 * (a + b), a, b, f - 0.5 * (d + e), d, e]
    }

    /// The transform of another raster, whose column k is at column `scale[0] * k + offset[0]` of this one; likewise
    /// for rows.
    #[must_use]
    pub fn resampled(&self, scale: [f64; 2], offset: [f64; 2]) -> Affine {
        let [a, b, c, d, e, f] = self.0;
        let ([x, y], [dx, dy]) = (scale, offset);
        Affine([a * x, b * y, a * dx + b * dy + c, d * x, e * y, d * dx + e * dy + f])
    }

    /// The position of a raster of `rows` rows.
    ///
    /// # Errors
    /// A message if the raster is rotated or mirrored, or the numbers are not valid coordinates.
    pub fn lattice(&self, rows: usize) -> Result<Lattice, String> {
        let [a, b, c, d, e, f] = self.0;
        if !self.0.iter().all(|number| number.is_finite()) || a <= 0.0 || e == 0.0 {
            return Err("its georeference is not a valid lattice".into());
        }
        if b.abs() > 1e-9 * a.abs() || d.abs() > 1e-9 * e.abs() {
            return Err("its rows are rotated; convert it to north-up first, for example with gdalwarp".into());
        }
        let from_south = e > 0.0;
        let north = if from_south { f + e * (rows as f64 - 1.0) } else { f };
        if let Some(far) = [c, north, a, e].into_iter().find(|at| at.is_nan() || at.abs() > MAX_COORDINATE) {
            return Err(format!("its georeference is invalid: a coordinate or cell size of {far:e} is not on a map"));
        }
        Ok(Lattice { origin: [c, north], step: [a, e.abs()], from_south })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_and_middles() {
        let affine = Affine::of_geotransform([100.0, 10.0, 0.0, 500.0, 0.0, -20.0]);
        assert_eq!(affine.0, [10.0, 0.0, 105.0, 0.0, -20.0, 490.0]);
        assert_eq!(affine.geotransform(), [100.0, 10.0, 0.0, 500.0, 0.0, -20.0]);
        let lattice = affine.lattice(4).unwrap();
        assert_eq!(lattice, Lattice { origin: [105.0, 490.0], step: [10.0, 20.0], from_south: false });
        let half = affine.resampled([0.5, 0.5], [-0.25, 1.0]);
        assert_eq!(half.0, [5.0, 0.0, 102.5, 0.0, -10.0, 470.0]);
        let turned = Affine([10.0, 0.0, 105.0, 0.0, 20.0, 490.0]).lattice(4).unwrap();
        assert_eq!((turned.origin, turned.from_south), ([105.0, 550.0], true));
        assert!(Affine([10.0, 1.0, 0.0, 0.0, -10.0, 0.0]).lattice(4).unwrap_err().contains("rotated"));
        assert!(Affine([-10.0, 0.0, 0.0, 0.0, -10.0, 0.0]).lattice(4).is_err());
        assert!(Affine([10.0, 0.0, 1e300, 0.0, -10.0, 0.0]).lattice(4).unwrap_err().contains("1e300 is not on a map"));
        assert!(Affine([10.0, 0.0, f64::NAN, 0.0, -10.0, 0.0]).lattice(4).is_err());
    }
}
