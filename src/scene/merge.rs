//! Replaces tables of a scene by those of another text.

use toml_edit::{DocumentMut, Item, TableLike};

use super::Scene;
use super::error::{Fault, SceneError};

/// Kinds of which an analysis of motion has at most one.
const INTEGRATORS: [&str; 3] = ["generalized_alpha", "gauss", "radau"];

impl Scene {
    /// This scene with the keys of `lines`, a TOML text, in place of its own: a `basis` replaces
    /// the whole basis of its beam, and an integrator the integrator; other keys are set one by
    /// one. Comments elsewhere stay.
    ///
    /// # Errors
    /// Where `lines` are not TOML, or the result is not a legal scene.
    pub fn merged(&self, lines: &str) -> Result<Self, SceneError> {
        Self::read(&self.name, &with_lines((&self.name, &self.text), lines)?.to_string(), &[])
    }

    /// The text of this scene with `lines` merged and without the accuracy for which they were
    /// chosen: what is solved as it stands. Parts that were [added](Self::add) are not in it, and
    /// its first line says so.
    ///
    /// # Errors
    /// Where `lines` are not TOML.
    pub fn chosen(&self, lines: &str) -> Result<String, SceneError> {
        chosen((&self.name, &self.text), self.added, lines)
    }

    /// [`Self::chosen`] for later, when the scene may be gone; where there is no such text, lines of it
    /// say why.
    pub(crate) fn chosen_later(&self, lines: String) -> impl FnOnce() -> String + Send + Sync + use<> {
        let (name, text, added) = (self.name.clone(), self.text.clone(), self.added);
        move || {
            chosen((&name, &text), added, &lines).unwrap_or_else(|error| {
                format!("# These lines cannot be merged into the scene: {}\n{lines}", error.brief())
            })
        }
    }

    /// This scene with everything left open that an accuracy chooses, and with this accuracy: no
    /// beam has a basis, no motion an integrator, no equilibrium a tolerance.
    ///
    /// # Errors
    /// Where the result is not a legal scene.
    pub fn opened(&self, accuracy: f64) -> Result<Self, SceneError> {
        let mut scene = document(&self.name, &self.text)?;
        each(&mut scene, "beam", |beam| drop(beam.remove("basis")));
        each(&mut scene, "analysis", |analysis| {
            for key in INTEGRATORS.iter().chain(&["tolerance"]) {
                analysis.remove(key);
            }
            analysis.insert("accuracy", toml_edit::value(accuracy));
        });
        Self::read(&self.name, &scene.to_string(), &[])
    }
}

/// The text of a scene of this name with `lines` merged and without an accuracy.
fn chosen(scene: (&str, &str), added: usize, lines: &str) -> Result<String, SceneError> {
    let mut scene = with_lines(scene, lines)?;
    each(&mut scene, "analysis", |analysis| drop(analysis.remove("accuracy")));
    let text = scene.to_string();
    match added {
        0 => Ok(text),
        parts => Ok(format!("# Without what was added to the scene by code: {parts} of its parts.\n{text}")),
    }
}

fn with_lines((name, text): (&str, &str), lines: &str) -> Result<DocumentMut, SceneError> {
    let lines = document("lines to merge", lines)?;
    let mut scene = document(name, text)?;
    merge(scene.as_table_mut(), lines.as_table(), &mut Vec::new());
    Ok(scene)
}

fn document(name: &str, text: &str) -> Result<DocumentMut, SceneError> {
    text.parse::<DocumentMut>()
        .map_err(|error| Fault::new(error.span().unwrap_or(0..0), error.message()).at(name, text))
}

/// Changes each of the tables in the table `key` of a scene.
fn each(scene: &mut DocumentMut, key: &str, edit: impl Fn(&mut dyn TableLike)) {
    let tables = scene.get_mut(key).and_then(Item::as_table_like_mut);
    for (_, item) in tables.into_iter().flat_map(TableLike::iter_mut) {
        if let Some(table) = item.as_table_like_mut() {
            edit(table);
        }
        // A dotted table without keys would not be written.
        if let Item::Table(table) = item {
            table.set_dotted(false);
            table.set_implicit(false);
        }
    }
}

fn merge(into: &mut dyn TableLike, from: &dyn TableLike, path: &mut Vec<String>) {
    for (key, item) in from.iter() {
        path.push(key.to_owned());
        let path_now: Vec<&str> = path.iter().map(String::as_str).collect();
        let whole = match path_now.as_slice() {
            ["beam", _, "basis"] => true,
            ["analysis", "dynamic", key] if INTEGRATORS.contains(key) => {
                for integrator in INTEGRATORS {
                    into.remove(integrator);
                }
                true
            }
            _ => false,
        };
        let old = into.get_mut(key).and_then(Item::as_table_like_mut).filter(|_| !whole);
        match (old, item.as_table_like()) {
            (Some(old), Some(new)) => merge(old, new, path),
            _ => {
                let mut item = item.clone();
                unplace(&mut item);
                into.remove(key);
                into.insert(key, item);
            }
        }
        path.pop();
    }
}

