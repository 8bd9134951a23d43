// Light of the sky on each sample, with the horizon in every direction.
//
// The shader runs twice for each direction. With `frame.step` 0 each invocation follows a line across the land and
// keeps the convex hull of the ground that it has passed. With 1 each invocation adds the light above the horizon of a
// sample. Lines of one direction are next to each other in memory, so that neighboring invocations read neighboring
// words. The names of the words are declared before this text. The CPU counterpart is
// `orogen-output/src/render/skylight.rs`.

fn word(index: u32) -> u32 {
    return data[frame.base + index];
}

fn whole_word(index: u32) -> i32 {
    return bitcast<i32>(word(index));
}

fn float_word(index: u32) -> f32 {
    return bitcast<f32>(word(index));
}

// The ground at column `i` and row `y` of the sweep.
fn ground_on_line(i: i32, y: f32) -> f32 {
    let lines = whole_word(LINES);
    let at = clamp(y, 0.0, f32(lines - 1));
    let j = min(i32(at), max(lines - 2, 0));
    let column = word(BED) + u32(i * lines);
    return mix(samples[column + u32(j)], samples[column + u32(min(j + 1, lines - 1))], at - f32(j));
}

fn slope_to(point: vec2<f32>, here: vec2<f32>) -> f32 {
    return (point.y - here.y) / (here.x - point.x);
}

// A point of the hull of a line.
fn hull_at(depth: u32, line: u32) -> vec2<f32> {
    let at = word(HULLS) + 2u * (depth * word(LINE_COUNT) + line);
    return vec2<f32>(samples[at], samples[at + 1u]);
}

fn follow_line(line: u32) {
    let count = word(LINE_COUNT);
    let length = whole_word(LENGTH);
    let last = f32(whole_word(LINES) - 1);
    let slant = float_word(SLANT);
    let start = f32(whole_word(FIRST_LINE) + i32(line));
    var depth = 0u;
    for (var k = 0; k < length; k++) {
        // Ground ahead comes first.
        let i = select(k, length - 1 - k, word(FORWARDS) != 0u);
        let out = word(HORIZONS) + u32(i) * count + line;
        let y = start + slant * f32(i);
        if (y < -1.0 || y > last + 1.0) {
            samples[out] = 0.0;
            continue;
        }
        let here = vec2<f32>(f32(k) * float_word(STEP), ground_on_line(i, y));
        var horizon = 0.0;
        if (depth > 0u) {
            horizon = slope_to(hull_at(depth - 1u, line), here);
        }
        while (depth > 1u) {
            let second = slope_to(hull_at(depth - 2u, line), here);
            if (second < horizon) {
                break;
            }
            horizon = second;
            depth -= 1u;
        }
        samples[out] = horizon;
        let top = word(HULLS) + 2u * (depth * count + line);
        samples[top] = here.x;
        samples[top + 1u] = here.y;
        depth += 1u;
    }
}

fn dome_at(index: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(vec4<u32>(data[index], data[index + 1u], data[index + 2u], data[index + 3u]));
}

// The light above a horizon with slope `slope`, on ground whose normal has the component `lean` towards it and `up`
// upward.
fn dome_light(slope: f32, lean: f32, up: f32) -> vec4<f32> {
    let high = max(slope, 0.0);
    let at = high / sqrt(1.0 + high * high) * f32(ENTRIES);
    let k = min(u32(at), ENTRIES - 1u);
    let share = at - f32(k);
    let low = word(DOME) + 8u * k;
    let leaning = mix(dome_at(low), dome_at(low + 8u), share);
    let level = mix(dome_at(low + 4u), dome_at(low + 12u), share);
    return max(lean * leaning + up * level, vec4<f32>(0.0));
}

fn bed_at(i: i32, j: i32) -> f32 {
    return samples[word(BED) + u32(i * whole_word(LINES) + j)];
}

// Adds the light of this direction to the sample at column `i` and row `j` of the sweep.
fn add_light(i: i32, j: i32) {
    let lines = whole_word(LINES);
    let count = word(LINE_COUNT);
    let line = f32(j) - float_word(SLANT) * f32(i) - f32(whole_word(FIRST_LINE));
    let index = min(u32(max(line, 0.0)), count - 1u);
    let row = word(HORIZONS) + u32(i) * count;
    let slope = mix(samples[row + index], samples[row + min(index + 1u, count - 1u)], line - f32(index));
    let west = max(i - 1, 0);
    let east = min(i + 1, whole_word(LENGTH) - 1);
    let above = max(j - 1, 0);
    let below = min(j + 1, lines - 1);
    let gx = (bed_at(east, j) - bed_at(west, j)) / f32(max(east - west, 1));
    let gy = (bed_at(i, below) - bed_at(i, above)) / f32(max(below - above, 1));
    let up = 1.0 / sqrt(1.0 + gx * gx + gy * gy);
    let lean = -(gx * float_word(ALONG) + gy * float_word(ACROSS)) * up;
    let light = dome_light(slope, lean, up);
    let to = word(SHED) + 4u * (u32(i) * word(STRIDE_ALONG) + u32(j) * word(STRIDE_ACROSS));
    samples[to] += light.x;
    samples[to + 1u] += light.y;
    samples[to + 2u] += light.z;
    samples[to + 3u] += light.w;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    if (frame.step == 0u) {
        // Workgroups are in one row; their invocations follow adjacent lines.
        let line = (id.x / 8u) * 64u + local;
        if (line < word(LINE_COUNT)) {
            follow_line(line);
        }
        return;
    }
    if (id.x >= frame.width || id.y >= frame.height) {
        return;
    }
    // Neighboring invocations take neighboring samples of the land.
    if (word(STRIDE_ALONG) == 1u) {
        add_light(i32(id.x), i32(id.y));
    } else {
        add_light(i32(id.y), i32(id.x));
    }
}
