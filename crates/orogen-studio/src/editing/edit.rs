//! Edits of a recipe's text. Comments, order and everything that is not edited are kept.

use std::collections::{HashMap, HashSet};

use orogen::declare::{Input, Stroke};
use orogen::io::palette::Rgb;
use orogen::node::Node;
use orogen::recipe::Recipe;
use orogen::value::Value;
use toml_edit::{DocumentMut, Item, Table};

use super::ground::{Ground, set_colors};
use super::kept::Kept;
use super::reader::Reader;
use super::references::{Change, Site, change};
use super::reroutes::{self, Reroute};
use super::strokes::{self, Placement};
use super::tables::{add_node, node, set, top, value_of};
use super::{drawing, groups, names, notes};

/// An edit.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "the names of fields say what they are")]
pub enum Edit {
    /// Sets the seed of the world.
    Seed(u64),
    /// Sets a number of the world: `cell`, `sea_level`.
    World(&'static str, f64),
    /// Sets the width and height of the world in metres.
    Size([f64; 2]),
    /// Sets the default of a parameter of the recipe.
    Default { parameter: String, value: f64 },
    /// Sets a parameter of a node.
    Param { node: String, key: String, value: Value },
    /// Resets a parameter of a node to its default.
    Reset { node: String, key: String },
    /// Sets the note of a node: the comment above it.
    Note { node: String, text: String },
    /// Sets an input of a node, or its `mask`, to another node or layer, a number, or nothing.
    Connect { node: String, input: String, source: Input },
    /// Sets an output to a node or layer, or removes it.
    Output { name: String, source: Input },
    /// Sets the colors of a surface or a terrain class, by its index.
    Colors { ground: Ground, index: usize, colors: Vec<Rgb> },
    /// Adds a node with some inputs and parameters. Required inputs that are not in `inputs` are 0. `readers` then read
    /// the node.
    Add { name: String, op: String, inputs: Vec<(String, String)>, params: Vec<(String, Value)>, readers: Vec<Reader> },
    /// Writes stroke number `at`, from 0, of a paint node: a new stroke, or a longer form of the last one. A node that
    /// does not exist is created at `placement`.
    Stroke { node: String, placement: Placement, at: usize, stroke: Stroke },
    /// Removes nodes; readers of a node then read its first input.
    Delete(Vec<String>),
    /// Copies nodes; connections among them become connections among the copies.
    Duplicate(Vec<String>),
    /// Renames a node, including all references to it.
    Rename { from: String, to: String },
    /// Puts nodes into a new group with this name.
    Group { nodes: Vec<String>, name: String },
    /// Dissolves a group; its nodes move to the group around it.
    Ungroup(String),
    /// Renames a group.
    RenameGroup { from: String, to: String },
    /// Replaces what the studio keeps in the recipe.
    Keep(Kept),
    /// Sets the title of a frame, by its index.
    FrameTitle { frame: usize, title: String },
    /// Replaces the points of a wire of the graph; without points it runs straight.
    Reroute(Reroute),
    /// Several edits, one after another, which are undone together. They rename nothing.
    Several(Vec<Edit>),
}

impl Edit {
    /// What the edit does, as a key of the catalog of texts.
    #[must_use]
    pub fn label(&self) -> &'static str {
        match self {
            Edit::Seed(_) => "edit.seed",
            Edit::World(..) | Edit::Size(_) => "edit.world",
            Edit::Default { .. } | Edit::Param { .. } => "edit.value",
            Edit::Colors { .. } => "edit.colors",
            Edit::Reset { .. } => "edit.reset",
            Edit::Note { .. } => "edit.note",
            Edit::Connect { .. } | Edit::Output { .. } => "edit.connect",
            Edit::Add { .. } => "edit.add",
            Edit::Stroke { .. } => "edit.stroke",
            Edit::Delete(_) => "edit.delete",
            Edit::Duplicate(_) => "edit.duplicate",
            Edit::Rename { .. } | Edit::RenameGroup { .. } => "edit.rename",
            Edit::Group { .. } => "edit.group",
            Edit::Ungroup(_) => "edit.ungroup",
            Edit::Keep(_) | Edit::FrameTitle { .. } => "edit.keep",
            Edit::Reroute(_) => "edit.reroute",
            Edit::Several(edits) => edits.first().map_or("edit.value", Edit::label),
        }
    }

    /// The edits of which it consists, in their order: each is of the recipe that the ones before it left.
    #[must_use]
    pub fn steps(&self) -> &[Edit] {
        match self {
            Edit::Several(edits) => edits,
            one => std::slice::from_ref(one),
        }
    }

