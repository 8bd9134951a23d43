//! The custom ops of a program: a field, a filter, a levelled op and a solver.

use orogen::op::{
    Context, Field, Filter, GridInputs, Inputs, Levelled, Levels, Solution, Solver, Sources, WorldParams,
};
use orogen::{Grid, Points, Registry, Result, Window};

orogen::choice! {
    /// Shape of a ripple.
    pub enum Wave {
        /// Straight sides.
        Triangle = "triangle",
        /// Upright sides.
        Square = "square",
    }
}

orogen::op! {
    /// Ripples from west to east. They stand on a source, if there is one.
    pub struct Ripples = "mygame.ripples", field, revision 1;
    inputs {
        /// What they stand on.
        source: optional,
    }
    params {
        /// Seed of their phase.
        seed: u64 = 0;
        /// Distance between crests.
        wavelength: f64 = 100.0, unit "m", range 1e-3 to 1e9, alias "spacing";
        /// Their shape.
        wave: Wave = Wave::Triangle;
    }
}

impl Field for Ripples {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) -> Result<()> {
        let phase = (world_params.seed_of(self.seed) % 1000) as f64 / 1000.0;
        for (k, sample) in out.iter_mut().enumerate() {
            let (x, _) = at.position(k).unwrap_or((f64::NAN, f64::NAN));
            let turns = x / self.wavelength + phase;
            let share = (turns - turns.floor()) as f32;
            let ripple = match self.wave {
                Wave::Triangle => (2.0 * share - 1.0).abs(),
                Wave::Square if share < 0.5 => 0.0,
                Wave::Square => 1.0,
            };
            *sample = ripple + inputs.get("source").map_or(0.0, |source| source[k]);
        }
        Ok(())
    }
}

orogen::op! {
    /// The highest of the samples around each one.
    pub struct Crests = "mygame.crests", filter, revision 1;
    inputs {
        /// Where crests are searched.
        source: required,
    }
    params {
        /// How far they are searched.
        reach: f64 = 30.0, unit "m", range 0.0 to 1e5;
        /// The lowest and the highest result.
        within: [f64; 2] = [-1e4, 1e4], unit "m", range -1e4 to 1e4;
    }
    layers {
        /// The height of the crest.
        height: source, unit "m";
        /// 1 on a crest, 0 elsewhere.
        crest: label;
    }
    check |op| match op.within[0] <= op.within[1] {
        true => Ok(()),
        false => Err(("within", "`within` must be the lower bound, then the upper one".to_string())),
    };
}

impl Filter for Crests {
    fn halo(&self, cell: f64) -> usize {
        (self.reach / cell).floor() as usize
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let [heights, crests] = out else { return Ok(()) };
        let reach = self.halo(window.cell);
        for j in 0..window.height {
            context.progress.check()?;
            for i in 0..window.width {
                let around = (j..=j + 2 * reach).flat_map(|j| (i..=i + 2 * reach).map(move |i| (i, j)));
                let highest = around.map(|at| source[at]).fold(f32::MIN, f32::max);
                if let Some(heights) = heights.as_mut() {
                    heights[(i, j)] = highest.clamp(self.within[0] as f32, self.within[1] as f32);
                }
                if let Some(crests) = crests.as_mut() {
                    crests[(i, j)] = f32::from(u8::from(source[(i + reach, j + reach)] >= highest));
                }
            }
        }
        Ok(())
    }
}

orogen::op! {
    /// What lies above the mean of the world, and on which side of the mean it is.
    pub struct Above = "mygame.above", solver, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    layers {
        /// Height above the mean, 0 below it.
        height: height, unit "m";
        /// 1 above the mean, 0 below it.
        side: label;
    }
}

orogen::op! {
    /// Midpoint displacement (Fournier, Fussell and Carpenter 1982): each level halves the one above it and is
    /// displaced by chance.
    pub struct Midpoints = "mygame.midpoints", levelled, revision 1;
    inputs {
        /// Strength of the displacement.
        roughness: optional,
    }
    params {
        /// Seed of the displacement.
        seed: u64 = 0;
        /// Cell of the finest level.
        cell: f64 = 10.0, unit "m", range 1e-3 to 1e6;
        /// Number of levels.
        levels: u32 = 5, range 1 to 20;
    }
    layers {
        /// The heights.
        height: height, unit "m";
        /// Number of the level that made the sample.
        level: label;
    }
}

