//! Places that satisfy conditions.

use axum::response::Response;
use orogen::grid::hex;
use orogen::locate::LocateJob;
use orogen::options::Options;
use orogen::world::check_cell;

use crate::call::Call;
use crate::desk::{Keep, Work};
use crate::refusal::Refusal;

/// The distance between the samples that are searched.
pub const CELL: &str = "cell";

/// `/locate`, with the options of the search as parameters.
pub async fn locate(call: Call) -> Result<Response, Refusal> {
    let specs = LocateJob::OPTIONS;
    let names: Vec<&str> = specs.iter().map(|spec| spec.name).chain([CELL]).collect();
    call.query.only_of_variants(&names)?;
    let served = call.served()?;
    let cell = call.query.number(CELL)?;
    cell.map_or(Ok(()), check_cell)?;
    let given =
        call.query.pairs().filter(|(name, value)| specs.iter().any(|spec| spec.name == *name) && !value.is_empty());
    let job = LocateJob::new(&Options::of(specs, given)?)?.with_cell(cell);
    let mut recipe = served.recipe().clone();
    job.prepare(&mut recipe)?;
    let mut key = format!("locate {} {} {}", served.name, served.version, call.query.text());
    for layer in job.layers() {
        let fingerprint = served.fingerprint(layer).map_err(|error| Refusal::of(&error).or_absent())?;
        key += &format!(" {}", hex::encode(&fingerprint));
    }
    let session = served.session().clone();
    let work = async || {
        Ok(Box::new(move |progress: &orogen::Progress| Ok(job.run(&session.open(recipe)?, progress)?.to_json().into()))
            as Work)
    };
    call.worked(&served, (key, Keep::Nothing), "application/json", work).await
}
