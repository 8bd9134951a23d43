//! Tiles of a map of a layer, painted as on a [sheet](super::map): in the layer's colors with relief shading.
//!
//! The colors are fitted once to an overview of the world; those of layers other than the heights also to its middle at
//! its own cell. The shading is fitted to the middle of the world at each cell, so that all zooms look alike and
//! neighbors fit together.

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use super::map::{MapJob, scale_of};
use super::sheet_format::SheetFormat;
use crate::builder::tile_grid::TileGrid;
use crate::export::biome_cover;
use crate::export::derived::layer::Nature;
use crate::export::layer_source::LayerSource;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::resample::LayerKind;
use orogen_io::file;
use orogen_io::format::levels::{NO_SAMPLES, extremes};
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::palette::tint::Tint;
use orogen_io::palette::{Palette, Rgb};
use orogen_output::map::shade::Shade;
use orogen_output::map::tile::{TilePainter, TileSamples};
use orogen_output::sheet::Layer;

/// Samples along the longer side of the overview.
const OVERVIEW: f64 = 512.0;

/// Samples along a side of the part in the middle.
const MIDDLE: usize = 256;

/// Cells of the overview of an unbounded world, in cells of the world.
const UNBOUNDED: f64 = 64.0;

/// A layer with its colors, from which any tile is painted.
pub struct MapTiles {
    world: Arc<World>,
    layer: String,
    /// Whether the recipe has the layer; otherwise it is computed from others.
    is_own: bool,
    kind: LayerKind,
    painter: TilePainter,
    /// The lowest and the highest height of the overview.
    heights: [f32; 2],
    /// Names and colors of classes.
    classes: Vec<(&'static str, Rgb)>,
    unit: &'static str,
    sea_level: f32,
    /// The shading of each cell, by its bits.
    shades: Mutex<HashMap<u64, Arc<Shade>>>,
}

impl MapTiles {
    /// Fits the colors to a world of a [prepared](crate::export::derived::list::prepare) recipe. Without a palette the
    /// layer has its own. `is_place`: it is a real place, a file of heights, which has no sea level.
    ///
    /// # Errors
    /// If the world has no such layer, the layer has several channels that are no color and no vector, the palette does
    /// not suit the layer, no sample is finite, or the work was cancelled.
    pub fn new(
        world: Arc<World>,
        layer: &str,
        palette: Option<Palette>,
        is_place: bool,
        progress: &Progress,
    ) -> Result<MapTiles> {
        let recipe = world.recipe();
        let mut job = MapJob::new(SheetFormat::Png).with_layer(layer);
        job.palette = palette;
        let sea_level = if is_place { f32::NEG_INFINITY } else { recipe.world.sea_level as f32 };
        let (windows, palette) = ([overview(&world), middle(&world, recipe.world.cell)?], job.palette(recipe));
        let (nature, kind, unit, channels) = {
            let source = LayerSource::new(&world, layer, windows[0], progress)?;
            (source.nature(), source.kind(), source.unit(), source.channels())
        };
        let is_own = world.unit(layer).is_ok();
        let mut heights = NO_SAMPLES;
        let mut tint = |palette: &Palette| {
            let seen = first(world.grids(&[HEIGHT], &windows[0], progress)?, &windows[0]);
            heights = extremes(NO_SAMPLES, seen.data());
            match heights[0] <= heights[1] {
                true => Ok(Tint::of(palette, &seen, sea_level)),
                false => Err(request("the layer `height` has no finite sample".into())),
            }
        };
        let hypsometric = MapJob::new(SheetFormat::Png).palette(recipe);
        let mut classes = Vec::new();
        let painter = if layer == HEIGHT {
            TilePainter::of_heights(tint(&palette)?)
        } else if let Some((_, found)) = biome_cover::classes(recipe).filter(|_| job.shows_biomes(recipe)) {
            classes = found;
            let colors: Vec<_> = classes.iter().map(|(_, color)| *color).collect();
            TilePainter::of_classes(tint(&hypsometric)?, &colors)
        } else if nature == Nature::Normal {
            TilePainter::of_vectors()
        } else if nature == Nature::Color {
            TilePainter::of_albedo(tint(&hypsometric)?)
        } else if channels != 1 {
            let message =
                format!("`{layer}` has {channels} channels, but a tile shows a layer with one; read it as an array");
            return Err(request(message));
        } else {
            let mut range = NO_SAMPLES;
            let mut seen = None;
            for window in &windows {
                let grid = first(read(&world, layer, is_own, window, progress)?, window);
                range = extremes(range, grid.data());
                seen.get_or_insert(grid);
            }
            let seen = seen.filter(|_| range[0] <= range[1]);
            let seen = seen.ok_or_else(|| request(format!("the layer `{layer}` has no finite sample")))?;
            let scale = scale_of(kind);
            // A logarithmic ramp needs the smallest value above 0 instead of the minimum.
            let range = Some(range).filter(|_| kind != LayerKind::Flow);
            TilePainter::of_layer(
                &Layer::new(layer, seen).with_unit(unit).with_scale(scale).with_range(range),
                &palette,
            )?
        };
        Ok(MapTiles {
            world,
            layer: layer.to_string(),
            is_own,
            kind,
            painter,
            heights,
            classes,
            unit,
            sea_level,
            shades: Mutex::default(),
        })
    }

