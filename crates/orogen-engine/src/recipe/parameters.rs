//! Parameters of a recipe, and formulas of them in place of numbers.
//!
//! A string that begins with `=` is a formula. Formulas are evaluated before anything else is read, so all later code
//! sees plain numbers. Their positions are recorded, so that a recipe keeps them when it is written.

use super::table::key::Key;
use super::table::keys::Keys;
use super::table::reader::{Table, ValueReader};
use super::text::Text;
use orogen_grid::words::{number, respelled, suggestion};
use orogen_ops::declare::Spec;
use orogen_ops::expression::error::ExpressionError;
use orogen_ops::expression::formula::{self, formula, is_parameter_name};
use orogen_ops::value::{Span, Spanned, Value, toml_key, toml_string};
use std::collections::HashSet;

/// Maximum number of parameters of a recipe.
pub const MAX_PARAMETERS: usize = 256;

/// Maximum number of formulas of a recipe.
const MAX_FORMULAS: usize = 65_536;

/// A parameter of a recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// The name in formulas.
    pub name: String,
    /// The description; may be empty.
    pub help: String,
    /// The unit, or empty.
    pub unit: String,
    /// The minimum and maximum value; infinite if there is no bound.
    pub range: [f64; 2],
    /// The value: the default, unless the recipe was read with another value.
    pub value: f64,
}

impl Parameter {
    /// Checks a value; the error describes the valid values.
    pub fn check(&self, value: f64) -> Result<(), String> {
        match value.is_finite() && (self.range[0]..=self.range[1]).contains(&value) {
            true => Ok(()),
            false => Err(format!("`{}` must be {}, not {value}", self.name, self.expected())),
        }
    }

    /// The valid values: "a number from 0 to 100 (m)".
    #[must_use]
    pub fn expected(&self) -> String {
        let range = match self.range {
            [low, high] if low.is_finite() && high.is_finite() => format!(" from {} to {}", number(low), number(high)),
            [low, _] if low.is_finite() => format!(" of at least {}", number(low)),
            [_, high] if high.is_finite() => format!(" of at most {}", number(high)),
            _ => String::new(),
        };
        let unit = if self.unit.is_empty() { String::new() } else { format!(" ({})", self.unit) };
        format!("a finite number{range}{unit}")
    }
}

/// The keys of a parameter.
pub static KEYS: Keys<Parameter> = Keys {
    needs: &[("default", "`default`")],
    parts: &[
        key!(Parameter, "default", "The default value.", |parameter| Some(&mut parameter.value)),
        key!(Parameter.unit, "Its unit.", text true),
        key!(
            Parameter.range,
            "The lowest and the highest value it may have.",
            range [f64::NEG_INFINITY, f64::INFINITY], pair "[LOWEST, HIGHEST]", ascending true
        ),
        key!(Parameter.help, "What it does.", text true),
    ],
};

/// A step of a path in a tree of values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// To a key's value.
    Key(String),
    /// To an item.
    Item(usize),
}

/// A formula and its position in the recipe.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Formula {
    /// The path from the root.
    pub path: Vec<Step>,
    /// The expression, without the `=`.
    pub text: String,
}

/// Parameters and formulas of a recipe.
#[derive(Debug, Clone, Default)]
pub struct Parameters {
    /// The parameters in the order of the text.
    pub list: Vec<Parameter>,
    /// The formulas.
    pub formulas: Vec<Formula>,
}

