//! The way between world and supervisor: loses, delays, repeats, reorders and corrupts what passes, and falls silent.

use crate::body::Side;
use crate::supervisor::{Input, LinkEvent};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const LANE_STREAM: u64 = 102;
/// Numbers that a broken sender may put into a message.
const NONSENSE: [f64; 7] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e9, 400.0, 0.0];

/// Which messages fall silent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Topic {
    Endpoint(Side),
    Joints,
    Robot,
    Body,
    Everything,
}

#[derive(Clone, Copy, Debug)]
struct Silence {
    topic: Topic,
    from_seconds: f64,
    to_seconds: f64,
}

/// How bad the lane is; by default it is good.
#[derive(Clone, Debug, Default)]
pub(super) struct LanePlan {
    lost: f64,
    late: f64,
    repeated: f64,
    corrupted: f64,
    silences: Vec<Silence>,
    events: Vec<(f64, LinkEvent)>,
}

impl LanePlan {
    pub(super) fn draw(random: &mut impl Rng, seconds: f64) -> Self {
        let mut share = |most: f64| if random.random_bool(0.3) { random.random_range(0.0..most) } else { 0.0 };
        let (lost, late, repeated, corrupted) = (share(0.05), share(0.05), share(0.2), share(0.002));
        let silences = (0..random.random_range(0..3)).map(|_| Silence::draw(random, seconds)).collect();
        let events = if random.random_bool(0.4) { link_events(random, seconds) } else { Vec::new() };
        Self { lost, late, repeated, corrupted, silences, events }
    }
}

impl LanePlan {
    /// Nothing arrives from one moment to another, in seconds.
    pub(super) fn silence_everything(&mut self, from_seconds: f64, to_seconds: f64) {
        self.silences.push(Silence { topic: Topic::Everything, from_seconds, to_seconds });
    }
}

impl Silence {
    fn draw(random: &mut impl Rng, seconds: f64) -> Self {
        let topics = [
            Topic::Endpoint(Side::Left),
            Topic::Endpoint(Side::Right),
            Topic::Joints,
            Topic::Robot,
            Topic::Body,
            Topic::Everything,
        ];
        let from_seconds = random.random_range(0.0..seconds);
        let to_seconds = from_seconds + random.random_range(0.02..3.0);
        let topic = topics.get(random.random_range(0..topics.len())).copied().unwrap_or(Topic::Everything);
        Self { topic, from_seconds, to_seconds }
    }
}

/// The master goes and comes back, a foreign node appears, a disk fills, a worker dies, the console goes.
fn link_events(random: &mut impl Rng, seconds: f64) -> Vec<(f64, LinkEvent)> {
    let at = random.random_range(0.0..seconds);
    let (topic, node) = ("/robot/limb/left/joint_command".to_owned(), "/other".to_owned());
    match random.random_range(0..8) {
        0 => vec![(at, LinkEvent::MasterLost), (at + random.random_range(0.1..5.0), LinkEvent::MasterBack)],
        1 => vec![(at, LinkEvent::ForeignPublisher { topic, node })],
        6 => vec![
            (at, LinkEvent::ForeignPublisher { topic: topic.clone(), node: node.clone() }),
            (at + random.random_range(0.5..10.0), LinkEvent::ForeignPublisherGone { topic, node }),
        ],
        // The console beats and falls silent, for a while or for good.
        7 => (0..20_u32)
            .map(|beat| at + f64::from(beat) * random.random_range(0.2..0.6))
            .map(|at| (at, LinkEvent::ConsoleBeat))
            .collect(),
        2 => vec![(at, LinkEvent::RecorderFailed { reason: "the disk is full".into() })],
        3 => vec![(at, LinkEvent::WorkerLost { name: "planner".into() })],
        4 => vec![(at, LinkEvent::InboxOverflow { lost: 17 })],
        _ => vec![(at, LinkEvent::ConsoleLost)],
    }
}

/// The lane with what is still under way on it.
#[derive(Debug)]
pub(super) struct Lane {
    plan: LanePlan,
    random: ChaCha8Rng,
    under_way: Vec<(f64, Input)>,
}

impl Lane {
    pub(super) fn new(plan: LanePlan, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(LANE_STREAM);
        let under_way = plan.events.iter().map(|(at, event)| (*at, Input::Link(event.clone()))).collect();
        Self { plan, random, under_way }
    }

    /// What arrives now, of what is sent now and of what was sent before.
    pub(super) fn pass(&mut self, seconds: f64, sent: impl Iterator<Item = Input>) -> Vec<Input> {
        let mut arrived = Vec::new();
        self.under_way.retain(|(due, input)| {
            let is_due = *due <= seconds;
            if is_due {
                arrived.push(input.clone());
            }
            !is_due
        });
        for input in sent {
            self.send(seconds, input, &mut arrived);
        }
        arrived
    }

    fn send(&mut self, seconds: f64, mut input: Input, arrived: &mut Vec<Input>) {
        if self.is_silent(seconds, &input) || self.happens(self.plan.lost) {
            return;
        }
        if self.happens(self.plan.corrupted) {
            corrupt(&mut self.random, &mut input);
        }
        if self.happens(self.plan.repeated) {
            arrived.push(input.clone());
        }
        if self.happens(self.plan.late) {
            let delay = self.random.random_range(0.005..0.4);
            self.under_way.push((seconds + delay, input));
        } else {
            arrived.push(input);
        }
    }

    fn happens(&mut self, share: f64) -> bool {
        share > 0.0 && self.random.random_bool(share)
    }

    fn is_silent(&self, seconds: f64, input: &Input) -> bool {
        self.plan.silences.iter().any(|silence| {
            let concerns = match (silence.topic, input) {
                (Topic::Everything, _)
                | (Topic::Joints, Input::Joints(_))
                | (Topic::Robot, Input::Robot(_))
                | (Topic::Body, Input::Body(_)) => true,
                (Topic::Endpoint(side), Input::Endpoint(sample)) => sample.side == side,
                _ => false,
            };
            concerns && (silence.from_seconds..silence.to_seconds).contains(&seconds)
        })
    }
}

/// Puts nonsense into a message.
fn corrupt(random: &mut impl Rng, input: &mut Input) {
    let nonsense = NONSENSE.get(random.random_range(0..NONSENSE.len())).copied().unwrap_or(f64::NAN);
    match input {
        Input::Endpoint(sample) => match random.random_range(0..3) {
            0 => sample.wrench.force.x = nonsense,
            1 => sample.wrench.force.z = nonsense,
            _ => sample.pose.translation.vector.y = nonsense,
        },
        Input::Joints(sample) => {
            let side = if random.random_bool(0.5) { Side::Left } else { Side::Right };
            let index = random.random_range(0..7_usize);
            if let Some(joint) = sample.positions.get_mut(side).get_mut(index) {
                *joint = random.random_bool(0.5).then_some(nonsense);
            }
        }
        Input::Robot(state) => match random.random_range(0..3) {
            0 => state.enabled = !state.enabled,
            1 => state.stopped = !state.stopped,
            _ => state.error = !state.error,
        },
        Input::Body(pose) => {
            if let Some(mut elbow) = pose.arms.right.joint(crate::body::Joint::Elbow).copied() {
                elbow.position.x = nonsense;
                pose.arms.right.set(crate::body::Joint::Elbow, Some(elbow));
            }
        }
        _ => {}
    }
}
