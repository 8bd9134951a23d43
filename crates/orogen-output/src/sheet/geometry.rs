//! Points, sizes, rectangles and affine maps on a page, in millimetres from the left and from the top.

/// A position: millimetres from the left and from the top of the page.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// Distance from the left.
    pub x: f32,
    /// Distance from the top.
    pub y: f32,
}

impl Point {
    /// The point at these distances.
    #[must_use]
    pub const fn new(x: f32, y: f32) -> Point {
        Point { x, y }
    }

    /// The point moved to the right and down by these distances.
    #[must_use]
    pub fn moved(self, right: f32, down: f32) -> Point {
        Point::new(self.x + right, self.y + down)
    }

    /// Multiplies both distances by a factor.
    #[must_use]
    pub fn scaled(self, by: f32) -> Point {
        Point::new(self.x * by, self.y * by)
    }

    /// The point at this share of the way to another point: 0 is this point, 1 the other.
    #[must_use]
    pub fn toward(self, other: Point, share: f32) -> Point {
        let way = self.to(other);
        Point::new(self.x + way.x * share, self.y + way.y * share)
    }

    /// The vector to another point.
    #[must_use]
    pub fn to(self, other: Point) -> Vector {
        Vector { x: other.x - self.x, y: other.y - self.y }
    }

    /// The distance to another point.
    #[must_use]
    pub fn distance(self, other: Point) -> f32 {
        self.to(other).length()
    }

    /// Whether both distances are finite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl From<[f32; 2]> for Point {
    fn from([x, y]: [f32; 2]) -> Point {
        Point::new(x, y)
    }
}

/// A vector in millimetres, to the right and down.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vector {
    /// To the right.
    pub x: f32,
    /// Down.
    pub y: f32,
}

impl Vector {
    /// The square of the length.
    #[must_use]
    pub fn square(self) -> f32 {
        self.x * self.x + self.y * self.y
    }

    /// The length.
    #[must_use]
    pub fn length(self) -> f32 {
        self.square().sqrt()
    }

    /// The direction in radians clockwise from the right, because y points down.
    #[must_use]
    pub fn direction(self) -> f32 {
        libm::atan2f(self.y, self.x)
    }
}

/// A width and a height.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Size {
    /// The width.
    pub width: f32,
    /// The height.
    pub height: f32,
}

impl Size {
    /// A size.
    #[must_use]
    pub const fn new(width: f32, height: f32) -> Size {
        Size { width, height }
    }

    /// Applies `change` to both sides.
    #[must_use]
    pub fn map(self, change: impl Fn(f32) -> f32) -> Size {
        Size::new(change(self.width), change(self.height))
    }

    /// Number of pixels along both sides at `dpi` pixels per inch, at least 1.
    #[must_use]
    pub fn pixels(self, dpi: f64) -> [usize; 2] {
        [self.width, self.height].map(|side| ((f64::from(side) * dpi / 25.4).round() as usize).max(1))
    }
}

/// A rectangle with horizontal and vertical sides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rect {
    /// The left side.
    pub left: f32,
    /// The upper side.
    pub top: f32,
    /// The width.
    pub width: f32,
    /// The height.
    pub height: f32,
}

impl Rect {
    /// A rectangle with this upper left corner and this size.
    #[must_use]
    pub const fn new(left: f32, top: f32, width: f32, height: f32) -> Rect {
        Rect { left, top, width, height }
    }

    /// The upper left corner.
    #[must_use]
    pub fn corner(self) -> Point {
        Point::new(self.left, self.top)
    }

    /// The width and height.
    #[must_use]
    pub fn size(self) -> Size {
        Size::new(self.width, self.height)
    }

    /// The right side.
    #[must_use]
    pub fn right(self) -> f32 {
        self.left + self.width
    }

    /// The lower side.
    #[must_use]
    pub fn bottom(self) -> f32 {
        self.top + self.height
    }

