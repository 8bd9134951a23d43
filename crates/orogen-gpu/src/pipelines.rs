//! Compiled shaders, kept by their text. The text depends only on the structure of the work. Parameters are data, so a
//! changed parameter compiles nothing.

use crate::failure::Failure;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};

/// The start of every shader: its data, the samples that it reads and writes, and the part of the data that a dispatch
/// uses.
pub const HEADER: &str = include_str!("header.wgsl");

/// Compiled shaders.
pub(crate) struct Pipelines {
    bindings: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    kept: Mutex<HashMap<String, Arc<wgpu::ComputePipeline>>>,
    compiled: AtomicU64,
}

/// Distance between the frames of dispatches, in bytes: the uniform alignment that all devices support.
pub(crate) const FRAME: u64 = 256;

/// Number of words of a frame.
pub(crate) const FRAME_WORDS: usize = 10;

/// Size of a frame, in bytes.
pub(crate) const FRAME_SIZE: std::num::NonZero<u64> =
    std::num::NonZero::<u64>::MIN.saturating_add(4 * FRAME_WORDS as u64 - 1);

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device) -> Pipelines {
        let entry = |binding, ty, dynamic, size| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: dynamic, min_binding_size: size },
            count: None,
        };
        let bindings = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[
                entry(0, wgpu::BufferBindingType::Storage { read_only: true }, false, None),
                entry(1, wgpu::BufferBindingType::Storage { read_only: false }, false, None),
                entry(2, wgpu::BufferBindingType::Uniform, true, Some(FRAME_SIZE)),
            ],
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&bindings)],
            immediate_size: 0,
        });
        Pipelines { bindings, layout, kept: Mutex::default(), compiled: AtomicU64::new(0) }
    }

    /// Buffers of data, samples and frames as the bindings of a shader.
    pub(crate) fn bind(&self, device: &wgpu::Device, buffers: [&wgpu::Buffer; 3]) -> wgpu::BindGroup {
        let [data, samples, frames] = buffers;
        let frame = wgpu::BufferBinding { buffer: frames, offset: 0, size: Some(FRAME_SIZE) };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.bindings,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: data.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: samples.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Buffer(frame) },
            ],
        })
    }

    /// Number of shaders compiled so far.
    pub(crate) fn compiled(&self) -> u64 {
        self.compiled.load(Relaxed)
    }

    /// The pipeline of a shader, without the [`HEADER`], whose entry point is `main`.
    pub(crate) fn of(&self, device: &wgpu::Device, text: &str) -> Result<Arc<wgpu::ComputePipeline>, Failure> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = kept.get(text) {
            return Ok(Arc::clone(found));
        }
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl([HEADER, text].concat().into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&self.layout),
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                // No shader uses workgroup memory.
                zero_initialize_workgroup_memory: false,
                ..wgpu::PipelineCompilationOptions::default()
            },
            cache: None,
        });
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(Failure::Driver(error.to_string()));
        }
        self.compiled.fetch_add(1, Relaxed);
        let pipeline = Arc::new(pipeline);
        kept.insert(text.to_string(), Arc::clone(&pipeline));
        Ok(pipeline)
    }
}
