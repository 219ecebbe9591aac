use super::*;
use crate::geometry::Finite;
use proptest::prelude::*;
use rosrust::RosMsg;

fn state(bytes: &[u8]) -> Option<RobotState> {
    robot_state(&AnyAssemblyState(bytes.to_vec()), Stamp::from_nanoseconds(7))
}

#[test]
fn both_forms_of_the_state_are_read() {
    let newer = state(&[1, 1, 0, 0, 0, 0]).unwrap();
    assert_eq!((newer.ready, newer.enabled, newer.stopped), (Some(true), true, false));
    let older = state(&[0, 1, 1, 3, 1]).unwrap();
    assert_eq!((older.ready, older.enabled, older.stopped, older.error), (None, false, true, true));
    assert_eq!((older.button, older.source), (RedButton::Released, StopSource::User));
}

#[test]
fn the_state_that_goes_out_is_the_state_that_comes_in() {
    let message = baxter_core_msgs::AssemblyState {
        ready: true,
        enabled: true,
        stopped: false,
        error: true,
        estop_button: 2,
        estop_source: 4,
    };
    let body = message.encode_vec().unwrap();
    let any = AnyAssemblyState::decode_slice(&body).unwrap();
    let state = robot_state(&any, Stamp::ZERO).unwrap();
    assert_eq!(
        (state.ready, state.error, state.button, state.source),
        (Some(true), true, RedButton::Unknown, StopSource::Brain)
    );
}

#[test]
fn joints_are_found_by_name_in_any_order_and_fingers_are_none() {
    let message = sensor_msgs::JointState {
        name: ["torso_t0", "right_w2", "left_s0", "head_pan", "left_e9"].map(String::from).to_vec(),
        position: vec![9.0, 0.5, -0.25, 1.0, 3.0],
        ..Default::default()
    };
    let sample = joints(&message).unwrap();
    assert_eq!(sample.positions.left, [Some(-0.25), None, None, None, None, None, None]);
    assert_eq!(sample.positions.right, [None, None, None, None, None, None, Some(0.5)]);
    let finger = sensor_msgs::JointState {
        name: vec!["r_gripper_l_finger_joint".into()],
        position: vec![0.01],
        ..Default::default()
    };
    assert_eq!(joints(&finger), None);
}

#[test]
fn names_without_positions_are_not_invented() {
    let message = sensor_msgs::JointState {
        name: vec!["left_s0".into(), "left_s1".into()],
        position: vec![1.0],
        ..Default::default()
    };
    assert_eq!(joints(&message).unwrap().positions.left[1], None);
}

fn image(width: u32, height: u32, step: u32, bytes: usize, encoding: &str) -> sensor_msgs::Image {
    sensor_msgs::Image { width, height, step, encoding: encoding.into(), data: vec![0; bytes], ..Default::default() }
}

#[test]
fn an_image_whose_size_and_data_disagree_is_nothing() {
    assert!(depth(image(4, 3, 8, 24, "16UC1")).is_some());
    assert!(depth(image(4, 3, 10, 30, "16UC1")).is_some(), "rows may be padded");
    for (width, height, step, bytes, encoding) in [
        (4, 3, 8, 23, "16UC1"),
        (4, 3, 4, 12, "16UC1"),
        (0, 3, 8, 24, "16UC1"),
        (4, 3, 8, 24, "rgb8"),
        (4, 3, 8, 24, "32FC1"),
        (u32::MAX, u32::MAX, u32::MAX, 1, "16UC1"),
    ] {
        assert!(depth(image(width, height, step, bytes, encoding)).is_none(), "{width}x{height} {encoding}");
    }
}

#[test]
fn a_quaternion_without_length_does_not_become_a_pose() {
    assert!(!pose(&geometry_msgs::Pose::default()).is_finite());
}

proptest! {
    #[test]
    fn a_state_of_any_length_is_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..12)) {
        let read = state(&bytes);
        prop_assert_eq!(read.is_some(), matches!(bytes.len(), 5 | 6));
    }

    #[test]
    fn bytes_of_any_kind_do_not_panic_in_a_decoder(bytes in prop::collection::vec(any::<u8>(), 4..400)) {
        // An array's length is on the wire: the transport's decoder allocates as much as it says before it reads.
        let bytes: Vec<u8> = bytes.iter().enumerate().map(|(index, byte)| if index % 4 == 3 { 0 } else { *byte }).collect();
        let _ = baxter_core_msgs::EndpointState::decode_slice(&bytes).map(|message| endpoint(Side::Left, &message));
        let _ = baxter_core_msgs::CollisionDetectionState::decode_slice(&bytes);
    }
}
