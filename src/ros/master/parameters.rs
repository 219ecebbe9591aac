//! The parameter server: a tree of values, and who wants to hear of changes. Pure.

use super::names::namespace;
use super::notify::Notice;
use crate::ros::xmlrpc::Value;
use std::collections::{BTreeMap, BTreeSet};

/// All parameters.
#[derive(Clone, Debug, Default)]
pub(super) struct Parameters {
    root: BTreeMap<String, Value>,
    /// Addresses by key.
    listeners: BTreeMap<String, BTreeSet<String>>,
}

fn parts(key: &str) -> impl Iterator<Item = &str> {
    key.split('/').filter(|part| !part.is_empty())
}

impl Parameters {
    /// A value or a whole branch; `None` where nothing is set.
    pub(super) fn get(&self, key: &str) -> Option<Value> {
        let mut parts = parts(key);
        let Some(first) = parts.next() else { return Some(Value::Struct(self.root.clone())) };
        let mut value = self.root.get(first)?;
        for part in parts {
            let Value::Struct(members) = value else { return None };
            value = members.get(part)?;
        }
        Some(value.clone())
    }

    /// Sets a value or a whole branch, in the place of what was there.
    pub(super) fn set(&mut self, key: &str, value: Value) -> Vec<Notice> {
        let mut parts: Vec<_> = parts(key).collect();
        match (parts.pop(), value) {
            (Some(last), value) => {
                let mut branch = &mut self.root;
                for part in parts {
                    let next = branch.entry(part.to_owned()).or_insert_with(|| Value::Struct(BTreeMap::new()));
                    if !matches!(next, Value::Struct(_)) {
                        *next = Value::Struct(BTreeMap::new());
                    }
                    let Value::Struct(members) = next else { return Vec::new() };
                    branch = members;
                }
                branch.insert(last.to_owned(), value);
            }
            (None, Value::Struct(members)) => self.root = members,
            // The root is a branch, whatever somebody wants to set it to.
            (None, _) => return Vec::new(),
        }
        self.notices(key)
    }

    /// Deletes a value or a branch; `None` where nothing is set.
    pub(super) fn delete(&mut self, key: &str) -> Option<Vec<Notice>> {
        let mut parts: Vec<_> = parts(key).collect();
        let last = parts.pop()?;
        let mut branch = &mut self.root;
        for part in parts {
            let Some(Value::Struct(members)) = branch.get_mut(part) else { return None };
            branch = members;
        }
        branch.remove(last)?;
        Some(self.notices(key))
    }

    /// The full names of all values.
    pub(super) fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        collect(&self.root, "", &mut names);
        names
    }

    /// The nearest parameter, from the node's own name upwards, whose path begins as `key` does.
    pub(super) fn search(&self, caller: &str, key: &str) -> Option<String> {
        if key.starts_with('/') {
            return self.get(key).is_some().then(|| key.to_owned());
        }
        let first = parts(key).next()?;
        let mut space = caller.trim_end_matches('/');
        loop {
            if self.get(&format!("{space}/{first}")).is_some() {
                return Some(format!("{space}/{key}"));
            }
            if space.is_empty() {
                return None;
            }
            space = namespace(space);
        }
    }

    /// Notes who wants to hear of a key; returns its value, or an empty branch.
    pub(super) fn subscribe(&mut self, key: &str, uri: &str) -> Value {
        self.listeners.entry(key.to_owned()).or_default().insert(uri.to_owned());
        self.get(key).unwrap_or_else(|| Value::Struct(BTreeMap::new()))
    }

    /// Forgets who wanted to hear of a key.
    pub(super) fn unsubscribe(&mut self, key: &str, uri: &str) -> bool {
        self.listeners.get_mut(key).is_some_and(|listeners| listeners.remove(uri))
    }

    /// Whoever listens to the key itself, to a branch above it, or to something below it, hears of it.
    fn notices(&self, changed: &str) -> Vec<Notice> {
        let is_below =
            |inner: &str, outer: &str| inner == outer || outer == "/" || inner.starts_with(&format!("{outer}/"));
        let touched = self.listeners.iter().filter(|(key, _)| is_below(changed, key) || is_below(key, changed));
        touched
            .flat_map(|(key, uris)| {
                // A listener below the change hears its own key's value; one above hears what changed.
                let told = if is_below(key, changed) { key } else { changed };
                let value = self.get(told).unwrap_or_else(|| Value::Struct(BTreeMap::new()));
                let key = format!("{}/", told.trim_end_matches('/'));
                uris.iter().map(move |uri| Notice {
                    uri: uri.clone(),
                    method: "paramUpdate",
                    parameters: vec![Value::text("/master"), Value::text(&key), value.clone()],
                })
            })
            .collect()
    }
}

fn collect(branch: &BTreeMap<String, Value>, path: &str, names: &mut Vec<String>) {
    for (key, value) in branch {
        let path = format!("{path}/{key}");
        match value {
            Value::Struct(members) => collect(members, &path, names),
            _ => names.push(path),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_branches_and_names_agree() {
        let mut parameters = Parameters::default();
        parameters.set("/a/b", Value::Integer(1));
        parameters.set("/a/c/d", Value::text("x"));
        assert_eq!(parameters.names(), ["/a/b", "/a/c/d"]);
        assert_eq!(parameters.get("/a/b"), Some(Value::Integer(1)));
        assert_eq!(parameters.get("/a/b/below"), None);
        assert!(matches!(parameters.get("/a"), Some(Value::Struct(members)) if members.len() == 2));
        parameters.set("/a", Value::Boolean(true));
        assert_eq!(parameters.names(), ["/a"]);
        parameters.set("/a/new", Value::Integer(2));
        assert_eq!(parameters.names(), ["/a/new"], "a value makes room for a branch");
        assert!(parameters.delete("/a/new").is_some() && parameters.delete("/a/new").is_none());
        assert!(parameters.set("/", Value::Integer(3)).is_empty());
    }

    #[test]
    fn a_search_goes_up_from_the_node_and_ends_without_an_answer_where_there_is_none() {
        let mut parameters = Parameters::default();
        parameters.set("/rate", Value::Integer(1));
        parameters.set("/space/rate/inner", Value::Integer(2));
        assert_eq!(parameters.search("/space/node", "rate").as_deref(), Some("/space/rate"));
        assert_eq!(parameters.search("/other/node", "rate").as_deref(), Some("/rate"));
        assert_eq!(parameters.search("/space/node", "rate/missing").as_deref(), Some("/space/rate/missing"));
        assert_eq!(parameters.search("/space/node", "nowhere"), None);
    }

    #[test]
    fn listeners_hear_of_their_key_and_of_what_is_above_and_below_it() {
        let mut parameters = Parameters::default();
        assert_eq!(parameters.subscribe("/a/b", "http://n:1/"), Value::Struct(BTreeMap::new()));
        for (key, value) in
            [("/a/b", Value::Integer(1)), ("/a/b/c", Value::Integer(2)), ("/a", Value::Struct(BTreeMap::new()))]
        {
            let notices = parameters.set(key, value);
            assert_eq!((notices.len(), notices[0].method), (1, "paramUpdate"), "{key}");
        }
        assert!(parameters.set("/ab", Value::Integer(1)).is_empty());
        assert!(parameters.unsubscribe("/a/b", "http://n:1/"));
        assert!(parameters.set("/a/b", Value::Integer(1)).is_empty());
    }
}
