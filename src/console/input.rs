//! The thread that reads keys: stop keys go to the latch before anything else sees them.
//!
//! It shares nothing with the drawing: a terminal that takes no more output, a slow frame or a full queue do not delay
//! a stop.

use super::StopHandle;
use super::keymap::{Chord, KeyMap};
use crossbeam_channel::Sender;
use ratatui::crossterm::event::{self, Event, KeyEventKind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How often the thread looks whether it should end, while no key comes.
const PATIENCE: Duration = Duration::from_millis(100);

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
        let body = move || {
            while !told_to_leave.load(Ordering::Relaxed) {
                if let Some(newest) = renewals.try_iter().last() {
                    keys = newest;
                }
                if told_to_pause.load(Ordering::Relaxed) {
                    thread::sleep(PATIENCE);
                } else if !listen(&keys, stop.as_ref(), &heard) {
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
        // On a terminal that is gone, crossterm's reading never returns: such a thread is left to end with the process.
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

/// Waits for one event and passes it on; false where there is nothing more to wait for.
fn listen(keys: &KeyMap, stop: &dyn StopHandle, heard: &Sender<Heard>) -> bool {
    let event = match event::poll(PATIENCE) {
        Ok(false) => return true,
        Ok(true) => event::read(),
        Err(error) => Err(error),
    };
    match event {
        Ok(event) => {
            if is_stop(keys, &event) {
                stop.stop();
            }
            heard.send(Heard::Event(event)).is_ok()
        }
        Err(error) if error.kind() == std::io::ErrorKind::Interrupted => true,
        Err(_) => {
            // Nobody is left to tell where the receiver is gone too.
            let _ = heard.send(Heard::Lost);
            false
        }
    }
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
