//! Runs a recorded trial through the same core and compares every decision with the recorded one.

use super::ahead::read_ahead;
use super::entry::{Header, Recipe, Step};
use super::error::JournalError;
use super::file::JournalFile;
use super::{Reading, read};
use crate::body::PerSide;
use crate::kinematics::RobotModel;
use crate::modelling::{ArmSpace, MovementSpace};
use crate::supervisor::{Effect, Setup, Supervisor, WarmStart};
use crate::time::Stamp;
use serde::Serialize;

/// A step at which the core now decides otherwise than it was recorded.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// The step's number.
    pub step: u64,
    /// The core's time, in nanoseconds.
    pub nanoseconds: u64,
    /// What was recorded, in words.
    pub recorded: String,
    /// What is decided now, in words.
    pub decided: String,
}

/// A core that is fed with a recorded trial.
#[derive(Debug)]
pub struct Replay {
    supervisor: Supervisor,
    space: Option<MovementSpace>,
    gap: Option<u64>,
    expected: u64,
}

impl Replay {
    /// The core that the journal's header describes, with settings changed by `change`.
    ///
    /// # Errors
    /// The reason in words where the header's settings are not usable.
    pub fn new(header: &Header, change: impl FnOnce(Setup) -> Result<Setup, String>) -> Result<Self, String> {
        let setup = change(Recipe::of_header(header)?)?;
        let model = RobotModel::baxter().map_err(|error| error.to_string())?;
        let space = setup.space.clone();
        let supervisor = Supervisor::new(setup, model).map_err(|error| error.to_string())?;
        Ok(Self { supervisor, space, gap: None, expected: 0 })
    }

    /// Feeds one step. Returns what is decided now and, where that is not what was recorded, the difference.
    pub fn step(&mut self, step: &Step) -> (Vec<Effect>, Option<Difference>) {
        // Lost by a full queue or with a damaged chunk: either way the core has not seen what came in.
        if step.number != self.expected {
            self.gap.get_or_insert(step.number);
        }
        self.expected = step.number + 1;
        let effects = self.supervisor.step(step.now, &step.input);
        let difference = (!step.decided(&effects)).then(|| Difference {
            step: step.number,
            nanoseconds: step.now.nanoseconds(),
            recorded: in_words(&step.effects),
            decided: in_words(&effects),
        });
        (effects, difference)
    }

    /// The first step after a hole in the journal: from there on differences are to be expected.
    #[must_use]
    pub const fn first_gap(&self) -> Option<u64> {
        self.gap
    }

    /// The person's movement space, where the trial had one.
    #[must_use]
    pub const fn space(&self) -> Option<&MovementSpace> {
        self.space.as_ref()
    }

    /// The core, for its snapshots.
    #[must_use]
    pub const fn supervisor(&self) -> &Supervisor {
        &self.supervisor
    }

    /// Runs a whole journal. Every step is shown to `visit` with what is decided now.
    ///
    /// # Errors
    /// [`JournalError`] where the journal cannot be read or its settings are not usable.
    pub fn run(
        journal: impl Into<JournalFile>,
        change: impl Fn(Setup) -> Result<Setup, String>,
        mut visit: impl FnMut(&Self, Stamp, &Step, &[Effect], Option<&Difference>),
    ) -> Result<Reading, JournalError> {
        let journal = journal.into();
        let mut replay = None;
        let mut refused = None;
        let reading = read_ahead(&journal, |header, step| {
            if replay.is_none() && refused.is_none() {
                match Self::new(header, &change) {
                    Ok(made) => replay = Some(made),
                    Err(reason) => refused = Some(reason),
                }
            }
            if let Some(replay) = &mut replay {
                let (effects, difference) = replay.step(&step);
                visit(replay, step.now, &step, &effects, difference.as_ref());
            }
        })?;
        match refused {
            None => Ok(reading),
            Some(reason) => {
                Err(JournalError::foreign(journal.path(), format!("its settings are not usable: {reason}")))
            }
        }
    }
}

fn in_words(effects: &[Effect]) -> String {
    if effects.is_empty() {
        return "nothing".to_owned();
    }
    serde_json::to_string(effects).unwrap_or_else(|_| format!("{effects:?}"))
}

/// What a recorded session found out about its person.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Learned {
    /// Paths of arms that were dressed, the newest last, with the journal's name as their source.
    pub paths: Vec<WarmStart>,
    /// The movement space of each arm whose movement was recorded; the newest one.
    pub spaces: PerSide<Option<ArmSpace>>,
}

/// What a recorded session has learned.
///
/// # Errors
/// [`JournalError`] where the journal cannot be read at all.
pub fn learned_in(journal: impl Into<JournalFile>) -> Result<Learned, JournalError> {
    let journal = journal.into();
    let trial = journal.name();
    let mut learned = Learned::default();
    read(&journal, |_, step| {
        for effect in step.effects {
            match effect {
                Effect::Learned(found) => learned.paths.push(WarmStart { trial: trial.clone(), ..found }),
                Effect::Recorded { side, space } => *learned.spaces.get_mut(side) = Some(*space),
                _ => {}
            }
        }
    })?;
    Ok(learned)
}
