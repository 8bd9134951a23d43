//! The requests, and what all of them have in common: the token, CORS, the log, counts and errors.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use axum::Router;
use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::get;

use crate::call::{Call, route, route_of_body};
use crate::refusal::Refusal;
use crate::shared::{Client, Shared};
use crate::{
    answer, colors, describe, files, meshes, objects, page, places, points, recipes, site, tiles, vector, windows, zarr,
};

/// First parts of paths that no world can have as its name.
pub const RESERVED: [&str; 25] = [
    "tiles",
    "terrarium",
    "terrain-rgb",
    "tilejson",
    "wmts",
    "window",
    "height",
    "profile",
    "locate",
    "mesh",
    "vector",
    "zarr",
    "map",
    "healthz",
    "metrics",
    "openapi",
    "addresses",
    "assets",
    "book",
    "colors",
    "objects",
    "studio",
    "world",
    "recipe",
    "recipes",
];

/// Path of the check that the server lives, which needs no token.
const HEALTH: &str = "/healthz";

/// First parts of paths that need no token.
const OPEN: [&str; 3] = ["assets", "studio", "book"];

/// The router of all requests.
pub fn router(shared: &Arc<Shared>) -> Router {
    let mut router = Router::new()
        .route("/", route(page::server))
        .route(HEALTH, get(async || "ok\n"))
        .route("/metrics", route(metrics))
        .route("/openapi.json", route(describe::openapi::openapi))
        .route("/recipes", route_of_body(recipes::post).fallback(recipes::other))
        .route("/{world}", route(page::folder))
        .route("/{world}/", route(page::world));
    // A single world has short paths, too.
    for prefix in ["", "/{world}"] {
        router = router
            .route(&format!("{prefix}/tiles/{{layer}}/{{z}}/{{x}}/{{y}}"), route(tiles::map))
            .route(&format!("{prefix}/terrarium/{{z}}/{{x}}/{{y}}"), route(tiles::terrarium))
            .route(&format!("{prefix}/terrain-rgb/{{z}}/{{x}}/{{y}}"), route(tiles::terrain_rgb))
            .route(&format!("{prefix}/vector/{{z}}/{{x}}/{{y}}"), route(vector::tile))
            .route(&format!("{prefix}/tilejson/{{layer}}"), route(describe::tilejson::tilejson))
            .route(&format!("{prefix}/recipe.json"), route(describe::recipe::recipe))
            .route(&format!("{prefix}/recipe.toml"), route(describe::recipe::text))
            .route(&format!("{prefix}/wmts"), route(describe::wmts::capabilities))
            .route(&format!("{prefix}/wmts/1.0.0/WMTSCapabilities.xml"), route(describe::wmts::capabilities))
            .route(&format!("{prefix}/colors/{{layer}}"), route(colors::colors))
            .route(&format!("{prefix}/world.json"), route(describe::world::world))
            .route(&format!("{prefix}/addresses"), route(describe::index::addresses))
            .route(&format!("{prefix}/objects.geojson"), route(objects::geojson))
            .route(&format!("{prefix}/height"), route(points::height))
            .route(&format!("{prefix}/profile"), route(points::profile))
            .route(&format!("{prefix}/locate"), route(places::locate))
            .route(&format!("{prefix}/mesh/layer.json"), route(meshes::layer))
            .route(&format!("{prefix}/mesh/{{z}}/{{x}}/{{y}}"), route(meshes::tile))
            .route(&format!("{prefix}/zarr/{{*key}}"), route(zarr::zarr));
        for format in windows::formats() {
            let path = format!("{prefix}/window.{}", format.name);
            router = router.route(&path, route(move |call| windows::window(call, format)));
        }
    }
    for asset in &page::ASSETS {
        router = router.route(&format!("/assets/{}", asset.name), route(async |call| page::asset(&call, asset)));
    }
    for part in site::PARTS {
        router = router
            .route(&format!("/{part}"), get(async move || files::folder(part)))
            .route(&format!("/{part}/"), route(move |call| files::file(call, part)))
            .route(&format!("/{part}/{{*path}}"), route(move |call| files::file(call, part)));
    }
    router
        .fallback(async || Refusal::absent("there is no such request; / and /openapi.json list all of them"))
        .method_not_allowed_fallback(async || Refusal {
            status: StatusCode::METHOD_NOT_ALLOWED,
            message: "requests are GET or HEAD".into(),
        })
        .layer(from_fn_with_state(Arc::clone(shared), around))
        .with_state(Arc::clone(shared))
}

