//! The semi-discrete system: the coordinates, effects, supports and constraints of a model, ready
//! for a solver.
//!
//! # Coordinates
//! Beam after beam and node after node, four coordinates per node: `[x, y, x', y']`, positions in
//! metres, gradients without unit. Fixed coordinates stay in this vector and are eliminated in
//! place ([`supports`]). Supports between nodes and joints add one Lagrange multiplier per row
//! ([`constraints`], [`joint`]), and so do the lengths of beams without axial stiffness
//! ([`inextensible`]).
//!
//! # Equations of statics
//! ```text
//! f_int(q) + λ f_load(q) + Bᵀ μ = 0,   g(q, λ) = 0
//! ```
//! with the load factor λ ∈ [0, 1]. A load is a density of its negative work, hence the plus sign.

mod actuation;
pub mod constraints;
mod contacts;
mod cut;
mod energy;
mod fix;
mod held;
mod history;
mod imbalance;
pub mod inextensible;
mod inventory;
pub mod joint;
pub mod laws;
mod lengths;
mod measure;
pub mod polar;
pub mod prescribed;
mod reaction;
mod redundancy;
mod resisted;
mod rows;
mod sums;
pub mod supports;
pub mod turning;
mod view;

pub use cut::Balanced;
pub use energy::Energy;
pub use inventory::{EffectEntry, Inventory};
pub use measure::Measured;
pub use reaction::Reaction;
pub use view::{Change, Fields, View, unfold};

use std::sync::Arc;

use crate::assembly::{
    Acting, Amplitude, Assembly, BuildError, DiscretizedBeam, Kind, Needs, Owner, Owners, Resistance, Terms,
    nodes,
};
use crate::basis::{Basis, BasisCache};
use crate::centreline::Curve;
use crate::effect;
use crate::linear::Matrix;
use crate::model::freedom::Freedom;
use crate::model::{Along, Centreline, Discretization, Joint, Model, Place};
use constraints::Constraint;
pub use constraints::Holds;
use imbalance::Start;
pub use imbalance::Unbalanced;
use lengths::Lengths;
use polar::Polar;
use reaction::Source;
use supports::Supports;

/// Estimate of ω² of a hanging chain, in units of its weight divided by ρA L²; it is deliberately
/// below the exact 1.45.
const CHAIN: f64 = 0.1;

/// The largest mean axial force by round-off that was seen, in ε EA √(L/h).
const MEAN_OF_CELLS: f64 = 0.3;

/// The equations of a model.
pub struct System {
    beams: Vec<DiscretizedBeam>,
    nodes: usize,
    blocks: usize,
    terms: Terms,
    /// Amplitude of all loads without a law of their own.
    amplitude: Amplitude,
    /// The sum of those of these loads that are the same in every state.
    constant_load: Vec<f64>,
    supports: Supports,
    /// Gradients that are described by polar coordinates in a motion.
    polar: Polar,
    constraints: Vec<Constraint>,
    /// The actuated beams.
    actuated: Vec<actuation::Actuated>,
    /// Per support, and then per joint: where it acts.
    sources: Vec<Source>,
    /// Per constraint row of an inextensible beam, which are the last rows: where its multiplier is
    /// the axial force.
    lengths: Vec<inextensible::Row>,
    /// Inextensible beams whose rows are summed cell by cell.
    kept: Vec<Lengths>,
    /// The numbers of the constraint rows that these do not sum.
    tied: Vec<usize>,
    /// Per coordinate, whether a support at a node fixes it, in that support's frame.
    fixed: Vec<bool>,
    /// Per node, whether a support or a weld changes the components of a row there.
    special: Vec<bool>,
    reference: Vec<f64>,
    /// The state in which an analysis begins, where it is not the stress-free one.
    start: Option<Start>,
    length: f64,
    stiffness: f64,
    round_off: f64,
    lowest_vibration: f64,
    has_strings: bool,
    bending: Vec<bool>,
    goes_slack: bool,
    /// Number of rigid motions that neither supports, joints nor springs resist, where it is known; counted in statics
    /// only.
    rigid_motions: Option<usize>,
    /// Number of those that supports and joints leave and that no spring, foundation or other effect has a stiffness
    /// against where the analysis begins.
    free_motions: usize,
}

