//! The trial: what the robot does, what moves next and why, the steps, both arms, the time axis.

use super::timeline;
use crate::body::Side;
use crate::console::draw::Scene;
use crate::console::theme::Role;
use crate::console::view::Tier;
use crate::console::widgets::text::{bar, clock, fill, line, span, stale, title, wrap};
use crate::snapshot::{ForceTier, IterationView, RunKeyView, StepRow, TrialPhase};
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

/// Draws the screen.
pub(in crate::console) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let wide = scene.view.tier() == Tier::Wide;
    // Before a trial the check-list needs the room, and there is nothing on the time axis.
    let heights = match (wide, scene.live.trial.phase == TrialPhase::Idle) {
        (true, false) => [6, 8, 12, 4, 0],
        (true, true) => [6, 8, 5, 0, 0],
        (false, false) => [5, 3, 7, 3, 0],
        (false, true) => [3, 3, 4, 0, 0],
    };
    let [now, steps, arms, time, rest] = Layout::vertical([
        Constraint::Length(heights[0]),
        Constraint::Length(heights[1]),
        Constraint::Length(heights[2]),
        Constraint::Length(heights[3]),
        Constraint::Min(heights[4]),
    ])
    .areas(area);
    fill(buffer, now, std::iter::once(title(scene.look, "Now")).chain(now_lines(scene, now.width)));
    fill(buffer, steps, step_lines(scene, wide));
    for (side, half) in Side::BOTH.into_iter().zip(halves(arms)) {
        fill(buffer, half, arm_lines(scene, side, half));
    }
    timeline::draw(scene, time, buffer);
    fill(buffer, rest, rest_lines(scene, rest.height));
}

fn halves(area: Rect) -> [Rect; 2] {
    Layout::horizontal([Constraint::Fill(1), Constraint::Fill(1)]).spacing(1).areas(area)
}

/// What the robot does, what it waits for, and what will move next and why.
pub(super) fn now_lines<'a>(scene: &Scene<'a>, width: u16) -> Vec<Line<'a>> {
    let (trial, look) = (&scene.live.trial, scene.look);
    let mut lines = Vec::new();
    let profile = format!(
        "{} · {} · profile {} · seed {}",
        trial.phase.words(),
        if trial.garment.is_empty() { "no garment" } else { &trial.garment },
        if trial.profile.is_empty() { "none" } else { &trial.profile },
        trial.seed,
    );
    lines.push(line(look, Role::Text, profile));
    if let Some(outcome) = trial.outcome {
        lines.push(line(look, Role::Title, format!("the trial is over: {}", outcome.words())));
    }
    let late = look.glyphs().late;
    for (words, text) in [("holds", &trial.hold_cause), ("waits for you", &trial.waiting_for)] {
        if !text.is_empty() {
            let rows = wrap(&format!("{late} {words}: {text}"), width);
            lines.extend(rows.into_iter().map(|row| line(look, Role::Late, row)));
        }
    }
    if trial.run_key != RunKeyView::NotNeeded {
        let key = scene.keys.first_key(crate::console::Action::Run);
        lines.push(line(look, Role::Late, format!("hold to run: the arms move only as long as {key} is held down")));
    }
    if let Some((strategy, when)) = &trial.strategy_pending {
        lines.push(line(look, Role::Late, format!("strategy {strategy} {when}")));
    }
    if let Some(movement) = &trial.movement {
        let text =
            format!("records the {} arm: {} poses, {:.0} s left", movement.side, movement.poses, movement.seconds_left);
        lines.push(line(look, Role::Late, text));
    }
    match &trial.next {
        Some(next) => {
            let arms: Vec<_> = next.arms.iter().map(|arm| arm.name()).collect();
            let text = format!("next: {} gripper {}, because {}", arms.join(" and "), next.what, next.why);
            lines.extend(wrap(&text, width).into_iter().map(|text| line(look, Role::Text, text)));
        }
        None => lines.push(line(look, Role::Muted, "next: nothing moves without you")),
    }
    lines
}

/// The step of each gripper in one line.
pub(super) fn step_words(scene: &Scene<'_>) -> String {
    let step = |side: Side| scene.live.trial.step.get(side).map_or_else(|| "-".into(), |step: u32| step.to_string());
    format!("step of table 3.1: left gripper {} · right gripper {}", step(Side::Left), step(Side::Right))
}

fn step_lines<'a>(scene: &Scene<'a>, wide: bool) -> Vec<Line<'a>> {
    let trial = &scene.live.trial;
    let heading = format!("    {:<36}{}", "left gripper (steps of table 3.1)", "right gripper");
    let mut lines = vec![title(scene.look, heading)];
    if trial.steps.is_empty() {
        lines.push(line(scene.look, Role::Muted, "no steps yet"));
    }
    let furthest = trial.step.left.max(trial.step.right).unwrap_or(1);
    let shown = trial.steps.iter().filter(|step| wide || step.number == furthest || step.number == furthest + 1);
    lines.extend(shown.map(|step| step_line(scene, step)));
    lines
}

