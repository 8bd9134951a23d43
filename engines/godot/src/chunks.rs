//! `OrogenChunks`: ground around a viewer.

use std::collections::HashMap;

use godot::classes::mesh::ArrayType;
use godot::prelude::*;
use orogen::{ChunkId, LodConfig};
use orogen_engine_ground::{ChunkArrays, Ground, Winding};

use crate::world::OrogenWorld;

/// Chunks of ground around a viewer, which worker threads make.
#[derive(GodotClass)]
#[class(init, base = RefCounted)]
pub struct OrogenChunks {
    ground: Option<Ground>,
    numbers: HashMap<ChunkId, i64>,
    next: i64,
    error: String,
}

#[godot_api]
impl OrogenChunks {
    /// Starts worker threads for a layer of a world: chunks of 64 cells, of `cell` metres near the viewer and twice as
    /// many with each of the `levels`, up to `range` metres away. Returns whether it worked; otherwise `get_error` says
    /// why.
    #[func]
    fn start(
        &mut self,
        world: Gd<OrogenWorld>,
        layer: GString,
        cell: f64,
        levels: i64,
        range: f64,
        threads: i64,
    ) -> bool {
        let lod = LodConfig::default().with_cell(cell).with_levels(levels.clamp(0, 255) as u8).with_range(range);
        let started = world.bind().opened().and_then(|world| {
            Ground::new(&world, &layer.to_string(), lod, Winding::Clockwise, threads.clamp(1, 64) as usize)
                .map_err(|error| error.to_string())
        });
        self.numbers.clear();
        match started {
            Ok(ground) => self.ground = Some(ground),
            Err(message) => self.fail(message),
        }
        self.ground.is_some()
    }

    /// Why the last call failed.
    #[func]
    fn get_error(&self) -> GString {
        GString::from(self.error.as_str())
    }

    /// Moves the viewer, in metres east and south of the world's origin.
    #[func]
    fn set_viewer(&mut self, x: f64, z: f64) {
        let moved = self.ground.as_mut().map(|ground| ground.set_viewer(x, z));
        if let Some(Err(error)) = moved {
            self.fail(error.to_string());
        }
    }

    /// The next chunk that is made; empty if there is none now. It has `id`, `level`, `x` and `z` of its north-west
    /// corner in metres, `width` and `depth` in samples, `cell`, `heights` in metres, `heights_in_cells` for a
    /// `HeightMapShape3D` that is scaled by `cell`, and `arrays` for `ArrayMesh.add_surface_from_arrays`.
    #[func]
    fn next_made(&mut self) -> VarDictionary {
        loop {
            let Some(made) = self.ground.as_mut().and_then(Ground::next_made) else { return VarDictionary::new() };
            match made.arrays {
                Ok(arrays) => {
                    self.next += 1;
                    self.numbers.insert(made.id, self.next);
                    return dictionary(self.next, made.id.level, &arrays);
                }
                Err(error) => self.fail(error.to_string()),
            }
        }
    }

    /// The `id` of the next chunk to remove; -1 if there is none now.
    #[func]
    fn next_dropped(&mut self) -> i64 {
        loop {
            let Some(id) = self.ground.as_mut().and_then(Ground::next_dropped) else { return -1 };
            // Chunks that could not be made have no number.
            if let Some(number) = self.numbers.remove(&id) {
                return number;
            }
        }
    }

    /// Whether all ground around the viewer is made.
    #[func]
    fn is_complete(&self) -> bool {
        self.ground.as_ref().is_some_and(Ground::is_complete)
    }

    /// The height at a point, in metres; NaN after an error.
    #[func]
    fn height(&self, x: f64, z: f64) -> f64 {
        self.ground.as_ref().and_then(|ground| ground.height(x, z).ok()).map_or(f64::NAN, f64::from)
    }
}

impl OrogenChunks {
    fn fail(&mut self, message: String) {
        godot_error!("{message}");
        self.error = message;
    }
}

/// A chunk as a dictionary.
fn dictionary(number: i64, level: u8, chunk: &ChunkArrays) -> VarDictionary {
    let vectors =
        |parts: &[[f32; 3]]| -> PackedVector3Array { parts.iter().map(|[x, y, z]| Vector3::new(*x, *y, *z)).collect() };
    let colors: PackedColorArray = chunk.colors.iter().map(|[r, g, b, a]| Color::from_rgba(*r, *g, *b, *a)).collect();
    let indices: PackedInt32Array = chunk.indices.iter().map(|index| *index as i32).collect();
    let mut arrays = VarArray::new();
    arrays.resize(ArrayType::MAX.ord() as usize, &Variant::nil());
    for (kind, array) in [
        (ArrayType::VERTEX, vectors(&chunk.positions).to_variant()),
        (ArrayType::NORMAL, vectors(&chunk.normals).to_variant()),
        (ArrayType::COLOR, colors.to_variant()),
        (ArrayType::INDEX, indices.to_variant()),
    ] {
        arrays.set(kind.ord() as usize, &array);
    }
    let in_cells: PackedFloat32Array = chunk.heights.iter().map(|height| height / chunk.cell).collect();
    let mut made = VarDictionary::new();
    for (key, value) in [
        ("id", number.to_variant()),
        ("level", i64::from(level).to_variant()),
        ("x", chunk.corner[0].to_variant()),
        ("z", chunk.corner[1].to_variant()),
        ("width", (chunk.size[0] as i64).to_variant()),
        ("depth", (chunk.size[1] as i64).to_variant()),
        ("cell", f64::from(chunk.cell).to_variant()),
        ("heights", PackedFloat32Array::from(chunk.heights.as_slice()).to_variant()),
        ("heights_in_cells", in_cells.to_variant()),
        ("arrays", arrays.to_variant()),
    ] {
        made.set(&key.to_variant(), &value);
    }
    made
}
