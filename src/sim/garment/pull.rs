//! The force along the arm that a sleeve, a catch or fabric that missed the hand puts on a gripper.
//!
//! Smooth laws whose figures for a hospital gown keep to the pulls that were measured on people's forearms: about 0.3 N on
//! the hand, then 19 N a metre that grow towards the elbow; a catch that rises steeply and works itself loose; fabric
//! that drags over the arm at 7.7 N a metre.

use super::GarmentSizes;

/// Fabric that touches the arm at all, in newtons.
const TOUCH: f64 = 0.3;
/// From the fingertips to the wrist, in metres: before it a sleeve runs freely.
const WRIST: f64 = 0.11;
/// The forearm thickens towards the elbow: friction doubles over this length, in metres.
const THICKENING: f64 = 1.0;

impl GarmentSizes {
    /// Force against the motion of a sleeve whose rim is `metres` past the fingertips.
    pub(super) fn sleeve_pull(&self, metres: f64) -> f64 {
        let past = (metres - WRIST).max(0.0);
        self.sleeve_friction_newtons_per_metre * past * (1.0 + past / THICKENING)
    }

    /// Force of a rim that is caught, after the gripper has gone on by `metres`.
    pub(super) fn snag_pull(&self, metres: f64) -> f64 {
        let ceiling = self.snag_ceiling_newtons;
        ceiling * (1.0 - (-self.snag_stiffness_newtons_per_metre * metres.max(0.0) / ceiling).exp())
    }

    /// Force of fabric that missed the hand and lies on the arm over `metres`.
    pub(super) fn drape_pull(&self, metres: f64) -> f64 {
        TOUCH + self.drape_newtons_per_metre * metres.max(0.0)
    }
}
