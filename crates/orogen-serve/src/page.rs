//! The page of a world, a map with its tools, and the files that it consists of. They are part of the program, and the
//! page requests nothing from other hosts.

use std::io::Write as _;
use std::sync::LazyLock;

use axum::body::Bytes;
use axum::http::{HeaderValue, header};
use axum::response::Response;
use orogen_codec::format::gzip;

use crate::answer::{self, Life};
use crate::call::Call;
use crate::describe::escape::escaped;
use crate::describe::index;
use crate::query::encoded;
use crate::refusal::Refusal;
use crate::served::Served;

/// A file of the page.
pub struct Asset {
    pub name: &'static str,
    kind: &'static str,
    bytes: &'static [u8],
    /// The tag and the compressed bytes, made at the first request.
    packed: LazyLock<Packed>,
}

/// The tag and the compressed bytes of a file.
type Packed = (String, Option<Bytes>);

const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";
const JSON: &str = "application/json";

/// Declares files: their names, media types and paths in the folder `page`.
macro_rules! assets {
    ($($name:literal $kind:ident $path:literal)*) => {
        /// The files of the page.
        pub static ASSETS: [Asset; [$($name),*].len()] = [$(Asset {
            name: $name,
            kind: $kind,
            bytes: include_bytes!(concat!("../page/", $path)),
            packed: LazyLock::new(|| packed(include_bytes!(concat!("../page/", $path)))),
        }),*];
    };
}

assets! {
    "main.js" SCRIPT "main.js"
    "download.js" SCRIPT "download.js"
    "legend.js" SCRIPT "legend.js"
    "marks.js" SCRIPT "marks.js"
    "message.js" SCRIPT "message.js"
    "parameters.js" SCRIPT "parameters.js"
    "place.js" SCRIPT "place.js"
    "profile.js" SCRIPT "profile.js"
    "readout.js" SCRIPT "readout.js"
    "search.js" SCRIPT "search.js"
    "server.js" SCRIPT "server.js"
    "state.js" SCRIPT "state.js"
    "style.js" SCRIPT "style.js"
    "texts.js" SCRIPT "texts.js"
    "style.css" STYLE "style.css"
    "en.json" JSON "en.json"
    "zh-CN.json" JSON "zh-CN.json"
    "maplibre-gl.mjs" SCRIPT "maplibre-gl/maplibre-gl.mjs"
    "maplibre-gl-worker.mjs" SCRIPT "maplibre-gl/maplibre-gl-worker.mjs"
    "maplibre-gl.css" STYLE "maplibre-gl/maplibre-gl.css"
}

/// The tag of a file, and its compressed bytes.
fn packed(bytes: &[u8]) -> Packed {
    let mut packed = Vec::new();
    let written = gzip::start(&mut packed).and_then(|mut gzip| {
        gzip.write_all(bytes)?;
        gzip::finish(gzip)
    });
    (answer::etag(&[bytes]), written.is_ok().then(|| packed.into()))
}

/// `/assets/{name}`.
pub fn asset(call: &Call, asset: &'static Asset) -> Result<Response, Refusal> {
    let (tag, packed) = &*asset.packed;
    if answer::is_known(&call.headers, tag) {
        return Ok(answer::not_modified(tag, Life::Checked, false));
    }
    let packed = packed.as_ref().filter(|_| answer::takes_gzip(&call.headers));
    let mut response = answer::bytes(asset.kind, packed.cloned().unwrap_or_else(|| Bytes::from_static(asset.bytes)));
    answer::lasting(&mut response, tag, Life::Checked, false);
    let headers = response.headers_mut();
    headers.insert(header::VARY, HeaderValue::from_static("accept-encoding"));
    if packed.is_some() {
        headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
    }
    Ok(response)
}

/// What the page may load: nothing from other hosts, and no script of a text of a recipe. MapLibre makes pictures and
/// its worker of its own bytes.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; \
    connect-src 'self'; worker-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors *";

/// `/`: the page of the only world, or the list of all.
pub async fn server(call: Call) -> Result<Response, Refusal> {
    match call.shared.worlds.as_slice() {
        [only] => page(&call, only, ""),
        _ => index::worlds(&call),
    }
}

/// `/{world}`: the addresses of the page are relative to its folder.
pub async fn folder(call: Call) -> Result<Response, Refusal> {
    let served = call.served()?;
    let pairs = call.query.pairs().map(|(name, value)| format!("{}={}", encoded(name), encoded(value)));
    let query = pairs.collect::<Vec<_>>().join("&");
    let query = if query.is_empty() { query } else { format!("?{query}") };
    Ok(answer::redirect(&format!("{}/{query}", served.name)))
}

/// `/{world}/`.
pub async fn world(call: Call) -> Result<Response, Refusal> {
    page(&call, &*call.served()?, "../")
}

/// The page of a world. `root` leads to the paths of the server.
fn page(call: &Call, served: &Served, root: &str) -> Result<Response, Refusal> {
    let text = include_str!("../page/index.html").replace("{root}", root).replace("{title}", &escaped(&served.name));
    let mut response = answer::text(&call.headers, "text/html; charset=utf-8", &text, call.is_private())?;
    answer::set(response.headers_mut(), header::CONTENT_SECURITY_POLICY, POLICY);
    answer::set(response.headers_mut(), header::REFERRER_POLICY, "no-referrer");
    Ok(response)
}
