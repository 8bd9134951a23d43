//! Chunks of ground around the [`Viewer`]: meshes as far as one sees, height fields to roll on near by.

use std::collections::HashMap;
use std::sync::Arc;

use avian3d::parry::shape::SharedShape;
use avian3d::parry::utils::Array2;
use avian3d::prelude::*;
use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use orogen::{ChunkId, LodConfig, World};
use orogen_engine_ground::{ChunkArrays, Ground, Winding};

/// Levels whose chunks have colliders: those near the viewer.
const COLLIDER_LEVELS: u8 = 1;

/// Chunks that are shown per frame at most: an upload takes time.
const SHOWN_PER_FRAME: usize = 8;

/// The entity that the ground is made around.
#[derive(Component)]
pub struct Viewer;

/// The ground that is shown.
#[derive(Resource)]
pub struct ShownGround {
    /// The chunks to make and to drop.
    pub ground: Ground,
    /// Metres east and south of the world's origin, at the origin of the scene: positions stay small there.
    pub origin: [f64; 2],
    /// The chunks.
    pub lod: LodConfig,
    /// Whether the ground around the viewer is complete.
    pub is_complete: bool,
    material: Handle<StandardMaterial>,
    entities: HashMap<ChunkId, Entity>,
}

/// Shows the ground of a world around the [`Viewer`].
pub struct GroundPlugin {
    /// The world.
    pub world: Arc<World>,
    /// Metres east and south of the world's origin, at the origin of the scene.
    pub origin: [f64; 2],
    /// The chunks.
    pub lod: LodConfig,
}

impl Plugin for GroundPlugin {
    fn build(&self, app: &mut App) {
        let ground = Ground::new(&self.world, "height", self.lod, Winding::Counterclockwise, 2);
        match ground {
            Ok(ground) => {
                let material = StandardMaterial { perceptual_roughness: 0.95, reflectance: 0.1, ..default() };
                let material = app.world_mut().resource_mut::<Assets<StandardMaterial>>().add(material);
                app.insert_resource(ShownGround {
                    ground,
                    origin: self.origin,
                    lod: self.lod,
                    is_complete: false,
                    material,
                    entities: HashMap::new(),
                });
                app.add_systems(Update, (follow_viewer, show_chunks).chain());
            }
            Err(error) => error!("{error}"),
        }
    }
}

/// Tells the ground where the viewer is.
fn follow_viewer(mut shown: ResMut<ShownGround>, viewer: Query<&Transform, With<Viewer>>) {
    let Ok(viewer) = viewer.single() else { return };
    let [east, south] = shown.origin;
    let at = viewer.translation;
    if let Err(error) = shown.ground.set_viewer(east + f64::from(at.x), south + f64::from(at.z)) {
        error!("{error}");
    }
}

/// Adds the chunks that workers have made, and removes those that are out of sight.
fn show_chunks(mut shown: ResMut<ShownGround>, mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    for _ in 0..SHOWN_PER_FRAME {
        let Some(made) = shown.ground.next_made() else { break };
        let arrays = match made.arrays {
            Ok(arrays) => arrays,
            Err(error) => {
                error!("chunk {:?}: {error}", made.id);
                continue;
            }
        };
        let [east, south] = [0, 1].map(|axis| (arrays.corner[axis] - shown.origin[axis]) as f32);
        let collider = (made.id.level < COLLIDER_LEVELS).then(|| collider(&arrays));
        let mut chunk = commands.spawn((
            Mesh3d(meshes.add(mesh(arrays))),
            MeshMaterial3d(shown.material.clone()),
            Transform::from_xyz(east, 0.0, south),
        ));
        if let Some((collider, middle)) = collider {
            chunk.insert(RigidBody::Static).with_child((collider, Transform::from_translation(middle)));
        }
        shown.entities.insert(made.id, chunk.id());
    }
    while let Some(id) = shown.ground.next_dropped() {
        if let Some(entity) = shown.entities.remove(&id) {
            commands.entity(entity).despawn();
        }
    }
    shown.is_complete = shown.ground.is_complete();
}

/// The mesh of a chunk.
fn mesh(arrays: ChunkArrays) -> Mesh {
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, arrays.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, arrays.normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, arrays.colors)
        .with_inserted_indices(Indices::U32(arrays.indices))
}

/// The height field of a chunk, and the place of its middle in the chunk: a height field is around its middle.
fn collider(arrays: &ChunkArrays) -> (Collider, Vec3) {
    let [width, height] = arrays.size;
    // Column by column, with the rows from the north.
    let columns = (0..width).flat_map(|column| (0..height).map(move |row| arrays.heights[row * width + column]));
    let sides = Vec3::new((width - 1) as f32 * arrays.cell, 1.0, (height - 1) as f32 * arrays.cell);
    let field = Array2::new(height, width, columns.collect());
    (SharedShape::heightfield(field, sides).into(), Vec3::new(0.5 * sides.x, 0.0, 0.5 * sides.z))
}
