//! The stop latch and its thread: the one way out that depends on nothing else.
//!
//! [`StopLatch::stop`] sets an atomic flag and wakes a thread that does nothing but send the stop until the robot confirms
//! it. No lock, queue or allocation is shared with the screen, the supervisor or the recorder. The latch never clears
//! itself: only an operator's Reset, which the supervisor has accepted, does.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle, Thread};
use std::time::{Duration, Instant};

/// How often the stop is repeated until the robot confirms it: 20 Hz, well inside the three seconds that Rethink's own
/// tool allows, and slow enough for a network that is in trouble.
const REPEAT: Duration = Duration::from_millis(50);

/// Sends the stop to the robot. It must not block.
pub trait StopPort: Send {
    /// Sends one stop message.
    fn send_stop(&mut self);
}

impl<F: FnMut() + Send> StopPort for F {
    fn send_stop(&mut self) {
        self();
    }
}

#[derive(Debug)]
struct Flags {
    stopped: Arc<AtomicBool>,
    /// How often a stop was asked for: each time is answered with a message of its own, also while an earlier stop is latched.
    requests: AtomicU64,
    confirmed: AtomicBool,
    ended: AtomicBool,
    /// Nanoseconds from the engine's start to the first stop message after the latest request; 0 before one was sent.
    sent_nanoseconds: AtomicU64,
    /// Nanoseconds from the engine's start to the request of the present stop; 0 before there was one.
    requested_nanoseconds: AtomicU64,
    start: Instant,
}

impl Flags {
    /// Nanoseconds since the engine's start, never 0.
    fn elapsed(&self) -> u64 {
        u64::try_from(self.start.elapsed().as_nanos()).unwrap_or(u64::MAX).max(1)
    }

    /// How long ago a moment was that one of the counters holds.
    fn ago(&self, counter: &AtomicU64) -> Option<Duration> {
        let then = counter.load(Ordering::SeqCst);
        (then > 0).then(|| Duration::from_nanos(self.elapsed().saturating_sub(then)))
    }
}

/// The latch: cheap to clone, safe to use from any thread, a panic hook included.
#[derive(Clone, Debug)]
pub struct StopLatch {
    flags: Arc<Flags>,
    thread: Thread,
}

impl StopLatch {
    /// Stops the robot. Never blocks, and does no harm when repeated: a robot that was reset and enabled since is stopped anew.
    pub fn stop(&self) {
        let was_stopped = self.flags.stopped.swap(true, Ordering::SeqCst);
        let was_confirmed = self.flags.confirmed.swap(false, Ordering::SeqCst);
        if !was_stopped || was_confirmed {
            self.flags.sent_nanoseconds.store(0, Ordering::SeqCst);
            self.flags.requested_nanoseconds.store(self.flags.elapsed(), Ordering::SeqCst);
        }
        self.flags.requests.fetch_add(1, Ordering::SeqCst);
        self.thread.unpark();
    }

    /// How often a stop was asked for so far: who tells of stops sees by it that there was a new one.
    #[must_use]
    pub fn requests(&self) -> u64 {
        self.flags.requests.load(Ordering::SeqCst)
    }

    /// True from [`StopLatch::stop`] until [`StopLatch::clear`].
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.flags.stopped.load(Ordering::SeqCst)
    }

    /// The flag itself, for guards that look at it before every command.
    #[must_use]
    pub fn flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.flags.stopped)
    }

    /// The robot says that it is stopped: the message need not be repeated any more.
    pub fn confirm(&self) {
        self.flags.confirmed.store(true, Ordering::SeqCst);
    }

    /// The operator has reset the stop and the supervisor has accepted it.
    pub fn clear(&self) {
        self.flags.stopped.store(false, Ordering::SeqCst);
    }

    /// When the first message of the present stop left, since the engine's start.
    #[must_use]
    pub fn sent_after(&self) -> Option<Duration> {
        let nanoseconds = self.flags.sent_nanoseconds.load(Ordering::SeqCst);
        (nanoseconds > 0).then(|| Duration::from_nanos(nanoseconds))
    }

    /// How long ago the present stop was asked for.
    #[must_use]
    pub fn requested_ago(&self) -> Option<Duration> {
        self.flags.ago(&self.flags.requested_nanoseconds)
    }

    /// How long ago its first message left; `None` where none has left yet.
    #[must_use]
    pub fn sent_ago(&self) -> Option<Duration> {
        self.flags.ago(&self.flags.sent_nanoseconds)
    }

    fn must_send(&self) -> bool {
        self.is_stopped() && !self.flags.confirmed.load(Ordering::SeqCst)
    }
}

/// The thread that sends the stop. Dropping it ends the thread after a last message where a stop is not confirmed.
#[derive(Debug)]
pub struct StopThread {
    latch: StopLatch,
    handle: Option<JoinHandle<()>>,
}

