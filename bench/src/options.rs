//! What a measurement is told.

/// What the command line asks for.
pub struct Options {
    /// Only cases with this in their name.
    pub case: String,
    /// How often each job is timed.
    pub repetitions: usize,
}
