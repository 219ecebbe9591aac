//! Paths, resistance, the movement space and the person's arms as markers, for RViz.

use super::{BASE, Snapshot, header, point};
use crate::body::{Joint, Side};
use crate::geometry::Point;
use crate::ros::message::{
    geometry_msgs, std_msgs,
    visualization_msgs::{Marker, MarkerArray},
};
use crate::snapshot::{EllipseView, PathView};
use nalgebra::{Matrix3, Rotation3, SymmetricEigen, UnitQuaternion};

/// For how long a marker stays when no newer one comes, in seconds: what is not fresh disappears.
const LIFETIME_SECONDS: i32 = 1;
/// Thickness of lines, in metres.
const LINE: f64 = 0.01;
/// Diameter of the balls where the garment was held up, in metres.
const BALL: f64 = 0.03;
/// Half axes of the ellipsoids, in deviations, as in the thesis' figures.
const DEVIATIONS: f64 = 2.0;
/// Opacity of the heaviest ellipsoid; lighter components are fainter.
const HEAVIEST: f32 = 0.4;

/// All markers of a snapshot.
pub(in crate::ros) fn all(snapshot: &Snapshot) -> MarkerArray {
    let mut markers = Vec::new();
    for (side, view) in snapshot.sides.iter() {
        let number = i32::from(side != Side::Left);
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
        markers.extend(resistance(snapshot, number, &view.path));
        markers.extend(ellipsoids(snapshot, number, &view.path));
    }
    MarkerArray { markers }
}

fn person(snapshot: &Snapshot, side: Side) -> Vec<Point> {
    let pose = snapshot.body.pose.as_ref().filter(|_| snapshot.body.freshness.is_fresh(snapshot.now));
    let arm = pose.map(|pose| pose.arms.get(side));
    Joint::DRESSED.into_iter().filter_map(|joint| arm?.position(joint)).collect()
}

fn marker(snapshot: &Snapshot, name: &str, id: i32, kind: u8, [r, g, b]: [f32; 3], a: f32) -> Marker {
    Marker {
        header: header(snapshot.now, BASE),
        ns: name.to_owned(),
        id,
        type_: i32::from(kind),
        action: i32::from(Marker::ADD),
        pose: geometry_msgs::Pose {
            orientation: geometry_msgs::Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
            ..Default::default()
        },
        color: std_msgs::ColorRGBA { r, g, b, a },
        lifetime: rosrust::Duration { sec: LIFETIME_SECONDS, nsec: 0 },
        ..Marker::default()
    }
}

fn line(snapshot: &Snapshot, name: &str, id: i32, points: &[Point], colour: [f32; 3]) -> Marker {
    Marker {
        scale: geometry_msgs::Vector3 { x: LINE, y: 0.0, z: 0.0 },
        points: points.iter().map(point).collect(),
        ..marker(snapshot, name, id, Marker::LINE_STRIP, colour, 1.0)
    }
}

/// Balls where way-points gave way to resistance in this trial.
fn resistance(snapshot: &Snapshot, id: i32, path: &PathView) -> Option<Marker> {
    let felt = path.changes.iter().filter(|change| change.force.norm() > 0.0);
    let points: Vec<_> = felt.map(|change| point(&change.old)).collect();
    (!points.is_empty()).then(|| Marker {
        scale: geometry_msgs::Vector3 { x: BALL, y: BALL, z: BALL },
        points,
        ..marker(snapshot, "resistance", id, Marker::SPHERE_LIST, [0.84, 0.37, 0.0], 1.0)
    })
}

/// The components of the movement space, two deviations wide. Numbers of the right arm begin at a thousand.
fn ellipsoids<'a>(snapshot: &'a Snapshot, number: i32, path: &'a PathView) -> impl Iterator<Item = Marker> + 'a {
    let heaviest = path.ellipses.iter().map(|ellipse| ellipse.weight).fold(f64::MIN_POSITIVE, f64::max);
    let ids = number * 1000..;
    ids.zip(path.ellipses.iter()).filter_map(move |(id, ellipse)| ellipsoid(snapshot, id, ellipse, heaviest))
}

