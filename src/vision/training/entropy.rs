//! n log2 n, which all entropies of counts are made of: looked up for small counts, of which training meets billions.

use std::sync::LazyLock;

/// Counts below this are looked up.
const KNOWN: u32 = 1 << 13;

static TABLE: LazyLock<Vec<f64>> = LazyLock::new(|| (0..KNOWN).map(computed).collect());

/// n times the binary logarithm of n; 0 for none.
#[inline]
pub(super) fn n_log_n(count: u32) -> f64 {
    TABLE.get(count as usize).copied().unwrap_or_else(|| computed(count))
}

fn computed(count: u32) -> f64 {
    let count = f64::from(count);
    if count > 0.0 { count * count.log2() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_looked_up_is_what_is_computed() {
        for count in [0, 1, 2, 3, 100, KNOWN - 1, KNOWN, KNOWN + 1, 1_500_000] {
            assert_eq!(n_log_n(count).to_bits(), computed(count).to_bits());
        }
        assert!((n_log_n(8) - 24.0).abs() < 1e-12);
    }
}
