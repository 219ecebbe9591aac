mod guards;

use super::stop::StopThread;
use super::*;
use crate::assembly::{RobotState, SwitchRequest};
use crate::kinematics::RobotModel;
use crate::supervisor::Setup;
use crossbeam_channel::unbounded;
use std::sync::OnceLock;

/// Nothing here is timed; a thread that has not answered after this has hung.
const PATIENCE: Duration = Duration::from_secs(60);

/// What reached the outlet.
#[derive(Clone, Debug, PartialEq)]
enum Told {
    Plan(u64),
    Setpoint(Side, JointVector),
    Release(Side),
    Switch(SwitchRequest),
    Shown,
    Step(Input),
}

/// An outlet that tells what reaches it; refuses setpoints, breaks, or answers each sample with another one, where it is told to.
struct FakeOutlet {
    told: Sender<Told>,
    refusal: Option<&'static str>,
    breaks: bool,
    floods: Option<Inbox>,
}

impl Outlet for FakeOutlet {
    fn setpoint(&mut self, _now: Stamp, side: Side, joints: &JointVector) -> Result<(), String> {
        self.told.send(Told::Setpoint(side, *joints)).unwrap();
        self.refusal.map_or(Ok(()), |reason| Err(reason.to_owned()))
    }

    fn release(&mut self, side: Side) {
        self.told.send(Told::Release(side)).unwrap();
    }

    fn surround(&mut self, scene: Scene) {
        assert!(scene.person.is_empty(), "nobody was seen");
    }

    fn plan(&mut self, order: PlanOrder) {
        self.told.send(Told::Plan(order.number)).unwrap();
    }

    fn switch(&mut self, request: SwitchRequest) {
        self.told.send(Told::Switch(request)).unwrap();
    }

    fn show(&mut self, _snapshot: &Snapshot) {
        self.told.send(Told::Shown).unwrap();
    }

    fn record(&mut self, _now: Stamp, input: &Input, _effects: &[Effect]) {
        assert!(!self.breaks, "an outlet that breaks");
        self.told.send(Told::Step(input.clone())).unwrap();
        if let (Some(inbox), Input::Collision { .. }) = (&self.floods, input) {
            inbox.offer(input.clone());
        }
    }
}

fn supervisor() -> Supervisor {
    Supervisor::new(Setup::default(), RobotModel::baxter().unwrap()).unwrap()
}

fn outlet() -> (FakeOutlet, Receiver<Told>) {
    let (told, heard) = unbounded();
    (FakeOutlet { told, refusal: None, breaks: false, floods: None }, heard)
}

/// A worker that is stepped by hand, with the stop thread that belongs to it and what that sends.
struct Bench {
    worker: Worker,
    told: Receiver<Told>,
    stops: Receiver<()>,
    effects: Receiver<Effect>,
    inbox: Inbox,
    stop: StopThread,
}

impl Bench {
    fn new(refusal: Option<&'static str>) -> Self {
        let (sent, stops) = unbounded();
        let stop = StopThread::start(move || sent.send(()).unwrap_or_default()).unwrap();
        let (outlet, heard) = outlet();
        let (inbox, waiting) = inbox(4);
        let (told, effects) = bounded(64);
        let worker = Worker {
            supervisor: supervisor(),
            outlet: Box::new(FakeOutlet { refusal, floods: Some(inbox.clone()), ..outlet }),
            latch: stop.latch(),
            stops_known: 0,
            waiting,
            inbox: inbox.clone(),
            snapshots: SharedSnapshot::default(),
            told,
            ended: Arc::default(),
            clock: Clock::start(),
        };
        Self { worker, told: heard, stops, effects, inbox, stop }
    }

    fn ask(&mut self, command: Command) {
        self.worker.step(&Input::Operator { command, origin: Origin::OperatorKey });
    }

    fn see_robot(&mut self, enabled: bool, stopped: bool) {
        let stamp = self.worker.clock.now();
        self.worker.step(&Input::Robot(RobotState { stamp, enabled, stopped, ..RobotState::default() }));
    }

    fn told(&self) -> Vec<Told> {
        self.told.try_iter().collect()
    }
}

fn setpoint() -> Effect {
    Effect::Setpoint { side: Side::Left, joints: JointVector::repeat(0.25) }
}

