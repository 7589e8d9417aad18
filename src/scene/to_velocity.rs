//! Tables `[[initial_velocity]]` → [`InitialVelocity`].

use crate::model::{FixedRotation, InitialVelocity, Model, Profile, Tabulated};

use super::error::Fault;
use super::file::{InitialVelocityTable, SceneTable, VelocityPointsTable};
use super::place::{Built, beam_index};
use super::quantity::{Measure, Quantity};
use super::value::Located;

pub(super) fn initial_velocities(file: &SceneTable, built: &[Built], model: &mut Model) -> Result<(), Fault> {
    for table in &file.initial_velocity {
        let beam = beam_index(&table.beam, built)?;
        let InitialVelocityTable { value, rotation, about, polynomial, table: points, .. } = table;
        let rigid = value.is_some() || rotation.is_some();
        if !rigid && polynomial.is_none() && points.is_none() {
            return Err(Fault::new(table.beam.span(), "this initial velocity is nothing").help(
                "give `value = [\"1 m/s\", 0]`, `rotation = \"2 rad/s\"` with `about = [0, 0]`, \
                 `polynomial = { vy = [0, 0, 1] }`, or `table = { s = [0, 1], vy = [0, 1] }`",
            ));
        }
        let mut add = |velocity: InitialVelocity| model.initial_velocities.push(velocity);
        if rigid {
            add(InitialVelocity {
                beam,
                translation: value.map_or([0.0; 2], |value| value.si),
                rotation: rotation.map_or(0.0, |rotation| rotation.si),
                center: about.map_or([0.0; 2], |about| about.si),
                ..InitialVelocity::default()
            });
        }
        if let Some(polynomial) = polynomial {
            let components = [&polynomial.get().vx, &polynomial.get().vy];
            if components.iter().all(|c| c.as_ref().is_none_or(Vec::is_empty)) {
                return Err(Fault::new(polynomial.span(), "this polynomial has no coefficients")
                    .help("give those of 1, s, s², … such as `polynomial = { vy = [0, 0, 1] }`"));
            }
            let along = components.map(|c| c.as_ref().map_or(Profile::None, |c| Profile::Polynomial(si(c))));
            add(InitialVelocity { beam, along, ..InitialVelocity::default() });
        }
        if let Some(points) = points {
            let length = built[beam].curve.length();
            let flat = [0.0, length].map(|end| {
                model.supports.iter().any(|support| {
                    support.at.beam == beam
                        && (support.at.s - end).abs() <= 1e-9 * length
                        && support.fix.rotation != FixedRotation::Free
                })
            });
            let along = through(points, length, flat)?;
            model.initial_velocities.push(InitialVelocity { beam, along, ..InitialVelocity::default() });
        }
    }
    Ok(())
}

fn si<M: Measure>(quantities: &[Quantity<M>]) -> Vec<f64> {
    quantities.iter().map(|quantity| quantity.si).collect()
}

/// Splines through the points of a beam of length `length` \[m\].
fn through(
    points: &Located<VelocityPointsTable>,
    length: f64,
    flat: [bool; 2],
) -> Result<[Profile; 2], Fault> {
    let VelocityPointsTable { s, vx, vy } = points.get();
    let fault = |message: String| {
        Fault::new(points.span(), message)
            .help("such as `table = { s = [0, \"50 cm\", 1], vy = [0, \"1 m/s\", 0] }`")
    };
    let s = si(s);
    if vx.is_none() && vy.is_none() {
        return Err(fault("this table has no velocities: `vx`, `vy` or both are needed".into()));
    }
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * length;
    if let (Some(first), Some(last)) = (s.first(), s.last())
        && !(near(*first, 0.0) && near(*last, length))
    {
        return Err(fault(format!(
            "`s` must go from one end of the beam to the other, 0 to {length} m; found {first} m to {last} m"
        )));
    }
    let component = |name: &str, velocities: &Option<Vec<_>>| match velocities {
        None => Ok(Profile::None),
        Some(velocities) => {
            let values = si(velocities);
            let (m, n) = (s.len(), values.len());
            match Tabulated::with_flat_ends(s.clone(), values, flat) {
                Some(table) => Ok(Profile::Table(table)),
                None => Err(fault(format!(
                    "a velocity needs two points or more at increasing arc lengths, and one `{name}` for each; found {m} arc lengths \
                     and {n} velocities"
                ))),
            }
        }
    };
    Ok([component("vx", vx)?, component("vy", vy)?])
}
