use super::super::sim_images;
use super::*;
use std::path::Path;

fn arguments(out: &Path) -> Arguments {
    Arguments {
        out: out.to_path_buf(),
        from: None,
        generic: false,
        images: 6,
        trees: Some(2),
        depth: 6,
        pixels: 20,
        neck_share: 0.5,
        features: 20,
        thresholds: 5,
        seed: 3,
        json: true,
    }
}

fn forest(file: &Path) -> Forest {
    Forest::from_bytes(&std::fs::read(file).unwrap()).unwrap()
}

#[test]
fn a_simulated_person_s_forest_is_written_and_the_same_seed_writes_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("a"), folder.path().join("b"));
    run(&arguments(&first)).unwrap();
    run(&arguments(&second)).unwrap();
    assert_eq!(forest(&first).trees().len(), 2);
    assert_eq!(std::fs::read(&first).unwrap(), std::fs::read(&second).unwrap());
    assert_ne!(forest(&first).trees()[0], forest(&first).trees()[1]);
    run(&Arguments { seed: 4, ..arguments(&second) }).unwrap();
    assert_ne!(std::fs::read(&first).unwrap(), std::fs::read(&second).unwrap());
}

#[test]
fn a_generic_forest_has_three_trees() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("generic.forest");
    run(&Arguments { generic: true, trees: None, images: 4, ..arguments(&file) }).unwrap();
    assert_eq!(forest(&file).trees().len(), 3);
    assert!(forest(&file).description.contains("people"));
}

#[test]
fn own_images_teach_and_what_they_lack_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let images = folder.path().join("images");
    sim_images::write(&images, 3, 1).unwrap();
    let own = Arguments { from: Some(images.clone()), ..arguments(&folder.path().join("own.forest")) };
    run(&own).unwrap();
    assert!(forest(&own.out).description.starts_with("2 own images"));
    std::fs::remove_file(&own.out).unwrap();
    std::fs::write(images.join("truth/joints.jsonl"), "{\"file\": 3}\n").unwrap();
    assert!(run(&own).unwrap_err().to_string().contains("line 1"));
    std::fs::remove_file(images.join("truth/joints.jsonl")).unwrap();
    std::fs::remove_file(images.join("truth/00001.png")).unwrap();
    let error = run(&own).unwrap_err().to_string();
    assert!(error.contains("truth/00001.png") && error.contains("8 bits"), "{error}");
    assert!(!own.out.exists(), "no half-written forest is left");
}

#[test]
fn an_empty_folder_and_settings_that_cannot_be_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("never");
    let error = run(&Arguments { from: Some(folder.path().into()), ..arguments(&out) }).unwrap_err();
    assert!(error.to_string().contains("no NAME.png"));
    let error = run(&Arguments { depth: 99, ..arguments(&out) }).unwrap_err();
    assert!(error.to_string().contains("depth"), "{error}");
    assert!(!out.exists());
}

#[test]
fn people_of_different_seeds_and_trees_are_different() {
    let base = arguments(Path::new("x"));
    let other = Arguments { seed: 4, ..base.clone() };
    let mut firsts =
        [people_from(&base, 0), people_from(&base, 15), people_from(&base, KEPT_PEOPLE), people_from(&other, 0)];
    firsts.sort_unstable();
    assert!(firsts.windows(2).all(|pair| pair[1] - pair[0] >= 1 << 20));
}
