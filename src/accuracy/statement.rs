//! Errors of single records, places and events, as they are stated.

use super::difference::each_larger;
use crate::model::{Model, Place, ProbeQuantity};
use crate::results::{ContactImpulse, Event, EventErrors, ProbeErrors, ProbeSample, Trajectory};

/// The records around one whose errors count for it, on either side, as a part of the run.
const WINDOW: usize = 20;

/// The part of a load factor to which it is known where stability changes: nearer to a singular tangent round-off decides.
const FOUND: f64 = 1e-7;

/// Part of the largest relative error of a contact that those of its other numbers are at least.
const LEAST: f64 = 0.2;

/// Errors oscillate, and a moment at which two runs agree by chance is no better than those around
/// it: the largest within a twentieth of the run on either side, and at its end within the last tenth.
pub(super) fn of_probe(mut probe: ProbeErrors) -> ProbeErrors {
    let reach = probe.samples.len() / WINDOW;
    let of_last = probe.samples.len().saturating_sub(2 * reach + 1);
    let around: Vec<ProbeSample> = (0..probe.samples.len())
        .map(|i| {
            let last = (i + reach).min(probe.samples.len() - 1);
            if probe.samples[i].x.is_nan() {
                return probe.samples[i];
            }
            let within = &probe.samples[i.saturating_sub(reach).min(of_last)..=last];
            within.iter().fold(ProbeSample::default(), |most, sample| each_larger(&most, sample))
        })
        .collect();
    probe.samples = around;
    probe
}

/// Errors of an event follow from those of its quantity, too. What errs by δ where it passes a value with the first and second
/// derivative q' and q'' passes it later or earlier by t with |q'| t + |q''| t²/2 = δ. What turns back does so later or earlier by
/// δ'/|q''| with an error δ' of q', and where nothing is known of that, by no more than 2 √(δ/|q''|): elsewhere it is lower by more
/// than 2δ. Two runs that agree in an event by chance tell of no smaller errors, and where none of its quantity is known, none of
/// the event is.
pub(super) fn of_events(
    mut errors: Vec<EventErrors>,
    model: &Model,
    run: &Trajectory,
    probes: &[ProbeErrors],
) -> Vec<EventErrors> {
    for (error, event) in errors.iter_mut().zip(&run.events) {
        let Event::Probe { time, probe, quantity, turns, rates, .. } = event else { continue };
        let at = model.probes.iter().find(|of| of.name == *probe).map(|of| of.at);
        let samples = probes.iter().find(|of| of.name == *probe).map_or(&[][..], |of| &of.samples[..]);
        let after = run.parameter.partition_point(|record| record < time);
        let around = samples.iter().take(after + 1).skip(after.saturating_sub(1));
        let quantity = ProbeQuantity::ALL.into_iter().find(|of| of.name().0 == *quantity);
        let most = |of: &dyn Fn(ProbeQuantity, &ProbeSample) -> Option<f64>| {
            around.clone().filter_map(|errors| of(quantity?, errors)).reduce(f64::max)
        };
        let [first, second] = rates.map(f64::abs);
        let value = most(&|quantity, errors| of_quantity(quantity, errors, model, at?));
        let shift = value.map(|value| match turns {
            None => 2.0 * value / (first + (first * first + 2.0 * second * value).sqrt()),
            Some(_) => most(&of_rate).map_or(2.0 * (value / second).sqrt(), |rate| rate / second),
        });
        // Of what does not err 0/0 is made.
        error.parameter = shift.map_or(f64::INFINITY, |shift| error.parameter.max(shift));
        error.value = error.value.map(|seen| seen.max(value.unwrap_or(f64::INFINITY)));
    }
    of_contacts(&mut errors, &run.events);
    of_modes(&mut errors, &run.events);
    for (error, event) in errors.iter_mut().zip(&run.events) {
        let least = match event {
            Event::Stability { load_factor, resolution, .. } => resolution.max(FOUND * load_factor.abs()),
            Event::Probe { time, .. } | Event::Contact { time, .. } => f64::EPSILON * time,
        };
        error.parameter = error.parameter.max(least);
    }
    errors
}

