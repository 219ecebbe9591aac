//! Whether everything lives: the check-list, master, robot, red button, recorder and disk, and every topic, worst first.

use crate::console::draw::{Scene, button, check_word, robot_words, verdict_word};
use crate::console::theme::Role;
use crate::console::widgets::text::{age, bytes, fill, line, seconds, span, title};
use crate::snapshot::{DiagnosisView, TopicHealth, Verdict};
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

/// Bytes below which the disk is said to be nearly full: about ten minutes with depth images.
const LITTLE_DISK: u64 = 5_000_000_000;

/// Seconds between a message's own stamp and its arrival above which the computers' clocks, or the way, deserve a look.
const MUCH_LAG: f64 = 0.1;

/// Draws the screen.
pub(in crate::console) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let checks = check_lines(scene);
    let count = u16::try_from(checks.len()).unwrap_or(0).min(area.height / 3);
    let told = diagnosis_lines(scene);
    let told_count = u16::try_from(told.len()).unwrap_or(u16::MAX).min(area.height / 4);
    let [links, list, topics, others] = Layout::vertical([
        Constraint::Length(5),
        Constraint::Length(if count == 0 { 0 } else { count + 1 }),
        Constraint::Fill(1),
        Constraint::Length(told_count),
    ])
    .areas(area);
    fill(buffer, links, link_lines(scene));
    fill(buffer, list, std::iter::once(title(scene.look, "Check-list")).chain(checks));
    fill(buffer, topics, topic_lines(scene, topics.width));
    fill(buffer, others, told);
}

/// What other nodes say of themselves on `/diagnostics`: how many are well, and those that are not, the worst first. Nothing
/// where nobody says anything.
fn diagnosis_lines<'a>(scene: &Scene<'a>) -> Vec<Line<'a>> {
    let (live, look) = (scene.live, scene.look);
    if live.diagnoses.is_empty() {
        return Vec::new();
    }
    let mut unwell: Vec<_> = live.diagnoses.iter().filter(|told| told.verdict(live.now) != Verdict::Good).collect();
    unwell.sort_by_key(|told| std::cmp::Reverse(told.verdict(live.now)));
    let all = live.diagnoses.len();
    let heading = format!("Diagnostics of other nodes: {} of {all} well", all - unwell.len());
    let row = |told: &'a DiagnosisView| {
        let verdict = told.verdict(live.now);
        let (symbol, role) = look.verdict(verdict);
        let word = if verdict == Verdict::Late { "WARN" } else { verdict_word(verdict) };
        let age = match verdict {
            Verdict::Stale => format!(" ({} old)", seconds(live.now.distance(told.heard).as_secs_f64())),
            _ => String::new(),
        };
        Line::from(vec![
            span(look, role, format!("{symbol} {word:<6}")),
            span(look, Role::Text, format!("{}: {}{age}", told.name, told.text)),
        ])
    };
    std::iter::once(title(look, heading)).chain(unwell.into_iter().map(row)).collect()
}

/// The check-list, one line each.
pub(super) fn check_lines<'a>(scene: &Scene<'a>) -> Vec<Line<'a>> {
    let look = scene.look;
    let line = |check: &'a crate::snapshot::CheckLine| {
        let (symbol, role) = look.verdict(check.verdict);
        let age = check.age.map_or_else(String::new, |age| format!(" ({} old)", seconds(age)));
        let hint = if check.verdict == Verdict::Good || check.hint.is_empty() {
            String::new()
        } else {
            format!(" {} {}", look.glyphs().arrow, check.hint)
        };
        Line::from(vec![
            span(look, role, format!("{symbol} {:<6}", check_word(check.verdict))),
            span(look, Role::Text, format!("{:<20} {}{age}", check.name, check.value)),
            span(look, Role::Late, hint),
        ])
    };
    scene.live.checks.iter().map(line).collect()
}

fn link_lines<'a>(scene: &Scene<'a>) -> Vec<Line<'a>> {
    let (live, look, glyphs) = (scene.live, scene.look, scene.look.glyphs());
    let master = match (live.master.uri.is_empty(), live.master.connected) {
        (true, _) => (format!("{} none: this run needs no master", glyphs.good), Role::Muted),
        (false, true) => (format!("{} LIVE {} {}", glyphs.good, live.master.uri, live.master.text), Role::Good),
        (false, false) => (format!("{} FAULT {} {}", glyphs.fault, live.master.uri, live.master.text), Role::Fault),
    };
    let recorder = recorder_line(scene);
    let row = |name: &'static str, (text, role): (String, Role)| {
        Line::from(vec![span(look, Role::Title, format!("{name:<11}")), span(look, role, text)])
    };
    let pressed = live.robot.fresh(live.now).is_some_and(|robot| robot.button == crate::assembly::RedButton::Pressed);
    vec![
        row("master", master),
        row("robot", robot_words(scene)),
        row(
            "red button",
            (format!("{} (the safety-rated stop)", button(live)), if pressed { Role::Stop } else { Role::Text }),
        ),
        row("recorder", recorder),
    ]
}

