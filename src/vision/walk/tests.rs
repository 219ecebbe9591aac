use super::*;
use crate::geometry::Point;
use crate::vision::camera::Intrinsics;
use crate::vision::part::CLASSES;
use crate::vision::tree::{Leaf, NO_VOTE, Node, VOTED, Vote};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A tree of random splits and depths of up to eleven levels.
fn tree(random: &mut ChaCha8Rng) -> Tree {
    let mut tree = Tree { nodes: vec![Node::default()], leaves: Vec::new() };
    let mut at = 0;
    while at < tree.nodes.len() {
        let children = u32::try_from(tree.nodes.len()).unwrap();
        let split = tree.nodes.len() < 2_000 && (at < 400 || random.random_bool(0.6));
        tree.nodes[at] = if split {
            let offsets = [0; 4].map(|_| random.random_range(-2_000..=2_000));
            let planes = if random.random_bool(0.5) { [0; 2] } else { [0; 2].map(|_| random.random_range(0..8)) };
            Node { offsets, threshold: random.random_range(-1_500..1_500), planes, next: children }
        } else {
            let leaf = Leaf { shares: [0; CLASSES], votes: [Vote { offset: [0; 3], deviation: NO_VOTE }; VOTED] };
            tree.leaves.push(leaf);
            Node { next: LEAF | u32::try_from(tree.leaves.len() - 1).unwrap(), ..Node::default() }
        };
        if split {
            tree.nodes.extend([Node::default(); 2]);
        }
        at += 1;
    }
    tree
}

fn scene(random: &mut ChaCha8Rng, width: u16, height: u16) -> (ProbeImage, Vec<Pixel>) {
    let mut image = ProbeImage::new(usize::from(width), usize::from(height));
    let mut pixels = Vec::new();
    for row in 0..height {
        for column in 0..width {
            if random.random_bool(0.6) {
                let depth = random.random_range(400..2_500);
                image.set(usize::from(column), usize::from(row), depth);
                pixels.push(Pixel { column, row, depth });
            }
        }
    }
    let camera = Intrinsics { fx: 60.0, fy: 60.0, cx: 30.0, cy: 20.0 };
    image.measure_from_neck(&pixels, &camera, &Point::new(0.0, 0.0, 1.0));
    (image, pixels)
}

#[test]
fn every_way_of_walking_ends_in_the_same_leaves() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for _ in 0..6 {
        let tree = tree(&mut random);
        let (image, pixels) = scene(&mut random, 67, 43);
        let ratio = random.random_range(0.9..1.1);
        let one_by_one = |pixel: &Pixel| {
            tree.leaf(&image, (f32::from(pixel.column), f32::from(pixel.row)), per_metre(*pixel, ratio))
        };
        let expected: Vec<u32> = pixels.iter().map(one_by_one).collect();
        let (mut plain, mut fast) = (Vec::new(), Vec::new());
        plain_leaves(&tree, &image, &pixels, ratio, &mut plain);
        leaves(&tree, &image, &pixels, ratio, &mut fast);
        assert_eq!(plain, expected);
        assert_eq!(fast, expected);
        assert!(expected.iter().collect::<std::collections::HashSet<_>>().len() > 20, "the walk is no test");
    }
}

#[test]
fn a_tree_that_points_out_of_itself_reads_nothing_beyond_its_end() {
    let broken = Tree {
        nodes: vec![Node { next: 1_000_000, ..Node::default() }, Node { next: LEAF | 7, ..Node::default() }],
        leaves: Vec::new(),
    };
    let (image, pixels) = scene(&mut ChaCha8Rng::seed_from_u64(1), 16, 16);
    let mut found = Vec::new();
    leaves(&broken, &image, &pixels, 1.0, &mut found);
    assert_eq!(found.len(), pixels.len());
}

#[test]
fn no_pixel_and_no_node_are_no_trouble() {
    let (image, pixels) = scene(&mut ChaCha8Rng::seed_from_u64(1), 16, 16);
    let mut found = vec![3];
    leaves(&Tree::default(), &image, &[], 1.0, &mut found);
    assert!(found.is_empty());
    leaves(&Tree::default(), &image, &pixels, 1.0, &mut found);
    assert_eq!(found, vec![0; pixels.len()]);
    leaves(&tree(&mut ChaCha8Rng::seed_from_u64(2)), &image, &pixels[..3], 1.0, &mut found);
    assert_eq!(found.len(), 3);
}
