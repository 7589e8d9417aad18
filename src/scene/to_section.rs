//! Stiffnesses, masses and the shape of a beam's section → [`Section`].

use std::f64::consts::PI;
use std::ops::Range;
use std::sync::Arc;

use crate::model::{Along, Elastic, Layer, NotElastic, Section};

use super::error::Fault;
use super::file::{AxialLawTable, BeamTable, BendingLawTable, LayerTable, SectionTable};
use super::quantity::{Measure, Quantity};
use super::to_along::along;
use super::value::Located;

/// Places between kinks at which a tube's bore is looked at.
const PLACES: usize = 256;
/// The smallest and the largest stiffness or mass with which the solver can count.
const USABLE: [f64; 2] = [1e-300, 1e300];

/// What the shape of a section tells without its material.
struct Shape {
    area: Along,
    second_moment: Along,
    /// Offset of its left face.
    half_height: Along,
}

/// A quantity and the text that gave it.
type Given = Option<(Along, Range<usize>)>;

/// The section of the beam `label`, which is `length` \[m\] long.
pub(super) fn section(label: &str, table: &BeamTable, length: f64) -> Result<Section, Fault> {
    let mut section = linear_section(label, table, length)?;
    if let Some(law) = &table.axial_law {
        let AxialLawTable { strain, force } = law.get();
        let law = elastic(label, law, ("axial_law", "strain", "force"), (strain, force))?;
        refuse_beside(label, table, "axial_law", ("axial_stiffness", &section.axial_stiffness))?;
        section.axial_stiffness = Some(Along::Constant(law.stiffness()));
        section.axial_law = Some(Arc::new(law));
    }
    if let Some(law) = &table.bending_law {
        let BendingLawTable { curvature, moment } = law.get();
        let law = elastic(label, law, ("bending_law", "curvature", "moment"), (curvature, moment))?;
        refuse_beside(label, table, "bending_law", ("bending_stiffness", &section.bending_stiffness))?;
        section.bending_stiffness = Some(Along::Constant(law.stiffness()));
        section.bending_law = Some(Arc::new(law));
    }
    Ok(section)
}

/// Refuses a law beside a stiffness, or beside sections whose shape asks for one.
fn refuse_beside(
    label: &str,
    table: &BeamTable,
    law: &str,
    (key, stiffness): (&str, &Option<Along>),
) -> Result<(), Fault> {
    let span = match law {
        "axial_law" => table.axial_law.as_ref().map(Located::span),
        _ => table.bending_law.as_ref().map(Located::span),
    };
    let span = span.unwrap_or(0..0);
    if stiffness.is_some() {
        return Err(twice(label, law, &format!("by `{key}`, or what it follows from"), span));
    }
    if table.section.is_some() {
        return Err(Fault::new(span, format!("beam `{label}` has `{law}` and a `section`, whose stresses are linear"))
            .help("give `mass_per_length` and, where it matters, `half_thickness` of contacts in place of `section`"));
    }
    Ok(())
}

/// Coordinates of the points of a table.
type Points<'a, M> = &'a [Located<Quantity<M>>];

/// The elastic law of a table with the keys `strain` and `force`.
fn elastic<T, A: Measure, B: Measure>(
    label: &str,
    table: &Located<T>,
    (law, strain, force): (&str, &str, &str),
    (strains, forces): (Points<'_, A>, Points<'_, B>),
) -> Result<Elastic, Fault> {
    let of_strains: Vec<f64> = strains.iter().map(|value| value.get().si).collect();
    let of_forces: Vec<f64> = forces.iter().map(|value| value.get().si).collect();
    let fault = |span: Range<usize>, what: String| {
        Fault::new(span, format!("`{law}` of beam `{label}`: {what}")).help(format!(
            "such as `{law} = {{ {strain} = [-0.01, 0.0, 0.02], {force} = [0.0, 0.0, 800.0] }}`: rising, without falling {force}s, zero at zero"
        ))
    };
    Elastic::new(of_strains.clone(), of_forces.clone()).map_err(|reason| match reason {
        NotElastic::Lengths => fault(
            table.span(),
            format!(
                "it needs two points or more, and found {} of `{strain}` and {} of `{force}`",
                of_strains.len(),
                of_forces.len()
            ),
        ),
        NotElastic::Strain(i) => fault(
            strains[i].span(),
            format!("{} is not larger than the {strain} before it, {}", of_strains[i], of_strains[i - 1]),
        ),
        NotElastic::Force(i) => fault(
            forces[i].span(),
            format!(
                "{} is smaller than the {force} before it, {}: what softens so has no energy to hold it",
                of_forces[i],
                of_forces[i - 1]
            ),
        ),
        NotElastic::AtZero(at_zero) => fault(
            table.span(),
            format!("the {force} is {at_zero} where the {strain} is zero, and must be zero there"),
        ),
        NotElastic::Flat => {
            fault(table.span(), format!("the {force} is the same everywhere, and resists nothing"))
        }
    })
}

