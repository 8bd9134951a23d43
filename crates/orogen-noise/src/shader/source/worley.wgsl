// Cellular noise: distances to points, one per cell. It has no slopes.
//
// Words of the source: share of a cell in which its point is placed, the rest before it, distance (0 euclidean, 1 manhattan, 2 chebyshev), feature (0 first,
// 1 second, 2 difference, 3 product, 4 value, 5 edge), and the factor that maps the feature to 0 ..= 2.

const WORLEY_FAR: f32 = 1e9;
// Maximum number of cells from a sample's cell to that of a point that matters.
const WORLEY_SHELLS: i32 = 5;

struct WorleySite {
    // Vector from the sample to the point.
    way: vec2<f32>,
    hash: u32,
}

fn worley_site(source: u32, octave: u32, x: Cell, y: Cell, offset: vec2<i32>) -> WorleySite {
    let hash = noise_hash(noise_key(octave, stepped(x, offset.x)), noise_key(octave + 2u, stepped(y, offset.y)));
    let second = (hash ^ (hash >> 16u)) * 0x93d765ddu;
    let place = vec2<f32>(noise_unit(hash), noise_unit(second)) * number(source, WORLEY_JITTER) + number(source, WORLEY_REST);
    return WorleySite((place + vec2<f32>(offset)) - vec2<f32>(x.t, y.t), hash);
}

// The distance of a vector; squared for the euclidean one.
fn worley_distance(distance: u32, way: vec2<f32>) -> f32 {
    let size = abs(way);
    if (distance == 0u) {
        return way.x * way.x + way.y * way.y;
    }
    return select(max(size.x, size.y), size.x + size.y, distance == 1u);
}

// Distance from the sample to the line midway between two points; very large if they are the same.
fn worley_midway(near: vec2<f32>, other: vec2<f32>) -> f32 {
    let between = other - near;
    let apart = between.x * between.x + between.y * between.y;
    let along = (other.x + near.x) * between.x + (other.y + near.y) * between.y;
    if (apart > 1e-12) {
        return max(along * 0.5 / sqrt(apart), 0.0);
    }
    return WORLEY_FAR;
}

fn worley_value(source: u32, octave: u32, x: Cell, y: Cell) -> f32 {
    let distance = data[source + WORLEY_DISTANCE];
    let feature = data[source + WORLEY_FEATURE];
    let euclidean = distance == 0u;
    let one = feature == 0u || feature == 4u || (feature == 5u && euclidean);
    let side = min(min(x.t, 1.0 - x.t), min(y.t, 1.0 - y.t));
    var first = WORLEY_FAR;
    var second = WORLEY_FAR;
    var way = vec2<f32>(WORLEY_FAR);
    var hash = 0u;
    // The neighboring cells first, then shells of cells as far as points can be nearer. The order of the cells is that of the processor's kernel.
    for (var shell = 1; shell <= WORLEY_SHELLS; shell = shell + 1) {
        if (shell > 1) {
            let reach = (side + f32(shell - 1)) * 0.999999;
            if (select(reach, reach * reach, euclidean) >= select(second, first, one)) {
                break;
            }
        }
        for (var j = -shell; j <= shell; j = j + 1) {
            let stride = select(2 * shell, 1, shell == 1 || abs(j) == shell);
            for (var i = -shell; i <= shell; i = i + stride) {
                let site = worley_site(source, octave, x, y, vec2<i32>(i, j));
                let d = worley_distance(distance, site.way);
                if (d < first) {
                    way = site.way;
                    hash = site.hash;
                }
                second = min(second, max(first, d));
                first = min(first, d);
            }
        }
    }
    if (feature == 4u) {
        return noise_signed((hash ^ (hash >> 16u)) * 0xadb4a92du);
    }
    if (euclidean) {
        first = sqrt(first);
        second = sqrt(second);
    }
    var raw = first;
    switch feature {
        case 0u: {
        }
        case 1u: {
            raw = second;
        }
        case 2u: {
            raw = second - first;
        }
        case 3u: {
            raw = first * second;
        }
        default: {
            raw = (second - first) * 0.5;
            if (euclidean) {
                raw = worley_edge(source, octave, x, y, way, first, side);
            }
        }
    }
    return min(raw * number(source, WORLEY_SCALE) - 1.0, 1.0);
}

// Distance to the nearest edge: to the nearest line midway between the nearest point and another one.
fn worley_edge(source: u32, octave: u32, x: Cell, y: Cell, near: vec2<f32>, first: f32, side: f32) -> f32 {
    var least = WORLEY_FAR;
    for (var shell = 1; shell <= WORLEY_SHELLS; shell = shell + 1) {
        // The line of a point at distance R is at least (R - first) / 2 away.
        if (shell > 1 && (side + f32(shell - 1)) * 0.99999 >= least * 2.0 + first) {
            break;
        }
        for (var j = -shell; j <= shell; j = j + 1) {
            let stride = select(2 * shell, 1, shell == 1 || abs(j) == shell);
            for (var i = -shell; i <= shell; i = i + stride) {
                let site = worley_site(source, octave, x, y, vec2<i32>(i, j));
                least = min(least, worley_midway(near, site.way));
            }
        }
    }
    return least;
}

fn worley_slopes(source: u32, octave: u32, x: Cell, y: Cell) -> vec3<f32> {
    return vec3<f32>(worley_value(source, octave, x, y), 0.0, 0.0);
}
