//! Factorisations against each other: banded LDLᵀ, banded LU, faer's sparse LU, faer's dense LU.

use ancf::linear::complex::ComplexFactor;
use ancf::linear::symmetric::SymmetricBand;
use ancf::linear::{Factor, Matrix, band::BandLu, bordered::Bordered, symmetric::Ldl};
use faer::linalg::solvers::Solve;
use proptest::prelude::*;

/// A symmetric band filled from a list of numbers, with a diagonal that makes it definite (`shift`
/// > 0) or not.
fn symmetric(nodes: usize, blocks: usize, numbers: &[f64], shift: f64) -> Matrix {
    let mut matrix = Matrix::zeros(nodes, blocks, true);
    let mut next = numbers.iter().cycle();
    for i in 0..4 * nodes {
        for j in matrix.columns(i).filter(|j| *j >= i) {
            let value = next.next().copied().unwrap_or(0.0);
            let diagonal = if i == j { shift * (1.0 + value.abs()) } else { 0.0 };
            if let Matrix::Symmetric(m) = &mut matrix {
                m.set(i, j, value + diagonal);
            }
        }
    }
    matrix
}

fn dense(matrix: &Matrix) -> faer::Mat<f64> {
    faer::Mat::from_fn(matrix.size(), matrix.size(), |i, j| matrix.get(i, j))
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0, 40..97)
}

fn agree(a: &[f64], b: &[f64], tolerance: f64) -> Result<(), TestCaseError> {
    let scale = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (a, b) in a.iter().zip(b) {
        prop_assert!((a - b).abs() <= tolerance * scale, "{} against {}", a, b);
    }
    Ok(())
}

/// A row within the first support.
fn row(n: usize) -> Vec<(usize, f64)> {
    vec![(0, 1.0), (n.min(4) - 1, -0.5)]
}

