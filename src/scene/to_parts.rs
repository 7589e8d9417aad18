//! Tables of joints, loads, damping, springs, masses, fluids and contacts → parts of the model.

use std::sync::Arc;

use crate::assembly::TendonPath;
use crate::centreline::Curve;
use crate::effect::{
    Actuation, BeamDamping, Buoyancy, Contact, DistributedForce, Drag, Electrostatic, Field, Force,
    ForceField, Foundation, Friction, Gravity, Moment, MovingForce, Obstacle, PointMass, SectionInertia,
    Spring, Tendon, TorsionSpring,
};
use crate::model::{Along, Beam, InitialShape, Joint, Model};

use super::error::Fault;
use super::file::{
    ActuationTable, ContactTable, ElectrostaticTable, ForceFieldTable, FrictionTable, GravityTable,
    HalfPlaneTable, JointName, JointTable, PointTable, SceneTable, TendonTable,
};
use super::place::{Built, beam_index, place};
use super::to_along::{Stretch, along};
use super::to_law;
use super::value::{Count, Located};

/// Adds the parts that the file names to the model.
pub(super) fn parts(file: &SceneTable, built: &[Built], model: &mut Model) -> Result<(), Fault> {
    let effects = &file.effect;
    let parts = &mut model.parts;
    for t in &effects.force {
        parts.push(Arc::new(Force {
            at: place(&t.beam, &t.at, built)?,
            value: t.value.si,
            follower: t.follower,
            law: t.in_time.as_ref().map(to_law::law).transpose()?,
        }));
    }
    for t in &effects.moment {
        let at = place(&t.beam, &t.at, built)?;
        let law = t.in_time.as_ref().map(to_law::law).transpose()?;
        parts.push(Arc::new(Moment { at, value: t.value.si, law }));
    }
    for t in &effects.distributed_force {
        let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
        parts.push(Arc::new(DistributedForce {
            beam: stretch.beam,
            value: stretch.vector(&t.value, "value")?,
            follower: t.follower,
            law: t.in_time.as_ref().map(to_law::law).transpose()?,
        }));
    }
    if let Some(gravity) = &effects.gravity {
        let GravityTable { acceleration, in_time, .. } = gravity.get();
        let law = in_time.as_ref().map(to_law::law).transpose()?;
        parts.push(Arc::new(Gravity { acceleration: acceleration.si, law }));
    }
    for t in &effects.damping {
        let both = t.stiffness_proportional.as_ref();
        if let (Some(both), true) = (both, t.strain.is_some() || t.curvature.is_some()) {
            return Err(Fault::new(
                both.span(),
                "`stiffness_proportional` stands for `strain` and `curvature`",
            )
            .help("keep `stiffness_proportional`, or the other two"));
        }
        let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
        let both = stretch.optional(&t.stiffness_proportional, "stiffness_proportional")?;
        let part = BeamDamping {
            beam: stretch.beam,
            mass_proportional: stretch.optional(&t.mass_proportional, "mass_proportional")?,
            strain: stretch.optional(&t.strain, "strain")?.or_else(|| both.clone()),
            curvature: stretch.optional(&t.curvature, "curvature")?.or(both),
        };
        let nothing = part == BeamDamping { beam: part.beam, ..BeamDamping::default() };
        needs(
            !nothing,
            &t.beam,
            "this damping",
            "`mass_proportional`, `stiffness_proportional`, `strain`, `curvature`",
        )?;
        parts.push(Arc::new(part));
    }
    for t in &effects.spring {
        needs(
            t.stiffness.is_some() || t.damping.is_some(),
            &t.beam,
            "this spring",
            "`stiffness`, `damping`",
        )?;
        if let (Some(length), None) = (&t.length, t.anchor) {
            return Err(Fault::new(length.span(), "a spring without an `anchor` has no length")
                .help("give `anchor = [0.0, 1.0]`, its end on the ground, or leave `length` out"));
        }
        if let Some(length) = t.length.as_ref().filter(|length| length.get().si < 0.0) {
            return Err(
                Fault::new(length.span(), "a spring's length cannot be negative").help("give 0 or more")
            );
        }
        parts.push(Arc::new(Spring {
            at: place(&t.beam, &t.at, built)?,
            anchor: t.anchor.map(|anchor| anchor.si),
            length: t.length.as_ref().map(|length| length.get().si),
            stiffness: t.stiffness.map(|k| k.si),
            damping: t.damping.map(|c| c.si),
        }));
    }
    for t in &effects.torsion_spring {
        needs(
            t.stiffness.is_some() || t.damping.is_some(),
            &t.beam,
            "this spring",
            "`stiffness`, `damping`",
        )?;
        parts.push(Arc::new(TorsionSpring {
            at: place(&t.beam, &t.at, built)?,
            stiffness: t.stiffness.map(|k| k.si),
            damping: t.damping.map(|c| c.si),
        }));
    }
    for t in &effects.point_mass {
        needs(
            t.mass.is_some() || t.rotary_inertia.is_some(),
            &t.beam,
            "this mass",
            "`mass`, `rotary_inertia`",
        )?;
        parts.push(Arc::new(PointMass {
            at: place(&t.beam, &t.at, built)?,
            mass: t.mass.map(|m| m.si),
            rotary_inertia: t.rotary_inertia.map(|j| j.si),
        }));
    }
    for t in &effects.rotary_inertia {
        let beam = beam_index(&t.beam, built)?;
        let per_length = match &t.per_length {
            Some(value) => Some(along(value, "per_length", built[beam].curve.length())?),
            None => model.beams[beam].section.rotary_inertia.clone(),
        };
        let per_length = per_length.ok_or_else(|| {
            Fault::new(t.beam.span(), format!("the rotary inertia of beam `{}` is not known", t.beam.get()))
                .help("give `per_length`, or the beam a `section` with `density`")
        })?;
        parts.push(Arc::new(SectionInertia { beam, per_length }));
    }
    for t in &effects.foundation {
        let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
        let stiffness = stretch.vector(t.stiffness.get(), "stiffness")?;
        let length = built[stretch.beam].curve.length();
        if stiffness.iter().any(|k| k.bounds(length)[0] < 0.0) || stiffness.iter().all(Along::is_zero) {
            return Err(Fault::new(t.stiffness.span(), "a foundation needs a positive stiffness")
                .help("such as `stiffness = [0.0, \"2 kN/m^2\"]` for a beam along x"));
        }
        parts.push(Arc::new(Foundation { beam: stretch.beam, stiffness }));
    }
    for t in &effects.actuation {
        needs(
            t.strain.is_some() || t.curvature.is_some(),
            &t.beam,
            "this actuation",
            "`strain`, `curvature`",
        )?;
        let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
        let layer =
            t.layer.as_ref().map(|number| layer(number, t, &model.beams[stretch.beam])).transpose()?;
        parts.push(Arc::new(Actuation {
            beam: stretch.beam,
            strain: stretch.optional(&t.strain, "strain")?,
            curvature: stretch.optional(&t.curvature, "curvature")?,
            layer,
            law: t.in_time.as_ref().map(to_law::law).transpose()?,
        }));
    }
    for t in &effects.tendon {
        parts.push(Arc::new(tendon(t, built, &model.beams)?));
    }
    for t in &effects.drag {
        let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
        let zero = || Along::Constant(0.0);
        let drag = Drag {
            beam: stretch.beam,
            viscous: [
                stretch.optional(&t.viscous_tangential, "viscous_tangential")?.unwrap_or_else(zero),
                stretch.optional(&t.viscous_normal, "viscous_normal")?.unwrap_or_else(zero),
            ],
            quadratic: [
                stretch.optional(&t.tangential, "tangential")?.unwrap_or_else(zero),
                stretch.optional(&t.normal, "normal")?.unwrap_or_else(zero),
            ],
            flow: t.flow.map_or([0.0; 2], |flow| flow.si),
        };
        let something = drag.viscous.iter().chain(&drag.quadratic).any(|c| !c.is_zero());
        needs(
            something,
            &t.beam,
            "this drag",
            "`normal`, `tangential`, `viscous_normal`, `viscous_tangential`",
        )?;
        parts.push(Arc::new(drag));
    }
    for t in &effects.buoyancy {
        let Some(gravity) = &effects.gravity else {
            return Err(Fault::new(t.beam.span(), "there is no buoyancy without gravity")
                .help("add `[effect.gravity]` with `acceleration = [0.0, -9.81]`"));
        };
        let GravityTable { acceleration, in_time, .. } = gravity.get();
        let law = in_time.as_ref().map(to_law::law).transpose()?;
        let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
        let displaced = stretch.quantity(&t.displaced_mass_per_length, "displaced_mass_per_length")?;
        parts.push(Arc::new(Buoyancy { beam: stretch.beam, displaced, acceleration: acceleration.si, law }));
    }
    for t in &effects.electrostatic {
        parts.push(Arc::new(electrostatic(t, built, &model.beams, &model.initial_shapes)?));
    }
    for t in &effects.force_field {
        parts.push(Arc::new(force_field(t, file, built)?));
    }
    for t in &effects.moving_force {
        let (beam, speed) = (beam_index(&t.beam, built)?, t.speed.get().si);
        if speed == 0.0 {
            return Err(Fault::new(t.speed.span(), "a moving force needs a speed")
                .help("give a `speed` other than 0, or a `[[effect.force]]`"));
        }
        let start = t.start.map_or(0.0, |start| start.si);
        parts.push(Arc::new(MovingForce { beam, value: t.value.si, start, speed }));
    }
    for t in &effects.contact {
        parts.push(Arc::new(contact(t, built, &model.beams)?));
    }
    for table in &file.joint {
        model.joints.push(joint(table.get(), built)?);
    }
    Ok(())
}

