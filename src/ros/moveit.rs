//! MoveIt as a planner: asks `/compute_cartesian_path` for the ways of both arms, and hands them back as joint positions.
//!
//! It only plans. Checks, timing and streaming stay valet's own, so that the chain of the stop does not change. Of the two
//! definitions in use (Noetic; Melodic and older) the one is taken whose digest the server offers; a third one is refused by name.
//! The person is not told to MoveIt: valet checks each way against the person itself.

use super::message::{geometry_msgs, moveit_msgs, moveit_msgs_melodic, sensor_msgs, std_msgs, trajectory_msgs};
use super::node::Node;
use super::service_call::{ServiceCaller, ServiceError};
use crate::body::{PerSide, Side};
use crate::geometry::Pose;
use crate::kinematics::{ArmModel, JointVector, MotionRefusal, PairMotion, RobotModel, Target, Ways, plan_through};
use crate::robot::{PlanRequest, Planner};
use nalgebra::{Isometry3, Translation3};
use rosrust::Message;
use std::time::Duration;
use thiserror::Error;

/// The service of `move_group` that plans straight lines.
pub const SERVICE: &str = "/compute_cartesian_path";
/// How long one step of a call may take: MoveIt plans a line of 0.6 m in well under a second.
const LIMIT: Duration = Duration::from_secs(2);
/// Distance of the points of a way in metres, as MoveIt's own tutorials have it near people: half of their 0.01 m.
const MAX_STEP: f64 = 0.005;
/// The least share of a line that counts as all of it: MoveIt counts points, and the last one may round.
const WHOLE: f64 = 0.999;
/// MoveIt's code for success.
const SUCCESS: i32 = 1;

/// Which definition a server speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Definition {
    Noetic,
    Melodic,
}

/// Why MoveIt gave no way.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MoveItError {
    /// The call itself.
    #[error("{0}; start move_group, or choose the planner built_in")]
    Service(#[from] ServiceError),
    /// A definition that valet does not have.
    #[error(
        "move_group speaks a definition of {SERVICE} that valet does not have (md5sum {digest}); valet has that of Noetic \
         ({noetic}) and that of Melodic and older ({melodic}): choose the planner built_in"
    )]
    Definition {
        /// What the server offers.
        digest: String,
        /// The digest of Noetic.
        noetic: String,
        /// The digest of Melodic and older.
        melodic: String,
    },
    /// MoveIt refuses.
    #[error("MoveIt cannot plan for the {side} arm: {} (code {code})", words(*code))]
    Refused {
        /// Which arm.
        side: Side,
        /// `moveit_msgs/MoveItErrorCodes`.
        code: i32,
    },
    /// Only a part of the line is possible.
    #[error("MoveIt can follow only {:.0} % of the {side} gripper's line", fraction * 100.0)]
    Partial {
        /// Which arm.
        side: Side,
        /// The share, 0 to 1.
        fraction: f64,
    },
    /// The answer does not hold a way of the arm.
    #[error("MoveIt's way for the {side} arm is not usable: {reason}")]
    Way {
        /// Which arm.
        side: Side,
        /// What is wrong with it.
        reason: String,
    },
}

/// What both definitions answer.
struct Answer {
    code: i32,
    fraction: f64,
    trajectory: trajectory_msgs::JointTrajectory,
}

/// MoveIt on this graph.
#[derive(Clone, Debug)]
pub struct MoveItPlanner {
    caller: ServiceCaller,
    model: RobotModel,
}

/// One call with the definition of a package: the fields that both have are named alike.
macro_rules! ask {
    ($package:ident, $caller:expr, $header:expr, $joints:expr, $side:expr, $target:expr) => {{
        let request = $package::GetCartesianPathReq {
            header: $header,
            // What is not named here (head, grippers) is as MoveIt knows it.
            start_state: $package::RobotState { joint_state: $joints, is_diff: true, ..Default::default() },
            group_name: format!("{}_arm", $side),
            link_name: format!("{}_gripper", $side),
            waypoints: vec![$target],
            max_step: MAX_STEP,
            avoid_collisions: true,
            // No threshold for jumps: MoveIt's is relative, valet checks each step against the robot's joints.
            ..Default::default()
        };
        let answer = $caller.call::<$package::GetCartesianPath>(&request)?;
        Answer { code: answer.error_code.val, fraction: answer.fraction, trajectory: answer.solution.joint_trajectory }
    }};
}

