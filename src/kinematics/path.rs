//! A way through joint space, by a parameter from 0 (start) to 1 (end) that both arms share.
//!
//! A cubic spline through evenly spaced knots: positions, speeds and accelerations are continuous. Knows no time.

use super::JointVector;

/// One arm's way. A single knot is an arm that stays.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct JointPath {
    knots: Vec<JointVector>,
    /// Second derivative with respect to the parameter at each knot.
    curvature: Vec<JointVector>,
}

/// A way's joint positions and their first two derivatives with respect to the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PathPoint {
    pub(super) joints: JointVector,
    pub(super) slope: JointVector,
    pub(super) curvature: JointVector,
}

impl JointPath {
    /// A way through knots that are evenly spaced in the parameter. No knot at all would be no way: `None`.
    pub(super) fn through(knots: Vec<JointVector>) -> Option<Self> {
        let curvature = spline_curvature(&knots);
        (!knots.is_empty()).then_some(Self { knots, curvature })
    }

    pub(super) fn knots(&self) -> &[JointVector] {
        &self.knots
    }

    /// The way at a parameter; outside 0 to 1 its ends.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the parameter is clamped to the knots"
    )]
    pub(super) fn at(&self, parameter: f64) -> PathPoint {
        let spans = self.knots.len().saturating_sub(1) as f64;
        let scaled = parameter.clamp(0.0, 1.0) * spans;
        let first = (scaled.floor() as usize).min(self.knots.len().saturating_sub(2));
        let knot = |index: usize| self.knots.get(index).copied().unwrap_or_else(JointVector::zeros);
        let bend = |index: usize| self.curvature.get(index).copied().unwrap_or_else(JointVector::zeros);
        if spans < 1.0 {
            return PathPoint { joints: knot(0), slope: JointVector::zeros(), curvature: JointVector::zeros() };
        }
        let (width, after) = (1.0 / spans, scaled - first as f64);
        let before = 1.0 - after;
        let (from, to, bend_from, bend_to) = (knot(first), knot(first + 1), bend(first), bend(first + 1));
        let squared = width * width / 6.0;
        PathPoint {
            joints: from * before
                + to * after
                + (bend_from * (before.powi(3) - before) + bend_to * (after.powi(3) - after)) * squared,
            slope: (to - from) * spans
                + (bend_to * (3.0 * after * after - 1.0) - bend_from * (3.0 * before * before - 1.0)) * (width / 6.0),
            curvature: bend_from * before + bend_to * after,
        }
    }
}

/// Second derivatives of the cubic spline through evenly spaced knots over 0 to 1: the tridiagonal system 1-4-1 with the ends
/// known, solved forwards and back (Thomas).
fn spline_curvature(knots: &[JointVector]) -> Vec<JointVector> {
    let spans = knots.len().saturating_sub(1) as f64;
    let differences: Vec<JointVector> = knots
        .windows(3)
        .map(|window| match window {
            [before, here, after] => (after - here * 2.0 + before) * (spans * spans),
            _ => JointVector::zeros(),
        })
        .collect();
    let (first, last) = end_curvature(&differences);
    let mut forward = vec![(0.0, first)];
    for difference in &differences {
        let (ratio, value) = forward.last().copied().unwrap_or((0.0, first));
        let pivot = 4.0 - ratio;
        forward.push((1.0 / pivot, (difference * 6.0 - value) / pivot));
    }
    let mut curvature = vec![JointVector::zeros(); knots.len()];
    let mut next = last;
    for (index, slot) in curvature.iter_mut().enumerate().rev() {
        *slot = match forward.get(index) {
            Some((ratio, value)) => value - next * *ratio,
            None => last,
        };
        next = *slot;
    }
    curvature
}

/// The curvature at both ends, continued from the differences next to them: a spline that is forced to be straight at its ends
/// would leave a curved way by more than the rest of it. Too few knots make a natural spline: straight ends.
fn end_curvature(differences: &[JointVector]) -> (JointVector, JointVector) {
    match (differences, differences) {
        ([first, second, ..], [.., before, last]) => (first * 2.0 - second, last * 2.0 - before),
        _ => (JointVector::zeros(), JointVector::zeros()),
    }
}

#[cfg(test)]
mod tests;
