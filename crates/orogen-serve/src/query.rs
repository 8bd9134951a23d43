//! Parameters of requests, after the question mark.

use orogen::grid::words;

use crate::refusal::Refusal;

/// The parameters of a request.
#[derive(Debug, Default)]
pub struct Query(Vec<(String, String)>);

/// Parameters of requests that are answered for a variant of the world: another seed, and `NAME=VALUE` for other
/// numbers, which may be given several times.
pub const SEED: &str = "seed";
pub const SET: &str = "set";

/// Parameters of every request: the token, and the version in links of descriptions.
const ALWAYS: [&str; 2] = ["token", "v"];

impl Query {
    /// Reads `name=value` pairs separated by `&`, with percent encoding.
    ///
    /// # Errors
    /// If the encoding is not valid, or a parameter is given twice.
    pub fn parse(text: &str) -> Result<Query, Refusal> {
        let mut pairs: Vec<(String, String)> = Vec::new();
        for pair in text.split('&').filter(|pair| !pair.is_empty()) {
            let (name, value) = pair.split_once('=').unwrap_or((pair, ""));
            let (name, value) = (decoded(name)?, decoded(value)?);
            if name != SET && pairs.iter().any(|(other, _)| *other == name) {
                return Err(Refusal::bad(format!("the parameter `{name}` is given twice; give it once")));
            }
            pairs.push((name, value));
        }
        Ok(Query(pairs))
    }

    /// Checks that there are no other parameters than these.
    ///
    /// # Errors
    /// If there are: the message names the closest one.
    pub fn only(&self, known: &[&str]) -> Result<(), Refusal> {
        let unknown =
            |name: &&(String, String)| !known.contains(&name.0.as_str()) && !ALWAYS.contains(&name.0.as_str());
        let Some((name, _)) = self.0.iter().find(unknown) else { return Ok(()) };
        let hint = match (words::nearest(name, known.iter().copied()), known) {
            (Some(near), _) => format!("did you mean `{near}`?"),
            (None, []) => "this request has none".into(),
            (None, known) => format!("it has {}", words::list(known.iter().copied())),
        };
        Err(Refusal::bad(format!("this request has no parameter `{name}`; {hint}")))
    }

    /// The parameters without those of these names, in upper or lower case.
    pub fn without(&self, names: &[&str]) -> Query {
        let is_kept = |name: &str| !names.iter().any(|other| other.eq_ignore_ascii_case(name));
        Query(self.0.iter().filter(|(name, _)| is_kept(name)).cloned().collect())
    }

    /// [`Query::only`] for requests that are answered for variants.
    ///
    /// # Errors
    /// If there are other parameters.
    pub fn only_of_variants(&self, known: &[&str]) -> Result<(), Refusal> {
        let known: Vec<&str> = known.iter().copied().chain([SEED, SET]).collect();
        self.only(&known)
    }

    /// The value of a parameter; an empty one counts as not given.
    pub fn get(&self, name: &str) -> Option<&str> {
        let found = self.0.iter().find(|(own, _)| own == name)?;
        Some(found.1.as_str()).filter(|value| !value.is_empty())
    }

    /// The parameters as one text, without those of every request.
    pub fn text(&self) -> String {
        let own = self.0.iter().filter(|(name, _)| !ALWAYS.contains(&name.as_str()));
        own.map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join("&")
    }

    /// All names and values.
    pub fn pairs(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value.as_str()))
    }

    /// A number.
    ///
    /// # Errors
    /// If it is not a finite number.
    pub fn number(&self, name: &str) -> Result<Option<f64>, Refusal> {
        let Some(text) = self.get(name) else { return Ok(None) };
        match text.trim().parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(Refusal::bad(format!("`{name}` must be a number, such as 12.5, not `{text}`"))),
        }
    }

    /// A number of samples.
    ///
    /// # Errors
    /// If it is not in this range.
    pub fn count(&self, name: &str, range: std::ops::RangeInclusive<usize>) -> Result<Option<usize>, Refusal> {
        let Some(text) = self.get(name) else { return Ok(None) };
        match text.trim().parse::<usize>() {
            Ok(count) if range.contains(&count) => Ok(Some(count)),
            _ => Err(Refusal::bad(format!(
                "`{name}` must be a whole number from {} to {}, not `{text}`",
                range.start(),
                range.end()
            ))),
        }
    }
}

/// Percent-decodes a name or a value; `+` is a space.
fn decoded(text: &str) -> Result<String, Refusal> {
    let wrong = || Refusal::bad(format!("`{text}` is not percent-encoded UTF-8, such as `a%20b`"));
    let digit = |byte: Option<u8>| byte.and_then(|byte| char::from(byte).to_digit(16));
    let (mut bytes, mut rest) = (Vec::with_capacity(text.len()), text.bytes());
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'+' => b' ',
            b'%' => {
                let (high, low) = (digit(rest.next()), digit(rest.next()));
                (high.ok_or_else(wrong)? * 16 + low.ok_or_else(wrong)?) as u8
            }
            byte => byte,
        });
    }
    String::from_utf8(bytes).map_err(|_| wrong())
}

/// Percent-encodes a value for a link.
pub fn encoded(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for byte in text.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' => out.push(char::from(byte)),
            byte => out.push_str(&format!("%{byte:02X}")),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_read_and_unknown_ones_are_named() {
        let query = Query::parse("a=1%2C2&b=x+y&c&&d=").unwrap();
        assert_eq!(
            (query.get("a"), query.get("b"), query.get("c"), query.get("d")),
            (Some("1,2"), Some("x y"), None, None)
        );
        assert!(query.only(&["a", "b", "c", "d"]).is_ok());
        let token = Query::parse("token=x&v=1").unwrap();
        assert!(token.only(&[]).is_ok());
        for (text, expect) in [
            ("bbx=1", "no parameter `bbx`; did you mean `bbox`?"),
            ("zzzzzz=1", "it has `bbox` and `width`"),
            ("a=%zz", "percent-encoded"),
            ("a=%ff", "percent-encoded"),
            ("a=%4", "percent-encoded"),
            ("a=1&a=2", "given twice"),
            ("seed=1&seed=2", "given twice"),
            ("set=a=1&set=b=2", "no parameter `set`"),
        ] {
            let refusal = Query::parse(text).and_then(|query| query.only(&["bbox", "width"])).unwrap_err();
            assert!(refusal.message.contains(expect), "{text}: {}", refusal.message);
        }
        assert!(Query::parse("x=1e400").unwrap().number("x").is_err());
        assert!(Query::parse("n=-1").unwrap().count("n", 1..=9).unwrap_err().message.contains("from 1 to 9"));
        for text in ["a b/ä%", "", "\0"] {
            assert_eq!(decoded(&encoded(text)).unwrap(), text);
        }
    }
}
