//! The panel next to the view: the world, the recipe's parameters, and the selected node.

use std::collections::HashMap;

use eframe::egui::{self, CollapsingHeader, ComboBox, DragValue, Id, RichText, TextEdit, Ui};
use orogen::declare::{Input, Shape};
use orogen::node::Node;
use orogen::recipe::{NamedNode, Recipe};
use orogen::value::Value;

use super::action::Action;
use super::command::Command;
use super::expression_field::ExpressionFields;
use super::fields::{self, Number};
use super::ground;
use crate::catalogue::Language;
use crate::editing::edit::Edit;
use crate::editing::expression::Site;
use crate::editing::kept::Kept;
use crate::editing::{groups, names, notes};
use crate::studio::Studio;

/// State of the panel.
#[derive(Debug, Default)]
pub struct Inspector {
    /// The name that is being typed for a node.
    renaming: Option<(String, String)>,
    /// Whether the name field should get the keyboard focus.
    wants_focus: bool,
    /// Expressions that are being typed.
    expressions: ExpressionFields,
    /// The notes of nodes, of a revision of the document.
    notes: Option<(u64, HashMap<String, String>)>,
}

impl Inspector {
    /// Starts renaming a node or a group.
    pub fn rename(&mut self, name: &str) {
        self.renaming = Some((name.to_owned(), name.to_owned()));
        self.wants_focus = true;
    }

    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        ui.add_enabled_ui(studio.document.is_valid(), |ui| {
            world(ui, studio, language, actions);
            parameters(ui, studio, language, actions);
            ground::show(ui, studio, language, actions);
            ui.separator();
            let recipe = studio.document.recipe();
            if let Some(group) = groups::of_selection(recipe, &studio.selected) {
                return self.group(ui, &group, studio, language, actions);
            }
            if studio.selected.len() > 1 {
                several(ui, studio, language, actions);
            }
            let selected =
                studio.selected.first().and_then(|name| recipe.nodes().iter().find(|named| named.name == *name));
            match selected {
                Some(named) => self.node(ui, named, studio, language, actions),
                None => drop(ui.weak(language.text("inspector.none"))),
            }
        });
    }

    /// A button that converts a number to a formula, and a formula to a number.
    #[allow(clippy::too_many_arguments, reason = "all of it is of this one frame")]
    fn formula(
        &mut self,
        ui: &mut Ui,
        node: &str,
        key: &str,
        value: &Value,
        recipe: &Recipe,
        language: Language,
        actions: &mut Vec<Action>,
    ) {
        let site = Site { node: node.to_owned(), key: key.to_owned(), is_formula: true };
        let is_formula = recipe.formula(node, key).is_some();
        let is_on = is_formula || self.expressions.is_typed(&site);
        let button = ui.selectable_label(is_on, RichText::new("ƒ").small());
        let label = language.fill("spoken.formula", &[("name", &format!("{node}.{key}"))]);
        button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_on, label.clone()));
        if !button.on_hover_text(language.text("inspector.formula")).clicked() {
            return;
        }
        match is_on {
            true => {
                self.expressions.end(&site);
                if is_formula {
                    actions.push(Action::Edit(Edit::Param {
                        node: node.into(),
                        key: key.into(),
                        value: value.clone(),
                    }));
                    actions.push(Action::EndGesture);
                }
            }
            false => self.expressions.begin(site, "", &format!(" {}", value.to_toml())),
        }
    }

    /// A field for the note of a node.
    fn note(&mut self, ui: &mut Ui, name: &str, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        let revision = studio.document.revision();
        if self.notes.as_ref().is_none_or(|(of, _)| *of != revision) {
            self.notes = Some((revision, notes::all(studio.document.text()).into_iter().collect()));
        }
        let Some(note) = self.notes.as_ref().and_then(|(_, notes)| notes.get(name)) else { return };
        let mut typed = note.clone();
        let hint = language.text("inspector.note");
        let field = TextEdit::multiline(&mut typed).desired_rows(1).desired_width(f32::INFINITY).hint_text(hint);
        let field = ui.add(field.font(egui::TextStyle::Small));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::MultilineTextInput, true, hint));
        if field.changed() {
            actions.push(Action::Edit(Edit::Note { node: name.to_owned(), text: typed }));
        }
        if field.lost_focus() {
            actions.push(Action::EndGesture);
        }
    }

    /// A field for the name of a node or group. Returns the new name.
    fn name(&mut self, ui: &mut Ui, name: &str, language: Language) -> Option<String> {
        match &mut self.renaming {
            Some((of, typed)) if of == name => {
                let field = ui.add(TextEdit::singleline(typed).desired_width(140.0));
                if std::mem::take(&mut self.wants_focus) {
                    field.request_focus();
                }
                if let Some(why) = names::fault(typed) {
                    ui.colored_label(ui.visuals().error_fg_color, language.text(why));
                } else if field.lost_focus() {
                    let is_given = ui.input(|input| input.key_pressed(egui::Key::Enter)) && typed != name;
                    let to = is_given.then(|| typed.clone());
                    self.renaming = None;
                    return to;
                }
            }
            _ => {
                let text = RichText::new(name).strong().size(15.0);
                let title = ui.add(egui::Label::new(text).sense(egui::Sense::click()));
                if title.on_hover_text(language.text("inspector.rename")).double_clicked() {
                    self.rename(name);
                }
            }
        }
        None
    }

    /// A group: its name, and its nodes.
    fn group(&mut self, ui: &mut Ui, group: &str, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        ui.horizontal(|ui| {
            if let Some(to) = self.name(ui, group, language) {
                actions.push(Action::Edit(Edit::RenameGroup { from: group.to_owned(), to }));
            }
            ui.weak(language.text("inspector.group"));
        });
        ui.horizontal_wrapped(|ui| {
            if ui.button(language.text("graph.enter")).clicked() {
                actions.push(Action::Enter(group.to_owned()));
            }
            buttons(ui, &[Command::Ungroup, Command::Duplicate, Command::Delete], language, actions);
        });
        ui.add_space(4.0);
        for name in groups::members(studio.document.recipe(), group) {
            let own = groups::rest(&name, group).unwrap_or(&name);
            if ui.selectable_label(false, own).clicked() {
                actions.push(Action::Enter(groups::group_of(&name).to_owned()));
                actions.push(Action::Select(vec![name]));
            }
        }
    }

    fn node(&mut self, ui: &mut Ui, named: &NamedNode, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        let NamedNode { name, node, mask } = named;
        let spec = node.spec();
        ui.horizontal(|ui| {
            if let Some(to) = self.name(ui, name, language) {
                actions.push(Action::Edit(Edit::Rename { from: name.clone(), to }));
            }
            ui.weak(language.named(spec.op)).on_hover_text(language.hint(spec.op, spec.doc));
        });
        let kept = studio.document.kept();
        let is_locked = kept.locked.contains(name);
        if is_locked {
            ui.horizontal(|ui| {
                ui.colored_label(ui.visuals().warn_fg_color, language.text("inspector.locked"));
                if ui.button(language.text("graph.unlock")).clicked() {
                    let locked = kept.locked.iter().filter(|other| *other != name).cloned().collect();
                    actions.push(Action::Edit(Edit::Keep(Kept { locked, ..kept.clone() })));
                }
            });
        }
        ui.horizontal(|ui| {
            let is_shown = studio.look.layer == *name;
            if ui.selectable_label(is_shown, language.text("inspector.show")).clicked() {
                let layer = if is_shown { orogen::world::HEIGHT.to_owned() } else { name.clone() };
                actions.push(Action::Show(layer));
            }
            if ui.button(language.text("command.duplicate")).clicked() {
                actions.push(Action::Command(Command::Duplicate));
            }
            if ui.button(language.text("command.delete")).clicked() {
                actions.push(Action::Command(Command::Delete));
            }
        });
        ui.label(RichText::new(language.told_shortly(spec.doc)).weak().small());
        self.note(ui, name, studio, language, actions);
        ui.add_space(4.0);
        if is_locked {
            ui.disable();
        }
        let inputs = node.inputs();
        for (i, input) in inputs.iter().enumerate() {
            let declared = spec.input_named(input.name).map(|at| &spec.inputs[at]);
            let about = declared.map_or("", |declared| declared.doc.trim());
            let is_required = declared.is_none_or(|declared| declared.required);
            source(ui, (name, input.name, about, is_required), node.input(i), studio, language, actions);
        }
        source(ui, (name, "mask", language.text("inspector.mask"), false), mask, studio, language, actions);
        ui.add_space(4.0);
        let recipe = studio.document.recipe();
        // A node with the defaults, for `reset`.
        let default = Node::named(spec.op);
        for (i, param) in spec.params.iter().enumerate() {
            let (value, default) = (node.param(i), default.as_ref().map(|node| node.param(i)));
            let is_default = default.as_ref() == Some(&value);
            ui.horizontal(|ui| {
                let text = RichText::new(language.named(param.name));
                let label = ui.label(if is_default { text } else { text.strong() });
                let hint = language.hint(param.name, param.doc);
                label.on_hover_text(format!(
                    "{hint}\n\n{}",
                    expected(param.range, param.unit, &param.expected(), language)
                ));
                if matches!(param.shape, Shape::Number | Shape::Integer) {
                    self.formula(ui, name, param.name, &value, recipe, language, actions);
                }
                let reset = ui.add_visible(!is_default, egui::Button::new(language.text("inspector.reset")).small());
                if reset.clicked() {
                    actions.push(Action::Edit(Edit::Reset { node: name.clone(), key: param.name.into() }));
                }
            });
            let own = recipe.formula(name, param.name);
            let site = Site {
                node: name.clone(),
                key: param.name.into(),
                is_formula: !matches!(param.shape, Shape::Expression),
            };
            match (&value, param.shape) {
                (Value::Text(own), Shape::Expression) => {
                    self.expressions.show(ui, &site, own, studio, language, actions);
                    continue;
                }
                _ if own.is_some() || self.expressions.is_typed(&site) => {
                    ui.weak(format!("= {}", value.to_toml()));
                    self.expressions.show(ui, &site, own.unwrap_or_default(), studio, language, actions);
                    continue;
                }
                _ => {}
            }
            let number = Number {
                range: param.range,
                default: default.as_ref().and_then(Value::number).unwrap_or(0.0),
                unit: language.named(param.unit),
                is_whole: false,
            };
            widen_sliders(ui, language.named(param.unit));
            let label = format!("{name}.{}", language.named(param.name));
            let input = fields::value(ui, &label, param.shape, &value, &number, language);
            if let Some(value) = input.value {
                actions.push(Action::Edit(Edit::Param { node: name.clone(), key: param.name.into(), value }));
            }
            if input.ended {
                actions.push(Action::EndGesture);
            }
        }
    }
}

