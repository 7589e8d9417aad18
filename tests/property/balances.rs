//! Energies of actuated beams, warnings of a balance that does not hold, and of what an analysis
//! leaves out.

use ancf::results::Trajectory;
use ancf::scene::parse;

fn solved(text: &str) -> Trajectory {
    let scene = parse("balances.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}")).into_states()
}

fn arm(more: &str) -> String {
    format!(
        "[beam.arm]\nstart = [0.0, 0.0]\nend = [1.0, 0.0]\naxial_stiffness = 1e4\nbending_stiffness = 1.0\nmass_per_length = 1.0\n\
         basis.ancf.elements = 12\n{more}"
    )
}

const CLAMP: &str = "[[support]]\nbeam = 'arm'\nat = 'start'\nfix = ['x', 'y', 'angle']\n";
const ACTUATION: &str = "[[effect.actuation]]\nbeam = 'arm'\ncurvature = 0.3\nstrain = 1e-3\n";

/// A beam that may take the shape that it would take by itself has no elastic energy, straight or
/// curved; one that may not has all of it, which the actuator has put in.
#[test]
fn an_actuated_beam_has_the_energy_of_what_it_is_kept_from() {
    let free = solved(&arm(&format!("{CLAMP}{ACTUATION}[analysis.static]\n")));
    let last = free.energy.last().expect("a record");
    assert!(last.stretch.abs() + last.bend.abs() < 1e-7, "{last:?}");
    assert!(last.potential == 0.0 && last.work.abs() < 1e-3, "{last:?}");

    let arc = arm(&format!("{CLAMP}{ACTUATION}[analysis.static]\n")).replace(
        "start = [0.0, 0.0]\nend = [1.0, 0.0]\n",
        "arc = { center = [0, 0], radius = 1.0, from = '-90 deg', to = '-30 deg' }\n",
    );
    let arc = solved(&arc);
    let last = arc.energy.last().expect("a record");
    assert!(last.stretch.abs() + last.bend.abs() < 1e-5, "{last:?}");

    // Both ends held: EA ε₀² L/2 and EI κ₀² L/2, of two actuations on the same beam together.
    let held = "[[support]]\nbeam = 'arm'\nat = 'end'\nfix = ['x', 'y', 'angle']\n";
    let twice = format!("{CLAMP}{held}{ACTUATION}{ACTUATION}[analysis.static]\nsteps = 2\n");
    let last = *solved(&arm(&twice)).energy.last().expect("a record");
    let (stretch, bend) = (0.5e4 * 2e-3_f64.powi(2), 0.5 * 0.6_f64.powi(2));
    assert!((last.stretch - stretch).abs() < 1e-9 && (last.bend - bend).abs() < 1e-9, "{last:?}");
    assert!((last.work - stretch - bend).abs() < 1e-9, "{last:?}");
}

/// In a motion the actuator's work is what elastic and kinetic energy gain.
#[test]
fn an_actuator_puts_in_what_the_motion_gains() {
    for held in ["", "[[support]]\nbeam = 'arm'\nat = 'end'\nfix = ['x', 'y', 'angle']\n"] {
        let text = format!(
            "{CLAMP}{held}{ACTUATION}in_time = {{ harmonic = {{ frequency = '1.5 Hz', phase = '30 deg' }} }}\n\
             [analysis.dynamic]\nduration = 0.6\noutput_every = 0.02\ngauss.step = 0.002\n"
        );
        let trajectory = solved(&arm(&text));
        let first = trajectory.energy[0];
        // sin 30° of ε₀ and κ₀ at the start, of a beam that is still straight.
        let initial = 0.5e4 * 0.5e-3_f64.powi(2) + 0.5 * 0.15_f64.powi(2);
        assert!((first.stretch + first.bend - initial).abs() < 1e-12, "{first:?}");
        for (energy, time) in trajectory.energy.iter().zip(&trajectory.parameter) {
            assert_eq!(energy.potential, 0.0);
            assert!((energy.total() - initial).abs() < 1e-5, "{held} t = {time}: {energy:?}");
            let rate = (std::f64::consts::TAU * 1.5 * time + std::f64::consts::FRAC_PI_6).sin();
            if !held.is_empty() {
                let elastic = rate * rate * (0.5e4 * 1e-6 + 0.5 * 0.09);
                assert!((energy.stretch + energy.bend - elastic).abs() < 1e-9, "t = {time}: {energy:?}");
                assert!((energy.work - elastic + initial).abs() < 1e-9, "t = {time}: {energy:?}");
            }
        }
        assert!(trajectory.run.warnings.is_empty(), "{:?}", trajectory.run.warnings);
    }
}

