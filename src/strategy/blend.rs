//! Comfort first, then reach: the kernel step finds the comfort path, one blend moves it towards the movement space, and
//! one pass more shows what that costs in force.

use super::learner::share_of_dense;
use super::{
    BlendSettings, Contact, Finish, FixedPath, IterationSummary, LearnedPath, NodeStrategy, Reaction, Strategy,
    StrategyError, StrategyKind,
};
use crate::geometry::{Point, Vector};
use crate::planning::Reach;
use crate::planning::blend::{BlendWeights, blend};

/// Stations at which the path is blended: 2 to 3 cm apart on an arm.
const STATIONS: u32 = 24;

/// The blend of comfort and reach.
#[derive(Debug)]
pub struct BlendStrategy {
    comfort: NodeStrategy,
    reach: Reach,
    reachable: Vec<Point>,
    settings: BlendSettings,
    /// The blended path, once comfort has been found.
    blended: Option<FixedPath>,
    verified: bool,
    iteration: u32,
}

impl BlendStrategy {
    /// A strategy whose comfort path is found by `comfort` and moved towards `reachable`.
    #[must_use]
    pub fn new(comfort: NodeStrategy, reach: Reach, reachable: &[Point], settings: &BlendSettings) -> Self {
        Self {
            comfort,
            reach,
            reachable: reachable.to_vec(),
            settings: settings.clone(),
            blended: None,
            verified: false,
            iteration: 0,
        }
    }

    fn active(&self) -> &dyn Strategy {
        self.blended.as_ref().map_or(&self.comfort as &dyn Strategy, |blended| blended)
    }

    fn active_mut(&mut self) -> &mut dyn Strategy {
        match self.blended.as_mut() {
            Some(blended) => blended,
            None => &mut self.comfort,
        }
    }

    fn blend(&mut self) {
        let weights = BlendWeights {
            weight: self.settings.weight,
            distance_scale: self.settings.distance_scale,
            stations: STATIONS,
        };
        let path = blend(self.comfort.path(), &self.reachable, &self.reach, &weights);
        self.blended = Some(FixedPath::along(path));
    }
}

impl Strategy for BlendStrategy {
    fn kind(&self) -> StrategyKind {
        StrategyKind::Blend
    }

    fn path(&self) -> &[Point] {
        self.active().path()
    }

    fn begin(&mut self) -> Result<(), StrategyError> {
        if self.verified {
            return Err(StrategyError::Finished { finish: Finish::Fixed });
        }
        self.active_mut().begin()?;
        self.iteration = self.iteration.saturating_add(1);
        Ok(())
    }

    fn goal(&self) -> Option<Point> {
        self.active().goal()
    }

    fn resisted(&mut self, contact: &Contact) -> Reaction {
        self.active_mut().resisted(contact)
    }

    fn settled(&mut self, residual: &Vector) {
        self.active_mut().settled(residual);
    }

    fn learns_from_residuals(&self) -> bool {
        self.active().learns_from_residuals()
    }

    fn arrived(&mut self) {
        self.active_mut().arrived();
    }

    fn listens_at(&self, position: &Point) -> bool {
        self.active().listens_at(position)
    }

    fn heeds(&self, position: &Point) -> bool {
        self.active().heeds(position)
    }

    fn interval_share(&self) -> f64 {
        // The blended path is drawn through as many points as the path it was made of, or more.
        self.blended.as_ref().map_or_else(|| self.comfort.interval_share(), |path| share_of_dense(path.path()))
    }

    fn finish(&mut self) -> IterationSummary {
        let mut summary = self.active_mut().finish();
        summary.iteration = self.iteration;
        match (self.blended.is_some(), summary.finished) {
            (true, finished) => self.verified = finished.is_some(),
            (false, Some(_)) => {
                self.blend();
                summary.path = self.path().to_vec();
                summary.finished = None;
            }
            (false, None) => {}
        }
        summary
    }

    fn learned(&self) -> LearnedPath {
        LearnedPath { kind: self.kind(), iteration: self.iteration, ..self.comfort.learned() }
    }

    fn adopt(&mut self, learned: &LearnedPath) -> Vec<String> {
        self.blended = None;
        self.verified = false;
        self.comfort.adopt(learned)
    }
}
