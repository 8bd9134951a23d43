//! Places among vector features: summits, lakes, rivers.

use super::condition::Condition;
use super::report::Match;
use super::search::{Area, SIDE};
use crate::export::features::layer::{Maker, VectorLayer};
use crate::export::features::options::FeatureOptions;
use crate::export::features::source::FeatureSource;
use orogen_engine::world::World;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::words::suggestion;
use orogen_io::format::features::{Feature, FeatureLayer, Geometry, Value};

/// Width of the border in which features are whole, in samples.
const BORDER: usize = SIDE / 2;

/// Features of a layer that satisfy conditions on their attributes.
pub(super) struct Objects<'a> {
    pub world: &'a World,
    /// The searched area.
    pub area: Area,
    pub layer: &'static VectorLayer,
    pub options: FeatureOptions<'a>,
    pub conditions: &'a [Condition],
    /// The attribute whose largest value is wanted.
    pub largest: Option<&'a str>,
}

impl Objects<'_> {
    /// The features whose nearest vertex is in a part of the world.
    pub(super) fn places(&self, part: &Window, progress: &Progress) -> Result<Vec<Match>> {
        let all = part.grown(BORDER);
        let all = match self.world.recipe().world.size {
            Some(_) => all.intersection(&self.world.full_window(all.cell)?),
            None => all,
        };
        let layer = match self.layer.make {
            Maker::World(make) => make(self.world, &all, progress)?,
            Maker::Ground(make) => {
                let ground = FeatureSource::of(self.world, &all, &self.options, 0, progress)?;
                self.world.install(|| make(&ground, &self.options, progress))?
            }
        };
        let columns = self
            .conditions
            .iter()
            .map(|condition| Ok((self.column(&layer, &condition.name, "--where")?, condition)))
            .collect::<Result<Vec<_>>>()?;
        let largest = self.largest.map(|name| self.column(&layer, name, "--largest")).transpose()?;
        let holds = |feature: &&Feature| {
            columns.iter().all(|(column, condition)| condition.holds_for(&feature.values[*column]))
        };
        let place = |feature: &Feature| {
            let at = nearest(&feature.geometry, &self.area)?;
            let distance = self.area.distance(at);
            let rank = match largest.map(|column| &feature.values[column]) {
                None => distance,
                Some(Value::Real(value)) => -value,
                Some(Value::Integer(value)) => -(*value as f64),
                Some(_) => return None,
            };
            // Numbers of objects are those of this part of the world.
            let fields = layer.fields.iter().zip(&feature.values).filter(|(field, value)| {
                **value != Value::Null && !field.about.starts_with("number of") && !field.about.starts_with("id of")
            });
            let values = fields.map(|(field, value)| (field.name.to_owned(), value.clone(), unit(field.about)));
            Some(Match { at, coordinates: at, distance, values: values.collect(), rank })
        };
        let is_here = |place: &Match| {
            let [x, y] = place.at.map(|at| (at / part.cell).round() as i64);
            (part.x..part.right()).contains(&x)
                && (part.y..part.bottom()).contains(&y)
                && place.distance <= self.area.within
        };
        Ok(layer.features.iter().filter(holds).filter_map(place).filter(is_here).collect())
    }

    fn column(&self, layer: &FeatureLayer, name: &str, option: &str) -> Result<usize> {
        let names = || layer.fields.iter().map(|field| field.name);
        names().position(|field| field == name).ok_or_else(|| {
            let known: Vec<&str> = names().collect();
            let message = format!(
                "{option}: {} have no attribute `{name}`; {}",
                self.layer.name,
                suggestion(name, known.iter().copied())
            );
            Error::new(ErrorKind::Request, message)
        })
    }
}

/// The vertex that is nearest to the position from which distances are measured.
fn nearest(geometry: &Geometry, area: &Area) -> Option<[f64; 2]> {
    let of = |places: &mut dyn Iterator<Item = [f64; 2]>| {
        places.map(|at| (area.distance(at), at)).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, at)| at)
    };
    match geometry {
        Geometry::Point([east, south, _]) => Some([*east, *south]),
        Geometry::Line(points) => of(&mut points.iter().map(|[east, south, _]| [*east, *south])),
        Geometry::MultiPolygon(parts) => of(&mut parts.iter().flatten().flatten().copied()),
    }
}

/// The unit in the description of an attribute, such as `area, m^2`.
fn unit(about: &'static str) -> &'static str {
    const UNITS: [&str; 6] = ["m^3/s", "m^2", "m^3", "m", "degrees", "m/s"];
    let after = about.split(", ").nth(1).unwrap_or_default();
    let word = after.split([':', ' ', ';']).next().unwrap_or_default();
    UNITS.into_iter().find(|unit| *unit == word).unwrap_or_default()
}
