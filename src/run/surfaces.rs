//! What friction on the surface of a thick beam leaves out.

use crate::effect::Contact;
use crate::model::Model;
use crate::system::System;
use std::any::Any;

/// Part of a beam's length up to which the lever arm of friction, times its coefficient, does not matter.
const THIN: f64 = 1e-3;

/// A message for every contact whose friction acts on the surface of a thick beam. It is taken to act at
/// the centreline, without its couple h t per length and without the slip h θ̇ of a section that turns.
pub(super) fn couples(model: &Model, system: &System) -> impl Iterator<Item = String> {
    model.parts.iter().filter_map(|part| {
        let part: &dyn Any = part.as_ref();
        let contact = part.downcast_ref::<Contact>()?;
        let (beam, friction) = (model.beams.get(contact.beam)?, contact.friction?);
        let length = system.beams().get(contact.beam)?.basis.length();
        let lever = contact.half_thickness;
        (beam.section.bending_stiffness.is_some() && friction.coefficient * lever > THIN * length).then(|| {
            format!(
                "friction on beam `{}` acts at its centreline, and not at its surface {lever:.3e} m beside it: the couple of this lever arm, and \
                 the slip of a section that turns, are left out, so that rolling and tilting are wrong by about as much",
                beam.name
            )
        })
    })
}
