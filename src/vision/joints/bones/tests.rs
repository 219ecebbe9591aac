#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixels of a made-up picture lie inside it"
)]

use super::*;
use crate::vision::foreground;
use crate::vision::part::{OTHER, PARTS};

const CAMERA: Intrinsics = Intrinsics { fx: 550.0, fy: 550.0, cx: 319.5, cy: 239.5 };
const NECK: Point = Point::new(0.0, -0.2, 1.4);

/// A left arm that is bent at the elbow, seen from above: shoulder, elbow, wrist, knuckle.
fn ends() -> [Point; 4] {
    let lengths = SegmentLengths::default();
    let shoulder = Point::new(0.19, -0.18, 1.51);
    let elbow = shoulder + Vector::new(0.75, 0.55, 0.37).normalize() * lengths.upper_arm;
    let wrist = elbow + Vector::new(-0.35, 0.9, -0.1).normalize() * lengths.forearm;
    [shoulder, elbow, wrist, wrist + Vector::new(-0.2, 0.9, 0.1).normalize() * lengths.palm]
}

/// The pixels of round limbs between the ends, each with the label of its part; `seen` tells which limbs are not covered.
fn skin_of(ends: &[Point; 4], seen: [bool; LIMBS]) -> Vec<Classified> {
    let radii = [0.058, 0.048, 0.031, 0.026];
    let mut depths = vec![(f64::INFINITY, OTHER); 640 * 480];
    for limb in (0..LIMBS).filter(|limb| seen[*limb]) {
        for along in 0..400 {
            let share = f64::from(along) / 400.0;
            let axis = ends[limb + 1] - ends[limb];
            let centre = ends[limb] + axis * share;
            let radius = radii[limb] * (1.0 - share) + radii[limb + 1] * share;
            let across = axis.cross(&Vector::z()).normalize();
            for turn in 0..120 {
                let angle = f64::from(turn) / 120.0 * std::f64::consts::PI;
                let out = across * angle.cos() - across.cross(&axis.normalize()) * angle.sin();
                let point = centre + if out.z > 0.0 { Vector::new(out.x, out.y, -out.z) } else { out } * radius;
                let Some((column, row)) = CAMERA.pixel(&point) else { continue };
                let index = row.round() as usize * 640 + column.round() as usize;
                let label = if limb == 0 && share < SHOULDER_SHARE { 0 } else { 1 + limb as u8 };
                if point.z < depths[index].0 {
                    depths[index] = (point.z, label);
                }
            }
        }
    }
    let pixels = depths.iter().enumerate().filter(|(_, (depth, _))| depth.is_finite());
    let classified = |(index, (depth, label)): (usize, &(f64, u8))| Classified {
        pixel: foreground::pixel(index % 640, index / 640, (depth * 1000.0).round() as u16),
        label: *label,
    };
    pixels.map(classified).filter(|found| Sampling::Quarter.asks(found.pixel)).collect()
}

fn lay(pixels: &[Classified], known: &[Option<Mode>; 6]) -> [Found; 6] {
    let lengths = SegmentLengths::default();
    Bones::default().lay(Side::Left, pixels, &Counts::of(pixels, Sampling::Quarter), &CAMERA, (&NECK, &lengths), known)
}

fn true_place(ends: &[Point; 4], joint: Joint) -> Point {
    let [shoulder, elbow, wrist, knuckle] = *ends;
    match joint {
        Joint::Hand => knuckle,
        Joint::Wrist => wrist,
        Joint::Forearm => nalgebra::center(&elbow, &wrist),
        Joint::Elbow => elbow,
        Joint::UpperArm => shoulder + (elbow - shoulder) * 0.62,
        Joint::Shoulder => shoulder,
    }
}

#[test]
fn the_centres_of_a_bent_arm_are_found_below_its_skin() {
    let ends = ends();
    for (joint, found) in Joint::ALL.into_iter().zip(lay(&skin_of(&ends, [true; LIMBS]), &[None; 6])) {
        let off = (found.place - true_place(&ends, joint)).norm();
        assert!(found.is_seen(), "{joint}");
        assert!(off < 0.02, "{joint} is {off} m off");
    }
}

#[test]
fn a_covered_forearm_and_hand_are_not_seen_and_what_is_uncovered_stays() {
    let found = lay(&skin_of(&ends(), [true, false, false]), &[None; 6]);
    for joint in [Joint::Hand, Joint::Wrist, Joint::Forearm] {
        assert!(!found[joint.index()].is_seen(), "{joint}");
    }
    assert!(found[Joint::UpperArm.index()].is_seen());
}

#[test]
fn without_any_skin_nothing_is_seen_and_every_number_is_finite() {
    for found in lay(&[], &[None; 6]) {
        assert!(!found.is_seen());
        assert!(found.place.iter().all(|value| value.is_finite()));
    }
    assert_eq!(Counts::of(&[], Sampling::Quarter).of_class, [0; PARTS + 1]);
}

#[test]
fn a_place_that_labels_draw_far_away_from_the_votes_is_not_seen() {
    let ends = ends();
    let mut known = Joint::ALL.map(|joint| Some(Mode { place: true_place(&ends, joint), share: 1.0 }));
    let pixels = skin_of(&ends, [true; LIMBS]);
    assert!(lay(&pixels, &known).iter().all(Found::is_seen));
    known[Joint::Hand.index()] = None;
    let found = lay(&pixels, &known);
    assert!(!found[Joint::Hand.index()].is_seen() && found[Joint::Wrist.index()].is_seen());
}

#[test]
fn the_same_finder_finds_the_same_a_second_time() {
    let (pixels, lengths, mut bones) = (skin_of(&ends(), [true; LIMBS]), SegmentLengths::default(), Bones::default());
    let mut once = || {
        bones
            .lay(Side::Left, &pixels, &Counts::of(&pixels, Sampling::Quarter), &CAMERA, (&NECK, &lengths), &[None; 6])
            .map(|found| found.place)
    };
    assert_eq!(once(), once());
}
