//! Reads meshes back: the files contain the terrain in the correct orientation.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::{Arc, LazyLock, Mutex};

use orogen::export::{ExportJob, registry};
use orogen::grid::analysis::halo::Halo;
use orogen::io::file::OutputPolicy;
use orogen::io::test_folder::TestFolder;
use orogen::options::Options;
use orogen::output::map::Painter;
use orogen::output::mesh::solid::Print;
use orogen::output::mesh::{Model, Shape, Solid, Surface, adaptive, glb, obj, ply, stl, three_mf};
use orogen::{Grid, Progress, Recipe, Window, World};
use serde_json::Value;

pub type V3 = [f64; 3];

/// A bump in the north-east of land that falls to the south, so that every mirror image and shift differs.
pub fn land(width: usize, height: usize) -> Grid {
    let mut grid = Grid::filled(Window::new(width, height, 12.5).at(40, -30), 0.0);
    for j in 0..height {
        for i in 0..width {
            let (x, y) = (i as f32 / width as f32, j as f32 / height as f32);
            let bump = 400.0 * libm::exp2f(-40.0 * ((x - 0.8) * (x - 0.8) + (y - 0.2) * (y - 0.2)));
            grid.row_mut(j)[i] = 1000.0 - 90.0 * y + bump + 3.0 * ((i * 7 + j * 13) % 5) as f32;
        }
    }
    grid
}

pub fn surface<'a>(grid: &'a Grid, shape: &'a Shape) -> Surface<'a> {
    static ALONE: LazyLock<Halo> = LazyLock::new(Halo::default);
    Surface { grid, halo: &ALONE, shape, exaggeration: 1.0, painter: None, progress: None }
}

/// A mesh as read from a file: positions and normals as east, up, south.
#[derive(Debug, Default)]
struct Mesh {
    places: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    textures: Vec<[f32; 2]>,
    triangles: Vec<[usize; 3]>,
}

pub fn f32s(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect()
}

struct Glb {
    json: Value,
    binary: Vec<u8>,
}

impl Glb {
    fn read(bytes: &[u8]) -> Glb {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], word(4), word(8)), (&b"glTF"[..], 2, bytes.len()));
        let json = word(12);
        assert_eq!((&bytes[16..20], json % 4), (&b"JSON"[..], 0));
        let binary = 20 + json;
        assert_eq!((&bytes[binary + 4..binary + 8], word(binary)), (&b"BIN\0"[..], bytes.len() - binary - 8));
        let glb =
            Glb { json: serde_json::from_slice(&bytes[20..binary]).unwrap(), binary: bytes[binary + 8..].to_vec() };
        assert_eq!(glb.json["buffers"][0]["byteLength"], glb.binary.len());
        glb
    }

    /// The bytes of each element of an accessor.
    fn elements(&self, accessor: &Value, size: usize) -> Vec<&[u8]> {
        let accessor = &self.json["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &self.json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let number = |value: &Value| value.as_u64().unwrap_or(0) as usize;
        let stride = view.get("byteStride").map_or(size, number);
        let start = number(&view["byteOffset"]);
        let bytes = &self.binary[start..start + number(&view["byteLength"])];
        (0..number(&accessor["count"]))
            .map(|i| &bytes[number(&accessor["byteOffset"]) + i * stride..][..size])
            .collect()
    }

    fn mesh(&self, mesh: usize) -> Mesh {
        let primitive = &self.json["meshes"][mesh]["primitives"][0];
        let attributes = &primitive["attributes"];
        let vectors = |name: &str| -> Vec<[f32; 3]> {
            self.elements(&attributes[name], 12).iter().map(|bytes| f32s(bytes).try_into().unwrap()).collect()
        };
        let kind = &self.json["accessors"][primitive["indices"].as_u64().unwrap() as usize]["componentType"];
        let size = if *kind == 5123 { 2 } else { 4 };
        let index = |bytes: &[u8]| bytes.iter().rev().fold(0, |index, byte| index << 8 | usize::from(*byte));
        let indices: Vec<usize> = self.elements(&primitive["indices"], size).into_iter().map(index).collect();
        Mesh {
            places: vectors("POSITION"),
            normals: vectors("NORMAL"),
            textures: self
                .elements(&attributes["TEXCOORD_0"], 8)
                .iter()
                .map(|bytes| f32s(bytes).try_into().unwrap())
                .collect(),
            triangles: indices.chunks_exact(3).map(|three| three.try_into().unwrap()).collect(),
        }
    }
}

