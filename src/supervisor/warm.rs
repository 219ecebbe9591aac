//! Warm start: a path that an earlier trial learned is offered to the next one, carried over to where the arm is now.
//!
//! It is used only where the operator says so (`warm_start`), and the log names the trial that it comes from.

use super::{Effect, Supervisor};
use crate::body::Side;
use crate::geometry::Point;
use crate::planning::{ArmJoints, ArmRelative};
use crate::snapshot::Level;
use crate::strategy::{LearnedPath, Strategy, StrategyKind};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};

/// A path that a trial has learned, relative to the person's arm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WarmStart {
    /// Which arm.
    pub side: Side,
    /// Which strategy learned it.
    pub strategy: StrategyKind,
    /// The trial that it comes from: the name of its journal.
    pub trial: String,
    /// Its energy in the last iteration, in newtons.
    pub energy_newtons: f64,
    /// The number of the way-point at the elbow, where the strategy keeps the two limbs apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elbow: Option<usize>,
    /// Way-points relative to the arm: part of the arm (0 hand to elbow, 1 elbow to shoulder), share of that part's length,
    /// and the offset in metres along the part, outwards and upwards.
    pub waypoints: Vec<ArmRelative>,
}

const fn arm_of([hand, elbow, shoulder]: [Point; 3]) -> ArmJoints {
    ArmJoints { hand, elbow, shoulder }
}

impl WarmStart {
    /// The path at an arm with these joints (hand, elbow, shoulder, in `base`); `None` where the arm has no length.
    fn carried_to(&self, joints: [Point; 3]) -> Option<LearnedPath> {
        let arm = arm_of(joints);
        let path = self.waypoints.iter().map(|waypoint| arm.place(waypoint)).collect::<Option<Vec<Point>>>()?;
        Some(LearnedPath {
            kind: self.strategy,
            path,
            iteration: 0,
            elbow: self.elbow,
            optimiser: None,
            stiffness: None,
        })
    }
}

impl Supervisor {
    /// The path that was learned last for an arm with a strategy.
    fn offered(&self, side: Side, kind: StrategyKind) -> Option<&WarmStart> {
        self.setup.warm_start.iter().rev().find(|path| path.side == side && path.strategy == kind)
    }

    /// Begins an arm with the path that was learned last, where the operator chose that; says so in either case.
    pub(super) fn start_warm(&mut self, now: Stamp, side: Side, strategy: &mut dyn Strategy, joints: [Point; 3]) {
        let Some(offered) = self.offered(side, strategy.kind()).cloned() else { return };
        let told = format!("the path that trial {} learned ({:.1} N)", offered.trial, offered.energy_newtons);
        if !self.setup.settings.warm_start {
            let text = format!("{side} arm: {told} is there, but warm_start is off: it begins anew");
            self.log(now, Level::Information, "strategy", text);
            return;
        }
        let Some(path) = offered.carried_to(joints) else {
            let text = format!("{side} arm: {told} cannot be carried over: the arm's joints coincide");
            self.log(now, Level::Warning, "strategy", text);
            return;
        };
        // What a fresh strategy has learned is nothing: nothing is dropped.
        let _ = strategy.adopt(&path);
        let text = format!("{side} arm: begins with {told}, carried over to where the arm is now");
        self.log(now, Level::Information, "strategy", text);
    }

    /// Tells what was learned for an arm that is dressed, for the next trial to begin with.
    pub(super) fn tell_learned(&mut self, side: Side) {
        let Some(trial) = self.trial.as_ref() else { return };
        let (learned, arm) = (trial.strategy(side).learned(), arm_of(trial.joints(side)));
        let waypoints = learned.path.iter().map(|waypoint| arm.relative(waypoint)).collect::<Option<Vec<_>>>();
        // A gripper that gave way by nothing leaves two way-points at one place; a path to begin with has none.
        let waypoints = waypoints.map(|mut waypoints| {
            waypoints.dedup_by(|next, kept| next.is_at(kept));
            waypoints
        });
        let energy_newtons = self.view.sides.get(side).iterations.last().map_or(0.0, |iteration| iteration.energy);
        if let Some(waypoints) = waypoints.filter(|waypoints| waypoints.iter().all(ArmRelative::is_usable)) {
            self.effects.push(Effect::Learned(WarmStart {
                side,
                strategy: learned.kind,
                trial: String::new(),
                energy_newtons,
                elbow: learned.elbow,
                waypoints,
            }));
        }
    }
}
