//! Exports a journal as tables (CSV), one file a kind, time in seconds from the first step.

use super::error::JournalError;
use super::file::JournalFile;
use super::{Reading, Step, read};
use crate::command::Command;
use crate::supervisor::{Effect, Input};
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// The files of an export.
#[derive(Debug)]
pub struct CsvFiles {
    folder: PathBuf,
    wrench: csv::Writer<File>,
    joints: csv::Writer<File>,
    robot: csv::Writer<File>,
    setpoints: csv::Writer<File>,
    iterations: csv::Writer<File>,
    waypoints: csv::Writer<File>,
    events: csv::Writer<File>,
}

/// Writes a journal as CSV files into a folder. Time counts from the first step. With `anonymous`, free text (the log, notes,
/// causes and reasons) is left out.
///
/// # Errors
/// [`JournalError`] where the journal cannot be read or a file cannot be written.
pub fn write_csv(journal: impl Into<JournalFile>, folder: &Path, anonymous: bool) -> Result<Reading, JournalError> {
    let mut files = CsvFiles::create(folder)?;
    let mut first = None;
    let mut outcome = Ok(());
    let reading = read(journal, |_, step| {
        let began = *first.get_or_insert(step.now);
        if outcome.is_ok() {
            outcome = files.step(step.now.since(began).as_secs_f64(), &step, anonymous);
        }
    })?;
    outcome.map_err(|error| JournalError::container(folder, error))?;
    files.finish()?;
    Ok(reading)
}

const JOINTS: [&str; 9] = [
    "time_seconds",
    "arm",
    "s0_radians",
    "s1_radians",
    "e0_radians",
    "e1_radians",
    "w0_radians",
    "w1_radians",
    "w2_radians",
];

impl CsvFiles {
    fn create(folder: &Path) -> Result<Self, JournalError> {
        fs::create_dir_all(folder).map_err(|source| JournalError::file(folder, source))?;
        let open = |name: &str, head: &[&str]| {
            let path = folder.join(name);
            let mut writer = csv::Writer::from_path(&path).map_err(|error| JournalError::container(&path, error))?;
            writer.write_record(head).map_err(|error| JournalError::container(&path, error))?;
            Ok::<_, JournalError>(writer)
        };
        let wrench = [
            "time_seconds",
            "arm",
            "x_metres",
            "y_metres",
            "z_metres",
            "qx",
            "qy",
            "qz",
            "qw",
            "force_x_newtons",
            "force_y_newtons",
            "force_z_newtons",
            "torque_x_newton_metres",
            "torque_y_newton_metres",
            "torque_z_newton_metres",
        ];
        let iterations = [
            "time_seconds",
            "arm",
            "strategy",
            "iteration",
            "energy_newtons",
            "resistances",
            "waypoints",
            "duration_seconds",
        ];
        let waypoints = [
            "time_seconds",
            "arm",
            "iteration",
            "waypoint",
            "from_x_metres",
            "from_y_metres",
            "from_z_metres",
            "to_x_metres",
            "to_y_metres",
            "to_z_metres",
            "force_x_newtons",
            "force_y_newtons",
            "force_z_newtons",
            "reason",
        ];
        Ok(Self {
            folder: folder.to_path_buf(),
            wrench: open("wrench.csv", &wrench)?,
            joints: open("joints.csv", &JOINTS)?,
            robot: open("robot.csv", &["time_seconds", "enabled", "stopped", "error", "button", "source"])?,
            setpoints: open("setpoints.csv", &JOINTS)?,
            iterations: open("iterations.csv", &iterations)?,
            waypoints: open("waypoints.csv", &waypoints)?,
            events: open("events.csv", &["time_seconds", "kind", "text"])?,
        })
    }

    fn step(&mut self, seconds: f64, step: &Step, anonymous: bool) -> csv::Result<()> {
        let time = format!("{seconds:.6}");
        self.input(&time, &step.input, anonymous)?;
        step.effects.iter().try_for_each(|effect| self.effect(&time, effect, anonymous))
    }

