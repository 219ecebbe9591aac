//! Reachability against comfort: every pass of every strategy along the focused arm as a point, and the front of those that
//! no other beats in both.

use crate::console::draw::Scene;
use crate::console::theme::Role;
use crate::console::widgets::text::{line, put, title};
use crate::snapshot::StrategyView;
use crate::strategy::StrategyKind;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Columns of the scale at the left.
const LABEL: u16 = 9;
/// Rows below which a plot says nothing.
const LEAST_ROWS: u16 = 5;

/// One pass of a strategy.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pass {
    kind: StrategyKind,
    /// Mean log density less the best possible: 0 is best.
    reach: f64,
    /// Sum of resistance in newtons: 0 is best.
    energy: f64,
}

impl Pass {
    /// True where `self` is at least as good in both and better in one.
    fn beats(&self, other: &Self) -> bool {
        let no_worse = self.reach >= other.reach && self.energy <= other.energy;
        no_worse && (self.reach > other.reach || self.energy < other.energy)
    }
}

/// The letter of a strategy: the key that chooses it, or its first letter.
pub(super) const fn letter(kind: StrategyKind) -> char {
    match kind {
        StrategyKind::Gmm => '3',
        StrategyKind::Force => '4',
        StrategyKind::Multimodal => '5',
        StrategyKind::Kernel => 'k',
        StrategyKind::OffsetField => 'o',
        StrategyKind::Blend => 'b',
    }
}

/// Draws the plot, where it has room.
pub(super) fn draw(scene: &Scene<'_>, strategies: &[StrategyView], area: Rect, buffer: &mut Buffer) {
    if area.height < LEAST_ROWS || area.width < 3 * LABEL {
        return;
    }
    let (look, side) = (scene.look, scene.view.side);
    put(buffer, area, 0, &title(look, format!("Reachability against comfort, {side} arm: one mark a pass")));
    let passes = passes(scene, strategies);
    if passes.is_empty() {
        let text = "no pass of this arm yet, or no movement space to judge it by";
        put(buffer, area, 1, &line(look, Role::Muted, text));
        return;
    }
    let legend = "down: less resistance; right: more reachable; reverse: no other pass beats it";
    put(buffer, area, area.height - 1, &line(look, Role::Muted, legend));
    let most = passes.iter().map(|pass| pass.energy).fold(1.0, f64::max);
    let least = passes.iter().map(|pass| pass.reach).fold(-1.0, f64::min);
    put(buffer, area, 1, &line(look, Role::Muted, format!("{most:>5.1} N")));
    put(buffer, area, area.height - 2, &line(look, Role::Muted, format!("{:>5.1} N  {least:.1} .. 0", 0.0)));
    let plot = Rect { x: area.x + LABEL, y: area.y + 1, width: area.width - LABEL, height: area.height - 3 };
    for pass in &passes {
        let role = if passes.iter().any(|other| other.beats(pass)) { Role::Muted } else { Role::Focus };
        let place = (
            plot.x + share(1.0 - pass.reach / least, plot.width),
            plot.y + share(1.0 - pass.energy / most, plot.height),
        );
        if let Some(cell) = buffer.cell_mut(place) {
            cell.set_char(letter(pass.kind)).set_style(look.style(role));
        }
    }
}

fn passes(scene: &Scene<'_>, strategies: &[StrategyView]) -> Vec<Pass> {
    let rows = strategies.iter().flat_map(|strategy| strategy.rows.iter().map(move |row| (strategy.kind, row)));
    rows.filter(|(_, row)| row.side == scene.view.side)
        .flat_map(|(kind, row)| {
            row.energies.iter().zip(&row.reaches).map(move |(energy, reach)| (kind, *energy, *reach))
        })
        .filter_map(|(kind, energy, reach)| Some(Pass { kind, energy, reach: reach? }))
        .filter(|pass| pass.energy.is_finite() && pass.reach.is_finite())
        .collect()
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a small length")]
fn share(part: f64, length: u16) -> u16 {
    (part.clamp(0.0, 1.0) * f64::from(length.saturating_sub(1))).round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pass_is_beaten_only_by_one_that_is_no_worse_in_both() {
        let pass = |reach, energy| Pass { kind: StrategyKind::Force, reach, energy };
        assert!(pass(-1.0, 5.0).beats(&pass(-2.0, 5.0)));
        assert!(!pass(-1.0, 6.0).beats(&pass(-2.0, 5.0)), "more reachable, less comfortable");
        assert!(!pass(-1.0, 5.0).beats(&pass(-1.0, 5.0)), "the same");
    }
}
