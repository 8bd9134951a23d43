//! The samples for an engine: a size that it supports, and the cell that fits the world.

use super::target::EngineTarget;
use crate::export::files::suffixed;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::tiles::Tiling;
use orogen_engine::view::{Size, View};
use orogen_engine::world::World;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::words::number;
use orogen_io::file::Output;

/// Tolerance, in cells, for an area that begins at a sample.
const NEAR: f64 = 1e-6;

/// Maximum number of tiles along a side.
pub(super) const MAX_TILES: usize = 100;

/// The requested samples; missing values are chosen by the target.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct FrameSpec {
    /// Samples along a side; of a tile, if there are several.
    pub side: Option<usize>,
    /// Distance between samples, in metres.
    pub cell: Option<f64>,
    /// The window; its size is optional for the target.
    pub window: Option<Window>,
    /// West, north, east and south of an area, in metres from the world's north-west corner, that is resampled to a
    /// size of the target.
    pub area: Option<[f64; 4]>,
    /// Number of tiles, east and south.
    pub tiles: Option<[usize; 2]>,
}

impl FrameSpec {
    /// The samples that a view of a world selects for a target, in one tile. The size of the view is the number of
    /// samples along each side; a part in metres or map coordinates is resampled, unless the view has a cell.
    ///
    /// # Errors
    /// If the size is not a square, or the part is not inside the world or has no sample.
    pub fn of_view(view: &View, target: &EngineTarget, recipe: &Recipe) -> Result<FrameSpec> {
        let side = match view.size {
            None => None,
            Some(Size::Longer(side)) => Some(side),
            Some(Size::Both(width, height)) if width == height => Some(width),
            Some(Size::Both(width, height)) => {
                let name = target.name;
                return refuse(format!("{name} only takes square terrains, not {width} x {height} samples"));
            }
        };
        let part = View { size: None, ..*view };
        let lattice = recipe.world.cell;
        let mut samples = FrameSpec { side, cell: part.cell, ..FrameSpec::default() };
        if part.cell.is_none() {
            // A window in metres is resampled to a size of the engine.
            samples.area = part.ends(recipe, lattice)?;
        }
        if samples.area.is_none() {
            samples.window = part.part(recipe, part.cell.unwrap_or(lattice))?;
        }
        Ok(samples)
    }

    /// The same with this many samples along a side.
    pub fn with_side(self, side: usize) -> FrameSpec {
        FrameSpec { side: Some(side), ..self }
    }

    /// The same with this distance between samples, in metres.
    pub fn with_cell(self, cell: f64) -> FrameSpec {
        FrameSpec { cell: Some(cell), ..self }
    }

    /// The same over this window.
    pub fn with_window(self, window: Window) -> FrameSpec {
        FrameSpec { window: Some(window), ..self }
    }

    /// The same over this area: west, north, east and south in metres from the world's north-west corner.
    pub fn with_area(self, area: [f64; 4]) -> FrameSpec {
        FrameSpec { area: Some(area), ..self }
    }

    /// The same in this many tiles, east and south.
    pub fn with_tiles(self, tiles: [usize; 2]) -> FrameSpec {
        FrameSpec { tiles: Some(tiles), ..self }
    }
}

/// The samples of an export.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Frame {
    /// The window of all samples.
    pub window: Window,
    /// Samples along a side of a tile.
    pub side: usize,
    /// Number of tiles, east and south; they share their edges.
    pub tiles: [usize; 2],
    /// A note about how the world was fitted, if it was not exact.
    pub note: Option<String>,
}

