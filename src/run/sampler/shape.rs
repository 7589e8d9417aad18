//! Shapes of the beams in a state, and what their sections carry.

use super::Sampler;
use crate::assembly::{Actions, Imposed, Side, TendonPath, nodes};
use crate::model::Beam;
use crate::results::{LayerStress, ModeShape, Shape};
use crate::system::{Change, Fields, View, unfold};
use nalgebra::Vector2;

/// Places nearer to each other than this, in beam lengths, are one.
const SAME_PLACE: f64 = 1e-9;

/// The places `even`, those of `jumps` twice, and the middle of each part between `breaks` that has no other place; each with the side
/// of the cut there.
fn stations(even: &[f64], jumps: &[f64], breaks: &[f64]) -> (Vec<f64>, Vec<Side>) {
    let end = even.last().copied().unwrap_or(0.0);
    let apart = |s: &&f64| jumps.iter().all(|jump| (jump - **s).abs() > SAME_PLACE * end);
    // At the beam's end the cut is before the forces that act there.
    let plain = even.iter().filter(apart).map(|s| (*s, if *s == end { Side::Left } else { Side::Right }));
    let between = |part: &&[f64]| part[1] - part[0] > 2.0 * SAME_PLACE * end;
    let unseen = |part: &&[f64]| {
        let inside = |s: &f64| *s > part[0] + SAME_PLACE * end && *s < part[1] - SAME_PLACE * end;
        !even.iter().chain(jumps).any(inside)
    };
    let short = breaks.windows(2).filter(between).filter(unseen);
    let middles = short.map(|part| (0.5 * (part[0] + part[1]), Side::Right));
    let mut stations: Vec<_> = plain
        .chain(middles)
        .chain(jumps.iter().flat_map(|s| [(*s, Side::Left), (*s, Side::Right)]))
        .collect();
    stations.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    stations.into_iter().unzip()
}

