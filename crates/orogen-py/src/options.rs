//! Keywords as options of the library, and the declarations of all options for the Python part.

use orogen::builder::BuildSpec;
use orogen::export::derived::list;
use orogen::export::registry;
use orogen::export::targets::job::EngineJob;
use orogen::fit::FitJob;
use orogen::jobs::noise::NoiseJob;
use orogen::jobs::refine::RefineJob;
use orogen::jobs::{BlocksJob, MapJob, RenderJob};
use orogen::options::{OptionSpec, Options, ValueKind};
use orogen::tilemap::TilemapJob;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyTuple};

use crate::failure::raised;

/// The options of a kind of work, by the name of the method that does it.
pub fn of_work(work: &str) -> Vec<&'static OptionSpec> {
    match work {
        "export" => registry::options().into_iter().map(|(spec, _)| spec).collect(),
        "engine" => EngineJob::OPTIONS.iter().collect(),
        "layer" => list::options().into_iter().map(|(spec, _)| spec).collect(),
        "map" => MapJob::OPTIONS.iter().collect(),
        "render" => RenderJob::OPTIONS.iter().collect(),
        "blocks" | "minecraft" => BlocksJob::OPTIONS.iter().collect(),
        "tilemap" => TilemapJob::OPTIONS.iter().collect(),
        "build" => BuildSpec::OPTIONS.iter().collect(),
        "fit" => FitJob::OPTIONS.iter().collect(),
        "refine" => RefineJob::OPTIONS.iter().collect(),
        "noise" => NoiseJob::OPTIONS.iter().collect(),
        _ => Vec::new(),
    }
}

/// Name, type, default and help of an option.
type Declaration = (String, &'static str, &'static str, &'static str);

/// The options of a kind of work, for the signatures of the Python part.
#[pyfunction]
pub fn declared(work: &str) -> Vec<Declaration> {
    of_work(work).into_iter().map(declaration).collect()
}

/// Name, description and options of each layer that is derived from the heights.
#[pyfunction]
pub fn derived_layers() -> Vec<(&'static str, &'static str, Vec<Declaration>)> {
    let options = |specs: &'static [OptionSpec]| specs.iter().map(declaration).collect();
    list::all().iter().map(|layer| (layer.name, layer.about, options((layer.options)()))).collect()
}

fn declaration(spec: &OptionSpec) -> Declaration {
    (keyword(spec), type_of(spec.kind), spec.default, spec.about)
}

/// The name of an option as a keyword.
fn keyword(spec: &OptionSpec) -> String {
    spec.name.replace('-', "_")
}

/// The Python type of the values of a kind.
fn type_of(kind: ValueKind) -> &'static str {
    match kind {
        ValueKind::Nothing => "bool",
        ValueKind::Whole(..) => "int",
        ValueKind::Number(..) | ValueKind::Positive => "float",
        ValueKind::Automatic => "float | bool",
        ValueKind::Numbers | ValueKind::Range | ValueKind::Point | ValueKind::Tuple(..) => "Sequence[float]",
        ValueKind::Size(..) => "int | tuple[int, int]",
        ValueKind::Clock | ValueKind::Text | ValueKind::Color | ValueKind::Layer | ValueKind::Paper => "str",
        ValueKind::Word(..) | ValueKind::Choice(..) | ValueKind::Part(..) => "str",
        ValueKind::Palette | ValueKind::Tileset | ValueKind::File => "str | PathLike[str]",
    }
}

