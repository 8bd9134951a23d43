//! `--sweep NAME=A..B:N`: values of a parameter.

use std::str::FromStr;

use super::number::finite;

/// Values of a parameter, evenly spaced.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// The name of the parameter.
    pub name: String,
    /// The first and the last value.
    pub ends: [f64; 2],
    /// The number of values.
    pub count: u8,
}

impl FromStr for Sweep {
    type Err = String;

    fn from_str(text: &str) -> Result<Sweep, String> {
        let parts = || {
            let (name, rest) = text.split_once('=')?;
            let (range, count) = rest.rsplit_once(':')?;
            let (first, last) = range.split_once("..")?;
            let number = |text: &str| finite(text).ok();
            Some((name.trim().to_string(), [number(first)?, number(last)?], count.trim().parse::<u8>().ok()?))
        };
        match parts() {
            Some((name, ends, count)) if !name.is_empty() && (2..=64).contains(&count) => Ok(Sweep { name, ends, count }),
            _ => Err("a sweep must be a parameter with its first and last value and a number of values from 2 to 64, such as relief=200..2000:9".into()),
        }
    }
}

impl Sweep {
    /// The values, in order.
    pub fn values(&self) -> impl Iterator<Item = f64> + '_ {
        let [first, last] = self.ends;
        let steps = f64::from(self.count - 1);
        // The last value is exactly the given one, without summation errors.
        (0..self.count)
            .map(move |k| if k + 1 == self.count { last } else { first + (last - first) * f64::from(k) / steps })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweeps() {
        let sweep: Sweep = "relief=200..2000:3".parse().unwrap();
        assert_eq!(sweep.values().collect::<Vec<f64>>(), [200.0, 1100.0, 2000.0]);
        let sweep: Sweep = "a = 1 .. -0.7 : 2".parse().unwrap();
        assert_eq!((sweep.name.as_str(), sweep.values().last()), ("a", Some(-0.7)));
        for text in [
            "relief",
            "relief=1",
            "relief=1..2",
            "relief=1..2:1",
            "relief=1..2:65",
            "relief=1..x:3",
            "=1..2:3",
            "a=1..inf:3",
        ] {
            assert!(text.parse::<Sweep>().is_err(), "{text}");
        }
    }
}
