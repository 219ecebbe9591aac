//! One armhole of cloth round one arm of two links: the physical world of a sleeve.

use super::super::super::person::{ArmPoints, ArmSizes};
use super::super::{GarmentSizes, Holder};
use crate::geometry::{Point, Vector as Vector64};
use rapier3d::prelude::*;

/// Particles round the armhole and along it.
const AROUND: usize = 24;
const ALONG: usize = 3;
/// Width of the rim that is modelled, in metres.
const RIM: f32 = 0.04;
/// Natural frequency of the cloth's edges in hertz: stiff enough for a woven jacket, soft enough for 5 ms.
const CLOTH_FREQUENCY: f32 = 60.0;
/// Friction of skin and cotton, dynamic, forearm (0.25 with a spread of 0.05 between people).
const FRICTION: f32 = 0.25;
/// Stiffness with which a person holds the elbow in place, in newtons per metre: 40 Nm/rad at the shoulder.
const ELBOW_STIFFNESS: f32 = 400.0;
/// Stiffness with which a person holds the hand in place, in newtons per metre: 25 Nm/rad at the elbow.
const HAND_STIFFNESS: f32 = 230.0;
/// Damping ratio of a held arm.
const DAMPING: f32 = 0.7;
/// Shares of the arm's mass: upper arm, forearm with hand (de Leva).
const UPPER_ARM_SHARE: f32 = 0.56;

/// A sleeve's physical world. Its origin is the person's shoulder, so that single precision is enough.
pub(super) struct ClothSleeve {
    world: PhysicsWorld,
    origin: Point,
    cloth: SoftBodyHandle,
    gripper: RigidBodyHandle,
    last_tip: Point,
    upper_arm: Link,
    forearm: Link,
    reflex: Vector,
}

/// One link of the arm, held at its far end.
struct Link {
    body: RigidBodyHandle,
    /// The far end in the body's own frame.
    end: Vector,
    stiffness: f32,
    damping: f32,
}

impl std::fmt::Debug for ClothSleeve {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("ClothSleeve").field("origin", &self.origin).finish_non_exhaustive()
    }
}

impl ClothSleeve {
    /// An armhole that has just gone round the hand, held by a gripper at `tip` (metres in `base`).
    pub(super) fn new(sizes: &GarmentSizes, arm_sizes: &ArmSizes, arm: &ArmPoints, tip: &Point) -> Self {
        let mut world = PhysicsWorld { gravity: Vector::new(0.0, 0.0, -9.81), ..PhysicsWorld::default() };
        let origin = arm.shoulder;
        let (hand, elbow) = (local(&origin, &arm.hand), local(&origin, &arm.elbow));
        let (upper_arm, forearm) = insert_arm(&mut world, arm_sizes, elbow, hand);
        let start = local(&origin, tip);
        let gripper =
            world.insert_body(RigidBodyBuilder::kinematic_position_based().translation(start).can_sleep(false));
        let cloth = insert_armhole(&mut world, sizes, hand, (elbow - hand).normalize_or_zero(), gripper);
        Self { world, origin, cloth, gripper, last_tip: *tip, upper_arm, forearm, reflex: Vector::ZERO }
    }

    /// Advances by `seconds` in `substeps`; the person holds elbow and hand at the given places (metres in `base`).
    /// Returns the mean force on the gripper in newtons.
    pub(super) fn advance(
        &mut self,
        seconds: f64,
        substeps: u32,
        holder: &Holder,
        elbow: &Point,
        hand: &Point,
    ) -> Vector64 {
        self.world.integration_parameters.dt = single(seconds) / single(f64::from(substeps));
        let (from, to) = (self.last_tip, holder.tip);
        let mut impulse = Vector::ZERO;
        for step in 1..=substeps {
            let tip = from + (to - from) * (f64::from(step) / f64::from(substeps));
            let goal = local(&self.origin, &tip);
            if let Some(gripper) = self.world.bodies.get_mut(self.gripper) {
                gripper.set_next_kinematic_translation(goal);
            }
            hold(&mut self.world, &self.upper_arm, local(&self.origin, elbow), self.reflex);
            hold(&mut self.world, &self.forearm, local(&self.origin, hand), Vector::ZERO);
            self.world.step();
            impulse += self.attachment_impulse();
        }
        self.last_tip = to;
        let parameters = &self.world.integration_parameters;
        let inner = parameters.dt / single(parameters.num_solver_iterations as f64);
        // Rapier counts an attachment's impulse as it acts on the body that the particle is attached to.
        let force = impulse / (inner * single(f64::from(substeps)));
        Vector64::new(f64::from(force.x), f64::from(force.y), f64::from(force.z))
    }

    /// The arm pulls with this force (newtons, `base` axes) from now on.
    pub(super) fn stiffen(&mut self, force: Vector64) {
        self.reflex = Vector::new(single(force.x), single(force.y), single(force.z));
    }

