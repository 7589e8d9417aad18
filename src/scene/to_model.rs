//! Tables of a scene file → [`Model`] and [`Analysis`]: everything that one key alone cannot tell.

use std::ops::Range;

use crate::centreline::Curve;
use crate::model::{
    About, Analysis, Beam, Centreline, Displacement, Fixed, FixedRotation, InitialShape, Law, Modal, Model,
    Outputs, Probe, Static, StrainMeasure, Support,
};

use super::error::Fault;
use super::file::{
    ArcTable, BeamTable, FixName, InitialShapeTable, MoveTable, OutputTable, SceneTable, SpinUpTable,
    StrainName, SupportTable,
};
use super::place::{Built, place};
use super::quantity::Length;
use super::rigid_motion::Resisting;
use super::to_basis::{self, Size};
use super::value::{Located, Vector};
use super::{rigid_motion, to_analysis, to_law, to_parts, to_section, to_velocity};

/// Converts and checks everything; `goes_on` tells whether the analysis starts from a state that
/// another stage has left.
pub(super) fn convert(file: &SceneTable, goes_on: bool) -> Result<(Model, Analysis), Fault> {
    // Restores the order of the file: the reader returns tables sorted by name.
    let mut tables: Vec<_> = file.beam.iter().collect();
    tables.sort_by_key(|(name, _)| name.span().start);
    if tables.is_empty() {
        return Err(Fault::new(0..0, "the scene has no beam").help(
            "add a table such as `[beam.NAME]` with `start`, `end`, stiffness, and `[beam.NAME.basis.ancf]`",
        ));
    }

    let OutputTable { reactions, effects, section_forces, .. } = file.output;
    let outputs = Outputs { reactions, effects, section_forces };
    let mut model = Model { title: file.title.clone(), outputs, ..Model::default() };
    let mut built = Vec::with_capacity(tables.len());
    let mut size = Size::default();
    for (name, table) in tables {
        let (beam, curve, needs) = beam(name, table)?;
        size.nodes += needs.nodes;
        size.memory += needs.memory;
        if let Some(basis) = &table.basis {
            to_basis::check_size(size, basis)?;
        }
        if let Some(shape) = &table.initial_shape {
            let centreline = initial_shape(name.get(), shape, curve.length())?;
            model.initial_shapes.push(InitialShape { beam: model.beams.len(), centreline });
        }
        model.beams.push(beam);
        built.push(Built { name: name.clone(), curve });
    }
    for table in &file.support {
        model.supports.push(support(table, &built)?);
    }
    rigid_motion::check_duplicates(file, &model, &built)?;
    to_parts::parts(file, &built, &mut model)?;
    to_velocity::initial_velocities(file, &built, &mut model)?;
    probes(file, &built, &mut model)?;
    let analysis = to_analysis::analysis(file, &model, size, goes_on)?;
    check_needs(file, &model, &built, &analysis, goes_on)?;
    let resisting = match &analysis {
        Analysis::Static(Static { arc_length: Some(_), .. }) | Analysis::Buckling(_) => {
            Some(if goes_on { Resisting::Weight } else { Resisting::Nothing })
        }
        Analysis::Static(_) => Some(Resisting::Weight),
        Analysis::Modal(Modal { about, .. }) => (*about == About::Equilibrium).then_some(Resisting::Weight),
        Analysis::Dynamic(_) | Analysis::Stages => None,
    };
    if let Some(resisting) = resisting {
        rigid_motion::check_rigid_motions(&model, &built, resisting)?;
    }
    Ok((model, analysis))
}

