//! What is checked of the arms: where their joints are, what the robot says of itself, who else would move them, and who plans.
//! Pure but for the planner's answer, which comes in as a closure.

use super::checks::{Check, Findings};
use crate::body::{PerSide, Side};
use crate::geometry::{Point, Vector};
use crate::kinematics::{JointVector, MotionLimits, RobotModel, Scene, Target, Ways, Workspace, plan_through};
use crate::ros::graph::Graph;
use crate::snapshot::Verdict;

/// A measured joint may be so far outside its range, in radians: the robot's own control error (0.5°).
const JOINT_ERROR: f64 = 0.009;
/// The line that the planner is asked for, in metres: short, and up.
const TRIAL_LINE: f64 = 0.03;

/// What is known of the arms beside what was heard.
pub(super) struct Arms<'a> {
    pub(super) model: &'a RobotModel,
    /// The text of `/robot_description`, where the master has one.
    pub(super) description: Option<&'a str>,
    pub(super) graph: &'a Graph,
}

/// The lines of the list that are about the arms.
pub(super) fn all(findings: &Findings, arms: &Arms) -> Vec<Check> {
    let mut list: Vec<_> = Side::BOTH.into_iter().map(|side| joints(findings, arms.model, side)).collect();
    list.push(description(arms.model, arms.description));
    list.push(trajectory_servers(arms.graph));
    list.push(speed_ratio(arms.graph));
    list
}

fn joints(findings: &Findings, model: &RobotModel, side: Side) -> Check {
    let name = format!("{side} joints");
    let Some(joints) = findings.joints(side) else {
        return Check::new(name, Verdict::Fault, "not all of them were heard", "look at /robot/joint_states");
    };
    let arm = model.arm(side);
    match arm.limits().breach(&joints, JOINT_ERROR) {
        None => Check::new(
            name,
            Verdict::Good,
            format!("{:.0} % from the nearest limit", 100.0 * arm.limits().margin(&joints)),
            "",
        ),
        Some((index, value)) => {
            let (lower, upper) = arm.limits().range(index);
            let joint = arm.joint_names().get(index).cloned().unwrap_or_default();
            let value = format!("{joint} is at {value:.4} rad, outside {lower:.4} to {upper:.4} rad");
            Check::new(name, Verdict::Fault, value, "squeeze the cuff and move the arm back by hand")
        }
    }
}

/// The robot's own description against the one that valet works with.
fn description(model: &RobotModel, text: Option<&str>) -> Check {
    let name = "robot description";
    let Some(text) = text else {
        let hint = "valet works with its own; on a real robot look why /robot_description is not set";
        return Check::new(name, Verdict::Late, "the robot offers none", hint);
    };
    let theirs = match RobotModel::from_urdf(text, PerSide::default()) {
        Ok(theirs) => theirs,
        Err(error) => return Check::new(name, Verdict::Fault, error.to_string(), "valet cannot move this robot"),
    };
    let found: Vec<_> = model.differences(&theirs).iter().map(ToString::to_string).collect();
    match found.as_slice() {
        [] => Check::new(name, Verdict::Good, "limits and tools as valet has them", ""),
        found => Check::new(
            name,
            Verdict::Late,
            found.join("; "),
            "mount the tool that valet is set to, or set the robot's own",
        ),
    }
}

/// Servers that go on commanding an arm after their last goal.
fn trajectory_servers(graph: &Graph) -> Check {
    let servers = graph.publishers.iter().filter(|(topic, _)| topic.ends_with("/follow_joint_trajectory/status"));
    let servers: Vec<_> =
        servers.flat_map(|(topic, nodes)| nodes.iter().map(move |node| format!("{node} on {topic}"))).collect();
    let hint = "end it: it holds the arm at its last goal and fights valet; before SDK 1.2 it lunges when the robot is enabled";
    match servers.as_slice() {
        [] => Check::new("trajectory servers", Verdict::Good, "none", ""),
        servers => Check::new("trajectory servers", Verdict::Fault, servers.join(", "), hint),
    }
}

fn speed_ratio(graph: &Graph) -> Check {
    let setters = graph.publishers.iter().filter(|(topic, _)| topic.ends_with("/set_speed_ratio"));
    let setters: Vec<_> =
        setters.flat_map(|(topic, nodes)| nodes.iter().map(move |node| format!("{node} on {topic}"))).collect();
    match setters.as_slice() {
        [] => Check::new("speed ratio", Verdict::Good, "set by nobody else", ""),
        setters => {
            let hint = "end that node: a changed ratio makes the arms lag behind what valet commands";
            Check::new("speed ratio", Verdict::Late, setters.join(", "), hint)
        }
    }
}

