//! Forces that the state in which statics begins leaves unbalanced.
//!
//! Where an analysis starts from a state that other supports, joints or effects have held, the
//! forces of what has left and does not fade by itself, R₀ = f(q₀) + B₀ᵀ μ₀ − r₀, keep it where it is,
//! where r₀ and μ₀ are what those supports and joints did that are still there. They act on as
//! −(1 − λ) R₀ at the nodes, held ones included, and fade as the load factor grows: the path leads from
//! that state to the equilibrium of what is there now, and reactions begin with what they were.
//!
//! On the position of a node they are a force of fixed direction. On its gradient r' = |r'| t, with the
//! normal n, they are a couple M and a part T along the beam, as supports, joints, springs and moments
//! make them, whatever the angle by which the node turns:
//!
//! ```text
//! F = T t + M n/|r'|,    T = R₀·t₀,    M = r₀' × R₀.
//! ```

use super::System;
use crate::assembly::{
    Acting, ActingLoad, Action, Actions, Amplitude, Earlier, Effect, InternalVariables, Kind, Owner,
    Workspace, nodes, remaining,
};
use crate::linear::Matrix;
use crate::numeric::GOLDEN;
use std::ops::Range;

/// Forces above this many round-offs of the internal forces count.
const STRESSED: f64 = 100.0;

/// The state in which an analysis begins.
pub(super) struct Start {
    /// Its coordinates.
    pub q: Vec<f64>,
    /// Its scaled multipliers; empty where they are not known.
    pub multipliers: Vec<f64>,
    /// Its internal variables.
    pub variables: InternalVariables,
    /// Whether another analysis has left it, and not the scene given it.
    pub taken_up: bool,
}

impl Start {
    /// A shape that a scene gives.
    pub fn given(q: Vec<f64>) -> Self {
        Self { q, multipliers: Vec::new(), variables: InternalVariables::default(), taken_up: false }
    }
}

/// −R₀ on the nodes of one beam.
struct Imbalance {
    beam: usize,
    /// Arc lengths of the nodes \[m\].
    nodes: Vec<f64>,
    /// The coordinates of the beam.
    range: Range<usize>,
    /// −R₀ on each of them.
    forces: Vec<OnNode>,
}

/// Part of −R₀ on a node.
#[derive(Clone, Copy)]
struct OnNode {
    /// The force on its position \[N\].
    force: [f64; 2],
    /// T \[N m\].
    along: f64,
    /// M \[N m\].
    couple: f64,
}

impl OnNode {
    /// The generalised forces `[fx, fy, gx, gy]` in the state \[x, y, x', y'\].
    fn new([.., x, y]: [f64; 4], [fx, fy, gx, gy]: [f64; 4]) -> Self {
        Self { force: [fx, fy], along: (gx * x + gy * y) / x.hypot(y), couple: x * gy - y * gx }
    }

    fn is_zero(&self) -> bool {
        self.force == [0.0; 2] && self.along == 0.0 && self.couple == 0.0
    }

    /// The generalised forces in another state.
    fn in_state(&self, [.., x, y]: [f64; 4]) -> [f64; 4] {
        let length = x.hypot(y);
        let (t, n) = (self.along / length, self.couple / (length * length));
        [self.force[0], self.force[1], t * x - n * y, t * y + n * x]
    }

    /// Their derivative with respect to the gradient, (T/|r'|) n nᵀ − (M/|r'|²)(t nᵀ + n tᵀ): the entries
    /// xx, xy and yy.
    fn derivative(&self, [.., x, y]: [f64; 4]) -> [f64; 3] {
        let length = x.hypot(y);
        let (c, s) = (x / length, y / length);
        let (t, m) = (self.along / length, self.couple / (length * length));
        [t * s * s + 2.0 * m * c * s, -t * c * s - m * (c * c - s * s), t * c * c - 2.0 * m * c * s]
    }
}

impl Effect for Imbalance {
    fn kind(&self) -> Kind {
        Kind::Other("imbalance")
    }

