//! Well-known text of coordinate systems: a parser, and recognition of the systems of [`epsg`].
//!
//! OGC 01-009 (WKT 1) and ESRI's dialect of it are compared by parameters. From WKT 2 (OGC 18-010) only the EPSG code
//! is used.

use std::ops::Range;

use super::epsg;
use super::system::System;
use super::unit::metres_of_vertical;

/// Maximum length of a text, in bytes.
pub const MAX_LENGTH: usize = 1 << 15;

/// Maximum nesting depth; real texts have 6.
const MAX_DEPTH: usize = 24;

/// A node: `KEYWORD[...]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The keyword in capital letters.
    pub keyword: String,
    /// The values between the brackets.
    pub values: Vec<Value>,
    /// The range of bytes in the text.
    pub span: Range<usize>,
}

/// A value between brackets.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A text in quotes.
    Text(String),
    /// A number.
    Number(f64),
    /// A word, such as an axis direction.
    Word(String),
    /// A node.
    Node(Node),
}

impl Node {
    /// Parses a text.
    ///
    /// # Errors
    /// A message if it is not well-known text.
    pub fn parse(text: &str) -> Result<Node, String> {
        if text.len() > MAX_LENGTH {
            return Err(format!("the definition of its coordinate system has {} bytes, which is too long", text.len()));
        }
        let mut reader = Reader { bytes: text.as_bytes(), at: 0 };
        let mut node = reader.next_node(0)?;
        // ESRI writes a vertical system after the horizontal one; together they form a compound system.
        if reader.eat(b",") {
            let vertical = reader.next_node(0)?;
            let span = node.span.start..vertical.span.end;
            let values = vec![Value::Node(node), Value::Node(vertical)];
            node = Node { keyword: "COMPD_CS".into(), values, span };
        }
        reader.blanks();
        match reader.at == reader.bytes.len() {
            true => Ok(node),
            false => Err("its well-known text continues after its last bracket".into()),
        }
    }

    /// The first child node with one of these keywords.
    pub fn child(&self, keywords: &[&str]) -> Option<&Node> {
        self.children().find(|node| keywords.contains(&node.keyword.as_str()))
    }

    fn children(&self) -> impl Iterator<Item = &Node> {
        self.values.iter().filter_map(|value| match value {
            Value::Node(node) => Some(node),
            _ => None,
        })
    }

