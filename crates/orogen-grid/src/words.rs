//! Text for messages: suggestions, lists, numbers.

/// The candidate that a misspelt `word` most likely means. At most a third of its letters may differ, or one of three;
/// insertions, deletions, substitutions and transpositions count one each, and case is ignored. `None` if there is
/// none.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word: Vec<char> = word.chars().flat_map(char::to_lowercase).take(64).collect();
    candidates
        .into_iter()
        .map(|candidate| {
            let letters: Vec<char> = candidate.chars().flat_map(char::to_lowercase).collect();
            (distance(&word, &letters), letters.len(), candidate)
        })
        .filter(|(distance, length, _)| *distance <= word.len().max(*length) / 3 && 2 * distance <= *length)
        .min_by_key(|(distance, _, _)| *distance)
        .map(|(_, _, candidate)| candidate)
}

/// Optimal string alignment distance (Damerau 1964, restricted to one edit per position).
fn distance(a: &[char], b: &[char]) -> usize {
    let mut rows = vec![vec![0usize; b.len() + 1]; a.len() + 1];
    for (i, row) in rows.iter_mut().enumerate() {
        row[0] = i;
    }
    for (j, cell) in rows[0].iter_mut().enumerate() {
        *cell = j;
    }
    for i in 1..=a.len() {
        for j in 1..=b.len() {
            let change = usize::from(a[i - 1] != b[j - 1]);
            let mut best = (rows[i - 1][j] + 1).min(rows[i][j - 1] + 1).min(rows[i - 1][j - 1] + change);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = best;
        }
    }
    rows[a.len()][b.len()]
}

/// `did you mean ...?` if there is a similar word, otherwise the list of candidates.
pub fn suggestion<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str> + Clone) -> String {
    match nearest(word, candidates.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => {
            let all: Vec<&str> = candidates.into_iter().collect();
            match all.len() {
                0 => "none is available".to_string(),
                _ => format!("available: {}", list(all)),
            }
        }
    }
}

/// A list for a message: "`a`, `b` and `c`". Lists of more than 100 words are shortened and show their count.
pub fn list<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 100;
    let words: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match words.as_slice() {
        [] => "nothing".to_string(),
        [one] => one.clone(),
        many if many.len() > SHOWN => format!("{} and {} more", many[..SHOWN].join(", "), many.len() - SHOWN),
        [init @ .., last] => format!("{} and {last}", init.join(", ")),
    }
}

/// Words with two spellings, British and American.
const SPELLINGS: [(&str, &str); 4] =
    [("centre", "center"), ("colour", "color"), ("grey", "gray"), ("normalise", "normalize")];

/// The name in its other spelling: "centre" for "center". `None` if it has only one.
#[must_use]
pub fn respelled(name: &str) -> Option<String> {
    let other = |(one, other): &(&str, &str)| match (name.contains(one), name.contains(other)) {
        (true, _) => Some(name.replace(one, other)),
        (_, true) => Some(name.replace(other, one)),
        _ => None,
    };
    SPELLINGS.iter().find_map(other)
}

/// A count with its noun: "1 tile", "3 tiles".
#[must_use]
pub fn count(n: usize, thing: &str) -> String {
    match n {
        1 => format!("1 {thing}"),
        n => format!("{n} {thing}s"),
    }
}

/// A share in percent, with two decimals: "12.50 %", "less than 0.01 %".
#[must_use]
pub fn percent(part: u64, whole: u64) -> String {
    match 100.0 * part as f64 / whole as f64 {
        little if part > 0 && little < 0.01 => "less than 0.01 %".to_string(),
        share => format!("{share:.2} %"),
    }
}

