//! Reroutes: points in the graph through which a wire runs.

use std::collections::HashMap;

use orogen::recipe::Recipe;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value as Json;

use super::groups;
use super::reader::{Reader, read_by};

/// Maximum number of points of a wire; further ones are ignored.
pub const MAX_POINTS: usize = 64;

/// Maximum offset of a point in points of the graph.
pub const MAX_OFFSET: f64 = 10_000.0;

/// A wire of the graph, and the points through which it runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub struct Reroute {
    /// The node that is read.
    pub from: String,
    /// What reads it.
    pub reader: Reader,
    /// The group whose graph shows the points; empty for the whole recipe.
    pub group: String,
    /// The points in their order along the wire: the share of the way from the start of the wire to its end, and the
    /// offset from there to the right and down, in points of a graph at normal size.
    pub points: Vec<[f64; 3]>,
}

/// Its form in the recipe. Absent texts are empty.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default)]
struct Written {
    from: String,
    #[serde(skip_serializing_if = "String::is_empty")]
    node: String,
    #[serde(skip_serializing_if = "String::is_empty")]
    input: String,
    #[serde(skip_serializing_if = "String::is_empty")]
    output: String,
    #[serde(skip_serializing_if = "String::is_empty")]
    group: String,
    points: Vec<[f64; 3]>,
}

impl From<Reroute> for Written {
    fn from(reroute: Reroute) -> Written {
        let Reroute { from, reader, group, points } = reroute;
        let written = Written { from, group, points, ..Written::default() };
        match reader {
            Reader::Input { node, key } => Written { node, input: key, ..written },
            Reader::Output(output) => Written { output, ..written },
        }
    }
}

impl TryFrom<Written> for Reroute {
    type Error = &'static str;

    fn try_from(written: Written) -> Result<Reroute, &'static str> {
        let Written { from, node, input, output, group, mut points } = written;
        let reader = match (node.is_empty(), input.is_empty(), output.is_empty()) {
            (false, false, true) => Reader::Input { node, key: input },
            (true, true, false) => Reader::Output(output),
            _ => return Err("the end of a wire is an input of a node, or an output"),
        };
        let is_good = |[share, right, down]: &[f64; 3]| {
            (0.0..=1.0).contains(share) && right.abs() <= MAX_OFFSET && down.abs() <= MAX_OFFSET
        };
        points.retain(is_good);
        points.truncate(MAX_POINTS);
        match points.is_empty() {
            true => Err("a wire without points needs no entry"),
            false => Ok(Reroute { from, reader, group, points }),
        }
    }
}

/// Reads a list of reroutes; entries that are none are left out.
pub(super) fn lenient<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Reroute>, D::Error> {
    let all = match Json::deserialize(deserializer)? {
        Json::Array(all) => all,
        _ => Vec::new(),
    };
    Ok(all.into_iter().filter_map(|one| serde_json::from_value(one).ok()).collect())
}

impl Reroute {
    /// Whether it is of the same wire, in the graph of the same group.
    #[must_use]
    pub fn is_same_wire(&self, other: &Reroute) -> bool {
        self.from == other.from && self.reader == other.reader && self.group == other.group
    }

    /// The end of the wire, as text.
    #[must_use]
    pub fn end(&self) -> String {
        match &self.reader {
            Reader::Input { node, key } => format!("{node}.{key}"),
            Reader::Output(name) => name.clone(),
        }
    }

    /// The names of the nodes at its ends.
    fn nodes(&self) -> impl Iterator<Item = &str> {
        let node = match &self.reader {
            Reader::Input { node, .. } => Some(node.as_str()),
            Reader::Output(_) => None,
        };
        [Some(self.from.as_str()), node].into_iter().flatten()
    }

    /// The group in whose graph both ends of the wire are.
    fn common(&self) -> &str {
        match &self.reader {
            Reader::Input { .. } => groups::common(self.nodes()),
            Reader::Output(_) => "",
        }
    }

    /// Whether a recipe has the wire.
    fn is_in(&self, recipe: &Recipe) -> bool {
        let is_read = read_by(recipe, &self.reader).is_some_and(|read| read.split('.').next() == Some(&self.from));
        let is_inside = |name: &str| groups::rest(name, &self.group).is_some();
        is_read && (self.group == self.common() || self.nodes().filter(|name| is_inside(name)).count() == 1)
    }

    /// It with other names of nodes; `None` if the graph of its group has no such wire any more.
    fn with_names<'a>(&self, new: impl Fn(&str) -> Option<&'a str>) -> Option<Reroute> {
        let named = |name: &String| new(name).map_or_else(|| name.clone(), str::to_owned);
        let reader = match &self.reader {
            Reader::Input { node, key } => Reader::Input { node: named(node), key: key.clone() },
            Reader::Output(name) => Reader::Output(name.clone()),
        };
        let mut renamed = Reroute { from: named(&self.from), reader, ..self.clone() };
        if self.group == self.common() {
            renamed.group = renamed.common().to_owned();
            return Some(renamed);
        }
        // Only one end is in the group.
        let (old, new) = self.nodes().zip(renamed.nodes()).find(|(old, _)| groups::rest(old, &self.group).is_some())?;
        if groups::rest(new, &self.group).is_none() {
            // The group has another name.
            let rest = groups::rest(old, &self.group)?;
            renamed.group = new.strip_suffix(rest)?.strip_suffix('/')?.to_owned();
        }
        Some(renamed)
    }

    /// It after nodes were renamed; `None` if the recipe has no such wire.
    #[must_use]
    pub fn after(&self, renames: &[(String, String)], recipe: &Recipe) -> Option<Reroute> {
        let new = |name: &str| renames.iter().find(|(from, _)| from == name).map(|(_, to)| to.as_str());
        let renamed = match renames.is_empty() {
            true => self.clone(),
            false => self.with_names(new)?,
        };
        Some(renamed).filter(|renamed| renamed.is_in(recipe))
    }

    /// It for the copy of the node that reads; `None` if that is not copied.
    pub(super) fn copied(&self, copies: &HashMap<&str, String>) -> Option<Reroute> {
        match &self.reader {
            Reader::Input { node, .. } if copies.contains_key(node.as_str()) => {
                self.with_names(|name| copies.get(name).map(String::as_str))
            }
            _ => None,
        }
    }
}

/// The reroutes with those of a wire replaced; none of it if there are no points.
#[must_use]
pub(super) fn with(mut all: Vec<Reroute>, new: &Reroute) -> Vec<Reroute> {
    let at = all.iter().position(|known| known.is_same_wire(new)).unwrap_or(all.len());
    all.retain(|known| !known.is_same_wire(new));
    if !new.points.is_empty() {
        all.insert(at.min(all.len()), new.clone());
    }
    all
}

#[cfg(test)]
mod tests;
