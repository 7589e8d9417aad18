//! Lines beside a beam that carry a tension through its cuts.

use crate::beam::Along;

/// The line of a tendon, at an offset from the centreline.
///
/// With the offset e, counted to the left of the direction of rising s, the normal n of the section
/// and its direction t = r'/|r'|, the line is p = r + e n. As n' = −κ t with the curvature κ =
/// (r' × r'')/|r'|², its derivative by the arc length of the beam is
///
/// ```text
/// p' = a t + e' n,   a = |r'| − e κ,   |p'| = √(a² + e'²)
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TendonPath {
    /// Arc lengths of the beam \[m\] between which it runs, and where it is fixed.
    pub ends: [f64; 2],
    /// e \[m\].
    pub offset: Along,
    /// Its tension \[N\], at the amplitude 1; that of a tendon of given length, times the multiplier.
    pub tension: f64,
}

impl TendonPath {
    /// The tension times p'/|p'| along t and n, and its moment about the centreline: what the tendon
    /// carries through a cut at `s`, as (N, Q, M) \[N, N, N m\]. `inside` tells the side of the cut
    /// as for [`Along::at`]; the beam has the stretch |r'| and the curvature κ there. Nothing, where
    /// it does not run.
    pub fn carries(&self, s: f64, inside: f64, [stretch, curvature]: [f64; 2]) -> [f64; 3] {
        let [from, to] = self.ends;
        if !(from..=to).contains(&inside) {
            return [0.0; 3];
        }
        let (offset, slope) = (self.offset.at(s, inside), self.offset.slope(s, inside));
        let along = stretch - offset * curvature;
        let length = if slope == 0.0 { along } else { along.hypot(slope) };
        let [axial, shear] = [along, slope].map(|part| self.tension * part / length);
        [axial, shear, -offset * axial]
    }
}
