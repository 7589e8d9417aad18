//! The assembly of parts into the terms of the equations.

use super::part::places;
use super::{
    Acting, ActingLoad, BuildError, ContactEffect, Damping, Density, DiscretizedBeam, Dissipation, Effect,
    Extent, FrictionEffect, HeldLength, Integral, Kind, Needs, Owner, Rayleigh, TendonPath, Terms,
    TimedDensity, TimedIntegral, TimedLoad, Turning, Weighted, Winding,
};
use crate::basis::{Basis, BasisTable, Quadrature};
use crate::beam::{Beam, Place};
use crate::law::Law;
use nalgebra::Vector2;
use std::sync::Arc;

/// The equations under assembly.
pub struct Assembly<'a> {
    beams: &'a [Beam],
    discretized: &'a [DiscretizedBeam],
    reference: &'a [f64],
    masses: Vec<(Place, f64)>,
    needs: Needs,
    acting: Acting,
    terms: Terms,
}

impl<'a> Assembly<'a> {
    /// An assembly without terms yet. `discretized` lists the discretisations of `beams` in the
    /// same order, `masses` the masses \[kg\] at points of the beams, and `reference` the
    /// coordinates of the stress-free state.
    pub fn new(
        beams: &'a [Beam],
        discretized: &'a [DiscretizedBeam],
        reference: &'a [f64],
        masses: Vec<(Place, f64)>,
        needs: Needs,
    ) -> Self {
        Self { beams, discretized, reference, masses, needs, acting: Acting::Not, terms: Terms::default() }
    }

    /// The terms that the parts have added.
    pub fn finish(self) -> Terms {
        self.terms
    }

    /// Says how the parts that are added from now on act in the state with which the analysis begins.
    pub fn set_acting(&mut self, acting: Acting) {
        self.acting = acting;
    }

    fn has_gone(&self) -> bool {
        matches!(self.acting, Acting::NoLonger { .. })
    }

    /// Notes `owner` as what has added the terms since the last such call.
    pub(crate) fn belong_to(&mut self, owner: Owner) {
        self.terms.belong_to(owner);
    }

