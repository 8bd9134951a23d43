//! The land of a picture as it stands in the 3D view.

use std::sync::Arc;

use glam::Vec3;

use super::camera::Camera;
use crate::preview::frame::Frame;
use crate::preview::ring::Ring;

/// The land of a picture in the space of the 3D view.
pub struct Land<'a> {
    frame: &'a Frame,
    /// The rings of detail, from coarse to fine.
    rings: &'a [Arc<Ring>],
    /// Metres per unit of the view.
    unit: f64,
    /// Units of the view per metre of height.
    up: f32,
    /// The height at 0.
    middle: f32,
    /// The position at the center of the view, in metres.
    center: [f64; 2],
}

/// Number of steps along a ray, and of halvings after it met the land.
const STEPS: [u32; 2] = [640, 12];

impl<'a> Land<'a> {
    /// The land of a picture and its rings, with this vertical exaggeration, and this height at the center of the view.
    #[must_use]
    pub fn new((frame, rings): (&'a Frame, &'a [Arc<Ring>]), times: f64, middle: f32) -> Land<'a> {
        let window = frame.window();
        let unit = Land::unit(frame);
        let half = |samples: usize| (samples.max(2) - 1) as f64 / 2.0;
        let center =
            [window.x as f64 + half(window.width), window.y as f64 + half(window.height)].map(|at| at * window.cell);
        Land { frame, rings, unit, up: (times / unit) as f32, middle, center }
    }

    /// Metres per unit of the view of a picture.
    #[must_use]
    pub fn unit(frame: &Frame) -> f64 {
        let window = frame.window();
        window.width.max(window.height) as f64 * window.cell / 2.0
    }

    /// The position in the world of a point in the view, in metres.
    #[must_use]
    pub fn world(&self, place: Vec3) -> [f64; 2] {
        [self.center[0] + f64::from(place.x) * self.unit, self.center[1] + f64::from(place.z) * self.unit]
    }

    /// The height at a position in the world, of the finest ring there.
    fn height(&self, at: [f64; 2]) -> Option<f32> {
        self.rings.iter().rev().find_map(|ring| ring.height(at)).or_else(|| self.frame.at(at).map(|[_, height]| height))
    }

    /// The point on the land at a position in the world; `None` beside the land.
    #[must_use]
    pub fn place(&self, at: [f64; 2]) -> Option<Vec3> {
        let height = self.height(at)?;
        let [east, south] = [0, 1].map(|k| ((at[k] - self.center[k]) / self.unit) as f32);
        height.is_finite().then(|| Vec3::new(east, (height - self.middle) * self.up, south))
    }

    /// The point where the ray through a position of the picture, from 0, 0 to 1, 1, meets the land.
    #[must_use]
    pub fn hit(&self, camera: &Camera, at: [f32; 2], aspect: f32) -> Option<Vec3> {
        let [start, ray] = camera.ray(at, aspect);
        let below = |place: Vec3| {
            let height = self.height(self.world(place))?;
            Some(place.y <= (height - self.middle) * self.up)
        };
        // Steps are finer than the lattice near the camera, which is enough for a pointer.
        let (mut far, step) = (0.0, camera.distance / 160.0);
        for _ in 0..STEPS[0] {
            if below(start + ray * far) == Some(true) {
                let (mut near, mut behind) = (far - step, far);
                for _ in 0..STEPS[1] {
                    let middle = (near + behind) / 2.0;
                    match below(start + ray * middle) {
                        Some(true) => behind = middle,
                        _ => near = middle,
                    }
                }
                return Some(start + ray * behind);
            }
            far += step;
        }
        None
    }
}
