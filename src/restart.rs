//! A state saved by one run, from which another may start.
//!
//! A motion of the same model by the same integrator goes on bit for bit as if it had not been
//! interrupted: the file holds the integrator's data that are carried from step to step, in decimal
//! digits that give back the same numbers. Where the end of a run, or an event, cut a step short,
//! these data are saved as they were before this step, which is then taken once more in full;
//! results that the run has reported already are not reported again. Where an expression of time acts,
//! it goes on to its accuracy: where steps end depends on how long the expression is looked at.
//!
//! Another scene may start from the state too, with other loads, supports or another integrator: a
//! motion at rest in the equilibrium that a static run found, or a static run anywhere. Its beams
//! must be the same: in name, centreline, discretisation, nodes, measure of strain, stiffness and, where both have
//! one, mass. The state knows what acted and held in it. In a static run these parts go on to act
//! in full, while what is new grows with the load factor and what has gone fades. Friction and the full turns of torsion
//! springs stay where they are, whatever coefficients the other scene has.
//!
//! A checksum tells whether the file is as it was written.

use crate::assembly::InternalVariables;
use crate::model::{Along, Beam, Displacement, Entering, Integrator, Model};
use crate::solve::dynamics::{Checkpoint, State};
use crate::solve::resume::Holding;
use crate::system::{System, turning};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Version of the format.
const FORMAT: u32 = 8;

/// A state with the beams to which it belongs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavedState {
    saved: Saved,
}

/// What a file of a saved state holds.
#[derive(Serialize, Deserialize)]
struct File<S> {
    /// Version of the format.
    format: u32,
    /// SHA-256 of what follows, as compact JSON.
    sha256: String,
    /// The data that are saved.
    saved: S,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved {
    beams: Vec<SavedBeam>,
    /// SHA-256 of all that determines the motion; empty if there was no motion.
    motion: String,
    /// Beam and arc length of each angle of the states.
    directions: Vec<(usize, f64)>,
    /// Checksums of the parts that acted and of the supports that held.
    acted: Vec<String>,
    held: Vec<String>,
    /// What the internal variables of these parts belong to; empty for those without.
    remembered: Vec<String>,
    /// Per friction and per torsion spring, the number of its part among those that acted.
    history_of: [Vec<usize>; 2],
    /// The state, and the integrator's data.
    checkpoint: Checkpoint,
    /// Kinetic energy of the state that was reached \[J\].
    kinetic: f64,
    /// The forces that hold it, where they are known.
    holding: Option<SavedHolding>,
}

/// The forces that hold a state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedHolding {
    /// Coordinates that supports fix, and the generalised forces on them, in fixed axes.
    supports: Vec<(usize, f64)>,
    /// Checksums of what makes rows, and the forces \[N\] and moments \[N m\] of these.
    rows: Vec<(String, Vec<f64>)>,
}

/// The data of a beam that must be the same where a state is taken up.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedBeam {
    name: String,
    centreline: String,
    /// With the points of quadrature.
    discretization: String,
    /// How the axial strain is measured.
    strain: String,
    /// EA \[N\], EI \[N m²\] and EB \[N m\].
    stiffness: [Option<SavedQuantity>; 3],
    /// ρA \[kg/m\].
    mass: Option<SavedQuantity>,
    /// Arc lengths \[m\].
    nodes: Vec<f64>,
}

/// A quantity of a beam: a number, or a description of how it varies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum SavedQuantity {
    Constant(f64),
    Varying(String),
}

impl From<&Along> for SavedQuantity {
    fn from(along: &Along) -> Self {
        along.constant().map_or_else(|| Self::Varying(along.to_string()), Self::Constant)
    }
}