fn read_ply(bytes: &[u8]) -> (Mesh, Vec<[u8; 3]>) {
    let end = bytes.windows(11).position(|part| part == b"end_header\n").unwrap() + 11;
    let header = std::str::from_utf8(&bytes[..end]).unwrap();
    let count = |what: &str| -> usize {
        let line = header.lines().find(|line| line.starts_with(&format!("element {what} "))).unwrap();
        line.rsplit(' ').next().unwrap().parse().unwrap()
    };
    let colored = header.contains("uchar red");
    let stride = if colored { 27 } else { 32 };
    let (vertices, faces) = bytes[end..].split_at(count("vertex") * stride);
    assert_eq!(faces.len(), count("face") * 13);
    let (mut mesh, mut colors) = (Mesh::default(), Vec::new());
    for vertex in vertices.chunks_exact(stride) {
        let v = f32s(vertex);
        mesh.places.push([v[0], v[2], 0.0 - v[1]]);
        mesh.normals.push([v[3], v[5], 0.0 - v[4]]);
        match colored {
            true => colors.push([vertex[24], vertex[25], vertex[26]]),
            false => mesh.textures.push([v[6], 1.0 - v[7]]),
        }
    }
    for face in faces.chunks_exact(13) {
        assert_eq!(face[0], 3);
        mesh.triangles.push([1, 5, 9].map(|at| u32::from_le_bytes(face[at..at + 4].try_into().unwrap()) as usize));
    }
    (mesh, colors)
}

fn read_obj(text: &str) -> Mesh {
    let mut mesh = Mesh::default();
    for line in text.lines() {
        let mut words = line.split(' ');
        let word = words.next().unwrap();
        let rest: Vec<&str> = words.collect();
        let numbers = || -> Vec<f32> { rest.iter().map(|number| number.parse().unwrap()).collect() };
        match word {
            "v" => mesh.places.push(numbers()[..3].try_into().unwrap()),
            "vn" => mesh.normals.push(numbers().try_into().unwrap()),
            "vt" => mesh.textures.push([numbers()[0], 1.0 - numbers()[1]]),
            "f" => mesh.triangles.push(std::array::from_fn(|k| {
                let indices: Vec<usize> = rest[k].split('/').map(|index| index.parse().unwrap()).collect();
                assert!(indices.iter().all(|index| *index == indices[0]));
                indices[0] - 1
            })),
            _ => {}
        }
    }
    mesh
}

