//! The Chinese of errors and diagnostics, which the engine makes as English sentences. Templates with holes for values
//! are matched with a sentence, and values that are sentences themselves are translated the same way.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use super::{Language, read};

/// Maximum length of a sentence that is translated, in bytes.
const LONGEST: usize = 16 << 10;

/// Maximum nesting of sentences in sentences.
const DEEPEST: usize = 5;

/// Maximum number of templates that are tried for a sentence or a value, the longest first.
const TRIED: usize = 3;

/// Maximum number of sentences and values that are looked up for one message.
const LOOKUPS: usize = 500;

/// Maximum number of translations that are kept: the window shows the same messages in every frame.
const KEPT: usize = 256;

static CHINESE: LazyLock<Messages> =
    LazyLock::new(|| Messages::new(read(include_str!("../../locales/messages.zh-CN.toml"))));

static TOLD: LazyLock<Mutex<HashMap<String, Option<String>>>> = LazyLock::new(Mutex::default);

impl Language {
    /// An error or a diagnostic of the engine in this language. A message without a template stays in English, and
    /// names and values stay as they are.
    #[must_use]
    pub fn message(self, english: &str) -> Cow<'_, str> {
        if self == Language::English || english.len() > LONGEST {
            return english.into();
        }
        let mut told = TOLD.lock().unwrap_or_else(PoisonError::into_inner);
        if told.len() >= KEPT {
            told.clear();
        }
        let found = match told.get(english) {
            Some(found) => found,
            None => told.entry(english.to_owned()).or_insert_with(|| CHINESE.message(english)),
        };
        found.as_ref().map_or(english.into(), |chinese| chinese.clone().into())
    }
}

/// A part of a template.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Piece {
    Text(String),
    Hole(String),
}

/// The pieces of a template. `{{` and `}}` are braces, and what follows a colon in a hole is its format.
fn pieces(template: &str) -> Vec<Piece> {
    let (mut pieces, mut text) = (Vec::new(), String::new());
    let mut chars = template.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '{' | '}' if chars.peek() == Some(&c) => {
                chars.next();
                text.push(c);
            }
            '{' => {
                let hole: String = chars.by_ref().take_while(|c| *c != '}').collect();
                pieces.push(Piece::Text(std::mem::take(&mut text)));
                pieces.push(Piece::Hole(hole.split(':').next().unwrap_or_default().to_owned()));
            }
            c => text.push(c),
        }
    }
    pieces.push(Piece::Text(text));
    pieces
}

/// An English sentence with holes, and its Chinese.
struct Template {
    /// The texts before, between and after the holes.
    texts: Vec<String>,
    holes: Vec<String>,
    chinese: Vec<Piece>,
    /// Number of bytes of the texts.
    weight: usize,
}

impl Template {
    fn new(english: &str, chinese: &str) -> Template {
        let (mut texts, mut holes) = (Vec::new(), Vec::new());
        for piece in pieces(english) {
            match piece {
                Piece::Text(text) => texts.push(text),
                Piece::Hole(name) => holes.push(name),
            }
        }
        let weight = texts.iter().map(String::len).sum();
        Template { texts, holes, chinese: pieces(chinese), weight }
    }

    /// Whether the hole of this number is in quotes, so that its value is a name.
    fn is_quoted(&self, hole: usize) -> bool {
        let next = self.texts.get(hole + 1).map(String::as_str).unwrap_or_default();
        let before = self.texts.get(hole).map(String::as_str).unwrap_or_default();
        ['`', '"'].iter().any(|quote| before.ends_with(*quote) && next.starts_with(*quote))
    }

    /// The values of the holes, if the sentence has this form.
    fn values<'s>(&self, sentence: &'s str) -> Option<Vec<&'s str>> {
        let (first, others) = self.texts.split_first()?;
        let mut left = sentence.strip_prefix(first.as_str())?;
        let (last, between) = others.split_last()?;
        left = left.strip_suffix(last.as_str())?;
        let mut values = Vec::with_capacity(self.holes.len());
        for text in between {
            let (value, rest) = left.split_once(text.as_str())?;
            values.push(value);
            left = rest;
        }
        values.push(left);
        let is_value = |(hole, value): (usize, &&str)| {
            let ticks = value.bytes().filter(|byte| *byte == b'`').count();
            let same = self.holes.iter().position(|name| *name == self.holes[hole]);
            !value.is_empty()
                && ticks % 2 == 0
                && !(ticks > 0 && self.is_quoted(hole))
                && same.is_some_and(|same| values[same] == *value)
        };
        values.iter().enumerate().all(is_value).then_some(values)
    }
}