/// Refuses a part that does nothing.
fn needs(something: bool, at: &Located<String>, what: &str, keys: &str) -> Result<(), Fault> {
    if something {
        return Ok(());
    }
    Err(Fault::new(at.span(), format!("{what} does nothing")).help(format!("give one or more of {keys}")))
}

/// Distance of the surface of a beam from its centreline \[m\], as its section tells it; zero where it
/// does not. `what` asks for it.
fn half_thickness(name: &Located<String>, beam: &Beam, what: &str) -> Result<f64, Fault> {
    let layers = &beam.section.layers;
    if layers.is_empty() {
        return Ok(0.0);
    }
    let constant =
        layers.iter().flat_map(|layer| [&layer.bottom, &layer.top]).all(|y| y.constant().is_some());
    match beam.section.faces(0.0, 0.0).filter(|[low, high]| constant && (low + high).abs() <= 1e-9 * (high - low)) {
        Some([_, high]) => Ok(high),
        None => Err(Fault::new(
            name.span(),
            format!(
                "the surfaces of beam `{}` are not everywhere equally far from its centreline, and this {what} does not say where the surface is",
                name.get()
            ),
        )
        .help(format!("give the {what} a `half_thickness`"))),
    }
}

fn contact(t: &ContactTable, built: &[Built], beams: &[Beam]) -> Result<Contact, Fault> {
    let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
    let beam = stretch.beam;
    let half_thickness = match t.half_thickness {
        Some(given) => given.si,
        None => half_thickness(&t.beam, &beams[beam], "contact")?,
    };
    let mut obstacles = Vec::new();
    if let Some(c) = &t.circle {
        obstacles.push(Obstacle::Circle { center: c.center.si, radius: c.radius.si, inside: c.inside });
    }
    if let Some(h) = &t.half_plane {
        let normal = unit(&h.normal.get().si).ok_or_else(|| {
            Fault::new(h.normal.span(), "a normal of no length").help("such as `normal = [0.0, 1.0]`")
        })?;
        obstacles.push(Obstacle::HalfPlane { point: h.point.si, normal });
    }
    if let Some(b) = &t.rectangle {
        let half = b.size.get().si.map(|side| 0.5 * side);
        if half.iter().any(|side| *side <= 0.0) {
            return Err(Fault::new(b.size.span(), "a box needs positive sides")
                .help("such as `size = [\"20 cm\", \"10 cm\"]`"));
        }
        let angle = b.angle.map_or(0.0, |angle| angle.si);
        obstacles.push(Obstacle::Box { center: b.center.si, half, angle });
    }
    let (Some(obstacle), true) = (obstacles.pop(), obstacles.is_empty()) else {
        return Err(Fault::new(t.beam.span(), "a contact needs exactly one obstacle").help(
            "give one of `circle = { center = [0, 0], radius = 1 }`, `half_plane = { point = [0, 0], normal = [0, 1] }`, \
             `box = { center = [0, 0], size = [1, 1] }`; each further obstacle is a contact of its own",
        ));
    };
    Ok(Contact {
        beam,
        obstacle,
        stiffness: t.stiffness.si,
        half_thickness,
        friction: t.friction.as_ref().map(|f| friction(f, t.stiffness.si)).transpose()?,
        between: stretch.part(),
    })
}

