//! From a snapshot and a view to a screen: the frame round every screen, by size.
//!
//! The stop state is the first thing drawn at every size. Drawing changes nothing.

mod banner;
mod overlay;

pub(super) use banner::{button, robot_words};

use super::app::{is_replay, refusal};
use super::keymap::{Action, Entry, KeyMap, Screen, TABLE};
use super::screens;
use super::theme::{Look, Role};
use super::view::{Tier, ViewState};
use super::widgets::text::{line, put, span};
use crate::body::Side;
use crate::snapshot::{Level, RecorderView, ReplayView, Snapshot, TrialPhase, Verdict, Watermark};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

/// Everything that a drawing depends on.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The newest snapshot.
    pub live: &'a Snapshot,
    /// What the operator looks at.
    pub view: &'a ViewState,
    /// Theme and glyphs.
    pub look: Look,
    /// The keys in force.
    pub keys: &'a KeyMap,
}

impl<'a> Scene<'a> {
    /// What plots, paths and log show: the frozen snapshot, or the live one.
    #[must_use]
    pub fn shown(&self) -> &'a Snapshot {
        self.view.shown(self.live)
    }
}

/// Draws the console into an area of any size.
pub fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let area = area.intersection(buffer.area);
    match Tier::of(area.width, area.height) {
        Tier::Line => draw_line(scene, area, buffer),
        Tier::Compact => {
            let body = draw_frame(scene, area, buffer);
            screens::compact::draw(scene, body, buffer);
            overlay::draw(scene, area, buffer);
        }
        Tier::Standard | Tier::Wide => {
            let body = draw_frame(scene, area, buffer);
            match scene.view.screen {
                Screen::Trial => screens::trial::draw(scene, body, buffer),
                Screen::Force => screens::force::draw(scene, body, buffer),
                Screen::Path => screens::path::draw(scene, body, buffer),
                Screen::Strategies => screens::strategies::draw(scene, body, buffer),
                Screen::Health => screens::health::draw(scene, body, buffer),
                Screen::Log => screens::log::draw(scene, body, buffer),
            }
            overlay::draw(scene, area, buffer);
        }
    }
    if scene.look.ascii {
        to_ascii(area, buffer);
    }
}

/// Replaces what is not ASCII: separators and arrows of ours by their likes, letters of a name by a question mark.
fn to_ascii(area: Rect, buffer: &mut Buffer) {
    for place in area.positions() {
        let Some(cell) = buffer.cell_mut(place) else { continue };
        if !cell.symbol().is_ascii() {
            let like = match cell.symbol() {
                "·" => "|",
                "→" => ">",
                "±" => "+",
                _ => "?",
            };
            cell.set_symbol(like);
        }
    }
}

/// One line: the stop state, then the trial, then what a dialog asks.
fn draw_line(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let state = banner::stop_state(scene);
    let mut spans = vec![span(scene.look, state.role, state.word.clone()), Span::raw(" ")];
    spans.push(span(scene.look, Role::Text, scene.live.trial.phase.words()));
    put(buffer, area, 0, &Line::from(spans));
    put(buffer, area, 1, &line(scene.look, state.role, state.headline));
    if scene.view.dialog.is_some() {
        put(buffer, area, 2, &line(scene.look, Role::Late, "a question is open: enlarge the terminal"));
    }
    put(buffer, area, 3, &line(scene.look, Role::Key, "Space: EMERGENCY STOP"));
}

/// Draws state line, stop banner, tabs, message and keys; returns what is left in the middle.
fn draw_frame(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) -> Rect {
    put(buffer, area, 0, &state_line(scene, area.width));
    let below = Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area };
    let taken = banner::draw(scene, below, buffer);
    let compact = Tier::of(area.width, area.height) == Tier::Compact;
    let tabs = u16::from(!compact);
    if !compact {
        put(buffer, area, 1 + taken, &tab_line(scene));
    }
    let bottom = area.height.saturating_sub(1);
    put(buffer, area, bottom, &key_line(scene, area.width));
    put(buffer, area, bottom.saturating_sub(1), &message_line(scene));
    let top = 1 + taken + tabs;
    Rect { y: area.y + top, height: area.height.saturating_sub(top + 2), ..area }
}