fn beam(name: &Located<String>, table: &BeamTable) -> Result<(Beam, Curve, Size), Fault> {
    let label = name.get();
    let (centreline, span) = centreline(name, table)?;
    let curve = Curve::new(&centreline).map_err(|reason| {
        Fault::new(span, format!("beam `{label}` cannot have this shape: {reason}")).help(
            "ends and neighbouring points must differ, points must not double back, and an arc needs an angle",
        )
    })?;
    let section = to_section::section(label, table, curve.length())?;
    let locks = section.bending_stiffness.is_some() && section.axial_stiffness.is_some();
    let (discretization, gauss_points, size) =
        to_basis::discretization(label, table.basis.as_ref(), curve.length(), locks)?;
    let beam = Beam {
        name: label.clone(),
        centreline,
        section,
        strain: match table.strain {
            StrainName::Green => StrainMeasure::Green,
            StrainName::Engineering => StrainMeasure::Engineering,
        },
        discretization,
        gauss_points,
    };
    Ok((beam, curve, size))
}

fn arc_of(arc: &ArcTable) -> Centreline {
    Centreline::Arc { center: arc.center.si, radius: arc.radius.si, from: arc.from.si, to: arc.to.si }
}

fn centreline(name: &Located<String>, table: &BeamTable) -> Result<(Centreline, Range<usize>), Fault> {
    const HELP: &str = "give one of: `start` and `end`; `arc = { center = [0.0, 0.0], radius = 1.0, from = 0.0, \
                        to = \"90 deg\" }`; `points = [[0.0, 0.0], [1.0, 0.2], [2.0, 0.0]]`";
    let label = name.get();
    let given: Vec<(&str, Range<usize>)> = [
        ("start", table.start.as_ref().map(Located::span)),
        ("end", table.end.as_ref().map(Located::span)),
        ("arc", table.arc.as_ref().map(Located::span)),
        ("points", table.points.as_ref().map(Located::span)),
    ]
    .into_iter()
    .filter_map(|(key, span)| Some((key, span?)))
    .collect();
    match (&table.start, &table.end, &table.arc, &table.points) {
        (Some(start), Some(end), None, None) => {
            Ok((Centreline::Line { start: start.get().si, end: end.get().si }, end.span()))
        }
        (None, None, Some(arc), None) => Ok((arc_of(arc.get()), arc.span())),
        (None, None, None, Some(points)) => {
            Ok((Centreline::Points(points.get().iter().map(|p| p.get().si).collect()), points.span()))
        }
        _ => {
            let keys: Vec<&str> = given.iter().map(|(key, _)| *key).collect();
            let (span, message) = match keys.as_slice() {
                [] => (name.span(), format!("beam `{label}` has no geometry")),
                ["start"] => (name.span(), format!("beam `{label}` has a `start` but no `end`")),
                ["end"] => (name.span(), format!("beam `{label}` has an `end` but no `start`")),
                keys => (
                    given.last().map_or(name.span(), |(_, span)| span.clone()),
                    format!("beam `{label}` has more than one geometry: `{}`", keys.join("`, `")),
                ),
            };
            Err(Fault::new(span, message).help(HELP))
        }
    }
}

/// Stretch of a beam in its initial shape beyond which a mistake is more likely.
const STRETCH: f64 = 0.5;

/// The shape in which the beam `label`, which is `length` \[m\] long, begins.
fn initial_shape(
    label: &str,
    located: &Located<InitialShapeTable>,
    length: f64,
) -> Result<Centreline, Fault> {
    let points = |points: &Located<Vec<Located<Vector<Length>>>>| {
        Centreline::Points(points.get().iter().map(|point| point.get().si).collect())
    };
    let centreline = match located.get() {
        InitialShapeTable { line: Some(line), arc: None, points: None } => {
            Centreline::Line { start: line.get().start.si, end: line.get().end.si }
        }
        InitialShapeTable { line: None, arc: Some(arc), points: None } => arc_of(arc.get()),
        InitialShapeTable { line: None, arc: None, points: Some(given) } => points(given),
        _ => {
            return Err(Fault::new(located.span(), format!("beam `{label}` needs exactly one initial shape")).help(
                "give one of `initial_shape.line = { start = [0, 0], end = [1, 0] }`, `initial_shape.arc = { center = [0, 0], radius = 1, \
                 from = 0, to = \"90 deg\" }`, `initial_shape.points = [[0, 0], [1, 0.2], [2, 0]]`",
            ));
        }
    };
    let curve = Curve::new(&centreline).map_err(|reason| {
        Fault::new(located.span(), format!("beam `{label}` cannot begin in this shape: {reason}"))
            .help("ends and neighbouring points must differ, points must not double back, and an arc needs an angle")
    })?;
    let stretch = curve.length() / length - 1.0;
    if stretch.abs() > STRETCH {
        return Err(Fault::new(
            located.span(),
            format!(
                "the initial shape of beam `{label}` is {} m long, and the beam {length} m: its points would be strained by {stretch:.2}",
                curve.length()
            ),
        )
        .help("give a shape of about the beam's length"));
    }
    Ok(centreline)
}