/// Several nodes are selected: actions for all of them.
fn several(ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
    let count = studio.selected.len().to_string();
    ui.weak(language.fill("inspector.several", &[("count", &count)]));
    ui.horizontal_wrapped(|ui| {
        buttons(ui, &[Command::Group, Command::Duplicate, Command::Delete], language, actions);
    });
    ui.separator();
}

fn buttons(ui: &mut Ui, commands: &[Command], language: Language, actions: &mut Vec<Action>) {
    for command in commands {
        let name = command.entry().map_or("", |entry| language.text(entry.name));
        if ui.button(name).clicked() {
            actions.push(Action::Command(*command));
        }
    }
}

fn world(ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
    let world = studio.document.recipe().world;
    CollapsingHeader::new(language.text("inspector.world")).default_open(true).show(ui, |ui| {
        ui.horizontal(|ui| {
            let label = ui.label(language.text("inspector.seed"));
            let mut seed = world.seed;
            let field = ui.add(DragValue::new(&mut seed).range(0..=i64::MAX as u64).speed(0.2));
            let field = field.labelled_by(label.id);
            if field.changed() {
                actions.push(Action::Edit(Edit::Seed(seed)));
            }
            if field.drag_stopped() || field.lost_focus() {
                actions.push(Action::EndGesture);
            }
            if ui.button(language.text("command.next_seed")).clicked() {
                actions.push(Action::Command(Command::NextSeed));
            }
        });
        let metres = Measure { scale: 1.0, unit: " m", range: [-1e6, 1e6], least: 1.0 };
        ui.horizontal(|ui| {
            let label = ui.label(language.text("inspector.sea_level")).id;
            let level = |level| Edit::World("sea_level", level);
            measure(ui, label, world.sea_level, metres, &level, actions);
        });
        ui.horizontal(|ui| {
            let label = ui.label(language.text("inspector.size")).id;
            let Some([width, height]) = world.size else {
                ui.weak(language.text("inspector.unbounded"));
                return;
            };
            let kilometres = Measure { scale: 1000.0, unit: " km", range: SIZES, least: 1e-3 };
            measure(ui, label, width, kilometres, &|width| Edit::Size([width, height]), actions);
            ui.label("×");
            measure(ui, label, height, kilometres, &|height| Edit::Size([width, height]), actions);
        });
        ui.horizontal(|ui| {
            let label = ui.label(language.text("inspector.cell")).id;
            // Finer cells than this would need more memory than there is.
            let side = world.size.map_or(f64::INFINITY, |[width, height]| width.max(height));
            let range = if side.is_finite() { [side / 65_536.0, side / 2.0] } else { [1e-3, 1e6] };
            measure(
                ui,
                label,
                world.cell,
                Measure { range, least: 0.05, ..metres },
                &|cell| Edit::World("cell", cell),
                actions,
            );
        });
    });
}

