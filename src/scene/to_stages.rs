//! Stages of a scene → one table of a scene for each, with what takes part in it.

use super::diagnose::choices;
use super::error::Fault;
use super::file::{During, SceneTable, StageTable, Staged};
use super::to_analysis;
use super::value::Located;
use crate::model::{Discretization, Entering, Model, Place, Stage};
use std::cmp::Ordering;

/// Longest name of a stage \[bytes\]: it names a folder.
const LONGEST_NAME: usize = 100;

/// A stage of a scene.
pub(super) struct StageScene {
    pub(super) name: String,
    /// The scene as it is in that stage.
    pub(super) scene: SceneTable,
    /// The numbers of its supports and joints among those of the whole scene.
    pub(super) numbers: [Vec<usize>; 2],
    /// For every table of a support, joint or effect, in their order, whether it comes after the state from which the stage starts. Each
    /// makes one support, joint or part of the model.
    entering: Vec<bool>,
}

impl StageScene {
    /// What is entering, of the `model` that has been made of its scene.
    pub(super) fn entering(&self, model: &Model) -> Entering {
        let mut entering = self.entering.iter();
        let mut next = |count: usize| -> Vec<usize> {
            let list = entering.by_ref().take(count).enumerate();
            list.filter(|(_, enters)| **enters).map(|(i, _)| i).collect()
        };
        Entering {
            supports: next(model.supports.len()),
            joints: next(model.joints.len()),
            parts: next(model.parts.len()),
        }
    }
}

/// The stages, none where the scene has a single analysis.
pub(super) fn stages(file: &SceneTable) -> Result<Vec<StageScene>, Fault> {
    let given = &file.stage;
    if let (Some(first), Some(analysis)) = (given.first(), &file.analysis) {
        return Err(Fault::new(analysis.span(), "a scene with stages has no analysis beside them").help(
            format!(
                "move it into a stage, such as `{}`: every stage has an analysis of its own",
                first.name.get()
            ),
        ));
    }
    for (index, stage) in given.iter().enumerate() {
        check_name(stage, &given[..index])?;
    }
    let position = |name: &Located<String>| {
        given.iter().position(|stage| stage.name.get() == name.get()).ok_or_else(|| unknown(name, given))
    };
    file.durings().into_iter().try_for_each(|during| check(during, &position))?;
    let moves = |stage: &StageTable| stage.analysis.get().dynamic.is_some();
    let first_motion = given.iter().position(moves).unwrap_or(0);
    let scene = |(index, stage): (usize, &StageTable)| {
        let takes_part = |During { stage, until }: During<'_>| {
            let begins = stage.and_then(|name| position(name).ok()).unwrap_or(0);
            let ends = until.and_then(|name| position(name).ok()).unwrap_or(given.len());
            (begins..ends).contains(&index)
        };
        // Vibrations and critical loads leave a state as it was.
        let leaves = |stage: &StageTable| {
            let analysis = stage.analysis.get();
            analysis.modal.is_none() && analysis.buckling.is_none()
        };
        let since = given[..index].iter().rposition(leaves).unwrap_or(0);
        let enters = |During { stage, .. }: During<'_>| {
            stage.and_then(|name| position(name).ok()).is_some_and(|begins| begins > since)
        };
        let numbers = [
            numbers(file.support.iter().map(|table| takes_part(table.during()))),
            numbers(file.joint.iter().map(|table| takes_part(table.during()))),
        ];
        let mut scene = file.clone();
        scene.stage.clear();
        scene.analysis = Some(stage.analysis.clone());
        scene.retain(&takes_part);
        if index != first_motion {
            // A motion that goes on has velocities of its own.
            scene.initial_velocity.clear();
        }
        let entering = scene.durings().into_iter().map(enters).collect();
        StageScene { name: stage.name.get().clone(), scene, numbers, entering }
    };
    Ok(given.iter().enumerate().map(scene).collect())
}

