//! The continuous problem: beams, sections, supports, loads and probes, all in SI units.
//!
//! A model does not contain nodes, elements or steps. A scene file is one way to make a [`Model`];
//! a program that uses the library can fill one directly.

mod accuracy;
mod analysis;
mod defaults;
mod event;
pub mod freedom;
mod initial_shape;
mod joint;
mod stage;
mod velocity;

pub use accuracy::{Accuracy, Open};
pub use analysis::*;
pub use defaults::*;
pub use event::{Crossing, EventCondition, EventKind, ProbeQuantity};
pub use initial_shape::InitialShape;
pub use joint::Joint;
pub use stage::Stage;
pub use velocity::{InitialVelocity, Profile};

pub use crate::basis::{Discretization, Kernel, Nodes, SideCondition};
pub use crate::beam::{Along, Beam, Elastic, GaussPoints, Layer, NotElastic, Place, Section, StrainMeasure};
pub use crate::centreline::Centreline;
pub use crate::law::{Expression, Law, Tabulated};

use crate::assembly::{Part, Resistance};
use crate::centreline::Curve;
use std::sync::Arc;

/// A complete mechanical model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// A title of one line.
    pub title: String,
    /// The beams; everything else refers to them by index.
    pub beams: Vec<Beam>,
    /// Supports: points at which quantities are fixed or follow a prescribed motion.
    pub supports: Vec<Support>,
    /// Joints between beams, and between beams and the ground.
    pub joints: Vec<Joint>,
    /// Everything that takes part besides the beams' own elasticity and inertia: loads, damping,
    /// springs, masses, contacts, ….
    pub parts: Vec<Arc<dyn Part>>,
    /// Shapes in which beams are at the start, where these are not the stress-free ones.
    pub initial_shapes: Vec<InitialShape>,
    /// Velocities of the beams at the start of a motion; a beam without an entry is at rest.
    pub initial_velocities: Vec<InitialVelocity>,
    /// Points whose motion is recorded.
    pub probes: Vec<Probe>,
    /// Further quantities to compute at every record.
    pub outputs: Outputs,
    /// Where an analysis starts from a state that another one has left: what has acted in it
    /// already, as indices of [parts](Self::parts). In statics their loads act in full from the
    /// beginning, where all others grow with the load factor. Joints may be open in the state.
    pub standing: Option<Vec<usize>>,
    /// What acted in that state and has gone, if it [fades](Part::fades), with the time of the state \[s\].
    pub fading: Vec<(Arc<dyn Part>, f64)>,
    /// What comes after the state from which the stage starts that this is the model of: nothing that acted in that state is the same, though
    /// it may be said in the same words.
    pub entering: Entering,
    /// The numbers by which results name the supports and the joints, where these are not 1, 2, 3, …:
    /// those of the scene, of which a stage may have fewer.
    pub numbers: [Vec<usize>; 2],
    /// Places at which there is a node although nothing in the model asks for one: where other
    /// stages of the same scene need it.
    pub nodes_at: Vec<Place>,
}

/// What comes with a stage, as indices of the lists of its model.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Entering {
    /// Of [supports](Model::supports).
    pub supports: Vec<usize>,
    /// Of [joints](Model::joints).
    pub joints: Vec<usize>,
    /// Of [parts](Model::parts).
    pub parts: Vec<usize>,
}

impl Model {
    /// Adds a part to the model.
    pub fn add(&mut self, part: impl Part) {
        self.parts.push(Arc::new(part));
    }

    /// Whether part number `part` has acted already in the state from which a static analysis
    /// starts.
    pub fn stands(&self, part: usize) -> bool {
        self.standing.as_ref().is_some_and(|standing| standing.contains(&part))
    }

    /// Whether any beam has no axial stiffness, and so keeps its length.
    pub fn is_inextensible(&self) -> bool {
        self.beams.iter().any(|beam| beam.section.axial_stiffness.is_none())
    }

    /// Whether some beam may touch an obstacle.
    pub fn has_contact(&self) -> bool {
        let touches = |part: &Arc<dyn Part>| {
            part.resists().iter().any(|resistance| matches!(resistance, Resistance::Contact(_)))
        };
        self.parts.iter().any(touches)
    }

    /// Whether some beam is held by friction, whose forces depend on the path to a state.
    pub fn has_friction(&self) -> bool {
        self.parts.iter().any(|part| part.has_memory())
    }

    /// Where parts, joints and supports act in a point.
    pub fn points(&self) -> impl Iterator<Item = Place> {
        let parts = self.parts.iter().filter_map(|part| part.point());
        parts
            .chain(self.joints.iter().flat_map(Joint::places))
            .chain(self.supports.iter().map(|support| support.at))
    }

    /// The arc lengths \[m\] along a beam at which what parts do along it [jumps or has a corner](Part::edges), or the curvature of its
    /// centreline has a corner.
    pub fn edges(&self, beam: usize) -> Vec<f64> {
        let edges = self.parts.iter().flat_map(|part| part.edges());
        let edges = edges.filter(|at| at.beam == beam).map(|at| at.s);
        // A centreline that is none is refused where the model is built.
        let corners = Curve::new(&self.beams[beam].centreline).map_or_else(
            |_| Vec::new(),
            |curve| {
                let s: Vec<f64> = [vec![0.0], curve.kinks(), vec![curve.length()]].concat();
                let value = s.iter().map(|s| curve.curvature(*s)).collect();
                Along::Table { s, value }.edges()
            },
        );
        edges.chain(corners).collect()
    }