fn state_line<'a>(scene: &Scene<'a>, width: u16) -> Line<'a> {
    let (live, look) = (scene.live, scene.look);
    let dot = look.glyphs().dot;
    let narrow = width < 100;
    let mut spans = if narrow { Vec::new() } else { vec![span(look, Role::Title, "valet ")] };
    if let Some(word) = live.watermark.word() {
        spans.push(span(look, Role::Watermark, format!(" {word} ")));
        spans.push(Span::raw(" "));
    }
    if let Some(replay) = live.replay {
        spans.push(span(look, Role::Text, replay_words(replay)));
    }
    if let Some(silence) = scene.view.silence {
        let silence = super::widgets::text::seconds(silence);
        spans.push(span(look, Role::Fault, format!(" {} NO NEWS FROM THE CORE {silence} ", look.glyphs().fault)));
    }
    let robot = banner::robot_words(scene);
    spans.push(span(look, robot.1, robot.0));
    let mut fact = |text: String, role: Role| {
        spans.push(span(look, Role::Muted, format!(" {dot} ")));
        spans.push(span(look, role, text));
    };
    fact(
        live.trial.phase.words().into(),
        if live.trial.phase == TrialPhase::Holding { Role::Late } else { Role::Text },
    );
    if let Some(arm) = live.trial.arm {
        let side = live.sides.get(arm);
        let iteration = side.iterations.last();
        let number = iteration.map_or(0, |iteration| iteration.number);
        fact(format!("{arm} arm {number}/{}", side.iterations_maximum), Role::Text);
        if let Some(strategy) = live.trial.strategy {
            fact(strategy.name().into(), Role::Text);
        }
        if let Some(iteration) = iteration {
            fact(format!("{}{:.1} N", if narrow { "" } else { "energy " }, iteration.energy), Role::Text);
        }
    }
    let recorder = recorder_words(&live.recorder);
    fact(recorder.0.into(), recorder.1);
    let (worst, symbol, role) = worst_topic(scene);
    let silent = if narrow { String::new() } else { age_of_what_is_stale(scene) };
    fact(format!("{symbol} data {worst}{silent}"), role);
    if live.dropped_samples > 0 {
        fact(format!("{} dropped", live.dropped_samples), Role::Late);
    }
    Line::from(spans)
}

fn replay_words(replay: ReplayView) -> String {
    let state = if replay.paused { "paused" } else { "runs" };
    format!("{state} {:.1}/{:.1} s x{} ", replay.position, replay.length, replay.speed)
}

const fn recorder_words(recorder: &RecorderView) -> (&'static str, Role) {
    if !recorder.fault.is_empty() {
        ("REC FAULT", Role::Fault)
    } else if recorder.on {
        ("REC", Role::Good)
    } else {
        ("not recording", Role::Late)
    }
}

/// The worst of what the trial needs: master and topics.
fn worst_topic(scene: &Scene<'_>) -> (&'static str, char, Role) {
    let live = scene.live;
    let topics = live.topics.iter().filter(|topic| topic.required).map(|topic| topic.verdict(live.now));
    let master = if live.master.uri.is_empty() || live.master.connected { Verdict::Good } else { Verdict::Fault };
    let worst = topics.chain([master]).max().unwrap_or_default();
    let (symbol, role) = scene.look.verdict(worst);
    (verdict_word(worst), symbol, role)
}

/// For how long a topic that the trial needs has been silent, the longest of them, where one is stale.
fn age_of_what_is_stale(scene: &Scene<'_>) -> String {
    let live = scene.live;
    let stale = live.topics.iter().filter(|topic| topic.required && topic.verdict(live.now) >= Verdict::Stale);
    let oldest = stale.filter_map(|topic| topic.freshness.age(live.now)).reduce(f64::max);
    oldest.map_or_else(String::new, |age| format!(" {}", super::widgets::text::seconds(age)))
}

/// A verdict as a word.
pub(super) const fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Good => "LIVE",
        Verdict::Late => "LATE",
        Verdict::Stale => "STALE",
        Verdict::Fault => "FAULT",
    }
}

/// A verdict of the check-list as a word: what is to be looked at there need not be late.
pub(super) const fn check_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Late => "CHECK",
        other => verdict_word(other),
    }
}

fn tab_line<'a>(scene: &Scene<'a>) -> Line<'a> {
    let look = scene.look;
    let mut spans = Vec::new();
    for screen in Screen::ALL {
        let role = if screen == scene.view.screen { Role::Focus } else { Role::Muted };
        spans.push(span(look, role, tab_text(screen)));
        spans.push(Span::raw(" "));
    }
    if let Some(frozen) = &scene.view.frozen {
        let age = scene.live.now.since(frozen.now).as_secs_f64();
        let age = super::widgets::text::seconds(age);
        spans.push(span(look, Role::Stale, format!(" FROZEN {age} ago, f goes on ")));
    }
    if !scene.view.filter.is_empty() {
        spans.push(span(look, Role::Late, format!(" filter: {} ", scene.view.filter)));
    }
    Line::from(spans)
}

