//! glTF 2.0 as one binary file (.glb).
//!
//! The Khronos Group's specification, 2.0.1. Metres; X east, Y up, Z south, with the first sample of the grid at the
//! node's origin; the node's translation is the position of that sample in its world. Vertices are interleaved:
//! position, normal, texture coordinate and, on request, color (linear, four u16) and tangent (eastward along the
//! ground). Indices have two bytes if they fit. Objects are instances by EXT_mesh_gpu_instancing: a reader without
//! support for it shows one placeholder of each kind. Levels of detail use MSFT_lod: a reader without support for it
//! shows the first level.

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use super::body::BodyMesh;
use super::bounds::bounds;
use super::normal_map::tangent;
use super::objects::{CORNERS, ObjectMesh};
use super::surface::{Corner, Surface, Wanted, push};
use super::water::WaterMesh;
use orogen_grid::error::{Error, ErrorKind};

/// A surface in one or several levels of detail, the finest first, over the same grid.
pub struct Model<'a> {
    /// The levels; empty if there are bodies instead.
    pub levels: &'a [Surface<'a>],
    /// A PNG picture of the grid with one pixel per sample.
    pub texture: Option<&'a [u8]>,
    /// A PNG picture of the grid to go with the texture: occlusion in red, roughness in green, metalness in blue.
    pub material: Option<&'a [u8]>,
    /// A PNG normal map per level, where it has one; empty if no level has one.
    pub normal_maps: &'a [Option<Vec<u8>>],
    /// Bodies that are not made from a grid: one node each, with one material and vertex colors.
    pub bodies: &'a [BodyMesh],
    /// Water: one node and one translucent material per mesh.
    pub water: &'a [WaterMesh],
    /// Objects: for each kind one node, a placeholder mesh and its instances.
    pub objects: &'a [ObjectMesh],
    /// Additional properties of the node (`extras`).
    pub extras: Map<String, Value>,
}

/// "glTF", "JSON" and "BIN\0" as little-endian integers.
const MAGIC: u32 = 0x4654_6C67;
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// Base of the screen coverages down to which levels of detail are meant to be shown: 1/2 for the first, 1/4 for the
/// second, and so on.
const COVERAGE: f64 = 0.5;

/// Writes a model.
///
/// Fails if `out` fails, or if the model exceeds the format's limit of 4 GiB.
pub fn write(out: &mut dyn Write, model: &Model) -> io::Result<()> {
    let colors = model.levels.iter().any(|level| level.painter.is_some());
    let document = Document::new(model, colors);
    let json = padded(document.json.to_string().into_bytes(), b' ');
    let length = 12 + 8 + json.len() as u64 + 8 + document.length;
    if length > u64::from(u32::MAX) {
        let message = format!(
            "a .glb file holds at most 4 GiB, and this mesh needs {}; use --max-error, a smaller window or a larger cell",
            orogen_grid::words::bytes(length)
        );
        return Err(Error::new(ErrorKind::Request, message).into());
    }
    let words =
        |out: &mut dyn Write, words: &[u32]| words.iter().try_for_each(|word| out.write_all(&word.to_le_bytes()));
    words(out, &[MAGIC, 2, length as u32, json.len() as u32, JSON])?;
    out.write_all(&json)?;
    words(out, &[document.length as u32, BIN])?;
    let light: Vec<u16> = (0..=255).map(linear).collect();
    for (nth, level) in model.levels.iter().enumerate() {
        let tangents = normal_map(model, nth).is_some();
        level.corners(out, Wanted { normals: true, colors }, |corner, bytes| {
            vertex(corner, bytes);
            if colors {
                let [r, g, b] = corner.color.map(|part| light[usize::from(part)]);
                [r, g, b, u16::MAX].iter().for_each(|part| bytes.extend_from_slice(&part.to_le_bytes()));
            }
            if tangents {
                push(&tangent(corner.normal), bytes);
                // The bitangent is the cross product itself: north.
                push(&[1.0], bytes);
            }
        })?;
        match narrow(level) {
            true => level.triangles(out, |triangle, bytes| {
                triangle.iter().for_each(|&corner| bytes.extend_from_slice(&(corner as u16).to_le_bytes()));
            })?,
            false => level.triangles(out, |triangle, bytes| {
                triangle.iter().for_each(|corner| bytes.extend_from_slice(&corner.to_le_bytes()));
            })?,
        }
        pad(out, indices(level))?;
    }
    for picture in pictures(model) {
        out.write_all(picture)?;
        pad(out, picture.len() as u64)?;
    }
    for body in model.bodies {
        let mut bytes = Vec::new();
        for ((corner, normal), color) in body.corners.iter().zip(&body.normals).zip(&body.colors) {
            push(corner, &mut bytes);
            push(normal, &mut bytes);
            let [r, g, b] = color.map(|part| light[usize::from(part)]);
            [r, g, b, u16::MAX].iter().for_each(|part| bytes.extend_from_slice(&part.to_le_bytes()));
        }
        out.write_all(&bytes)?;
        bytes.clear();
        bytes.extend(body.triangles.iter().flatten().flat_map(|corner| corner.to_le_bytes()));
        out.write_all(&bytes)?;
    }
    for water in model.water {
        let mut bytes = Vec::new();
        for (corner, normal) in water.corners.iter().zip(water.normals()) {
            push(corner, &mut bytes);
            push(&normal, &mut bytes);
        }
        out.write_all(&bytes)?;
        bytes.clear();
        bytes.extend(water.triangles.iter().flatten().flat_map(|corner| corner.to_le_bytes()));
        out.write_all(&bytes)?;
    }
    for kind in model.objects {
        let mut bytes = Vec::new();
        kind.placeholder().iter().flatten().for_each(|numbers| push(numbers, &mut bytes));
        kind.instances.iter().for_each(|instance| push(&instance.position, &mut bytes));
        kind.instances.iter().for_each(|instance| push(&instance.rotation(), &mut bytes));
        kind.instances.iter().for_each(|instance| push(&[instance.size; 3], &mut bytes));
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// The pictures of the ground's materials, in file order.
fn pictures<'a>(model: &Model<'a>) -> impl Iterator<Item = &'a [u8]> {
    let base = model.texture.into_iter().flat_map(|texture| [Some(texture), model.material]).flatten();
    base.chain(model.normal_maps.iter().flatten().map(Vec::as_slice))
}

