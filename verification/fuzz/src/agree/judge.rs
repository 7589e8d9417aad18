//! Runs a scene in a way that must agree, and says whether it does.

use fastrand::Rng;
use toml::Table;

use super::frame::Frame;
use super::gap::{self, Gap, Largest, Records};
use super::neighbour::{self, Growth};
use super::outcome::{self, Outcome, Seen};
use super::ways::{self, Way};
use super::{balance, cut, momentum, settings, stages};

/// Largest difference that two runs may have, in units of the accuracy asked for.
const ALLOWED: f64 = 10.0;

/// Growth of errors beyond which a scene has no definite result.
const NEUTRAL: f64 = 1e4;
/// Factor of the estimated errors of both meshes at a cut, beside which the shape functions are
/// others.
const WELDED: f64 = 3.0;
/// Relative accuracy of eigenvalues.
const EIGENVALUES: f64 = 1e-7;
/// Largest difference between a motion that was stopped and goes on and one that was not.
const CONTINUED: f64 = 1e-8;
/// Accuracy of forces and other things than positions, for which nothing is asked.
const FORCES: f64 = 1e-5;

/// The accuracy of the run that is the truth for another one, in that one's.
const HUNDREDTH: f64 = 0.01;
/// Errors tell something of an estimate where the truth errs by no more than this part of them.
const TOLD: f64 = 0.2;

/// A scene in natural units, with the frame in which it is run and the seed from which its other
/// ways are drawn.
#[derive(Clone, Debug)]
pub struct Case {
    pub scene: Table,
    pub frame: Frame,
    pub seed: u64,
}

/// The verdict of one way on a scene.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// The way does not apply to this scene.
    NotApplicable,
    /// The runs differ by this share of the allowed difference.
    Agrees(f64),
    /// A run for an accuracy differs from one for a hundredth of it, but not by more than ten
    /// times what was wanted.
    Estimated(Estimated),
    /// They differ by no more than the scene's own sensitivity explains.
    Unstable,
    /// A warning says that a result is not accurate.
    Warned,
    /// Status 1 or 2 in all ways.
    Refused,
    /// A run took too long and was given up.
    TooLong,
    /// They differ.
    Finding(Finding),
}

/// The errors of a run that chose its mesh.
#[derive(Clone, Copy, Debug)]
pub struct Estimated {
    /// Largest error that was wanted.
    pub wanted: f64,
    /// The largest that was found.
    pub error: f64,
    /// That of the last state beside its estimate, where the run for a hundredth can tell it.
    pub last: Option<[f64; 2]>,
}

/// Runs that do not agree.
#[derive(Clone, Debug)]
pub struct Finding {
    pub way: Way,
    pub what: String,
    /// The scene in the other way, as text.
    pub other: String,
}

/// One disagreement, and the allowed one.
struct Measured {
    value: f64,
    allowed: f64,
    /// Whether it is a disagreement of positions, so that their growth counts.
    places: bool,
    what: String,
}

/// Judges one way.
pub fn judge(case: &Case, way: Way, base: &Outcome) -> Verdict {
    // Each way has random numbers of its own, so that a smaller scene is judged in the same way.
    let mut rng = Rng::with_seed(case.seed ^ ((way as u64 + 1) << 32));
    if let Outcome::Panicked(said) = base {
        return finding(way, format!("a panic: {said}"), String::new());
    }
    let compares = way.is_exact() || matches!(way, Way::LoadSteps | Way::Accuracy | Way::Balance);
    if settings::accuracy(&case.scene).is_some() && !compares {
        // A mesh that is chosen is another one for every change.
        return Verdict::NotApplicable;
    }
    match way {
        _ if way.is_exact() => exact(case, way, base, &mut rng),
        Way::Balance => solved(base).map_or_else(|verdict| verdict, |seen| balanced(case, seen, &mut rng)),
        Way::Momentum => solved(base).map_or_else(|verdict| verdict, |_| keeps_momentum(case, &mut rng)),
        _ => match solved(base) {
            Ok(seen) => approximate(case, way, seen, &mut rng),
            Err(verdict) => verdict,
        },
    }
}

/// The results of a run, if it has no warnings and can be compared; otherwise the verdict.
fn solved(outcome: &Outcome) -> Result<&Seen, Verdict> {
    match outcome {
        Outcome::Solved(seen) if seen.warnings.is_empty() => Ok(seen),
        Outcome::Solved(_) => Err(Verdict::Warned),
        Outcome::Failed(_) | Outcome::Refused(_) => Err(Verdict::Refused),
        Outcome::TooLong => Err(Verdict::TooLong),
        Outcome::Panicked(said) => Err(finding(Way::Balance, format!("a panic: {said}"), String::new())),
    }
}

