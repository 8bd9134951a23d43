//! Drafts: frames of an early stage with a quarter of the samples and without later stages.
//!
//! A full frame of a stage needs all later stages, over the whole world at their own cell. A draft skips them: they
//! pass their source through. It is made at twice the cell, without the octaves of gullies that are too fine for it,
//! and is interpolated. At the end of the stage the frame is made in full, so the difference to its draft is known
//! there. That difference, with a weight that increases towards the end, is added to every earlier frame. Detail
//! therefore appears gradually, and the last frame of the stage continues in the first one of the next stage without a
//! jump.

use crate::recipe::document::Recipe;
use crate::recipe::graph::Graph;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::resample;
use orogen_noise::Points;
use orogen_ops::field::{Add, Gullies};
use orogen_ops::ids::{Id, NodeId};
use orogen_ops::layer::LayerKind;
use orogen_ops::node::Node;
use std::collections::BTreeSet;

/// The ratio of a draft's cell to its frame's cell.
const COARSER: i64 = 2;

/// Samples that the interpolating cubic reads around a position.
const MARGIN: usize = 2;

/// The window of the draft of a frame over `window`.
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

/// The recipe of a draft of a frame over `window`: solvers use the draft's cell, and the nodes in `later` pass their
/// source through.
pub fn recipe(mut recipe: Recipe, later: &BTreeSet<NodeId>, window: &Window) -> Recipe {
    recipe.world.cell = recipe.world.cell.max(window.cell) * COARSER as f64;
    let mut passing = recipe.clone();
    let mut nodes = (0..).map(NodeId::new);
    passing.change(|node| {
        let is_later = nodes.next().is_some_and(|id| later.contains(&id));
        match node {
            Node::StreamPower(law) if is_later => {
                *node = Node::Add(Add { a: law.source.clone(), b: 0.0.into() });
            }
            Node::Gullies(gullies) => gullies.octaves = octaves(gullies, window.cell * COARSER as f64),
            _ => {}
        }
    });
    // If another layer of such a node is read, it must be solved.
    if Graph::resolve(&passing).is_ok() { passing } else { recipe }
}

/// Number of octaves of gullies that are visible at a cell: those whose gullies are at least two samples apart, and the
/// first.
fn octaves(gullies: &Gullies, cell: f64) -> u32 {
    let apart = |octave: u32| gullies.wavelength / libm::pow(gullies.lacunarity, f64::from(octave));
    (1..gullies.octaves).find(|octave| apart(*octave) < 2.0 * cell).unwrap_or(gullies.octaves)
}

/// The weight of the difference at a share of the stage's steps: its cube, because half way the fine detail of the end
/// does not exist yet.
pub fn share(steps: f64) -> f32 {
    (steps * steps * steps) as f32
}

/// A draft interpolated to the samples of its frame's window.
pub fn refined(draft: &Grid, window: &Window) -> Grid {
    let mut out = Grid::filled(*window, 0.0);
    let (xs, ys) = (window.eastings(), window.southings());
    resample::read(draft, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, out.data_mut());
    out
}

/// The difference between a frame and its draft.
pub fn lacking(draft: &Grid, frame: &Grid) -> Grid {
    let mut out = refined(draft, frame.window());
    for (out, height) in out.data_mut().iter_mut().zip(frame.data()) {
        *out = height - *out;
    }
    out
}

/// A frame from its draft and a weighted difference.
pub fn frame(draft: &Grid, lacking: &Grid, share: f32) -> Grid {
    let mut out = refined(draft, lacking.window());
    for (out, lacking) in out.data_mut().iter_mut().zip(lacking.data()) {
        *out += share * lacking;
    }
    out
}
