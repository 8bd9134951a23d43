//! Values beyond the edges of the world.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;
use std::ops::Range;

op! {
    /// Linear extrapolation beyond the edges of a bounded world; inside the world the source itself.
    ///
    /// Filters at the edge of the world read beyond it: without this op the source's own values there, with it only the
    /// ground inside the world. Samples that are farther out than `samples` are missing (NaN). In an unbounded world
    /// nothing changes.
    pub struct Extrapolate = "extrapolate", filter, revision 1;
    inputs {
        /// The values inside the world.
        source: required,
    }
    params {
        /// Number of samples beyond each edge that continue the line through the two samples before them.
        samples: u32 = 1, range 0 to 16;
    }
    layers {
        /// The values.
        value: source;
    }
}

impl Filter for Extrapolate {
    fn halo(&self, _: f64) -> usize {
        // The outermost sample continues the line through the two samples at the edge.
        if self.samples == 0 { 0 } else { self.samples as usize + 1 }
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let Some(world) = context.world_params.window(window.cell).filter(|world| !world.contains(window)) else {
            out.paste(source);
            return Ok(());
        };
        let most = i64::from(self.samples);
        let sample = |x: i64, y: i64| {
            let from = source.window();
            source.get((x - from.x) as usize, (y - from.y) as usize).unwrap_or(f32::NAN)
        };
        let in_row = |x: i64, y: i64| match Beyond::of(x, world.width) {
            None => sample(x, y),
            Some(beyond) => beyond.value(most, |x| sample(x, y)),
        };
        let inside = window.intersection(&world);
        context.progress.expect(window.height as f64);
        parallel::try_for_each(out.data_mut().chunks_mut(window.width.max(1)).enumerate(), |(j, row)| {
            context.progress.step(1.0)?;
            let y = window.y + j as i64;
            let mut fill = |columns: Range<i64>, value: &dyn Fn(i64) -> f32| {
                for x in columns {
                    row[(x - window.x) as usize] = value(x);
                }
            };
            match Beyond::of(y, world.height) {
                Some(beyond) => fill(window.x..window.right(), &|x| beyond.value(most, |y| in_row(x, y))),
                None if inside.is_empty() => fill(window.x..window.right(), &|x| in_row(x, y)),
                None => {
                    fill(window.x..inside.x, &|x| in_row(x, y));
                    fill(inside.right()..window.right(), &|x| in_row(x, y));
                    let [to, from] = [window, source.window()].map(|window| (inside.x - window.x) as usize);
                    let samples = &source.row((y - source.window().y) as usize)[from..from + inside.width];
                    row[to..to + inside.width].copy_from_slice(samples);
                }
            }
            Ok(())
        })
    }

    fn lower(&self, cell: f64, world_params: &WorldParams) -> Lowering<Passes> {
        let sides = world_params.window(cell).map_or([0; 2], |world| [world.width as u32, world.height as u32]);
        let words = sides.into_iter().chain([self.samples]);
        let passes = Passes::new(include_str!("extrapolate.wgsl"), &[]).with_words(words);
        let halo = self.halo(cell);
        Lowering::Shader(passes.then("extrapolate", 0, [halo; 2]))
    }

    fn cost(&self, _: f64) -> f64 {
        1.0
    }

    fn reads_size(&self) -> bool {
        true
    }
}

/// A position along an axis beyond the first or the last sample of the world.
struct Beyond {
    /// The sample at the edge, and the one before it.
    last: i64,
    before: i64,
    /// Number of samples beyond the edge.
    steps: i64,
}

impl Beyond {
    /// The position `at` along a side of `count` samples; `None` if it is inside.
    fn of(at: i64, count: usize) -> Option<Beyond> {
        let end = count as i64 - 1;
        let last = at.clamp(0, end);
        let inward = (last - at).signum();
        (at != last).then(|| Beyond { last, before: (last + inward).clamp(0, end), steps: (at - last).abs() })
    }

    /// The value on the line, at most `most` samples beyond the edge; the edge's value if the line is not finite.
    fn value(&self, most: i64, at: impl Fn(i64) -> f32) -> f32 {
        if self.steps > most {
            return f32::NAN;
        }
        let last = at(self.last);
        let next = last + self.steps as f32 * (last - at(self.before));
        if next.is_finite() { next } else { last }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::declare::Declared;
    use orogen_grid::analysis::slope::extended;
    use orogen_grid::progress::Progress;

    fn made(samples: u32, source: &Grid, window: &Window) -> Grid {
        let world = source.window();
        let size = [world.width, world.height].map(|samples| (samples - 1) as f64 * world.cell);
        let world_params = WorldParams { seed: 0, size: Some(size), cell: world.cell, sea_level: 0.0 };
        let op = Extrapolate { samples, ..Extrapolate::default() };
        let mut given = Grid::filled(window.grown(op.halo(world.cell)), -1e9);
        given.paste(source);
        let mut out = [Some(Grid::filled(*window, 0.0))];
        let context = Context { world_params: &world_params, progress: &Progress::none(), observer: None };
        op.apply(&GridInputs::new(op.spec(), &[Some(&given)]), window, &mut out, &context).unwrap();
        let [Some(out)] = out else { panic!("no layer") };
        out
    }

    #[test]
    fn one_sample_beyond_the_edges_is_that_of_an_extended_grid() {
        for (width, height) in [(7, 5), (1, 1), (2, 1), (1, 3), (2, 2)] {
            let window = Window::new(width, height, 5.0);
            let data = (0..width * height).map(|k| (k * k % 23) as f32).collect();
            let ground = Grid::from_data(window, data).unwrap();
            let whole = extended(&ground);
            assert_eq!(made(1, &ground, &window.grown(1)), whole, "{width} x {height}");
            for part in window.tiles(2) {
                assert_eq!(Some(made(1, &ground, &part.grown(1))), whole.crop(&part.grown(1)), "{part:?}");
            }
        }
    }

    #[test]
    fn planes_continue_and_farther_samples_are_missing() {
        let plane = |window: Window| {
            let mut grid = Grid::filled(window, 0.0);
            for j in 0..window.height {
                for i in 0..window.width {
                    grid.row_mut(j)[i] = (3.0 * window.east(i) - 2.0 * window.south(j)) as f32;
                }
            }
            grid
        };
        let window = Window::new(6, 4, 0.5);
        assert_eq!(made(3, &plane(window), &window.grown(3)), plane(window.grown(3)));
        let wide = made(3, &plane(window), &window.grown(4));
        assert!(wide.row(0).iter().all(|value| value.is_nan()) && wide[(0, 5)].is_nan() && wide[(1, 1)].is_finite());
        let bare = made(0, &plane(window), &window.grown(2));
        assert_eq!(bare.data().iter().filter(|value| value.is_finite()).count(), 24);
        assert_eq!(bare.crop(&window), Some(plane(window)));
    }
}
