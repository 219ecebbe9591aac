//! The posture that the arms begin a trial from: searched by whoever has time for it, because no beat may wait that long.
//!
//! A question goes out as an effect, the answer comes back as an input. While it is open both arms stand still. An answer that
//! nobody waits for any more is dropped.

use super::{Effect, Input, Mode, Supervisor};
use crate::body::PerSide;
use crate::geometry::Point;
use crate::kinematics::{
    JointVector, Leg, MotionLimits, MotionRefusal, RobotModel, Scene, dressing_postures, plan_postures,
};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// How long the search may take before the operator is told: a hundred times what it takes on a computer that does nothing else.
const PATIENCE: Duration = Duration::from_secs(30);

/// The way along one arm of the person, and what the robot's arms keep clear of on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartLeg {
    /// What surrounds the arms.
    pub scene: Scene,
    /// Where the grippers go in turn: `base`, metres.
    pub stages: Vec<PerSide<Point>>,
}

/// A question to whoever has time for it: joint positions of both arms from which they can go all of the way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartOrder {
    /// Which question this is: the answer names it.
    pub number: u64,
    /// The way along the arm that is dressed first, then along the other one.
    pub legs: [StartLeg; 2],
    /// How the arms may move.
    pub limits: MotionLimits,
}

impl StartOrder {
    /// The answer: some tenths of a second of work, to be done where nobody waits.
    #[must_use]
    pub fn answer(&self, model: &RobotModel) -> Input {
        let joints = self.postures(model).map_err(|refusal| refusal.to_string());
        Input::StartFound { number: self.number, joints }
    }

    /// Postures from which both of the person's arms can be dressed; where there are none, from which the first one can:
    /// the second may be held elsewhere when its turn comes.
    fn postures(&self, model: &RobotModel) -> Result<PerSide<JointVector>, MotionRefusal> {
        let legs = self.legs.each_ref().map(|leg| Leg { scene: &leg.scene, stages: &leg.stages });
        let [first, _] = legs;
        dressing_postures(model, &legs, &self.limits).or_else(|_| dressing_postures(model, &[first], &self.limits))
    }
}

/// What was asked and not answered yet.
#[derive(Debug)]
pub(super) struct OpenStart {
    number: u64,
    asked: Stamp,
    from: PerSide<JointVector>,
    limits: MotionLimits,
}

impl Supervisor {
    /// Asks for the posture to begin from.
    pub(super) fn ask_start(&mut self, now: Stamp, from: PerSide<JointVector>, limits: MotionLimits) {
        let Some(trial) = self.trial.as_ref() else { return };
        let first_arm = self.setup.settings.trial.first_arm;
        let leg = |arm, stages: &[PerSide<Point>]| StartLeg { scene: self.scene(arm), stages: stages.to_vec() };
        let legs = [leg(first_arm, &trial.first_arm_stages()), leg(first_arm.other(), &trial.second_arm_stages())];
        let number = self.questions.next_number();
        self.questions.start = Some(OpenStart { number, asked: now, from, limits: limits.clone() });
        self.effects.push(Effect::FindStart(Box::new(StartOrder { number, legs, limits })));
    }

    /// Holds where the answer has not come for so long that it will not come any more.
    pub(super) fn await_start(&mut self, now: Stamp) {
        let open = self.questions.start.as_ref();
        if open.is_some_and(|open| now.since(open.asked) > PATIENCE) {
            let seconds = PATIENCE.as_secs();
            self.hold(
                now,
                &format!("no posture to begin from was found within {seconds} s: this computer is overloaded"),
            );
        }
    }

    /// Takes an answer: moves the arms to where they begin, or holds with the reason.
    pub(super) fn see_start(&mut self, now: Stamp, number: u64, joints: &Result<PerSide<JointVector>, String>) {
        let Some(open) = self.questions.start.take_if(|open| open.number == number) else { return };
        if self.mode != Mode::Running {
            return;
        }
        match joints {
            Ok(joints) => {
                let scene = self.surroundings();
                let targets = joints.map(|_, joints| Some(*joints));
                let planned = plan_postures(&self.model, &scene, &open.from, &targets, &open.limits);
                self.begin(now, planned);
            }
            Err(reason) => self.hold(now, &format!("the next move is not possible: {reason}")),
        }
    }
}
