//! The positions of the boxes of the graph while the recipe changes: known boxes keep their positions, new ones get a
//! free one.

use std::collections::HashSet;

use eframe::egui::{Pos2, Vec2, pos2};

use super::graph_box::{self, WIDTH};
use super::graph_panel::Graph;
use crate::editing::groups;
use crate::studio::Studio;
use crate::view::arrangement::{self, Area};
use crate::view::scene::{End, GraphBox, Kind, Scene};

/// Maximum number of positions that are kept.
const KEPT: usize = 10_000;

const GAP: f32 = 62.0;

impl Graph {
    /// The key under which the position of a box is kept.
    pub(super) fn key(&self, block: &GraphBox) -> String {
        match block.kind {
            Kind::Outside => format!("{}{}", self.group, block.id),
            _ => block.id.clone(),
        }
    }

    pub(super) fn place_of(&self, block: &GraphBox) -> Option<Pos2> {
        self.places.get(&self.key(block)).copied()
    }

    /// Updates the scene to the current text, with a position for each box.
    pub(super) fn update(&mut self, studio: &Studio) {
        let recipe = studio.document.recipe();
        if !self.group.is_empty() && !groups::is_group(recipe, &self.group) {
            // The shown group no longer exists, or has another name: that of the selected node's group.
            let selected = studio.selected.first().map_or("", |name| groups::group_of(name));
            let is_renamed = selected.matches('/').count() == self.group.matches('/').count();
            let other = if is_renamed { selected } else { groups::group_of(&self.group) }.to_owned();
            self.enter(&other);
            while !self.group.is_empty() && !groups::is_group(recipe, &self.group) {
                self.group = groups::group_of(&self.group).to_owned();
            }
        }
        let now = (studio.document.revision(), self.group.clone(), studio.has_thumbnails);
        if self.placed.as_ref() == Some(&now) {
            return;
        }
        self.placed = Some(now);
        if self.places.len() > KEPT {
            self.places.clear();
        }
        let before: HashSet<String> = self.scene.boxes.iter().map(|block| self.key(block)).collect();
        self.scene = Scene::of(recipe, &self.group);
        let has_pictures = studio.has_thumbnails;
        let has_own = self.scene.boxes.iter().any(|block| self.place_of(block).is_some());
        let found: Vec<Option<Pos2>> =
            self.scene.boxes.iter().map(|block| self.place_of(block).or_else(|| self.former(block))).collect();
        if found.iter().flatten().count() * 2 < found.len() || !has_own {
            self.tidy(has_pictures);
            self.wants_whole = true;
            return;
        }
        // A graph that is shown whole stays so.
        self.wants_whole |= self.is_whole() && found.iter().any(Option::is_none);
        let mut taken: Vec<Area> = Vec::new();
        let is_old: Vec<bool> = self.scene.boxes.iter().map(|block| before.contains(&self.key(block))).collect();
        // Boxes that existed before keep their positions; others get a free one.
        for is_first in [true, false] {
            for (at, place) in found.iter().enumerate() {
                let is_behind = self.is_behind(at, &found);
                let keeps = is_old.get(at) == Some(&true) && place.is_some() && !is_behind;
                let Some(block) = self.scene.boxes.get(at).filter(|_| keeps == is_first) else { continue };
                let size: [f32; 2] = graph_box::size(block, has_pictures).into();
                // What an output reads has its place by now.
                let wanted = place.filter(|_| !is_behind).unwrap_or_else(|| self.wanted(at));
                let wanted: [f32; 2] = wanted.into();
                let place = if keeps { wanted } else { arrangement::free(wanted, size, &taken) };
                taken.push((place, size));
                self.places.insert(self.key(block), place.into());
            }
        }
    }

    /// The position of a box before it was grouped or ungrouped: a node next to its group, a group at the center of its
    /// nodes.
    fn former(&self, block: &GraphBox) -> Option<Pos2> {
        let outer = groups::group_of(block.id.trim_end_matches('/'));
        match block.kind {
            Kind::Node(_) if !outer.is_empty() => {
                self.places.get(&groups::within(groups::group_of(outer), groups::own_name(&block.id))).copied()
            }
            Kind::Group => {
                let group = block.group_name()?;
                let near = |name: &String| self.places.get(&groups::within(outer, groups::rest(name, group)?));
                let all: Vec<Pos2> = block.nodes.iter().filter_map(near).copied().collect();
                let sum = all.iter().fold(Vec2::ZERO, |sum, place| sum + place.to_vec2());
                (!all.is_empty()).then(|| (sum / all.len() as f32).to_pos2())
            }
            _ => None,
        }
    }

    /// Whether a box is an output that has to make way: what it reads is new, or is not to its left.
    fn is_behind(&self, at: usize, places: &[Option<Pos2>]) -> bool {
        let place = |at: usize| places.get(at).copied().flatten();
        let is_output = self.scene.boxes.get(at).is_some_and(|block| block.kind == Kind::Output);
        let mut sources = self.scene.wires.iter().filter(|wire| wire.to == at).map(|wire| place(wire.from));
        is_output && sources.any(|source| source.zip(place(at)).is_none_or(|(source, own)| source.x + WIDTH > own.x))
    }

    /// The wanted position of a new box: next to the boxes that it reads, or in the visible part.
    fn wanted(&self, at: usize) -> Pos2 {
        let sources =
            self.scene.wires.iter().filter(|wire| wire.to == at).filter_map(|wire| self.scene.boxes.get(wire.from));
        let sources: Vec<Pos2> = sources.filter_map(|block| self.place_of(block)).collect();
        let right = sources.iter().map(|place| place.x).fold(f32::NEG_INFINITY, f32::max);
        match sources.first() {
            Some(first) => pos2(right + WIDTH + GAP, first.y),
            None => self.to_graph(pos2(60.0, 60.0)),
        }
    }

    /// Arranges all boxes in an automatic layout.
    pub(super) fn tidy(&mut self, has_pictures: bool) {
        let boxes = &self.scene.boxes;
        let sizes: Vec<[f32; 2]> = boxes.iter().map(|block| graph_box::size(block, has_pictures).into()).collect();
        let outlet = |block: usize, k: usize| boxes.get(block).map_or(0.0, |block| graph_box::outlet(block, k));
        let port = |block: usize, end: End| match (boxes.get(block), end) {
            (Some(block), End::Port(k)) => graph_box::port(block, k),
            _ => 0.0,
        };
        let places = arrangement::tidy(&self.scene, &sizes, outlet, port);
        let keys: Vec<String> = boxes.iter().map(|block| self.key(block)).collect();
        self.places.extend(keys.into_iter().zip(places.into_iter().map(Pos2::from)));
    }
}
