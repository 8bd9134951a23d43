// Where a sample is on lattices.

// A sample: its column and row, and how far it is displaced, in metres.
struct Placement {
    column: u32,
    row: u32,
    moved: vec2<f32>,
}

// A coordinate: the number of its cell as a whole number of 64 bits, and the fraction, from 0 to 1.
struct Cell {
    low: u32,
    high: u32,
    t: f32,
}

// The cell some cells on.
fn stepped(cell: Cell, steps: i32) -> Cell {
    let low = cell.low + bitcast<u32>(steps);
    // The high word of the steps, and the carry.
    var high = cell.high + bitcast<u32>(steps >> 31u);
    if (low < cell.low) {
        high = high + 1u;
    }
    return Cell(low, high, cell.t);
}

// A cell with a fraction beyond 0 ..= 1 that belongs to other cells.
fn carried(cell: Cell) -> Cell {
    let whole = floor(cell.t);
    return stepped(Cell(cell.low, cell.high, cell.t - whole), i32(whole));
}

// The cell that is the sum of two coordinates.
fn together(a: Cell, b: Cell) -> Cell {
    let low = a.low + b.low;
    var high = a.high + b.high;
    if (low < a.low) {
        high = high + 1u;
    }
    return carried(Cell(low, high, a.t + b.t));
}

// The upper twelve digits of a number; the others are the rest. Products of two such numbers are exact.
fn upper(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) & 0xfffff000u);
}

// Adds a displacement in metres times a factor that is the sum of two numbers. The product is computed in parts, so that it keeps its fraction where it is
// many cells.
fn displaced(cell: Cell, metres: f32, factor: vec2<f32>) -> Cell {
    let far = clamp(metres, -1e9, 1e9);
    let m = upper(far);
    let f = upper(factor.x);
    let product = m * f;
    let whole = clamp(floor(product), -1073741824.0, 1073741824.0);
    let rest = m * (factor.x - f) + (far - m) * factor.x + far * factor.y;
    let rest_whole = clamp(floor(rest), -1073741824.0, 1073741824.0);
    let t = cell.t + clamp(product - whole, 0.0, 1.0) + clamp(rest - rest_whole, 0.0, 1.0);
    return carried(stepped(stepped(Cell(cell.low, cell.high, t), i32(whole)), i32(rest_whole)));
}

fn tabled(table: u32, index: u32) -> Cell {
    let at = table + TABLED_WORDS * index;
    return Cell(data[at], data[at + 1u], bitcast<f32>(data[at + 2u]));
}

// The cell of a sample along an axis of the lattice whose block starts at `lattice`.
fn cell_at(lattice: u32, axis: u32, place: Placement) -> Cell {
    let columns = data[lattice + LATTICE_TABLES + 2u * axis];
    let rows = data[lattice + LATTICE_TABLES + 2u * axis + 1u];
    var cell = Cell(0u, 0u, 0.0);
    if (columns != 0u) {
        cell = tabled(columns, place.column);
        if (rows != 0u) {
            cell = together(cell, tabled(rows, place.row));
        }
    } else if (rows != 0u) {
        cell = tabled(rows, place.row);
    }
    let by = lattice + 4u * axis;
    let by_x = vec2<f32>(number(by, 0u), number(by, 1u));
    if (place.moved.x != 0.0 && by_x.x != 0.0) {
        cell = displaced(cell, place.moved.x, by_x);
    }
    let by_y = vec2<f32>(number(by, 2u), number(by, 3u));
    if (place.moved.y != 0.0 && by_y.x != 0.0) {
        cell = displaced(cell, place.moved.y, by_y);
    }
    return cell;
}

// A coordinate as one number, which is exact only near the lattice's origin.
fn coordinate(lattice: u32, axis: u32, place: Placement) -> f32 {
    let cell = cell_at(lattice, axis, place);
    let low = bitcast<i32>(cell.low);
    // Whether the high word is only the sign of the low one.
    if (bitcast<i32>(cell.high) == (low >> 31u)) {
        return f32(low) + cell.t;
    }
    return f32(bitcast<i32>(cell.high)) * 4294967296.0 + f32(cell.low);
}
