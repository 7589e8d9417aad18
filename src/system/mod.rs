//! The semi-discrete system: coordinates, effects, supports and constraints of a model, ready for a solver.
//!
//! # Coordinates
//! Node after node, beam after beam, four each: `[x, y, x', y']`, positions in metres, gradients without unit. What a
//! support holds stays in this vector and is eliminated in place ([`supports`]); supports between nodes add one Lagrange
//! multiplier a row ([`constraints`]).
//!
//! # Equations of statics
//! ```text
//! f_int(q) + λ f_load(q) + Bᵀ μ = 0,   g(q, λ) = 0
//! ```
//! with the load factor λ ∈ [0, 1]. Loads count as densities of negative work, hence the plus sign.

pub mod constraints;
mod effects;
mod error;
mod inventory;
pub mod supports;
mod view;

pub use error::SystemError;
pub use inventory::{EffectEntry, Inventory};
pub use view::View;

use crate::basis::Basis;
use crate::centreline::Curve;
use crate::effect::{Effect, Kind, Workspace};
use crate::linear::Matrix;
use crate::linear::bordered::BorderRow;
use crate::model::{Centreline, Discretization, FixedRotation, Model, Place, Support};
use crate::trajectory::Energy;
use constraints::{Constraint, Row};
use supports::{Held, Hold, Ramp, Supports};

/// What an analysis asks of the system; nothing else is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needs {
    /// Whether inertia takes part.
    pub inertia: bool,
}

/// Distance beyond an end, per length, that counts as round-off.
const PLACE_ROUND_OFF: f64 = 1e-9;

/// A beam's part of the system.
#[derive(Debug)]
pub struct BeamPart {
    /// The beam's name.
    pub name: String,
    /// Its shape functions.
    pub basis: Basis,
    /// Its first node in the system.
    pub first_node: usize,
    /// Whether the stress-free state is straight to round-off, as the shape functions see it.
    pub straight: bool,
}

impl BeamPart {
    /// First coefficient in the system: two a node.
    pub fn offset(&self) -> usize {
        2 * self.first_node
    }
}

/// Equations of a model.
pub struct System {
    beams: Vec<BeamPart>,
    nodes: usize,
    blocks: usize,
    internal: Vec<Box<dyn Effect>>,
    loads: Vec<Box<dyn Effect>>,
    /// The sum of all loads that are the same in every state.
    constant_load: Vec<f64>,
    inertia: Vec<Box<dyn Effect>>,
    supports: Supports,
    constraints: Vec<Constraint>,
    reference: Vec<f64>,
    length: f64,
    stiffness: f64,
    round_off: f64,
    lowest_vibration: f64,
}

impl System {
    /// Builds the equations of `model`: shape functions, tables of the effects that it names, supports.
    ///
    /// # Errors
    /// [`SystemError`] where the model contradicts itself or its shape functions cannot be built.
    pub fn build(model: &Model, needs: Needs) -> Result<Self, SystemError> {
        if model.beams.is_empty() {
            return Err(SystemError::NoBeam);
        }
        let mut beams: Vec<BeamPart> = Vec::with_capacity(model.beams.len());
        let mut reference = Vec::new();
        let (mut stiffness, mut round_off) = (0.0_f64, 0.0_f64);
        for beam in &model.beams {
            let in_curve = |source| SystemError::Curve { beam: beam.name.clone(), source };
            let in_basis = |e| SystemError::basis(&beam.name, e);
            let curve = Curve::new(&beam.centreline).map_err(in_curve)?;
            let basis = Basis::new(&beam.discretization, curve.length()).map_err(in_basis)?;
            let first_node = reference.len() / 4;
            for &s in basis.nodes() {
                let ([x, y], [tx, ty]) = (curve.position(s), curve.tangent(s));
                reference.extend([x, y, tx, ty]);
            }
            let linear = match beam.discretization {
                Discretization::Ancf { .. } => true,
                Discretization::Rpim { polynomial_terms, .. } => polynomial_terms >= 2,
            };
            let straight = linear && matches!(beam.centreline, Centreline::Line { .. });
            let section = &beam.section;
            let per_length = section.bending_stiffness.map_or(0.0, |ei| ei / curve.length().powi(2));
            stiffness = stiffness.max(section.axial_stiffness.unwrap_or(per_length));
            // A position is stored to ε L; a cubic element resists that with EA/h, and with 12 EI/h³ across.
            let spacing = basis.nodes().windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
            let axial = section.axial_stiffness.unwrap_or(0.0);
            let bending = 12.0 * section.bending_stiffness.unwrap_or(0.0) / spacing.powi(2);
            round_off = round_off.max(f64::EPSILON * axial.max(bending) * curve.length() / spacing);
            beams.push(BeamPart { name: beam.name.clone(), basis, first_node, straight });
        }
        let nodes = reference.len() / 4;
        let blocks = beams.iter().map(|b| b.basis.width() / 2).max().unwrap_or(1);
        let length = beams.iter().map(|b| b.basis.length()).fold(0.0, f64::max);
        let mut system = Self {
            beams,
            nodes,
            blocks,
            internal: Vec::new(),
            loads: Vec::new(),
            constant_load: Vec::new(),
            inertia: Vec::new(),
            supports: Supports::default(),
            constraints: Vec::new(),
            reference,
            length,
            stiffness,
            round_off,
            lowest_vibration: lowest_vibration_scale(model, length),
        };
        effects::add(&mut system, model, needs)?;
        system.constant_load = vec![0.0; system.coordinates()];
        for effect in system.loads.iter().filter(|effect| effect.is_constant()) {
            effect.add_force(1.0, &system.reference, &mut system.constant_load);
        }
        system.add_supports(&model.supports)?;
        Ok(system)
    }

