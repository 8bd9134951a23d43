//! The chunks to make and to drop as the viewer moves.

use super::id::ChunkId;
use super::lod::LodConfig;
use super::seam::Sides;
use crate::world::World;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;

/// A step of [`Chunks::next_step`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChunkStep {
    /// Make this chunk and show it.
    Make(ChunkId),
    /// Drop this chunk: it is out of range, or others that cover its terrain have been made.
    Drop(ChunkId),
}

/// The chunks around a viewer: for each position of the viewer, it returns the chunks to make (nearest first) and to
/// drop.
///
/// It only keeps the lists; the samples come from a [`Sampler`](crate::Sampler), on any thread. A chunk is dropped only
/// after its replacement has been made, so that the terrain never has holes; until then parts of it are covered twice.
/// See [`LodConfig`] for the division into chunks and for their borders.
///
/// ```
/// use orogen_engine::{ChunkStep, Recipe, LodConfig, Sampler, World};
/// use std::collections::HashMap;
///
/// let text = "orogen = 1\n[nodes.n]\nop = \"fbm\"\n[outputs]\nheight = \"n\"\n";
/// let world = World::open(Recipe::parse(text, "example")?)?;
/// let ground = Sampler::new(&world, "height")?;
/// let mut chunks = world.chunks(LodConfig::default().with_cells(16).with_levels(3).with_range(200.0))?;
/// let mut scene = HashMap::new();
/// for step in 0..20 {
///     chunks.set_viewer(10.0 * f64::from(step), -3.0)?;
///     while let Some(step) = chunks.next_step() {
///         match step {
///             ChunkStep::Make(id) => drop(scene.insert(id, ground.window(&chunks.window(id))?)),
///             ChunkStep::Drop(id) => drop(scene.remove(&id)),
///         }
///     }
/// }
/// assert_eq!(scene.len(), chunks.wanted().len());
/// # Ok::<(), orogen_engine::Error>(())
/// ```
///
/// **Chunks made on other threads.** [`Chunks::take`] returns the nearest chunk that is not being made yet. Call
/// [`Chunks::done`] when it is made, or [`Chunks::forget`] if it failed. [`Chunks::evict`] returns the chunks to drop.
/// [`Chunks::next_step`] combines these, for callers that make each chunk before they ask for the next step.
///
/// After its lists have reached their final size, it allocates no memory.
#[derive(Debug, Clone)]
pub struct Chunks {
    lod: LodConfig,
    size: Option<[f64; 2]>,
    /// The chunks that cover the terrain around the viewer, sorted.
    wanted: Vec<ChunkId>,
    /// Wanted chunks that are not being made yet, nearest last.
    queue: Vec<ChunkId>,
    /// Chunks returned by [`Chunks::take`], sorted.
    known: Vec<Known>,
    /// Chunks that have been made and are no longer wanted.
    leaving: Vec<ChunkId>,
    /// Chunks that are replaced by finer ones, and chunks of the coarsest level in range, both sorted. Both change with
    /// hysteresis.
    split: Vec<ChunkId>,
    roots: Vec<ChunkId>,
    /// Scratch lists.
    stack: Vec<ChunkId>,
    fresh: Vec<ChunkId>,
    /// The last chunk returned by [`Chunks::next_step`].
    handed: Option<ChunkId>,
}

#[derive(Debug, Clone, Copy)]
struct Known {
    id: ChunkId,
    made: bool,
}

impl World {
    /// The chunks around a viewer of this world, initially none. In a bounded world there are no chunks outside of it,
    /// and those at its far edges are clipped.
    ///
    /// # Errors
    /// If the configuration is invalid: see [`LodConfig::check`].
    pub fn chunks(&self, lod: LodConfig) -> Result<Chunks> {
        Chunks::new(lod, self.recipe().world.size)
    }
}

