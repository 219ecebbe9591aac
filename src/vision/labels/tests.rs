use super::*;

/// Eight colours that differ well.
const COLOURS: SampleColours = SampleColours([
    [200, 30, 30],
    [230, 140, 20],
    [230, 230, 40],
    [40, 160, 60],
    [30, 60, 200],
    [120, 40, 160],
    [60, 200, 220],
    [240, 150, 190],
]);
const WIDTH: usize = 40;
const HEIGHT: usize = 24;

/// Bands of three rows for each label, with some pixels of another colour.
fn bands(wrong: &[(usize, usize, usize)]) -> Vec<u8> {
    let mut parts: Vec<usize> = (0..WIDTH * HEIGHT).map(|index| index / WIDTH / 3).collect();
    wrong.iter().for_each(|(column, row, part)| parts[row * WIDTH + column] = *part);
    parts.iter().flat_map(|part| COLOURS.0[*part]).collect()
}

fn foreground() -> ProbeImage {
    let mut image = ProbeImage::new(WIDTH, HEIGHT);
    (0..HEIGHT).for_each(|row| (0..WIDTH).for_each(|column| image.set(column, row, 1000)));
    image
}

fn image(bytes: &[u8]) -> ColourImage<'_> {
    ColourImage { width: WIDTH, height: HEIGHT, bytes }
}

#[test]
fn colours_come_out_as_in_the_golden_table() {
    let golden: serde_json::Value =
        serde_json::from_str(include_str!("../../../tests/vectors/vision/rdf_conventions.json")).unwrap();
    let cases = golden["srgb_to_lab_d65"].as_array().unwrap();
    assert!(cases.len() > 20);
    for case in cases {
        let rgb = [0, 1, 2].map(|index| u8::try_from(case["rgb"][index].as_u64().unwrap()).unwrap());
        let found = lab(rgb);
        for (found, index) in [found.lightness, found.a, found.b].into_iter().zip(0..) {
            let index: usize = index;
            assert!((found - case["lab"][index].as_f64().unwrap()).abs() < 0.02, "{rgb:?}");
        }
    }
}

#[test]
fn shaded_cloth_keeps_its_label_and_single_wrong_pixels_are_mended() {
    let mut bytes = bands(&[(10, 7, 7), (25, 13, 0), (3, 22, 1)]);
    // Light differs by a fifth from column to column.
    for (index, value) in bytes.iter_mut().enumerate() {
        let light = 0.8 + 0.2 * ((index / 3 % WIDTH) as f64 / WIDTH as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "light only darkens")]
        let shaded = (f64::from(*value) * light) as u8;
        *value = shaded;
    }
    let labels = COLOURS.label(&image(&bytes), &foreground(), Facing::LowerEdge).unwrap();
    // The forearm's band lies ahead of the upper arm's, and the shoulder's column is the middle: only the right upper arm
    // loses its left half, by the thesis' rule.
    let expected = |index: usize| index / WIDTH / 3;
    let right = labels.iter().enumerate().filter(|(index, label)| usize::from(**label) == expected(*index)).count();
    let upper_arm = usize::from(Part::UpperArm.label(Side::Right));
    let lost =
        labels.iter().enumerate().filter(|(index, label)| **label == NONE && expected(*index) == upper_arm).count();
    assert_eq!(lost, 3 * WIDTH / 2);
    assert_eq!(right + lost, WIDTH * HEIGHT);
}

#[test]
fn what_is_background_or_has_no_colour_stays_unlabelled() {
    let mut bytes = bands(&[]);
    bytes[..3].fill(0);
    let mut image_of = foreground();
    image_of.set(5, 0, super::super::probe::BACKGROUND);
    let labels = COLOURS.label(&image(&bytes), &image_of, Facing::LowerEdge).unwrap();
    assert_eq!((labels[0], labels[5], labels[6]), (NONE, NONE, 0));
}

#[test]
fn the_thesis_rules_hold_in_the_body_s_axes_whichever_way_the_person_faces() {
    let (left_shoulder, upper_arm, forearm) =
        (Part::Shoulder.label(Side::Left), Part::UpperArm.label(Side::Right), Part::Forearm.label(Side::Right));
    let mut labels = vec![NONE; 10 * 10];
    let at = |column: usize, row: usize| row * 10 + column;
    labels[at(6, 2)] = left_shoulder;
    labels[at(2, 4)] = upper_arm;
    labels[at(8, 4)] = upper_arm;
    labels[at(2, 7)] = forearm;
    labels[at(2, 1)] = forearm;
    let mut turned: Vec<u8> = labels.iter().rev().copied().collect();
    remove_outliers(&mut labels, 10, Facing::LowerEdge);
    assert_eq!([labels[at(2, 4)], labels[at(8, 4)]], [upper_arm, NONE]);
    assert_eq!([labels[at(2, 7)], labels[at(2, 1)]], [forearm, NONE]);
    remove_outliers(&mut turned, 10, Facing::UpperEdge);
    turned.reverse();
    assert_eq!(turned, labels);
}

#[test]
fn like_colours_wrong_sizes_and_picks_outside_are_refused() {
    let mut alike = COLOURS;
    alike.0[5] = [202, 31, 29];
    assert!(matches!(alike.check(), Err(LabelError::Alike { first: 0, second: 5, .. })));
    let bytes = bands(&[]);
    let short = ColourImage { width: WIDTH, height: HEIGHT, bytes: &bytes[3..] };
    assert!(matches!(COLOURS.label(&short, &foreground(), Facing::LowerEdge), Err(LabelError::Size { .. })));
    assert_eq!(image(&bytes).pick(40, 0), Err(LabelError::Outside { column: 40, row: 0 }));
    let picked = image(&bytes).pick(20, 4).unwrap();
    assert_eq!(picked[0], 224, "a fifth of the first band, the rest of the second");
}
