//! Rigid motions that supports and joints leave to the beams of a model.
//!
//! A planar rigid motion of a beam is (t_x, t_y, ω): the displacement of its start (x̄, ȳ), divided
//! by a length L, and its rotation. A support at (x₀, y₀) fixes t_x − ω (y₀ − ȳ)/L,
//! t_y + ω (x₀ − x̄)/L or ω, and a joint makes these equal for two beams; each such condition is
//! one row. The motions left are the null space of the rows. It is found by Gauss–Jordan
//! elimination, because a singular value decomposition would return mixtures of motions, which a
//! message could not name.

use super::{FixedRotation, Joint, Model, Place};
use crate::assembly::Resistance;

/// A row is a combination of others if its residual, relative to its size, is at most this.
const DEPENDENT: f64 = 1e-9;

/// Reduced rows that motions must satisfy: each is 1 in a column in which all others are 0.
#[derive(Clone, Debug)]
pub struct Freedom {
    length: f64,
    origins: Vec<[f64; 2]>,
    rows: Vec<(usize, Vec<f64>)>,
}

/// A rigid motion of the model: per beam (t_x, t_y, ω), with the displacements in units of the
/// length.
pub type Motion = Vec<[f64; 3]>;

impl Freedom {
    /// The motions that supports and joints of `model` leave. `position` gives the position of a
    /// place in the stress-free shape \[m\], and `length` is the scale of lengths \[m\].
    pub fn new(model: &Model, length: f64, position: impl Fn(Place) -> [f64; 2]) -> Self {
        let origins = (0..model.beams.len()).map(|beam| position(Place { beam, s: 0.0 })).collect();
        let mut freedom = Self { length, origins, rows: Vec::new() };
        for support in &model.supports {
            let (at, fix) = (support.at, support.fix);
            let axes = [(fix.x, [1.0, 0.0]), (fix.y, [0.0, 1.0])];
            for (_, axis) in axes.into_iter().filter(|(fixed, _)| *fixed) {
                freedom.fix_displacement(&[(at.beam, position(at), axis)]);
            }
            if fix.rotation != FixedRotation::Free {
                freedom.fix_direction(at.beam);
            }
        }
        for joint in &model.joints {
            match *joint {
                Joint::Slider { at, along: [x, y] } => {
                    freedom.fix_displacement(&[(at.beam, position(at), [-y, x])]);
                }
                Joint::Hinge { first, second } | Joint::Weld { first, second } => {
                    let (a, b) = (position(first), position(second));
                    for [x, y] in [[1.0, 0.0], [0.0, 1.0]] {
                        freedom.fix_displacement(&[(first.beam, a, [-x, -y]), (second.beam, b, [x, y])]);
                    }
                    if matches!(joint, Joint::Weld { .. }) {
                        freedom.fix_turns(&[(first.beam, -1.0), (second.beam, 1.0)]);
                    }
                }
            }
        }
        freedom
    }

    /// Removes the motions that the model's parts may resist by elasticity. Contacts count only
    /// where there are springs, which may press beams against them.
    pub fn resist(&mut self, model: &Model, position: impl Fn(Place) -> [f64; 2]) {
        let all: Vec<_> = model.parts.iter().flat_map(|part| part.resists()).collect();
        let springs = all.iter().any(|resistance| !matches!(resistance, Resistance::Contact(_)));
        for resistance in all {
            match resistance {
                Resistance::Displacement(at, axis) => {
                    self.fix_displacement(&[(at.beam, position(at), axis)]);
                }
                Resistance::Direction(at) => self.fix_direction(at.beam),
                Resistance::Contact(beam) if springs => {
                    let start = position(Place { beam, s: 0.0 });
                    for axis in [[1.0, 0.0], [0.0, 1.0]] {
                        self.fix_displacement(&[(beam, start, axis)]);
                    }
                    self.fix_direction(beam);
                }
                Resistance::Contact(_) => {}
            }
        }
    }

    /// Removes the rotation of a beam.
    pub fn fix_direction(&mut self, beam: usize) {
        self.fix_turns(&[(beam, 1.0)]);
    }

