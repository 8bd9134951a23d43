//! What the 3D view draws: the land, its light and the camera, on an adapter of some ability.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use eframe::egui_wgpu::{RenderState, wgpu};
use orogen::Window;
use orogen::output::render::shader::LightShader;

use crate::preview::frame::{Frame, Key};
use crate::preview::ring::Ring;

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

/// The format of the picture.
pub const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// The format of the positions of pixels.
pub const POSITIONS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Maximum number of vertices along the longer side of a mesh: on a graphics card; if a CPU draws; and if a CPU draws
/// while something moves.
const VERTICES: [usize; 3] = [1024, 257, 129];

/// Number of cells along the sides of a ring: on a graphics card, and if a CPU draws.
const RING_CELLS: [usize; 2] = [512, 256];

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

    /// The number of samples per pixel.
    #[must_use]
    pub fn samples(self) -> u32 {
        if self.is_software { 1 } else { 4 }
    }

    /// The format of depths. If a CPU draws, with the kind and part of each pixel.
    #[must_use]
    pub fn depth(self) -> wgpu::TextureFormat {
        if self.is_software { wgpu::TextureFormat::Depth24PlusStencil8 } else { wgpu::TextureFormat::Depth32Float }
    }

    /// The number of cells along the sides of a ring.
    #[must_use]
    pub fn ring_cells(self) -> usize {
        RING_CELLS[usize::from(self.is_software)]
    }

    /// The numbers of vertices of the mesh of a window.
    pub(super) fn lattice(self, window: &Window, share: f32) -> [usize; 2] {
        let most = VERTICES[if self.is_software { 1 + usize::from(share < 1.0) } else { 0 }];
        let longest = window.width.max(window.height).max(2);
        [window.width, window.height].map(|side| (side * most.min(longest)).div_ceil(longest).max(2))
    }
}

/// A picture to draw.
#[derive(Clone)]
pub struct Drawing {
    /// The land.
    pub frame: Arc<Frame>,
    /// Parts of the land with finer samples, from coarse to fine.
    pub rings: Vec<Arc<Ring>>,
    /// The camera and the land.
    pub scene: Scene,
    /// The light.
    pub light: Arc<LightShader>,
    /// Whether the lattice of the mesh is drawn.
    pub has_wire: bool,
    /// The size of the picture in pixels.
    pub size: [u32; 2],
    /// The share of the pixels along a side that are drawn.
    pub share: f32,
    /// The abilities of the adapter.
    pub ability: Ability,
}

/// The identity of a picture, at any resolution.
#[derive(Clone)]
pub struct PictureId {
    frame: Key,
    /// The windows of the rings.
    pub(super) rings: Vec<Window>,
    scene: Scene,
    light: Arc<LightShader>,
    has_wire: bool,
    size: [u32; 2],
}

impl PictureId {
    /// Whether the land is the same.
    #[must_use]
    pub fn has_frame(&self, frame: &Frame) -> bool {
        self.frame == frame.key()
    }

    /// Whether the camera is the same.
    #[must_use]
    pub fn has_camera(&self, scene: &Scene) -> bool {
        self.scene.matrix == scene.matrix
    }

    /// Whether the picture is the same except for rings of detail.
    #[must_use]
    pub fn is_same_land(&self, other: &PictureId) -> bool {
        self.frame == other.frame
            && self.scene == other.scene
            && Arc::ptr_eq(&self.light, &other.light)
            && self.has_wire == other.has_wire
            && self.size == other.size
    }
}

impl Drawing {
    /// The identity of the picture.
    #[must_use]
    pub fn id(&self) -> PictureId {
        PictureId {
            frame: self.frame.key(),
            rings: self.rings.iter().map(|ring| *ring.window()).collect(),
            scene: self.scene,
            light: Arc::clone(&self.light),
            has_wire: self.has_wire,
            size: self.size,
        }
    }

    /// The width and height of the drawn part in pixels.
    pub(super) fn drawn(&self) -> [f32; 2] {
        self.size.map(|side| (side as f32 * self.share).round().max(1.0))
    }

    /// The windows of the picture and its rings, from coarse to fine.
    pub(super) fn windows(&self) -> Vec<Window> {
        std::iter::once(*self.frame.window()).chain(self.rings.iter().map(|ring| *ring.window())).collect()
    }
}
