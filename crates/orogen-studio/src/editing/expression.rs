//! Expressions and formulas while they are typed: their errors with positions, and completions.

use std::ops::Range;

use orogen::expression::Expression;
use orogen::recipe::Recipe;
use orogen::value::Value;

use super::document::Document;
use super::edit::Edit;

/// The position of an expression in a recipe.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Site {
    /// The node.
    pub node: String,
    /// The parameter.
    pub key: String,
    /// Whether it is a formula for a number, which begins with `=` in the recipe.
    pub is_formula: bool,
}

/// An error in an expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpressionDiagnostic {
    /// The position, in bytes of the expression.
    pub span: Range<usize>,
    /// The error, and how to fix it.
    pub message: String,
}

/// A word that an expression may contain.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Word {
    /// The word.
    pub text: String,
    /// Its description.
    pub about: String,
}

impl Site {
    /// The edit that sets the expression.
    #[must_use]
    pub fn edit(&self, text: &str) -> Edit {
        let text = if self.is_formula { format!("={text}") } else { text.to_owned() };
        Edit::Param { node: self.node.clone(), key: self.key.clone(), value: Value::Text(text) }
    }

    /// Checks an expression that replaces the one in the recipe.
    ///
    /// # Errors
    /// The error and its position.
    pub fn check(&self, document: &Document, text: &str) -> Result<(), ExpressionDiagnostic> {
        let expression = Expression::from(text);
        if let Some(error) = expression.error() {
            return Err(ExpressionDiagnostic {
                span: visible(text, error.span.clone()),
                message: error.message.clone(),
            });
        }
        let error = match document.check(&self.edit(text)) {
            Ok(()) => return Ok(()),
            Err(error) => error,
        };
        let message = error.diagnostics().first().map_or_else(|| error.to_string(), |first| first.message.clone());
        // The message need not name the node and parameter, because the field shows them.
        let message = match message.split_once("`: ") {
            Some((at, what)) if at.starts_with(&format!("node `{}`", self.node)) => what.to_owned(),
            _ => message,
        };
        // The name that the message mentions, otherwise the whole expression.
        let has = |part: &str| message.contains(&format!("`{part}`"));
        let is_meant =
            |name: &&String| has(name) || name.split_once('.').is_some_and(|(node, layer)| has(node) && has(layer));
        let named = expression.names().iter().find(is_meant);
        let span = named.and_then(|name| place_of(text, name)).unwrap_or(0..text.len());
        Err(ExpressionDiagnostic { span: visible(text, span), message })
    }

    /// The words that the expression may contain: functions, parameters, and, unless it is a formula, nodes and their
    /// layers.
    #[must_use]
    pub fn words(&self, recipe: &Recipe) -> Vec<Word> {
        let functions = Expression::functions()
            .map(|(name, usage, about)| Word { text: format!("{name}("), about: format!("{usage}: {about}") });
        let parameters =
            recipe.parameters().iter().map(|known| Word { text: known.name.clone(), about: known.help.clone() });
        let mut words: Vec<Word> = parameters.collect();
        if !self.is_formula {
            for named in recipe.nodes().iter().filter(|named| named.name != self.node && is_word(&named.name)) {
                let spec = named.node.spec();
                let about = orogen::declare::short(spec.doc).to_owned();
                words.push(Word { text: named.name.clone(), about: format!("{}: {about}", spec.op) });
                words.extend(named.node.layers().iter().skip(1).map(|layer| Word {
                    text: format!("{}.{}", named.name, layer.name),
                    about: layer.doc.trim().to_owned(),
                }));
            }
        }
        words.extend(functions);
        words
    }
}

/// Whether a name can be written in an expression as it is.
fn is_word(name: &str) -> bool {
    Expression::from(name).names() == [name]
}

/// A visible span: at least one character; at the end of the text, the last one.
fn visible(text: &str, span: Range<usize>) -> Range<usize> {
    let end = text.len();
    let start = span.start.min(end);
    match span.end.min(end) {
        to if to > start => start..to,
        _ => match text.get(start..).and_then(|rest| rest.chars().next()) {
            Some(c) => start..start + c.len_utf8(),
            None => text.char_indices().next_back().map_or(0..0, |(at, _)| at..end),
        },
    }
}

