//! Radial functions R(d) and their first three derivatives, d in units of the average spacing of
//! the nodes.

use super::Kernel;

use super::arithmetic::Arithmetic;
use super::error::BasisError;

/// Name of a kernel in messages.
pub fn name(kernel: &Kernel) -> &'static str {
    match kernel {
        Kernel::Multiquadric { .. } => "multiquadric",
        Kernel::Exponential { .. } => "exponential",
        Kernel::ThinPlateSpline { .. } => "thin plate spline",
        Kernel::Wendland { .. } => "Wendland",
    }
}

/// Kernel and parameters in messages.
pub fn describe(kernel: &Kernel) -> String {
    let name = name(kernel);
    match kernel {
        Kernel::Multiquadric { q, shape } => format!("{name} with q = {q:?}, shape = {shape:?}"),
        Kernel::Exponential { shape } => format!("{name} with shape = {shape:?}"),
        Kernel::ThinPlateSpline { exponent } => format!("{name} with exponent = {exponent:?}"),
        Kernel::Wendland { radius } => format!("{name} with radius = {radius:?}"),
    }
}

/// Refuses parameters for which every moment matrix is singular or the third derivative does not
/// exist. `widest_cell` is the largest spacing of the nodes in units of the average one.
pub fn check(kernel: &Kernel, widest_cell: f64) -> Result<(), BasisError> {
    let fault = |parameter, value, problem: String| {
        Err(BasisError::KernelParameter { kernel: name(kernel), parameter, value, problem })
    };
    let positive = |parameter, value: f64| {
        if value > 0.0 && value.is_finite() {
            Ok(())
        } else {
            fault(parameter, value, "expected a positive, finite number".to_owned())
        }
    };
    match *kernel {
        Kernel::Multiquadric { q, shape } => {
            positive("shape", shape)?;
            if !(-64.0..=64.0).contains(&q) {
                return fault("q", q, "expected a number between -64 and 64".to_owned());
            }
            if q >= 0.0 && q.fract() == 0.0 {
                let problem = format!(
                    "a whole power of d² + α² is a polynomial, so the moment matrix is singular for every mesh; try {}",
                    if q == 0.0 { 0.5 } else { q + 0.03 }
                );
                return fault("q", q, problem);
            }
            Ok(())
        }
        Kernel::Exponential { shape } => positive("shape", shape),
        Kernel::ThinPlateSpline { exponent } => {
            if exponent > 3.0 && exponent <= 64.0 {
                Ok(())
            } else {
                let problem =
                    "expected a number above 3, so that three derivatives exist, and at most 64; try 5";
                fault("exponent", exponent, problem.to_owned())
            }
        }
        Kernel::Wendland { radius } => {
            positive("radius", radius)?;
            if radius > widest_cell {
                return Ok(());
            }
            let problem = format!(
                "no larger than the widest cell, {widest_cell:.4} average spacings, so that no radial function of a node \
                 reaches the next; try {:.1}",
                (3.0 * widest_cell).ceil()
            );
            fault("radius", radius, problem)
        }
    }
}

/// A kernel with its parameters in the numbers of one precision.
pub struct Radial<'a, A: Arithmetic> {
    arithmetic: &'a A,
    kernel: Kernel,
    /// α² for the multiquadric.
    square: A::Number,
    zero: A::Number,
}

impl<'a, A: Arithmetic> Radial<'a, A> {
    /// The kernel for numbers of `arithmetic`.
    pub fn new(arithmetic: &'a A, kernel: Kernel) -> Self {
        let zero = arithmetic.number(0.0);
        let square = match kernel {
            Kernel::Multiquadric { shape, .. } => {
                let shape = arithmetic.number(shape);
                arithmetic.mul(&shape, &shape)
            }
            _ => zero.clone(),
        };
        Self { arithmetic, kernel, square, zero }
    }

    /// [R, R', R'', R'''] at the signed distance `d`.
    pub fn derivatives(&self, d: &A::Number) -> [A::Number; 4] {
        match self.kernel {
            Kernel::Multiquadric { q, .. } => self.multiquadric(d, q),
            Kernel::Exponential { shape } => self.exponential(d, shape),
            Kernel::ThinPlateSpline { exponent } => self.thin_plate_spline(d, exponent),
            Kernel::Wendland { radius } => self.wendland(d, radius),
        }
    }

    /// Needs only one power: with t = d² + α² and u = 1/t, R = t^q, R' = 2qd Ru,
    /// R'' = 2q Ru (1 + 2(q−1)d²u), R''' = 4q(q−1)d Ru² (3 + 2(q−2)d²u).
    fn multiquadric(&self, d: &A::Number, q: f64) -> [A::Number; 4] {
        let a = self.arithmetic;
        let n = |x| a.number(x);
        let dd = a.mul(d, d);
        let t = a.add(&dd, &self.square);
        let r = a.pow(&t, q);
        let u = a.div(&n(1.0), &t);
        let (q, q1, q2) = (n(q), a.sub(&n(q), &n(1.0)), a.sub(&n(q), &n(2.0)));
        let ru = a.mul(&a.mul(&n(2.0), &q), &a.mul(&r, &u));
        let ddu = a.mul(&n(2.0), &a.mul(&dd, &u));
        let second = a.add(&n(1.0), &a.mul(&q1, &ddu));
        let third = a.add(&n(3.0), &a.mul(&q2, &ddu));
        let ruu = a.mul(&a.mul(&n(2.0), &q1), &a.mul(&ru, &u));
        let (r1, r3) = (a.mul(&ru, d), a.mul(&a.mul(&ruu, d), &third));
        [r, r1, a.mul(&ru, &second), r3]
    }

