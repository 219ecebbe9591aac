//! What the operator asks of the trial: questions before motion, lists of choices, settings.

use super::{App, AskedSetting, Reaction};
use crate::body::Side;
use crate::command::Command;
use crate::console::ReplayRequest;
use crate::console::app::refusal;
use crate::console::dialog::{ChoiceItem, Dialog, TextPurpose};
use crate::console::keymap::Action;
use crate::snapshot::{SettingView, Snapshot, TrialPhase, Watermark};
use crate::strategy::StrategyKind;
use crate::time::Stamp;
use std::time::Duration;

/// How long a recording of the person's movement lasts, in seconds: the thesis recorded 5000 frames at 30 Hz a person in
/// five movements (section 3.5.1), half a minute each.
const MOVEMENT_SECONDS: f64 = 30.0;
/// How far a replay moves at a key, in seconds.
const SEEK_SECONDS: f64 = 10.0;
/// How long a value that was asked for is taken for the newest while the snapshot still says another: the core answers
/// within a beat of 10 ms, and what it refused must not count for long.
const ANSWER_PATIENCE: Duration = Duration::from_millis(300);

/// A terminal repeats a key that is held after half a second or a little more, and then some 30 times a second.
const REPEAT_DELAY: Duration = Duration::from_millis(1000);

impl App {
    /// Does what an action says, or says why not.
    pub(super) fn act(&mut self, action: Action, snapshot: &Snapshot) -> Vec<Reaction> {
        if let Some(reason) = refusal(action, snapshot) {
            let name = action.entry().map_or("", |entry| if entry.short.is_empty() { entry.text } else { entry.short });
            self.complain(format!("{name}: {reason}"));
            return Vec::new();
        }
        match action {
            Action::HoldOrContinue => self.hold_or_continue(snapshot),
            Action::Run => self.hold_run_key(snapshot),
            Action::GoAhead => self.ask(Command::GoAhead, snapshot),
            Action::NextStep => self.ask(Command::NextStep, snapshot),
            Action::PreviousStep => self.ask(Command::PreviousStep, snapshot),
            Action::NextIteration => self.ask(Command::NextIteration, snapshot),
            Action::FinishAfterThis => self.send(Command::FinishAfterThis, snapshot),
            Action::Withdraw => self.ask(Command::Withdraw, snapshot),
            Action::Abort => self.open(Dialog::confirm("Give the trial up?", ABORT_MOVES, Command::Abort)),
            Action::Start => self.ask(Command::Start, snapshot),
            Action::Reset => self.ask_for_the_word(),
            Action::Enable => self.ask(Command::Enable, snapshot),
            Action::Disable => self.ask(Command::Disable, snapshot),
            Action::StrategyGmm => self.ask(Command::SelectStrategy(StrategyKind::Gmm), snapshot),
            Action::StrategyForce => self.ask(Command::SelectStrategy(StrategyKind::Force), snapshot),
            Action::StrategyMultimodal => self.ask(Command::SelectStrategy(StrategyKind::Multimodal), snapshot),
            Action::Tare => self.send(Command::Tare(self.view.side), snapshot),
            Action::SignCheck => self.send(Command::SignCheck(self.view.side), snapshot),
            Action::Record => self.record(snapshot),
            Action::Note => self.open(Dialog::Text { purpose: TextPurpose::Note, typed: String::new() }),
            Action::Settings => self.open(Dialog::Settings { selected: 0 }),
            Action::StrategyList => self.open(strategy_list(snapshot)),
            Action::Profile => {
                self.open(names("Profile", &snapshot.choices.profiles, &snapshot.trial.profile, Command::SelectProfile))
            }
            Action::Garment => {
                self.open(names("Garment", &snapshot.choices.garments, &snapshot.trial.garment, Command::SelectGarment))
            }
            Action::FirstArm => self.open(sides("Which arm first", snapshot.trial.first_arm, Command::SelectFirstArm)),
            Action::RecordMovement => self.open(sides("Record the movement of which arm", None, |side| {
                Command::RecordMovement { side, seconds: MOVEMENT_SECONDS }
            })),
            Action::ReplayStep => vec![Reaction::Replay(ReplayRequest::Step)],
            Action::ReplaySlower => vec![Reaction::Replay(ReplayRequest::Speed(0.5))],
            Action::ReplayFaster => vec![Reaction::Replay(ReplayRequest::Speed(2.0))],
            Action::ReplayBack => vec![Reaction::Replay(ReplayRequest::Seek(-SEEK_SECONDS))],
            Action::ReplayForward => vec![Reaction::Replay(ReplayRequest::Seek(SEEK_SECONDS))],
            looking => self.look(looking, snapshot),
        }
    }

