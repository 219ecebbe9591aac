//! Paths and the person's arms as markers, for RViz.

use super::{BASE, Snapshot, header, point};
use crate::body::{Joint, Side};
use crate::geometry::Point;
use crate::ros::message::{
    geometry_msgs, std_msgs,
    visualization_msgs::{Marker, MarkerArray},
};

/// For how long a marker stays when no newer one comes, in seconds: what is not fresh disappears.
const LIFETIME_SECONDS: i32 = 1;
/// Thickness of lines, in metres.
const LINE: f64 = 0.01;

/// All markers of a snapshot.
pub(in crate::ros) fn all(snapshot: &Snapshot) -> MarkerArray {
    let mut markers = Vec::new();
    for (side, view) in snapshot.sides.iter() {
        let number = if side == Side::Left { 0 } else { 1 };
        let lines: [(&str, Vec<Point>, [f32; 3]); 4] = [
            ("planned", view.path.planned.to_vec(), [0.5, 0.5, 0.5]),
            ("updated", view.path.updated.to_vec(), [0.1, 0.6, 1.0]),
            ("travelled", view.path.travelled.to_vec(), [0.1, 0.8, 0.3]),
            ("arm", person(snapshot, side), [1.0, 0.6, 0.1]),
        ];
        for (name, points, colour) in lines {
            if points.len() > 1 {
                markers.push(line(snapshot, name, number, &points, colour));
            }
        }
    }
    MarkerArray { markers }
}

fn person(snapshot: &Snapshot, side: Side) -> Vec<Point> {
    let pose = snapshot.body.pose.as_ref().filter(|_| snapshot.body.freshness.is_fresh(snapshot.now));
    let arm = pose.map(|pose| pose.arms.get(side));
    Joint::DRESSED.into_iter().filter_map(|joint| arm?.position(joint)).collect()
}

fn line(snapshot: &Snapshot, name: &str, id: i32, points: &[Point], [r, g, b]: [f32; 3]) -> Marker {
    Marker {
        header: header(snapshot.now, BASE),
        ns: name.to_owned(),
        id,
        type_: i32::from(Marker::LINE_STRIP),
        action: i32::from(Marker::ADD),
        pose: geometry_msgs::Pose {
            orientation: geometry_msgs::Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
            ..Default::default()
        },
        scale: geometry_msgs::Vector3 { x: LINE, y: 0.0, z: 0.0 },
        color: std_msgs::ColorRGBA { r, g, b, a: 1.0 },
        lifetime: rosrust::Duration { sec: LIFETIME_SECONDS, nsec: 0 },
        points: points.iter().map(point).collect(),
        ..Marker::default()
    }
}
