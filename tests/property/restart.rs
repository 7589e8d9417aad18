//! Going on: a motion in parts is the motion as a whole, to the last bit; what starts elsewhere is
//! at rest where it should be, or refused.

use ancf::restart::SavedState;
use ancf::results::{Event, Results, Trajectory};
use ancf::run::{Options, RunError};
use ancf::scene::{Scene, parse};

fn scene(text: &str) -> Scene {
    parse("scene.toml", text).unwrap_or_else(|error| panic!("{error:?}\n{text}"))
}

fn solve(text: &str) -> Trajectory {
    let scene = scene(text);
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}")).into_states()
}

/// What a file holds of a state.
fn filed(saved: &SavedState) -> SavedState {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), serde_json::to_string(saved).expect("finite numbers")).expect("a file");
    SavedState::load(file.path()).expect("what was written")
}

fn go_on(text: &str, from: &Trajectory) -> Result<Trajectory, RunError> {
    let (scene, saved) = (scene(text), filed(from.saved.as_ref().expect("a state")));
    scene
        .model()
        .solve_with(scene.analysis(), Options { start: Some(&saved), ..Options::default() })
        .map(Results::into_states)
}

/// Everything that has a memory: loads without potential, damping, contact, a support that turns, a
/// beam that keeps its length.
const MOTIONS: [&str; 6] = [
    "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 0.1, mass_per_length = 1, basis.ancf.elements = 4 }
     support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
     effect.gravity.acceleration = [0, -9.81]
     effect.moment = [{ beam = 'arm', at = 'end', value = 0.1 }]
     effect.force = [{ beam = 'arm', at = 'end', value = [0, 0.5], in_time = { harmonic = { frequency = 3 } } }]
     effect.damping = [{ beam = 'arm', mass_proportional = 0.3 }]",
    "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 0.1, mass_per_length = 1, basis.rpim.nodes = 5 }
     effect.gravity.acceleration = [0.5, -9.81]
     effect.contact = [{ beam = 'arm', half_plane = { point = [0, -0.05], normal = [0, 1] }, stiffness = 1e4 }]",
    "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 3 }
     support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'], move = { spin_up = { speed = '12 rad/s', duration = 0.3 } } }]
     effect.gravity.acceleration = [0, -9.81]",
    "beam.arm = { start = [0, 0], end = [1, 0], bending_stiffness = 0.1, mass_per_length = 1, basis.ancf.elements = 4 }
     support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
     effect.gravity.acceleration = [0, -9.81]",
    // A torsion spring that is wound up.
    "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e3, mass_per_length = 3, basis.ancf.elements = 4 }
     support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
     initial_velocity = [{ beam = 'arm', rotation = 40, about = [0, 0] }]
     effect.torsion_spring = [{ beam = 'arm', at = 'start', stiffness = 2 }]",
    // A slow flight, in which the first step of no bound would be longer than the motion.
    "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 6e4, bending_stiffness = 1, mass_per_length = 1, basis.rpim.nodes = 8 }
     initial_velocity = [{ beam = 'arm', table = { s = [0, 0.5, 1], vy = [0, 0.02, 0.07] } }]",
];

fn motion(system: &str, duration: f64, integrator: &str, event: &str) -> String {
    format!(
        "{system}\nprobe = [{{ name = 'tip', beam = 'arm', at = 'end' }}]
         analysis.dynamic = {{ duration = {duration}, output_every = 0.01, {integrator}{event} }}"
    )
}

/// Records and events of the second part are those of the whole.
fn agree(whole: &Trajectory, second: &Trajectory, since: f64, what: &str) {
    assert_eq!(second.parameter[0], since, "{what}");
    for (i, time) in second.parameter.iter().enumerate().skip(1) {
        let j = whole.parameter.iter().position(|t| t == time).unwrap_or_else(|| panic!("{what}: {time} s"));
        assert_eq!(second.probes[0].samples[i], whole.probes[0].samples[j], "{what}, {time} s");
        assert_eq!(second.energy[i], whole.energy[j], "{what}, {time} s");
    }
    assert_eq!(second.parameter.last(), whole.parameter.last(), "{what}");
    let times = |t: &Trajectory| t.events.iter().map(Event::parameter).collect::<Vec<_>>();
    let later: Vec<f64> = times(whole).into_iter().filter(|time| *time > since).collect();
    assert_eq!(times(second), later, "{what}");
    assert_eq!(second.saved, whole.saved, "{what}: another stop would leave the same");
}

