//! What an operator is told of an input that holds the robot.

use super::super::{Reaction, Verdict};
use crate::body::Side;
use crate::sensing::Freshness;
use crate::time::Stamp;

/// What is said of a master that is lost.
pub(super) const MASTER_LOST: &str = "the ROS master does not answer: start roscore again, then continue";

pub(super) fn foreign_words(topic: &str, node: &str) -> String {
    format!("{node} publishes on {topic}, where only valet may: end it, then continue")
}

pub(super) fn collision_words(side: Side) -> String {
    format!("the robot felt a contact on its {side} arm; by itself it would go on after two seconds")
}

pub(super) fn cuff_words(side: Side) -> String {
    format!("the {side} arm's cuff is squeezed, the arm follows a hand: let go of it, then continue")
}

/// A hold where a stream is not fresh.
pub(super) fn late(name: &str, stream: &Freshness, now: Stamp) -> Verdict {
    if stream.is_fresh(now) {
        return Verdict::clear();
    }
    let deadline = stream.settings().deadline.as_millis();
    let cause = match (stream.last(), stream.age(now)) {
        (None, _) => format!("{name}: nothing has come in"),
        (_, None) => format!("{name}: the clock went back"),
        _ if stream.is_ahead() => format!("{name}: its time stamps jumped ahead: check the robot's time service"),
        (_, Some(age)) => {
            let age = age.as_secs_f64() + stream.delay();
            format!("{name}: {:.0} ms old, more than {deadline} ms", age * 1000.0)
        }
    };
    Verdict::new(Reaction::Hold, cause)
}
