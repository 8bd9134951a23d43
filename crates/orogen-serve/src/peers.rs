//! The open connections: which of them wait for a request, and which read their answers too slowly.

use std::collections::HashMap;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, ready};
use std::time::{Duration, Instant};

use axum::body::{Body, Bytes, HttpBody};
use hyper::body::{Frame, SizeHint};
use tokio::sync::Notify;

/// Time after which a client that reads nothing of its answers is given up, and the rate at which it must read them in
/// the long run, in bytes a second.
const STALLED: Duration = Duration::from_secs(60);
const RATE: u64 = 8 << 10;

/// An open connection.
#[derive(Default)]
pub struct Peer {
    /// Whether it ever had a request.
    has_begun: AtomicBool,
    /// Requests without a complete answer.
    busy: AtomicUsize,
    /// Answers that are being sent.
    sending: AtomicUsize,
    /// Bytes that were sent and not counted by [`Pace`] yet.
    sent: AtomicU64,
    /// Milliseconds from the start of the server until it last became idle.
    idle_since: AtomicU64,
    /// Notified when another connection takes its place.
    displaced: Notify,
}

impl Peer {
    /// Whether it ever had a request.
    pub fn has_begun(&self) -> bool {
        self.has_begun.load(Ordering::Relaxed)
    }

    /// Counts bytes that were sent.
    pub fn count(&self, bytes: usize) {
        self.sent.fetch_add(bytes as u64, Ordering::Relaxed);
    }

    /// Waits until another connection takes its place.
    pub async fn displaced(&self) {
        self.displaced.notified().await;
    }
}

/// The open connections of a server.
pub struct Peers {
    most: usize,
    started: Instant,
    open: Mutex<HashMap<u64, Arc<Peer>>>,
    next: AtomicU64,
    /// Idle connections that were closed for new ones.
    pub displaced: AtomicU64,
    /// Connections that were refused, because all others were busy.
    pub refused: AtomicU64,
}

impl Peers {
    /// At most `most` connections.
    pub fn new(most: usize) -> Peers {
        let (displaced, refused) = (AtomicU64::default(), AtomicU64::default());
        Peers { most, started: Instant::now(), open: Mutex::default(), next: AtomicU64::default(), displaced, refused }
    }

    /// Data under this lock is consistent at any time, also after a panic of another thread.
    fn lock(&self) -> MutexGuard<'_, HashMap<u64, Arc<Peer>>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn now(&self) -> u64 {
        self.started.elapsed().as_millis() as u64
    }

    /// Number of open connections.
    pub fn count(&self) -> usize {
        self.lock().len()
    }

    /// Closes the connection that has been idle for the longest time; `false` if all are busy.
    pub fn displace(&self) -> bool {
        let mut open = self.lock();
        let idle = open.iter().filter(|(_, peer)| peer.busy.load(Ordering::Relaxed) == 0);
        // Of those of the same millisecond the first one.
        let oldest = idle.map(|(id, peer)| (peer.idle_since.load(Ordering::Relaxed), *id)).min();
        let Some(peer) = oldest.and_then(|(_, id)| open.remove(&id)) else { return false };
        peer.displaced.notify_one();
        self.displaced.fetch_add(1, Ordering::Relaxed);
        true
    }

    /// A slot for a new connection. If there is none, that of the longest idle connection; `None` if all are busy.
    pub fn enter(self: &Arc<Peers>) -> Option<Slot> {
        if self.count() >= self.most && !self.displace() {
            self.refused.fetch_add(1, Ordering::Relaxed);
            return None;
        }
        let id = self.next.fetch_add(1, Ordering::Relaxed);
        let peer = Arc::new(Peer { idle_since: AtomicU64::new(self.now()), ..Peer::default() });
        self.lock().insert(id, Arc::clone(&peer));
        Some(Slot { peers: Arc::clone(self), id, peer })
    }
}

/// The slot of a connection, which is free again when this is dropped.
pub struct Slot {
    peers: Arc<Peers>,
    id: u64,
    pub peer: Arc<Peer>,
}

impl Slot {
    /// Begins a request.
    pub fn begin(&self) -> Busy {
        let peer = Arc::clone(&self.peer);
        peer.has_begun.store(true, Ordering::Relaxed);
        peer.busy.fetch_add(1, Ordering::Relaxed);
        Busy { peers: Arc::clone(&self.peers), peer }
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        self.peers.lock().remove(&self.id);
    }
}

/// A request, until the last byte of its answer was sent.
pub struct Busy {
    peers: Arc<Peers>,
    peer: Arc<Peer>,
}

impl Drop for Busy {
    fn drop(&mut self) {
        self.peer.idle_since.store(self.peers.now(), Ordering::Relaxed);
        self.peer.busy.fetch_sub(1, Ordering::Relaxed);
    }
}

