//! Errors that coarser meshes do not show: of parts with one cell, of shape functions that are others there, and of what acts in a
//! point, where errors of the first order are beside others that fall faster, or where all meshes err alike.

use super::Round;
use crate::accuracy::difference::{
    self, Difference, Layer, StrainJump, fixed_gradients, is_path, jumps_of_modes,
};
use crate::accuracy::mesh::Mesh;
use crate::accuracy::runner::{Purpose, Runner, coarser, short};
use crate::accuracy::saturation::is_uneven;
use crate::accuracy::setting::{Family, Setting, Solver};
use crate::model::{Accuracy, Analysis, Discretization, Integrator, Place, StepControl};
use crate::numeric::plain;
use crate::results::{Event, Results};
use crate::run::{shapes_at, stiffness_jumps as jumps_of_laws};

/// Part of the wanted error that may be due to strains that jump …
const AT_JUMPS: f64 = 0.25;
/// … the part of their length to which cells beside these become shorter at once …
const MOST_SHORTER: f64 = 0.01;
/// … and how short they may be, in beam lengths: the round-off of positions makes forces that grow as the third power of what
/// follows from it.
const SHORTEST: f64 = 2e-4;
/// Two meshes whose frequencies or critical loads differ by more than this part are too coarse for these waves to tell errors by
/// themselves.
const TOO_COARSE_FOR_WAVES: f64 = 1e-3;
/// With half of their length errors that fall with the first order are told by half.
const TOLD_BY_HALF: f64 = 2.0;
/// Smallest and largest tolerance of a motion with contacts that tells what steps of a given length err by …
const TOLERANCES: [f64; 2] = [1e-6, 1e-3];
/// … and how many times as many iterations it may take.
const MOST_ITERATIONS: usize = 10;

/// Most records of which it is known where their forces pass corners of laws.
const RECORDS: usize = 64;

impl Runner<'_, '_> {
    /// Whether coarser meshes tell nothing of the errors of a part of a beam: the scene gives it one cell, or shape functions
    /// whose errors the number of cells does not decide, or which are others there.
    pub fn is_unseen(&self, beam: usize) -> bool {
        let one = self.named[beam].as_ref().is_some_and(|mesh| mesh.coarsening().is_none());
        one || self.saturated[beam] || self.dissimilar[beam]
    }

    /// Whether the stiffness of a beam jumps whose mesh is chosen.
    fn has_open_jumps(&self) -> bool {
        (0..self.model.beams.len()).any(|beam| self.is_open(beam) && !self.softer[beam].is_empty())
    }

    /// Where the stiffnesses of open beams jump, with all that results differ by from those `beside` them.
    pub(super) fn stiffness_jumps(&self, beside: Option<&Difference>) -> Vec<StrainJump> {
        let error = beside.map_or(0.0, |beside| beside.errors.result);
        let open = (0..self.model.beams.len()).filter(|beam| self.is_open(*beam));
        open.flat_map(|beam| self.softer[beam].iter().map(move |s| StrainJump { beam, s: *s, error }))
            .collect()
    }

