//! `valet replay`: a recorded trial through the same core, every decision compared with the recorded one.

mod screen;

use super::exit::Failure;
use super::key::KeyArguments;
use super::output::Output;
use crate::config::{Places, Settings, layered};
use crate::headless::Report;
use crate::record::{Difference, JournalFile, Player, Reading, Replay};
use crate::supervisor::{Effect, Setup, SupervisorSettings};
use serde::Serialize;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::Instant;
use toml::Table;

/// A recorded trial through the same core, on the same screen: every decision compared with the recorded one.
///
/// Keys on the screen: p pauses and goes on, . goes to the next decision, { and } halve and double the pace, < and > go ten
/// seconds back and on. Differences stand in the log. Without a terminal the decisions are printed as lines.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// The journal (`*.mcap`).
    trial: PathBuf,
    /// Only compare: exit code 0 only where every decision is the recorded one and the whole journal could be read.
    #[arg(long)]
    check: bool,
    /// Print what was decided as lines instead of showing it on a screen.
    #[arg(long)]
    headless: bool,
    /// Print one JSON object a line.
    #[arg(long)]
    json: bool,
    /// Change a setting and show what would have been decided, as in `strategy=multimodal` or `window.threshold_newtons=4`.
    #[arg(long, value_name = "KEY=VALUE")]
    what_if: Vec<String>,
    #[command(flatten)]
    key: KeyArguments,
}

/// Differences that are shown to people; the rest is counted.
const SHOWN: u64 = 20;

#[derive(Serialize)]
struct Summary<'a> {
    event: &'static str,
    trial: &'a Path,
    steps: u64,
    decisions: u64,
    differences: u64,
    lost_steps: u64,
    problems: Vec<String>,
    finished: bool,
    first_gap: Option<u64>,
    what_if: &'a [String],
    wall_seconds: f64,
}

#[derive(Serialize)]
struct DifferenceEvent<'a> {
    event: &'static str,
    seconds: f64,
    #[serde(flatten)]
    difference: &'a Difference,
}

/// What is counted while a journal runs.
#[derive(Default)]
struct Tally {
    decisions: u64,
    differences: u64,
    first_gap: Option<u64>,
    printed: Option<Failure>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(arguments.json);
    let layer = what_if_layer(&arguments.what_if)?;
    if arguments.is_for_a_screen() {
        return show(arguments, layer);
    }
    let began = Instant::now();
    let mut tally = Tally::default();
    let change = |setup: Setup| changed(setup, &arguments.trial, &layer);
    let reading = Replay::run(arguments.journal()?, change, |replay, now, _, effects, difference| {
        tally.first_gap = replay.first_gap();
        tally.decisions += effects.len() as u64;
        let printed = print_step(arguments, &mut output, &mut tally.differences, now.seconds(), effects, difference);
        if let Err(failure) = printed {
            tally.printed.get_or_insert(failure);
        }
    });
    let reading = reading.map_err(Failure::configuration)?;
    tally.printed.map_or(Ok(()), Err)?;
    let summary = Summary {
        event: "replay",
        trial: &arguments.trial,
        steps: reading.steps,
        decisions: tally.decisions,
        differences: tally.differences,
        lost_steps: reading.lost,
        problems: reading.problems.iter().map(ToString::to_string).collect(),
        finished: reading.finished,
        first_gap: tally.first_gap,
        what_if: &arguments.what_if,
        wall_seconds: began.elapsed().as_secs_f64(),
    };
    print_summary(&mut output, &summary)?;
    if arguments.check { verdict(&arguments.trial, &reading, tally.differences) } else { Ok(()) }
}

impl Arguments {
    fn journal(&self) -> Result<JournalFile, Failure> {
        Ok(JournalFile::new(&self.trial, self.key.given()?))
    }

    fn is_for_a_screen(&self) -> bool {
        let terminal = std::io::stdin().is_terminal() && std::io::stdout().is_terminal();
        terminal && !self.check && !self.json && !self.headless
    }
}

fn show(arguments: &Arguments, layer: Table) -> Result<(), Failure> {
    let settings = Settings::find(None, &Places::of_this_machine()).map_err(Failure::configuration)?;
    let trial = arguments.trial.clone();
    let change = Box::new(move |setup| changed(setup, &trial, &layer));
    let player = Player::open(arguments.journal()?, change).map_err(Failure::configuration)?;
    screen::show(player, settings.console())
}