pub fn minus(a: V3, b: V3) -> V3 {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn wide(v: [f32; 3]) -> V3 {
    v.map(f64::from)
}

/// Checks that every vertex is a sample with its exact height, normals match the slope, triangles face up and cover the
/// grid.
fn check(mesh: &Mesh, grid: &Grid, shape: &Shape) {
    assert_eq!((mesh.places.len(), mesh.triangles.len()), (shape.corners(), shape.triangles()));
    let (width, height) = (grid.width(), grid.height());
    for (corner, [east, up, south]) in mesh.places.iter().enumerate() {
        let [column, row] = shape.sample(corner as u32);
        assert_eq!((*east, *south), (column as f32 * 12.5, row as f32 * 12.5));
        assert_eq!(up.to_bits(), grid[(column, row)].to_bits());
        let normal = wide(mesh.normals[corner]);
        assert!((dot(normal, normal) - 1.0).abs() < 1e-6 && normal[1] > 0.0);
        if (1..width - 1).contains(&column) && (1..height - 1).contains(&row) {
            let at = |i: usize, j: usize| f64::from(grid[(column + i - 1, row + j - 1)]);
            let east = (at(2, 0) - at(0, 0) + 2.0 * (at(2, 1) - at(0, 1)) + at(2, 2) - at(0, 2)) / 100.0;
            let south = (at(0, 2) - at(0, 0) + 2.0 * (at(1, 2) - at(1, 0)) + at(2, 2) - at(2, 0)) / 100.0;
            let expect = [-east, 1.0, -south];
            let length = dot(expect, expect).sqrt();
            assert!((0..3).all(|i| (normal[i] - expect[i] / length).abs() < 1e-4), "{normal:?} {expect:?}");
        }
        let middle = [(column as f64 + 0.5) / width as f64, (row as f64 + 0.5) / height as f64];
        if let Some(texture) = mesh.textures.get(corner) {
            assert!((0..2).all(|i| (f64::from(texture[i]) - middle[i]).abs() < 1e-6));
        }
    }
    assert!(mesh.textures.is_empty() || mesh.textures.len() == mesh.places.len());
    let mut area = 0.0;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| wide(mesh.places[corner]));
        let normal = cross(minus(b, a), minus(c, a));
        assert!(normal[1] > 0.0, "counter-clockwise from above, Y up");
        area += 0.5 * normal[1];
    }
    let expect = 12.5 * 12.5 * ((width - 1) * (height - 1)) as f64;
    assert!((area - expect).abs() < 1e-6 * expect, "{area} {expect}");
}

pub fn shapes(grid: &Grid) -> Vec<Shape> {
    vec![Shape::lattice(grid, 1).unwrap(), Shape::lattice(grid, 4).unwrap(), adaptive(grid, 8.0).unwrap()]
}

fn glb_bytes(levels: &[Surface], texture: Option<&[u8]>) -> Vec<u8> {
    let mut bytes = Vec::new();
    glb::write(
        &mut bytes,
        &Model {
            levels,
            texture,
            material: None,
            normal_maps: &[],
            bodies: &[],
            water: &[],
            objects: &[],
            extras: serde_json::Map::new(),
        },
    )
    .unwrap();
    bytes
}

#[test]
fn every_format_holds_the_land_the_right_way_round() {
    for (width, height) in [(37, 23), (2, 2), (300, 260)] {
        let grid = land(width, height);
        for shape in shapes(&grid) {
            let surface = surface(&grid, &shape);
            let glb = Glb::read(&glb_bytes(&[surface], None));
            check(&glb.mesh(0), &grid, &shape);
            let mut bytes = Vec::new();
            ply::write(&mut bytes, &surface, &["a comment".into()]).unwrap();
            check(&read_ply(&bytes).0, &grid, &shape);
            bytes.clear();
            obj::write(&mut bytes, &surface, &[], None).unwrap();
            check(&read_obj(std::str::from_utf8(&bytes).unwrap()), &grid, &shape);
        }
    }
}

#[test]
fn glb_tells_its_bounds_its_place_and_how_wide_its_indices_are() {
    for (side, kind) in [(40, 5123), (255, 5123), (257, 5125)] {
        let grid = land(side, side);
        let shape = Shape::lattice(&grid, 1).unwrap();
        let glb = Glb::read(&glb_bytes(&[surface(&grid, &shape)], None));
        let json = &glb.json;
        let primitive = &json["meshes"][0]["primitives"][0];
        assert_eq!(json["accessors"][primitive["indices"].as_u64().unwrap() as usize]["componentType"], kind);
        assert_eq!(json["nodes"][0]["translation"], serde_json::json!([500.0, 0.0, -375.0]));
        let (low, high) = grid.data().iter().fold((f32::MAX, f32::MIN), |(l, h), &z| (l.min(z), h.max(z)));
        let place = &json["accessors"][0];
        assert_eq!(place["min"], serde_json::json!([0.0, f64::from(low), 0.0]));
        let far = 12.5 * (side - 1) as f64;
        assert_eq!(place["max"], serde_json::json!([far, f64::from(high), far]));
        assert!(json.get("extensionsUsed").is_none() && json.get("images").is_none());
    }
}

