//! Rows of fields for declared options.

use std::borrow::Cow;
use std::ops::RangeInclusive;

use eframe::egui::{Checkbox, DragValue, Grid, Response, Role, TextEdit, Ui, WidgetInfo};
use orogen::io::palette::color::hex;
use orogen::io::palette::names::hexadecimal;
use orogen::io::palette::{Rgb, named};
use orogen::options::{Component, OptionSpec, ValueKind};
use orogen::output::sheet::paper;
use orogen::tilemap::art::set::SETS;

use super::rows::{self, WIDTH};
use crate::catalogue::Language;
use crate::export::given::{Given, WITHOUT_FIELD, applies};

/// Number of columns of the parts.
const COLUMNS: usize = 3;

/// The word for a value that is chosen from the data.
const AUTO: &str = "auto";

/// What fields need in addition to their declarations.
pub struct Fields<'a> {
    /// The language.
    pub language: Language,
    /// The layers that can be chosen.
    pub layers: Vec<String>,
    /// The default title.
    pub title: &'a str,
}

/// The fields of declared options. Options that do not apply together with the given ones have no field.
pub struct OptionRows<'a> {
    /// The context of the fields.
    pub fields: &'a Fields<'a>,
    /// The declarations.
    pub specs: &'static [OptionSpec],
    /// The given options.
    pub given: &'a mut Given,
}

