//! The parts of a model and their extents.

use super::{Assembly, BuildError, TendonPath};
use crate::basis::{BasisTable, Quadrature};
use crate::beam::{Along, Place, ProductRule};
use crate::law::Law;
use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// Anything that takes part in the mechanics besides supports and joints: elasticity, inertia,
/// loads, springs, contacts. It is [`Any`], so that code that reads a model can recognise the kinds
/// of parts that it knows.
pub trait Part: Any + fmt::Debug + Send + Sync {
    /// Adds the part's densities to the equations under assembly.
    ///
    /// # Errors
    /// [`BuildError`] where the part does not fit the model.
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError>;

    /// Whether it fades as it is where it has gone in a later static analysis: one that acts in an
    /// equilibrium by loads and energies alone. What another part has done fades as forces on nodes.
    fn fades(&self) -> bool {
        false
    }

    /// What an actuation imposes on beam `beam`.
    fn actuation(&self, _beam: usize) -> Option<Imposed<'_>> {
        None
    }

    /// The tendon that it is, the index of its beam, and its law of time.
    fn tendon(&self) -> Option<(usize, &TendonPath, Option<&Law>)> {
        None
    }

    /// Places that are to be nodes, because the curvature of the beam jumps there for another reason
    /// than a couple, or its slope does so much that a cell would not see what lies between, or because the part ends there.
    fn jumps(&self) -> Vec<Place> {
        Vec::new()
    }

    /// Places at which what the part does along a beam jumps, where it begins or ends for instance, or has a corner. They need not be nodes, but what
    /// a mesh errs by depends on where in a cell they lie.
    fn edges(&self) -> Vec<Place> {
        Vec::new()
    }

    /// The outline of an obstacle on the ground, as a line for pictures; `size` is the size of the
    /// beams \[m\].
    fn outline(&self, _size: f64) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// The place at which the part transmits a couple, where the curvature of the beam may jump.
    fn couple(&self) -> Option<Place> {
        None
    }

    /// The point at which it acts, where it acts at a single one: there the shear force jumps.
    fn point(&self) -> Option<Place> {
        None
    }

    /// The motions that the part may resist by elasticity against the ground. They are used to
    /// refuse models with a motion that nothing resists.
    fn resists(&self) -> Vec<Resistance> {
        Vec::new()
    }

    /// Whether its forces depend on the path to a state: those of friction.
    fn has_memory(&self) -> bool {
        false
    }

    /// What its internal variables belong to, the place of a torsion spring or a rough obstacle: a part there with other
    /// coefficients goes on with them. None where it has no such variables.
    fn remembers(&self) -> Option<String> {
        None
    }

    /// A mass \[kg\] on which gravity acts, and its place.
    fn mass(&self) -> Option<(Place, f64)> {
        None
    }
}

/// The places of beam `beam` at which quantities along it jump, or their slopes do so much that it matters.
pub fn edges_along<'q>(beam: usize, quantities: impl IntoIterator<Item = &'q Along>) -> Vec<Place> {
    let places = quantities.into_iter().flat_map(|quantity| quantity.edges());
    places.map(|s| Place::new(beam, s)).collect()
}

/// Strains that an actuation imposes on a beam.
#[derive(Clone, Copy, Debug)]
pub struct Imposed<'p> {
    /// The strain.
    pub strain: &'p Along,
    /// The curvature \[1/m\].
    pub curvature: &'p Along,
    /// Index of the layer on which the strain is imposed; `None` for the whole section.
    pub layer: Option<usize>,
    /// The law of time that both follow.
    pub law: Option<&'p Law>,
}

/// A motion of a beam against the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resistance {
    /// Displacement of a point along an axis.
    Displacement(Place, [f64; 2]),
    /// Rotation of the direction at a point.
    Direction(Place),
    /// Any motion of a whole beam, if something presses it against an obstacle.
    Contact(usize),
}

/// Two parts are equal if their `Debug` output is the same.
impl PartialEq for dyn Part {
    fn eq(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
    }
}

