//! What was asked of the robot's switch, until its state shows it.
//!
//! A single message may be lost, as before the robot has connected to the topic: so it is sent again until the robot has
//! followed, as the maker's own tools do, and given up with a word to the operator after their time. A stop ends it at once;
//! the stop's own repetition is elsewhere.

use super::{Effect, Supervisor};
use crate::assembly::{RedButton, RobotState, SwitchRequest};
use crate::snapshot::Level;
use crate::time::Stamp;
use std::time::Duration;

/// How often it is sent again: seldom enough that a robot which answers at once is asked once.
const REPEAT: Duration = Duration::from_millis(250);
/// How long a robot may take: the maker's tool gives up after 2 s for Enable and 5 s for Disable and Reset, and homing takes longer.
const GIVE_UP: Duration = Duration::from_secs(5);
/// When the operator is told that a robot has not followed: the maker's tool gives up as soon.
const ENABLE_WITHIN: Duration = Duration::from_secs(2);
const RESET_WITHIN: Duration = Duration::from_secs(3);

/// One request that the robot has not followed yet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Asked {
    request: SwitchRequest,
    at: Stamp,
    sent: Stamp,
    told: bool,
}

/// What becomes of a request now.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fate {
    Followed,
    /// Not to be asked for any more: the robot is stopped, and enabling it would be nobody's wish.
    Void,
    Waits,
}

impl Asked {
    /// A request that was just sent; a stop is repeated by its own rules and none of these.
    pub(super) fn new(now: Stamp, request: SwitchRequest) -> Option<Self> {
        (request != SwitchRequest::Stop).then_some(Self { request, at: now, sent: now, told: false })
    }

    /// The span after which the operator is told what to look at.
    const fn within(&self) -> Duration {
        match self.request {
            SwitchRequest::Enable => ENABLE_WITHIN,
            SwitchRequest::Reset | SwitchRequest::Stop => RESET_WITHIN,
            SwitchRequest::Disable => GIVE_UP,
        }
    }

    fn fate(&self, robot: Option<&RobotState>) -> Fate {
        let Some(robot) = robot else { return Fate::Waits };
        let is_stopped = robot.stopped || robot.error || robot.button == RedButton::Pressed;
        match self.request {
            SwitchRequest::Enable if robot.enabled => Fate::Followed,
            SwitchRequest::Enable if is_stopped => Fate::Void,
            SwitchRequest::Disable if !robot.enabled => Fate::Followed,
            SwitchRequest::Reset if !robot.stopped && !robot.error => Fate::Followed,
            SwitchRequest::Reset if robot.button == RedButton::Pressed => Fate::Void,
            _ => Fate::Waits,
        }
    }
}

impl Supervisor {
    /// Tells the operator once what to look at where the robot takes longer than it should.
    fn tell_late(&mut self, now: Stamp, asked: Asked) -> Asked {
        if asked.told || now.since(asked.at) <= asked.within() {
            return asked;
        }
        self.log(now, Level::Warning, "switch", late(asked.request).to_owned());
        let asked = Asked { told: true, ..asked };
        self.asked = Some(asked);
        asked
    }

    /// Sends again what the robot has not followed, or gives it up.
    pub(super) fn follow_switch(&mut self, now: Stamp) {
        let Some(asked) = self.asked else { return };
        // A robot that is not heard may be in any state: nothing is sent into it, and the time runs on.
        let robot = self.protection.robot(now).copied();
        let fate = asked.fate(robot.as_ref());
        let asked = if robot.is_some() && fate == Fate::Waits { self.tell_late(now, asked) } else { asked };
        match fate {
            Fate::Followed | Fate::Void => self.asked = None,
            Fate::Waits if now.since(asked.at) > GIVE_UP => {
                self.asked = None;
                self.log(now, Level::Error, "switch", unanswered(asked.request));
            }
            Fate::Waits if robot.is_some() && now.since(asked.sent) >= REPEAT => {
                self.asked = Some(Asked { sent: now, ..asked });
                self.protection.watchdogs_mut().own_switching(now);
                self.effects.push(Effect::Switch(asked.request));
            }
            Fate::Waits => {}
        }
    }
}

