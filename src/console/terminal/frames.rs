//! From one frame to the next: what the terminal shows, and what is drawn into the frame that follows.
//!
//! Never takes or gives back the terminal.

use ratatui::Terminal;
use ratatui::backend::Backend;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// What the terminal shows, and a buffer to draw the next frame into.
#[derive(Debug, Default)]
pub(super) struct Frames {
    shown: Buffer,
    next: Buffer,
}

impl Frames {
    /// Forgets what is on the terminal, so that the next frame is another one.
    pub(super) fn forget(&mut self) {
        self.shown = Buffer::default();
    }

    /// Draws the next frame for a terminal of this size; false where it is the one that is shown already.
    pub(super) fn prepare(&mut self, area: Rect, render: &impl Fn(Rect, &mut Buffer)) -> bool {
        self.next.resize(area);
        self.next.reset();
        render(area, &mut self.next);
        self.next != self.shown
    }

    /// Sends the frame that was prepared. A terminal that has another size by now gets a frame of that size: whoever drags a
    /// window's corner changes it between any two steps of the program.
    ///
    /// # Errors
    /// What the terminal answers.
    pub(super) fn send<B: Backend>(
        &mut self,
        screen: &mut Terminal<B>,
        render: &impl Fn(Rect, &mut Buffer),
    ) -> Result<(), B::Error> {
        let sent = screen.draw(|frame| {
            if frame.area() != self.next.area {
                self.prepare(frame.area(), render);
            }
            frame.buffer_mut().clone_from(&self.next);
        });
        sent.map(|_| std::mem::swap(&mut self.shown, &mut self.next))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::backend::TestBackend;

    fn fill(area: Rect, buffer: &mut Buffer) {
        buffer.set_string(0, 0, "x".repeat(area.width.into()), ratatui::style::Style::default());
    }

    #[test]
    fn a_terminal_that_changes_its_size_while_a_frame_is_drawn_gets_one_of_its_new_size() {
        for (columns, rows) in [(7, 3), (3, 5), (1, 1), (5, 2)] {
            let mut screen = Terminal::new(TestBackend::new(5, 2)).unwrap();
            let mut frames = Frames::default();
            assert!(frames.prepare(Rect::new(0, 0, 5, 2), &fill));
            screen.backend_mut().resize(columns, rows);
            frames.send(&mut screen, &fill).unwrap();
            let mut expected = Buffer::empty(Rect::new(0, 0, columns, rows));
            fill(expected.area, &mut expected);
            screen.backend().assert_buffer(&expected);
            assert!(!frames.prepare(expected.area, &fill), "it is shown already");
        }
    }

    #[test]
    fn a_frame_that_was_forgotten_is_drawn_again() {
        let mut screen = Terminal::new(TestBackend::new(5, 2)).unwrap();
        let mut frames = Frames::default();
        frames.prepare(Rect::new(0, 0, 5, 2), &fill);
        frames.send(&mut screen, &fill).unwrap();
        assert!(!frames.prepare(Rect::new(0, 0, 5, 2), &fill));
        frames.forget();
        assert!(frames.prepare(Rect::new(0, 0, 5, 2), &fill));
    }
}
