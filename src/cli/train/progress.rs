//! What a person sees on stderr while a forest is trained: how far it is, the time left, and the accuracy so far.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// Parts of the bar that stands for one tree.
const PARTS: u64 = 1000;

/// One bar; gone when it is dropped.
#[derive(Debug)]
pub(super) struct Bar(ProgressBar);

impl Bar {
    /// A bar over images.
    pub(super) fn of_images(what: &str, count: u64) -> Self {
        Self::new(count, "{spinner} {msg} [{bar:30}] {pos}/{len}, {eta} left", what.to_owned())
    }

    /// A bar over a tree's samples.
    pub(super) fn of_tree(number: u64, trees: u64) -> Self {
        let what = format!("tree {} of {trees}", number + 1);
        Self::new(PARTS, "{spinner} {msg} [{bar:30}] {percent} %, {elapsed} gone, {eta} left", what)
    }

    fn new(length: u64, template: &str, what: String) -> Self {
        let bar = ProgressBar::new(length);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(what);
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    pub(super) fn step(&self) {
        self.0.inc(1);
    }

    /// The share that is done.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a thousand")]
    pub(super) fn reach(&self, share: f64) {
        self.0.set_position((share.clamp(0.0, 1.0) * PARTS as f64) as u64);
    }

    /// Ends with the accuracy of the forest so far, where there was something to judge by.
    pub(super) fn finish(&self, accuracy: Option<f64>) {
        if let Some(share) = accuracy {
            self.0.set_message(format!("{:.1} % of pixels right", share * 100.0));
        }
        self.0.finish_and_clear();
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