/// The options of these declarations that keywords give. `None` gives none, and neither does `False` for a switch.
///
/// # Errors
/// `TypeError` for a keyword that is not declared or a value without a text; the errors of the library.
pub fn of_keywords(specs: &[&'static OptionSpec], keywords: &Bound<'_, PyDict>) -> PyResult<Options> {
    let py = keywords.py();
    let mut given: Vec<(String, String)> = Vec::new();
    for (key, value) in keywords.iter() {
        let key: String = key.extract()?;
        let name = key.replace('_', "-");
        let spec = specs.iter().find(|spec| spec.name == name || spec.aliases.contains(&name.as_str()));
        let Some(spec) = spec else {
            let names: Vec<String> = specs.iter().map(|spec| keyword(spec)).collect();
            let near = orogen::grid::words::nearest(&key, names.iter().map(String::as_str));
            let hint = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            return Err(PyTypeError::new_err(format!("there is no option `{key}`{hint}")));
        };
        if let Some(text) = text(spec, &value)? {
            given.push((spec.name.to_owned(), text));
        }
    }
    let given = given.iter().map(|(name, text)| (name.as_str(), text.as_str()));
    Options::of(specs.iter().copied(), given).map_err(|error| raised(py, &error))
}

/// The options of a kind of work, those of the derived layer that it writes or draws, and those of the game engine that
/// an export is for.
///
/// # Errors
/// Those of [`of_keywords`].
pub fn split(work: &str, keywords: &Bound<'_, PyDict>) -> PyResult<[Options; 3]> {
    let groups: [&[&str]; 3] = match work {
        "export" => [&["export"], &["layer"], &["engine"]],
        "map" => [&["map"], &["layer"], &[]],
        _ => [&[work], &[], &[]],
    };
    let specs = groups.map(|works| works.iter().flat_map(|work| of_work(work)).collect::<Vec<_>>());
    let given = [(); 3].map(|()| PyDict::new(keywords.py()));
    for (key, value) in keywords.iter() {
        let name: String = key.extract::<String>()?.replace('_', "-");
        let knows = |specs: &Vec<&OptionSpec>| specs.iter().any(|spec| spec.name == name);
        // Unknown ones are refused with the names of the first group.
        let group = specs.iter().position(knows).unwrap_or(0);
        given[group].set_item(key, value)?;
    }
    let [own, of_layer, of_engine] = [0, 1, 2].map(|group| of_keywords(&specs[group], &given[group]));
    Ok([own?, of_layer?, of_engine?])
}

/// The text of a value, as a command line would have it; `None` if the option is not given.
fn text(spec: &OptionSpec, value: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    if value.is_none() {
        return Ok(None);
    }
    if value.is_instance_of::<PyBool>() {
        let is_given = value.is_truthy()?;
        return match spec.kind {
            ValueKind::Nothing => Ok(is_given.then(String::new)),
            ValueKind::Automatic => Ok(is_given.then(|| "auto".to_owned())),
            _ => Err(PyTypeError::new_err(format!("`{}` must not be a bool", keyword(spec)))),
        };
    }
    if spec.kind == ValueKind::Nothing {
        return Err(PyTypeError::new_err(format!("`{}` must be True or False", keyword(spec))));
    }
    if value.is_instance_of::<PyTuple>() || value.is_instance_of::<PyList>() {
        let parts = value.try_iter()?.map(|part| plain(&part?)).collect::<PyResult<Vec<String>>>()?;
        let separator = if matches!(spec.kind, ValueKind::Size(_)) { "x" } else { "," };
        return Ok(Some(parts.join(separator)));
    }
    plain(value).map(Some)
}

/// The text of a number, a string, a path or a time of day.
fn plain(value: &Bound<'_, PyAny>) -> PyResult<String> {
    if value.is_instance_of::<PyFloat>() {
        return Ok(value.extract::<f64>()?.to_string());
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(value.str()?.to_string());
    }
    if let Ok(number) = value.extract::<f64>() {
        // Numbers of NumPy.
        return Ok(number.to_string());
    }
    if let Ok(path) = value.call_method0("__fspath__") {
        return path.extract();
    }
    if value.hasattr("hour")? && value.hasattr("minute")? {
        let [hour, minute] = ["hour", "minute"].map(|name| value.getattr(name).and_then(|part| part.extract::<u32>()));
        return Ok(format!("{:02}:{:02}", hour?, minute?));
    }
    value.extract::<String>().map_err(|_| {
        let kind = value.get_type().name().map_or_else(|_| "object".to_owned(), |name| name.to_string());
        PyTypeError::new_err(format!("a value must be a number, text or a path, not {kind}"))
    })
}
