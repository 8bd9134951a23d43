//! A request with the world that it is about.

use std::collections::HashMap;
use std::future::Future;
use std::sync::Arc;

use axum::body::{Body, Bytes};
use axum::extract::rejection::RawPathParamsRejection;
use axum::extract::{RawPathParams, State};
use axum::http::{HeaderMap, Uri, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{MethodRouter, get, post};
use orogen::Progress;
use orogen::grid::words;
use orogen::io::palette::named::{self, Named};

use crate::answer::{self, Life};
use crate::desk::{Keep, Work};
use crate::query::{Query, SEED, SET, encoded};
use crate::refusal::Refusal;
use crate::sent;
use crate::served::{Frame, Served};
use crate::shared::Shared;
use crate::variants::Change;

/// A request.
pub struct Call {
    pub shared: Arc<Shared>,
    pub query: Query,
    pub headers: HeaderMap,
    parts: HashMap<String, String>,
    /// The host, if the address of the request has it.
    authority: Option<String>,
    /// Whether the path names the world.
    is_named: bool,
}

/// A route that answers with this function.
pub fn route<F, A>(answer: F) -> MethodRouter<Arc<Shared>>
where
    F: Fn(Call) -> A + Clone + Send + Sync + 'static,
    A: Future<Output = Result<Response, Refusal>> + Send,
{
    let respond = move |State(shared), path, uri: Uri, headers| {
        let answer = answer.clone();
        async move { answered(shared, path, &uri, headers, answer).await }
    };
    get(respond)
}

/// A route whose requests have a body.
pub fn route_of_body<F, A>(answer: F) -> MethodRouter<Arc<Shared>>
where
    F: Fn(Call, Body) -> A + Clone + Send + Sync + 'static,
    A: Future<Output = Result<Response, Refusal>> + Send,
{
    let respond = move |State(shared), path, uri: Uri, headers, body| {
        let answer = answer.clone();
        async move { answered(shared, path, &uri, headers, |call| answer(call, body)).await }
    };
    post(respond)
}

/// The answer, within the time that it may take.
async fn answered<A>(
    shared: Arc<Shared>,
    path: Result<RawPathParams, RawPathParamsRejection>,
    uri: &Uri,
    headers: HeaderMap,
    answer: impl FnOnce(Call) -> A,
) -> Response
where
    A: Future<Output = Result<Response, Refusal>>,
{
    let limit = shared.limits.timeout;
    let answered = async {
        let path = path.map_err(|_| Refusal::bad("the path is not percent-encoded UTF-8"))?;
        let parts = path.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
        let query = Query::parse(uri.query().unwrap_or_default())?;
        let authority = uri.authority().map(|host| host.as_str().to_string());
        answer(Call::new(shared, query, headers, parts, authority)).await
    };
    let in_time = tokio::time::timeout(limit, answered).await;
    let late = || {
        Err(Refusal::busy(format!(
            "the answer takes longer than {} s; send the request again later, ask for fewer samples, or raise --timeout",
            limit.as_secs_f64()
        )))
    };
    in_time.unwrap_or_else(|_| late()).into_response()
}

/// Work whose result is compressed, unless it is empty.
fn gzipped(work: Work) -> Work {
    Box::new(move |progress| {
        let bytes = work(progress)?;
        if bytes.is_empty() { Ok(bytes) } else { Ok(answer::gzipped(&bytes)?.into()) }
    })
}

impl Call {
    fn new(
        shared: Arc<Shared>,
        query: Query,
        headers: HeaderMap,
        parts: HashMap<String, String>,
        authority: Option<String>,
    ) -> Call {
        let is_named = parts.contains_key("world");
        Call { shared, query, headers, parts, authority, is_named }
    }

    /// A part of the path; empty if the route does not have it.
    pub fn part(&self, name: &str) -> &str {
        self.parts.get(name).map_or("", String::as_str)
    }

    /// The world that the path names, or the only one; its variant, if the parameters ask for one.
    ///
    /// # Errors
    /// If there is none.
    pub fn served(&self) -> Result<Arc<Served>, Refusal> {
        let own = self.named()?;
        match Change::of(&self.query)? {
            None => Ok(own),
            Some(change) => own.variant(&change),
        }
    }

    /// The world that the path names, or the only one.
    fn named(&self) -> Result<Arc<Served>, Refusal> {
        let worlds = &self.shared.worlds;
        let names = || worlds.iter().map(|world| world.name.as_str());
        if !self.is_named {
            return match worlds.as_slice() {
                [only] => Ok(Arc::clone(only)),
                _ => Err(Refusal::absent(format!(
                    "several worlds are served; begin the path with the name of one: {}",
                    words::list(names())
                ))),
            };
        }
        // Names are only ever looked up, never part of a path in the file system.
        let asked = self.part("world");
        let found = worlds.iter().find(|world| world.name == asked).cloned();
        found.or_else(|| self.shared.recipes.find(asked)).ok_or_else(|| {
            if self.shared.limits.allows_recipes && sent::is_name(asked) {
                return Refusal::absent(format!(
                    "no recipe `{asked}` is kept; the server keeps the last {} that were used: send it to /recipes again",
                    sent::MAX_KEPT
                ));
            }
            let hint = match words::nearest(asked, names()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", words::list(names())),
            };
            Refusal::absent(format!("no world or request is called `{asked}`; {hint}"))
        })
    }

    /// The grid of tiles, `?grid=`.
    ///
    /// # Errors
    /// If there is no such grid.
    pub fn frame(&self) -> Result<Frame, Refusal> {
        match self.query.get("grid") {
            None => Ok(Frame::Web),
            Some(name) => Frame::ALL.into_iter().find(|frame| frame.name() == name).ok_or_else(|| {
                Refusal::bad(format!(
                    "`grid` must be web (the tiles of web maps) or world (the square of the world), not `{name}`"
                ))
            }),
        }
    }

    /// The palette of a layer, `?palette=`; `None` is the layer's own.
    ///
    /// # Errors
    /// If there is no such palette.
    pub fn palette(&self) -> Result<Option<&'static Named>, Refusal> {
        let Some(name) = self.query.get("palette") else { return Ok(None) };
        let found = named::find(name).map(Some);
        found.ok_or_else(|| {
            let names = || named::all().iter().map(|named| named.name);
            let hint = match words::nearest(name, names()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", words::list(names())),
            };
            Refusal::bad(format!("no palette is called `{name}`; {hint}"))
        })
    }

    /// Samples that a request may have.
    pub fn max_samples(&self, served: &Served) -> usize {
        let most = self.shared.limits.samples;
        if served.is_sent { most.min(sent::MAX_SAMPLES) } else { most }
    }

    /// Whether answers are for this client only.
    pub fn is_private(&self) -> bool {
        self.shared.limits.token.is_some()
    }

    /// How long an answer may be used.
    pub fn life(&self, served: &Served) -> Life {
        if self.query.get("v") == Some(served.version.as_str()) { Life::Forever } else { Life::Checked }
    }

    /// The address of the server as the client knows it, with the name of the world if the path has it.
    pub fn base(&self, served: &Served) -> String {
        let plain = |host: &&str| {
            !host.is_empty()
                && host.len() < 256
                && host.bytes().all(|byte| byte.is_ascii_alphanumeric() || b".-:[]_".contains(&byte))
        };
        let header = |name: &str| self.headers.get(name).and_then(|value| value.to_str().ok());
        // With HTTP/2 the host is in the address.
        let host = self.authority.as_deref().or(header(header::HOST.as_str())).filter(plain);
        let host = host.map_or_else(|| self.shared.address(), str::to_string);
        let scheme = if header("x-forwarded-proto") == Some("https") { "https" } else { "http" };
        match self.is_named {
            true => format!("{scheme}://{host}/{}", served.name),
            false => format!("{scheme}://{host}"),
        }
    }

    /// Parameters that links to other answers need: those of the request's grid, the version, the variant and the
    /// token.
    pub fn link(&self, served: &Served, grid: Option<&str>) -> String {
        let mut link = format!("?v={}", served.version);
        if let Some(grid) = grid {
            link += &format!("&grid={grid}");
        }
        for (name, value) in self.query.pairs().filter(|(name, value)| [SEED, SET].contains(name) && !value.is_empty())
        {
            link += &format!("&{name}={}", encoded(value));
        }
        if let Some(token) = self.query.get("token") {
            link += &format!("&token={}", encoded(token));
        }
        link
    }

    /// The answer of some work, or that the client has it already. `tag` is what it depends on.
    ///
    /// # Errors
    /// If too many others wait, or the work fails.
    pub async fn worked(
        &self,
        served: &Served,
        (key, keep): (String, Keep),
        kind: &'static str,
        work: impl AsyncFnOnce() -> Result<Work, Refusal>,
    ) -> Result<Response, Refusal> {
        let compresses = answer::compresses(&self.headers, kind);
        let plain = key;
        let key = if compresses { format!("gzip {plain}") } else { plain.clone() };
        let tag = answer::etag(&[key.as_bytes()]);
        let (life, is_private) = (self.life(served), self.is_private());
        if answer::is_known(&self.headers, &tag) {
            return Ok(answer::not_modified(&tag, life, is_private));
        }
        let desk = &self.shared.desk;
        let bytes: Bytes = match desk.cached(&key) {
            Some(bytes) => bytes,
            None => {
                let _seat = desk.seat()?;
                let work = match desk.cached(&plain).filter(|_| compresses) {
                    Some(bytes) => Box::new(move |_: &Progress| Ok(bytes)),
                    None => work().await?,
                };
                let work = if compresses { gzipped(work) } else { work };
                desk.get(key, keep, || work).await?
            }
        };
        let is_compressed = compresses && !bytes.is_empty();
        let mut response = answer::part(&self.headers, &tag, bytes, kind)?;
        if answer::is_compressible(kind) {
            answer::set(response.headers_mut(), header::VARY, "accept-encoding");
        }
        if is_compressed {
            answer::set(response.headers_mut(), header::CONTENT_ENCODING, "gzip");
        }
        answer::lasting(&mut response, &tag, life, is_private);
        Ok(response)
    }
}
