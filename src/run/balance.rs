//! What the strains and curvatures of shape functions are off those of the forces that balance the loads.
//!
//! The axial force N and the bending moment M of a shape balance what acts on a beam before the cut, and are as accurate as
//! its positions. They belong to a strain and a curvature
//!
//! ```text
//! ε = (EI N − EB M)/(EA EI − EB²),   κ = κ₀ + (EA M − EB N)/(EA EI − EB²)
//! ```
//!
//! with the curvature κ₀ of the curve along which the beam is laid out, and with what [actuation](System::imposed) takes from N and M added to
//! them. Those of the shape functions, which are derivatives, differ from these by their own error, and moments, which forces make with
//! positions as levers, by what those are off; of taut beams this is all there is. The energy of the difference is that by which a beam is too stiff (W. Prager and J. L. Synge, Quarterly of Applied Mathematics 5,
//! 1947), so that one run tells whether its cells are too few.

use crate::basis::Basis;
use crate::centreline::Curve;
use crate::effect::BeamDamping;
use crate::model::{Beam, Model, StrainMeasure};
use crate::results::Shape;
use crate::results::places::{is_before, same_place};
use crate::system::{System, View};
use std::any::Any;

/// Part of the bending energy of a beam that what its curvature is off may have …
const TOLERATED: f64 = 0.005;
/// … and of its whole energy: a little bending of what is taut, or of what moves like a rigid body, moves nothing.
const IRRELEVANT: f64 = 1e-3;
/// In a motion a mean cell may turn by so much too much or too little \[rad\]: a load that begins suddenly excites waves that are shorter than any
/// cells, which spoil the curvature and hardly the positions.
const TOLERATED_TURN: f64 = 0.01;
/// Turns of a beam below this are round-off \[rad\].
const SLIGHT: f64 = 1e-9;
/// Where the axial force is more than so many times EI/h², with cells of the length h, a beam is a string but for layers within cells. What its
/// moment is off there, divided by the axial force, is by how much its axis is off …
const TAUT: f64 = 30.0;
/// … of which this part of its length is tolerated.
const TOLERATED_SAG: f64 = 0.005;

/// A beam without stress, at the places of a shape.
pub(crate) struct StressFree {
    /// \[1/m\].
    curvature: Vec<f64>,
    /// By how much what is imposed lowers the axial force \[N\] and the bending moment \[N m\].
    taken: Vec<[f64; 2]>,
    /// Arc lengths at which these jump \[m\].
    jumps: Vec<f64>,
}

impl StressFree {
    /// The curve along which a beam is laid out, if nothing is imposed on it.
    pub fn curve(beam: &Beam, shape: &Shape) -> Option<Self> {
        let curve = Curve::new(&beam.centreline).ok()?;
        let curvature = shape.s.iter().map(|s| curve.curvature(*s)).collect();
        Some(Self { curvature, taken: vec![[0.0; 2]; shape.s.len()], jumps: Vec::new() })
    }

    /// What shape functions make of that curve, which has no stress although it may be off the curve, and what is imposed at a load factor or a time.
    fn of(model: &Model, system: &System, (index, shape): (usize, &Shape), parameter: f64) -> Option<Self> {
        let part = system.beams().get(index)?;
        let curvature = if part.straight {
            vec![0.0; shape.s.len()]
        } else {
            let view = View::points(&part.basis, part.offset(), &shape.s).ok()?;
            view.all(system.reference()).map(|fields| fields.curvature()).collect()
        };
        let taken = |s: &f64| system.imposed(index, *s, *s, parameter).map(|parts| parts.iter().sum());
        let imposed = model.parts.iter().filter_map(|part| part.actuation(index));
        let jumps = imposed.flat_map(|of| [of.strain.jumps(), of.curvature.jumps()]).flatten();
        Some(Self { curvature, taken: shape.s.iter().map(taken).collect(), jumps: jumps.collect() })
    }
}

/// What a shape is off at each of its places: what its shape functions have less what belongs to its forces, and nothing where something
/// jumps, which the strain there is a compromise of.
pub(crate) struct OffBalance {
    pub strain: Vec<f64>,
    /// \[1/m\].
    pub curvature: Vec<f64>,
}