/// The numbers of the parts among `owners`.
fn parts(owners: &[Owner]) -> impl Iterator<Item = usize> {
    owners.iter().filter_map(|owner| match owner {
        Owner::Part(number) => Some(*number),
        Owner::Beam(_) | Owner::Gone(_) => None,
    })
}

impl System {
    /// Builds the equations of `model`: shape functions, tables of the effects that the model
    /// contains, supports and constraints.
    ///
    /// # Errors
    /// [`BuildError`] if the model contradicts itself or its shape functions cannot be built.
    pub fn build(model: &Model, needs: Needs) -> Result<Self, BuildError> {
        Self::build_with(model, needs, None)
    }

    /// [`Self::build`], with shape functions that `cache` has or keeps from then on.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub fn build_with(model: &Model, needs: Needs, cache: Option<&BasisCache>) -> Result<Self, BuildError> {
        if model.beams.is_empty() {
            return Err(BuildError::NoBeam);
        }
        let mut beams: Vec<DiscretizedBeam> = Vec::with_capacity(model.beams.len());
        let mut reference = Vec::new();
        let (mut stiffness, mut round_off) = (0.0_f64, 0.0_f64);
        for (index, beam) in model.beams.iter().enumerate() {
            let in_curve = |cause| BuildError::Curve { beam: beam.name.clone(), cause };
            let in_basis = |e| BuildError::basis(&beam.name, e);
            let curve = Curve::new(&beam.centreline).map_err(in_curve)?;
            let (length, breaks) = (curve.length(), model.breaks(index));
            let basis = match cache {
                Some(cache) => cache.get(&beam.discretization, length, &breaks),
                None => Basis::broken(&beam.discretization, length, &breaks).map(Arc::new),
            };
            let basis = basis.map_err(in_basis)?;
            let first_node = reference.len() / 4;
            for &s in basis.nodes() {
                let ([x, y], [tx, ty]) = (curve.position(s), curve.tangent(s));
                reference.extend([x, y, tx, ty]);
            }
            let linear = match beam.discretization {
                Discretization::Ancf { .. } | Discretization::Open => true,
                Discretization::Rpim { polynomial_terms, .. } => polynomial_terms >= 2,
            };
            let straight = linear && matches!(beam.centreline, Centreline::Line { .. });
            let largest = |quantity: &Option<Along>| quantity.as_ref().map(|along| along.bounds(length)[1]);
            let axial = largest(&beam.section.axial_stiffness);
            let bending = largest(&beam.section.bending_stiffness);
            stiffness = stiffness.max(axial.or(bending.map(|ei| ei / length.powi(2))).unwrap_or(0.0));
            // A position is stored with the round-off ε L. A cubic element turns this into a force
            // with its stiffness EA/h, or 12 EI/h³ across.
            let spacing = basis.nodes().windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
            let across = 12.0 * bending.unwrap_or(0.0) / spacing.powi(2);
            round_off = round_off.max(f64::EPSILON * axial.unwrap_or(0.0).max(across) * length / spacing);
            beams.push(DiscretizedBeam { name: beam.name.clone(), basis, first_node, straight });
        }
        let nodes = reference.len() / 4;
        let blocks = beams.iter().map(|b| b.basis.width() / 2).max().unwrap_or(1);
        let length = beams.iter().map(|b| b.basis.length()).fold(0.0, f64::max);
        let start = start(model, &beams, &reference)?;
        let lowest_vibration = lowest_vibration_scale(model, &beams, length);
        let mut system = Self {
            beams,
            nodes,
            blocks,
            terms: Terms::default(),
            amplitude: if needs.motion { Amplitude::Full } else { Amplitude::Proportional },
            constant_load: Vec::new(),
            supports: Supports::default(),
            polar: Polar::default(),
            constraints: Vec::new(),
            actuated: Vec::new(),
            sources: Vec::new(),
            lengths: Vec::new(),
            kept: Vec::new(),
            tied: Vec::new(),
            fixed: Vec::new(),
            special: Vec::new(),
            reference,
            start: start.map(Start::given),
            length,
            stiffness,
            round_off,
            has_strings: model.beams.iter().any(|beam| beam.section.bending_stiffness.is_none()),
            bending: model.beams.iter().map(|beam| beam.section.bending_stiffness.is_some()).collect(),
            goes_slack: model
                .beams
                .iter()
                .any(|beam| beam.section.axial_law.as_ref().is_some_and(|law| law.goes_slack())),
            rigid_motions: None,
            free_motions: 0,
            lowest_vibration,
        };
        let masses = model.parts.iter().filter_map(|part| part.mass()).collect();
        let mut assembly = Assembly::new(&model.beams, &system.beams, &system.reference, masses, needs);
        for beam in 0..model.beams.len() {
            effect::of_section(beam).iter().try_for_each(|part| part.add_to(&mut assembly))?;
            assembly.belong_to(Owner::Beam(beam));
        }
        for (number, part) in model.parts.iter().enumerate() {
            let already = !needs.motion && model.stands(number);
            assembly.set_acting(if already { Acting::Already } else { Acting::Not });
            part.add_to(&mut assembly)?;
            assembly.belong_to(Owner::Part(number));
        }
        let fading = if needs.motion { &[][..] } else { &model.fading[..] };
        for (number, (part, time)) in fading.iter().enumerate() {
            assembly.set_acting(Acting::NoLonger { time: *time });
            part.add_to(&mut assembly)?;
            assembly.belong_to(Owner::Gone(number));
        }
        system.terms = assembly.finish();
        if let Some(mut start) = system.start.take() {
            start.variables = system.variables_without_path(&start.q);
            system.start = Some(start);
        }
        system.actuated = actuation::actuated(model, fading, &system);
        system.constant_load = vec![0.0; system.coordinates()];
        for load in system.terms.loads.iter().filter(|load| load.is_summed()) {
            load.effect.add_force(1.0, &system.reference, &mut system.constant_load);
        }
        (system.supports, system.constraints, system.sources) = fix::fix(&system, &model.supports, needs)?;
        for joint in &model.joints {
            let first = system.constraints.len();
            let rows = joint::rows(&system, *joint, model.standing.is_some())?;
            system.constraints.extend(rows);
            system.sources.push(Source::Rows(first..system.constraints.len()));
        }
        system.polar = joint::polar(&system, &model.joints)?;
        let rows = inextensible::rows(&system, model)?;
        system.lengths = rows.places;
        system.constraints.extend(rows.constraints);
        let summed = |row: &usize| rows.summed.iter().any(|(_, rows)| rows.contains(row));
        system.tied = (0..system.constraints.len()).filter(|row| !summed(row)).collect();
        system.kept = rows.summed.into_iter().map(|(lengths, _)| lengths).collect();
        system.fixed = vec![false; system.coordinates()];
        system.supports.eliminated().for_each(|i| system.fixed[i] = true);
        system.special = vec![false; system.nodes];
        let special = system.supports.nodes().chain(system.polar.nodes());
        special.for_each(|node| system.special[node] = true);
        if system.stiffness == 0.0 {
            // Chains have no stiffness; the scale of their forces is their load.
            let load = system.norm(&system.constant_load);
            system.stiffness = if load > 0.0 { load } else { 1.0 };
            let masses = model.beams.iter().zip(&system.beams).filter_map(|(beam, part)| {
                Some(beam.section.mass_per_length.as_ref()?.mean(part.basis.length()))
            });
            let mass = length * masses.fold(f64::INFINITY, f64::min);
            system.lowest_vibration = CHAIN * system.stiffness / (mass * length);
        }
        if !needs.motion && system.start.is_some() {
            let start = system.start().to_vec();
            system.begin_lengths_open(&start);
        }
        system.check_room()?;
        system.check_rows(model)?;
        if !needs.motion {
            (system.free_motions, system.rigid_motions) = system.count_rigid_motions(model)?;
        }
        Ok(system)
    }

    /// The arc length of a place on its beam; round-off beyond an end is removed.
    ///
    /// # Errors
    /// [`BuildError`] naming `what`, if the place is not on the beam.
    pub fn arc_length(&self, what: &'static str, at: Place) -> Result<f64, BuildError> {
        self.part(what, at).map(|(_, s)| s)
    }

    /// Index of the beam and arc length \[m\] of the node to which an unknown belongs; those of the
    /// first node for a multiplier.
    pub fn place_of(&self, unknown: usize) -> (usize, f64) {
        let node = unknown / 4;
        let beams = self.beams.iter().enumerate().rev();
        beams
            .filter(|(_, part)| part.first_node <= node)
            .find_map(|(i, part)| Some((i, *part.basis.nodes().get(node - part.first_node)?)))
            .unwrap_or((0, 0.0))
    }

    fn part(&self, what: &'static str, at: Place) -> Result<(&DiscretizedBeam, f64), BuildError> {
        let none = BuildError::NoSuchBeam { what, beam: at.beam, count: self.beams.len() };
        let part = self.beams.get(at.beam).ok_or(none)?;
        Ok((part, part.arc_length(what, at.s)?))
    }

    /// The gradient at a place at the start.
    fn gradient_of(&self, at: Place) -> Result<[f64; 2], BuildError> {
        Ok(self.fields_of(at)?.gradient)
    }

    fn fields_of(&self, at: Place) -> Result<Fields, BuildError> {
        let (part, s) = self.part("a joint", at)?;
        let view =
            View::point(&part.basis, part.offset(), s).map_err(|e| BuildError::basis(&part.name, e))?;
        Ok(view.fields(self.start()))
    }

    /// Numbers of rigid motions that supports and joints leave to the beams: of those against which nothing has a stiffness, and,
    /// where it is known, of those that nothing may resist however far it has moved.
    fn count_rigid_motions(&self, model: &Model) -> Result<(usize, Option<usize>), BuildError> {
        let resistances = || model.parts.iter().flat_map(|part| part.resists());
        let supports = model.supports.iter().map(|support| support.at);
        let joints = model.joints.iter().flat_map(Joint::places);
        let starts = (0..model.beams.len()).map(|beam| Place { beam, s: 0.0 });
        let resisting = resistances().filter_map(|resistance| match resistance {
            Resistance::Displacement(at, _) | Resistance::Direction(at) => Some(at),
            Resistance::Contact(_) => None,
        });
        let mut positions = Vec::new();
        for place in supports.chain(joints).chain(starts).chain(resisting) {
            positions.push((place, self.fields_of(place)?.position));
        }
        let position = |place: Place| {
            positions.iter().find(|(at, _)| *at == place).map_or([0.0; 2], |(_, position)| *position)
        };
        let mut freedom = Freedom::new(model, self.length, position);
        let free = freedom.motions().len();
        let resisted = self.resisted(&freedom);
        let of_beams =
            |kind: Kind| matches!(kind, Kind::Stretch | Kind::Bend | Kind::Coupling | Kind::Contact);
        let told = |kind: Kind| matches!(kind, Kind::Spring | Kind::TorsionSpring | Kind::Foundation);
        let kinds = || self.terms.internal.iter().map(|effect| effect.kind());
        let left = if kinds().all(of_beams) {
            Some(free)
        } else if kinds().all(|kind| of_beams(kind) || told(kind)) {
            freedom.resist(model, position);
            Some(freedom.motions().len())
        } else {
            // What another effect resists is not known.
            None
        };
        Ok((free - resisted, left))
    }

    /// The discretised beams.
    pub fn beams(&self) -> &[DiscretizedBeam] {
        &self.beams
    }

    /// Effects of the model that the analysis leaves out, with the names of their beams.
    pub fn left_out(&self) -> impl Iterator<Item = (Kind, &str)> {
        self.terms.left_out.iter().map(|(kind, beam)| (*kind, self.beams[*beam].name.as_str()))
    }

    /// Number of coordinates, including fixed ones.
    pub fn coordinates(&self) -> usize {
        4 * self.nodes
    }

    /// Number of Lagrange multipliers.
    pub fn multipliers(&self) -> usize {
        self.constraints.len() + self.terms.held.len()
    }

    /// Number of unknowns: coordinates that are not fixed, and multipliers.
    pub fn degrees_of_freedom(&self) -> usize {
        self.coordinates() - self.supports.count() + self.multipliers()
    }

    /// Coordinates of the stress-free state.
    pub fn reference(&self) -> &[f64] {
        &self.reference
    }

    /// Coordinates of the state in which an analysis begins.
    pub fn start(&self) -> &[f64] {
        self.start.as_ref().map_or(&self.reference, |start| &start.q)
    }

    /// Whether an analysis begins in a given shape, which is no equilibrium yet.
    pub fn starts_bent(&self) -> bool {
        self.start.as_ref().is_some_and(|start| !start.taken_up)
    }

    /// Per friction and per torsion spring, in the order of the internal variables: the number of
    /// its part in the model.
    pub fn history_of(&self) -> [Vec<usize>; 2] {
        let Owners { friction, windings, .. } = &self.terms.owners;
        [friction, windings].map(|owners| parts(owners).collect())
    }

    /// Per tendon of given length, the number of its part in the model.
    pub fn parts_of_tendons(&self) -> impl Iterator<Item = usize> {
        parts(&self.terms.owners.held)
    }

    /// Length of the longest beam \[m\]: the scale of positions.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The scale of internal forces \[N\]: the largest EA, or EI/L² of inextensible beams, or the
    /// load of chains.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// The change of the internal forces on a node when a position changes by its round-off \[N\]:
    /// ε max(EA, 12 EI/h²) L/h with the smallest node spacing h.
    pub fn round_off(&self) -> f64 {
        self.round_off
    }

    /// The mean axial force that the round-off of positions makes along a beam \[N\]. What it is off by in one cell is nearly what it is
    /// in the next with the other sign, so that of L/h cells the root counts.
    pub fn stress_round_off(&self) -> f64 {
        MEAN_OF_CELLS * (f64::EPSILON * self.stiffness * self.round_off).sqrt()
    }

    /// The order of magnitude of the lowest vibration's ω² \[1/s²\]: EI/(ρA L⁴); for a string a
    /// small fraction of EA/(ρA L²); for a chain a fraction of its load divided by ρA L².
    pub fn lowest_vibration_scale(&self) -> f64 {
        self.lowest_vibration
    }

    /// The supports at nodes, whose coordinates are eliminated.
    pub fn supports(&self) -> &Supports {
        &self.supports
    }

    /// The gradients that are described by polar coordinates in a motion.
    pub fn polar(&self) -> &Polar {
        &self.polar
    }

    /// Whether the stress-free structure can move without resistance: it contains strings, or
    /// supports and joints leave its beams a rigid motion.
    pub fn is_floppy(&self) -> bool {
        self.has_strings || self.rigid_motions.is_some_and(|left| left > 0)
    }

    /// Whether a beam has no bending stiffness.
    pub fn has_strings(&self) -> bool {
        self.has_strings
    }

    /// The beams that have a bending stiffness.
    pub fn bending_beams(&self) -> impl Iterator<Item = &DiscretizedBeam> {
        self.beams.iter().zip(&self.bending).filter_map(|(beam, bends)| bends.then_some(beam))
    }

    /// Whether an axial law resists tension only, or pressure only, so that a beam with it has no stiffness along its axis where
    /// nothing acts.
    pub fn goes_slack(&self) -> bool {
        self.goes_slack
    }

    /// Number of motions without deformation of beams against which nothing but loads has a stiffness where the analysis begins,
    /// if all beams have a bending stiffness; `None` if there are strings. Counted in analyses without motion only.
    pub fn free_motions(&self) -> Option<usize> {
        (!self.has_strings).then_some(self.free_motions)
    }

    /// Number of rigid motions that supports and joints leave in statics, if all beams have a
    /// bending stiffness; `None` if there are strings.
    pub fn rigid_motions(&self) -> Option<usize> {
        (!self.has_strings).then_some(self.rigid_motions.unwrap_or(0))
    }

    /// Weights of the coordinates, which resemble the diagonal of a mass matrix \[N/m, N m\]: EA/L²
    /// times the length w that belongs to the node, and w²/10 times as much for gradients.
    pub fn weights(&self) -> Vec<f64> {
        let scale = self.stiffness / self.length.powi(2);
        let of_beam = |part: &DiscretizedBeam| {
            let nodes = part.basis.nodes().to_vec();
            (0..nodes.len()).flat_map(move |i| {
                let left = nodes[i.saturating_sub(1)];
                let right = nodes[(i + 1).min(nodes.len() - 1)];
                let w = 0.5 * (right - left);
                let (position, gradient) = (scale * w, 0.1 * scale * w.powi(3));
                [position, position, gradient, gradient]
            })
        };
        self.beams.iter().flat_map(of_beam).collect()
    }

    /// Norm of a vector of forces \[N\]; forces on gradients are divided by the beam length.
    pub fn norm(&self, force: &[f64]) -> f64 {
        let square = |[x, y]: [f64; 2]| x * x + y * y;
        let squares = nodes(force).map(|f| square(f.position) + square(f.gradient) / self.length.powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// Per coordinate, whether a support at a node fixes it, in that support's frame.
    pub fn fixed(&self) -> &[bool] {
        &self.fixed
    }

    /// The constraint rows: of supports between nodes, of joints, and of inextensible beams.
    pub fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }

    /// Whether tangents are symmetric.
    pub fn is_symmetric(&self) -> bool {
        let loads = self.terms.loads.iter().map(|load| &load.effect);
        self.terms.friction.is_empty()
            && self.terms.internal.iter().chain(loads).all(|effect| effect.is_symmetric())
            && self.terms.timed_loads.iter().all(|load| load.is_symmetric())
    }

    /// A zero tangent with the right pattern.
    pub fn matrix(&self) -> Matrix {
        Matrix::zeros(self.nodes, self.blocks, self.is_symmetric())
    }
}

