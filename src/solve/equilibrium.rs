//! The equations of statics at a load factor, in the form that Newton's method and the path solvers
//! ask for.

use super::newton::{Equations, RESIDUAL_TOLERANCE};
use super::retraction::Retraction;
use super::stability::Stability;
use crate::assembly::{AcceptedState, Earlier, InternalVariables, Workspace};
use crate::lanes::Lanes;
use crate::linear::bordered::BorderRow;
use crate::linear::{Factor, Matrix, NOT_FACTORISED, Singular};
use crate::solve::Statistics;
use crate::system::System;
use crate::threads;

/// Residuals up to this many round-offs of the internal forces count as zero.
const ROUND_OFFS: f64 = 100.0;

/// Stiffness, as a part of that of the beams, of what moves without resistance.
const RESISTANCE: f64 = 1e-6;

/// Residual, tangent and its factorisation at one load factor. Unknowns are the system's
/// coordinates followed by the scaled multipliers.
pub struct Equilibrium<'a> {
    system: &'a System,
    /// How states are moved along increments.
    pub retraction: Retraction,
    tangent: Matrix,
    factor: Option<Factor>,
    border: Vec<BorderRow>,
    workspace: Workspace,
    prescribed_rate: Vec<f64>,
    /// The last accepted state, for effects that depend on the path.
    accepted: AcceptedState,
    /// The load factor and the coordinates at which the tangent is.
    linearized: (f64, Vec<f64>),
    /// Counts so far.
    pub statistics: Statistics,
}

impl<'a> Equilibrium<'a> {
    /// The equations of `system`.
    pub fn new(system: &'a System) -> Self {
        let n = system.coordinates();
        Self {
            system,
            retraction: Retraction::new(system),
            tangent: system.matrix(),
            factor: None,
            border: Vec::new(),
            workspace: Workspace::default(),
            prescribed_rate: vec![0.0; n],
            accepted: AcceptedState { q: system.start().to_vec(), variables: system.start_history().1 },
            linearized: (0.0, system.start().to_vec()),
            statistics: Statistics::default(),
        }
    }

    /// The system whose equations these are.
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// Makes `x` the last accepted state, from which internal variables are counted.
    pub fn set_accepted(&mut self, x: &[f64]) {
        if self.system.has_history() {
            let variables = self.internal_variables(x);
            self.accepted = AcceptedState { q: x[..self.system.coordinates()].to_vec(), variables };
        }
    }

    /// Counts the turns of torsion springs up to `x` without accepting it, on a path of many small
    /// changes.
    pub fn follow_windings(&mut self, x: &[f64]) {
        if self.system.has_windings() {
            self.accepted.variables.angles = self.internal_variables(x).angles;
        }
    }

    /// The last accepted state.
    pub fn accepted(&self) -> &AcceptedState {
        &self.accepted
    }

    /// Makes one that was accepted before the last accepted state again.
    pub fn restore(&mut self, accepted: AcceptedState) {
        self.accepted = accepted;
    }

    /// Calls `solve`, and restores the last accepted state afterwards.
    pub fn without_trace<T>(&mut self, solve: impl FnOnce(&mut Self) -> T) -> T {
        let held = self.accepted.clone();
        let found = solve(self);
        self.accepted = held;
        found
    }

    /// The internal variables of the state `x`.
    pub fn internal_variables(&self, x: &[f64]) -> InternalVariables {
        self.system.internal_variables(&self.accepted, &x[..self.system.coordinates()])
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.system.coordinates() + self.system.multipliers()
    }

    /// The state in which an analysis begins; multipliers that are not known are zero.
    pub fn start(&self) -> Vec<f64> {
        let mut x = self.system.start().to_vec();
        x.extend(self.system.start_history().0);
        x.resize(self.unknowns(), 0.0);
        x
    }

    /// Writes −R(x) to `negative` and returns the scaled residual: its largest component against
    /// the largest force on a coordinate (reactions included) plus the round-off of the internal
    /// forces.
    pub fn residual(&mut self, load: f64, x: &[f64], negative: &mut [f64]) -> f64 {
        let n = self.system.coordinates();
        self.statistics.residual_evaluations += 1;
        self.system.force(load, &x[..n], &mut negative[..n]);
        self.system.add_history(&self.accepted, &x[..n], &mut negative[..n]);
        self.balanced(load, x, negative)
    }

    /// The residual of the forces that are in `negative`.
    fn balanced(&self, load: f64, x: &[f64], negative: &mut [f64]) -> f64 {
        let mut scale = Largest::force(self.system);
        negative[..self.system.coordinates()].as_chunks().0.iter().for_each(|f| scale.see(f));
        let scale = balance(self.system, load, x, scale.size(), negative);
        negate(self.system, scale, negative, |_, _| ())
    }