#[test]
fn a_motion_in_parts_is_the_whole_motion() {
    for (number, system) in MOTIONS.iter().enumerate() {
        for integrator in [
            "gauss = { tolerance = 1e-4 }",
            "radau = { tolerance = 1e-4 }",
            "generalized_alpha = { tolerance = 1e-3 }",
            "radau = { step = 7e-3 }",
        ] {
            // Gauss' method takes no beam that keeps its length.
            if number == 3 && integrator.starts_with("gauss") {
                continue;
            }
            let whole = solve(&motion(system, 0.5, integrator, ""));
            let first = solve(&motion(system, 0.213, integrator, ""));
            let second = go_on(&motion(system, 0.287, integrator, ""), &first).expect("a motion");
            agree(&whole, &second, 0.213, &format!("motion {number}, {integrator}"));
            let told = second.run.settings.iter().find(|(name, _)| name == "continued").expect("is told");
            assert!(
                told.1.contains("for 0.287 s from t = 0.213 s to 0.5 s, as if it had not stopped"),
                "{told:?}"
            );
        }
    }
}

/// An event ends the first part in the middle of a step; it is not told again.
#[test]
fn a_motion_that_an_event_ended_goes_on() {
    for integrator in ["gauss = { tolerance = 1e-4 }", "generalized_alpha = { step = 3e-3 }"] {
        let events = |stop| format!(", event = [{{ probe = 'tip', y = -0.3, stop = {stop} }}]");
        let whole = solve(&motion(MOTIONS[0], 0.5, integrator, &events(false)));
        let first = solve(&motion(MOTIONS[0], 0.5, integrator, &events(true)));
        let since = *first.parameter.last().expect("a time");
        assert_eq!((first.events.len(), first.events[0].parameter()), (1, since));
        let rest = motion(MOTIONS[0], 0.5 - since, integrator, &events(false));
        agree(&whole, &go_on(&rest, &first).expect("a motion"), since, integrator);
    }
}

/// An equilibrium that a static run found is one of the motion: bent by a force and a moment,
/// clamped or with a clamp that was moved; and a cable.
#[test]
fn a_motion_from_an_equilibrium_stays_there() {
    let beam = "beam.arm = { start = [0, 0], end = [0.6, 0.8], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.BASIS }
         effect.gravity.acceleration = [0, -3]
         effect.force = [{ beam = 'arm', at = 'end', value = [1.5, -2] }]
         effect.moment = [{ beam = 'arm', at = 'end', value = 0.3 }]";
    let cable = "beam.arm = { arc = { center = [0, 1], radius = 1, from = '210 deg', to = '330 deg' }, axial_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 8 }
         effect.gravity.acceleration = [0, -9.81]
         effect.force = [{ beam = 'arm', at = 0.3, value = [0.1, -0.5] }]
         support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }, { beam = 'arm', at = 'end', fix = ['x', 'y'], move = { x = -0.1 } }]";
    let clamp = "support = [{ beam = 'arm', at = AT, fix = ['x', 'y', 'HOW']MOVE }]";
    // A spring that is wound up by ten radians.
    let wound = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }
         support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
         effect.torsion_spring = [{ beam = 'arm', at = 'start', stiffness = 2 }]
         effect.moment = [{ beam = 'arm', at = 'start', value = 20 }]";
    let mut systems = vec![cable.to_owned(), wound.to_owned()];
    for basis in ["ancf.elements = 6", "rpim.nodes = 6"] {
        for at in ["'start'", "0.31"] {
            for how in ["angle", "gradient"] {
                for moved in ["", ", move = { x = 0.1, y = -0.2, angle = '50 deg' }"] {
                    let clamp = clamp.replace("AT", at).replace("HOW", how).replace("MOVE", moved);
                    systems.push(format!("{}\n{clamp}", beam.replace("BASIS", basis)));
                }
            }
        }
    }
    for system in systems {
        let with = |analysis: &str| {
            format!(
                "{system}\nprobe = [{{ name = 'tip', beam = 'arm', at = 'end' }}, {{ name = 'middle', beam = 'arm', at = 0.5 }}]\n{analysis}"
            )
        };
        let still = solve(&with("analysis.static = { tolerance = 1e-11 }"));
        for integrator in
            ["gauss = { tolerance = 1e-5 }", "radau = { step = 0.02 }", "generalized_alpha = { step = 0.02 }"]
        {
            let dynamic = format!("analysis.dynamic = {{ duration = 0.5, {integrator} }}");
            let moved = go_on(&with(&dynamic), &still).unwrap_or_else(|error| panic!("{error}\n{system}"));
            assert_eq!((moved.parameter[0], *moved.parameter.last().expect("a time")), (0.0, 0.5));
            for (here, there) in moved.probes.iter().zip(&still.probes) {
                let rest = there.samples.last().expect("an equilibrium");
                for sample in &here.samples {
                    let apart =
                        (sample.x - rest.x).hypot(sample.y - rest.y).max((sample.angle - rest.angle).abs());
                    assert!(apart < 1e-6, "{apart}: {sample:?}, not {rest:?}, {integrator}\n{system}");
                }
            }
        }
    }
}

