//! Numbers of a recipe that can be changed without its text: its parameters, and scalar parameters of its nodes.

use super::document::{NamedNode, Recipe};
use super::surface::document::Surface;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::suggestion;
use orogen_io::dem::file_ref::FileRef;
use orogen_ops::declare::{ParamSpec, Shape};
use orogen_ops::value::Value;

/// A scalar parameter of a node.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeScalar {
    /// The name of the node.
    pub node: String,
    /// The op of the node.
    pub op: &'static str,
    /// The key of the parameter.
    pub key: &'static str,
    /// The value.
    pub value: f64,
    /// Whether the value must be a whole number.
    pub is_whole: bool,
    /// The minimum and maximum value; infinite if there is no bound.
    pub range: [f64; 2],
    /// The unit, or empty.
    pub unit: &'static str,
    /// The documentation.
    pub doc: &'static str,
    /// The formula of the recipe's parameters in place of the number, or empty.
    pub formula: String,
}

impl NodeScalar {
    /// The name in [`Recipe::with_values`].
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}.{}", self.node, self.key)
    }
}

/// Largest whole number that a float has exactly.
const EXACT: f64 = (1u64 << 53) as f64;

/// Whether a parameter is a single number; seeds and integers are whole.
fn scalar(param: &ParamSpec) -> Option<bool> {
    match param.shape {
        Shape::Number => Some(false),
        Shape::Integer | Shape::Seed => Some(true),
        _ => None,
    }
}

impl Recipe {
    /// The scalar parameters of its own nodes, in the order of the text. Nodes that read a file have none: files that
    /// were read stay read.
    #[doc(hidden)]
    #[must_use]
    pub fn scalars(&self) -> Vec<NodeScalar> {
        let mut scalars = Vec::new();
        for NamedNode { name, node, .. } in self.own_nodes() {
            let spec = node.spec();
            if spec.params.iter().any(|param| matches!(param.shape, Shape::File)) {
                continue;
            }
            for (i, param) in spec.params.iter().enumerate() {
                let (Some(is_whole), Some(value)) = (scalar(param), node.param(i).number()) else { continue };
                let range = match param.shape {
                    Shape::Seed => [0.0, EXACT],
                    _ => param.range,
                };
                scalars.push(NodeScalar {
                    node: name.clone(),
                    op: spec.op,
                    key: param.name,
                    value,
                    is_whole,
                    range,
                    unit: param.unit,
                    doc: param.doc,
                    formula: self.formula(name, param.name).unwrap_or_default().to_string(),
                });
            }
        }
        scalars
    }

    /// The recipe with another seed and other numbers: `NAME` is a parameter of the recipe, `NODE.KEY` a scalar
    /// parameter of a node. Files that were read stay read.
    ///
    /// # Errors
    /// If there is no such parameter, or a value is not valid.
    #[doc(hidden)]
    pub fn with_values(&self, seed: Option<u64>, values: &[(String, f64)]) -> Result<Recipe> {
        let of_recipe = |(name, _): &&(String, f64)| !name.contains('.');
        let own: Vec<(String, f64)> = values.iter().filter(of_recipe).cloned().collect();
        let mut recipe = match own.as_slice() {
            [] => self.clone(),
            own => self.with_parameters(own)?,
        };
        recipe.world.seed = seed.unwrap_or(recipe.world.seed);
        for (name, value) in values.iter().filter(|value| !of_recipe(value)) {
            recipe.set_scalar(name, *value).map_err(|message| Error::new(ErrorKind::Request, message))?;
        }
        Ok(recipe)
    }

    /// The recipe with other values of its parameters, on which formulas anywhere in it depend.
    fn with_parameters(&self, values: &[(String, f64)]) -> Result<Recipe> {
        let fault = |error: Error| Error::new(ErrorKind::Request, error.to_string());
        let mut recipe = Recipe::parse_with(&self.to_toml(), "the recipe", values).map_err(fault)?;
        let mut files = self.clone().files_by_name();
        for (name, file) in recipe.files_mut() {
            if let Some(at) = files.iter().position(|(own, _)| *own == name) {
                *file = files.swap_remove(at).1;
            }
        }
        Ok(recipe)
    }

    /// The files that nodes and surfaces name, by the position of the parameter.
    fn files_by_name(mut self) -> Vec<(String, FileRef)> {
        self.files_mut().into_iter().map(|(name, file)| (name, file.clone())).collect()
    }

    fn files_mut(&mut self) -> Vec<(String, &mut FileRef)> {
        let nodes = self.nodes.iter_mut().flat_map(|NamedNode { name, node, .. }| {
            node.files().into_iter().enumerate().map(move |(i, file)| (format!("node {name} {i}"), file))
        });
        let surfaces = self.surfaces.iter_mut().enumerate();
        let pictures =
            surfaces.filter_map(|(i, surface)| Some((format!("surface {i}"), Surface::picture_mut(surface)?)));
        nodes.chain(pictures).collect()
    }

