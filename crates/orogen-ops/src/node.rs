//! Nodes of recipes: an enum of all built-in ops and of ops that programs register.

use crate::declare::{Declared, Input, InputName, Spec};
use crate::layer::Layer;
use crate::op::{Field, Filter, Levelled, Op, OpType, Solver};
use crate::registered::RegisteredOp;
use crate::value::Value;
use crate::{field, filter, levelled, solver};
use orogen_io::dem::file_ref::FileRef;
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::LazyLock;

macro_rules! nodes {
    (
        field { $( $field:ident, )* }
        filter { $( $filter:ident, )* }
        levelled { $( $levelled:ident, )* }
        solver { $( $solver:ident, )* }
    ) => {
        /// One node of a recipe: an op with its inputs and parameters.
        #[derive(Debug, Clone, PartialEq)]
        #[allow(missing_docs, reason = "each variant is the struct of the same name")]
        pub enum Node {
            $( $field(field::$field), )*
            $( $filter(filter::$filter), )*
            $( $levelled(levelled::$levelled), )*
            $( $solver(solver::$solver), )*
            /// An op of the program that uses this crate.
            Registered(RegisteredOp),
        }

        impl<T: OpType> From<T> for Node {
            /// A built-in op becomes its own variant, any other op becomes [`Node::Registered`].
            fn from(op: T) -> Node {
                match built_in(&op) {
                    Some(node) => node,
                    None => Node::Registered(RegisteredOp::new(op)),
                }
            }
        }

        /// A separate function, because `From` is compiled once per op and crate.
        fn built_in(op: &dyn Any) -> Option<Node> {
            $( if let Some(op) = op.downcast_ref::<field::$field>() { return Some(Node::$field(op.clone())); } )*
            $( if let Some(op) = op.downcast_ref::<filter::$filter>() { return Some(Node::$filter(op.clone())); } )*
            $( if let Some(op) = op.downcast_ref::<levelled::$levelled>() { return Some(Node::$levelled(op.clone())); } )*
            $( if let Some(op) = op.downcast_ref::<solver::$solver>() { return Some(Node::$solver(op.clone())); } )*
            None
        }

        impl Node {
            /// Every built-in op, with its defaults. A `Registry` of the engine also lists the ops of the program.
            pub fn all() -> Vec<Node> {
                vec![
                    $( Node::$field(Default::default()), )*
                    $( Node::$filter(Default::default()), )*
                    $( Node::$levelled(Default::default()), )*
                    $( Node::$solver(Default::default()), )*
                ]
            }

            fn declared(&self) -> &dyn Declared {
                match self {
                    $( Node::$field(op) => op, )*
                    $( Node::$filter(op) => op, )*
                    $( Node::$levelled(op) => op, )*
                    $( Node::$solver(op) => op, )*
                    Node::Registered(op) => op.declared(),
                }
            }

            fn declared_mut(&mut self) -> &mut dyn Declared {
                match self {
                    $( Node::$field(op) => op, )*
                    $( Node::$filter(op) => op, )*
                    $( Node::$levelled(op) => op, )*
                    $( Node::$solver(op) => op, )*
                    Node::Registered(op) => op.declared_mut(),
                }
            }

            /// The op of the node, by its locality.
            pub fn op(&self) -> Op<'_> {
                match self {
                    $( Node::$field(op) => Op::Field(op as &dyn Field), )*
                    $( Node::$filter(op) => Op::Filter(op as &dyn Filter), )*
                    $( Node::$levelled(op) => Op::Levelled(op as &dyn Levelled), )*
                    $( Node::$solver(op) => Op::Solver(op as &dyn Solver), )*
                    Node::Registered(op) => op.op(),
                }
            }
        }
    };
}

include!("node_list.rs");

impl Node {
    /// The built-in op of this name, with its defaults.
    pub fn named(op: &str) -> Option<Node> {
        static BUILT_IN: LazyLock<BTreeMap<&str, Node>> =
            LazyLock::new(|| Node::all().into_iter().map(|node| (node.spec().op, node)).collect());
        BUILT_IN.get(op).cloned()
    }

    /// The declaration of its op.
    #[must_use]
    pub fn spec(&self) -> &'static Spec {
        self.declared().spec()
    }

    /// Its inputs: the inputs that its op declares, or the names in its expression.
    #[must_use]
    pub fn inputs(&self) -> Vec<InputName<'_>> {
        self.declared().inputs()
    }

    /// Input `i` of [`Node::inputs`].
    #[must_use]
    pub fn input(&self, i: usize) -> &Input {
        self.declared().input(i)
    }

    /// Sets input `i`.
    pub fn set_input(&mut self, i: usize, input: Input) {
        self.declared_mut().set_input(i, input);
    }

    /// Parameter `i` of the declaration.
    #[must_use]
    pub fn param(&self, i: usize) -> Value {
        self.declared().param(i)
    }

    /// Sets parameter `i`; the error describes the valid values.
    pub fn set_param(&mut self, i: usize, value: &Value) -> Result<(), String> {
        self.declared_mut().set_param(i, value)
    }

    /// The part of parameter `i` that affects the node's result.
    #[must_use]
    pub fn param_key(&self, i: usize) -> Value {
        self.declared().param_key(i)
    }

    /// The length by which a solver's domain extends beyond each side of the world, in metres; `None` if the op has no
    /// such parameter.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        self.declared().margin()
    }

    /// Whether its result depends on the altitude at which it is sampled, other than through its inputs.
    #[must_use]
    pub fn reads_altitude(&self) -> bool {
        match self.op() {
            Op::Field(field) => field.reads_altitude() || self.declared().vertical() > 0.0,
            Op::Filter(_) | Op::Levelled(_) | Op::Solver(_) => false,
        }
    }

    /// The files that its parameters name.
    pub fn files(&mut self) -> Vec<&mut FileRef> {
        self.declared_mut().files()
    }

    /// Whether parameter `i` names a file.
    #[doc(hidden)]
    pub fn names_file(&mut self, i: usize) -> bool {
        self.declared_mut()
            .params_mut()
            .get_mut(i)
            .and_then(|param| param.file_ref())
            .is_some_and(|file| !file.is_empty())
    }

    /// Checks that parameters do not contradict each other; the error has a key and a message.
    pub fn consistent(&self) -> Result<(), (&'static str, String)> {
        self.declared().consistent()
    }

    /// The layers of the node.
    #[must_use]
    pub fn layers(&self) -> &'static [Layer] {
        self.spec().layers
    }

    /// The unit of a layer, or empty.
    #[must_use]
    pub fn unit(&self, layer: usize) -> &'static str {
        self.declared().unit(layer)
    }
}