/// With other loads it leaves the equilibrium, with a velocity of the scene too; work counts from
/// there.
#[test]
fn a_motion_from_an_equilibrium_may_have_other_loads_and_a_velocity() {
    let arm = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 6 }
         support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
         probe = [{ name = 'tip', beam = 'arm', at = 'end' }]";
    let bent = solve(&format!(
        "{arm}\neffect.force = [{{ beam = 'arm', at = 'end', value = [0, 1e-3] }}]\nanalysis.static = {{}}"
    ));
    let dynamic =
        "analysis.dynamic = { duration = 1.79, output_every = 0.001, gauss = { tolerance = 1e-7 } }";
    // Released, it swings to the other side within half of its longest period, 2π/3.516 s.
    let released = go_on(&format!("{arm}\n{dynamic}"), &bent).expect("a motion");
    let lowest = released.probes[0].samples.iter().fold(0.0_f64, |low, sample| low.min(sample.y));
    assert!((lowest / 3.333e-4 + 1.0).abs() < 0.1, "{lowest}");
    let pushed = format!(
        "{arm}\ninitial_velocity = [{{ beam = 'arm', polynomial = {{ vy = [0, 0, 0.1] }} }}]\n{dynamic}"
    );
    let pushed = go_on(&pushed, &bent).expect("a motion");
    assert!((pushed.probes[0].samples[0].vy.expect("a velocity") - 0.1).abs() < 1e-12);
    assert!((pushed.probes[0].samples[0].y - 3.333e-4).abs() < 1e-6);
}

/// A support that is elsewhere than the state, or jumps later, has no finite work.
#[test]
fn supports_that_jump_are_refused_at_any_time() {
    let with = |law: &str, duration: f64| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [0, 2], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }}
             support = [{{ beam = 'arm', at = 'end', fix = ['x', 'y', 'angle'], move = {{ {law} }} }}]
             effect.force = [{{ beam = 'arm', at = 'start', value = [0.1, 0], in_time = {{ step = {{ start = 0.05 }} }} }}]
             analysis.dynamic = {{ duration = {duration} }}"
        )
    };
    let jump = "y = '0.1 m', in_time = { step = { start = '0.1 s' } }";
    let turn = "angle = '90 deg', in_time = { step = { start = '0.1 s' } }";
    for (law, size) in [(jump, "1.000e-1"), (turn, "1.571e0")] {
        let scene = scene(&with(law, 0.2));
        let error = scene.model().solve(scene.analysis()).expect_err("a jump");
        assert_eq!(error.exit_status(), 2);
        let text = error.to_string();
        for part in ["beam `arm` near s = 2.000000 m", "t = 0.1 s", size] {
            assert!(text.contains(part), "{part} in {text}");
        }
    }
    // What does not happen within the motion does no harm.
    let first = solve(&with(jump, 0.08));
    assert!(go_on(&with(jump, 0.01), &first).is_ok());
    let error = go_on(&with(jump, 0.03), &first).expect_err("a jump at 0.1 s");
    assert!(error.to_string().contains("t = 0.1 s"), "{error}");
    // A law that is elsewhere when another motion starts from the state.
    for (moved, by) in [("y = '0.1 m'", "8.000e-2"), ("angle = '90 deg'", "1.257e0")] {
        let ramp = format!("{moved}, in_time = {{ ramp = {{ duration = 0.1 }} }}");
        let error = go_on(&with(&ramp, 0.01), &first).expect_err("a jump by 0.08 m or 72 degrees");
        assert!(error.to_string().contains(by) && error.exit_status() == 2, "{error}");
    }
}