    /// Sets a scalar parameter of a node.
    fn set_scalar(&mut self, name: &str, value: f64) -> std::result::Result<(), String> {
        let all = self.scalars();
        let Some(found) = all.iter().find(|scalar| scalar.name() == name) else {
            let names: Vec<String> = all.iter().map(NodeScalar::name).collect();
            return Err(match names.as_slice() {
                [] => format!("there is no parameter `{name}`: no node has a scalar parameter"),
                _ => format!("there is no parameter `{name}`; {}", suggestion(name, names.iter().map(String::as_str))),
            });
        };
        let given = match found.is_whole && value.fract() == 0.0 && value.abs() <= EXACT {
            true => Value::Integer(value as i64),
            false => Value::Number(value),
        };
        let node = self.nodes.iter_mut().find(|own| own.name == found.node).map(|own| &mut own.node);
        let Some((node, i)) = node.and_then(|node| node.spec().param_named(found.key).map(|i| (node, i))) else {
            return Err(format!("there is no parameter `{name}`"));
        };
        node.set_param(i, &given).map_err(|_| {
            let param = &node.spec().params[i];
            format!("`{name}` must be {}, not {value}", param.expected())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"
orogen = 1
[parameters]
relief = 300
[parameters.side]
default = 4000
range = [1000, 9000]
[world]
size = ["=side", 2000]
cell = 10
[nodes.noise]
op = "fbm"
wavelength = 900
[nodes.land]
op = "remap"
source = "noise"
to = [0, "=relief"]
[outputs]
height = "land"
"#;

    fn recipe() -> Recipe {
        Recipe::parse(TEXT, "test").unwrap()
    }

    #[test]
    fn numbers_are_those_of_a_recipe_with_other_numbers() {
        let values = [("relief".into(), 500.0), ("side".into(), 6000.0), ("noise.octaves".into(), 3.0)];
        let changed = recipe().with_values(Some(9), &values).unwrap();
        let text = TEXT.replace("relief = 300", "relief = 500").replace("default = 4000", "default = 6000");
        let text = text.replace("wavelength = 900", "wavelength = 900\noctaves = 3").replace("cell", "seed = 9\ncell");
        assert_eq!(changed, Recipe::parse(&text, "test").unwrap());
        assert_eq!(recipe().with_values(None, &[]).unwrap(), recipe());
        let scalars = recipe().scalars();
        let found = scalars.iter().find(|scalar| scalar.name() == "noise.wavelength").unwrap();
        assert_eq!((found.value, found.unit, found.is_whole, found.op), (900.0, "m", false, "fbm"));
    }

    #[test]
    fn nodes_that_read_a_file_have_nothing_to_set() {
        let text = TEXT.replace("[outputs]", "[nodes.place]\nop = \"dem\"\npath = \"nowhere.tif\"\n[outputs]");
        let recipe = Recipe::parse(&text, "test").unwrap();
        assert!(recipe.scalars().iter().all(|scalar| scalar.node != "place"));
        assert!(recipe.with_values(None, &[("place.band".into(), 1.0)]).is_err());
        // Files keep their folder and what was read of them.
        let mut based = recipe.clone();
        based.set_base_dir(std::path::Path::new("folder"));
        let changed = based.with_values(None, &[("relief".into(), 500.0)]).unwrap();
        assert_eq!(changed.files(), based.files());
        assert_ne!(changed.files(), recipe.files());
    }

    #[test]
    fn what_cannot_be_set_is_a_sentence() {
        for (name, value, expect) in [
            ("releif", 1.0, "did you mean `relief`"),
            ("side", 1.0, "must be a finite number from 1000 to 9000, not 1"),
            ("noise.octave", 1.0, "did you mean `noise.octaves`"),
            ("noise.octaves", 2.5, "must be a whole number"),
            ("noise.octaves", -1.0, "must be a whole number"),
            ("noise.octaves", 1e300, "must be a whole number"),
            ("noise.wavelength", -1.0, "must be a finite number"),
            ("noise.wavelength", f64::NAN, "must be a finite number"),
            ("land.to", 1.0, "no parameter `land.to`"),
            ("nothing.at", 1.0, "no parameter `nothing.at`"),
            (".", 1.0, "no parameter `.`"),
            ("", 1.0, "no parameter ``"),
        ] {
            let error = recipe().with_values(None, &[(name.to_string(), value)]).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Request, "{name}");
            assert!(error.to_string().contains(expect), "{name}: {error}");
        }
    }
}
