//! A value that is computed from parameters once and shared.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// The last computed value. Any thread can use it without computing it again.
pub struct Memo<T>(Mutex<Option<Arc<T>>>);

impl<T> Memo<T> {
    /// The value, if it is current; otherwise a new one. Other threads wait while it is computed.
    pub fn get_or_make(&self, is_current: impl FnOnce(&T) -> bool, make: impl FnOnce() -> T) -> Arc<T> {
        let mut made = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match made.as_ref().filter(|value| is_current(value)) {
            Some(value) => Arc::clone(value),
            None => Arc::clone(made.insert(Arc::new(make()))),
        }
    }
}

impl<T> Default for Memo<T> {
    fn default() -> Memo<T> {
        Memo(Mutex::new(None))
    }
}

/// A copy shares the value until one of them computes a new one.
impl<T> Clone for Memo<T> {
    fn clone(&self) -> Memo<T> {
        Memo(Mutex::new(self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()))
    }
}

/// Always equal: a value that follows from parameters does not distinguish nodes.
impl<T> PartialEq for Memo<T> {
    fn eq(&self, _: &Memo<T>) -> bool {
        true
    }
}

impl<T> fmt::Debug for Memo<T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("Memo")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_made_once_until_it_is_not_current() {
        let memo = Memo::default();
        let mut made = 0;
        let mut get = |memo: &Memo<i32>, wanted: i32| {
            *memo.get_or_make(
                |value| *value == wanted,
                || {
                    made += 1;
                    wanted
                },
            )
        };
        assert_eq!(
            [get(&memo, 1), get(&memo, 1), get(&memo.clone(), 1), get(&memo, 2), get(&memo, 2)],
            [1, 1, 1, 2, 2]
        );
        assert_eq!(made, 2);
        assert_eq!(memo, Memo::default());
    }
}
