//! Actuators and contacts at work, and parts that do not fit.

use super::arm::{LENGTH, ancf, beam, imbalance, moved, one, still, support};
use ancf::effect::{Actuation, BeamDamping, Contact, Friction, Obstacle, Spring};
use ancf::effect::{Force, Gravity};
use ancf::model::*;
use ancf::results::Event;
use std::sync::Arc;

/// An actuated cantilever without loads takes the arc of its own curvature, and is free of stress.
#[test]
fn an_actuated_beam_takes_its_own_shape() {
    let actuation = Actuation {
        beam: 0,
        strain: Some((0.02).into()),
        curvature: Some((1.5).into()),
        layer: None,
        law: None,
    };
    let trajectory = still(&one(vec![support(0.0, FixedRotation::Angle)], vec![Arc::new(actuation)]));
    let last = trajectory.probes[0].samples.last().expect("a record");
    // κ counts per reference length: the arc has the angle κ L and the length 1.02 L.
    let angle = 1.5 * LENGTH;
    let radius = 1.02 / 1.5;
    assert!((last.angle - angle).abs() < 1e-4, "{}", last.angle);
    assert!((last.x - radius * angle.sin()).hypot(last.y - radius * (1.0 - angle.cos())) < 1e-3, "{last:?}");
    let arm = &trajectory.last[0];
    assert!(arm.axial_force.iter().all(|n| n.abs() < 2.0), "{:?}", arm.axial_force);
}

/// A beam dropped on a plane bounces; the contact gives back what it takes, friction takes for
/// good.
#[test]
fn a_beam_bounces_from_a_plane() {
    let contact = |friction| Contact {
        beam: 0,
        obstacle: Obstacle::HalfPlane { point: [0.0, -0.1], normal: [0.0, 1.0] },
        stiffness: 1e4,
        half_thickness: 0.0,
        friction,
        between: None,
    };
    let tolerance = Integrator::Gauss { stages: 2, step: StepControl::Tolerance(1e-7) };
    for friction in [None, Some(Friction { coefficient: 0.3, stiffness: 1e4 })] {
        let mut model = one(vec![], vec![Arc::new(contact(friction))]);
        model.add(Gravity::new([0.0, -9.81]));
        model.initial_velocities =
            vec![InitialVelocity { translation: [1.0, 0.0], ..InitialVelocity::default() }];
        let trajectory = moved(&model, 0.4, tolerance);
        let lowest = trajectory.probes[0].samples.iter().fold(f64::INFINITY, |m, s| m.min(s.y));
        assert!((-0.12..-0.05).contains(&lowest), "lowest {lowest}");
        let off = imbalance(&trajectory);
        assert!(off < 1e-5, "balance off by {off}");
        assert_eq!(trajectory.run.outlines, [[[LENGTH, -0.1], [-LENGTH, -0.1]]]);
        // It falls 0.1 m, and is pushed back.
        let [
            Event::Contact { time: begin, contact, touches: true, impulse: None },
            Event::Contact { time: end, touches: false, impulse: Some(found), .. },
            ..,
        ] = &trajectory.events[..]
        else {
            panic!("{:?}", trajectory.events)
        };
        assert!(
            contact == "arm.1" && (begin - (0.2_f64 / 9.81).sqrt()).abs() < 1e-6,
            "{contact} at {begin} s"
        );
        assert!((1e-3..0.1).contains(&(end - begin)), "it touches until {end} s");
        // It leaves as fast as it came, by an oscillation on the penalty about the depth at which
        // that bears the weight.
        let (mass, speed, frequency) = (0.4 * LENGTH, 9.81 * begin, (1e4 / 0.4_f64).sqrt());
        let impulse = mass * (2.0 * speed + 9.81 * (end - begin));
        let force =
            1e4 * LENGTH * (9.81 / frequency.powi(2) + (9.81 / frequency.powi(2)).hypot(speed / frequency));
        assert!(
            found.impulse[0].abs() < 1e-9 && (found.impulse[1] - impulse).abs() < 1e-5 * impulse,
            "{found:?}, not {impulse}"
        );
        assert!((0.9..=1.0 + 1e-6).contains(&(found.largest_force / force)), "{found:?}, not {force}");
        let lost = trajectory.energy.last().expect("a record").lost;
        assert_eq!(friction.is_some(), lost > 1e-3, "lost {lost}");
        let speed = trajectory.probes[0].samples.last().and_then(|s| s.vx).unwrap_or_default();
        assert_eq!(friction.is_some(), speed < 0.95, "speed {speed}");
        assert!(
            trajectory
                .effects
                .iter()
                .any(|e| e.name == "contact.arm" && e.samples.iter().any(|s| s[2] > 1.0))
        );
    }
}

