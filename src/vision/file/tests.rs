use super::super::tree::NO_VOTE;
use super::*;
use proptest::prelude::*;

fn leaf(first: u8) -> Leaf {
    let mut shares = [3; CLASSES];
    shares[0] = first;
    let mut votes = [Vote { offset: [-5, 6, 300], deviation: 70 }; VOTED];
    votes[2].deviation = NO_VOTE;
    Leaf { shares, votes }
}

fn forest() -> Forest {
    let split = |next| Node { offsets: [-100, 200, -300, 24_000], threshold: -77, planes: [2, 7], next };
    let end = |leaf| Node { next: LEAF | leaf, ..Node::default() };
    let nodes = vec![split(1), end(0), split(3), end(1), end(2)];
    let tree = Tree { nodes, leaves: vec![leaf(1), leaf(2), leaf(3)] };
    Forest::new(545.0, "three leaves".into(), vec![tree.clone(), tree])
}

/// The bytes with a new checksum, as a careless or ill-meaning writer would make them.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.len() - DIGEST_BYTES);
    let digest = Sha256::digest(&bytes);
    bytes.extend(digest);
    bytes
}

#[test]
fn a_forest_comes_back_as_it_went() {
    let bytes = forest().to_bytes().unwrap();
    assert_eq!(Forest::from_bytes(&bytes).unwrap(), forest());
}

#[test]
fn every_way_of_cutting_it_short_is_refused() {
    let bytes = forest().to_bytes().unwrap();
    for length in 0..bytes.len() {
        assert!(Forest::from_bytes(&bytes[..length]).is_err(), "{length}");
    }
    let mut longer = bytes;
    longer.push(0);
    assert!(matches!(Forest::from_bytes(&longer), Err(FileError::Length { .. })));
}

#[test]
fn another_version_or_another_kind_of_file_is_named() {
    let mut bytes = forest().to_bytes().unwrap();
    bytes[8] = 9;
    assert_eq!(Forest::from_bytes(&bytes), Err(FileError::Version { found: 9 }));
    assert_eq!(Forest::from_bytes(b"PNG and so on"), Err(FileError::Magic));
}

#[test]
fn a_changed_byte_is_found_by_the_checksum() {
    let mut bytes = forest().to_bytes().unwrap();
    let middle = bytes.len() - 60;
    bytes[middle] ^= 1;
    assert_eq!(Forest::from_bytes(&bytes), Err(FileError::Checksum));
}

#[test]
fn cycles_and_stray_children_are_refused_even_under_a_right_checksum() {
    let whole = forest();
    for (node, next) in [(2, 0), (2, 1), (0, 3), (2, 40), (1, LEAF | 2), (4, LEAF | 9)] {
        let mut broken = whole.clone();
        broken.trees[1].nodes[node].next = next;
        let bytes = sealed(broken.to_bytes().unwrap());
        assert!(matches!(Forest::from_bytes(&bytes), Err(FileError::Structure { tree: 1, .. })), "{node} {next}");
    }
}

#[test]
fn other_conventions_are_refused_by_name() {
    let bytes = forest().to_bytes().unwrap();
    let text = |from: &str, to: &str| {
        assert_eq!(from.len(), to.len());
        let start = bytes.windows(from.len()).position(|window| window == from.as_bytes()).unwrap();
        let mut changed = bytes.clone();
        changed[start..start + from.len()].copy_from_slice(to.as_bytes());
        Forest::from_bytes(&sealed(changed))
    };
    for (from, to) in
        [("metres\":10000", "metres\":32767"), ("ed\":false", "ed\":true "), ("classes\":9", "classes\":8")]
    {
        assert!(matches!(text(from, to), Err(FileError::Convention { .. })), "{to}");
    }
    assert!(matches!(text("pixels\":545.0", "pixels\":-45.0"), Err(FileError::Header(_))));
    assert!(matches!(text("[5,3]", "[5,0]"), Err(FileError::Header(_))));
}

proptest! {
    #[test]
    fn no_bytes_make_it_panic(place in 0_usize..600, value: u8) {
        let mut bytes = forest().to_bytes().unwrap();
        let index = place % bytes.len();
        bytes[index] = value;
        let _ = Forest::from_bytes(&sealed(bytes));
    }
}
