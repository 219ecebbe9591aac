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

/// The same forest as the version before wrote it: thresholds of 32 bits, and no maps in the header.
fn of_version_1() -> (Forest, Vec<u8>) {
    let mut forest = forest();
    for (threshold, node) in [-77, 300].into_iter().zip([0, 2]) {
        for tree in &mut forest.trees {
            (tree.nodes[node].threshold, tree.nodes[node].planes) = (threshold, [0; 2]);
        }
    }
    let bytes = forest.to_bytes().unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let header = String::from_utf8(bytes[16..16 + length].to_vec()).unwrap();
    let maps = format!("\"maps\":{},", serde_json::to_string(&MAPS).unwrap());
    let header = header.replace(&maps, "");
    let mut old = bytes[..8].to_vec();
    old.extend(DEPTH_ALONE.to_le_bytes());
    old.extend(u32::try_from(header.len()).unwrap().to_le_bytes());
    old.extend(header.as_bytes());
    let trees = old.len();
    old.extend(&bytes[16 + length..]);
    // The sign of a threshold fills its upper half, where planes stand now.
    for tree in 0..2 {
        let start = trees + tree * (5 * NODE_BYTES + 3 * LEAF_BYTES);
        old[start + 10..start + 12].fill(u8::MAX);
    }
    (forest, sealed(old))
}

#[test]
fn a_forest_of_the_version_before_is_read_as_one_of_depth_alone() {
    let (forest, bytes) = of_version_1();
    assert_eq!(Forest::from_bytes(&bytes), Ok(forest));
}

#[test]
fn a_threshold_that_no_difference_of_depths_reaches_and_a_plane_that_is_none_are_refused() {
    let (_, mut bytes) = of_version_1();
    let second = bytes.len() - DIGEST_BYTES - (5 * NODE_BYTES + 3 * LEAF_BYTES);
    bytes[second + 10] = 1;
    assert_eq!(Forest::from_bytes(&sealed(bytes)), Err(FileError::Structure { tree: 1, node: 0 }));
    let mut broken = forest();
    broken.trees[0].nodes[2].planes = [0, 8];
    let bytes = broken.to_bytes().unwrap();
    assert_eq!(Forest::from_bytes(&bytes), Err(FileError::Structure { tree: 0, node: 2 }));
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
    for (from, to) in [
        ("metres\":10000", "metres\":32767"),
        ("ed\":false", "ed\":true "),
        ("classes\":9", "classes\":8"),
        ("\"way\"", "\"off\""),
    ] {
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
