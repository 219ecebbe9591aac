//! What can be wrong with an arm: impairments as classes of a profile, each with the size that a profile gives it.
//!
//! The classes follow published models of simulated users (limits, weakness, tremor: Assistive Gym; one-sided weakness and
//! involuntary motion: Clegg and others) and textbook signs; how strongly each acts on a sleeve is an assumption of ours.
//! An impairment changes how the arm reacts; it never tells the node that it is there.

use super::super::random::Random;
use super::{ArmAngles, PersonError, Response};
use crate::geometry::Vector;
use serde::{Deserialize, Serialize};

/// A relaxed person gives way by up to this much, in metres; a limited range leaves a share of it.
const GIVES_WAY_METRES: f64 = 0.10;
/// In a painful arc the person reacts in this share of the time, stiffens this many times as fast, and gives way less.
const PAIN_HASTE: f64 = 0.6;
const PAIN_STIFFENING: f64 = 1.5;
const PAIN_YIELD: f64 = 0.3;
/// From shoulder to elbow in metres (median woman, ANSUR II): turns an angle of the shoulder into a way of the elbow.
const UPPER_ARM_METRES: f64 = 0.31;
/// How long a startled arm stays away, in seconds.
const STARTLED_SECONDS: f64 = 0.2;
/// How far off a movement is that the person was not asked for, in metres.
const WHIM_METRES: f64 = 0.06;
/// Where no sleeve pulls, a number that no time reaches.
const NEVER: f64 = f64::INFINITY;

/// One impairment of an arm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Impairment {
    /// The joints reach only a share of their range.
    LimitedRange {
        /// Share of the range that is left, 0.1 to 1.
        share: f64,
    },
    /// The muscles have only a share of their strength: the arm holds and resists less.
    Weakness {
        /// Share of the strength that is left, 0.1 to 1.
        share: f64,
    },
    /// The arm trembles.
    Tremor {
        /// Amplitude in metres (action tremor: 1 to 5 mm).
        amplitude_metres: f64,
        /// Frequency in hertz (action tremor: 4 to 8 Hz).
        frequency_hz: f64,
    },
    /// The arm is passive, and its flexors resist the more the faster they are stretched (hemiplegia).
    OneSided {
        /// Resistance in newtons at one metre per second.
        tone_newton_seconds_per_metre: f64,
    },
    /// Lifting the arm hurts between two elevations (typically 60 to 120 degrees).
    PainfulArc {
        /// Where it begins, in degrees of elevation.
        from_degrees: f64,
        /// Where it ends.
        to_degrees: f64,
    },
    /// The arm sinks as the person tires.
    Fatigue {
        /// By how many degrees a minute (1 to 3 are usual).
        degrees_per_minute: f64,
    },
    /// The first pull of an iteration startles the person: the arm jerks back.
    Startle {
        /// How far, in metres (5 to 10 cm).
        metres: f64,
    },
    /// The person does not keep to the movement that was asked for.
    NonCompliance {
        /// In which share of the iterations.
        share: f64,
    },
}

impl Impairment {
    pub(super) fn check(&self, key: &str) -> Result<(), PersonError> {
        let range = |name: &str, value: f64, range| PersonError::range(format!("{key}.{name}"), value, range);
        match *self {
            Self::LimitedRange { share } | Self::Weakness { share } => range("share", share, (0.1, 1.0)),
            Self::NonCompliance { share } => range("share", share, (0.0, 1.0)),
            Self::Tremor { amplitude_metres, frequency_hz } => {
                range("amplitude_metres", amplitude_metres, (0.0, 0.03))?;
                range("frequency_hz", frequency_hz, (2.0, 14.0))
            }
            Self::OneSided { tone_newton_seconds_per_metre } => {
                range("tone_newton_seconds_per_metre", tone_newton_seconds_per_metre, (0.0, 200.0))
            }
            Self::Fatigue { degrees_per_minute } => range("degrees_per_minute", degrees_per_minute, (0.0, 20.0)),
            Self::Startle { metres } => range("metres", metres, (0.0, 0.2)),
            Self::PainfulArc { from_degrees, to_degrees } => {
                range("from_degrees", from_degrees, (0.0, 180.0))?;
                range("to_degrees", to_degrees, (0.0, 180.0))?;
                if from_degrees < to_degrees {
                    return Ok(());
                }
                Err(PersonError::Contradiction {
                    key: key.to_owned(),
                    reason: format!(
                        "the painful arc begins at {from_degrees} degrees and ends before, at {to_degrees}"
                    ),
                })
            }
        }
    }

