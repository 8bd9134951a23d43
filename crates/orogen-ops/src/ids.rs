//! Ids: typed indices, so that indices of different kinds cannot be confused.

use serde::{Deserialize, Serialize};
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut, Index, IndexMut};

/// An index of elements of one kind.
pub trait Id: Copy {
    /// The id of the element at an index.
    fn new(index: usize) -> Self;
    /// The index.
    fn index(self) -> usize;
}

macro_rules! ids {
    ($( $(#[doc = $doc:literal])+ $name:ident, )+) => { $(
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(usize);

        impl Id for $name {
            fn new(index: usize) -> $name {
                $name(index)
            }

            fn index(self) -> usize {
                self.0
            }
        }
    )+ };
}

ids! {
    /// A node of a recipe.
    NodeId,
    /// A step of a plan.
    StepId,
    /// A grid of a plan.
    GridId,
    /// A grid that a plan's program or filter requests, before the step that makes it is known.
    RequestId,
    /// A register of a program: one block of samples.
    RegisterId,
    /// A coordinate set of a program: the points at which samples are evaluated.
    CoordSetId,
}

impl CoordSetId {
    /// The block itself.
    pub const BLOCK: CoordSetId = CoordSetId(0);
}

/// Elements by their ids.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct IndexVec<I, T> {
    elements: Vec<T>,
    #[serde(skip)]
    ids: PhantomData<I>,
}

impl<I: Id, T> IndexVec<I, T> {
    /// Adds an element and returns its id.
    pub fn push(&mut self, element: T) -> I {
        self.elements.push(element);
        I::new(self.elements.len() - 1)
    }

    /// The element, if there is one.
    #[must_use]
    pub fn find(&self, id: I) -> Option<&T> {
        self.elements.get(id.index())
    }

    /// The elements with their ids.
    #[must_use]
    pub fn entries(&self) -> impl DoubleEndedIterator<Item = (I, &T)> {
        self.elements.iter().enumerate().map(|(index, element)| (I::new(index), element))
    }

    /// Changes the number of elements; new ones come from `make`.
    pub fn resize_with(&mut self, len: usize, make: impl FnMut() -> T) {
        self.elements.resize_with(len, make);
    }
}

impl<I, T> Default for IndexVec<I, T> {
    fn default() -> IndexVec<I, T> {
        IndexVec::from(Vec::new())
    }
}

impl<I, T> From<Vec<T>> for IndexVec<I, T> {
    fn from(elements: Vec<T>) -> IndexVec<I, T> {
        IndexVec { elements, ids: PhantomData }
    }
}

impl<I, T> FromIterator<T> for IndexVec<I, T> {
    fn from_iter<E: IntoIterator<Item = T>>(elements: E) -> IndexVec<I, T> {
        elements.into_iter().collect::<Vec<T>>().into()
    }
}

impl<'a, I, T> IntoIterator for &'a IndexVec<I, T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.elements.iter()
    }
}

impl<I: Id, T> Index<I> for IndexVec<I, T> {
    type Output = T;

    fn index(&self, id: I) -> &T {
        &self.elements[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for IndexVec<I, T> {
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.elements[id.index()]
    }
}

impl<I, T> Deref for IndexVec<I, T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.elements
    }
}

impl<I, T> DerefMut for IndexVec<I, T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.elements
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_keep_their_ids_in_text() {
        let mut names: IndexVec<NodeId, &str> = IndexVec::default();
        let [first, second] = ["first", "second"].map(|name| names.push(name));
        assert_eq!((names[first], names[second], names.len()), ("first", "second", 2));
        assert_eq!(names.find(NodeId::new(2)), None);
        assert_eq!(serde_json::to_string(&(second, &names)).unwrap(), "[1,[\"first\",\"second\"]]");
    }
}