#[test]
fn levels_of_detail_and_pictures_are_in_one_file() {
    let grid = land(64, 48);
    let painter = Painter::fit(&grid, 0.0);
    let mut picture = Vec::new();
    painter.write_png(&mut picture, &grid, None, &[]).unwrap();
    let shapes: Vec<Shape> = [2.0, 8.0, 32.0].iter().map(|error| adaptive(&grid, *error).unwrap()).collect();
    let levels: Vec<Surface> = shapes.iter().map(|shape| surface(&grid, shape)).collect();
    let glb = Glb::read(&glb_bytes(&levels, Some(&picture)));
    for (level, shape) in shapes.iter().enumerate() {
        check(&glb.mesh(level), &grid, shape);
        assert_eq!(glb.json["nodes"][level]["name"], format!("LOD{level}"));
    }
    assert!(shapes.windows(2).all(|pair| pair[1].triangles() < pair[0].triangles()));
    assert_eq!(glb.json["nodes"][0]["extensions"]["MSFT_lod"]["ids"], serde_json::json!([1, 2]));
    assert_eq!(glb.json["nodes"][0]["extras"]["MSFT_screencoverage"], serde_json::json!([0.5, 0.25, 0.125]));
    assert_eq!(glb.json["scenes"][0]["nodes"], serde_json::json!([0]));
    let view = &glb.json["bufferViews"][glb.json["images"][0]["bufferView"].as_u64().unwrap() as usize];
    let start = view["byteOffset"].as_u64().unwrap() as usize;
    assert_eq!(&glb.binary[start..start + picture.len()], picture);
    assert_eq!(view["byteLength"], picture.len());
}

