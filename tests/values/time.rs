//! Laws of time and what follows them: a free rod of mass m under m a f(t) has the velocity a ∫ f
//! dt and the place a ∬ f dt dt.

use super::{ROD, SECOND, Written, near};
use std::f64::consts::{FRAC_PI_6, PI, TAU};

/// Each law with ∫₀¹ f dt and ∫₀¹ (1 − t) f dt, by hand.
fn laws() -> [(&'static str, [f64; 2]); 11] {
    // From 0.2 s for 0.5 s: half of that, and 0.3 s more at 1.
    let after = 0.25 * 0.3 + 0.5 * 0.3 * 0.3;
    let (w, phase) = (TAU * 0.7, 40.0 * PI / 180.0);
    let sine = [
        (phase.cos() - (w + phase).cos()) / w,
        phase.cos() / w - ((w + phase).sin() - phase.sin()) / (w * w),
    ];
    [
        ("ramp = { start = '200 ms', duration = '500 ms' }", [0.55, 0.25 / 6.0 + after]),
        ("ramp = { duration = 0.5 }", [0.75, 0.25 / 6.0 + 0.25 * 0.5 + 0.125]),
        // ∬ (10 x³ − 15 x⁴ + 6 x⁵) = 1/7
        ("smooth_ramp = { start = 0.2, duration = 0.5 }", [0.55, 0.25 / 7.0 + after]),
        ("step = { start = '300 ms' }", [0.7, 0.245]),
        ("harmonic = { frequency = '0.7 Hz', phase = '40 deg' }", sine),
        // Without a phase it begins at zero.
        ("harmonic = { frequency = 0.5 }", [2.0 / PI, 1.0 / PI]),
        ("polynomial = [1, -2, 3]", [1.0, 0.5 - 1.0 / 3.0 + 0.25]),
        // Straight: 0.2 + 0.3 · 2 + 0.3 · 1 − 0.2.
        ("table = { times = [0.2, 0.5, 0.8], values = [1, 3, -1] }", [0.9, 0.67]),
        // The natural spline has the second derivatives 0, −100, 0 there, and so 2 · 0.3³ · 100/24
        // more below it.
        ("table = { times = [0.2, 0.5, 0.8], values = [1, 3, -1], smooth = true }", [1.125, 0.7825]),
        ("sum = [{ polynomial = [1, 2] }, { step = { start = 0.5 } }]", [2.5, 0.5 + 1.0 / 3.0 + 0.125]),
        // t sin(π t/2), with w = π/2.
        (
            "product = [{ polynomial = [0, 1] }, { harmonic = { frequency = 0.25 } }]",
            [4.0 / (PI * PI), 16.0 / (PI * PI * PI) - 4.0 / (PI * PI)],
        ),
    ]
}

/// Would catch a start that is ignored, a frequency without 2π, a phase of the other sign or in
/// degrees, coefficients in reverse, a smooth table for a straight one, and components of the load
/// that are swapped.
#[test]
fn a_free_rod_integrates_every_law_twice() {
    for (law, [velocity, place]) in laws() {
        let load =
            format!("effect.distributed_force = [{{ beam = 'rod', value = [3, -5], in_time.{law} }}]\n");
        let found = Written::of(&format!("{ROD}{load}{SECOND}"));
        let expected = [
            ("middle.vx", 1.5 * velocity),
            ("middle.vy", -2.5 * velocity),
            ("middle.x", 0.5 + 1.5 * place),
            ("middle.y", -2.5 * place),
        ];
        found.ends("probes.csv", &expected, 1e-6);
    }
}

/// Every load that may follow a law follows it: would catch one that acts in full, or whose law is
/// dropped on the way.
#[test]
fn every_load_follows_its_law() {
    let law = "in_time.ramp = { start = 0.2, duration = 0.5 }";
    let place = 0.25 / 6.0 + 0.25 * 0.3 + 0.045;
    // A force in the middle, a couple (moment of inertia 2/12), weight of the rod, lift of the
    // fluid for a third of it.
    for (acts, name, expected) in [
        (
            format!("effect.force = [{{ beam = 'rod', at = 0.5, value = [0.1, 0.3], {law} }}]\n"),
            "middle.y",
            0.15,
        ),
        (
            format!("effect.force = [{{ beam = 'rod', at = 0.5, value = [0.1, 0.3], {law} }}]\n"),
            "middle.x",
            0.05,
        ),
        (
            format!("effect.moment = [{{ beam = 'rod', at = 0.5, value = 0.05, {law} }}]\n"),
            "middle.angle",
            0.3,
        ),
        (format!("effect.gravity = {{ acceleration = [0.4, -9.81], {law} }}\n"), "middle.x", 0.4),
        (format!("effect.gravity = {{ acceleration = [0.4, -9.81], {law} }}\n"), "middle.y", -9.81),
        (
            format!(
                "effect.gravity = {{ acceleration = [0.4, -9.81], {law} }}\n\
                 effect.buoyancy = [{{ beam = 'rod', displaced_mass_per_length = 0.5 }}]\n"
            ),
            "middle.y",
            -9.81 * 0.75,
        ),
    ] {
        let found = Written::of(&format!("{ROD}{acts}{SECOND}"));
        let rest = if name == "middle.x" { 0.5 } else { 0.0 };
        near(found.last("probes.csv", name), rest + expected * place, 2e-6, &acts);
    }
}

/// A bar so light that it follows at once stretches and bends by what actuates it, times the law.
#[test]
fn actuation_follows_its_law() {
    let text = "beam.bar = { start = [0, 0], end = [2, 0], axial_stiffness = 1e5, bending_stiffness = 1e3, \
        mass_per_length = 1e-4, basis.ancf.elements = 4 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.actuation = [{ beam = 'bar', strain = 2e-3, curvature = 0.3, \
        in_time.smooth_ramp = { start = 0.2, duration = 1.6 } }]
        probe = [{ name = 'end', beam = 'bar', at = 'end' }]
        analysis.dynamic = { duration = 1, output_every = 0.5, radau.tolerance = 1e-7 }\n";
    let found = Written::of(text);
    // In the middle of the ramp the factor is a half.
    let expected = [("end.strain", 1e-3), ("end.curvature", 0.15), ("end.angle", 0.3)];
    found.ends("probes.csv", &expected, 1e-4);
}

/// A clamp that moves: would catch x for y, an angle without its law, and a spin-up of another
/// duration or speed.
#[test]
fn supports_go_where_their_laws_say() {
    let clamp = |at: &str| {
        format!(
            "support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'], move = {{ {at} }} }}]\n"
        )
    };
    let law = "in_time.polynomial = [0, 1, 2]";
    let moved = clamp(&format!("x = '3 cm', y = '-20 mm', angle = '10 deg', {law}"));
    let found = Written::of(&format!("{ROD}{moved}{SECOND}"));
    for (i, time) in [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
        let factor = time + 2.0 * time * time;
        let expected = [("start.x", 0.03), ("start.y", -0.02), ("start.angle", PI / 18.0)];
        for (name, value) in expected {
            near(found.column("probes.csv", name)[i], value * factor, 1e-9, name);
        }
        near(found.column("probes.csv", "start.vx")[i], 0.03 * (1.0 + 4.0 * time), 1e-8, "vx");
    }
    let hub =
        Written::of(&format!("{ROD}{}{SECOND}", clamp("spin_up = { speed = '3 rad/s', duration = 0.5 }")));
    let angles = hub.column("probes.csv", "start.angle");
    // Ω/T (t²/2 + (T/2π)² (cos(2πt/T) − 1)) in the middle of the run-up, and Ω (t − T/2) behind it.
    near(angles[1], 6.0 * (0.03125 - 2.0 * (0.25 / PI).powi(2)), 1e-9, "half way");
    near(angles[4], 3.0 * 0.75, 1e-9, "at speed");
    // The same a quarter of a second later.
    let later = clamp("spin_up = { start = 0.25, speed = '3 rad/s', duration = 0.5 }");
    let later = Written::of(&format!("{ROD}{later}{SECOND}"));
    for (later, angle) in later.column("probes.csv", "start.angle")[1..].iter().zip(angles) {
        near(*later, angle, 1e-9, "later");
    }
}

/// In statics what moves does so with the load factor, and the other of two supports stays.
#[test]
fn prescribed_displacements_are_full_at_full_load() {
    let text = "beam.bar = { start = [0, 0], end = [2, 0], axial_stiffness = 1e3, bending_stiffness = 1, \
        basis.ancf.elements = 4 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y', 'gradient'] }, \
        { beam = 'bar', at = 'end', fix = ['x', 'y', 'angle'], move = { x = 0.01, y = 2e-4, angle = 3e-4 } }]
        probe = [{ name = 'end', beam = 'bar', at = 'end' }, { name = 'start', beam = 'bar', at = 'start' }]
        analysis.static.steps = 4\n";
    let found = Written::of(text);
    assert_eq!(found.column("probes.csv", "load"), [0.0, 0.25, 0.5, 0.75, 1.0]);
    for (i, load) in [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
        for (name, value) in [
            ("end.x", 2.0 + 0.01 * load),
            ("end.y", 2e-4 * load),
            ("end.angle", 3e-4 * load),
            ("start.strain", 0.0),
        ] {
            near(found.column("probes.csv", name)[i], value, 1e-12, name);
        }
    }
}

/// A force that crosses a free rod within half a second pushes its centre by F/m, and turns it by
/// −F/I/48 s² to the side where it came on first.
#[test]
fn a_moving_force_acts_while_it_is_on_the_rod() {
    // F = 0.02 N on 2 kg with the moment of inertia 2/12.
    let turned = 0.02 / (2.0 / 12.0) / 48.0;
    for (travels, arrives, angle) in [
        ("speed = 2, start = -0.5", 0.25, -turned),
        ("speed = -2, start = 1.5", 0.25, turned),
        // At the rod's start where nothing is said.
        ("speed = 2", 0.0, -turned),
    ] {
        let acts = format!("effect.moving_force = [{{ beam = 'rod', value = [0.01, 0.02], {travels} }}]\n");
        let found = Written::of(&format!("{ROD}{acts}{SECOND}"));
        let left = 1.0 - arrives - 0.5;
        let (velocity, place) = (0.01 * 0.5, 0.01 * (0.125 + 0.5 * left));
        let expected = [("middle.vy", velocity), ("middle.y", place), ("middle.x", 0.5 + 0.5 * place)];
        // It leaves some vibration behind.
        found.ends("probes.csv", &expected, 2e-5);
        near(found.last("probes.csv", "middle.angle"), angle, 2e-5, travels);
    }
}

/// Velocities at the start: a rigid motion about a point, a polynomial and a table along the rod;
/// would catch the other sense of rotation, a centre that is forgotten, coefficients in reverse,
/// and vx for vy.
#[test]
fn velocities_at_the_start_are_those_of_the_scene() {
    let first = |velocity: &str| {
        let found = Written::of(&format!(
            "{ROD}initial_velocity = [{{ beam = 'rod', {velocity} }}]\n\
             analysis.dynamic = {{ duration = 1e-3, output_every = 1e-3, radau.tolerance = 1e-9 }}\n"
        ));
        ["start", "middle", "end"]
            .map(|probe| ["vx", "vy"].map(|axis| found.column("probes.csv", &format!("{probe}.{axis}"))[0]))
    };
    let about = first("value = ['20 cm/s', 0.1], rotation = '3 rad/s', about = [0.25, 0.5]");
    // v + ω × (r − c)
    let exact = [[0.2 + 1.5, 0.1 - 0.75], [0.2 + 1.5, 0.1 + 0.75], [0.2 + 1.5, 0.1 + 2.25]];
    let polynomial = first("polynomial = { vx = [0.1, 0, 0.2], vy = [0.3, -0.4] }");
    let table = first("table = { s = [0, 0.5, 1], vx = [0, 0.1, 0.3], vy = ['1 cm/s', -0.02, 0.05] }");
    for (found, exact) in [
        (about, exact),
        (polynomial, [[0.1, 0.3], [0.15, 0.1], [0.3, -0.1]]),
        (table, [[0.0, 0.01], [0.1, -0.02], [0.3, 0.05]]),
    ] {
        for (found, exact) in found.concat().into_iter().zip(exact.concat()) {
            near(found, exact, 1e-10, "a velocity");
        }
    }
}

/// A rod thrown up crosses a height twice, and a line across its way once: when, where, and from
/// which side.
#[test]
fn events_are_when_and_where_the_rod_crosses() {
    let thrown = |event: &str| {
        let text = format!(
            "{ROD}effect.gravity.acceleration = [0, -10]\ninitial_velocity = [{{ beam = 'rod', value = [2, 4] }}]\n\
             analysis.dynamic = {{ duration = 1, output_every = 0.25, radau.tolerance = 1e-9, event = [{{ {event} }}] }}\n"
        );
        let found = Written::of(&text);
        let events = found.summary()["events"].as_array().cloned().unwrap_or_default();
        (found.said("/last"), events)
    };
    // 4 t − 5 t² = 0.6 at 0.2 s and 0.6 s; the rod's end is at x = 1.5 after 0.25 s.
    for (event, axis, value, times, last) in [
        ("probe = 'middle', y = '60 cm', crossing = 'any'", "y", 0.6, &[0.2, 0.6][..], 1.0),
        ("probe = 'middle', y = 0.6, crossing = 'rising'", "y", 0.6, &[0.2], 1.0),
        ("probe = 'middle', y = 0.6, crossing = 'falling'", "y", 0.6, &[0.6], 1.0),
        ("probe = 'end', x = 1.5, crossing = 'rising', stop = true", "x", 1.5, &[0.25], 0.25),
        ("probe = 'end', x = 1.5, crossing = 'falling', stop = true", "x", 1.5, &[], 1.0),
    ] {
        let (reached, events) = thrown(event);
        near(reached, last, 1e-7, event);
        assert_eq!(events.len(), times.len(), "{event}: {events:?}");
        for (found, time) in events.iter().zip(times) {
            near(found["time"].as_f64().expect("a time"), *time, 1e-7, event);
            assert_eq!(
                (found["quantity"].as_str(), found["value"].as_f64()),
                (Some(axis), Some(value)),
                "{event}"
            );
            assert_eq!(found["probe"].as_str(), event.split('\'').nth(1), "{event}");
        }
    }
}

/// The sense of angles: a rod that turns counter-clockwise has a growing angle, over more than one
/// turn.
#[test]
fn angles_count_turns_counter_clockwise() {
    let text = format!(
        "{ROD}initial_velocity = [{{ beam = 'rod', rotation = '2.5 turn/s', about = [0.5, 0] }}]\n\
         analysis.dynamic = {{ duration = 1, output_every = 0.1, radau.tolerance = 1e-7 }}\n"
    );
    let found = Written::of(&text);
    // Half the rod stretches it by its centrifugal force, which slows it down a little.
    near(found.last("probes.csv", "middle.angle"), 5.0 * PI, 5e-3, "angle");
    let angles = found.column("probes.csv", "middle.angle");
    near(angles[1], 3.0 * FRAC_PI_6, 1e-3, "after a tenth of a second");
}

/// A pulse of ∫ f dt = 0.1 √π N s/m, of any width, with nothing before it that would make steps short or beside something slow,
/// gives a free rod of 1 kg/m its velocity, and takes it v (10 s − 3.37 s) far.
#[test]
fn no_step_passes_over_a_pulse() {
    for (integrator, tolerance) in [
        ("", 1e-6),
        (", radau.tolerance = 1e-3", 1e-6),
        (", generalized_alpha.tolerance = 1e-4", 1e-4),
        (", generalized_alpha.step = '5 ms'", 5e-4),
        (", gauss.step = '50 ms'", 2e-5),
        (", gauss = { stages = 2, step = 0.3 }", 2e-5),
        (", radau = { stages = 2, step = 0.1 }", 1e-6),
    ] {
        for width in [1e-2, 1e-3, 1e-5, 1e-8] {
            for (before, gives) in [("", 0.0), ("1e-4*sin(2*t) + ", 5e-5 * (1.0 - 20.0_f64.cos()))] {
                let pulse = format!("{before}{:e}*exp(-((t-3.37)/{width:e})^2)", 0.1 / width);
                let found = Written::of(&format!(
                    "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 100, mass_per_length = 1, basis.ancf.elements = 4 }}
                    effect.distributed_force = [{{ beam = 'rod', value = [0, 1], in_time.expression = '{pulse}' }}]
                    probe = [{{ name = 'tip', beam = 'rod', at = 'end' }}]
                    analysis.dynamic = {{ duration = 10, output_every = 5{integrator} }}\n"
                ));
                let velocity = 0.1 * std::f64::consts::PI.sqrt();
                let what = format!("{pulse}{integrator}");
                near(found.last("probes.csv", "tip.vy"), velocity + gives, tolerance * velocity, &what);
                if before.is_empty() {
                    near(
                        found.last("probes.csv", "tip.y"),
                        6.63 * velocity,
                        7.0 * tolerance * velocity,
                        &what,
                    );
                }
            }
        }
    }
}

/// A load acts as its two halves do, and takes the same steps: an expression divides steps of fixed
/// length only where it changes within one, not where it stands twice.
#[test]
fn halves_of_an_expression_act_as_the_whole() {
    let law = "expression = 'sin(14*t)'";
    let of = |effects: &str| {
        Written::of(&format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 3 }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
            effect.force = [{effects}]
            probe = [{{ name = 'end', beam = 'arm', at = 'end' }}]
            analysis.dynamic = {{ duration = 1, output_every = 0.1, gauss.step = 0.00390625 }}\n"
        ))
    };
    let force = |value: f64, law: &str| {
        format!("{{ beam = 'arm', at = 'end', value = [0, {value}], in_time = {{ {law} }} }}")
    };
    let whole = of(&force(0.5, law));
    let half = force(0.25, law);
    let halves = of(&format!("{half}, {half}"));
    let sum = of(&force(0.25, &format!("sum = [{{ {law} }}, {{ {law} }}]")));
    for other in [halves, sum] {
        let [a, b] = [&whole, &other].map(|found| found.column("probes.csv", "end.y"));
        a.iter().zip(&b).for_each(|(a, b)| near(*a, *b, 1e-12, "the place of the tip"));
    }
}

