//! `/objects.geojson`: objects, rivers, lakes, summits, contours, coasts and roads of a window, as `orogen export`
//! writes them.

use std::io::{self, Write};
use std::path::Path;

use axum::body::Bytes;
use axum::response::Response;
use orogen::export::features::list;
use orogen::export::features::options::OPTIONS;
use orogen::export::{ExportJob, registry};
use orogen::grid::hex;
use orogen::grid::words;
use orogen::io::file;
use orogen::options::{OptionSpec, Options};

use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::windows::{Held, check_samples, chosen};

/// The media type of GeoJSON.
pub const KIND: &str = "application/geo+json";

/// The layers, by their names in requests and in exports. The first one is the default.
pub const LAYERS: [(&str, &str); 7] = [
    ("objects", "scatter"),
    ("rivers", "rivers"),
    ("lakes", "lakes"),
    ("summits", "summits"),
    ("contours", "contours"),
    ("coast", "coast"),
    ("roads", "roads"),
];

/// Parameters of every layer.
const PARAMETERS: [&str; 3] = ["bbox", "cell", "layer"];

/// Maximum length of an answer, in bytes.
const MAX_BYTES: usize = 64 << 20;

/// The options of a layer.
pub fn options(layer: &str) -> impl Iterator<Item = &'static OptionSpec> {
    let names = list::named(layer).map_or(&[][..], |layer| layer.options);
    OPTIONS.iter().filter(move |spec| names.contains(&spec.name))
}

/// The answer.
pub async fn geojson(call: Call) -> Result<Response, Refusal> {
    let served = call.served()?;
    let asked = call.query.get("layer").unwrap_or(LAYERS[0].0);
    let names = || LAYERS.iter().map(|(name, _)| *name);
    let Some((_, layer)) = LAYERS.into_iter().find(|(name, _)| *name == asked) else {
        return Err(Refusal::absent(format!("there are no features `{asked}`; {}", words::suggestion(asked, names()))));
    };
    let known: Vec<&str> = PARAMETERS.into_iter().chain(options(layer).map(|spec| spec.name)).collect();
    call.query.only_of_variants(&known)?;
    let given =
        call.query.pairs().filter(|(name, value)| options(layer).any(|spec| spec.name == *name) && !value.is_empty());
    let options = Options::of(options(layer), given)?;
    let window = chosen(&call, &served)?;
    check_samples(&call, &served, &window)?;
    let Some(format) = registry::named("geojson") else {
        return Err(Refusal::absent("no format is called geojson"));
    };
    let hash = served.vector().key().map_err(|error| Refusal::of(&error).or_absent())?;
    let key = format!("features {} {} {window:?} {}", served.name, hex::encode(&hash), call.query.text());
    let (session, mut recipe) = (served.session().clone(), served.recipe().clone());
    let export = ExportJob::new(format).with_layer(layer).with_window(window).with_options(options);
    let work = async || {
        Ok(Box::new(move |progress: &orogen::Progress| {
            export.prepare(&mut recipe)?;
            let world = session.open(recipe)?;
            let mut text = Limited { bytes: Vec::new(), is_full: false };
            let written = export.to_stream(&world, &mut text, progress);
            if text.is_full {
                let message = format!(
                    "the features take more than {} MiB; ask for a smaller bbox or a larger cell, or use `orogen export`",
                    MAX_BYTES >> 20
                );
                return Err(Refusal::too_large(message));
            }
            written.map_err(|cause| file::explain("make", Path::new(layer), &cause))?;
            Ok(Bytes::from_owner(Held::new(world.budget(), text.bytes)?))
        }) as Work)
    };
    call.worked(&served, (key, Keep::Tile), KIND, work).await
}

/// Bytes of which there may be no more than [`MAX_BYTES`].
struct Limited {
    bytes: Vec<u8>,
    is_full: bool,
}

impl Write for Limited {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.bytes.len() + bytes.len() > MAX_BYTES {
            self.is_full = true;
            return Err(io::Error::new(io::ErrorKind::OutOfMemory, "the answer is too long"));
        }
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
