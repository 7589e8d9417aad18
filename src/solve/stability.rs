//! What a factorised tangent tells of the stability of an equilibrium.

/// Stability of an equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// Number of unstable directions: negative eigenvalues of a symmetric tangent on the motions
    /// that constraints and supports allow.
    Directions(usize),
    /// Sign of the determinant of an unsymmetric tangent, as follower loads have it, on the same
    /// motions. It changes where an odd number of directions lose their stiffness.
    Determinant {
        /// Whether it is negative.
        negative: bool,
    },
}

impl Stability {
    /// Whether the number of unstable directions is odd.
    pub fn is_odd(self) -> bool {
        match self {
            Self::Directions(count) => count % 2 == 1,
            Self::Determinant { negative } => negative,
        }
    }

    /// Whether the equilibrium is known to be unstable.
    pub fn is_unstable(self) -> bool {
        self.is_odd() || matches!(self, Self::Directions(1..))
    }

    /// Whether it differs from that of a point further on, as far as both tell.
    pub fn differs(self, after: Self) -> bool {
        match (self, after) {
            (Self::Directions(before), Self::Directions(after)) => before != after,
            _ => self.is_odd() != after.is_odd(),
        }
    }

    /// Whether a point further on has lost stability, as far as both tell.
    pub fn is_lost(self, after: Self) -> bool {
        match (self, after) {
            (Self::Directions(before), Self::Directions(after)) => after > before,
            _ => self.is_odd() != after.is_odd(),
        }
    }
}

/// Directions lost or regained their stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityChange {
    /// Load factor at which it happened.
    pub load: f64,
    /// Stability before.
    pub before: Stability,
    /// Stability after.
    pub after: Stability,
}
