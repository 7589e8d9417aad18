//! Gauss–Legendre rules on (0, 1): abscissae in ascending order, and weights that sum to one.
//!
//! The numbers are rounded from sixty digits. [`crate::basis::Quadrature`] computes rules with any
//! number of points.

/// Two points, exact up to degree 3.
pub const GAUSS_2: [(f64, f64); 2] = [(0.211_324_865_405_187_1, 0.5), (0.788_675_134_594_812_9, 0.5)];

/// Three points, exact up to degree 5.
pub const GAUSS_3: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 0.277_777_777_777_777_8),
    (0.5, 0.444_444_444_444_444_4),
    (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
];

/// Six points, exact up to degree 11.
pub const GAUSS_6: [(f64, f64); 6] = [
    (0.033_765_242_898_423_99, 0.085_662_246_189_585_18),
    (0.169_395_306_766_867_73, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_56, 0.233_956_967_286_345_52),
    (0.619_309_593_041_598_5, 0.233_956_967_286_345_52),
    (0.830_604_693_233_132_2, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_18),
];

/// Ten points, exact up to degree 19.
pub const GAUSS_10: [(f64, f64); 10] = [
    (0.013_046_735_741_414_14, 0.033_335_672_154_344_07),
    (0.067_468_316_655_507_75, 0.074_725_674_575_290_3),
    (0.160_295_215_850_487_8, 0.109_543_181_257_991_02),
    (0.283_302_302_935_376_4, 0.134_633_359_654_998_17),
    (0.425_562_830_509_184_4, 0.147_762_112_357_376_44),
    (0.574_437_169_490_815_6, 0.147_762_112_357_376_44),
    (0.716_697_697_064_623_6, 0.134_633_359_654_998_17),
    (0.839_704_784_149_512_2, 0.109_543_181_257_991_02),
    (0.932_531_683_344_492_2, 0.074_725_674_575_290_3),
    (0.986_953_264_258_585_9, 0.033_335_672_154_344_07),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// A rule of n points integrates x^k exactly, to 1/(k + 1), up to k = 2n − 1 and no further.
    fn is_exact(rule: &[(f64, f64)]) {
        let error = |degree: usize| {
            let sum: f64 = rule.iter().map(|(x, weight)| weight * x.powi(degree as i32)).sum();
            (sum - 1.0 / (degree + 1) as f64).abs()
        };
        let degree = 2 * rule.len() - 1;
        assert!((0..=degree).all(|k| error(k) < 4e-16), "{} points", rule.len());
        // The error of n points for x^(2n) is (n!)⁴/((2n + 1) ((2n)!)²).
        let missing =
            (1..=rule.len()).fold(1.0, |e, n| e * (n * n) as f64 / (2 * n * (2 * n - 1)) as f64).powi(2)
                / (degree + 2) as f64;
        assert!((error(degree + 1) / missing - 1.0).abs() < 1e-3 || missing < 1e-12, "{} points", rule.len());
    }

    #[test]
    fn rules_are_exact_as_far_as_they_can_be() {
        is_exact(&GAUSS_2);
        is_exact(&GAUSS_3);
        is_exact(&GAUSS_6);
        is_exact(&GAUSS_10);
    }
}
