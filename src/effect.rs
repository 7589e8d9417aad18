//! Physics as densities at a point of the beam.
//!
//! An effect is a function W of a few local fields z = (r⁽ᵒ¹⁾, r⁽ᵒ²⁾, …): the position r, the
//! gradient r' and its derivative r'' at one arc length s. With the shape functions r⁽ᵒ⁾(s) = Σ_a
//! N_a⁽ᵒ⁾(s) q_a, everything that a solver asks for follows from the first and second derivatives
//! of W at that point:
//!
//! ```text
//! energy     U   = ∫ W(z) ds
//! force      f_a = ∫ Σ_m N_a⁽ᵒᵐ⁾ ∂W/∂z_m ds
//! tangent    K_ab = ∫ Σ_m Σ_n N_a⁽ᵒᵐ⁾ ∂²W/∂z_m∂z_n N_b⁽ᵒⁿ⁾ ds
//! ```
//!
//! A [`Density`] gives W and its derivatives and knows no node, no step and no other effect; an
//! [`Integral`] sums it over a table of shape functions. A load that has no energy (a follower
//! force) is a density that gives its virtual work's coefficients as "∂W/∂z" and their derivatives
//! as "∂²W/∂z∂z", which then is not symmetric.
//!
//! # The tangent between two iterates
//! The stress resultants that enter the tangent's second term (N for stretch, M for bend) are taken
//! by linear extrapolation from the previous iterate, S = C (ε(z⁻) + ∂ε/∂z Δz), and not from the
//! strain at the current one. This is Newton's method on the mixed problem in which S is an unknown
//! of its own at every quadrature point, with S eliminated (Magisano, Leonetti, Garcea, *Int. J.
//! Numer. Meth. Engng* 109, 2017, 1237–1262). The equilibria are the same and convergence stays
//! quadratic; but a slender beam's large EA no longer turns the strain of a not yet converged
//! rotation into an enormous axial force, so that steps can be many times longer. With z⁻ = z and
//! Δz = 0 it is the ordinary tangent. Δz is that of the increment; the current iterate may have
//! been moved along it with turns that are finite.

mod action;
mod actuation;
mod bend;
mod contact;
mod damping;
mod direction;
mod dissipation;
mod drag;
mod force;
mod foundation;
mod history;
mod inertia;
mod integral;
mod mass;
mod moving;
mod spring;
mod stretch;
mod winding;

pub use action::{Action, Actions, Side};
pub use actuation::{Actuation, PreCurvature, PreStrain};
pub use bend::{Bend, curvature};
pub use contact::{Contact, ContactIntegral, Friction, FrictionIntegral, Obstacle, Penalty, Piece};
pub use damping::{BeamDamping, BendDamping, MassDamping, StretchDamping};
pub use dissipation::{Damping, Dissipation, Rayleigh};
pub use drag::{Buoyancy, Drag, SteadyDrag};
pub use force::{DeadForce, FollowerForce, Moment};
pub use foundation::Foundation;
pub use history::{AcceptedState, InternalVariables};
pub use inertia::Inertia;
pub use integral::{Integral, Workspace};
pub use mass::{Gyration, PointMass, RotaryInertia, SectionInertia};
pub use moving::{MovingForce, Travelling};
pub use spring::{Dashpot, GroundSpring, Spring, Strut, Torsion, TorsionDashpot, TorsionSpring};
pub use stretch::{Engineering, Green, Strain, Stretch};
pub use winding::{Direction, Winding};

use crate::lanes::{self, Lanes, Pair, Points, Square};
use crate::linear::Matrix;
use nalgebra::{Matrix2, Vector2};

/// First derivatives of a density by each of its local fields.
pub type Gradient<const M: usize> = [Vector2<f64>; M];

/// Second derivatives of a density: block (m, n) is ∂²W/∂z_m∂z_n.
pub type Hessian<const M: usize> = [[Matrix2<f64>; M]; M];

/// A quantity per unit of arc length that depends on `M` local fields.
pub trait Density<const M: usize>: Send + Sync {
    /// The local fields, as derivative orders of r in rising order: `[1, 2]` for (r', r'').
    const ORDERS: [usize; M];

    /// Whether ∂²W/∂z∂z is symmetric, as it is for everything that has an energy.
    const SYMMETRIC: bool = true;

    /// Whether ∂²W/∂z∂z is more than zero; where it is not, the force is constant and no tangent is
    /// assembled.
    const HAS_TANGENT: bool = true;

    /// Whether the force has the potential W; where it has not, its work is summed up along the
    /// motion.
    const CONSERVATIVE: bool = true;

    /// W at quadrature point number `point` \[J/m\]; zero for what has no energy.
    fn energy(&self, point: usize, z: &Gradient<M>) -> f64;

