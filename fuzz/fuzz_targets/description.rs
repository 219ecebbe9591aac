//! Any text is an error or a robot.
#![no_main]

use valet::body::PerSide;
use valet::kinematics::{RobotModel, Tool};

libfuzzer_sys::fuzz_target!(|text: &str| {
    let _ = RobotModel::from_urdf(text, PerSide { left: Tool::default(), right: Tool::default() });
});
