//! `orogen devices`.

use crate::failure::Failure;
use crate::say;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print the list as JSON instead of text
    #[arg(long)]
    json: bool,
}

/// A graphics card in the list.
#[derive(Debug, serde::Serialize)]
struct Row {
    number: usize,
    name: String,
    kind: &'static str,
    interface: &'static str,
    driver: String,
    buffer_bytes: u64,
    workgroups: u32,
    /// The reason why it cannot be used.
    refused: Option<String>,
}

/// Lists the graphics cards.
pub fn run(args: &Args) -> Result<(), Failure> {
    let rows = rows();
    if args.json {
        let text = serde_json::to_string_pretty(&rows).map_err(|cause| Failure::Usage(cause.to_string()))?;
        return say::out(&(text + "\n"));
    }
    say::out(&table(&rows))
}

#[cfg(feature = "gpu")]
fn rows() -> Vec<Row> {
    let row = |adapter: orogen::gpu::Adapter| Row {
        number: adapter.index,
        name: adapter.name,
        kind: adapter.kind.name(),
        interface: adapter.interface,
        driver: adapter.driver,
        buffer_bytes: adapter.limits.buffer,
        workgroups: adapter.limits.workgroups,
        refused: adapter.refused,
    };
    orogen::gpu::adapters().into_iter().map(row).collect()
}

#[cfg(not(feature = "gpu"))]
fn rows() -> Vec<Row> {
    Vec::new()
}

/// The message if there is nothing to list.
const NOTHING: &str = if cfg!(feature = "gpu") {
    "no graphics card: no driver for Vulkan, Metal or Direct3D 12 was found\nall commands use the processor\n"
} else {
    "this program was built without graphics cards; `cargo build --release --features gpu` builds it with them\nall commands use the processor\n"
};

fn table(rows: &[Row]) -> String {
    if rows.is_empty() {
        return NOTHING.to_string();
    }
    let mut text = String::new();
    for Row { number, name, kind, interface, driver, buffer_bytes, refused, .. } in rows {
        text.push_str(&format!("{number}  {name}\n   {kind}, {interface}, buffers up to {} MiB\n", buffer_bytes >> 20));
        if !driver.is_empty() {
            text.push_str(&format!("   driver: {driver}\n"));
        }
        if let Some(why) = refused {
            text.push_str(&format!("   cannot be used: {why}\n"));
        }
    }
    let usable = |row: &&Row| row.refused.is_none();
    let names =
        |row: Option<&Row>| row.map_or("the processor".to_string(), |row| format!("{}, {}", row.number, row.name));
    text.push_str(&format!(
        "\n--device gpu uses {}\n--device auto uses {}\n",
        names(rows.iter().find(usable)),
        names(rows.iter().filter(usable).find(|row| row.kind != "software")),
    ));
    text
}