    /// What the results of a `setting` differ by from those with four cells in every part of a beam that has one, with nodes where
    /// something acts in a point or forces pass corners of laws, with short cells where a stiffness jumps, with elements in
    /// place of shape functions whose errors finer meshes do not remove, or whose errors coarser ones do not tell, and with halves of
    /// cells of a scene that are long against the waves, as what was `seen` of these shows; `None` where there is nothing of it.
    pub(super) fn beside_finer(
        &mut self,
        stations: &[Vec<f64>],
        setting: &Setting,
        results: &Results,
        corners: &[Place],
        seen: Option<&Difference>,
    ) -> Result<Option<Difference>, String> {
        let corners = self.within_cells(corners);
        let too_coarse =
            seen.is_some_and(|seen| seen.eigenvalues.iter().any(|error| *error > TOO_COARSE_FOR_WAVES));
        // What acts in a point within a cell makes an error by its place in the cell, which is another one in coarser cells.
        let beams = 0..self.model.beams.len();
        // Where a stiffness jumps, errors of the first order are beside others that fall so fast that coarser meshes show these only.
        let is_unseen = |beam: &usize| {
            let acts = self.pointed[*beam] || !self.softer[*beam].is_empty() || !corners[*beam].is_empty();
            self.is_unseen(*beam) || acts || too_coarse && self.named[*beam].is_some()
        };
        let unseen: Vec<usize> = beams.filter(is_unseen).collect();
        if unseen.is_empty() || !results.run().complete {
            return Ok(None);
        }
        let at_jumps = self.has_open_jumps();
        let mut finer = setting.clone();
        for index in unseen {
            let beam = &self.model.beams[index];
            finer.beams[index] = match &self.named[index] {
                None => {
                    let mesh = self.meshes[index].halved().halved_beside(&self.softer[index]);
                    self.families[index].of(beam, mesh.and(&corners[index]).places())
                }
                Some(named) => {
                    // Meshfree shape functions reach over corners, and beside nodes that are close they amplify round-off. Elements have
                    // to be shorter to err by less than those do.
                    let meshfree = matches!(beam.discretization, Discretization::Rpim { .. });
                    let mut edges = if meshfree { self.model.edges(index) } else { Vec::new() };
                    edges.retain(|s| *s > 0.0 && *s < named.length());
                    let reach = !corners[index].is_empty() || !edges.is_empty() || is_uneven(&named.nodes);
                    let dissimilar = self.dissimilar[index] || meshfree && reach;
                    let named = match () {
                        () if dissimilar => named.halved().halved(),
                        () if too_coarse => named.halved(),
                        () => named.clone(),
                    };
                    let mesh = named.quartered_parts().graded_towards(&self.softer[index]);
                    let nodes = mesh.and(&corners[index]).and(&edges).places();
                    match self.saturated[index] || dissimilar {
                        true => Family::REDUCED.of(beam, nodes),
                        false => (coarser(&beam.discretization, nodes), beam.gauss_points),
                    }
                }
            };
        }
        let finer = self.solve(stations, &finer, Purpose::Shapes).map_err(|error| {
            format!("on more cells, by which errors are told that coarser ones do not show, there is no result: {error}")
        })?;
        if !finer.run().complete {
            return Err("the run on more cells was stopped".to_owned());
        }
        let difference = self.difference(&finer, results)?;
        Ok(Some(if at_jumps { difference.divided([TOLD_BY_HALF.recip(); 2]) } else { difference }))
    }

    /// What load factors of changes of stability on a path differ by from those with short cells where the strain of a mode may jump: the
    /// first motion away from the path at a bifurcation is one. `None` where there is no such change or no such place.
    pub(super) fn changes_beside_jumps(
        &mut self,
        stations: &[Vec<f64>],
        setting: &Setting,
        results: &Results,
        difference: &Difference,
    ) -> Option<Difference> {
        let changes = results.states().events.iter().any(|event| matches!(event, Event::Stability { .. }));
        let jumps: Vec<Vec<f64>> = self
            .meshes
            .iter()
            .enumerate()
            .map(|(i, mesh)| jumps_of_modes(self.model, i, mesh.length()))
            .collect();
        if !changes || !results.run().complete || jumps.iter().all(Vec::is_empty) {
            return None;
        }
        let mut finer = setting.clone();
        for (index, jumps) in jumps.iter().enumerate().filter(|(_, jumps)| !jumps.is_empty()) {
            let beam = &self.model.beams[index];
            let mesh = match &self.named[index] {
                Some(named) => named.clone().graded_towards(jumps),
                None => self.meshes[index].halved().graded_towards(jumps),
            };
            finer.beams[index] = match &self.named[index] {
                Some(_) if self.saturated[index] => Family::REDUCED.of(beam, mesh.places()),
                Some(_) => (coarser(&beam.discretization, mesh.places()), beam.gauss_points),
                None => self.families[index].of(beam, mesh.places()),
            };
        }
        let finer = self.solve(stations, &finer, Purpose::Shapes).ok().filter(|finer| finer.run().complete);
        let beside = finer.and_then(|finer| self.difference(&finer, results).ok());
        Some(difference.with_events_alone(beside.map(|beside| beside.events)))
    }

