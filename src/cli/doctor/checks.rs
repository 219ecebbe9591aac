//! What is checked before a trial, and what to do where it is not good. Pure: findings in, lines out.

use crate::assembly::{RedButton, RobotState};
use crate::body::{PerSide, Side};
use crate::kinematics::JointVector;
use crate::ros::TopicReport;
use crate::ros::graph::Graph;
use crate::snapshot::Verdict;
use crate::supervisor::Input;
use crate::time::Stamp;
use serde::Serialize;

/// Robot and this computer may differ by so much, in seconds: two messages of 100 Hz.
const CLOCK_OFFSET: f64 = 0.02;
/// The robot's own nodes that may enable it and hold its safety behaviours.
const ROBOTS_OWN: [&str; 3] = ["/rcloader_left", "/rcloader_right", "/realtime_loop"];

/// One line of the list.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Check {
    event: &'static str,
    name: String,
    pub(super) verdict: Verdict,
    value: String,
    age_seconds: Option<f64>,
    hint: String,
}

impl Check {
    pub(super) fn new(name: impl Into<String>, verdict: Verdict, value: impl Into<String>, hint: &str) -> Self {
        let hint = if verdict == Verdict::Good { String::new() } else { hint.to_owned() };
        Self { event: "check", name: name.into(), verdict, value: value.into(), age_seconds: None, hint }
    }

    fn aged(mut self, seconds: Option<f64>) -> Self {
        self.age_seconds = seconds;
        self
    }

    /// The line for people.
    pub(super) fn line(&self) -> String {
        let word = match self.verdict {
            Verdict::Good => "good ",
            Verdict::Late => "look ",
            Verdict::Stale => "stale",
            Verdict::Fault => "FAULT",
        };
        let age = self.age_seconds.map_or_else(|| "      ".into(), |age| format!("{age:5.2}s"));
        let hint = if self.hint.is_empty() { String::new() } else { format!("  -> {}", self.hint) };
        format!("{word} {age} {}: {}{hint}", self.name, self.value)
    }
}

/// What was heard.
#[derive(Clone, Debug, Default)]
pub(super) struct Findings {
    robot: Option<RobotState>,
    clock_offset: Option<f64>,
    body: Option<Stamp>,
    colliding: PerSide<bool>,
    joints: PerSide<[Option<f64>; 7]>,
}

impl Findings {
    /// Takes in what the robot says; `arrival` is this computer's time.
    pub(super) fn take(&mut self, input: &Input, arrival: Stamp) {
        match input {
            Input::Robot(state) => self.robot = Some(*state),
            Input::Endpoint(sample) => {
                let offset = sample.stamp.seconds() - arrival.seconds();
                // The message that came quickest tells the clocks' difference best.
                let better = self.clock_offset.is_none_or(|known| offset > known);
                self.clock_offset = if better { Some(offset) } else { self.clock_offset };
            }
            Input::Joints(sample) => {
                for (side, positions) in sample.positions.iter() {
                    for (known, position) in self.joints.get_mut(side).iter_mut().zip(positions) {
                        *known = position.or(*known);
                    }
                }
            }
            Input::Body(pose) => self.body = Some(pose.stamp),
            Input::Collision { side, active } => *self.colliding.get_mut(*side) = *active,
            _ => {}
        }
    }
}

impl Findings {
    /// All joints of an arm, radians, where all were heard.
    pub(super) fn joints(&self, side: Side) -> Option<JointVector> {
        let known: Option<Vec<f64>> = self.joints.get(side).iter().copied().collect();
        known.map(|known| JointVector::from_column_slice(&known))
    }
}

/// The list, but for the arms.
pub(super) fn all(
    findings: &Findings,
    topics: &[TopicReport],
    graph: &Graph,
    master: &str,
    address: Option<&str>,
    now: Stamp,
) -> Vec<Check> {
    let mut list = vec![Check::new("ROS master", Verdict::Good, format!("answers at {master}"), "")];
    list.push(match address {
        Some(address) => Check::new("own address", Verdict::Good, address, ""),
        None => Check::new(
            "own address",
            Verdict::Late,
            "neither ROS_IP nor ROS_HOSTNAME is set",
            "set ROS_IP to the address under which the robot reaches this computer",
        ),
    });
    list.extend(topics.iter().map(topic));
    list.push(robot(findings.robot.as_ref(), now));
    list.push(clocks(findings.clock_offset));
    for (side, colliding) in findings.colliding.iter() {
        list.push(contact(side, *colliding));
    }
    list.push(person(findings.body, now));
    list.push(nobody_else(
        graph,
        "other nodes that command the robot",
        is_command,
        "end that node: two that command one arm fight each other",
    ));
    list.push(nobody_else(
        graph,
        "suppressed safety behaviours",
        is_suppression,
        "end that node: the robot's own safety is switched off while it runs",
    ));
    list.push(stop_listener(graph));
    list
}

