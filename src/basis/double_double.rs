//! Double-double arithmetic: a number is the unevaluated sum of two doubles, with about 106 bits.
//!
//! Sums and products use Knuth's and Dekker's error-free transformations in the accurate variants
//! of Joldes, Muller and Popescu, *ACM TOMS* 44(2) (2017) 15, with a fused multiply-add for the
//! error of a product. The relative error of one operation is below 2⁻¹⁰²; that of the exponential
//! and the logarithm is below 1e-30 (absolute for the logarithm near 1).
//!
//! The crate `qd` (0.8) is as fast in the exponential and the logarithm, but its powers err by 1e-29
//! where |q ln x| exceeds 100, because it takes ln 2 for two doubles, and its operators add without
//! a bound for the error where terms cancel: kernels need all digits that the condition number of
//! the moment matrix will take.

use super::arithmetic::{Arithmetic, ldexp};

/// hi + lo with |lo| ≤ ½ ulp(hi).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Double {
    hi: f64,
    lo: f64,
}

/// The arithmetic of [`Double`].
#[derive(Clone, Copy, Debug, Default)]
pub struct DoubleDouble;

const ONE: Double = Double { hi: 1.0, lo: 0.0 };

/// ln 2 as three doubles; the first has 32 trailing zero bits, so that small whole multiples of it
/// are exact.
const LN2: [f64; 3] = [0.693_146_705_627_441_4, 4.749_325_039_031_672_6e-7, -2.340_793_886_567_823_4e-23];

/// 1/n! for n = 3 to 10.
const INVERSE_FACTORIAL: [Double; 8] = [
    Double { hi: 1.0 / 6.0, lo: 9.25185853854297e-18 },
    Double { hi: 1.0 / 24.0, lo: 2.3129646346357427e-18 },
    Double { hi: 1.0 / 120.0, lo: 1.1564823173178714e-19 },
    Double { hi: 1.0 / 720.0, lo: -5.300543954373577e-20 },
    Double { hi: 1.0 / 5040.0, lo: 1.7209558293420705e-22 },
    Double { hi: 1.0 / 40320.0, lo: 2.1511947866775882e-23 },
    Double { hi: 1.0 / 362880.0, lo: -1.858393274046472e-22 },
    Double { hi: 1.0 / 3628800.0, lo: 2.3767714622250297e-23 },
];

/// Number of times the argument of the exponential is halved before its series is summed.
const HALVINGS: i64 = 9;

#[inline(always)]
fn two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let t = hi - a;
    Double { hi, lo: (a - (hi - t)) + (b - t) }
}

#[inline(always)]
fn quick_two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    Double { hi, lo: b - (hi - a) }
}

#[inline(always)]
fn two_product(a: f64, b: f64) -> Double {
    let hi = a * b;
    Double { hi, lo: a.mul_add(b, -hi) }
}

impl Double {
    #[inline(always)]
    fn plus(self, b: Self) -> Self {
        let s = two_sum(self.hi, b.hi);
        let t = two_sum(self.lo, b.lo);
        let s = quick_two_sum(s.hi, s.lo + t.hi);
        quick_two_sum(s.hi, s.lo + t.lo)
    }

    #[inline(always)]
    fn minus(self, b: Self) -> Self {
        self.plus(Self { hi: -b.hi, lo: -b.lo })
    }

    #[inline(always)]
    fn times(self, b: Self) -> Self {
        let p = two_product(self.hi, b.hi);
        let cross = self.hi.mul_add(b.lo, self.lo.mul_add(b.hi, self.lo * b.lo));
        quick_two_sum(p.hi, p.lo + cross)
    }

    #[inline(always)]
    fn over(self, b: Self) -> Self {
        let q0 = self.hi / b.hi;
        let r = self.minus(b.times(Self { hi: q0, lo: 0.0 }));
        let q1 = r.hi / b.hi;
        let r = r.minus(b.times(Self { hi: q1, lo: 0.0 }));
        let q2 = r.hi / b.hi;
        let q = quick_two_sum(q0, q1);
        quick_two_sum(q.hi, q.lo + q2)
    }

    #[inline(always)]
    fn scaled(self, power_of_two: f64) -> Self {
        Self { hi: self.hi * power_of_two, lo: self.lo * power_of_two }
    }

    fn exp(self) -> Self {
        if self.hi > 709.0 {
            return Self { hi: f64::INFINITY, lo: 0.0 };
        }
        if self.hi < -740.0 {
            return Self { hi: 0.0, lo: 0.0 };
        }
        // x = k ln 2 + 2⁹ r, so |r| < 7e-4 and ten terms of the series suffice.
        let k = (self.hi * std::f64::consts::LOG2_E).round();
        let r = self
            .plus(Self { hi: -k * LN2[0], lo: 0.0 })
            .minus(two_product(k, LN2[1]))
            .minus(Self { hi: k * LN2[2], lo: 0.0 })
            .scaled(1.0 / (1 << HALVINGS) as f64);
        let mut series = INVERSE_FACTORIAL[7];
        for term in INVERSE_FACTORIAL[..7].iter().rev() {
            series = series.times(r).plus(*term);
        }
        let square = r.times(r);
        let mut less_one = series.times(r).times(square).plus(square.scaled(0.5)).plus(r);
        for _ in 0..HALVINGS {
            // e²ʳ − 1 = 2(eʳ − 1) + (eʳ − 1)² keeps digits that squaring eʳ itself would lose.
            less_one = less_one.times(less_one).plus(less_one.scaled(2.0));
        }
        let e = less_one.plus(ONE);
        let (hi, lo) = (ldexp(e.hi, k as i64), ldexp(e.lo, k as i64));
        Self { hi, lo }
    }

