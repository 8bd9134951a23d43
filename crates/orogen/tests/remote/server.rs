//! A server on loopback that keeps objects in memory and speaks as much of S3's protocol as clients use: objects,
//! ranges, conditions, listings and uploads in parts. It can fail every few requests, like real ones.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

/// What a server does instead of answering a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// Answers with this status.
    Status(u16),
    /// Closes the connection without an answer, although the request was carried out.
    Silence,
    /// Sends half of the answer.
    Half,
}

#[derive(Debug, Default)]
struct Kept {
    objects: BTreeMap<String, Vec<u8>>,
    /// Parts of uploads that are not complete, by upload and number.
    parts: BTreeMap<(String, u32), Vec<u8>>,
    failures: Vec<Failure>,
}

/// The server. It ends with the process.
#[derive(Debug, Clone)]
pub struct Server {
    kept: Arc<Mutex<Kept>>,
    requests: Arc<AtomicU64>,
    sent: Arc<AtomicU64>,
    /// Its address, such as `127.0.0.1:40001`.
    pub address: String,
}

struct Request {
    method: String,
    /// The path without the slash at the start, decoded: bucket and name.
    name: String,
    query: BTreeMap<String, String>,
    headers: BTreeMap<String, String>,
    body: Vec<u8>,
}

struct Answer {
    status: u16,
    headers: Vec<(&'static str, String)>,
    body: Vec<u8>,
}

impl Answer {
    fn new(status: u16) -> Answer {
        Answer { status, headers: Vec::new(), body: Vec::new() }
    }