fn ellipsoid(snapshot: &Snapshot, id: i32, ellipse: &EllipseView, heaviest: f64) -> Option<Marker> {
    let covariance = Matrix3::from_fn(|row, column| {
        ellipse.covariance.get(row).and_then(|values| values.get(column)).copied().unwrap_or(f64::NAN)
    });
    if !covariance.iter().all(|value| value.is_finite()) {
        return None;
    }
    let axes = SymmetricEigen::new(covariance);
    let mut turned = axes.eigenvectors;
    // Three axes from an eigensolver may be a mirror image, which no rotation reaches.
    if turned.determinant() < 0.0 {
        turned.column_mut(2).neg_mut();
    }
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turned));
    let widths = axes.eigenvalues.map(|variance| 2.0 * DEVIATIONS * variance.max(0.0).sqrt());
    let share = (ellipse.weight / heaviest).clamp(0.1, 1.0);
    #[expect(clippy::cast_possible_truncation, reason = "an opacity from 0 to 1")]
    let opacity = HEAVIEST * share as f32;
    let (name, colour) = looks(ellipse.joint);
    Some(Marker {
        pose: geometry_msgs::Pose {
            position: point(&ellipse.mean),
            orientation: geometry_msgs::Quaternion { x: rotation.i, y: rotation.j, z: rotation.k, w: rotation.w },
        },
        scale: geometry_msgs::Vector3 { x: widths.x, y: widths.y, z: widths.z },
        ..marker(snapshot, name, id, Marker::SPHERE, colour, opacity)
    })
}

const fn looks(joint: Joint) -> (&'static str, [f32; 3]) {
    match joint {
        Joint::Elbow | Joint::Forearm => ("space of the elbow", [0.9, 0.62, 0.0]),
        Joint::Shoulder | Joint::UpperArm => ("space of the shoulder", [0.8, 0.47, 0.65]),
        Joint::Hand | Joint::Wrist => ("space of the hand", [0.34, 0.71, 0.91]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::WaypointRow;

    fn snapshot(ellipses: Vec<EllipseView>, changes: Vec<WaypointRow>) -> Snapshot {
        let mut snapshot = Snapshot::default();
        snapshot.sides.right.path.ellipses = ellipses.into();
        snapshot.sides.right.path.changes = changes.into();
        snapshot
    }

    fn ellipse(covariance: [[f64; 3]; 3]) -> EllipseView {
        EllipseView { joint: Joint::Elbow, weight: 0.5, mean: Point::new(0.7, -0.3, 0.1), covariance }
    }

    #[test]
    fn an_ellipsoid_has_the_width_of_four_deviations_along_its_own_axes() {
        // A long axis of 0.1 m deviation along x + y, 0.02 m across and upwards.
        let (long, short) = (0.01, 0.0004);
        let (sum, difference) = (f64::midpoint(long, short), (long - short) / 2.0);
        let covariance = [[sum, difference, 0.0], [difference, sum, 0.0], [0.0, 0.0, short]];
        let markers = all(&snapshot(vec![ellipse(covariance)], Vec::new())).markers;
        let [marker] = markers.as_slice() else { panic!("{markers:?}") };
        let widths = [marker.scale.x, marker.scale.y, marker.scale.z];
        let longest = (0..3).max_by(|left, right| widths[*left].total_cmp(&widths[*right])).unwrap();
        assert!((widths[longest] - 0.4).abs() < 1e-9, "{widths:?}");
        let turn = &marker.pose.orientation;
        let turn = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(turn.w, turn.x, turn.y, turn.z));
        let mut axis = nalgebra::Vector3::zeros();
        axis[longest] = 1.0;
        let along = turn * axis;
        assert!((along.x.abs() - 0.5_f64.sqrt()).abs() < 1e-6 && (along.x - along.y).abs() < 1e-6, "{along}");
        assert_eq!((marker.id, marker.ns.as_str()), (1000, "space of the elbow"));
    }

    #[test]
    fn a_number_that_is_not_finite_draws_nothing() {
        assert!(all(&snapshot(vec![ellipse([[f64::NAN; 3]; 3])], Vec::new())).markers.is_empty());
    }

    #[test]
    fn balls_stand_where_resistance_was_felt_and_nowhere_else() {
        let row = |force: f64| WaypointRow {
            index: 1,
            iteration: 1,
            old: Point::new(force, 0.0, 0.0),
            new: Point::origin(),
            force: crate::geometry::Vector::new(force, 0.0, 0.0),
            reason: String::new(),
        };
        let markers = all(&snapshot(Vec::new(), vec![row(6.0), row(0.0)])).markers;
        let [marker] = markers.as_slice() else { panic!("{markers:?}") };
        assert_eq!(marker.ns, "resistance");
        assert_eq!(marker.points.iter().map(|place| place.x).collect::<Vec<_>>(), [6.0]);
    }
}
