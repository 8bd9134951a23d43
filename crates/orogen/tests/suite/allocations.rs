//! Repeated requests do not allocate memory.

use allocation_counter::measure;
use orogen::{ChunkStep, Chunks, LodConfig, Recipe, Sampler, Window, World, presets};

/// Returns the number of allocations of `work`.
fn allocations(work: impl FnMut()) -> u64 {
    measure(work).count_total
}

#[test]
fn chunks_and_points_of_presets_allocate_nothing_once_warm() {
    let mut seen = 0;
    for preset in presets::all() {
        let mut recipe = preset.recipe().unwrap();
        let cell = recipe.world.size.map_or(recipe.world.cell, |size| size[0] / 4096.0);
        if recipe.world.size.is_some() {
            // Solvers are quick on fewer samples.
            recipe.world.cell *= 4.0;
        }
        let world = World::open(recipe).unwrap();
        let plan = world.plan(&["height"], &Window::new(65, 65, cell)).unwrap();
        let explained = world.explain(&plan).unwrap();
        if explained.contains("  apply `") || explained.contains("  refine `") {
            // A filter or a levelled op allocates grids for each chunk.
            continue;
        }
        if preset.name == "craters" {
            // Lists of the craters that reach a chunk are made for each.
            continue;
        }
        seen += 1;
        let sampler = Sampler::new(&world, "height").unwrap();
        for cells in [64, 256] {
            let chunk = Window::new(cells + 1, cells + 1, cell);
            let mut heights = vec![0.0; chunk.len()];
            let mut made = |x, y| sampler.fill(&chunk.at(x, y), &mut heights).unwrap();
            assert!(allocations(|| made(0, 0)) > 0, "the count works: the first chunk needs buffers");
            let count = allocations(|| (1..6).for_each(|i| made(i * 300, 1000)));
            assert_eq!(count, 0, "{}: chunks of {cells} cells", preset.name);
        }
        // Also in the smallest world.
        let at = |i: i32| sampler.at(f64::from(i) * 3.3, 123.5).unwrap();
        at(0);
        assert_eq!(allocations(|| (1..20).for_each(|i| assert!(at(i).is_finite()))), 0, "{}: points", preset.name);
    }
    assert!(seen > 3, "most presets end with fields or solvers");
}

/// Unbounded hills made of fields only.
const FIELDS: &str = "
orogen = 1
world.cell = 15
nodes.east = { op = \"fbm\", seed = 1, wavelength = 3000, octaves = 2 }
nodes.south = { op = \"fbm\", seed = 2, wavelength = 3000, octaves = 2 }
nodes.knolls = { op = \"billow\", seed = 4, wavelength = 2400, octaves = 5 }
nodes.high = { op = \"perlin\", seed = 3, wavelength = 4200 }
nodes.rolling = { op = \"expr\", expr = \"(1 + knolls) * abs(high)\" }
nodes.bent = { op = \"warp\", source = \"rolling\", x = \"east\", y = \"south\", strength = 800 }
nodes.terrain = { op = \"expr\", expr = \"60 + 210 * bent\" }
outputs.height = \"terrain\"
";

#[test]
fn volumes_of_fields_allocate_nothing_once_warm() {
    let text = FIELDS
        .replace("op = \"billow\",", "op = \"billow\", vertical = 0.5,")
        .replace("expr = \"60 + 210 * bent\"", "expr = \"60 + 210 * bent - altitude\"")
        + "nodes.altitude = { op = \"altitude\" }\n";
    let world = World::open(Recipe::parse(&text, "fields").unwrap()).unwrap();
    let sampler = Sampler::new(&world, "height").unwrap();
    let altitudes: Vec<f64> = (-20..20).map(f64::from).collect();
    let chunk = Window::new(16, 16, 1.0);
    let mut samples = vec![0.0; chunk.len() * altitudes.len()];
    let mut made = |x, y| sampler.fill_volume(&chunk.at(x, y), &altitudes, &mut samples).unwrap();
    assert!(allocations(|| made(0, 0)) > 0, "the count works: the first chunk needs buffers");
    assert_eq!(allocations(|| (1..6).for_each(|i| made(i * 300, -1000))), 0);
    // The density falls by one metre per metre of altitude, plus noise.
    assert!(samples[0] > samples[samples.len() - 1]);
}

#[test]
fn a_walk_through_chunks_allocates_nothing_once_warm() {
    let world = World::open(Recipe::parse(FIELDS, "fields").unwrap()).unwrap();
    let sampler = Sampler::new(&world, "height").unwrap();
    let mut chunks = world.chunks(LodConfig::default().with_cells(32).with_cell(4.0).with_range(4000.0)).unwrap();
    let mut heights = vec![0.0; 33 * 33];
    let mut walk = |chunks: &mut Chunks| {
        let mut made = 0;
        for step in 0..160 {
            let along = f64::from(80 - i32::abs(step - 80)) * 60.0;
            chunks.set_viewer(along, -0.5 * along).unwrap();
            while let Some(step) = chunks.next_step() {
                if let ChunkStep::Make(id) = step {
                    sampler.fill(&chunks.window(id), &mut heights).unwrap();
                    made += 1;
                }
            }
        }
        made
    };
    // There and back; then the same path again.
    let first = walk(&mut chunks);
    let mut again = 0;
    assert_eq!(allocations(|| again = walk(&mut chunks)), 0);
    assert!(again > 1000 && first > again, "{first} and {again} chunks");
}
