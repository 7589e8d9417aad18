//! A tangent that turns with the nodes of a beam.
//!
//! What changes a slender beam's tangent K most is rotation. Between the state q₀ at which K was
//! taken and the state q, node i turns by φ_i, the angle from r'_i(q₀) to r'_i(q). With R =
//! diag(R(φ_i)) over the pairs (x, y) and (x', y') of the nodes, R K Rᵀ is K at q apart from the
//! change of stress and shape. So a residual is turned back by Rᵀ, the equations are solved with
//! the old factorisation, and the increment is turned forth by R.

use crate::lanes::{Pair, Real, cross, dot};
use crate::threads;

/// A turn of a node, in one state or in four.
#[derive(Clone, Copy, Debug)]
pub struct Turn<T> {
    cosine: T,
    sine: T,
}

impl<T: Real> Turn<T> {
    /// No turn.
    pub fn none() -> Self {
        Self { cosine: T::of(1.0), sine: T::of(0.0) }
    }

    /// From the gradient `start` to the gradient `now`.
    #[inline(always)]
    pub fn between(start: Pair<T>, now: Pair<T>) -> Self {
        let (cosine, sine) = (dot(now, start), cross(start, now));
        let inverse = (cosine * cosine + sine * sine).sqrt().inverse();
        Self { cosine: cosine * inverse, sine: sine * inverse }
    }

    /// R v.
    #[inline(always)]
    pub fn forth(&self, v: &mut [T; 4]) {
        let Self { cosine, sine } = *self;
        let [a, b, c, d] = *v;
        *v = [
            cosine.fma(a, -(sine * b)),
            cosine.fma(b, sine * a),
            cosine.fma(c, -(sine * d)),
            cosine.fma(d, sine * c),
        ];
    }

    /// Rᵀ v.
    #[inline(always)]
    pub fn back(&self, v: &mut [T; 4]) {
        Self { cosine: self.cosine, sine: -self.sine }.forth(v);
    }
}

/// R of a whole system, node by node.
#[derive(Clone, Debug)]
pub struct Turns {
    turns: Vec<Turn<f64>>,
    /// Nodes that do not turn: a fixed component of a position must keep its axis.
    still: Vec<usize>,
}

impl Turns {
    /// No turn of any of `nodes` nodes; those of `still` never turn.
    pub fn new(nodes: usize, still: Vec<usize>) -> Self {
        Self { turns: vec![Turn::none(); nodes], still }
    }

    /// Measures the turns from `q0` to `q`.
    pub fn measure(&mut self, q0: &[f64], q: &[f64]) {
        let (q, q0) = (q.as_chunks::<4>().0, q0.as_chunks::<4>().0);
        threads::each([&mut self.turns[..]], &|range, [turns]| {
            for (turn, (x, start)) in turns.iter_mut().zip(q[range.clone()].iter().zip(&q0[range])) {
                *turn = Turn::between([start[2], start[3]], [x[2], x[3]]);
            }
        });
        for &node in &self.still {
            self.turns[node] = Turn::none();
        }
    }

    /// The turns, node by node.
    pub fn of_nodes(&self) -> &[Turn<f64>] {
        &self.turns
    }

    /// R v.
    pub fn forth(&self, v: &mut [f64]) {
        self.turns.iter().zip(v.as_chunks_mut::<4>().0).for_each(|(turn, v)| turn.forth(v));
    }

    /// Rᵀ v.
    pub fn back(&self, v: &mut [f64]) {
        self.turns.iter().zip(v.as_chunks_mut::<4>().0).for_each(|(turn, v)| turn.back(v));
    }
}
