//! A tangent that turns with the nodes of a beam.
//!
//! What changes a slender beam's tangent K most is rotation. Between the state q₀ at which K was
//! taken and the state q, node i turns by φ_i, the angle from r'_i(q₀) to r'_i(q). With R =
//! diag(R(φ_i)) over the pairs (x, y) and (x', y') of the nodes, R K Rᵀ is K at q apart from the
//! change of stress and shape. So a residual is turned back by Rᵀ, the equations are solved with
//! the old factorisation, and the increment is turned forth by R.
//!
//! A polar gradient (y, θ) has the turn in θ: it stays as it is, and the position of its node turns by the change of θ. In a weld both
//! nodes turn by the same angle, and with them the force that it transmits ([`PairTurns`]).

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

    /// By an angle \[rad\].
    fn by(angle: T) -> Self {
        let (sine, cosine) = angle.sin_cos();
        Self { cosine, sine }
    }

    /// The opposite turn.
    #[inline(always)]
    fn reversed(&self) -> Self {
        Self { cosine: self.cosine, sine: -self.sine }
    }

    /// R of one pair.
    #[inline(always)]
    fn of_pair(&self, [x, y]: Pair<T>) -> Pair<T> {
        let Self { cosine, sine } = *self;
        [cosine.fma(x, -(sine * y)), cosine.fma(y, sine * x)]
    }

    /// R v.
    #[inline(always)]
    pub fn forth(&self, v: &mut [T; 4]) {
        let [a, b, c, d] = *v;
        let ([a, b], [c, d]) = (self.of_pair([a, b]), self.of_pair([c, d]));
        *v = [a, b, c, d];
    }

    /// Rᵀ v.
    #[inline(always)]
    pub fn back(&self, v: &mut [T; 4]) {
        self.reversed().forth(v);
    }
}

/// Pairs of unknowns that turn as an unknown direction θ does.
#[derive(Clone, Debug)]
pub struct PairTurns<T> {
    /// The unknown θ, and the first unknown of the pair.
    pairs: Vec<[usize; 2]>,
    turns: Vec<Turn<T>>,
}

impl<T: Real> PairTurns<T> {
    /// No turn of any of the `pairs`: the unknown θ and the first unknown of each.
    pub fn new(pairs: Vec<[usize; 2]>) -> Self {
        Self { turns: vec![Turn::none(); pairs.len()], pairs }
    }

    /// Measures the turns from `q0` to `q`.
    pub fn measure(&mut self, q0: &[f64], q: &[T]) {
        for (turn, [direction, _]) in self.turns.iter_mut().zip(&self.pairs) {
            *turn = Turn::by(q[*direction] - T::of(q0[*direction]));
        }
    }

    /// R v, of all unknowns.
    pub fn forth(&self, v: &mut [T]) {
        self.each(v, |turn, pair| turn.of_pair(pair));
    }

    /// Rᵀ v, of all unknowns.
    pub fn back(&self, v: &mut [T]) {
        self.each(v, |turn, pair| turn.reversed().of_pair(pair));
    }

    fn each(&self, v: &mut [T], turned: impl Fn(&Turn<T>, Pair<T>) -> Pair<T>) {
        for (turn, [_, first]) in self.turns.iter().zip(&self.pairs) {
            [v[*first], v[first + 1]] = turned(turn, [v[*first], v[first + 1]]);
        }
    }
}

/// R of a whole system, node by node.
#[derive(Clone, Debug)]
pub struct Turns {
    turns: Vec<Turn<f64>>,
    /// Nodes that do not turn: a fixed component of a position must keep its axis.
    still: Vec<usize>,
    pairs: PairTurns<f64>,
}

impl Turns {
    /// No turn of any of `nodes` nodes; those of `still` never turn as a whole.
    pub fn new(nodes: usize, still: Vec<usize>, pairs: PairTurns<f64>) -> Self {
        Self { turns: vec![Turn::none(); nodes], still, pairs }
    }

    /// Measures the turns from `q0` to `q`.
    pub fn measure(&mut self, q0: &[f64], q: &[f64]) {
        self.pairs.measure(q0, q);
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

    /// The sine of the largest angle by which the turn of a node differs from the mean one of all nodes. Only where it is zero does
    /// R K Rᵀ keep what K keeps of a translation.
    pub fn spread(&self) -> f64 {
        let mean =
            self.turns.iter().chain(&self.pairs.turns).fold(Turn { cosine: 0.0, sine: 0.0 }, |mean, turn| {
                Turn { cosine: mean.cosine + turn.cosine, sine: mean.sine + turn.sine }
            });
        let size = mean.cosine.hypot(mean.sine);
        let off = |turn: &Turn<f64>| (turn.sine * mean.cosine - turn.cosine * mean.sine).abs() / size;
        // A node whose pair of positions turns by itself does so in place of the node as a whole.
        let by_itself = |node: &usize| self.pairs.pairs.iter().any(|[_, first]| first / 4 == *node);
        let whole = (0..self.turns.len()).filter(|node| !self.still.contains(node) || !by_itself(node));
        let turns = whole.map(|node| &self.turns[node]).chain(&self.pairs.turns);
        turns.map(off).fold(0.0, f64::max)
    }

    /// The turns beside those of whole nodes.
    pub fn of_pairs(&self) -> &PairTurns<f64> {
        &self.pairs
    }

    /// R v, of all unknowns.
    pub fn forth(&self, v: &mut [f64]) {
        self.pairs.forth(v);
        self.turns.iter().zip(v.as_chunks_mut::<4>().0).for_each(|(turn, v)| turn.forth(v));
    }

    /// Rᵀ v, of all unknowns.
    pub fn back(&self, v: &mut [f64]) {
        self.pairs.back(v);
        self.turns.iter().zip(v.as_chunks_mut::<4>().0).for_each(|(turn, v)| turn.back(v));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three nodes turn by 0.1, 0.2 and 0.3 rad, or the last one stays; all alike have no spread.
    #[test]
    fn nodes_that_turn_apart_are_told() {
        let state = |angles: [f64; 3]| {
            angles.iter().enumerate().flat_map(|(k, a)| [k as f64, 0.0, a.cos(), a.sin()]).collect::<Vec<_>>()
        };
        let spread = |angles, still: Vec<usize>| {
            let mut turns = Turns::new(3, still, PairTurns::new(Vec::new()));
            turns.measure(&state([0.0; 3]), &state(angles));
            turns.spread()
        };
        assert!((spread([0.1, 0.2, 0.3], vec![]) - 0.1_f64.sin()).abs() < 1e-12);
        assert!(spread([0.7; 3], vec![]) < 1e-12);
        // Two directions of 0.6 rad and one of 0: the mean has the angle atan(2 sin 0.6/(2 cos 0.6 + 1)).
        let mean = (2.0 * 0.6_f64.sin()).atan2(2.0 * 0.6_f64.cos() + 1.0);
        assert!((spread([0.6; 3], vec![2]) - mean.sin()).abs() < 1e-12);
    }
}
