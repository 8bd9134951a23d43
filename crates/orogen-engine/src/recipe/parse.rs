//! Conversion of a tree of values to a recipe, with diagnostics at their keys.

use super::class::list::CLASSES;
use super::document::{Recipe, VERSION, WorldSpec};
use super::graph::{At, Graph, MAX_FAULTS};
use super::parameters::{Formula, Parameters, Step, resolve};
use super::scatter::list::SCATTERS;
use super::subgraph::{NO_FILES, Origin, UseDiagnostic, Uses, take_in};
use super::surface::list::SURFACES;
use super::table::list::List;
use super::table::reader::ValueReader;
use super::text::{LONGEST_TEXT, Text, too_long};
use super::{class, json, outputs, scatter, surface, toml};
use crate::registry::Registry;
use orogen_grid::error::{Diagnostic, Error, ErrorKind, Result};
use orogen_grid::words::{list, respelled, suggestion};
use orogen_ops::declare::{Input, Shape};
use orogen_ops::expression::formula::place_of;
use orogen_ops::expression::text::Expression;
use orogen_ops::node::Node;
use orogen_ops::value::{Span, Spanned, Value};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// Terms of other programs for keys that have another name here.
const ALIASES: [(&str, &str); 8] = [
    ("persistence", "gain"),
    ("frequency", "wavelength"),
    ("scale", "wavelength"),
    ("period", "wavelength"),
    ("input", "source"),
    ("in", "source"),
    ("sigma", "radius"),
    ("amount", "strength"),
];

/// The message for an unknown key, with a suggestion.
fn unknown_key(key: &str, node: &Node) -> String {
    let inputs = node.inputs();
    let params = node.spec().params.iter().map(|param| param.name);
    let known = inputs.iter().map(|input| input.name).chain(params);
    match ALIASES.iter().find(|(alias, name)| *alias == key && known.clone().any(|known| known == *name)) {
        Some(("frequency", name)) => format!("write `{name}`, which is 1 / frequency"),
        Some((_, name)) => format!("it is called `{name}` here"),
        None => suggestion(key, known.chain(["op", "mask"])),
    }
}

/// Reads a list of tables, and returns their positions.
fn tables<T: Clone>(top: &Table, list: &List<T>, values: &mut ValueReader, mut add: impl FnMut(T)) -> Vec<Span> {
    let lists = top.iter().filter(|(key, _)| key.value == list.key);
    let entries: Vec<(T, Span)> = lists.flat_map(|(_, value)| list.read(value, values)).collect();
    let place = |(entry, place)| {
        add(entry);
        place
    };
    entries.into_iter().map(place).collect()
}

type Table = [(Spanned<String>, Spanned<Value>)];

/// Reads a recipe and the recipes that it uses.
pub(super) fn parse(text: &str, name: &str, set: &[(String, f64)], origin: &Origin) -> Result<Recipe> {
    if text.len() as u64 > LONGEST_TEXT {
        return Err(too_long(name));
    }
    // A byte order mark, which some editors write.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.trim().is_empty() {
        return Err(Error::new(
            ErrorKind::Recipe,
            format!(
                "{name} is empty; a recipe starts with `orogen = {VERSION}`. `orogen new NAME` writes a recipe to edit"
            ),
        ));
    }
    let text = Text { name, text };
    let is_json = text.text.trim_start().starts_with('{');
    let tree = match is_json {
        true => json::read(&text)?,
        // A file whose name says that it is JSON gets messages about JSON.
        false => {
            toml::read(&text).or_else(|error| if name.ends_with(".json") { json::read(&text) } else { Err(error) })?
        }
    };
    let walk = Walk {
        text: &text,
        registry: origin.registry(),
        max_nodes: origin.max_nodes(),
        reads_files: origin.reads_files(),
        diagnostics: Vec::new(),
        more: 0,
        places: HashMap::new(),
        names: Vec::new(),
        parameters: Parameters::default(),
        failed: HashSet::new(),
        elsewhere: Vec::new(),
    };
    walk.recipe(tree, set, origin)
}