    /// The corners, clockwise from the upper left one.
    #[must_use]
    pub fn corners(self) -> [Point; 4] {
        let (right, bottom) = (self.right(), self.bottom());
        [[self.left, self.top], [right, self.top], [right, bottom], [self.left, bottom]].map(Point::from)
    }

    /// The point at these shares of the width and height.
    #[must_use]
    pub fn at(self, across: f32, down: f32) -> Point {
        Point::new(self.left + self.width * across, self.top + self.height * down)
    }

    /// The rectangle with all sides moved inwards by a distance.
    #[must_use]
    pub fn inset(self, by: f32) -> Rect {
        Rect::new(self.left + by, self.top + by, self.width - 2.0 * by, self.height - 2.0 * by)
    }

    /// Multiplies position and size by a factor.
    #[must_use]
    pub fn scaled(self, by: f32) -> Rect {
        Rect::new(self.left * by, self.top * by, self.width * by, self.height * by)
    }
}

/// An affine map of points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Affine {
    /// The image of (0, 0).
    pub origin: Point,
    /// The image of a step of 1 to the right.
    pub right: Vector,
    /// The image of a step of 1 down.
    pub down: Vector,
}

impl Affine {
    /// Scales by these factors to the right and down, then moves (0, 0) to `origin`.
    #[must_use]
    pub const fn scaling(origin: Point, across: f32, down: f32) -> Affine {
        Affine { origin, right: Vector { x: across, y: 0.0 }, down: Vector { x: 0.0, y: down } }
    }

    /// Rotates by `angle` radians counter-clockwise and moves (0, 0) to `origin`. Input points have y up, as in fonts.
    #[must_use]
    pub fn turning(origin: Point, angle: f32) -> Affine {
        let (sin, cos) = libm::sincosf(angle);
        Affine { origin, right: Vector { x: cos, y: -sin }, down: Vector { x: -sin, y: -cos } }
    }

    /// The image of a point.
    #[must_use]
    pub fn apply(self, Point { x, y }: Point) -> Point {
        let Affine { origin, right, down } = self;
        Point::new(origin.x + x * right.x + y * down.x, origin.y + x * right.y + y * down.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_have_sides_and_corners() {
        let rect = Rect::new(10.0, 20.0, 30.0, 40.0);
        assert_eq!((rect.right(), rect.bottom()), (40.0, 60.0));
        assert_eq!(rect.corners(), [[10.0, 20.0], [40.0, 20.0], [40.0, 60.0], [10.0, 60.0]].map(Point::from));
        assert_eq!(rect.inset(5.0), Rect::new(15.0, 25.0, 20.0, 30.0));
        assert_eq!(rect.at(0.5, 1.0), Point::new(25.0, 60.0));
        assert_eq!(rect.size().pixels(25.4), [30, 40]);
        assert_eq!(Size::new(0.01, 2.0).pixels(25.4), [1, 2]);
    }

    #[test]
    fn maps_turn_and_scale() {
        let at = Point::new(5.0, 7.0);
        assert_eq!(Affine::scaling(at, 2.0, 3.0).apply(Point::new(1.0, 10.0)), Point::new(7.0, 37.0));
        // Text that runs upwards: a step along it goes up, its ascent to the left.
        let turned = Affine::turning(at, std::f32::consts::FRAC_PI_2);
        let near = |a: Point, b: Point| a.distance(b) < 1e-6;
        assert!(near(turned.apply(Point::new(2.0, 0.0)), at.moved(0.0, -2.0)));
        assert!(near(turned.apply(Point::new(0.0, 2.0)), at.moved(-2.0, 0.0)));
        assert_eq!(Point::new(0.0, 4.0).to(Point::new(3.0, 0.0)).length(), 5.0);
        assert_eq!(at.toward(Point::new(9.0, 7.0), 0.25), Point::new(6.0, 7.0));
    }
}
