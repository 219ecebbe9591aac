//! How long one frame of 120 x 40 takes: each screen with both arms at full rate, drawn anew every time.
//!
//! Run with `cargo bench --bench console`. Criterion prints the mean with its interval; the percentiles are printed here.

#![allow(clippy::expect_used, clippy::print_stdout, reason = "a bench may fail loudly, and prints")]

use criterion::{Criterion, criterion_group, criterion_main};
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::hint::black_box;
use std::io::{self, Write};
use std::rc::Rc;
use std::time::{Duration, Instant};
use valet::console::{KeyMap, Look, Scene, Screen, Situation, ThemeName, ViewState, draw, fixture};

/// A full screen of the largest tier.
const AREA: Rect = Rect { x: 0, y: 0, width: 120, height: 40 };
const FRAMES: usize = 5000;

fn percentile(sorted: &[Duration], share: f64) -> Duration {
    let index = (sorted.len().saturating_sub(1) as f64 * share).round();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index into a few thousand frames")]
    sorted.get(index as usize).copied().unwrap_or_default()
}

fn frames(criterion: &mut Criterion) {
    let snapshot = fixture(Situation::Live);
    let look = Look { theme: ThemeName::Terminal, ascii: false };
    let keys = KeyMap::new(&BTreeMap::new()).expect("the default table has no conflicts");
    for screen in Screen::ALL {
        let view = ViewState { screen, size: (AREA.width, AREA.height), span: 60.0, ..ViewState::default() };
        let scene = Scene { live: &snapshot, view: &view, look, keys: &keys };
        let mut buffer = Buffer::empty(AREA);
        criterion.bench_function(&format!("frame 120x40 {}", screen.name()), |bencher| {
            bencher.iter(|| {
                buffer.reset();
                draw(black_box(&scene), AREA, &mut buffer);
            });
        });
        percentiles(&scene, screen);
    }
}

/// Takes everything and counts it.
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

/// A frame as the terminal gets it: drawn, compared with the one before and written as escape codes into memory. Every
/// second frame is empty, so that each writes the whole screen: the worst case.
fn percentiles(scene: &Scene<'_>, screen: Screen) {
    let written = Rc::new(Cell::new(0));
    let mut terminal = Terminal::with_options(
        CrosstermBackend::new(Counter(Rc::clone(&written))),
        ratatui::TerminalOptions { viewport: ratatui::Viewport::Fixed(AREA) },
    )
    .expect("a terminal in memory");
    let mut times = Vec::with_capacity(FRAMES);
    let mut bytes = 0;
    for _ in 0..FRAMES {
        let start = Instant::now();
        let drawn = terminal.draw(|frame| draw(scene, AREA, frame.buffer_mut()));
        times.push(start.elapsed());
        black_box(drawn.expect("memory takes everything"));
        bytes = written.take();
        terminal.draw(|_| ()).expect("memory takes everything");
        written.set(0);
    }
    times.sort_unstable();
    println!(
        "frame 120x40 {}: median {:?}, 99th percentile {:?}, {bytes} bytes for a whole screen",
        screen.name(),
        percentile(&times, 0.5),
        percentile(&times, 0.99),
    );
}

criterion_group!(benches, frames);
criterion_main!(benches);
