//! The resolution of the 3D view while something moves: as high as the time of a frame allows.

/// The time between two frames that is aimed at while something moves, in seconds: below it the resolution rises, above
/// it falls.
const FRAME: [f64; 2] = [0.036, 0.050];

/// Minimum share of the pixels along a side.
const MIN_SHARE: f32 = 0.25;

/// Seconds without a movement after which the picture is drawn with all pixels.
pub const REST: f64 = 0.15;

/// Times between frames above this contain a pause, in seconds.
const PAUSE: f64 = 2.0;

/// The resolution of the view.
#[derive(Debug, Clone, PartialEq)]
pub struct Pace {
    /// The share of the pixels along a side while something moves.
    share: f32,
    /// The time of the last movement.
    moved: f64,
    /// The time of the last frame that was drawn while the camera moved.
    last: Option<f64>,
    /// The longest time between frames since the camera moved.
    longest: f64,
}

/// What happened since the last frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Changes {
    /// The camera has moved.
    pub camera: bool,
    /// Something else has changed in the picture.
    pub picture: bool,
    /// A button of the pointer is down: more changes may follow.
    pub is_held: bool,
}

impl Pace {
    /// The resolution for a graphics card, or for a CPU that draws. The first movement has it; the next ones have what
    /// their time allows.
    #[must_use]
    pub fn new(is_software: bool) -> Pace {
        Pace { share: if is_software { 0.5 } else { 1.0 }, moved: f64::NEG_INFINITY, last: None, longest: 0.0 }
    }

    /// The share of the pixels along a side for this frame. `time` is that of the interface, and `clock` the real time,
    /// both in seconds: a test may have an interface with a time of its own.
    pub fn share(&mut self, changes: Changes, time: f64, clock: f64) -> f32 {
        if let Some(last) = self.last.filter(|last| clock - last < PAUSE) {
            self.longest = self.longest.max(clock - last);
            // Between two movements the interface may draw the same picture again, which takes little time.
            if changes.camera {
                self.adapt(self.longest);
            }
        }
        if changes.camera {
            self.longest = 0.0;
        }
        if changes.camera || changes.picture {
            self.moved = time;
        }
        let is_moving = self.is_moving(time) || changes.is_held;
        self.last = (changes.camera || (is_moving && self.last.is_some())).then_some(clock);
        if is_moving { self.share } else { 1.0 }
    }

    /// Whether something moved just now.
    #[must_use]
    pub fn is_moving(&self, time: f64) -> bool {
        time - self.moved < REST
    }

    fn adapt(&mut self, seconds: f64) {
        // The time grows with the number of pixels; a part of it does not depend on them.
        let factor = match seconds {
            long if long > FRAME[1] => libm::sqrt(FRAME[1] / long).clamp(0.6, 0.97),
            short if short < FRAME[0] => 1.06,
            _ => 1.0,
        };
        self.share = (self.share * factor as f32).clamp(MIN_SHARE, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Changes = Changes { camera: true, picture: true, is_held: true };

    /// The share after a number of moving frames, each of which takes `seconds` at full resolution, of which `fixed` do
    /// not depend on it.
    fn after(frames: usize, seconds: f64, fixed: f64) -> (f32, f64) {
        let (mut pace, mut clock, mut taken) = (Pace::new(true), 0.0, 0.0);
        for _ in 0..frames {
            let share = f64::from(pace.share(CAMERA, clock, clock));
            taken = fixed + (seconds - fixed) * share * share;
            clock += taken;
        }
        (pace.share, taken)
    }

    #[test]
    fn frames_become_quick_enough_and_no_coarser_than_needed() {
        for seconds in [0.08, 0.2, 0.4] {
            let (share, taken) = after(60, seconds, 0.02);
            assert!(taken < 0.055 && taken > 0.03 && share < 1.0, "{seconds}: {share}, {taken}");
        }
        assert_eq!(after(60, 0.016, 0.0).0, 1.0);
        assert_eq!(after(60, 1.5, 0.1).0, MIN_SHARE);
    }

    #[test]
    fn all_pixels_are_drawn_at_rest() {
        let mut pace = Pace::new(true);
        assert_eq!(pace.share(Changes::default(), 0.0, 0.0), 1.0);
        assert_eq!(pace.share(Changes { picture: true, ..Changes::default() }, 1.0, 1.0), 0.5);
        assert_eq!(pace.share(Changes::default(), 1.1, 1.1), 0.5);
        assert_eq!(pace.share(Changes { is_held: true, ..Changes::default() }, 1.2, 1.2), 0.5);
        assert_eq!(pace.share(Changes::default(), 1.3, 1.3), 1.0);
    }

    #[test]
    fn pauses_between_movements_do_not_count() {
        let mut pace = Pace::new(false);
        for k in 0..50 {
            // Every fifth frame changes; the others are drawn at once.
            let time = f64::from(k) * 0.02;
            pace.share(Changes { camera: k % 5 == 0, ..Changes::default() }, time, time);
            let late = f64::from(k) * 100.0;
            pace.share(CAMERA, late, late);
        }
        assert_eq!(pace.share, 1.0);
    }
}
