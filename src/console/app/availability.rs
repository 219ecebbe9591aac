//! Why a key does nothing now, in words: what the key line shows as disabled.
//!
//! Only what the snapshot itself rules out is refused here; everything else is asked of the supervisor, which decides.

use crate::console::keymap::{Action, Guard};
use crate::snapshot::{RunKeyView, Snapshot, StopPhase, TrialPhase, Watermark};

/// Why an action cannot be done now; `None` where it can be asked for.
pub(in crate::console) fn refusal(action: Action, snapshot: &Snapshot) -> Option<&'static str> {
    let guard = action.entry().map_or(Guard::None, |entry| entry.guard);
    if guard == Guard::Immediate {
        return None;
    }
    if snapshot.watermark == Watermark::Watch && asks_the_robot(action) {
        return Some("this screen only watches");
    }
    if snapshot.watermark == Watermark::Replay && asks_the_robot(action) {
        // The key that holds a trial pauses a replay.
        return (action != Action::HoldOrContinue).then_some("a recorded trial: nothing can be asked of it");
    }
    let phase = snapshot.trial.phase;
    let robot = snapshot.robot.fresh(snapshot.now);
    let way_back = snapshot.stop.phase(snapshot.now);
    let stopped = robot.is_some_and(|robot| robot.stopped) || !matches!(way_back, StopPhase::Clear | StopPhase::Reset);
    let needs_start = way_back == StopPhase::Reset && !stopped;
    match action {
        Action::Reset if needs_start => Some("reset already: enable, then start"),
        Action::Reset => (!stopped).then_some("nothing is stopped"),
        _ if stopped && leaves_a_stop(action) => Some("stopped: reset first"),
        Action::Start if phase.is_running() && !needs_start => Some("a trial runs"),
        Action::Start => needs_enabled(snapshot),
        _ if needs_start && leaves_a_stop(action) && action != Action::Enable => {
            Some("after a stop: enable, then start")
        }
        Action::Run if snapshot.trial.run_key == RunKeyView::NotNeeded => {
            Some("not chosen (trial.hold_to_run, or --hold-to-run)")
        }
        _ if in_a_trial(action) && !phase.is_running() => Some("no trial runs"),
        Action::GoAhead | Action::NextStep | Action::NextIteration if phase != TrialPhase::Waiting => {
            Some("nothing waits for it")
        }
        Action::PreviousStep => Some("a step is undone by withdrawing the garment: hold, then withdraw"),
        Action::Withdraw if phase != TrialPhase::Holding => Some("hold first"),
        Action::Enable if robot.is_some_and(|robot| robot.enabled) => Some("enabled already"),
        Action::Disable if robot.is_some_and(|robot| !robot.enabled) => Some("disabled already"),
        _ if phase.is_running() && prepares(action) => Some("only before a trial"),
        Action::SignCheck if phase.is_running() => Some("only before a trial"),
        Action::Tare if phase.moves() => Some("only when the arms are still"),
        _ if is_replay(action) && snapshot.watermark != Watermark::Replay => Some("only in a replay"),
        _ => None,
    }
}

fn needs_enabled(snapshot: &Snapshot) -> Option<&'static str> {
    match snapshot.robot.fresh(snapshot.now) {
        None => Some("the robot's state is not known"),
        Some(robot) if !robot.enabled => Some("enable the robot first"),
        Some(_) => None,
    }
}

/// True for what there is only while a trial runs.
const fn in_a_trial(action: Action) -> bool {
    matches!(
        action,
        Action::HoldOrContinue
            | Action::Run
            | Action::Withdraw
            | Action::Abort
            | Action::FinishAfterThis
            | Action::GoAhead
            | Action::NextStep
            | Action::PreviousStep
            | Action::NextIteration
    )
}

/// True for what needs the stop to be reset first.
const fn leaves_a_stop(action: Action) -> bool {
    matches!(
        action,
        Action::Enable
            | Action::Start
            | Action::Withdraw
            | Action::GoAhead
            | Action::NextIteration
            | Action::NextStep
            | Action::PreviousStep
            | Action::HoldOrContinue
            | Action::Run
    )
}

/// True for what belongs before a trial.
const fn prepares(action: Action) -> bool {
    matches!(action, Action::Profile | Action::Garment | Action::FirstArm | Action::RecordMovement)
}

pub(in crate::console) const fn is_replay(action: Action) -> bool {
    matches!(
        action,
        Action::ReplayStep | Action::ReplaySlower | Action::ReplayFaster | Action::ReplayBack | Action::ReplayForward
    )
}

/// True for what a watching screen must not do.
const fn asks_the_robot(action: Action) -> bool {
    matches!(
        action,
        Action::HoldOrContinue
            | Action::Run
            | Action::GoAhead
            | Action::NextStep
            | Action::PreviousStep
            | Action::NextIteration
            | Action::FinishAfterThis
            | Action::Withdraw
            | Action::Abort
            | Action::Start
            | Action::Reset
            | Action::Enable
            | Action::Disable
            | Action::StrategyGmm
            | Action::StrategyForce
            | Action::StrategyMultimodal
            | Action::StrategyList
            | Action::Profile
            | Action::Garment
            | Action::FirstArm
            | Action::Settings
            | Action::RecordMovement
            | Action::Tare
            | Action::SignCheck
            | Action::Record
            | Action::Note
    )
}
