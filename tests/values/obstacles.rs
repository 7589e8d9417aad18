//! Contacts: where a falling rod touches first, and how deep a resting one sinks, by geometry and
//! balance.

use super::{Written, near};

/// A horizontal rod 40 cm long falls from the height `height`, its start at `x`: when it touches
/// `obstacle`, from which y follows.
fn lands([x, height]: [f64; 2], obstacle: &str) -> f64 {
    let text = format!(
        "beam.rod = {{ start = [{x:?}, {height:?}], end = [{:?}, {height:?}], axial_stiffness = 1e5, bending_stiffness = 1e3, \
         mass_per_length = 1, basis.ancf.elements = 2 }}
         effect.gravity.acceleration = [0, -10]
         effect.contact = [{{ beam = 'rod', stiffness = 1e5, {obstacle} }}]
         analysis.dynamic = {{ duration = 0.6, output_every = 0.1, radau.tolerance = 1e-7 }}\n",
        x + 0.4
    );
    let found = Written::of(&text);
    let summary = found.summary();
    let event = &summary["events"][0];
    assert_eq!(
        (event["touches"].as_bool(), event["contact"].as_str()),
        (Some(true), Some("rod.1")),
        "{summary}"
    );
    let time = event["time"].as_f64().expect("a time");
    height - 5.0 * time * time
}

/// Would catch sides of a box that are halved, doubled or swapped, an angle of the other sense,
/// half a thickness that is the whole or a quarter, a hole that is a disc, and a normal or a point
/// that is another.
#[test]
fn a_falling_rod_touches_where_the_surface_is() {
    let (sine, cosine) = 20.0_f64.to_radians().sin_cos();
    for (start, obstacle, height) in [
        ([0.3, 1.0], "box = { center = [0.5, 0.1], size = ['3 m', '40 cm'] }, half_thickness = '5 cm'", 0.35),
        ([0.3, 1.0], "box = { center = [0.5, 0.1], size = [3, 0.4] }", 0.3),
        // Turned by 20°, its upper side rises to the right: the rod's end at x = 0.7 is the first
        // to touch.
        (
            [0.3, 1.2],
            "box = { center = [0, 0], size = [3, 0.4], angle = '20 deg' }, half_thickness = 0.05",
            (0.25 + 0.7 * sine) / cosine,
        ),
        // The other way round its start is.
        (
            [0.3, 1.0],
            "box = { center = [0, 0], size = [3, 0.4], angle = '-20 deg' }",
            (0.2 - 0.3 * sine) / cosine,
        ),
        // A corner under the rod's middle.
        ([-0.2, 1.2], "box = { center = [0, 0], size = [0.6, 0.8], angle = '45 deg' }", 1.4 / 8.0_f64.sqrt()),
        ([0.3, 1.0], "circle = { center = [0.5, -0.2], radius = '60 cm' }, half_thickness = 0.02", 0.42),
        // The ends of the rod come to the rim of a hole.
        (
            [0.3, 1.0],
            "circle = { center = [0.5, 0.9], radius = 0.7, inside = true }, half_thickness = 0.02",
            0.9 - (0.68_f64 * 0.68 - 0.04).sqrt(),
        ),
        ([0.3, 1.0], "half_plane = { point = [0, 0.1], normal = [0, 2] }, half_thickness = 0.05", 0.15),
        // (r − p)·n = 0 with n = (0.6, 0.8): the rod's start is nearest.
        ([0.3, 1.0], "half_plane = { point = [0.1, 0.3], normal = [3, 4] }", 0.3 - 0.75 * 0.2),
    ] {
        near(lands(start, obstacle), height, 1e-6, obstacle);
    }
}