impl Parameters {
    /// The value of a parameter.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<f64> {
        self.list.iter().find(|parameter| parameter.name == name).map(|parameter| parameter.value)
    }

    /// The value of a formula.
    pub fn evaluate(&self, text: &str) -> Result<f64, ExpressionError> {
        let names = self.list.iter().map(|parameter| parameter.name.as_str());
        formula::value(
            text,
            |name| self.value(name),
            |name| format!("there is no parameter `{name}`; {}", suggestion(name, names.clone())),
        )
    }

    /// The keys of nodes that are bound to the parameter of the same name.
    #[must_use]
    pub fn bound(&self) -> HashSet<(&str, &str)> {
        let keys = self.formulas.iter().filter_map(|formula| match formula.path.as_slice() {
            [Step::Key(nodes), Step::Key(node), Step::Key(key)] if nodes == "nodes" && formula.text.trim() == key => {
                Some((node.as_str(), key.as_str()))
            }
            _ => None,
        });
        keys.collect()
    }

    /// Sets values.
    ///
    /// # Errors
    /// If there is no such parameter, or a value is out of range.
    pub fn set(&mut self, values: &[(String, f64)]) -> Result<(), String> {
        for (name, value) in values {
            let names: Vec<String> = self.list.iter().map(|parameter| parameter.name.clone()).collect();
            let Some(parameter) = self.list.iter_mut().find(|parameter| parameter.name == *name) else {
                return Err(match names.as_slice() {
                    [] => format!("there is no parameter `{name}`: this recipe has none"),
                    _ => format!(
                        "there is no parameter `{name}`; {}",
                        suggestion(name, names.iter().map(String::as_str))
                    ),
                });
            };
            parameter.check(*value)?;
            parameter.value = *value;
        }
        Ok(())
    }

    /// Writes the parameters as TOML tables.
    pub fn write_toml(&self, text: &mut String) {
        for parameter in &self.list {
            KEYS.write(&format!("[parameters.{}]", toml_key(&parameter.name)), parameter, text);
        }
    }

    /// Puts formulas back into the text of a recipe, where the number is still the formula's value. `spec` returns the
    /// declaration of an op.
    pub fn restore(&self, text: String, spec: impl Fn(&str) -> Option<&'static Spec>) -> String {
        if self.formulas.is_empty() {
            return text;
        }
        let Ok(tree) = super::toml::read(&Text { name: "", text: &text }) else { return text };
        let mut changes: Vec<(Span, String)> = Vec::new();
        for formula in &self.formulas {
            let Ok(value) = self.evaluate(&formula.text) else { continue };
            let written = toml_string(&format!("={}", formula.text));
            let Some(found) = formula.path.iter().try_fold(&tree, |at, step| follow(at, step, &spec)) else { continue };
            let spans: Vec<&Spanned<Value>> = match &found.value {
                // One number for both values of a pair.
                Value::List(items) => items.iter().collect(),
                _ => vec![found],
            };
            if spans.iter().all(|number| number.value.number() == Some(value)) {
                changes.extend(spans.iter().map(|number| (number.span.clone(), written.clone())));
            }
        }
        changes.sort_by_key(|(span, _)| span.start);
        changes.dedup_by_key(|(span, _)| span.start);
        let (mut out, mut at) = (String::with_capacity(text.len()), 0);
        for (span, written) in changes {
            out.push_str(&text[at..span.start]);
            out.push_str(&written);
            at = span.end;
        }
        out.push_str(&text[at..]);
        out
    }
}

fn follow<'t>(
    at: &'t Spanned<Value>,
    step: &Step,
    spec: impl Fn(&str) -> Option<&'static Spec>,
) -> Option<&'t Spanned<Value>> {
    match (&at.value, step) {
        (Value::Table(entries), Step::Key(key)) => {
            let find = |name: &str| entries.iter().find(|(key, _)| key.value == name).map(|(_, value)| value);
            let op = || match find("op").map(|op| &op.value) {
                Some(Value::Text(op)) => spec(op),
                _ => None,
            };
            let current = || op()?.aliases().find(|(alias, _)| alias == key).map(|(_, name)| name);
            find(key).or_else(|| find(&respelled(key)?)).or_else(|| find(current()?))
        }
        (Value::List(items), Step::Item(item)) => items.get(*item),
        _ => None,
    }
}

/// The result of resolving the formulas of a recipe.
#[derive(Default)]
pub struct Resolved {
    /// Parameters and formulas.
    pub parameters: Parameters,
    /// The problems.
    pub diagnostics: Vec<(Span, String)>,
    /// Formulas without a value, which need no further diagnostics.
    pub failed: Vec<Span>,
}

/// Reads the parameters of a recipe, applies the values in `set`, and replaces all formulas by numbers.
///
/// # Errors
/// If a value in `set` is not valid.
pub fn resolve(tree: &mut Spanned<Value>, text: &Text, set: &[(String, f64)]) -> Result<Resolved, String> {
    let mut resolved = Resolved::default();
    let Value::Table(top) = &mut tree.value else { return Ok(resolved) };
    if let Some((_, value)) = top.iter().find(|(key, _)| key.value == "parameters") {
        let mut values = ValueReader::new(true);
        resolved.parameters.list = read(value, &mut values);
        resolved.diagnostics = values.diagnostics;
    }
    // If parameters could not be read, errors in formulas would only repeat that.
    let silent = !resolved.diagnostics.is_empty();
    if !silent {
        resolved.parameters.set(set)?;
    }
    {
        let mut resolver = Resolver { text, resolved: &mut resolved, silent, path: Vec::new() };
        for (key, value) in top
            .iter_mut()
            .filter(|(key, _)| !matches!(key.value.as_str(), "parameters" | "about" | "orogen" | "studio" | "$schema"))
        {
            resolver.under(Step::Key(key.value.clone()), value);
        }
    }
    Ok(resolved)
}

