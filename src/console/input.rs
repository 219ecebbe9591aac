//! The thread that reads keys: stop keys go to the latch before anything else sees them.
//!
//! It shares nothing with the drawing: a terminal that takes no more output, a slow frame or a full queue do not delay
//! a stop. It reads the terminal itself and not through crossterm's events: those drop a key that comes together with a
//! new size until the next key, and a Space that follows an Esc, half a sequence or a byte that is no UTF-8 for good.

use super::StopHandle;
use super::keyboard::Decoder;
use super::keymap::{Chord, KeyMap};
use crossbeam_channel::Sender;
use ratatui::crossterm::event::{Event, KeyEventKind};
use ratatui::crossterm::terminal;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use signal_hook::consts::SIGWINCH;
use signal_hook::{SigId, low_level};
use std::io::{self, Read, Stdin};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How often the thread looks whether it should end, while no key comes.
const PATIENCE: Duration = Duration::from_millis(100);

/// How long after an Esc the rest of a sequence may come, as over a slow line; longer, and it was the Esc key.
const ESCAPE_PATIENCE: Duration = Duration::from_millis(50);

/// What the thread tells.
#[derive(Debug)]
pub(super) enum Heard {
    /// A key, the mouse or a size.
    Event(Event),
    /// The terminal cannot be read any more.
    Lost,
}

/// The running thread; it ends when this is dropped.
#[derive(Debug)]
pub(super) struct InputThread {
    leave: Arc<AtomicBool>,
    paused: Arc<AtomicBool>,
    keys: Sender<KeyMap>,
    handle: Option<JoinHandle<()>>,
}

impl InputThread {
    /// Starts the thread.
    pub(super) fn start(keys: KeyMap, stop: Arc<dyn StopHandle>, heard: Sender<Heard>) -> std::io::Result<Self> {
        let leave = Arc::new(AtomicBool::new(false));
        let paused = Arc::new(AtomicBool::new(false));
        let (told_to_leave, told_to_pause) = (Arc::clone(&leave), Arc::clone(&paused));
        let (renewed, renewals) = crossbeam_channel::unbounded();
        let mut keys = keys;
        let mut ears = Ears::open()?;
        let body = move || {
            while !told_to_leave.load(Ordering::Relaxed) {
                if let Some(newest) = renewals.try_iter().last() {
                    keys = newest;
                }
                if told_to_pause.load(Ordering::Relaxed) {
                    thread::sleep(PATIENCE);
                } else if !listen(&mut ears, &keys, stop.as_ref(), &heard) {
                    return;
                }
            }
        };
        let handle = thread::Builder::new().name("keys".into()).spawn(body)?;
        Ok(Self { leave, paused, keys: renewed, handle: Some(handle) })
    }

    /// Leaves the terminal's input alone, or takes it up again: while the shell has it.
    pub(super) fn pause(&self, paused: bool) {
        self.paused.store(paused, Ordering::Relaxed);
    }
}

impl InputThread {
    /// Stops at the keys of this table from now on. The two stop keys are in every table.
    pub(super) fn use_keys(&self, keys: KeyMap) {
        // A thread that has ended reads no keys any more.
        let _ = self.keys.send(keys);
    }
}

impl Drop for InputThread {
    fn drop(&mut self) {
        self.leave.store(true, Ordering::Relaxed);
        let Some(handle) = self.handle.take() else { return };
        // Where somebody else has read the key that was waited for, reading goes on until the next one: such a thread is left
        // to end with the process.
        let patience = Instant::now();
        while !handle.is_finished() && patience.elapsed() < 3 * PATIENCE {
            thread::sleep(PATIENCE / 10);
        }
        if handle.is_finished() {
            // A panic of that thread has already stopped the robot and been told by the hook.
            let _ = handle.join();
        }
    }
}

/// What the thread listens to.
struct Ears {
    keys: Stdin,
    sizes: UnixStream,
    signal: SigId,
    decoder: Decoder,
}

