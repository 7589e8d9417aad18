//! Four numbers of a node, real or complex, for factorisations that serve both.

use crate::lanes::Lanes;
use faer::c64;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Four numbers of a node, real or complex.
pub trait Four: Copy + std::fmt::Debug {
    /// One of them.
    type One: Copy
        + std::fmt::Debug
        + Add<Output = Self::One>
        + Sub<Output = Self::One>
        + Mul<Output = Self::One>
        + Div<Output = Self::One>
        + Neg<Output = Self::One>;
    /// Zeros.
    const ZERO: Self;
    /// The real number `value`.
    fn one(value: f64) -> Self::One;
    /// The size by which numbers are compared.
    fn size(one: Self::One) -> f64;
    /// Whether a pivot is real and negative.
    fn is_negative(one: Self::One) -> bool;
    /// From its numbers.
    fn new(numbers: [Self::One; 4]) -> Self;
    /// Real numbers.
    fn real(numbers: [f64; 4]) -> Self;
    /// Its numbers.
    fn numbers(self) -> [Self::One; 4];
    /// `target + l · self`.
    fn added(self, l: Self::One, target: Self) -> Self;
    /// `target − l · self`.
    fn subtracted(self, l: Self::One, target: Self) -> Self;
    /// Σ self · other.
    fn dot(self, other: Self) -> Self::One;
    /// The transposed block.
    fn transpose(block: [Self; 4]) -> [Self; 4];
    /// `self` times real numbers, number by number.
    fn times(self, numbers: [f64; 4]) -> Self;
    /// The same number four times.
    fn splat(one: Self::One) -> Self;

    /// Its first two numbers, and zeros.
    #[inline(always)]
    fn first_two(self) -> Self {
        self.times([1.0, 1.0, 0.0, 0.0])
    }

    /// Its third number in the first place, and zeros. (Products with zeros, because valgrind does
    /// not know the instruction that the compiler chooses for an assignment of zeros.)
    #[inline(always)]
    fn third_first(self) -> Self {
        Self::splat(self.numbers()[2]).times([1.0, 0.0, 0.0, 0.0])
    }
}

impl Four for Lanes {
    type One = f64;
    const ZERO: Self = Self::ZERO;

    #[inline(always)]
    fn one(value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn size(one: f64) -> f64 {
        one.abs()
    }

    #[inline(always)]
    fn is_negative(one: f64) -> bool {
        one < 0.0
    }

    #[inline(always)]
    fn new(numbers: [f64; 4]) -> Self {
        Self::new(numbers)
    }

    #[inline(always)]
    fn real(numbers: [f64; 4]) -> Self {
        Self::new(numbers)
    }

    #[inline(always)]
    fn numbers(self) -> [f64; 4] {
        self.to_array()
    }

    #[inline(always)]
    fn added(self, l: f64, target: Self) -> Self {
        Self::splat(l).mul_add(self, target)
    }

    #[inline(always)]
    fn subtracted(self, l: f64, target: Self) -> Self {
        Self::splat(l).mul_neg_add(self, target)
    }

    #[inline(always)]
    fn dot(self, other: Self) -> f64 {
        (self * other).reduce_add()
    }

    #[inline(always)]
    fn transpose(block: [Self; 4]) -> [Self; 4] {
        Self::transpose(block)
    }

    #[inline(always)]
    fn times(self, numbers: [f64; 4]) -> Self {
        self * Self::new(numbers)
    }

    #[inline(always)]
    fn splat(one: f64) -> Self {
        Self::splat(one)
    }
}

/// Real parts and imaginary parts.
impl Four for [Lanes; 2] {
    type One = c64;
    const ZERO: Self = [Lanes::ZERO; 2];

    #[inline(always)]
    fn one(value: f64) -> c64 {
        c64::new(value, 0.0)
    }

    #[inline(always)]
    fn size(one: c64) -> f64 {
        one.re.abs() + one.im.abs()
    }

    #[inline(always)]
    fn is_negative(_: c64) -> bool {
        false
    }

    #[inline(always)]
    fn new(numbers: [c64; 4]) -> Self {
        [Lanes::new(numbers.map(|one| one.re)), Lanes::new(numbers.map(|one| one.im))]
    }

    #[inline(always)]
    fn real(numbers: [f64; 4]) -> Self {
        [Lanes::new(numbers), Lanes::ZERO]
    }

    #[inline(always)]
    fn numbers(self) -> [c64; 4] {
        let [re, im] = self.map(Lanes::to_array);
        std::array::from_fn(|lane| c64::new(re[lane], im[lane]))
    }

    #[inline(always)]
    fn added(self, l: c64, [re, im]: Self) -> Self {
        let (l_re, l_im) = (Lanes::splat(l.re), Lanes::splat(l.im));
        let [s_re, s_im] = self;
        [l_im.mul_neg_add(s_im, l_re.mul_add(s_re, re)), l_im.mul_add(s_re, l_re.mul_add(s_im, im))]
    }

    #[inline(always)]
    fn subtracted(self, l: c64, [re, im]: Self) -> Self {
        let (l_re, l_im) = (Lanes::splat(l.re), Lanes::splat(l.im));
        let [s_re, s_im] = self;
        [l_im.mul_add(s_im, l_re.mul_neg_add(s_re, re)), l_im.mul_neg_add(s_re, l_re.mul_neg_add(s_im, im))]
    }

    #[inline(always)]
    fn dot(self, [re, im]: Self) -> c64 {
        let [s_re, s_im] = self;
        let (re, im) = (s_im.mul_neg_add(im, s_re * re), s_im.mul_add(re, s_re * im));
        c64::new(re.reduce_add(), im.reduce_add())
    }

    #[inline(always)]
    fn transpose(block: [Self; 4]) -> [Self; 4] {
        let [re, im] = [0, 1].map(|part| Lanes::transpose(block.map(|row| row[part])));
        std::array::from_fn(|r| [re[r], im[r]])
    }

    #[inline(always)]
    fn times(self, numbers: [f64; 4]) -> Self {
        self.map(|part| part * Lanes::new(numbers))
    }

    #[inline(always)]
    fn splat(one: c64) -> Self {
        [Lanes::splat(one.re), Lanes::splat(one.im)]
    }
}
