//! The graph of a recipe as drawn: the nodes of one group, the groups in it as boxes, and the nodes outside that they
//! are connected to.

use std::collections::{HashMap, HashSet};

use orogen::declare::Input;
use orogen::declare::spec::Locality;
use orogen::recipe::{NamedNode, Recipe};

use crate::editing::groups;

/// An input at the left of a box.
#[derive(Debug, Clone, PartialEq)]
pub struct Port {
    /// The text next to it.
    pub label: String,
    /// The node whose input it is.
    pub node: String,
    /// The input, or `mask`.
    pub key: String,
}

/// A box.
#[derive(Debug, Clone, PartialEq)]
pub struct GraphBox {
    /// Its identifier: the name of its node, or the name of its group with a trailing `/`.
    pub id: String,
    /// What it represents.
    pub kind: Kind,
    /// Its title.
    pub title: String,
    /// The text below the title; empty for groups.
    pub subtitle: String,
    /// Its nodes.
    pub nodes: Vec<String>,
    /// Its inputs.
    pub ports: Vec<Port>,
    /// The nodes that can be read through it.
    pub outlets: Vec<String>,
}

/// What a box represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A node.
    Node(Locality),
    /// A group, which can be opened.
    Group,
    /// A node outside of the shown group.
    Outside,
    /// An output of the recipe.
    Output,
}

/// The end of a wire at a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// At an input.
    Port(usize),
    /// At the mask of a node.
    Mask,
}

/// A wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wire {
    /// The box that is read.
    pub from: usize,
    /// The outlet of that box.
    pub outlet: usize,
    /// The box that reads.
    pub to: usize,
    /// Its end.
    pub end: End,
}

/// Boxes and wires.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scene {
    /// The boxes, in the order of the recipe.
    pub boxes: Vec<GraphBox>,
    /// The wires.
    pub wires: Vec<Wire>,
}

/// The node that an input refers to, possibly by a layer.
#[must_use]
pub fn source_of(input: &Input) -> Option<&str> {
    match input {
        Input::Node(name) => Some(name.split_once('.').map_or(name.as_str(), |(node, _)| node)),
        _ => None,
    }
}

/// The inputs of a node with their names; `mask` comes last.
fn inputs(named: &NamedNode) -> Vec<(&str, &Input)> {
    let inputs = named.node.inputs();
    let own = inputs.iter().enumerate().map(|(i, input)| (input.name, named.node.input(i)));
    own.chain([("mask", &named.mask)]).collect()
}

impl Scene {
    /// The scene of a group; of the whole recipe for the empty name.
    #[must_use]
    pub fn of(recipe: &Recipe, group: &str) -> Scene {
        let mut scene = Scene::default();
        let mut at: HashMap<String, usize> = HashMap::new();
        for named in recipe.nodes() {
            let Some(rest) = groups::rest(&named.name, group) else { continue };
            let id = id_of(&named.name, group);
            let known = *at.entry(id.clone()).or_insert_with(|| {
                scene.boxes.push(match id.strip_suffix('/') {
                    Some(inner) => GraphBox::group(&id, groups::own_name(inner)),
                    None => GraphBox::node(named, rest),
                });
                scene.boxes.len() - 1
            });
            scene.boxes[known].nodes.push(named.name.clone());
        }
        let names: HashSet<&str> = recipe.nodes().iter().map(|named| named.name.as_str()).collect();
        let mut read: HashSet<&str> = HashSet::new();
        for reader in recipe.nodes() {
            for (k, (key, input)) in inputs(reader).into_iter().enumerate() {
                let Some(source) = source_of(input).filter(|source| names.contains(source)) else { continue };
                read.insert(source);
                let ends = [source, reader.name.as_str()].map(|name| id_of(name, group));
                if ends[0] == ends[1] || !ends.iter().any(|id| at.contains_key(id)) {
                    continue;
                }
                let from = scene.end(&mut at, &ends[0], source, false);
                let to = scene.end(&mut at, &ends[1], &reader.name, true);
                let outlet = scene.boxes[from].outlet(source);
                let end = match scene.boxes[to].kind {
                    Kind::Node(_) if key == "mask" => End::Mask,
                    Kind::Node(_) => End::Port(k),
                    Kind::Group => {
                        let label = format!("{}.{key}", scene.boxes[to].inside(&reader.name));
                        scene.boxes[to].port(label, &reader.name, key)
                    }
                    Kind::Outside | Kind::Output => scene.boxes[to].port(key.to_owned(), &reader.name, key),
                };
                scene.wires.push(Wire { from, outlet, to, end });
            }
        }
        let outputs: HashSet<&str> = recipe.output_inputs().iter().filter_map(|(_, input)| source_of(input)).collect();
        for block in scene.boxes.iter_mut().filter(|block| block.kind == Kind::Group) {
            // Nodes that nothing reads are also outlets of the group.
            for name in block.nodes.clone() {
                if outputs.contains(name.as_str()) || !read.contains(name.as_str()) {
                    block.outlet(&name);
                }
            }
        }
        if group.is_empty() {
            scene.add_outputs(recipe, &at);
        }
        scene
    }