    /// The same as [`Self::residual`]; also factorises the tangent at `x`, and to `rate` writes the
    /// right-hand side of the path's tangent dx/dλ there.
    ///
    /// # Errors
    /// [`Singular`] where the tangent has no inverse.
    pub fn linearize(
        &mut self,
        load: f64,
        x: &[f64],
        earlier: Option<Earlier<'_>>,
        negative: &mut [f64],
        rate: &mut [f64],
    ) -> Result<f64, Singular> {
        self.factorize(load, x, earlier, None, negative, |equilibrium| {
            rate.fill(0.0);
            let n = equilibrium.system.coordinates();
            equilibrium.system.add_load_rate(-1.0, load, &x[..n], &mut rate[..n]);
            equilibrium.add_rate_of_supports(load, x, rate);
        })
    }

    /// Writes −R(x) to `negative` and factorises the tangent at `x` with σ times a diagonal added.
    ///
    /// # Errors
    /// [`Singular`] where the sum has no inverse.
    pub fn linearize_shifted(
        &mut self,
        load: f64,
        x: &[f64],
        earlier: Earlier<'_>,
        shift: (f64, &[f64]),
        negative: &mut [f64],
    ) -> Result<(), Singular> {
        self.factorize(load, x, Some(earlier), Some(shift), negative, |_| ()).map(|_| ())
    }

    /// The state to which `x`, in which supports are as at load factor `from`, goes as they move to
    /// where they are at `load`, to first order and without loads. What moves without resistance
    /// goes no further than it must. `None` where that cannot be computed.
    pub fn moved_with_supports(&mut self, from: f64, load: f64, x: &[f64]) -> Option<Vec<f64>> {
        let (mut rate, mut negative) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        let shift = (RESISTANCE, &self.system.weights()[..]);
        self.factorize(from, x, None, Some(shift), &mut negative, |equilibrium| {
            equilibrium.add_rate_of_supports(from, x, &mut rate);
        })
        .ok()?;
        self.solve(from, &mut rate, true);
        Some(x.iter().zip(&rate).map(|(x, rate)| x + (load - from) * rate).collect())
    }

    /// Writes −R(x) to `negative`, returns the scaled residual, and factorises the tangent with σ
    /// times a diagonal added, if a `shift` is given. `whole` is called before the fixed coordinates
    /// are eliminated from the tangent.
    fn factorize(
        &mut self,
        load: f64,
        x: &[f64],
        earlier: Option<Earlier<'_>>,
        shift: Option<(f64, &[f64])>,
        negative: &mut [f64],
        whole: impl FnOnce(&mut Self),
    ) -> Result<f64, Singular> {
        let system = self.system;
        let n = system.coordinates();
        self.statistics.residual_evaluations += 1;
        self.statistics.tangent_evaluations += 1;
        self.statistics.factorizations += 1;
        let q = &x[..n];
        self.linearized.0 = load;
        self.linearized.1.copy_from_slice(q);
        let force = &mut negative[..n];
        system.force_and_tangent(load, q, earlier, force, &mut self.tangent, &mut self.workspace);
        system.add_history_and_tangent(&self.accepted, q, force, &mut self.tangent, &mut self.workspace);
        let residual = self.balanced(load, x, negative);
        system.add_constraint_stiffness(q, &x[n..], &mut self.tangent);
        if let Some((sigma, diagonal)) = shift {
            self.tangent.add_diagonal(sigma, diagonal);
        }
        system.supports().turn_matrix(load, &mut self.tangent);
        whole(self);
        system.supports().eliminate(load, &mut self.tangent);
        system.border_again(load, q, &mut self.border);
        self.factor = Some(Factor::again(self.factor.take(), &self.tangent, &self.border)?);
        Ok(residual)
    }

