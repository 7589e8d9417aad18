//! Angles that count turns: a tip that has gone round once stands at 2π, not at 0.

use super::constraints::Constraint;
use super::{System, View, unfold};
use crate::assembly::{DiscretizedBeam, Node, nodes};
use std::ops::Range;

impl System {
    /// The parts of the load in each of which no support turns by more than `turn` \[rad\].
    pub fn parts_of_turns(&self, turn: f64) -> usize {
        ((self.largest_turn() / turn).ceil() as usize).max(1)
    }

    /// By how much all nodes have turned between two states, each with its load factor \[rad\]. One load step may wind a beam up by
    /// whole turns. But a support that holds a direction is known to have turned by so much, and the turns of the other nodes follow from
    /// cell to cell, and across welds. On beams without any, some node has turned by less than half a turn: that which has turned least.
    pub fn node_turns(&self, (from, before): (f64, &[f64]), (to, now): (f64, &[f64])) -> Vec<f64> {
        let mut turns: Vec<f64> =
            self.beams.iter().flat_map(|part| within_half_a_turn(part, before, now)).collect();
        let range = |beam: usize| {
            let part = &self.beams[beam];
            part.first_node..part.first_node + part.basis.nodes().len()
        };
        let beam_of =
            |node: usize| self.beams.partition_point(|part| part.first_node <= node).saturating_sub(1);
        let at_nodes = self.supports.angles();
        let between = self.constraints.iter().filter_map(|row: &Constraint| {
            let (beam, s) = self.place_of_row(row);
            Some((range(beam).start + nearest(&self.beams[beam], s), row.angle_of_support()?))
        });
        let mut found: Vec<(usize, f64)> =
            at_nodes.chain(between).map(|(node, angle)| (node, angle.at(to) - angle.at(from))).collect();
        let mut known = vec![false; self.beams.len()];
        loop {
            while let Some((node, turn)) = found.pop() {
                let beam = beam_of(node);
                if std::mem::replace(&mut known[beam], true) {
                    continue;
                }
                follow(&mut turns, range(beam), node, turn);
                let nodes = range(beam);
                let welded = self.polar.welds().flat_map(|[a, b]| [[a, b], [b, a]]);
                found.extend(
                    welded.filter(|[here, _]| nodes.contains(here)).map(|[here, other]| (other, turns[here])),
                );
            }
            let left = (0..known.len()).filter(|beam| !known[*beam]).flat_map(range);
            let Some(node) = left.min_by(|a, b| turns[*a].abs().total_cmp(&turns[*b].abs())) else {
                return turns;
            };
            found.push((node, turns[node]));
        }
    }
}

/// The turns of the nodes of a beam between two states, up to full turns \[rad\].
fn within_half_a_turn<'q>(
    part: &DiscretizedBeam,
    before: &'q [f64],
    now: &'q [f64],
) -> impl Iterator<Item = f64> + use<'q> {
    let first = 4 * part.first_node;
    let all = first..first + 4 * part.basis.nodes().len();
    let angle = |Node { gradient: [x, y], .. }: Node| y.atan2(x);
    let pairs = nodes(&before[all.clone()]).zip(nodes(&now[all]));
    pairs.map(move |(before, now)| unfold(angle(now) - angle(before), Some(0.0)))
}

/// Adds full turns to those of the nodes of a beam: the one of this number has turned by about so much, and each other by less than half
/// a turn more or less than the next.
fn follow(turns: &mut [f64], nodes: Range<usize>, from: usize, turn: f64) {
    turns[from] = unfold(turns[from], Some(turn));
    for node in from + 1..nodes.end {
        turns[node] = unfold(turns[node], Some(turns[node - 1]));
    }
    for node in (nodes.start..from).rev() {
        turns[node] = unfold(turns[node], Some(turns[node + 1]));
    }
}

/// By how much the nodes of a beam have turned between two states of which nothing else is known than that some node has turned by less
/// than half a turn.
pub fn turns(part: &DiscretizedBeam, before: &[f64], now: &[f64]) -> Vec<f64> {
    let mut turns: Vec<f64> = within_half_a_turn(part, before, now).collect();
    let sizes = turns.iter().map(|turn| turn.abs()).enumerate();
    let still = sizes.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(node, _)| node);
    let (nodes, turn) = (0..turns.len(), turns.get(still).copied().unwrap_or(0.0));
    if !nodes.is_empty() {
        follow(&mut turns, nodes, still, turn);
    }
    turns
}