impl Chunks {
    /// The chunks around a viewer of a world of `size` metres east and south, or of an unbounded one.
    ///
    /// # Errors
    /// If the configuration is invalid: see [`LodConfig::check`].
    pub fn new(lod: LodConfig, size: Option<[f64; 2]>) -> Result<Chunks> {
        lod.check()?;
        Ok(Chunks {
            lod,
            size,
            wanted: Vec::new(),
            queue: Vec::new(),
            known: Vec::new(),
            leaving: Vec::new(),
            split: Vec::new(),
            roots: Vec::new(),
            stack: Vec::new(),
            fresh: Vec::new(),
            handed: None,
        })
    }

    /// The configuration.
    #[must_use]
    pub fn lod(&self) -> &LodConfig {
        &self.lod
    }

    /// The samples of a chunk, including its far edges, clipped to a bounded world.
    #[must_use]
    pub fn window(&self, id: ChunkId) -> Window {
        self.lod.window_within(id, self.size).unwrap_or_else(|| self.lod.window(id))
    }

    /// The chunks that cover the terrain around the viewer, whether made or not, sorted.
    #[must_use]
    pub fn wanted(&self) -> &[ChunkId] {
        &self.wanted
    }

    /// Moves the viewer to x metres east and y metres south of the origin.
    ///
    /// # Errors
    /// If the position is not finite, or so far away that positions are no longer exact; then nothing changes.
    pub fn set_viewer(&mut self, x: f64, y: f64) -> Result<()> {
        // Samples have exact positions up to 2^53; the terrain in range must be closer.
        let farthest = (1u64 << 52) as f64 * self.lod.cell;
        if !(x.abs() <= farthest && y.abs() <= farthest) {
            let message = match x.is_finite() && y.is_finite() {
                false => format!("({x}, {y}) is not a position: coordinates must be finite"),
                true => format!(
                    "({x}, {y}) is more than 2^52 cells of {} m from the origin, where positions are no longer exact",
                    self.lod.cell
                ),
            };
            return Err(Error::new(ErrorKind::Request, message));
        }
        let viewer = [x, y];
        self.see(viewer);
        self.cut(viewer);
        let Chunks { lod, wanted, queue, known, leaving, .. } = self;
        queue.clear();
        queue.extend(wanted.iter().filter(|id| find(known, **id).is_err()));
        let nearest = |id: &ChunkId| (lod.distance(*id, viewer), lod.distance_to_middle(*id, viewer));
        queue.sort_unstable_by(|a, b| {
            let ((a_near, a_middle), (b_near, b_middle)) = (nearest(a), nearest(b));
            let order = a_near.total_cmp(&b_near).then(a_middle.total_cmp(&b_middle)).then(a.cmp(b));
            order.reverse()
        });
        leaving.clear();
        leaving.extend(known.iter().filter(|known| known.made && !is_wanted(wanted, known.id)).map(|k| k.id));
        Ok(())
    }

    /// Finds the chunks of the coarsest level in range.
    fn see(&mut self, viewer: [f64; 2]) {
        let level = self.lod.levels - 1;
        let side = self.lod.side(level);
        let longer = self.lod.range + self.lod.slack * side;
        let [columns, rows] =
            viewer.map(|at| ((at - longer) / side).floor() as i64..=((at + longer) / side).floor() as i64);
        self.fresh.clear();
        for y in rows {
            for x in columns.clone() {
                let id = ChunkId { level, y, x };
                let range = if self.roots.binary_search(&id).is_ok() { longer } else { self.lod.range };
                if self.lod.distance(id, viewer) < range && self.has_ground(id) {
                    self.fresh.push(id);
                }
            }
        }
        // Row-by-row order is sorted already.
        std::mem::swap(&mut self.fresh, &mut self.roots);
    }