/// Why a saved state cannot be used.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[non_exhaustive]
pub enum RestartError {
    /// The file cannot be read.
    #[error("{path}: {cause}")]
    #[diagnostic(help("give the `state.json` that a run has written into its output directory"))]
    Read {
        /// The file.
        path: PathBuf,
        /// Cause of the failure.
        cause: std::io::Error,
    },
    /// The file is not a saved state.
    #[error("{path} is not a saved state: {cause}")]
    #[diagnostic(help(
        "give the `state.json` that a run of this version has written into its output directory"
    ))]
    Parse {
        /// The file.
        path: PathBuf,
        /// Cause of the failure.
        cause: serde_json::Error,
    },
    /// The file has another format.
    #[error("the saved state has format {found}, and this version reads format {FORMAT}")]
    #[diagnostic(help(
        "run the scene that made it again with this version, to the same time: its directory then has a new `state.json`"
    ))]
    Format {
        /// The format found.
        found: u32,
    },
    /// The file is not as it was written.
    #[error("{path} is not as it was written: its checksum is that of another content")]
    #[diagnostic(help(
        "a saved state cannot be edited: run the scene that made it again, or start from another copy of the file"
    ))]
    Altered {
        /// The file.
        path: PathBuf,
    },
    /// The scene has other beams.
    #[error("the saved state does not fit this scene: {what}")]
    #[diagnostic(help(
        "the beams must have the same names, centrelines, discretisations, nodes, sections and measures of strain in both scenes; supports, loads, joints and the integrator may differ. \
         What a scene leaves open for an `accuracy` is in the `chosen.toml` beside the state, which goes on"
    ))]
    Mismatch {
        /// What differs.
        what: String,
    },
    /// The analysis starts from the stress-free state.
    #[error("a {analysis} starts from the stress-free state, and from no other")]
    #[diagnostic(help(
        "[analysis.static] and [analysis.dynamic] start from a state that another run has left, and so does [analysis.modal] \
         with `about = \"equilibrium\"`"
    ))]
    Analysis {
        /// The analysis.
        analysis: &'static str,
    },
}

fn layout(model: &Model, system: &System) -> Vec<SavedBeam> {
    let beams = model.beams.iter().zip(system.beams());
    let saved = beams.map(|(beam, part)| {
        let Beam { name, centreline, section, strain, discretization, gauss_points } = beam;
        SavedBeam {
            name: name.clone(),
            centreline: format!("{centreline:?}"),
            discretization: format!("{discretization:?} {gauss_points:?}"),
            strain: format!("{strain:?}"),
            stiffness: [
                (&section.axial_stiffness, &section.axial_law),
                (&section.bending_stiffness, &section.bending_law),
                (&section.coupling, &None),
            ]
            .map(|(quantity, law)| match law {
                Some(law) => Some(SavedQuantity::Varying(format!("{law:?}"))),
                None => quantity.as_ref().map(SavedQuantity::from),
            }),
            mass: section.mass_per_length.as_ref().map(SavedQuantity::from),
            nodes: part.basis.nodes().to_vec(),
        }
    });
    saved.collect()
}

fn directions(model: &Model) -> Vec<(usize, f64)> {
    model.probes.iter().map(|probe| (probe.at.beam, probe.at.s)).collect()
}

fn sha256(bytes: &[u8]) -> String {
    let digit = |half: u8| char::from_digit(u32::from(half), 16).unwrap_or_default();
    Sha256::digest(bytes).iter().flat_map(|byte| [digit(byte >> 4), digit(byte & 15)]).collect()
}

/// With a checksum, which only what is written needs.
impl Serialize for SavedState {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        File { format: FORMAT, sha256: self.saved.sha256(), saved: &self.saved }.serialize(serializer)
    }
}

/// Whatever the checksum says; [`SavedState::load`] looks at it.
impl<'de> Deserialize<'de> for SavedState {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        File::deserialize(deserializer).map(|File { saved, .. }| Self { saved })
    }
}

/// A checksum of the integrator and of all of a model that determines how a motion goes on.
pub(crate) fn fingerprint(model: &Model, integrator: Integrator) -> String {
    let Model { beams, supports, joints, parts, .. } = model;
    sha256(format!("{beams:?} {supports:?} {joints:?} {parts:?} {integrator:?}").as_bytes())
}

