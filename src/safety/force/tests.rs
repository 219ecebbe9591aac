//! The guard against steady, sudden, soft, spurious and self-made force.

use super::*;
use crate::safety::Reaction::{Advise, Clear, Hold, Slow, Stop};
use proptest::prelude::*;

fn guard() -> ForceGuard {
    ForceGuard::new(GuardSettings::default()).unwrap()
}

fn at(index: u64) -> Stamp {
    Stamp::from_nanoseconds(1_000_000_000 + index * 10_000_000)
}

fn sample(index: u64, force: Vector) -> GuardSample {
    GuardSample { stamp: at(index), force, ..GuardSample::default() }
}

/// The reaction to a force that stands for a second.
fn reaction_to(newtons: f64, zone: Zone) -> Reaction {
    let mut guard = guard();
    let force = Vector::new(0.6, -0.8, 0.0) * newtons;
    (0..100).map(|index| guard.observe(&GuardSample { zone, ..sample(index, force) }).reaction).last().unwrap()
}

#[test]
fn s_11_each_tier_begins_at_its_limit() {
    let expected = [(7.9, Clear), (8.1, Advise), (12.1, Slow), (15.1, Hold), (25.1, Stop), (80.0, Stop)];
    for (newtons, reaction) in expected {
        assert_eq!(reaction_to(newtons, Zone::Arm), reaction, "{newtons} N");
    }
}

#[test]
fn s_12_near_shoulder_and_neck_every_tier_is_halved() {
    let expected = [(3.9, Clear), (4.1, Advise), (6.1, Slow), (7.6, Hold), (12.6, Stop)];
    for (newtons, reaction) in expected {
        assert_eq!(reaction_to(newtons, Zone::ShoulderOrNeck), reaction, "{newtons} N");
    }
}

#[test]
fn s_13_no_setting_raises_the_hard_cap() {
    let highest = GuardSettings { tiers: Tiers::MOST, ..GuardSettings::default() };
    let mut guard = ForceGuard::new(highest.clone()).unwrap();
    guard.observe(&sample(0, Vector::zeros()));
    // A single sample is enough: the cap is not smoothed.
    let verdict = guard.observe(&sample(1, Vector::new(0.0, 35.1, 0.0)));
    assert_eq!(verdict.reaction, Stop);
    let beyond = GuardSettings { tiers: Tiers { stop: 36.0, ..Tiers::MOST }, ..highest };
    assert!(ForceGuard::new(beyond).is_err());
}

/// Pulls a spring of the stiffness (N/m) at the speed (m/s) and returns the force at which it was found.
fn found_at(stiffness: f64, speed: f64, settings: GuardSettings) -> Option<f64> {
    let mut guard = ForceGuard::new(settings).unwrap();
    let velocity = Vector::new(speed, 0.0, 0.0);
    (0..1000).find_map(|index| {
        let force = stiffness * speed * index as f64 * 0.01;
        guard.observe(&GuardSample { velocity, ..sample(index, Vector::new(-force, 0.0, 0.0)) });
        guard.catch().map(|_| force)
    })
}

#[test]
fn s_14_a_soft_spring_is_found_before_ten_newtons_at_every_speed() {
    for speed in [0.02, 0.05, 0.1, 0.2, 0.25] {
        let force = found_at(60.0, speed, GuardSettings::default()).unwrap();
        assert!(force < 8.0, "found at {force:.1} N at {speed} m/s");
    }
}

#[test]
fn s_14_a_good_pull_is_not_taken_for_a_catch() {
    for speed in [0.05, 0.1, 0.2] {
        assert_eq!(found_at(26.0, speed, GuardSettings::default()), None, "{speed} m/s");
    }
}

#[test]
fn the_resistance_of_a_catch_points_as_the_sleeve_pulls() {
    let mut guard = guard();
    let velocity = Vector::new(0.1, 0.0, 0.0);
    for index in 0..300 {
        let pull = Vector::new(-0.06, 0.03, 0.0) * index as f64;
        guard.observe(&GuardSample { velocity, ..sample(index, pull) });
        if let Some(found) = guard.catch() {
            assert!(found.resistance.normalize().dot(&Vector::new(-0.894, 0.447, 0.0)) > 0.99);
            assert!((found.magnitude - found.resistance.norm()).abs() < 1e-12);
            return;
        }
    }
    panic!("not found");
}

#[test]
fn s_15_a_force_that_is_not_finite_holds_and_is_not_taken_for_zero() {
    for bad in [f64::NAN, f64::INFINITY] {
        let mut guard = guard();
        guard.observe(&sample(0, Vector::new(9.0, 0.0, 0.0)));
        assert_eq!(guard.observe(&sample(1, Vector::new(bad, 0.0, 0.0))).reaction, Hold);
        assert_eq!(guard.load(), None);
    }
}

#[test]
fn s_16_the_arms_own_acceleration_is_no_contact() {
    let settings = GuardSettings {
        inertia: crate::sensing::InertiaCompensation { mass_kilograms: 2.0 },
        ..GuardSettings::default()
    };
    let mut guard = ForceGuard::new(settings).unwrap();
    for index in 0..200 {
        // 2.3 kg are really there: 0.3 kg more than is known.
        let acceleration = Vector::new(2.0 * (index as f64 * 0.3).sin(), 0.0, 0.0);
        let verdict = guard.observe(&GuardSample { acceleration, ..sample(index, acceleration * -2.3) });
        assert_eq!(verdict.reaction, Clear, "{}", verdict.cause);
    }
}