/// By how much the direction of a beam turns from one place to another in a state, from node to node by less than half a turn; `None`
/// where a place is not on the beam, or there is no such state.
pub fn between(part: &DiscretizedBeam, q: &[f64], [from, to]: [f64; 2]) -> Option<f64> {
    let nodes = part.basis.nodes().iter().copied();
    let (low, high) = (from.min(to), from.max(to));
    let mut places: Vec<f64> =
        [low].into_iter().chain(nodes.filter(|s| *s > low && *s < high)).chain([high]).collect();
    if from > to {
        places.reverse();
    }
    let first = part.offset();
    (q.len() >= first + 4 * part.basis.nodes().len()).then_some(())?;
    let views = places.iter().map(|s| View::point(&part.basis, first, *s).ok());
    let angles: Vec<f64> = views.map(|view| Some(view?.fields(q).angle())).collect::<Option<_>>()?;
    Some(angles.windows(2).map(|pair| unfold(pair[1] - pair[0], Some(0.0))).sum())
}

/// The node of a beam that is nearest to `s` \[m\].
pub fn nearest(part: &DiscretizedBeam, s: f64) -> usize {
    let nodes = part.basis.nodes();
    let after = nodes.partition_point(|node| *node < s).min(nodes.len() - 1);
    after.checked_sub(1).filter(|before| s - nodes[*before] <= nodes[after] - s).unwrap_or(after)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Needs;
    use crate::model::{Beam, Discretization, Joint, Model, Place, Section, Support};
    use crate::system::System;
    use std::f64::consts::FRAC_PI_2;

    /// Nodes that are turned by 1.5 rad more from each to the next, so that the last stands at 6 rad:
    /// about the first, which is still, and about the last, which is.
    #[test]
    fn turns_are_followed_from_the_node_that_is_still() {
        let beam = |y: f64| {
            let section = Section::new(1.0, 1.0);
            Beam::line("rod", [0.0, y], [1.0, y], section, Discretization::ancf(4))
        };
        let supports = [0, 1].map(|beam| Support::clamp(crate::model::Place { beam, s: 0.0 })).into();
        let model = Model { beams: vec![beam(0.0), beam(1.0)], supports, ..Model::default() };
        let system = System::build(&model, Needs::default()).unwrap();
        let turned = |start: f64, each: f64| {
            let mut q = system.reference().to_vec();
            for (node, q) in q[20..].chunks_exact_mut(4).enumerate() {
                let (sine, cosine) = (start + node as f64 * each).sin_cos();
                (q[2], q[3]) = (cosine, sine);
            }
            q
        };
        let still = turned(0.0, 0.0);
        for (start, each, s, expected) in [
            (0.0, 1.5, 1.0, 6.0),
            (0.0, -1.5, 1.0, -6.0),
            (-6.0, 1.5, 0.0, -6.0),
            (-6.0, 1.5, 0.3, -4.5),
            (-3.0, 1.5, 1.0, 3.0),
            (-3.0, 1.5, 0.0, -3.0),
            (0.25, 0.0, 0.6, 0.25),
        ] {
            let (now, beam) = (turned(start, each), &system.beams()[1]);
            let found = turns(beam, &still, &now)[nearest(beam, s)];
            assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
            let back = turns(beam, &now, &still)[nearest(beam, s)];
            assert!((back + expected).abs() < 1e-12, "{back} instead of {}", -expected);
        }
    }

    /// Two welded beams are wound up by nearly a turn from a clamp that turns by 1 rad: the node that seems to have turned least is at
    /// the tip, where that is 0.28 rad less than a full turn. A third beam is hinged to them, and hangs on to itself.
    #[test]
    fn turns_are_followed_from_supports_and_across_welds() {
        let at = |beam: usize, s: f64| Place { beam, s };
        let beam = |x: f64| {
            let section = Section::new(1.0, 1.0);
            Beam::line("rod", [x, 0.0], [x + 1.0, 0.0], section, Discretization::ancf(2))
        };
        let mut clamp = Support::clamp(at(1, 0.0));
        clamp.displacement.angle = 2.0;
        let model = Model {
            beams: vec![beam(1.0), beam(0.0), beam(2.0)],
            supports: vec![clamp],
            joints: vec![
                Joint::Weld { first: at(1, 1.0), second: at(0, 0.0) },
                Joint::Hinge { first: at(0, 1.0), second: at(2, 0.0) },
            ],
            ..Model::default()
        };
        let system = System::build(&model, Needs::default()).unwrap();
        let mut q = system.reference().to_vec();
        let turned = [3.5, 4.75, 6.0, 1.0, 2.25, 3.5, -0.25, 0.0, 0.5];
        for (q, angle) in q.chunks_exact_mut(4).zip(turned) {
            (q[3], q[2]) = f64::sin_cos(angle);
        }
        let found = system.node_turns((0.25, system.reference()), (0.75, &q));
        for (found, expected) in found.iter().zip(turned) {
            assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
        }
        assert_eq!((found.len(), system.parts_of_turns(FRAC_PI_2)), (9, 2));
    }
}
