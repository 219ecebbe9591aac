//! What other nodes may see of this one: `~state`, `~force/{s}`, `~path/{s}`, `~markers`, `~snapshot`, `/diagnostics`.

use super::{RosError, advertise};
use crate::body::{PerSide, Side};
use crate::ros::encode;
use crate::ros::message::{diagnostic_msgs, nav_msgs, valet_msgs, visualization_msgs};
use crate::snapshot::Snapshot;
use crate::time::Stamp;
use rosrust::{Message, Publisher};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Snapshots come as often as a screen draws; other nodes get ten a second.
const PERIOD: Duration = Duration::from_millis(100);

/// Shows snapshots to other nodes. Sending never blocks.
#[derive(Clone)]
pub struct Showing {
    state: Publisher<valet_msgs::State>,
    force: PerSide<Publisher<valet_msgs::Force>>,
    path: PerSide<Publisher<nav_msgs::Path>>,
    markers: Publisher<visualization_msgs::MarkerArray>,
    snapshots: Publisher<valet_msgs::Snapshot>,
    diagnostics: Publisher<diagnostic_msgs::DiagnosticArray>,
    last: Arc<Mutex<Option<Stamp>>>,
}

impl std::fmt::Debug for Showing {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Showing")
    }
}

impl Showing {
    pub(super) fn advertise() -> Result<Self, RosError> {
        Ok(Self {
            state: advertise("~state", 1)?,
            force: both("~force")?,
            path: both("~path")?,
            markers: advertise("~markers", 1)?,
            snapshots: advertise("~snapshot", 2)?,
            diagnostics: advertise("/diagnostics", 1)?,
            last: Arc::new(Mutex::new(None)),
        })
    }

    /// Publishes a snapshot, unless the last one was published less than a tenth of a second before. `complete` fills in
    /// what only the shell knows, and is asked only where a console watches.
    pub fn show(&self, snapshot: &Snapshot, complete: impl FnOnce(&mut Snapshot)) {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.is_some_and(|last| snapshot.now.checked_since(last).is_some_and(|span| span < PERIOD)) {
            return;
        }
        *last = Some(snapshot.now);
        drop(last);
        tell(&self.state, || encode::state(snapshot));
        for (side, view) in snapshot.sides.iter() {
            tell(self.force.get(side), || encode::force(snapshot, side, view));
            tell(self.path.get(side), || encode::path(snapshot.now, &view.path.updated));
        }
        tell(&self.markers, || encode::markers::all(snapshot));
        if self.snapshots.subscriber_count() > 0 {
            let mut whole = snapshot.shortened();
            complete(&mut whole);
            if let Some(message) = encode::snapshot(&whole) {
                let _ = self.snapshots.send(message);
            }
        }
    }

    pub(super) fn diagnose(&self, message: &diagnostic_msgs::DiagnosticArray) {
        tell(&self.diagnostics, || message.clone());
    }
}

/// Publishes a message where anybody listens: making and queueing one for nobody is what an idle node would mostly do.
fn tell<T: Message>(publisher: &Publisher<T>, message: impl FnOnce() -> T) {
    if publisher.subscriber_count() > 0 {
        // What cannot be shown is not missed by the trial: the next one comes in a tenth of a second.
        let _ = publisher.send(message());
    }
}

fn both<T: Message>(word: &str) -> Result<PerSide<Publisher<T>>, RosError> {
    let topic = |side: Side| advertise(&format!("{word}/{side}"), 1);
    Ok(PerSide { left: topic(Side::Left)?, right: topic(Side::Right)? })
}
