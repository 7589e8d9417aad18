//! Sums over effects: forces, tangents, matrices, energies and powers.

use super::Energy;
use super::System;
use crate::assembly::{ActingLoad, Amplitude, Earlier, Effect, HeldLength, Kind, Workspace, nodes};
use crate::lanes::{self, Lanes};
use crate::linear::Matrix;
use crate::threads;

impl System {
    /// `f = f_int(q) + f_load(q)` at the load factor or time `parameter`.
    pub fn force(&self, parameter: f64, q: &[f64], f: &mut [f64]) {
        self.start_with_constant_load(parameter, f);
        for effect in &self.terms.internal {
            effect.add_force(1.0, q, f);
        }
        for (effect, amplitude) in self.varying_loads(parameter) {
            effect.add_force(amplitude, q, f);
        }
        self.terms.timed_loads.iter().for_each(|load| load.add_force(1.0, parameter, q, f));
    }

    /// The forces of [`Self::force`] in four states, one per lane, each at its own parameter;
    /// `scratch` holds two vectors of coordinates.
    pub fn forces(&self, parameters: [f64; 4], q: &[Lanes], f: &mut [Lanes], scratch: &mut [Vec<f64>; 2]) {
        let factor = Lanes::new(parameters.map(|parameter| self.amplitude.at(parameter)));
        f.iter_mut().zip(&self.constant_load).for_each(|(f, load)| *f = factor * Lanes::splat(*load));
        for effect in &self.terms.internal {
            effect.add_forces(Lanes::ONE, q, f, scratch);
        }
        for load in self.terms.loads.iter().filter(|load| !load.is_summed()) {
            let amplitude = self.amplitude_of(load);
            load.effect.add_forces(Lanes::new(parameters.map(|p| amplitude.at(p))), q, f, scratch);
        }
        for load in &self.terms.timed_loads {
            lanes::one_by_one(q, f, scratch, |lane, q, f| load.add_force(1.0, parameters[lane], q, f));
        }
    }

    /// `f += factor · ∂f/∂λ` at the load factor λ = `load`.
    pub fn add_load_rate(&self, factor: f64, load: f64, q: &[f64], f: &mut [f64]) {
        self.add_constant_load(factor, f);
        for acting in self.terms.loads.iter().filter(|acting| !acting.is_summed()) {
            let rate = self.amplitude_of(acting).rate(load);
            if rate != 0.0 {
                acting.effect.add_force(factor * rate, q, f);
            }
        }
    }

    /// What part of forces of the norm `size` \[N\] others are: none where `size` is round-off, and an infinite
    /// one where they are no numbers, as beyond an electrode.
    pub fn relative(&self, forces: &[f64], size: f64) -> f64 {
        let part = self.norm(forces) / size;
        match size <= self.round_off {
            true => 0.0,
            false if part.is_nan() => f64::INFINITY,
            false => part,
        }
    }