/// The coordinates in which an analysis begins, where some beam has an initial shape.
fn start(
    model: &Model,
    beams: &[DiscretizedBeam],
    reference: &[f64],
) -> Result<Option<Vec<f64>>, BuildError> {
    if model.initial_shapes.is_empty() {
        return Ok(None);
    }
    let mut start = reference.to_vec();
    for shape in &model.initial_shapes {
        let (count, beam) = (beams.len(), shape.beam);
        let part = beams.get(beam).ok_or(BuildError::NoSuchBeam { what: "an initial shape", beam, count })?;
        let curve = Curve::new(&shape.centreline)
            .map_err(|cause| BuildError::Curve { beam: part.name.clone(), cause })?;
        let stretch = curve.length() / part.basis.length();
        let nodes = start[4 * part.first_node..].chunks_exact_mut(4);
        for (node, s) in nodes.zip(part.basis.nodes()) {
            let ([x, y], tangent) = (curve.position(stretch * s), curve.tangent(stretch * s));
            node.copy_from_slice(&[x, y, stretch * tangent[0], stretch * tangent[1]]);
        }
    }
    Ok(Some(start))
}

fn lowest_vibration_scale(model: &Model, beams: &[DiscretizedBeam], length: f64) -> f64 {
    model.beams.iter().zip(beams).fold(0.0, |scale: f64, (beam, part)| {
        let mean = |quantity: &Option<Along>| quantity.as_ref().map(|along| along.mean(part.basis.length()));
        let mass = mean(&beam.section.mass_per_length).unwrap_or(f64::INFINITY);
        let bending = mean(&beam.section.bending_stiffness).unwrap_or(0.0) / length.powi(2);
        let axial = 1e-9 * mean(&beam.section.axial_stiffness).unwrap_or(0.0);
        scale.max(bending.max(axial) / (mass * length.powi(2)))
    })
}
