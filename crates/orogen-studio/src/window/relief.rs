//! The 3D view, drawn by the graphics card first into a separate picture with depths, and then into the window.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use eframe::egui::PaintCallbackInfo;
use eframe::egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor, wgpu};
use orogen::gpu::render::LightShader;
use wgpu::util::DeviceExt as _;

use super::mesh::{Mesh, Vertex};
use crate::preview::frame::{Frame, Key};

/// The input of the shaders, like `Scene` in `relief.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Scene {
    /// The matrix from the view's space to clip space.
    pub matrix: [[f32; 4]; 4],
    /// The inverse matrix.
    pub inverse: [[f32; 4]; 4],
    /// Half the width and depth, units of height per metre, the height at 0.
    pub extent: [f32; 4],
    /// Interval of contours, their strength, the base, the strength of shadows.
    pub lines: [f32; 4],
    /// Height of the water, whether there is any, the lowest ground, the relief in metres.
    pub water: [f32; 4],
    /// The position of the camera.
    pub eye: [f32; 4],
}

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Number of vertices along the longer side of the mesh: on a graphics card, and if a CPU draws.
const VERTICES: [usize; 2] = [1024, 256];

/// The abilities of an adapter at an acceptable speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ability {
    /// The format of the window.
    pub target: wgpu::TextureFormat,
    /// Whether a CPU draws instead of a graphics card.
    pub is_software: bool,
    /// Maximum side of a texture.
    pub largest: usize,
}

impl Ability {
    /// The abilities of the window's adapter.
    #[must_use]
    pub fn of(state: &RenderState) -> Ability {
        Ability {
            target: state.target_format,
            is_software: state.adapter.get_info().device_type == wgpu::DeviceType::Cpu,
            largest: state.device.limits().max_texture_dimension_2d as usize,
        }
    }

    fn samples(self) -> u32 {
        if self.is_software { 1 } else { 4 }
    }

    fn vertices(self) -> usize {
        VERTICES[usize::from(self.is_software)]
    }
}

/// A picture to draw.
#[derive(Clone)]
pub struct Drawing {
    /// The land.
    pub frame: Arc<Frame>,
    /// The camera and the land.
    pub scene: Scene,
    /// The light.
    pub light: Arc<LightShader>,
    /// Whether the lattice of the mesh is drawn.
    pub has_wire: bool,
    /// The size of the picture in pixels.
    pub size: [u32; 2],
    /// The abilities of the adapter.
    pub ability: Ability,
}

