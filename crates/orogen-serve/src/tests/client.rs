//! A server in this process, and a client that sends what it is told.

use std::collections::HashMap;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

use orogen::options::Options;
use orogen::{Recipe, Result, Session, World};

use crate::Server;

/// A running server; it is stopped when this is dropped.
pub struct Running {
    pub address: SocketAddr,
    pub lines: Arc<Mutex<Vec<String>>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Result<()>>>,
}

/// An answer.
#[derive(Debug)]
pub struct Reply {
    pub status: u16,
    pub headers: HashMap<String, String>,
    pub body: Vec<u8>,
}

impl Reply {
    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.body).unwrap()
    }

    pub fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|cause| panic!("{cause}: {self:?}"))
    }

    pub fn header(&self, name: &str) -> &str {
        self.headers.get(name).map_or("", String::as_str)
    }

    /// The pixels of a picture.
    pub fn pixels(&self) -> Vec<u8> {
        let mut reader = png::Decoder::new(std::io::Cursor::new(&self.body)).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut data).unwrap();
        data
    }
}

pub fn session() -> Session {
    Session::new(orogen::Options { threads: Some(2), ..orogen::Options::default() }).unwrap()
}

pub fn options(given: &[(&'static str, &str)]) -> Options {
    Options::of(Server::OPTIONS, [("port", "0")].iter().chain(given).map(|(name, text)| (*name, *text))).unwrap()
}

pub fn recipe(text: &str) -> Recipe {
    Recipe::parse(text, "test").unwrap()
}

pub fn world(text: &str) -> World {
    World::open(recipe(text)).unwrap()
}

pub fn start(worlds: &[(&str, &str)], given: &[(&'static str, &str)]) -> Running {
    started(session(), worlds, given)
}

/// A server with this much memory.
pub fn start_within(worlds: &[(&str, &str)], given: &[(&'static str, &str)], memory: u64) -> Running {
    let options =
        orogen::Options { threads: Some(2), memory: orogen::Budget::of(memory), ..orogen::Options::default() };
    started(Session::new(options).unwrap(), worlds, given)
}

fn started(session: Session, worlds: &[(&str, &str)], given: &[(&'static str, &str)]) -> Running {
    let mut server = Server::new(session, &options(given)).unwrap();
    for (name, text) in worlds {
        server.add(name, recipe(text), false).unwrap();
    }
    let address = server.bind().unwrap();
    let (stop, lines) = (Arc::new(AtomicBool::new(false)), Arc::new(Mutex::new(Vec::new())));
    let (flag, log) = (Arc::clone(&stop), Arc::clone(&lines));
    let thread = std::thread::spawn(move || server.run(&flag, move |line| log.lock().unwrap().push(line.to_string())));
    Running { address, lines, stop, thread: Some(thread) }
}

impl Running {
    pub fn connect(&self) -> TcpStream {
        TcpStream::connect(self.address).unwrap()
    }

    /// Sends bytes, and reads the answer until the server closes the connection.
    pub fn send(&self, bytes: &[u8]) -> Vec<u8> {
        let mut stream = self.connect();
        // The server may close the connection before it has read everything.
        let _ = stream.write_all(bytes);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        answer
    }

    /// Sends bytes that may be no whole request, and says that there are no more.
    pub fn send_all(&self, bytes: &[u8]) -> Vec<u8> {
        let mut stream = self.connect();
        let _ = stream.write_all(bytes).and_then(|()| stream.shutdown(std::net::Shutdown::Write));
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        answer
    }

    pub fn ask(&self, method: &str, path: &str, headers: &[&str]) -> Reply {
        self.try_ask(method, path, headers).unwrap_or_else(|| panic!("{method} {path} has no answer"))
    }

    /// As [`Running::ask`]; `None` if the server ended the connection first.
    fn try_ask(&self, method: &str, path: &str, headers: &[&str]) -> Option<Reply> {
        let headers: String = headers.iter().map(|header| format!("{header}\r\n")).collect();
        let head = format!("{method} {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n{headers}\r\n", self.address);
        parsed(&self.send(head.as_bytes()))
    }

    pub fn get(&self, path: &str) -> Reply {
        self.ask("GET", path, &[])
    }

    /// The answer at an address of a description.
    pub fn follow(&self, address: &str) -> Reply {
        let own = format!("http://{}", self.address);
        self.get(address.strip_prefix(&own).unwrap_or_else(|| panic!("{address} is not at {own}")))
    }

    /// A number of `/metrics`.
    pub fn metric(&self, name: &str) -> u64 {
        number(&self.get("/metrics"), name)
    }

    /// Waits until a number of `/metrics` has a value. A server whose connections are all still busy is asked again.
    pub fn wait(&self, name: &str, value: u64) {
        let reply = || self.try_ask("GET", "/metrics", &[]).filter(|reply| reply.status != 503);
        while reply().is_none_or(|reply| number(&reply, name) != value) {
            std::thread::yield_now();
        }
    }

    pub fn end(&mut self) -> Result<()> {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take().map_or(Ok(()), |thread| thread.join().unwrap())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let ended = self.end();
        if !std::thread::panicking() {
            ended.unwrap();
        }
    }
}

/// A number of the answer of `/metrics`.
fn number(reply: &Reply, name: &str) -> u64 {
    let line = reply.text().lines().find_map(|line| line.strip_prefix(&format!("{name} "))).map(str::to_string);
    line.unwrap_or_else(|| panic!("no {name}")).parse().unwrap()
}

/// Splits an answer; `None` if it is none.
pub fn parsed(bytes: &[u8]) -> Option<Reply> {
    let end = bytes.windows(4).position(|four| four == b"\r\n\r\n")?;
    let head = std::str::from_utf8(&bytes[..end]).ok()?;
    let mut lines = head.lines();
    let status = lines.next()?.strip_prefix("HTTP/1.1 ")?.get(..3)?.parse().ok()?;
    let headers = lines.filter_map(|line| line.split_once(": "));
    let headers = headers.map(|(name, value)| (name.to_lowercase(), value.to_string())).collect();
    Some(Reply { status, headers, body: bytes[end + 4..].to_vec() })
}
