//! Elastic laws that are no straight lines: force against strain, or moment against curvature.

/// A force (or a moment) as a piecewise linear function of a strain (or a curvature) that never
/// falls, with its energy. Beyond its ends it goes on as straight as there.
#[derive(Clone, Debug, PartialEq)]
pub struct Elastic {
    /// Rising, with 0 among them.
    strain: Vec<f64>,
    force: Vec<f64>,
    /// Energy from 0 to each strain.
    energy: Vec<f64>,
}

/// Why a table is no elastic law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotElastic {
    /// Fewer than two points, or other numbers of forces than of strains.
    Lengths,
    /// The strain at this index is not larger than the one before.
    Strain(usize),
    /// The force at this index is smaller than the one before.
    Force(usize),
    /// The force at this strain does not vanish where the strain does.
    AtZero(f64),
    /// The force is the same everywhere.
    Flat,
}

/// A force that counts as zero, relative to the largest.
const ROUND_OFF: f64 = 1e-12;

impl Elastic {
    /// The law through these points.
    ///
    /// # Errors
    /// [`NotElastic`] where strains do not rise, forces fall, or there is a force without strain.
    pub fn new(mut strain: Vec<f64>, mut force: Vec<f64>) -> Result<Self, NotElastic> {
        if strain.len() < 2 || strain.len() != force.len() {
            return Err(NotElastic::Lengths);
        }
        let falls = |values: &[f64], strictly: bool| {
            values.windows(2).position(|pair| pair[1] < pair[0] || strictly && pair[1] == pair[0])
        };
        if let Some(index) = falls(&strain, true) {
            return Err(NotElastic::Strain(index + 1));
        }
        if let Some(index) = falls(&force, false) {
            return Err(NotElastic::Force(index + 1));
        }
        let largest = force.iter().fold(0.0_f64, |m, force| m.max(force.abs()));
        if force[0] == force[force.len() - 1] {
            return Err(NotElastic::Flat);
        }
        let raw = Self { strain: strain.clone(), force: force.clone(), energy: vec![0.0; strain.len()] };
        let at_zero = raw.force_and_stiffness(0.0).0;
        if at_zero.abs() > ROUND_OFF * largest {
            return Err(NotElastic::AtZero(at_zero));
        }
        if !strain.contains(&0.0) {
            let index = strain.partition_point(|strain| *strain < 0.0);
            strain.insert(index, 0.0);
            force.insert(index, 0.0);
        }
        let mut energy = vec![0.0];
        for (strain, force) in strain.windows(2).zip(force.windows(2)) {
            let last = energy[energy.len() - 1];
            energy.push(last + 0.5 * (force[0] + force[1]) * (strain[1] - strain[0]));
        }
        let zero = strain.iter().position(|strain| *strain == 0.0).map_or(0.0, |index| energy[index]);
        energy.iter_mut().for_each(|energy| *energy -= zero);
        Ok(Self { strain, force, energy })
    }

    /// The number of the piece that contains `strain`.
    #[inline]
    fn piece(&self, strain: f64) -> usize {
        self.strain.partition_point(|end| *end <= strain).clamp(1, self.strain.len() - 1) - 1
    }

    fn slope(&self, piece: usize) -> f64 {
        (self.force[piece + 1] - self.force[piece]) / (self.strain[piece + 1] - self.strain[piece])
    }

    /// The force, and its derivative by the strain.
    #[inline]
    pub fn force_and_stiffness(&self, strain: f64) -> (f64, f64) {
        let piece = self.piece(strain);
        let slope = self.slope(piece);
        (self.force[piece] + slope * (strain - self.strain[piece]), slope)
    }

    /// The energy at `strain`.
    pub fn energy(&self, strain: f64) -> f64 {
        let piece = self.piece(strain);
        let further = strain - self.strain[piece];
        self.energy[piece] + further * (self.force[piece] + 0.5 * self.slope(piece) * further)
    }

    /// The largest stiffness.
    pub fn stiffness(&self) -> f64 {
        (0..self.strain.len() - 1).map(|piece| self.slope(piece)).fold(0.0, f64::max)
    }

    /// Whether it has no stiffness on one side of its stress-free state, as that of a rope that resists tension only.
    pub fn goes_slack(&self) -> bool {
        let [below, above] = [self.piece(-f64::MIN_POSITIVE), self.piece(f64::MIN_POSITIVE)];
        self.slope(below) == 0.0 || self.slope(above) == 0.0
    }

    /// The stiffnesses on both sides of a corner at `strain`, or within `near` of its width.
    pub fn corner(&self, strain: f64, near: f64) -> Option<[f64; 2]> {
        let [first, last] = self.ends();
        let point = self.strain.iter().position(|point| (point - strain).abs() <= near * (last - first))?;
        let inner = (1..self.strain.len() - 1).contains(&point);
        let sides = inner.then(|| [self.slope(point - 1), self.slope(point)])?;
        ((sides[1] - sides[0]).abs() > near * self.stiffness()).then_some(sides)
    }