    /// The arc length of a place on its beam; round-off beyond an end is cut off.
    ///
    /// # Errors
    /// [`SystemError`] naming `what`, if the place is off the beam.
    pub fn arc_length(&self, what: &'static str, at: Place) -> Result<f64, SystemError> {
        self.part(what, at).map(|(_, s)| s)
    }

    /// Beam and arc length \[m\] of the node to which an unknown belongs; of the first node for a multiplier.
    pub fn place_of(&self, unknown: usize) -> (usize, f64) {
        let node = unknown / 4;
        let beams = self.beams.iter().enumerate().rev();
        beams
            .filter(|(_, part)| part.first_node <= node)
            .find_map(|(i, part)| Some((i, *part.basis.nodes().get(node - part.first_node)?)))
            .unwrap_or((0, 0.0))
    }

    fn part(&self, what: &'static str, at: Place) -> Result<(&BeamPart, f64), SystemError> {
        let part = self.beams.get(at.beam).ok_or(SystemError::NoSuchBeam {
            what,
            beam: at.beam,
            count: self.beams.len(),
        })?;
        let length = part.basis.length();
        // A length computed elsewhere may differ by round-off.
        if at.s >= -PLACE_ROUND_OFF * length && at.s <= (1.0 + PLACE_ROUND_OFF) * length {
            Ok((part, at.s.clamp(0.0, length)))
        } else {
            Err(SystemError::OffBeam { what, beam: part.name.clone(), s: at.s, length })
        }
    }

    fn add_supports(&mut self, supports: &[Support]) -> Result<(), SystemError> {
        let mut held: Vec<Held> = Vec::new();
        let mut constraints = Vec::new();
        for support in supports {
            let (part, s) = self.part("a support", support.at)?;
            let in_basis = |e| SystemError::basis(&part.name, e);
            let fields =
                View::point(&part.basis, part.offset(), s).map_err(in_basis)?.fields(&self.reference);
            let (position, gradient) = (fields.position, fields.gradient);
            let angle = Ramp { start: gradient[1].atan2(gradient[0]), change: support.displacement.angle };
            let rotation = Ramp { start: 0.0, change: support.displacement.angle };
            let motion = [support.displacement.x, support.displacement.y];
            let fixed = [support.fix.x, support.fix.y];
            let components: [Option<Ramp>; 2] = std::array::from_fn(|axis| {
                fixed[axis].then_some(Ramp { start: position[axis], change: motion[axis] })
            });
            if let Some(node) = part.basis.node_at(s) {
                let pair = 2 * (part.first_node + node);
                let mut add = |pair: usize, hold: Hold| match held.iter_mut().find(|h| h.pair == pair) {
                    None => {
                        held.push(Held { pair, hold });
                        Ok(())
                    }
                    Some(Held { hold: Hold::Position(there), .. }) => match hold {
                        Hold::Position(new) if (0..2).all(|a| there[a].is_none() || new[a].is_none()) => {
                            *there = std::array::from_fn(|a| there[a].or(new[a]));
                            Ok(())
                        }
                        _ => Err("position"),
                    },
                    Some(_) => Err("rotation"),
                };
                let position = if components.iter().any(Option::is_some) {
                    add(pair, Hold::Position(components))
                } else {
                    Ok(())
                };
                position
                    .and_then(|()| match support.fix.rotation {
                        FixedRotation::Free => Ok(()),
                        FixedRotation::Angle => add(pair + 1, Hold::Direction(angle)),
                        FixedRotation::Gradient => {
                            add(pair + 1, Hold::Gradient { reference: gradient, rotation })
                        }
                    })
                    .map_err(|what| SystemError::HeldTwice {
                        what,
                        beam: part.name.clone(),
                        s: support.at.s,
                    })?;
            } else {
                let mut rows: Vec<(usize, Row)> = components
                    .iter()
                    .enumerate()
                    .filter_map(|(axis, c)| c.map(|value| (0, Row::Position { axis, value })))
                    .collect();
                match support.fix.rotation {
                    FixedRotation::Free => {}
                    FixedRotation::Angle => rows.push((1, Row::Direction(angle))),
                    FixedRotation::Gradient => rows.extend(
                        (0..2).map(|axis| (1, Row::Gradient { axis, reference: gradient, rotation })),
                    ),
                }
                for (order, row) in rows {
                    let table = part.basis.points(&[s], &[order]).map_err(in_basis)?;
                    constraints.push(Constraint::new(&table, part.offset(), row));
                }
            }
        }
        self.supports = Supports::new(held);
        self.constraints = constraints;
        Ok(())
    }

