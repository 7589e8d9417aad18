//! The `analysis` table → [`Analysis`].

use std::ops::Range;

use crate::model::{
    About, Accuracy, Analysis, ArcLength, Buckling, Crossing, Discretization, Dynamic, EventCondition,
    EventKind, Integrator, Modal, Model, Probe, ProbeQuantity, ProbeTarget, SPECTRAL_RADIUS, STEP_CONTROL,
    Section, Static, StepControl, Undamped,
};

use super::diagnose::choices;
use super::error::Fault;
use super::file::{
    AboutName, AnalysisTable, ArcLengthTable, CrossingName, DynamicTable, EventTable, ProbeQuantityName,
    SceneTable, StaticTable,
};
use super::quantity::{Length, Positive, Quantity, Ratio, Stress, Time};
use super::to_basis::{MAX_MEMORY, Size};
use super::value::{AccuracyTable, AccuracyValue, Count, Located};

/// Points on a path unless the scene says otherwise.
pub const ARC_LENGTH_MAX_POINTS: usize = 1000;
/// Most records, load steps and path points of a run: all are kept in memory.
pub const MAX_RECORDS: u64 = 1_000_000;
/// Most time steps of a run with a fixed step.
pub const MAX_STEPS: f64 = 1e9;
/// Records of a dynamic run unless the scene says otherwise.
pub const DYNAMIC_RECORDS: f64 = 200.0;

/// The errors that the results of an analysis may have; `None` where the scene does not say.
pub(super) fn accuracy(analysis: Option<&Located<AnalysisTable>>) -> Result<Option<Accuracy>, Fault> {
    let Some(AnalysisTable { statics, dynamic, buckling, modal }) = analysis.map(Located::get) else {
        return Ok(None);
    };
    let value = statics.as_ref().and_then(|table| table.accuracy.as_ref());
    let value = value.or_else(|| dynamic.as_ref().and_then(|table| table.get().accuracy.as_ref()));
    if let Some(value) = value {
        return match value.get() {
            AccuracyValue::Position(position) if position.si < 1.0 => Ok(Some(Accuracy::new(position.si))),
            AccuracyValue::Position(position) => Err(too_large(value.span(), position.si)),
            AccuracyValue::Table(AccuracyTable { position, curvature, section_force }) => {
                let read = |value: &Option<Located<Quantity<Ratio, Positive>>>| {
                    value.as_ref().map(largest_error).transpose()
                };
                Ok(Some(Accuracy {
                    result: read(position)?.unwrap_or(Accuracy::USUAL),
                    curvature: read(curvature)?,
                    section_force: read(section_force)?,
                }))
            }
        };
    }
    let value = buckling.as_ref().and_then(|table| table.accuracy.as_ref());
    let value = value.or_else(|| modal.as_ref().and_then(|table| table.accuracy.as_ref()));
    value.map(|value| largest_error(value).map(Accuracy::new)).transpose()
}

fn largest_error(value: &Located<Quantity<Ratio, Positive>>) -> Result<f64, Fault> {
    let error = value.get().si;
    if error < 1.0 { Ok(error) } else { Err(too_large(value.span(), error)) }
}

fn too_large(span: Range<usize>, error: f64) -> Fault {
    Fault::new(span, format!("found the largest error {error}"))
        .help("it must be smaller than 1; 1e-4 is the usual choice")
}

/// Whether a motion names its integrator.
pub(super) fn names_an_integrator(file: &SceneTable) -> bool {
    let dynamic = file.analysis.as_ref().and_then(|analysis| analysis.get().dynamic.as_ref());
    dynamic.is_some_and(|table| {
        let DynamicTable { generalized_alpha, gauss, radau, .. } = table.get();
        generalized_alpha.is_some() || gauss.is_some() || radau.is_some()
    })
}

