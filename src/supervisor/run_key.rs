//! Hold to run: where the operator has chosen it, the arms move only as long as a key is held down.
//!
//! Keeps account of the key and takes up again only what stopped for it; every other hold waits for the operator's own act.

use super::{Mode, Supervisor};
use crate::sequencing::Stage;
use crate::snapshot::Level;
use crate::time::Stamp;
use std::time::Duration;

/// So long after its last repeat a key counts as held: a terminal tells repeats, every 30 to 40 ms, but not the release
/// (checklists of dressing robots: at most 300 ms where it has to be guessed).
const HELD: Duration = Duration::from_millis(300);

/// The key, and whether the trial holds for it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RunKey {
    last: Option<Stamp>,
    holds: Option<LetGo>,
}

/// What was under way when the key was let go.
#[derive(Clone, Copy, Debug)]
struct LetGo {
    retreats: bool,
}

impl RunKey {
    fn is_held(self, now: Stamp) -> bool {
        self.last.and_then(|last| now.checked_since(last)).is_some_and(|age| age <= HELD)
    }
}

impl Supervisor {
    /// Holds the arms where the key has been let go while they move or are about to.
    pub(super) fn watch_run_key(&mut self, now: Stamp) {
        let waits = self.trial.as_ref().is_some_and(|trial| matches!(trial.stage(), Stage::AwaitGoAhead(_)));
        let needs_key = self.setup.settings.trial.hold_to_run && self.mode == Mode::Running && !waits;
        if !needs_key || self.run_key.is_held(now) {
            return;
        }
        let retreats = self.protection.retreats();
        self.hold(now, "the run key is not held down: the arms move only as long as it is");
        self.run_key.holds = Some(LetGo { retreats });
        self.show_run_key();
    }

    /// Something else than the key holds the trial from now on, or the trial goes on.
    pub(super) const fn forget_run_key(&mut self) {
        self.run_key.holds = None;
        self.show_run_key();
    }

    /// The key repeats. What stopped because it had been let go is taken up again; nothing else is.
    pub(super) fn obey_run(&mut self, now: Stamp) -> Result<String, String> {
        if !self.setup.settings.trial.hold_to_run {
            return Err("hold to run is not chosen: trial.hold_to_run, or --hold-to-run".into());
        }
        match (&self.mode, self.run_key.holds) {
            (Mode::Idle, _) => return Err("no trial runs".into()),
            (Mode::Held, None) => return Err("the trial holds for something else: continue, withdraw or abort".into()),
            (Mode::Held, Some(LetGo { retreats })) => self.take_up(now, retreats)?,
            (Mode::Running, _) => {}
        }
        self.run_key.last = Some(now);
        Ok("as long as it is held".into())
    }

    fn take_up(&mut self, now: Stamp, retreats: bool) -> Result<(), String> {
        if retreats {
            self.protection.may_retreat(now)?;
        } else {
            self.protection.readiness(now)?;
        }
        self.go_on(now);
        if retreats {
            self.protection.begin_retreat();
        }
        self.log(now, Level::Information, "operator", "the run key is held: the trial goes on".into());
        Ok(())
    }

    /// Something else holds a trial that is held: one that waited for the key does so no longer.
    pub(super) fn hold_for_more(&mut self, now: Stamp, cause: &str) {
        if self.waits_for_run_key() {
            self.forget_run_key();
            self.show_hold(now, cause);
        }
    }

    /// True where the trial moves only under a held key and waits for it.
    pub(super) const fn waits_for_run_key(&self) -> bool {
        self.run_key.holds.is_some()
    }
}
