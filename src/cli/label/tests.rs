use super::super::images::write_depth;
use super::*;
use crate::vision::DepthImage;

const COLOURS: [[u8; 3]; PARTS] = [
    [220, 30, 30],
    [30, 200, 30],
    [30, 30, 220],
    [220, 220, 30],
    [220, 30, 220],
    [30, 220, 220],
    [240, 240, 240],
    [90, 60, 20],
];
const SAMPLES: &str = "[left]\nshoulder = { image = \"a.png\", column = 34, row = 24 }\nupper_arm = [30, 200, 30]\n\
forearm = [30, 30, 220]\nhand = [220, 220, 30]\n[right]\nshoulder = [220, 30, 220]\nupper_arm = [30, 220, 220]\n\
forearm = [240, 240, 240]\nhand = [90, 60, 20]\n";

/// The part whose cloth is at a column: four to each side of the middle, the subject's left at large columns.
fn part_at(column: usize) -> usize {
    if column >= 32 { (column - 32) / 8 } else { 4 + (31 - column) / 8 }
}

fn write_colour(path: &Path) {
    let file = std::fs::File::create(path).unwrap();
    let mut encoder = png::Encoder::new(file, 64, 48);
    encoder.set_color(png::ColorType::Rgb);
    let bytes: Vec<u8> = (0..64 * 48).flat_map(|index| COLOURS[part_at(index % 64)]).collect();
    encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
}

/// A folder with one image: a plate below the neck, striped in the eight colours.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let depth = (0..64 * 48).map(|index| if (16..40).contains(&(index / 64)) { 1200 } else { 0 }).collect();
    write_depth(&folder.path().join("a.png"), &DepthImage::new(64, 48, depth).unwrap()).unwrap();
    let notes = r#"{"fx": 60.0, "fy": 60.0, "cx": 31.5, "cy": 23.5, "neck_m": [0.0, -0.3, 1.1]}"#;
    std::fs::write(folder.path().join("a.json"), notes).unwrap();
    std::fs::create_dir(folder.path().join("colour")).unwrap();
    write_colour(&folder.path().join("colour/a.png"));
    std::fs::write(folder.path().join("samples.toml"), SAMPLES).unwrap();
    folder
}

fn arguments(folder: &Path) -> Arguments {
    let samples = Some(folder.join("samples.toml"));
    Arguments { images: folder.to_owned(), samples, profile: None, key: KeyArguments::default(), out: None, json: true }
}

#[test]
fn a_person_in_eight_colours_is_labelled_for_training() {
    let folder = folder();
    run(&arguments(folder.path())).unwrap();
    let file = std::fs::File::open(folder.path().join("truth/a.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut labels = vec![0; 64 * 48];
    reader.next_frame(&mut labels).unwrap();
    assert_eq!(labels[3 * 64 + 30], NONE, "no depth, no label");
    for column in (0..64).filter(|column| column % 8 != 0 && column % 8 != 7) {
        // The thesis' rule takes the half of the right forearm that lies further back than the right upper arm.
        let rows = if part_at(column) == 6 { 30..36 } else { 20..36 };
        for row in rows {
            assert_eq!(usize::from(labels[row * 64 + column]), part_at(column), "column {column}, row {row}");
        }
    }
}

#[test]
fn what_is_missing_broken_or_alike_is_named_with_its_file() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let failure = || run(&arguments(folder.path())).unwrap_err().to_string();
    let complaint = |text: &str| {
        std::fs::write(at("samples.toml"), text).unwrap();
        samples_in(&at("samples.toml"), folder.path()).unwrap_err()
    };
    assert!(complaint(&SAMPLES.replace("hand = [90, 60, 20]", "")).contains("samples.toml"));
    assert!(complaint(&SAMPLES.replace("[90, 60, 20]", "[240, 240, 238]")).contains("differ by"));
    assert!(complaint(&SAMPLES.replace("column = 34", "column = 64")).contains("pick inside the image"));
    assert!(complaint(&SAMPLES.replace("a.png", "b.png")).contains("b.png"));
    std::fs::write(at("samples.toml"), SAMPLES).unwrap();
    std::fs::copy(at("a.png"), at("c.png")).unwrap();
    assert!(failure().contains("1 of 2 images"));
    assert!(at("truth/a.png").exists() && !at("truth/c.png").exists());
    let colours = samples_in(&at("samples.toml"), folder.path()).unwrap();
    assert!(label(&at("c.png"), &at("truth/c.png"), &colours).unwrap_err().contains("c.json"));
    std::fs::copy(at("a.json"), at("c.json")).unwrap();
    assert!(label(&at("c.png"), &at("truth/c.png"), &colours).unwrap_err().contains("colour/c.png"));
    std::fs::copy(at("a.png"), at("colour/c.png")).unwrap();
    assert!(label(&at("c.png"), &at("truth/c.png"), &colours).unwrap_err().contains("8 bits"));
}

#[test]
fn colours_of_a_profile_label_as_those_of_a_file_do_and_a_profile_without_any_says_what_to_do() {
    let folder = folder();
    run(&arguments(folder.path())).unwrap();
    let from_file = std::fs::read(folder.path().join("truth/a.png")).unwrap();
    let colours = in_profile(&SampleColours(COLOURS)).unwrap();
    let profile = folder.path().join("p-01.toml");
    let of_profile = |path: &Path| Arguments {
        samples: None,
        profile: Some(path.to_string_lossy().into_owned()),
        ..arguments(folder.path())
    };
    std::fs::write(&profile, "version = 1\npseudonym = \"p-01\"\n").unwrap();
    let words = run(&of_profile(&profile)).unwrap_err().to_string();
    assert!(words.contains("p-01.toml") && words.contains("--samples"), "{words}");
    std::fs::write(&profile, format!("version = 1\npseudonym = \"p-01\"\n{colours}")).unwrap();
    run(&of_profile(&profile)).unwrap();
    assert_eq!(std::fs::read(folder.path().join("truth/a.png")).unwrap(), from_file);
}
