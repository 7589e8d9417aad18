//! By how much two runs of a model differ: where along the beams, when, and in which cells.

use crate::model::{Analysis, Model, Place, Probe};
use crate::results::{BeamErrors, Errors, ModeShape, ProbeErrors, ProbeSample, Results, Shape, Trajectory};

use super::mesh::{CellErrors, Mesh};

/// Records belong together when their parameters differ by less, relative to the last one.
const SAME: f64 = 1e-9;
/// Most places of a beam that are watched, unless it has more cells.
const STATIONS: usize = 64;
/// Bending of a mode, relative to its displacement, that is round-off.
const RIGID: f64 = 1e-5;
/// Curvatures smaller than this per beam length are round-off.
const STRAIGHT: f64 = 1e-9;

/// Where all beams are watched: the same places in both runs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stations {
    /// Per beam, arc lengths \[m\].
    pub s: Vec<Vec<f64>>,
    /// Number of the model's own probes.
    own: usize,
}

impl Stations {
    /// In every cell of the coarser meshes as many, and where nodes of the finer ones come to lie
    /// none: there both are at their best.
    pub fn new(model: &Model, meshes: &[Mesh]) -> Self {
        let of = |mesh: &Mesh| {
            let parts: &[f64] = if mesh.cells() * 2 <= STATIONS { &[0.25, 0.75] } else { &[0.25] };
            let inside =
                |cell: &[f64]| parts.iter().map(|p| cell[0] + p * (cell[1] - cell[0])).collect::<Vec<_>>();
            let mut s: Vec<f64> = mesh.nodes.windows(2).flat_map(inside).collect();
            s.extend(mesh.nodes.last());
            s
        };
        Self { s: meshes.iter().map(of).collect(), own: model.probes.len() }
    }

    /// The model with probes at all stations behind its own.
    pub fn watch(&self, model: &Model) -> Model {
        let mut model = model.clone();
        for (beam, stations) in self.s.iter().enumerate() {
            model.probes.extend(stations.iter().map(|&s| Probe::new("station", Place::new(beam, s))));
        }
        model
    }

    /// Takes the stations out of what a run saw.
    pub fn strip(&self, results: &mut Results) {
        results.states_mut().probes.truncate(self.own);
    }

    /// The stations of each beam among the probes of a run.
    pub fn of_beams<'t>(
        &'t self,
        t: &'t Trajectory,
    ) -> impl Iterator<Item = &'t [crate::results::ProbeSeries]> {
        let mut next = self.own;
        self.s.iter().map(move |stations| {
            let first = next;
            next += stations.len();
            t.probes.get(first..next).unwrap_or_default()
        })
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
}

