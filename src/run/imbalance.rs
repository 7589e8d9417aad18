//! Equilibria whose forces round-off keeps from balance.
//!
//! Positions are known to the last digit of a number, and forces follow from their differences: between nodes that are close, what a
//! position may be off by makes forces of the size of the loads. Positions hardly suffer from that as long as these forces are a small part of the
//! loads; reactions and section forces do.

use crate::assembly::{DiscretizedBeam, InternalVariables, nodes};
use crate::numeric::plain;
use crate::system::System;

/// Part of the forces by which they may be out of balance.
const IMBALANCE: f64 = 1e-3;
/// Part of the forces out of balance from which on positions may be off, too.
const MOVES: f64 = 1e-2;
/// What the round-off of positions leaves on a beam is at most so many times what it makes between the nearest nodes.
const ROUND_OFFS: f64 = 100.0;

/// A warning where the forces on a beam in an equilibrium, unknowns `x` at a load factor, are out of balance as a whole by a part that
/// matters. Opposite forces at two nodes that are near change neither reactions nor the section forces that follow from these.
pub(super) fn out_of_balance(
    system: &System,
    load: f64,
    x: &[f64],
    variables: &InternalVariables,
) -> Option<String> {
    let length = system.length();
    let mut loads = vec![0.0; system.coordinates()];
    system.add_load_rate(1.0, 0.0, &x[..system.coordinates()], &mut loads);
    let total = |forces: &[f64]| -> f64 {
        nodes(forces).map(|force| force.shift().max(force.slope() / length)).sum()
    };
    let loads = total(&loads);
    // Round-off may not reach a part of the loads that matters, and without loads all forces may be round-off.
    let round_off = ROUND_OFFS * system.round_off();
    if loads > 0.0 && round_off <= IMBALANCE * loads {
        return None;
    }
    let held = total(&system.static_support_forces(load, x, variables));
    if loads == 0.0 && held <= round_off {
        return None;
    }
    let acting = loads.max(held);
    let left = system.imbalance(load, x, variables);
    let of_beam = |part: &DiscretizedBeam| {
        let first = part.first_node;
        let nodes = nodes(&left).skip(first).take(part.basis.nodes().len());
        let [x, y] = nodes.fold([0.0; 2], |[x, y], force| [x + force.position[0], y + force.position[1]]);
        x.hypot(y)
    };
    let off = system.beams().iter().map(of_beam).fold(0.0, f64::max);
    if off <= IMBALANCE * acting {
        return None;
    }
    let cells = system.beams().iter().flat_map(|part| {
        let cells = part.basis.nodes().windows(2);
        cells.map(|cell| (cell[1] - cell[0], part.name.as_str()))
    });
    let (shortest, beam) = cells.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let positions = if off > MOVES * acting { "may be off as well" } else { "do not suffer from it" };
    Some(format!(
        "the forces of the equilibrium balance to {:.1} % only, and reactions or section forces err by as much: between nodes of beam \
         `{beam}` that are {} m apart the last digit of a position makes forces of that size; positions {positions}; use longer \
         cells, or a larger `accuracy`",
        100.0 * off / acting,
        plain(shortest, 2)
    ))
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    fn warnings(part: f64, unit: f64, force: f64) -> Vec<String> {
        let (before, behind) = (0.7 - part, 0.7 + part);
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = {:e}, bending_stiffness = {unit:e}, basis.ancf.nodes = [0, 0.35, {before}, 0.7, {behind}, 1] }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'arm', at = 0.7, fix = ['y'] }}]\n\
             effect.force = [{{ beam = 'arm', at = 'end', value = [0, {:e}] }}]\nanalysis.static = {{}}\n",
            1e3 * unit,
            force * unit
        );
        let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).expect("an equilibrium");
        results.run().warnings.iter().filter(|text| text.contains("balance to")).cloned().collect()
    }

    /// In cells of 10 µm of 1 m beside a support, 12 EI/h³ times the last digit of a position is a force like the load, in whatever
    /// unit of force. Without a load no force is more than round-off.
    #[test]
    fn round_off_between_near_nodes_is_told() {
        for unit in [1e-9, 1.0, 1e9] {
            assert_eq!([warnings(0.1, unit, -4.0), warnings(1e-5, unit, 0.0)], [[""; 0]; 2]);
            let found = warnings(1e-5, unit, -4.0);
            assert!(found.len() == 1 && found[0].contains("1.00e-5 m apart"), "{unit}: {found:?}");
        }
    }
}
