//! Fields for values, derived from their declarations.

use eframe::egui::{
    self, Align2, ComboBox, DragValue, FontId, Response, Sense, Slider, SliderClamping, Stroke, TextEdit, Ui, Vec2,
};
use orogen::declare::Shape;
use orogen::value::{Spanned, Value};

use crate::catalogue::Language;

/// The user's input in a field.
#[derive(Debug, Clone, PartialEq)]
pub struct Input<T> {
    /// The new value.
    pub value: Option<T>,
    /// Whether the gesture has ended.
    pub ended: bool,
}

impl<T> Input<T> {
    fn none() -> Input<T> {
        Input { value: None, ended: false }
    }

    fn of(response: &Response, value: T) -> Input<T> {
        Input { value: response.changed().then_some(value), ended: response.drag_stopped() || response.lost_focus() }
    }

    /// Converts the value.
    pub fn map<U>(self, of: impl FnOnce(T) -> U) -> Input<U> {
        Input { value: self.value.map(of), ended: self.ended }
    }
}

/// The declaration of a number.
#[derive(Debug, Clone, Copy)]
pub struct Number<'a> {
    /// Minimum and maximum; infinite if there is none.
    pub range: [f64; 2],
    /// The default; if the range is wide, the slider's ends are derived from it.
    pub default: f64,
    /// The unit, or empty.
    pub unit: &'a str,
    /// Whether it is an integer.
    pub is_whole: bool,
}

/// A range is wide if it spans more than this many times the default.
const WIDE: f64 = 200.0;

impl Number<'_> {
    /// The ends of the slider, and whether its scale is logarithmic.
    #[must_use]
    pub fn slider(&self) -> ([f64; 2], bool) {
        let [low, high] = self.range;
        let size = if self.default == 0.0 { 1.0 } else { self.default.abs() };
        let is_narrow = low.is_finite() && high.is_finite() && high - low <= WIDE * size.max(1e-3);
        if is_narrow {
            let is_log = low > 0.0 && high / low > 100.0;
            return ([low, high], is_log);
        }
        if self.default > 0.0 {
            let low = low.max(size / 20.0);
            return ([if self.is_whole { low.round() } else { low }, high.min(size * 20.0)], true);
        }
        ([low.max(-size * 10.0), high.min(size * 10.0)], false)
    }
}

/// A slider with a field for a number.
pub fn number(ui: &mut Ui, label: &str, mut value: f64, declared: &Number) -> Input<f64> {
    let ([low, high], is_log) = declared.slider();
    let mut slider = Slider::new(&mut value, low..=high)
        .logarithmic(is_log)
        .clamping(SliderClamping::Never)
        .smart_aim(true)
        .max_decimals(6);
    if !declared.unit.is_empty() {
        slider = slider.suffix(format!(" {}", declared.unit));
    }
    if declared.is_whole {
        slider = slider.integer();
    }
    let response = named(ui.add(slider), label);
    let [low, high] = declared.range;
    Input::of(&response, rounded(value.clamp(low, high)))
}

/// Sets the name of a field for screen readers and tests.
fn named(response: Response, label: &str) -> Response {
    let label = label.to_owned();
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, label.clone()));
    response
}

/// Removes the digits that a slider adds: six digits are enough.
#[must_use]
pub fn rounded(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let text = format!("{value:.5e}");
    text.parse().unwrap_or(value)
}

