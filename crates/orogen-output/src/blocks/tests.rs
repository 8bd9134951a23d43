//! Blocks of a whole world and of its parts.

use super::caves::{BELOW, add};
use super::density::DENSITY;
use super::kind::Block;
use super::land::{Land, prepare};
use super::levels::{Extent, Levels};
use super::mesh::BlockMesh;
use super::section::Section;
use super::volume::BlockVolume;
use orogen_engine::{Recipe, Window, World, presets};
use orogen_grid::progress::Progress;

/// The preset with caves, with or without its density.
fn caves(has_density: bool) -> World {
    let recipe = presets::find("caves").unwrap().recipe().unwrap();
    let text = recipe.to_toml();
    let text = if has_density { text } else { text.replace("density = \"density\"", "other = \"density\"") };
    let mut recipe = Recipe::parse(&text, "caves").unwrap();
    prepare(&mut recipe, 1.0).unwrap();
    World::open(recipe).unwrap()
}

fn land(world: &World, window: Window, extent: Extent) -> Land {
    Land::of(world, &window, extent, 1.0, &|_| Ok(()), &Progress::none()).unwrap()
}

#[test]
fn blocks_of_a_part_are_those_of_the_whole() {
    for has_density in [true, false] {
        let world = caves(has_density);
        let whole = land(&world, Window::new(384, 384, 1.0), Extent::Below(12));
        let volume = BlockVolume::of(&whole, &Progress::none()).unwrap();
        // Chunks in the middle and at the sides, with other levels, and a window that is not a chunk.
        for (x, y, width, height) in [(0, 0, 16, 16), (368, 368, 16, 16), (160, 208, 16, 16), (83, 117, 37, 5)] {
            for (bottom, top) in [(-20, 90), (3, 19), (-6, -2), (30, 40)] {
                let window = Window::new(width, height, 1.0).at(x, y);
                let part = land(&world, window, Extent::Levels(Levels::between(bottom, top)));
                let blocks = part.blocks(&window).unwrap();
                for (at, block) in blocks.iter().enumerate() {
                    let [column, row, level] = [at % width, at / width % height, at / width / height];
                    let level = bottom + level as i32;
                    if level < volume.levels.bottom {
                        continue;
                    }
                    let there = [x + column as i64, y + row as i64, i64::from(level - volume.levels.bottom)];
                    assert_eq!(Block::of(*block), volume.block(there), "{there:?} {has_density} {bottom}");
                }
            }
        }
        assert!(whole.blocks(&whole.window.grown(1)).is_err());
    }
}

#[test]
fn caves_are_in_the_ground_and_overhangs_above_it() {
    let volumes = [true, false].map(|has_density| {
        let world = caves(has_density);
        let land = land(&world, Window::new(384, 384, 1.0), Extent::Below(12));
        BlockVolume::of(&land, &Progress::none()).unwrap()
    });
    let layer = 384 * 384;
    // Columns with air below something solid that is not a tree.
    let roofed = volumes.each_ref().map(|volume| {
        let is_roofed = |column: usize| {
            let kinds = (0..volume.levels.count).map(|level| Block::of(volume.blocks[level * layer + column]));
            let kinds: Vec<Block> = kinds.filter(|block| *block < Block::Log).collect();
            kinds.windows(2).any(|pair| pair[0] == Block::Air && pair[1].is_solid())
        };
        (0..layer).filter(|column| is_roofed(*column)).count()
    });
    assert!(roofed[0] > layer / 20 && roofed[1] == 0, "{roofed:?}");
    for volume in &volumes {
        let counts = volume.counts();
        for block in
            [Block::Water, Block::Snow, Block::Grass, Block::Sand, Block::Coal, Block::Iron, Block::Log, Block::Leaves]
        {
            assert!(counts[block as usize] > 10, "{block:?}");
        }
        // Water lies on ground or on water, and nothing grows in it.
        for at in layer..volume.blocks.len() {
            let [below, block] = [at - layer, at].map(|at| Block::of(volume.blocks[at]));
            assert!(block != Block::Water || below.is_solid() || below == Block::Water, "{below:?}");
            assert!(block != Block::Water || below != Block::Grass);
        }
    }
}

