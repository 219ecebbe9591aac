//! The topics' health on `/diagnostics`, once a second, from a thread of its own: it asks no master and no supervisor, so it
//! goes on telling when either hangs.

use super::Showing;
use crate::ros::encode;
use crate::ros::monitor::{Monitor, now};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The rate at which diagnostics are usually published.
const PERIOD: Duration = Duration::from_secs(1);
/// How often the thread looks whether it is to end.
const NAP: Duration = Duration::from_millis(200);

/// Starts the thread; it ends soon after `ended` is set.
pub(super) fn start(
    node: String,
    showing: Showing,
    monitors: Vec<Monitor>,
    ended: Arc<AtomicBool>,
) -> std::io::Result<JoinHandle<()>> {
    thread::Builder::new().name("diagnostics".into()).spawn(move || {
        let mut next = Instant::now();
        while !ended.load(Ordering::SeqCst) {
            if Instant::now() >= next {
                let now = now();
                let reports: Vec<_> = monitors.iter().map(|monitor| monitor.report(now)).collect();
                showing.diagnose(&encode::diagnostics(now, &node, &reports));
                next = (next + PERIOD).max(Instant::now());
            }
            thread::sleep(NAP);
        }
    })
}
