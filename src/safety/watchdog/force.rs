//! Whether a force can be true: finite, alive, and within what can be measured.

use super::WatchSettings;
use crate::geometry::{Finite, Vector};

/// What is known of the newest forces of one arm.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ForcePlausibility {
    last: Option<Vector>,
    identical: u32,
}

impl ForcePlausibility {
    pub(super) fn observe(&mut self, force: Vector, settings: &WatchSettings) {
        let repeats = self.last == Some(force);
        self.identical = if repeats { self.identical.saturating_add(1).min(settings.frozen_samples) } else { 1 };
        self.last = Some(force);
    }

    /// What is wrong with the newest force, in words that follow its name; `None` where it can be true.
    pub(super) fn fault(&self, settings: &WatchSettings) -> Option<String> {
        let force = self.last?;
        if !force.is_finite() {
            return Some("holds a number that is not finite".into());
        }
        if force.amax() >= settings.saturated_newtons {
            return Some(format!("reads {:.0} N, which the robot cannot measure", force.amax()));
        }
        (self.identical >= settings.frozen_samples)
            .then(|| format!("has been the same for {} samples: it is frozen", self.identical))
    }
}