    /// Adds −K v with the prescribed rates v of fixed coordinates, which must not have been eliminated
    /// from the tangent yet, and the rates of constraints; turns `rate` into the supports' frames.
    fn add_rate_of_supports(&mut self, load: f64, x: &[f64], rate: &mut [f64]) {
        let system = self.system;
        let n = system.coordinates();
        let q = &x[..n];
        for (r, constraint) in system.constraints().iter().enumerate() {
            let unit = constraint.scale(system.stiffness(), system.length());
            rate[n + r] = -unit * constraint.rate(load, q);
        }
        system.held_load_rates(load, q, None, &mut rate[n..]);
        system.supports().rate(load, q, &mut self.prescribed_rate);
        if system.supports().moves() {
            system.supports().to_frames(load, &mut rate[..n]);
            self.tangent.multiply_add(-1.0, &self.prescribed_rate, &mut rate[..n]);
            system.supports().from_frames(load, &mut rate[..n]);
            let mut global = self.prescribed_rate.clone();
            system.supports().from_frames(load, &mut global);
            for (r, constraint) in system.constraints().iter().enumerate() {
                let unit = constraint.scale(system.stiffness(), system.length());
                rate[n + r] -=
                    unit * constraint.gradient(load, q).map(|(i, value)| value * global[i]).sum::<f64>();
            }
            system.held_load_rates(load, q, Some(&global), &mut rate[n..]);
        }
        system.supports().to_frames(load, &mut rate[..n]);
    }

    /// Solves with the last tangent; `b` is given in the supports' frames and returned in fixed
    /// axes. With `moving`, fixed coordinates receive their prescribed rates.
    ///
    /// # Panics
    /// Where no tangent has been factorised.
    pub fn solve(&self, load: f64, b: &mut [f64], moving: bool) {
        let n = self.system.coordinates();
        self.factor.as_ref().expect(NOT_FACTORISED).solve(b);
        if moving {
            for (b, rate) in b[..n].iter_mut().zip(&self.prescribed_rate) {
                // Fixed components are zero in a solved right-hand side, free ones have no
                // prescribed rate.
                *b += rate;
            }
        }
        self.system.supports().from_frames(load, &mut b[..n]);
    }

    /// Largest nodal change: positions in beam lengths, gradients as they are. Multipliers do not
    /// count.
    pub fn size(&self, increment: &[f64]) -> f64 {
        size(self.system, increment)
    }

    /// Number of unstable directions at the last linearised state: negative eigenvalues of the
    /// tangent restricted to motions that constraints and supports allow. `None` under follower
    /// loads.
    pub fn unstable_directions(&self) -> Option<usize> {
        self.factor.as_ref()?.negative_directions(&self.tangent, &self.border)
    }

    /// Number of negative eigenvalues of the symmetric part of the last tangent, on the motions that
    /// constraints and supports allow. Where it is zero, no direction has lost its stiffness. That the
    /// friction of a point which slides follows the pressure is left out: the symmetric part of that is
    /// indefinite wherever anything slides, and takes no stiffness from what it slows down.
    pub fn soft_directions(&self) -> Option<usize> {
        let mut symmetric = self.tangent.symmetric_part();
        let (load, q) = &self.linearized;
        if let Some(sliding) = self.system.tangent_of_sliding(*load, &self.accepted, q) {
            symmetric.add(-1.0, &sliding.symmetric_part());
            self.system.supports().eliminate(*load, &mut symmetric);
        }
        let factor = Factor::new(&symmetric, &self.border).ok()?;
        factor.negative_directions(&symmetric, &self.border)
    }

    /// Linearises at `x`, and counts the directions that have lost their stiffness: of a symmetric
    /// tangent those that are unstable, otherwise [`Self::soft_directions`].
    pub fn directions_at(&mut self, load: f64, x: &[f64]) -> Option<usize> {
        let (mut residual, mut rate) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        self.linearize(load, x, None, &mut residual, &mut rate).ok()?;
        if self.is_symmetric() { self.unstable_directions() } else { self.soft_directions() }
    }

    /// Stability at the last linearised state, where the factorisation tells, and where that is the sign
    /// of the determinant of a tangent without symmetry, [`Self::soft_directions`] beside it.
    pub fn stability_and_softness(&self) -> (Option<Stability>, Option<usize>) {
        let stability = self.stability();
        let by_sign = !self.is_symmetric() && matches!(stability, Some(Stability::NegativeDeterminants(_)));
        (stability, by_sign.then(|| self.soft_directions()).flatten())
    }

    /// Stability at the last linearised state, where the factorisation tells.
    /// Where the directions of a symmetric tangent cannot be counted, it is singular, and the sign of its determinant is
    /// round-off.
    pub fn stability(&self) -> Option<Stability> {
        if self.is_symmetric() {
            return self.unstable_directions().map(Stability::Directions);
        }
        let count = self.factor.as_ref()?.negative_determinants(&self.tangent, &self.border)?;
        Some(Stability::NegativeDeterminants(count))
    }

    /// Whether the tangent is symmetric.
    pub fn is_symmetric(&self) -> bool {
        matches!(self.tangent, Matrix::Symmetric(_))
    }