/// A world of hills with a lake, and a sea in the west.
fn hills(has_caves: bool) -> World {
    let text = "orogen = 1\n[world]\nsize = [200, 160]\ncell = 2\n[nodes.noise]\nop = \"fbm\"\nwavelength = 90\nseed = 5\n[nodes.land]\nop = \"expr\"\n\
                expr = \"noise * 70 + 30\"\n[nodes.lakes]\nop = \"expr\"\nexpr = \"(noise > 0.1) * (noise < 0.13)\"\n[outputs]\nheight = \"land\"\nlakes = \"lakes\"\n";
    let mut recipe = Recipe::parse(text, "hills").unwrap();
    prepare(&mut recipe, 1.0).unwrap();
    if has_caves {
        add(&mut recipe, 1.0).unwrap();
    }
    World::open(recipe).unwrap()
}

#[test]
fn caves_of_any_recipe_open_to_the_surface_and_keep_from_water() {
    let window = Window::new(200, 160, 1.0);
    let volumes = [true, false].map(|has_caves| {
        let land = land(&hills(has_caves), window, Extent::Below(BELOW));
        BlockVolume::of(&land, &Progress::none()).unwrap()
    });
    let [caves, solid] = &volumes;
    assert_eq!(solid.enclosed(), 0);
    assert!(caves.enclosed() > 2000, "{}", caves.enclosed());
    let air = volumes.each_ref().map(|volume| volume.counts()[Block::Air as usize]);
    // There are as many levels as the caves have above the ground, all of air.
    let layer = 200 * 160;
    let opened = (0..layer).filter(|column| {
        let at = [column % 200, column / 200];
        caves.ground(at).unwrap_or(0) < solid.ground(at).unwrap_or(0)
    });
    let opened = opened.count();
    assert!(air[0] > air[1] && opened > 50 && opened < layer / 4, "{opened}");
    // All water is where it was, and no cave is below it, next to it or through the bottom.
    let mut water = 0;
    for column in 0..layer {
        let [x, y] = [(column % 200) as i64, (column / 200) as i64];
        let blocks = |volume: &BlockVolume| -> Vec<Block> {
            (0..solid.levels.count as i64).map(|level| volume.block([x, y, level])).collect()
        };
        let (with, without) = (blocks(caves), blocks(solid));
        assert!(with[0].is_solid());
        if without.contains(&Block::Water) {
            let ground = |blocks: &[Block]| blocks.iter().map(|block| block.is_solid()).collect::<Vec<_>>();
            assert_eq!(ground(&with), ground(&without), "{x} {y}");
            water += 1;
        }
        assert_eq!(
            with.iter().filter(|block| **block == Block::Water).count(),
            without.iter().filter(|block| **block == Block::Water).count()
        );
    }
    assert!(water > 1000 && water < layer / 2, "{water}");
    // Any part gives the same blocks.
    let window = Window::new(30, 20, 1.0).at(90, 70);
    let part = land(&hills(true), window, Extent::Levels(Levels::between(-30, 60)));
    let blocks = part.blocks(&window).unwrap();
    for (at, block) in blocks.iter().enumerate() {
        let [column, row, level] = [at % 30, at / 30 % 20, at / 600];
        let level = i64::from(-30 - caves.levels.bottom) + level as i64;
        if level >= 0 {
            assert_eq!(Block::of(*block), caves.block([90 + column as i64, 70 + row as i64, level]), "{at}");
        }
    }
    let mut shaped = presets::find("caves").unwrap().recipe().unwrap();
    prepare(&mut shaped, 1.0).unwrap();
    assert!(add(&mut shaped, 1.0).unwrap_err().to_string().contains("an output `density`"));
}

