//! How a part of a model becomes terms of the equations.
//!
//! A [`Part`] is what a scene names besides beams, supports and loads: springs, dampers, masses,
//! contacts, …. It knows the model in words (arc lengths, stiffnesses) and, asked once when the
//! system is built, hands densities to the [`Assembly`], which tabulates the shape functions where
//! the density is to be summed.

use super::{Acting, BeamPart, Needs, SystemError, Turning};
use crate::basis::{Basis, BasisTable, Quadrature};
use crate::effect::{
    ContactIntegral, Damping, Density, Direction, Dissipation, Effect, Friction, FrictionIntegral, Integral,
    Kind, Rayleigh, Travelling, Winding,
};
use crate::model::{Beam, Law, Model, Place};
use crate::system::prescribed::Amplitude;
use nalgebra::Vector2;
use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// What takes part in the mechanics besides beams, supports and loads; as [`Any`], so that what
/// reads a model can tell the kinds of parts that it knows.
pub trait Part: Any + fmt::Debug + Send + Sync {
    /// Adds the part's densities to the equations under assembly.
    ///
    /// # Errors
    /// [`SystemError`] where the part does not fit the model.
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), SystemError>;

    /// Strain and curvature \[1/m\] that beam `beam` would take by itself, and their law of time.
    fn actuation(&self, _beam: usize) -> Option<(f64, f64, Option<&Law>)> {
        None
    }

    /// What it looks like on the ground, as a line for pictures; `size` is that of the beams \[m\].
    fn outline(&self, _size: f64) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// Where it takes or gives a couple.
    fn couple(&self) -> Option<Place> {
        None
    }

    /// A mass \[kg\] on which gravity acts.
    fn mass(&self) -> Option<(Place, f64)> {
        None
    }
}

/// Two parts are equal if they describe themselves alike.
impl PartialEq for dyn Part {
    fn eq(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
    }
}

/// Where a density is summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// Over a whole beam, by a quadrature rule in every cell.
    Beam(usize, Quadrature),
    /// At one point, with weight 1.
    Point(Place),
}

impl Extent {
    /// Index of the beam.
    fn beam(self) -> usize {
        match self {
            Self::Beam(beam, _) => beam,
            Self::Point(place) => place.beam,
        }
    }
}

/// The equations under assembly.
pub struct Assembly<'a> {
    model: &'a Model,
    beams: &'a [BeamPart],
    reference: &'a [f64],
    needs: Needs,
    pub(super) internal: Vec<Box<dyn Effect>>,
    pub(super) loads: Vec<Acting>,
    pub(super) inertia: Vec<Box<dyn Effect>>,
    pub(super) turning: Vec<Turning>,
    pub(super) damping: Vec<Box<dyn Damping>>,
    pub(super) travelling: Vec<Travelling>,
    pub(super) contacts: Vec<Arc<ContactIntegral>>,
    pub(super) friction: Vec<FrictionIntegral>,
    pub(super) windings: Vec<Winding>,
    pub(super) left_out: Vec<(Kind, usize)>,
}

impl<'a> Assembly<'a> {
    pub(super) fn new(model: &'a Model, beams: &'a [BeamPart], reference: &'a [f64], needs: Needs) -> Self {
        Self {
            model,
            beams,
            reference,
            needs,
            internal: Vec::new(),
            loads: Vec::new(),
            inertia: Vec::new(),
            turning: Vec::new(),
            damping: Vec::new(),
            travelling: Vec::new(),
            contacts: Vec::new(),
            friction: Vec::new(),
            windings: Vec::new(),
            left_out: Vec::new(),
        }
    }