#[test]
fn a_level_with_a_normal_map_has_tangents_and_a_material_of_its_own() {
    let grid = land(64, 48);
    let painter = Painter::fit(&grid, 0.0);
    let mut picture = Vec::new();
    painter.write_png(&mut picture, &grid, None, &[]).unwrap();
    let shapes: Vec<Shape> = [1, 4, 8].iter().map(|step| Shape::lattice(&grid, *step).unwrap()).collect();
    for colors in [false, true] {
        let painter = colors.then_some(&painter);
        let levels: Vec<Surface> = shapes.iter().map(|shape| Surface { painter, ..surface(&grid, shape) }).collect();
        let mut bytes = Vec::new();
        let model = Model {
            levels: &levels,
            texture: Some(&picture),
            material: Some(&picture),
            normal_maps: &[None, Some(picture.clone()), Some(picture.clone())],
            bodies: &[],
            water: &[],
            objects: &[],
            extras: serde_json::Map::new(),
        };
        glb::write(&mut bytes, &model).unwrap();
        let glb = Glb::read(&bytes);
        for (level, shape) in shapes.iter().enumerate() {
            check(&glb.mesh(level), &grid, shape);
            let primitive = &glb.json["meshes"][level]["primitives"][0];
            let material = &glb.json["materials"][primitive["material"].as_u64().unwrap() as usize];
            assert_eq!(material["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
            assert_eq!(material["occlusionTexture"]["index"], 1);
            if level == 0 {
                assert!(material.get("normalTexture").is_none() && primitive["attributes"].get("TANGENT").is_none());
                continue;
            }
            assert_eq!(material["normalTexture"]["index"], level + 1);
            let float = |bytes: &[u8], at: usize| f32::from_le_bytes(bytes[4 * at..4 * at + 4].try_into().unwrap());
            let normals = glb.elements(&primitive["attributes"]["NORMAL"], 12);
            let tangents = glb.elements(&primitive["attributes"]["TANGENT"], 16);
            assert_eq!(tangents.len(), shape.corners());
            for (normal, tangent) in normals.iter().zip(&tangents) {
                let dot = |a: &[u8], b: &[u8]| (0..3).map(|k| float(a, k) * float(b, k)).sum::<f32>();
                assert!((dot(tangent, tangent) - 1.0).abs() < 1e-5 && dot(normal, tangent).abs() < 1e-5);
                assert!(float(tangent, 0) > 0.0 && float(tangent, 2) == 0.0 && float(tangent, 3) == 1.0);
            }
        }
    }
}

#[test]
fn colors_of_corners_are_those_of_the_map() {
    let grid = land(31, 33);
    let shape = adaptive(&grid, 5.0).unwrap();
    let painter = Painter::fit(&grid, 950.0);
    let mut map = vec![0; 3 * 31 * 33];
    painter.paint(&grid, 0..33, &mut map);
    let surface = Surface { painter: Some(&painter), ..surface(&grid, &shape) };
    let mut bytes = Vec::new();
    ply::write(&mut bytes, &surface, &[]).unwrap();
    let (mesh, colors) = read_ply(&bytes);
    check(&mesh, &grid, &shape);
    let glb = Glb::read(&glb_bytes(&[surface], None));
    let lights = glb.elements(&glb.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"], 8);
    let mut text = Vec::new();
    obj::write(&mut text, &surface, &[], None).unwrap();
    let text = String::from_utf8(text).unwrap();
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("v ")).collect();
    assert_eq!(colors.len(), shape.corners());
    for (corner, color) in colors.iter().enumerate() {
        let [column, row] = shape.sample(corner as u32);
        assert_eq!(color, &map[3 * (row * 31 + column)..][..3]);
        for part in 0..3 {
            let share = f64::from(color[part]) / 255.0;
            let light = if share <= 0.04045 { share / 12.92 } else { libm::pow((share + 0.055) / 1.055, 2.4) };
            let got = u16::from_le_bytes([lights[corner][2 * part], lights[corner][2 * part + 1]]);
            assert!((f64::from(got) / 65535.0 - light).abs() < 1e-5);
            let number: f64 = lines[corner].split(' ').nth(4 + part).unwrap().parse().unwrap();
            assert!((number - share).abs() < 1e-6);
        }
        assert_eq!(lights[corner][6..], [255, 255]);
    }
}

#[test]
fn holes_are_left_out_or_refused() {
    let mut grid = land(20, 20);
    grid.row_mut(7)[9] = f32::NAN;
    let shape = Shape::lattice(&grid, 1).unwrap();
    let mut bytes = Vec::new();
    ply::write(&mut bytes, &surface(&grid, &shape), &[]).unwrap();
    let (mesh, _) = read_ply(&bytes);
    assert_eq!((mesh.places.len(), mesh.triangles.len()), (399, 2 * 19 * 19 - 4));
    assert!(mesh.places.iter().chain(&mesh.normals).flatten().all(|number| number.is_finite()));
    let glb = Glb::read(&glb_bytes(&[surface(&grid, &shape)], None));
    assert_eq!(glb.mesh(0).triangles, mesh.triangles);
    let print = Print::new(100.0).with_base(1.0);
    let error = Solid::new(&surface(&grid, &shape), &print).unwrap_err().to_string();
    assert!(error.contains("1 of 400 samples are nodata"), "{error}");
}

/// Accepts `left` bytes, then fails.
struct Full {
    left: usize,
}

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let take = bytes.len().min(self.left);
        self.left -= take;
        if take == 0 && !bytes.is_empty() { Err(io::ErrorKind::StorageFull.into()) } else { Ok(take) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_writer_that_fails_is_an_error_wherever_it_fails() {
    let grid = land(9, 9);
    let shape = adaptive(&grid, 2.0).unwrap();
    let surface = surface(&grid, &shape);
    type Writing<'a> = &'a dyn Fn(&mut dyn Write) -> io::Result<()>;
    let levels = [surface];
    let solid = Solid::new(&surface, &Print::new(10.0).with_base(1.0)).unwrap();
    let writers: [Writing; 5] = [
        &|out| {
            glb::write(
                out,
                &Model {
                    levels: &levels,
                    texture: Some(&[1, 2, 3]),
                    material: None,
                    normal_maps: &[],
                    bodies: &[],
                    water: &[],
                    objects: &[],
                    extras: serde_json::Map::new(),
                },
            )
        },
        &|out| ply::write(out, &surface, &[]),
        &|out| obj::write(out, &surface, &[], Some("a.mtl")),
        &|out| stl::write(out, &solid, &Progress::none()),
        &|out| three_mf::write(out, &solid, &Progress::none()),
    ];
    for write in writers {
        let mut bytes = Vec::new();
        write(&mut bytes).unwrap();
        for left in (0..bytes.len()).step_by(7).chain([bytes.len() - 1]) {
            assert!(write(&mut Full { left }).is_err(), "after {left} of {} bytes", bytes.len());
        }
    }
}

fn world() -> World {
    let preset = orogen::presets::find("hills").unwrap();
    World::open(preset.recipe().unwrap()).unwrap()
}

fn export(world: &World, window: Window, path: &std::path::Path, given: &[(&str, &str)]) -> Result<String, String> {
    export_with(world, window, path, given, &Progress::none())
}

fn export_with(
    world: &World,
    window: Window,
    path: &std::path::Path,
    given: &[(&str, &str)],
    progress: &Progress,
) -> Result<String, String> {
    let format = registry::of_path(path).map_err(|error| error.to_string())?;
    let mut options = Options::default();
    for (name, text) in given {
        let spec = format.options.iter().find(|spec| spec.name == *name).unwrap();
        options.give(spec, text).map_err(|error| error.to_string())?;
    }
    let job = ExportJob::new(format).with_window(window).with_options(options);
    let output = OutputPolicy::default().output(path).map_err(|error| error.to_string())?;
    job.to_file(world, &output, progress).map(|written| written.words).map_err(|error| error.to_string())
}

#[test]
fn exports_are_whole_and_the_same_on_any_number_of_threads() {
    let folder = TestFolder::new("meshes").unwrap();
    let (world, window) = (world(), Window::new(150, 90, 20.0).at(100, 100));
    type Given<'a> = &'a [(&'a str, &'a str)];
    let cases: [(&str, Given, &str); 10] = [
        ("a.glb", &[], "26522 triangles"),
        (
            "b.glb",
            &[("max-error", "1"), ("lods", "3"), ("color", "vertex")],
            "no sample more than 1 m above or below them",
        ),
        ("c.obj", &[("max-error", "2"), ("height-curve", "0:0,0.5:0.2,1:1")], "no sample more than 2 m"),
        ("d.ply", &[("exaggeration", "1.5")], "26522 triangles"),
        ("e.stl", &[("print-size", "80"), ("base", "2")], "26522 triangles and a base, 80 x 47.8 x "),
        ("f.obj", &[("color", "none")], "26522 triangles"),
        ("g.3mf", &[("max-error", "1")], "150 x 89.6 x "),
        (
            "h.stl",
            &[("hollow", "1"), ("text", "H"), ("bed", "100x150.5x90")],
            "letters of --text have a size of 2.6 mm",
        ),
        ("j.stl", &[("text", "Alp"), ("text-style", "engraved"), ("max-error", "2")], "no sample more than 2 m"),
        ("i.3mf", &[("cut", "200"), ("exaggeration", "0.01")], "less than a layer of 0.2 mm; use an exaggeration of"),
    ];
    let all = |threads: usize| -> BTreeMap<String, Vec<u8>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            for (name, given, expect) in cases {
                let words = export(&world, window, &folder.join(name), given).unwrap();
                assert!(words.contains(expect), "{words}");
            }
        });
        let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap());
        files.map(|file| (file.file_name().into_string().unwrap(), std::fs::read(file.path()).unwrap())).collect()
    };
    let one = all(1);
    let names: Vec<&str> = one.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        [
            "a.glb",
            "b.glb",
            "c-texture.png",
            "c.mtl",
            "c.obj",
            "d.ply",
            "e.stl",
            "f.obj",
            "g.3mf",
            "h.stl",
            "i.3mf",
            "j.stl"
        ]
    );
    assert!(one == all(3));
    let obj = String::from_utf8(one["c.obj"].clone()).unwrap();
    assert!(
        obj.contains("mtllib c.mtl\n")
            && obj.contains("the first sample, at the origin, is 2000 m east and 2000 m south")
    );
    assert!(String::from_utf8(one["c.mtl"].clone()).unwrap().contains("map_Kd -clamp on c-texture.png\n"));
    let heights = world.window("height", &window).unwrap();
    let high = |mesh: &Mesh| mesh.places.iter().map(|place| place[1]).fold(f32::MIN, f32::max);
    let highest = heights.data().iter().copied().fold(f32::MIN, f32::max);
    assert_eq!(high(&Glb::read(&one["a.glb"]).mesh(0)), highest);
    assert_eq!(high(&read_ply(&one["d.ply"]).0), highest * 1.5);

    for (name, given, window, expect) in [
        ("x.glb", &[][..], Window::new(1, 9, 20.0), "at least 2 x 2 samples, and there are 1 x 9"),
        ("x.obj", &[("height-curve", "0:0,0:1")], window, "0 follows 0"),
        ("x.ply", &[("color", "texture")], window, "cannot hold a texture; use --color vertex"),
        ("x.stl", &[("bed", "220x220")], window, "such as 220x220x250"),
        ("x.3mf", &[("bed", "100x100x100")], window, "has room for 100 x 100 x 100 mm; use --print-size 100 or less"),
        ("x.3mf", &[("cut", "200"), ("hollow", "2"), ("max-error", "3")], window, "leave out --max-error"),
        (
            "x.stl",
            &[("cut", "200"), ("text", "A"), ("text-style", "engraved")],
            window,
            "engraved does not apply with --cut",
        ),
        ("x.stl", &[("text-style", "engraved")], window, "--text-style applies to the letters of --text"),
        ("x.3mf", &[("cut", "200"), ("hollow", "3")], window, "walls of 3 mm need a base that is thicker than 3 mm"),
    ] {
        let why = export(&world, window, &folder.join(name), given).unwrap_err();
        assert!(why.contains(expect), "{why}");
    }
    assert_eq!(folder.names().len(), 12);
}

