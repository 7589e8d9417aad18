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

    /// Would catch digits too many or too few, and powers of ten for what is read better without.
    #[test]
    fn numbers_have_the_digits_that_are_asked_for() {
        for (value, digits, expected) in [
            (1.0, 6, "1"),
            (-2.0, 3, "−2"),
            (123.456, 4, "123.5"),
            (1.234_56e-3, 3, "0.00123"),
            (120.0, 2, "120"),
            (1_234_567.0, 3, "1234567"),
            (1e-4, 6, "0.0001"),
            (9.9e-5, 6, "9.9 × 10⁻⁵"),
            (9_999_999.0, 7, "9999999"),
            (9_999_999.0, 3, "1 × 10⁷"),
            (1e7, 6, "1 × 10⁷"),
            (-1.234_56e-9, 3, "−1.23 × 10⁻⁹"),
            (5.4e123, 1, "5 × 10¹²³"),
            (f64::INFINITY, 6, "infinite"),
            (f64::NEG_INFINITY, 6, "infinite"),
        ] {
            assert_eq!(human(value, digits), expected);
        }
        assert_eq!(superscript(-1_234_567_890), "⁻¹²³⁴⁵⁶⁷⁸⁹⁰");
        for (value, decimals, expected) in
            [(-0.04, 1, "0.0"), (-0.06, 1, "−0.1"), (2.5, 2, "2.50"), (-7.0, 0, "−7"), (0.0, 3, "0.000")]
        {
            assert_eq!(fixed(value, decimals), expected);
        }
    }
}
