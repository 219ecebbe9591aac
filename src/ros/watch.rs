//! The watch: looks at the master once a second, and mends what the transport does not.
//!
//! - The master gone or back is told. A master that came back knows nothing of this node: everything is registered again,
//!   and our own subscribers are told the publishers, without touching streams that still run.
//! - A publisher that lives but has gone silent is subscribed to anew: a broken link is never taken up again by itself.
//! - A foreign publisher on a topic that commands the robot is named, and so is one that publishes by another definition.
//! - A second node of this one's name, to which the master gave its place, is named as such a publisher.
//!
//! All of this waits for the network, so it has a thread of its own, away from screen, stop and supervisor.

use super::definitions::{Definitions, Publisher};
use super::graph::{Graph, topic_types};
use super::monitor::now;
use super::node::{MASTER_LIMIT, resolved};
use super::subscription::{Sink, Subscription};
use super::xmlrpc::Value;
use super::xmlrpc::http::{CallError, call_ros};
use crate::supervisor::{Input, LinkEvent};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// How often the master is looked at.
const PERIOD: Duration = Duration::from_secs(1);
/// How often the watch looks whether it is to end.
const NAP: Duration = Duration::from_millis(200);
/// A published topic that is silent for so long is subscribed to anew.
const SILENCE: Duration = Duration::from_secs(2);
/// A silent topic is subscribed to anew after this, and then after twice as long each time: the transport keeps a thread and a
/// connection of each subscription that was given up until its publisher says something again.
const RENEWAL: Duration = Duration::from_secs(5);
/// The longest time between two such attempts.
const RAREST_RENEWAL: Duration = Duration::from_secs(60);
/// The robot's own nodes that may enable it (two loaders run on every Baxter).
const ROBOTS_OWN: [&str; 2] = ["/rcloader_left", "/rcloader_right"];

/// When a silent topic is subscribed to anew.
#[derive(Clone, Copy, Debug)]
struct Renewal {
    last: Instant,
    wait: Duration,
}

impl Renewal {
    const fn new(now: Instant) -> Self {
        Self { last: now, wait: RENEWAL }
    }

    /// Whether it is time for the next attempt. What is heard, or has no publisher, begins with short waits again.
    fn is_due(&mut self, now: Instant, is_silent: bool) -> bool {
        if !is_silent {
            self.wait = RENEWAL;
            return false;
        }
        let is_due = now.saturating_duration_since(self.last) > self.wait;
        if is_due {
            *self = Self { last: now, wait: (self.wait * 2).min(RAREST_RENEWAL) };
        }
        is_due
    }
}

/// What this node has with the master, as the master itself once said.
#[derive(Debug, Default)]
struct Registrations {
    published: BTreeSet<String>,
    subscribed: BTreeSet<String>,
    services: BTreeMap<String, String>,
    types: BTreeMap<String, String>,
}

pub(super) struct Watch {
    master: String,
    node: String,
    uri: String,
    sink: Sink,
    subscriptions: Vec<(Subscription, Renewal)>,
    registrations: Registrations,
    is_lost: bool,
    /// Topics on which nobody else may publish, as the master knows them.
    guarded: Vec<String>,
    /// Asks publishers for their definitions; `None` where nothing is listened to.
    definitions: Option<Definitions>,
    foreign: BTreeSet<(String, String)>,
    /// Another node took this one's name: what this one sends may reach nobody until it is started anew.
    is_pushed_out: bool,
}

impl Watch {
    pub(super) fn new(master: &str, node: &str, sink: Sink, subscriptions: Vec<Subscription>) -> Self {
        let begin = Renewal::new(Instant::now());
        Self {
            master: master.to_owned(),
            node: node.to_owned(),
            uri: rosrust::uri(),
            sink,
            subscriptions: subscriptions.into_iter().map(|subscription| (subscription, begin)).collect(),
            registrations: Registrations::default(),
            is_lost: false,
            guarded: Vec::new(),
            definitions: None,
            foreign: BTreeSet::new(),
            is_pushed_out: false,
        }
    }

    /// Names whoever else publishes on `topics`; they are given as they are before remappings.
    pub(super) fn guarding(self, topics: &[String]) -> Self {
        Self { guarded: topics.iter().map(|topic| resolved(topic)).collect(), ..self }
    }

    /// Starts the thread; it ends soon after `ended` is set, and gives its subscriptions up.
    pub(super) fn start(mut self, ended: Arc<AtomicBool>) -> std::io::Result<thread::JoinHandle<()>> {
        if !self.subscriptions.is_empty() {
            self.definitions = Some(Definitions::start(&self.master, &self.node, Arc::clone(&self.sink))?);
        }
        thread::Builder::new().name("ros-watch".into()).spawn(move || {
            while !ended.load(Ordering::SeqCst) {
                self.look();
                let next = Instant::now() + PERIOD;
                while Instant::now() < next && !ended.load(Ordering::SeqCst) {
                    thread::sleep(NAP);
                }
            }
        })
    }

    fn tell(&self, event: LinkEvent) {
        (self.sink)(Input::Link(event));
    }

    fn look(&mut self) {
        match Graph::ask(&self.master, &self.node) {
            Err(_) if self.is_lost => {}
            Err(_) => {
                self.is_lost = true;
                self.tell(LinkEvent::MasterLost);
            }
            Ok(graph) => {
                // A node that another one of its name has pushed out must not push back.
                let mended = if rosrust::is_ok() { self.mend(&graph) } else { Ok(()) };
                if mended.is_ok() && std::mem::take(&mut self.is_lost) {
                    self.tell(LinkEvent::MasterBack);
                }
                self.name_foreign(&graph);
                self.renew_silent(&graph);
            }
        }
    }

