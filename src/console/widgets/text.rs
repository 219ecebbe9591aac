//! Text that cannot leave its place, and numbers, ages and sizes as the operator reads them.

use crate::console::theme::{Look, Role};
use crate::snapshot::Freshness;
use crate::time::Stamp;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

/// Puts a line on a row of an area; rows outside it are left out.
pub(in crate::console) fn put(buffer: &mut Buffer, area: Rect, row: u16, line: &Line<'_>) {
    let area = area.intersection(buffer.area);
    if row < area.height {
        buffer.set_line(area.x, area.y + row, line, area.width);
    }
}

/// Puts lines into an area, the first at its top.
pub(in crate::console) fn fill<'a>(buffer: &mut Buffer, area: Rect, lines: impl IntoIterator<Item = Line<'a>>) {
    for (row, line) in (0..area.height).zip(lines) {
        put(buffer, area, row, &line);
    }
}

/// A piece of text in a role.
pub(in crate::console) fn span<'a>(look: Look, role: Role, text: impl Into<std::borrow::Cow<'a, str>>) -> Span<'a> {
    Span::styled(text, look.style(role))
}

/// A whole line in a role.
pub(in crate::console) fn line<'a>(look: Look, role: Role, text: impl Into<std::borrow::Cow<'a, str>>) -> Line<'a> {
    Line::from(span(look, role, text))
}

/// A heading, cut off by the end of the area.
pub(in crate::console) fn title<'a>(look: Look, text: impl Into<std::borrow::Cow<'a, str>>) -> Line<'a> {
    line(look, Role::Title, text)
}

/// Breaks a text into lines of at most `width` columns, at spaces where it can.
pub(in crate::console) fn wrap(text: &str, width: u16) -> Vec<String> {
    let width = usize::from(width.max(1));
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let taken = lines.last().map_or(0, |line| line.chars().count());
        let room = if taken == 0 { width } else { width.saturating_sub(taken + 1) };
        if word.chars().count() > room && taken > 0 {
            lines.push(String::new());
        }
        if let Some(last) = lines.last_mut() {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}

/// A span of time in seconds, as in "12 ms" or "1.2 s".
pub(in crate::console) fn seconds(value: f64) -> String {
    if value < 0.0995 {
        format!("{:.0} ms", value * 1000.0)
    } else if value < 9.95 {
        format!("{value:.1} s")
    } else if value < 99.5 {
        format!("{value:.0} s")
    } else if value < 5999.5 {
        format!("{:.0} min", value / 60.0)
    } else {
        format!("{:.0} h", value / 3600.0)
    }
}

/// The age of a value: how old, and whether that is too old.
pub(in crate::console) fn age(freshness: &Freshness, now: Stamp, none: &str) -> String {
    freshness.age(now).map_or_else(|| none.to_owned(), seconds)
}

/// What stands in the place of a value that is not fresh.
pub(in crate::console) fn stale(freshness: &Freshness, now: Stamp, none: &str) -> String {
    match freshness.age(now) {
        Some(age) => format!("{none} STALE {}", seconds(age)),
        None => format!("{none} none yet"),
    }
}

/// The time of day, UTC.
pub(in crate::console) fn clock(stamp: Stamp) -> String {
    let seconds = stamp.nanoseconds() / 1_000_000_000 % 86_400;
    format!("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

/// A number of bytes.
pub(in crate::console) fn bytes(count: u64) -> String {
    let count = count as f64;
    if count < 1e6 {
        format!("{:.0} kB", count / 1e3)
    } else if count < 1e9 {
        format!("{:.1} MB", count / 1e6)
    } else {
        format!("{:.1} GB", count / 1e9)
    }
}

/// A bar of `width` columns that is full to a share from 0 to 1.
pub(in crate::console) fn bar(look: Look, share: f64, width: usize) -> String {
    let glyphs = look.glyphs();
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    // Only counts of columns are rounded here, which are small and not negative.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a small width")]
    let full = (share * width as f64).round() as usize;
    (0..width).map(|column| if column < full { glyphs.full } else { glyphs.hollow }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn spans_of_time_read_as_people_say_them() {
        for (value, text) in [(0.012, "12 ms"), (0.0996, "0.1 s"), (1.24, "1.2 s"), (120.0, "2 min"), (7200.0, "2 h")] {
            assert_eq!(seconds(value), text);
        }
    }

    #[test]
    fn a_value_that_never_came_is_not_an_old_one() {
        let never = Freshness::default();
        assert_eq!(stale(&never, Stamp::ZERO, "-"), "- none yet");
        let old = Freshness { last: Some(Stamp::ZERO), deadline: 0.05 };
        assert_eq!(stale(&old, Stamp::from_nanoseconds(1_200_000_000), "-"), "- STALE 1.2 s");
    }

    proptest! {
        #[test]
        fn text_stays_in_its_place(x in 0_u16..20, y in 0_u16..20, width in 0_u16..30, height in 0_u16..30, row in 0_u16..40) {
            let mut buffer = Buffer::empty(Rect::new(0, 0, 12, 5));
            put(&mut buffer, Rect::new(x, y, width, height), row, &Line::from("resistance → 5.0 N"));
            let inside = Rect::new(x, y, width, height).intersection(buffer.area);
            for (index, cell) in buffer.content.iter().enumerate() {
                let (column, line) = buffer.pos_of(index);
                let there = inside.contains((column, line).into());
                prop_assert!(there || cell.symbol() == " ");
            }
        }

        #[test]
        fn wrapping_keeps_every_word(text in "[a-z ]{0,80}", width in 1_u16..40) {
            let lines = wrap(&text, width);
            let words: Vec<&str> = text.split_whitespace().collect();
            let kept = lines.join(" ");
            prop_assert_eq!(kept.split_whitespace().collect::<Vec<_>>(), words);
        }

        #[test]
        fn a_bar_has_its_width(share in proptest::num::f64::ANY, width in 0_usize..50) {
            let look = Look { theme: crate::console::ThemeName::Mono, ascii: true };
            prop_assert_eq!(bar(look, share, width).chars().count(), width);
        }
    }
}
