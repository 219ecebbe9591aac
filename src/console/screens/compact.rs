//! What is left on a small terminal: force numbers of both arms, the step, what comes next.

use super::trial::{force_words, margin_line, now_lines, step_words};
use crate::body::Side;
use crate::console::draw::Scene;
use crate::console::theme::Role;
use crate::console::widgets::text::{fill, line};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Draws the screen.
pub(in crate::console) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let mut lines = Vec::new();
    for side in Side::BOTH {
        lines.push(force_words(scene, side));
        lines.push(margin_line(scene, side));
    }
    lines.push(line(scene.look, Role::Text, step_words(scene)));
    lines.extend(now_lines(scene, area.width));
    fill(buffer, area, lines);
}