/// What a new support holds must be at rest; a state of other beams is none of this scene.
#[test]
fn what_does_not_fit_is_refused() {
    let with = |more: &str| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 0.1, mass_per_length = 1, basis.ancf.elements = 4 }}
             effect.gravity.acceleration = [0, -9.81]
             analysis.dynamic = {{ duration = 0.2 }}\n{more}"
        )
    };
    let first = solve(&with(""));
    let error = go_on(&with("support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]"), &first)
        .expect_err("it falls");
    assert!(
        error.to_string().contains("a support that was not there before changes its velocity by 1.962e0 m/s"),
        "{error}"
    );
    let slider = "joint = [{ type = 'slider', first = { beam = 'arm', at = 'end' }, along = [1, 0] }]";
    let error = go_on(&with(slider), &first).expect_err("it has fallen");
    assert!(error.to_string().contains("misses it by 1.9"), "{error}");
    let heavier = with("").replace("mass_per_length = 1", "mass_per_length = 2");
    let error = go_on(&heavier, &first).expect_err("another beam");
    assert!(error.to_string().contains("another section"), "{error}");
    let moved = with("").replace("end = [1, 0]", "end = [0, 1]");
    assert!(go_on(&moved, &first).expect_err("another beam").to_string().contains("another centreline"));
}

/// What joints and lengths do not allow is told as theirs, with the rate at which they part, whatever the mesh.
#[test]
fn velocities_that_part_joints_are_refused_as_such() {
    let chain = |joint: &str, elements: usize, axial: &str, more: &str| {
        format!(
            "[beam]\na = {{ start = [0, 0], end = [1, 0], {axial} bending_stiffness = 5, mass_per_length = 1, basis.ancf.elements = {elements} }}
             b = {{ start = [1, 0], end = [2, 0], {axial} bending_stiffness = 5, mass_per_length = 1, basis.ancf.elements = {elements} }}
             [[joint]]\ntype = '{joint}'\nfirst = {{ beam = 'a', at = 'end' }}\nsecond = {{ beam = 'b', at = 'start' }}
             [[support]]\nbeam = 'a'\nat = 'start'\nfix = ['x', 'y']
             [analysis]\ndynamic = {{ duration = 0.01 }}\n{more}"
        )
    };
    let velocity = |beam: &str, field: &str| format!("[[initial_velocity]]\nbeam = '{beam}'\n{field}\n");
    let turns = velocity("a", "rotation = 2");
    let follows = velocity("b", "rotation = 3\nabout = [1, 0]\nvalue = [0, 2]");
    let (soft, stiff) = ("axial_stiffness = 1e3,", "");
    for elements in [4, 9] {
        for (joint, axial, velocities, part) in [
            (
                "hinge",
                soft,
                turns.clone(),
                Some(("parts a joint: near s = 1.000000 m of beam `a`", "2.000e0 m/s")),
            ),
            (
                "hinge",
                soft,
                velocity("a", "rotation = 0.01"),
                Some(("parts a joint: near s = 1.000000 m of beam `a`", "1.000e-2 m/s")),
            ),
            ("hinge", soft, format!("{turns}{follows}"), None),
            (
                "weld",
                soft,
                format!("{turns}{follows}"),
                Some(("parts a joint: near s = 1.000000 m of beam `a`", "1.000e0 rad/s")),
            ),
            (
                "hinge",
                soft,
                format!("{}{}", velocity("a", "value = [0, 1]"), velocity("b", "value = [0, 1]")),
                Some(("moves what a support holds", "of beam `a`")),
            ),
            (
                "hinge",
                stiff,
                velocity("b", "polynomial = { vx = [0, 0.3] }"),
                Some(("stretches the inextensible beam `b`", " m/s")),
            ),
        ] {
            let scene = scene(&chain(joint, elements, axial, &velocities));
            let end = scene.model().solve(scene.analysis());
            match part {
                None => assert!(end.is_ok(), "{velocities}"),
                Some((what, rate)) => {
                    let error = end.expect_err("it parts");
                    let text = error.to_string();
                    assert!(text.contains(what) && text.contains(rate) && error.exit_status() == 2, "{text}");
                }
            }
        }
    }
}

