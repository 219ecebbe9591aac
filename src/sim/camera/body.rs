//! A seated person as solids in the camera frame, with the joints' true places and the true part of each surface point.

use super::look::Look;
use super::shape::Shape;
use crate::body::{Joint, PerSide, Side};
use crate::geometry::{Point, Pose, Vector};
use crate::sim::person::ArmPoints;
use crate::vision::part::{OTHER, Part, SHOULDER_SHARE};
use nalgebra::Matrix3;

/// Radius of the muscles between neck and shoulders, in metres: the neck's root is where they end.
const NECK_MUSCLES: f64 = 0.05;

/// What a solid belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Region {
    Torso,
    UpperArm(Side),
    Forearm(Side),
    Hand(Side),
    /// Head, lap: of the person, but of no part.
    Person,
    /// Chair, floor: stays when the person leaves.
    Furniture,
}

/// A shape with what it belongs to and the folds of its cloth.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub(super) shape: Shape,
    pub(super) region: Region,
    folds: (f64, f64, f64),
}

impl Solid {
    /// How far folds push the surface away from the camera or towards it at the most, in metres.
    pub(super) const fn fold_height(&self) -> f64 {
        self.folds.0
    }

    /// How far folds push the surface away from the camera at a point (its x and y in metres), in metres.
    pub(super) fn fold(&self, x: f64, y: f64) -> f64 {
        let (height, waves, phase) = self.folds;
        height * ((x * waves + phase).sin() + (y * waves * 0.7 + x * waves * 0.4 + 2.0 * phase).sin()) * 0.5
    }
}

/// A scene in the camera frame.
#[derive(Clone, Debug)]
pub struct Scene {
    solids: Vec<Solid>,
    arms: PerSide<ArmPoints>,
    neck: Point,
    left: Vector,
    middle: Point,
}

/// Puts solids together in `base` and hands them over in the camera frame.
pub(super) struct Builder<'a> {
    pub(super) look: &'a Look,
    pub(super) middle: Point,
    pub(super) half_breadth: f64,
    pub(super) left: Vector,
    pub(super) up: Vector,
    pub(super) ahead: Vector,
    to_camera: Pose,
    solids: Vec<Solid>,
}

impl Scene {
    /// A person on a chair whose arms are at the given places in `base`, as a camera with a pose in `base` sees them.
    #[must_use]
    pub fn seated(arms: &PerSide<ArmPoints>, look: &Look, camera: &Pose) -> Self {
        let (left, right) = (arms.left.shoulder, arms.right.shoulder);
        let across = (left - right).try_normalize(1e-6).unwrap_or_else(Vector::y);
        let ahead = across.cross(&Vector::z());
        let up = (Vector::z() + ahead * look.lean).normalize();
        let to_camera = camera.inverse();
        let middle = nalgebra::center(&left, &right);
        let mut builder = Builder {
            look,
            middle,
            half_breadth: (left - right).norm() / 2.0,
            left: across,
            up,
            ahead: across.cross(&up),
            to_camera,
            solids: Vec::with_capacity(64),
        };
        builder.torso();
        builder.lap();
        builder.chair();
        for (side, points) in arms.iter() {
            builder.arm(side, points);
        }
        let camera_points = |points: &ArmPoints| ArmPoints {
            hand: to_camera * points.hand,
            wrist: to_camera * points.wrist,
            elbow: to_camera * points.elbow,
            shoulder: to_camera * points.shoulder,
        };
        Self {
            solids: builder.solids,
            arms: arms.map(|_, points| camera_points(points)),
            neck: to_camera * (middle + up * (look.slope + NECK_MUSCLES)),
            left: to_camera * across,
            middle: to_camera * middle,
        }
    }

    /// The same place without the person.
    #[must_use]
    pub fn empty(&self) -> Self {
        let mut scene = self.clone();
        scene.solids.retain(|solid| solid.region == Region::Furniture);
        scene
    }

    /// The same place without chair and floor.
    #[must_use]
    pub fn without_furniture(&self) -> Self {
        let mut scene = self.clone();
        scene.solids.retain(|solid| solid.region != Region::Furniture);
        scene
    }

    /// The neck's root, which an operator measures the distance to, in the camera frame.
    #[must_use]
    pub const fn neck(&self) -> Point {
        self.neck
    }

    /// A joint's true centre in the camera frame.
    #[must_use]
    pub fn joint(&self, side: Side, joint: Joint) -> Point {
        let points = self.arms.get(side);
        match joint {
            Joint::Hand => points.hand,
            Joint::Wrist => points.wrist,
            Joint::Forearm => nalgebra::center(&points.wrist, &points.elbow),
            Joint::Elbow => points.elbow,
            // The middle of the labelled part, which begins where the shoulder ends.
            Joint::UpperArm => points.shoulder + (points.elbow - points.shoulder) * f64::midpoint(1.0, SHOULDER_SHARE),
            Joint::Shoulder => points.shoulder,
        }
    }

