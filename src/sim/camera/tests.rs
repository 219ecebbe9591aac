use super::*;
use crate::body::{Joint, Side};
use crate::vision::part::{NONE, OTHER, parts_of};
use crate::vision::{Part, PoseFinder};

fn subject(seed: u64) -> Sampled {
    Subject::sampled(seed).at_random(seed)
}

#[test]
fn the_same_seed_gives_the_same_image_and_another_seed_another() {
    let sampled = subject(3);
    let render = |seed| sampled.scene.render(&sampled.camera, (160, 120), Some(&SensorNoise::default()), seed).depth;
    assert_eq!(render(1), render(1));
    assert_ne!(render(1), render(2));
}

#[test]
fn every_pixel_of_a_part_lies_near_that_part_s_arm() {
    let sampled = subject(4);
    let view = sampled.scene.render(&sampled.camera, IMAGE_SIZE, None, 1);
    let mut seen = 0;
    for (index, label) in view.labels.iter().enumerate() {
        let Some((side, part)) = Part::from_label(*label) else { continue };
        if part == Part::Shoulder {
            continue;
        }
        let (column, row) = (index % IMAGE_SIZE.0, index / IMAGE_SIZE.0);
        let depth = f64::from(view.depth.at(column, row)) / 1000.0;
        let point = sampled.camera.point(column as f64, row as f64, depth);
        let ends = match part {
            Part::UpperArm => [Joint::Shoulder, Joint::Elbow],
            Part::Forearm => [Joint::Elbow, Joint::Wrist],
            _ => [Joint::Wrist, Joint::Hand],
        }
        .map(|joint| sampled.scene.joint(side, joint));
        let foot = crate::geometry::closest_on_segment(&point, &ends[0], &ends[1]);
        assert!((point - foot).norm() < 0.15, "{part:?} {:?}", point - foot);
        seen += 1;
    }
    assert!(seen > 1000, "{seen}");
}

#[test]
fn the_empty_scene_has_furniture_and_no_part_and_the_person_is_nearer() {
    let sampled = subject(5);
    let full = sampled.scene.render(&sampled.camera, IMAGE_SIZE, None, 1);
    let empty = sampled.scene.empty().render(&sampled.camera, IMAGE_SIZE, None, 1);
    assert!(empty.labels.iter().all(|label| *label == OTHER || *label == NONE));
    for ((label, depth), behind) in full.labels.iter().zip(full.depth.millimetres()).zip(empty.depth.millimetres()) {
        if Part::from_label(*label).is_some() {
            assert!(*behind == 0 || depth <= behind);
        }
    }
}

#[test]
fn a_person_who_faces_the_lower_edge_has_the_left_arm_at_large_x() {
    let sampled = subject(6);
    let [left, right] = [Side::Left, Side::Right].map(|side| sampled.scene.joint(side, Joint::Shoulder));
    assert!(left.x > right.x);
}

#[test]
fn the_robot_s_camera_sees_both_shoulders_of_the_person_it_stands_behind_with_the_left_one_at_small_x() {
    let person = SimulatedPerson::default();
    let arms = person.posture();
    let camera = Intrinsics::default();
    let view = view(&person, &arms, &camera, &robot_mount(), 1);
    for side in Side::BOTH {
        let label = Part::Shoulder.label(side);
        let seen = view.labels.iter().map(|found| u32::from(*found == label)).sum::<u32>();
        assert!(seen > 2000, "{side}: {seen}");
    }
    let columns = [Side::Left, Side::Right].map(|side| {
        let point = robot_mount().inverse() * arms.get(side).shoulder;
        camera.pixel(&point).unwrap().0
    });
    assert!(columns[0] < columns[1]);
}

#[test]
fn with_true_labels_joints_are_found_within_centimetres_and_covered_ones_are_not_made_up() {
    let (mut errors, mut finder) = (Vec::new(), PoseFinder::new(crate::vision::generic::forest().unwrap()));
    for number in 0..6 {
        let image = dataset::Frame { person: 9_000 + number, number: 2 * number }.render();
        let labels = &image.rendering.labels;
        let found = finder.find_in_labels(&image.rendering.depth, labels, &image.view()).unwrap();
        for (side, arm) in found.arms.iter() {
            for joint in Joint::ALL {
                let own = |label: &&u8| parts_of(joint).iter().any(|part| part.label(side) == **label);
                match arm.position(joint) {
                    None => {}
                    Some(_) if labels.iter().filter(own).count() < 20 => panic!("{side} {joint} is covered"),
                    Some(place) => errors.push((place - image.sampled.scene.joint(side, joint)).norm()),
                }
            }
        }
    }
    assert!(errors.len() > 40, "{}", errors.len());
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    assert!(mean < 0.025, "{mean}");
}
