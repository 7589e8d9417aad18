//! Laws of time in a system: the times at which they are not smooth, and the parts of them that a
//! method of integration misses.
//!
//! A method evaluates loads and supports at a few times of a step, and takes them to be
//! interpolated between these. The error of this is known exactly, because a law does not depend on
//! the motion: each law has a mean over the step and a first moment ([`crate::law::Law::moments`]).
//! The differences between these and the values that the method uses are the changes of velocity
//! and position that it misses, however fast a law oscillates compared with the step.

use super::System;
use crate::assembly::ActingLoad;
use crate::law::Law;

/// A time at which a method evaluates loads, with its weights in the mean over the step and in the
/// first moment.
pub type LoadSample = (f64, [f64; 2]);

/// Changes of a load that are larger than its median change by this factor are sudden.
const SUDDEN: f64 = 8.0;
/// Steps into which a sudden change is divided.
const PIECES: usize = 16;
/// Where between two times laws are looked at, too.
const BETWEEN: f64 = 0.382;
/// Changes of a load, relative to its size, that count as none.
const NOTHING: f64 = 1e-9;

fn law(load: &ActingLoad) -> Option<&Law> {
    load.amplitude.as_ref()?.law()
}

/// Mean and first moment of `f` as the method computes them from its samples `looks`.
fn seen(looks: &[LoadSample], f: impl Fn(f64) -> f64) -> [f64; 2] {
    looks.iter().fold([0.0; 2], |[mean, moment], (time, [a, b])| {
        let f = f(*time);
        [mean + a * f, moment + b * f]
    })
}

impl System {
    /// The laws of time of loads, supports and tendons of given length.
    pub fn laws(&self) -> impl Iterator<Item = &Law> {
        let lengths = self.terms.held.iter().filter_map(|length| length.amplitude.as_ref()?.law());
        self.terms.loads.iter().filter_map(law).chain(self.supports.laws()).chain(lengths)
    }

    /// Times at which a load or the motion of a support is not smooth, in no particular order.
    pub fn kinks(&self) -> Vec<f64> {
        let timed = self.terms.timed_loads.iter().flat_map(|load| load.kinks());
        self.laws().flat_map(Law::kinks).chain(timed).collect()
    }

    /// Times at which steps of a fixed length should also end ([`Law::short_changes`]); in no particular order.
    pub fn short_changes(&self, step: f64) -> Vec<f64> {
        self.laws().flat_map(|law| law.short_changes(step)).collect()
    }

    /// Times between `start` and `end` at which steps should end, so that they see what laws do that
    /// nobody knows beforehand: those that are no farther than `near` from another one of the same law
    /// ([`Law::turns`]); in no particular order.
    pub fn turns_of_laws(&self, [start, end]: [f64; 2], near: f64) -> Vec<f64> {
        self.laws().flat_map(|law| law.turns([start, end], near)).collect()
    }

    /// Times between `start` and `end` at which steps should end, because loads with formulas of place
    /// and time change suddenly on beams that fly on as they do in the state (q, v): where such a change
    /// begins, or, if it begins at the start, some until it ends. The time is looked at in as many
    /// `parts`.
    pub fn sudden_changes(&self, [start, end]: [f64; 2], state: [&[f64]; 2], parts: usize) -> Vec<f64> {
        let loads = &self.terms.timed_loads;
        let mut changes = vec![0.0; if loads.is_empty() { 0 } else { parts }];
        let size: f64 = loads.iter().map(|load| load.add_changes([start, end], state, &mut changes)).sum();
        let mut sorted = changes.clone();
        sorted.sort_by(f64::total_cmp);
        let level = SUDDEN.mul_add(sorted.get(parts / 2).copied().unwrap_or(0.0), NOTHING * size);
        let time = |part: usize| start + (end - start) * part as f64 / parts as f64;
        match changes.iter().position(|change| *change > level) {
            Some(0) => {
                let last = changes.iter().position(|change| *change <= level).unwrap_or(0);
                let piece = (time(last) - start) / PIECES as f64;
                let ends = (1..=PIECES).map(|pieces| piece.mul_add(pieces as f64, start));
                ends.filter(|end| *end > start).collect()
            }
            begins => begins.map(time).into_iter().collect(),
        }
    }

    /// The first of the rising `times` \[s\] from which on no load, support or tendon changes by its law; `None` where one does to the
    /// last, or has a formula of place and time.
    pub fn steady_from(&self, times: &[f64]) -> Option<usize> {
        if !self.terms.timed_loads.is_empty() {
            return None;
        }
        let steady = |law: &Law| {
            let looks: Vec<[f64; 2]> = times
                .windows(2)
                .map(|pair| {
                    // Between times that are evenly spread laws are looked at unevenly, so that a period hides in none.
                    let between = pair[0] + BETWEEN * (pair[1] - pair[0]);
                    [pair[0], between].map(|time| law.at(time)[0])
                })
                .collect();
            let end = law.at(*times.last()?)[0];
            let size = looks.iter().flatten().fold(end.abs(), |most, value| most.max(value.abs()));
            let changes = |look: &[f64; 2]| look.iter().any(|value| (value - end).abs() > NOTHING * size);
            Some(looks.iter().rposition(changes).map_or(0, |last| last + 1))
        };
        self.laws().map(steady).try_fold(0, |latest, from| Some(latest.max(from?)))
    }

    /// Whether a load follows a law of time, moves along a beam, or has a formula of time.
    pub fn loads_follow_time(&self) -> bool {
        !self.terms.timed_loads.is_empty() || self.terms.loads.iter().any(|load| law(load).is_some())
    }

    /// Adds to `mean` and `moment` those of the loads from `start` to `end` in the state `q`, less
    /// the values that the method computes from its samples `looks`. `scratch` is overwritten.
    pub fn add_unseen_loads(
        &self,
        [start, end]: [f64; 2],
        looks: &[LoadSample],
        q: &[f64],
        [mean, moment]: [&mut [f64]; 2],
        scratch: &mut [f64],
    ) {
        let following = self.terms.loads.iter().filter_map(|load| Some((load, law(load)?)));
        for (load, law) in following {
            let seen = seen(looks, |time| law.at(time)[0]);
            let unseen = law.moments(start, end);
            scratch.fill(0.0);
            load.effect.add_force(1.0, q, scratch);
            for (i, force) in scratch.iter().enumerate() {
                mean[i] += (unseen[0] - seen[0]) * force;
                moment[i] += (unseen[1] - seen[1]) * force;
            }
        }
        for load in &self.terms.timed_loads {
            load.add_moments([start, end], q, [mean, moment]);
            for (time, [a, b]) in looks {
                load.add_force(-a, *time, q, mean);
                load.add_force(-b, *time, q, moment);
            }
        }
    }

    /// The largest difference between the motions of supports from `start` to `end` and those that
    /// a method computes from their accelerations at its samples `looks`; positions in beam
    /// lengths, angles in rad.
    pub fn unseen_motion(&self, [start, end]: [f64; 2], looks: &[LoadSample]) -> f64 {
        let h = end - start;
        let miss = |(course, unit): (&super::prescribed::Prescribed, f64)| {
            let ([u0, v0, _], [u1, v1, _]) = (course.prescribed(start), course.prescribed(end));
            let [mean, moment] = seen(looks, |time| h * h * course.prescribed(time)[2]);
            let misses = [h * (v1 - v0) - mean, (u1 - u0) - h * v0 - moment];
            misses.into_iter().fold(0.0_f64, |m, miss| m.max((unit * miss).abs()))
        };
        self.supports.moving(1.0 / self.length()).map(miss).fold(0.0, f64::max)
    }
}