    /// Adds a box for each output.
    fn add_outputs(&mut self, recipe: &Recipe, at: &HashMap<String, usize>) {
        for (name, input) in recipe.output_inputs() {
            let mut block = GraphBox::output(name);
            let end = block.port(String::new(), &block.id.clone(), name);
            self.boxes.push(block);
            let to = self.boxes.len() - 1;
            if let Some(source) = source_of(input)
                && let Some(from) = at.get(&id_of(source, "")).copied()
            {
                let outlet = self.boxes[from].outlet(source);
                self.wires.push(Wire { from, outlet, to, end });
            }
        }
    }

    /// The box at an end of a wire; it is created if it is outside the group.
    fn end(&mut self, at: &mut HashMap<String, usize>, id: &str, name: &str, reads: bool) -> usize {
        if let Some(known) = at.get(id) {
            return *known;
        }
        // A node outside that both is read and reads appears on both sides.
        let id = format!("{}{name}", if reads { '>' } else { '<' });
        *at.entry(id.clone()).or_insert_with(|| {
            self.boxes.push(GraphBox {
                id,
                kind: Kind::Outside,
                title: name.to_owned(),
                subtitle: String::new(),
                nodes: vec![name.to_owned()],
                ports: Vec::new(),
                outlets: Vec::new(),
            });
            self.boxes.len() - 1
        })
    }

    /// The box that contains a node.
    #[must_use]
    pub fn box_of(&self, node: &str) -> Option<&GraphBox> {
        self.boxes.iter().find(|block| block.kind != Kind::Outside && block.nodes.iter().any(|name| name == node))
    }
}

/// The identifier of the box of a node when a group is shown.
fn id_of(name: &str, group: &str) -> String {
    groups::inner(name, group).map_or_else(|| name.to_owned(), |inner| format!("{inner}/"))
}

impl GraphBox {
    fn node(named: &NamedNode, title: &str) -> GraphBox {
        let spec = named.node.spec();
        let mut inputs = inputs(named);
        inputs.pop();
        let ports = inputs.into_iter().map(|(key, input)| Port {
            label: match input {
                Input::Value(value) => format!("{key} = {}", orogen::grid::words::number(*value)),
                _ => key.to_owned(),
            },
            node: named.name.clone(),
            key: key.to_owned(),
        });
        GraphBox {
            id: named.name.clone(),
            kind: Kind::Node(spec.locality),
            title: title.to_owned(),
            subtitle: spec.op.to_owned(),
            nodes: Vec::new(),
            ports: ports.collect(),
            outlets: vec![named.name.clone()],
        }
    }

    fn group(id: &str, title: &str) -> GraphBox {
        GraphBox {
            id: id.to_owned(),
            kind: Kind::Group,
            title: title.to_owned(),
            subtitle: String::new(),
            nodes: Vec::new(),
            ports: Vec::new(),
            outlets: Vec::new(),
        }
    }

    fn output(name: &str) -> GraphBox {
        // No node has a name with this character.
        GraphBox { kind: Kind::Output, ..GraphBox::group(&format!("={name}"), name) }
    }

