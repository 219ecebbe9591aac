//! Force protection that does not depend on the strategy: always on, on both arms.
//!
//! Beside the thesis' window, which sees only what builds within 150 ms, four things are watched: the absolute force in
//! tiers, a fast change, the *stiffness* with which force grows along the way (a sleeve that catches softly), and the
//! work done beyond what dressing needs. Each verdict names its cause with numbers.
//!
//! It judges and never moves anything. It is software on a PC and not safety-rated.

mod catch;
mod settings;

pub use settings::{CatchLimits, ExpectedPull, GuardError, GuardSettings, HARD_CAP_NEWTONS, Tiers, Zone};

use super::{Reaction, Verdict};
use crate::geometry::{Finite, Vector};
use crate::sensing::{BiasTracker, Detection, Tare, TareError, TwoRate};
use crate::time::Stamp;
use catch::CatchFit;

/// Time constant of the mean that the tiers are compared with, in seconds: short enough for a stop, long enough that
/// noise of 2 N does not cross a tier.
const SMOOTH_SECONDS: f64 = 0.05;
/// Samples further apart than this do not belong together, in seconds: the filters start anew.
const LONGEST_GAP_SECONDS: f64 = 0.1;
/// A tier that was reached is left only below this share of its limit, so that the speed does not chatter.
const RELEASE_SHARE: f64 = 0.8;
/// Slower than this the arm counts as still, in m/s: a tenth of the slowest dressing speed.
const STILL_METRES_PER_SECOND: f64 = 0.002;

/// One force sample with what the arm was told to do at that moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GuardSample {
    /// The sample's own stamp.
    pub stamp: Stamp,
    /// Force from outside on the gripper, in `base`, in newtons.
    pub force: Vector,
    /// Commanded velocity of the gripper in `base`, in m/s.
    pub velocity: Vector,
    /// Commanded acceleration of the gripper in `base`, in m/s².
    pub acceleration: Vector,
    /// Where the gripper is at the person.
    pub zone: Zone,
    /// Force that dressing itself needs here, in newtons: 0 where nothing is known of it.
    pub expected_newtons: f64,
}

/// Watches the force of one arm.
///
/// ```
/// use valet::geometry::Vector;
/// use valet::safety::{ForceGuard, GuardSample, GuardSettings, Reaction};
///
/// let mut guard = ForceGuard::new(GuardSettings::default())?;
/// let verdict = guard.observe(&GuardSample { force: Vector::new(13.0, 0.0, 0.0), ..GuardSample::default() });
/// assert_eq!(verdict.reaction, Reaction::Slow);
/// assert_eq!(verdict.cause, "force 13.0 N, slow from 12.0 N");
/// assert_eq!(verdict.margin_newtons, Some(2.0));
/// # Ok::<(), valet::safety::GuardError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ForceGuard {
    settings: GuardSettings,
    bias: BiasTracker,
    fast_change: TwoRate,
    soft: CatchFit,
    hard: CatchFit,
    last: Option<Stamp>,
    load: Option<Vector>,
    tier: Reaction,
    work_joules: f64,
    verdict: Verdict,
}

impl ForceGuard {
    /// A guard that has seen nothing and has no zero.
    ///
    /// # Errors
    /// Where a setting cannot be used; no setting raises a tier beyond its cap.
    pub fn new(settings: GuardSettings) -> Result<Self, GuardError> {
        settings.validate()?;
        Ok(Self {
            bias: BiasTracker::new(settings.bias)?,
            fast_change: TwoRate::new(settings.fast_change)?,
            soft: CatchFit::new(settings.catch.window_metres),
            hard: CatchFit::new(settings.hard_catch.window_metres),
            settings,
            last: None,
            load: None,
            tier: Reaction::Clear,
            work_joules: 0.0,
            verdict: Verdict::clear(),
        })
    }

    /// Takes a sample and judges it.
    pub fn observe(&mut self, sample: &GuardSample) -> Verdict {
        self.verdict = self.judge(sample);
        self.verdict.clone()
    }

