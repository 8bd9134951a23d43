//! Work is done once, within limits, and not for clients that have gone.

use std::io::{Read, Write};

use super::client::{parsed, start};
use super::{HILLS, PLAIN};

/// A request whose answer takes far longer than a test.
const ENDLESS: &str = "GET /window.npy?bbox=0,-300000,300000,0&width=30000 HTTP/1.1\r\nHost: a\r\n\r\n";

#[test]
fn a_full_queue_is_refused_and_nothing_is_left_of_clients_that_go_away() {
    let server = start(&[("plain", PLAIN)], &[("queue", "1"), ("max-samples", "10000000000")]);
    // Two workers, and one seat in the queue.
    let mut clients: Vec<_> = (0..3)
        .map(|k| {
            let mut stream = server.connect();
            stream.write_all(ENDLESS.replace("width=30000", &format!("width={}", 30_000 + k)).as_bytes()).unwrap();
            stream
        })
        .collect();
    server.wait("orogen_work_pending", 3);
    let refused = server.get("/terrarium/14/8192/8192.png");
    assert_eq!((refused.status, refused.header("retry-after")), (503, "2"));
    assert!(refused.json()["error"].as_str().unwrap().contains("too many requests are waiting"));
    assert_eq!(server.metric("orogen_requests_refused_total"), 1);
    // One goes away, and there is room for another one.
    clients.pop();
    server.wait("orogen_work_pending", 2);
    drop(clients);
    server.wait("orogen_work_pending", 0);
    server.wait("orogen_workers_busy", 0);
    assert_eq!(server.metric("orogen_work_cancelled_total"), 3);
    assert_eq!(server.get("/terrarium/14/8192/8192.png").status, 200);
    let lines = server.lines.lock().unwrap();
    assert_eq!(lines.iter().filter(|line| line.contains("status=499")).count(), 3, "{lines:?}");
}

#[test]
fn an_answer_that_takes_too_long_is_given_up() {
    let server = start(&[("plain", PLAIN)], &[("timeout", "0.1"), ("max-samples", "10000000000")]);
    let reply = parsed(&server.send(ENDLESS.replace("\r\n\r\n", "\r\nConnection: close\r\n\r\n").as_bytes())).unwrap();
    assert_eq!((reply.status, reply.header("retry-after")), (503, "2"));
    assert!(reply.json()["error"].as_str().unwrap().contains("longer than 0.1 s"));
    server.wait("orogen_work_pending", 0);
}

#[test]
fn many_clients_at_once_have_the_same_tile_from_one_computation() {
    let server = start(&[("hills", HILLS)], &[]);
    let first = server.get("/terrarium/2/1/0.png?grid=world").body;
    let made = server.metric("orogen_work_total");
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for column in 0..4 {
                    let reply = server.get(&format!("/terrarium/2/{column}/1.png?grid=world"));
                    assert_eq!(reply.status, 200);
                }
                assert!(server.get("/terrarium/2/1/0.png?grid=world").body == first);
            });
        }
    });
    assert_eq!(server.metric("orogen_work_total"), made + 4);
}

#[test]
fn connections_are_kept_and_the_server_ends_in_peace() {
    let mut server = start(&[("hills", HILLS)], &[]);
    let mut stream = server.connect();
    for _ in 0..3 {
        stream.write_all(b"GET /healthz HTTP/1.1\r\nHost: a\r\n\r\n").unwrap();
        let mut bytes = vec![0; 4096];
        let length = stream.read(&mut bytes).unwrap();
        assert!(bytes[..length].starts_with(b"HTTP/1.1 200") && bytes[..length].ends_with(b"ok\n"));
    }
    // An idle connection does not keep it.
    server.end().unwrap();
    assert!(std::net::TcpStream::connect(server.address).is_err());
    let lines = server.lines.lock().unwrap();
    let expect = "client=127.0.0.1 method=GET path=\"/healthz\" status=200 bytes=3 ms=";
    assert!(
        lines.len() == 3 && lines.iter().all(|line| line.starts_with("time=2") && line.contains(expect)),
        "{lines:?}"
    );
}
