//! The pull of a tendon that runs along a beam.

use super::{Engineering, PreStrain, Strain, bend};
use crate::assembly::{
    Assembly, BuildError, CompiledFor, Density, Extent, Gradient, Hessian, Kind, Part, TendonPath,
    edges_along,
};
use crate::beam::{Along, Place};
use crate::lanes;
use crate::law::Law;
use nalgebra::Vector2;
use std::sync::Arc;

/// A tendon without friction in its sheath, which runs beside the centreline of a beam and is pulled
/// with a given tension.
///
/// Its tension is the same everywhere, so that it has the potential W = T ∫ |p'| ds with the line p
/// of [`TendonPath`]. This contains the forces on the sections at which it ends, and those that
/// press it against its sheath where it is bent. A tendon of given length has a tension that keeps its
/// length, as [`crate::assembly::HeldLength`] says.
#[derive(Clone, Debug, PartialEq)]
pub struct Tendon {
    /// Index of the beam.
    pub beam: usize,
    /// Where it runs, and its tension.
    pub path: TendonPath,
    /// For a tendon of given length: by how much it is shorter than in the stress-free state \[m\].
    pub shortening: Option<f64>,
    /// In a motion, the law of time that multiplies the tension, or the shortening; without one it
    /// acts in full from the start.
    pub law: Option<Law>,
}

impl Tendon {
    /// The same tendon, pulled with a tension \[N\] in place of its length. A law that is always one
    /// says that it has no potential, as it had none while its length was given.
    #[must_use]
    pub fn pulled_with(&self, tension: f64) -> Self {
        let path = TendonPath { tension, ..self.path.clone() };
        let law = Some(Law::Polynomial(vec![1.0]));
        Self { path, shortening: None, law, ..self.clone() }
    }

    /// Whether it is fixed at the ends of a beam of length `length` \[m\].
    fn is_whole(&self, length: f64) -> bool {
        self.path.ends == [0.0, length]
    }
}

impl Part for Tendon {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let beam = assembly.beam("a tendon", self.beam)?;
        let TendonPath { ends, offset, .. } = &self.path;
        if beam.section.bending_stiffness.is_none() && !offset.is_zero() {
            return Err(BuildError::missing(beam, "bending stiffness", "a tendon beside the centreline"));
        }
        let law = self.law.as_ref();
        let one = Along::Constant(1.0);
        let whole = self.is_whole(assembly.discretized(self.beam).basis.length());
        let acting = if whole { one } else { one.within(*ends) };
        // T ∫ |r'| ds at the points at which the beam's own axial force acts: on the centreline the tendon
        // then takes exactly from the resistance to bending what its thrust gives.
        let rule = match beam.section.axial_stiffness {
            Some(_) => beam.gauss_points.stretch_rule(),
            None => assembly.mass_rule(self.beam),
        };
        let (factor, extent) = Extent::along(self.beam, rule, &acting);
        let pull = PreStrain::<Engineering>::new(-self.path.tension * factor);
        let centreline = (extent, pull);
        // The factor has the kinks of the offset too, so that cells are divided there.
        let acting = acting.plus(&offset.times(0.0));
        let (_, extent) = Extent::along(self.beam, assembly.mass_rule(self.beam), &acting);
        let places = assembly.places(Kind::Tendon, &extent)?;
        let detour = |z: Vec<_>| Detour::new(Arc::new(self.path.clone()), &places, &z);
        match self.shortening {
            Some(shortening) => {
                assembly.hold_length((&self.path, shortening), law, centreline, (extent, detour))
            }
            None => {
                let (along, pull) = centreline;
                assembly.load(Kind::Tendon, along, law, |_| pull)?;
                assembly.load(Kind::Tendon, extent, law, detour)
            }
        }
    }

    fn fades(&self) -> bool {
        true
    }

    fn jumps(&self) -> Vec<Place> {
        let [from, to] = self.path.ends;
        let within = |at: &Place| from < at.s && at.s < to;
        let mut places = edges_along(self.beam, [&self.path.offset]);
        places.retain(within);
        places.extend(self.path.ends.iter().map(|s| Place::new(self.beam, *s)));
        places
    }

    fn tendon(&self) -> Option<(usize, &TendonPath, Option<&Law>)> {
        Some((self.beam, &self.path, self.law.as_ref()))
    }
}

