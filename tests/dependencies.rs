//! Licences, sources and versions of everything that valet is built from, judged by the lists of `deny.toml`.
//!
//! Needs no network and no tool beyond cargo. It judges what manifests declare: `cargo deny` also reads licence texts and the
//! advisory database, which this never does.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail loudly anywhere")]

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// What `cargo metadata` tells of every package of `Cargo.lock`, for every system and feature.
fn packages() -> Vec<Value> {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    let arguments = ["metadata", "--format-version", "1", "--locked", "--offline", "--manifest-path"];
    let told = Command::new(env!("CARGO")).args(arguments).arg(manifest).output().unwrap();
    assert!(told.status.success(), "{}", String::from_utf8_lossy(&told.stderr));
    let told: Value = serde_json::from_slice(&told.stdout).unwrap();
    told.get("packages").and_then(Value::as_array).unwrap().clone()
}

fn list(table: &str, key: &str) -> Vec<String> {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("deny.toml")).unwrap();
    let rules: toml::Table = text.parse().unwrap();
    let entries = rules.get(table).and_then(|table| table.get(key)).and_then(toml::Value::as_array).unwrap();
    entries.iter().map(|entry| entry.as_str().unwrap().to_owned()).collect()
}

fn text<'a>(package: &'a Value, key: &str) -> &'a str {
    package.get(key).and_then(Value::as_str).unwrap_or_default()
}

/// Whether a licence expression (SPDX; `/` is the old way to write OR) is met by allowed licences alone.
fn is_met(expression: &str, allowed: &[String]) -> bool {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = words.as_slice();
    let met = any_of(&mut rest, allowed);
    met && rest.is_empty()
}

fn any_of(words: &mut &[&str], allowed: &[String]) -> bool {
    let mut met = all_of(words, allowed);
    while let Some(("OR", rest)) = words.split_first().map(|(word, rest)| (*word, rest)) {
        *words = rest;
        // Both sides are read, whatever the first one brought.
        met |= all_of(words, allowed);
    }
    met
}

fn all_of(words: &mut &[&str], allowed: &[String]) -> bool {
    let mut met = one(words, allowed);
    while let Some(("AND", rest)) = words.split_first().map(|(word, rest)| (*word, rest)) {
        *words = rest;
        met &= one(words, allowed);
    }
    met
}

fn one(words: &mut &[&str], allowed: &[String]) -> bool {
    let Some((first, rest)) = words.split_first() else { return false };
    *words = rest;
    if *first == "(" {
        let met = any_of(words, allowed);
        let closed = words.first() == Some(&")");
        *words = words.get(1..).unwrap_or_default();
        return met && closed;
    }
    let mut licence = (*first).to_owned();
    if let ["WITH", exception, rest @ ..] = *words {
        licence = format!("{licence} WITH {exception}");
        *words = rest;
    }
    allowed.contains(&licence)
}

#[test]
fn expressions_are_read_as_spdx_says() {
    let allowed = ["MIT", "Zlib", "Apache-2.0 WITH LLVM-exception"].map(String::from);
    for met in
        ["MIT", "GPL-3.0 OR MIT", "GPL-3.0/MIT", "MIT AND Zlib", "(GPL-3.0 OR MIT) AND Zlib", "GPL-3.0 OR MIT AND Zlib"]
    {
        assert!(is_met(met, &allowed), "{met}");
    }
    assert!(is_met("Apache-2.0 WITH LLVM-exception OR GPL-3.0", &allowed));
    for unmet in
        ["", "GPL-3.0", "MIT AND GPL-3.0", "(MIT OR Zlib) AND GPL-3.0", "Apache-2.0", "MIT Zlib", "(MIT", "MIT AND"]
    {
        assert!(!is_met(unmet, &allowed), "{unmet}");
    }
}

#[test]
fn every_licence_is_allowed() {
    let allowed = list("licenses", "allow");
    let packages = packages();
    assert!(packages.len() > 100, "{} packages", packages.len());
    let refused: Vec<_> = packages
        .iter()
        .filter(|package| !is_met(text(package, "license"), &allowed))
        .map(|package| (text(package, "name"), text(package, "license")))
        .collect();
    assert!(refused.is_empty(), "{refused:?}");
}

#[test]
fn everything_comes_from_an_allowed_source() {
    let allowed: Vec<String> =
        list("sources", "allow-registry").into_iter().map(|address| format!("registry+{address}")).collect();
    for package in packages() {
        let (name, source) = (text(&package, "name"), text(&package, "source"));
        assert!(
            name == "valet" && source.is_empty() || allowed.iter().any(|allowed| allowed == source),
            "{name} from {source:?}"
        );
    }
}

#[test]
fn nothing_is_asked_for_in_any_version_and_nothing_banned_is_used() {
    let packages = packages();
    let valet = packages.iter().find(|package| text(package, "name") == "valet").unwrap();
    for dependency in valet.get("dependencies").and_then(Value::as_array).unwrap() {
        assert_ne!(text(dependency, "req"), "*", "{}", text(dependency, "name"));
    }
    let banned = list("bans", "deny");
    for package in &packages {
        let name = text(package, "name");
        assert!(!banned.iter().any(|banned| banned == name), "{name} is banned");
    }
}
