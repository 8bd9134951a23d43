//! Connections: HTTP/1.1 and HTTP/2, with limits of time and size against clients that send or read too slowly.

use std::io::{self, Write as _};
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, ready};
use std::time::Duration;

use axum::Router;
use axum::extract::Request;
use hyper::body::Incoming;
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioExecutor, TokioIo, TokioTimer};
use hyper_util::server::conn::auto::Builder;
use hyper_util::server::graceful::GracefulShutdown;
use hyper_util::service::TowerToHyperService;
use orogen::{Error, ErrorKind, Result};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Sleep, sleep};

use crate::peers::{Answer, Pace, Peer};
use crate::shared::{Client, GRACE, Shared};

/// Time for the head of the first request, for the head of another one, and until the next request of a connection.
const HEAD: Duration = Duration::from_secs(30);

/// Limits of the head of a request.
const HEAD_BYTES: usize = 32 << 10;
const HEADERS: usize = 64;

/// Requests of an HTTP/2 connection at the same time, and those that it may take back before they were looked at.
const STREAMS: u32 = 64;
const TAKEN_BACK: usize = 20;

/// Bytes of answers that wait in an HTTP/2 connection for each of its requests.
const WAITING: usize = 64 << 10;

/// Interval at which the flag is looked at that stops the server.
const LOOK: Duration = Duration::from_millis(50);

/// Answers requests until `stop` is set.
///
/// # Errors
/// If the listener cannot be used.
pub async fn serve(
    listener: std::net::TcpListener,
    router: Router,
    shared: &Shared,
    stop: &Arc<AtomicBool>,
) -> Result<()> {
    let listener = TcpListener::from_std(listener);
    let listener = listener.map_err(|cause| Error::new(ErrorKind::File, format!("cannot listen: {cause}")))?;
    let (builder, graceful) = (builder(), GracefulShutdown::new());
    let service = TowerToHyperService::new(router);
    loop {
        let accepted = tokio::select! {
            accepted = listener.accept() => accepted,
            () = stopped(stop) => break,
        };
        let (stream, client) = match accepted {
            Ok(accepted) => accepted,
            Err(_) => {
                // Such as too many open files.
                shared.peers.displace();
                sleep(LOOK).await;
                continue;
            }
        };
        let Some(slot) = shared.peers.enter().map(Arc::new) else {
            refuse(stream);
            continue;
        };
        // Tiles are small: without it they would wait for acknowledgements.
        let _ = stream.set_nodelay(true);
        let (service, begun) = (service.clone(), Arc::clone(&slot));
        let answer = service_fn(move |request| {
            let (busy, answered) = (begun.begin(), service.call(with_client(request, client)));
            async move { answered.await.map(|response| response.map(|body| Answer::new(body, busy))) }
        });
        let stream = TokioIo::new(Timed::new(stream, Arc::clone(&slot.peer)));
        let connection = graceful.watch(builder.serve_connection(stream, answer).into_owned());
        tokio::spawn(async move {
            let mut pace = Pace::new();
            tokio::pin!(connection);
            loop {
                tokio::select! {
                    // An error is one of the client or of the network: it went away, or was too slow.
                    _ = &mut connection => break,
                    () = slot.peer.displaced() => break,
                    () = sleep(Pace::LOOK) => if pace.is_too_slow(&slot.peer) { break },
                }
            }
        });
    }
    drop(listener);
    let ended = graceful.shutdown();
    if tokio::time::timeout(GRACE, ended).await.is_err() {
        shared.desk.cancel();
    }
    Ok(())
}

/// Answers a connection for which there is no slot, and closes it.
fn refuse(stream: TcpStream) {
    let body = r#"{"error":"too many connections are busy; connect again later, or raise --connections"}"#;
    let head =
        "HTTP/1.1 503 Service Unavailable\r\ncontent-type: application/json\r\nretry-after: 2\r\nconnection: close";
    // A new connection has room for it.
    if let Ok(mut stream) = stream.into_std() {
        let _ = write!(stream, "{head}\r\ncontent-length: {}\r\n\r\n{body}", body.len());
    }
}

/// Adds the address of the client, for the log.
fn with_client(mut request: Request<Incoming>, client: SocketAddr) -> Request<Incoming> {
    request.extensions_mut().insert(Client(client));
    request
}

/// Waits until the flag is set.
async fn stopped(stop: &AtomicBool) {
    while !stop.load(Ordering::Relaxed) {
        sleep(LOOK).await;
    }
}

fn builder() -> Builder<TokioExecutor> {
    let mut builder = Builder::new(TokioExecutor::new());
    let mut http1 = builder.http1();
    http1.timer(TokioTimer::new()).header_read_timeout(HEAD).max_buf_size(HEAD_BYTES).max_headers(HEADERS);
    let mut http2 = builder.http2();
    http2.timer(TokioTimer::new()).max_concurrent_streams(STREAMS).max_header_list_size(HEAD_BYTES as u32);
    http2.keep_alive_interval(HEAD).keep_alive_timeout(HEAD);
    http2.max_pending_accept_reset_streams(TAKEN_BACK).max_local_error_reset_streams(TAKEN_BACK);
    http2.max_send_buf_size(WAITING);
    builder
}

/// A connection that fails if its client sends no whole request at first, and counts what it sends.
struct Timed {
    stream: TcpStream,
    peer: Arc<Peer>,
    /// For the first request.
    deadline: Pin<Box<Sleep>>,
}

impl Timed {
    fn new(stream: TcpStream, peer: Arc<Peer>) -> Timed {
        Timed { stream, peer, deadline: Box::pin(sleep(HEAD)) }
    }

    /// Counts what was sent.
    fn counted(&self, result: Poll<io::Result<usize>>) -> Poll<io::Result<usize>> {
        if let Poll::Ready(Ok(bytes)) = result {
            self.peer.count(bytes);
        }
        result
    }
}

impl AsyncRead for Timed {
    fn poll_read(mut self: Pin<&mut Self>, context: &mut Context, buffer: &mut ReadBuf) -> Poll<io::Result<()>> {
        let result = Pin::new(&mut self.stream).poll_read(context, buffer);
        if result.is_pending() && !self.peer.has_begun() {
            ready!(self.deadline.as_mut().poll(context));
            return Poll::Ready(Err(io::ErrorKind::TimedOut.into()));
        }
        result
    }
}

impl AsyncWrite for Timed {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let result = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.counted(result)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context,
        bytes: &[io::IoSlice],
    ) -> Poll<io::Result<usize>> {
        let result = Pin::new(&mut self.stream).poll_write_vectored(context, bytes);
        self.counted(result)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}