/// A table is written where its parent is, not where it was in another text.
fn unplace(item: &mut Item) {
    if let Item::Table(table) = item {
        table.set_position(None);
        table.iter_mut().for_each(|(_, item)| unplace(item));
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse;

    const LINES: &str = "[beam.arm.basis.rpim]\nnodes = 9\n\n[analysis.dynamic.radau]\ntolerance = 1e-4\n";

    fn scene(beam: &str, dynamic: &str) -> String {
        format!(
            "{beam}\n[effect.gravity]\nacceleration = [0, -9.81] # down\n[[support]]\nbeam = \"arm\"\nat = \"start\"\n\
             fix = [\"x\", \"y\"]\n{dynamic}"
        )
    }

    #[test]
    fn tables_are_replaced_however_they_are_written() {
        let section =
            "axial_stiffness = 1e4\nbending_stiffness = 1\nmass_per_length = 1\nstart = [0, 0]\nend = [1, 0]";
        let beams = [
            format!("[beam.arm]\n{section}\nbasis.ancf.elements = 4"),
            format!("[beam.arm]\n{section}\n[beam.arm.basis.ancf]\nelements = 4"),
            format!("[beam.arm]\n{section}\n[beam.arm.basis]\nrpim = {{ nodes = 5, neighbours = 3 }}"),
            format!("[beam]\narm = {{ {}, basis.ancf.elements = 4 }}", section.replace('\n', ", ")),
        ];
        let motions = [
            "[analysis.dynamic]\nduration = 1\n",
            "[analysis.dynamic]\nduration = 1\ngauss = { step = 0.01 }\n",
            "[analysis.dynamic]\nduration = 1\n[analysis.dynamic.generalized_alpha]\nstep = 0.01\n",
            "[analysis]\ndynamic = { duration = 1, radau.stages = 2, radau.step = 0.1 }\n",
        ];
        let expected = parse("expected", &scene(&beams[0], motions[0])).unwrap();
        let expected = expected
            .with(&[
                "beam.arm.basis={ rpim = { nodes = 9 } }".to_owned(),
                "analysis.dynamic.radau.tolerance=1e-4".to_owned(),
            ])
            .unwrap();
        for beam in &beams {
            for motion in motions {
                let scene = parse("scene", &scene(beam, motion)).unwrap();
                let merged = scene.merged(LINES).unwrap();
                assert_eq!(merged.model(), expected.model(), "{}", merged.text());
                assert_eq!(merged.analysis(), expected.analysis(), "{}", merged.text());
                assert!(merged.text().contains("# down"), "{}", merged.text());
            }
        }
    }

    #[test]
    fn what_an_accuracy_chooses_is_left_open() {
        let section =
            "axial_stiffness = 1e4\nbending_stiffness = 1\nmass_per_length = 1\nstart = [0, 0]\nend = [1, 0]";
        let beams = [
            format!("[beam.arm]\n{section}\nbasis.ancf.elements = 4"),
            format!("[beam.arm]\n{section}\n[beam.arm.basis.rpim]\nnodes = 5"),
            format!("[beam]\narm = {{ {}, basis.ancf.elements = 4 }}", section.replace('\n', ", ")),
        ];
        let analyses = [
            (
                "[analysis.dynamic]\nduration = 1\n[analysis.dynamic.gauss]\nstep = 0.01\n",
                "analysis.dynamic.duration = 1\nanalysis.dynamic.accuracy = 1e-3",
            ),
            (
                "analysis.dynamic = { duration = 1, radau.step = 0.1, accuracy = 0.5 }",
                "analysis.dynamic = { duration = 1, accuracy = 1e-3 }",
            ),
            (
                "[analysis.static]\nsteps = 3\ntolerance = 1e-9",
                "[analysis.static]\nsteps = 3\naccuracy = 1e-3",
            ),
            ("analysis.static.tolerance = 1e-9", "analysis.static.accuracy = 1e-3"),
            ("[analysis]\nmodal.count = 3", "[analysis]\nmodal = { count = 3, accuracy = 1e-3 }"),
        ];
        for beam in &beams {
            for (before, after) in analyses {
                // Keys before the first table belong to the scene itself.
                let text = |analysis: &str, beam: &str| format!("{analysis}\n{}", scene(beam, ""));
                let opened = parse("scene", &text(before, beam)).unwrap().opened(1e-3).unwrap();
                let open = format!("[beam.arm]\n{section}");
                let expected = parse("expected", &text(after, &open)).unwrap();
                assert_eq!(opened.model(), expected.model(), "{}", opened.text());
                assert_eq!(opened.analysis(), expected.analysis(), "{}", opened.text());
                assert_eq!(opened.open(), expected.open(), "{}", opened.text());
                assert_eq!(opened.accuracy(), expected.accuracy(), "{}", opened.text());
            }
        }
    }

    #[test]
    fn what_is_no_scene_is_refused() {
        let scene = parse("scene", &scene("[beam.arm]\nstart = [0, 0]\nend = [1, 0]\naxial_stiffness = 1\nbending_stiffness = 1\nmass_per_length = 1\nbasis.ancf.elements = 4", "[analysis.dynamic]\nduration = 1\n")).unwrap();
        assert!(scene.merged("[beam.arm.basis.rpim]\nnodes = 1\n").is_err());
        assert!(scene.merged("[beam").is_err());
    }
}
