//! Forces of supports and joints on the beams.
//!
//! A support at a node acts on the fixed coordinates with R = M q̈ + f; a support between nodes, or
//! a joint, acts with −Bᵀμ. A generalised force F' on a gradient r' is the moment r' × F' on the
//! section, because δW = F'·δr' = M δθ with δr' = δθ J r', where J is the quarter turn.

use super::System;
use crate::assembly::{InternalVariables, Kind, Owner};
use crate::model::{FixedRotation, Support};
use std::collections::HashMap;
use std::ops::Range;

/// A force \[N\] and a moment \[N m\] on a beam, in fixed axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Reaction {
    /// Along x.
    pub fx: f64,
    /// Along y.
    pub fy: f64,
    /// Counter-clockwise.
    pub moment: f64,
}

/// The place where a support or joint acts.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Source {
    /// The fixed components of a node.
    Node { node: usize, position: [bool; 2], rotation: bool },
    /// The indices of constraint rows.
    Rows(Range<usize>),
}

impl Source {
    pub(super) fn node(node: usize, support: &Support) -> Self {
        let rotation = support.fix.rotation != FixedRotation::Free;
        Self::Node { node, position: [support.fix.x, support.fix.y], rotation }
    }
}

/// The moment r' × F'.
fn moment(gradient: [f64; 2], force: [f64; 2]) -> f64 {
    gradient[0] * force[1] - gradient[1] * force[0]
}

impl System {
    /// Forces on the beams of all supports, and then of all joints (on their second points), in the
    /// model's order. `support_forces` are the forces on fixed coordinates in fixed axes,
    /// `multipliers` the scaled μ.
    pub fn reactions(
        &self,
        parameter: f64,
        q: &[f64],
        support_forces: &[f64],
        multipliers: &[f64],
    ) -> Vec<Reaction> {
        let of = |source: &Source| match source {
            Source::Node { node, position, rotation } => {
                let (q, f) = (&q[4 * node..4 * node + 4], &support_forces[4 * node..4 * node + 4]);
                let component = |axis: usize| if position[axis] { f[axis] } else { 0.0 };
                let moment = if *rotation { moment([q[2], q[3]], [f[2], f[3]]) } else { 0.0 };
                Reaction { fx: component(0), fy: component(1), moment }
            }
            Source::Rows(rows) => {
                let mut sum = Reaction::default();
                for (constraint, mu) in self.constraints[rows.clone()].iter().zip(&multipliers[rows.clone()])
                {
                    let mu = -mu * constraint.scale(self.stiffness, self.length);
                    let (normal, field) = constraint.last_field(parameter, q);
                    let force = normal.map(|n| mu * n);
                    match field {
                        None => {
                            sum.fx += force[0];
                            sum.fy += force[1];
                        }
                        Some(gradient) => sum.moment += moment(gradient, force),
                    }
                }
                sum
            }
        };
        self.sources.iter().map(of).collect()
    }

    /// As [`Self::reactions`], in equilibrium; `x` holds the coordinates and the scaled
    /// multipliers, and `variables` are the internal variables.
    pub fn static_reactions(&self, load: f64, x: &[f64], variables: &InternalVariables) -> Vec<Reaction> {
        let (q, multipliers) = x.split_at(self.coordinates());
        self.reactions(load, q, &self.static_support_forces(load, x, variables), multipliers)
    }

    /// Forces of supports on the fixed coordinates in equilibrium, in fixed axes.
    pub fn static_support_forces(&self, load: f64, x: &[f64], variables: &InternalVariables) -> Vec<f64> {
        let mut force = self.static_forces(load, x, variables);
        self.supports.keep_fixed(load, &mut force);
        force
    }

    /// What is left of all forces but those of supports on fixed coordinates, in fixed axes: in equilibrium these are their opposites, and
    /// zero on free coordinates.
    fn static_forces(&self, load: f64, x: &[f64], variables: &InternalVariables) -> Vec<f64> {
        let (q, multipliers) = x.split_at(self.coordinates());
        let mut force = vec![0.0; q.len()];
        self.force(load, q, &mut force);
        self.add_known_history(variables, q, &mut force);
        self.add_constraint_forces(load, q, multipliers, &mut force);
        force
    }

    /// What is left of the forces on free coordinates in a state that counts as an equilibrium, in fixed axes.
    pub fn imbalance(&self, load: f64, x: &[f64], variables: &InternalVariables) -> Vec<f64> {
        let mut left = self.static_forces(load, x, variables);
        let mut fixed = left.clone();
        self.supports.keep_fixed(load, &mut fixed);
        left.iter_mut().zip(&fixed).for_each(|(left, fixed)| *left -= fixed);
        left
    }

    /// The energies \[J\] of the contacts with obstacles in the state `q`, each with the number of its part and the index of its
    /// beam.
    pub fn contact_energies<'a>(&'a self, q: &'a [f64]) -> impl Iterator<Item = (usize, usize, f64)> + 'a {
        let effects = self.terms.internal.iter().zip(&self.terms.owners.internal);
        effects.filter(|(effect, _)| effect.kind() == Kind::Contact).filter_map(|(effect, owner)| match owner
        {
            Owner::Part(part) => Some((*part, effect.beam(), effect.energy(q))),
            Owner::Beam(_) | Owner::Gone(_) => None,
        })
    }

