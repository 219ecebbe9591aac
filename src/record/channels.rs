//! The channels of a journal: topic, type, definition and md5 sum of the ROS 1 ones.

/// A kind of ROS 1 message that a journal or a bag holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    pub(super) name: &'static str,
    pub(super) md5: &'static str,
    pub(super) definition: &'static str,
}

const ENDPOINT_STATE: Kind = Kind {
    name: "baxter_core_msgs/EndpointState",
    md5: "44bea01d596ff699fa1447bec34167ac",
    definition: include_str!("definitions/EndpointState.msg"),
};
const JOINT_STATE: Kind = Kind {
    name: "sensor_msgs/JointState",
    md5: "3066dcd76a6cfaef579bd0f34173e9fd",
    definition: include_str!("definitions/JointState.msg"),
};
/// Of release 1.2.0.
const ASSEMBLY_STATE: Kind = Kind {
    name: "baxter_core_msgs/AssemblyState",
    md5: "356d9dd237ce73b2667da9235f541933",
    definition: include_str!("definitions/AssemblyState.msg"),
};
const JOINT_COMMAND: Kind = Kind {
    name: "baxter_core_msgs/JointCommand",
    md5: "19bfec8434dd568ab3c633d187c36f2e",
    definition: include_str!("definitions/JointCommand.msg"),
};
const LOG: Kind = Kind {
    name: "rosgraph_msgs/Log",
    md5: "acffd30cd6b6de30f120938c17c593fb",
    definition: include_str!("definitions/Log.msg"),
};
const COMPRESSED_IMAGE: Kind = Kind {
    name: "sensor_msgs/CompressedImage",
    md5: "8f7a12909da2c9d3332d540a0977563f",
    definition: include_str!("definitions/CompressedImage.msg"),
};

const TRANSFORMS: Kind = Kind {
    name: "tf2_msgs/TFMessage",
    md5: "94810edda583a504dfda3829e70d7eec",
    definition: include_str!("definitions/TFMessage.msg"),
};

/// A ROS 1 channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Channel {
    pub(super) topic: &'static str,
    pub(super) kind: Kind,
}

/// All ROS 1 channels. Their order is their number in [`RosMessage::channel`](super::ros_message::RosMessage).
pub(super) const CHANNELS: [Channel; 9] = [
    Channel { topic: "/robot/limb/left/endpoint_state", kind: ENDPOINT_STATE },
    Channel { topic: "/robot/limb/right/endpoint_state", kind: ENDPOINT_STATE },
    Channel { topic: "/robot/joint_states", kind: JOINT_STATE },
    Channel { topic: "/robot/state", kind: ASSEMBLY_STATE },
    Channel { topic: "/robot/limb/left/joint_command", kind: JOINT_COMMAND },
    Channel { topic: "/robot/limb/right/joint_command", kind: JOINT_COMMAND },
    Channel { topic: "/rosout", kind: LOG },
    Channel { topic: "/camera/depth/image_raw/compressedDepth", kind: COMPRESSED_IMAGE },
    Channel { topic: "/tf", kind: TRANSFORMS },
];

/// Numbers of channels in [`CHANNELS`]; those of a side begin with the left one.
pub(super) const ENDPOINTS: usize = 0;
pub(super) const JOINTS: usize = 2;
pub(super) const STATE: usize = 3;
pub(super) const COMMANDS: usize = 4;
pub(super) const ROSOUT: usize = 6;
pub(super) const DEPTH: usize = 7;
pub(super) const BODY: usize = 8;

/// The channel with the exact record of what came in.
pub(super) const INPUT: &str = "/valet/input";
/// The channel with the exact record of what was decided.
pub(super) const EFFECT: &str = "/valet/effect";