    pub(super) fn solids(&self) -> &[Solid] {
        &self.solids
    }

    /// Tells the true label of points on a solid's surface.
    pub(super) fn labeller(&self, solid: &Solid) -> Labeller {
        match solid.region {
            Region::Torso => Labeller::Torso { middle: self.middle, left: self.left },
            Region::UpperArm(side) => {
                let points = self.arms.get(side);
                let part = |part: Part| part.label(side);
                let labels = [Part::Shoulder, Part::UpperArm, Part::Forearm].map(part);
                Labeller::along(&points.shoulder, &points.elbow, [SHOULDER_SHARE, 1.0], labels)
            }
            Region::Forearm(side) | Region::Hand(side) => {
                let points = self.arms.get(side);
                let before = if solid.region == Region::Forearm(side) { Part::UpperArm } else { Part::Forearm };
                let labels = [before, Part::Forearm, Part::Hand].map(|part| part.label(side));
                Labeller::along(&points.elbow, &points.wrist, [0.0, 1.0], labels)
            }
            Region::Person | Region::Furniture => Labeller::Same(OTHER),
        }
    }
}

/// Tells the true label of points on a surface, with everything worked out that is the same for all of them.
#[derive(Clone, Copy, Debug)]
pub(super) enum Labeller {
    /// All the same.
    Same(u8),
    /// The shoulder's half of the trunk on the side of the middle.
    Torso { middle: Point, left: Vector },
    /// By the share of the way along a limb: up to the first limit, up to the second, beyond.
    Along { start: Point, along: Vector, square: f64, limits: [f64; 2], labels: [u8; 3] },
}

impl Labeller {
    fn along(start: &Point, end: &Point, limits: [f64; 2], labels: [u8; 3]) -> Self {
        let along = end - start;
        Self::Along { start: *start, along, square: along.norm_squared().max(1e-12), limits, labels }
    }

    /// The label of a point in metres in the camera frame.
    pub(super) fn label(&self, point: &Point) -> u8 {
        match self {
            Self::Same(label) => *label,
            Self::Torso { middle, left } => {
                let side = if (point - middle).dot(left) > 0.0 { Side::Left } else { Side::Right };
                Part::Shoulder.label(side)
            }
            Self::Along { start, along, square, limits: [first, second], labels: [before, between, beyond] } => {
                match (point - start).dot(along) / square {
                    share if share < *first => *before,
                    share if share <= *second => *between,
                    _ => *beyond,
                }
            }
        }
    }
}