fn checksums<T: std::fmt::Debug>(all: &[T]) -> Vec<String> {
    all.iter().map(|one| sha256(format!("{one:?}").as_bytes())).collect()
}

/// The checksums of a list without those of what is entering, which is nothing that was there before.
fn going_on<T: std::fmt::Debug>(all: &[T], entering: &[usize]) -> Vec<String> {
    let of = |(i, checksum): (usize, String)| if entering.contains(&i) { String::new() } else { checksum };
    checksums(all).into_iter().enumerate().map(of).collect()
}

/// Checksums of all that makes rows of constraints, in the order of [`System::forces_of_rows`], those of what is `entering` left empty.
fn rows(model: &Model, system: &System, entering: &Entering) -> Vec<String> {
    let Entering { supports, joints, parts } = entering;
    let of_parts = going_on(&model.parts, parts);
    let tendons = system.parts_of_tendons().map(|part| of_parts[part].clone());
    let held = [going_on(&model.supports, supports), going_on(&model.joints, joints)].concat();
    held.into_iter().chain(["lengths".into()]).chain(tendons).collect()
}

/// Per entry of `now`, the index of the same entry of `before`, each of which is found once.
fn matches(before: &[String], now: &[String]) -> Vec<Option<usize>> {
    let mut left: Vec<Option<&String>> = before.iter().map(Some).collect();
    let find = |one: &String| {
        let found = left.iter().position(|other| *other == Some(one))?;
        left[found] = None;
        Some(found)
    };
    now.iter().map(find).collect()
}

fn remembered(model: &Model) -> Vec<String> {
    model.parts.iter().map(|part| part.remembers().unwrap_or_default()).collect()
}

/// The internal variables by the parts that have them now; springs that are new have turned by `turned`.
fn moved(
    variables: &InternalVariables,
    before: &[Vec<usize>; 2],
    now: &[Vec<usize>; 2],
    same: &[Option<usize>],
    turned: &[f64],
) -> InternalVariables {
    // A part may have several: the n-th of a part is the n-th of the same part before.
    let index = |kind: usize, i: usize| {
        let part = now[kind][i];
        let nth = now[kind][..i].iter().filter(|other| **other == part).count();
        let there = same.get(part).copied().flatten()?;
        before[kind].iter().enumerate().filter(|(_, other)| **other == there).nth(nth).map(|(j, _)| j)
    };
    let contact = |i: usize| index(0, i).and_then(|j| variables.contacts.get(j).cloned()).unwrap_or_default();
    let angle = |(i, turned): (usize, &f64)| {
        index(1, i).and_then(|j| variables.angles.get(j).copied()).unwrap_or(*turned)
    };
    let contacts: Vec<_> = (0..now[0].len()).map(contact).collect();
    let angles: Vec<f64> = turned.iter().enumerate().map(angle).collect();
    InternalVariables { contacts, angles, ..variables.clone() }
}

impl Saved {
    fn sha256(&self) -> String {
        // A state without a JSON form cannot be written to a file either.
        sha256(&serde_json::to_vec(self).unwrap_or_default())
    }
}

impl SavedState {
    /// `motion` is the [`fingerprint`] of the motion, empty where there was none.
    pub(crate) fn new(
        model: &Model,
        system: &System,
        motion: String,
        checkpoint: Checkpoint,
        holding: Option<Holding>,
    ) -> Self {
        let reached = checkpoint.reached();
        let saved = Saved {
            kinetic: system.energy(reached.time, &reached.q, Some(&reached.v)).kinetic,
            beams: layout(model, system),
            motion,
            directions: directions(model),
            acted: checksums(&model.parts),
            held: checksums(&model.supports),
            remembered: remembered(model),
            history_of: system.history_of(),
            checkpoint,
            holding: holding.map(|Holding { supports, multipliers }| {
                let supports = supports.into_iter().enumerate().filter(|(_, force)| *force != 0.0);
                let rows = rows(model, system, &Entering::default())
                    .into_iter()
                    .zip(system.forces_of_rows(&multipliers));
                let rows = rows.filter(|(_, forces)| !forces.is_empty());
                SavedHolding { supports: supports.collect(), rows: rows.collect() }
            }),
        };
        Self { saved }
    }

