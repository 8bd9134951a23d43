//! The ops that recipes may use: built-in ops and ops of the program.

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::{nearest, respelled, suggestion};
use orogen_ops::declare::Spec;
use orogen_ops::node::Node;
use orogen_ops::op::OpType;
use orogen_ops::registered::{check_name, namespace};

/// The ops that recipes may use by their names: all built-in ops, and the ops that the program registers.
///
/// A registry is a value. It reads recipes ([`Registry::read`], [`Registry::parse`]) and writes their
/// [schema](crate::recipe::schema::json_schema_of) and [reference](crate::recipe::reference::markdown_of). Only texts
/// need it. A recipe contains its ops, and so do its worlds, plans and sessions. [`Recipe::add`](crate::Recipe::add)
/// accepts any op without a registry.
///
/// ```
/// use orogen_engine::op::{Field, Inputs, WorldParams};
/// use orogen_engine::registry::Registry;
/// use orogen_engine::{Points, Result, World};
///
/// orogen_engine::op! {
///     /// The source in steps.
///     pub struct Steps = "example.steps", field, revision 1;
///     inputs {
///         /// The heights to round.
///         source: required,
///     }
///     params {
///         /// Height of a step.
///         height: f64 = 10.0, unit "m", range 1e-3 to 1e5;
///     }
/// }
///
/// impl Field for Steps {
///     fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
///         let height = self.height as f32;
///         for (out, source) in out.iter_mut().zip(inputs.required("source")?) {
///             *out = (source / height).floor() * height;
///         }
///         Ok(())
///     }
/// }
///
/// let mut registry = Registry::new();
/// registry.register::<Steps>()?;
/// let recipe = registry.parse(
///     r#"
///     orogen = 1
///     outputs = { height = "steps" }
///     nodes.hills = { op = "remap", source = "noise", from = [-1, 1], to = [0, 200] }
///     nodes.noise = { op = "fbm" }
///     nodes.steps = { op = "example.steps", source = "hills", height = 25 }
///     "#,
///     "example",
/// )?;
/// assert_eq!(World::open(recipe)?.height(120.0, 80.0)? % 25.0, 0.0);
/// # Ok::<(), orogen_engine::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Registry {
    registered: Vec<Node>,
}

impl Registry {
    /// A registry with only the built-in ops.
    #[must_use]
    pub fn new() -> Registry {
        Registry::default()
    }

    /// Adds an op that [`op!`](crate::op!) declares.
    ///
    /// # Errors
    /// If its name has no namespace or is not allowed, if an op of that name is registered already, or if its
    /// declaration is inconsistent.
    pub fn register<T: OpType>(&mut self) -> Result<&mut Registry> {
        let node = Node::from(T::default());
        self.check(&node).map_err(|message| Error::new(ErrorKind::Request, message))?;
        self.registered.push(node);
        Ok(self)
    }

    fn check(&self, node: &Node) -> std::result::Result<(), String> {
        let spec = node.spec();
        if !matches!(node, Node::Registered(_)) {
            return Err(format!("`{}` is a built-in op; it needs no registration", spec.op));
        }
        check_name(spec.op)?;
        let known = |op: &str| self.registered.iter().any(|node| node.spec().op == op);
        if let Some(taken) = [Some(spec.op.to_string()), respelled(spec.op)].into_iter().flatten().find(|op| known(op))
        {
            return Err(match taken == spec.op {
                true => format!("an op `{taken}` is registered already; rename one of them"),
                false => format!("`{}` is another spelling of the op `{taken}`, which is registered already", spec.op),
            });
        }
        check_keys(spec)?;
        let mut copy = node.clone();
        for i in 0..spec.params.len() {
            let default = node.param(i);
            copy.set_param(i, &default)
                .map_err(|message| format!("the op `{}` cannot have its defaults: {message}", spec.op))?;
        }
        Ok(())
    }

    /// All ops with their defaults: the built-in ones, then the registered ones in the order of registration.
    #[must_use]
    pub fn nodes(&self) -> Vec<Node> {
        Node::all().into_iter().chain(self.registered.iter().cloned()).collect()
    }

    /// The registered ops with their defaults.
    #[must_use]
    pub fn registered(&self) -> &[Node] {
        &self.registered
    }

    /// The op with this name, with its defaults.
    #[must_use]
    pub fn named(&self, op: &str) -> Option<Node> {
        match namespace(op) {
            Some(_) => self.registered.iter().find(|node| node.spec().op == op).cloned(),
            None => Node::named(op),
        }
    }

    /// The message for an unknown op name, with a suggestion.
    #[must_use]
    pub fn unknown(&self, op: &str) -> String {
        let registered = || self.registered.iter().map(|node| node.spec().op);
        let of_namespace = |wanted: &str| registered().filter(|op| namespace(op) == Some(wanted)).collect::<Vec<_>>();
        let Some(wanted) = namespace(op) else {
            // Perhaps only the namespace is missing.
            if let Some(name) = registered().find(|name| name.split_once('.').is_some_and(|(_, name)| name == op)) {
                return format!("unknown op `{op}`; did you mean `{name}`?");
            }
            let built_in = Node::all();
            let names: Vec<&str> = built_in.iter().map(|node| node.spec().op).chain(registered()).collect();
            return format!("unknown op `{op}`; {}", suggestion(op, names));
        };
        match of_namespace(wanted).as_slice() {
            [] => {
                let hint = match nearest(op, registered()) {
                    Some(near) => format!("; did you mean `{near}`?"),
                    None => ". Ops with a namespace belong to a program, which registers them before it reads recipes"
                        .to_string(),
                };
                format!("unknown op `{op}`: no op of the namespace `{wanted}` is registered{hint}")
            }
            ops => format!("unknown op `{op}`; {}", suggestion(op, ops.iter().copied())),
        }
    }
}

/// Whether a recipe can name every input and parameter of an op.
fn check_keys(spec: &Spec) -> std::result::Result<(), String> {
    let inputs = spec.inputs.iter().map(|input| input.name);
    let aliases = spec.aliases().map(|(alias, _)| alias);
    let mut seen = vec!["op", "mask"];
    for key in inputs.chain(spec.params.iter().map(|param| param.name)).chain(aliases) {
        if seen.contains(&key) {
            return Err(match key {
                "op" | "mask" => format!("the op `{}` cannot have a key `{key}`: every node has one", spec.op),
                _ => format!("the op `{}` has two keys `{key}`", spec.op),
            });
        }
        seen.push(key);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names of built-in ops have no namespace, so content keys differ from theirs.
    #[test]
    fn built_in_ops_have_no_namespace() {
        assert!(Node::all().iter().all(|node| namespace(node.spec().op).is_none()));
    }

    #[test]
    fn names_are_a_namespace_and_a_name() {
        for name in ["a.b", "mygame.wide-terraces", "g2.op-3d"] {
            assert_eq!(check_name(name), Ok(()), "{name}");
        }
        for name in [
            "terraces", ".a", "a.", "a.b.c", "A.b", "a.B", "a_b.c", "a.-b", "a.b-", "a.b--c", "2a.b", "a.2b", "a b.c",
            "é.b",
        ] {
            assert!(check_name(name).is_err(), "{name}");
        }
        assert!(check_name(&format!("a.{}", "b".repeat(63))).is_err());
        assert!(check_name("terraces").is_err_and(|message| message.contains("`mygame.terraces`")));
    }
}
