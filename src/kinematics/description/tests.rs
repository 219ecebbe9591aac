use super::*;
use crate::kinematics::BAXTER_URDF;
use std::collections::{BTreeMap, BTreeSet};
use urdf_rs::Geometry;

fn robot() -> Robot {
    urdf_rs::read_from_string(BAXTER_URDF).unwrap()
}

#[test]
fn the_links_form_one_tree_with_base_at_its_root() {
    let robot = robot();
    let links: BTreeSet<_> = robot.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(links.len(), robot.links.len(), "each link once");
    let joints: BTreeSet<_> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(joints.len(), robot.joints.len(), "each joint once");
    let mut parents: BTreeMap<&str, &str> = BTreeMap::new();
    for joint in &robot.joints {
        assert!(links.contains(joint.parent.link.as_str()) && links.contains(joint.child.link.as_str()));
        assert_eq!(parents.insert(&joint.child.link, &joint.parent.link), None, "one parent for {}", joint.child.link);
    }
    let roots: Vec<_> = links.iter().filter(|link| !parents.contains_key(**link)).collect();
    assert_eq!(roots, [&"base"]);
    for link in links {
        let mut here = link;
        for _ in 0..parents.len() {
            here = parents.get(here).copied().unwrap_or(here);
        }
        assert_eq!(here, "base", "{link} hangs from base");
    }
}

#[test]
fn inertias_are_those_of_bodies_and_the_root_has_none() {
    for link in robot().links {
        let inertial = &link.inertial;
        if link.name == "base" {
            assert!(inertial.mass.value.abs() < f64::EPSILON, "robot_state_publisher wants a root without inertia");
            continue;
        }
        let inertia = &inertial.inertia;
        let matrix = nalgebra::Matrix3::new(
            inertia.ixx,
            inertia.ixy,
            inertia.ixz,
            inertia.ixy,
            inertia.iyy,
            inertia.iyz,
            inertia.ixz,
            inertia.iyz,
            inertia.izz,
        );
        assert!(inertial.mass.value > 0.0, "{}", link.name);
        assert!(matrix.symmetric_eigenvalues().min() > 0.0, "{}", link.name);
    }
}

#[test]
fn every_shape_is_a_primitive_of_positive_size() {
    let robot = robot();
    let shapes = robot.links.iter().flat_map(|link| {
        let visual = link.visual.iter().map(|visual| &visual.geometry);
        visual.chain(link.collision.iter().map(|collision| &collision.geometry))
    });
    for shape in shapes {
        match shape {
            Geometry::Cylinder { radius, length } => assert!(*radius > 0.0 && *length > 0.0),
            Geometry::Sphere { radius } => assert!(*radius > 0.0),
            Geometry::Box { size } => assert!(size.0.iter().all(|side| *side > 0.0)),
            other => panic!("no mesh and nothing else: {other:?}"),
        }
    }
}

#[test]
fn the_arms_have_the_published_masses() {
    let robot = robot();
    for side in Side::BOTH {
        let prefix = format!("{side}_");
        let mass: f64 =
            robot.links.iter().filter(|link| link.name.starts_with(&prefix)).map(|link| link.inertial.mass.value).sum();
        assert!((mass - 19.7).abs() < 0.1, "{mass}");
    }
}

#[test]
fn links_are_held_by_what_moves_them() {
    let description = Description::read(BAXTER_URDF).unwrap();
    let holder = |link: &str| description.holder(link).unwrap().map(|(holder, _)| holder);
    assert_eq!(holder("torso"), Some(None));
    assert_eq!(holder("left_upper_shoulder"), Some(Some((Side::Left, 0))));
    assert_eq!(holder("right_hand"), Some(Some((Side::Right, 6))));
    assert_eq!(holder("screen"), None, "the head turns by itself");
}