/// A stiff rod under an even load sinks into the ground by q/k, and is dragged along it by what the
/// springs of friction give way: q_x/k_t.
///
/// Would catch a stiffness that is doubled, and a default of the friction's stiffness other than
/// that of the contact.
#[test]
fn a_resting_rod_sinks_and_slips_by_load_over_stiffness() {
    for (friction, slip) in [
        ("friction = { coefficient = 0.5, stiffness = '50 N/m^2' }", 0.2 / (50.0 + 10.0)),
        ("friction = { coefficient = 0.5 }", 0.2 / (200.0 + 10.0)),
    ] {
        let text = format!(
            "beam.rod = {{ start = [0, 0.05], end = [1, 0.05], axial_stiffness = 1e6, bending_stiffness = 1e4, basis.ancf.elements = 2 }}
             effect.contact = [{{ beam = 'rod', half_plane = {{ point = [0, 0], normal = [0, 1] }}, stiffness = '200 N/m^2', \
             half_thickness = '50 mm', {friction} }}]
             effect.foundation = [{{ beam = 'rod', stiffness = [10, 0] }}]
             effect.distributed_force = [{{ beam = 'rod', value = [0.2, -2] }}]
             probe = [{{ name = 'middle', beam = 'rod', at = 0.5 }}]
             output.effects = true
             analysis.static = {{}}\n"
        );
        let found = Written::of(&text);
        let expected = [("middle.x", 0.5 + slip), ("middle.y", 0.04)];
        found.ends("probes.csv", &expected, 1e-6);
        let expected = [
            ("contact.rod.energy", 0.5 * 2.0 * 0.01),
            ("contact.rod.fx", 0.0),
            ("contact.rod.fy", 2.0),
            ("friction.rod.fx", -(0.2 - 10.0 * slip)),
        ];
        found.ends("effects.csv", &expected, 1e-5);
    }
}

/// ½ k ∫ d² ds of straight rods in a box and beside it, by hand: depths d have a kink where another side is
/// nearer, where they begin, and, at a distance of the surface, at the circles about the corners. Quadrature
/// is exact between these.
#[test]
fn the_energy_in_a_box_is_the_integral_of_its_depth() {
    let flat = |depth: f64, to: f64| depth * depth * 2.0 * (to - depth) + 2.0 * depth.powi(3) / 3.0;
    // ∫ (g − √(u² + h²))² du from 0 to the rim, where √(u² + h²) = g.
    let corner = {
        let (g, h, rim) = (0.05_f64, 0.04_f64, 0.03_f64);
        (g * g + h * h) * rim + rim.powi(3) / 3.0 - g * (rim * g + h * h * (rim / h).asinh())
    };
    for (half, [start, end], gap, integral) in [
        // Along the longer side, near it and near the middle; along the shorter one.
        ([0.3, 0.2], [[-1.0, 0.19], [1.0, 0.19]], 0.0, flat(0.01, 0.3)),
        ([0.3, 0.2], [[-1.0, 0.05], [1.0, 0.05]], 0.0, flat(0.15, 0.3)),
        ([0.3, 0.2], [[-0.26, -1.0], [-0.26, 1.0]], 0.0, flat(0.04, 0.2)),
        // Through the middle aslant: 0.2 − |y|.
        ([0.3, 0.2], [[-0.5, -0.5], [0.5, 0.5]], 0.0, 2.0_f64.sqrt() * 2.0 * 0.008 / 3.0),
        ([0.2, 0.3], [[-0.5, -0.5], [0.5, 0.5]], 0.0, 2.0_f64.sqrt() * 2.0 * 0.008 / 3.0),
        // Above the longer side, and beside the shorter one, at 0.04 of 0.05.
        ([0.3, 0.2], [[-1.0, 0.24], [1.0, 0.24]], 0.05, 1e-4 * 0.6 + 2.0 * corner),
        ([0.3, 0.2], [[0.34, -1.0], [0.34, 1.0]], 0.05, 1e-4 * 0.4 + 2.0 * corner),
        // Across, with the gap: 0.25 − |y| at its deepest.
        ([0.3, 0.2], [[0.0, -1.0], [0.0, 1.0]], 0.05, 2.0 * 0.25_f64.powi(3) / 3.0),
    ] {
        let gap = if gap > 0.0 { format!(", half_thickness = {gap}") } else { String::new() };
        for (degrees, elements) in [(0.0_f64, 1), (35.0, 3)] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let turned = |[x, y]: [f64; 2]| [0.7 + cosine * x - sine * y, -0.4 + sine * x + cosine * y];
            let text = format!(
                "beam.rod = {{ start = {:?}, end = {:?}, axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = {elements} }}
                 effect.contact = [{{ beam = 'rod', stiffness = 6{gap}, \
                 box = {{ center = [0.7, -0.4], size = {:?}, angle = '{degrees} deg' }} }}]
                 analysis.dynamic = {{ duration = 1e-6, output_every = 1e-6 }}\n",
                turned(start),
                turned(end),
                half.map(|half| 2.0 * half),
            );
            let energy = Written::of(&text).column("energy.csv", "stored")[0];
            near(energy, 3.0 * integral, 1e-6 * integral, &text);
        }
    }
}

