//! A recipe in memory: the world, its nodes and its outputs.

pub use super::text::LONGEST_TEXT;

use crate::recipe::class::document::{ExpandedClass, TerrainClass};
use crate::recipe::class::list::CLASSES;
use crate::recipe::outputs::CLASS;
use crate::recipe::parameters::{Formula, Parameter, Parameters, Step};
use crate::recipe::scatter::document::{ExpandedScatter, Scatter};
use crate::recipe::scatter::list::SCATTERS;
use crate::recipe::surface::document::{Expanded, Surface};
use crate::recipe::surface::list::SURFACES;
use crate::recipe::world_spec;
pub use crate::recipe::world_spec::WorldSpec;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::dem::dem_file::DemFile;
use orogen_io::dem::file_ref::FileRef;
use orogen_io::dem::open;
use orogen_io::dem::prepared::PreparedDem;
use orogen_io::format::dem::Georeference;
use orogen_ops::declare::Input;
use orogen_ops::field::Dem;
use orogen_ops::node::Node;
use orogen_ops::op::Op;
use orogen_ops::value::{toml_key, toml_string};
use std::collections::HashSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The version of the recipe format that this library writes.
pub const VERSION: i64 = 1;

/// Maximum number of nodes of a recipe.
pub const MAX_NODES: usize = 65_536;

/// A node with its name and its mask.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedNode {
    /// The name.
    pub name: String,
    /// The op.
    pub node: Node,
    /// The weight of the op: where it is 1 the op has full effect; where it is 0 the result is the first input, or 0.
    pub mask: Input,
}

/// A recipe: the complete description of a world.
///
/// ```
/// use orogen_engine::field::Fbm;
/// use orogen_engine::solver::Normalise;
/// use orogen_engine::{Recipe, WorldSpec};
///
/// let world = WorldSpec::default().with_seed(7).with_size(Some([2000.0, 2000.0])).with_cell(10.0);
/// let mut recipe = Recipe::new(world);
/// recipe.add("base", Fbm { wavelength: 800.0, ..Fbm::default() });
/// recipe.add("hills", Normalise { source: "base".into(), low: 0.0, high: 300.0, ..Normalise::default() });
/// recipe.output("height", "hills");
/// assert!(recipe.to_toml().starts_with("orogen = 1"));
/// ```
#[derive(Debug, Clone)]
pub struct Recipe {
    /// A short description, or empty.
    pub about: String,
    /// The world.
    pub world: WorldSpec,
    parameters: Parameters,
    pub(super) used: Vec<PathBuf>,
    pub(super) nodes: Vec<NamedNode>,
    outputs: Vec<(String, Input)>,
    pub(super) surfaces: Vec<Surface>,
    pub(super) expanded: Vec<Expanded>,
    scatter: Vec<Scatter>,
    expanded_scatter: Vec<ExpandedScatter>,
    classes: Vec<TerrainClass>,
    expanded_classes: Vec<ExpandedClass>,
    pub(super) held: u64,
}

impl PartialEq for Recipe {
    /// Whether two recipes make the same world from the same parameters.
    fn eq(&self, other: &Recipe) -> bool {
        let document = |recipe: &Recipe| (recipe.about.clone(), recipe.world, recipe.held);
        document(self) == document(other)
            && self.parameters.list == other.parameters.list
            && self.nodes == other.nodes
            && self.outputs == other.outputs
            && self.surfaces == other.surfaces
            && self.expanded == other.expanded
            && self.scatter == other.scatter
            && self.expanded_scatter == other.expanded_scatter
            && self.classes == other.classes
            && self.expanded_classes == other.expanded_classes
    }
}

impl Recipe {
    /// A recipe without nodes.
    #[must_use]
    pub fn new(world: WorldSpec) -> Recipe {
        Recipe {
            about: String::new(),
            world,
            parameters: Parameters::default(),
            used: Vec::new(),
            nodes: Vec::new(),
            outputs: Vec::new(),
            surfaces: Vec::new(),
            expanded: Vec::new(),
            scatter: Vec::new(),
            expanded_scatter: Vec::new(),
            classes: Vec::new(),
            expanded_classes: Vec::new(),
            held: 0,
        }
    }

    /// Adds a node. Errors in it are reported when the world is opened.
    pub fn add(&mut self, name: &str, node: impl Into<Node>) -> &mut Recipe {
        self.add_masked(name, node, Input::None)
    }

    /// Adds a node with a mask: it has full effect where `mask` is 1.
    pub fn add_masked(&mut self, name: &str, node: impl Into<Node>, mask: impl Into<Input>) -> &mut Recipe {
        self.nodes.push(NamedNode { name: name.to_string(), node: node.into(), mask: mask.into() });
        self
    }

