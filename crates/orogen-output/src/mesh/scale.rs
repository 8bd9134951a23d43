//! The scale of a solid for printing.

use super::surface::Surface;

/// Conversion from samples to millimetres.
pub(super) struct Scale {
    /// Millimetres per metre.
    pub scale: f64,
    /// The height at the top of the base, in metres.
    lowest: f64,
    /// Thickness of the base in millimetres.
    pub base: f64,
}

impl Scale {
    /// The scale of a solid with this length of the longer side on a base of this thickness, both in millimetres. Its
    /// lowest point is the lowest sample of the surface, or `cut`, the level in metres at which the surface is cut.
    pub fn new(surface: &Surface, [size, base]: [f64; 2], cut: Option<f64>) -> Scale {
        let window = surface.grid.window();
        let [east, south] = [window.width, window.height].map(|samples| (samples - 1) as f64 * window.cell);
        let [least, _] = surface.bounds();
        let lowest = cut.map_or(f64::from(least[1]), |level| level * f64::from(surface.exaggeration));
        Scale { scale: size / east.max(south), lowest, base }
    }

    /// The position of a sample of the surface.
    pub fn place(&self, surface: &Surface, column: usize, row: usize) -> [f32; 3] {
        let grid = surface.grid;
        let [_, height, _] = surface.place(column, row);
        let along = |steps: usize| (steps as f64 * grid.window().cell * self.scale) as f32;
        let up = self.base + (f64::from(height) - self.lowest) * self.scale;
        [along(column), along(grid.height() - 1 - row), up as f32]
    }
}
