//! Reading of lists of points, with messages about problems.

use crate::value::{Span, Spanned, Value};
use orogen_grid::words::count;

/// Maximum number of points of a parameter.
pub const MAX_POINTS: usize = 100_000;

pub(super) type Lists = Vec<Vec<[f64; 3]>>;

/// The form in which points are written.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Form {
    /// Whether they are a list of lists.
    pub(super) is_nested: bool,
    /// Whether every point has a height.
    pub(super) has_heights: bool,
}

/// The kind of drawing that the points belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Drawn {
    Stroke,
    Line,
    Area,
}

impl Drawn {
    /// The kind of drawing whose lists have at least this many points.
    pub(super) fn of_at_least(points: usize) -> Drawn {
        if points > 2 { Drawn::Area } else { Drawn::Line }
    }

    /// Minimum number of points of a list.
    pub(super) fn min(self) -> usize {
        match self {
            Drawn::Stroke => 1,
            Drawn::Line => 2,
            Drawn::Area => 3,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Drawn::Stroke => "a stroke",
            Drawn::Line => "a line",
            Drawn::Area => "an area",
        }
    }

    /// The syntax of a point, for messages.
    fn point(self) -> &'static str {
        match self {
            Drawn::Stroke => "[x, y]",
            Drawn::Line | Drawn::Area => "[x, y] or [x, y, height]",
        }
    }

    /// Maximum number of numbers of a point.
    fn numbers(self) -> usize {
        if self == Drawn::Stroke { 2 } else { 3 }
    }

    /// Advice for more points than are allowed.
    fn elsewhere(self) -> &'static str {
        match self {
            Drawn::Stroke => "paint the others in a node of their own",
            Drawn::Line | Drawn::Area => "write larger drawings to a file, and name it as `file`",
        }
    }
}

/// Reads lists of points; an error has the position of the item that is wrong.
pub(super) struct Reader<'a> {
    /// The name of the parameter.
    pub(super) name: &'a str,
    /// The valid values of a coordinate, for messages.
    pub(super) number: String,
    /// The kind of drawing.
    pub(super) drawn: Drawn,
    /// The range of coordinates.
    pub(super) range: [f64; 2],
}

impl Reader<'_> {
    pub(super) fn read(&self, value: &Value) -> Result<(Lists, Form), (Span, String)> {
        let Value::List(items) = value else {
            let message = format!("`{}` must be a list of points [[x, y], ...], not {}", self.name, value.describe());
            return Err((0..0, message));
        };
        let is_nested = match items.first().map(|item| &item.value) {
            Some(Value::List(inner)) => matches!(inner.first().map(|item| &item.value), Some(Value::List(_))),
            _ => false,
        };
        let (mut numbers, mut left) = (None, MAX_POINTS);
        let lists = if items.is_empty() {
            Vec::new()
        } else if is_nested {
            let lists = items.iter().enumerate().map(|(k, item)| {
                let of = format!(" of list {}", k + 1);
                match &item.value {
                    Value::List(points) => self.list(points, &item.span, &of, &mut numbers, &mut left),
                    other => Err(self.wrong(
                        &item.span,
                        format!("list {} is {}; write each line or ring as a list of points", k + 1, other.describe()),
                    )),
                }
            });
            lists.collect::<Result<Lists, _>>()?
        } else {
            vec![self.list(items, &(0..0), "", &mut numbers, &mut left)?]
        };
        Ok((lists, Form { is_nested, has_heights: numbers == Some(3) }))
    }

    fn wrong(&self, span: &Span, what: String) -> (Span, String) {
        (span.clone(), format!("`{}`: {what}", self.name))
    }

    /// The points of one list. `of` names the list in messages, `numbers` is the number of numbers of every point
    /// (`None` until the first point is read), and `left` is the number of points that are still allowed.
    pub(super) fn list(
        &self,
        items: &[Spanned<Value>],
        span: &Span,
        of: &str,
        numbers: &mut Option<usize>,
        left: &mut usize,
    ) -> Result<Vec<[f64; 3]>, (Span, String)> {
        let (min, form) = (self.drawn.min(), self.drawn.point());
        if items.len() < min {
            let (line, has) = (self.drawn.name(), count(items.len(), "point"));
            let what = match of.strip_prefix(" of ") {
                Some(list) => format!("{list} has {has}"),
                None => format!("it has {has}"),
            };
            return Err(self.wrong(span, format!("{what}; {line} needs at least {min}")));
        }
        *left = left.checked_sub(items.len()).ok_or_else(|| {
            let what = format!("it has more than {MAX_POINTS} points; {}", self.drawn.elsewhere());
            self.wrong(span, what)
        })?;
        let points = items.iter().enumerate().map(|(k, item)| {
            let at = || format!("point {}{of}", k + 1);
            let Value::List(coordinates) = &item.value else {
                let found = item.value.describe();
                return Err(self.wrong(&item.span, format!("{} is {found}; a point is {form}", at())));
            };
            if !(2..=self.drawn.numbers()).contains(&coordinates.len()) {
                let has = count(coordinates.len(), "number");
                return Err(self.wrong(&item.span, format!("{} has {has}; a point is {form}", at())));
            }
            let before = *numbers.get_or_insert(coordinates.len());
            if before != coordinates.len() {
                let what = format!(
                    "{} has {} numbers, and the points before have {before}; give a height to all points or to none",
                    at(),
                    coordinates.len()
                );
                return Err(self.wrong(&item.span, what));
            }
            let mut point = [0.0; 3];
            for ((place, coordinate), axis) in point.iter_mut().zip(coordinates).zip(["x", "y", "the height"]) {
                let [low, high] = self.range;
                match coordinate.value.number() {
                    Some(number) if number.is_finite() && (low..=high).contains(&number) => *place = number,
                    _ => {
                        let found = coordinate.value.describe();
                        let what = format!("{axis} of {} must be {}, not {found}", at(), self.number);
                        return Err(self.wrong(&coordinate.span, what));
                    }
                }
            }
            Ok(point)
        });
        points.collect()
    }
}