fn is_part(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '.')
}

/// The position of a name in an expression, as a whole word.
fn place_of(text: &str, name: &str) -> Option<Range<usize>> {
    text.match_indices(name).map(|(at, _)| at..at + name.len()).find(|span| {
        let before = text.get(..span.start).and_then(|before| before.chars().next_back());
        let after = text.get(span.end..).and_then(|after| after.chars().next());
        !before.is_some_and(is_part) && !after.is_some_and(is_part)
    })
}

/// The word that ends at a byte of a text.
#[must_use]
pub fn word_at(text: &str, cursor: usize) -> Range<usize> {
    let before = text.get(..cursor).unwrap_or(text);
    let length: usize = before.chars().rev().take_while(|c| is_part(*c)).map(char::len_utf8).sum();
    before.len() - length..before.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "orogen = 1\n[parameters]\nrelief = { default = 900, range = [0, 5000], help = \"the height\" }\n[world]\nsize = \
                        1000\n[nodes.hills]\nop = \"fbm\"\n[nodes.water]\nop = \"drainage\"\nsource = \"hills\"\n[nodes.land]\nop = \"expr\"\nexpr = \
                        \"hills * 100\"\n[nodes.wide]\nop = \"fbm\"\nwavelength = \"= relief / 2\"\n[outputs]\nheight = \"land\"\n";

    fn document() -> Document {
        Document::new("test", TEXT.into()).unwrap()
    }

    fn site(node: &str, key: &str, is_formula: bool) -> Site {
        Site { node: node.into(), key: key.into(), is_formula }
    }

    #[test]
    fn faults_are_told_where_they_are() {
        let document = document();
        let expr = site("land", "expr", false);
        assert_eq!(expr.check(&document, "hills * relief + sqrt(water.flow)").err(), None);
        for (text, span, part) in [
            ("hills * ", 7..8, ""),
            ("hills * (2 + 1", 0..0, "`)`"),
            ("hils * 2", 0..4, "hils"),
            ("2 * hills.nothing", 4..17, "nothing"),
            ("sqrt(hills, 3)", 0..0, "sqrt"),
            ("", 0..0, ""),
        ] {
            let fault = expr.check(&document, text).unwrap_err();
            assert!(fault.message.contains(part) && fault.message.len() > 10, "{text}: {fault:?}");
            assert!(span.is_empty() || fault.span == span, "{text}: {fault:?}");
            assert!(
                text.get(fault.span.clone()).is_some_and(|part| text.is_empty() || !part.is_empty()),
                "{text}: {fault:?}"
            );
        }
        let formula = site("wide", "wavelength", true);
        assert_eq!(formula.check(&document, " relief * 3").err(), None);
        assert_eq!(formula.check(&document, " releif").unwrap_err().span, 1..7);
        // Out of the range of the parameter.
        let low = formula.check(&document, "-relief").unwrap_err();
        assert!(low.message.contains("wavelength") && low.span == (0..7), "{low:?}");
        assert_eq!(document.text(), TEXT);
    }

    #[test]
    fn expressions_are_set() {
        let mut document = document();
        document.apply(&site("wide", "wavelength", true).edit(" relief * 3")).unwrap();
        assert_eq!(document.recipe().formula("wide", "wavelength"), Some(" relief * 3"));
        document.apply(&site("land", "expr", false).edit("hills * relief")).unwrap();
        assert!(document.text().contains("expr = \"hills * relief\""));
    }

    #[test]
    fn words_are_those_that_fit() {
        let document = document();
        let texts = |site: Site| site.words(document.recipe()).into_iter().map(|word| word.text).collect::<Vec<_>>();
        let all = texts(site("land", "expr", false));
        for word in ["hills", "water.receiver", "relief", "sqrt("] {
            assert!(all.iter().any(|known| known == word), "{word} in {all:?}");
        }
        assert!(!all.contains(&"land".to_owned()));
        assert!(!texts(site("wide", "wavelength", true)).contains(&"hills".to_owned()));
        assert_eq!((word_at("a + hil", 7), word_at("a + ", 4), word_at("é.x", 4)), (4..7, 4..4, 0..4));
    }
}