impl OffBalance {
    /// `None` where forces do not tell strains: of elastic laws, and where the forces are not known.
    pub fn of(beam: &Beam, shape: &Shape, stress_free: &StressFree) -> Option<Self> {
        let section = &beam.section;
        let curve = Curve::new(&beam.centreline).ok()?;
        let given =
            [&shape.axial_force, &shape.bending_moment].iter().all(|along| along.len() == shape.s.len());
        if !section.is_linear() || !given {
            return None;
        }
        let jumps: Vec<f64> = curve
            .kinks()
            .into_iter()
            .chain(section.breaks())
            .chain(stress_free.jumps.iter().copied())
            .collect();
        let mut off = Self { strain: Vec::new(), curvature: Vec::new() };
        for (k, &s) in shape.s.iter().enumerate() {
            let is_twice = is_before(&shape.s, k) || k.checked_sub(1).is_some_and(|k| is_before(&shape.s, k));
            let jumps = is_twice || jumps.iter().any(|at| (at - s).abs() <= same_place(&shape.s));
            let inside = 0.5 * curve.length();
            let [axial, bending, coupling] =
                [&section.axial_stiffness, &section.bending_stiffness, &section.coupling]
                    .map(|along| along.as_ref().map(|along| along.at(s, inside)));
            // N is the derivative of the energy by |r'|.
            let by_stretch = match beam.strain {
                StrainMeasure::Green => beam.strain.stretch(shape.strain[k]),
                StrainMeasure::Engineering => 1.0,
            };
            let [taken, taken_moment] = stress_free.taken[k];
            let [n, m] = [shape.axial_force[k] / by_stretch + taken, shape.bending_moment[k] + taken_moment];
            let [strain, bend] = match (axial, bending, coupling) {
                _ if jumps => [None; 2],
                (Some(ea), Some(ei), Some(eb)) => {
                    let both = ea * ei - eb * eb;
                    [Some((ei * n - eb * m) / both), Some((ea * m - eb * n) / both)]
                }
                (ea, ei, _) => [ea.map(|ea| n / ea), ei.map(|ei| m / ei)],
            };
            off.strain.push(strain.map_or(0.0, |strain| shape.strain[k] - strain));
            off.curvature
                .push(bend.map_or(0.0, |bend| shape.curvature[k] - (stress_free.curvature[k] + bend)));
        }
        Some(off)
    }
}

/// Twice the energies of a beam \[N m\], how far it turns \[rad\], and by how much its axis is off where it is taut \[m\].
struct Energies {
    off: f64,
    bend: f64,
    stretch: f64,
    turn: f64,
    sag: f64,
}

impl Energies {
    /// `None` where they are not known.
    fn of(beam: &Beam, basis: &Basis, shape: &Shape, stress_free: &StressFree) -> Option<Self> {
        let bending = beam.section.bending_stiffness.as_ref()?;
        let off = OffBalance::of(beam, shape, stress_free)?;
        let inside = 0.5 * basis.length();
        let mut sag = 0.0_f64;
        let mut at = |k: usize| {
            let s = shape.s[k];
            let bent = shape.curvature[k] - stress_free.curvature[k];
            let [ei, ea] = [Some(bending), beam.section.axial_stiffness.as_ref()]
                .map(|along| along.map_or(0.0, |along| along.at(s, inside)));
            let mut off = off.curvature[k];
            let cell = basis.spacing(basis.cell_at(s));
            if shape.axial_force[k] * cell * cell > TAUT * ei {
                sag = sag.max((ei * off / shape.axial_force[k]).abs());
                off = 0.0;
            }
            [ei * off * off, ei * bent * bent, ea * shape.strain[k] * shape.strain[k], bent.abs()]
        };
        let mut sum = [0.0; 4];
        for k in 0..shape.s.len() {
            let ends = [k.saturating_sub(1), (k + 1).min(shape.s.len() - 1)].map(|k| shape.s[k]);
            let weight = 0.5 * (ends[1] - ends[0]);
            sum.iter_mut().zip(at(k)).for_each(|(sum, value)| *sum += weight * value);
        }
        let [off, bend, stretch, turn] = sum;
        Some(Self { off, bend, stretch, turn, sag })
    }
}