/// `/metrics`.
async fn metrics(call: Call) -> Result<Response, Refusal> {
    call.query.only(&[])?;
    let text = call.shared.metrics.text(&call.shared.desk, &call.shared.peers, &call.shared.session);
    answer::text(&call.headers, "text/plain; version=0.0.4; charset=utf-8", &text, call.is_private())
}

/// A request in the log and in the counts, also if its client goes away.
struct Line<'a> {
    shared: &'a Shared,
    begun: Instant,
    client: Option<SocketAddr>,
    method: Method,
    path: String,
    route: String,
    /// The status and the length of the answer; 499 if the client went away before.
    answer: (u16, Option<u64>),
}

impl Drop for Line<'_> {
    fn drop(&mut self) {
        let seconds = self.begun.elapsed().as_secs_f64();
        let (status, length) = self.answer;
        self.shared.metrics.count(&self.route, status, seconds);
        (self.shared.log)(&format!(
            "time={} client={} method={} path={:?} status={status} bytes={} ms={:.1}",
            timestamp(SystemTime::now()),
            self.client.map_or_else(|| "-".into(), |client| client.ip().to_string()),
            self.method,
            self.path,
            length.map_or_else(|| "-".into(), |length| length.to_string()),
            seconds * 1000.0,
        ));
    }
}

/// Longest path in the log.
const LOGGED: usize = 300;

