//! Windows that a device computes, and results that are kept for later windows.

use orogen_engine::device::{Computed, Device, DeviceGrid, PassRun, PassStep, PlanGrid};
use orogen_engine::field::{Fbm, Multiply};
use orogen_engine::filter::{Blur, Pipes};
use orogen_engine::levelled::Amplify;
use orogen_engine::lower::{Extent, Lowering, Passes};
use orogen_engine::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_engine::solver::{Drainage, Normalise};
use orogen_engine::{Grid, Options, Progress, Recipe, Result, Session, Window, WorldSpec};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

orogen_engine::op! {
    /// Land that is solved, also by a device.
    pub struct Solved = "test.solved", solver, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Added to them.
        raise: f64 = 0.0, unit "m", range -1e4 to 1e4;
        /// Whether the device makes other land.
        chaotic: bool = false;
    }
}

impl Solver for Solved {
    fn scratch(&self, padded: &Window) -> u64 {
        4 * padded.len() as u64
    }

    fn solve(&self, sources: &dyn Sources, _: &Context) -> Result<Solution> {
        let mut heights = sources.whole("source", sources.padded())?;
        heights.data_mut().iter_mut().for_each(|height| *height += self.raise as f32);
        Ok(Solution { layers: vec![sources.keep(heights)?], scalars: Vec::new() })
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        let passes = Passes::new("", &[self.raise as f32]).with_planes(Extent::Domain, 1, &[true]);
        Lowering::Shader(if self.chaotic { passes.chaotic() } else { passes })
    }
}

/// Offset that the device adds to everything that it solves and filters.
const OFF: f32 = 1000.0;

/// A device whose results are off by [`OFF`], so that they can be recognized. It counts its work.
#[derive(Default)]
struct Off {
    refuses: bool,
    solved: AtomicUsize,
    filtered: AtomicUsize,
}

impl Device for Off {
    fn run(&self, run: &PassRun, _: &Progress) -> Result<Computed<Vec<PlanGrid>>> {
        let [PassStep { passes, inputs, window }] = run.steps else { return Ok(Computed::Declined) };
        let raise = match passes.extent {
            Extent::Halo(_) => {
                self.filtered.fetch_add(1, Ordering::Relaxed);
                None
            }
            // The processor computes built-in solvers.
            _ if !passes.passes.is_empty() => return Ok(Computed::Declined),
            _ => {
                self.solved.fetch_add(1, Ordering::Relaxed);
                Some(f32::from_bits(passes.words[0]))
            }
        };
        if self.refuses {
            return Ok(Computed::Declined);
        }
        let made = match raise {
            None => passes.layers.iter().map(|_| Grid::filled(*window, OFF)).collect(),
            Some(raise) => {
                let mut heights = inputs[0].as_ref().unwrap().memory().unwrap().clone();
                assert_eq!(heights.window(), window);
                heights.data_mut().iter_mut().for_each(|height| *height += raise + OFF);
                vec![heights]
            }
        };
        Ok(Computed::Done(made.into_iter().map(PlanGrid::from).collect()))
    }
}

const WINDOW: Window = Window { x: 3, y: 5, width: 40, height: 30, cell: 100.0 };

fn recipe(chaotic: bool) -> Recipe {
    let mut recipe = Recipe::new(WorldSpec::default().with_seed(2).with_size(Some([8000.0; 2])).with_cell(100.0));
    recipe.add("noise", Fbm { seed: 3, wavelength: 3000.0, octaves: 4, ..Fbm::default() });
    recipe.add("land", Multiply { a: "noise".into(), b: 200.0.into() });
    recipe.add("solved", Solved { source: "land".into(), raise: 10.0, chaotic });
    recipe.add("drained", Drainage { source: "solved".into(), ..Drainage::default() });
    let refined = Amplify {
        source: "solved".into(),
        flow: "drained.flow".into(),
        cell: 100.0,
        halvings: 1,
        ..Amplify::default()
    };
    recipe.add("refined", refined);
    recipe.add("eroded", Pipes { source: "solved".into(), ..Pipes::default() });
    recipe.add("even", Normalise { source: "land".into(), ..Normalise::default() });
    recipe.output("height", "refined");
    recipe
}

