//! `valet profile check` says of a profile that was written by hand whether a trial could begin with it: file and key are
//! named, and settings of a person count only together with those below them.

#![allow(clippy::unwrap_used, reason = "a test may fail loudly anywhere")]

use assert_cmd::Command;
use std::path::Path;

const BEGIN: &str = "version = 1\npseudonym = \"person-09\"\n";

/// What `profile check` answers about a profile with these lines, beside a file of settings: whether it may be used, and the words.
fn check(lines: &str, settings: &str) -> (bool, String) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let file = folder.path().join("valet").join(name);
        std::fs::create_dir_all(file.parent().unwrap_or(Path::new("."))).unwrap();
        std::fs::write(file, text).unwrap();
    };
    write("profiles/person-09.toml", &format!("{BEGIN}{lines}"));
    write("config.toml", &format!("version = 1\n{settings}"));
    let mut command = Command::cargo_bin("valet").unwrap();
    command.env("XDG_DATA_HOME", folder.path()).env("XDG_CONFIG_HOME", folder.path()).current_dir(folder.path());
    let output = command.args(["profile", "check", "person-09"]).output().unwrap();
    let words = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8(words).unwrap())
}

#[test]
fn a_profile_with_settings_that_can_be_used_is_told_with_its_file() {
    let (good, words) = check("[settings.guard.tiers]\nadvise = 9.0\n", "");
    assert!(good && words.contains("person-09.toml: everything can be used"), "{words}");
}

#[test]
fn a_setting_that_contradicts_the_ones_below_it_is_named_with_file_and_key() {
    let (good, words) = check("[settings.guard.tiers]\nadvise = 20.0\n", "");
    assert!(!good && words.contains("person-09.toml") && words.contains("advise tier"), "{words}");
}

#[test]
fn the_file_of_settings_counts_too() {
    let lines = "[settings.guard.tiers]\nadvise = 9.0\n";
    let (good, words) = check(lines, "[guard.tiers]\nslow = 8.5\n");
    assert!(!good && words.contains("slow tier"), "{words}");
}

#[test]
fn a_key_that_does_not_exist_is_named() {
    for (lines, key) in [("[settings.guard.tiers]\nadvice = 9.0\n", "advice"), ("garmants = []\n", "garmants")] {
        let (good, words) = check(lines, "");
        assert!(!good && words.contains("person-09.toml") && words.contains(key), "{words}");
    }
}