fn linear_section(label: &str, table: &BeamTable, length: f64) -> Result<Section, Fault> {
    if let Some(section) = &table.section
        && let Some(layers) = &section.get().layers
    {
        only(section)?;
        return of_layers(label, table, layers, length);
    }
    let shape = table.section.as_ref().map(|section| shape(section, length)).transpose()?;
    macro_rules! given {
        ($key:ident) => {
            match &table.$key {
                None => None,
                Some(value) => Some((along(value, stringify!($key), length)?, value.span())),
            }
        };
    }
    let e: Given = given!(youngs_modulus);
    let density: Given = given!(density);
    let (mut area, mut second_moment): (Given, Given) = (given!(area), given!(second_moment));
    if let (Some(shape), Some(section)) = (&shape, &table.section) {
        for (key, given) in [("area", &area), ("second_moment", &second_moment)] {
            if let Some((_, span)) = given {
                return Err(twice(label, key, "by the shape of its `section`", span.clone()));
            }
        }
        area = Some((shape.area.clone(), section.span()));
        second_moment = Some((shape.second_moment.clone(), section.span()));
    }
    let (ea, ei, mass): (Given, Given, Given) =
        (given!(axial_stiffness), given!(bending_stiffness), given!(mass_per_length));
    if let (Some((_, span)), None, None) = (&e, &area, &ea) {
        // A beam without axial stiffness keeps its length, but with an elastic modulus its area was
        // forgotten.
        let message = format!("beam `{label}` has a `youngs_modulus` but no `area`: is it to stretch?");
        return Err(Fault::new(span.clone(), message).help(
            "give `area`, `section` or `axial_stiffness`; or, for a beam that keeps its length, `bending_stiffness` in \
             place of `youngs_modulus` and `second_moment`",
        ));
    }
    let either = |direct: Given, key: &str, a: (&Given, &str), b: (&Given, &str)| {
        let product = match (a.0, b.0) {
            (Some((a, span)), Some((b, _))) => Some((a.product(b), span.clone())),
            _ => None,
        };
        match (direct, product) {
            (Some((_, span)), Some(_)) => {
                let other = if table.section.is_some() {
                    format!("by `{}` and the shape of its `section`", a.1)
                } else {
                    format!("as `{}` times `{}`", a.1, b.1)
                };
                Err(twice(label, key, &other, span))
            }
            (direct, product) => {
                direct.or(product).map(|given| usable(label, key, given, length)).transpose()
            }
        }
    };
    let layers = shape.map(|shape| Layer {
        youngs_modulus: e.as_ref().map(|(modulus, _)| modulus.clone()),
        bottom: shape.half_height.times(-1.0),
        top: shape.half_height,
        stiffness: None,
    });
    if e.is_none() {
        modulus_is_not_missed(label, table)?;
    }
    let (with_modulus, with_density) = ((&e, "youngs_modulus"), (&density, "density"));
    Ok(Section {
        axial_stiffness: either(ea, "axial_stiffness", with_modulus, (&area, "area"))?,
        bending_stiffness: either(ei, "bending_stiffness", with_modulus, (&second_moment, "second_moment"))?,
        coupling: None,
        mass_per_length: either(mass, "mass_per_length", with_density, (&area, "area"))?,
        rotary_inertia: density.zip(second_moment).map(|((a, _), (b, _))| a.product(&b)),
        layers: layers.into_iter().collect(),
        ..Section::default()
    })
}

/// Refuses a beam without elastic modulus that has a second moment or the shape of a section and no other bending stiffness, or an area and no
/// stiffness at all. It would be a string, perhaps one that keeps its length: more likely the modulus was forgotten.
fn modulus_is_not_missed(label: &str, table: &BeamTable) -> Result<(), Fault> {
    let stretches = table.axial_stiffness.is_some() || table.axial_law.is_some();
    let bends = table.bending_stiffness.is_some() || table.bending_law.is_some();
    let second_moment = table.second_moment.as_ref().map(|given| ("a `second_moment`", given.span()));
    let shape = table.section.as_ref().map(|given| ("a `section`", given.span()));
    let area = table.area.as_ref().map(|given| ("an `area`", given.span()));
    let missed = match (bends, stretches) {
        (true, _) => None,
        (false, true) => second_moment.or(shape),
        (false, false) => second_moment.or(shape).or(area),
    };
    let Some((what, span)) = missed else { return Ok(()) };
    let (key, other) =
        if stretches { ("bend", "`bending_stiffness`") } else { ("stretch or bend", "stiffnesses") };
    let message = format!("beam `{label}` has {what} but no `youngs_modulus`: is it to {key}?");
    Err(Fault::new(span, message).help(format!(
        "give `youngs_modulus`, or {other} of its own; or, for a string that resists nothing but a change of its length, `mass_per_length` in place of \
         all that tells of its section"
    )))
}

