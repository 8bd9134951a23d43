//! Grids in the memory of the card.

use crate::failure::Failure;
use crate::gpu::{Gpu, Moved};
use orogen_engine::device::{DeviceGrid, PlanGrid};
use orogen_grid::grid::{Grid, Window};
use std::sync::mpsc;
use std::time::Duration;

/// The samples of a grid in a buffer of the card, row after row.
#[derive(Clone)]
pub struct Resident {
    pub gpu: Gpu,
    pub buffer: wgpu::Buffer,
    pub window: Window,
}

/// Maximum time to wait for readable buffers after all work is done.
const MAPPED: Duration = Duration::from_secs(10);

impl Resident {
    /// Allocates a grid.
    ///
    /// # Errors
    /// If the device was lost or has too little memory.
    pub fn new(gpu: &Gpu, window: &Window) -> Result<Resident, Failure> {
        use wgpu::BufferUsages as Usage;
        let usage = Usage::STORAGE | Usage::COPY_SRC;
        let buffer = gpu.scoped(|| Ok(gpu.buffer(window.len(), usage)))?;
        Ok(Resident { gpu: gpu.clone(), buffer, window: *window })
    }
}

impl From<Resident> for PlanGrid {
    fn from(resident: Resident) -> PlanGrid {
        DeviceGrid::new(resident.window, resident).into()
    }
}

/// Copies grids to the processor's memory.
///
/// # Errors
/// If the device was lost or has too little memory, or a grid is not on it.
pub(crate) fn read(gpu: &Gpu, grids: &[&DeviceGrid]) -> Result<Vec<Grid>, Failure> {
    let of = |grid: &&DeviceGrid| grid.samples::<Resident>().cloned().filter(|resident| resident.gpu.is(gpu));
    let residents: Option<Vec<Resident>> = grids.iter().map(of).collect();
    let residents = residents.ok_or_else(|| Failure::Input("a grid is on another card".to_string()))?;
    let parts: Vec<_> = residents.iter().map(|resident| (&resident.buffer, 0, resident.window.len())).collect();
    let back = gpu.scoped(|| download(gpu, &parts))?;
    let grids = back.into_iter().zip(&residents).map(|(samples, resident)| {
        Grid::from_data(resident.window, samples)
            .ok_or_else(|| Failure::Lost("it gave back another number of samples".to_string()))
    });
    grids.collect()
}

/// Waits for all work, and copies parts of buffers to the processor's memory. A part is a buffer, its first sample and
/// the number of samples.
pub(crate) fn download(gpu: &Gpu, parts: &[(&wgpu::Buffer, usize, usize)]) -> Result<Vec<Vec<f32>>, Failure> {
    use wgpu::BufferUsages as Usage;
    let mut back = Vec::with_capacity(parts.len());
    let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    for (buffer, first, count) in parts {
        let to = gpu.buffer(*count, Usage::COPY_DST | Usage::MAP_READ);
        encoder.copy_buffer_to_buffer(buffer, 4 * *first as u64, &to, 0, 4 * *count as u64);
        back.push(to);
    }
    gpu.count_moved(Moved { there: 0, back: parts.iter().map(|(_, _, count)| *count as u64).sum() });
    gpu.wait()?;
    gpu.queue().submit([encoder.finish()]);
    let (sender, receiver) = mpsc::channel();
    for buffer in &back {
        let sender = sender.clone();
        // If the receiver is gone, nothing waits for the result.
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |mapped| drop(sender.send(mapped)));
    }
    gpu.wait()?;
    for _ in &back {
        // The buffer is mapped, but the callback may still be running on another thread that polls the device.
        match receiver.recv_timeout(MAPPED) {
            Ok(Ok(())) => {}
            _ => return Err(Failure::Lost("its results could not be read".to_string())),
        }
    }
    let read = |(buffer, (_, _, count)): (&wgpu::Buffer, &(&wgpu::Buffer, usize, usize))| {
        let bytes = buffer.slice(..).get_mapped_range();
        let bytes = bytes.map_err(|error| Failure::Lost(error.to_string()))?;
        Ok(bytemuck::cast_slice::<u8, f32>(&bytes)[..*count].to_vec())
    };
    back.iter().zip(parts).map(read).collect()
}
