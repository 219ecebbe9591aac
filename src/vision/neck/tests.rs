use super::super::probe::{Feature, NOTHING};
use super::*;
use proptest::prelude::*;

const CAMERA: Intrinsics = Intrinsics { fx: 200.0, fy: 200.0, cx: 80.0, cy: 20.0 };
/// In the middle of the images, one metre away: a pixel is 5 mm there.
const NECK: Point = Point::new(0.0, 0.0, 1.0);

/// An image with foreground at the given columns, rows and depths, and its maps.
fn image(set: impl IntoIterator<Item = (u16, u16, u16)>) -> ProbeImage {
    let mut image = ProbeImage::new(160, 120);
    let pixels: Vec<Pixel> = set.into_iter().map(|(column, row, depth)| Pixel { column, row, depth }).collect();
    pixels.iter().for_each(|pixel| image.set(pixel.column.into(), pixel.row.into(), pixel.depth));
    image.measure_from_neck(&pixels, &CAMERA, &NECK);
    image
}

/// What a map reads at a pixel, in millimetres.
fn read(image: &ProbeImage, map: &str, column: u16, row: u16) -> i32 {
    let plane = u8::try_from(MAPS.iter().position(|name| *name == map).unwrap() + 1).unwrap();
    let feature = Feature { offsets: [0.0; 4], planes: [plane, NOTHING] };
    image.response((f32::from(column), f32::from(row)), 1.0, &feature) + i32::from(BACKGROUND)
}

/// A band of rows 16 to 23 from one column to another, at one metre.
fn band(from: u16, to: u16) -> impl Iterator<Item = (u16, u16, u16)> {
    (from..to).flat_map(|column| (16..24).map(move |row| (column, row, 1000)))
}

/// A band to the right whose end turns down and comes back below: an arm that is bent.
fn bent() -> ProbeImage {
    let down = (140..148).flat_map(|column| (16..72).map(move |row| (column, row, 1000)));
    let back = (84..148).flat_map(|column| (64..72).map(move |row| (column, row, 1000)));
    image(band(70, 148).chain(down).chain(back))
}

#[test]
fn the_way_follows_the_surface_and_not_the_straight_line() {
    let image = bent();
    let (end, elbow) = (read(&image, "way", 86, 68), read(&image, "way", 144, 20));
    // 64 pixels to the right, 48 down, 58 back; the straight line is 48 pixels, 0.24 m.
    assert!((750..900).contains(&end), "{end}");
    assert!((300..360).contains(&elbow), "{elbow}");
    assert!(read(&image, "rest", 86, 68) < 60);
    // As well in the outer corner, which no shortest way runs through.
    assert!((read(&image, "rest", 144, 20) - (end - elbow)).abs() < 60);
}

#[test]
fn a_root_tells_where_a_limb_leaves_the_trunk() {
    let image = bent();
    let root = read(&image, "root", 86, 68) - 5000;
    assert!((200..300).contains(&root), "the limb leaves to the right: {root}");
    // Far out, to the left.
    let other = self::image(band(10, 90));
    assert!(read(&other, "root", 12, 20) < 4800);
}

#[test]
fn places_are_counted_from_the_neck() {
    let image = image([(120, 40, 1200)]);
    assert_eq!(read(&image, "across", 120, 40), 5000 + 240);
    assert_eq!(read(&image, "down", 120, 40), 5000 + 120);
    assert_eq!(read(&image, "deep", 120, 40), 5200);
    assert_eq!(read(&image, "way", 4, 100), i32::from(BACKGROUND));
}

#[test]
fn a_hand_before_the_trunk_is_reached_along_its_arm_or_by_a_longer_way() {
    let before = (80..88).flat_map(|column| (16..24).map(move |row| (column, row, 650)));
    let image = image(band(70, 80).chain(before).chain(band(88, 120)));
    let hand = read(&image, "way", 84, 20);
    assert!(hand > 700, "a jump of 0.35 m is no surface: {hand}");
}

#[test]
fn what_hangs_together_with_nothing_still_has_a_way() {
    let way = read(&image(band(70, 90).chain(band(130, 150))), "way", 140, 20);
    assert!((850..1000).contains(&way), "{way}");
}

#[test]
fn a_cut_out_reads_as_the_whole_does() {
    let whole = bent();
    let (cut, corner) = whole.cropped((70, 16), (148, 72));
    for plane in 0..8 {
        for (column, row) in [(70, 16), (100, 20), (144, 70), (86, 68), (110, 40)] {
            let feature = Feature { offsets: [3.0, -2.0, -4.0, 1.0], planes: [plane, NOTHING] };
            let place = |left: usize, top: usize| ((column - left) as f32, (row - top) as f32);
            let (here, there) = (place(0, 0), place(corner.0, corner.1));
            assert_eq!(whole.response(here, 1.0, &feature), cut.response(there, 1.0, &feature), "{plane}");
        }
    }
}

#[test]
fn the_same_room_measures_the_same_a_second_time() {
    let mut image = bent();
    let first = image.values().to_vec();
    let pixels = [Pixel { column: 9, row: 9, depth: 700 }];
    image.measure_from_neck(&pixels, &CAMERA, &NECK);
    assert_ne!(image.values(), first);
    let again = bent();
    assert_eq!(again.values(), first);
}

proptest! {
    #[test]
    fn no_foreground_makes_a_way_shorter_than_the_straight_line(
        set in proptest::collection::vec((0_u16..160, 0_u16..120, 400_u16..3000), 0..300),
    ) {
        let image = image(set.clone());
        for (column, row, _) in set {
            let place: Vec<f64> =
                ["across", "down", "deep"].iter().map(|map| f64::from(read(&image, map, column, row) - 5000)).collect();
            let straight = place.iter().map(|value| value * value).sum::<f64>().sqrt();
            prop_assert!(f64::from(read(&image, "way", column, row)) + 4.0 >= straight.min(9_990.0));
            prop_assert!(read(&image, "rest", column, row) >= 0);
        }
    }
}
