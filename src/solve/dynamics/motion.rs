//! The equations of motion of a system, in the form that all integrators ask for.
//!
//! ```text
//! M q̈ + f(q, t) + f_d(q, q̇) + Bᵀ μ = 0,   g(q) = 0,   f = f_int + f_load
//! ```
//!
//! Coordinates that supports fix or prescribe at nodes are eliminated from every matrix *before* it
//! is factorised, the mass matrix included: solving with the mass matrix of the free beam and
//! clearing the fixed components afterwards would give all others wrong accelerations. Supports
//! between nodes and joints are linear in q with constant rows, so that a method which satisfies
//! them in its stages integrates an ordinary differential equation on the subspace g(q) = 0, with
//! all of its order.
//!
//! # Inextensible beams
//! Their constraint rows depend on the gradients, and the equations are differential-algebraic of
//! index 3: the constraint is an equation of every stage, and after a step positions and velocities
//! are put back onto it ([`Motion::project`]; Hairer, Wanner, *Solving Ordinary Differential
//! Equations II*, 1996, ch. VII). This needs a method that damps infinite frequencies: Radau IIA,
//! or generalised-α with ρ∞ < 1. Gauss' methods and the trapezoidal rule carry an error of the
//! axial force on from step to step, undamped, and are refused.
//!
//! # Welds
//! The gradients of welded nodes are polar: length y and direction θ are the unknowns, in which a
//! weld's rows are linear and constant ([`crate::system::polar`]). Rows and forces are computed in
//! fixed axes and turned into these unknowns; the mass matrix then depends on the state.
//!
//! # Supports that move
//! A coordinate prescribed by a law of time has its exact value, velocity and acceleration in every
//! stage, whatever the method; the others again satisfy an ordinary differential equation. Where
//! the *direction* θ(t) of a gradient is prescribed, its length y along that direction is the
//! unknown, and the method integrates (y, ẏ). Only this module converts to fixed axes, with the
//! centrifugal and Coriolis terms of the turning direction
//! ([`crate::system::supports::Supports::carry`]). The mass matrix in that frame turns too and is
//! formed anew with each tangent.

mod laws;
mod projection;
mod reactions;

pub use projection::StepMatrix;
pub use reactions::{Balance, StageState};

use super::State;
use super::turns::{PairTurns, Turns};
use crate::assembly::{AcceptedState, Earlier, Node, Workspace, nodes};
use crate::lanes::{Lanes, Real};
use crate::linear::bordered::BorderRow;
use crate::linear::complex::ComplexFactor;
use crate::linear::isotropic::Inertia;
use crate::linear::{Factor, Matrix, NOT_FACTORISED, Singular};
use crate::solve::Statistics;
use crate::solve::equilibrium::{self, Largest, balance, negate};
use crate::system::System;
use crate::threads;
use faer::c64;
use std::borrow::Cow;

/// Velocities and accelerations of the unknowns at a time.
#[derive(Clone, Copy, Debug)]
pub struct Rates<'r> {
    /// Time \[s\].
    pub time: f64,
    /// Velocities; read only where [`Motion::needs_velocity`] says so.
    pub v: &'r [f64],
    /// Accelerations.
    pub a: Acceleration<'r>,
}

/// The acceleration c q + e as a function of the unknowns q: it is evaluated where it is needed,
/// and no vector holds it.
#[derive(Clone, Copy, Debug)]
pub struct Acceleration<'r> {
    /// c \[1/s²\].
    pub factor: f64,
    /// e.
    pub rest: &'r [f64],
}

impl<'r> Acceleration<'r> {
    /// An acceleration that does not depend on the unknowns.
    pub fn constant(rest: &'r [f64]) -> Self {
        Self { factor: 0.0, rest }
    }
}