fn step_line<'a>(scene: &Scene<'a>, step: &'a StepRow) -> Line<'a> {
    let cell = |side: Side| {
        let here = *scene.live.trial.step.get(side) == Some(step.number);
        let role = if here { Role::Focus } else { Role::Muted };
        let mark = if here { scene.look.glyphs().gripper } else { ' ' };
        span(scene.look, role, format!("{mark} {:<34}", step.goals.get(side)))
    };
    let mut spans = vec![span(scene.look, Role::Text, format!("{} ", step.number))];
    spans.extend(Side::BOTH.map(cell));
    Line::from(spans)
}

/// The force of an arm in one line: number, tier, margin.
pub(super) fn force_words<'a>(scene: &Scene<'a>, side: Side) -> Line<'a> {
    let (look, now) = (scene.look, scene.live.now);
    let force = &scene.live.sides.get(side).force;
    let mut spans = vec![span(look, Role::Title, format!("{side:<5} "))];
    match force.fresh_sample(now) {
        Some(sample) => {
            spans.push(span(look, Role::Text, format!("|F| {:>5.2} N", sample.magnitude())));
            let window = match sample.statistic {
                Some(statistic) => format!(" · window {statistic:>5.2}/{:.1} N", force.window.threshold),
                None => format!(" · window fills {}/{}", force.window.filled, force.window.length),
            };
            spans.push(span(look, Role::Muted, window));
        }
        None => spans.push(span(look, Role::Stale, stale(&force.freshness, now, look.glyphs().none))),
    }
    Line::from(spans)
}

pub(super) fn margin_line<'a>(scene: &Scene<'a>, side: Side) -> Line<'a> {
    let (look, force) = (scene.look, &scene.live.sides.get(side).force);
    let role = match force.tier {
        ForceTier::Normal => Role::Good,
        ForceTier::Advise | ForceTier::Slow => Role::Late,
        ForceTier::Pause | ForceTier::Stop => Role::Fault,
    };
    let symbol = if force.tier == ForceTier::Normal { look.glyphs().good } else { look.glyphs().late };
    let margin = match force.next_margin() {
        Some((tier, newtons)) => format!(" · {newtons:.1} N to {tier}"),
        None if force.margins.is_empty() => " · no limits known".into(),
        None => String::new(),
    };
    let cause = if force.tier_cause.is_empty() { String::new() } else { format!(" · {}", force.tier_cause) };
    Line::from(vec![
        span(look, role, format!("{symbol} {}", force.tier)),
        span(look, Role::Text, format!("{margin}{cause}")),
    ])
}

fn arm_lines<'a>(scene: &Scene<'a>, side: Side, area: Rect) -> Vec<Line<'a>> {
    let (look, view) = (scene.look, scene.live.sides.get(side));
    let focused = scene.live.trial.arm == Some(side);
    let name = span(look, if focused { Role::Focus } else { Role::Title }, format!(" {side} arm "));
    let progress = match view.progress {
        Some(share) => span(
            look,
            Role::Updated,
            format!(
                " hand {} shoulder {:>3.0} %",
                bar(look, share, if area.width < 50 { 6 } else { 12 }),
                share * 100.0
            ),
        ),
        None => span(look, Role::Muted, " no iteration runs"),
    };
    let mut lines = vec![Line::from(vec![name, progress]), force_words(scene, side), margin_line(scene, side)];
    let room = usize::from(area.height).saturating_sub(lines.len() + 1);
    let first = view.iterations.len().saturating_sub(room);
    let most = view.iterations.iter().map(|iteration| iteration.energy).fold(0.0, f64::max);
    let heading = format!(" n/{:<4}energy (sum), ends at 0 N", view.iterations_maximum);
    lines.push(line(look, Role::Muted, heading));
    let rows = view.iterations.iter().skip(first);
    lines.extend(rows.map(|iteration| iteration_line(scene, iteration, view.iterations_maximum, most)));
    lines
}

fn iteration_line<'a>(scene: &Scene<'a>, iteration: &IterationView, maximum: u32, most: f64) -> Line<'a> {
    let look = scene.look;
    let share = if most > 0.0 { iteration.energy / most } else { 0.0 };
    let state = if iteration.finished { " " } else { "runs" };
    Line::from(vec![
        span(look, Role::Text, format!("{:>2}/{maximum} {:>6.1} N ", iteration.number, iteration.energy)),
        span(look, Role::Curve, bar(look, share, 10)),
        span(
            look,
            Role::Muted,
            format!(" {:>2} res {:>5.1} s {} {state}", iteration.resistances, iteration.duration, iteration.strategy),
        ),
    ])
}

/// The check-list before a trial, the newest answers during one.
fn rest_lines<'a>(scene: &Scene<'a>, height: u16) -> Vec<Line<'a>> {
    let look = scene.look;
    if scene.live.trial.phase == TrialPhase::Idle {
        let mut lines = vec![title(look, "Before the first trial")];
        lines.extend(super::health::check_lines(scene));
        return lines;
    }
    let count = usize::from(height.saturating_sub(1));
    let mut lines = vec![title(look, "Answers")];
    let newest: Vec<_> = scene.live.receipts.iter().rev().take(count).collect();
    for answer in newest.into_iter().rev() {
        let role = if answer.receipt.is_accepted() { Role::Text } else { Role::Late };
        lines.push(line(look, role, format!("{} {}", clock(answer.stamp), answer.receipt)));
    }
    lines
}