/// Width or height of a world, in metres.
const SIZES: [f64; 2] = [1.0, 1e8];

/// How a length is shown.
#[derive(Clone, Copy)]
struct Measure {
    /// Metres per unit.
    scale: f64,
    unit: &'static str,
    /// The range in metres.
    range: [f64; 2],
    /// The smallest change by one point of dragging, in this unit.
    least: f64,
}

/// A field for a length in metres that an edit sets.
fn measure(ui: &mut Ui, label: Id, metres: f64, shown: Measure, edit: &dyn Fn(f64) -> Edit, actions: &mut Vec<Action>) {
    let mut number = metres / shown.scale;
    let [low, high] = shown.range.map(|end| end / shown.scale);
    let speed = (number.abs() * 0.01).max(shown.least);
    let field = DragValue::new(&mut number).range(low..=high).speed(speed).suffix(shown.unit).max_decimals(3);
    let field = ui.add(field).labelled_by(label);
    if field.changed() {
        actions.push(Action::Edit(edit(fields::rounded(number * shown.scale))));
    }
    if field.drag_stopped() || field.lost_focus() {
        actions.push(Action::EndGesture);
    }
}

fn parameters(ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
    let parameters = studio.document.recipe().parameters();
    if parameters.is_empty() {
        return;
    }
    CollapsingHeader::new(language.text("inspector.parameters")).default_open(true).show(ui, |ui| {
        for parameter in parameters {
            let label = language.named(&parameter.name);
            let hint = language.hint(&parameter.name, &parameter.help);
            let expected = expected(parameter.range, &parameter.unit, &parameter.expected(), language);
            ui.label(label).on_hover_text(format!("{hint}\n\n{expected}"));
            let unit = language.named(&parameter.unit);
            let number = Number { range: parameter.range, default: parameter.value, unit, is_whole: false };
            widen_sliders(ui, unit);
            let input = fields::number(ui, label, parameter.value, &number);
            if let Some(value) = input.value {
                actions.push(Action::Edit(Edit::Default { parameter: parameter.name.clone(), value }));
            }
            if input.ended {
                actions.push(Action::EndGesture);
            }
        }
    });
}