    /// The text at index `at`.
    fn text(&self, at: usize) -> Option<&str> {
        match self.values.get(at)? {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The number at index `at`.
    fn number(&self, at: usize) -> Option<f64> {
        match self.values.get(at)? {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The EPSG code that the node states.
    fn code(&self) -> Option<u16> {
        let node = self.child(&["AUTHORITY", "ID"])?;
        if !node.text(0)?.eq_ignore_ascii_case("EPSG") {
            return None;
        }
        match node.values.get(1)? {
            Value::Text(code) => code.trim().parse().ok(),
            Value::Number(code) if code.fract() == 0.0 && (1.0..65536.0).contains(code) => Some(*code as u16),
            _ => None,
        }
    }

    /// Metres per unit of the vertical part of a compound system; `None` if it has none.
    pub fn vertical_metres(&self) -> Option<f64> {
        const VERTICAL: &[&str] = &["VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"];
        let mut node = self;
        while !VERTICAL.contains(&node.keyword.as_str()) {
            node = match node.keyword.as_str() {
                "COMPD_CS" | "COMPOUNDCRS" => node.child(VERTICAL).or_else(|| node.child(&["BOUNDCRS"]))?,
                "BOUNDCRS" => node.child(&["SOURCECRS"])?,
                "SOURCECRS" => node.children().next()?,
                _ => return None,
            };
        }
        match (node.stated_metres(), node.code()) {
            (Some(metres), _) => Some(metres),
            (None, Some(code)) => Some(metres_of_vertical(code)),
            (None, None) => Some(1.0),
        }
    }

    /// The horizontal part of a compound system.
    pub fn horizontal(&self) -> &Node {
        const HORIZONTAL: &[&str] =
            &["PROJCS", "GEOGCS", "PROJCRS", "PROJECTEDCRS", "GEOGCRS", "GEOGRAPHICCRS", "GEODCRS", "GEODETICCRS"];
        let mut node = self;
        for _ in 0..MAX_DEPTH {
            let inner = match node.keyword.as_str() {
                "COMPD_CS" | "COMPOUNDCRS" => node.child(HORIZONTAL),
                "BOUNDCRS" => node.child(&["SOURCECRS"]),
                "SOURCECRS" => node.children().next(),
                _ => None,
            };
            match inner {
                Some(inner) => node = inner,
                None => break,
            }
        }
        node
    }

    /// Whether its coordinates are degrees.
    pub fn is_geographic(&self) -> bool {
        matches!(self.horizontal().keyword.as_str(), "GEOGCS" | "GEOGCRS" | "GEOGRAPHICCRS" | "GEODCRS" | "GEODETICCRS")
    }

    /// Whether it is a projected system; false for a vertical system and a system without a position on Earth.
    pub fn is_projected(&self) -> bool {
        matches!(self.horizontal().keyword.as_str(), "PROJCS" | "PROJCRS" | "PROJECTEDCRS")
    }

    /// Metres per unit of a projected system; 1 if it does not state the unit.
    pub fn metres(&self) -> f64 {
        if self.is_geographic() {
            return 1.0;
        }
        self.horizontal().stated_metres().unwrap_or(1.0)
    }

    /// Metres per unit of length that the node states, itself or in its axes.
    fn stated_metres(&self) -> Option<f64> {
        self.stated_unit(&["UNIT", "LENGTHUNIT"])
    }

    /// Radians per unit of a geographic system; `None` if it does not state the unit.
    pub fn radians(&self) -> Option<f64> {
        if !self.is_geographic() {
            return None;
        }
        self.horizontal().stated_unit(&["UNIT", "ANGLEUNIT"])
    }

    fn stated_unit(&self, keywords: &[&str]) -> Option<f64> {
        let unit = self.child(keywords).or_else(|| {
            self.children()
                .filter(|node| matches!(node.keyword.as_str(), "CS" | "AXIS"))
                .find_map(|node| node.child(keywords))
        });
        unit.and_then(|unit| unit.number(1)).filter(|size| size.is_finite() && *size > 0.0)
    }

    /// The EPSG code of the system: the stated one, otherwise the code of a known system with the same parameters.
    pub fn epsg(&self) -> Option<u16> {
        let node = self.horizontal();
        if let Some(code) = node.code() {
            return Some(code);
        }
        let degrees = if node.keyword == "PROJCS" { node.child(&["GEOGCS"])? } else { node };
        let datum = plain(degrees.child(&["DATUM"])?.text(0)?);
        let spheroid = degrees.child(&["DATUM"])?.child(&["SPHEROID"])?;
        let (radius, flattening) = (spheroid.number(1)?, spheroid.number(2)?);
        let meridian = degrees.child(&["PRIMEM"]).and_then(|node| node.number(1)).unwrap_or(0.0);
        if meridian != 0.0 {
            return None;
        }
        // Known systems are in degrees.
        if node.radians().is_some_and(|radians| (radians - 1f64.to_radians()).abs() > 1e-6) {
            return None;
        }
        let metres = self.metres();
        epsg::codes().find(|code| {
            epsg::find(*code).is_some_and(|system| {
                let known = &system.geographic;
                [known.datum, known.datum_ogc].iter().any(|name| plain(name) == datum)
                    && (known.radius - radius).abs() < 1e-3
                    && (known.flattening - flattening).abs() < 1e-6
                    && system.projection.is_some() == (node.keyword == "PROJCS")
                    && (system.unit - metres).abs() < 1e-9
                    && node.has_parameters_of(&system)
            })
        })
    }

    /// Whether a projected system has exactly the parameters of a known one.
    fn has_parameters_of(&self, system: &System) -> bool {
        let Some((method, parameters)) = &system.projection else { return true };
        let (name, names) = method.terms();
        let Some(said) = self.child(&["PROJECTION"]).and_then(|node| node.text(0)) else { return false };
        // The same projection has two names.
        let one = |name: &str| plain(name).replace("gausskruger", "transversemercator");
        if one(said) != one(name) {
            return false;
        }
        let said = |name: &str| {
            let mut all = self.children().filter(|node| node.keyword == "PARAMETER");
            all.find(|node| node.text(0).is_some_and(|own| own.eq_ignore_ascii_case(name)))
                .and_then(|node| node.number(1))
        };
        let count = self.children().filter(|node| node.keyword == "PARAMETER").count();
        count == names.len()
            && names
                .iter()
                .zip(parameters)
                .all(|(name, value)| said(name).is_some_and(|own| (own - value).abs() <= 1e-9 * value.abs().max(1.0)))
    }
}

/// A name without variations between writers: case, blanks, underscores, a D before a datum.
fn plain(name: &str) -> String {
    let name = name.strip_prefix("D_").unwrap_or(name);
    name.chars().filter(|c| c.is_alphanumeric() || *c == '+').flat_map(char::to_lowercase).collect()
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn blanks(&mut self) {
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    fn eat(&mut self, any: &[u8]) -> bool {
        self.blanks();
        let there = self.bytes.get(self.at).is_some_and(|byte| any.contains(byte));
        self.at += usize::from(there);
        there
    }

    /// The text up to the next bracket, comma or blank.
    fn word(&mut self) -> String {
        self.blanks();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|b| b"[](),\"".contains(b) || b.is_ascii_whitespace()).unwrap_or(rest.len());
        self.at += length;
        String::from_utf8_lossy(&rest[..length]).into_owned()
    }

    /// A quoted text; two double quotes stand for one.
    fn quoted(&mut self) -> Result<String, String> {
        let mut text = Vec::new();
        loop {
            let Some(byte) = self.bytes.get(self.at) else {
                return Err("its well-known text ends within quotes".into());
            };
            self.at += 1;
            if *byte == b'"' {
                if self.bytes.get(self.at) != Some(&b'"') {
                    return Ok(String::from_utf8_lossy(&text).into_owned());
                }
                self.at += 1;
            }
            text.push(*byte);
        }
    }

    /// The node that begins after any blanks.
    fn next_node(&mut self, depth: usize) -> Result<Node, String> {
        self.blanks();
        let start = self.at;
        let keyword = self.word();
        self.node(keyword, start, depth)
    }

    fn node(&mut self, keyword: String, start: usize, depth: usize) -> Result<Node, String> {
        let known = !keyword.is_empty() && keyword.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !known || depth > MAX_DEPTH || !self.eat(b"[(") {
            return Err("it is not the well-known text of a coordinate system".into());
        }
        let mut values = Vec::new();
        loop {
            if self.eat(b"\"") {
                values.push(Value::Text(self.quoted()?));
            } else {
                self.blanks();
                let start = self.at;
                let word = self.word();
                self.blanks();
                if self.bytes.get(self.at).is_some_and(|byte| b"[(".contains(byte)) {
                    values.push(Value::Node(self.node(word, start, depth + 1)?));
                } else {
                    values.push(match word.parse() {
                        Ok(number) => Value::Number(number),
                        Err(_) => Value::Word(word),
                    });
                }
            }
            if self.eat(b"])") {
                return Ok(Node { keyword: keyword.to_ascii_uppercase(), values, span: start..self.at });
            }
            if !self.eat(b",") {
                return Err("its well-known text lacks a comma or a bracket".into());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_recognised() {
        for code in epsg::codes() {
            let system = epsg::find(code).unwrap();
            let node = Node::parse(&system.to_wkt()).unwrap();
            let found = node.epsg().unwrap();
            // Of two codes with the same parameters, the first is returned.
            let same = epsg::find(found).unwrap();
            assert_eq!(
                (same.projection, same.geographic.datum),
                (system.projection.clone(), system.geographic.datum),
                "{code}"
            );
            assert_eq!(node.is_geographic(), system.projection.is_none());
        }
    }

    #[test]
    fn other_dialects_are_understood() {
        for (text, expect) in [
            (
                r#"GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]"#,
                Some(4326),
            ),
            (r#"PROJCS["x",GEOGCS["y"],AUTHORITY["EPSG","32632"]]"#, Some(32632)),
            (r#"PROJCRS["x",BASEGEOGCRS["y"],CS[Cartesian,2],LENGTHUNIT["metre",1],ID["EPSG",2154]]"#, Some(2154)),
            (r#"COMPD_CS["x",PROJCS["y",AUTHORITY["EPSG","25832"]],VERT_CS["z"]]"#, Some(25832)),
            (
                r#"PROJCS["x",GEOGCS["y",DATUM["D_WGS_1984",SPHEROID["s",1,2]]],PROJECTION["Transverse_Mercator"]]"#,
                None,
            ),
        ] {
            assert_eq!(Node::parse(text).unwrap().epsg(), expect, "{text}");
        }
        let feet =
            Node::parse(r#"PROJCS["x",GEOGCS["y",UNIT["Degree",0.017]],UNIT["Foot_US",0.3048006096012192]]"#).unwrap();
        assert!((feet.metres() - 0.304_800_609_6).abs() < 1e-9 && feet.is_projected());
    }

    #[test]
    fn what_is_no_text_is_a_sentence() {
        for text in
            ["", "PROJCS", "PROJCS[", "PROJCS[\"a", "PROJCS[\"a\"]x", "Projection UTM\nZone 11", &"A[".repeat(200)]
        {
            assert!(Node::parse(text).is_err(), "{text}");
        }
    }
}