fn finding(way: Way, what: String, other: String) -> Verdict {
    Verdict::Finding(Finding { way, what, other })
}

/// Cells of a beam whose halves and quarters tell how errors fall.
const ENOUGH: usize = 8;

/// Ratio of the round-off of forces to that of positions: a factor of a hundred because forces
/// follow from differences of positions, and one of ten for beams that lie ten lengths from the
/// origin.
const OF_FORCES: f64 = 1e3;
/// Ratio of the round-off of frequencies and critical loads to that of positions.
const OF_EIGENVALUES: f64 = 10.0;

/// Error of positions due to the round-off of the stretch, which the stiffest beam turns into a
/// force.
fn round_off(scene: &Table) -> f64 {
    1e-9 + 1e-15 * settings::stiffness_ratio(scene) * settings::all_cells(scene) as f64
}

fn decide(case: &Case, way: Way, measured: Measured, other: &str, rng: &mut Rng) -> Verdict {
    let Measured { value, allowed, places, what } = measured;
    // A NaN agrees with nothing.
    if value <= allowed {
        return Verdict::Agrees(value / allowed);
    }
    if settings::is_slack(&case.scene) || value <= error_of_strings(case) {
        return Verdict::Unstable;
    }
    let factor = match neighbour::growth(&case.scene, &case.frame, rng) {
        Growth::Unknown => return Verdict::Unstable,
        // Nearly any shape is a solution: of a string without a load across it, of a column at its
        // critical load.
        Growth::By { places, .. } if places > NEUTRAL => return Verdict::Unstable,
        Growth::By { places: grown, .. } if places => grown,
        Growth::By { all, .. } if all > NEUTRAL => return Verdict::Unstable,
        Growth::By { all, .. } => all,
    };
    if value <= allowed * factor {
        return Verdict::Unstable;
    }
    // Which point sticks first decides where others stick, and to which side beams give way that begin
    // compressed.
    let by_chance = settings::has_friction(&case.scene) || settings::begins_elsewhere(&case.scene);
    let mut by_order = || ALLOWED * neighbour::apart_by_order(&case.scene, &case.frame, rng);
    if places && by_chance && value <= by_order() {
        return Verdict::Unstable;
    }
    let says = format!(
        "{what}: {value:.2e} where {allowed:.2e} is allowed, and neighbours depart by {factor:.1} times their difference"
    );
    finding(way, says, other.to_owned())
}

/// Two errors of a coarse mesh of strings that hang still, as a finer one that errs by a third tells them. A cell that would have to kink where a force
/// acts, or fold up, has several equilibria, each of which has this error, so that two of them differ by up to twice as much.
fn error_of_strings(case: &Case) -> f64 {
    let Case { scene, frame, .. } = case;
    let statics = settings::get(scene, &["analysis", "static"]).is_some();
    if !statics || settings::beams(scene).all(|(_, beam)| settings::bends(beam)) {
        return 0.0;
    }
    let Some(finer) = settings::finer(scene) else { return 0.0 };
    match (outcome::run(scene, frame), outcome::run(&finer, frame)) {
        (Outcome::Solved(a), Outcome::Solved(b)) => 3.0 * gap::between(&a, &b, Records::Last).places,
        _ => 0.0,
    }
}

