//! `/recipes`: worlds of recipes that clients send, if the server was started with `--allow-recipes`.

use std::sync::Arc;
use std::time::Duration;

use axum::body::{Body, Bytes, to_bytes};
use axum::http::{StatusCode, header};
use axum::response::Response;
use orogen::{Error, ErrorKind};
use serde_json::json;

use crate::answer;
use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;
use crate::sent;
use crate::served::Served;

/// Time for the text.
const BODY: Duration = Duration::from_secs(30);

/// `POST /recipes`.
pub async fn post(call: Call, body: Body) -> Result<Response, Refusal> {
    if !call.shared.limits.allows_recipes {
        let status = StatusCode::FORBIDDEN;
        let message = format!("this server takes no recipes; start it with --{}", sent::OPTION);
        return Err(Refusal { status, message });
    }
    call.query.only(&[])?;
    let text = text(&call, body).await?;
    let name = sent::name(&text);
    let (served, status) = match call.shared.recipes.find(&name) {
        Some(served) => (served, StatusCode::OK),
        None => {
            let _seat = call.shared.desk.seat()?;
            let (shared, own) = (Arc::clone(&call.shared), name.clone());
            let work = || {
                Box::new(move |_: &orogen::Progress| {
                    let recipe = sent::read(&text).map_err(|error| wrong(&error))?;
                    let served = Served::sent(&own, &shared.session, recipe).map_err(|error| wrong(&error))?;
                    shared.recipes.keep(&own, served);
                    Ok(Bytes::new())
                }) as Work
            };
            call.shared.desk.get(format!("recipe {name}"), Keep::Nothing, work).await?;
            let missing = || Refusal::busy("other recipes took its place; send the recipe again");
            (call.shared.recipes.find(&name).ok_or_else(missing)?, StatusCode::CREATED)
        }
    };
    let layers: Vec<String> = served.layers().into_iter().map(|layer| layer.name).collect();
    let url = format!("{}/{name}/", call.base(&served));
    let about = json!({ "name": name, "url": url, "about": served.recipe().about, "version": served.version, "layers": layers });
    let mut response = answer::bytes("application/json", about.to_string().into());
    *response.status_mut() = status;
    answer::set(response.headers_mut(), header::LOCATION, &format!("{name}/"));
    answer::set(response.headers_mut(), header::CACHE_CONTROL, "no-store");
    Ok(response)
}

/// The text of a recipe.
async fn text(call: &Call, body: Body) -> Result<String, Refusal> {
    let too_long = || Refusal::too_large(format!("a recipe may have {} bytes; leave something out", sent::MAX_BYTES));
    let length = call.headers.get(header::CONTENT_LENGTH).and_then(|value| value.to_str().ok());
    if length.and_then(|length| length.parse::<u64>().ok()).is_some_and(|length| length > sent::MAX_BYTES as u64) {
        return Err(too_long());
    }
    let read = tokio::time::timeout(BODY, to_bytes(body, sent::MAX_BYTES)).await;
    let late = || Refusal {
        status: StatusCode::REQUEST_TIMEOUT,
        message: format!("the recipe did not arrive within {} s", BODY.as_secs()),
    };
    // The only other error is that the client went away.
    let bytes = read.map_err(|_| late())?.map_err(|_| too_long())?;
    String::from_utf8(bytes.into()).map_err(|cause| {
        let at = cause.utf8_error().valid_up_to();
        Refusal::bad(format!("byte {at} is not UTF-8 text; a recipe is a TOML or JSON text"))
    })
}

/// A recipe that is not valid is a wrong request.
fn wrong(error: &Error) -> Refusal {
    match error.kind() {
        ErrorKind::Memory => Refusal::too_large(error.to_string()),
        ErrorKind::Cancelled => Refusal::of(error),
        _ => Refusal::bad(error.to_string()),
    }
}

/// The answer to other methods.
pub async fn other() -> Refusal {
    let message = "send a recipe as the body of a POST; its world is then at the address in `Location`";
    Refusal { status: StatusCode::METHOD_NOT_ALLOWED, message: message.into() }
}
