// Numbers marked cells from 1 in row order. A solver defines the planes `MARK` and `NUMBER`; unmarked cells get the
// number of the last marked cell before them.

// The number of marks of each row, at its first cell.
fn count_marks(base: u32, at: vec2<i32>) {
    if (at.x != 0) {
        return;
    }
    var count = 0u;
    for (var x = 0; x < size().x; x += 1) {
        count += word(MARK, cell_at(vec2<i32>(x, at.y)));
    }
    set_word(NUMBER, cell_at(at), count);
}

// The number of marks in all rows before each row.
fn sum_marks(base: u32, at: vec2<i32>) {
    if (any(at != vec2<i32>(0))) {
        return;
    }
    var sum = 0u;
    for (var y = 0; y < size().y; y += 1) {
        let row = cell_at(vec2<i32>(0, y));
        let count = word(NUMBER, row);
        set_word(NUMBER, row, sum);
        sum += count;
    }
}

fn number_marks(base: u32, at: vec2<i32>) {
    if (at.x != 0) {
        return;
    }
    var sum = word(NUMBER, cell_at(at));
    for (var x = 0; x < size().x; x += 1) {
        let cell = cell_at(vec2<i32>(x, at.y));
        sum += word(MARK, cell);
        set_word(NUMBER, cell, sum);
    }
}
