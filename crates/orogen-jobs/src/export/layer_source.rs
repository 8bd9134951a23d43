//! The source of an export: a layer over a window, in bands of rows or as a whole.

use std::io;

use super::derived::layer::{Channels, Made, Nature};
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

/// Bands of rows from the north, each with a grid per channel and a count of finite samples (for some derived layers,
/// of finite heights instead).
type Source<'w> = Box<dyn Iterator<Item = Result<(Vec<Grid>, FiniteCount)>> + 'w>;

/// A layer of a world over a window.
pub struct LayerSource<'w> {
    world: &'w World,
    layer: String,
    /// The channels of a derived layer, if the recipe has no layer with this name.
    derived: Option<&'static Channels>,
    /// Layers of vector features, which replace samples.
    vectors: Vec<&'static VectorLayer>,
    window: Window,
    progress: Progress,
    /// Memory reserved in addition to the current rows, in bytes.
    reserved: u64,
    /// The iterator over the rows, once it is prepared.
    ready: Option<Source<'w>>,
    /// Minimum and maximum so far.
    range: [f32; 2],
    /// Count of samples so far.
    count: FiniteCount,
}

impl<'w> LayerSource<'w> {
    /// A layer over a window: a layer of the recipe, or a layer [derived](super::derived) from its heights, which needs
    /// a [prepared](super::derived::list::prepare) recipe. `progress` counts samples, and can cancel the work.
    ///
    /// # Errors
    /// If there is no such layer, or the window is not valid for this world.
    pub fn new(world: &'w World, layer: &str, window: Window, progress: &Progress) -> Result<LayerSource<'w>> {
        world.check(&window)?;
        let derived = match world.unit(layer) {
            Ok(_) => None,
            Err(error) => match list::named(layer) {
                Some(derived) => match &derived.made {
                    Made::Channels(channels) => Some(channels),
                    // The nodes of the layer must be appended before a world is opened.
                    Made::Nodes(_) => return Err(error),
                },
                None if vector_list::named(layer).is_some() => {
                    let message = format!(
                        "`{layer}` consists of vector features, not of samples; `orogen export --layer {layer}` writes them to files such as .geojson"
                    );
                    return Err(Error::new(ErrorKind::Request, message));
                }
                None => {
                    let names: Vec<&str> = (list::all().iter().map(|derived| derived.name))
                        .chain(vector_list::all().iter().map(|layer| layer.name))
                        .collect();
                    let hint = match nearest(layer, names.iter().copied()) {
                        // The recipe has this layer, and the error names it.
                        Some(near) if world.unit(near).is_ok() => return Err(error),
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

    /// Layers of vector features over a window; they replace samples.
    ///
    /// # Errors
    /// The errors of [`LayerSource::new`] for the heights.
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

    /// Sets the count of the samples from which features were made, if they were not read as rows.
    pub(super) fn made_of(&mut self, count: FiniteCount) {
        self.count = count;
    }

    /// The requested layers of vector features.
    #[must_use]
    pub fn vectors(&self) -> &[&'static VectorLayer] {
        &self.vectors
    }

    /// Plans the rows. Requests that do not fit in memory with `reserved` bytes fail before a file is started.
    ///
    /// # Errors
    /// The errors of [`World::bands`].
    pub(super) fn prepare(&mut self, reserved: u64) -> Result<()> {
        self.reserved = reserved;
        // Features need more than the window's rows, and count their memory themselves.
        if self.vectors.is_empty() {
            self.ready = Some(self.source(&self.window)?);
        }
        Ok(())
    }

    fn source(&self, window: &Window) -> Result<Source<'w>> {
        if let Some(derived) = self.derived {
            return Ok(Box::new(Rows::new(derived, self.world, window, self.reserved, &self.progress)?));
        }
        let counted = list::counted(self.world.recipe(), &self.layer);
        let layers = [self.layer.as_str(), counted.as_str()];
        let layers = if counted == self.layer { &layers[..1] } else { &layers };
        let bands = self.world.bands(layers, window, self.reserved, &self.progress)?;
        let split = |mut grids: Vec<Grid>| {
            let count = grids.last().map_or_else(FiniteCount::default, |grid| FiniteCount::of(grid.data()));
            grids.truncate(1);
            (grids, count)
        };
        Ok(Box::new(bands.map(move |band| band.map(split))))
    }

    /// The rows of another derived layer over the same window, with the same memory reserved. Its inputs must be
    /// prepared.
    ///
    /// # Errors
    /// The errors of [`World::bands`].
    pub(super) fn rows_of(&self, derived: &'static Channels) -> Result<Rows<'w>> {
        Rows::new(derived, self.world, &self.window, self.reserved, &self.progress.part(0.0))
    }

    /// The world.
    #[must_use]
    pub fn world(&self) -> &'w World {
        self.world
    }

    /// The layer's name.
    #[must_use]
    pub fn layer(&self) -> &str {
        &self.layer
    }

    /// The unit of a sample: "m" for heights, otherwise the unit of the layer, which may be empty.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        self.world.unit(&self.layer).unwrap_or_default()
    }

    /// The kind of the layer: heights, labels or amounts.
    #[must_use]
    pub fn kind(&self) -> LayerKind {
        self.world.kind(&self.layer).unwrap_or(LayerKind::Height)
    }

    /// A hash of everything that the layer depends on; for a derived layer with channels, the hash of its heights.
    #[must_use]
    pub fn key(&self) -> [u8; 32] {
        let layer = if self.derived.is_some() { HEIGHT } else { &self.layer };
        self.world.key(layer).unwrap_or_default()
    }

    /// The meaning of the channels.
    #[must_use]
    pub fn nature(&self) -> Nature {
        self.derived.map_or(Nature::Numbers, |derived| derived.nature)
    }

    /// The window.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The progress of the export.
    #[must_use]
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Number of grids per band: 1 for plain numbers.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.derived.map_or(1, |derived| (derived.names)(self.world.recipe()).len())
    }

    /// The names of the channels, for formats that store them.
    #[must_use]
    pub fn channel_names(&self) -> Vec<String> {
        match self.derived {
            Some(derived) => (derived.names)(self.world.recipe()),
            None => vec![self.layer.clone()],
        }
    }

    /// The position of metres on a map, if the recipe contains a real place or a `crs`.
    #[must_use]
    pub fn map(&self) -> Option<Georeference> {
        self.world.recipe().georeference()
    }

    /// Calls `visit` with all rows, in bands from the north: one grid per channel. Every call computes them again.
    ///
    /// Fails if `visit` or the world fails.
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

    /// All rows at once: one grid per channel. A format that uses this includes it in
    /// [`Format::memory`](super::format::Format::memory).
    ///
    /// Fails if the world fails.
    pub fn whole(&mut self) -> io::Result<Vec<Grid>> {
        let mut all = vec![Grid::filled(self.window, 0.0); self.channels()];
        self.rows(|band| {
            all.iter_mut().zip(band).for_each(|(all, band)| all.paste(band));
            Ok(())
        })?;
        Ok(all)
    }

    /// Number of the samples that were last computed, and of the finite ones among them (or among the heights that they
    /// are derived from).
    #[must_use]
    pub fn count(&self) -> FiniteCount {
        self.count
    }

    /// The first channel, all rows at once; `halo` receives the samples around it, as far as the world extends. Values
    /// that depend on neighbors are then the same in adjacent windows. A format that uses this includes it in its
    /// memory, like [`whole`](LayerSource::whole).
    ///
    /// Fails if the world fails.
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
        // A count of heights would include those around the window.
        let counts_own = self.derived.is_none() && list::counted(self.world.recipe(), &self.layer) == self.layer;
        self.count = if counts_own { FiniteCount::of(grid.data()) } else { count };
        self.range = extremes(NO_SAMPLES, grid.data());
        Ok(grid)
    }

    /// The range of the samples that were last computed; empty range if there were none.
    #[must_use]
    pub fn levels(&self) -> Levels {
        Levels::new(self.range[0], self.range[1])
    }
}