/// The normal map of a level.
fn normal_map<'a>(model: &Model<'a>, level: usize) -> Option<&'a [u8]> {
    model.normal_maps.get(level)?.as_deref()
}

/// Bytes per vertex, with a color or with a tangent.
fn stride(colors: bool, tangents: bool) -> u32 {
    32 + if colors { 8 } else { 0 } + if tangents { 16 } else { 0 }
}

fn vertex(corner: &Corner, bytes: &mut Vec<u8>) {
    push(&[corner.east, corner.height, corner.south], bytes);
    push(&corner.normal, bytes);
    push(&corner.texture, bytes);
}

/// Whether the indices of a level have two bytes each; 65535 is not a valid index.
fn narrow(level: &Surface) -> bool {
    level.shape.corners() <= usize::from(u16::MAX)
}

/// Size of the indices of a level in bytes.
fn indices(level: &Surface) -> u64 {
    level.shape.triangles() as u64 * if narrow(level) { 6 } else { 12 }
}

/// Linear light of an sRGB byte, in units of 1/65535.
fn linear(byte: u32) -> u16 {
    let share = f64::from(byte) / 255.0;
    let light = if share <= 0.04045 { share / 12.92 } else { libm::pow((share + 0.055) / 1.055, 2.4) };
    (light * 65535.0).round() as u16
}

fn padded(mut bytes: Vec<u8>, with: u8) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(4), with);
    bytes
}

fn pad(out: &mut dyn Write, written: u64) -> io::Result<()> {
    out.write_all(&[0; 3][..(written.next_multiple_of(4) - written) as usize])
}

/// The arrays of the JSON part, and the length of the binary part.
#[derive(Default)]
struct Arrays {
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    length: u64,
}

/// The triangles of a mesh: size in bytes and type of the indices, and their number.
type Indices = (u64, u32, usize);

