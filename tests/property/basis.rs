//! Shape functions: what defines them holds for every mesh, kernel and length, or the refusal says
//! what to change.

use ancf::basis::{Basis, BasisError, BasisTable, Quadrature};
use ancf::model::{Discretization, Kernel, Nodes, SideCondition};
use proptest::prelude::*;

/// The accuracy promised, relative to each function's own scale.
const PROMISED: f64 = 1e-11;

/// Arc lengths from spacings, scaled to the length.
fn nodes_from(spacings: &[f64], length: f64) -> Vec<f64> {
    let total: f64 = spacings.iter().sum();
    let mut s: Vec<f64> = std::iter::once(0.0)
        .chain(spacings.iter().scan(0.0, |sum, spacing| {
            *sum += spacing;
            Some(*sum / total * length)
        }))
        .collect();
    if let Some(last) = s.last_mut() {
        *last = length;
    }
    s
}

/// Meshes whose neighbouring spacings differ by up to 1000 : 1.
fn spacings() -> impl Strategy<Value = Vec<f64>> {
    let cells = 1..12usize;
    prop_oneof![
        (cells.clone(), 0.0..3.0f64)
            .prop_map(|(n, log)| (0..n).map(|i| if i % 2 == 0 { 1.0 } else { 10f64.powf(log) }).collect()),
        // As far as double precision can hold the nodes: 13 digits between the smallest spacing and
        // the length.
        (cells.clone(), 0.0..3.0f64, any::<bool>()).prop_map(|(n, log, grows)| {
            let log = log.min(12.0 / n as f64) * if grows { 1.0 } else { -1.0 };
            (0..n).map(|i| 10f64.powf(log * i as f64)).collect()
        }),
        prop::collection::vec((-1.5..1.5f64).prop_map(|log| 10f64.powf(log)), cells),
    ]
}

fn side_condition() -> impl Strategy<Value = SideCondition> {
    prop_oneof![Just(SideCondition::Plus), Just(SideCondition::Minus)]
}

fn multiquadric() -> impl Strategy<Value = Kernel> {
    (prop::sample::select(vec![0.5, 0.98, 1.03, 1.98, 2.03]), 0.5..20.0f64)
        .prop_map(|(q, shape)| Kernel::Multiquadric { q, shape })
}

fn rpim(nodes: Vec<f64>, kernel: Kernel, side_condition: SideCondition, neighbours: usize) -> Discretization {
    Discretization::Rpim {
        nodes: Nodes::Given(nodes),
        kernel,
        polynomial_terms: 2,
        side_condition,
        neighbours,
    }
}

/// Largest defect of Σ N_j u_j against a polynomial's derivative, over all points and orders of a
/// table, relative to the sum of absolute terms or, where all terms vanish, to the size of the
/// derivative that a cell could resolve.
fn reproduction(basis: &Basis, table: &BasisTable, polynomial: impl Fn(f64, usize) -> f64) -> f64 {
    let mut worst = 0.0f64;
    for (index, cell) in table.cells.iter().enumerate() {
        let (_, rows) = table.block(*cell);
        let points = &table.s[index * table.points_per_cell..(index + 1) * table.points_per_cell];
        for (rows, s) in rows.chunks_exact(table.row_stride()).zip(points) {
            for (row, &order) in rows.chunks_exact(table.width).zip(&table.orders) {
                let (mut sum, mut size) = (-polynomial(*s, order), polynomial(*s, order).abs());
                for (j, entry) in row.iter().enumerate() {
                    let coefficient = cell.first as usize + j;
                    let term = entry * polynomial(basis.nodes()[coefficient / 2], coefficient % 2);
                    sum += term;
                    size += term.abs();
                }
                if size > 0.0 {
                    worst = worst.max((sum / size).abs());
                }
            }
        }
    }
    worst
}

