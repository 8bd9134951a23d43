//! The pictures of `orogen variants`, with the same colors and light, and the page that shows them side by side.

use std::borrow::Cow;

use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::words::shortened;
use orogen_io::palette::palette::Palette;
use orogen_io::palette::tint::Tint;

use super::canvas::{Canvas, Ink};
use super::paint::Painter;
use super::text::{BuiltinFont, Face, Style};

const PAPER: Ink = [253, 252, 249];
const INK: Ink = [28; 3];
const SOFT: Ink = [97; 3];
const LINE: Ink = [194; 3];

/// Dimensions in pixels.
const MARGIN: usize = 44;
const GUTTER: usize = 20;
const HEADER: usize = 74;
const CAPTION: usize = 46;
const FOOTER: usize = 34;

/// The texts of the page.
pub struct Sheet {
    /// The heading.
    pub title: String,
    /// The line below the heading.
    pub about: String,
    /// The line at the foot.
    pub footer: String,
    /// Height of the sea level, in metres.
    pub sea_level: f64,
    /// The palette, over the heights of all pictures; by default that of the relief map.
    pub palette: Option<Palette>,
}

/// A picture of the page.
pub struct Variant {
    /// The label.
    pub label: String,
    /// The heights.
    pub grid: Grid,
    /// A picture that replaces the relief map.
    pub picture: Option<Drawn>,
}

/// A picture that was drawn elsewhere, such as a render.
pub struct Drawn {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Red, green and blue of each pixel.
    pub bytes: Vec<u8>,
}

impl Sheet {
    /// The painter of the maps, with the same colors and light for all pictures. Making it takes [`fitting`] bytes of
    /// memory.
    #[must_use]
    pub fn painter(&self, variants: &[Variant]) -> Painter {
        let all = together(variants);
        match &self.palette {
            Some(palette) => Painter::with_tint(Tint::of(palette, &all, self.sea_level as f32), &all, self.sea_level),
            None => Painter::fit(&all, self.sea_level),
        }
    }
}

impl Variant {
    /// Width and height of the picture, in pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.picture.as_ref().map_or([self.grid.width(), self.grid.height()], |picture| picture.size)
    }

    /// Red, green and blue of each pixel of the picture. `painter` comes from [`Sheet::painter`].
    #[must_use]
    pub fn pixels(&self, painter: &Painter) -> Cow<'_, [u8]> {
        if let Some(picture) = &self.picture {
            return Cow::Borrowed(&picture.bytes);
        }
        let mut painted = vec![0; 3 * self.grid.width() * self.grid.height()];
        painter.paint(&self.grid, 0..self.grid.height(), &mut painted);
        Cow::Owned(painted)
    }
}

/// The lowest and the highest of all heights; `None` if there are none.
#[must_use]
pub fn range(variants: &[Variant]) -> Option<[f64; 2]> {
    let all = variants.iter().flat_map(|variant| variant.grid.data()).copied().filter(|height| height.is_finite());
    let [low, high] = all.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)]);
    (low < high).then_some([f64::from(low), f64::from(high)])
}

/// Memory for fitting colors and light to all pictures, in bytes.
#[must_use]
pub fn fitting(variants: &[Variant]) -> u64 {
    variants.iter().map(|variant| size_of_val(variant.grid.data()) as u64).sum()
}

/// Number of pictures per row, and the size of the largest one.
struct Layout {
    columns: usize,
    rows: usize,
    cell: [usize; 2],
}

fn layout(variants: &[Variant], columns: Option<usize>) -> Layout {
    let count = variants.len().max(1);
    let square = (1..=count).find(|columns| columns * columns >= count).unwrap_or(1);
    let columns = columns.unwrap_or(square).min(count);
    let largest = |side: usize| variants.iter().map(|variant| variant.size()[side]).max().unwrap_or(1);
    Layout { columns, rows: count.div_ceil(columns), cell: [largest(0), largest(1)] }
}

/// The size of the page.
#[must_use]
pub fn size(variants: &[Variant], columns: Option<usize>) -> [usize; 2] {
    let Layout { columns, rows, cell } = layout(variants, columns);
    [2 * MARGIN + columns * cell[0] + (columns - 1) * GUTTER, 2 * MARGIN + HEADER + rows * (cell[1] + CAPTION) + FOOTER]
}

