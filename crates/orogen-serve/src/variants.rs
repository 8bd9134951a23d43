//! Variants of a world: with another seed and other numbers, as sliders of a page choose them.
//!
//! A variant is opened when it is requested, within the limits of all requests. Nothing of a recipe can be changed but
//! its seed and its [numbers](orogen::recipe::values).

use std::sync::Arc;

use axum::http::StatusCode;

use crate::query::{Query, SEED, SET};
use crate::refusal::Refusal;
use crate::served::Served;

/// Maximum number of numbers that differ.
const MAX_VALUES: usize = 64;

/// What differs in a variant.
#[derive(Debug, PartialEq)]
pub struct Change {
    seed: Option<u64>,
    values: Vec<(String, f64)>,
}

impl Change {
    /// Reads the parameters `seed` and `set`; `None` if there is neither.
    ///
    /// # Errors
    /// If one is not valid.
    pub fn of(query: &Query) -> Result<Option<Change>, Refusal> {
        let seed = query.get(SEED).map(|text| {
            let seed = text.trim().parse::<u64>().ok().filter(|seed| i64::try_from(*seed).is_ok());
            seed.ok_or_else(|| {
                Refusal::bad(format!("`seed` must be a whole number from 0 to 9223372036854775807, not `{text}`"))
            })
        });
        let mut values: Vec<(String, f64)> = Vec::new();
        for (_, text) in query.pairs().filter(|(name, text)| *name == SET && !text.is_empty()) {
            let (name, value) = one(text)?;
            if values.iter().any(|(other, _)| *other == name) {
                return Err(Refusal::bad(format!("`{name}` is set twice; set it once")));
            }
            values.push((name, value));
        }
        if values.len() > MAX_VALUES {
            return Err(Refusal::bad(format!("at most {MAX_VALUES} numbers can be set, not {}", values.len())));
        }
        values.sort_by(|a, b| a.0.cmp(&b.0));
        let change = Change { seed: seed.transpose()?, values };
        Ok((change.seed.is_some() || !change.values.is_empty()).then_some(change))
    }
}

/// Reads `NAME=VALUE`.
fn one(text: &str) -> Result<(String, f64), Refusal> {
    let wrong = || {
        Refusal::bad(format!(
            "`set` must be a name and a number, such as set=relief=1500 or set=noise.wavelength=900, not `{text}`; /recipe.json lists the names"
        ))
    };
    let (name, value) = text.split_once('=').ok_or_else(wrong)?;
    let value: f64 = value.trim().parse().map_err(|_| wrong())?;
    if value.is_finite() { Ok((name.trim().to_string(), value)) } else { Err(wrong()) }
}

impl Served {
    /// A variant of this world.
    ///
    /// # Errors
    /// If there is no such parameter, or a value is not valid.
    pub fn variant(&self, change: &Change) -> Result<Arc<Served>, Refusal> {
        // Numbers in their shortest form are different for different bits.
        let key = format!("{change:?}");
        if let Some(found) = self.variants.find(&key) {
            return Ok(found);
        }
        let wrong = |error: orogen::Error| match Refusal::of(&error) {
            // Values that contradict each other are found when the recipe is opened.
            refusal if refusal.status == StatusCode::INTERNAL_SERVER_ERROR => Refusal::bad(refusal.message),
            refusal => refusal,
        };
        let recipe = self.recipe().with_values(change.seed, &change.values).map_err(wrong)?;
        Ok(self.variants.keep(&key, self.changed(recipe).map_err(wrong)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn change(text: &str) -> Result<Option<Change>, Refusal> {
        Change::of(&Query::parse(text).unwrap())
    }

    #[test]
    fn changes_are_read_in_any_order() {
        assert_eq!(change("x=1&seed=&set=").unwrap(), None);
        let expect = Change { seed: Some(7), values: vec![("a".into(), -2.5), ("b.c".into(), 1e3)] };
        assert_eq!(change("set=b.c=1e3&seed=7&set=a%3D-2.5").unwrap().unwrap(), expect);
        for (text, expect) in [
            ("seed=-1", "`seed` must be"),
            ("seed=9223372036854775808", "`seed` must be"),
            ("set=a", "a name and a number"),
            ("set=a=", "a name and a number"),
            ("set=a=nan", "a name and a number"),
            ("set=a=1e999", "a name and a number"),
            ("set=a=1&set=a=2", "set twice"),
        ] {
            assert!(change(text).unwrap_err().message.contains(expect), "{text}");
        }
        let many: String = (0..65).map(|k| format!("set=a{k}=1&")).collect();
        assert!(change(&many).unwrap_err().message.contains("at most 64"));
    }
}
