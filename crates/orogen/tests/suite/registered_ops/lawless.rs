//! Ops that break laws.

use orogen::laws::{Law, Laws};
use orogen::op::{
    Context, Field, Filter, GridInputs, Inputs, Levelled, Levels, Reading, Solution, Solver, Sources, WorldParams,
    only_layer,
};
use orogen::{Grid, Level, Points, Result, Window};
use std::time::Duration;

macro_rules! filter {
    ($($name:ident = $op:literal, $apply:expr;)*) => { $(
        orogen::op! {
            /// Breaks a law.
            pub struct $name = $op, filter, revision 1;
            inputs {
                /// What it reads.
                source: required,
            }
        }
        impl Filter for $name {
            fn halo(&self, _: f64) -> usize {
                0
            }

            fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
                let source = inputs.required("source")?;
                let out = only_layer(out)?;
                let add: fn(&Window, &Context) -> f32 = $apply;
                let add = add(window, context);
                out.data_mut().iter_mut().zip(source.data()).for_each(|(out, source)| *out = source + add);
                Ok(())
            }
        }
    )* };
}

filter! {
    Tiled = "lawless.tiled", |window, _| window.width as f32;
    Infinite = "lawless.infinite", |_, _| f32::NAN;
    Sea = "lawless.sea", |_, context| context.world_params.sea_level as f32;
    Asleep = "lawless.asleep", |window, _| {
        std::thread::sleep(Duration::from_millis(if window.width > 300 { 400 } else { 0 }));
        0.0
    };
    Leveled = "lawless.leveled", |_, _| Level::current().lanes() as f32;
}

orogen::op! {
    /// Neither reports nor checks, although it takes its time.
    pub struct Deaf = "lawless.deaf", filter, revision 1;
    inputs {
        /// What it reads.
        source: required,
    }
}

impl Filter for Deaf {
    fn halo(&self, _: f64) -> usize {
        0
    }

    fn apply(&self, inputs: &GridInputs, _: &Window, out: &mut [Option<Grid>], _: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        out.data_mut().copy_from_slice(source.data());
        Ok(())
    }

    fn cost(&self, _: f64) -> f64 {
        5000.0
    }
}

orogen::op! {
    /// A mean of two samples of its source, nine samples north and south, which may lie beyond the halo.
    pub struct Wide = "lawless.wide", filter, revision 1;
    inputs {
        /// What it reads.
        source: required,
    }
    params {
        /// The declared halo.
        halo: u32 = 0;
    }
}

impl Filter for Wide {
    fn halo(&self, _: f64) -> usize {
        self.halo as usize
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], _: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let halo = self.halo as usize;
        for (i, j) in (0..window.height).flat_map(|j| (0..window.width).map(move |i| (i, j))) {
            let at = |row: usize| source[(i + halo, row.min(source.height() - 1))];
            out[(i, j)] = 0.5 * (at((j + halo).saturating_sub(9)) + at(j + halo + 9));
        }
        Ok(())
    }
}

orogen::op! {
    /// Depends on the tiles of its sources.
    pub struct Counted = "lawless.counted", solver, revision 1;
    inputs {
        /// What it reads.
        source: required,
    }
}

impl Solver for Counted {
    fn rasters(&self) -> usize {
        0
    }

    fn solve(&self, sources: &dyn Sources, _: &Context) -> Result<Solution> {
        let mut tiles = 0.0;
        sources.each_tile("source", sources.domain(), &mut |_| {
            tiles += 1.0;
            Ok(())
        })?;
        Ok(Solution { layers: Vec::new(), scalars: vec![tiles] })
    }

    fn read(&self, solution: &Solution, _: &Reading, out: &mut [f32]) -> Result<()> {
        out.fill(solution.scalars.first().map_or(0.0, |tiles| *tiles as f32));
        Ok(())
    }
}

orogen::op! {
    /// Counts positions by samples.
    pub struct Celled = "lawless.celled", field, revision 1;
}

impl Field for Celled {
    fn eval(&self, at: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        out.iter_mut().enumerate().for_each(|(k, out)| *out = at.position(k + 1).map_or(0.0, |(x, _)| x as f32));
        Ok(())
    }
}

orogen::op! {
    /// A mean of two samples of the level above, nine samples west and east, which may lie beyond the halo.
    pub struct Narrow = "lawless.narrow", levelled, revision 1;
    params {
        /// The declared halo.
        halo: u32 = 0;
    }
}

impl Levelled for Narrow {
    fn levels(&self) -> Levels {
        Levels { finest: 10.24, count: 6 }
    }

    fn planes(&self) -> usize {
        1
    }

    fn halo(&self, _: usize) -> usize {
        self.halo as usize
    }

