//! Reads and changes the settings of a scene: accuracy, steps, integrator, mesh.

use toml::{Table, Value};

use super::stages;

/// The value at a path of tables. The `analysis` of a scene with stages is that of the last one.
pub fn get<'t>(scene: &'t Table, path: &[&str]) -> Option<&'t Value> {
    let (first, rest) = path.split_first()?;
    let last = || scene.get("stage").filter(|_| *first == "analysis")?.as_array()?.last()?.get("analysis");
    let value = scene.get(*first).or_else(last)?;
    if rest.is_empty() { Some(value) } else { get(value.as_table()?, rest) }
}

/// The table at a path, made where there is none. The `analysis` of a scene with stages is that of
/// the last one.
pub fn table<'t>(scene: &'t mut Table, path: &[&str]) -> Option<&'t mut Table> {
    let Some((first, rest)) = path.split_first() else { return Some(scene) };
    if *first == "analysis" && scene.contains_key("stage") {
        return table(scene.get_mut("stage")?.as_array_mut()?.last_mut()?.as_table_mut()?, path);
    }
    let below = scene.entry(*first).or_insert_with(|| Table::new().into());
    table(below.as_table_mut()?, rest)
}

/// The analyses of a scene in their order: one, or those of its stages.
pub fn analyses(scene: &Table) -> impl DoubleEndedIterator<Item = &Table> {
    let stages = scene.get("stage").and_then(Value::as_array).into_iter().flatten();
    let one = scene.get("analysis").and_then(Value::as_table);
    one.into_iter().chain(stages.filter_map(|stage| stage.get("analysis")?.as_table()))
}

/// The analyses of a scene, to change them.
pub fn analyses_mut(scene: &mut Table) -> Vec<&mut Table> {
    fn of(stage: &mut Value) -> Option<&mut Table> {
        stage.get_mut("analysis")?.as_table_mut()
    }
    if scene.contains_key("stage") {
        let stages = scene.get_mut("stage").and_then(Value::as_array_mut);
        return stages.into_iter().flatten().filter_map(of).collect();
    }
    scene.get_mut("analysis").and_then(Value::as_table_mut).into_iter().collect()
}

/// The tables of a list.
pub fn items<'t>(scene: &'t Table, path: &[&str]) -> impl Iterator<Item = &'t Table> + use<'t> {
    let list = get(scene, path).and_then(Value::as_array);
    list.into_iter().flatten().filter_map(Value::as_table)
}

/// Whether a motion ends by what no tolerance bounds: a turn that is smaller than the errors of a run is
/// there in one run and not in another, and a speed or a force is reached at another time. Tolerances
/// are those of positions.
pub fn stops_beyond_tolerance(scene: &Table) -> bool {
    let bounded = |event: &Table| event.contains_key("x") || event.contains_key("y");
    items(scene, &["analysis", "dynamic", "event"]).any(|event| event.contains_key("stop") && !bounded(event))
}

/// Whether a path ends by the number of its points, wherever its steps have brought it.
pub fn ends_by_points(scene: &Table) -> bool {
    let path = get(scene, &["analysis", "static", "arc_length"]).and_then(Value::as_table);
    path.is_some_and(|path| !path.contains_key("until_load") && !path.contains_key("until_probe"))
}

/// Whether a beam has shape functions of radial point interpolation.
pub fn is_meshfree(scene: &Table) -> bool {
    let beams = scene.get("beam").and_then(Value::as_table).into_iter().flat_map(Table::values);
    beams.into_iter().any(|beam| beam.get("basis").is_some_and(|basis| basis.get("rpim").is_some()))
}

/// The kind of analysis, as a scene names it.
pub fn analysis(scene: &Table) -> &str {
    get(scene, &["analysis"])
        .and_then(Value::as_table)
        .and_then(|t| t.keys().next())
        .map_or("", String::as_str)
}

/// The settings of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// `radau`, `gauss` or `generalized_alpha`.
    pub integrator: String,
    /// The tolerance, or none and a fixed step.
    pub tolerance: Option<f64>,
    pub step: Option<f64>,
    pub duration: f64,
    pub output_every: f64,
}

/// The settings of a motion, to change them.
pub fn dynamic_mut(analysis: &mut Table) -> Option<&mut Table> {
    analysis.get_mut("dynamic")?.as_table_mut()
}

/// Reads the settings of a motion: of the last one, where there are several.
pub fn motion(scene: &Table) -> Option<Motion> {
    analyses(scene).rev().find_map(|analysis| motion_of(analysis.get("dynamic")?.as_table()?))
}

