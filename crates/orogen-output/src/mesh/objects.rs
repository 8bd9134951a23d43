//! Scattered objects on a mesh: a placeholder for each kind, and its instances.

/// A kind of objects: one mesh that is drawn at many positions.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectMesh {
    /// The name of the kind.
    pub name: String,
    /// Red, green and blue in linear light: 0 to 1.
    pub color: [f32; 3],
    /// Width of the placeholder in metres, at a size of 1. Its height is 1.5 times its width.
    pub width: f32,
    /// The objects.
    pub instances: Vec<Instance>,
}

/// An object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instance {
    /// Metres from the first sample of the ground: east, height, south.
    pub position: [f32; 3],
    /// Rotation about the vertical axis in degrees, clockwise seen from above.
    pub turn: f64,
    /// Scale factor.
    pub size: f32,
}

/// Number of vertices of a placeholder.
pub const CORNERS: usize = 12;

impl ObjectMesh {
    /// The placeholder, a pyramid with four sides that stands on the ground: a position and a normal for each vertex,
    /// three vertices a triangle, counter-clockwise seen from outside.
    #[must_use]
    pub fn placeholder(&self) -> [[[f32; 3]; 2]; CORNERS] {
        let (half, high) = (self.width / 2.0, self.width * 1.5);
        // The sides towards south, east, north and west.
        let feet = [[-half, half], [half, half], [half, -half], [-half, -half]];
        // The ratio of width to height determines the slope of the sides at any scale.
        let [out, up] = [3.0 / 10.0_f32.sqrt(), 1.0 / 10.0_f32.sqrt()];
        let mut corners = [[[0.0; 3]; 2]; CORNERS];
        for (k, [east, south]) in [[0.0, 1.0], [1.0, 0.0], [0.0, -1.0], [-1.0, 0.0]].into_iter().enumerate() {
            let normal = [east * out, up, south * out];
            let foot = |at: [f32; 2]| [[at[0], 0.0, at[1]], normal];
            corners[3 * k..3 * k + 3].copy_from_slice(&[
                foot(feet[k]),
                foot(feet[(k + 1) % 4]),
                [[0.0, high, 0.0], normal],
            ]);
        }
        corners
    }
}

impl Instance {
    /// The rotation as a quaternion (x, y, z, w) of glTF, whose y points up.
    #[must_use]
    pub fn rotation(&self) -> [f32; 4] {
        let half = -self.turn.to_radians() / 2.0;
        [0.0, libm::sin(half) as f32, 0.0, libm::cos(half) as f32]
    }

    /// The instance as a matrix of three rows: scaled rotation and position, with y up.
    #[must_use]
    pub fn transform(&self) -> [f32; 12] {
        let angle = -self.turn.to_radians();
        let [sine, cosine] = [libm::sin(angle), libm::cos(angle)].map(|part| (part * f64::from(self.size)) as f32);
        let [east, height, south] = self.position;
        [cosine, 0.0, sine, east, 0.0, self.size, 0.0, height, -sine, 0.0, cosine, south]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn placeholders_are_closed_above_the_ground_and_face_outwards() {
        let mesh = ObjectMesh { name: "tree".into(), color: [0.0; 3], width: 2.0, instances: Vec::new() };
        for triangle in mesh.placeholder().chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| triangle[k][0]);
            let edge = |to: [f32; 3]| [to[0] - a[0], to[1] - a[1], to[2] - a[2]];
            let ([ux, uy, uz], [vx, vy, vz]) = (edge(b), edge(c));
            let cross = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
            let length = cross.iter().map(|part| part * part).sum::<f32>().sqrt();
            for (part, normal) in cross.iter().zip(triangle[0][1]) {
                assert!((part / length - normal).abs() < 1e-6, "{cross:?} {:?}", triangle[0][1]);
            }
            assert_eq!((a[1], b[1], c), (0.0, 0.0, [0.0, 3.0, 0.0]));
        }
    }

    #[test]
    fn turns_are_clockwise_seen_from_above() {
        let [x, y, z, w] = Instance { position: [0.0; 3], turn: 90.0, size: 1.0 }.rotation();
        // North (-z) becomes east (+x).
        let north = [-2.0 * (x * z + w * y), -2.0 * (y * z - w * x), -(1.0 - 2.0 * (x * x + y * y))];
        assert!((north[0] - 1.0).abs() < 1e-6 && north[1].abs() < 1e-6 && north[2].abs() < 1e-6, "{north:?}");
        let rows = Instance { position: [7.0, 8.0, 9.0], turn: 90.0, size: 2.0 }.transform();
        let north = [0, 1, 2].map(|row| -rows[4 * row + 2]);
        assert!((north[0] - 2.0).abs() < 1e-6 && north[1].abs() < 1e-6 && north[2].abs() < 1e-6, "{north:?}");
        assert_eq!([rows[3], rows[7], rows[11]], [7.0, 8.0, 9.0]);
    }
}
