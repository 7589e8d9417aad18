//! By how much two runs of a model differ: where along the beams, when, and in which cells.

use crate::model::{Analysis, Model};
use crate::results::{BeamErrors, Errors, ModeShape, ProbeErrors, ProbeSample, Results, Shape, Trajectory};
use std::f64::consts::TAU;

use super::judgement::scaled;
use super::mesh::{CellErrors, Mesh};

/// Parameters of records, and places along a beam, are the same when they differ by less, relative to
/// the last one.
const SAME: f64 = 1e-9;
/// Most places of a beam that are watched, unless it has more cells.
const STATIONS: usize = 64;
/// Bending of a mode, relative to its displacement, that is round-off.
const RIGID: f64 = 1e-5;
/// Curvatures smaller than this per beam length are round-off.
const STRAIGHT: f64 = 1e-9;

/// Errors of a record of which nothing is known.
const UNKNOWN: ProbeSample = ProbeSample {
    x: f64::NAN,
    y: f64::NAN,
    angle: f64::NAN,
    curvature: f64::NAN,
    strain: f64::NAN,
    vx: None,
    vy: None,
};

/// Where all beams are compared, as arc lengths \[m\] on each: in every cell of the coarser meshes as
/// many. Where nodes of the finer ones come to lie both are at their best, and none of those is taken
/// but the end and the nodes that must be: where something acts that makes the strain jump, elements
/// whose strain cannot jump err most. Nor are the quarters of the coarser cells: where curvatures are linear
/// within cells, as those of elements nearly are, both err alike there.
pub(super) fn stations(meshes: &[Mesh]) -> Vec<Vec<f64>> {
    let of = |mesh: &Mesh| {
        let of_cell = |cell: &[f64]| {
            let node = mesh.must_be(cell[0]).then_some(cell[0]).filter(|s| *s > 0.0);
            let inside = parts(mesh, cell).iter().map(|p| cell[0] + p * (cell[1] - cell[0]));
            node.into_iter().chain(inside).collect::<Vec<_>>()
        };
        let mut s: Vec<f64> = mesh.nodes.windows(2).flat_map(of_cell).collect();
        s.extend(mesh.nodes.last());
        s
    };
    meshes.iter().map(of).collect()
}

/// The stations inside of a cell, as parts of its length. A beam that is the mirror image of itself has stations that
/// are.
fn parts(mesh: &Mesh, cell: &[f64]) -> &'static [f64] {
    if mesh.cells() * 2 <= STATIONS {
        &[0.375, 0.625]
    } else if cell[0] + cell[1] < mesh.length() {
        &[0.375]
    } else {
        &[0.625]
    }
}

/// How a coarse run and a finer one differ.
#[derive(Clone, Debug, Default)]
pub(super) struct Difference {
    /// As a whole.
    pub errors: Errors,
    /// Relative, of each frequency or load factor.
    pub eigenvalues: Vec<f64>,
    /// Per own probe and record of the finer run.
    pub probes: Vec<ProbeErrors>,
    /// Per record of the finer run.
    pub records: Vec<f64>,
    /// Along each beam.
    pub beams: Vec<BeamErrors>,
    /// Of the cells of the coarse meshes, per beam.
    pub cells: Vec<CellErrors>,
    /// By what errors of curvatures and section forces are relative.
    pub scales: Scales,
}

/// The largest of a finer run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scales {
    /// \[1/m\], of all records.
    pub curvature: f64,
    /// \[N\], in the last record, M/L included.
    pub force: f64,
    /// \[N m\], in the last record.
    pub moment: f64,
}

impl Difference {
    /// Divided by these: positions, angles, velocities and values by the first, curvatures, strains and forces by
    /// the second.
    #[must_use]
    pub fn divided(mut self, by: [f64; 2]) -> Self {
        let [result, curvature] = by;
        self.errors = scaled(self.errors, by);
        self.eigenvalues.iter_mut().for_each(|error| *error /= result);
        self.records.iter_mut().for_each(|error| *error /= result);
        for sample in self.probes.iter_mut().flat_map(|probe| &mut probe.samples) {
            sample.x /= result;
            sample.y /= result;
            sample.angle /= result;
            sample.strain /= curvature;
            sample.curvature /= curvature;
            sample.vx = sample.vx.map(|v| v / result);
            sample.vy = sample.vy.map(|v| v / result);
        }
        for beam in &mut self.beams {
            beam.position.iter_mut().for_each(|error| *error /= result);
            beam.curvature.iter_mut().for_each(|error| *error /= curvature);
        }
        self
    }

    /// The errors of both together, in the cells of this one; `None` where they are not of as many records.
    pub fn plus(&self, other: &Self) -> Option<Self> {
        if self.records.len() != other.records.len() {
            return None;
        }
        let of = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a + b);
        let (mine, others) = (self.errors, other.errors);
        let mut sum = self.clone();
        sum.errors = Errors {
            result: mine.result + others.result,
            curvature: of(mine.curvature, others.curvature),
            section_force: of(mine.section_force, others.section_force),
        };
        let add = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        add(&mut sum.eigenvalues, &other.eigenvalues);
        add(&mut sum.records, &other.records);
        for (a, b) in sum.probes.iter_mut().zip(&other.probes) {
            for (a, b) in a.samples.iter_mut().zip(&b.samples) {
                *a = ProbeSample {
                    x: a.x + b.x,
                    y: a.y + b.y,
                    angle: a.angle + b.angle,
                    curvature: a.curvature + b.curvature,
                    strain: a.strain + b.strain,
                    vx: of(a.vx, b.vx),
                    vy: of(a.vy, b.vy),
                };
            }
        }
        for (a, b) in sum.beams.iter_mut().zip(&other.beams) {
            add(&mut a.position, &b.position);
            add(&mut a.curvature, &b.curvature);
        }
        Some(sum)
    }
}

