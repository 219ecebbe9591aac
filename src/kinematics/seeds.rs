//! Where inverse kinematics starts: a table of postures, those first whose pose is nearest to the target.
//!
//! Poses are kept in single precision and coordinate by coordinate, so that a scan of the whole table is a handful of vector
//! instructions a posture. The table is drawn once from a fixed seed: the same for every target and every run.

use super::JointVector;
use super::chain::Chain;
use super::limits::JointLimits;
use super::model::ArmModel;
use crate::geometry::Pose;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::ops::Range;

/// Postures in the table: more of them save fewer steps than their scan costs.
pub(super) const TABLE_SIZE: usize = 1024;
/// Metres that count as much as one radian when postures are compared with a target: a quarter of the arm's reach took
/// the fewest steps.
const METRES_PER_RADIAN: f32 = 0.25;
/// The share of each joint's range that the table's postures come from: one that starts at the end of a range has to be
/// turned round first. Wider and narrower took more steps.
const SHARE: Range<f64> = 0.07..0.93;

/// Postures to start from, with the pose that each gives.
#[derive(Debug)]
pub(super) struct SeedTable {
    postures: Vec<JointVector>,
    /// x, y, z in metres, then the quaternion's i, j, k, w, each for all postures.
    coordinates: [[f32; TABLE_SIZE]; 7],
}

impl SeedTable {
    /// Postures drawn uniformly from [`SHARE`] of the joint ranges, always the same ones, and the middle of the ranges.
    pub(super) fn new(chain: &Chain, limits: &JointLimits) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(0x5eed_7ab1e);
        let span = limits.upper - limits.lower;
        let mut postures = vec![limits.middle()];
        postures.resize_with(TABLE_SIZE, || {
            let share = JointVector::from_fn(|_, _| random.random_range(SHARE));
            limits.lower + share.component_mul(&span)
        });
        #[expect(clippy::large_stack_arrays, reason = "the table of a model is made once and moved into it")]
        let mut coordinates = [[0.0; TABLE_SIZE]; 7];
        for (index, posture) in postures.iter().enumerate() {
            for (row, value) in coordinates.iter_mut().zip(coordinates_of(&chain.tip_pose(posture))) {
                if let Some(slot) = row.get_mut(index) {
                    *slot = value;
                }
            }
        }
        Self { postures, coordinates }
    }

    /// How far each posture is from a target: squared metres, with the turn in them by [`METRES_PER_RADIAN`].
    fn distances(&self, target: &Pose) -> [f32; TABLE_SIZE] {
        let [x, y, z, i, j, k, w] = &self.coordinates;
        let to = coordinates_of(target);
        let mut distances = [0.0; TABLE_SIZE];
        let rows = x.iter().zip(y).zip(z).zip(i).zip(j).zip(k).zip(w);
        for (distance, ((((((x, y), z), i), j), k), w)) in distances.iter_mut().zip(rows) {
            *distance = distance_squared(&[*x, *y, *z, *i, *j, *k, *w], &to);
        }
        distances
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a seed need not be near to more than single precision")]
fn coordinates_of(pose: &Pose) -> [f32; 7] {
    let (place, turn) = (&pose.translation.vector, pose.rotation.quaternion().coords);
    [place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w].map(|value| value as f32)
}

fn distance_squared(from: &[f32; 7], to: &[f32; 7]) -> f32 {
    let [x, y, z, i, j, k, w] = from;
    let [to_x, to_y, to_z, to_i, to_j, to_k, to_w] = to;
    let place = (x - to_x) * (x - to_x) + (y - to_y) * (y - to_y) + (z - to_z) * (z - to_z);
    // 1 - |q·p| is an eighth of the squared angle for small turns.
    let turn = 8.0 * (1.0 - (i * to_i + j * to_j + k * to_k + w * to_w).abs());
    place + METRES_PER_RADIAN * METRES_PER_RADIAN * turn
}

/// Where attempts start: the given seed and the table, those first whose pose is closest to the target.
pub(super) struct Candidates<'a> {
    distances: [f32; TABLE_SIZE],
    seed_distance: f32,
    seed: JointVector,
    table: &'a SeedTable,
}

