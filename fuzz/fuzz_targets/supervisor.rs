//! The supervisor takes any inputs, one a line, in any order.
#![no_main]

use valet::kinematics::RobotModel;
use valet::supervisor::{Input, Setup, Supervisor};
use valet::time::Stamp;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let model = RobotModel::baxter().expect("the shipped robot");
    let mut supervisor = Supervisor::new(Setup::default(), model).expect("the defaults");
    for (index, line) in text.lines().enumerate() {
        if let Ok(input) = serde_json::from_str::<Input>(line) {
            supervisor.step(Stamp::from_nanoseconds(index as u64 * 10_000_000), &input);
        }
    }
});