impl Arrays {
    fn view(&mut self, bytes: u64, mut view: Value) -> usize {
        view["buffer"] = json!(0);
        view["byteOffset"] = json!(self.length);
        view["byteLength"] = json!(bytes);
        self.length += bytes.next_multiple_of(4);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds interleaved vertices with these attributes: name, bytes from the start of a vertex, and type. The first
    /// attribute is the position, whose minimum and maximum values are `bounds`; a color has four u16. Returns the
    /// primitive.
    fn primitive(
        &mut self,
        (corners, stride): (usize, u32),
        bounds: [[f32; 3]; 2],
        attributes: &[(&str, u32, &str)],
        indices: Option<Indices>,
        material: usize,
    ) -> Value {
        let vertices =
            self.view(corners as u64 * u64::from(stride), json!({"byteStride": stride, "target": ARRAY_BUFFER}));
        let indices = indices.map(|(bytes, kind, count)| {
            let view = self.view(bytes, json!({"target": ELEMENT_ARRAY_BUFFER}));
            json!({"bufferView": view, "componentType": kind, "count": count, "type": "SCALAR"})
        });
        // As f64: the shortest decimal digits of an f32 are not its exact value.
        let [least, greatest] = bounds.map(|corner| corner.map(f64::from));
        let mut names = json!({});
        for (nth, (name, offset, kind)) in attributes.iter().enumerate() {
            let mut accessor = json!({
                "bufferView": vertices, "byteOffset": offset, "componentType": F32, "count": corners, "type": kind
            });
            if nth == 0 {
                accessor["min"] = json!(least);
                accessor["max"] = json!(greatest);
            }
            if *name == COLOR {
                accessor["componentType"] = json!(U16);
                accessor["normalized"] = json!(true);
            }
            names[name] = json!(self.accessor(accessor));
        }
        let mut primitive = json!({"attributes": names});
        if let Some(indices) = indices {
            primitive["indices"] = json!(self.accessor(indices));
        }
        primitive["material"] = json!(material);
        primitive
    }
}

const POSITION: (&str, u32, &str) = ("POSITION", 0, "VEC3");
const NORMAL: (&str, u32, &str) = ("NORMAL", 12, "VEC3");
const COLOR: &str = "COLOR_0";

/// The JSON part, and the length of the binary part.
struct Document {
    json: Value,
    length: u64,
}

impl Document {
    fn new(model: &Model, colors: bool) -> Document {
        let mut arrays = Arrays::default();
        // Levels without a normal map share a material; the others have one each.
        let has_map = |level: usize| normal_map(model, level).is_some();
        let shared = usize::from((0..model.levels.len()).any(|level| !has_map(level)));
        for (nth, level) in model.levels.iter().enumerate() {
            let mut attributes = vec![POSITION, NORMAL, ("TEXCOORD_0", 24, "VEC2")];
            if colors {
                attributes.push((COLOR, 32, "VEC4"));
            }
            if has_map(nth) {
                attributes.push(("TANGENT", stride(colors, false), "VEC4"));
            }
            let material = if has_map(nth) { shared + (0..nth).filter(|level| has_map(*level)).count() } else { 0 };
            let kind = if narrow(level) { U16 } else { U32 };
            let vertices = (level.shape.corners(), stride(colors, has_map(nth)));
            let triangles = (indices(level), kind, 3 * level.shape.triangles());
            let primitive = arrays.primitive(vertices, level.bounds(), &attributes, Some(triangles), material);
            arrays.meshes.push(json!({"primitives": [primitive]}));
        }
        let mut material =
            json!({"name": "terrain", "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 1.0}});
        let mut json = json!({"asset": {"version": "2.0", "generator": concat!("Orogen ", env!("CARGO_PKG_VERSION"))}});
        let images: Vec<Value> = pictures(model)
            .map(|picture| json!({"bufferView": arrays.view(picture.len() as u64, json!({})), "mimeType": "image/png"}))
            .collect();
        if !images.is_empty() {
            if model.texture.is_some() {
                material["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
            }
            if model.texture.and(model.material).is_some() {
                material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = json!({"index": 1});
                material["pbrMetallicRoughness"]["metallicFactor"] = json!(1.0);
                material["occlusionTexture"] = json!({"index": 1});
            }
            let textures: Vec<Value> = (0..images.len()).map(|k| json!({"source": k, "sampler": 0})).collect();
            json["images"] = json!(images);
            // Linear and mipmapped filtering; clamped to the edge.
            json["samplers"] = json!([{"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}]);
            json["textures"] = json!(textures);
        }
        let mut materials = vec![material.clone(); shared];
        let base = usize::from(model.texture.is_some()) + usize::from(model.texture.and(model.material).is_some());
        for (nth, level) in (0..model.levels.len()).filter(|level| has_map(*level)).enumerate() {
            let mut material = material.clone();
            if level > 0 {
                material["name"] = json!(format!("terrain LOD{level}"));
            }
            material["normalTexture"] = json!({"index": base + nth});
            materials.push(material);
        }
        if !model.bodies.is_empty() {
            material["name"] = json!("blocks");
            materials.push(material);
        }
        // Bodies and water have indices of four bytes.
        let triangles = |triangles: &[[u32; 3]]| Some((12 * triangles.len() as u64, U32, 3 * triangles.len()));
        for body in model.bodies {
            let attributes = [POSITION, NORMAL, (COLOR, 24, "VEC4")];
            let vertices = (body.corners.len(), 32);
            let material = materials.len() - 1;
            let primitive =
                arrays.primitive(vertices, body.bounds(), &attributes, triangles(&body.triangles), material);
            arrays.meshes.push(json!({"name": body.name, "primitives": [primitive]}));
        }
        for water in model.water {
            let vertices = (water.corners.len(), 24);
            let (bounds, material) = (bounds(&water.corners), materials.len());
            let primitive =
                arrays.primitive(vertices, bounds, &[POSITION, NORMAL], triangles(&water.triangles), material);
            arrays.meshes.push(json!({"name": water.name, "primitives": [primitive]}));
            let color = water.color.map(f64::from);
            materials.push(json!({
                "name": water.name,
                "alphaMode": "BLEND",
                "pbrMetallicRoughness": {"baseColorFactor": color, "metallicFactor": 0.0, "roughnessFactor": 0.1}
            }));
        }
        let mut instanced = Vec::new();
        for kind in model.objects {
            let bounds = bounds(&kind.placeholder().map(|[position, _]| position));
            let primitive = arrays.primitive((CORNERS, 24), bounds, &[POSITION, NORMAL], None, materials.len());
            arrays.meshes.push(json!({"name": kind.name, "primitives": [primitive]}));
            let [red, green, blue] = kind.color.map(f64::from);
            materials.push(json!({
                "name": kind.name,
                "pbrMetallicRoughness": {"baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
            }));
            let count = kind.instances.len() as u64;
            let mut each = |parts: u64, kind: &str| {
                let view = arrays.view(count * parts * 4, json!({}));
                arrays.accessor(json!({"bufferView": view, "componentType": F32, "count": count, "type": kind}))
            };
            let attributes =
                json!({"TRANSLATION": each(3, "VEC3"), "ROTATION": each(4, "VEC4"), "SCALE": each(3, "VEC3")});
            instanced.push(json!({
                "name": kind.name,
                "mesh": arrays.meshes.len() - 1,
                "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
            }));
        }
        let levels = model.levels.len();
        let mut nodes: Vec<Value> = (0..levels).map(|level| node(model, level)).collect();
        let mut shown: Vec<usize> = (0..levels.min(1)).collect();
        let names =
            model.bodies.iter().map(|body| body.name.as_str()).chain(model.water.iter().map(|water| water.name));
        for (k, name) in names.enumerate() {
            shown.push(nodes.len());
            nodes.push(placed(model, json!({"name": name, "mesh": levels + k})));
        }
        for node in instanced {
            shown.push(nodes.len());
            nodes.push(placed(model, node));
        }
        let lod = (levels > 1).then_some("MSFT_lod");
        let instancing = (!model.objects.is_empty()).then_some("EXT_mesh_gpu_instancing");
        let extensions: Vec<&str> = lod.into_iter().chain(instancing).collect();
        if !extensions.is_empty() {
            json["extensionsUsed"] = json!(extensions);
        }
        json["scene"] = json!(0);
        json["scenes"] = json!([{"nodes": shown}]);
        json["nodes"] = json!(nodes);
        json["meshes"] = json!(arrays.meshes);
        json["materials"] = json!(materials);
        json["accessors"] = json!(arrays.accessors);
        json["bufferViews"] = json!(arrays.views);
        json["buffers"] = json!([{"byteLength": arrays.length}]);
        Document { json, length: arrays.length }
    }
}

/// A node translated to the position of the grid, or of the bodies, in the world.
fn placed(model: &Model, mut node: Value) -> Value {
    let of_grid = model.levels.first().map(|level| level.grid.window());
    let origin = of_grid.map(|window| [window.east(0), window.south(0)]);
    let Some([east, south]) = origin.or(model.bodies.first().map(|body| body.origin)) else { return node };
    if east != 0.0 || south != 0.0 {
        node["translation"] = json!([east, 0.0, south]);
    }
    node
}

/// The node of a level. The node of the first level refers to the others.
fn node(model: &Model, level: usize) -> Value {
    let levels = model.levels.len();
    let name = if levels == 1 { "terrain".to_string() } else { format!("LOD{level}") };
    let mut node = placed(model, json!({"name": name, "mesh": level}));
    if level == 0 {
        node["extras"] = Value::Object(model.extras.clone());
        if levels > 1 {
            let others: Vec<usize> = (1..levels).collect();
            node["extensions"] = json!({"MSFT_lod": {"ids": others}});
            let coverage: Vec<f64> = (1..=levels as i32).map(|level| libm::pow(COVERAGE, f64::from(level))).collect();
            node["extras"]["MSFT_screencoverage"] = json!(coverage);
        }
    }
    node
}