impl<'a> Candidates<'a> {
    pub(super) fn new(arm: &'a ArmModel, target: &Pose, seed: JointVector) -> Self {
        let seed_distance = distance_squared(&coordinates_of(&arm.chain.tip_pose(&seed)), &coordinates_of(target));
        Self { distances: arm.seeds.distances(target), seed_distance, seed, table: &arm.seeds }
    }
}

impl Iterator for Candidates<'_> {
    type Item = JointVector;

    fn next(&mut self) -> Option<JointVector> {
        let least = least(&self.distances);
        if self.seed_distance <= least && self.seed_distance.is_finite() {
            self.seed_distance = f32::INFINITY;
            return Some(self.seed);
        }
        let index = self.distances.iter().position(|distance| distance.to_bits() == least.to_bits())?;
        let posture = self.table.postures.get(index).filter(|_| least.is_finite())?;
        if let Some(taken) = self.distances.get_mut(index) {
            *taken = f32::INFINITY;
        }
        Some(*posture)
    }
}

/// The least of all distances, in lanes as wide as a vector register.
fn least(distances: &[f32; TABLE_SIZE]) -> f32 {
    let lower = |one: f32, other: f32| if other < one { other } else { one };
    let mut lanes = [f32::INFINITY; 8];
    for chunk in distances.chunks_exact(lanes.len()) {
        for (lane, distance) in lanes.iter_mut().zip(chunk) {
            *lane = lower(*lane, *distance);
        }
    }
    lanes.into_iter().fold(f32::INFINITY, lower)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Side;
    use crate::kinematics::RobotModel;

    #[test]
    fn every_posture_of_the_table_is_tried_once_and_the_nearest_first() {
        let model = RobotModel::baxter().unwrap();
        let arm = model.arm(Side::Right);
        let target = arm.forward(&arm.limits().lower.lerp(&arm.limits().upper, 0.4));
        let seed = arm.limits().lower;
        let tried: Vec<_> = Candidates::new(arm, &target, seed).collect();
        assert_eq!(tried.len(), TABLE_SIZE + 1);
        assert_eq!(tried.iter().filter(|joints| **joints == seed).count(), 1);
        let to = coordinates_of(&target);
        let far: Vec<_> =
            tried.iter().map(|joints| distance_squared(&coordinates_of(&arm.forward(joints)), &to)).collect();
        assert!(far.windows(2).all(|pair| pair[0] <= pair[1]), "{far:?}");
    }

    #[test]
    fn a_seed_that_is_at_the_target_comes_first() {
        let model = RobotModel::baxter().unwrap();
        let arm = model.arm(Side::Left);
        let seed = arm.limits().lower.lerp(&arm.limits().upper, 0.3);
        assert_eq!(Candidates::new(arm, &arm.forward(&seed), seed).next(), Some(seed));
    }

    #[test]
    fn the_distance_is_that_of_places_and_turns() {
        let pose = |x: f64, angle: f64| {
            let turn = nalgebra::UnitQuaternion::from_axis_angle(&nalgebra::Vector3::z_axis(), angle);
            Pose::from_parts(nalgebra::Translation3::new(x, 0.0, 0.0), turn)
        };
        let distance = |one: &Pose, other: &Pose| distance_squared(&coordinates_of(one), &coordinates_of(other));
        assert!((distance(&pose(0.0, 0.2), &pose(0.3, 0.2)) - 0.09).abs() < 1e-6);
        assert!(
            (distance(&pose(0.0, 0.0), &pose(0.0, 0.2)).sqrt() - 0.05).abs() < 1e-4,
            "a quarter of a metre a radian"
        );
    }
}
