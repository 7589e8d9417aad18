//! The two discretisations solve the same beam: random scenes on fine meshes must give the same
//! answer.

use super::generators::clamp;
use ancf::effect::{DistributedForce, Force, Moment};
use ancf::model::{
    Analysis, Beam, Centreline, Discretization, Dynamic, Fixed, GaussPoints, Integrator, Kernel, Model,
    Nodes, Place, Probe, Section, SideCondition, Static, StepControl, StrainMeasure, Support,
};
use ancf::run::{Control, Options, Progress};
use proptest::prelude::*;
use std::sync::Arc;

/// A random problem without its discretisation; lengths and forces are scaled so that all are
/// equally hard.
#[derive(Clone, Debug)]
struct Problem {
    length: f64,
    direction: f64,
    bending: f64,
    /// EA L²/EI.
    slenderness: f64,
    strain: StrainMeasure,
    /// P L²/EI along and across the beam, M L/EI, q L³/EI.
    force: [f64; 2],
    moment: f64,
    distributed: [f64; 2],
    follower: bool,
    /// Widths of the cells, relative.
    widths: Vec<f64>,
}

fn problem() -> impl Strategy<Value = Problem> {
    let load = || -2.0..2.0_f64;
    // With the distributed load below what buckles a cantilever (2.47, 7.84 if distributed): beyond
    // it a beam that its moment bends to the other side snaps through before the full load is
    // reached.
    let force = || -1.1..1.1_f64;
    (
        (-1.0..1.0_f64, 0.0..6.2_f64, -3.0..3.0_f64, 3.0..6.0_f64, any::<bool>()),
        ([force(), force()], load(), [load(), load()], any::<bool>()),
        prop::collection::vec(0.6..1.6_f64, 24),
    )
        .prop_map(|((length, direction, bending, slenderness, green), loads, widths)| {
            let (force, moment, distributed, follower) = loads;
            Problem {
                length: 10.0_f64.powf(length),
                direction,
                bending: 10.0_f64.powf(bending),
                slenderness: 10.0_f64.powf(slenderness),
                strain: if green { StrainMeasure::Green } else { StrainMeasure::Engineering },
                force,
                moment,
                distributed,
                follower,
                widths,
            }
        })
}

impl Problem {
    /// Nodes at the random widths, each cell cut into `parts`.
    fn nodes(&self, parts: usize) -> Nodes {
        let total: f64 = self.widths.iter().sum();
        let mut s = vec![0.0];
        let mut sum = 0.0;
        for width in &self.widths {
            for part in 1..=parts {
                s.push(self.length * (sum + width * part as f64 / parts as f64) / total);
            }
            sum += width;
        }
        let last = s.len() - 1;
        s[last] = self.length;
        Nodes::Given(s)
    }

    fn ancf(&self) -> (Discretization, GaussPoints) {
        (Discretization::Ancf { nodes: self.nodes(4) }, GaussPoints { stretch: 4, bend: 2, lobatto: false })
    }

    fn rpim(&self) -> (Discretization, GaussPoints) {
        let kernel = Kernel::Multiquadric { q: 1.03, shape: 5.0 };
        let (nodes, polynomial_terms) = (self.nodes(1), 2);
        let rpim = Discretization::Rpim {
            nodes,
            kernel,
            polynomial_terms,
            side_condition: SideCondition::Plus,
            neighbours: 2,
        };
        (rpim, GaussPoints { stretch: 4, bend: 4, lobatto: false })
    }

    fn rotate(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sine, cosine) = self.direction.sin_cos();
        [cosine * x - sine * y, sine * x + cosine * y]
    }

    fn model(
        &self,
        (discretization, gauss_points): (Discretization, GaussPoints),
        support: Support,
    ) -> Model {
        let Self { length, bending, .. } = *self;
        let unit = bending / length.powi(2);
        let tip = Place { beam: 0, s: length };
        let scaled = |v: [f64; 2], factor: f64| self.rotate(v.map(|v| factor * v));
        Model {
            beams: vec![Beam {
                name: "beam".into(),
                centreline: Centreline::Line { start: [0.0; 2], end: self.rotate([length, 0.0]) },
                section: Section {
                    axial_stiffness: Some((self.slenderness * unit).into()),
                    bending_stiffness: Some(bending.into()),
                    // Frequencies of the order of 1/s.
                    mass_per_length: Some((bending / length.powi(4)).into()),
                    ..Default::default()
                },
                strain: self.strain,
                discretization,
                gauss_points,
            }],
            supports: vec![support],
            parts: vec![
                Arc::new(Force {
                    at: tip,
                    value: scaled(self.force, unit),
                    follower: self.follower,
                    law: None,
                }),
                Arc::new(Moment::new(tip, self.moment * bending / length)),
                Arc::new(DistributedForce {
                    beam: 0,
                    value: scaled(self.distributed, unit / length).map(Into::into),
                    follower: false,
                    law: None,
                }),
            ],
            probes: vec![
                Probe { name: "tip".into(), at: tip },
                Probe { name: "middle".into(), at: Place { beam: 0, s: 0.4 * length } },
            ],
            ..Model::default()
        }
    }

    /// Largest distance of the probes between the two, in beam lengths.
    fn disagreement(&self, support: &Support, analysis: &Analysis) -> f64 {
        let [a, b] = [self.ancf(), self.rpim()].map(|discretization| {
            let observer = &mut |progress: &Progress| {
                assert!(progress.newton_iterations < 20_000, "no end in sight: {progress:?}");
                Control::Continue
            };
            let options = Options { observer: Some(observer), ..Options::default() };
            self.model(discretization, support.clone())
                .solve_with(analysis, options)
                .expect("a stable cantilever, or a motion")
        });
        let mut largest = 0.0_f64;
        for (a, b) in a.states().probes.iter().zip(&b.states().probes) {
            let (a, b) = (a.samples.last().expect("a state"), b.samples.last().expect("a state"));
            largest = largest.max((a.x - b.x).hypot(a.y - b.y) / self.length);
        }
        largest
    }
}

proptest! {
    #![proptest_config(super::cases(24))]

    /// 24 uneven cells: RPIM errs by some 1e-7, ANCF with each cell in four by some 1e-7 too, more
    /// where an end load presses along the beam.
    #[test]
    fn both_discretisations_find_the_same_equilibrium(problem in problem()) {
        let disagreement = problem.disagreement(&clamp(), &Analysis::Static(Static::default()));
        prop_assert!(disagreement < 1e-5, "{disagreement}");
    }
}

proptest! {
    #![proptest_config(super::cases(6))]

    /// The same beams hinged and let go under their distributed load. A sudden tip moment would
    /// excite waves as short as the cells, which no two meshes carry alike.
    #[test]
    fn both_discretisations_move_alike(problem in problem()) {
        let problem = Problem { force: [0.0; 2], moment: 0.0, ..problem };
        let hinge = Support { fix: Fixed { x: true, y: true, ..Fixed::default() }, ..clamp() };
        let integrator = Integrator::Radau { stages: 3, step: StepControl::Tolerance(1e-5) };
        let dynamic = Dynamic { duration: 0.5, output_every: 0.5, integrator, events: vec![] };
        let disagreement = problem.disagreement(&hinge, &Analysis::Dynamic(dynamic));
        prop_assert!(disagreement < 3e-5, "{disagreement}");
    }
}
