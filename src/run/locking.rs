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
/// Part of the work of the loads from which such a stretch is told: of a hanging string whose
/// stretch took 2.5e-4 of it, points were 6e-4 of its length from where they belong.
const JAMMED_WORK: f64 = 1e-5;
/// Strain up to which the stretch of a string counts as round-off.
const LEAST_STRAIN: f64 = 1e-9;
/// Strain within the cells of a beam that round-off of positions makes.
const ROUND_OFF: f64 = 1e-12;
/// Part of the kinetic energy that bends a beam by the round-off of a motion.
const SLIGHT: f64 = 1e-12;
/// Places that are nearer to each other are one, in lengths of a cell.
const SAME: f64 = 1e-9;
/// Gauss points for bending that are too few where bending strains are large …
const FEW: usize = 2;
/// … beyond this κ √(EI/EA).
const HELD: f64 = 0.5;
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
    /// \[m\]
    length: f64,
    offset: usize,
    /// r' at the points for stretching, r' and r'' at those for bending.
    tables: [BasisTable; 2],
    /// Whether a strain is imposed, which takes its part of the stretch without a force.
    actuated: bool,
    /// Per cell, whether an imposed strain jumps at an end of it: shape functions that cannot follow that oscillate, whatever bends.
    jumps: Vec<bool>,
    /// ε and κ of the stress-free state there.
    reference: [Vec<f64>; 2],
    /// Energies \[J\] of each state: of bending, of all stretch, and of that which bending causes.
    seen: Vec<[f64; 3]>,
}

/// Warnings on beams of cable elements that are bent so much in the state `now`, the last one, that the strain at their nodes
/// may run away: κ is large where no point for bending is, and |r'| small. Under a couple at the end of a cantilever, of which the
/// exact equilibrium is stable, that begins at κ √(EI/EA) = 1/2 on meshes of 4, 16 and 64 elements, and not with three
/// points for bending. `free` is the stress-free state.
pub(super) fn unheld(model: &Model, now: &[Shape], free: &[Shape]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (beam, (now, free)) in model.beams.iter().zip(now.iter().zip(free)) {
        let cable = matches!(beam.discretization, crate::model::Discretization::Ancf { .. });
        let stiffnesses = beam.section.axial_stiffness.as_ref().zip(beam.section.bending_stiffness.as_ref());
        let Some((stretch, bend)) = stiffnesses.filter(|_| cable && beam.gauss_points.bend <= FEW) else {
            continue;
        };
        let thickness = |(s, curvature): (&f64, &f64)| {
            let reference = free.s.partition_point(|place| place < s).min(free.s.len().saturating_sub(1));
            let bent = curvature - free.curvature.get(reference).unwrap_or(&0.0);
            (bent.abs() * (bend.at(*s, *s) / stretch.at(*s, *s)).sqrt(), *s)
        };
        let most = now
            .s
            .iter()
            .zip(&now.curvature)
            .map(thickness)
            .fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
        if most.0 > HELD {
            warnings.push(format!(
                "beam `{}` is bent to κ √(EI/EA) = {:.2} at s = {:.4e} m: beyond {HELD}, {} Gauss points a cell for bending let the strain at the \
                 nodes of cable elements run away, and curvatures and section forces with it; give \
                 `gauss_points = {{ stretch = 5, bend = 3 }}` in `basis.ancf`, or nodes without a mesh (`basis.rpim`). No beam is that thick against its radius",
                beam.name, most.0, most.1, beam.gauss_points.bend
            ));
        }
    }
    warnings
}

