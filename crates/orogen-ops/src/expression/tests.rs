use super::formula::{is_parameter_name, renamed, value};
use super::function::{Argument, Function};
use super::term::{MAX_DEPTH, MAX_NAMES, MAX_TERMS, Term};
use super::text::Expression;

fn of(text: &str, names: &[f64]) -> f64 {
    let expression = Expression::from(text);
    assert_eq!(expression.error(), None, "{text}");
    expression.value(names).unwrap()
}

#[test]
fn what_expressions_are_worth() {
    for (text, expect) in [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("2 - 3 - 4", -5.0),
        ("2 ^ 3 ^ 2", 512.0),
        ("-2 ^ 2", -4.0),
        ("2 ^ -1", 0.5),
        ("--3", 3.0),
        ("+3", 3.0),
        ("7 ^ 1", 7.0),
        ("3 * 3 - 9 + 3 * 3", 9.0),
        ("16^0.5 + 2^0.5 * 2^0.5", 4.0 + 2f64.sqrt() * 2f64.sqrt()),
        ("8 / 4 / 2", 1.0),
        ("-7 % 3", 2.0),
        ("7 % -3", -2.0),
        (".5e1 + 1e-1 + 2.", 7.1),
        ("1 < 2", 1.0),
        ("2 <= 1", 0.0),
        ("(1 == 1) + (1 != 1) + (2 >= 2) + (3 > 4)", 2.0),
        ("min(3, 1, 2) + max(3, 1, 2)", 4.0),
        ("clamp(5, 0, 2) + clamp(-5, 0, 2)", 2.0),
        ("mix(10, 20, 2) + mix(10, 20, 0.5)", 35.0),
        ("lerp(10, 20, 2)", 30.0),
        ("smoothstep(0, 2, 1) + smoothstep(0, 2, 5) + smoothstep(0, 2, -1)", 1.5),
        ("step(1, 1) + step(1, 0.5)", 1.0),
        ("abs(-2) + sign(-2) + sign(0) + sign(9)", 2.0),
        ("floor(-1.5) + ceil(1.2) + round(2.5)", 3.0),
        ("fract(2.25) + fract(-0.25)", 1.0),
        ("sqrt(9) + exp(0) + log(1) + log2(8) + log10(100)", 9.0),
        ("pow(2, 10)", 1024.0),
        ("sin(0) + cos(pi) + tan(0) + asin(0) + acos(1) + atan(0)", -1.0),
        ("atan2(1, 0) / tau", 0.25),
        ("hypot(3, 4) + tanh(0)", 5.0),
        ("smin(1, 5, 0) + smax(1, 5, 0)", 6.0),
        ("smin(1, 1, 4)", 0.0),
        ("smax(1, 1, 4)", 2.0),
    ] {
        assert!((of(text, &[]) - expect).abs() < 1e-12, "{text} = {}", of(text, &[]));
    }
    assert_eq!(of("height^2 - noise.east", &[3.0, 1.0]), 8.0);
}

/// Expressions with the byte offset of their error, and a part of the message.
#[test]
fn what_is_wrong_and_where() {
    for (text, at, expect) in [
        ("", 0, "empty"),
        ("  ", 0, "empty"),
        ("1 +", 3, "ends too early"),
        ("(1 + 2", 0, "the `)` that closes this is missing"),
        ("1 + 2)", 5, "no `(`"),
        ("a b", 2, "operator"),
        ("2a", 1, "operator"),
        ("1 * * 2", 4, "before this `*`"),
        ("a, b", 1, "comma"),
        ("(a, b)", 2, "comma"),
        ("smothstep(0, 1, a)", 0, "did you mean `smoothstep`?"),
        ("clamp(1, 2)", 0, "`clamp` takes 3 arguments, clamp(a, low, high), not 2"),
        ("min(1)", 0, "takes 2 arguments"),
        ("sin()", 0, "takes 1 argument"),
        ("sin + 1", 0, "is a function"),
        ("1 < 2 < 3", 6, "do not chain"),
        ("a = 3", 2, "equality is `==`"),
        ("a ** 2", 2, "a ^ b"),
        ("a && b", 2, "comparisons are 1 or 0"),
        ("1.2.3", 0, "is not a number"),
        ("1e999", 0, "more than a number can be"),
        ("a + ü", 4, "unknown symbol"),
        ("a \u{0} b", 2, "unknown symbol"),
        ("a # b", 2, "unknown symbol"),
        ("max(1, )", 7, "before this `)`"),
    ] {
        let expression = Expression::from(text);
        let fault = expression.error().unwrap_or_else(|| panic!("{text} is fine"));
        assert_eq!(fault.span.start, at, "{text}: {}", fault.message);
        assert!(fault.message.contains(expect), "{text}: {}", fault.message);
    }
}