    /// How an arm with this impairment answers, in place of one without.
    fn changed(&self, mut response: Response, posture: &ArmAngles) -> Response {
        match *self {
            Self::Weakness { share } => {
                response.lateral_stiffness_newtons_per_metre *= share;
                response.reflex_rate_newtons_per_second *= share;
            }
            Self::OneSided { .. } => {
                (response.reflex_rate_newtons_per_second, response.yield_share) = (0.0, 0.0);
            }
            Self::PainfulArc { from_degrees, to_degrees }
                if (from_degrees..=to_degrees).contains(&posture.elevation_degrees) =>
            {
                response.reaction_seconds *= PAIN_HASTE;
                response.reflex_rate_newtons_per_second *= PAIN_STIFFENING;
                response.yield_share *= PAIN_YIELD;
            }
            _ => {}
        }
        response
    }
}

/// The impairments of one arm at work.
#[derive(Clone, Debug, Default)]
pub(super) struct Impaired {
    list: Vec<Impairment>,
    seconds: f64,
    startled_at: Option<f64>,
    whim: Vector,
}

impl Impaired {
    pub(super) fn new(list: &[Impairment]) -> Self {
        Self { list: list.to_vec(), ..Self::default() }
    }

    /// How the arm answers.
    pub(super) fn response(&self, healthy: Response, posture: &ArmAngles) -> Response {
        self.list.iter().fold(healthy, |response, impairment| impairment.changed(response, posture))
    }

    /// True where the arm moves by itself.
    pub(super) fn moves(&self) -> bool {
        !self.list.is_empty()
    }

    pub(super) fn advance(&mut self, seconds: f64) {
        self.seconds += seconds;
    }

    /// A pull has lasted for the reaction time.
    pub(super) fn feel(&mut self) {
        self.startled_at.get_or_insert(self.seconds);
    }

    /// Another iteration begins.
    pub(super) fn end_pass(&mut self, random: &mut Random) {
        self.startled_at = None;
        self.whim = Vector::zeros();
        for impairment in &self.list {
            if let Impairment::NonCompliance { share } = impairment
                && random.uniform() < *share
            {
                self.whim = random.normal_vector(WHIM_METRES / 3.0_f64.sqrt());
            }
        }
    }

    /// How far the middle of the arm is from where a healthy one would be, in metres.
    pub(super) fn displacement(&self) -> Vector {
        let startled = self.startled_at.map_or(NEVER, |at| self.seconds - at) < STARTLED_SECONDS;
        self.list.iter().fold(self.whim, |sum, impairment| {
            sum + match *impairment {
                Impairment::Tremor { amplitude_metres, frequency_hz } => {
                    let turn = std::f64::consts::TAU * frequency_hz * self.seconds;
                    Vector::new(turn.sin(), 0.0, turn.cos()) * amplitude_metres
                }
                Impairment::Fatigue { degrees_per_minute } => {
                    let sunk = (degrees_per_minute * self.seconds / 60.0).to_radians();
                    -Vector::z() * (sunk.min(1.0) * UPPER_ARM_METRES)
                }
                Impairment::Startle { metres } if startled => Vector::x() * metres,
                _ => Vector::zeros(),
            }
        })
    }

    /// How far the arm can give way, in metres.
    pub(super) fn gives_way_metres(&self) -> f64 {
        self.list.iter().fold(NEVER, |least, impairment| match impairment {
            Impairment::LimitedRange { share } => least.min(share * GIVES_WAY_METRES),
            _ => least,
        })
    }

    /// Force against a pull at a speed in metres per second, in newtons.
    pub(super) fn tone(&self, speed: f64) -> f64 {
        let tone = |impairment: &Impairment| match impairment {
            Impairment::OneSided { tone_newton_seconds_per_metre } => tone_newton_seconds_per_metre * speed,
            _ => 0.0,
        };
        self.list.iter().map(tone).sum()
    }
}