impl Locking {
    /// Watches strings, and all beams that resist stretch at more points than a cell can follow.
    pub fn new(model: &Model, system: &System) -> Result<Self, BuildError> {
        let mut beams = Vec::new();
        for (index, (beam, part)) in model.beams.iter().zip(system.beams()).enumerate() {
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
            let imposed: Vec<_> = model.parts.iter().filter_map(|part| part.actuation(index)).collect();
            let jumps: Vec<f64> = imposed.iter().flat_map(|imposed| imposed.strain.jumps()).collect();
            let at_jump = |ends: &[f64]| {
                let near = SAME * (ends[1] - ends[0]);
                jumps.iter().any(|s| (ends[0] - near..=ends[1] + near).contains(s))
            };
            let mut watched = LockingBeam {
                actuated: !imposed.is_empty(),
                jumps: part.basis.nodes().windows(2).map(at_jump).collect(),
                name: beam.name.clone(),
                points,
                cable: matches!(beam.discretization, crate::model::Discretization::Ancf { .. }),
                measure: beam.strain,
                axial_stiffness,
                bending_stiffness: beam.section.bending_stiffness.clone(),
                length: part.basis.nodes().last().copied().unwrap_or(0.0),
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
        let strings = self.beams.iter().filter(|beam| beam.bending_stiffness.is_none() && !beam.actuated);
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
            let least = beam.of_strain(LEAST_STRAIN);
            (stretch > JAMMED * balanced && stretch > least.max(JAMMED_WORK * scale)).then(|| {
                format!(
                    "string `{}` holds itself: its stretch takes {stretch:.1e} J, and its section forces account for {balanced:.1e} J, so that \
                     its cells are too few for the shape; use more elements or nodes, or a smaller `axial_stiffness`",
                    beam.name,
                )
            })
        })
    }

    /// Messages on beams that lock, where their bending matters beside the largest `kinetic` energy \[J\].
    pub fn warnings(&self, kinetic: f64) -> impl Iterator<Item = String> + '_ {
        self.beams.iter().filter_map(move |beam| beam.warning(SLIGHT * kinetic))
    }
}

