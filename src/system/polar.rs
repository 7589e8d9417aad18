//! Gradients of welded nodes in polar coordinates.
//!
//! A weld ties the directions of two gradients and leaves their lengths free: θ_b − θ_a = φ. In
//! components of r' that is not linear, and a motion under it would be differential-algebraic of
//! index 3. With length y and direction θ as the unknowns,
//!
//! ```text
//! r' = y e,   ṙ' = ẏ e + y θ̇ n,   r̈' = (ÿ − y θ̇²) e + (2 ẏ θ̇ + y θ̈) n,   e = (cos θ, sin θ), n = (−sin θ, cos θ)
//! f → Pᵀ f,   K → Pᵀ K P,   P = ∂r'/∂(y, θ) = [e, y n]
//! ```
//!
//! it is linear with constant rows, and the motion an ordinary differential equation on the
//! subspace that they leave: every method keeps its order, and Gauss' methods conserve the energy
//! as they do elsewhere. What the change of P adds to a tangent, f·∂²r'/∂(y, θ)², vanishes where
//! forces and inertia balance, and is left out.

use super::System;
use crate::linear::Matrix;

/// The pairs of coordinates, 2·pair and 2·pair + 1, that are polar in a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polar {
    pairs: Vec<usize>,
}

/// e, and y n.
fn tangents([x, y]: [f64; 2]) -> [[f64; 2]; 2] {
    let length = x.hypot(y);
    [[x / length, y / length], [-y, x]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn of(v: &mut [f64], pair: usize) -> &mut [f64; 2] {
    &mut v.as_chunks_mut::<2>().0[pair]
}

impl Polar {
    /// The given pairs.
    pub fn new(mut pairs: Vec<usize>) -> Self {
        pairs.sort_unstable();
        pairs.dedup();
        Self { pairs }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Their nodes.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.pairs.iter().map(|pair| pair / 2)
    }

    /// r', ṙ', r̈' from (y, θ) and its rates.
    pub fn carry(&self, [q, v, a]: [&mut [f64]; 3]) {
        for &pair in &self.pairs {
            let (q, v, a) = (of(q, pair), of(v, pair), of(a, pair));
            let ([y, angle], [dy, turn], [ddy, second]) = (*q, *v, *a);
            let (sine, cosine) = angle.sin_cos();
            let at =
                |along: f64, across: f64| [along * cosine - across * sine, along * sine + across * cosine];
            *q = at(y, 0.0);
            *v = at(dy, y * turn);
            *a = at(ddy - y * turn * turn, 2.0 * dy * turn + y * second);
        }
    }

    /// (y, θ) and its rates from r' and ṙ': the inverse of [`Self::carry`], with θ from −π to π.
    pub fn uncarry(&self, q: &mut [f64], v: &mut [f64]) {
        for &pair in &self.pairs {
            let (q, v) = (of(q, pair), of(v, pair));
            let ([x, y], [e, yn]) = (*q, tangents(*q));
            let length = x.hypot(y);
            *v = [dot(e, *v), dot(yn, *v) / (length * length)];
            *q = [length, y.atan2(x)];
        }
    }

    /// Pᵀ f in the state `q` in fixed axes.
    pub fn forces(&self, q: &[f64], f: &mut [f64]) {
        for &pair in &self.pairs {
            let f = of(f, pair);
            *f = tangents([q[2 * pair], q[2 * pair + 1]]).map(|t| dot(t, *f));
        }
    }

    /// P d in the state `q` in fixed axes.
    pub fn changes(&self, q: &[f64], d: &mut [f64]) {
        for &pair in &self.pairs {
            let d = of(d, pair);
            let ([e, yn], [along, turn]) = (tangents([q[2 * pair], q[2 * pair + 1]]), *d);
            *d = std::array::from_fn(|i| along * e[i] + turn * yn[i]);
        }
    }

    /// Pᵀ K P in the state `q` in fixed axes.
    pub fn matrix(&self, q: &[f64], k: &mut Matrix) {
        for &pair in &self.pairs {
            k.change_pair(pair, tangents([q[2 * pair], q[2 * pair + 1]]));
        }
    }
}

impl System {
    /// Whether unknowns of a motion are not all coordinates in fixed axes with rates of their own.
    pub fn carries(&self) -> bool {
        self.supports.moves_in_time() || !self.polar.is_empty()
    }

    /// Whether the directions in which unknowns of a motion are counted turn.
    pub fn turns(&self) -> bool {
        self.supports.turn_in_time() || !self.polar.is_empty()
    }

    /// Positions, velocities and accelerations in fixed axes from the unknowns of a motion.
    pub fn carry(&self, time: f64, [q, v, a]: [&mut [f64]; 3]) {
        self.supports.carry(time, [&mut *q, &mut *v, &mut *a]);
        self.polar.carry([q, v, a]);
    }

    /// The unknowns of a motion from positions and velocities in fixed axes: the inverse of
    /// [`Self::carry`].
    pub fn uncarry(&self, time: f64, q: &mut [f64], v: &mut [f64]) {
        self.supports.uncarry(time, q, v);
        self.polar.uncarry(q, v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_derivatives() {
        // y = 1.1 + 0.3 t − 0.2 t², θ = 2 + 1.7 t + 0.4 t².
        let polar = Polar::new(vec![1, 1]);
        let at = |t: f64| {
            let mut q = [5.0, 6.0, 1.1 + 0.3 * t - 0.2 * t * t, 2.0 + 1.7 * t + 0.4 * t * t];
            let (mut v, mut a) = ([7.0, 8.0, 0.3 - 0.4 * t, 1.7 + 0.8 * t], [0.0, 9.0, -0.4, 0.8]);
            polar.carry([&mut q, &mut v, &mut a]);
            (q, v, a)
        };
        let h = 1e-4;
        let ((q0, v0, _), (q, v, a), (q1, v1, _)) = (at(-h), at(0.0), at(h));
        assert_eq!(([q[0], q[1]], [v[0], v[1]], [a[0], a[1]]), ([5.0, 6.0], [7.0, 8.0], [0.0, 9.0]));
        for i in 2..4 {
            assert!(((q1[i] - q0[i]) / (2.0 * h) - v[i]).abs() < 1e-7);
            assert!(((v1[i] - v0[i]) / (2.0 * h) - a[i]).abs() < 1e-6);
        }
        let (mut y, mut dy) = (q, v);
        polar.uncarry(&mut y, &mut dy);
        assert!((y[2] - 1.1).abs() < 1e-15 && (y[3] - 2.0).abs() < 1e-15);
        assert!((dy[2] - 0.3).abs() < 1e-15 && (dy[3] - 1.7).abs() < 1e-15);
        polar.changes(&q, &mut dy);
        assert!(dy.iter().zip(v).all(|(a, b)| (a - b).abs() < 1e-14));
    }
}
