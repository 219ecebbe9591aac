//! How long a frame takes, from the snapshot to the last byte for the terminal: for `valet bench console`.

use super::fixture::{Situation, fixture};
use super::keymap::{KeyMap, Screen};
use super::theme::Look;
use super::view::ViewState;
use super::{KeyMapError, Scene, ThemeName, draw};
use ratatui::backend::CrosstermBackend;
use ratatui::layout::Rect;
use ratatui::{Terminal, TerminalOptions, Viewport};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::rc::Rc;
use std::time::{Duration, Instant};

/// A full screen of the largest tier.
const AREA: Rect = Rect { x: 0, y: 0, width: 120, height: 40 };

/// How long the frames of one screen took.
#[derive(Clone, Debug)]
pub struct FrameTimes {
    /// The screen's name.
    pub screen: &'static str,
    /// One time a frame, the shortest first.
    pub sorted: Vec<Duration>,
    /// Bytes of the last frame.
    pub bytes: usize,
}

/// Takes everything and counts it.
#[derive(Clone, Debug, Default)]
struct Counter(Rc<Cell<usize>>);

impl Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.set(self.0.get() + bytes.len());
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Draws every screen `frames` times at 120 x 40 with both arms at full rate. Every frame is written whole, as after a
/// change of screens: the worst case.
///
/// # Errors
/// Where the default key table has a conflict, which its own tests rule out.
pub fn frame_times(frames: usize) -> Result<Vec<FrameTimes>, KeyMapError> {
    let keys = KeyMap::new(&BTreeMap::new())?;
    let snapshot = fixture(Situation::Live);
    let look = Look { theme: ThemeName::Terminal, ascii: false };
    let of_screen = |screen: Screen| {
        let view = ViewState { screen, size: (AREA.width, AREA.height), span: 60.0, ..ViewState::default() };
        let scene = Scene { live: &snapshot, view: &view, look, keys: &keys };
        // Memory takes everything: no frame can fail.
        times_of(&scene, frames).unwrap_or(FrameTimes { screen: screen.name(), sorted: Vec::new(), bytes: 0 })
    };
    Ok(Screen::ALL.map(of_screen).to_vec())
}

fn times_of(scene: &Scene<'_>, frames: usize) -> io::Result<FrameTimes> {
    let counter = Counter::default();
    let backend = CrosstermBackend::new(counter.clone());
    let mut terminal = Terminal::with_options(backend, TerminalOptions { viewport: Viewport::Fixed(AREA) })?;
    let mut sorted = Vec::with_capacity(frames);
    let mut bytes = 0;
    for _ in 0..frames {
        terminal.draw(|_| ())?;
        counter.0.set(0);
        let began = Instant::now();
        terminal.draw(|frame| draw(scene, AREA, frame.buffer_mut()))?;
        sorted.push(began.elapsed());
        bytes = counter.0.get();
    }
    sorted.sort_unstable();
    Ok(FrameTimes { screen: scene.view.screen.name(), sorted, bytes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_screen_is_measured_and_writes_something() {
        let times = frame_times(3).unwrap();
        assert_eq!(times.len(), Screen::ALL.len());
        assert!(times.iter().all(|times| times.sorted.len() == 3 && times.bytes > 1000), "{times:?}");
    }
}
