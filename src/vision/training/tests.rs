use super::*;
use crate::geometry::Point;
use crate::vision::camera::Intrinsics;
use crate::vision::probe::ProbeImage;

const CAMERA: Intrinsics = Intrinsics { fx: 500.0, fy: 500.0, cx: 32.0, cy: 24.0 };

/// A bar of foreground whose left half is class 2 and right half class 6, both joints known.
fn set(images: usize) -> TrainingSet {
    let mut set = TrainingSet::new(500.0, 20);
    for shift in 0..images {
        let mut image = ProbeImage::new(64, 48);
        let mut labels = vec![super::super::part::NONE; 64 * 48];
        for row in 20..28 {
            for column in 10 + shift..50 + shift {
                image.set(column, row, 1000);
                labels[row * 64 + column] = if column < 30 + shift { 2 } else { 6 };
            }
        }
        let joints = [Point::new(0.01, 0.0, 1.05); VOTED];
        set.add(&Example { image: &image, labels: &labels, camera: CAMERA, joints }, 7);
    }
    set
}

fn settings() -> Settings {
    Settings { features: 60, reach_metres: 0.05, depth: 6, ..Settings::default() }
}

#[test]
fn a_simple_rule_is_learnt_and_leaves_know_the_way_to_a_joint() {
    let tree = train(&set(6), &settings(), &|_| ()).unwrap();
    let mut image = ProbeImage::new(64, 48);
    (20..28).for_each(|row| (12..52).for_each(|column| image.set(column, row, 1000)));
    for (column, class) in [(14_u8, 2), (20, 2), (42, 6), (48, 6)] {
        let leaf = tree.leaf_content(tree.leaf(&image, (f32::from(column), 24.0), 1.0)).unwrap();
        assert!(leaf.shares[class] > 200, "{column} {:?}", leaf.shares);
        assert!((i32::from(leaf.votes[0].offset[2]) - 50).abs() <= 1);
        assert!(leaf.votes[0].deviation < 60);
    }
}

#[test]
fn maps_of_the_neck_tell_apart_what_depth_cannot_and_the_thesis_share_never_reads_them() {
    // A bar along which depth is the same everywhere: only the way from the neck tells its quarters apart.
    let mut set = TrainingSet::new(500.0, 60);
    let (mut image, mut labels) = (ProbeImage::default(), Vec::new());
    for shift in 0..6 {
        image = ProbeImage::new(320, 48);
        labels = vec![super::super::part::NONE; 320 * 48];
        let mut pixels = Vec::new();
        for row in 20..28 {
            for column in 10 + shift..310 {
                image.set(column, row, 1000);
                labels[row * 320 + column] = if (column / 40) % 2 == 0 { 2 } else { 6 };
                pixels.push(super::super::foreground::pixel(column, row, 1000));
            }
        }
        image.measure_from_neck(&pixels, &CAMERA, &Point::new(0.0, 0.0, 1.0));
        let joints = [Point::new(0.0, 0.0, 1.0); VOTED];
        set.add(&Example { image: &image, labels: &labels, camera: CAMERA, joints }, 7);
    }
    // Judged far from the bar's ends, on the last of the images.
    let right = |tree: &Tree| {
        let class = |column: u16| {
            let leaf = tree.leaf_content(tree.leaf(&image, (f32::from(column), 24.0), 1.0)).unwrap();
            if leaf.shares[2] > leaf.shares[6] { 2 } else { 6 }
        };
        (60..260).filter(|column| class(*column) == labels[24 * 320 + usize::from(*column)]).count()
    };
    let grow = |neck_share| train(&set, &Settings { neck_share, smallest: 40, ..settings() }, &|_| ()).unwrap();
    let (depth_alone, both) = (grow(0.0), grow(0.5));
    assert!(depth_alone.nodes.iter().all(|node| node.planes == [0; 2]));
    assert!(both.nodes.iter().any(|node| node.planes != [0; 2]));
    assert!(right(&both) > 150 && right(&depth_alone) < 140, "{} {}", right(&both), right(&depth_alone));
    assert!(Settings { neck_share: 1.5, ..settings() }.check().is_err());
}

#[test]
fn the_tree_is_the_same_whatever_the_number_of_threads() {
    let set = set(5);
    let grow = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| train(&set, &settings(), &|_| ()).unwrap())
    };
    assert_eq!(grow(1), grow(3));
}

#[test]
fn another_seed_grows_another_tree_and_progress_ends_at_the_whole() {
    let most = std::sync::Mutex::new(0.0_f64);
    let hear = |share: f64| {
        let mut most = most.lock().unwrap();
        *most = most.max(share);
    };
    let first = train(&set(3), &settings(), &hear).unwrap();
    assert!((*most.lock().unwrap() - 1.0).abs() < 1e-12);
    assert_ne!(first, train(&set(3), &Settings { seed: 2, ..settings() }, &|_| ()).unwrap());
}

#[test]
fn nothing_to_learn_from_and_settings_that_cannot_be_are_refused() {
    assert_eq!(train(&TrainingSet::new(500.0, 63), &settings(), &|_| ()), Err(TrainingError::NoSamples));
    let error = train(&set(1), &Settings { thresholds: 16, ..settings() }, &|_| ()).unwrap_err();
    assert!(error.to_string().contains("thresholds"));
}

#[test]
fn a_joint_whose_place_is_unknown_gets_no_vote() {
    let mut set = TrainingSet::new(500.0, 5);
    let mut image = ProbeImage::new(8, 8);
    (0..8).for_each(|column| image.set(column, 4, 1000));
    let mut joints = [Point::new(0.0, 0.0, 1.0); VOTED];
    joints[3] = Point::new(f64::NAN, 0.0, 0.0);
    set.add(&Example { image: &image, labels: &[1; 64], camera: CAMERA, joints }, 1);
    let tree = train(&set, &settings(), &|_| ()).unwrap();
    let leaf = tree.leaf_content(0).unwrap();
    assert_eq!(leaf.votes[3].deviation, NO_VOTE);
    assert_ne!(leaf.votes[2].deviation, NO_VOTE);
}

#[test]
fn a_cut_tree_is_the_one_that_would_have_been_trained_no_deeper() {
    let set = set(6);
    let (deep, cut) = train_with_cut(&set, &settings(), 2).unwrap();
    assert_eq!(deep, train(&set, &settings(), &|_| ()).unwrap());
    assert_eq!(cut, train(&set, &Settings { depth: 2, ..settings() }, &|_| ()).unwrap());
}
