//! How far two outcomes are apart.

use super::outcome::{Line, Sample, Seen};

/// Differences between two outcomes of a scene, each relative to the size of the quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gap {
    /// Positions at probes and along beams \[natural lengths\], and eigenvalues \[of their size\]:
    /// the quantities to which a tolerance refers.
    pub places: f64,
    /// Eigenvalues alone.
    pub eigenvalues: f64,
    /// Section forces and reactions, relative to the largest force.
    pub forces: f64,
    /// The largest of all differences.
    pub all: Largest,
    /// The largest of what follows from positions: forces, strains, directions, velocities, energies.
    pub derived: f64,
    /// The largest of times of records and of events.
    pub times: Largest,
    /// Whether one of both has more events, where all records are compared.
    pub events: bool,
}

/// The largest of some differences, and the quantity that has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Largest {
    pub value: f64,
    pub what: String,
}

impl Largest {
    fn note(&mut self, what: &str, value: f64) {
        // NaN counts as the largest difference.
        if value.is_nan() || value > self.value {
            *self = Self { value, what: what.to_owned() };
        }
    }
}

impl Gap {
    fn note(&mut self, what: &str, difference: f64, size: f64) {
        let relative = if difference == 0.0 { 0.0 } else { difference / size };
        larger(&mut self.derived, relative);
        self.all.note(what, relative);
    }

    fn time(&mut self, what: &str, difference: f64, end: f64) {
        self.times.note(what, difference / end);
        self.all.note(what, difference / end);
    }

    fn place(&mut self, what: &str, difference: f64) {
        larger(&mut self.places, difference);
        self.all.note(what, difference);
    }

    fn force(&mut self, what: &str, difference: f64, size: f64) {
        larger(&mut self.forces, difference / size);
        self.note(what, difference, size);
    }
}

/// Keeps the larger of two; what is no number is the largest.
fn larger(kept: &mut f64, other: f64) {
    if other.is_nan() || other > *kept {
        *kept = other;
    }
}

/// Which records are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Records {
    /// All; both runs must have as many.
    All,
    /// Those at the same times, and the last.
    Common,
    /// The last.
    Last,
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Compares two outcomes, and their stages, if both have as many.
pub fn between(a: &Seen, b: &Seen, records: Records) -> Gap {
    let mut gap = Gap::default();
    // The records of statics are chosen by the solver.
    let of_stages = |seen: &Seen| if seen.moves { records } else { Records::Last };
    let staged = !a.before.is_empty() && a.before.len() == b.before.len();
    for (i, (a, b)) in a.before.iter().zip(&b.before).enumerate().filter(|_| staged) {
        let stage = between(a, b, of_stages(a));
        for (all, of_stage) in [(&mut gap.all, &stage.all), (&mut gap.times, &stage.times)] {
            all.note(&format!("{} in stage {}", of_stage.what, i + 1), of_stage.value);
        }
        gap.events |= stage.events;
        larger(&mut gap.places, stage.places);
        larger(&mut gap.eigenvalues, stage.eigenvalues);
        larger(&mut gap.forces, stage.forces);
        larger(&mut gap.derived, stage.derived);
    }
    let records = if a.before.is_empty() { records } else { of_stages(a) };
    one(a, b, records, &mut gap);
    gap
}

fn one(a: &Seen, b: &Seen, records: Records, gap: &mut Gap) {
    let pairs = match records {
        Records::All if a.parameter.len() != b.parameter.len() => {
            let n = a.parameter.len().abs_diff(b.parameter.len());
            gap.time("number of records", n as f64, a.parameter.len().max(1) as f64);
            last(a, b)
        }
        Records::All => (0..a.parameter.len()).map(|i| (i, i)).collect(),
        Records::Common => common(a, b),
        Records::Last => last(a, b),
    };
    let end = a.parameter.last().map_or(1.0, |p| p.abs().max(1e-300));
    for &(i, j) in &pairs {
        gap.time("load factor or time of a record", (a.parameter[i] - b.parameter[j]).abs(), end);
    }
    probes(a, b, &pairs, gap);
    energies(a, b, &pairs, gap);
    lines(a, b, gap);
    eigenvalues(a, b, gap);
    if a.events.len() == b.events.len() {
        for (s, t) in a.events.iter().zip(&b.events) {
            gap.time("time of an event", (s - t).abs(), end);
        }
    } else {
        gap.events |= records == Records::All;
    }
}

/// The largest difference of two last states, in lengths of the beam, or of eigenvalues, relative.
pub fn of_last(a: &Seen, b: &Seen) -> f64 {
    if !a.eigenvalues.is_empty() {
        let pairs = a.eigenvalues.iter().zip(&b.eigenvalues);
        return pairs.filter(|(f, g)| f != g).fold(0.0, |m, (f, g)| m.max((f - g).abs() / g.abs()));
    }
    let of = |(a, b): (&Line, &Line)| {
        let length: f64 = b.places.windows(2).map(|pair| apart(pair[0], pair[1])).sum();
        a.places.iter().zip(&b.places).map(|(p, q)| apart(*p, *q)).fold(0.0, f64::max) / length
    };
    a.beams.iter().zip(&b.beams).map(of).fold(0.0, f64::max)
}

