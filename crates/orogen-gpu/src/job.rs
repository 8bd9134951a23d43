//! Jobs: work on a device, with grids that are copied there, shaders that are run, and grids that are copied back.

use crate::failure::Failure;
use crate::gpu::{Gpu, Moved};
use crate::pipelines::{FRAME, FRAME_WORDS};
use crate::resident::{Resident, download};
use std::borrow::Cow;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::time::Instant;

/// Columns and rows of a workgroup.
pub const GROUP: u32 = 8;

/// One run of a shader.
#[derive(Debug, Clone, Default)]
pub struct Dispatch<'a> {
    /// The shader's text after the header. Its entry point is `main`, with workgroups of 8 x 8.
    pub text: &'a str,
    /// Index of its first word in the data.
    pub base: u32,
    /// Number of columns and rows.
    pub size: [u32; 2],
    /// A number for the shader, such as the number of the iteration.
    pub step: u32,
    /// For a pass over planes: their columns and rows, and the index of their first sample.
    pub planes: [u32; 3],
}

/// A part of a grid on the device, and its position among the samples of a job.
#[derive(Clone)]
pub struct Part<'a> {
    /// The grid.
    pub resident: &'a Resident,
    /// Index of the part's first sample in the grid.
    pub first: usize,
    /// Index of its first sample among the samples of the job.
    pub at: usize,
    /// Number of samples of the job from row to row.
    pub stride: usize,
    /// Number of columns and rows.
    pub size: [usize; 2],
}

const COPY: &str = include_str!("copy.wgsl");

/// Work on a device.
#[derive(Default)]
pub struct Job<'a> {
    /// Numbers and tables.
    pub data: Vec<u32>,
    /// Number of samples in all grids.
    pub samples: usize,
    /// Grids that are copied to the device, with the index of their first sample.
    pub uploads: Vec<(usize, Cow<'a, [f32]>)>,
    /// Parts of grids on the device that are copied to the samples.
    pub loads: Vec<Part<'a>>,
    /// The shaders to run, in order.
    pub dispatches: Vec<Dispatch<'a>>,
    /// Grids that are copied back: the index of their first sample, and the number of samples.
    pub downloads: Vec<(usize, usize)>,
    /// Parts of the samples that are copied to grids on the device.
    pub stores: Vec<Part<'a>>,
}

impl Job<'_> {
    /// Memory on the device, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        let downloads: usize = self.downloads.iter().map(|(_, count)| count).sum();
        let frames = self.loads.len() + self.dispatches.len() + self.stores.len();
        4 * (self.data.len() + self.samples + downloads) as u64 + FRAME * frames as u64
    }

    /// Runs the job and returns the downloads. `is_cancelled` is called between parts of the work. Without downloads
    /// the work may not have ended on return; later jobs run after it.
    ///
    /// # Errors
    /// If the device was lost, has too little memory, or refuses a shader; `Ok(None)` if the work was cancelled.
    pub fn run(&self, gpu: &Gpu, is_cancelled: impl Fn() -> bool) -> Result<Option<Vec<Vec<f32>>>, Failure> {
        gpu.scoped(|| self.submit(gpu, None, is_cancelled))
    }

    /// [`run`](Job::run) with at most `together` dispatches at once, or fewer if each of them takes long.
    ///
    /// # Errors
    /// The errors of [`run`](Job::run).
    pub fn run_in_parts(
        &self,
        gpu: &Gpu,
        together: usize,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Option<Vec<Vec<f32>>>, Failure> {
        gpu.scoped(|| self.submit(gpu, Some(together.max(1)), is_cancelled))
    }

    fn submit(
        &self,
        gpu: &Gpu,
        together: Option<usize>,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Option<Vec<Vec<f32>>>, Failure> {
        use wgpu::BufferUsages as Usage;
        let (device, queue) = (gpu.device(), gpu.queue());
        gpu.begin();
        let data = gpu.buffer(self.data.len(), Usage::STORAGE | Usage::COPY_DST);
        let samples = gpu.buffer(self.samples, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC);
        let mut frames = Frames::default();
        let loads: Vec<u32> = self.loads.iter().map(|part| frames.of(part.frame(true))).collect();
        let offsets: Vec<u32> = self.dispatches.iter().map(|dispatch| frames.of(dispatch.frame())).collect();
        let stores: Vec<u32> = self.stores.iter().map(|part| frames.of(part.frame(false))).collect();
        let frames = {
            let buffer = gpu.buffer(frames.words.len(), Usage::UNIFORM | Usage::COPY_DST);
            queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&frames.words));
            buffer
        };
        queue.write_buffer(&data, 0, bytemuck::cast_slice(&self.data));
        for (start, grid) in &self.uploads {
            queue.write_buffer(&samples, 4 * *start as u64, bytemuck::cast_slice(grid));
        }
        let there = self.uploads.iter().map(|(_, grid)| grid.len() as u64).sum();
        gpu.count_moved(Moved { there, back: 0 });
        if is_cancelled() {
            return Ok(None);
        }
        let loads = self.loads.iter().zip(loads);
        let loads: Vec<Copy> = loads
            .map(|(part, offset)| Copy::new(gpu, [&part.resident.buffer, &samples, &frames], offset, part.size))
            .collect();
        copy(gpu, &loads)?;
        let bindings = gpu.pipelines().bind(device, [&data, &samples, &frames]);
        // The passes of a solver share few texts, and comparing texts takes longer than a dispatch.
        let mut pipelines = HashMap::new();
        let mut done = 0;
        while done < self.dispatches.len() {
            if is_cancelled() {
                return Ok(None);
            }
            // Waiting for the previous part has ended its time measurement.
            gpu.begin();
            let now = done..(done + together.unwrap_or_else(|| gpu.together())).min(self.dispatches.len());
            let (dispatches, offsets) = (&self.dispatches[now.clone()], &offsets[now.clone()]);
            let begun = Instant::now();
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            for (dispatch, offset) in dispatches.iter().zip(offsets) {
                let pipeline = match pipelines.entry(dispatch.text.as_ptr()) {
                    Entry::Occupied(known) => known.into_mut(),
                    Entry::Vacant(new) => new.insert(gpu.pipelines().of(device, dispatch.text)?),
                };
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, &bindings, &[*offset]);
                let [width, height] = dispatch.size;
                pass.dispatch_workgroups(width.div_ceil(GROUP), height.div_ceil(GROUP), 1);
            }
            drop(pass);
            queue.submit([encoder.finish()]);
            // The next part waits for this one, so that a cancelled job leaves little behind.
            if now.len() < self.dispatches.len() {
                gpu.wait()?;
                gpu.took(now.len(), begun.elapsed());
            }
            done = now.end;
        }
        let stores: Vec<Copy> = self
            .stores
            .iter()
            .zip(stores)
            .map(|(part, offset)| Copy::new(gpu, [&samples, &part.resident.buffer, &frames], offset, part.size))
            .collect();
        copy(gpu, &stores)?;
        if self.downloads.is_empty() {
            return Ok(Some(Vec::new()));
        }
        let parts: Vec<_> = self.downloads.iter().map(|(first, count)| (&samples, *first, *count)).collect();
        download(gpu, &parts).map(Some)
    }
}