/// The region over which a density is summed.
#[derive(Clone, Debug, PartialEq)]
pub enum Extent {
    /// Over a whole beam, by a quadrature rule in every cell.
    Beam(usize, Quadrature),
    /// Over a whole beam, times a factor that varies along it; where the factor is not smooth,
    /// cells are divided.
    Weighted(usize, Quadrature, Arc<Along>),
    /// Over a whole beam, times a factor f that varies along it, by product integration: at the points of the
    /// rule alone, where f is not smooth with 1/wᵢ ∫ ℓᵢ f ds in place of f, ℓᵢ being Lagrange's polynomials.
    Whole(usize, Quadrature, Arc<Along>),
    /// At one point, with weight 1.
    Point(Place),
}

impl Extent {
    /// A density with the coefficient `quantity` over a whole beam: the coefficient to give to the
    /// density, and the extent over which to sum it. A quantity that varies is a factor of the
    /// extent, and one that does not costs nothing.
    pub fn along(beam: usize, rule: Quadrature, quantity: &Along) -> (f64, Self) {
        match quantity.constant() {
            Some(value) => (value, Self::Beam(beam, rule)),
            None => (1.0, Self::Weighted(beam, rule, Arc::new(quantity.clone()))),
        }
    }

    /// As [`Self::along`] for what resists stretch: cells are not divided, since with more points than the rule has slender beams would lock.
    pub fn along_whole_cells(beam: usize, rule: Quadrature, quantity: &Along) -> (f64, Self) {
        match quantity.constant() {
            Some(value) => (value, Self::Beam(beam, rule)),
            None => (1.0, Self::Whole(beam, rule, Arc::new(quantity.clone()))),
        }
    }

    /// A density over a whole beam whose cells are divided at these arc lengths \[m\], which rise.
    pub fn divided(beam: usize, rule: Quadrature, at: &[f64]) -> Self {
        if at.is_empty() {
            return Self::Beam(beam, rule);
        }
        Self::Weighted(
            beam,
            rule,
            Arc::new(Along::Pieces { until: at.to_vec(), value: vec![1.0; at.len() + 1] }),
        )
    }

    /// The factor at each point of its table, where there is one.
    pub(super) fn factors(&self, table: &BasisTable) -> Option<Vec<f64>> {
        match self {
            Self::Weighted(_, _, factor) => {
                Some(places(table).map(|[s, inside]| factor.at(s, inside)).collect())
            }
            Self::Whole(_, rule, factor) => {
                let rule = ProductRule::new(*rule).ok()?;
                let cells = table.cells.iter().zip(table.s.chunks(table.points_per_cell));
                let values = cells.flat_map(|(cell, places)| {
                    let length = table.block(*cell).0.iter().sum();
                    rule.values(factor, places, length)
                });
                Some(values.collect())
            }
            Self::Beam(..) | Self::Point(_) => None,
        }
    }

    /// As [`Self::along`] for a density with two coefficients that adds up from both: one sum for
    /// constant coefficients, else one for each that is not zero.
    pub fn pairs_along(beam: usize, rule: Quadrature, pair: &[Along; 2]) -> Vec<(Self, [f64; 2])> {
        if let [Some(first), Some(second)] = pair.each_ref().map(Along::constant) {
            return vec![(Self::Beam(beam, rule), [first, second])];
        }
        let of_one = |index: usize| {
            let (value, extent) = Self::along(beam, rule, &pair[index]);
            let mut both = [0.0; 2];
            both[index] = value;
            (extent, both)
        };
        (0..2).filter(|index| !pair[*index].is_zero()).map(of_one).collect()
    }

    /// Index of the beam.
    pub fn beam(&self) -> usize {
        match self {
            Self::Beam(beam, _) | Self::Weighted(beam, ..) | Self::Whole(beam, ..) => *beam,
            Self::Point(place) => place.beam,
        }
    }
}

/// The arc length of each point of a table, and that of the middle of its cell \[m\].
pub(super) fn places(table: &BasisTable) -> impl Iterator<Item = [f64; 2]> + '_ {
    table.s.chunks(table.points_per_cell).flat_map(|places| {
        let middle = places.iter().sum::<f64>() / places.len() as f64;
        places.iter().map(move |s| [*s, middle])
    })
}
