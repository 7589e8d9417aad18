//! Scenes with stages: parts of them, and other stages that lead to the same end.

use std::ops::Range;

use fastrand::Rng;
use toml::{Table, Value};

use super::{settings, ways};

/// Whether a scene has stages.
pub fn has(scene: &Table) -> bool {
    scene.contains_key("stage")
}

/// The names of the stages.
fn names(scene: &Table) -> Vec<String> {
    let name = |stage: &Table| stage.get("name").and_then(Value::as_str).map(str::to_owned);
    settings::items(scene, &["stage"]).filter_map(name).collect()
}

/// What a stage computes.
pub fn kinds(scene: &Table) -> Vec<String> {
    settings::analyses(scene).filter_map(|analysis| analysis.keys().next().cloned()).collect()
}

/// Changes the items that may come and go, and drops those of which nothing is left.
fn change_items(scene: &mut Table, change: &dyn Fn(&mut Table) -> bool) {
    let keep = |value: &mut Value| value.as_table_mut().is_none_or(change);
    let list = |value: &mut Value| match value {
        Value::Array(items) => {
            items.retain_mut(keep);
            !items.is_empty()
        }
        one => keep(one),
    };
    for key in ["support", "joint"] {
        if scene.get_mut(key).is_some_and(|value| !list(value)) {
            scene.remove(key);
        }
    }
    if let Some(Value::Table(effects)) = scene.get_mut("effect") {
        effects.retain(|_, value| list(value));
    }
}

/// The stages of a range alone, with what takes part in them; a single one becomes the analysis of
/// the scene.
pub fn part(scene: &Table, range: Range<usize>) -> Option<Table> {
    let names = names(scene);
    let position = |item: &Table, key: &str| {
        let name = item.get(key).and_then(Value::as_str)?;
        names.iter().position(|other| other == name)
    };
    let mut scene = scene.clone();
    change_items(&mut scene, &|item| {
        let begins = position(item, "stage").unwrap_or(0);
        let ends = position(item, "until").unwrap_or(names.len());
        if begins <= range.start {
            item.remove("stage");
        }
        if ends >= range.end {
            item.remove("until");
        }
        begins < range.end && ends > range.start
    });
    let stages = scene.get_mut("stage")?.as_array_mut()?;
    stages.truncate(range.end);
    stages.drain(..range.start);
    if let [only] = stages.as_slice() {
        let analysis = only.get("analysis")?.clone();
        scene.remove("stage");
        scene.insert("analysis".into(), analysis);
    }
    Some(scene)
}

/// The scene as it is in its last stage.
pub fn last(scene: &Table) -> Table {
    let n = names(scene).len();
    n.checked_sub(1).and_then(|last| part(scene, last..n)).unwrap_or_else(|| scene.clone())
}

/// Whether a part of something that goes may still act at the end: it fades with the load factor of
/// the last stage, which a path need not bring to one.
pub fn may_end_fading(scene: &Table) -> bool {
    let Some(name) = names(scene).pop() else { return false };
    let last = settings::analyses(scene).last();
    let path = last.is_some_and(|analysis| settings::get(analysis, &["static", "arc_length"]).is_some());
    let goes = |item: &Table| item.get("until").and_then(Value::as_str) == Some(&name);
    let list = |value: &Value| match value {
        Value::Array(items) => items.iter().filter_map(Value::as_table).any(goes),
        Value::Table(one) => goes(one),
        _ => false,
    };
    let effects = scene.get("effect").and_then(Value::as_table);
    let ties = ["support", "joint"].into_iter().filter_map(|key| scene.get(key));
    path && effects.into_iter().flat_map(Table::values).chain(ties).any(list)
}

/// The scene with what may be left out of its stages: one of them, with what is there only then.
pub fn without(scene: &Table, index: usize) -> Option<Table> {
    let names = names(scene);
    if names.len() < 2 {
        return None;
    }
    let next = names.get(index + 1).cloned();
    let mut scene = scene.clone();
    change_items(&mut scene, &|item| {
        let is = |item: &Table, key: &str| item.get(key).and_then(Value::as_str) == Some(&names[index]);
        let (begins, ends) = (is(item, "stage"), is(item, "until"));
        match &next {
            Some(next) if begins => drop(item.insert("stage".into(), next.clone().into())),
            None if begins => return false,
            _ => {}
        }
        match &next {
            Some(next) if ends => drop(item.insert("until".into(), next.clone().into())),
            None if ends => drop(item.remove("until")),
            _ => {}
        }
        // What comes and goes with the stage that has gone.
        item.get("stage").is_none() || item.get("stage") != item.get("until")
    });
    scene.get_mut("stage")?.as_array_mut()?.remove(index);
    part(&scene, 0..names.len() - 1)
}

