//! Running a program on a device: tile by tile, kernel by kernel.

use super::kernel::{GRID_COLUMNS, GRID_LATTICE, GRID_ROWS, Kernel, Word, kernel, parts};
use super::positions;
use crate::failure::Failure;
use crate::gpu::Gpu;
use crate::job::{Dispatch, Job};
use crate::layers::Layers;
use crate::source::Source;
use crate::tiles::fitting;
use orogen_engine::device::{Lowered, LoweredProgram, PlanGrid};
use orogen_grid::grid::Window;
use orogen_noise::shader::function::Shader;
use orogen_noise::shader::lattice::{Lattice, Positions};
use std::collections::BTreeMap;

/// A program that runs over a window.
struct Run<'a> {
    program: &'a LoweredProgram,
    grids: &'a [Source<'a>],
    kernels: Vec<Kernel>,
    /// For each instruction, whether it reads a grid that has the samples of the window.
    copies: Vec<bool>,
    /// The slot of each value that is kept between kernels or is an output.
    slots: BTreeMap<usize, usize>,
    /// Number of slots.
    slot_count: usize,
}

/// The outputs of a program over a window; `None` if it was cancelled. `most` is the maximum weight of a part of the
/// program.
pub(crate) fn run(
    gpu: &Gpu,
    program: &LoweredProgram,
    window: &Window,
    grids: &[&PlanGrid],
    most: usize,
    is_cancelled: impl Fn() -> bool,
) -> Result<Option<Vec<PlanGrid>>, Failure> {
    let grids = grids.iter().map(|grid| Source::of(gpu, grid)).collect::<Result<Vec<_>, _>>()?;
    let run = Run::new(program, window, &grids, most);
    let limit = gpu.buffer_limit();
    let Some(tiles) = fitting(window, |tile| run.bytes(tile).into_iter().max() <= Some(limit)) else {
        return Err(Failure::Memory(format!("a program and its grids need buffers of more than {limit} bytes")));
    };
    let mut layers = Layers::new(gpu, window, program.outputs.len())?;
    for tile in tiles {
        let firsts: Vec<usize> = program.outputs.iter().map(|value| run.slot(*value, &tile)).collect();
        if !layers.run(gpu, run.tile(&tile)?, &tile, (&firsts, tile.width), &is_cancelled)? {
            return Ok(None);
        }
    }
    Ok(Some(layers.into_grids()))
}

