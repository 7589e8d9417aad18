//! What round-off makes of curvatures and section forces that are none.

use crate::accuracy::mesh::Mesh;
use crate::model::{Analysis, Beam};
use crate::results::Shape;

/// Curvatures of straight beams, relative to the largest coordinate over the square of the shortest cell: second
/// differences of coordinates that are rounded.
const OF_COORDINATES: f64 = 2e-14;
/// Moments of straight beams about a cut, relative to the largest force times the largest coordinate …
const OF_ARMS: f64 = 1e-14;
/// … and all of them in motions, in which what round-off has bent goes on to vibrate: curvatures per length, and
/// moments relative to the largest force times the length.
const OF_MOTIONS: f64 = 1e-9;
/// Strains of strings.
const OF_STRAINS: f64 = 1e-13;
/// Of round-off two meshes do not agree to this part: what they agree about is none, however little it is against what
/// short cells could make.
const AGREED: f64 = 0.1;

/// Whether the largest value that a mesh has found tells something, where another one differs from it by so much and `none` is what
/// round-off makes.
pub fn tells(largest: f64, difference: f64, none: f64) -> bool {
    largest > none || difference < AGREED * largest
}

/// Less than this tells nothing of a beam.
#[derive(Clone, Copy, Debug, Default)]
pub struct Negligible {
    /// \[1/m\]
    pub curvature: f64,
    /// Axial and shear forces \[N\].
    pub force: f64,
    /// Moments of a beam that nothing loads \[N m\] …
    own_moment: f64,
    /// … and how they grow with the largest force \[m\].
    arm: f64,
}

impl Negligible {
    /// For a beam on the coarser of two meshes, of which the finer one has found this shape.
    pub fn of(beam: &Beam, mesh: &Mesh, shape: &Shape, analysis: &Analysis) -> Self {
        let length = mesh.length();
        let (bending, axial) = (&beam.section.bending_stiffness, &beam.section.axial_stiffness);
        if bending.is_none() {
            let force = axial.as_ref().map_or(0.0, |axial| OF_STRAINS * axial.mean(length));
            return Self { force, ..Self::default() };
        }
        let coordinates = shape.x.iter().chain(&shape.y);
        let farthest = coordinates.fold(length, |farthest, coordinate| farthest.max(coordinate.abs()));
        // The finer mesh has twice the cells.
        let shortest =
            0.5 * mesh.nodes.windows(2).map(|ends| ends[1] - ends[0]).fold(f64::INFINITY, f64::min);
        let of_mesh = OF_COORDINATES * farthest / (shortest * shortest);
        let (curvature, arm) = match analysis {
            Analysis::Dynamic(_) | Analysis::Stages => {
                (of_mesh.max(OF_MOTIONS / length), OF_MOTIONS * length)
            }
            _ => (of_mesh, OF_ARMS * farthest),
        };
        // Forces of cells that are not in balance add up along the beam.
        let own_moment =
            bending.as_ref().map_or(0.0, |bending| bending.mean(length)) * curvature * mesh.cells() as f64;
        Self { curvature, force: own_moment / length, own_moment, arm }
    }

    /// Bending moments \[N m\], where this is the largest force \[N\].
    pub fn moment(&self, force: f64) -> f64 {
        self.own_moment + self.arm * force
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::difference::tests::{meshes, scene};

    /// Cells of 0.5 m and 1.5 m, in either order, and halves of them, far from the origin; a string of 1 N.
    #[test]
    fn little_tells_nothing_of_a_beam() {
        let shape = Shape { x: vec![1.0, 3.0], y: vec![-8.0, 2.0], ..Shape::default() };
        let on = |mesh: &Mesh, analysis: &str, beam: usize| {
            let scene = scene(analysis);
            Negligible::of(&scene.model().beams[beam], mesh, &shape, scene.analysis())
        };
        let of = |analysis: &str, beam: usize| on(&meshes()[beam], analysis, beam);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12 * b;
        let still = of("static = {}", 0);
        assert!(near(still.curvature, 2e-14 * 8.0 * 16.0), "{still:?}");
        let other = on(&Mesh::of(&[0.0, 1.5, 2.0]), "static = {}", 0);
        assert!(near(other.curvature, still.curvature), "{other:?}");
        assert!(near(still.moment(0.0), 2.0 * still.curvature) && near(still.force, still.curvature));
        assert!(near(still.moment(1e9) - still.moment(0.0), 8e-5), "{still:?}");
        let moving = of("dynamic.duration = 1", 0);
        assert!(near(moving.curvature, 5e-10) && near(moving.moment(3.0), 1e-9 + 6e-9), "{moving:?}");
        assert!(tells(2.0, 2.0, 1.0) && tells(1.0, 0.09, 2.0));
        assert!(!tells(1.0, 0.11, 2.0) && !tells(0.0, 0.0, 0.0));
        let string = of("static = {}", 1);
        assert_eq!((string.curvature, string.force, string.moment(1.0)), (0.0, 1e-13, 0.0));
    }
}