proptest! {
    #![proptest_config(super::cases(64))]

    /// K + c M of an unsymmetric tangent: by blocks without exchanges between them, and by an LU
    /// with exchanges across the band.
    #[test]
    fn unsymmetric_tangents_with_a_mass_are_solved(
        nodes in 1..12_usize, blocks in 1..7_usize, numbers in numbers(),
    ) {
        let m = symmetric(nodes, blocks, &numbers[3..], 20.0);
        let mut k = Matrix::zeros(nodes, blocks, false);
        let mut next = numbers.iter().cycle();
        for i in 0..4 * nodes {
            for j in k.columns(i).filter(|j| (i / 4).abs_diff(j / 4) < blocks) {
                k.add_at(i, j, next.next().copied().unwrap_or(0.0));
            }
        }
        let factor = Factor::shifted(None, &k, (3.0, &m), &[]).expect("a regular matrix");
        prop_assert!(matches!(factor, Factor::BlockLu(_)));
        let mut sum = k.clone();
        for i in 0..4 * nodes {
            for j in m.columns(i) {
                sum.add_at(i, j, 3.0 * m.get(i, j));
            }
        }
        let x: Vec<f64> = (0..4 * nodes).map(|i| (i as f64).sin()).collect();
        let mut b = vec![0.0; 4 * nodes];
        sum.multiply_add(1.0, &x, &mut b);
        factor.solve(&mut b);
        agree(&b, &x, 1e-11)?;
    }

    /// K + ζ M of a collocation method's stages, banded, without symmetry, and bordered: what comes
    /// out is put back into the equations.
    #[test]
    fn complex_systems_are_solved(
        nodes in 1..12_usize, blocks in 1..7_usize, numbers in numbers(),
        re in -30.0..30.0_f64, im in 5.0..40.0_f64, general: bool, bordered: bool,
    ) {
        let k = symmetric(nodes, blocks, &numbers, 3.0);
        let m = symmetric(nodes, blocks, &numbers[3..], 20.0);
        let zeta = faer::c64::new(re, im);
        let n = k.size();
        let k = match &k {
            Matrix::Symmetric(k) if general => Matrix::General(k.to_band()),
            _ => k,
        };
        let border = if bordered { vec![row(n)] } else { vec![] };
        let size = n + border.len();
        let b: Vec<f64> = numbers.iter().cycle().take(2 * size).copied().collect();
        let (mut x_re, mut x_im) = (b[..size].to_vec(), b[size..].to_vec());
        // Twice: the second factorisation reuses the memory of the first.
        let first = ComplexFactor::again(None, &k, &m, zeta.conj(), &border).expect("regular");
        let factor = ComplexFactor::again(Some(first), &k, &m, zeta, &border).expect("regular");
        factor.solve(&mut x_re, &mut x_im);
        let (mut back_re, mut back_im) = (vec![0.0; size], vec![0.0; size]);
        k.multiply_add(1.0, &x_re[..n], &mut back_re[..n]);
        k.multiply_add(1.0, &x_im[..n], &mut back_im[..n]);
        m.multiply_add(re, &x_re[..n], &mut back_re[..n]);
        m.multiply_add(-im, &x_im[..n], &mut back_re[..n]);
        m.multiply_add(re, &x_im[..n], &mut back_im[..n]);
        m.multiply_add(im, &x_re[..n], &mut back_im[..n]);
        for (r, row) in border.iter().enumerate() {
            for &(i, value) in row {
                for (back, x) in [(&mut back_re, &x_re), (&mut back_im, &x_im)] {
                    back[i] += value * x[n + r];
                    back[n + r] += value * x[i];
                }
            }
        }
        agree(&back_re, &b[..size], 1e-9)?;
        agree(&back_im, &b[size..], 1e-9)?;
    }

    /// K + c M in one pass is the sum factorised: to round-off where that is eliminated from one
    /// end and the other from both.
    #[test]
    fn shifted_systems_are_solved(
        nodes in 1..12_usize, blocks in 1..7_usize, numbers in numbers(), c in 0.0..5.0_f64,
    ) {
        let (k, m) = (symmetric(nodes, blocks, &numbers, 30.0), symmetric(nodes, blocks, &numbers[5..], 30.0));
        let mut sum = k.clone();
        sum.add(c, &m);
        let b: Vec<f64> = numbers.iter().cycle().take(k.size()).copied().collect();
        let (mut x, mut y) = (b.clone(), b);
        Factor::new(&sum, &[]).expect("definite").solve(&mut x);
        let earlier = Factor::new(&k, &[]).expect("definite");
        Factor::shifted(Some(earlier), &k, (c, &m), &[]).expect("definite").solve(&mut y);
        if blocks.min(nodes) == 2 {
            agree(&x, &y, 1e-13)?;
        } else {
            prop_assert_eq!(x, y);
        }
    }

    #[test]
    fn products_take_every_entry(nodes in 1..12_usize, blocks in 1..7_usize, numbers in numbers()) {
        let matrix = symmetric(nodes, blocks, &numbers, 0.0);
        let n = matrix.size();
        let x: Vec<f64> = numbers.iter().cycle().take(n).copied().collect();
        let mut y = x.clone();
        matrix.multiply_add(-0.7, &x, &mut y);
        for i in 0..n {
            let sum: f64 = (0..n).map(|j| matrix.get(i, j) * x[j]).sum();
            prop_assert!((y[i] - x[i] + 0.7 * sum).abs() < 1e-12, "row {}", i);
        }
    }

    #[test]
    fn all_factorisations_solve_alike(nodes in 1..12_usize, blocks in 1..7_usize, numbers in numbers()) {
        let matrix = symmetric(nodes, blocks, &numbers, 30.0);
        let n = matrix.size();
        let b: Vec<f64> = numbers.iter().cycle().take(n).copied().collect();
        let mut expected = faer::Mat::from_fn(n, 1, |i, _| b[i]);
        dense(&matrix).partial_piv_lu().solve_in_place(&mut expected);
        let expected: Vec<f64> = (0..n).map(|i| expected[(i, 0)]).collect();
        let Matrix::Symmetric(symmetric) = &matrix else { unreachable!("built symmetric") };
        let mut x = b.clone();
        Ldl::new(symmetric).expect("definite").solve(&mut x);
        agree(&x, &expected, 1e-12)?;
        let mut x = b.clone();
        BandLu::new(&symmetric.to_band()).expect("regular").solve(&mut x);
        agree(&x, &expected, 1e-12)?;
        let mut x = b.clone();
        Bordered::new(&matrix, &[], None).expect("regular").solve(&mut x);
        agree(&x, &expected, 1e-12)?;
        // Multiplying back gives the right-hand side.
        let mut back = vec![0.0; n];
        matrix.multiply_add(1.0, &expected, &mut back);
        agree(&back, &b, 1e-11)?;
    }

    #[test]
    fn inertia_is_the_number_of_negative_eigenvalues(nodes in 1..10_usize, blocks in 1..7_usize, numbers in numbers()) {
        let matrix = symmetric(nodes, blocks, &numbers, 0.0);
        let eigenvalues = dense(&matrix).self_adjoint_eigenvalues(faer::Side::Lower).expect("symmetric");
        prop_assume!(eigenvalues.iter().all(|e| e.abs() > 1e-6));
        let factor = Factor::new(&matrix, &[]).expect("regular");
        if let Some(count) = factor.negative_eigenvalues() {
            prop_assert_eq!(count, eigenvalues.iter().filter(|e| **e < 0.0).count());
        }
    }

    #[test]
    fn pivoted_lu_solves_what_needs_pivots(n in 2..40_usize, half in 1..9_usize, numbers in numbers()) {
        // No diagonal dominance, zeros on the diagonal.
        let mut band = ancf::linear::band::Band::zeros(n, half);
        let mut next = numbers.iter().cycle();
        for i in 0..n {
            for j in band.columns(i) {
                band.set(i, j, if i == j { 0.0 } else { next.next().copied().unwrap_or(0.0) });
            }
        }
        let matrix = Matrix::General(band.clone());
        let lu = dense(&matrix).full_piv_lu();
        let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let mut expected = faer::Mat::from_fn(n, 1, |i, _| b[i]);
        lu.solve_in_place(&mut expected);
        let size = (0..n).map(|i| expected[(i, 0)].abs()).fold(0.0, f64::max);
        prop_assume!(size < 1e3);
        let mut x = b;
        let ours = BandLu::new(&band).expect("regular");
        let negative = (0..n).filter(|k| ours.turns_sign(*k)).count() % 2 == 1;
        prop_assert_eq!(negative, dense(&matrix).determinant() < 0.0);
        ours.solve(&mut x);
        agree(&x, &(0..n).map(|i| expected[(i, 0)]).collect::<Vec<_>>(), 1e-9)?;
    }

    #[test]
    fn bordered_solution_satisfies_its_constraints(nodes in 2..8_usize, numbers in numbers(), at in 0..7_usize) {
        let matrix = symmetric(nodes, 2, &numbers, 30.0);
        let n = matrix.size();
        let row = vec![(at, 1.0), (at + 1, -2.0)];
        let mut x: Vec<f64> = numbers.iter().cycle().take(n).copied().collect();
        x.push(0.25);
        let b = x.clone();
        Factor::new(&matrix, std::slice::from_ref(&row)).expect("regular").solve(&mut x);
        prop_assert!((x[at] - 2.0 * x[at + 1] - 0.25).abs() < 1e-12);
        let mut back = vec![0.0; n];
        matrix.multiply_add(1.0, &x[..n], &mut back);
        for (j, value) in row {
            back[j] += value * x[n];
        }
        agree(&back, &b[..n], 1e-11)?;
    }
}

/// What elimination leaves of a pivot is measured by the entry of K + c M that it came from: of 2⁴⁰
/// = c m there is 2⁻¹², a last digit.
#[test]
fn pivots_of_a_shifted_matrix_are_measured_by_the_sum() {
    let (k, mut m) = (SymmetricBand::zeros(1, 1), SymmetricBand::zeros(1, 1));
    let c = 2_f64.powi(20);
    (0..4).for_each(|i| m.set(i, i, c));
    m.set(0, 1, c);
    m.set(1, 1, c * (1.0 + f64::EPSILON));
    let singular = Ldl::again(None, &k, Some((c, &m))).expect_err("no pivot in row 1");
    assert_eq!(singular.row, 1);
}
