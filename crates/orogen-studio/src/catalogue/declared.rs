//! The Chinese of what is declared elsewhere: names and descriptions of ops, parameters, presets, palettes and formats.
//! What is English there is the key here, so a description that changes is reported by a test.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::LazyLock;

use super::{Language, read};

/// Names and descriptions.
#[derive(Default)]
struct Declared {
    names: HashMap<String, String>,
    texts: HashMap<String, String>,
}

static CHINESE: LazyLock<Declared> = LazyLock::new(|| {
    let mut declared = Declared::default();
    for (key, text) in read(include_str!("../../locales/declared.zh-CN.toml")) {
        match key.split_once('.') {
            Some(("names", name)) => drop(declared.names.insert(name.to_owned(), text)),
            Some(("texts", english)) => drop(declared.texts.insert(english.to_owned(), text)),
            _ => {}
        }
    }
    declared
});

impl Language {
    /// The name of something that is declared, such as an op, a parameter, a layer or a unit. What has no name in this
    /// language, such as a node of the user's, keeps its own.
    #[must_use]
    pub fn named(self, name: &str) -> &str {
        match self {
            Language::English => name,
            Language::Chinese => CHINESE.names.get(name).map_or(name, String::as_str),
        }
    }

    /// A declared description, whose paragraphs are separated by empty lines. The marks of code in it are left out: the
    /// window shows plain text.
    #[must_use]
    pub fn told(self, text: &str) -> Cow<'_, str> {
        let told = self.marked(text);
        if told.contains('`') { told.replace('`', "").into() } else { told }
    }

    /// A declared description with its marks of code.
    fn marked(self, text: &str) -> Cow<'_, str> {
        match self {
            Language::English => text.trim().into(),
            Language::Chinese => {
                let paragraphs = paragraphs(text).map(|english| match CHINESE.texts.get(&english) {
                    Some(chinese) => chinese.clone(),
                    None => english,
                });
                paragraphs.collect::<Vec<_>>().join("\n\n").into()
            }
        }
    }

    /// The description of something declared, for a hint: below its own name, if it is shown by another one.
    #[must_use]
    pub fn hint(self, name: &str, text: &str) -> String {
        match self.named(name) == name {
            true => self.told(text).into_owned(),
            false => format!("{name}\n\n{}", self.told(text)).trim_end().to_owned(),
        }
    }

    /// The first paragraph of a declared description.
    #[must_use]
    pub fn told_shortly(self, text: &str) -> String {
        let first = paragraphs(text).next().unwrap_or_default();
        self.told(&first).into_owned()
    }
}