    /// The forces that held it and that what holds in `model` takes over, where they are known. What
    /// is new begins without any.
    pub(crate) fn holding(&self, model: &Model, system: &System) -> Option<Holding> {
        let SavedHolding { supports: known, rows: before } = self.saved.holding.as_ref()?;
        let mut supports = vec![0.0; system.coordinates()];
        for (coordinate, force) in known {
            *supports.get_mut(*coordinate)? = *force;
        }
        let names: Vec<String> = before.iter().map(|(name, _)| name.clone()).collect();
        let same = matches(&names, &rows(model, system, &model.entering)).into_iter();
        let forces = same.map(|there| there.map(|there| &before[there].1[..]));
        Some(Holding { supports, multipliers: system.multipliers_of(forces) })
    }

    /// Its time \[s\].
    pub fn time(&self) -> f64 {
        self.saved.checkpoint.reached().time
    }

    /// The model as a run goes on with it from this state: what acted already stands, and supports
    /// that held already hold the beams where they are.
    pub(crate) fn gone_on(&self, model: &Model) -> Model {
        let found = |before: &[String], now: &[String]| {
            let same = matches(before, now).into_iter().enumerate();
            same.filter_map(|(i, there)| there.map(|_| i)).collect::<Vec<_>>()
        };
        let mut model = model.clone();
        let Entering { supports, parts, .. } = model.entering.clone();
        model.standing = Some(found(&self.saved.acted, &going_on(&model.parts, &parts)));
        for i in found(&self.saved.held, &going_on(&model.supports, &supports)) {
            let support = &mut model.supports[i];
            if support.law.is_none() {
                support.displacement = Displacement::default();
            }
        }
        model
    }

    /// Per part of a model, the one before whose internal variables it goes on with: the same part, or else one with
    /// other coefficients at the same place.
    fn with_the_history_of(&self, model: &Model) -> Vec<Option<usize>> {
        let mut same = matches(&self.saved.acted, &going_on(&model.parts, &model.entering.parts));
        let mut before = self.saved.remembered.clone();
        let mut now = remembered(model);
        for (part, there) in same.iter().enumerate().filter_map(|(part, there)| Some((part, (*there)?))) {
            now[part].clear();
            before.get_mut(there).map(String::clear);
        }
        for (part, there) in matches(&before, &now).into_iter().enumerate() {
            let remembers = !now[part].is_empty();
            same[part] = same[part].or(there.filter(|_| remembers));
        }
        same
    }

    /// Its kinetic energy \[J\].
    pub(crate) fn kinetic(&self) -> f64 {
        self.saved.kinetic
    }

    /// Whether it is an equilibrium that a static run found.
    pub(crate) fn is_equilibrium(&self) -> bool {
        self.saved.motion.is_empty()
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`RestartError`] where there is no such file, or it is something else or has been altered.
    pub fn load(path: &Path) -> Result<Self, RestartError> {
        #[derive(Deserialize)]
        struct Version {
            format: u32,
        }
        let text = std::fs::read_to_string(path)
            .map_err(|cause| RestartError::Read { path: path.to_path_buf(), cause })?;
        let no_state = |cause| RestartError::Parse { path: path.to_path_buf(), cause };
        let Version { format } = serde_json::from_str(&text).map_err(no_state)?;
        if format != FORMAT {
            return Err(RestartError::Format { found: format });
        }
        let File::<Saved> { sha256, saved, .. } = serde_json::from_str(&text).map_err(no_state)?;
        if sha256 != saved.sha256() {
            return Err(RestartError::Altered { path: path.to_path_buf() });
        }
        Ok(Self { saved })
    }