    fn xml(status: u16, text: String) -> Answer {
        let headers = vec![("Content-Type", "application/xml".to_string())];
        Answer { status, headers, body: format!("<?xml version=\"1.0\"?>{text}").into_bytes() }
    }
}

impl Server {
    pub fn start() -> Server {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let server = Server { kept: Arc::default(), requests: Arc::default(), sent: Arc::default(), address };
        let serving = server.clone();
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let server = serving.clone();
                // A client that closes its connection is no failure.
                std::thread::spawn(move || drop(server.serve(&stream)));
            }
        });
        server
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap()
    }

    /// Fails from now on: every twelfth request in one of these ways, in turn.
    pub fn fail(&self, failures: &[Failure]) {
        self.kept().failures = failures.to_vec();
    }

    /// The objects whose names start so, by the rest of their names.
    pub fn objects(&self, start: &str) -> BTreeMap<String, Vec<u8>> {
        let kept = self.kept();
        let with = kept.objects.iter().filter_map(|(name, bytes)| Some((name.strip_prefix(start)?, bytes)));
        with.map(|(name, bytes)| (name.to_string(), bytes.clone())).collect()
    }

    /// Number of parts of uploads that were neither completed nor given up.
    pub fn parts(&self) -> usize {
        self.kept().parts.len()
    }

    pub fn put(&self, name: &str, bytes: Vec<u8>) {
        self.kept().objects.insert(name.to_string(), bytes);
    }

    pub fn requests(&self) -> u64 {
        self.requests.load(Ordering::Relaxed)
    }

    /// Number of bytes of objects that were sent.
    pub fn sent(&self) -> u64 {
        self.sent.load(Ordering::Relaxed)
    }

    fn serve(&self, stream: &TcpStream) -> std::io::Result<()> {
        let mut reader = BufReader::new(stream);
        while let Some(request) = read(&mut reader)? {
            let count = self.requests.fetch_add(1, Ordering::Relaxed);
            let failure = {
                let kept = self.kept();
                let is_due = count % 12 == 11 && !kept.failures.is_empty();
                is_due.then(|| kept.failures[count as usize / 12 % kept.failures.len()])
            };
            let answer = match failure {
                Some(Failure::Status(status)) => {
                    Answer::xml(status, "<Error><Code>SlowDown</Code><Message>Slow down.</Message></Error>".into())
                }
                _ => self.answer(&request),
            };
            if failure == Some(Failure::Silence) {
                return Ok(());
            }
            if request.method == "GET" {
                self.sent.fetch_add(answer.body.len() as u64, Ordering::Relaxed);
            }
            let is_head = request.method == "HEAD";
            let mut head = format!("HTTP/1.1 {} X\r\n", answer.status);
            for (name, value) in &answer.headers {
                head.push_str(&format!("{name}: {value}\r\n"));
            }
            if !is_head {
                head.push_str(&format!("Content-Length: {}\r\n", answer.body.len()));
            }
            head.push_str("\r\n");
            let mut out = stream;
            out.write_all(head.as_bytes())?;
            match (is_head, failure) {
                (true, _) => {}
                (false, Some(Failure::Half)) => return out.write_all(&answer.body[..answer.body.len() / 2]),
                (false, _) => out.write_all(&answer.body)?,
            }
        }
        Ok(())
    }

    fn answer(&self, request: &Request) -> Answer {
        let mut kept = self.kept();
        let (name, query) = (&request.name, &request.query);
        let upload = query.get("uploadId");
        match request.method.as_str() {
            "GET" if query.contains_key("list-type") => list(&kept.objects, name, query),
            "GET" | "HEAD" => get(&kept.objects, request),
            "PUT" if upload.is_some() => {
                let number = query["partNumber"].parse().unwrap();
                kept.parts.insert((upload.unwrap().clone(), number), request.body.clone());
                Answer { headers: vec![("ETag", tag(&request.body))], ..Answer::new(200) }
            }
            "PUT" => {
                if request.headers.get("if-none-match").is_some_and(|tag| tag == "*") && kept.objects.contains_key(name)
                {
                    return Answer::xml(412, "<Error><Code>PreconditionFailed</Code></Error>".into());
                }
                kept.objects.insert(name.clone(), request.body.clone());
                Answer { headers: vec![("ETag", tag(&request.body))], ..Answer::new(200) }
            }
            "POST" if query.contains_key("uploads") => {
                let id = format!("upload-{}", self.requests());
                Answer::xml(
                    200,
                    format!("<InitiateMultipartUploadResult><UploadId>{id}</UploadId></InitiateMultipartUploadResult>"),
                )
            }
            "POST" if upload.is_some() => {
                let id = upload.unwrap().clone();
                let numbers: Vec<(String, u32)> = kept.parts.keys().filter(|(of, _)| *of == id).cloned().collect();
                let whole: Vec<u8> = numbers.iter().flat_map(|key| kept.parts.remove(key).unwrap()).collect();
                // Completed before, if the answer was lost.
                if !whole.is_empty() {
                    kept.objects.insert(name.clone(), whole);
                }
                let tag = tag(&kept.objects[name]);
                Answer::xml(
                    200,
                    format!("<CompleteMultipartUploadResult><ETag>{tag}</ETag></CompleteMultipartUploadResult>"),
                )
            }
            "POST" if query.contains_key("delete") => {
                let text = String::from_utf8_lossy(&request.body).into_owned();
                let mut removed = String::new();
                for key in text.split("<Key>").skip(1).filter_map(|rest| rest.split("</Key>").next()) {
                    let bucket = name.trim_end_matches('/');
                    kept.objects.remove(&format!("{bucket}/{key}"));
                    removed.push_str(&format!("<Deleted><Key>{key}</Key></Deleted>"));
                }
                Answer::xml(200, format!("<DeleteResult>{removed}</DeleteResult>"))
            }
            "DELETE" if upload.is_some() => {
                let id = upload.unwrap().clone();
                kept.parts.retain(|(of, _), _| *of != id);
                Answer::new(204)
            }
            "DELETE" => {
                kept.objects.remove(name);
                Answer::new(204)
            }
            _ => Answer::new(405),
        }
    }
}

fn tag(bytes: &[u8]) -> String {
    let hash = bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3));
    format!("\"{hash:016x}\"")
}

