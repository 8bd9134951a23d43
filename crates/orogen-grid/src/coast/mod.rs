//! Coasts that waves make: cliffs, shore platforms and beaches.
//!
//! Winds raise waves over their fetch. The power of the waves moves the shore into the land, as a front whose speed
//! depends on the rock and on what falls down; it leaves a cliff and a platform. Sand of cliffs and rivers moves along
//! the shore; it makes beaches, and spits, bars and tombolos in the water. All sums are in the order of cells, so the
//! result does not depend on threads.

mod beach;
mod climate;
mod course;
mod drift;
mod fetch;
mod inlets;
mod march;
mod nodes;
mod retreat;
mod ridges;
mod rock;
mod spits;
mod tombolos;
mod waves;

use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::hydrology::accumulation::accumulate_with;
use crate::hydrology::breach::breach_with;
use crate::hydrology::drainage::route_carving_with;
use crate::hydrology::outlets::Outlets;
use crate::hydrology::steepest::Descent;
use crate::progress::Progress;
use beach::{Sand, Section};
use climate::Climate;
use drift::Drift;
use nodes::Nodes;
use retreat::Shore;
use ridges::Ridges;
use rock::Profile;
use spits::Drifting;

/// Waves that work on a shore.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Coast {
    /// Height of the sea, in metres.
    pub sea_level: f64,
    /// Speed of strong winds, in m/s.
    pub wind_speed: f64,
    /// Direction that the main wind comes from, in degrees clockwise from north.
    pub wind_direction: f64,
    /// Share of the main wind; the others blow from all directions alike.
    pub wind_share: f64,
    /// Maximum fetch, also over the sea outside the window, in metres.
    pub fetch: f64,
    /// Duration, in years.
    pub years: f64,
    /// Retreat of an open, low coast at first, in m/yr.
    pub retreat: f64,
    /// Slope of cliffs, in degrees.
    pub cliff_angle: f64,
    /// Slope of shore platforms.
    pub platform_slope: f64,
    /// Share of sand in what cliffs and rivers bring.
    pub sand_share: f64,
    /// Mean denudation of the land, in mm/yr.
    pub denudation: f64,
    /// Size of grains of sand, in mm.
    pub grain_size: f64,
    /// Height of beaches above the sea, in metres.
    pub berm: f64,
    /// How far sand moves along the shore, in metres.
    pub reach: f64,
    /// Share of the sand which builds spits, bars and tombolos.
    pub spits: f64,
}

impl Default for Coast {
    /// The defaults of the op `coast`.
    fn default() -> Coast {
        Coast {
            sea_level: 0.0,
            wind_speed: 14.0,
            wind_direction: 270.0,
            wind_share: 0.5,
            fetch: 200e3,
            years: 6000.0,
            retreat: 0.1,
            cliff_angle: 60.0,
            platform_slope: 0.015,
            sand_share: 0.1,
            denudation: 0.05,
            grain_size: 0.3,
            berm: 2.0,
            reach: 2000.0,
            spits: 0.5,
        }
    }
}

orogen_noise::builder!(
    Coast:
    with_sea_level(sea_level: f64),
    with_wind_speed(wind_speed: f64),
    with_wind_direction(wind_direction: f64),
    with_wind_share(wind_share: f64),
    with_fetch(fetch: f64),
    with_years(years: f64),
    with_retreat(retreat: f64),
    with_cliff_angle(cliff_angle: f64),
    with_platform_slope(platform_slope: f64),
    with_sand_share(sand_share: f64),
    with_denudation(denudation: f64),
    with_grain_size(grain_size: f64),
    with_berm(berm: f64),
    with_reach(reach: f64),
    with_spits(spits: f64)
);

/// A coast after the waves.
#[derive(Debug, Clone, PartialEq)]
pub struct CoastLayers {
    /// Heights, in metres.
    pub height: Grid,
    /// Thickness of the sand of beaches, in metres.
    pub beach: Grid,
    /// Power of the waves over that of an open coast; 0 on land.
    pub exposure: Grid,
    /// What the sea has taken (negative) and laid down, in metres.
    pub change: Grid,
    /// The volumes of sand.
    pub volumes: Volumes,
}

/// Volumes in m^3.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Volumes {
    /// Rock that waves took.
    pub worn: f64,
    /// Sand of rivers.
    pub rivers: f64,
    /// Sand that came to the shore: `sand_share` of both.
    pub sand: f64,
    /// Sand on beaches, with spits, bars and tombolos.
    pub beach: f64,
    /// Sand of spits, bars and tombolos as it left the shore.
    pub spits: f64,
    /// Sand that was lost to deep water.
    pub lost: f64,
}

/// Channels through sand begin within as many cells of it.
const BESIDE: usize = 6;

