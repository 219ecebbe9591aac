//! Faults that the simulated world can have, each with the time at which it begins and ends.
//!
//! Faults happen to the robot, the person and the messages; whether the node notices is not decided here.

mod typed;

pub use typed::TypedFaultError;

use super::random::{Purpose, Random};
use crate::body::{PerSide, Side};
use serde::{Deserialize, Serialize};

/// What can go wrong.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum FaultKind {
    /// Endpoint messages of an arm stop coming.
    StaleForce,
    /// Endpoint messages go on, but the wrench stays at its last value.
    FrozenForce,
    /// A constant is added to the reported force.
    BiasedForce {
        /// Newtons along x, y, z.
        newtons: [f64; 3],
    },
    /// The reported force is not a number.
    NotANumberForce,
    /// Neither images nor poses come.
    LostCamera,
    /// The person's pose is not found any more, while images go on.
    LostPose,
    /// Joint commands reach the arm late.
    LateCommands {
        /// Seconds.
        seconds: f64,
    },
    /// A share of the joint commands is lost.
    DroppedCommands {
        /// From 0 to 1.
        share: f64,
    },
    /// Joint states of an arm stop coming.
    StaleJoints,
    /// A joint's fault stops the robot.
    JointFault,
    /// Somebody presses the red button; it comes up when the fault ends.
    RedButton,
    /// The garment is caught on fist, elbow or a fold.
    Snag,
    /// The garment slips out of a gripper.
    GarmentSlip,
    /// The person pulls the arm away.
    PullAway {
        /// By how many metres.
        metres: f64,
    },
}

impl FaultKind {
    /// The names of all kinds.
    pub const NAMES: [&'static str; 14] = [
        "stale_force",
        "frozen_force",
        "biased_force",
        "not_a_number_force",
        "lost_camera",
        "lost_pose",
        "late_commands",
        "dropped_commands",
        "stale_joints",
        "joint_fault",
        "red_button",
        "snag",
        "garment_slip",
        "pull_away",
    ];

    /// A short name for logs, tables and the command line.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::StaleForce => "stale_force",
            Self::FrozenForce => "frozen_force",
            Self::BiasedForce { .. } => "biased_force",
            Self::NotANumberForce => "not_a_number_force",
            Self::LostCamera => "lost_camera",
            Self::LostPose => "lost_pose",
            Self::LateCommands { .. } => "late_commands",
            Self::DroppedCommands { .. } => "dropped_commands",
            Self::StaleJoints => "stale_joints",
            Self::JointFault => "joint_fault",
            Self::RedButton => "red_button",
            Self::Snag => "snag",
            Self::GarmentSlip => "garment_slip",
            Self::PullAway { .. } => "pull_away",
        }
    }
}

/// One fault: what, on which side, from when to when.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// What goes wrong.
    #[serde(flatten)]
    pub kind: FaultKind,
    /// Which of the robot's or the person's arms; both where it is not given.
    #[serde(default)]
    pub side: Option<Side>,
    /// When it begins, in seconds from the start of the world.
    pub from_seconds: f64,
    /// How long it lasts in seconds; for ever where it is not given.
    #[serde(default)]
    pub duration_seconds: Option<f64>,
}

impl Fault {
    /// True where the fault is there at a time (seconds from the start of the world) on a side.
    #[must_use]
    pub fn is_active(&self, seconds: f64, side: Side) -> bool {
        self.side.is_none_or(|own| own == side) && self.is_active_anywhere(seconds)
    }

    fn is_active_anywhere(&self, seconds: f64) -> bool {
        let end = self.duration_seconds.map_or(f64::INFINITY, |duration| self.from_seconds + duration);
        (self.from_seconds..end).contains(&seconds)
    }
}

/// Which faults a world will have.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FaultPlan {
    /// The faults, in no order.
    pub faults: Vec<Fault>,
}

impl FaultPlan {
    /// One fault of a random kind at a random moment of a trial that lasts about `seconds`: a repeatable accident.
    #[must_use]
    pub fn from_seed(seed: u64, seconds: f64) -> Self {
        let mut random = Random::new(seed, Purpose::Faults);
        let kinds = [
            FaultKind::StaleForce,
            FaultKind::FrozenForce,
            FaultKind::BiasedForce { newtons: random.normal_vector(8.0).into() },
            FaultKind::NotANumberForce,
            FaultKind::LostCamera,
            FaultKind::LostPose,
            FaultKind::LateCommands { seconds: random.between(0.05, 0.4) },
            FaultKind::DroppedCommands { share: random.between(0.2, 1.0) },
            FaultKind::StaleJoints,
            FaultKind::JointFault,
            FaultKind::RedButton,
            FaultKind::Snag,
            FaultKind::GarmentSlip,
            FaultKind::PullAway { metres: random.between(0.05, 0.15) },
        ];
        let pick = random.uniform() * kinds.len() as f64;
        let kind = kinds.iter().enumerate().find(|(index, _)| pick < (index + 1) as f64).map(|(_, kind)| *kind);
        let side = [Some(Side::Left), Some(Side::Right), None]
            .into_iter()
            .nth(usize::from(random.uniform() < 0.5) + usize::from(random.uniform() < 0.5));
        let from_seconds = random.between(0.02, 0.98) * seconds;
        let duration_seconds = (random.uniform() < 0.7).then(|| random.between(0.05, 4.0));
        let fault = kind.map(|kind| Fault { kind, side: side.flatten(), from_seconds, duration_seconds });
        Self { faults: fault.into_iter().collect() }
    }

