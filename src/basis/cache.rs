//! Shape functions that were computed before: of the discretisations that one model after the other
//! has, and the tables of each.

use std::sync::{Arc, Mutex, PoisonError};

use super::{Basis, BasisError, BasisTable, Discretization, Quadrature};

/// Most discretisations that are kept; the one that was not asked for the longest goes first.
const DISCRETIZATIONS: usize = 32;
/// Most tables that are kept of each.
const TABLES: usize = 32;

/// Shape functions of beams that many runs have in common, such as those of an optimisation, in
/// which loads change and discretisations do not. Threads may share it.
///
/// ```
/// use ancf::basis::{BasisCache, Discretization};
///
/// let cache = BasisCache::default();
/// let first = cache.get(&Discretization::rpim(12), 1.8, &[])?;
/// let again = cache.get(&Discretization::rpim(12), 1.8, &[])?;
/// assert!(std::sync::Arc::ptr_eq(&first, &again));
/// # Ok::<(), ancf::basis::BasisError>(())
/// ```
#[derive(Debug, Default)]
pub struct BasisCache {
    kept: Mutex<Vec<Kept>>,
}

#[derive(Debug)]
struct Kept {
    discretization: Discretization,
    length: f64,
    breaks: Vec<f64>,
    basis: Arc<Basis>,
}

impl BasisCache {
    /// [`Basis::broken`], computed once.
    ///
    /// # Errors
    /// As [`Basis::broken`].
    pub fn get(
        &self,
        discretization: &Discretization,
        length: f64,
        breaks: &[f64],
    ) -> Result<Arc<Basis>, BasisError> {
        let lock = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |kept: &Kept| {
            kept.length == length && kept.breaks == breaks && kept.discretization == *discretization
        };
        {
            let mut kept = lock();
            if let Some(index) = kept.iter().position(same) {
                let found = kept.remove(index);
                let basis = Arc::clone(&found.basis);
                kept.push(found);
                return Ok(basis);
            }
        }
        // Not under the lock: other threads need not wait for what takes long.
        let basis = Arc::new(Basis::broken(discretization, length, breaks)?.keep_tables());
        let mut kept = lock();
        if kept.len() >= DISCRETIZATIONS {
            kept.remove(0);
        }
        let (discretization, breaks) = (discretization.clone(), breaks.to_vec());
        kept.push(Kept { discretization, length, breaks, basis: Arc::clone(&basis) });
        Ok(basis)
    }
}

/// What a table is asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Request {
    /// The points of a rule in every cell, and orders of derivatives.
    Cells(Quadrature, Vec<usize>),
    /// Arc lengths, and orders of derivatives.
    Points(Vec<f64>, Vec<usize>),
}

/// Tables of one discretisation.
#[derive(Debug, Default)]
pub(super) struct Tables(Mutex<Vec<(Request, BasisTable)>>);

impl Tables {
    /// The table that was asked for before, or the one that `compute` makes.
    pub fn get(
        &self,
        request: Request,
        compute: impl FnOnce() -> Result<BasisTable, BasisError>,
    ) -> Result<BasisTable, BasisError> {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, table)) = lock().iter().find(|(known, _)| *known == request) {
            return Ok(table.clone());
        }
        let table = compute()?;
        let mut kept = lock();
        if kept.len() >= TABLES {
            kept.remove(0);
        }
        kept.push((request, table.clone()));
        Ok(table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_computed_before_is_given_again() {
        let cache = BasisCache::default();
        let get = |nodes: usize, length: f64, breaks: &[f64]| {
            cache.get(&Discretization::rpim(nodes), length, breaks).unwrap()
        };
        let first = get(5, 1.0, &[]);
        assert!(Arc::ptr_eq(&first, &get(5, 1.0, &[])));
        for other in [get(6, 1.0, &[]), get(5, 1.5, &[]), get(5, 1.0, &[0.4])] {
            assert!(!Arc::ptr_eq(&first, &other));
        }
        assert_eq!(cache.kept.lock().unwrap().len(), 4);
        // The first was asked for again just before, and is the last to go.
        let first = get(5, 1.0, &[]);
        for nodes in 7..6 + DISCRETIZATIONS {
            get(nodes, 1.0, &[]);
        }
        assert_eq!(cache.kept.lock().unwrap().len(), DISCRETIZATIONS);
        assert!(Arc::ptr_eq(&first, &get(5, 1.0, &[])));
    }

    #[test]
    fn kept_tables_are_those_that_were_computed() {
        let basis = Basis::new(&Discretization::rpim(6), 2.0).unwrap().keep_tables();
        for orders in [&[0, 1, 2][..], &[1]] {
            for rule in [Quadrature::Gauss(3), Quadrature::Lobatto(3)] {
                let first = basis.table(rule, orders).unwrap();
                assert_eq!(basis.table(rule, orders).unwrap(), first);
                assert_eq!(basis.of_cells(rule, orders).unwrap(), first);
            }
            for s in [&[0.3][..], &[0.3, 1.7]] {
                let first = basis.points(s, orders).unwrap();
                assert_eq!(basis.points(s, orders).unwrap(), first);
                assert_eq!(basis.of_points(s, orders).unwrap(), first);
            }
        }
        assert!(basis.points(&[2.5], &[0]).is_err() && basis.points(&[2.5], &[0]).is_err());
    }

    /// The table that was computed first goes first.
    #[test]
    fn tables_make_room_for_new_ones() {
        let tables = Tables::default();
        let computed = std::cell::Cell::new(0);
        let get = |s: usize| {
            let compute = || {
                computed.set(computed.get() + 1);
                Ok(BasisTable { width: s, ..BasisTable::default() })
            };
            assert_eq!(tables.get(Request::Points(vec![s as f64], vec![0]), compute).unwrap().width, s);
        };
        (0..=TABLES).for_each(get);
        (1..=TABLES).for_each(get);
        assert_eq!(computed.get(), TABLES + 1, "all but the first were known");
        get(0);
        assert_eq!(computed.get(), TABLES + 2);
    }
}