#[test]
fn what_is_too_large_is_refused_quickly() {
    let begun = std::time::Instant::now();
    let deep = 1 << 20;
    let wide = |part: &str, n: usize| vec![part; n].join("+");
    let many_names: Vec<String> = (0..=MAX_NAMES).map(|name| format!("a{name}")).collect();
    let many_numbers: Vec<String> = (0..=MAX_TERMS / 2).map(|number| number.to_string()).collect();
    for (text, expect) in [
        ("(".repeat(deep), "bytes"),
        ("(".repeat(1000), "levels deep"),
        ("-".repeat(1000) + "1", "levels deep"),
        ("2^".repeat(1000) + "1", "levels deep"),
        ("sin(".repeat(1000), "levels deep"),
        (wide("a", deep), "bytes"),
        (many_names.join("+"), "more than 64 names"),
        (many_numbers.join("*a+"), "more than 4096 terms"),
    ] {
        let expression = Expression::from(text.as_str());
        let fault = expression.error().unwrap();
        assert!(fault.message.contains(expect), "{}", fault.message);
    }
    // Equal terms are computed once, so a long expression is not necessarily an error.
    assert!(Expression::from(wide("a", 30_000).as_str()).error().is_some());
    assert!(Expression::from(wide("a*b", 1000).as_str()).error().is_none());
    assert!(Expression::from(("(".repeat(MAX_DEPTH) + "1" + &")".repeat(MAX_DEPTH)).as_str()).error().is_none());
    // Quadratic time would take hours.
    assert!(begun.elapsed().as_secs() < 120, "{:?}", begun.elapsed());
}

/// Random texts never panic, and a parsed expression lists each term after its operands.
#[test]
fn random_texts() {
    let pieces = [
        "a", "b.c", "1", "2.5e3", "(", ")", ",", "+", "-", "*", "/", "^", "%", "<", "==", " ", "sin(", "min(", "é",
        "\0", ".",
    ];
    let mut state = 7u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let mut sound = 0;
    for _ in 0..200_000 {
        let length = random(9);
        let text: String = (0..length).map(|_| pieces[random(pieces.len())]).collect();
        let expression = Expression::from(text.as_str());
        match expression.error() {
            Some(fault) => {
                assert!(fault.span.start <= fault.span.end && fault.span.end <= text.len().max(1) + 1, "{text:?}");
                assert!(text.is_char_boundary(fault.span.start.min(text.len())), "{text:?}");
            }
            None => {
                sound += 1;
                assert!(expression.value(&[1.5; MAX_NAMES]).is_some(), "{text:?}");
                for (at, term) in expression.terms().iter().enumerate() {
                    if let Term::Apply(function, arguments) = term {
                        assert!(arguments[..function.arity()].iter().all(|argument| *argument < at), "{text:?}");
                    }
                }
            }
        }
    }
    assert!(sound > 1000, "{sound}");
}

