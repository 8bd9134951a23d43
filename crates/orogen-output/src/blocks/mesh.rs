//! The surface of a land as triangles, with the colors of its blocks.
//!
//! Surface nets of the densities at the centers of the blocks, in chunks. Neighboring chunks have bit-identical
//! vertices along their common border.

use std::io::{self, Write};

use orogen_engine::Budget;
use orogen_engine::budget::Reservation;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;
use orogen_grid::progress::Progress;
use orogen_grid::surface_nets::Lattice;
use serde_json::Map;

use super::kind::Block;
use super::land::Land;
use super::levels::Levels;
use crate::mesh::body::BodyMesh;
use crate::mesh::glb::{self, Model};
use crate::mesh::water::WaterMesh;

/// Columns along a side of a chunk of the mesh.
const SIDE: usize = 64;

/// Color of water in linear light, and its opacity.
const WATER: [f32; 4] = [0.04, 0.15, 0.3, 0.75];

/// Memory per sample of a chunk while it is made, in bytes: its density, its block and its vertex number.
const SAMPLE: u64 = 4 + 1 + 4;

/// The surface of a land.
#[derive(Debug)]
pub struct BlockMesh {
    bodies: Vec<BodyMesh>,
    water: Vec<WaterMesh>,
    _memory: Vec<Reservation>,
}

/// Number of chunks of a window that are made at once.
fn at_once(window: &Window) -> usize {
    let parts = window.width.div_ceil(SIDE).saturating_mul(window.height.div_ceil(SIDE));
    parallel::threads().min(parts).max(1)
}

impl BlockMesh {
    /// Memory for the chunks that are made at once, in bytes, without the mesh.
    #[must_use]
    pub fn memory(window: &Window, levels: Levels) -> u64 {
        let samples = (SIDE + 2).pow(2) as u64 * levels.count as u64;
        samples.saturating_mul(SAMPLE).saturating_mul(at_once(window) as u64)
    }

    /// The surface of the window of a land. Memory is taken from `budget`.
    ///
    /// # Errors
    /// If there is not enough memory, or `progress` is cancelled.
    pub fn of(land: &Land, budget: &Budget, progress: &Progress) -> Result<BlockMesh> {
        let window = land.window;
        let parts: Vec<Window> = window.tiles(SIDE).collect();
        let at_once = at_once(&window);
        let _parts = budget.reserve(BlockMesh::memory(&window, land.levels))?;
        let (mut bodies, mut memory) = (Vec::new(), Vec::new());
        progress.expect(parts.len() as f64);
        for group in parts.chunks(at_once) {
            progress.check()?;
            let made: Vec<BodyMesh> = parallel::try_map(group, |part| body(land, part))?;
            for body in made {
                memory.push(budget.reserve(body.memory())?);
                bodies.push(body);
            }
            progress.advance(group.len() as f64);
        }
        bodies.retain(|body| !body.triangles.is_empty());
        let water = water(land);
        memory.push(budget.reserve(12 * (water.corners.len() + water.triangles.len()) as u64)?);
        let water = Some(water).filter(|water| !water.triangles.is_empty()).into_iter().collect();
        Ok(BlockMesh { bodies, water, _memory: memory })
    }

    /// Number of triangles of the ground, and number of chunks that hold them.
    #[must_use]
    pub fn triangles(&self) -> [usize; 2] {
        [self.bodies.iter().map(|body| body.triangles.len()).sum(), self.bodies.len()]
    }

    /// Writes a .glb file.
    ///
    /// # Errors
    /// If `out` fails, or the mesh exceeds the 4 GiB of the format.
    pub fn write_glb(&self, out: &mut dyn Write) -> io::Result<()> {
        let model = Model {
            levels: &[],
            texture: None,
            material: None,
            normal_maps: &[],
            bodies: &self.bodies,
            water: &self.water,
            objects: &[],
            extras: Map::new(),
        };
        glb::write(out, &model)
    }
}

/// The water of a land.
fn water(land: &Land) -> WaterMesh {
    let window = land.window;
    let level = |i: usize, j: usize| {
        let column = land.column(window.x + i as i64, window.y + j as i64)?;
        Some(column.water).filter(|water| water.is_finite())
    };
    let mut water = WaterMesh::new("water", WATER);
    water.cover(&Grid::filled(window, 0.0), level);
    water
}

/// A chunk of the surface.
fn body(land: &Land, part: &Window) -> Result<BodyMesh> {
    let (window, cell, levels) = (land.window, land.window.cell, land.levels);
    // One sample before the first and one after the last; beyond the land they repeat its sides.
    let size = [part.width + 2, part.height + 2, levels.count];
    let start = [part.x - 1, part.y - 1, i64::from(levels.bottom)];
    let mut densities = vec![f32::NEG_INFINITY; size.iter().product()];
    let layer = size[0] * size[1];
    for row in 0..size[1] {
        for across in 0..size[0] {
            land.densities(start[0] + across as i64, start[1] + row as i64, |k, density| {
                densities[k * layer + row * size[0] + across] = density;
            });
        }
    }
    let net = Lattice { start, size, densities: &densities }.net()?;
    let shown = part.grown(1).intersection(&window);
    let blocks = land.blocks(&shown)?;
    let block = |[x, y, z]: [i64; 3]| {
        let x = (x - shown.x).clamp(0, shown.width as i64 - 1) as usize;
        let y = (y - shown.y).clamp(0, shown.height as i64 - 1) as usize;
        let z = (z - i64::from(levels.bottom)) as usize;
        blocks.get((z * shown.height + y) * shown.width + x).map_or(Block::Air, |block| Block::of(*block))
    };
    let is_ground = |block: &Block| block.is_solid() && *block < Block::Log;
    let place = |cube: &[i64; 3], offset: &[f32; 3]| {
        let at = |axis: usize, from: i64| (((cube[axis] - from) as f64 + f64::from(offset[axis])) * cell) as f32;
        [at(0, window.x), (Levels::middle(cube[2] as i32, cell) + f64::from(offset[2]) * cell) as f32, at(1, window.y)]
    };
    let color = |cube: &[i64; 3]| {
        // The mean color of the blocks around the vertex that are open above, otherwise of the uppermost ones.
        let corners = (0..8).rev().map(|corner| [0, 1, 2].map(|axis| cube[axis] + (corner >> axis & 1)));
        let ground: Vec<([i64; 3], Block)> =
            corners.map(|at| (at, block(at))).filter(|(_, block)| is_ground(block)).collect();
        let is_open = |[x, y, z]: [i64; 3]| !is_ground(&block([x, y, z + 1]));
        let has_open = ground.iter().any(|(at, _)| is_open(*at));
        let top = ground.first().map_or(0, |(at, _)| at[2]);
        let shown = ground.iter().filter(|(at, _)| if has_open { is_open(*at) } else { at[2] == top });
        let (sum, count) = shown.fold(([0u32; 3], 0), |(sum, count), (_, block)| {
            let color = block.kind().color;
            ([0, 1, 2].map(|part| sum[part] + u32::from(color[part])), count + 1)
        });
        if count > 0 { sum.map(|sum| (sum / count) as u8) } else { Block::Stone.kind().color }
    };
    Ok(BodyMesh {
        name: format!("blocks {} {}", part.x, part.y),
        origin: [window.east(0), window.south(0)],
        corners: net.cubes.iter().zip(&net.offsets).map(|(cube, offset)| place(cube, offset)).collect(),
        normals: net.normals.iter().map(|[east, south, up]| [*east, *up, *south]).collect(),
        colors: net.cubes.iter().map(color).collect(),
        triangles: net.triangles,
    })
}
