//! The key table has no conflicts, cannot lose its stop keys, and names what is wrong with a difference.

use super::*;

fn with(name: &str, keys: &[&str]) -> Result<KeyMap, KeyMapError> {
    let names = KeyNames::Several(keys.iter().map(|key| (*key).to_owned()).collect());
    KeyMap::new(&BTreeMap::from([(name.to_owned(), names)]))
}

fn chord(text: &str) -> Chord {
    Chord::parse(text).unwrap()
}

#[test]
fn the_default_table_has_no_conflicts_and_every_action_has_a_key_and_words() {
    let map = KeyMap::new(&BTreeMap::new()).unwrap();
    for entry in TABLE {
        assert!(!map.keys_of(entry.action).is_empty(), "{}", entry.name);
        assert!(!entry.text.is_empty() && entry.action.entry().is_some(), "{}", entry.name);
    }
    let mut names: Vec<_> = TABLE.iter().map(|entry| entry.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), TABLE.len());
}

#[test]
fn the_default_keys_are_those_that_operators_know() {
    let map = KeyMap::new(&BTreeMap::new()).unwrap();
    let expected = [
        ("space", Screen::Log, Action::Stop),
        ("ctrl-c", Screen::Trial, Action::StopAndQuit),
        ("p", Screen::Trial, Action::HoldOrContinue),
        ("enter", Screen::Trial, Action::GoAhead),
        ("n", Screen::Trial, Action::NextStep),
        ("b", Screen::Trial, Action::PreviousStep),
        ("3", Screen::Log, Action::StrategyGmm),
        ("4", Screen::Force, Action::StrategyForce),
        ("5", Screen::Path, Action::StrategyMultimodal),
        ("s", Screen::Trial, Action::StrategyList),
        ("s", Screen::Log, Action::LogSolo),
        ("i", Screen::Trial, Action::NextIteration),
        ("I", Screen::Trial, Action::FinishAfterThis),
        ("w", Screen::Path, Action::Waypoints),
        ("t", Screen::Force, Action::Tare),
        ("T", Screen::Force, Action::Trial),
        ("f", Screen::Log, Action::Freeze),
        ("0", Screen::Force, Action::ZoomReset),
        ("R", Screen::Health, Action::Reset),
        ("o", Screen::Health, Action::Note),
        ("f1", Screen::Path, Action::Help),
        ("q", Screen::Path, Action::Quit),
    ];
    for (key, screen, action) in expected {
        assert_eq!(map.action(chord(key), screen), Some(action), "{key}");
    }
    assert_eq!(map.action(chord("t"), Screen::Trial), None);
}

#[test]
fn a_stop_key_can_be_added_and_never_taken_away() {
    let map = with("stop", &["f5", "~"]).unwrap();
    for key in ["space", "f5", "~"] {
        assert_eq!(map.stop(chord(key)), Some(Action::Stop), "{key}");
    }
    assert_eq!(map.stop(chord("ctrl-c")), Some(Action::StopAndQuit));
    assert_eq!(with("stop", &[]).unwrap().stop(chord("space")), Some(Action::Stop));
    assert!(matches!(with("stop", &["x"]), Err(KeyMapError::NoStopKey { .. })));
    assert!(matches!(with("stop", &["enter"]), Err(KeyMapError::NoStopKey { .. })));
}

#[test]
fn what_is_wrong_is_named() {
    let conflict = with("freeze", &["space"]).unwrap_err();
    assert!(conflict.to_string().contains("stop") && conflict.to_string().contains("freeze"), "{conflict}");
    assert_eq!(with("jump", &["x"]).unwrap_err(), KeyMapError::UnknownAction { name: "jump".into() });
    assert!(matches!(with("quit", &["hyper-x"]), Err(KeyMapError::UnknownKey { .. })));
    assert!(matches!(with("quit", &["ctrl-q"]), Err(KeyMapError::Swallowed { .. })));
}

#[test]
fn a_key_may_mean_different_things_on_different_screens_only() {
    assert!(with("log_mute", &["t"]).is_ok());
    let conflict = with("tare", &["f"]).unwrap_err();
    assert!(matches!(&conflict, KeyMapError::Conflict { place, .. } if place == "force"), "{conflict}");
}

#[test]
fn nothing_vital_needs_alt_a_function_key_or_a_multiplexers_key() {
    for entry in TABLE {
        let plain = entry.keys.iter().any(|key| !key.starts_with('f') || key.len() == 1);
        assert!(plain, "{} has function keys only", entry.name);
    }
}
