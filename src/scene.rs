//! Scene files: text → checked description.
//!
//! A scene is a TOML file; numbers in it are SI, text carries a unit (`"45 cm"`). Reading it goes
//! through
//!
//! ```text
//! text ──syntax──► tables ──keys, types, units──► tables with spans
//!                                                 └──cross-field rules──► Model + Analysis
//! ```
//!
//! and every fault on the way names file, line and column, what was found, and what is legal.
//! Nothing here knows of shape functions, degrees of freedom or solvers; a geometry is measured
//! only to place nodes and loads on it.

mod diagnose;
mod error;
mod file;
mod merge;
mod overrides;
mod place;
mod quantity;
mod reader;
mod rigid_motion;
mod schema;
mod to_along;
mod to_analysis;
mod to_basis;
mod to_law;
mod to_model;
mod to_parts;
mod to_section;
mod to_stages;
mod to_velocity;
mod unit;
mod value;

use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use toml::de::DeTable;

use crate::assembly::Part;
use crate::model::{Accuracy, Analysis, Model, Open, Stage};
use error::Fault;
use overrides::Overridden;

pub(crate) use unit::split_number;

pub use error::{Brief, Invalid, SceneError};
pub use schema::schema;
pub use to_analysis::{ARC_LENGTH_MAX_POINTS, DYNAMIC_RECORDS, MAX_RECORDS, MAX_STEPS};
pub use to_basis::{MAX_GAUSS_POINTS, MAX_MEMORY, MAX_NEIGHBOURS, MAX_NODES};

/// Longest scene file that is read \[bytes\]: it has room for more than 10⁷ places of nodes, and it
/// is a bound for endless input.
const LONGEST: u64 = 1 << 29;

/// A checked scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    name: String,
    text: String,
    model: Model,
    analysis: Analysis,
    stages: Vec<Stage>,
    accuracy: Option<Accuracy>,
    open: Open,
    output: Output,
    /// Number of the last parts of the model, which were added.
    added: usize,
}

/// Files asked for beyond those that are always written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Output {
    /// Every beam at every record, as `states.csv`.
    pub states: bool,
    /// A VTU series for ParaView.
    pub vtu: bool,
}

impl Scene {
    /// Reads the scene file at `path`, with `overrides` of the form `PATH=VALUE`: a dotted path
    /// whose list entries go by number (`effect.moment.0.value=12.5`), and a TOML value, or else
    /// text. `*` stands for all names of a table and all entries of a list
    /// (`beam.*.basis.ancf.elements=9`).
    ///
    /// # Errors
    /// Where the file cannot be read, an override has no place in it, or the scene is not legal.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self, SceneError> {
        let name = path.display().to_string();
        let unreadable = |reason: String| SceneError::Unreadable { path: path.to_owned(), reason };
        let bytes = std::fs::File::open(path)
            .and_then(|file| whole(file, LONGEST))
            .map_err(|error| unreadable(error.to_string()))?
            .ok_or_else(|| unreadable(format!("it is longer than {} MiB", LONGEST >> 20)))?;
        match String::from_utf8(bytes) {
            Ok(text) => Self::read(&name, &text, overrides),
            Err(error) => {
                let at = error.utf8_error().valid_up_to();
                let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
                Err(Fault::new(at..at, "the file is not UTF-8 text from here on")
                    .help("save it as UTF-8; a scene is a text file in the TOML format")
                    .at(&name, &text))
            }
        }
    }

    fn read(name: &str, text: &str, overrides: &[String]) -> Result<Self, SceneError> {
        if !overrides.is_empty() {
            DeTable::parse(text).map_err(|error| diagnose::syntax(&error, text).at(name, text))?;
        }
        Self::overridden(name, text, overrides)
    }

    /// The scene `text`, which must be TOML where there are overrides.
    fn overridden(name: &str, text: &str, overrides: &[String]) -> Result<Self, SceneError> {
        let overridden = Overridden::apply(name, text, overrides)?;
        let text = overridden.text();
        tables(name, text).map_err(|fault| overridden.blame(fault))
    }

    /// This scene with further `overrides`, of the form that [`load`](Self::load) takes.
    ///
    /// # Errors
    /// Where an override has no place in the scene, or the result is not legal.
    pub fn with(&self, overrides: &[String]) -> Result<Self, SceneError> {
        Self::overridden(&self.name, &self.text, overrides)
    }

    /// The analyses that are done one after the other; none where the scene has a single one.
    pub fn stages(&self) -> &[Stage] {
        &self.stages
    }

    /// This scene without the stages after the one called `name`; `None` where there is no such
    /// stage.
    #[must_use]
    pub fn through(&self, name: &str) -> Option<Self> {
        let last = self.stages.iter().position(|stage| stage.name == name)?;
        let mut scene = self.clone();
        scene.stages.truncate(last + 1);
        Some(scene)
    }

    /// The continuous problem, in SI; that of the first stage where there are stages.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// What is to be computed; [`Analysis::Stages`] where there are [stages](Self::stages).
    pub fn analysis(&self) -> &Analysis {
        &self.analysis
    }

    /// The largest errors that the results may have: as the scene says, or the usual ones where it
    /// leaves a discretisation open; `None` where it says nothing of accuracy and leaves nothing
    /// open.
    pub fn accuracy(&self) -> Option<Accuracy> {
        self.accuracy.or_else(|| self.open.beams.contains(&true).then(Accuracy::default))
    }

    /// Whether the scene says how large errors may be.
    pub fn names_accuracy(&self) -> bool {
        self.accuracy.is_some()
    }

    /// What is to be chosen for the accuracy.
    pub fn open(&self) -> &Open {
        &self.open
    }

    /// Adds a part that scene files have no words for. It is not in the [text](Self::text), and a
    /// scene that is made from this one by [`with`](Self::with) does not have it.
    pub fn add(&mut self, part: impl Part) {
        let part: Arc<dyn Part> = Arc::new(part);
        self.stages.iter_mut().for_each(|stage| stage.model.parts.push(Arc::clone(&part)));
        self.model.parts.push(part);
        self.added += 1;
    }

    /// Adds the parts that were [added](Self::add) to another scene.
    pub fn add_parts_of(&mut self, other: &Self) {
        let parts = &other.model.parts;
        let added = &parts[parts.len() - other.added..];
        self.model.parts.extend_from_slice(added);
        self.stages.iter_mut().for_each(|stage| stage.model.parts.extend_from_slice(added));
        self.added += other.added;
    }

    /// The value at a dotted path, as overrides write it, or nothing where the scene has none
    /// there; tables and lists as objects and arrays, dates as text.
    ///
    /// # Errors
    /// Where that is no path.
    pub fn value(&self, path: &str) -> Result<Option<serde_json::Value>, SceneError> {
        overrides::value(&self.text, path).map_err(|fault| fault.at("path", path))
    }

    /// Which further files are asked for.
    pub fn output(&self) -> Output {
        self.output
    }

    /// The name that messages give to the scene: its path.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text that was read, overrides included.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// Reads a scene from text; `name` stands for the file in messages.
