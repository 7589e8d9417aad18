//! Velocities of beams at the start of a motion.

use super::Tabulated;

/// The velocity of a beam at the start: ṙ = v + ω × (r − c) + w(s). Several entries of one beam add
/// up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialVelocity {
    /// Index of the beam.
    pub beam: usize,
    /// v \[m/s\].
    pub translation: [f64; 2],
    /// ω \[rad/s\], counter-clockwise.
    pub rotation: f64,
    /// c \[m\].
    pub center: [f64; 2],
    /// w(s) along x and y.
    pub along: [Profile; 2],
}

/// A component of a velocity along the arc length.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Profile {
    /// Zero.
    #[default]
    None,
    /// Σ c_k s^k, s in metres, c_k in m/s/mᵏ.
    Polynomial(Vec<f64>),
    /// Interpolates given points.
    Table(Tabulated),
}

impl Profile {
    /// w \[m/s\] and dw/ds \[1/s\] at the arc length `s` \[m\].
    pub fn at(&self, s: f64) -> [f64; 2] {
        match self {
            Self::None => [0.0; 2],
            Self::Polynomial(coefficients) => coefficients
                .iter()
                .rev()
                .fold([0.0; 2], |[value, slope], c| [value * s + c, slope * s + value]),
            Self::Table(table) => {
                let [value, slope, _] = table.between(s);
                [value, slope]
            }
        }
    }
}

impl InitialVelocity {
    /// Rates of \[x, y, x', y'\] at the arc length `s` \[m\], where the beam has the position \[m\]
    /// and the gradient given by the other arguments.
    pub fn at(&self, s: f64, [x, y]: [f64; 2], [dx, dy]: [f64; 2]) -> [f64; 4] {
        let ([vx, vy], [cx, cy], turn) = (self.translation, self.center, self.rotation);
        let [[wx, dwx], [wy, dwy]] = [self.along[0].at(s), self.along[1].at(s)];
        [vx - turn * (y - cy) + wx, vy + turn * (x - cx) + wy, dwx - turn * dy, dwy + turn * dx]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocities_and_their_slopes_are_those_of_a_turn_and_of_profiles() {
        let profile = Profile::Polynomial(vec![2.0, -3.0, 0.5]);
        assert_eq!(profile.at(4.0), [2.0 - 12.0 + 8.0, -3.0 + 4.0]);
        assert_eq!((profile.at(0.0), Profile::None.at(4.0)), ([2.0, -3.0], [0.0, 0.0]));
        let velocity = InitialVelocity {
            translation: [0.5, 0.25],
            rotation: 2.0,
            center: [1.0, 3.0],
            along: [Profile::Polynomial(vec![0.0, 8.0]), profile],
            ..InitialVelocity::default()
        };
        // ω × (r − c) with r − c = (4, −1), and ω × r' with r' = (0.6, 0.8).
        let found = velocity.at(4.0, [5.0, 2.0], [0.6, 0.8]);
        assert_eq!(found, [0.5 + 2.0 + 32.0, 0.25 + 8.0 - 2.0, 8.0 - 1.6, 1.0 + 1.2]);
    }
}
