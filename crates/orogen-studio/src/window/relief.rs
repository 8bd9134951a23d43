//! The 3D view, drawn by the graphics card first into a separate picture with depths, and then into the window. The
//! picture is drawn again only if something in it has changed.

use std::sync::Arc;

use eframe::egui::PaintCallbackInfo;
use eframe::egui_wgpu::{CallbackResources, CallbackTrait, ScreenDescriptor, wgpu};
use glam::Mat4;
use orogen::output::render::shader::LightShader;
use orogen::{Grid, Window};
use wgpu::util::DeviceExt as _;

use super::mesh::{Mesh, Tile};
use super::relief_drawing::{Ability, COLOR, Drawing, POSITIONS, PictureId, Scene};
use super::relief_part::{Placement, places, visible};
use super::relief_pipelines::{Pipelines, Way};
use crate::preview::frame::Key;

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
            let id = self.id();
            let is_drawn = |(last, share): &(PictureId, f32)| {
                last.is_same_land(&id) && last.rings == id.rings && *share >= self.share
            };
            if !relief.drawn.as_ref().is_some_and(is_drawn) {
                relief.load(device, queue, self);
                relief.draw(queue, encoder, self);
                relief.drawn = Some((id, self.share));
            }
        }
        Vec::new()
    }

    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, resources: &CallbackResources) {
        if let Some(relief) = resources.get::<Relief>()
            && let Some(target) = &relief.target
        {
            let is_all = relief.drawn.as_ref().is_some_and(|(_, share)| *share >= 1.0);
            pass.set_pipeline(if is_all { &relief.pipelines.copy } else { &relief.pipelines.blit });
            pass.set_bind_group(0, &target.bind, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// The heights, colors and light of a part of the land on the graphics card.
struct Samples {
    identity: Identity,
    views: [wgpu::TextureView; 3],
    place: wgpu::Buffer,
}

/// The identity of a part: its picture and its window.
#[derive(PartialEq)]
struct Identity(Key, Window);

/// The light on the graphics card.
struct Light {
    shader: Arc<LightShader>,
    bind: wgpu::BindGroup,
}

/// A mesh on the graphics card.
struct Buffers {
    lattice: [usize; 2],
    tiles: Vec<Tile>,
    vertices: wgpu::Buffer,
    ground: wgpu::Buffer,
    lines: wgpu::Buffer,
    walls: (wgpu::Buffer, u32),
    water: (wgpu::Buffer, u32),
    water_walls: (wgpu::Buffer, u32),
}

/// The picture into which the land is drawn.
struct Target {
    size: [u32; 2],
    color: wgpu::TextureView,
    /// The same picture with several samples per pixel, if they are used.
    many: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
    /// The positions of pixels, if a CPU draws.
    positions: Option<(wgpu::TextureView, wgpu::BindGroup)>,
    /// The drawn part of the picture.
    drawn: wgpu::Buffer,
    bind: wgpu::BindGroup,
}

/// All resources on the graphics card.
struct Relief {
    ability: Ability,
    pipelines: Pipelines,
    scene: wgpu::Buffer,
    sampler: wgpu::Sampler,
    /// The parts of the land, from coarse to fine.
    parts: Vec<Samples>,
    binds: Vec<wgpu::BindGroup>,
    light: Option<Light>,
    meshes: Vec<Buffers>,
    target: Option<Target>,
    /// What the picture shows, and the share of its pixels along a side that are drawn.
    drawn: Option<(PictureId, f32)>,
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

/// An uninitialized uniform buffer.
fn uniform(device: &wgpu::Device, label: &str, size: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

impl Relief {
    fn new(device: &wgpu::Device, ability: Ability, light: &LightShader) -> Relief {
        Relief {
            ability,
            pipelines: Pipelines::new(device, ability, light),
            scene: uniform(device, "scene", size_of::<Scene>()),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..wgpu::SamplerDescriptor::default()
            }),
            parts: Vec::new(),
            binds: Vec::new(),
            light: None,
            meshes: Vec::new(),
            target: None,
            drawn: None,
        }
    }

    /// Uploads changed data to the graphics card.
    fn load(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, drawing: &Drawing) {
        self.load_parts(device, queue, drawing);
        if self.light.as_ref().is_none_or(|light| !Arc::ptr_eq(&light.shader, &drawing.light)) {
            let bind = self.light_bind(device, queue, &drawing.light);
            self.light = Some(Light { shader: Arc::clone(&drawing.light), bind });
        }
        let lattices = drawing.windows().into_iter().flat_map(|window| {
            // Those of pictures at rest are kept for the next one.
            [1.0, drawing.share].map(|share| self.ability.lattice(&window, share))
        });
        let lattices: Vec<[usize; 2]> = lattices.collect();
        self.meshes.retain(|mesh| lattices.contains(&mesh.lattice));
        for lattice in lattices {
            if self.meshes.iter().all(|mesh| mesh.lattice != lattice) {
                self.meshes.push(Buffers::new(device, lattice));
            }
        }
        if self.target.as_ref().is_none_or(|target| target.size != drawing.size) {
            self.target = Some(self.target(device, drawing.size));
        }
    }

    /// Uploads the parts of the land that are new.
    fn load_parts(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, drawing: &Drawing) {
        let frame = &drawing.frame;
        let land: (&Grid, &[u8], &[u8]) = (&frame.heights, &frame.albedo, &frame.light);
        let rings = drawing.rings.iter().map(|ring| (&*ring.heights, &ring.albedo[..], &ring.light[..]));
        let mut old = std::mem::take(&mut self.parts);
        let before = old.len();
        let (mut kept, mut is_same) = (0, true);
        for (heights, albedo, light) in std::iter::once(land).chain(rings) {
            let identity = Identity(frame.key(), *heights.window());
            let known = old.iter().position(|part| part.identity == identity);
            is_same &= known == Some(0);
            kept += usize::from(known.is_some());
            self.parts.push(match known {
                Some(known) => old.remove(known),
                None => Samples {
                    views: textures(device, queue, (heights, albedo, light), frame.levels[0]),
                    place: uniform(device, "place", size_of::<Placement>()),
                    identity,
                },
            });
        }
        if is_same && kept == before && before == self.parts.len() {
            return;
        }
        let entry = |binding: u32, resource| wgpu::BindGroupEntry { binding, resource };
        let view = |binding: u32, view| entry(binding, wgpu::BindingResource::TextureView(view));
        let bind = |k: usize| {
            let (own, coarser) = (&self.parts[k], &self.parts[k.saturating_sub(1)]);
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("land"),
                layout: &self.pipelines.land,
                entries: &[
                    entry(0, self.scene.as_entire_binding()),
                    view(1, &own.views[0]),
                    view(2, &own.views[1]),
                    view(3, &own.views[2]),
                    entry(4, wgpu::BindingResource::Sampler(&self.sampler)),
                    entry(5, own.place.as_entire_binding()),
                    view(6, &coarser.views[0]),
                    view(7, &coarser.views[1]),
                    view(8, &coarser.views[2]),
                ],
            })
        };
        self.binds = (0..self.parts.len()).map(bind).collect();
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
            layout: &self.pipelines.light,
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
        let drawn = uniform(device, "drawn", size_of::<[f32; 4]>());
        let bind = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.pipelines.picture,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&color) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&self.sampler) },
                wgpu::BindGroupEntry { binding: 2, resource: drawn.as_entire_binding() },
            ],
        });
        let positions = self.ability.is_software.then(|| {
            let positions = view(POSITIONS, 1, wgpu::TextureUsages::TEXTURE_BINDING);
            let bind = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("positions"),
                layout: &self.pipelines.positions,
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&positions),
                }],
            });
            (positions, bind)
        });
        Target {
            size,
            positions,
            many: (samples > 1).then(|| view(COLOR, samples, wgpu::TextureUsages::empty())),
            depth: view(self.ability.depth(), samples, wgpu::TextureUsages::empty()),
            color,
            drawn,
            bind,
        }
    }

    /// Draws the land into the picture.
    fn draw(&self, queue: &wgpu::Queue, encoder: &mut wgpu::CommandEncoder, drawing: &Drawing) {
        let (Some(light), Some(target)) = (&self.light, &self.target) else { return };
        let scene = &drawing.scene;
        let windows = drawing.windows();
        let lattices: Vec<[usize; 2]> =
            windows.iter().map(|window| self.ability.lattice(window, drawing.share)).collect();
        let places = places(&windows, [scene.extent[0], scene.extent[1]], &lattices);
        queue.write_buffer(&self.scene, 0, bytemuck::bytes_of(scene));
        for (part, place) in self.parts.iter().zip(&places) {
            queue.write_buffer(&part.place, 0, bytemuck::bytes_of(place));
        }
        let [width, height] = drawing.drawn();
        let of_side = [width / target.size[0] as f32, height / target.size[1] as f32];
        // Half a pixel inside, so that no color from outside of the part is mixed in.
        let last = [(width - 0.5) / target.size[0] as f32, (height - 0.5) / target.size[1] as f32];
        queue.write_buffer(&target.drawn, 0, bytemuck::bytes_of(&[of_side, last]));
        let mesh = |lattice: &[usize; 2]| self.meshes.iter().find(|mesh| mesh.lattice == *lattice);
        let meshes = lattices.iter().map(mesh);
        let parts: Vec<Part<'_>> = self
            .binds
            .iter()
            .zip(&places)
            .zip(meshes)
            .filter_map(|((bind, place), mesh)| Some(Part { bind, place, mesh: mesh? }))
            .collect();
        let Some(land) = parts.first() else { return };
        let has_water = scene.water[1] > 0.0;
        let view = View::of(drawing);
        let positions = target.positions.as_ref();
        if let (Way::Deferred { ground, water, .. }, Some((positions, _))) = (&self.pipelines.land_way, positions) {
            let mut pass = begin(encoder, ("positions", positions, None), &target.depth, true, true);
            pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
            pass.set_bind_group(1, &light.bind, &[]);
            for (nth, part) in parts.iter().enumerate() {
                let is_ring = usize::from(nth > 0);
                part.ground(&mut pass, &ground[is_ring], &view, code(nth, 0));
                if nth == 0 {
                    part.all(&mut pass, &ground[is_ring], &part.mesh.walls, code(nth, 1));
                }
                if has_water {
                    part.all(&mut pass, &water[is_ring], &part.mesh.water, code(nth, 2));
                }
                if has_water && nth == 0 {
                    part.all(&mut pass, &water[is_ring], &part.mesh.water_walls, code(nth, 3));
                }
            }
        }
        let color =
            ("relief", target.many.as_ref().unwrap_or(&target.color), target.many.as_ref().map(|_| &target.color));
        let is_first = positions.is_none();
        let mut pass = begin(encoder, color, &target.depth, is_first, self.ability.is_software);
        pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
        pass.set_bind_group(1, &light.bind, &[]);
        match &self.pipelines.land_way {
            Way::Forward { ground, .. } => {
                for part in &parts {
                    part.ground(&mut pass, ground, &view, 0);
                }
                land.all(&mut pass, ground, &land.mesh.walls, 0);
            }
            Way::Deferred { shade_ground, shade_water, shade_walls, .. } => {
                if let Some((_, bind)) = positions {
                    pass.set_bind_group(2, bind, &[]);
                }
                for (nth, part) in parts.iter().enumerate() {
                    let is_ring = usize::from(nth > 0);
                    part.shade(&mut pass, &shade_ground[is_ring], code(nth, 0));
                    if has_water {
                        part.shade(&mut pass, &shade_water[is_ring], code(nth, 2));
                    }
                }
                land.shade(&mut pass, &shade_walls[0], code(0, 1));
                if has_water {
                    land.shade(&mut pass, &shade_walls[1], code(0, 3));
                }
            }
        }
        // The background is drawn only where there is no land.
        land.shade(&mut pass, &self.pipelines.behind, 0);
        if drawing.has_wire {
            for part in &parts {
                part.lines(&mut pass, &self.pipelines.wire, &view);
            }
        }
        if let Way::Forward { water, .. } = &self.pipelines.land_way
            && has_water
        {
            for part in &parts {
                part.all(&mut pass, water, &part.mesh.water, 0);
            }
            land.all(&mut pass, water, &land.mesh.water_walls, 0);
        }
    }
}

