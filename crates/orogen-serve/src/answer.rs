//! Answers: bytes and texts with their headers.

use std::io::Write as _;

use axum::body::{Body, Bytes};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use orogen::grid::hex;
use orogen_codec::format::gzip;
use sha2::{Digest, Sha256};

use crate::refusal::Refusal;

/// Texts from this length on are compressed.
const COMPRESSED: usize = 512;

/// Media types of answers that are computed and much shorter when they are compressed.
const COMPRESSIBLE: [&str; 3] =
    ["application/vnd.mapbox-vector-tile", "application/vnd.quantized-mesh", "application/json"];

/// How long an answer may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Life {
    /// Its address has the version of the world: it never changes.
    Forever,
    /// It must be checked again before each use.
    Checked,
}

/// The tag of an answer that depends on these parts.
pub fn etag(parts: &[&[u8]]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    format!("\"{}\"", &hex::encode(&hash.finalize())[..32])
}

/// Whether the client has the answer with this tag.
pub fn is_known(headers: &HeaderMap, etag: &str) -> bool {
    let tags = headers.get_all(header::IF_NONE_MATCH).iter().filter_map(|value| value.to_str().ok());
    tags.flat_map(|tags| tags.split(','))
        .map(|tag| tag.trim().trim_start_matches("W/"))
        .any(|tag| tag == etag || tag == "*")
}

/// The answer to a client that has it already.
pub fn not_modified(etag: &str, life: Life, is_private: bool) -> Response {
    let mut response = StatusCode::NOT_MODIFIED.into_response();
    lasting(&mut response, etag, life, is_private);
    response
}

/// An answer of bytes.
pub fn bytes(kind: &'static str, bytes: Bytes) -> Response {
    let mut response = Response::new(Body::from(bytes));
    response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    response
}

/// A part of an answer, if the client asks for one (RFC 9110, section 14): a single range of bytes of the answer with
/// this tag. Requests for several ranges are answered as a whole.
///
/// # Errors
/// If the range begins beyond the end.
pub fn part(headers: &HeaderMap, etag: &str, bytes: Bytes, kind: &'static str) -> Result<Response, Refusal> {
    let length = bytes.len();
    let header = |name| headers.get(name).and_then(|value: &HeaderValue| value.to_str().ok());
    let is_current = header(header::IF_RANGE).is_none_or(|tag| tag == etag);
    let range = header(header::RANGE).filter(|_| is_current).and_then(|range| range.strip_prefix("bytes="));
    let asked = range.and_then(|range| range.trim().split_once('-')).and_then(|(first, last)| {
        match (first.parse::<usize>(), last.parse::<usize>()) {
            (Ok(first), Ok(last)) if first <= last => Some((first, last.saturating_add(1).min(length))),
            (Ok(first), Err(_)) if last.is_empty() => Some((first, length)),
            (Err(_), Ok(count)) if first.is_empty() => Some((length.saturating_sub(count), length)),
            _ => None,
        }
    });
    let whole = |bytes| self::bytes(kind, bytes);
    let mut response = match asked {
        None => whole(bytes),
        Some((first, _)) if first >= length => {
            let message = format!("the answer has {length} bytes, and the range begins at {first}");
            return Err(Refusal { status: StatusCode::RANGE_NOT_SATISFIABLE, message });
        }
        Some((first, end)) => {
            let mut response = whole(bytes.slice(first..end));
            *response.status_mut() = StatusCode::PARTIAL_CONTENT;
            let last = end - 1;
            set(response.headers_mut(), header::CONTENT_RANGE, &format!("bytes {first}-{last}/{length}"));
            response
        }
    };
    response.headers_mut().insert(header::ACCEPT_RANGES, HeaderValue::from_static("bytes"));
    Ok(response)
}

/// A lasting redirect to another address.
pub fn redirect(address: &str) -> Response {
    let mut response = bytes("text/plain; charset=utf-8", Bytes::new());
    *response.status_mut() = StatusCode::PERMANENT_REDIRECT;
    set(response.headers_mut(), header::LOCATION, address);
    response
}

/// Adds the tag, and how long the answer may be used.
pub fn lasting(response: &mut Response, etag: &str, life: Life, is_private: bool) {
    let life = match (life, is_private) {
        (Life::Forever, false) => "public, max-age=31536000, immutable",
        (Life::Forever, true) => "private, max-age=31536000, immutable",
        (Life::Checked, false) => "public, no-cache",
        (Life::Checked, true) => "private, no-cache",
    };
    let headers = response.headers_mut();
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static(life));
    set(headers, header::ETAG, etag);
}

/// Sets a header, if its value is valid.
pub fn set(headers: &mut HeaderMap, name: HeaderName, value: &str) {
    if let Ok(value) = HeaderValue::from_str(value) {
        headers.insert(name, value);
    }
}

