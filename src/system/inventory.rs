//! Inventory of the parts of a system.

use super::System;
use super::measure::Measured;
use crate::assembly::Kind;
use crate::linear::condensed::serves;
use crate::linear::interleaved::fits;
use crate::linear::{Matrix, chain};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The parts of a system: effects with their tables, unknowns, matrix.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Inventory {
    /// Effects that were built, by beam.
    pub effects: Vec<EffectEntry>,
    /// Kinds of effects that exist but that this system does not contain.
    pub absent: Vec<Kind>,
    /// The beams, with the size and quality of their discretisations.
    pub beams: Vec<BeamEntry>,
    /// Number of unknowns: coordinates that are not eliminated, plus multipliers.
    pub degrees_of_freedom: usize,
    /// Number of coordinates, including fixed ones.
    pub coordinates: usize,
    /// Number of coordinates eliminated by supports at nodes.
    pub fixed: usize,
    /// Number of multipliers of supports between nodes, joints and inextensible beams.
    pub multipliers: usize,
    /// Whether the tangent is symmetric.
    pub symmetric: bool,
    /// Number of diagonals on either side of the main one.
    pub half_bandwidth: usize,
    /// The factorisation that follows from the pattern.
    pub solver: &'static str,
    /// Bytes of one tangent.
    pub matrix_bytes: usize,
    /// Bytes of the mass matrix; 0 where there is none.
    pub mass_bytes: usize,
    /// Bytes of the damping matrix; 0 where there is none.
    pub damping_bytes: usize,
    /// Times of the linear algebra, if they were measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
}

/// An effect on a beam.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EffectEntry {
    /// The kind of effect.
    pub kind: Kind,
    /// The beam's name.
    pub beam: String,
    /// Number of quadrature points.
    pub points: usize,
    /// Bytes of tables and data.
    pub bytes: usize,
    /// Time of one evaluation with its tangent \[s\], if it was measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
}

/// A discretised beam.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BeamEntry {
    /// The beam's name.
    pub name: String,
    /// Number of nodes.
    pub nodes: usize,
    /// Length \[m\].
    pub length: f64,
    /// Arc lengths between the ends at which nodes were placed because a support, a joint or a
    /// couple acts on the beam there \[m\].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub breaks: Vec<f64>,
    /// Number of shape functions that are different from zero at a point.
    pub width: usize,
    /// Number of distinct cells, for which shape functions were computed.
    pub distinct_cells: usize,
    /// Bits of the arithmetic in which shape functions were computed; 53 for explicit formulas.
    pub bits: usize,
}

impl System {
    /// Lists the parts of the system.
    pub fn inventory(&self) -> Inventory {
        let mut entries: BTreeMap<(usize, Kind), (usize, usize)> = BTreeMap::new();
        let loads = self.terms.loads.iter().map(|load| &load.effect);
        let effects = self.terms.internal.iter().chain(&self.terms.inertia).chain(loads);
        let effects = effects.map(|effect| (effect.beam(), effect.kind(), effect.size()));
        let turning = self.terms.turning.iter().map(|turning| &turning.momentum);
        let damping = self
            .terms
            .damping
            .iter()
            .chain(turning)
            .map(|damping| (damping.beam(), damping.kind(), damping.size()));
        let timed = self.terms.timed_loads.iter().map(|load| (load.beam(), load.kind(), load.size()));
        let friction =
            self.terms.friction.iter().map(|friction| (friction.beam(), Kind::Friction, friction.size()));
        let lengths = self.lengths().map(|(beam, bytes)| (beam, Kind::Inextensibility, (1, bytes)));
        let held = self.terms.held.iter().map(|length| (length.beam(), Kind::Tendon, length.size()));
        for (beam, kind, (points, bytes)) in
            effects.chain(damping).chain(timed).chain(friction).chain(lengths).chain(held)
        {
            let entry = entries.entry((beam, kind)).or_default();
            entry.0 += points;
            entry.1 += bytes;
        }
        let absent =
            Kind::ALL.iter().copied().filter(|kind| !entries.keys().any(|(_, k)| k == kind)).collect();
        let effects = entries
            .into_iter()
            .map(|((beam, kind), (points, bytes))| EffectEntry {
                kind,
                beam: self.beams[beam].name.clone(),
                points,
                bytes,
                seconds: None,
            })
            .collect();
        let beams = self
            .beams
            .iter()
            .map(|part| {
                let defects = part.basis.defects();
                BeamEntry {
                    name: part.name.clone(),
                    nodes: part.basis.nodes().len(),
                    length: part.basis.length(),
                    breaks: part.basis.breaks().collect(),
                    width: part.basis.width(),
                    distinct_cells: defects.distinct_cells,
                    bits: defects.bits,
                }
            })
            .collect();
        let symmetric = self.is_symmetric();
        let (matrix, border) = (self.matrix(), self.border(0.0, &self.reference));
        Inventory {
            effects,
            absent,
            beams,
            degrees_of_freedom: self.degrees_of_freedom(),
            coordinates: self.coordinates(),
            fixed: self.supports.count(),
            multipliers: self.multipliers(),
            symmetric,
            half_bandwidth: 4 * self.blocks - 1,
            solver: match (self.multipliers() == 0, symmetric) {
                (false, true) if !self.terms.inertia.is_empty() && serves(&matrix, &border) => {
                    "banded LDLᵀ, constraints condensed"
                }
                (false, true) if matches!(&matrix, Matrix::Symmetric(k) if chain::fits(k, &border)) => {
                    "banded LDLᵀ, constraints among the unknowns"
                }
                (false, _) if fits(&matrix, &border) => "banded LU, constraints among the unknowns",
                (false, true) => "sparse LDLᵀ (faer)",
                (false, false) => "sparse LU (faer)",
                (true, true) => "banded LDLᵀ",
                (true, false) => "banded LU",
            },
            matrix_bytes: matrix.bytes(),
            mass_bytes: if self.terms.inertia.is_empty() { 0 } else { self.damping_pattern().bytes() },
            damping_bytes: if self.terms.damping.is_empty() { 0 } else { self.damping_pattern().bytes() },
            measured: None,
        }
    }
}

