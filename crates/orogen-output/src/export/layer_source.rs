//! What is exported: a layer over a window, row after row or whole.

use std::io;

use super::derived::layer::{Made, Nature, RowLayer};
use super::derived::list;
use super::derived::rows::Rows;
use super::features::layer::VectorLayer;
use super::features::list as vector_list;
use orogen_engine::layer::LayerKind;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::analysis::halo::Halo;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::words::nearest;
use orogen_io::format::dem::Georeference;
use orogen_io::format::levels::{Levels, NO_SAMPLES, extremes};

/// Bands of rows from the north, each a grid a channel, with how many of its samples are finite: of a derived layer, of the heights beneath.
type Source<'w> = Box<dyn Iterator<Item = Result<(Vec<Grid>, FiniteCount)>> + 'w>;

/// A layer of a world over a window.
pub struct LayerSource<'w> {
    world: &'w World,
    layer: String,
    /// What the layer is if the recipe has none of that name.
    derived: Option<&'static RowLayer>,
    /// Layers of vector features in place of samples.
    vectors: Vec<&'static VectorLayer>,
    window: Window,
    progress: Progress,
    /// Bytes held beside the rows at hand.
    reserved: u64,
    /// Rows that are about to be made.
    ready: Option<Source<'w>>,
    /// The lowest and highest sample so far.
    range: [f32; 2],
    /// How many there are.
    count: FiniteCount,
}

impl<'w> LayerSource<'w> {
    /// A layer over a window: one of the recipe's, or one that is [derived](super::derived) from its heights (of which some want the recipe
    /// [prepared](super::derived::list::prepare)). `progress` hears of the samples, and may stop the work.
    ///
    /// # Errors
    /// If there is no such layer, or the window is not one of this world.
    pub fn new(world: &'w World, layer: &str, window: Window, progress: &Progress) -> Result<LayerSource<'w>> {
        world.check(&window)?;
        let derived = match world.unit(layer) {
            Ok(_) => None,
            Err(error) => match list::named(layer) {
                Some(derived) => match &derived.made {
                    Made::Rows(rows) => Some(rows),
                    // Its nodes are appended before a world is opened.
                    Made::Nodes(_) => return Err(error),
                },
                None => {
                    let names: Vec<&str> = (list::all().iter().map(|derived| derived.name))
                        .chain(vector_list::all().iter().map(|layer| layer.name))
                        .collect();
                    let hint = match nearest(layer, names.iter().copied()) {
                        Some(near) => format!("did you mean `{near}`, which is derived from the heights?"),
                        None => format!("layers derived from the heights: {}", names.join(", ")),
                    };
                    return Err(Error::new(ErrorKind::Request, format!("{error}; {hint}")));
                }
            },
        };
        if derived.is_some() {
            world.unit(HEIGHT)?;
        }
        let layer = layer.to_string();
        Ok(LayerSource {
            world,
            layer,
            derived,
            vectors: Vec::new(),
            window,
            progress: progress.clone(),
            reserved: 0,
            ready: None,
            range: NO_SAMPLES,
            count: FiniteCount::default(),
        })
    }

    /// Layers of vector features over a window, in place of samples.
    ///
    /// # Errors
    /// As [`LayerSource::new`], of the heights.
    pub fn of_features(
        world: &'w World,
        vectors: Vec<&'static VectorLayer>,
        window: Window,
        progress: &Progress,
    ) -> Result<LayerSource<'w>> {
        let mut source = LayerSource::new(world, HEIGHT, window, progress)?;
        source.layer = vectors.iter().map(|layer| layer.name).collect::<Vec<_>>().join(", ");
        source.vectors = vectors;
        Ok(source)
    }

    /// Says how many samples features were made of, where these do not come as rows.
    pub(super) fn made_of(&mut self, count: FiniteCount) {
        self.count = count;
    }

    /// The layers of vector features that are wanted in place of samples.
    pub fn vectors(&self) -> &[&'static VectorLayer] {
        &self.vectors
    }

    /// Plans the rows: what does not fit in memory beside `beside` bytes is refused before a file is begun.
    ///
    /// # Errors
    /// As [`World::bands`].
    pub(super) fn prepare(&mut self, reserved: u64) -> Result<()> {
        self.reserved = reserved;
        // Features are made of more than the window's rows, and count their memory themselves.
        if self.vectors.is_empty() {
            self.ready = Some(self.source(&self.window)?);
        }
        Ok(())
    }

