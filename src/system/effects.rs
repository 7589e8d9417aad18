//! Which effects a model names, and their tables. The one place that turns a model's words into densities.

use super::{BeamPart, Needs, System, SystemError};
use crate::basis::{Basis, BasisError, BasisTable, Quadrature};
use crate::effect::{
    Bend, DeadForce, Density, Effect, Engineering, FollowerForce, Green, Inertia, Integral, Kind, Moment,
    Stretch,
};
use crate::model::{Beam, GaussPoints, Load, Model, Place, StrainMeasure};
use nalgebra::Vector2;

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

/// Gauss points that integrate products of two shape functions: exact for the cable element's mass matrix (degree 6).
fn mass_points(beam: &Beam) -> usize {
    beam.gauss_points.stretch.max(beam.gauss_points.bend).max(4)
}

struct Builder<'a> {
    index: usize,
    part: &'a BeamPart,
    reference: &'a [f64],
}

impl Builder<'_> {
    fn integral<D: Density<M> + 'static, const M: usize>(
        &self,
        kind: Kind,
        table: Result<BasisTable, BasisError>,
        density: impl FnOnce(Vec<[Vector2<f64>; M]>) -> D,
    ) -> Result<Box<dyn Effect>, SystemError> {
        let table = table.map_err(|e| SystemError::basis(&self.part.name, e))?;
        let fields = reference_fields::<M>(&table, self.part.offset(), self.reference);
        let density = density(fields);
        Ok(Box::new(Integral::new(kind, self.index, self.part.offset(), table, density)))
    }

    fn basis(&self) -> &Basis {
        &self.part.basis
    }
}

fn missing(beam: &Beam, quantity: &'static str, needed_by: &'static str) -> SystemError {
    SystemError::Missing { beam: beam.name.clone(), quantity, needed_by }
}

pub(super) fn add(system: &mut System, model: &Model, needs: Needs) -> Result<(), SystemError> {
    let (mut internal, mut loads, mut inertia) = (Vec::new(), Vec::new(), Vec::new());
    for (index, beam) in model.beams.iter().enumerate() {
        let builder = Builder { index, part: &system.beams[index], reference: &system.reference };
        let basis = builder.basis();
        // Only a curved beam keeps its reference strains.
        let straight = builder.part.straight;
        if let Some(ea) = beam.section.axial_stiffness {
            let GaussPoints { stretch, lobatto, .. } = beam.gauss_points;
            let rule = if lobatto { Quadrature::Lobatto(stretch) } else { Quadrature::Gauss(stretch) };
            let table = basis.table(rule, &[1]);
            let gradients = |z: Vec<[Vector2<f64>; 1]>| -> Vec<_> {
                if straight { Vec::new() } else { z.into_iter().map(|[r]| r).collect() }
            };
            internal.push(match beam.strain {
                StrainMeasure::Green => {
                    builder.integral(Kind::Stretch, table, |z| Stretch::<Green>::new(ea, &gradients(z)))
                }
                StrainMeasure::Engineering => {
                    builder.integral(Kind::Stretch, table, |z| Stretch::<Engineering>::new(ea, &gradients(z)))
                }
            }?);
        }
        if let Some(ei) = beam.section.bending_stiffness {
            let table = basis.table(Quadrature::Gauss(beam.gauss_points.bend), &[1, 2]);
            internal.push(
                builder.integral(Kind::Bend, table, |z| Bend::new(ei, if straight { &[] } else { &z }))?,
            );
        }
        if needs.inertia {
            let mass_per_length =
                beam.section.mass_per_length.ok_or_else(|| missing(beam, "mass per length", "inertia"))?;
            let table = basis.table(Quadrature::Gauss(mass_points(beam)), &[0]);
            inertia
                .push(builder.integral(Kind::Inertia, table, |_: Vec<[_; 1]>| Inertia { mass_per_length })?);
        }
    }
    for load in &model.loads {
        match *load {
            Load::Gravity { acceleration } => {
                let mut any = false;
                for (index, beam) in model.beams.iter().enumerate() {
                    let Some(mass) = beam.section.mass_per_length else { continue };
                    any = true;
                    let builder = Builder { index, part: &system.beams[index], reference: &system.reference };
                    let table = builder.basis().table(Quadrature::Gauss(mass_points(beam)), &[0]);
                    loads.push(builder.integral(Kind::Gravity, table, |z| {
                        DeadForce::new(acceleration.map(|g| mass * g), z.into_iter().map(|[r]| r).collect())
                    })?);
                }
                if !any {
                    return Err(missing(&model.beams[0], "mass per length", "gravity"));
                }
            }
            Load::Force { at, value, follower } => {
                let (builder, basis, s) = place(system, "a force", at)?;
                loads.push(force(&builder, Kind::Force, follower, value, |orders| {
                    basis.points(&[s], orders)
                })?);
            }
            Load::DistributedForce { beam, value, follower } => {
                let (builder, basis, _) = place(system, "a distributed force", Place { beam, s: 0.0 })?;
                let rule = Quadrature::Gauss(mass_points(&model.beams[beam]));
                loads.push(force(&builder, Kind::DistributedForce, follower, value, |orders| {
                    basis.table(rule, orders)
                })?);
            }
            Load::Moment { at, value } => {
                let (builder, basis, s) = place(system, "a moment", at)?;
                let table = basis.points(&[s], &[1]);
                loads.push(builder.integral(Kind::Moment, table, |_: Vec<[_; 1]>| Moment { moment: value })?);
            }
        }
    }
    (system.internal, system.loads, system.inertia) = (internal, loads, inertia);
    Ok(())
}

fn place<'a>(
    system: &'a System,
    what: &'static str,
    at: Place,
) -> Result<(Builder<'a>, &'a Basis, f64), SystemError> {
    let (part, s) = system.part(what, at)?;
    Ok((Builder { index: at.beam, part, reference: &system.reference }, &part.basis, s))
}

fn force(
    builder: &Builder<'_>,
    kind: Kind,
    follower: bool,
    value: [f64; 2],
    table: impl Fn(&[usize]) -> Result<BasisTable, BasisError>,
) -> Result<Box<dyn Effect>, SystemError> {
    if follower {
        builder.integral(kind, table(&[0, 1]), |z: Vec<[Vector2<f64>; 2]>| {
            FollowerForce::new(value, &z.into_iter().map(|[_, r]| r).collect::<Vec<_>>())
        })
    } else {
        builder.integral(kind, table(&[0]), |z: Vec<[Vector2<f64>; 1]>| {
            DeadForce::new(value, z.into_iter().map(|[r]| r).collect())
        })
    }
}
