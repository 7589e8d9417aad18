//! Values with no digit beyond their error.

/// A value and its error in units of the last digit, `0.44501(3)`; `None` where the error tells
/// nothing of the digits: where it is zero, or either is not finite.
///
/// ```
/// use ancf::output::with_error;
/// assert_eq!(with_error(0.445012, 2.6e-5).as_deref(), Some("0.44501(3)"));
/// assert_eq!(with_error(123.4, 20.0).as_deref(), Some("1.2(2)e2"));
/// assert_eq!(with_error(-3.1e-7, 1e-9).as_deref(), Some("-3.10(1)e-7"));
/// ```
pub fn with_error(value: f64, error: f64) -> Option<String> {
    if !(error > 0.0 && error.is_finite() && value.is_finite()) {
        return None;
    }
    // One digit of the error, rounded up.
    let mut place = error.log10().floor() as i32;
    let mut digit = (error / 10.0_f64.powi(place) * (1.0 - 1e-9)).ceil() as i32;
    if digit > 9 {
        (digit, place) = (1, place + 1);
    }
    let size = if value == 0.0 { place } else { (value.abs().log10().floor() as i32).max(place) };
    Some(if place <= 0 && (-4..7).contains(&size) {
        let decimals = usize::try_from(-place).unwrap_or(0);
        format!("{value:.decimals$}({digit})")
    } else {
        let decimals = usize::try_from(size - place).unwrap_or(0);
        format!("{:.decimals$}({digit})e{size}", value / 10.0_f64.powi(size))
    })
}

#[cfg(test)]
mod tests {
    use super::with_error;

    #[test]
    fn numbers_of_any_size_have_the_digits_that_are_known() {
        let said = |value, error| with_error(value, error).unwrap();
        assert_eq!(said(0.0, 2e-3), "0.000(2)");
        assert_eq!(said(0.0, 2e-6), "0(2)e-6");
        assert_eq!(said(9.999, 0.95), "10(1)");
        assert_eq!(said(1234.5678, 0.01), "1234.57(1)");
        assert_eq!(said(0.000_123_4, 1e-6), "0.000123(1)");
        assert_eq!(said(0.000_012_34, 1e-7), "1.23(1)e-5");
        assert_eq!(said(1e-9, 1e-3), "0.000(1)");
        for [value, error] in [[1.0, 0.0], [1.0, f64::NAN], [f64::NAN, 1.0], [1.0, f64::INFINITY]] {
            assert_eq!(with_error(value, error), None);
        }
    }
}