/// Checks the token, answers questions of browsers, adds headers, and logs.
async fn around(State(shared): State<Arc<Shared>>, request: Request, next: Next) -> Response {
    let matched = request.extensions().get::<MatchedPath>();
    let mut line = Line {
        begun: Instant::now(),
        client: request.extensions().get::<Client>().map(|client| client.0),
        method: request.method().clone(),
        path: logged(request.uri().path(), request.uri().query()),
        route: matched.map_or_else(|| "none".into(), |route| route.as_str().to_string()),
        answer: (499, None),
        shared: &shared,
    };
    let is_asked = request.method() == Method::OPTIONS;
    // Pages that are the same everywhere are no secret.
    let is_open = |path: &str| path == HEALTH || OPEN.contains(&path.split('/').nth(1).unwrap_or_default());
    let is_allowed = is_asked || is_open(request.uri().path()) || is_allowed(&shared, &request);
    let mut response = match (is_asked, is_allowed) {
        (true, _) => asked(shared.limits.allows_recipes),
        (false, true) => next.run(request).await,
        (false, false) => Refusal {
            status: StatusCode::UNAUTHORIZED,
            message: "this server needs its token: send `Authorization: Bearer TOKEN` or `?token=TOKEN`".into(),
        }
        .into_response(),
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (header::ACCESS_CONTROL_ALLOW_ORIGIN, "*"),
        (header::ACCESS_CONTROL_EXPOSE_HEADERS, "etag, location, retry-after, x-orogen-window"),
        (HeaderName::from_static("x-content-type-options"), "nosniff"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    let length = axum::body::HttpBody::size_hint(response.body()).exact();
    line.answer = (response.status().as_u16(), length);
    response
}

/// The answer to a browser that asks what another site's page may request.
fn asked(allows_recipes: bool) -> Response {
    let mut response = StatusCode::NO_CONTENT.into_response();
    let headers: &mut HeaderMap = response.headers_mut();
    let (methods, names) = match allows_recipes {
        true => ("GET, HEAD, POST, OPTIONS", "authorization, content-type, if-none-match"),
        false => ("GET, HEAD, OPTIONS", "authorization, if-none-match"),
    };
    headers.insert(header::ACCESS_CONTROL_ALLOW_METHODS, HeaderValue::from_static(methods));
    headers.insert(header::ACCESS_CONTROL_ALLOW_HEADERS, HeaderValue::from_static(names));
    headers.insert(header::ACCESS_CONTROL_MAX_AGE, HeaderValue::from_static("86400"));
    response
}

/// Whether a request has the token.
fn is_allowed(shared: &Shared, request: &Request) -> bool {
    let Some(token) = &shared.limits.token else { return true };
    let given = request.headers().get(header::AUTHORIZATION).and_then(|value| value.to_str().ok());
    let bearer = given.and_then(|value| value.strip_prefix("Bearer ")).map(str::trim);
    let parameter = request.uri().query().into_iter().flat_map(|query| query.split('&'));
    let mut parameter = parameter.filter_map(|pair| pair.strip_prefix("token="));
    bearer.is_some_and(|given| is_same(given, token)) || parameter.any(|given| is_same(given, token))
}

/// Compares in a time that does not depend on where the two differ.
fn is_same(given: &str, token: &str) -> bool {
    let (given, token) = (given.as_bytes(), token.as_bytes());
    given.len() == token.len() && given.iter().zip(token).fold(0, |sum, (a, b)| sum | (a ^ b)) == 0
}

/// The path for the log, without the token.
fn logged(path: &str, query: Option<&str>) -> String {
    let mut text = path.to_string();
    let shown = query.into_iter().flat_map(|query| query.split('&')).filter(|pair| !pair.starts_with("token="));
    for (k, pair) in shown.enumerate() {
        text.push(if k == 0 { '?' } else { '&' });
        text.push_str(pair);
    }
    match text.char_indices().nth(LOGGED) {
        Some((end, _)) => text[..end].to_string() + "...",
        None => text,
    }
}

/// A time as in RFC 3339, in UTC.
fn timestamp(time: SystemTime) -> String {
    let since = time.duration_since(UNIX_EPOCH).unwrap_or(Duration::ZERO);
    let (days, second) = (since.as_secs() / 86_400, since.as_secs() % 86_400);
    // Days to dates of the Gregorian calendar (H. Hinnant, "chrono-compatible low-level date algorithms").
    let day = days + 719_468;
    let (era, of_era) = (day / 146_097, day % 146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * of_year + 2) / 153;
    let (date, month) = (of_year - (153 * month + 2) / 5 + 1, if month < 10 { month + 3 } else { month - 9 });
    let year = year_of_era + 400 * era + u64::from(month <= 2);
    let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
    format!("{year:04}-{month:02}-{date:02}T{hour:02}:{minute:02}:{second:02}.{:03}Z", since.subsec_millis())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_paths_of_the_log() {
        for (seconds, expect) in [
            (0, "1970-01-01T00:00:00.000Z"),
            (951_782_400, "2000-02-29T00:00:00.000Z"),
            (1_772_323_199, "2026-02-28T23:59:59.000Z"),
            (4_107_542_400, "2100-03-01T00:00:00.000Z"),
        ] {
            assert_eq!(timestamp(UNIX_EPOCH + Duration::from_secs(seconds)), expect);
        }
        assert_eq!(logged("/a", Some("x=1&token=secret&y=2")), "/a?x=1&y=2");
        assert_eq!(logged("/a", Some("token=secret")), "/a");
        assert_eq!(logged(&"ä".repeat(400), None).chars().count(), LOGGED + 3);
        assert!(is_same("abc", "abc") && !is_same("abd", "abc") && !is_same("ab", "abc"));
    }
}