    /// Values and their colors in ascending order, for a legend; none if the color does not depend on one number.
    #[must_use]
    pub fn stops(&self) -> Vec<(f32, Rgb)> {
        self.painter.stops(self.heights)
    }

    /// Names and colors of the classes, for a legend; none if the layer has other colors.
    #[must_use]
    pub fn classes(&self) -> &[(&'static str, Rgb)] {
        &self.classes
    }

    /// The unit of the layer's values.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        self.unit
    }

    /// The tile at a column and a row of a grid, as an RGBA PNG; pixels outside the world are transparent.
    ///
    /// # Errors
    /// If memory does not suffice, or the work was cancelled.
    pub fn png(&self, grid: &TileGrid, column: u64, row: u64, side: usize, progress: &Progress) -> Result<Vec<u8>> {
        let window = grid.window(column, row, 1);
        let is_height = self.layer == HEIGHT;
        let is_shaded = self.world.unit(HEIGHT).is_ok();
        let (mut heights, mut channels) = (None, Vec::new());
        match (is_height, is_shaded, self.is_own) {
            (true, ..) => heights = self.world.grids(&[HEIGHT], &window, progress)?.pop(),
            (false, true, true) => {
                channels = self.world.grids(&[HEIGHT, &self.layer], &window, progress)?;
                heights = (!channels.is_empty()).then(|| channels.remove(0));
            }
            (false, _, is_own) => {
                channels = read(&self.world, &self.layer, is_own, &window, progress)?;
                if is_shaded {
                    heights = self.world.grids(&[HEIGHT], &window, progress)?.pop();
                }
            }
        }
        let heights = heights.map(|heights| grid.read(column, row, 1, &heights, LayerKind::Height));
        let values: Vec<Vec<f32>> =
            channels.iter().map(|channel| grid.read(column, row, 0, channel, self.kind)).collect();
        let shade = match heights {
            Some(_) => Some(self.shade(grid.cell(), progress)?),
            None => None,
        };
        let samples = TileSamples {
            side,
            cell: grid.cell(),
            heights: heights.as_deref(),
            values: &values,
            covered: grid.covered(column, row),
        };
        let pixels = self.painter.paint(&samples, shade.as_deref());
        let mut bytes = Vec::new();
        png::write(&mut bytes, &Picture::new(side, side, Pixel::Rgba8), |rows, out| {
            out.copy_from_slice(&pixels[4 * side * rows.start..4 * side * rows.end]);
            Ok(())
        })
        .map_err(|cause| file::explain("make", Path::new(&self.layer), &cause))?;
        Ok(bytes)
    }

