//! Shape functions tabulated at points of a beam: all that effects, loads, probes and supports see
//! of a discretisation.

/// One point or one cell of a beam, with the coefficients that its rows multiply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Number of the first coefficient; the others follow without gaps.
    pub first: u32,
    /// Number of the block of weights and rows, shared by cells of equal local geometry.
    pub block: u32,
}

/// Rows of shape functions at quadrature points or at single points.
///
/// A row of order d holds dᵈN_j/dsᵈ for `width` consecutive coefficients, so that
/// `dᵈr/dsᵈ = Σ_j row[j] · coefficient[first + j]`. Where a cell touches fewer coefficients (at the
/// ends of a beam), the row is padded with zeros, and `first` is such that all coefficients exist.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BasisTable {
    /// Coefficients that each row multiplies.
    pub width: usize,
    /// Orders of the derivatives held, in the order of the rows of a point.
    pub orders: Vec<usize>,
    /// Points in a cell.
    pub points_per_cell: usize,
    /// Whether these are single points, and not the cells of a quadrature rule.
    pub concentrated: bool,
    /// Cells, or points, in order.
    pub cells: Vec<Cell>,
    /// Per block, per point: the quadrature weight ds \[m\]; 1 for single points.
    pub weights: Vec<f64>,
    /// Per block, per point, per order: a row of `width` numbers. Of order d, those of a value are
    /// in m⁻ᵈ, those of a slope in m¹⁻ᵈ.
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

    /// The first cells of as many fours as there are that have the same block and start each a node
    /// later than the one before, and the cells that are in no four.
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

    /// Numbers from one point's rows to the next point's: `width` times the number of orders.
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
