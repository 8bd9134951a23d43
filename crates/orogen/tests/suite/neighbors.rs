//! Windows that share a row or a column of samples agree there: colors and textures of meshes, normals of tiles for
//! engines.

use std::path::Path;

use orogen::export::mesh_cover::{self, SURFACES};
use orogen::export::mesh_tint::COLOR_RANGE;
use orogen::export::targets::frame::FrameSpec;
use orogen::export::targets::job::EngineJob;
use orogen::export::{ExportJob, LayerSource, registry, targets};
use orogen::io::file::OutputPolicy;
use orogen::io::test_folder::TestFolder;
use orogen::options::Options;
use orogen::{Progress, Recipe, Window, World};

fn recipe(size: &str) -> Recipe {
    let text = format!(
        "orogen = 1\n[world]\n{size}\ncell = 10\n[nodes.a]\nop = \"fbm\"\nwavelength = 700\n[nodes.b]\nop = \"remap\"\nsource = \"a\"\n\
         to = [-200, 2900]\n[outputs]\nheight = \"b\"\n"
    );
    Recipe::parse(&text, "test").unwrap()
}

/// Width, bytes per pixel and bytes of a PNG.
fn png(path: &Path) -> (usize, usize, Vec<u8>) {
    let bytes = std::fs::read(path).unwrap();
    pixels(&bytes)
}

fn pixels(bytes: &[u8]) -> (usize, usize, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    (info.width as usize, info.color_type.samples() * info.bit_depth as usize / 8, data)
}

fn column((width, size, data): &(usize, usize, Vec<u8>), at: usize) -> Vec<u8> {
    data.chunks_exact(width * size).flat_map(|row| row[at * size..(at + 1) * size].to_vec()).collect()
}

fn row((width, size, data): &(usize, usize, Vec<u8>), at: usize) -> Vec<u8> {
    data[at * width * size..(at + 1) * width * size].to_vec()
}

/// The colors of the vertices of a .ply file, row by row.
fn ply_colors(path: &Path) -> Vec<[u8; 3]> {
    let bytes = std::fs::read(path).unwrap();
    let end = b"end_header\n";
    let at = bytes.windows(end.len()).position(|window| window == end).unwrap() + end.len();
    let head = String::from_utf8_lossy(&bytes[..at]).into_owned();
    let count = head.lines().find_map(|line| line.strip_prefix("element vertex ")).unwrap().parse().unwrap();
    let properties = head.lines().take_while(|line| !line.starts_with("element face"));
    let (mut size, mut red) = (0, 0);
    for property in properties.filter_map(|line| line.strip_prefix("property ")) {
        if property.ends_with(" red") {
            red = size;
        }
        size += if property.starts_with("uchar") { 1 } else { 4 };
    }
    bytes[at..].chunks_exact(size).take(count).map(|corner| corner[red..red + 3].try_into().unwrap()).collect()
}

#[test]
fn colors_of_meshes() {
    let folder = TestFolder::new("neighbors-colors").unwrap();
    for (size, range) in [("size = [2400, 1600]", None), ("", None), ("size = [2400, 1600]", Some("0,900"))] {
        let world = World::open(recipe(size)).unwrap();
        let mut options = Options::default();
        range.iter().for_each(|range| options.give(&COLOR_RANGE, range).unwrap());
        let colors = [0, 60].map(|x| {
            let path = folder.join(format!("{x}.ply"));
            let job = ExportJob::new(registry::named("ply").unwrap())
                .with_window(Window::new(61, 40, 10.0).at(x, 20))
                .with_options(options.clone());
            let output = OutputPolicy::default().output(&path).unwrap();
            job.to_file(&world, &output, &Progress::none()).unwrap();
            ply_colors(&path)
        });
        let sides = [(&colors[0], 60), (&colors[1], 0)]
            .map(|(colors, at)| colors.chunks_exact(61).map(|row| row[at]).collect::<Vec<[u8; 3]>>());
        assert_eq!(sides[0].len(), 40);
        assert_eq!(sides[0], sides[1], "{size} {range:?}");
        assert!(colors[0].iter().any(|color| *color != colors[0][0]), "{size} {range:?}");
    }
}

#[test]
fn textures_of_surfaces() {
    let mut options = Options::default();
    options.give(&SURFACES, "").unwrap();
    let mut recipe = recipe("size = [2400, 1600]");
    mesh_cover::prepare(&mut recipe, &options);
    let world = World::open(recipe).unwrap();
    let progress = Progress::none();
    let pictures = [0, 60].map(|x| {
        let source = LayerSource::new(&world, "height", Window::new(61, 40, 10.0).at(x, 20), &progress).unwrap();
        mesh_cover::of(&source, &options, true).unwrap().unwrap()
    });
    for of in [
        |pictures: &mesh_cover::Pictures| pictures.base.clone(),
        |pictures: &mesh_cover::Pictures| pictures.material.clone(),
    ] {
        let [west, east] = pictures.each_ref().map(|picture| pixels(&of(picture)));
        assert_eq!(column(&west, 60), column(&east, 0));
        assert_ne!(column(&west, 59), column(&east, 0));
    }
}

#[test]
fn layers_of_engine_tiles() {
    let folder = TestFolder::new("neighbors-tiles").unwrap();
    for layer in ["normal", "splat", "albedo", "roughness", "occlusion", "slope", "curvature"] {
        let mut recipe = recipe("size = [2400, 2400]");
        let target = targets::list::named("unity").unwrap();
        let job = EngineJob::new(target, registry::named("png").unwrap())
            .with_layer(layer)
            .with_samples(FrameSpec::default().with_side(65).with_tiles([2, 2]));
        job.prepare(&mut recipe).unwrap();
        let world = World::open(recipe).unwrap();
        let output = OutputPolicy::default().output(folder.join(format!("{layer}.png"))).unwrap();
        let made = job.run(&world, &output, &Progress::none()).unwrap();
        assert_eq!(made.files.len(), 4, "{layer}");
        // Unity numbers rows from the south, and its pictures start in the north.
        let tile = |column: usize, south: usize| {
            let path = target.tile.unwrap()(column, 1 - south, 2);
            let file = made.files.iter().find(|file| file.to_string_lossy().contains(&path)).unwrap();
            png(file)
        };
        let [north_west, north_east, south_west] = [tile(0, 1), tile(1, 1), tile(0, 0)];
        let side = north_west.0;
        if layer == "splat" {
            // Weights have one pixel per cell, so tiles share none.
            assert_eq!(side, 64);
            continue;
        }
        assert_eq!(side, 65, "{layer}");
        assert_eq!(column(&north_west, 64), column(&north_east, 0), "{layer}");
        assert_ne!(column(&north_west, 63), column(&north_east, 0), "{layer}");
        assert_eq!(row(&north_west, 64), row(&south_west, 0), "{layer}");
    }
}