    /// ∂W/∂z.
    fn gradient(&self, point: usize, z: &Gradient<M>) -> Gradient<M>;

    /// Whether [`Self::gradients`] is faster than four times [`Self::gradient`].
    const BY_FOURS: bool = false;

    /// `factor · ∂W/∂z` at four points.
    #[inline(always)]
    fn gradients(&self, factor: f64, points: Points, z: &[Pair<Lanes>; M]) -> [Pair<Lanes>; M] {
        let numbers = points.numbers();
        let gradients: [Gradient<M>; 4] =
            std::array::from_fn(|lane| self.gradient(numbers[lane], &lane_of(z, lane)).map(|g| g * factor));
        std::array::from_fn(|m| {
            let part = |d: usize| Lanes::new(std::array::from_fn(|lane| gradients[lane][m][d]));
            [part(0), part(1)]
        })
    }

    /// `factor` times what [`Self::gradient_and_hessian`] gives for the states z, before and
    /// change, at four points.
    #[inline(always)]
    fn gradients_and_hessians(
        &self,
        factor: f64,
        points: Points,
        states: [&[Pair<Lanes>; M]; 3],
    ) -> ([Pair<Lanes>; M], [[Square<Lanes>; M]; M]) {
        let numbers = points.numbers();
        let of_lanes: [(Gradient<M>, Hessian<M>); 4] = std::array::from_fn(|lane| {
            let [z, before, change] = states.map(|z| lane_of(z, lane));
            self.gradient_and_hessian(numbers[lane], &z, &before, &change)
        });
        let in_lanes = |of: &dyn Fn(&(Gradient<M>, Hessian<M>)) -> f64| {
            Lanes::new(std::array::from_fn(|lane| factor * of(&of_lanes[lane])))
        };
        use std::array::from_fn;
        let gradient = from_fn(|m| from_fn(|d| in_lanes(&|(gradient, _)| gradient[m][d])));
        let entry = |m: usize, n: usize, d: usize, e: usize| in_lanes(&|(_, hessian)| hessian[m][n][(d, e)]);
        (gradient, from_fn(|m| from_fn(|n| from_fn(|d| from_fn(|e| entry(m, n, d, e))))))
    }

    /// ∂W/∂z and ∂²W/∂z∂z, stress resultants in the latter extrapolated from the iterate `before`
    /// by the `change` that was computed there.
    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<M>,
        before: &Gradient<M>,
        change: &Gradient<M>,
    ) -> (Gradient<M>, Hessian<M>);
}

/// The local fields in one of four points.
#[inline(always)]
fn lane_of<const M: usize>(z: &[Pair<Lanes>; M], lane: usize) -> Gradient<M> {
    z.map(|pair| Vector2::from(pair.map(|lanes| lanes.to_array()[lane])))
}

/// The iterate before the present one, from which stress resultants are extrapolated.
#[derive(Clone, Copy, Debug)]
pub struct Earlier<'a> {
    /// Its coordinates.
    pub q: &'a [f64],
    /// The increment computed there: linear, whatever the present iterate was made of it.
    pub increment: &'a [f64],
}

/// What an effect is, for energies and inventories.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Axial strain energy.
    Stretch,
    /// An axis that keeps its length, by constraint.
    Inextensibility,
    /// Bending strain energy.
    Bend,
    /// Kinetic energy of the centreline.
    Inertia,
    /// Weight.
    Gravity,
    /// Concentrated force.
    Force,
    /// Concentrated moment.
    Moment,
    /// Force per length.
    DistributedForce,
    /// Damping of a beam's motion and deformation.
    Damping,
    /// Spring to the ground.
    Spring,
    /// Dashpot to the ground.
    Dashpot,
    /// Torsional spring to the ground.
    TorsionSpring,
    /// Torsional dashpot to the ground.
    TorsionDashpot,
    /// Mass at a point.
    PointMass,
    /// Rotary inertia of a point or of sections.
    RotaryInertia,
    /// Elastic foundation.
    Foundation,
    /// Strain that a beam would take by itself.
    PreStrain,
    /// Curvature that a beam would take by itself.
    PreCurvature,
    /// Resistance of a fluid.
    Drag,
    /// Lift by a displaced fluid.
    Buoyancy,
    /// Contact with an obstacle.
    Contact,
    /// Friction in a contact.
    Friction,
    /// Force that travels along a beam.
    MovingForce,
    /// An effect that another crate brings.
    Other(&'static str),
}

impl Kind {
    /// All kinds that exist here.
    pub const ALL: [Self; 23] = [
        Self::Stretch,
        Self::Inextensibility,
        Self::Bend,
        Self::Inertia,
        Self::Gravity,
        Self::Force,
        Self::Moment,
        Self::DistributedForce,
        Self::Damping,
        Self::Spring,
        Self::Dashpot,
        Self::TorsionSpring,
        Self::TorsionDashpot,
        Self::PointMass,
        Self::RotaryInertia,
        Self::Foundation,
        Self::PreStrain,
        Self::PreCurvature,
        Self::Drag,
        Self::Buoyancy,
        Self::Contact,
        Self::Friction,
        Self::MovingForce,
    ];