/// A number with up to six significant digits, or rounded to an integer: "2666.67", "0.3125", "1e308".
#[must_use]
pub fn number(value: f64) -> String {
    // Formatting rounds to the nearest number, and parsing is exact.
    let rounded = match value.abs() {
        large if large >= 1e5 => value.round(),
        _ => format!("{value:.5e}").parse().unwrap_or(value),
    };
    match rounded.abs() {
        plain if plain == 0.0 || (1e-6..1e15).contains(&plain) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

/// Maximum length of a name in a message, in characters.
const LONGEST_NAME: usize = 80;

/// Maximum number of digits of a number in a message, which is more than any useful number has.
const LONGEST_NUMBER: usize = 24;

/// Shortens a message. Names between backticks that are longer than 80 characters are cut in the middle, and numbers of
/// more than 24 digits are written with an exponent.
#[must_use]
pub fn readable(message: String) -> String {
    if message.len() <= LONGEST_NUMBER {
        return message;
    }
    let mut out = String::with_capacity(message.len().min(4096));
    let mut parts = message.split('`').peekable();
    let mut quoted = false;
    while let Some(part) = parts.next() {
        // A backtick without its counterpart quotes nothing.
        match quoted && parts.peek().is_some() && part.chars().nth(LONGEST_NAME).is_some() {
            true => {
                let half = LONGEST_NAME / 2 - 2;
                out.extend(part.chars().take(half));
                out.push_str("...");
                let end: Vec<char> = part.chars().rev().take(half).collect();
                out.extend(end.into_iter().rev());
            }
            false => short_numbers(part, &mut out),
        }
        if parts.peek().is_some() {
            out.push('`');
        }
        quoted = !quoted;
    }
    out
}

/// Appends a text, with its long numbers written with an exponent.
fn short_numbers(text: &str, out: &mut String) {
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let digits = |c: char| c.is_ascii_digit() || c == '.';
        let end = rest[start..].find(|c| !digits(c)).map_or(rest.len(), |length| start + length);
        out.push_str(&rest[..start]);
        let run = &rest[start..end];
        // Not inside a word, such as a checksum.
        let alone = !rest[..start].ends_with(char::is_alphanumeric) && !rest[end..].starts_with(char::is_alphanumeric);
        match run.trim_end_matches('.').parse::<f64>() {
            Ok(number) if run.len() > LONGEST_NUMBER && alone => {
                out.push_str(&format!("{number:e}"));
                out.push_str(&run[run.trim_end_matches('.').len()..]);
            }
            _ => out.push_str(run),
        }
        rest = &rest[end..];
    }
    out.push_str(rest);
}

/// A number of bytes with its unit: "1.5 GiB".
#[must_use]
pub fn bytes(n: u64) -> String {
    bytes_with(n, 0, f64::round).0
}

/// A required number of bytes and a limit that it exceeds, with enough digits that both texts differ: "1.1 GiB" and
/// "1.0 GiB". The required number is rounded up, so that a limit of the displayed number is sufficient.
#[must_use]
pub fn bytes_apart(need: u64, limit: u64) -> [String; 2] {
    // More digits would be harder to read than the number itself.
    const MOST: usize = 3;
    for more in 0..=MOST {
        let (one, one_rounded) = bytes_with(need, more, f64::ceil);
        let (other, other_rounded) = bytes_with(limit, more, f64::round);
        if need == limit || one_rounded != other_rounded {
            return [one, other];
        }
    }
    [need, limit].map(|n| format!("{n} bytes"))
}

/// A number of bytes as text, with `more` decimals beyond the usual ones and rounded with `round`, and the value of the
/// text.
fn bytes_with(n: u64, more: usize, round: impl Fn(f64) -> f64) -> (String, f64) {
    const UNITS: [&str; 6] = ["bytes", "KiB", "MiB", "GiB", "TiB", "PiB"];
    let (mut value, mut unit, mut scale) = (n as f64, 0, 1.0);
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        scale *= 1024.0;
        unit += 1;
    }
    if unit == 0 {
        return (count(n as usize, "byte"), value);
    }
    let decimals = more + usize::from(value < 10.0);
    let digit = [1.0, 10.0, 100.0, 1e3, 1e4][decimals.min(4)];
    let text = format!("{:.decimals$}", round(value * digit) / digit);
    let shown = text.parse().unwrap_or(value) * scale;
    (format!("{text} {}", UNITS[unit]), shown)
}

/// Maximum number of characters of a text on one line.
const LONGEST_LINE: usize = 1000;