proptest! {
    #![proptest_config(super::cases(48))]

    #[test]
    fn rpim_reproduces_straight_lines_on_any_mesh(
        spacings in spacings(), log_length in -6.0..6.0f64, kernel in multiquadric(),
        side in side_condition(), neighbours in 0..5usize,
    ) {
        let length = 10f64.powf(log_length);
        let nodes = nodes_from(&spacings, length);
        let basis = match Basis::new(&rpim(nodes, kernel, side, neighbours), length) {
            Ok(basis) => basis,
            // Lines are reproduced there, too, but round-off is amplified.
            Err(BasisError::NodesTooClose { spacing, beside, .. }) if spacing < 0.3 * beside => return Ok(()),
            Err(refusal) => return Err(TestCaseError::fail(refusal.to_string())),
        };
        let defects = basis.defects();
        prop_assert!(defects.kronecker < PROMISED, "{defects:?}");
        prop_assert!(defects.reproduction < PROMISED, "{defects:?}");
        prop_assert!(defects.estimated_error > 0.0 && defects.estimated_error < PROMISED, "{defects:?}");
        let table = basis.table(Quadrature::Gauss(2), &[0, 1, 2]).unwrap();
        let one = reproduction(&basis, &table, |_, order| if order == 0 { 1.0 } else { 0.0 });
        // Centred in the beam, so that the round-off of far nodes is not taken for a defect.
        let line = reproduction(&basis, &table, |s, order| match order {
            0 => s,
            1 => 1.0,
            _ => 0.0,
        });
        prop_assert!(one < PROMISED, "partition of unity: {one:e}");
        prop_assert!(line < PROMISED, "linear reproduction: {line:e}");
        prop_assert!((table.weights.iter().sum::<f64>() - length).abs() < 1e-12 * length || table.blocks() < table.cells.len());
    }

    #[test]
    fn ancf_reproduces_cubics_on_any_mesh(spacings in spacings(), log_length in -6.0..6.0f64, c in prop::array::uniform4(-1.0..1.0f64)) {
        let length = 10f64.powf(log_length);
        let nodes = Nodes::Given(nodes_from(&spacings, length));
        let basis = Basis::new(&Discretization::Ancf { nodes }, length).unwrap();
        let table = basis.table(Quadrature::Lobatto(4), &[0, 1, 2]).unwrap();
        let defect = reproduction(&basis, &table, |s, order| {
            let x = s / length;
            let value = match order {
                0 => c[0] + x * (c[1] + x * (c[2] + x * c[3])),
                1 => c[1] + x * (2.0 * c[2] + x * 3.0 * c[3]),
                _ => 2.0 * c[2] + x * 6.0 * c[3],
            };
            value / length.powi(order as i32)
        });
        prop_assert!(defect < PROMISED, "{defect:e}");
    }
}

