//! Nodes that turn too easily, because the quadrature does not see the force that holds them.
//!
//! Tension holds a beam's direction by ½ ∫ N r'⊥² ds. Three Lobatto points a cell see of it what
//! stands at the nodes and in the middle. Where N vanishes at a node, as at the free end of a hanging
//! cable, a turn of this node alone, r'⊥ = p(x) = (1 − x)(1 − 2x) in the cells beside it, x being the
//! distance in cells, meets no tension at any point: only bending is left to resist it. With N
//! interpolated between the points, and the sum over the cells beside the node,
//!
//! ```text
//! K = Σ h N₀/6 + 7/3 EI/h                                 what resists the turn
//! T = Σ h (13/140 N₀ + 1/21 N½ − 1/140 N₁) + 7/3 EI/h     what should: h ∫ N p² dx, EI/h ∫ p′² dx
//! ```
//!
//! A cable with hardly any bending stiffness then has a vibration of its end that is √(T/K) times too
//! slow, down to zero with EI.

use super::locking::at_points;
use crate::assembly::BuildError;
use crate::basis::BasisTable;
use crate::model::{Along, Model, StrainMeasure};
use crate::numeric::plain;
use crate::system::{Fields, System};

/// T/K beyond which a node is loose: its own vibration takes twice its time.
const LOOSE: f64 = 4.0;

/// The beams of a model that may have loose nodes.
#[derive(Clone)]
pub(super) struct Loose {
    beams: Vec<LooseBeam>,
    /// States so far.
    states: usize,
}

#[derive(Clone)]
struct LooseBeam {
    name: String,
    /// Its number in the system.
    beam: usize,
    measure: StrainMeasure,
    /// EA \[N\] and EI \[N m²\].
    stiffness: [Along; 2],
    offset: usize,
    /// r' at the points for stretching.
    table: BasisTable,
    /// ε of the stress-free state there.
    reference: Vec<f64>,
    /// Per node, in how many states it was loose, and the least T/K of these.
    nodes: Vec<(usize, f64)>,
}

impl Loose {
    /// Watches beams that resist stretch at three Lobatto points a cell.
    pub fn new(model: &Model, system: &System) -> Result<Self, BuildError> {
        let mut beams = Vec::new();
        for (index, (beam, part)) in model.beams.iter().zip(system.beams()).enumerate() {
            let (points, section) = (beam.gauss_points, &beam.section);
            let (Some(axial), Some(bending)) = (&section.axial_stiffness, &section.bending_stiffness) else {
                continue;
            };
            if !section.is_linear() || !points.lobatto || points.stretch != 3 {
                continue;
            }
            let table = part.basis.table(points.stretch_rule(), &[1]);
            let table = table.map_err(|e| BuildError::basis(&part.name, e))?;
            let nodes = vec![(0, f64::INFINITY); table.cells.len() + 1];
            let mut watched = LooseBeam {
                name: beam.name.clone(),
                beam: index,
                measure: beam.strain,
                stiffness: [axial.clone(), bending.clone()],
                offset: part.offset(),
                table,
                reference: Vec::new(),
                nodes,
            };
            watched.reference = watched.strains(system.reference());
            beams.push(watched);
        }
        Ok(Self { beams, states: 0 })
    }

    /// Takes a state into account: of a motion at a time, of statics at a load factor.
    pub fn see(&mut self, system: &System, parameter: f64, q: &[f64]) {
        self.states += 1;
        self.beams.iter_mut().for_each(|beam| beam.see(system, parameter, q));
    }

    /// Messages on beams with nodes that were loose in half of the states or more: in passing, a wave
    /// takes the force from a node of any beam.
    pub fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        let of = |beam: &LooseBeam| {
            let often = |(_, (times, _)): &(usize, &(usize, f64))| 2 * times >= self.states.max(1);
            let loose = beam.nodes.iter().enumerate().filter(often);
            let (node, (_, ratio)) = loose.max_by(|(_, a), (_, b)| a.1.total_cmp(&b.1))?;
            Some(format!(
                "beam `{}` is loose at s = {} m: its axial force vanishes there, so that at the points of its quadrature hardly anything but \
                 its bending stiffness resists a turn of this place, whose own vibration is at least {:.1} times too slow: use more elements, or \
                 `gauss_points = {{ stretch = 5, bend = 3 }}`",
                beam.name,
                plain(beam.place(node), 4),
                ratio.sqrt(),
            ))
        };
        self.beams.iter().filter_map(of)
    }
}

impl LooseBeam {
    fn strains(&self, q: &[f64]) -> Vec<f64> {
        at_points(&self.table, self.offset, q, |z| {
            Fields { position: [0.0; 2], gradient: z[0], second: [0.0; 2] }.strain(self.measure)
        })
    }

