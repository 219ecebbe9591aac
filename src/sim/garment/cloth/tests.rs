use super::super::super::person::{SimulatedPerson, point_along};
use super::super::super::random::{Purpose, Random};
use super::*;
use crate::geometry::{Point, polyline_length};

struct Scene {
    sizes: GarmentSizes,
    arm_sizes: ArmSizes,
    arm: ArmPoints,
}

fn scene() -> Scene {
    let person = SimulatedPerson::default();
    Scene {
        sizes: GarmentSizes::default(),
        arm_sizes: person.body.arm_sizes(),
        arm: *person.posture().get(Side::Right),
    }
}

impl Scene {
    /// Forces on a gripper that moves along a path at 0.1 m/s with steps of the cloth of `step_seconds`, after 0.5 s at rest.
    fn travel(&self, path: &[Point], step_seconds: f64) -> Vec<Vector> {
        let mut cloth = ClothSleeve::new(&self.sizes, &self.arm_sizes, &self.arm, &path[0]);
        let still = |cloth: &mut ClothSleeve, tip: Point| {
            let holder = Holder { tip, velocity: Vector::zeros() };
            cloth.advance(step_seconds, 1, &holder, &self.arm.elbow, &self.arm.hand)
        };
        let mut at = 0.0;
        while at < 0.5 {
            still(&mut cloth, path[0]);
            at += step_seconds;
        }
        let (length, mut travelled, mut forces) = (polyline_length(path), 0.0, Vec::new());
        while travelled < length {
            travelled += 0.1 * step_seconds;
            forces.push(still(&mut cloth, point_along(path, travelled).unwrap()));
        }
        forces
    }
}

fn mean(forces: &[Vector]) -> f64 {
    forces.iter().map(Vector::norm).sum::<f64>() / forces.len() as f64
}

#[test]
fn a_hanging_armhole_weighs_what_it_weighs() {
    let scene = scene();
    let outward = (scene.arm.hand - scene.arm.elbow).normalize();
    let mut cloth = ClothSleeve::new(&scene.sizes, &scene.arm_sizes, &scene.arm, &scene.arm.hand);
    let mut forces = Vec::new();
    for step in 0..1600_u32 {
        let tip = scene.arm.hand + outward * (f64::from(step) * 0.0005).min(0.5);
        let holder = Holder { tip, velocity: Vector::zeros() };
        forces.push(cloth.advance(0.005, 1, &holder, &scene.arm.elbow, &scene.arm.hand).z);
    }
    let weight = scene.sizes.mass_kilograms / 2.0 * GRAVITY;
    let settled = forces[1400..].iter().sum::<f64>() / 200.0;
    assert!((settled + weight).abs() < 0.01 * weight, "{settled} N for {weight} N");
}

#[test]
fn along_the_arm_the_force_is_small_and_hardly_depends_on_the_step() {
    let scene = scene();
    let path = scene.arm.dressed();
    let coarse = mean(&scene.travel(&path, 0.005));
    let fine = mean(&scene.travel(&path, 0.002));
    assert!(coarse < 6.0, "{coarse}");
    assert!((coarse / fine - 1.0).abs() < 0.05, "{coarse} N against {fine} N");
}

#[test]
fn far_off_the_arm_the_force_rises_and_points_back() {
    let scene = scene();
    let [hand, elbow, shoulder] = scene.arm.dressed();
    let off = [hand, elbow + Vector::z() * 0.15, shoulder];
    let forces = scene.travel(&off, 0.005);
    let strongest = forces.iter().max_by(|one, other| one.norm().total_cmp(&other.norm())).unwrap();
    assert!(strongest.norm() > 5.0 && strongest.z < 0.0, "{strongest:?}");
}

#[test]
fn the_same_run_repeats_to_the_last_bit() {
    let bits = || -> Vec<[u64; 3]> {
        let scene = scene();
        let path = scene.arm.dressed();
        let forces = scene.travel(&path[..2], 0.005);
        forces.iter().map(|force| [force.x.to_bits(), force.y.to_bits(), force.z.to_bits()]).collect()
    };
    assert_eq!(bits(), bits());
}

#[test]
fn the_armhole_goes_on_with_the_gripper_and_comes_off_with_it() {
    let person = SimulatedPerson::default();
    let arms = person.posture();
    let mut reactions = PerSide::from_fn(|side| {
        Reaction::new(person.arm(side).response, person.preferred_path(side), Random::new(1, Purpose::RightArm))
    });
    let mut garment = ClothGarment::new(GarmentSizes::default(), person.body.arm_sizes());
    let mut at = |garment: &mut ClothGarment, tip: Point| {
        let holder = Holder { tip, velocity: Vector::zeros() };
        let holders = PerSide { left: Holder { tip: arms.right.shoulder, ..holder }, right: holder };
        garment.step(0.01, &holders, &arms, &mut reactions);
        garment.wearing().right
    };
    let away = arms.right.hand + (arms.right.hand - arms.right.elbow).normalize() * 0.3;
    assert_eq!(at(&mut garment, away), Wearing::Off);
    assert!(matches!(at(&mut garment, arms.right.hand), Wearing::On { .. }));
    assert_eq!(at(&mut garment, away), Wearing::Off);
}