fn motion_of(dynamic: &Table) -> Option<Motion> {
    let float = |table: &Table, key: &str| table.get(key).and_then(Value::as_float);
    let duration = float(dynamic, "duration")?;
    let output_every = float(dynamic, "output_every").unwrap_or(duration / 200.0);
    let named = ["radau", "gauss", "generalized_alpha"]
        .into_iter()
        .find_map(|name| Some((name, dynamic.get(name)?.as_table()?)));
    Some(match named {
        None => {
            Motion { integrator: "radau".into(), tolerance: Some(1e-6), step: None, duration, output_every }
        }
        Some((name, table)) => Motion {
            integrator: name.to_owned(),
            tolerance: float(table, "tolerance"),
            step: float(table, "step"),
            duration,
            output_every,
        },
    })
}

/// The scene with another integrator of all its motions.
pub fn with_integrator(scene: &Table, name: &str, key: &str, value: f64) -> Table {
    let mut scene = scene.clone();
    for dynamic in analyses_mut(&mut scene).into_iter().filter_map(dynamic_mut) {
        let same = dynamic.remove(name).and_then(|settings| match settings {
            Value::Table(settings) => Some(settings),
            _ => None,
        });
        for other in ["radau", "gauss", "generalized_alpha"] {
            dynamic.remove(other);
        }
        let mut settings = same.unwrap_or_default();
        for other in ["tolerance", "step"] {
            settings.remove(other);
        }
        if key == "tolerance" {
            settings.remove("newton_tolerance");
        }
        settings.insert(key.into(), value.into());
        dynamic.insert(name.into(), settings.into());
    }
    scene
}

/// The scene with nothing chosen but an accuracy; none where there are stages, which name all.
pub fn opened(scene: &Table, accuracy: f64) -> Option<Table> {
    if stages::has(scene) {
        return None;
    }
    let mut scene = scene.clone();
    for (_, beam) in table(&mut scene, &["beam"])?.iter_mut() {
        beam.as_table_mut()?.remove("basis");
    }
    let kind = analysis(&scene).to_owned();
    let analysis = table(&mut scene, &["analysis", &kind])?;
    for key in ["radau", "gauss", "generalized_alpha", "tolerance"] {
        analysis.remove(key);
    }
    analysis.insert("accuracy".into(), accuracy.into());
    Some(scene)
}

/// The largest error that is wanted of a scene that chooses its mesh, or of one that says so.
pub fn accuracy(scene: &Table) -> Option<f64> {
    let wanted = get(scene, &["analysis", analysis(scene), "accuracy"]);
    let position = wanted.and_then(|wanted| wanted.as_float().or_else(|| wanted.get("position")?.as_float()));
    let open = wanted.is_some() || beams(scene).any(|(_, beam)| !beam.contains_key("basis"));
    open.then(|| position.unwrap_or(1e-4))
}

/// The scene with all accuracies that it names times `factor`; none where it names none.
pub fn looser(scene: &Table, factor: f64) -> Option<Table> {
    let mut scene = scene.clone();
    let kind = analysis(&scene).to_owned();
    let loosen = |value: &mut Value| {
        if let Value::Float(accuracy) = value {
            // Relative ones are below 1.
            *accuracy = (*accuracy * factor).min(accuracy.max(0.9));
        }
    };
    match table(&mut scene, &["analysis", &kind])?.get_mut("accuracy")? {
        Value::Table(each) => each.iter_mut().for_each(|(_, value)| loosen(value)),
        one => loosen(one),
    }
    Some(scene)
}

/// The accuracy that is asked for.
pub fn tolerance(scene: &Table) -> f64 {
    if let Some(accuracy) = accuracy(scene) {
        return accuracy;
    }
    analyses(scene).map(tolerance_of).fold(0.0, f64::max)
}

fn tolerance_of(analysis: &Table) -> f64 {
    let dynamic = analysis.get("dynamic").and_then(Value::as_table);
    match dynamic.and_then(|dynamic| Some((dynamic, motion_of(dynamic)?))) {
        // The errors of the iterations of a thousand fixed steps should add up to less.
        Some((dynamic, motion)) => motion.tolerance.unwrap_or_else(|| {
            let given = get(dynamic, &["generalized_alpha", "newton_tolerance"]).and_then(Value::as_float);
            1e-8_f64.max(1e3 * given.unwrap_or(0.0))
        }),
        None => get(analysis, &["static", "tolerance"]).and_then(Value::as_float).unwrap_or(1e-10),
    }
}