/// A field of the beam whose coordinates begin with pair `offset`, at all points of a table, computed
/// from the derivatives at each.
pub(super) fn at_points(
    table: &BasisTable,
    offset: usize,
    q: &[f64],
    of: impl Fn(&[[f64; 2]]) -> f64,
) -> Vec<f64> {
    let mut values = Vec::with_capacity(table.points());
    for cell in &table.cells {
        let (_, rows) = table.block(*cell);
        let q = &q[2 * (offset + cell.first as usize)..];
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

impl LockingBeam {
    fn strains(&self, q: &[f64]) -> Vec<f64> {
        let strain = |z: &[[f64; 2]]| {
            let fields = Fields { position: [0.0; 2], gradient: z[0], second: [0.0; 2] };
            fields.strain(self.measure)
        };
        at_points(&self.tables[0], self.offset, q, strain)
    }

    fn curvatures(&self, q: &[f64]) -> Vec<f64> {
        at_points(&self.tables[1], self.offset, q, |z| curvature(&Vector2::from(z[0]), &Vector2::from(z[1])))
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
        for (((cell, strain), s), jumps) in cells.zip(&self.jumps) {
            let (w, _) = of_stretch.block(*cell);
            let sum = |f: &dyn Fn(usize) -> f64| (0..points).map(|i| w[i] * f(i)).sum::<f64>();
            let length = sum(&|_| 1.0);
            let (centre, mean) = (sum(&|i| s[i]) / length, sum(&|i| strain[i]) / length);
            let spread = sum(&|i| (s[i] - centre).powi(2));
            let slope = sum(&|i| (s[i] - centre) * (strain[i] - mean)) / spread;
            let ea = self.axial_stiffness.at(centre, centre);
            energies[1] += 0.5 * ea * sum(&|i| strain[i].powi(2));
            if !jumps {
                energies[2] += 0.5 * ea * sum(&|i| (strain[i] - mean - slope * (s[i] - centre)).powi(2));
            }
        }
        energies
    }

    /// The energy of a strain that is the same everywhere \[J\].
    fn of_strain(&self, strain: f64) -> f64 {
        0.5 * self.axial_stiffness.mean(self.length) * self.length * strain * strain
    }

    /// A message where it locks in states that are bent with an energy of `slight` \[J\] or more.
    fn warning(&self, slight: f64) -> Option<String> {
        self.bending_stiffness.as_ref()?;
        let least = self.of_strain(ROUND_OFF).max(slight);
        let most = self.seen.iter().fold(0.0_f64, |most, [bend, ..]| most.max(*bend));
        // A curvature that round-off makes has less energy than such a strain.
        let bent = self.seen.iter().filter(|[bend, ..]| *bend > least.max(STRAIGHT * most));
        let relevant =
            bent.filter(|[bend, stretch, locked]| *locked > least.max(IRRELEVANT * (bend + stretch)));
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

    use crate::assembly::Needs;

    /// A beam of 2 m in one cell with EA = 3 N and EI = 5 N m², behind another one.
    fn watched() -> (Locking, Vec<f64>) {
        let beam = |name: &str, y: u32, cells: u32| {
            format!(
                "beam.{name} = {{ start = [0, {y}], end = [2, {y}], axial_stiffness = 3, bending_stiffness = 5, \
                 basis.ancf = {{ elements = {cells}, gauss_points = {{ stretch = 5, bend = 3 }} }} }}\n"
            )
        };
        let held =
            |name: &str| format!("[[support]]\nbeam = '{name}'\nat = 'start'\nfix = ['x', 'y', 'angle']\n");
        let beams = [beam("other", 0, 2), beam("arm", 1, 1)].concat();
        let text = format!("{}\nanalysis.static = {{}}\n{}{}", beams, held("other"), held("arm"));
        let scene = crate::scene::parse("scene", &text);
        let model = scene.unwrap_or_else(|error| panic!("{error}\n{text}")).model().clone();
        let system = System::build(&model, Needs::default()).unwrap();
        (Locking::new(&model, &system).unwrap(), system.reference().to_vec())
    }

    /// Energies of the second beam with its two nodes at these coordinates.
    fn energies(nodes: [[f64; 4]; 2]) -> [f64; 3] {
        let (mut locking, mut q) = watched();
        assert_eq!(locking.beams.len(), 2);
        let first = q.len() - 8;
        q[first..].copy_from_slice(nodes.as_flattened());
        locking.see(&q);
        locking.beams[1].seen[0]
    }

    /// A strain that grows with the square of s: no linear one comes nearer to s² along a length L than
    /// by L⁵/180 in the square.
    #[test]
    fn energies_are_the_integrals_along_a_cell() {
        let near = |found: [f64; 3], expected: [f64; 3], within: f64| {
            let close = found.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= within);
            assert!(close, "{found:?} instead of {expected:?}");
        };
        // x = s + a s³ with ε = 3a s², and x = s + a s² with ε = 2a s.
        let a = 0.01_f64;
        let cubic = [[0.0, 1.0, 1.0, 0.0], [2.0 + 8.0 * a, 1.0, 1.0 + 12.0 * a, 0.0]];
        let squares = 9.0 * a * a * 32.0;
        near(energies(cubic), [0.0, 1.5 * squares / 5.0, 1.5 * squares / 180.0], 1e-16);
        let square = [[0.0, 1.0, 1.0, 0.0], [2.0 + 4.0 * a, 1.0, 1.0 + 4.0 * a, 0.0]];
        near(energies(square), [0.0, 1.5 * 4.0 * a * a * 8.0 / 3.0, 0.0], 1e-16);
        // y = b s² with κ = 2b and ε = 2b² s², but for higher orders of b s.
        let b = 1e-3_f64;
        let bent = [[0.0, 1.0, 1.0, 0.0], [2.0, 1.0 + 4.0 * b, 1.0, 4.0 * b]];
        let [bend, stretch, locked] = energies(bent);
        assert!((bend / (2.5 * 4.0 * b * b * 2.0) - 1.0).abs() < 1e-4, "{bend}");
        let squares = 1.5 * 4.0 * b.powi(4) * 32.0;
        assert!(
            (stretch / (squares / 5.0) - 1.0).abs() < 1e-4 && (locked / (squares / 180.0) - 1.0).abs() < 1e-4
        );
    }

    /// An imposed strain that jumps at the only node within a beam leaves no cell that tells of bending.
    #[test]
    fn cells_beside_an_imposed_strain_that_jumps_do_not_count() {
        let text = "beam.arm = { start = [0, 0], end = [3, 0], axial_stiffness = 3, bending_stiffness = 5, basis.rpim.nodes = 4 }\n\
                    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
                    effect.actuation = [{ beam = 'arm', strain = 0.1, to = 1.0 }]\nanalysis.static = {}\n";
        let scene = crate::scene::parse("scene", text).unwrap_or_else(|error| panic!("{error}"));
        let system = System::build(scene.model(), Needs::default()).unwrap();
        let locking = Locking::new(scene.model(), &system).unwrap();
        assert_eq!(locking.beams[0].jumps, [true, true, false]);
        let (mut beam, mut q) = (locking.beams[0].clone(), system.reference().to_vec());
        q.iter_mut().enumerate().for_each(|(i, q)| *q += 0.01 * (i as f64).sin());
        let all = LockingBeam { jumps: vec![false; 3], ..beam.clone() }.energies(&q)[2];
        let last = beam.energies(&q)[2];
        beam.jumps = vec![false, false, true];
        assert!((beam.energies(&q)[2] + last - all).abs() < 1e-12 * all && last > 0.0 && last < all);
    }

    /// A rod that slides is bent by round-off only.
    #[test]
    fn what_round_off_bends_does_not_lock() {
        let (mut locking, _) = watched();
        locking.beams[1].seen = vec![[2.0, 1.0, 0.02]];
        assert_eq!([0.0, 1e12, 3e12].map(|kinetic| locking.warnings(kinetic).count()), [1, 0, 0]);
    }

    /// The worst of the states that are bent by a tenth of the most at least, and where what is locked
    /// is more than a thousandth of all energy.
    #[test]
    fn the_worst_state_is_told_of_those_that_matter() {
        let (mut locking, _) = watched();
        let told = |locking: &mut Locking, seen: &[[f64; 3]]| {
            locking.beams[1].seen = seen.into();
            locking.warnings(0.0).next()
        };
        for (seen, percent) in [
            (&[[2.0, 1.0, 0.0101]][..], Some("0.5 %")),
            (&[[2.0, 1.0, 0.0099]], None),
            (&[[2.0, 1.0, 0.02], [1.0, 1.0, 0.04], [1.5, 1.0, 0.03]], Some("4.0 %")),
            (&[[2.0, 1.0, 0.0], [0.19, 0.1, 0.1]], None),
            (&[[2.0, 1.0, 0.0], [0.21, 0.1, 0.1]], Some("47.6 %")),
            (&[[2.0, 28.1, 0.03]], None),
            (&[[2.0, 27.9, 0.03]], Some("1.5 %")),
            // Strains of 1e-12 take 3e-24 J.
            (&[[2.9e-24, 0.0, 2.9e-24]], None),
            (&[[3.1e-24, 0.0, 3.1e-24]], Some("100.0 %")),
            // A wave along a beam, which bends by round-off only.
            (&[[2.9e-24, 1.0, 0.03]], None),
        ] {
            let found = told(&mut locking, seen);
            assert_eq!(found.is_some(), percent.is_some(), "{seen:?}: {found:?}");
            if let (Some(found), Some(percent)) = (found, percent) {
                let part = format!("takes {percent} of the energy of bending");
                assert!(found.contains(&part) && found.contains("5 points a cell"), "{found}");
            }
        }
        assert_eq!(told(&mut locking, &[]), None);
    }

    /// Section forces of 2, 4 and 6 N over 1 m and 2 m of EA = 4 N: (½·20/2 + 2·½·52/2)/4 J.
    #[test]
    fn strings_are_told_whose_stretch_no_section_force_explains() {
        let string = |stretch: f64| LockingBeam {
            axial_stiffness: Along::Constant(4.0),
            bending_stiffness: None,
            seen: vec![[0.0, 1e9, 0.0], [0.0, stretch, 0.0]],
            ..watched().0.beams.remove(1)
        };
        let shape = Shape {
            beam: "arm".into(),
            s: vec![0.0, 1.0, 3.0],
            axial_force: vec![2.0, 4.0, 6.0],
            ..Shape::default()
        };
        let told = |stretch: f64, scale: f64| {
            Locking { beams: vec![string(stretch)] }.jammed(std::slice::from_ref(&shape), scale).next()
        };
        assert_eq!(told(77.4, 0.0), None);
        let said = told(77.6, 0.0).unwrap();
        assert!(said.contains("takes 7.8e1 J") && said.contains("account for 7.8e0 J"), "{said}");
        // Where it matters against the work of the loads, of which it is 1e-5.
        assert_eq!((told(77.6, 7.75e6).is_some(), told(77.6, 7.77e6)), (true, None));
    }

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
                actuated: false,
                length: 2.0,
                offset: 0,
                tables: [BasisTable::default(), BasisTable::default()],
                jumps: Vec::new(),
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