/// The one analysis of the scene; where it is that of a stage, `goes_on` tells whether one came
/// before.
pub(super) fn analysis(
    file: &SceneTable,
    model: &Model,
    size: Size,
    goes_on: bool,
) -> Result<Analysis, Fault> {
    let Some(located) = &file.analysis else {
        return Err(Fault::new(0..0, "missing key `analysis` in the scene").help(ADD));
    };
    let table = located.get();
    match (&table.statics, &table.dynamic, &table.buckling, &table.modal) {
        (Some(table), None, None, None) => Ok(Analysis::Static(statics(table, model, size)?)),
        (None, Some(table), None, None) => Ok(Analysis::Dynamic(dynamic(table, model, size)?)),
        (None, None, Some(table), None) => {
            Ok(Analysis::Buckling(Buckling { count: modes(&table.count, model, size)? }))
        }
        (None, None, None, Some(table)) => Ok(Analysis::Modal(Modal {
            count: modes(&table.count, model, size)?,
            about: match &table.about {
                None if goes_on => About::Equilibrium,
                None => About::Reference,
                Some(about) => match about.get() {
                    AboutName::Equilibrium => About::Equilibrium,
                    AboutName::Reference if goes_on => {
                        return Err(Fault::new(
                            about.span(),
                            "vibrations about the reference do not start from the stage before them",
                        )
                        .help("leave `about` out: those about the equilibrium of this stage are found"));
                    }
                    AboutName::Reference => About::Reference,
                },
            },
        })),
        (None, None, None, None) => Err(Fault::new(located.span(), "`analysis` is empty").help(ANALYSES)),
        _ => Err(Fault::new(located.span(), "the scene has more than one analysis").help(ANALYSES)),
    }
}

const ADD: &str = "add one of `[analysis.static]`, `[analysis.dynamic]`, `[analysis.buckling]`, `[analysis.modal]`; or `[[stage]]`s, each with a `name` and one of these as its `analysis`";

const ANALYSES: &str = "give exactly one of `[analysis.static]`, `[analysis.dynamic]`, `[analysis.buckling]`, `[analysis.modal]`";

fn modes<const MIN: u64>(located: &Located<Count<MIN>>, model: &Model, size: Size) -> Result<usize, Fault> {
    let most = 4.0 * size.nodes;
    let count = located.get().0;
    let open = model.beams.iter().any(|beam| beam.discretization == Discretization::Open);
    if count as f64 > most && !open {
        return Err(Fault::new(located.span(), format!("found {count} modes"))
            .help(format!("this scene has {most} coordinates and so at most as many modes")));
    }
    let modes = bounded(located, "modes")?;
    // Shapes, their products with both matrices, and the basis in which they are found.
    check_memory(located.span(), &format!("{count} modes"), 4.0 * count as f64, size)?;
    Ok(modes)
}

/// Refuses more states than any memory can hold: each has four numbers per node.
fn check_memory(span: Range<usize>, what: &str, states: f64, size: Size) -> Result<(), Fault> {
    let memory = states * size.nodes * 32.0 / 1024f64.powi(3);
    if memory > MAX_MEMORY {
        return Err(Fault::new(span, format!("{what} of {} nodes need about {memory:.3e} GiB", size.nodes))
            .help(format!(
                "all states are kept in memory, up to {MAX_MEMORY} GiB: ask for fewer, or for fewer nodes"
            )));
    }
    Ok(())
}

fn bounded<const MIN: u64>(count: &Located<Count<MIN>>, what: &str) -> Result<usize, Fault> {
    match usize::try_from(count.get().0) {
        Ok(value) if count.get().0 <= MAX_RECORDS => Ok(value),
        _ => Err(Fault::new(count.span(), format!("found {} {what}", count.get().0))
            .help(format!("from {MIN} to {MAX_RECORDS} are legal: every state is kept in memory"))),
    }
}

fn tolerance(value: &Located<Quantity<Ratio, Positive>>) -> Result<f64, Fault> {
    let tolerance = value.get().si;
    if tolerance >= 1.0 {
        return Err(Fault::new(value.span(), format!("found the relative tolerance {tolerance}"))
            .help("it must be smaller than 1; 1e-6 is a usual choice"));
    }
    Ok(tolerance)
}

fn statics(table: &StaticTable, model: &Model, size: Size) -> Result<Static, Fault> {
    if let (Some(steps), Some(_)) = (&table.steps, &table.arc_length) {
        return Err(Fault::new(steps.span(), "`steps` beside `arc_length`").help(
            "`steps` records at parts of the load, `arc_length` at points of the path; keep one of them",
        ));
    }
    if let (Some(step), Some(_)) = (&table.max_step, &table.arc_length) {
        return Err(Fault::new(step.span(), "`max_step` of the load factor beside `arc_length`")
            .help("write it in the table `arc_length`, in lengths of the beam"));
    }
    if let Some(steps) = &table.steps {
        let count = steps.get().0;
        check_memory(steps.span(), &format!("{count} load steps"), count as f64, size)?;
    }
    if let Some(step) = &table.max_step {
        let count = 1.0 / step.get().si;
        let kept = if table.steps.is_some() { 1.0 } else { count };
        check_memory(step.span(), &format!("{count:.3e} load steps"), kept, size)?;
        if count > MAX_RECORDS as f64 {
            return Err(Fault::new(
                step.span(),
                format!("{count:.3e} load steps, of which {MAX_RECORDS} can be taken"),
            )
            .help("give a larger `max_step`"));
        }
    }
    Ok(Static {
        steps: table.steps.as_ref().map(|n| bounded(n, "load steps")).transpose()?,
        max_step: table.max_step.as_ref().map(|step| step.get().si),
        tolerance: table.tolerance.as_ref().map(tolerance).transpose()?,
        arc_length: table.arc_length.as_ref().map(|table| arc_length(table, model, size)).transpose()?,
    })
}