impl Frame {
    /// The samples of a world for a target.
    ///
    /// Without a cell or a window, the shorter extent of the area or the world (with several tiles, the extent that
    /// they cover) is resampled; the default size is the one whose cell is nearest to the world's. With a cell it is
    /// the largest that the world has samples for, and with either, they start at the window's first sample. The
    /// samples of an area are moved to the lattice, by less than a cell to the west and north.
    ///
    /// # Errors
    /// If the target does not support a size or tiles; the message names the closest.
    pub fn new(target: &EngineTarget, world: &World, asked: &FrameSpec) -> Result<Frame> {
        let tiles = asked.tiles.unwrap_or([1, 1]);
        if asked.tiles.is_some() && target.tile.is_none() {
            return refuse(format!("{} imports a single file and splits it itself; leave out --tiles", target.name));
        }
        if tiles.contains(&0) || tiles.iter().any(|count| *count > MAX_TILES) {
            return refuse(format!("--tiles must be 1 to {MAX_TILES} tiles per side, such as --tiles 2x2"));
        }
        let spec = &world.recipe().world;
        let cell = asked.cell.unwrap_or(spec.cell);
        let area = asked.area.filter(|_| asked.window.is_none());
        let extent = area.map(|[west, north, east, south]| [east - west, south - north]);
        if extent.is_some_and(|extent| extent.into_iter().any(|side| side < spec.cell)) {
            return refuse(format!("the area is smaller than a cell of {} m", number(spec.cell)));
        }
        let extent = extent.or(spec.size);
        let side = match (asked.side, asked.window) {
            (Some(side), _) => allowed(target, side)?,
            (None, Some(window)) => {
                let sides = [0, 1].map(|axis| {
                    let samples = if axis == 0 { window.width } else { window.height };
                    (samples.saturating_sub(1) / tiles[axis] + 1, samples)
                });
                if let Some((side, samples)) = sides.into_iter().enumerate().find_map(|(axis, (side, samples))| {
                    ((side - 1) * tiles[axis] + 1 != samples).then_some((side, samples))
                }) {
                    return refuse(format!(
                        "{samples} samples cannot be divided into tiles that share their edges; use {}",
                        (nearest(target, side) - 1) * tiles[0] + 1
                    ));
                }
                if sides[0].0 != sides[1].0 {
                    return refuse(format!(
                        "{} only takes squares; use a window of {1} x {1} samples",
                        target.name, sides[0].1
                    ));
                }
                allowed(target, sides[0].0)?
            }
            (None, None) => match extent {
                Some(size) => {
                    let steps = [0, 1].map(|axis| size[axis] / cell / tiles[axis] as f64);
                    let steps = steps[0].min(steps[1]);
                    let fits = |side: &usize| asked.cell.is_none() || (side - 1) as f64 <= steps;
                    let far = |side: &usize| {
                        let ratio = (side - 1) as f64 / steps;
                        ratio.max(1.0 / ratio)
                    };
                    let sides = target.sides.iter().copied().filter(fits);
                    sides.min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(target.sides[0])
                }
                None => target.sides.iter().copied().filter(|side| *side <= 1025).max().unwrap_or(target.sides[0]),
            },
        };
        let samples = tiles.map(|count| count * (side - 1) + 1);
        let spread =
            |[width, height]: [f64; 2]| (width / (samples[0] - 1) as f64).min(height / (samples[1] - 1) as f64);
        let (first, cell, note) = match (asked.window, asked.cell, extent) {
            (Some(window), ..) => ([window.x, window.y], cell, None),
            (None, None, Some(size)) => {
                let cell = spread(size);
                let covered = samples.map(|samples| (samples - 1) as f64 * cell);
                let left = [0, 1].into_iter().any(|axis| size[axis] - covered[axis] > 1e-6 * size[axis]);
                let mut note = Vec::new();
                if (cell - spec.cell).abs() > 1e-9 * cell {
                    note.push(format!(
                        "the cell is {} m instead of {} m, so that {} fits",
                        number(cell),
                        number(spec.cell),
                        if area.is_some() { "the area" } else { "the world" }
                    ));
                }
                if left {
                    note.push(format!(
                        "only the first {2} x {3} m of {4} {0} x {1} m are written, because the engine only takes squares",
                        number(size[0]),
                        number(size[1]),
                        number(covered[0]),
                        number(covered[1]),
                        if area.is_some() { "the area's" } else { "the world's" }
                    ));
                }
                let first =
                    area.map_or([0, 0], |[west, north, ..]| [west, north].map(|at| (at / cell + NEAR).floor() as i64));
                (first, cell, (!note.is_empty()).then(|| note.join("; ")))
            }
            _ => ([0, 0], cell, None),
        };
        let window = Window { x: first[0], y: first[1], width: samples[0], height: samples[1], cell };
        Ok(Frame { window, side, tiles, note })
    }