/// A field for a value of a shape. Other values are only described.
pub fn value(
    ui: &mut Ui,
    label: &str,
    shape: Shape,
    value: &Value,
    declared: &Number,
    language: Language,
) -> Input<Value> {
    match (shape, value) {
        (Shape::Number, value) => match value.number() {
            Some(own) => number(ui, label, own, declared).map(Value::Number),
            None => text(ui, label, &value.to_toml()).map(|_| value.clone()),
        },
        (Shape::Integer | Shape::Seed, Value::Integer(own)) => match shape {
            Shape::Seed => {
                let mut seed = *own;
                let response = ui.add(DragValue::new(&mut seed).range(0..=i64::MAX).speed(0.1));
                Input::of(&named(response, label), Value::Integer(seed))
            }
            _ => number(ui, label, *own as f64, &Number { is_whole: true, ..*declared })
                .map(|number| Value::Integer(number.round() as i64)),
        },
        (Shape::Flag, Value::Flag(own)) => {
            let mut flag = *own;
            let response = ui.checkbox(&mut flag, "");
            let name = label.to_owned();
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::CheckBox, true, name.clone()));
            Input { value: response.changed().then_some(Value::Flag(flag)), ended: response.changed() }
        }
        (Shape::Choice(choices), Value::Text(own)) => choice(ui, label, &choices(), own, language).map(Value::Text),
        (Shape::Pair, Value::List(items)) => pair(ui, label, items),
        (Shape::Curve, Value::List(items)) => curve(ui, items),
        (Shape::Expression | Shape::File | Shape::Crs, Value::Text(own)) => text(ui, label, own).map(Value::Text),
        (_, Value::List(items)) => {
            ui.weak(language.fill("inspector.items", &[("count", &items.len().to_string())]));
            Input::none()
        }
        _ => {
            ui.weak(value.describe());
            Input::none()
        }
    }
}

fn choice(
    ui: &mut Ui,
    label: &str,
    choices: &[(&'static str, &'static str)],
    own: &str,
    language: Language,
) -> Input<String> {
    let mut chosen = None;
    let list = ComboBox::from_id_salt(label).selected_text(language.named(own)).show_ui(ui, |ui| {
        for (name, about) in choices {
            let entry = ui.selectable_label(*name == own, language.named(name));
            if entry.on_hover_text(language.hint(name, about)).clicked() {
                chosen = Some((*name).to_owned());
            }
        }
    });
    let label = label.to_owned();
    list.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, label.clone()));
    Input { ended: chosen.is_some(), value: chosen }
}

/// A line of text.
pub fn text(ui: &mut Ui, label: &str, own: &str) -> Input<String> {
    let mut typed = own.to_owned();
    let response = ui.add(TextEdit::singleline(&mut typed).desired_width(f32::INFINITY).code_editor());
    let label = label.to_owned();
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, label.clone()));
    Input::of(&response, typed)
}

fn pair(ui: &mut Ui, label: &str, items: &[Spanned<Value>]) -> Input<Value> {
    let mut numbers: Vec<f64> = items.iter().filter_map(|item| item.value.number()).collect();
    let mut input = Input::none();
    ui.horizontal(|ui| {
        for number in &mut numbers {
            let speed = (number.abs() * 0.005).max(1e-3);
            let response = named(ui.add(DragValue::new(number).speed(speed).max_decimals(6)), label);
            input.ended |= response.drag_stopped() || response.lost_focus();
            if response.changed() {
                input.value = Some(());
            }
        }
    });
    let list =
        || Value::List(numbers.iter().map(|number| Spanned::unplaced(Value::Number(rounded(*number)))).collect());
    Input { value: input.value.map(|()| list()), ended: input.ended }
}