    /// Makes a node's result an output. Maps and meshes are made from the output `height`.
    pub fn output(&mut self, layer: &str, node: impl Into<Input>) -> &mut Recipe {
        self.outputs.push((layer.to_string(), node.into()));
        self
    }

    /// Replaces the outputs.
    pub(super) fn set_outputs(&mut self, outputs: Vec<(String, Input)>) {
        self.outputs = outputs;
    }

    /// Adds a surface on top of the existing ones. A recipe without surfaces has the surfaces of
    /// [`standard`](super::surface::standard).
    pub fn surface(&mut self, surface: Surface) -> &mut Recipe {
        self.surfaces.push(surface);
        self
    }

    /// Its own surfaces, bottom to top.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// Its surfaces with the nodes that compute them, after [`expand`](super::surface::expand::expand).
    #[must_use]
    pub fn expanded(&self) -> &[Expanded] {
        &self.expanded
    }

    /// Sets the surfaces with the nodes that compute them. These are not written with the recipe.
    pub(super) fn set_expanded(&mut self, expanded: Vec<Expanded>) {
        self.expanded = expanded;
    }

    /// Adds a kind of objects after the existing ones.
    pub fn add_scatter(&mut self, scatter: Scatter) -> &mut Recipe {
        self.scatter.push(scatter);
        self
    }

    /// Its kinds of objects, in the order in which they are placed.
    #[must_use]
    pub fn scatter(&self) -> &[Scatter] {
        &self.scatter
    }

    /// The nodes that compute the densities of its objects, after [`expand`](super::scatter::expand::expand).
    #[must_use]
    pub fn expanded_scatter(&self) -> &[ExpandedScatter] {
        &self.expanded_scatter
    }

    /// Sets the nodes that compute densities. These are not written with the recipe.
    pub(super) fn set_expanded_scatter(&mut self, expanded: Vec<ExpandedScatter>) {
        self.expanded_scatter = expanded;
    }

    /// Adds a terrain class, which covers those before it where its conditions hold.
    pub fn add_class(&mut self, class: TerrainClass) -> &mut Recipe {
        self.classes.push(class);
        self
    }

    /// Its terrain classes. The output `class` of its world has their numbers.
    #[must_use]
    pub fn classes(&self) -> &[TerrainClass] {
        &self.classes
    }

    /// The nodes that compute its terrain classes, after [`expand`](super::class::expand::expand).
    #[must_use]
    pub fn expanded_classes(&self) -> &[ExpandedClass] {
        &self.expanded_classes
    }

    /// Sets the nodes that compute terrain classes. These and the output that they make are not written with the
    /// recipe.
    pub(super) fn set_expanded_classes(&mut self, expanded: Vec<ExpandedClass>) {
        self.expanded_classes = expanded;
    }