/// The stencil of a kind of surface of a part: 0 for the ground, 1 for its walls, 2 for the water, 3 for its walls.
/// Pixels without land have 0.
fn code(nth: usize, kind: u32) -> u32 {
    1 + 4 * nth as u32 + kind
}

/// Begins a pass that draws into a picture. The first one clears the depths.
fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    (label, view, resolve_target): (&str, &wgpu::TextureView, Option<&wgpu::TextureView>),
    depth: &wgpu::TextureView,
    is_first: bool,
    has_stencil: bool,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations {
                load: if is_first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load },
                store: if has_stencil { wgpu::StoreOp::Store } else { wgpu::StoreOp::Discard },
            }),
            stencil_ops: has_stencil.then_some(wgpu::Operations {
                load: if is_first { wgpu::LoadOp::Clear(0) } else { wgpu::LoadOp::Load },
                store: wgpu::StoreOp::Store,
            }),
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

/// What decides which tiles are visible.
struct View {
    matrix: Mat4,
    /// The lowest and highest ground.
    levels: [f32; 2],
}

impl View {
    fn of(drawing: &Drawing) -> View {
        let scene = &drawing.scene;
        let level = |metres: f32| (metres - scene.extent[3]) * scene.extent[2];
        // A ring may be a little higher and lower than the land between its samples.
        let [low, high] = drawing.frame.levels;
        let spare = 0.1 * (high - low);
        View { matrix: Mat4::from_cols_array_2d(&scene.matrix), levels: [level(low - spare), level(high + spare)] }
    }
}