/// A warning for each beam whose curvature, or sag in an equilibrium, is off by a part that matters in the `last` state, at the load factor or the
/// time `parameter`. In a motion it has a `kinetic` energy \[J\], and what damps the bending of a beam makes a moment without a curvature.
pub(super) fn too_few_cells(
    model: &Model,
    system: &System,
    (parameter, last): (f64, &[Shape]),
    kinetic: Option<f64>,
) -> Vec<String> {
    let told = |(index, (beam, shape)): (usize, (&Beam, &Shape))| {
        let part = system.beams().get(index)?;
        let basis = &part.basis;
        let is_damped = model.parts.iter().any(|part| {
            let damping = (part.as_ref() as &dyn Any).downcast_ref::<BeamDamping>();
            damping.is_some_and(|of| of.beam == index && (of.strain.is_some() || of.curvature.is_some()))
        });
        // With less than one place in a cell, what it is off is not seen.
        if kinetic.is_some() && is_damped || shape.s.len() < basis.nodes().len() {
            return None;
        }
        // Any cells will do for what is straight, and stays so.
        if part.straight && shape.curvature.iter().all(|k| k.abs() * basis.length() <= SLIGHT) {
            return None;
        }
        let stress_free = StressFree::of(model, system, (index, shape), parameter)?;
        let Energies { off, bend, stretch, turn, sag } = Energies::of(beam, basis, shape, &stress_free)?;
        let whole = bend + stretch + 2.0 * kinetic.unwrap_or(0.0);
        // In a motion what a string with a little bending stiffness is off may be any part of it.
        let is_string = kinetic.is_some() && off > bend;
        let cells = (basis.nodes().len() - 1) as f64;
        let is_slight = kinetic.is_some() && (off / bend).sqrt() * turn < TOLERATED_TURN * cells;
        let matters = !is_string && !is_slight && off > TOLERATED * bend && off > IRRELEVANT * whole;
        let what = if kinetic.is_none() && sag > TOLERATED_SAG * shape.s.last()? {
            format!(
                "the axis of beam `{}` is off the line on which tension balances its loads by {sag:.1e} m: its cells are too few for its sag",
                beam.name
            )
        } else if matters && turn > SLIGHT {
            format!(
                "the curvature of beam `{}` is off that of the moments which balance what acts on it by {:.0} % (root mean square): its cells are too \
                 few for how it bends, and positions may err, too",
                beam.name,
                100.0 * (off / bend).sqrt()
            )
        } else {
            return None;
        };
        Some(format!("{what}; use more elements or nodes, or leave `basis` out and name an `accuracy`"))
    };
    model.beams.iter().zip(last).enumerate().filter_map(told).collect()
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    fn warnings(basis: &str, more: &str) -> Vec<String> {
        warnings_of("1", basis, &format!("{more}[analysis.static]\n"))
    }

    fn warnings_of(stiffness: &str, basis: &str, more: &str) -> Vec<String> {
        warnings_along("start = [0, 0], end = [1, 0]", stiffness, basis, more)
    }

    fn warnings_along(line: &str, stiffness: &str, basis: &str, more: &str) -> Vec<String> {
        let text = format!(
            "beam.arm = {{ {line}, axial_stiffness = 1e5, bending_stiffness = {stiffness}, mass_per_length = 1, basis = {{ {basis} }} }}\n\
             [[support]]\nbeam = 'arm'\nat = 'start'\nfix = ['x', 'y', 'angle']\n{more}"
        );
        let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).expect("an equilibrium");
        results.run().warnings.iter().filter(|text| text.contains("are too few for")).cloned().collect()
    }

    /// A cantilever that an end moment rolls up into a circle: with three elements, which turn by 120° each, the tip misses the clamp by 0.09 of
    /// the length, with six by 0.009.
    #[test]
    fn cells_that_turn_too_far_are_told() {
        let moment = "[[effect.moment]]\nbeam = 'arm'\nat = 'end'\nvalue = 6.283185307179586\n";
        let found = warnings("ancf.elements = 3", moment);
        let [found] = &found[..] else { panic!("{found:?}") };
        assert!(
            found.starts_with("the curvature of beam `arm` is off") && found.contains("by 15 %"),
            "{found}"
        );
        assert_eq!(warnings("ancf.elements = 6", moment), [""; 0]);
        assert_eq!(warnings("rpim.nodes = 5", moment), [""; 0]);
    }

    /// The same circle as the stress-free shape of an actuated beam, whose moments vanish.
    #[test]
    fn cells_that_follow_no_actuation_are_told() {
        let curled = "[[effect.actuation]]\nbeam = 'arm'\ncurvature = 6.283185307179586\n";
        let found = warnings("ancf.elements = 3", curled);
        assert!(found.len() == 1 && found[0].contains("by 13 %"), "{found:?}");
        assert_eq!(warnings("ancf.elements = 6", curled), [""; 0]);
        let partly = "[[effect.actuation]]\nbeam = 'arm'\ncurvature = { pieces = { until = [0.5], value = [2, -3] } }\n";
        assert_eq!(warnings("ancf.elements = 8", partly), [""; 0]);
    }

    /// Of the moment q (L − s)²/2 of a beam under its weight one element can have all but q L² (6ξ² − 6ξ + 1)/12, of which the square is
    /// a 35th of that of the rest: 17 %. Of two elements each lacks a quarter of that.
    #[test]
    fn the_part_is_that_of_the_moment_which_elements_cannot_have() {
        let weight = "[effect.gravity]\nacceleration = [0, -1e-3]\n";
        let found = warnings("ancf.elements = 1", weight);
        assert!(found.len() == 1 && found[0].contains("by 17 %"), "{found:?}");
        assert_eq!(warnings("ancf.elements = 2", weight), [""; 0]);
    }

    /// Where the stiffness jumps the curvature does, and at each place it is that of the stiffness there.
    #[test]
    fn steps_of_the_stiffness_are_followed() {
        let moment = "[[effect.moment]]\nbeam = 'arm'\nat = 'end'\nvalue = 3\n[analysis.static]\n";
        let stepped = |basis: &str| {
            warnings_of("{ pieces = { until = [0.3, 0.6], value = [4, 1, 3] } }", basis, moment)
        };
        assert_eq!(stepped("ancf.elements = 10"), [""; 0]);
        assert_eq!(stepped("ancf.nodes = [0, 0.3, 0.6, 1]").len(), 0);
    }

    /// What shape functions cannot have of the curve along which a beam is laid out is no fault of how it bends.
    #[test]
    fn curves_without_a_load_are_not_bent() {
        let arc = |force: f64| {
            let force = format!(
                "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [{force}, 0]\n[analysis.static]\n"
            );
            warnings_along(
                "arc = { center = [0, 1], radius = 1, from = '-90 deg', to = 0 }",
                "1",
                "ancf.elements = 6",
                &force,
            )
        };
        assert_eq!([0.0, 1e-4, 1.0].map(|force| arc(force).len()), [0; 3]);
    }

    /// In a motion cells that are too few are told, too. A moment that begins suddenly excites waves shorter than any cells, which are not.
    #[test]
    fn motions_in_cells_that_are_too_few_are_told() {
        let motion = |basis: &str, more: &str, duration: f64| {
            let analysis = format!("[analysis.dynamic]\nduration = {duration}\nradau.tolerance = 1e-5\n");
            warnings_of("1", basis, &format!("{more}{analysis}"))
        };
        let curled = "[[effect.actuation]]\nbeam = 'arm'\ncurvature = 5\nin_time.ramp.duration = 0.5\n";
        assert_eq!(motion("ancf.elements = 3", curled, 1.0).len(), 1);
        assert_eq!(motion("ancf.elements = 20", curled, 1.0), [""; 0]);
        let sudden = "[[effect.moment]]\nbeam = 'arm'\nat = 'end'\nvalue = 0.3\n";
        assert_eq!(motion("ancf.elements = 32", sudden, 0.3), [""; 0]);
    }

    /// What is pulled by 2000 EI/L² is straight but for a 45th of its length, which tells nothing of where it is.
    #[test]
    fn layers_of_what_is_taut_are_not() {
        let pulled = |force: &str| {
            warnings(
                "ancf.elements = 3",
                &format!("[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = {force}\n"),
            )
        };
        assert_eq!(pulled("[2000, 20]"), [""; 0]);
        assert_eq!(pulled("[100, 100]").len(), 1);
    }

    /// A beam between clamps under 5000 N/m, which hangs between them like a cable: with three elements 0.028 of its length beside where it
    /// belongs, with forty 0.0002.
    #[test]
    fn cables_that_sag_within_cells_are_told() {
        let loaded = "[[support]]\nbeam = 'arm'\nat = 'end'\nfix = ['x', 'y', 'angle']\n[effect.gravity]\nacceleration = [0, -5000]\n";
        let found = warnings("ancf.elements = 3", loaded);
        assert!(found.len() == 1 && found[0].contains("tension balances its loads by 3.7e-2 m"), "{found:?}");
        let finer = warnings("ancf.elements = 40", loaded);
        assert!(!finer.iter().any(|told| told.contains("tension")), "{finer:?}");
    }
}
