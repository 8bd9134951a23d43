//! The camera of a picture.

use super::march::Ray;
use super::relief::Relief;
use super::vector::Vector;

/// Position and direction of a camera, in the world's metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum View {
    /// On a sphere around the center of the land.
    Around {
        /// Direction of the camera from the center, in degrees clockwise from north.
        azimuth: f64,
        /// Elevation of the camera, in degrees above the horizon.
        elevation: f64,
        /// Distance from the center, in metres; `None` chooses it so that all of the land is visible.
        distance: Option<f64>,
    },
    /// At a given position.
    At {
        /// Position: metres east and south of the world's origin, and height in metres.
        eye: [f64; 3],
        /// The target at the center of the picture: metres east and south, at ground level.
        look: [f64; 2],
    },
}

/// A picture's camera: its view, its size and its angle of view.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CameraSpec {
    /// Position and direction.
    pub view: View,
    /// Width and height of the picture, in pixels. The camera depends on their ratio only.
    pub size: [usize; 2],
    /// Angle of view along the longer side, in degrees; 40 by default.
    pub fov: f64,
}

impl CameraSpec {
    /// A view in a picture of this size.
    #[must_use]
    pub fn new(view: View, size: [usize; 2]) -> CameraSpec {
        CameraSpec { view, size, fov: 40.0 }
    }

    /// Sets the angle of view along the longer side, in degrees.
    #[must_use]
    pub fn with_fov(self, fov: f64) -> CameraSpec {
        CameraSpec { fov, ..self }
    }

    /// Sets the position and direction.
    #[must_use]
    pub fn with_view(self, view: View) -> CameraSpec {
        CameraSpec { view, ..self }
    }
}

/// The box that must be visible when the distance of a camera is chosen automatically, in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The north-western lower corner.
    pub low: Vector,
    /// The south-eastern upper corner.
    pub high: Vector,
    /// Whether the land continues beyond its edges, mirrored.
    pub mirrored: bool,
}

impl Frame {
    fn middle(&self) -> Vector {
        (self.low + self.high) * 0.5
    }

    fn corners(&self) -> impl Iterator<Item = Vector> {
        let Frame { low, high, .. } = *self;
        (0..8).map(move |k| {
            let pick = |bit: usize, low: f64, high: f64| if k & bit == 0 { low } else { high };
            Vector::new(pick(1, low.x, high.x), pick(2, low.y, high.y), pick(4, low.z, high.z))
        })
    }
}

/// Margin around the land on each side, as a share of the picture, when the distance is chosen automatically.
const MARGIN: f64 = 0.02;

/// Minimum height of a camera above the ground, in cells.
const LEAST: f64 = 0.05;

/// A placed camera: gives the ray of every point of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    eye: Vector,
    pub(super) ahead: Vector,
    pub(super) right: Vector,
    pub(super) down: Vector,
    /// Tangents of half the angles of view.
    pub(super) wide: [f64; 2],
    lifted: Option<f64>,
}

impl Camera {
    /// A camera over the land. `frame` is only used if the distance is chosen automatically.
    #[must_use]
    pub fn new(spec: &CameraSpec, relief: &Relief, frame: &Frame) -> Camera {
        let half = libm::tan(spec.fov.to_radians() / 2.0);
        let origin = relief.origin();
        let [width, height] = spec.size.map(|side| side as f64);
        let longer = width.max(height);
        let wide = [half * width / longer, half * height / longer];
        let cells = |[x, y]: [f64; 2]| [(x - origin[0]) / relief.cell(), (y - origin[1]) / relief.cell()];
        let mut camera = match spec.view {
            View::Around { azimuth, elevation, distance } => {
                let middle = frame.middle();
                let out = Vector::towards(azimuth, elevation);
                let look = Camera::towards(middle, -out, azimuth, wide);
                let distance = match distance {
                    Some(distance) => distance / relief.cell(),
                    None => look.framing(frame, out),
                };
                // From above, the near half takes more of the picture, so the center of the frame differs from the
                // center of the land.
                let mut camera = Camera { eye: middle + out * distance, ..look };
                camera.center(frame);
                camera
            }
            View::At { eye, look } => {
                let [x, y] = cells([eye[0], eye[1]]);
                let [look_x, look_y] = cells(look);
                let eye = Vector::new(x, y, relief.level_of(eye[2]));
                let aim = Vector::new(look_x, look_y, relief.top(look_x, look_y));
                let azimuth = libm::atan2(eye.x - aim.x, aim.y - eye.y).to_degrees();
                Camera::towards(eye, (aim - eye).unit(), azimuth, wide)
            }
        };
        camera.lift(relief, frame);
        camera
    }

    /// The distance, in metres, from which all of `frame` is visible from each of these directions: for a series of
    /// pictures around the land at a constant distance. `spec` gives the size and the angle of view.
    pub fn distance(sides: impl Iterator<Item = [f64; 2]>, spec: &CameraSpec, relief: &Relief, frame: &Frame) -> f64 {
        let middle = frame.middle();
        let away = sides.map(|[azimuth, elevation]| {
            let view = View::Around { azimuth, elevation, distance: None };
            let camera = Camera::new(&spec.with_view(view), relief, frame);
            (middle - camera.eye).dot(camera.ahead)
        });
        away.fold(0.0, f64::max) * relief.cell()
    }