/// Forces, tangent and mass of a system in motion. Unknowns are the system's coordinates followed
/// by the scaled multipliers.
pub struct Motion<'a> {
    pub(super) system: &'a System,
    pub(super) mass: Inertia,
    /// The mass matrix in the supports' frames, with zeros for the fixed coordinates.
    free_mass: Matrix,
    /// The same with diagonal entries for the fixed coordinates.
    eliminated_mass: Matrix,
    mass_factor: Option<Factor>,
    /// The constraint rows with which it is factorised.
    mass_border: Vec<BorderRow>,
    /// The mass matrix without constraint rows, where these follow the state and the mass does not.
    without_rows: Option<Factor>,
    rows_factor: RowsFactor,
    border: Vec<BorderRow>,
    /// Whether the last step is much too long for vibrations of the mesh.
    pub vibrates: bool,
    /// About the square ω² \[1/s²\] of the fastest vibration with the last tangent, where constraint rows depend on the state.
    fastest: f64,
    /// Tangent of elastic forces and loads in the supports' frames, fixed coordinates eliminated.
    tangent: Matrix,
    /// Damping matrix in the same form; none if no force depends on velocities.
    damping: Option<Matrix>,
    /// Whether unknowns must be converted to coordinates in fixed axes: with supports that move in
    /// time, and with polar gradients.
    pub(super) carries: bool,
    /// Whether the constraint rows depend on the state.
    follows: bool,
    workspace: Workspace,
    /// Receives the force that is computed along with a tangent.
    force: Vec<f64>,
    scratch: Vec<f64>,
    /// The last accepted state, for friction.
    pub(super) accepted: AcceptedState,
    /// Working memory for the forces of several states at once.
    pub(super) side_by_side: [Vec<f64>; 2],
    /// The scaled multipliers of the last accelerations.
    multipliers: Vec<f64>,
    /// Positions, velocities and accelerations in fixed axes, where supports move.
    carried: [Vec<f64>; 3],
    /// Counts so far.
    pub statistics: Statistics,
}

/// The mass matrix with the constraint rows of a tangent.
#[derive(Debug, Default)]
struct RowsFactor {
    factor: Option<Factor>,
    /// Whether the rows are those of the last tangent.
    is_of_tangent: bool,
}

/// Whether the mass matrix of the unknowns depends on the state.
fn turns_mass(system: &System) -> bool {
    system.turns() || system.has_turning_inertia()
}

/// The mass matrix of the unknowns in the state `q`, given in fixed axes, with the fixed
/// coordinates eliminated: once with zeros on their diagonal, and once so that it can be
/// factorised.
fn free_mass(system: &System, time: f64, q: &[f64], mass: &Inertia) -> [Matrix; 2] {
    let mut free = mass.to_matrix();
    system.add_turning_mass(q, &mut free);
    system.supports().turn_matrix(time, &mut free);
    system.polar().matrix(q, &mut free);
    let mut eliminated = free.clone();
    system.supports().eliminate(time, &mut eliminated);
    system.supports().clear_fixed(time, &mut free);
    [free, eliminated]
}

