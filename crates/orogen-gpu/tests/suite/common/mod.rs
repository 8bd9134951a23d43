//! Helpers for the tests: a graphics card, and the difference between its terrain and the processor's.

#![allow(
    dead_code,
    unreachable_pub,
    clippy::must_use_candidate,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

pub mod filters;
pub mod levels;
pub mod solvers;

use orogen_engine::device::{PassRun, PassStep, PlanGrid};
use orogen_engine::lower::Passes;
use orogen_engine::{Grid, Options, Recipe, Session, Window};
use orogen_gpu::{Choice, Failure, Gpu, gpu};
use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

/// The first adapter of this machine, including software.
pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| Gpu::open(&gpu::Options::new(Choice::Any)).unwrap())
}

/// A session without a device. All sessions share its solutions.
pub fn processor() -> &'static Session {
    static SESSION: OnceLock<Session> = OnceLock::new();
    SESSION.get_or_init(|| Session::new(Options::default()).unwrap())
}

/// Passes with inputs from memory.
pub fn step<'a>(passes: Passes, inputs: &[Option<Grid>], window: &Window) -> PassStep<'a> {
    let inputs = inputs.iter().cloned().map(|input| input.map(|grid| Cow::Owned(grid.into()))).collect();
    PassStep { passes, inputs, window: *window }
}

/// The layers of the last of some passes, in memory.
pub fn run(
    gpu: &Gpu,
    steps: &[PassStep],
    above: &[Grid],
    is_cancelled: impl Fn() -> bool,
) -> Result<Option<Vec<Grid>>, Failure> {
    let made = orogen_gpu::passes::run(gpu, &PassRun { steps, above, stays: false }, is_cancelled)?;
    Ok(made.map(|made| made.into_iter().filter_map(PlanGrid::into_memory).collect()))
}

pub fn session_of(gpu: &Gpu) -> Session {
    processor().with_device(Arc::new(gpu.clone()))
}

pub fn session() -> Session {
    session_of(gpu())
}

/// A layer over a window, computed by the processor.
pub fn exact(recipe: &Recipe, layer: &str, window: &Window) -> Grid {
    processor().open(recipe.clone()).unwrap().window(layer, window).unwrap()
}

/// The difference between two grids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    pub worst: f32,
    pub rms: f64,
    /// The maximum difference as a share of the range of values.
    pub share: f32,
    /// The share of samples that differ by more than 1e-4 of the range.
    pub beyond: f64,
}

pub fn difference(exact: &Grid, made: &Grid) -> Difference {
    assert_eq!(exact.window(), made.window());
    let finite = || exact.data().iter().filter(|sample| sample.is_finite());
    let range = finite().copied().fold(f32::MIN, f32::max) - finite().copied().fold(f32::MAX, f32::min);
    // The range of flat land is 0.
    let range =
        if range > 0.0 { range } else { finite().copied().fold(1.0, |most: f32, sample| most.max(sample.abs())) };
    let (mut worst, mut squares, mut beyond) = (0.0f32, 0.0f64, 0usize);
    for (a, b) in exact.data().iter().zip(made.data()) {
        let apart = if a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()) { 0.0 } else { (a - b).abs() };
        let apart = if apart.is_nan() { f32::INFINITY } else { apart };
        worst = worst.max(apart);
        squares += f64::from(apart) * f64::from(apart);
        beyond += usize::from(apart > 1e-4 * range);
    }
    let count = exact.data().len().max(1) as f64;
    Difference { worst, rms: (squares / count).sqrt(), share: worst / range, beyond: beyond as f64 / count }
}

/// Compares a layer of a session with a device with the processor's.
pub fn compare(session: &Session, recipe: &Recipe, layer: &str, window: &Window) -> Difference {
    let made = session.open(recipe.clone()).unwrap().window(layer, window).unwrap();
    difference(&exact(recipe, layer, window), &made)
}
