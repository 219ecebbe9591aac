//! How often a pass of the garment may go on after force has held it: each time slower, and not for ever.
//!
//! Counts and judges; it never moves anything.

/// So often a pass goes on after force has held it; then the garment is to be withdrawn, or the trial given up (checklists of
/// dressing robots: retries are limited, at most three, and each is smaller).
const MOST: u32 = 3;
/// Each time at this share of the speed before (ours).
const SHARE: f64 = 0.5;

/// The present pass.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Retries {
    held: u32,
}

impl Retries {
    /// A pass begins.
    pub(super) const fn pass_begins(&mut self) {
        self.held = 0;
    }

    /// Force has held the pass, or stopped it.
    pub(super) const fn held_for_force(&mut self) {
        self.held = self.held.saturating_add(1);
    }

    /// Whether the pass may go on.
    ///
    /// # Errors
    /// The reason in words, and what to do instead.
    pub(super) fn check(self) -> Result<(), String> {
        if self.held > MOST {
            return Err(format!("force has held this pass {} times: withdraw the garment, or abort", self.held));
        }
        Ok(())
    }

    /// The share of a motion's own speed at which the pass goes on, in (0, 1].
    pub(super) fn ratio(self) -> f64 {
        (0..self.held.min(MOST)).fold(1.0, |ratio, _| ratio * SHARE)
    }

    /// What the log says when the pass goes on; empty where force has not held it.
    pub(super) fn words(self) -> String {
        match self.held {
            0 => String::new(),
            held => format!(
                " after force has held this pass ({held} of {MOST}), at {:.0} % of the speed",
                self.ratio() * 100.0
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_retry_is_slower_the_fourth_is_refused_and_a_new_pass_begins_anew() {
        let mut retries = Retries::default();
        let mut ratios = vec![retries.ratio()];
        assert!(retries.words().is_empty());
        for _ in 0..MOST {
            retries.held_for_force();
            retries.check().unwrap();
            ratios.push(retries.ratio());
        }
        assert_eq!(ratios, [1.0, 0.5, 0.25, 0.125]);
        assert!(retries.words().contains("3 of 3") && retries.words().contains("12 %"), "{}", retries.words());
        retries.held_for_force();
        assert!(retries.check().unwrap_err().contains("4 times"));
        assert!(retries.ratio() > 0.0, "a speed of nothing would never arrive");
        retries.pass_begins();
        retries.check().unwrap();
    }
}
