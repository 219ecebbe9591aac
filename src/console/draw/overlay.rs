//! What lies on top of a screen: questions, lists, fields, settings and help.

use super::{Scene, refusal};
use crate::console::dialog::{Dialog, TextPurpose};
use crate::console::keymap::{Entry, TABLE};
use crate::console::theme::Role;
use crate::console::widgets::text::{fill, line, span, wrap};
use crate::snapshot::SettingView;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::symbols::border;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Clear, Widget};

const ASCII_BORDER: border::Set<'static> = border::Set {
    top_left: "+",
    top_right: "+",
    bottom_left: "+",
    bottom_right: "+",
    vertical_left: "|",
    vertical_right: "|",
    horizontal_top: "-",
    horizontal_bottom: "-",
};

/// Draws the open dialog, if there is one.
pub(super) fn draw(scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let Some(dialog) = &scene.view.dialog else { return };
    let width = area
        .width
        .saturating_sub(4)
        .clamp(20, if matches!(dialog, Dialog::Help { .. } | Dialog::Choice { .. }) { 116 } else { 72 });
    let inner = width.saturating_sub(4);
    let (title, lines) = contents(scene, dialog, inner);
    // State line and first row of the banner stay in sight.
    let most = area.height.saturating_sub(3);
    let height = u16::try_from(lines.len()).unwrap_or(u16::MAX).saturating_add(2).min(most);
    let frame = Rect {
        x: area.x + area.width.saturating_sub(width) / 2,
        y: area.y + 2 + area.height.saturating_sub(2 + height) / 2,
        width,
        height,
    }
    .intersection(area);
    Clear.render(frame, buffer);
    let look = scene.look;
    let set = if look.ascii { ASCII_BORDER } else { border::PLAIN };
    let block =
        Block::bordered().border_set(set).border_style(look.style(Role::Title)).title(span(look, Role::Title, title));
    let room = block.inner(frame);
    block.render(frame, buffer);
    let room = Rect { x: room.x + 1, width: room.width.saturating_sub(2), ..room };
    let skipped = scroll(dialog, lines.len(), room.height);
    fill(buffer, room, lines.into_iter().skip(skipped));
}

/// Lines to leave out at the top so that what is selected is in sight.
fn scroll(dialog: &Dialog, lines: usize, height: u16) -> usize {
    let height = usize::from(height);
    let last = lines.saturating_sub(height);
    match dialog {
        Dialog::Help { row, .. } => (*row).min(last),
        Dialog::Choice { selected, .. } | Dialog::Settings { selected } => {
            (selected + 3).saturating_sub(height).min(last)
        }
        _ => 0,
    }
}

fn contents<'a>(scene: &Scene<'a>, dialog: &'a Dialog, width: u16) -> (String, Vec<Line<'a>>) {
    match dialog {
        Dialog::Confirm { question, moves, yes, .. } => {
            (" Confirm ".into(), confirm(scene, question, moves, *yes, width))
        }
        Dialog::Quit { after_stop, yes } => {
            (" Leave ".into(), confirm(scene, quit_question(*after_stop), QUIT_MOVES, *yes, width))
        }
        Dialog::TypedWord { question, word, typed, .. } => {
            (" Confirm ".into(), typed_word(scene, question, word, typed, width))
        }
        Dialog::Choice { title, items, selected } => {
            let row = |(index, item): (usize, &'a crate::console::dialog::ChoiceItem)| {
                let role = if index == *selected { Role::Focus } else { Role::Text };
                let able = if item.command.is_some() { Role::Muted } else { Role::Late };
                let refused = if item.command.is_some() { "" } else { "not now: " };
                Line::from(vec![
                    span(scene.look, role, format!(" {:<14}", item.name)),
                    span(scene.look, able, format!(" {refused}{}", item.note)),
                ])
            };
            let mut lines: Vec<_> = items.iter().enumerate().map(row).collect();
            // What is cut off in the list stands whole below it.
            let cut = items.get(*selected).filter(|item| item.note.chars().count() + 26 > usize::from(width));
            lines.extend(cut.into_iter().flat_map(|item| wrapped(scene, Role::Text, &item.note, width)));
            if items.is_empty() {
                lines.push(line(scene.look, Role::Late, "nothing to choose from"));
            }
            lines.push(line(scene.look, Role::Muted, "up and down choose, enter takes, esc leaves"));
            (format!(" {title} "), lines)
        }
        Dialog::Text { purpose, typed } => (" Text ".into(), text_field(scene, *purpose, typed)),
        Dialog::Settings { selected } => (" Settings ".into(), settings(scene, *selected)),
        Dialog::Help { filter, typing, .. } => {
            (format!(" Keys: {} ", scene.view.screen.name()), help(scene, filter, *typing, width))
        }
    }
}

const QUIT_MOVES: &str = "nothing moves: the arms hold where they are";

const fn quit_question(after_stop: bool) -> &'static str {
    if after_stop {
        "The robot was told to stop. Leave the console? The same key again leaves at once."
    } else {
        "A trial runs and holds. Leave the console?"
    }
}

fn wrapped<'a>(scene: &Scene<'a>, role: Role, text: &str, width: u16) -> Vec<Line<'a>> {
    wrap(text, width).into_iter().map(|text| line(scene.look, role, text)).collect()
}