/// The part of a text that fits in `width`, with an ellipsis if it is cut; `measure` returns the width of a text.
pub fn shortened(text: &str, width: f32, measure: impl Fn(&str) -> f32) -> String {
    let ends: Vec<usize> = text.char_indices().map(|(at, _)| at).take(LONGEST_LINE + 1).collect();
    if ends.len() <= LONGEST_LINE && measure(text) <= width {
        return text.to_string();
    }
    let cut = |letters: usize| format!("{}…", text[..ends.get(letters).copied().unwrap_or(text.len())].trim_end());
    // Binary search for the number of characters that fit: 0 fit, all do not.
    let (mut fits, mut most) = (0, ends.len().saturating_sub(1));
    while fits < most {
        let middle = (fits + most).div_ceil(2);
        if measure(&cut(middle)) <= width {
            fits = middle;
        } else {
            most = middle - 1;
        }
    }
    cut(fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_holds_as_much_as_fits_however_long_the_text() {
        let measured = std::cell::Cell::new(0usize);
        let measure = |text: &str| {
            measured.set(measured.get() + text.chars().count());
            text.chars().count() as f32
        };
        for (text, width, expect) in [
            ("short", 5.0, "short"),
            ("a longer one", 5.0, "a lo…"),
            ("a longer one", 3.0, "a…"),
            ("äöü ß", 3.0, "äö…"),
            ("x", 0.5, "…"),
            ("", 0.5, ""),
        ] {
            assert_eq!(shortened(text, width, measure), expect);
        }
        measured.set(0);
        let long = shortened(&"w".repeat(100_000), 80.0, measure);
        assert_eq!(long.chars().count(), 80);
        assert!(measured.get() < 20_000, "{} letters were measured", measured.get());
    }

    #[test]
    fn near_words() {
        let names = ["octaves", "lacunarity", "gain", "wavelength"];
        for (word, expect) in [
            ("octavs", Some("octaves")),
            ("Octaves", Some("octaves")),
            ("wavelenght", Some("wavelength")),
            ("gian", Some("gain")),
            ("persistence", None),
            ("", None),
            ("x", None),
        ] {
            assert_eq!(nearest(word, names), expect, "{word}");
        }
        for (word, candidate, near) in [
            ("scale", "cache", false),
            ("fmb", "fbm", true),
            ("ab", "cb", false),
            ("ab", "abc", true),
            ("abcd", "ab", false),
            ("layer", "player", true),
            ("size", "side", true),
            ("spacing", "scaling", true),
            ("seed", "speed", true),
            ("width", "height", false),
            ("format", "front", false),
            ("tile", "tiles", true),
        ] {
            assert_eq!(nearest(word, [candidate]).is_some(), near, "{word} {candidate}");
        }
    }

    #[test]
    fn sentences_stay_readable() {
        for (message, expect) in [
            ("short".to_string(), "short".to_string()),
            (format!("not {}, but 2.5", 1e308), "not 1e308, but 2.5".to_string()),
            (format!("not {}.", 1e-308), "not 1e-308.".to_string()),
            (format!("from {} to -{}", 1.5e40, 1e30), "from 1.5e40 to -1e30".to_string()),
            ("a checksum ab11111111111111111111111111111111111111 stays".into(), String::new()),
            ("0.1234567890123456789 m and 9007199254740993 m stay".into(), String::new()),
            (
                format!("no node `{}`, but `b`", "x".repeat(500)),
                format!("no node `{0}...{0}`, but `b`", "x".repeat(38)),
            ),
            (
                format!("`{}` and `{}`", "é".repeat(80), "é".repeat(81)),
                format!("`{}` and `{1}...{1}`", "é".repeat(80), "é".repeat(38)),
            ),
            (format!("one ` and {}", "y ".repeat(100)), String::new()),
        ] {
            let expect = if expect.is_empty() { message.clone() } else { expect };
            assert_eq!(readable(message), expect);
        }
    }

    #[test]
    fn sizes() {
        assert_eq!(bytes(12), "12 bytes");
        assert_eq!(bytes(1536), "1.5 KiB");
        assert_eq!(bytes(3 << 30), "3.0 GiB");
        assert_eq!(bytes(200 << 20), "200 MiB");
        assert_eq!(bytes(1), "1 byte");
    }

    #[test]
    fn a_need_and_its_limit_differ_in_their_texts() {
        const GIB: u64 = 1 << 30;
        for (needed, limit, expect) in [
            (2 * GIB, GIB, ["2.0 GiB", "1.0 GiB"]),
            (GIB + (GIB >> 8), GIB, ["1.1 GiB", "1.0 GiB"]),
            ((200 << 20) + (300 << 10), 200 << 20, ["201 MiB", "200 MiB"]),
            (GIB + 1, GIB, ["1.1 GiB", "1.0 GiB"]),
            (GIB + (GIB >> 8), GIB + (GIB >> 9), ["1.1 GiB", "1.0 GiB"]),
            ((1 << 30) + (150 << 20), (1 << 30) + (100 << 20), ["1.2 GiB", "1.1 GiB"]),
            (GIB + (65 << 20), GIB + (60 << 20), ["1.07 GiB", "1.06 GiB"]),
            // The same digits in two units.
            (GIB, GIB - (100 << 10), ["1.00 GiB", "1023.9 MiB"]),
            (1025, 1024, ["1.1 KiB", "1.0 KiB"]),
            (1001, 1000, ["1001 bytes", "1000 bytes"]),
            (GIB, GIB, ["1.0 GiB", "1.0 GiB"]),
            (u64::MAX, 3 * GIB, ["16384 PiB", "3.0 GiB"]),
        ] {
            assert_eq!(bytes_apart(needed, limit), expect, "{needed} {limit}");
        }
    }

    #[test]
    fn counts_and_numbers() {
        assert_eq!([0, 1, 2].map(|n| count(n, "tile")), ["0 tiles", "1 tile", "2 tiles"]);
        assert_eq!([0, 1, 1250].map(|n| percent(n, 100_000)), ["0.00 %", "less than 0.01 %", "1.25 %"]);
        for (value, expect) in [
            (8000.0 / 3.0, "2666.67"),
            (0.1 + 0.2, "0.3"),
            (10.0, "10"),
            (-0.000_123_456_7, "-0.000123457"),
            (1_234_567.89, "1234568"),
            (0.0, "0"),
            (1e308, "1e308"),
            (1e-9, "1e-9"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(value), expect);
        }
    }
}