/// A translation, and how much of the English was known.
struct Told {
    chinese: String,
    weight: usize,
}

/// All templates.
#[derive(Default)]
struct Messages {
    /// Sentences without holes.
    plain: HashMap<String, String>,
    /// Templates that begin with a text, by its first byte.
    by_start: HashMap<u8, Vec<Template>>,
    /// Templates that begin with a hole.
    open: Vec<Template>,
    /// Nouns that follow a number.
    counted: HashMap<String, String>,
}

impl Messages {
    fn new(texts: super::Texts) -> Messages {
        let mut messages = Messages::default();
        for (key, chinese) in texts {
            let (table, english) = key.split_once('.').unwrap_or_default();
            if table == "counted" {
                messages.counted.insert(english.to_owned(), chinese);
                continue;
            }
            let template = Template::new(english, &chinese);
            let start = template.texts.first().and_then(|text| text.bytes().next());
            match (template.holes.is_empty(), start) {
                (true, _) => drop(messages.plain.insert(template.texts.concat(), filled(&template.chinese, |_| ""))),
                (false, Some(byte)) => messages.by_start.entry(byte).or_default().push(template),
                (false, None) => messages.open.push(template),
            }
        }
        messages
    }

    /// The Chinese of a message, which may have several lines; `None` if nothing of it is known.
    fn message(&self, english: &str) -> Option<String> {
        let mut lookups = LOOKUPS;
        let mut is_known = false;
        let lines = english.split('\n').map(|line| match self.sentence(line, 0, &mut lookups) {
            Some(told) => {
                is_known = true;
                told.chinese
            }
            None => line.to_owned(),
        });
        let lines: Vec<String> = lines.collect();
        is_known.then(|| lines.join("\n"))
    }

    /// The Chinese of a sentence, or of a value in one.
    fn sentence(&self, english: &str, depth: usize, lookups: &mut usize) -> Option<Told> {
        if depth > DEEPEST || *lookups == 0 {
            return None;
        }
        *lookups -= 1;
        self.by_template(english, depth, lookups)
            .or_else(|| self.counted(english))
            .or_else(|| self.list(english))
            .or_else(|| self.joined(english, depth, lookups))
            .or_else(|| self.located(english, depth, lookups))
    }

    /// By the template that knows most of it.
    fn by_template(&self, english: &str, depth: usize, lookups: &mut usize) -> Option<Told> {
        if let Some(chinese) = self.plain.get(english) {
            return Some(Told { chinese: chinese.clone(), weight: english.len() });
        }
        let start = english.bytes().next()?;
        let templates = self.by_start.get(&start).into_iter().flatten().chain(&self.open);
        let mut found: Vec<(&Template, Vec<&str>)> =
            templates.filter_map(|template| Some((template, template.values(english)?))).collect();
        found.sort_by_key(|(template, _)| std::cmp::Reverse(template.weight));
        found.truncate(TRIED);
        let told = found.into_iter().map(|(template, values)| {
            let mut weight = template.weight;
            let told: Vec<Cow<str>> = (values.into_iter().enumerate())
                .map(|(hole, value)| match template.is_quoted(hole) {
                    true => value.into(),
                    false => match self.sentence(value, depth + 1, lookups) {
                        Some(told) => {
                            weight += told.weight;
                            told.chinese.into()
                        }
                        None => value.into(),
                    },
                })
                .collect();
            let value = |name: &str| {
                let hole = template.holes.iter().position(|hole| hole == name);
                hole.and_then(|hole| told.get(hole)).map(Cow::as_ref).unwrap_or_default()
            };
            Told { chinese: filled(&template.chinese, value), weight }
        });
        // The last of several that know as much: the one with the shortest text, which is around the others.
        told.reduce(|best, other| if other.weight >= best.weight { other } else { best })
    }

    /// A number with its noun: "3 points".
    fn counted(&self, english: &str) -> Option<Told> {
        let (number, thing) = english.split_once(' ')?;
        number.parse::<u64>().ok()?;
        let noun = self.counted.get(thing).or_else(|| self.counted.get(thing.strip_suffix('s')?))?;
        Some(Told { chinese: format!("{number} {noun}"), weight: thing.len() })
    }