    /// Whether the last linearised state is known to be unstable.
    pub fn is_unstable(&self) -> bool {
        self.stability().is_some_and(Stability::is_unstable)
    }

    /// The factorised tangent.
    pub fn factor(&self) -> Option<&Factor> {
        self.factor.as_ref()
    }
}

/// Adds Bᵀμ to the forces that are in `r`, turns them into the supports' frames and appends g.
/// Returns the largest force, `scale` or larger.
pub(super) fn balance(system: &System, load: f64, x: &[f64], scale: f64, r: &mut [f64]) -> f64 {
    let (q, multipliers) = x.split_at(system.coordinates());
    let (force, gaps) = r.split_at_mut(q.len());
    let scale = system.constrain(load, [q, multipliers], force, gaps, scale);
    system.supports().to_frames(load, force);
    scale
}

/// Negates the R that [`balance`] left; `turn` may then turn the force on the node of a number.
/// Returns the residual scaled by the largest force. Constraints do not count: Newton's method
/// satisfies those that are linear in q to round-off at once, and lengths as soon as its increments
/// vanish.
#[inline(always)]
pub(super) fn negate(
    system: &System,
    scale: f64,
    r: &mut [f64],
    turn: impl Fn(usize, &mut [f64; 4]) + Sync,
) -> f64 {
    let (force, gaps) = r.split_at_mut(system.coordinates());
    let largest = threads::over(
        [force.as_chunks_mut().0],
        &|nodes, [force]| {
            let mut largest = Largest::force(system);
            for (node, force) in nodes.zip(force) {
                largest.see(force);
                *force = force.map(|force| -force);
                turn(node, force);
            }
            largest
        },
        &Largest::of_both,
    );
    gaps.iter_mut().for_each(|gap| *gap = -*gap);
    let residual = largest.size();
    if residual == 0.0 { 0.0 } else { residual / (scale + floor(system)) }
}

/// The force to which a residual is compared where nothing else acts.
pub(super) fn floor(system: &System) -> f64 {
    ROUND_OFFS / RESIDUAL_TOLERANCE * system.round_off()
}

/// Largest nodal change: positions in beam lengths, gradients as they are. Multipliers do not
/// count.
pub(super) fn size(system: &System, increment: &[f64]) -> f64 {
    let mut largest = Largest::change(system);
    increment[..system.coordinates()].as_chunks().0.iter().for_each(|d| largest.see(d));
    largest.size()
}

/// The largest of the numbers of many nodes, each component in a unit of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Largest {
    units: Lanes,
    sizes: Lanes,
    not_finite: Lanes,
}

impl Largest {
    /// For forces \[N\]; those on gradients are divided by the beam length.
    pub fn force(system: &System) -> Self {
        let inverse = 1.0 / system.length();
        Self::new([1.0, 1.0, inverse, inverse])
    }

    /// For changes of positions, in beam lengths, and of gradients.
    pub fn change(system: &System) -> Self {
        let inverse = 1.0 / system.length();
        Self::new([inverse, inverse, 1.0, 1.0])
    }

    fn new(units: [f64; 4]) -> Self {
        Self { units: Lanes::new(units), sizes: Lanes::ZERO, not_finite: Lanes::ZERO }
    }

    /// Takes a node into account.
    #[inline(always)]
    pub fn see(&mut self, node: &[f64; 4]) {
        let sizes = (Lanes::new(*node) * self.units).abs();
        self.sizes = sizes.fast_max(self.sizes);
        // Times zero, ∞ and NaN give NaN, which a maximum might drop.
        self.not_finite += sizes * Lanes::ZERO;
    }

    /// Of what either has seen.
    pub fn of_both(self, other: Self) -> Self {
        let not_finite = self.not_finite + other.not_finite;
        Self { sizes: self.sizes.fast_max(other.sizes), not_finite, ..self }
    }

    /// The largest so far; NaN if one was not finite.
    pub fn size(&self) -> f64 {
        (self.sizes + self.not_finite).to_array().into_iter().fold(0.0, larger)
    }
}

/// The larger of two sizes. `f64::max` would drop a NaN.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// Equilibrium at a given load factor.
pub struct AtLoad<'e, 'a> {
    /// The equations.
    pub equilibrium: &'e mut Equilibrium<'a>,
    /// λ.
    pub load: f64,
    scratch: Vec<f64>,
    rate: Vec<f64>,
}

impl<'e, 'a> AtLoad<'e, 'a> {
    /// The equations at load factor `load`.
    pub fn new(equilibrium: &'e mut Equilibrium<'a>, load: f64) -> Self {
        let scratch = vec![0.0; equilibrium.unknowns()];
        let rate = scratch.clone();
        Self { equilibrium, load, scratch, rate }
    }

