//! Conditions such as `height > 3000 and slope < 5`.

use orogen_grid::analysis::patches::Bounds;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::format::features::Value;

/// A comparison of a named value with a constant.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Condition {
    /// The name of a layer, or of an attribute.
    pub name: String,
    relation: Relation,
    constant: Constant,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Relation {
    Less,
    AtMost,
    Equal,
    Unequal,
    AtLeast,
    More,
}

#[derive(Debug, Clone, PartialEq)]
enum Constant {
    Number(f64),
    Word(String),
}

/// The signs of relations; those of two characters are first.
const RELATIONS: [(&str, Relation); 7] = [
    ("<=", Relation::AtMost),
    (">=", Relation::AtLeast),
    ("!=", Relation::Unequal),
    ("==", Relation::Equal),
    ("=", Relation::Equal),
    ("<", Relation::Less),
    (">", Relation::More),
];

/// Units of constants, in metres and square metres.
const UNITS: [(&str, f64); 5] = [("km2", 1e6), ("m2", 1.0), ("ha", 1e4), ("km", 1e3), ("m", 1.0)];

/// Maximum number of conditions.
const MOST: usize = 16;

/// Reads conditions that are joined by `and` or by commas; a text of spaces has none.
///
/// # Errors
/// If the text is not a list of conditions.
pub(super) fn read(text: &str) -> Result<Vec<Condition>> {
    let parts = text.split(',').flat_map(|part| part.split(" and ")).map(str::trim);
    let conditions: Vec<Condition> = match text.trim() {
        "" => Vec::new(),
        _ => parts.map(Condition::read).collect::<Result<_>>()?,
    };
    if conditions.len() > MOST {
        return Err(refused(text, &format!("it has {} conditions, at most {MOST} are possible", conditions.len())));
    }
    Ok(conditions)
}

fn refused(text: &str, why: &str) -> Error {
    Error::new(ErrorKind::Request, format!("`{}` is not a value for --where: {why}", text.escape_debug()))
}

impl Condition {
    fn read(text: &str) -> Result<Condition> {
        let form = "a condition is a name, one of > >= < <= = !=, and a value, such as `height > 3000`";
        let at = text.find(['<', '>', '=', '!']).ok_or_else(|| refused(text, form))?;
        let (name, rest) = text.split_at(at);
        let name = name.trim();
        let found = RELATIONS.iter().find_map(|(sign, relation)| rest.strip_prefix(sign).map(|rest| (*relation, rest)));
        let (relation, constant) = found.ok_or_else(|| refused(text, form))?;
        let constant = constant.trim();
        let is_name = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
        if name.is_empty() || !name.chars().all(is_name) || constant.is_empty() {
            return Err(refused(text, form));
        }
        let constant = match number(constant) {
            Some(number) => Constant::Number(number),
            None if constant.chars().all(is_name) && !constant.starts_with(|c: char| c.is_ascii_digit()) => {
                Constant::Word(constant.to_owned())
            }
            None => return Err(refused(text, &format!("`{}` is no number and no word", constant.escape_debug()))),
        };
        if matches!(constant, Constant::Word(_)) && !matches!(relation, Relation::Equal | Relation::Unequal) {
            return Err(refused(text, "words can only be compared with = and !="));
        }
        Ok(Condition { name: name.to_owned(), relation, constant })
    }

    /// The bounds of the number; `None` if it is compared with a word.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        let Constant::Number(constant) = self.constant else { return None };
        let range = match self.relation {
            Relation::Less => [f64::NEG_INFINITY, constant.next_down()],
            Relation::AtMost => [f64::NEG_INFINITY, constant],
            Relation::Equal | Relation::Unequal => [constant, constant],
            Relation::AtLeast => [constant, f64::INFINITY],
            Relation::More => [constant.next_up(), f64::INFINITY],
        };
        Some(Bounds { range, is_within: self.relation != Relation::Unequal })
    }

    /// Whether a number satisfies the condition; NaN does not.
    fn holds(&self, value: f64) -> bool {
        self.bounds().is_some_and(|bounds| bounds.hold(value))
    }

    /// Whether an attribute satisfies the condition; one without a value does not.
    pub(super) fn holds_for(&self, value: &Value) -> bool {
        let word = match value {
            Value::Integer(number) => return self.holds(*number as f64),
            Value::Real(number) => return self.holds(*number),
            Value::Boolean(is) => {
                if *is {
                    "true"
                } else {
                    "false"
                }
            }
            Value::Text(text) => text.as_ref(),
            Value::Null => return false,
        };
        match (&self.constant, self.relation) {
            (Constant::Word(constant), Relation::Equal) => word == constant,
            (Constant::Word(constant), Relation::Unequal) => word != constant,
            _ => false,
        }
    }
}

/// A finite number with or without a unit.
fn number(text: &str) -> Option<f64> {
    let unit = UNITS.iter().find_map(|(unit, factor)| text.strip_suffix(unit).map(|digits| (digits, *factor)));
    let (digits, factor) = unit.unwrap_or((text, 1.0));
    let digits = digits.trim_end();
    // Words such as `inf` are no numbers here.
    let is_number = digits.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    digits.parse::<f64>().ok().filter(|number| is_number && number.is_finite()).map(|number| number * factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_are_read() {
        let read = |text: &str| read(text).unwrap();
        let all = read("height > 3000 and slope<=5.5, drainage-area >= 2 km2");
        let names: Vec<&str> = all.iter().map(|condition| condition.name.as_str()).collect();
        assert_eq!(names, ["height", "slope", "drainage-area"]);
        assert!(all[0].holds(3001.0) && !all[0].holds(3000.0) && !all[0].holds(f64::NAN));
        assert!(all[1].holds(5.5) && !all[1].holds(5.6));
        assert!(all[2].holds(2e6) && !all[2].holds(1.99e6));
        assert!(read("area > 3ha")[0].holds(30_001.0) && read("  ").is_empty());
        let words = read("mouth = sea and source != lake and n != 3");
        assert!(words[0].holds_for(&Value::Text("sea".into())) && !words[0].holds_for(&Value::Text("lake".into())));
        assert!(words[1].holds_for(&Value::Text("land".into())) && !words[1].holds_for(&Value::Null));
        assert!(words[2].holds_for(&Value::Integer(4)) && !words[2].holds(f64::NAN));
        assert!(read("closed = true")[0].holds_for(&Value::Boolean(true)));
    }

    #[test]
    fn other_texts_are_refused() {
        for (text, why) in [
            ("height", "a condition is a name"),
            ("> 3", "a condition is a name"),
            ("height >", "a condition is a name"),
            ("height > 3 and", "no number and no word"),
            ("height > 3, ", "a condition is a name"),
            ("height ! 3", "a condition is a name"),
            ("height > 3x", "no number and no word"),
            ("height > 1e999", "no number and no word"),
            ("height > nan", "only be compared"),
            ("mouth > sea", "only be compared"),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.contains(why) && message.contains("--where"), "{text}: {message}");
        }
        assert!(read(&"a > 1,".repeat(17)[..101]).unwrap_err().to_string().contains("17 conditions"));
    }
}
