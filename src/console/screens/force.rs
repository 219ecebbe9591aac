//! Force of both arms: raw at the left, as the detector sees it at the right, per axis and combined.

use crate::body::Side;
use crate::console::draw::Scene;
use crate::console::theme::Role;
use crate::console::view::Tier;
use crate::console::widgets::envelope::{Envelope, SERIES, Window};
use crate::console::widgets::strip::{LABEL_WIDTH, Strip, round_scale};
use crate::console::widgets::text::{age, put, seconds, span, stale};
use crate::snapshot::{ForceSample, ForceView, Snapshot};
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

/// The force deadline of the robot's 100 Hz samples, in seconds, where the snapshot names none.
const USUAL_GAP: f64 = 0.05;
/// The least scale of the raw plots in newtons.
const LEAST_SCALE: f64 = 5.0;

/// Which half of the screen.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Raw,
    Detector,
}

/// Draws the screen: on a wide terminal both arms with four series each, else the focused arm with four and the other
/// with its combined one.
pub(in crate::console) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let focused = scene.view.side;
    let shares = Side::BOTH.map(|side| {
        let wide = scene.view.tier() == Tier::Wide;
        if wide || side == focused { Constraint::Fill(if wide { 1 } else { 3 }) } else { Constraint::Fill(1) }
    });
    let areas: [Rect; 2] = Layout::vertical(shares).areas(area);
    for (side, area) in Side::BOTH.into_iter().zip(areas) {
        draw_arm(scene, side, area, buffer);
    }
}

fn draw_arm(scene: &Scene<'_>, side: Side, area: Rect, buffer: &mut Buffer) {
    put(buffer, area, 0, &heading(scene, side));
    let body = Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area };
    let [raw, detector] = Layout::horizontal([Constraint::Fill(1), Constraint::Fill(1)]).spacing(1).areas(body);
    draw_kind(scene, side, Kind::Raw, raw, buffer);
    draw_kind(scene, side, Kind::Detector, detector, buffer);
}

fn heading<'a>(scene: &Scene<'a>, side: Side) -> Line<'a> {
    let (look, live) = (scene.look, scene.live);
    let force = &live.sides.get(side).force;
    let role = if side == scene.view.side { Role::Focus } else { Role::Title };
    let window = if force.window.filled < force.window.length {
        format!("fills {}/{}", force.window.filled, force.window.length)
    } else {
        format!("full {}", force.window.length)
    };
    let broken = if force.window.broken.is_empty() { String::new() } else { format!(", last {}", force.window.broken) };
    let tare = if force.tare.is_some() { "" } else { " · not tared" };
    // What must not be cut off stands first: whether the force lives at all.
    let mut spans = vec![
        span(look, role, format!(" {side} gripper ")),
        span(look, Role::Muted, format!("raw {} ", seconds(scene.view.span))),
    ];
    if force.freshness.is_fresh(live.now) {
        spans.push(span(look, Role::Muted, format!("· age {:<5}", age(&force.freshness, live.now, "-"))));
    } else {
        let text = format!(" {} ", stale(&force.freshness, live.now, look.glyphs().none));
        spans.push(span(look, Role::Stale, text));
    }
    spans.push(selected_mark(scene, side, force));
    spans.push(span(look, Role::Text, format!(" | {}, {window}{tare}{broken}", force.window.detector)));
    Line::from(spans)
}

fn selected_mark<'a>(scene: &Scene<'a>, side: Side, force: &ForceView) -> ratatui::text::Span<'a> {
    let shown = &scene.shown().sides.get(side).force;
    let mark = scene.view.mark.filter(|_| side == scene.view.side);
    let Some(detection) = mark.and_then(|mark| shown.detections.iter().rev().nth(mark)) else {
        return span(scene.look, Role::Muted, format!(" · {} found", force.detections.len()));
    };
    let waypoint = detection.waypoint.map_or_else(String::new, |index| format!(" at way-point {index}"));
    let text =
        format!(" · {:.1} N in iteration {}{waypoint}, enter: its line", detection.magnitude, detection.iteration);
    span(scene.look, Role::Resistance, text)
}

