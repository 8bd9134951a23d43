//! Refusals: the errors of requests, as JSON.

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use orogen::{Error, ErrorKind};
use serde_json::json;

/// Seconds after which a client may try again.
const RETRY: u32 = 2;

/// Maximum length of a word of a message, in characters.
const LONGEST_WORD: usize = 400;

/// Why a request has no answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    pub status: StatusCode,
    pub message: String,
}

impl Refusal {
    /// The request is wrong.
    pub fn bad(message: impl Into<String>) -> Refusal {
        Refusal { status: StatusCode::BAD_REQUEST, message: message.into() }
    }

    /// There is no such thing.
    pub fn absent(message: impl Into<String>) -> Refusal {
        Refusal { status: StatusCode::NOT_FOUND, message: message.into() }
    }

    /// The request asks for too much.
    pub fn too_large(message: impl Into<String>) -> Refusal {
        Refusal { status: StatusCode::PAYLOAD_TOO_LARGE, message: message.into() }
    }

    /// There is no room or no time for it now.
    pub fn busy(message: impl Into<String>) -> Refusal {
        Refusal { status: StatusCode::SERVICE_UNAVAILABLE, message: message.into() }
    }

    /// An error of the engine. Options of the command line in its message become parameters of requests.
    pub fn of(error: &Error) -> Refusal {
        let message = [("--bounds", "bbox"), ("--size", "width and height"), ("--", "")]
            .iter()
            .fold(error.to_string(), |message, (option, parameter)| message.replace(option, parameter));
        match error.kind() {
            ErrorKind::Request => Refusal::bad(message),
            ErrorKind::Memory => Refusal::too_large(message),
            ErrorKind::Cancelled => Refusal::busy("the work was cancelled; send the request again"),
            _ => Refusal { status: StatusCode::INTERNAL_SERVER_ERROR, message },
        }
    }

    /// The same for something that is missing, if it was a wrong request.
    pub fn or_absent(self) -> Refusal {
        match self.status {
            StatusCode::BAD_REQUEST => Refusal::absent(self.message),
            _ => self,
        }
    }
}

/// A message without what is too long to be a word in it, which a request can have.
fn shortened(message: &str) -> String {
    let short = |word: &str| match word.char_indices().nth(LONGEST_WORD) {
        Some((end, _)) => word[..end].to_string() + "...",
        None => word.to_string(),
    };
    message.split(' ').map(short).collect::<Vec<_>>().join(" ")
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Refusal {
        Refusal::of(&error)
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        let body = json!({ "error": shortened(&self.message) }).to_string();
        let mut response = (self.status, body).into_response();
        let headers = response.headers_mut();
        headers.insert(header::CONTENT_TYPE, HeaderValue::from_static("application/json"));
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
        match self.status {
            StatusCode::SERVICE_UNAVAILABLE => drop(headers.insert(header::RETRY_AFTER, HeaderValue::from(RETRY))),
            StatusCode::UNAUTHORIZED => {
                headers.insert(header::WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
            }
            _ => {}
        }
        response
    }
}
