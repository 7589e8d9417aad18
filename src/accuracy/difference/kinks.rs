//! Kinks of strings.
//!
//! What acts in a point within a string gives it a corner there, which shape functions with continuous tangents round off. Its
//! length, tension and vibrations err by parts in proportion to the length of the cells beside it, and more evenly than other errors.

use crate::accuracy::mesh::Mesh;
use crate::model::{Model, Place};

/// Places this near to an end of a beam are at it, in beam lengths.
const SAME: f64 = 1e-9;

/// A place within a string where parts, joints or supports act in a point; `None` where there is none.
pub(in crate::accuracy) fn kink(model: &Model, meshes: &[Mesh]) -> Option<Place> {
    let within = |at: &Place| {
        let length = meshes[at.beam].length();
        at.s > SAME * length && at.s < (1.0 - SAME) * length
    };
    let of_string = |at: &Place| model.beams[at.beam].section.bending_stiffness.is_none();
    model.points().find(|at| of_string(at) && within(at))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{meshes, scene};
    use super::*;

    /// At its ends a string turns freely, and a beam has no kink.
    #[test]
    fn strings_have_kinks_where_something_acts_within_them() {
        let of = |force: &str| {
            let force = format!("static = {{}}\neffect.force = [{{ {force}, value = [0, -1] }}]");
            kink(scene(&force).model(), &meshes())
        };
        assert_eq!(of("beam = 'rope', at = 1.5"), Some(Place::new(1, 1.5)));
        assert_eq!([of("beam = 'rope', at = 'end'"), of("beam = 'arm', at = 1.5")], [None; 2]);
    }
}