impl StopThread {
    /// Starts the thread with a port of its own.
    ///
    /// # Errors
    /// Where the system has no thread to give.
    pub fn start(port: impl StopPort + 'static) -> std::io::Result<Self> {
        let flags = Arc::new(Flags {
            stopped: Arc::default(),
            requests: AtomicU64::new(0),
            confirmed: AtomicBool::new(false),
            ended: AtomicBool::new(false),
            sent_nanoseconds: AtomicU64::new(0),
            requested_nanoseconds: AtomicU64::new(0),
            start: Instant::now(),
        });
        let shared = Arc::clone(&flags);
        let handle = thread::Builder::new().name("stop".into()).spawn(move || {
            let latch = StopLatch { flags: shared, thread: thread::current() };
            run(&latch, port);
        })?;
        let latch = StopLatch { flags, thread: handle.thread().clone() };
        Ok(Self { latch, handle: Some(handle) })
    }

    /// The latch of this thread.
    #[must_use]
    pub fn latch(&self) -> StopLatch {
        self.latch.clone()
    }
}

impl Drop for StopThread {
    fn drop(&mut self) {
        self.latch.flags.ended.store(true, Ordering::SeqCst);
        self.latch.thread.unpark();
        if let Some(handle) = self.handle.take() {
            // A panic of the thread has nothing left to tell here: the process ends.
            let _ = handle.join();
        }
    }
}

fn run(latch: &StopLatch, mut port: impl StopPort) {
    let mut answered = 0;
    loop {
        let requests = latch.requests();
        if latch.must_send() || requests != answered {
            port.send_stop();
            answered = requests;
            let after = latch.flags.elapsed();
            // Only the first message of a stop is timed.
            let _ = latch.flags.sent_nanoseconds.compare_exchange(0, after, Ordering::SeqCst, Ordering::SeqCst);
        }
        if latch.flags.ended.load(Ordering::SeqCst) {
            return;
        }
        if latch.must_send() {
            thread::park_timeout(REPEAT);
        } else if latch.requests() == answered {
            thread::park();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crossbeam_channel::{Receiver, unbounded};

    const PATIENCE: Duration = Duration::from_secs(20);

    fn thread_that_tells() -> (StopThread, Receiver<()>) {
        let (sender, receiver) = unbounded();
        let thread = StopThread::start(move || {
            let _ = sender.send(());
        });
        (thread.unwrap(), receiver)
    }

    #[test]
    fn a_stop_is_sent_and_repeated_until_it_is_confirmed() {
        let (thread, sent) = thread_that_tells();
        let latch = thread.latch();
        latch.stop();
        for _ in 0..3 {
            sent.recv_timeout(PATIENCE).unwrap();
        }
        assert!(latch.sent_after().is_some());
        let (requested, sent) = (latch.requested_ago().unwrap(), latch.sent_ago().unwrap());
        assert!(requested >= sent, "asked for before it was sent: {requested:?} {sent:?}");
        latch.confirm();
        drop(thread);
        assert!(latch.is_stopped(), "a confirmed stop stays latched");
    }

    #[test]
    fn without_a_stop_nothing_is_sent() {
        let (thread, sent) = thread_that_tells();
        drop(thread);
        assert!(sent.try_recv().is_err());
    }

    #[test]
    fn a_stop_that_comes_while_the_thread_ends_is_still_sent() {
        let (thread, sent) = thread_that_tells();
        thread.latch().stop();
        drop(thread);
        sent.recv_timeout(PATIENCE).unwrap();
    }

    #[test]
    fn after_a_reset_the_next_stop_is_sent_anew() {
        let (thread, sent) = thread_that_tells();
        let latch = thread.latch();
        latch.stop();
        sent.recv_timeout(PATIENCE).unwrap();
        latch.confirm();
        latch.clear();
        assert!(!latch.is_stopped());
        while sent.try_recv().is_ok() {}
        latch.stop();
        sent.recv_timeout(PATIENCE).unwrap();
    }

    #[test]
    fn a_stop_that_is_asked_for_again_is_sent_again_although_the_first_was_confirmed() {
        let (thread, sent) = thread_that_tells();
        let latch = thread.latch();
        latch.stop();
        sent.recv_timeout(PATIENCE).unwrap();
        latch.confirm();
        // What was on its way when the confirmation came.
        while sent.recv_timeout(REPEAT * 4).is_ok() {}
        latch.stop();
        latch.confirm();
        sent.recv_timeout(PATIENCE).unwrap();
        assert_eq!(latch.requests(), 2);
    }

    #[test]
    fn many_threads_may_stop_at_once() {
        let (thread, sent) = thread_that_tells();
        let latch = thread.latch();
        thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| latch.stop());
            }
        });
        sent.recv_timeout(PATIENCE).unwrap();
        assert!(latch.is_stopped());
    }
}