/// The difference of two runs of `model`, both kept at the [`stations`] of `meshes`.
///
/// # Errors
/// In words, where they cannot be compared.
pub(super) fn between(
    model: &Model,
    analysis: &Analysis,
    meshes: &[Mesh],
    coarse: &Results,
    fine: &Results,
) -> Result<Difference, String> {
    match analysis {
        Analysis::Modal(_) | Analysis::Buckling(_) => modes(model, meshes, coarse, fine),
        Analysis::Static(_) | Analysis::Dynamic(_) | Analysis::Stages => {
            states(model, analysis, meshes, coarse.states(), fine.states())
        }
    }
}

/// Pairs of records that belong together. Along a path each run takes points of its own, and only
/// the ends do. So do the ends of motions that an event ends, which are moments of their own.
///
/// # Errors
/// In words, where no records belong together.
pub(crate) fn pairs(
    analysis: &Analysis,
    run: &[f64],
    reference: &[f64],
) -> Result<Vec<(usize, usize)>, String> {
    let ends = run.len().checked_sub(1).zip(reference.len().checked_sub(1)).ok_or("no record")?;
    if is_path(analysis) {
        return Ok(vec![ends]);
    }
    let mut pairs = common(run, reference)?;
    if matches!(analysis, Analysis::Dynamic(_)) && pairs.iter().all(|&(i, j)| i != ends.0 && j != ends.1) {
        pairs.push(ends);
    }
    Ok(pairs)
}

fn is_path(analysis: &Analysis) -> bool {
    matches!(analysis, Analysis::Static(settings) if settings.arc_length.is_some())
}

/// Pairs of records at the same time or load factor; both lists ascend. At least one is required.
pub(crate) fn common(run: &[f64], reference: &[f64]) -> Result<Vec<(usize, usize)>, String> {
    let last = *reference.last().ok_or("no record")?;
    let (mut pairs, mut i) = (Vec::new(), 0);
    for (j, &at) in reference.iter().enumerate() {
        while i < run.len() && run[i] < at - SAME * last.abs() {
            i += 1;
        }
        if run.get(i).is_some_and(|found| (found - at).abs() <= SAME * last.abs()) {
            pairs.push((i, j));
        }
    }
    if pairs.is_empty() { Err("no record at the times or loads of the reference".into()) } else { Ok(pairs) }
}

fn states<'t>(
    model: &Model,
    analysis: &Analysis,
    meshes: &[Mesh],
    coarse: &'t Trajectory,
    fine: &'t Trajectory,
) -> Result<Difference, String> {
    let pairs = pairs(analysis, &coarse.parameter, &fine.parameter)?;
    let lengths: Vec<f64> = meshes.iter().map(Mesh::length).collect();
    let mut difference = Difference { records: vec![0.0; fine.parameter.len()], ..Difference::default() };
    let mut result = 0.0_f64;
    for ((probe, a), b) in model.probes.iter().zip(&coarse.probes).zip(&fine.probes) {
        let mut samples = vec![ProbeSample::default(); fine.parameter.len()];
        for &(i, j) in &pairs {
            let (Some(a), Some(b)) = (a.samples.get(i), b.samples.get(j)) else { continue };
            samples[j] = differ(a, b);
            let around = |t: &'t Trajectory, record: usize| t.stations.get(record)?.get(probe.at.beam);
            if let Some((a, b)) = around(coarse, i).zip(around(fine, j)) {
                samples[j] = not_by_chance(samples[j], a, b, probe.at.s);
            }
            let error = samples[j].x / lengths[probe.at.beam];
            difference.records[j] = larger(difference.records[j], error);
            result = larger(result, error);
        }
        difference.probes.push(ProbeErrors { name: probe.name.clone(), samples });
    }
    let (mut curvature, mut largest) = (0.0_f64, 0.0_f64);
    for (index, (beam, mesh)) in model.beams.iter().zip(meshes).enumerate() {
        let s = fine.stations.first().and_then(|beams| beams.get(index)).map_or(&[][..], |shape| &shape.s);
        let length = mesh.length();
        let bends = beam.section.bending_stiffness.is_some();
        let mut along = BeamErrors {
            beam: beam.name.clone(),
            s: s.to_vec(),
            position: vec![0.0; s.len()],
            curvature: vec![0.0; s.len()],
        };
        let mut squares = vec![0.0_f64; mesh.cells()];
        for &(i, j) in &pairs {
            let mut now = vec![0.0_f64; mesh.cells()];
            let at = |t: &'t Trajectory, record: usize| t.stations.get(record)?.get(index);
            let (Some(a), Some(b)) = (at(coarse, i), at(fine, j)) else {
                return Err(format!("beam `{}` was not kept at record {j}", beam.name));
            };
            for (k, (a, b)) in samples(a).zip(samples(b)).enumerate() {
                let error = differ(&a, &b);
                along.position[k] = larger(along.position[k], error.x / length);
                along.curvature[k] = larger(along.curvature[k], error.curvature);
                difference.records[j] = larger(difference.records[j], error.x / length);
                let (end, node) = (k + 1 == s.len(), mesh.must_be(s[k]));
                // At inner nodes only positions are compared: strains and curvatures may jump there.
                if bends && (end || !node) {
                    largest = largest.max(b.curvature.abs());
                    curvature = larger(curvature, error.curvature);
                }
                if !end && !node {
                    let cell = mesh.cell_at(s[k]);
                    let ends = &mesh.nodes[cell..=cell + 1];
                    let width = (ends[1] - ends[0]) / parts(mesh, ends).len() as f64;
                    let bent = if bends { error.curvature } else { within_half_a_turn(error.angle) / length };
                    // A part that is longer by its strain moves what is behind it by its length, one that is
                    // bent by its distance.
                    let stretched = error.strain / length;
                    now[cell] += width * (bent * bent + stretched * stretched);
                }
            }
            squares.iter_mut().zip(now).for_each(|(most, now)| *most = larger(*most, now));
        }
        result = along.position.iter().copied().fold(result, larger);
        difference.beams.push(along);
        difference.cells.push(CellErrors { squares, order: if bends { 2.0 } else { 3.0 } });
    }
    // Stations are inside the cells; where cells meet curvatures err most.
    for ((beam, a), b) in model.beams.iter().zip(&coarse.last).zip(&fine.last) {
        if beam.section.bending_stiffness.is_none() {
            continue;
        }
        largest = b.curvature.iter().fold(largest, |largest, value| largest.max(value.abs()));
        for (s, value) in a.s.iter().zip(&a.curvature) {
            let other = interpolated(&b.s, &b.curvature, *s, true);
            curvature = other.map_or(curvature, |other| larger(curvature, (value - other).abs()));
        }
    }
    let known: Vec<usize> = pairs.iter().map(|&(_, j)| j).collect();
    if matches!(analysis, Analysis::Static(_)) {
        // Each run chooses load factors of its own, and near a critical one even neighbours differ.
        for j in (0..fine.parameter.len()).filter(|j| !known.contains(j)) {
            difference.records[j] = f64::NAN;
            difference.probes.iter_mut().for_each(|probe| probe.samples[j] = UNKNOWN);
        }
    } else {
        fill(&mut difference.records, &known, |a, b| larger(*a, *b));
        for probe in &mut difference.probes {
            fill(&mut probe.samples, &known, |a, b| if a.x >= b.x { *a } else { *b });
        }
    }
    let scale = lengths.iter().copied().fold(0.0, f64::max);
    let (section_force, [force, moment]) = section_forces(&coarse.last, &fine.last);
    difference.errors = Errors {
        result,
        curvature: (largest * scale > STRAIGHT).then(|| curvature / largest),
        section_force,
    };
    difference.scales = Scales { curvature: largest, force, moment };
    if result.is_finite() { Ok(difference) } else { Err("a position is not a number".into()) }
}

