//! A recorded trial on the operator's screen: the same console, fed by the player instead of a robot.

use crate::cli::exit::Failure;
use crate::cli::output::Output;
use crate::command::Command;
use crate::console::{ConsoleOptions, ReplayControl, ReplayRequest};
use crate::record::Player;
use crate::snapshot::Snapshot;
use std::cell::RefCell;
use std::rc::Rc;
use std::time::{Duration, Instant};

/// How long the core may be fed before the screen gets its turn again: half a frame at thirty a second.
const TURN: Duration = Duration::from_millis(16);
/// Steps between two looks at the clock.
const PORTION: usize = 64;

/// The player with the clock that moves it.
struct Playing {
    player: Player,
    last: Instant,
    problem: Option<String>,
}

impl Playing {
    /// The newest snapshot; `None` while a far seek is under way.
    fn newest(&mut self) -> Option<Snapshot> {
        let began = Instant::now();
        let elapsed = began.duration_since(self.last);
        self.last = began;
        self.player.pass(elapsed);
        while !self.player.catch_up(PORTION) {
            if began.elapsed() > TURN {
                return None;
            }
        }
        Some(self.player.snapshot())
    }

    fn request(&mut self, request: ReplayRequest) {
        let done = match request {
            ReplayRequest::PauseOrGoOn => self.player.pause_or_go_on(),
            ReplayRequest::Seek(seconds) => self.player.seek(seconds),
            ReplayRequest::Step => {
                self.player.step();
                Ok(())
            }
            ReplayRequest::Speed(factor) => {
                self.player.change_speed(factor);
                Ok(())
            }
        };
        if let Err(error) = done {
            self.problem.get_or_insert(error.to_string());
        }
    }
}

/// The console's hold on the player.
struct Control(Rc<RefCell<Playing>>);

impl ReplayControl for Control {
    fn request(&mut self, request: ReplayRequest) {
        self.0.borrow_mut().request(request);
    }
}

/// Shows a trial until the operator leaves it, and says then what was seen.
pub(super) fn show(player: Player, options: &ConsoleOptions) -> Result<(), Failure> {
    let playing = Rc::new(RefCell::new(Playing { player, last: Instant::now(), problem: None }));
    let source = Rc::clone(&playing);
    let control = Box::new(Control(Rc::clone(&playing)));
    let snapshots = move || -> Option<Snapshot> { source.borrow_mut().newest() };
    let commands = |_: Command| Err("a recorded trial takes no commands".to_owned());
    // There is nothing to stop: the keys still answer.
    let stop: std::sync::Arc<dyn crate::console::StopHandle> = std::sync::Arc::new(|| {});
    crate::console::run(snapshots, commands, &stop, Some(control), options).map_err(Failure::configuration)?;
    let playing = playing.borrow();
    if let Some(problem) = &playing.problem {
        return Err(Failure::Fault(problem.clone()));
    }
    let mut output = Output::new(false);
    for problem in &playing.player.reading().problems {
        output.line(format!("not readable: {problem}"))?;
    }
    output.line(format!("{} differences so far as it was shown", playing.player.differing()))
}
