//! The messages on the wire, made from the definitions in `msg/`.
//!
//! Nothing here converts or judges: `decode` and `encode` do that. One message cannot be made from a definition alone: the
//! robot's state, of which two forms are in use.

#![allow(clippy::all, clippy::pedantic, missing_docs, reason = "the generated code follows its generator's habits")]

rosrust::rosmsg_include!(
    baxter_core_msgs / AssemblyState,
    baxter_core_msgs_1_1 / AssemblyState,
    baxter_core_msgs / EndpointState,
    baxter_core_msgs / JointCommand,
    baxter_core_msgs / CollisionDetectionState,
    baxter_core_msgs / CollisionAvoidanceState,
    baxter_core_msgs / DigitalIOState,
    geometry_msgs / PoseStamped,
    geometry_msgs / WrenchStamped,
    geometry_msgs / TransformStamped,
    sensor_msgs / JointState,
    sensor_msgs / Image,
    sensor_msgs / CameraInfo,
    std_msgs / Bool,
    std_msgs / Empty,
    std_msgs / Float64,
    std_msgs / String,
    std_msgs / UInt16,
    std_msgs / UInt32,
    tf2_msgs / TFMessage,
    nav_msgs / Path,
    visualization_msgs / MarkerArray,
    diagnostic_msgs / DiagnosticArray,
    rosgraph_msgs / Log,
    std_srvs / Trigger,
    trajectory_msgs / JointTrajectory,
    moveit_msgs / GetCartesianPath,
    moveit_msgs_melodic / GetCartesianPath,
    valet_msgs / State,
    valet_msgs / Force,
    valet_msgs / Snapshot
);

#[cfg(test)]
mod tests;
