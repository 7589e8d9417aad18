//! Supports at nodes, by elimination.
//!
//! Both discretisations interpolate values and slopes at their nodes (Kronecker delta), so that what a support holds
//! there *is* a coordinate, if need be in a turned frame, and is eliminated exactly: its row and column become those of
//! the identity, which keeps the band as it is. Coordinates come in pairs, (x, y) or (x', y') of a node:
//!
//! - a held position fixes one or both components of its pair;
//! - a held gradient fixes both components of (x', y') to R(φ) r'₀, φ the prescribed rotation;
//! - a held direction θ lets (x', y') = a (cos θ, sin θ) with a free: in the frame turned by θ the second component is
//!   fixed to zero.

use crate::linear::Matrix;

/// A quantity that grows with the load factor: start + λ · change.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ramp {
    /// Value at λ = 0.
    pub start: f64,
    /// Difference between λ = 1 and λ = 0.
    pub change: f64,
}

impl Ramp {
    /// The value at load factor `load`.
    pub fn at(self, load: f64) -> f64 {
        self.change.mul_add(load, self.start)
    }
}

/// What is held of a pair of coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Hold {
    /// One or both components of a position.
    Position([Option<Ramp>; 2]),
    /// Both components of a gradient, turned by an angle.
    Gradient {
        /// r'₀.
        reference: [f64; 2],
        /// The angle by which it is turned \[rad\].
        rotation: Ramp,
    },
    /// The direction of a gradient \[rad\].
    Direction(Ramp),
}

/// A pair of coordinates, 2·pair and 2·pair + 1, of which something is held.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// Number of the pair.
    pub pair: usize,
    /// What is held.
    pub hold: Hold,
}

impl Held {
    /// Cosine and sine of the frame's angle, and which components are fixed in that frame.
    fn frame(&self, load: f64) -> ([f64; 2], [bool; 2]) {
        match &self.hold {
            Hold::Position(components) => ([1.0, 0.0], components.map(|c| c.is_some())),
            Hold::Gradient { .. } => ([1.0, 0.0], [true, true]),
            Hold::Direction(angle) => {
                let (sine, cosine) = angle.at(load).sin_cos();
                ([cosine, sine], [false, true])
            }
        }
    }

    /// ∂/∂λ of the fixed components, in the frame.
    fn rate(&self, load: f64, q: &[f64]) -> [f64; 2] {
        match &self.hold {
            Hold::Position(components) => components.map(|c| c.map_or(0.0, |ramp| ramp.change)),
            Hold::Gradient { reference: [x, y], rotation } => {
                let (sine, cosine) = rotation.at(load).sin_cos();
                let (x, y) = (cosine * x - sine * y, sine * x + cosine * y);
                [-y * rotation.change, x * rotation.change]
            }
            Hold::Direction(angle) => [0.0, q[2 * self.pair].hypot(q[2 * self.pair + 1]) * angle.change],
        }
    }
}

/// All supports at nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Supports {
    held: Vec<Held>,
}

fn rotate([cosine, sine]: [f64; 2], pair: &mut [f64]) {
    (pair[0], pair[1]) = (cosine * pair[0] + sine * pair[1], cosine * pair[1] - sine * pair[0]);
}

impl Supports {
    /// The given pairs are held.
    pub fn new(held: Vec<Held>) -> Self {
        Self { held }
    }

