//! Gradients of welded nodes in polar coordinates.
//!
//! A weld ties the directions of two gradients and leaves their lengths free: θ_b − θ_a = φ. In
//! components of r' this is not linear, and a motion under this constraint would be a
//! differential-algebraic system of index 3. With the length y and the direction θ as unknowns,
//!
//! ```text
//! r' = y e,   ṙ' = ẏ e + y θ̇ n,   r̈' = (ÿ − y θ̇²) e + (2 ẏ θ̇ + y θ̈) n
//! e = (cos θ, sin θ),   n = (−sin θ, cos θ)
//! f → Pᵀ f,   K → Pᵀ K P,   P = ∂r'/∂(y, θ) = [e, y n]
//! ```
//!
//! the constraint is linear with constant rows, and the motion is an ordinary differential equation
//! on the subspace that the rows leave. Every method keeps its order, and Gauss methods conserve
//! the energy as well as elsewhere. The change of P would add f·∂²r'/∂(y, θ)² to a tangent; it
//! vanishes where forces and inertia balance, and is neglected.

use super::System;
use crate::linear::Matrix;

/// The pairs of coordinates, 2·pair and 2·pair + 1, that are described by polar coordinates in a
/// motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polar {
    pairs: Vec<usize>,
    /// The nodes of each weld, and the first of its rows, which are those of its position.
    welds: Vec<([usize; 2], usize)>,
    /// The nodes of sliders, whose rows have a direction that does not turn.
    sliders: Vec<usize>,
}

/// The columns e and y n of P for the gradient (x, y).
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
    /// Polar coordinates for the given pairs, which are at the nodes of these welds, with the first row of each. Others are nodes of
    /// sliders.
    pub fn new(mut pairs: Vec<usize>, welds: Vec<([usize; 2], usize)>, sliders: Vec<usize>) -> Self {
        pairs.sort_unstable();
        pairs.dedup();
        Self { pairs, welds, sliders }
    }

    /// The nodes of the welds between two nodes.
    pub fn welds(&self) -> impl Iterator<Item = [usize; 2]> {
        self.welds.iter().map(|(nodes, _)| *nodes)
    }

    /// Whether there are no such pairs.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// The nodes of the pairs.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.pairs.iter().map(|pair| pair / 2)
    }

    /// Replaces (y, θ) and its first two rates by r', ṙ', r̈'.
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

    /// Replaces r' and ṙ' by (y, θ) and its rates: the inverse of [`Self::carry`], with θ from −π
    /// to π.
    pub fn uncarry(&self, q: &mut [f64], v: &mut [f64]) {
        for &pair in &self.pairs {
            let (q, v) = (of(q, pair), of(v, pair));
            let ([x, y], [e, yn]) = (*q, tangents(*q));
            let length = x.hypot(y);
            *v = [dot(e, *v), dot(yn, *v) / (length * length)];
            *q = [length, y.atan2(x)];
        }
    }

    /// Replaces f by Pᵀ f; `q` is the state in fixed axes.
    pub fn forces(&self, q: &[f64], f: &mut [f64]) {
        for &pair in &self.pairs {
            let f = of(f, pair);
            *f = tangents([q[2 * pair], q[2 * pair + 1]]).map(|t| dot(t, *f));
        }
    }

    /// Replaces d by P d; `q` is the state in fixed axes.
    pub fn changes(&self, q: &[f64], d: &mut [f64]) {
        for &pair in &self.pairs {
            let d = of(d, pair);
            let ([e, yn], [along, turn]) = (tangents([q[2 * pair], q[2 * pair + 1]]), *d);
            *d = std::array::from_fn(|i| along * e[i] + turn * yn[i]);
        }
    }

    /// Replaces K by Pᵀ K P; `q` is the state in fixed axes.
    pub fn matrix(&self, q: &[f64], k: &mut Matrix) {
        for &pair in &self.pairs {
            k.change_pair(pair, tangents([q[2 * pair], q[2 * pair + 1]]));
        }
    }
}

impl System {
    /// Whether [`Self::carry`] changes anything: a support moves with time, or gradients are
    /// described by polar coordinates.
    pub fn carries(&self) -> bool {
        self.supports.moves_in_time() || !self.polar.is_empty()
    }

