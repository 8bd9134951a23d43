//! Detection of the kind of a file from its first bytes.

use std::io::{self, Read};
use std::path::Path;

use super::mark;
use crate::fs::{self, File};
use crate::samples;

/// Number of bytes that are read: enough for the head of a recipe, and for the longest title before a document's first
/// element.
const HEAD: u64 = 64 << 10;

/// Maximum length of a recipe whose mark is checked; longer recipes count as written by hand.
const LONGEST_RECIPE: u64 = 16 << 20;

/// A kind of file with a signature.
struct Kind {
    /// The name in messages: "it holds a PDF document".
    name: &'static str,
    /// The file extensions of this kind.
    extensions: &'static [&'static str],
    /// Whether these bytes are the start of such a file.
    begins: fn(&[u8]) -> bool,
}

/// All kinds with a signature. A format listed here is protected in both directions: files of other kinds are not
/// written over it, and it is not written over files of other kinds.
const KINDS: &[Kind] = &[
    Kind { name: "a PNG picture", extensions: &["png"], begins: |head| head.starts_with(b"\x89PNG\r\n\x1a\n") },
    Kind { name: "a GIF picture", extensions: &["gif"], begins: |head| head.starts_with(b"GIF8") },
    Kind { name: "a JPEG picture", extensions: &["jpg", "jpeg"], begins: |head| head.starts_with(b"\xff\xd8\xff") },
    Kind {
        name: "a WebP picture",
        extensions: &["webp"],
        begins: |head| head.starts_with(b"RIFF") && head.get(8..12) == Some(b"WEBP"),
    },
    Kind {
        name: "a TIFF picture",
        extensions: &["tif", "tiff"],
        begins: |head| [&b"II*\0"[..], b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| head.starts_with(magic)),
    },
    Kind { name: "a PDF document", extensions: &["pdf"], begins: |head| head.starts_with(b"%PDF-") },
    Kind { name: "a NumPy array", extensions: &["npy"], begins: |head| head.starts_with(b"\x93NUMPY") },
    Kind { name: "an OpenEXR picture", extensions: &["exr"], begins: |head| head.starts_with(b"\x76\x2f\x31\x01") },
    Kind { name: "a glTF mesh", extensions: &["glb"], begins: |head| head.starts_with(b"glTF") },
    Kind {
        name: "a PLY mesh",
        extensions: &["ply"],
        begins: |head| head.starts_with(b"ply\n") || head.starts_with(b"ply\r"),
    },
    Kind {
        name: "a PGM picture",
        extensions: &["pgm", "pnm"],
        begins: |head| matches!(head, [b'P', b'1'..=b'6', space, ..] if space.is_ascii_whitespace()),
    },
    Kind {
        name: "an SQLite database, such as a GeoPackage",
        extensions: &["gpkg", "sqlite", "mbtiles"],
        begins: |head| head.starts_with(b"SQLite format 3\0"),
    },
    Kind { name: "a PMTiles archive", extensions: &["pmtiles"], begins: |head| head.starts_with(b"PMTiles") },
    Kind { name: "a FlatGeobuf file", extensions: &["fgb"], begins: |head| head.starts_with(b"fgb") },
    Kind {
        name: "a 3MF model",
        extensions: &["3mf"],
        begins: |head| head.starts_with(b"PK\x03\x04") && holds(head.get(..64).unwrap_or(head), "[Content_Types].xml"),
    },
    Kind { name: "a ZIP archive", extensions: &["zip", "npz", "kmz"], begins: |head| head.starts_with(b"PK\x03\x04") },
    Kind {
        name: "a gzip archive, such as a schematic",
        extensions: &["gz", "tgz", "schem", "dat"],
        begins: |head| head.starts_with(b"\x1f\x8b\x08"),
    },
    Kind { name: "a MagicaVoxel model", extensions: &["vox"], begins: |head| head.starts_with(b"VOX \x96\0\0\0") },
    Kind {
        name: "a program",
        extensions: &[],
        begins: |head| head.starts_with(b"\x7fELF") || head.starts_with(b"#!/"),
    },
    Kind { name: "an SVG drawing", extensions: &["svg"], begins: |head| is_markup(head) && holds(head, "<svg") },
    Kind { name: "an HTML page", extensions: &["html", "htm"], begins: |head| is_markup(head) && holds(head, "<html") },
    Kind { name: "a Graphviz graph", extensions: &["dot", "gv"], begins: |head| head.starts_with(b"digraph ") },
    Kind { name: "a Wavefront material", extensions: &["mtl"], begins: |head| head.starts_with(b"newmtl") },
    Kind { name: "a table of points or classes", extensions: &["csv"], begins: is_table },
    Kind { name: "an ASCII grid", extensions: &["asc"], begins: |head| starts_with_word(head, "ncols") },
    Kind {
        name: "GeoJSON",
        extensions: &["geojson"],
        begins: |head| is_json(head) && (holds(head, "\"FeatureCollection\"") || holds(head, "\"Feature\"")),
    },
];

