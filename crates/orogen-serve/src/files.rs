//! `/studio/` and `/book/`: files of the [site](crate::site).

use std::path::Path;

use axum::body::Bytes;
use axum::http::{HeaderName, header};
use axum::response::Response;

use crate::answer::{self, Life};
use crate::call::Call;
use crate::refusal::Refusal;

/// A file of a part; a path that ends with `/` is its index.
pub async fn file(call: Call, part: &'static str) -> Result<Response, Refusal> {
    let asked = call.part("path");
    let name = if asked.is_empty() || asked.ends_with('/') {
        format!("{part}/{asked}index.html")
    } else {
        format!("{part}/{asked}")
    };
    let site = &call.shared.site;
    let Some(path) = site.find(&name) else {
        return Err(Refusal::absent(match site.has(part) {
            true => format!("`/{name}` is no file of the {part}"),
            false => format!(
                "this server has no {part}; `cargo xtask {}` makes its files, and `orogen serve --web FOLDER` serves them",
                if part == "book" { "book" } else { "web" }
            ),
        }));
    };
    let read = tokio::task::spawn_blocking({
        let path = path.to_path_buf();
        move || std::fs::read(path)
    });
    let bytes: Bytes = match read.await {
        Ok(Ok(bytes)) => bytes.into(),
        _ => return Err(Refusal::absent(format!("`/{name}` cannot be read; it was there when the server started"))),
    };
    let tag = answer::etag(&[&bytes]);
    if answer::is_known(&call.headers, &tag) {
        return Ok(answer::not_modified(&tag, Life::Checked, call.is_private()));
    }
    let mut response = answer::part(&call.headers, &tag, bytes, kind_of(&name))?;
    answer::lasting(&mut response, &tag, Life::Checked, call.is_private());
    for (name, value) in [
        // With these two a page may use threads.
        ("cross-origin-opener-policy", "same-origin"),
        ("cross-origin-embedder-policy", "require-corp"),
        (
            header::CONTENT_SECURITY_POLICY.as_str(),
            "default-src 'self'; script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; \
             img-src 'self' data: blob:; font-src 'self' data:; worker-src 'self' blob:; connect-src 'self'; object-src 'none'; base-uri 'self'",
        ),
    ] {
        answer::set(response.headers_mut(), HeaderName::from_static(name), value);
    }
    Ok(response)
}

/// `/studio` and `/book`: the addresses of their files are relative to the folder.
pub fn folder(part: &str) -> Response {
    answer::redirect(&format!("{part}/"))
}

/// The media type of a file, by its extension.
fn kind_of(name: &str) -> &'static str {
    let extension = Path::new(name).extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    match extension {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" => "application/json",
        "toml" | "txt" | "md" => "text/plain; charset=utf-8",
        "wasm" => "application/wasm",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "gif" => "image/gif",
        "svg" => "image/svg+xml",
        "webp" => "image/webp",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        _ => "application/octet-stream",
    }
}
