//! What happened: levels as words, filtered by level, source and text, following the newest line or standing still.

use crate::console::draw::Scene;
use crate::console::theme::Role;
use crate::console::widgets::text::{clock, fill, line, span, title, wrap};
use crate::snapshot::{Level, LogLine};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Columns before the text of a line: number, time, level and source.
const LABEL_WIDTH: u16 = 38;

/// Draws the screen.
pub(in crate::console) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let lines: Vec<&LogLine> = scene.view.log_lines(scene.shown()).collect();
    let last = lines.len().saturating_sub(1);
    let selected = if scene.view.follow { last } else { scene.view.row.min(last) };
    // A line that is cut off is shown whole below when it is selected.
    let room = usize::from(area.width.saturating_sub(LABEL_WIDTH));
    let cut = lines.get(selected).filter(|entry| entry.text.chars().count() > room);
    let whole = cut.map_or_else(Vec::new, |entry| wrap(&entry.text, area.width.saturating_sub(1).max(1)));
    let height = usize::from(area.height.saturating_sub(1)).saturating_sub(whole.len());
    let first = selected.saturating_sub(height.saturating_sub(1) / if scene.view.follow { 1 } else { 2 });
    let mut rows = vec![heading(scene, lines.len())];
    if lines.is_empty() {
        rows.push(line(scene.look, Role::Muted, "no lines to show"));
    }
    let shown = lines.iter().enumerate().skip(first).take(height);
    rows.extend(shown.map(|(index, entry)| log_line(scene, entry, index == selected)));
    rows.resize(height + 1, Line::default());
    rows.extend(whole.into_iter().map(|text| line(scene.look, Role::Focus, format!(" {text}"))));
    fill(buffer, area, rows);
}

fn heading<'a>(scene: &Scene<'a>, count: usize) -> Line<'a> {
    let log = &scene.view.log;
    let all = scene.shown().log.len();
    let mut text = format!("Log: {count} of {all} lines, {} and graver", log.minimum);
    if let Some(solo) = &log.solo {
        text += ", only ";
        text += solo;
    }
    if !log.muted.is_empty() {
        let muted: Vec<_> = log.muted.iter().map(String::as_str).collect();
        text += ", without ";
        text += &muted.join(" ");
    }
    if log.inverted && !scene.view.filter.is_empty() {
        text.push_str(", filter inverted");
    }
    text.push_str(if scene.view.follow { ", follows" } else { ", stands still: G follows" });
    title(scene.look, text)
}

fn log_line<'a>(scene: &Scene<'a>, entry: &'a LogLine, selected: bool) -> Line<'a> {
    let look = scene.look;
    let role = match entry.level {
        Level::Debug => Role::Muted,
        Level::Information => Role::Text,
        Level::Warning => Role::Late,
        Level::Error => Role::Fault,
    };
    let text = if selected { Role::Focus } else { Role::Text };
    Line::from(vec![
        span(look, Role::Muted, format!("{:>5} {} ", entry.id, clock(entry.stamp))),
        span(look, role, format!("{:<11}", entry.level)),
        span(look, Role::Muted, format!(" {:<10} ", entry.source)),
        span(look, text, entry.text.as_str()),
    ])
}
