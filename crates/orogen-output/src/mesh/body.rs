//! Surfaces in space that are not made from a grid of heights.

use super::bounds::bounds;

/// A part of a surface, with a color for each vertex.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyMesh {
    /// The name.
    pub name: String,
    /// The origin of positions: metres east and south of the world's origin.
    pub origin: [f64; 2],
    /// The vertices in metres: east, height, south.
    pub corners: Vec<[f32; 3]>,
    /// The unit normal of each vertex.
    pub normals: Vec<[f32; 3]>,
    /// The color of each vertex, sRGB.
    pub colors: Vec<[u8; 3]>,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl BodyMesh {
    /// Memory of the mesh, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        27 * self.corners.len() as u64 + 12 * self.triangles.len() as u64
    }

    /// The minimum and the maximum of each coordinate.
    #[must_use]
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        bounds(&self.corners)
    }
}