    /// The nodes that the edit changes or removes; a lock protects them from it.
    #[must_use]
    pub fn changed(&self) -> Vec<&str> {
        match self {
            Edit::Param { node, .. }
            | Edit::Reset { node, .. }
            | Edit::Connect { node, .. }
            | Edit::Stroke { node, .. } => vec![node],
            Edit::Delete(names) => names.iter().map(String::as_str).collect(),
            Edit::Several(edits) => edits.iter().flat_map(Edit::changed).collect(),
            _ => Vec::new(),
        }
    }

    /// The name of the gesture that the edit is part of: successive edits of one value are undone together.
    #[must_use]
    pub fn gesture(&self) -> Option<String> {
        match self {
            Edit::Seed(_) => Some("seed".into()),
            Edit::World(key, _) => Some(format!("world/{key}")),
            Edit::Size(_) => Some("world/size".into()),
            Edit::Default { parameter, .. } => Some(format!("parameter/{parameter}")),
            Edit::Param { node, key, .. } => Some(format!("node/{node}/{key}")),
            Edit::Note { node, .. } => Some(format!("note/{node}")),
            Edit::FrameTitle { frame, .. } => Some(format!("frame/{frame}")),
            Edit::Colors { ground, index, .. } => Some(format!("colors/{ground:?}/{index}")),
            Edit::Stroke { node, at, .. } => Some(format!("stroke/{node}/{at}")),
            _ => None,
        }
    }
}

/// The nodes that an edit renames: old and new name.
#[must_use]
pub fn renames(recipe: &Recipe, edit: &Edit) -> Vec<(String, String)> {
    match edit {
        Edit::Rename { from, to } => vec![(from.clone(), to.clone())],
        Edit::Group { nodes, name } => groups::grouped(nodes, name),
        Edit::Ungroup(group) => groups::ungrouped(recipe, group),
        Edit::RenameGroup { from, to } => groups::renamed(recipe, from, to),
        _ => Vec::new(),
    }
}

