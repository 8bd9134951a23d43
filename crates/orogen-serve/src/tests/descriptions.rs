//! Descriptions lead to tiles, and caches are told what they may keep.

use super::client::{Reply, start};
use super::{HILLS, PLAIN, placed};

/// The namespace of WMTS.
const WMTS: &str = "http://www.opengis.net/wmts/1.0";

/// The text of the first element with a name.
fn element<'a>(xml: &'a str, name: &str) -> &'a str {
    let start = xml.find(&format!("<{name}>")).unwrap_or_else(|| panic!("no {name}")) + name.len() + 2;
    &xml[start..start + xml[start..].find("</").unwrap()]
}

fn is_picture(reply: &Reply) -> bool {
    reply.status == 200 && reply.body.starts_with(b"\x89PNG")
}

#[test]
fn tilejson_leads_to_tiles() {
    let place = placed("EPSG:3857", [1_300_000.0, 6_100_000.0]);
    let server = start(&[("hills", HILLS), ("plain", PLAIN), ("place", &place)], &[]);
    for (world, layer, encoding) in [
        ("hills", "height", None),
        ("hills", "terrarium", Some("terrarium")),
        ("hills", "terrain-rgb", Some("mapbox")),
        ("plain", "slope", None),
        ("place", "hillshade", None),
    ] {
        for grid in ["web", "world"] {
            let json = server.get(&format!("/{world}/tilejson/{layer}.json?grid={grid}")).json();
            assert_eq!(json["encoding"].as_str(), encoding, "{json}");
            assert_eq!(json["grid"]["name"], grid);
            let template = json["tiles"][0].as_str().unwrap();
            let zoom = json["maxzoom"].as_u64().unwrap();
            // The tile in the middle of the world.
            let (x, y) = match (grid, json["center"].as_array()) {
                ("web", Some(center)) => {
                    let count = f64::from(1u32 << zoom);
                    let [east, north] = [0, 1].map(|k| center[k].as_f64().unwrap());
                    let sine = libm::sin(north.to_radians());
                    let y = 0.5 - 0.25 * libm::log((1.0 + sine) / (1.0 - sine)) / std::f64::consts::PI;
                    (((east + 180.0) / 360.0 * count) as u64, (y * count) as u64)
                }
                _ if world == "plain" => (1 << (zoom - 1), 1 << (zoom - 1)),
                _ => (1 << (zoom - 1), 0),
            };
            let tile = ["{z}", "{x}", "{y}"].into_iter().zip([zoom, x, y]);
            let address = tile.fold(template.to_string(), |text, (name, value)| text.replace(name, &value.to_string()));
            let reply = server.follow(&address);
            assert!(is_picture(&reply), "{address}: {}", String::from_utf8_lossy(&reply.body));
            assert_eq!(reply.header("cache-control"), "public, max-age=31536000, immutable", "{address}");
        }
    }
}

#[test]
fn capabilities_list_layers_and_grids() {
    let utm = placed("EPSG:32632", [600_000.0, 5_200_000.0]);
    let server = start(&[("utm", &utm), ("hills", HILLS)], &[]);
    for (world, sets) in [("utm", vec!["web", "world"]), ("hills", vec!["web"])] {
        for path in ["wmts", "wmts?SERVICE=WMTS&REQUEST=GetCapabilities", "wmts/1.0.0/WMTSCapabilities.xml"] {
            let reply = server.get(&format!("/{world}/{path}"));
            assert_eq!((reply.status, reply.header("content-type")), (200, "application/xml"));
            let text = reply.text();
            let document = roxmltree::Document::parse(text).unwrap();
            let named = |name: &'static str| document.descendants().filter(move |node| node.has_tag_name((WMTS, name)));
            let found: Vec<&str> = named("Contents")
                .flat_map(|contents| contents.children().filter(|node| node.has_tag_name((WMTS, "TileMatrixSet"))))
                .map(|set| set.first_element_child().unwrap().text().unwrap())
                .collect();
            assert_eq!(found, sets, "{world}");
            let template = named("ResourceURL").next().unwrap().attribute("template").unwrap();
            for set in sets.iter().copied() {
                // The first tile of a zoom in which the world is.
                let limits = named("TileMatrixSetLink")
                    .find(|link| link.first_element_child().unwrap().text() == Some(set))
                    .unwrap();
                let limit = limits.descendants().rfind(|node| node.has_tag_name((WMTS, "TileMatrixLimits"))).unwrap();
                let value =
                    |name: &str| limit.children().find(|node| node.tag_name().name() == name).unwrap().text().unwrap();
                let address = template
                    .replace("{TileMatrixSet}", set)
                    .replace("{TileMatrix}", value("TileMatrix"))
                    .replace("{TileCol}", value("MinTileCol"))
                    .replace("{TileRow}", value("MinTileRow"));
                assert!(is_picture(&server.follow(&address)), "{address}");
            }
        }
    }
    let text = server.get("/utm/wmts").text().to_string();
    assert!(
        text.contains("urn:ogc:def:crs:EPSG::32632") && element(&text, "ows:Title") == "Hills &amp; &lt;valleys&gt;"
    );
}