fn get(objects: &BTreeMap<String, Vec<u8>>, request: &Request) -> Answer {
    let Some(bytes) = objects.get(&request.name) else {
        return Answer::xml(404, "<Error><Code>NoSuchKey</Code><Message>No such key.</Message></Error>".into());
    };
    if request.headers.get("if-match").is_some_and(|expect| *expect != tag(bytes)) {
        return Answer::new(412);
    }
    let mut headers = vec![
        ("ETag", tag(bytes)),
        ("Last-Modified", "Wed, 25 Nov 2026 10:00:00 GMT".to_string()),
        ("Accept-Ranges", "bytes".to_string()),
    ];
    let range = request.headers.get("range").and_then(|range| range.strip_prefix("bytes=")?.split_once('-'));
    let (status, body) = match range {
        Some((start, end)) => {
            let start: usize = start.parse().unwrap();
            let end = (end.parse::<usize>().unwrap() + 1).min(bytes.len());
            headers.push(("Content-Range", format!("bytes {start}-{}/{}", end - 1, bytes.len())));
            (206, bytes[start..end].to_vec())
        }
        None => (200, bytes.clone()),
    };
    if request.method == "HEAD" {
        headers.push(("Content-Length", bytes.len().to_string()));
    }
    Answer { status, headers, body }
}

fn list(objects: &BTreeMap<String, Vec<u8>>, bucket: &str, query: &BTreeMap<String, String>) -> Answer {
    let bucket = bucket.trim_end_matches('/');
    let prefix = query.get("prefix").map_or("", String::as_str);
    let (mut folders, mut text) = (Vec::new(), String::new());
    for (name, bytes) in objects {
        let Some(key) = name.strip_prefix(bucket).and_then(|name| name.strip_prefix('/')) else { continue };
        let Some(rest) = key.strip_prefix(prefix) else { continue };
        match rest.split_once('/') {
            Some((folder, _)) if query.contains_key("delimiter") => folders.push(format!("{prefix}{folder}/")),
            _ => text.push_str(&format!(
                "<Contents><Key>{key}</Key><Size>{}</Size><LastModified>2026-11-25T10:00:00.000Z</LastModified><ETag>{}</ETag></Contents>",
                bytes.len(),
                tag(bytes).replace('"', "&quot;")
            )),
        }
    }
    folders.dedup();
    let folders: String =
        folders.iter().map(|folder| format!("<CommonPrefixes><Prefix>{folder}</Prefix></CommonPrefixes>")).collect();
    Answer::xml(200, format!("<ListBucketResult><IsTruncated>false</IsTruncated>{text}{folders}</ListBucketResult>"))
}

/// Reads a request; `None` at the end of the connection.
fn read(reader: &mut BufReader<&TcpStream>) -> std::io::Result<Option<Request>> {
    let mut line = String::new();
    if reader.read_line(&mut line)? == 0 {
        return Ok(None);
    }
    let mut words = line.split_whitespace();
    let (method, target) = (words.next().unwrap_or_default().to_string(), words.next().unwrap_or_default().to_string());
    let mut headers = BTreeMap::new();
    loop {
        let mut line = String::new();
        reader.read_line(&mut line)?;
        let Some((name, value)) = line.trim_end().split_once(':') else { break };
        headers.insert(name.to_lowercase(), value.trim().to_string());
    }
    let length = headers.get("content-length").map_or(0, |length| length.parse().unwrap());
    let mut body = vec![0; length];
    reader.read_exact(&mut body)?;
    let (path, query) = target.split_once('?').unwrap_or((&target, ""));
    let pairs = query.split('&').filter(|pair| !pair.is_empty());
    let pairs = pairs.map(|pair| pair.split_once('=').unwrap_or((pair, "")));
    let query = pairs.map(|(key, value)| (decoded(key), decoded(value))).collect();
    Ok(Some(Request { method, name: decoded(path.trim_start_matches('/')), query, headers, body }))
}

fn decoded(text: &str) -> String {
    let bytes = text.as_bytes();
    let (mut out, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let hex = (bytes[at] == b'%').then(|| text.get(at + 1..at + 3)).flatten();
        match hex.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => (out.push(byte), at += 3),
            None => (out.push(bytes[at]), at += 1),
        };
    }
    String::from_utf8(out).unwrap()
}