fn topic(report: &TopicReport) -> Check {
    let (least, most) = report.expected_hertz;
    let value = format!(
        "{:.0} Hz from {}",
        report.hertz,
        if report.publishers.is_empty() { "nobody".into() } else { report.publishers.join(" ") }
    );
    if let Some((node, found)) = report.wrong.first() {
        let hint = "bring the message packages of both to one version: `rosmsg md5` tells the digest";
        return Check::new(
            &report.topic,
            Verdict::Fault,
            format!("{node} publishes {found}, which valet cannot read"),
            hint,
        )
        .aged(report.age_seconds);
    }
    let is_rated = (least..=most).contains(&report.hertz);
    let (verdict, hint) = match (report.age_seconds, report.required) {
        (None, true) => {
            (Verdict::Fault, "never heard: is the robot on, is ROS_IP right, do the message versions agree?")
        }
        (Some(age), _) if age > 0.5 && least > 0.0 => {
            (Verdict::Stale, "no longer comes: look at the node that publishes it")
        }
        (Some(_), _) if !is_rated => {
            (Verdict::Late, "comes at another rate than expected: look at the network and the robot's load")
        }
        // What is not needed and not there is no fault.
        (None, false) | (Some(_), _) => (Verdict::Good, ""),
    };
    Check::new(&report.topic, verdict, value, hint).aged(report.age_seconds)
}

fn robot(state: Option<&RobotState>, now: Stamp) -> Check {
    let Some(state) = state else {
        return Check::new(
            "robot state",
            Verdict::Fault,
            "never heard",
            "is the robot on, and can it reach this computer's ROS_IP?",
        );
    };
    let age = Some(now.since(state.stamp).as_secs_f64());
    let (verdict, value, hint) = if state.button == RedButton::Pressed {
        (
            Verdict::Fault,
            "the red button is pressed, or its cable is loose",
            "release the button, then Reset and Enable",
        )
    } else if state.stopped {
        (Verdict::Fault, "stopped", "Reset, then Enable")
    } else if state.error {
        (Verdict::Fault, "reports an error", "look at /diagnostics; Reset")
    } else if state.enabled {
        (Verdict::Good, "enabled", "")
    } else {
        (Verdict::Good, "disabled, ready to be enabled", "")
    };
    Check::new("robot state", verdict, value, hint).aged(age)
}

fn clocks(offset: Option<f64>) -> Check {
    let hint = "set both clocks by one NTP server; large offsets are mended only at the robot's boot";
    match offset {
        None => Check::new("clocks", Verdict::Fault, "not known: no stamped message came", "see the topics above"),
        Some(offset) if offset.abs() <= CLOCK_OFFSET => {
            Check::new("clocks", Verdict::Good, format!("{:+.1} ms apart", offset * 1e3), "")
        }
        Some(offset) => Check::new("clocks", Verdict::Late, format!("{:+.1} ms apart", offset * 1e3), hint),
    }
}

fn contact(side: Side, colliding: bool) -> Check {
    let verdict = if colliding { Verdict::Fault } else { Verdict::Good };
    let value = if colliding { "the robot feels a contact" } else { "none" };
    Check::new(format!("{side} contact"), verdict, value, "free the arm; the robot goes on by itself after 2 s")
}

fn person(last: Option<Stamp>, now: Stamp) -> Check {
    match last {
        None => Check::new(
            "person's pose",
            Verdict::Late,
            "never seen",
            "start the camera or the tracker, and let the person sit before it",
        ),
        Some(stamp) => {
            let age = now.since(stamp).as_secs_f64();
            let verdict = if age > 0.5 { Verdict::Stale } else { Verdict::Good };
            Check::new("person's pose", verdict, "seen", "the person is out of sight of the camera").aged(Some(age))
        }
    }
}

fn is_command(topic: &str) -> bool {
    topic.starts_with("/robot/set_super_") || (topic.starts_with("/robot/limb/") && topic.ends_with("/joint_command"))
}

