//! Shape functions tabulated at points of a beam. Effects, loads, probes and supports know a
//! discretisation only through such tables.

/// One point or one cell of a beam: which coefficients and which rows belong to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Index of the first coefficient; the others follow without gaps.
    pub first: u32,
    /// Index of the block of weights and rows, shared by cells of equal local geometry.
    pub block: u32,
}

/// Rows of shape functions at quadrature points or at single points.
///
/// A row of order d holds dᵈN_j/dsᵈ for `width` consecutive coefficients, so that
/// `dᵈr/dsᵈ = Σ_j row[j] · coefficient[first + j]`. Where a cell touches fewer coefficients (at the
/// ends of a beam), the row is padded with zeros, and `first` is such that all coefficients exist.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BasisTable {
    /// Number of coefficients that each row multiplies.
    pub width: usize,
    /// Orders of the derivatives held, in the order of the rows of a point.
    pub orders: Vec<usize>,
    /// Points in a cell.
    pub points_per_cell: usize,
    /// Whether the table holds single points instead of the cells of a quadrature rule.
    pub concentrated: bool,
    /// Cells, or points, in order.
    pub cells: Vec<Cell>,
    /// Per block, per point: the quadrature weight ds \[m\]; 1 for single points.
    pub weights: Vec<f64>,
    /// Per block, per point, per order: a row of `width` numbers. In a row of order d, the entries
    /// for positions are in m⁻ᵈ, those for slopes in m¹⁻ᵈ.
    pub rows: Vec<f64>,
    /// Per cell, per point: the arc length s \[m\].
    pub s: Vec<f64>,
}

impl BasisTable {
    /// Weights and rows of a cell: `points_per_cell` weights, and for each point one row per order.
    ///
    /// # Panics
    /// If the cell's block is not one of this table's.
    #[inline]
    pub fn block(&self, cell: Cell) -> (&[f64], &[f64]) {
        let block = cell.block as usize;
        let points = self.points_per_cell;
        let stride = points * self.row_stride();
        (
            &self.weights[block * points..(block + 1) * points],
            &self.rows[block * stride..(block + 1) * stride],
        )
    }

    /// Keeps those cells for which `wanted` is true; it is given the range of a cell's points among
    /// all points.
    pub fn keep_cells(&mut self, wanted: impl Fn(std::ops::Range<usize>) -> bool) {
        let points = self.points_per_cell;
        let kept: Vec<usize> =
            (0..self.cells.len()).filter(|cell| wanted(cell * points..(cell + 1) * points)).collect();
        self.s = kept.iter().flat_map(|cell| &self.s[cell * points..(cell + 1) * points]).copied().collect();
        self.cells = kept.iter().map(|cell| self.cells[*cell]).collect();
    }

    /// Groups cells for computation four at a time. The first list holds the first cell of each
    /// four consecutive cells that share one block and start each one node after the cell before;
    /// the second list holds the remaining cells.
    pub fn by_fours(&self) -> (Vec<u32>, Vec<u32>) {
        let alike = |cells: &[Cell]| {
            cells.windows(2).all(|pair| pair[0].block == pair[1].block && pair[1].first == pair[0].first + 2)
        };
        let (mut fours, mut singles) = (Vec::new(), Vec::new());
        let mut cell = 0;
        while cell < self.cells.len() {
            if self.cells.get(cell..cell + 4).is_some_and(alike) {
                fours.push(cell as u32);
                cell += 4;
            } else {
                singles.push(cell as u32);
                cell += 1;
            }
        }
        (fours, singles)
    }

    /// Distance in memory from one point's rows to the next point's: `width` times the number of
    /// orders.
    #[inline]
    pub fn row_stride(&self) -> usize {
        self.width * self.orders.len()
    }

    /// Number of different blocks.
    pub fn blocks(&self) -> usize {
        self.weights.len().checked_div(self.points_per_cell).unwrap_or(0)
    }

    /// Number of points in all cells together.
    pub fn points(&self) -> usize {
        self.cells.len() * self.points_per_cell
    }

    /// Memory held on the heap \[bytes\].
    pub fn bytes(&self) -> usize {
        size_of_val(self.cells.as_slice())
            + size_of_val(self.weights.as_slice())
            + size_of_val(self.rows.as_slice())
            + size_of_val(self.s.as_slice())
            + size_of_val(self.orders.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells with two points each, of as many blocks as there are numbers.
    fn table(cells: &[(u32, u32)]) -> BasisTable {
        let cells: Vec<Cell> = cells.iter().map(|&(first, block)| Cell { first, block }).collect();
        let blocks = cells.iter().map(|cell| cell.block + 1).max().unwrap_or(0);
        BasisTable {
            width: 4,
            orders: vec![0, 2, 1],
            points_per_cell: 2,
            concentrated: false,
            s: (0..2 * cells.len()).map(|i| i as f64).collect(),
            weights: (0..2 * blocks).map(f64::from).collect(),
            rows: (0..2 * 12 * blocks).map(f64::from).collect(),
            cells,
        }
    }

    #[test]
    fn blocks_are_the_weights_and_rows_of_a_cell() {
        let table = table(&[(0, 0), (2, 1), (4, 1)]);
        assert_eq!((table.row_stride(), table.blocks(), table.points()), (12, 2, 6));
        let (weights, rows) = table.block(table.cells[2]);
        assert_eq!((weights, rows.len(), rows[0], rows[23]), (&[2.0, 3.0][..], 24, 24.0, 47.0));
        // Three cells of 8 bytes, 4 weights, 48 numbers in rows, 6 places, and 3 orders.
        assert_eq!(table.bytes(), 3 * 8 + 8 * (4 + 48 + 6 + 3));
        assert_eq!((BasisTable::default().blocks(), BasisTable::default().points()), (0, 0));
    }

    #[test]
    fn kept_cells_keep_their_places() {
        let mut table = table(&[(0, 0), (2, 0), (4, 0)]);
        table.keep_cells(|points| points != (2..4));
        assert_eq!(table.s, [0.0, 1.0, 4.0, 5.0]);
        assert_eq!(table.cells.iter().map(|cell| cell.first).collect::<Vec<_>>(), [0, 4]);
    }

    #[test]
    fn four_cells_in_a_row_that_are_alike_go_together() {
        let even: Vec<(u32, u32)> = (0..9).map(|i| (2 * i, 0)).collect();
        assert_eq!(table(&even).by_fours(), (vec![0, 4], vec![8]));
        let with = |at: usize, cell: (u32, u32)| {
            let mut cells = even.clone();
            cells[at] = cell;
            table(&cells).by_fours()
        };
        assert_eq!(with(0, (0, 1)), (vec![1, 5], vec![0]));
        assert_eq!(with(3, (6, 1)), (vec![4], vec![0, 1, 2, 3, 8]));
        // A gap in the coefficients.
        assert_eq!(with(2, (5, 0)), (vec![3], vec![0, 1, 2, 7, 8]));
    }
}