    /// The coordinates that are eliminated, in the supports' frames.
    pub fn eliminated(&self) -> impl Iterator<Item = usize> + '_ {
        // Which components are fixed in a frame does not depend on where the frame stands.
        self.held.iter().flat_map(|held| {
            let (_, fixed) = held.frame(0.0);
            (0..2).filter(move |component| fixed[*component]).map(|component| 2 * held.pair + component)
        })
    }

    /// Nodes of which one component of the position is held and the other free.
    pub fn half_held(&self) -> impl Iterator<Item = usize> + '_ {
        let half = |held: &&Held| matches!(held.hold, Hold::Position([a, b]) if a.is_some() != b.is_some());
        self.held.iter().filter(half).map(|held| held.pair / 2)
    }

    /// Number of coordinates that are eliminated.
    pub fn count(&self) -> usize {
        self.eliminated().count()
    }

    /// Sets the held coordinates of `q` to their values at load factor `load`.
    pub fn impose(&self, load: f64, q: &mut [f64]) {
        for held in &self.held {
            let pair = &mut q[2 * held.pair..2 * held.pair + 2];
            match &held.hold {
                Hold::Position(components) => {
                    for (value, component) in pair.iter_mut().zip(components) {
                        if let Some(ramp) = component {
                            *value = ramp.at(load);
                        }
                    }
                }
                Hold::Gradient { reference: [x, y], rotation } => {
                    let (sine, cosine) = rotation.at(load).sin_cos();
                    pair[0] = cosine * x - sine * y;
                    pair[1] = sine * x + cosine * y;
                }
                Hold::Direction(angle) => {
                    let length = pair[0].hypot(pair[1]);
                    let (sine, cosine) = angle.at(load).sin_cos();
                    pair[0] = length * cosine;
                    pair[1] = length * sine;
                }
            }
        }
    }

    /// Whether anything moves by prescription.
    pub fn moves(&self) -> bool {
        self.held.iter().any(|held| match &held.hold {
            Hold::Position(c) => c.iter().flatten().any(|ramp| ramp.change != 0.0),
            Hold::Gradient { rotation: ramp, .. } | Hold::Direction(ramp) => ramp.change != 0.0,
        })
    }

    /// Turns a vector of forces or increments into the frames of the supports and clears what is held.
    pub fn to_frames(&self, load: f64, v: &mut [f64]) {
        for held in &self.held {
            let (frame, fixed) = held.frame(load);
            let pair = &mut v[2 * held.pair..2 * held.pair + 2];
            rotate(frame, pair);
            for (value, fixed) in pair.iter_mut().zip(fixed) {
                if fixed {
                    *value = 0.0;
                }
            }
        }
    }

    /// Turns increments back from the frames of the supports.
    pub fn from_frames(&self, load: f64, v: &mut [f64]) {
        for held in &self.held {
            let ([cosine, sine], _) = held.frame(load);
            rotate([cosine, -sine], &mut v[2 * held.pair..2 * held.pair + 2]);
        }
    }

    /// Writes ∂q/∂λ of the held coordinates, in their frames, and zero elsewhere.
    pub fn rate(&self, load: f64, q: &[f64], rate: &mut [f64]) {
        rate.fill(0.0);
        for held in &self.held {
            rate[2 * held.pair..2 * held.pair + 2].copy_from_slice(&held.rate(load, q));
        }
    }

    /// Turns a tangent into the frames of the supports.
    pub fn turn_matrix(&self, load: f64, k: &mut Matrix) {
        for held in &self.held {
            if let ([cosine, sine], _) = held.frame(load)
                && sine != 0.0
            {
                k.rotate_pair(held.pair, cosine, sine);
            }
        }
    }

    /// Clears the diagonal of held coordinates in a matrix from which they are eliminated.
    pub fn clear_held(&self, load: f64, k: &mut Matrix) {
        for held in &self.held {
            let (_, fixed) = held.frame(load);
            for component in (0..2).filter(|c| fixed[*c]) {
                k.eliminate(2 * held.pair + component, 0.0);
            }
        }
    }

    /// Eliminates the held coordinates from a tangent that is already in their frames. The diagonal is left in place of
    /// the row, so that the matrix keeps its units.
    pub fn eliminate(&self, load: f64, k: &mut Matrix) {
        for held in &self.held {
            let (_, fixed) = held.frame(load);
            for (component, fixed) in fixed.into_iter().enumerate() {
                if fixed {
                    let i = 2 * held.pair + component;
                    let diagonal = k.get(i, i).abs();
                    k.eliminate(i, if diagonal > 0.0 && diagonal.is_finite() { diagonal } else { 1.0 });
                }
            }
        }
    }
}