/// Applies one of an edit's [steps](Edit::steps) to the text of a recipe; `recipe` is the parsed text.
///
/// # Errors
/// If the text is not TOML, or has no such node, parameter or key; the message says which.
pub fn apply(text: &str, recipe: &Recipe, edit: &Edit) -> Result<String, String> {
    let mut document: DocumentMut = text.parse().map_err(|error| format!("{error}"))?;
    let known = |name: &str| match recipe.nodes().iter().any(|named| named.name == name) {
        true => Ok(()),
        false => Err(format!("there is no node `{name}`")),
    };
    let missing = |what: &str| format!("the text has no {what}");
    let used = used_names(&document);
    let written = |name: &str| match used.iter().find(|used| groups::rest(name, used).is_some()) {
        Some(used) => Err(format!(
            "`{name}` is part of the recipe that `[use.{used}]` includes; it can be changed in that recipe only"
        )),
        None => Ok(()),
    };
    match edit {
        Edit::Seed(seed) => {
            let seed = i64::try_from(*seed).map_err(|_| format!("a seed must be at most {}, not {seed}", i64::MAX))?;
            set(top(&mut document, "world").ok_or_else(|| missing("[world]"))?, "seed", seed.into());
        }
        Edit::Size(sides) => {
            let size = value_of(&drawing::numbers(sides)).ok_or("a size is two numbers")?;
            set(top(&mut document, "world").ok_or_else(|| missing("[world]"))?, "size", size);
        }
        Edit::World(key, value) => {
            set(top(&mut document, "world").ok_or_else(|| missing("[world]"))?, key, (*value).into());
        }
        Edit::Default { parameter, value } => {
            let parameters = document.get_mut("parameters").and_then(Item::as_table_like_mut);
            let own = parameters.and_then(|parameters| parameters.get_mut(parameter));
            match own {
                // `relief = 2000` is short for a table with a default.
                Some(Item::Value(old)) if !old.is_inline_table() => {
                    let decor = old.decor().clone();
                    *old = (*value).into();
                    *old.decor_mut() = decor;
                }
                Some(item) => {
                    let own = item.as_table_like_mut().ok_or_else(|| missing(&format!("parameter `{parameter}`")))?;
                    set(own, "default", (*value).into());
                }
                None => return Err(missing(&format!("parameter `{parameter}`"))),
            }
        }
        Edit::Param { node: name, key, value } => {
            known(name)?;
            written(name)?;
            let value = value_of(value).ok_or_else(|| format!("`{key}` cannot be {}", value.describe()))?;
            let own = node(&mut document, name).ok_or_else(|| missing(&format!("node `{name}`")))?;
            let key = written_key(own.get("op").and_then(Item::as_str), key, |key| own.contains_key(key));
            set(own, &key, value);
        }
        Edit::Note { node: name, text } => {
            written(name)?;
            notes::set(&mut document, name, text)?;
        }
        Edit::Reset { node: name, key } => {
            written(name)?;
            let own = node(&mut document, name).ok_or_else(|| missing(&format!("node `{name}`")))?;
            let key = written_key(own.get("op").and_then(Item::as_str), key, |key| own.contains_key(key));
            own.remove(&key);
        }
        Edit::Connect { node: name, input, source } => {
            known(name)?;
            written(name)?;
            connect(&mut document, &Reader::Input { node: name.clone(), key: input.clone() }, source)?;
        }
        Edit::Output { name, source } => connect(&mut document, &Reader::Output(name.clone()), source)?,
        Edit::Colors { ground, index, colors } => set_colors(&mut document, *ground, *index, colors)?,
        Edit::Add { name, op, inputs, params, readers } => {
            add(&mut document, name, op, inputs)?;
            let own = node(&mut document, name).ok_or_else(|| missing(&format!("node `{name}`")))?;
            for (key, value) in params {
                let value = value_of(value).ok_or_else(|| format!("`{key}` cannot be {}", value.describe()))?;
                set(own, key, value);
            }
            for reader in readers {
                if let Reader::Input { node: reader, .. } = reader {
                    written(reader)?;
                }
                connect(&mut document, reader, &Input::Node(name.clone()))?;
            }
        }
        Edit::Stroke { node: name, placement, at, stroke } => {
            strokes::write(&mut document, name, placement, *at, stroke)?;
        }
        Edit::Delete(names) => {
            names.iter().try_for_each(|name| written(name))?;
            delete(&mut document, recipe, names)?;
        }
        Edit::Duplicate(names) => {
            names.iter().try_for_each(|name| written(name))?;
            let copies = copies(recipe, names);
            duplicate(&mut document, recipe, names, &copies)?;
            let mut kept = Kept::of(text);
            let copied: Vec<Reroute> = kept.reroutes.iter().filter_map(|reroute| reroute.copied(&copies)).collect();
            if !copied.is_empty() {
                kept.reroutes.extend(copied);
                kept.write(&mut document)?;
            }
        }
        Edit::Rename { .. } | Edit::Group { .. } | Edit::Ungroup(_) | Edit::RenameGroup { .. } => {
            let renames = renames(recipe, edit);
            match edit {
                Edit::Group { nodes, name } if nodes.is_empty() || groups::is_group(recipe, name) => {
                    return Err(match nodes.is_empty() {
                        true => "no nodes are selected for the group".into(),
                        false => format!("there is a group `{name}` already; choose another name"),
                    });
                }
                Edit::Ungroup(group) | Edit::RenameGroup { from: group, .. } if renames.is_empty() => {
                    return Err(format!("there is no group `{group}`"));
                }
                Edit::RenameGroup { from, to } if from != to && groups::is_group(recipe, to) => {
                    return Err(format!("there is a group `{to}` already; choose another name"));
                }
                _ => {}
            }
            for (from, _) in &renames {
                known(from)?;
                written(from)?;
            }
            rename(&mut document, recipe, &renames)?;
        }
        Edit::Keep(kept) => kept.write(&mut document)?,
        Edit::FrameTitle { frame, title } => {
            let mut kept = Kept::of(text);
            kept.frames.get_mut(*frame).ok_or_else(|| missing("such frame"))?.title.clone_from(title);
            kept.write(&mut document)?;
        }
        Edit::Reroute(reroute) => {
            let kept = Kept::of(text);
            let reroutes = reroutes::with(kept.reroutes, reroute);
            Kept { reroutes, ..kept }.write(&mut document)?;
        }
        Edit::Several(_) => return Err("several edits are applied one by one".into()),
    }
    Ok(document.to_string())
}

/// Makes a reader read a node, a number, or nothing.
fn connect(document: &mut DocumentMut, reader: &Reader, source: &Input) -> Result<(), String> {
    let (own, key) = match reader {
        Reader::Output(name) => (top(document, "outputs").ok_or("the text has no [outputs]")?, name.clone()),
        Reader::Input { node: name, key } => {
            let own = node(document, name).ok_or_else(|| format!("the text has no node `{name}`"))?;
            let key = written_key(own.get("op").and_then(Item::as_str), key, |key| own.contains_key(key));
            (own, key)
        }
    };
    match source {
        Input::None => drop(own.remove(&key)),
        Input::Node(source) => set(own, &key, source.as_str().into()),
        Input::Value(value) => set(own, &key, (*value).into()),
    }
    Ok(())
}