/// Every beam's table.
pub fn beams(scene: &Table) -> impl Iterator<Item = (&String, &Table)> {
    let beams = get(scene, &["beam"]).and_then(Value::as_table);
    beams.into_iter().flatten().filter_map(|(name, beam)| Some((name, beam.as_table()?)))
}

/// Cells of a discretisation.
pub fn cells(basis: &Table) -> usize {
    let of = |kind: &Value| {
        let nodes = kind.get("nodes");
        let counted = nodes.and_then(Value::as_integer).map(|n| n - 1);
        let given = nodes.and_then(Value::as_array).map(|list| list.len() as i64 - 1);
        let elements = kind.get("elements").and_then(Value::as_integer);
        usize::try_from(elements.or(counted).or(given).unwrap_or(1)).unwrap_or(1)
    };
    basis.iter().next().map_or(1, |(_, kind)| of(kind))
}

/// Whether a beam can be stretched.
pub fn stretches(beam: &Table) -> bool {
    ["axial_stiffness", "youngs_modulus", "section", "axial_law"].iter().any(|key| beam.contains_key(*key))
}

/// Largest EA L²/EI in natural units. The stiffness of a string counts relative to its loads;
/// inextensible beams do not count.
pub fn stiffness_ratio(scene: &Table) -> f64 {
    let of = |beam: &Table| {
        let most = |key: &str| most(beam.get(key)?);
        let by_law = || slope(get(beam, &["axial_law", "strain"])?, get(beam, &["axial_law", "force"])?);
        let by_material = || Some(most("youngs_modulus")? * most("area")?);
        let by_shape = || Some(stretching(beam.get("section")?.as_table()?, most("youngs_modulus")));
        most("axial_stiffness").or_else(by_material).or_else(by_shape).or_else(by_law).unwrap_or(1.0)
    };
    beams(scene).map(|(_, beam)| of(beam)).fold(1.0, f64::max)
}

/// The largest value of a quantity that may vary along a beam of about the natural length.
fn most(quantity: &Value) -> Option<f64> {
    let numbers = |list: &Value| list.as_array()?.iter().map(Value::as_float).collect::<Option<Vec<f64>>>();
    match quantity {
        Value::Float(value) => Some(*value),
        Value::Table(table) => {
            let (kind, below) = table.iter().next()?;
            if kind == "polynomial" {
                return Some(numbers(below)?.iter().map(|c| c.abs()).sum());
            }
            numbers(below.get("value")?)?.into_iter().reduce(f64::max)
        }
        _ => None,
    }
}

/// EA of a section at its largest.
fn stretching(section: &Table, modulus: Option<f64>) -> f64 {
    let of = |shape: &Value| {
        let side = |key: &str| shape.get(key).and_then(most);
        let modulus = side("youngs_modulus").or(modulus).unwrap_or(1.0);
        // The square about a circle is near enough.
        let area = side("diameter").map(|d| d * d).or_else(|| Some(side("width")? * side("height")?));
        modulus * area.unwrap_or(1.0)
    };
    let shapes = section.iter().flat_map(|(_, shape)| match shape {
        Value::Array(layers) => layers.iter().collect::<Vec<_>>(),
        one => vec![one],
    });
    shapes.map(of).sum()
}

/// The largest slope of a table.
fn slope(x: &Value, y: &Value) -> Option<f64> {
    let numbers = |list: &Value| list.as_array()?.iter().map(Value::as_float).collect::<Option<Vec<f64>>>();
    let (x, y) = (numbers(x)?, numbers(y)?);
    let slopes = x.windows(2).zip(y.windows(2)).map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0]));
    slopes.reduce(f64::max)
}

/// All cells of a scene.
pub fn all_cells(scene: &Table) -> usize {
    beams(scene).filter_map(|(_, beam)| beam.get("basis")?.as_table()).map(cells).sum()
}

/// Cells of the beam that has the fewest.
pub fn fewest_cells(scene: &Table) -> usize {
    beams(scene).filter_map(|(_, beam)| beam.get("basis")?.as_table()).map(cells).min().unwrap_or(0)
}

/// Whether a list of the scene has entries.
pub fn names(scene: &Table, path: &[&str]) -> bool {
    items(scene, path).next().is_some()
}

