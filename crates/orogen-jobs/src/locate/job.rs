//! The search as one job.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::condition::{self, Condition};
use super::ground::Ground;
use super::objects::Objects;
use super::report::{Located, Match};
use super::search::Area;
use crate::export::derived::layer::Made;
use crate::export::derived::list;
use crate::export::features::layer::VectorLayer;
use crate::export::features::list as vector_list;
use crate::export::features::options::{FeatureOptions, LAKE_AREA, PROMINENCE, RIVER_AREA};
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::recipe::document::Recipe;
use orogen_engine::world::{World, check_cell};

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::format::dem::Georeference;

/// The search for the places of a world that satisfy conditions, the nearest first.
///
/// ```
/// use orogen_engine::{Progress, World, presets};
/// use orogen_jobs::locate::LocateJob;
/// use orogen_jobs::options::Options;
///
/// let options = Options::of(LocateJob::OPTIONS, [("where", "height > 200 and slope < 10")])?;
/// let job = LocateJob::new(&options)?;
/// let mut recipe = presets::find("classic").ok_or("no such preset")?.recipe()?;
/// job.prepare(&mut recipe)?;
/// let found = job.run(&World::open(recipe)?, &Progress::none())?;
/// assert_eq!(found.places.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LocateJob {
    /// Number of places.
    pub count: usize,
    /// The distance between the samples that are searched, in metres; `None` chooses one by the area.
    pub cell: Option<f64>,
    find: &'static str,
    conditions: Vec<Condition>,
    largest: Option<String>,
    near: Option<[f64; 2]>,
    within: Option<f64>,
    least: f64,
    apart: Option<f64>,
    features: Options,
}

/// What can be found.
const FIND: &[&str] = &["ground", "summits", "lakes", "rivers", "coast", "roads", "scatter"];

/// Default radius in worlds without bounds, in metres.
const WITHIN: f64 = 100_000.0;

/// Default distance between places on the ground, in cells of the search.
const APART: f64 = 16.0;

/// Number of coarse candidates that are searched for each place with a largest value, and minimum number of these.
const CANDIDATES: [usize; 2] = [4, 16];

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("where", "CONDITIONS", ValueKind::Text).with_about(
        "Conditions on layers of the world, or on attributes of the objects, joined by `and`: a name, one of > >= < \
         <= = != and a number, with a unit if wanted (m, km, m2, ha, km2), such as `height > 3000 and slope < 5` or \
         `area > 2km2`",
    ),
    OptionSpec::new("find", "WHAT", ValueKind::Word(FIND))
        .with_about(
            "What is searched: `ground`, or the objects `summits`, `lakes`, `rivers`, `coast`, `roads` or `scatter`",
        )
        .with_default("ground"),
    OptionSpec::new("near", "E,N", ValueKind::Point).with_about(
        "Position that distances are measured from: easting and northing in the CRS of the heights; without a CRS, \
         metres east and north of the world's north-west corner (points south of it are negative) [default: the \
         middle of the world; without bounds, 0,0]",
    ),
    OptionSpec::new("within", "M", ValueKind::Number(0.0, 1e9))
        .with_about("Maximum distance in metres [default: the whole world; without bounds, 100000]"),
    OptionSpec::new("area", "M2", ValueKind::Number(0.0, 1e12))
        .with_about("Minimum area of connected ground in m^2, for places on the ground")
        .with_default("0"),
    OptionSpec::new("largest", "NAME", ValueKind::Text)
        .with_about("The places where this layer or attribute is largest, in place of the nearest ones"),
    OptionSpec::new("count", "N", ValueKind::Whole(1, 1000)).with_about("Number of places").with_default("1"),
    OptionSpec::new("apart", "M", ValueKind::Number(0.0, 1e9)).with_about(
        "Minimum distance between two places in metres [default: 16 cells of the search for ground, 0 for objects]",
    ),
    RIVER_AREA,
    LAKE_AREA,
    PROMINENCE,
];

