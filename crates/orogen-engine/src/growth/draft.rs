//! Drafts: frames of an early stage, made of a quarter of the samples and without the stages after it.
//!
//! A frame of a stage that others follow would need all of them, over the whole world at their own cell, to show what it does at its coarser one.
//! A draft leaves them out: their source passes through. It is made at twice the cell, without the octaves of gullies too fine for it, and read
//! between its samples. What it lacks is known where
//! the stage ends, since the frame there is made in full: the difference between the two is added to every frame before, the more the nearer it is
//! to the end. So detail comes in evenly, and the last frame of the stage goes over into the first of the next without a jump.

use crate::field::add::Add;
use crate::field::gullies::Gullies;
use crate::layer::LayerKind;
use crate::node::Node;
use crate::recipe::document::Recipe;
use crate::recipe::graph::Graph;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::resample;
use orogen_noise::Points;
use std::collections::BTreeSet;

/// A draft's cell in cells of its frame.
const COARSER: i64 = 2;

/// Samples that the interpolating cubic reads beyond a position.
const MARGIN: usize = 2;

/// The samples that a draft of the frame over `window` is made at.
pub fn window(window: &Window) -> Window {
    let first = |start: i64| start.div_euclid(COARSER);
    let count = |start: i64, end: i64| (end - 1).div_euclid(COARSER) + 2 - first(start);
    let (width, height) = (count(window.x, window.right()), count(window.y, window.bottom()));
    Window {
        x: first(window.x),
        y: first(window.y),
        width: width.max(1) as usize,
        height: height.max(1) as usize,
        cell: window.cell * COARSER as f64,
    }
    .grown(MARGIN)
}

/// The recipe of a draft of a frame over `window`: solvers work at the draft's cell, and the nodes in `later` show their source.
pub fn recipe(mut recipe: Recipe, later: &BTreeSet<usize>, window: &Window) -> Recipe {
    recipe.world.cell = recipe.world.cell.max(window.cell) * COARSER as f64;
    let mut passing = recipe.clone();
    let mut index = 0;
    passing.change(|node| {
        match node {
            Node::StreamPower(law) if later.contains(&index) => {
                *node = Node::Add(Add { a: law.source.clone(), b: 0.0.into() });
            }
            Node::Gullies(gullies) => gullies.octaves = octaves(gullies, window.cell * COARSER as f64),
            _ => {}
        }
        index += 1;
    });
    // Where another layer of such a node is read, it has to be solved.
    if Graph::resolve(&passing).is_ok() { passing } else { recipe }
}

/// How many octaves of gullies can be seen at a cell: those whose gullies are at least two samples apart, and the first.
fn octaves(gullies: &Gullies, cell: f64) -> u32 {
    let apart = |octave: u32| gullies.wavelength / libm::pow(gullies.lacunarity, f64::from(octave));
    (1..gullies.octaves).find(|octave| apart(*octave) < 2.0 * cell).unwrap_or(gullies.octaves)
}

/// How much of what drafts lack at their stage's end is added at a share of its steps: as a cube, since half way the fine detail of the end is not
/// there yet.
pub fn share(steps: f64) -> f32 {
    (steps * steps * steps) as f32
}

/// A draft at every sample of its frame's window.
pub fn refined(draft: &Grid, window: &Window) -> Grid {
    let mut out = Grid::filled(*window, 0.0);
    let (xs, ys) = (window.eastings(), window.southings());
    resample::read(draft, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, out.data_mut());
    out
}

/// What the draft lacks of a frame.
pub fn lacking(draft: &Grid, frame: &Grid) -> Grid {
    let mut out = refined(draft, frame.window());
    for (out, height) in out.data_mut().iter_mut().zip(frame.data()) {
        *out = height - *out;
    }
    out
}

/// A frame from its draft and a share of what drafts lack at the stage's end.
pub fn frame(draft: &Grid, lacking: &Grid, share: f32) -> Grid {
    let mut out = refined(draft, lacking.window());
    for (out, lacking) in out.data_mut().iter_mut().zip(lacking.data()) {
        *out += share * lacking;
    }
    out
}