proptest! {
    #![proptest_config(super::cases(12))]

    /// ∫ N_j⁽ᵈ⁺¹⁾ ds over a cell is the difference of N_j⁽ᵈ⁾ between its ends, which is a
    /// difference of Kronecker deltas: ties values, first and second derivatives at interior points
    /// to what defines the functions, for all of them at once.
    #[test]
    fn derivatives_integrate_to_kronecker_deltas(
        spacings in prop::collection::vec(0.4..1.6f64, 1..7), kernel in multiquadric(), side in side_condition(),
        neighbours in 0..4usize, pick in any::<prop::sample::Index>(),
    ) {
        let length = spacings.iter().sum();
        let nodes = nodes_from(&spacings, length);
        let basis = Basis::new(&rpim(nodes.clone(), kernel, side, neighbours), length).unwrap();
        let cell = pick.index(spacings.len());
        let (left, right) = (nodes[cell], nodes[cell + 1]);
        // Panels narrower than the distance of the kernel's singularities from the real axis.
        let (xi, weights) = Quadrature::Gauss(12).rule().unwrap();
        let panels = 4;
        let h = (right - left) / panels as f64;
        let s: Vec<f64> = (0..panels).flat_map(|p| xi.iter().map(move |xi| left + h * (p as f64 + xi))).collect();
        let inner = basis.points(&s, &[1, 2]).unwrap();
        let ends = basis.points(&[left, right], &[0, 1]).unwrap();
        for order in 0..2 {
            let mut integral = vec![0.0; basis.coefficients()];
            let mut size = vec![0.0f64; basis.coefficients()];
            for (point, at) in inner.cells.iter().enumerate() {
                let (_, rows) = inner.block(*at);
                for (j, entry) in rows[order * inner.width..(order + 1) * inner.width].iter().enumerate() {
                    integral[at.first as usize + j] += h * weights[point % xi.len()] * entry;
                    size[at.first as usize + j] += h * weights[point % xi.len()] * entry.abs();
                }
            }
            for (sign, at) in [(-1.0, ends.cells[0]), (1.0, ends.cells[1])] {
                let (_, rows) = ends.block(at);
                for (j, entry) in rows[order * ends.width..(order + 1) * ends.width].iter().enumerate() {
                    integral[at.first as usize + j] -= sign * entry;
                }
            }
            let largest = size.iter().copied().fold(0.0, f64::max);
            for (defect, size) in integral.iter().zip(&size) {
                prop_assert!(defect.abs() < PROMISED * size.max(1e-3 * largest), "order {order}: {defect:e} of {size:e}");
            }
        }
    }

    /// The same beam in another unit: rows of order d scale with length^−d, those of slopes with
    /// one power more.
    #[test]
    fn rows_do_not_depend_on_the_unit_of_length(
        spacings in prop::collection::vec(0.1..1.0f64, 1..6), kernel in multiquadric(), side in side_condition(),
        neighbours in 0..3usize, unit in prop::sample::select(vec![1e-3, 1e3, 0.0254, 1e6]),
    ) {
        let length: f64 = spacings.iter().sum();
        let build = |unit: f64| {
            let nodes = nodes_from(&spacings, length).iter().map(|s| s * unit).collect();
            Basis::new(&rpim(nodes, kernel, side, neighbours), length * unit).unwrap()
                .table(Quadrature::Gauss(3), &[0, 1, 2]).unwrap()
        };
        let (here, there) = (build(1.0), build(unit));
        for (a, b) in here.rows.chunks_exact(here.row_stride()).zip(there.rows.chunks_exact(here.row_stride())) {
            for order in 0..3 {
                let rows = order * here.width..(order + 1) * here.width;
                let scale = a[rows.clone()].iter().copied().map(f64::abs).fold(0.0, f64::max);
                for (j, (a, b)) in a[rows.clone()].iter().zip(&b[rows]).enumerate() {
                    let b = b * unit.powi(order as i32 - (j % 2) as i32);
                    // Node positions in another unit are rounded differently.
                    prop_assert!((a - b).abs() < 1e-10 * scale, "order {order}, function {j}: {a:e} and {b:e}");
                }
            }
        }
    }

    #[test]
    fn every_kernel_keeps_its_promises(
        spacings in prop::collection::vec(0.4..1.6f64, 1..9), side in side_condition(), neighbours in 0..4usize,
        terms in 2..5usize,
        kernel in prop_oneof![
            (0.01..2.0f64).prop_map(|shape| Kernel::Exponential { shape }),
            (3.1..7.0f64).prop_map(|exponent| Kernel::ThinPlateSpline { exponent }),
            prop::sample::select(vec![4.0, 5.0, 6.0, 7.0]).prop_map(|exponent| Kernel::ThinPlateSpline { exponent }),
            (4.5..20.0f64).prop_map(|radius| Kernel::Wendland { radius }),
            (-1.5..-0.1f64, 0.5..5.0f64).prop_map(|(q, shape)| Kernel::Multiquadric { q, shape }),
        ],
    ) {
        let length = spacings.iter().sum();
        let nodes = Nodes::Given(nodes_from(&spacings, length));
        let discretization =
            Discretization::Rpim { nodes, kernel, polynomial_terms: terms, side_condition: side, neighbours };
        match Basis::new(&discretization, length) {
            Ok(basis) => {
                let defects = basis.defects();
                prop_assert!(defects.kronecker.max(defects.reproduction).max(defects.estimated_error) < PROMISED, "{defects:?}");
            }
            Err(refusal) => return Err(TestCaseError::fail(refusal.to_string())),
        }
    }
}