#[test]
fn a_full_inbox_loses_the_newest_counts_it_and_does_not_block() {
    let (inbox, waiting) = inbox(2);
    (0..5).for_each(|_| inbox.offer(Input::Tick));
    assert_eq!((waiting.samples.len(), inbox.lost.load(Ordering::Relaxed)), (2, 3));
}

#[test]
fn an_inbox_without_a_worker_loses_nothing_that_anybody_missed() {
    let (inbox, waiting) = inbox(2);
    drop(waiting);
    inbox.offer(Input::Tick);
    assert_eq!(inbox.lost.load(Ordering::Relaxed), 0);
}

#[test]
fn losses_are_told_to_the_supervisor_once() {
    let mut bench = Bench::new(None);
    bench.worker.waiting.lost.store(7, Ordering::Relaxed);
    bench.worker.report_losses();
    bench.worker.report_losses();
    assert_eq!(bench.told(), [Told::Step(Input::Link(LinkEvent::InboxOverflow { lost: 7 }))]);
    assert_eq!(bench.worker.supervisor.snapshot(bench.worker.clock.now()).dropped_samples, 7);
}

#[test]
fn each_effect_goes_through_its_own_door() {
    let mut bench = Bench::new(None);
    let now = bench.worker.clock.now();
    let told = Effect::Log { level: crate::snapshot::Level::Warning, text: "told".into() };
    for effect in
        [setpoint(), Effect::Release { side: Side::Right }, Effect::Switch(SwitchRequest::Enable), told.clone()]
    {
        bench.worker.carry_out(now, effect);
    }
    assert_eq!(
        bench.told(),
        [
            Told::Setpoint(Side::Left, JointVector::repeat(0.25)),
            Told::Release(Side::Right),
            Told::Switch(SwitchRequest::Enable)
        ]
    );
    assert_eq!(bench.effects.try_iter().collect::<Vec<_>>(), [told]);
}

#[test]
fn telling_stops_where_nobody_takes_it_and_the_arms_are_served_all_the_same() {
    let mut bench = Bench::new(None);
    let now = bench.worker.clock.now();
    for _ in 0..100 {
        bench.worker.carry_out(now, Effect::Log { level: crate::snapshot::Level::Debug, text: String::new() });
    }
    bench.worker.carry_out(now, setpoint());
    assert_eq!(bench.told().len(), 1);
}

#[test]
fn what_the_operator_asks_is_not_lost_among_samples() {
    let mut bench = Bench::new(None);
    for _ in 0..10 {
        bench.inbox.offer(Input::Collision { side: Side::Left, active: false });
    }
    let hold = Input::Operator { command: Command::Hold, origin: Origin::OperatorKey };
    bench.inbox.offer(hold.clone());
    bench.worker.beat();
    let lost = Input::Link(LinkEvent::InboxOverflow { lost: 6 });
    assert!(bench.told().contains(&Told::Step(lost)), "samples beyond what the inbox holds are lost and counted");
    assert_eq!(bench.worker.waiting.orders.try_recv(), Ok(hold));
}

#[test]
fn a_beat_comes_although_more_samples_come_than_can_be_taken_in() {
    let mut bench = Bench::new(None);
    bench.inbox.offer(Input::Collision { side: Side::Left, active: false });
    bench.stop.latch().stop();
    bench.worker.beat();
    assert!(bench.worker.supervisor.is_stopped());
    assert_eq!(bench.worker.waiting.samples.len(), 1, "what came in meanwhile waits for the next beat");
}

#[test]
fn an_enable_does_not_follow_a_stop_that_a_key_has_asked_for_since_the_decision() {
    let mut bench = Bench::new(None);
    bench.stop.latch().stop();
    let now = bench.worker.clock.now();
    for request in [SwitchRequest::Enable, SwitchRequest::Reset, SwitchRequest::Stop] {
        bench.worker.carry_out(now, Effect::Switch(request));
    }
    assert_eq!(bench.told(), [Told::Switch(SwitchRequest::Stop)]);
}

#[test]
fn no_setpoint_passes_a_latch_that_a_key_has_set_since_the_decision() {
    let mut bench = Bench::new(None);
    bench.stop.latch().stop();
    let now = bench.worker.clock.now();
    bench.worker.carry_out(now, setpoint());
    assert_eq!(bench.told(), []);
}