/// What the way of a tendon beside the centreline adds to its potential: the density
/// W = T (|p'| − |r'|), relative to the stress-free shape.
#[derive(Clone, Debug)]
pub struct Detour {
    path: Arc<TendonPath>,
    /// e and e' at each quadrature point.
    offsets: Vec<[f64; 2]>,
    /// |p'| − |r'| of the stress-free shape at each quadrature point.
    start: Vec<f64>,
}

impl Detour {
    /// `places` holds the arc length of each quadrature point and that of the middle of its cell
    /// \[m\], `reference` (r', r'') of the stress-free shape there.
    pub fn new(path: Arc<TendonPath>, places: &[[f64; 2]], reference: &[[Vector2<f64>; 2]]) -> Self {
        let offsets: Vec<[f64; 2]> = places
            .iter()
            .map(|[s, inside]| [path.offset.at(*s, *inside), path.offset.slope(*s, *inside)])
            .collect();
        let start = offsets.iter().zip(reference).map(|(offset, z)| detour(*offset, z).0).collect();
        Self { path, offsets, start }
    }
}

/// |p'| − |r'|, and the first two derivatives of |p'| by a = |r'| − e κ.
fn detour([offset, slope]: [f64; 2], [first, second]: &Gradient<2>) -> (f64, f64, f64) {
    let bent = -offset * bend::curvature(first, second);
    if slope == 0.0 {
        return (bent, 1.0, 0.0);
    }
    let stretch = first.norm();
    let along = stretch + bent;
    let length = along.hypot(slope);
    let share = slope / length;
    (length - stretch, along / length, share * share / length)
}

impl Density<2> for Detour {
    const ORDERS: [usize; 2] = [1, 2];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn tendon(&self) -> Option<&TendonPath> {
        Some(&self.path)
    }

    fn energy(&self, point: usize, z: &Gradient<2>) -> f64 {
        self.path.tension * (detour(self.offsets[point], z).0 - self.start[point])
    }

    fn gradient(&self, point: usize, z: &Gradient<2>) -> Gradient<2> {
        let (_, by_a, _) = detour(self.offsets[point], z);
        let (_, tangent) = Engineering::first(z[0].into());
        let [by_first, by_second] = bend::gradient(z);
        let (tension, across) = (self.path.tension, -self.offsets[point][0] * by_a);
        let along = Vector2::from(tangent) * (by_a - 1.0);
        [(along + by_first * across) * tension, by_second * (across * tension)]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<2>,
        _: &Gradient<2>,
        _: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let (_, by_a, by_aa) = detour(self.offsets[point], z);
        let (_, tangent, second) = Engineering::second(z[0].into());
        let ([by_first, by_second], [aa, ab]) = (bend::gradient(z), bend::hessian(z));
        let (tension, offset) = (self.path.tension, self.offsets[point][0]);
        let (along, across) = (tension * (by_a - 1.0), -offset * tension * by_a);
        let a = [Vector2::from(tangent) - by_first * offset, by_second * -offset];
        let block = |m: usize, n: usize| a[m] * a[n].transpose() * (tension * by_aa);
        let mixed = block(0, 1) + ab * across;
        let hessian = [
            [block(0, 0) + lanes::matrix(second) * along + aa * across, mixed],
            [mixed.transpose(), block(1, 1)],
        ];
        (self.gradient(point, z), hessian)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tendon that moves off by ¾ for each metre beside a beam that is stretched to 2 and bent by
    /// κ = 4/|r'|² = 1: at an offset of 1 it runs along a = 2 − 1, and is √(1² + ¾²) = 1¼ long.
    #[test]
    fn tendons_are_longer_by_their_slope_and_shorter_by_the_bend() {
        let z = [Vector2::new(2.0, 0.0), Vector2::new(0.0, 2.0)];
        assert_eq!(bend::curvature(&z[0], &z[1]), 1.0);
        let (longer, by_a, again) = detour([1.0, 0.75], &z);
        assert!((longer + 0.75).abs() < 1e-15 && (by_a - 0.8).abs() < 1e-15, "{longer} {by_a}");
        // d²/da² √(a² + ¾²) = (¾)²/1¼³.
        assert!((again - 0.288).abs() < 1e-15, "{again}");
        assert_eq!(detour([0.5, 0.0], &z), (-0.5, 1.0, 0.0));
    }
}
