//! Checks beforehand whether there is memory for what a model needs: an allocation that fails ends
//! a program without a message.

use super::RunError;
use crate::model::{About, Analysis, Beam, Buckling, Discretization, Modal, Model};

/// Bytes of a number.
const NUMBER: f64 = 8.0;
/// Vectors of all coordinates that solvers keep beside states and matrices, at most.
const VECTORS: f64 = 40.0;
/// Bytes for which the operating system is not asked: to ask takes as long as to solve a small
/// model, which needs less.
const MODEST: f64 = 1e6;

/// Refuses a model that needs more memory than is free.
///
/// # Errors
/// [`RunError::Memory`] where less is free than is needed.
pub(super) fn check(model: &Model, analysis: &Analysis) -> Result<(), RunError> {
    if *analysis == Analysis::Stages {
        return Err(RunError::Stages);
    }
    let needed = needed(model, analysis);
    if needed <= MODEST {
        return Ok(());
    }
    match free() {
        Some(free) if needed > free => Err(RunError::Memory { needed, free }),
        _ => Ok(()),
    }
}

/// About how many bytes tables, matrices and states take.
fn needed(model: &Model, analysis: &Analysis) -> f64 {
    let coordinates: f64 = model.beams.iter().map(|beam| 4.0 * nodes(beam)).sum();
    let state = coordinates * NUMBER;
    let equilibria = |steps: Option<usize>| steps.unwrap_or(0) as f64 * state;
    // Matrices as large as the tangent, factors included, and states that are kept.
    let (matrices, states) = match analysis {
        Analysis::Static(settings) => {
            (2.0, equilibria(settings.steps.or(settings.arc_length.as_ref().map(|arc| arc.max_points))))
        }
        Analysis::Buckling(Buckling { count }) => (4.0, 4.0 * *count as f64 * state),
        Analysis::Modal(Modal { count, about }) => {
            (if *about == About::Equilibrium { 5.0 } else { 4.0 }, 4.0 * *count as f64 * state)
        }
        Analysis::Stages => (0.0, 0.0),
        Analysis::Dynamic(settings) => (4.0, 2.0 * settings.duration / settings.output_every * state),
    };
    let tables: f64 = model.beams.iter().map(|beam| table(beam) + matrices * tangent(beam)).sum();
    tables + states + VECTORS * state
}

fn nodes(beam: &Beam) -> f64 {
    beam.discretization.nodes().count() as f64
}

/// Number of shape functions of a cell.
fn width(beam: &Beam) -> f64 {
    match &beam.discretization {
        Discretization::Ancf { .. } | Discretization::Open => 4.0,
        Discretization::Rpim { neighbours, .. } => 2.0 * (2 * neighbours + 2) as f64,
    }
}

/// Bytes of shape functions: r, r' and r'' at every point, of which uniform meshes share most.
fn table(beam: &Beam) -> f64 {
    let points = (beam.gauss_points.stretch + beam.gauss_points.bend) as f64;
    nodes(beam) * points * width(beam) * NUMBER
}

/// Bytes of a banded symmetric matrix.
fn tangent(beam: &Beam) -> f64 {
    4.0 * nodes(beam) * 2.0 * width(beam) * NUMBER
}

/// Bytes that this process may still take; none if the operating system does not tell.
fn free() -> Option<f64> {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let number = |text: &str| text.split_whitespace().next()?.parse::<f64>().ok();
    // `Name:   123 kB`.
    let entry = |text: &str, name: &str| {
        Some(1024.0 * number(text.lines().find_map(|line| line.strip_prefix(name))?)?)
    };
    let memory = read("/proc/meminfo");
    let memory = memory
        .as_deref()
        .and_then(|text| Some(entry(text, "MemAvailable:")? + entry(text, "SwapFree:").unwrap_or(0.0)));
    let limit = || {
        let limits = read("/proc/self/limits")?;
        let most = number(limits.lines().find_map(|line| line.strip_prefix("Max address space"))?)?;
        Some(most - entry(&read("/proc/self/status")?, "VmSize:")?)
    };
    let group = || {
        let of = |name: &str| number(&read(&format!("/sys/fs/cgroup/memory.{name}"))?);
        Some(of("max")? - of("current")?)
    };
    [memory, limit(), group()].into_iter().flatten().reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(basis: &str, analysis: &str) -> f64 {
        let scene = crate::scene::parse(
            "arm",
            &format!(
                "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1, mass_per_length = 1, basis.{basis} }}\n\
                 support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\nanalysis.{analysis}"
            ),
        )
        .unwrap();
        needed(scene.model(), scene.analysis())
    }

    /// Counted by hand for 11 nodes, 44 coordinates of 8 bytes: 40 vectors; tables of so many
    /// functions at 5 points a cell; band matrices of four rows a node, twice as wide as the
    /// functions of a cell; and the states.
    #[test]
    fn what_is_needed_is_counted_as_by_hand() {
        let state = 44.0 * 8.0;
        let of = |functions: f64, matrices: f64, states: f64| {
            11.0 * 5.0 * functions * 8.0
                + matrices * 4.0 * 11.0 * 2.0 * functions * 8.0
                + (40.0 + states) * state
        };
        let ancf = "ancf = { elements = 10, gauss_points = { stretch = 3, bend = 2 } }";
        let rpim = "rpim = { nodes = 11, neighbours = 2, gauss_points = { stretch = 3, bend = 2 } }";
        for (analysis, matrices, states) in [
            ("static = {}", 2.0, 0.0),
            ("static.steps = 7", 2.0, 7.0),
            ("static.arc_length = { until_load = 1, max_points = 30 }", 2.0, 30.0),
            ("buckling.count = 3", 4.0, 12.0),
            ("modal.count = 3", 4.0, 12.0),
            ("modal = { count = 3, about = 'equilibrium' }", 5.0, 12.0),
            ("dynamic = { duration = 2, output_every = 0.1 }", 4.0, 40.0),
        ] {
            assert_eq!(bytes(ancf, analysis), of(4.0, matrices, states), "{analysis}");
            assert_eq!(bytes(rpim, analysis), of(12.0, matrices, states), "{analysis}");
        }
    }
}