#[test]
fn a_refused_setpoint_comes_back_as_an_input_with_the_guards_words() {
    let mut bench = Bench::new(Some("left_s0 was to jump"));
    let now = bench.worker.clock.now();
    bench.worker.carry_out(now, setpoint());
    let refused = Input::SetpointRefused { side: Side::Left, reason: "left_s0 was to jump".into() };
    assert_eq!(bench.told().last(), Some(&Told::Step(refused)));
}

#[test]
fn a_stop_from_a_key_reaches_the_robot_first_and_the_supervisor_at_the_next_beat() {
    let mut bench = Bench::new(None);
    bench.stop.latch().stop();
    bench.stops.recv_timeout(PATIENCE).unwrap();
    assert!(!bench.worker.supervisor.is_stopped());
    bench.worker.poll_latch();
    assert!(bench.worker.supervisor.is_stopped());
    let stop = Input::Operator { command: Command::Stop, origin: Origin::OperatorKey };
    assert!(bench.told().contains(&Told::Step(stop.clone())));
    bench.worker.poll_latch();
    assert!(!bench.told().contains(&Told::Step(stop)), "told once");
}

#[test]
fn a_stop_sets_the_latch_and_only_reset_enable_and_start_clear_it() {
    let mut bench = Bench::new(None);
    bench.see_robot(true, false);
    bench.ask(Command::Stop);
    bench.stops.recv_timeout(PATIENCE).unwrap();
    bench.see_robot(false, true);
    for (act, enabled, stopped) in
        [(Command::Start, false, true), (Command::Reset, false, false), (Command::Enable, true, false)]
    {
        bench.ask(act);
        assert!(bench.stop.latch().is_stopped(), "not yet");
        bench.see_robot(enabled, stopped);
    }
    bench.ask(Command::Start);
    // Without a person before it no trial begins; but the stop is over.
    assert_eq!(bench.stop.latch().is_stopped(), bench.worker.supervisor.is_stopped());
    assert!(!bench.told().iter().any(|told| matches!(told, Told::Setpoint(..))));
}

#[test]
fn a_stop_key_after_reset_and_enable_stops_the_robot_anew() {
    let mut bench = Bench::new(None);
    bench.see_robot(true, false);
    bench.ask(Command::Stop);
    bench.see_robot(false, true);
    bench.ask(Command::Reset);
    bench.see_robot(false, false);
    bench.ask(Command::Enable);
    bench.see_robot(true, false);
    while bench.stops.recv_timeout(Duration::from_millis(200)).is_ok() {}
    bench.told();
    bench.stop.latch().stop();
    bench.stops.recv_timeout(PATIENCE).unwrap();
    bench.worker.poll_latch();
    assert!(bench.told().contains(&Told::Switch(SwitchRequest::Stop)), "the supervisor stops anew too");
    assert!(!bench.worker.supervisor.stop_is_confirmed());
}

#[test]
fn a_running_engine_takes_inputs_in_their_order_ticks_shows_and_ends_with_its_handle() {
    let stop = StopThread::start(|| ()).unwrap();
    let (outlet, told) = outlet();
    let engine = Engine::start(supervisor(), Box::new(outlet), stop.latch()).unwrap();
    let inputs: Vec<_> = Side::BOTH.map(|side| Input::Collision { side, active: false }).into();
    inputs.iter().for_each(|input| engine.inbox().offer(input.clone()));
    let (mut seen, mut ticks, mut shown) = (Vec::new(), 0, 0);
    while ticks < 3 || shown < 2 || seen.len() < 2 {
        match told.recv_timeout(PATIENCE).unwrap() {
            Told::Step(Input::Tick) => ticks += 1,
            Told::Step(input) => seen.push(input),
            Told::Shown => shown += 1,
            other => panic!("{other:?}"),
        }
    }
    assert_eq!(seen, inputs);
    assert!(engine.snapshots().newest().now > Stamp::ZERO);
    drop(engine);
    while told.recv_timeout(PATIENCE).is_ok() {}
    assert_eq!(
        told.try_recv(),
        Err(crossbeam_channel::TryRecvError::Disconnected),
        "the worker has given its outlet up"
    );
}

#[test]
fn a_worker_that_dies_stops_the_robot() {
    let (sent, stops) = unbounded();
    let stop = StopThread::start(move || sent.send(()).unwrap_or_default()).unwrap();
    let (outlet, _told) = outlet();
    let engine = Engine::start(supervisor(), Box::new(FakeOutlet { breaks: true, ..outlet }), stop.latch()).unwrap();
    stops.recv_timeout(PATIENCE).unwrap();
    assert!(stop.latch().is_stopped());
    while engine.next_effect(PATIENCE).is_ok_and(|effect| effect.is_some()) {}
    assert_eq!(engine.next_effect(PATIENCE), Err(SupervisorDied), "and whoever tells of decisions learns of it");
    drop(engine);
}

