//! The link of a console that only watches: another valet's snapshots in, the stop out, and nothing else.
//!
//! It advertises no topic but the software stop, so that it cannot command anything. The stop goes to the robot itself and to
//! the watched node's `~stop`: either is enough, and neither waits for the other.

use super::checked::Checked;
use super::decode::{self, AnyAssemblyState};
use super::error::RosError;
use super::link::{StopPublisher, advertise};
use super::message::std_srvs::{Trigger, TriggerReq};
use super::message::valet_msgs;
use super::monitor::now;
use crate::assembly::RobotState;
use crate::snapshot::Snapshot;
use crossbeam_channel::{Sender, bounded};
use rosrust::Subscriber;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How long the watched node's service may be looked for at a stop; the robot itself has been told long before.
const SERVICE_LIMIT: Duration = Duration::from_secs(1);
/// Snapshots that may wait for their callback.
const QUEUE: usize = 4;

/// What has come in.
#[derive(Debug, Default)]
struct Seen {
    snapshot: Option<Snapshot>,
    /// When it came, and whether it has been taken.
    arrived: Option<Instant>,
    is_new: bool,
    robot: Option<RobotState>,
    unreadable: u64,
}

/// The link. One a process.
pub struct WatchLink {
    seen: Arc<Mutex<Seen>>,
    stop: StopPublisher,
    ask: Sender<()>,
    _subscribers: [Subscriber; 2],
}

impl std::fmt::Debug for WatchLink {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("WatchLink")
    }
}

impl WatchLink {
    /// Listens to the node called `watched` and to the robot's state, and makes the stop ready. The node need not be up yet.
    ///
    /// # Errors
    /// Where the master does not register something, or the system has no thread to give.
    pub fn connect(watched: &str) -> Result<Self, RosError> {
        let stop = StopPublisher::new(advertise("/robot/set_super_stop", 1)?);
        let seen = Arc::<Mutex<Seen>>::default();
        let (snapshots, robot) = (Arc::clone(&seen), Arc::clone(&seen));
        let topic = format!("{watched}/snapshot");
        let subscribers = [
            rosrust::subscribe(&topic, QUEUE, move |Checked(message): Checked<valet_msgs::Snapshot>| {
                take(&snapshots, &message.cbor);
            })
            .map_err(|error| RosError::registration(&topic, error))?,
            rosrust::subscribe("/robot/state", QUEUE, move |message: AnyAssemblyState| {
                let state = decode::robot_state(&message, now());
                let mut seen = robot.lock().unwrap_or_else(PoisonError::into_inner);
                seen.robot = state.or(seen.robot);
            })
            .map_err(|error| RosError::registration("/robot/state", error))?,
        ];
        let ask = start_asking(format!("{watched}/stop"))?;
        Ok(Self { seen, stop, ask, _subscribers: subscribers })
    }

    /// The newest snapshot, where it has not been taken yet.
    #[must_use]
    pub fn newest(&self) -> Option<Snapshot> {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        if std::mem::take(&mut seen.is_new) { seen.snapshot.clone() } else { None }
    }

    /// How long the watched node has been silent; `None` where it was never heard.
    #[must_use]
    pub fn silence(&self) -> Option<Duration> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner).arrived.map(|arrived| arrived.elapsed())
    }

    /// The robot's state as this process has heard it.
    #[must_use]
    pub fn robot(&self) -> Option<RobotState> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner).robot
    }

    /// Snapshots that could not be read, as from a valet of another version.
    #[must_use]
    pub fn unreadable(&self) -> u64 {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner).unreadable
    }

    /// What sends the stop, to be called until the robot confirms it. Never blocks.
    pub fn stopper(&self) -> impl FnMut() + Send + 'static {
        let (stop, ask) = (self.stop.clone(), self.ask.clone());
        move || {
            stop.send();
            // Where one question is on its way already, another would say nothing new.
            let _ = ask.try_send(());
        }
    }
}

fn take(seen: &Mutex<Seen>, cbor: &[u8]) {
    let part: Result<Snapshot, _> = ciborium::from_reader(cbor);
    let mut seen = seen.lock().unwrap_or_else(PoisonError::into_inner);
    match part {
        Ok(part) => {
            let whole = match &seen.snapshot {
                Some(earlier) => part.carrying_on(earlier),
                None => part,
            };
            (seen.snapshot, seen.arrived, seen.is_new) = (Some(whole), Some(Instant::now()), true);
        }
        Err(_) => seen.unreadable += 1,
    }
}

/// Starts the thread that asks the watched node to stop: a service call waits for its answer, and a stop must not.
fn start_asking(service: String) -> Result<Sender<()>, RosError> {
    let (ask, asked) = bounded::<()>(1);
    thread::Builder::new()
        .name("watch-stop".into())
        .spawn(move || {
            for () in asked {
                // The robot has been told directly; where the node does not answer, it is told again with the next stop.
                let _ = rosrust::wait_for_service(&service, Some(SERVICE_LIMIT))
                    .and_then(|()| rosrust::client::<Trigger>(&service))
                    .map(|client| client.req(&TriggerReq {}));
            }
        })
        .map_err(|error| RosError::thread("the question to stop", error))?;
    Ok(ask)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ros::encode;
    use crate::snapshot::{TopicHealth, TrialPhase};

    #[test]
    fn a_snapshot_survives_the_wire_with_its_infinities() {
        let mut sent = Snapshot::default();
        sent.trial.phase = TrialPhase::Dressing;
        let topic = TopicHealth { expected: (0.0, f64::INFINITY), ..TopicHealth::default() };
        sent.topics = vec![topic].into();
        let seen = Mutex::new(Seen::default());
        take(&seen, &encode::snapshot(&sent).unwrap().cbor);
        let seen = seen.into_inner().unwrap();
        assert_eq!(seen.snapshot, Some(sent));
        assert!(seen.is_new && seen.unreadable == 0);
    }

    #[test]
    fn what_cannot_be_read_is_counted_and_keeps_nothing() {
        let seen = Mutex::new(Seen::default());
        take(&seen, &[0xff, 0x00]);
        let seen = seen.into_inner().unwrap();
        assert_eq!((seen.unreadable, seen.snapshot), (1, None));
    }
}