    /// Writes a file.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        std::fs::write(path, serde_json::to_vec(self)?)
    }

    /// The saved checkpoint, if it belongs to the beams of `model`, and whether the motion of this
    /// `fingerprint` goes on; any other motion starts from the state alone.
    ///
    /// # Errors
    /// [`RestartError::Mismatch`] naming the first difference.
    pub(crate) fn take_up(
        &self,
        model: &Model,
        system: &System,
        fingerprint: &str,
    ) -> Result<(Checkpoint, bool), RestartError> {
        let mismatch = |what: String| Err(RestartError::Mismatch { what });
        let (here, there) = (layout(model, system), &self.saved.beams);
        if here.len() != there.len() {
            return mismatch(format!("it has {} beams, the scene {}", there.len(), here.len()));
        }
        for (here, there) in here.iter().zip(there) {
            let name = &here.name;
            let masses = here.mass.as_ref().zip(there.mass.as_ref());
            if *name != there.name {
                return mismatch(format!("its beam `{}` is called `{name}` in the scene", there.name));
            }
            if here.nodes != there.nodes {
                let (n, m) = (here.nodes.len(), there.nodes.len());
                return mismatch(format!(
                    "beam `{name}` had {m} nodes when it was saved and has {n} now, or they lie elsewhere"
                ));
            }
            if here.centreline != there.centreline {
                return mismatch(format!("beam `{name}` had another centreline when it was saved"));
            }
            if here.discretization != there.discretization {
                return mismatch(format!(
                    "beam `{name}` had another discretisation, or other points of quadrature, when it was saved"
                ));
            }
            if here.strain != there.strain {
                return mismatch(format!("beam `{name}` had another measure of `strain` when it was saved"));
            }
            if here.stiffness != there.stiffness || masses.is_some_and(|(here, there)| here != there) {
                return mismatch(format!("beam `{name}` had another section when it was saved"));
            }
        }
        let mut checkpoint = self.saved.checkpoint.clone();
        // Angles at the probes of this scene. Those of new places follow along the beam from the nearest one of which they are known;
        // on a beam without any, turns count from now on.
        let there = &self.saved.directions;
        for state in [&mut checkpoint.state].into_iter().chain(&mut checkpoint.cut) {
            let angle = |(beam, s): (usize, f64)| {
                let known = there.iter().zip(&state.angles);
                let known = known.filter(|((other, _), angle)| *other == beam && angle.is_finite());
                let nearest =
                    known.min_by(|((_, a), _), ((_, b), _)| (a - s).abs().total_cmp(&(b - s).abs()));
                let ((_, from), angle) = nearest?;
                let part = system.beams().get(beam)?;
                if *from == s {
                    Some(*angle)
                } else {
                    Some(angle + turning::between(part, &state.q, [*from, s])?)
                }
            };
            state.angles =
                directions(model).into_iter().map(|place| angle(place).unwrap_or(f64::NAN)).collect();
        }
        let fits = |state: &State| {
            let numbers = state.q.iter().chain(&state.v).chain([&state.time, &state.work, &state.lost]);
            [&state.q, &state.v].iter().all(|v| v.len() == system.coordinates())
                && numbers.copied().all(f64::is_finite)
        };
        let state = checkpoint.reached();
        if !fits(state) || !fits(&checkpoint.state) {
            return mismatch("its coordinates or velocities are incomplete".into());
        }
        // What statics goes on with may be other parts.
        if fingerprint.is_empty() || self.saved.motion != fingerprint {
            let same = self.with_the_history_of(model);
            let (before, turned) = (&self.saved.history_of, system.turned(&state.q));
            let variables = moved(&state.variables, before, &system.history_of(), &same, &turned);
            let variables = system.with_energies(variables, &state.q);
            let state = State { variables, ..state.clone() };
            return Ok((Checkpoint { state, ..Checkpoint::default() }, false));
        }
        let Checkpoint { method, memory, step, last_ratio, origin: (origin, _), .. } = &checkpoint;
        let positive = |v: f64| v.is_finite() && v > 0.0;
        let sound = positive(*step) && positive(*last_ratio) && origin.is_finite();
        // Without the name of a method there is no memory of one.
        if !(method.is_empty() || sound && memory.is_finite()) {
            return mismatch("what its integrator carries from step to step is no sound number".into());
        }
        Ok((checkpoint, true))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Needs;
    use crate::scene::{Scene, parse};
    use crate::solve::dynamics::memory::{CollocationMemory, Memory};

    const ARM: &str = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, \
         bending_stiffness = 0.1, mass_per_length = 1, basis.ancf.elements = 2 }\n\
         support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]\n\
         effect.gravity.acceleration = [0, -9.81]\n\
         analysis.dynamic.duration = 0.01\n";

    /// The first example of FIPS 180-2, appendix B.
    #[test]
    fn a_digest_is_that_of_the_standard() {
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), expected);
    }

    fn scene(text: &str) -> Scene {
        parse("arm.toml", text).expect("a scene")
    }

    fn saved(text: &str) -> SavedState {
        let scene = scene(text);
        let motion = scene.model().solve(scene.analysis());
        motion.expect("a motion").into_states().saved.expect("a state")
    }

    /// The state taken up by the model of a text, as the same motion or another.
    fn taken(state: &SavedState, text: &str, same: bool) -> Result<(Checkpoint, bool), String> {
        let scene = scene(text);
        let system = System::build(scene.model(), Needs { inertia: true, motion: true });
        let system = system.expect("a system");
        let motion = if same { state.saved.motion.clone() } else { String::new() };
        state.take_up(scene.model(), &system, &motion).map_err(|error| error.to_string())
    }

    fn of_collocation(checkpoint: &mut Checkpoint) -> &mut CollocationMemory {
        match &mut checkpoint.memory {
            Memory::Collocation(memory) => memory,
            other => panic!("{other:?}"),
        }
    }

    /// Would catch a number of a saved state that is not checked: with each out of order in turn,
    /// the state is refused.
    #[test]
    fn no_number_of_a_state_is_taken_unseen() {
        let sound = saved(ARM);
        assert_eq!(taken(&sound, ARM, true), Ok((sound.saved.checkpoint.clone(), true)));
        let (nan, infinite) = (f64::NAN, f64::INFINITY);
        type Change = Box<dyn Fn(&mut Checkpoint)>;
        let of_state: [Change; 7] = [
            Box::new(|c| c.state.q.truncate(11)),
            Box::new(|c| c.state.v.push(0.0)),
            Box::new(move |c| c.state.q[3] = nan),
            Box::new(move |c| c.state.v[3] = infinite),
            Box::new(move |c| c.state.work = nan),
            // The state before a step that was cut, and the one that was reached, are both needed.
            Box::new(|c| {
                c.cut = Some(c.state.clone());
                c.state.q.clear();
            }),
            Box::new(|c| c.cut = Some(State { v: Vec::new(), ..c.state.clone() })),
        ];
        let of_method: [Change; 8] = [
            Box::new(|c| c.step = 0.0),
            Box::new(|c| c.step = -1e-3),
            Box::new(move |c| c.step = infinite),
            Box::new(|c| c.last_ratio = 0.0),
            Box::new(move |c| c.last_ratio = nan),
            Box::new(move |c| c.origin.0 = infinite),
            Box::new(move |c| of_collocation(c).accelerations[1][2] = nan),
            Box::new(move |c| of_collocation(c).last_step = infinite),
        ];
        for (i, change) in of_state.iter().enumerate() {
            let mut state = sound.clone();
            change(&mut state.saved.checkpoint);
            let refused = taken(&state, ARM, true).expect_err("an unsound state");
            assert!(refused.contains("coordinates or velocities are incomplete"), "{i}: {refused}");
        }
        for (i, change) in of_method.iter().enumerate() {
            let mut state = sound.clone();
            assert!(!state.saved.checkpoint.method.is_empty());
            change(&mut state.saved.checkpoint);
            let refused = taken(&state, ARM, true).expect_err("an unsound memory");
            assert!(refused.contains("no sound number"), "{i}: {refused}");
            // Another motion starts from the state alone, and so does one without the memory of a
            // method.
            let (other, same) = taken(&state, ARM, false).expect("the state is sound");
            assert_eq!(
                (other.state, other.step, same),
                (state.saved.checkpoint.reached().clone(), 0.0, false)
            );
            state.saved.checkpoint.method.clear();
            assert!(taken(&state, ARM, true).is_ok_and(|(_, same)| same), "{i}");
        }
    }

    /// Would catch beams that are taken for those of the state although they differ.
    #[test]
    fn a_state_of_other_beams_is_refused_with_the_first_difference() {
        let state = saved(ARM);
        let second = ARM.replace(
            "beam.arm",
            "beam.other = { start = [0, 2], end = [1, 2], \
             axial_stiffness = 1e3, bending_stiffness = 0.1, mass_per_length = 1, \
             basis.ancf.elements = 2 }\nbeam.arm",
        );
        for (text, part) in [
            (second, "it has 1 beams, the scene 2"),
            (ARM.replace("beam.arm", "beam.leg").replace("'arm'", "'leg'"), "its beam `arm` is called `leg`"),
            (ARM.replace("elements = 2", "elements = 3"), "had 3 nodes when it was saved and has 4 now"),
            (ARM.replace("ancf.elements = 2", "ancf.nodes = [0, 0.3, 1]"), "or they lie elsewhere"),
            (
                ARM.replace("start = [0, 0], end = [1, 0]", "start = [0, 1], end = [1, 1]"),
                "another centreline",
            ),
            (ARM.replace("ancf.elements = 2", "rpim.nodes = 3"), "another discretisation"),
            (
                ARM.replace(
                    "elements = 2",
                    "elements = 2, basis.ancf.gauss_points = { stretch = 5, bend = 3 }",
                ),
                "or other points of quadrature",
            ),
            (
                ARM.replace("mass_per_length", "strain = 'green', mass_per_length"),
                "another measure of `strain`",
            ),
            (ARM.replace("axial_stiffness = 1e3", "axial_stiffness = 2e3"), "another section"),
            (ARM.replace("bending_stiffness = 0.1", "bending_stiffness = 0.2"), "another section"),
            (ARM.replace("mass_per_length = 1", "mass_per_length = 2"), "another section"),
        ] {
            let refused = taken(&state, &text, false).expect_err(part);
            assert!(refused.contains(part), "{part} in {refused}");
        }
        // The mass may be unknown in an equilibrium.
        let mut massless = state;
        massless.saved.beams[0].mass = None;
        assert!(taken(&massless, ARM, false).is_ok());
    }

    /// Would catch an angle that is taken up at another probe than its own, and so is wrong by full
    /// turns. The beam is nearly straight: a new place has the direction of the nearest one.
    #[test]
    fn angles_stay_with_their_probes() {
        let probes = |places: &[f64]| {
            let probe = |s: &f64| format!("{{ name = 'p{s}', beam = 'arm', at = {s} }}");
            format!("probe = [{}]\n{ARM}", places.iter().map(probe).collect::<Vec<_>>().join(", "))
        };
        let mut state = saved(&probes(&[0.25, 0.5, 1.0]));
        state.saved.checkpoint.state.angles = vec![7.0, 8.0, 9.0];
        if let Some(cut) = &mut state.saved.checkpoint.cut {
            cut.angles = vec![7.0, 8.0, 9.0];
        }
        let (taken, _) = taken(&state, &probes(&[1.0, 0.75, 0.25]), true).expect("the same beams");
        for state in [&taken.state].into_iter().chain(&taken.cut) {
            assert_eq!((state.angles[0], state.angles[2], state.angles.len()), (9.0, 7.0, 3));
            assert!((state.angles[1] - 8.0).abs() < 0.01, "{:?}", state.angles);
        }
    }
}
