//! The threads round the core: a 100 Hz supervisor, and a stop that depends on none of it.
//!
//! The engine gives the core its time, hands it the inputs in the order in which they came, and carries its effects out
//! through an [`Outlet`]. It decides nothing.

pub mod stop;

use crate::assembly::SwitchRequest;
use crate::body::Side;
use crate::command::{Command, Origin};
use crate::kinematics::{JointVector, Scene};
use crate::snapshot::Snapshot;
use crate::supervisor::{Effect, Input, LinkEvent, MovementOrder, PlanOrder, StartOrder, Supervisor};
use crate::time::Stamp;
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, TrySendError, bounded};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, PoisonError, RwLock};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use stop::StopLatch;

/// The supervisor's beat: the rate of the robot's wrench and joint topics (thesis section 4.4.2).
const TICK: Duration = Duration::from_millis(10);
/// How often a snapshot is made: what a screen can draw.
const SNAPSHOT: Duration = Duration::from_millis(33);
/// Inputs that may wait: a second's worth of everything a robot sends (two wrenches, joints, state at 100 Hz, and poses).
const INBOX: usize = 512;
/// What people may ask within one beat: more than anybody types.
const ORDERS: usize = 64;

/// Carries effects out. Nothing here may block: the supervisor waits for it.
pub trait Outlet: Send {
    /// Sends joint positions to an arm, or refuses them with the reason.
    ///
    /// # Errors
    /// The guard's words, where it refuses.
    fn setpoint(&mut self, now: Stamp, side: Side, joints: &JointVector) -> Result<(), String>;
    /// Sends nothing more to an arm.
    fn release(&mut self, side: Side);
    /// Takes what the arms keep away from; commands are judged by it from now on.
    fn surround(&mut self, scene: Scene);
    /// Passes a question on to the planner outside; its answer comes in as an input. Must not wait for it.
    fn plan(&mut self, order: PlanOrder);
    /// Asks something of the robot's switch.
    fn switch(&mut self, request: SwitchRequest);
    /// Shows a snapshot to other nodes.
    fn show(&mut self, snapshot: &Snapshot);
    /// Is told every step: what came in, and what was decided.
    fn record(&mut self, now: Stamp, input: &Input, effects: &[Effect]);
}

/// Where inputs go. Cheap to clone; never blocks, counts what it loses.
#[derive(Clone, Debug)]
pub struct Inbox {
    samples: Sender<Input>,
    orders: Sender<Input>,
    lost: Arc<AtomicU64>,
}

/// The other end of an [`Inbox`].
#[derive(Debug)]
struct Waiting {
    samples: Receiver<Input>,
    orders: Receiver<Input>,
    lost: Arc<AtomicU64>,
}

/// An inbox that holds so many samples, and both of its ends.
fn inbox(capacity: usize) -> (Inbox, Waiting) {
    let ((samples, samples_in), (orders, orders_in)) = (bounded(capacity), bounded(ORDERS));
    let lost = Arc::new(AtomicU64::new(0));
    let waiting = Waiting { samples: samples_in, orders: orders_in, lost: Arc::clone(&lost) };
    (Inbox { samples, orders, lost }, waiting)
}

impl Inbox {
    /// Puts an input into the inbox; where that is full, the input is lost and counted. What an operator asks and what was
    /// asked for once has room of its own: however many samples wait, it is not lost among them.
    pub fn offer(&self, input: Input) {
        let queue = if input.is_asked_for() { &self.orders } else { &self.samples };
        if let Err(TrySendError::Full(_)) = queue.try_send(input) {
            self.lost.fetch_add(1, Ordering::Relaxed);
        }
    }
}

/// The supervisor's thread has ended before the engine was told to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the supervisor has died: the robot was stopped; start valet again, and see its log file for the reason")]
pub struct SupervisorDied;

/// The newest snapshot, shared with whoever shows it.
#[derive(Clone, Debug, Default)]
pub struct SharedSnapshot(Arc<RwLock<Arc<Snapshot>>>);

impl SharedSnapshot {
    /// The newest snapshot.
    #[must_use]
    pub fn newest(&self) -> Arc<Snapshot> {
        Arc::clone(&self.0.read().unwrap_or_else(PoisonError::into_inner))
    }

    fn replace(&self, snapshot: Snapshot) {
        *self.0.write().unwrap_or_else(PoisonError::into_inner) = Arc::new(snapshot);
    }
}