    /// The shading at a cell.
    fn shade(&self, cell: f64, progress: &Progress) -> Result<Arc<Shade>> {
        let lock = || self.shades.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(shade) = lock().get(&cell.to_bits()) {
            return Ok(Arc::clone(shade));
        }
        let window = middle(&self.world, cell)?;
        let heights = first(self.world.grids(&[HEIGHT], &window, progress)?, &window);
        let shade = Arc::new(Shade::fit(&heights, self.sea_level));
        Ok(Arc::clone(lock().entry(cell.to_bits()).or_insert(shade)))
    }
}

/// The whole world at its own or a larger cell; of an unbounded one, a large square around the origin.
fn overview(world: &World) -> Window {
    let spec = &world.recipe().world;
    let around = |cell: f64| {
        let side = OVERVIEW as usize;
        Window::new(side, side, cell).at(-(side as i64) / 2, -(side as i64) / 2)
    };
    let whole = spec.size.and_then(|[width, height]| {
        let cell = spec.cell.max(width.max(height) / OVERVIEW);
        world.full_window(cell).ok()
    });
    whole.unwrap_or_else(|| around(UNBOUNDED * spec.cell))
}

/// The middle of a world at a cell.
fn middle(world: &World, cell: f64) -> Result<Window> {
    let half = MIDDLE as i64 / 2;
    match world.recipe().world.size {
        None => Ok(Window::new(MIDDLE, MIDDLE, cell).at(-half, -half)),
        Some(_) => {
            let whole = world.full_window(cell)?;
            let [x, y] = [whole.width, whole.height].map(|count| count as i64 / 2 - half);
            Ok(Window::new(MIDDLE, MIDDLE, cell).at(x, y).intersection(&whole))
        }
    }
}

/// The channels of a layer over a window.
fn read(world: &World, layer: &str, is_own: bool, window: &Window, progress: &Progress) -> Result<Vec<Grid>> {
    if is_own {
        return world.grids(&[layer], window, progress);
    }
    let made = LayerSource::new(world, layer, *window, progress)?.whole();
    made.map_err(|cause| file::explain("make", Path::new(layer), &cause))
}

fn first(grids: Vec<Grid>, window: &Window) -> Grid {
    grids.into_iter().next().unwrap_or_else(|| Grid::filled(*window, f32::NAN))
}

fn request(message: String) -> Error {
    Error::new(ErrorKind::Request, message)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::derived::list;
    use crate::options::Options;
    use orogen_engine::recipe::document::Recipe;

    const RECIPE: &str = "orogen = 1\n[world]\nsize = [5120, 2560]\ncell = 10\nsea_level = 20\n[nodes.a]\nop = \"fbm\"\nwavelength = 900\n\
                          [nodes.b]\nop = \"remap\"\nsource = \"a\"\nto = [0, 300]\n[outputs]\nheight = \"b\"\n";

    fn tiles(layer: &str) -> Result<MapTiles> {
        let mut recipe = Recipe::parse(RECIPE, "test")?;
        list::prepare(&mut recipe, layer, &Options::default())?;
        MapTiles::new(Arc::new(World::open(recipe)?), layer, None, false, &Progress::none())
    }

    fn pixels(tiles: &MapTiles, zoom: u32, column: u64) -> Vec<u8> {
        let grid = TileGrid::own(&tiles.world, zoom, 256).unwrap();
        let bytes = tiles.png(&grid, column, 0, 256, &Progress::none()).unwrap();
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut data).unwrap();
        data
    }

    #[test]
    fn tiles_of_every_layer_fit_together_and_end_where_the_world_ends() {
        for layer in ["height", "a", "slope", "hillshade", "normal", "albedo", "drainage-area"] {
            let tiles = tiles(layer).unwrap();
            let data = pixels(&tiles, 0, 0);
            let opaque =
                |j: usize| data[4 * 256 * j + 3..4 * 256 * (j + 1)].iter().step_by(4).all(|alpha| *alpha == 255);
            assert!((0..128).all(opaque), "{layer}");
            assert!(data[4 * 256 * 128..].iter().all(|byte| *byte == 0), "{layer}");
            let (left, right) = (pixels(&tiles, 1, 0), pixels(&tiles, 1, 1));
            // No seam: the columns beside an edge differ no more than those within a tile do.
            let step = |a: usize, b: (&[u8], usize)| -> u32 {
                let at = |data: &[u8], i: usize, j: usize| u32::from(data[4 * (256 * j + i) + 1]);
                (0..256).map(|j| at(&left, a, j).abs_diff(at(b.0, b.1, j))).sum()
            };
            let within = (245..255).map(|i| step(i, (&left, i + 1))).max().unwrap();
            assert!(step(255, (&right, 0)) <= 2 * within + 256, "{layer}: {} {within}", step(255, (&right, 0)));
        }
        assert!(tiles("splat").is_ok_and(|_| false) || tiles("splat").err().unwrap().to_string().contains("channels"));
        assert!(tiles("nothing").err().unwrap().to_string().contains("no layer `nothing`"));
    }
}