fn exact(case: &Case, way: Way, base: &Outcome, rng: &mut Rng) -> Verdict {
    let Case { scene, frame, .. } = case;
    let there = ways::other_frame(way, frame, scene, rng);
    let text = || there.write(scene).to_string();
    let outcome = outcome::run(scene, &there);
    let (a, b) = match (base, &outcome) {
        (Outcome::TooLong, _) | (_, Outcome::TooLong) => return Verdict::TooLong,
        (_, Outcome::Panicked(said)) => return finding(way, format!("a panic: {said}"), text()),
        (Outcome::Solved(a), Outcome::Solved(b)) => (a, b),
        (Outcome::Solved(seen), Outcome::Failed(said) | Outcome::Refused(said))
        | (Outcome::Failed(said) | Outcome::Refused(said), Outcome::Solved(seen)) => {
            let slack = settings::is_slack(scene) || settings::gives_way(scene);
            let given_up = !seen.warnings.is_empty() || slack;
            // An accuracy that cannot be had may be missed by as little as runs may differ.
            let solves = |scene: &Table, frame| matches!(outcome::run(scene, frame), Outcome::Solved(_));
            let nearly = |scene: Table| [frame, &there].into_iter().all(|frame| solves(&scene, frame));
            let missed = settings::looser(scene, ALLOWED).is_some_and(nearly);
            if given_up || missed || neighbour::at_the_edge(scene, [frame, &there], rng) {
                return Verdict::Unstable;
            }
            return finding(way, format!("one of both has no result: {said}"), text());
        }
        _ => return Verdict::Refused,
    };
    if !a.warnings.is_empty() || !b.warnings.is_empty() {
        return Verdict::Warned;
    }
    let same = a.counts == b.counts;
    // Round-off may change the last of its steps.
    if settings::ends_by_points(scene) && (!same || ends_elsewhere(a, b)) {
        return Verdict::NotApplicable;
    }
    // So it may the steps before a turn that no tolerance bounds.
    if settings::stops_beyond_tolerance(scene) && !same {
        return Verdict::NotApplicable;
    }
    let motion = settings::motion(scene);
    // The records of a path, or of a load without `steps`, are chosen by the solver and need not
    // agree.
    let pauses = settings::get(scene, &["analysis", "static", "steps"]).is_some() || motion.is_some();
    let records = if pauses { Records::All } else { Records::Last };
    let gap = gap::between(a, b, records);
    let chosen = motion.as_ref().and_then(|motion| motion.tolerance);
    let modes = matches!(settings::analysis(scene), "modal" | "buckling");
    let accuracy = settings::accuracy(scene);
    let wanted = match () {
        () if accuracy.is_some() => settings::tolerance(scene),
        // Modes after a motion are those of a state that errs by its tolerance.
        () if modes => EIGENVALUES.max(chosen.map_or(0.0, |_| settings::tolerance(scene))),
        () if settings::ends_by_points(scene) => FORCES,
        () => settings::tolerance(scene),
    };
    // Friction depends on the path: where round-off changes which load steps are taken, both runs err by their own.
    let of_load_steps = match ways::half_load_steps(scene).filter(|_| !same && accuracy.is_none()) {
        None => None,
        Some(halved) => match other(&halved, frame, way) {
            Ok(halved) => Some(gap::between(a, &halved, Records::Last).places),
            Err(verdict) => return verdict,
        },
    };
    let (places, all) = match chosen {
        _ if let Some(error) = of_load_steps => (ALLOWED * wanted.max(error), f64::INFINITY),
        _ if accuracy.is_some() => (ALLOWED * wanted, f64::INFINITY),
        // Round-off may change the choice of a step, and where an expression turns. Both runs then err by their own
        // steps, as two runs with different tolerances do.
        Some(_) if !same || settings::has_expression(scene) => (ALLOWED * wanted, f64::INFINITY),
        // Of as many steps one may still be another.
        Some(_) => (wanted, FORCES.max(wanted)),
        None => (ALLOWED * wanted, FORCES.max(ALLOWED * wanted)),
    };
    // Round-off of the stiffness changes frequencies and critical loads by more than it moves an equilibrium, and all forces of what
    // nothing loads are round-off.
    let round_off = if modes { OF_EIGENVALUES } else { 1.0 } * round_off(scene);
    let places = places + round_off;
    let all = all + OF_FORCES * round_off;
    if gap.events && all.is_finite() && gap.places <= places && gap.all.value <= all {
        if !neighbour::keeps_events(scene, frame, a, rng) {
            return Verdict::Unstable;
        }
        return finding(way, "another number of events".to_owned(), text());
    }
    let measured = if gap.places > places {
        let what = "a position or an eigenvalue".to_owned();
        Measured { value: gap.places, allowed: places, places: true, what }
    } else if chosen.is_some() && gap.derived > all {
        // Iterations end within the tolerance of positions, which does not bound what follows from them. A
        // smaller one tells how much that errs.
        let finer = ways::tighter(scene).ok_or(Verdict::NotApplicable);
        let own = match finer.and_then(|finer| other(&finer, frame, way)) {
            Ok(finer) => gap::between(a, &finer, Records::Common).derived,
            Err(verdict) => return verdict,
        };
        let Largest { value, what } = if gap.derived > own { gap.all } else { gap.times };
        Measured { value, allowed: all, places: false, what }
    } else {
        let Largest { value, what } = gap.all;
        Measured { value, allowed: all, places: false, what }
    };
    decide(case, way, measured, &text(), rng)
}

/// Runs another scene in the same frame. Returns its results if there is no warning, otherwise the
/// verdict.
fn other(scene: &Table, frame: &Frame, way: Way) -> Result<Box<Seen>, Verdict> {
    match outcome::run(scene, frame) {
        Outcome::Panicked(said) => {
            Err(finding(way, format!("a panic: {said}"), frame.write(scene).to_string()))
        }
        Outcome::Solved(seen) if seen.warnings.is_empty() => Ok(seen),
        outcome => Err(solved(&outcome).err().unwrap_or(Verdict::Refused)),
    }
}

