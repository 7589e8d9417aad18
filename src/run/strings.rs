//! Demands of a model on its strings that a string cannot meet.

use crate::model::{FixedRotation, Joint, Model, Place};
use crate::numeric::plain;

/// A message for every place where a string, which has no bending stiffness, has a fixed direction
/// or carries a couple. It transmits no couple: only its first cells would bend, whatever their
/// length, so that the result depends on the mesh.
pub(super) fn couples(model: &Model) -> impl Iterator<Item = String> {
    let supports = model.supports.iter().enumerate();
    let supports = supports.filter(|(_, support)| support.fix.rotation != FixedRotation::Free);
    let supports =
        supports.map(|(i, support)| (format!("support {} holds its direction", i + 1), support.at));
    let welds = model.joints.iter().enumerate().flat_map(|(i, joint)| {
        let places = match *joint {
            Joint::Weld { first, second } => vec![first, second],
            Joint::Hinge { .. } | Joint::Slider { .. } => Vec::new(),
        };
        places.into_iter().map(move |at| (format!("joint {} welds it", i + 1), at))
    });
    let parts = model.parts.iter().filter_map(|part| part.couple());
    let parts = parts.map(|at| ("a moment, a torsion spring or rotary inertia acts on it".to_owned(), at));
    let on_strings = |(what, at): (String, Place)| {
        let beam = model.beams.get(at.beam).filter(|beam| beam.section.bending_stiffness.is_none())?;
        Some(format!(
            "beam `{}` has no `bending_stiffness`, and {what} at s = {} m: a string passes no couple on and turns freely, so that \
             the shape there depends on the mesh; leave it out, or give the beam a bending stiffness",
            beam.name,
            plain(at.s, 6),
        ))
    };
    supports.chain(welds).chain(parts).filter_map(on_strings)
}