    /// The output of each tile, row by row. Those that may not be replaced are rejected before the first tile is
    /// computed.
    pub(super) fn outputs(&self, target: &EngineTarget, output: &Output) -> Result<Vec<Output>> {
        let tiles = (0..self.tiles[1]).flat_map(|row| (0..self.tiles[0]).map(move |column| (column, row)));
        tiles
            .map(|(column, row)| match target.tile {
                Some(name) if self.tiles != [1, 1] => {
                    output.policy().output(suffixed(output.path(), &name(column, row, self.tiles[1])))
                }
                _ => Ok(output.clone()),
            })
            .collect()
    }

    /// The window of a tile.
    #[must_use]
    pub fn tile(&self, column: usize, row: usize) -> Window {
        Tiling { overlap: 1, ..Tiling::of(self.side - 1) }.tile(&self.window, column, row)
    }
}

fn refuse<T>(message: String) -> Result<T> {
    Err(Error::new(ErrorKind::Request, message))
}

fn nearest(target: &EngineTarget, side: usize) -> usize {
    target.sides.iter().copied().min_by_key(|allowed| allowed.abs_diff(side)).unwrap_or(side)
}

fn allowed(target: &EngineTarget, side: usize) -> Result<usize> {
    match target.sides.contains(&side) {
        true => Ok(side),
        false => {
            let sides: Vec<String> = target.sides.iter().map(usize::to_string).collect();
            refuse(format!(
                "{} does not support {side} x {side} samples; the nearest is {}; supported sizes: {}",
                target.name,
                nearest(target, side),
                sides.join(", ")
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::targets::list;

    fn frame(target: &str, size: &str, asked: FrameSpec) -> std::result::Result<Frame, String> {
        let text = format!(
            "orogen = 1\n[world]\n{size}\ncell = 10\n[nodes.a]\nop = \"constant\"\n[outputs]\nheight = \"a\"\n"
        );
        let world = World::open(Recipe::parse(&text, "test").unwrap()).unwrap();
        let frame = Frame::new(list::named(target).unwrap(), &world, &asked).map_err(|error| error.to_string())?;
        world.check(&frame.window).unwrap();
        Ok(frame)
    }

    #[test]
    fn the_size_with_the_nearest_cell_is_taken() {
        let square = "size = [10240, 10240]";
        for (target, side, cell) in [
            ("unreal", 1009, 10240.0 / 1008.0),
            ("unity", 1025, 10.0),
            ("hterrain", 1025, 10.0),
            ("terrain3d", 1024, 10240.0 / 1023.0),
        ] {
            let frame = frame(target, square, FrameSpec::default()).unwrap();
            assert_eq!((frame.side, frame.window.cell, frame.window.width), (side, cell, side), "{target}");
            assert_eq!(frame.note.is_some(), cell != 10.0);
        }
        let wide = frame("unity", "size = [10240, 5120]", FrameSpec::default()).unwrap();
        assert_eq!((wide.side, wide.window.cell), (513, 10.0));
        assert!(wide.note.unwrap().contains("the first 5120 x 5120 m"));
        assert_eq!(frame("unreal", "size = [300, 300]", FrameSpec::default()).unwrap().side, 127);
        // A little finer rather than half as fine; with a cell of its own only what is there.
        assert_eq!(frame("unity", "size = [10000, 10000]", FrameSpec::default()).unwrap().side, 1025);
        assert_eq!(frame("unity", "size = [7000, 7000]", FrameSpec::default()).unwrap().side, 513);
        let with_cell = FrameSpec { cell: Some(10.0), ..FrameSpec::default() };
        assert_eq!(frame("unity", "size = [10000, 10000]", with_cell).unwrap().side, 513);
        assert_eq!(frame("unity", "", FrameSpec::default()).unwrap().side, 1025);
    }

    #[test]
    fn an_area_in_metres_is_resampled() {
        let asked = FrameSpec::default().with_area([2000.0, 3000.0, 7000.0, 8000.0]);
        let made = frame("unity", "size = [10240, 10240]", asked).unwrap();
        // The land has 501 samples of 10 m there; the engine takes 257 or 513.
        assert_eq!((made.side, made.window.cell), (513, 5000.0 / 512.0));
        assert_eq!((made.window.x, made.window.y), (204, 307));
        assert!((2000.0 - made.window.east(0)) < made.window.cell);
        assert!(made.note.unwrap().contains("so that the area fits"));
        let fine = frame("unity", "size = [10240, 10240]", asked.with_side(1025)).unwrap();
        assert_eq!((fine.side, fine.window.cell), (1025, 5000.0 / 1024.0));
        let tiny = FrameSpec::default().with_area([0.0, 0.0, 5.0, 5.0]);
        assert!(frame("unity", "size = [10240, 10240]", tiny).unwrap_err().contains("smaller than a cell"));
    }

    /// The samples of a view of a world of 10240 m, for Unity.
    fn of_view(view: View) -> std::result::Result<FrameSpec, String> {
        let text = "orogen = 1\n[world]\nsize = [10240, 10240]\ncell = 10\n[nodes.a]\nop = \"constant\"\n";
        let recipe = Recipe::parse(&format!("{text}[outputs]\nheight = \"a\"\n"), "test").unwrap();
        FrameSpec::of_view(&view, list::named("unity").unwrap(), &recipe).map_err(|error| error.to_string())
    }

    #[test]
    fn a_view_selects_samples_or_an_area() {
        let (none, metres) = (View::default(), Some("2km,3km,5km,5km".parse().unwrap()));
        assert_eq!(of_view(none), Ok(FrameSpec::default()));
        let sized = View { size: Some(Size::Both(513, 513)), cell: Some(5.0), ..none };
        assert_eq!(of_view(sized), Ok(FrameSpec::default().with_side(513).with_cell(5.0)));
        let area = FrameSpec::default().with_area([2000.0, 3000.0, 7000.0, 8000.0]);
        assert_eq!(of_view(View { window: metres, ..none }), Ok(area));
        let larger = View { window: metres, size: Some(Size::Longer(1025)), ..none };
        assert_eq!(of_view(larger), Ok(area.with_side(1025)));
        let window = Window::new(1000, 1000, 5.0).at(400, 600);
        let with_cell = View { window: metres, cell: Some(5.0), ..none };
        assert_eq!(of_view(with_cell), Ok(FrameSpec::default().with_cell(5.0).with_window(window)));
        let samples = View { window: Some("7,9,513,513".parse().unwrap()), ..none };
        assert_eq!(of_view(samples), Ok(FrameSpec::default().with_window(Window::new(513, 513, 10.0).at(7, 9))));
        for (view, expect) in [
            (View { size: Some(Size::Both(33, 65)), ..none }, "unity only takes square terrains, not 33 x 65 samples"),
            (View { bounds: Some("0,0,100,100".parse().unwrap()), ..none }, "not inside the world"),
        ] {
            let why = of_view(view).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }

    #[test]
    fn tiles_share_their_edges() {
        let asked = FrameSpec { tiles: Some([2, 2]), ..FrameSpec::default() };
        let frame = frame("unity", "size = [10240, 10240]", asked).unwrap();
        assert_eq!((frame.side, frame.window.width), (513, 1025));
        assert_eq!(frame.tile(1, 0), Window::new(513, 513, 10.0).at(512, 0));
    }

    #[test]
    fn what_is_asked_for_is_kept_or_refused() {
        let square = "size = [10240, 10240]";
        let asked = FrameSpec { side: Some(505), cell: Some(5.0), ..FrameSpec::default() };
        assert_eq!(frame("unreal", square, asked).unwrap().window, Window::new(505, 505, 5.0));
        let window = Window::new(513, 513, 10.0).at(7, 9);
        let asked = FrameSpec { window: Some(window), ..FrameSpec::default() };
        assert_eq!(frame("unity", square, asked).unwrap().window, window);
        for (target, asked, expect) in [
            ("unreal", FrameSpec { side: Some(1024), ..FrameSpec::default() }, "the nearest is 1009"),
            ("unity", FrameSpec { side: Some(512), ..FrameSpec::default() }, "the nearest is 513"),
            (
                "unity",
                FrameSpec { window: Some(Window::new(512, 512, 10.0)), ..FrameSpec::default() },
                "the nearest is 513",
            ),
            ("unity", FrameSpec { window: Some(Window::new(513, 257, 10.0)), ..FrameSpec::default() }, "squares"),
            ("hterrain", FrameSpec { tiles: Some([2, 2]), ..FrameSpec::default() }, "leave out --tiles"),
            ("unreal", FrameSpec { tiles: Some([0, 2]), ..FrameSpec::default() }, "1 to 100 tiles"),
            (
                "unity",
                FrameSpec { window: Some(Window::new(512, 512, 10.0)), tiles: Some([2, 2]), ..FrameSpec::default() },
                "share their edges; use 513",
            ),
        ] {
            let why = frame(target, square, asked).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