    /// The arc lengths \[m\] along a beam at which there must be a node and supports of shape
    /// functions must end: at joints, where a support or a part transmits a couple, and where the
    /// section jumps or has a corner, since the curvature or the strain jumps there or nearly does. A concentrated force makes only the slope of the curvature jump,
    /// which matters little: nine nodes that do not meet it have an error of 3e-6 of the length.
    pub fn breaks(&self, beam: usize) -> Vec<f64> {
        let supports = self.supports.iter().filter(|support| support.fix.rotation != FixedRotation::Free);
        let supports = supports.map(|support| support.at);
        let joints = self.joints.iter().flat_map(Joint::places);
        let parts = self.parts.iter().filter_map(|part| part.couple());
        let jumps = self.parts.iter().flat_map(|part| part.jumps());
        let further = self.nodes_at.iter().copied();
        let places = supports.chain(joints).chain(parts).chain(jumps).chain(further);
        let of_section = self.beams[beam].section.breaks();
        places.filter(|at| at.beam == beam).map(|at| at.s).chain(of_section).collect()
    }
}

/// Quantities that are computed at every record besides probes and energies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Forces of supports and joints.
    pub reactions: bool,
    /// Energy and resultant force of every effect.
    pub effects: bool,
    /// Section forces and stresses, at the probes and along the beams.
    pub section_forces: bool,
}

/// Fixes quantities at a point of a beam, or prescribes their motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Support {
    /// The point.
    pub at: Place,
    /// The fixed quantities.
    pub fix: Fixed,
    /// Prescribed change of the fixed quantities: x \[m\], y \[m\], angle \[rad\]. In statics it is
    /// multiplied by the load factor, in a motion by `law`.
    pub displacement: Displacement,
    /// Law of time of the displacement; needed in a motion if there is one, and not allowed
    /// elsewhere.
    pub law: Option<Law>,
}

impl Support {
    /// Fixes the position of a point and the direction there.
    pub fn clamp(at: Place) -> Self {
        Self { at, fix: Fixed { x: true, y: true, rotation: FixedRotation::Angle }, ..Self::default() }
    }

    /// Fixes the position of a point.
    pub fn pin(at: Place) -> Self {
        Self { at, fix: Fixed { x: true, y: true, rotation: FixedRotation::Free }, ..Self::default() }
    }
}

/// The quantities that a support fixes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fixed {
    /// Position along x.
    pub x: bool,
    /// Position along y.
    pub y: bool,
    /// Direction of r'.
    pub rotation: FixedRotation,
}

/// How a support fixes the gradient r'.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FixedRotation {
    /// Not at all.
    #[default]
    Free,
    /// Its direction; the stretch at this point stays free.
    Angle,
    /// Both components, as at the clamp of the paper by Chen, Zhang and Li.
    Gradient,
}

/// Prescribed motion of a support.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// Along x \[m\].
    pub x: f64,
    /// Along y \[m\].
    pub y: f64,
    /// Rotation \[rad\]; full turns count.
    pub angle: f64,
}

/// A point whose motion is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name of its columns in the output.
    pub name: String,
    /// The point.
    pub at: Place,
}

impl Probe {
    /// A probe named `name` at the point `at`.
    pub fn new(name: &str, at: Place) -> Self {
        Self { name: name.to_owned(), at }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model(more: &str) -> Model {
        let text = "beam.arm = { start = [0, 0], end = [4, 0], axial_stiffness = 1, bending_stiffness = 1 }\n\
                    beam.rod = { start = [0, 1], end = [4, 1], axial_stiffness = 1, bending_stiffness = 1 }\n\
                    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'arm', at = 1, fix = ['y'] }, \
                    { beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'arm', at = 2, fix = ['angle'] }]\n\
                    analysis.static = {}\n";
        let scene = crate::scene::parse("scene", &format!("{text}{more}\n"));
        scene.unwrap_or_else(|error| panic!("{error}\n{more}")).model().clone()
    }

    /// Couples and held directions make curvatures jump; forces and held positions do not.
    #[test]
    fn a_beam_has_nodes_where_its_curvature_jumps() {
        let model = model(
            "joint = [{ first = { beam = 'arm', at = 3 }, second = { beam = 'rod', at = 2.5 }, type = 'hinge' }]\n\
             effect.moment = [{ beam = 'rod', at = 1.5, value = 1 }]\n\
             effect.force = [{ beam = 'rod', at = 3.5, value = [0, 1] }]",
        );
        let sorted = |beam: usize| {
            let mut breaks = model.breaks(beam);
            breaks.sort_by(f64::total_cmp);
            breaks
        };
        assert_eq!((sorted(0), sorted(1)), (vec![0.0, 2.0, 3.0], vec![0.0, 1.5, 2.5]));
    }

    #[test]
    fn one_contact_among_other_parts_is_a_contact() {
        let contact = "effect.contact = [{ beam = 'arm', stiffness = 1e4, half_plane = { point = [0, -1], normal = [0, 1] } }]";
        let spring = "effect.spring = [{ beam = 'arm', at = 'end', stiffness = 1 }]";
        assert!(!model(spring).has_contact() && model(&format!("{spring}\n{contact}")).has_contact());
        let mut model = model(contact);
        assert!(!model.stands(0), "nothing stands that no stage has left");
        model.standing = Some(vec![0, 2]);
        assert_eq!([0, 1, 2].map(|part| model.stands(part)), [true, false, true]);
    }
}
