//! The declaration of a key.

/// The declaration of a key.
pub struct Key<'k> {
    pub name: &'k str,
    pub doc: &'k str,
    /// The bounds of numbers.
    pub range: Option<[f64; 2]>,
    /// Whether a string may be any text, not only a name.
    pub text: Option<bool>,
    /// The name of two numbers in messages, such as `[WIDTH, HEIGHT]`.
    pub pair: Option<&'k str>,
    /// Whether one number may be given for both.
    pub single: Option<bool>,
    /// Whether the first of two numbers must not be greater than the second.
    pub ascending: Option<bool>,
    /// The default that the schema states.
    pub stated: Option<f64>,
    /// The number for which the key is left out.
    pub omitted: Option<f64>,
}

impl<'k> Key<'k> {
    /// A key without any of the optional properties.
    pub const fn new(name: &'k str, doc: &'k str) -> Key<'k> {
        let (text, single, ascending) = (None, None, None);
        Key { name, doc, range: None, text, pair: None, single, ascending, stated: None, omitted: None }
    }
}