    /// Catches the rim on the forearm at its underside (`true`), or frees it.
    pub(super) fn snag(&mut self, caught: bool) {
        let Some(cloth) = self.world.soft_bodies.get_mut(self.cloth) else { return };
        let is_caught = cloth.particle_attachments().iter().any(|attachment| attachment.body == self.forearm.body);
        if caught == is_caught {
            return;
        }
        let lowest = (0..cloth.num_particles())
            .min_by(|one, other| cloth.particle_position(*one).z.total_cmp(&cloth.particle_position(*other).z));
        let Some(lowest) = lowest else { return };
        if caught {
            cloth.attach_particle(lowest, self.forearm.body, &self.world.bodies);
        } else {
            let held: Vec<usize> = (cloth.particle_attachments().iter())
                .filter(|attachment| attachment.body == self.forearm.body)
                .map(|attachment| attachment.particle as usize)
                .collect();
            for particle in held {
                cloth.detach_particle(particle);
            }
        }
    }

    fn attachment_impulse(&self) -> Vector {
        let Some(cloth) = self.world.soft_bodies.get(self.cloth) else { return Vector::ZERO };
        let held = cloth.particle_attachments().iter().filter(|attachment| attachment.body == self.gripper);
        held.map(SoftParticleAttachment::impulse).sum()
    }
}

/// A point in the sleeve's own frame, in single precision.
fn local(origin: &Point, point: &Point) -> Vector {
    let offset = point - origin;
    Vector::new(single(offset.x), single(offset.y), single(offset.z))
}

#[expect(clippy::cast_possible_truncation, reason = "rapier works in single precision; offsets are below two metres")]
const fn single(value: f64) -> f32 {
    value as f32
}

/// Two links: upper arm on the shoulder, forearm with a fist on the elbow. Muscles carry the arm's own weight.
fn insert_arm(world: &mut PhysicsWorld, sizes: &ArmSizes, elbow: Vector, hand: Vector) -> (Link, Link) {
    let mass = single(sizes.mass_kilograms);
    let chest = world.insert_body(RigidBodyBuilder::fixed());
    let mut link = |start: Vector, end: Vector, radii: (f64, f64), mass: f32, stiffness: f32| {
        let body = RigidBodyBuilder::dynamic().translation(start).gravity_scale(0.0).can_sleep(false);
        let limb = ColliderBuilder::capsule_from_endpoints(Vector::ZERO, end - start, single(radii.0));
        let (body, _) = world.insert(body, limb.mass(0.9 * mass).friction(FRICTION));
        let tip = ColliderBuilder::ball(single(radii.1)).translation(end - start);
        world.insert_collider(tip.mass(0.1 * mass).friction(FRICTION), Some(body));
        // A held link turns about its joint: the mass felt at its end is about a third of its own.
        let damping = 2.0 * DAMPING * (stiffness * mass / 2.0).sqrt();
        Link { body, end: end - start, stiffness, damping }
    };
    let upper_arm = link(
        Vector::ZERO,
        elbow,
        (sizes.upper_arm_radius_metres, sizes.forearm_radius_metres),
        mass * UPPER_ARM_SHARE,
        ELBOW_STIFFNESS,
    );
    let forearm = link(
        elbow,
        hand,
        (f64::midpoint(sizes.forearm_radius_metres, sizes.wrist_radius_metres), sizes.hand_radius_metres),
        mass * (1.0 - UPPER_ARM_SHARE),
        HAND_STIFFNESS,
    );
    let joint = |anchor: Vector| {
        SphericalJointBuilder::new().local_anchor1(anchor).local_anchor2(Vector::ZERO).contacts_enabled(false)
    };
    world.insert_impulse_joint(chest, upper_arm.body, joint(Vector::ZERO));
    world.insert_impulse_joint(upper_arm.body, forearm.body, joint(elbow));
    (upper_arm, forearm)
}

/// The armhole round the hand, its top held by the gripper.
fn insert_armhole(
    world: &mut PhysicsWorld,
    sizes: &GarmentSizes,
    hand: Vector,
    axis: Vector,
    gripper: RigidBodyHandle,
) -> SoftBodyHandle {
    let radius = single(sizes.armhole_girth_metres / std::f64::consts::TAU);
    let rim = axis * RIM;
    let tube = SoftBodyBuilder::cloth_tube(hand - rim * 0.5, rim, radius, radius, AROUND, ALONG)
        .mass(single(sizes.mass_kilograms) / 2.0)
        .softness(SpringCoefficients::new(CLOTH_FREQUENCY, 1.0))
        .particle_radius(0.004)
        .surface_collider(ColliderBuilder::ball(0.004).friction(FRICTION))
        .can_sleep(false);
    let cloth = world.insert_soft_body(tube);
    if let Some(cloth) = world.soft_bodies.get_mut(cloth) {
        let top = (0..AROUND)
            .max_by(|one, other| cloth.particle_position(*one).z.total_cmp(&cloth.particle_position(*other).z));
        for ring in 0..ALONG {
            cloth.attach_particle(ring * AROUND + top.unwrap_or_default(), gripper, &world.bodies);
        }
    }
    cloth
}

/// Pulls a link's far end towards a place, as a person holds an arm, with a further force on it.
fn hold(world: &mut PhysicsWorld, link: &Link, goal: Vector, force: Vector) {
    let Some(body) = world.bodies.get_mut(link.body) else { return };
    let end = body.position().transform_point(link.end);
    let pull = (goal - end) * link.stiffness - body.velocity_at_point(end) * link.damping + force;
    body.reset_forces(true);
    body.reset_torques(true);
    body.add_force_at_point(pull, end, true);
}
