//! Puts reachability beside every change and every summary of another strategy, where a movement space is known.

use super::{Contact, IterationSummary, LearnedPath, Reaction, Strategy, StrategyError, StrategyKind};
use crate::geometry::{Point, Vector, polyline_length};
use crate::planning::Reach;

/// Into how many pieces a path is cut to be judged: about 2 cm on an arm.
const PIECES: f64 = 32.0;

/// A strategy whose answers say what they do to reachability.
#[derive(Debug)]
pub(super) struct Explained {
    inner: Box<dyn Strategy>,
    reach: Reach,
}

impl Explained {
    pub(super) const fn new(inner: Box<dyn Strategy>, reach: Reach) -> Self {
        Self { inner, reach }
    }
}

impl Strategy for Explained {
    fn kind(&self) -> StrategyKind {
        self.inner.kind()
    }

    fn path(&self) -> &[Point] {
        self.inner.path()
    }

    fn begin(&mut self) -> Result<(), StrategyError> {
        self.inner.begin()
    }

    fn goal(&self) -> Option<Point> {
        self.inner.goal()
    }

    fn resisted(&mut self, contact: &Contact) -> Reaction {
        let mut reaction = self.inner.resisted(contact);
        for change in &mut reaction.changes {
            change.reachability_before = Some(self.reach.at(&change.from).score);
            change.reachability_after = Some(self.reach.at(&change.to).score);
        }
        reaction
    }

    fn settled(&mut self, residual: &Vector) {
        self.inner.settled(residual);
    }

    fn learns_from_residuals(&self) -> bool {
        self.inner.learns_from_residuals()
    }

    fn arrived(&mut self) {
        self.inner.arrived();
    }

    fn listens_at(&self, position: &Point) -> bool {
        self.inner.listens_at(position)
    }

    fn heeds(&self, position: &Point) -> bool {
        self.inner.heeds(position)
    }

    fn interval_share(&self) -> f64 {
        self.inner.interval_share()
    }

    fn finish(&mut self) -> IterationSummary {
        let mut summary = self.inner.finish();
        let length = polyline_length(&summary.path);
        if length > 0.0 {
            let judged = self.reach.along(&summary.path, length / PIECES);
            summary.reachability = Some(judged.score);
            summary.inside_share = Some(judged.inside_share);
        }
        summary
    }

    fn learned(&self) -> LearnedPath {
        self.inner.learned()
    }

    fn adopt(&mut self, learned: &LearnedPath) -> Vec<String> {
        self.inner.adopt(learned)
    }
}
