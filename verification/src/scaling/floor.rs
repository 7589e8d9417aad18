//! What a step must at least cost: the bytes that it moves and the operations that it does, beside
//! what one thread of this machine moves and does at best.
//!
//! Counted is a step of generalised-α with a kept tangent, a beam without loads that vary. All
//! numbers have 8 bytes; a node has four in a vector, and 16 in a block of a matrix. Where a
//! vector is written that is not in a cache, its memory is read first, which counts as well. Of
//! multiplications with an addition each counts as two operations; a division or a root as one.

use std::hint::black_box;
use std::time::Instant;

use ancf::model::{Beam, Discretization};
use serde::{Deserialize, Serialize};

/// Numbers in each of the arrays of the stream: more than caches hold.
const STREAM: usize = 8 << 20;
/// Repetitions, of which the fastest counts.
const REPEAT: usize = 7;
/// Registers of four numbers whose additions do not wait for each other.
const REGISTERS: usize = 12;
/// Multiply–adds of each register in one repetition.
const DEEP: usize = 2_000_000;

/// What one thread of a machine does at best.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub struct Machine {
    /// Bytes a second between memory and processor.
    pub bytes: f64,
    /// Operations a second on numbers in registers.
    pub operations: f64,
}

impl Machine {
    /// Measures both.
    pub fn measure() -> Self {
        Self { bytes: stream(), operations: peak() }
    }
}

/// Bytes a second of a_i = b_i + s c_i.
fn stream() -> f64 {
    let (mut a, b, c) = (vec![0.0; STREAM], vec![1.0; STREAM], vec![2.0; STREAM]);
    let mut best = f64::INFINITY;
    for k in 0..REPEAT {
        let (s, clock) = (black_box(k as f64), Instant::now());
        for ((a, b), c) in a.iter_mut().zip(&b).zip(&c) {
            *a = s.mul_add(*c, *b);
        }
        black_box(&mut a);
        best = best.min(clock.elapsed().as_secs_f64());
    }
    // Read b and c, and a before it is written.
    (4 * size_of::<f64>() * STREAM) as f64 / best
}

/// Operations a second of multiply–adds in registers.
fn peak() -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..REPEAT {
        let mut sums = black_box([[0.5_f64; 4]; REGISTERS]);
        let (factor, add) = (black_box([0.999_f64; 4]), black_box([1e-3_f64; 4]));
        let clock = Instant::now();
        for _ in 0..DEEP {
            for sum in &mut sums {
                for lane in 0..4 {
                    sum[lane] = sum[lane].mul_add(factor[lane], add[lane]);
                }
            }
        }
        black_box(sums);
        best = best.min(clock.elapsed().as_secs_f64());
    }
    (2 * 4 * REGISTERS * DEEP) as f64 / best
}

/// What an iteration and the rest of a step take per node.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Work {
    /// Of an iteration.
    pub iteration: Count,
    /// Of the rest of a step.
    pub rest: Count,
}

/// A number of bytes and of operations per node.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Count {
    /// Bytes between memory and processor, if no cache holds anything.
    pub bytes: f64,
    /// Operations.
    pub operations: f64,
}

impl Work {
    /// Of a step with so many iterations.
    pub fn step(&self, iterations: f64) -> Count {
        let sum = |iteration: f64, rest: f64| iterations * iteration + rest;
        Count {
            bytes: sum(self.iteration.bytes, self.rest.bytes),
            operations: sum(self.iteration.operations, self.rest.operations),
        }
    }
}

/// Passes over a vector (v), or over other numbers of a node: read, written where they have just
/// been read, and written alone.
fn passes(read: usize, changed: usize, written: usize) -> f64 {
    // What is written alone is read first.
    (8 * (read + 2 * changed + 2 * written)) as f64
}

/// The work per node of a beam. `None` where its discretisation is not known.
pub fn work(beam: &Beam) -> Option<Work> {
    let points = beam.gauss_points;
    // Shape functions of a cell, and nodes ahead with which a node is coupled.
    let (width, ahead) = match &beam.discretization {
        Discretization::Ancf { .. } => (4, 1),
        Discretization::Rpim { neighbours, .. } => (4 * (1 + neighbours), 1 + 2 * neighbours),
        _ => return None,
    };
    let v = 4;
    let bytes = [
        passes(v, 0, v),                       // the constant load
        passes(v, v, 0),                       // forces of strain: q, f
        passes(v, v, 0),                       // forces of curvature
        passes(2 * v + 4 * (ahead + 1), v, 0), // inertia: q, the acceleration's rest, M
        passes(2, v, 0),                       // turned back
        passes(16 * (ahead + 1), v, 0),        // forward substitution
        passes(16 * ahead, v, 0),              // backward substitution
        passes(2, 2 * v, 0),                   // turned forth, added
    ];
    // Per point: fields from shape functions and forces on coefficients, 4 operations per shape
    // function and derivative each, and the law between them.
    let stretch = points.stretch * (8 * width + 14);
    let bend = points.bend * (2 * 8 * width + 34);
    let inertia = 16 * (2 * ahead + 1) + 8;
    let substitution = 32 * (2 * ahead + 1);
    let turns = 2 * 12 + 8;
    Some(Work {
        iteration: Count {
            bytes: bytes.iter().sum(),
            operations: (stretch + bend + inertia + substitution + turns) as f64,
        },
        rest: Count {
            // Prediction; its copy and size; the turns; positions, velocities and accelerations.
            bytes: passes(5 * v, 0, 2 * v)
                + passes(v, 0, v)
                + passes(2 * v, 0, 0)
                + passes(2 * v, 0, 2)
                + passes(5 * v, 0, 4 * v),
            operations: (v * (12 + 4 + 12) + 12) as f64,
        },
    })
}
