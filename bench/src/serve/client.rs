//! A server in a process of its own, and connections to it that stay open.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// The environment variable with the program to run: `cargo xtask bench` builds it and sets this.
const PROGRAM: &str = "OROGEN_BIN";

/// The longest wait for a part of an answer.
const WAIT: Duration = Duration::from_secs(120);

/// A running server; it is ended when this is dropped.
pub struct Server {
    process: Child,
    pub address: SocketAddr,
}

impl Server {
    /// Serves worlds with these options.
    pub fn start(arguments: &[&str]) -> Result<Server, String> {
        Server::start_with(arguments, &[])
    }

    /// Serves worlds with these options, in a process with these variables.
    pub fn start_with(arguments: &[&str], variables: &[(&str, &str)]) -> Result<Server, String> {
        let program = std::env::var_os(PROGRAM)
            .map(PathBuf::from)
            .ok_or_else(|| format!("{PROGRAM} is not set: run `cargo xtask bench serve`"))?;
        let failed = |cause: std::io::Error| format!("{}: {cause}", program.display());
        let mut command = Command::new(&program);
        command.arg("serve").args(arguments).args(["--port", "0", "--quiet"]).envs(variables.iter().copied());
        let mut process = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().map_err(failed)?;
        let mut line = String::new();
        if let Some(output) = process.stdout.take() {
            BufReader::new(output).read_line(&mut line).map_err(failed)?;
        }
        let address = line.split("http://").nth(1).and_then(|rest| rest.trim().trim_end_matches('/').parse().ok());
        match address {
            Some(address) => Ok(Server { process, address }),
            None => Err(format!("`orogen serve {}` said `{}`", arguments.join(" "), line.trim())),
        }
    }

    /// A number that the system has of the process, in bytes: `VmHWM` is its largest memory, `VmRSS` that of now.
    pub fn memory(&self, name: &str) -> Result<u64, String> {
        let path = format!("/proc/{}/status", self.process.id());
        let text = std::fs::read_to_string(&path).map_err(|cause| format!("{path}: {cause}"))?;
        let line = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'));
        let kibibytes = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse::<u64>().ok());
        kibibytes.map(|count| count << 10).ok_or_else(|| format!("{path} has no {name}"))
    }

    /// A number of `/metrics`.
    pub fn metric(&self, name: &str) -> Result<u64, String> {
        let (_, body) = Connection::open(self.address)?.get("/metrics")?;
        let text = String::from_utf8_lossy(&body).into_owned();
        let value = text.lines().find_map(|line| line.strip_prefix(&format!("{name} "))?.parse().ok());
        value.ok_or_else(|| format!("/metrics has no {name}"))
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A connection that stays open.
pub struct Connection {
    stream: BufReader<TcpStream>,
}

impl Connection {
    /// Connects.
    pub fn open(address: SocketAddr) -> Result<Connection, String> {
        let stream = TcpStream::connect(address).map_err(|cause| cause.to_string())?;
        let set = stream.set_nodelay(true).and_then(|()| stream.set_read_timeout(Some(WAIT)));
        set.map_err(|cause| cause.to_string())?;
        Ok(Connection { stream: BufReader::new(stream) })
    }

    /// Sends a request, without waiting for the answer.
    pub fn send(&mut self, path: &str) -> Result<(), String> {
        self.send_raw(&format!("GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n"))
    }

    /// Sends a text, which may be no whole request.
    pub fn send_raw(&mut self, text: &str) -> Result<(), String> {
        self.stream.get_mut().write_all(text.as_bytes()).map_err(|cause| format!("{}: {cause}", text.trim()))
    }

    /// The status and the body of an answer.
    pub fn get(&mut self, path: &str) -> Result<(u16, Vec<u8>), String> {
        self.send(path)?;
        let failed = |cause: std::io::Error| format!("{path}: {cause}");
        let mut line = String::new();
        self.stream.read_line(&mut line).map_err(failed)?;
        let status = line.split(' ').nth(1).and_then(|code| code.parse().ok());
        let status = status.ok_or_else(|| format!("{path}: the answer begins with `{}`", line.trim()))?;
        let mut length = 0usize;
        loop {
            line.clear();
            self.stream.read_line(&mut line).map_err(failed)?;
            let Some((name, value)) = line.split_once(':') else { break };
            if name.eq_ignore_ascii_case("content-length") {
                length = value.trim().parse().map_err(|_| format!("{path}: a length of `{}`", value.trim()))?;
            }
        }
        let mut body = vec![0; length];
        self.stream.read_exact(&mut body).map_err(failed)?;
        Ok((status, body))
    }
}