/// An answer that is being sent.
struct Sending(Busy);

impl Drop for Sending {
    fn drop(&mut self) {
        self.0.peer.sending.fetch_sub(1, Ordering::Relaxed);
    }
}

/// The body of an answer. Its parts know when they were sent, also after the body itself was given away.
pub struct Answer {
    body: Body,
    sending: Arc<Sending>,
}

impl Answer {
    /// The body of the answer to a request.
    pub fn new(body: Body, busy: Busy) -> Answer {
        busy.peer.sending.fetch_add(1, Ordering::Relaxed);
        Answer { body, sending: Arc::new(Sending(busy)) }
    }
}

/// Bytes of an answer.
struct Part {
    bytes: Bytes,
    _sending: Arc<Sending>,
}

impl AsRef<[u8]> for Part {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}

impl HttpBody for Answer {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let frame = ready!(Pin::new(&mut self.body).poll_frame(context));
        let part = |bytes| Bytes::from_owner(Part { bytes, _sending: Arc::clone(&self.sending) });
        Poll::Ready(frame.map(|frame| frame.map(|frame| frame.map_data(part))))
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

/// How fast a client reads its answers.
pub struct Pace {
    /// The time for which it may still read nothing.
    left: Duration,
}

impl Pace {
    /// The time between two looks.
    pub const LOOK: Duration = Duration::from_secs(1);

    /// The pace of a new connection.
    pub fn new() -> Pace {
        Pace { left: STALLED }
    }

    /// Whether the client is too slow, after the [time](Pace::LOOK) since the last look.
    pub fn is_too_slow(&mut self, peer: &Peer) -> bool {
        let sent = peer.sent.swap(0, Ordering::Relaxed);
        if peer.sending.load(Ordering::Relaxed) == 0 {
            self.left = STALLED;
            return false;
        }
        let earned = Duration::from_millis(sent.saturating_mul(1000) / RATE);
        self.left = self.left.saturating_add(earned).min(STALLED + Pace::LOOK).saturating_sub(Pace::LOOK);
        self.left.is_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_idle_connection_makes_room() {
        let peers = Arc::new(Peers::new(3));
        let slots: Vec<Slot> = (0..3).map(|_| peers.enter().unwrap()).collect();
        // The first one is busy, the others are idle since they came.
        let busy = slots[0].begin();
        let fourth = peers.enter().unwrap();
        assert_eq!((peers.count(), peers.displaced.load(Ordering::Relaxed)), (3, 1));
        assert!(!peers.lock().contains_key(&slots[1].id) && peers.lock().contains_key(&slots[2].id));
        let answers = [slots[2].begin(), fourth.begin()].map(|busy| Answer::new(Body::empty(), busy));
        assert!(peers.enter().is_none());
        assert_eq!(peers.refused.load(Ordering::Relaxed), 1);
        drop(answers);
        drop(busy);
        assert!(peers.displace());
        drop((slots, fourth));
        assert_eq!(peers.count(), 0);
    }

    #[test]
    fn clients_that_read_too_slowly_are_found() {
        let peers = Arc::new(Peers::new(1));
        let slot = peers.enter().unwrap();
        let looks = |bytes: u64, count: usize| {
            let (mut pace, answer) = (Pace::new(), Answer::new(Body::empty(), slot.begin()));
            let slow = (0..count).position(|_| {
                slot.peer.count(bytes as usize);
                pace.is_too_slow(&slot.peer)
            });
            drop(answer);
            slow
        };
        assert_eq!(looks(0, 1000), Some(59));
        assert_eq!(looks(RATE / 2, 1000), Some(119));
        assert_eq!(looks(RATE, 10_000), None);
        // Without an answer a client has nothing to read.
        let mut pace = Pace::new();
        assert!((0..1000).all(|_| !pace.is_too_slow(&slot.peer)));
    }

    #[test]
    fn an_answer_is_sent_when_its_last_part_is_gone() {
        let peers = Arc::new(Peers::new(1));
        let slot = peers.enter().unwrap();
        let mut answer = Answer::new(Body::from("abc"), slot.begin());
        let mut context = Context::from_waker(std::task::Waker::noop());
        let Poll::Ready(Some(Ok(frame))) = Pin::new(&mut answer).poll_frame(&mut context) else { panic!("no part") };
        let part = frame.into_data().unwrap();
        let rest = part.slice(1..);
        drop((answer, part));
        assert_eq!((&rest[..], slot.peer.sending.load(Ordering::Relaxed)), (&b"bc"[..], 1));
        drop(rest);
        assert_eq!((slot.peer.sending.load(Ordering::Relaxed), slot.peer.busy.load(Ordering::Relaxed)), (0, 0));
    }
}
