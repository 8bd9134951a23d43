//! An op of another crate as a trait object.

use crate::declare::Declared;
use crate::op::{Op, OpType};
use std::any::Any;
use std::fmt;

/// Maximum length of an op's name, in bytes.
const MAX_NAME: usize = 64;

/// An op that is not built in; [`Node::Registered`](crate::node::Node::Registered) holds it.
pub struct RegisteredOp(Box<dyn ErasedOp>);

/// The object-safe interface of an [`OpType`].
trait ErasedOp: Send + Sync {
    fn declared(&self) -> &dyn Declared;
    fn declared_mut(&mut self) -> &mut dyn Declared;
    fn op(&self) -> Op<'_>;
    fn any(&self) -> &dyn Any;
    fn copy(&self) -> Box<dyn ErasedOp>;
    fn equals(&self, other: &dyn ErasedOp) -> bool;
    fn debug(&self, formatter: &mut fmt::Formatter) -> fmt::Result;
}

impl<T: OpType> ErasedOp for T {
    fn declared(&self) -> &dyn Declared {
        self
    }

    fn declared_mut(&mut self) -> &mut dyn Declared {
        self
    }

    fn op(&self) -> Op<'_> {
        self.as_op()
    }

    fn any(&self) -> &dyn Any {
        self
    }

    fn copy(&self) -> Box<dyn ErasedOp> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn ErasedOp) -> bool {
        other.any().downcast_ref::<T>().is_some_and(|other| self == other)
    }

    fn debug(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        fmt::Debug::fmt(self, formatter)
    }
}

impl RegisteredOp {
    pub(crate) fn new(op: impl OpType) -> RegisteredOp {
        RegisteredOp(Box::new(op))
    }

    /// The op, if it is of this type.
    #[must_use]
    pub fn get<T: OpType>(&self) -> Option<&T> {
        self.0.any().downcast_ref()
    }

    pub(crate) fn declared(&self) -> &dyn Declared {
        self.0.declared()
    }

    pub(crate) fn declared_mut(&mut self) -> &mut dyn Declared {
        self.0.declared_mut()
    }

    pub(crate) fn op(&self) -> Op<'_> {
        self.0.op()
    }
}

impl Clone for RegisteredOp {
    fn clone(&self) -> RegisteredOp {
        RegisteredOp(self.0.copy())
    }
}

impl PartialEq for RegisteredOp {
    fn eq(&self, other: &RegisteredOp) -> bool {
        self.0.equals(&*other.0)
    }
}

impl fmt::Debug for RegisteredOp {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        self.0.debug(formatter)
    }
}

/// The namespace of an op's name, if it has one.
#[must_use]
pub fn namespace(op: &str) -> Option<&str> {
    op.split_once('.').map(|(namespace, _)| namespace)
}

/// Checks the name of an op that is not built in. It must be `namespace.name`; names of built-in ops have no namespace,
/// now and later.
///
/// # Errors
/// The rule that the name violates.
pub fn check_name(op: &str) -> Result<(), String> {
    let is_word = |word: &str| {
        word.starts_with(|c: char| c.is_ascii_lowercase())
            && word.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-')
            && !word.ends_with('-')
            && !word.contains("--")
    };
    match op.split_once('.') {
        None => Err(format!(
            "the op `{op}` has no namespace; only built-in ops have none. Name it `NAMESPACE.{op}`, such as `mygame.{op}`"
        )),
        Some((namespace, name)) if is_word(namespace) && is_word(name) && op.len() <= MAX_NAME => Ok(()),
        Some(_) => Err(format!(
            "`{op}` cannot be an op's name: it must be a namespace, a dot and a name, such as `mygame.wide-terraces`, each of lower-case letters, digits and single `-`, \
             beginning with a letter, with at most {MAX_NAME} characters together"
        )),
    }
}
