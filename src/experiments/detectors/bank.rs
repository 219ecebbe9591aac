//! All detectors side by side, each with the settings under which it is used.

use super::pull::Step;
use crate::geometry::Vector;
use crate::safety::{ForceGuard, GuardSample, GuardSettings, Reaction, Zone};
use crate::sensing::{ForceWindow, TwoRate, TwoRateSettings, WindowForm, WindowSettings};
use std::collections::VecDeque;

const PERIOD_SECONDS: f64 = 0.01;
/// Short and long block of the block difference, in samples.
const BLOCKS: (usize, usize) = (5, 20);

/// Every detector with its own state.
#[derive(Debug)]
pub(super) struct Bank {
    windows: Vec<ForceWindow>,
    two_rate: Vec<TwoRate>,
    block: VecDeque<Vector>,
    guards: Vec<ForceGuard>,
}

impl Bank {
    /// The detectors, in the order of their alarms.
    pub(super) const NAMES: [&'static str; 7] = [
        "window_magnitude_5_newtons",
        "window_axis_5_newtons",
        "window_vector_5_newtons",
        "two_rate_2.5_newtons",
        "two_rate_5_newtons",
        "block_difference_5_newtons",
        Self::GUARD,
    ];
    /// The guard as it is used.
    pub(super) const GUARD: &'static str = "force_guard";

    /// Detectors that have seen nothing. One whose settings cannot be used would be left out and never alarm.
    pub(super) fn new() -> Self {
        let window = |form| ForceWindow::new(WindowSettings { form, ..WindowSettings::default() }).ok();
        let two_rate =
            |threshold_newtons| TwoRate::new(TwoRateSettings { threshold_newtons, ..TwoRateSettings::default() }).ok();
        Self {
            windows: [WindowForm::Magnitude, WindowForm::Axis, WindowForm::Vector]
                .into_iter()
                .filter_map(window)
                .collect(),
            two_rate: [2.5, 5.0].into_iter().filter_map(two_rate).collect(),
            block: VecDeque::new(),
            guards: ForceGuard::new(GuardSettings::default()).into_iter().collect(),
        }
    }

    /// Which detectors alarm at a sample, in the order of [`Self::NAMES`].
    pub(super) fn alarms(&mut self, step: &Step) -> Vec<bool> {
        let mut alarms = Vec::with_capacity(Self::NAMES.len());
        for window in &mut self.windows {
            window.push(step.stamp, step.force);
            alarms.push(window.detect().is_some());
        }
        for filter in &mut self.two_rate {
            alarms.push(filter.push(step.force, PERIOD_SECONDS).contact);
        }
        alarms.push(self.block_alarms(step.force));
        alarms.extend(self.guards.iter_mut().map(|guard| guard_alarms(guard, step)));
        alarms
    }

    /// The mean of the newest 5 samples less the mean of the 20 before them.
    fn block_alarms(&mut self, force: Vector) -> bool {
        let (short, long) = BLOCKS;
        self.block.push_back(force);
        if self.block.len() <= short + long {
            return false;
        }
        self.block.pop_front();
        let before: Vector = self.block.iter().take(long).sum::<Vector>() / long as f64;
        let newest: Vector = self.block.iter().skip(long).sum::<Vector>() / short as f64;
        (newest - before).norm() > 5.0
    }
}

/// What the guard does about a sample: a catch that it found, or a tier from which the arm slows down.
fn guard_alarms(guard: &mut ForceGuard, step: &Step) -> bool {
    let verdict = guard.observe(&GuardSample {
        stamp: step.stamp,
        force: step.force,
        velocity: step.velocity,
        acceleration: step.acceleration,
        zone: Zone::Arm,
        expected_newtons: guard.expected(step.passed),
    });
    if step.take_zero && guard.tare(step.stamp).is_err() {
        return true;
    }
    guard.catch().is_some() || verdict.reaction >= Reaction::Hold
}