/// Where more directions are unstable already the next one is lost in shorter waves, which a mesh shows no better: the load factor errs by no
/// smaller part than those before. Two meshes may err alike in one mode by chance.
fn of_modes(errors: &mut [EventErrors], events: &[Event]) {
    let lost = |event: &Event| match event {
        Event::Stability {
            stability: "lost", unstable_directions: Some([before, _]), load_factor, ..
        } => Some((*before, load_factor.abs())),
        _ => None,
    };
    let known: Vec<(usize, f64)> = events
        .iter()
        .zip(&*errors)
        .filter_map(|(event, error)| lost(event).map(|(before, load)| (before, error.parameter / load)))
        .filter(|(_, relative)| relative.is_finite())
        .collect();
    for (event, error) in events.iter().zip(errors) {
        let Some((before, load)) = lost(event) else { continue };
        let lower = known.iter().filter(|(others, _)| *others < before).map(|(_, relative)| relative * load);
        error.parameter = lower.fold(error.parameter, f64::max);
    }
}

/// What is known of a contact errs alike: of its duration, its impulse and its largest force none by less than a part of the largest
/// relative error.
fn of_contacts(errors: &mut [EventErrors], events: &[Event]) {
    for (end, event) in events.iter().enumerate() {
        let Event::Contact {
            time,
            contact,
            impulse: Some(ContactImpulse { impulse: [x, y], largest_force }),
            ..
        } = event
        else {
            continue;
        };
        let begins = |event: &Event| matches!(event, Event::Contact { contact: of, touches: true, .. } if of == contact);
        let Some(begin) = events[..end].iter().rposition(begins) else { continue };
        let (duration, impulse) = (time - events[begin].parameter(), x.hypot(*y));
        let relative = |error: f64, of: f64| if error.is_finite() && of > 0.0 { error / of } else { 0.0 };
        let EventErrors { parameter: time, impulse: of_impulse, largest_force: of_force, .. } = errors[end];
        let largest = relative(time, duration)
            .max(relative(errors[begin].parameter, duration))
            .max(relative(of_impulse.unwrap_or(0.0), impulse))
            .max(relative(of_force.unwrap_or(0.0), *largest_force));
        let least = |scale: f64| LEAST * largest * scale;
        for error in [begin, end] {
            errors[error].parameter = errors[error].parameter.max(least(duration));
        }
        errors[end].impulse = of_impulse.map(|error| error.max(least(impulse)));
        errors[end].largest_force = of_force.map(|error| error.max(least(*largest_force)));
    }
}

/// The error of a quantity in that of what its probe sees, at this place.
fn of_quantity(quantity: ProbeQuantity, errors: &ProbeSample, model: &Model, at: Place) -> Option<f64> {
    use ProbeQuantity::{
        Angle, AxialForce, BendingMoment, Curvature, ShearForce, Speed, Strain, StressBottom, StressTop, Vx,
        Vy, X, Y,
    };
    let section = &model.beams.get(at.beam)?.section;
    match quantity {
        X => Some(errors.x),
        Y => Some(errors.y),
        Angle => Some(errors.angle),
        Vx => errors.vx,
        Vy => errors.vy,
        Speed => errors.vx.zip(errors.vy).map(|(x, y)| x.max(y)),
        Strain => Some(errors.strain),
        Curvature => Some(errors.curvature),
        AxialForce => section.axial_stiffness.as_ref().map(|along| along.at(at.s, at.s) * errors.strain),
        BendingMoment => {
            section.bending_stiffness.as_ref().map(|along| along.at(at.s, at.s) * errors.curvature)
        }
        ShearForce | StressBottom | StressTop => None,
    }
}

