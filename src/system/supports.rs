//! Supports at nodes, by elimination.
//!
//! Both discretisations interpolate values and slopes at their nodes (Kronecker delta), so that
//! every quantity fixed there *is* a coordinate, if necessary in a rotated frame. It is eliminated
//! exactly: its row and column are replaced by those of the identity, which does not change the
//! band. Coordinates come in pairs, (x, y) or (x', y') of a node:
//!
//! - a fixed position fixes one or both components of its pair;
//! - a fixed gradient fixes both components of (x', y') to R(φ) r'₀, where φ is the prescribed
//!   rotation;
//! - a fixed direction θ leaves the length a free in (x', y') = a (cos θ, sin θ): in the frame
//!   rotated by θ the second component is fixed to zero.

use super::prescribed::Prescribed;
use crate::lanes::Real;
use crate::law::Law;
use crate::linear::Matrix;

/// The quantities that are fixed in a pair of coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Restraint {
    /// One or both components of a position.
    Position([Option<Prescribed>; 2]),
    /// Both components of a gradient, rotated by an angle.
    Gradient {
        /// The gradient without rotation, r'₀.
        reference: [f64; 2],
        /// The angle of rotation \[rad\].
        rotation: Prescribed,
    },
    /// The direction of a gradient \[rad\].
    Direction(Prescribed),
}

/// A pair of coordinates, 2·pair and 2·pair + 1, with a fixed quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct RestrainedPair {
    /// Index of the pair.
    pub pair: usize,
    /// The fixed quantities.
    pub restraint: Restraint,
}

impl RestrainedPair {
    fn prescribed(&self) -> impl Iterator<Item = &Prescribed> {
        let all: [Option<&Prescribed>; 2] = match &self.restraint {
            Restraint::Position(components) => components.each_ref().map(Option::as_ref),
            Restraint::Gradient { rotation: course, .. } | Restraint::Direction(course) => {
                [Some(course), None]
            }
        };
        all.into_iter().flatten()
    }

    /// Whether its frame rotates with time.
    fn turns(&self) -> bool {
        matches!(&self.restraint, Restraint::Direction(angle) if angle.moves_in_time())
    }

    /// Cosine and sine of the frame's angle, and which components are fixed in that frame.
    fn frame(&self, load: f64) -> ([f64; 2], [bool; 2]) {
        match &self.restraint {
            Restraint::Position(components) => ([1.0, 0.0], components.each_ref().map(Option::is_some)),
            Restraint::Gradient { .. } => ([1.0, 0.0], [true, true]),
            Restraint::Direction(angle) => {
                let (sine, cosine) = angle.at(load).sin_cos();
                ([cosine, sine], [false, true])
            }
        }
    }

    /// Derivatives of the fixed components with respect to λ, in the frame.
    fn rate(&self, load: f64, q: &[f64]) -> [f64; 2] {
        match &self.restraint {
            Restraint::Position(components) => {
                components.each_ref().map(|c| c.as_ref().map_or(0.0, |course| course.change))
            }
            Restraint::Gradient { reference: [x, y], rotation } => {
                let (sine, cosine) = rotation.at(load).sin_cos();
                let (x, y) = (cosine * x - sine * y, sine * x + cosine * y);
                [-y * rotation.change, x * rotation.change]
            }
            Restraint::Direction(angle) => [0.0, q[2 * self.pair].hypot(q[2 * self.pair + 1]) * angle.change],
        }
    }
}

/// All supports at nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Supports {
    pairs: Vec<RestrainedPair>,
}

/// Values of a pair of coordinates, with their velocities and accelerations.
type PairMotion = [[f64; 2]; 3];

fn rotate<T: Real>([cosine, sine]: [f64; 2], pair: &mut [T]) {
    let (cosine, sine) = (T::of(cosine), T::of(sine));
    (pair[0], pair[1]) = (cosine * pair[0] + sine * pair[1], cosine * pair[1] - sine * pair[0]);
}

fn clear<T: Real>(pair: &mut [T], which: [bool; 2]) {
    for (value, which) in pair.iter_mut().zip(which) {
        if which {
            *value = T::of(0.0);
        }
    }
}

