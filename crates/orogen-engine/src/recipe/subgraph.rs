//! Recipes within recipes: `[use.NAME]` adds the nodes of another recipe to this one, named `NAME/node`.

use super::document::{MAX_NODES, Recipe};
use super::graph::{MAX_USE_DEPTH, is_name};
use super::parameters::{Formula, Parameters, Step};
use super::presets;
use super::table::keys::Keys;
use super::table::reader::{Table, ValueReader};
use super::text::{LONGEST_TEXT, text_of};
use crate::registry::Registry;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::{bytes, suggestion};
use orogen_io::{fs, open};
use orogen_ops::declare::{Input, Shape};
use orogen_ops::expression::formula::renamed;
use orogen_ops::expression::text::Expression;
use orogen_ops::node::Node;
use orogen_ops::value::{Span, Spanned, Value};
use std::cell::Cell;
use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

/// Maximum number of recipes that a recipe uses, directly and indirectly.
pub const MAX_USES: usize = 256;

/// The reason why a name of a file is refused.
pub const NO_FILES: &str = "this recipe may use presets, but no file of this machine and no address";

/// The origin of a recipe during reading.
pub struct Origin<'a> {
    /// The folder of relative paths; `None` for a text without a file.
    pub folder: Option<PathBuf>,
    /// The identities of the recipes that use this one, outermost first, and its own.
    chain: Vec<String>,
    /// State that all recipes of one reading share.
    shared: &'a Shared<'a>,
}

/// Parses a recipe: text, name, values for parameters, and origin.
pub type Parse = fn(&str, &str, &[(String, f64)], &Origin) -> Result<Recipe>;

/// State that all recipes of one reading share: the remaining limits, the ops and the parser.
pub struct Shared<'a> {
    uses: Cell<usize>,
    bytes: Cell<u64>,
    /// Maximum number of nodes.
    nodes: usize,
    /// Whether they may name files.
    reads_files: bool,
    /// The ops that all of them may use.
    registry: &'a Registry,
    /// The parser of used recipes, the same as for the first one.
    parse: Parse,
}

impl<'a> Shared<'a> {
    /// The state before the first recipe is read.
    pub fn new(registry: &'a Registry, parse: Parse) -> Shared<'a> {
        let (uses, bytes) = (Cell::new(MAX_USES), Cell::new(LONGEST_TEXT));
        Shared { uses, bytes, nodes: MAX_NODES, reads_files: true, registry, parse }
    }

    /// The state before a recipe of at most `nodes` nodes is read that must not name files.
    pub fn without_files(registry: &'a Registry, parse: Parse, nodes: usize) -> Shared<'a> {
        Shared { nodes: nodes.min(MAX_NODES), reads_files: false, ..Shared::new(registry, parse) }
    }
}

impl<'a> Origin<'a> {
    /// The ops that recipes may use.
    pub fn registry(&self) -> &'a Registry {
        self.shared.registry
    }

    /// Maximum number of nodes of all recipes together.
    pub fn max_nodes(&self) -> usize {
        self.shared.nodes
    }

    /// Whether recipes may name files.
    pub fn reads_files(&self) -> bool {
        self.shared.reads_files
    }

    /// The origin of a text without a file.
    pub fn text(shared: &'a Shared<'a>) -> Origin<'a> {
        Origin { folder: None, chain: Vec::new(), shared }
    }

