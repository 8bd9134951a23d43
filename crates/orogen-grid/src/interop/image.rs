//! Grids as images of the crate `image` with one channel. The first row of a grid is the top row of the image.

use ::image::{ImageBuffer, Luma, Pixel, Primitive};

use crate::{Grid, Window};

/// A gray image of `T`.
type Gray<T> = ImageBuffer<Luma<T>, Vec<T>>;

impl<T: Copy + Primitive> Grid<T>
where
    Luma<T>: Pixel<Subpixel = T>,
{
    /// The samples as an image, unchanged and without a copy: heights in metres of a `Grid<f32>`, levels of a
    /// `Grid<u8>` or `Grid<u16>`. `None` if a side has more than 2^32 - 1 samples, the maximum of an image.
    #[must_use]
    pub fn into_image(self) -> Option<Gray<T>> {
        let (width, height) = sides(self.window())?;
        ImageBuffer::from_raw(width, height, self.into_data())
    }

    /// A grid over the samples of an image, without a copy; `None` if the image does not have the size of `window`.
    #[must_use]
    pub fn from_image(window: Window, image: Gray<T>) -> Option<Grid<T>> {
        if sides(&window) != Some(image.dimensions()) {
            return None;
        }
        let mut data = image.into_raw();
        data.truncate(window.len());
        Grid::from_data(window, data)
    }
}

impl Grid<f32> {
    /// The heights as a 16-bit image. Heights from `low` to `high` are mapped linearly to 0 ..= 65535 and rounded;
    /// others are clamped. NaN becomes 0. Files exported with `--range LOW,HIGH` have the same levels.
    ///
    /// `None` if `low` and `high` are not two finite numbers in this order, or a side has more samples than an image
    /// can have.
    ///
    /// ```
    /// use orogen_grid::{Grid, Window};
    ///
    /// let heights = vec![-100.0, 0.0, 1000.0, 2000.0];
    /// let grid = Grid::from_data(Window::new(4, 1, 10.0), heights).ok_or("another length")?;
    /// let image = grid.to_image16(0.0, 2000.0).ok_or("no image")?;
    /// assert_eq!(image.as_raw(), &[0, 0, 32768, 65535]);
    /// # Ok::<(), &str>(())
    /// ```
    #[must_use]
    pub fn to_image16(&self, low: f32, high: f32) -> Option<Gray<u16>> {
        let (low, span) = line(low, high)?;
        // Computed in f64, where the difference of two f32 and its product with a level do not overflow.
        let level = |&height: &f32| match height.is_nan() {
            true => 0,
            false => (((f64::from(height) - low) / span).clamp(0.0, 1.0) * LEVELS + 0.5).floor() as u16,
        };
        let (width, height) = sides(self.window())?;
        ImageBuffer::from_raw(width, height, self.data().iter().map(level).collect())
    }

    /// Heights from 16 bits: level 0 is `low`, level 65535 is `high`. The inverse of [`Grid::to_image16`], up to the
    /// rounding to levels.
    ///
    /// `None` if `low` and `high` are not two finite numbers in this order, or the image does not have the size of
    /// `window`.
    #[must_use]
    pub fn from_image16(window: Window, image: &Gray<u16>, low: f32, high: f32) -> Option<Grid> {
        if sides(&window) != Some(image.dimensions()) {
            return None;
        }
        let (low, span) = line(low, high)?;
        let height = |pixel: &Luma<u16>| (low + f64::from(pixel.0[0]) / LEVELS * span) as f32;
        Grid::from_data(window, image.pixels().map(height).collect())
    }
}

/// Maximum level in 16 bits.
const LEVELS: f64 = 65535.0;

/// The lowest height, and the difference between the highest and the lowest.
fn line(low: f32, high: f32) -> Option<(f64, f64)> {
    let valid = low.is_finite() && high.is_finite() && low < high;
    valid.then(|| (f64::from(low), f64::from(high) - f64::from(low)))
}

fn sides(window: &Window) -> Option<(u32, u32)> {
    Some((window.width.try_into().ok()?, window.height.try_into().ok()?))
}

#[cfg(test)]
mod tests {
    use ::image::{ImageBuffer, Luma};

    use super::Gray;
    use crate::{Grid, Window};

    const WINDOW: Window = Window { x: 5, y: -2, width: 3, height: 2, cell: 10.0 };

    #[test]
    fn the_first_row_is_the_uppermost() {
        let grid = Grid::from_data(WINDOW, vec![0u8, 1, 2, 10, 11, 12]).unwrap();
        let image = grid.clone().into_image().unwrap();
        assert_eq!(
            (image.dimensions(), image.get_pixel(2, 0), image.get_pixel(0, 1)),
            ((3, 2), &Luma([2]), &Luma([10]))
        );
        assert_eq!(Grid::from_image(WINDOW, image), Some(grid));
    }

    #[test]
    fn heights_stay_as_they_are() {
        let heights = vec![-3.25f32, 0.0, 1e-20, 8848.86, f32::MAX, -0.0];
        let grid = Grid::from_data(WINDOW, heights).unwrap();
        assert_eq!(Grid::from_image(WINDOW, grid.clone().into_image().unwrap()), Some(grid));
    }

    #[test]
    fn another_size_is_refused() {
        let image: Gray<u8> = ImageBuffer::new(2, 3);
        assert_eq!(Grid::from_image(WINDOW, image), None);
        assert_eq!(Grid::from_image16(WINDOW, &ImageBuffer::new(3, 3), 0.0, 1.0), None);
        let wide = Window::new(1 << 32, 0, 1.0);
        assert!(Grid::filled(wide, 0u8).into_image().is_none());
    }

    #[test]
    fn sixteen_bits_there_and_back() {
        let levels: Vec<u16> = (0..=65535).collect();
        let window = Window::new(256, 256, 1.0);
        for (low, high) in [(0.0, 65535.0), (-431.0, 8848.86), (0.0, 1e-30), (f32::MIN, f32::MAX)] {
            let image: Gray<u16> = ImageBuffer::from_raw(256, 256, levels.clone()).unwrap();
            let grid = Grid::from_image16(window, &image, low, high).unwrap();
            assert_eq!((grid.data()[0], grid.data()[65535]), (low, high));
            assert!(grid.to_image16(low, high).unwrap() == image, "{low} to {high}");
        }
    }

    #[test]
    fn heights_become_the_nearest_level() {
        let window = Window::new(8, 1, 1.0);
        let heights = vec![f32::NEG_INFINITY, -1.0, 0.0, 0.4, 0.6, 65535.0, f32::INFINITY, f32::NAN];
        let grid = Grid::from_data(window, heights).unwrap();
        assert_eq!(grid.to_image16(0.0, 65535.0).unwrap().into_raw(), [0, 0, 0, 0, 1, 65535, 65535, 0]);
        for (low, high) in [(1.0, 1.0), (2.0, 1.0), (f32::NAN, 1.0), (0.0, f32::INFINITY)] {
            assert!(grid.to_image16(low, high).is_none(), "{low} to {high}");
        }
    }
}
