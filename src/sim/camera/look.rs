//! How a body looks from outside: girths, slopes, cloth. Lengths come from the arms' joints.

use super::super::person::BodySizes;
use super::noise::PixelRandom;

/// Outer sizes of a body in metres, and of what it wears and sits on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    pub(super) upper_arm: f64,
    pub(super) forearm: f64,
    pub(super) wrist: f64,
    pub(super) hand_length: f64,
    pub(super) hand_breadth: f64,
    /// How much the deltoid stands out, as a factor on the upper arm's radius.
    pub(super) deltoid: f64,
    /// Height of the neck's root above the shoulders' centres: the shoulders' slope.
    pub(super) slope: f64,
    pub(super) chest_depth: f64,
    pub(super) breast: f64,
    pub(super) belly: f64,
    /// Added to radii by cloth: torso and upper arm, forearm.
    pub(super) cloth: (f64, f64),
    /// Height of folds and their waves a metre.
    pub(super) folds: (f64, f64),
    /// Turn of the hand about the forearm in radians, and how far the fingers bend.
    pub(super) hand_turn: f64,
    pub(super) finger_bend: f64,
    /// The head's lean: forward and to the left.
    pub(super) head: (f64, f64),
    pub(super) lean: f64,
    pub(super) thigh: f64,
    pub(super) knees_apart: f64,
    /// Height of the chair's back above the seat; its breadth; whether it has arm rests.
    pub(super) back_height: f64,
    pub(super) chair_breadth: f64,
    pub(super) arm_rests: bool,
    /// Phase of folds.
    pub(super) phase: f64,
}

impl Look {
    /// The plain look of a body.
    #[must_use]
    pub fn of(body: &BodySizes) -> Self {
        let sizes = body.arm_sizes();
        let stout = (body.mass_kilograms / body.stature_metres.powi(2) / 25.0).clamp(0.6, 2.0);
        Self {
            upper_arm: sizes.upper_arm_radius_metres,
            forearm: sizes.forearm_radius_metres,
            wrist: sizes.wrist_radius_metres,
            hand_length: sizes.hand_metres,
            hand_breadth: 1.35 * sizes.hand_radius_metres,
            deltoid: 1.12,
            slope: 0.06,
            chest_depth: 0.115 * stout.sqrt(),
            breast: 0.05,
            belly: 0.12 * stout,
            cloth: (0.006, 0.003),
            folds: (0.002, 60.0),
            hand_turn: 0.0,
            finger_bend: 0.3,
            head: (0.03, 0.0),
            lean: 0.05,
            thigh: 0.08 * stout.sqrt(),
            knees_apart: 0.12,
            back_height: 0.45,
            chair_breadth: 0.22,
            arm_rests: false,
            phase: 0.0,
        }
    }

    /// A look that varies about the body's own as people and clothing do.
    #[must_use]
    pub fn sampled(body: &BodySizes, seed: u64) -> Self {
        let plain = Self::of(body);
        let mut random = PixelRandom(seed ^ 0x100C);
        let mut between = |low: f64, high: f64| random.between(low, high);
        let thick_cloth = between(0.0, 1.0).powi(2);
        Self {
            upper_arm: plain.upper_arm * between(0.82, 1.12),
            forearm: plain.forearm * between(0.8, 1.12),
            wrist: plain.wrist * between(0.85, 1.2),
            hand_length: plain.hand_length * between(0.94, 1.06),
            hand_breadth: plain.hand_breadth * between(0.8, 1.25),
            deltoid: between(0.98, 1.3),
            slope: between(0.02, 0.10),
            chest_depth: plain.chest_depth * between(0.8, 1.2),
            breast: between(0.02, 0.09),
            belly: plain.belly * between(0.75, 1.25),
            cloth: (0.028 * thick_cloth, 0.028 * thick_cloth * between(0.0, 1.0)),
            folds: (between(0.0, 0.007), between(25.0, 110.0)),
            hand_turn: between(-1.6, 1.6),
            finger_bend: between(0.0, 1.5),
            head: (between(-0.03, 0.10), between(-0.04, 0.04)),
            lean: between(-0.10, 0.22),
            thigh: plain.thigh * between(0.85, 1.2),
            knees_apart: between(0.07, 0.24),
            back_height: between(0.15, 0.65),
            chair_breadth: between(0.16, 0.28),
            arm_rests: between(0.0, 1.0) < 0.4,
            phase: between(0.0, 6.3),
        }
    }
}
