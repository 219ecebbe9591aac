//! S-16 to S-18 and S-20: what a whole trial makes of its force: the arm's own acceleration, work, a bias, and a broken window.

use super::room::{BRAKING_BEATS, Room, pulled, unaltered};
use std::time::Duration;
use valet::body::Side;
use valet::command::Command;
use valet::geometry::{Point, Vector};
use valet::safety::ExpectedPull;
use valet::snapshot::{ForceTier, ForceView, TrialPhase};
use valet::supervisor::{Input, Setup};

fn seen(room: &Room) -> ForceView {
    room.supervisor.snapshot(room.now).sides.right.force.clone()
}

/// The gripper's velocity and acceleration as they were sent last, in m/s and m/s².
fn motion(room: &Room) -> (Vector, Vector) {
    let places: Vec<Point> = room.places(Side::Right, room.sent.len().saturating_sub(3));
    let [first, second, third] = places[..] else { return (Vector::zeros(), Vector::zeros()) };
    ((third - second) / 0.01, ((third - second) - (second - first)) / 1e-4)
}

/// The loads that are judged while the arms brake and go on again, with so much mass at the gripper, known or not.
fn loads(felt_kilograms: f64, known_kilograms: f64) -> Vec<f64> {
    let mut setup = Setup::default();
    setup.settings.guard.inertia.mass_kilograms = known_kilograms;
    let mut room = Room::with(setup);
    room.until(TrialPhase::Dressing);
    let mut loads = Vec::new();
    for beat in 0..300 {
        if beat == 120 {
            assert!(room.ask(Command::Hold).is_accepted());
        }
        if beat == 240 {
            assert!(room.ask(Command::Continue).is_accepted());
        }
        let (_, acceleration) = motion(&room);
        room.beats(1, pulled(acceleration * -felt_kilograms));
        loads.push(seen(&room).load.unwrap());
    }
    loads
}

#[test]
fn s_16_what_the_arms_own_acceleration_adds_to_the_force_is_not_judged() {
    let largest = |some: &[f64], other: &[f64]| {
        some.iter().zip(other).map(|(some, other)| (some - other).abs()).fold(0.0, f64::max)
    };
    let still = loads(0.0, 0.0);
    let masked = largest(&still, &loads(3.0, 3.0));
    let unmasked = largest(&still, &loads(3.0, 0.0));
    assert!(masked < 0.3 * unmasked && unmasked > 0.5, "{masked} N with, {unmasked} N without the mask");
}

#[test]
fn s_17_a_pull_below_its_tier_that_goes_on_for_long_slows_the_arm_for_its_work() {
    let mut setup = Setup::default();
    // Less than by default and nothing expected, so that it comes before the end of the pass.
    let guard = &mut setup.settings.guard;
    (guard.work_free_newtons, guard.work_joules, guard.expected) = (2.0, 0.2, ExpectedPull::none());
    let mut room = Room::with(setup);
    room.until(TrialPhase::Dressing);
    let (mut against, mut newtons) = (Vector::zeros(), 0.0);
    for _ in 0..1500 {
        // It grows with the way, more gently than a catch does.
        let (velocity, _) = motion(&room);
        if newtons < 0.05 {
            against = -velocity.try_normalize(1e-3).unwrap_or_default();
        }
        newtons = f64::min(newtons + 15.0 * velocity.norm() * 0.01, 5.0);
        room.beats(1, pulled(against * newtons));
        let force = seen(&room);
        if force.tier_cause.contains("J of work") {
            assert_eq!(force.tier, ForceTier::Slow);
            assert!(force.load.unwrap() < 12.0, "{:?}", force.load);
            return;
        }
        assert_eq!(room.phase(), TrialPhase::Dressing, "at {newtons} N: {}", room.hold_cause());
    }
    panic!("never slowed");
}

#[test]
fn s_18_a_bias_is_taken_away_by_the_operators_zero_and_the_cap_holds_with_and_without_one() {
    let bias = || pulled(Vector::new(5.0, -4.0, 7.0));
    let held = || {
        let mut room = Room::dressing();
        room.ask(Command::Hold);
        room.beats(BRAKING_BEATS, unaltered);
        // Bias creeps in as an arm settles: no jump that would be a touch.
        for share in 0..200 {
            room.beats(1, pulled(Vector::new(5.0, -4.0, 7.0) * (f64::from(share) / 200.0)));
        }
        room.beats(100, bias());
        room
    };
    let mut room = held();
    assert!(seen(&room).tier >= ForceTier::Advise, "{:?}", seen(&room).load);
    let receipt = room.ask(Command::Tare(Side::Right));
    assert!(receipt.is_accepted(), "{receipt:?}");
    room.beats(100, bias());
    assert!(seen(&room).tier == ForceTier::Normal && seen(&room).load.unwrap() < 1.0, "{:?}", seen(&room).load);
    assert!(!room.supervisor.is_stopped());
    let stops = |mut room: Room| {
        room.beats(2, pulled(Vector::new(0.0, 0.0, 45.0)));
        room.supervisor.is_stopped()
    };
    assert!(stops(room) && stops(held()));
}

/// A trial whose right force is altered once, and how full its window is at the beats that follow.
fn filled_after(mut alter: impl FnMut(Input) -> Option<Input>) -> (Vec<u32>, String) {
    let mut room = Room::new();
    room.until(TrialPhase::Dressing);
    room.beats(60, unaltered);
    assert_eq!(seen(&room).window.filled, seen(&room).window.length);
    room.beats(1, |input| match &input {
        Input::Endpoint(sample) if sample.side == Side::Right => alter(input),
        _ => Some(input),
    });
    let mut filled = Vec::new();
    let mut why = String::new();
    for _ in 0..25 {
        room.beats(1, unaltered);
        filled.push(seen(&room).window.filled);
        if why.is_empty() {
            why = seen(&room).window.broken;
        }
    }
    assert!(matches!(room.phase(), TrialPhase::Dressing | TrialPhase::Holding));
    (filled, why)
}

#[test]
fn s_20_one_missing_late_or_older_sample_empties_the_window_of_a_running_pass_and_it_fills_by_itself() {
    let later = |span: i64| {
        move |mut input: Input| {
            if let Input::Endpoint(sample) = &mut input {
                let stamp = sample.stamp;
                sample.stamp = if span < 0 {
                    valet::time::Stamp::from_nanoseconds(stamp.nanoseconds() - span.unsigned_abs())
                } else {
                    stamp + Duration::from_nanos(span.unsigned_abs())
                };
            }
            Some(input)
        }
    };
    let cases = [
        ("missing", filled_after(|_| None)),
        ("late", filled_after(later(7_000_000))),
        ("older", filled_after(later(-40_000_000))),
    ];
    for (what, (filled, why)) in cases {
        assert!(filled[0] <= 1, "{what}: {filled:?}");
        assert!(!why.is_empty(), "{what}: the reason is told");
        assert_eq!(filled.last(), Some(&15), "{what}: {filled:?}");
    }
}