fn confirm<'a>(scene: &Scene<'a>, question: &str, moves: &str, yes: bool, width: u16) -> Vec<Line<'a>> {
    let mut lines = wrapped(scene, Role::Title, question, width);
    if !moves.is_empty() {
        lines.extend(wrapped(scene, Role::Late, &format!("Moves: {moves}"), width));
    }
    let focus = |focused: bool| if focused { Role::Focus } else { Role::Muted };
    lines.push(Line::default());
    lines.push(Line::from(vec![
        span(scene.look, focus(!yes), if yes { "  No  " } else { "[ No ]" }),
        Span::raw("   "),
        span(scene.look, focus(yes), if yes { "[ Yes ]" } else { "  Yes  " }),
    ]));
    lines.push(line(scene.look, Role::Muted, "y or tab, then enter: yes; enter or esc: no"));
    lines
}

fn typed_word<'a>(scene: &Scene<'a>, question: &str, word: &str, typed: &str, width: u16) -> Vec<Line<'a>> {
    let mut lines = wrapped(scene, Role::Title, question, width);
    lines.push(Line::default());
    lines.push(line(scene.look, Role::Text, format!("type {word} and enter: {typed}_")));
    lines.push(line(scene.look, Role::Muted, "esc: no"));
    lines
}

fn text_field<'a>(scene: &Scene<'a>, purpose: TextPurpose, typed: &'a str) -> Vec<Line<'a>> {
    let (name, hint) = match purpose {
        TextPurpose::Note => ("note", "type _ for a space (Space stops the robot); enter writes, esc leaves"),
        TextPurpose::Filter => ("filter", "enter filters, esc clears; Space stops the robot"),
    };
    vec![
        Line::from(vec![
            span(scene.look, Role::Title, format!("{name}: ")),
            span(scene.look, Role::Text, format!("{typed}_")),
        ]),
        line(scene.look, Role::Muted, hint),
    ]
}

fn settings<'a>(scene: &Scene<'a>, selected: usize) -> Vec<Line<'a>> {
    let rows = &scene.live.settings;
    let selected = selected.min(rows.len().saturating_sub(1));
    let row = |(index, setting): (usize, &'a SettingView)| {
        let role = if index == selected { Role::Focus } else { Role::Text };
        let (least, most) = setting.limits;
        let previous = setting.previous.map_or_else(String::new, |previous| format!(" was {previous:.3}"));
        Line::from(vec![
            span(scene.look, role, format!(" {:<26}{:>9.3} {:<4}", setting.name, setting.value, setting.unit)),
            span(scene.look, Role::Muted, format!(" {least} to {most}")),
            span(scene.look, Role::Late, previous),
        ])
    };
    let mut lines: Vec<_> = rows.iter().enumerate().map(row).collect();
    if rows.is_empty() {
        lines.push(line(scene.look, Role::Late, "no setting can be changed now"));
    }
    lines.push(line(scene.look, Role::Muted, "left and right change, u undoes, enter or esc leaves"));
    lines
}

/// Columns of the keys in the help.
const KEY_WIDTH: u16 = 13;

/// The key table, the keys of this screen first.
fn help<'a>(scene: &Scene<'a>, filter: &str, typing: bool, width: u16) -> Vec<Line<'a>> {
    let screen = scene.view.screen;
    let found = |entry: &&Entry| {
        let wanted = filter.to_lowercase();
        entry.text.to_lowercase().contains(&wanted) || entry.name.contains(&wanted)
    };
    let entries: Vec<&Entry> = TABLE.iter().filter(found).collect();
    let mut lines = vec![if typing || !filter.is_empty() {
        line(scene.look, Role::Late, format!("search: {filter}_ ({} found; esc clears)", entries.len()))
    } else {
        line(scene.look, Role::Muted, "up and down scroll, / searches, esc closes")
    }];
    let own = |entry: &&&Entry| entry.scope.contains(screen) && entry.scope.words() != "everywhere";
    let everywhere = |entry: &&&Entry| entry.scope.words() == "everywhere";
    let elsewhere = |entry: &&&Entry| !entry.scope.contains(screen);
    push_group(scene, &mut lines, "on this screen", entries.iter().filter(own), width);
    push_group(scene, &mut lines, "everywhere", entries.iter().filter(everywhere), width);
    push_group(scene, &mut lines, "on other screens", entries.iter().filter(elsewhere), width);
    lines
}

fn push_group<'a, 'b>(
    scene: &Scene<'a>,
    lines: &mut Vec<Line<'a>>,
    name: &'static str,
    entries: impl Iterator<Item = &'b &'b Entry>,
    width: u16,
) {
    let mut rows = entries.peekable();
    if rows.peek().is_some() {
        lines.push(line(scene.look, Role::Title, name));
    }
    for entry in rows {
        let keys = scene.keys.keys_of(entry.action).join(" ");
        let place = if name == "on other screens" { format!(" [{}]", entry.scope.words()) } else { String::new() };
        let guard = if entry.guard.words().is_empty() { String::new() } else { format!(" ({})", entry.guard.words()) };
        let not_now = refusal(entry.action, scene.live).map_or_else(String::new, |reason| format!("now: {reason}"));
        let room = width.saturating_sub(KEY_WIDTH).max(1);
        let rows = wrap(&format!("{}{guard}{place}", entry.text), room).into_iter().map(|text| (Role::Text, text));
        let reasons = wrap(&not_now, room).into_iter().filter(|text| !text.is_empty()).map(|text| (Role::Late, text));
        for (index, (role, text)) in rows.chain(reasons).enumerate() {
            let keys = if index == 0 { keys.as_str() } else { "" };
            let keys = format!(" {keys:<width$}", width = usize::from(KEY_WIDTH) - 1);
            lines.push(Line::from(vec![span(scene.look, Role::Key, keys), span(scene.look, role, text)]));
        }
    }
}
