//! Whether those who publish to this node mean the same message: each publisher is asked once for its definition's digest.
//!
//! rosrust drops a publisher with another definition after one line in its own log and says nothing to anybody; the topic just
//! stays silent. So each is greeted here once more, as a subscriber that takes any definition, and what it answers is compared.
//! Asking waits for peers, so it has a thread of its own; it never touches the connections that carry data.

use super::greeting::{self, Fields};
use super::monitor::Monitor;
use super::node::MASTER_LIMIT;
use super::subscription::Sink;
use super::xmlrpc::Value;
use super::xmlrpc::http::{CallError, call_ros};
use crate::supervisor::{Input, LinkEvent};
use crossbeam_channel::{Receiver, Sender, bounded};
use std::collections::BTreeMap;
use std::io;
use std::thread;
use std::time::{Duration, Instant};

/// A publisher that did not answer, or whose topic stays silent, is asked again, but not more often than this: it may have been
/// replaced by another program of the same name.
const AGAIN: Duration = Duration::from_secs(5);

/// A message's type and the digest of its definition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Definition {
    pub(super) kind: String,
    pub(super) digest: String,
}

impl std::fmt::Display for Definition {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{} (md5 {})", self.kind, self.digest)
    }
}

impl Definition {
    /// True where messages of `other` can be read as these. A star stands for any definition.
    fn reads(&self, other: &Self) -> bool {
        [&self.digest, &other.digest].iter().any(|digest| *digest == "*") || self.digest == other.digest
    }
}

/// A publisher that is to be asked.
#[derive(Clone, Debug)]
pub(super) struct Publisher {
    pub(super) node: String,
    pub(super) monitor: Monitor,
    /// Whether its topic brings nothing.
    pub(super) is_silent: bool,
}

/// Takes publishers to the thread that asks them. Never blocks: where that is busy, the next list comes in a second.
#[derive(Clone, Debug)]
pub(super) struct Definitions(Sender<Vec<Publisher>>);

impl Definitions {
    /// Starts the thread; it ends when the last of its senders is dropped.
    pub(super) fn start(master: &str, caller: &str, sink: Sink) -> io::Result<Self> {
        let (sender, lists) = bounded(1);
        let asker = Asker { master: master.to_owned(), caller: caller.to_owned(), limit: MASTER_LIMIT };
        thread::Builder::new().name("ros-definitions".into()).spawn(move || follow(&asker, &lists, &sink))?;
        Ok(Self(sender))
    }

    /// All publishers that there are now.
    pub(super) fn look_at(&self, publishers: Vec<Publisher>) {
        let _ = self.0.try_send(publishers);
    }
}

/// What one publisher answered last, and when it was asked.
#[derive(Clone, Debug)]
struct Known {
    asked: Instant,
    answer: Option<Definition>,
}

fn follow(asker: &Asker, lists: &Receiver<Vec<Publisher>>, sink: &Sink) {
    let mut known: BTreeMap<(String, String), Known> = BTreeMap::new();
    for publishers in lists {
        known.retain(|(topic, node), _| {
            publishers.iter().any(|there| there.monitor.resolved == *topic && there.node == *node)
        });
        for Publisher { node, monitor, is_silent } in publishers {
            let key = (monitor.resolved.clone(), node.clone());
            let before = known.get(&key);
            let is_due = |known: &Known| (is_silent || known.answer.is_none()) && known.asked.elapsed() > AGAIN;
            if before.is_some_and(|known| !is_due(known)) {
                continue;
            }
            // A publisher that does not answer is told of by the silence of its topic.
            let answer = asker.definition(&monitor.resolved, &node).ok();
            let is_news = before.is_none_or(|known| known.answer != answer);
            let wrong = answer.as_ref().filter(|found| !monitor.definitions.iter().any(|wanted| wanted.reads(found)));
            monitor.set_wrong(&node, wrong.map(ToString::to_string));
            if let Some(found) = wrong.filter(|_| is_news) {
                let wanted: Vec<_> = monitor.definitions.iter().map(ToString::to_string).collect();
                sink(Input::Link(LinkEvent::WrongDefinition {
                    topic: monitor.resolved.clone(),
                    node,
                    found: found.to_string(),
                    wanted: wanted.join(" or "),
                }));
            }
            known.insert(key, Known { asked: Instant::now(), answer });
        }
    }
}

/// Asks publishers, each step with a time limit.
#[derive(Clone, Debug)]
struct Asker {
    master: String,
    caller: String,
    limit: Duration,
}

impl Asker {
    /// What `node` says that it publishes on `topic`.
    fn definition(&self, topic: &str, node: &str) -> Result<Definition, CallError> {
        let caller = Value::text(&self.caller);
        let found = call_ros(&self.master, "lookupNode", &[caller.clone(), Value::text(node)], self.limit)?;
        let protocols = Value::Array(vec![Value::texts(["TCPROS"])]);
        let uri = found.as_text().unwrap_or_default();
        let answer = call_ros(uri, "requestTopic", &[caller, Value::text(topic), protocols], self.limit)?;
        let Some([protocol, host, port]) = answer.as_array() else { return Err(foreign("an answer of another form")) };
        let (Some("TCPROS"), Some(host), Some(port)) = (protocol.as_text(), host.as_text(), port.as_integer()) else {
            return Err(foreign("another transport than TCPROS"));
        };
        let mut stream = greeting::connect(&format!("{host}:{port}"), self.limit)?;
        // rospy closes a node's older connection when a newer one of the same name comes: who asks needs a name of its own.
        let caller = format!("{}_definitions", self.caller);
        let asked = [("callerid", caller.as_str()), ("topic", topic), ("md5sum", "*"), ("type", "*")];
        let asked: Fields = asked.into_iter().map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
        let answer = greeting::exchange(&mut stream, &asked)?;
        match (answer.get("error"), answer.get("type"), answer.get("md5sum")) {
            (None, Some(kind), Some(digest)) => Ok(Definition { kind: kind.clone(), digest: digest.clone() }),
            (reason, _, _) => Err(foreign(reason.map_or("a greeting without type or digest", String::as_str))),
        }
    }
}

fn foreign(words: &str) -> CallError {
    CallError::Refused(words.to_owned())
}

#[cfg(test)]
mod tests;