/// Gives records that the coarse run has not those of the records around them, of which `choose`
/// takes one.
fn fill<T: Clone>(values: &mut [T], known: &[usize], choose: impl Fn(&T, &T) -> T) {
    for i in 0..values.len() {
        let after = known.partition_point(|&k| k < i);
        let (before, after) = (after.checked_sub(1).map(|k| known[k]), known.get(after).copied());
        values[i] = match (before, after) {
            (_, Some(after)) if after == i => continue,
            (Some(before), Some(after)) => choose(&values[before], &values[after]),
            (Some(one), None) | (None, Some(one)) => values[one].clone(),
            (None, None) => continue,
        };
    }
}

/// The sizes of the differences of what a probe sees; that of x and y is the distance.
fn differ(a: &ProbeSample, b: &ProbeSample) -> ProbeSample {
    let distance = (a.x - b.x).hypot(a.y - b.y);
    let of = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| (a - b).abs());
    ProbeSample {
        x: distance,
        y: distance,
        angle: (a.angle - b.angle).abs(),
        curvature: (a.curvature - b.curvature).abs(),
        strain: (a.strain - b.strain).abs(),
        vx: of(a.vx, b.vx),
        vy: of(a.vy, b.vy),
    }
}

/// What a shape holds, place by place.
fn samples(shape: &Shape) -> impl Iterator<Item = ProbeSample> {
    (0..shape.s.len()).filter_map(|k| sample(shape, k))
}

/// What a shape holds at its place of this number.
fn sample(shape: &Shape, k: usize) -> Option<ProbeSample> {
    Some(ProbeSample {
        x: *shape.x.get(k)?,
        y: *shape.y.get(k)?,
        angle: *shape.angle.get(k)?,
        curvature: *shape.curvature.get(k)?,
        strain: *shape.strain.get(k)?,
        vx: None,
        vy: None,
    })
}

/// What a probe at `s` differs by, and no less than what is on both sides of it. Errors are waves along a beam:
/// a probe that lies where one passes zero tells nothing.
fn not_by_chance(seen: ProbeSample, coarse: &Shape, fine: &Shape, s: f64) -> ProbeSample {
    let differ_at = |k: usize| Some(differ(&sample(coarse, k)?, &sample(fine, k)?));
    let after = fine.s.partition_point(|place| *place < s);
    let Some((before, after)) = after.checked_sub(1).and_then(differ_at).zip(differ_at(after)) else {
        return seen;
    };
    let angle = within_half_a_turn(before.angle).min(within_half_a_turn(after.angle));
    let distance = larger(seen.x, before.x.min(after.x));
    ProbeSample {
        x: distance,
        y: distance,
        angle: larger(seen.angle, angle),
        curvature: larger(seen.curvature, before.curvature.min(after.curvature)),
        strain: larger(seen.strain, before.strain.min(after.strain)),
        ..seen
    }
}

/// The size of an angle without whole turns, which shapes do not tell.
fn within_half_a_turn(angle: f64) -> f64 {
    (angle - TAU * (angle / TAU).round()).abs()
}