fn approximate(case: &Case, way: Way, base: &Seen, rng: &mut Rng) -> Verdict {
    let Case { scene, frame, .. } = case;
    if settings::stops_beyond_tolerance(scene) && way != Way::Continued {
        return Verdict::NotApplicable;
    }
    let tolerance = settings::tolerance(scene);
    let plain = ALLOWED * tolerance + round_off(scene);
    let changed = match way {
        Way::LoadSteps => ways::load_steps(scene, rng),
        Way::Tolerance => ways::tighter(scene),
        Way::Integrator => ways::integrator(scene, rng),
        Way::Count => ways::count(scene, rng),
        Way::FixedStep => ways::half_steps(scene),
        Way::Mesh => (settings::all_cells(scene) <= 40).then(|| settings::finer(scene)).flatten(),
        Way::Welded => cut::cut(scene),
        Way::Basis => settings::other_basis(scene),
        Way::Continued if stages::has(scene) => return in_two_files(case, base, rng),
        Way::Continued => return continued(case, base, rng),
        Way::Split => stages::split(scene, rng),
        Way::AtOnce => return at_once(case, base, rng),
        Way::Accuracy => return accurate(case, rng),
        Way::Estimate => return tells_its_error(case, base, rng),
        Way::Limit => return ends_before_limit(case, rng),
        Way::Turned | Way::Mirrored | Way::Units | Way::Balance | Way::Momentum => None,
    };
    let Some(changed) = changed else { return Verdict::NotApplicable };
    let path = settings::get(scene, &["analysis", "static", "arc_length"]).is_some();
    if path && matches!(way, Way::Mesh | Way::Welded | Way::Basis) {
        // Where a path ends by its points depends on the mesh, and where it ends by a place it may
        // pass it again.
        let until = settings::get(scene, &["analysis", "static", "arc_length", "until_load"]).is_some();
        if !until {
            return Verdict::NotApplicable;
        }
    }
    let text = || frame.write(&changed).to_string();
    let result = (|| {
        let seen = other(&changed, frame, way)?;
        let records = if settings::motion(scene).is_some() { Records::Common } else { Records::Last };
        let gap = gap::between(base, &seen, records);
        let places = |value: f64, allowed: f64| Measured {
            value,
            allowed,
            places: true,
            what: "a position or an eigenvalue".to_owned(),
        };
        Ok(match way {
            Way::Count => places(gap.places, ALLOWED * EIGENVALUES + OF_EIGENVALUES * round_off(scene)),
            Way::FixedStep => {
                let third = ways::half_steps(&changed).ok_or(Verdict::NotApplicable)?;
                let finest = other(&third, frame, way)?;
                let next = gap::between(&seen, &finest, records);
                estimated(&next, gap.places, plain)
            }
            // Nodes at the jumps of a beam's quantities may make one mesh of two numbers of elements.
            Way::Mesh if gap.places == 0.0 => return Err(Verdict::NotApplicable),
            Way::Mesh => {
                let third = settings::finer(&changed).ok_or(Verdict::NotApplicable)?;
                let finest = other(&third, frame, way)?;
                let next = gap::between(&seen, &finest, records);
                let mut measured = estimated(&next, gap.places, 1e-6 + plain);
                // Two meshes may be near each other by chance, and where nodes lie at the jumps of a
                // beam's quantities they are nearly the same. The error then falls from there on.
                if measured.value > measured.allowed
                    && let Some(fourth) = settings::finer(&third)
                {
                    let rest = gap::between(&finest, &*other(&fourth, frame, way)?, records);
                    if rest.places < 0.5 * next.places {
                        measured.allowed = measured.allowed.max(ALLOWED * next.places);
                    }
                }
                measured
            }
            Way::Welded => {
                let fine = settings::finer(scene).ok_or(Verdict::NotApplicable)?;
                let fine_cut = settings::finer(&changed).ok_or(Verdict::NotApplicable)?;
                let whole = gap::between(base, &*other(&fine, frame, way)?, records);
                // Beside a cut, shape functions that reach over several cells are others.
                let pieces = gap::between(&seen, &*other(&fine_cut, frame, way)?, records);
                estimated(&gap, WELDED * (whole.places + pieces.places), 1e-6 + plain)
            }
            Way::Basis => {
                let fine = settings::finer(scene).ok_or(Verdict::NotApplicable)?;
                let fine_other = settings::finer(&changed).ok_or(Verdict::NotApplicable)?;
                let next =
                    gap::between(&*other(&fine, frame, way)?, &*other(&fine_other, frame, way)?, records);
                let errors = |[mesh, mesh_of_other]: [&Table; 2]| {
                    let [one, two] = [(base, mesh), (&*seen, mesh_of_other)].map(|(of, mesh)| {
                        other(mesh, frame, way).map(|finer| gap::between(of, &finer, records).places)
                    });
                    Ok::<f64, Verdict>(one? + two?)
                };
                let mut measured = estimated(&next, errors([&fine, &fine_other])?, 1e-6 + plain);
                // Nodes at the jumps of a beam's quantities may make nearly one mesh of two numbers of cells.
                if measured.value > measured.allowed
                    && let (Some(finest), Some(finest_other)) =
                        (settings::finer(&fine), settings::finer(&fine_other))
                {
                    measured.allowed = measured.allowed.max(ALLOWED * errors([&finest, &finest_other])?);
                }
                measured
            }
            Way::Split => {
                let mut measured = places_or_forces(&gap, plain, scene);
                // Other steps make other errors: of forces, which no tolerance bounds, and of all
                // where steps are fixed and the first part ends within one. A smaller tolerance,
                // or steps of half the length, tells how large these are. Where the steps are those
                // of a load, only the second time makes them others.
                for (run, scene) in [(base, scene), (&*seen, &changed)] {
                    let mut finer = Some(scene.clone());
                    for _ in 0..2 {
                        finer = finer.and_then(|of| ways::tighter(&of).or_else(|| ways::half_steps(&of)));
                        let Some(finer) = finer.as_ref().filter(|_| measured.value > measured.allowed) else {
                            break;
                        };
                        let errors = gap::between(run, &*other(finer, frame, way)?, records);
                        let error = if measured.places { errors.places } else { errors.forces };
                        measured.allowed = measured.allowed.max(ALLOWED * error);
                    }
                }
                measured
            }
            _ => places(gap.places, plain),
        })
    })();
    match result {
        Ok(measured) => {
            let measured = if matches!(way, Way::Mesh | Way::Welded | Way::Basis) {
                beside_own_estimates(measured, [scene, &changed], frame)
            } else {
                measured
            };
            decide(case, way, measured, &text(), rng)
        }
        Err(verdict) => verdict,
    }
}