    /// What the results of a `setting` with steps of a given length differ by from those with steps that follow the motion, where there
    /// are contacts: what begins and ends within a step, an impact or the slip before friction holds, errs by as much with steps of twice the
    /// length. `None` where the steps do follow it, or nothing touches.
    pub(super) fn beside_chosen_steps(
        &mut self,
        stations: &[Vec<f64>],
        setting: &Setting,
        results: &Results,
        difference: &Difference,
    ) -> Result<Option<Difference>, String> {
        let fixed = match setting.solver {
            Solver::Integrator(integrator) => matches!(integrator.step_control(), StepControl::Fixed(_)),
            _ => false,
        };
        if !fixed || !self.model.has_contact() || !results.run().complete {
            return Ok(None);
        }
        let [least, most] = TOLERANCES;
        let tolerance = StepControl::Tolerance(short(difference.errors.result.clamp(least, most)));
        let chosen = Setting { solver: Solver::Integrator(Integrator::usual(tolerance)), ..setting.clone() };
        let iterations = MOST_ITERATIONS.saturating_mul(results.run().statistics.newton_iterations);
        let followed = self.solve_within(iterations, stations, &chosen, Purpose::Shapes).map_err(|error| {
            format!("with steps that follow the contacts, by which errors are told that others of a given length do not show, there is no result: {error}")
        })?;
        if !followed.run().complete {
            return Err(format!(
                "steps that follow the contacts take more than {MOST_ITERATIONS} times the iterations of these: give a `tolerance` in place of a `step`"
            ));
        }
        self.difference(&followed, results).map(Some)
    }

    /// Where the forces of beams pass corners of their laws, in the last state of a run and, where they were kept, in the records before
    /// it. In motions such places wander, and along a path no record is compared but the last.
    pub(super) fn corners(&self, setting: &Setting, results: &Results) -> Vec<Place> {
        if !self.has_corners() {
            return Vec::new();
        }
        let states = results.states();
        let mut places = jumps_of_laws(self.model, &states.last);
        if states.states.is_some() && !is_path(self.analysis) {
            let (model, analysis) = setting.apply(self.model, self.analysis);
            let stride = states.parameter.len().div_ceil(RECORDS).max(1);
            let shapes = |at: &f64| shapes_at(&model, &analysis, states, *at, self.options.cache).ok();
            let before = states.parameter.iter().rev().skip(1).step_by(stride).filter_map(shapes);
            places.extend(before.flat_map(|shapes| jumps_of_laws(self.model, &shapes)));
        }
        places
    }

    /// Whether laws may have corners where a state, or several, rest.
    pub fn has_corners(&self) -> bool {
        let linear = self.model.beams.iter().all(|beam| beam.section.is_linear());
        !linear && !matches!(self.analysis, Analysis::Dynamic(_))
    }

    /// Those of `corners` that lie within cells of the finer run, for each beam. Beside a node that coarser meshes have, too, these err by
    /// as much as the finer run.
    fn within_cells(&self, corners: &[Place]) -> Vec<Vec<f64>> {
        let of = |beam: usize| {
            let mesh = match &self.named[beam] {
                Some(named) => named.clone(),
                None => self.meshes[beam].halved(),
            };
            let places: Vec<f64> = corners.iter().filter(|at| at.beam == beam).map(|at| at.s).collect();
            let more = mesh.clone().and(&places);
            more.nodes.into_iter().filter(|s| !mesh.nodes.contains(s)).collect()
        };
        (0..self.model.beams.len()).map(of).collect()
    }

    /// Shorter cells where the strain of an open beam jumps, if errors of the first order there are more than a part of the
    /// `wanted` one; whether they are.
    ///
    /// # Errors
    /// In words, where round-off allows no shorter ones.
    pub fn grade(&mut self, jumps: &[StrainJump], wanted: f64) -> Result<bool, String> {
        let mut any = false;
        for StrainJump { beam, s, error } in jumps.iter().filter(|jump| jump.error > AT_JUMPS * wanted) {
            let mesh = &self.meshes[*beam];
            let longest = mesh.longest_beside(*s);
            let short = (MOST_SHORTER.max(AT_JUMPS * wanted / error) * longest).max(SHORTEST * mesh.length());
            if short < longest {
                let others = self.short[*beam].iter().copied().filter(|[place, _]| place != s);
                self.short[*beam] = others.chain([[*s, short]]).collect();
                any = true;
            } else if *error > wanted {
                return Err(self.jump_at(*beam, *s));
            }
        }
        Ok(any)
    }