impl<'a> Run<'a> {
    fn new(program: &'a LoweredProgram, window: &Window, grids: &'a [Source<'a>], most: usize) -> Run<'a> {
        let is_copy = |instruction: &Lowered| match instruction {
            Lowered::Grid { grid, coords: 0, .. } => {
                grids.get(*grid).is_some_and(|grid| grid.window().cell == window.cell && grid.window().contains(window))
            }
            _ => false,
        };
        let copies: Vec<bool> = program.instructions.iter().map(is_copy).collect();
        let parts = parts(program, most);
        // The last part that reads each value.
        let part_of = |i: usize| parts.partition_point(|part| part.end <= i);
        let mut last: Vec<usize> = (0..program.instructions.len()).map(part_of).collect();
        for i in 0..program.instructions.len() {
            for value in program.reads(i) {
                last[value] = last[value].max(part_of(i));
            }
        }
        program.outputs.iter().for_each(|value| last[*value] = parts.len());
        let is_constant = |i: usize| matches!(program.instructions[i], Lowered::Constant(_));
        let is_output = |i: usize| program.outputs.contains(&i);
        let (mut slots, mut free, mut slot_count, mut kernels) = (BTreeMap::new(), Vec::new(), 0, Vec::new());
        for (p, part) in parts.iter().enumerate() {
            let kept: Vec<usize> =
                part.clone().filter(|i| last[*i] > p && (is_output(*i) || !is_constant(*i))).collect();
            for value in &kept {
                let slot = free.pop().unwrap_or_else(|| {
                    slot_count += 1;
                    slot_count - 1
                });
                slots.insert(*value, slot);
            }
            kernels.push(kernel(program, part.clone(), &kept, &copies));
            // A slot whose value was read for the last time is free for the next part.
            free.extend(slots.iter().filter(|(value, _)| last[**value] == p).map(|(_, slot)| *slot));
        }
        Run { program, grids, kernels, copies, slots, slot_count }
    }

    /// An upper bound of the sizes of the buffers of samples and of data for a tile, in bytes.
    fn bytes(&self, tile: &Window) -> [u64; 2] {
        let grids: usize = (0..self.grids.len()).map(|k| self.part(k, tile).len()).sum();
        // A block, and tables of columns and rows along both axes.
        let table = 16 + 2 * 3 * (tile.width + tile.height);
        let tables = |instruction: &Lowered| match instruction {
            Lowered::Field { shader, .. } => shader.words.len() + shader.lattices.len() * table,
            Lowered::Grid { .. } => table,
            _ => 4,
        };
        let data: usize = self.program.instructions.iter().map(tables).sum();
        [4 * (grids + self.slot_count * tile.len()) as u64, 4 * (data + 16) as u64]
    }

    /// The job of a tile.
    ///
    /// # Errors
    /// If a grid does not cover the samples that are read.
    fn tile(&self, tile: &Window) -> Result<Job<'_>, Failure> {
        let sets = positions::of_sets(&self.program.coord_sets, tile);
        let mut job = Job { samples: self.slot_count * tile.len(), ..Job::default() };
        let mut starts = Vec::with_capacity(self.grids.len());
        for (k, grid) in self.grids.iter().enumerate() {
            let part = self.part(k, tile);
            starts.push(job.samples);
            job.samples += part.len();
            grid.add_to(&mut job, part, starts[k])?;
        }
        // The first word is reserved: index 0 means no table.
        let mut data = vec![0];
        for kernel in &self.kernels {
            let words: Vec<u32> = kernel
                .words
                .iter()
                .map(|word| match word {
                    Word::Number(number) => number.to_bits(),
                    Word::Slot(value) => self.slot(*value, tile) as u32,
                    Word::Function(i) => match &self.program.instructions[*i] {
                        Lowered::Field { shader, coords, .. } => shader.encode(&sets[*coords], *coords != 0, &mut data),
                        _ => 0,
                    },
                    Word::Grid(i) => self.grid(*i, tile, &sets, &starts, &mut data),
                })
                .collect();
            let base = data.len() as u32;
            data.extend(words);
            job.dispatches.push(Dispatch {
                text: &kernel.text,
                base,
                size: [tile.width as u32, tile.height as u32],
                ..Dispatch::default()
            });
        }
        Ok(Job { data, ..job })
    }

    /// The part of a grid that a tile reads: the tile itself if the grid is only copied, otherwise the whole grid.
    fn part<'b>(&'b self, grid: usize, tile: &'b Window) -> &'b Window {
        let reads = self.program.instructions.iter().zip(&self.copies);
        let mut reads = reads.filter(|(read, _)| matches!(read, Lowered::Grid { grid: read, .. } if *read == grid));
        if reads.all(|(_, is_copy)| *is_copy) { tile } else { self.grids[grid].window() }
    }

    /// The index of the first sample of a value that is kept.
    fn slot(&self, value: usize, tile: &Window) -> usize {
        self.slots.get(&value).copied().unwrap_or(0) * tile.len()
    }

    /// Appends the block of the grid that an instruction reads; returns its index.
    fn grid(&self, i: usize, tile: &Window, sets: &[Positions], starts: &[usize], data: &mut Vec<u32>) -> u32 {
        let Lowered::Grid { grid, coords, .. } = self.program.instructions[i] else { return 0 };
        let (window, start) = (self.part(grid, tile), starts[grid] as i64);
        if self.copies[i] {
            let first = start + (tile.y - window.y) * window.width as i64 + (tile.x - window.x);
            let base = data.len();
            data.resize(base + GRID_ROWS, 0);
            (data[base], data[base + GRID_COLUMNS]) = (first as u32, window.width as u32);
            return base as u32;
        }
        let lattice = Lattice::square(1.0 / window.cell, [-(window.x as f64), -(window.y as f64)]);
        let mut words = vec![start as u32; GRID_LATTICE];
        (words[GRID_COLUMNS], words[GRID_ROWS]) = (window.width as u32, window.height as u32);
        Shader { words, ..Shader::new("", "", &[]) }.on(lattice).encode(&sets[coords], true, data)
    }
}
