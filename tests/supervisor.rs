//! The supervisor with the simulated robot and person in virtual time: the invariants of the house, each by its name, and
//! what the operator's acts come to. No screen, no socket, no clock.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test may fail loudly anywhere"
)]

use std::time::Duration;
use valet::body::Side;
use valet::command::Command;
use valet::headless::{ScriptedOperator, VirtualTrial};
use valet::sim::faults::{Fault, FaultKind, FaultPlan};
use valet::sim::world::WorldSetup;
use valet::snapshot::{Outcome, TrialPhase};
use valet::strategy::StrategyKind;
use valet::supervisor::{Effect, Input, LinkEvent, Setup};

/// A trial and all that was decided in it.
struct Bench {
    trial: VirtualTrial,
    effects: Vec<Effect>,
}

impl Bench {
    fn with_faults(faults: Vec<Fault>) -> Self {
        let setup = Setup { seed: 1, ..Setup::default() };
        let world = WorldSetup { seed: 1, faults: FaultPlan { faults }, ..WorldSetup::default() };
        Self { trial: VirtualTrial::new(setup, &world).unwrap(), effects: Vec::new() }
    }

    fn new() -> Self {
        Self::with_faults(Vec::new())
    }

    /// Lets time pass and returns what was decided meanwhile.
    fn pass(&mut self, seconds: f64) -> Vec<Effect> {
        let beats = (seconds * 100.0).round() as usize;
        let effects: Vec<_> = (0..beats).flat_map(|_| self.trial.beat(&mut |_, _, _| ())).collect();
        self.effects.extend(effects.clone());
        effects
    }

    /// Asks, and says whether it was accepted and with which words.
    fn ask(&mut self, command: Command) -> (bool, String) {
        let effects = self.trial.ask(command, &mut |_, _, _| ());
        let answer = effects.iter().find_map(|effect| match effect {
            Effect::Receipt(receipt) => Some((receipt.is_accepted(), format!("{receipt:?}"))),
            _ => None,
        });
        self.effects.extend(effects);
        answer.expect("every command is answered")
    }

    fn accept(&mut self, command: Command) {
        let (accepted, words) = self.ask(command);
        assert!(accepted, "{words}");
    }

    fn refuse(&mut self, command: Command) -> String {
        let (accepted, words) = self.ask(command);
        assert!(!accepted, "{words}");
        words
    }

    /// Enabled, started, and on its way.
    fn moving() -> Self {
        Self::moving_with(Vec::new())
    }

    fn moving_with(faults: Vec<Fault>) -> Self {
        let mut bench = Self::with_faults(faults);
        bench.pass(1.0);
        bench.accept(Command::Enable);
        bench.pass(0.5);
        bench.accept(Command::Start);
        assert!(setpoints(&bench.pass(3.0)) > 100);
        bench
    }

    fn phase(&self) -> TrialPhase {
        self.trial.snapshot().trial.phase
    }
}

fn setpoints(effects: &[Effect]) -> usize {
    effects.iter().filter(|effect| matches!(effect, Effect::Setpoint { .. })).count()
}

/// True where all setpoints of each arm are the same: the arm holds its place.
fn holds_still(effects: &[Effect]) -> bool {
    Side::BOTH.into_iter().all(|wanted| {
        let mut joints = effects.iter().filter_map(|effect| match effect {
            Effect::Setpoint { side, joints } if *side == wanted => Some(*joints),
            _ => None,
        });
        let first = joints.next();
        joints.all(|next| Some(next) == first)
    })
}

fn fault(kind: FaultKind, from_seconds: f64) -> Fault {
    Fault { kind, side: None, from_seconds, duration_seconds: None }
}

#[test]
fn an_iteration_that_runs_shows_the_resistance_that_it_has_met() {
    let mut bench = Bench::moving();
    let found = |bench: &Bench| bench.trial.snapshot().sides.right.force.detections.len();
    while found(&bench) == 0 && bench.phase() != TrialPhase::Ended {
        bench.pass(0.1);
    }
    let right = bench.trial.snapshot().sides.right;
    let running = right.iterations.last().unwrap();
    let met: f64 = right.force.detections.iter().map(|detection| detection.magnitude).sum();
    assert!(!running.finished && running.resistances > 0 && running.duration > 0.0, "{running:?}");
    assert!(met > 0.0 && (running.energy - met).abs() < 1e-9, "{running:?}, {met}");
}