fn window(session: &Session, layer: &str) -> Grid {
    session.open(recipe(false)).unwrap().window(layer, &WINDOW).unwrap()
}

const LAYERS: [&str; 5] = ["solved", "drained.flow", "refined", "eroded", "even"];

fn session() -> Session {
    Session::new(Options { threads: Some(2), ..Options::default() }).unwrap()
}

#[test]
fn what_a_device_makes_is_never_taken_for_exact() {
    let exact = LAYERS.map(|layer| window(&session(), layer));
    let session = session();
    let device = Arc::new(Off::default());
    let preview = session.with_device(Arc::clone(&device) as Arc<dyn Device>);
    for _ in 0..2 {
        let made = LAYERS.map(|layer| window(&preview, layer));
        // The terrain has the device's offset, also where the processor computed it from the device's results.
        let mut heights = made[0].data().iter().zip(exact[0].data());
        assert!(heights.all(|(made, exact)| (made - exact - OFF).abs() < 0.01));
        let mean = |grid: &Grid| grid.data().iter().sum::<f32>() / grid.data().len() as f32;
        assert!((mean(&made[2]) - mean(&exact[2]) - OFF).abs() < 50.0, "{} {}", mean(&made[2]), mean(&exact[2]));
        assert!(made[3].data().iter().all(|height| *height == OFF));
        // Layers that do not depend on the device's results are exact.
        assert_eq!(made[4], exact[4]);
    }
    // Solutions and grids of filters are kept for later previews.
    assert_eq!((device.solved.load(Ordering::Relaxed), device.filtered.load(Ordering::Relaxed)), (1, 1));
    assert_eq!(session.solutions_made(), 1, "`even` alone is exact");
    assert!(preview.kept_memory() > 0);
    for (layer, exact) in LAYERS.iter().zip(&exact) {
        assert_eq!(window(&preview.without_device(), layer), *exact, "{layer}");
    }
    assert_eq!(session.solutions_made(), 3);
    // Previews also use exact results that exist already.
    let made = window(&session.with_device(Arc::new(Off::default())), "solved");
    assert_eq!(made, exact[0]);
    // Points are always exact.
    let world = preview.open(recipe(false)).unwrap();
    assert_eq!(world.points("solved", &[1000.0], &[2000.0]).unwrap(), [exact[0][(7, 15)]]);
}

#[test]
fn other_land_is_made_for_drafts_alone() {
    let session = session();
    let preview = session.with_device(Arc::new(Off::default()));
    let window = |session: &Session, layer: &str| {
        session.open(recipe(true)).unwrap().window(layer, &WINDOW).unwrap().data().to_vec()
    };
    let may_draft = |session: &Session| {
        let world = session.open(recipe(true)).unwrap();
        world.may_draft(&world.plan(&["eroded"], &WINDOW).unwrap()).unwrap()
    };
    assert!(may_draft(&preview) && !may_draft(&session));
    let draft = window(&preview.drafting(), "solved");
    let heights = window(&preview, "solved");
    assert!(heights.iter().zip(&draft).all(|(height, draft)| (draft - height - OFF).abs() < 0.01));
    assert_eq!(session.solutions_made(), 1);
    // Solvers that are already solved exactly need no draft.
    assert!(!may_draft(&preview) && window(&preview.drafting(), "solved") == heights);
    assert_eq!(window(&session.drafting(), "solved"), heights);
}

#[test]
fn what_a_device_refuses_is_made_by_the_processor() {
    let device = Arc::new(Off { refuses: true, ..Off::default() });
    let preview = session().with_device(Arc::clone(&device) as Arc<dyn Device>);
    for layer in LAYERS {
        assert_eq!(window(&preview, layer), window(&session(), layer), "{layer}");
    }
    assert!(device.solved.load(Ordering::Relaxed) > 0 && device.filtered.load(Ordering::Relaxed) > 0);
}