    /// R' = −2αd R, R'' = 2α(2αd² − 1) R, R''' = 4α²d (3 − 2αd²) R.
    fn exponential(&self, d: &A::Number, shape: f64) -> [A::Number; 4] {
        let a = self.arithmetic;
        let n = |x| a.number(x);
        let double = a.mul(&n(2.0), &n(shape));
        let add = a.mul(&n(shape), &a.mul(d, d));
        let twice = a.mul(&n(2.0), &add);
        let r = a.exp(&a.sub(&self.zero, &add));
        let scaled = a.mul(&double, &r);
        let r1 = a.sub(&self.zero, &a.mul(&scaled, d));
        let r2 = a.mul(&scaled, &a.sub(&twice, &n(1.0)));
        let r3 = a.mul(&a.mul(&a.mul(&double, &scaled), d), &a.sub(&n(3.0), &twice));
        [r, r1, r2, r3]
    }

    /// R = |d|^η, times ln|d| where η is an even whole number. R and its derivatives vanish at
    /// d = 0.
    fn thin_plate_spline(&self, d: &A::Number, eta: f64) -> [A::Number; 4] {
        let a = self.arithmetic;
        let n = |x| a.number(x);
        if a.is_zero(d) {
            return std::array::from_fn(|_| self.zero.clone());
        }
        let negative = a.nearest(d) < 0.0;
        let magnitude = if negative { a.sub(&self.zero, d) } else { d.clone() };
        let logarithm = a.ln(&magnitude);
        let power = a.exp(&a.mul(&n(eta), &logarithm));
        let even = eta % 2.0 == 0.0;
        // With l = ln|d|, the k-th derivative of d^η (b l + c) is d^(η−k) (b_k l + c_k). Each
        // derivative changes b to b e and c to c e + b, where e is the exponent before it. Without
        // the logarithm b = 0, so one recurrence serves both cases.
        let (mut b, mut c) = if even { (n(1.0), n(0.0)) } else { (n(0.0), n(1.0)) };
        let mut scale = power;
        let mut exponent = n(eta);
        std::array::from_fn(|_| {
            let value = a.mul(&scale, &a.add(&a.mul(&b, &logarithm), &c));
            c = a.add(&a.mul(&c, &exponent), &b);
            b = a.mul(&b, &exponent);
            exponent = a.sub(&exponent, &n(1.0));
            scale = a.div(&scale, d);
            value
        })
    }

