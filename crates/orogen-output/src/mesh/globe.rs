//! Positions on the globe: the ellipsoid of WGS 84, in metres from its center.

/// Radii of the ellipsoid of WGS 84.
const RADII: [f64; 3] = [6_378_137.0, 6_378_137.0, 6_356_752.314_245_179];

/// A point or a direction.
pub type Vector = [f64; 3];

fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|part| part * factor)
}

/// The difference of two points.
pub fn minus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] - b[i])
}

/// The scalar product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length of a vector.
pub fn length(a: Vector) -> f64 {
    libm::sqrt(dot(a, a))
}

/// The directions east, north and up at a place in radians.
pub fn axes([longitude, latitude]: [f64; 2]) -> [Vector; 3] {
    let (sin, cos) = (libm::sin(longitude), libm::cos(longitude));
    let (rise, run) = (libm::sin(latitude), libm::cos(latitude));
    [[-sin, cos, 0.0], [-rise * cos, -rise * sin, run], [run * cos, run * sin, rise]]
}

/// The point at a place in radians, `height` metres above the ellipsoid.
pub fn point(place: [f64; 2], height: f64) -> Vector {
    let [_, _, up] = axes(place);
    let squares: Vector = std::array::from_fn(|i| RADII[i] * RADII[i] * up[i]);
    let surface = scaled(squares, 1.0 / libm::sqrt(dot(up, squares)));
    std::array::from_fn(|i| surface[i] + height * up[i])
}

/// The longest distance of an occlusion point from the center of the globe, in radii: from far enough away it is
/// always visible.
const MAX_OCCLUSION: f64 = 1e3;

/// The point whose visibility over the horizon tells that of all `points`, on the ray to `center`, in radii of the
/// ellipsoid (K. Ring, "Horizon Culling", cesium.com, 2013).
pub fn occlusion(center: Vector, points: impl Iterator<Item = Vector>) -> Vector {
    let in_radii = |a: Vector| -> Vector { std::array::from_fn(|i| a[i] / RADII[i]) };
    let center = in_radii(center);
    let ray = scaled(center, 1.0 / length(center));
    let mut most: f64 = 1.0;
    for point in points.map(in_radii) {
        let distance = length(point);
        let direction = scaled(point, 1.0 / distance);
        // A point below the ellipsoid is taken as one on it.
        let distance = distance.max(1.0);
        let (cos, sin) = (dot(direction, ray), length(cross(direction, ray)));
        // The angle from the point down to the horizon.
        let (cos_horizon, sin_horizon) = (1.0 / distance, libm::sqrt(distance * distance - 1.0) / distance);
        let drop = cos * cos_horizon - sin * sin_horizon;
        most = most.max(if drop > 1.0 / MAX_OCCLUSION { 1.0 / drop } else { MAX_OCCLUSION });
    }
    scaled(ray, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_where_the_ellipsoid_has_them() {
        let quarter = std::f64::consts::FRAC_PI_2;
        for (place, height, expect) in [
            ([0.0, 0.0], 0.0, [RADII[0], 0.0, 0.0]),
            ([quarter, 0.0], 100.0, [0.0, RADII[1] + 100.0, 0.0]),
            ([0.0, quarter], -5.0, [0.0, 0.0, RADII[2] - 5.0]),
        ] {
            assert!(length(minus(point(place, height), expect)) < 1e-6, "{place:?}");
        }
        // EPSG guidance note 7-2, geographic to geocentric.
        let degrees = |d: f64, m: f64, s: f64| (d + m / 60.0 + s / 3600.0).to_radians();
        let found = point([degrees(2.0, 7.0, 46.38), degrees(53.0, 48.0, 33.82)], 73.0);
        assert!(length(minus(found, [3_771_793.97, 140_253.34, 5_124_304.35])) < 0.01, "{found:?}");
    }

    #[test]
    fn a_hidden_occlusion_point_means_that_all_points_are_hidden() {
        let points: Vec<Vector> = (0..49)
            .map(|k| point([0.3 + 0.01 * f64::from(k % 7), 0.7 + 0.01 * f64::from(k / 7)], 50.0 * f64::from(k)))
            .collect();
        let far = occlusion(points[24], points.iter().copied());
        let in_radii = |a: Vector| -> Vector { std::array::from_fn(|i| a[i] / RADII[i]) };
        // Whether the unit sphere hides a point from an eye.
        let is_hidden = |point: Vector, eye: Vector| {
            let to = minus(point, eye);
            let along = -dot(to, eye) / dot(to, to);
            let near = std::array::from_fn(|i| eye[i] + along.clamp(0.0, 1.0) * to[i]);
            along < 1.0 && length(near) < 1.0
        };
        let mut hidden = 0;
        for k in 0..2000 {
            let (angle, rise) = (f64::from(k) * 0.37, libm::sin(f64::from(k) * 0.11));
            let run = libm::sqrt(1.0 - rise * rise);
            let eye = scaled([run * libm::cos(angle), run * libm::sin(angle), rise], 1.001 + f64::from(k % 50) * 0.01);
            if is_hidden(far, eye) {
                hidden += 1;
                assert!(points.iter().all(|point| is_hidden(in_radii(*point), eye)), "{k}");
            }
        }
        assert!((500..1999).contains(&hidden), "{hidden}");
    }
}
