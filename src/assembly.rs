//! Densities at a point of the beam, and what sums them over its tables of shape functions.
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
//!
//! # From parts to terms
//! A [`Part`] is what takes part in the mechanics: a beam's own elasticity and inertia, loads,
//! springs, dampers, contacts, …. It knows the model in words (arc lengths, stiffnesses) and, asked
//! once when a system is built, hands densities to the [`Assembly`], which tabulates the shape
//! functions where the density is to be summed. What comes of all parts are the [`Terms`] of the
//! equations.

mod action;
mod assemble;
mod contact;
mod density;
mod discretized;
mod dissipation;
mod effect;
mod error;
mod history;
mod integral;
mod kind;
mod load;
mod moving;
mod node;
mod part;
mod terms;
mod winding;

pub use action::{Action, Actions, Side};
pub use assemble::Assembly;
pub use contact::{ContactEffect, CubicStates, FrictionEffect};
pub use density::{Density, Gradient, Hessian};
pub use discretized::DiscretizedBeam;
pub use dissipation::{Damping, Dissipation, Rayleigh};
pub use effect::{Earlier, Effect};
pub use error::BuildError;
pub use history::{AcceptedState, ContactPiece, InternalVariables};
pub use integral::{Integral, Workspace};
pub(crate) use integral::{add_tiles, multiply_rows};
pub use kind::Kind;
pub use load::{ActingLoad, Amplitude};
pub use moving::MovingLoad;
pub use node::{Node, nodes};
pub use part::{Extent, Part, Resistance};
pub use terms::{Needs, Terms, Turning};
pub use winding::Winding;
