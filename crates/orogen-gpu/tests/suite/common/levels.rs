//! Helpers for tests of levels: coarse land, and the levels below it.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

use super::filters::sampled;
use super::run;
use orogen_engine::device::PassStep;
use orogen_engine::levelled::Amplify;
use orogen_engine::lower::{Lowering, Passes};
use orogen_engine::op::{Context, GridInputs, Levelled, WorldParams};
use orogen_engine::{Options, Recipe, Session};
use orogen_gpu::Gpu;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use std::sync::OnceLock;

pub const WORLD: WorldParams = WorldParams { seed: 1, size: None, cell: 60.0, sea_level: 400.0 };

/// The planes of a level.
pub const PLANES: [&str; 8] = ["east", "south", "height", "area", "receiver", "variation", "uplift", "shore"];
pub const HEIGHT: usize = 2;
pub const AREA: usize = 3;
pub const RECEIVER: usize = 4;

/// Coarse land with rivers and basins without an outlet: its heights and drainage areas.
pub fn land() -> &'static [Grid; 2] {
    static LAND: OnceLock<[Grid; 2]> = OnceLock::new();
    LAND.get_or_init(|| {
        let recipe = "orogen = 1\n[world]\nseed = 2\nsize = [105600.0, 105600.0]\ncell = 480.0\n\
            [nodes.swells]\nop = \"fbm\"\nwavelength = 24000.0\noctaves = 5\n\
            [nodes.foreland]\nop = \"remap\"\nsource = \"swells\"\nfrom = [-0.5, 0.5]\nto = [100.0, 400.0]\n\
            [nodes.ranges]\nop = \"stream-power\"\nsource = \"foreland\"\ncell = 480.0\nyears = 15000000.0\nsteps = 60\n\
            erodibility = 6e-06\nuplift = 0.7\ncreep = 0.0\n[outputs]\nheight = \"ranges\"\nflow = \"ranges.flow\"\n";
        let session = Session::new(Options::default()).unwrap();
        let world = session.open(Recipe::parse(recipe, "test").unwrap()).unwrap();
        let window = Window::new(212, 212, 480.0).at(4, 4);
        let [mut height, flow] = ["height", "flow"].map(|layer| world.window(layer, &window).unwrap());
        // A third of the middle is below sea level.
        let mut middle = height.crop(&window.shrunk(70)).unwrap().data().to_vec();
        middle.sort_by(f32::total_cmp);
        let fall = middle[middle.len() / 3] - WORLD.sea_level as f32;
        height.data_mut().iter_mut().for_each(|height| *height -= fall);
        // Two hollows.
        for (x, y) in [(106, 107), (98, 112)] {
            height.row_mut(y)[x] -= 900.0;
        }
        [height, flow]
    })
}

/// A chain of levels: each window contains all samples from which the next finer one is made.
pub struct Chain<'a> {
    pub op: &'a dyn Levelled,
    /// The windows of the levels from the coarsest.
    pub windows: Vec<Window>,
    /// The inputs of the coarsest level.
    pub coarsest: Vec<Option<Grid>>,
    /// Which inputs of the finer levels are given; their values are functions of the position.
    pub given: Vec<bool>,
}

pub const fn context(progress: &Progress) -> Context<'_> {
    Context { world_params: &WORLD, progress, observer: None }
}

/// A factor as a function of the position: smooth, with a hole.
pub fn factor(window: &Window, input: usize) -> Grid {
    let metres = window.cell;
    sampled(window, |x, y| {
        let (x, y) = ((x * metres).rem_euclid(61_440.0), (y * metres).rem_euclid(61_440.0));
        let wave = libm::sin(x / (1500.0 + 400.0 * input as f64)) * libm::cos(y / 2300.0 + input as f64);
        if libm::hypot(x - 9000.0, y - 7000.0) < 800.0 && input.is_multiple_of(2) {
            f64::NAN
        } else {
            libm::exp(0.8 * wave)
        }
    })
}

