//! How fast force grows along the way: the slope of a line fitted to force over the travelled metres.
//!
//! Time does not come in: a sleeve that catches is a spring, so its force grows with the way and not with the clock, at
//! whatever speed. A bias that drifts over the whole way grows little within one window. A long window finds a soft catch
//! in spite of noise, a short one a hard catch in time: the guard has both. Dressing itself pulls more from place to place:
//! where it is expected to, the limit rises by a share of that growth; nothing is taken off the measured force.

use super::settings::CatchLimits;
use crate::geometry::Vector;
use crate::sensing::Detection;
use crate::time::Stamp;
use std::collections::VecDeque;

/// Steps of the way in which forces are averaged before the line is fitted, over the whole window.
const BINS: f64 = 20.0;
/// Share of the window that must be filled before its slope means anything.
const LEAST_SHARE: f64 = 0.9;

#[derive(Clone, Copy, Debug)]
struct Bin {
    metres: f64,
    force: Vector,
    /// The pull that dressing itself was expected to need, in newtons.
    expected: f64,
    samples: f64,
}

/// A fitted line.
#[derive(Clone, Copy, Debug)]
struct Growth {
    /// Of the measured force, in N/m.
    slope: Vector,
    /// Of what was expected, in N/m, never below 0.
    expected: f64,
    /// The way it was taken over, in metres.
    span: f64,
}

impl Growth {
    /// The slope in N/m beyond which it is a catch.
    fn limit(&self, limits: &CatchLimits) -> f64 {
        limits.newtons_per_metre + limits.expected_share * self.expected
    }
}

/// The fit along one arm's way.
#[derive(Clone, Debug)]
pub(super) struct CatchFit {
    window_metres: f64,
    metres: f64,
    bins: VecDeque<Bin>,
    fit: Option<Growth>,
    detection: Option<Detection>,
}

impl CatchFit {
    pub(super) fn new(window_metres: f64) -> Self {
        Self { window_metres, metres: 0.0, bins: VecDeque::new(), fit: None, detection: None }
    }

    /// Takes a force `metres` further along the way, and the newtons that dressing itself is expected to pull there.
    pub(super) fn push(&mut self, force: Vector, expected: f64, metres: f64) {
        self.metres += metres;
        let width = self.window_metres / BINS;
        match self.bins.back_mut() {
            Some(bin) if self.metres - bin.metres < width => {
                bin.samples += 1.0;
                bin.force += (force - bin.force) / bin.samples;
                bin.expected += (expected - bin.expected) / bin.samples;
            }
            _ => {
                self.bins.push_back(Bin { metres: self.metres, force, expected, samples: 1.0 });
                self.fit = self.fit_line();
            }
        }
        while self.bins.front().is_some_and(|bin| self.metres - bin.metres > self.window_metres) {
            self.bins.pop_front();
        }
    }

    fn fit_line(&self) -> Option<Growth> {
        let span = self.metres - self.bins.front()?.metres;
        // The newest bin has one sample only and does not count.
        let complete = || self.bins.iter().take(self.bins.len().saturating_sub(1));
        if span < self.window_metres * LEAST_SHARE || complete().count() < 4 {
            return None;
        }
        let samples: f64 = complete().map(|bin| bin.samples).sum();
        let mean_metres = complete().map(|bin| bin.metres * bin.samples).sum::<f64>() / samples;
        let (mut across, mut expected, mut along) = (Vector::zeros(), 0.0, 0.0);
        for bin in complete() {
            // Weighted by ways off their own mean: a constant part of the forces falls out of the sums.
            let off = bin.metres - mean_metres;
            across += bin.force * (off * bin.samples);
            expected += bin.expected * off * bin.samples;
            along += off * off * bin.samples;
        }
        (along > 0.0).then(|| Growth { slope: across / along, expected: (expected / along).max(0.0), span })
    }

    /// Growth along the way and the limit beyond which it is a catch, both in N/m; `None` while too little way was made.
    pub(super) fn stiffness(&self, limits: &CatchLimits) -> Option<(f64, f64)> {
        self.fit.map(|growth| (growth.slope.norm(), growth.limit(limits)))
    }

    /// Compares the growth with its limits: a slope in N/m, and newtons over the window, which are `mask` more where the arm
    /// accelerates. The first find stays as long as it lasts.
    pub(super) fn judge(&mut self, stamp: Stamp, limits: &CatchLimits, mask: f64) {
        let caught = self.fit.filter(|growth| {
            let slope = growth.slope.norm();
            slope > growth.limit(limits) && slope * growth.span > limits.least_newtons + mask
        });
        self.detection = caught.map(|growth| {
            let resistance = growth.slope * growth.span;
            self.detection.unwrap_or(Detection { stamp, resistance, magnitude: resistance.norm() })
        });
    }

    pub(super) const fn detection(&self) -> Option<Detection> {
        self.detection
    }

    pub(super) fn reset(&mut self) {
        *self = Self::new(self.window_metres);
    }
}