/// Refuses a scene in which a beam lacks a property that the analysis or an effect needs.
fn check_needs(
    file: &SceneTable,
    model: &Model,
    built: &[Built],
    analysis: &Analysis,
    goes_on: bool,
) -> Result<(), Fault> {
    let kind = match analysis {
        Analysis::Static(_) => "a static analysis",
        Analysis::Buckling(_) => "a buckling analysis",
        Analysis::Modal(_) => "a modal analysis",
        Analysis::Dynamic(_) | Analysis::Stages => "a dynamic analysis",
    };
    let mass = match analysis {
        Analysis::Modal(_) | Analysis::Dynamic(_) => Some(kind),
        _ if file.effect.gravity.is_some() => Some("gravity"),
        _ => None,
    };
    let straight_from = match analysis {
        _ if goes_on => None,
        Analysis::Buckling(_) => Some("a buckling analysis"),
        Analysis::Static(Static { arc_length: Some(_), .. }) => Some("a path by arc length"),
        Analysis::Modal(Modal { about: About::Reference, .. }) => {
            Some("a modal analysis about the reference")
        }
        _ => None,
    };
    let bent = file.beam.values().find_map(|table| table.initial_shape.as_ref());
    if let (Some(kind), Some(shape)) = (straight_from, bent) {
        return Err(Fault::new(shape.span(), format!("{kind} starts from the stress-free shape, and not from another one"))
            .help("leave `initial_shape` out, or use `[analysis.static]`, `[analysis.dynamic]`, or `analysis.modal.about = \"equilibrium\"`"));
    }
    for (beam, built) in model.beams.iter().zip(built) {
        let lacks = |what: &str, who: &str, key: &str, product: [&str; 2]| {
            let [a, b] = product;
            Err(Fault::new(
                built.name.span(),
                format!("beam `{}` has no {what}, which {who} needs", beam.name),
            )
            .help(format!("give `{key}`, or `{a}` and `{b}`")))
        };
        if let (None, Some(who)) = (&beam.section.mass_per_length, mass) {
            lacks("mass", who, "mass_per_length", ["density", "area"])?;
        }
        let bedded = file.effect.foundation.iter().any(|table| table.beam.get() == &beam.name);
        let unloaded = match analysis {
            _ if goes_on => None,
            Analysis::Buckling(_) => Some("a buckling analysis"),
            Analysis::Static(Static { arc_length: Some(_), .. }) => Some("a path by arc length"),
            _ => None,
        };
        if let (None, Some(kind), false) = (&beam.section.bending_stiffness, unloaded, bedded) {
            return Err(Fault::new(
                built.name.span(),
                format!(
                    "beam `{}` has no bending stiffness: it resists nothing across it before it is loaded, and \
                     {kind} starts from the unloaded structure",
                    beam.name
                ),
            )
            .help("give `bending_stiffness`, use `[analysis.static]` with `steps`, load the string in a `[[stage]]` before, or take a spring in its place"));
        }
    }
    Ok(())
}

