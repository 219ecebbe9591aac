//! Ears and a voice for measurements: when a stop is published, a force that calls for one, and how long an empty message
//! takes over loopback by itself.

use super::encode;
use super::error::RosError;
use super::link::advertise;
use super::message::{baxter_core_msgs, std_msgs};
use super::monitor::now;
use crate::body::Side;
use crate::geometry::{Pose, Vector, Wrench};
use crate::supervisor::EndpointSample;
use crossbeam_channel::{Receiver, bounded};
use rosrust::{Publisher, Subscriber};
use std::thread;
use std::time::{Duration, Instant};

/// The topic of the messages that measure the way itself.
const PING: &str = "~ping";

/// How often it is looked whether somebody listens.
const LOOK: Duration = Duration::from_millis(10);

fn listen(topic: &str) -> Result<(Subscriber, Receiver<Instant>), RosError> {
    let (sender, heard) = bounded(64);
    let subscriber = rosrust::subscribe(topic, 1, move |_: std_msgs::Empty| {
        // Where nobody takes them, later moments are of no use either.
        let _ = sender.try_send(Instant::now());
    })
    .map_err(|error| RosError::registration(topic, error))?;
    Ok((subscriber, heard))
}

/// Hears the software stop, whoever sends it.
pub struct StopEar {
    heard: Receiver<Instant>,
    _subscriber: Subscriber,
}

impl std::fmt::Debug for StopEar {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("StopEar")
    }
}

impl StopEar {
    /// Listens from now on.
    ///
    /// # Errors
    /// Where the master does not register it.
    pub fn listen() -> Result<Self, RosError> {
        let (subscriber, heard) = listen("/robot/set_super_stop")?;
        Ok(Self { heard, _subscriber: subscriber })
    }

    /// Forgets what was heard so far.
    pub fn forget(&self) {
        self.heard.try_iter().for_each(drop);
    }

    /// When the next stop came in; `None` where none did in time.
    #[must_use]
    pub fn next(&self, patience: Duration) -> Option<Instant> {
        self.heard.recv_timeout(patience).ok()
    }
}

/// Sends empty messages to itself over TCPROS on loopback.
pub struct Ping {
    publisher: Publisher<std_msgs::Empty>,
    heard: Receiver<Instant>,
    _subscriber: Subscriber,
}

impl std::fmt::Debug for Ping {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Ping")
    }
}

impl Ping {
    /// Makes both ends; they find each other within a moment.
    ///
    /// # Errors
    /// Where the master does not register one of them.
    pub fn start() -> Result<Self, RosError> {
        let publisher = advertise(PING, 1)?;
        let (subscriber, heard) = listen(PING)?;
        Ok(Self { publisher, heard, _subscriber: subscriber })
    }

    /// How long one message took; `None` where it did not arrive in time.
    #[must_use]
    pub fn once(&self, patience: Duration) -> Option<Duration> {
        self.heard.try_iter().for_each(drop);
        let sent = Instant::now();
        self.publisher.send(std_msgs::Empty {}).ok()?;
        self.heard.recv_timeout(patience).ok().map(|arrived| arrived.saturating_duration_since(sent))
    }
}

/// Says, beside the robot, what force an arm feels.
pub struct ForceVoice {
    publisher: Publisher<baxter_core_msgs::EndpointState>,
    side: Side,
}

impl std::fmt::Debug for ForceVoice {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("ForceVoice").field("side", &self.side).finish_non_exhaustive()
    }
}

impl ForceVoice {
    /// Publishes on the arm's end point topic, and waits until somebody listens.
    ///
    /// # Errors
    /// Where the master does not register it, or nobody listens in time.
    pub fn start(side: Side, patience: Duration) -> Result<Self, RosError> {
        let topic = format!("/robot/limb/{side}/endpoint_state");
        let publisher = advertise(&topic, 1)?;
        // Not until all are connected whom the master names: it may still name a node that was killed.
        let began = Instant::now();
        while publisher.subscriber_count() == 0 {
            if began.elapsed() > patience {
                return Err(RosError::registration(&topic, "nobody listens to it"));
            }
            thread::sleep(LOOK);
        }
        Ok(Self { publisher, side })
    }

    /// One message with a force of so many newtons.
    ///
    /// # Errors
    /// Where it cannot be sent.
    pub fn say(&self, newtons: f64) -> Result<(), RosError> {
        let wrench = Wrench { force: Vector::new(newtons, 0.0, 0.0), ..Wrench::default() };
        let sample = EndpointSample { side: self.side, stamp: now(), pose: Pose::identity(), wrench };
        self.publisher.send(encode::endpoint(&sample)).map_err(|error| RosError::registration("endpoint_state", error))
    }
}
