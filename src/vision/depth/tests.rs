use super::*;
use proptest::prelude::*;

fn raw<'a>(encoding: &'a str, width: u32, height: u32, step: u32, data: &'a [u8]) -> RawImage<'a> {
    RawImage { width, height, step, encoding, big_endian: false, data }
}

#[test]
fn both_byte_orders_and_row_padding_give_the_same_image() {
    let little = [1, 0, 2, 0, 99, 3, 1, 4, 0, 99];
    let big = [0, 1, 0, 2, 99, 1, 3, 0, 4, 99];
    let first = DepthImage::decode(&raw("16UC1", 2, 2, 5, &little)).unwrap();
    let second = DepthImage::decode(&RawImage { big_endian: true, ..raw("16UC1", 2, 2, 5, &big) }).unwrap();
    assert_eq!(first.millimetres(), [1, 2, 259, 4]);
    assert_eq!(first, second);
}

#[test]
fn the_last_row_may_lack_its_padding() {
    assert!(DepthImage::decode(&raw("16UC1", 2, 2, 6, &[0; 10])).is_ok());
    assert!(matches!(DepthImage::decode(&raw("16UC1", 2, 2, 6, &[0; 9])), Err(DepthError::Short { .. })));
}

#[test]
fn metres_become_millimetres_and_nonsense_becomes_no_reading() {
    let values = [1.2346_f32, f32::NAN, f32::INFINITY, -1.0, 0.0, 80.0];
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let image = DepthImage::decode(&raw("32FC1", 6, 1, 24, &bytes)).unwrap();
    assert_eq!(image.millimetres(), [1235, 0, 0, 0, 0, 0]);
}

#[test]
fn a_saturated_or_empty_image_is_blind() {
    let saturated = DepthImage::decode(&raw("16UC1", 2, 1, 4, &[255; 4])).unwrap();
    assert_eq!(saturated.check_readings(), Err(DepthError::Blind));
    let not_a_number: Vec<u8> = [f32::NAN; 2].iter().flat_map(|value| value.to_be_bytes()).collect();
    let image = DepthImage::decode(&raw("32FC1", 2, 1, 8, &not_a_number)).unwrap();
    assert_eq!(image.check_readings(), Err(DepthError::Blind));
}

#[test]
fn wrong_encoding_size_and_step_are_named() {
    assert_eq!(DepthImage::decode(&raw("rgb8", 2, 1, 6, &[0; 6])), Err(DepthError::Encoding("rgb8".into())));
    assert!(matches!(DepthImage::decode(&raw("16UC1", 0, 1, 6, &[])), Err(DepthError::Size { .. })));
    assert!(matches!(DepthImage::decode(&raw("16UC1", 4, 1, 6, &[0; 6])), Err(DepthError::Step { .. })));
    assert!(matches!(DepthImage::new(2, 2, vec![0; 3]), Err(DepthError::Short { .. })));
}

#[test]
fn a_failed_decode_leaves_the_image_as_it_was() {
    let mut image = DepthImage::new(2, 1, vec![7, 8]).unwrap();
    assert!(image.decode_from(&raw("16UC1", 2, 2, 4, &[0; 5])).is_err());
    assert_eq!(image.millimetres(), [7, 8]);
}

#[test]
fn mirroring_turns_each_row_round() {
    let mut image = DepthImage::new(3, 2, vec![1, 2, 3, 4, 5, 6]).unwrap();
    image.unmirror();
    assert_eq!(image.millimetres(), [3, 2, 1, 6, 5, 4]);
    assert_eq!(image.at(0, 1), 6);
    assert_eq!(image.at(3, 0), 0);
}

proptest! {
    #[test]
    fn no_bytes_make_it_panic(
        width in 0_u32..20, height in 0_u32..20, step in 0_u32..100, wide: bool, big_endian: bool,
        data in proptest::collection::vec(any::<u8>(), 0..600),
    ) {
        let encoding = if wide { "32FC1" } else { "16UC1" };
        if let Ok(image) = DepthImage::decode(&RawImage { width, height, step, encoding, big_endian, data: &data }) {
            prop_assert_eq!(image.millimetres().len(), (width * height) as usize);
        }
    }
}
