//! Numbers in texts.

/// Maximum number of samples per side: far beyond any memory, and small enough to avoid overflow.
pub const MAX_SIDE: u64 = 1_000_000_000;

/// Parses a number of samples along a side.
///
/// # Errors
/// If it is not one.
pub fn samples(text: &str) -> Result<usize, String> {
    match text.trim().parse::<u64>() {
        Ok(n) if (1..=MAX_SIDE).contains(&n) => Ok(n as usize),
        Ok(n) => Err(format!("a side must have 1 to {MAX_SIDE} samples, not {n}")),
        Err(_) => Err("a size must be a number of samples, such as 1024 or 1024x768".into()),
    }
}

/// Parses a finite number.
///
/// # Errors
/// If it is not one.
pub fn finite(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "the value must be a number, such as 2 or 0.5".into())
}
