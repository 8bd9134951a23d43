//! `/wmts`: the capabilities of a Web Map Tile Service (OGC 07-057r7) whose tiles are those of the other requests.

use std::fmt::Write as _;

use axum::response::Response;
use orogen::builder::tile_grid::{EQUATOR, pixel};
use orogen::io::format::encoding::Encoding;

use super::escape::escaped;
use super::tilejson::tiles_of;
use crate::answer;
use crate::call::Call;
use crate::refusal::Refusal;
use crate::served::{Frame, Served, TILE};

/// Side of a pixel in metres for which scales of the standard are meant.
const PIXEL: f64 = 0.28e-3;

/// The parameters of a request for capabilities, in upper or lower case: those of the standard, and the version that
/// clients add. There is one version and one form of the answer.
const PARAMETERS: [&str; 7] =
    ["service", "request", "version", "acceptversions", "sections", "updatesequence", "acceptformats"];

/// The answer.
pub async fn capabilities(call: Call) -> Result<Response, Refusal> {
    let served = call.served()?;
    let asked = call.query.pairs().find(|(name, _)| name.eq_ignore_ascii_case("request"));
    if let Some((_, request)) = asked
        && !request.eq_ignore_ascii_case("GetCapabilities")
    {
        return Err(Refusal::bad(format!(
            "this service has no request `{request}`: its tiles have addresses of their own, which the capabilities list"
        )));
    }
    call.query.without(&PARAMETERS).only_of_variants(&PARAMETERS)?;
    let text = text(&call, &served)?;
    answer::text(&call.headers, "application/xml", &text, call.is_private())
}

/// A set of tile matrices: a grid of tiles in coordinates of a map.
struct MatrixSet {
    frame: Frame,
    crs: u16,
    /// West, south, east and north of the world.
    bounds: [f64; 4],
    /// The first and last zoom.
    zooms: [u32; 2],
}

/// The grids whose coordinates a map program knows.
fn sets(served: &Served) -> Result<Vec<MatrixSet>, Refusal> {
    let zooms = served.zooms(Frame::Web)?;
    let own = served.grid(Frame::Web, zooms.own, TILE)?;
    let side = pixel(zooms.own, TILE);
    let [[left, right], [top, bottom]] = own.pixels();
    let east = |pixel: u64| pixel as f64 * side - 0.5 * EQUATOR;
    let north = |pixel: u64| 0.5 * EQUATOR - pixel as f64 * side;
    let bounds = [east(left), north(bottom + 1), east(right + 1), north(top)];
    let mut sets = vec![MatrixSet { frame: Frame::Web, crs: 3857, bounds, zooms: [0, zooms.most] }];
    // A scale has one number: units of both axes must be equally long.
    if let (Some(map), Some([width, height])) = (served.map(), served.recipe().world.size)
        && let Some(code) = map.epsg()
        && map.per_metre[0] == map.per_metre[1]
        && !map.counts_degrees()
    {
        let ([west, north], [east, south]) = (map.at(0.0, 0.0), map.at(width, height));
        let bounds = [west, south, east, north];
        sets.push(MatrixSet { frame: Frame::World, crs: code, bounds, zooms: [0, served.zooms(Frame::World)?.most] });
    }
    Ok(sets)
}