    /// The strains at which its stiffness jumps by more than this part of the largest.
    pub fn corners(&self, by: f64) -> impl Iterator<Item = f64> + '_ {
        let inner = self.strain.get(1..self.strain.len() - 1).unwrap_or_default();
        let jumps =
            move |point: &usize| (self.slope(*point) - self.slope(point - 1)).abs() > by * self.stiffness();
        (1..=inner.len()).filter(jumps).map(|point| self.strain[point])
    }

    /// The first and the last strain that it knows.
    pub fn ends(&self) -> [f64; 2] {
        [self.strain[0], self.strain[self.strain.len() - 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_where_the_stiffness_jumps() {
        let law =
            Elastic::new(vec![-1.0, 0.0, 0.1, 0.2, 0.3], vec![-100.0, 0.0, 10.0, 40.0, 70.0]).expect("a law");
        assert_eq!(law.corners(1e-9).collect::<Vec<_>>(), [0.1]);
        let straight = Elastic::new(vec![0.0, 1.0], vec![0.0, 2.0]).expect("a law");
        assert_eq!(straight.corners(1e-9).count(), 0);
    }

    /// Slack below 0, 100 up to 0.1, 300 beyond: energies by areas.
    #[test]
    fn forces_and_energies_of_a_rope() {
        let rope = Elastic::new(vec![-1.0, 0.0, 0.1, 0.2], vec![0.0, 0.0, 10.0, 40.0]).expect("a law");
        let at = |strain: f64| (rope.force_and_stiffness(strain), rope.energy(strain));
        assert_eq!(at(-2.0), ((0.0, 0.0), 0.0));
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        let ((force, stiffness), energy) = at(0.05);
        close(force, 5.0);
        close(stiffness, 100.0);
        close(energy, 0.125);
        let ((force, stiffness), energy) = at(0.3);
        close(force, 70.0);
        close(stiffness, 300.0);
        close(energy, 0.5 + 0.5 * (10.0 + 70.0) * 0.2);
        close(rope.stiffness(), 300.0);
        assert_eq!(rope.ends(), [-1.0, 0.2]);
    }

    /// A law that has no point at zero has its energy from there on; forces are those of the line.
    #[test]
    fn zero_need_not_be_among_the_points() {
        let law = Elastic::new(vec![-0.1, 0.3], vec![-1.0, 3.0]).expect("a law");
        assert_eq!(law.force_and_stiffness(0.2).0, 2.0);
        assert!((law.energy(0.2) - 0.2).abs() < 1e-15 && (law.energy(-0.2) - 0.2).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_law_is_refused() {
        let of = |strain: &[f64], force: &[f64]| Elastic::new(strain.to_vec(), force.to_vec()).err();
        assert_eq!(of(&[0.0], &[0.0]), Some(NotElastic::Lengths));
        assert_eq!(of(&[0.0, 1.0], &[0.0]), Some(NotElastic::Lengths));
        assert_eq!(of(&[0.0, 1.0, 1.0], &[0.0, 1.0, 2.0]), Some(NotElastic::Strain(2)));
        assert_eq!(of(&[0.0, 1.0, 2.0], &[0.0, 2.0, 1.0]), Some(NotElastic::Force(2)));
        assert_eq!(of(&[0.0, 1.0], &[1.0, 2.0]), Some(NotElastic::AtZero(1.0)));
        assert_eq!(of(&[-1.0, 1.0], &[0.0, 0.0]), Some(NotElastic::Flat));
    }

    /// Slopes of 1, 1 and 3 between −1, 0, 1 and 2: the one corner is at 1.
    #[test]
    fn corners_leave_out_points_on_straight_lines() {
        let law = Elastic::new(vec![-1.0, 0.0, 1.0, 2.0], vec![-1.0, 0.0, 1.0, 4.0]).expect("a law");
        let corner = |strain: f64| law.corner(strain, 1e-3);
        assert_eq!(corner(1.0), Some([1.0, 3.0]));
        // A thousandth of the width of 3 is as near as that.
        assert_eq!([1.0 + 2.9e-3, 1.0 - 2.9e-3].map(corner), [Some([1.0, 3.0]); 2]);
        assert_eq!([1.0 + 3.1e-3, 1.0 - 3.1e-3, -1.0, 0.0, 2.0, 0.5].map(corner), [None; 6]);
        // Slopes count as different beyond the same part of the largest, 3.
        let blunt = Elastic::new(vec![-1.0, 1.0, 2.0], vec![-1.0, 1.0, 2.004]).expect("a law");
        assert_eq!([1e-3, 5e-3].map(|near| blunt.corner(1.0, near).is_some()), [true, false]);
    }
}
