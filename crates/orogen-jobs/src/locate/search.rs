//! The parts of a world in the order of their distance from a position.

use orogen_engine::world::World;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::words::number;

/// Number of samples along the side of a part.
pub(super) const SIDE: usize = 256;

/// Maximum number of parts.
const MOST: f64 = 1e6;

/// Maximum number of samples of a search whose cell is not given.
const SAMPLES: f64 = 4e6;

/// The searched area: a disc, within the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    /// The position that the distance is measured from, in metres east and south of the world's origin.
    pub near: [f64; 2],
    /// The radius, in metres.
    pub within: f64,
}

impl Area {
    /// The distance of a position.
    pub(super) fn distance(&self, [east, south]: [f64; 2]) -> f64 {
        libm::hypot(east - self.near[0], south - self.near[1])
    }

    /// The distance of the nearest sample of a window, or less.
    pub(super) fn distance_of(&self, window: &Window) -> f64 {
        let outside = |near: f64, first: i64, last: i64| {
            let [least, greatest] = [first, last - 1].map(|at| at as f64 * window.cell);
            (least - near).max(near - greatest).max(0.0)
        };
        let east = outside(self.near[0], window.x, window.right());
        libm::hypot(east, outside(self.near[1], window.y, window.bottom()))
    }

    /// The square around the disc that is within the world, in metres: west, north, east, south.
    fn sides(&self, world: &World) -> [f64; 4] {
        let [x, y] = self.near;
        let own = [x - self.within, y - self.within, x + self.within, y + self.within];
        match world.recipe().world.size {
            Some([width, height]) => [own[0].max(0.0), own[1].max(0.0), own[2].min(width), own[3].min(height)],
            None => own,
        }
    }

    /// The smallest cell at which the area has few enough samples: the world's, or that times a power of two.
    pub(super) fn cell(&self, world: &World) -> f64 {
        let [west, north, east, south] = self.sides(world);
        let mut cell = world.recipe().world.cell;
        while (east - west).max(0.0) * (south - north).max(0.0) > SAMPLES * cell * cell {
            cell *= 2.0;
        }
        cell
    }

    /// The parts of the world in the area, with samples of this cell, in the order of their distance. They are the same
    /// for every area.
    ///
    /// # Errors
    /// If there are too many.
    pub(super) fn parts(&self, world: &World, cell: f64) -> Result<Vec<(f64, Window)>> {
        let length = SIDE as f64 * cell;
        let [west, north, east, south] = self.sides(world).map(|side| (side / length).floor());
        if (east - west + 1.0) * (south - north + 1.0) > MOST {
            let message = format!(
                "with samples of {} m, {} m around the place are too many to search; use a larger --cell, or a smaller --within",
                number(cell),
                number(self.within)
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        let whole = world.recipe().world.size.map(|_| world.full_window(cell)).transpose()?;
        let mut parts = Vec::new();
        for row in north as i64..=south as i64 {
            for column in west as i64..=east as i64 {
                let part = Window::new(SIDE, SIDE, cell).at(column * SIDE as i64, row * SIDE as i64);
                let part = whole.map_or(part, |whole| part.intersection(&whole));
                if !part.is_empty() && self.distance_of(&part) <= self.within {
                    parts.push((self.distance_of(&part), part));
                }
            }
        }
        // Equal distances keep the order of rows.
        parts.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_engine::presets;

    fn world(name: &str) -> World {
        World::open(presets::find(name).unwrap().recipe().unwrap()).unwrap()
    }

    #[test]
    fn the_nearest_parts_are_first_and_all_parts_are_there() {
        let world = world("endless");
        let area = Area { near: [1000.0, -500.0], within: 20_000.0 };
        let parts = area.parts(&world, 8.0).unwrap();
        assert!(parts.is_sorted_by(|a, b| a.0 <= b.0) && parts[0].0 == 0.0);
        let samples = [[1000.0, -500.0], [20_900.0, -500.0], [1000.0, 19_400.0]].map(|at| at.map(|at: f64| at / 8.0));
        for [x, y] in samples {
            let has = |part: &Window| {
                (part.x..part.right()).contains(&(x as i64)) && (part.y..part.bottom()).contains(&(y.floor() as i64))
            };
            assert_eq!(parts.iter().filter(|(_, part)| has(part)).count(), 1);
        }
        assert!(area.parts(&world, 0.001).unwrap_err().to_string().contains("larger --cell"));
    }

    #[test]
    fn the_cell_follows_the_area_and_the_world() {
        let endless = world("endless");
        let own = endless.recipe().world.cell;
        let cell = |within: f64| Area { near: [0.0; 2], within }.cell(&endless);
        assert_eq!(cell(own * 900.0), own);
        assert!(cell(1e6) > cell(1e5) && libm::log2(cell(1e6) / own).fract() == 0.0);
        let classic = world("classic");
        let area = Area { near: [0.0; 2], within: 1e9 };
        assert_eq!(area.cell(&classic), classic.recipe().world.cell);
        let parts = area.parts(&classic, 10.0).unwrap();
        assert_eq!(parts.iter().map(|(_, part)| part.len()).sum::<usize>(), classic.full_window(10.0).unwrap().len());
    }
}
