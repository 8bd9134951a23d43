//! The camera of the 3D view.
//!
//! Lengths are in units of half the longer side of the shown land. The origin is at its center; x points east, y up and
//! z south.

use glam::{Mat4, Vec3, Vec4};

/// The camera looks at a point from a distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The point that it looks at.
    pub target: Vec3,
    /// Direction from the target to the camera, clockwise from south, in radians.
    pub yaw: f32,
    /// Elevation of the camera over the target, in radians.
    pub pitch: f32,
    /// Distance from the target.
    pub distance: f32,
}

/// Vertical field of view, in radians.
const FIELD: f32 = 0.7;

/// Minimum and maximum elevation: from slightly below level to nearly from above.
const PITCHES: [f32; 2] = [-0.2, 1.55];

/// Minimum and maximum distance.
const DISTANCES: [f32; 2] = [0.02, 12.0];

/// Maximum distance of the target from the center.
const REACH: f32 = 2.0;

impl Default for Camera {
    fn default() -> Camera {
        // Slightly in front of the center, so that the land appears in the middle of the picture.
        Camera { target: Vec3::new(0.12, 0.0, 0.25), yaw: 0.55, pitch: 0.62, distance: 3.05 }
    }
}

/// A direction to look from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "its name says it")]
pub enum Side {
    Above,
    North,
    East,
    South,
    West,
}

impl Side {
    /// All sides.
    pub const ALL: [Side; 5] = [Side::Above, Side::North, Side::East, Side::South, Side::West];

    /// The catalog key of its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Side::Above => "relief.from_above",
            Side::North => "relief.from_north",
            Side::East => "relief.from_east",
            Side::South => "relief.from_south",
            Side::West => "relief.from_west",
        }
    }
}

impl Camera {
    /// The camera that sees the whole land from a side.
    #[must_use]
    pub fn of_side(side: Side) -> Camera {
        let quarters = match side {
            Side::Above | Side::South => 0.0,
            Side::East => 1.0,
            Side::North => 2.0,
            Side::West => 3.0,
        };
        let pitch = if side == Side::Above { PITCHES[1] } else { 0.5 };
        Camera { target: Vec3::ZERO, yaw: quarters * std::f32::consts::FRAC_PI_2, pitch, distance: 3.0 }
    }

    /// The camera as numbers, to be kept in a file.
    #[must_use]
    pub fn numbers(&self) -> [f32; 6] {
        [self.target.x, self.target.y, self.target.z, self.yaw, self.pitch, self.distance]
    }

    /// The camera of [`numbers`](Camera::numbers), within its limits; what is not finite gets its default.
    #[must_use]
    pub fn of_numbers(numbers: [f32; 6]) -> Camera {
        if numbers.iter().any(|number| !number.is_finite()) {
            return Camera::default();
        }
        let [x, y, z, yaw, pitch, distance] = numbers;
        Camera {
            target: Vec3::new(x, y, z).clamp(Vec3::splat(-REACH), Vec3::splat(REACH)),
            yaw: yaw.rem_euclid(std::f32::consts::TAU),
            pitch: pitch.clamp(PITCHES[0], PITCHES[1]),
            distance: distance.clamp(DISTANCES[0], DISTANCES[1]),
        }
    }

    /// The position of the camera.
    #[must_use]
    pub fn position(&self) -> Vec3 {
        self.target - self.forward() * self.distance
    }

    /// The viewing direction.
    #[must_use]
    pub fn forward(&self) -> Vec3 {
        let level = libm::cosf(self.pitch);
        -Vec3::new(libm::sinf(self.yaw) * level, libm::sinf(self.pitch), libm::cosf(self.yaw) * level)
    }

    /// The direction from the target to the camera, in degrees clockwise from north, and its elevation in degrees above
    /// the horizon: rounded to a tenth, and never below the horizon.
    #[must_use]
    pub fn bearing(&self) -> [f64; 2] {
        let tenths = |degrees: f64| (degrees * 10.0).round() / 10.0;
        let azimuth = tenths((180.0 - f64::from(self.yaw).to_degrees()).rem_euclid(360.0));
        [azimuth % 360.0, tenths(f64::from(self.pitch).to_degrees()).clamp(0.0, 90.0)]
    }

    fn right(&self) -> Vec3 {
        Vec3::new(libm::cosf(self.yaw), 0.0, -libm::sinf(self.yaw))
    }

    /// The size of a pixel at a position, for a picture with this number of pixels in its height.
    #[must_use]
    pub fn pixel(&self, place: Vec3, height: f32) -> f32 {
        2.0 * libm::tanf(FIELD / 2.0) * place.distance(self.position()) / height.max(1.0)
    }

    /// The matrix from the view's space to clip space, for a picture with this ratio of width to height. Depths are
    /// reversed: 1 is near, 0 is far.
    #[must_use]
    pub fn matrix(&self, aspect: f32) -> Mat4 {
        let near = (self.distance * 0.01).max(1e-3);
        let projection = Mat4::perspective_infinite_reverse_rh(FIELD, aspect.max(1e-3), near);
        projection * Mat4::look_at_rh(self.position(), self.target, Vec3::Y)
    }

    /// Rotates around the target; movements are relative to the view's height.
    pub fn orbit(&mut self, [right, down]: [f32; 2]) {
        self.yaw = (self.yaw - right * 3.0).rem_euclid(std::f32::consts::TAU);
        self.pitch = (self.pitch + down * 3.0).clamp(PITCHES[0], PITCHES[1]);
    }