fn twice(label: &str, key: &str, other: &str, span: Range<usize>) -> Fault {
    Fault::new(span, format!("beam `{label}` has `{key}` twice: by itself, and {other}"))
        .help(format!("keep `{key}`, or the other"))
}

/// Refuses stiffnesses and masses that are too small or too large to count with.
fn usable(label: &str, key: &str, (along, span): (Along, Range<usize>), length: f64) -> Result<Along, Fault> {
    let usable = USABLE[0]..=USABLE[1];
    let bad = places(&along, length).map(|(_, value)| value).find(|value| !usable.contains(value));
    match bad {
        None => Ok(along),
        Some(value) => Err(Fault::new(span, format!("beam `{label}`: {key} = {value} is no usable number"))
            .help("it must be a positive number between 1e-300 and 1e300")),
    }
}

/// Refuses a section of more than one kind, or of none.
fn only(section: &Located<SectionTable>) -> Result<(), Fault> {
    let SectionTable { rectangle, circle, tube, layers } = section.get();
    let kinds = [rectangle.is_some(), circle.is_some(), tube.is_some(), layers.is_some()];
    let problem = match kinds.into_iter().filter(|given| *given).count() {
        1 => return Ok(()),
        0 => "an empty `section`",
        _ => "more than one shape in `section`",
    };
    Err(Fault::new(section.span(), problem).help(
        "give one of `rectangle = { width = \"40 mm\", height = \"8 mm\" }`, `circle = { diameter = \"6 mm\" }`, `tube = { diameter = \
         \"6 mm\", wall = \"1 mm\" }`, `layers = [{ youngs_modulus = \"12 GPa\", width = \"40 mm\", height = \"8 mm\" }]`",
    ))
}

fn shape(section: &Located<SectionTable>, length: f64) -> Result<Shape, Fault> {
    only(section)?;
    let power = |along: &Along, n: usize| (1..n).fold(along.clone(), |product, _| product.product(along));
    let SectionTable { rectangle, circle, tube, .. } = section.get();
    if let Some(rectangle) = rectangle {
        let width = along(&rectangle.get().width, "width", length)?;
        let height = along(&rectangle.get().height, "height", length)?;
        return Ok(Shape {
            area: width.product(&height),
            second_moment: width.product(&power(&height, 3)).times(1.0 / 12.0),
            half_height: height.times(0.5),
        });
    }
    let disc = |diameter: &Along| [power(diameter, 2).times(PI / 4.0), power(diameter, 4).times(PI / 64.0)];
    if let Some(circle) = circle {
        let diameter = along(&circle.get().diameter, "diameter", length)?;
        let [area, second_moment] = disc(&diameter);
        return Ok(Shape { area, second_moment, half_height: diameter.times(0.5) });
    }
    let Some(tube) = tube else { return Err(Fault::new(section.span(), "an empty `section`")) };
    let diameter = along(&tube.get().diameter, "diameter", length)?;
    let wall = along(&tube.get().wall, "wall", length)?;
    let bore = diameter.plus(&wall.times(-2.0));
    if let Some((s, bore)) = places(&bore, length).find(|(_, bore)| *bore < 0.0) {
        return Err(Fault::new(
            tube.get().wall.span(),
            format!("`wall`: at s = {s} m the walls of the tube overlap by {} m", -bore),
        )
        .help("a wall is at most half as thick as the tube's diameter; a solid rod is a `circle`"));
    }
    let ([outer, outer_moment], [inner, inner_moment]) = (disc(&diameter), disc(&bore));
    Ok(Shape {
        area: outer.plus(&inner.times(-1.0)),
        second_moment: outer_moment.plus(&inner_moment.times(-1.0)),
        half_height: diameter.times(0.5),
    })
}

/// Arc lengths, and values of a quantity on both sides of each.
fn places(along: &Along, length: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
    let mut ends: Vec<f64> = along.kinks().into_iter().filter(|s| *s > 0.0 && *s < length).collect();
    ends.extend([0.0, length]);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let pieces: Vec<[f64; 2]> = ends.windows(2).map(|ends| [ends[0], ends[1]]).collect();
    pieces.into_iter().flat_map(move |[from, to]| {
        (0..=PLACES).map(move |i| {
            let s = from + (to - from) * i as f64 / PLACES as f64;
            (s, along.at(s, 0.5 * (from + to)))
        })
    })
}

