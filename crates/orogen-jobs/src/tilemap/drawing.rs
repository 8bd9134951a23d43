//! The tiles of a map, drawn row by row from the north.

use std::io;
use std::path::Path;

use orogen_grid::autotile::choose::{NONE, Tiles, layers};
use orogen_grid::autotile::classes::Classes;
use orogen_grid::autotile::clean::clean;
use orogen_grid::autotile::drawable::{Drawable, Gap};
use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::{Error, Result};
use orogen_grid::grid::Window;
use orogen_grid::parallel;
use orogen_grid::progress::Progress;
use orogen_io::file;
use orogen_io::records::{Record, Recorder, Records};
use orogen_io::spool::Spool;

use super::map::TileLayer;
use super::tileset::{Tileset, parts};

/// Maximum number of positions without a tile that a map lists.
const MAX_GAPS: usize = 1000;

/// Bytes of tiles, classes or objects that stay in memory before they are packed into a file.
pub(super) const IN_MEMORY: usize = 1 << 19;

/// Tiles per row, and rows of tiles, of the map of a window.
pub(super) fn sides(layout: Layout, window: &Window) -> [usize; 2] {
    let more = usize::from(layout == Layout::Dual);
    [window.width + more, window.height + more]
}

/// The rows of cells on which rows of tiles depend, from the first up to, but not including, the last.
pub(super) fn seen(layout: Layout, rows: [usize; 2]) -> [i64; 2] {
    let [top, bottom] = rows.map(|row| row as i64);
    match layout {
        Layout::Corner => [top, bottom + 1],
        Layout::Dual => [top - 1, bottom],
        _ => [top - 1, bottom + 1],
    }
}

/// Where the tiles, classes and objects of a map are stored until it is written.
pub(super) struct Stores<'a> {
    /// Packed data is stored next to this file; in memory if there is none.
    pub path: Option<&'a Path>,
}

impl Stores<'_> {
    /// A new store.
    pub fn recorder<T: Record>(&self) -> Recorder<T> {
        let spool = self.path.map(|path| Spool::beside(path).with_most(IN_MEMORY));
        spool.map_or_else(Recorder::in_memory, Recorder::packed)
    }

    /// The content of a store.
    pub fn finished<T: Record>(&self, recorder: Recorder<T>) -> Result<Records<T>> {
        recorder.finish().map_err(|cause| self.failed(&cause))
    }

    /// The error of a store.
    pub fn failed(&self, cause: &io::Error) -> Error {
        Error::file("work in", self.path.map_or(Path::new("."), file::folder), cause)
    }
}

/// A layer of the map.
struct Layer {
    tiles: Recorder<u32>,
    is_used: bool,
    is_turned: bool,
}

/// A map whose rows are drawn from the first to the last.
pub(super) struct Drawing<'a> {
    tileset: &'a Tileset,
    window: &'a Window,
    seed: u64,
    /// Number of rows that are drawn at once.
    at_once: usize,
    pub drawable: Drawable,
    choices: Tiles,
    stores: &'a Stores<'a>,
    classes: Recorder<u8>,
    layers: Vec<Layer>,
    class_counts: Vec<u64>,
    gaps_before: u64,
    gap_count: u64,
    gaps: Vec<Gap>,
    changed: u64,
}

