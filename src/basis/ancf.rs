//! Shape functions of the gradient-deficient cable element: cubic Hermite polynomials between two
//! nodes.
//!
//! With ξ = (s − s_i)/l, for (r_i, r'_i, r_{i+1}, r'_{i+1}):
//!
//! N₁ = 1 − 3ξ² + 2ξ³,  N₂ = l(ξ − 2ξ² + ξ³),  N₃ = 3ξ² − 2ξ³,  N₄ = l(−ξ² + ξ³).
//!
//! Source: Gerstmayr and Shabana, *Nonlinear Dynamics* 45 (2006) 109–130, the thin cable element.

/// Derivative of order `order` (0, 1 or 2) of the four functions with respect to s, at ξ ∈ [0, 1]
/// of a cell of length `l` \[m\].
pub fn row(l: f64, xi: f64, order: usize, out: &mut [f64; 4]) {
    let x = xi;
    *out = match order {
        0 => {
            let y = 1.0 - x;
            [y * y * (1.0 + 2.0 * x), l * x * y * y, x * x * (3.0 - 2.0 * x), -l * x * x * y]
        }
        1 => {
            let y = 1.0 - x;
            [-6.0 * x * y / l, y * (1.0 - 3.0 * x), 6.0 * x * y / l, -x * (2.0 - 3.0 * x)]
        }
        _ => {
            let ll = l * l;
            [(12.0 * x - 6.0) / ll, (6.0 * x - 4.0) / l, (6.0 - 12.0 * x) / ll, (6.0 * x - 2.0) / l]
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ N_i u_i reproduces a cubic and its derivatives, which fixes all four functions.
    #[test]
    fn cubics_are_reproduced_with_derivatives() {
        let c = [0.3, -1.2, 0.7, 2.1];
        let f = |s: f64| {
            [
                c[0] + s * (c[1] + s * (c[2] + s * c[3])),
                c[1] + s * (2.0 * c[2] + s * 3.0 * c[3]),
                2.0 * c[2] + 6.0 * c[3] * s,
            ]
        };
        let l = 0.37;
        let nodal = [f(0.0)[0], f(0.0)[1], f(l)[0], f(l)[1]];
        for xi in [0.0, 0.1, 0.5, 0.83, 1.0] {
            for (order, exact) in f(xi * l).into_iter().enumerate() {
                let mut n = [0.0; 4];
                row(l, xi, order, &mut n);
                let value: f64 = n.iter().zip(nodal).map(|(n, u)| n * u).sum();
                assert!((value - exact).abs() < 1e-13 / l.powi(order as i32), "order {order} at {xi}");
            }
        }
    }
}