    /// The beams' parts.
    pub fn beams(&self) -> &[BeamPart] {
        &self.beams
    }

    /// Number of coordinates, held ones included.
    pub fn coordinates(&self) -> usize {
        4 * self.nodes
    }

    /// Number of Lagrange multipliers.
    pub fn multipliers(&self) -> usize {
        self.constraints.len()
    }

    /// Unknowns: coordinates that are not held, and multipliers.
    pub fn degrees_of_freedom(&self) -> usize {
        self.coordinates() - self.supports.count() + self.multipliers()
    }

    /// Coordinates of the stress-free state.
    pub fn reference(&self) -> &[f64] {
        &self.reference
    }

    /// Length of the longest beam \[m\]: the scale of positions.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Largest EA \[N\], the scale of internal forces.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// By how much the internal forces on a node change when a position changes by its round-off \[N\]:
    /// ε max(EA, 12 EI/h²) L/h with the smallest spacing h of nodes.
    pub fn round_off(&self) -> f64 {
        self.round_off
    }

    /// The order of magnitude of the lowest vibration's ω² \[1/s²\]: EI/(ρA L⁴), or for a string a small part of
    /// EA/(ρA L²).
    pub fn lowest_vibration_scale(&self) -> f64 {
        self.lowest_vibration
    }

    /// The supports that are eliminated.
    pub fn supports(&self) -> &Supports {
        &self.supports
    }

    /// Per coordinate, whether a support at a node holds it, in that support's frame.
    pub fn held(&self) -> Vec<bool> {
        let mut held = vec![false; self.coordinates()];
        self.supports.eliminated().for_each(|i| held[i] = true);
        held
    }

