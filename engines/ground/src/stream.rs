//! Chunks around a viewer, made by worker threads.

use std::fmt;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use orogen::{ChunkId, Chunks, Error, LodConfig, Sampler, Window, World};

use crate::arrays::{ChunkArrays, Winding};

/// Chunks that are being made at a time, for each thread.
const AHEAD: usize = 2;

/// A chunk that a worker has made.
pub struct MadeChunk {
    /// Which chunk it is.
    pub id: ChunkId,
    /// The chunk, or why there is none.
    pub arrays: Result<ChunkArrays, GroundError>,
}

/// An error of the terrain.
#[derive(Debug, Clone)]
pub struct GroundError(String);

impl fmt::Display for GroundError {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl std::error::Error for GroundError {}

impl From<Error> for GroundError {
    fn from(error: Error) -> GroundError {
        GroundError(error.to_string())
    }
}

/// The ground of a world around a viewer.
pub struct Ground {
    sampler: Arc<Sampler<Arc<World>>>,
    chunks: Chunks,
    tasks: Sender<(ChunkId, Window)>,
    /// Behind a lock that is never waited for: engines want what they keep to be shared between threads.
    made: Mutex<Receiver<MadeChunk>>,
    /// Chunks that workers have not returned yet.
    pending: usize,
    room: usize,
}

impl Ground {
    /// The ground of a layer of a world, made by this many threads. They end when the ground is dropped.
    ///
    /// # Errors
    /// If the world has no such layer, or the configuration is not valid.
    pub fn new(
        world: &Arc<World>,
        layer: &str,
        lod: LodConfig,
        winding: Winding,
        threads: usize,
    ) -> Result<Ground, GroundError> {
        let sampler = Arc::new(Sampler::new(Arc::clone(world), layer)?);
        let chunks = world.chunks(lod)?;
        let (tasks, waiting) = channel();
        let (results, made) = channel();
        let waiting = Arc::new(Mutex::new(waiting));
        for _ in 0..threads.max(1) {
            let worker = Worker {
                waiting: Arc::clone(&waiting),
                results: results.clone(),
                sampler: Arc::clone(&sampler),
                sea_level: world.recipe().world.sea_level as f32,
                winding,
            };
            thread::spawn(move || worker.run());
        }
        Ok(Ground { sampler, chunks, tasks, made: Mutex::new(made), pending: 0, room: AHEAD * threads.max(1) })
    }

    /// Moves the viewer to x metres east and y metres south of the origin, and starts work on the nearest chunks.
    ///
    /// # Errors
    /// If the position is not finite.
    pub fn set_viewer(&mut self, x: f64, y: f64) -> Result<(), GroundError> {
        self.chunks.set_viewer(x, y)?;
        self.start();
        Ok(())
    }

    fn start(&mut self) {
        while self.pending < self.room {
            let Some(id) = self.chunks.take() else { return };
            // Workers end only with this sender.
            if self.tasks.send((id, self.chunks.window(id))).is_err() {
                return;
            }
            self.pending += 1;
        }
    }

    /// The next chunk that is made, if there is one; it counts as shown.
    pub fn next_made(&mut self) -> Option<MadeChunk> {
        let made = self.made.get_mut().unwrap_or_else(PoisonError::into_inner).try_recv().ok()?;
        self.pending -= 1;
        // A chunk that cannot be made is not tried again: it would fail again.
        self.chunks.done(made.id);
        self.start();
        Some(made)
    }

    /// The next chunk to drop: it is out of sight, or others are shown in its place.
    pub fn next_dropped(&mut self) -> Option<ChunkId> {
        self.chunks.evict()
    }

    /// Whether all chunks around the viewer are made.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.pending == 0
    }

    /// The height at a point, in metres.
    ///
    /// # Errors
    /// If the point is outside of the world.
    pub fn height(&self, x: f64, y: f64) -> Result<f32, GroundError> {
        Ok(self.sampler.at(x, y)?)
    }
}

/// What a worker thread needs.
struct Worker {
    waiting: Arc<Mutex<Receiver<(ChunkId, Window)>>>,
    results: Sender<MadeChunk>,
    sampler: Arc<Sampler<Arc<World>>>,
    sea_level: f32,
    winding: Winding,
}

impl Worker {
    /// Makes chunks until the ground is dropped.
    fn run(&self) {
        loop {
            let task = self.waiting.lock().unwrap_or_else(PoisonError::into_inner).recv();
            let Ok((id, window)) = task else { return };
            if self.results.send(MadeChunk { id, arrays: self.make(&window) }).is_err() {
                return;
            }
        }
    }

    fn make(&self, window: &Window) -> Result<ChunkArrays, GroundError> {
        // Beyond the edge of a bounded world there are no samples.
        let wide = match self.sampler.window(&window.grown(1)) {
            Ok(wide) => wide,
            Err(_) => self.sampler.window(window)?,
        };
        Ok(ChunkArrays::of(&wide, window, self.sea_level, self.winding))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    /// Makes all chunks around a viewer.
    fn complete(ground: &mut Ground, shown: &mut HashMap<ChunkId, ChunkArrays>) {
        while !ground.is_complete() {
            if let Some(made) = ground.next_made() {
                shown.insert(made.id, made.arrays.unwrap());
            }
            thread::yield_now();
        }
        while let Some(id) = ground.next_dropped() {
            assert!(shown.remove(&id).is_some());
        }
    }

    #[test]
    fn chunks_follow_the_viewer_and_share_their_edges() {
        let world = Arc::new(orogen::open("hills").unwrap());
        let lod = LodConfig::default().with_cells(16).with_cell(10.0).with_levels(3).with_range(1500.0);
        let mut ground = Ground::new(&world, "height", lod, Winding::Clockwise, 2).unwrap();
        let mut shown = HashMap::new();
        ground.set_viewer(4000.0, 4000.0).unwrap();
        complete(&mut ground, &mut shown);
        assert!(shown.keys().any(|id| id.level == 0) && shown.keys().any(|id| id.level == 2));
        let mut pairs = 0;
        for (id, chunk) in &shown {
            let [width, height] = chunk.size;
            assert_eq!(chunk.heights[0], ground.height(chunk.corner[0], chunk.corner[1]).unwrap());
            let Some(east) = shown.get(&id.beside(1, 0)) else { continue };
            pairs += 1;
            for row in 0..height {
                assert_eq!(chunk.heights[row * width + width - 1], east.heights[row * east.size[0]]);
            }
        }
        assert!(pairs > 4);
        let before = shown.len();
        ground.set_viewer(4800.0, 4000.0).unwrap();
        complete(&mut ground, &mut shown);
        assert!(shown.len() < 2 * before && shown.keys().all(|id| lod.distance(*id, [4800.0, 4000.0]) < 4000.0));
        assert!(ground.set_viewer(f64::NAN, 0.0).is_err());
        assert!(Ground::new(&world, "nothing", lod, Winding::Clockwise, 1).is_err());
    }
}
