//! Names of the graph: absolute, private and relative ones.

/// A name as the graph knows it, from what a node typed: `~` is below the node, a relative name is in the node's namespace.
pub(super) fn resolve(name: &str, caller: &str) -> String {
    let joined = if name.starts_with('/') {
        name.to_owned()
    } else if let Some(private) = name.strip_prefix('~') {
        format!("/{caller}/{private}")
    } else {
        format!("/{}/{name}", namespace(caller))
    };
    let parts: Vec<_> = joined.split('/').filter(|part| !part.is_empty()).collect();
    format!("/{}", parts.join("/"))
}

/// The namespace that a node is in.
pub(super) fn namespace(caller: &str) -> &str {
    caller.trim_end_matches('/').rsplit_once('/').map_or("", |(namespace, _)| namespace)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_resolve_as_ros_resolves_them() {
        for (name, caller, expected) in [
            ("/a/b/", "/n", "/a/b"),
            ("a", "/n", "/a"),
            ("a", "/space/n", "/space/a"),
            ("~a", "/space/n", "/space/n/a"),
            ("//a//b", "/n", "/a/b"),
            ("/", "/n", "/"),
        ] {
            assert_eq!(resolve(name, caller), expected);
        }
    }
}
