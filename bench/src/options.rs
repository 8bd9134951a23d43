//! Options of a measurement.

/// The options of the command line.
pub struct Options {
    /// Only cases whose name contains this.
    pub case: String,
    /// Number of timings per job.
    pub repetitions: usize,
}