impl CallbackTrait for Drawing {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if !resources.contains::<Relief>() {
            resources.insert(Relief::new(device, self.ability, &self.light));
        }
        if let Some(relief) = resources.get_mut::<Relief>() {
            relief.load(device, queue, self);
            relief.draw(queue, encoder, self);
        }
        Vec::new()
    }

    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, resources: &CallbackResources) {
        if let Some(relief) = resources.get::<Relief>()
            && let Some(target) = &relief.target
        {
            pass.set_pipeline(&relief.blit);
            pass.set_bind_group(0, &target.bind, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// The land on the graphics card.
struct Land {
    frame: Key,
    bind: wgpu::BindGroup,
}

/// The light on the graphics card.
struct Light {
    shader: Arc<LightShader>,
    bind: wgpu::BindGroup,
}

/// A mesh on the graphics card.
struct Buffers {
    lattice: [usize; 2],
    vertices: wgpu::Buffer,
    ground: (wgpu::Buffer, u32),
    water: (wgpu::Buffer, u32),
    lines: (wgpu::Buffer, u32),
}

/// The picture into which the land is drawn.
struct Target {
    size: [u32; 2],
    color: wgpu::TextureView,
    /// The same picture with several samples per pixel, if they are used.
    many: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
    bind: wgpu::BindGroup,
}

/// All resources on the graphics card.
struct Relief {
    ability: Ability,
    ground: wgpu::RenderPipeline,
    water: wgpu::RenderPipeline,
    wire: wgpu::RenderPipeline,
    behind: wgpu::RenderPipeline,
    blit: wgpu::RenderPipeline,
    scene: wgpu::Buffer,
    sampler: wgpu::Sampler,
    land_layout: wgpu::BindGroupLayout,
    light_layout: wgpu::BindGroupLayout,
    blit_layout: wgpu::BindGroupLayout,
    land: Option<Land>,
    light: Option<Light>,
    buffers: Option<Buffers>,
    target: Option<Target>,
}

/// A texture with a label, a size and a format.
fn filled(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    (label, [width, height], format): (&str, [u32; 2], wgpu::TextureFormat),
    bytes: &[u8],
) -> wgpu::TextureView {
    let descriptor = wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let texture = device.create_texture_with_data(queue, &descriptor, wgpu::util::TextureDataOrder::LayerMajor, bytes);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
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

impl Relief {
    fn new(device: &wgpu::Device, ability: Ability, light: &LightShader) -> Relief {
        // The shader code is the same for all light.
        let words = light.words.len().div_ceil(4);
        let text = format!("const WORDS = {words}u;\n{}{}", light.text, include_str!("relief.wgsl"));
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("relief"),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let uniform = |binding: u32| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let land_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("land"),
            entries: &[uniform(0), texture(1, false), texture(2, true), texture(3, true), sampler(4)],
        });
        let light_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("light"),
            entries: &[uniform(0), texture(1, false)],
        });
        let blit_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("picture"),
            entries: &[texture(0, true), sampler(1)],
        });
        let land_pipelines = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("land"),
            bind_group_layouts: &[Some(&land_layout), Some(&light_layout)],
            immediate_size: 0,
        });
        let blit_pipelines = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("picture"),
            bind_group_layouts: &[Some(&blit_layout)],
            immediate_size: 0,
        });
        let attributes = wgpu::vertex_attr_array![0 => Float32x4];
        let vertices = [Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        })];
        let land = |vertex: &str, fragment: &str, topology: wgpu::PrimitiveTopology| {
            // Lines are drawn over existing pixels. The background behind the land is drawn first, and hides nothing.
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
        Relief {
            ability,
            ground: land("corner", "ground", triangles),
            water: land("corner", "water", triangles),
            wire: land("corner", "wire", wgpu::PrimitiveTopology::LineList),
            behind: land("covering", "behind", triangles),
            blit,
            scene: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("scene"),
                size: size_of::<Scene>() as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..wgpu::SamplerDescriptor::default()
            }),
            land_layout,
            light_layout,
            blit_layout,
            land: None,
            light: None,
            buffers: None,
            target: None,
        }
    }

    /// Uploads changed data to the graphics card.
    fn load(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, drawing: &Drawing) {
        let frame = &drawing.frame;
        let window = frame.window();
        let key = frame.key();
        if self.land.as_ref().is_none_or(|land| land.frame != key) {
            self.land = Some(Land { frame: key, bind: self.textures(device, queue, frame) });
        }
        if self.light.as_ref().is_none_or(|light| !Arc::ptr_eq(&light.shader, &drawing.light)) {
            let bind = self.light_bind(device, queue, &drawing.light);
            self.light = Some(Light { shader: Arc::clone(&drawing.light), bind });
        }
        let longest = window.width.max(window.height).max(2);
        let lattice = [window.width, window.height]
            .map(|side| (side * self.ability.vertices().min(longest)).div_ceil(longest).max(2));
        if self.buffers.as_ref().is_none_or(|buffers| buffers.lattice != lattice) {
            self.buffers = Some(Buffers::new(device, lattice));
        }
        if self.target.as_ref().is_none_or(|target| target.size != drawing.size) {
            self.target = Some(self.target(device, drawing.size));
        }
    }

    fn textures(&self, device: &wgpu::Device, queue: &wgpu::Queue, frame: &Frame) -> wgpu::BindGroup {
        // Samples without a height are at the base.
        let low =
            frame.heights.data().iter().copied().filter(|height| height.is_finite()).fold(f32::INFINITY, f32::min);
        let low = if low.is_finite() { low } else { 0.0 };
        let heights: Vec<f32> =
            frame.heights.data().iter().map(|height| if height.is_finite() { *height } else { low }).collect();
        let size = [frame.window().width, frame.window().height].map(|side| side as u32);
        let view = |label: &str, format: wgpu::TextureFormat, bytes: &[u8]| {
            filled(device, queue, (label, size, format), bytes)
        };
        let views = [
            view("heights", wgpu::TextureFormat::R32Float, bytemuck::cast_slice(&heights)),
            view("albedo", wgpu::TextureFormat::Rgba8UnormSrgb, &frame.albedo),
            view("light", wgpu::TextureFormat::Rg8Unorm, &frame.light),
        ];
        let entry = |binding: u32, resource| wgpu::BindGroupEntry { binding, resource };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("land"),
            layout: &self.land_layout,
            entries: &[
                entry(0, self.scene.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(&views[0])),
                entry(2, wgpu::BindingResource::TextureView(&views[1])),
                entry(3, wgpu::BindingResource::TextureView(&views[2])),
                entry(4, wgpu::BindingResource::Sampler(&self.sampler)),
            ],
        })
    }

    fn light_bind(&self, device: &wgpu::Device, queue: &wgpu::Queue, light: &LightShader) -> wgpu::BindGroup {
        let mut words = light.words.clone();
        words.resize(words.len().next_multiple_of(4), 0);
        let words = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("light"),
            contents: bytemuck::cast_slice(&words),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        // Rows have a width that every device supports; each texel is three numbers.
        const COLUMNS: usize = 64;
        let mut texels: Vec<f32> =
            light.tables.chunks(3).flat_map(|three| three.iter().copied().chain([1.0])).collect();
        texels.resize(texels.len().next_multiple_of(4 * COLUMNS), 0.0);
        let size = [COLUMNS, texels.len() / (4 * COLUMNS)].map(|side| side as u32);
        let format = wgpu::TextureFormat::Rgba32Float;
        let tables = filled(device, queue, ("sky", size, format), bytemuck::cast_slice(&texels));
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("light"),
            layout: &self.light_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: words.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&tables) },
            ],
        })
    }

    fn target(&self, device: &wgpu::Device, size: [u32; 2]) -> Target {
        let view = |format: wgpu::TextureFormat, sample_count: u32, usage: wgpu::TextureUsages| {
            let descriptor = wgpu::TextureDescriptor {
                label: Some("picture"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            };
            device.create_texture(&descriptor).create_view(&wgpu::TextureViewDescriptor::default())
        };
        let samples = self.ability.samples();
        let color = view(COLOR, 1, wgpu::TextureUsages::TEXTURE_BINDING);
        let bind = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.blit_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&color) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        });
        Target {
            size,
            many: (samples > 1).then(|| view(COLOR, samples, wgpu::TextureUsages::empty())),
            depth: view(DEPTH, samples, wgpu::TextureUsages::empty()),
            color,
            bind,
        }
    }

    /// Draws the land into the picture.
    fn draw(&self, queue: &wgpu::Queue, encoder: &mut wgpu::CommandEncoder, drawing: &Drawing) {
        let (Some(land), Some(light)) = (&self.land, &self.light) else { return };
        let (Some(buffers), Some(target)) = (&self.buffers, &self.target) else { return };
        queue.write_buffer(&self.scene, 0, bytemuck::bytes_of(&drawing.scene));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("relief"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target.many.as_ref().unwrap_or(&target.color),
                depth_slice: None,
                resolve_target: target.many.as_ref().map(|_| &target.color),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &target.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_bind_group(0, &land.bind, &[]);
        pass.set_bind_group(1, &light.bind, &[]);
        pass.set_pipeline(&self.behind);
        pass.draw(0..3, 0..1);
        pass.set_vertex_buffer(0, buffers.vertices.slice(..));
        let mut part = |pipeline: &wgpu::RenderPipeline, (indices, count): &(wgpu::Buffer, u32)| {
            pass.set_pipeline(pipeline);
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..*count, 0, 0..1);
        };
        part(&self.ground, &buffers.ground);
        if drawing.has_wire {
            part(&self.wire, &buffers.lines);
        }
        if drawing.scene.water[1] > 0.0 {
            part(&self.water, &buffers.water);
        }
    }
}

impl Buffers {
    fn new(device: &wgpu::Device, lattice: [usize; 2]) -> Buffers {
        let mesh = Mesh::new(lattice[0], lattice[1]);
        let buffer = |label: &str, contents: &[u8], usage: wgpu::BufferUsages| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let indices = |label: &str, indices: &[u32]| {
            (buffer(label, bytemuck::cast_slice(indices), wgpu::BufferUsages::INDEX), indices.len() as u32)
        };
        Buffers {
            lattice,
            vertices: buffer("vertices", bytemuck::cast_slice(&mesh.vertices), wgpu::BufferUsages::VERTEX),
            ground: indices("ground", &mesh.ground),
            water: indices("water", &mesh.water),
            lines: indices("lines", &mesh.lines),
        }
    }
}