#[test]
fn exaggeration_is_of_the_ground_the_water_and_the_density() {
    for world in [hills(false), caves(true)] {
        let window = Window::new(120, 90, 1.0).at(60, 50);
        let tall = |exaggeration: f64| {
            let land =
                Land::of(&world, &window, Extent::Below(0), exaggeration, &|_| Ok(()), &Progress::none()).unwrap();
            let heights: Vec<f32> = land.columns.iter().map(|column| column.height).collect();
            (heights, land)
        };
        let ((heights, once), (exaggerated, twice)) = (tall(1.0), tall(2.0));
        let is_wet = |k: &usize| once.columns[*k].water > f32::NEG_INFINITY;
        assert!((0..heights.len()).filter(|k| !is_wet(k)).all(|k| exaggerated[k] == 2.0 * heights[k]));
        assert!((0..heights.len()).filter(is_wet).all(|k| twice.columns[k].water == 2.0 * once.columns[k].water));
        let [[low, high], [lower, higher]] = [&once, &twice].map(|land| [land.levels.bottom, land.levels.top()]);
        assert!(higher - lower > (high - low) * 3 / 2 && higher > high, "{low} {high} {lower} {higher}");
        if let (Some(once), Some(twice)) = (&once.offsets, &twice.offsets) {
            // At the same position of the land, half as high.
            let [mut a, mut b] = [Vec::new(), Vec::new()];
            once.column([100, 80], &mut a);
            twice.column([100, 80], &mut b);
            let apart = (0..20).map(|level| (2.0 * once.at(&a, level) - twice.at(&b, 2 * level)).abs());
            assert!(apart.fold(0.0, f32::max) < 12.0);
        }
    }
}

#[test]
fn a_section_shows_the_blocks_of_a_row_or_a_column() {
    let window = Window::new(200, 160, 1.0);
    let land = land(&hills(true), window, Extent::Below(20));
    let volume = BlockVolume::of(&land, &Progress::none()).unwrap();
    let levels = volume.levels.count;
    // The row and the column with the most open blocks below the ground.
    let enclosed = |at: [usize; 2]| {
        let free = |level: &usize| volume.block([at[0] as i64, at[1] as i64, *level as i64]) == Block::Air;
        (0..volume.ground(at).unwrap_or(0)).filter(free).count()
    };
    let of_row = |row: usize| (0..200).map(|column| enclosed([column, row])).sum::<usize>();
    let of_column = |column: usize| (0..160).map(|row| enclosed([column, row])).sum::<usize>();
    let row = (0..160).max_by_key(|row| of_row(*row)).unwrap();
    let column = (0..200).max_by_key(|column| of_column(*column)).unwrap();
    assert!(of_row(row) > 50 && of_column(column) > 50);
    assert_eq!((0..160).map(of_row).sum::<usize>() as u64, volume.enclosed());
    for (text, across, expect) in
        [(format!("row={row}"), 200, of_row(row)), (format!(" column = {column}"), 160, of_column(column))]
    {
        let section = Section::parse(&text).unwrap();
        let side = section.check(&window, levels).unwrap();
        let mut bytes = Vec::new();
        section.write(&mut bytes, &volume, &[]).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut pixels).unwrap();
        assert_eq!([frame.width as usize, frame.height as usize], [side * across, side * levels]);
        let mut caves = 0;
        for k in 0..across {
            let at = if across == 200 { [k as i64, row as i64] } else { [column as i64, k as i64] };
            for level in 0..levels {
                let middle = ((levels - 1 - level) * side + side / 2) * side * across + k * side + side / 2;
                let color = &pixels[3 * middle..3 * middle + 3];
                match volume.block([at[0], at[1], level as i64]) {
                    Block::Air => caves += usize::from(color[0] < 100),
                    block => assert_eq!(color, block.kind().color),
                }
            }
        }
        assert_eq!(caves, expect);
    }
    for (text, expect) in
        [("70", "must be row=N or column=N"), ("row=x", "must be"), ("line=3", "must be"), ("row=-1", "must be")]
    {
        assert!(Section::parse(text).unwrap_err().to_string().contains(expect), "{text}");
    }
    let why = Section::Row(160).check(&window, levels).unwrap_err().to_string();
    assert_eq!(why, "there is no row 160 to cut along; the window has the rows 0 to 159");
    assert!(Section::Column(0).check(&window, 20_000).unwrap_err().to_string().contains("at most 16384 pixels"));
}