fn arc_length(located: &Located<ArcLengthTable>, model: &Model, size: Size) -> Result<ArcLength, Fault> {
    let table = located.get();
    if table.until_load.is_none() && table.until_probe.is_none() && table.max_points.is_none() {
        return Err(Fault::new(located.span(), "nothing says where the path ends").help(
            "give `until_load = 1.0`, `until_probe = { probe = \"NAME\", y = -0.5 }` or `max_points = 200`",
        ));
    }
    if let Some(points) = &table.max_points {
        let count = points.get().0;
        check_memory(points.span(), &format!("{count} points on the path"), count as f64, size)?;
    }
    let until_probe = table.until_probe.as_ref().map(|located| {
        let target = located.get();
        probe_target(&target.probe, target.x, target.y, model)
    });
    Ok(ArcLength {
        until_load: table.until_load.map(|v| v.si),
        max_points: table
            .max_points
            .as_ref()
            .map_or(Ok(ARC_LENGTH_MAX_POINTS), |n| bounded(n, "points on the path"))?,
        max_step: table.max_step.map(|v| v.si),
        until_probe: until_probe.transpose()?,
    })
}

fn known_probe<'m>(probe: &Located<String>, model: &'m Model) -> Result<&'m Probe, Fault> {
    let name = probe.get();
    model.probes.iter().find(|probe| probe.name == *name).ok_or_else(|| {
        let names: Vec<String> = model.probes.iter().map(|probe| probe.name.clone()).collect();
        if names.is_empty() {
            return Fault::new(probe.span(), format!("there is no probe named `{name}`, nor any other"))
                .help(format!("add `[[probe]]` with `name = \"{name}\"`, a `beam` and a place `at` on it"));
        }
        Fault::new(probe.span(), format!("there is no probe named `{name}`")).help(choices(
            "probes of this scene",
            name,
            &names,
        ))
    })
}

fn probe_target(
    probe: &Located<String>,
    x: Option<Quantity<Length>>,
    y: Option<Quantity<Length>>,
    model: &Model,
) -> Result<ProbeTarget, Fault> {
    let name = &known_probe(probe, model)?.name;
    let (axis, value) = match (x, y) {
        (Some(x), None) => (0, x.si),
        (None, Some(y)) => (1, y.si),
        _ => {
            return Err(Fault::new(probe.span(), "a probe's target needs either `x` or `y`")
                .help(format!("such as `probe = \"{name}\", y = -0.5`")));
        }
    };
    Ok(ProbeTarget { probe: name.clone(), axis, value })
}

