//! Reads lines and areas from GeoJSON (RFC 7946).
//!
//! A file can be a geometry, a feature, or a collection of either. Coordinate systems are skipped, and points and
//! properties other than heights, which only ridges have. y points north in GeoJSON, so it is negated. The third
//! coordinate is the height.

use std::cell::Cell;
use std::fmt;
use std::marker::PhantomData;

use orogen_grid::polylines::outline::Outline;
use serde::de::{self, Deserialize, DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::outlines::{Collector, DrawingKind, MAX_POINTS, height_rank};

/// Maximum number of objects, lists and positions in a file.
const MAX_ITEMS: usize = 2 * MAX_POINTS;

/// Reads a GeoJSON text into `collector`.
pub fn read(text: &str, collector: &mut Collector) -> Result<(), String> {
    let left = Cell::new(MAX_ITEMS);
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let object = Seed::<ObjectVisitor> { left: &left, kind: PhantomData }.deserialize(&mut deserializer);
    let object = object.and_then(|object| deserializer.end().map(|()| object));
    let object = object.map_err(|cause| format!("it is not valid GeoJSON ({cause})"))?;
    if object.kind.is_none() {
        return Err("it is not GeoJSON: its `type` is missing".into());
    }
    geometry(&object, collector)
}

/// Recursion is bounded, because the parser rejects deep nesting.
fn geometry(object: &Object, collector: &mut Collector) -> Result<(), String> {
    use DrawingKind::{Areas, Lines, Ridges};
    if let Some((_, height)) = object.height {
        collector.height = Some(height);
    }
    for inner in object.geometry.as_deref().into_iter().chain(&object.objects) {
        geometry(inner, collector)?;
    }
    if object.kind.as_deref() == Some("Feature") {
        collector.height = None;
    }
    let Some(kind) = object.kind.as_deref() else { return Ok(()) };
    let (depth, kinds) = match kind {
        "LineString" => (1, [Lines]),
        "MultiLineString" => (2, [Lines]),
        "Polygon" => (2, [Areas]),
        "MultiPolygon" => (3, [Areas]),
        "Point" | "MultiPoint" if collector.kind() == Ridges => {
            let Some(coordinates) = &object.coordinates else { return Err(format!("a {kind} has no coordinates")) };
            return collector.take(&[Ridges], points(coordinates).map_err(|why| format!("a {kind}: {why}"))?);
        }
        _ => return Ok(()),
    };
    let Some(coordinates) = &object.coordinates else { return Err(format!("a {kind} has no coordinates")) };
    let mut outlines = Vec::new();
    lines(coordinates, depth, &mut outlines).map_err(|why| format!("a {kind}: {why}"))?;
    collector.take(&kinds, outlines)
}

/// The points in lists.
fn points(coordinates: &Coordinates) -> Result<Vec<Outline>, String> {
    match coordinates {
        Coordinates::Position([x, y, z]) => Ok(vec![Outline::of_points(&[[*x, -y, *z]])]),
        Coordinates::List(items) => Ok(items.iter().map(points).collect::<Result<Vec<_>, _>>()?.concat()),
    }
}

/// The lines in nested lists. At depth 1 the list consists of positions.
fn lines(coordinates: &Coordinates, depth: usize, outlines: &mut Vec<Outline>) -> Result<(), String> {
    let Coordinates::List(items) = coordinates else {
        return Err("its coordinates are not nested as this type has them".into());
    };
    if depth > 1 {
        return items.iter().try_for_each(|item| lines(item, depth - 1, outlines));
    }
    let points = items.iter().map(|item| match item {
        Coordinates::Position([x, y, z]) => Ok([*x, -y, *z]),
        Coordinates::List(_) => Err("a position is not a list of two or three numbers"),
    });
    let points: Vec<[f64; 3]> = points.collect::<Result<_, _>>()?;
    if !points.is_empty() {
        outlines.push(Outline::of_points(&points));
    }
    Ok(())
}

/// The members of an object that are read.
#[derive(Default)]
struct Object {
    kind: Option<String>,
    coordinates: Option<Coordinates>,
    geometry: Option<Box<Object>>,
    /// Features or geometries.
    objects: Vec<Object>,
    /// The height among the properties, and its rank.
    height: Option<(usize, f64)>,
}

enum Coordinates {
    Position([f64; 3]),
    List(Vec<Coordinates>),
}

/// Deserializes values of kind `K`, and counts the items that it creates.
struct Seed<'a, K> {
    left: &'a Cell<usize>,
    kind: PhantomData<K>,
}