impl<'a> Motion<'a> {
    /// The equations of motion of `system`, which must have been built with inertia.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn new(system: &'a System) -> Result<Self, Singular> {
        let n = system.coordinates();
        let mass = Inertia::new(system.mass_matrix());
        let mut border = Vec::new();
        system.border_in_motion(0.0, system.start(), &mut border);
        let [free_mass, eliminated_mass] = free_mass(system, 0.0, system.start(), &mass);
        let mass_factor = Some(Factor::definite(None, &eliminated_mass, &border)?);
        let (carries, follows) = (system.carries(), system.has_nonlinear_constraints());
        let follow_alone = follows && !turns_mass(system);
        let without_rows = follow_alone.then(|| Factor::definite(None, &eliminated_mass, &[])).transpose()?;
        let carried = if carries { n } else { 0 };
        Ok(Self {
            system,
            mass,
            free_mass,
            eliminated_mass,
            mass_factor,
            mass_border: Vec::new(),
            without_rows,
            rows_factor: RowsFactor::default(),
            border,
            vibrates: false,
            fastest: 0.0,
            tangent: system.matrix(),
            damping: system.is_damped().then(|| system.damping_pattern()),
            carries,
            follows,
            workspace: Workspace::default(),
            force: vec![0.0; n],
            side_by_side: [0; 2].map(|_| vec![0.0; n]),
            accepted: AcceptedState { q: system.start().to_vec(), ..AcceptedState::default() },
            scratch: vec![0.0; if system.is_damped() { n } else { 0 }],
            multipliers: vec![0.0; system.multipliers()],
            carried: [0; 3].map(|_| vec![0.0; carried]),
            statistics: Statistics { factorizations: 1, ..Statistics::default() },
        })
    }

    /// Makes a state the last accepted one, from which internal variables are counted.
    pub fn set_accepted(&mut self, state: &State) {
        if self.system.has_history() {
            self.accepted = AcceptedState { q: state.q.clone(), variables: state.variables.clone() };
        }
    }

    /// By how much friction in the state `end` would differ had these states of the unknowns been accepted on the way
    /// there, in the supports' frames.
    pub fn forgotten_friction(&self, passed: impl Iterator<Item = State>, end: &State) -> Vec<f64> {
        let mut accepted = self.accepted.clone();
        for mut state in passed {
            self.carry(&mut state);
            let variables = self.system.internal_variables(&accepted, &state.q);
            accepted = AcceptedState { q: state.q, variables };
        }
        let n = self.coordinates();
        let mut force = vec![0.0; self.unknowns()];
        self.system.add_friction(&self.accepted, &end.q, &mut force[..n]);
        force.iter_mut().for_each(|f| *f = -*f);
        self.system.add_friction(&accepted, &end.q, &mut force[..n]);
        self.system.supports().to_frames(end.time, &mut force[..n]);
        self.system.polar().forces(&end.q, &mut force[..n]);
        force
    }

    /// Whether tangents depend on the path to the last accepted state: with friction, and with
    /// torsion springs that are wound up.
    pub fn remembers(&self) -> bool {
        self.system.has_friction() || self.accepted.variables.winding != 0.0
    }

    /// The system that moves.
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// The scaled multipliers of the last accelerations.
    pub fn multipliers(&self) -> &[f64] {
        &self.multipliers
    }

    /// Turns of the nodes, for a tangent that turns with them.
    pub fn turns(&self) -> Turns {
        Turns::new(self.coordinates() / 4, self.still(), self.turning_pairs())
    }

    /// Pairs of unknowns that turn with a tangent while their nodes do not.
    pub fn turning_pairs<T: Real>(&self) -> PairTurns<T> {
        PairTurns::new(self.system.turning_pairs())
    }

    /// Nodes with which a tangent is not turned as a whole: a fixed component of a position must keep its
    /// axis, and polar gradients contain the turn themselves.
    pub fn still(&self) -> Vec<usize> {
        self.system.supports().half_fixed().chain(self.system.polar().nodes()).collect()
    }

    /// Whether lengths are kept, whose rows are quadratic in the coordinates.
    pub fn keeps_lengths(&self) -> bool {
        self.follows
    }

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.system.coordinates()
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.system.coordinates() + self.system.multipliers()
    }

    /// Whether a residual depends on velocities: through damping, or through turning frames,
    /// gradients or inertias.
    pub fn needs_velocity(&self) -> bool {
        self.damping.is_some() || self.system.has_turning_inertia() || self.system.turns()
    }

    /// Factorises the mass matrix of the unknowns with the constraint rows, at `time` in the state
    /// `q` in fixed axes, if they are not constant. The mass matrix and rows that belong to the
    /// tangent stay as they are, so that a motion continued from a saved state finds the same.
    fn mass_at(&mut self, time: f64, q: &[f64]) -> Result<(), Singular> {
        let mass_turns = turns_mass(self.system);
        if mass_turns {
            [_, self.eliminated_mass] = free_mass(self.system, time, q, &self.mass);
        }
        if mass_turns || self.follows {
            self.system.border_in_motion(time, q, &mut self.mass_border);
            let earlier = self.mass_factor.take();
            self.mass_factor = Some(Factor::definite(earlier, &self.eliminated_mass, &self.mass_border)?);
        }
        Ok(())
    }

    /// Accelerations of the unknowns in the state `state` of unknowns.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn acceleration(&mut self, state: &State, acceleration: &mut [f64]) -> Result<(), Singular> {
        let mut forces = self.free_forces(state);
        self.accelerate(state, &mut forces)?;
        let n = self.coordinates();
        acceleration.copy_from_slice(&forces[..n]);
        self.multipliers.copy_from_slice(&forces[n..]);
        Ok(())
    }

    /// −f, and −B q̈ of moving supports and turning directions, with zero accelerations of the
    /// unknowns.
    fn free_forces(&mut self, state: &State) -> Vec<f64> {
        let n = self.coordinates();
        let mut forces = vec![0.0; self.unknowns()];
        let still = vec![0.0; n];
        let mut x = state.q.clone();
        x.resize(self.unknowns(), 0.0);
        let a = Acceleration::constant(&still);
        self.residual(&x, Rates { time: state.time, v: &state.v, a }, &mut forces);
        let [q, v, supported] = match &self.carried {
            [q, v, a] if self.carries => [&q[..n], &v[..], &a[..]],
            _ => [&state.q[..], &state.v[..], &still[..]],
        };
        self.system.constraint_rates(state.time, q, supported, &mut forces[n..]);
        self.system.add_constraint_curvatures(q, v, &mut forces[n..]);
        self.system.add_prescribed_rates(2, state.time, &mut forces[n..]);
        forces
    }

    /// Replaces the forces of [`Self::free_forces`] by the accelerations of the unknowns and
    /// multipliers.
    fn accelerate(&mut self, state: &State, forces: &mut [f64]) -> Result<(), Singular> {
        let mut fixed = Cow::Borrowed(state);
        if self.carries {
            self.carry(fixed.to_mut());
        }
        self.mass_at(state.time, &fixed.q)?;
        self.mass_factor.as_ref().expect(NOT_FACTORISED).solve(forces);
        self.from_frames(forces);
        self.release(forces);
        Ok(())
    }

    /// The velocity nearest to `v`, in the norm of the kinetic energy, that supports and
    /// constraints allow in the state `q` at `time`.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn admissible_velocity(&mut self, time: f64, q: &[f64], v: &[f64]) -> Result<Vec<f64>, Singular> {
        let n = self.coordinates();
        self.mass_at(time, q)?;
        let supports = self.system.supports();
        // The velocity with moving supports and all else at rest; the rest is then found without
        // supports.
        let mut prescribed = vec![0.0; n];
        supports.prescribed_velocity(time, q, &mut prescribed);
        let mut wanted: Vec<f64> = v.iter().zip(&prescribed).map(|(v, p)| v - p).collect();
        let mut momentum = vec![0.0; self.unknowns()];
        self.mass.multiply_add(1.0, &wanted, &mut momentum[..n]);
        self.system.add_turning_momentum(q, &wanted, &mut momentum[..n]);
        supports.to_frames(time, &mut momentum[..n]);
        self.system.polar().forces(q, &mut momentum[..n]);
        self.system.constraint_rates(time, q, &prescribed, &mut momentum[n..]);
        self.system.add_prescribed_rates(1, time, &mut momentum[n..]);
        self.mass_factor.as_ref().expect(NOT_FACTORISED).solve(&mut momentum);
        supports.to_fixed_axes(time, &mut momentum[..n]);
        self.system.polar().changes(q, &mut momentum[..n]);
        wanted.iter_mut().zip(&momentum).zip(&prescribed).for_each(|((v, w), p)| *v = w + p);
        Ok(wanted)
    }

    /// Writes −(M a + f(q) + Bᵀμ) and −g to `negative`, in the supports' frames; returns the scaled
    /// residual.
    pub fn residual(&mut self, x: &[f64], rates: Rates<'_>, negative: &mut [f64]) -> f64 {
        let scale = self.balance(x, rates, negative);
        negate(self.system, scale, negative, |_, _| ())
    }

    /// [`Self::residual`], turned back node by node.
    pub fn residual_turned_back(
        &mut self,
        x: &[f64],
        rates: Rates<'_>,
        turns: &Turns,
        negative: &mut [f64],
    ) -> f64 {
        let scale = self.balance(x, rates, negative);
        let of_nodes = turns.of_nodes();
        let residual = negate(self.system, scale, negative, |node, force| of_nodes[node].back(force));
        turns.of_pairs().back(negative);
        residual
    }

    /// Writes M a + f(q) + Bᵀμ and g; returns the largest force apart from inertia.
    fn balance(&mut self, x: &[f64], rates: Rates<'_>, r: &mut [f64]) -> f64 {
        self.statistics.residual_evaluations += 1;
        let n = self.coordinates();
        if !self.carries {
            self.system.force(rates.time, &x[..n], &mut r[..n]);
            self.system.add_history(&self.accepted, &x[..n], &mut r[..n]);
            return self.finish(x, rates, r);
        }
        self.with_carried(x, rates, |motion, x, rates| {
            motion.system.force(rates.time, &x[..n], &mut r[..n]);
            motion.system.add_history(&motion.accepted, &x[..n], &mut r[..n]);
            motion.finish(x, rates, r)
        })
    }

    /// [`Self::residual`], and the tangent ∂f/∂q with stress resultants extrapolated from an
    /// earlier iterate.
    pub fn linearize(
        &mut self,
        x: &[f64],
        earlier: Earlier<'_>,
        rates: Rates<'_>,
        negative: &mut [f64],
    ) -> f64 {
        self.statistics.residual_evaluations += 1;
        let n = self.coordinates();
        if !self.carries {
            self.assemble(x, Some(earlier), rates, &mut negative[..n]);
            let scale = self.finish(x, rates, negative);
            return negate(self.system, scale, negative, |_, _| ());
        }
        let mut before = earlier.q.to_vec();
        let mut idle = vec![0.0; n];
        let mut still = vec![0.0; n];
        self.system.carry(rates.time, [&mut before[..n], &mut idle, &mut still]);
        let scale = self.with_carried(x, rates, |motion, x, rates| {
            let change: Vec<f64> = x.iter().zip(&before).map(|(x, before)| x - before).collect();
            let earlier = Earlier { q: &before, increment: &change };
            motion.assemble(x, Some(earlier), rates, &mut negative[..n]);
            motion.finish(x, rates, negative)
        });
        negate(self.system, scale, negative, |_, _| ())
    }

    /// The tangent ∂f/∂q in the state `state` of unknowns, with the scaled `multipliers`, and the
    /// mass and the constraints' rows there.
    pub fn tangent_at(&mut self, state: &State, multipliers: &[f64]) {
        let rates = Rates { time: state.time, v: &state.v, a: Acceleration::constant(&state.v) };
        let mut x = Cow::Borrowed(&state.q[..]);
        if !multipliers.is_empty() {
            x.to_mut().extend_from_slice(multipliers);
        }
        let mut force = std::mem::take(&mut self.force);
        if self.carries {
            self.with_carried(&x, rates, |motion, x, rates| motion.assemble(x, None, rates, &mut force));
        } else {
            self.assemble(&x, None, rates, &mut force);
        }
        self.force = force;
    }

    /// Calls `f` with positions, velocities and accelerations in fixed axes, those of moving
    /// supports as prescribed.
    fn with_carried<T>(
        &mut self,
        x: &[f64],
        rates: Rates<'_>,
        f: impl FnOnce(&mut Self, &[f64], Rates<'_>) -> T,
    ) -> T {
        let n = self.coordinates();
        let [mut q, mut v, mut a] = std::mem::take(&mut self.carried);
        q.clear();
        q.extend_from_slice(x);
        v.copy_from_slice(&rates.v[..n]);
        let Acceleration { factor, rest } = rates.a;
        a.iter_mut().zip(x.iter().zip(rest)).for_each(|(a, (x, e))| *a = factor.mul_add(*x, *e));
        self.system.carry(rates.time, [&mut q[..n], &mut v, &mut a]);
        let carried = Rates { time: rates.time, v: &v, a: Acceleration::constant(&a) };
        let result = f(self, &q, carried);
        self.carried = [q, v, a];
        result
    }

    /// Force in fixed axes, and tangent and damping matrix in the supports' frames.
    fn assemble(&mut self, x: &[f64], earlier: Option<Earlier<'_>>, rates: Rates<'_>, force: &mut [f64]) {
        let n = self.coordinates();
        let Self { system, tangent, damping, workspace, scratch, accepted, .. } = self;
        let supports = system.supports();
        if let Some(damping) = damping {
            system.damping_matrix(&x[..n], rates.v, scratch, damping, workspace);
            supports.turn_matrix(rates.time, damping);
            system.polar().matrix(&x[..n], damping);
            supports.clear_fixed(rates.time, damping);
        }
        system.force_and_tangent(rates.time, &x[..n], earlier, force, tangent, workspace);
        system.add_history_and_tangent(accepted, &x[..n], force, tangent, workspace);
        system.add_constraint_stiffness(&x[..n], &x[n..], tangent);
        supports.turn_matrix(rates.time, tangent);
        system.polar().matrix(&x[..n], tangent);
        supports.eliminate(rates.time, tangent);
        if self.follows || system.turns() {
            system.border_in_motion(rates.time, &x[..n], &mut self.border);
            self.rows_factor.is_of_tangent = false;
        }
        if turns_mass(system) {
            [self.free_mass, _] = free_mass(system, rates.time, &x[..n], &self.mass);
        }
        if self.follows {
            self.fastest = self.fastest();
        }
        self.statistics.tangent_evaluations += 1;
    }

    /// Adds damping, inertia and constraints to the forces in `r`; returns the largest force apart
    /// from inertia.
    fn finish(&mut self, x: &[f64], rates: Rates<'_>, r: &mut [f64]) -> f64 {
        let n = self.coordinates();
        if self.damping.is_some() {
            self.system.add_damping(&x[..n], rates.v, &mut r[..n]);
        }
        let Acceleration { factor, rest } = rates.a;
        let (q, rest) = (x[..n].as_chunks::<4>().0, rest[..n].as_chunks::<4>().0);
        let acceleration = |node: usize| {
            let (q, rest) = (Lanes::new(q[node]), Lanes::new(rest[node]));
            q.mul_add(Lanes::splat(factor), rest).to_array()
        };
        let scale = self.mass.multiply_add_seen(
            acceleration,
            &mut r[..n],
            Largest::force(self.system),
            |scale, force| scale.see(&force),
            Largest::of_both,
        );
        if self.system.has_turning_inertia() {
            let a: Vec<f64> = (0..n / 4).flat_map(acceleration).collect();
            self.system.add_turning_force(&x[..n], rates.v, &a, &mut r[..n]);
        }
        let scale = balance(self.system, rates.time, x, scale.size(), r);
        self.system.polar().forces(x, &mut r[..n]);
        scale
    }

    /// K q̇ in the unknowns `earlier` less that in the unknowns `later`: by how much the forces'
    /// rates differ, in the supports' frames.
    pub fn rate_of_forces(&mut self, earlier: &State, later: &State) -> Vec<f64> {
        let n = self.coordinates();
        let mut product = vec![0.0; n];
        let mut difference = vec![0.0; self.unknowns()];
        for (state, sign) in [(earlier, 1.0), (later, -1.0)] {
            let (mut q, mut v) = (state.q.clone(), state.v.clone());
            if self.carries {
                let mut idle = vec![0.0; n];
                self.system.carry(state.time, [&mut q, &mut v, &mut idle]);
            }
            self.system.tangent_product(state.time, &q, &v, &mut product);
            self.system.polar().forces(&q, &mut product);
            difference.iter_mut().zip(&product).for_each(|(d, p)| *d += sign * p);
        }
        self.system.supports().to_frames(later.time, &mut difference[..n]);
        difference
    }

    /// Factorises K + d D + c M with the last tangent K and damping matrix D.
    ///
    /// # Errors
    /// [`Singular`] where it has no inverse.
    pub fn factorize(&mut self, c: f64, d: f64, earlier: Option<Factor>) -> Result<Factor, Singular> {
        self.statistics.factorizations += 1;
        let mass = (c, &self.free_mass);
        match &self.damping {
            None => Factor::shifted(earlier, &self.tangent, mass, &self.border),
            Some(damping) => {
                let mut sum = self.tangent.clone();
                sum.add(d, damping);
                Factor::shifted(earlier, &sum, mass, &self.border)
            }
        }
    }

    /// Factorises K + ζ D + ζ² M with the last tangent K and damping matrix D.
    ///
    /// # Errors
    /// [`Singular`] where it has no inverse.
    pub fn factorize_complex(
        &mut self,
        zeta: c64,
        earlier: Option<ComplexFactor>,
    ) -> Result<ComplexFactor, Singular> {
        self.statistics.factorizations += 1;
        let square = zeta * zeta;
        let Some(damping) = &self.damping else {
            return ComplexFactor::again(earlier, &self.tangent, &self.free_mass, square, &self.border);
        };
        let (mut real, mut imaginary) = (self.tangent.clone(), self.free_mass.clone());
        real.add(square.re, &self.free_mass);
        real.add(zeta.re, damping);
        imaginary.add(square.im - 1.0, &self.free_mass);
        imaginary.add(zeta.im, damping);
        ComplexFactor::again(earlier, &real, &imaginary, c64::new(0.0, 1.0), &self.border)
    }

    /// Multiplies by the mass matrix without the fixed coordinates: `b += factor · M d`, both in
    /// the supports' frames.
    pub fn multiply_free_mass(&self, factor: f64, d: &[f64], b: &mut [f64]) {
        let n = self.coordinates();
        self.free_mass.multiply_add(factor, &d[..n], &mut b[..n]);
    }

    /// Turns changes of unknowns into the supports' frames and clears the fixed coordinates.
    pub fn to_frames(&self, v: &mut [f64]) {
        let n = self.coordinates();
        self.system.supports().unknowns_to_frames(&mut v[..n]);
    }

    /// Turns changes of unknowns back from the supports' frames.
    pub fn from_frames<T: Real>(&self, v: &mut [T]) {
        let n = self.coordinates();
        self.system.supports().from_frames(0.0, &mut v[..n]);
    }

    /// Removes the fixed components from changes or rates of the unknowns.
    pub fn release<T: Real>(&self, v: &mut [T]) {
        let n = self.coordinates();
        self.system.supports().release(&mut v[..n]);
    }

    /// Sets the fixed coordinates to their values at `time`.
    pub fn impose(&self, time: f64, x: &mut [f64]) {
        let n = self.coordinates();
        self.system.supports().impose_unknowns(time, &mut x[..n]);
    }

    /// The unknowns and their velocities of a state in fixed axes.
    pub fn unknowns_of<'s>(&self, state: &'s State) -> Cow<'s, State> {
        if !self.system.turns() {
            return std::borrow::Cow::Borrowed(state);
        }
        let mut state = state.clone();
        self.system.uncarry(state.time, &mut state.q, &mut state.v);
        std::borrow::Cow::Owned(state)
    }

    /// Turns the state of unknowns at the end of a step into fixed axes; fixed coordinates receive
    /// their prescribed values.
    pub fn carry(&self, state: &mut State) {
        self.impose(state.time, &mut state.q);
        self.release(&mut state.v);
        if self.carries {
            let mut acceleration = vec![0.0; state.q.len()];
            self.system.carry(state.time, [&mut state.q, &mut state.v, &mut acceleration]);
        }
    }

    /// Accelerations in fixed axes from those of the unknowns in the state `state`, which is in
    /// fixed axes.
    pub fn carried_acceleration(&self, state: &State, mut acceleration: Vec<f64>) -> Vec<f64> {
        if self.carries {
            let mut state = self.unknowns_of(state).into_owned();
            self.system.carry(state.time, [&mut state.q, &mut state.v, &mut acceleration]);
        }
        acceleration
    }

    /// Root mean square over the nodes of the change of their positions, in beam lengths.
    pub fn distance(&self, change: &[f64]) -> f64 {
        let n = self.coordinates();
        let sum: f64 = nodes(&change[..n]).map(|Node { position: [x, y], .. }| x * x + y * y).sum();
        (sum / (n / 4) as f64).sqrt() / self.system.length()
    }

    /// Largest nodal change: positions in beam lengths, gradients as they are.
    pub fn size(&self, increment: &[f64]) -> f64 {
        equilibrium::size(self.system, increment)
    }

    /// [`Self::size`] of the change from `start` to `end`.
    pub fn size_of_change(&self, start: &[f64], end: &[f64]) -> f64 {
        let states = [start, &end[..start.len()]].map(|state| state.as_chunks::<4>().0);
        let largest = threads::over(
            states,
            &|_, [start, end]| {
                let mut largest = Largest::change(self.system);
                for (start, end) in start.iter().zip(end) {
                    largest.see(&std::array::from_fn(|i| end[i] - start[i]));
                }
                largest
            },
            &Largest::of_both,
        );
        largest.size()
    }

    /// Turns an increment forth node by node and back from the supports' frames, and adds it to
    /// `x`; returns its size.
    pub fn update(&self, turns: &Turns, increment: &mut [f64], x: &mut [f64]) -> f64 {
        // Turns in the plane commute: the order does not matter.
        self.from_frames(increment);
        turns.of_pairs().forth(increment);
        let n = self.coordinates();
        let nodes = [&mut increment[..n], &mut x[..n]].map(|vector| vector.as_chunks_mut::<4>().0);
        let largest = threads::over(
            nodes,
            &|range, [increment, x]| {
                let mut largest = Largest::change(self.system);
                for ((d, x), turn) in increment.iter_mut().zip(x).zip(&turns.of_nodes()[range]) {
                    turn.forth(d);
                    largest.see(d);
                    *x = (Lanes::new(*x) + Lanes::new(*d)).to_array();
                }
                largest
            },
            &Largest::of_both,
        );
        x[n..].iter_mut().zip(&increment[n..]).for_each(|(x, d)| *x += d);
        largest.size()
    }
}
