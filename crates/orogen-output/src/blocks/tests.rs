//! Blocks of a whole world and of its parts.

use super::density::DENSITY;
use super::kind::Block;
use super::land::{Land, prepare};
use super::levels::{Extent, Levels};
use super::mesh::BlockMesh;
use super::volume::BlockVolume;
use orogen_engine::{Recipe, Window, World, presets};
use orogen_grid::progress::Progress;

/// The preset with caves, or without its density.
fn caves(has_density: bool) -> World {
    let recipe = presets::find("caves").unwrap().recipe().unwrap();
    let text = recipe.to_toml();
    let text = if has_density { text } else { text.replace("density = \"density\"", "other = \"density\"") };
    let mut recipe = Recipe::parse(&text, "caves").unwrap();
    prepare(&mut recipe, 1.0).unwrap();
    World::open(recipe).unwrap()
}

fn land(world: &World, window: Window, extent: Extent) -> Land {
    Land::of(world, &window, extent, &|_| Ok(()), &Progress::none()).unwrap()
}

#[test]
fn blocks_of_a_part_are_those_of_the_whole() {
    for has_density in [true, false] {
        let world = caves(has_density);
        let whole = land(&world, Window::new(384, 384, 1.0), Extent::Below(12));
        let volume = BlockVolume::of(&whole, &Progress::none()).unwrap();
        // Chunks in the middle and at the sides, of other levels, and one that is no chunk.
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
    // Columns in which air is below something solid that is no tree.
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
        // Water stands on ground or on water, and nothing grows in it.
        for at in layer..volume.blocks.len() {
            let [below, block] = [at - layer, at].map(|at| Block::of(volume.blocks[at]));
            assert!(block != Block::Water || below.is_solid() || below == Block::Water, "{below:?}");
            assert!(block != Block::Water || below != Block::Grass);
        }
    }
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
    // The eastern half of a mesh that is made apart has as many triangles as in the whole.
    assert_eq!((whole[1], east[1]), (2, 1));
    assert!(whole[0] > east[0] && east[0] > 2 * 64 * 64);
}

/// Water that is shallower than a block, and a river above the sea, have a block of water.
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
