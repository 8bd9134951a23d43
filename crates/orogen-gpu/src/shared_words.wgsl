// Words for passes whose calls write words of other calls. They have the binding of `samples`, which such passes do not
// use.
@group(0) @binding(1) var<storage, read_write> words: array<atomic<u32>>;

// A word of plane `k`.
fn word(k: u32, cell: u32) -> u32 {
    return atomicLoad(&words[word_index(k, cell)]);
}

fn set_word(k: u32, cell: u32, value: u32) {
    atomicStore(&words[word_index(k, cell)], value);
}

// Sets a word to the minimum of it and `value`.
fn lower_word(k: u32, cell: u32, value: u32) {
    if (word(k, cell) > value) {
        atomicMin(&words[word_index(k, cell)], value);
    }
}

// Sets a word to the maximum of it and `value`.
fn raise_word(k: u32, cell: u32, value: u32) {
    if (word(k, cell) < value) {
        atomicMax(&words[word_index(k, cell)], value);
    }
}

fn add_word(k: u32, cell: u32, value: u32) {
    atomicAdd(&words[word_index(k, cell)], value);
}