/// Blocks of samples, single numbers, and constants in place of blocks give the same bits.
#[test]
fn blocks_and_single_numbers_agree() {
    let special = [0.0, -0.0, 1.0, -1.0, 0.5, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e-40, 3.4e38, -2.75];
    let samples = |seed: usize| -> Vec<f32> {
        (0..777)
            .map(|k| special[(k * (seed + 3) + k / 11 + seed) % special.len()] * if k % 5 == 0 { 1.37 } else { 1.0 })
            .collect()
    };
    let all: Vec<Vec<f32>> = (0..3).map(samples).collect();
    for function in Function::ALL {
        let blocks: Vec<Argument> = all.iter().take(function.arity()).map(|block| Argument::Samples(block)).collect();
        let mut out = vec![0.0; 777];
        function.apply(&blocks, &mut out);
        for (k, made) in out.iter().enumerate() {
            let single = function.of_f32([all[0][k], all[1][k], all[2][k]]);
            assert!(same(*made, single), "{function:?} of {} {} {}: {made}, {single}", all[0][k], all[1][k], all[2][k]);
        }
        if matches!(function, Function::Floor | Function::Ceil) {
            for (sample, made) in all[0].iter().zip(&out) {
                let expect = if *function == Function::Floor { sample.floor() } else { sample.ceil() };
                assert!(same(*made, expect), "{function:?} of {sample}: {made}");
            }
        }
        // The last argument is constant, then the first, then all but the last.
        for number in special {
            let mut mixed = blocks.clone();
            mixed.pop();
            mixed.push(Argument::Number(number));
            function.apply(&mixed, &mut out);
            for (k, made) in out.iter().enumerate() {
                let mut arguments = [all[0][k], all[1][k], all[2][k]];
                arguments[function.arity() - 1] = number;
                let single = function.of_f32(arguments);
                assert!(same(*made, single), "{function:?} of {arguments:?}: {made}, {single}");
            }
            for kept in 0..function.arity() {
                let mut mixed = vec![Argument::Number(number); function.arity()];
                mixed[kept] = blocks[kept];
                function.apply(&mixed, &mut out);
                for (k, made) in out.iter().enumerate() {
                    let mut arguments = [number; 3];
                    arguments[kept] = all[kept][k];
                    let single = function.of_f32(arguments);
                    assert!(same(*made, single), "{function:?} of {arguments:?}: {made}, {single}");
                }
            }
        }
    }
}

/// Equal bits, or both NaN.
fn same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// f32 and f64 are two implementations of one function: they agree within the precision of f32.
#[test]
fn single_and_double_precision_agree() {
    for function in Function::ALL {
        for k in 0..200 {
            let number = |seed: usize| ((k * (seed + 7) * 31 + seed * 17) % 199) as f64 / 100.0 - 0.97;
            let arguments = [number(1), number(2), number(3)];
            let (double, single) = (function.of_f64(arguments), function.of_f32(arguments.map(|n| n as f32)));
            // Steps have other positions in f32.
            if matches!(
                function,
                Function::Modulo | Function::Floor | Function::Ceil | Function::Round | Function::Fract
            ) {
                continue;
            }
            let near = (double - f64::from(single)).abs() <= 1e-3 * double.abs().max(1.0);
            assert!(
                near || (double.is_nan() && single.is_nan()) || double.abs() > 100.0,
                "{function:?} of {arguments:?}: {double}, {single}"
            );
        }
    }
}

#[test]
fn formulas() {
    let known = |name: &str| (name == "width").then_some(8.0);
    let unknown = |name: &str| format!("no `{name}`");
    assert_eq!(value("width / 4 + 1", known, unknown), Ok(3.0));
    let fault = value("2 * wdth", known, unknown).unwrap_err();
    assert_eq!((fault.span, fault.message.as_str()), (4..8, "no `wdth`"));
    let fault = value("1 / (width - 8)", known, unknown).unwrap_err();
    assert!(fault.message.contains("inf"), "{}", fault.message);
    assert!(value("sqrt(-1)", known, unknown).unwrap_err().message.contains("NaN"));
    assert_eq!(
        renamed("a + sin(a) * b.c + aa", |name| (name == "a").then(|| "(x / 2)".into())),
        "(x / 2) + sin((x / 2)) * b.c + aa"
    );
    for (name, expect) in [
        ("relief", true),
        ("_a1", true),
        ("pi", false),
        ("min", false),
        ("a-b", false),
        ("a.b", false),
        ("", false),
        ("1a", false),
        ("a b", false),
    ] {
        assert_eq!(is_parameter_name(name), expect, "{name}");
    }
}