fn stage(name: &str, analysis: Value) -> Value {
    let mut stage = Table::new();
    stage.insert("name".into(), name.into());
    stage.insert("analysis".into(), analysis);
    stage.into()
}

/// A static stage in which nothing changes.
fn idle(name: &str) -> Value {
    let mut analysis = Table::new();
    analysis.insert("static".into(), Table::new().into());
    stage(name, analysis.into())
}

/// The same with one stage in two: a motion in two parts, and statics or another analysis with a
/// stage behind it, or before, in which nothing changes. A scene without stages becomes one with
/// them.
pub fn split(scene: &Table, rng: &mut Rng) -> Option<Table> {
    if settings::accuracy(scene).is_some() {
        return None;
    }
    let mut scene = scene.clone();
    if !has(&scene) {
        let analysis = scene.remove("analysis")?;
        scene.insert("stage".into(), Value::Array(vec![stage("whole", analysis)]));
    }
    let kinds = kinds(&scene);
    let index = rng.usize(0..kinds.len());
    let stages = scene.get("stage")?.as_array()?.clone();
    let (before, at) = stages.split_at(index);
    let at = &at[0];
    let name = at.get("name")?.as_str()?.to_owned();
    let other = "more";
    let [first, second] = match &kinds[index][..] {
        "dynamic" => {
            let mut alone = Table::new();
            alone.insert("analysis".into(), at.get("analysis")?.clone());
            let [a, b] = ways::parts(&alone, rng)?;
            [stage(&name, a.get("analysis")?.clone()), stage(other, b.get("analysis")?.clone())]
        }
        // A path may end at another load than the full one, with which the next stage begins.
        "static" if at.get("analysis")?.get("static")?.get("arc_length").is_some() => return None,
        "static" => [at.clone(), idle(other)],
        // Frequencies leave the state as it is.
        "modal" if index > 0 => [at.clone(), stage(other, at.get("analysis")?.clone())],
        _ => return Some(scene),
    };
    let mut all = before.to_vec();
    all.extend([first, second]);
    all.extend_from_slice(&stages[index + 1..]);
    scene.insert("stage".into(), Value::Array(all));
    Some(scene)
}

/// The static stages at the beginning in a single one, if their order does not matter.
pub fn at_once(scene: &Table) -> Option<Table> {
    let kinds = kinds(scene);
    let analyses: Vec<&Table> = settings::analyses(scene).collect();
    let names = names(scene);
    // The last of the static stages that are first, or that only frequencies part.
    let quiet = |kind: &String| matches!(&kind[..], "static" | "modal");
    let leading = kinds.iter().take_while(|kind| quiet(kind)).count();
    let last = (0..leading).rev().find(|i| kinds[*i] == "static").filter(|last| *last > 0)?;
    let path = |analysis: &&Table| settings::get(analysis, &["static", "arc_length"]).is_some();
    if analyses[..=last].iter().any(path) || settings::has_friction(scene) {
        return None;
    }
    let position = |item: &Table, key: &str| {
        let name = item.get(key).and_then(Value::as_str)?;
        names.iter().position(|other| other == name)
    };
    // A support that comes later holds the beam where it is then.
    let later = |item: &Table| position(item, "stage").is_some_and(|begins| (1..=last).contains(&begins));
    let stays = |item: &Table| position(item, "until").is_none_or(|ends| ends > last);
    if settings::items(scene, &["support"]).any(|support| later(support) && stays(support)) {
        return None;
    }
    // All stages have a node wherever one of them has something at a point.
    let at_a_node = |item: &Table| item.get("at").is_some_and(Value::is_float);
    let effects = scene.get("effect").and_then(Value::as_table).into_iter().flat_map(Table::values);
    let lists = effects.chain(scene.get("support")).filter_map(Value::as_array).flatten();
    if lists.filter_map(Value::as_table).any(|item| at_a_node(item) && !stays(item)) {
        return None;
    }
    part(scene, last..names.len())
}

/// The first stages, and the others, which go on from the state that they leave.
pub fn two_files(scene: &Table, rng: &mut Rng) -> Option<[Table; 2]> {
    let kinds = kinds(scene);
    let leaves = |i: &usize| matches!(&kinds[i - 1][..], "static" | "dynamic");
    let places: Vec<usize> = (1..kinds.len()).filter(leaves).collect();
    let at = *places.get(rng.usize(0..places.len().max(1)))?;
    let mut rest = part(scene, at..kinds.len())?;
    // Frequencies after a stage are those about an equilibrium.
    for modal in
        settings::analyses_mut(&mut rest).into_iter().filter_map(|analysis| analysis.get_mut("modal"))
    {
        modal.as_table_mut()?.insert("about".into(), "equilibrium".into());
    }
    if kinds[..at].iter().any(|kind| kind == "dynamic") {
        rest.remove("initial_velocity");
    }
    Some([part(scene, 0..at)?, rest])
}

