//! What news of the connection to the robot means: hold, stop, or a line in the log. Coming back never moves anything.

use super::{LinkEvent, Mode, Supervisor};
use crate::snapshot::{Level, Outcome};
use crate::time::Stamp;

impl Supervisor {
    pub(super) fn see_link(&mut self, now: Stamp, event: &LinkEvent) {
        match event {
            LinkEvent::MasterLost => {
                self.protection.watchdogs_mut().master(false);
                self.hold_or_warn(now, "the ROS master does not answer: start roscore again, then continue");
            }
            LinkEvent::MasterBack => {
                self.protection.watchdogs_mut().master(true);
                self.log(now, Level::Information, "link", "the ROS master answers".into());
            }
            LinkEvent::ForeignPublisher { topic, node } => {
                self.protection.watchdogs_mut().foreign_publisher(topic, node);
                self.hold_or_warn(now, &format!("{node} publishes on {topic}: end it, then continue"));
            }
            LinkEvent::ForeignPublisherGone { topic, node } => {
                self.protection.watchdogs_mut().foreign_publisher_gone(topic, node);
                self.log(now, Level::Information, "link", format!("{node} publishes on {topic} no more"));
            }
            LinkEvent::WrongDefinition { topic, node, found, wanted } => {
                let text = format!(
                    "{node} publishes {topic} as {found}, valet reads {wanted}: nothing of it is used; bring the message packages of both to one version"
                );
                self.log(now, Level::Error, "link", text);
            }
            LinkEvent::CannotSee { reason } => {
                self.log(now, Level::Warning, "pose", format!("no pose of the person: {reason}"));
            }
            LinkEvent::WorkerLost { name } => {
                self.stop(now, &format!("the part of valet called {name} died"), Outcome::Fault);
            }
            LinkEvent::InboxOverflow { lost } => {
                self.view.dropped_samples += lost;
                self.log(
                    now,
                    Level::Warning,
                    "link",
                    format!("{lost} messages were lost: this computer is overloaded"),
                );
            }
            LinkEvent::RecorderFailed { reason } => {
                self.log(now, Level::Error, "recorder", format!("nothing is recorded any more: {reason}"));
                self.hold(now, &format!("the trial is not recorded any more: {reason}"));
            }
            LinkEvent::RecorderOverflow { lost } => {
                let text = format!("{lost} steps are missing in the record: this computer or its disk is overloaded");
                self.log(now, Level::Warning, "recorder", text);
            }
            LinkEvent::ConsoleBeat => self.protection.watchdogs_mut().console(now),
            LinkEvent::ConsoleLost => self.hold(now, "the console is gone"),
        }
        self.show_link(event);
    }

    /// As [`Self::hold`]; where nothing moves that could be held, the operator is told all the same.
    fn hold_or_warn(&mut self, now: Stamp, cause: &str) {
        if self.mode == Mode::Running {
            self.hold(now, cause);
        } else {
            self.log(now, Level::Warning, "link", cause.to_owned());
        }
    }
}
