//! The view of the map: converts between positions in the world and in the view.

/// A part of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapView {
    /// The position at the center: metres east and south of the origin.
    pub center: [f64; 2],
    /// Metres per point of the view.
    pub scale: f64,
}

/// Minimum and maximum scale, in metres per point.
const SCALES: [f64; 2] = [1e-3, 1e6];

impl MapView {
    /// The view that shows a whole area, given by its west, north, east and south in metres, in a view of this size in
    /// points.
    #[must_use]
    pub fn fitting([west, north, east, south]: [f64; 4], [width, height]: [f32; 2]) -> MapView {
        let scale = ((east - west) / f64::from(width.max(1.0))).max((south - north) / f64::from(height.max(1.0)));
        MapView {
            center: [(west + east) / 2.0, (north + south) / 2.0],
            scale: (scale * 1.04).clamp(SCALES[0], SCALES[1]),
        }
    }

    /// The world position at a position in a view of this size.
    #[must_use]
    pub fn world(&self, at: [f32; 2], size: [f32; 2]) -> [f64; 2] {
        std::array::from_fn(|k| self.center[k] + f64::from(at[k] - size[k] / 2.0) * self.scale)
    }

    /// The position in the view of a world position.
    #[must_use]
    pub fn screen(&self, world: [f64; 2], size: [f32; 2]) -> [f32; 2] {
        std::array::from_fn(|k| ((world[k] - self.center[k]) / self.scale) as f32 + size[k] / 2.0)
    }

    /// Moves by points of the view: the position under the pointer follows it.
    pub fn pan(&mut self, by: [f32; 2]) {
        for (center, by) in self.center.iter_mut().zip(by) {
            *center = (*center - f64::from(by) * self.scale).clamp(-1e12, 1e12);
        }
    }

    /// Zooms in by a factor above 1, or out; the position under `at` does not move.
    pub fn zoom(&mut self, factor: f64, at: [f32; 2], size: [f32; 2]) {
        let fixed = self.world(at, size);
        self.scale = (self.scale / factor.clamp(0.1, 10.0)).clamp(SCALES[0], SCALES[1]);
        let now = self.world(at, size);
        for k in 0..2 {
            self.center[k] += fixed[k] - now[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_go_there_and_back() {
        let view = MapView { center: [1e6, -3e5], scale: 12.5 };
        let size = [800.0, 600.0];
        for at in [[0.0, 0.0], [400.0, 300.0], [123.0, 456.0]] {
            let back = view.screen(view.world(at, size), size);
            assert!((back[0] - at[0]).abs() < 1e-2 && (back[1] - at[1]).abs() < 1e-2);
        }
    }

    #[test]
    fn what_is_under_the_pointer_stays_there() {
        let (mut view, size, at) = (MapView { center: [5.0, 6.0], scale: 2.0 }, [640.0, 480.0], [100.0, 420.0]);
        let before = view.world(at, size);
        for factor in [1.3, 0.2, 7.0] {
            view.zoom(factor, at, size);
            let after = view.world(at, size);
            assert!((0..2).all(|k| (after[k] - before[k]).abs() < 1e-6));
        }
    }

    #[test]
    fn a_fitting_view_shows_all() {
        let view = MapView::fitting([0.0, 0.0, 1000.0, 3000.0], [500.0, 400.0]);
        let (a, b) = (view.screen([0.0, 0.0], [500.0, 400.0]), view.screen([1000.0, 3000.0], [500.0, 400.0]));
        assert!(a[0] >= 0.0 && a[1] >= 0.0 && b[0] <= 500.0 && b[1] <= 400.0);
    }
}
