//! Numbers in messages.

/// A number with this many decimals, or with a power of ten where they would show too few digits of
/// it or too many.
pub fn plain(value: f64, decimals: usize) -> String {
    if value == 0.0 || (1e-2..1e6).contains(&value.abs()) {
        format!("{value:.decimals$}")
    } else {
        format!("{value:.decimals$e}")
    }
}
