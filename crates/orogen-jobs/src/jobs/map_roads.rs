//! The roads of a map.

use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::hydrography::clip::Rectangle;
use orogen_grid::progress::Progress;
use orogen_output::sheet::roads::MapRoad;

/// The roads of a recipe's nodes within a window.
///
/// # Errors
/// The errors of [`World::roads`].
pub fn of(world: &World, window: &Window, progress: &Progress) -> Result<Vec<MapRoad>> {
    let ends = [window.width, window.height].map(|samples| samples.saturating_sub(1) as f64);
    let frame = Rectangle { sides: [0.0, 0.0, ends[0], ends[1]] };
    let mut roads = Vec::new();
    for road in world.roads(progress)? {
        let sample = |[x, y, z]: &[f64; 3]| [x / window.cell - window.x as f64, y / window.cell - window.y as f64, *z];
        let points: Vec<[f64; 3]> = road.line.points.iter().map(sample).collect();
        for (kind, range) in road.line.stretches() {
            let pieces = frame.pieces(&points[range]).into_iter();
            roads.extend(
                pieces.map(|piece| MapRoad { kind, points: piece.points.iter().map(|[x, y, _]| [*x, *y]).collect() }),
            );
        }
    }
    Ok(roads)
}