fn tab_text(screen: Screen) -> String {
    let action = match screen {
        Screen::Trial => "T",
        Screen::Force => "F",
        Screen::Path => "P",
        Screen::Strategies => "C",
        Screen::Health => "H",
        Screen::Log => "L",
    };
    format!(" {action} {} ", screen.name())
}

/// The screen whose tab lies at a place, where there is one.
pub(super) fn tab_at(column: u16, row: u16, size: (u16, u16)) -> Option<Screen> {
    if Tier::of(size.0, size.1) < Tier::Standard || !(2..=4).contains(&row) {
        return None;
    }
    let mut start = 0;
    Screen::ALL.into_iter().find(|screen| {
        let end = start + tab_text(*screen).len() + 1;
        let inside = (start..end).contains(&usize::from(column));
        start = end;
        inside
    })
}

/// The arm whose plots lie at a row of the force screen: the left one's above, the right one's below.
pub(super) fn arm_at(screen: Screen, row: u16, size: (u16, u16)) -> Option<Side> {
    const FRAME_ROWS: u16 = 3;
    if screen != Screen::Force || Tier::of(size.0, size.1) < Tier::Standard || row < FRAME_ROWS {
        return None;
    }
    Some(if row < size.1 / 2 { Side::Left } else { Side::Right })
}

/// What the console itself says of the last key, or else the newest of the core's answers and the log: what came of a sign
/// check, or why the trial holds, is seen on every screen.
fn message_line<'a>(scene: &Scene<'a>) -> Line<'a> {
    if let Some(message) = &scene.view.message {
        return line(scene.look, if message.refused { Role::Late } else { Role::Text }, message.text.as_str());
    }
    let (answer, news) = (scene.live.receipts.last(), scene.live.log.last());
    let news = news.filter(|news| news.level > Level::Debug && answer.is_none_or(|answer| news.stamp > answer.stamp));
    let (stamp, text, is_grave) = match (news, answer) {
        (Some(news), _) => (news.stamp, format!("{}: {}", news.source, news.text), news.level > Level::Information),
        (None, Some(answer)) => (answer.stamp, answer.receipt.to_string(), !answer.receipt.is_accepted()),
        (None, None) => return Line::default(),
    };
    let role = if is_grave { Role::Late } else { Role::Muted };
    line(scene.look, role, format!("{} {text}", super::widgets::text::clock(stamp)))
}

/// The keys that are valid on this screen now; what cannot be done stands behind them with its reason.
fn key_line<'a>(scene: &Scene<'a>, width: u16) -> Line<'a> {
    let look = scene.look;
    let mut spans = Vec::new();
    let mut taken = 0;
    let hint = |action: Action| {
        format!("{} {}", scene.keys.first_key(Action::Help), action.entry().map_or("", |entry| entry.short))
    };
    let reserve = hint(Action::Help).len() + 1;
    let replays = scene.live.watermark == Watermark::Replay;
    let belongs = |entry: &&Entry| !entry.short.is_empty() && entry.scope.contains(scene.view.screen);
    let entries = TABLE.iter().filter(belongs).filter(|entry| replays || !is_replay(entry.action));
    let (able, unable): (Vec<&Entry>, Vec<&Entry>) =
        entries.partition(|entry: &&Entry| refusal(entry.action, scene.live).is_none());
    let shown = able.into_iter().map(|entry: &Entry| (entry, None));
    let hidden = unable.into_iter().map(|entry| (entry, refusal(entry.action, scene.live)));
    for (entry, reason) in shown.chain(hidden).filter(|(entry, _)| entry.action != Action::Help) {
        let key = scene.keys.first_key(entry.action);
        let text = reason.map_or_else(|| format!(" {} ", entry.short), |reason| format!(" {}: {reason} ", entry.short));
        let length = key.chars().count() + text.chars().count();
        if taken + length + reserve > usize::from(width) {
            continue;
        }
        taken += length;
        spans.push(span(look, if reason.is_some() { Role::Muted } else { Role::Key }, key));
        spans.push(span(look, Role::Muted, text));
    }
    spans.push(span(look, Role::Key, hint(Action::Help)));
    Line::from(spans)
}
