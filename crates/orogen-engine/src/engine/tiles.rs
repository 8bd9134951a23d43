//! The sources of a solver, computed tile by tile on request.

use crate::plan::steps::Solve;
use crate::recipe::graph::Link;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_io::pages::Pages;
use orogen_io::raster::Raster;
use orogen_ops::declare::Spec;
use orogen_ops::op::Sources;
use std::path::Path;

/// The inputs of a solver; `make` computes an input over a tile.
pub struct Tiles<'a> {
    pub spec: &'static Spec,
    pub links: &'a [Link],
    pub order: &'a Solve,
    pub make: &'a dyn Fn(Link, Window) -> Result<Vec<Grid>>,
    /// The folder for rasters on disk.
    pub scratch: &'a Path,
}

impl Tiles<'_> {
    /// The target of an input, if it is given.
    fn link(&self, name: &str) -> Option<Link> {
        self.links.get(self.spec.input_named(name)?).copied().filter(|link| *link != Link::None)
    }
}

impl Sources for Tiles<'_> {
    fn domain(&self) -> &Window {
        &self.order.domain
    }

    fn padded(&self) -> &Window {
        &self.order.padded
    }

    fn given(&self, name: &str) -> bool {
        self.link(name).is_some()
    }

    fn each_tile(&self, name: &str, window: &Window, visit: &mut dyn FnMut(&Grid) -> Result<()>) -> Result<()> {
        let link = self.link(name).ok_or_else(|| self.spec.missing(name))?;
        for tile in window.tiles(self.order.side) {
            for grid in (self.make)(link, tile)? {
                visit(&grid)?;
            }
        }
        Ok(())
    }

    fn raster(&self) -> Result<Raster> {
        match self.order.on_disk {
            true => Pages::scratch(self.scratch, self.order.padded).map(Raster::on_disk),
            false => Ok(Raster::in_memory(Grid::filled(self.order.padded, 0.0))),
        }
    }

    fn on_disk(&self) -> bool {
        self.order.on_disk
    }

    fn keep(&self, grid: Grid) -> Result<Raster> {
        let raster = Raster::in_memory(grid);
        if self.order.on_disk { raster.copied_to_disk(self.scratch) } else { Ok(raster) }
    }
}