/// The capabilities.
fn text(call: &Call, served: &Served) -> Result<String, Refusal> {
    let (base, sets) = (call.base(served), sets(served)?);
    let zooms = served.zooms(Frame::Web)?;
    let own = served.grid(Frame::Web, zooms.own, TILE)?;
    let [west, south, east, north] = orogen::builder::tile_grid::degrees(own.pixels(), (TILE as u64) << zooms.own);
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Capabilities xmlns=\"http://www.opengis.net/wmts/1.0\" \
         xmlns:ows=\"http://www.opengis.net/ows/1.1\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" version=\"1.0.0\">\n\
         <ows:ServiceIdentification><ows:Title>{}</ows:Title><ows:ServiceType>OGC WMTS</ows:ServiceType>\
         <ows:ServiceTypeVersion>1.0.0</ows:ServiceTypeVersion></ows:ServiceIdentification>\n<Contents>\n",
        escaped(served.title())
    );
    let encodings = Encoding::ALL.into_iter().filter(|_| served.has_heights());
    let encodings =
        encodings.map(|encoding| (encoding.name().to_string(), format!("heights encoded as {}", encoding.name())));
    let layers: Vec<(String, String)> =
        served.layers().into_iter().map(|layer| (layer.name, layer.about)).chain(encodings).collect();
    // Writing to a string cannot fail.
    for (name, about) in &layers {
        let (path, _) = tiles_of(name);
        // The version comes first, so that the template of the grid is a value of its own.
        let link = escaped(&call.link(served, Some("{TileMatrixSet}")));
        let _ = write!(
            text,
            "<Layer><ows:Title>{name}</ows:Title><ows:Abstract>{}</ows:Abstract>\
             <ows:WGS84BoundingBox><ows:LowerCorner>{west} {south}</ows:LowerCorner><ows:UpperCorner>{east} {north}</ows:UpperCorner></ows:WGS84BoundingBox>",
            escaped(about),
            name = escaped(name),
        );
        for MatrixSet { crs, bounds: [west, south, east, north], .. } in &sets {
            let _ = write!(
                text,
                "<ows:BoundingBox crs=\"urn:ogc:def:crs:EPSG::{crs}\"><ows:LowerCorner>{west} {south}</ows:LowerCorner>\
                 <ows:UpperCorner>{east} {north}</ows:UpperCorner></ows:BoundingBox>"
            );
        }
        let _ = write!(
            text,
            "<ows:Identifier>{}</ows:Identifier><Style isDefault=\"true\"><ows:Identifier>default</ows:Identifier></Style><Format>image/png</Format>",
            escaped(name)
        );
        for set in &sets {
            let name = set.frame.name();
            let _ = write!(
                text,
                "<TileMatrixSetLink><TileMatrixSet>{name}</TileMatrixSet>{}</TileMatrixSetLink>",
                limits(served, set)?
            );
        }
        let _ = writeln!(
            text,
            "<ResourceURL format=\"image/png\" resourceType=\"tile\" template=\"{base}/{path}/{{TileMatrix}}/{{TileCol}}/{{TileRow}}.png{link}\"/></Layer>"
        );
    }
    for set in &sets {
        let _ = writeln!(
            text,
            "<TileMatrixSet><ows:Identifier>{}</ows:Identifier><ows:SupportedCRS>urn:ogc:def:crs:EPSG::{}</ows:SupportedCRS>",
            set.frame.name(),
            set.crs
        );
        for zoom in set.zooms[0]..=set.zooms[1] {
            let _ = writeln!(text, "{}", matrix(served, set.frame, zoom)?);
        }
        text += "</TileMatrixSet>\n";
    }
    let _ = write!(text, "</Contents>\n<ServiceMetadataURL xlink:href=\"{base}/wmts\"/>\n</Capabilities>\n");
    Ok(text)
}

/// The tiles of each zoom that are in the world.
fn limits(served: &Served, set: &MatrixSet) -> Result<String, Refusal> {
    let mut text = String::from("<TileMatrixSetLimits>");
    for zoom in set.zooms[0]..=set.zooms[1] {
        // At low zooms a small world has no sample.
        let Ok(grid) = served.grid(set.frame, zoom, TILE) else { continue };
        let [[left, right], [top, bottom]] = grid.tiles();
        let _ = write!(
            text,
            "<TileMatrixLimits><TileMatrix>{zoom}</TileMatrix><MinTileRow>{top}</MinTileRow><MaxTileRow>{bottom}</MaxTileRow>\
             <MinTileCol>{left}</MinTileCol><MaxTileCol>{right}</MaxTileCol></TileMatrixLimits>"
        );
    }
    Ok(text + "</TileMatrixSetLimits>")
}

/// A tile matrix.
fn matrix(served: &Served, frame: Frame, zoom: u32) -> Result<String, Refusal> {
    let count = 1u64 << zoom;
    let (side, corner) = match frame {
        Frame::Web => (pixel(zoom, TILE), [-0.5 * EQUATOR, 0.5 * EQUATOR]),
        Frame::World => {
            let cell = served.recipe().world.size.map_or(1.0, |[width, height]| width.max(height))
                / (TILE as u64 * count) as f64;
            let map = served.map().unwrap_or(orogen::io::format::Georeference {
                origin: [0.0; 2],
                per_metre: [1.0; 2],
                keys: None,
            });
            // A sample is in the middle of its pixel.
            (cell * map.per_metre[0], map.at(-0.5 * cell, -0.5 * cell))
        }
    };
    Ok(format!(
        "<TileMatrix><ows:Identifier>{zoom}</ows:Identifier><ScaleDenominator>{}</ScaleDenominator>\
         <TopLeftCorner>{} {}</TopLeftCorner><TileWidth>{TILE}</TileWidth><TileHeight>{TILE}</TileHeight>\
         <MatrixWidth>{count}</MatrixWidth><MatrixHeight>{count}</MatrixHeight></TileMatrix>",
        side / PIXEL,
        corner[0],
        corner[1]
    ))
}
