//! Membrane locking, measured on the states of a run.
//!
//! A cell whose shape functions cannot follow a bent axis is stretched where it should only bend,
//! by a strain that oscillates within the cell. The strain due to loads is smooth, so that the part
//! of ε that is not linear in a cell tells the two apart:
//!
//! ```text
//! ½ ∫ EA (ε − ε_linear)² ds / ½ ∫ EI (κ − κ₀)² ds
//! ```
//!
//! is the energy that bending takes beyond its own, relative to its own: by this part a beam is too
//! stiff.
//!
//! A string may lock in another way. With too few cells for its shape, it is held by tensions and
//! thrusts of neighbouring points that cancel each other and are far larger than the axial force
//! that follows from the balance of one side of a cut. Their energy reveals it.

use crate::assembly::BuildError;
use crate::basis::BasisTable;
use crate::effect::curvature;
use crate::model::{Along, GaussPoints, Model, StrainMeasure};
use crate::results::Shape;
use crate::system::{Fields, System};
use nalgebra::Vector2;

/// Part of the bending energy beyond which locking is reported.
const TOLERATED: f64 = 0.005;
/// States whose bending energy is a smaller part of the largest one are not considered.
const STRAIGHT: f64 = 0.1;
/// Ratio of a string's stretch energy to that of the forces that balance its cuts, beyond which
/// most of the stretch is in equilibrium with itself.
const JAMMED: f64 = 10.0;
/// Strain up to which the stretch of a string counts as round-off.
const LEAST_STRAIN: f64 = 1e-9;
/// Part of a beam's whole elastic energy up to which locking does not matter.
const IRRELEVANT: f64 = 1e-3;

/// The beams of a model that may lock, with their energies in the states so far.
#[derive(Clone)]
pub(super) struct Locking {
    beams: Vec<LockingBeam>,
}

#[derive(Clone)]
struct LockingBeam {
    name: String,
    points: GaussPoints,
    cable: bool,
    measure: StrainMeasure,
    /// EA \[N\].
    axial_stiffness: Along,
    /// EI \[N m²\]; `None` for a string.
    bending_stiffness: Option<Along>,
    offset: usize,
    /// r' at the points for stretching, r' and r'' at those for bending.
    tables: [BasisTable; 2],
    /// ε and κ of the stress-free state there.
    reference: [Vec<f64>; 2],
    /// Energies \[J\] of each state: of bending, of all stretch, and of that which bending causes.
    seen: Vec<[f64; 3]>,
}

impl Locking {
    /// Watches strings, and all beams that resist stretch at more points than a cell can follow.
    pub fn new(model: &Model, system: &System) -> Result<Self, BuildError> {
        let mut beams = Vec::new();
        for (beam, part) in model.beams.iter().zip(system.beams()) {
            let points = beam.gauss_points;
            let Some(axial_stiffness) = beam.section.axial_stiffness.clone() else { continue };
            // What it compares are energies of linear springs.
            if !beam.section.is_linear() {
                continue;
            }
            // Stretch is resisted at no more points than a cell can follow.
            let follows = points.stretch <= if points.lobatto { 3 } else { 2 };
            if beam.section.bending_stiffness.is_some() && follows {
                continue;
            }
            let table = |rule, orders: &[usize]| {
                part.basis.table(rule, orders).map_err(|e| BuildError::basis(&part.name, e))
            };
            let tables = [table(points.stretch_rule(), &[1])?, table(points.bend_rule(), &[1, 2])?];
            let mut watched = LockingBeam {
                name: beam.name.clone(),
                points,
                cable: matches!(beam.discretization, crate::model::Discretization::Ancf { .. }),
                measure: beam.strain,
                axial_stiffness,
                bending_stiffness: beam.section.bending_stiffness.clone(),
                offset: part.offset(),
                tables,
                reference: [Vec::new(), Vec::new()],
                seen: Vec::new(),
            };
            watched.reference = [watched.strains(system.reference()), watched.curvatures(system.reference())];
            beams.push(watched);
        }
        Ok(Self { beams })
    }