/// The index of the layer on which an actuation imposes its strain.
fn layer(number: &Located<Count<1>>, t: &ActuationTable, beam: &Beam) -> Result<usize, Fault> {
    let (found, layers) = (number.get().0, &beam.section.layers);
    if let Some(curvature) = &t.curvature {
        return Err(Fault::new(curvature.span(), "no `curvature` can be imposed on a single layer")
            .help("give its `strain`, or leave `layer` out"));
    }
    let index = usize::try_from(found - 1)
        .ok()
        .filter(|index| layers.get(*index).is_some_and(|layer| layer.stiffness.is_some()));
    index.ok_or_else(|| {
        let known = layers.iter().filter(|layer| layer.stiffness.is_some()).count();
        Fault::new(
            number.span(),
            format!("beam `{}` has no layer {found}: its `section` has {known} layers", beam.name),
        )
        .help("layers are those of `section.layers`, counted from 1, from the right face to the left one")
    })
}

fn tendon(t: &TendonTable, built: &[Built], beams: &[Beam]) -> Result<Tendon, Fault> {
    let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
    let (ends, section) = (stretch.ends(), &beams[stretch.beam].section);
    let offset = along(&t.offset, "offset", built[stretch.beam].curve.length())?;
    if section.bending_stiffness.is_none() && !offset.is_zero() {
        return Err(Fault::new(
            t.offset.span(),
            format!("beam `{}` is a string, on which nothing can pull beside its centreline", t.beam.get()),
        )
        .help("give the beam a `bending_stiffness`, or the tendon the `offset` 0"));
    }
    if let Some(s) = offset.jumps().into_iter().find(|s| (ends[0]..=ends[1]).contains(s)) {
        return Err(Fault::new(t.offset.span(), format!("this tendon jumps to another offset at s = {s} m"))
            .help("let it run there over a length: `offset = { table = { s = [0.0, 0.5, 0.6], value = [0.01, 0.01, 0.02] } }`"));
    }
    let between = |i: usize| ends[0] + (ends[1] - ends[0]) * i as f64 / CHECKED as f64;
    let kinks = offset.kinks().into_iter().chain(section.jumps());
    let kinks = kinks.filter(|s| (ends[0]..=ends[1]).contains(s));
    for s in (0..=CHECKED).map(between).chain(kinks) {
        let place = offset.at(s, s);
        if let Some([low, high]) = section.faces(s, s).filter(|[low, high]| place < *low || place > *high) {
            return Err(Fault::new(
                t.offset.span(),
                format!(
                    "this tendon leaves the section of beam `{}` at s = {s:.6} m: its offset is {place:.4e} m there, and the \
                     section reaches from {low:.4e} m to {high:.4e} m",
                    t.beam.get()
                ),
            )
            .help(
                "offsets count to the left of the direction from the beam's start to its end; for a tendon that is held outside \
                 the section, give the beam its stiffnesses in place of a `section`",
            ));
        }
    }
    let path =
        TendonPath { ends, offset, tension: t.tension.as_ref().map_or(1.0, |tension| tension.get().si) };
    let shortening = match (&t.tension, &t.length, &t.shortening) {
        (Some(_), None, None) => None,
        (None, Some(length), None) => {
            let free = stress_free_length(&path, &built[stretch.beam].curve);
            if length.get().si > free * (1.0 + TAUT) {
                return Err(Fault::new(
                    length.span(),
                    format!(
                        "this tendon would be slack: it is {} m long, and its way along the stress-free beam `{}` is {free:.9} m",
                        length.get().si,
                        t.beam.get()
                    ),
                )
                .help("a tendon of given length pulls and cannot push: give a shorter `length`, or a `shortening`"));
            }
            Some(free - length.get().si)
        }
        (None, None, Some(shortening)) if shortening.get().si >= 0.0 => Some(shortening.get().si),
        (None, None, Some(shortening)) => {
            return Err(Fault::new(
                shortening.span(),
                "this tendon would be slack: its shortening is negative",
            )
            .help("a tendon of given length pulls and cannot push"));
        }
        _ => {
            return Err(Fault::new(
                t.beam.span(),
                "a tendon needs exactly one of `tension`, `length`, `shortening`",
            )
            .help("such as `tension = \"20 N\"`, or `shortening = \"5 mm\"` for one that does not stretch"));
        }
    };
    let law = t.in_time.as_ref().map(to_law::law).transpose()?;
    Ok(Tendon { beam: stretch.beam, path, shortening, law })
}