impl Midpoints {
    fn chance(&self, level: usize, x: i64, y: i64, seed: u64) -> f32 {
        let hash = [level as u64, x as u64, y as u64].iter().fold(seed, |hash, part| {
            (hash ^ part).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(23).wrapping_mul(0xD1B5_4A32_D192_ED03)
        });
        (hash >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    fn displaced(
        &self,
        level: usize,
        inputs: &GridInputs,
        window: &Window,
        context: &Context,
        smooth: impl Fn(i64, i64) -> f32,
    ) -> Grid {
        let seed = context.world_params.seed_of(self.seed);
        let mut grid = Grid::filled(*window, 0.0f32);
        for (i, j) in (0..window.height).flat_map(|j| (0..window.width).map(move |i| (i, j))) {
            let (x, y) = (window.x + i as i64, window.y + j as i64);
            let roughness = inputs.get("roughness").map_or(1.0, |input| input[(i, j)].abs());
            grid[(i, j)] = smooth(x, y) + roughness * self.chance(level, x, y, seed) / (1 << level) as f32;
        }
        grid
    }
}

impl Levelled for Midpoints {
    fn levels(&self) -> Levels {
        Levels { finest: self.cell, count: self.levels as usize }
    }

    fn planes(&self) -> usize {
        1
    }

    fn halo(&self, _: usize) -> usize {
        1
    }

    fn coarsest(&self, inputs: &GridInputs, window: &Window, context: &Context) -> Result<Vec<Grid>> {
        Ok(vec![self.displaced(0, inputs, window, context, |_, _| 0.0)])
    }

    fn refine(
        &self,
        level: usize,
        parent: &[Grid],
        inputs: &GridInputs,
        window: &Window,
        context: &Context,
    ) -> Result<Vec<Grid>> {
        context.progress.check()?;
        let [parent] = parent else { return Ok(Vec::new()) };
        let at = |x: i64, y: i64| parent[((x - parent.window().x) as usize, (y - parent.window().y) as usize)];
        let smooth = |x: i64, y: i64| {
            let ((left, top), (right, bottom)) = ((x >> 1, y >> 1), ((x + 1) >> 1, (y + 1) >> 1));
            0.25 * (at(left, top) + at(right, top) + at(left, bottom) + at(right, bottom))
        };
        Ok(vec![self.displaced(level, inputs, window, context, smooth)])
    }

    fn surface_halo(&self, _: usize, _: &[bool]) -> usize {
        0
    }

    fn layers_of(
        &self,
        level: usize,
        planes: &[Grid],
        window: &Window,
        out: &mut [Option<Grid>],
        _: &Context,
    ) -> Result<()> {
        let ([plane], [heights, levels]) = (planes, out) else { return Ok(()) };
        if let Some(heights) = heights {
            *heights = plane.clone();
        }
        if let Some(levels) = levels {
            *levels = Grid::filled(*window, level as f32);
        }
        Ok(())
    }

    fn cost(&self, _: usize) -> f64 {
        10.0
    }
}

/// The solution of [`Above`] and of its other revision.
fn above(sources: &dyn Sources, context: &Context, times: f32) -> Result<Solution> {
    let source = sources.whole("source", sources.padded())?;
    context.progress.check()?;
    let mean = source.data().iter().map(|sample| f64::from(*sample)).sum::<f64>() / source.data().len() as f64;
    let grid = |of: &dyn Fn(f32) -> f32| {
        let mut grid = Grid::filled(*sources.padded(), 0.0f32);
        grid.data_mut().iter_mut().zip(source.data()).for_each(|(out, source)| *out = of(*source));
        sources.keep(grid)
    };
    let height = grid(&|height| (height - mean as f32).max(0.0) * times)?;
    let side = grid(&|height| f32::from(u8::from(height > mean as f32)))?;
    Ok(Solution { layers: vec![height, side], scalars: vec![mean] })
}

impl Solver for Above {
    fn scratch(&self, padded: &Window) -> u64 {
        3 * 4 * padded.len() as u64
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        above(sources, context, 1.0)
    }
}

/// Ops with the names of other ops.
pub mod other {
    use super::*;

    orogen::op! {
        /// Twice what lies above the mean: other bits, so another revision.
        pub struct Above = "mygame.above", solver, revision 2;
        inputs {
            /// The heights.
            source: required,
        }
        layers {
            /// Height above the mean, 0 below it.
            height: height, unit "m";
            /// 1 above the mean, 0 below it.
            side: label;
        }
    }

    impl Solver for Above {
        fn scratch(&self, padded: &Window) -> u64 {
            3 * 4 * padded.len() as u64
        }

        fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
            above(sources, context, 2.0)
        }
    }
}

/// A registry of these ops.
pub fn registry() -> Registry {
    let mut registry = Registry::new();
    registry
        .register::<Ripples>()
        .unwrap()
        .register::<Crests>()
        .unwrap()
        .register::<Midpoints>()
        .unwrap()
        .register::<Above>()
        .unwrap();
    registry
}