/// Whether an expression in the time acts.
pub fn has_expression(scene: &Table) -> bool {
    fn within(value: &Value) -> bool {
        match value {
            Value::Table(table) => {
                table.contains_key("expression") || table.iter().any(|(_, below)| within(below))
            }
            Value::Array(items) => items.iter().any(within),
            _ => false,
        }
    }
    ["support", "effect"].iter().any(|key| scene.get(*key).is_some_and(within))
}

/// Whether some contact has friction.
pub fn has_friction(scene: &Table) -> bool {
    items(scene, &["effect", "contact"]).any(|contact| contact.contains_key("friction"))
}

/// Whether a beam begins in another shape than the stress-free one, where no path starts.
pub fn begins_elsewhere(scene: &Table) -> bool {
    beams(scene).any(|(_, beam)| beam.contains_key("initial_shape"))
}

/// Whether an equilibrium contains a string without a load along its whole length: then any of its
/// shapes is one.
pub fn is_slack(scene: &Table) -> bool {
    let stays = |load: &Table| !["stage", "until"].iter().any(|key| load.contains_key(*key));
    let pulled = |beam: &str| {
        items(scene, &["effect", "distributed_force"])
            .filter(|load| load.get("follower").and_then(Value::as_bool) != Some(true) && stays(load))
            .any(|load| load.get("beam").and_then(Value::as_str) == Some(beam))
    };
    let weighs = get(scene, &["effect", "gravity"]).and_then(Value::as_table).is_some_and(stays);
    let rests = analyses(scene).any(|analysis| !analysis.contains_key("dynamic"));
    rests && beams(scene).any(|(name, beam)| !(bends(beam) || weighs || pulled(name)))
}

/// Whether the law of a beam has an interval without resistance, in which any strain or curvature
/// is as good as another.
pub fn gives_way(scene: &Table) -> bool {
    let flat = |beam: &Table, law: &str, value: &str| {
        let values = get(beam, &[law, value]).and_then(Value::as_array);
        values.is_some_and(|values| values.windows(2).any(|pair| pair[0] == pair[1]))
    };
    beams(scene).any(|(_, beam)| flat(beam, "axial_law", "force") || flat(beam, "bending_law", "moment"))
}

/// Changes every beam's `basis`; none where one cannot be.
pub fn map_bases(scene: &Table, change: impl Fn(&Table) -> Option<Table>) -> Option<Table> {
    let mut scene = scene.clone();
    for (_, beam) in table(&mut scene, &["beam"])?.iter_mut() {
        let basis = change(beam.get("basis")?.as_table()?)?;
        beam.as_table_mut()?.insert("basis".into(), basis.into());
    }
    Some(scene)
}

/// Twice the cells.
pub fn finer(scene: &Table) -> Option<Table> {
    map_bases(scene, |basis| {
        let mut basis = basis.clone();
        for (_, kind) in basis.iter_mut() {
            let kind = kind.as_table_mut()?;
            if let Some(Value::Integer(elements)) = kind.get_mut("elements") {
                *elements *= 2;
            }
            match kind.get_mut("nodes") {
                Some(Value::Integer(nodes)) => *nodes = 2 * *nodes - 1,
                Some(Value::Array(list)) => *list = halved(list)?,
                _ => {}
            }
        }
        Some(basis)
    })
}

fn halved(list: &[Value]) -> Option<Vec<Value>> {
    let places = list.iter().map(Value::as_float).collect::<Option<Vec<f64>>>()?;
    let mut all = vec![Value::Float(*places.first()?)];
    for pair in places.windows(2) {
        all.extend([0.5 * (pair[0] + pair[1]), pair[1]].map(Value::Float));
    }
    Some(all)
}

/// The other discretisation, with the same nodes and its default settings.
pub fn other_basis(scene: &Table) -> Option<Table> {
    map_bases(scene, |basis| {
        let (name, kind) = basis.iter().next()?;
        let mut other = Table::new();
        let nodes = match kind.get("nodes") {
            Some(nodes) => nodes.clone(),
            None => (kind.get("elements")?.as_integer()? + 1).into(),
        };
        other.insert("nodes".into(), nodes);
        if let Some(spacing) = kind.get("spacing") {
            other.insert("spacing".into(), spacing.clone());
        }
        let mut basis = Table::new();
        basis.insert(if name == "ancf" { "rpim" } else { "ancf" }.into(), other.into());
        Some(basis)
    })
}

/// Whether a beam resists bending, and is no string.
pub fn bends(beam: &Table) -> bool {
    ["bending_stiffness", "second_moment", "section", "bending_law"].iter().any(|key| beam.contains_key(*key))
}
