//! The events that a scene asks for: quantities at probes as functions of the state.

use super::RunError;
use super::sampler::{ProbePoint, Sampler};
use crate::assembly::Side;
use crate::model::{Discretization, Dynamic, EventCondition, ProbeQuantity};
use crate::results::{ProbeSeries, Shape, Trajectory};
use crate::solve::dynamics::{self, Observed};
use crate::system::{View, unfold};

/// Round-offs of single positions that may add up in a quantity of elements …
const ROUND_OFFS: f64 = 4.0;
/// … and of meshfree shape functions, of which more nodes take part in a place.
const ROUND_OFFS_OF_MESHFREE: f64 = 16.0;
/// Heights of bends below this are round-off \[beam lengths\].
const STILL: f64 = 1e-9;
/// What a probe at rest is moved by round-off at most \[beam lengths\].
const REST: f64 = 1e-13;

impl Sampler<'_> {
    /// The events of a motion, each with the view of its probe.
    pub(super) fn watches(&self, settings: &Dynamic) -> Result<Vec<dynamics::EventWatch<'_>>, RunError> {
        let watch = |event: &EventCondition| {
            let number = self.probe_named(&event.probe)?;
            use ProbeQuantity::{Angle, Speed, Vx, Vy};
            Ok(dynamics::EventWatch {
                quantity: self.quantity(number, event.quantity),
                place: self.probes[number].view.clone(),
                round_off: self.round_off(number, event.quantity),
                is_rate: matches!(event.quantity, Vx | Vy | Speed),
                is_relative: event.quantity == Angle,
                is_square: event.quantity == Speed,
                when: event.when,
                stop: event.stop,
            })
        };
        settings.events.iter().map(watch).collect()
    }

    /// Warnings about probes that are watched and move, but by no more than what counts as an error: no
    /// event was found there, however the quantity turned.
    pub(super) fn hardly_moving(&self, settings: &Dynamic, trajectory: &Trajectory) -> Vec<String> {
        let length = self.system.length();
        let least = dynamics::least_change(settings.integrator.step_control());
        let watched = |name: &String| settings.events.iter().any(|event| event.probe == *name);
        let moved = |probe: &ProbeSeries| {
            let first = probe.samples.first()?;
            let far = (first.x.hypot(first.y) / length).max(1.0);
            let distances = probe.samples.iter().map(|at| (at.x - first.x).hypot(at.y - first.y) / length);
            let moved = distances.fold(0.0, f64::max);
            (moved > REST * far && moved < least * far).then_some(moved)
        };
        let warning = |probe: &ProbeSeries| {
            moved(probe).map(|moved| {
                format!(
                    "probe `{}` moves by {moved:.1e} beam lengths at most: events of so small a motion cannot be told from its errors \
                     and are not looked for; with a larger load, or a smaller tolerance down to 1e-6, they are",
                    probe.name
                )
            })
        };
        trajectory.probes.iter().filter(|probe| watched(&probe.name)).filter_map(warning).collect()
    }

    /// Values of a quantity at probe number `number` that are round-off: a position is stored with the
    /// round-off ε L, from which an element of length h makes forces ε EA L/h along the beam and
    /// 12 ε EI L/h³ across. A gentle bend turns a part (h/L)² of the former across: a larger part would
    /// hide the turns of small vibrations. Directions and strains err by ε L/h, curvatures by 12 ε L/h².
    /// Some of these errors add up, and a beam at rest vibrates by them: so a bend by less than [`STILL`]
    /// of its length counts as none.
    fn round_off(&self, number: usize, quantity: ProbeQuantity) -> f64 {
        let ProbePoint { beam, view, .. } = &self.probes[number];
        let (section, basis) = (&self.model.beams[*beam].section, &self.system.beams()[*beam].basis);
        let (s, length) = (view.s()[0], basis.length());
        let h = basis.nodes().windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let [stretching, bending] = [&section.axial_stiffness, &section.bending_stiffness]
            .map(|along| along.as_ref().map_or(0.0, |along| along.bounds(length)[1]));
        let times = match self.model.beams[*beam].discretization {
            Discretization::Rpim { .. } => ROUND_OFFS_OF_MESHFREE,
            _ => ROUND_OFFS,
        };
        let unit = times * f64::EPSILON * length / h;
        let bend = STILL / length;
        let bent = unit * 12.0 * bending / (h * h);
        // The force in a beam that keeps its length balances those across its neighbours.
        let axial = if section.axial_stiffness.is_some() { unit * stretching } else { bent };
        let across = bent + unit * stretching * (h / length).powi(2);
        let moment = (across * h).max(bending * bend);
        let stress = |face: usize| {
            let signs = [1.0, -1.0].map(|sign| section.stresses(s, s, [axial, sign * moment], &[]));
            let of = |layers: Vec<[f64; 2]>| layers.iter().fold(0.0_f64, |m, faces| m.max(faces[face].abs()));
            signs.into_iter().flatten().map(of).fold(0.0, f64::max)
        };
        match quantity {
            ProbeQuantity::Angle => unit.max(STILL),
            ProbeQuantity::Strain => unit,
            ProbeQuantity::Curvature => (12.0 * unit / h).max(bend),
            ProbeQuantity::AxialForce => axial,
            ProbeQuantity::ShearForce => across.max(bending * bend / length),
            ProbeQuantity::BendingMoment => moment,
            ProbeQuantity::StressBottom => stress(0),
            ProbeQuantity::StressTop => stress(1),
            _ => 0.0,
        }
    }

    /// A quantity at probe number `number` as a function of the state; of a speed its square.
    fn quantity(&self, number: usize, quantity: ProbeQuantity) -> dynamics::Quantity<'_> {
        use dynamics::Quantity::{OfForces, OfMotion, Position};
        let ProbePoint { beam, view, measure, reference_strain, .. } = &self.probes[number];
        let carries = |of: fn(&Shape) -> Option<&[f64]>| {
            let part = &self.system.beams()[*beam];
            let length = part.basis.length();
            // The probe comes first, and then places along the beam, the last of which is its end.
            let mut places = vec![view.s()[0]];
            places.extend(self.frame_places(*beam, None).0);
            let side = |s: &f64| if *s >= length { Side::Left } else { Side::Right };
            let sides: Vec<Side> = places.iter().map(side).collect();
            let along = View::points(&part.basis, part.offset(), &places).ok();
            OfForces(Box::new(move |balance| {
                let actions = self.system.actions(balance.view());
                let cut = |view| self.cut_view(*beam, view, &sides, &balance.state.q, &actions[*beam]);
                let shape = along.as_ref().map(cut).unwrap_or_default();
                let along = of(&shape).unwrap_or_default();
                let value = along.first().copied().unwrap_or(f64::NAN);
                Observed { value, along: along.iter().fold(0.0, |largest, value| largest.max(value.abs())) }
            }))
        };
        match quantity {
            ProbeQuantity::X => Position(view.clone(), 0),
            ProbeQuantity::Y => Position(view.clone(), 1),
            ProbeQuantity::Angle => OfMotion(Box::new(move |state| {
                let near = state.angles.get(number).copied().filter(|angle| angle.is_finite());
                unfold(view.fields(&state.q).angle(), near)
            })),
            ProbeQuantity::Vx => OfMotion(Box::new(|state| view.at_point(&state.v)[0])),
            ProbeQuantity::Vy => OfMotion(Box::new(|state| view.at_point(&state.v)[1])),
            ProbeQuantity::Speed => OfMotion(Box::new(|state| {
                let [x, y] = view.at_point(&state.v);
                x * x + y * y
            })),
            // The strain of a state that is interpolated between steps errs by far more than its
            // position.
            ProbeQuantity::Strain => OfForces(Box::new(move |balance| {
                Observed::at_point(view.fields(&balance.state.q).strain(*measure) - reference_strain)
            })),
            ProbeQuantity::Curvature => {
                OfForces(Box::new(|balance| Observed::at_point(view.fields(&balance.state.q).curvature())))
            }
            ProbeQuantity::AxialForce => carries(|shape| Some(&shape.axial_force)),
            ProbeQuantity::ShearForce => carries(|shape| Some(&shape.shear_force)),
            ProbeQuantity::BendingMoment => carries(|shape| Some(&shape.bending_moment)),
            ProbeQuantity::StressBottom => carries(|shape| shape.face_stresses().map(|[bottom, _]| bottom)),
            ProbeQuantity::StressTop => carries(|shape| shape.face_stresses().map(|[_, top]| top)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Needs;
    use crate::run::Options;
    use crate::system::System;

    /// Elements of length h in a rectangle of 0.25 m by 0.5 m of 800 Pa: EA = 100 N, EI = 25/12 N m², and N/A +
    /// M/W on a face, of the largest force and moment of round-off, whatever their signs. Long elements
    /// resolve bends that are too flat to count.
    #[test]
    fn round_off_of_forces_is_that_of_positions_in_an_element() {
        let (length, bending) = (2.0, 25.0 / 12.0);
        for (elements, flat) in [(4, true), (400, false)] {
            let text = format!(
                "beam.bar = {{ start = [0, 0], end = [2, 0], youngs_modulus = 800, basis.ancf.elements = {elements}, \
                 section.rectangle = {{ height = 0.5, width = 0.25 }} }}
                support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}]
                probe = [{{ name = 'end', beam = 'bar', at = 'end' }}]
                analysis.static = {{}}"
            );
            let scene = crate::scene::parse("bar.toml", &text).expect("a scene");
            let needs = Needs { inertia: false, motion: false };
            let system = System::build(scene.model(), needs).expect("a system");
            let sampler =
                Sampler::new(scene.model(), &system, Options::default().detail()).expect("a sampler");
            let h = length / f64::from(elements);
            let position = 4.0 * f64::EPSILON * length;
            let axial = position * 100.0 / h;
            let across = position * (12.0 * bending / h.powi(3) + 100.0 / h * (h / length).powi(2));
            let bend = 1e-9 / length;
            let [curvature, shear, moment] = if flat {
                [bend, bending * bend / length, bending * bend]
            } else {
                [12.0 * position / (h * h), across, across * h]
            };
            let stress = axial / 0.125 + moment / (0.25 * 0.25 / 6.0);
            for (quantity, expected) in [
                (ProbeQuantity::AxialForce, axial),
                (ProbeQuantity::ShearForce, shear),
                (ProbeQuantity::BendingMoment, moment),
                (ProbeQuantity::StressBottom, stress),
                (ProbeQuantity::StressTop, stress),
                (ProbeQuantity::Angle, 1e-9),
                (ProbeQuantity::Strain, position / h),
                (ProbeQuantity::Curvature, curvature),
                (ProbeQuantity::Y, 0.0),
                (ProbeQuantity::Speed, 0.0),
            ] {
                let found = sampler.round_off(0, quantity);
                assert!(
                    (found - expected).abs() <= 1e-9 * expected,
                    "{elements} {quantity:?}: {found} for {expected}"
                );
            }
        }
    }
}