#[test]
fn what_does_not_fit_is_refused_with_its_place() {
    let refused = |model: &Model, words: &str| {
        let error = model.solve(&Static::default());
        let message = error.expect_err("refused").to_string();
        assert!(message.contains(words), "{message}");
    };
    let mut apart = one(vec![support(0.0, FixedRotation::Angle)], vec![]);
    apart.beams.push(beam("other", [LENGTH, 0.3], [2.0, 0.3], ancf(2)));
    apart.joints =
        vec![Joint::Hinge { first: Place { beam: 0, s: LENGTH }, second: Place { beam: 1, s: 0.0 } }];
    refused(&apart, "3.000e-1 m apart");
    let law = Some(Law::Step { start: 0.0 });
    let load = Arc::new(Force { at: Place { beam: 0, s: 0.5 }, value: [0.0, 1.0], follower: false, law });
    let mut timed = one(vec![support(0.0, FixedRotation::Angle)], vec![]);
    timed.parts = vec![load];
    refused(&timed, "law of time");
    let spring = Spring {
        at: Place { beam: 0, s: 7.0 },
        anchor: None,
        length: None,
        stiffness: Some(1.0),
        damping: None,
    };
    refused(&one(vec![support(0.0, FixedRotation::Angle)], vec![Arc::new(spring)]), "s = 7 m");
    let damping = BeamDamping { beam: 3, mass_proportional: Some((1.0).into()), ..BeamDamping::default() };
    refused(&one(vec![support(0.0, FixedRotation::Angle)], vec![Arc::new(damping)]), "beam number 3");
}

/// What a load and an actuator put in together is the elastic energy. The load's part is λF·u less
/// ∫ F·u dλ along the path, of which many small steps give the integral; the actuator's is its own
/// column, right to six digits however few steps the solver takes, along the load or the arc
/// length's small ones.
#[test]
fn an_actuator_and_a_load_put_in_the_elastic_energy() {
    let scene = |analysis: &str| {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 10 }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.actuation = [{{ beam = 'arm', curvature = 2.5, strain = 1e-3 }}]
             effect.force = [{{ beam = 'arm', at = 'end', value = [3, -4] }}]
             probe = [{{ name = 'tip', beam = 'arm', at = 'end' }}]\nanalysis.static = {analysis}\n"
        );
        let scene = ancf::scene::parse("arm.toml", &text).expect("a legal scene");
        scene.model().solve(scene.analysis()).expect("equilibria")
    };
    let fine = scene("{ steps = 400 }");
    let along: Vec<f64> =
        fine.states().probes[0].samples.iter().map(|tip| 3.0 * (tip.x - 1.0) - 4.0 * tip.y).collect();
    let simpson: f64 = along.windows(3).step_by(2).map(|u| (u[0] + 4.0 * u[1] + u[2]) / (3.0 * 400.0)).sum();
    let last = fine.states().energy.last().expect("an equilibrium");
    let by_actuator = last.stretch + last.bend - (along.last().expect("a tip") - simpson);
    for (analysis, error) in [
        ("{}", 1e-6),
        ("{ steps = 1 }", 1e-6),
        ("{ steps = 3 }", 1e-6),
        ("{ steps = 400 }", 1e-6),
        ("{ arc_length = { until_load = 1, max_step = 0.02, max_points = 2000 } }", 1e-3),
    ] {
        let found = scene(analysis);
        let work = found.states().energy.last().expect("an equilibrium").work;
        assert!((work - by_actuator).abs() < error * by_actuator.abs(), "{analysis}: {work} {by_actuator}");
        assert!(found.run().warnings.is_empty(), "{analysis}: {:?}", found.run().warnings);
    }
    // Few points of a path that bends are few for the integral, too.
    let coarse = scene("{ arc_length = { until_load = 1, max_step = 2, max_points = 2000 } }");
    let work = coarse.states().energy.last().expect("an equilibrium").work;
    let told = coarse.run().warnings.iter().any(|warning| warning.contains("put in"));
    assert!(told || (work - by_actuator).abs() < 0.02 * by_actuator.abs(), "{work} {by_actuator}");
}