impl LocateJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// The search that is chosen by [`OPTIONS`](LocateJob::OPTIONS).
    ///
    /// # Errors
    /// If the conditions cannot be read, or an option does not apply to what is searched.
    pub fn new(options: &Options) -> Result<LocateJob> {
        let find = options.word("find").unwrap_or(FIND[0]);
        let features = [RIVER_AREA, LAKE_AREA, PROMINENCE];
        let refused = |name: &str, of: &str| {
            Err(Error::new(ErrorKind::Request, format!("--{name} does not apply to --find {find}; {of}")))
        };
        if find != FIND[0] && options.has("area") {
            return refused("area", "use a condition, such as --where \"area > 1ha\"");
        }
        if let Some(spec) = features.iter().find(|spec| find == FIND[0] && options.has(spec.name)) {
            return refused(spec.name, "it applies to objects");
        }
        let given = features.iter().filter_map(|spec| Some((spec, options.number(spec.name)?)));
        let mut of_features = Options::default();
        for (spec, number) in given {
            of_features.give(spec, &number.to_string())?;
        }
        Ok(LocateJob {
            count: options.whole("count").unwrap_or(1) as usize,
            cell: None,
            find,
            conditions: condition::read(options.text("where").unwrap_or_default())?,
            largest: options.text("largest").map(str::to_owned),
            near: options.pair("near"),
            within: options.number("within"),
            least: options.number("area").unwrap_or(0.0),
            apart: options.number("apart"),
            features: of_features,
        })
    }

    /// The same with this distance between the samples that are searched, in metres.
    #[must_use]
    pub fn with_cell(self, cell: Option<f64>) -> LocateJob {
        LocateJob { cell, ..self }
    }

    /// The layers that are compared; none for objects.
    pub fn layers(&self) -> impl Iterator<Item = &str> {
        let all = self.conditions.iter().map(|condition| condition.name.as_str()).chain(self.largest.as_deref());
        all.filter(|_| self.objects().is_none())
    }

    fn objects(&self) -> Option<&'static VectorLayer> {
        vector_list::named(self.find)
    }

    /// Appends the nodes that the layers of the conditions need; call it before the world is opened.
    ///
    /// # Errors
    /// If a layer cannot be used in a condition.
    pub fn prepare(&self, recipe: &mut Recipe) -> Result<()> {
        if self.objects().is_some() {
            return Ok(());
        }
        for name in self.conditions.iter().map(|condition| &condition.name).chain(&self.largest) {
            let is_own = recipe.outputs().any(|output| output == name);
            if !is_own && list::named(name).is_some_and(|derived| matches!(derived.made, Made::Channels(_))) {
                let message = format!("the layer `{name}` has several values at a place and cannot be compared");
                return Err(Error::new(ErrorKind::Request, message));
            }
            list::prepare(recipe, name, &Options::default())?;
        }
        Ok(())
    }

    /// Finds the places.
    ///
    /// # Errors
    /// If there is no such layer or attribute; if the area has too many samples, or they do not fit into memory; or if
    /// the work was cancelled.
    pub fn run(&self, world: &World, progress: &Progress) -> Result<Located> {
        let recipe = world.recipe();
        let map = recipe.georeference();
        let map = map.unwrap_or(Georeference::LOCAL);
        let middle = recipe.world.size.map_or([0.0; 2], |size| size.map(|length| length / 2.0));
        let near = self.near.map_or(middle, |[east, north]| map.metres(east, north));
        let whole = recipe.world.size.map(|[width, height]| {
            let far = |at: f64, length: f64| at.abs().max((length - at).abs());
            libm::hypot(far(near[0], width), far(near[1], height))
        });
        let area = Area { near, within: self.within.or(whole).unwrap_or(WITHIN) };
        let cell = self.cell.unwrap_or_else(|| area.cell(world));
        check_cell(cell)?;
        let own_cell = if self.objects().is_some() { cell } else { recipe.world.cell.min(cell) };
        let kind = match self.objects() {
            Some(layer) => Kind::Objects(Box::new(Objects {
                world,
                area,
                layer,
                options: FeatureOptions::new(&self.features, recipe)?,
                conditions: &self.conditions,
                largest: self.largest.as_deref(),
            })),
            None => Kind::Ground(Ground::new(world, area, &self.conditions, self.least, self.largest.as_deref())?),
        };
        let apart = self.apart.unwrap_or(if self.objects().is_some() { 0.0 } else { APART * cell });
        let mut search = Search { kind, own_cell, apart, count: self.count, places: Vec::new() };
        let parts = match (self.objects(), recipe.world.size) {
            // The water of a bounded world is found as a whole, whichever part is requested.
            (Some(_), Some(_)) => vec![(0.0, world.full_window(cell)?)],
            _ => area.parts(world, cell)?,
        };
        progress.expect(parts.len() as f64);
        match self.largest {
            None => search.nearest(&parts, progress)?,
            Some(_) => search.largest(&parts, progress)?,
        }
        progress.finish();
        let mut places = search.places;
        for place in &mut places {
            place.coordinates = map.at(place.at[0], place.at[1]);
        }
        Ok(Located { places, cell, own_cell, near, within: area.within })
    }
}