/// A load that is written as an expression acts as the same load in other words, and an expression
/// has its kinks where it says: the motion of a point that is moved by it.
#[test]
fn expressions_are_the_functions_that_they_spell() {
    let text = |law: &str| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 3 }}
            support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'], move = {{ y = 0.1, in_time = {{ {law} }} }} }}]
            effect.force = [{{ beam = 'arm', at = 'end', value = [0, 0.3], in_time = {{ {law} }} }}]
            probe = [{{ name = 'start', beam = 'arm', at = 'start' }}, {{ name = 'end', beam = 'arm', at = 'end' }}]
            analysis.dynamic = {{ duration = 1, output_every = 0.1, radau.tolerance = 1e-10 }}\n"
        )
    };
    let same = [
        ("expression = 'sin(2*pi*t)*(1-exp(-t/0.5))'", None),
        ("expression = '-t^2*(3 - 2*t)'", Some("polynomial = [0, 0, -3, 2]")),
        (
            "product = [{ expression = '2' }, { harmonic.frequency = 0.5 }]",
            Some("sum = [{ expression = 'sin(pi*t)' }, { harmonic.frequency = 0.5 }]"),
        ),
        (
            "product = [{ step.start = 0.45 }, { expression = { of = '(t-0.45)^2', kinks = ['450 ms'] } }]",
            Some("product = [{ step.start = 0.45 }, { polynomial = [0.2025, -0.9, 1] }]"),
        ),
    ];
    for (law, other) in same {
        let found = Written::of(&text(law));
        if let Some(other) = other {
            let other = Written::of(&text(other));
            for (a, b) in found.column("probes.csv", "end.y").iter().zip(other.column("probes.csv", "end.y"))
            {
                near(*a, b, 1e-9, law);
            }
            continue;
        }
        for (t, y) in found.column("probes.csv", "time").iter().zip(found.column("probes.csv", "start.y")) {
            near(y, 0.1 * (std::f64::consts::TAU * t).sin() * (1.0 - (-t / 0.5).exp()), 1e-14, law);
        }
    }
    let refused =
        ancf::scene::parse("law.toml", &text("expression = 'sin(2*pi*t'")).expect_err("no expression");
    assert!(
        refused.to_string().contains("a bracket is not closed")
            && refused.to_string().contains("law.toml:2:"),
        "{refused}"
    );
}