/// A rod whose middle alone can touch sinks in by all of its load over the part's stiffness, and rests
/// on it in balance; beyond it the rod goes through the obstacle.
///
/// Would catch a part that is counted from the wrong end, and one that ends at another node.
#[test]
fn a_rod_touches_only_where_it_can() {
    for (basis, friction) in [("ancf.elements = 3", ""), ("rpim.nodes = 7", ", friction.coefficient = 0.5")] {
        let text = format!(
            "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e4, basis.{basis} }}
             effect.contact = [{{ beam = 'rod', half_plane = {{ point = [0, 0.001], normal = [0, 1] }}, stiffness = 200, from = 0.3, to = '80 cm'{friction} }}]
             support = [{{ beam = 'rod', at = 'start', fix = ['angle'] }}]
             effect.foundation = [{{ beam = 'rod', stiffness = [10, 0] }}]
             effect.force = [{{ beam = 'rod', at = 0.55, value = [0, -2] }}]
             probe = [{{ name = 'middle', beam = 'rod', at = 0.5 }}, {{ name = 'end', beam = 'rod', at = 'end' }}]
             output = {{ effects = true, reactions = true }}
             analysis.static = {{}}\n"
        );
        let found = Written::of(&text);
        let expected = [("middle.y", -0.019), ("end.y", -0.019), ("end.angle", 0.0)];
        // The part is pressed in its middle, under the force.
        found.ends("reactions.csv", &[("support1.moment", 0.0)], 1e-5);
        found.ends("probes.csv", &expected, 1e-5);
        found.ends("effects.csv", &[("contact.rod.fy", 2.0), ("contact.rod.energy", 0.02)], 1e-5);
    }
    // A circle beside the part is not met.
    let free = "beam.rod = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }
        initial_velocity = [{ beam = 'rod', value = [0, -1] }]
        effect.contact = [{ beam = 'rod', circle = { center = [0.2, -0.1], radius = 0.05 }, stiffness = 1e4, from = 0.4 }]
        probe = [{ name = 'end', beam = 'rod', at = 'end' }]
        analysis.dynamic = { duration = 0.2, radau.tolerance = 1e-8 }\n";
    near(Written::of(free).last("probes.csv", "end.y"), -0.2, 1e-7, "y");
    let met = Written::of(&free.replace("from = 0.4", "to = 0.4"));
    assert!(met.last("probes.csv", "end.y") < -0.2 - 1e-3);
    assert_eq!(met.summary()["events"][0]["touches"], true);
}