    /// The origin of a file.
    pub fn file(path: &Path, shared: &'a Shared<'a>) -> Origin<'a> {
        Origin { folder: Some(folder_of(path)), chain: vec![known_as(path)], shared }
    }

    /// The origin of a preset.
    pub fn preset(name: &str, shared: &'a Shared<'a>) -> Origin<'a> {
        Origin { folder: None, chain: vec![name.to_string()], shared }
    }

    /// Reads a recipe that this one uses: a preset by its name, or a file.
    fn read(&self, name: &str, set: &[(String, f64)]) -> Result<(Recipe, Option<PathBuf>)> {
        let fault = |message: String| Err(Error::new(ErrorKind::Recipe, message));
        let preset = presets::find(name);
        if preset.is_none() && !looks_like_a_path(name) {
            let hint = suggestion(name, presets::all().iter().map(|preset| preset.name));
            return fault(format!(
                "there is no preset `{name}`; {hint} A file is named with its extension, such as \"{name}.toml\""
            ));
        }
        if preset.is_none() && !self.reads_files() {
            return fault(format!("`{name}` is a file; {NO_FILES}"));
        }
        let path = fs::joined(&self.folder.clone().unwrap_or_default(), name);
        let known = preset.map_or_else(|| known_as(&path), |preset| preset.name.to_string());
        if let Some(first) = self.chain.iter().position(|other| *other == known) {
            let circle: Vec<&str> = self.chain[first..].iter().chain([&known]).map(String::as_str).collect();
            return fault(format!("these recipes use each other in a circle: {}", circle.join(" -> ")));
        }
        if self.chain.len() >= MAX_USE_DEPTH {
            return fault(format!("recipes are used more than {MAX_USE_DEPTH} levels deep"));
        }
        let Some(uses) = self.shared.uses.get().checked_sub(1) else {
            return fault(format!("more than {MAX_USES} recipes are used, those counted that used recipes use"));
        };
        self.shared.uses.set(uses);
        let chain = self.chain.iter().cloned().chain([known]).collect();
        let left = self.shared.bytes.get();
        let too_long = || format!("the recipes that are used have more than {} of text together", bytes(LONGEST_TEXT));
        match preset {
            Some(preset) => {
                let Some(left) = left.checked_sub(preset.text.len() as u64) else { return fault(too_long()) };
                self.shared.bytes.set(left);
                let origin = Origin { folder: None, chain, shared: self.shared };
                let recipe = (self.shared.parse)(preset.text, &format!("recipes/{}.toml", preset.name), set, &origin)?;
                Ok((recipe, None))
            }
            None => {
                let Some(content) = open::bytes(&path, "read the recipe", left)? else { return fault(too_long()) };
                self.shared.bytes.set(left - (content.len() as u64).min(left));
                let origin = Origin { folder: Some(folder_of(&path)), chain, shared: self.shared };
                let text = text_of(content, &path)?;
                Ok(((self.shared.parse)(&text, &path.display().to_string(), set, &origin)?, Some(path)))
            }
        }
    }
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).to_path_buf()
}

/// The identity of a file, independent of its name.
fn known_as(path: &Path) -> String {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf()).display().to_string()
}

fn looks_like_a_path(name: &str) -> bool {
    Path::new(name).extension().is_some() || name.contains(['/', '\\'])
}

/// A problem, in this text or in a used recipe.
pub enum UseDiagnostic {
    /// In this text, with the position.
    Here(Span, String),
    /// In another text.
    There(Error),
}

/// The recipes that were included.
#[derive(Default)]
pub struct Uses {
    /// The problems.
    pub diagnostics: Vec<UseDiagnostic>,
    /// The targets of `name` and `name.output`.
    pub outputs: BTreeMap<String, Input>,
    /// For ranges of node indices, the position of the name of the recipe that they came from.
    pub places: Vec<(std::ops::Range<usize>, Span)>,
    /// The files that were read.
    pub files: Vec<PathBuf>,
}

impl Uses {
    /// The position of the name of the recipe that a node came from.
    pub fn place(&self, node: usize) -> Option<&Span> {
        self.places.iter().find(|(nodes, _)| nodes.contains(&node)).map(|(_, span)| span)
    }

    /// The target of a name of a node or layer, if it is an output of a used recipe.
    pub fn output(&self, name: &str) -> Option<&Input> {
        self.outputs.get(name)
    }
}