    /// With r = |d|/δ: R = (1−r)⁸(32r³ + 25r² + 8r + 1), R' = −22 r(1−r)⁷(16r² + 7r + 1)/δ,
    /// R'' = 22 (1−r)⁶(160r³ + 15r² − 6r − 1)/δ², R''' = 1584 r(1−r)⁵(1 + 5r − 20r²)/δ³.
    fn wendland(&self, d: &A::Number, radius: f64) -> [A::Number; 4] {
        let a = self.arithmetic;
        let n = |x| a.number(x);
        let sign = if a.nearest(d) < 0.0 { -1.0 } else { 1.0 };
        let inverse = a.div(&n(1.0), &n(radius));
        let r = a.mul(&a.mul(d, &n(sign)), &inverse);
        let rest = a.sub(&n(1.0), &r);
        if a.nearest(&rest) <= 0.0 {
            return std::array::from_fn(|_| self.zero.clone());
        }
        let polynomial = |coefficients: [f64; 4]| {
            let horner = |sum, c: &f64| a.add(&a.mul(&sum, &r), &n(*c));
            coefficients.iter().fold(self.zero.clone(), horner)
        };
        let square = a.mul(&rest, &rest);
        let fifth = a.mul(&a.mul(&square, &square), &rest);
        let sixth = a.mul(&fifth, &rest);
        let seventh = a.mul(&sixth, &rest);
        let eighth = a.mul(&seventh, &rest);
        let odd = a.mul(&inverse, &n(sign));
        let squared = a.mul(&inverse, &inverse);
        [
            a.mul(&eighth, &polynomial([32.0, 25.0, 8.0, 1.0])),
            a.mul(&a.mul(&seventh, &odd), &polynomial([-352.0, -154.0, -22.0, 0.0])),
            a.mul(&a.mul(&sixth, &squared), &polynomial([3520.0, 330.0, -132.0, -22.0])),
            a.mul(&a.mul(&fifth, &a.mul(&odd, &squared)), &polynomial([-31680.0, 7920.0, 1584.0, 0.0])),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::multiprecision::Multiprecision;
    use super::*;

    const KERNELS: [Kernel; 9] = [
        Kernel::Multiquadric { q: 1.03, shape: 3.3 },
        Kernel::Multiquadric { q: -0.5, shape: 0.7 },
        Kernel::Multiquadric { q: 2.03, shape: 20.0 },
        Kernel::Exponential { shape: 0.4 },
        Kernel::ThinPlateSpline { exponent: 4.0 },
        Kernel::ThinPlateSpline { exponent: 5.0 },
        Kernel::ThinPlateSpline { exponent: 4.5 },
        Kernel::ThinPlateSpline { exponent: 6.0 },
        Kernel::Wendland { radius: 3.7 },
    ];

    /// Central differences with 320 bits: the step 2⁻⁸⁰ leaves an error of about 1e-48.
    #[test]
    fn each_derivative_is_that_of_the_one_before() {
        let a = Multiprecision::new(320).unwrap();
        let step = a.number(2f64.powi(-80));
        for kernel in KERNELS {
            let radial = Radial::new(&a, kernel);
            for d in [-3.1, -1.0, -0.2, 0.3, 1.0, 2.9, 4.5] {
                let d = a.number(d);
                let exact = radial.derivatives(&d);
                let ahead = radial.derivatives(&a.add(&d, &step));
                let behind = radial.derivatives(&a.sub(&d, &step));
                for k in 0..3 {
                    let slope = a.div(&a.sub(&ahead[k], &behind[k]), &a.mul(&a.number(2.0), &step));
                    let error = a.nearest(&a.sub(&slope, &exact[k + 1])).abs();
                    let size = a.nearest(&exact[k + 1]).abs().max(1e-20);
                    assert!(error <= 1e-30 * size, "{kernel:?}, order {}: {error:e} of {size:e}", k + 1);
                }
            }
        }
    }

    #[test]
    fn values_follow_the_definitions() {
        let a = super::super::double_double::DoubleDouble;
        let value = |kernel, d: f64| a.nearest(&Radial::new(&a, kernel).derivatives(&a.number(d))[0]);
        let d: f64 = -1.3;
        let r = d.abs() / 3.7;
        for (kernel, expected) in [
            (KERNELS[0], (d * d + 3.3 * 3.3).powf(1.03)),
            (KERNELS[3], (-0.4 * d * d).exp()),
            (KERNELS[4], d.powi(4) * d.abs().ln()),
            (KERNELS[6], d.abs().powf(4.5)),
            (KERNELS[8], (1.0 - r).powi(8) * (32.0 * r.powi(3) + 25.0 * r * r + 8.0 * r + 1.0)),
        ] {
            assert!((value(kernel, d) - expected).abs() < 1e-14 * expected.abs(), "{kernel:?}");
        }
    }

    #[test]
    fn hopeless_parameters_are_refused_by_name() {
        let parameter = |kernel| match check(&kernel, 1.0) {
            Err(BasisError::KernelParameter { parameter, .. }) => parameter,
            other => panic!("{kernel:?}: {other:?}"),
        };
        for q in [0.0, 1.0, 2.0, f64::NAN, f64::INFINITY] {
            assert_eq!(parameter(Kernel::Multiquadric { q, shape: 1.0 }), "q");
        }
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(parameter(Kernel::Multiquadric { q: 1.03, shape: bad }), "shape");
            assert_eq!(parameter(Kernel::Exponential { shape: bad }), "shape");
            assert_eq!(parameter(Kernel::ThinPlateSpline { exponent: bad }), "exponent");
            assert_eq!(parameter(Kernel::Wendland { radius: bad }), "radius");
        }
        for q in [64.5, -64.5] {
            assert_eq!(parameter(Kernel::Multiquadric { q, shape: 1.0 }), "q");
        }
        for exponent in [3.0, 64.5] {
            assert_eq!(parameter(Kernel::ThinPlateSpline { exponent }), "exponent");
        }
        let limits =
            [Kernel::Multiquadric { q: -64.0, shape: 1.0 }, Kernel::ThinPlateSpline { exponent: 64.0 }];
        assert!(limits.iter().all(|kernel| check(kernel, 1.0).is_ok()));
        assert_eq!(parameter(Kernel::Wendland { radius: 0.9 }), "radius");
        assert_eq!(parameter(Kernel::Wendland { radius: 1.0 }), "radius");
        // What is proposed is legal.
        for (kernel, widest, proposal) in [
            (Kernel::Multiquadric { q: 2.0, shape: 1.0 }, 1.0, "try 2.03"),
            (Kernel::Multiquadric { q: 0.0, shape: 1.0 }, 1.0, "try 0.5"),
            (Kernel::Wendland { radius: 1.0 }, 1.5, "try 5.0"),
        ] {
            let told = check(&kernel, widest).unwrap_err().to_string();
            assert!(told.ends_with(proposal), "{told}");
        }
        assert!(KERNELS.iter().all(|kernel| check(kernel, 1.0).is_ok()));
    }
}