    /// Cells of half the length of layers at the ends of open beams, where these hide more than a part of the error that is `wanted`;
    /// whether there are any.
    pub fn resolve(&mut self, layers: &[Layer], wanted: Accuracy) -> bool {
        let curvature = wanted.curvature.unwrap_or(f64::INFINITY);
        let hides = |layer: &Layer| layer.curvature > AT_JUMPS * curvature || layer.position > wanted.result;
        // In cells as short as that beams that keep their length have rows that are nearly the same.
        let stretches = |beam: usize| self.model.beams[beam].section.axial_stiffness.is_some();
        let hide = |layer: &&Layer| hides(layer) && self.is_open(layer.beam) && stretches(layer.beam);
        let hidden: Vec<Layer> = layers.iter().filter(hide).copied().collect();
        for Layer { beam, end, length, .. } in &hidden {
            let others = self.short[*beam].iter().copied().filter(|[place, _]| place != end);
            self.short[*beam] = others.chain([[*end, 0.5 * length]]).collect();
        }
        !hidden.is_empty()
    }

    /// What is to be done about the largest of some jumps.
    pub fn largest_jump(&self, jumps: &[StrainJump]) -> Option<String> {
        let largest = jumps.iter().max_by(|a, b| a.error.total_cmp(&b.error))?;
        Some(self.jump_at(largest.beam, largest.s))
    }

    /// What is to be done about a strain that jumps.
    fn jump_at(&self, beam: usize, s: f64) -> String {
        if fixed_gradients(self.model, beam).any(|at| at == s) {
            return format!(
                "the support at s = {} m of beam `{}` fixes the gradient, and leaves no strain in that one point: fix the `angle` instead",
                plain(s, 6),
                self.model.beams[beam].name
            );
        }
        let length = self.meshes[beam].length();
        if s <= 0.0 || s >= length {
            return format!(
                "beam `{}` bends within a short part of its end at s = {} m, which takes cells that are as short there",
                self.model.beams[beam].name,
                plain(s, 6)
            );
        }
        format!(
            "the strain of beam `{}` jumps at s = {} m, which one beam cannot follow: cut it there (two beams in a `weld` have a strain each)",
            self.model.beams[beam].name,
            plain(s, 6)
        )
    }

    /// What is to be done about a kink within a string.
    pub fn kink_at(&self) -> Option<String> {
        let at = self.kink?;
        Some(format!(
            "string `{}` has a kink at s = {} m, where something acts in a point, which continuous tangents round off: cut it there (two \
             strings in a `hinge`)",
            self.model.beams[at.beam].name,
            plain(at.s, 6)
        ))
    }

    /// What is to be done about a strain that jumps, or a kink, where there is no result, for such a reason, since cells beside such a
    /// place have become short.
    pub fn shortened(&self, why: &str) -> Option<String> {
        let first = |(beam, short): (usize, &Vec<[f64; 2]>)| Some(self.jump_at(beam, short.first()?[0]));
        let place = self.short.iter().enumerate().find_map(first).or_else(|| self.kink_at())?;
        Some(format!("{place}; with shorter cells beside it there is no result: {why}"))
    }

    /// Gives open beams these meshes, with cells as short as they must be where strains jump.
    pub fn take(&mut self, meshes: Vec<Mesh>) {
        let graded = |(mesh, short): (Mesh, &Vec<[f64; 2]>)| {
            short.iter().fold(mesh, |mesh, [s, length]| mesh.graded_down_to(*s, *length))
        };
        self.meshes = meshes.into_iter().zip(&self.short).map(graded).collect();
    }

    /// Why no choice for other beams makes errors as small as is wanted, where those are larger that coarser meshes do
    /// not tell.
    pub fn remains(&self, round: &Round, caution: f64, wanted: Accuracy) -> Option<String> {
        let error = caution * round.unseen.as_ref()?.errors.result;
        let round_off = difference::round_off(&round.results).map_or(0.0, |of| of.errors.result);
        if round_off > wanted.result {
            return Some(format!(
                "round-off of the stiffness may change a value by {round_off:.1e}, which more cells make worse: ask for less, or leave out an \
                 `axial_stiffness` that is of no interest"
            ));
        }
        let beams = (0..self.model.beams.len()).filter(|beam| self.is_unseen(*beam));
        let names: Vec<String> = beams.map(|beam| format!("`{}`", self.model.beams[beam].name)).collect();
        (error > wanted.result && !names.is_empty()).then(|| {
            format!(
                "the basis that the scene gives {} leaves an error of {error:.1e}: leave it out, or give it more nodes",
                names.join(", ")
            )
        })
    }
}
