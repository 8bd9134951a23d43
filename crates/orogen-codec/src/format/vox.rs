//! MagicaVoxel models (.vox, version 150): colored voxels, in models of at most 256 voxels along each side that a scene
//! graph places.
//!
//! Follows "MagicaVoxel .vox File Format" and its extension for scenes (ephtracy, voxel-model). The chunks are SIZE and
//! XYZI for each model, then nTRN, nGRP and nSHP, then the palette RGBA. x points east, y north and z up.

use std::io::{self, Write};

use orogen_grid::error::{Error, ErrorKind, Result};

/// Maximum number of voxels along a side of a model.
pub const MAX_SIDE: usize = 256;

/// Maximum number of voxels along a side of a scene, because `MagicaVoxel` supports positions from -1000 to 999.
pub const MAX_SCENE: usize = 2000;

/// Number of bytes in the header of a chunk.
const HEAD: u64 = 12;

/// A scene of voxels.
pub struct Scene<'a> {
    /// Number of voxels to the east, north and up.
    pub size: [usize; 3],
    /// The colors of the numbers 1 to 255, as red, green, blue and opacity.
    pub palette: &'a [[u8; 4]],
    /// Returns the color number of the voxel at a position in x, y and z; 0 if there is no voxel.
    pub voxel: &'a dyn Fn([usize; 3]) -> u8,
}

/// A model: its first voxel, and its size.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Model {
    start: [usize; 3],
    size: [usize; 3],
    count: u64,
}