    fn source(&self, window: &Window) -> Result<Source<'w>> {
        if let Some(derived) = self.derived {
            return Ok(Box::new(Rows::new(derived, self.world, window, self.reserved, &self.progress)?));
        }
        let bands = self.world.bands(&[&self.layer], window, self.reserved, &self.progress)?;
        let counted = |grids: Vec<Grid>| {
            let count =
                grids.iter().fold(FiniteCount::default(), |count, grid| count.and(FiniteCount::of(grid.data())));
            (grids, count)
        };
        Ok(Box::new(bands.map(move |band| band.map(counted))))
    }

    /// The world.
    pub fn world(&self) -> &'w World {
        self.world
    }

    /// The layer's name.
    pub fn layer(&self) -> &str {
        &self.layer
    }

    /// What a sample is measured in: "m" of heights, else what the layer says of itself, which may be nothing.
    pub fn unit(&self) -> &'static str {
        match self.derived {
            Some(derived) => derived.unit,
            None => self.world.unit(&self.layer).unwrap_or_default(),
        }
    }

    /// How the samples may be read: as heights, as names in numbers, or as amounts.
    pub fn kind(&self) -> LayerKind {
        self.world.kind(&self.layer).unwrap_or(LayerKind::Height)
    }

    /// A hash of all that the layer depends on; of a derived one, that its heights depend on.
    pub fn key(&self) -> [u8; 32] {
        let layer = if self.derived.is_some() { HEIGHT } else { &self.layer };
        self.world.key(layer).unwrap_or_default()
    }

    /// What its channels are.
    pub fn nature(&self) -> Nature {
        self.derived.map_or(Nature::Numbers, |derived| derived.nature)
    }

    /// The samples: all of the window's.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The progress that hears of the samples.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// How many grids a band has: 1 for plain numbers.
    pub fn channels(&self) -> usize {
        self.derived.map_or(1, |derived| (derived.channels)(self.world.recipe()).len())
    }

    /// The channels' names, for formats that have some.
    pub fn channel_names(&self) -> Vec<String> {
        match self.derived {
            Some(derived) => (derived.channels)(self.world.recipe()),
            None => vec![self.layer.clone()],
        }
    }

    /// How metres lie on a map, where the recipe holds a real place.
    pub fn map(&self) -> Option<Georeference> {
        self.world.recipe().georeference()
    }

    /// Gives `visit` all rows, some at a time from the north: a grid a channel. Every call makes them anew.
    ///
    /// Fails as `visit` does and as the world does.
    pub fn rows(&mut self, mut visit: impl FnMut(&[Grid]) -> io::Result<()>) -> io::Result<()> {
        let source = match self.ready.take() {
            Some(source) => source,
            None => self.source(&self.window)?,
        };
        (self.range, self.count) = (NO_SAMPLES, FiniteCount::default());
        for band in source {
            let (band, count) = band?;
            self.count = self.count.and(count);
            self.range = band.iter().fold(self.range, |range, grid| extremes(range, grid.data()));
            visit(&band)?;
        }
        Ok(())
    }

    /// All rows at once: a grid a channel. A format that calls this counts them in [`Format::memory`](super::format::Format::memory).
    ///
    /// Fails as the world does.
    pub fn whole(&mut self) -> io::Result<Vec<Grid>> {
        let mut all = vec![Grid::filled(self.window, 0.0); self.channels()];
        self.rows(|band| {
            all.iter_mut().zip(band).for_each(|(all, band)| all.paste(band));
            Ok(())
        })?;
        Ok(all)
    }

    /// How many samples were last made, and how many of them, or of the heights that they follow from, are finite.
    pub fn count(&self) -> FiniteCount {
        self.count
    }

    /// The first channel, all rows at once, and into `halo` the samples around it, as far as the world goes: what follows from a sample and its
    /// neighbours is then the same in windows that share it. A format that calls this counts it as [`whole`](LayerSource::whole).
    ///
    /// Fails as the world does.
    pub fn surrounded(&mut self, halo: &mut Halo) -> io::Result<Grid> {
        self.ready = None;
        let window = self.window;
        let wide = self.world.surroundings(&window, 1);
        *halo = Halo::new(&window, &wide);
        let mut grid = Grid::filled(window, 0.0);
        let mut count = FiniteCount::default();
        for band in self.source(&wide)? {
            let (band, of) = band?;
            count = count.and(of);
            let Some(band) = band.into_iter().next() else { continue };
            grid.paste(&band);
            halo.take(&window, &band);
        }
        // What is told of a derived layer are the heights beneath it, here with those around the window.
        self.count = if self.derived.is_some() { count } else { FiniteCount::of(grid.data()) };
        self.range = extremes(NO_SAMPLES, grid.data());
        Ok(grid)
    }

    /// The range of the samples that were last made; flat if there were none.
    pub fn levels(&self) -> Levels {
        Levels::new(self.range[0], self.range[1])
    }
}