    fn ln(self) -> Self {
        if !(self.hi > 0.0 && self.hi.is_finite()) {
            return Self { hi: self.hi.ln(), lo: 0.0 };
        }
        // ln x = y + ln(1 + e) with y = ln x in double precision, so e is about 1e-16 and two terms
        // suffice.
        let y = self.hi.ln();
        let e = self.times(Self { hi: -y, lo: 0.0 }.exp()).minus(ONE);
        Self { hi: y, lo: 0.0 }.plus(e.minus(e.times(e).scaled(0.5)))
    }
}

impl Arithmetic for DoubleDouble {
    type Number = Double;

    fn bits(&self) -> usize {
        106
    }

    fn log2_round_off(&self) -> f64 {
        -103.0
    }

    fn number(&self, x: f64) -> Double {
        Double { hi: x, lo: 0.0 }
    }

    fn nearest(&self, x: &Double) -> f64 {
        x.hi
    }

    fn exponent(&self, x: &Double) -> Option<i64> {
        (x.hi != 0.0 && x.hi.is_finite()).then(|| ((x.hi.to_bits() >> 52) & 0x7ff) as i64 - 1023)
    }

    fn scaled_magnitude(&self, x: &Double, shift: i64) -> f64 {
        ldexp(x.hi.abs(), -shift)
    }

    fn exceeds(&self, a: &Double, b: &Double) -> bool {
        a.hi.abs() > b.hi.abs()
    }

    fn is_finite(&self, x: &Double) -> bool {
        x.hi.is_finite() && x.lo.is_finite()
    }

    #[inline]
    fn add(&self, a: &Double, b: &Double) -> Double {
        a.plus(*b)
    }

    #[inline]
    fn sub(&self, a: &Double, b: &Double) -> Double {
        a.minus(*b)
    }

    #[inline]
    fn mul(&self, a: &Double, b: &Double) -> Double {
        a.times(*b)
    }

    fn div(&self, a: &Double, b: &Double) -> Double {
        a.over(*b)
    }

    fn exp(&self, x: &Double) -> Double {
        Double::exp(*x)
    }

    fn ln(&self, x: &Double) -> Double {
        Double::ln(*x)
    }
}

#[cfg(test)]
mod tests {
    use super::super::multiprecision::Multiprecision;
    use super::*;
    use proptest::prelude::*;

    /// Relative difference between a double-double and a multiprecision number.
    fn error(m: &Multiprecision, x: Double, exact: &<Multiprecision as Arithmetic>::Number) -> f64 {
        let x = m.add(&m.number(x.hi), &m.number(x.lo));
        let difference = m.sub(&x, exact);
        if m.is_zero(&difference) { 0.0 } else { m.nearest(&m.div(&difference, exact)).abs() }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn elementary_functions_agree_with_multiprecision(x in 1e-8..1e8f64, tail in -0.5..0.5f64, q in -8.0..8.0f64, y in -40.0..40.0f64) {
            let (d, m) = (DoubleDouble, Multiprecision::new(320).unwrap());
            let lo = tail * f64::EPSILON * x * 0.49;
            let x = quick_two_sum(x, lo);
            let exact = m.add(&m.number(x.hi), &m.number(x.lo));
            prop_assert!(error(&m, d.ln(&x), &m.ln(&exact)) * d.ln(&x).hi.abs().min(1.0) < 1e-30);
            prop_assert!(error(&m, d.pow(&x, q), &m.pow(&exact, q)) < 1e-29);
            prop_assert!(error(&m, d.exp(&d.number(y)), &m.exp(&m.number(y))) < 1e-30);
        }

        #[test]
        fn rational_operations_agree_with_multiprecision(a in -1e6..1e6f64, b in 1e-6..1e6f64, p in 1e-17..1e-16f64, q in -1e-16..1e-17f64) {
            let (d, m) = (DoubleDouble, Multiprecision::new(320).unwrap());
            let (a, b) = (quick_two_sum(a, a * p * 0.4), quick_two_sum(b, b * q * 0.4));
            let wide = |x: Double| m.add(&m.number(x.hi), &m.number(x.lo));
            let (ma, mb) = (wide(a), wide(b));
            for (x, exact) in [
                (d.add(&a, &b), m.add(&ma, &mb)),
                (d.sub(&a, &b), m.sub(&ma, &mb)),
                (d.mul(&a, &b), m.mul(&ma, &mb)),
                (d.div(&a, &b), m.div(&ma, &mb)),
            ] {
                prop_assert!(error(&m, x, &exact) < 2f64.powi(-102));
            }
        }
    }

    #[test]
    fn extremes_do_not_turn_into_nonsense() {
        assert_eq!(DoubleDouble.exp(&DoubleDouble.number(-1e4)).hi, 0.0);
        assert_eq!(DoubleDouble.exp(&DoubleDouble.number(1e4)).hi, f64::INFINITY);
        assert_eq!(DoubleDouble.exp(&DoubleDouble.number(0.0)), ONE);
        assert_eq!(DoubleDouble.ln(&ONE).hi, 0.0);
    }

    /// An overflowing exponential has a finite second part; it must count neither as finite nor as
    /// zero.
    #[test]
    fn a_number_is_finite_where_both_its_parts_are() {
        let is_finite = |hi, lo| DoubleDouble.is_finite(&Double { hi, lo });
        assert!(is_finite(1.0, 1e-17));
        assert!(!is_finite(f64::INFINITY, 0.0) && !is_finite(1.0, f64::NAN));
        assert!(!DoubleDouble.is_zero(&DoubleDouble.exp(&DoubleDouble.number(1e4))));
    }
}