    /// The arc length of a node: the first point of the cell after it, or the last of all.
    fn place(&self, node: usize) -> f64 {
        self.table.s.get(3 * node).or(self.table.s.last()).copied().unwrap_or(0.0)
    }

    fn see(&mut self, system: &System, parameter: f64, q: &[f64]) {
        let mut sums = vec![[0.0; 2]; self.nodes.len()];
        let strains = self.strains(q);
        let cells =
            strains.chunks_exact(3).zip(self.reference.chunks_exact(3)).zip(self.table.s.chunks_exact(3));
        for (cell, ((strain, before), s)) in cells.enumerate() {
            let h = s[2] - s[0];
            let [axial, bending] = self.stiffness.each_ref().map(|along| along.at(s[1], s[1]));
            let force = |point: usize| {
                let imposed = system.imposed_force(self.beam, s[point], s[1], parameter);
                axial * (strain[point] - before[point]) - imposed
            };
            let bend = 7.0 / 3.0 * bending / h;
            for (node, near, far) in [(cell, 0, 2), (cell + 1, 2, 0)] {
                sums[node][0] += h * force(near) / 6.0 + bend;
                sums[node][1] +=
                    h * (13.0 / 140.0 * force(near) + force(1) / 21.0 - force(far) / 140.0) + bend;
            }
        }
        for ((times, least), [resists, should]) in self.nodes.iter_mut().zip(sums) {
            // Where compression outweighs it, the place buckles, which is another matter.
            if resists > 0.0 && should > LOOSE * resists {
                *times += 1;
                *least = least.min(should / resists);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What holds a turn p of a node, integrated by many points.
    #[test]
    fn weights_are_integrals_of_the_turn() {
        let p = |x: f64| (1.0 - x) * (1.0 - 2.0 * x);
        let integral = |f: &dyn Fn(f64) -> f64| {
            let n = 20_000;
            (0..n).map(|i| f((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n)
        };
        // The parabolas that are 1 at one of the three points.
        let shares = [
            integral(&|x| p(x).powi(3)),
            integral(&|x| 4.0 * x * (1.0 - x) * p(x).powi(2)),
            integral(&|x| x * (2.0 * x - 1.0) * p(x).powi(2)),
        ];
        for (share, expected) in shares.into_iter().zip([13.0 / 140.0, 1.0 / 21.0, -1.0 / 140.0]) {
            assert!((share - expected).abs() < 1e-8, "{share} {expected}");
        }
        assert!((integral(&|x| (4.0 * x - 3.0).powi(2)) - 7.0 / 3.0).abs() < 1e-8);
    }

    /// A bar of two elements in states of the strains e and e (1 − s): in the latter no tension is left at
    /// its end. That is told where it is so in half of the states or more, with the least of the ratios.
    #[test]
    fn a_node_is_loose_that_is_so_in_half_of_the_states() {
        let text = "beam.bar = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1e-6, strain = 'engineering', \
             basis.ancf.elements = 2 }
            support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
            analysis.static = {}";
        let scene = crate::scene::parse("bar.toml", text).expect("a scene");
        let needs = crate::assembly::Needs { inertia: false, motion: false };
        let system = System::build(scene.model(), needs).expect("a system");
        let mut loose = Loose::new(scene.model(), &system).expect("points");
        let state = |e: f64, falls: f64| -> Vec<f64> {
            let node = |s: f64| [s + e * (s - 0.5 * falls * s * s), 0.0, 1.0 + e * (1.0 - falls * s), 0.0];
            [0.0, 0.5, 1.0].into_iter().flat_map(node).collect()
        };
        for (e, falls, told) in [
            (1e-3, 1.0, true),
            (1e-3, 0.0, true),
            (2e-3, 0.0, false),
            (1e-3, 0.0, false),
            (4e-3, 1.0, false),
            (2e-3, 1.0, true),
        ] {
            loose.see(&system, 1.0, &state(e, falls));
            assert_eq!(loose.warnings().count(), usize::from(told), "{e} {falls} after {}", loose.states);
        }
        // N is 0.25 and 0.5 N in the middle and at the start of the last cell of 0.5 m, if e = 1e-3.
        let bend: f64 = 7.0 / 3.0 * 1e-6 / 0.5;
        let slow = ((0.5 * (0.25 / 21.0 - 0.5 / 140.0) + bend) / bend).sqrt();
        let said = loose.warnings().next().expect("a warning");
        assert!(said.starts_with("beam `bar` is loose at s = 1.0000 m: "), "{said}");
        assert!(said.contains(&format!("at least {slow:.1} times too slow")), "{slow}: {said}");
    }
}