    /// The path's tangent (dx/dλ, 1) at the last linearised state.
    pub fn rate(mut self) -> Vec<f64> {
        self.equilibrium.solve(self.load, &mut self.rate, true);
        self.rate.push(1.0);
        self.rate
    }
}

impl Equations for AtLoad<'_, '_> {
    fn increment(&mut self, x: &[f64], earlier: Earlier<'_>, increment: &mut [f64]) -> Result<f64, Singular> {
        self.equilibrium.statistics.newton_iterations += 1;
        let residual = self.equilibrium.linearize(self.load, x, Some(earlier), increment, &mut self.rate)?;
        self.equilibrium.solve(self.load, increment, false);
        Ok(residual)
    }

    fn residual(&mut self, x: &[f64]) -> f64 {
        self.equilibrium.residual(self.load, x, &mut self.scratch)
    }

    fn size(&self, increment: &[f64]) -> f64 {
        self.equilibrium.size(increment)
    }

    fn apply(&self, increment: &[f64], x: &mut [f64]) {
        self.equilibrium.retraction.apply(increment, x);
    }
}

/// Equilibrium on a plane across the path: unknowns (x, λ) with ⟨τ, (x, λ) − (x, λ)_predicted⟩ = 0.
///
/// The plane's normal τ is the predictor's direction (Keller's pseudo-arc length); the bordered
/// system is solved with the same tangent twice, δx = a + δλ b with K a = −R and K b = −∂R/∂λ.
pub struct AcrossPath<'e, 'a> {
    /// The equations.
    pub equilibrium: &'e mut Equilibrium<'a>,
    /// τ, one longer than x; already weighted, so that its dot product with a change is that change
    /// along the path.
    pub normal: Vec<f64>,
    /// λ at the last linearised state.
    load: f64,
    /// Change of λ that counts as one beam length.
    load_scale: f64,
    rate: Vec<f64>,
    scratch: Vec<f64>,
}

impl<'e, 'a> AcrossPath<'e, 'a> {
    /// `normal` as in [`Self::normal`].
    pub fn new(equilibrium: &'e mut Equilibrium<'a>, normal: Vec<f64>, load_scale: f64) -> Self {
        let rate = vec![0.0; equilibrium.unknowns()];
        let scratch = rate.clone();
        Self { equilibrium, normal, load: 0.0, load_scale, rate, scratch }
    }

    /// The direction (dx/dλ, 1) of the path at the last linearised state.
    pub fn rate(mut self) -> Vec<f64> {
        self.rate.push(1.0);
        self.rate
    }
}

impl Equations for AcrossPath<'_, '_> {
    fn increment(&mut self, x: &[f64], earlier: Earlier<'_>, increment: &mut [f64]) -> Result<f64, Singular> {
        let n = self.equilibrium.unknowns();
        let load = x[n];
        self.load = load;
        self.equilibrium.statistics.newton_iterations += 1;
        let residual =
            self.equilibrium.linearize(load, &x[..n], Some(earlier), &mut increment[..n], &mut self.rate)?;
        self.equilibrium.solve(load, &mut increment[..n], false);
        self.equilibrium.solve(load, &mut self.rate, true);
        let along = |v: &[f64]| -> f64 { v.iter().zip(&self.normal).map(|(v, n)| v * n).sum() };
        let change = -along(&increment[..n]) / (self.normal[n] + along(&self.rate));
        for (increment, rate) in increment[..n].iter_mut().zip(&self.rate) {
            *increment += change * rate;
        }
        increment[n] = change;
        Ok(residual)
    }

    fn residual(&mut self, x: &[f64]) -> f64 {
        let n = self.equilibrium.unknowns();
        self.equilibrium.residual(x[n], &x[..n], &mut self.scratch)
    }

    /// The load factor counts too: where a structure slides along the plane's normal, it alone is corrected.
    fn size(&self, increment: &[f64]) -> f64 {
        let load = increment[self.equilibrium.unknowns()].abs();
        larger(self.equilibrium.size(increment), load / (self.load_scale + self.load.abs()))
    }

    fn apply(&self, increment: &[f64], x: &mut [f64]) {
        self.equilibrium.retraction.apply(increment, x);
        // Prescribed rotations are not linear in the load factor.
        let n = self.equilibrium.unknowns();
        let load = x[n];
        self.equilibrium.system().supports().impose(load, &mut x[..self.equilibrium.system().coordinates()]);
    }
}
