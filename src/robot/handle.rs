//! A motion that is being carried out. Whoever holds the handle moves the arms tick by tick; whoever lets it go stops them.

use super::pair::GuardedPair;
use super::ports::{CommandError, Limb};
use crate::kinematics::PairMotion;
use crate::time::Stamp;

/// How far a motion has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// On the way.
    Moving,
    /// At the end, at rest.
    Arrived,
}

/// A motion under way. Dropping it makes both arms hold, unless the motion has arrived.
#[derive(Debug)]
pub struct MotionHandle<'a, L: Limb> {
    pair: &'a mut GuardedPair<L>,
    motion: PairMotion,
    start: Stamp,
    newest: Stamp,
    arrived: bool,
}

impl<'a, L: Limb> MotionHandle<'a, L> {
    /// Begins a motion at a moment. Nothing is sent before the first step.
    pub const fn begin(pair: &'a mut GuardedPair<L>, motion: PairMotion, start: Stamp) -> Self {
        Self { pair, motion, start, newest: start, arrived: false }
    }

    /// Sends what both arms are to be at this moment.
    ///
    /// # Errors
    /// A [`CommandError`]; the arms then hold.
    pub fn step(&mut self, now: Stamp) -> Result<Progress, CommandError> {
        self.newest = now;
        let elapsed = now.since(self.start);
        let joints = self.motion.sample(elapsed).map(|_, setpoint| setpoint.joints);
        if let Err(error) = self.pair.command_both(now, &joints) {
            self.pair.hold(now);
            return Err(error);
        }
        self.arrived = elapsed >= self.motion.duration();
        Ok(if self.arrived { Progress::Arrived } else { Progress::Moving })
    }

    /// Goes over to the jerk-limited stop on the same path: the steps that follow brake.
    pub fn halt(&mut self, now: Stamp) {
        self.motion = self.motion.halt(now.since(self.start));
        (self.start, self.newest) = (now, now);
    }
}

impl<L: Limb> Drop for MotionHandle<'_, L> {
    fn drop(&mut self) {
        if !self.arrived {
            self.pair.hold(self.newest);
        }
    }
}

#[cfg(test)]
mod tests;
