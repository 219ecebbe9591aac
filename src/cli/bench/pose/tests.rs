use super::*;
use crate::cli::sim_images;
use crate::sim::camera::dataset::{Frame, training_set};
use crate::vision::training::{Settings, train};

/// A forest that has seen a few people: enough to find some joints.
fn forest(path: &Path) {
    let frames: Vec<Frame> = Frame::list(12, 1, 100).collect();
    let settings = Settings { features: 60, depth: 12, ..Settings::default() };
    let tree = train(&training_set(&frames, 545.0, 40, &|| ()), &settings, &|_| ()).unwrap();
    std::fs::write(path, Forest::new(545.0, "a test".into(), vec![tree]).to_bytes().unwrap()).unwrap();
}

fn arguments(folder: &Path) -> Arguments {
    Arguments {
        images: folder.join("images"),
        empty: Some(folder.join("images/empty")),
        out: folder.join("found"),
        forest: Some(folder.join("forest")),
        facing: FacingChoice::LowerEdge,
        json: true,
    }
}

#[test]
fn good_images_get_labels_and_joints_and_bad_ones_are_named_without_stopping_the_rest() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = arguments(folder.path());
    forest(&folder.path().join("forest"));
    sim_images::write(&arguments.images, 3, 1).unwrap();
    run(&arguments).unwrap();
    let lines = std::fs::read_to_string(arguments.out.join("joints.jsonl")).unwrap();
    assert_eq!(lines.lines().count(), 3);
    let line: serde_json::Value = serde_json::from_str(lines.lines().next().unwrap()).unwrap();
    assert_eq!(line["file"], "00000.png");
    for side in ["left", "right"] {
        let arm = line["joints"][side].as_object().unwrap();
        let mut names: Vec<&str> = arm.keys().map(String::as_str).collect();
        names.sort_unstable();
        assert_eq!(names, ["elbow", "forearm", "hand", "shoulder", "upper_arm", "wrist"]);
        assert!(arm.values().all(|place| place.is_null() || place.as_array().unwrap().len() == 3));
    }
    assert!(lines.contains("[0") || lines.contains("[-0"), "no joint at all is seen");

    std::fs::write(arguments.images.join("00001.json"), "{}").unwrap();
    let blind = DepthImage::new(640, 480, vec![0; 640 * 480]).unwrap();
    super::super::super::images::write_depth(&arguments.images.join("00002.png"), &blind).unwrap();
    let error = run(&arguments).unwrap_err();
    assert!(error.to_string().contains("2 of 3"), "{error}");
    assert_eq!(std::fs::read_to_string(arguments.out.join("joints.jsonl")).unwrap().lines().count(), 1);
}

#[test]
fn each_bad_image_has_its_own_words() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = arguments(folder.path());
    forest(&folder.path().join("forest"));
    sim_images::write(&arguments.images, 2, 1).unwrap();
    let picture = arguments.images.join("00000.png");
    let mut bench = Bench::open(&arguments).unwrap();
    let notes = std::fs::read_to_string(picture.with_extension("json")).unwrap();
    let with_neck = |neck: &str| {
        let mut value: serde_json::Value = serde_json::from_str(&notes).unwrap();
        value["neck_m"] = serde_json::from_str(neck).unwrap();
        std::fs::write(picture.with_extension("json"), value.to_string()).unwrap();
    };
    with_neck("[0, 0, 40]");
    assert!(bench.judge(&picture).unwrap_err().contains("neck"));
    std::fs::write(picture.with_extension("json"), &notes).unwrap();
    let small = DepthImage::new(320, 240, vec![900; 320 * 240]).unwrap();
    super::super::super::images::write_depth(&picture, &small).unwrap();
    let error = bench.judge(&picture).unwrap_err();
    assert!(error.contains("00000.png") && error.contains("320 x 240") | error.contains("640 x 480"), "{error}");
    std::fs::write(&picture, b"no image").unwrap();
    assert!(bench.judge(&picture).unwrap_err().contains("00000.png"));
}

#[test]
fn folders_and_forests_that_are_not_there_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = arguments(folder.path());
    assert!(run(&arguments).unwrap_err().to_string().contains("forest"));
    std::fs::write(folder.path().join("forest"), b"nothing").unwrap();
    assert!(run(&arguments).unwrap_err().to_string().contains("valet train"));
    forest(&folder.path().join("forest"));
    let without_empty = Arguments { empty: None, ..arguments };
    assert!(run(&without_empty).unwrap_err().to_string().contains("images"));
    std::fs::create_dir_all(folder.path().join("images")).unwrap();
    assert!(run(&without_empty).unwrap_err().to_string().contains("valet sim --images"));
}
