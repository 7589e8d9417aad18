//! Rigid motions that springs, foundations and whatever else is no beam resist.

use super::System;
use crate::assembly::{Kind, nodes};
use crate::model::freedom::{Freedom, Motion};

/// A stiffness is a combination of others if what is left of it is at most this part.
const DEPENDENT: f64 = 1e-9;

impl System {
    /// How many of the motions that supports and joints leave have a stiffness by other effects than those of the beams
    /// themselves, where the analysis begins: the rank of φᵢᵀ K φⱼ.
    pub(super) fn resisted(&self, freedom: &Freedom) -> usize {
        let q = self.start();
        let of_beams = |kind: Kind| matches!(kind, Kind::Stretch | Kind::Bend | Kind::Coupling);
        let effects: Vec<_> = self.terms.internal.iter().filter(|effect| !of_beams(effect.kind())).collect();
        if effects.is_empty() {
            return 0;
        }
        let motions: Vec<Vec<f64>> =
            freedom.motions().iter().map(|motion| self.moved(freedom, motion)).collect();
        let of_motion = |v: &Vec<f64>| {
            let mut force = vec![0.0; q.len()];
            effects.iter().for_each(|effect| effect.add_tangent_product(1.0, q, v, &mut force));
            let acting = force.into_iter().enumerate().filter(|(_, force)| *force != 0.0);
            let acting: Vec<(usize, f64)> = acting.collect();
            motions.iter().map(|v| acting.iter().map(|(i, force)| force * v[*i]).sum()).collect()
        };
        rank(motions.iter().map(of_motion).collect())
    }

    /// The changes of the coordinates by a rigid motion of every beam.
    fn moved(&self, freedom: &Freedom, motion: &Motion) -> Vec<f64> {
        let q = self.start();
        let mut moved = vec![0.0; q.len()];
        for (beam, ([tx, ty, turn], part)) in motion.iter().zip(&self.beams).enumerate() {
            let [ox, oy] = freedom.origin(beam);
            let range = 4 * part.first_node..4 * (part.first_node + part.basis.nodes().len());
            let coordinates = moved[range.clone()].as_chunks_mut::<4>().0;
            for (moved, node) in coordinates.iter_mut().zip(nodes(&q[range])) {
                let ([x, y], [gx, gy]) = (node.position, node.gradient);
                *moved = [
                    self.length * tx - turn * (y - oy),
                    self.length * ty + turn * (x - ox),
                    -turn * gy,
                    turn * gx,
                ];
            }
        }
        moved
    }
}

/// The rank of a symmetric matrix that has no negative eigenvalues but by round-off, and rows of different sizes.
fn rank(mut rows: Vec<Vec<f64>>) -> usize {
    let diagonal: Vec<f64> = rows.iter().enumerate().map(|(i, row)| row[i]).collect();
    let mut left: Vec<usize> = (0..rows.len()).filter(|i| diagonal[*i] > 0.0).collect();
    let mut rank = 0;
    // The pivot of which the largest part is left comes first.
    while let Some((at, part)) =
        left.iter().map(|i| rows[*i][*i] / diagonal[*i]).enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b))
        && part > DEPENDENT
    {
        let pivot = left.swap_remove(at);
        let row = rows[pivot].clone();
        for i in &left {
            let factor = row[*i] / row[pivot];
            rows[*i].iter_mut().zip(&row).for_each(|(value, by)| *value -= factor * by);
        }
        rank += 1;
    }
    rank
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_of_matrices_are_counted() {
        assert_eq!(rank(Vec::new()), 0);
        assert_eq!(rank(vec![vec![0.0, 0.0], vec![0.0, 3e-12]]), 1);
        // (1, 2) times itself, and with 1e-6 beside it.
        assert_eq!(rank(vec![vec![1.0, 2.0], vec![2.0, 4.0]]), 1);
        assert_eq!(rank(vec![vec![1.0, 2.0], vec![2.0, 4.0 + 1e-6]]), 2);
        assert_eq!(rank(vec![vec![2.0, 1.0, 0.0], vec![1.0, 2.0, 1.0], vec![0.0, 1.0, 2.0]]), 3);
    }
}