    /// Registers again what the master does not know any more, and learns what it knows.
    fn mend(&mut self, graph: &Graph) -> Result<(), CallError> {
        let caller = Value::text(&self.node);
        let mine = |nodes: &[String]| nodes.contains(&self.node);
        for topic in self.registrations.published.iter().filter(|topic| !mine(graph.publishers_of(topic))) {
            let kind = self.kind_of(topic);
            call_ros(
                &self.master,
                "registerPublisher",
                &[caller.clone(), Value::text(topic), kind, Value::text(&self.uri)],
                MASTER_LIMIT,
            )?;
        }
        for topic in self.registrations.subscribed.iter().filter(|topic| !mine(graph.subscribers_of(topic))) {
            let kind = self.kind_of(topic);
            let parameters = [caller.clone(), Value::text(topic), kind, Value::text(&self.uri)];
            let publishers = call_ros(&self.master, "registerSubscriber", &parameters, MASTER_LIMIT)?;
            call_ros(
                &self.uri,
                "publisherUpdate",
                &[Value::text("/master"), Value::text(topic), publishers],
                MASTER_LIMIT,
            )?;
        }
        for (service, address) in &self.registrations.services {
            if !graph.services.get(service).is_some_and(|nodes| mine(nodes)) {
                let parameters = [caller.clone(), Value::text(service), Value::text(address), Value::text(&self.uri)];
                call_ros(&self.master, "registerService", &parameters, MASTER_LIMIT)?;
            }
        }
        self.learn(graph)
    }

    fn kind_of(&self, topic: &str) -> Value {
        Value::text(self.registrations.types.get(topic).map_or("*", String::as_str))
    }

    fn learn(&mut self, graph: &Graph) -> Result<(), CallError> {
        let mine = |(_, nodes): &(&String, &Vec<String>)| nodes.contains(&self.node);
        let known = &mut self.registrations;
        let before = known.published.len() + known.subscribed.len();
        known.published.extend(graph.publishers.iter().filter(mine).map(|(topic, _)| topic.clone()));
        known.subscribed.extend(graph.subscribers.iter().filter(mine).map(|(topic, _)| topic.clone()));
        if known.published.len() + known.subscribed.len() > before {
            known.types.extend(topic_types(&self.master, &self.node)?);
        }
        for (service, _) in graph.services.iter().filter(mine) {
            if !known.services.contains_key(service) {
                let parameters = [Value::text(&self.node), Value::text(service)];
                if let Some(address) = call_ros(&self.master, "lookupService", &parameters, MASTER_LIMIT)?.as_text() {
                    known.services.insert(service.clone(), address.to_owned());
                }
            }
        }
        Ok(())
    }

    /// Names nodes that command the robot beside this one, each once as long as it stays.
    fn name_foreign(&mut self, graph: &Graph) {
        let mut found: BTreeSet<_> = self
            .guarded
            .iter()
            .flat_map(|topic| graph.publishers_of(topic).iter().map(move |node| (topic.clone(), node.clone())))
            .filter(|(_, node)| *node != self.node && !ROBOTS_OWN.contains(&node.as_str()))
            .collect();
        self.is_pushed_out |= self.has_lost_its_name();
        if let Some(topic) = self.guarded.first().filter(|_| self.is_pushed_out) {
            // The graph shows the other one as if it were this one.
            let node = format!("a second {} has taken this one's place (close this one): it", self.node);
            found.insert((topic.clone(), node));
        }
        for (topic, node) in found.difference(&self.foreign) {
            self.tell(LinkEvent::ForeignPublisher { topic: topic.clone(), node: node.clone() });
        }
        for (topic, node) in self.foreign.difference(&found) {
            self.tell(LinkEvent::ForeignPublisherGone { topic: topic.clone(), node: node.clone() });
        }
        self.foreign = found;
    }

    /// Whether the master has told this node to end because another one took its name.
    fn has_lost_its_name(&self) -> bool {
        if rosrust::is_ok() {
            return false;
        }
        let parameters = [Value::text(&self.node), Value::text(&self.node)];
        let holder = call_ros(&self.master, "lookupNode", &parameters, MASTER_LIMIT);
        holder.is_ok_and(|uri| uri.as_text().is_some_and(|uri| uri != self.uri))
    }

    fn renew_silent(&mut self, graph: &Graph) {
        let mut publishers = Vec::new();
        for (subscription, renewal) in &mut self.subscriptions {
            let monitor = subscription.monitor.clone();
            let nodes = graph.publishers_of(&monitor.resolved);
            monitor.set_publishers(nodes.to_vec());
            let is_silent = monitor.is_silent(now(), SILENCE);
            let publisher = |node: &String| Publisher { node: node.clone(), monitor: monitor.clone(), is_silent };
            publishers.extend(nodes.iter().map(publisher));
            if renewal.is_due(Instant::now(), is_silent) {
                // Where it fails, the topic stays silent, is shown as such, and is tried again.
                let _ = subscription.renew();
            }
        }
        if let Some(definitions) = &self.definitions {
            definitions.look_at(publishers);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_silent_topic_is_tried_again_ever_more_rarely_and_soon_again_once_it_was_heard() {
        let begin = Instant::now();
        let mut renewal = Renewal::new(begin);
        let mut tried = Vec::new();
        for second in 0..600 {
            if renewal.is_due(begin + Duration::from_secs(second), true) {
                tried.push(second);
            }
        }
        assert_eq!(tried[..5], [6, 17, 38, 79, 140]);
        assert_eq!(tried.len(), 12, "once a minute at last");
        assert!(!renewal.is_due(begin + Duration::from_secs(600), false));
        assert!(renewal.is_due(begin + Duration::from_secs(606), true));
    }
}