fn recorder_line(scene: &Scene<'_>) -> (String, Role) {
    let (recorder, glyphs) = (&scene.live.recorder, scene.look.glyphs());
    let disk = recorder.disk_free.map_or_else(String::new, |free| format!(" · {} free", bytes(free)));
    let drops = if recorder.drops > 0 { format!(" · {} events lost", recorder.drops) } else { String::new() };
    let little = recorder.disk_free.is_some_and(|free| free < LITTLE_DISK);
    if !recorder.fault.is_empty() {
        (format!("{} FAULT {}{disk}", glyphs.fault, recorder.fault), Role::Fault)
    } else if recorder.on {
        let role = if little || recorder.drops > 0 { Role::Late } else { Role::Good };
        let symbol = if role == Role::Late { glyphs.late } else { glyphs.good };
        (format!("{symbol} ON {}{drops}{disk} · {}", bytes(recorder.bytes), recorder.file), role)
    } else {
        (format!("{} OFF{disk}", glyphs.late), Role::Late)
    }
}

fn topic_lines<'a>(scene: &Scene<'a>, width: u16) -> Vec<Line<'a>> {
    let (live, look) = (scene.live, scene.look);
    let mut topics: Vec<&TopicHealth> = live.topics.iter().filter(|topic| scene.view.passes(&topic.name)).collect();
    // What is not there and not needed troubles nobody: it stands last.
    topics.sort_by_key(|topic| (topic.is_absent(), std::cmp::Reverse(topic.verdict(live.now))));
    let heading = format!("Topics: {} of {}, worst first", topics.len(), live.topics.len());
    let mut lines = vec![title(look, heading)];
    let columns = format!(
        "{:<8}{:<44}{:<4}{:>5} {:>7} {:>5} {:>5} {:>6} {:>6} {:>5}",
        "state", "topic", "need", "Hz", "band", "age", "gap", "jitter", "lag", "drops"
    );
    lines.push(line(look, Role::Muted, if width >= 112 { format!("{columns} publisher") } else { columns }));
    let skipped = scene.view.row.min(topics.len().saturating_sub(1));
    lines.extend(topics.into_iter().skip(skipped).map(|topic| topic_line(scene, topic)));
    lines
}

fn topic_line<'a>(scene: &Scene<'a>, topic: &TopicHealth) -> Line<'a> {
    let (look, now) = (scene.look, scene.live.now);
    let verdict = topic.verdict(now);
    let none = look.glyphs().none;
    let (symbol, role) = if topic.is_absent() { (look.glyphs().stale, Role::Muted) } else { look.verdict(verdict) };
    let word = if topic.is_absent() { "none" } else { verdict_word(verdict) };
    let live = verdict < Verdict::Stale;
    let lag = topic.stamp_lag.map_or_else(|| none.to_owned(), signed_seconds);
    let is_late = topic.stamp_lag.is_some_and(|lag| lag.abs() > MUCH_LAG);
    let number = |text: String| if live { text } else { none.to_owned() };
    let publishers = if topic.publishers.is_empty() { "nobody".into() } else { topic.publishers.join(" ") };
    let needed = if topic.required { "yes" } else { "no" };
    Line::from(vec![
        span(look, role, format!("{symbol} {word:<6}")),
        span(look, Role::Text, format!("{:<44}{needed:<4}", topic.name)),
        span(look, Role::Text, format!("{:>5} {:>7} ", number(format!("{:.1}", topic.rate)), expected(topic))),
        span(look, role, format!("{:>5}", age(&topic.freshness, now, none))),
        span(look, Role::Text, format!(" {:>5} {:>6}", number(seconds(topic.gap)), number(seconds(topic.jitter)))),
        span(look, if is_late { Role::Late } else { Role::Text }, format!(" {:>6}", number(lag))),
        span(look, if topic.drops > 0 { Role::Late } else { Role::Muted }, format!(" {:>5}", topic.drops)),
        span(look, Role::Muted, format!(" {publishers}")),
    ])
}

/// A span of time that may lie ahead, as a stamp of a clock that goes before ours.
fn signed_seconds(value: f64) -> String {
    if value < 0.0 { format!("-{}", seconds(-value)) } else { seconds(value) }
}

/// The rates that are expected, in words where any rate is right.
fn expected(topic: &TopicHealth) -> String {
    match topic.expected {
        (least, most) if least <= 0.0 && most.is_infinite() => "any".into(),
        (least, most) => format!("{least:.0}..{most:.0}"),
    }
}
