//! Densities at a point of a beam, and their sums over tables of shape functions.
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
//! A [`Density`] gives W and its derivatives; it does not know nodes, steps or other effects. An
//! [`Integral`] sums it over a table of shape functions. A load without an energy, such as a
//! follower force, is a density whose "∂W/∂z" are the coefficients of its virtual work, and whose
//! "∂²W/∂z∂z" are the derivatives of these, which need not be symmetric.
//!
//! # The tangent between two iterates
//! In the second term of the tangent, the stress resultants (N for stretch, M for bend) are
//! extrapolated linearly from the previous iterate, S = C (ε(z⁻) + ∂ε/∂z Δz), instead of being
//! computed from the strain at the current one. This is Newton's method on the mixed problem in
//! which S is an unknown of its own at every quadrature point, with S eliminated (Magisano,
//! Leonetti, Garcea, *Int. J. Numer. Meth. Engng* 109, 2017, 1237–1262). The equilibria are the
//! same and convergence stays quadratic, but in a slender beam the strain of a rotation that has
//! not converged yet no longer causes, through the large EA, an enormous axial force; steps can
//! therefore be many times longer. With z⁻ = z and Δz = 0 the tangent is the ordinary one. Δz is
//! the increment as the linear system gave it; the current iterate may differ from z⁻ + Δz, since
//! finite rotations may have been applied along the increment.
//!
//! # From parts to terms
//! A [`Part`] is anything that takes part in the mechanics: a beam's own elasticity and inertia,
//! loads, springs, dampers, contacts, …. It describes itself by arc lengths and stiffnesses. When a
//! system is built, each part is asked once to hand its densities to the [`Assembly`], which
//! tabulates the shape functions where the densities are to be summed. All parts together yield the
//! [`Terms`] of the equations.

mod action;
mod assemble;
mod contact;
mod density;
mod discretized;
mod dissipation;
mod effect;
mod error;
mod held;
mod history;
mod integral;
mod kind;
mod load;
mod node;
mod part;
mod tendon;
mod terms;
mod timed;
mod weighted;
mod winding;

pub use action::{Action, Actions, Side};
pub use assemble::Assembly;
pub use contact::{ContactEffect, CubicStates, FrictionEffect};
pub use density::{CompiledFor, Density, Gradient, Hessian};
pub use discretized::DiscretizedBeam;
pub use dissipation::{Damping, Dissipation, Rayleigh};
pub use effect::{Earlier, Effect};
pub use error::BuildError;
pub use held::HeldLength;
pub use history::{AcceptedState, ContactPiece, InternalVariables};
pub use integral::{Integral, Workspace};
pub(crate) use integral::{add_tiles, multiply_rows};
pub use kind::Kind;
pub use load::{Acting, ActingLoad, Amplitude, remaining};
pub use node::{Node, nodes};
pub use part::{Extent, Imposed, Part, Resistance, edges_along};
pub use tendon::TendonPath;
pub use terms::{Needs, Owner, Owners, Terms, Turning};
pub use timed::{TimedDensity, TimedIntegral, TimedLoad};
pub use weighted::Weighted;
pub use winding::Winding;