impl Supports {
    /// Supports that fix the given pairs.
    pub fn new(pairs: Vec<RestrainedPair>) -> Self {
        Self { pairs }
    }

    /// The coordinates that are eliminated, in the supports' frames.
    pub fn eliminated(&self) -> impl Iterator<Item = usize> + '_ {
        // The angle of a frame does not affect which of its components are fixed.
        self.pairs.iter().flat_map(|restrained| {
            let (_, fixed) = restrained.frame(0.0);
            (0..2).filter(move |component| fixed[*component]).map(|component| 2 * restrained.pair + component)
        })
    }

    /// Nodes at which anything is fixed.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.pairs.iter().map(|restrained| restrained.pair / 2)
    }

    /// Nodes with a pair of which one component is fixed and the other free, in the support's
    /// frame.
    pub fn half_fixed(&self) -> impl Iterator<Item = usize> + '_ {
        let half = |restrained: &&RestrainedPair| {
            let (_, [first, second]) = restrained.frame(0.0);
            first != second
        };
        self.pairs.iter().filter(half).map(|restrained| restrained.pair / 2)
    }

    /// Whether the position of a node is fixed in both directions.
    pub fn pin(&self) -> bool {
        let pins = |restrained: &RestrainedPair| {
            matches!(restrained.restraint, Restraint::Position(_)) && restrained.frame(0.0).1 == [true; 2]
        };
        self.pairs.iter().any(pins)
    }

    /// Nodes at which one or both components of the position are fixed.
    pub fn positions(&self) -> impl Iterator<Item = usize> + '_ {
        self.pairs
            .iter()
            .filter(|restrained| matches!(restrained.restraint, Restraint::Position(_)))
            .map(|restrained| restrained.pair / 2)
    }

    /// Number of coordinates that are eliminated.
    pub fn count(&self) -> usize {
        self.eliminated().count()
    }

    /// Sets the fixed coordinates of `q` to their values at the load factor `load`.
    pub fn impose(&self, load: f64, q: &mut [f64]) {
        for restrained in &self.pairs {
            restrained.impose(load, &mut q[2 * restrained.pair..2 * restrained.pair + 2]);
        }
    }

    /// Per fixed component of a position: its axis, and the distance of the component in `q` from
    /// its value at the load factor `load` \[m\].
    pub fn position_changes<'a>(
        &'a self,
        load: f64,
        q: &'a [f64],
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        self.pairs.iter().flat_map(move |RestrainedPair { pair, restraint }| {
            let components = match restraint {
                Restraint::Position(components) => components.each_ref(),
                Restraint::Gradient { .. } | Restraint::Direction(_) => [&None; 2],
            };
            [0, 1].into_iter().filter_map(move |axis| {
                components[axis].as_ref().map(|value| (axis, value.at(load) - q[2 * pair + axis]))
            })
        })
    }

    /// The nodes whose directions are held, and the angles of these \[rad\].
    pub fn angles(&self) -> impl Iterator<Item = (usize, &Prescribed)> {
        self.pairs.iter().filter_map(|RestrainedPair { pair, restraint }| match restraint {
            Restraint::Position(_) => None,
            Restraint::Gradient { rotation: angle, .. } | Restraint::Direction(angle) => {
                Some((pair / 2, angle))
            }
        })
    }

    /// Fixes quantities that no law moves at the values that they have in the state `q`; `length`
    /// is the scale of lengths.
    pub fn freeze(&mut self, q: &[f64], length: f64) {
        for RestrainedPair { pair, restraint } in &mut self.pairs {
            let field = [q[2 * *pair], q[2 * *pair + 1]];
            match restraint {
                Restraint::Position(components) => {
                    let components = components.iter_mut().zip(field);
                    components.for_each(|(course, value)| {
                        if let Some(course) = course {
                            course.freeze(value, length);
                        }
                    });
                }
                Restraint::Gradient { reference, rotation } => rotation.freeze_angle(*reference, field),
                Restraint::Direction(angle) => angle.freeze_angle([1.0, 0.0], field),
            }
        }
    }

    /// Whether any prescribed quantity changes.
    pub fn moves(&self) -> bool {
        self.pairs.iter().flat_map(RestrainedPair::prescribed).any(Prescribed::moves)
    }

    /// Transforms a vector of forces or increments to the frames of the supports and clears the
    /// fixed components.
    pub fn to_frames<T: Real>(&self, load: f64, v: &mut [T]) {
        for restrained in &self.pairs {
            let (frame, fixed) = restrained.frame(load);
            let pair = &mut v[2 * restrained.pair..2 * restrained.pair + 2];
            rotate(frame, pair);
            clear(pair, fixed);
        }
    }

    /// Transforms increments back from the frames of the supports, except from frames that rotate
    /// with time: there the unknowns of a motion are components in the frame.
    pub fn from_frames<T: Real>(&self, load: f64, v: &mut [T]) {
        for restrained in self.pairs.iter().filter(|restrained| !restrained.turns()) {
            let ([cosine, sine], _) = restrained.frame(load);
            rotate([cosine, -sine], &mut v[2 * restrained.pair..2 * restrained.pair + 2]);
        }
    }

    /// Writes ∂q/∂λ of the fixed coordinates, in their frames, and zero elsewhere.
    pub fn rate(&self, load: f64, q: &[f64], rate: &mut [f64]) {
        rate.fill(0.0);
        for restrained in &self.pairs {
            rate[2 * restrained.pair..2 * restrained.pair + 2].copy_from_slice(&restrained.rate(load, q));
        }
    }

    /// Transforms a tangent to the frames of the supports.
    pub fn turn_matrix(&self, load: f64, k: &mut Matrix) {
        for restrained in &self.pairs {
            if let ([cosine, sine], _) = restrained.frame(load)
                && sine != 0.0
            {
                k.rotate_pair(restrained.pair, cosine, sine);
            }
        }
    }

    /// Sets the rows, columns and diagonal entries of fixed coordinates to zero.
    pub fn clear_fixed(&self, load: f64, k: &mut Matrix) {
        for restrained in &self.pairs {
            let (_, fixed) = restrained.frame(load);
            for component in (0..2).filter(|c| fixed[*c]) {
                k.eliminate(2 * restrained.pair + component, 0.0);
            }
        }
    }

    /// Eliminates the fixed coordinates from a tangent that is already in their frames. The
    /// magnitude of the diagonal entry is kept, so that the matrix keeps its units.
    pub fn eliminate(&self, load: f64, k: &mut Matrix) {
        for restrained in &self.pairs {
            let (_, fixed) = restrained.frame(load);
            for (component, fixed) in fixed.into_iter().enumerate() {
                if fixed {
                    let i = 2 * restrained.pair + component;
                    let diagonal = k.get(i, i).abs();
                    k.eliminate(i, if diagonal > 0.0 && diagonal.is_finite() { diagonal } else { 1.0 });
                }
            }
        }
    }

    /// Whether any prescribed quantity changes by a law of time.
    pub fn moves_in_time(&self) -> bool {
        self.pairs.iter().flat_map(RestrainedPair::prescribed).any(Prescribed::moves_in_time)
    }

    /// The quantities that change by a law of time, each with a factor that makes it dimensionless:
    /// `per_length` for positions, 1 for angles.
    pub fn moving(&self, per_length: f64) -> impl Iterator<Item = (&Prescribed, f64)> {
        let of = move |restrained: &RestrainedPair| {
            if matches!(restrained.restraint, Restraint::Position(_)) { per_length } else { 1.0 }
        };
        let prescribed = self
            .pairs
            .iter()
            .flat_map(move |restrained| restrained.prescribed().map(move |course| (course, of(restrained))));
        prescribed.filter(|(course, _)| course.moves_in_time())
    }

    /// Whether a fixed direction rotates by a law of time.
    pub fn turn_in_time(&self) -> bool {
        self.pairs.iter().any(RestrainedPair::turns)
    }

    /// Whether coordinate `i` belongs to a pair with a fixed quantity, and no quantity of the pair
    /// moves with time.
    pub fn is_stationary(&self, i: usize) -> bool {
        self.pairs.iter().any(|restrained| {
            restrained.pair == i / 2 && !restrained.prescribed().any(Prescribed::moves_in_time)
        })
    }

    /// The laws of time of the prescribed quantities.
    pub fn laws(&self) -> impl Iterator<Item = &Law> {
        self.pairs.iter().flat_map(RestrainedPair::prescribed).filter_map(|course| course.law.as_ref())
    }

    /// Prescribed quantities that jump by a law: a coordinate of the pair, the time, and the height
    /// (m, or rad).
    pub fn jumps(&self) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        self.pairs.iter().flat_map(|restrained| {
            let jumps = |course: &'_ Prescribed| {
                let law = course.law.as_ref().filter(|_| course.moves());
                let (pair, change) = (2 * restrained.pair, course.change);
                let jumps = law.map_or_else(Vec::new, Law::jumps).into_iter();
                jumps.map(move |(time, height)| (pair, time, height * change))
            };
            restrained.prescribed().flat_map(jumps)
        })
    }

    /// Transforms changes of a motion's unknowns to the frames of the supports and clears the fixed
    /// components.
    pub fn unknowns_to_frames(&self, v: &mut [f64]) {
        for restrained in &self.pairs {
            let (frame, fixed) = restrained.frame(0.0);
            let pair = &mut v[2 * restrained.pair..2 * restrained.pair + 2];
            if !restrained.turns() {
                rotate(frame, pair);
            }
            clear(pair, fixed);
        }
    }

    /// Removes fixed components from changes or rates of a motion's unknowns.
    ///
    /// In a frame that is not parallel to the axes, round-off leaves a small fixed component in
    /// every sum. The equations never correct it, so that it must be removed from all vectors that
    /// are continued from step to step: extrapolating the polynomial of the stages would multiply
    /// it in every step.
    pub fn release<T: Real>(&self, v: &mut [T]) {
        for restrained in &self.pairs {
            let ([cosine, sine], fixed) = restrained.frame(0.0);
            let pair = &mut v[2 * restrained.pair..2 * restrained.pair + 2];
            if restrained.turns() {
                clear(pair, fixed);
            } else {
                rotate([cosine, sine], pair);
                clear(pair, fixed);
                rotate([cosine, -sine], pair);
            }
        }
    }

    /// Transforms a vector back from all frames.
    pub fn to_fixed_axes(&self, time: f64, v: &mut [f64]) {
        for restrained in &self.pairs {
            let ([cosine, sine], _) = restrained.frame(time);
            rotate([cosine, -sine], &mut v[2 * restrained.pair..2 * restrained.pair + 2]);
        }
    }

    /// Sets the fixed components of a motion's unknowns.
    pub fn impose_unknowns(&self, time: f64, x: &mut [f64]) {
        for restrained in &self.pairs {
            let pair = &mut x[2 * restrained.pair..2 * restrained.pair + 2];
            if restrained.turns() { pair[1] = 0.0 } else { restrained.impose(time, pair) }
        }
    }

    /// Writes the velocities that supports prescribe in the state `q`, and zero for all free
    /// components.
    pub fn prescribed_velocity(&self, time: f64, q: &[f64], velocity: &mut [f64]) {
        velocity.fill(0.0);
        for restrained in &self.pairs {
            let at = 2 * restrained.pair;
            let length = if restrained.turns() { q[at].hypot(q[at + 1]) } else { 0.0 };
            let [_, v, _] = restrained.carried(time, [[length, 0.0], [0.0; 2], [0.0; 2]]);
            velocity[at..at + 2].copy_from_slice(&v);
        }
    }

    /// Clears all forces except those on fixed components, in fixed axes.
    pub fn keep_fixed(&self, time: f64, force: &mut [f64]) {
        let mut kept = vec![0.0; force.len()];
        for restrained in &self.pairs {
            let ([cosine, sine], fixed) = restrained.frame(time);
            let range = 2 * restrained.pair..2 * restrained.pair + 2;
            let mut pair = [force[range.start], force[range.start + 1]];
            rotate([cosine, sine], &mut pair);
            clear(&mut pair, fixed.map(|fixed| !fixed));
            rotate([cosine, -sine], &mut pair);
            kept[range].copy_from_slice(&pair);
        }
        force.copy_from_slice(&kept);
    }

    /// Transforms the unknowns of a motion to positions, velocities and accelerations in fixed
    /// axes. Prescribed components receive their values. Along a direction that rotates with θ(t),
    ///
    /// ```text
    /// r' = y e,   ṙ' = ẏ e + y θ̇ n,   r̈' = (ÿ − y θ̇²) e + (2 ẏ θ̇ + y θ̈) n
    /// e = (cos θ, sin θ),   n = (−sin θ, cos θ)
    /// ```
    pub fn carry(&self, time: f64, [q, v, a]: [&mut [f64]; 3]) {
        for restrained in &self.pairs {
            let range = 2 * restrained.pair..2 * restrained.pair + 2;
            let pair = |x: &[f64]| [x[range.start], x[range.start + 1]];
            let moved = restrained.carried(time, [pair(q), pair(v), pair(a)]);
            for (x, moved) in [&mut *q, &mut *v, &mut *a].into_iter().zip(moved) {
                x[range.clone()].copy_from_slice(&moved);
            }
        }
    }

    /// Transforms positions and velocities in fixed axes to the unknowns of a motion: the inverse
    /// of [`Self::carry`].
    pub fn uncarry(&self, time: f64, q: &mut [f64], v: &mut [f64]) {
        for restrained in self.pairs.iter().filter(|restrained| restrained.turns()) {
            let (frame, _) = restrained.frame(time);
            for x in [&mut *q, &mut *v] {
                let pair = &mut x[2 * restrained.pair..2 * restrained.pair + 2];
                rotate(frame, pair);
                pair[1] = 0.0;
            }
        }
    }
}

