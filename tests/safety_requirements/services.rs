//! S-36: what another node may ask.

use super::room::Room;
use valet::body::Side;
use valet::command::{Command, Origin};
use valet::snapshot::TrialPhase;
use valet::strategy::StrategyKind;

fn every_command() -> Vec<Command> {
    vec![
        Command::Continue,
        Command::Abort,
        Command::Withdraw,
        Command::GoAhead,
        Command::NextIteration,
        Command::NextStep,
        Command::PreviousStep,
        Command::FinishAfterThis,
        Command::Reset,
        Command::Enable,
        Command::Disable,
        Command::Start,
        Command::SelectStrategy(StrategyKind::Gmm),
        Command::SelectFirstArm(Side::Left),
        Command::SetSetting { key: "window.threshold_newtons".into(), value: 9.0 },
        Command::UndoSetting { key: "window.threshold_newtons".into() },
        Command::Tare(Side::Left),
        Command::Note("x".into()),
        Command::SelectProfile("x".into()),
        Command::SelectGarment("x".into()),
    ]
}

#[test]
fn s_36_another_node_may_stop_and_hold_and_nothing_else() {
    for command in every_command() {
        let mut room = Room::dressing();
        let before = room.supervisor.snapshot(room.now);
        let receipt = room.ask_from(command.clone(), Origin::RosService);
        assert!(!receipt.is_accepted(), "{command}");
        let after = room.supervisor.snapshot(room.now);
        assert_eq!(before.trial.phase, after.trial.phase, "{command}");
        assert_eq!(before.robot.state, after.robot.state);
    }
    let mut room = Room::dressing();
    assert!(room.ask_from(Command::Hold, Origin::RosService).is_accepted());
    assert_eq!(room.phase(), TrialPhase::Holding);
    assert!(!room.ask_from(Command::Continue, Origin::RosService).is_accepted());
    assert!(room.ask_from(Command::Stop, Origin::RosService).is_accepted());
    assert!(room.supervisor.is_stopped());
}