/// The difference of two runs of `model`, both watched at `stations`.
///
/// # Errors
/// In words, where they cannot be compared.
pub(super) fn between(
    model: &Model,
    analysis: &Analysis,
    (stations, meshes): (&Stations, &[Mesh]),
    coarse: &Results,
    fine: &Results,
) -> Result<Difference, String> {
    match analysis {
        Analysis::Modal(_) | Analysis::Buckling(_) => modes(model, meshes, coarse, fine),
        Analysis::Static(_) | Analysis::Dynamic(_) | Analysis::Stages => {
            states(model, analysis, (stations, meshes), coarse.states(), fine.states())
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

fn states(
    model: &Model,
    analysis: &Analysis,
    (stations, meshes): (&Stations, &[Mesh]),
    coarse: &Trajectory,
    fine: &Trajectory,
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
            let error = samples[j].x / lengths[probe.at.beam];
            difference.records[j] = larger(difference.records[j], error);
            result = larger(result, error);
        }
        difference.probes.push(ProbeErrors { name: probe.name.clone(), samples });
    }
    let (mut curvature, mut largest) = (0.0_f64, 0.0_f64);
    let of_beams = stations.of_beams(coarse).zip(stations.of_beams(fine));
    for (((beam, mesh), s), (a, b)) in model.beams.iter().zip(meshes).zip(&stations.s).zip(of_beams) {
        let length = mesh.length();
        let bends = beam.section.bending_stiffness.is_some();
        let mut along = BeamErrors {
            beam: beam.name.clone(),
            s: s.clone(),
            position: vec![0.0; s.len()],
            curvature: vec![0.0; s.len()],
        };
        let mut squares = vec![0.0_f64; mesh.cells()];
        for &(i, j) in &pairs {
            let mut now = vec![0.0_f64; mesh.cells()];
            for (k, (a, b)) in a.iter().zip(b).enumerate() {
                let (Some(a), Some(b)) = (a.samples.get(i), b.samples.get(j)) else { continue };
                let error = differ(a, b);
                along.position[k] = larger(along.position[k], error.x / length);
                along.curvature[k] = larger(along.curvature[k], error.curvature);
                difference.records[j] = larger(difference.records[j], error.x / length);
                if bends {
                    largest = largest.max(b.curvature.abs());
                    curvature = larger(curvature, error.curvature);
                }
                // The last station is the end.
                if k + 1 < s.len() {
                    let cell = k * mesh.cells() / (s.len() - 1);
                    let share = mesh.cells() as f64 / (s.len() - 1) as f64;
                    let width = share * (mesh.nodes[cell + 1] - mesh.nodes[cell]);
                    let value = if bends { error.curvature } else { error.angle / length };
                    now[cell] += width * value * value;
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
            difference.probes.iter_mut().for_each(|probe| probe.samples[j] = unknown(&probe.samples[j]));
        }
    } else {
        fill(&mut difference.records, &known, |a, b| larger(*a, *b));
        for probe in &mut difference.probes {
            fill(&mut probe.samples, &known, |a, b| if a.x >= b.x { *a } else { *b });
        }
    }
    let scale = lengths.iter().copied().fold(0.0, f64::max);
    difference.errors = Errors {
        result,
        curvature: (largest * scale > STRAIGHT).then(|| curvature / largest),
        section_force: section_forces(&coarse.last, &fine.last),
    };
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

/// Errors of which nothing is known.
fn unknown(like: &ProbeSample) -> ProbeSample {
    let nan = f64::NAN;
    let of = |v: Option<f64>| v.map(|_| nan);
    ProbeSample { x: nan, y: nan, angle: nan, curvature: nan, strain: nan, vx: of(like.vx), vy: of(like.vy) }
}

/// The largest difference of axial and shear forces, relative to the largest of both and of M/L,
/// and of bending moments, relative to the largest of these; `None` where nothing is loaded.
fn section_forces(coarse: &[Shape], fine: &[Shape]) -> Option<f64> {
    let kinds: [fn(&Shape) -> &Vec<f64>; 3] =
        [|shape| &shape.axial_force, |shape| &shape.shear_force, |shape| &shape.bending_moment];
    let error = |kind: fn(&Shape) -> &Vec<f64>| {
        let (mut largest, mut error) = (0.0_f64, 0.0_f64);
        for (a, b) in coarse.iter().zip(fine) {
            largest = kind(b).iter().fold(largest, |largest, value| largest.max(value.abs()));
            for (k, (s, value)) in a.s.iter().zip(kind(a)).enumerate() {
                let after = a.s.get(k + 1) != Some(s);
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
    (force > 0.0).then(|| {
        let bending = if m > STRAIGHT * force * length { bending / m } else { 0.0 };
        larger(larger(axial / force, shear / force), bending)
    })
}

/// The value at `s`; where a place is there twice, behind it with `after`.
fn interpolated(places: &[f64], values: &[f64], s: f64, after: bool) -> Option<f64> {
    let right = if after { places.partition_point(|p| *p <= s) } else { places.partition_point(|p| *p < s) };
    if after && right > 0 && places[right - 1] == s {
        return values.get(right - 1).copied();
    }
    if places.get(right) == Some(&s) {
        return values.get(right).copied();
    }
    let left = right.checked_sub(1)?;
    let (a, b) = (*places.get(left)?, *places.get(right)?);
    let part = (s - a) / (b - a);
    Some((1.0 - part) * values.get(left)? + part * values.get(right)?)
}

fn modes(model: &Model, meshes: &[Mesh], coarse: &Results, fine: &Results) -> Result<Difference, String> {
    let (a, b) = (coarse.eigenvalues(), fine.eigenvalues());
    if a.len() != b.len() || b.is_empty() {
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
        let of = |shape: &ModeShape, order: f64| {
            if order == 2.0 { shape.curvature.clone() } else { shape.angle.clone() }
        };
        // Signs are arbitrary, and one for the whole mode; so is the size.
        let (mut product, mut size, mut largest) = (0.0, 0.0, 0.0_f64);
        for (a, b) in a.iter().zip(b) {
            for (s, y) in b.s.iter().zip(&b.y) {
                product += y * interpolated(&a.s, &a.y, *s, false).unwrap_or(0.0);
            }
            for (s, x) in b.s.iter().zip(&b.x) {
                product += x * interpolated(&a.s, &a.x, *s, false).unwrap_or(0.0);
            }
        }
        for b in b {
            largest = b.x.iter().chain(&b.y).fold(largest, |most, value| most.max(value.abs()));
        }
        let sign = if product < 0.0 { -1.0 } else { 1.0 };
        let mut now: Vec<Vec<f64>> = cells.iter().map(|cells| vec![0.0; cells.squares.len()]).collect();
        for (((a, b), mesh), (cells, now)) in a.iter().zip(b).zip(meshes).zip(cells.iter().zip(&mut now)) {
            let (of_a, of_b) = (of(a, cells.order), of(b, cells.order));
            for (k, s) in b.s.windows(2).enumerate() {
                let middle = 0.5 * (s[0] + s[1]);
                let value = 0.5 * (of_b[k] + of_b[k + 1]);
                let Some(other) = interpolated(&a.s, &of_a, middle, false) else { continue };
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
        let error = |coarse: Shape| section_forces(&[coarse], &fine).unwrap();
        assert_eq!(error(shape([1.0, 6.0], [0.0, -4.0], [0.0, 10.0])), 0.25);
        assert_eq!(error(shape([1.0, 8.0], [0.0, -3.0], [0.0, 10.0])), 0.125);
        assert_eq!(error(shape([1.0, 8.0], [0.0, -4.0], [5.0, 10.0])), 0.5);
        assert_eq!(error(fine[0].clone()), 0.0);
        // Moments decide about forces where these are small.
        let bent = [shape([0.0, 0.0], [0.0, 1.0], [0.0, 20.0])];
        let other = shape([0.0, 0.5], [0.0, 1.0], [0.0, 20.0]);
        assert_eq!(section_forces(&[other], &bent), Some(0.05));
        let nothing = [shape([0.0; 2], [0.0; 2], [0.0; 2])];
        assert_eq!(section_forces(&nothing, &nothing), None);
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