    /// Moves the target over level ground, so that the point under the pointer follows it; movements are relative to
    /// the view's height.
    pub fn pan(&mut self, [right, down]: [f32; 2]) {
        let scale = 2.0 * self.distance * libm::tanf(FIELD / 2.0);
        let ahead = Vec3::new(-libm::sinf(self.yaw), 0.0, -libm::cosf(self.yaw));
        let steep = libm::sinf(self.pitch.abs()).max(0.25);
        self.go(self.right() * (-right * scale) + ahead * (down * scale / steep));
    }

    /// Moves closer by a factor above 1, or away by a factor below 1.
    pub fn zoom(&mut self, factor: f32) {
        self.distance = (self.distance / factor.clamp(0.1, 10.0)).clamp(DISTANCES[0], DISTANCES[1]);
    }

    /// Moves the camera with its target to the right, up and ahead, relative to the distance.
    pub fn fly(&mut self, [right, up, ahead]: [f32; 3]) {
        let step = self.right() * right + Vec3::Y * up + self.forward() * ahead;
        self.go(step * self.distance);
    }

    fn go(&mut self, step: Vec3) {
        self.target = (self.target + step).clamp(Vec3::splat(-REACH), Vec3::splat(REACH));
    }

    /// The ray through a position of the picture, from 0, 0 in its upper left corner to 1, 1 in its lower right corner:
    /// its origin and its unit direction.
    #[must_use]
    pub fn ray(&self, [right, down]: [f32; 2], aspect: f32) -> [Vec3; 2] {
        let inverse = self.matrix(aspect).inverse();
        let through = inverse * Vec4::new(2.0 * right - 1.0, 1.0 - 2.0 * down, 0.5, 1.0);
        let start = self.position();
        [start, (through.truncate() / through.w - start).normalize_or_zero()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_look_from_where_they_are_called() {
        for (side, azimuth) in [(Side::North, 0.0), (Side::East, 90.0), (Side::South, 180.0), (Side::West, 270.0)] {
            assert_eq!(Camera::of_side(side).bearing()[0], azimuth, "{side:?}");
        }
        assert!(Camera::of_side(Side::Above).bearing()[1] > 88.0);
    }

    #[test]
    fn numbers_come_back_and_broken_ones_do_no_harm() {
        let camera = Camera { target: Vec3::new(0.1, -0.2, 0.3), yaw: 1.0, pitch: 0.4, distance: 0.5 };
        assert_eq!(Camera::of_numbers(camera.numbers()), camera);
        let far = Camera::of_numbers([1e9, 0.0, 0.0, -9.0, 9.0, 0.0]);
        assert!(far.position().is_finite() && far.distance == DISTANCES[0] && far.pitch == PITCHES[1]);
        assert_eq!(Camera::of_numbers([f32::NAN; 6]), Camera::default());
    }

    #[test]
    fn the_target_is_in_the_middle_of_the_picture() {
        let mut camera = Camera { target: Vec3::new(0.3, 0.1, -0.2), ..Camera::default() };
        for step in [[0.1, 0.0], [0.4, -0.3], [-2.0, 5.0]] {
            camera.orbit(step);
            let clip = camera.matrix(1.6) * camera.target.extend(1.0);
            assert!((clip.x / clip.w).abs() < 1e-4 && (clip.y / clip.w).abs() < 1e-4, "{camera:?}");
            let [start, ray] = camera.ray([0.5, 0.5], 1.6);
            assert!((start + ray * camera.distance - camera.target).length() < 1e-3);
            assert!(camera.pitch >= PITCHES[0] && camera.pitch <= PITCHES[1]);
        }
    }

    #[test]
    fn bearings_are_those_of_a_map() {
        for (yaw, pitch, expect) in
            [(0.0, 0.5, [180.0, 28.6]), (1.570_796_4, -0.1, [90.0, 0.0]), (3.2, 1.55, [356.7, 88.8])]
        {
            let camera = Camera { target: Vec3::ZERO, yaw, pitch, distance: 1.0 };
            assert_eq!(camera.bearing(), expect);
            // East is x, and south is z.
            let place = camera.position();
            let azimuth = f64::from(libm::atan2f(place.x, -place.z)).to_degrees().rem_euclid(360.0);
            assert!((azimuth - expect[0]).abs() < 0.1, "{azimuth}");
        }
    }

    #[test]
    fn panning_moves_the_ground_with_the_pointer() {
        let mut camera = Camera { yaw: 0.0, pitch: 1.5, ..Camera::default() };
        let before = camera.matrix(1.0) * Vec4::new(0.0, 0.0, 0.0, 1.0);
        camera.pan([0.1, 0.05]);
        let after = camera.matrix(1.0) * Vec4::new(0.0, 0.0, 0.0, 1.0);
        let moved = [after.x / after.w - before.x / before.w, after.y / after.w - before.y / before.w];
        // Clip space has a height of two, and y points up.
        assert!((moved[0] - 0.2).abs() < 0.02 && (moved[1] + 0.1).abs() < 0.02, "{moved:?}");
    }

    #[test]
    fn distances_are_bounded() {
        let mut camera = Camera::default();
        (0..100).for_each(|_| camera.zoom(2.0));
        assert_eq!(camera.distance, DISTANCES[0]);
        (0..100).for_each(|_| camera.zoom(0.5));
        assert_eq!(camera.distance, DISTANCES[1]);
        camera.fly([1e9, 0.0, 0.0]);
        assert!(camera.target.x.abs() <= REACH && camera.matrix(0.0).is_finite());
    }
}
