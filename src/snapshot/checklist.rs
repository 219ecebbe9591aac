//! What an operator looks at before the first trial: master, robot, red button, force, person, recorder, each with what to
//! do where it is not good. Follows from the snapshot alone.

use super::{CheckLine, PoseQuality, Snapshot, Verdict};
use crate::assembly::RedButton;
use crate::body::Side;

fn check(name: &str, verdict: Verdict, value: impl Into<String>, hint: &str, age: Option<f64>) -> CheckLine {
    let hint = if verdict == Verdict::Good { "" } else { hint };
    CheckLine { name: name.to_owned(), verdict, value: value.into(), hint: hint.to_owned(), age }
}

impl Snapshot {
    /// The check-list at the snapshot's own moment.
    #[must_use]
    pub fn check_list(&self) -> Vec<CheckLine> {
        let mut lines = Vec::new();
        if !self.master.uri.is_empty() {
            lines.push(self.check_master());
        }
        lines.push(self.check_robot());
        lines.push(self.check_button());
        lines.extend(Side::BOTH.map(|side| self.check_force(side)));
        lines.extend(Side::BOTH.map(|side| self.check_person(side)));
        lines.push(self.check_recorder());
        lines
    }

    fn check_master(&self) -> CheckLine {
        let verdict = if self.master.connected { Verdict::Good } else { Verdict::Fault };
        check("ROS master", verdict, self.master.uri.as_str(), "start roscore: valet joins again by itself", None)
    }

    fn check_robot(&self) -> CheckLine {
        let age = self.robot.state.map(|state| self.now.since(state.stamp).as_secs_f64());
        let (verdict, value, hint) = match self.robot.fresh(self.now) {
            None if age.is_some() => (Verdict::Stale, "silent", "is the robot on, and the network?"),
            None => (Verdict::Fault, "never heard", "is the robot on? is /robot/state published?"),
            Some(robot) if robot.error => (Verdict::Fault, "reports a fault", "see the robot's own log"),
            Some(robot) if robot.stopped => (Verdict::Fault, "stopped", "find the cause, then reset"),
            Some(robot) if !robot.enabled => (Verdict::Late, "disabled", "enable it"),
            Some(robot) if robot.ready == Some(false) => (Verdict::Late, "not homed", "home it first"),
            Some(_) => (Verdict::Good, "enabled", ""),
        };
        check("robot", verdict, value, hint, age)
    }

    fn check_button(&self) -> CheckLine {
        let (verdict, value) = match self.robot.fresh(self.now).map(|robot| robot.button) {
            Some(RedButton::Unpressed) => (Verdict::Good, "not pressed"),
            Some(RedButton::Pressed) => (Verdict::Fault, "pressed"),
            Some(RedButton::Released) => (Verdict::Fault, "released, its stop is still latched"),
            Some(RedButton::Unknown) | None => (Verdict::Late, "not known"),
        };
        check("red button", verdict, value, "turn it to release it, then reset; keep it within reach", None)
    }

    fn check_force(&self, side: Side) -> CheckLine {
        let force = &self.sides.get(side).force;
        let age = force.freshness.age(self.now);
        let name = format!("{side} force");
        match force.fresh_sample(self.now) {
            Some(sample) => check(&name, Verdict::Good, format!("{:.1} N", sample.magnitude()), "", age),
            None if age.is_some() => check(&name, Verdict::Stale, "silent", "is the robot's network up?", age),
            None => {
                let hint = "is the endpoint_state of this arm published?";
                check(&name, Verdict::Fault, "never heard", hint, None)
            }
        }
    }

    fn check_person(&self, side: Side) -> CheckLine {
        let (verdict, value) = match self.body.quality(side, self.now) {
            PoseQuality::Seen => (Verdict::Good, "seen"),
            PoseQuality::Inferred => (Verdict::Late, "partly concluded, not seen"),
            PoseQuality::Lost => (Verdict::Fault, "not seen"),
        };
        let hint = "clear the camera's view, or ask the person to move a little";
        check(&format!("person's {side} arm"), verdict, value, hint, self.body.freshness.age(self.now))
    }

    fn check_recorder(&self) -> CheckLine {
        let (verdict, value) = match (self.recorder.fault.is_empty(), self.recorder.on) {
            (false, _) => (Verdict::Fault, self.recorder.fault.as_str()),
            (true, true) => (Verdict::Good, "on"),
            (true, false) => (Verdict::Late, "off"),
        };
        check("recorder", verdict, value, "nothing of this trial is kept", None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{RobotState, StopSource};
    use crate::snapshot::Freshness;
    use crate::time::Stamp;

    fn verdict_of(snapshot: &Snapshot, name: &str) -> Verdict {
        snapshot.check_list().into_iter().find(|line| line.name == name).unwrap().verdict
    }

    fn robot(stamp: Stamp) -> RobotState {
        RobotState {
            stamp,
            ready: Some(true),
            enabled: true,
            stopped: false,
            error: false,
            button: RedButton::Unpressed,
            source: StopSource::None,
        }
    }

    #[test]
    fn nothing_heard_is_a_fault_with_something_to_do() {
        let lines = Snapshot::default().check_list();
        assert!(lines.iter().all(|line| line.verdict != Verdict::Good && !line.hint.is_empty()), "{lines:?}");
        assert!(!lines.iter().any(|line| line.name == "ROS master"), "a run without a master needs none");
    }

    #[test]
    fn a_robot_that_was_heard_and_is_silent_is_stale_and_not_enabled() {
        let now = Stamp::from_nanoseconds(5_000_000_000);
        let mut snapshot = Snapshot { now, ..Snapshot::default() };
        snapshot.robot.deadline_seconds = 0.5;
        snapshot.robot.state = Some(robot(now));
        assert_eq!(verdict_of(&snapshot, "robot"), Verdict::Good);
        assert_eq!(verdict_of(&snapshot, "red button"), Verdict::Good);
        snapshot.robot.state = Some(robot(Stamp::from_nanoseconds(1_000_000_000)));
        assert_eq!(verdict_of(&snapshot, "robot"), Verdict::Stale);
        assert_eq!(verdict_of(&snapshot, "red button"), Verdict::Late);
    }

    #[test]
    fn a_stop_names_the_reset_and_a_force_its_age() {
        let now = Stamp::from_nanoseconds(5_000_000_000);
        let mut snapshot = Snapshot { now, ..Snapshot::default() };
        snapshot.robot.deadline_seconds = 0.5;
        snapshot.robot.state = Some(RobotState { stopped: true, ..robot(now) });
        let lines = snapshot.check_list();
        let line = lines.iter().find(|line| line.name == "robot").unwrap();
        assert!(line.hint.contains("reset"), "{line:?}");
        snapshot.sides.left.force.freshness = Freshness { last: Some(Stamp::ZERO), deadline: 0.05 };
        let lines = snapshot.check_list();
        let line = lines.iter().find(|line| line.name == "left force").unwrap();
        assert_eq!((line.verdict, line.age), (Verdict::Stale, Some(5.0)));
    }
}