fn size(bytes: usize) -> String {
    match bytes {
        0..10_000 => format!("{bytes} B"),
        10_000..10_000_000 => format!("{} kB", bytes / 1000),
        _ => format!("{} MB", bytes / 1_000_000),
    }
}

impl fmt::Display for Inventory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for beam in &self.beams {
            writeln!(
                f,
                "beam {:<16} {} nodes, {} m, {} functions a point, {} distinct cells solved with {} bits",
                beam.name, beam.nodes, beam.length, beam.width, beam.distinct_cells, beam.bits
            )?;
            if !beam.breaks.is_empty() {
                let places: Vec<String> = beam.breaks.iter().map(|s| format!("{s:.6}")).collect();
                let at = "nodes put, and shape functions ended, where something holds, joins or turns it, or its section jumps: s =";
                writeln!(f, "beam {:<16} {at} {} m", beam.name, places.join(", "))?;
            }
        }
        let share = |seconds: f64| match &self.measured {
            Some(measured) => {
                format!(" {:>9.2} µs {:>3.0} %", 1e6 * seconds, 100.0 * seconds / measured.iteration)
            }
            None => String::new(),
        };
        for effect in &self.effects {
            let kind = effect.kind.name();
            writeln!(
                f,
                "effect {kind:<18} {:<16} {:>8} points {:>10}{}",
                effect.beam,
                effect.points,
                size(effect.bytes),
                effect.seconds.map(share).unwrap_or_default()
            )?;
        }
        if let Some(measured) = &self.measured {
            let line = |what: &str, seconds: f64| format!("solver {what:<53}{}", share(seconds));
            writeln!(f, "{}", line("factorisation", measured.factorization))?;
            writeln!(f, "{}", line("substitution", measured.substitution))?;
        }
        let absent: Vec<_> = self.absent.iter().map(|kind| kind.name()).collect();
        writeln!(f, "absent: {}", if absent.is_empty() { "nothing".into() } else { absent.join(", ") })?;
        writeln!(
            f,
            "unknowns: {} ({} coordinates, {} held, {} multipliers)",
            self.degrees_of_freedom, self.coordinates, self.fixed, self.multipliers
        )?;
        for (what, bytes) in [("mass", self.mass_bytes), ("damping", self.damping_bytes)] {
            if bytes > 0 {
                writeln!(f, "{what} matrix: {}", size(bytes))?;
            }
        }
        write!(
            f,
            "tangent: {}, half bandwidth {}, {}, {}",
            if self.symmetric { "symmetric" } else { "not symmetric" },
            self.half_bandwidth,
            size(self.matrix_bytes),
            self.solver
        )
    }
}