/// A part of the land, ready to be drawn.
struct Part<'a> {
    bind: &'a wgpu::BindGroup,
    place: &'a Placement,
    mesh: &'a Buffers,
}

impl Part<'_> {
    fn begin(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline, code: u32) {
        pass.set_pipeline(pipeline);
        pass.set_stencil_reference(code);
        pass.set_bind_group(0, self.bind, &[]);
        pass.set_vertex_buffer(0, self.mesh.vertices.slice(..));
    }

    /// Draws the visible tiles of the ground.
    fn ground(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline, view: &View, code: u32) {
        self.begin(pass, pipeline, code);
        pass.set_index_buffer(self.mesh.ground.slice(..), wgpu::IndexFormat::Uint32);
        for range in visible(&self.mesh.tiles, self.place, view.levels, &view.matrix, |tile| tile.ground.clone()) {
            pass.draw_indexed(range, 0, 0..1);
        }
    }

    /// Draws the lines of the visible tiles.
    fn lines(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline, view: &View) {
        self.begin(pass, pipeline, 0);
        pass.set_index_buffer(self.mesh.lines.slice(..), wgpu::IndexFormat::Uint32);
        for range in visible(&self.mesh.tiles, self.place, view.levels, &view.matrix, |tile| tile.lines.clone()) {
            pass.draw_indexed(range, 0, 0..1);
        }
    }

    /// Draws all triangles of a kind.
    fn all(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pipeline: &wgpu::RenderPipeline,
        (indices, count): &(wgpu::Buffer, u32),
        code: u32,
    ) {
        self.begin(pass, pipeline, code);
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..*count, 0, 0..1);
    }

    /// Draws all pixels, or those with this code.
    fn shade(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline, code: u32) {
        self.begin(pass, pipeline, code);
        pass.draw(0..3, 0..1);
    }
}