/// ∫ |p'| ds of a tendon on the stress-free beam \[m\], by Gauss's rule of two points in many parts.
fn stress_free_length(path: &TendonPath, curve: &Curve) -> f64 {
    let [from, to] = path.ends;
    let even = (0..=CHECKED).map(|i| from + (to - from) * i as f64 / CHECKED as f64);
    let kinks = path.offset.kinks().into_iter().filter(|s| (from..to).contains(s));
    let mut ends: Vec<f64> = even.chain(kinks).collect();
    ends.sort_unstable_by(f64::total_cmp);
    let part = |part: &[f64]| {
        let (middle, half) = (0.5 * (part[0] + part[1]), 0.5 * (part[1] - part[0]));
        let speed = |s: f64| {
            let (offset, slope) = (path.offset.at(s, middle), path.offset.slope(s, middle));
            (1.0 - offset * curve.curvature(s)).hypot(slope)
        };
        let offset = half / 3.0_f64.sqrt();
        half * (speed(middle - offset) + speed(middle + offset))
    };
    ends.windows(2).map(part).sum()
}

/// Relative excess of a tendon's length that counts as round-off.
const TAUT: f64 = 1e-9;

fn force_field(t: &ForceFieldTable, file: &SceneTable, built: &[Built]) -> Result<ForceField, Fault> {
    let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
    let wrong = |span: std::ops::Range<usize>, reason: String| {
        Fault::new(span, format!("this formula cannot be read: {reason}"))
            .help("such as `potential = \"50*(y-0.2)^2\"`, or `value = [\"-3*y\", \"3*x\"]`, with x and y in metres, and in motions t in seconds")
    };
    let stands = file.analysis.as_ref().is_some_and(|analysis| analysis.get().dynamic.is_none());
    // Which time would be meant where there is none, nobody knows.
    let in_time = |text: &Located<String>, field: Field| {
        match stands && field.depends_on_time() {
        false => Ok(field),
        true => Err(Fault::new(text.span(), "this formula names the time t, which this analysis does not have")
            .help(
                "put a number in place of t, or use `[analysis.dynamic]`; in a scene with stages let the field begin with a motion, \
                 by `stage = \"…\"`, and end with it, by `until = \"…\"`",
            )),
    }
    };
    let field = match (&t.potential, &t.value) {
        (Some(potential), None) => {
            let field = Field::of_potential(potential.get());
            in_time(potential, field.map_err(|reason| wrong(potential.span(), reason))?)?
        }
        (None, Some([x, y])) => {
            // Each by itself first, so that a fault is told at its place.
            for one in [x, y] {
                let alone = Field::of_components([one.get(), "0"]);
                in_time(one, alone.map_err(|reason| wrong(one.span(), reason))?)?;
            }
            Field::of_components([x.get(), y.get()]).map_err(|reason| wrong(x.span(), reason))?
        }
        _ => {
            return Err(Fault::new(t.beam.span(), "a force field needs exactly one of `potential`, `value`")
                .help("such as `potential = \"50*(y-0.2)^2\"`, or `value = [\"-3*y\", \"3*x\"]`"));
        }
    };
    let law = t.in_time.as_ref().map(to_law::law).transpose()?;
    Ok(ForceField { beam: stretch.beam, field, acting: stretch.indicator(), law })
}

