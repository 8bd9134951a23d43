// Words for passes whose calls neither write the same word nor read words that other calls write. They are faster than
// the atomic words of `shared_words.wgsl`. They have the binding of `samples`, which such passes do not use.
@group(0) @binding(1) var<storage, read_write> words: array<u32>;

// A word of plane `k`.
fn word(k: u32, cell: u32) -> u32 {
    return words[word_index(k, cell)];
}

fn set_word(k: u32, cell: u32, value: u32) {
    words[word_index(k, cell)] = value;
}

// Sets a word to the minimum of it and `value`.
fn lower_word(k: u32, cell: u32, value: u32) {
    set_word(k, cell, min(word(k, cell), value));
}

// Sets a word to the maximum of it and `value`.
fn raise_word(k: u32, cell: u32, value: u32) {
    set_word(k, cell, max(word(k, cell), value));
}

fn add_word(k: u32, cell: u32, value: u32) {
    set_word(k, cell, word(k, cell) + value);
}