/// The words of a frame, without padding.
type Frame = [u32; FRAME_WORDS - 1];

/// The frames of dispatches; equal frames are stored once.
#[derive(Default)]
struct Frames {
    words: Vec<u32>,
    known: HashMap<Frame, u32>,
}

impl Frames {
    /// The offset of a frame, in bytes.
    fn of(&mut self, frame: Frame) -> u32 {
        *self.known.entry(frame).or_insert_with(|| {
            let start = self.words.len();
            self.words.extend(frame);
            self.words.resize(start + FRAME as usize / 4, 0);
            4 * start as u32
        })
    }
}

impl Dispatch<'_> {
    fn frame(&self) -> Frame {
        let [columns, rows, first] = self.planes;
        [self.base, self.size[0], self.size[1], self.step, 0, 0, columns, rows, first]
    }
}

impl Part<'_> {
    /// The frame of the copy to the job's samples, or back.
    fn frame(&self, is_load: bool) -> Frame {
        let ends = [(self.first, self.resident.window.width), (self.at, self.stride)];
        let [from, to] = if is_load { ends } else { [ends[1], ends[0]] };
        [from.0, self.size[0], self.size[1], to.0, from.1, to.1, 0, 0, 0].map(|word| word as u32)
    }
}

/// A copy from buffer to buffer.
struct Copy {
    bindings: wgpu::BindGroup,
    offset: u32,
    size: [usize; 2],
}

impl Copy {
    /// A copy from one buffer to another, with its frame.
    fn new(gpu: &Gpu, buffers: [&wgpu::Buffer; 3], offset: u32, size: [usize; 2]) -> Copy {
        Copy { bindings: gpu.pipelines().bind(gpu.device(), buffers), offset, size }
    }
}

/// Copies parts of buffers.
fn copy(gpu: &Gpu, copies: &[Copy]) -> Result<(), Failure> {
    if copies.is_empty() {
        return Ok(());
    }
    let pipeline = gpu.pipelines().of(gpu.device(), COPY)?;
    let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    for Copy { bindings, offset, size: [width, height] } in copies {
        pass.set_bind_group(0, bindings, &[*offset]);
        pass.dispatch_workgroups((*width as u32).div_ceil(GROUP), (*height as u32).div_ceil(GROUP), 1);
    }
    drop(pass);
    gpu.queue().submit([encoder.finish()]);
    Ok(())
}