    /// True where no picture comes at a time (seconds from the start of the world).
    #[must_use]
    pub fn camera_is_lost(&self, seconds: f64) -> bool {
        self.at(seconds).lost_camera
    }

    /// What the faults do at a time (seconds from the start of the world).
    pub(super) fn at(&self, seconds: f64) -> ActiveFaults {
        let mut active = ActiveFaults::default();
        for fault in &self.faults {
            if !fault.is_active_anywhere(seconds) {
                continue;
            }
            for side in Side::BOTH.into_iter().filter(|side| fault.is_active(seconds, *side)) {
                active.arms.get_mut(side).add(&fault.kind);
            }
            match fault.kind {
                FaultKind::LostCamera => active.lost_camera = true,
                FaultKind::LostPose => active.lost_pose = true,
                FaultKind::JointFault => active.joint_fault = true,
                FaultKind::RedButton => active.red_button = true,
                _ => {}
            }
        }
        active
    }
}

/// What faults do at one moment.
#[derive(Clone, Copy, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fault of its own, and any of them may be there at once")]
pub(super) struct ActiveFaults {
    pub(super) arms: PerSide<ArmFaults>,
    pub(super) lost_camera: bool,
    pub(super) lost_pose: bool,
    pub(super) joint_fault: bool,
    pub(super) red_button: bool,
}

/// What faults do to one arm at one moment.
#[derive(Clone, Copy, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fault of its own, and any of them may be there at once")]
pub(super) struct ArmFaults {
    pub(super) stale_force: bool,
    pub(super) frozen_force: bool,
    pub(super) bias: Option<[f64; 3]>,
    pub(super) not_a_number: bool,
    pub(super) late_commands: Option<f64>,
    pub(super) dropped_commands: Option<f64>,
    pub(super) stale_joints: bool,
    pub(super) snag: bool,
    pub(super) garment_slip: bool,
    pub(super) pull_away: Option<f64>,
}

impl ArmFaults {
    const fn add(&mut self, kind: &FaultKind) {
        match *kind {
            FaultKind::StaleForce => self.stale_force = true,
            FaultKind::FrozenForce => self.frozen_force = true,
            FaultKind::BiasedForce { newtons } => self.bias = Some(newtons),
            FaultKind::NotANumberForce => self.not_a_number = true,
            FaultKind::LateCommands { seconds } => self.late_commands = Some(seconds),
            FaultKind::DroppedCommands { share } => self.dropped_commands = Some(share),
            FaultKind::StaleJoints => self.stale_joints = true,
            FaultKind::Snag => self.snag = true,
            FaultKind::GarmentSlip => self.garment_slip = true,
            FaultKind::PullAway { metres } => self.pull_away = Some(metres),
            FaultKind::LostCamera | FaultKind::LostPose | FaultKind::JointFault | FaultKind::RedButton => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_there_from_its_beginning_to_its_end_on_its_side_only() {
        let fault = Fault {
            kind: FaultKind::StaleForce,
            side: Some(Side::Left),
            from_seconds: 2.0,
            duration_seconds: Some(1.0),
        };
        let plan = FaultPlan { faults: vec![fault] };
        for (seconds, expected) in [(1.99, false), (2.0, true), (2.99, true), (3.0, false)] {
            assert_eq!(plan.at(seconds).arms.left.stale_force, expected, "at {seconds} s");
            assert!(!plan.at(seconds).arms.right.stale_force);
        }
    }

    #[test]
    fn a_seed_repeats_its_accident_and_seeds_bring_every_kind() {
        assert_eq!(FaultPlan::from_seed(5, 60.0), FaultPlan::from_seed(5, 60.0));
        let mut names: Vec<&str> =
            (0..400).flat_map(|seed| FaultPlan::from_seed(seed, 60.0).faults).map(|fault| fault.kind.name()).collect();
        names.sort_unstable();
        names.dedup();
        let mut all = FaultKind::NAMES;
        all.sort_unstable();
        assert_eq!(names, all);
    }

    #[derive(Deserialize)]
    struct File {
        faults: FaultPlan,
    }

    #[test]
    fn faults_are_read_from_toml() {
        let text =
            "[[faults]]\nkind = \"biased_force\"\nnewtons = [1.0, 2.0, 3.0]\nside = \"left\"\nfrom_seconds = 3.0\n";
        let file: File = toml::from_str(text).unwrap();
        assert_eq!(file.faults.at(3.0).arms.left.bias, Some([1.0, 2.0, 3.0]));
        assert_eq!(file.faults.at(3.0).arms.right.bias, None);
    }
}
