//! Records the person's movement for a set time and has the movement space fitted to it (thesis sections 3.3 and 3.5.1).
//!
//! A posture counts where hand, elbow and shoulder were all seen: what was inferred says where a model thinks the person
//! is. The fit itself takes longer than a beat, so it goes out as an effect and comes back as an input; it is asked for
//! again while the person still moves, so that the mixtures appear as they grow. Nothing moves the robot here.

use super::{Effect, Input, Mode, Supervisor};
use crate::body::{BodyPose, Evidence, Joint, Side};
use crate::geometry::{Finite, Point, Vector};
use crate::modelling::{ArmSpace, FitSettings};
use crate::snapshot::{Level, RecordingMovement};
use crate::time::Stamp;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The longest recording: the thesis' 5,000 frames at 30 Hz took less than three minutes (section 3.5.1).
const LONGEST_SECONDS: f64 = 600.0;
/// Fewer postures than a camera brings in a second say nothing about a movement.
const LEAST_POSTURES: usize = 30;
/// While the person moves a fit is asked for whenever the postures have grown by this factor.
const GROWTH: f64 = 1.25;
/// Most places that are drawn: more than a screen has dots for.
const MOST_DRAWN: usize = 1_200;

/// A question to whoever has time for it: the movement space of an arm, from where its joints were seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MovementOrder {
    /// Which question this is: the answer names it.
    pub number: u64,
    /// Whose arm.
    pub side: Side,
    /// Places of hand, elbow and shoulder in metres in `base`, posture by posture.
    pub places: [Vec<Vector>; 3],
    /// How the mixtures are fitted.
    pub settings: FitSettings,
    /// Seed of the fit's starting points.
    pub seed: u64,
}

impl MovementOrder {
    /// The answer: some tenths of a second of work, to be done where nobody waits.
    #[must_use]
    pub fn answer(&self) -> Input {
        let space = ArmSpace::fit(&self.places, &self.settings, self.seed).map_err(|error| error.to_string());
        Input::Fitted { number: self.number, space: space.map(Box::new) }
    }
}

/// A recording that is under way or waits for its last fit.
#[derive(Debug)]
pub(super) struct Recording {
    side: Side,
    until: Stamp,
    places: [Vec<Vector>; 3],
    newest: Stamp,
    /// How many postures the last question had; 0 before the first.
    asked_with: usize,
    waits: bool,
    ended: bool,
}

impl Recording {
    const fn postures(&self) -> usize {
        self.places[0].len()
    }

    /// Takes a posture where all three joints were seen and the pose is newer than the last.
    fn take(&mut self, pose: &BodyPose) -> Option<[Point; 3]> {
        if self.ended || pose.stamp <= self.newest {
            return None;
        }
        self.newest = pose.stamp;
        let arm = pose.arms.get(self.side);
        let mut seen = [Point::origin(); 3];
        for (place, joint) in seen.iter_mut().zip(Joint::DRESSED) {
            let estimate = arm.joint(joint).filter(|estimate| estimate.evidence == Evidence::Seen)?;
            *place = Some(estimate.position).filter(Finite::is_finite)?;
        }
        for (list, place) in self.places.iter_mut().zip(seen) {
            list.push(place.coords);
        }
        Some(seen)
    }

    /// True where another fit is worth its while.
    fn has_grown(&self) -> bool {
        let due = (self.asked_with as f64 * GROWTH).max(LEAST_POSTURES as f64);
        !self.waits && self.postures() as f64 >= due
    }
}

impl Supervisor {
    /// The movement space of an arm: what was recorded last, or what the profile has.
    pub(super) fn space_of(&self, side: Side) -> Option<&ArmSpace> {
        let of_profile = || self.setup.space.as_ref().map(|space| space.arms.get(side));
        self.recorded.get(side).as_ref().or_else(of_profile)
    }

    pub(super) fn obey_record_movement(&mut self, now: Stamp, side: Side, seconds: f64) -> Result<String, String> {
        if self.mode != Mode::Idle {
            return Err("the person's movement is recorded while no trial runs".into());
        }
        if let Some(recording) = &self.movement {
            return Err(format!("the {} arm's movement is being recorded: wait until that has ended", recording.side));
        }
        if !(seconds.is_finite() && (1.0..=LONGEST_SECONDS).contains(&seconds)) {
            return Err(format!("a recording lasts from 1 to {LONGEST_SECONDS:.0} s, not {seconds}"));
        }
        self.arm_joints(side)?;
        // The camera's clock may differ from this computer's: a pose is new by the poses before it.
        let newest = self.body.as_ref().map_or(Stamp::ZERO, |body| body.stamp);
        let until = now + Duration::from_secs_f64(seconds);
        let places = <[Vec<Vector>; 3]>::default();
        self.movement = Some(Recording { side, until, places, newest, asked_with: 0, waits: false, ended: false });
        self.view.sides.get_mut(side).path.seen.make_mut().clear();
        self.log(now, Level::Information, "movement", format!("recording the {side} arm for {seconds:.0} s"));
        self.show_movement(now);
        Ok(format!("now, for {seconds:.0} s: let the person move the {side} arm about"))
    }