    /// All beams.
    pub fn beams(&self) -> &'a [Beam] {
        self.beams
    }

    /// The masses \[kg\] at points of the beams.
    pub fn masses(&self) -> &[(Place, f64)] {
        &self.masses
    }

    /// The kinds of terms that the analysis needs.
    pub fn needs(&self) -> Needs {
        self.needs
    }

    /// Beam number `beam`; `what` names the part that refers to it, for the error.
    ///
    /// # Errors
    /// [`BuildError::NoSuchBeam`].
    pub fn beam(&self, what: &'static str, beam: usize) -> Result<&'a Beam, BuildError> {
        let none = BuildError::NoSuchBeam { what, beam, count: self.beams.len() };
        self.beams.get(beam).ok_or(none)
    }

    /// The shape functions of a beam and its position among the coordinates.
    pub fn discretized(&self, beam: usize) -> &'a DiscretizedBeam {
        &self.discretized[beam]
    }

    /// A rule for integrals of products of two shape functions: exact for the cable element's mass
    /// matrix (degree 6).
    pub fn mass_rule(&self, beam: usize) -> Quadrature {
        self.beams[beam].gauss_points.of_loads()
    }

    /// Adds an effect with an energy: springs, foundations, contacts, a beam's own elasticity.
    /// `density` receives the fields of the stress-free state at the points.
    ///
    /// # Errors
    /// [`BuildError`] where the extent is off the beam, naming the kind.
    pub fn elastic<D: Density<M> + 'static, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<(), BuildError> {
        let effect = self.effect(kind, &extent, density)?;
        if self.has_gone() {
            self.terms.loads.push(ActingLoad { effect, amplitude: self.acting.amplitude(None) });
        } else {
            self.terms.internal.push(effect);
        }
        Ok(())
    }

    /// Adds a load. In statics it grows with the load factor; in a motion it acts in full, or by
    /// `law`.
    ///
    /// # Errors
    /// As [`Self::elastic`], and where there is a law of time in an analysis without time.
    pub fn load<D: Density<M> + 'static, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        law: Option<&Law>,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<(), BuildError> {
        if law.is_some() && !self.needs.motion && !self.has_gone() {
            return Err(BuildError::NoTime { what: format!("a load (`{}`)", kind.name()) });
        }
        let effect = self.effect(kind, &extent, density)?;
        self.terms.loads.push(ActingLoad { effect, amplitude: self.acting.amplitude(law) });
        Ok(())
    }

    /// Adds a kinetic energy, quadratic in the velocities, with a constant matrix; adds nothing in
    /// an analysis without inertia.
    ///
    /// # Errors
    /// As [`Self::elastic`].
    pub fn inertia<D: Density<M> + 'static, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        density: D,
    ) -> Result<(), BuildError> {
        if self.needs.inertia {
            let effect = self.effect(kind, &extent, |_| density)?;
            self.terms.inertia.push(effect);
        } else if !matches!(kind, Kind::Inertia | Kind::PointMass) {
            // Masses are not reported as left out, because they still act by their weight.
            self.terms.left_out.push((kind, extent.beam()));
        }
        Ok(())
    }

    /// Adds a kinetic energy, quadratic in the velocities, whose matrix depends on the state:
    /// `momentum` is its derivative by the rates of the fields, and `rate` the force of inertia of
    /// fields without acceleration. Adds nothing in an analysis without inertia.
    ///
    /// # Errors
    /// As [`Self::elastic`].
    pub fn turning_inertia<D, E, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        momentum: D,
        rate: E,
    ) -> Result<(), BuildError>
    where
        D: Dissipation<M> + 'static,
        E: Dissipation<M> + 'static,
    {
        if self.needs.inertia {
            let momentum = self.dissipative(kind, &extent, |_| momentum)?;
            let rate = self.dissipative(kind, &extent, |_| rate)?;
            self.terms.turning.push(Turning { momentum, rate });
        }
        Ok(())
    }

    /// Adds a dissipation function. In an analysis without motion it adds nothing and lists the
    /// effect as left out.
    ///
    /// # Errors
    /// As [`Self::elastic`].
    pub fn damping<D: Dissipation<M> + 'static, const M: usize>(
        &mut self,
        kind: Kind,
        extent: Extent,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<(), BuildError> {
        if self.needs.motion {
            let effect = self.dissipative(kind, &extent, density)?;
            self.terms.damping.push(effect);
        } else if !self.has_gone() {
            self.terms.left_out.push((kind, extent.beam()));
        }
        Ok(())
    }

    /// Adds a contact: an energy that can also be asked where it touches.
    pub fn contact(&mut self, contact: Arc<dyn ContactEffect>) {
        self.terms.internal.push(Box::new(Arc::clone(&contact)));
        self.terms.contacts.push(contact);
    }

    /// Adds the friction of a contact; `friction` receives its index among all frictions of the
    /// system.
    pub fn friction(&mut self, friction: impl FnOnce(usize) -> Box<dyn FrictionEffect>) {
        self.terms.friction.push(friction(self.terms.friction.len()));
    }

    /// Keeps the length of the line of a tendon, which is the sum of two densities, at that of the
    /// stress-free state less `shortening` \[m\] times an amplitude: in statics the load factor, in a
    /// motion 1 or `law`.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn hold_length<C, D, const M: usize, const N: usize>(
        &mut self,
        (path, shortening): (&TendonPath, f64),
        law: Option<&Law>,
        centreline: (Extent, C),
        (extent, detour): (Extent, impl FnOnce(Vec<[Vector2<f64>; N]>) -> D),
    ) -> Result<(), BuildError>
    where
        C: Density<M> + 'static,
        D: Density<N> + 'static,
    {
        if law.is_some() && !self.needs.motion {
            return Err(BuildError::NoTime { what: "a tendon".to_owned() });
        }
        let sums = [
            self.effect(Kind::Tendon, &centreline.0, |_| centreline.1)?,
            self.effect(Kind::Tendon, &extent, detour)?,
        ];
        let amplitude = self.acting.amplitude(law);
        self.terms.held.push(HeldLength::new(sums, path.clone(), shortening, amplitude, self.reference));
        Ok(())
    }

    /// Adds the energy of the full turns of a torsion spring ½ k θ². `direction` is made from the
    /// fields of the stress-free state at the point, and is the density θ, from −π to π.
    ///
    /// # Errors
    /// As [`Self::elastic`].
    pub fn winding<D: Density<M> + 'static, const M: usize>(
        &mut self,
        kind: Kind,
        at: Place,
        stiffness: f64,
        direction: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<(), BuildError> {
        let direction = self.effect(kind, &Extent::Point(at), direction)?;
        self.terms.windings.push(Winding::new(at, direction, stiffness, self.terms.windings.len()));
        Ok(())
    }

    /// Adds a load that depends on time by more than a factor; `what` names it for the error.
    ///
    /// # Errors
    /// [`BuildError::NoTime`] in an analysis without time.
    pub fn timed_load(&mut self, what: &'static str, load: Box<dyn TimedLoad>) -> Result<(), BuildError> {
        if !self.needs.motion {
            return Err(BuildError::NoTime { what: what.to_owned() });
        }
        self.terms.timed_loads.push(load);
        Ok(())
    }

    /// Adds a load with a density that depends on time, times `law`; `what` names it for the error.
    ///
    /// # Errors
    /// As [`Self::elastic`] and [`Self::timed_load`].
    pub fn timed_density<D: TimedDensity<M> + 'static, const M: usize>(
        &mut self,
        what: &'static str,
        kind: Kind,
        extent: &Extent,
        law: Option<&Law>,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<(), BuildError> {
        let (table, offset) = self.table(kind, extent, &D::ORDERS)?;
        let density = density(fields::<M>(&table, offset, self.reference));
        let (beam, law) = (extent.beam(), law.cloned());
        let load: Box<dyn TimedLoad> = match extent.factors(&table) {
            None => Box::new(TimedIntegral::new(Integral::new(kind, beam, offset, table, density), law)),
            Some(factors) => {
                let density = Weighted::new(density, factors);
                Box::new(TimedIntegral::new(Integral::new(kind, beam, offset, table, density), law))
            }
        };
        self.timed_load(what, load)
    }

    /// The sum of a density over its extent.
    fn effect<D: Density<M> + 'static, const M: usize>(
        &self,
        kind: Kind,
        extent: &Extent,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<Box<dyn Effect>, BuildError> {
        let (table, offset) = self.table(kind, extent, &D::ORDERS)?;
        let density = density(fields::<M>(&table, offset, self.reference));
        Ok(match extent.factors(&table) {
            None => Box::new(Integral::new(kind, extent.beam(), offset, table, density)),
            Some(factors) => {
                let density = Weighted::new(density, factors);
                Box::new(Integral::new(kind, extent.beam(), offset, table, density))
            }
        })
    }

    /// The sum of a dissipation function over its extent.
    fn dissipative<D: Dissipation<M> + 'static, const M: usize>(
        &self,
        kind: Kind,
        extent: &Extent,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<Box<dyn Damping>, BuildError> {
        let (table, offset) = self.table(kind, extent, &D::ORDERS)?;
        let density = density(fields::<M>(&table, offset, self.reference));
        Ok(match extent.factors(&table) {
            None => Box::new(Integral::new(kind, extent.beam(), offset, table, Rayleigh(density))),
            Some(factors) => {
                let density = Rayleigh(Weighted::new(density, factors));
                Box::new(Integral::new(kind, extent.beam(), offset, table, density))
            }
        })
    }

    /// The arc length of each quadrature point of an extent, and that of the middle of its cell
    /// \[m\].
    ///
    /// # Errors
    /// As [`Self::elastic`].
    pub fn places(&self, kind: Kind, extent: &Extent) -> Result<Vec<[f64; 2]>, BuildError> {
        let (table, _) = self.table(kind, extent, &[0])?;
        Ok(places(&table).collect())
    }

    /// The shape functions at the points of an extent, and the index of its beam's first
    /// coefficient.
    fn table(
        &self,
        kind: Kind,
        extent: &Extent,
        orders: &[usize],
    ) -> Result<(BasisTable, usize), BuildError> {
        let index = extent.beam();
        let beam = self.beam(kind.name(), index)?;
        let part = &self.discretized[index];
        let acting = |mut table: BasisTable| {
            let factors = extent.factors(&table).unwrap_or_default();
            table.keep_cells(|cell| factors[cell].iter().any(|factor| *factor != 0.0));
            table
        };
        let table = match extent {
            Extent::Beam(_, rule) => part.basis.table(*rule, orders),
            Extent::Weighted(_, rule, factor) => {
                part.basis.divided_table(*rule, orders, &factor.kinks()).map(acting)
            }
            Extent::Whole(_, rule, _) => part.basis.table(*rule, orders).map(acting),
            Extent::Point(place) => part.basis.points(&[part.arc_length(kind.name(), place.s)?], orders),
        };
        let table = table.map_err(|e| BuildError::basis(&beam.name, e))?;
        Ok((table, part.offset()))
    }

    /// The shape functions of a beam.
    pub fn basis(&self, beam: usize) -> &'a Basis {
        &self.discretized[beam].basis
    }
}

/// The fields of the state `q` at all points of a table: one array `[z_0, z_1, …]` per point.
pub(super) fn fields<const M: usize>(table: &BasisTable, offset: usize, q: &[f64]) -> Vec<[Vector2<f64>; M]> {
    let width = table.width;
    let mut all = Vec::with_capacity(table.s.len());
    for entry in &table.cells {
        let (_, rows) = table.block(*entry);
        let q = &q[2 * (offset + entry.first as usize)..];
        for rows in rows.chunks_exact(M * width) {
            all.push(std::array::from_fn(|m| {
                let row = &rows[m * width..(m + 1) * width];
                row.iter()
                    .zip(q.chunks_exact(2))
                    .fold(Vector2::zeros(), |sum, (n, q)| sum + Vector2::new(q[0], q[1]) * *n)
            }));
        }
    }
    all
}