impl RestrainedPair {
    fn impose(&self, load: f64, pair: &mut [f64]) {
        match &self.restraint {
            Restraint::Position(components) => {
                for (value, component) in pair.iter_mut().zip(components) {
                    if let Some(course) = component {
                        *value = course.at(load);
                    }
                }
            }
            Restraint::Gradient { reference: [x, y], rotation } => {
                let (sine, cosine) = rotation.at(load).sin_cos();
                pair[0] = cosine * x - sine * y;
                pair[1] = sine * x + cosine * y;
            }
            Restraint::Direction(angle) => {
                let length = pair[0].hypot(pair[1]);
                let (sine, cosine) = angle.at(load).sin_cos();
                pair[0] = length * cosine;
                pair[1] = length * sine;
            }
        }
    }

    fn carried(&self, time: f64, [mut q, mut v, mut a]: PairMotion) -> PairMotion {
        match &self.restraint {
            Restraint::Position(components) => {
                for (i, component) in components.iter().enumerate() {
                    if let Some(course) = component {
                        [q[i], v[i], a[i]] = course.prescribed(time);
                    }
                }
            }
            Restraint::Gradient { reference: [x, y], rotation } => {
                let [angle, rate, second] = rotation.prescribed(time);
                let (sine, cosine) = angle.sin_cos();
                let r = [cosine * x - sine * y, sine * x + cosine * y];
                q = r;
                v = [-r[1] * rate, r[0] * rate];
                a = [-r[1] * second - r[0] * rate * rate, r[0] * second - r[1] * rate * rate];
            }
            Restraint::Direction(angle) if self.turns() => {
                let [angle, rate, second] = angle.prescribed(time);
                let (sine, cosine) = angle.sin_cos();
                let turned = |along: f64, across: f64| {
                    [along * cosine - across * sine, along * sine + across * cosine]
                };
                let (y, dy, ddy) = (q[0], v[0], a[0]);
                q = turned(y, 0.0);
                v = turned(dy, y * rate);
                a = turned(ddy - y * rate * rate, 2.0 * dy * rate + y * second);
            }
            Restraint::Direction(_) => {}
        }
        [q, v, a]
    }
}