    /// Splits the chunks near the viewer into finer ones.
    fn cut(&mut self, viewer: [f64; 2]) {
        self.wanted.clear();
        self.fresh.clear();
        self.stack.clear();
        self.stack.extend_from_slice(&self.roots);
        while let Some(id) = self.stack.pop() {
            let was_split = self.split.binary_search(&id).is_ok();
            let sides = self.lod.detail + if was_split { self.lod.slack } else { 0.0 };
            if id.level > 0 && self.lod.distance(id, viewer) < sides * self.lod.side(id.level) {
                self.fresh.push(id);
                for child in id.children() {
                    if self.has_ground(child) {
                        self.stack.push(child);
                    }
                }
            } else if self.lod.window_within(id, self.size).is_some() {
                self.wanted.push(id);
            }
        }
        self.wanted.sort_unstable();
        self.fresh.sort_unstable();
        std::mem::swap(&mut self.fresh, &mut self.split);
    }

    /// Whether a chunk overlaps the world.
    fn has_ground(&self, id: ChunkId) -> bool {
        let Some([east, south]) = self.size else { return true };
        let side = self.lod.side(id.level);
        let within = |index: i64, length: f64| index >= 0 && (index as f64 * side) < length;
        within(id.x, east) && within(id.y, south)
    }

    /// Returns the nearest wanted chunk that is not being made yet.
    pub fn take(&mut self) -> Option<ChunkId> {
        let id = self.queue.pop()?;
        if let Err(place) = find(&self.known, id) {
            self.known.insert(place, Known { id, made: false });
        }
        Some(id)
    }

    /// Reports that a taken chunk has been made and is shown.
    pub fn done(&mut self, id: ChunkId) {
        let Ok(place) = find(&self.known, id) else { return };
        let known = &mut self.known[place];
        if !std::mem::replace(&mut known.made, true) && !is_wanted(&self.wanted, id) {
            self.leaving.push(id);
        }
    }

    /// Reports that a taken chunk could not be made or was lost. If it is wanted, it is returned again after all
    /// others.
    pub fn forget(&mut self, id: ChunkId) {
        let Ok(place) = find(&self.known, id) else { return };
        self.known.remove(place);
        self.leaving.retain(|leaving| *leaving != id);
        if is_wanted(&self.wanted, id) {
            self.queue.insert(0, id);
        }
    }

    /// Returns a chunk to drop, and removes it from the lists.
    pub fn evict(&mut self) -> Option<ChunkId> {
        let replaced = |id: &ChunkId| {
            let missing = |other: &Known| !other.made && other.id.overlaps(*id) && is_wanted(&self.wanted, other.id);
            !self.queue.iter().any(|wanted| wanted.overlaps(*id)) && !self.known.iter().any(missing)
        };
        let place = self.leaving.iter().position(replaced)?;
        let id = self.leaving.swap_remove(place);
        if let Ok(place) = find(&self.known, id) {
            self.known.remove(place);
        }
        Some(id)
    }

    /// The next step; `None` if the terrain is complete until the viewer moves. A chunk to make counts as made at the
    /// next call.
    pub fn next_step(&mut self) -> Option<ChunkStep> {
        if let Some(id) = self.handed.take() {
            self.done(id);
        }
        if let Some(id) = self.evict() {
            return Some(ChunkStep::Drop(id));
        }
        self.handed = self.take();
        self.handed.map(ChunkStep::Make)
    }

    /// The sides of a chunk with a coarser neighbor, for [`stitch`](super::seam::stitch). They change as the viewer
    /// moves.
    #[must_use]
    pub fn coarser(&self, id: ChunkId) -> Sides {
        let coarser = |columns, rows| {
            let mut beside = id.beside(columns, rows);
            (beside.level + 1..self.lod.levels).any(|_| {
                beside = beside.parent();
                is_wanted(&self.wanted, beside)
            })
        };
        Sides { north: coarser(0, -1), east: coarser(1, 0), south: coarser(0, 1), west: coarser(-1, 0) }
    }
}

fn find(known: &[Known], id: ChunkId) -> std::result::Result<usize, usize> {
    known.binary_search_by(|known| known.id.cmp(&id))
}

fn is_wanted(wanted: &[ChunkId], id: ChunkId) -> bool {
    wanted.binary_search(&id).is_ok()
}
