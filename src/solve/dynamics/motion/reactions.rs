//! Forces of supports and joints in a motion, and the power that moving supports put in.
//!
//! # Forces in a recorded state
//! The positions of a recorded state err by a part of the tolerance, and stiffness times this error
//! would hide the forces. A step knows its forces through the inertia in its stages. The
//! accelerations a of the stages, continued to the record, are freed of components that would
//! strain the beam faster than a step of length h can follow, and the state is moved by δ, of the
//! size of its error, until its forces balance them:
//!
//! ```text
//! (K + d D + c M) δ + Bᵀμ = −(M a + f(q) + f_d(q, v))   B c δ = −B a − Ḃ v
//!     q ← q + δ, v ← v + d δ, a ← a + c δ,   c = (4/h)², d = 4/h
//! (K + c M) w + Bᵀν = −(K a + D²f[v, v])             B w = −B a − Ḃ v
//! (K + c M) u + Bᵀν = c M w                          B u = 0
//!     a ← a + w − u
//! ```
//!
//! K a + D²f[v, v] is f̈: stiff directions move as if they were constrained. It is taken where the state has been moved
//! once, since the forces of a state that errs turn with a slow motion, and would change its acceleration; u is what w
//! still has of one. The state is moved once more under what has become of a. Slow motions receive the acceleration
//! that their forces give; motions too fast to be followed receive the quasi-static force under the inertia of the
//! rest.

use super::super::{State, Tendency};
use super::{Acceleration, Motion, Rates};
use crate::linear::Singular;
use crate::system::{Balanced, Reaction};

/// A state of a motion's unknowns in which its equations hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StageState {
    /// Unknowns and their velocities.
    pub state: State,
    /// Accelerations of the unknowns, followed by the scaled multipliers.
    pub rates: Vec<f64>,
}

/// A state of motion in fixed axes with all that acts in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Balance {
    /// The state.
    pub state: State,
    /// Accelerations.
    pub acceleration: Vec<f64>,
    /// Forces of supports on the fixed coordinates.
    pub support_forces: Vec<f64>,
    /// Scaled multipliers.
    pub multipliers: Vec<f64>,
}

impl Balance {
    /// The balance as the sums of a system take it.
    pub fn view(&self) -> Balanced<'_> {
        let State { time, q, v, variables, .. } = &self.state;
        let motion = Some([&v[..], &self.acceleration]);
        Balanced {
            parameter: *time,
            q,
            motion,
            support_forces: &self.support_forces,
            multipliers: &self.multipliers,
            variables,
        }
    }
}

/// ω h beyond which a vibration is too fast for steps of length h.
const FAST: f64 = 4.0;
/// How often a state is moved at least; before the second time the accelerations are freed of what strains.
const PASSES: usize = 2;
/// How often it is moved at most: again …
const MOST_PASSES: usize = 5;
/// … where the last change, in beam lengths or of a gradient, was larger than this: the square of it, times the stretching stiffness,
/// is what forces still lack.
const SETTLED: f64 = 1e-7;
/// Change of a gradient, or of a position in beam lengths, over which a tangent is differenced.
const DIFFERENCE: f64 = 1e-4;