struct Resolver<'a> {
    text: &'a Text<'a>,
    resolved: &'a mut Resolved,
    silent: bool,
    path: Vec<Step>,
}

impl Resolver<'_> {
    fn under(&mut self, step: Step, value: &mut Spanned<Value>) {
        self.path.push(step);
        self.value(value);
        self.path.pop();
    }

    /// Recursion is bounded by the parsers, which reject deep nesting.
    fn value(&mut self, value: &mut Spanned<Value>) {
        match &mut value.value {
            Value::Table(entries) => {
                // The expression of the op `expr` applies to samples; it is not a formula.
                let is_expression =
                    entries.iter().any(|(key, value)| key.value == "op" && value.value == Value::Text("expr".into()));
                for (key, value) in entries.iter_mut().filter(|(key, _)| !(is_expression && key.value == "expr")) {
                    self.under(Step::Key(key.value.clone()), value);
                }
            }
            Value::List(items) => {
                items.iter_mut().enumerate().for_each(|(item, value)| self.under(Step::Item(item), value));
            }
            Value::Text(text) => {
                let Some(text) = formula(text).map(str::to_string) else { return };
                let Resolved { parameters, diagnostics, failed } = &mut *self.resolved;
                let (span, message) = match parameters.evaluate(&text) {
                    Ok(number) if parameters.formulas.len() < MAX_FORMULAS => {
                        value.value = plain(number);
                        return parameters.formulas.push(Formula { path: self.path.clone(), text });
                    }
                    Ok(_) => (value.span.clone(), format!("the recipe has more than {MAX_FORMULAS} formulas")),
                    Err(fault) => (self.text.within(&value.span, &text, &fault.span), fault.message),
                };
                failed.push(value.span.clone());
                if !self.silent {
                    diagnostics.push((span, message));
                }
            }
            _ => {}
        }
    }
}

/// A number as recipes write it: integers without a fraction, because some keys accept only integers.
fn plain(number: f64) -> Value {
    const EXACT: f64 = (1u64 << 53) as f64;
    match number.fract() == 0.0 && number.abs() <= EXACT {
        true => Value::Integer(number as i64),
        false => Value::Number(number),
    }
}

/// Reads `[parameters]`.
fn read(value: &Spanned<Value>, values: &mut ValueReader) -> Vec<Parameter> {
    let Value::Table(entries) = &value.value else {
        let found = value.value.describe();
        values.diagnostic(&value.span, format!("`parameters` must be a table of parameters, not {found}"));
        return Vec::new();
    };
    if let Some((key, _)) = entries.get(MAX_PARAMETERS) {
        values.diagnostic(&key.span, format!("the recipe has more than {MAX_PARAMETERS} parameters"));
        return Vec::new();
    }
    let mut parameters: Vec<Parameter> = Vec::new();
    for (name, value) in entries {
        let problem = if parameters.iter().any(|other| other.name == name.value) {
            format!("there are two parameters named `{}`: rename one", name.value)
        } else if !is_parameter_name(&name.value) {
            format!(
                "`{}` cannot be a parameter's name: names are 1 to 64 letters, digits and `_`, do not begin with a digit, and are not the name of a function or constant",
                name.value
            )
        } else {
            parameters.push(one(name, value, values));
            continue;
        };
        values.diagnostic(&name.span, problem);
    }
    parameters
}

/// Reads one parameter: a number, or a table of its keys.
fn one(name: &Spanned<String>, value: &Spanned<Value>, values: &mut ValueReader) -> Parameter {
    let range = [f64::NEG_INFINITY, f64::INFINITY];
    let mut parameter =
        Parameter { name: name.value.clone(), help: String::new(), unit: String::new(), range, value: 0.0 };
    let before = values.diagnostics.len();
    let mut place = value.span.clone();
    match &value.value {
        Value::Table(_) => {
            let what = format!("the parameter `{}`", name.value);
            let Some(entries) = values.table(&what, value) else { return parameter };
            let table = Table { name: &what, span: &name.span, entries };
            parameter = KEYS.read(&table, values, parameter);
            place = table.find("default").map_or(place, |(_, default)| default.span.clone());
        }
        _ => parameter.value = values.number(&Key::new(&name.value, ""), value).unwrap_or(0.0),
    }
    // If the range could not be read, the default is not checked.
    if values.diagnostics.len() == before
        && let Err(message) = parameter.check(parameter.value)
    {
        values.diagnostic(&place, message);
    }
    parameter
}
