//! Profiles edited by hand: every mistake is named with file and key.

use super::*;
use crate::config::{ConfigError, Places, profile_names};
use std::path::Path;

const SMALLEST: &str = "version = 1\npseudonym = \"p-01\"\n";

fn parse(text: &str) -> Result<LoadedProfile, ConfigError> {
    LoadedProfile::parse(Path::new("p-01.toml"), text)
}

fn complaint(text: &str) -> String {
    parse(text).unwrap_err().to_string()
}

fn places(folder: &Path) -> Places {
    Places {
        settings: vec![],
        profiles: vec![folder.into()],
        trials: folder.into(),
        demos: folder.into(),
        logs: folder.into(),
    }
}

#[test]
fn the_built_in_profiles_are_usable_and_written_back_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let places = places(folder.path());
    let names = profile_names(&places);
    assert!(names.contains(&"default".to_owned()));
    for name in names {
        let loaded = LoadedProfile::find(&name, &places).unwrap();
        assert_eq!(loaded.hash.len(), 64);
        let written = toml::to_string(&loaded.profile).unwrap();
        assert_eq!(parse(&written).unwrap().profile, loaded.profile, "{name}");
    }
}

#[test]
fn the_smallest_profile_is_a_pseudonym() {
    let loaded = parse(SMALLEST).unwrap();
    assert_eq!(loaded.profile.pseudonym, "p-01");
    assert_eq!(loaded.short_hash().len(), 12);
}

fn learned(waypoints: &str) -> String {
    format!(
        "version = 1\npseudonym = \"p-01\"\n[[learned]]\nside = \"right\"\nstrategy = \"force\"\ntrial = \"p-01-001\"\n\
         energy_newtons = 0.0\nwaypoints = {waypoints}"
    )
}

/// A profile with the colours of clothes, the left shoulder's to be chosen.
fn clothed(shoulder: &str) -> String {
    format!(
        "version = 1\npseudonym = \"p-01\"\n[clothes.left]\nshoulder = {shoulder}\nupper_arm = [30, 200, 30]\n\
         forearm = [30, 30, 220]\nhand = [220, 220, 30]\n[clothes.right]\nshoulder = [220, 30, 220]\n\
         upper_arm = [30, 220, 220]\nforearm = [240, 240, 240]\nhand = [90, 60, 20]\n"
    )
}

#[test]
fn clothes_that_can_be_told_apart_are_read() {
    let clothes = parse(&clothed("[220, 30, 30]")).unwrap().profile.clothes.unwrap();
    assert_eq!(super::sample_colours(&clothes).0[0], [220, 30, 30]);
}

#[test]
fn mistakes_are_named_with_file_and_key() {
    let cases = [
        ("pseudonym = \"p-01\"", "version"),
        ("version = 1\npseudonym = \"Mary Smith\"", "pseudonym"),
        ("version = 1\npseudonym = \"p-01\"\nname = \"x\"", "name"),
        ("version = 1\npseudonym = \"p-01\"\nfirst_arm = \"upper\"", "first_arm"),
        ("version = 1\npseudonym = \"p-01\"\nshoe_size = 44", "shoe_size"),
        ("version = 1\npseudonym = \"p-01\"\n[consent]\nversion = \"2\"\ndate = \"yesterday\"", "consent.date"),
        ("version = 1\npseudonym = \"p-01\"\n[consent]\nversion = \"\"\ndate = \"2026-11-22\"", "consent.version"),
        ("version = 1\npseudonym = \"p-01\"\n[simulated.body]\nstature_metres = 17.5", "stature_metres"),
        ("version = 1\npseudonym = \"p-01\"\n[[garments]]\nname = \"\"", "garments[0].name"),
        (&clothed("[220, 30, 300]"), "shoulder"),
        (&clothed("[30, 200, 31]"), "clothes"),
        (&learned("[]"), "learned[0].waypoints"),
        (&learned("[[0, 0.0, [0, 0, 0]], [1, 9.0, [0, 0, 0]]]"), "learned[0].waypoints[1]"),
        (&learned("[[0, 0.0, [0, 0, 0]], [0, 0.0, [0, 0, 0]], [1, 1.0, [0, 0, 0]]]"), "learned[0].waypoints[1]"),
        ("version = \"one\"\npseudonym = \"p-01\"", "version"),
        ("version = 1\npseudonym = ", "pseudonym"),
    ];
    for (text, key) in cases {
        let words = complaint(text);
        assert!(words.contains("p-01.toml") && words.contains(key), "{text}: {words}");
    }
}

#[test]
fn a_later_version_is_refused_before_anything_else() {
    let words = complaint("version = 7\nwhatever = true");
    assert!(words.contains("version") && words.contains('7') && words.contains("newer valet"), "{words}");
}

#[test]
fn a_profile_that_is_not_there_says_where_it_was_looked_for() {
    let folder = tempfile::tempdir().unwrap();
    let words = LoadedProfile::find("nobody", &places(folder.path())).unwrap_err().to_string();
    assert!(words.contains("nobody") && words.contains(folder.path().to_str().unwrap()) && words.contains("default"));
}

#[test]
fn a_file_beats_the_built_in_profile_of_the_same_name() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("default.toml"), SMALLEST).unwrap();
    let loaded = LoadedProfile::find("default", &places(folder.path())).unwrap();
    assert_eq!(loaded.profile.pseudonym, "p-01");
}

#[test]
fn an_encrypted_or_foreign_file_is_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p-01.toml.age");
    std::fs::write(&path, "age-encryption.org/v1\n-> scrypt").unwrap();
    assert!(matches!(LoadedProfile::read(&path, None), Err(ConfigError::Encrypted { .. })));
    std::fs::write(&path, [0xff, 0xfe, 0x00]).unwrap();
    assert!(LoadedProfile::read(&path, None).unwrap_err().to_string().contains("UTF-8"));
}

#[test]
fn the_hash_follows_the_text() {
    assert_ne!(parse(SMALLEST).unwrap().hash, parse(&format!("{SMALLEST}notes = \"x\"\n")).unwrap().hash);
    assert_eq!(parse(SMALLEST).unwrap().hash, parse(SMALLEST).unwrap().hash);
}
