//! How the description that a robot offers differs from the one a model was made from: shown to the operator before a trial.

use super::chain::JOINTS;
use super::model::RobotModel;
use crate::body::{PerSide, Side};
use crate::geometry::Point;
use thiserror::Error;

/// Smaller differences of limits (radians, radians per second) are rounding in descriptions.
const LIMIT_ROUNDING: f64 = 1e-4;
/// Smaller differences of a tip's place (metres) are rounding in descriptions.
const TIP_ROUNDING: f64 = 1e-4;

/// One difference of two robots.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Difference {
    /// A joint's range or speed.
    #[error(
        "{joint}: valet works with {:.4} to {:.4} rad at {:.2} rad/s, the robot says {:.4} to {:.4} rad at {:.2} rad/s",
        ours.0, ours.1, ours.2, theirs.0, theirs.1, theirs.2
    )]
    Limits {
        /// The joint's name on the wire.
        joint: String,
        /// Lower end, upper end (radians) and speed (radians per second) of this model.
        ours: (f64, f64, f64),
        /// The same of the other.
        theirs: (f64, f64, f64),
    },
    /// The gripper's tip: another tool, or another arm.
    #[error(
        "the {side} gripper's tip is {distance:.4} m from where the robot's description puts it; set the tool that is mounted"
    )]
    Tip {
        /// Which gripper.
        side: Side,
        /// The largest distance found, in metres.
        distance: f64,
    },
}

impl RobotModel {
    /// What differs in another robot: joint limits, and where the tips are. Empty where both are the same within rounding.
    #[must_use]
    pub fn differences(&self, other: &Self) -> Vec<Difference> {
        let mut found = Vec::new();
        for side in Side::BOTH {
            found.extend(limit_differences(self, other, side));
            found.extend(tip_difference(self, other, side));
        }
        found
    }
}

fn limit_differences(ours: &RobotModel, theirs: &RobotModel, side: Side) -> Vec<Difference> {
    let models = PerSide { left: ours, right: theirs };
    let arm = ours.arm(side);
    let differs = |index: usize| {
        let PerSide { left, right } = models.map(|_, model| {
            let limits = model.arm(side).limits();
            let (lower, upper) = limits.range(index);
            (lower, upper, limits.speed.get(index).copied().unwrap_or(f64::NAN))
        });
        let same =
            (left.0 - right.0).abs().max((left.1 - right.1).abs()).max((left.2 - right.2).abs()) <= LIMIT_ROUNDING;
        let joint = arm.joint_names().get(index)?.clone();
        (!same).then_some(Difference::Limits { joint, ours: left, theirs: right })
    };
    (0..JOINTS).filter_map(differs).collect()
}

/// Compares the tips in a few postures: where they agree, links and tool are the same.
fn tip_difference(ours: &RobotModel, theirs: &RobotModel, side: Side) -> Option<Difference> {
    let limits = ours.arm(side).limits();
    let distance = [0.3, 0.5, 0.8]
        .into_iter()
        .map(|share| {
            let joints = limits.lower.lerp(&limits.upper, share);
            let place = |model: &RobotModel| Point::from(model.arm(side).forward(&joints).translation.vector);
            (place(ours) - place(theirs)).norm()
        })
        .fold(0.0, f64::max);
    (distance > TIP_ROUNDING).then_some(Difference::Tip { side, distance })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::{BAXTER_URDF, Tool};

    #[test]
    fn a_robot_does_not_differ_from_itself() {
        let model = RobotModel::baxter().unwrap();
        assert_eq!(model.differences(&RobotModel::baxter().unwrap()), []);
    }

    #[test]
    fn other_limits_are_shown_by_joint_with_both_values() {
        let ours = RobotModel::baxter().unwrap();
        let text = BAXTER_URDF.replace("lower=\"-0.05\" upper=\"2.618\"", "lower=\"-0.05\" upper=\"2.4\"");
        let theirs = RobotModel::from_urdf(&text, PerSide::default()).unwrap();
        let found = ours.differences(&theirs);
        assert_eq!(found.len(), 2, "both elbows: {found:?}");
        let words = found[0].to_string();
        assert!(words.contains("left_e1") && words.contains("2.6180") && words.contains("2.4000"), "{words}");
    }

    #[test]
    fn another_tool_is_shown_with_its_distance() {
        let ours = RobotModel::baxter().unwrap();
        let tools = PerSide { left: Tool::AsDescribed, right: Tool::ElectricExtended };
        let theirs = RobotModel::from_urdf(BAXTER_URDF, tools).unwrap();
        match ours.differences(&theirs).as_slice() {
            [Difference::Tip { side: Side::Right, distance }] => assert!((distance - 0.1327).abs() < 1e-9),
            other => panic!("{other:?}"),
        }
    }
}