    fn judge(&mut self, sample: &GuardSample) -> Verdict {
        if !sample.force.is_finite() || !sample.velocity.is_finite() {
            self.forget_motion();
            return Verdict::new(Reaction::Hold, "a force that is not a finite number");
        }
        let Some(seconds) = self.step_since(sample.stamp) else { return self.verdict.clone() };
        let plain = self.settings.inertia.apply(sample.force, sample.acceleration);
        self.bias.observe(plain, sample.velocity.norm() < STILL_METRES_PER_SECOND);
        let now = self.bias.apply(plain);
        let load = self.load.map_or(now, |load| load + (now - load) * (1.0 - (-seconds / SMOOTH_SECONDS).exp()));
        self.load = Some(load);
        let tiers = self.settings.tiers.at(sample.zone);
        Verdict::strictest([
            hard_cap(now),
            self.judge_tier(load.norm(), &tiers),
            self.judge_change(now, sample, seconds),
            self.judge_catch(now, sample, seconds),
            self.judge_work(load, sample, seconds),
        ])
    }

    /// Seconds since the sample before; 0 for the first; `None` for the same sample once more.
    fn step_since(&mut self, stamp: Stamp) -> Option<f64> {
        let before = self.last.replace(stamp);
        if before == Some(stamp) {
            return None;
        }
        let seconds = before.and_then(|before| stamp.checked_since(before)).map(|span| span.as_secs_f64());
        if let Some(seconds) = seconds.filter(|seconds| *seconds <= LONGEST_GAP_SECONDS) {
            return Some(seconds);
        }
        self.forget_motion();
        Some(0.0)
    }

    fn judge_tier(&mut self, load: f64, tiers: &Tiers) -> Verdict {
        let (reached, limit) = tiers.reached(load);
        let kept = tiers.reached(load / RELEASE_SHARE).0;
        // A tier is entered at its limit and left below a share of it.
        self.tier = reached.max(kept.min(self.tier));
        let margin = tiers.above(self.tier).map(|next| next - load);
        if self.tier == Reaction::Clear {
            return Verdict::clear().with_margin(margin);
        }
        let limit = if self.tier == reached { limit } else { tiers.limit(self.tier) };
        let cause = format!("force {load:.1} N, {} from {limit:.1} N", tier_word(self.tier));
        Verdict::new(self.tier, cause).with_margin(margin)
    }

    fn judge_change(&mut self, now: Vector, sample: &GuardSample, seconds: f64) -> Verdict {
        let threshold = self.settings.fast_change.threshold_newtons + self.mask(sample);
        let reading = self.fast_change.push_with_threshold(now, seconds, threshold);
        if !reading.contact {
            return Verdict::clear();
        }
        let cause = format!("force changed by {:.1} N, beyond {threshold:.1} N", reading.change.norm());
        Verdict::new(Reaction::Advise, cause)
    }

    /// What the compensation of the arm's own acceleration may leave over, in newtons: its mass is known to a third.
    fn mask(&self, sample: &GuardSample) -> f64 {
        let acceleration = if sample.acceleration.is_finite() { sample.acceleration.norm() } else { 0.0 };
        acceleration * self.settings.unknown_mass_kilograms
    }

    fn judge_catch(&mut self, now: Vector, sample: &GuardSample, seconds: f64) -> Verdict {
        let metres = sample.velocity.norm() * seconds;
        let mask = self.mask(sample);
        let expected = if sample.expected_newtons.is_finite() { sample.expected_newtons } else { 0.0 };
        for (fit, limits) in [(&mut self.soft, &self.settings.catch), (&mut self.hard, &self.settings.hard_catch)] {
            fit.push(now, expected, metres);
            fit.judge(sample.stamp, limits, mask);
        }
        let limits = [(&self.soft, &self.settings.catch), (&self.hard, &self.settings.hard_catch)];
        let caught = limits.into_iter().find(|(fit, _)| fit.detection().is_some());
        caught.map_or_else(Verdict::clear, |(fit, limits)| {
            let (stiffness, limit) = fit.stiffness(limits).unwrap_or_default();
            let cause = format!("force grows by {stiffness:.0} N/m along the way, a catch from {limit:.0} N/m");
            Verdict::new(self.settings.catch_reaction, cause)
        })
    }

