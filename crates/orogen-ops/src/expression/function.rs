//! The functions of expressions, each declared once: its name, its arguments, and its computation in f32 and in f64.

use serde::{Deserialize, Serialize};

/// Number of samples that are computed at a time if an argument is a number. The number is repeated this many times and
/// stays in the L1 cache.
const CHUNK: usize = 256;

/// Maximum number of arguments of a function.
pub const MAX_ARGUMENTS: usize = 3;

/// An argument of a function over a block of samples.
#[derive(Debug, Clone, Copy)]
pub enum Argument<'a> {
    /// A constant.
    Number(f32),
    /// One number per sample.
    Samples(&'a [f32]),
}

macro_rules! functions {
    ($(
        $(#[doc = $doc:literal])+
        $variant:ident = $name:literal $arguments:tt, $cost:literal, |$($arg:ident),+| $single:expr, $double:expr;
    )*) => {
        /// A function of one, two or three numbers. Arithmetic is IEEE 754; other functions use `orogen-libm`, so
        /// the bits are the same on every machine.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum Function { $( $(#[doc = $doc])+ $variant, )* }

        impl Function {
            /// All functions.
            pub const ALL: &'static [Function] = &[$( Function::$variant, )*];

            /// The name in expressions; operators have their symbol.
            pub fn name(self) -> &'static str {
                match self { $( Function::$variant => $name, )* }
            }

            /// The description, on one line.
            pub fn doc(self) -> &'static str {
                match self { $( Function::$variant => concat!($($doc,)+), )* }
            }

            /// The syntax, with named arguments.
            pub fn usage(self) -> &'static str {
                match self { $( Function::$variant => concat!($name, stringify!($arguments)), )* }
            }

            /// Number of arguments.
            pub fn arity(self) -> usize {
                match self { $( Function::$variant => [$(stringify!($arg)),+].len(), )* }
            }

            /// Approximate nanoseconds per sample.
            pub fn cost(self) -> f64 {
                match self { $( Function::$variant => $cost, )* }
            }

            /// The value for single numbers, in f64.
            pub fn of_f64(self, arguments: [f64; MAX_ARGUMENTS]) -> f64 {
                match self { $( Function::$variant => { functions!(@bind arguments, $($arg),+); $double } )* }
            }

            /// The value for single numbers, in f32: the same bits as [`Function::apply`].
            pub fn of_f32(self, arguments: [f32; MAX_ARGUMENTS]) -> f32 {
                match self { $( Function::$variant => { functions!(@bind arguments, $($arg),+); $single } )* }
            }

            /// The values for blocks of samples, all of the length of `out`.
            pub fn apply(self, arguments: &[Argument], out: &mut [f32]) {
                match self { $( Function::$variant => functions!(@apply arguments, out, |$($arg),+| $single), )* }
            }
        }
    };
    (@bind $arguments:ident, $a:ident) => { let [$a, ..] = $arguments; };
    (@bind $arguments:ident, $a:ident, $b:ident) => { let [$a, $b, _] = $arguments; };
    (@bind $arguments:ident, $a:ident, $b:ident, $c:ident) => { let [$a, $b, $c] = $arguments; };
    (@apply $arguments:ident, $out:ident, |$a:ident| $single:expr) => { unary($arguments, $out, |$a| $single) };
    (@apply $arguments:ident, $out:ident, |$a:ident, $b:ident| $single:expr) => { binary($arguments, $out, |$a, $b| $single) };
    (@apply $arguments:ident, $out:ident, |$a:ident, $b:ident, $c:ident| $single:expr) => {
        ternary($arguments, $out, |$a, $b, $c| $single)
    };
}

/// The minimum of a and b, with the seam rounded where they differ by less than `smooth`: min(a, b) - h^2 smooth / 4
/// with h = max(0, smooth - |a - b|) / smooth (Quilez, "Smooth minimum", the quadratic polynomial). With `>` and `+`
/// instead of `<` and `-` it is the maximum, with the mirrored rule.
macro_rules! seam {
    ($a:ident $comparison:tt $b:ident, $sign:tt $smooth:ident) => {{
        let extreme = if $a $comparison $b { $a } else { $b };
        if $smooth <= 0.0 {
            extreme
        } else {
            let h = ($smooth - ($a - $b).abs()).max(0.0) / $smooth;
            extreme $sign h * h * ($smooth * 0.25)
        }
    }};
}