    /// The model.
    pub fn model(&self) -> &'a Model {
        self.model
    }

    /// What the analysis asks for.
    pub fn needs(&self) -> Needs {
        self.needs
    }

    /// A beam, as `what` refers to it.
    ///
    /// # Errors
    /// [`SystemError::NoSuchBeam`].
    pub fn beam(&self, what: &'static str, beam: usize) -> Result<&'a Beam, SystemError> {
        let none = SystemError::NoSuchBeam { what, beam, count: self.model.beams.len() };
        self.model.beams.get(beam).ok_or(none)
    }

    /// A beam's shape functions and its place among the coordinates.
    pub fn discretised(&self, beam: usize) -> &'a BeamPart {
        &self.beams[beam]
    }

    /// A rule that integrates products of two shape functions: exact for the cable element's mass
    /// matrix (degree 6).
    pub fn mass_rule(&self, beam: usize) -> Quadrature {
        let points = self.model.beams[beam].gauss_points;
        Quadrature::Gauss(points.stretch.max(points.bend).max(4))
    }

    /// Something with an energy: springs, foundations, contacts, a beam's own elasticity. `density`
    /// receives the fields of the stress-free state at the points.
    ///
    /// # Errors
    /// [`SystemError`] where the extent is off the beam, naming the kind.
    pub fn elastic<D: Density<M> + 'static, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<(), SystemError> {
        let effect = self.integral(kind, extent, D::ORDERS, density)?;
        self.internal.push(Box::new(effect));
        Ok(())
    }

    /// A load: grows with the load factor in statics; acts in full, or by `law`, in a motion.
    ///
    /// # Errors
    /// As [`Self::elastic`], and where there is a law of time in an analysis without time.
    pub fn load<D: Density<M> + 'static, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        law: Option<&Law>,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<(), SystemError> {
        if law.is_some() && !self.needs.motion {
            return Err(SystemError::NoTime { what: "a load" });
        }
        let effect = self.integral(kind, extent, D::ORDERS, density)?;
        self.loads.push(Acting { effect: Box::new(effect), amplitude: law.cloned().map(Amplitude::Law) });
        Ok(())
    }

    /// A kinetic energy, quadratic in the velocities, with a constant matrix; nothing in an
    /// analysis without inertia.
    ///
    /// # Errors
    /// As [`Self::elastic`].
    pub fn inertia<D: Density<M> + 'static, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        density: D,
    ) -> Result<(), SystemError> {
        if self.needs.inertia {
            let effect = self.integral(kind, extent, D::ORDERS, |_| density)?;
            self.inertia.push(Box::new(effect));
        } else if !matches!(kind, Kind::Inertia | Kind::PointMass) {
            // Of masses there is the weight.
            self.left_out.push((kind, extent.beam()));
        }
        Ok(())
    }

    /// A kinetic energy, quadratic in the velocities, with a matrix that follows the state:
    /// `momentum` is its derivative by the rates of the fields, and `rate` the force of inertia of
    /// fields that do not accelerate. Nothing in an analysis without inertia.
    ///
    /// # Errors
    /// As [`Self::elastic`].
    pub fn turning_inertia<D, E, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        momentum: D,
        rate: E,
    ) -> Result<(), SystemError>
    where
        D: Dissipation<M> + 'static,
        E: Dissipation<M> + 'static,
    {
        if self.needs.inertia {
            let momentum = Box::new(self.integral(kind, extent, D::ORDERS, |_| Rayleigh(momentum))?);
            let rate = Box::new(self.integral(kind, extent, E::ORDERS, |_| Rayleigh(rate))?);
            self.turning.push(Turning { momentum, rate });
        }
        Ok(())
    }

    /// A dissipation function; nothing in an analysis without motion, which says so.
    ///
    /// # Errors
    /// As [`Self::elastic`].
    pub fn damping<D: Dissipation<M> + 'static, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<(), SystemError> {
        if self.needs.motion {
            let effect = self.integral(kind, extent, D::ORDERS, |fields| Rayleigh(density(fields)))?;
            self.damping.push(Box::new(effect));
        } else {
            self.left_out.push((kind, extent.beam()));
        }
        Ok(())
    }

    /// A contact: an energy that is asked, besides, where it touches; and its friction.
    pub fn contact(&mut self, contact: ContactIntegral, friction: Option<Friction>) {
        let contact = Arc::new(contact);
        self.internal.push(Box::new(Arc::clone(&contact)));
        if let Some(friction) = friction {
            self.friction.push(FrictionIntegral::new(Arc::clone(&contact), friction, self.friction.len()));
        }
        self.contacts.push(contact);
    }

    /// The turns of a torsion spring.
    ///
    /// # Errors
    /// As [`Self::elastic`].
    pub fn winding(&mut self, at: Place, stiffness: f64) -> Result<(), SystemError> {
        let direction = |z: Vec<[Vector2<f64>; 1]>| Direction::new(z.first().map_or(Vector2::x(), |[r]| *r));
        let direction =
            self.integral(Kind::TorsionSpring, Extent::Point(at), Direction::ORDERS, direction)?;
        self.windings.push(Winding::new(Box::new(direction), stiffness, self.windings.len()));
        Ok(())
    }

    /// A force whose place moves.
    ///
    /// # Errors
    /// [`SystemError::NoTime`] in an analysis without time.
    pub fn travelling(&mut self, travelling: Travelling) -> Result<(), SystemError> {
        if !self.needs.motion {
            return Err(SystemError::NoTime { what: "a moving force" });
        }
        self.travelling.push(travelling);
        Ok(())
    }

    fn integral<D, const M: usize>(
        &self,
        kind: Kind,
        extent: Extent,
        orders: [usize; M],
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<Integral<D, M>, SystemError>
    where
        D: Density<M>,
    {
        let index = extent.beam();
        let beam = self.beam(kind.name(), index)?;
        let part = &self.beams[index];
        let table = match extent {
            Extent::Beam(_, rule) => part.basis.table(rule, &orders),
            Extent::Point(place) => part.basis.points(&[part.arc_length(kind.name(), place.s)?], &orders),
        };
        let table = table.map_err(|e| SystemError::basis(&beam.name, e))?;
        let fields = reference_fields::<M>(&table, part.offset(), self.reference);
        Ok(Integral::new(kind, index, part.offset(), table, density(fields)))
    }

    /// The shape functions of a beam.
    pub fn basis(&self, beam: usize) -> &'a Basis {
        &self.beams[beam].basis
    }
}

/// The fields of the reference state at all points of a table: one `[z_0, z_1, …]` a point.
fn reference_fields<const M: usize>(table: &BasisTable, offset: usize, q: &[f64]) -> Vec<[Vector2<f64>; M]> {
    let width = table.width;
    let mut fields = Vec::with_capacity(table.s.len());
    for entry in &table.cells {
        let (_, rows) = table.block(*entry);
        let q = &q[2 * (offset + entry.first as usize)..];
        for rows in rows.chunks_exact(M * width) {
            fields.push(std::array::from_fn(|m| {
                let row = &rows[m * width..(m + 1) * width];
                row.iter()
                    .zip(q.chunks_exact(2))
                    .fold(Vector2::zeros(), |sum, (n, q)| sum + Vector2::new(q[0], q[1]) * *n)
            }));
        }
    }
    fields
}
