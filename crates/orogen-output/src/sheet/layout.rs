//! The layout of a sheet, in millimetres.

use super::geometry::{Point, Rect, Size};
use super::options::{Page, Resolution, SheetOptions};

/// Margin of the page.
pub const MARGIN: f32 = 9.0;
/// Height of the heading and the two lines under it, including the space above the map.
const HEADING: f32 = 17.5;
/// Room for coordinates at the left, the right, the top and the bottom.
const AXES: [f32; 4] = [12.5, 5.0, 1.0, 6.0];
/// Room for coordinates with the numbers of a grid on all sides.
const GRID: [f32; 4] = [12.5, 12.5, 5.2, 6.0];
/// Distance between the map and the blocks below it or at its side.
const FOOT_GAP: f32 = 5.0;
/// The height of a row of blocks.
pub const ROW: f32 = 12.5;
/// Distance between two blocks of a column.
const COLUMN_GAP: f32 = 3.5;
/// Minimum width of a column of blocks at the side of a map, and its maximum width for a narrow map.
const COLUMN: [f32; 2] = [64.0, 88.0];
/// Minimum width and height of a profile, and its maximum ratio of height to width, below a map and at its side.
const PROFILE: [f32; 2] = [58.0, 30.0];
const PROFILE_ASPECT: [f32; 2] = [0.45, 0.60];
/// Distance between two blocks of a row.
pub const BLOCK_GAP: f32 = 9.0;
/// Minimum width of a page that is fitted to a map.
const NARROWEST: f32 = 118.0;

/// A block below the map or at its side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// Its width in a row, and in a column, where its height is flexible.
    pub widths: [f32; 2],
    /// Its height in a column.
    pub height: f32,
}

/// The positions of all elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// The size of the page.
    pub page: Size,
    /// Pixels per inch.
    pub dpi: f64,
    /// The rectangle of the map.
    pub map: Rect,
    /// The upper left corner of each block.
    pub blocks: Vec<Point>,
    /// Width of the column of blocks; `None` if they are in rows below the map.
    pub column: Option<f32>,
    /// The space for profiles, including their labels; two if one would be badly proportioned.
    pub profiles: Vec<Rect>,
}

/// A map with its blocks, before it is positioned.
struct Draft {
    /// The size of the map.
    size: Size,
    column: Option<f32>,
}