fn event(table: &EventTable, model: &Model) -> Result<EventCondition, Fault> {
    use ProbeQuantity as Of;
    let probe = known_probe(&table.probe, model)?;
    let stress = |stress: &Option<Located<Quantity<Stress>>>| stress.as_ref().map(|stress| stress.get().si);
    let values = [
        (Of::X, table.x.map(|x| x.si)),
        (Of::Y, table.y.map(|y| y.si)),
        (Of::Angle, table.angle.map(|angle| angle.si)),
        (Of::Vx, table.vx.map(|v| v.si)),
        (Of::Vy, table.vy.map(|v| v.si)),
        (Of::Speed, table.speed.map(|v| v.si)),
        (Of::Strain, table.strain.map(|strain| strain.si)),
        (Of::Curvature, table.curvature.map(|curvature| curvature.si)),
        (Of::AxialForce, table.axial_force.map(|force| force.si)),
        (Of::ShearForce, table.shear_force.map(|force| force.si)),
        (Of::BendingMoment, table.bending_moment.map(|moment| moment.si)),
        (Of::StressBottom, stress(&table.stress_bottom)),
        (Of::StressTop, stress(&table.stress_top)),
    ];
    let crossing = table.crossing.as_ref().map_or(Crossing::Any, |name| match name.get() {
        CrossingName::Any => Crossing::Any,
        CrossingName::Rising => Crossing::Rising,
        CrossingName::Falling => Crossing::Falling,
    });
    let reached = values
        .into_iter()
        .filter_map(|(quantity, value)| Some((quantity, EventKind::Reaches { value: value?, crossing })));
    let turns = [(&table.maximum, EventKind::Maximum), (&table.minimum, EventKind::Minimum)];
    let turns =
        turns.into_iter().filter_map(|(name, when)| Some((probe_quantity(*name.as_ref()?.get()), when)));
    let all: Vec<(ProbeQuantity, EventKind)> = reached.chain(turns).collect();
    let [(quantity, when)] = all[..] else {
        return Err(Fault::new(
            table.probe.span(),
            format!("an event needs exactly one quantity of its probe; found {}", all.len()),
        )
        .help(format!(
            "such as `probe = \"{0}\", y = -0.5`, `probe = \"{0}\", speed = \"3 m/s\"` or `probe = \"{0}\", maximum = \"y\"`",
            table.probe.get()
        )));
    };
    if let (Some(crossing), EventKind::Maximum | EventKind::Minimum) = (&table.crossing, when) {
        return Err(Fault::new(crossing.span(), "a maximum or a minimum has no `crossing`")
            .help("leave `crossing` out; it belongs to a value that is reached"));
    }
    let Section { bending_stiffness, .. } = &model.beams[probe.at.beam].section;
    let of_bending = matches!(quantity, Of::Curvature | Of::ShearForce | Of::BendingMoment);
    if bending_stiffness.is_none() && of_bending {
        return Err(Fault::new(
            table.probe.span(),
            format!("probe `{}` lies on a string, which has no {}", probe.name, quantity.name().0),
        )
        .help("watch its `axial_force` or `strain`, or give the beam a `bending_stiffness`"));
    }
    if matches!(quantity, Of::StressBottom | Of::StressTop) {
        let beam = &model.beams[probe.at.beam];
        let s = probe.at.s;
        if beam.section.stresses(s, s, [0.0; 2], &[]).is_none() {
            return Err(Fault::new(
                table.probe.span(),
                format!(
                    "the stress at probe `{}` is not known: beam `{}` has no `section`",
                    probe.name, beam.name
                ),
            )
            .help("give the beam a `section` with its `youngs_modulus`, or watch the `bending_moment`"));
        }
    }
    Ok(EventCondition { probe: probe.name.clone(), quantity, when, stop: table.stop })
}

fn probe_quantity(name: ProbeQuantityName) -> ProbeQuantity {
    match name {
        ProbeQuantityName::X => ProbeQuantity::X,
        ProbeQuantityName::Y => ProbeQuantity::Y,
        ProbeQuantityName::Angle => ProbeQuantity::Angle,
        ProbeQuantityName::Vx => ProbeQuantity::Vx,
        ProbeQuantityName::Vy => ProbeQuantity::Vy,
        ProbeQuantityName::Speed => ProbeQuantity::Speed,
        ProbeQuantityName::Strain => ProbeQuantity::Strain,
        ProbeQuantityName::Curvature => ProbeQuantity::Curvature,
        ProbeQuantityName::AxialForce => ProbeQuantity::AxialForce,
        ProbeQuantityName::ShearForce => ProbeQuantity::ShearForce,
        ProbeQuantityName::BendingMoment => ProbeQuantity::BendingMoment,
        ProbeQuantityName::StressBottom => ProbeQuantity::StressBottom,
        ProbeQuantityName::StressTop => ProbeQuantity::StressTop,
    }
}