/// What is searched.
enum Kind<'a> {
    Ground(Ground<'a>),
    Objects(Box<Objects<'a>>),
}

struct Search<'a> {
    kind: Kind<'a>,
    /// The cell of the samples in which places are found, in metres.
    own_cell: f64,
    /// Minimum distance between places, in metres.
    apart: f64,
    /// Number of places that are wanted.
    count: usize,
    /// The places so far.
    places: Vec<Match>,
}

/// Something to look at, with the least rank that a place in it can have.
struct Open {
    least: f64,
    what: What,
}

enum What {
    Window(Window),
    Found(Box<Match>),
}

impl Ord for Open {
    /// The greatest is the one to look at first: of equal ranks a window, which may have a place of that rank, then the
    /// place in the north-west.
    fn cmp(&self, other: &Open) -> Ordering {
        let order = |open: &Open| match &open.what {
            What::Window(window) => (0, window.y as f64, window.x as f64),
            What::Found(place) => (1, place.at[1], place.at[0]),
        };
        let (own, others) = (order(self), order(other));
        let rank = self.least.total_cmp(&other.least).then(own.0.cmp(&others.0));
        rank.then(own.1.total_cmp(&others.1)).then(own.2.total_cmp(&others.2)).reverse()
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Open) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Open) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

impl Search<'_> {
    /// What a part of the world has: places, or windows at a smaller cell.
    fn look(&self, part: &Window, progress: &Progress) -> Result<Vec<Open>> {
        let of_place = |place: Match| Open { least: place.rank, what: What::Found(Box::new(place)) };
        Ok(match &self.kind {
            Kind::Ground(ground) if part.cell > self.own_cell => {
                let is_nearest = |window: &Window| ground.area.distance_of(window);
                let found = ground.candidates(part, progress)?.into_iter();
                let of_window = |(rank, window): (f64, Window)| Open {
                    least: if ground.is_nearest() { is_nearest(&window) } else { rank },
                    what: What::Window(window),
                };
                found.map(of_window).collect()
            }
            Kind::Ground(ground) => ground.places(part, progress)?.into_iter().map(of_place).collect(),
            Kind::Objects(objects) => objects.places(part, progress)?.into_iter().map(of_place).collect(),
        })
    }

    /// Takes a place unless it is too near to another one. Returns whether there are enough.
    fn take(&mut self, place: Match) -> bool {
        let is_apart = |other: &Match| {
            libm::hypot(place.at[0] - other.at[0], place.at[1] - other.at[1]) >= self.apart.max(f64::MIN_POSITIVE)
        };
        if self.places.iter().all(is_apart) {
            self.places.push(place);
        }
        self.places.len() >= self.count
    }

    /// Finds the nearest places: what may have a nearer place than all else is looked at first.
    fn nearest(&mut self, parts: &[(f64, Window)], progress: &Progress) -> Result<()> {
        let mut open = BinaryHeap::new();
        let mut parts = parts.iter().peekable();
        loop {
            progress.check()?;
            let next = open.peek().map_or(f64::INFINITY, |open: &Open| open.least);
            if let Some((_, part)) = parts.next_if(|(distance, _)| *distance <= next) {
                open.extend(self.look(part, &progress.part(1.0))?);
                continue;
            }
            match open.pop().map(|open| open.what) {
                None => return Ok(()),
                Some(What::Window(window)) => open.extend(self.look(&window, &progress.part(0.0))?),
                Some(What::Found(place)) => {
                    if self.take(*place) {
                        return Ok(());
                    }
                }
            }
        }
    }

    /// Finds the places with the largest values.
    fn largest(&mut self, parts: &[(f64, Window)], progress: &Progress) -> Result<()> {
        let candidates = (self.count * CANDIDATES[0]).max(CANDIDATES[1]);
        let mut open = Vec::new();
        for (_, part) in parts {
            progress.check()?;
            open.extend(self.look(part, &progress.part(1.0))?);
            open.sort_by(|a: &Open, b: &Open| b.cmp(a));
            let is_window = |open: &Open| matches!(open.what, What::Window(_));
            if open.first().is_some_and(is_window) {
                open.truncate(candidates);
            }
        }
        let mut found = Vec::new();
        for next in open {
            match next.what {
                What::Window(window) => found.extend(self.look(&window, &progress.part(0.0))?),
                What::Found(_) => found.push(next),
            }
        }
        found.sort_by(|a, b| b.cmp(a));
        for next in found {
            if let What::Found(place) = next.what
                && self.take(*place)
            {
                break;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_engine::presets;
    use orogen_engine::world::HEIGHT;
    use orogen_io::format::features::Value;

    fn job(given: &[(&str, &str)]) -> LocateJob {
        LocateJob::new(&Options::of(OPTIONS, given.iter().copied()).unwrap()).unwrap()
    }

    fn world(name: &str, job: &LocateJob) -> World {
        let mut recipe = presets::find(name).unwrap().recipe().unwrap();
        job.prepare(&mut recipe).unwrap();
        World::open(recipe).unwrap()
    }

    fn value(place: &Match, name: &str) -> f64 {
        match place.values.iter().find(|(own, ..)| own == name) {
            Some((_, Value::Real(value), _)) => *value,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_nearest_ground_is_found_as_in_the_whole_picture() {
        let near = [2000.0, 3100.0];
        let job = job(&[("where", "height > 220"), ("near", "2000,-3100"), ("count", "3"), ("apart", "500")]);
        let world = world("classic", &job);
        let found = job.run(&world, &Progress::none()).unwrap();
        let window = world.full_window(10.0).unwrap();
        let heights = world.window(HEIGHT, &window).unwrap();
        let mut high: Vec<(f64, [f64; 2])> = (0..window.len())
            .filter(|k| heights.data()[*k] > 220.0)
            .map(|k| [window.east(k % window.width), window.south(k / window.width)])
            .map(|at| (libm::hypot(at[0] - near[0], at[1] - near[1]), at))
            .collect();
        high.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!((found.places.len(), found.cell, found.own_cell), (3, 10.0, 10.0));
        assert_eq!(found.places[0].at, high[0].1);
        assert_eq!(found.places[0].coordinates, [high[0].1[0], -high[0].1[1]]);
        assert!(found.places.is_sorted_by(|a, b| a.distance <= b.distance));
        for (nth, place) in found.places.iter().enumerate() {
            let [x, y] = place.at.map(|at| (at / 10.0) as usize);
            assert_eq!(value(place, "height"), f64::from(heights[(x, y)]));
            assert!(
                found.places[..nth]
                    .iter()
                    .all(|other| { libm::hypot(place.at[0] - other.at[0], place.at[1] - other.at[1]) >= 500.0 })
            );
        }
    }

    #[test]
    fn a_coarse_search_finds_ground_at_the_own_cell() {
        let mut job = job(&[("where", "height > 1500 and slope < 20"), ("within", "20000")]);
        let world = world("endless", &job);
        let own = world.recipe().world.cell;
        job.cell = Some(own * 8.0);
        let found = job.run(&world, &Progress::none()).unwrap();
        assert_eq!((found.cell, found.own_cell), (own * 8.0, own));
        let place = &found.places[0];
        assert_eq!(value(place, "height"), f64::from(world.height(place.at[0], place.at[1]).unwrap()));
        assert!(value(place, "height") > 1500.0 && value(place, "slope") < 20.0);
        assert!(place.at.iter().all(|at| at % own == 0.0));
        job.cell = Some(own);
        let exact = job.run(&world, &Progress::none()).unwrap();
        assert!(exact.places[0].distance <= place.distance);
        assert!(found.words().contains("smaller places may be missing"), "{}", found.words());
    }

    #[test]
    fn the_area_of_connected_ground_counts() {
        let wide = job(&[("where", "height > 0 and slope < 20"), ("area", "20000")]);
        let world = world("classic", &wide);
        let place = &wide.run(&world, &Progress::none()).unwrap().places[0];
        assert!(value(place, "area") >= 20_000.0);
        let any = job(&[("where", "height > 0 and slope < 20")]);
        assert!(any.run(&world, &Progress::none()).unwrap().places[0].distance <= place.distance);
        let too_wide = job(&[("where", "height > 240"), ("area", "1e9")]);
        let found = too_wide.run(&world, &Progress::none()).unwrap();
        assert!(found.places.is_empty() && found.words().starts_with("no place within"), "{}", found.words());
    }

    #[test]
    fn the_largest_value_and_the_highest_summit_are_one() {
        let top = job(&[("largest", "height")]);
        let world = world("classic", &top);
        let ground = top.run(&world, &Progress::none()).unwrap();
        let window = world.full_window(10.0).unwrap();
        let highest = world.window(HEIGHT, &window).unwrap().data().iter().copied().fold(f32::MIN, f32::max);
        assert_eq!(value(&ground.places[0], "height"), f64::from(highest));
        let summits = job(&[("find", "summits"), ("largest", "height"), ("where", "prominence > 50"), ("count", "2")]);
        let summits = summits.run(&world, &Progress::none()).unwrap();
        assert_eq!(summits.places[0].at, ground.places[0].at);
        assert!(value(&summits.places[1], "prominence") > 50.0);
    }

    #[test]
    fn objects_are_found_by_attributes() {
        let lakes = job(&[("find", "lakes"), ("where", "depth > 1"), ("count", "2")]);
        let found = lakes.run(&world("alpine", &lakes), &Progress::none()).unwrap();
        assert!(found.places.len() == 2 && found.places.iter().all(|lake| value(lake, "depth") > 1.0));
        let json: serde_json::Value = serde_json::from_str(&found.to_json()).unwrap();
        assert_eq!(json["places"][1]["values"]["depth"], value(&found.places[1], "depth"));
    }

    #[test]
    fn what_cannot_be_searched_is_a_sentence() {
        let refused = |given: &[(&str, &str)]| {
            LocateJob::new(&Options::of(OPTIONS, given.iter().copied())?).and_then(|job| {
                let mut recipe = presets::find("classic").unwrap().recipe()?;
                job.prepare(&mut recipe)?;
                job.run(&World::open(recipe)?, &Progress::none()).map(|_| ())
            })
        };
        for (given, why) in [
            (&[("where", "hieght > 3")][..], "did you mean `height`?"),
            (&[("where", "normal > 3")], "several values"),
            (&[("where", "height = high")], "are numbers"),
            (&[("where", "height")], "a condition is a name"),
            (&[("find", "lakes"), ("where", "aera > 3")], "did you mean `area`?"),
            (&[("find", "lakes"), ("largest", "size")], "--largest"),
            (&[("find", "lakes"), ("area", "3")], "use a condition"),
            (&[("lake-area", "3")], "it applies to objects"),
            (&[("find", "caves")], "caves"),
        ] {
            let message = refused(given).unwrap_err().to_string();
            assert!(message.contains(why), "{given:?}: {message}");
        }
        let stopped = Progress::none();
        stopped.cancel();
        let job = job(&[]);
        assert_eq!(job.run(&world("classic", &job), &stopped).unwrap_err().kind(), ErrorKind::Cancelled);
    }
}