/// A torsion spring that is wound up stays so where another scene gives it another stiffness: E = k φ²/2 with all turns, whose
/// part between −π and π the coordinates know.
#[test]
fn a_spring_of_another_stiffness_keeps_its_turns() {
    let arm = |stiffness: f64, duration: f64| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 2 }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y'] }}]
             initial_velocity = [{{ beam = 'arm', rotation = 10, about = [0, 0] }}]
             effect.torsion_spring = [{{ beam = 'arm', at = 'start', stiffness = {stiffness} }}]
             probe = [{{ name = 'tip', beam = 'arm', at = 'end' }}]
             analysis.dynamic = {{ duration = {duration}, radau.tolerance = 1e-7 }}"
        )
    };
    let first = solve(&arm(0.05, 1.2));
    let angle = first.probes[0].samples.last().expect("a state").angle;
    assert!(angle > 10.0, "{angle}");
    let second = go_on(&arm(0.06, 0.05).replace("rotation = 10", "rotation = 0"), &first).expect("a motion");
    let stored = second.energy[0].stored;
    assert!((stored / (0.5 * 0.06 * angle * angle) - 1.0).abs() < 1e-4, "{stored} at {angle}");
}

/// What sticks on rough ground goes on to stick where another scene changes a coefficient of the contact.
#[test]
fn friction_of_another_coefficient_keeps_its_place() {
    let bar = |coefficient: f64, stiffness: f64| {
        format!(
            "beam.bar = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 2 }}
             effect.gravity.acceleration = [3, -9.81]
             effect.damping = [{{ beam = 'bar', mass_proportional = 20 }}]
             effect.contact = [{{ beam = 'bar', half_plane = {{ point = [0, 0], normal = [0, 1] }}, stiffness = {stiffness}, friction = {{ coefficient = {coefficient}, stiffness = 1e4 }} }}]
             probe = [{{ name = 'tip', beam = 'bar', at = 'end' }}]
             analysis.dynamic = {{ duration = 2, output_every = 0.5, radau.tolerance = 1e-6 }}"
        )
    };
    let first = solve(&bar(0.5, 1e4));
    let at = |motion: &Trajectory| motion.probes[0].samples.last().expect("a state").x;
    // 3 N on springs of 1e4 N/m² along 1 m.
    assert!((at(&first) - 1.0003).abs() < 2e-5, "{}", at(&first));
    for (coefficient, stiffness) in [(0.6, 1e4), (0.5, 1.0001e4)] {
        let second = go_on(&bar(coefficient, stiffness), &first).expect("a motion");
        assert!((at(&second) - at(&first)).abs() < 1e-6, "{coefficient}, {stiffness}: {}", at(&second));
    }
    // Other ground has held nothing yet.
    let moved = bar(0.5, 1e4).replace("point = [0, 0]", "point = [0, -1e-9]");
    let second = go_on(&moved, &first).expect("a motion");
    assert!((at(&second) - at(&first) - 3e-4).abs() < 5e-5, "{}", at(&second));
}

