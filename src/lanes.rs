//! Four numbers side by side, in the lanes of a register.
//!
//! The densities that take most time are written once, for [`Real`] numbers, and serve single
//! points as well as four points at once. The compiler does not vectorise them by itself; the lanes
//! are therefore explicit, by the registers of the crate `wide` (AVX where the target has it).

mod fma;

pub use fma::fma;

use nalgebra::Matrix2;
use std::ops::{Add, Mul, Neg, Sub};
use wide::f64x4;

/// Four numbers in the lanes of a register.
pub type Lanes = f64x4;

/// The components of a vector in the plane, or of four vectors.
pub type Pair<T> = [T; 2];

/// A matrix of 2 × 2 numbers, row by row, or four such matrices.
pub type Square<T> = [Pair<T>; 2];

/// A number, or four of them.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// The number `x`, in all lanes if there are four.
    fn of(x: f64) -> Self;
    /// `self · b + c`.
    fn fma(self, b: Self, c: Self) -> Self;
    /// √x.
    fn sqrt(self) -> Self;
    /// 1/x.
    fn inverse(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// sin x and cos x.
    fn sin_cos(self) -> (Self, Self);
}

impl Real for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        fma(self, b, c)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        1.0 / self
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        Self::sin_cos(self)
    }
}

impl Real for Lanes {
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self::splat(x)
    }

    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        self.mul_add(b, c)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        Self::ONE / self
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        Self::sin_cos(self)
    }
}

/// The indices of four quadrature points, at equal distances.
#[derive(Clone, Copy, Debug)]
pub struct Points {
    /// Index of the first lane's point.
    pub first: usize,
    /// Difference between the indices of successive lanes.
    pub stride: usize,
}

impl Points {
    /// The index of each lane's point.
    pub fn numbers(self) -> [usize; 4] {
        std::array::from_fn(|lane| self.first + lane * self.stride)
    }

    /// The entries of `list` for these points; zeros if it is empty.
    #[inline(always)]
    pub fn of(self, list: &[f64]) -> Lanes {
        if list.is_empty() {
            Lanes::ZERO
        } else {
            Lanes::new(self.numbers().map(|point| list.get(point).copied().unwrap_or(0.0)))
        }
    }
}

/// a · b.
#[inline(always)]
pub fn dot<T: Real>(a: Pair<T>, b: Pair<T>) -> T {
    a[0].fma(b[0], a[1] * b[1])
}

/// a × b, the component out of the plane.
#[inline(always)]
pub fn cross<T: Real>(a: Pair<T>, b: Pair<T>) -> T {
    a[0].fma(b[1], -(a[1] * b[0]))
}

/// a bᵀ.
#[inline(always)]
pub fn outer<T: Real>(a: Pair<T>, b: Pair<T>) -> Square<T> {
    a.map(|a| b.map(|b| a * b))
}

/// c A + B.
#[inline(always)]
pub fn add<T: Real>(c: T, a: Square<T>, b: Square<T>) -> Square<T> {
    std::array::from_fn(|i| std::array::from_fn(|j| c.fma(a[i][j], b[i][j])))
}

/// Aᵀ.
#[inline(always)]
pub fn turned<T: Real>([[xx, xy], [yx, yy]]: Square<T>) -> Square<T> {
    [[xx, yx], [xy, yy]]
}

/// The matrix as nalgebra's type.
#[inline(always)]
pub fn matrix([[xx, xy], [yx, yy]]: Square<f64>) -> Matrix2<f64> {
    Matrix2::new(xx, xy, yx, yy)
}

/// Adds to every lane of `f` what `add` computes from that lane of `q`. `add` is called with the
/// index of the lane, the lane of `q`, and a zeroed vector for the result; `scratch` holds two
/// vectors of the same length.
pub fn one_by_one(
    q: &[Lanes],
    f: &mut [Lanes],
    scratch: &mut [Vec<f64>; 2],
    mut add: impl FnMut(usize, &[f64], &mut [f64]),
) {
    let [one, sum] = scratch;
    for lane in 0..4 {
        one.iter_mut().zip(q).for_each(|(one, q)| *one = q.to_array()[lane]);
        sum.fill(0.0);
        add(lane, one, sum);
        for (f, sum) in f.iter_mut().zip(&*sum) {
            let mut lanes = f.to_array();
            lanes[lane] += sum;
            *f = Lanes::new(lanes);
        }
    }
}

/// The `W` coefficients of each of four cells, each one node after the cell before; `q` starts at
/// the first cell's coefficients.
#[inline(always)]
pub fn gather<const W: usize>(q: &[f64]) -> [Pair<Lanes>; W] {
    let nodes = q.as_chunks::<4>().0;
    let mut here = [[Lanes::ZERO; 2]; W];
    for (node, pair) in here.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        let [x, y, along, across] =
            Lanes::transpose(std::array::from_fn(|lane| Lanes::new(nodes[node + lane])));
        *pair = [[x, y], [along, across]];
    }
    here
}

/// Adds `sums` to the coefficients of four cells: the transpose of [`gather`].
#[inline(always)]
pub fn scatter<const W: usize>(sums: &[Pair<Lanes>; W], f: &mut [f64]) {
    let nodes = f.as_chunks_mut::<4>().0;
    for (node, [[x, y], [along, across]]) in sums.as_chunks::<2>().0.iter().enumerate() {
        for (lane, sum) in Lanes::transpose([*x, *y, *along, *across]).into_iter().enumerate() {
            nodes[node + lane] = (Lanes::new(nodes[node + lane]) + sum).to_array();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_windows_are_gathered_and_scattered() {
        let q: Vec<f64> = (0..28).map(f64::from).collect();
        let here = gather::<8>(&q);
        for lane in 0..4 {
            for (a, [x, y]) in here.iter().enumerate() {
                let place = 4 * lane + 2 * a;
                assert_eq!([x.to_array()[lane], y.to_array()[lane]], [q[place], q[place + 1]]);
            }
        }
        let mut f = vec![0.5; 28];
        scatter(&here, &mut f);
        for (i, f) in f.iter().enumerate() {
            let windows = (0..4).filter(|lane| (4 * lane..4 * lane + 16).contains(&i)).count();
            assert_eq!(*f, 0.5 + windows as f64 * i as f64);
        }
    }
}
