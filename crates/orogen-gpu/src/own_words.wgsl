// Words of passes no two calls of which write the same word, or read one that another one writes: faster than those of `shared_words.wgsl`. The binding is that
// of `samples`, which they do not use.
@group(0) @binding(1) var<storage, read_write> words: array<u32>;

// A word of plane `k`.
fn word(k: u32, cell: u32) -> u32 {
    return words[word_index(k, cell)];
}

fn set_word(k: u32, cell: u32, value: u32) {
    words[word_index(k, cell)] = value;
}

// Lowers a word to `value`, if that is less.
fn lower_word(k: u32, cell: u32, value: u32) {
    set_word(k, cell, min(word(k, cell), value));
}

// Raises a word to `value`, if that is more.
fn raise_word(k: u32, cell: u32, value: u32) {
    set_word(k, cell, max(word(k, cell), value));
}

fn add_word(k: u32, cell: u32, value: u32) {
    set_word(k, cell, word(k, cell) + value);
}
