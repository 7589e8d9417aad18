//! Angles that count turns: a tip that has gone round once stands at 2π, not at 0.

use super::{System, View, unfold};
use crate::assembly::{DiscretizedBeam, Node, nodes};
use std::f64::consts::FRAC_PI_2;

/// Turn of a support up to which one load step is believed to have turned some node of every beam by less than half a turn \[rad\].
const FAR: f64 = FRAC_PI_2;

/// How far the nodes of all beams have turned since it was last asked, where supports turn by more than [`FAR`] until load factor 1.
#[derive(Debug, Default)]
pub struct Turned {
    parts: usize,
    nodes: Vec<f64>,
}

impl Turned {
    /// At the start of a path.
    pub fn new(system: &System) -> Self {
        let parts = (system.largest_turn() / FAR).ceil() as usize;
        Self { parts: if parts > 1 { parts } else { 0 }, nodes: Vec::new() }
    }

    /// The parts of the load in each of which no support turns far; none where a single one does.
    pub fn parts(&self) -> usize {
        self.parts
    }

    /// Adds a load step, in which no support turns far, from one state to another.
    pub fn add_step(&mut self, system: &System, before: &[f64], now: &[f64]) {
        if self.parts > 0 {
            let of_step = system.beams().iter().flat_map(|part| turns(part, before, now));
            if self.nodes.is_empty() {
                self.nodes.extend(of_step);
            } else {
                self.nodes.iter_mut().zip(of_step).for_each(|(sum, turn)| *sum += turn);
            }
        }
    }

    /// The turns of the nodes, beam by beam \[rad\], counted from zero from now on; nothing where no support turns far.
    pub fn take(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.nodes)
    }
}

/// By how much the nodes of a beam have turned between two states. One load step may wind a beam up
/// by whole turns. But some node, such as a clamped one, has turned by less than half a turn, and
/// the turns of the others follow from cell to cell.
pub fn turns(part: &DiscretizedBeam, before: &[f64], now: &[f64]) -> Vec<f64> {
    let first = 4 * part.first_node;
    let all = first..first + 4 * part.basis.nodes().len();
    let angle = |Node { gradient: [x, y], .. }: Node| y.atan2(x);
    let pairs = nodes(&before[all.clone()]).zip(nodes(&now[all]));
    let mut turns: Vec<f64> =
        pairs.map(|(before, now)| unfold(angle(now) - angle(before), Some(0.0))).collect();
    let sizes = turns.iter().map(|turn| turn.abs()).enumerate();
    let still = sizes.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(node, _)| node);
    for node in still + 1..turns.len() {
        turns[node] = unfold(turns[node], Some(turns[node - 1]));
    }
    for node in (0..still).rev() {
        turns[node] = unfold(turns[node], Some(turns[node + 1]));
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
    use crate::model::{Beam, Discretization, Model, Section, Support};
    use crate::system::System;

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
}
