//! Vectors in space.

use serde::{Deserialize, Serialize};
use std::ops::{Add, Mul, Neg, Sub};

/// A direction or position: x east, y south, z up, as in grids.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Vector {
    /// East.
    pub x: f64,
    /// South.
    pub y: f64,
    /// Up.
    pub z: f64,
}

impl Vector {
    /// Straight up.
    pub const UP: Vector = Vector { x: 0.0, y: 0.0, z: 1.0 };

    /// From its components.
    pub fn new(x: f64, y: f64, z: f64) -> Vector {
        Vector { x, y, z }
    }

    /// The unit vector towards `azimuth` degrees clockwise from north and `elevation` degrees above the horizon.
    pub fn towards(azimuth: f64, elevation: f64) -> Vector {
        let (sin, cos) = libm::sincos(azimuth.to_radians());
        let (up, level) = libm::sincos(elevation.to_radians());
        Vector::new(sin * level, -cos * level, up)
    }

    /// The dot product.
    pub fn dot(self, other: Vector) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The cross product. Because y points south, east x south is up.
    pub fn cross(self, other: Vector) -> Vector {
        Vector::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// The length.
    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The same direction with length 1; a zero vector is unchanged.
    pub fn unit(self) -> Vector {
        let length = self.length();
        if length > 0.0 { self * (1.0 / length) } else { self }
    }

    /// The direction after reflection at a surface with this unit normal.
    pub fn mirrored(self, normal: Vector) -> Vector {
        self - normal * (2.0 * self.dot(normal))
    }
}

impl Add for Vector {
    type Output = Vector;

    fn add(self, other: Vector) -> Vector {
        Vector::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl Sub for Vector {
    type Output = Vector;

    fn sub(self, other: Vector) -> Vector {
        Vector::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl Mul<f64> for Vector {
    type Output = Vector;

    fn mul(self, by: f64) -> Vector {
        Vector::new(self.x * by, self.y * by, self.z * by)
    }
}

impl Neg for Vector {
    type Output = Vector;

    fn neg(self) -> Vector {
        Vector::new(-self.x, -self.y, -self.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuths_turn_clockwise_from_north() {
        for (azimuth, elevation, expect) in [
            (0.0, 0.0, [0.0, -1.0, 0.0]),
            (90.0, 0.0, [1.0, 0.0, 0.0]),
            (180.0, 0.0, [0.0, 1.0, 0.0]),
            (270.0, 0.0, [-1.0, 0.0, 0.0]),
            (123.0, 90.0, [0.0, 0.0, 1.0]),
        ] {
            let got = Vector::towards(azimuth, elevation);
            let miss = got - Vector::new(expect[0], expect[1], expect[2]);
            assert!(miss.length() < 1e-12, "{azimuth} {elevation}: {got:?}");
        }
    }

    #[test]
    fn mirrors_and_right_angles() {
        let down = Vector::new(0.6, 0.0, -0.8);
        assert_eq!(down.mirrored(Vector::UP), Vector::new(0.6, 0.0, 0.8));
        let (east, south) = (Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0));
        assert_eq!(east.cross(south), Vector::UP);
        assert_eq!(Vector::new(0.0, 0.0, 0.0).unit(), Vector::new(0.0, 0.0, 0.0));
    }
}
