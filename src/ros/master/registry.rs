//! Who publishes, listens and serves. Pure: changes in, the notices that follow from them out.

use super::notify::Notice;
use crate::ros::xmlrpc::Value;
use std::collections::BTreeMap;

/// A node's part in a topic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Publisher,
    Subscriber,
}

/// Nodes by name, in the order in which they came.
type Members = BTreeMap<String, Vec<String>>;

/// The graph as nodes have registered it.
#[derive(Clone, Debug, Default)]
pub(super) struct Registry {
    nodes: BTreeMap<String, String>,
    publishers: Members,
    subscribers: Members,
    /// Node and address of each service.
    services: BTreeMap<String, (String, String)>,
    types: BTreeMap<String, String>,
}

impl Registry {
    /// Registers a node for a topic; returns the addresses on the other side of the topic, and whom to tell what.
    pub(super) fn register(
        &mut self,
        role: Role,
        caller: &str,
        topic: &str,
        kind: &str,
        uri: &str,
    ) -> (Vec<String>, Vec<Notice>) {
        let mut notices = self.enter(caller, uri);
        let known = self.types.entry(topic.to_owned()).or_insert_with(|| kind.to_owned());
        if kind != "*" && (role == Role::Publisher || known == "*") {
            kind.clone_into(known);
        }
        let members = self.members(role).entry(topic.to_owned()).or_default();
        if !members.iter().any(|node| node == caller) {
            members.push(caller.to_owned());
        }
        if role == Role::Publisher {
            notices.extend(self.publisher_updates(topic));
        }
        let others = match role {
            Role::Publisher => self.addresses(&self.subscribers, topic),
            Role::Subscriber => self.addresses(&self.publishers, topic),
        };
        (others, notices)
    }

    /// Takes a node's registration back; a message of a process that has been replaced changes nothing.
    pub(super) fn unregister(&mut self, role: Role, caller: &str, topic: &str, uri: &str) -> (bool, Vec<Notice>) {
        if self.nodes.get(caller).is_none_or(|known| known != uri) {
            return (false, Vec::new());
        }
        let removed = remove(self.members(role), topic, caller);
        let notices = if removed && role == Role::Publisher { self.publisher_updates(topic) } else { Vec::new() };
        self.forget_if_idle(caller);
        (removed, notices)
    }

    pub(super) fn register_service(&mut self, caller: &str, service: &str, address: &str, uri: &str) -> Vec<Notice> {
        let notices = self.enter(caller, uri);
        self.services.insert(service.to_owned(), (caller.to_owned(), address.to_owned()));
        notices
    }

    /// Takes a service back, unless somebody else serves it by now.
    pub(super) fn unregister_service(&mut self, service: &str, address: &str) -> bool {
        let Some((node, _)) = self.services.get(service).filter(|(_, known)| known == address).cloned() else {
            return false;
        };
        self.services.remove(service);
        self.forget_if_idle(&node);
        true
    }

    /// A node's address.
    pub(super) fn node(&self, name: &str) -> Option<String> {
        self.nodes.get(name).cloned()
    }

    /// A service's address.
    pub(super) fn service(&self, name: &str) -> Option<String> {
        self.services.get(name).map(|(_, address)| address.clone())
    }

    /// Published topics with their types; only those below `subgraph`, unless that is empty.
    pub(super) fn published(&self, subgraph: &str) -> Value {
        let below = format!("{}/", subgraph.trim_end_matches('/'));
        let wanted = self.publishers.keys().filter(|topic| subgraph.is_empty() || topic.starts_with(&below));
        Value::Array(wanted.map(|topic| Value::texts([topic.as_str(), self.kind_of(topic)])).collect())
    }

    /// All topics that were ever spoken of, with their types.
    pub(super) fn types(&self) -> Value {
        Value::Array(self.types.iter().map(|(topic, kind)| Value::texts([topic, kind])).collect())
    }

    /// The whole graph: publishers, subscribers, services.
    pub(super) fn state(&self) -> Value {
        let pair = |name: &String, nodes: &[String]| {
            Value::Array(vec![Value::text(name), Value::texts(nodes.iter().cloned())])
        };
        let members =
            |members: &Members| Value::Array(members.iter().map(|(topic, nodes)| pair(topic, nodes)).collect());
        let services = self.services.iter().map(|(service, (node, _))| pair(service, std::slice::from_ref(node)));
        Value::Array(vec![members(&self.publishers), members(&self.subscribers), Value::Array(services.collect())])
    }

    fn kind_of(&self, topic: &str) -> &str {
        self.types.get(topic).map_or("*", String::as_str)
    }

    fn members(&mut self, role: Role) -> &mut Members {
        match role {
            Role::Publisher => &mut self.publishers,
            Role::Subscriber => &mut self.subscribers,
        }
    }

    fn addresses(&self, members: &Members, topic: &str) -> Vec<String> {
        members.get(topic).into_iter().flatten().filter_map(|node| self.nodes.get(node).cloned()).collect()
    }

