//! Tiles of the coarse levels from which a window of a levelled op is made. They are taken from memory or the store, or
//! made, coarsest first.

use super::refine::{Planes, Refining};
use super::run::Engine;
use crate::plan::levels;
use crate::store::level_tile::LevelTile;
use crate::store::level_tiles::Claim;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;
use orogen_ops::op::Levelled;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

/// The column and row of a tile of a level.
type At = (i64, i64);

/// Minimum cost of a tile that is stored for later runs, in nanoseconds per sample of a plane; reading one takes about
/// three.
const EXPENSIVE: f64 = 16.0;

/// The tiles of one level from which a window is made.
struct LevelTiles {
    level: usize,
    found: Planes,
    missing: Vec<At>,
}

impl Engine<'_> {
    /// The tiles of the first of the `direct` levels, from which pieces of the last one are made. Only a thread outside
    /// of the pool waits for tiles that other requests make.
    pub(super) fn level_tiles(
        &self,
        refining: &Refining,
        direct: RangeInclusive<usize>,
        pieces: &[Window],
    ) -> Result<Planes> {
        let Refining { op, .. } = *refining;
        let (last, level) = (*direct.start(), *direct.end());
        let firsts =
            pieces.iter().filter_map(|piece| levels::windows(op, refining.wanted, last, level, piece).first().copied());
        let first: BTreeSet<At> = firsts.flat_map(|window| levels::tiles(last, &window)).collect();
        let mut tiles = Vec::new();
        let claims = loop {
            tiles = self.find_level_tiles(refining, (last, &first), tiles);
            let of_level = |tiles: &LevelTiles| {
                let level = tiles.level;
                tiles.missing.iter().map(|at| self.level_tile(refining, level, *at)).collect::<Vec<_>>()
            };
            let missing: Vec<LevelTile> = tiles.iter().flat_map(of_level).collect();
            if let Some(claims) = self.kept.level_tiles.claim(&missing, self.may_wait(), refining.progress)? {
                break claims;
            }
        };
        let of_tiles = |tiles: &LevelTiles| tiles.missing.len() as f64 * refining.work_of_tile(tiles.level);
        let work: f64 = tiles.iter().map(of_tiles).sum();
        let of_piece = |piece: &Window| refining.work_of_piece(direct.clone(), piece);
        refining.progress.expect(work + pieces.iter().map(of_piece).sum::<f64>());
        let is_stored = self.kept.store.keeps_tiles(work);
        // The claims end on a thread of the pool: the calling thread may run work of another request that waits for
        // them.
        self.pool.install(|| self.make_level_tiles(refining, tiles, claims, is_stored))
    }

    /// Looks up the tiles of each level from `last` up, and lists the missing ones: they determine which tiles of the
    /// level above are needed. Tiles that were `found` before are not looked up again.
    fn find_level_tiles(
        &self,
        refining: &Refining,
        (last, first): (usize, &BTreeSet<At>),
        found: Vec<LevelTiles>,
    ) -> Vec<LevelTiles> {
        let Refining { op, .. } = *refining;
        let mut before: BTreeMap<usize, Planes> = found.into_iter().map(|tiles| (tiles.level, tiles.found)).collect();
        let mut asked = first.clone();
        let mut tiles = Vec::with_capacity(last + 1);
        for level in (0..=last).rev() {
            let mut before = before.remove(&level).unwrap_or_default();
            let (mut found, mut missing) = (Planes::new(), Vec::new());
            for at in asked {
                match before.remove(&at).or_else(|| self.find_level_tile(refining, level, at)) {
                    Some(planes) => drop(found.insert(at, planes)),
                    None => missing.push(at),
                }
            }
            let above = missing.iter().filter(|_| level > 0);
            asked =
                above.flat_map(|at| levels::tiles(level - 1, &op.parent(level, &refining.tile(level, *at)))).collect();
            tiles.push(LevelTiles { level, found, missing });
        }
        tiles
    }

    /// The planes of a tile, from memory or else from the store.
    fn find_level_tile(&self, refining: &Refining, level: usize, at: At) -> Option<Vec<Grid>> {
        let tile = self.level_tile(refining, level, at);
        self.kept.level_tiles.find(&tile).or_else(|| {
            let is_stored = self.kept.store.has_tiles() && is_expensive(refining.op, level);
            let planes = is_stored.then(|| self.kept.store.find_tile(&tile)).flatten()?;
            self.keep_level_tile(&tile, &planes);
            Some(planes)
        })
    }

    /// The tiles of the last level. Makes the missing ones, and stores them if required.
    fn make_level_tiles(
        &self,
        refining: &Refining,
        tiles: Vec<LevelTiles>,
        claims: Vec<Claim>,
        is_stored: bool,
    ) -> Result<Planes> {
        let mut claims = claims.into_iter();
        let mut tiles: Vec<(LevelTiles, Vec<Claim>)> = tiles
            .into_iter()
            .map(|tiles| {
                let claims = claims.by_ref().take(tiles.missing.len()).collect();
                (tiles, claims)
            })
            .collect();
        let mut above = Planes::new();
        while let Some((LevelTiles { level, mut found, missing }, claims)) = tiles.pop() {
            let is_stored = is_stored && is_expensive(refining.op, level);
            let make = |(at, claim): (At, Claim)| {
                let tile = self.level_tile(refining, level, at);
                let planes = refining.planes(level, &tile.window, &above)?;
                self.kept.level_tiles.count_made();
                self.keep_level_tile(&tile, &planes);
                drop(claim);
                if is_stored {
                    self.kept.store.store_tile(&tile, &planes);
                }
                Ok((at, planes))
            };
            let missing: Vec<(At, Claim)> = missing.into_iter().zip(claims).collect();
            let made: Vec<(At, Vec<Grid>)> = parallel::try_map(missing, make)?;
            found.extend(made);
            above = found;
        }
        Ok(above)
    }

    fn keep_level_tile(&self, tile: &LevelTile, planes: &[Grid]) {
        self.kept.level_tiles.keep(tile, planes, self.room());
    }

    fn level_tile(&self, refining: &Refining, level: usize, at: At) -> LevelTile {
        let (node, planes) = (self.resolved.keys[refining.node], refining.op.planes());
        LevelTile { node, level, planes, window: refining.tile(level, at) }
    }
}

/// Whether a tile is read from a store much faster than it is made.
fn is_expensive(op: &dyn Levelled, level: usize) -> bool {
    op.cost(level) >= EXPENSIVE * op.planes() as f64
}