impl Drop for Ears {
    fn drop(&mut self) {
        low_level::unregister(self.signal);
    }
}

impl Ears {
    fn open() -> io::Result<Self> {
        let (sizes, told) = UnixStream::pair()?;
        sizes.set_nonblocking(true)?;
        told.set_nonblocking(true)?;
        let signal = low_level::pipe::register(SIGWINCH, told)?;
        Ok(Self { keys: io::stdin(), sizes, signal, decoder: Decoder::default() })
    }

    /// Waits for a moment; what was heard, keys before sizes. Each is asked about anew every time, so nothing that has
    /// come at the same time as something else is forgotten.
    fn listen(&mut self) -> io::Result<Vec<Event>> {
        let patience = if self.decoder.is_waiting() { ESCAPE_PATIENCE } else { PATIENCE };
        let patience = Timespec { tv_sec: 0, tv_nsec: patience.subsec_nanos().into() };
        let mut waits = [PollFd::new(&self.keys, PollFlags::IN), PollFd::new(&self.sizes, PollFlags::IN)];
        match poll(&mut waits, Some(&patience)) {
            Ok(0) => return Ok(self.decoder.flush()),
            Err(Errno::INTR) => return Ok(Vec::new()),
            other => other?,
        };
        let [typed, resized] = waits.map(|wait| !wait.revents().is_empty());
        let mut events = if typed { self.read_keys()? } else { Vec::new() };
        if resized {
            let mut signals = [0; 64];
            while matches!(self.sizes.read(&mut signals), Ok(1..)) {}
            let (columns, rows) = terminal::size()?;
            events.push(Event::Resize(columns, rows));
        }
        Ok(events)
    }

    fn read_keys(&mut self) -> io::Result<Vec<Event>> {
        let mut bytes = [0; 4096];
        match rustix::io::read(&self.keys, &mut bytes) {
            Ok(0) => Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(count) => Ok(self.decoder.take(bytes.get(..count).unwrap_or_default())),
            Err(Errno::INTR | Errno::AGAIN) => Ok(Vec::new()),
            Err(error) => Err(error.into()),
        }
    }
}

/// Waits for events and passes them on; false where there is nothing more to wait for.
fn listen(ears: &mut Ears, keys: &KeyMap, stop: &dyn StopHandle, heard: &Sender<Heard>) -> bool {
    let Ok(events) = ears.listen() else {
        // Nobody is left to tell where the receiver is gone too.
        let _ = heard.send(Heard::Lost);
        return false;
    };
    if events.iter().any(|event| is_stop(keys, event)) {
        stop.stop();
    }
    events.into_iter().all(|event| heard.send(Heard::Event(event)).is_ok())
}

/// True for an emergency stop, whatever is on the screen.
pub(super) fn is_stop(keys: &KeyMap, event: &Event) -> bool {
    let Event::Key(key) = event else { return false };
    key.kind != KeyEventKind::Release && Chord::from_event(*key).is_some_and(|chord| keys.stop(chord).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
    use std::collections::BTreeMap;

    #[test]
    fn space_and_control_c_stop_and_letters_do_not() {
        let keys = KeyMap::new(&BTreeMap::new()).unwrap();
        let key = |code, modifiers| Event::Key(KeyEvent::new(code, modifiers));
        assert!(is_stop(&keys, &key(KeyCode::Char(' '), KeyModifiers::NONE)));
        assert!(is_stop(&keys, &key(KeyCode::Char(' '), KeyModifiers::SHIFT)));
        assert!(is_stop(&keys, &key(KeyCode::Char('c'), KeyModifiers::CONTROL)));
        assert!(!is_stop(&keys, &key(KeyCode::Char('c'), KeyModifiers::NONE)));
        assert!(!is_stop(&keys, &Event::Resize(1, 1)));
    }
}
