//! The interpolation of exact nodal values by a discretisation, without any equilibrium.
//!
//! Every node is given the exact position and gradient of the beam's centreline; between the nodes
//! the shape functions decide. The strain that appears there is wrong throughout ("pseudo-strain"),
//! since the exact curve has none.

use ancf::basis::{Basis, BasisTable, Quadrature};
use ancf::centreline::Curve;
use ancf::model::{Along, Beam, StrainMeasure};

/// Even places at which the curve is recorded, ends included.
const PLACES: usize = 201;

/// An interpolated centreline.
#[derive(Clone, Debug)]
pub struct Interpolation {
    /// ½∫ EA ε² ds by the beam's own quadrature \[J\]; ε of the interpolated curve. None without
    /// EA.
    pub stretch: Option<f64>,
    /// ½∫ EI κ² ds by the beam's own quadrature \[J\]. None without EI.
    pub bend: Option<f64>,
    /// Largest distance of the recorded points from the exact curve \[m\].
    pub distance: f64,
    /// Arc lengths \[m\].
    pub s: Vec<f64>,
    /// Positions along x \[m\].
    pub x: Vec<f64>,
    /// Positions along y \[m\].
    pub y: Vec<f64>,
    /// ε.
    pub strain: Vec<f64>,
    /// κ \[1/m\].
    pub curvature: Vec<f64>,
}

/// ε and κ from r' and r''.
fn strain_and_curvature(measure: StrainMeasure, d: [f64; 2], dd: [f64; 2]) -> (f64, f64) {
    let square = d[0] * d[0] + d[1] * d[1];
    let strain = match measure {
        StrainMeasure::Green => 0.5 * (square - 1.0),
        StrainMeasure::Engineering => square.sqrt() - 1.0,
    };
    (strain, (d[0] * dd[1] - d[1] * dd[0]) / square)
}

/// Interpolates the stress-free centreline of a beam.
///
/// # Errors
/// A centreline or nodes that cannot be used.
pub fn interpolate(beam: &Beam) -> Result<Interpolation, String> {
    let exact = Curve::new(&beam.centreline).map_err(|e| e.to_string())?;
    let basis = Basis::new(&beam.discretization, exact.length()).map_err(|e| e.to_string())?;
    let coefficients: Vec<[f64; 2]> =
        basis.nodes().iter().flat_map(|&s| [exact.position(s), exact.tangent(s)]).collect();

    let energy = |stiffness: &Option<Along>, points: usize, density: &dyn Fn(f64, f64) -> f64| match stiffness
    {
        None => Ok(None),
        Some(stiffness) => {
            let table = basis.table(Quadrature::Gauss(points), &[1, 2]).map_err(|e| e.to_string())?;
            let (mut sum, mut places) = (0.0, table.s.iter());
            each_point(&table, &coefficients, |weight, r| {
                let (strain, curvature) = strain_and_curvature(beam.strain, r[0], r[1]);
                let stiffness = places.next().map_or(f64::NAN, |s| stiffness.at(*s, *s));
                sum += weight * stiffness * density(strain, curvature);
            });
            Ok::<_, String>(Some(0.5 * sum))
        }
    };
    let section = &beam.section;
    let stretch = energy(&section.axial_stiffness, beam.gauss_points.stretch, &|strain, _| strain * strain)?;
    let bend =
        energy(&section.bending_stiffness, beam.gauss_points.bend, &|_, curvature| curvature * curvature)?;

    let s: Vec<f64> = (0..PLACES).map(|i| exact.length() * i as f64 / (PLACES - 1) as f64).collect();
    let table = basis.points(&s, &[0, 1, 2]).map_err(|e| e.to_string())?;
    let mut result = Interpolation {
        stretch,
        bend,
        distance: 0.0,
        s,
        x: Vec::with_capacity(PLACES),
        y: Vec::with_capacity(PLACES),
        strain: Vec::with_capacity(PLACES),
        curvature: Vec::with_capacity(PLACES),
    };
    each_point(&table, &coefficients, |_, r| {
        let (strain, curvature) = strain_and_curvature(beam.strain, r[1], r[2]);
        result.x.push(r[0][0]);
        result.y.push(r[0][1]);
        result.strain.push(strain);
        result.curvature.push(curvature);
    });
    for ((&s, &x), &y) in result.s.iter().zip(&result.x).zip(&result.y) {
        result.distance = result.distance.max(distance(&exact, [x, y], s));
    }
    Ok(result)
}

/// Distance of a point from a curve, near s: Newton's method for the foot of the perpendicular.
fn distance(curve: &Curve, point: [f64; 2], mut s: f64) -> f64 {
    let off = |s: f64| {
        let r = curve.position(s);
        [point[0] - r[0], point[1] - r[1]]
    };
    for _ in 0..20 {
        let (d, t) = (off(s), curve.tangent(s));
        let along = d[0] * t[0] + d[1] * t[1];
        let across = t[0] * d[1] - t[1] * d[0];
        s = (s + along / (1.0 - curve.curvature(s) * across)).clamp(0.0, curve.length());
    }
    let d = off(s);
    d[0].hypot(d[1])
}

/// Calls `visit` with the weight and the wanted derivatives of r at every point of the table.
fn each_point(table: &BasisTable, coefficients: &[[f64; 2]], mut visit: impl FnMut(f64, &[[f64; 2]])) {
    let mut r = vec![[0.0; 2]; table.orders.len()];
    for &cell in &table.cells {
        let (weights, rows) = table.block(cell);
        let local = &coefficients[cell.first as usize..][..table.width];
        for (weight, rows) in weights.iter().zip(rows.chunks_exact(table.row_stride())) {
            for (r, row) in r.iter_mut().zip(rows.chunks_exact(table.width)) {
                *r = row.iter().zip(local).fold([0.0; 2], |r, (n, c)| [r[0] + n * c[0], r[1] + n * c[1]]);
            }
            visit(*weight, &r);
        }
    }
}