/// Kinds of text that people also write by hand, with the name for files written by Orogen.
const SIGNED: &[(&str, &str)] = &[
    ("json", "JSON of Orogen"),
    ("obj", "an Orogen mesh"),
    // Tiled removes the mark when it saves, so edited maps are kept.
    ("tmx", "a map of Orogen"),
    ("tmj", "a map of Orogen"),
    ("tsx", "a tileset of Orogen"),
    // LDtk and Godot also remove it.
    ("ldtk", "a project of Orogen"),
    ("tres", "a resource of Orogen"),
    ("tscn", "a scene of Orogen"),
    ("txt", "the settings of a map of Orogen"),
    ("mt", "a Luanti world of Orogen"),
    ("lua", "a Luanti mod of Orogen"),
    ("conf", "a Luanti mod of Orogen"),
];

/// Kinds without a signature, which begin with numbers.
const HEADERLESS: &[&str] = &["r16", "r32", "raw", "hgt", "mca"];

/// The content found at a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// An empty file.
    Empty,
    /// A recipe written by Orogen and unchanged since.
    OwnRecipe,
    /// A recipe written or changed by hand.
    Recipe,
    /// A kind with a signature.
    Known(&'static str),
    /// JSON written by Orogen.
    OwnText,
    /// Other text.
    Text,
    /// Unknown bytes.
    Bytes,
}

impl Found {
    /// Detects the content of the file at `path`.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn at(path: &Path) -> io::Result<Found> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        let mut head = Vec::new();
        file.take(HEAD).read_to_end(&mut head)?;
        Ok(match Found::of(&head) {
            Found::Recipe if length <= LONGEST_RECIPE => match fs::read_to_string(path) {
                Ok(text) if mark::is_intact(&text) => Found::OwnRecipe,
                _ => Found::Recipe,
            },
            // An STL has no signature, but its length follows from its number of triangles.
            Found::Bytes | Found::Text if is_binary_stl(&head, length) => Found::Known(STL),
            found => found,
        })
    }

    /// Detects the content by its first bytes. The mark of a recipe is not checked.
    fn of(head: &[u8]) -> Found {
        if head.is_empty() {
            return Found::Empty;
        }
        if let Some(kind) = KINDS.iter().find(|kind| (kind.begins)(head)) {
            return Found::Known(kind.name);
        }
        match is_text(head) {
            true if is_recipe(head) => Found::Recipe,
            true if head.starts_with(b"solid") && holds(head, "facet") => Found::Known(STL),
            true if holds(head, "Orogen") || holds(head, "\"height_min\"") && holds(head, "\"sha256\"") => {
                Found::OwnText
            }
            true => Found::Text,
            false => Found::Bytes,
        }
    }

    /// The name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Found::Empty => "nothing",
            Found::OwnRecipe | Found::Recipe => "a recipe",
            Found::Known(name) => name,
            Found::OwnText | Found::Text => "text",
            Found::Bytes => "data of an unknown kind",
        }
    }

    /// The reason why a file named `path` may not replace this content: the kind that is to be written; `None` if it
    /// may. `new` is the new content, if it is already known; it decides if the file extension does not.
    pub fn differs(self, path: &Path, new: Option<Found>) -> Option<&'static str> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let extension = extension.as_str();
        if self == Found::Empty {
            return None;
        }
        if let Some(kind) = KINDS.iter().find(|kind| kind.extensions.contains(&extension)) {
            return (self != Found::Known(kind.name)).then_some(kind.name);
        }
        if let Some((_, kind)) = SIGNED.iter().find(|(signed, _)| *signed == extension) {
            return (self != Found::OwnText).then_some(*kind);
        }
        match extension {
            "stl" => (self != Found::Known(STL)).then_some(STL),
            "toml" => (self != Found::OwnRecipe).then_some("a recipe of its own"),
            _ if HEADERLESS.contains(&extension) => (self != Found::Bytes).then_some("plain numbers"),
            _ => new.filter(|new| *new != self && *new != Found::Empty).map(Found::name),
        }
    }
}

const STL: &str = "an STL mesh";

fn holds(head: &[u8], word: &str) -> bool {
    samples::contains(head, word.as_bytes())
}

fn trimmed(head: &[u8]) -> &[u8] {
    head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start()
}

/// Whether the first line is the header of a table of points, or a list of class numbers.
fn is_table(head: &[u8]) -> bool {
    let line = head.split(|byte| *byte == b'\n').next().unwrap_or_default();
    let is_number = |byte: &u8| byte.is_ascii_digit() || *byte == b',';
    head.starts_with(b"x,y,") || line.contains(&b',') && line.iter().all(is_number)
}

fn is_markup(head: &[u8]) -> bool {
    trimmed(head).starts_with(b"<")
}

fn is_json(head: &[u8]) -> bool {
    trimmed(head).starts_with(b"{")
}

fn starts_with_word(head: &[u8], word: &str) -> bool {
    trimmed(head).get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
}