#[test]
fn even_meshes_share_a_handful_of_blocks() {
    let paper = |nodes| Discretization::Rpim {
        nodes: Nodes::Uniform(nodes),
        kernel: Kernel::Multiquadric { q: 1.03, shape: 3.3 },
        polynomial_terms: 2,
        side_condition: SideCondition::Plus,
        neighbours: 2,
    };
    for length in [1e-6, 1.8, 1e6] {
        let basis = Basis::new(&paper(100_000), length).unwrap();
        assert_eq!(basis.defects().distinct_cells, 5, "two at each end and all others");
        let table = basis.table(Quadrature::Gauss(5), &[1, 2]).unwrap();
        assert_eq!((table.blocks(), table.cells.len(), table.width), (5, 99_999, 12));
        let largest = table.cells.iter().map(|cell| cell.first as usize + table.width).max();
        assert_eq!(largest, Some(basis.coefficients()));
    }
}

#[test]
fn ends_are_padded_to_the_common_width() {
    let discretization =
        rpim(vec![0.0, 0.2, 0.7, 1.0], Kernel::Multiquadric { q: 1.03, shape: 3.3 }, SideCondition::Plus, 2);
    let basis = Basis::new(&discretization, 1.0).unwrap();
    assert_eq!((basis.width(), basis.coefficients()), (8, 8));
    let basis = Basis::new(
        &rpim(
            (0..9).map(|i| i as f64 / 8.0).collect(),
            Kernel::Exponential { shape: 0.3 },
            SideCondition::Minus,
            1,
        ),
        1.0,
    )
    .unwrap();
    let table = basis.table(Quadrature::Gauss(1), &[0]).unwrap();
    let firsts: Vec<u32> = table.cells.iter().map(|cell| cell.first).collect();
    assert_eq!(firsts, [0, 0, 2, 4, 6, 8, 10, 10]);
    let (_, first) = table.block(table.cells[0]);
    let (_, last) = table.block(table.cells[7]);
    assert!(first[6..].iter().all(|&entry| entry == 0.0) && first[..6].iter().all(|&entry| entry != 0.0));
    assert!(last[..2].iter().all(|&entry| entry == 0.0) && last[2..].iter().all(|&entry| entry != 0.0));
}

#[test]
fn rows_at_nodes_are_exact() {
    let nodes = vec![0.0, 0.1, 0.3, 0.65, 0.9, 1.3];
    for discretization in [
        Discretization::Ancf { nodes: Nodes::Given(nodes.clone()) },
        rpim(nodes.clone(), Kernel::Multiquadric { q: 0.98, shape: 6.0 }, SideCondition::Plus, 2),
    ] {
        let basis = Basis::new(&discretization, 1.3).unwrap();
        let table = basis.points(&nodes, &[0, 1]).unwrap();
        for (node, cell) in table.cells.iter().enumerate() {
            let (weights, rows) = table.block(*cell);
            assert_eq!(weights, [1.0]);
            for (order, row) in rows.chunks_exact(table.width).enumerate() {
                for (j, &entry) in row.iter().enumerate() {
                    let own = cell.first as usize + j == 2 * node + order;
                    assert_eq!(entry, if own { 1.0 } else { 0.0 });
                }
            }
            assert_eq!(basis.node_at(nodes[node] * (1.0 + f64::EPSILON)), Some(node));
        }
        assert_eq!(basis.node_at(0.2), None);
        for s in [-1e-9, 1.3 + 1e-9, f64::NAN, f64::INFINITY] {
            assert!(matches!(basis.points(&[s], &[0]), Err(BasisError::OffBeam { .. })));
        }
        assert!(matches!(basis.points(&[0.2], &[3]), Err(BasisError::Order { order: 3 })));
    }
}