    /// The largest part of itself by which the stiffness of a contact, or of a load that has acted before,
    /// changes along `step` from the state `q`, as that of an electrode does that comes nearer.
    pub fn change_of_stiffness(&self, q: &[f64], step: &[f64]) -> f64 {
        /// Part of the step of which the force is taken to be linear.
        const SMALL: f64 = 1e-6;
        /// A force that changes by this part of itself along the step has hardly a stiffness.
        const SLIGHT: f64 = 1e-3;
        let contacts = self.terms.internal.iter().filter(|effect| effect.kind() == Kind::Contact);
        let acts_already = |load: &&ActingLoad| matches!(load.amplitude, Some(Amplitude::Full));
        let loads = self.terms.loads.iter().filter(acts_already).map(|load| &load.effect);
        let of_effect = |effect: &dyn Effect| {
            let [start, after, before, end] = [0.0, SMALL, 1.0 - SMALL, 1.0].map(|part| {
                let moved: Vec<f64> = q.iter().zip(step).map(|(q, step)| q + part * step).collect();
                let mut force = vec![0.0; q.len()];
                effect.add_force(1.0, &moved, &mut force);
                force
            });
            let slope = |a: &[f64], b: &[f64]| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| (b - a) / SMALL).collect()
            };
            let (first, last) = (slope(&start, &after), slope(&before, &end));
            let force = self.norm(&start).max(self.norm(&end));
            let size = self.norm(&first).max(self.norm(&last));
            let change: Vec<f64> = first.iter().zip(&last).map(|(first, last)| last - first).collect();
            if size <= SLIGHT * force { 0.0 } else { self.relative(&change, size) }
        };
        contacts.chain(loads).map(|effect| of_effect(effect.as_ref())).fold(0.0, f64::max)
    }

    /// Whether anything changes with the load factor from `load` on: a load, a support that moves, a
    /// tendon that is pulled, or a constraint that closes.
    /// What acts where it can move nothing counts, because only round-off tells it from what can.
    pub fn is_driven(&self, load: f64) -> bool {
        let changes = |amplitude: &Amplitude| amplitude.rate(load) != 0.0;
        let held = |tendon: &HeldLength| {
            tendon.closes(load) != 0.0
                || tendon.shortening != 0.0 && changes(self.amplitude_of_length(tendon))
        };
        let varies = |load: &ActingLoad| !load.is_summed() && changes(self.amplitude_of(load));
        self.supports.moves()
            || changes(&self.amplitude) && self.constant_load.iter().any(|load| *load != 0.0)
            || self.terms.loads.iter().any(varies)
            || self.terms.held.iter().any(held)
            || self.constraints.iter().any(|row| row.is_driven(load, self.length))
    }

    fn start_with_constant_load(&self, parameter: f64, f: &mut [f64]) {
        let factor = self.amplitude.at(parameter);
        let load = self.constant_load.as_chunks::<4>().0;
        threads::each([f.as_chunks_mut::<4>().0], &|range, [f]| {
            f.iter_mut().zip(&load[range]).for_each(|(f, load)| *f = load.map(|load| factor * load));
        });
    }

    fn add_constant_load(&self, factor: f64, f: &mut [f64]) {
        for (f, load) in f.iter_mut().zip(&self.constant_load) {
            *f += factor * load;
        }
    }

    /// Loads that are not part of the constant sum, with their factors.
    fn varying_loads(&self, parameter: f64) -> impl Iterator<Item = (&dyn Effect, f64)> {
        let loads = self.terms.loads.iter().filter(|load| !load.is_summed());
        loads.map(move |load| (&*load.effect, self.amplitude_of(load).at(parameter)))
    }

    pub(super) fn amplitude_of<'a>(&'a self, load: &'a ActingLoad) -> &'a Amplitude {
        load.amplitude.as_ref().unwrap_or(&self.amplitude)
    }

    /// The factor of all loads without a law of their own.
    pub fn amplitude(&self, parameter: f64) -> f64 {
        self.amplitude.at(parameter)
    }

    /// Whether there are loads, other than those of [`Terms::timed_loads`](crate::assembly::Terms).
    pub fn has_loads(&self) -> bool {
        !self.terms.loads.is_empty()
    }

    /// Whether a load does work that no potential accounts for.
    pub fn has_work(&self) -> bool {
        !self.terms.timed_loads.is_empty() || self.terms.loads.iter().any(|load| !load.has_potential())
    }

    /// Whether any load depends on the state.
    pub fn loads_have_tangents(&self) -> bool {
        self.terms.loads.iter().any(|load| !load.effect.is_constant())
            || self.terms.timed_loads.iter().any(|load| !load.is_constant())
    }

    /// Whether forces depend on velocities.
    pub fn is_damped(&self) -> bool {
        !self.terms.damping.is_empty()
    }

    /// Power \[W\] at time `parameter` of the loads without a potential in the state (q, v), or of those alone whose force has
    /// none at any time; `scratch` is overwritten.
    pub fn power(&self, parameter: f64, q: &[f64], v: &[f64], at_no_time: bool, scratch: &mut [f64]) -> f64 {
        scratch.fill(0.0);
        let counts =
            |load: &&ActingLoad| !(load.has_potential() || at_no_time && load.effect.is_conservative());
        for load in self.terms.loads.iter().filter(counts) {
            load.effect.add_force(self.amplitude_of(load).at(parameter), q, scratch);
        }
        self.terms.timed_loads.iter().for_each(|load| load.add_force(1.0, parameter, q, scratch));
        -scratch.iter().zip(v).map(|(f, v)| f * v).sum::<f64>()
    }

    /// Work \[J\] between two states and times of the loads whose force has a potential W at any time, times a factor a that
    /// follows a law of time: −½ (a₀ + a₁)(W(q₁) − W(q₀)). Forces that nearly cancel those within a beam, as those of actuation do,
    /// then do their work with the same strains.
    pub fn work_of_laws(&self, [(from, q0), (to, q1)]: [(f64, &[f64]); 2]) -> f64 {
        let by_law = |load: &&ActingLoad| !load.has_potential() && load.effect.is_conservative();
        let work = |load: &ActingLoad| {
            let amplitude = self.amplitude_of(load);
            let change = load.effect.energy(q1) - load.effect.energy(q0);
            -0.5 * (amplitude.at(from) + amplitude.at(to)) * change
        };
        self.terms.loads.iter().filter(by_law).map(work).sum()
    }

    /// `f += ` the forces that depend on velocities.
    pub fn add_damping(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        for damping in &self.terms.damping {
            damping.add_force(q, v, f);
        }
    }

    /// `f += ` the forces that depend on velocities, `d = ` their derivative with respect to the
    /// velocities.
    pub fn damping_matrix(
        &self,
        q: &[f64],
        v: &[f64],
        f: &mut [f64],
        d: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        d.clear();
        for damping in &self.terms.damping {
            damping.add_matrix(q, v, f, d, workspace);
        }
    }

    /// Power \[W\] dissipated by damping in the state (q, v); `scratch` is overwritten.
    pub fn lost_power(&self, q: &[f64], v: &[f64], scratch: &mut [f64]) -> f64 {
        scratch.fill(0.0);
        self.add_damping(q, v, scratch);
        scratch.iter().zip(v).map(|(f, v)| f * v).sum()
    }

    /// The same force as [`Self::force`], and its derivative with respect to q. Stress resultants
    /// in the tangent are extrapolated from an earlier iterate, if there is one (see
    /// [`crate::assembly`]).
    pub fn force_and_tangent(
        &self,
        parameter: f64,
        q: &[f64],
        earlier: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        self.start_with_constant_load(parameter, f);
        k.clear();
        for effect in &self.terms.internal {
            effect.add_force_and_tangent(1.0, q, earlier, f, k, workspace);
        }
        for (effect, amplitude) in self.varying_loads(parameter) {
            effect.add_force_and_tangent(amplitude, q, earlier, f, k, workspace);
        }
        for load in &self.terms.timed_loads {
            load.add_force_and_tangent(parameter, q, f, k, workspace);
        }
    }

    /// `f = K v` with the tangent of [`Self::force_and_tangent`] at `q`, but with many more correct
    /// digits on fine meshes.
    pub fn tangent_product(&self, parameter: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        f.fill(0.0);
        for effect in &self.terms.internal {
            effect.add_tangent_product(1.0, q, v, f);
        }
        for (effect, amplitude) in self.varying_loads(parameter).filter(|(_, amplitude)| *amplitude != 0.0) {
            effect.add_tangent_product(amplitude, q, v, f);
        }
        self.terms.timed_loads.iter().for_each(|load| load.add_tangent_product(parameter, q, v, f));
    }

    /// The tangent of the internal forces alone, which is symmetric.
    pub fn internal_tangent(&self, q: &[f64]) -> Matrix {
        self.sum_of_tangents(&self.terms.internal, q)
    }

    /// Whether the mass matrix depends on the state, as that of rotary inertia depends on
    /// directions.
    pub fn has_turning_inertia(&self) -> bool {
        !self.terms.turning.is_empty()
    }

    /// `m += ` the part of the mass matrix that depends on the state `q`.
    pub fn add_turning_mass(&self, q: &[f64], m: &mut Matrix) {
        if self.terms.turning.is_empty() {
            return;
        }
        let (mut workspace, mut idle) = (Workspace::default(), vec![0.0; q.len()]);
        let still = idle.clone();
        for turning in &self.terms.turning {
            turning.momentum.add_matrix(q, &still, &mut idle, m, &mut workspace);
        }
    }

    /// `f += ` the state-dependent part of the mass matrix times `v`.
    pub fn add_turning_momentum(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        self.terms.turning.iter().for_each(|turning| turning.momentum.add_force(q, v, f));
    }

    /// `f += ` the force of state-dependent inertia at the velocities `v` and accelerations `a`.
    pub fn add_turning_force(&self, q: &[f64], v: &[f64], a: &[f64], f: &mut [f64]) {
        self.add_turning_momentum(q, a, f);
        self.terms.turning.iter().for_each(|turning| turning.rate.add_force(q, v, f));
    }

    /// Kinetic energy \[J\] of each inertia whose mass matrix depends on the state: its kind, its
    /// beam's index and ½ v·M v.
    pub(super) fn turning_energies<'q>(
        &'q self,
        q: &'q [f64],
        v: &'q [f64],
    ) -> impl Iterator<Item = (Kind, usize, f64)> + 'q {
        self.terms.turning.iter().map(move |turning| {
            let mut momentum = vec![0.0; q.len()];
            turning.momentum.add_force(q, v, &mut momentum);
            let twice: f64 = momentum.iter().zip(v).map(|(p, v)| p * v).sum();
            (turning.momentum.kind(), turning.momentum.beam(), 0.5 * twice)
        })
    }

    /// The constant part of the mass matrix; zero in an analysis without inertia.
    pub fn mass_matrix(&self) -> Matrix {
        self.sum_of_tangents(&self.terms.inertia, &vec![0.0; self.coordinates()])
    }

    /// A zero matrix with the pattern of the damping and mass matrices.
    pub fn damping_pattern(&self) -> Matrix {
        Matrix::zeros(self.nodes, self.blocks, true)
    }

    fn sum_of_tangents(&self, effects: &[Box<dyn Effect>], q: &[f64]) -> Matrix {
        let mut sum = self.damping_pattern();
        let mut force = vec![0.0; self.coordinates()];
        let mut workspace = Workspace::default();
        for effect in effects {
            effect.add_force_and_tangent(1.0, q, None, &mut force, &mut sum, &mut workspace);
        }
        sum
    }

    /// Energies at the load factor or time `parameter`; `velocity` is given in a motion. The `work`
    /// returned is only the work of actuation by laws of time that is contained in the elastic
    /// energy but not in [`Self::power`].
    pub fn energy(&self, parameter: f64, q: &[f64], velocity: Option<&[f64]>) -> Energy {
        let sum = |effects: &[Box<dyn Effect>], kind: Kind, q: &[f64]| -> f64 {
            // `fold` instead of `sum`, because the `sum` of nothing is −0.
            effects.iter().filter(|e| e.kind() == kind).fold(0.0, |sum, e| sum + e.energy(q))
        };
        let actuates = |load: &ActingLoad| matches!(load.effect.kind(), Kind::PreStrain | Kind::PreCurvature);
        let with_potential = self.terms.loads.iter().filter(|load| load.has_potential() && !actuates(load));
        let (own, common): (Vec<_>, Vec<_>) = with_potential.partition(|load| load.amplitude.is_some());
        let common: f64 = common.iter().map(|load| load.effect.energy(q)).sum();
        let own = own.iter().map(|load| self.amplitude_of(load).at(parameter) * load.effect.energy(q));
        let own: f64 = own.sum();
        let ([stretch, bend], work) = self.actuation_energy(parameter, q);
        Energy {
            stretch: sum(&self.terms.internal, Kind::Stretch, q) + stretch,
            bend: sum(&self.terms.internal, Kind::Bend, q)
                + sum(&self.terms.internal, Kind::Coupling, q)
                + bend,
            stored: self.stored_energy(q),
            kinetic: velocity.map_or(0.0, |v| {
                let turning = self.turning_energies(q, v).map(|(.., energy)| energy);
                self.terms.inertia.iter().map(|e| e.energy(v)).chain(turning).sum()
            }),
            potential: self.amplitude.at(parameter) * common + own,
            work,
            lost: 0.0,
        }
    }

    /// Energy \[J\] of all internal effects but stretch and bend: springs, foundations and
    /// contacts.
    fn stored_energy(&self, q: &[f64]) -> f64 {
        let of_section = |kind: Kind| matches!(kind, Kind::Stretch | Kind::Bend | Kind::Coupling);
        let others = self.terms.internal.iter().filter(|e| !of_section(e.kind()));
        others.map(|e| e.energy(q)).sum()
    }
}

/// The resultant \[N\] of forces on a beam, where `f` is the negative of the forces on the
/// coordinates: the shape functions of positions sum to 1, and those of gradients do not
/// contribute.
pub(super) fn resultant(f: &[f64]) -> [f64; 2] {
    nodes(f).fold([0.0; 2], |sum, f| [sum[0] - f.position[0], sum[1] - f.position[1]])
}
