//! Round values along an axis.

/// The unit of the values along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Count {
    /// Metres.
    Metres,
    /// Degrees west or east.
    Longitude,
    /// Degrees south or north.
    Latitude,
}

/// At most `most` round values between two ends, each with its label.
pub fn ticks([from, to]: [f64; 2], most: usize, count: Count) -> Vec<(f64, String)> {
    let (low, high) = (from.min(to), from.max(to));
    ticks_every([from, to], step(high - low, most), count)
}

/// The multiples of `step` between two ends, each with its label.
pub fn ticks_every([from, to]: [f64; 2], step: f64, count: Count) -> Vec<(f64, String)> {
    let (low, high) = (from.min(to), from.max(to));
    if step <= 0.0 {
        return Vec::new();
    }
    let kilometres = count == Count::Metres && high - low >= 4000.0 && step >= 100.0;
    let (divide, unit) = if kilometres { (1000.0, " km") } else { (1.0, " m") };
    let decimals = decimals(step / divide);
    let name = |value: f64| match count {
        Count::Metres => format!("{}{unit}", grouped(value / divide, decimals)),
        Count::Longitude => degrees(value, decimals, ["W", "E"]),
        Count::Latitude => degrees(value, decimals, ["S", "N"]),
    };
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    if !(0.0..1000.0).contains(&(last - first)) {
        return Vec::new();
    }
    (first as i64..=last as i64).map(|k| k as f64 * step).map(|value| (value, name(value))).collect()
}

/// The number of decimals of the multiples of a step.
fn decimals(step: f64) -> usize {
    let first = (-libm::log10(step * 1.000_001).floor()).clamp(0.0, 9.0) as usize;
    let is_whole = |decimals: &usize| {
        let scaled = step * libm::pow(10.0, *decimals as f64);
        (scaled - scaled.round()).abs() < 1e-6 * scaled
    };
    (first..=9).find(is_whole).unwrap_or(first)
}

/// A step with its unit.
pub fn step_words(step: f64, count: Count) -> String {
    let kilometres = count == Count::Metres && step >= 1000.0;
    let value = if kilometres { step / 1000.0 } else { step };
    let unit = match count {
        Count::Metres if kilometres => " km",
        Count::Metres => " m",
        Count::Longitude | Count::Latitude => "°",
    };
    format!("{}{unit}", grouped(value, decimals(value)))
}

/// The smallest round step (1, 2 or 5 times a power of ten) with at most `most` values in a length; 0 if there is none.
pub fn step(length: f64, most: usize) -> f64 {
    let rough = length / most.max(1) as f64;
    if !(rough > 1e-12 && rough < 1e15) {
        return 0.0;
    }
    let power = libm::pow(10.0, libm::log10(rough).floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|n| n * power).find(|step| *step >= rough * 0.999_999).unwrap_or(10.0 * power)
}

/// A number with narrow spaces between groups of three digits, and a typographic minus sign.
pub fn grouped(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let (whole, rest) = text.split_at(text.find('.').unwrap_or(text.len()));
    let mut out = String::new();
    if value < 0.0 && text.bytes().any(|byte| (b'1'..=b'9').contains(&byte)) {
        out.push('−');
    }
    for (k, digit) in whole.chars().enumerate() {
        if k > 0 && (whole.len() - k) % 3 == 0 && whole.len() > 4 {
            out.push(' ');
        }
        out.push(digit);
    }
    out + rest
}

fn degrees(value: f64, decimals: usize, sides: [&str; 2]) -> String {
    let side = if value.abs() < 1e-9 { "" } else { sides[usize::from(value > 0.0)] };
    format!("{:.decimals$}°{side}", value.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_named() {
        let names = |ends, most, count| ticks(ends, most, count).into_iter().map(|tick| tick.1).collect::<Vec<_>>();
        for (ends, most, count, expect) in [
            ([0.0, 12_345.0], 4, Count::Metres, vec!["0 km", "5 km", "10 km"]),
            ([0.0, 900.0], 5, Count::Metres, vec!["0 m", "200 m", "400 m", "600 m", "800 m"]),
            ([376_328.0, 381_000.0], 3, Count::Metres, vec!["378 km", "380 km"]),
            ([-118.34, -117.95], 4, Count::Longitude, vec!["118.3°W", "118.2°W", "118.1°W", "118.0°W"]),
            ([0.25, -0.25], 3, Count::Latitude, vec!["0.2°S", "0.0°", "0.2°N"]),
            ([0.0, 1.5], 3, Count::Metres, vec!["0.0 m", "0.5 m", "1.0 m", "1.5 m"]),
        ] {
            assert_eq!(names(ends, most, count), expect, "{ends:?}");
        }
        assert!(ticks([5.0, 5.0], 4, Count::Metres).is_empty() && ticks([f64::NAN, 1.0], 4, Count::Metres).is_empty());
    }

    #[test]
    fn numbers_in_groups() {
        for (value, decimals, expect) in
            [(1234.0, 0, "1234"), (12_345.0, 0, "12 345"), (-1_234_567.5, 1, "−1 234 567.5"), (-0.01, 1, "0.0")]
        {
            assert_eq!(grouped(value, decimals), expect);
        }
    }
}