/// The running supervisor. Dropping it ends its thread; the arms then hold by the robot's own time-out.
#[derive(Debug)]
pub struct Engine {
    inbox: Inbox,
    snapshots: SharedSnapshot,
    effects: Receiver<Effect>,
    ended: Arc<AtomicBool>,
    handle: Option<JoinHandle<()>>,
}

/// What the supervisor's thread owns.
struct Worker {
    supervisor: Supervisor,
    outlet: Box<dyn Outlet>,
    latch: StopLatch,
    /// Stops of the latch that the supervisor knows of.
    stops_known: u64,
    waiting: Waiting,
    inbox: Inbox,
    snapshots: SharedSnapshot,
    told: Sender<Effect>,
    ended: Arc<AtomicBool>,
    clock: Clock,
}

/// The time of day at the start, carried on by a clock that never jumps.
#[derive(Clone, Copy, Debug)]
struct Clock {
    wall: Duration,
    start: Instant,
}

impl Clock {
    fn start() -> Self {
        Self { wall: SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default(), start: Instant::now() }
    }

    fn now(&self) -> Stamp {
        Stamp::ZERO + self.wall + self.start.elapsed()
    }
}

impl Engine {
    /// Starts the supervisor's thread.
    ///
    /// # Errors
    /// Where the system has no thread to give.
    pub fn start(supervisor: Supervisor, outlet: Box<dyn Outlet>, latch: StopLatch) -> std::io::Result<Self> {
        let (inbox, waiting) = inbox(INBOX);
        let (told, effects) = bounded(INBOX);
        let snapshots = SharedSnapshot::default();
        let ended = Arc::new(AtomicBool::new(false));
        let worker = Worker {
            supervisor,
            outlet,
            stops_known: latch.requests(),
            latch: latch.clone(),
            waiting,
            inbox: inbox.clone(),
            snapshots: snapshots.clone(),
            told,
            ended: Arc::clone(&ended),
            clock: Clock::start(),
        };
        let handle = thread::Builder::new().name("supervisor".into()).spawn(move || {
            // Whatever ends this thread other than the engine itself must stop the robot: the guard does it on unwinding.
            let guard = StopOnUnwind(latch);
            worker.run();
            drop(guard);
        })?;
        Ok(Self { inbox, snapshots, effects, ended, handle: Some(handle) })
    }

    /// Where inputs go.
    #[must_use]
    pub fn inbox(&self) -> Inbox {
        self.inbox.clone()
    }

    /// The newest snapshot, for screens.
    #[must_use]
    pub fn snapshots(&self) -> SharedSnapshot {
        self.snapshots.clone()
    }

    /// The next decision for whoever tells of them, setpoints left out; `None` where there was none for so long. Those that
    /// nobody takes in time are dropped.
    ///
    /// # Errors
    /// Where the supervisor's thread has died: nothing is decided any more.
    pub fn next_effect(&self, patience: Duration) -> Result<Option<Effect>, SupervisorDied> {
        match self.effects.recv_timeout(patience) {
            Ok(effect) => Ok(Some(effect)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(SupervisorDied),
        }
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::SeqCst);
        if let Some(handle) = self.handle.take() {
            // A panic of the thread has stopped the robot already.
            let _ = handle.join();
        }
    }
}

struct StopOnUnwind(StopLatch);

impl Drop for StopOnUnwind {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.stop();
        }
    }
}