/// Parts of a beam at whose ends its distance from an electrode, or that of a tendon from its faces,
/// is checked.
const CHECKED: usize = 200;

fn electrostatic(
    t: &ElectrostaticTable,
    built: &[Built],
    beams: &[Beam],
    initial_shapes: &[InitialShape],
) -> Result<Electrostatic, Fault> {
    let stretch = Stretch::new(&t.beam, t.from.as_ref(), t.to.as_ref(), built)?;
    let HalfPlaneTable { point, normal } = &t.electrode;
    let direction = unit(&normal.get().si).ok_or_else(|| {
        Fault::new(normal.span(), "a normal of no length")
            .help("such as `normal = [0.0, 1.0]`, towards the beam")
    })?;
    let half_thickness = match t.half_thickness {
        Some(given) => given.si,
        None => half_thickness(&t.beam, &beams[stretch.beam], "electrode")?,
    };
    let facing = stretch.indicator();
    let shape = initial_shapes.iter().find(|shape| shape.beam == stretch.beam);
    let shape = shape.and_then(|shape| Curve::new(&shape.centreline).ok());
    let (curve, length) =
        (shape.as_ref().unwrap_or(&built[stretch.beam].curve), built[stretch.beam].curve.length());
    for i in 0..=CHECKED {
        let share = i as f64 / CHECKED as f64;
        let ([x, y], [px, py]) = (curve.position(share * curve.length()), point.si);
        let gap = direction[0] * (x - px) + direction[1] * (y - py) - half_thickness;
        let s = share * length;
        if gap <= 0.0 && facing.at(s, s) != 0.0 {
            return Err(Fault::new(
                normal.span(),
                format!("the surface of beam `{}` begins {} m behind the electrode at s = {s} m", t.beam.get(), -gap),
            )
            .help("`normal` points from the electrode towards the beam, and `point` lies on the electrode's surface; the beam's half thickness counts"));
        }
    }
    Ok(Electrostatic {
        beam: stretch.beam,
        voltage: t.voltage.si,
        point: point.si,
        normal: direction,
        width: t.width.si,
        facing,
        fringe: t.fringe.map_or(0.0, |fringe| fringe.si),
        half_thickness,
        permittivity: t.permittivity.map_or(Electrostatic::VACUUM, |permittivity| permittivity.si),
        law: t.in_time.as_ref().map(to_law::law).transpose()?,
    })
}

