use super::*;
use crate::sim::faults::{Fault, FaultKind};
use crate::sim::wrench::WrenchErrors;

const BEAT: u64 = 10_000_000;

fn at(beat: u64) -> Stamp {
    Stamp::from_nanoseconds(1_700_000_000_000_000_000 + beat * BEAT)
}

fn world(setup: &WorldSetup) -> World {
    let mut world = World::new(setup).unwrap();
    world.step(at(0));
    world
}

fn right(output: &SimOutput) -> [f64; 7] {
    output.joints.last().unwrap().positions.right.map(Option::unwrap)
}

#[test]
fn a_world_with_its_seed_repeats_to_the_last_bit_and_another_seed_differs() {
    let run = |seed| {
        let mut world = world(&WorldSetup { seed, ..WorldSetup::default() });
        world.switch(SwitchRequest::Enable, at(0));
        let goal = JointVector::from(UNTUCKED_RIGHT).add_scalar(0.1);
        (1..200)
            .map(|beat| {
                world.command_joints(Side::Right, &goal, at(beat));
                world.step(at(beat))
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

#[test]
fn beats_come_at_one_hundred_hertz_and_poses_at_thirty() {
    let mut world = world(&WorldSetup::default());
    let output = world.step(at(100));
    assert_eq!((output.joints.len(), output.endpoints.len(), output.bodies.len()), (100, 200, 30));
}

#[test]
fn an_arm_follows_only_while_the_robot_is_enabled_and_commands_come() {
    let mut world = world(&WorldSetup::default());
    let goal = JointVector::from(UNTUCKED_RIGHT).add_scalar(0.2);
    world.command_joints(Side::Right, &goal, at(0));
    let before = right(&world.step(at(10)));
    assert!((before[0] - UNTUCKED_RIGHT[0]).abs() < 1e-3, "a disabled robot does not move");

    world.switch(SwitchRequest::Enable, at(10));
    world.command_joints(Side::Right, &goal, at(10));
    let after_one_command = right(&world.step(at(60)));
    assert!(after_one_command[0] > before[0] + 0.1);
    let fast = JointVector::from(UNTUCKED_RIGHT).add_scalar(3.0);
    world.command_joints(Side::Right, &fast, at(60));
    let lapsed = right(&world.step(at(81)));
    assert_eq!(
        right(&world.step(at(160))).map(f64::to_bits),
        lapsed.map(f64::to_bits),
        "0.2 s after the last command the arm holds"
    );
}

#[test]
fn after_a_stop_nothing_old_is_followed() {
    let mut world = world(&WorldSetup::default());
    world.switch(SwitchRequest::Enable, at(0));
    let goal = JointVector::from(UNTUCKED_RIGHT).add_scalar(0.5);
    world.command_joints(Side::Right, &goal, at(1));
    world.step(at(2));
    world.switch(SwitchRequest::Stop, at(2));
    let stopped = right(&world.step(at(3)));
    world.switch(SwitchRequest::Reset, at(4));
    world.switch(SwitchRequest::Enable, at(5));
    assert_eq!(right(&world.step(at(10))).map(f64::to_bits), stopped.map(f64::to_bits));
}

#[test]
fn the_wrench_of_a_still_arm_is_the_garments_weight_with_the_robots_sign() {
    let mut world = world(&WorldSetup { wrench: WrenchErrors::NONE, ..WorldSetup::default() });
    let output = world.step(at(1));
    for endpoint in &output.endpoints {
        // Half of 0.4 kg hangs on each gripper: the robot reports what it applies to the world, upward.
        assert!((endpoint.wrench.force.z - 1.962).abs() < 1e-9, "{endpoint:?}");
    }
}

#[test]
fn message_faults_do_what_their_names_say() {
    let fault = |kind| {
        let fault = Fault { kind, side: Some(Side::Left), from_seconds: 0.5, duration_seconds: None };
        let faults = FaultPlan { faults: vec![fault] };
        world(&WorldSetup { faults, ..WorldSetup::default() }).step(at(100))
    };
    let of = |output: &SimOutput, side| output.endpoints.iter().filter(|sample| sample.side == side).count();
    let stale = fault(FaultKind::StaleForce);
    assert_eq!((of(&stale, Side::Left), of(&stale, Side::Right)), (49, 100));

    let left = |output: &SimOutput| {
        output
            .endpoints
            .iter()
            .filter(|sample| sample.side == Side::Left)
            .map(|sample| sample.wrench.force.x)
            .collect::<Vec<_>>()
    };
    assert!(left(&fault(FaultKind::FrozenForce))[49..].windows(2).all(|pair| pair[0].to_bits() == pair[1].to_bits()));
    assert!(left(&fault(FaultKind::NotANumberForce))[60].is_nan());
    assert!(left(&fault(FaultKind::BiasedForce { newtons: [50.0, 0.0, 0.0] }))[60] > 30.0);
    assert_eq!(fault(FaultKind::StaleJoints).joints[99].positions.left, [None; 7]);
}

#[test]
fn faults_of_the_whole_robot_reach_its_state() {
    let fault = |kind| {
        let fault = Fault { kind, side: None, from_seconds: 0.5, duration_seconds: Some(0.2) };
        let faults = FaultPlan { faults: vec![fault] };
        let mut world = world(&WorldSetup { faults, ..WorldSetup::default() });
        world.switch(SwitchRequest::Enable, at(0));
        world.step(at(100))
    };
    let pressed = fault(FaultKind::RedButton);
    assert!(pressed.robot[40].enabled && pressed.robot[60].stopped);
    assert_eq!(pressed.robot[60].button, crate::assembly::RedButton::Pressed);
    assert_eq!(pressed.robot[90].button, crate::assembly::RedButton::Released);
    assert_eq!(fault(FaultKind::JointFault).robot[90].source, crate::assembly::StopSource::Fault);
    assert_eq!(fault(FaultKind::LostPose).bodies.len(), 24);
}

#[test]
fn late_and_lost_commands_hold_the_arm_back() {
    let moved = |kind: Option<FaultKind>| {
        let faults = kind.map(|kind| Fault { kind, side: None, from_seconds: 0.0, duration_seconds: None });
        let faults = FaultPlan { faults: faults.into_iter().collect() };
        let mut world = world(&WorldSetup { faults, ..WorldSetup::default() });
        world.switch(SwitchRequest::Enable, at(0));
        let goal = JointVector::from(UNTUCKED_RIGHT).add_scalar(1.0);
        for beat in 1..20 {
            world.command_joints(Side::Right, &goal, at(beat));
            world.step(at(beat));
        }
        right(&world.step(at(20)))[0] - UNTUCKED_RIGHT[0]
    };
    let free = moved(None);
    assert!(moved(Some(FaultKind::LateCommands { seconds: 0.1 })) < 0.7 * free);
    assert!(moved(Some(FaultKind::DroppedCommands { share: 1.0 })).abs() < 1e-3);
}

#[test]
fn a_world_that_cannot_be_is_refused() {
    let mut setup = WorldSetup::default();
    setup.garment.armhole_girth_metres = 0.15;
    assert!(World::new(&setup).unwrap_err().to_string().contains("cannot pass the hand"));
    let setup = WorldSetup { pose_noise_metres: f64::NAN, ..WorldSetup::default() };
    assert!(World::new(&setup).unwrap_err().to_string().contains("pose_noise_metres"));
}

/// In real time the world is woken whenever the wire has time, in virtual time at every beat: what it does depends on the
/// commands and their beats alone.
#[test]
fn a_world_that_is_woken_late_gives_the_same_trial_for_the_same_commands() {
    let run = |wakes: &dyn Fn(u64) -> bool| {
        let mut world = world(&WorldSetup { seed: 5, ..WorldSetup::default() });
        world.switch(SwitchRequest::Enable, at(0));
        let mut said = SimOutput::default();
        let mut hear = |output: SimOutput| {
            said.endpoints.extend(output.endpoints);
            said.joints.extend(output.joints);
            said.robot.extend(output.robot);
            said.collisions.extend(output.collisions);
            said.bodies.extend(output.bodies);
        };
        for beat in 1..=400 {
            if beat % 15 == 0 {
                hear(world.step(at(beat)));
                let goal = JointVector::from(UNTUCKED_RIGHT).add_scalar(0.001 * (beat / 15) as f64);
                world.command_joints(Side::Right, &goal, at(beat));
            } else if wakes(beat) {
                hear(world.step(at(beat)));
            }
        }
        hear(world.step(at(400)));
        said
    };
    let every_beat = run(&|_| true);
    assert_eq!(every_beat.endpoints.len(), 800);
    assert_eq!(run(&|beat| beat % 7 == 3), every_beat);
    assert_eq!(run(&|_| false), every_beat);
}

#[test]
fn a_person_who_exercises_comes_to_rest_in_the_posture_of_the_profile() {
    let mut world = World::new(&WorldSetup { exercise_seconds: 5.0, ..WorldSetup::default() }).unwrap();
    let rest = SimulatedPerson::default().posture().right;
    let mut furthest = 0.0_f64;
    for beat in 0..450 {
        world.step(at(beat));
        let arm = world.person_arms().right;
        assert!((arm.shoulder - rest.shoulder).norm() < 1e-9, "the exercise leaves the trunk where it is");
        furthest = furthest.max((arm.hand - rest.hand).norm());
    }
    assert!(furthest > 0.1, "{furthest}");
    let before = world.person_arms().right.hand;
    world.step(at(455));
    assert!((world.person_arms().right.hand - before).norm() < 0.05, "the arm comes to rest without a jump");
    world.step(at(520));
    assert!((world.person_arms().right.hand - rest.hand).norm() < 1e-9);
}
