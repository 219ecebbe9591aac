//! The strategies side by side for this person: energy by iteration, reachability, comfort, and what a switch would do.

use super::front;
use crate::console::draw::Scene;
use crate::console::theme::Role;
use crate::console::widgets::text::{bar, fill, line, span, title, wrap};
use crate::snapshot::{StrategyRow, StrategyView};
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

/// How many strategies stand side by side.
const SHOWN: usize = 3;

/// Draws the screen.
pub(in crate::console) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let strategies = &scene.shown().strategies;
    if strategies.is_empty() {
        fill(buffer, area, [line(scene.look, Role::Muted, "nothing is known of any strategy for this person yet")]);
        return;
    }
    let first = scene.view.row.min(strategies.len().saturating_sub(SHOWN));
    let tall = strategies.iter().skip(first).take(SHOWN).map(height).max().unwrap_or(0);
    let [above, below] = Layout::vertical([Constraint::Length(tall), Constraint::Fill(1)]).areas(area);
    front::draw(scene, strategies, below, buffer);
    let columns: [Rect; SHOWN] = Layout::horizontal([Constraint::Fill(1); SHOWN]).spacing(1).areas(above);
    let most = strategies.iter().flat_map(energies).fold(0.0, f64::max);
    for (strategy, column) in strategies.iter().skip(first).zip(columns) {
        fill(buffer, column, strategy_lines(scene, strategy, column, most));
    }
}

/// Rows that a strategy takes: its heading, each arm, and what a switch would do in up to four lines.
fn height(strategy: &StrategyView) -> u16 {
    let rows: usize = strategy.rows.iter().map(|row| 3 + row.energies.len()).sum();
    u16::try_from(rows + 7).unwrap_or(u16::MAX)
}

fn energies(strategy: &StrategyView) -> impl Iterator<Item = f64> {
    strategy.rows.iter().flat_map(|row| row.energies.iter().copied())
}

fn strategy_lines<'a>(scene: &Scene<'a>, strategy: &'a StrategyView, area: Rect, most: f64) -> Vec<Line<'a>> {
    let look = scene.look;
    let works = scene.live.trial.strategy == Some(strategy.kind);
    let role = if works { Role::Focus } else { Role::Title };
    let state = if works { " at work " } else { "" };
    let origin = match (strategy.measured, energies(strategy).next().is_some()) {
        (true, _) => "measured in this trial",
        (false, true) => "from an earlier trial",
        (false, false) => "never run: path judged",
    };
    let mut lines = vec![
        Line::from(span(look, role, format!(" {} {}{state} ", front::letter(strategy.kind), strategy.kind))),
        line(look, if strategy.measured { Role::Good } else { Role::Muted }, origin),
    ];
    for row in &strategy.rows {
        lines.extend(row_lines(scene, row, area.width, most));
    }
    lines.push(title(look, "a switch now"));
    let (text, role) = match &strategy.refusal {
        Some(reason) => (format!("not now: {reason}"), Role::Late),
        None => (strategy.switch.clone(), Role::Text),
    };
    lines.extend(wrap(&text, area.width).into_iter().map(|text| line(look, role, text)));
    lines
}

fn row_lines<'a>(scene: &Scene<'a>, row: &StrategyRow, width: u16, most: f64) -> Vec<Line<'a>> {
    let look = scene.look;
    let number = |value: Option<f64>, unit: &str| {
        value.map_or_else(|| look.glyphs().none.to_owned(), |value| format!("{value:.2}{unit}"))
    };
    let share = row.inside.map_or_else(|| look.glyphs().none.to_owned(), |share| format!("{:.0} %", share * 100.0));
    let inside = if width < 34 { "in" } else { "inside" };
    let reach = format!("reach {} · {share} {inside} 95 %", number(row.reachability, ""));
    let left = |newtons: f64| format!("{newtons:.2} N left");
    let mut lines = vec![
        title(look, format!("{} arm", row.side)),
        line(look, Role::Text, reach),
        line(look, Role::Text, format!("comfort {}", row.comfort.map_or("not measured".into(), left))),
    ];
    let room = usize::from(width).saturating_sub(14).min(20);
    for (index, energy) in row.energies.iter().enumerate() {
        let full = if most > 0.0 { energy / most } else { 0.0 };
        lines.push(Line::from(vec![
            span(look, Role::Text, format!("{:>2} {energy:>6.1} N ", index + 1)),
            span(look, Role::Curve, bar(look, full, room)),
        ]));
    }
    lines
}
