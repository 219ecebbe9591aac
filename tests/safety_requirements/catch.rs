//! S-13 and S-14: a force that calls for a stop, and a soft catch, in a whole trial.

use super::room::{Room, unaltered};
use std::time::Duration;
use valet::body::Side;
use valet::geometry::Point;
use valet::snapshot::TrialPhase;
use valet::supervisor::{Effect, Input, Setup};

#[test]
fn s_14_a_soft_catch_that_the_window_does_not_see_moves_the_path_before_10_newtons() {
    let mut setup = Setup::default();
    // The thesis' detector is as good as off.
    setup.settings.window.threshold_newtons = 15.0;
    let mut room = Room::with(setup);
    room.until(TrialPhase::Dressing);
    room.beats(100, unaltered);
    let (mut caught_at, mut most): (Option<Point>, f64) = (None, 0.0);
    let told = room.told.len();
    let spring = |input: Input| {
        let mut input = input;
        if let Input::Endpoint(sample) = &mut input
            && sample.side == Side::Right
        {
            let place: Point = sample.pose.translation.vector.into();
            let pull = (*caught_at.get_or_insert(place) - place) * 60.0;
            most = most.max(pull.norm());
            sample.wrench.force -= pull;
        }
        Some(input)
    };
    room.beats(250, spring);
    let moved = room.told[told..].iter().any(|effect| matches!(effect, Effect::Waypoint { .. }));
    assert!(moved, "the path gave way; the pull reached {most} N");
    assert!(most < 10.0, "{most} N");
}

#[test]
fn s_13_one_sample_beyond_the_cap_stops_although_a_mild_one_follows_within_the_same_beat() {
    let mut room = Room::dressing();
    let mut newest = None;
    room.beats(1, |input| {
        if let Input::Endpoint(sample) = &input
            && sample.side == Side::Right
        {
            newest = Some(*sample);
        }
        Some(input)
    });
    let mut mild = newest.unwrap();
    let mut strong = mild;
    strong.stamp = strong.stamp + Duration::from_millis(1);
    strong.wrench.force.x += 60.0;
    mild.stamp = mild.stamp + Duration::from_millis(2);
    for sample in [strong, mild] {
        room.step(&Input::Endpoint(sample));
    }
    room.step(&Input::Tick);
    assert!(room.supervisor.is_stopped());
}