    /// Notes a node's address. Where a new process takes a name over, the old one is told to end, and what it had is gone
    /// before the new one's first registration is entered.
    fn enter(&mut self, caller: &str, uri: &str) -> Vec<Notice> {
        let Some(old) = self.nodes.insert(caller.to_owned(), uri.to_owned()).filter(|old| old != uri) else {
            return Vec::new();
        };
        let gone: Vec<String> = self
            .publishers
            .iter()
            .filter(|(_, nodes)| nodes.iter().any(|node| node == caller))
            .map(|(topic, _)| topic.clone())
            .collect();
        for members in [&mut self.publishers, &mut self.subscribers] {
            members.retain(|_, nodes| {
                nodes.retain(|node| node != caller);
                !nodes.is_empty()
            });
        }
        self.services.retain(|_, (node, _)| node != caller);
        let reason = format!("[{caller}] Reason: new node registered with same name");
        let end =
            Notice { uri: old, method: "shutdown", parameters: vec![Value::text("/master"), Value::text(reason)] };
        std::iter::once(end).chain(gone.iter().flat_map(|topic| self.publisher_updates(topic))).collect()
    }

    fn publisher_updates(&self, topic: &str) -> Vec<Notice> {
        let publishers = Value::texts(self.addresses(&self.publishers, topic));
        let tell = |uri| Notice {
            uri,
            method: "publisherUpdate",
            parameters: vec![Value::text("/master"), Value::text(topic), publishers.clone()],
        };
        self.addresses(&self.subscribers, topic).into_iter().map(tell).collect()
    }

    fn forget_if_idle(&mut self, node: &str) {
        let takes_part = |members: &Members| members.values().flatten().any(|member| member == node);
        if !takes_part(&self.publishers)
            && !takes_part(&self.subscribers)
            && !self.services.values().any(|(name, _)| name == node)
        {
            self.nodes.remove(node);
        }
    }
}

fn remove(members: &mut Members, topic: &str, node: &str) -> bool {
    let Some(nodes) = members.get_mut(topic) else { return false };
    let before = nodes.len();
    nodes.retain(|member| member != node);
    let removed = nodes.len() < before;
    if nodes.is_empty() {
        members.remove(topic);
    }
    removed
}

#[cfg(test)]
mod tests {
    use super::*;

    const TYPE: &str = "std_msgs/Empty";

    #[test]
    fn a_publisher_is_told_to_those_who_listen_and_so_is_its_end() {
        let mut registry = Registry::default();
        assert_eq!(registry.register(Role::Subscriber, "/listener", "/stop", "*", "http://l:1/"), (vec![], vec![]));
        let (others, notices) = registry.register(Role::Publisher, "/speaker", "/stop", TYPE, "http://s:1/");
        assert_eq!(others, ["http://l:1/"]);
        assert_eq!(notices.len(), 1);
        assert_eq!((notices[0].uri.as_str(), notices[0].method), ("http://l:1/", "publisherUpdate"));
        assert_eq!(notices[0].parameters[2], Value::texts(["http://s:1/"]));
        assert_eq!(registry.types(), Value::Array(vec![Value::texts(["/stop", TYPE])]));
        let (removed, notices) = registry.unregister(Role::Publisher, "/speaker", "/stop", "http://s:1/");
        assert!(removed);
        assert_eq!(notices[0].parameters[2], Value::Array(vec![]));
        assert_eq!(registry.node("/speaker"), None);
    }

    #[test]
    fn a_new_process_of_the_same_name_keeps_its_registrations_and_the_old_one_is_told_to_end() {
        let mut registry = Registry::default();
        registry.register(Role::Subscriber, "/listener", "/a", TYPE, "http://l:1/");
        registry.register(Role::Publisher, "/robot", "/a", TYPE, "http://old:1/");
        registry.register_service("/robot", "/serve", "rosrpc://old:2", "http://old:1/");
        let (_, notices) = registry.register(Role::Publisher, "/robot", "/b", TYPE, "http://new:1/");
        assert_eq!((notices[0].uri.as_str(), notices[0].method), ("http://old:1/", "shutdown"));
        assert_eq!((notices[1].uri.as_str(), notices[1].method), ("http://l:1/", "publisherUpdate"));
        assert_eq!(registry.service("/serve"), None);
        // What the old process still says while it ends does not touch the new one.
        assert_eq!(registry.unregister(Role::Publisher, "/robot", "/b", "http://old:1/"), (false, vec![]));
        assert_eq!(registry.node("/robot").as_deref(), Some("http://new:1/"));
        assert_eq!(registry.published(""), Value::Array(vec![Value::texts(["/b", TYPE])]));
    }

    #[test]
    fn registering_twice_is_registering_once() {
        let mut registry = Registry::default();
        for _ in 0..2 {
            registry.register(Role::Publisher, "/node", "/a", TYPE, "http://n:1/");
        }
        let expected = Value::Array(vec![Value::text("/a"), Value::texts(["/node"])]);
        assert_eq!(registry.state().as_array().unwrap()[0], Value::Array(vec![expected]));
    }

    #[test]
    fn a_service_that_somebody_else_serves_by_now_stays() {
        let mut registry = Registry::default();
        registry.register_service("/one", "/serve", "rosrpc://one:1", "http://one:1/");
        registry.register_service("/two", "/serve", "rosrpc://two:1", "http://two:1/");
        assert!(!registry.unregister_service("/serve", "rosrpc://one:1"));
        assert_eq!(registry.service("/serve").as_deref(), Some("rosrpc://two:1"));
        assert!(registry.unregister_service("/serve", "rosrpc://two:1"));
    }

    #[test]
    fn a_subgraph_is_a_namespace_and_not_a_beginning_of_letters() {
        let mut registry = Registry::default();
        for topic in ["/robot/state", "/robotic"] {
            registry.register(Role::Publisher, "/node", topic, TYPE, "http://n:1/");
        }
        assert_eq!(registry.published("/robot").as_array().unwrap().len(), 1);
        assert_eq!(registry.published("").as_array().unwrap().len(), 2);
    }
}
