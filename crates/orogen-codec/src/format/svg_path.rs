//! Path data of SVG, from the attribute `d`, and other lists of numbers.

use orogen_grid::polylines::cubic::Cubic;
use orogen_grid::polylines::outline::{Outline, Piece};

/// Maximum angle of a piece of an arc, in radians. A cubic curve over it deviates by less than 1e-7 of the radius.
const MAX_ANGLE: f64 = std::f64::consts::PI / 8.0;

/// Numbers of an attribute, separated by spaces, by a comma, or by their own signs and decimal points.
pub struct Numbers<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Numbers<'a> {
    /// The numbers of a text.
    #[must_use]
    pub fn new(text: &'a str) -> Numbers<'a> {
        Numbers { bytes: text.as_bytes(), at: 0 }
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Skips white space.
    pub fn skip_spaces(&mut self) {
        while self.peek().is_some_and(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    /// Skips spaces, at most one comma, and spaces.
    pub fn skip_separator(&mut self) {
        self.skip_spaces();
        if self.peek() == Some(b',') {
            self.at += 1;
            self.skip_spaces();
        }
    }

    /// Whether only white space is left.
    #[must_use]
    pub fn is_at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// Whether a number begins here.
    fn is_number(&self) -> bool {
        self.peek().is_some_and(|byte| byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.'))
    }

    /// The text from here to the end.
    #[must_use]
    pub fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// Reads the next number and the separator after it.
    pub fn number(&mut self) -> Result<f64, String> {
        let start = self.at;
        let digits = |numbers: &mut Numbers| {
            let from = numbers.at;
            while numbers.peek().is_some_and(|byte| byte.is_ascii_digit()) {
                numbers.at += 1;
            }
            numbers.at > from
        };
        if matches!(self.peek(), Some(b'+' | b'-')) {
            self.at += 1;
        }
        let mut is_number = digits(self);
        if self.peek() == Some(b'.') {
            self.at += 1;
            is_number |= digits(self);
        }
        if is_number && matches!(self.peek(), Some(b'e' | b'E')) {
            let before = self.at;
            self.at += 1;
            if matches!(self.peek(), Some(b'+' | b'-')) {
                self.at += 1;
            }
            // `3em` is the number 3 and a unit.
            if !digits(self) {
                self.at = before;
            }
        }
        let text = std::str::from_utf8(&self.bytes[start..self.at]).unwrap_or_default();
        match text.parse::<f64>() {
            Ok(number) if is_number && number.is_finite() => {
                self.skip_separator();
                Ok(number)
            }
            _ => {
                self.at = start;
                Err(self.expected("a number"))
            }
        }
    }

    fn point(&mut self) -> Result<[f64; 2], String> {
        Ok([self.number()?, self.number()?])
    }

    /// Reads a flag of an arc, which needs no separator: `00` is two flags.
    fn flag(&mut self) -> Result<bool, String> {
        let flag = match self.peek() {
            Some(b'0') => false,
            Some(b'1') => true,
            _ => return Err(self.expected("the flag 0 or 1")),
        };
        self.at += 1;
        self.skip_separator();
        Ok(flag)
    }

    fn expected(&self, what: &str) -> String {
        let found: String = String::from_utf8_lossy(self.rest()).chars().take(12).collect();
        let found = if found.is_empty() { "the end".to_string() } else { format!("{found:?}") };
        format!("expected {what} at character {}, not {found}", self.at + 1)
    }
}

/// The points in a list of coordinate pairs, such as the attribute `points`.
pub fn points(text: &str) -> Result<Vec<[f64; 2]>, String> {
    let mut numbers = Numbers::new(text);
    numbers.skip_spaces();
    let mut points = Vec::new();
    while !numbers.is_at_end() {
        points.push(numbers.point()?);
    }
    Ok(points)
}

/// The subpaths of path data.
pub fn parse(text: &str) -> Result<Vec<Outline>, String> {
    let mut reader =
        Reader { numbers: Numbers::new(text), pen: Pen::default(), handle: Handle::None, has_moved: false };
    reader.numbers.skip_spaces();
    while !reader.numbers.is_at_end() {
        reader.command()?;
    }
    Ok(reader.pen.finish())
}

/// Creates outlines piece by piece.
#[derive(Default)]
pub struct Pen {
    done: Vec<Outline>,
    current: Option<Outline>,
    /// The first point of the subpath.
    start: [f64; 2],
    at: [f64; 2],
}

impl Pen {
    /// Begins a new outline.
    pub fn move_to(&mut self, at: [f64; 2]) {
        self.done.extend(self.current.take());
        (self.start, self.at) = (at, at);
    }

    fn push(&mut self, piece: Piece) {
        let [x, y] = self.at;
        let outline =
            self.current.get_or_insert_with(|| Outline { start: [x, y, 0.0], pieces: Vec::new(), closed: false });
        let [x, y, _] = piece.end();
        outline.pieces.push(piece);
        self.at = [x, y];
    }

    /// Draws a straight line.
    pub fn line_to(&mut self, [x, y]: [f64; 2]) {
        self.push(Piece::Straight([x, y, 0.0]));
    }

    fn curve_to(&mut self, control: [[f64; 2]; 2], [x, y]: [f64; 2]) {
        self.push(Piece::Curve(control, [x, y, 0.0]));
    }

    /// Draws an arc of an ellipse with these radii, rotated by an angle in degrees (SVG 2, appendix B.2).
    pub fn arc_to(&mut self, radii: [f64; 2], turn: f64, [is_large, is_positive]: [bool; 2], to: [f64; 2]) {
        let (from, [mut rx, mut ry]) = (self.at, radii.map(f64::abs));
        if from == to {
            return;
        }
        if rx == 0.0 || ry == 0.0 {
            return self.line_to(to);
        }
        let (sin, cos) = libm::sincos(turn.to_radians());
        let half = [0, 1].map(|k| 0.5 * (from[k] - to[k]));
        let (x, y) = (cos * half[0] + sin * half[1], cos * half[1] - sin * half[0]);
        // Radii that are too small are increased until the ellipse reaches both points.
        let reach = (x / rx) * (x / rx) + (y / ry) * (y / ry);
        if reach > 1.0 {
            (rx, ry) = (rx * reach.sqrt(), ry * reach.sqrt());
        }
        let root = ((1.0 - reach.min(1.0)) / reach.min(1.0)).sqrt();
        let root = if is_large == is_positive { -root } else { root };
        let (cx, cy) = (root * rx * y / ry, -root * ry * x / rx);
        let center = [cos * cx - sin * cy + 0.5 * (from[0] + to[0]), sin * cx + cos * cy + 0.5 * (from[1] + to[1])];
        let first = libm::atan2((y - cy) / ry, (x - cx) / rx);
        let last = libm::atan2((-y - cy) / ry, (-x - cx) / rx);
        let mut angle = last - first;
        if is_positive && angle < 0.0 {
            angle += std::f64::consts::TAU;
        } else if !is_positive && angle > 0.0 {
            angle -= std::f64::consts::TAU;
        }
        if !(angle.is_finite() && center.iter().all(|number| number.is_finite())) {
            return self.line_to(to);
        }
        let count = (angle.abs() / MAX_ANGLE).ceil().max(1.0);
        let step = angle / count;
        let reach = 4.0 / 3.0 * libm::tan(0.25 * step);
        let placed = |u: f64, v: f64| {
            let (u, v) = (rx * u, ry * v);
            [center[0] + (cos * u - sin * v), center[1] + (sin * u + cos * v)]
        };
        for k in 0..count as u32 {
            let (sin, cos) = libm::sincos(first + step * f64::from(k));
            let (next_sin, next_cos) = libm::sincos(first + step * f64::from(k + 1));
            let control = [
                placed(cos - reach * sin, sin + reach * cos),
                placed(next_cos + reach * next_sin, next_sin - reach * next_cos),
            ];
            let end = if k + 1 == count as u32 { to } else { placed(next_cos, next_sin) };
            self.curve_to(control, end);
        }
    }

    /// Draws a straight line to the start of the outline, and ends it.
    pub fn close(&mut self) {
        if let Some(outline) = &mut self.current {
            outline.closed = true;
        }
        self.move_to(self.start);
    }

    /// The finished outlines.
    #[must_use]
    pub fn finish(mut self) -> Vec<Outline> {
        self.done.extend(self.current.take());
        self.done
    }
}

/// The last control point, which smooth commands mirror.
enum Handle {
    None,
    Quadratic([f64; 2]),
    Cubic([f64; 2]),
}

struct Reader<'a> {
    numbers: Numbers<'a>,
    pen: Pen,
    handle: Handle,
    has_moved: bool,
}

impl Reader<'_> {
    /// Reads a command with all its repetitions.
    fn command(&mut self) -> Result<(), String> {
        let Some(letter) = self.numbers.peek().filter(u8::is_ascii_alphabetic) else {
            return Err(self.numbers.expected("a command such as M, L or C"));
        };
        if !self.has_moved && !letter.eq_ignore_ascii_case(&b'm') {
            return Err(self.numbers.expected("M, because a path begins with a move"));
        }
        self.has_moved = true;
        if !b"MLHVCSQTAZ".contains(&letter.to_ascii_uppercase()) {
            return Err(self.numbers.expected("one of the commands M L H V C S Q T A Z"));
        }
        self.numbers.at += 1;
        self.numbers.skip_spaces();
        let is_relative = letter.is_ascii_lowercase();
        if letter.eq_ignore_ascii_case(&b'z') {
            self.pen.close();
            self.handle = Handle::None;
            self.numbers.skip_spaces();
            return Ok(());
        }
        let mut is_repeated = false;
        loop {
            self.piece(letter.to_ascii_uppercase(), is_relative, is_repeated)?;
            is_repeated = true;
            if !self.numbers.is_number() {
                return Ok(());
            }
        }
    }

    fn point(&mut self, is_relative: bool) -> Result<[f64; 2], String> {
        let point = self.numbers.point()?;
        Ok(if is_relative { [0, 1].map(|k| self.pen.at[k] + point[k]) } else { point })
    }

    fn piece(&mut self, letter: u8, is_relative: bool, is_repeated: bool) -> Result<(), String> {
        let at = self.pen.at;
        let mirrored = |handle: [f64; 2]| [0, 1].map(|k| at[k] + (at[k] - handle[k]));
        let mut handle = Handle::None;
        match letter {
            b'M' if !is_repeated => {
                let to = self.point(is_relative)?;
                self.pen.move_to(to);
            }
            b'M' | b'L' => {
                let to = self.point(is_relative)?;
                self.pen.line_to(to);
            }
            b'H' | b'V' => {
                let axis = usize::from(letter == b'V');
                let mut to = at;
                to[axis] = self.numbers.number()? + if is_relative { at[axis] } else { 0.0 };
                self.pen.line_to(to);
            }
            b'C' | b'S' => {
                let first = match (letter, &self.handle) {
                    (b'C', _) => self.point(is_relative)?,
                    (_, Handle::Cubic(last)) => mirrored(*last),
                    _ => at,
                };
                let (second, to) = (self.point(is_relative)?, self.point(is_relative)?);
                self.pen.curve_to([first, second], to);
                handle = Handle::Cubic(second);
            }
            b'Q' | b'T' => {
                let control = match (letter, &self.handle) {
                    (b'Q', _) => self.point(is_relative)?,
                    (_, Handle::Quadratic(last)) => mirrored(*last),
                    _ => at,
                };
                let to = self.point(is_relative)?;
                let Cubic([_, first, second, _]) = Cubic::of_quadratic([at, control, to]);
                self.pen.curve_to([first, second], to);
                handle = Handle::Quadratic(control);
            }
            _ => {
                let radii = self.numbers.point()?;
                let turn = self.numbers.number()?;
                let flags = [self.numbers.flag()?, self.numbers.flag()?];
                let to = self.point(is_relative)?;
                self.pen.arc_to(radii, turn, flags, to);
            }
        }
        self.handle = handle;
        Ok(())
    }
}