fn support(table: &Located<SupportTable>, built: &[Built]) -> Result<Support, Fault> {
    let t = table.get();
    let at = place(&t.beam, &t.at, built)?;
    let mut fix = Fixed::default();
    if t.fix.get().is_empty() {
        return Err(Fault::new(t.fix.span(), "this support fixes nothing")
            .help("name some of \"x\", \"y\", \"angle\", \"gradient\", or leave the support out"));
    }
    for item in t.fix.get() {
        let twice = match item.get() {
            FixName::X => std::mem::replace(&mut fix.x, true),
            FixName::Y => std::mem::replace(&mut fix.y, true),
            FixName::Angle => {
                std::mem::replace(&mut fix.rotation, FixedRotation::Angle) != FixedRotation::Free
            }
            FixName::Gradient => {
                std::mem::replace(&mut fix.rotation, FixedRotation::Gradient) != FixedRotation::Free
            }
        };
        if twice {
            return Err(Fault::new(item.span(), "this support fixes one quantity twice").help(
                "name each of \"x\", \"y\" once, and \"angle\" (the direction of r') or \"gradient\" (both components), not both",
            ));
        }
    }
    let (displacement, law) = match &t.displacement {
        None => (Displacement::default(), None),
        Some(by) => prescribed(by, fix)?,
    };
    Ok(Support { at, fix, displacement, law })
}

/// By how much a support moves, and how in time.
fn prescribed(by: &Located<MoveTable>, fix: Fixed) -> Result<(Displacement, Option<Law>), Fault> {
    let check = |key: &str, fixed: bool, span: Range<usize>| {
        if fixed {
            return Ok(());
        }
        let needed = if matches!(key, "angle" | "spin_up") { "\"angle\" or \"gradient\"" } else { key };
        Err(Fault::new(span, format!("`move.{key}` of a quantity that this support does not fix"))
            .help(format!("add {needed} to `fix`, or leave `move.{key}` out")))
    };
    let mut displacement = Displacement::default();
    let MoveTable { x, y, angle, in_time, spin_up } = by.get();
    if let Some(x) = x {
        check("x", fix.x, x.span())?;
        displacement.x = x.get().si;
    }
    if let Some(y) = y {
        check("y", fix.y, y.span())?;
        displacement.y = y.get().si;
    }
    if let Some(angle) = angle {
        check("angle", fix.rotation != FixedRotation::Free, angle.span())?;
        displacement.angle = angle.get().si;
    }
    if let Some(hub) = spin_up {
        check("spin_up", fix.rotation != FixedRotation::Free, hub.span())?;
        if in_time.is_some() || x.is_some() || y.is_some() || angle.is_some() {
            return Err(Fault::new(hub.span(), "`spin_up` moves the angle alone, by a law of its own")
                .help("keep `spin_up`, or `x`, `y`, `angle` with `in_time`"));
        }
        let SpinUpTable { start, speed, duration } = hub.get();
        let start = start.as_ref().map_or(0.0, |start| start.si);
        displacement.angle = 1.0;
        return Ok((displacement, Some(Law::SpinUp { start, speed: speed.si, duration: duration.si })));
    }
    let law = in_time.as_ref().map(to_law::law).transpose()?;
    if law.is_some() && displacement == Displacement::default() {
        return Err(Fault::new(by.span(), "this law of time moves nothing").help(
            "say by how much: `move = { x = \"1 cm\", in_time = { harmonic = { frequency = \"2 Hz\" } } }`",
        ));
    }
    Ok((displacement, law))
}

fn probes(file: &SceneTable, built: &[Built], model: &mut Model) -> Result<(), Fault> {
    for probe in &file.probe {
        let name = probe.name.get();
        if name.trim().is_empty() || name.chars().any(char::is_control) {
            return Err(Fault::new(probe.name.span(), format!("{name:?} cannot name a probe"))
                .help("a probe's name heads its columns in the output: give one line of text"));
        }
        if model.probes.iter().any(|other| other.name == *name) {
            return Err(Fault::new(probe.name.span(), format!("there are two probes named `{name}`"))
                .help("every probe needs a name of its own"));
        }
        model.probes.push(Probe { name: name.clone(), at: place(&probe.beam, &probe.at, built)? });
    }
    Ok(())
}
