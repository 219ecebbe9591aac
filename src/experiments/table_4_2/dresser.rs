//! One arm dressed in virtual time: the shipped strategy and detector on a simulated person, without a robot's joints.
//!
//! Follows the order of a trial: passes along the path, each contact answered by a halt and the strategy's way-point, a
//! withdrawal along the travelled path, and the next pass, until no resistance is left or eight passes are done.

use crate::body::Side;
use crate::geometry::{Point, Pose, Vector};
use crate::modelling::ArmSpace;
use crate::sensing::{Detection, ForceWindow, SensingError, WindowForm, WindowSettings, WrenchConversion};
use crate::sim::rig::{BEAT_SECONDS, Rig};
use crate::sim::{SimError, WorldSetup};
use crate::strategy::{
    ArmContext, Contact, IterationSummary, StrategyError, StrategyKind, StrategySettings, WaypointChange, build,
};
use crate::time::Stamp;
use thiserror::Error;

/// Gripper speed in metres per second (thesis section 3.5: 3 s for 0.30 m).
const SPEED: f64 = 0.10;
/// Gripper acceleration in metres per second squared: at rest from full speed within 25 mm, as the robot's halt.
const ACCELERATION: f64 = 0.25;
/// Least time to a goal in seconds (thesis section 3.5).
const LEAST_SECONDS: f64 = 3.0;
/// Resistance is not listened to for this long after a motion has begun, in seconds.
const SETTLING: f64 = 0.3;
/// What the thesis' robot took to plan and start a new motion after a resistance, in seconds. Its table 4.2 grows by
/// about 11 s a resistance; the rest of that is the halt, the correction and the slower way after it.
pub const PLANNING_SECONDS: f64 = 6.0;

/// Why an experiment could not be run.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DressingError {
    /// The simulated person or garment cannot be.
    #[error(transparent)]
    World(#[from] SimError),
    /// The detector's settings cannot be used.
    #[error(transparent)]
    Sensing(#[from] SensingError),
    /// The strategy cannot work.
    #[error(transparent)]
    Strategy(#[from] StrategyError),
}

/// One resistance and the strategy's answer.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactRecord {
    /// Where the gripper stood, in metres in `base`.
    pub position: Point,
    /// Which way-points moved.
    pub changes: Vec<WaypointChange>,
}

/// One pass of the garment along the arm.
#[derive(Clone, Debug, PartialEq)]
pub struct PassRecord {
    /// What the strategy says of it.
    pub summary: IterationSummary,
    /// The path that was planned at its beginning, in metres in `base`.
    pub planned: Vec<Point>,
    /// Its resistances in order.
    pub contacts: Vec<ContactRecord>,
    /// Seconds from the first motion of the pass to its end.
    pub motion_seconds: f64,
    /// The gripper's places by beat, in metres in `base`.
    pub travelled: Vec<Point>,
    /// The detector's statistic by beat, in newtons; `None` while the window fills.
    pub statistic: Vec<Option<f64>>,
}

/// One experiment: all passes along one arm.
#[derive(Clone, Debug, PartialEq)]
pub struct DressingRecord {
    /// The passes in order.
    pub passes: Vec<PassRecord>,
}

impl PassRecord {
    /// Seconds that the pass took, with the planning time of the thesis' robot for each resistance.
    #[must_use]
    pub fn duration_seconds(&self) -> f64 {
        self.motion_seconds + PLANNING_SECONDS * f64::from(self.summary.contacts)
    }
}

impl DressingRecord {
    /// Passes until no resistance was left.
    #[must_use]
    pub fn iterations(&self) -> usize {
        self.passes.len()
    }

    /// True where the last pass met no resistance.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.passes.last().is_some_and(|pass| pass.summary.contacts == 0)
    }

    /// Sum of detected resistance over all passes in newtons (the thesis' energy).
    #[must_use]
    pub fn energy_newtons(&self) -> f64 {
        self.passes.iter().map(|pass| pass.summary.energy).sum()
    }

    /// Resistances of all passes.
    #[must_use]
    pub fn resistances(&self) -> u32 {
        self.passes.iter().map(|pass| pass.summary.contacts).sum()
    }

    /// Seconds that the passes took, with the planning time of the thesis' robot for each resistance.
    #[must_use]
    pub fn duration_seconds(&self) -> f64 {
        self.passes.iter().map(PassRecord::duration_seconds).sum()
    }
}

/// Dresses one arm with chapter 4's strategy and returns what came of it.
///
/// # Errors
/// Where the person, the garment or the settings cannot be.
pub fn dress(setup: &WorldSetup, side: Side) -> Result<DressingRecord, DressingError> {
    dress_with(setup, side, StrategyKind::Force, None)
}

