//! Values of parameters, drawn from the whole declared range.

use crate::support::Random;
use orogen::declare::{ParamSpec, Shape, TableSpec};
use orogen::expression::function::Function;
use orogen::value::{Spanned, Value};

/// Replaces a bound that is not declared.
const UNBOUNDED: f64 = 1e9;

/// A value of the declared kind and range. Half of the lengths and areas are of the order of `cell`, because most
/// others have no visible effect in a small window. `file` is used for file names.
pub fn value(spec: &ParamSpec, cell: f64, file: &str, random: &mut Random) -> Value {
    let number = |random: &mut Random| number(spec, cell, random);
    match spec.shape {
        Shape::Number => Value::Number(number(random)),
        Shape::Integer => Value::Integer(number(random).round() as i64),
        Shape::Seed => Value::Integer([0, 1, i64::MAX, random.below(1 << 63) as i64][random.below(4) as usize]),
        Shape::Flag => Value::Flag(random.below(2) == 0),
        Shape::Choice(choices) => {
            let names = choices();
            Value::Text(names[random.below(names.len() as u64) as usize].0.to_string())
        }
        Shape::Pair => {
            let mut pair = [number(random), number(random)];
            // Often the ends of a range.
            if random.below(2) == 0 {
                pair.sort_by(f64::total_cmp);
            }
            list(pair.map(Value::Number))
        }
        Shape::Expression => Value::Text(expression(3, random)),
        Shape::Curve => {
            let mut xs: Vec<f64> = (0..2 + random.below(5)).map(|_| number(random)).collect();
            while {
                xs.sort_by(f64::total_cmp);
                xs.dedup_by(|a, b| a == b);
                xs.len() < 2
            } {
                xs.push(number(random));
            }
            list(xs.into_iter().map(|x| list([x, number(random)].map(Value::Number))))
        }
        Shape::Points(min) => {
            // Ridges have heights.
            let numbers = if spec.name == "ridges" { 3 } else { 2 + random.below(2) };
            let point = |random: &mut Random| {
                let of = |k: u64, drawn: f64| if k == 2 && spec.name == "ridges" { drawn.abs() + 1.0 } else { drawn };
                list((0..numbers).map(|k| Value::Number(of(k, number(random)).min(UNBOUNDED))))
            };
            let line = |random: &mut Random| {
                let points = min as u64 + random.below(6);
                list((0..points).map(|_| point(random)))
            };
            if random.below(2) == 0 { line(random) } else { list((0..1 + random.below(3)).map(|_| line(random))) }
        }
        Shape::Positions => {
            list((0..1 + random.below(5)).map(|_| list([number(random), number(random)].map(Value::Number))))
        }
        Shape::Tables(tables) => list((0..random.below(5)).map(|_| table(tables, cell, file, random))),
        Shape::File => Value::Text(file.to_string()),
        Shape::Crs => Value::Text("EPSG:32632".to_string()),
    }
}

fn list(items: impl IntoIterator<Item = Value>) -> Value {
    Value::List(items.into_iter().map(Spanned::unplaced).collect())
}

fn table(tables: &TableSpec, cell: f64, file: &str, random: &mut Random) -> Value {
    let mut entries = Vec::new();
    for (k, key) in tables.keys.iter().enumerate() {
        if k < tables.required || random.below(2) == 0 {
            let value = value(key, cell, file, random);
            entries.push((Spanned::unplaced(key.name.to_string()), Spanned::unplaced(value)));
        }
    }
    Value::Table(entries)
}

/// A number within the range of the declaration, of any order of magnitude, or one of its ends.
fn number(spec: &ParamSpec, cell: f64, random: &mut Random) -> f64 {
    let [low, high] = [spec.range[0].max(-UNBOUNDED), spec.range[1].min(UNBOUNDED)];
    let cells = libm::pow(10.0, 4.0 * random.share() - 2.0);
    let drawn = match (random.below(8), spec.unit) {
        (0, _) => low,
        (1, _) => high,
        (2, _) => random.below(4) as f64 - 1.0,
        (3..6, "m") => cells * cell,
        (3..6, "m^2") => cells * cells * cell * cell,
        // All orders of magnitude are equally likely.
        _ if high > 1e3 * low.abs().max(1.0) => {
            let least = if low > 0.0 { low } else { (1e-6 * high).min(1e-3) };
            let size = least * libm::pow(high / least, random.share());
            if low < 0.0 && random.below(2) == 0 { -size } else { size }
        }
        _ => low + (high - low) * random.share(),
    };
    drawn.clamp(low, high)
}

/// An expression of the names a, b and c, and of any functions.
fn expression(depth: u32, random: &mut Random) -> String {
    if depth == 0 || random.below(6) == 0 {
        return match random.below(5) {
            0 => format!("{:?}", 100.0 * random.share()),
            1 => random.below(5).to_string(),
            k => ["a", "b", "c"][k as usize - 2].to_string(),
        };
    }
    let function = Function::ALL[random.below(Function::ALL.len() as u64) as usize];
    let arguments: Vec<String> = (0..function.arity()).map(|_| expression(depth - 1, random)).collect();
    match (function.name(), arguments.as_slice()) {
        (name, arguments) if name.starts_with(char::is_alphabetic) => format!("{name}({})", arguments.join(", ")),
        (sign, [a, b]) => format!("({a} {sign} {b})"),
        (sign, arguments) => format!("({sign}{})", arguments.concat()),
    }
}