/// A rod that bounces off the ground as it came: would catch impulses along another axis or of
/// another sign, forces and times that are another.
#[test]
fn a_bounce_gives_twice_the_momentum() {
    let rod = "beam.rod = { start = [0, 0.2], end = [0.4, 0.2], axial_stiffness = 1e5, bending_stiffness = 1e3, mass_per_length = 5, \
        basis.ancf.elements = 2 }
        probe = [{ name = 'end', beam = 'rod', at = 'end' }]\n";
    let text = format!(
        "{rod}initial_velocity = [{{ beam = 'rod', value = [0.1, -1] }}]
         effect.contact = [{{ beam = 'rod', half_plane = {{ point = [0, 0], normal = [0, 1] }}, stiffness = 1e4 }}]
         analysis.dynamic = {{ duration = 0.6, output_every = 0.1, radau.tolerance = 1e-8 }}\n"
    );
    let found = Written::of(&text);
    let events = found.summary()["events"].clone();
    let number = |event: usize, pointer: &str| events[event].pointer(pointer).and_then(|v| v.as_f64());
    // It touches at 0.2 s, with ω = √(k/ρA) for half a period π/ω; 2 kg.
    let frequency = (1e4_f64 / 5.0).sqrt();
    for (event, pointer, value) in [
        (0, "/time", 0.2),
        (1, "/time", 0.2 + std::f64::consts::PI / frequency),
        (1, "/impulse/0", 0.0),
        (1, "/impulse/1", 4.0),
        (1, "/largest_force", 2.0 * frequency),
    ] {
        let found = number(event, pointer).unwrap_or_else(|| panic!("{pointer} in {events}"));
        let tolerance = if pointer == "/largest_force" { 0.02 * value } else { 1e-5 };
        near(found, value, tolerance, pointer);
    }
    assert_eq!((events[0]["touches"].as_bool(), events[1]["touches"].as_bool()), (Some(true), Some(false)));
    found.ends("probes.csv", &[("end.vy", 1.0), ("end.vx", 0.1)], 1e-5);
    // With an accuracy alone all of them are as right as is told.
    let told = Written::of(
        &text.replace("basis.ancf.elements = 2", "").replace("radau.tolerance = 1e-8", "accuracy = 1e-3"),
    );
    let events = told.summary()["events"].clone();
    let number = |event: usize, pointer: &str| {
        let found = events[event].pointer(pointer).and_then(|value| value.as_f64());
        found.unwrap_or_else(|| panic!("{pointer} in {events}"))
    };
    for (event, value, error, expected) in [
        (0, "/time", "/error/time", 0.2),
        (1, "/time", "/error/time", 0.2 + std::f64::consts::PI / frequency),
        (1, "/impulse/0", "/error/impulse", 0.0),
        (1, "/impulse/1", "/error/impulse", 4.0),
        (1, "/largest_force", "/error/largest_force", 2.0 * frequency),
    ] {
        let (found, error) = (number(event, value), number(event, error));
        assert!((found - expected).abs() <= 3.0 * error + 1e-9, "{value}: {found} ± {error} for {expected}");
        assert!(error < 0.02 * expected.abs().max(0.1), "{value}: {error}");
    }
}

/// A rod that begins within the ground is thrown out by energy that nothing put in, and that is said; one that begins as deep
/// as its weight presses it, or above, is not.
#[test]
fn a_motion_that_begins_within_an_obstacle_says_so() {
    let warned = |height: f64, springs: &str| {
        let text = format!(
            "beam.rod = {{ start = [0, {height:?}], end = [0.4, {height:?}], axial_stiffness = 1e5, bending_stiffness = 1e3, \
             mass_per_length = 1, basis.ancf.elements = 2 }}
             effect.gravity.acceleration = [0, -10]
             effect.contact = [{{ beam = 'rod', stiffness = 1e4, half_plane = {{ point = [0, 0], normal = [0, 1] }} }}]
             {springs}
             analysis.dynamic = {{ duration = 0.3, output_every = 0.01, radau.tolerance = 1e-6 }}\n"
        );
        Written::of(&text).summary()["warnings"].to_string().contains("begins within an obstacle")
    };
    assert_eq!([-0.1, -1e-3, 0.0, 0.1].map(|height| warned(height, "")), [true, false, false, false]);
    // What springs take up is no energy of the contact.
    let spring =
        "effect.spring = [{ beam = 'rod', at = 0.2, anchor = [0.2, -0.1], stiffness = 2e3, length = 0 }]";
    assert!(warned(-0.1, spring));
}

/// A bar that hangs on its hinge creeps down to a thin plate, and rests on it: with R = m g/2 at its tip, which sinks
/// into the plate by δ with ½ k δ²/sin θ = R.
#[test]
fn a_bar_comes_to_rest_on_a_thin_plate() {
    let found = Written::of(
        "beam.bar = { start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 4 }
        support = [{ beam = 'bar', at = 'start', fix = ['x', 'y'] }]
        effect.gravity.acceleration = [0, -9.81]
        effect.contact = [{ beam = 'bar', stiffness = 1e6, box = { center = [0.9, -0.3], size = [0.4, 0.01] } }]
        probe = [{ name = 'tip', beam = 'bar', at = 'end' }]
        analysis.static = {}\n",
    );
    let depth = (2.0 * (0.5 * 9.81) * 0.2967 / 1e6_f64).sqrt();
    near(found.last("probes.csv", "tip.y"), -0.295 - depth, 5e-6, "tip.y");
}