    /// A camera at `eye` that looks in the direction `ahead`. `azimuth` is the direction from the target to the camera,
    /// used if `ahead` is vertical.
    fn towards(eye: Vector, ahead: Vector, azimuth: f64, wide: [f64; 2]) -> Camera {
        let (sin, cos) = libm::sincos(azimuth.to_radians());
        // Horizontal, to the right of a viewer who looks against `azimuth`.
        let right = Vector::new(-cos, -sin, 0.0);
        let down = right.cross(ahead).unit();
        Camera { eye, ahead, right, down, wide, lifted: None }
    }

    /// The position of a point in the picture, -1 to 1 along each axis; `None` if it is behind the camera.
    #[must_use]
    pub fn project(&self, place: Vector) -> Option<[f64; 2]> {
        let way = place - self.eye;
        let depth = way.dot(self.ahead);
        (depth > 1e-9).then(|| [way.dot(self.right) / depth / self.wide[0], way.dot(self.down) / depth / self.wide[1]])
    }

    /// The largest position of the box in the picture.
    fn framing(&self, frame: &Frame, out: Vector) -> f64 {
        let middle = self.eye;
        let fits = |distance: f64| {
            let mut camera = Camera { eye: middle + out * distance, ..*self };
            camera.center(frame);
            frame.corners().all(|corner| {
                camera.project(corner).is_some_and(|at| at.iter().all(|at| at.abs() <= 1.0 - 2.0 * MARGIN))
            })
        };
        let size = (frame.high - frame.low).length().max(1.0);
        let (mut near, mut far) = (0.0, size);
        while !fits(far) && far < 1e4 * size {
            far *= 2.0;
        }
        for _ in 0..50 {
            let half = 0.5 * (near + far);
            (near, far) = if fits(half) { (near, half) } else { (half, far) };
        }
        far
    }

    /// Moves the camera perpendicular to its line of sight until the box has equal distances from the upper and lower
    /// edges of the picture, and from the left and right edges.
    fn center(&mut self, frame: &Frame) {
        let depth = (frame.middle() - self.eye).dot(self.ahead);
        for _ in 0..8 {
            let mut low = [f64::INFINITY; 2];
            let mut high = [f64::NEG_INFINITY; 2];
            for corner in frame.corners() {
                let Some(at) = self.project(corner) else {
                    return;
                };
                for axis in 0..2 {
                    low[axis] = low[axis].min(at[axis]);
                    high[axis] = high[axis].max(at[axis]);
                }
            }
            let shift = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]) * self.wide[axis] * depth);
            self.eye = self.eye + self.right * shift[0] + self.down * shift[1];
        }
    }

    /// Raises a camera that is below the ground or, outside of the land, below the bottom of the land.
    fn lift(&mut self, relief: &Relief, frame: &Frame) {
        let [east, south] = relief.reach();
        let inside = (0.0..=east).contains(&self.eye.x) && (0.0..=south).contains(&self.eye.y);
        let below = match inside || frame.mirrored {
            true => relief.top(folded(self.eye.x, east).0, folded(self.eye.y, south).0),
            false => frame.low.z,
        };
        let least = below + LEAST;
        if self.eye.z < least {
            self.lifted = Some(relief.height_of(least) - relief.height_of(self.eye.z));
            self.eye.z = least;
        }
    }

    /// The position, in cells.
    #[must_use]
    pub fn eye(&self) -> Vector {
        self.eye
    }

    /// The distance in metres by which the camera was raised above ground and water; `None` if it was not.
    #[must_use]
    pub fn lifted(&self) -> Option<f64> {
        self.lifted
    }

    /// The ray through a point of the picture: (0, 0) is its upper left corner, (1, 1) its lower right corner.
    #[must_use]
    pub fn ray(&self, across: f64, down: f64) -> Ray {
        let (x, y) = ((2.0 * across - 1.0) * self.wide[0], (2.0 * down - 1.0) * self.wide[1]);
        Ray { from: self.eye, along: (self.ahead + self.right * x + self.down * y).unit() }
    }

    /// The width of a pixel at distance 1, in a picture of `width` pixels.
    #[must_use]
    pub fn pixel(&self, width: usize) -> f64 {
        2.0 * self.wide[0] / width as f64
    }
}

