//! Lines and areas as parameters: lists of points, and the segments that they consist of.

use std::sync::Arc;

use super::memo::Memo;
use super::param::Param;
use super::point_lists::{Drawn, Form, Lists, MAX_POINTS, Reader};
use super::spec::Shape;
use crate::value::{Spanned, Value};
use orogen_grid::meanders::{Floodplain, Meanders};
use orogen_grid::multiscale::drawn_ridges::DrawnRidges;
use orogen_grid::multiscale::drawn_rivers::DrawnRivers;
use orogen_grid::polylines::outline::Outline;
use orogen_grid::polylines::segments::Segments;
use orogen_io::dem::file_ref::FileRef;
use orogen_io::format::drawing::Drawing;

/// The points of lines, at least two per line.
pub type LinePoints = PointLists<2>;

/// The corners of areas, at least three per ring.
pub type AreaPoints = PointLists<3>;

/// Lists of points, each with at least `MIN` points; it may be empty. Recipes write one list as `[[x, y], ...]` and
/// several as `[[[x, y], ...], ...]`; a third number of every point is its height.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PointLists<const MIN: usize> {
    lists: Arc<Lists>,
    form: Form,
    made: Box<Memos>,
}

/// What is made of the lists, in a box: a node has few lists, but every node has their size.
#[derive(Debug, Clone, PartialEq, Default)]
struct Memos {
    segments: Memo<Made>,
    rivers: Memo<MadeRivers>,
    ridges: Memo<MadeRidges>,
    floodplain: Memo<MadeFloodplain>,
}

/// Options of the conversion of points, or of a file's outlines, to segments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlineOptions {
    /// Whether lines are smooth curves through their points.
    pub smooth: bool,
    /// Whether all lines are closed.
    pub closed: bool,
    /// Maximum distance between a curve and its segments, in metres.
    pub tolerance: f64,
    /// Metres per unit of the file.
    pub scale: [f64; 2],
    /// Position of the file's origin, in metres.
    pub offset: [f64; 2],
}

/// Segments, with the options and the file from which they were made.
struct Made {
    options: OutlineOptions,
    file: Option<Arc<Drawing>>,
    segments: Segments,
}

/// Drawn rivers, with the file and the options from which they were made.
struct MadeRivers {
    file: Option<Arc<Drawing>>,
    smooth: bool,
    near: f64,
    rivers: Arc<DrawnRivers>,
}

/// Drawn ridges, with the file and the option from which they were made.
struct MadeRidges {
    file: Option<Arc<Drawing>>,
    smooth: bool,
    ridges: Arc<DrawnRidges>,
}

/// A floodplain, with the rivers, the file and the options from which it was made.
struct MadeFloodplain {
    river: Meanders,
    options: OutlineOptions,
    file: Option<Arc<Drawing>>,
    floodplain: Arc<Floodplain>,
}

/// Maximum distance between a curve of a file and the straight segments of a drawn river, in metres.
const RIVER_TOLERANCE: f64 = 1.0;

/// The points of straight segments that keep within `tolerance` of an outline.
fn points_of(outline: &Outline, tolerance: f64) -> Vec<[f64; 3]> {
    let mut points = vec![outline.start];
    outline.flatten(tolerance, |point| points.push(point));
    points
}

/// Whether two drawings are the same object, or neither is there.
fn is_same(one: Option<&Arc<Drawing>>, other: Option<&Arc<Drawing>>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => Arc::ptr_eq(one, other),
        (one, other) => one.is_none() && other.is_none(),
    }
}

impl<const MIN: usize> From<Vec<Vec<[f64; 3]>>> for PointLists<MIN> {
    fn from(lists: Lists) -> PointLists<MIN> {
        let form = Form { is_nested: lists.len() != 1, has_heights: true };
        PointLists { lists: Arc::new(lists), form, made: Box::default() }
    }
}

impl<const MIN: usize> From<Vec<Vec<[f64; 2]>>> for PointLists<MIN> {
    fn from(lists: Vec<Vec<[f64; 2]>>) -> PointLists<MIN> {
        let raised = lists.into_iter().map(|list| list.into_iter().map(|[x, y]| [x, y, 0.0]).collect());
        let mut made = PointLists::from(raised.collect::<Lists>());
        made.form.has_heights = false;
        made
    }
}

impl<const MIN: usize> From<Vec<[f64; 2]>> for PointLists<MIN> {
    fn from(list: Vec<[f64; 2]>) -> PointLists<MIN> {
        PointLists::from(vec![list])
    }
}

impl<const MIN: usize> From<Vec<[f64; 3]>> for PointLists<MIN> {
    fn from(list: Vec<[f64; 3]>) -> PointLists<MIN> {
        PointLists::from(vec![list])
    }
}

