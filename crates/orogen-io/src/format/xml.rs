//! XML documents, checked before they are parsed.

use roxmltree::{Document, ParsingOptions};

/// Maximum number of elements, texts and comments.
const MAX_NODES: u32 = 1 << 20;

/// Maximum number of attributes of an element. The parser compares each with all others.
const MAX_ATTRIBUTES: usize = 256;

/// Parses a document. With `allow_dtd`, it may declare a document type.
///
/// # Errors
/// A message if it is not XML, or too large to be parsed in a short time.
pub fn parse(text: &str, allow_dtd: bool) -> Result<Document<'_>, String> {
    if let Some(element) = crowded(text) {
        return Err(format!("its element `{element}` has more than {MAX_ATTRIBUTES} attributes"));
    }
    let options = ParsingOptions { allow_dtd, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|cause| format!("it is not valid XML ({cause})"))
}

/// The name of the first element with too many attributes. Invalid XML is left to the parser.
fn crowded(text: &str) -> Option<&str> {
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        rest = &rest[start + 1..];
        let closed = [("!--", "-->"), ("![CDATA[", "]]>"), ("?", "?>")];
        if let Some((_, end)) = closed.iter().find(|(start, _)| rest.starts_with(start)) {
            rest = &rest[rest.find(end)? + end.len()..];
            continue;
        }
        // A document type, followed by its declarations.
        if rest.starts_with('!') {
            continue;
        }
        let tag = rest;
        let mut attributes = 0;
        // The next special character outside of quoted values.
        while let Some(at) = rest.find(['"', '\'', '>', '<']) {
            let (mark, after) = (&rest[at..=at], &rest[at + 1..]);
            if matches!(mark, ">" | "<") {
                rest = if mark == ">" { after } else { &rest[at..] };
                break;
            }
            attributes += 1;
            if attributes > MAX_ATTRIBUTES {
                return tag.split([' ', '\t', '\r', '\n', '/']).next();
            }
            rest = &after[after.find(mark)? + 1..];
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn element(count: usize) -> String {
        let attributes: String = (0..count).map(|k| format!(" a{k}='>{k}'")).collect();
        format!("<svg><g{attributes}/></svg>")
    }

    #[test]
    fn an_element_with_too_many_attributes_is_refused_before_it_is_parsed() {
        assert!(parse(&element(256), false).is_ok());
        assert_eq!(parse(&element(257), false).unwrap_err(), "its element `g` has more than 256 attributes");
        assert!(parse(&element(2_000_000), false).unwrap_err().contains("more than 256 attributes"));
        // Text that only looks like attributes.
        let quotes = "'a' ".repeat(400);
        for text in [
            format!("<a><!-- <b {quotes}> --></a>"),
            format!("<a>{quotes}</a>"),
            format!("<a><![CDATA[<b {quotes}>]]></a>"),
        ] {
            assert!(parse(&text, false).is_ok(), "{text}");
        }
        for text in ["", "<", "<a", "<a b='", "<!-- ", "a > b", "<a b='1'<c/>"] {
            assert!(parse(text, false).unwrap_err().contains("not valid XML"), "{text}");
        }
    }
}