impl OptionRows<'_> {
    /// Shows a row for each option except the parts.
    pub fn rows(&mut self, ui: &mut Ui) {
        for spec in self.specs.iter().filter(|spec| !is_part(spec) && !WITHOUT_FIELD.contains(&spec.name)) {
            if applies(spec, self.specs, self.given) {
                ui.label(self.label(spec)).on_hover_text(self.fields.language.told(spec.about));
                self.field(ui, spec);
                ui.end_row();
            }
        }
    }

    /// Shows the parts that can be switched off, in columns.
    pub fn parts(&mut self, ui: &mut Ui) {
        ui.add_space(4.0);
        ui.strong(self.fields.language.text("export.parts"));
        Grid::new("parts").num_columns(COLUMNS).spacing([16.0, 4.0]).show(ui, |ui| {
            let parts = self.specs.iter().filter(|spec| is_part(spec) && !WITHOUT_FIELD.contains(&spec.name));
            for (nth, spec) in parts.enumerate() {
                let is_enabled = applies(spec, self.specs, self.given);
                let label = self.label(spec);
                ui.add_enabled_ui(is_enabled, |ui| self.switch(ui, spec, &label));
                if nth % COLUMNS == COLUMNS - 1 {
                    ui.end_row();
                }
            }
        });
    }

    /// The name of an option; options of formats and layers have the words of the command line.
    fn label(&self, spec: &OptionSpec) -> Cow<'static, str> {
        match self.fields.language.find(&format!("option.{}", spec.name)) {
            Some(label) => label.into(),
            None => match self.fields.language.named(spec.name) {
                name if name == spec.name => sentence(name).into(),
                name => name.to_owned().into(),
            },
        }
    }

    /// The name of a choice.
    fn choice(&self, spec: &OptionSpec, word: &str) -> Option<&'static str> {
        self.fields.language.find(&format!("choice.{}-{word}", spec.name))
    }

    /// An item of a list: something declared that is shown by its name.
    fn name(&self, name: &str) -> (String, String) {
        (name.to_owned(), self.fields.language.named(name).to_owned())
    }

    /// An item of a list: a name and its text.
    fn item(&self, spec: &OptionSpec, name: &str, about: &str) -> (String, String) {
        let text = self
            .choice(spec, name)
            .map_or_else(|| format!("{name}  {}", self.fields.language.told(about)), str::to_owned);
        (name.to_owned(), text)
    }

    /// The given value, or else the default.
    fn value(&self, spec: &OptionSpec) -> String {
        self.given.get(spec.name).cloned().unwrap_or_else(|| spec.default.to_owned())
    }

    /// Sets a value; the default or `None` removes it from the given options.
    fn set(&mut self, spec: &OptionSpec, value: Option<String>) {
        match value.filter(|value| spec.default.is_empty() || value != spec.default) {
            Some(value) => drop(self.given.insert(spec.name, value)),
            None => drop(self.given.remove(spec.name)),
        }
    }

    fn field(&mut self, ui: &mut Ui, spec: &'static OptionSpec) {
        match spec.kind {
            ValueKind::Nothing => self.switch(ui, spec, ""),
            ValueKind::Choice(choices) => {
                let items = choices.iter().map(|choice| self.item(spec, choice.name, choice.about));
                self.list(ui, spec, items.collect());
            }
            ValueKind::Word(words) => {
                self.list(ui, spec, words.iter().map(|word| (word.to_string(), word.to_string())).collect());
            }
            ValueKind::Layer => {
                self.list(ui, spec, self.fields.layers.iter().map(|name| self.name(name)).collect());
            }
            ValueKind::Palette => {
                self.list(ui, spec, named::all().iter().map(|palette| self.name(palette.name)).collect());
            }
            ValueKind::Paper => {
                let names = paper::NAMES.iter().map(|(name, _)| (name.to_string(), name.to_string()));
                self.list(ui, spec, names.collect());
            }
            ValueKind::Tileset => self.tileset(ui, spec),
            ValueKind::Color => self.color(ui, spec),
            ValueKind::Automatic => self.automatic(ui, spec),
            _ if spec.example.is_empty() && spec.default.is_empty() => self.text(ui, spec),
            ValueKind::Whole(from, to) => self.numbers(ui, spec, &[number(spec, [from as f64, to as f64])], 1),
            ValueKind::Number(from, to) => self.numbers(ui, spec, &[number(spec, [from, to])], 1),
            ValueKind::Positive => self.numbers(ui, spec, &[number(spec, POSITIVE)], 1),
            ValueKind::Range => self.numbers(ui, spec, &[number(spec, ANY); 2], 2),
            ValueKind::Tuple(components, least) => self.numbers(ui, spec, components, least),
            ValueKind::Size(most) => {
                let side = |unit| Component::new("", unit, [1.0, most as f64]);
                self.numbers(ui, spec, &[side(" ×"), side("")], 2);
            }
            ValueKind::Numbers
            | ValueKind::Point
            | ValueKind::Clock
            | ValueKind::Part(_)
            | ValueKind::Text
            | ValueKind::File => self.text(ui, spec),
        }
    }

    /// A switch. An option that switches a part off is shown as checked while it is not given.
    fn switch(&mut self, ui: &mut Ui, spec: &OptionSpec, label: &str) {
        let leaves_out = leaves_out(spec);
        let mut is_on = self.given.contains_key(spec.name) != leaves_out;
        let response = ui.add(Checkbox::new(&mut is_on, label)).on_hover_text(self.fields.language.told(spec.about));
        let is_changed = response.changed();
        self.named(&response, Role::CheckBox, spec);
        if is_changed {
            self.set(spec, (is_on != leaves_out).then(String::new));
        }
    }

    /// A list of values; the first item stands for no value, unless there is a default.
    fn list(&mut self, ui: &mut Ui, spec: &OptionSpec, mut items: Vec<(String, String)>) {
        if spec.default.is_empty() {
            let none = self.choice(spec, AUTO).unwrap_or(self.fields.language.text("export.automatic"));
            items.insert(0, (String::new(), none.to_owned()));
        }
        let mut value = self.value(spec);
        if !items.iter().any(|(item, _)| *item == value) {
            items.push((value.clone(), value.clone()));
        }
        if rows::list(ui, &self.label(spec), &mut value, &items) {
            self.set(spec, Some(value).filter(|value| !value.is_empty()));
        }
    }

    /// A choice between the built-in tilesets and a file.
    fn tileset(&mut self, ui: &mut Ui, spec: &OptionSpec) {
        let mut value = self.value(spec);
        let is_file = !SETS.iter().any(|set| set.name == value);
        let mut name = if is_file { String::new() } else { value.clone() };
        let mut items: Vec<(String, String)> = SETS.iter().map(|set| self.item(spec, set.name, set.about)).collect();
        items.push((String::new(), self.fields.language.text("export.tileset_file").to_owned()));
        if rows::list(ui, &self.label(spec), &mut name, &items) {
            self.given.insert(spec.name, name);
        } else if is_file {
            ui.end_row();
            let label = self.fields.language.text("export.tileset_path");
            ui.label(label);
            let field = ui.add(TextEdit::singleline(&mut value).desired_width(WIDTH));
            field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, label));
            self.given.insert(spec.name, value);
        }
    }

    /// A checkbox that says whether a value is given; the initial value is the example.
    fn is_given(&mut self, ui: &mut Ui, spec: &OptionSpec, first: &str) -> bool {
        let mut is_given = self.given.contains_key(spec.name);
        let response = ui.checkbox(&mut is_given, "");
        let is_changed = response.changed();
        self.named(&response, Role::CheckBox, spec);
        if is_changed {
            self.set(spec, is_given.then(|| first.to_owned()));
        }
        if !is_given {
            ui.weak(self.fields.language.text("export.automatic"));
        }
        is_given
    }

    fn color(&mut self, ui: &mut Ui, spec: &OptionSpec) {
        ui.horizontal(|ui| {
            if self.is_given(ui, spec, spec.example) {
                let mut color: Rgb = hexadecimal(&self.value(spec)).unwrap_or_default();
                if ui.color_edit_button_srgb(&mut color).changed() {
                    self.given.insert(spec.name, hex(color));
                }
            }
        });
    }

    /// A switch and a number that is either chosen from the data or given.
    fn automatic(&mut self, ui: &mut Ui, spec: &OptionSpec) {
        ui.horizontal(|ui| {
            let mut is_given = self.given.contains_key(spec.name);
            let response = ui.checkbox(&mut is_given, "");
            if response.changed() {
                self.set(spec, is_given.then(|| AUTO.to_owned()));
            }
            self.named(&response, Role::CheckBox, spec);
            if !is_given {
                return;
            }
            let mut is_automatic = self.value(spec) == AUTO;
            let label = self.choice(spec, AUTO).unwrap_or(self.fields.language.text("export.automatic"));
            if ui.checkbox(&mut is_automatic, label).changed() {
                self.set(spec, Some(if is_automatic { AUTO } else { spec.example }.to_owned()));
            }
            if !is_automatic {
                self.drag(ui, spec, &[number(spec, POSITIVE)], 1);
            }
        });
    }

    /// Numbers, of which the first `least` are required; with a default they are always present.
    fn numbers(&mut self, ui: &mut Ui, spec: &OptionSpec, components: &[Component], least: usize) {
        ui.horizontal(|ui| {
            if !spec.default.is_empty() || self.is_given(ui, spec, spec.example) {
                self.drag(ui, spec, components, least);
            }
        });
    }

    fn drag(&mut self, ui: &mut Ui, spec: &OptionSpec, components: &[Component], least: usize) {
        let (split, is_whole) = match spec.kind {
            ValueKind::Size(_) => ('x', true),
            ValueKind::Whole(..) => (',', true),
            _ => (',', false),
        };
        let text = self.value(spec);
        let mut values: Vec<f64> = text.split(split).filter_map(|part| part.trim().parse().ok()).collect();
        let mut is_changed = false;
        for (nth, component) in components.iter().enumerate() {
            let hint = self.choice(spec, component.name).unwrap_or(component.name);
            if nth >= least {
                let mut is_given = nth < values.len();
                if ui.checkbox(&mut is_given, hint).changed() {
                    values.resize(if is_given { nth + 1 } else { nth }, 1000.0);
                    is_changed = true;
                }
            }
            let Some(value) = values.get_mut(nth) else { continue };
            let [from, to] = component.ends;
            let speed = if is_whole { 0.2 } else { (value.abs() / 200.0).clamp(0.01, 100.0) };
            let field = DragValue::new(value).range::<f64>(RangeInclusive::new(from, to)).speed(speed);
            let field = field.prefix(spec.affixes[0]).suffix(self.fields.language.named(component.unit));
            let field = if is_whole { field.max_decimals(0) } else { field };
            let response = ui.add(field);
            is_changed |= response.changed();
            self.named(&response, Role::SpinButton, spec);
            if !hint.is_empty() {
                response.on_hover_text(hint);
            }
        }
        if is_changed {
            let texts: Vec<String> =
                values.iter().map(|value| if is_whole { value.round() } else { *value }.to_string()).collect();
            self.set(spec, Some(texts.join(&split.to_string())));
        }
    }

    /// A text field; an empty text is not given.
    fn text(&mut self, ui: &mut Ui, spec: &OptionSpec) {
        let mut text = self.value(spec);
        let hint = match (spec.name, spec.example) {
            ("title", _) => self.fields.title,
            (_, "") => spec.value,
            (_, example) => example,
        };
        let field = ui.add(TextEdit::singleline(&mut text).desired_width(WIDTH).hint_text(hint));
        if field.changed() {
            self.set(spec, Some(text).filter(|text| !text.is_empty()));
        }
        self.named(&field, Role::TextInput, spec);
    }

    /// Sets the name of a field for screen readers.
    fn named(&self, response: &Response, role: Role, spec: &OptionSpec) {
        let label = self.label(spec);
        response.widget_info(|| WidgetInfo::labeled(role, true, label.clone()));
    }
}

const POSITIVE: [f64; 2] = [1e-6, 1e15];
const ANY: [f64; 2] = [-1e9, 1e9];

/// The component of an option with a single number.
fn number(spec: &OptionSpec, ends: [f64; 2]) -> Component {
    Component::new("", spec.affixes[1], ends)
}

fn leaves_out(spec: &OptionSpec) -> bool {
    spec.name.starts_with("no-")
}

/// Whether an option switches off a part, and is shown with other such options.
fn is_part(spec: &OptionSpec) -> bool {
    leaves_out(spec) && !spec.heading.is_empty()
}

/// The words of a name, as the beginning of a sentence: "Max error" for `max-error`.
fn sentence(name: &str) -> String {
    let mut letters = name.chars();
    let first = letters.next().map(char::to_uppercase).into_iter().flatten();
    first.chain(letters.map(|letter| if letter == '-' { ' ' } else { letter })).collect()
}
