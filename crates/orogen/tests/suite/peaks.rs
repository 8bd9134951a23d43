//! Peak memory of a process that runs a plan, compared with the memory that the plan states. The peak comes from the
//! system.

use crate::support::{open, recipe_of, world_of};
use orogen::node::Node;
use orogen::{Progress, Window, World, presets};
use std::process::Command;

/// Memory of a process in addition to its plan: the program, and the stacks of the threads.
const BESIDE: u64 = 16 << 20;

/// Environment variable that tells a child process of this test what to run: a preset or `op NAME`, and the minimum
/// memory of its plan in bytes.
const JOB: &str = "OROGEN_PEAK_JOB";

/// Maximum number of samples along a side.
const LARGEST: usize = 8192;

/// Number of samples along a side of the world of an op.
const SIDE: usize = 1024;

/// A run: samples along the longer side, memory of the plan and peak of the process in bytes.
struct Run {
    side: usize,
    stated: u64,
    peak: u64,
}

/// A separate world for an op, with noise as inputs.
fn world_of_op(name: &str) -> World {
    let node = Node::all().into_iter().find(|node| node.spec().op == name).unwrap();
    let mut spec = world_of(10.0);
    spec.size = Some([(SIDE - 1) as f64 * 10.0; 2]);
    open(&recipe_of(&node, spec, false), 2)
}

/// The five ops with the longest time per sample.
fn expensive_ops() -> Vec<String> {
    let mut works: Vec<(f64, String)> = Node::all()
        .iter()
        .map(|node| {
            let name = node.spec().op;
            let world = world_of_op(name);
            let plan = world.plan(&["height"], &Window::new(256, 256, 10.0)).unwrap();
            (world.work(&plan).unwrap(), name.to_string())
        })
        .collect();
    works.sort_by(|a, b| b.0.total_cmp(&a.0));
    works.into_iter().take(5).map(|(_, name)| name).collect()
}

/// Runs a job in this process, and prints the results.
fn run(job: &str) {
    let (name, least) = job.rsplit_once(' ').unwrap();
    let least: u64 = least.parse().unwrap();
    let world = match name.strip_prefix("op ") {
        Some(op) => world_of_op(op),
        None => open(&presets::find(name).unwrap().recipe().unwrap(), 2),
    };
    let (mut side, mut plan);
    side = 512;
    loop {
        // An unbounded world has no size to fit a window to.
        let window = world.window_fitting(side);
        let window = window.unwrap_or_else(|_| Window::new(side, side, world.recipe().world.cell));
        plan = world.plan(&["height"], &window).unwrap();
        if world.memory_of(&plan).unwrap() >= least || side >= LARGEST {
            break;
        }
        side *= 2;
    }
    let stated = world.memory_of(&plan).unwrap();
    let made = world.run(&plan, &Progress::none()).unwrap();
    assert!(made[0].data().iter().any(|height| height.is_finite()));
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    let peak: u64 = peak.trim().trim_end_matches(" kB").parse().unwrap();
    println!("\nmeasured {side} {stated} {}", peak << 10);
}

/// The results of a job in a separate process.
fn measured(name: &str, least: u64) -> Run {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "peaks::plans_of_some_presets_keep_their_memory", "--nocapture"]);
    // Freed blocks are returned to the system at once. Otherwise glibc's allocator keeps freed blocks of up to 32 MiB
    // for later, which a plan cannot know: up to 46 MiB with the presets.
    command.env("MALLOC_MMAP_THRESHOLD_", "131072");
    let output = command.env(JOB, format!("{name} {least}")).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{name}: {text}{}", String::from_utf8_lossy(&output.stderr));
    let figures = text.lines().find_map(|line| line.strip_prefix("measured ")).unwrap();
    let figures: Vec<u64> = figures.split(' ').map(|figure| figure.parse().unwrap()).collect();
    Run { side: figures[0] as usize, stated: figures[1], peak: figures[2] }
}

fn check(names: &[String], least: u64) {
    let mut beyond = Vec::new();
    println!("{:24} {:>5} {:>12} {:>12} {:>6}", "run", "side", "plan (MiB)", "peak (MiB)", "ratio");
    for name in names {
        let Run { side, stated, peak } = measured(name, least);
        let [plan, most] = [stated, peak].map(|bytes| bytes as f64 / f64::from(1 << 20));
        println!("{name:24} {side:5} {plan:12.1} {most:12.1} {:6.2}", most / plan);
        if peak > stated + BESIDE {
            beyond.push(format!("{name}: {most:.1} MiB, and the plan states {plan:.1} MiB"));
        }
        assert!(stated > least.min(2 * BESIDE), "{name}: the figure of {plan:.1} MiB says little");
    }
    assert!(beyond.is_empty(), "{}", beyond.join("\n"));
}

#[test]
fn plans_of_some_presets_keep_their_memory() {
    // The child process runs this same test.
    if let Ok(job) = std::env::var(JOB) {
        return run(&job);
    }
    let names = ["hills", "mesa", "op pipes"].map(String::from);
    check(&names, 40 << 20);
}

#[test]
#[ignore = "long: every preset and the five most expensive ops, with plans of 128 MiB or more"]
fn plans_of_all_presets_and_expensive_ops_keep_their_memory() {
    let mut names: Vec<String> = presets::all().iter().map(|preset| preset.name.to_string()).collect();
    names.extend(expensive_ops().iter().map(|op| format!("op {op}")));
    check(&names, 128 << 20);
}