    fn input(&mut self, time: &str, input: &Input, anonymous: bool) -> csv::Result<()> {
        match input {
            Input::Endpoint(sample) => {
                let rotation = sample.pose.rotation.coords;
                let numbers = sample.pose.translation.vector.iter().chain(rotation.iter());
                let numbers = numbers.chain(sample.wrench.force.iter()).chain(sample.wrench.torque.iter());
                self.wrench.write_record(row(time, sample.side.name(), numbers.map(ToString::to_string)))
            }
            Input::Joints(sample) => sample.positions.iter().try_for_each(|(side, positions)| {
                let numbers =
                    positions.iter().map(|position| position.map_or(String::new(), |value| value.to_string()));
                self.joints.write_record(row(time, side.name(), numbers))
            }),
            Input::Robot(state) => {
                let flags = [state.enabled, state.stopped, state.error].map(|flag| flag.to_string());
                let words = [format!("{:?}", state.button), format!("{:?}", state.source)];
                self.robot.write_record(std::iter::once(time.to_owned()).chain(flags).chain(words))
            }
            // Causes and reasons can hold the names of machines, files and people: only what happened is kept.
            Input::Operator {
                command: Command::Note(_) | Command::SelectProfile(_) | Command::SelectGarment(_),
                ..
            } if anonymous => Ok(()),
            Input::SetpointRefused { .. } if anonymous => self.events.write_record([time, "refused", ""]),
            Input::Link(_) if anonymous => self.events.write_record([time, "link", ""]),
            Input::Operator { command, .. } => self.events.write_record([time, "operator", &command.to_string()]),
            Input::SetpointRefused { reason, .. } => self.events.write_record([time, "refused", reason]),
            Input::Planned { ways: Ok(_), number } => self.events.write_record([time, "planned", &number.to_string()]),
            Input::Planned { ways: Err(reason), .. } => self.events.write_record([time, "not planned", reason]),
            Input::Link(event) => self.events.write_record([time, "link", &format!("{event:?}")]),
            Input::Cuff { side, squeezed: true } => self.events.write_record([time, "cuff", side.name()]),
            Input::StartFound { joints: Err(reason), .. } => self.events.write_record([time, "no start", reason]),
            Input::Tick
            | Input::Cuff { .. }
            | Input::Collision { .. }
            | Input::Body(_)
            | Input::Fitted { .. }
            | Input::StartFound { .. } => Ok(()),
        }
    }

    fn effect(&mut self, time: &str, effect: &Effect, anonymous: bool) -> csv::Result<()> {
        match effect {
            Effect::Setpoint { side, joints } => {
                self.setpoints.write_record(row(time, side.name(), joints.iter().map(ToString::to_string)))
            }
            Effect::Iteration { side, strategy, summary, duration_seconds } => {
                let cells = [
                    strategy.name().to_owned(),
                    summary.iteration.to_string(),
                    summary.energy.to_string(),
                    summary.contacts.to_string(),
                    summary.path.len().to_string(),
                    duration_seconds.to_string(),
                ];
                self.iterations.write_record(row(time, side.name(), cells))
            }
            Effect::Waypoint { side, change } => {
                let numbers = change.from.coords.iter().chain(change.to.coords.iter()).chain(change.resistance.iter());
                let cells = [change.iteration.to_string(), change.index.to_string()].into_iter();
                let cells = cells.chain(numbers.map(ToString::to_string)).chain([change.to_string()]);
                self.waypoints.write_record(row(time, side.name(), cells))
            }
            Effect::Log { level, text } if !anonymous => self.events.write_record([time, level.name(), text]),
            Effect::Stopped { outcome, .. } if anonymous => self.events.write_record([time, "stop", outcome.words()]),
            Effect::TrialEnded { outcome, .. } if anonymous => self.events.write_record([time, "end", outcome.words()]),
            Effect::Stopped { cause, .. } => self.events.write_record([time, "stop", cause]),
            Effect::TrialEnded { outcome, reason } => {
                self.events.write_record([time, "end", &format!("{}: {reason}", outcome.words())])
            }
            _ => Ok(()),
        }
    }

    fn finish(self) -> Result<(), JournalError> {
        let files =
            [self.wrench, self.joints, self.robot, self.setpoints, self.iterations, self.waypoints, self.events];
        for mut file in files {
            file.flush().map_err(|source| JournalError::file(&self.folder, source))?;
        }
        Ok(())
    }
}

fn row(time: &str, arm: &str, cells: impl IntoIterator<Item = String>) -> impl Iterator<Item = String> {
    [time.to_owned(), arm.to_owned()].into_iter().chain(cells)
}