/// A traversal of the tree that collects diagnostics and the positions of keys, which later checks of the graph need.
struct Walk<'a> {
    text: &'a Text<'a>,
    /// The ops that nodes may have.
    registry: &'a Registry,
    max_nodes: usize,
    /// Whether nodes and surfaces may name files.
    reads_files: bool,
    diagnostics: Vec<Diagnostic>,
    /// Number of diagnostics beyond the limit.
    more: usize,
    /// Positions of the values of (node, key); the empty key is the node's name.
    places: HashMap<(usize, String), Span>,
    /// Positions of the outputs' values.
    names: Vec<Span>,
    /// The parameters of formulas.
    parameters: Parameters,
    /// Formulas without a value, which need no further diagnostics.
    failed: HashSet<Span>,
    /// Problems of recipes that this one uses.
    elsewhere: Vec<Diagnostic>,
}

impl Walk<'_> {
    fn complain(&mut self, span: &Span, message: impl Into<String>) {
        if self.failed.contains(span) {
            return;
        }
        if self.diagnostics.len() >= MAX_FAULTS {
            self.more += 1;
            return;
        }
        let diagnostic = self.text.diagnostic(span, message);
        self.diagnostics.push(diagnostic);
    }

    fn recipe(mut self, mut tree: Spanned<Value>, set: &[(String, f64)], origin: &Origin) -> Result<Recipe> {
        let Value::Table(top) = &tree.value else {
            return Err(self.text.error(&tree.span, "a recipe must be a table of keys"));
        };
        self.version(top)?;
        let resolved = resolve(&mut tree, self.text, set)
            .map_err(|message| Error::new(ErrorKind::Recipe, format!("{}: {message}", self.text.name)))?;
        resolved.diagnostics.into_iter().for_each(|(span, message)| self.complain(&span, message));
        self.parameters = resolved.parameters;
        self.failed = resolved.failed.into_iter().collect();
        let Value::Table(top) = &tree.value else {
            return Err(self.text.error(&tree.span, "a recipe is a table of keys"));
        };
        let mut recipe = Recipe::new(WorldSpec::default());
        let mut seen = HashSet::new();
        for (key, value) in top {
            self.repeated(&mut seen, key);
            match key.value.as_str() {
                "orogen" | "$schema" | "parameters" => {}
                // What the studio keeps; it has no effect on the world.
                "studio" => {
                    if !matches!(value.value, Value::Table(_)) {
                        self.complain(&value.span, format!("`studio` must be a table, not {}", value.value.describe()));
                    }
                }
                "about" => match &value.value {
                    Value::Text(about) => recipe.about = about.clone(),
                    other => self.complain(&value.span, format!("`about` must be a string, not {}", other.describe())),
                },
                "world" => recipe.world = self.world(value),
                "nodes" => self.nodes(value, &mut recipe)?,
                "outputs" => self.outputs(value, &mut recipe),
                // Read last: conditions depend on whether the world is bounded, and nodes of used recipes follow its
                // own nodes.
                "surface" | "scatter" | "class" | "use" => {}
                unknown => {
                    let known = [
                        "orogen",
                        "about",
                        "parameters",
                        "world",
                        "nodes",
                        "use",
                        "outputs",
                        "surface",
                        "scatter",
                        "class",
                        "studio",
                    ];
                    let hint = suggestion(unknown, known);
                    self.complain(&key.span, format!("unknown key `{unknown}` in a recipe; {hint}"));
                }
            }
        }
        let mut values = ValueReader::new(recipe.world.size.is_some());
        let surfaces = tables(top, &SURFACES, &mut values, |surface| _ = recipe.surface(surface));
        let scatter = tables(top, &SCATTERS, &mut values, |entry| _ = recipe.add_scatter(entry));
        let classes = tables(top, &CLASSES, &mut values, |class| _ = recipe.add_class(class));
        if !self.reads_files {
            let named = recipe.surfaces().iter().zip(&surfaces).filter(|(surface, _)| surface.picture().is_some());
            let places: Vec<Span> = named.map(|(_, place)| place.clone()).collect();
            places.iter().for_each(|place| self.complain(place, format!("`picture` is a file; {NO_FILES}")));
        }
        let ValueReader { mut names, diagnostics, .. } = values;
        // A problem of a node is reported at the first name in the text that it is about.
        names.sort_by_key(|(_, span)| span.start);
        diagnostics.into_iter().for_each(|(span, message)| self.complain(&span, message));
        if let Some((key, _)) = top.iter().find(|(key, _)| key.value == CLASSES.key) {
            let has = |name: &str| recipe.outputs().any(|output| output == name);
            if has(outputs::CLASS) {
                self.complain(&key.span, class::expand::BOTH);
            } else if !has(outputs::HEIGHT) {
                self.complain(&key.span, class::expand::NO_HEIGHT);
            }
        }
        if let Some(folder) = &origin.folder {
            recipe.set_base_dir(folder);
        }
        let uses = match top.iter().find(|(key, _)| key.value == "use") {
            Some((_, value)) => self.uses(value, &mut recipe, origin),
            None => Uses::default(),
        };
        if recipe.output_inputs().is_empty() && self.is_sound() {
            self.complain(
                &(0..0),
                "the recipe has no outputs; add a table `[outputs]` with a line such as `height = \"NODE\"`",
            );
        }
        if self.is_sound()
            && let Err(diagnostics) = Graph::resolve(&recipe)
        {
            for diagnostic in diagnostics {
                let span = match &diagnostic.at {
                    At::Node(node, key) => {
                        let name = self.places.get(&(*node, String::new()));
                        let place = self.places.get(&(*node, key.clone())).or(name);
                        place.or_else(|| uses.place(*node)).cloned().unwrap_or(0..0)
                    }
                    At::Output(output) => self.names.get(*output).cloned().unwrap_or(0..0),
                    At::World => {
                        top.iter().find(|(key, _)| key.value == "world").map_or(0..0, |(key, _)| key.span.clone())
                    }
                };
                self.complain(&span, diagnostic.message);
            }
        }
        self.check_tables(&recipe, "surface", &surfaces, &names, |whole| {
            surface::expand::expand(whole);
            whole.expanded().iter().map(|it| (it.surface.name.clone(), it.nodes.clone(), it.share.clone())).collect()
        });
        self.check_tables(&recipe, "scatter", &scatter, &names, |whole| {
            scatter::expand::expand(whole);
            let expanded = whole.scatter().iter().zip(whole.expanded_scatter());
            expanded.map(|(entry, it)| (entry.name.clone(), it.nodes.clone(), Some(it.density.clone()))).collect()
        });
        self.check_tables(&recipe, "class", &classes, &names, |whole| {
            // The reason why it cannot have classes was reported above.
            let _ = class::expand::expand(whole);
            let expanded = whole.classes().iter().zip(whole.expanded_classes());
            expanded.map(|(class, it)| (class.name.clone(), it.nodes.clone(), None)).collect()
        });
        // Whatever names a file, it is not read: the checks above only say where it is.
        if !self.reads_files && self.is_sound() && recipe.names_files() {
            self.complain(&(0..0), format!("a file is named; {NO_FILES}"));
        }
        match self.is_sound() {
            true => {
                recipe.set_used(uses.files);
                recipe.set_parameters(self.parameters);
                Ok(recipe)
            }
            false => Err(self.text.errors(self.diagnostics, self.elsewhere, self.more)),
        }
    }

    /// Whether there are no problems so far.
    fn is_sound(&self) -> bool {
        self.diagnostics.is_empty() && self.elsewhere.is_empty()
    }

    /// Includes the recipes that this one uses.
    fn uses(&mut self, value: &Spanned<Value>, recipe: &mut Recipe, origin: &Origin) -> Uses {
        let mut uses = take_in(value, recipe, &mut self.parameters, origin);
        for complaint in std::mem::take(&mut uses.diagnostics) {
            match complaint {
                UseDiagnostic::Here(span, message) => self.complain(&span, message),
                UseDiagnostic::There(error) => {
                    let room = MAX_FAULTS.saturating_sub(self.elsewhere.len());
                    self.elsewhere.extend(error.diagnostics().iter().take(room).cloned());
                }
            }
        }
        recipe.rename_inputs(|name| uses.output(name).cloned());
        uses
    }

    /// Reports problems that appear only in the nodes that the tables of a list expand to. `expand` adds these nodes to
    /// a recipe and returns the name, the nodes and the resulting layer of each table. `places` are the positions of
    /// the tables, `names` the names of nodes in all tables.
    fn check_tables(
        &mut self,
        written: &Recipe,
        list: &str,
        places: &[Span],
        names: &[(String, Span)],
        expand: impl Fn(&mut Recipe) -> Vec<(String, Range<usize>, Option<String>)>,
    ) {
        if !self.is_sound() || places.is_empty() {
            return;
        }
        let mut whole = written.clone();
        let nodes = expand(&mut whole);
        let name = |at: usize| format!("{list} `{}`", nodes[at].0);
        let start = |table: usize| places.get(table).map_or(usize::MAX, |span| span.start);
        for diagnostic in Graph::resolve(&whole).err().unwrap_or_default() {
            let at = match diagnostic.at {
                At::Node(node, _) => nodes.iter().position(|(_, nodes, _)| nodes.contains(&node)),
                _ => None,
            };
            // A name that is wrong, with a suggestion from the nodes that were written.
            let is_told = |name: &str| {
                let node = name.split('.').next().unwrap_or_default();
                diagnostic.message.contains(&format!("`{node}`"))
            };
            let wrong = at.and_then(|at| {
                let within = start(at)..start(at + 1);
                let mut names = names.iter().filter(|(name, span)| within.contains(&span.start) && is_told(name));
                names.find_map(|(name, span)| Some((at, span, Graph::find(written, name).err()?)))
            });
            if let Some((at, span, what)) = wrong {
                self.complain(span, format!("{}: {what}", name(at)));
                continue;
            }
            let span = at.and_then(|at| places.get(at)).cloned().unwrap_or(0..0);
            // Names of generated nodes would not help the user.
            let message = match (at, diagnostic.message.split_once("`: ")) {
                (Some(at), Some((_, what))) => format!("{}: {what}", name(at)),
                _ => diagnostic.message,
            };
            self.complain(&span, message);
        }
        // A mask that is the only condition is the result itself: no node reads it.
        for (at, layer) in nodes.iter().enumerate().filter_map(|(at, (.., layer))| Some((at, layer.as_ref()?))) {
            if Graph::find(&whole, layer).is_err()
                && let Err(what) = Graph::find(written, layer)
            {
                let within = start(at)..start(at + 1);
                let place = names.iter().find(|(name, span)| name == layer && within.contains(&span.start));
                let span = place.map(|(_, span)| span).or(places.get(at)).cloned().unwrap_or(0..0);
                self.complain(&span, format!("{}: {what}", name(at)));
            }
        }
    }

    /// The version is checked first: a recipe of another version cannot be interpreted reliably.
    fn version(&self, top: &Table) -> Result<()> {
        match top.iter().find(|(key, _)| key.value == "orogen") {
            None => Err(self.text.error(
                &(0..0),
                format!("this is not a recipe: the line `orogen = {VERSION}`, the version of the recipe format, is missing"),
            )),
            Some((_, Spanned { value: Value::Integer(VERSION), .. })) => Ok(()),
            Some((_, Spanned { value: Value::Integer(version), span })) if *version > VERSION => Err(self.text.error(
                span,
                format!("this recipe has the format version {version}, and this program reads version {VERSION}; use a newer Orogen"),
            )),
            Some((_, value)) => Err(self.text.error(
                &value.span,
                format!("`orogen` is the version of the recipe format and must be {VERSION}, not {}", value.value.describe_as_integer()),
            )),
        }
    }

    /// Reports a duplicate key in a table (the TOML parser rejects it itself, the JSON parser does not). Its values are
    /// checked all the same.
    fn repeated<'k>(&mut self, seen: &mut HashSet<&'k str>, key: &'k Spanned<String>) {
        if !seen.insert(key.value.as_str()) {
            self.complain(&key.span, format!("the key `{}` appears twice in this table", key.value));
        }
    }

    fn world(&mut self, value: &Spanned<Value>) -> WorldSpec {
        let mut values = ValueReader::new(true);
        let world = WorldSpec::read(value, &mut values);
        values.diagnostics.into_iter().for_each(|(span, message)| self.complain(&span, message));
        world
    }

    fn nodes(&mut self, value: &Spanned<Value>, recipe: &mut Recipe) -> Result<()> {
        let Value::Table(entries) = &value.value else {
            self.complain(
                &value.span,
                format!("`nodes` must be a table of named nodes, not {}", value.value.describe()),
            );
            return Ok(());
        };
        let most = self.max_nodes;
        if entries.len() > most {
            return Err(self.text.error(
                &entries[most].0.span,
                format!("this recipe has {} nodes; at most {most} are allowed", entries.len()),
            ));
        }
        let mut names: HashSet<&str> = HashSet::with_capacity(entries.len());
        for (name, value) in entries {
            if !names.insert(&name.value) {
                self.complain(&name.span, format!("two nodes are named `{}`; rename one", name.value));
            }
            let index = recipe.nodes().len();
            self.places.insert((index, String::new()), name.span.clone());
            // A node that cannot be read still defines its name, so that nodes that read it cause no further
            // diagnostics; the recipe is rejected anyway.
            if let Some((node, mask)) = self.node(index, name, value) {
                recipe.add_masked(&name.value, node, mask);
            }
        }
        Ok(())
    }

    fn node(&mut self, index: usize, name: &Spanned<String>, value: &Spanned<Value>) -> Option<(Node, Input)> {
        let Value::Table(entries) = &value.value else {
            let found = value.value.describe();
            self.complain(&value.span, format!("the node `{}` must be a table with an `op`, not {found}", name.value));
            return None;
        };
        // A key that is repeated is reported; all of its values are checked.
        let ops = entries.iter().filter(|(key, _)| key.value == "op").map(|(_, op)| op);
        let nodes: Vec<Option<Node>> = ops.map(|op| self.op(op)).collect();
        let Some(node) = nodes.into_iter().next() else {
            self.complain(
                &name.span,
                format!("the node `{}` has no `op`; add a line such as `op = \"fbm\"`", name.value),
            );
            return None;
        };
        let mut node = node?;
        let spec = node.spec();
        let (mut seen, mut mask) = (HashSet::new(), Input::None);
        let is_known = |name: &str| spec.input_named(name).is_some() || spec.param_named(name).is_some();
        let mut entries: Vec<(Spanned<String>, &Spanned<Value>)> = (entries.iter())
            .map(|(key, value)| {
                let other = respelled(&key.value).filter(|other| !is_known(&key.value) && is_known(other));
                let name = other.unwrap_or_else(|| key.value.clone());
                let alias = spec.aliases().find(|(alias, _)| *alias == name).map(|(_, name)| name.to_string());
                (Spanned { value: alias.unwrap_or(name), span: key.span.clone() }, value)
            })
            .collect();
        // The inputs are known only from the expression.
        if spec.named_inputs {
            entries.sort_by_key(|(key, _)| spec.param_named(&key.value).is_none());
        }
        let mut sound = true;
        for (key, value) in &entries {
            self.repeated(&mut seen, key);
            if key.value == "op" {
                continue;
            }
            if key.value == "mask" {
                self.places.insert((index, key.value.clone()), value.span.clone());
                mask = self.input("mask", value);
            } else if let Some(i) = spec.param_named(&key.value) {
                self.places.insert((index, key.value.clone()), value.span.clone());
                match node.set_param(i, &value.value) {
                    Ok(()) if !self.reads_files && node.names_file(i) => {
                        self.complain(&value.span, format!("`{}` is a file; {NO_FILES}", key.value));
                        sound = false;
                    }
                    Ok(()) => {
                        self.remember(&mut node, value);
                        if let Shape::Expression = spec.params[i].shape {
                            sound &= self.expression(index, value);
                        }
                    }
                    Err(message) => {
                        let part = spec.params[i].problem(&value.value).map(|(span, _)| span);
                        self.complain(part.as_ref().filter(|span| !span.is_empty()).unwrap_or(&value.span), message);
                        sound = false;
                    }
                }
            } else if let Some(i) = node.inputs().iter().position(|input| input.name == key.value) {
                self.places.insert((index, key.value.clone()), value.span.clone());
                let input = self.input(&key.value, value);
                node.set_input(i, input);
            } else if sound || !spec.named_inputs {
                let hint = unknown_key(&key.value, &node);
                self.complain(
                    &key.span,
                    format!("unknown key `{}` in node `{}` (op `{}`); {hint}", key.value, name.value, spec.op),
                );
            }
        }
        if spec.named_inputs {
            self.name_inputs(&name.value, &mut node);
        }
        Some((node, mask))
    }

    /// The node of an op, with its defaults.
    fn op(&mut self, op: &Spanned<Value>) -> Option<Node> {
        let Value::Text(name) = &op.value else {
            self.complain(&op.span, format!("`op` must be the name of an op, not {}", op.value.describe()));
            return None;
        };
        let node = self.registry.named(name).or_else(|| self.registry.named(&respelled(name)?));
        if node.is_none() {
            self.complain(&op.span, self.registry.unknown(name));
        }
        node
    }

    /// Reports problems within an expression at their positions.
    fn expression(&mut self, index: usize, value: &Spanned<Value>) -> bool {
        let Value::Text(text) = &value.value else { return true };
        let expr = Expression::from(text.as_str());
        let Some(fault) = expr.error() else {
            // An unknown name is reported where it is used, unless a key defines it.
            for name in expr.names() {
                let span = self.text.within(&value.span, text, &place_of(text, name));
                self.places.insert((index, name.clone()), span);
            }
            return true;
        };
        let span = self.text.within(&value.span, text, &fault.span);
        self.complain(&span, fault.message.clone());
        false
    }

    /// Defines the names of an expression that no key defines: a parameter, otherwise a node or layer.
    fn name_inputs(&mut self, node_name: &str, node: &mut Node) {
        let names: Vec<String> = node.inputs().iter().map(|input| input.name.to_string()).collect();
        for (i, name) in names.iter().enumerate() {
            if *node.input(i) != Input::None {
                continue;
            }
            let input = match self.parameters.value(name) {
                Some(value) => {
                    let path = ["nodes", node_name, name].map(|key| Step::Key(key.to_string()));
                    self.parameters.formulas.push(Formula { path: path.into(), text: format!(" {name}") });
                    Input::Value(value)
                }
                None => Input::from(name),
            };
            node.set_input(i, input);
        }
    }

    /// Records the location of a file name, for errors when it is read.
    fn remember(&self, node: &mut Node, value: &Spanned<Value>) {
        let Value::Text(name) = &value.value else { return };
        let files = node.files().into_iter().filter(|file| file.location().is_none() && file.text() == *name);
        files.for_each(|file| file.set_location(self.text.locate(&value.span)));
    }

    fn input(&mut self, key: &str, value: &Spanned<Value>) -> Input {
        match (&value.value, value.value.number()) {
            (Value::Text(name), _) => Input::Node(name.clone()),
            (_, Some(number)) if number.is_finite() => Input::Value(number),
            (other, _) => {
                let found = other.describe();
                self.complain(
                    &value.span,
                    format!("`{key}` must name a node (or one of its layers, `node.layer`) or be a finite number, not {found}"),
                );
                Input::None
            }
        }
    }

    fn outputs(&mut self, value: &Spanned<Value>, recipe: &mut Recipe) {
        let Value::Table(entries) = &value.value else {
            self.complain(&value.span, format!("`outputs` must be a table, not {}", value.value.describe()));
            return;
        };
        let mut seen = HashSet::new();
        for (key, value) in entries {
            self.repeated(&mut seen, key);
            if let Value::Table(_) = value.value {
                self.complain(&value.span, format!("the output `{}` must name a node, not be a table", key.value));
                continue;
            }
            let input = self.input(&key.value, value);
            self.names.push(value.span.clone());
            recipe.output(&key.value, input);
        }
        if entries.is_empty() {
            let names: Vec<&str> = recipe.nodes().iter().map(|node| node.name.as_str()).collect();
            self.complain(
                &value.span,
                format!("`outputs` is empty; add a layer such as `height`, which shows {}", list(names)),
            );
        }
    }
}
