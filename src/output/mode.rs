//! Mode shapes as they are drawn: added to the state that vibrates or buckles.

use crate::results::{ModeShape, Shape};

/// Largest displacement of a drawn mode, in lengths of the longest beam.
const DRAWN: f64 = 0.1;

/// A beam, displaced by a mode.
pub(super) struct Displaced {
    /// Centreline \[m\].
    pub(super) line: Vec<[f64; 2]>,
    /// Nodes \[m\].
    pub(super) nodes: Vec<[f64; 2]>,
}

/// The beams of a state with a mode added, whose largest displacement is a tenth of the longest
/// beam.
pub(super) fn displaced(state: &[Shape], mode: &[ModeShape]) -> Vec<Displaced> {
    let longest = state.iter().filter_map(|beam| Some(beam.s.last()? - beam.s.first()?)).fold(0.0, f64::max);
    let displacements = mode.iter().flat_map(|beam| beam.x.iter().zip(&beam.y));
    let largest = displacements.fold(0.0_f64, |m, (x, y)| m.max(x.hypot(*y)));
    let factor = if largest > 0.0 { DRAWN * longest / largest } else { 0.0 };
    let add = |at: [f64; 2], by: [f64; 2]| [0, 1].map(|axis| factor.mul_add(by[axis], at[axis]));
    let displaced = |(beam, mode): (&Shape, &ModeShape)| Displaced {
        line: (0..beam.x.len().min(mode.x.len()))
            .map(|i| add([beam.x[i], beam.y[i]], [mode.x[i], mode.y[i]]))
            .collect(),
        nodes: beam.nodes.iter().zip(&mode.nodes).map(|(at, by)| add(*at, *by)).collect(),
    };
    state.iter().zip(mode).map(displaced).collect()
}
