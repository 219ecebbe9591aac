//! Requirement S-38: no bytes, whatever they are, bring down a decoder or a file reader.

#![allow(clippy::indexing_slicing, reason = "a test may fail loudly anywhere")]

use proptest::prelude::*;
use std::io::Write;
use std::path::Path;
use valet::body::PerSide;
use valet::config::Settings;
use valet::kinematics::{RobotModel, Tool};
use valet::supervisor::Input;

/// Bytes that are nearly a valid text: the text with some of it cut out, doubled or replaced.
fn damaged(text: &'static str) -> impl Strategy<Value = String> {
    let length = text.len();
    (0..=length, 0..=length, proptest::collection::vec(any::<u8>(), 0..16)).prop_map(move |(from, to, put)| {
        let (from, to) = (from.min(to), from.max(to));
        let mut bytes = text.as_bytes()[..from].to_vec();
        bytes.extend(put);
        bytes.extend(&text.as_bytes()[to..]);
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

const SETTINGS: &str = "[supervisor.window]\nlength = 15\nthreshold_newtons = 5.0\nform = \"vector\"\n";
const INPUT: &str = r#"{"operator":{"command":{"set_setting":{"key":"window.threshold_newtons","value":5.0}},"origin":"operator_key"}}"#;

proptest! {
    #[test]
    fn s_38_a_damaged_settings_file_is_an_error_or_settings(text in damaged(SETTINGS)) {
        let _ = Settings::parse(Path::new("settings.toml"), &text);
    }

    #[test]
    fn s_38_a_damaged_input_is_an_error_or_an_input(text in damaged(INPUT)) {
        let _ = serde_json::from_str::<Input>(&text);
    }

    #[test]
    fn s_38_any_bytes_are_an_error_or_an_input(bytes in proptest::collection::vec(any::<u8>(), 0..512)) {
        let _ = serde_json::from_slice::<Input>(&bytes);
    }

    #[test]
    fn s_38_any_bytes_are_an_error_or_a_journal(bytes in proptest::collection::vec(any::<u8>(), 0..2048)) {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(&bytes).unwrap();
        let _ = valet::record::read(file.path(), |_, _| {});
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn s_38_a_damaged_robot_description_is_an_error_or_a_robot(text in damaged(valet::kinematics::BAXTER_URDF)) {
        let _ = RobotModel::from_urdf(&text, PerSide { left: Tool::default(), right: Tool::default() });
    }
}