/// What to look at where the robot does not follow. A robot whose stop circuit is open may report nothing at all.
const fn late(request: SwitchRequest) -> &'static str {
    match request {
        SwitchRequest::Enable => {
            "the motors do not come on, and the robot says nothing of a reason: check the red button and its cable"
        }
        SwitchRequest::Reset => "the robot does not answer the reset: look at its red button and its diagnostics",
        SwitchRequest::Disable | SwitchRequest::Stop => {
            "the robot does not switch its motors off: press the red button"
        }
    }
}

fn unanswered(request: SwitchRequest) -> String {
    let (word, topic) = match request {
        SwitchRequest::Enable => ("enabled", "enable"),
        SwitchRequest::Disable => ("disabled", "enable"),
        SwitchRequest::Reset => ("reset", "reset"),
        SwitchRequest::Stop => ("stopped", "stop"),
    };
    format!(
        "the robot was not {word} within {} s: see with `rostopic info /robot/set_super_{topic}` whether it listens, look at \
         its red button and its diagnostics, then ask again",
        GIVE_UP.as_secs()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::{Command, Origin};
    use crate::kinematics::RobotModel;
    use crate::supervisor::{Input, Setup};

    const BEAT: Duration = Duration::from_millis(10);
    const DISABLED: RobotState = RobotState {
        stamp: Stamp::ZERO,
        ready: Some(false),
        enabled: false,
        stopped: false,
        error: false,
        button: RedButton::Unpressed,
        source: crate::assembly::StopSource::None,
    };

    struct Bench {
        supervisor: Supervisor,
        now: Stamp,
    }

    impl Bench {
        fn new() -> Self {
            let supervisor = Supervisor::new(Setup::default(), RobotModel::baxter().unwrap()).unwrap();
            let mut bench = Self { supervisor, now: Stamp::from_nanoseconds(1_000_000_000) };
            bench.pass(50, Some(DISABLED));
            bench
        }

        /// Beats with a robot that says this of itself; what was asked of its switch, and the errors in the log.
        fn pass(&mut self, beats: usize, robot: Option<RobotState>) -> (Vec<SwitchRequest>, Vec<String>) {
            self.pass_at(Level::Error, beats, robot)
        }

        /// The same with the lines of any level.
        fn pass_at(
            &mut self,
            wanted: Level,
            beats: usize,
            robot: Option<RobotState>,
        ) -> (Vec<SwitchRequest>, Vec<String>) {
            let (mut asked, mut errors) = (Vec::new(), Vec::new());
            for _ in 0..beats {
                self.now = self.now + BEAT;
                let state = robot.map(|state| Input::Robot(RobotState { stamp: self.now, ..state }));
                for effect in
                    state.into_iter().chain([Input::Tick]).flat_map(|input| self.supervisor.step(self.now, &input))
                {
                    match effect {
                        Effect::Switch(request) => asked.push(request),
                        Effect::Log { level, text } if level == wanted => errors.push(text),
                        _ => {}
                    }
                }
            }
            (asked, errors)
        }

        fn ask(&mut self, command: Command) {
            let input = Input::Operator { command, origin: Origin::OperatorKey };
            let effects = self.supervisor.step(self.now, &input);
            assert!(effects.iter().any(|effect| matches!(effect, Effect::Receipt(receipt) if receipt.is_accepted())));
        }
    }

    #[test]
    fn a_robot_that_follows_at_once_is_asked_once() {
        let mut bench = Bench::new();
        bench.ask(Command::Enable);
        let (asked, _) = bench.pass(5, Some(DISABLED));
        assert_eq!(asked, []);
        let (asked, errors) = bench.pass(800, Some(RobotState { enabled: true, ready: Some(true), ..DISABLED }));
        assert_eq!((asked.len(), errors.len()), (0, 0));
    }

    #[test]
    fn an_enable_that_was_lost_is_sent_again_until_the_robot_follows() {
        let mut bench = Bench::new();
        bench.ask(Command::Enable);
        let (asked, errors) = bench.pass(200, Some(DISABLED));
        assert!(asked.len() >= 6 && asked.iter().all(|request| *request == SwitchRequest::Enable), "{asked:?}");
        assert!(errors.is_empty(), "{errors:?}");
        let on = RobotState { enabled: true, ready: Some(true), ..DISABLED };
        assert_eq!(bench.pass(100, Some(on)).0, []);
        assert_eq!(
            bench.pass(100, Some(DISABLED)).0,
            [],
            "an enable is not taken up again when the robot is disabled later"
        );
    }

    #[test]
    fn a_robot_that_never_follows_is_told_to_the_operator_and_asked_no_more() {
        let mut bench = Bench::new();
        bench.ask(Command::Enable);
        let (_, errors) = bench.pass(600, Some(DISABLED));
        assert_eq!(errors.len(), 1, "{errors:?}");
        assert!(
            errors.iter().all(|text| text.contains("was not enabled within 5 s") && text.contains("set_super_enable"))
        );
        assert_eq!(bench.pass(200, Some(DISABLED)).0, []);
    }

    #[test]
    fn s_09_motors_that_do_not_come_on_within_2_s_point_to_the_button_and_its_cable() {
        let mut bench = Bench::new();
        bench.ask(Command::Enable);
        let cable = |told: &[String]| told.iter().filter(|text| text.contains("cable")).count();
        assert_eq!(cable(&bench.pass_at(Level::Warning, 199, Some(DISABLED)).1), 0);
        assert_eq!(cable(&bench.pass_at(Level::Warning, 250, Some(DISABLED)).1), 1, "told once");
    }

    #[test]
    fn s_09_a_stop_that_the_robot_does_not_confirm_within_3_s_points_to_the_red_button() {
        let mut bench = Bench::new();
        bench.ask(Command::Stop);
        let running = RobotState { enabled: true, ready: Some(true), ..DISABLED };
        assert_eq!(bench.pass(300, Some(running)).1, Vec::<String>::new());
        let (asked, told) = bench.pass(200, Some(running));
        assert!(matches!(told.as_slice(), [text] if text.contains("red button")), "{told:?}");
        assert_eq!(asked.len(), 200, "and it is asked for at every beat all the while");
    }

    #[test]
    fn a_stop_ends_an_enable_that_the_robot_has_not_followed() {
        let mut bench = Bench::new();
        bench.ask(Command::Enable);
        bench.ask(Command::Stop);
        let (asked, _) = bench.pass(300, Some(DISABLED));
        assert!(asked.iter().all(|request| *request == SwitchRequest::Stop), "{asked:?}");
        let mut bench = Bench::new();
        bench.ask(Command::Enable);
        let (asked, _) = bench.pass(300, Some(RobotState { stopped: true, button: RedButton::Pressed, ..DISABLED }));
        assert!(!asked.contains(&SwitchRequest::Enable), "the robot stopped by itself: {asked:?}");
    }

    #[test]
    fn nothing_is_sent_to_a_robot_that_is_not_heard() {
        let mut bench = Bench::new();
        bench.ask(Command::Enable);
        let (asked, errors) = bench.pass(600, None);
        assert!(asked.len() <= 1, "{asked:?}");
        assert_eq!(errors.len(), 1, "{errors:?}");
    }

    #[test]
    fn a_reset_that_was_lost_is_sent_again() {
        let mut bench = Bench::new();
        let stopped = RobotState { stopped: true, button: RedButton::Unknown, ..DISABLED };
        bench.ask(Command::Stop);
        bench.pass(10, Some(stopped));
        bench.ask(Command::Reset);
        let (asked, _) = bench.pass(100, Some(stopped));
        assert!(asked.len() >= 3 && asked.iter().all(|request| *request == SwitchRequest::Reset), "{asked:?}");
        assert_eq!(bench.pass(100, Some(DISABLED)).0, []);
    }
}