/// Includes the recipes of a table `use`: adds their nodes to `recipe`, and their formulas to `parameters`.
pub fn take_in(value: &Spanned<Value>, recipe: &mut Recipe, parameters: &mut Parameters, origin: &Origin) -> Uses {
    let mut uses = Uses::default();
    let Value::Table(entries) = &value.value else {
        let message = format!("`use` must be a table of recipes by name, not {}", value.value.describe());
        uses.diagnostics.push(UseDiagnostic::Here(value.span.clone(), message));
        return uses;
    };
    let mut names: HashSet<String> = recipe.nodes().iter().map(|named| named.name.clone()).collect();
    for (name, value) in entries {
        let problem = if !is_name(&name.value) || name.value.contains('/') {
            format!(
                "`{}` cannot be the name of a used recipe: names are 1 to 64 letters, digits, `_` and `-` and do not begin with a digit",
                name.value
            )
        } else if !names.insert(name.value.clone()) {
            format!("there is already a node or a used recipe named `{}`: rename one", name.value)
        } else {
            one(name, value, recipe, parameters, origin, &mut uses);
            continue;
        };
        uses.diagnostics.push(UseDiagnostic::Here(name.span.clone(), problem));
    }
    uses
}

/// A table in `use`.
#[derive(Clone, Default)]
pub struct Use {
    recipe: String,
    inputs: Vec<(Spanned<String>, Input)>,
    parameters: Vec<(Spanned<String>, f64)>,
    seed: u64,
}

/// Its keys.
pub static KEYS: Keys<Use> = Keys {
    needs: &[("recipe", "`recipe`: add a line such as `recipe = \"hills\"`")],
    parts: &[
        key!(Use.recipe, "Name of a preset, or path of a recipe.", text true),
        key!(Use.inputs, "What its nodes of the op `input` read, by their names."),
        key!(Use.parameters, "Values of its parameters, by their names."),
        key!(Use.seed, "Hashed with the seeds of its nodes; 0 leaves them as they are."),
    ],
};

/// Reads a table of `use` and includes its recipe.
fn one(
    name: &Spanned<String>,
    value: &Spanned<Value>,
    recipe: &mut Recipe,
    parameters: &mut Parameters,
    origin: &Origin,
    uses: &mut Uses,
) {
    let what = format!("the used recipe `{}`", name.value);
    let mut values = ValueReader::new(true);
    if let Some(entries) = values.table(&what, value) {
        let table = Table { name: &what, span: &name.span, entries };
        let asked = KEYS.read(&table, &mut values, Use::default());
        if let (true, Some((_, file))) = (values.diagnostics.is_empty(), table.find("recipe"))
            && let Err(problem) = include(name, &asked, &file.span, recipe, parameters, origin, uses)
        {
            uses.diagnostics.push(problem);
        }
    }
    let problems = values.diagnostics.into_iter().map(|(span, message)| UseDiagnostic::Here(span, message));
    uses.diagnostics.extend(problems);
}