/// A curve with points that can be dragged; a double click adds a point or removes it.
fn curve(ui: &mut Ui, items: &[Spanned<Value>]) -> Input<Value> {
    let mut points: Vec<[f64; 2]> = items
        .iter()
        .filter_map(|item| match &item.value {
            Value::List(pair) => Some([pair.first()?.value.number()?, pair.get(1)?.value.number()?]),
            _ => None,
        })
        .collect();
    if points.len() < 2 {
        return Input::none();
    }
    let size = Vec2::new(ui.available_width().clamp(80.0, 320.0), 120.0);
    let (rect, background) = ui.allocate_exact_size(size, Sense::click());
    let ends = |k: usize| {
        let low = points.iter().map(|point| point[k]).fold(f64::INFINITY, f64::min);
        let high = points.iter().map(|point| point[k]).fold(f64::NEG_INFINITY, f64::max);
        if high > low { [low, high] } else { [low - 0.5, low + 0.5] }
    };
    let inner = rect.shrink(10.0);
    // The scale does not change while a point is dragged.
    let id = background.id.with("ends");
    let [xs, ys]: [[f64; 2]; 2] = ui.data(|data| data.get_temp(id)).unwrap_or([ends(0), ends(1)]);
    let screen = |[x, y]: [f64; 2]| {
        egui::pos2(
            inner.left() + ((x - xs[0]) / (xs[1] - xs[0])) as f32 * inner.width(),
            inner.bottom() - ((y - ys[0]) / (ys[1] - ys[0])) as f32 * inner.height(),
        )
    };
    let world = |at: egui::Pos2| {
        [
            xs[0] + f64::from((at.x - inner.left()) / inner.width()) * (xs[1] - xs[0]),
            ys[0] + f64::from((at.y - inner.top()) / inner.height()) * (ys[0] - ys[1]) + (ys[1] - ys[0]),
        ]
    };
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 4.0, ui.visuals().extreme_bg_color);
    let line: Vec<egui::Pos2> = points.iter().map(|point| screen(*point)).collect();
    painter.line(line, Stroke::new(1.5, ui.visuals().selection.bg_fill));
    let mut input = Input::none();
    let mut removed = None;
    for k in 0..points.len() {
        let at = screen(points[k]);
        let handle = ui.interact(
            egui::Rect::from_center_size(at, Vec2::splat(14.0)),
            background.id.with(k),
            Sense::click_and_drag(),
        );
        let radius = if handle.hovered() || handle.dragged() { 6.0 } else { 4.0 };
        painter.circle_filled(at, radius, ui.visuals().strong_text_color());
        if handle.dragged()
            && let Some(pointer) = handle.interact_pointer_pos()
        {
            let [x, y] = world(pointer);
            // Points keep their order.
            let gap = (xs[1] - xs[0]) * 1e-3;
            let low = if k > 0 { points[k - 1][0] + gap } else { f64::NEG_INFINITY };
            let high = points.get(k + 1).map_or(f64::INFINITY, |next| next[0] - gap);
            points[k] = [rounded(x.max(low).min(high)), rounded(y)];
            ui.data_mut(|data| data.insert_temp(id, [xs, ys]));
            input.value = Some(());
            let [x, y] = points[k];
            painter.text(
                rect.left_top() + Vec2::splat(4.0),
                Align2::LEFT_TOP,
                format!("{x}, {y}"),
                FontId::monospace(10.0),
                ui.visuals().text_color(),
            );
        }
        if handle.drag_stopped() {
            ui.data_mut(|data| data.remove::<[[f64; 2]; 2]>(id));
            input.ended = true;
        }
        if handle.double_clicked() && points.len() > 2 {
            removed = Some(k);
        }
    }
    if let Some(k) = removed {
        points.remove(k);
        input = Input { value: Some(()), ended: true };
    } else if background.double_clicked()
        && let Some(pointer) = background.interact_pointer_pos()
    {
        let [x, y] = world(pointer).map(rounded);
        let at = points.partition_point(|point| point[0] < x);
        if points.iter().all(|point| point[0] != x) {
            points.insert(at, [x, y]);
            input = Input { value: Some(()), ended: true };
        }
    }
    let list = |point: &[f64; 2]| {
        Spanned::unplaced(Value::List(point.iter().map(|number| Spanned::unplaced(Value::Number(*number))).collect()))
    };
    Input { value: input.value.map(|()| Value::List(points.iter().map(list).collect())), ended: input.ended }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliders_have_useful_ends() {
        let number = |range, default| Number { range, default, unit: "", is_whole: false }.slider();
        assert_eq!(number([0.0, 1.0], 0.5), ([0.0, 1.0], false));
        assert_eq!(number([1e-3, 1e9], 1000.0), ([50.0, 20_000.0], true));
        assert_eq!(number([f64::NEG_INFINITY, f64::INFINITY], 0.0), ([-10.0, 10.0], false));
        assert_eq!(number([0.0, 90.0], 33.0), ([0.0, 90.0], false));
    }

    #[test]
    fn digits_are_few() {
        for (value, expect) in [(0.1 + 0.2, 0.3), (1234.56789, 1234.57), (0.0, 0.0), (-1e-9, -1e-9)] {
            assert_eq!(rounded(value), expect);
        }
    }
}