    /// The full name of its group; `None` for other boxes.
    #[must_use]
    pub fn group_name(&self) -> Option<&str> {
        self.id.strip_suffix('/').filter(|_| self.kind == Kind::Group)
    }

    /// The name of one of its nodes without the names of the groups around the box.
    #[must_use]
    pub fn inside<'a>(&self, name: &'a str) -> &'a str {
        self.group_name().and_then(|group| groups::rest(name, group)).unwrap_or_else(|| groups::own_name(name))
    }

    fn outlet(&mut self, name: &str) -> usize {
        self.outlets.iter().position(|known| known == name).unwrap_or_else(|| {
            self.outlets.push(name.to_owned());
            self.outlets.len() - 1
        })
    }

    fn port(&mut self, label: String, node: &str, key: &str) -> End {
        self.ports.push(Port { label, node: node.to_owned(), key: key.to_owned() });
        End::Port(self.ports.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "orogen = 1\n[world]\nsize = 1000\n[nodes.hills]\nop = \"fbm\"\n[nodes.\"g/rough\"]\nop = \"blur\"\nsource = \
                        \"hills\"\nradius = 20\n[nodes.\"g/h/land\"]\nop = \"add\"\na = \"g/rough\"\nb = 5\nmask = \"hills\"\n[nodes.soft]\nop = \
                        \"blur\"\nsource = \"g/h/land\"\nradius = 30\nmask = \"g/rough\"\n[outputs]\nheight = \"soft\"\n";

    fn scene(group: &str) -> Scene {
        Scene::of(&Recipe::parse(TEXT, "test").unwrap(), group)
    }

    fn ids(scene: &Scene) -> Vec<&str> {
        scene.boxes.iter().map(|block| block.id.as_str()).collect()
    }

    fn wires(scene: &Scene) -> Vec<(&str, &str, End)> {
        let id = |k: usize| scene.boxes[k].id.as_str();
        scene.wires.iter().map(|wire| (id(wire.from), id(wire.to), wire.end)).collect()
    }

    #[test]
    fn a_group_is_one_box_with_what_goes_in_and_out() {
        let scene = scene("");
        assert_eq!(ids(&scene), ["hills", "g/", "soft", "=height"]);
        let group = &scene.boxes[1];
        assert_eq!((group.kind, group.title.as_str(), group.group_name()), (Kind::Group, "g", Some("g")));
        assert_eq!(group.nodes, ["g/rough", "g/h/land"]);
        let labels: Vec<&str> = group.ports.iter().map(|port| port.label.as_str()).collect();
        assert_eq!(labels, ["rough.source", "h/land.mask"]);
        assert_eq!(group.outlets, ["g/h/land", "g/rough"]);
        assert_eq!(
            wires(&scene),
            [
                ("hills", "g/", End::Port(0)),
                ("hills", "g/", End::Port(1)),
                ("g/", "soft", End::Port(0)),
                ("g/", "soft", End::Mask),
                ("soft", "=height", End::Port(0)),
            ]
        );
        assert_eq!((scene.boxes[3].kind, scene.boxes[3].title.as_str()), (Kind::Output, "height"));
        assert_eq!(scene.box_of("g/h/land").unwrap().id, "g/");
    }

    #[test]
    fn within_a_group_what_is_outside_stands_at_its_sides() {
        let inside = scene("g");
        assert_eq!(ids(&inside), ["g/rough", "g/h/", "<hills", ">soft"]);
        assert_eq!(inside.boxes[0].title, "rough");
        assert_eq!(
            wires(&inside),
            [
                ("<hills", "g/rough", End::Port(0)),
                ("g/rough", "g/h/", End::Port(0)),
                ("<hills", "g/h/", End::Port(1)),
                ("g/h/", ">soft", End::Port(0)),
                ("g/rough", ">soft", End::Port(1)),
            ]
        );
        assert_eq!(ids(&scene("g/h")), ["g/h/land", "<g/rough", "<hills", ">soft"]);
        assert!(scene("none").boxes.is_empty());
    }
}
