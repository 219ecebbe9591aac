//! Steps, resistance, holds and stops of a trial on one time axis, a row for each side.

use crate::body::Side;
use crate::console::draw::Scene;
use crate::console::theme::Role;
use crate::console::widgets::text::{put, seconds, span};
use crate::snapshot::{TimelineEvent, TimelineKind};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Seconds that the axis shows: about one iteration with what led to it.
const SPAN: f64 = 60.0;
const LABEL: u16 = 7;

/// Draws the axis: heading, then one row for each side.
pub(super) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let look = scene.look;
    let mark = look.glyphs().mark;
    let heading =
        format!("{}: 1-6 step, i iteration, {mark} resistance, h hold, c continue, S stop, ? stale", seconds(SPAN));
    put(buffer, area, 0, &Line::from(span(look, Role::Title, heading)));
    for (row, side) in (1..).zip(Side::BOTH) {
        put(buffer, area, row, &axis(scene, side, area.width));
    }
}

fn axis<'a>(scene: &Scene<'a>, side: Side, width: u16) -> Line<'a> {
    let shown = scene.shown();
    let columns = usize::from(width.saturating_sub(LABEL));
    let mut cells = vec![(scene.look.glyphs().dash, Role::Muted); columns];
    for event in shown.timeline.iter().rev() {
        let age = shown.now.since(event.stamp).as_secs_f64();
        if age > SPAN {
            break;
        }
        if event.side.is_some_and(|other| other != side) {
            continue;
        }
        if let Some(cell) = column(age, columns).and_then(|column| cells.get_mut(column)) {
            *cell = glyph(scene, event);
        }
    }
    let mut spans = vec![span(scene.look, Role::Muted, format!("{side:<6} "))];
    spans.extend(cells.into_iter().map(|(glyph, role)| span(scene.look, role, glyph.to_string())));
    Line::from(spans)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a small width")]
fn column(age: f64, columns: usize) -> Option<usize> {
    let last = columns.checked_sub(1)?;
    Some(((1.0 - (age / SPAN).clamp(0.0, 1.0)) * last as f64).round() as usize)
}

fn glyph(scene: &Scene<'_>, event: &TimelineEvent) -> (char, Role) {
    match event.kind {
        TimelineKind::Step(number) => (char::from_digit(number % 10, 10).unwrap_or('?'), Role::Text),
        TimelineKind::Iteration(_) => ('i', Role::Text),
        TimelineKind::Resistance => (scene.look.glyphs().mark, Role::Resistance),
        TimelineKind::Hold => ('h', Role::Late),
        TimelineKind::Continue => ('c', Role::Good),
        TimelineKind::Stop => ('S', Role::Stop),
        TimelineKind::Stale => ('?', Role::Stale),
    }
}