fn print_step(
    arguments: &Arguments,
    output: &mut Output,
    differences: &mut u64,
    seconds: f64,
    effects: &[Effect],
    difference: Option<&Difference>,
) -> Result<(), Failure> {
    if !arguments.check {
        for report in effects.iter().filter_map(Report::of) {
            output.line(format!("{seconds:8.2} s  {}", report.sentence))?;
            report.event.as_ref().map_or(Ok(()), |event| output.event(event))?;
        }
    }
    let Some(difference) = difference else { return Ok(()) };
    *differences += 1;
    if *differences <= SHOWN {
        output.line(format!(
            "{seconds:8.2} s  step {}: recorded {}; now {}",
            difference.step,
            shortened(&difference.recorded),
            shortened(&difference.decided)
        ))?;
    }
    output.event(&DifferenceEvent { event: "difference", seconds, difference })
}

fn shortened(text: &str) -> String {
    const LONGEST: usize = 160;
    let head: String = text.chars().take(LONGEST).collect();
    if head.len() < text.len() { format!("{head} ...") } else { head }
}

fn print_summary(output: &mut Output, summary: &Summary<'_>) -> Result<(), Failure> {
    output.event(summary)?;
    for problem in &summary.problems {
        output.line(format!("not readable: {problem}"))?;
    }
    if !summary.finished {
        output.line("the journal was not ended in order: all but at most its last second is there")?;
    }
    if let Some(step) = summary.first_gap {
        output.line(format!(
            "steps are missing before step {step} ({} of them were left out by the recorder): what is decided after it may differ",
            summary.lost_steps
        ))?;
    }
    output.line(format!(
        "{} steps, {} decisions, {} differences, {:.1} s",
        summary.steps, summary.decisions, summary.differences, summary.wall_seconds
    ))
}

fn verdict(trial: &Path, reading: &Reading, differences: u64) -> Result<(), Failure> {
    let trial = trial.display();
    if differences > 0 {
        return Err(Failure::Fault(format!("{trial}: {differences} steps are decided otherwise than recorded")));
    }
    match reading.problems.first() {
        Some(problem) => Err(Failure::Fault(format!("{trial}: not all of it can be read: {problem}"))),
        None if reading.lost > 0 => Err(Failure::Fault(format!("{trial}: {} steps were not recorded", reading.lost))),
        None => Ok(()),
    }
}

/// The settings that `--what-if` changes, as a layer.
fn what_if_layer(typed: &[String]) -> Result<Table, Failure> {
    let text: Vec<String> = typed
        .iter()
        .map(|change| {
            let (key, value) = change
                .split_once('=')
                .ok_or_else(|| Failure::Configuration(format!("--what-if {change}: write KEY=VALUE")))?;
            // A word that is no value of TOML is a text.
            let plain = format!("{key} = {value}");
            Ok(if plain.parse::<Table>().is_ok() { plain } else { format!("{key} = {value:?}") })
        })
        .collect::<Result<_, Failure>>()?;
    text.join("\n").parse().map_err(|error: toml::de::Error| Failure::Configuration(format!("--what-if: {error}")))
}

fn changed(mut setup: Setup, trial: &Path, layer: &Table) -> Result<Setup, String> {
    if layer.is_empty() {
        return Ok(setup);
    }
    let recorded = Table::try_from(&setup.settings).map_err(|error| error.to_string())?;
    let layers = [(trial, &recorded), (Path::new("--what-if"), layer)];
    setup.settings = layered::<SupervisorSettings>(&layers).map_err(|error| error.to_string())?;
    Ok(setup)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strategy::StrategyKind;

    #[test]
    fn a_word_and_a_number_are_both_understood() {
        let layer = what_if_layer(&["strategy=multimodal".into(), "window.threshold_newtons=4".into()]);
        let layer = layer.map_err(|failure| failure.to_string());
        // A whole number is no float in TOML; the settings take both.
        let setup = changed(Setup::default(), Path::new("x"), &layer.unwrap()).unwrap();
        assert_eq!(setup.settings.strategy, StrategyKind::Multimodal);
        assert!((setup.settings.window.threshold_newtons - 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_key_that_does_not_exist_is_named() {
        let layer = what_if_layer(&["windows.length=4".into()]).map_err(|failure| failure.to_string()).unwrap();
        let error = changed(Setup::default(), Path::new("x"), &layer).unwrap_err();
        assert!(error.contains("windows"), "{error}");
        assert!(what_if_layer(&["strategy".into()]).is_err());
    }
}