/// The paragraphs of a text, each on one line.
fn paragraphs(text: &str) -> impl Iterator<Item = String> + '_ {
    let line = |paragraph: &str| paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    text.split("\n\n").map(line).filter(|line| !line.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::declare::{Shape, Spec};
    use orogen::export::targets::job::EngineJob;
    use orogen::export::targets::list as engines;
    use orogen::export::{derived::list, registry};
    use orogen::jobs::{MapJob, RenderJob};
    use orogen::options::{OptionSpec, ValueKind};
    use orogen::tilemap::TilemapJob;
    use orogen::tilemap::art::set::SETS;
    use std::collections::BTreeSet;

    /// What the studio shows of the declarations.
    #[derive(Default)]
    struct Shown {
        names: BTreeSet<String>,
        texts: BTreeSet<String>,
    }

    impl Shown {
        fn name(&mut self, name: &str) {
            self.names.extend((!name.is_empty()).then(|| name.to_owned()));
        }

        fn text(&mut self, text: &str) {
            self.texts.extend(paragraphs(text));
        }

        fn both(&mut self, name: &str, text: &str) {
            self.name(name);
            self.text(text);
        }

        fn op(&mut self, spec: &Spec) {
            self.both(spec.op, spec.doc);
            spec.inputs.iter().for_each(|input| self.both(input.name, input.doc));
            spec.layers.iter().for_each(|layer| self.both(layer.name, layer.doc));
            for param in spec.params {
                self.both(param.name, param.doc);
                self.name(param.unit);
                if let Shape::Choice(choices) = param.shape {
                    choices().into_iter().for_each(|(name, about)| self.both(name, about));
                }
            }
        }

        fn option(&mut self, spec: &OptionSpec) {
            // Options of jobs have labels in both catalogs.
            if Language::English.find(&format!("option.{}", spec.name)).is_none() {
                self.name(spec.name);
            }
            self.text(spec.about);
            if let ValueKind::Choice(choices) = spec.kind {
                choices.iter().for_each(|choice| self.text(choice.about));
            }
        }

        fn all() -> Shown {
            let mut shown = Shown::default();
            // The input that every node has.
            shown.name("mask");
            orogen::node::Node::all().iter().for_each(|node| shown.op(node.spec()));
            for preset in orogen::presets::all() {
                let recipe = preset.recipe().unwrap();
                shown.both(preset.name, &recipe.about);
                recipe.outputs().for_each(|output| shown.name(output));
                for parameter in recipe.parameters().iter() {
                    shown.both(&parameter.name, &parameter.help);
                    shown.name(&parameter.unit);
                }
            }
            list::all().iter().for_each(|layer| shown.both(layer.name, layer.about));
            orogen::io::palette::named::all().iter().for_each(|palette| shown.both(palette.name, palette.about));
            registry::all().iter().for_each(|format| shown.text(format.about));
            registry::options().iter().for_each(|(spec, _)| shown.option(spec));
            list::options().iter().for_each(|(spec, _)| shown.option(spec));
            for specs in [MapJob::OPTIONS, RenderJob::OPTIONS, TilemapJob::OPTIONS, EngineJob::OPTIONS] {
                specs.iter().for_each(|spec| shown.option(spec));
            }
            engines::all().iter().for_each(|target| shown.text(target.about));
            SETS.iter().for_each(|set| shown.text(set.about));
            shown
        }
    }

    #[test]
    fn all_that_is_declared_is_translated_and_nothing_else() {
        include_str!("../../locales/declared.zh-CN.toml").parse::<toml::Table>().unwrap();
        let shown = Shown::all();
        for (declared, translated, what) in
            [(&shown.names, &CHINESE.names, "names"), (&shown.texts, &CHINESE.texts, "texts")]
        {
            let missing: Vec<&String> = declared.iter().filter(|key| !translated.contains_key(*key)).collect();
            assert!(missing.is_empty(), "[{what}] of declared.zh-CN.toml lacks {missing:#?}");
            let unused: Vec<&String> = translated.keys().filter(|key| !declared.contains(*key)).collect();
            assert!(unused.is_empty(), "[{what}] of declared.zh-CN.toml has {unused:#?}, which nothing declares");
            assert!(translated.values().all(|text| !text.trim().is_empty()));
        }
        // A formula is the same in all languages.
        let is_chinese = |text: &str| text.chars().any(|c| ('\u{4e00}'..='\u{9fff}').contains(&c));
        let is_kept = |english: &str, text: &str| english.trim_end_matches('.') == text.trim_end_matches('。');
        let english: Vec<_> =
            CHINESE.texts.iter().filter(|(english, text)| !is_chinese(text) && !is_kept(english, text)).collect();
        assert!(english.is_empty(), "{english:#?}");
    }

    /// Numbers and what stands in backquotes are the same in both languages.
    #[test]
    fn identifiers_are_kept() {
        for (english, chinese) in &CHINESE.texts {
            for word in english.split('`').skip(1).step_by(2) {
                assert!(chinese.contains(&format!("`{word}`")), "`{word}` is not in {chinese:?}");
            }
        }
    }

    #[test]
    fn the_parameters_of_an_op_have_different_names() {
        for node in orogen::node::Node::all() {
            let spec = node.spec();
            let names = spec.params.iter().map(|param| param.name).chain(spec.inputs.iter().map(|input| input.name));
            let names: Vec<&str> = names.collect();
            let shown: BTreeSet<&str> = names.iter().map(|name| Language::Chinese.named(name)).collect();
            let distinct: BTreeSet<&&str> = names.iter().collect();
            assert_eq!(shown.len(), distinct.len(), "{}: {shown:?}", spec.op);
        }
    }

    #[test]
    fn what_is_unknown_keeps_its_name() {
        assert_eq!(Language::Chinese.named("my mountains"), "my mountains");
        assert_eq!(Language::Chinese.told("Nobody wrote this."), "Nobody wrote this.");
        assert_eq!(Language::English.told(" Heights.\n\nThe rest. "), "Heights.\n\nThe rest.");
        assert_eq!(Language::English.told_shortly("Two\nlines.\n\nThe rest."), "Two lines.");
    }
}