fn friction(t: &FrictionTable, stiffness: f64) -> Result<Friction, Fault> {
    if let Some(velocity) = &t.velocity {
        return Err(Fault::new(velocity.span(), "friction has no `velocity`: it sticks by elastic springs")
            .help("leave `velocity` out; `stiffness` is that of the springs, and that of the contact when left out"));
    }
    Ok(Friction { coefficient: t.coefficient.si, stiffness: t.stiffness.map_or(stiffness, |k| k.si) })
}

fn unit([x, y]: &[f64; 2]) -> Option<[f64; 2]> {
    let length = x.hypot(*y);
    (length > 0.0).then(|| [x / length, y / length])
}

fn joint(t: &JointTable, built: &[Built]) -> Result<Joint, Fault> {
    let point = |point: &PointTable| place(&point.beam, &point.at, built);
    let first = point(&t.first)?;
    let fault =
        |message: &str, help: &str| Fault::new(t.kind.span(), message.to_owned()).help(help.to_owned());
    match (*t.kind.get(), &t.second, &t.along) {
        (JointName::Hinge, Some(second), None) => Ok(Joint::Hinge { first, second: point(second)? }),
        (JointName::Weld, Some(second), None) => Ok(Joint::Weld { first, second: point(second)? }),
        (JointName::Slider, None, Some(along)) => {
            let along = unit(&along.get().si).ok_or_else(|| {
                Fault::new(along.span(), "a direction of no length").help("such as `along = [1.0, 0.0]`")
            })?;
            Ok(Joint::Slider { at: first, along })
        }
        (JointName::Slider, ..) => Err(fault(
            "a slider moves one point, `first`, along a line of the ground",
            "give `along = [1.0, 0.0]`, the line's direction, and no `second`",
        )),
        _ => Err(fault(
            "a hinge or a weld joins two points, `first` and `second`",
            "such as `second = { beam = \"arm\", at = \"start\" }`, without `along`; a point is held to the ground by a `[[support]]`",
        )),
    }
}
