//! The operations on numbers that the construction of shape functions needs, so that one code
//! serves every precision.

use std::fmt::Debug;

/// Real arithmetic at a fixed precision.
///
/// Operations are methods of the arithmetic, not of the number, since multiprecision needs to know
/// its precision and keeps constants. All but the conversions have a relative error of a few units
/// of the round-off that [`Arithmetic::log2_round_off`] states.
pub trait Arithmetic {
    /// A number.
    type Number: Clone + Debug;

    /// Bits of the mantissa.
    fn bits(&self) -> usize;
    /// log₂ of the largest relative error of one operation.
    fn log2_round_off(&self) -> f64;
    /// The number equal to `x`, without rounding.
    fn number(&self, x: f64) -> Self::Number;
    /// The double nearest to `x`; infinite beyond the range of doubles.
    fn nearest(&self, x: &Self::Number) -> f64;
    /// e with 2^(e−1) ≤ |x| < 2^(e+1), or `None` for zero, infinities and NaN.
    fn exponent(&self, x: &Self::Number) -> Option<i64>;
    /// |x| · 2^−shift, rounded to double precision.
    fn scaled_magnitude(&self, x: &Self::Number, shift: i64) -> f64;
    /// Whether |a| > |b|.
    fn exceeds(&self, a: &Self::Number, b: &Self::Number) -> bool;
    /// Whether `x` is neither infinite nor NaN.
    fn is_finite(&self, x: &Self::Number) -> bool;
    /// a + b.
    fn add(&self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// a − b.
    fn sub(&self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// a b.
    fn mul(&self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// a / b.
    fn div(&self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// eˣ.
    fn exp(&self, x: &Self::Number) -> Self::Number;
    /// ln x for x > 0.
    fn ln(&self, x: &Self::Number) -> Self::Number;

    /// xᵖ for x > 0.
    fn pow(&self, x: &Self::Number, p: f64) -> Self::Number {
        self.exp(&self.mul(&self.ln(x), &self.number(p)))
    }

    /// Whether x is exactly zero.
    fn is_zero(&self, x: &Self::Number) -> bool {
        self.is_finite(x) && self.exponent(x).is_none()
    }

    /// y_i ← y_i − a x_i.
    fn sub_scaled(&self, y: &mut [Self::Number], a: &Self::Number, x: &[Self::Number]) {
        for (y, x) in y.iter_mut().zip(x) {
            *y = self.sub(y, &self.mul(a, x));
        }
    }
}

/// m · 2^e without intermediate overflow or a second rounding of normal results.
pub fn ldexp(m: f64, e: i64) -> f64 {
    let mut m = m;
    let mut e = e.clamp(-2400, 2400);
    while e != 0 && m != 0.0 && m.is_finite() {
        let step = e.clamp(-1000, 1000);
        m *= f64::from_bits(((1023 + step) as u64) << 52);
        e -= step;
    }
    m
}