/// The same of its rate.
fn of_rate(quantity: ProbeQuantity, errors: &ProbeSample) -> Option<f64> {
    match quantity {
        ProbeQuantity::X => errors.vx,
        ProbeQuantity::Y => errors.vy,
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::difference::tests::scene;

    /// Forty records: two on either side count.
    #[test]
    fn the_largest_error_around_a_record_counts() {
        let mut samples = vec![ProbeSample { vx: Some(0.0), ..ProbeSample::default() }; 40];
        samples[10] =
            ProbeSample { x: 4.0, y: 6.0, angle: 8.0, curvature: 9.0, strain: 12.0, vx: Some(2.0), vy: None };
        samples[36].y = 10.0;
        samples[20].x = f64::NAN;
        let found = of_probe(ProbeErrors { name: "tip".into(), samples }).samples;
        let x = |value: f64| found.iter().enumerate().filter(move |(_, s)| s.x == value).map(|(i, _)| i);
        assert_eq!(x(4.0).collect::<Vec<_>>(), [8, 9, 10, 11, 12]);
        let around =
            ProbeSample { x: 4.0, y: 6.0, angle: 8.0, curvature: 9.0, strain: 12.0, vx: Some(2.0), vy: None };
        assert_eq!((found[8], found[12]), (around, around));
        // At the end four before it do.
        assert_eq!([33, 34, 37, 38, 39].map(|i| found[i].y), [0.0, 10.0, 10.0, 10.0, 10.0]);
        assert!(found[20].x.is_nan() && found[19].x == 0.0, "of a record nothing may be known");
    }

    /// A tip with errors of 0.5 m and 2 m/s around an event at 1.5 s: EA = 1 N and EI = 1 N m².
    #[test]
    fn events_err_by_what_their_quantity_does() {
        let scene = scene("dynamic = { duration = 1 }");
        let sample = ProbeSample {
            x: 0.5,
            y: 0.25,
            angle: 1.0,
            curvature: 4.0,
            strain: 8.0,
            vx: Some(2.0),
            vy: Some(1.0),
        };
        let samples =
            vec![ProbeSample { x: 9.0, ..sample }, sample, sample, ProbeSample { x: 9.0, ..sample }];
        let probes = [ProbeErrors { name: "tip".into(), samples }];
        let of = |quantity: &'static str, turns: Option<&'static str>, rates: [f64; 2], seen: f64| {
            let event = Event::Probe { time: 1.5, probe: "tip".into(), quantity, value: 0.0, turns, rates };
            let motion = Trajectory {
                parameter: vec![0.0, 1.0, 2.0, 3.0],
                events: vec![event],
                ..Trajectory::default()
            };
            let value = turns.map(|_| 0.0);
            let errors = vec![EventErrors { parameter: seen, value, ..EventErrors::default() }];
            let found = of_events(errors, scene.model(), &motion, &probes)[0];
            (found.parameter, found.value)
        };
        assert_eq!(of("x", None, [-4.0, 0.0], 0.0), (0.125, None));
        assert_eq!(of("x", None, [4.0, 0.0], 0.25), (0.25, None), "what was seen is larger");
        // Where it only just reaches its value, t²/2 q'' = 1/2.
        assert_eq!(of("x", None, [0.0, 4.0], 0.0), (0.5, None));
        assert_eq!(of("y", Some("maximum"), [0.0, -8.0], 0.0), (0.125, Some(0.25)));
        assert_eq!(of("x", Some("minimum"), [0.0, 8.0], 0.0), (0.25, Some(0.5)));
        assert_eq!(of("vx", Some("minimum"), [0.0, 8.0], 0.0), (1.0, Some(2.0)));
        assert_eq!(of("speed", None, [8.0, 0.0], 0.0), (0.25, None));
        assert_eq!(of("bending_moment", None, [8.0, 0.0], 0.0), (0.5, None));
        assert_eq!(of("axial_force", None, [8.0, 0.0], 0.0), (1.0, None));
        assert_eq!(of("shear_force", Some("maximum"), [8.0, 0.0], 0.0), (f64::INFINITY, Some(f64::INFINITY)));
    }

    /// Of the second mode a part of a hundredth is told, as of the first, and of the third, which errs by more, and of what is regained, what
    /// was seen.
    #[test]
    fn higher_modes_are_known_no_better() {
        let change = |load_factor: f64, stability: &'static str, directions: [usize; 2]| Event::Stability {
            load_factor,
            stability,
            unstable_directions: Some(directions),
            resolution: 0.0,
        };
        let events = vec![
            change(1.0, "lost", [0, 1]),
            change(-4.0, "lost", [1, 2]),
            change(9.0, "lost", [2, 3]),
            change(2.0, "regained", [3, 2]),
        ];
        let told =
            [0.01, 1e-3, 0.5, 1e-3].map(|parameter| EventErrors { parameter, ..EventErrors::default() });
        let path = Trajectory { events, ..Trajectory::default() };
        let found = of_events(told.to_vec(), &Model::default(), &path, &[]);
        assert_eq!(found.iter().map(|error| error.parameter).collect::<Vec<_>>(), [0.01, 0.04, 0.5, 1e-3]);
    }

    /// Two runs that agree tell no more than how far a change of stability was sought, and no more than round-off leaves.
    #[test]
    fn changes_of_stability_are_known_as_far_as_they_are_sought() {
        let change = |load_factor: f64, resolution: f64| Event::Stability {
            load_factor,
            stability: "lost",
            unstable_directions: None,
            resolution,
        };
        let events = vec![change(-2.0, 0.0), change(0.5, 0.25), change(0.5, 0.25)];
        let told = [0.0, 0.0, 1.0].map(|parameter| EventErrors { parameter, ..EventErrors::default() });
        let path = Trajectory { events, ..Trajectory::default() };
        let found = of_events(told.to_vec(), &Model::default(), &path, &[]);
        assert_eq!(found.iter().map(|error| error.parameter).collect::<Vec<_>>(), [2e-7, 0.25, 1.0]);
    }

    /// A contact of 2 s with an impulse of 10 N s and up to 8 N, of which the duration errs by half: nothing errs by less than a tenth.
    /// Of another one, and where nothing is known, it tells nothing; and no time is better known than its round-off.
    #[test]
    fn all_numbers_of_a_contact_err_alike() {
        let contact = |time: f64, contact: &str, touches: bool| {
            let impulse = (!touches).then_some(ContactImpulse { impulse: [6.0, -8.0], largest_force: 8.0 });
            Event::Contact { time, contact: contact.into(), touches, impulse }
        };
        let events = vec![
            contact(1.0, "arm.1", true),
            contact(1.0, "arm.1", false),
            contact(2.0, "arm.1", true),
            contact(2.0, "leg.1", true),
            contact(4.0, "arm.1", false),
            contact(6.0, "leg.1", false),
        ];
        let ended = |time, impulse, largest_force| EventErrors {
            parameter: time,
            value: None,
            impulse: Some(impulse),
            largest_force: Some(largest_force),
        };
        let at = |time: f64| EventErrors { parameter: time, ..EventErrors::default() };
        let none = ended(0.0, 0.0, 0.0);
        let errors = vec![at(0.0), none, at(1.0), at(0.0), ended(0.0, 2.0, 0.0), EventErrors::UNKNOWN];
        let motion = Trajectory { events, ..Trajectory::default() };
        let found = of_events(errors, &Model::default(), &motion, &[]);
        assert_eq!(found[0], at(f64::EPSILON));
        assert_eq!(found[1], EventErrors { parameter: f64::EPSILON, ..none });
        assert_eq!((found[2], found[4]), (at(1.0), ended(0.2, 2.0, 0.8)));
        assert_eq!((found[3], found[5]), (at(2.0 * f64::EPSILON), EventErrors::UNKNOWN));
    }
}
