// Gradients at the corners of triangles: simplex noise and both variants of OpenSimplex2. Coordinates are those of the skewed lattice.
//
// Words of the source: number of corners (3, or 5 with wide kernels), squared radius of a kernel, factor of the result, and the directions (0: sixteen, 1:
// twenty-four).

// One of 24 directions.
fn simplex_twelfth(hash: u32) -> vec2<f32> {
    let scaled = (hash >> 16u) * 12u;
    let index = scaled >> 16u;
    // The directions 6 to 11 are the mirror images of 5 to 0.
    let mirrored = index > 5u;
    let folded = select(index, 11u - index, mirrored);
    let odd = (folded & 1u) != 0u;
    let last = folded > 3u;
    let middle = folded > 1u;
    let x = select(
        select(select(0.991444886, 0.923879504, odd), select(0.793353319, 0.60876143, odd), middle),
        select(0.382683426, 0.130526185, odd),
        last,
    );
    let y = select(
        select(select(0.130526185, 0.382683426, odd), select(0.60876143, 0.793353319, odd), middle),
        select(0.923879504, 0.991444886, odd),
        last,
    );
    let sign = scaled << 16u;
    return vec2<f32>(noise_turned(select(x, -x, mirrored), sign), noise_turned(y, sign));
}

// Value and slopes by unskewed coordinates.
fn simplex_slopes(source: u32, octave: u32, x: Cell, y: Cell) -> vec3<f32> {
    let corners = data[source];
    let reach = number(source, SIMPLEX_REACH);
    let directions = data[source + SIMPLEX_DIRECTIONS];
    let t = vec2<f32>(x.t, y.t);
    let wide = y.t < x.t;
    // The fifth corner is the nearer one of the two beside the triangle: (2, 1) or (0, -1) if x is the larger fraction, (1, 2) or (-1, 0) if y is.
    let ahead = x.t + y.t > 1.0;
    let far = select(0, 2, ahead);
    let near = select(-1, 1, ahead);
    let extra = select(vec2<i32>(near, far), vec2<i32>(far, near), wide);
    let second = select(vec2<i32>(0, 1), vec2<i32>(1, 0), wide);
    var raw = vec3<f32>(0.0);
    for (var i = 0u; i < corners; i = i + 1u) {
        // The corners of the triangle, then the fourth one of the rhombus, then the one beside.
        var offset = vec2<i32>(0, 0);
        switch i {
            case 0u: {
            }
            case 1u: {
                offset = second;
            }
            case 2u: {
                offset = vec2<i32>(1, 1);
            }
            case 3u: {
                offset = second.yx;
            }
            default: {
                offset = extra;
            }
        }
        let skewed = t - vec2<f32>(offset);
        let way = skewed - (skewed.x + skewed.y) * 0.21132487;
        let left = max(reach - way.x * way.x - way.y * way.y, 0.0);
        let hash = noise_hash(noise_key(octave, stepped(x, offset.x)), noise_key(octave + 2u, stepped(y, offset.y)));
        var gradient: vec2<f32>;
        if (directions == 0u) {
            gradient = noise_sixteenth(hash);
        } else {
            gradient = simplex_twelfth(hash);
        }
        let ramp = gradient.x * way.x + gradient.y * way.y;
        let squared = left * left;
        let weight = squared * squared;
        let steep = squared * left * ramp * 8.0;
        raw = raw + vec3<f32>(weight * ramp, weight * gradient - steep * way);
    }
    return raw * number(source, SIMPLEX_SCALE);
}

fn simplex_value(source: u32, octave: u32, x: Cell, y: Cell) -> f32 {
    return simplex_slopes(source, octave, x, y).x;
}
