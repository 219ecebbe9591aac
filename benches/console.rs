//! How long one frame of 120 x 40 takes: each screen with both arms at full rate, drawn anew every time.
//!
//! Run with `cargo bench --bench console`. Criterion prints the mean with its interval; `valet bench console` prints percentiles of frames
//! as a terminal gets them.

#![allow(clippy::expect_used, reason = "a bench may fail loudly")]

use criterion::{Criterion, criterion_group, criterion_main};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::collections::BTreeMap;
use std::hint::black_box;
use valet::console::{KeyMap, Look, Scene, Screen, Situation, ThemeName, ViewState, draw, fixture};

/// A full screen of the largest tier.
const AREA: Rect = Rect { x: 0, y: 0, width: 120, height: 40 };

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
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
