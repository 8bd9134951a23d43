//! The layers of water over one window.

use orogen::grid::hydrology::direction::STEPS;
use orogen::layer::LayerKind;
use orogen::{Error, ErrorKind, Grid, Options, Progress, Recipe, Result, Session, Window};
use std::collections::HashMap;

/// Layers over one window.
#[derive(Debug, Clone, PartialEq)]
pub struct Water {
    /// Height of the bed, in m.
    pub bed: Grid,
    /// Drainage area, in m².
    pub flow: Grid,
    /// Depth of lakes, in m; 0 elsewhere.
    pub lakes: Grid,
    /// Codes of flow directions, if the world has them.
    pub receiver: Option<Grid>,
    /// The sea level in m; the sea is where the bed is lower.
    pub sea_level: f32,
}

impl Water {
    /// The window of all layers.
    pub fn window(&self) -> &Window {
        self.bed.window()
    }

    /// Whether a cell belongs to a lake or the sea.
    pub fn is_standing(&self, cell: usize) -> bool {
        self.lakes.data()[cell] > 0.0 || self.bed.data()[cell] < self.sea_level
    }

    /// Height of the water in lakes and the sea, and of the bed elsewhere.
    pub fn surface(&self, cell: usize) -> f32 {
        (self.bed.data()[cell] + self.lakes.data()[cell]).max(self.sea_level)
    }

    /// Drainage area of a cell, in m².
    pub fn area(&self, cell: usize) -> f64 {
        f64::from(self.flow.data()[cell])
    }

    /// Copies another window of the same world into this one, where they overlap.
    pub fn paste(&mut self, other: &Water) {
        self.bed.paste(&other.bed);
        self.flow.paste(&other.flow);
        self.lakes.paste(&other.lakes);
        match (&mut self.receiver, &other.receiver) {
            (Some(receiver), Some(other)) => receiver.paste(other),
            _ => self.receiver = None,
        }
    }

    /// An empty window with the layers that `other` has.
    pub fn like(other: &Water, window: Window) -> Water {
        let empty = || Grid::filled(window, 0.0);
        Water {
            bed: empty(),
            flow: empty(),
            lakes: empty(),
            receiver: other.receiver.as_ref().map(|_| empty()),
            sea_level: other.sea_level,
        }
    }
}

/// A function that makes one tile. No tile may depend on another one.
pub type Tiles<'a> = &'a (dyn Fn(&Window) -> Result<Water> + Sync);

/// Tiles of a recipe: each comes from a new world in a new session.
pub fn tiles_of(recipe: &Recipe, threads: Option<usize>) -> impl Fn(&Window) -> Result<Water> + use<> {
    let recipe = recipe.clone();
    move |window| tile(&recipe, &Session::new(Options { threads, ..Options::default() })?, window)
}

/// Tiles of a recipe: each comes from a new world, and all worlds share the solutions of a session, so a bounded world
/// is solved once.
pub fn tiles_in(recipe: &Recipe, session: &Session) -> impl Fn(&Window) -> Result<Water> + use<> {
    let (recipe, session) = (recipe.clone(), session.clone());
    move |window| tile(&recipe, &session, window)
}

fn tile(recipe: &Recipe, session: &Session, window: &Window) -> Result<Water> {
    let world = session.open(recipe.clone())?;
    let has = |layer: &&str| recipe.outputs().any(|output| output == *layer);
    let numbered = has(&"lakes") && world.kind("lakes")? == LayerKind::Label;
    let layers: Vec<&str> = ["height", "flow", "lakes", "receiver"].into_iter().filter(has).collect();
    let layers: Vec<&str> = layers.into_iter().chain(numbered.then_some("surface")).collect();
    // All layers at once, so that the levels they are made from are made only once.
    let mut made: HashMap<&str, Grid> =
        layers.iter().copied().zip(world.grids(&layers, window, &Progress::none())?).collect();
    let missing = |layer: &str| Error::new(ErrorKind::Recipe, format!("the recipe has no output `{layer}`"));
    let bed = made.remove("height").ok_or_else(|| missing("height"))?;
    let flow = made.remove("flow").ok_or_else(|| missing("flow"))?;
    let lakes = match (made.remove("lakes"), made.remove("surface")) {
        (Some(lakes), Some(surface)) => depth(&lakes, &surface, &bed),
        (Some(lakes), None) => lakes,
        (None, _) => Grid::filled(*window, 0.0),
    };
    let sea_level = recipe.world.sea_level as f32;
    Ok(Water { bed, flow, lakes, receiver: made.remove("receiver"), sea_level })
}

/// The depth of lakes from their numbers and the water surface.
fn depth(labels: &Grid, surface: &Grid, bed: &Grid) -> Grid {
    let mut depth = labels.clone();
    for (label, (surface, bed)) in depth.data_mut().iter_mut().zip(surface.data().iter().zip(bed.data())) {
        // A lake remains a lake even where rounding leaves no depth.
        *label = if *label > 0.0 { (surface - bed).max(f32::MIN_POSITIVE) } else { 0.0 };
    }
    depth
}

/// The neighbors of a cell inside the window: the code of the direction and the cell.
pub fn neighbors(window: &Window, cell: usize) -> impl Iterator<Item = (usize, usize)> + use<> {
    let (width, height) = (window.width as isize, window.height as isize);
    let (i, j) = (cell as isize % width, cell as isize / width);
    STEPS.into_iter().enumerate().filter_map(move |(code, (east, south))| {
        let (x, y) = (i + east, j + south);
        ((0..width).contains(&x) && (0..height).contains(&y)).then_some((code, (y * width + x) as usize))
    })
}

/// Number of cells between a cell and the nearest edge of the window.
pub fn cells_to_edge(window: &Window, cell: usize) -> usize {
    let (i, j) = (cell % window.width, cell / window.width);
    i.min(j).min(window.width - 1 - i).min(window.height - 1 - j)
}
