//! The shaders of the 3D view, and what they read.

use eframe::egui_wgpu::wgpu;
use orogen::output::render::shader::LightShader;

use super::mesh::Vertex;
use super::relief_drawing::{Ability, COLOR, POSITIONS};

/// The shaders of the 3D view, and the layouts of what they read.
pub struct Pipelines {
    /// What draws the land.
    pub land_way: Way,
    /// Draws the lattice.
    pub wire: wgpu::RenderPipeline,
    /// Draws the background where there is no land.
    pub behind: wgpu::RenderPipeline,
    /// Draws the picture into the window, at another resolution.
    pub blit: wgpu::RenderPipeline,
    /// Draws the picture into the window, pixel by pixel. A CPU takes more time to interpolate.
    pub copy: wgpu::RenderPipeline,
    /// A part of the land.
    pub land: wgpu::BindGroupLayout,
    /// The light.
    pub light: wgpu::BindGroupLayout,
    /// The picture.
    pub picture: wgpu::BindGroupLayout,
    /// The positions of pixels.
    pub positions: wgpu::BindGroupLayout,
}

/// How the land is drawn.
pub enum Way {
    /// Each triangle is shaded as it is drawn, by a graphics card.
    Forward {
        /// Draws the ground and its walls.
        ground: wgpu::RenderPipeline,
        /// Draws the water and its walls.
        water: wgpu::RenderPipeline,
    },
    /// First positions are drawn, then each pixel is shaded once, by a CPU. Each of two pipelines is for the whole land
    /// and for rings.
    Deferred {
        /// Draws positions of the ground and its walls.
        ground: [wgpu::RenderPipeline; 2],
        /// Draws positions of the water and its walls.
        water: [wgpu::RenderPipeline; 2],
        /// Shades the ground.
        shade_ground: [wgpu::RenderPipeline; 2],
        /// Shades the water.
        shade_water: [wgpu::RenderPipeline; 2],
        /// Shades the walls of the ground and of the water.
        shade_walls: [wgpu::RenderPipeline; 2],
    },
}

/// When a pipeline draws, by the stencil of a pixel.
#[derive(Clone, Copy, PartialEq)]
enum Stencil {
    /// Always.
    Ignored,
    /// Always; the stencil is set to the reference.
    Set,
    /// Where it is the reference.
    Equal,
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
        // Contours have the width of their heights' derivative, which is only used where it is defined; browsers would
        // refuse it.
        let rule = "diagnostic(off, derivative_uniformity);";
        let text = format!("{rule}\nconst WORDS = {words}u;\n{}{}", light.text, include_str!("relief.wgsl"));
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
        let positions_layout = layout("positions", &[texture(0, false)]);
        let picture_layout = layout("picture", &[texture(0, true), sampler(1), uniform(2)]);
        let pipelines = |label: &str, layouts: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: layouts,
                immediate_size: 0,
            })
        };
        let land_pipelines = pipelines("land", &[Some(&land_layout), Some(&light_layout)]);
        let shade_pipelines =
            pipelines("positions", &[Some(&land_layout), Some(&light_layout), Some(&positions_layout)]);
        let blit_pipelines = pipelines("picture", &[Some(&picture_layout)]);
        let attributes = wgpu::vertex_attr_array![0 => Float32x4];
        let vertices = [Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        })];
        let land = |vertex: &str, fragment: &str, is_ring: bool, stencil: Stencil| {
            let is_wire = fragment == "wire";
            let is_mesh = vertex == "corner";
            let topology =
                if is_wire { wgpu::PrimitiveTopology::LineList } else { wgpu::PrimitiveTopology::TriangleList };
            // Lines are drawn over existing pixels. The background is at an infinite distance, and hides nothing.
            let blend = is_wire.then_some(wgpu::BlendState::ALPHA_BLENDING);
            let format = if stencil == Stencil::Set { POSITIONS } else { COLOR };
            let face = wgpu::StencilFaceState {
                compare: match stencil {
                    Stencil::Equal => wgpu::CompareFunction::Equal,
                    _ => wgpu::CompareFunction::Always,
                },
                pass_op: match stencil {
                    Stencil::Set => wgpu::StencilOperation::Replace,
                    _ => wgpu::StencilOperation::Keep,
                },
                fail_op: wgpu::StencilOperation::Keep,
                depth_fail_op: wgpu::StencilOperation::Keep,
            };
            let stencil_state = match stencil {
                Stencil::Ignored => wgpu::StencilState::default(),
                Stencil::Set | Stencil::Equal => {
                    wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff }
                }
            };
            let constants = [("RING", f64::from(u8::from(is_ring)))];
            let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(fragment),
                layout: Some(if stencil == Stencil::Equal { &shade_pipelines } else { &land_pipelines }),
                vertex: wgpu::VertexState {
                    module: &shader,
                    entry_point: Some(vertex),
                    compilation_options: options.clone(),
                    buffers: if is_mesh { &vertices } else { &[] },
                },
                primitive: wgpu::PrimitiveState { topology, ..wgpu::PrimitiveState::default() },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: ability.depth(),
                    depth_write_enabled: Some(is_mesh && !is_wire),
                    depth_compare: Some(match stencil {
                        Stencil::Equal => wgpu::CompareFunction::Always,
                        _ => wgpu::CompareFunction::GreaterEqual,
                    }),
                    stencil: stencil_state,
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState { count: ability.samples(), ..wgpu::MultisampleState::default() },
                fragment: Some(wgpu::FragmentState {
                    module: &shader,
                    entry_point: Some(fragment),
                    compilation_options: options,
                    targets: &[Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let blit = |fragment: &str| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(fragment),
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
                    entry_point: Some(fragment),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(ability.target.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let parts = |vertex: &str, fragment: &str, stencil: Stencil| {
            [false, true].map(|is_ring| land(vertex, fragment, is_ring, stencil))
        };
        let land_way = match ability.is_software {
            true => Way::Deferred {
                ground: parts("corner", "ground_position", Stencil::Set),
                water: parts("corner", "water_position", Stencil::Set),
                shade_ground: parts("covering", "shade_ground", Stencil::Equal),
                shade_water: parts("covering", "shade_water", Stencil::Equal),
                shade_walls: ["shade_wall", "shade_water_wall"]
                    .map(|fragment| land("covering", fragment, false, Stencil::Equal)),
            },
            false => Way::Forward {
                ground: land("corner", "ground", true, Stencil::Ignored),
                water: land("corner", "water", true, Stencil::Ignored),
            },
        };
        Pipelines {
            land_way,
            wire: land("corner", "wire", true, Stencil::Ignored),
            behind: match ability.is_software {
                true => land("covering", "behind", false, Stencil::Equal),
                false => land("covering", "behind", false, Stencil::Ignored),
            },
            blit: blit("blit"),
            copy: blit("copy"),
            land: land_layout,
            light: light_layout,
            picture: picture_layout,
            positions: positions_layout,
        }
    }
}