/// Whether between two of its files something comes or goes within a meshfree beam: shape functions end at what holds or turns a point
/// there, in all stages of one file, and in one of two files only.
pub fn ends_shape_functions(first: &Table, rest: &Table) -> bool {
    let inside = |at: Option<&Value>| at.is_some_and(|at| at.is_float() || at.is_integer());
    let acts_inside = |item: &Table| {
        let sides = ["first", "second"].into_iter().filter_map(|side| item.get(side)?.as_table()?.get("at"));
        inside(item.get("at")) || sides.map(Some).any(inside)
    };
    let within = |scene: &Table| -> Vec<String> {
        let effects = scene.get("effect").and_then(Value::as_table).into_iter().flat_map(Table::values);
        let lists = [scene.get("support"), scene.get("joint")].into_iter().flatten().chain(effects);
        let items = lists.filter_map(Value::as_array).flatten().filter_map(Value::as_table);
        items.filter(|item| acts_inside(item)).map(Table::to_string).collect()
    };
    settings::is_meshfree(first) && within(first) != within(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Table {
        let text =
            "stage = [{ name = 'one', analysis.static = {} }, { name = 'two', analysis.modal.count = 1 }, \
             { name = 'three', analysis.dynamic.duration = 1.0 }]
            support = [{ beam = 'a', until = 'three' }, { beam = 'b', stage = 'two' }, { beam = 'c' }]
            effect.force = [{ at = 1.0, until = 'two' }, { at = 2.0, stage = 'two', until = 'three' }]
            effect.gravity = { acceleration = [0.0, 1.0], stage = 'three' }";
        text.parse().unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn what_goes_within_a_meshfree_beam_ends_shape_functions() {
        let of = |basis: &str, supports: &str| -> Table {
            let text = format!("beam.a.basis.{basis} = 9\nsupport = [{supports}]");
            text.parse().unwrap_or_else(|error| panic!("{error}"))
        };
        let (end, inside) = ("{ beam = 'a', at = 'start' }", "{ beam = 'a', at = 0.3 }");
        let both = format!("{end}, {inside}");
        assert!(ends_shape_functions(&of("rpim.nodes", &both), &of("rpim.nodes", end)));
        assert!(!ends_shape_functions(&of("rpim.nodes", &both), &of("rpim.nodes", inside)));
        assert!(!ends_shape_functions(&of("ancf.nodes", &both), &of("ancf.nodes", end)));
    }

    #[test]
    fn parts_have_what_takes_part_in_them() {
        let first = part(&scene(), 0..1).expect("a part");
        assert_eq!(settings::analysis(&first), "static");
        assert_eq!(
            first.get("support").map(Value::to_string).as_deref(),
            Some("[{ beam = \"a\" }, { beam = \"c\" }]")
        );
        assert_eq!(first.get("effect").map(Value::to_string).as_deref(), Some("{ force = [{ at = 1.0 }] }"));
        let rest = part(&scene(), 1..3).expect("a part");
        assert_eq!(kinds(&rest), ["modal", "dynamic"]);
        assert_eq!(
            rest.get("support").map(Value::to_string).as_deref(),
            Some("[{ beam = \"a\", until = \"three\" }, { beam = \"b\" }, { beam = \"c\" }]")
        );
        assert_eq!(settings::items(&rest, &["effect", "force"]).count(), 1);
        assert!(settings::get(&last(&scene()), &["effect", "force"]).is_none());
    }

    #[test]
    fn what_fades_along_a_path_may_still_act_at_its_end() {
        let text = |analysis: &str, until: &str| {
            let scene = format!(
                "stage = [{{ name = 'one', analysis.static = {{}} }}, {{ name = 'two', analysis.static = {analysis} }}]
                effect.gravity = {{ acceleration = [0.0, 1.0]{until} }}"
            );
            scene.parse().unwrap_or_else(|error| panic!("{error}"))
        };
        let path = "{ arc_length.until_load = 0.4 }";
        assert!(may_end_fading(&text(path, ", until = 'two'")));
        assert!(!may_end_fading(&text("{}", ", until = 'two'")));
        assert!(!may_end_fading(&text(path, "")));
    }

    #[test]
    fn what_belongs_to_a_stage_goes_with_it() {
        let shorter = without(&scene(), 1).expect("two stages");
        assert_eq!(kinds(&shorter), ["static", "dynamic"]);
        let names = |key: &str| -> Vec<Option<String>> {
            settings::items(&shorter, &["support"]).map(|s| s.get(key)?.as_str().map(str::to_owned)).collect()
        };
        assert_eq!(names("stage"), [None, Some("three".into()), None]);
        assert_eq!(names("until"), [Some("three".into()), None, None]);
        assert_eq!(settings::items(&shorter, &["effect", "force"]).count(), 1);
        assert_eq!(kinds(&without(&shorter, 1).expect("one stage")), ["static"]);
    }
}