fn is_suppression(topic: &str) -> bool {
    topic.starts_with("/robot/limb/") && topic.rsplit('/').next().is_some_and(|last| last.starts_with("suppress_"))
}

fn nobody_else(graph: &Graph, name: &str, matters: fn(&str) -> bool, hint: &str) -> Check {
    let others = graph.publishers.iter().filter(|(topic, _)| matters(topic)).flat_map(|(topic, nodes)| {
        let foreign = nodes.iter().filter(|node| !ROBOTS_OWN.contains(&node.as_str()));
        foreign.map(move |node| format!("{node} on {topic}"))
    });
    let others: Vec<_> = others.collect();
    let verdict = if others.is_empty() { Verdict::Good } else { Verdict::Late };
    Check::new(name, verdict, if others.is_empty() { "none".to_owned() } else { others.join(", ") }, hint)
}

fn stop_listener(graph: &Graph) -> Check {
    let listeners = graph.subscribers_of("/robot/set_super_stop");
    let verdict = if listeners.is_empty() { Verdict::Fault } else { Verdict::Good };
    let value = if listeners.is_empty() { "nobody listens".to_owned() } else { listeners.join(" ") };
    Check::new(
        "software stop reaches",
        verdict,
        value,
        "a stop by software would reach nobody: only the red button is left",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(state: RobotState) -> Verdict {
        robot(Some(&state), Stamp::ZERO).verdict
    }

    #[test]
    fn a_robot_that_cannot_start_is_a_fault_with_what_to_do() {
        assert_eq!(heard(RobotState::default()), Verdict::Good);
        for state in [
            RobotState { stopped: true, ..RobotState::default() },
            RobotState { error: true, ..RobotState::default() },
            RobotState { button: RedButton::Pressed, ..RobotState::default() },
        ] {
            assert_eq!(heard(state), Verdict::Fault);
            assert!(!robot(Some(&state), Stamp::ZERO).hint.is_empty());
        }
    }

    #[test]
    fn who_else_commands_or_suppresses_is_named_and_the_robots_own_nodes_are_not() {
        let publish = |topic: &str, node: &str| (topic.to_owned(), vec![node.to_owned()]);
        let graph = Graph {
            publishers: [
                publish("/robot/set_super_enable", "/rcloader_left"),
                publish("/robot/limb/left/joint_command", "/tuck_arms"),
                publish("/robot/limb/left/suppress_contact_safety", "/careless"),
            ]
            .into(),
            ..Graph::default()
        };
        let list = all(&Findings::default(), &[], &graph, "http://m:1/", None, Stamp::ZERO);
        let text = list.iter().map(Check::line).collect::<Vec<_>>().join("\n");
        assert!(
            text.contains("/tuck_arms on") && text.contains("/careless on") && !text.contains("rcloader"),
            "{text}"
        );
        assert!(text.contains("FAULT        software stop reaches: nobody listens"), "{text}");
    }

    #[test]
    fn a_topic_is_judged_by_age_rate_and_need() {
        let report = |age_seconds, hertz, required| TopicReport {
            topic: "/t".into(),
            kind: "k".into(),
            newest: None,
            age_seconds,
            hertz,
            expected_hertz: (80.0, 120.0),
            gap_seconds: 0.0,
            jitter_seconds: 0.0,
            stamp_lag_seconds: None,
            unusable: 0,
            publishers: vec![],
            wrong: vec![],
            required,
        };
        assert_eq!(topic(&report(Some(0.01), 100.0, true)).verdict, Verdict::Good);
        assert_eq!(topic(&report(Some(0.01), 30.0, true)).verdict, Verdict::Late);
        assert_eq!(topic(&report(Some(2.0), 0.0, true)).verdict, Verdict::Stale);
        assert_eq!(topic(&report(None, 0.0, true)).verdict, Verdict::Fault);
        assert_eq!(topic(&report(None, 0.0, false)).verdict, Verdict::Good);
        let wrong = vec![("/old_robot".to_owned(), "k (md5 1)".to_owned())];
        let line = topic(&TopicReport { wrong, ..report(None, 0.0, false) }).line();
        assert!(line.starts_with("FAULT") && line.contains("/old_robot publishes k (md5 1)"), "{line}");
    }

    #[test]
    fn clocks_that_differ_are_told_with_their_offset() {
        assert_eq!(clocks(Some(0.001)).verdict, Verdict::Good);
        let far = clocks(Some(-8.0));
        assert!(far.verdict == Verdict::Late && far.value.starts_with("-8000.0 ms"), "{}", far.value);
    }
}