    fn coarsest(&self, _: &GridInputs, window: &Window, _: &Context) -> Result<Vec<Grid>> {
        let mut grid = Grid::filled(*window, 0.0f32);
        let columns = (0..window.len()).map(|k| ((window.x + (k % window.width) as i64) % 7) as f32);
        grid.data_mut().iter_mut().zip(columns).for_each(|(sample, column)| *sample = column);
        Ok(vec![grid])
    }

    fn refine(&self, _: usize, parent: &[Grid], _: &GridInputs, window: &Window, _: &Context) -> Result<Vec<Grid>> {
        let mut grid = Grid::filled(*window, 0.0f32);
        for (i, j) in (0..window.height).flat_map(|j| (0..window.width).map(move |i| (i, j))) {
            let at = |x: i64, y: i64| {
                let inside = |index: i64, first: i64, count: usize| (index - first).clamp(0, count as i64 - 1) as usize;
                let over = parent[0].window();
                parent[0][(inside(x, over.x, over.width), inside(y, over.y, over.height))]
            };
            let (x, y) = ((window.x + i as i64) >> 1, (window.y + j as i64) >> 1);
            grid[(i, j)] = 0.5 * (at(x - 9, y) + at(x + 9, y));
        }
        Ok(vec![grid])
    }

    fn surface_halo(&self, _: usize, _: &[bool]) -> usize {
        0
    }

    fn layers_of(&self, _: usize, planes: &[Grid], _: &Window, out: &mut [Option<Grid>], _: &Context) -> Result<()> {
        let ([plane], [Some(out)]) = (planes, out) else { return Ok(()) };
        *out = plane.clone();
        Ok(())
    }
}

#[test]
fn broken_laws_are_found_and_name_the_op() {
    if Level::available().len() > 1 {
        assert!(Laws::of(|_| Leveled::default()).levels().is_err_and(|broken| broken.law == Law::Levels));
    }
    let tiled = Laws::of(|_| Tiled::default());
    let broken = tiled.tiles(10.24, false).unwrap_err();
    assert_eq!((broken.law, broken.op.as_str()), (Law::TileEqualsCrop, "lawless.tiled"));
    assert_eq!(broken.window, Some(Window::new(31, 17, 10.24).at(13, 44)));
    let said = broken.to_string();
    assert!(said.contains("`lawless.tiled` breaks the law TileEqualsCrop in 31 x 17 samples at (13, 44)"), "{said}");
    assert!(tiled.check().iter().any(|broken| broken.law == Law::Unbounded), "far out, too");
    assert!(tiled.warped(30.0).is_err_and(|broken| broken.law == Law::Warped));
    let broken = Laws::of(|_| Infinite::default()).tiles(0.1, false).unwrap_err();
    assert!(broken.law == Law::Finite && broken.message.contains("NaN"), "{broken}");
    let broken = Laws::of(|_| Sea::default()).content_keys().unwrap_err();
    assert!(broken.law == Law::ContentKeys && broken.message.contains("the sea level"), "{broken}");
    let broken = Laws::of(|_| Deaf::default()).stops(320).unwrap_err();
    assert!(broken.law == Law::Cancel && broken.message.contains("pass without a report"), "{broken}");
    assert!(Laws::of(|_| Counted::default()).stored(1.0 / 3.0).is_err_and(|broken| broken.law == Law::Stored));
    let broken = Laws::of(|_| Celled::default()).resolutions(10.24).unwrap_err();
    assert_eq!(broken.law, Law::Resolutions, "{broken}");
}

#[test]
#[ignore = "long: an op that sleeps, and the time until it stops"]
fn an_op_that_takes_longer_than_it_says_is_found_by_the_clock() {
    let laws = Laws::of(|_| Asleep::default());
    assert!(laws.stops(320).is_ok(), "by its costs it is quick");
    let broken = laws.cancel(320).unwrap_err();
    assert!(broken.law == Law::Cancel && broken.message.contains("it went on for"), "{broken}");
}

/// A halo that is one sample too small is detected, for a filter and for a levelled op; a halo that is just large
/// enough breaks no law.
#[test]
fn a_halo_one_sample_too_small_breaks_a_law() {
    for (halo, holds) in [(0, false), (8, false), (9, true), (10, true)] {
        let levelled = Laws::of(move |_| Narrow { halo });
        let filter = Laws::of(move |_| Wide { halo, ..Wide::default() });
        for (laws, op) in [(levelled, "lawless.narrow"), (filter, "lawless.wide")] {
            let found: Vec<_> =
                [laws.tiles(10.24, false), laws.pieces()].into_iter().filter_map(|verdict| verdict.err()).collect();
            assert_eq!(found.is_empty(), holds, "{op} with a halo of {halo}: {found:?}");
            assert!(found.iter().all(|broken| broken.law == Law::TileEqualsCrop && broken.op == op), "{found:?}");
        }
    }
}