/// A difference of two meshes that are coarse is a finding only if the program's own estimates of their
/// errors do not tell it either. Two finer meshes may be near each other by chance.
fn beside_own_estimates(measured: Measured, scenes: [&Table; 2], frame: &Frame) -> Measured {
    if measured.value <= measured.allowed {
        return measured;
    }
    let own: f64 = scenes.iter().filter_map(|scene| outcome::own_estimate(scene, frame)).sum();
    Measured { allowed: measured.allowed.max(ALLOWED * own), ..measured }
}

/// Positions that must agree, or else forces.
fn places_or_forces(gap: &Gap, allowed: f64, scene: &Table) -> Measured {
    let forces = FORCES.max(allowed) + OF_FORCES * round_off(scene);
    if gap.places <= allowed && gap.forces > forces {
        let what = "section forces or reactions".to_owned();
        return Measured { value: gap.forces, allowed: forces, places: false, what };
    }
    Measured { value: gap.places, allowed, places: true, what: "a position or an eigenvalue".to_owned() }
}

/// What comes and goes in static stages leads to the equilibrium that all of it has at once.
fn at_once(case: &Case, base: &Seen, rng: &mut Rng) -> Verdict {
    let Case { scene, frame, .. } = case;
    let way = Way::AtOnce;
    let Some(changed) = stages::at_once(scene) else { return Verdict::NotApplicable };
    let seen = match other(&changed, frame, way) {
        Ok(seen) => seen,
        Err(verdict) => return verdict,
    };
    let gone = base.before.len() - seen.before.len();
    let later = Seen { before: base.before[gone..].to_vec(), ..base.clone() };
    let gap = gap::between(&later, &seen, Records::Last);
    let allowed = ALLOWED * settings::tolerance(scene) + round_off(scene);
    let mut measured = places_or_forces(&gap, allowed, scene);
    // What has gone may leave nodes where it began and ended, and so another mesh.
    for (run, scene) in [(&later, scene), (&*seen, &changed)] {
        if measured.value <= measured.allowed {
            break;
        }
        let Some(finer) = settings::finer(scene) else { continue };
        match other(&finer, frame, way) {
            Ok(finer) => {
                let errors = gap::between(run, &finer, Records::Last);
                let error = if measured.places { errors.places } else { errors.forces };
                measured.allowed = measured.allowed.max(ALLOWED * error);
            }
            Err(verdict) => return verdict,
        }
    }
    if measured.value > measured.allowed && other_branch(case, &changed, &later, measured.allowed) {
        return Verdict::Unstable;
    }
    decide(case, way, measured, &frame.write(&changed).to_string(), rng)
}

/// Whether what static stages lead to is another equilibrium of the scene that has all at once: it
/// then stays there.
fn other_branch(case: &Case, changed: &Table, base: &Seen, allowed: f64) -> bool {
    let first = base.before.first().unwrap_or(base);
    let statics = stages::part(changed, 0..1).unwrap_or_else(|| changed.clone());
    let Some(saved) = &first.saved else { return false };
    match outcome::run_from(&statics, &case.frame, Some(saved)) {
        Outcome::Solved(seen) => {
            let alone = Seen { before: Vec::new(), ..first.clone() };
            gap::between(&alone, &seen, Records::Last).places <= allowed
        }
        _ => false,
    }
}

