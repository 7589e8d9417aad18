//! Equilibria whose forces round-off keeps from balance.
//!
//! Positions are known to the last digit of a number, and forces follow from their differences: between nodes that are close, what a
//! position may be off by makes forces of the size of the loads. Positions do not suffer from that; reactions and section forces do.

use crate::assembly::{InternalVariables, nodes};
use crate::numeric::plain;
use crate::system::System;

/// Part of the forces by which they may be out of balance.
const IMBALANCE: f64 = 1e-3;
/// What is left is due to the round-off of positions where it is at most so many times what this makes between the nearest nodes.
const ROUND_OFFS: f64 = 100.0;

/// A warning where the forces in an equilibrium, unknowns `x` at a load factor, are out of balance by a part that matters. What is left
/// at the nodes has one sign as often as the other, so that its squares add up.
pub(super) fn out_of_balance(
    system: &System,
    load: f64,
    x: &[f64],
    variables: &InternalVariables,
) -> Option<String> {
    let length = system.length();
    let mut loads = vec![0.0; system.coordinates()];
    system.add_load_rate(1.0, 0.0, &x[..system.coordinates()], &mut loads);
    let held = system.static_support_forces(load, x, variables);
    let total = |forces: &[f64]| -> f64 {
        nodes(forces).map(|force| force.shift().max(force.slope() / length)).sum()
    };
    let acting = total(&loads).max(total(&held));
    let left = system.imbalance(load, x, variables);
    let off = nodes(&left).map(|force| force.shift().powi(2)).sum::<f64>().sqrt();
    if acting == 0.0 || off <= IMBALANCE * acting {
        return None;
    }
    let part = 100.0 * off / acting;
    let err = "and reactions or section forces err by as much";
    if off > ROUND_OFFS * system.round_off() {
        return Some(format!(
            "the forces of the equilibrium balance to {part:.1} % only, {err}: the iteration ended before; give [analysis.static] a smaller \
             `tolerance`"
        ));
    }
    let cells = system.beams().iter().flat_map(|part| {
        let cells = part.basis.nodes().windows(2);
        cells.map(|cell| (cell[1] - cell[0], part.name.as_str()))
    });
    let (shortest, beam) = cells.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
    Some(format!(
        "the forces of the equilibrium balance to {part:.1} % only, {err}: between nodes of beam `{beam}` that are {} m apart the last digit of \
         a position makes forces of that size; positions do not suffer from it; use longer cells, or a larger `accuracy`",
        plain(shortest, 2)
    ))
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    fn warnings(last: f64, analysis: &str) -> Vec<String> {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1, basis.ancf.nodes = [0, 0.5, {last}, 1] }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             effect.force = [{{ beam = 'arm', at = 'end', value = [0, -4] }}]\nanalysis.static = {{ {analysis} }}\n"
        );
        let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).expect("an equilibrium");
        results.run().warnings.iter().filter(|text| text.contains("balance to")).cloned().collect()
    }

    /// In a cell of 10 µm of 1 m, 12 EI/h³ times the last digit of the deflection is a force like the load.
    #[test]
    fn round_off_between_near_nodes_is_told() {
        assert_eq!(warnings(0.75, ""), [""; 0]);
        let found = warnings(0.999_99, "");
        assert!(found.len() == 1 && found[0].contains("1.00e-5 m apart"), "{found:?}");
    }
}
