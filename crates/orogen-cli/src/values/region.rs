//! Positions on maps.

use super::number::finite;

/// `--origin`: east and north of the world's north-west corner.
pub fn place(text: &str) -> Result<[f64; 2], String> {
    let parts: Option<Vec<f64>> = text.split(',').map(|part| finite(part).ok()).collect();
    match parts.as_deref() {
        Some(&[east, north]) => Ok([east, north]),
        _ => Err("a position must be EAST,NORTH, such as 600000,5200000".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places() {
        assert_eq!(place("1.5,-2"), Ok([1.5, -2.0]));
        assert!(place("1").is_err() && place("a,b").is_err());
    }
}