/// Whether the bytes can be text. The last character may be truncated.
fn is_text(head: &[u8]) -> bool {
    let control = |byte: &u8| *byte < 0x20 && !matches!(*byte, b'\t' | b'\n' | b'\r' | 0x0c | 0x1b);
    let whole = match std::str::from_utf8(head) {
        Ok(_) => true,
        Err(error) => error.error_len().is_none() && head.len() as u64 == HEAD,
    };
    whole && !head.iter().any(control)
}

/// Whether a line of TOML or a key of JSON states the version of the recipe format.
fn is_recipe(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    let toml = |line: &str| {
        let rest = line.trim_start().strip_prefix("orogen").map(str::trim_start);
        rest.and_then(|rest| rest.strip_prefix('='))
            .is_some_and(|rest| rest.trim_start().starts_with(|c: char| c.is_ascii_digit()))
    };
    let json = || {
        let key = text.split_once("\"orogen\"").map(|(_, rest)| rest.trim_start());
        key.and_then(|rest| rest.strip_prefix(':'))
            .is_some_and(|rest| rest.trim_start().starts_with(|c: char| c.is_ascii_digit()))
    };
    text.lines().any(toml) || json()
}

fn is_binary_stl(head: &[u8], length: u64) -> bool {
    let count = head.get(80..84).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    count.is_some_and(|count| 84 + 50 * u64::from(count) == length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_of_points_or_of_classes() {
        for (head, is_ours) in
            [("0,0,1,12\n0,1,1,2\n", true), ("x,y,z\n", true), ("12\n", false), ("name,age\n", false)]
        {
            assert_eq!(is_table(head.as_bytes()), is_ours, "{head}");
        }
    }

    #[test]
    fn every_kind_takes_its_own_place_and_no_other() {
        let samples: [(&str, &[u8]); 21] = [
            ("png", b"\x89PNG\r\n\x1a\n...."),
            ("gif", b"GIF89a...."),
            ("tif", b"II*\0...."),
            ("pdf", b"%PDF-1.7\n"),
            ("npy", b"\x93NUMPY\x01\0"),
            ("exr", b"\x76\x2f\x31\x01\x02\0\0\0"),
            ("glb", b"glTF\x02\0\0\0"),
            ("ply", b"ply\nformat binary_little_endian 1.0\n"),
            ("pgm", b"P5\n4 4\n65535\n\0\0"),
            ("gpkg", b"SQLite format 3\0"),
            ("fgb", b"fgb\x03fgb\x00"),
            ("svg", b"<?xml version=\"1.0\"?>\n<svg xmlns=\"\">"),
            ("schem", b"\x1f\x8b\x08\0"),
            ("vox", b"VOX \x96\0\0\0MAIN"),
            ("3mf", b"PK\x03\x04\x14\0\x08\x08\x08\0\0\0\x21\0\0\0\0\0\0\0\0\0\0\0\0\0\x13\0\0\0[Content_Types].xml"),
            ("zip", b"PK\x03\x04\x14\0\x08\x08\x08\0\0\0\x21\0\0\0\0\0\0\0\0\0\0\0\0\0\x05\0\0\0a.txt"),
            ("csv", b"x,y,z,kind\n1,2,3,tree\n"),
            ("asc", b"NCOLS 4\nNROWS 4\n"),
            ("geojson", b"{\"type\": \"FeatureCollection\"}"),
            ("json", b"{\"made_by\": \"Orogen 0.1.0\"}"),
            ("r16", b"\0\0\x01\0"),
        ];
        for (own, head) in samples {
            for (other, _) in samples {
                let (found, path) = (Found::of(head), format!("a.{other}"));
                assert_eq!(
                    found.differs(Path::new(&path), None).is_none(),
                    own == other,
                    "{own} under {other}: {found:?}"
                );
            }
        }
        let notes = b"My notes on the walk to the lake\n";
        for extension in ["png", "TIF", "r16", "hgt", "json", "toml", "obj", "svg", "stl", "tres", "ldtk"] {
            assert!(Found::of(notes).differs(Path::new(&format!("a.{extension}")), None).is_some(), "{extension}");
            assert!(Found::of(b"").differs(Path::new(&format!("a.{extension}")), None).is_none(), "{extension}");
        }
    }

    #[test]
    fn recipes_are_known_whatever_they_are_called() {
        for text in [
            "orogen = 1\n",
            "# mine\n\n  orogen=1",
            "\u{feff}orogen = 1",
            "{ \"orogen\": 1, \"nodes\": {} }",
            "about = \"x\"\norogen = 1",
        ] {
            assert_eq!(Found::of(text.trim_start_matches('\u{feff}').as_bytes()), Found::Recipe, "{text}");
        }
        for text in ["orogenic = 1", "# orogen = 1 is the first line", "[orogen]\na = 1"] {
            assert_ne!(Found::of(text.as_bytes()), Found::Recipe, "{text}");
        }
    }
}