fn of_layers(
    label: &str,
    table: &BeamTable,
    layers: &Located<Vec<Located<LayerTable>>>,
    length: f64,
) -> Result<Section, Fault> {
    let others = [
        ("youngs_modulus", table.youngs_modulus.as_ref().map(Located::span)),
        ("density", table.density.as_ref().map(Located::span)),
        ("area", table.area.as_ref().map(Located::span)),
        ("second_moment", table.second_moment.as_ref().map(Located::span)),
        ("axial_stiffness", table.axial_stiffness.as_ref().map(Located::span)),
        ("bending_stiffness", table.bending_stiffness.as_ref().map(Located::span)),
        ("mass_per_length", table.mass_per_length.as_ref().map(Located::span)),
    ];
    if let Some((key, Some(span))) = others.into_iter().find(|(_, span)| span.is_some()) {
        return Err(Fault::new(
            span,
            format!("beam `{label}` has `{key}` beside layers, which tell it themselves"),
        )
        .help(format!("leave `{key}` out")));
    }
    let rows = layers.get();
    let sum = |terms: &[Along]| terms.iter().cloned().reduce(|sum, term| sum.plus(&term));
    let mut heights = Vec::with_capacity(rows.len());
    for row in rows {
        heights.push(along(&row.get().height, "height", length)?);
    }
    let (Some(first), Some(total)) = (rows.first(), sum(&heights)) else {
        return Err(Fault::new(layers.span(), "a section without any layer").help("give one layer or more"));
    };
    let has_density = first.get().density.is_some();
    let has_offset = first.get().offset.is_some();
    let differs = |row: &&Located<LayerTable>| {
        row.get().density.is_some() != has_density || row.get().offset.is_some() != has_offset
    };
    if let Some(row) = rows.iter().find(differs) {
        return Err(Fault::new(row.span(), "some layers have what this one has not, or the other way round")
            .help("give `density` and `offset` for every layer, or for none"));
    }
    let mut bottom = total.times(-0.5);
    let mut stiffness = [const { Vec::new() }; 3];
    let mut inertia = [const { Vec::new() }; 2];
    let mut made = Vec::with_capacity(rows.len());
    for (row, height) in rows.iter().zip(&heights) {
        let row = row.get();
        let modulus = along(&row.youngs_modulus, "youngs_modulus", length)?;
        let area = along(&row.width, "width", length)?.product(height);
        let middle = match &row.offset {
            Some(offset) => along(offset, "offset", length)?,
            None => bottom.plus(&height.times(0.5)),
        };
        bottom = bottom.plus(height);
        // About the centreline: I = A (h²/12 + y²).
        let square = height.product(height).times(1.0 / 12.0).plus(&middle.product(&middle));
        let second_moment = area.product(&square);
        let axial = modulus.product(&area);
        let coupling = axial.product(&middle).times(-1.0);
        stiffness[0].push(axial.clone());
        stiffness[1].push(coupling.clone());
        stiffness[2].push(modulus.product(&second_moment));
        if let Some(density) = &row.density {
            let density = along(density, "density", length)?;
            inertia[0].push(density.product(&area));
            inertia[1].push(density.product(&second_moment));
        }
        let half = height.times(0.5);
        made.push(Layer {
            youngs_modulus: Some(modulus),
            bottom: middle.plus(&half.times(-1.0)),
            top: middle.plus(&half),
            stiffness: Some([axial, coupling]),
        });
    }
    let usable = |key: &str, along: Option<Along>| {
        along.map(|along| usable(label, key, (along, layers.span()), length)).transpose()
    };
    let neutral = |coupling: &Along| {
        places(coupling, length).all(|(s, value)| {
            // Round-off of layers that lie evenly about the centreline.
            let scale = stiffness[1].iter().map(|term| term.at(s, s).abs()).sum::<f64>();
            value.abs() <= 8.0 * f64::EPSILON * scale
        })
    };
    Ok(Section {
        axial_stiffness: usable("axial_stiffness", sum(&stiffness[0]))?,
        bending_stiffness: usable("bending_stiffness", sum(&stiffness[2]))?,
        coupling: sum(&stiffness[1]).filter(|coupling| !neutral(coupling)),
        mass_per_length: usable("mass_per_length", sum(&inertia[0]))?,
        rotary_inertia: sum(&inertia[1]),
        layers: made,
        ..Section::default()
    })
}
