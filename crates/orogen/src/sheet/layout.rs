//! Where the parts of a sheet stand, in millimetres.

use super::options::{Options, Page, Resolution};

/// Around everything.
pub const MARGIN: f32 = 9.0;
/// The heading, and the two lines beneath it, with the space to the map.
const HEADING: f32 = 17.5;
/// Room for numbers along the sides: at the left, the right, the top and the bottom.
const AXES: [f32; 4] = [12.5, 5.0, 1.0, 6.0];
/// Between the map and what stands beneath it, and the height of a row of that.
const FOOT_GAP: f32 = 5.0;
const ROW: f32 = 12.5;
/// Between two blocks of a row.
pub const BLOCK_GAP: f32 = 9.0;
/// The narrowest page that is made to fit a map.
const NARROWEST: f32 = 118.0;

/// A block beneath the map, as wide as it needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// Its width.
    pub width: f32,
}

/// Where everything stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Width and height of the page.
    pub page: [f32; 2],
    /// Pixels an inch.
    pub dpi: f64,
    /// Left, top, width and height of the map.
    pub map: [f32; 4],
    /// Left and top of each block beneath the map.
    pub blocks: Vec<[f32; 2]>,
}

impl Layout {
    /// Lays out a map of this width over height, and blocks beneath it.
    ///
    /// The map's sides stand on whole pixels, so that its picture is shown as it is.
    pub fn new(aspect: f64, blocks: &[Block], options: &Options) -> Layout {
        let aspect = aspect.clamp(1e-3, 1e3) as f32;
        let head = if options.parts.title { HEADING } else { 0.0 };
        let [left, right, top, bottom] = if options.parts.axes { AXES } else { [0.0; 4] };
        let beside = 2.0 * MARGIN + left + right;
        let (page, size) = match options.page {
            Page::Fitted(longer) => {
                let longer = longer as f32;
                let size = if aspect >= 1.0 { [longer, longer / aspect] } else { [longer * aspect, longer] };
                let width = (size[0] + beside).max(NARROWEST);
                let foot = foot(blocks, width - 2.0 * MARGIN);
                ([width, 2.0 * MARGIN + head + top + size[1] + bottom + foot], size)
            }
            Page::Paper(page) => {
                let page = page.map(|side| side as f32);
                let foot = foot(blocks, page[0] - 2.0 * MARGIN);
                let room = [page[0] - beside, page[1] - 2.0 * MARGIN - head - top - bottom - foot];
                let room = room.map(|side| side.max(5.0));
                let width = room[0].min(room[1] * aspect);
                (page, [width, width / aspect])
            }
        };
        let dpi = match options.resolution {
            Resolution::Inch(dpi) => dpi,
            Resolution::Longer(pixels) => f64::from(pixels) / f64::from(page[0].max(page[1])) * 25.4,
        };
        let pixel = (25.4 / dpi) as f32;
        let snapped = |at: f32| (at / pixel).round() * pixel;
        let x = MARGIN + left + (page[0] - beside - size[0]).max(0.0) / 2.0;
        let size = size.map(|side| snapped(side).max(pixel));
        let map = [snapped(x), snapped(MARGIN + head + top), size[0], size[1]];
        let mut at = [MARGIN, map[1] + map[3] + bottom + FOOT_GAP];
        let places = blocks.iter().map(|block| {
            if at[0] > MARGIN && at[0] + block.width > page[0] - MARGIN {
                at = [MARGIN, at[1] + ROW];
            }
            let here = at;
            at[0] += block.width + BLOCK_GAP;
            here
        });
        Layout { page, dpi, map, blocks: places.collect() }
    }
}

/// The height of all rows that blocks take within a width.
fn foot(blocks: &[Block], width: f32) -> f32 {
    let (mut rows, mut used) = (0.0, f32::MAX);
    for block in blocks {
        if used > 0.0 && used + block.width > width {
            (rows, used) = (rows + 1.0, 0.0);
        }
        used += block.width + BLOCK_GAP;
    }
    if rows > 0.0 { rows * ROW + FOOT_GAP } else { 0.0 }
}
