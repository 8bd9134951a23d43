//! Connections: HTTP/1.1 and HTTP/2, with limits of time and size against clients that send or read too slowly.

use std::io;
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
use tokio::sync::Semaphore;
use tokio::time::{Sleep, sleep};

use crate::shared::{Client, GRACE, Shared};

/// Open connections; more wait until one of them ends.
const CONNECTIONS: usize = 512;

/// Time for the first byte, for the head of a request, and until the next request of a connection.
const HEAD: Duration = Duration::from_secs(30);

/// Time in which a client must read something of its answer.
const STALLED: Duration = Duration::from_secs(60);

/// Limits of the head of a request.
const HEAD_BYTES: usize = 32 << 10;
const HEADERS: usize = 64;

/// Requests of an HTTP/2 connection at the same time.
const STREAMS: u32 = 64;

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
    let room = Arc::new(Semaphore::new(CONNECTIONS));
    let service = TowerToHyperService::new(router);
    loop {
        let accepted = async {
            let place = Arc::clone(&room).acquire_owned().await;
            (place, listener.accept().await)
        };
        let (place, accepted) = tokio::select! {
            accepted = accepted => accepted,
            () = stopped(stop) => break,
        };
        let (stream, client) = match accepted {
            Ok(accepted) => accepted,
            Err(_) => {
                // Such as too many open files: it passes when others end.
                sleep(LOOK).await;
                continue;
            }
        };
        // Tiles are small: without it they would wait for acknowledgements.
        let _ = stream.set_nodelay(true);
        let service = service.clone();
        let answer = service_fn(move |request| service.call(with_client(request, client)));
        let connection = builder.serve_connection(TokioIo::new(Timed::new(stream)), answer).into_owned();
        let connection = graceful.watch(connection);
        tokio::spawn(async move {
            // An error is one of the client or of the network: it went away, or was too slow.
            let _ = connection.await;
            drop(place);
        });
    }
    drop(listener);
    let ended = graceful.shutdown();
    if tokio::time::timeout(GRACE, ended).await.is_err() {
        shared.desk.cancel();
    }
    Ok(())
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
    builder
}

/// A connection that fails if its client sends nothing at first, or does not read.
struct Timed {
    stream: TcpStream,
    /// Runs until the first byte, then while a write waits.
    deadline: Pin<Box<Sleep>>,
    has_begun: bool,
    is_waiting: bool,
}

impl Timed {
    fn new(stream: TcpStream) -> Timed {
        Timed { stream, deadline: Box::pin(sleep(HEAD)), has_begun: false, is_waiting: false }
    }

    /// The result of a write; the deadline runs while it waits.
    fn write(&mut self, context: &mut Context, result: Poll<io::Result<usize>>) -> Poll<io::Result<usize>> {
        if result.is_ready() {
            self.is_waiting = false;
            return result;
        }
        if !self.is_waiting {
            self.is_waiting = true;
            self.deadline.as_mut().reset(tokio::time::Instant::now() + STALLED);
        }
        ready!(self.deadline.as_mut().poll(context));
        Poll::Ready(Err(io::ErrorKind::TimedOut.into()))
    }
}

impl AsyncRead for Timed {
    fn poll_read(mut self: Pin<&mut Self>, context: &mut Context, buffer: &mut ReadBuf) -> Poll<io::Result<()>> {
        let result = Pin::new(&mut self.stream).poll_read(context, buffer);
        if result.is_ready() {
            self.has_begun = true;
        } else if !self.has_begun {
            ready!(self.deadline.as_mut().poll(context));
            return Poll::Ready(Err(io::ErrorKind::TimedOut.into()));
        }
        result
    }
}

impl AsyncWrite for Timed {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let result = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.write(context, result)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context,
        bytes: &[io::IoSlice],
    ) -> Poll<io::Result<usize>> {
        let result = Pin::new(&mut self.stream).poll_write_vectored(context, bytes);
        self.write(context, result)
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