    pub(super) fn record_movement(&mut self, pose: &BodyPose) {
        let Some(recording) = self.movement.as_mut() else { return };
        let Some(seen) = recording.take(pose) else { return };
        let drawn = self.view.sides.get_mut(recording.side).path.seen.make_mut();
        drawn.extend(seen);
        if drawn.len() > MOST_DRAWN {
            let mut index = 0_usize;
            // Every other posture goes; its three places together.
            drawn.retain(|_| {
                index += 1;
                ((index - 1) / 3).is_multiple_of(2)
            });
        }
    }

    /// Goes on with a recording: asks for a fit where one is due, and ends it.
    pub(super) fn follow_movement(&mut self, now: Stamp) {
        let Some(recording) = self.movement.as_mut() else { return };
        let over = !recording.ended && now >= recording.until;
        if over && recording.postures() < LEAST_POSTURES {
            let (side, seen) = (recording.side, recording.postures());
            let text =
                format!("hand, elbow and shoulder were seen together {seen} times, and {LEAST_POSTURES} are needed");
            self.give_up_movement(now, side, &text);
            return;
        }
        if over || (!recording.ended && recording.has_grown()) {
            recording.ended = over;
            recording.waits = true;
            recording.asked_with = recording.postures();
            self.fits_asked += 1;
            let order = MovementOrder {
                number: self.fits_asked,
                side: recording.side,
                places: recording.places.clone(),
                settings: FitSettings::default(),
                seed: self.setup.seed,
            };
            self.effects.push(Effect::Fit(order));
        }
        self.show_movement(now);
    }

    /// Takes a fitted movement space; an answer that nobody waits for any more is dropped.
    pub(super) fn see_fitted(&mut self, now: Stamp, number: u64, space: &Result<Box<ArmSpace>, String>) {
        if number != self.fits_asked {
            return;
        }
        let Some(recording) = self.movement.as_mut() else { return };
        recording.waits = false;
        let (side, ended, postures) = (recording.side, recording.ended, recording.postures());
        match space {
            Ok(space) if ended => {
                let gaussians = space.dressed().map(|joint| joint.components().len());
                let [hand, elbow, shoulder] = gaussians;
                *self.recorded.get_mut(side) = Some(space.as_ref().clone());
                self.effects.push(Effect::Recorded { side, space: space.clone() });
                self.movement = None;
                self.comparison.is_due();
                let text = format!(
                    "the {side} arm's movement space has {hand} Gaussians for the hand, {elbow} for the elbow, {shoulder} \
                     for the shoulder, from {postures} postures; it is used from the next trial on"
                );
                self.log(now, Level::Information, "movement", text);
                self.show_space(side, None);
            }
            Ok(space) => self.show_space(side, Some(space)),
            Err(reason) if ended => self.give_up_movement(now, side, reason),
            // More postures may mend it.
            Err(_) => {}
        }
        self.show_movement(now);
    }

    /// A trial begins: what was recorded so far is not enough for a movement space of the whole time that was asked for.
    pub(super) fn end_movement_for_trial(&mut self, now: Stamp) {
        if let Some(side) = self.movement.as_ref().map(|recording| recording.side) {
            self.give_up_movement(now, side, "a trial begins");
        }
    }

    fn give_up_movement(&mut self, now: Stamp, side: Side, reason: &str) {
        self.movement = None;
        self.show_space(side, None);
        self.show_movement(now);
        let text = format!("the {side} arm's movement was not taken up: {reason}");
        self.log(now, Level::Warning, "movement", text);
    }

    fn show_movement(&mut self, now: Stamp) {
        self.view.trial.movement = self.movement.as_ref().map(|recording| RecordingMovement {
            side: recording.side,
            poses: u32::try_from(recording.postures()).unwrap_or(u32::MAX),
            seconds_left: if recording.ended { 0.0 } else { recording.until.since(now).as_secs_f64() },
        });
    }
}

#[cfg(test)]
mod tests;
