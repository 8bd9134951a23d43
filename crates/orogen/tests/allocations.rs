//! What is asked again and again asks for no memory.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

use allocation_counter::measure;
use orogen::{Sampler, Window, World, presets};

/// How often `work` asks for memory.
fn allocations(work: impl FnMut()) -> u64 {
    measure(work).count_total
}

#[test]
fn chunks_and_points_of_presets_allocate_nothing_once_warm() {
    for preset in presets::all() {
        let world = World::open(preset.recipe().unwrap()).unwrap();
        let spec = world.recipe().world;
        let sampler = Sampler::new(&world, "height").unwrap();
        let size = spec.size.unwrap();
        for cells in [64, 256] {
            let chunk = Window::new(cells + 1, cells + 1, size[0] / 4096.0);
            let mut heights = vec![0.0; chunk.len()];
            let mut made = |x, y| sampler.fill(&chunk.at(x, y), &mut heights).unwrap();
            assert!(allocations(|| made(0, 0)) > 0, "the count works: the first chunk needs buffers");
            let count = allocations(|| (1..6).for_each(|i| made(i * 300, 1000)));
            assert_eq!(count, 0, "{}: chunks of {cells} cells", preset.name);
        }
        let at = |i: i32| sampler.at(f64::from(i) * 3.3, 1234.5).unwrap();
        at(0);
        assert_eq!(allocations(|| (1..20).for_each(|i| assert!(at(i).is_finite()))), 0, "{}: points", preset.name);
    }
}
