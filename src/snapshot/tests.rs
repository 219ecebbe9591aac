//! What follows from a snapshot's own data: stop phases, freshness, verdicts and margins.

use super::*;
use crate::body::{BodyPose, Evidence, Joint, JointEstimate, Side};
use crate::geometry::Point;

fn at(milliseconds: u64) -> Stamp {
    Stamp::from_nanoseconds(milliseconds * 1_000_000)
}

#[test]
fn a_stop_that_the_robot_does_not_confirm_in_time_sends_to_the_red_button() {
    let mut stop = StopView { latched: true, requested_at: Some(at(1000)), ..StopView::default() };
    assert_eq!(stop.phase(at(1100)), StopPhase::Requested);
    assert_eq!(stop.phase(at(1251)), StopPhase::NotConfirmed);
    assert_eq!(stop.phase(at(200)), StopPhase::NotConfirmed, "the clock went back: nobody knows how long it was");
    stop.confirmed_at = Some(at(1012));
    assert_eq!(stop.phase(at(9000)), StopPhase::Confirmed);
    assert!((stop.confirmation_seconds().unwrap() - 0.012).abs() < 1e-9);
    stop.latched = false;
    assert_eq!(stop.phase(at(9000)), StopPhase::Clear);
}

#[test]
fn a_robot_state_does_not_outlive_its_deadline() {
    let state = RobotState { stamp: at(1000), enabled: true, ..RobotState::default() };
    let robot = RobotView { state: Some(state), deadline_seconds: 0.25 };
    assert!(robot.fresh(at(1200)).is_some());
    assert!(robot.fresh(at(1300)).is_none());
    assert!(RobotView::default().fresh(at(0)).is_none());
}

#[test]
fn what_came_in_before_the_clock_went_back_stays_stale_when_the_clock_comes_there_again() {
    let fresh = Freshness { last: Some(at(1000)), deadline: 0.06 };
    let mut snapshot = Snapshot::default();
    snapshot.sides.left.force.freshness = fresh;
    snapshot.body.freshness = fresh;
    snapshot.robot.state = Some(RobotState { stamp: at(1000), ..RobotState::default() });
    let kept = snapshot.clone();
    snapshot.forget_what_lies_ahead(at(1000));
    assert_eq!(snapshot, kept, "nothing lies ahead");
    snapshot.forget_what_lies_ahead(at(300));
    assert!(!snapshot.sides.left.force.freshness.is_fresh(at(990)));
    assert!(!snapshot.body.freshness.is_fresh(at(990)));
    assert_eq!(snapshot.robot.fresh(at(990)), None);
}

#[test]
fn a_topic_is_judged_by_age_first_and_rate_second() {
    let mut topic = TopicHealth { expected: (90.0, 110.0), rate: 100.0, ..TopicHealth::default() };
    assert_eq!(topic.verdict(at(0)), Verdict::Fault);
    topic.freshness = Freshness { last: Some(at(1000)), deadline: 0.05 };
    assert_eq!(topic.verdict(at(1010)), Verdict::Good);
    topic.rate = 40.0;
    assert_eq!(topic.verdict(at(1010)), Verdict::Late);
    assert_eq!(topic.verdict(at(1060)), Verdict::Stale);
}

#[test]
fn the_next_margin_is_that_of_the_first_tier_above_the_present_one() {
    let margins = vec![
        TierMargin { tier: ForceTier::Advise, limit: 10.0 },
        TierMargin { tier: ForceTier::Slow, limit: 15.0 },
        TierMargin { tier: ForceTier::Stop, limit: 35.0 },
    ];
    let mut force =
        ForceView { load: Some(12.0), tier: ForceTier::Advise, margins: margins.into(), ..Default::default() };
    assert_eq!(force.next_margin(), Some((ForceTier::Slow, 3.0)));
    force.load = None;
    assert_eq!(force.next_margin(), None);
}

#[test]
fn a_pose_is_seen_inferred_or_lost_and_never_old() {
    let mut body = BodyView { freshness: Freshness { last: Some(at(1000)), deadline: 0.2 }, ..BodyView::default() };
    assert_eq!(body.quality(Side::Right, at(1000)), PoseQuality::Lost);
    let mut pose = BodyPose::default();
    let mut estimate = JointEstimate {
        position: Point::origin(),
        covariance: nalgebra::Matrix3::identity(),
        confidence: 1.0,
        evidence: Evidence::Seen,
    };
    pose.arms.right.set(Joint::Hand, Some(estimate));
    body.pose = Some(pose);
    assert_eq!(body.quality(Side::Right, at(1100)), PoseQuality::Seen);
    assert_eq!(body.quality(Side::Left, at(1100)), PoseQuality::Lost);
    estimate.evidence = Evidence::Inferred;
    pose.arms.right.set(Joint::Elbow, Some(estimate));
    body.pose = Some(pose);
    assert_eq!(body.qualities(at(1100)).right, PoseQuality::Inferred);
    assert_eq!(body.quality(Side::Right, at(1300)), PoseQuality::Lost);
}

#[test]
fn a_snapshot_survives_the_way_over_a_wire() {
    let mut snapshot = Snapshot { now: at(5), ..Snapshot::default() };
    snapshot.log.push(LogLine {
        id: 1,
        stamp: at(4),
        level: Level::Warning,
        source: "ros".into(),
        text: "late".into(),
    });
    let text = serde_json::to_string(&snapshot).unwrap();
    assert_eq!(serde_json::from_str::<Snapshot>(&text).unwrap(), snapshot);
}