    /// Adds the row Σ n·u = 0, with the displacements u of points of beams.
    fn fix_displacement(&mut self, terms: &[(usize, [f64; 2], [f64; 2])]) {
        let mut row = vec![0.0; 3 * self.origins.len()];
        // Terms of one beam may cancel, as where its ends are joined.
        let mut size = 0.0_f64;
        for &(beam, [x, y], n) in terms {
            let [ox, oy] = self.origins[beam];
            let lever = (n[1] * (x - ox) - n[0] * (y - oy)) / self.length;
            for (i, value) in [n[0], n[1], lever].into_iter().enumerate() {
                row[3 * beam + i] += value;
                size = size.max(value.abs());
            }
        }
        self.add(row, size);
    }

    /// Adds the row Σ ±ω = 0, with the rotations ω of beams.
    fn fix_turns(&mut self, terms: &[(usize, f64)]) {
        let mut row = vec![0.0; 3 * self.origins.len()];
        terms.iter().for_each(|(beam, sign)| row[3 * beam + 2] += sign);
        self.add(row, 1.0);
    }

    /// Adds a row whose terms have this `size`, unless it is a combination of others.
    fn add(&mut self, mut row: Vec<f64>, size: f64) {
        let largest = |row: &[f64]| {
            let sizes = row.iter().map(|value| value.abs()).enumerate();
            sizes.fold((0, 0.0), |best, (i, size)| if size > best.1 { (i, size) } else { best })
        };
        for (column, reduced) in &self.rows {
            subtract(row[*column], reduced, &mut row);
        }
        let (column, left) = largest(&row);
        if left <= DEPENDENT * size {
            return;
        }
        let by = row[column];
        row.iter_mut().for_each(|value| *value /= by);
        self.rows.iter_mut().for_each(|(_, other)| subtract(other[column], &row, other));
        self.rows.push((column, row));
    }

    /// A basis of the motions left.
    pub fn motions(&self) -> Vec<Motion> {
        let columns = 3 * self.origins.len();
        let mut pivots = vec![false; columns];
        self.rows.iter().for_each(|(column, _)| pivots[*column] = true);
        let free = (0..columns).filter(|column| !pivots[*column]);
        free.map(|free| {
            let mut motion = vec![0.0; columns];
            motion[free] = 1.0;
            self.rows.iter().for_each(|(column, row)| motion[*column] = -row[free]);
            motion.as_chunks().0.to_vec()
        })
        .collect()
    }

    /// The start of a beam, to which its displacement refers \[m\].
    pub fn origin(&self, beam: usize) -> [f64; 2] {
        self.origins[beam]
    }
}

