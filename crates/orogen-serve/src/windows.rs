//! Windows as files: the formats of exports.

use axum::body::Bytes;
use axum::response::Response;
use orogen::budget::{Budget, Reservation};
use orogen::export::derived::list;
use orogen::export::{ExportJob, Format, LayerSource, registry};
use orogen::grid::hex;
use orogen::grid::words::{self, number};
use orogen::io::file;
use orogen::options::Options;
use orogen::view::{Bounds, Size, View};
use orogen::world::HEIGHT;
use orogen::{Error, ErrorKind, Window};

use crate::answer;
use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::served::Served;

/// The formats of windows: those of samples and of meshes. Formats of objects are files of layers that a window of
/// samples is not.
pub fn formats() -> impl Iterator<Item = &'static Format> {
    registry::all().iter().copied().filter(|format| !format.features)
}

/// The media type of a format.
pub fn media_type(format: &Format) -> &'static str {
    match format.name {
        "tif" => "image/tiff",
        "png" => "image/png",
        "exr" => "image/x-exr",
        "pgm" => "image/x-portable-graymap",
        "glb" => "model/gltf-binary",
        "obj" => "model/obj",
        "stl" => "model/stl",
        "3mf" => "model/3mf",
        "asc" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

/// The option of formats for files beside the file: there are none here.
const NO_SIDECAR: &str = "no-sidecar";

/// Parameters of every window.
pub const PARAMETERS: [&str; 5] = ["bbox", "width", "height", "cell", "layer"];

/// `/window.tif` and the like.
pub async fn window(call: Call, format: &'static Format) -> Result<Response, Refusal> {
    let (name, kind) = (format.name, media_type(format));
    let served = call.served()?;
    let layer = call.query.get("layer").unwrap_or(HEIGHT).to_string();
    let (options, layer_options) = options(&call, format, &layer)?;
    served.world_of_options(&layer, &layer_options)?;
    let window = chosen(&call, &served)?;
    check_samples(&call, &served, &window)?;
    let fingerprint = hex::encode(&served.fingerprint(&layer).unwrap_or_default());
    let key = format!("window.{name} {} {fingerprint} {window:?} {}", served.name, call.query.text());
    let (session, mut recipe) = (served.session().clone(), served.recipe().clone());
    let export = ExportJob::new(format)
        .with_layer(layer)
        .with_window(window)
        .with_options(options)
        .with_layer_options(layer_options);
    let work = async || {
        Ok(Box::new(move |progress: &orogen::Progress| {
            export.prepare(&mut recipe)?;
            let world = session.open(recipe)?;
            let channels = LayerSource::new(&world, &export.layer, window, progress)?.channels();
            // The file, uncompressed; then the file until it is sent and no longer in the cache.
            let held = world.budget().reserve(((4 * channels + 2) * window.len()) as u64)?;
            let mut file = Growing::new(world.budget(), held);
            let written = export.to_stream(&world, &mut file, progress);
            written.map_err(|cause| file::explain("make", std::path::Path::new(&export.layer), &cause))?;
            let bytes = file.into_bytes();
            Ok(Bytes::from_owner(Held::new(world.budget(), bytes)?))
        }) as Work)
    };
    let mut response = call.worked(&served, (key, Keep::Tile), kind, work).await?;
    let Window { x, y, width, height, cell } = window;
    let place = format!("x={x}, y={y}, width={width}, height={height}, cell={cell}");
    answer::set(response.headers_mut(), axum::http::HeaderName::from_static("x-orogen-window"), &place);
    answer::set(
        response.headers_mut(),
        axum::http::header::CONTENT_DISPOSITION,
        &format!("inline; filename=\"{}.{name}\"", served.name),
    );
    Ok(response)
}

/// A file in memory, which may become larger than expected: a mesh has more bytes than its samples.
struct Growing<'a> {
    bytes: Vec<u8>,
    budget: &'a Budget,
    /// Memory that counts for it.
    held: Vec<Reservation>,
    counted: u64,
}

/// Step in which more memory is counted, in bytes.
const STEP: u64 = 4 << 20;