/// Whose screen is told nothing until the other end lets go.
struct Hanging(Receiver<()>);
impl Outlet for Hanging {
    fn setpoint(&mut self, _: Stamp, _: Side, _: &JointVector) -> Result<(), String> {
        Ok(())
    }
    fn release(&mut self, _: Side) {}
    fn surround(&mut self, _: Scene) {}
    fn plan(&mut self, _: PlanOrder) {}
    fn switch(&mut self, _: SwitchRequest) {}
    fn show(&mut self, _: &Snapshot) {
        let _ = self.0.recv();
    }
    fn record(&mut self, _: Stamp, _: &Input, _: &[Effect]) {}
}

#[test]
fn a_fit_is_done_elsewhere_and_its_answer_comes_in_past_a_full_inbox() {
    let mut bench = Bench::new(None);
    let order = MovementOrder {
        number: 7,
        side: Side::Right,
        places: [Vec::new(), Vec::new(), Vec::new()],
        settings: crate::modelling::FitSettings::default(),
        seed: 1,
    };
    (0..9).for_each(|_| bench.inbox.offer(Input::Tick));
    bench.worker.carry_out(Stamp::ZERO, Effect::Fit(order));
    let answer = bench.worker.waiting.orders.recv_timeout(PATIENCE).unwrap();
    assert!(matches!(answer, Input::Fitted { number: 7, space: Err(_) }), "{answer:?}");
}

#[test]
fn a_stop_message_leaves_while_the_worker_hangs() {
    let (release, hanging) = bounded::<()>(0);
    let (sent, stops) = unbounded();
    let stop = StopThread::start(move || sent.send(()).unwrap_or_default()).unwrap();
    let engine = Engine::start(supervisor(), Box::new(Hanging(hanging)), stop.latch()).unwrap();
    stop.latch().stop();
    stops.recv_timeout(PATIENCE).unwrap();
    drop(release);
    drop(engine);
}

/// Takes long over two samples that it sends to itself after every other beat: the second one falls into a beat.
struct Slow {
    inbox: Arc<OnceLock<Inbox>>,
    beats: Sender<Stamp>,
    after_next: bool,
}

impl Slow {
    fn offer(&self, side: Side) {
        if let Some(inbox) = self.inbox.get() {
            inbox.offer(Input::Collision { side, active: false });
        }
    }
}

impl Outlet for Slow {
    fn setpoint(&mut self, _: Stamp, _: Side, _: &JointVector) -> Result<(), String> {
        Ok(())
    }
    fn release(&mut self, _: Side) {}
    fn surround(&mut self, _: Scene) {}
    fn plan(&mut self, _: PlanOrder) {}
    fn switch(&mut self, _: SwitchRequest) {}
    fn show(&mut self, _: &Snapshot) {}
    fn record(&mut self, now: Stamp, input: &Input, _: &[Effect]) {
        match input {
            Input::Tick => {
                self.after_next = !self.after_next;
                if self.after_next {
                    self.offer(Side::Left);
                }
                let _ = self.beats.send(now);
            }
            Input::Collision { side, .. } => {
                if *side == Side::Left {
                    self.offer(Side::Right);
                }
                thread::sleep(TICK.mul_f64(1.2));
            }
            _ => {}
        }
    }
}

#[test]
fn after_a_beat_that_took_long_the_next_one_does_not_follow_at_once() {
    let stop = StopThread::start(|| ()).unwrap();
    let (beats, heard) = unbounded();
    let inbox = Arc::new(OnceLock::new());
    let slow = Slow { inbox: Arc::clone(&inbox), beats, after_next: false };
    let engine = Engine::start(supervisor(), Box::new(slow), stop.latch()).unwrap();
    inbox.set(engine.inbox()).unwrap();
    let beats: Vec<Stamp> = (0..30).map(|_| heard.recv_timeout(PATIENCE).unwrap()).collect();
    // A least distance, whatever else the computer does.
    let closest = beats.iter().zip(beats.iter().skip(1)).map(|(one, next)| next.since(*one)).min().unwrap();
    assert!(closest >= TICK / 2, "{closest:?}");
}
