//! Number of directions in which a tangent is negative, among the motions that constraint rows
//! allow: by the signs of the pivots of its LDLᵀ without pivoting, see [`SparseLdl`].

use super::Matrix;
use super::bordered::BorderRow;
use super::sparse_ldl::SparseLdl;

/// Factors of the weights of rows that are tried until two of them yield the same number. One is not
/// enough: without pivoting, a small pivot may amplify round-off to the size of entries eliminated
/// after it.
const TRIES: [f64; 5] = [1.0, 30.0, 0.03, 7.0, 0.2];

/// Number of negative eigenvalues of the symmetric `k` on the motions that the rows of `border`
/// allow; `None` if `k` is unsymmetric, or if no two eliminations without a vanishing pivot agree.
/// The factorisation that is `known` of it is one of them.
pub fn negative_directions(k: &Matrix, border: &[BorderRow], known: Option<&SparseLdl>) -> Option<usize> {
    if matches!(k, Matrix::General(_)) {
        return None;
    }
    let mut counts: Vec<usize> = known.and_then(SparseLdl::negative_directions).into_iter().collect();
    let mut last: Option<SparseLdl> = None;
    for factor in TRIES.iter().filter(|factor| known.is_none_or(|known| known.factor() != **factor)) {
        let Ok(ldl) = SparseLdl::new(last.as_ref().or(known), k, border, *factor) else { continue };
        let count = ldl.negative_directions();
        last = Some(ldl);
        let Some(count) = count else { continue };
        if counts.contains(&count) {
            return Some(count);
        }
        counts.push(count);
    }
    None
}