    /// The name used in scenes and inventories.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stretch => "stretch",
            Self::Inextensibility => "inextensibility",
            Self::Bend => "bend",
            Self::Inertia => "inertia",
            Self::Gravity => "gravity",
            Self::Force => "force",
            Self::Moment => "moment",
            Self::DistributedForce => "distributed_force",
            Self::Damping => "damping",
            Self::Spring => "spring",
            Self::Dashpot => "dashpot",
            Self::TorsionSpring => "torsion_spring",
            Self::TorsionDashpot => "torsion_dashpot",
            Self::PointMass => "point_mass",
            Self::RotaryInertia => "rotary_inertia",
            Self::Foundation => "foundation",
            Self::PreStrain => "pre_strain",
            Self::PreCurvature => "pre_curvature",
            Self::Drag => "drag",
            Self::Buoyancy => "buoyancy",
            Self::Contact => "contact",
            Self::Friction => "friction",
            Self::MovingForce => "moving_force",
            Self::Other(name) => name,
        }
    }
}

impl serde::Serialize for Kind {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// A density summed over a beam: what a system is made of.
///
/// Coordinates `q` and forces `f` are those of the whole system, `[x, y, x', y']` node after node.
pub trait Effect: Send + Sync {
    /// What it is.
    fn kind(&self) -> Kind;

    /// Index of the beam on which it acts.
    fn beam(&self) -> usize;

    /// Whether its tangent is symmetric.
    fn is_symmetric(&self) -> bool;

    /// Whether its force is the same in all states.
    fn is_constant(&self) -> bool;

    /// Whether its force has a potential.
    fn is_conservative(&self) -> bool;

    /// U \[J\].
    fn energy(&self, q: &[f64]) -> f64;

    /// `f += factor · ∂U/∂q`.
    fn add_force(&self, factor: f64, q: &[f64], f: &mut [f64]);

    /// The same in the states of four lanes, each with its own factor; `scratch` has two vectors of
    /// coordinates.
    fn add_forces(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes], scratch: &mut [Vec<f64>; 2]) {
        let factors = factors.to_array();
        lanes::one_by_one(q, f, scratch, |lane, q, f| self.add_force(factors[lane], q, f));
    }

    /// `f += factor · ∂U/∂q`, `k += factor · ∂²U/∂q∂q`, the latter with stress resultants
    /// extrapolated from an earlier iterate, if there is one.
    fn add_force_and_tangent(
        &self,
        factor: f64,
        q: &[f64],
        earlier: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    );

    /// `f += factor · ∂²U/∂q∂q v`, from point to point without a matrix: what differs by little
    /// between neighbouring nodes is differentiated before it is multiplied by a large stiffness,
    /// so that fine meshes cost few digits.
    fn add_tangent_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]);

    /// What it does to its beam in the state `q`, times `factor`; a kinetic energy with the
    /// accelerations `a` of the coordinates, all else with `a` the same as `q`.
    fn add_actions(&self, factor: f64, q: &[f64], a: &[f64], sum: &mut Actions);

    /// Quadrature points, and bytes of its tables and data.
    fn size(&self) -> (usize, usize);
}

/// An effect that is asked for more elsewhere.
impl<E: Effect + ?Sized> Effect for std::sync::Arc<E> {
    fn kind(&self) -> Kind {
        (**self).kind()
    }

    fn beam(&self) -> usize {
        (**self).beam()
    }

    fn is_symmetric(&self) -> bool {
        (**self).is_symmetric()
    }

    fn is_constant(&self) -> bool {
        (**self).is_constant()
    }

    fn is_conservative(&self) -> bool {
        (**self).is_conservative()
    }

    fn energy(&self, q: &[f64]) -> f64 {
        (**self).energy(q)
    }

    fn add_force(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        (**self).add_force(factor, q, f);
    }

    fn add_forces(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes], scratch: &mut [Vec<f64>; 2]) {
        (**self).add_forces(factors, q, f, scratch);
    }

    fn add_force_and_tangent(
        &self,
        factor: f64,
        q: &[f64],
        earlier: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        (**self).add_force_and_tangent(factor, q, earlier, f, k, workspace);
    }

    fn add_tangent_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        (**self).add_tangent_product(factor, q, v, f);
    }

    fn add_actions(&self, factor: f64, q: &[f64], a: &[f64], sum: &mut Actions) {
        (**self).add_actions(factor, q, a, sum);
    }

    fn size(&self) -> (usize, usize) {
        (**self).size()
    }
}
