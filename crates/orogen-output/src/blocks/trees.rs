//! Trees: one candidate position in each square of columns, from hashes of positions.

use super::hash::{hash, share};
use super::kind::Block;
use super::land::Land;
use super::levels::Levels;
use super::reach::{CROWN, SOIL_REACH};
use super::solid::Solid;
use orogen_grid::grid::Window;

/// Columns along a side of the square in which a tree may stand.
const SQUARE: i64 = 5;

/// Side of the part of a square in which trees stand, in columns; it keeps neighboring trees apart.
const INNER: u64 = 4;

/// A tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tree {
    at: [i64; 2],
    /// The level of its lowest block.
    foot: i32,
    is_conifer: bool,
    number: u64,
}

/// The trees whose crowns may reach into a part of the window of a land, from north-west to south-east.
pub(super) fn around(land: &Land, part: &Window) -> Vec<Tree> {
    if !land.has_trees {
        return Vec::new();
    }
    let squares = |from: i64, length: usize| {
        (from - CROWN).div_euclid(SQUARE)..=(from + length as i64 - 1 + CROWN).div_euclid(SQUARE)
    };
    let mut trees = Vec::new();
    for square_y in squares(part.y, part.height) {
        for square_x in squares(part.x, part.width) {
            let number = hash(land.seed ^ 0x7E, [square_x, square_y, 0]);
            let at = [square_x * SQUARE + (number % INNER) as i64, square_y * SQUARE + (number / INNER % INNER) as i64];
            let is_near =
                |at: i64, from: i64, length: usize| (from - CROWN..from + length as i64 + CROWN).contains(&at);
            if !is_near(at[0], part.x, part.width) || !is_near(at[1], part.y, part.height) {
                continue;
            }
            let cover = land.column(at[0], at[1]).and_then(|column| column.cover.trees());
            let Some((_, is_conifer)) = cover.filter(|(part, _)| share(hash(number, [1, 0, 0])) < *part) else {
                continue;
            };
            if let Some(foot) = stand(land, at) {
                trees.push(Tree { at, foot, is_conifer, number });
            }
        }
    }
    trees
}

/// The highest level near the ground of a column on which a tree can stand; `None` if its surface is in water.
fn stand(land: &Land, at: [i64; 2]) -> Option<i32> {
    let column = land.column(at[0], at[1]).filter(|column| column.height.is_finite())?;
    let cell = land.window.cell;
    let mut solid = Solid::default();
    solid.begin(land, column, at);
    let ground = column.ground(cell);
    let level = (ground - SOIL_REACH..=ground + SOIL_REACH).rev().find(|level| solid.at(*level))?;
    (Levels::middle(level + 1, cell) >= f64::from(column.water)).then_some(level + 1)
}

impl Tree {
    /// Calls a function for each of its blocks: crown, then trunk.
    pub(super) fn each(&self, mut visit: impl FnMut([i64; 2], i32, Block)) {
        let [x, y] = self.at;
        let (trunk, leaf) = match self.is_conifer {
            true => (5 + (self.number >> 32 & 3) as i32, Block::Needles),
            false => (4 + ((self.number >> 32) % 3) as i32, Block::Leaves),
        };
        let top = self.foot + trunk;
        // The radius of each level of the crown, from the top.
        let crown: &[i64] = match self.is_conifer {
            true => &[0, 1, 1, 2, 1, 2],
            false => &[1, 1, 2, 2],
        };
        for (below, radius) in (0..).zip(crown) {
            let level = top - below;
            for south in -radius..=*radius {
                for east in -radius..=*radius {
                    let is_corner = *radius > 0 && south.abs() == *radius && east.abs() == *radius;
                    let thins =
                        self.is_conifer || below == 0 || hash(self.number, [east, south, i64::from(below)]) & 1 == 0;
                    if !(is_corner && thins) {
                        visit([x + east, y + south], level, leaf);
                    }
                }
            }
        }
        (self.foot..top).for_each(|level| visit(self.at, level, Block::Log));
    }
}