/// Memory of a cell, in bytes: the grids before and after, fetches, fronts, drainage, ridges.
const BYTES: u64 = 150;

impl Coast {
    /// Memory in bytes of [`Coast::run`] over a window, with its grids.
    #[must_use]
    pub fn memory(&self, window: &Window) -> u64 {
        (window.len() as u64).saturating_mul(BYTES)
    }

    /// The coast after all years. `erodibility_factor` multiplies the retreat at each sample.
    ///
    /// # Errors
    /// If the grids have different windows, or the work is cancelled.
    pub fn run(&self, ground: &Grid, erodibility_factor: Option<&Grid>, progress: &Progress) -> Result<CoastLayers> {
        let window = *ground.window();
        if erodibility_factor.is_some_and(|factor| *factor.window() != window) {
            return Err(Error::new(ErrorKind::Request, "the ground and its erodibility must have the same window"));
        }
        progress.expect(retreat::ROUNDS as f64 + 5.0);
        let sea = self.sea_level as f32;
        // Samples without a height are sea.
        let height: Vec<f32> =
            ground.data().iter().map(|height| if height.is_finite() { height - sea } else { -1.0 }).collect();
        let climate = Climate::new(self);
        let factor = |cell: usize| match erodibility_factor.map(|factor| f64::from(factor.data()[cell])) {
            Some(factor) if factor > 0.0 => factor.min(1e3),
            Some(_) => 0.0,
            None => 1.0,
        };
        let mut shore = retreat::retreat(self, &window, &height, factor, &climate, progress)?;
        let profile = Profile::new(self, &window, &height, &shore);
        let worn: Vec<f32> =
            (0..height.len()).map(|cell| profile.worn(self, window.cell, &shore, &height, cell)).collect();
        drop(profile);
        progress.step(1.0)?;
        let (sand, mut volumes) = self.beaches(ground, &height, &worn, &mut shore, &climate, progress)?;
        let with_sand = worn.iter().zip(&sand.thickness).map(|(worn, sand)| worn + sand).collect();
        let height_after = self.opened(&window, with_sand, &sand.thickness, progress)?;
        let mut beach = sand.thickness;
        for ((beach, after), worn) in beach.iter_mut().zip(&height_after).zip(&worn) {
            *beach = if *beach > 0.0 { (after - worn).max(0.0) } else { 0.0 };
        }
        volumes.beach = beach.iter().map(|beach| f64::from(*beach)).sum::<f64>() * window.cell * window.cell;
        let cut = worn.iter().zip(&height_after).map(|(worn, after)| f64::from(worn - after).max(0.0));
        volumes.worn += cut.sum::<f64>() * window.cell * window.cell;
        volumes.lost = volumes.sand - volumes.beach;
        let grid = |data: Vec<f32>| {
            Grid::from_data(window, data).ok_or_else(|| Error::new(ErrorKind::Internal, "a plane of another length"))
        };
        let change = height_after.iter().zip(&height).map(|(after, before)| after - before).collect();
        // Ground that the sea left alone keeps its bits.
        let after = ground.data().iter().zip(&height).zip(&height_after).map(|((ground, before), after)| {
            if after == before || !ground.is_finite() { *ground } else { after + sea }
        });
        Ok(CoastLayers {
            height: grid(after.collect())?,
            beach: grid(beach)?,
            exposure: grid(shore.exposure)?,
            change: grid(change)?,
            volumes,
        })
    }

