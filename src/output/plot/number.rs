//! Numbers for readers.

/// Superscript digits of an integer.
pub(super) fn superscript(number: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
    };
    number.to_string().chars().map(digit).collect()
}

/// `value` with this many decimals and a true minus sign; no negative zero.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| matches!(c, '0' | '.')) => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// `value` for a table: up to `digits` significant digits, trailing zeros dropped, powers of ten
/// for what is very large or small.
///
/// ```
/// use ancf::output::plot::human;
/// assert_eq!(human(-0.316_627_9, 5), "−0.31663");
/// assert_eq!(human(1.5e-9, 6), "1.5 × 10⁻⁹");
/// ```
pub fn human(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return if value.is_nan() { "not a number" } else { "infinite" }.into();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trim = |text: String| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    };
    if (-4..7).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        trim(fixed(value, decimals))
    } else {
        format!("{} × 10{}", trim(mantissa.replace('-', "−")), superscript(exponent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        let written = [0.0, -1.8, 123_456.7, 6.25e-3, 1e300, -2.5e-17, f64::NAN].map(|v| human(v, 6));
        let expected = ["0", "−1.8", "123457", "0.00625", "1 × 10³⁰⁰", "−2.5 × 10⁻¹⁷", "not a number"];
        assert_eq!(written, expected);
        assert_eq!(fixed(-0.001, 1), "0.0");
    }
}
