//! Newton's method, which knows nothing of loads or time.
//!
//! Convergence is judged by the increment in a scaled norm, which is what the user's accuracy
//! refers to, and by the scaled residual, which reveals a wrong tangent. Increments below the
//! tolerance that no longer shrink are the round-off of the forces, which then balance as well as
//! they can. Because convergence is quadratic, an increment δ_k with contraction Θ =
//! |δ_k|/|δ_{k−1}| leaves an error of about Θ² |δ_k|; iteration stops when that is below the
//! tolerance. The first contraction also tells the caller how far the predictor was from the
//! solution (Deuflhard, *Newton Methods for Nonlinear Problems*, 2004, ch. 5).

use crate::assembly::{Earlier, Node, nodes};
use crate::linear::Singular;
use crate::threads;
use std::ops::Range;

/// A nonlinear system of equations.
pub trait Equations {
    /// Writes the Newton increment at `x` to `increment` and returns the scaled residual at `x`.
    /// The tangent may use the iterate before.
    ///
    /// # Errors
    /// [`Singular`] where the tangent has no inverse.
    fn increment(&mut self, x: &[f64], earlier: Earlier<'_>, increment: &mut [f64]) -> Result<f64, Singular>;

    /// The scaled residual at `x`.
    fn residual(&mut self, x: &[f64]) -> f64;

    /// The scaled size of an increment.
    fn size(&self, increment: &[f64]) -> f64;

    /// `x += increment`.
    fn apply(&self, increment: &[f64], x: &mut [f64]) {
        for (x, d) in x.iter_mut().zip(increment) {
            *x += d;
        }
    }
}

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Largest error of the solution in the norm of the increments.
    pub tolerance: f64,
    /// Largest scaled residual; infinite: the increments alone decide.
    pub residual_tolerance: f64,
    /// Largest first increment: how far the prediction may be from the solution.
    pub first_increment: f64,
    /// Largest last increment: how far the last tangent may be from that of the solution.
    pub last_increment: f64,
    /// Give up after this many iterations.
    pub max_iterations: usize,
}

/// Largest scaled residual of a solution.
pub const RESIDUAL_TOLERANCE: f64 = 1e-6;

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            residual_tolerance: RESIDUAL_TOLERANCE,
            first_increment: f64::INFINITY,
            last_increment: f64::INFINITY,
            max_iterations: 16,
        }
    }
}

/// How the iteration went.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Iterations {
    /// Scaled increment of each iteration.
    pub increments: Vec<f64>,
    /// Scaled residual before each iteration.
    pub residuals: Vec<f64>,
}

/// Why the iteration did not converge.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The tangent has no inverse.
    #[error(transparent)]
    Singular(#[from] Singular),
    /// The prediction is so far from the solution that another one may be nearer.
    #[error("the prediction is {size:.2} of a beam length or rad off")]
    FarOff {
        /// The first scaled increment.
        size: f64,
    },
    /// Increments grow.
    #[error("the increments grow (the last is {last:.1e} of a beam length)")]
    Diverging {
        /// The last scaled increment.
        last: f64,
    },
    /// A force or an increment overflowed or is not a number.
    #[error("a force or an increment is not finite")]
    NotFinite,
    /// Converged, but so far from the prediction that it may be another equilibrium than the one
    /// that continues the path.
    #[error(
        "the solution lies {off:.2} {unit} from where the path's tangents lead, perhaps on another branch"
    )]
    OtherBranch {
        /// Largest turn of a node between solution and prediction, or turn that the path's tangents
        /// do not explain, if that is larger; the same of shifts where nothing turns.
        off: f64,
        /// What it is counted in.
        unit: &'static str,
    },
    /// A node's gradient has shrunk so far that the beam model no longer holds there.
    #[error(
        "the beam is crushed: |r'|, its length against the stress-free one, is down to {stretch:.2} at a node"
    )]
    Crushed {
        /// |r'| there; 0 where it has reversed.
        stretch: f64,
        /// The node.
        node: usize,
    },
    /// The path of the step leads through an obstacle, or into it too far for its force to be seen.
    #[error("the step would carry the beam through the obstacle of contact {}", contact + 1)]
    Crossed {
        /// Number of the contact.
        contact: usize,
        /// Part of the step that is clear of it.
        part: f64,
    },
    /// The step touches an obstacle on its way, and neither its start nor its end does.
    #[error("the step would touch the obstacle of contact {} and leave it again, unseen", contact + 1)]
    Unseen {
        /// Number of the contact.
        contact: usize,
    },
    /// Converged, but to an equilibrium that lies beyond a bifurcation, where a path that bends
    /// away may still be stable.
    #[error("the step ends beyond a bifurcation, perhaps on another branch")]
    Bifurcation,
    /// A step of a motion gains energy that no load puts in.
    #[error("the step would gain energy, {:.1} % of the kinetic", 100.0 * gain)]
    Gain {
        /// Energy gained, relative to the kinetic energy.
        gain: f64,
    },
    /// A torsion spring turns so far in a step that it could have turned the other way.
    #[error(
        "a torsion spring turns by {turn:.1} rad in one step, so that its turns cannot be counted; take smaller steps"
    )]
    Overwound {
        /// The turn \[rad\].
        turn: f64,
    },
    /// The limit of iterations was reached.
    #[error(
        "no convergence within {iterations} iterations (the last increment is {last:.1e} of a beam length)"
    )]
    TooSlow {
        /// Iterations made.
        iterations: usize,
        /// The last scaled increment.
        last: f64,
    },
    /// Steps of a motion err by as much, however short they are.
    #[error("ever shorter steps err no less")]
    StepsErr,
    /// The observer ended the analysis.
    #[error("it was stopped")]
    Stopped,
}