    /// The sand of beaches, and of ridges in the water. Waves are then those over the water between the ridges.
    fn beaches(
        &self,
        ground: &Grid,
        height: &[f32],
        worn: &[f32],
        shore: &mut Shore,
        climate: &Climate,
        progress: &Progress,
    ) -> Result<(Sand, Volumes)> {
        let window = *ground.window();
        let area = window.cell * window.cell;
        let mut volumes = Volumes::default();
        // Sand comes to the nearest shore within some kilometres.
        let reach = (3000.0 / window.cell).ceil().clamp(8.0, 2000.0) as usize;
        let nodes = Nodes::new(&window, &shore.beside, reach)?;
        let taken = height.iter().zip(worn).map(|(before, after)| f64::from(before - after).max(0.0) * area);
        volumes.worn = taken.clone().sum();
        let mouths = self.mouths(ground, progress)?;
        let rivers = mouths.iter().map(|(cell, basin)| (*cell, basin * self.denudation * 1e-3 * self.years));
        volumes.rivers = rivers.clone().map(|(_, volume)| volume).sum();
        let brought = taken.enumerate().filter(|(_, volume)| *volume > 0.0).chain(rivers);
        let mut sand = beach::supply(&nodes, brought.map(|(cell, volume)| (cell, volume * self.sand_share)));
        volumes.sand = sand.iter().sum();
        progress.step(1.0)?;
        let drift = Drift::new(&window, &nodes, &shore.beside, climate, progress)?;
        let mut ridges = Ridges::new(self, &window, shore, worn);
        if self.spits > 0.0 && volumes.sand > 0.0 {
            tombolos::build(self, &mut ridges, &nodes, &mut sand);
            Drifting { nodes: &nodes, drift: &drift, mouths: &mouths }.build(self, &mut ridges, &mut sand);
        }
        let ridges = ridges.thickness;
        volumes.spits = volumes.sand - sand.iter().sum::<f64>();
        let bed: Vec<f32> = worn.iter().zip(&ridges).map(|(worn, ridge)| worn + ridge).collect();
        if volumes.spits > 0.0 {
            let built =
                |(beside, (bed, ridge)): (&f32, (&f32, &f32))| if *ridge > 0.0 && *bed > 0.0 { 1.0 } else { *beside };
            let land: Vec<f32> = shore.beside.iter().zip(bed.iter().zip(&ridges)).map(built).collect();
            shore.exposure = climate.exposure(&window, &land, progress)?;
        }
        progress.step(1.0)?;
        let sections = Section::all(self, &window, shore, &bed, &nodes);
        drift::run(self, &nodes.nodes, &drift, &sections, &mut sand);
        progress.step(1.0)?;
        let held = sand.iter().zip(&nodes.nodes).zip(&sections);
        // Without a reach sand stays where it comes to the shore.
        let held: Vec<f64> = held.map(|((sand, node), section)| (sand / node.length).min(section.most())).collect();
        let volume = held.iter().zip(&nodes.nodes).map(|(held, node)| held * node.length).sum();
        let widths: Vec<f64> = held.iter().zip(&sections).map(|(held, section)| section.width(*held)).collect();
        let mut sand = beach::lay(self, &window, shore, &bed, &nodes, &widths, volume);
        sand.thickness.iter_mut().zip(&ridges).for_each(|(sand, ridge)| *sand += ridge);
        let rivers = mouths.iter().filter(|(_, basin)| *basin >= spits::RIVER).map(|(cell, _)| *cell);
        inlets::open(&window, worn, &mut sand.thickness, rivers);
        Ok((sand, volumes))
    }

    /// The cells at which rivers end, with the areas of their basins in m^2.
    fn mouths(&self, ground: &Grid, progress: &Progress) -> Result<Vec<(usize, f64)>> {
        let window = *ground.window();
        if window.is_empty() || (self.denudation <= 0.0 && self.spits <= 0.0) {
            return Ok(Vec::new());
        }
        let outlets = Outlets::new(ground, Some(self.sea_level as f32));
        let part = progress.part(0.5);
        let drainage = route_carving_with(ground, &outlets, Descent::Steepest, &part)?;
        let accumulation = accumulate_with(&drainage.receivers, &progress.part(0.5))?;
        let area = window.cell * window.cell;
        let cells = accumulation.area.data().iter().enumerate();
        let mouths = cells.filter(|(cell, count)| outlets.at(*cell) && **count > 1);
        Ok(mouths.map(|(cell, count)| (cell, f64::from(count - 1) * area)).collect())
    }

    /// Heights over the sea with channels through sand that dams a river.
    fn opened(&self, window: &Window, height: Vec<f32>, sand: &[f32], progress: &Progress) -> Result<Vec<f32>> {
        let Some(grid) = Grid::from_data(*window, height.clone()) else { return Ok(height) };
        if window.is_empty() {
            return Ok(height);
        }
        let outlets = Outlets::new(&grid, Some(0.0));
        let drainage = route_carving_with(&grid, &outlets, Descent::Steepest, &progress.part(0.5))?;
        let cut = breach_with(&grid, &outlets, &drainage, self.berm as f32 + 1.0, &progress.part(0.5))?;
        // Lakes elsewhere stay as they are.
        let near = near(window, sand);
        let opened = height.iter().zip(cut.data()).zip(&near);
        Ok(opened.map(|((height, cut), near)| if *near { height.min(*cut) } else { *height }).collect())
    }
}

/// The cells within [`BESIDE`] columns and rows of sand.
fn near(window: &Window, sand: &[f32]) -> Vec<bool> {
    let mut near: Vec<bool> = sand.iter().map(|sand| *sand > 0.0).collect();
    let mut spread = |lines: usize, line_stride: usize, along: usize, stride: usize| {
        for line in 0..lines {
            let marked: Vec<bool> = (0..along).map(|i| near[line * line_stride + i * stride]).collect();
            for i in 0..along {
                let around = i.saturating_sub(BESIDE)..(i + BESIDE + 1).min(along);
                near[line * line_stride + i * stride] = marked[around].contains(&true);
            }
        }
    };
    spread(window.height, window.width, window.width, 1);
    spread(window.width, 1, window.height, window.width);
    near
}

#[cfg(test)]
mod tests;