/// Draws the page.
///
/// # Errors
/// If the font cannot be loaded.
pub fn draw(sheet: &Sheet, variants: &[Variant], columns: Option<usize>) -> Result<Canvas> {
    let [width, height] = size(variants, columns);
    let layout = layout(variants, columns);
    let font = BuiltinFont::new()?;
    let mut canvas = Canvas::new(width, height, PAPER);
    let style = |face, size: f32, ink| Style { face, size, ink };
    let (bold, plain) = (style(Face::Bold, 15.0, INK), style(Face::Regular, 13.0, SOFT));
    let fitted = |text: &str, style: Style, room: usize| shortened(text, room as f32, |text| font.width(text, style));
    let inner = width - 2 * MARGIN;
    let heading = style(Face::Bold, 28.0, INK);
    let about = style(Face::Regular, 15.0, SOFT);
    font.write(&mut canvas, MARGIN as f32, (MARGIN + 22) as i64, &fitted(&sheet.title, heading, inner), heading);
    font.write(&mut canvas, MARGIN as f32, (MARGIN + 48) as i64, &fitted(&sheet.about, about, inner), about);
    let painter = sheet.painter(variants);
    for (k, variant) in variants.iter().enumerate() {
        let (Variant { label, grid, .. }, [across, down]) = (variant, variant.size());
        let (row, column) = (k / layout.columns, k % layout.columns);
        let left = MARGIN + column * (layout.cell[0] + GUTTER);
        let top = MARGIN + HEADER + row * (layout.cell[1] + CAPTION);
        picture(&mut canvas, &painter, variant, [left, top]);
        let baseline = top + down;
        let label = fitted(label, bold, across);
        let end = font.write(&mut canvas, left as f32, (baseline + 21) as i64, &label, bold);
        let heights = heights(grid, sheet.sea_level);
        let room = across as f32 - font.width(&heights, plain);
        // Next to the label if there is room, otherwise below it.
        match end - left as f32 + 12.0 <= room {
            true => font.write(&mut canvas, left as f32 + room, (baseline + 21) as i64, &heights, plain),
            false => {
                let heights = fitted(&heights, plain, across);
                font.write(&mut canvas, left as f32, (baseline + 38) as i64, &heights, plain)
            }
        };
    }
    let foot = height - MARGIN / 2;
    canvas.fill(MARGIN as i64..(width - MARGIN) as i64, (foot - 24) as i64..(foot - 23) as i64, LINE);
    let small = style(Face::Regular, 12.0, SOFT);
    font.write(&mut canvas, MARGIN as f32, foot as i64, &fitted(&sheet.footer, small, inner), small);
    Ok(canvas)
}

/// Some rows of every variant, joined into one grid to which colors and light are fitted.
fn together(variants: &[Variant]) -> Grid {
    let width = variants.iter().map(|variant| variant.grid.width()).min().unwrap_or(1);
    let rows: usize = variants.iter().map(|variant| variant.grid.height()).sum();
    let cell = variants.first().map_or(1.0, |variant| variant.grid.window().cell);
    let mut all = Grid::filled(Window::new(width, rows.max(1), cell), 0.0f32);
    let samples =
        variants.iter().flat_map(|variant| (0..variant.grid.height()).flat_map(|j| &variant.grid.row(j)[..width]));
    all.data_mut().iter_mut().zip(samples).for_each(|(to, from)| *to = *from);
    all
}

fn picture(canvas: &mut Canvas, painter: &Painter, variant: &Variant, [left, top]: [usize; 2]) {
    let [width, _] = variant.size();
    for (k, pixel) in variant.pixels(painter).chunks_exact(3).enumerate() {
        let (i, j) = (k % width, k / width);
        canvas.set((left + i) as i64, (top + j) as i64, [pixel[0], pixel[1], pixel[2]]);
    }
}

/// The lowest and the highest height, and the share of land if there is a sea.
fn heights(grid: &Grid, sea_level: f64) -> String {
    let finite = || grid.data().iter().copied().filter(|height| height.is_finite());
    let (low, high) =
        finite().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), height| (low.min(height), high.max(height)));
    if low > high {
        return String::new();
    }
    let land = finite().filter(|height| f64::from(*height) > sea_level).count() as f64 / grid.data().len() as f64;
    let sea = if land < 0.995 { format!(", {:.0} % land", land * 100.0) } else { String::new() };
    format!("{low:.0} to {high:.0} m{sea}").replace('-', "\u{2212}")
}
