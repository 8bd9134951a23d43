//! `--set NAME=VALUE`: values for a recipe's parameters.

use std::str::FromStr;

use clap::Args;

/// Values for parameters.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "World and window")]
pub struct Arguments {
    /// Value of a parameter of the recipe, instead of its default; can be given several times. `orogen explain RECIPE`
    /// lists the parameters
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    set: Vec<Assignment>,
}

impl Arguments {
    /// Names and values for the library.
    pub fn values(&self) -> Vec<(String, f64)> {
        self.set.iter().map(|Assignment(name, value)| (name.clone(), *value)).collect()
    }

    /// The same values with one more.
    pub fn with(&self, more: Option<(String, f64)>) -> Arguments {
        let more = more.map(|(name, value)| Assignment(name, value));
        Arguments { set: self.set.iter().cloned().chain(more).collect() }
    }
}

/// A name and its value.
#[derive(Debug, Clone, PartialEq)]
struct Assignment(String, f64);

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Assignment, String> {
        let Some((name, value)) = text.split_once('=') else {
            return Err("a parameter must be set as a name and a number, such as relief=1500".into());
        };
        let (name, value) = (name.trim(), value.trim());
        match value.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Assignment(name.to_string(), number)),
            _ => Err(format!("the value of `{name}` must be a number, such as {name}=1500")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers() {
        for (text, expect) in [
            ("relief=1500", Ok(("relief", 1500.0))),
            ("a = -2.5e3", Ok(("a", -2500.0))),
            ("relief", Err("as a name and a number")),
            ("relief=", Err("must be a number")),
            ("relief=high", Err("must be a number")),
            ("relief=nan", Err("must be a number")),
            ("relief=inf", Err("must be a number")),
        ] {
            match (text.parse::<Assignment>(), expect) {
                (Ok(Assignment(name, value)), Ok(expect)) => assert_eq!((name.as_str(), value), expect, "{text}"),
                (Err(why), Err(expect)) => assert!(why.contains(expect), "{text}: {why}"),
                (found, _) => panic!("{text}: {found:?}"),
            }
        }
    }
}