impl Builder<'_> {
    /// The point `ahead`, `left` and `up` of the middle between the shoulders.
    pub(super) fn at(&self, ahead: f64, left: f64, up: f64) -> Point {
        self.middle + self.ahead * ahead + self.left * left + self.up * up
    }

    pub(super) fn cone(&mut self, region: Region, (start, end): (Point, Point), radii: (f64, f64), folded: bool) {
        let shape = Shape::Cone {
            start: self.to_camera * start,
            end: self.to_camera * end,
            start_radius: radii.0,
            end_radius: radii.1,
        };
        self.push(shape, region, folded);
    }

    /// An ellipsoid with half lengths along the given axes.
    pub(super) fn ellipsoid(&mut self, region: Region, centre: Point, axes: [Vector; 3], half: [f64; 3], folded: bool) {
        let axes = Matrix3::from_columns(&axes.map(|axis| self.to_camera * axis));
        self.push(Shape::ellipsoid(self.to_camera * centre, &axes, half.into()), region, folded);
    }

    /// A box of furniture with half lengths along ahead, left and up, upright.
    pub(super) fn block(&mut self, centre: Point, half: [f64; 3]) {
        let ahead = self.left.cross(&Vector::z());
        let axes = Matrix3::from_columns(&[ahead, self.left, Vector::z()].map(|axis| self.to_camera * axis));
        self.push(Shape::block(self.to_camera * centre, &axes, half.into()), Region::Furniture, false);
    }

    fn push(&mut self, shape: Shape, region: Region, folded: bool) {
        let folds = if folded { (self.look.folds.0, self.look.folds.1, self.look.phase) } else { (0.0, 0.0, 0.0) };
        self.solids.push(Solid { shape, region, folds });
    }

    fn torso(&mut self) {
        let look = self.look;
        let (half, cloth) = (self.half_breadth, look.cloth.0);
        let axes = [self.ahead, self.left, self.up];
        let mut bulge = |place: [f64; 3], size: [f64; 3]| {
            let centre = self.at(place[0], place[1], place[2]);
            self.ellipsoid(Region::Torso, centre, axes, size.map(|length| length + cloth), true);
        };
        bulge([0.0, 0.0, -0.13], [look.chest_depth, half + 0.015, 0.15]);
        bulge([0.01, 0.0, -0.27], [look.chest_depth * 1.05, half * 0.95, 0.2]);
        bulge([0.02, 0.0, -0.42], [look.belly, half * 0.95, 0.16]);
        for side in [1.0, -1.0] {
            bulge([look.chest_depth * 0.6, side * half * 0.5, -0.17], [0.02 + look.breast, half * 0.45, 0.08]);
            bulge([-look.chest_depth * 0.45, side * half * 0.5, -0.1], [0.055, half * 0.5, 0.1]);
        }
        for side in [1.0, -1.0] {
            let ends = (self.at(-0.01, side * 0.03, look.slope), self.at(-0.005, side * half, 0.005));
            self.cone(Region::Torso, ends, (NECK_MUSCLES + cloth, look.upper_arm * 0.95 + cloth), true);
        }
        let (top, root) = (self.at(look.head.0, look.head.1, 0.16), self.at(0.0, 0.0, 0.03));
        self.cone(Region::Person, (root, top), (0.058, 0.05), false);
        let head = self.at(look.head.0 * 1.5, look.head.1 * 1.5, 0.27);
        self.ellipsoid(Region::Person, head, axes, [0.098, 0.077, 0.118], false);
    }

    fn arm(&mut self, side: Side, points: &ArmPoints) {
        let look = self.look;
        let along = |share: f64| points.shoulder + (points.elbow - points.shoulder) * share;
        let (upper, lower) = look.cloth;
        let (thick, elbow) = (look.upper_arm + upper, 0.5 * (look.upper_arm + look.forearm) * 0.92 + upper.min(lower));
        let region = Region::UpperArm(side);
        self.cone(region, (along(0.0), along(0.45)), (thick * 1.02, thick), true);
        self.cone(region, (along(0.45), along(1.0)), (thick, elbow), true);
        let axis = (points.elbow - points.shoulder).try_normalize(1e-6).unwrap_or_else(Vector::z);
        let (second, third) = perpendicular(&axis);
        let size = thick * look.deltoid;
        self.ellipsoid(region, along(0.14), [axis, second, third], [size * 1.5, size, size], true);

        let fore = |share: f64| points.elbow + (points.wrist - points.elbow) * share;
        let region = Region::Forearm(side);
        self.cone(region, (fore(0.0), fore(0.3)), (elbow, look.forearm + lower), true);
        self.cone(region, (fore(0.3), fore(1.0)), (look.forearm + lower, look.wrist + lower), true);
        self.hand(side, points);
    }

    fn hand(&mut self, side: Side, points: &ArmPoints) {
        let look = self.look;
        let region = Region::Hand(side);
        let axis = (points.hand - points.wrist).try_normalize(1e-6).unwrap_or_else(Vector::x);
        let (flat, normal) = perpendicular(&axis);
        let outward = if side == Side::Left { 1.0 } else { -1.0 };
        let turn = look.hand_turn * outward;
        let (flat, normal) = (flat * turn.cos() + normal * turn.sin(), normal * turn.cos() - flat * turn.sin());
        let breadth = look.hand_breadth;
        let palm = (points.hand - points.wrist).norm().max(0.03);
        let centre = points.wrist + axis * (palm * 0.55);
        self.ellipsoid(region, centre, [axis, flat, normal], [palm * 0.62, breadth, 0.02], false);
        self.cone(region, (points.wrist, points.wrist + axis * (palm * 0.4)), (look.wrist, 0.021), false);
        let finger =
            (axis * look.finger_bend.cos() - normal * look.finger_bend.sin()) * (look.hand_length - palm).max(0.05);
        for step in [-0.75, -0.25, 0.25, 0.75] {
            let root = points.hand + flat * (breadth * step);
            self.cone(region, (root, root + finger * (1.0 - 0.2 * f64::abs(step))), (0.0105, 0.008), false);
        }
        let thumb = points.wrist + axis * (palm * 0.35) - flat * (breadth * 0.8);
        self.cone(region, (thumb, thumb + axis * 0.05 - flat * 0.03), (0.014, 0.009), false);
    }

    fn lap(&mut self) {
        let look = self.look;
        let hips = self.at(0.0, 0.0, -0.53);
        let axes = [self.ahead, self.left, self.up];
        self.ellipsoid(Region::Person, hips, axes, [0.15, self.half_breadth + 0.03, 0.12], true);
        let ahead = self.left.cross(&Vector::z());
        for side in [1.0, -1.0] {
            let hip = hips + self.left * (side * 0.09);
            let knee = hip + ahead * 0.46 + self.left * (side * (look.knees_apart - 0.06)) + Vector::z() * 0.02;
            self.cone(Region::Person, (hip, knee), (look.thigh + 0.01, look.thigh * 0.72), true);
            let foot = knee - Vector::z() * 0.4;
            self.cone(Region::Person, (knee, foot), (look.thigh * 0.7, look.thigh * 0.5), true);
        }
    }
}

/// Two directions that stand on an axis and on each other.
fn perpendicular(axis: &Vector) -> (Vector, Vector) {
    let reference = if axis.z.abs() < 0.9 { Vector::z() } else { Vector::x() };
    let flat = axis.cross(&reference).normalize();
    (flat, axis.cross(&flat))
}