#[test]
fn after_a_stop_no_motion_until_reset_enable_and_start_each_a_separate_act() {
    let mut bench = Bench::moving();
    bench.accept(Command::Stop);
    assert_eq!(setpoints(&bench.pass(2.0)), 0, "stopped");
    for command in [Command::Enable, Command::Start, Command::Continue, Command::GoAhead, Command::Withdraw] {
        bench.refuse(command);
        assert_eq!(setpoints(&bench.pass(0.2)), 0, "stopped");
    }
    bench.accept(Command::Reset);
    assert_eq!(setpoints(&bench.pass(1.0)), 0, "reset alone never moves anything");
    bench.refuse(Command::Start);
    bench.accept(Command::Enable);
    assert_eq!(setpoints(&bench.pass(1.0)), 0, "enable alone never moves anything");
    bench.accept(Command::Start);
    assert_eq!(setpoints(&bench.pass(1.0)), 0, "start ends the stop; the trial still holds");
    assert_eq!(bench.phase(), TrialPhase::Holding);
    bench.accept(Command::Continue);
    assert!(setpoints(&bench.pass(1.0)) > 0);
}

#[test]
fn a_stop_reaches_the_switch_in_the_very_step_that_asks_for_it_and_is_repeated_until_confirmed() {
    let mut bench = Bench::moving();
    let effects = bench.trial.ask(Command::Stop, &mut |_, _, _| ());
    let first = effects.first().expect("a stop has effects");
    assert!(matches!(first, Effect::Switch(valet::assembly::SwitchRequest::Stop)), "{first:?}");
    bench.pass(0.1);
    assert!(bench.trial.snapshot().stop.latched);
}

#[test]
fn the_red_button_stops_and_cannot_be_reset_while_it_is_down() {
    let mut bench = Bench::moving();
    bench.trial.world_mut().press_red_button(true);
    bench.pass(0.2);
    assert_eq!(setpoints(&bench.pass(1.0)), 0);
    let words = bench.refuse(Command::Reset);
    assert!(words.contains("button"), "{words}");
    bench.trial.world_mut().press_red_button(false);
    bench.pass(0.5);
    bench.accept(Command::Reset);
}

#[test]
fn no_motion_on_stale_or_missing_force_joint_or_robot_state_or_numbers_that_are_not_finite() {
    for kind in [FaultKind::StaleForce, FaultKind::NotANumberForce, FaultKind::StaleJoints] {
        let mut bench = Bench::moving_with(vec![fault(kind, 6.0)]);
        bench.pass(3.0);
        assert!(holds_still(&bench.pass(2.0)), "{kind:?}");
        assert!(!bench.phase().moves(), "{kind:?}");
        bench.refuse(Command::Continue);
    }
}

#[test]
fn without_the_person_in_sight_nothing_starts_and_the_reason_is_said() {
    let mut bench = Bench::with_faults(vec![fault(FaultKind::LostPose, 0.0)]);
    bench.pass(1.0);
    bench.accept(Command::Enable);
    bench.pass(0.5);
    let words = bench.refuse(Command::Start);
    assert!(words.contains("not seen") || words.contains("pose"), "{words}");
    assert_eq!(setpoints(&bench.pass(1.0)), 0);
}

#[test]
fn nothing_moves_before_enable_and_start() {
    let mut bench = Bench::new();
    assert_eq!(setpoints(&bench.pass(1.0)), 0);
    bench.refuse(Command::Start);
    bench.accept(Command::Enable);
    assert_eq!(setpoints(&bench.pass(1.0)), 0);
}

#[test]
fn a_hold_comes_to_rest_keeps_its_place_and_goes_on_when_told() {
    let mut bench = Bench::moving();
    bench.accept(Command::Hold);
    bench.pass(1.0);
    let resting = bench.pass(1.0);
    assert!(setpoints(&resting) > 0 && holds_still(&resting));
    bench.accept(Command::Continue);
    assert!(!holds_still(&bench.pass(1.0)));
}

#[test]
fn a_master_that_is_lost_holds_the_trial_until_the_operator_continues() {
    let mut bench = Bench::moving();
    bench.trial.tell(LinkEvent::MasterLost);
    bench.pass(1.0);
    assert_eq!(bench.phase(), TrialPhase::Holding);
    bench.trial.tell(LinkEvent::MasterBack);
    assert!(holds_still(&bench.pass(1.0)), "coming back is no reason to move");
    bench.accept(Command::Continue);
    assert!(!holds_still(&bench.pass(1.0)));
}