#[test]
fn hopeless_choices_are_refused_with_their_reason() {
    let with = |kernel, polynomial_terms, neighbours| {
        let nodes = Nodes::Uniform(9);
        Basis::new(
            &Discretization::Rpim {
                nodes,
                kernel,
                polynomial_terms,
                side_condition: SideCondition::Plus,
                neighbours,
            },
            1.0,
        )
    };
    let good = Kernel::Multiquadric { q: 1.03, shape: 3.3 };
    assert!(matches!(with(good, 0, 2), Err(BasisError::PolynomialTerms { found: 0, .. })));
    assert!(matches!(with(good, 9, 2), Err(BasisError::PolynomialTerms { found: 9, limit: 8 })));
    assert!(with(good, 2, usize::MAX).is_ok(), "all nodes in every support");
    for (kernel, parameter) in [
        (Kernel::Multiquadric { q: 2.0, shape: 3.3 }, "q"),
        (Kernel::Multiquadric { q: 1.03, shape: f64::NAN }, "shape"),
        (Kernel::ThinPlateSpline { exponent: 3.0 }, "exponent"),
        (Kernel::Wendland { radius: 0.5 }, "radius"),
        // Just not beyond the next node.
        (Kernel::Wendland { radius: 1.0 }, "radius"),
    ] {
        match with(kernel, 2, 2) {
            Err(BasisError::KernelParameter { parameter: found, .. }) => assert_eq!(found, parameter),
            other => panic!("{kernel:?}: {other:?}"),
        }
    }
}

/// What decides is the widest support, which stands in the middle of the beam, and not those
/// clipped at its ends.
#[test]
fn a_support_that_is_too_wide_is_refused_wherever_it_stands() {
    let nodes: Vec<f64> = (0..81).map(f64::from).collect();
    let kernel = Kernel::Multiquadric { q: 1.03, shape: 3.3 };
    let found = Basis::new(&rpim(nodes, kernel, SideCondition::Plus, 32), 80.0);
    assert!(
        matches!(found, Err(BasisError::SupportTooWide { nodes: 66, .. })),
        "{:?}",
        found.map(|basis| basis.width())
    );
}

/// cond(G) is about 1e5 for a shape of 1 and 1e10 for 4, of a support of six nodes.
#[test]
fn the_condition_number_is_told() {
    let condition = |shape| {
        let nodes: Vec<f64> = (0..9).map(f64::from).collect();
        let kernel = Kernel::Multiquadric { q: 1.03, shape };
        let basis = Basis::new(&rpim(nodes, kernel, SideCondition::Plus, 2), 8.0).expect("a basis");
        basis.defects().condition_log10
    };
    let (one, four) = (condition(1.0), condition(4.0));
    assert!((3.5..7.5).contains(&one), "shape 1: {one}");
    assert!((8.5..13.5).contains(&four), "shape 4: {four}");
}

/// Powers of two are exact: whatever is measured in units of a function's own scale is the same to
/// the last bit on any of them.
#[test]
fn quality_does_not_depend_on_the_unit_of_length() {
    let of = |nodes: Nodes, kernel: Kernel, length: f64| {
        let basis = Discretization::Rpim {
            nodes,
            kernel,
            polynomial_terms: 2,
            side_condition: SideCondition::Plus,
            neighbours: 2,
        };
        Basis::new(&basis, length).expect("a basis").defects()
    };
    let kernel = Kernel::Multiquadric { q: 1.03, shape: 4.0 };
    for nodes in [Nodes::Uniform(9), Nodes::Chebyshev(7)] {
        let [one, small, large] = [0, -20, 10].map(|power| of(nodes.clone(), kernel, 2f64.powi(power)));
        assert!(one.reproduction > 0.0 && one.kronecker > 0.0, "{one:?}");
        assert_eq!(one, small);
        assert_eq!(one, large);
    }
}