impl<'a> Drawing<'a> {
    /// A map without rows.
    pub fn new(
        tileset: &'a Tileset,
        window: &'a Window,
        seed: u64,
        at_once: usize,
        stores: &'a Stores<'a>,
    ) -> Drawing<'a> {
        let layers = tileset.layer_names().into_iter();
        Drawing {
            tileset,
            window,
            seed,
            at_once,
            drawable: tileset.drawable(),
            choices: tileset.choices(),
            stores,
            classes: stores.recorder(),
            layers: layers.map(|_| Layer { tiles: stores.recorder(), is_used: false, is_turned: false }).collect(),
            class_counts: vec![0; tileset.terrains.len()],
            gaps_before: 0,
            gap_count: 0,
            gaps: Vec::new(),
            changed: 0,
        }
    }

    /// Cleans classes, if requested, and draws the rows of tiles that depend on them: from `top` up to, but not
    /// including, `bottom`.
    pub fn add(
        &mut self,
        before: Classes,
        is_cleaned: bool,
        [top, bottom]: [usize; 2],
        progress: &Progress,
    ) -> Result<()> {
        let rows = (bottom - top) as f64;
        progress.expect(2.0 * rows);
        let mut cleaned = None;
        if is_cleaned {
            let mut classes = before.clone();
            clean(&mut classes, &self.drawable, &progress.part(rows))?;
            cleaned = Some(classes);
        }
        for first in (top..bottom).step_by(self.at_once) {
            progress.check()?;
            let last = (first + self.at_once).min(bottom);
            self.count_gaps(&before, cleaned.as_ref(), [first, last]);
            self.add_classes(&before, cleaned.as_ref(), [first, last])?;
            self.add_tiles(cleaned.as_ref().unwrap_or(&before), [first, last])?;
            progress.advance((last - first) as f64 * if is_cleaned { 1.0 } else { 2.0 });
        }
        Ok(())
    }

    /// The classes on which rows of tiles depend.
    fn around(&self, classes: &Classes, [first, last]: [usize; 2]) -> Classes {
        let (x, width) = match self.tileset.layout {
            Layout::Corner => (self.window.x, self.window.width + 1),
            _ => (self.window.x - 1, self.window.width + 2),
        };
        let [from, to] = seen(self.tileset.layout, [first, last]);
        classes.part([x, self.window.y + from], width, (to - from) as usize)
    }

    /// Number of tiles that are drawn outside the map on each side, for tiles of cells, which depend on one cell around
    /// them.
    fn beside(&self) -> usize {
        usize::from(!self.tileset.layout.is_on_corners())
    }

    /// Counts the positions without a tile, before and after the clean-up.
    fn count_gaps(&mut self, before: &Classes, cleaned: Option<&Classes>, [first, last]: [usize; 2]) {
        if self.drawable.is_complete() {
            return;
        }
        let columns = 0..sides(self.tileset.layout, self.window)[0] as i64;
        let rows = 0..(last - first) as i64;
        let beside = self.beside() as i64;
        let gaps = |classes: &Classes| -> Vec<Gap> {
            let mut gaps = self.drawable.gaps(&self.around(classes, [first, last]));
            gaps.iter_mut().for_each(|gap| (gap.x, gap.y) = (gap.x - beside, gap.y - beside));
            gaps.retain(|gap| columns.contains(&gap.x) && rows.contains(&gap.y));
            gaps
        };
        let found = gaps(before);
        let found_count = found.len() as u64;
        let left = cleaned.map_or(found, gaps);
        self.gaps_before += found_count;
        self.gap_count += left.len() as u64;
        let room = MAX_GAPS - self.gaps.len();
        self.gaps.extend(left.into_iter().take(room).map(|gap| Gap { y: gap.y + first as i64, ..gap }));
    }

    /// Adds the rows of classes that belong to rows of tiles.
    fn add_classes(&mut self, before: &Classes, cleaned: Option<&Classes>, [first, last]: [usize; 2]) -> Result<()> {
        let more = usize::from(self.tileset.layout == Layout::Corner);
        let [columns, rows] = [self.window.width + more, self.window.height + more];
        let last = if last == sides(self.tileset.layout, self.window)[1] { rows } else { last.min(rows) };
        for row in first..last {
            let own = |classes: &Classes| classes.part([self.window.x, self.window.y + row as i64], columns, 1);
            let now = own(cleaned.unwrap_or(before));
            if cleaned.is_some() {
                let found = own(before);
                self.changed += found.data().iter().zip(now.data()).filter(|(found, now)| found != now).count() as u64;
            }
            for (counted, count) in self.class_counts.iter_mut().zip(now.counts()) {
                *counted += count as u64;
            }
            self.classes.push(now.data()).map_err(|cause| self.stores.failed(&cause))?;
        }
        Ok(())
    }

    /// Adds rows of tiles to each layer.
    fn add_tiles(&mut self, classes: &Classes, [first, last]: [usize; 2]) -> Result<()> {
        let tiles = layers(&self.around(classes, [first, last]), &self.drawable, &self.choices, self.seed);
        let columns = sides(self.tileset.layout, self.window)[0];
        let beside = self.beside();
        let add = |(layer, tiles): (&mut Layer, Vec<u32>)| {
            let rows = tiles.chunks(columns + 2 * beside).skip(beside).take(last - first);
            let mut own = Vec::with_capacity((last - first) * columns);
            for tile in rows.flat_map(|row| &row[beside..beside + columns]) {
                layer.is_used |= *tile != NONE;
                layer.is_turned |= *tile != NONE && parts(*tile).1.diagonal;
                // 0 for no tile.
                own.push(tile.wrapping_add(1));
            }
            layer.tiles.push(&own)
        };
        let added = parallel::try_for_each(self.layers.iter_mut().zip(tiles), add);
        added.map_err(|cause| self.stores.failed(&cause))
    }

    /// The tiles and classes of the map, without its other properties.
    pub fn finish(self) -> Result<Drawn> {
        let stores = self.stores;
        let layers = self.layers.into_iter().map(|layer| {
            let tiles = stores.finished(layer.tiles)?;
            Ok(TileLayer { tiles, is_used: layer.is_used, is_turned: layer.is_turned })
        });
        Ok(Drawn {
            layers: layers.collect::<Result<_>>()?,
            classes: stores.finished(self.classes)?,
            class_counts: self.class_counts,
            gaps_before: self.gaps_before,
            gap_count: self.gap_count,
            gaps: self.gaps,
            changed: self.changed,
        })
    }
}

/// The drawn part of a map.
pub(super) struct Drawn {
    pub layers: Vec<TileLayer>,
    pub classes: Records<u8>,
    pub class_counts: Vec<u64>,
    pub gaps_before: u64,
    pub gap_count: u64,
    pub gaps: Vec<Gap>,
    pub changed: u64,
}