impl Sampler<'_> {
    /// All beams in the state `q`.
    pub(in crate::run) fn shape(&self, q: &[f64]) -> Vec<Shape> {
        self.shapes.iter().enumerate().map(|(beam, view)| self.shape_of(beam, view, q)).collect()
    }

    /// One beam in the state `q`, as `view` sees it.
    fn shape_of(&self, beam: usize, view: &View, q: &[f64]) -> Shape {
        let part = &self.system.beams()[beam];
        let first = 4 * part.first_node;
        let nodes = nodes(&q[first..first + 4 * part.basis.nodes().len()]);
        Shape { nodes: nodes.map(|node| node.position).collect(), ..self.seen(beam, view, q) }
    }

    /// [`Self::shape_of`] without the nodes.
    pub(super) fn seen(&self, beam: usize, view: &View, q: &[f64]) -> Shape {
        let (part, beam) = (&self.system.beams()[beam], &self.model.beams[beam]);
        let places = || Vec::with_capacity(view.s().len());
        let mut shape = Shape {
            beam: beam.name.clone(),
            s: view.s().to_vec(),
            x: places(),
            y: places(),
            angle: places(),
            strain: places(),
            curvature: places(),
            ..Shape::default()
        };
        let mut angle = None;
        for fields in view.all(q) {
            shape.x.push(fields.position[0]);
            shape.y.push(fields.position[1]);
            let unfolded = unfold(fields.angle(), angle);
            angle = Some(unfolded);
            shape.angle.push(unfolded);
            shape.strain.push(fields.strain(beam.strain));
            shape.curvature.push(fields.curvature());
        }
        // The stress-free shape of a curved beam has a strain by its interpolation, which does not
        // count.
        if !part.straight {
            let reference = view.all(self.system.reference());
            for (strain, reference) in shape.strain.iter_mut().zip(reference) {
                *strain -= reference.strain(beam.strain);
            }
        }
        shape
    }

    /// The changes of one beam by modes of the state `q`, at the arc lengths `s`.
    pub(in crate::run) fn changes(
        &self,
        beam: usize,
        s: &[f64],
        q: &[f64],
        modes: &[&[f64]],
    ) -> Vec<ModeShape> {
        let part = &self.system.beams()[beam];
        let (name, measure) = (&self.model.beams[beam].name, self.model.beams[beam].strain);
        let view = View::points(&part.basis, part.offset(), s);
        let view = view.as_ref().unwrap_or(&self.shapes[beam]);
        let state: Vec<Fields> = view.all(q).collect();
        let first = 4 * part.first_node;
        let coordinates = first..first + 4 * part.basis.nodes().len();
        let shape = |mode: &&[f64]| {
            let places = || Vec::with_capacity(state.len());
            let mut shape = ModeShape {
                beam: name.clone(),
                s: view.s().to_vec(),
                x: places(),
                y: places(),
                angle: places(),
                strain: places(),
                curvature: places(),
                nodes: nodes(&mode[coordinates.clone()]).map(|node| node.position).collect(),
            };
            for (fields, by) in state.iter().zip(view.all(mode)) {
                shape.x.push(by.position[0]);
                shape.y.push(by.position[1]);
                let Change { angle, strain, curvature } = fields.change(&by, measure);
                shape.angle.push(angle);
                shape.strain.push(strain);
                shape.curvature.push(curvature);
            }
            shape
        };
        modes.iter().map(shape).collect()
    }

    /// [`Self::shape`] with section forces, from the forces that act on each beam. A point where a
    /// force or a couple acts has two rows, before and behind it.
    pub(in crate::run) fn loaded(&self, q: &[f64], actions: &[Actions]) -> Vec<Shape> {
        self.loaded_with(q, actions, &|beam, length| actions[beam].jumps(length))
    }

    /// [`Self::loaded`], with two rows at the places that `jumps` gives for a beam and its length.
    pub(in crate::run) fn loaded_with(
        &self,
        q: &[f64],
        actions: &[Actions],
        jumps: &dyn Fn(usize, f64) -> Vec<f64>,
    ) -> Vec<Shape> {
        let beams = self.shapes.iter().zip(actions).enumerate();
        beams
            .map(|(beam, (even, actions))| {
                let part = &self.system.beams()[beam];
                let length = part.basis.length();
                let of_section = self.model.beams[beam].section.jumps();
                let mut jumps = jumps(beam, length);
                jumps.extend(&of_section);
                jumps.extend(self.jumps_of_imposed(beam, length, |imposed| imposed.layer.is_some()));
                let mut breaks = self.jumps_of_imposed(beam, length, |_| true);
                breaks.extend(of_section.into_iter().chain([0.0, length]));
                for places in [&mut jumps, &mut breaks] {
                    places.sort_by(f64::total_cmp);
                    places.dedup_by(|a, b| (*a - *b).abs() <= SAME_PLACE * length);
                }
                let (s, sides) = stations(even.s(), &jumps, &breaks);
                let more =
                    (s != even.s()).then(|| View::points(&part.basis, part.offset(), &s).ok()).flatten();
                let mut shape = self.shape_of(beam, more.as_ref().unwrap_or(even), q);
                self.bend_before(beam, &sides, q, &mut shape);
                self.cut(beam, actions, &sides, &mut shape);
                shape.tendons = self.tendons(beam, &shape);
                shape
            })
            .collect()
    }

    /// Where what is imposed on a beam and is `meant` begins or ends. The stresses jump there if it is a strain of a layer. The strain does
    /// in any case, which at a node, where the tangents of both sides are one, no row shows: only one inside does.
    fn jumps_of_imposed(&self, beam: usize, length: f64, meant: impl Fn(&Imposed) -> bool) -> Vec<f64> {
        let inner = SAME_PLACE * length..(1.0 - SAME_PLACE) * length;
        let imposed = self.model.parts.iter().filter_map(|part| part.actuation(beam)).filter(|i| meant(i));
        let places =
            imposed.flat_map(|imposed| [imposed.strain, imposed.curvature]).flat_map(|along| along.jumps());
        places.filter(|s| inner.contains(s)).collect()
    }

    /// Gives rows before a cut the strain and the curvature there: those of a node are the ones behind it.
    fn bend_before(&self, beam: usize, sides: &[Side], q: &[f64], shape: &mut Shape) {
        let part = &self.system.beams()[beam];
        let length = part.basis.length();
        let is_before = |i: &usize| sides[*i] == Side::Left && shape.s[*i] < length;
        let rows: Vec<usize> = (0..sides.len()).filter(is_before).collect();
        if rows.is_empty() {
            return;
        }
        let places: Vec<f64> = rows.iter().map(|i| (shape.s[*i] - SAME_PLACE * length).max(0.0)).collect();
        let Ok(view) = View::points(&part.basis, part.offset(), &places) else { return };
        let before = self.seen(beam, &view, q);
        for (i, (strain, curvature)) in rows.into_iter().zip(before.strain.iter().zip(&before.curvature)) {
            (shape.strain[i], shape.curvature[i]) = (*strain, *curvature);
        }
    }

    /// One beam at the arc lengths `s` \[m\], with section forces on the given sides of the cuts.
    pub(in crate::run) fn cut_shape(
        &self,
        beam: usize,
        s: &[f64],
        sides: &[Side],
        q: &[f64],
        actions: &Actions,
    ) -> Shape {
        let part = &self.system.beams()[beam];
        let view = View::points(&part.basis, part.offset(), s);
        view.map_or_else(|_| Shape::default(), |view| self.cut_view(beam, &view, sides, q, actions))
    }

    /// The same of a view of the beam.
    pub(in crate::run) fn cut_view(
        &self,
        beam: usize,
        view: &View,
        sides: &[Side],
        q: &[f64],
        actions: &Actions,
    ) -> Shape {
        let mut shape = self.shape_of(beam, view, q);
        if shape.s.len() == sides.len() {
            self.cut(beam, actions, sides, &mut shape);
        }
        shape
    }

    /// Adds the section forces; a string has only N.
    fn cut(&self, beam: usize, actions: &Actions, sides: &[Side], shape: &mut Shape) {
        let Beam { section, strain: measure, .. } = &self.model.beams[beam];
        let bends = section.bending_stiffness.is_some();
        let length = self.system.beams()[beam].basis.length();
        for forces in [&mut shape.axial_force, &mut shape.shear_force, &mut shape.bending_moment] {
            forces.reserve_exact(sides.len());
        }
        for (i, side) in sides.iter().enumerate() {
            let before = actions.until(shape.s[i], *side, length);
            let (r, (sine, cosine)) = (Vector2::new(shape.x[i], shape.y[i]), shape.angle[i].sin_cos());
            let force = -before.force;
            let inside = shape.s[i] + if *side == Side::Left { -SAME_PLACE } else { SAME_PLACE } * length;
            let stretch = measure.stretch(shape.strain[i]);
            let [axial, shear, moment] =
                actions.of_tendons(shape.s[i], inside, [stretch, shape.curvature[i]]);
            let along = force.x * cosine + force.y * sine - axial;
            let across = force.y * cosine - force.x * sine - shear;
            // The force in a string has the direction of the string, which at a kink is not that of the node.
            shape.axial_force.push(if bends { along } else { along.hypot(across).copysign(along) });
            shape.shear_force.push(if bends { across } else { 0.0 });
            let couple = r.perp(&before.force) - before.moment - moment;
            shape.bending_moment.push(if bends { couple } else { 0.0 });
            shape.faces.extend(section.faces(shape.s[i], inside));
            let forces = [shape.axial_force[i], shape.bending_moment[i]];
            let imposed = actions.layer_strains(shape.s[i], inside);
            for (layer, [bottom, top]) in
                section.stresses(shape.s[i], inside, forces, &imposed).into_iter().flatten().enumerate()
            {
                if layer == shape.stress.len() {
                    shape.stress.push(LayerStress::default());
                }
                shape.stress[layer].bottom.push(bottom);
                shape.stress[layer].top.push(top);
            }
        }
    }

    /// The lines of the tendons of a beam.
    fn tendons(&self, beam: usize, shape: &Shape) -> Vec<Vec<[f64; 2]>> {
        let paths = self.model.parts.iter().filter_map(|part| part.tendon());
        let line = |path: &TendonPath| {
            let [from, to] = path.ends;
            let points = (0..shape.s.len()).filter(|i| (from..=to).contains(&shape.s[*i]));
            points.map(|i| shape.beside(i, path.offset.at(shape.s[i], shape.s[i]))).collect()
        };
        paths.filter(|(of, ..)| *of == beam).map(|(_, path, _)| line(path)).collect()
    }
}
