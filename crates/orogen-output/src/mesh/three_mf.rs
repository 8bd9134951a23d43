//! 3D Manufacturing Format (.3mf): a solid to print, with its unit.
//!
//! 3MF Core Specification 1.3: a ZIP archive with a model in XML.

use std::fmt::Write as _;
use std::io::{self, Write};

use orogen_grid::parallel;

use super::solid::Solid;
use orogen_grid::progress::Progress;
use orogen_io::format::zip_writer::ZipWriter;

/// Number of vertices or triangles that a thread writes at a time.
const PIECE: usize = 1 << 12;

const TYPES: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
    <Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\
    <Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\
    <Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";

const RELATIONS: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
    <Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
    <Relationship Target=\"/3D/3dmodel.model\" Id=\"model\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

const START: &str = concat!(
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
    "<model unit=\"millimeter\" xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n",
    "<metadata name=\"Application\">Orogen ",
    env!("CARGO_PKG_VERSION"),
    "</metadata>\n<resources><object id=\"1\" type=\"model\" name=\"terrain\"><mesh>\n<vertices>\n"
);

const END: &str = "</triangles>\n</mesh></object></resources>\n<build><item objectid=\"1\"/></build>\n</model>\n";

/// Writes a solid.
///
/// Fails if `out` fails, or if the file would be 4 GiB or larger.
pub fn write(out: &mut dyn Write, solid: &Solid, progress: &Progress) -> io::Result<()> {
    progress.expect((solid.corners.len() + solid.triangles.len()) as f64);
    let mut zip = ZipWriter::new(out);
    zip.file("[Content_Types].xml", |out| out.write_all(TYPES.as_bytes()))?;
    zip.file("_rels/.rels", |out| out.write_all(RELATIONS.as_bytes()))?;
    zip.file("3D/3dmodel.model", |out| {
        out.write_all(START.as_bytes())?;
        lines(out, &solid.corners, progress, |[x, y, z], text| {
            let _ = writeln!(text, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>");
        })?;
        out.write_all(b"</vertices>\n<triangles>\n")?;
        lines(out, &solid.triangles, progress, |[a, b, c], text| {
            let _ = writeln!(text, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>");
        })?;
        out.write_all(END.as_bytes())
    })?;
    zip.finish()
}

/// Writes a line for each item, made on all threads.
fn lines<T: Copy + Sync>(
    out: &mut dyn Write,
    items: &[T],
    progress: &Progress,
    emit: impl Fn(T, &mut String) + Sync,
) -> io::Result<()> {
    for band in items.chunks(PIECE * parallel::threads()) {
        let pieces: Vec<&[T]> = band.chunks(PIECE).collect();
        let made = parallel::map(&pieces, |piece| {
            let mut text = String::with_capacity(56 * piece.len());
            piece.iter().for_each(|item| emit(*item, &mut text));
            text
        });
        made.iter().try_for_each(|text| out.write_all(text.as_bytes()))?;
        progress.step(band.len() as f64)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use miniz_oxide::inflate::decompress_to_vec;
    use std::collections::BTreeMap;

    /// The files of an archive.
    fn unpacked(archive: &[u8]) -> BTreeMap<String, Vec<u8>> {
        let number =
            |at: usize, size: usize| archive[at..at + size].iter().rev().fold(0, |n, byte| n << 8 | usize::from(*byte));
        let end = archive.len() - 22;
        let mut at = number(end + 16, 4);
        let mut files = BTreeMap::new();
        for _ in 0..number(end + 10, 2) {
            let name = String::from_utf8(archive[at + 46..at + 46 + number(at + 28, 2)].to_vec()).unwrap();
            let start = number(at + 42, 4) + 30 + name.len();
            let bytes = decompress_to_vec(&archive[start..start + number(at + 20, 4)]).unwrap();
            assert_eq!(bytes.len(), number(at + 24, 4));
            at += 46 + name.len();
            files.insert(name, bytes);
        }
        files
    }

    #[test]
    fn the_model_has_the_unit_and_the_vertices_and_triangles_of_the_solid() {
        let corners = (0..9000).map(|k| [k as f32 / 7.0, -0.1, 1e-7 * k as f32]).collect();
        let solid = Solid { corners, triangles: (0..8998).map(|k| [k, k + 1, k + 2]).collect() };
        let mut bytes = Vec::new();
        write(&mut bytes, &solid, &Progress::none()).unwrap();
        let files = unpacked(&bytes);
        assert!(files.keys().eq(["3D/3dmodel.model", "[Content_Types].xml", "_rels/.rels"]));
        for name in ["[Content_Types].xml", "_rels/.rels"] {
            roxmltree::Document::parse(std::str::from_utf8(&files[name]).unwrap()).unwrap();
        }
        let text = std::str::from_utf8(&files["3D/3dmodel.model"]).unwrap();
        let model = roxmltree::Document::parse(text).unwrap();
        assert_eq!(model.root_element().attribute("unit"), Some("millimeter"));
        let read = |tag: &str, names: [&str; 3]| -> Vec<[f32; 3]> {
            let nodes = model.descendants().filter(|node| node.has_tag_name(tag));
            nodes.map(|node| names.map(|name| node.attribute(name).unwrap().parse().unwrap())).collect()
        };
        assert_eq!(read("vertex", ["x", "y", "z"]), solid.corners);
        let triangles: Vec<_> = solid.triangles.iter().map(|triangle| triangle.map(|corner| corner as f32)).collect();
        assert_eq!(read("triangle", ["v1", "v2", "v3"]), triangles);
        assert_eq!(model.descendants().filter(|node| node.attribute("objectid") == Some("1")).count(), 1);
    }
}