impl Chain<'_> {
    pub fn new<'a>(op: &'a dyn Levelled, level: usize, window: &Window, given: &[bool]) -> Chain<'a> {
        let mut windows = vec![*window];
        for depth in (1..=level).rev() {
            windows.insert(0, op.parent(depth, &windows[0]));
        }
        let read = windows[0].grown(op.source_halo(0));
        let [height, flow] = land();
        let place = |grid: &Grid| {
            assert!(read.width <= grid.width() && read.height <= grid.height(), "the land is too small");
            let [left, top] = [read.width, read.height].map(|side| (grid.width() - side) / 2);
            let first = height.window();
            let (x, y) = (first.x + left as i64, first.y + top as i64);
            let part = Window { x, y, cell: first.cell, ..read };
            Grid::from_data(read, grid.crop(&part).unwrap().data().to_vec()).unwrap()
        };
        let mut coarsest = vec![Some(place(height)), Some(place(flow))];
        coarsest.extend((2..given.len()).map(|i| given[i].then(|| factor(&read, i))));
        Chain { op, windows, coarsest, given: given.to_vec() }
    }

    /// A chain without any inputs.
    pub fn of_nothing<'a>(op: &'a dyn Levelled, level: usize, window: &Window) -> Chain<'a> {
        let mut windows = vec![*window];
        for depth in (1..=level).rev() {
            windows.insert(0, op.parent(depth, &windows[0]));
        }
        Chain { op, windows, coarsest: vec![None; 6], given: vec![false; 6] }
    }

    pub fn is_lowered(&self, level: usize) -> bool {
        match self.op.lower(level, &self.given, &WORLD) {
            Lowering::Shader(_) => true,
            Lowering::Processor(_) => false,
            Lowering::Missing => panic!("level {level}"),
        }
    }

    /// The planes of a level, computed by the processor.
    pub fn until(&self, level: usize) -> Vec<Grid> {
        (1..=level).fold(self.first(), |above, level| self.on_processor(level, &above))
    }

    pub fn inputs(&self, level: usize) -> Vec<Option<Grid>> {
        let read = self.windows[level].grown(self.op.source_halo(level));
        let reads = |i: usize| self.given[i] && self.op.reads_input(level, i);
        (0..self.given.len()).map(|i| (reads(i) && i >= 2).then(|| factor(&read, i))).collect()
    }

    pub fn first(&self) -> Vec<Grid> {
        let inputs: Vec<Option<&Grid>> = self.coarsest.iter().map(Option::as_ref).collect();
        self.op
            .coarsest(&GridInputs::new(self.op.spec(), &inputs), &self.windows[0], &context(&Progress::none()))
            .unwrap()
    }

    pub fn on_processor(&self, level: usize, above: &[Grid]) -> Vec<Grid> {
        let inputs = self.inputs(level);
        let inputs: Vec<Option<&Grid>> = inputs.iter().map(Option::as_ref).collect();
        self.op
            .refine(
                level,
                above,
                &GridInputs::new(self.op.spec(), &inputs),
                &self.windows[level],
                &context(&Progress::none()),
            )
            .unwrap()
    }

    pub fn on_card(&self, gpu: &Gpu, level: usize, above: &[Grid]) -> Vec<Grid> {
        run(gpu, &[self.step(level)], above, || false).unwrap().unwrap()
    }

    pub fn step(&self, level: usize) -> PassStep<'static> {
        let inputs = self.inputs(level);
        let given: Vec<bool> = inputs.iter().map(Option::is_some).collect();
        super::step(passes(self.op, level, &given), &inputs, &self.windows[level])
    }
}

pub fn passes(op: &dyn Levelled, level: usize, given: &[bool]) -> Passes {
    match op.lower(level, given, &WORLD) {
        Lowering::Shader(passes) => passes,
        other => panic!("level {level}: {other:?}"),
    }
}

/// The op with the parameters of the preset `alpine`.
pub fn alpine() -> Amplify {
    Amplify { cell: 60.0, halvings: 3, creep: 1.2, variation: 0.75, ..Default::default() }
}

/// Which inputs are given: no optional ones, the ones that `alpine` gives, and all.
pub const NO_INPUTS: [bool; 8] = [true, true, false, false, false, false, false, false];
pub const ALPINE_INPUTS: [bool; 8] = [true, true, false, true, true, true, true, false];
pub const ALL_INPUTS: [bool; 8] = [true, true, false, true, true, true, true, true];

pub fn windows(cell: f64) -> [(&'static str, Window); 4] {
    let far = (1e6 / cell) as i64;
    [
        ("near", Window::new(64, 51, cell).at(10, 7)),
        ("odd", Window::new(37, 23, cell).at(-41, 15)),
        ("far", Window::new(33, 40, cell).at(far, -far - 3)),
        ("one sample", Window::new(1, 1, cell).at(1, -2)),
    ]
}
