//! A straight beam for tests of what takes part in statics and motion, and ways to run it.

use ancf::assembly::Part;
use ancf::model::*;
use ancf::results::Trajectory;
use std::sync::Arc;

pub const LENGTH: f64 = 1.2;

pub fn ancf(elements: usize) -> Discretization {
    Discretization::Ancf { nodes: Nodes::Uniform(elements + 1) }
}

pub fn beam(name: &str, start: [f64; 2], end: [f64; 2], discretization: Discretization) -> Beam {
    Beam {
        name: name.into(),
        centreline: Centreline::Line { start, end },
        section: Section {
            axial_stiffness: Some(2e3.into()),
            bending_stiffness: Some(0.5.into()),
            mass_per_length: Some(0.4.into()),
            ..Default::default()
        },
        strain: StrainMeasure::Engineering,
        discretization,
        gauss_points: GaussPoints { stretch: 4, bend: 3, lobatto: false },
    }
}

pub fn support(s: f64, rotation: FixedRotation) -> Support {
    Support { at: Place { beam: 0, s }, fix: Fixed { x: true, y: true, rotation }, ..Support::default() }
}

pub fn tip(beam: usize, s: f64) -> Vec<Probe> {
    vec![Probe { name: "tip".into(), at: Place { beam, s } }]
}

pub fn one(supports: Vec<Support>, parts: Vec<Arc<dyn Part>>) -> Model {
    Model {
        beams: vec![beam("arm", [0.0, 0.0], [LENGTH, 0.0], ancf(6))],
        supports,
        parts,
        probes: tip(0, LENGTH),
        outputs: Outputs { reactions: true, effects: true, section_forces: false },
        ..Model::default()
    }
}

pub fn moved(model: &Model, duration: f64, integrator: Integrator) -> Trajectory {
    let analysis = Dynamic { duration, output_every: duration / 20.0, integrator, events: vec![] };
    model.solve(&analysis).expect("a motion")
}

pub fn still(model: &Model) -> Trajectory {
    model.solve(&Static::default()).expect("an equilibrium")
}

pub fn gauss(step: f64) -> Integrator {
    Integrator::Gauss { stages: 3, step: StepControl::Fixed(step) }
}

/// Every method with a fixed step, and its order.
pub fn methods(step: f64) -> Vec<(Integrator, f64)> {
    let step = StepControl::Fixed(step);
    let alpha =
        |spectral_radius| Integrator::GeneralizedAlpha { step, spectral_radius, newton_tolerance: 1e-12 };
    vec![
        (alpha(1.0), 2.0),
        (alpha(0.8), 2.0),
        (Integrator::Gauss { stages: 1, step }, 2.0),
        (Integrator::Gauss { stages: 2, step }, 4.0),
        (Integrator::Gauss { stages: 3, step }, 6.0),
        (Integrator::Radau { stages: 2, step }, 3.0),
        (Integrator::Radau { stages: 3, step }, 5.0),
    ]
}

pub fn imbalance(trajectory: &Trajectory) -> f64 {
    let first = trajectory.energy[0].total();
    let kinetic = trajectory.energy.iter().fold(0.0_f64, |m, e| m.max(e.kinetic));
    trajectory.energy.iter().fold(0.0_f64, |m, e| m.max((e.total() - first).abs())) / kinetic
}
