//! Groups of nodes. A node is in a group if its name begins with the name of the group: `hills/noise` is in `hills`,
//! and `hills/rocks/noise` is in the group `rocks` within `hills`. The nodes of a recipe that `[use.NAME]` includes
//! also form such a group.

use std::collections::HashSet;

use orogen::recipe::Recipe;

use super::names;

/// The group that contains a node or a group; empty at the top level.
#[must_use]
pub fn group_of(name: &str) -> &str {
    name.rsplit_once('/').map_or("", |(group, _)| group)
}

/// A name without its group.
#[must_use]
pub fn own_name(name: &str) -> &str {
    name.rsplit_once('/').map_or(name, |(_, own)| own)
}

/// The full name of `name` in a group.
#[must_use]
pub fn within(group: &str, name: &str) -> String {
    if group.is_empty() { name.to_owned() } else { format!("{group}/{name}") }
}

/// The part of a name after the name of a group; `None` if it is not in the group. The empty group contains everything.
#[must_use]
pub fn rest<'a>(name: &'a str, group: &str) -> Option<&'a str> {
    if group.is_empty() { Some(name) } else { name.strip_prefix(group)?.strip_prefix('/') }
}

/// The full name of the group directly within `group` that contains a node; `None` if the node is directly in `group`,
/// or outside.
#[must_use]
pub fn inner<'a>(name: &'a str, group: &str) -> Option<&'a str> {
    let rest = rest(name, group)?;
    let (first, _) = rest.split_once('/')?;
    name.get(..name.len() - rest.len() + first.len())
}

/// The nodes of a group, and of the groups within it.
#[must_use]
pub fn members(recipe: &Recipe, group: &str) -> Vec<String> {
    let names = recipe.nodes().iter().map(|named| &named.name);
    names.filter(|name| rest(name, group).is_some()).cloned().collect()
}

/// Whether a recipe has a group.
#[must_use]
pub fn is_group(recipe: &Recipe, group: &str) -> bool {
    !group.is_empty() && recipe.nodes().iter().any(|named| rest(&named.name, group).is_some())
}

/// The group whose nodes are exactly these; the outermost one, if groups contain nothing but another group.
#[must_use]
pub fn of_selection(recipe: &Recipe, selected: &[String]) -> Option<String> {
    let first = selected.first()?;
    let chosen: HashSet<&str> = selected.iter().map(String::as_str).collect();
    let ends = first.match_indices('/').map(|(at, _)| &first[..at]);
    let is_whole = |group: &&str| {
        let members = members(recipe, group);
        members.len() == chosen.len() && members.iter().all(|name| chosen.contains(name.as_str()))
    };
    ends.into_iter().find(is_whole).map(str::to_owned)
}

/// The innermost group that contains all of these nodes.
#[must_use]
pub fn common<'a>(mut names: impl Iterator<Item = &'a str>) -> &'a str {
    let mut common = names.next().map_or("", group_of);
    for name in names {
        while rest(name, common).is_none() {
            common = group_of(common);
        }
    }
    common
}

/// A name for a group within `group` that no node and no other group has.
#[must_use]
pub fn free(recipe: &Recipe, group: &str, name: &str) -> String {
    let nodes = || recipe.nodes().iter().map(|named| named.name.as_str());
    let taken: HashSet<&str> = nodes().filter_map(|name| inner(name, group)).chain(nodes()).collect();
    let taken = taken.into_iter().filter_map(|name| rest(name, group)).collect();
    within(group, &names::free(name, &taken))
}

/// The renames that put nodes into a group: old and new names.
#[must_use]
pub fn grouped(nodes: &[String], name: &str) -> Vec<(String, String)> {
    let outer = common(nodes.iter().map(String::as_str));
    let moved = |node: &String| Some((node.clone(), within(name, rest(node, outer)?)));
    nodes.iter().filter_map(moved).collect()
}

/// The renames that dissolve a group.
#[must_use]
pub fn ungrouped(recipe: &Recipe, group: &str) -> Vec<(String, String)> {
    let inside = members(recipe, group);
    let outer = group_of(group);
    // Existing names and groups outside are not changed.
    let others = recipe.nodes().iter().map(|named| named.name.as_str()).filter(|name| rest(name, group).is_none());
    let mut taken: HashSet<String> = HashSet::new();
    for name in others.filter_map(|name| rest(name, outer)) {
        taken.insert(name.split_once('/').map_or(name, |(first, _)| first).to_owned());
        taken.insert(name.to_owned());
    }
    let mut heads: Vec<(String, String)> = Vec::new();
    let mut all = Vec::new();
    for name in inside {
        let Some(own) = rest(&name, group) else { continue };
        let (head, tail) = own.split_once('/').map_or((own, None), |(head, tail)| (head, Some(tail)));
        // A node and a group with the same name are different.
        let head = format!("{head}{}", if tail.is_some() { "/" } else { "" });
        let known = heads.iter().find(|(known, _)| *known == head).map(|(_, to)| to.clone());
        let to = known.unwrap_or_else(|| {
            let to = names::free(head.trim_end_matches('/'), &taken.iter().map(String::as_str).collect());
            taken.insert(to.clone());
            heads.push((head, to.clone()));
            to
        });
        let to = within(outer, &tail.map_or(to.clone(), |tail| within(&to, tail)));
        all.push((name, to));
    }
    all
}

/// The renames that rename a group.
#[must_use]
pub fn renamed(recipe: &Recipe, from: &str, to: &str) -> Vec<(String, String)> {
    let moved = |name: String| {
        let new = within(to, rest(&name, from)?);
        Some((name, new))
    };
    members(recipe, from).into_iter().filter_map(moved).collect()
}

#[cfg(test)]
mod tests;