    /// Its parameters, with their values. [`Recipe::read_with`] and [`Recipe::parse_with`] read a recipe with other
    /// values.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters.list
    }

    /// Sets its parameters, and the positions of formulas.
    pub(super) fn set_parameters(&mut self, parameters: Parameters) {
        self.parameters = parameters;
    }

    /// The formulas.
    pub(super) fn formulas(&self) -> &[Formula] {
        &self.parameters.formulas
    }

    /// The formula in place of the number of a node's parameter, without its `=`; `None` if the parameter has no
    /// formula.
    #[must_use]
    pub fn formula(&self, node: &str, key: &str) -> Option<&str> {
        let is_there = |formula: &&Formula| match formula.path.as_slice() {
            [Step::Key(nodes), Step::Key(name), Step::Key(own)] => nodes == "nodes" && name == node && own == key,
            _ => false,
        };
        self.parameters.formulas.iter().find(is_there).map(|formula| formula.text.as_str())
    }

    /// The files of the recipes that it uses, directly and indirectly.
    #[must_use]
    pub fn used(&self) -> &[PathBuf] {
        &self.used
    }

    /// Sets the files of the recipes that it uses.
    pub(super) fn set_used(&mut self, used: Vec<PathBuf>) {
        self.used = used;
    }

    /// Renames the inputs of its nodes, outputs, surfaces, scatter and classes.
    pub(super) fn rename_inputs(&mut self, of: impl Fn(&str) -> Option<Input>) {
        let other = |input: &Input| match input {
            Input::Node(name) => of(name),
            _ => None,
        };
        for NamedNode { node, mask, .. } in &mut self.nodes {
            for i in 0..node.inputs().len() {
                if let Some(input) = other(node.input(i)) {
                    node.set_input(i, input);
                }
            }
            if let Some(input) = other(mask) {
                *mask = input;
            }
        }
        for (_, output) in &mut self.outputs {
            if let Some(input) = other(output) {
                *output = input;
            }
        }
        self.surfaces.iter_mut().for_each(|surface| surface.rename_inputs(&of));
        self.scatter.iter_mut().for_each(|scatter| scatter.rename_inputs(&of));
        self.classes.iter_mut().for_each(|class| class.rename_inputs(&of));
    }

    /// The nodes in the order of the text.
    #[must_use]
    pub fn nodes(&self) -> &[NamedNode] {
        &self.nodes
    }

    /// Changes nodes in place; names and masks stay.
    pub fn change(&mut self, change: impl FnMut(&mut Node)) {
        self.nodes.iter_mut().map(|named| &mut named.node).for_each(change);
    }

    /// Sets the folder that relative paths in the recipe refer to, usually the folder of its file.
    pub fn set_base_dir(&mut self, folder: &Path) {
        let nodes = self.nodes.iter_mut().flat_map(|named| named.node.files());
        nodes
            .chain(self.surfaces.iter_mut().filter_map(Surface::picture_mut))
            .for_each(|file| file.set_base_dir(folder));
    }

    /// The position of the world on a map: the position of the first real place in the recipe, otherwise the world's
    /// `crs` and `origin`. A place without a coordinate system is in the world's `crs`. It is known after the files are
    /// read.
    #[must_use]
    pub fn georeference(&self) -> Option<Georeference> {
        match (self.place(), self.world.georeference()) {
            (Some(place), _) if place.is_on_map() => Some(place),
            (_, Some(own)) => Some(own),
            (Some(place), None) => Some(match self.world.crs {
                Some(crs) => Georeference { keys: Some(crs.keys()), ..place },
                None => place,
            }),
            (None, None) => None,
        }
    }

    /// The position of the first real place on its map.
    fn place(&self) -> Option<Georeference> {
        self.nodes.iter().find_map(|named| match named.node.op() {
            Op::Field(field) => field.georeference(),
            _ => None,
        })
    }

    /// Checks that `crs` and `origin` are given together and agree with the place in the recipe's files.
    pub(super) fn check_map(&self) -> Result<()> {
        let place = self.place();
        let message = match (&place, self.world.crs, self.world.origin) {
            (Some(place), _, Some(_)) if place.is_on_map() => {
                "the file of heights is georeferenced; leave out `origin`".to_string()
            }
            (Some(place), Some(crs), None) if place.is_on_map() && place.epsg() != Some(crs.code()) => format!(
                "the file of heights is in {}, but `crs` is EPSG:{}; heights are not reprojected. Leave out `crs`, or reproject the file first, for example with gdalwarp",
                place.epsg().map_or("a CRS without an EPSG code".into(), |code| format!("EPSG:{code}")),
                crs.code()
            ),
            (Some(place), Some(crs), None) if !place.is_on_map() && !place.fits(&crs) => format!(
                "the coordinates of the file of heights were read as {}, but EPSG:{} ({}) has other units",
                if place.counts_degrees() { "degrees" } else { "metres" },
                crs.code(),
                crs.name()
            ),
            (None, Some(crs), None) => format!(
                "`crs` is EPSG:{}, but `origin` is missing; set it to the easting and northing of the world's north-west corner",
                crs.code()
            ),
            (_, None, Some(_)) => {
                "`origin` is set, but `crs` is missing; set it, for example to \"EPSG:32632\"".to_string()
            }
            _ => return Ok(()),
        };
        Err(Error::new(ErrorKind::Recipe, message))
    }

    /// A recipe that consists of a real place, with its exact samples.
    #[must_use]
    pub fn from_dem(path: &Path, ground: &Arc<PreparedDem>) -> Recipe {
        let cell = ground.grid.window().cell;
        let size = ground.size.map(|samples| samples as f64 * cell);
        let mut recipe = Recipe::new(WorldSpec { size: Some(size), cell, ..WorldSpec::default() });
        let (path, band) = open::split(path);
        let mut file = FileRef::from(path.to_string_lossy().as_ref());
        file.set_base_dir(Path::new(""));
        file.hold(Arc::clone(ground));
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        recipe.about = format!("Heights of {name}");
        recipe.add("place", Dem { path: file, band: band.unwrap_or(0), ..Dem::default() }).output("height", "place");
        recipe
    }

    /// [`Recipe::from_dem`] for a file from which windows are read when they are requested.
    #[doc(hidden)]
    #[must_use]
    pub fn from_dem_file(path: &Path, file: &Arc<DemFile>) -> Recipe {
        let mut recipe = Recipe::from_dem(path, file.place());
        recipe.change(|node| {
            if let Node::Dem(dem) = node {
                dem.path.hold_file(Arc::clone(file));
            }
        });
        recipe
    }

    /// Whether its heights are the unchanged heights of a file.
    #[doc(hidden)]
    #[must_use]
    pub fn is_dem(&self) -> bool {
        matches!(self.nodes.as_slice(), [only] if matches!(only.node, Node::Dem(_)))
    }

    /// The names of its outputs.
    pub fn outputs(&self) -> impl Iterator<Item = &str> + Clone {
        self.outputs.iter().map(|(name, _)| name.as_str())
    }

    /// The outputs with their inputs.
    #[must_use]
    pub fn output_inputs(&self) -> &[(String, Input)] {
        &self.outputs
    }

    /// The recipe as TOML with all defaults written out, so that it makes the same world even if a later version has
    /// other defaults. Recipes that it uses become nodes of it. Parameters keep their current values as defaults, and
    /// formulas are kept.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut text = format!("orogen = {VERSION}\n");
        if !self.about.is_empty() {
            let _ = writeln!(text, "about = {}", toml_string(&self.about));
        }
        self.parameters.write_toml(&mut text);
        world_spec::KEYS.write("[world]", &self.world, &mut text);
        let bound = self.parameters.bound();
        for NamedNode { name, node, mask } in self.own_nodes() {
            let spec = node.spec();
            let _ = writeln!(text, "\n[nodes.{}]\nop = {:?}", toml_key(name), spec.op);
            let inputs = |text: &mut String| {
                for (i, input) in node.inputs().iter().enumerate() {
                    if !(spec.named_inputs && self.is_meant(&bound, name, input.name, node.input(i))) {
                        write_input(text, &toml_key(input.name), node.input(i));
                    }
                }
            };
            let params = |text: &mut String| {
                for (i, param) in spec.params.iter().enumerate() {
                    let _ = writeln!(text, "{} = {}", param.name, node.param(i).to_toml_lines());
                }
            };
            // An expression is written before the names in it.
            if spec.named_inputs {
                params(&mut text);
                inputs(&mut text);
            } else {
                inputs(&mut text);
                params(&mut text);
            }
            write_input(&mut text, "mask", mask);
        }
        text.push_str("\n[outputs]\n");
        let has_classes = !self.expanded_classes.is_empty();
        for (layer, input) in self.outputs.iter().filter(|(layer, _)| !(has_classes && layer == CLASS)) {
            write_input(&mut text, &toml_key(layer), input);
        }
        self.surfaces.iter().for_each(|surface| SURFACES.write(surface, &mut text));
        self.scatter.iter().for_each(|scatter| SCATTERS.write(scatter, &mut text));
        self.classes.iter().for_each(|class| CLASSES.write(class, &mut text));
        let specs = self.nodes.iter().map(|named| named.node.spec());
        self.parameters.restore(text, |op| specs.clone().find(|spec| spec.op == op))
    }

    /// The nodes of its text, without those that surfaces, scatter and classes add.
    pub(super) fn own_nodes(&self) -> impl Iterator<Item = &NamedNode> {
        let surfaces = self.expanded.iter().map(|surface| &surface.nodes);
        let scatter = self.expanded_scatter.iter().map(|scatter| &scatter.nodes);
        let expanded = surfaces.chain(scatter).chain(self.expanded_classes.iter().map(|class| &class.nodes));
        let is_own = move |at: &usize| !expanded.clone().any(|nodes| nodes.contains(at));
        self.nodes.iter().enumerate().filter(move |(at, _)| is_own(at)).map(|(_, named)| named)
    }

    /// Whether a name in an expression refers to this input by default.
    fn is_meant(&self, bound: &HashSet<(&str, &str)>, node: &str, name: &str, input: &Input) -> bool {
        match (self.parameters.value(name), input) {
            (Some(value), Input::Value(number)) => value == *number && bound.contains(&(node, name)),
            (None, Input::Node(source)) => source == name,
            _ => false,
        }
    }
}

fn write_input(text: &mut String, key: &str, input: &Input) {
    let _ = match input {
        Input::None => Ok(()),
        Input::Node(name) => writeln!(text, "{key} = {}", toml_string(name)),
        Input::Value(value) => writeln!(text, "{key} = {value:?}"),
    };
}
