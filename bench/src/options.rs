//! Options of a measurement.

/// The options of the command line.
pub struct Options {
    /// Only cases whose name contains this.
    pub case: String,
    /// Number of timings per job.
    pub repetitions: usize,
}

/// The number that an option has.
pub fn number<T: std::str::FromStr>(option: &str, text: &str) -> Result<T, String> {
    text.trim().parse().map_err(|_| format!("{option}: '{text}' is not a valid number"))
}

/// The arguments of a line, for tests.
#[cfg(test)]
pub fn words(line: &str) -> Vec<String> {
    line.split_whitespace().map(str::to_owned).collect()
}