/// Asks a planner for a short line of both arms from where they are, and checks what it answers. Nothing moves.
pub(super) fn planner<E: std::fmt::Display>(
    findings: &Findings,
    model: &RobotModel,
    ask: impl FnOnce(&PerSide<JointVector>, &PerSide<Option<Target>>) -> Result<Ways, E>,
) -> Check {
    let refused =
        |reason: String| Check::new("planner", Verdict::Fault, reason, "start move_group, or use the planner built_in");
    let (Some(left), Some(right)) = (findings.joints(Side::Left), findings.joints(Side::Right)) else {
        return refused("not asked: the joints are not known".into());
    };
    let start = PerSide { left, right };
    let up = |side: Side| {
        let here = Point::from(model.arm(side).forward(start.get(side)).translation.vector);
        Some(Target::position(here + Vector::z() * TRIAL_LINE))
    };
    let targets = PerSide { left: up(Side::Left), right: up(Side::Right) };
    let ways = match ask(&start, &targets) {
        Ok(ways) => ways,
        Err(error) => return refused(error.to_string()),
    };
    match plan_through(model, &Scene::default(), &start, &targets, &ways, &anywhere()) {
        Ok(_) => Check::new("planner", Verdict::Good, "MoveIt plans short lines of both arms from where they are", ""),
        Err(refusal) => refused(refusal.to_string()),
    }
}

/// Before a trial the arms may be anywhere, and no garment hangs between them.
fn anywhere() -> MotionLimits {
    let corner = |metres: f64| Point::new(metres, metres, metres);
    MotionLimits {
        minimum_gripper_distance: 0.0,
        maximum_gripper_distance: 10.0,
        workspace: Workspace { lower: corner(-5.0), upper: corner(5.0) },
        ..MotionLimits::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::{BAXTER_URDF, Tool};
    use crate::supervisor::{Input, JointSample};
    use crate::time::Stamp;

    fn heard(joints: [f64; 7]) -> Findings {
        let mut findings = Findings::default();
        let positions = PerSide::from_fn(|_| joints.map(Some));
        findings.take(&Input::Joints(JointSample { stamp: Stamp::ZERO, positions }), Stamp::ZERO);
        findings
    }

    /// `move_to_neutral` of the maker's programs.
    const NEUTRAL: [f64; 7] = [0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0];

    #[test]
    fn joints_that_are_missing_or_outside_their_range_are_a_fault() {
        let model = RobotModel::baxter().unwrap();
        assert_eq!(joints(&heard(NEUTRAL), &model, Side::Left).verdict, Verdict::Good);
        assert_eq!(joints(&Findings::default(), &model, Side::Left).verdict, Verdict::Fault);
        let mut far = NEUTRAL;
        far[3] = 2.7;
        let check = joints(&heard(far), &model, Side::Right);
        assert!(check.verdict == Verdict::Fault && check.line().contains("right_e1 is at 2.7000"), "{}", check.line());
        far[3] = f64::NAN;
        assert_eq!(joints(&heard(far), &model, Side::Right).verdict, Verdict::Fault);
    }

    #[test]
    fn another_description_is_told_with_what_differs() {
        let model = RobotModel::baxter().unwrap();
        assert_eq!(description(&model, Some(BAXTER_URDF)).verdict, Verdict::Good);
        assert_eq!(description(&model, None).verdict, Verdict::Late);
        assert_eq!(description(&model, Some("<robot name='x'/>")).verdict, Verdict::Fault);
        let tools = PerSide { left: Tool::ElectricExtended, right: Tool::AsDescribed };
        let other = RobotModel::from_urdf(BAXTER_URDF, tools).unwrap();
        let check = description(&other, Some(BAXTER_URDF));
        assert!(check.verdict == Verdict::Late && check.line().contains("left gripper's tip"), "{}", check.line());
    }

    #[test]
    fn a_trajectory_server_and_a_setter_of_the_speed_are_named() {
        let publish = |topic: &str, node: &str| (topic.to_owned(), vec![node.to_owned()]);
        let graph = Graph {
            publishers: [
                publish(
                    "/robot/limb/left/follow_joint_trajectory/status",
                    "/rsdk_position_joint_trajectory_action_server",
                ),
                publish("/robot/limb/right/set_speed_ratio", "/hurry"),
            ]
            .into(),
            ..Graph::default()
        };
        assert!(trajectory_servers(&graph).line().contains("/rsdk_position"));
        assert!(speed_ratio(&graph).line().contains("/hurry"));
        assert_eq!(trajectory_servers(&Graph::default()).verdict, Verdict::Good);
    }

    #[test]
    fn what_a_planner_answers_is_checked() {
        let model = RobotModel::baxter().unwrap();
        let refused = planner(&heard(NEUTRAL), &model, |_, _| Err("MoveIt is not there"));
        assert!(refused.verdict == Verdict::Fault && refused.line().contains("not there"));
        let lazy =
            planner::<String>(&heard(NEUTRAL), &model, |start, _| Ok(start.map(|_, joints| Some(vec![*joints]))));
        assert!(lazy.verdict == Verdict::Fault && lazy.line().contains("ends 0.03"), "{}", lazy.line());
        let good = planner::<String>(&heard(NEUTRAL), &model, |start, targets| {
            Ok(PerSide::from_fn(|side| {
                let (arm, mut joints) = (model.arm(side), *start.get(side));
                let here = arm.forward(&joints);
                let to = targets.get(side).as_ref()?.position.coords;
                (0..=10)
                    .map(|index| {
                        let mut pose = here;
                        pose.translation.vector = here.translation.vector.lerp(&to, f64::from(index) / 10.0);
                        joints = arm.inverse(&pose, &joints).ok()?;
                        Some(joints)
                    })
                    .collect()
            }))
        });
        assert_eq!(good.verdict, Verdict::Good, "{}", good.line());
    }
}