impl<'a> Growing<'a> {
    fn new(budget: &'a Budget, held: Reservation) -> Growing<'a> {
        let counted = held.bytes();
        Growing { bytes: Vec::new(), budget, held: vec![held], counted }
    }

    fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

impl std::io::Write for Growing<'_> {
    fn write(&mut self, more: &[u8]) -> std::io::Result<usize> {
        while (self.bytes.len() + more.len()) as u64 > self.counted {
            // To wait for others here could be to wait for oneself.
            if self.budget.unused().is_some_and(|unused| unused < STEP) {
                let message = "the file does not fit into the memory that is left; use a larger cell or a smaller bbox";
                return Err(Error::new(ErrorKind::Memory, message).into());
            }
            self.held.push(self.budget.charge(STEP));
            self.counted += STEP;
        }
        self.bytes.extend_from_slice(more);
        Ok(more.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Checks that a request may have the samples of a window.
///
/// # Errors
/// If they are too many.
pub fn check_samples(call: &Call, served: &Served, window: &Window) -> Result<(), Refusal> {
    let most = call.max_samples(served);
    if window.len() <= most {
        return Ok(());
    }
    Err(Refusal::too_large(format!(
        "{} x {} samples are {}, more than the {most} that one request may have; use a larger cell, a smaller width and height, or a smaller bbox, or raise --max-samples",
        window.width,
        window.height,
        window.len()
    )))
}

/// Bytes of an answer, whose memory counts until they are sent.
pub struct Held {
    bytes: Vec<u8>,
    _held: Reservation,
}

impl Held {
    /// Counts the memory of these bytes.
    ///
    /// # Errors
    /// If it does not suffice.
    pub fn new(budget: &Budget, bytes: Vec<u8>) -> orogen::Result<Held> {
        let held = budget.reserve(bytes.len() as u64)?;
        Ok(Held { bytes, _held: held })
    }
}

impl AsRef<[u8]> for Held {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}

/// The options of the format and of the layer among the parameters.
fn options(call: &Call, format: &Format, layer: &str) -> Result<(Options, Options), Refusal> {
    let own = format.options.iter().filter(|spec| spec.name != NO_SIDECAR);
    let derived = list::named(layer).map_or(&[][..], |derived| (derived.options)());
    let known: Vec<&str> = PARAMETERS
        .into_iter()
        .chain(own.clone().map(|spec| spec.name))
        .chain(derived.iter().map(|spec| spec.name))
        .collect();
    call.query.only_of_variants(&known)?;
    let given = |specs: &[&str]| -> Vec<(&str, &str)> {
        call.query.pairs().filter(|(name, _)| specs.contains(name) && !PARAMETERS.contains(name)).collect()
    };
    let names: Vec<&str> = own.clone().map(|spec| spec.name).collect();
    let of_format = Options::of(own, given(&names))?;
    let names: Vec<&str> = derived.iter().map(|spec| spec.name).collect();
    Ok((of_format, Options::of(derived, given(&names))?))
}

/// The requested window: a part or the whole world, at a cell or with a number of samples.
pub fn chosen(call: &Call, served: &Served) -> Result<Window, Refusal> {
    let query = &call.query;
    let world = served.world();
    let bounds =
        query.get("bbox").map(|text| text.parse::<Bounds>().map_err(|why| Refusal::bad(format!("bbox: {why}"))));
    let bounds = bounds.transpose()?;
    let [width, height] = ["width", "height"].map(|name| query.count(name, 1..=MAX_SIDE));
    let (width, height, cell) = (width?, height?, query.number("cell")?);
    if cell.is_some() && (width.is_some() || height.is_some()) {
        return Err(Refusal::bad("width and height set the cell; leave out `cell`, or give only `cell`"));
    }
    if bounds.is_none() && world.recipe().world.size.is_none() {
        let message = "this world is unbounded; give a `bbox` of west,south,east,north, such as bbox=0,-10000,10000,0";
        return Err(Refusal::bad(message));
    }
    if let Some(cell) = cell {
        orogen::world::check_cell(cell)?;
    }
    let view = View { bounds, ..View::default() };
    // One side: the other one follows from the aspect ratio.
    let one = |along: usize, samples: usize| -> Result<View, Refusal> {
        let whole = || world.recipe().world.size.map(|[width, height]| [0.0, 0.0, width, height]);
        let ends = view.ends(world.recipe(), world.recipe().world.cell)?.or_else(whole).unwrap_or_default();
        Ok(View { cell: Some((ends[along + 2] - ends[along]) / samples as f64), ..view })
    };
    let view = match (width, height) {
        (Some(width), Some(height)) => View { size: Some(Size::Both(width, height)), ..view },
        (Some(width), None) => one(0, width)?,
        (None, Some(height)) => one(1, height)?,
        (None, None) => View { cell, ..view },
    };
    let window = view.window(world, |_| ()).map_err(|error| match error.kind() {
        ErrorKind::Request => Refusal::bad(format!("{}{}", Refusal::of(&error).message, hint(served))),
        _ => Refusal::of(&error),
    })?;
    Ok(window)
}

/// Maximum number of samples along a side.
const MAX_SIDE: usize = 1 << 20;

/// What coordinates mean.
fn hint(served: &Served) -> String {
    match (served.map(), served.recipe().world.size) {
        (Some(_), _) => String::new(),
        (None, Some([width, height])) => format!(
            " (bbox is west,south,east,north in metres from the world's north-west corner; the whole world is 0,-{},{},0)",
            number(height),
            number(width)
        ),
        (None, None) => " (bbox is west,south,east,north in metres from the world's origin)".into(),
    }
}

impl Served {
    /// Checks that a layer exists and takes these options.
    fn world_of_options(&self, layer: &str, options: &Options) -> Result<(), Refusal> {
        if self.world().unit(layer).is_ok() {
            return Ok(());
        }
        if list::named(layer).is_none() {
            return self.world_of(layer).map(drop).map_err(|error| Refusal::of(&error).or_absent());
        }
        let mut recipe = self.recipe().clone();
        let prepared = list::prepare(&mut recipe, layer, options);
        prepared.map_err(|error| {
            let takes = list::named(layer).map_or(&[][..], |derived| (derived.options)());
            let names = words::list(takes.iter().map(|spec| spec.name));
            match takes {
                [] => Refusal::of(&error),
                _ => Refusal::bad(format!("{} (the layer has the parameters {names})", Refusal::of(&error).message)),
            }
        })
    }
}