    /// The supports that are constraint rows.
    pub fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }

    /// Whether tangents are symmetric.
    pub fn is_symmetric(&self) -> bool {
        self.internal.iter().chain(&self.loads).all(|effect| effect.is_symmetric())
    }

    /// A zero tangent of the right pattern.
    pub fn matrix(&self) -> Matrix {
        Matrix::zeros(self.nodes, self.blocks, self.is_symmetric())
    }

    /// `f = f_int(q) + λ f_load(q)`.
    pub fn force(&self, load: f64, q: &[f64], f: &mut [f64]) {
        f.fill(0.0);
        for effect in &self.internal {
            effect.add_force(1.0, q, f);
        }
        self.add_loads(load, q, f);
    }

    /// `f += factor · f_load(q)`.
    pub fn add_loads(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        self.add_constant_load(factor, f);
        for effect in self.varying_loads() {
            effect.add_force(factor, q, f);
        }
    }

    fn add_constant_load(&self, factor: f64, f: &mut [f64]) {
        for (f, load) in f.iter_mut().zip(&self.constant_load) {
            *f += factor * load;
        }
    }

    fn varying_loads(&self) -> impl Iterator<Item = &dyn Effect> {
        self.loads.iter().map(|effect| &**effect).filter(|effect| !effect.is_constant())
    }

    /// Whether a load does work that no potential counts.
    pub fn has_work(&self) -> bool {
        self.loads.iter().any(|effect| !effect.is_conservative())
    }

    /// Power \[W\] of the loads without potential in the state (q, v); `scratch` is overwritten.
    pub fn power(&self, q: &[f64], v: &[f64], scratch: &mut [f64]) -> f64 {
        scratch.fill(0.0);
        for effect in self.loads.iter().filter(|effect| !effect.is_conservative()) {
            effect.add_force(-1.0, q, scratch);
        }
        scratch.iter().zip(v).map(|(f, v)| f * v).sum()
    }

    /// The same force as [`Self::force`], and its derivative by q; stress resultants in the tangent are extrapolated
    /// from the iterate `before` (see [`crate::effect`]).
    pub fn force_and_tangent(
        &self,
        load: f64,
        q: &[f64],
        before: &[f64],
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        f.fill(0.0);
        k.clear();
        for effect in &self.internal {
            effect.add_force_and_tangent(1.0, q, before, f, k, workspace);
        }
        self.add_constant_load(load, f);
        for effect in self.varying_loads() {
            effect.add_force_and_tangent(load, q, before, f, k, workspace);
        }
    }

    /// `f = K v` with the tangent of [`Self::force_and_tangent`] at `q`, but to many more digits where the mesh is fine.
    pub fn tangent_product(&self, load: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        f.fill(0.0);
        for effect in &self.internal {
            effect.add_tangent_product(1.0, q, v, f);
        }
        for effect in self.loads.iter().filter(|_| load != 0.0) {
            effect.add_tangent_product(load, q, v, f);
        }
    }

    /// The tangent of the internal forces alone, which is symmetric.
    pub fn internal_tangent(&self, q: &[f64]) -> Matrix {
        self.sum_of_tangents(&self.internal, q)
    }

    /// The constant mass matrix, if inertia was asked for.
    pub fn mass_matrix(&self) -> Matrix {
        self.sum_of_tangents(&self.inertia, &vec![0.0; self.coordinates()])
    }

    fn sum_of_tangents(&self, effects: &[Box<dyn Effect>], q: &[f64]) -> Matrix {
        let mut sum = Matrix::zeros(self.nodes, self.blocks, true);
        let mut force = vec![0.0; self.coordinates()];
        let mut workspace = Workspace::default();
        for effect in effects {
            effect.add_force_and_tangent(1.0, q, q, &mut force, &mut sum, &mut workspace);
        }
        sum
    }

    /// Scaled rows of ∂g/∂q in the supports' frames, without the held coordinates.
    pub fn border(&self, load: f64) -> Vec<BorderRow> {
        let mut dense = vec![0.0; self.coordinates()];
        let rows = self.constraints.iter().map(|constraint| {
            dense.fill(0.0);
            let scale = constraint.scale(self.stiffness, self.length);
            for (i, value) in constraint.gradient(load) {
                dense[i] = scale * value;
            }
            self.supports.to_frames(load, &mut dense);
            dense.iter().copied().enumerate().filter(|(_, value)| *value != 0.0).collect()
        });
        rows.collect()
    }

    /// Energies at load factor `load`; `velocity` where there is motion.
    pub fn energy(&self, load: f64, q: &[f64], velocity: Option<&[f64]>) -> Energy {
        let sum = |effects: &[Box<dyn Effect>], kind: Kind, q: &[f64]| -> f64 {
            effects.iter().filter(|e| e.kind() == kind).map(|e| e.energy(q)).sum()
        };
        Energy {
            stretch: sum(&self.internal, Kind::Stretch, q),
            bend: sum(&self.internal, Kind::Bend, q),
            kinetic: velocity.map_or(0.0, |v| self.inertia.iter().map(|e| e.energy(v)).sum()),
            potential: load * self.loads.iter().map(|e| e.energy(q)).sum::<f64>(),
            work: 0.0,
        }
    }
}

fn lowest_vibration_scale(model: &Model, length: f64) -> f64 {
    let sections = model.beams.iter().map(|beam| beam.section);
    sections.fold(0.0, |scale: f64, section| {
        let mass = section.mass_per_length.unwrap_or(f64::INFINITY);
        let bending = section.bending_stiffness.unwrap_or(0.0) / length.powi(2);
        let axial = 1e-9 * section.axial_stiffness.unwrap_or(0.0);
        scale.max(bending.max(axial) / (mass * length.powi(2)))
    })
}