#[test]
fn s_17_work_beyond_what_dressing_needs_slows_the_arm_down() {
    let work = |expected_newtons: f64| {
        let mut guard = guard();
        let velocity = Vector::new(0.1, 0.0, 0.0);
        let force = Vector::new(-11.0, 0.0, 0.0);
        (0..400)
            .map(|index| guard.observe(&GuardSample { velocity, expected_newtons, ..sample(index, force) }))
            .last()
            .unwrap()
    };
    let unexpected = work(0.0);
    assert_eq!(unexpected.reaction, Slow);
    assert!(unexpected.cause.contains("J of work"), "{}", unexpected.cause);
    assert_eq!(work(9.0).reaction, Advise, "the tier alone speaks");
}

#[test]
fn s_18_a_steady_bias_is_taken_away_by_a_zero_and_the_cap_holds_without_one() {
    let mut guard = guard();
    let bias = Vector::new(5.0, -4.0, 6.0);
    for index in 0..60 {
        guard.observe(&sample(index, bias));
    }
    assert_eq!(guard.verdict().reaction, Advise);
    let beyond = Vector::new(0.0, 0.0, 36.0);
    assert_eq!(guard.clone().observe(&sample(60, beyond)).reaction, Stop, "without a zero the cap holds as well");
    guard.tare(at(60)).unwrap();
    assert_eq!(guard.observe(&sample(61, bias)).reaction, Clear);
    assert!(guard.load().unwrap().norm() < 1e-9);
}

#[test]
fn s_19_no_zero_is_taken_while_the_arm_moves() {
    let mut guard = guard();
    for index in 0..60 {
        guard.observe(&GuardSample { velocity: Vector::new(0.05, 0.0, 0.0), ..sample(index, Vector::x()) });
    }
    assert!(matches!(guard.tare(at(60)), Err(TareError::NotStill { .. })));
    assert_eq!(guard.zero(), None);
}

#[test]
fn a_tier_is_left_only_well_below_its_limit() {
    let mut guard = guard();
    let mut reaction = Clear;
    for (index, newtons) in (0..400).map(|index| {
        (
            index,
            if index < 100 {
                12.5
            } else if index < 200 {
                11.0
            } else {
                9.0
            },
        )
    }) {
        reaction = guard.observe(&sample(index, Vector::new(newtons, 0.0, 0.0))).reaction;
        match index {
            99 | 199 => assert_eq!(reaction, Slow, "at {newtons} N"),
            _ => {}
        }
    }
    assert_eq!(reaction, Advise);
}

#[test]
fn a_sudden_force_is_told_before_it_reaches_a_tier() {
    let mut guard = guard();
    for index in 0..100 {
        guard.observe(&sample(index, Vector::zeros()));
    }
    let verdict = (100..130).map(|index| guard.observe(&sample(index, Vector::new(7.0, 0.0, 0.0)))).last().unwrap();
    assert_eq!(verdict.reaction, Advise);
    assert!(verdict.cause.contains("changed by"), "{}", verdict.cause);
}

#[test]
fn a_gap_in_the_samples_does_not_join_what_lies_apart() {
    let mut guard = guard();
    let velocity = Vector::new(0.1, 0.0, 0.0);
    for index in 0..70 {
        guard.observe(&GuardSample { velocity, ..sample(index, Vector::zeros()) });
    }
    for index in 100..170 {
        guard.observe(&GuardSample { velocity, ..sample(index, Vector::new(7.0, 0.0, 0.0)) });
        assert!(guard.catch().is_none());
    }
}

#[test]
fn the_same_sample_twice_changes_nothing() {
    let mut guard = guard();
    let first = guard.observe(&sample(0, Vector::new(13.0, 0.0, 0.0)));
    assert_eq!(guard.observe(&sample(0, Vector::new(13.0, 0.0, 0.0))), first);
}

proptest! {
    #[test]
    fn s_13_no_force_beyond_the_cap_ever_passes(
        before in proptest::collection::vec([-10.0..10.0_f64, -10.0..10.0, -10.0..10.0], 0..50),
        way in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
        newtons in 35.01..1e6_f64,
    ) {
        let way = Vector::from(way);
        prop_assume!(way.norm() > 0.01);
        let mut guard = guard();
        for (index, force) in before.iter().enumerate() {
            guard.observe(&sample(index as u64, Vector::from(*force)));
        }
        let verdict = guard.observe(&sample(before.len() as u64, way.normalize() * newtons));
        prop_assert_eq!(verdict.reaction, Stop);
    }

    #[test]
    fn s_11_more_force_is_never_judged_more_mildly(newtons in 0.0..60.0_f64, more in 0.0..20.0_f64) {
        prop_assert!(reaction_to(newtons + more, Zone::Arm) >= reaction_to(newtons, Zone::Arm));
        prop_assert!(reaction_to(newtons, Zone::ShoulderOrNeck) >= reaction_to(newtons, Zone::Arm));
    }

    #[test]
    fn whatever_comes_in_a_verdict_comes_out(stream in proptest::collection::vec((0_u64..5, proptest::num::f64::ANY, proptest::num::f64::ANY), 1..100)) {
        let mut guard = guard();
        let mut index = 0;
        for (gap, force, speed) in stream {
            index += gap;
            let verdict = guard.observe(&GuardSample {
                velocity: Vector::new(speed, 0.0, 0.0),
                acceleration: Vector::new(0.0, speed, 0.0),
                expected_newtons: speed,
                ..sample(index, Vector::new(force, 0.0, 0.0))
            });
            prop_assert_eq!(verdict.cause.is_empty(), verdict.reaction == Clear);
        }
    }
}