impl MoveItPlanner {
    /// MoveIt on the node's graph, for a robot.
    #[must_use]
    pub fn new(node: &Node, model: RobotModel) -> Self {
        Self::at(node.master(), &node.name(), model)
    }

    /// MoveIt on the graph of a master.
    #[must_use]
    pub fn at(master: &str, caller: &str, model: RobotModel) -> Self {
        let caller =
            ServiceCaller { master: master.into(), caller: caller.into(), service: SERVICE.into(), limit: LIMIT };
        Self { caller, model }
    }

    /// The ways of both arms for straight lines from where they are (radians) to their targets. An arm without a target has none.
    ///
    /// # Errors
    /// [`MoveItError`]: nobody answers, another definition, a refusal, or a part of the line only.
    pub fn ways(&self, start: &PerSide<JointVector>, targets: &PerSide<Option<Target>>) -> Result<Ways, MoveItError> {
        let definition = self.definition()?;
        let way = |side: Side| {
            let Some(target) = targets.get(side) else { return Ok(None) };
            let answer = self.ask(definition, side, start, target)?;
            if answer.code != SUCCESS {
                return Err(MoveItError::Refused { side, code: answer.code });
            }
            if answer.fraction.is_nan() || answer.fraction < WHOLE {
                return Err(MoveItError::Partial { side, fraction: answer.fraction });
            }
            joints_of(self.model.arm(side), &answer.trajectory).map(Some)
        };
        Ok(PerSide { left: way(Side::Left)?, right: way(Side::Right)? })
    }

    /// Which definition the server speaks.
    fn definition(&self) -> Result<Definition, MoveItError> {
        let digest = self.caller.digest()?;
        let noetic = moveit_msgs::GetCartesianPath::md5sum();
        let melodic = moveit_msgs_melodic::GetCartesianPath::md5sum();
        match digest {
            digest if digest == noetic => Ok(Definition::Noetic),
            digest if digest == melodic => Ok(Definition::Melodic),
            digest => Err(MoveItError::Definition { digest, noetic, melodic }),
        }
    }

    fn ask(
        &self,
        definition: Definition,
        side: Side,
        start: &PerSide<JointVector>,
        target: &Target,
    ) -> Result<Answer, MoveItError> {
        let here = self.model.arm(side).forward(start.get(side));
        let there = Isometry3::from_parts(
            Translation3::from(target.position.coords),
            target.orientation.unwrap_or(here.rotation),
        );
        let header = std_msgs::Header { frame_id: "base".into(), ..std_msgs::Header::default() };
        let (joints, there) = (self.joint_state(start), pose_message(&there));
        Ok(match definition {
            Definition::Noetic => ask!(moveit_msgs, self.caller, header, joints, side, there),
            Definition::Melodic => ask!(moveit_msgs_melodic, self.caller, header, joints, side, there),
        })
    }

    fn joint_state(&self, start: &PerSide<JointVector>) -> sensor_msgs::JointState {
        let mut state = sensor_msgs::JointState::default();
        for (side, joints) in start.iter() {
            state.name.extend(self.model.arm(side).joint_names().iter().cloned());
            state.position.extend(joints.iter());
        }
        state
    }
}

impl Planner for MoveItPlanner {
    fn name(&self) -> &'static str {
        "MoveIt"
    }

    fn plan(&mut self, request: &PlanRequest<'_>) -> Result<PairMotion, MotionRefusal> {
        let ways = self.ways(request.start, request.targets);
        let ways = ways.map_err(|error| MotionRefusal::Planner { reason: error.to_string() })?;
        plan_through(&self.model, request.scene, request.start, request.targets, &ways, request.limits)
    }
}