impl Model {
    /// Calls `visit` for each voxel, with its position in the model and its color number.
    fn each(&self, scene: &Scene, mut visit: impl FnMut([u8; 3], u8) -> io::Result<()>) -> io::Result<()> {
        for z in 0..self.size[2] {
            for y in 0..self.size[1] {
                for x in 0..self.size[0] {
                    let color = (scene.voxel)([self.start[0] + x, self.start[1] + y, self.start[2] + z]);
                    if color != 0 {
                        visit([x as u8, y as u8, z as u8], color)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Number of bytes of the model's chunks.
    fn bytes(&self) -> u64 {
        HEAD + 12 + HEAD + 4 + 4 * self.count
    }
}

/// Checks that `MagicaVoxel` supports scenes of this size.
///
/// # Errors
/// If the scene is too large.
pub fn check([x, y, z]: [usize; 3]) -> Result<()> {
    if x.max(y).max(z) <= MAX_SCENE {
        return Ok(());
    }
    let message = format!(
        "a scene of MagicaVoxel has at most {MAX_SCENE} voxels along a side, and this one needs {x} x {y} x {z}; use a smaller window, a larger cell, or \
         another format"
    );
    Err(Error::new(ErrorKind::Request, message))
}

/// Writes a scene.
///
/// # Errors
/// If `out` fails, if the scene is too large for `MagicaVoxel`, or if the file would have more than 4 GiB.
pub fn write(out: &mut dyn Write, scene: &Scene) -> io::Result<()> {
    check(scene.size)?;
    let models = models(scene)?;
    let graph = graph(scene, &models);
    let length = models.iter().map(Model::bytes).sum::<u64>() + graph.len() as u64 + HEAD + 1024;
    let Ok(length) = u32::try_from(length) else {
        return Err(io::Error::other("a .vox file holds at most 4 GiB; use a smaller window or a larger cell"));
    };
    out.write_all(b"VOX ")?;
    out.write_all(&150u32.to_le_bytes())?;
    out.write_all(b"MAIN")?;
    out.write_all(&[0u32, length].map(u32::to_le_bytes).concat())?;
    for model in &models {
        let size = model.size.map(|side| (side as u32).to_le_bytes()).concat();
        out.write_all(&chunk(b"SIZE", &size))?;
        out.write_all(b"XYZI")?;
        out.write_all(&[4 + 4 * model.count as u32, 0, model.count as u32].map(u32::to_le_bytes).concat())?;
        model.each(scene, |[x, y, z], color| out.write_all(&[x, y, z, color]))?;
    }
    out.write_all(&graph)?;
    let mut colors: Vec<u8> = scene.palette.iter().take(255).flatten().copied().collect();
    colors.resize(1024, 255);
    out.write_all(&chunk(b"RGBA", &colors))
}

/// The models of the scene: boxes of at most [`MAX_SIDE`] along each side that have voxels.
fn models(scene: &Scene) -> io::Result<Vec<Model>> {
    let mut models = Vec::new();
    let starts = |side: usize| (0..side).step_by(MAX_SIDE);
    for z in starts(scene.size[2]) {
        for y in starts(scene.size[1]) {
            for x in starts(scene.size[0]) {
                let start = [x, y, z];
                let size = [0, 1, 2].map(|axis| (scene.size[axis] - start[axis]).min(MAX_SIDE));
                let mut model = Model { start, size, count: 0 };
                let mut count = 0;
                model.each(scene, |_, _| {
                    count += 1;
                    Ok(())
                })?;
                model.count = count;
                if count > 0 {
                    models.push(model);
                }
            }
        }
    }
    Ok(models)
}

/// The chunks of the scene graph: a transform of the whole scene, a group, and a transform and a shape for each model.
fn graph(scene: &Scene, models: &[Model]) -> Vec<u8> {
    let number = |numbers: &[i32]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    let text = |text: &str| [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat();
    // The number of the node, no attributes, its child, a reserved number, the layer, and one frame.
    let transform = |node: i32, child: i32, place: Option<String>| {
        let frame = place.map_or_else(|| number(&[0]), |place| [number(&[1]), text("_t"), text(&place)].concat());
        chunk(b"nTRN", &[number(&[node, 0, child, -1, 0, 1]), frame].concat())
    };
    let mut bytes = transform(0, 1, None);
    let children: Vec<i32> = (0..models.len() as i32).map(|model| 2 + 2 * model).collect();
    bytes.extend(chunk(b"nGRP", &[number(&[1, 0, children.len() as i32]), number(&children)].concat()));
    // A translation places the middle of a model. The scene stands on the ground, with its middle at the origin.
    let middle = [scene.size[0] as i64 / 2, scene.size[1] as i64 / 2, 0];
    for (model, node) in models.iter().zip(children) {
        let place = [0, 1, 2].map(|axis| (model.start[axis] + model.size[axis] / 2) as i64 - middle[axis]);
        bytes.extend(transform(node, node + 1, Some(format!("{} {} {}", place[0], place[1], place[2]))));
        // The number of the node, no attributes, and one model: its number, no attributes.
        bytes.extend(chunk(b"nSHP", &number(&[node + 1, 0, 1, node / 2 - 1, 0])));
    }
    bytes
}

/// A chunk without children.
fn chunk(name: &[u8; 4], content: &[u8]) -> Vec<u8> {
    [name.as_slice(), &(content.len() as u32).to_le_bytes(), &[0; 4], content].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The chunks of a file, as name and content.
    fn chunks(file: &[u8]) -> Vec<(String, &[u8])> {
        assert!(file.starts_with(b"VOX \x96\0\0\0MAIN\0\0\0\0"));
        let four = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!(four(16), file.len() - 20);
        let (mut at, mut found) = (20, Vec::new());
        while at < file.len() {
            let name = String::from_utf8(file[at..at + 4].to_vec()).unwrap();
            assert_eq!(four(at + 8), 0);
            found.push((name, &file[at + 12..at + 12 + four(at + 4)]));
            at += 12 + four(at + 4);
        }
        found
    }

    #[test]
    fn a_large_scene_has_several_models_and_no_empty_ones() {
        let scene = Scene {
            size: [600, 10, 300],
            palette: &[[1, 2, 3, 255], [4, 5, 6, 255]],
            voxel: &|[x, y, z]| u8::from(y == 3 && x % 100 == 50 && z < 20) * (1 + u8::from(x == 350)),
        };
        let mut file = Vec::new();
        write(&mut file, &scene).unwrap();
        let chunks = chunks(&file);
        let names: Vec<&str> = chunks.iter().map(|(name, _)| name.as_str()).collect();
        let models = ["SIZE", "XYZI"].repeat(3);
        let graph = [&["nTRN", "nGRP"][..], &["nTRN", "nSHP"].repeat(3), &["RGBA"]].concat();
        assert_eq!(names, [models, graph].concat());
        let voxels: Vec<&[u8]> =
            chunks.iter().filter(|(name, _)| name == "XYZI").flat_map(|(_, bytes)| bytes[4..].chunks(4)).collect();
        assert_eq!(voxels.len(), 6 * 20);
        assert_eq!(voxels.iter().filter(|voxel| voxel[3] == 2 && voxel[0] == 94 && voxel[1] == 3).count(), 20);
        // The third model is 88 voxels wide from 512 on. Its middle is 556 - 300 from the middle of the scene.
        let places: Vec<&[u8]> = chunks.iter().filter(|(name, _)| name == "nTRN").map(|(_, bytes)| *bytes).collect();
        assert!(places[3].ends_with(b"\x02\0\0\0_t\x09\0\0\x00256 0 128"), "{:?}", String::from_utf8_lossy(places[3]));
        assert_eq!(chunks.last().unwrap().1[..8], [1, 2, 3, 255, 4, 5, 6, 255]);
    }
}