/// The numbers, from 1, of those that take part.
fn numbers(take_part: impl Iterator<Item = bool>) -> Vec<usize> {
    (1..).zip(take_part).filter(|(_, takes_part)| *takes_part).map(|(number, _)| number).collect()
}

/// Refuses stages that leave something open, and makes all of them have the same nodes.
pub(super) fn finish(file: &SceneTable, stages: &mut [Stage]) -> Result<(), Fault> {
    for (stage, Stage { model, .. }) in file.stage.iter().zip(&*stages) {
        let open = model.beams.iter().find(|beam| beam.discretization == Discretization::Open);
        if let Some(beam) = open {
            let name = file.beam.keys().find(|name| name.get() == &beam.name);
            return Err(Fault::new(
                name.map_or(stage.name.span(), Located::span),
                format!("beam `{}` has no basis, which a scene with stages must name", beam.name),
            )
            .help(
                "give `basis.ancf.elements` or `basis.rpim.nodes`: a mesh is chosen for one analysis only",
            ));
        }
        if to_analysis::accuracy(Some(&stage.analysis))?.is_some() {
            return Err(Fault::new(stage.analysis.span(), "the analysis of a stage takes no `accuracy`")
                .help(
                    "name the mesh, and the `tolerance` or `step`: they are chosen for one analysis only",
                ));
        }
    }
    let mut nodes: Vec<Place> = Vec::new();
    for Stage { model, .. } in &*stages {
        for beam in 0..model.beams.len() {
            nodes.extend(model.breaks(beam).into_iter().map(|s| Place { beam, s }));
        }
    }
    nodes.sort_by(|a, b| (a.beam, a.s).partial_cmp(&(b.beam, b.s)).unwrap_or(Ordering::Equal));
    nodes.dedup();
    stages.iter_mut().for_each(|stage| stage.model.nodes_at.clone_from(&nodes));
    Ok(())
}

fn check_name(stage: &StageTable, before: &[StageTable]) -> Result<(), Fault> {
    let name = stage.name.get();
    let legal = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | ' ' | '.' | '+');
    let starts_well = name.starts_with(char::is_alphanumeric);
    let ends_well = name.ends_with(|c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '+'));
    if name.len() > LONGEST_NAME || !starts_well || !ends_well || !name.chars().all(legal) {
        return Err(Fault::new(stage.name.span(), format!("{name:?} cannot name a stage")).help(
            "its folder has the same name: use letters, digits, `-`, `_`, `+`, and `.` or spaces within",
        ));
    }
    // File systems that do not tell capitals from small letters have one folder for both.
    let lower = name.to_lowercase();
    if before.iter().any(|other| other.name.get().to_lowercase() == lower) {
        return Err(Fault::new(stage.name.span(), format!("there are two stages named `{name}`"))
            .help("every stage needs a name of its own, in other letters"));
    }
    Ok(())
}

fn check(
    During { stage, until }: During<'_>,
    position: &dyn Fn(&Located<String>) -> Result<usize, Fault>,
) -> Result<(), Fault> {
    let begins = stage.map(position).transpose()?.unwrap_or(0);
    match until.map(|name| Ok((name, position(name)?))).transpose()? {
        Some((name, ends)) if ends <= begins => Err(Fault::new(
            name.span(),
            format!("this is gone from stage `{}` on, and has not come before", name.get()),
        )
        .help("name a stage after that of `stage`, or leave `until` out: it then stays to the end")),
        _ => Ok(()),
    }
}

fn unknown(name: &Located<String>, given: &[StageTable]) -> Fault {
    let fault = Fault::new(name.span(), format!("there is no stage `{}`", name.get()));
    if given.is_empty() {
        return fault.help(
            "this scene has one analysis; stages are `[[stage]]` with a `name` and an `analysis` each",
        );
    }
    let names: Vec<String> = given.iter().map(|stage| stage.name.get().clone()).collect();
    fault.help(choices("stages of this scene", name.get(), &names))
}