    /// A list of names and known words: "`a`, `b` and `c`".
    fn list(&self, english: &str) -> Option<Told> {
        let is_of_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
        let (mut chinese, mut weight, mut left) = (String::new(), 0, english);
        loop {
            let quote = left.chars().next().filter(|quote| matches!(quote, '`' | '"'));
            let end = match quote {
                Some(quote) => left.get(1..)?.find(quote)? + 2,
                None => {
                    left.find(", ").or_else(|| left.find(" and ")).or_else(|| left.find(" or ")).unwrap_or(left.len())
                }
            };
            let item = left.get(..end)?;
            let more = item.strip_suffix(" more").filter(|number| number.parse::<u64>().is_ok());
            match (quote, more, self.plain.get(item)) {
                (Some('`'), ..) => chinese.push_str(&format!("“{}”", item.trim_matches('`'))),
                (Some(_), ..) => chinese.push_str(item),
                (_, Some(number), _) => chinese.push_str(&format!("另外 {number} 个")),
                (.., Some(known)) => chinese.push_str(known),
                // A word that is no list.
                (.., None) if item.len() == english.len() || !item.chars().all(is_of_word) => return None,
                (.., None) => chinese.push_str(item),
            }
            weight += item.len();
            left = left.get(end..)?;
            if left.is_empty() {
                return Some(Told { chinese, weight });
            }
            let separators = [(", and ", "和"), (", or ", "或"), (", ", "、"), (" and ", "和"), (" or ", "或")];
            let (rest, separator) =
                separators.iter().find_map(|(english, chinese)| Some((left.strip_prefix(english)?, chinese)))?;
            chinese.push_str(separator);
            left = rest;
        }
    }

    /// Two sentences, separated by a semicolon.
    fn joined(&self, english: &str, depth: usize, lookups: &mut usize) -> Option<Told> {
        let (first, second) = english.rsplit_once("; ")?;
        let second = self.sentence(second, depth + 1, lookups)?;
        let first = self.sentence(first, depth + 1, lookups)?;
        Some(Told { chinese: format!("{}；{}", first.chinese, second.chinese), weight: first.weight + second.weight })
    }

    /// A sentence after the place that it is about, such as a file's name.
    fn located(&self, english: &str, depth: usize, lookups: &mut usize) -> Option<Told> {
        let (place, sentence) = english
            .match_indices(": ")
            .take(4)
            .map(|(at, colon)| (&english[..at], &english[at + colon.len()..]))
            .find(|(place, _)| !place.is_empty() && (!place.contains(' ') || place.contains(['/', '\\'])))?;
        let told = self.sentence(sentence, depth + 1, lookups)?;
        Some(Told { chinese: format!("{place}：{}", told.chinese), ..told })
    }
}

/// A template with the values of its holes. There is a space between Chinese and Latin letters only.
fn filled<'v>(pieces: &[Piece], value: impl Fn(&str) -> &'v str) -> String {
    let is_wide =
        |c: char| matches!(c, '\u{4e00}'..='\u{9fff}' | '“' | '”' | '（' | '）' | '、' | '，' | '；' | '：' | '。');
    let is_chinese = |c: char| ('\u{4e00}'..='\u{9fff}').contains(&c);
    let is_latin = |c: char| c.is_ascii_alphanumeric() || matches!(c, '"' | '`' | '-' | '[' | '{');
    let mut text = String::new();
    for piece in pieces {
        let part = match piece {
            Piece::Text(text) => text.as_str(),
            Piece::Hole(name) => value(name),
        };
        let (before, after) =
            (text.trim_end_matches(' ').chars().next_back(), part.trim_start_matches(' ').chars().next());
        let Some((before, after)) = before.zip(after) else {
            text.push_str(part);
            continue;
        };
        let has_space = text.ends_with(' ') || part.starts_with(' ');
        if has_space && is_wide(before) && is_wide(after) {
            text.truncate(text.trim_end_matches(' ').len());
            text.push_str(part.trim_start_matches(' '));
            continue;
        }
        let meet = is_chinese(before) && is_latin(after) || is_latin(before) && is_chinese(after);
        if !has_space && meet {
            text.push(' ');
        } else if text.ends_with(' ') && part.starts_with(' ') {
            text.pop();
        }
        text.push_str(part);
    }
    text
}

#[cfg(test)]
mod tests;