/// The largest difference of axial and shear forces, relative to the largest of both and of M/L,
/// and of bending moments, relative to the largest of these; `None` where nothing is loaded. With these
/// largest ones.
fn section_forces(coarse: &[Shape], fine: &[Shape]) -> (Option<f64>, [f64; 2]) {
    let kinds: [fn(&Shape) -> &Vec<f64>; 3] =
        [|shape| &shape.axial_force, |shape| &shape.shear_force, |shape| &shape.bending_moment];
    let error = |kind: fn(&Shape) -> &Vec<f64>| {
        let (mut largest, mut error) = (0.0_f64, 0.0_f64);
        for (a, b) in coarse.iter().zip(fine) {
            largest = kind(b).iter().fold(largest, |largest, value| largest.max(value.abs()));
            for (k, (s, value)) in a.s.iter().zip(kind(a)).enumerate() {
                let after = a.s.get(k + 1).is_none_or(|next| next - s > same_place(&a.s));
                if let Some(other) = interpolated(&b.s, kind(b), *s, after) {
                    error = larger(error, (value - other).abs());
                }
            }
        }
        (error, largest)
    };
    let [(axial, n), (shear, q), (bending, m)] = kinds.map(error);
    // A force that is nowhere more than a small part of the others and of M/L is round-off.
    let length = fine.iter().filter_map(|shape| shape.s.last().copied()).fold(0.0, f64::max);
    let force = n.max(q).max(m / length);
    let moment = if m > STRAIGHT * force * length { m } else { 0.0 };
    let error = (force > 0.0).then(|| {
        let bending = if moment > 0.0 { bending / moment } else { 0.0 };
        larger(larger(axial / force, shear / force), bending)
    });
    (error, [force, moment])
}

/// Arc lengths \[m\] that are nearer to each other are one place, to which a finer mesh gives other last
/// digits.
fn same_place(places: &[f64]) -> f64 {
    SAME * places.last().copied().unwrap_or(0.0)
}

/// The value at `s`; where a place is there twice, behind it with `after`.
fn interpolated(places: &[f64], values: &[f64], s: f64, after: bool) -> Option<f64> {
    let (before, behind) = (s - same_place(places), s + same_place(places));
    let right = places.partition_point(|p| if after { *p <= behind } else { *p < before });
    let here = if after { right.checked_sub(1) } else { Some(right) };
    if let Some(here) = here
        && places.get(here).is_some_and(|p| (before..=behind).contains(p))
    {
        return values.get(here).copied();
    }
    let left = right.checked_sub(1)?;
    let (a, b) = (*places.get(left)?, *places.get(right)?);
    let part = (s - a) / (b - a);
    Some((1.0 - part) * values.get(left)? + part * values.get(right)?)
}

fn modes(model: &Model, meshes: &[Mesh], coarse: &Results, fine: &Results) -> Result<Difference, String> {
    let (a, b) = (coarse.eigenvalues(), fine.eigenvalues());
    if a.len() != b.len() {
        return Err(format!("one run has {} values, the other {}", a.len(), b.len()));
    }
    // The frequency of a motion that nothing resists is zero in both.
    let relative = |(a, b): (&f64, &f64)| if a == b { 0.0 } else { (a - b).abs() / b.abs() };
    let eigenvalues: Vec<f64> = a.iter().zip(&b).map(relative).collect();
    let result = eigenvalues.iter().copied().fold(0.0, larger);
    if !result.is_finite() {
        return Err("a value is not a number".into());
    }
    let shapes: Vec<(&[ModeShape], &[ModeShape])> =
        coarse.mode_shapes().into_iter().zip(fine.mode_shapes()).collect();
    let mut cells: Vec<CellErrors> = meshes
        .iter()
        .zip(&model.beams)
        .map(|(mesh, beam)| CellErrors {
            squares: vec![0.0; mesh.cells()],
            order: if beam.section.bending_stiffness.is_some() { 2.0 } else { 3.0 },
        })
        .collect();
    let longest = meshes.iter().map(Mesh::length).fold(0.0, f64::max);
    for (a, b) in shapes {
        fn bent(shape: &ModeShape, order: f64) -> &[f64] {
            if order == 2.0 { &shape.curvature } else { &shape.angle }
        }
        // Signs are arbitrary, and one for the whole mode; so is the size.
        let (mut product, mut size, mut largest) = (0.0, 0.0, 0.0_f64);
        for (a, b) in a.iter().zip(b) {
            for (k, s) in a.s.iter().enumerate() {
                product += a.x[k] * interpolated(&b.s, &b.x, *s, false).unwrap_or(0.0);
                product += a.y[k] * interpolated(&b.s, &b.y, *s, false).unwrap_or(0.0);
            }
        }
        for b in b {
            largest = b.x.iter().chain(&b.y).fold(largest, |most, value| most.max(value.abs()));
        }
        let sign = if product < 0.0 { -1.0 } else { 1.0 };
        let mut now: Vec<Vec<f64>> = cells.iter().map(|cells| vec![0.0; cells.squares.len()]).collect();
        for (((a, b), mesh), (cells, now)) in a.iter().zip(b).zip(meshes).zip(cells.iter().zip(&mut now)) {
            let (coarse, fine) = (bent(a, cells.order), bent(b, cells.order));
            // The finer run knows all places of the coarse one, and more.
            for (k, s) in a.s.windows(2).enumerate() {
                let ends = interpolated(&b.s, fine, s[0], true).zip(interpolated(&b.s, fine, s[1], false));
                let Some((from, to)) = ends else { continue };
                let (value, other) = (0.5 * (from + to), 0.5 * (coarse[k] + coarse[k + 1]));
                let middle = 0.5 * (s[0] + s[1]);
                let cell = mesh.nodes.partition_point(|node| *node <= middle).saturating_sub(1);
                size += value * value * (s[1] - s[0]);
                if let Some(cell) = now.get_mut(cell) {
                    *cell += (value - sign * other).powi(2) * (s[1] - s[0]);
                }
            }
        }
        // A rigid motion bends nothing; what is left of it is round-off.
        if size * longest.powi(3) <= (RIGID * largest).powi(2) {
            continue;
        }
        for (cells, now) in cells.iter_mut().zip(now) {
            cells.squares.iter_mut().zip(now).for_each(|(most, now)| *most = larger(*most, now / size));
        }
    }
    Ok(Difference {
        errors: Errors { result, curvature: None, section_force: None },
        eigenvalues,
        cells,
        ..Difference::default()
    })
}