    /// Takes a state into account.
    pub fn see(&mut self, q: &[f64]) {
        for beam in &mut self.beams {
            beam.seen.push(beam.energies(q));
        }
    }

    /// Messages on strings whose stretch is in equilibrium with itself in the last state, where its
    /// energy matters against the work `scale` of the loads \[J\]. `shapes` holds the section
    /// forces.
    pub fn jammed(&self, shapes: &[Shape], scale: f64) -> impl Iterator<Item = String> {
        let strings = self.beams.iter().filter(|beam| beam.bending_stiffness.is_none());
        strings.filter_map(move |beam| {
            let shape = shapes.iter().find(|shape| shape.beam == beam.name)?;
            let stretch = beam.seen.last()?[1];
            let pieces = shape.s.windows(2).zip(shape.axial_force.windows(2));
            let energies = pieces.map(|(s, n)| {
                let middle = 0.5 * (s[0] + s[1]);
                let stiffness = beam.axial_stiffness.at(middle, middle);
                0.25 * (s[1] - s[0]) * (n[0] * n[0] + n[1] * n[1]) / stiffness
            });
            let balanced = energies.sum::<f64>();
            let length = *shape.s.last()?;
            let stiffness = beam.axial_stiffness.mean(length);
            let least = 0.5 * stiffness * length * LEAST_STRAIN * LEAST_STRAIN;
            (stretch > JAMMED * balanced && stretch > least.max(TOLERATED * scale)).then(|| {
                format!(
                    "string `{}` holds itself: its stretch takes {stretch:.1e} J, and its section forces account for {balanced:.1e} J, so that \
                     its cells are too few for the shape; use more elements or nodes, or a smaller `axial_stiffness`",
                    beam.name,
                )
            })
        })
    }

    /// Messages on beams that lock.
    pub fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        self.beams.iter().filter_map(LockingBeam::warning)
    }
}

impl LockingBeam {
    /// A field at all points of a table, computed from the derivatives at each.
    fn at_points(&self, table: &BasisTable, q: &[f64], of: impl Fn(&[[f64; 2]]) -> f64) -> Vec<f64> {
        let mut values = Vec::with_capacity(table.points());
        for cell in &table.cells {
            let (_, rows) = table.block(*cell);
            let q = &q[2 * (self.offset + cell.first as usize)..];
            for rows in rows.chunks_exact(table.row_stride()) {
                let mut fields = [[0.0; 2]; 2];
                for (field, row) in fields.iter_mut().zip(rows.chunks_exact(table.width)) {
                    for (n, q) in row.iter().zip(q.chunks_exact(2)) {
                        field[0] += n * q[0];
                        field[1] += n * q[1];
                    }
                }
                values.push(of(&fields));
            }
        }
        values
    }

    fn strains(&self, q: &[f64]) -> Vec<f64> {
        let strain = |z: &[[f64; 2]]| {
            let fields = Fields { position: [0.0; 2], gradient: z[0], second: [0.0; 2] };
            fields.strain(self.measure)
        };
        self.at_points(&self.tables[0], q, strain)
    }

    fn curvatures(&self, q: &[f64]) -> Vec<f64> {
        self.at_points(&self.tables[1], q, |z| curvature(&Vector2::from(z[0]), &Vector2::from(z[1])))
    }

