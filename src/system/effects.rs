//! The beams' own elasticity and inertia, and the loads: which densities a model's words stand for.

use super::SystemError;
use super::assembly::{Assembly, Extent};
use crate::effect::{Bend, DeadForce, Engineering, FollowerForce, Green, Inertia, Kind, Moment, Stretch};
use crate::model::{Beam, Law, Load, StrainMeasure};
use nalgebra::Vector2;

fn missing(beam: &Beam, quantity: &'static str, needed_by: &'static str) -> SystemError {
    SystemError::Missing { beam: beam.name.clone(), quantity, needed_by }
}

/// Adds what the model names.
pub(super) fn add(assembly: &mut Assembly<'_>) -> Result<(), SystemError> {
    let model = assembly.model();
    for (index, beam) in model.beams.iter().enumerate() {
        add_beam(assembly, index, beam)?;
    }
    for load in &model.loads {
        add_load(assembly, load, None)?;
    }
    model.parts.iter().try_for_each(|part| part.add_to(assembly))
}

fn add_beam(assembly: &mut Assembly<'_>, index: usize, beam: &Beam) -> Result<(), SystemError> {
    // Only a curved beam keeps its reference strains.
    let straight = assembly.discretised(index).straight;
    if let Some(ea) = beam.section.axial_stiffness {
        let gradients = |z: Vec<[Vector2<f64>; 1]>| -> Vec<_> {
            if straight { Vec::new() } else { z.into_iter().map(|[r]| r).collect() }
        };
        let extent = Extent::Beam(index, beam.gauss_points.stretch_rule());
        match beam.strain {
            StrainMeasure::Green => {
                assembly.elastic(Kind::Stretch, extent, |z| Stretch::<Green>::new(ea, &gradients(z)))
            }
            StrainMeasure::Engineering => {
                assembly.elastic(Kind::Stretch, extent, |z| Stretch::<Engineering>::new(ea, &gradients(z)))
            }
        }?;
    }
    if let Some(ei) = beam.section.bending_stiffness {
        let extent = Extent::Beam(index, beam.gauss_points.bend_rule());
        assembly.elastic(Kind::Bend, extent, |z| Bend::new(ei, if straight { &[] } else { &z }))?;
    }
    if assembly.needs().inertia {
        let mass_per_length =
            beam.section.mass_per_length.ok_or_else(|| missing(beam, "mass per length", "inertia"))?;
        let extent = Extent::Beam(index, assembly.mass_rule(index));
        assembly.inertia(Kind::Inertia, extent, Inertia { mass_per_length })?;
    }
    Ok(())
}

fn add_load(assembly: &mut Assembly<'_>, load: &Load, law: Option<&Law>) -> Result<(), SystemError> {
    match load {
        Load::InTime { load, law } => add_load(assembly, load, Some(law)),
        Load::Gravity { acceleration } => {
            let model = assembly.model();
            let mut any = false;
            for (index, beam) in model.beams.iter().enumerate() {
                let Some(mass) = beam.section.mass_per_length else { continue };
                any = true;
                let extent = Extent::Beam(index, assembly.mass_rule(index));
                dead_force(assembly, Kind::Gravity, extent, acceleration.map(|g| mass * g), law)?;
            }
            for (at, mass) in model.parts.iter().filter_map(|part| part.mass()) {
                any = true;
                let force = acceleration.map(|g| mass * g);
                dead_force(assembly, Kind::Gravity, Extent::Point(at), force, law)?;
            }
            match (any, model.beams.first()) {
                (false, Some(first)) => Err(missing(first, "mass per length", "gravity")),
                _ => Ok(()),
            }
        }
        Load::Force { at, value, follower } => {
            force(assembly, Kind::Force, Extent::Point(*at), *value, *follower, law)
        }
        Load::DistributedForce { beam, value, follower } => {
            assembly.beam("a distributed force", *beam)?;
            let extent = Extent::Beam(*beam, assembly.mass_rule(*beam));
            force(assembly, Kind::DistributedForce, extent, *value, *follower, law)
        }
        Load::Moment { at, value } => {
            let moment = |_: Vec<[Vector2<f64>; 1]>| Moment { moment: *value };
            assembly.load(Kind::Moment, Extent::Point(*at), law, moment)
        }
    }
}

fn dead_force(
    assembly: &mut Assembly<'_>,
    kind: Kind,
    extent: Extent,
    value: [f64; 2],
    law: Option<&Law>,
) -> Result<(), SystemError> {
    assembly.load(kind, extent, law, |z: Vec<[Vector2<f64>; 1]>| {
        DeadForce::new(value, z.into_iter().map(|[r]| r).collect())
    })
}

fn force(
    assembly: &mut Assembly<'_>,
    kind: Kind,
    extent: Extent,
    value: [f64; 2],
    follower: bool,
    law: Option<&Law>,
) -> Result<(), SystemError> {
    if !follower {
        return dead_force(assembly, kind, extent, value, law);
    }
    assembly.load(kind, extent, law, |z: Vec<[Vector2<f64>; 2]>| {
        FollowerForce::new(value, &z.into_iter().map(|[_, r]| r).collect::<Vec<_>>())
    })
}