/// The arm's joints at each point of a trajectory, in the arm's own order; joints of others are left out.
fn joints_of(arm: &ArmModel, trajectory: &trajectory_msgs::JointTrajectory) -> Result<Vec<JointVector>, MoveItError> {
    let side = arm.side();
    let unusable = |reason: String| MoveItError::Way { side, reason };
    let places: Vec<usize> = arm
        .joint_names()
        .iter()
        .map(|name| {
            let place = trajectory.joint_names.iter().position(|named| named == name);
            place.ok_or_else(|| unusable(format!("it does not name {name}")))
        })
        .collect::<Result<_, _>>()?;
    let point = |(index, point): (usize, &trajectory_msgs::JointTrajectoryPoint)| {
        let values: Option<Vec<f64>> = places.iter().map(|place| point.positions.get(*place).copied()).collect();
        let values = values.ok_or_else(|| unusable(format!("its point {index} has too few positions")))?;
        Ok(JointVector::from_column_slice(&values))
    };
    trajectory.points.iter().enumerate().map(point).collect()
}

fn pose_message(pose: &Pose) -> geometry_msgs::Pose {
    let (place, turn) = (&pose.translation.vector, pose.rotation.quaternion().coords);
    geometry_msgs::Pose {
        position: geometry_msgs::Point { x: place.x, y: place.y, z: place.z },
        orientation: geometry_msgs::Quaternion { x: turn.x, y: turn.y, z: turn.z, w: turn.w },
    }
}

/// The codes that planning a line may bring, in words.
const fn words(code: i32) -> &'static str {
    match code {
        -1 => "planning failed",
        -2 => "its own plan is not valid",
        -6 => "it ran out of time",
        -7 => "it was interrupted",
        -10 => "the arms touch something where they are",
        -12 => "the target touches something",
        -15 => "it has no group of that name: is it configured for a Baxter?",
        -17 | -23 => "it does not know where the joints are: is joint_states remapped to /robot/joint_states?",
        -18 => "it has no gripper link of that name: set left_tip_name and right_tip_name",
        -21 => "it cannot transform from base",
        -31 => "no inverse kinematics",
        _ => "it does not say why",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trajectory(names: &[&str], points: &[&[f64]]) -> trajectory_msgs::JointTrajectory {
        let point = |positions: &&[f64]| trajectory_msgs::JointTrajectoryPoint {
            positions: positions.to_vec(),
            ..Default::default()
        };
        trajectory_msgs::JointTrajectory {
            joint_names: names.iter().map(|name| (*name).to_owned()).collect(),
            points: points.iter().map(point).collect(),
            ..Default::default()
        }
    }

    const ALPHABETICAL: [&str; 7] =
        ["right_e0", "right_e1", "right_s0", "right_s1", "right_w0", "right_w1", "right_w2"];

    #[test]
    fn joints_are_found_by_name_whatever_their_order() {
        let model = RobotModel::baxter().unwrap();
        let way = trajectory(&ALPHABETICAL, &[&[0.2, 0.3, 0.0, 0.1, 0.4, 0.5, 0.6]]);
        let joints = joints_of(model.arm(Side::Right), &way).unwrap();
        assert_eq!(joints, [JointVector::from([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6])]);
    }

    #[test]
    fn a_way_that_lacks_a_joint_or_a_position_is_refused() {
        let model = RobotModel::baxter().unwrap();
        let short = trajectory(&ALPHABETICAL, &[&[0.0; 3]]);
        let words = joints_of(model.arm(Side::Right), &short).unwrap_err().to_string();
        assert!(words.contains("point 0 has too few"), "{words}");
        let words = joints_of(model.arm(Side::Left), &short).unwrap_err().to_string();
        assert!(words.contains("does not name left_s0"), "{words}");
    }

    #[test]
    fn both_definitions_have_their_published_digest() {
        assert_eq!(moveit_msgs::GetCartesianPath::md5sum(), "c54b9430d97ea6816e0f7c7ffd3779b8");
        assert_eq!(moveit_msgs_melodic::GetCartesianPath::md5sum(), "5c9a54219f0d91a804e7670bc0e118f1");
    }

    #[test]
    fn without_a_master_the_refusal_names_the_service_and_what_to_do() {
        let planner = MoveItPlanner::at("http://127.0.0.1:9/", "/test", RobotModel::baxter().unwrap());
        let start = PerSide { left: JointVector::zeros(), right: JointVector::zeros() };
        let words = planner.ways(&start, &PerSide::default()).unwrap_err().to_string();
        assert!(words.contains(SERVICE) && words.contains("built_in"), "{words}");
    }
}
