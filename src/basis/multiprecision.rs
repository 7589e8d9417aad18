//! Arithmetic of any precision, for cells whose moment matrix outgrows double-double.

use astro_float_num::{BigFloat, Consts, Exponent, RoundingMode, Sign};

use super::arithmetic::{Arithmetic, ldexp};

/// Rounding to nearest would take more time and gain one bit, for whose loss the error estimate
/// allows.
const ROUNDING: RoundingMode = RoundingMode::None;

/// Arithmetic with a mantissa of a chosen number of bits.
#[derive(Debug)]
pub struct Multiprecision {
    bits: usize,
    exponential: Exponential,
}

/// Constants of the exponential, with guard bits.
#[derive(Debug)]
struct Exponential {
    bits: usize,
    ln2: BigFloat,
    /// 1/n!, for as many terms as the series needs.
    inverse_factorials: Vec<BigFloat>,
    /// Number of times the argument is halved before the series is summed.
    halvings: usize,
}

/// Bits that repeated squaring and the reduction of the argument may lose.
const GUARD_BITS: usize = 64;

impl Multiprecision {
    /// Arithmetic with at least `bits` bits; `None` if there is no memory for its constants.
    pub fn new(bits: usize) -> Option<Self> {
        let bits = bits.next_multiple_of(64);
        let p = bits + GUARD_BITS;
        let ln2 = Consts::new().ok()?.ln_2(p, ROUNDING);
        // More halvings mean fewer terms; each costs about one product, so this choice balances
        // them.
        let halvings = p.isqrt() / 2 + 2;
        let mut inverse_factorials = vec![BigFloat::from_f64(1.0, p)];
        let mut log2_term = 0.0;
        while log2_term > -(p as f64) {
            let n = inverse_factorials.len() as f64;
            let next = inverse_factorials.last()?.div(&BigFloat::from_f64(n, p), p, ROUNDING);
            inverse_factorials.push(next);
            log2_term -= halvings as f64 + 1.0 + n.log2();
        }
        Some(Self { bits, exponential: Exponential { bits: p, ln2, inverse_factorials, halvings } })
    }
}

impl Arithmetic for Multiprecision {
    type Number = BigFloat;

    fn bits(&self) -> usize {
        self.bits
    }

    fn log2_round_off(&self) -> f64 {
        2.0 - self.bits as f64
    }

    fn number(&self, x: f64) -> BigFloat {
        BigFloat::from_f64(x, self.bits)
    }

    fn nearest(&self, x: &BigFloat) -> f64 {
        let magnitude = self.scaled_magnitude(x, 0);
        if x.sign() == Some(Sign::Neg) { -magnitude } else { magnitude }
    }

    fn exponent(&self, x: &BigFloat) -> Option<i64> {
        if x.is_zero() { None } else { x.exponent().map(i64::from) }
    }

    fn scaled_magnitude(&self, x: &BigFloat, shift: i64) -> f64 {
        // The value is 0.m × 2^e; the words of m are stored least significant first. The two
        // leading words hold at least 64 bits, of which the conversion keeps 53, rounding to
        // nearest.
        match x.as_raw_parts() {
            Some((words, _, _, exponent, _)) => {
                let mut sum = 0.0;
                let mut weight = i64::from(exponent) - shift;
                for word in words.iter().rev().take(2).map(|&word| (word, word_bits(word))) {
                    weight -= word.1;
                    sum += ldexp(word.0 as f64, weight);
                }
                sum
            }
            None if x.is_nan() => f64::NAN,
            None => f64::INFINITY,
        }
    }

    fn exceeds(&self, a: &BigFloat, b: &BigFloat) -> bool {
        // `abs_cmp` is not used, because it compares signed values in astro-float 0.3.7. Mantissas
        // are normalised and have the same length.
        match (a.as_raw_parts(), b.as_raw_parts()) {
            (Some((a, _, _, ea, _)), Some((b, _, _, eb, _))) => {
                match (a.iter().all(|w| *w == 0), b.iter().all(|w| *w == 0)) {
                    (true, _) => false,
                    (false, true) => true,
                    (false, false) => ea.cmp(&eb).then_with(|| a.iter().rev().cmp(b.iter().rev())).is_gt(),
                }
            }
            _ => a.is_inf() && self.is_finite(b),
        }
    }

    fn is_finite(&self, x: &BigFloat) -> bool {
        !x.is_nan() && !x.is_inf()
    }

    fn add(&self, a: &BigFloat, b: &BigFloat) -> BigFloat {
        a.add(b, self.bits, ROUNDING)
    }

    fn sub(&self, a: &BigFloat, b: &BigFloat) -> BigFloat {
        a.sub(b, self.bits, ROUNDING)
    }

    fn mul(&self, a: &BigFloat, b: &BigFloat) -> BigFloat {
        a.mul(b, self.bits, ROUNDING)
    }

    fn div(&self, a: &BigFloat, b: &BigFloat) -> BigFloat {
        a.div(b, self.bits, ROUNDING)
    }