    pub(super) fn open(&mut self, dialog: Dialog) -> Vec<Reaction> {
        self.view.dialog = Some(dialog);
        Vec::new()
    }

    /// Asks before a command that can move the robot; sends any other at once.
    pub(super) fn ask(&mut self, command: Command, snapshot: &Snapshot) -> Vec<Reaction> {
        let switches_at_rest = matches!(command, Command::SelectStrategy(_)) && !snapshot.trial.phase.moves();
        if !command.may_move() || switches_at_rest {
            return self.send(command, snapshot);
        }
        let moves = what_moves(&command, snapshot);
        self.open(Dialog::confirm(question(&command), moves, command))
    }

    fn hold_or_continue(&mut self, snapshot: &Snapshot) -> Vec<Reaction> {
        if snapshot.watermark == Watermark::Replay {
            return vec![Reaction::Replay(ReplayRequest::PauseOrGoOn)];
        }
        if snapshot.trial.phase == TrialPhase::Holding {
            self.ask(Command::Continue, snapshot)
        } else {
            self.send(Command::Hold, snapshot)
        }
    }

    /// A first press alone moves nothing: only a key that repeats is held.
    fn hold_run_key(&mut self, snapshot: &Snapshot) -> Vec<Reaction> {
        let last = self.run_pressed.replace(snapshot.now);
        if last.is_some_and(|last| snapshot.now.distance(last) <= REPEAT_DELAY) {
            return vec![Reaction::Send(Command::Run)];
        }
        self.inform("hold it down: the arms move only as long as it is held");
        Vec::new()
    }

    fn ask_for_the_word(&mut self) -> Vec<Reaction> {
        self.open(Dialog::TypedWord {
            question: "Clear the robot's stop? Nothing moves; the robot stays disabled until it is enabled.".into(),
            word: "reset",
            typed: String::new(),
            command: Command::Reset,
        })
    }

    fn record(&mut self, snapshot: &Snapshot) -> Vec<Reaction> {
        if snapshot.recorder.on {
            let loses = "nothing moves; what happens from now on is not recorded";
            self.open(Dialog::confirm("Stop recording?", loses, Command::SetRecording(false)))
        } else {
            self.send(Command::SetRecording(true), snapshot)
        }
    }

    pub(super) fn move_setting(&mut self, row: usize, steps: i8, snapshot: &Snapshot) -> Vec<Reaction> {
        let Some(setting) = snapshot.settings.get(row.min(snapshot.settings.len().saturating_sub(1))) else {
            self.complain("no setting can be changed now");
            return Vec::new();
        };
        let value = rounded(self.newest_value(setting, snapshot.now) + f64::from(steps) * setting.step);
        let (least, most) = setting.limits;
        // A step that is meant to land on a limit may miss it by rounding.
        let slack = setting.step * 1e-6;
        if value < least - slack || value > most + slack {
            self.complain(format!("{}: {value:.3} is outside {least} to {most} {}", setting.name, setting.unit));
            return Vec::new();
        }
        let value = value.clamp(least, most);
        self.asked_setting = Some(AskedSetting { key: setting.key.clone(), value, at: snapshot.now });
        self.send(Command::SetSetting { key: setting.key.clone(), value }, snapshot)
    }

    /// A setting's value, or the one that has just been asked for: keys come faster than answers.
    fn newest_value(&self, setting: &SettingView, now: Stamp) -> f64 {
        let asked = self.asked_setting.as_ref().filter(|asked| asked.key == setting.key);
        asked.filter(|asked| now.distance(asked.at) < ANSWER_PATIENCE).map_or(setting.value, |asked| asked.value)
    }

    pub(super) fn undo_setting(&mut self, row: usize, snapshot: &Snapshot) -> Vec<Reaction> {
        let row = row.min(snapshot.settings.len().saturating_sub(1));
        self.asked_setting = None;
        match snapshot.settings.get(row) {
            Some(setting) if setting.previous.is_some() => {
                self.send(Command::UndoSetting { key: setting.key.clone() }, snapshot)
            }
            Some(setting) => {
                self.complain(format!("{}: was not changed, nothing to undo", setting.name));
                Vec::new()
            }
            None => Vec::new(),
        }
    }
}

