//! Options of derived layers that are the parameters of an op.

use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::declare::{ParamSpec, Shape};
use orogen_engine::op::OpType;
use orogen_engine::value::Value;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::number;

/// Options for all numbers among an op's parameters, with the names, ranges, defaults and documentation that the op
/// declares. Call it only once per op, because the texts are leaked.
pub fn options<T: OpType>() -> Vec<OptionSpec> {
    let op = T::default();
    let params = op.spec().params.iter().enumerate().filter(|(_, param)| matches!(param.shape, Shape::Number));
    params.map(|(i, param)| option(param, &op.param(i))).collect()
}

fn option(param: &'static ParamSpec, default: &Value) -> OptionSpec {
    let unit = if param.unit.is_empty() { String::new() } else { format!(", in {}", param.unit) };
    let text = param.doc.trim().trim_end_matches('.').replace('\n', " ");
    let default = default.number().map_or(String::new(), number);
    let placeholder = match param.unit {
        "" => "N".into(),
        "degrees" => "DEG".into(),
        unit => unit.to_uppercase(),
    };
    OptionSpec::new(name(param).leak(), placeholder.leak(), ValueKind::Number(param.range[0], param.range[1]))
        .with_about(format!("{text}{unit} [default: {default}]").leak())
}

/// The name of a parameter's option.
fn name(param: &ParamSpec) -> String {
    param.name.replace('_', "-")
}

/// An op with the given options, and its defaults for the others.
///
/// # Errors
/// If an option is not a valid value of its parameter.
pub fn given<T: OpType>(options: &Options) -> Result<T> {
    let mut op = T::default();
    for (i, param) in op.spec().params.iter().enumerate() {
        if let Some(value) = options.number(&name(param)) {
            op.set_param(i, &Value::Number(value)).map_err(|why| Error::new(ErrorKind::Request, why))?;
        }
    }
    Ok(op)
}
