//! Undo and redo of texts.

/// Maximum number of bytes of earlier texts; the oldest are dropped first.
const LIMIT: usize = 64 << 20;

/// A text, and the change that produced it.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Step {
    text: String,
    /// The change, as a key of the catalog of texts; empty for the first step.
    label: &'static str,
}

/// All texts of a document, one of which is current.
#[derive(Debug, Clone)]
pub struct History {
    steps: Vec<Step>,
    at: usize,
    /// The gesture that made the current step, until it ends: its further changes replace the step.
    gesture: Option<String>,
}

impl History {
    /// The history of a newly opened text.
    #[must_use]
    pub fn new(text: String) -> History {
        History { steps: vec![Step { text, label: "" }], at: 0, gesture: None }
    }

    /// The current text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.steps[self.at].text
    }

    /// Makes a text the current one. Successive changes with the same gesture name, such as the drag of a slider, are
    /// one step. Undone steps are dropped.
    pub fn push(&mut self, text: String, label: &'static str, gesture: Option<&str>) {
        if text == self.text() {
            return;
        }
        self.steps.truncate(self.at + 1);
        let goes_on = gesture.is_some() && self.gesture.as_deref() == gesture && self.at > 0;
        match goes_on {
            true => self.steps[self.at].text = text,
            false => {
                self.steps.push(Step { text, label });
                self.at += 1;
            }
        }
        self.gesture = gesture.map(str::to_owned);
        self.forget();
    }

    /// Ends the current gesture: the next change starts a new step.
    pub fn end_gesture(&mut self) {
        self.gesture = None;
    }

    /// The change that undo would revert, as a key of the catalog.
    #[must_use]
    pub fn undo_label(&self) -> Option<&'static str> {
        (self.at > 0).then(|| self.steps[self.at].label)
    }

    /// The change that redo would make, as a key of the catalog.
    #[must_use]
    pub fn redo_label(&self) -> Option<&'static str> {
        self.steps.get(self.at + 1).map(|step| step.label)
    }

    /// Goes back by one step; false if there is none.
    pub fn undo(&mut self) -> bool {
        self.go(self.at.checked_sub(1))
    }

    /// Goes forward by one step; false if there is none.
    pub fn redo(&mut self) -> bool {
        self.go(Some(self.at + 1).filter(|at| *at < self.steps.len()))
    }

    /// The changes of all steps, oldest first, as keys of the catalog; the first step has none.
    #[must_use]
    pub fn labels(&self) -> impl ExactSizeIterator<Item = &'static str> + '_ {
        self.steps.iter().map(|step| step.label)
    }

    /// The number of the current step, from 0.
    #[must_use]
    pub fn at(&self) -> usize {
        self.at
    }

    /// Goes to a step; false if there is none or it is the current one.
    pub fn go_to(&mut self, step: usize) -> bool {
        self.go(Some(step).filter(|step| *step < self.steps.len() && *step != self.at))
    }

    fn go(&mut self, to: Option<usize>) -> bool {
        self.gesture = None;
        let Some(to) = to else { return false };
        self.at = to;
        true
    }

    /// Drops the oldest steps beyond the limit, but not the current one.
    fn forget(&mut self) {
        let mut bytes: usize = self.steps.iter().map(|step| step.text.len()).sum();
        while bytes > LIMIT && self.at > 0 {
            bytes -= self.steps.remove(0).text.len();
            self.at -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_undone_and_redone() {
        let mut history = History::new("a".into());
        assert!(!history.undo() && !history.redo());
        history.push("b".into(), "edit", None);
        history.push("c".into(), "seed", None);
        assert_eq!((history.undo_label(), history.redo_label()), (Some("seed"), None));
        assert!(history.undo() && history.undo() && !history.undo());
        assert_eq!((history.text(), history.redo_label()), ("a", Some("edit")));
        assert!(history.redo());
        assert_eq!(history.text(), "b");
        history.push("d".into(), "edit", None);
        assert!(!history.redo());
        assert_eq!(history.text(), "d");
    }

    #[test]
    fn any_step_is_reached_at_once() {
        let mut history = History::new("a".into());
        for (text, label) in [("b", "edit"), ("c", "seed"), ("d", "edit")] {
            history.push(text.into(), label, None);
        }
        assert_eq!(history.labels().collect::<Vec<_>>(), ["", "edit", "seed", "edit"]);
        assert!(history.go_to(1) && !history.go_to(1) && !history.go_to(4));
        assert_eq!((history.at(), history.text(), history.redo_label()), (1, "b", Some("seed")));
        assert!(history.go_to(3));
        assert_eq!(history.text(), "d");
    }

    #[test]
    fn a_gesture_is_one_step() {
        let mut history = History::new("0".into());
        for text in ["1", "2", "3"] {
            history.push(text.into(), "value", Some("slider"));
        }
        history.end_gesture();
        history.push("4".into(), "value", Some("slider"));
        assert!(history.undo());
        assert_eq!(history.text(), "3");
        assert!(history.undo());
        assert_eq!(history.text(), "0");
        // After an undo, the same gesture starts a new step.
        history.push("5".into(), "value", Some("slider"));
        history.undo();
        assert_eq!(history.text(), "0");
    }

    #[test]
    fn an_equal_text_is_no_step() {
        let mut history = History::new("a".into());
        history.push("a".into(), "edit", None);
        assert!(!history.undo());
    }

    #[test]
    fn old_texts_are_forgotten() {
        let mut history = History::new("0".repeat(LIMIT / 2));
        history.push("1".repeat(LIMIT / 2), "edit", None);
        history.push("2".repeat(LIMIT / 2), "edit", None);
        assert!(history.undo() && !history.undo());
        assert!(history.text().starts_with('1'));
    }
}