impl Layout {
    /// Lays out a map with this ratio of width to height. Blocks are in rows below it or, if that makes the map larger,
    /// in a column at its side. Remaining space on paper is used for profiles of the land.
    ///
    /// The map's sides are on whole pixels, so that its picture needs no resampling.
    pub fn new(aspect: f64, blocks: &[Block], options: &SheetOptions) -> Layout {
        let aspect = aspect.clamp(1e-3, 1e3) as f32;
        let head = if options.parts.title { HEADING } else { 0.0 };
        let [left, right, top, bottom] = match (options.parts.axes, options.grid) {
            (true, None) => AXES,
            (true, Some(_)) => GRID,
            (false, _) => [0.0; 4],
        };
        let beside = 2.0 * MARGIN + left + right;
        let (page, draft) = match options.page {
            Page::Fitted(longer) => {
                let longer = longer as f32;
                let size =
                    if aspect >= 1.0 { Size::new(longer, longer / aspect) } else { Size::new(longer * aspect, longer) };
                let width = (size.width + beside).max(NARROWEST);
                let foot = foot(blocks, width - 2.0 * MARGIN);
                let page = Size::new(width, 2.0 * MARGIN + head + top + size.height + bottom + foot);
                (page, Draft { size, column: None })
            }
            Page::Paper([width, height]) => {
                let page = Size::new(width as f32, height as f32);
                let room = Size::new(page.width - beside, page.height - 2.0 * MARGIN - head - top - bottom);
                let within = |room: Size| {
                    let room = room.map(|side| side.max(5.0));
                    let width = room.width.min(room.height * aspect);
                    Size::new(width, width / aspect)
                };
                let below = within(Size { height: room.height - foot(blocks, page.width - 2.0 * MARGIN), ..room });
                let column = blocks.iter().map(|block| block.widths[1]).fold(COLUMN[0], f32::max);
                let aside = within(Size { width: room.width - column - FOOT_GAP, ..room });
                let stacked = stack(blocks) <= page.height - 2.0 * MARGIN - head;
                let is_aside = !blocks.is_empty() && stacked && aside.width > below.width;
                // The space at the side of the map, at most as wide as the map with its coordinates.
                let widest = column.max(COLUMN[1]).max(aside.width + left + right);
                let column = column.max(room.width - FOOT_GAP - aside.width).min(widest);
                let draft = match is_aside {
                    true => Draft { size: aside, column: Some(column) },
                    false => Draft { size: below, column: None },
                };
                (page, draft)
            }
        };
        let Draft { size, column } = draft;
        let dpi = match options.resolution {
            Resolution::Inch(dpi) => dpi,
            Resolution::Longer(pixels) => f64::from(pixels) / f64::from(page.width.max(page.height)) * 25.4,
        };
        let pixel = (25.4 / dpi) as f32;
        let snapped = |at: f32| (at / pixel).round() * pixel;
        let taken = column.map_or(0.0, |column| column + FOOT_GAP);
        let x = MARGIN + left + (page.width - beside - taken - size.width).max(0.0) / 2.0;
        let size = size.map(|side| snapped(side).max(pixel));
        let map = Rect::new(snapped(x), snapped(MARGIN + head + top), size.width, size.height);
        let mut layout = Layout { page, dpi, map, blocks: Vec::new(), column, profiles: Vec::new() };
        let under = map.bottom() + bottom;
        let wanted = options.parts.profile && matches!(options.page, Page::Paper(_));
        let fits = |room: Rect| {
            let height = room.height.min(room.width * PROFILE_ASPECT[usize::from(column.is_some())]);
            Some(Rect { height, ..room }).filter(|_| wanted && room.width >= PROFILE[0] && height >= PROFILE[1])
        };
        match column {
            Some(column) => {
                let x = page.width - MARGIN - column;
                let mut y = map.top;
                for block in blocks {
                    layout.blocks.push(Point::new(x, y));
                    y += block.height + COLUMN_GAP;
                }
                let free = under - y - FOOT_GAP;
                let half = (free - FOOT_GAP) / 2.0;
                let areas = match fits(Rect::new(x, y, column, half)) {
                    Some(_) => vec![fits(Rect::new(x, y + FOOT_GAP, column, half)); 2],
                    None => vec![fits(Rect::new(x, y + FOOT_GAP, column, free))],
                };
                // The lower edge of the last profile is aligned with that of the map.
                let mut foot = under;
                for area in areas.into_iter().flatten() {
                    foot -= area.height;
                    layout.profiles.insert(0, Rect { top: foot, ..area });
                    foot -= FOOT_GAP;
                }
            }
            None => {
                let free = page.height - MARGIN - foot(blocks, page.width - 2.0 * MARGIN) - under - FOOT_GAP;
                let mut at = Point::new(MARGIN, under + FOOT_GAP);
                match fits(Rect::new(map.left - left, under + FOOT_GAP, map.width + left + right, free)) {
                    None => at.y += free.clamp(0.0, 2.0 * FOOT_GAP),
                    Some(area) => {
                        // Any remaining space widens the gaps.
                        let apart = ((free - area.height) / 2.0).min(2.0 * FOOT_GAP);
                        layout.profiles.push(Rect { top: area.top + apart, ..area });
                        at.y += area.height + 2.0 * apart + FOOT_GAP;
                    }
                }
                for block in blocks {
                    if at.x > MARGIN && at.x + block.widths[0] > page.width - MARGIN {
                        at = Point::new(MARGIN, at.y + ROW);
                    }
                    layout.blocks.push(at);
                    at.x += block.widths[0] + BLOCK_GAP;
                }
            }
        }
        layout
    }
}

/// The height of all rows of blocks for a given width.
fn foot(blocks: &[Block], width: f32) -> f32 {
    let (mut rows, mut used) = (0.0, f32::MAX);
    for block in blocks {
        if used > 0.0 && used + block.widths[0] > width {
            (rows, used) = (rows + 1.0, 0.0);
        }
        used += block.widths[0] + BLOCK_GAP;
    }
    if rows > 0.0 { rows * ROW + FOOT_GAP } else { 0.0 }
}