fn subtract(factor: f64, from: &[f64], row: &mut [f64]) {
    if factor != 0.0 {
        row.iter_mut().zip(from).for_each(|(value, other)| *value -= factor * other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Beam, Discretization, Fixed, Section, Support};

    /// Beams of unit length along x, one above the other, and what holds them.
    fn model(beams: usize, supports: Vec<Support>, joints: Vec<Joint>) -> Model {
        let beam = |i: usize| {
            let y = i as f64;
            Beam::line("rod", [0.0, y], [1.0, y], Section::new(1.0, 1.0), Discretization::ancf(1))
        };
        Model { beams: (0..beams).map(beam).collect(), supports, joints, ..Model::default() }
    }

    fn position(at: Place) -> [f64; 2] {
        [at.s, at.beam as f64]
    }

    /// The motions left with displacements in lengths of 2.
    fn left(model: &Model) -> Vec<Motion> {
        Freedom::new(model, 2.0, position).motions()
    }

    fn at(beam: usize, s: f64) -> Place {
        Place { beam, s }
    }

    #[test]
    fn supports_leave_what_they_do_not_hold() {
        let every = vec![vec![[1.0, 0.0, 0.0]], vec![[0.0, 1.0, 0.0]], vec![[0.0, 0.0, 1.0]]];
        assert_eq!(left(&model(1, vec![], vec![])), every);
        assert_eq!(left(&model(1, vec![Support::clamp(at(0, 0.5))], vec![])), [] as [Motion; 0]);
        assert_eq!(left(&model(1, vec![Support::pin(at(0, 0.0))], vec![])), [[[0.0, 0.0, 1.0]]]);
        // About its end a beam turns with its start going down by ω times 1, in units of 2.
        assert_eq!(left(&model(1, vec![Support::pin(at(0, 1.0))], vec![])), [[[0.0, -0.5, 1.0]]]);
        // Along y, a rod that is held along x at two heights, by its turn, does not turn.
        let only = |x, y| Fixed { x, y, ..Fixed::default() };
        let held = |s, fix| Support { at: at(0, s), fix, ..Support::default() };
        assert_eq!(left(&model(1, vec![held(0.0, only(true, false))], vec![])).len(), 2);
        let two = vec![held(0.0, only(false, true)), held(1.0, only(false, true))];
        assert_eq!(left(&model(1, two, vec![])), [[[1.0, 0.0, 0.0]]]);
        // Twice the same says no more than once.
        let same = vec![held(0.5, only(false, true)), held(0.5, only(false, true))];
        assert_eq!(left(&model(1, same, vec![])).len(), 2);
    }

    /// A ring whose ends meet but for round-off moves as freely as a beam.
    #[test]
    fn a_beam_that_is_joined_to_itself_is_free() {
        let ring = model(1, vec![], vec![Joint::Weld { first: at(0, 0.0), second: at(0, 1.0) }]);
        let meet = |at: Place| [at.s * 1e-16, at.s * -2e-16];
        assert_eq!(Freedom::new(&ring, 2.0, meet).motions().len(), 3);
        // Ends that are apart cannot be turned about each other.
        assert_eq!(left(&ring).len(), 2);
    }

    #[test]
    fn joints_make_beams_move_together() {
        let [first, second] = [at(0, 1.0), at(1, 0.0)];
        assert_eq!(left(&model(2, vec![], vec![Joint::Weld { first, second }])).len(), 3);
        let clamp = || vec![Support::clamp(at(0, 0.0))];
        assert_eq!(left(&model(2, clamp(), vec![Joint::Weld { first, second }])), [] as [Motion; 0]);
        let hinge = Joint::Hinge { first, second };
        assert_eq!(left(&model(2, clamp(), vec![hinge])), [[[0.0; 3], [0.0, 0.0, 1.0]]]);
        // The first turns about its start by 1, which lifts its end by 1, in units of 2, and with it the
        // start of the second, which keeps its direction.
        let both = left(&model(2, vec![Support::pin(at(0, 0.0))], vec![hinge]));
        assert_eq!(both.len(), 2);
        for [[tx, ty, turn], [ux, uy, _]] in both.into_iter().map(|motion| [motion[0], motion[1]]) {
            // Seen from the first's start, its end is at (1, 0), in units of 2 (½, 0).
            assert_eq!([tx, ty, ux, uy], [0.0, 0.0, 0.0, 0.5 * turn]);
        }
        // Along a slope of 4 to 3.
        let slider = Joint::Slider { at: at(0, 0.0), along: [0.6, 0.8] };
        let mut slides = Freedom::new(&model(1, vec![], vec![slider]), 2.0, position);
        slides.fix_direction(0);
        let [[x, y, turn]] = slides.motions()[0][..] else { panic!("{slides:?}") };
        assert!(slides.motions().len() == 1 && turn == 0.0 && x != 0.0, "{slides:?}");
        assert!((y / x - 4.0 / 3.0).abs() < 1e-15, "{slides:?}");
        assert_eq!(slides.origin(0), [0.0, 0.0]);
    }

    /// An obstacle holds what springs press against it, and alone nothing.
    #[test]
    fn contacts_hold_where_springs_may_press() {
        let scene = |effects: &str| {
            let text = format!(
                "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 1 }}\n\
                 analysis.modal.count = 1\n[effect]\n{effects}"
            );
            crate::scene::parse("scene", &text)
                .unwrap_or_else(|error| panic!("{error}\n{text}"))
                .model()
                .clone()
        };
        let contact = "contact = [{ beam = 'rod', half_plane = { point = [0, -1], normal = [0, 1] }, stiffness = 1 }]\n";
        let spring = "torsion_spring = [{ beam = 'rod', at = 'start', stiffness = 1 }]\n";
        for (effects, motions) in
            [(String::new(), 3), (contact.into(), 3), (spring.into(), 2), (format!("{contact}{spring}"), 0)]
        {
            let model = scene(&effects);
            let mut freedom = Freedom::new(&model, 2.0, position);
            freedom.resist(&model, position);
            assert_eq!(freedom.motions().len(), motions, "{effects}");
        }
    }
}