/// A text, compressed if the client takes that and asks for no part of it; with the tag of its content.
pub fn text(headers: &HeaderMap, kind: &'static str, text: &str, is_private: bool) -> Result<Response, Refusal> {
    let takes_part = headers.contains_key(header::RANGE);
    let takes_gzip = !takes_part && takes_gzip(headers) && text.len() >= COMPRESSED;
    let tag = etag(&[kind.as_bytes(), text.as_bytes(), &[u8::from(takes_gzip)]]);
    if is_known(headers, &tag) {
        return Ok(not_modified(&tag, Life::Checked, is_private));
    }
    let body = match takes_gzip {
        false => Bytes::copy_from_slice(text.as_bytes()),
        true => gzipped(text.as_bytes())?.into(),
    };
    let mut response = match takes_gzip {
        false => part(headers, &tag, body, kind)?,
        true => bytes(kind, body),
    };
    lasting(&mut response, &tag, Life::Checked, is_private);
    let headers = response.headers_mut();
    headers.insert(header::VARY, HeaderValue::from_static("accept-encoding, host"));
    if takes_gzip {
        headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
    }
    Ok(response)
}

/// Bytes, compressed with gzip.
///
/// # Errors
/// If they cannot be compressed.
pub fn gzipped(bytes: &[u8]) -> Result<Vec<u8>, Refusal> {
    let mut packed = Vec::new();
    let write = gzip::start(&mut packed).and_then(|mut gzip| {
        gzip.write_all(bytes)?;
        gzip::finish(gzip)
    });
    write.map_err(|cause| Refusal {
        status: StatusCode::INTERNAL_SERVER_ERROR,
        message: format!("the answer cannot be compressed: {cause}"),
    })?;
    Ok(packed)
}

/// Whether computed answers of this media type may be compressed.
pub fn is_compressible(kind: &str) -> bool {
    COMPRESSIBLE.contains(&kind)
}

/// Whether an answer of this media type is compressed for a client: it takes gzip and asks for no part.
pub fn compresses(headers: &HeaderMap, kind: &str) -> bool {
    is_compressible(kind) && takes_gzip(headers) && !headers.contains_key(header::RANGE)
}

/// Whether the client takes gzip: it names it, with a weight above 0.
pub fn takes_gzip(headers: &HeaderMap) -> bool {
    let all = headers.get_all(header::ACCEPT_ENCODING).iter().filter_map(|value| value.to_str().ok());
    all.flat_map(|value| value.split(',')).any(|coding| {
        let mut parts = coding.split(';').map(str::trim);
        let name = parts.next().unwrap_or_default();
        let weight = parts.find_map(|part| part.strip_prefix("q=")).map_or(1.0, |weight| weight.parse().unwrap_or(0.0));
        matches!(name, "gzip" | "x-gzip" | "*") && weight > 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(name: HeaderName, value: &'static str) -> HeaderMap {
        HeaderMap::from_iter([(name, HeaderValue::from_static(value))])
    }

    #[test]
    fn encodings_and_tags_are_read() {
        for (value, expect) in [
            ("gzip", true),
            ("br, gzip;q=0.5", true),
            ("gzip;q=0", false),
            ("gzip; q=0.0, br", false),
            ("*", true),
            ("identity", false),
        ] {
            assert_eq!(takes_gzip(&headers(header::ACCEPT_ENCODING, value)), expect, "{value}");
        }
        for (value, expect) in
            [("\"a\"", true), ("W/\"a\"", true), ("\"b\", \"a\"", true), ("*", true), ("\"b\"", false)]
        {
            assert_eq!(is_known(&headers(header::IF_NONE_MATCH, value), "\"a\""), expect, "{value}");
        }
        for (range, status, expect) in [
            ("bytes=0-1", 206, "bytes 0-1/5"),
            ("bytes=3-", 206, "bytes 3-4/5"),
            ("bytes=-2", 206, "bytes 3-4/5"),
            ("bytes=-9", 206, "bytes 0-4/5"),
            ("bytes=2-99", 206, "bytes 2-4/5"),
            ("bytes=0-0,2-3", 200, ""),
            ("bytes=3-2", 200, ""),
            ("bytes=a-b", 200, ""),
            ("lines=0-1", 200, ""),
            ("bytes=18446744073709551615-18446744073709551615", 416, ""),
            ("bytes=5-", 416, ""),
        ] {
            let asked = part(&headers(header::RANGE, range), "\"a\"", Bytes::from_static(b"01234"), "text/plain");
            let response = asked.unwrap_or_else(IntoResponse::into_response);
            let found = response.headers().get(header::CONTENT_RANGE).map_or("", |value| value.to_str().unwrap());
            assert_eq!((response.status().as_u16(), found), (status, expect), "{range}");
        }
        assert_ne!(etag(&[b"ab", b"c"]), etag(&[b"a", b"bc"]));
    }
}
