//! Holds the code to the table of rooms and edges in `docs/architecture.md`.

#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may fail loudly anywhere")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

const GROUND_FLOOR: [&str; 4] = ["time", "geometry", "body", "assembly"];
const PURE_CORE: [&str; 15] = [
    "time",
    "geometry",
    "body",
    "assembly",
    "sensing",
    "vision",
    "modelling",
    "planning",
    "strategy",
    "kinematics",
    "safety",
    "sequencing",
    "command",
    "snapshot",
    "supervisor",
];
/// What the pure core may not touch: clocks, files, sockets, threads, and randomness that is not seeded.
const IMPURE: [&str; 10] = [
    "Instant::now",
    "SystemTime::now",
    "std::fs",
    "std::net",
    "std::thread",
    "thread::spawn",
    "std::io::",
    "std::process",
    "rand::rng(",
    "thread_rng",
];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The table of rooms: name -> rooms it may use.
fn table() -> BTreeMap<String, BTreeSet<String>> {
    let text = fs::read_to_string(root().join("docs/architecture.md")).unwrap();
    let section = text.split("## Rooms and edges").nth(1).unwrap().split("\n## ").next().unwrap();
    section
        .lines()
        .filter(|line| line.starts_with("| ") && !line.starts_with("| room"))
        .map(|line| {
            let cells: Vec<_> = line.trim_matches('|').split('|').map(str::trim).collect();
            (cells[0].to_owned(), cells[2].split_whitespace().map(str::to_owned).collect())
        })
        .collect()
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The room that a file under `src/` belongs to; `None` for `lib.rs` and `main.rs`.
fn room_of(file: &Path) -> Option<String> {
    let inside = file.strip_prefix(root().join("src")).unwrap();
    let first = inside.components().next().unwrap().as_os_str().to_str().unwrap();
    let room = first.strip_suffix(".rs").unwrap_or(first);
    (!["lib", "main"].contains(&room)).then(|| room.to_owned())
}

/// The file without comments and without inline test modules, which may use what they like.
fn production_code(file: &Path) -> String {
    let text = fs::read_to_string(file).unwrap();
    let without_tests = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    without_tests.lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n")
}

fn is_test_file(file: &Path) -> bool {
    file.file_name().is_some_and(|name| name == "tests.rs") || file.components().any(|part| part.as_os_str() == "tests")
}

/// Every `crate::room` that a text names, also inside `crate::{a::b, c}`.
fn rooms_named(code: &str) -> BTreeSet<String> {
    let mut named = BTreeSet::new();
    for (start, _) in code.match_indices("crate::") {
        let rest = &code[start + "crate::".len()..];
        if let Some(group) = rest.strip_prefix('{') {
            let mut depth = 0;
            let mut word = String::new();
            let mut fresh = true;
            for letter in group.chars() {
                match letter {
                    '{' => depth += 1,
                    '}' if depth == 0 => break,
                    '}' => depth -= 1,
                    ',' if depth == 0 => fresh = true,
                    letter if letter.is_alphanumeric() || letter == '_' => {
                        if fresh && depth == 0 {
                            word.push(letter);
                        }
                    }
                    _ => {
                        if !word.is_empty() {
                            named.insert(std::mem::take(&mut word));
                            fresh = false;
                        }
                    }
                }
            }
            if !word.is_empty() {
                named.insert(word);
            }
        } else {
            named.insert(rest.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect());
        }
    }
    named
}

fn production_files() -> impl Iterator<Item = (String, PathBuf)> {
    rust_files(&root().join("src"))
        .into_iter()
        .filter(|file| !is_test_file(file))
        .filter_map(|file| room_of(&file).map(|room| (room, file)))
}

#[test]
fn every_room_is_in_the_table_and_every_edge_is_allowed() {
    let table = table();
    let mut wrong = Vec::new();
    for (room, file) in production_files() {
        let Some(allowed) = table.get(&room) else {
            wrong.push(format!("{}: the room `{room}` is not in docs/architecture.md", file.display()));
            continue;
        };
        for used in rooms_named(&production_code(&file)) {
            let known = table.contains_key(&used);
            let fine = used == room
                || GROUND_FLOOR.contains(&used.as_str())
                || allowed.contains(&used)
                || allowed.contains("*");
            if known && !fine {
                wrong.push(format!("{}: `{room}` uses `{used}`", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "edges that docs/architecture.md does not have:\n{}", wrong.join("\n"));
}

#[test]
fn the_table_names_only_rooms_that_exist() {
    for room in table().keys() {
        assert!(root().join(format!("src/{room}.rs")).exists(), "src/{room}.rs does not exist");
    }
}

#[test]
fn rosrust_is_used_in_ros_alone_and_the_terminal_in_console_alone() {
    for (room, file) in production_files() {
        let code = production_code(&file);
        assert!(room == "ros" || !code.contains("rosrust"), "{} uses rosrust", file.display());
        let terminal = code.contains("ratatui") || code.contains("crossterm");
        assert!(room == "console" || !terminal, "{} uses ratatui or crossterm", file.display());
    }
}

#[test]
fn the_pure_core_touches_no_clock_file_socket_thread_or_unseeded_randomness() {
    for (room, file) in production_files().filter(|(room, _)| PURE_CORE.contains(&room.as_str())) {
        let code = production_code(&file);
        for forbidden in IMPURE {
            assert!(!code.contains(forbidden), "{}: `{room}` is pure but names {forbidden}", file.display());
        }
    }
}

#[test]
fn no_module_is_called_mod_rs() {
    let found = rust_files(&root().join("src")).into_iter().find(|file| file.ends_with("mod.rs"));
    assert_eq!(found, None);
}

#[test]
fn nothing_says_unwrap_expect_or_todo_outside_tests() {
    let mut wrong = Vec::new();
    for (_, file) in production_files() {
        let code = production_code(&file);
        for forbidden in [".unwrap()", ".expect(", "todo!(", "unimplemented!(", "#[ignore"] {
            if code.contains(forbidden) {
                wrong.push(format!("{}: {forbidden}", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_reader_of_use_lines_sees_groups_and_single_paths() {
    let code = "use crate::{body::{Side, Joint}, time::Stamp};\nuse crate::safety;\nlet x = crate::strategy::build();";
    let expected: BTreeSet<String> = ["body", "time", "safety", "strategy"].map(String::from).into();
    assert_eq!(rooms_named(code), expected);
}
