//! Reading lists of tables, which are parameters such as strokes and strata.

use super::spec::{ParamSpec, TableSpec};
use crate::value::{Span, Spanned, Value};
use orogen_grid::words::{list, suggestion};

/// A problem within a value: its position and a message.
pub(super) type Problem = (Span, String);

/// A number in its shortest form for recipes: 200 instead of 200.0.
pub(super) fn shortest(number: f64) -> Value {
    let is_whole = number.abs() < 1e15 && number == (number as i64) as f64;
    if is_whole { Value::Integer(number as i64) } else { Value::Number(number) }
}

/// Reads a list of tables. `form` shows a table in messages, and `advice` says what to do if there are too many.
pub(super) fn items<'a>(
    spec: &TableSpec,
    [form, advice]: [&str; 2],
    name: &str,
    value: &'a Value,
) -> Result<&'a [Spanned<Value>], Problem> {
    let [_, plural] = spec.names;
    let Value::List(items) = value else {
        return Err((0..0, format!("`{name}` must be a list of {plural} [{form}, ...], not {}", value.describe())));
    };
    if items.len() > spec.max {
        return Err((0..0, format!("`{name}`: it has more than {} {plural}; {advice}", spec.max)));
    }
    Ok(items)
}

/// Reads the table of this number: `set` receives each key by its index.
pub(super) fn table(
    spec: &TableSpec,
    form: &str,
    name: &str,
    number: usize,
    item: &Spanned<Value>,
    mut set: impl FnMut(usize, &ParamSpec, &Spanned<Value>) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let singular = spec.names[0];
    let wrong = |span: &Span, what: String| Err((span.clone(), format!("`{name}`: {what}")));
    let Value::Table(entries) = &item.value else {
        let found = item.value.describe();
        return wrong(&item.span, format!("{singular} {number} is {found}; write it as {form}"));
    };
    let mut given = vec![false; spec.keys.len()];
    for (key, value) in entries {
        let known = spec.keys.iter().zip(&mut given).enumerate().find(|(_, (spec, _))| spec.name == key.value);
        let Some((k, (key_spec, is_given))) = known else {
            let hint = suggestion(&key.value, spec.keys.iter().map(|spec| spec.name));
            return wrong(&key.span, format!("unknown key `{}` in {singular} {number}; {hint}", key.value));
        };
        if std::mem::replace(is_given, true) {
            return wrong(&key.span, format!("{singular} {number} has `{}` twice", key.value));
        }
        set(k, key_spec, value)?;
    }
    let missing = spec.keys.iter().zip(given).take(spec.required).filter(|(_, is_given)| !is_given);
    let missing: Vec<&str> = missing.map(|(spec, _)| spec.name).collect();
    if !missing.is_empty() {
        return wrong(&item.span, format!("{singular} {number} has no {}", list(missing)));
    }
    Ok(())
}

/// The problem of a key whose value was refused with this message.
pub(super) fn refused(spec: &TableSpec, name: &str, number: usize, value: &Spanned<Value>, message: &str) -> Problem {
    (value.span.clone(), format!("`{name}`: in {} {number} {message}", spec.names[0]))
}
