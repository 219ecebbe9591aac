//! What the master knows of the graph, asked for with a time limit: who publishes, who listens, who serves.

use super::node::MASTER_LIMIT;
use super::xmlrpc::Value;
use super::xmlrpc::http::{CallError, call_ros};
use std::collections::BTreeMap;

/// A name and the nodes behind it.
pub type Nodes = BTreeMap<String, Vec<String>>;

/// The graph at one moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    /// Publishers by topic.
    pub publishers: Nodes,
    /// Subscribers by topic.
    pub subscribers: Nodes,
    /// Providers by service.
    pub services: Nodes,
}

impl Graph {
    /// Asks the master.
    ///
    /// # Errors
    /// Where it does not answer in time, or answers something else.
    pub fn ask(master: &str, caller: &str) -> Result<Self, CallError> {
        let state = call_ros(master, "getSystemState", &[Value::text(caller)], MASTER_LIMIT)?;
        match state.as_array() {
            Some([publishers, subscribers, services]) => {
                Ok(Self { publishers: nodes(publishers), subscribers: nodes(subscribers), services: nodes(services) })
            }
            _ => Err(CallError::Refused("a state of the graph that is none".into())),
        }
    }

    /// The nodes that publish a topic.
    #[must_use]
    pub fn publishers_of(&self, topic: &str) -> &[String] {
        self.publishers.get(topic).map_or(&[], Vec::as_slice)
    }

    /// The nodes that listen to a topic.
    #[must_use]
    pub fn subscribers_of(&self, topic: &str) -> &[String] {
        self.subscribers.get(topic).map_or(&[], Vec::as_slice)
    }
}

fn nodes(value: &Value) -> Nodes {
    let pairs = value.as_array().unwrap_or_default().iter().filter_map(|pair| match pair.as_array() {
        Some([name, nodes]) => {
            let nodes = nodes.as_array()?.iter().filter_map(|node| node.as_text().map(str::to_owned)).collect();
            Some((name.as_text()?.to_owned(), nodes))
        }
        _ => None,
    });
    pairs.collect()
}

/// Types by topic, as the master knows them.
///
/// # Errors
/// Where it does not answer in time.
pub fn topic_types(master: &str, caller: &str) -> Result<BTreeMap<String, String>, CallError> {
    let types = call_ros(master, "getTopicTypes", &[Value::text(caller)], MASTER_LIMIT)?;
    let pairs = types.as_array().unwrap_or_default().iter().filter_map(|pair| match pair.as_array() {
        Some([name, kind]) => Some((name.as_text()?.to_owned(), kind.as_text()?.to_owned())),
        _ => None,
    });
    Ok(pairs.collect())
}

/// A parameter that is text, as long as a robot description may be; `None` where the master has none or does not answer in time.
#[must_use]
pub fn text_parameter(master: &str, caller: &str, name: &str) -> Option<String> {
    let value = call_ros(master, "getParam", &[Value::text(caller), Value::text(name)], MASTER_LIMIT).ok()?;
    value.as_text().map(str::to_owned)
}
