//! A tangent that turns with the nodes.
//!
//! What changes a slender beam's tangent K most is rotation. Between the state q₀ at which K was taken and the state q, node i turns by
//! φ_i, the angle from r'_i(q₀) to r'_i(q); with R = diag(R(φ_i)) over the pairs (x, y) and (x', y') of the nodes, R K Rᵀ is K at
//! q but for the change of stress and shape. So a residual is turned back by Rᵀ, solved for with the old factorisation, and the increment turned
//! forth by R.

/// R, node by node.
#[derive(Clone, Debug)]
pub struct Turns {
    /// Cosine and sine of φ_i.
    turns: Vec<[f64; 2]>,
    /// Nodes that do not turn: a held component of a position must stay what it is.
    still: Vec<usize>,
}

impl Turns {
    /// No turn of any of `nodes` nodes; those of `still` never turn.
    pub fn new(nodes: usize, still: Vec<usize>) -> Self {
        Self { turns: vec![[1.0, 0.0]; nodes], still }
    }

    /// Measures the turns from `q0` to `q`.
    pub fn measure(&mut self, q0: &[f64], q: &[f64]) {
        let nodes = q.chunks_exact(4).zip(q0.chunks_exact(4));
        for (turn, (x, start)) in self.turns.iter_mut().zip(nodes) {
            let (cosine, sine) = (x[2] * start[2] + x[3] * start[3], x[3] * start[2] - x[2] * start[3]);
            let square = cosine * cosine + sine * sine;
            // Also false for a NaN.
            *turn = if square > 0.0 {
                let inverse = 1.0 / square.sqrt();
                [cosine * inverse, sine * inverse]
            } else {
                [1.0, 0.0]
            };
        }
        for &node in &self.still {
            self.turns[node] = [1.0, 0.0];
        }
    }

    /// R v.
    pub fn forth(&self, v: &mut [f64]) {
        self.turn(v, 1.0);
    }

    /// Rᵀ v.
    pub fn back(&self, v: &mut [f64]) {
        self.turn(v, -1.0);
    }

    fn turn(&self, v: &mut [f64], sign: f64) {
        for (v, [cosine, sine]) in v.chunks_exact_mut(4).zip(&self.turns) {
            let sine = sign * sine;
            (v[0], v[1]) = (cosine * v[0] - sine * v[1], cosine * v[1] + sine * v[0]);
            (v[2], v[3]) = (cosine * v[2] - sine * v[3], cosine * v[3] + sine * v[2]);
        }
    }
}
