//! Tells nodes what changed, without ever waiting for one on behalf of another.
//!
//! Each node's address has a queue and a thread, which ends when there was nothing to tell for a while. Notices to one node
//! keep their order.

use crate::ros::xmlrpc::Value;
use crate::ros::xmlrpc::http::call;
use crossbeam_channel::{Receiver, Sender, bounded};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How long a node may take for an answer.
const LIMIT: Duration = Duration::from_secs(3);
/// After this time without anything to tell, a node's thread ends.
const IDLE: Duration = Duration::from_secs(10);
/// Notices that may wait for a node that hangs.
const QUEUE: usize = 256;

/// Something to tell a node.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Notice {
    /// The node's address.
    pub(super) uri: String,
    /// Its method.
    pub(super) method: &'static str,
    /// What to tell.
    pub(super) parameters: Vec<Value>,
}

type Queues = Arc<Mutex<HashMap<String, Sender<Notice>>>>;

/// Tells notices.
#[derive(Debug, Default)]
pub(super) struct Notifier {
    queues: Queues,
}

impl Notifier {
    /// Queues a notice. Never blocks: a node that hangs with a full queue misses it.
    pub(super) fn tell(&self, notice: Notice) {
        let mut queues = self.queues.lock().unwrap_or_else(PoisonError::into_inner);
        if !queues.contains_key(&notice.uri) {
            let (sender, receiver) = bounded(QUEUE);
            let (all, uri) = (Arc::clone(&self.queues), notice.uri.clone());
            if thread::Builder::new().name("master-notice".into()).spawn(move || work(&uri, &receiver, &all)).is_err() {
                return;
            }
            queues.insert(notice.uri.clone(), sender);
        }
        if let Some(queue) = queues.get(&notice.uri) {
            // A full queue belongs to a node that hangs; it learns the present state when it registers again.
            let _ = queue.try_send(notice);
        }
    }
}

fn work(uri: &str, notices: &Receiver<Notice>, queues: &Queues) {
    loop {
        if let Ok(notice) = notices.recv_timeout(IDLE) {
            // A node that is gone cannot be told; the graph keeps it until it is cleaned up, as every master does.
            drop(call(&notice.uri, notice.method, &notice.parameters, LIMIT));
            continue;
        }
        let mut queues = queues.lock().unwrap_or_else(PoisonError::into_inner);
        // Under the lock nothing new can come: what is empty now stays empty.
        if notices.is_empty() {
            queues.remove(uri);
            return;
        }
    }
}
