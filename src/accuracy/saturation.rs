//! Errors of radial shape functions that finer meshes do not remove.
//!
//! Radial functions whose width is fixed in units of the spacing reproduce no polynomials. Their error
//! falls with the spacing only down to a level that their width decides (the saturation error of
//! stationary interpolation: M. D. Buhmann, *Radial Basis Functions*, Cambridge 2003, chapter 5). From
//! there on a mesh and its halves agree with each other and not with the truth, so that elements, which
//! reproduce cubic polynomials, have to be asked. So they have where half as many nodes are so few that most shape
//! functions reach to an end ([`ends_prevail`]), and where a cell is much shorter than the next ([`has_uneven_cells`]).

use super::difference::defects;
use crate::basis::Basis;
use crate::model::{Discretization, Nodes};

/// Shape functions that reproduce a constant curvature to this part of it converge as elements do.
const REPRODUCED: f64 = 1e-3;
/// Nodes beside those that a cell between the ends reaches over.
const ENDS: usize = 4;
/// Of neighbouring cells of which one is shorter than this part of the other, meshfree shape functions amplify round-off fiftyfold.
const UNEVEN: f64 = 0.2;
/// Places in each cell.
const PLACES: [f64; 3] = [0.15, 0.5, 0.85];

/// Whether shape functions on a beam of this length \[m\] reproduce constant curvatures too badly for
/// errors to fall as the spacing does.
pub(super) fn saturates(discretization: &Discretization, length: f64) -> bool {
    let Discretization::Rpim { neighbours, .. } = discretization else { return false };
    let mut few = discretization.clone();
    if let Discretization::Rpim { nodes, .. } = &mut few {
        // The width alone decides: a beam with all kinds of cells, at the ends and between, will do.
        *nodes = Nodes::Uniform(nodes.count().min(2 * neighbours + ENDS));
    }
    defect(&few, length).is_some_and(|defect| defect > REPRODUCED)
}

/// Whether on a mesh of so many cells most shape functions of this kind reach to an end, where they are others than
/// within the beam. By how much they differ from those on twice as many cells tells nothing of how much the latter err.
pub(super) fn ends_prevail(discretization: &Discretization, cells: usize) -> bool {
    matches!(discretization, Discretization::Rpim { neighbours, .. } if cells <= 2 * (2 * neighbours + 1))
}

/// Whether of the cells of a meshfree beam of this length \[m\], with nodes at its `breaks` \[m\], one is much shorter than the next.
/// On a coarser mesh, which has not all of these nodes, shape functions are others there.
pub(super) fn has_uneven_cells(discretization: &Discretization, length: f64, breaks: &[f64]) -> bool {
    let Discretization::Rpim { nodes, .. } = discretization else { return false };
    let elements = Discretization::Ancf { nodes: nodes.clone() };
    Basis::broken(&elements, length, breaks).is_ok_and(|basis| is_uneven(basis.nodes()))
}

/// Whether a cell is much shorter than one beside it.
pub(super) fn is_uneven(nodes: &[f64]) -> bool {
    let cells: Vec<f64> = nodes.windows(2).map(|ends| ends[1] - ends[0]).collect();
    cells.windows(2).any(|pair| pair[0].min(pair[1]) < UNEVEN * pair[0].max(pair[1]))
}

/// The largest part by which a constant curvature is wrong within cells; `None` where there are no such shape functions.
fn defect(discretization: &Discretization, length: f64) -> Option<f64> {
    let basis = Basis::new(discretization, length).ok()?;
    let inside = |cell: &[f64]| PLACES.map(|part| cell[0] + part * (cell[1] - cell[0]));
    let places: Vec<f64> = basis.nodes().windows(2).flat_map(inside).collect();
    Some(defects(&basis, &places)?.into_iter().fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Kernel;

    fn meshfree(nodes: usize, of: Option<Kernel>) -> Discretization {
        let mut found = Discretization::rpim(nodes);
        if let (Discretization::Rpim { kernel, .. }, Some(of)) = (&mut found, of) {
            *kernel = of;
        }
        found
    }

    /// The usual cells reach over five, so that of ten only those in the middle do not reach to an end.
    #[test]
    fn ends_prevail_on_meshes_of_few_cells() {
        let found = |cells| ends_prevail(&meshfree(9, None), cells);
        assert!(found(4) && found(10) && !found(11));
        assert!(!ends_prevail(&Discretization::ancf(9), 4));
    }

    /// A break a fifth of a cell beside a given node; even nodes move there. Elements do not reach over others.
    #[test]
    fn breaks_may_leave_uneven_cells() {
        let mut given = meshfree(9, None);
        if let Discretization::Rpim { nodes, .. } = &mut given {
            *nodes = Nodes::Given(vec![0.0, 1.0, 2.0, 3.0, 4.0]);
        }
        let uneven = |discretization: &Discretization, s: f64| has_uneven_cells(discretization, 4.0, &[s]);
        assert!(uneven(&given, 1.15) && !uneven(&given, 1.25) && !uneven(&meshfree(5, None), 1.15));
        assert!(!uneven(&Discretization::Ancf { nodes: given.nodes().clone() }, 1.15));
    }

    /// The number of nodes and the length do not matter. Beams of these kernels were compared with many
    /// elements: those that are said to saturate err by 1e-7 to 1e-3 of their length with 19 nodes and
    /// hardly less with 37, the others by less than 1e-8.
    #[test]
    fn narrow_kernels_saturate() {
        let narrow = [
            Kernel::Multiquadric { q: 0.5, shape: 2.0 },
            Kernel::Multiquadric { q: 1.03, shape: 1.0 },
            Kernel::Wendland { radius: 8.0 },
            Kernel::Wendland { radius: 30.0 },
            Kernel::ThinPlateSpline { exponent: 5.0 },
        ];
        let wide = [None, Some(Kernel::Multiquadric { q: 1.03, shape: 20.0 })];
        for (nodes, length) in [(10, 1.0), (19, 1e-3), (37, 70.0)] {
            for kernel in narrow {
                assert!(saturates(&meshfree(nodes, Some(kernel)), length), "{kernel:?}");
            }
            for kernel in wide {
                assert!(!saturates(&meshfree(nodes, kernel), length), "{kernel:?}");
            }
            let kernel = Kernel::Multiquadric { q: 0.5, shape: 2.0 };
            let found = defect(&meshfree(nodes, Some(kernel)), length).expect("shape functions");
            assert!((found - 0.052_244_507).abs() < 1e-8, "{found}");
        }
        assert!(!saturates(&Discretization::ancf(4), 1.0));
        let elements = defect(&Discretization::ancf(4), 3.0).expect("shape functions");
        assert!(elements < 1e-13, "{elements}");
    }
}