#[test]
fn triangles_have_their_share_of_the_progress() {
    let world = world();
    let folder = TestFolder::new("mesh-progress").unwrap();
    let path = folder.join("a.glb");
    for given in [&[][..], &[("max-error", "0.5")]] {
        let shares = Arc::new(Mutex::new(Vec::new()));
        let heard = Arc::clone(&shares);
        let progress = Progress::new(move |share| heard.lock().unwrap().push(share));
        export_with(&world, Window::new(200, 160, 25.0), &path, given, &progress).unwrap();
        let shares = shares.lock().unwrap();
        assert!(shares.windows(2).all(|pair| pair[0] < pair[1]), "{shares:?}");
        // Computing the heights of one fractal is only a small share of the work.
        assert!(shares.iter().any(|share| (0.3..0.99).contains(share)), "{shares:?}");
    }
}

#[test]
fn a_mesh_far_from_the_origin_is_as_precise_as_one_at_it() {
    let text =
        "orogen = 1\n[world]\ncell = 0.5\n[nodes.a]\nop = \"fbm\"\nwavelength = 40.0\n[outputs]\nheight = \"a\"\n";
    let world = World::open(Recipe::parse(text, "test").unwrap()).unwrap();
    let window = Window::new(30, 30, 0.5).at(2_000_000_001, -3_000_000_003);
    let grid = world.window("height", &window).unwrap();
    let shape = Shape::lattice(&grid, 1).unwrap();
    let glb = Glb::read(&glb_bytes(&[surface(&grid, &shape)], None));
    assert_eq!(glb.json["nodes"][0]["translation"], serde_json::json!([1_000_000_000.5, 0.0, -1_500_000_001.5]));
    let mesh = glb.mesh(0);
    assert_eq!(mesh.places[1][0], 0.5);
    assert_eq!(mesh.places[899], [14.5, grid[(29, 29)], 14.5]);
}
