//! The kernel step: a contact's correction is carried forward along the path, fading with distance.
//!
//! Nodes ahead move along because the cloth that resists here resists there too; nodes behind were passed without
//! resistance and stay.

use super::nodes::Correction;
use super::{KernelSettings, Rule};
use crate::geometry::{Point, Vector};

/// The correction of the kernel step.
#[derive(Debug)]
pub(super) struct KernelStep {
    gain: f64,
    length_scale: f64,
    step: f64,
}

impl KernelStep {
    pub(super) const fn new(settings: &KernelSettings) -> Self {
        Self { gain: settings.gain, length_scale: settings.length_scale, step: 0.0 }
    }
}

impl Correction for KernelStep {
    fn rebase(&mut self, _nodes: &[Point], step: f64) {
        self.step = step;
    }

    fn correct(&mut self, nodes: &mut [Point], index: usize, towards_optimum: &Vector) {
        let last = nodes.len().saturating_sub(1);
        for (other, node) in nodes.iter_mut().enumerate().take(last).skip(index) {
            let ahead = (other - index) as f64 * self.step / self.length_scale;
            let remaining = (last - other) as f64 * self.step / self.length_scale;
            // The pinned end pulls the correction down to nothing, save at the node of the contact itself.
            let fade = if other == index { 1.0 } else { (-0.5 * ahead * ahead).exp() * remaining.min(1.0) };
            *node += towards_optimum * (self.gain * fade);
        }
    }

    fn rule(&self, stiffness: f64) -> Rule {
        Rule::Carried { stiffness }
    }
}