    fn energies(&self, q: &[f64]) -> [f64; 3] {
        let [of_stretch, of_bend] = &self.tables;
        let changes = |now: Vec<f64>, before: &[f64]| -> Vec<f64> {
            now.iter().zip(before).map(|(a, b)| a - b).collect()
        };
        let strains = changes(self.strains(q), &self.reference[0]);
        let curvatures = changes(self.curvatures(q), &self.reference[1]);
        let mut energies = [0.0; 3];
        // The stiffnesses of a cell are taken in its middle.
        let bending = |middle: f64| self.bending_stiffness.as_ref().map_or(0.0, |ei| ei.at(middle, middle));
        let points = of_bend.points_per_cell;
        let cells =
            of_bend.cells.iter().zip(curvatures.chunks_exact(points)).zip(of_bend.s.chunks_exact(points));
        for ((cell, kappa), s) in cells {
            let (weights, _) = of_bend.block(*cell);
            let ei = bending(s.iter().sum::<f64>() / points as f64);
            energies[0] +=
                0.5 * ei * weights.iter().zip(kappa).map(|(w, kappa)| w * kappa * kappa).sum::<f64>();
        }
        let points = of_stretch.points_per_cell;
        let cells =
            of_stretch.cells.iter().zip(strains.chunks_exact(points)).zip(of_stretch.s.chunks_exact(points));
        for ((cell, strain), s) in cells {
            let (w, _) = of_stretch.block(*cell);
            let sum = |f: &dyn Fn(usize) -> f64| (0..points).map(|i| w[i] * f(i)).sum::<f64>();
            let length = sum(&|_| 1.0);
            let (centre, mean) = (sum(&|i| s[i]) / length, sum(&|i| strain[i]) / length);
            let spread = sum(&|i| (s[i] - centre).powi(2));
            let slope = sum(&|i| (s[i] - centre) * (strain[i] - mean)) / spread;
            let ea = self.axial_stiffness.at(centre, centre);
            energies[1] += 0.5 * ea * sum(&|i| strain[i].powi(2));
            energies[2] += 0.5 * ea * sum(&|i| (strain[i] - mean - slope * (s[i] - centre)).powi(2));
        }
        energies
    }

    fn warning(&self) -> Option<String> {
        self.bending_stiffness.as_ref()?;
        let most = self.seen.iter().fold(0.0_f64, |most, [bend, ..]| most.max(*bend));
        let bent = self.seen.iter().filter(|[bend, ..]| *bend > STRAIGHT * most);
        let relevant = bent.filter(|[bend, stretch, locked]| *locked > IRRELEVANT * (bend + stretch));
        let too_stiff = relevant.fold(0.0_f64, |worst, [bend, _, locked]| worst.max(locked / bend));
        if too_stiff <= TOLERATED {
            return None;
        }
        let advice = if self.cable {
            "leave `gauss_points` out, or use more elements"
        } else {
            "use more nodes, or fewer `gauss_points` for stretching"
        };
        Some(format!(
            "beam `{}` locks: stretch that bending alone causes within its cells takes {:.1} % of the energy of bending, by so much the beam is too \
             stiff, and near a limit of its load by several times more; {} points a cell resist it: {advice}",
            self.name,
            100.0 * too_stiff,
            self.points.stretch,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ½ EA L ε² of ε = 10⁻⁹ is 3·10⁻¹⁴ J for 2 m of 3·10⁴ N: what stores less than that, and has
    /// no section force at all, is strained by round-off.
    #[test]
    fn what_round_off_strains_does_not_hold_itself() {
        let told = |stretch: f64| {
            let string = LockingBeam {
                name: "a".into(),
                points: GaussPoints { stretch: 5, bend: 3, lobatto: false },
                cable: true,
                measure: StrainMeasure::Engineering,
                axial_stiffness: Along::Constant(3e4),
                bending_stiffness: None,
                offset: 0,
                tables: [BasisTable::default(), BasisTable::default()],
                reference: [Vec::new(), Vec::new()],
                seen: vec![[0.0, stretch, 0.0]],
            };
            let slack = Shape {
                beam: "a".into(),
                s: vec![0.0, 2.0],
                axial_force: vec![0.0, 0.0],
                ..Shape::default()
            };
            let locking = Locking { beams: vec![string] };
            locking.jammed(&[slack], 0.0).count()
        };
        assert_eq!([2.9e-14, 3.1e-14].map(told), [0, 1]);
    }
}