/// Stages of which the later ones go on from a saved state.
fn in_two_files(case: &Case, base: &Seen, rng: &mut Rng) -> Verdict {
    let Case { scene, frame, .. } = case;
    let way = Way::Continued;
    let Some([first, rest]) = stages::two_files(scene, rng) else { return Verdict::NotApplicable };
    if stages::ends_shape_functions(&first, &rest) {
        return Verdict::NotApplicable;
    }
    let tendons_and_actuations = |scene: &Table| -> Vec<Table> {
        let kinds = ["tendon", "actuation"].into_iter();
        kinds.flat_map(|kind| settings::items(scene, &["effect", kind]).cloned()).collect()
    };
    let half = match other(&first, frame, way) {
        Ok(half) => half,
        Err(verdict) => return verdict,
    };
    let Some(saved) = &half.saved else {
        return finding(way, "a stage leaves no state".into(), frame.write(&first).to_string());
    };
    let text = || format!("{}\n# and then, --from its state:\n{}", frame.write(&first), frame.write(&rest));
    let seen = match outcome::run_from(&rest, frame, Some(saved)) {
        Outcome::Solved(seen) if seen.warnings.is_empty() => seen,
        Outcome::Solved(_) => return Verdict::Warned,
        // Stages share their nodes, and what comes or goes between nodes adds one of its own.
        Outcome::Failed(said) | Outcome::Refused(said) if said.contains("nodes when it was saved") => {
            return Verdict::NotApplicable;
        }
        // A path in a file of its own does not know that the state before it holds what only loads hold.
        Outcome::Refused(said) if said.contains("is under-supported") => return Verdict::NotApplicable,
        // Stages let a tendon or an actuation go as it is. A state does not know of it: the forces that it
        // has left keep their directions as they fade, and a state that needs it to be stable has no other
        // way.
        Outcome::Failed(_) | Outcome::Refused(_)
            if tendons_and_actuations(&first)
                .iter()
                .any(|one| !tendons_and_actuations(&rest).contains(one)) =>
        {
            return Verdict::NotApplicable;
        }
        Outcome::Failed(said) | Outcome::Refused(said) => {
            return finding(way, format!("it does not go on: {said}"), text());
        }
        Outcome::Panicked(said) => return finding(way, format!("a panic: {said}"), text()),
        Outcome::TooLong => return Verdict::TooLong,
    };
    let gone = base.before.len() - seen.before.len();
    let later = Seen { before: base.before[gone..].to_vec(), ..base.clone() };
    // Where a path ends by its points depends on its steps, which another round-off at a contact changes.
    if settings::ends_by_points(&rest) && ends_elsewhere(&later, &seen) {
        return Verdict::NotApplicable;
    }
    let gap = gap::between(&later, &seen, Records::Last);
    let tolerance = match () {
        () if settings::ends_by_points(&rest) => FORCES,
        () if settings::has_expression(scene) => ALLOWED * settings::tolerance(scene),
        () => CONTINUED,
    };
    decide(case, way, places_or_forces(&gap, tolerance + round_off(scene), scene), &text(), rng)
}

/// A difference that an estimate of the error should explain.
fn estimated(gap: &Gap, estimate: f64, least: f64) -> Measured {
    Measured {
        value: gap.places,
        allowed: ALLOWED * estimate + least,
        places: true,
        what: format!("position or eigenvalue, of which the estimated error is {estimate:.2e}"),
    }
}

/// Whether two paths end at other load factors.
fn ends_elsewhere(a: &Seen, b: &Seen) -> bool {
    let [a, b] = [a, b].map(|seen| seen.parameter.last().copied().unwrap_or(0.0));
    (a - b).abs() > FORCES * a.abs()
}