/// A device that filters and keeps its results, until it is lost.
#[derive(Default)]
struct Keeping {
    is_lost: AtomicBool,
    filtered: AtomicUsize,
    read: AtomicUsize,
}

impl Keeping {
    /// A grid, in memory or on the device.
    fn grid<'a>(&self, grid: &'a PlanGrid) -> &'a Grid {
        grid.memory().or_else(|| grid.on_device()?.samples::<Grid>()).unwrap()
    }
}

impl Device for Keeping {
    fn run(&self, run: &PassRun, _: &Progress) -> Result<Computed<Vec<PlanGrid>>> {
        let [PassStep { passes, inputs, window }] = run.steps else { return Ok(Computed::Declined) };
        if self.is_lost.load(Ordering::Relaxed) {
            return Ok(Computed::Declined);
        }
        self.filtered.fetch_add(1, Ordering::Relaxed);
        let mut made = self.grid(inputs[0].as_ref().unwrap()).crop(window).unwrap();
        made.data_mut().iter_mut().for_each(|height| *height += OFF);
        let grid = DeviceGrid::new(*window, made);
        Ok(Computed::Done(passes.layers.iter().map(|_| grid.clone().into()).collect()))
    }

    fn read(&self, grids: &[&DeviceGrid], _: &Progress) -> Result<Computed<Vec<Grid>>> {
        if self.is_lost.load(Ordering::Relaxed) {
            return Ok(Computed::Lost);
        }
        self.read.fetch_add(grids.len(), Ordering::Relaxed);
        Ok(Computed::Done(grids.iter().map(|grid| grid.samples::<Grid>().unwrap().clone()).collect()))
    }
}

/// Two filters one after the other, and a field that reads both.
fn filtered() -> Recipe {
    let mut recipe = Recipe::new(WorldSpec::default().with_seed(2).with_cell(100.0));
    recipe.add("noise", Fbm { seed: 3, wavelength: 3000.0, octaves: 4, ..Fbm::default() });
    recipe.add("land", Multiply { a: "noise".into(), b: 200.0.into() });
    recipe.add("soft", Blur { source: "land".into(), radius: 250.0 });
    recipe.add("eroded", Pipes { source: "soft".into(), ..Pipes::default() });
    recipe.add("both", Multiply { a: "soft".into(), b: "eroded".into() });
    recipe.output("height", "both");
    recipe
}

#[test]
fn grids_stay_on_a_device_until_the_processor_reads_them() {
    let device = Arc::new(Keeping::default());
    let session = session();
    let preview = session.with_device(Arc::clone(&device) as Arc<dyn Device>);
    let window = |session: &Session, layer: &str| session.open(filtered()).unwrap().window(layer, &WINDOW).unwrap();
    let count = |count: &AtomicUsize| count.swap(0, Ordering::Relaxed);
    let land = window(&session, "land");
    // The intermediate grid is not read.
    let twice = window(&preview, "eroded");
    assert!(twice.data().iter().zip(land.data()).all(|(made, land)| (made - land - 2.0 * OFF).abs() < 0.01));
    assert_eq!((count(&device.filtered), count(&device.read)), (2, 1));
    // The grid is kept on the device for a later window.
    assert_eq!(window(&preview, "eroded"), twice);
    assert_eq!((count(&device.filtered), count(&device.read)), (0, 1));
    // The processor reads both for a field, and only once.
    let both = window(&preview, "both");
    let expect = |(both, land): (&f32, &f32)| (both / ((land + OFF) * (land + 2.0 * OFF)) - 1.0).abs() < 1e-5;
    assert!(both.data().iter().zip(land.data()).all(expect));
    assert_eq!(count(&device.read), 2);
    // A lost device has lost the grids that it kept; the processor makes them again.
    device.is_lost.store(true, Ordering::Relaxed);
    for layer in ["eroded", "both"] {
        assert_eq!(window(&preview, layer), window(&session, layer), "{layer}");
    }
}
