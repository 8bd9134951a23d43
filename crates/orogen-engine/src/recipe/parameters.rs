//! Parameters of a recipe, and formulas of them in place of numbers.
//!
//! A string that begins with `=` is a formula. Formulas are evaluated before anything else is read, so all later code
//! sees plain numbers. Their positions are recorded, so that a recipe keeps them when it is written.

use super::text::Text;
use orogen_grid::words::{number, respelled, suggestion};
use orogen_ops::declare::Spec;
use orogen_ops::expression::error::ExpressionError;
use orogen_ops::expression::formula::{self, formula, is_parameter_name};
use orogen_ops::value::{Span, Spanned, Value, toml_key, toml_string};
use std::collections::HashSet;
use std::fmt::Write as _;

/// Maximum number of parameters of a recipe.
pub const MAX_PARAMETERS: usize = 256;

/// Maximum number of formulas of a recipe.
const MAX_FORMULAS: usize = 65_536;

/// The keys of a parameter, for diagnostics.
const KEYS: [&str; 4] = ["default", "unit", "range", "help"];

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
    /// The value: the default, unless the recipe was read with another.
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

    fn write_toml(&self, text: &mut String) {
        let _ = writeln!(text, "\n[parameters.{}]\ndefault = {:?}", toml_key(&self.name), self.value);
        if !self.unit.is_empty() {
            let _ = writeln!(text, "unit = {}", toml_string(&self.unit));
        }
        if self.range != [f64::NEG_INFINITY, f64::INFINITY] {
            let bound = |bound: f64| Value::Number(bound).to_toml();
            let _ = writeln!(text, "range = [{}, {}]", bound(self.range[0]), bound(self.range[1]));
        }
        if !self.help.is_empty() {
            let _ = writeln!(text, "help = {}", toml_string(&self.help));
        }
    }
}

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
        self.list.iter().for_each(|parameter| parameter.write_toml(text));
    }

    /// Puts formulas back into the text of a recipe, where the number there is still the one that the formula makes.
    /// `spec` says what is declared of an op.
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

/// Problems with their positions in the text.
type Diagnostics = Vec<(Span, String)>;

/// The result of resolving the formulas of a recipe.
#[derive(Default)]
pub struct Resolved {
    /// Parameters and formulas.
    pub parameters: Parameters,
    /// The problems.
    pub diagnostics: Diagnostics,
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
        read(value, &mut resolved.parameters.list, &mut resolved.diagnostics);
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
            .filter(|(key, _)| !matches!(key.value.as_str(), "parameters" | "about" | "orogen" | "$schema"))
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
fn read(value: &Spanned<Value>, parameters: &mut Vec<Parameter>, diagnostics: &mut Diagnostics) {
    let Value::Table(entries) = &value.value else {
        diagnostics.push((
            value.span.clone(),
            format!("`parameters` must be a table of parameters, not {}", value.value.describe()),
        ));
        return;
    };
    if let Some((key, _)) = entries.get(MAX_PARAMETERS) {
        diagnostics.push((key.span.clone(), format!("the recipe has more than {MAX_PARAMETERS} parameters")));
        return;
    }
    let mut seen = HashSet::new();
    for (name, value) in entries {
        if !seen.insert(name.value.as_str()) {
            diagnostics
                .push((name.span.clone(), format!("there are two parameters named `{}`: rename one", name.value)));
        } else if !is_parameter_name(&name.value) {
            let message = format!(
                "`{}` cannot be a parameter's name: names are 1 to 64 letters, digits and `_`, do not begin with a digit, and are not the name of a function or constant",
                name.value
            );
            diagnostics.push((name.span.clone(), message));
        } else if let Some(parameter) = one(name, value, diagnostics) {
            parameters.push(parameter);
        }
    }
}

/// Reads one parameter: a number, or a table with its default and other keys.
fn one(name: &Spanned<String>, value: &Spanned<Value>, diagnostics: &mut Diagnostics) -> Option<Parameter> {
    let range = [f64::NEG_INFINITY, f64::INFINITY];
    let mut parameter =
        Parameter { name: name.value.clone(), help: String::new(), unit: String::new(), range, value: 0.0 };
    let before = diagnostics.len();
    let mut default = None;
    match &value.value {
        Value::Table(entries) => {
            let mut seen = HashSet::new();
            for (key, value) in entries {
                if !seen.insert(key.value.as_str()) {
                    diagnostics
                        .push((key.span.clone(), format!("the key `{}` appears twice in this table", key.value)));
                }
                match (key.value.as_str(), &value.value) {
                    ("default", _) => default = Some(value),
                    ("unit", Value::Text(unit)) => parameter.unit = unit.clone(),
                    ("help", Value::Text(help)) => parameter.help = help.clone(),
                    ("range", Value::List(ends)) if bounds(ends).is_some() => {
                        parameter.range = bounds(ends).unwrap_or(range)
                    }
                    ("unit" | "help", other) => {
                        let message = format!("`{}` must be a string, not {}", key.value, other.describe());
                        diagnostics.push((value.span.clone(), message));
                    }
                    ("range", other) => {
                        let message = format!(
                            "`range` must be two numbers, the lower one first, such as [0, 100], not {}",
                            other.describe()
                        );
                        diagnostics.push((value.span.clone(), message));
                    }
                    (unknown, _) => {
                        let hint = suggestion(unknown, KEYS);
                        diagnostics.push((
                            key.span.clone(),
                            format!("unknown key `{unknown}` in the parameter `{}`; {hint}", name.value),
                        ));
                    }
                }
            }
            if default.is_none() {
                diagnostics.push((name.span.clone(), format!("the parameter `{}` has no `default`", name.value)));
            }
        }
        _ => default = Some(value),
    }
    let default = default?;
    let fault = match default.value.number() {
        Some(number) => {
            parameter.value = number;
            parameter.check(number).err()
        }
        None => Some(format!(
            "the default of `{}` must be {}, not {}",
            name.value,
            parameter.expected(),
            default.value.describe()
        )),
    };
    // If the range could not be read, the default is not checked.
    if diagnostics.len() == before {
        diagnostics.extend(fault.map(|message| (default.span.clone(), message)));
    }
    (diagnostics.len() == before).then_some(parameter)
}

/// Two numbers, the lower one first; both may be infinite.
fn bounds(ends: &[Spanned<Value>]) -> Option<[f64; 2]> {
    match ends {
        [low, high] => {
            let (low, high) = (low.value.number()?, high.value.number()?);
            (low <= high).then_some([low, high])
        }
        _ => None,
    }
}