#[test]
fn caches_are_told_what_they_may_keep() {
    let server = start(&[("hills", HILLS)], &[]);
    let path = "/tiles/height/0/0/0.png?grid=world";
    let first = server.get(path);
    let tag = first.header("etag").to_string();
    assert_eq!((first.header("cache-control"), first.header("access-control-allow-origin")), ("public, no-cache", "*"));
    for (header, status) in [
        (format!("If-None-Match: {tag}"), 304),
        (format!("If-None-Match: \"other\", W/{tag}"), 304),
        ("If-None-Match: \"other\"".into(), 200),
    ] {
        let reply = server.ask("GET", path, &[&header]);
        assert_eq!((reply.status, reply.header("etag")), (status, tag.as_str()), "{header}");
        assert_eq!(reply.body.is_empty(), status == 304);
    }
    // The tag needs no work: no tile of this zoom was made.
    let made = server.metric("orogen_work_total");
    let known = server.get("/terrarium/1/0/0.png?grid=world").header("etag").to_string();
    assert_eq!(server.metric("orogen_work_total"), made + 1);
    assert_eq!(server.ask("GET", "/terrarium/1/0/0.png?grid=world", &[&format!("If-None-Match: {known}")]).status, 304);
    assert_eq!(server.get(path).body, first.body);
    assert_eq!(server.metric("orogen_work_total"), made + 1);
    let head = server.ask("HEAD", path, &[]);
    assert_eq!(
        (head.status, head.body.len(), head.header("content-length")),
        (200, 0, first.body.len().to_string().as_str())
    );
    // Another seed has other tags, everywhere.
    let other = start(&[("hills", &HILLS.replace("cell = 10", "cell = 10\nseed = 5"))], &[]);
    assert_ne!(other.get(path).header("etag"), tag);
    let asked = server.ask("OPTIONS", path, &["Origin: http://a", "Access-Control-Request-Method: GET"]);
    assert_eq!((asked.status, asked.header("access-control-allow-methods")), (204, "GET, HEAD, OPTIONS"));
    // Texts are compressed for those who take it.
    let (plain, packed) = (server.get("/wmts"), server.ask("GET", "/wmts", &["Accept-Encoding: gzip"]));
    assert_eq!((packed.header("content-encoding"), plain.header("content-encoding")), ("gzip", ""));
    assert!(packed.body.len() * 4 < plain.body.len() && packed.body.starts_with(&[0x1f, 0x8b]));
    let tag = packed.header("etag");
    assert_eq!(server.ask("GET", "/wmts", &["Accept-Encoding: gzip", &format!("If-None-Match: {tag}")]).status, 304);
    assert_eq!(packed.header("vary"), "accept-encoding, host");
}

#[test]
fn pages_list_worlds_and_layers() {
    let server = start(&[("hills", HILLS)], &[]);
    for path in ["/addresses", "/hills/addresses"] {
        let reply = server.get(path);
        assert_eq!((reply.status, reply.header("content-type")), (200, "text/html; charset=utf-8"));
        let text = reply.text();
        assert!(
            text.contains("Hills &amp; &lt;valleys&gt;") && text.contains("/wmts") && text.contains(">slope<"),
            "{text}"
        );
        assert!(reply.header("content-security-policy").contains("default-src 'none'"));
        let picture = text.split("img src=\"").nth(1).unwrap().split('"').next().unwrap().replace("&amp;", "&");
        assert!(is_picture(&server.follow(&picture)), "{picture}");
    }
    let api = server.get("/openapi.json").json();
    assert_eq!(api["openapi"], "3.1.0");
    for path in ["/tiles/{layer}/{z}/{x}/{y}.png", "/{world}/window.npy", "/wmts", "/healthz"] {
        assert!(api["paths"][path]["get"]["responses"]["200"].is_object(), "{path}");
    }
    let several = start(&[("hills", HILLS), ("plain", PLAIN)], &[]);
    let page = several.get("/");
    assert!(page.text().contains("href=\"hills/\"") && page.text().contains("href=\"plain/\""));
    for picture in page.text().split("img src=\"").skip(1) {
        let picture = picture.split('"').next().unwrap().replace("&amp;", "&");
        assert!(is_picture(&several.get(&format!("/{picture}"))), "{picture}");
    }
    let refused = several.get("/tiles/height/0/0/0.png?grid=world");
    assert_eq!(refused.status, 404);
    assert!(refused.text().contains("begin the path with the name of one: `hills`"), "{}", refused.text());
    assert!(is_picture(&several.get("/hills/tiles/height/0/0/0.png?grid=world")));
    // Two worlds do not share tiles.
    let [one, other] = ["hills", "plain"].map(|name| several.get(&format!("/{name}/terrarium/14/8192/8192.png")));
    assert!(one.body != other.body && is_picture(&other));
    assert!(several.get("/metrics").text().contains("route=\"/{world}/terrarium/{z}/{x}/{y}\",status=\"200\"} 2"));
}
