//! What needs a ROS master says so where none answers, with the address and what to do, and ends; nothing waits, nothing moves.

#![allow(clippy::unwrap_used, reason = "a test may fail loudly anywhere")]

use assert_cmd::Command;

/// Port 9 is that of the discard service: no master listens there.
const NOBODY: &str = "http://127.0.0.1:9/";

fn told_by(arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::cargo_bin("valet").unwrap();
    let output = command.args(arguments).env("ROS_MASTER_URI", NOBODY).env("ROS_IP", "127.0.0.1").output().unwrap();
    (output.status.code(), String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned())
}

#[test]
fn a_node_a_watcher_a_simulator_and_the_doctor_name_the_address_and_what_to_do() {
    for arguments in [&["console", "--headless", "--no-record"][..], &["console", "--watch"], &["sim"], &["doctor"]] {
        let (code, told) = told_by(arguments);
        assert!(!matches!(code, None | Some(0)), "{arguments:?} ended with {code:?}: {told}");
        assert!(told.contains("no ROS master answers at http://127.0.0.1:9"), "{arguments:?}: {told}");
        assert!(told.contains("start roscore"), "{arguments:?}: {told}");
        assert!(!told.contains("panicked"), "{arguments:?}: {told}");
    }
}
