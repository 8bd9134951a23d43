//! The functions of expressions in WGSL.

use orogen_engine::expression::function::Function;

/// Functions that WGSL lacks, or has with too little precision.
pub(crate) const TEXT: &str = include_str!("functions.wgsl");

/// The expression of a function of arguments.
pub(crate) fn expression(function: Function, arguments: &[String]) -> String {
    let [a, b, c] = [0, 1, 2].map(|i| arguments.get(i).map_or("0.0", String::as_str));
    match function {
        Function::Add => format!("({a} + {b})"),
        Function::Subtract => format!("({a} - {b})"),
        Function::Multiply => format!("({a} * {b})"),
        Function::Divide => format!("({a} / {b})"),
        Function::Modulo => format!("modulo({a}, {b})"),
        Function::Negate => format!("(-{a})"),
        Function::Less => format!("truth({a} < {b})"),
        Function::LessOrEqual => format!("truth({a} <= {b})"),
        Function::Greater => format!("truth({a} > {b})"),
        Function::GreaterOrEqual => format!("truth({a} >= {b})"),
        Function::Equal => format!("truth({a} == {b})"),
        Function::NotEqual => format!("truth({a} != {b})"),
        Function::Power => format!("power({a}, {b})"),
        Function::Min => format!("select({b}, {a}, {a} < {b})"),
        Function::Max => format!("select({b}, {a}, {a} > {b})"),
        Function::SmoothMin => format!("smooth_min({a}, {b}, {c})"),
        Function::SmoothMax => format!("smooth_max({a}, {b}, {c})"),
        Function::Clamp => format!("cut({a}, {b}, {c})"),
        Function::Mix => format!("({a} + ({b} - {a}) * cut({c}, 0.0, 1.0))"),
        Function::Lerp => format!("({a} + ({b} - {a}) * {c})"),
        Function::Smoothstep => format!("step_between({a}, {b}, {c})"),
        Function::Step => format!("truth({b} >= {a})"),
        Function::Abs => format!("abs({a})"),
        Function::Sign => format!("(truth({a} > 0.0) - truth({a} < 0.0))"),
        Function::Floor => format!("floor({a})"),
        Function::Ceil => format!("ceil({a})"),
        Function::Round => format!("rounded({a})"),
        Function::Fract => format!("({a} - floor({a}))"),
        Function::Sqrt => format!("sqrt({a})"),
        Function::Exp => format!("exp({a})"),
        Function::Log => format!("log({a})"),
        Function::Log2 => format!("log2({a})"),
        Function::Log10 => format!("(log2({a}) * 0.30102999566398120)"),
        Function::Sin => format!("sine({a})"),
        Function::Cos => format!("cosine({a})"),
        Function::Tan => format!("(sine({a}) / cosine({a}))"),
        Function::Asin => format!("arc_sine({a})"),
        Function::Acos => format!("arc_cosine({a})"),
        Function::Atan => format!("arc_tangent({a})"),
        Function::Atan2 => format!("arc_tangent2({a}, {b})"),
        Function::Tanh => format!("hyperbolic_tangent({a})"),
        Function::Hypot => format!("length(vec2<f32>({a}, {b}))"),
    }
}