/// Dresses one arm with a strategy. With a movement space the initial path is where its joints are most often, and the
/// lengths of the arm are kept (thesis section 5.2.2); without one it is where hand, elbow and shoulder are.
///
/// # Errors
/// Where the person, the garment or the settings cannot be, or the strategy needs a movement space.
pub fn dress_with(
    setup: &WorldSetup,
    side: Side,
    kind: StrategyKind,
    space: Option<&ArmSpace>,
) -> Result<DressingRecord, DressingError> {
    let rig = Rig::new(setup, side)?;
    let [hand, elbow, shoulder] = rig.dressed();
    let lengths = [(elbow - hand).norm(), (shoulder - elbow).norm()];
    let initial = space.map_or([hand, elbow, shoulder], |space| space.initial_path(lengths));
    let context = ArmContext { initial, space: space.cloned(), seed: setup.seed };
    let mut strategy = build(kind, &StrategySettings::default(), &context)?;
    let window = ForceWindow::new(WindowSettings { form: WindowForm::Vector, ..WindowSettings::default() })?;
    let mut gripper = Gripper::new(rig, window);
    let [start, ..] = initial;
    gripper.go(start, 0.0, false);
    let mut record = DressingRecord { passes: Vec::new() };
    loop {
        strategy.begin()?;
        gripper.begin_pass(strategy.path().to_vec());
        let mut corners = vec![gripper.at];
        while let Some(goal) = strategy.goal() {
            match gripper.go(goal, LEAST_SECONDS, true) {
                None => strategy.arrived(),
                Some(found) => {
                    let contact = Contact { position: gripper.at, resistance: found.resistance };
                    corners.push(gripper.at);
                    let reaction = strategy.resisted(&contact);
                    gripper.contacts.push(ContactRecord { position: contact.position, changes: reaction.changes });
                    gripper.go(reaction.move_to, 0.0, false);
                }
            }
            corners.push(gripper.at);
        }
        let summary = strategy.finish();
        let finished = summary.finished.is_some();
        record.passes.push(gripper.end_pass(summary));
        if finished {
            return Ok(record);
        }
        for corner in corners.into_iter().rev() {
            gripper.go(corner, 0.0, false);
        }
        gripper.rest();
    }
}

/// A gripper with its detector and its clock.
struct Gripper {
    rig: Rig,
    window: ForceWindow,
    conversion: WrenchConversion,
    beat: u64,
    at: Point,
    pass_began: u64,
    planned: Vec<Point>,
    contacts: Vec<ContactRecord>,
    travelled: Vec<Point>,
    statistic: Vec<Option<f64>>,
}

impl Gripper {
    fn new(rig: Rig, window: ForceWindow) -> Self {
        let [at, ..] = rig.dressed();
        let conversion = WrenchConversion::default();
        Self {
            rig,
            window,
            conversion,
            beat: 0,
            at,
            pass_began: 0,
            planned: Vec::new(),
            contacts: Vec::new(),
            travelled: Vec::new(),
            statistic: Vec::new(),
        }
    }

    fn begin_pass(&mut self, planned: Vec<Point>) {
        self.pass_began = self.beat;
        self.planned = planned;
        (self.travelled, self.statistic) = (Vec::new(), Vec::new());
    }

    fn end_pass(&mut self, summary: IterationSummary) -> PassRecord {
        PassRecord {
            summary,
            planned: std::mem::take(&mut self.planned),
            contacts: std::mem::take(&mut self.contacts),
            motion_seconds: (self.beat - self.pass_began) as f64 * BEAT_SECONDS,
            travelled: std::mem::take(&mut self.travelled),
            statistic: std::mem::take(&mut self.statistic),
        }
    }

    /// Waits at the hand for a second, as between two passes.
    fn rest(&mut self) {
        for _ in 0..100 {
            self.tick(self.at);
        }
    }

    /// Goes to a goal in a straight line; a resistance on the way, where it is listened to, brings the gripper to a halt.
    fn go(&mut self, goal: Point, least_seconds: f64, listen: bool) -> Option<Detection> {
        self.window.reset();
        let (start, way) = (self.at, goal - self.at);
        let length = way.norm();
        let direction = way.try_normalize(1e-9)?;
        let top = if least_seconds > 0.0 { SPEED.min(length / (least_seconds - SPEED / ACCELERATION)) } else { SPEED };
        let (mut done, mut speed, mut since, mut found) = (0.0, 0.0_f64, 0.0, None);
        loop {
            let braking = speed * speed / (2.0 * ACCELERATION);
            let slower = found.is_some() || done + braking >= length;
            let change = ACCELERATION * BEAT_SECONDS;
            speed = if slower { speed - change } else { (speed + change).min(top) };
            let creep = if found.is_some() { 0.0 } else { change };
            speed = speed.max(creep.min(top));
            done = (done + speed * BEAT_SECONDS).min(length);
            since += BEAT_SECONDS;
            self.tick(start + direction * done);
            if found.is_none() && listen && since > SETTLING {
                found = self.window.detect();
            }
            if done >= length || (found.is_some() && speed <= 0.0) {
                return found;
            }
        }
    }

    /// One beat: the wrench comes in and the window takes it.
    fn tick(&mut self, tip: Point) {
        let wrench = self.rig.place(tip);
        let stamp = Stamp::from_nanoseconds(self.beat * 10_000_000);
        let force: Vector = self.conversion.gripper_force(&wrench, &Pose::identity());
        let reading = self.window.push(stamp, force);
        self.beat += 1;
        self.at = tip;
        self.travelled.push(tip);
        self.statistic.push(reading.map(|reading| reading.combined));
    }
}