/// A maximum that keeps what is not a number.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{BucklingMode, CriticalLoads, ProbeSeries, Vibration, Vibrations};
    use crate::scene::{Scene, parse};

    /// A beam of 2 m with a probe at its tip, and a string of 4 m.
    fn scene(analysis: &str) -> Scene {
        let text = "beam.arm = { start = [0, 0], end = [2, 0], axial_stiffness = 1, bending_stiffness = 1, mass_per_length = 1 }\n\
                    beam.rope = { start = [0, 1], end = [4, 1], axial_stiffness = 1, mass_per_length = 1 }\n\
                    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, \
                    { beam = 'rope', at = 'start', fix = ['x', 'y'] }, { beam = 'rope', at = 'end', fix = ['x', 'y'] }]\n\
                    probe = [{ name = 'tip', beam = 'arm', at = 'end' }]\n";
        parse("scene", &format!("{text}analysis.{analysis}\n")).unwrap()
    }

    fn meshes() -> [Mesh; 2] {
        [Mesh::of(&[0.0, 0.5, 2.0]), Mesh::of(&[0.0, 4.0])]
    }

    /// Each kind of value by its own factor, and the sum of every one.
    #[test]
    fn differences_are_divided_and_added_value_by_value() {
        let of = |k: f64| Difference {
            errors: Errors { result: k, curvature: Some(3.0 * k), section_force: Some(6.0 * k) },
            eigenvalues: vec![2.0 * k],
            probes: vec![ProbeErrors {
                name: "tip".into(),
                samples: vec![ProbeSample {
                    x: k,
                    y: 2.0 * k,
                    angle: 3.0 * k,
                    curvature: 6.0 * k,
                    strain: 9.0 * k,
                    vx: Some(4.0 * k),
                    vy: None,
                }],
            }],
            records: vec![5.0 * k],
            beams: vec![BeamErrors {
                beam: "arm".into(),
                s: vec![0.5],
                position: vec![7.0 * k],
                curvature: vec![12.0 * k],
            }],
            cells: vec![CellErrors { squares: vec![k], order: 2.0 }],
            scales: Scales::default(),
        };
        let same = |found: &Difference, [first, second]: [f64; 2]| {
            let errors =
                Errors { result: first, curvature: Some(3.0 * second), section_force: Some(6.0 * second) };
            assert_eq!(found.errors, errors);
            assert_eq!((found.eigenvalues[0], found.records[0]), (2.0 * first, 5.0 * first));
            let sample = ProbeSample {
                x: first,
                y: 2.0 * first,
                angle: 3.0 * first,
                curvature: 6.0 * second,
                strain: 9.0 * second,
                vx: Some(4.0 * first),
                vy: None,
            };
            assert_eq!(found.probes[0].samples, [sample]);
            assert_eq!(found.beams[0].s, [0.5]);
            assert_eq!(
                (found.beams[0].position[0], found.beams[0].curvature[0]),
                (7.0 * first, 12.0 * second)
            );
            assert_eq!(found.cells[0].squares, [8.0], "cells are told apart by size only");
        };
        let divided = of(8.0).divided([2.0, 4.0]);
        same(&divided, [4.0, 2.0]);
        same(&divided.plus(&of(1.0)).expect("as many records"), [5.0, 3.0]);
        assert!(divided.plus(&Difference::default()).is_none(), "an event has ended one of the motions");
    }

    /// Two stations in a cell, or one where there are more than 32 cells, one at the end, and one at each
    /// node that must be.
    #[test]
    fn stations_are_inside_of_cells_and_at_nodes_that_must_be() {
        assert_eq!(stations(&meshes()), [vec![0.1875, 0.3125, 1.0625, 1.4375, 2.0], vec![1.5, 2.5, 4.0]]);
        let pulled = scene("static = {}\neffect.force = [{ beam = 'arm', at = 0.5, value = [1, 0] }]");
        let mesh = Mesh::first(pulled.model(), 0, 1.0).remove(0);
        let nodes: Vec<f64> = stations(std::slice::from_ref(&mesh))[0]
            .iter()
            .copied()
            .filter(|s| mesh.nodes.contains(s))
            .collect();
        assert_eq!(nodes, [0.5, 2.0]);
        let of_cells = |cells: usize| {
            let nodes: Vec<f64> = (0..=cells).map(|i| i as f64).collect();
            stations(&[Mesh::of(&nodes)]).remove(0)
        };
        assert_eq!((of_cells(32).len(), of_cells(33).len()), (65, 34));
        assert_eq!(of_cells(33)[14..18], [14.375, 15.375, 16.625, 17.625]);
        assert_eq!(of_cells(34)[16..18], [16.375, 17.625]);
    }

    #[test]
    fn records_at_the_same_time_or_load_belong_together() {
        assert_eq!(common(&[0.0, 0.5, 1.0], &[0.25, 0.5, 1.0 + 1e-10]), Ok(vec![(1, 1), (2, 2)]));
        assert_eq!(common(&[-1.0, -0.5], &[-0.5]), Ok(vec![(1, 0)]));
        // A billionth of the last one apart, times three.
        assert!(common(&[0.0, 100.0], &[3e-7, 100.0]).is_ok_and(|pairs| pairs == [(1, 1)]));
        assert!(common(&[0.0, 1.0], &[0.5]).is_err() && common(&[1.0], &[]).is_err());
        let (still, motion) = (scene("static = {}"), scene("dynamic = { duration = 1 }"));
        let path = super::super::round::tests::scene("analysis.static.arc_length.max_points = 9");
        let of = |scene: &Scene, run: &[f64], reference: &[f64]| pairs(scene.analysis(), run, reference);
        assert_eq!(of(&still, &[0.0, 0.5, 1.0], &[0.0, 0.7, 1.0]), Ok(vec![(0, 0), (2, 2)]));
        assert_eq!(of(&path, &[0.0, 0.5, 1.0], &[0.0, 1.0]), Ok(vec![(2, 1)]));
        assert!(of(&path, &[], &[0.0]).is_err() && of(&path, &[0.0], &[]).is_err());
        // An event has ended both motions, at times that differ a little.
        assert_eq!(of(&motion, &[0.0, 0.5, 0.7], &[0.0, 0.5, 0.71]), Ok(vec![(0, 0), (1, 1), (2, 2)]));
        assert_eq!(of(&motion, &[0.0, 0.5, 0.71], &[0.0, 0.71]), Ok(vec![(0, 0), (2, 1)]));
        // One of them has gone on: the last record of the other has a partner.
        assert_eq!(of(&motion, &[0.0, 0.5, 1.0], &[0.0, 0.5]), Ok(vec![(0, 0), (1, 1)]));
    }

    /// What one run, at rest but for these samples (record, place, sample), saw at some times: by its probe, and
    /// at the five stations of the beam and the three of the string.
    fn seen(parameter: &[f64], samples: &[(usize, usize, ProbeSample)]) -> Trajectory {
        let at_rest = ProbeSample { vx: Some(0.0), ..ProbeSample::default() };
        let mut probe = ProbeSeries { name: String::new(), samples: vec![at_rest; parameter.len()] };
        let still = |s: &Vec<f64>| {
            let zero = || vec![0.0; s.len()];
            Shape {
                s: s.clone(),
                x: zero(),
                y: zero(),
                angle: zero(),
                strain: zero(),
                curvature: zero(),
                ..Shape::default()
            }
        };
        let mut stations = vec![stations(&meshes()).iter().map(still).collect::<Vec<_>>(); parameter.len()];
        for &(record, place, sample) in samples {
            let Some(station) = place.checked_sub(1) else {
                probe.samples[record] = sample;
                continue;
            };
            let shape = &mut stations[record][station / 5];
            let k = station % 5;
            (shape.x[k], shape.y[k], shape.angle[k]) = (sample.x, sample.y, sample.angle);
            (shape.strain[k], shape.curvature[k]) = (sample.strain, sample.curvature);
        }
        Trajectory { parameter: parameter.into(), probes: vec![probe], stations, ..Trajectory::default() }
    }

    /// Worked out by hand: what differs at nine places in two records, the first and the last of three.
    #[test]
    fn differences_of_motions_are_those_of_all_places_and_records() {
        let bent = |curvature: f64| ProbeSample { curvature, ..ProbeSample::default() };
        let coarse = seen(
            &[0.0, 1.0],
            &[
                (
                    1,
                    0,
                    ProbeSample {
                        x: 0.3,
                        y: 0.4,
                        angle: 0.1,
                        strain: 0.2,
                        vx: Some(1.0),
                        ..ProbeSample::default()
                    },
                ),
                (0, 1, ProbeSample { angle: 5.0, ..bent(3.0) }),
                (1, 2, bent(2.0)),
                (1, 3, bent(-7.0)),
                (1, 4, bent(4.0)),
                // At the end of the beam, which is in no cell.
                (1, 5, ProbeSample { x: 0.8, ..bent(3.5) }),
                // A string that has gone round once more is where it was.
                (1, 6, ProbeSample { angle: 0.8 + TAU, ..bent(100.0) }),
            ],
        );
        let at_rest = ProbeSample { vx: Some(-1.0), ..ProbeSample::default() };
        let mut fine = seen(&[0.0, 0.5, 1.0], &[(2, 0, at_rest), (2, 3, bent(-8.0))]);
        let motion = scene("dynamic = { duration = 1 }");
        let of = |scene: &Scene, coarse: &Trajectory, fine: &Trajectory| {
            let results = [coarse, fine].map(|run| Results::from(run.clone()));
            between(scene.model(), scene.analysis(), &meshes(), &results[0], &results[1])
        };
        let found = of(&motion, &coarse, &fine).unwrap();
        assert_eq!(found.errors, Errors { result: 0.4, curvature: Some(0.5), section_force: None });
        assert_eq!(found.records, [0.0, 0.4, 0.4]);
        let tip = &found.probes[0].samples;
        // The curvature is that of the stations beside it, which differ though the probe does not.
        let last = ProbeSample {
            x: 0.5,
            y: 0.5,
            angle: 0.1,
            strain: 0.2,
            curvature: 3.5,
            vx: Some(2.0),
            ..ProbeSample::default()
        };
        assert_eq!((found.probes.len(), tip[0].x, tip[1], tip[2]), (1, 0.0, last, last));
        assert_eq!(found.beams[0].position, [0.0, 0.0, 0.0, 0.0, 0.4]);
        assert_eq!(found.beams[0].curvature, [3.0, 2.0, 1.0, 4.0, 3.5]);
        assert_eq!(found.beams[1].curvature, [100.0, 0.0, 0.0]);
        // Cells of 0.5 m and 1.5 m, with two stations each: the record counts that errs most, 3² of
        // the first, and 1² and 4² of the last. Of the string the direction counts, over its length.
        let cells = [(vec![0.25 * 9.0, 0.75 * (1.0 + 16.0)], 2.0), (vec![2.0 * 0.2 * 0.2], 3.0)];
        for (found, (squares, order)) in found.cells.iter().zip(cells) {
            assert_eq!(found.order, order);
            assert!(found.squares.iter().zip(&squares).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        }
        // In equilibria, records without a partner tell nothing.
        let found = of(&scene("static = {}"), &coarse, &fine).unwrap();
        assert!(found.records[1].is_nan() && found.records[2] == 0.4);
        let sample = found.probes[0].samples[1];
        assert!(sample.x.is_nan() && sample.strain.is_nan());
        assert_eq!(found.probes[0].samples[2], last);
        // Where cells meet, curvatures of the last state count, too, but not those of a string.
        let shape = |curvature: [f64; 3]| Shape {
            s: vec![0.0, 0.5, 2.0],
            curvature: curvature.into(),
            ..Shape::default()
        };
        let of_string = Shape { s: vec![0.0, 4.0], curvature: vec![1e3; 2], ..Shape::default() };
        let coarse = Trajectory { last: vec![shape([0.0, 5.0, 0.0]), Shape::default()], ..coarse };
        fine.last = vec![shape([0.0, -16.0, 1.0]), of_string];
        assert_eq!(of(&motion, &coarse, &fine).unwrap().errors.curvature, Some(21.0 / 16.0));
        // A probe may see more than the stations, and what is not a number is no small difference.
        let far = ProbeSample { y: 2.0, ..ProbeSample::default() };
        let found = of(&motion, &seen(&[0.0, 1.0], &[(1, 0, far)]), &seen(&[0.0, 1.0], &[])).unwrap();
        assert_eq!((found.errors.result, found.errors.curvature), (1.0, None));
        let lost = ProbeSample { x: f64::NAN, ..ProbeSample::default() };
        assert!(of(&motion, &seen(&[0.0, 1.0], &[(0, 7, lost)]), &seen(&[0.0, 1.0], &[])).is_err());
    }

    /// The bent beam and the string in a mode, with values at `s` as parts of their lengths.
    fn shapes(s: &[f64], beam: [&[f64]; 3], string: [&[f64]; 3]) -> Vec<ModeShape> {
        let shape = |length: f64, [x, y, bent]: [&[f64]; 3]| ModeShape {
            s: s.iter().map(|s| s * length).collect(),
            x: x.into(),
            y: y.into(),
            ..if length == 2.0 {
                ModeShape { curvature: bent.into(), angle: vec![7.0; s.len()], ..ModeShape::default() }
            } else {
                ModeShape { angle: bent.into(), curvature: vec![7.0; s.len()], ..ModeShape::default() }
            }
        };
        vec![shape(2.0, beam), shape(4.0, string)]
    }

    fn vibrations(modes: Vec<(f64, Vec<ModeShape>)>) -> Results {
        let modes = modes.into_iter().map(|(frequency, shape)| Vibration { frequency, shape }).collect();
        Results::from(Vibrations { modes, ..Vibrations::default() })
    }

    #[test]
    fn differences_of_modes_do_not_depend_on_their_signs() {
        let scene = scene("modal.count = 1");
        let of = |coarse: &Results, fine: &Results| {
            between(scene.model(), scene.analysis(), &meshes(), coarse, fine)
        };
        let (few, many) = ([0.0, 0.5, 1.0], [0.0, 0.25, 0.5, 0.75, 1.0]);
        let none = [0.0; 5];
        let coarse = |sign: f64| {
            let [beam, string] = [[-2.0, -2.0, -1.0], [1.0, 1.0, 0.0]].map(|v| v.map(|v| sign * v));
            shapes(&few, [&[0.0; 3], &[0.0, -sign, -4.0 * sign], &beam], [&[0.0; 3], &[0.0; 3], &string])
        };
        let fine =
            || shapes(&many, [&none, &[0.0, 0.25, 1.0, 2.25, 4.0], &[2.0; 5]], [&none, &none, &[-1.0; 5]]);
        // The coarse spaces are 1 m long, in the second cell, with curvatures of 2 and 1.5 in place of 2. On
        // the string, where they are 2 m long, angles are 1 and 0.5 in place of 1. Both count in the size,
        // 4·2 + 1·4.
        let expected = [vec![0.0, 0.25 / 12.0], vec![2.0 * 0.25 / 12.0]];
        for sign in [1.0, -1.0] {
            let found = of(&vibrations(vec![(1.1, coarse(sign))]), &vibrations(vec![(1.0, fine())])).unwrap();
            assert!(
                (found.eigenvalues[0] - 0.1).abs() < 1e-15 && found.errors.result == found.eigenvalues[0]
            );
            assert_eq!(found.cells.iter().map(|cells| cells.order).collect::<Vec<_>>(), [2.0, 3.0]);
            for (found, expected) in found.cells.iter().zip(&expected) {
                assert!(found.squares.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
            }
        }
        // A mode along x has its sign from there. The square of what bends it, ∫ κ² ds = 2 m κ² times the
        // cube of 4 m, is more than the square of 1e-5 of its displacement; with half of that curvature
        // it is less, as in a rigid motion, and counts for nothing.
        let along = |places: &[f64], x: f64, bent: f64| {
            let [x, y, bent, zero] = [x, 0.0, bent, 0.0].map(|value| vec![value; places.len()]);
            shapes(places, [&x, &y, &bent], [&zero, &zero, &zero])
        };
        for (size, squares) in [(1e-6, [0.25, 0.75]), (5e-7, [0.0, 0.0])] {
            let (a, b) = (along(&many, -1.0, -2.0 * size), along(&many, 1.0, size));
            let found = of(&vibrations(vec![(0.0, a)]), &vibrations(vec![(0.0, b)])).unwrap();
            assert_eq!(found.eigenvalues, [0.0], "a frequency of zero in both runs");
            assert!(
                found.cells[0].squares.iter().zip(squares).all(|(a, b)| (a - b).abs() < 1e-9),
                "{found:?}"
            );
        }
        // Runs with different numbers of values cannot be compared, nor those that are none.
        let one = |value: f64| vibrations(vec![(value, fine())]);
        assert!(of(&vibrations(Vec::new()), &one(1.0)).is_err());
        // Where nothing buckles on either mesh they agree.
        assert_eq!(of(&vibrations(Vec::new()), &vibrations(Vec::new())).unwrap().errors.result, 0.0);
        assert!(of(&one(f64::NAN), &one(1.0)).is_err());
        let load = |load_factor: f64| {
            let modes = vec![BucklingMode { load_factor, shape: fine() }];
            Results::from(CriticalLoads { modes, ..CriticalLoads::default() })
        };
        assert_eq!(of(&load(-3.0), &load(-4.0)).unwrap().eigenvalues, [0.25]);
    }

    /// Everything a probe sees differs at least by the smaller one of the differences on both sides of it; at the
    /// start of a beam there is one side only.
    #[test]
    fn probes_differ_no_less_than_both_sides_of_them() {
        let of = |by: f64| Shape {
            s: vec![0.0, 1.0, 3.0],
            x: vec![0.0; 3],
            y: vec![0.0, by, 2.0 * by],
            angle: vec![0.0, 3.0 * by + TAU, 4.0 * by],
            strain: vec![0.0, 6.0 * by, 5.0 * by],
            curvature: vec![0.0, 7.0 * by, -8.0 * by],
            ..Shape::default()
        };
        let none = ProbeSample::default();
        let at = |seen, s| not_by_chance(seen, &of(0.0), &of(0.125), s);
        let least = ProbeSample { x: 0.125, y: 0.125, angle: 0.375, strain: 0.625, curvature: 0.875, ..none };
        let found = at(none, 2.0);
        assert!((found.angle - least.angle).abs() < 1e-14);
        assert_eq!(ProbeSample { angle: least.angle, ..found }, least);
        let more =
            ProbeSample { x: 1.0, y: 1.0, angle: 1.0, strain: 1.0, curvature: 1.0, vx: Some(0.0), vy: None };
        assert_eq!(at(more, 2.0), more);
        assert_eq!((at(none, 0.0), at(none, 0.5), at(none, 3.5)), (none, none, none));
    }

    #[test]
    fn a_maximum_keeps_what_is_not_a_number() {
        assert_eq!((larger(1.0, 2.0), larger(2.0, 1.0)), (2.0, 2.0));
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan());
    }

    #[test]
    fn between_two_places_values_are_linear_and_at_a_jump_there_are_two() {
        let (s, v) = ([0.0, 1.0, 1.0, 3.0], [1.0, 2.0, 5.0, 9.0]);
        let at = |place, after| interpolated(&s, &v, place, after);
        assert_eq!(at(0.25, true), Some(1.25));
        assert_eq!(at(2.5, false), Some(8.0));
        assert_eq!((at(1.0, false), at(1.0, true)), (Some(2.0), Some(5.0)));
        assert_eq!((at(0.0, false), at(3.0, true)), (Some(1.0), Some(9.0)));
        assert_eq!((at(-0.5, true), at(3.5, true)), (None, None));
    }

    /// Of the forces the largest of both kinds counts, and M over the length; of moments their own.
    #[test]
    fn section_forces_err_by_their_largest() {
        let shape = |axial: [f64; 2], shear: [f64; 2], moment: [f64; 2]| Shape {
            s: vec![0.0, 2.0],
            axial_force: axial.into(),
            shear_force: shear.into(),
            bending_moment: moment.into(),
            ..Shape::default()
        };
        let fine = [shape([1.0, 8.0], [0.0, -4.0], [0.0, 10.0])];
        let error = |coarse: Shape| section_forces(&[coarse], &fine).0.unwrap();
        assert_eq!(error(shape([1.0, 6.0], [0.0, -4.0], [0.0, 10.0])), 0.25);
        assert_eq!(error(shape([1.0, 8.0], [0.0, -3.0], [0.0, 10.0])), 0.125);
        assert_eq!(error(shape([1.0, 8.0], [0.0, -4.0], [5.0, 10.0])), 0.5);
        assert_eq!(error(fine[0].clone()), 0.0);
        // Moments decide about forces where these are small.
        let bent = [shape([0.0, 0.0], [0.0, 1.0], [0.0, 20.0])];
        let other = shape([0.0, 0.5], [0.0, 1.0], [0.0, 20.0]);
        assert_eq!(section_forces(&[other], &bent).0, Some(0.05));
        // The same jump, at places that differ by their last digits.
        let jump = |s: f64| Shape {
            s: vec![0.0, s, s, 2.0],
            axial_force: vec![3.0, 3.0, -5.0, -5.0],
            shear_force: vec![0.0; 4],
            bending_moment: vec![0.0; 4],
            ..Shape::default()
        };
        for s in [1.0_f64.next_down(), 1.0, 1.0_f64.next_up()] {
            assert_eq!(section_forces(&[jump(s)], &[jump(1.0)]).0, Some(0.0), "{s:?}");
        }
        assert!(section_forces(&[jump(1.001)], &[jump(1.0)]).0 > Some(1.0));
        let nothing = [shape([0.0; 2], [0.0; 2], [0.0; 2])];
        assert_eq!(section_forces(&nothing, &nothing).0, None);
    }

    #[test]
    fn records_without_a_partner_take_the_larger_of_their_neighbours() {
        let mut values = vec![0.0, 3.0, 0.0, 1.0, 0.0];
        fill(&mut values, &[1, 3], |a, b| larger(*a, *b));
        assert_eq!(values, [3.0, 3.0, 3.0, 1.0, 1.0]);
        let mut none = vec![1.0, 2.0];
        fill(&mut none, &[], |a, b| larger(*a, *b));
        assert_eq!(none, [1.0, 2.0]);
    }
}