///
/// # Errors
/// Where the scene is not legal, with line and column.
///
/// ```
/// let scene = ancf::scene::parse("arch.toml", r#"
/// [beam.arch]
/// arc = { center = [0.0, 0.0], radius = "2 m", from = "180 deg", to = "0 deg" }
/// axial_stiffness = "8 MN"
/// bending_stiffness = 90.0
/// basis.ancf.elements = 12
///
/// [[support]]
/// beam = "arch"
/// at = "start"
/// fix = ["x", "y", "angle"]
///
/// [analysis.static]
/// "#)?;
/// assert_eq!(scene.model().beams[0].name, "arch");
///
/// let error = ancf::scene::parse("arch.toml", "[beam.arch]\nradius = 3").unwrap_err();
/// assert!(error.to_string().starts_with("arch.toml:2:1: unknown key `radius`"));
/// # Ok::<(), ancf::scene::SceneError>(())
/// ```
pub fn parse(name: &str, text: &str) -> Result<Scene, SceneError> {
    Scene::read(name, text, &[])
}

/// All bytes of a source; none if there are more than `longest`.
fn whole(source: impl Read, longest: u64) -> std::io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    source.take(longest + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= longest).then_some(bytes))
}

/// Reads a positive time such as `"60 s"` or `"2 min"` \[s\].
///
/// # Errors
/// What was found and what is legal, in one sentence.
pub fn seconds(text: &str) -> Result<f64, String> {
    quantity::Quantity::<quantity::Time, quantity::Positive>::parse(text).map(|time| time.si)
}

fn tables(name: &str, text: &str) -> Result<Scene, Fault> {
    let root = DeTable::parse(text).map_err(|error| diagnose::syntax(&error, text))?;
    let file: file::SceneTable =
        reader::read(&root).map_err(|error| diagnose::data(&error, root.get_ref()))?;
    let mut stages = Vec::new();
    for (index, stage) in to_stages::stages(&file)?.into_iter().enumerate() {
        let (model, analysis) = to_model::convert(&stage.scene, index > 0)?;
        let entering = stage.entering(&model);
        let model = Model { numbers: stage.numbers, entering, ..model };
        stages.push(Stage { name: stage.name, model, analysis });
    }
    to_stages::finish(&file, &mut stages)?;
    let (model, analysis) = match stages.first() {
        None => to_model::convert(&file, false)?,
        Some(first) => (first.model.clone(), Analysis::Stages),
    };
    let accuracy = to_analysis::accuracy(file.analysis.as_ref())?;
    let open = Open::of(&model, &analysis, !to_analysis::names_an_integrator(&file));
    let output = Output { states: file.output.states, vtu: file.output.vtu };
    Ok(Scene {
        name: name.to_owned(),
        text: text.to_owned(),
        model,
        analysis,
        stages,
        accuracy,
        open,
        output,
        added: 0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scene through one of its stages has this one and those before it.
    #[test]
    fn a_scene_ends_with_the_stage_that_is_named() {
        let text = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1, basis.ancf.elements = 2 }\n\
                    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
                    stage = [{ name = 'a', analysis.static = {} }, { name = 'b', analysis.static = {} }, { name = 'c', analysis.static = {} }]\n";
        let scene = parse("scene", text).expect("a scene");
        let names = |last: &str| -> Option<Vec<String>> {
            Some(scene.through(last)?.stages().iter().map(|stage| stage.name.clone()).collect())
        };
        for (last, expected) in [("a", &["a"][..]), ("b", &["a", "b"]), ("c", &["a", "b", "c"])] {
            assert_eq!(names(last).expect("a stage"), expected);
        }
        assert_eq!(names("d"), None);
    }

    /// Would catch a file that is cut off without a word.
    #[test]
    fn sources_are_read_whole_or_not_at_all() {
        for (length, whole_one) in [(0, true), (7, true), (8, true), (9, false), (100, false)] {
            let source = vec![b'#'; length];
            let found = whole(&source[..], 8).expect("no source fails");
            assert_eq!(found, whole_one.then_some(source), "{length}");
        }
    }
}