/// To a millionth, far below the step of every setting: sums of steps such as 0.03 - 0.005 miss a number of few digits.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

const ABORT_MOVES: &str = "nothing moves: the arms hold where they are";

fn question(command: &Command) -> String {
    let mut words = command.to_string();
    if let Some(first) = words.get_mut(0..1) {
        first.make_ascii_uppercase();
    }
    words.push('?');
    words
}

/// What a command will set in motion: limb, strategy, iteration.
fn what_moves(command: &Command, snapshot: &Snapshot) -> String {
    let trial = &snapshot.trial;
    let strategy = trial.strategy.map_or_else(String::new, |strategy| format!(" · strategy {strategy}"));
    let iteration = trial.arm.map_or_else(String::new, |arm| {
        let side = snapshot.sides.get(arm);
        let number = side.iterations.last().map_or(1, |iteration| iteration.number);
        format!(" · {arm} arm, iteration {number} of {}", side.iterations_maximum)
    });
    match command {
        Command::Start if !trial.phase.is_running() => {
            let first = trial.first_arm.map_or_else(String::new, |arm| format!("; then the {arm} arm first"));
            format!("both grippers: take the start posture, back from the person{first}{strategy}")
        }
        // After a stop: the latch opens, and the trial holds.
        Command::Start => "nothing yet: the trial holds until it is continued, withdrawn or given up".into(),
        Command::Enable => "both arms: the motors switch on and hold them where they are".into(),
        Command::Disable => "both arms: the motors switch off, the arms may sink".into(),
        Command::Withdraw => {
            let arm = trial.arm.map_or_else(|| "the arm".into(), |arm| format!("the {arm} arm"));
            format!("{arm} goes back along the travelled path, slowly")
        }
        Command::SelectStrategy(kind) => {
            let known = snapshot.strategies.iter().find(|strategy| strategy.kind == *kind);
            let effect = known.map_or_else(|| "from the next safe point on".into(), |known| known.switch.clone());
            format!("{effect}{iteration}")
        }
        _ => match &trial.next {
            Some(next) => {
                let arms: Vec<_> = next.arms.iter().map(|arm| arm.name()).collect();
                format!("{} gripper: {}{strategy}{iteration}", arms.join(" and "), next.what)
            }
            None => format!("both grippers may move{strategy}{iteration}"),
        },
    }
}

fn strategy_list(snapshot: &Snapshot) -> Dialog {
    let item = |kind: StrategyKind| {
        let known = snapshot.strategies.iter().find(|strategy| strategy.kind == kind);
        let refused = known.and_then(|known| known.refusal.clone());
        ChoiceItem {
            name: kind.name().into(),
            note: refused.clone().or_else(|| known.map(|known| known.switch.clone())).unwrap_or_default(),
            command: refused.is_none().then_some(Command::SelectStrategy(kind)),
        }
    };
    let offered: &[StrategyKind] =
        if snapshot.choices.strategies.is_empty() { &StrategyKind::ALL } else { &snapshot.choices.strategies };
    Dialog::Choice { title: "Strategy".into(), items: offered.iter().copied().map(item).collect(), selected: 0 }
}

/// A list in which the name that holds now has the focus and says so.
fn names(title: &str, names: &[String], now: &str, command: impl Fn(String) -> Command) -> Dialog {
    let item = |name: &String| ChoiceItem {
        name: name.clone(),
        note: if name == now { NOW.into() } else { String::new() },
        command: Some(command(name.clone())),
    };
    let selected = names.iter().position(|name| name == now).unwrap_or_default();
    Dialog::Choice { title: title.into(), items: names.iter().map(item).collect(), selected }
}

fn sides(title: &str, now: Option<Side>, command: impl Fn(Side) -> Command) -> Dialog {
    const ORDER: [Side; 2] = [Side::Right, Side::Left];
    let item = |side: Side| ChoiceItem {
        name: format!("{side} arm"),
        note: if now == Some(side) { NOW.into() } else { String::new() },
        command: Some(command(side)),
    };
    let selected = ORDER.iter().position(|side| now == Some(*side)).unwrap_or_default();
    Dialog::Choice { title: title.into(), items: ORDER.map(item).to_vec(), selected }
}

/// What stands beside the choice that holds.
const NOW: &str = "now";
