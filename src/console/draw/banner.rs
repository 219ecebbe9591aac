//! The stop: requested, confirmed by the robot, or not confirmed; the red button beside it; and what a PC cannot promise.

use super::Scene;
use crate::assembly::{RedButton, RobotState, StopSource};
use crate::console::theme::Role;
use crate::console::widgets::text::{clock, line, put, seconds};
use crate::snapshot::{Snapshot, StopPhase};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// The stop state in one word and one sentence.
pub(super) struct StopState {
    pub(super) role: Role,
    pub(super) word: String,
    pub(super) headline: String,
}

/// The red button in words.
const fn button_words(button: RedButton) -> &'static str {
    match button {
        RedButton::Unpressed => "not pressed",
        RedButton::Pressed => "PRESSED",
        RedButton::Unknown => "not known",
        RedButton::Released => "released, stop still latched",
    }
}

const fn source_words(source: StopSource) -> &'static str {
    match source {
        StopSource::None => "nothing",
        StopSource::User => "the red button",
        StopSource::Unknown => "software or unknown",
        StopSource::Fault => "a joint's fault",
        StopSource::Brain => "the motor controller lost its computer",
    }
}

/// The red button, as far as the robot has said lately.
pub(in crate::console) fn button(snapshot: &Snapshot) -> &'static str {
    snapshot.robot.fresh(snapshot.now).map_or("not known", |robot| button_words(robot.button))
}

/// The robot's state in words, and its role.
pub(in crate::console) fn robot_words(scene: &Scene<'_>) -> (String, Role) {
    let glyphs = scene.look.glyphs();
    match scene.live.robot.fresh(scene.live.now) {
        None if scene.live.robot.state.is_some() => (format!("{} ROBOT STATE STALE", glyphs.stale), Role::Stale),
        None => (format!("{} NO ROBOT", glyphs.stale), Role::Stale),
        Some(robot) => robot_state_words(robot, scene),
    }
}

fn robot_state_words(robot: &RobotState, scene: &Scene<'_>) -> (String, Role) {
    let glyphs = scene.look.glyphs();
    if robot.error {
        (format!("{} ROBOT FAULT", glyphs.fault), Role::Fault)
    } else if robot.stopped {
        (format!("{} STOPPED", glyphs.stopped), Role::Stop)
    } else if robot.enabled && robot.ready == Some(false) {
        (format!("{} ENABLED, NOT HOMED", glyphs.late), Role::Late)
    } else if robot.enabled {
        (format!("{} ENABLED", glyphs.good), Role::Good)
    } else {
        (format!("{} DISABLED", glyphs.late), Role::Late)
    }
}

/// What is to be said of the stop now.
pub(super) fn stop_state(scene: &Scene<'_>) -> StopState {
    let (live, glyphs) = (scene.live, scene.look.glyphs());
    let waited = live.stop.requested_at.map(|requested| live.now.since(requested).as_secs_f64());
    let waited = waited.map_or_else(String::new, seconds);
    let state = |role, word: String, headline: String| StopState { role, word, headline };
    let stopped = format!("{} STOP", glyphs.stopped);
    match live.stop.phase(live.now) {
        StopPhase::NotConfirmed => state(
            Role::Stop,
            format!("{} STOP NOT CONFIRMED", glyphs.fault),
            format!("NOT CONFIRMED after {waited}: PRESS THE RED BUTTON"),
        ),
        StopPhase::Reset => {
            let enabled = live.robot.fresh(live.now).is_some_and(|robot| robot.enabled);
            let left = if enabled { "Start is left" } else { "Enable and Start are left" };
            state(Role::Late, format!("{} STOP RESET", glyphs.late), format!("nothing moves: {left}"))
        }
        StopPhase::Requested => state(Role::Stop, stopped, format!("requested {waited} ago, not confirmed yet")),
        StopPhase::Confirmed => {
            let took =
                live.stop.confirmation_seconds().map_or_else(String::new, |took| format!(" after {}", seconds(took)));
            state(Role::Stop, stopped, format!("confirmed by the robot{took}"))
        }
        StopPhase::Clear => match live.robot.fresh(live.now) {
            Some(robot) if robot.stopped => {
                state(Role::Stop, stopped, format!("the robot is stopped by {}", source_words(robot.source)))
            }
            Some(_) => state(Role::Good, format!("{} not stopped", glyphs.good), "not stopped".into()),
            None => {
                let word = format!("{} stop state not known", glyphs.stale);
                state(Role::Stale, word, "stop state not known: the robot's state is not fresh".into())
            }
        },
    }
}

/// Draws the banner and returns how many rows it took: one while nothing is stopped.
pub(super) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) -> u16 {
    let state = stop_state(scene);
    let key = scene.keys.first_key(crate::console::Action::Stop);
    let red = button(scene.live);
    if state.role != Role::Stop {
        let text = if scene.live.stop.is_reset {
            format!("{} · {} · {key}: STOP · red button {red}", state.word, state.headline)
        } else if area.width < 70 {
            // In forty columns the button's state must not be cut off: its name alone could be taken for "pressed".
            format!("{} · {key}: STOP · button {red}", state.word)
        } else if area.width < 100 {
            format!("{} · {key}: EMERGENCY STOP (software) · red button: {red}", state.word)
        } else {
            format!("{} · {key}: EMERGENCY STOP (software), not safety-rated · red button: {red}", state.word)
        };
        put(buffer, area, 0, &line(scene.look, state.role, text));
        return 1;
    }
    let rows = stop_rows(scene, &state, area.width, red);
    let mut taken = 0;
    for text in rows {
        let width = usize::from(area.width);
        put(buffer, area, taken, &line(scene.look, Role::Stop, format!("{text:<width$}")));
        taken += 1;
    }
    taken
}

/// What a stop says, the most important first, in as many words as the terminal has room for.
fn stop_rows(scene: &Scene<'_>, state: &StopState, width: u16, red: &str) -> [String; 3] {
    let stop = &scene.live.stop;
    let asked = stop.requested_at.map_or_else(String::new, |at| format!(" · requested {}", clock(at)));
    let sent = stop.sent_at.zip(stop.requested_at).map(|(sent, asked)| seconds(sent.since(asked).as_secs_f64()));
    let sent = sent.map_or_else(String::new, |sent| format!(" · sent after {sent}"));
    let cause = if stop.cause.is_empty() { "not known" } else { stop.cause.as_str() };
    let (word, headline) = (&state.word, &state.headline);
    if width < 70 {
        return [
            format!("{word} {headline}"),
            format!(" red button: {red} · cause: {cause}"),
            " By software: not safety-rated.".into(),
        ];
    }
    if width < 100 {
        let asked = stop.requested_at.map_or_else(String::new, |at| format!(" · {}", clock(at)));
        return [
            format!("{word}: EMERGENCY STOP (software) {headline}"),
            format!(" red button: {red}{asked}{sent} · cause: {cause}"),
            " No software on a PC is safety-rated: the red button is.".into(),
        ];
    }
    [
        format!("{word}: EMERGENCY STOP (software) {headline}"),
        format!(" red button: {red}{asked}{sent} · cause: {cause}"),
        " No software on a PC is safety-rated: the red button is. Reset, Enable and Start are three acts.".into(),
    ]
}