/// The key of an input or parameter in the text of a node: an old alias if that is used.
fn written_key(op: Option<&str>, key: &str, has: impl Fn(&str) -> bool) -> String {
    let spec = op.and_then(Node::named).map(|node| node.spec());
    let alias = spec.and_then(|spec| spec.aliases().find(|(alias, name)| *name == key && has(alias)));
    alias.map_or(key, |(alias, _)| alias).to_string()
}

fn add(document: &mut DocumentMut, name: &str, op: &str, inputs: &[(String, String)]) -> Result<(), String> {
    let spec = Node::named(op).ok_or_else(|| format!("there is no op `{op}`"))?.spec();
    let mut own = Table::new();
    own.insert("op", toml_edit::value(op));
    for input in spec.inputs {
        match inputs.iter().find(|(key, _)| key == input.name) {
            Some((_, source)) => drop(own.insert(input.name, toml_edit::value(source.as_str()))),
            None if input.required => drop(own.insert(input.name, toml_edit::value(0))),
            None => {}
        }
    }
    if spec.named_inputs {
        // A new expression is the name `a` for the first input, or 0 without one.
        match inputs.first() {
            Some((_, source)) => {
                own.insert("expr", toml_edit::value("a"));
                own.insert("a", toml_edit::value(source.as_str()));
            }
            None => drop(own.insert("expr", toml_edit::value("0"))),
        }
    }
    add_node(document, name, own)
}

/// The node of a reference, without its layer.
fn node_of(reference: &str) -> &str {
    reference.split_once('.').map_or(reference, |(name, _)| name)
}

fn delete(document: &mut DocumentMut, recipe: &Recipe, names: &[String]) -> Result<(), String> {
    let gone: HashSet<&str> = names.iter().map(String::as_str).collect();
    // What readers of a removed node read instead: its first input.
    let first: HashMap<&str, Input> = recipe
        .nodes()
        .iter()
        .filter(|named| gone.contains(named.name.as_str()))
        .map(|named| {
            let first = if named.node.inputs().is_empty() { Input::None } else { named.node.input(0).clone() };
            (named.name.as_str(), first)
        })
        .collect();
    let nodes = top(document, "nodes").ok_or("`nodes` is no table")?;
    for name in names {
        nodes.remove(name).ok_or_else(|| format!("there is no node `{name}`"))?;
    }
    change(document, &mut |site, reference| {
        if !gone.contains(node_of(reference)) {
            return Change::Keep;
        }
        // A layer other than the first cannot be replaced by the input.
        let mut left = if reference.contains('.') { Input::None } else { Input::Node(reference.to_string()) };
        for _ in 0..=names.len() {
            match &left {
                Input::Node(name) if gone.contains(node_of(name)) => {
                    left = first.get(node_of(name)).cloned().unwrap_or_default();
                }
                _ => break,
            }
        }
        match (left, site) {
            (Input::Node(name), _) if !gone.contains(node_of(&name)) => Change::Name(name),
            (Input::Value(value), Site::Required | Site::Output) => Change::Number(value),
            (_, Site::Required) => Change::Number(0.0),
            _ => Change::Remove,
        }
    });
    // Names in expressions that referred to a removed node directly by its name.
    for named in recipe.nodes().iter().filter(|named| !gone.contains(named.name.as_str())) {
        if !named.node.spec().named_inputs {
            continue;
        }
        let lost: Vec<String> = named.node.inputs().iter().map(|input| input.name.to_owned()).collect();
        for name in lost.into_iter().filter(|name| gone.contains(node_of(name))) {
            let Some(own) = node(document, &named.name).filter(|own| !own.contains_key(&name)) else { continue };
            match first.get(name.as_str()) {
                Some(Input::Node(source)) if !gone.contains(node_of(source)) => set(own, &name, source.as_str().into()),
                Some(Input::Value(value)) => set(own, &name, (*value).into()),
                _ => set(own, &name, 0.0.into()),
            }
        }
    }
    Ok(())
}

/// The names of the copies of nodes.
fn copies<'a>(recipe: &Recipe, names: &'a [String]) -> HashMap<&'a str, String> {
    let mut taken: HashSet<String> = recipe.nodes().iter().map(|named| named.name.clone()).collect();
    let mut copies = HashMap::new();
    // A whole group becomes a new group.
    let group = groups::of_selection(recipe, names);
    let copy = group.as_ref().map(|group| groups::free(recipe, groups::group_of(group), groups::own_name(group)));
    for name in names {
        let moved = group.as_ref().and_then(|group| groups::rest(name, group)).zip(copy.as_ref());
        let free = match moved {
            Some((rest, copy)) => groups::within(copy, rest),
            None => names::free(name, &taken.iter().map(String::as_str).collect()),
        };
        taken.insert(free.clone());
        copies.insert(name.as_str(), free);
    }
    copies
}