impl<K: Copy> Seed<'_, K> {
    fn of<L>(&self, _: L) -> Seed<'_, L> {
        Seed { left: self.left, kind: PhantomData }
    }

    fn count<E: de::Error>(&self) -> Result<(), E> {
        match self.left.get().checked_sub(1) {
            Some(left) => {
                self.left.set(left);
                Ok(())
            }
            None => Err(E::custom(format!("it has more than {MAX_ITEMS} positions and objects"))),
        }
    }
}

#[derive(Clone, Copy)]
struct ObjectVisitor;

/// An object or null.
#[derive(Clone, Copy)]
struct OptionalObject;

#[derive(Clone, Copy)]
struct ObjectList;

/// The properties of a feature, of which only the height is read.
#[derive(Clone, Copy)]
struct Properties;

#[derive(Clone, Copy)]
struct CoordinatesVisitor;

/// An item in a list of coordinates.
enum Item {
    Number(f64),
    Coordinates(Coordinates),
}

#[derive(Clone, Copy)]
struct ItemVisitor;

impl<'de> DeserializeSeed<'de> for Seed<'_, ObjectVisitor> {
    type Value = Object;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Object, D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_, ObjectVisitor> {
    type Value = Object;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object of GeoJSON")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Object, A::Error> {
        self.count()?;
        let mut object = Object::default();
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "type" => object.kind = Some(map.next_value()?),
                "coordinates" => object.coordinates = Some(map.next_value_seed(self.of(CoordinatesVisitor))?),
                "geometry" => object.geometry = map.next_value_seed(self.of(OptionalObject))?.map(Box::new),
                "features" | "geometries" => object.objects = map.next_value_seed(self.of(ObjectList))?,
                "properties" => object.height = map.next_value_seed(self.of(Properties))?,
                _ => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
        }
        Ok(object)
    }
}

impl<'de> DeserializeSeed<'de> for Seed<'_, OptionalObject> {
    type Value = Option<Object>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Option<Object>, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_, OptionalObject> {
    type Value = Option<Object>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a geometry or null")
    }

    fn visit_unit<E: de::Error>(self) -> Result<Option<Object>, E> {
        Ok(None)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Option<Object>, A::Error> {
        self.of(ObjectVisitor).visit_map(map).map(Some)
    }
}

impl<'de> DeserializeSeed<'de> for Seed<'_, Properties> {
    type Value = Option<(usize, f64)>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        // Properties of any form are skipped.
        let read = serde_json::Value::deserialize(deserializer)?;
        let serde_json::Value::Object(read) = read else { return Ok(None) };
        let number = |value: &serde_json::Value| value.as_f64().or_else(|| value.as_str()?.trim().parse().ok());
        let heights = read.iter().filter_map(|(name, value)| Some((height_rank(name)?, number(value)?)));
        Ok(heights.filter(|(_, height)| height.is_finite()).min_by_key(|(rank, _)| *rank))
    }
}

impl<'de> DeserializeSeed<'de> for Seed<'_, ObjectList> {
    type Value = Vec<Object>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Vec<Object>, D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_, ObjectList> {
    type Value = Vec<Object>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list of objects")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Vec<Object>, A::Error> {
        let mut objects = Vec::new();
        while let Some(object) = items.next_element_seed(self.of(ObjectVisitor))? {
            objects.push(object);
        }
        Ok(objects)
    }
}

impl<'de> DeserializeSeed<'de> for Seed<'_, CoordinatesVisitor> {
    type Value = Coordinates;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Coordinates, D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_, CoordinatesVisitor> {
    type Value = Coordinates;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list of coordinates")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Coordinates, A::Error> {
        self.count()?;
        let (mut numbers, mut lists) = ([0.0; 3], Vec::new());
        let mut count = 0;
        while let Some(item) = items.next_element_seed(self.of(ItemVisitor))? {
            match item {
                Item::Coordinates(inner) if count == 0 => lists.push(inner),
                // More than three numbers are allowed; the others are ignored.
                Item::Number(number) if lists.is_empty() => {
                    if let Some(place) = numbers.get_mut(count) {
                        *place = number;
                    }
                    count += 1;
                }
                _ => return Err(de::Error::custom("a list has both numbers and lists")),
            }
        }
        match count {
            0 => Ok(Coordinates::List(lists)),
            1 => Err(de::Error::custom("a position has only one number")),
            _ => Ok(Coordinates::Position(numbers)),
        }
    }
}

impl<'de> DeserializeSeed<'de> for Seed<'_, ItemVisitor> {
    type Value = Item;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Item, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_, ItemVisitor> {
    type Value = Item;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or a list of coordinates")
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<Item, E> {
        Ok(Item::Number(number as f64))
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<Item, E> {
        Ok(Item::Number(number as f64))
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<Item, E> {
        Ok(Item::Number(number))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, items: A) -> Result<Item, A::Error> {
        self.of(CoordinatesVisitor).visit_seq(items).map(Item::Coordinates)
    }
}