functions! {
    /// Sum.
    Add = "+" (a, b), 0.2, |a, b| a + b, a + b;
    /// Difference.
    Subtract = "-" (a, b), 0.2, |a, b| a - b, a - b;
    /// Product.
    Multiply = "*" (a, b), 0.2, |a, b| a * b, a * b;
    /// Quotient.
    Divide = "/" (a, b), 0.3, |a, b| a / b, a / b;
    /// Remainder of a division rounded down: it has the sign of b.
    Modulo = "%" (a, b), 1.0, |a, b| a - b * floor(a / b), a - b * (a / b).floor();
    /// Opposite number.
    Negate = "-" (a), 0.2, |a| -a, -a;
    /// 1 where a is less than b, else 0.
    Less = "<" (a, b), 0.2, |a, b| truth(a < b) as f32, truth(a < b);
    /// 1 where a is at most b, else 0.
    LessOrEqual = "<=" (a, b), 0.2, |a, b| truth(a <= b) as f32, truth(a <= b);
    /// 1 where a is more than b, else 0.
    Greater = ">" (a, b), 0.2, |a, b| truth(a > b) as f32, truth(a > b);
    /// 1 where a is at least b, else 0.
    GreaterOrEqual = ">=" (a, b), 0.2, |a, b| truth(a >= b) as f32, truth(a >= b);
    /// 1 where a equals b, else 0.
    Equal = "==" (a, b), 0.2, |a, b| truth(a == b) as f32, truth(a == b);
    /// 1 where a differs from b, else 0.
    NotEqual = "!=" (a, b), 0.2, |a, b| truth(a != b) as f32, truth(a != b);
    /// a raised to the power b; `^` is the same.
    Power = "pow" (a, b), 30.0, |a, b| libm::powf(a, b), libm::pow(a, b);
    /// Smaller of a and b.
    Min = "min" (a, b), 0.2, |a, b| if a < b { a } else { b }, if a < b { a } else { b };
    /// Greater of a and b.
    Max = "max" (a, b), 0.2, |a, b| if a > b { a } else { b }, if a > b { a } else { b };
    /// Smaller of a and b, their seam rounded where they differ by less than k, as `min` with `smooth`.
    SmoothMin = "smin" (a, b, k), 0.5, |a, b, k| seam!(a < b, -k), seam!(a < b, -k);
    /// Greater of a and b, their seam rounded where they differ by less than k, as `max` with `smooth`.
    SmoothMax = "smax" (a, b, k), 0.5, |a, b, k| seam!(a > b, +k), seam!(a > b, +k);
    /// a, cut off below low and above high.
    Clamp = "clamp" (a, low, high), 0.3, |a, low, high| cut(a, low, high), {
        let a = if a < low { low } else { a };
        if a > high { high } else { a }
    };
    /// Linear interpolation from a to b: a + (b - a) * t, with t clamped to 0 ..= 1.
    Mix = "mix" (a, b, t), 0.3, |a, b, t| a + (b - a) * cut(t, 0.0, 1.0), a + (b - a) * t.clamp(0.0, 1.0);
    /// Linear interpolation without clamping: a + (b - a) * t.
    Lerp = "lerp" (a, b, t), 0.3, |a, b, t| a + (b - a) * t, a + (b - a) * t;
    /// 0 below low, 1 above high, and the cubic t t (3 - 2 t) in between.
    Smoothstep = "smoothstep" (low, high, x), 0.5, |low, high, x| {
        let t = cut((x - low) / (high - low), 0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }, {
        let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    /// 0 where x is less than edge, else 1.
    Step = "step" (edge, x), 0.2, |edge, x| truth(x >= edge) as f32, truth(x >= edge);
    /// Absolute value.
    Abs = "abs" (a), 0.2, |a| a.abs(), a.abs();
    /// -1, 0 or 1.
    Sign = "sign" (a), 0.2, |a| (truth(a > 0.0) - truth(a < 0.0)) as f32, truth(a > 0.0) - truth(a < 0.0);
    /// Greatest whole number that is at most a.
    Floor = "floor" (a), 0.7, |a| floor(a), a.floor();
    /// Least whole number that is at least a.
    Ceil = "ceil" (a), 0.7, |a| -floor(-a), a.ceil();
    /// Nearest whole number; halves go away from 0.
    Round = "round" (a), 1.0, |a| a.round(), a.round();
    /// a - floor(a).
    Fract = "fract" (a), 0.8, |a| a - floor(a), a - a.floor();
    /// Square root.
    Sqrt = "sqrt" (a), 1.0, |a| a.sqrt(), a.sqrt();
    /// e to the power a.
    Exp = "exp" (a), 8.0, |a| libm::expf(a), libm::exp(a);
    /// Natural logarithm.
    Log = "log" (a), 6.0, |a| libm::logf(a), libm::log(a);
    /// Logarithm to the base 2.
    Log2 = "log2" (a), 6.0, |a| libm::log2f(a), libm::log2(a);
    /// Logarithm to the base 10.
    Log10 = "log10" (a), 6.0, |a| libm::log10f(a), libm::log10(a);
    /// Sine of an angle in radians.
    Sin = "sin" (a), 6.0, |a| libm::sinf(a), libm::sin(a);
    /// Cosine of an angle in radians.
    Cos = "cos" (a), 6.0, |a| libm::cosf(a), libm::cos(a);
    /// Tangent of an angle in radians.
    Tan = "tan" (a), 12.0, |a| libm::tanf(a), libm::tan(a);
    /// Angle in radians whose sine is a.
    Asin = "asin" (a), 8.0, |a| libm::asinf(a), libm::asin(a);
    /// Angle in radians whose cosine is a.
    Acos = "acos" (a), 8.0, |a| libm::acosf(a), libm::acos(a);
    /// Angle in radians whose tangent is a.
    Atan = "atan" (a), 8.0, |a| libm::atanf(a), libm::atan(a);
    /// Angle in radians of the point (x, y), from the x axis.
    Atan2 = "atan2" (y, x), 18.0, |y, x| libm::atan2f(y, x), libm::atan2(y, x);
    /// Hyperbolic tangent: like a, but never beyond -1 and 1.
    Tanh = "tanh" (a), 20.0, |a| libm::tanhf(a), libm::tanh(a);
    /// Length of (a, b): the square root of a^2 + b^2.
    Hypot = "hypot" (a, b), 4.0, |a, b| libm::hypotf(a, b), libm::hypot(a, b);
}

impl Function {
    /// The function with this name; operators have none.
    #[must_use]
    pub fn named(name: &str) -> Option<Function> {
        Function::functions().find(|function| function.name() == name)
    }

    /// The functions that are written with a name.
    pub fn functions() -> impl Iterator<Item = Function> + Clone {
        Function::ALL.iter().copied().filter(|function| function.name().starts_with(|c: char| c.is_ascii_alphabetic()))
    }
}

fn truth(holds: bool) -> f64 {
    if holds { 1.0 } else { 0.0 }
}

/// The largest integer that is at most x. The standard library's floor is a function call when compiled for the
/// processor's oldest level.
fn floor(x: f32) -> f32 {
    // From here on every f32 is an integer; NaN stays NaN.
    const WHOLE: f32 = 8_388_608.0;
    let whole = (x as i32) as f32;
    let below = if whole > x { whole - 1.0 } else { whole };
    if x.abs() < WHOLE { below.copysign(x) } else { x }
}

/// A number clamped at both ends. Unlike the standard library's clamp it also has a result for ends in the wrong order:
/// the upper one.
fn cut(a: f32, low: f32, high: f32) -> f32 {
    let a = if a < low { low } else { a };
    if a > high { high } else { a }
}

fn unary(arguments: &[Argument], out: &mut [f32], f: impl Fn(f32) -> f32) {
    match arguments {
        [Argument::Samples(a)] => out.iter_mut().zip(*a).for_each(|(out, a)| *out = f(*a)),
        [Argument::Number(a)] => out.fill(f(*a)),
        _ => {}
    }
}

fn binary(arguments: &[Argument], out: &mut [f32], f: impl Fn(f32, f32) -> f32) {
    match arguments {
        [Argument::Samples(a), Argument::Number(b)] => unary(&[Argument::Samples(a)], out, |a| f(a, *b)),
        [Argument::Number(a), b] => unary(&[*b], out, |b| f(*a, b)),
        [Argument::Samples(a), Argument::Samples(b)] => {
            for ((out, a), b) in out.iter_mut().zip(*a).zip(*b) {
                *out = f(*a, *b);
            }
        }
        _ => {}
    }
}

fn ternary(arguments: &[Argument], out: &mut [f32], f: impl Fn(f32, f32, f32) -> f32) {
    match arguments {
        [a, b, Argument::Number(c)] => binary(&[*a, *b], out, |a, b| f(a, b, *c)),
        [Argument::Number(a), Argument::Number(b), c] => unary(&[*c], out, |c| f(*a, *b, c)),
        [a, b, c] => {
            let (ra, rb, rc) = (repeated(a), repeated(b), repeated(c));
            for (chunk, out) in out.chunks_mut(CHUNK).enumerate() {
                let part = |argument, number| part(argument, number, chunk * CHUNK, out.len());
                let (a, b, c) = (part(a, &ra), part(b, &rb), part(c, &rc));
                for (((out, a), b), c) in out.iter_mut().zip(a).zip(b).zip(c) {
                    *out = f(*a, *b, *c);
                }
            }
        }
        _ => {}
    }
}

/// A part of an argument: its samples, or the repeated number.
fn part<'a>(argument: &Argument<'a>, repeated: &'a [f32; CHUNK], from: usize, count: usize) -> &'a [f32] {
    match argument {
        Argument::Number(_) => &repeated[..count],
        Argument::Samples(samples) => samples.get(from..from + count).unwrap_or(&[]),
    }
}

fn repeated(argument: &Argument) -> [f32; CHUNK] {
    match argument {
        Argument::Number(number) => [*number; CHUNK],
        Argument::Samples(_) => [0.0; CHUNK],
    }
}