/// Share of the usual movement that is left to an arm with these impairments.
pub(super) fn range_share(list: &[Impairment]) -> f64 {
    list.iter().fold(1.0, |least: f64, impairment| match impairment {
        Impairment::LimitedRange { share } => least.min(*share),
        _ => least,
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::random::Purpose;
    use super::super::reaction::{Pull, Reaction};
    use super::super::{SimulatedArm, SimulatedPerson};
    use super::*;
    use crate::body::Side;

    fn reaction(impairments: &[Impairment]) -> Reaction {
        let mut person = SimulatedPerson::default();
        person.right.impairments = impairments.to_vec();
        person.right.response.path_jitter_metres = 0.0;
        let path = person.preferred_path(Side::Right);
        Reaction::of(&person.right, path, Random::new(1, Purpose::RightArm))
    }

    /// The force of an arm that is pulled for a second, beat by beat, in newtons.
    fn pulled(reaction: &mut Reaction) -> Vec<f64> {
        let pull = Pull { excess: Vector::x() * 0.03, speed: 0.1, advancing: true };
        (0..100).map(|_| reaction.react(&pull, 0.01).norm()).collect()
    }

    #[test]
    fn a_weak_arm_stiffens_more_slowly_and_one_in_pain_faster() {
        let at = |impairments: &[Impairment]| pulled(&mut reaction(impairments))[18];
        let (weak, healthy) = (at(&[Impairment::Weakness { share: 0.3 }]), at(&[]));
        let pain = at(&[Impairment::PainfulArc { from_degrees: 30.0, to_degrees: 120.0 }]);
        assert!(weak < 0.5 * healthy && healthy < pain, "{weak} {healthy} {pain}");
        let elsewhere = at(&[Impairment::PainfulArc { from_degrees: 60.0, to_degrees: 120.0 }]);
        assert_eq!(elsewhere.to_bits(), healthy.to_bits(), "an arm below the arc feels no pain");
    }

    #[test]
    fn a_passive_arm_resists_by_its_tone_alone() {
        let mut arm = reaction(&[Impairment::OneSided { tone_newton_seconds_per_metre: 40.0 }]);
        assert!(pulled(&mut arm).iter().all(|force| (force - 4.0).abs() < 1e-9));
    }

    #[test]
    fn tremor_fatigue_and_startle_move_the_arm() {
        let way = |impairment: Impairment| {
            let mut arm = reaction(&[impairment]);
            let pull = Pull { excess: Vector::x() * 0.03, speed: 0.1, advancing: true };
            let places = (0..6000).map(|_| {
                arm.react(&pull, 0.01);
                arm.displacement()
            });
            places.collect::<Vec<_>>()
        };
        let tremor = way(Impairment::Tremor { amplitude_metres: 0.003, frequency_hz: 6.0 });
        assert!(tremor.iter().all(|place| (place.norm() - 0.003).abs() < 1e-9));
        let tired = way(Impairment::Fatigue { degrees_per_minute: 3.0 });
        assert!((tired[5999].z + 3.0_f64.to_radians() * UPPER_ARM_METRES).abs() < 1e-4);
        let startled = way(Impairment::Startle { metres: 0.08 });
        assert!(startled.iter().filter(|place| place.x > 0.07).count().abs_diff(20) <= 1);
        assert_eq!(startled[5999], Vector::zeros(), "the arm comes back");
    }

    #[test]
    fn who_does_not_comply_likes_another_movement_in_the_next_iteration() {
        let moved = |share| {
            let mut arm = reaction(&[Impairment::NonCompliance { share }]);
            let before = arm.path().to_vec();
            arm.end_pass();
            arm.path() != before
        };
        assert!(moved(1.0) && !moved(0.0));
    }

    #[test]
    fn a_limited_range_leaves_less_movement_and_less_giving_way() {
        let limited = [Impairment::LimitedRange { share: 0.5 }];
        assert_eq!(range_share(&limited).to_bits(), 0.5_f64.to_bits());
        let given = |impairments: &[Impairment]| {
            let mut arm = reaction(impairments);
            let pull = Pull { excess: Vector::x() * 0.5, speed: 0.0, advancing: false };
            for _ in 0..50 {
                arm.react(&pull, 0.01);
            }
            arm.displacement().norm()
        };
        assert!((given(&limited) - 0.05).abs() < 1e-9 && given(&[]) > 0.1);
    }

    #[test]
    fn impairments_that_contradict_themselves_or_that_nobody_has_are_refused_by_key() {
        let refused = |impairment: Impairment| {
            let arm = SimulatedArm { impairments: vec![impairment], ..SimulatedArm::default() };
            SimulatedPerson { right: arm, ..SimulatedPerson::default() }.check().unwrap_err().to_string()
        };
        let message = refused(Impairment::PainfulArc { from_degrees: 120.0, to_degrees: 60.0 });
        assert!(message.contains("right.impairments[0]") && message.contains("contradicts"), "{message}");
        assert!(refused(Impairment::Weakness { share: 0.0 }).contains("right.impairments[0].share"));
        assert!(refused(Impairment::Tremor { amplitude_metres: f64::NAN, frequency_hz: 6.0 }).contains("amplitude"));
    }

    #[test]
    fn a_profile_names_impairments_by_kind() {
        let text = "[right]\nimpairments = [{ kind = \"tremor\", amplitude_metres = 0.002, frequency_hz = 6.0 }]\n";
        let person: SimulatedPerson = toml::from_str(text).unwrap();
        assert_eq!(person.right.impairments, [Impairment::Tremor { amplitude_metres: 0.002, frequency_hz: 6.0 }]);
        assert!(toml::from_str::<SimulatedPerson>("[right]\nimpairments = [{ kind = \"gout\" }]\n").is_err());
    }
}