    fn beam(&self) -> usize {
        self.beam
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn is_constant(&self) -> bool {
        self.forces.iter().all(|on| on.along == 0.0 && on.couple == 0.0)
    }

    fn is_conservative(&self) -> bool {
        false
    }

    // A couple has a potential only with an angle that counts full turns: its work is accumulated.
    fn energy(&self, _: &[f64]) -> f64 {
        0.0
    }

    fn add_force(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        let states = q[self.range.clone()].as_chunks::<4>().0;
        let sums = f[self.range.clone()].as_chunks_mut::<4>().0;
        for ((sum, z), on) in sums.iter_mut().zip(states).zip(&self.forces) {
            sum.iter_mut().zip(on.in_state(*z)).for_each(|(sum, force)| *sum += factor * force);
        }
    }

    fn add_force_and_tangent(
        &self,
        factor: f64,
        q: &[f64],
        _: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        _: &mut Workspace,
    ) {
        self.add_force(factor, q, f);
        let states = q[self.range.clone()].as_chunks::<4>().0;
        for ((node, z), on) in states.iter().enumerate().zip(&self.forces) {
            let (x, [xx, xy, yy]) = (self.range.start + 4 * node + 2, on.derivative(*z));
            let entries = [(x, x, xx), (x, x + 1, xy), (x + 1, x, xy), (x + 1, x + 1, yy)];
            entries.into_iter().for_each(|(i, j, entry)| k.add_at(i, j, factor * entry));
        }
    }

    fn add_tangent_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        let [q, v] = [q, v].map(|vector| vector[self.range.clone()].as_chunks::<4>().0);
        let sums = f[self.range.clone()].as_chunks_mut::<4>().0;
        for (((sum, z), [.., x, y]), on) in sums.iter_mut().zip(q).zip(v).zip(&self.forces) {
            let [xx, xy, yy] = on.derivative(*z);
            sum[2] += factor * (xx * x + xy * y);
            sum[3] += factor * (xy * x + yy * y);
        }
    }

    fn add_actions(&self, factor: f64, q: &[f64], _: &[f64], sum: &mut Actions) {
        let states = q[self.range.clone()].as_chunks::<4>().0;
        for ((s, z), on) in self.nodes.iter().zip(states).zip(&self.forces) {
            sum.add_point(*s, Action::of_node(*z, on.in_state(*z)) * -factor);
        }
    }

    fn size(&self) -> (usize, usize) {
        (0, size_of_val(&self.forces[..]))
    }
}

impl System {
    /// Begins in the state `q` with the internal `variables`: supports that follow no law hold the
    /// beams where they are in it, and rows that it misses close in proportion to the load factor.
    pub fn begin_in(&mut self, q: &[f64], variables: &InternalVariables) {
        self.freeze(q);
        self.constraints.iter_mut().for_each(|row| row.begin_open(q));
        self.begin_lengths_open(q);
        let (q, variables) = (q.to_vec(), variables.clone());
        self.start = Some(Start { q, multipliers: Vec::new(), variables, taken_up: true });
    }

    /// Begins with these scaled multipliers, and lets −`unbalanced` act on all nodes and fade.
    pub fn leave_unbalanced(&mut self, multipliers: &[f64], unbalanced: Option<&[f64]>) {
        let Some(start) = &mut self.start else { return };
        start.multipliers = multipliers.to_vec();
        let Some(unbalanced) = unbalanced else { return };
        for (beam, part) in self.beams.iter().enumerate() {
            let nodes = part.basis.nodes().to_vec();
            let range = 4 * part.first_node..4 * (part.first_node + nodes.len());
            let states = start.q[range.clone()].as_chunks::<4>().0;
            let on_nodes = unbalanced[range.clone()].as_chunks::<4>().0;
            let of_node = |(z, force): (&[f64; 4], &[f64; 4])| OnNode::new(*z, force.map(|force| -force));
            let forces: Vec<OnNode> = states.iter().zip(on_nodes).map(of_node).collect();
            if !forces.iter().all(OnNode::is_zero) {
                let effect = Box::new(Imbalance { beam, nodes, range, forces });
                let amplitude = Acting::NoLonger { time: 0.0 }.amplitude(None);
                self.terms.loads.push(ActingLoad { effect, amplitude });
            }
        }
        self.terms.belong_to(Owner::Gone(usize::MAX));
    }

    /// Norm of the forces of effects of these `kinds` on what is free in the state in which an analysis
    /// begins, without any load \[N\]; 0 where it is round-off: what these effects, and no others, make of that of the coordinates.
    pub fn force_at_start(&self, kinds: &[Kind]) -> f64 {
        self.force_of(&self.internal_of(kinds).collect::<Vec<_>>())
    }

    /// Whether any of these effects acts there, be it that all of them balance each other.
    pub fn is_stressed_at_start(&self, kinds: &[Kind]) -> bool {
        self.internal_of(kinds).any(|effect| self.force_of(&[effect]) > 0.0)
    }

    fn internal_of(&self, kinds: &[Kind]) -> impl Iterator<Item = &dyn Effect> {
        self.terms.internal.iter().map(AsRef::as_ref).filter(|effect| kinds.contains(&effect.kind()))
    }

