//! What a factorised tangent tells of the stability of an equilibrium.

/// Stability of an equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// Number of unstable directions: negative eigenvalues of a symmetric tangent on the motions
    /// that constraints and supports allow.
    Directions(usize),
    /// Of an unsymmetric tangent, as follower loads have it: number of the structures, among those that
    /// nothing ties to others, whose determinant on the same motions is negative. Its sign changes
    /// where an odd number of directions lose their stiffness.
    NegativeDeterminants(usize),
}

impl Stability {
    /// Directions, or determinants.
    pub(super) fn count(self) -> usize {
        let (Self::Directions(count) | Self::NegativeDeterminants(count)) = self;
        count
    }

    /// Whether the equilibrium is known to be unstable.
    pub fn is_unstable(self) -> bool {
        self.count() > 0
    }

    /// Whether it differs from that of a point further on, as far as both tell.
    pub fn differs(self, after: Self) -> bool {
        if std::mem::discriminant(&self) == std::mem::discriminant(&after) {
            return self != after;
        }
        self.changes_sign(after)
    }

    /// Whether the determinant of the tangent has the other sign at a point further on.
    pub fn changes_sign(self, after: Self) -> bool {
        self.count() % 2 != after.count() % 2
    }

    /// Whether a point further on may have lost stability, as far as both tell.
    pub fn is_lost(self, after: Self) -> bool {
        match (self, after) {
            (Self::Directions(before), Self::Directions(after)) => after > before,
            _ => self.differs(after),
        }
    }
}

/// Directions lost or regained their stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityChange {
    /// Load factor at which it happened …
    pub load: f64,
    /// … and by how much that may be another one, since it was sought no further.
    pub resolution: f64,
    /// Stability before.
    pub before: Stability,
    /// Stability after.
    pub after: Stability,
}