/// Folds a coordinate into 0 to `reach` by mirrors at both ends; returns it with its direction there: 1 or -1.
pub(super) fn folded(x: f64, reach: f64) -> (f64, f64) {
    let turn = x.rem_euclid(2.0 * reach);
    if turn <= reach { (turn, 1.0) } else { (2.0 * reach - turn, -1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::relief::Land;
    use orogen_grid::grid::{Grid, Window};

    fn relief() -> Relief {
        let heights =
            Grid::from_data(Window::new(21, 11, 10.0), (0..231).map(|i| (i % 7) as f32 * 10.0).collect()).unwrap();
        Relief::new(&Land { heights: &heights, surface: None, flow: None, sea_level: None }, 1.0).unwrap()
    }

    fn frame(relief: &Relief) -> Frame {
        let [east, south] = relief.reach();
        Frame { low: Vector::new(0.0, 0.0, -1.0), high: Vector::new(east, south, relief.highest()), mirrored: false }
    }

    #[test]
    fn what_lies_east_is_on_the_right_of_who_looks_north() {
        let relief = relief();
        for elevation in [0.0, 20.0, 89.0, 90.0] {
            let view = View::Around { azimuth: 180.0, elevation, distance: Some(900.0) };
            let camera = Camera::new(&CameraSpec::new(view, [640, 360]).with_fov(45.0), &relief, &frame(&relief));
            let middle = Vector::new(10.0, 5.0, 2.5);
            let east = camera.project(middle + Vector::new(1.0, 0.0, 0.0)).unwrap();
            let north = camera.project(middle + Vector::new(0.0, -1.0, 0.0)).unwrap();
            let up = camera.project(middle + Vector::UP).unwrap();
            assert!(east[0] > 0.01 && north[1] <= up[1].max(0.02), "{elevation}: {east:?} {north:?} {up:?}");
            assert!(elevation > 80.0 || up[1] < -0.01, "{elevation}: {up:?}");
            assert!(elevation < 10.0 || north[1] < -0.001, "{elevation}: {north:?}");
        }
    }

    #[test]
    fn rays_and_places_agree() {
        let relief = relief();
        let view = View::At { eye: [-50.0, 180.0, 300.0], look: [120.0, 40.0] };
        let camera = Camera::new(&CameraSpec::new(view, [300, 400]).with_fov(50.0), &relief, &frame(&relief));
        for (across, down) in [(0.5, 0.5), (0.1, 0.9), (0.8, 0.25)] {
            let place = camera.ray(across, down).at(17.0);
            let at = camera.project(place).unwrap();
            assert!((at[0] - (2.0 * across - 1.0)).abs() < 1e-9 && (at[1] - (2.0 * down - 1.0)).abs() < 1e-9);
        }
        // The center of the picture is the point that the camera looks at.
        let hit = relief.hit(&camera.ray(0.5, 0.5), 0.0).unwrap();
        let place = camera.ray(0.5, 0.5).at(hit.distance);
        assert!((place.x - 12.0).abs() < 1e-6 && (place.y - 4.0).abs() < 1e-6, "{place:?}");
    }

    #[test]
    fn by_itself_it_sees_all_of_the_land_and_fills_the_picture() {
        let relief = relief();
        for (azimuth, elevation, size) in
            [(0.0, 30.0, [1920, 1080]), (137.0, 10.0, [400, 900]), (200.0, 70.0, [500, 500])]
        {
            let view = View::Around { azimuth, elevation, distance: None };
            let camera = Camera::new(&CameraSpec::new(view, size), &relief, &frame(&relief));
            let mut most = [0.0f64; 2];
            for corner in frame(&relief).corners() {
                let at = camera.project(corner).unwrap();
                most = [0, 1].map(|axis| most[axis].max(at[axis].abs()));
            }
            assert!(most.iter().all(|most| *most < 1.0) && most[0].max(most[1]) > 0.94, "{azimuth}: {most:?}");
        }
    }

    #[test]
    fn underground_it_is_lifted_and_says_so() {
        let relief = relief();
        let view = View::At { eye: [55.0, 50.0, -80.0], look: [120.0, 40.0] };
        let camera = Camera::new(&CameraSpec::new(view, [300, 200]).with_fov(50.0), &relief, &frame(&relief));
        assert!(camera.lifted().unwrap() > 80.0 && camera.eye().z > relief.ground(5.5, 5.0));
        // Outside a bounded terrain the camera may be as low as its base; not if the terrain continues there.
        let view = View::At { eye: [-45.0, 50.0, -5.0], look: [120.0, 40.0] };
        assert_eq!(
            Camera::new(&CameraSpec::new(view, [300, 200]).with_fov(50.0), &relief, &frame(&relief)).lifted(),
            None
        );
        let mirrored = Frame { mirrored: true, ..frame(&relief) };
        let camera = Camera::new(&CameraSpec::new(view, [300, 200]).with_fov(50.0), &relief, &mirrored);
        assert!(camera.lifted().is_some() && camera.eye().z > relief.ground(4.5, 5.0));
        assert_eq!(
            [-3.0, 5.0, 12.0, 25.0].map(|x| folded(x, 10.0)),
            [(3.0, -1.0), (5.0, 1.0), (8.0, -1.0), (5.0, 1.0)]
        );
        let view = View::At { eye: [55.0, 50.0, 200.0], look: [120.0, 40.0] };
        assert_eq!(
            Camera::new(&CameraSpec::new(view, [300, 200]).with_fov(50.0), &relief, &frame(&relief)).lifted(),
            None
        );
    }
}