    fn force_of(&self, effects: &[&dyn Effect]) -> f64 {
        if effects.is_empty() {
            return 0.0;
        }
        let q = self.start();
        let units = [self.length, self.length, 1.0, 1.0].into_iter().cycle();
        // Of all signs and sizes, so that neither a spring along an axis nor one between two nodes sees none of it.
        let part = |i: usize| 2.0 * (i as f64 * GOLDEN).fract() - 1.0;
        let off: Vec<f64> = (q.iter().zip(units).enumerate())
            .map(|(i, (q, unit))| f64::EPSILON * unit.max(q.abs()) * part(i))
            .collect();
        let mut round_off = vec![0.0; self.coordinates()];
        let mut force = vec![0.0; self.coordinates()];
        for effect in effects {
            effect.add_tangent_product(1.0, q, &off, &mut round_off);
            effect.add_force(1.0, q, &mut force);
        }
        let force = self.norm_of_free(force);
        if force > STRESSED * self.norm(&round_off) { force } else { 0.0 }
    }

    /// Norm of the internal forces of effects of some kinds on what is free in the state `q` \[N\], round-off included.
    pub fn internal_force(&self, q: &[f64], counts: impl Fn(Kind) -> bool) -> f64 {
        let mut force = vec![0.0; self.coordinates()];
        for effect in self.terms.internal.iter().filter(|effect| counts(effect.kind())) {
            effect.add_force(1.0, q, &mut force);
        }
        self.norm_of_free(force)
    }

    /// The norm of forces without those on coordinates that are fixed.
    fn norm_of_free(&self, mut force: Vec<f64>) -> f64 {
        self.supports.to_frames(0.0, &mut force);
        force.iter_mut().zip(&self.fixed).filter(|(_, fixed)| **fixed).for_each(|(force, _)| *force = 0.0);
        self.norm(&force)
    }

    /// Whether anything fades as the load factor grows.
    pub fn is_fading(&self) -> bool {
        self.terms.loads.iter().any(|load| matches!(load.amplitude, Some(Amplitude::Fading { .. })))
    }

    /// Whether at the load factor `load` something that has gone still acts, or something that is to
    /// hold is still open.
    pub fn is_between(&self, load: f64) -> bool {
        let rows = || self.constraints.iter().any(|row| row.begins_open(self.length));
        let lengths = || self.terms.held.iter().any(|length| length.remains_open(load) != 0.0);
        remaining(load)[0] > 0.0 && (self.is_fading() || rows() || lengths())
    }

    /// Whether an analysis begins in a state that another one has left.
    pub fn is_taken_up(&self) -> bool {
        self.start.as_ref().is_some_and(|start| start.taken_up)
    }

    /// The scaled multipliers and the internal variables with which an analysis begins.
    pub fn start_history(&self) -> (&[f64], InternalVariables) {
        let of = |start: &'_ Start| start.variables.clone();
        let multipliers = self.start.as_ref().map_or(&[][..], |start| &start.multipliers);
        (multipliers, self.start.as_ref().map(of).unwrap_or_default())
    }

    /// What is left of the forces R = f(q) + Bᵀ μ in statics at load factor 0, in fixed axes, if
    /// supports at nodes take up as much as they did: `supports` are forces on coordinates. Where
    /// that is not known, they take up all. `x` holds the coordinates and the scaled multipliers, and
    /// `variables` are the internal variables.
    pub fn unbalanced(
        &self,
        x: &[f64],
        variables: &InternalVariables,
        supports: Option<&[f64]>,
    ) -> Unbalanced {
        let (q, multipliers) = x.split_at(self.coordinates());
        let mut force = vec![0.0; q.len()];
        self.force(0.0, q, &mut force);
        self.add_known_history(variables, q, &mut force);
        self.add_constraint_forces(0.0, q, multipliers, &mut force);
        let mut taken = force.clone();
        self.supports.keep_fixed(0.0, &mut taken);
        let mut on_fixed = 0.0;
        if let Some(supports) = supports {
            let mut before = supports.to_vec();
            self.supports.keep_fixed(0.0, &mut before);
            taken.iter_mut().zip(&before).for_each(|(taken, before)| *taken -= before);
            let left = self.largest(&taken);
            on_fixed = if left > STRESSED * self.round_off { left / self.largest(&force) } else { 0.0 };
            taken = before;
        }
        force.iter_mut().zip(&taken).for_each(|(force, taken)| *force -= taken);
        Unbalanced { force, on_fixed }
    }

    /// The largest generalised force on a coordinate \[N\]; those on gradients count by the length of
    /// the structure.
    fn largest(&self, force: &[f64]) -> f64 {
        nodes(force).fold(0.0, |largest: f64, node| largest.max(node.shift()).max(node.slope() / self.length))
    }
}

/// Forces that nothing takes up in the state in which statics begins.
pub struct Unbalanced {
    /// On all coordinates.
    pub force: Vec<f64>,
    /// The largest on coordinates that supports fix, in the largest of all forces.
    pub on_fixed: f64,
}