impl Failure {
    /// The first unknown of the node at which it shows, where it shows at one.
    pub fn unknown(&self) -> Option<usize> {
        match self {
            Self::Crushed { node, .. } => Some(4 * node),
            _ => None,
        }
    }
}

/// Increments that no longer shrink count as converged below this size: they are round-off.
pub(super) const ROUND_OFF: f64 = 1e-6;

/// Iterates from `x`, which receives the solution. `start` holds the state and the increment from
/// which `x` was predicted; the first tangent is extrapolated from them. `record` receives the
/// course of the iteration, also on failure.
///
/// # Errors
/// [`Failure`]; `x` is then meaningless.
pub fn solve(
    equations: &mut impl Equations,
    x: &mut [f64],
    start: Earlier<'_>,
    settings: &Settings,
    record: &mut Iterations,
) -> Result<(), Failure> {
    let mut before = start.q.to_vec();
    let mut last_increment = start.increment[..x.len()].to_vec();
    let mut increment = vec![0.0; x.len()];
    let (mut first, mut last) = (0.0, f64::INFINITY);
    for iteration in 0..settings.max_iterations {
        let earlier = Earlier { q: &before, increment: &last_increment };
        let residual = equations.increment(x, earlier, &mut increment)?;
        let size = equations.size(&increment);
        record.residuals.push(residual);
        record.increments.push(size);
        if !(size.is_finite() && residual.is_finite()) {
            return Err(Failure::NotFinite);
        }
        if iteration == 0 {
            first = size;
            if size > settings.first_increment {
                return Err(Failure::FarOff { size });
            }
        }
        let contraction = if iteration == 0 { 1.0 } else { size / last };
        let stalled = contraction > 0.5 && size <= ROUND_OFF;
        if !stalled && (size > 10.0 * first || (iteration >= 4 && contraction > 1.0)) {
            return Err(Failure::Diverging { last: size });
        }
        before.copy_from_slice(x);
        equations.apply(&increment, x);
        std::mem::swap(&mut increment, &mut last_increment);
        let remaining = size * contraction * contraction;
        if ((remaining <= settings.tolerance && size <= settings.last_increment) || stalled)
            && (size <= 1e-3 * settings.tolerance
                || (stalled && size <= settings.tolerance)
                || settings.residual_tolerance == f64::INFINITY
                || equations.residual(x) <= settings.residual_tolerance)
        {
            return Ok(());
        }
        last = size;
    }
    Err(Failure::TooSlow { iterations: settings.max_iterations, last })
}

/// |r'| at a node below which the beam counts as crushed. With Green's strain even a beam that is
/// compressed to a point and beyond has a force, which has long lost any meaning there.
const CRUSHED: f64 = 0.05;

/// Refuses coordinates in which a node's gradient has all but vanished.
///
/// # Errors
/// [`Failure::Crushed`] with the first such node.
pub fn not_crushed(q: &[f64]) -> Result<(), Failure> {
    let crushed = |[.., x, y]: &[f64; 4]| x * x + y * y < CRUSHED * CRUSHED;
    let nodes = q.as_chunks::<4>().0;
    let find = |range: Range<usize>, [nodes]: [&[[f64; 4]]; 1]| {
        nodes.iter().position(crushed).map(|node| range.start + node)
    };
    match threads::over([nodes], &find, &Option::or) {
        Some(node) => Err(Failure::Crushed { stretch: nodes[node][2].hypot(nodes[node][3]), node }),
        None => Ok(()),
    }
}

/// Refuses a step from `before` to `q` that reverses a node's gradient, or ends where it has all
/// but vanished.
///
/// # Errors
/// [`Failure::Crushed`] with the node.
pub fn not_crushed_since(before: &[f64], q: &[f64]) -> Result<(), Failure> {
    let along = |(a, b): (Node, Node)| a.gradient[0] * b.gradient[0] + a.gradient[1] * b.gradient[1];
    match nodes(before).zip(nodes(q)).position(|pair| along(pair) < 0.0) {
        Some(node) => Err(Failure::Crushed { stretch: 0.0, node }),
        None => not_crushed(q),
    }
}