#[test]
fn a_density_that_is_the_height_changes_nothing() {
    let text = |density: &str| {
        format!(
            "orogen = 1\n[world]\nsize = [96, 64]\ncell = 1\n[nodes.noise]\nop = \"fbm\"\nwavelength = 40\n[nodes.land]\nop = \"expr\"\n\
             expr = \"noise * 20 + 1\"\n[nodes.up]\nop = \"altitude\"\n[nodes.solid]\nop = \"expr\"\nexpr = \"land - up\"\n\
             [outputs]\nheight = \"land\"\n{density} = \"solid\"\n"
        )
    };
    let [with, without] = [DENSITY, "other"].map(|name| {
        let mut recipe = Recipe::parse(&text(name), "plain").unwrap();
        prepare(&mut recipe, 1.0).unwrap();
        let world = World::open(recipe).unwrap();
        let land = land(&world, Window::new(96, 64, 1.0), Extent::Below(5));
        BlockVolume::of(&land, &Progress::none()).unwrap()
    });
    assert_eq!((with.levels, with.blocks == without.blocks), (without.levels, true));
}

#[test]
fn parts_of_a_mesh_share_their_borders() {
    let world = caves(true);
    let [whole, east] = [(0, 128), (64, 64)].map(|(x, width)| {
        let window = Window::new(width, 64, 1.0).at(160 + x, 160);
        let land = land(&world, window, Extent::Below(4));
        let mesh = BlockMesh::of(&land, world.budget(), &Progress::none()).unwrap();
        let mut out = Vec::new();
        mesh.write_glb(&mut out).unwrap();
        assert!(out.starts_with(b"glTF"));
        mesh.triangles()
    });
    // The eastern half of a mesh that is made separately has as many triangles as in the whole mesh.
    assert_eq!((whole[1], east[1]), (2, 1));
    assert!(whole[0] > east[0] && east[0] > 2 * 64 * 64);
}

/// Water shallower than a block, and a river above the sea, have a block of water.
#[test]
fn what_is_water_in_a_map_has_water() {
    let recipe = r#"
        orogen = 1
        world = { size = [64, 64], cell = 1, sea_level = 0 }
        outputs = { height = "height", class = "class" }
        nodes.east = { op = "ramp", origin = [0, 0], length = 64, azimuth = 90 }
        nodes.height = { op = "expr", expr = "30 * east - 0.3 * (east < 0.25)" }
        nodes.class = { op = "expr", expr = "2 * (1 - (east < 0.25)) * (1 - (east > 0.5) * (east < 0.6))" }
    "#;
    let mut recipe = Recipe::parse(recipe, "test").unwrap();
    prepare(&mut recipe, 1.0).unwrap();
    let world = World::open(recipe).unwrap();
    let land = land(&world, Window::new(64, 1, 1.0), Extent::Below(4));
    let volume = BlockVolume::of(&land, &Progress::none()).unwrap();
    for x in 0..64 {
        let levels = (0..land.levels.count as i64).map(|level| volume.block([x, 0, level]));
        let water = levels.filter(|block| *block == Block::Water).count();
        let is_water = x < 16 || (33..=38).contains(&x);
        assert_eq!(water > 0, is_water, "column {x}: {water}");
    }
}
