//! Numbers as the report writes them.

use ancf_check::Outcome;

/// A number with as many decimals as `resolution` asks for.
pub fn at_resolution(value: f64, resolution: f64) -> String {
    let decimals = (-resolution.log10()).ceil();
    if value.abs() >= 1e7 || !(0.0..=16.0).contains(&decimals) {
        return format!("{value:.12e}").replace('-', "−");
    }
    let text = format!("{value:.*}", decimals as usize);
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        text.trim_start_matches('-').to_owned()
    } else {
        text.replace('-', "−")
    }
}

/// Two digits and a power of ten.
pub fn short(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}").replace('-', "−") }
}

/// A number with its sign and one decimal.
pub fn signed(value: f64) -> String {
    format!("{value:+.1}").replace('-', "−")
}

/// The limits of an error.
pub fn limits(outcome: &Outcome) -> String {
    let mut parts = Vec::new();
    parts.extend(outcome.verdict.allowed.map(|a| format!("≤ {}", short(a))));
    parts.extend(outcome.verdict.at_least.map(|a| format!("≥ {}", short(a))));
    if parts.is_empty() { "rate only".to_owned() } else { parts.join(", ") }
}

/// Decimal digits between an error and what is allowed.
pub fn margin(outcome: &Outcome) -> String {
    match outcome.margin() {
        Some(digits) => signed(digits),
        None if outcome.error == 0.0 => "∞".to_owned(),
        None => "–".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_count_and_a_true_minus() {
        assert_eq!(at_resolution(-0.123_456, 1e-3), "−0.123");
        assert_eq!(at_resolution(-1e-9, 1e-3), "0.000");
        assert_eq!((short(1.23e-4), short(0.0), signed(-0.26)), ("1.2e−4".into(), "0".into(), "−0.3".into()));
    }
}