fn last(a: &Seen, b: &Seen) -> Vec<(usize, usize)> {
    a.parameter.len().checked_sub(1).zip(b.parameter.len().checked_sub(1)).into_iter().collect()
}

fn common(a: &Seen, b: &Seen) -> Vec<(usize, usize)> {
    let end = a.parameter.last().copied().unwrap_or(1.0);
    let same = |i: usize| {
        let j = b.parameter.iter().position(|p| (p - a.parameter[i]).abs() <= 1e-9 * end)?;
        Some((i, j))
    };
    let mut pairs: Vec<_> = (0..a.parameter.len()).filter_map(same).collect();
    if pairs.is_empty() {
        pairs = last(a, b);
    }
    pairs
}

fn probes(a: &Seen, b: &Seen, pairs: &[(usize, usize)], gap: &mut Gap) {
    let largest = |of: &dyn Fn(&Sample) -> f64, least: f64| {
        let samples = a.probes.iter().flatten().chain(b.probes.iter().flatten());
        samples.fold(least, |m, s| m.max(of(s).abs()))
    };
    let curvature = largest(&|s| s.curvature, 1.0);
    let strain = largest(&|s| s.strain, 1e-3);
    let velocity = largest(&|s| s.velocity[0].hypot(s.velocity[1]), 1e-3);
    for (p, q) in a.probes.iter().zip(&b.probes) {
        for &(i, j) in pairs {
            let (Some(p), Some(q)) = (p.get(i), q.get(j)) else { continue };
            gap.place("position of a probe", apart(p.place, q.place));
            // Where nothing resists a turn, a state without loads has any direction; and one of half a turn has two.
            let turned = (p.angle - q.angle).abs().min((p.direction - q.direction).abs());
            gap.note("angle at a probe", turned, 1.0);
            gap.note("curvature at a probe", (p.curvature - q.curvature).abs(), curvature);
            gap.note("strain at a probe", (p.strain - q.strain).abs(), strain);
            gap.note("velocity of a probe", apart(p.velocity, q.velocity), velocity);
        }
    }
}

fn energies(a: &Seen, b: &Seen, pairs: &[(usize, usize)], gap: &mut Gap) {
    let (Some(first), Some(other)) = (a.energy.first(), b.energy.first()) else { return };
    let change = |e: &[f64; 7], first: &[f64; 7]| {
        let mut change = *e;
        // The zero of the potential may differ.
        change[4] -= first[4];
        change
    };
    let all = a.energy.iter().map(|e| change(e, first)).chain(b.energy.iter().map(|e| change(e, other)));
    let size = all.flatten().fold(1e-9_f64, |m, e| m.max(e.abs()));
    let names = ["stretch", "bend", "stored", "kinetic", "potential", "work", "lost"];
    for &(i, j) in pairs {
        let (Some(e), Some(f)) = (a.energy.get(i), b.energy.get(j)) else { continue };
        let (e, f) = (change(e, first), change(f, other));
        for (name, (e, f)) in names.iter().zip(e.iter().zip(f)) {
            gap.note(&format!("energy, {name}"), (e - f).abs(), size);
        }
    }
}

fn lines(a: &Seen, b: &Seen, gap: &mut Gap) {
    if a.beams.len() != b.beams.len() {
        return;
    }
    let force = force_size(a).max(force_size(b));
    for (a, b) in a.beams.iter().zip(&b.beams) {
        if a.places.len() != b.places.len() {
            continue;
        }
        for (p, q) in a.places.iter().zip(&b.places) {
            gap.place("shape of a beam", apart(*p, *q));
        }
        for (f, g) in a.forces.iter().zip(&b.forces) {
            for (name, (f, g)) in ["N", "Q", "M"].iter().zip(f.iter().zip(g)) {
                gap.force(&format!("section force {name}"), (f - g).abs(), force);
            }
        }
    }
    for ((name, r), (_, s)) in a.reactions.iter().zip(&b.reactions) {
        for (r, s) in r.iter().zip(s) {
            gap.force(&format!("reaction of {name}"), (r - s).abs(), force);
        }
    }
}

/// The largest force or couple of a scene \[EI/L²\].
pub fn force_size(seen: &Seen) -> f64 {
    let sections = seen.beams.iter().flat_map(|beam| &beam.forces).flatten();
    let reactions = seen.reactions.iter().flat_map(|(_, r)| r);
    sections.chain(reactions).fold(seen.effects.1.max(1e-2), |m, f| m.max(f.abs()))
}

fn eigenvalues(a: &Seen, b: &Seen, gap: &mut Gap) {
    let n = a.eigenvalues.len().min(b.eigenvalues.len());
    let smallest = a.eigenvalues.iter().copied().map(f64::abs).find(|f| *f > 1e-3).unwrap_or(1.0);
    for (f, g) in a.eigenvalues[..n].iter().zip(&b.eigenvalues[..n]) {
        let difference = (f - g).abs() / f.abs().max(smallest);
        larger(&mut gap.eigenvalues, difference);
        gap.place("an eigenvalue", difference);
    }
    if n == 0 && a.eigenvalues.len() != b.eigenvalues.len() {
        gap.eigenvalues = 1.0;
        gap.place("number of eigenvalues", 1.0);
    }
}
