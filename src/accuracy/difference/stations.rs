//! Where along the beams two runs are compared.

use crate::accuracy::mesh::Mesh;

/// Most places of a beam that are watched, unless it has more cells.
const STATIONS: usize = 64;

/// Where all beams are compared, as arc lengths \[m\] on each: in every cell of the coarser meshes as
/// many. Where nodes of the finer ones come to lie both are at their best, and none of those is taken
/// but the end and the nodes that must be: where something acts that makes the strain jump, elements
/// whose strain cannot jump err most. Nor are the quarters of the coarser cells: where curvatures are linear
/// within cells, as those of elements nearly are, both err alike there.
pub fn stations(meshes: &[Mesh]) -> Vec<Vec<f64>> {
    let of = |mesh: &Mesh| {
        let of_cell = |cell: &[f64]| {
            let node = mesh.must_be(cell[0]).then_some(cell[0]).filter(|s| *s > 0.0);
            let inside = parts(mesh, cell).iter().map(|p| cell[0] + p * (cell[1] - cell[0]));
            node.into_iter().chain(inside).collect::<Vec<_>>()
        };
        let mut s: Vec<f64> = mesh.nodes.windows(2).flat_map(of_cell).collect();
        s.extend(mesh.nodes.last());
        s
    };
    meshes.iter().map(of).collect()
}

/// The stations inside of a cell, as parts of its length. A beam that is the mirror image of itself has stations that
/// are.
pub fn parts(mesh: &Mesh, cell: &[f64]) -> &'static [f64] {
    if mesh.cells() * 2 <= STATIONS {
        &[0.375, 0.625]
    } else if cell[0] + cell[1] < mesh.length() {
        &[0.375]
    } else {
        &[0.625]
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{meshes, scene};
    use super::*;

    /// Two stations in a cell, or one where there are more than 32 cells, one at the end, and one at each
    /// node that must be.
    #[test]
    fn stations_are_inside_of_cells_and_at_nodes_that_must_be() {
        assert_eq!(stations(&meshes()), [vec![0.1875, 0.3125, 1.0625, 1.4375, 2.0], vec![1.5, 2.5, 4.0]]);
        let pulled = scene("static = {}\neffect.force = [{ beam = 'arm', at = 0.5, value = [1, 0] }]");
        let mesh = Mesh::first(pulled.model(), 0, 1.0).remove(0);
        let nodes: Vec<f64> = stations(std::slice::from_ref(&mesh))[0]
            .iter()
            .copied()
            .filter(|s| mesh.nodes.contains(s))
            .collect();
        assert_eq!(nodes, [0.5, 2.0]);
        let of_cells = |cells: usize| {
            let nodes: Vec<f64> = (0..=cells).map(|i| i as f64).collect();
            stations(&[Mesh::of(&nodes)]).remove(0)
        };
        assert_eq!((of_cells(32).len(), of_cells(33).len()), (65, 34));
        assert_eq!(of_cells(33)[14..18], [14.375, 15.375, 16.625, 17.625]);
        assert_eq!(of_cells(34)[16..18], [16.375, 17.625]);
    }
}
