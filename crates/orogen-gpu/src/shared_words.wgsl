// Words of passes whose calls write to cells of others. The binding is that of `samples`, which they do not use.
@group(0) @binding(1) var<storage, read_write> words: array<atomic<u32>>;

// A word of plane `k`.
fn word(k: u32, cell: u32) -> u32 {
    return atomicLoad(&words[word_index(k, cell)]);
}

fn set_word(k: u32, cell: u32, value: u32) {
    atomicStore(&words[word_index(k, cell)], value);
}

// Lowers a word to `value`, if that is less.
fn lower_word(k: u32, cell: u32, value: u32) {
    if (word(k, cell) > value) {
        atomicMin(&words[word_index(k, cell)], value);
    }
}

// Raises a word to `value`, if that is more.
fn raise_word(k: u32, cell: u32, value: u32) {
    if (word(k, cell) < value) {
        atomicMax(&words[word_index(k, cell)], value);
    }
}

fn add_word(k: u32, cell: u32, value: u32) {
    atomicAdd(&words[word_index(k, cell)], value);
}
