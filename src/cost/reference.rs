//! What errors are measured against: two runs that share neither the discretisation nor, in motion,
//! the integrator, made finer until they agree.

use super::bench::{Desk, Unmeasured};
use super::{CostError, Deviation, Family, Setting, Solver};
use crate::model::RPIM_GAUSS_POINTS;
use crate::model::{Analysis, Integrator, StepControl};
use crate::trajectory::Trajectory;

/// Cells of the meshfree run of the first pair.
const CELLS: usize = 16;
/// Elements of the other run for each of them: about as expensive, and about as accurate where
/// bending dominates.
const ELEMENTS_PER_CELL: usize = 4;
/// Most pairs.
const PAIRS: u32 = 7;
/// A pair costs about so many times the one before.
const GROWTH: f64 = 2.5;
/// Agreement that is enough, and agreement beyond which nothing is gained, in targets.
const ENOUGH: f64 = 0.1;
const AMPLE: f64 = 1e-3;

/// What errors are measured against.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The meshfree run of the pair that agrees best.
    pub trajectory: Trajectory,
    /// By how much the other run of the pair differs: the uncertainty of the reference.
    pub uncertainty: Deviation,
    /// What either run warned of.
    pub warnings: Vec<String>,
    /// The pair in words.
    pub pair: [String; 2],
    /// Wall time that it took to make \[s\].
    pub seconds: f64,
}

/// The settings of a pair.
fn pair(desk: &Desk<'_>, level: u32, target: f64) -> [(Family, usize, Setting); 2] {
    let meshfree = Family::usual(RPIM_GAUSS_POINTS.bend);
    let cells = CELLS << level;
    let step = StepControl::Tolerance(0.05 * target * 0.25_f64.powi(level as i32));
    let solvers = match desk.analysis {
        Analysis::Dynamic(_) => [
            Solver::Integrator(Integrator::Gauss { stages: 3, step }),
            Solver::Integrator(Integrator::Radau { stages: 3, step }),
        ],
        _ => [Solver::Scene; 2],
    };
    let [first, second] = solvers;
    [(meshfree, cells, first), (Family::REDUCED, ELEMENTS_PER_CELL * cells, second)].map(
        |(family, cells, solver)| (family, cells, Setting { beams: family.beams(desk.model, cells), solver }),
    )
}

/// Refines until two runs agree well below `target`, or the time `deadline` \[s\] is near.
pub(super) fn make(desk: &Desk<'_>, target: f64, deadline: f64) -> Result<Reference, CostError> {
    // Gone before the ladder, whose runs are alone.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build()?;
    let start = desk.now();
    let mut best: Option<Reference> = None;
    let mut reason = String::new();
    for level in 0..PAIRS {
        let settings = pair(desk, level, target);
        let names = settings.each_ref().map(|(family, cells, setting)| match setting.solver {
            Solver::Scene => format!("{family}, {cells} cells"),
            solver => format!("{family}, {cells} cells, {solver}"),
        });
        let agreement = best.as_ref().map(|best| best.uncertainty.error);
        let doing = match agreement {
            None => format!("reference with {} cells", settings[0].1),
            Some(error) => format!("reference with {} cells (agreement so far {error:.1e})", settings[0].1),
        };
        let began = desk.now();
        let run = |i: usize| desk.run(&settings[i].2, &doing, deadline);
        let found = match pool.join(|| run(0), || run(1)) {
            (Err(Unmeasured::Interrupted), _) | (_, Err(Unmeasured::Interrupted)) => {
                return Err(CostError::Interrupted);
            }
            (Ok(a), Ok(b)) => {
                let warnings = [&a.warnings[..], &b.warnings].concat();
                let deviation = Deviation::between(desk.model, desk.analysis, &b, &a);
                deviation.map(|deviation| (a, deviation, warnings)).map_err(Unmeasured::Failed)
            }
            (Err(miss), _) | (_, Err(miss)) => Err(miss),
        };
        match found {
            Ok((trajectory, mut uncertainty, warnings)) => {
                if matches!(desk.analysis, Analysis::Dynamic(_)) {
                    // A drift is measured against nothing.
                    uncertainty.energy = None;
                }
                if agreement.is_none_or(|error| uncertainty.error < error) {
                    best = Some(Reference { trajectory, uncertainty, warnings, pair: names, seconds: 0.0 });
                }
            }
            Err(Unmeasured::Failed(why)) => reason = why,
            Err(_) => {
                reason = format!(
                    "the time is over; the pair with {} cells took more than was left",
                    settings[0].1
                );
                break;
            }
        }
        let (now, next) = (desk.now(), GROWTH * (desk.now() - began));
        let error = best.as_ref().map_or(f64::INFINITY, |best| best.uncertainty.error);
        let stalled = agreement.is_some_and(|before| error > 0.5 * before);
        // Beyond what is needed, refinement must be cheap and still gain something.
        let content = error <= ENOUGH * target && (stalled || now - start + next > 0.05 * desk.budget);
        if error <= AMPLE * target || content || now + next > deadline {
            break;
        }
    }
    match best {
        Some(best) => Ok(Reference { seconds: desk.now() - start, ..best }),
        None => Err(CostError::NoReference { reason }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    /// Twice the cells and a quarter of the tolerance from pair to pair; meshfree by Gauss against
    /// elements by Radau.
    #[test]
    fn pairs_share_neither_mesh_nor_method() {
        let scene = parse(
            "arm",
            "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 5 }\n\
             analysis.dynamic = { duration = 1, output_every = 0.1 }",
        )
        .unwrap();
        let watcher = |_: &super::super::Progress<'_>| crate::run::Control::Continue;
        let desk = Desk {
            model: scene.model(),
            analysis: scene.analysis(),
            start: std::time::Instant::now(),
            budget: 1.0,
            watcher: &watcher,
        };
        for (level, cells, tolerance) in [(0, 16, 5e-6), (1, 32, 1.25e-6), (3, 128, 7.8125e-8)] {
            let [(meshfree, first, gauss), (elements, second, radau)] = pair(&desk, level, 1e-4);
            assert_eq!((first, second), (cells, 4 * cells));
            assert!(matches!(meshfree, Family::Rpim { .. }) && matches!(elements, Family::Ancf(_)));
            let nodes = |setting: &Setting| setting.beams[0].0.nodes().count();
            assert_eq!((nodes(&gauss), nodes(&radau)), (cells + 1, 4 * cells + 1));
            let close = |step: StepControl| match step {
                StepControl::Tolerance(found) => (found / tolerance - 1.0).abs() < 1e-12,
                StepControl::Fixed(_) => false,
            };
            assert!(
                matches!(gauss.solver, Solver::Integrator(Integrator::Gauss { step, .. }) if close(step))
            );
            assert!(
                matches!(radau.solver, Solver::Integrator(Integrator::Radau { stages: 3, step }) if close(step))
            );
        }
    }
}