/// A free rod that spins and is made longer by a tenth keeps its angular momentum: of its kinetic energy m l² ω²/24 the actuators take what
/// the length does, 1 − 1/1.1², however stiff it is against what a step changes the imposed strain by.
#[test]
fn actuators_take_the_energy_of_a_rod_that_grows() {
    let kinetic = 4.0_f64.powi(2) / 24.0;
    let exact = kinetic * (1.1_f64.powi(-2) - 1.0);
    for stiffness in ["1e5", "1e7"] {
        for settings in ["step = 1e-3", "step = 1e-3, spectral_radius = 0.6", "tolerance = 1e-4"] {
            let trajectory = solved(&format!(
                "beam.r = {{ start = [-0.5, 0], end = [0.5, 0], axial_stiffness = {stiffness}, bending_stiffness = 100, mass_per_length = 1, \
                 basis.ancf.elements = 4 }}\n\
                 initial_velocity = [{{ beam = 'r', rotation = 4, about = [0, 0] }}]\n\
                 effect.actuation = [{{ beam = 'r', strain = 0.1, in_time.smooth_ramp.duration = 1 }}]\n\
                 analysis.dynamic = {{ duration = 1.5, output_every = 0.1, generalized_alpha = {{ {settings} }} }}\n"
            ));
            let work = trajectory.energy.last().expect("a state").work;
            assert!((work / exact - 1.0).abs() < 1e-3, "{stiffness} {settings}: {work} for {exact}");
            assert!(trajectory.run.warnings.is_empty(), "{:?}", trajectory.run.warnings);
        }
    }
}

/// A balance of energy that is off is a warning; one that holds is none.
#[test]
fn a_balance_that_is_off_is_a_warning() {
    let motion = |method: &str| {
        let text = format!(
            "{CLAMP}[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.0, 2.0]\n\
             [analysis.dynamic]\nduration = 0.5\noutput_every = 0.05\n{method}\n"
        );
        solved(&arm(&text)).run.warnings
    };
    let damped = motion("generalized_alpha = { step = 0.04, spectral_radius = 0.0 }");
    assert!(damped.iter().any(|warning| warning.contains("the motion has lost")), "{damped:?}");
    assert_eq!(motion("gauss.step = 0.001"), [""; 0]);
    // Nothing moves.
    let rest = format!("{CLAMP}[analysis.dynamic]\nduration = 0.5\noutput_every = 0.05\n");
    assert_eq!(solved(&arm(&rest)).run.warnings, [""; 0]);
}

/// Where a motion in a steady flow comes to rest, statics finds it.
#[test]
fn statics_finds_where_a_motion_in_a_flow_settles() {
    for flow in ["[2.0, 1.5]", "[-1.0, 3.0]"] {
        let drag = format!(
            "{CLAMP}[[effect.drag]]\nbeam = 'arm'\nnormal = 1.2\ntangential = 0.1\nviscous_normal = 3.0\nflow = {flow}\n\
             [[probe]]\nname = 'tip'\nbeam = 'arm'\nat = 'end'\n"
        );
        let still = solved(&arm(&format!("{drag}[analysis.static]\n")));
        let moving = solved(&arm(&format!(
            "{drag}[analysis.dynamic]\nduration = 8.0\noutput_every = 1.0\nradau.tolerance = 1e-4\n"
        )));
        let [a, b] = [&still, &moving].map(|t| *t.probes[0].samples.last().expect("a record"));
        assert!(a.y.abs() > 0.1, "it bends: {a:?}");
        assert!((a.x - b.x).hypot(a.y - b.y) < 2e-4, "{flow}: ({}, {}) and ({}, {})", a.x, a.y, b.x, b.y);
        assert!(still.run.warnings.is_empty(), "{:?}", still.run.warnings);
    }
}

/// What cannot take part is named.
#[test]
fn what_an_analysis_leaves_out_is_named() {
    let all = format!(
        "{CLAMP}[[effect.damping]]\nbeam = 'arm'\nmass_proportional = 1.0\n\
         [[effect.spring]]\nbeam = 'arm'\nat = 'end'\nstiffness = 1.0\ndamping = 0.5\n\
         [[effect.torsion_spring]]\nbeam = 'arm'\nat = 'end'\ndamping = 0.1\n\
         [[effect.drag]]\nbeam = 'arm'\nnormal = 1.0\n\
         [[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [-0.1, 0.0]\n\
         [[initial_velocity]]\nbeam = 'arm'\nrotation = 0.0\n"
    );
    for analysis in ["static", "buckling", "modal"] {
        let count = if analysis == "static" { "" } else { "count = 1\n" };
        let warnings = solved(&arm(&format!("{all}[analysis.{analysis}]\n{count}"))).run.warnings;
        let first = warnings.iter().find(|warning| warning.contains("no part in")).expect("a warning");
        for name in ["`damping`", "`dashpot`", "`torsion_dashpot`", "`drag`", "`initial_velocity`"] {
            assert!(first.contains(name), "{analysis}: {first}");
        }
        let loads = warnings.iter().any(|warning| warning.contains("loads take no part"));
        assert_eq!(loads, analysis == "modal", "{warnings:?}");
    }
    let motion = format!("{all}[analysis.dynamic]\nduration = 0.01\n");
    assert!(solved(&arm(&motion)).run.warnings.is_empty());
}