/// Uploads heights, colors and light. Samples without a height are at the `lowest` one.
fn textures(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    (heights, albedo, light): (&Grid, &[u8], &[u8]),
    lowest: f32,
) -> [wgpu::TextureView; 3] {
    let finite: Vec<f32> =
        heights.data().iter().map(|height| if height.is_finite() { *height } else { lowest }).collect();
    let size = [heights.width(), heights.window().height].map(|side| side as u32);
    let view =
        |label: &str, format: wgpu::TextureFormat, bytes: &[u8]| filled(device, queue, (label, size, format), bytes);
    [
        view("heights", wgpu::TextureFormat::R32Float, bytemuck::cast_slice(&finite)),
        view("albedo", wgpu::TextureFormat::Rgba8UnormSrgb, albedo),
        view("light", wgpu::TextureFormat::Rg8Unorm, light),
    ]
}

impl Buffers {
    fn new(device: &wgpu::Device, lattice: [usize; 2]) -> Buffers {
        let mesh = Mesh::new(lattice[0], lattice[1]);
        let buffer = |label: &str, contents: &[u8], usage: wgpu::BufferUsages| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let indices =
            |label: &str, indices: &[u32]| buffer(label, bytemuck::cast_slice(indices), wgpu::BufferUsages::INDEX);
        let counted = |label: &str, of: &[u32]| (indices(label, of), of.len() as u32);
        Buffers {
            lattice,
            vertices: buffer("vertices", bytemuck::cast_slice(&mesh.vertices), wgpu::BufferUsages::VERTEX),
            ground: indices("ground", &mesh.ground),
            lines: indices("lines", &mesh.lines),
            walls: counted("walls", &mesh.walls),
            water: counted("water", &mesh.water),
            water_walls: counted("water walls", &mesh.water_walls),
            tiles: mesh.tiles,
        }
    }
}