    fn judge_work(&mut self, load: Vector, sample: &GuardSample, seconds: f64) -> Verdict {
        let beyond = beyond_expected(load, sample).norm() - self.settings.work_free_newtons;
        self.work_joules += beyond.max(0.0) * sample.velocity.norm() * seconds;
        let limit = self.settings.work_joules;
        if self.work_joules <= limit {
            return Verdict::clear();
        }
        Verdict::new(
            Reaction::Slow,
            format!("{:.1} J of work beyond what dressing needs, more than {limit:.1} J", self.work_joules),
        )
    }

    /// The newest verdict.
    #[must_use]
    pub const fn verdict(&self) -> &Verdict {
        &self.verdict
    }

    /// A sleeve that catches, softly or hard, from the sample that showed it on as long as it lasts. Its resistance points as the
    /// external force does, in `base`; its magnitude is what has grown over the window, in newtons.
    #[must_use]
    pub fn catch(&self) -> Option<Detection> {
        self.soft.detection().or(self.hard.detection())
    }

    /// The pull in newtons that dressing itself needs so many metres from the hand.
    #[must_use]
    pub fn expected(&self, metres: f64) -> f64 {
        self.settings.expected.at(metres)
    }

    /// The smoothed force without bias that the tiers are compared with, in `base`, in newtons.
    #[must_use]
    pub const fn load(&self) -> Option<Vector> {
        self.load
    }

    /// The tiers that hold in a zone, in newtons.
    #[must_use]
    pub fn tiers(&self, zone: Zone) -> Tiers {
        self.settings.tiers.at(zone)
    }

    /// Takes the present force as zero.
    ///
    /// # Errors
    /// Where the arm has not been still for long enough, or its force was not steady.
    pub fn tare(&mut self, now: Stamp) -> Result<Tare, TareError> {
        let tare = self.bias.tare(now)?;
        self.forget_motion();
        Ok(tare)
    }

    /// The zero in use; `None` where none was taken.
    #[must_use]
    pub const fn zero(&self) -> Option<&Tare> {
        self.bias.zero()
    }

    /// A pass begins, or the arm starts on another way: what was learned on the old one means nothing. The zero and the
    /// smoothed force stay.
    pub fn motion_begins(&mut self) {
        self.soft.reset();
        self.hard.reset();
        self.work_joules = 0.0;
    }

    fn forget_motion(&mut self) {
        self.load = None;
        self.fast_change.reset();
        self.motion_begins();
    }
}

/// The part of a force that is beyond what dressing needs: its pull against the motion is reduced by
/// what is expected, never below 0.
fn beyond_expected(force: Vector, sample: &GuardSample) -> Vector {
    let expected = if sample.expected_newtons.is_finite() { sample.expected_newtons.max(0.0) } else { 0.0 };
    let speed = sample.velocity.norm();
    if expected <= 0.0 || speed <= STILL_METRES_PER_SECOND {
        return force;
    }
    // Dressing pulls against the motion; where it pulls less than is expected, nothing is left over.
    let way = sample.velocity / speed;
    let pull = (-force.dot(&way)).clamp(0.0, expected);
    force + way * pull
}

fn hard_cap(force: Vector) -> Verdict {
    let newtons = force.norm();
    if newtons <= HARD_CAP_NEWTONS {
        return Verdict::clear();
    }
    Verdict::new(
        Reaction::Stop,
        format!("force {newtons:.1} N, beyond the cap of {HARD_CAP_NEWTONS:.1} N that no setting raises"),
    )
}

/// The tiers' own words: a hold for force is called a pause.
const fn tier_word(tier: Reaction) -> &'static str {
    match tier {
        Reaction::Hold => "pause",
        other => other.name(),
    }
}

#[cfg(test)]
mod tests;