    /// Sums the series of a halved argument and squares repeatedly; here this is three times faster
    /// than the library's own exponential.
    fn exp(&self, x: &BigFloat) -> BigFloat {
        let Exponential { bits: p, ln2, inverse_factorials, halvings } = &self.exponential;
        let p = *p;
        let size = self.nearest(x);
        if !size.is_finite() || size.abs() > 1e8 {
            // Far beyond any value of a kernel: zero, or infinity, which makes the cell fail.
            return BigFloat::from_f64(if size < 0.0 { 0.0 } else { f64::INFINITY }, self.bits);
        }
        if size == 0.0 {
            return self.number(1.0);
        }
        let k = (size * std::f64::consts::LOG2_E).round();
        let mut r = x.sub(&ln2.mul(&BigFloat::from_f64(k, p), p, ROUNDING), p, ROUNDING);
        shift_exponent(&mut r, -(*halvings as i64));
        let horner = |sum: BigFloat, c: &BigFloat| sum.mul(&r, p, ROUNDING).add(c, p, ROUNDING);
        let mut y = inverse_factorials.iter().rev().fold(BigFloat::from_f64(0.0, p), horner);
        for _ in 0..*halvings {
            y = y.mul(&y, p, ROUNDING);
        }
        shift_exponent(&mut y, k as i64);
        y.add(&BigFloat::from_f64(0.0, p), self.bits, ROUNDING)
    }

    /// Starts from the logarithm in double precision and iterates with order four:
    /// ln x = y + ln(1 + e) with e = x e^−y − 1, whose series is cut after e³.
    fn ln(&self, x: &BigFloat) -> BigFloat {
        let p = self.bits;
        let (Some(exponent), false) = (self.exponent(x), x.is_negative()) else {
            return BigFloat::from_f64(self.nearest(x).ln(), p);
        };
        // Starts from the mantissa's logarithm in double precision, so that no exponent is too
        // large for it.
        let mut y =
            self.number(self.scaled_magnitude(x, exponent).ln() + exponent as f64 * std::f64::consts::LN_2);
        let one = self.number(1.0);
        let mut known = 40;
        while known < p {
            let e = self.sub(&self.mul(x, &self.exp(&self.sub(&self.number(0.0), &y))), &one);
            let third = self.div(&self.mul(&e, &self.mul(&e, &e)), &self.number(3.0));
            let half = self.mul(&self.number(0.5), &self.mul(&e, &e));
            y = self.add(&y, &self.add(&self.sub(&e, &half), &third));
            known *= 4;
        }
        y
    }
}

/// x · 2^by.
fn shift_exponent(x: &mut BigFloat, by: i64) {
    if let Some(exponent) = x.exponent().filter(|_| !x.is_zero()) {
        match Exponent::try_from(i64::from(exponent) + by) {
            Ok(exponent) => x.set_exponent(exponent),
            Err(_) => *x = BigFloat::from_f64(if by < 0 { 0.0 } else { f64::INFINITY }, 64),
        }
    }
}

/// Bits of a word of a mantissa, whose type depends on the machine.
fn word_bits<T>(_: T) -> i64 {
    8 * size_of::<T>() as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn doubles_pass_through_unchanged(x in prop::num::f64::NORMAL) {
            let m = Multiprecision::new(192).unwrap();
            prop_assert_eq!(m.nearest(&m.number(x)), x);
        }

        #[test]
        fn magnitudes_compare_as_doubles_do(a in prop::num::f64::ANY, b in prop::num::f64::ANY, tail in -1e-20..1e-20f64) {
            prop_assume!(!a.is_nan() && !b.is_nan());
            let m = Multiprecision::new(192).unwrap();
            prop_assert_eq!(m.exceeds(&m.number(a), &m.number(b)), a.abs() > b.abs());
            let (one, near) = (m.number(-1.0), m.add(&m.number(1.0), &m.number(tail)));
            prop_assert_eq!(m.exceeds(&near, &one), tail > 0.0);
            prop_assert_eq!(m.exceeds(&one, &near), tail < 0.0);
        }

        #[test]
        fn elementary_functions_agree_with_the_library(x in 1e-12..1e12f64, y in -300.0..300.0f64, divisor in 1.0..9.0f64, bits in 100..2000usize) {
            let m = Multiprecision::new(bits).unwrap();
            let mut constants = Consts::new().unwrap();
            let p = m.bits() + 128;
            let (x, y) = (m.div(&m.number(x), &m.number(divisor)), m.div(&m.number(y), &m.number(divisor)));
            for (ours, library) in [
                (m.exp(&y), y.exp(p, RoundingMode::ToEven, &mut constants)),
                (m.ln(&x), x.ln(p, RoundingMode::ToEven, &mut constants)),
            ] {
                let difference = ours.sub(&library, p, RoundingMode::ToEven);
                let lost = difference.exponent().filter(|_| !difference.is_zero()).map_or(0, |exponent| {
                    i64::from(exponent) - i64::from(library.exponent().unwrap()).max(0) + m.bits() as i64
                });
                prop_assert!(lost <= 3, "{lost} bits lost of {}", m.bits());
            }
        }

        #[test]
        fn exponential_inverts_logarithm(x in 1e-6..1e6f64) {
            let m = Multiprecision::new(256).unwrap();
            let x = m.number(x);
            let y = m.exp(&m.ln(&x));
            prop_assert!(m.nearest(&m.div(&m.sub(&y, &x), &x)).abs() < 1e-73);
        }
    }

    #[test]
    fn special_values() {
        let m = Multiprecision::new(128).unwrap();
        assert!(m.is_zero(&m.number(0.0)) && m.nearest(&m.number(0.0)) == 0.0);
        let infinite = m.div(&m.number(1.0), &m.number(0.0));
        assert!(!m.is_finite(&infinite) && !m.is_zero(&infinite));
    }
}