fn dynamic(located: &Located<DynamicTable>, model: &Model, size: Size) -> Result<Dynamic, Fault> {
    let table = located.get();
    let duration = table.duration.si;
    let output_every = match &table.output_every {
        Some(every) => {
            let (value, records) = (every.get().si, duration / every.get().si);
            if value > duration {
                return Err(Fault::new(
                    every.span(),
                    format!("output_every = {value} s is longer than duration = {duration} s"),
                )
                .help("records are taken at 0, output_every, 2 output_every, … up to duration"));
            }
            if records > MAX_RECORDS as f64 {
                return Err(Fault::new(
                    every.span(),
                    format!("duration / output_every = {records:.3e} records"),
                )
                .help(format!("up to {MAX_RECORDS} are legal: every record is kept in memory")));
            }
            // Positions and velocities.
            check_memory(every.span(), &format!("{records:.3e} records"), 2.0 * records, size)?;
            value
        }
        None => duration / DYNAMIC_RECORDS,
    };
    const ONE: &str = "give one of `[analysis.dynamic.generalized_alpha]`, `[analysis.dynamic.gauss]`, \
                       `[analysis.dynamic.radau]`, or none for Radau IIA collocation with its default accuracy";
    let integrator = match (&table.generalized_alpha, &table.gauss, &table.radau) {
        (None, None, None) => Integrator::usual(STEP_CONTROL),
        (Some(alpha), None, None) => {
            let t = alpha.get();
            let spectral_radius = match &t.spectral_radius {
                Some(radius) if !(0.0..=1.0).contains(&radius.get().si) => {
                    return Err(Fault::new(
                        radius.span(),
                        format!("found the spectral radius {}", radius.get().si),
                    )
                    .help("from 0 (most damping of high frequencies) to 1 (none) are legal; 0.9 is usual"));
                }
                Some(radius) => radius.get().si,
                None => SPECTRAL_RADIUS,
            };
            let step = step_control(alpha, &t.step, &t.tolerance, duration)?;
            let newton_tolerance = match (&t.newton_tolerance, step) {
                (None, _) => Integrator::NEWTON_TOLERANCE,
                (Some(tolerance), StepControl::Fixed(_)) => tolerance.get().si,
                (Some(tolerance), StepControl::Tolerance(_)) => {
                    let found = "found `newton_tolerance` beside `tolerance`";
                    let help = "with `tolerance` the iteration is as accurate as the steps; `newton_tolerance` goes with `step`";
                    return Err(Fault::new(tolerance.span(), found).help(help));
                }
            };
            Integrator::GeneralizedAlpha { step, spectral_radius, newton_tolerance }
        }
        (None, Some(gauss), None) => {
            let t = gauss.get();
            let step = step_control(gauss, &t.step, &t.tolerance, duration)?;
            Integrator::Gauss { stages: stages(&t.stages)?, step }
        }
        (None, None, Some(radau)) => {
            let t = radau.get();
            let step = step_control(radau, &t.step, &t.tolerance, duration)?;
            Integrator::Radau { stages: stages(&t.stages)?, step }
        }
        _ => return Err(Fault::new(located.span(), "more than one integrator").help(ONE)),
    };
    if let Err(undamped) = integrator.suits(model) {
        let spans =
            [table.generalized_alpha.as_ref().map(Located::span), table.gauss.as_ref().map(Located::span)];
        let span = spans.into_iter().flatten().next().unwrap_or_else(|| located.span());
        return Err(Fault::new(span, undamped.to_string()).help(Undamped::HELP));
    }
    let events = table.event.iter().map(|table| event(table, model)).collect::<Result<_, _>>()?;
    Ok(Dynamic { duration, output_every, integrator, events })
}

fn stages<const MIN: u64>(count: &Option<Located<Count<MIN>>>) -> Result<usize, Fault> {
    match count {
        None => Ok(3),
        Some(count) => match count.get().0 {
            n @ 1..=3 => Ok(n as usize),
            n => Err(Fault::new(count.span(), format!("found {n} stages")).help(format!(
                "from {MIN} to 3 are legal; 3 is the most efficient where accuracy is wanted"
            ))),
        },
    }
}

fn step_control<T>(
    integrator: &Located<T>,
    step: &Option<Located<Quantity<Time, Positive>>>,
    accuracy: &Option<Located<Quantity<Ratio, Positive>>>,
    duration: f64,
) -> Result<StepControl, Fault> {
    match (step, accuracy) {
        (Some(step), None) => {
            let value = step.get().si;
            if value > duration || duration / value > MAX_STEPS {
                return Err(Fault::new(
                    step.span(),
                    format!("a step of {value} s in a duration of {duration} s"),
                )
                .help(format!("the step must lie between duration / {MAX_STEPS:e} and duration")));
            }
            Ok(StepControl::Fixed(value))
        }
        (None, Some(accuracy)) => Ok(StepControl::Tolerance(tolerance(accuracy)?)),
        (Some(step), Some(_)) => Err(Fault::new(step.span(), "both `step` and `tolerance`")
            .help("keep `tolerance` (steps chosen for that accuracy), or `step` (all alike)")),
        (None, None) => Err(Fault::new(integrator.span(), "the integrator needs `tolerance` or `step`")
            .help("such as `tolerance = 1e-5`, or `step = \"1 ms\"`")),
    }
}
