//! What can go wrong between this node and the ROS graph, in words an operator can act on.

use thiserror::Error;

/// Why something of ROS does not work.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RosError {
    /// No master answers.
    #[error(
        "no ROS master answers at {uri} ({reason}): start roscore, switch the robot on, or correct ROS_MASTER_URI; \
         `valet sim --master embedded` brings a master along"
    )]
    NoMaster {
        /// Where it was looked for.
        uri: String,
        /// What was found there.
        reason: String,
    },
    /// The node could not be made.
    #[error("the ROS node {name} cannot start: {reason}")]
    Node {
        /// Its name.
        name: String,
        /// Why.
        reason: String,
    },
    /// A topic or service could not be registered.
    #[error("{name} cannot be registered with the ROS master: {reason}")]
    Registration {
        /// The topic or service.
        name: String,
        /// Why.
        reason: String,
    },
    /// The embedded master cannot start.
    #[error(
        "the embedded ROS master cannot listen on {address} ({reason}): is another master running there? Choose another --port"
    )]
    MasterAddress {
        /// Where it should listen.
        address: String,
        /// Why it cannot.
        reason: String,
    },
    /// The system has no thread to give.
    #[error("cannot start a thread for {what}: {reason}")]
    Thread {
        /// What for.
        what: String,
        /// Why.
        reason: String,
    },
}

impl RosError {
    pub(super) fn registration(name: &str, reason: impl std::fmt::Display) -> Self {
        Self::Registration { name: name.to_owned(), reason: reason.to_string() }
    }

    pub(super) fn thread(what: &str, reason: impl std::fmt::Display) -> Self {
        Self::Thread { what: what.to_owned(), reason: reason.to_string() }
    }
}
