//! The shaders of the 3D view, and what they read.

use eframe::egui_wgpu::wgpu;
use orogen::gpu::render::LightShader;

use super::mesh::Vertex;
use super::relief::{Ability, COLOR, DEPTH};

/// The shaders of the 3D view, and the layouts of what they read.
pub struct Pipelines {
    /// Draws the ground.
    pub ground: wgpu::RenderPipeline,
    /// Draws the water.
    pub water: wgpu::RenderPipeline,
    /// Draws the lattice.
    pub wire: wgpu::RenderPipeline,
    /// Draws the background where there is no land.
    pub behind: wgpu::RenderPipeline,
    /// Draws the picture into the window.
    pub blit: wgpu::RenderPipeline,
    /// A part of the land.
    pub land: wgpu::BindGroupLayout,
    /// The light.
    pub light: wgpu::BindGroupLayout,
    /// The picture.
    pub picture: wgpu::BindGroupLayout,
}

/// The layout entry of a texture.
fn texture(binding: u32, filterable: bool) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

/// The layout entry of a sampler.
fn sampler(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        count: None,
    }
}

/// The layout entry of a uniform buffer.
fn uniform(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

impl Pipelines {
    /// Compiles the shaders. The code is the same for all light.
    pub fn new(device: &wgpu::Device, ability: Ability, light: &LightShader) -> Pipelines {
        let words = light.words.len().div_ceil(4);
        let text = format!("const WORDS = {words}u;\n{}{}", light.text, include_str!("relief.wgsl"));
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("relief"),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let layout = |label: &str, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let land_layout = layout(
            "land",
            &[
                uniform(0),
                texture(1, false),
                texture(2, true),
                texture(3, true),
                sampler(4),
                uniform(5),
                texture(6, false),
                texture(7, true),
                texture(8, true),
            ],
        );
        let light_layout = layout("light", &[uniform(0), texture(1, false)]);
        let picture_layout = layout("picture", &[texture(0, true), sampler(1), uniform(2)]);
        let pipelines = |label: &str, layouts: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: layouts,
                immediate_size: 0,
            })
        };
        let land_pipelines = pipelines("land", &[Some(&land_layout), Some(&light_layout)]);
        let blit_pipelines = pipelines("picture", &[Some(&picture_layout)]);
        let attributes = wgpu::vertex_attr_array![0 => Float32x4];
        let vertices = [Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        })];
        let land = |vertex: &str, fragment: &str, topology: wgpu::PrimitiveTopology| {
            // Lines are drawn over existing pixels. The background is at an infinite distance, and hides nothing.
            let blend = (fragment == "wire").then_some(wgpu::BlendState::ALPHA_BLENDING);
            let hides = vertex == "corner" && blend.is_none();
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(fragment),
                layout: Some(&land_pipelines),
                vertex: wgpu::VertexState {
                    module: &shader,
                    entry_point: Some(vertex),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: if vertex == "corner" { &vertices } else { &[] },
                },
                primitive: wgpu::PrimitiveState { topology, ..wgpu::PrimitiveState::default() },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH,
                    depth_write_enabled: Some(hides),
                    depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState { count: ability.samples(), ..wgpu::MultisampleState::default() },
                fragment: Some(wgpu::FragmentState {
                    module: &shader,
                    entry_point: Some(fragment),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: COLOR,
                        blend,
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let blit = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("blit"),
            layout: Some(&blit_pipelines),
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("covering"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("blit"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(ability.target.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let triangles = wgpu::PrimitiveTopology::TriangleList;
        Pipelines {
            ground: land("corner", "ground", triangles),
            water: land("corner", "water", triangles),
            wire: land("corner", "wire", wgpu::PrimitiveTopology::LineList),
            behind: land("covering", "behind", triangles),
            blit,
            land: land_layout,
            light: light_layout,
            picture: picture_layout,
        }
    }
}