impl Worker {
    fn run(mut self) {
        let mut next_tick = Instant::now() + TICK;
        let mut next_snapshot = Instant::now();
        while !self.ended.load(Ordering::SeqCst) {
            while let Ok(order) = self.waiting.orders.try_recv() {
                self.step(&order);
            }
            match self.waiting.samples.recv_deadline(next_tick) {
                Ok(input) => self.step(&input),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            let now = Instant::now();
            if now >= next_tick {
                self.beat();
                // After a long pause the missed beats are not made up for: the arms must not hurry, and no two beats come
                // so close together that what is measured between them is mostly noise.
                // The beat itself may have taken long: it is over now, not when it was due.
                next_tick = (next_tick + TICK).max(Instant::now() + TICK / 2);
            }
            if now >= next_snapshot {
                self.supervisor.refresh_comparison();
                let mut snapshot = self.supervisor.snapshot(self.clock.now());
                self.time_stop(&mut snapshot);
                self.outlet.show(&snapshot);
                self.snapshots.replace(snapshot);
                next_snapshot = now + SNAPSHOT;
            }
        }
    }

    /// One beat of the supervisor.
    fn beat(&mut self) {
        // What came in while a step took long is taken in first: it must not look older than it is. What comes in meanwhile
        // waits: a flood must not put off the beat, which sees to stops.
        let samples = self.waiting.samples.clone();
        for sample in samples.try_iter().take(samples.len()) {
            self.step(&sample);
        }
        self.poll_latch();
        self.report_losses();
        self.step(&Input::Tick);
    }

    /// When the stop was asked for and when its first message left, as the latch and its thread measured it.
    fn time_stop(&self, snapshot: &mut Snapshot) {
        if snapshot.stop.latched {
            let now = Duration::from_nanos(snapshot.now.nanoseconds());
            let moment = |ago: Duration| Stamp::ZERO + now.saturating_sub(ago);
            snapshot.stop.requested_at = self.latch.requested_ago().map(moment).or(snapshot.stop.requested_at);
            snapshot.stop.sent_at = self.latch.sent_ago().map(moment);
        }
    }

    /// A stop that came past the supervisor, straight from a key: it is told.
    fn poll_latch(&mut self) {
        let requests = self.latch.requests();
        if requests != self.stops_known {
            self.stops_known = requests;
            self.step(&Input::Operator { command: Command::Stop, origin: Origin::OperatorKey });
        }
    }

    fn report_losses(&mut self) {
        let lost = self.waiting.lost.swap(0, Ordering::Relaxed);
        if lost > 0 {
            self.step(&Input::Link(LinkEvent::InboxOverflow { lost }));
        }
    }

    fn step(&mut self, input: &Input) {
        let now = self.clock.now();
        let was_stopped = self.supervisor.is_stopped();
        let effects = self.supervisor.step(now, input);
        self.follow_stop(was_stopped, &effects);
        if matches!(input, Input::Tick) {
            self.outlet.surround(self.supervisor.surroundings());
        }
        self.outlet.record(now, input, &effects);
        for effect in effects {
            self.carry_out(now, effect);
        }
    }

    /// Keeps the latch in step with the supervisor, in both directions.
    fn follow_stop(&mut self, was_stopped: bool, effects: &[Effect]) {
        let is_stopped = self.supervisor.is_stopped();
        if effects.iter().any(|effect| matches!(effect, Effect::Stopped { .. })) || (is_stopped && !was_stopped) {
            self.latch.stop();
            self.stops_known = self.latch.requests();
        } else if was_stopped && !is_stopped && self.latch.requests() == self.stops_known {
            self.latch.clear();
        }
        if self.supervisor.stop_is_confirmed() {
            self.latch.confirm();
        }
    }

    /// Has a movement space fitted where no beat waits for it.
    fn fit(&mut self, order: MovementOrder) {
        let number = order.number;
        let failed = |reason| Input::Fitted { number, space: Err(reason) };
        self.aside("fit", move || order.answer(), failed);
    }

    /// Has a posture to begin from searched where no beat waits for it.
    fn find_start(&mut self, order: StartOrder) {
        let (number, model) = (order.number, self.supervisor.model().clone());
        let failed = |reason| Input::StartFound { number, joints: Err(reason) };
        self.aside("start", move || order.answer(&model), failed);
    }

    /// Answers a question in a thread of its own.
    fn aside(
        &mut self,
        name: &str,
        answer: impl FnOnce() -> Input + Send + 'static,
        failed: impl FnOnce(String) -> Input,
    ) {
        let inbox = self.inbox.clone();
        if let Err(error) = thread::Builder::new().name(name.into()).spawn(move || inbox.offer(answer())) {
            self.step(&failed(format!("this computer has no thread for it: {error}")));
        }
    }

    fn carry_out(&mut self, now: Stamp, effect: Effect) {
        match effect {
            // The latch may have been set since the supervisor decided: nothing moves any more.
            Effect::Setpoint { .. } if self.latch.is_stopped() => {}
            Effect::Setpoint { side, joints } => {
                if let Err(reason) = self.outlet.setpoint(now, side, &joints) {
                    self.step(&Input::SetpointRefused { side, reason });
                }
            }
            Effect::Release { side } => self.outlet.release(side),
            // A stop came straight from a key since the supervisor decided: it is not to be followed by an Enable.
            Effect::Switch(request) if request != SwitchRequest::Stop && self.latch.requests() != self.stops_known => {}
            Effect::Plan(order) => self.outlet.plan(order),
            Effect::Switch(request) => self.outlet.switch(request),
            Effect::FindStart(order) => self.find_start(*order),
            Effect::Fit(order) => self.fit(order),
            told => {
                // Telling is best effort; the record has it all.
                let _ = self.told.try_send(told);
            }
        }
    }
}

#[cfg(test)]
mod tests;
