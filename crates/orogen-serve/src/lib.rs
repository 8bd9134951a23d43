//! A server of Orogen's terrain: map tiles and windows of heights over HTTP, computed when they are requested.
//!
//! A [`Server`] serves worlds: each has map tiles of all its layers, heights as Terrarium and Terrain-RGB, descriptions
//! for map programs (TileJSON, WMTS), windows as files, and heights at points. Nothing is built beforehand, and every
//! sample has the bits that an export has.
//!
//! ```no_run
//! use orogen::options::Options;
//! use orogen::{Session, presets};
//! use orogen_serve::Server;
//! use std::sync::{Arc, atomic::AtomicBool};
//!
//! let session = Session::new(orogen::Options::default())?;
//! let mut server = Server::new(session, &Options::default())?;
//! server.add("hills", presets::find("hills").ok_or("no such preset")?.recipe()?, false)?;
//! println!("http://{}", server.bind()?);
//! server.run(&Arc::new(AtomicBool::new(false)), |line| println!("{line}"))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **Where to look.** `routes` lists the requests, `served` is a world that is served, `desk` computes each answer once
//! within the limits, `connection` speaks HTTP with time limits, `describe` has the texts about a world.
#![forbid(unsafe_code)]

mod answer;
mod cache;
mod call;
mod colors;
mod connection;
mod describe;
mod desk;
mod files;
mod meshes;
mod metrics;
mod objects;
mod page;
mod peers;
mod places;
mod points;
mod query;
mod recent;
mod recipes;
mod refusal;
mod routes;
mod sent;
mod served;
mod server;
mod shared;
mod site;
mod tiles;
mod variants;
mod vector;
mod windows;
mod zarr;

pub use server::Server;

#[cfg(test)]
mod tests;