    /// Whether the frames of some unknowns of a motion rotate.
    pub fn turns(&self) -> bool {
        self.supports.turn_in_time() || !self.polar.is_empty()
    }

    /// Pairs of unknowns that turn as a welded node does, whose direction θ is an unknown: θ, and the first of the pair. They are the
    /// position of the node, and the force in the weld. A node of which a support or a slider fixes one component of the position keeps
    /// its axes, and so do those that are welded to it.
    pub fn turning_pairs(&self) -> Vec<[usize; 2]> {
        let Polar { pairs, welds, sliders } = &self.polar;
        let mut still: Vec<usize> = self.supports.half_fixed().chain(sliders.iter().copied()).collect();
        let turns = |still: &[usize], node: &usize| {
            !still.contains(node) && pairs.binary_search(&(2 * node + 1)).is_ok()
        };
        loop {
            let mut held = welds.iter().filter(|(nodes, _)| nodes.iter().any(|node| !turns(&still, node)));
            let next = held.find_map(|(nodes, _)| nodes.iter().find(|node| turns(&still, node)));
            let Some(next) = next else { break };
            still.push(*next);
        }
        let direction = |node: usize| 4 * node + 3;
        let nodes = self.polar.nodes().filter(|node| turns(&still, node));
        let positions = nodes.map(|node| [direction(node), 4 * node]);
        let welds = welds.iter().filter(|(nodes, _)| nodes.iter().all(|node| turns(&still, node)));
        let forces = welds.map(|([node, _], row)| [direction(*node), self.coordinates() + row]);
        positions.chain(forces).collect()
    }

    /// Transforms the unknowns of a motion to positions, velocities and accelerations in fixed
    /// axes.
    pub fn carry(&self, time: f64, [q, v, a]: [&mut [f64]; 3]) {
        self.supports.carry(time, [&mut *q, &mut *v, &mut *a]);
        self.polar.carry([q, v, a]);
    }

    /// Transforms positions and velocities in fixed axes to the unknowns of a motion: the inverse
    /// of [`Self::carry`].
    pub fn uncarry(&self, time: f64, q: &mut [f64], v: &mut [f64]) {
        self.supports.uncarry(time, q, v);
        self.polar.uncarry(q, v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Needs;
    use crate::model::{Beam, Discretization, Fixed, Joint, Model, Place, Section, Support};

    #[test]
    fn rates_are_derivatives() {
        // y = 1.1 + 0.3 t − 0.2 t², θ = 2 + 1.7 t + 0.4 t².
        let polar = Polar::new(vec![1, 1], Vec::new(), Vec::new());
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

    /// Four beams begin in one point: the first is hinged to the second, and the others are welded to that. Both unknowns of a position
    /// and of the force of each weld turn, unless a support or a slider holds one component of one of the positions.
    #[test]
    fn positions_and_forces_turn_with_welded_nodes() {
        let of = |held: Option<usize>, slides: Option<usize>| {
            let beam = |end: [f64; 2]| {
                let section = Section { mass_per_length: Some(1.0.into()), ..Section::new(1.0, 1.0) };
                Beam::line("arm", [0.0, 0.0], end, section, Discretization::ancf(1))
            };
            let ends = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
            let at = |beam: usize| Place::new(beam, 0.0);
            let fix = Fixed { y: true, ..Fixed::default() };
            let supports = held.map(|beam| Support { at: at(beam), fix, ..Support::default() });
            let model = Model {
                beams: ends.map(beam).into(),
                supports: supports.into_iter().collect(),
                joints: [
                    Joint::Hinge { first: at(0), second: at(1) },
                    Joint::Weld { first: at(1), second: at(2) },
                    Joint::Weld { first: at(2), second: at(3) },
                ]
                .into_iter()
                .chain(slides.map(|beam| Joint::Slider { at: at(beam), along: [1.0, 1.0] }))
                .collect(),
                ..Model::default()
            };
            System::build(&model, Needs { inertia: true, motion: true }).expect("a system").turning_pairs()
        };
        // Nodes 2, 4 and 6, and the two rows of each weld behind those of the hinge.
        assert_eq!(of(None, None), [[11, 8], [19, 16], [27, 24], [11, 34], [19, 37]]);
        assert!(of(Some(3), None).is_empty() && of(None, Some(2)).is_empty());
        assert_eq!(of(Some(0), None).len(), 5);
    }
}