/// Runs a scene for an accuracy and for a hundredth of it.
fn accurate(case: &Case, rng: &mut Rng) -> Verdict {
    let Case { scene, frame, .. } = case;
    let way = Way::Accuracy;
    let wanted = [1e-2, 1e-3, 1e-4, 1e-5][rng.usize(0..4)];
    let (open, finer) = (settings::opened(scene, wanted), settings::opened(scene, HUNDREDTH * wanted));
    let (Some(open), Some(finer)) = (open, finer) else { return Verdict::NotApplicable };
    let runs = [&open, &finer].map(|scene| other(scene, frame, way));
    let [seen, finest] = match runs {
        [Ok(seen), Ok(finest)] => [seen, finest],
        [Err(verdict), _] | [_, Err(verdict)] => return verdict,
    };
    // On another mesh a path takes other steps.
    if settings::ends_by_points(scene) && ends_elsewhere(&seen, &finest) {
        return Verdict::NotApplicable;
    }
    let moves = settings::motion(scene).is_some();
    let gap = gap::between(&seen, &finest, if moves { Records::Common } else { Records::Last });
    let allowed = ALLOWED * wanted + round_off(scene);
    // Of vibrations and critical loads their numbers are wanted, and not where the beam lies.
    let numbers = matches!(settings::analysis(scene), "modal" | "buckling");
    let off = if numbers { gap.eigenvalues } else { gap.places };
    if off <= allowed {
        if let Some(measured) = event_beyond_its_error(&seen, &finest) {
            return decide(case, way, measured, &frame.write(&open).to_string(), rng);
        }
        let error = gap::of_last(&seen, &finest);
        let told = finest.estimated.is_some_and(|least| least <= TOLD * error);
        let last = seen.estimated.filter(|_| told).map(|estimated| [error, estimated]);
        return Verdict::Estimated(Estimated { wanted, error: off, last });
    }
    let what = "a position or an eigenvalue of a run for an accuracy".to_owned();
    let measured = Measured { value: off, allowed, places: true, what };
    decide(case, way, measured, &frame.write(&open).to_string(), rng)
}

/// An event of which the time or the load factor is not what a run tells it to be, by another run for a hundredth of its accuracy. Where one
/// has more events than the other, or one tells nothing of an event, nobody knows which belong together.
fn event_beyond_its_error(seen: &Seen, finest: &Seen) -> Option<Measured> {
    if seen.events.len() != finest.events.len() {
        return None;
    }
    let end = finest.parameter.last().map_or(1.0, |end| end.abs());
    let pairs =
        seen.events.iter().zip(&finest.events).zip(seen.event_errors.iter().zip(&finest.event_errors));
    let mut measured = pairs.map(|((event, other), (told, least))| Measured {
        value: (event - other).abs(),
        allowed: ALLOWED * (told + least) + 1e-9 * end,
        places: false,
        what: format!("time or load factor of an event, whose error is said to be {told:.2e}"),
    });
    measured.find(|measured| measured.value > measured.allowed)
}

/// What a scene says of the errors of the mesh that it names, against a mesh four times as fine.
fn tells_its_error(case: &Case, base: &Seen, rng: &mut Rng) -> Verdict {
    let Case { scene, frame, .. } = case;
    let way = Way::Estimate;
    // Of motions the steps err, too, and paths end elsewhere on other meshes.
    let is_path = |analysis: &Table| settings::get(analysis, &["static", "arc_length"]).is_some();
    let path = settings::analyses(scene).any(is_path);
    // Halves and quarters of the fewest cells are too coarse for errors to fall regularly.
    let cells = [settings::fewest_cells(scene), settings::all_cells(scene)];
    if settings::motion(scene).is_some() || path || cells[0] < ENOUGH || cells[1] > 40 {
        return Verdict::NotApplicable;
    }
    let Some(fine) = settings::finer(scene).and_then(|fine| settings::finer(&fine)) else {
        return Verdict::NotApplicable;
    };
    let Some(estimate) = outcome::own_estimate(scene, frame) else { return Verdict::NotApplicable };
    let seen = match other(&fine, frame, way) {
        Ok(seen) => seen,
        Err(verdict) => return verdict,
    };
    let gap = gap::between(base, &seen, Records::Last);
    let numbers = matches!(settings::analysis(scene), "modal" | "buckling");
    let value = match numbers {
        _ if stages::has(scene) => gap.places.max(gap.eigenvalues),
        true => gap.eigenvalues,
        false => gap.places,
    };
    let allowed = ALLOWED * (estimate + settings::tolerance(scene)) + round_off(scene);
    let what = format!("a position or an eigenvalue, whose error is said to be {estimate:.2e}");
    decide(case, way, Measured { value, allowed, places: true, what }, &frame.write(&fine).to_string(), rng)
}

/// A path to a load factor just below its first limit load ends where one by short steps does.
fn ends_before_limit(case: &Case, rng: &mut Rng) -> Verdict {
    let Case { scene, frame, .. } = case;
    let way = Way::Limit;
    let Some(long) = ways::long_path(scene) else { return Verdict::NotApplicable };
    let Outcome::Solved(long) = outcome::run(&long, frame) else { return Verdict::NotApplicable };
    let turn = long.parameter.windows(2).position(|pair| pair[1] < pair[0]);
    let Some(limit) = turn.and_then(|at| long.parameter.get(at)).filter(|limit| **limit > 0.0) else {
        return Verdict::NotApplicable;
    };
    let load = limit * (1.0 - 10.0_f64.powi(-rng.i32(1..6)));
    let Some(below) = ways::path_to(scene, load) else { return Verdict::NotApplicable };
    let Some(slowly) = ways::short_steps(&below) else { return Verdict::NotApplicable };
    let (ends, expected) = match (other(&below, frame, way), other(&slowly, frame, way)) {
        (Ok(ends), Ok(expected)) => (ends, expected),
        (Err(verdict), _) | (_, Err(verdict)) => return verdict,
    };
    let gap = gap::between(&ends, &expected, Records::Last);
    // Near a limit point positions go with the root of the load.
    let allowed = ALLOWED * settings::tolerance(scene).sqrt() + round_off(scene);
    let what = format!("a position at load factor {load}, just below the limit load");
    let measured = Measured { value: gap.places, allowed, places: true, what };
    decide(case, way, measured, &frame.write(&slowly).to_string(), rng)
}

