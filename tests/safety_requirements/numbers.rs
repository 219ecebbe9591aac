//! Every requirement of `docs/safety.md` has a test of its own, and no test bears a number that is not there.

use std::path::Path;

/// Every file of tests: those of the rooms and those of the whole.
fn sources(folder: &Path, found: &mut String) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs" || extension == "py") {
            found.push_str(&std::fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn every_requirement_has_a_test_that_bears_its_number() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let document = std::fs::read_to_string(root.join("docs/safety.md")).unwrap();
    let ids: Vec<&str> = document.lines().filter_map(|line| line.strip_prefix("| S-")?.get(..2)).collect();
    assert!(ids.len() >= 41, "the table of requirements was read: {ids:?}");
    let mut tests = String::new();
    ["src", "tests"].iter().for_each(|folder| sources(&root.join(folder), &mut tests));
    let missing: Vec<&&str> = ids.iter().filter(|id| !tests.contains(&format!("fn s_{id}_"))).collect();
    assert!(missing.is_empty(), "requirements without a test of their own: {missing:?}");
    // And no test bears a number that the document does not have.
    let tested = tests.match_indices("fn s_").filter_map(|(at, _)| tests.get(at + 5..at + 7));
    let unknown: Vec<&str> = tested.filter(|id| id.parse::<u32>().is_ok() && !ids.contains(id)).collect();
    assert!(unknown.is_empty(), "tests of requirements that are not in docs/safety.md: {unknown:?}");
}