    /// Per effect of the model: its name (kind and beam, and a number where a beam has several of a kind,
    /// in the order of the model), its energy \[J\] if it has one, and the resultant \[N\] of its
    /// forces on the beam.
    pub fn effects(
        &self,
        parameter: f64,
        q: &[f64],
        velocity: Option<&[f64]>,
        variables: &InternalVariables,
    ) -> Vec<(String, Option<f64>, [f64; 2])> {
        let mut f = vec![0.0; q.len()];
        let resultant = |f: &mut Vec<f64>| {
            let sum = super::sums::resultant(f);
            f.fill(0.0);
            sum
        };
        let (terms, owners) = (&self.terms, &self.terms.owners);
        let mut out = Reported::default();
        for (effect, owner) in terms.internal.iter().zip(&owners.internal) {
            effect.add_force(1.0, q, &mut f);
            out.add(effect.kind(), effect.beam(), *owner, Some(effect.energy(q)), resultant(&mut f));
        }
        for (load, owner) in terms.loads.iter().zip(&owners.loads) {
            let amplitude = self.amplitude_of(load).at(parameter);
            load.effect.add_force(amplitude, q, &mut f);
            let energy = load.effect.is_conservative().then(|| amplitude * load.effect.energy(q));
            out.add(load.effect.kind(), load.effect.beam(), *owner, energy, resultant(&mut f));
        }
        for (load, owner) in terms.timed_loads.iter().zip(&owners.timed_loads) {
            load.add_force(1.0, parameter, q, &mut f);
            out.add(load.kind(), load.beam(), *owner, None, resultant(&mut f));
        }
        for (friction, owner) in terms.friction.iter().zip(&owners.friction) {
            friction.add_force_of(variables, q, &mut f);
            out.add(Kind::Friction, friction.beam(), *owner, None, resultant(&mut f));
        }
        for ((winding, angle), owner) in terms.windings.iter().zip(&variables.angles).zip(&owners.windings) {
            out.add(Kind::TorsionSpring, winding.beam(), *owner, Some(winding.energy(*angle)), [0.0; 2]);
        }
        if let Some(v) = velocity {
            for (effect, owner) in terms.inertia.iter().zip(&owners.inertia) {
                out.add(effect.kind(), effect.beam(), *owner, Some(effect.energy(v)), [0.0; 2]);
            }
            for ((kind, beam, energy), owner) in self.turning_energies(q, v).zip(&owners.turning) {
                out.add(kind, beam, *owner, Some(energy), [0.0; 2]);
            }
            for (damping, owner) in terms.damping.iter().zip(&owners.damping) {
                damping.add_force(q, v, &mut f);
                out.add(damping.kind(), damping.beam(), *owner, None, resultant(&mut f));
            }
        }
        out.named(|beam| &self.beams[beam].name)
    }
}

/// The name of its kind, the beam, and what has added its terms.
type Identity = (&'static str, usize, Owner);

/// Energies and forces of effects, each of which may consist of several terms.
#[derive(Default)]
struct Reported {
    effects: Vec<(Identity, Option<f64>, [f64; 2])>,
    places: HashMap<Identity, usize>,
}

impl Reported {
    /// Adds a term to the effect of its kind, beam and owner.
    fn add(&mut self, kind: Kind, beam: usize, owner: Owner, energy: Option<f64>, [fx, fy]: [f64; 2]) {
        let (identity, end) = ((kind.name(), beam, owner), self.effects.len());
        let place = *self.places.entry(identity).or_insert(end);
        if place == end {
            self.effects.push((identity, None, [0.0; 2]));
        }
        let (_, of_all, force) = &mut self.effects[place];
        *of_all = energy.map(|energy| energy + of_all.unwrap_or(0.0)).or(*of_all);
        *force = [force[0] + fx, force[1] + fy];
    }

    /// Names the effects, with numbers where a beam has several of a kind: `force.arm.1`,
    /// `force.arm.2`.
    fn named<'n>(self, name: impl Fn(usize) -> &'n str) -> Vec<(String, Option<f64>, [f64; 2])> {
        let mut of_a_kind: HashMap<(&str, usize), Vec<Owner>> = HashMap::new();
        for ((kind, beam, owner), ..) in &self.effects {
            of_a_kind.entry((kind, *beam)).or_default().push(*owner);
        }
        of_a_kind.values_mut().for_each(|owners| owners.sort_unstable());
        let named = |&((kind, beam, owner), energy, force): &(Identity, _, _)| {
            let owners = &of_a_kind[&(kind, beam)];
            let number = owners.partition_point(|other| *other <= owner);
            let name = format!("{kind}.{}", name(beam));
            (if owners.len() == 1 { name } else { format!("{name}.{number}") }, energy, force)
        };
        self.effects.iter().map(named).collect()
    }
}
