//! A color bar in the corner of a picture, in the style of map sheets.

use orogen_grid::error::Result;
use orogen_io::palette::tint::Tint;
use orogen_output::sheet::font_set::FontSet;
use orogen_output::sheet::furniture::{COLORS, Desk};
use orogen_output::sheet::geometry::{Point, Rect, Size};
use orogen_output::sheet::options::PageColors;
use orogen_output::sheet::raster;
use orogen_output::sheet::scene::{Scene, polygon};

/// Size of the panel, space around it and within it, in millimetres.
const PANEL: Size = Size::new(COLORS + 3.0, 12.5);
const MARGIN: f32 = 4.0;
const PADDING: [f32; 2] = [4.5, 3.0];

/// Opacity of the panel.
const COVER: f32 = 0.8;

/// Share of the picture's width for the panel, its maximum, and the pixels of a millimetre that make its numbers
/// legible.
const SHARE: f32 = 0.38;
const MOST: f32 = 0.9;
const LEGIBLE: f32 = 4.2;

/// Maximum share of the picture's height.
const HEIGHT: f32 = 0.3;

/// A color bar of heights in the lower left corner of pictures.
pub struct ColorBar {
    scene: Scene,
}

impl ColorBar {
    /// The bar of a tint between two heights in metres.
    ///
    /// # Errors
    /// If the built-in font cannot be read.
    pub fn new(tint: &Tint, ends: [f64; 2]) -> Result<ColorBar> {
        let letters = FontSet::for_texts([])?;
        let colors = PageColors::default();
        let Size { width, height } = PANEL;
        let scene = Scene::new(Size::new(width + 2.0 * MARGIN, height + 2.0 * MARGIN), String::new());
        let mut desk = Desk { scene, letters: &letters, colors };
        let panel = Rect::new(MARGIN, MARGIN, width, height);
        desk.scene.area(polygon(panel.corners()), colors.page, COVER);
        let [right, down] = PADDING;
        desk.colors(panel.corner().moved(right, down), COLORS, tint, ends);
        Ok(ColorBar { scene: desk.scene })
    }

    /// Draws the bar over rows from `top` of a picture of this size: three bytes for each pixel.
    pub fn draw(&self, [width, height]: [usize; 2], top: usize, bytes: &mut [u8]) {
        let (wide, high) = (width as f32, height as f32);
        let Size { width: across, height: down } = self.scene.size;
        let pixels = (SHARE * wide / across).max(LEGIBLE).min(MOST * wide / across).min(HEIGHT * high / down);
        let corner = Point::new(0.0, high - down * pixels);
        raster::draw_over(&self.scene, pixels, corner, top, width, bytes);
    }
}