/// The height of a column of blocks.
fn stack(blocks: &[Block]) -> f32 {
    blocks.iter().map(|block| block.height + COLUMN_GAP).sum()
}

#[cfg(test)]
mod tests {
    use super::super::options::Parts;
    use super::*;
    use orogen_io::palette::named;

    fn on(page: [f64; 2], profile: bool) -> SheetOptions {
        SheetOptions {
            parts: Parts { profile, ..Parts::default() },
            ..SheetOptions::new(named::all()[0].palette()).with_page(Page::Paper(page))
        }
    }

    /// The blocks of colors, scale, north and legend.
    fn blocks() -> [Block; 4] {
        let block = |row: f32, column: f32, height: f32| Block { widths: [row, column], height };
        [block(88.0, 0.0, ROW), block(53.0, 53.0, 9.5), block(10.0, 10.0, ROW), block(98.0, 50.0, 24.0)]
    }

    /// Left, top, right and bottom of every item on a page.
    fn boxes(layout: &Layout) -> Vec<[f32; 4]> {
        let map = layout.map;
        let mut boxes = vec![[map.left - AXES[0], map.top - AXES[2], map.right() + AXES[1], map.bottom() + AXES[3]]];
        for (block, Point { x, y }) in blocks().iter().zip(&layout.blocks) {
            let (width, height) = match layout.column {
                Some(column) => (block.widths[1].max(10.0).min(column), block.height),
                None => (block.widths[0], 11.0),
            };
            boxes.push([*x, *y, x + width, y + height]);
        }
        boxes.extend(layout.profiles.iter().map(|area| [area.left, area.top, area.right(), area.bottom()]));
        boxes
    }

    #[test]
    fn paper_is_filled_and_nothing_lies_over_another() {
        for page in [[210.0, 297.0], [297.0, 210.0], [297.0, 420.0], [420.0, 297.0], [215.9, 279.4], [300.0, 200.0]] {
            for aspect in [0.65, 1.0, std::f64::consts::SQRT_2] {
                let layout = Layout::new(aspect, &blocks(), &on(page, true));
                let boxes = boxes(&layout);
                let within = |k: usize| page[k] as f32 - MARGIN + 0.1;
                for (n, a) in boxes.iter().enumerate() {
                    assert!(a[0] >= MARGIN - 0.1 && a[2] <= within(0) && a[3] <= within(1), "{page:?} {aspect}: {a:?}");
                    for b in &boxes[n + 1..] {
                        let apart =
                            a[2] <= b[0] + 0.1 || b[2] <= a[0] + 0.1 || a[3] <= b[1] + 0.1 || b[3] <= a[1] + 0.1;
                        assert!(apart, "{page:?} {aspect}: {a:?} {b:?}");
                    }
                }
                let ends =
                    |k: usize, of: fn(f32, f32) -> f32, from: f32| boxes.iter().fold(from, |end, b| of(end, b[k]));
                let usable = [0, 1].map(|k| page[k] as f32 - 2.0 * MARGIN);
                let wide = (ends(2, f32::max, 0.0) - ends(0, f32::min, 1e9)) / usable[0];
                let high = (ends(3, f32::max, 0.0) - MARGIN) / usable[1];
                let area: f32 = boxes.iter().map(|b| (b[2] - b[0]) * (b[3] - b[1])).sum();
                let covered = area / (usable[0] * (usable[1] - HEADING));
                assert!(wide > 0.85 && high > 0.92 && covered > 0.66, "{page:?} {aspect}: {wide} {high} {covered}");
            }
        }
    }

    #[test]
    fn a_map_is_never_smaller_for_its_profile() {
        for aspect in [0.4, 1.0, 2.5] {
            let [with, without] = [true, false].map(|is| Layout::new(aspect, &blocks(), &on([210.0, 297.0], is)));
            assert_eq!(with.map, without.map);
            assert!(without.profiles.is_empty());
        }
    }
}
