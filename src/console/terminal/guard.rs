//! Takes the terminal and gives it back: at the end, at an error, and at a panic in any thread.

use super::frames::Frames;
use crate::console::StopHandle;
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::buffer::Buffer;
use ratatui::crossterm::cursor::Show;
use ratatui::crossterm::event::{DisableMouseCapture, EnableMouseCapture};
use ratatui::crossterm::terminal::{
    BeginSynchronizedUpdate, EndSynchronizedUpdate, EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode,
    enable_raw_mode,
};
use ratatui::crossterm::{execute, queue};
use ratatui::layout::{Position, Rect};
use std::io::{self, BufWriter, Stdout, Write};
use std::panic::{PanicHookInfo, set_hook, take_hook};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// True while this process has the terminal in its own mode.
static TAKEN: AtomicBool = AtomicBool::new(false);

type Screen = Terminal<CrosstermBackend<BufWriter<Stdout>>>;

/// Bytes that are collected before they go to the terminal: more than a full frame.
const BUFFER: usize = 1 << 16;

/// The terminal in raw mode on its alternate screen; dropped, it is as it was.
#[derive(Debug)]
pub(super) struct TerminalGuard {
    screen: Screen,
    frames: Frames,
}

impl TerminalGuard {
    /// Takes the terminal.
    pub(super) fn enter(mouse: bool) -> io::Result<Self> {
        take(mouse)?;
        let writer = BufWriter::with_capacity(BUFFER, io::stdout());
        match Terminal::new(CrosstermBackend::new(writer)) {
            Ok(screen) => Ok(Self { screen, frames: Frames::default() }),
            Err(error) => {
                restore();
                Err(error)
            }
        }
    }

    /// Draws one frame as one synchronized update: no terminal shows half of it. A frame that is the same as the last one is
    /// not sent at all.
    pub(super) fn draw(&mut self, render: impl Fn(Rect, &mut Buffer)) -> io::Result<()> {
        let area = Rect::from((Position::ORIGIN, self.screen.size()?));
        if !self.frames.prepare(area, &render) {
            return Ok(());
        }
        queue!(self.screen.backend_mut(), BeginSynchronizedUpdate)?;
        let drawn = self.frames.send(&mut self.screen, &render);
        execute!(self.screen.backend_mut(), EndSynchronizedUpdate)?;
        drawn
    }

    /// Columns and rows now.
    pub(super) fn size(&self) -> io::Result<(u16, u16)> {
        self.screen.size().map(|size| (size.width, size.height))
    }

    /// Forgets what is on the terminal, so that the next frame draws everything.
    pub(super) fn clear(&mut self) -> io::Result<()> {
        self.frames.forget();
        // Not `clear`, which asks the terminal where its cursor is and so reads keys itself: a stop among them would be lost,
        // and a terminal that does not answer would be taken for one that is gone.
        let size = self.screen.size()?;
        self.screen.resize(Rect::from((Position::ORIGIN, size)))
    }

    /// Takes or gives back the mouse.
    pub(super) fn mouse(&mut self, on: bool) -> io::Result<()> {
        if on {
            execute!(self.screen.backend_mut(), EnableMouseCapture)
        } else {
            execute!(self.screen.backend_mut(), DisableMouseCapture)
        }
    }

    /// Gives the terminal to the shell until `sleep` returns, then takes it again.
    pub(super) fn lend(&mut self, mouse: bool, sleep: impl FnOnce()) -> io::Result<()> {
        restore();
        sleep();
        take(mouse)?;
        self.clear()
    }

    /// Rings the bell.
    pub(super) fn bell(&mut self) -> io::Result<()> {
        self.screen.backend_mut().write_all(b"\x07")?;
        io::Write::flush(self.screen.backend_mut())
    }
}

impl Drop for TerminalGuard {
    fn drop(&mut self) {
        restore();
    }
}

fn take(mouse: bool) -> io::Result<()> {
    enable_raw_mode()?;
    TAKEN.store(true, Ordering::SeqCst);
    let entered = execute!(io::stdout(), EnterAlternateScreen);
    let entered = if mouse { entered.and_then(|()| execute!(io::stdout(), EnableMouseCapture)) } else { entered };
    if entered.is_err() {
        restore();
    }
    entered
}

/// Gives the terminal back, once. Nothing can be done where that fails: the terminal is gone then.
pub(super) fn restore() {
    if TAKEN.swap(false, Ordering::SeqCst) {
        let _ = execute!(io::stdout(), EndSynchronizedUpdate, DisableMouseCapture, LeaveAlternateScreen, Show);
        let _ = disable_raw_mode();
    }
}

type Hook = dyn Fn(&PanicHookInfo<'_>) + Send + Sync;

/// While it lives, a panic in any thread first stops the robot, then restores the terminal, then is logged and told.
pub(super) struct PanicGuard {
    previous: Arc<Hook>,
}

impl std::fmt::Debug for PanicGuard {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("PanicGuard").finish_non_exhaustive()
    }
}

impl PanicGuard {
    /// Puts the hook in front of the one that is there.
    pub(super) fn install(stop: Arc<dyn StopHandle>) -> Self {
        let previous: Arc<Hook> = Arc::from(take_hook());
        let next = Arc::clone(&previous);
        set_hook(Box::new(move |panic| {
            stop.stop();
            restore();
            tracing::error!("panic: {panic}");
            next(panic);
        }));
        Self { previous }
    }
}

impl Drop for PanicGuard {
    fn drop(&mut self) {
        // A hook cannot be changed from a thread that panics.
        if !std::thread::panicking() {
            let previous = Arc::clone(&self.previous);
            set_hook(Box::new(move |panic| previous(panic)));
        }
    }
}
