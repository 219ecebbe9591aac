//! Any bytes on the wire are an error or a message, and any message is nothing or an input.
#![no_main]

use rosrust::RosMsg;
use valet::body::Side;
use valet::ros::checked::Checked;
use valet::ros::decode::{self, AnyAssemblyState};
use valet::ros::message::{baxter_core_msgs, sensor_msgs, tf2_msgs};
use valet::time::Stamp;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((kind, bytes)) = bytes.split_first() else { return };
    match kind % 5 {
        0 => {
            if let Ok(state) = AnyAssemblyState::decode(bytes) {
                let _ = decode::robot_state(&state, Stamp::ZERO);
            }
        }
        1 => {
            if let Ok(Checked(message)) = Checked::<baxter_core_msgs::EndpointState>::decode(bytes) {
                let _ = decode::endpoint(Side::Left, &message);
            }
        }
        2 => {
            if let Ok(Checked(message)) = Checked::<sensor_msgs::JointState>::decode(bytes) {
                let _ = decode::joints(&message);
            }
        }
        3 => {
            if let Ok(Checked(message)) = Checked::<sensor_msgs::Image>::decode(bytes)
                && let Some(frame) = decode::depth(message)
            {
                let _ = frame.image();
            }
        }
        _ => {
            let _ = Checked::<tf2_msgs::TFMessage>::decode(bytes);
        }
    }
});