fn draw_kind(scene: &Scene<'_>, side: Side, kind: Kind, area: Rect, buffer: &mut Buffer) {
    let (shown, live) = (scene.shown(), scene.live);
    let force = &shown.sides.get(side).force;
    let series = chosen_series(area.height);
    let Some(height) = area.height.checked_div(u16::try_from(series.len()).unwrap_or(1)).filter(|height| *height > 0)
    else {
        return;
    };
    let columns = usize::from(area.width.saturating_sub(LABEL_WIDTH)) * 2;
    let gap = if force.freshness.deadline > 0.0 { force.freshness.deadline } else { USUAL_GAP };
    let window = Window { now: shown.now, span: scene.view.span, columns, gap };
    let envelope = Envelope::new(force.samples.iter().rev(), window, |sample| values(kind, sample));
    let marks = marks(scene, force, &envelope, side);
    let scale = scale(scene, kind, force, &envelope);
    for (row, index) in series.iter().enumerate() {
        let combined = *index == SERIES - 1;
        let strip = Strip {
            name: name(kind, *index),
            value: live_value(live, side, kind, *index),
            envelope: &envelope,
            series: *index,
            threshold: (kind == Kind::Detector).then_some(force.window.threshold),
            scale,
            floor: if combined && envelope.least(*index) >= 0.0 { 0.0 } else { -scale },
            marks: if combined { &marks } else { &[] },
        };
        let place = Rect { y: area.y + height * u16::try_from(row).unwrap_or(0), height, ..area };
        strip.draw(scene.look, place, buffer);
    }
}

/// All four series where each gets two rows, else the combined one.
const fn chosen_series(height: u16) -> &'static [usize] {
    if height >= 8 { &[0, 1, 2, 3] } else { &[3] }
}

const fn name(kind: Kind, series: usize) -> &'static str {
    match (kind, series) {
        (Kind::Raw, 0) => "x",
        (Kind::Raw, 1) => "y",
        (Kind::Raw, 2) => "z",
        (Kind::Raw, _) => "|F|",
        (Kind::Detector, 0) => "dx",
        (Kind::Detector, 1) => "dy",
        (Kind::Detector, 2) => "dz",
        (Kind::Detector, _) => "dF",
    }
}

fn values(kind: Kind, sample: &ForceSample) -> [Option<f64>; SERIES] {
    match kind {
        Kind::Raw => {
            let [x, y, z] = sample.force;
            [Some(x), Some(y), Some(z), Some(sample.magnitude())]
        }
        Kind::Detector => {
            let [x, y, z] = sample.change.map_or([None; 3], |change| change.map(Some));
            [x, y, z, sample.statistic]
        }
    }
}

/// The newest value, or what stands in its place: numbers are live even where the plot is frozen.
fn live_value(live: &Snapshot, side: Side, kind: Kind, series: usize) -> Result<f64, String> {
    let force = &live.sides.get(side).force;
    let Some(sample) = force.fresh_sample(live.now) else {
        return Err(force
            .freshness
            .age(live.now)
            .map_or_else(|| "none yet".into(), |age| format!("  STALE {}", seconds(age))));
    };
    let value = values(kind, sample).get(series).copied().flatten();
    value.ok_or_else(|| "  fills".into())
}

fn scale(scene: &Scene<'_>, kind: Kind, force: &ForceView, envelope: &Envelope) -> f64 {
    let threshold = force.window.threshold * 1.2;
    let most = force.margins.last().map_or(LEAST_SCALE, |margin| margin.limit);
    match (kind, scene.view.fixed_scale) {
        (Kind::Raw, true) => round_scale(most),
        (Kind::Detector, true) => round_scale(threshold.max(LEAST_SCALE) * 2.0),
        (_, false) => round_scale(envelope.largest().max(threshold).max(LEAST_SCALE)),
    }
}

fn marks(scene: &Scene<'_>, force: &ForceView, envelope: &Envelope, side: Side) -> Vec<(i64, bool)> {
    let newest_first = force.detections.iter().rev().enumerate();
    newest_first
        .map(|(index, detection)| {
            let selected = side == scene.view.side && scene.view.mark == Some(index);
            (envelope.index(detection.stamp), selected)
        })
        .take_while(|(column, _)| *column >= 0)
        .collect()
}