#[test]
fn s_42_a_squeezed_cuff_hands_the_arm_over_and_the_arm_is_not_called_back() {
    let mut bench = Bench::moving();
    bench.trial.feed(&Input::Cuff { side: Side::Left, squeezed: true });
    assert_eq!(setpoints(&bench.pass(1.0)), 0, "once the hand lets go, an old setpoint would pull the arm back");
    assert_eq!(bench.phase(), TrialPhase::Holding);
    assert!(bench.refuse(Command::Continue).contains("cuff"), "the hand is still there");
    bench.trial.feed(&Input::Cuff { side: Side::Left, squeezed: false });
    assert_eq!(setpoints(&bench.pass(1.0)), 0, "letting go is no reason to move");
    bench.accept(Command::Continue);
    assert!(!holds_still(&bench.pass(1.0)));
}

#[test]
fn a_setpoint_that_a_guard_refused_holds_the_trial_with_the_guards_words() {
    let mut bench = Bench::moving();
    bench.trial.feed(&Input::SetpointRefused { side: Side::Left, reason: "elbow beyond its limit".into() });
    bench.pass(1.0);
    assert_eq!(bench.phase(), TrialPhase::Holding);
    let cause = bench.trial.snapshot().trial.hold_cause;
    assert!(cause.contains("elbow beyond its limit"), "{cause}");
}

#[test]
fn an_abort_ends_the_trial_releases_both_arms_and_a_new_one_can_begin() {
    let mut bench = Bench::new();
    bench.pass(1.0);
    bench.accept(Command::Enable);
    bench.pass(0.5);
    bench.accept(Command::Start);
    bench.pass(0.5);
    bench.accept(Command::Abort);
    let ended = |effect: &Effect| matches!(effect, Effect::TrialEnded { outcome: Outcome::Aborted, .. });
    assert!(bench.effects.iter().any(ended));
    let released = bench.effects.iter().filter(|effect| matches!(effect, Effect::Release { .. })).count();
    assert_eq!(released, 2);
    assert_eq!(setpoints(&bench.pass(1.0)), 0);
    bench.accept(Command::Start);
    let effects = bench.pass(1.0);
    assert!(setpoints(&effects) > 0, "{effects:?}");
}

#[test]
fn a_disabled_robot_is_not_moved_when_it_is_enabled_again() {
    let mut bench = Bench::moving();
    bench.accept(Command::Disable);
    bench.pass(0.5);
    assert_eq!(setpoints(&bench.pass(1.0)), 0);
    bench.accept(Command::Enable);
    assert_eq!(setpoints(&bench.pass(1.0)), 0, "enabled, but held");
}

#[test]
fn a_profile_without_a_movement_space_cannot_take_the_strategies_that_need_one() {
    let mut bench = Bench::moving();
    let words = bench.refuse(Command::SelectStrategy(StrategyKind::Gmm));
    assert!(words.contains("movement space"), "{words}");
    bench.accept(Command::SelectStrategy(StrategyKind::Kernel));
}

#[test]
fn the_same_seed_brings_the_same_decisions_and_another_seed_others() {
    let decided = |seed: u64| {
        let setup = Setup { seed, ..Setup::default() };
        let mut trial = VirtualTrial::new(setup, &WorldSetup { seed, ..WorldSetup::default() }).unwrap();
        let mut all = Vec::new();
        let mut operator = ScriptedOperator::new(3);
        trial.run(&mut operator, Duration::from_secs(25), |_, _, effects| all.extend_from_slice(effects));
        all
    };
    let first = decided(7);
    assert!(first.len() > 1_000);
    assert!(first == decided(7));
    assert!(first != decided(8));
}

#[test]
fn an_undo_brings_back_the_old_value_though_the_new_one_was_asked_for_twice() {
    let mut bench = Bench::new();
    bench.pass(0.1);
    let key = || String::from("strategies.learning.optimiser.learning_rate");
    let shown = |bench: &Bench| {
        let snapshot = bench.trial.snapshot();
        let row = snapshot.settings.iter().find(|row| row.key == key()).unwrap();
        (row.value, row.previous)
    };
    let (before, _) = shown(&bench);
    for _ in 0..2 {
        bench.accept(Command::SetSetting { key: key(), value: 0.01 });
    }
    assert_eq!(shown(&bench), (0.01, Some(before)));
    bench.accept(Command::UndoSetting { key: key() });
    assert_eq!(shown(&bench), (before, Some(0.01)));
}