fn duplicate(
    document: &mut DocumentMut,
    recipe: &Recipe,
    names: &[String],
    copies: &HashMap<&str, String>,
) -> Result<(), String> {
    let nodes = top(document, "nodes").ok_or("`nodes` is no table")?;
    for name in names {
        let mut copy = nodes.get(name).cloned().ok_or_else(|| format!("there is no node `{name}`"))?;
        if let Some(own) = copy.as_table_like_mut() {
            // Names in an expression that refer to nodes that are also copied.
            for named in recipe.nodes().iter().filter(|named| named.name == *name && named.node.spec().named_inputs) {
                for (i, input) in named.node.inputs().iter().enumerate() {
                    let is_meant = *named.node.input(i) == Input::Node(input.name.to_string());
                    if is_meant && copies.contains_key(node_of(input.name)) && !own.contains_key(input.name) {
                        set(own, input.name, input.name.into());
                    }
                }
            }
            let inputs: Vec<String> = own.iter().map(|(key, _)| key.to_owned()).collect();
            for key in inputs.iter().filter(|key| *key != "op") {
                let Some(reference) = own.get(key).and_then(Item::as_str).map(str::to_owned) else { continue };
                if let Some(new) = copies.get(node_of(&reference)) {
                    let layer = reference.strip_prefix(node_of(&reference)).unwrap_or_default();
                    set(own, key, format!("{new}{layer}").into());
                }
            }
        }
        if let Item::Table(copy) = &mut copy {
            copy.set_position(None);
        }
        if let Some(new) = copies.get(name.as_str()) {
            nodes.insert(new, copy);
        }
    }
    Ok(())
}

/// The names of the recipes that a document uses.
fn used_names(document: &DocumentMut) -> Vec<String> {
    let uses = document.get("use").and_then(Item::as_table_like);
    uses.map(|uses| uses.iter().map(|(name, _)| name.to_owned()).collect()).unwrap_or_default()
}

/// Renames nodes, and all references to them.
fn rename(document: &mut DocumentMut, recipe: &Recipe, renames: &[(String, String)]) -> Result<(), String> {
    let new: HashMap<&str, &str> = renames.iter().map(|(from, to)| (from.as_str(), to.as_str())).collect();
    let mut taken: HashSet<&str> =
        recipe.nodes().iter().map(|named| named.name.as_str()).filter(|name| !new.contains_key(name)).collect();
    if let Some((_, to)) = renames.iter().find(|(_, to)| !taken.insert(to)) {
        return Err(format!("there is a node `{to}` already"));
    }
    // Expressions keep their names: names that referred to a node get a key that says so.
    for named in recipe.nodes().iter().filter(|named| named.node.spec().named_inputs) {
        for (i, input) in named.node.inputs().iter().enumerate() {
            let is_meant =
                new.contains_key(node_of(input.name)) && *named.node.input(i) == Input::Node(input.name.to_string());
            if is_meant && let Some(own) = node(document, &named.name).filter(|own| !own.contains_key(input.name)) {
                set(own, input.name, input.name.into());
            }
        }
    }
    let nodes = top(document, "nodes").ok_or("`nodes` is no table")?;
    rename_keys(nodes, &new);
    change(document, &mut |_, reference| match new.get(node_of(reference)) {
        Some(to) => Change::Name(format!("{to}{}", reference.strip_prefix(node_of(reference)).unwrap_or_default())),
        None => Change::Keep,
    });
    Ok(())
}

/// Renames keys; their positions in the text are kept.
fn rename_keys(nodes: &mut dyn toml_edit::TableLike, new: &HashMap<&str, &str>) {
    // Tables are written by their position in the text, which is stored in the item.
    let keys: Vec<String> = nodes.iter().map(|(key, _)| key.to_owned()).collect();
    let mut entries = Vec::with_capacity(keys.len());
    for key in &keys {
        if let Some((old, item)) = nodes.get_key_value(key).map(|(old, item)| (old.clone(), item.clone())) {
            entries.push((key, old, item));
        }
        nodes.remove(key);
    }
    for (key, old, item) in entries {
        match new.get(key.as_str()) {
            Some(to) => drop(nodes.insert(to, item)),
            None => drop(nodes.entry_format(&old).or_insert(item)),
        }
    }
}