impl Motion<'_> {
    /// Forces of supports and joints on the beams in the state `state`, whose positions are taken
    /// to be exact.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn reactions(&mut self, state: &State) -> Result<Vec<Reaction>, Singular> {
        let balance = self.exact_balance(state)?;
        Ok(self.reactions_in(&balance))
    }

    /// All forces in the state `state`, whose positions are taken to be exact.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn exact_balance(&mut self, state: &State) -> Result<Balance, Singular> {
        let stage = self.stage_of(state)?;
        Ok(self.balance_of(stage))
    }

    /// Forces of supports and joints on the beams in a balance.
    pub fn reactions_in(&self, balance: &Balance) -> Vec<Reaction> {
        let Balance { state, support_forces, multipliers, .. } = balance;
        self.system.reactions(state.time, &state.q, support_forces, multipliers)
    }

    /// The unknowns of a state with the accelerations that its forces give.
    fn stage_of(&mut self, state: &State) -> Result<StageState, Singular> {
        let state = self.unknowns_of(state).into_owned();
        let mut rates = vec![0.0; self.coordinates()];
        self.acceleration(&state, &mut rates)?;
        rates.extend_from_slice(&self.multipliers);
        Ok(StageState { state, rates })
    }

    /// Moves into balance the state `state`, to which a step has led with such a tendency.
    ///
    /// # Errors
    /// [`Singular`] where the step's matrix has no inverse.
    pub fn settle(&mut self, state: &State, tendency: Tendency) -> Result<Balance, Singular> {
        let Tendency { rates, step: h } = tendency;
        let n = self.coordinates();
        let state = self.unknowns_of(state).into_owned();
        let mut stage = StageState { state, rates };
        let (d, c) = (FAST / h, (FAST / h).powi(2));
        let mut last = f64::INFINITY;
        for pass in 0..MOST_PASSES {
            self.tangent_at(&stage.state, &stage.rates[n..]);
            let factor = match self.factorize(c, d, None) {
                Err(_) if pass >= PASSES => break,
                factor => factor?,
            };
            if pass == 1 {
                let mut change = self.rate_of_rates(&stage);
                self.constraint_defects(&stage, 1.0, &mut change[n..]);
                factor.solve(&mut change);
                let mut slow = vec![0.0; self.unknowns()];
                self.multiply_free_mass(c, &change, &mut slow);
                factor.solve(&mut slow);
                change.iter_mut().zip(&slow).for_each(|(w, u)| *w -= u);
                self.from_frames(&mut change);
                stage.rates[..n].iter_mut().zip(&change).for_each(|(a, w)| *a += w);
            }
            let mut change = vec![0.0; self.unknowns()];
            let (mut x, a) = (stage.state.q.clone(), Acceleration::constant(&stage.rates[..n]));
            x.extend_from_slice(&stage.rates[n..]);
            self.residual(&x, Rates { time: stage.state.time, v: &stage.state.v, a }, &mut change);
            self.constraint_defects(&stage, c.recip(), &mut change[n..]);
            let StageState { state, rates } = &mut stage;
            factor.solve(&mut change);
            self.from_frames(&mut change);
            // What no longer shrinks leads nowhere.
            let size = self.size(&change[..n]);
            if pass >= PASSES && (size.is_nan() || size >= last) {
                break;
            }
            last = size;
            for (i, change) in change[..n].iter().enumerate() {
                state.q[i] += change;
                state.v[i] += d * change;
                rates[i] += c * change;
            }
            rates[n..].iter_mut().zip(&change[n..]).for_each(|(mu, change)| *mu += change);
            if pass + 1 >= PASSES && size <= SETTLED {
                break;
            }
        }
        Ok(self.balance_of(stage))
    }

    /// −f̈ = −(K a + D²f\[v, v\]) of the elastic forces in the supports' frames, and zeros for the
    /// multipliers.
    fn rate_of_rates(&self, StageState { state, rates }: &StageState) -> Vec<f64> {
        let (n, time) = (self.coordinates(), state.time);
        let [q, v, a] = self.in_fixed_axes(state, &rates[..n]);
        let mut sum = vec![0.0; self.unknowns()];
        self.system.tangent_product(time, &q, &a, &mut sum[..n]);
        self.system.add_constraint_stiffness_product(&q, &rates[n..], &a, &mut sum[..n]);
        // D²f[v, v] as the difference of K v a little after and a little before.
        let speed = self.size(&v);
        if speed > 0.0 {
            let ahead = DIFFERENCE / speed;
            let mut product = vec![0.0; n];
            for step in [ahead, -ahead] {
                let there: Vec<f64> = q.iter().zip(&v).map(|(q, v)| step.mul_add(*v, *q)).collect();
                self.system.tangent_product(time, &there, &v, &mut product);
                sum.iter_mut().zip(&product).for_each(|(sum, kv)| *sum += kv / (2.0 * step));
            }
        }
        sum[..n].iter_mut().for_each(|f| *f = -*f);
        self.system.supports().to_frames(time, &mut sum[..n]);
        self.system.polar().forces(&q, &mut sum[..n]);
        sum
    }

    /// Writes `factor` times −(B a + Ḃ v), scaled.
    fn constraint_defects(&self, StageState { state, rates }: &StageState, factor: f64, defects: &mut [f64]) {
        let [q, v, a] = self.in_fixed_axes(state, &rates[..self.coordinates()]);
        self.system.constraint_rates(state.time, &q, &a, defects);
        self.system.add_constraint_curvatures(&q, &v, defects);
        self.system.add_prescribed_rates(2, state.time, defects);
        defects.iter_mut().for_each(|defect| *defect *= factor);
    }

    fn in_fixed_axes(&self, state: &State, acceleration: &[f64]) -> [Vec<f64>; 3] {
        let [mut q, mut v, mut a] = [&state.q[..], &state.v, acceleration].map(<[f64]>::to_vec);
        self.system.carry(state.time, [&mut q, &mut v, &mut a]);
        [q, v, a]
    }

    /// All forces in a state in which the equations hold.
    pub fn balance_of(&self, stage: StageState) -> Balance {
        let (mut balance, force) = self.forces_of(stage);
        balance.support_forces = force;
        let (time, q) = (balance.state.time, &balance.state.q);
        self.system.add_constraint_forces(time, q, &balance.multipliers, &mut balance.support_forces);
        self.system.supports().keep_fixed(time, &mut balance.support_forces);
        balance
    }

    /// A state in fixed axes, and M q̈ + f there.
    fn forces_of(&self, stage: StageState) -> (Balance, Vec<f64>) {
        let StageState { state, mut rates } = stage;
        let State { time, work, lost, .. } = state;
        let angles = state.angles.clone();
        let multipliers = rates.split_off(self.coordinates());
        let [q, v, acceleration] = self.in_fixed_axes(&state, &rates);
        let mut force = vec![0.0; q.len()];
        self.system.force(time, &q, &mut force);
        self.system.add_history(&self.accepted, &q, &mut force);
        self.system.add_damping(&q, &v, &mut force);
        self.mass.multiply_add(1.0, &acceleration, &mut force);
        self.system.add_turning_force(&q, &v, &acceleration, &mut force);
        let variables = self.system.internal_variables(&self.accepted, &q);
        let state = State { time, q, v, work, lost, variables, angles };
        (Balance { state, acceleration, support_forces: Vec::new(), multipliers }, force)
    }

    /// Power \[W\] that moving supports put in, in a stage.
    ///
    /// It is R·v with the reactions R = M q̈ + f, which vanish in all coordinates that no support
    /// moves. So v may be the velocities of all coordinates. This is more accurate, because the
    /// stages are solved only to a tolerance: the beam follows its supports, so that the remaining
    /// stiff forces do no work on v.
    pub fn support_power(&self, stage: StageState) -> f64 {
        let (balance, force) = self.forces_of(stage);
        force.iter().zip(&balance.state.v).map(|(force, v)| force * v).sum()
    }
}
