//! Clients that send what no browser would.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};

use super::client::{Reply, Running, parsed, start};
use super::{HILLS, PLAIN};

/// Reads until the server closes the connection or the answer is whole.
fn read(stream: &mut TcpStream) -> Option<Reply> {
    let mut bytes = Vec::new();
    loop {
        if let Some(reply) = parsed(&bytes) {
            let length: usize = reply.header("content-length").parse().unwrap_or(0);
            if reply.body.len() >= length {
                return Some(reply);
            }
        }
        let mut more = [0; 4096];
        match stream.read(&mut more) {
            Ok(0) | Err(_) => return parsed(&bytes),
            Ok(count) => bytes.extend(&more[..count]),
        }
    }
}

fn ask(stream: &mut TcpStream, path: &str) -> Option<Reply> {
    stream.write_all(format!("GET {path} HTTP/1.1\r\nHost: a\r\n\r\n").as_bytes()).ok()?;
    read(stream)
}

#[test]
fn idle_connections_make_room_for_those_that_ask() {
    let server = start(&[("hills", HILLS)], &[("connections", "4")]);
    let mut idle: Vec<TcpStream> = (0..4).map(|_| server.connect()).collect();
    // Half of a request, and less, is no request.
    idle[0].write_all(b"GET /healthz HTTP/1.1\r\nHost: a\r\n").unwrap();
    idle[1].write_all(b"P").unwrap();
    idle[2].write_all(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n").unwrap();
    for _ in 0..20 {
        let mut stream = server.connect();
        assert_eq!(ask(&mut stream, "/healthz").map(|reply| reply.status), Some(200));
        idle.push(stream);
        assert!(server.metric("orogen_connections") <= 4);
    }
    for mut stream in idle.drain(..4) {
        // What was sent before it was closed is not an answer.
        assert_eq!(read(&mut stream).map(|reply| reply.status), None);
    }
    assert!(server.metric("orogen_connections_displaced_total") >= 20);
    assert_eq!(server.metric("orogen_connections_refused_total"), 0);
}

#[test]
fn a_connection_beyond_the_limit_is_told_so_if_all_others_are_busy() {
    const ENDLESS: &[u8] = b"GET /window.npy?bbox=0,-300000,300000,0&width=30000 HTTP/1.1\r\nHost: a\r\n\r\n";
    let server = start(&[("plain", PLAIN)], &[("connections", "3"), ("max-samples", "10000000000")]);
    let mut busy: Vec<TcpStream> = (0..2).map(|_| server.connect()).collect();
    busy.iter_mut().for_each(|stream| stream.write_all(ENDLESS).unwrap());
    let mut third = server.connect();
    while ask(&mut third, "/metrics").is_none_or(|reply| !reply.text().contains("orogen_work_pending 1\n")) {
        std::thread::yield_now();
    }
    third.write_all(ENDLESS).unwrap();
    let refused = loop {
        let mut fourth = server.connect();
        match ask(&mut fourth, "/healthz") {
            // The third one was not busy yet, and had to go.
            Some(reply) if reply.status == 200 => {
                third = fourth;
                third.write_all(ENDLESS).unwrap();
            }
            Some(reply) => break reply,
            None => {}
        }
    };
    assert_eq!((refused.status, refused.header("retry-after")), (503, "2"));
    assert!(refused.json()["error"].as_str().unwrap().contains("raise --connections"));
    drop(busy);
    drop(third);
    server.wait("orogen_work_pending", 0);
}

#[test]
fn heads_that_are_too_large_are_refused() {
    let server = start(&[("hills", HILLS)], &[]);
    let head = |more: &str| format!("GET /healthz HTTP/1.1\r\nHost: a\r\nConnection: close\r\n{more}\r\n");
    let lines = |count: usize, value: &str| (0..count).map(|k| format!("X-{k}: {value}\r\n")).collect::<String>();
    for (request, expect) in [
        (head(&lines(62, "y")), Some(200)),
        (head(&lines(63, "y")), Some(431)),
        (head(&lines(1000, "y")), Some(431)),
        (head(&format!("X: {}\r\n", "y".repeat(1 << 20))), Some(431)),
        (head(&lines(60, &"y".repeat(1000))), Some(431)),
        (head(&format!("{}: y\r\n", "x".repeat(100_000))), Some(431)),
        (format!("GET /{} HTTP/1.1\r\nHost: a\r\n\r\n", "a".repeat(1 << 20)), Some(414)),
        (format!("GET /?{} HTTP/1.1\r\nHost: a\r\n\r\n", "a=1&".repeat(1 << 16)), Some(414)),
        (format!("{} / HTTP/1.1\r\nHost: a\r\n\r\n", "A".repeat(1 << 20)), Some(400)),
        ("GET / HTTP/9.9\r\nHost: a\r\n\r\n".into(), Some(400)),
        (head("X : y\r\n"), Some(400)),
        (head("X\0: y\r\n"), Some(400)),
        (head("Content-Length: -1\r\n"), Some(400)),
        (head("Content-Length: 1\r\nContent-Length: 2\r\n"), Some(400)),
        (head("Transfer-Encoding: chunked, nonsense\r\n"), Some(400)),
    ] {
        let shown: String = request.chars().take(100).collect();
        let status = parsed(&server.send(request.as_bytes())).map(|reply| reply.status);
        // A connection may be reset before its answer is read, if more was sent than the server read.
        let is_large = request.len() > 32 << 10;
        assert!(
            status == expect || (is_large && status.is_none_or(|status| (400..500).contains(&status))),
            "{shown}: {status:?}"
        );
    }
    assert_eq!(server.get("/healthz").text(), "ok\n");
}

#[test]
fn wrong_methods_and_bodies_are_refused() {
    let server = start(&[("hills", HILLS)], &[]);
    for method in ["POST", "PUT", "DELETE", "PATCH", "TRACE", "CONNECT", "PROPFIND", "get", "X"] {
        for path in ["/", "/height?x=5&y=-5", "/hills/", "/tiles/height/0/0/0.png?grid=world", "/zarr/zarr.json"] {
            let target = if method == "CONNECT" { "a:80" } else { path };
            let head = format!("{method} {target} HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n");
            let reply = parsed(&server.send(head.as_bytes())).unwrap_or_else(|| panic!("{method} {path}"));
            assert!((400..500).contains(&reply.status), "{method} {path}: {}", reply.status);
            assert!(reply.body.is_empty() || !reply.json()["error"].as_str().unwrap().is_empty(), "{method} {path}");
        }
    }
    // A body that nobody reads: the answer comes, and the connection ends instead of reading it.
    let mut stream = server.connect();
    stream.write_all(b"POST /height HTTP/1.1\r\nHost: a\r\nContent-Length: 99999999999\r\n\r\n").unwrap();
    assert_eq!(read(&mut stream).map(|reply| reply.status), Some(405));
    let mut sent = 0usize;
    while sent < 1 << 30 && stream.write_all(&[0; 1 << 16]).is_ok() {
        sent += 1 << 16;
    }
    assert!(sent < 1 << 30);
    let get = b"GET /healthz HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nConnection: close\r\n\r\nhello";
    assert_eq!(parsed(&server.send(get)).map(|reply| reply.status), Some(200));
}

/// The statuses in what a connection received.
fn statuses(received: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(received).into_owned();
    text.split("HTTP/1.1 ").skip(1).map(|part| part[..3].to_string()).collect()
}

#[test]
fn requests_in_a_row_are_answered_in_their_order() {
    let server = start(&[("hills", HILLS)], &[]);
    const PATHS: [(&str, &str); 4] =
        [("/healthz", "200"), ("/nothing/here", "404"), ("/height?x=5&y=-5", "200"), ("/height?x=a", "400")];
    let request = |path: &str, more: &str| format!("GET {path} HTTP/1.1\r\nHost: a\r\n{more}\r\n");
    let mut many: String = (0..199).map(|k| request(PATHS[k % 4].0, "")).collect();
    many += &request(PATHS[3].0, "Connection: close\r\n");
    let expect: Vec<&str> = (0..200).map(|k| PATHS[k % 4].1).collect();
    assert_eq!(statuses(&server.send(many.as_bytes())), expect);
    // What follows a request that is none is not answered.
    let many = request("/healthz", "") + "nonsense\r\n\r\n" + &request("/healthz", "");
    assert_eq!(statuses(&server.send(many.as_bytes())), ["200", "400"]);
}

/// A frame of HTTP/2 (RFC 9113, section 4.1).
fn frame(kind: u8, flags: u8, stream: u32, payload: &[u8]) -> Vec<u8> {
    let length = (payload.len() as u32).to_be_bytes();
    [&length[1..], &[kind, flags], &stream.to_be_bytes(), payload].concat()
}

/// The kinds of the frames that the server sends on an HTTP/2 connection with these frames, up to one of this kind, or
/// until it ends the connection.
fn kinds(server: &Running, frames: &[Vec<u8>], last: u8) -> Vec<u8> {
    let mut stream = server.connect();
    let hello = [b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n".to_vec(), frame(4, 0, 0, &[])].concat();
    let mut writer = stream.try_clone().unwrap();
    std::thread::scope(|scope| {
        // It may end the connection at any frame.
        scope.spawn(move || {
            writer.write_all(&hello).and_then(|()| frames.iter().try_for_each(|it| writer.write_all(it)))
        });
        let mut kinds = Vec::new();
        let mut head = [0; 9];
        while kinds.last() != Some(&last) && stream.read_exact(&mut head).is_ok() {
            let length = u32::from_be_bytes([0, head[0], head[1], head[2]]);
            if stream.read_exact(&mut vec![0; length as usize]).is_err() {
                break;
            }
            kinds.push(head[3]);
        }
        let _ = stream.shutdown(Shutdown::Both);
        kinds
    })
}

#[test]
fn floods_of_http_2_end_the_connection() {
    const HEADERS: u8 = 1;
    const RESET: u8 = 3;
    const PING: u8 = 6;
    const GO_AWAY: u8 = 7;
    let server = start(&[("hills", HILLS)], &[]);
    // GET / of http (static table: 2, 4, 6), and the host "a".
    let head = [0x82, 0x84, 0x86, 0x41, 1, b'a'];
    let ask = |stream: u32| frame(HEADERS, 5, stream, &head);
    let answered = kinds(&server, &[ask(1)], HEADERS);
    assert!(answered.contains(&HEADERS) && !answered.contains(&GO_AWAY), "{answered:?}");
    // Requests that are taken back at once (CVE-2023-44487).
    let reset = |stream: u32| frame(RESET, 0, stream, &8u32.to_be_bytes());
    let rapid: Vec<Vec<u8>> = (0..20_000).map(|k| [ask(2 * k + 1), reset(2 * k + 1)].concat()).collect();
    let ended = kinds(&server, &[rapid.concat()], GO_AWAY);
    assert!(ended.iter().filter(|kind| **kind == HEADERS).count() < 20_000, "{}", ended.len());
    // A head that never ends (CVE-2024-27316), and one of 4 MiB.
    let part = [[0, 1, b'x', 127].as_slice(), &[0x80, 0x7e], &vec![b'y'; 16_255]].concat();
    let endless: Vec<Vec<u8>> = (0..1000).map(|k| frame(if k == 0 { HEADERS } else { 9 }, 0, 1, &part)).collect();
    let ended = kinds(&server, &endless, GO_AWAY);
    assert!(!ended.contains(&HEADERS), "{ended:?}");
    // Frames that are larger than allowed, of unknown streams, and pings.
    for frames in [
        vec![frame(0, 0, 1, &[0; 20_000])],
        vec![frame(0, 0, 99, &[0; 9])],
        vec![frame(HEADERS, 4, 0, &head)],
        vec![frame(8, 0, 0, &[0; 4])],
        vec![frame(4, 0, 0, &[0; 5])],
    ] {
        let ended = kinds(&server, &frames, GO_AWAY);
        assert!(ended.contains(&GO_AWAY), "{ended:?}");
    }
    let calm = kinds(&server, &vec![frame(PING, 0, 0, &[0; 8]); 20_000], PING);
    assert!(calm.contains(&PING) || calm.contains(&GO_AWAY), "{calm:?}");
    assert_eq!(server.get("/healthz").text(), "ok\n");
}

#[test]
fn numbers_and_names_of_any_size_are_sentences() {
    let server = start(&[("hills", HILLS), ("plain", PLAIN)], &[]);
    let long = "9".repeat(10_000);
    let (deep, name) = ("(".repeat(8000), "n".repeat(20_000));
    for path in [
        format!("/hills/window.tif?bbox=0,-{long},{long},0"),
        "/plain/window.tif?bbox=-1e300,-1e300,1e300,1e300".into(),
        "/plain/window.tif?bbox=0,-1e9,1e9,0&cell=1e-9".into(),
        format!("/plain/window.tif?bbox=0,-9,9,0&width={long}"),
        format!("/hills/height?x={long}&y=-{long}"),
        "/plain/height?x=nan&y=inf".into(),
        "/plain/height?x=1e&y=0x10".into(),
        format!("/hills/locate?where={deep}"),
        format!("/hills/locate?where=height%3E{long}"),
        format!("/hills/profile?points={}", "1,1;".repeat(5000)),
        format!("/hills/height?x=1&y=-1&seed={long}"),
        format!("/hills/height?x=1&y=-1&set=noise.wavelength={long}"),
        format!("/hills/height?x=1&y=-1&set={name}=1"),
        format!("/hills/height?x=1&y=-1&layer={name}"),
        format!("/{name}/height?x=1&y=-1"),
        format!("/hills/tiles/{name}/0/0/0.png"),
        format!("/hills/tiles/height/{long}/0/0.png"),
        format!("/hills/zarr/height/c/{long}/0"),
        format!("/hills/mesh/{long}/0/0.terrain"),
        format!("/hills/vector/0/0/0.mvt?grid=world&interval={long}"),
        format!("/hills/objects.geojson?layer=contours&levels={}", "1,".repeat(8000)),
        format!("/hills/{}", "a/".repeat(8000)),
        format!("/hills/height?{}", "x=1&".repeat(5000)),
    ] {
        let shown: String = path.chars().take(60).collect();
        let reply = server.get(&path);
        assert!((400..500).contains(&reply.status), "{shown}: {}", reply.status);
        let error = reply.json()["error"].as_str().unwrap_or_default().to_string();
        assert!(!error.is_empty() && error.len() < 2000, "{shown}: {} bytes", error.len());
    }
}
