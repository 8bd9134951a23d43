//! One piece of work on a device: what is copied there, what is run, and what is copied back.

use crate::failure::Failure;
use crate::gpu::Gpu;
use crate::pipelines::FRAME;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Columns and rows of a workgroup.
pub const GROUP: u32 = 8;

/// One run of a shader.
#[derive(Debug, Clone)]
pub struct Dispatch<'a> {
    /// The shader's text after the header. Its entry point is `main`, with workgroups of 8 x 8.
    pub text: &'a str,
    /// Index of its first word in the data.
    pub base: u32,
    /// Number of columns and rows.
    pub size: [u32; 2],
    /// Any number, such as that of the iteration.
    pub step: u32,
}

/// Work on a device.
#[derive(Debug, Default)]
pub struct Job<'a> {
    /// Numbers and tables.
    pub data: Vec<u32>,
    /// Number of samples in all grids.
    pub samples: usize,
    /// Grids that are copied to the device, with the index of their first sample.
    pub uploads: Vec<(usize, &'a [f32])>,
    /// What is run, in order.
    pub dispatches: Vec<Dispatch<'a>>,
    /// Grids that are copied back: the index of their first sample, and the number of samples.
    pub downloads: Vec<(usize, usize)>,
}

/// Maximum number of dispatches that are submitted together, so that a long job can be cancelled and no driver ends it as a hang.
const TOGETHER: usize = 64;

/// The longest wait for buffers to be readable once all work is done.
const MAPPED: Duration = Duration::from_secs(10);

impl Job<'_> {
    /// Memory on the device, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        let downloads: usize = self.downloads.iter().map(|(_, count)| count).sum();
        4 * (self.data.len() + self.samples + downloads) as u64 + FRAME * self.dispatches.len() as u64
    }

    /// Runs it; returns the downloads. `is_cancelled` is asked between parts of the work.
    ///
    /// # Errors
    /// If the device was lost, has too little memory, or refuses a shader; `Ok(None)` if the work was cancelled.
    pub fn run(&self, gpu: &Gpu, is_cancelled: impl Fn() -> bool) -> Result<Option<Vec<Vec<f32>>>, Failure> {
        self.run_in_parts(gpu, TOGETHER, is_cancelled)
    }

    /// The same with at most `together` dispatches at once: fewer, if each of them takes long.
    ///
    /// # Errors
    /// Those of [`run`](Job::run).
    pub fn run_in_parts(
        &self,
        gpu: &Gpu,
        together: usize,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Option<Vec<Vec<f32>>>, Failure> {
        gpu.check()?;
        let device = gpu.device();
        let out_of_memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let invalid = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let done = self.submit(gpu, together.max(1), is_cancelled);
        let invalid = pollster::block_on(invalid.pop());
        let out_of_memory = pollster::block_on(out_of_memory.pop());
        gpu.check()?;
        if let Some(error) = out_of_memory {
            return Err(Failure::Memory(error.to_string()));
        }
        if let Some(error) = invalid {
            return Err(Failure::Driver(error.to_string()));
        }
        done
    }

    /// The frames of all dispatches, equal ones once, and the offset of each dispatch's frame in bytes.
    fn frames(&self) -> (Vec<u32>, Vec<u32>) {
        let (mut words, mut known) = (Vec::new(), HashMap::new());
        let offset_of = |dispatch: &Dispatch| {
            let frame = [dispatch.base, dispatch.size[0], dispatch.size[1], dispatch.step];
            *known.entry(frame).or_insert_with(|| {
                let start = words.len();
                words.extend(frame);
                words.resize(start + FRAME as usize / 4, 0);
                4 * start as u32
            })
        };
        let offsets = self.dispatches.iter().map(offset_of).collect();
        (words, offsets)
    }

    fn submit(
        &self,
        gpu: &Gpu,
        together: usize,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Option<Vec<Vec<f32>>>, Failure> {
        let (device, queue) = (gpu.device(), gpu.queue());
        let buffer = |words: usize, usage| {
            let size = 4 * words.max(4) as u64;
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        use wgpu::BufferUsages as Usage;
        let begun = Instant::now();
        let data = buffer(self.data.len(), Usage::STORAGE | Usage::COPY_DST);
        let samples = buffer(self.samples, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC);
        let (words, offsets) = self.frames();
        let frames = buffer(words.len(), Usage::UNIFORM | Usage::COPY_DST);
        queue.write_buffer(&data, 0, bytemuck::cast_slice(&self.data));
        for (start, grid) in &self.uploads {
            queue.write_buffer(&samples, 4 * *start as u64, bytemuck::cast_slice(grid));
        }
        queue.write_buffer(&frames, 0, bytemuck::cast_slice(&words));
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: gpu.pipelines().bindings(),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: data.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: samples.as_entire_binding() },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &frames,
                        offset: 0,
                        size: std::num::NonZero::new(16),
                    }),
                },
            ],
        });
        // The passes of a solver share few texts, and comparing texts takes longer than a dispatch.
        let mut pipelines = HashMap::new();
        for (dispatches, offsets) in self.dispatches.chunks(together).zip(offsets.chunks(together)) {
            if is_cancelled() {
                return Ok(None);
            }
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
            if self.dispatches.len() > together {
                gpu.wait()?;
            }
        }
        gpu.wait()?;
        gpu.count_seconds(begun.elapsed().as_secs_f64());
        let mut back = Vec::with_capacity(self.downloads.len());
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (start, count) in &self.downloads {
            let to = buffer(*count, Usage::COPY_DST | Usage::MAP_READ);
            encoder.copy_buffer_to_buffer(&samples, 4 * *start as u64, &to, 0, 4 * *count as u64);
            back.push(to);
        }
        queue.submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        for buffer in &back {
            let sender = sender.clone();
            // If the receiver is gone, nothing waits for the result.
            buffer.slice(..).map_async(wgpu::MapMode::Read, move |mapped| drop(sender.send(mapped)));
        }
        gpu.wait()?;
        for _ in &back {
            // They are mapped by now, but the callback may still be running on another thread that polls the device.
            match receiver.recv_timeout(MAPPED) {
                Ok(Ok(())) => {}
                _ => return Err(Failure::Lost("its results could not be read".to_string())),
            }
        }
        let read = |(buffer, (_, count)): (&wgpu::Buffer, &(usize, usize))| {
            let bytes = buffer.slice(..).get_mapped_range();
            let bytes = bytes.map_err(|error| Failure::Lost(error.to_string()))?;
            Ok(bytemuck::cast_slice::<u8, f32>(&bytes)[..*count].to_vec())
        };
        back.iter().zip(&self.downloads).map(read).collect::<Result<_, Failure>>().map(Some)
    }
}