fn continued(case: &Case, base: &Seen, rng: &mut Rng) -> Verdict {
    let Case { scene, frame, .. } = case;
    let way = Way::Continued;
    let Some([first, rest]) = ways::parts(scene, rng) else { return Verdict::NotApplicable };
    let half = match other(&first, frame, way) {
        Ok(half) => half,
        Err(verdict) => return verdict,
    };
    let Some(saved) = &half.saved else {
        return finding(way, "a motion leaves no state".into(), frame.write(&first).to_string());
    };
    let text = || format!("{}\n# and then, --from its state:\n{}", frame.write(&first), frame.write(&rest));
    let outcome = outcome::run_from(&rest, frame, Some(saved));
    let seen = match &outcome {
        Outcome::Solved(seen) => {
            let mut seen = seen.clone();
            // Its angles count from where it begins.
            for (probe, before) in seen.probes.iter_mut().zip(&half.probes) {
                let turned = before.last().map_or(0.0, |sample| sample.angle);
                probe.iter_mut().for_each(|sample| sample.angle += turned);
            }
            // So do its energies.
            if let (Some(first), Some(whole)) = (seen.energy.first_mut(), base.energy.first()) {
                *first = *whole;
            }
            seen
        }
        Outcome::Failed(said) | Outcome::Refused(said) => {
            return finding(way, format!("it does not go on: {said}"), text());
        }
        Outcome::Panicked(said) => return finding(way, format!("a panic: {said}"), text()),
        Outcome::TooLong => return Verdict::TooLong,
    };
    let gap = gap::between(base, &seen, Records::Last);
    // The state goes on bit for bit; forces are computed of it, and are round-off where nothing
    // acts.
    let allowed = if gap.places > CONTINUED { CONTINUED } else { CONTINUED + OF_FORCES * round_off(scene) };
    let measured = if settings::has_expression(scene) {
        // Where steps end depends on how long an expression is looked at, also fixed ones at a kink.
        let halved = ways::half_steps(scene).map(|scene| other(&scene, frame, way));
        let error = match halved {
            None => settings::tolerance(scene),
            Some(Ok(halved)) => gap::between(base, &halved, Records::Last).places,
            Some(Err(verdict)) => return verdict,
        };
        let allowed = ALLOWED * error.max(settings::tolerance(scene)) + round_off(scene);
        Measured { value: gap.places, allowed, places: true, what: "a position".to_owned() }
    } else {
        Measured { value: gap.all.value, allowed, places: false, what: gap.all.what }
    };
    decide(case, way, measured, &text(), rng)
}

fn balanced(case: &Case, seen: &Seen, rng: &mut Rng) -> Verdict {
    let Some((off, what)) = balance::worst(&case.scene, seen) else { return Verdict::NotApplicable };
    let tolerance = settings::tolerance(&case.scene);
    let allowed = 1e-6 + OF_FORCES * round_off(&case.scene) + ALLOWED * tolerance;
    let measured = Measured { value: off, allowed, places: false, what };
    decide(case, Way::Balance, measured, "", rng)
}

/// Judges the balance of momentum in natural units, in which the whole motion is run once more.
fn keeps_momentum(case: &Case, rng: &mut Rng) -> Verdict {
    let Case { scene, .. } = case;
    let (way, natural) = (Way::Momentum, Frame::default());
    if !momentum::is_known(scene) {
        return Verdict::NotApplicable;
    }
    let Some([first, _]) = ways::parts(scene, rng) else { return Verdict::NotApplicable };
    let runs = [&first, scene].map(|scene| other(scene, &natural, way));
    let [first, whole] = match runs {
        [Ok(first), Ok(whole)] => [first, whole],
        [Err(verdict), _] | [_, Err(verdict)] => return verdict,
    };
    let Some((off, what)) = momentum::lacks(scene, &first, &whole) else { return Verdict::NotApplicable };
    let allowed = 1e-7 + round_off(scene) + ALLOWED * settings::tolerance(scene);
    decide(case, way, Measured { value: off, allowed, places: false, what }, "", rng)
}
