//! Small numerical tools that do not depend on beams: Gauss rules with few points, cubic splines,
//! formulas, numbers in messages, places at which to look.

mod decimals;
mod formula;
mod gauss;
mod spline;
mod spread;

pub use decimals::plain;
pub use formula::Formula;
pub use gauss::{GAUSS_2, GAUSS_3, GAUSS_6, GAUSS_10};
pub use spline::{End, rates};
pub use spread::{GOLDEN, spread};
