//! The definitions in `msg/` against the digests that the robot's and ROS' own software publishes.

use super::*;
use rosrust::Message;

/// Digests of Rethink's SDK 1.2.0 and of the common message packages from Indigo to Noetic.
#[test]
fn every_type_on_the_wire_has_its_published_md5() {
    let found = [
        (baxter_core_msgs::AssemblyState::md5sum(), "356d9dd237ce73b2667da9235f541933"),
        (baxter_core_msgs_1_1::AssemblyState::md5sum(), "d7ff2b9fa7d5f688665ce44db4ee2af8"),
        (baxter_core_msgs::EndpointState::md5sum(), "44bea01d596ff699fa1447bec34167ac"),
        (baxter_core_msgs::JointCommand::md5sum(), "19bfec8434dd568ab3c633d187c36f2e"),
        (baxter_core_msgs::CollisionDetectionState::md5sum(), "7bde38c182b4d08fdc0635b116f65d04"),
        (baxter_core_msgs::CollisionAvoidanceState::md5sum(), "30f5cb8ae019f1ffe8b599e6d2e589c7"),
        (baxter_core_msgs::DigitalIOState::md5sum(), "29d0be3859dae81a66b28f167ecec98c"),
        (std_msgs::Bool::md5sum(), "8b94c1b53db61fb6aed406028ad6332a"),
        (std_msgs::Empty::md5sum(), "d41d8cd98f00b204e9800998ecf8427e"),
        (std_msgs::Float64::md5sum(), "fdb28210bfa9d7c91146260178d9a584"),
        (std_msgs::UInt16::md5sum(), "1df79edf208b629fe6b81923a544552d"),
        (std_msgs::UInt32::md5sum(), "304a39449588c7f8ce2df6e8001c5fce"),
        (std_msgs::String::md5sum(), "992ce8a1687cec8c8bd883ec73ca41d1"),
        (sensor_msgs::JointState::md5sum(), "3066dcd76a6cfaef579bd0f34173e9fd"),
        (sensor_msgs::Image::md5sum(), "060021388200f6f0f447d0fcd9c64743"),
        (sensor_msgs::CameraInfo::md5sum(), "c9a58c1b0b154e0e6da7578cb991d214"),
        (geometry_msgs::PoseStamped::md5sum(), "d3812c3cbc69362b77dc0b19b345f8f5"),
        (geometry_msgs::WrenchStamped::md5sum(), "d78d3cb249ce23087ade7e7d0c40cfa7"),
        (geometry_msgs::TransformStamped::md5sum(), "b5764a33bfeb3588febc2682852579b0"),
        (tf2_msgs::TFMessage::md5sum(), "94810edda583a504dfda3829e70d7eec"),
        (nav_msgs::Path::md5sum(), "6227e2b7e9cce15051f669a5e197bbf7"),
        (visualization_msgs::MarkerArray::md5sum(), "d155b9ce5188fbaf89745847fd5882d7"),
        (diagnostic_msgs::DiagnosticArray::md5sum(), "60810da900de1dd6ddd437c3503511da"),
        (rosgraph_msgs::Log::md5sum(), "acffd30cd6b6de30f120938c17c593fb"),
        (std_srvs::Trigger::md5sum(), "937c9679a518e3a18d831e57125ea522"),
        (trajectory_msgs::JointTrajectory::md5sum(), "65b4f94a94d1ed67169da35a02f33d3f"),
    ];
    for (index, (found, published)) in found.iter().enumerate() {
        assert_eq!(found, published, "type number {index} of the list");
    }
}

#[test]
fn types_carry_the_names_that_peers_expect() {
    assert_eq!(baxter_core_msgs::EndpointState::msg_type(), "baxter_core_msgs/EndpointState");
    assert_eq!(std_srvs::Trigger::msg_type(), "std_srvs/Trigger");
}