/// A law that begins where the motion before has ended, but for the last digit: 0.12 + 0.02 is less than 0.14.
#[test]
fn a_motion_may_begin_a_digit_before_a_law_does() {
    let ramp = |start: f64| {
        format!(
            "{{ beam = 'arm', at = 'end', value = [0, -1], in_time.ramp = {{ start = {start}, duration = 0.02 }} }}"
        )
    };
    let arm = |forces: &str, duration: f64, integrator: &str| {
        format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 2 }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.force = [{forces}]
             probe = [{{ name = 'tip', beam = 'arm', at = 'end' }}]
             analysis.dynamic = {{ duration = {duration}, {integrator} }}"
        )
    };
    for integrator in [
        "radau.tolerance = 1e-6",
        "gauss.tolerance = 1e-6",
        "generalized_alpha.step = 1e-3",
        "radau.step = 1e-3",
    ] {
        let both = format!("{}, {}", ramp(0.12), ramp(0.14));
        let whole = solve(&arm(&both, 0.24, integrator));
        let first = solve(&arm(&ramp(0.12), 0.14, integrator));
        let second = go_on(&arm(&both, 0.1, integrator), &first).expect(integrator);
        let at = |motion: &Trajectory| motion.probes[0].samples.last().expect("a state").y;
        assert!((at(&second) - at(&whole)).abs() < 1e-5, "{integrator}: {} for {}", at(&second), at(&whole));
    }
}

/// A beam that keeps its length and hangs at rest has velocities that are round-off. It goes on, and has lost nothing.
#[test]
fn an_inextensible_beam_at_rest_goes_on() {
    for stiffness in ["bending_stiffness = 1, ", ""] {
        let hanging = |force: f64| {
            format!(
                "beam.a = {{ start = [0, 0], end = [0, -1], {stiffness}mass_per_length = 1, basis.ancf.elements = 4 }}
                 support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}]
                 effect.gravity.acceleration = [0, -9.81]
                 effect.force = [{{ beam = 'a', at = 'end', value = [{force}, 0] }}]
                 probe = [{{ name = 'tip', beam = 'a', at = 'end' }}]
                 analysis.dynamic = {{ duration = 0.1, radau.tolerance = 1e-6 }}"
            )
        };
        let first = solve(&hanging(0.0));
        assert_eq!(first.run.warnings, [""; 0]);
        let second = go_on(&hanging(1.0), &first).unwrap_or_else(|error| panic!("{error}"));
        assert!(second.probes[0].samples.last().expect("a state").x > 1e-3);
    }
}

/// A slow motion of a stiff beam is no round-off, which a support that comes might take without a word.
#[test]
fn a_support_does_not_stop_a_slow_motion() {
    let rod = |rest: &str| {
        format!(
            "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e12, bending_stiffness = 1e6, mass_per_length = 1, basis.ancf.elements = 2 }}
             {rest}
             analysis.dynamic.duration = 0.1"
        )
    };
    let first =
        solve(&rod("initial_velocity = [{ beam = 'rod', table = { s = [0, 1], vy = [0.01, 0.01] } }]"));
    let held = rod("support = [{ beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }]");
    let error = go_on(&held, &first).expect_err("it moves").to_string();
    assert!(
        error.contains("a support that was not there before changes its velocity by 1.000e-2 m/s"),
        "{error}"
    );
}

/// A rod of 1 kg that falls flat on ground of 20 kN/m² is stopped within it, while it comes up again, and goes on from there: the largest
/// force of the rest is the one with which it begins.
#[test]
fn a_contact_that_goes_on_has_no_force_of_the_past() {
    let fall = "beam.rod = { start = [0, 0.3], end = [1, 0.3], axial_stiffness = 1e4, bending_stiffness = 5, mass_per_length = 1, \
        basis.ancf.elements = 4 }
        effect.gravity.acceleration = [0, -9.81]
        effect.contact = [{ beam = 'rod', half_plane = { point = [0, 0], normal = [0, 1] }, stiffness = 2e4 }]
        probe = [{ name = 'middle', beam = 'rod', at = 0.5 }]\n";
    for method in [
        "radau.tolerance = 1e-5",
        "gauss.tolerance = 1e-5",
        "radau.step = 1e-3",
        "generalized_alpha.tolerance = 1e-4",
    ] {
        let motion =
            |duration: f64| format!("{fall}analysis.dynamic = {{ duration = {duration}, {method} }}");
        let first = solve(&motion(0.2688));
        let rest = go_on(&motion(0.05), &first).expect("a motion");
        let Some(Event::Contact { impulse: Some(impulse), .. }) = rest.events.last() else {
            panic!("{method}: {:?}", rest.events)
        };
        let force = -2e4 * first.probes[0].samples.last().expect("a sample").y;
        assert!((impulse.largest_force / force - 1.0).abs() < 2e-3, "{method}: {impulse:?} for {force}");
    }
}
