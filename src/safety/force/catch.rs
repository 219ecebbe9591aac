//! How fast force grows along the way: the slope of a line fitted to force over the travelled metres.
//!
//! Time does not come in: a sleeve that catches is a spring, so its force grows with the way and not with the clock, at
//! whatever speed. A bias that drifts over the whole way grows little within one window. A long window finds a soft catch
//! in spite of noise, a short one a hard catch in time: the guard has both.

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
    samples: f64,
}

/// The fit along one arm's way.
#[derive(Clone, Debug)]
pub(super) struct CatchFit {
    window_metres: f64,
    metres: f64,
    bins: VecDeque<Bin>,
    fit: Option<(Vector, f64)>,
    detection: Option<Detection>,
}

impl CatchFit {
    pub(super) fn new(window_metres: f64) -> Self {
        Self { window_metres, metres: 0.0, bins: VecDeque::new(), fit: None, detection: None }
    }

    /// Takes the force beyond what is expected, `metres` further along the way.
    pub(super) fn push(&mut self, beyond: Vector, metres: f64) {
        self.metres += metres;
        let width = self.window_metres / BINS;
        match self.bins.back_mut() {
            Some(bin) if self.metres - bin.metres < width => {
                bin.samples += 1.0;
                bin.force += (beyond - bin.force) / bin.samples;
            }
            _ => {
                self.bins.push_back(Bin { metres: self.metres, force: beyond, samples: 1.0 });
                self.fit = self.fit_line();
            }
        }
        while self.bins.front().is_some_and(|bin| self.metres - bin.metres > self.window_metres) {
            self.bins.pop_front();
        }
    }

    /// Slope as a vector in N/m and the way it was taken over in metres.
    fn fit_line(&self) -> Option<(Vector, f64)> {
        let span = self.metres - self.bins.front()?.metres;
        // The newest bin has one sample only and does not count.
        let complete = || self.bins.iter().take(self.bins.len().saturating_sub(1));
        if span < self.window_metres * LEAST_SHARE || complete().count() < 4 {
            return None;
        }
        let samples: f64 = complete().map(|bin| bin.samples).sum();
        let mean_metres = complete().map(|bin| bin.metres * bin.samples).sum::<f64>() / samples;
        let mean_force = complete().map(|bin| bin.force * bin.samples).sum::<Vector>() / samples;
        let (mut across, mut along) = (Vector::zeros(), 0.0);
        for bin in complete() {
            let off = bin.metres - mean_metres;
            across += (bin.force - mean_force) * (off * bin.samples);
            along += off * off * bin.samples;
        }
        (along > 0.0).then(|| (across / along, span))
    }

    /// Growth along the way in N/m; `None` while too little way was made.
    pub(super) fn stiffness(&self) -> Option<f64> {
        self.fit.map(|(slope, _)| slope.norm())
    }

    /// Compares the growth with its limits: a slope in N/m, and newtons over the window. The first find stays as long as
    /// it lasts.
    pub(super) fn judge(&mut self, stamp: Stamp, newtons_per_metre: f64, least_newtons: f64) {
        let caught =
            self.fit.filter(|(slope, span)| slope.norm() > newtons_per_metre && slope.norm() * span > least_newtons);
        self.detection = caught.map(|(slope, span)| {
            let resistance = slope * span;
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
