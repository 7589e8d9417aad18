//! Beams as they lie in a state.

use serde::Serialize;

/// The centrelines of all beams at one record.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Frame {
    /// Load factor or time.
    pub parameter: f64,
    /// Per beam: positions \[m\] at evenly spaced arc lengths.
    pub beams: Vec<Vec<[f64; 2]>>,
}

/// One beam sampled at 201 arc lengths or more. In the last state a point where a force or a couple
/// acts is there twice: before and behind it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Shape {
    /// Name of the beam.
    pub beam: String,
    /// Arc lengths \[m\].
    pub s: Vec<f64>,
    /// Positions along x \[m\].
    pub x: Vec<f64>,
    /// Positions along y \[m\].
    pub y: Vec<f64>,
    /// Direction of r' \[rad\], continuous along s.
    pub angle: Vec<f64>,
    /// ε, zero in the stress-free state.
    pub strain: Vec<f64>,
    /// κ \[1/m\].
    pub curvature: Vec<f64>,
    /// N \[N\], positive in tension; given for the last state alone, like Q and M. All three
    /// balance the forces that act on the beam before the cut.
    pub axial_force: Vec<f64>,
    /// Q \[N\], along the normal J r' on the side of the cut that looks to the beam's end.
    pub shear_force: Vec<f64>,
    /// M \[N m\], of the sign of EI κ.
    pub bending_moment: Vec<f64>,
    /// Positions of the nodes \[m\].
    pub nodes: Vec<[f64; 2]>,
}
