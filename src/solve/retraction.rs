//! Moving a beam along an increment, with turns that are finite.
//!
//! An increment Δq of Newton's method is a tangent vector. Added to the coordinates it stretches
//! the vectors that it turns: a gradient of length 1 turned by φ becomes √(1 + φ²) long, an error
//! that only smaller steps could reduce. Here every gradient and every chord from node to node is
//! *turned* instead by the angle that its increment means,
//!
//! ```text
//! φ = (g × Δg)/|g|²,  g ← (1 + g·Δg/|g|²) R(φ) g        and the same for the chord c with ψ
//! ```
//!
//! and the chords are joined end to end, beginning where the beam is held. If the ends of a chord
//! turn against it by α = φ₁ − ψ and β = φ₂ − ψ, the cubic between them would become longer by (2α²
//! − αβ + 2β²)/30, and the chord is shortened by that. Between two fixed nodes the chords would
//! miss the second; the gap is distributed along the chain. The result differs from q + Δq in the
//! second order, so that Newton's convergence stays what it is (a retraction, in the language of
//! Absil, Mahony, Sepulchre, *Optimization Algorithms on Matrix Manifolds*, 2008, ch. 4). Yet a
//! straight cantilever is bent into a circle of any angle, with an error of the fourth order in the
//! angle of a cell.

use crate::system::System;

/// Increments that turn no gradient by more than this are simply added \[rad\]: the stretch is then
/// smaller than the error of Newton's method itself.
const SMALL: f64 = 0.01;

/// No vector shrinks to a smaller part of its length in one increment.
const SHORTEST: f64 = 0.1;

/// How the beams of a system move.
#[derive(Clone, Debug)]
pub struct Retraction {
    chains: Vec<Chain>,
}

/// A beam.
#[derive(Clone, Debug)]
struct Chain {
    /// Its nodes.
    nodes: std::ops::Range<usize>,
    /// Those of them whose positions are fixed, or the first node if there are none.
    anchors: Vec<usize>,
}

impl Retraction {
    /// The retraction of `system`. Where constraint rows tie nodes to each other all increments are
    /// simply added, because the rows are linear.
    pub fn new(system: &System) -> Self {
        if system.multipliers() > 0 {
            return Self { chains: Vec::new() };
        }
        let held: Vec<usize> = system.supports().positions().collect();
        let chain = |beam: &crate::assembly::DiscretizedBeam| {
            let nodes = beam.first_node..beam.first_node + beam.basis.nodes().len();
            let mut anchors: Vec<usize> = held.iter().copied().filter(|node| nodes.contains(node)).collect();
            anchors.sort_unstable();
            if anchors.is_empty() {
                anchors.push(nodes.start);
            }
            Chain { nodes, anchors }
        };
        Self { chains: system.beams().iter().map(chain).collect() }
    }

    /// Whether increments turn vectors, and are not simply added.
    pub fn turns(&self) -> bool {
        !self.chains.is_empty()
    }

    /// Moves `x` by `increment`; the entries behind the coordinates are added.
    pub fn apply(&self, increment: &[f64], x: &mut [f64]) {
        let coordinates = self.chains.last().map_or(0, |chain| 4 * chain.nodes.end);
        let turning = increment[..coordinates].as_chunks::<4>().0;
        let largest = turning.iter().fold(0.0_f64, |m, d| m.max(d[2].abs()).max(d[3].abs()));
        let start = x[..coordinates].to_vec();
        x.iter_mut().zip(increment).for_each(|(x, d)| *x += d);
        if largest > SMALL {
            let (start, x) = (start.as_chunks::<4>().0, x[..coordinates].as_chunks_mut::<4>().0);
            self.chains.iter().for_each(|chain| chain.turn(start, turning, x));
        }
    }
}

impl Chain {
    /// `x` comes as `start + increment`.
    fn turn(&self, start: &[[f64; 4]], increment: &[[f64; 4]], x: &mut [[f64; 4]]) {
        let mut turns = Vec::with_capacity(self.nodes.len());
        for node in self.nodes.clone() {
            let [_, _, a, b] = start[node];
            let [_, _, da, db] = increment[node];
            let (gradient, turn) = turned([a, b], [da, db]);
            [x[node][2], x[node][3]] = gradient;
            turns.push(turn);
        }
        // How far every node lands from its linear place if the chords are joined end to end from
        // the first node on.
        let mut beside = Vec::with_capacity(self.nodes.len());
        let mut sum = [0.0; 2];
        beside.push(sum);
        for (i, node) in self.nodes.clone().skip(1).enumerate() {
            let difference = |v: &[[f64; 4]]| [v[node][0] - v[node - 1][0], v[node][1] - v[node - 1][1]];
            let (chord, change) = (difference(start), difference(increment));
            let (new, turn) = turned(chord, change);
            let (alpha, beta) = (turns[i] - turn, turns[i + 1] - turn);
            let shorter = 1.0 - (2.0 * alpha * alpha - alpha * beta + 2.0 * beta * beta) / 30.0;
            for d in 0..2 {
                sum[d] += shorter.max(0.0) * new[d] - (chord[d] + change[d]);
            }
            beside.push(sum);
        }
        let at = |node: usize| beside[node - self.nodes.start];
        let (first, last) = (self.anchors[0], self.anchors[self.anchors.len() - 1]);
        for node in self.nodes.clone() {
            // Between two anchors the gap is distributed in proportion to the distance; beyond the
            // outer ones it is that of the nearest.
            let next = self.anchors.partition_point(|anchor| *anchor <= node);
            let (left, right) = match next {
                0 => (first, first),
                _ if next == self.anchors.len() => (last, last),
                _ => (self.anchors[next - 1], self.anchors[next]),
            };
            let share = if right > left { (node - left) as f64 / (right - left) as f64 } else { 0.0 };
            let (here, left, right) = (at(node), at(left), at(right));
            for (d, x) in x[node][..2].iter_mut().enumerate() {
                *x += here[d] - ((1.0 - share) * left[d] + share * right[d]);
            }
        }
    }
}

/// A vector after its change, stretched and turned, and the angle.
fn turned([x, y]: [f64; 2], [dx, dy]: [f64; 2]) -> ([f64; 2], f64) {
    let inverse = 1.0 / (x * x + y * y);
    // The bound keeps an iterate far from the solution from compressing a vector until it reverses.
    let stretch = (1.0 + (x * dx + y * dy) * inverse).max(SHORTEST);
    let turn = (x * dy - y * dx) * inverse;
    let (sine, cosine) = turn.sin_cos();
    ([stretch * (cosine * x - sine * y), stretch * (sine * x + cosine * y)], turn)
}