/// Includes a recipe; problems of its file are reported at this place.
fn include(
    name: &Spanned<String>,
    asked: &Use,
    place: &Span,
    recipe: &mut Recipe,
    parameters: &mut Parameters,
    origin: &Origin,
    uses: &mut Uses,
) -> std::result::Result<(), UseDiagnostic> {
    let here = |span: &Span, message: String| UseDiagnostic::Here(span.clone(), message);
    let set: Vec<(String, f64)> = asked.parameters.iter().map(|(name, value)| (name.value.clone(), *value)).collect();
    let (used, file) = origin.read(&asked.recipe, &set).map_err(|error| {
        // A diagnostic without a location refers to the values given here.
        match error.diagnostics() {
            [one] if one.place.is_none() => here(place, one.message.clone()),
            _ => UseDiagnostic::There(error),
        }
    })?;
    let most = origin.max_nodes();
    if recipe.nodes().len() + used.nodes().len() > most {
        let message = format!("with this recipe there would be more than {most} nodes");
        return Err(here(&name.span, message));
    }
    for (key, _) in &asked.inputs {
        let inputs = (used.nodes().iter())
            .filter(|named| matches!(named.node, Node::GraphInput(_)))
            .map(|named| named.name.as_str());
        if !inputs.clone().any(|input| input == key.value) {
            let message = match inputs.clone().next() {
                None => format!("{} has no inputs, which are nodes of the op `input`", asked.recipe),
                Some(_) => format!("{} has no input `{}`; {}", asked.recipe, key.value, suggestion(&key.value, inputs)),
            };
            return Err(here(&key.span, message));
        }
    }
    let prefixed = |input: &Input| match input {
        Input::Node(node) => Input::Node(format!("{}/{node}", name.value)),
        other => other.clone(),
    };
    let first = recipe.nodes().len();
    for named in used.nodes() {
        let mut node = named.node.clone();
        for i in 0..node.inputs().len() {
            let input = prefixed(node.input(i));
            node.set_input(i, input);
        }
        if let (Node::GraphInput(input), Some((_, given))) =
            (&mut node, asked.inputs.iter().find(|(key, _)| key.value == named.name))
        {
            input.source = given.clone();
        }
        if asked.seed > 0 {
            reseed(&mut node, asked.seed);
        }
        recipe.add_masked(&format!("{}/{}", name.value, named.name), node, prefixed(&named.mask));
    }
    take_formulas(&name.value, &used, parameters);
    let outputs = used.output_inputs();
    let main = outputs.iter().find(|(output, _)| output == "height").or(outputs.first());
    let layers = outputs.iter().map(|(output, input)| (format!("{}.{output}", name.value), prefixed(input)));
    uses.outputs.extend(layers.chain(main.map(|(_, input)| (name.value.clone(), prefixed(input)))));
    uses.places.push((first..recipe.nodes().len(), name.span.clone()));
    uses.files.extend(used.used().iter().cloned().chain(file));
    Ok(())
}

/// Gives all noises new seeds: each node's seed hashed with the seed of the use.
fn reseed(node: &mut Node, seed: u64) {
    let params = node.spec().params;
    for i in (0..params.len()).filter(|i| matches!(params[*i].shape, Shape::Seed)) {
        if let Value::Integer(own) = node.param(i) {
            let mixed = (own as u64 ^ seed.wrapping_mul(0x9E37_79B9_7F4A_7C15)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            // A seed accepts any number of 63 bits.
            let _ = node.set_param(i, &Value::Integer(((mixed ^ (mixed >> 31)) >> 1) as i64));
        }
    }
}

/// Formulas in the nodes of a used recipe, with the given values in place of its parameters.
fn take_formulas(name: &str, used: &Recipe, parameters: &mut Parameters) {
    let given = |parameter: &str| -> Option<String> {
        let path = ["use", name, "parameters", parameter].map(|key| Step::Key(key.to_string()));
        let formula =
            parameters.formulas.iter().find(|formula| formula.path == path).map(|formula| formula.text.trim());
        match formula {
            Some(text) if parameters.value(text).is_some() => Some(text.to_string()),
            Some(text) => Some(format!("({text})")),
            None => {
                let value = used.parameters().iter().find(|known| known.name == parameter)?.value;
                Some(if value < 0.0 { format!("({value:?})") } else { format!("{value:?}") })
            }
        }
    };
    let mut taken = Vec::new();
    for Formula { path, text } in used.formulas() {
        let [Step::Key(nodes), Step::Key(node), rest @ ..] = path.as_slice() else { continue };
        let text = renamed(text, given);
        // A formula of constants only is replaced by its value.
        if nodes == "nodes" && !Expression::from(text.as_str()).names().is_empty() {
            let path =
                [Step::Key(nodes.clone()), Step::Key(format!("{name}/{node}"))].into_iter().chain(rest.iter().cloned());
            taken.push(Formula { path: path.collect(), text });
        }
    }
    parameters.formulas.append(&mut taken);
}
