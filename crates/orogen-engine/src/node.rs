//! The list of all ops, as an enum.

use crate::declare::{Declared, Input, InputName, Spec};
use crate::layer::Layer;
use crate::op::{Field, Filter, Op, Solver};
use crate::value::Value;
use crate::{field, filter, solver};
use orogen_io::dem::file_ref::FileRef;

macro_rules! nodes {
    (
        field { $( $field_mod:ident :: $field:ident, )* }
        filter { $( $filter_mod:ident :: $filter:ident, )* }
        solver { $( $solver_mod:ident :: $solver:ident, )* }
    ) => {
        /// One node of a recipe: an op with its inputs and parameters.
        #[derive(Debug, Clone, PartialEq)]
        #[allow(missing_docs, reason = "each variant is the struct of the same name")]
        pub enum Node {
            $( $field(field::$field_mod::$field), )*
            $( $filter(filter::$filter_mod::$filter), )*
            $( $solver(solver::$solver_mod::$solver), )*
        }

        $( impl From<field::$field_mod::$field> for Node { fn from(op: field::$field_mod::$field) -> Node { Node::$field(op) } } )*
        $( impl From<filter::$filter_mod::$filter> for Node { fn from(op: filter::$filter_mod::$filter) -> Node { Node::$filter(op) } } )*
        $( impl From<solver::$solver_mod::$solver> for Node { fn from(op: solver::$solver_mod::$solver) -> Node { Node::$solver(op) } } )*

        impl Node {
            /// All ops with their defaults.
            pub fn all() -> Vec<Node> {
                vec![
                    $( Node::$field(Default::default()), )*
                    $( Node::$filter(Default::default()), )*
                    $( Node::$solver(Default::default()), )*
                ]
            }

            fn declared(&self) -> &dyn Declared {
                match self { $( Node::$field(op) => op, )* $( Node::$filter(op) => op, )* $( Node::$solver(op) => op, )* }
            }

            fn declared_mut(&mut self) -> &mut dyn Declared {
                match self { $( Node::$field(op) => op, )* $( Node::$filter(op) => op, )* $( Node::$solver(op) => op, )* }
            }

            /// The node as a field, a filter or a solver.
            pub fn op(&self) -> Op<'_> {
                match self {
                    $( Node::$field(op) => Op::Field(op as &dyn Field), )*
                    $( Node::$filter(op) => Op::Filter(op as &dyn Filter), )*
                    $( Node::$solver(op) => Op::Solver(op as &dyn Solver), )*
                }
            }
        }
    };
}

include!("node_list.rs");

impl Node {
    /// The op with this name, with its defaults.
    pub fn named(op: &str) -> Option<Node> {
        Node::all().into_iter().find(|node| node.spec().op == op)
    }

    /// The declaration of its op.
    pub fn spec(&self) -> &'static Spec {
        self.declared().spec()
    }

    /// Its inputs: those that its op declares, or the names in its expression.
    pub fn inputs(&self) -> Vec<InputName<'_>> {
        self.declared().inputs()
    }

    /// Input `i` of [`Node::inputs`].
    pub fn input(&self, i: usize) -> &Input {
        self.declared().input(i)
    }

    /// Sets input `i`.
    pub fn set_input(&mut self, i: usize, input: Input) {
        self.declared_mut().set_input(i, input);
    }

    /// Parameter `i` of the declaration.
    pub fn param(&self, i: usize) -> Value {
        self.declared().param(i)
    }

    /// Sets parameter `i`; the error describes the valid values.
    pub fn set_param(&mut self, i: usize, value: &Value) -> Result<(), String> {
        self.declared_mut().set_param(i, value)
    }

    /// The part of parameter `i` that affects the node's result.
    pub fn param_key(&self, i: usize) -> Value {
        self.declared().param_key(i)
    }

    /// The files that its parameters name.
    pub fn files(&mut self) -> Vec<&mut FileRef> {
        self.declared_mut().files()
    }

    /// Checks that parameters do not contradict each other; the error has a key and a message.
    pub fn consistent(&self) -> Result<(), (&'static str, String)> {
        self.declared().consistent()
    }

    /// The layers of the node.
    pub fn layers(&self) -> &'static [Layer] {
        self.spec().layers
    }
}