impl<const MIN: usize> PointLists<MIN> {
    /// Whether there are no points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lists.is_empty()
    }

    /// The points of each list: east, south, and the height, which is 0 if the points have none.
    #[must_use]
    pub fn lists(&self) -> &[Vec<[f64; 3]>] {
        &self.lists
    }

    /// The segments of the points and of the file's outlines. They are made once, and made again only for other options
    /// or another file.
    pub fn with_segments<T>(&self, file: &FileRef, options: OutlineOptions, read: impl FnOnce(&Segments) -> T) -> T {
        let drawing = file.drawing();
        let is_current = |made: &Made| is_same(made.file.as_ref(), drawing) && made.options == options;
        let make = || {
            let segments = Segments::new(&self.outlines(drawing, options), options.tolerance);
            Made { options, file: drawing.cloned(), segments }
        };
        read(&self.made.segments.get_or_make(is_current, make).segments)
    }

    /// The outlines of the points and of the file.
    fn outlines(&self, drawing: Option<&Arc<Drawing>>, options: OutlineOptions) -> Vec<Outline> {
        let own = self.lists.iter().map(|points| Outline::of_points(points));
        let read = drawing.into_iter().flat_map(|drawing| &drawing.outlines);
        let read = read.map(|outline| outline.placed(options.scale, options.offset));
        let outlines = own.chain(read).map(|outline| {
            let outline = if options.closed { outline.closed() } else { outline };
            if options.smooth { outline.smoothed() } else { outline }
        });
        outlines.collect()
    }

    /// The floodplain of rivers that start along the points and along the file's lines. It is made once, and again only
    /// for other options.
    #[must_use]
    pub fn floodplain(&self, file: &FileRef, options: OutlineOptions, river: Meanders) -> Arc<Floodplain> {
        let drawing = file.drawing();
        let is_current = |made: &MadeFloodplain| {
            is_same(made.file.as_ref(), drawing) && made.options == options && made.river == river
        };
        let make = || {
            let outlines = self.outlines(drawing, options);
            let lines: Vec<Vec<[f64; 3]>> =
                outlines.iter().map(|outline| points_of(outline, options.tolerance)).collect();
            MadeFloodplain { river, options, file: drawing.cloned(), floodplain: Arc::new(river.floodplain(&lines)) }
        };
        Arc::clone(&self.made.floodplain.get_or_make(is_current, make).floodplain)
    }

    /// The rivers along the points and along the file's lines, which are smooth curves if `smooth` is set. A line that
    /// ends within `near` metres of another is its tributary. They are made once, and again only for other options.
    #[must_use]
    pub fn drawn_rivers(&self, file: &FileRef, smooth: bool, near: f64) -> Arc<DrawnRivers> {
        let drawing = file.drawing();
        let is_current =
            |made: &MadeRivers| is_same(made.file.as_ref(), drawing) && made.smooth == smooth && made.near == near;
        let make = || {
            let lines = self.lines(drawing, smooth);
            MadeRivers { file: drawing.cloned(), smooth, near, rivers: Arc::new(DrawnRivers::new(&lines, near)) }
        };
        Arc::clone(&self.made.rivers.get_or_make(is_current, make).rivers)
    }

    /// The ridges along the points and of the file, which are smooth curves if `smooth` is set. They are made once, and
    /// again only for other options.
    #[must_use]
    pub fn drawn_ridges(&self, file: &FileRef, smooth: bool) -> Arc<DrawnRidges> {
        let drawing = file.drawing();
        let is_current = |made: &MadeRidges| is_same(made.file.as_ref(), drawing) && made.smooth == smooth;
        let make = || {
            let ridges = Arc::new(DrawnRidges::new(&self.lines(drawing, smooth)));
            MadeRidges { file: drawing.cloned(), smooth, ridges }
        };
        Arc::clone(&self.made.ridges.get_or_make(is_current, make).ridges)
    }

    /// The points of straight segments along the points and along the outlines of a file.
    fn lines(&self, drawing: Option<&Arc<Drawing>>, smooth: bool) -> Vec<Vec<[f64; 3]>> {
        let own = self.lists.iter().map(|points| Outline::of_points(points));
        let read = drawing.into_iter().flat_map(|drawing| drawing.outlines.iter().cloned());
        let lines = own.chain(read).map(|outline| {
            let outline = if smooth && !outline.pieces.is_empty() { outline.smoothed() } else { outline };
            points_of(&outline, RIVER_TOLERANCE)
        });
        lines.collect()
    }
}

impl<const MIN: usize> Param for PointLists<MIN> {
    const SHAPE: Shape = Shape::Points(MIN);

    fn read(value: &Value) -> Option<PointLists<MIN>> {
        let anywhere = [f64::NEG_INFINITY, f64::INFINITY];
        let reader = Reader { name: "", number: String::new(), drawn: Drawn::of_at_least(MIN), range: anywhere };
        let (lists, form) = reader.read(value).ok()?;
        Some(PointLists { lists: Arc::new(lists), form, made: Box::default() })
    }

    fn write(&self) -> Value {
        let list = |items: Vec<Value>| Value::List(items.into_iter().map(Spanned::unplaced).collect());
        let numbers = if self.form.has_heights { 3 } else { 2 };
        let point = |point: &[f64; 3]| list(point[..numbers].iter().map(|number| Value::Number(*number)).collect());
        let points = |points: &Vec<[f64; 3]>| list(points.iter().map(point).collect());
        match (self.lists.as_slice(), self.form.is_nested) {
            ([only], false) => points(only),
            (lists, _) => list(lists.iter().map(points).collect()),
        }
    }

    fn within(&self, [low, high]: [f64; 2]) -> bool {
        let numbers = || self.lists.iter().flatten().flatten();
        self.lists.iter().all(|points| points.len() >= MIN)
            && self.lists.iter().map(Vec::len).sum::<usize>() <= MAX_POINTS
            && numbers().all(|number| number.is_finite() && (low..=high).contains(number))
    }
}
