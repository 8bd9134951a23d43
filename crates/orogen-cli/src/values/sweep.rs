//! `--sweep NAME=A..B:N` or `NAME=A,B,...`: values of a parameter.

use std::str::FromStr;

use super::number::finite;

/// Values of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// The name of the parameter.
    pub name: String,
    /// The values, in order.
    pub values: Vec<f64>,
    /// The values as given.
    pub text: String,
}

impl FromStr for Sweep {
    type Err = String;

    fn from_str(text: &str) -> Result<Sweep, String> {
        let parts = || {
            let (name, rest) = text.split_once('=')?;
            let number = |text: &str| finite(text).ok();
            let values = match rest.split_once("..") {
                Some((first, rest)) => {
                    let (last, count) = rest.rsplit_once(':')?;
                    spaced([number(first)?, number(last)?], count.trim().parse::<u8>().ok()?)
                }
                None => rest.split(',').map(number).collect::<Option<Vec<f64>>>()?,
            };
            Some(Sweep { name: name.trim().to_string(), values, text: rest.replace(char::is_whitespace, "") })
        };
        match parts() {
            Some(sweep) if !sweep.name.is_empty() && (2..=64).contains(&sweep.values.len()) => Ok(sweep),
            _ => Err("a sweep must be a parameter with its first and last value and a number of values from 2 to 64, such as \
                      relief=200..2000:9, or with 2 to 64 values, such as relief=200,500,2000"
                .into()),
        }
    }
}

/// Evenly spaced values, including both ends.
fn spaced([first, last]: [f64; 2], count: u8) -> Vec<f64> {
    let steps = f64::from(count.max(2) - 1);
    // The last value is exactly the given one, without summation errors.
    (0..count).map(|k| if k + 1 == count { last } else { first + (last - first) * f64::from(k) / steps }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweeps() {
        let sweep: Sweep = "relief=200..2000:3".parse().unwrap();
        assert_eq!(sweep.values, [200.0, 1100.0, 2000.0]);
        let sweep: Sweep = "a = 1 .. -0.7 : 2".parse().unwrap();
        assert_eq!((sweep.name.as_str(), &sweep.values[..]), ("a", &[1.0, -0.7][..]));
        let sweep: Sweep = "k=0.5, 1,-4e1".parse().unwrap();
        assert_eq!((&sweep.values[..], sweep.text.as_str()), (&[0.5, 1.0, -40.0][..], "0.5,1,-4e1"));
        for text in [
            "relief",
            "relief=1",
            "relief=1..2",
            "relief=1..2:1",
            "relief=1..2:65",
            "relief=1..x:3",
            "=1..2:3",
            "a=1..inf:3",
            "a=1,",
            "a=1,nan",
            "a=1,2..3",
        ] {
            assert!(text.parse::<Sweep>().is_err(), "{text}");
        }
    }
}
