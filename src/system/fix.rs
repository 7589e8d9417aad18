//! The supports of a model: fixed coordinates of nodes, which are eliminated, and constraint rows
//! between nodes.

use super::constraints::{Constraint, Row};
use super::prescribed::Prescribed;
use super::reaction::Source;
use super::supports::{RestrainedPair, Restraint, Supports};
use super::{BuildError, Needs, System, View};
use crate::model::{Displacement, FixedRotation, Support};

impl System {
    /// Fixes what no law of time moves at the quantities that it has in the state `q`.
    pub fn freeze(&mut self, q: &[f64]) {
        let length = self.length;
        self.supports.freeze(q, length);
        self.constraints.iter_mut().for_each(|row| row.freeze(q, length));
    }
}

impl System {
    /// The translation that all supports share when they move from the state `q` to their places at
    /// load factor `load` \[m\]: per axis the smallest of the prescribed changes, and zero if they
    /// have different signs or if there is a slider, whose line does not move.
    pub fn shared_move(&self, load: f64, q: &[f64]) -> [f64; 2] {
        if self.constraints.iter().any(Constraint::is_slider) {
            return [0.0; 2];
        }
        let at_nodes = self.supports.position_changes(load, q);
        let between = self.constraints.iter().filter_map(|row| row.position_change(load, q));
        let mut shared: [Option<f64>; 2] = [None; 2];
        for (axis, change) in at_nodes.chain(between) {
            shared[axis] = Some(shared[axis].map_or(change, |least: f64| {
                if least * change <= 0.0 { 0.0 } else { least.signum() * least.abs().min(change.abs()) }
            }));
        }
        shared.map(Option::unwrap_or_default)
    }

    /// The largest turn of a support \[rad\].
    pub fn largest_turn(&self) -> f64 {
        let at_nodes = self.supports.angles().map(|(_, angle)| angle);
        let between = self.constraints.iter().filter_map(Constraint::angle_of_support);
        at_nodes.chain(between).fold(0.0, |largest, angle| angle.change.abs().max(largest))
    }
}

/// Makes the eliminated supports, the constraint rows, and per support the place where it acts.
pub(super) fn fix(
    system: &System,
    supports: &[Support],
    needs: Needs,
) -> Result<(Supports, Vec<Constraint>, Vec<Source>), BuildError> {
    let mut pairs: Vec<RestrainedPair> = Vec::new();
    let (mut constraints, mut sources) = (Vec::new(), Vec::new());
    for support in supports {
        let (part, s) = system.part("a support", support.at)?;
        let moves = support.displacement != Displacement::default();
        match (needs.motion, &support.law) {
            (true, None) if moves => return Err(BuildError::NoLaw { beam: part.name.clone(), s }),
            (false, Some(_)) => {
                return Err(BuildError::NoTime {
                    what: format!("the support of beam `{}` at s = {s} m", part.name),
                });
            }
            (true, Some(_)) if moves && part.basis.node_at(s).is_none() => {
                return Err(BuildError::MovesBetweenNodes { beam: part.name.clone(), s });
            }
            _ => {}
        }
        let in_basis = |e| BuildError::basis(&part.name, e);
        let fields = View::point(&part.basis, part.offset(), s).map_err(in_basis)?.fields(system.start());
        let (position, gradient) = (fields.position, fields.gradient);
        let course = |start: f64, change: f64| Prescribed { start, change, law: support.law.clone() };
        let angle = course(gradient[1].atan2(gradient[0]), support.displacement.angle);
        let rotation = course(0.0, support.displacement.angle);
        let motion = [support.displacement.x, support.displacement.y];
        let fixed = [support.fix.x, support.fix.y];
        let components: [Option<Prescribed>; 2] =
            std::array::from_fn(|axis| fixed[axis].then(|| course(position[axis], motion[axis])));
        if let Some(node) = part.basis.node_at(s) {
            sources.push(Source::node(part.first_node + node, support));
            let pair = 2 * (part.first_node + node);
            let mut add = |pair: usize, restraint: Restraint| match pairs.iter_mut().find(|h| h.pair == pair)
            {
                None => {
                    pairs.push(RestrainedPair { pair, restraint });
                    Ok(())
                }
                Some(RestrainedPair { restraint: Restraint::Position(there), .. }) => match restraint {
                    Restraint::Position(new) if (0..2).all(|a| there[a].is_none() || new[a].is_none()) => {
                        *there = std::array::from_fn(|a| there[a].take().or_else(|| new[a].clone()));
                        Ok(())
                    }
                    _ => Err("position"),
                },
                Some(_) => Err("rotation"),
            };
            let position = if components.iter().any(Option::is_some) {
                add(pair, Restraint::Position(components.clone()))
            } else {
                Ok(())
            };
            position
                .and_then(|()| match support.fix.rotation {
                    FixedRotation::Free => Ok(()),
                    FixedRotation::Angle => add(pair + 1, Restraint::Direction(angle)),
                    FixedRotation::Gradient => {
                        add(pair + 1, Restraint::Gradient { reference: gradient, rotation })
                    }
                })
                .map_err(|what| BuildError::HeldTwice { what, beam: part.name.clone(), s: support.at.s })?;
        } else {
            let mut rows: Vec<(usize, Row)> = components
                .into_iter()
                .enumerate()
                .filter_map(|(axis, c)| Some((0, Row::Position { axis, value: c? })))
                .collect();
            match support.fix.rotation {
                FixedRotation::Free => {}
                FixedRotation::Angle => rows.push((1, Row::Direction(angle))),
                FixedRotation::Gradient => rows.extend((0..2).map(|axis| {
                    (1, Row::Gradient { axis, reference: gradient, rotation: rotation.clone() })
                })),
            }
            let first = constraints.len();
            for (order, row) in rows {
                let table = part.basis.points(&[s], &[order]).map_err(in_basis)?;
                constraints.push(Constraint::new(&table, part.offset(), row));
            }
            sources.push(Source::Rows(first..constraints.len()));
        }
    }
    Ok((Supports::new(pairs), constraints, sources))
}