/// Makes sliders as wide as the panel, with room for a number and its unit.
fn widen_sliders(ui: &mut Ui, unit: &str) {
    // Room for eight digits: a row that is wider than the panel would widen it.
    let number = 104.0 + 7.5 * unit.chars().count() as f32;
    ui.spacing_mut().slider_width = (ui.available_width() - number).max(60.0);
}

/// The valid values of a parameter; `english` says it in that language.
fn expected(range: [f64; 2], unit: &str, english: &str, language: Language) -> String {
    if language == Language::English {
        return english.to_owned();
    }
    let bounds = match range {
        [low, high] if low.is_finite() && high.is_finite() => format!("{low} – {high}"),
        [low, _] if low.is_finite() => format!("≥ {low}"),
        [_, high] if high.is_finite() => format!("≤ {high}"),
        _ => String::new(),
    };
    format!("{bounds} {}", language.named(unit)).trim().to_owned()
}

/// A field for the source of an input: a node, or a number.
fn source(
    ui: &mut Ui,
    (node, key, about, is_required): (&str, &str, &str, bool),
    input: &Input,
    studio: &Studio,
    language: Language,
    actions: &mut Vec<Action>,
) {
    ui.horizontal(|ui| {
        let label = ui.label(language.named(key)).on_hover_text(language.hint(key, about));
        let connect =
            |source: Input| Action::Edit(Edit::Connect { node: node.to_owned(), input: key.to_owned(), source });
        let shown = match input {
            Input::None => language.text("inspector.nothing").to_owned(),
            Input::Node(name) => name.clone(),
            Input::Value(_) => language.text("inspector.number").to_owned(),
        };
        let sources = ComboBox::from_id_salt((node, key)).selected_text(shown).show_ui(ui, |ui| {
            if !is_required && ui.selectable_label(*input == Input::None, language.text("inspector.nothing")).clicked()
            {
                actions.push(connect(Input::None));
            }
            if ui.selectable_label(matches!(input, Input::Value(_)), language.text("inspector.number")).clicked() {
                actions.push(connect(Input::Value(0.0)));
            }
            for other in studio.document.recipe().nodes().iter().filter(|other| other.name != node) {
                let layers = other.node.layers();
                let names = layers.iter().enumerate().map(|(k, layer)| match k {
                    0 => other.name.clone(),
                    _ => format!("{}.{}", other.name, layer.name),
                });
                for name in names {
                    let is_own = matches!(input, Input::Node(own) if *own == name);
                    if ui.selectable_label(is_own, &name).clicked() {
                        actions.push(connect(Input::Node(name)));
                    }
                }
            }
        });
        sources.response.labelled_by(label.id);
        if let Input::Value(value) = input {
            let mut number = *value;
            let field = ui.add(DragValue::new(&mut number).speed((value.abs() * 0.01).max(0.01)).max_decimals(6));
            let field = field.labelled_by(label.id);
            if field.changed() {
                actions.push(connect(Input::Value(fields::rounded(number))));
            }
            if field.drag_stopped() || field.lost_focus() {
                actions.push(Action::EndGesture);
            }
        }
    });
}
