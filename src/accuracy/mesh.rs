//! Places of nodes: where a search begins, every second node of a mesh, and nodes spread so that
//! every cell errs alike.
//!
//! A cell of length h whose curvature (of a string: direction) is approximated with order q errs by
//! η_c = C_c h^{q + 1/2} in the root of its integral. With the density d_c = C_c^{2/(2q + 1)} of
//! cells per length the sum of all η_c² is the smallest for a given number of cells where every
//! cell has the same ∫ d ds, and then it is (∫ d ds)^{2q + 1} N^{−2q}.

use std::f64::consts::FRAC_PI_4;

use crate::centreline::Curve;
use crate::model::{Along, Discretization, Model, Nodes, Place, Section};

/// Cells with which the search begins, of the longest beam; fewer are of no use …
const FIRST: f64 = 4.0;
/// … for every half-wave of the modes that are wanted …
const OF_HALF_WAVE: f64 = 1.75;
/// … and of every beam or part of a beam between two places that must be nodes.
const LEAST: usize = 2;
/// In a short part, the factor by which a stiffness changes from one group of so many cells to the next, and
/// the logarithm of the change up to which that is sought.
const CHANGE: f64 = 8.0;
const MOST_CHANGE: f64 = 40.0;
/// Cells longer than this part of the longest one are long …
const LONG: f64 = 0.5;
/// … and others hardly longer, where they are so by less than this factor.
const HARDLY_LONGER: f64 = 1.4;
/// How often cells are halved towards a place where the stiffness jumps.
const GRADES: usize = 3;
/// How often an interval is halved in search of a place.
const HALVINGS: usize = 30;
/// Largest turn of a stress-free centreline in a cell of the first mesh \[rad\].
const TURN: f64 = FRAC_PI_4;
/// Smallest density, relative to the mean: where nothing happens at first, something may happen
/// later.
const SPARSEST: f64 = 0.3;
/// The densities of neighbouring cells differ by this factor at most.
const GRADING: f64 = 2.0;
/// Where densities differ by less than this factor, even spacing does as well.
const EVEN: f64 = 3.0;
/// Where other places of as many cells would make the sum of squares this part of what it is …
const UNEVEN: f64 = 0.1;
/// … at most so many times the cells are taken at once; and elsewhere …
const CAREFUL: f64 = 2.0;
/// … at least so many times.
const MORE: f64 = 1.1;
/// Largest relative difference of the cells of even spacing.
const SAME: f64 = 1e-9;
/// Loads that begin or end nearer to a free end, in beam lengths, need no node there …
const NEAR: f64 = 2e-3;
/// … nor do those that act in a point which is nearer than this.
const NEAR_POINT: f64 = 5e-5;
/// Places that are nearer to a node, in cells, are nearly nodes.
const AT_NODE: f64 = 0.01;

/// The nodes of one beam.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mesh {
    /// Arc lengths \[m\], from 0 to the beam's length.
    pub nodes: Vec<f64>,
    /// Nodes that must be, ends included.
    fixed: Vec<f64>,
}

/// The nodes that a beam of this length \[m\] must have, rising, ends included. A load that begins or ends very near to a free end of the beam, or
/// acts in a point nearer still, has none of its own: cells as short as that amplify the round-off of positions, and what the load does
/// beyond a node that would be there is next to nothing.
fn fixed(model: &Model, beam: usize, length: f64) -> Vec<f64> {
    let here = |at: Place| (at.beam == beam).then_some(at.s);
    // Meshfree nodes that are close amplify round-off.
    let meshfree = matches!(model.beams[beam].discretization, Discretization::Rpim { .. });
    let edges = if meshfree { Vec::new() } else { model.edges(beam) };
    let parts = |resist: bool| model.parts.iter().filter(move |part| part.resists().is_empty() != resist);
    let edges_of =
        |resist: bool| -> Vec<f64> { parts(resist).flat_map(|part| part.edges()).filter_map(here).collect() };
    let points_of =
        |resist: bool| -> Vec<f64> { parts(resist).filter_map(|part| here(part.point()?)).collect() };
    let [of_loads, of_others] = [false, true].map(edges_of);
    let mut needed = model.breaks(beam);
    needed.extend(edges.iter().filter(|s| !of_loads.contains(s) || of_others.contains(s)));
    needed.extend(points_of(true));
    needed.extend(model.supports.iter().filter_map(|support| here(support.at)));
    let is_free = |end: f64| needed.iter().all(|s| (s - end).abs() > NEAR * length);
    let free = [0.0, length].map(|end| is_free(end).then_some(end));
    let is_apart = |s: &f64, near: f64| free.into_iter().flatten().all(|end| (s - end).abs() > near * length);
    let mut places: Vec<f64> = edges.iter().copied().filter(|s| is_apart(s, NEAR)).collect();
    places.extend(points_of(false).into_iter().filter(|s| is_apart(s, NEAR_POINT)));
    places.extend(needed);
    places.sort_by(f64::total_cmp);
    let mut fixed = vec![0.0];
    for s in places.into_iter().filter(|s| *s < (1.0 - SAME) * length) {
        if fixed.last().is_some_and(|last| s - last > SAME * length) {
            fixed.push(s);
        }
    }
    fixed.push(length);
    fixed
}

/// What the cells of a mesh err by.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CellErrors {
    /// ∫ η² ds of each cell.
    pub squares: Vec<f64>,
    /// The order q with which cells become better.
    pub order: f64,
}

/// A cell that ends at a node.
struct Beside {
    /// -1 before the node, 1 behind it.
    side: f64,
    /// \[m\]
    length: f64,
}

impl Mesh {
    /// Where the search begins, for every beam; with `waves` half-waves of a mode along the longest
    /// each has some cells. There are `times` as many as an error of a thousandth needs.
    pub fn first(model: &Model, waves: usize, times: f64) -> Vec<Self> {
        let curves: Vec<Option<Curve>> =
            model.beams.iter().map(|beam| Curve::new(&beam.centreline).ok()).collect();
        let longest = curves.iter().flatten().map(Curve::length).fold(0.0, f64::max);
        let mesh = |(beam, curve): (usize, &Option<Curve>)| {
            // A centreline without length is refused where the model is built.
            let Some(curve) = curve else { return Self { nodes: vec![0.0], fixed: vec![0.0] } };
            let length = curve.length();
            let fixed = fixed(model, beam, length);
            let straight =
                number((times * FIRST.max(OF_HALF_WAVE * waves as f64)).max(FIRST) * length / longest);
            let turns = number(turning(curve) / TURN);
            let cells = straight.max(turns).max(LEAST);
            let spread = |part: &[f64]| {
                let share = number(cells as f64 * (part[1] - part[0]) / length);
                if share <= LEAST {
                    return graded(&model.beams[beam].section, [part[0], part[1]]);
                }
                // An even number, so that every second node makes a mesh, too.
                even(part[0], part[1], share.next_multiple_of(2))
            };
            let mut nodes: Vec<f64> = fixed.windows(2).flat_map(spread).collect();
            nodes.push(length);
            Self { nodes, fixed }
        };
        curves.iter().enumerate().map(mesh).collect()
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.nodes.len().saturating_sub(1)
    }

    /// Whether no node must be but the ends.
    pub fn is_one_part(&self) -> bool {
        self.fixed.len() == 2
    }

    /// The cell that contains `s`.
    pub fn cell_at(&self, s: f64) -> usize {
        let after = self.nodes.partition_point(|node| *node <= s);
        (after.max(1) - 1).min(self.cells() - 1)
    }

    /// Whether there must be a node at `s` because of the model.
    pub fn must_be(&self, s: f64) -> bool {
        self.fixed.iter().any(|fixed| (fixed - s).abs() <= SAME * self.length())
    }

    /// Length of the beam \[m\].
    pub fn length(&self) -> f64 {
        self.nodes.last().copied().unwrap_or(0.0)
    }

    /// Every cell cut in two.
    pub fn halved(&self) -> Self {
        self.divided(2)
    }

    /// Every cell cut into `times`.
    fn divided(&self, times: usize) -> Self {
        let mut nodes: Vec<f64> =
            self.nodes.windows(2).flat_map(|cell| even(cell[0], cell[1], times)).collect();
        nodes.extend(self.nodes.last());
        Self { nodes, fixed: self.fixed.clone() }
    }

    /// A mesh of these nodes and of those that must be. In place of one that is nearly another that one must be.
    pub fn with(&self, nodes: &[f64]) -> Self {
        let nodes = Self { nodes: nodes.to_vec(), fixed: Vec::new() }.and(&self.fixed).nodes;
        let nearest = |s: &f64| {
            let after = nodes.partition_point(|node| node < s).min(nodes.len() - 1);
            let [before, after] = [nodes[after.saturating_sub(1)], nodes[after]];
            if s - before < after - s { before } else { after }
        };
        let mut fixed: Vec<f64> = self.fixed.iter().map(nearest).collect();
        fixed.dedup();
        Self { nodes, fixed }
    }

    /// With more nodes, at those of the `places` that are not nearly nodes.
    pub fn and(mut self, places: &[f64]) -> Self {
        for s in places {
            let cell = self.cell_at(*s);
            let [start, end] = [self.nodes[cell], self.nodes[cell + 1]];
            if (s - start).min(end - s) > AT_NODE * (end - start) {
                self.nodes.insert(cell + 1, *s);
            }
        }
        self
    }

    /// Its parts between nodes that must be: the nodes of each.
    fn parts(&self) -> Vec<&[f64]> {
        let inside = |i: &usize| *i > 0 && *i < self.cells() && self.must_be(self.nodes[*i]);
        let inner: Vec<usize> = (0..self.nodes.len()).filter(inside).collect();
        let starts = std::iter::once(0).chain(inner.iter().copied());
        let ends = inner.iter().copied().chain(std::iter::once(self.cells()));
        starts.zip(ends).map(|(start, end)| &self.nodes[start..=end]).collect()
    }

    /// With other cells in each of its parts between nodes that must be, of which `cells` has the nodes but for the last.
    fn with_parts(&self, cells: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        let mut nodes: Vec<f64> = self.parts().into_iter().flat_map(cells).collect();
        nodes.extend(self.nodes.last());
        Self { nodes, fixed: self.fixed.clone() }
    }

    /// Half as many cells in every part between nodes that must be, or of an odd number one less than that, down to
    /// one: each reaches over as many of those that are.
    pub fn coarser(&self) -> Self {
        self.with_parts(|nodes| {
            let (count, cells) = (nodes.len() - 1, ((nodes.len() - 1) / 2).max(1));
            let place = |k: usize| {
                let (before, part) = (k * count / cells, (k * count % cells) as f64 / cells as f64);
                nodes[before] + if part > 0.0 { part * (nodes[before + 1] - nodes[before]) } else { 0.0 }
            };
            (0..cells).map(place).collect()
        })
    }

    /// By how many times fewer cells are in [`Self::coarser`], at least in any part between nodes that must be; `None`
    /// where a part has one cell only.
    pub fn coarsening(&self) -> Option<f64> {
        let of = |nodes: &[f64]| {
            let cells = nodes.len() - 1;
            (cells > 1).then(|| cells as f64 / (cells / 2) as f64)
        };
        self.parts().into_iter().map(of).try_fold(f64::INFINITY, |least, times| Some(times?.min(least)))
    }

    /// Whether a long cell of a `finer` mesh lies in one that is hardly longer, so that both err by as much there.
    pub fn hardly_differs_from(&self, finer: &Self) -> bool {
        let cells = || finer.nodes.windows(2).map(|ends| (0.5 * (ends[0] + ends[1]), ends[1] - ends[0]));
        let longest = cells().map(|(_, width)| width).fold(0.0, f64::max);
        let around = |s: f64| {
            let cell = self.cell_at(s);
            self.nodes[cell + 1] - self.nodes[cell]
        };
        cells().any(|(middle, width)| width >= LONG * longest && around(middle) < HARDLY_LONGER * width)
    }

    /// Four cells in every part between nodes that must be that has one.
    pub fn quartered_parts(&self) -> Self {
        self.with_parts(|nodes| match nodes {
            [from, to] => even(*from, *to, 4),
            _ => nodes[..nodes.len() - 1].to_vec(),
        })
    }

    /// With cells that are shorter and shorter, down to an eighth, towards both sides of `places`, which are nodes.
    pub fn graded_towards(mut self, places: &[f64]) -> Self {
        for _ in 0..GRADES {
            self = self.halved_beside(places);
        }
        self
    }

    /// With half the cells on both sides of `places`, which are nodes.
    pub fn halved_beside(mut self, places: &[f64]) -> Self {
        for s in places {
            self.nodes.extend(self.beside(*s).map(|end| s + 0.5 * end.length.copysign(end.side)));
            self.nodes.sort_by(f64::total_cmp);
        }
        self
    }

    /// The longer one of the cells that meet at the node `s`.
    pub fn longest_beside(&self, s: f64) -> f64 {
        self.beside(s).map(|end| end.length).fold(0.0, f64::max)
    }

    /// With cells that are shorter and shorter towards both sides of the node `s`, down to some `length` between half and twice of
    /// what is given. There is an even number more of them on either side, so that every second node makes a mesh still.
    pub fn graded_down_to(mut self, s: f64, length: f64) -> Self {
        for end in self.beside(s) {
            let halvings = number((end.length / length).log2()) as i32;
            let halvings = if halvings > 2 { halvings - halvings % 2 } else { halvings + halvings % 2 };
            self.nodes.extend((1..=halvings).map(|k| s + 0.5_f64.powi(k) * end.length.copysign(end.side)));
        }
        self.nodes.sort_by(f64::total_cmp);
        self
    }

    /// The cells that end at the node `s`.
    fn beside(&self, s: f64) -> impl Iterator<Item = Beside> + use<> {
        let node = self.nodes.partition_point(|node| *node < s - SAME * self.length());
        let others = [(node.checked_sub(1), -1.0), (Some(node + 1), 1.0)];
        let cells = others.map(|(other, side)| {
            let other = *self.nodes.get(other?)?;
            Some(Beside { side, length: (other - s).abs() })
        });
        cells.into_iter().flatten()
    }

    /// The errors of this mesh, from those of the cells of a `finer` one.
    pub fn gathered(&self, finer: &Self, errors: &CellErrors) -> CellErrors {
        let mut squares = vec![0.0; self.cells()];
        for (cell, square) in finer.nodes.windows(2).zip(&errors.squares) {
            squares[self.cell_at(0.5 * (cell[0] + cell[1]))] += square;
        }
        CellErrors { squares, order: errors.order }
    }

    /// As a scene says it.
    pub fn places(&self) -> Nodes {
        let cells = self.cells() as f64;
        let length = self.nodes.last().copied().unwrap_or(0.0);
        let even =
            self.nodes.windows(2).all(|cell| ((cell[1] - cell[0]) * cells / length - 1.0).abs() <= SAME);
        if even && self.is_one_part() {
            Nodes::Uniform(self.nodes.len())
        } else {
            Nodes::Given(self.nodes.clone())
        }
    }

    /// Densities of cells for the errors of this mesh, graded, and never too sparse against
    /// `mean`.
    fn densities(&self, errors: &CellErrors, mean: f64) -> Vec<f64> {
        let power = 2.0 * errors.order + 1.0;
        let density =
            |(cell, square): (&[f64], &f64)| (square / (cell[1] - cell[0]).powf(power)).powf(power.recip());
        let mut densities: Vec<f64> =
            self.nodes.windows(2).zip(&errors.squares).map(density).map(|d| d.max(SPARSEST * mean)).collect();
        for i in 1..densities.len() {
            densities[i] = densities[i].max(densities[i - 1] / GRADING);
        }
        for i in (1..densities.len()).rev() {
            densities[i - 1] = densities[i - 1].max(densities[i] / GRADING);
        }
        densities
    }

    /// The integral of a density over the cells.
    fn integral(&self, densities: &[f64]) -> f64 {
        self.nodes.windows(2).zip(densities).map(|(cell, d)| d * (cell[1] - cell[0])).sum()
    }

    /// Nodes with `per_cell` = ∫ d ds in each cell, or less.
    fn spread(&self, densities: &[f64], per_cell: f64) -> Self {
        let largest = densities.iter().copied().fold(0.0, f64::max);
        let smallest = densities.iter().copied().fold(f64::INFINITY, f64::min);
        let mut nodes = Vec::new();
        for part in self.fixed.windows(2) {
            let inside: Vec<(usize, &[f64])> = self
                .nodes
                .windows(2)
                .enumerate()
                .filter(|(_, cell)| cell[0] >= part[0] && cell[0] < part[1])
                .collect();
            let total: f64 = inside.iter().map(|(i, cell)| densities[*i] * (cell[1] - cell[0])).sum();
            let cells = number(total / per_cell).max(LEAST);
            if largest <= EVEN * smallest {
                nodes.extend(even(part[0], part[1], cells));
                continue;
            }
            let densest = inside.iter().map(|(i, _)| densities[*i]).fold(0.0, f64::max);
            let smallest = total / cells as f64 / densest;
            let (mut sum, mut next) = (0.0, 0);
            for (i, cell) in inside {
                let step = densities[i] * (cell[1] - cell[0]);
                while next < cells && next as f64 * total / cells as f64 <= sum + step {
                    let share = (next as f64 * total / cells as f64 - sum) / step;
                    let s = cell[0] + share.max(0.0) * (cell[1] - cell[0]);
                    nodes.push(if next == 0 { part[0] } else { rounded(s, smallest, [part[0], part[1]]) });
                    next += 1;
                }
                sum += step;
            }
        }
        nodes.extend(self.fixed.last());
        Self { nodes, fixed: self.fixed.clone() }
    }
}

/// Meshes for errors that are smaller as if `times` as many cells had been spread as they are now,
/// but with every cell where it is needed. At most `most` cells; beams without errors keep their
/// mesh.
pub(super) fn refined(meshes: &[Mesh], errors: &[Option<CellErrors>], times: f64, most: usize) -> Vec<Mesh> {
    let densities = |mean: f64| -> Vec<Option<Vec<f64>>> {
        let of = |(mesh, errors): (&Mesh, &Option<CellErrors>)| Some(mesh.densities(errors.as_ref()?, mean));
        meshes.iter().zip(errors).map(of).collect()
    };
    // Over all beams with errors: ∫ d ds, their length, their cells.
    let sums = |densities: &[Option<Vec<f64>>]| {
        let with = meshes.iter().zip(densities).filter_map(|(mesh, d)| Some((mesh, d.as_ref()?)));
        with.fold((0.0, 0.0, 0), |(sum, length, cells), (mesh, d)| {
            (sum + mesh.integral(d), length + mesh.length(), cells + mesh.cells())
        })
    };
    let plain = densities(0.0);
    let (sum, length, _) = sums(&plain);
    let mean = sum / length;
    if !(mean > 0.0 && mean.is_finite()) {
        // Nothing tells where: everywhere.
        let divided = |(mesh, errors): (&Mesh, &Option<CellErrors>)| match errors {
            Some(_) => mesh.divided((times.ceil() as usize).clamp(1, 4)),
            None => mesh.clone(),
        };
        return meshes.iter().zip(errors).map(divided).collect();
    }
    let graded = densities(mean);
    let (total, _, cells) = sums(&graded);
    // Σ η² as it is, against that of as many cells with equal shares.
    let order = errors.iter().flatten().map(|errors| errors.order).fold(0.0, f64::max);
    let power = 2.0 * order + 1.0;
    let now: f64 = meshes
        .iter()
        .zip(&graded)
        .filter_map(|(mesh, d)| Some((mesh, d.as_ref()?)))
        .flat_map(|(mesh, d)| {
            mesh.nodes.windows(2).zip(d).map(|(cell, d)| (d * (cell[1] - cell[0])).powf(power))
        })
        .sum();
    let gain = (total.powf(power) * (cells as f64).powf(1.0 - power) / now).min(1.0);
    // How fast errors fall on cells that are where they should be is only known when they are there.
    let times = if gain < UNEVEN { times.min(CAREFUL) } else { times };
    let number = cells as f64 * times * gain.powf((2.0 * order).recip());
    // Other places alone are not enough where cells are not far from them. Nor do they gain all of what is promised
    // where errors are large in a part of a cell only, of which the cell tells nothing.
    let number = number.max(if gain < UNEVEN { times.sqrt() } else { MORE } * cells as f64);
    let per_cell = total / number.min(most as f64);
    let spread = |(mesh, d): (&Mesh, &Option<Vec<f64>>)| match d {
        Some(d) => mesh.spread(d, per_cell),
        None => mesh.clone(),
    };
    meshes.iter().zip(&graded).map(spread).collect()
}

/// Number of cells of the meshes `now` in a cell of those `before`, there where these erred: the
/// geometric mean, weighted by the squares of errors; 1 where nothing erred. How many cells there are
/// elsewhere tells nothing of how errors fall.
pub(super) fn refinement(before: &[Mesh], errors: &[CellErrors], now: &[Mesh]) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for ((before, errors), now) in before.iter().zip(errors).zip(now) {
        for (cell, square) in before.nodes.windows(2).zip(&errors.squares) {
            let first = now.nodes.partition_point(|node| *node <= cell[0]).saturating_sub(1);
            let inside = now.nodes[first..].windows(2).take_while(|new| new[0] < cell[1]);
            let part = |new: &[f64]| (new[1].min(cell[1]) - new[0].max(cell[0])) / (new[1] - new[0]);
            sum += square * inside.map(part).sum::<f64>().log2();
            weights += square;
        }
    }
    if weights > 0.0 { (sum / weights).exp2() } else { 1.0 }
}

/// A place between two that must be nodes, to a thousandth of a cell: nobody wants to read more digits. What is rounded
/// is the distance from the nearer one, so that meshes of mirror images are mirror images: a perfect structure on another
/// mesh is not perfect, and chance would choose the side to which it buckles.
fn rounded(s: f64, cell: f64, [from, to]: [f64; 2]) -> f64 {
    let decimals = |cell: f64| (3.0 - cell.log10().floor()).clamp(0.0, 300.0) as usize;
    let to_decimals = |s: f64, decimals: usize| format!("{s:.decimals$}").parse().unwrap_or(s);
    let distance = |d: f64| to_decimals(d, decimals(cell));
    let middle = 0.5 * (from + to);
    let place = if distance((s - middle).abs()) == 0.0 {
        middle
    } else if s < middle {
        from + distance(s - from)
    } else {
        to - distance(to - s)
    };
    // Sums have digits of round-off.
    to_decimals(place, decimals(SAME * cell))
}

/// The least whole number that is not smaller than `x` but for round-off, which differs between mirror images.
fn number(x: f64) -> usize {
    (x * (1.0 - SAME)).ceil() as usize
}

/// The starts of `cells` even cells from `start` to `end`.
fn even(start: f64, end: f64, cells: usize) -> Vec<f64> {
    (0..cells).map(|i| start + (end - start) * i as f64 / cells as f64).collect()
}

/// By how much a stress-free centreline turns in all \[rad\].
pub(super) fn turning(curve: &Curve) -> f64 {
    const SAMPLES: usize = 256;
    let tangent = |i: usize| curve.tangent(curve.length() * i as f64 / SAMPLES as f64);
    let turn = |i: usize| {
        let ([a, b], [c, d]) = (tangent(i), tangent(i + 1));
        (a * d - b * c).atan2(a * c + b * d).abs()
    };
    (0..SAMPLES).map(turn).sum()
}

/// The nodes of a short part, but for its last: [`LEAST`] cells wherever a stiffness has changed by the
/// factor [`CHANGE`], such as on the sides of a notch.
fn graded(section: &Section, [from, to]: [f64; 2]) -> Vec<f64> {
    let middle = 0.5 * (from + to);
    let stiffnesses = [&section.bending_stiffness, &section.axial_stiffness].into_iter().flatten();
    let at = |stiffness: &Along, s: f64| stiffness.at(s, middle).ln();
    let change = |stiffness: &Along| at(stiffness, to) - at(stiffness, from);
    let largest = stiffnesses.max_by(|a, b| change(a).abs().total_cmp(&change(b).abs()));
    let steep = |stiffness: &&Along| (CHANGE.ln()..MOST_CHANGE).contains(&change(stiffness).abs());
    let Some(stiffness) = largest.filter(steep) else { return even(from, to, LEAST) };
    // Half of the change lies on either side.
    let half = at(stiffness, from) + 0.5 * change(stiffness);
    let (mut low, mut high) = (from, to);
    for _ in 0..HALVINGS {
        let s = 0.5 * (low + high);
        let before = (at(stiffness, s) < half) == (change(stiffness) > 0.0);
        *(if before { &mut low } else { &mut high }) = s;
    }
    let there = 0.5 * (low + high);
    if there - from < SAME * (to - from) || to - there < SAME * (to - from) {
        return even(from, to, LEAST);
    }
    [graded(section, [from, there]), graded(section, [there, to])].concat()
}

#[cfg(test)]
impl Mesh {
    /// A mesh of these nodes, none of which must be.
    pub fn of(nodes: &[f64]) -> Self {
        Self { nodes: nodes.into(), fixed: vec![nodes[0], nodes[nodes.len() - 1]] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(nodes: &[f64], fixed: &[f64]) -> Mesh {
        Mesh { nodes: nodes.into(), fixed: fixed.into() }
    }

    #[test]
    fn halves_and_coarser_meshes_are_inverse() {
        let coarse = mesh(&[0.0, 1.0, 4.0], &[0.0, 4.0]);
        let fine = coarse.halved();
        assert_eq!(fine.nodes, [0.0, 0.5, 1.0, 2.5, 4.0]);
        assert_eq!(fine.coarser(), coarse);
        let of = |nodes: &[f64]| mesh(nodes, &[0.0, nodes[nodes.len() - 1]]);
        // Two and a half cells of five in each of two.
        let five = of(&[0.0, 1.0, 2.0, 3.0, 6.0, 7.0]);
        assert_eq!((five.coarser().nodes, five.coarsening()), (vec![0.0, 2.5, 7.0], Some(2.5)));
        let one = of(&[0.0, 4.0]);
        assert_eq!((one.coarser().nodes, one.coarsening()), (vec![0.0, 4.0], None));
    }

    /// What is divided in one place only differs hardly if its long cells are those that were; short ones do not count.
    #[test]
    fn a_mesh_hardly_differs_where_its_long_cells_are_the_same() {
        let of = |nodes: &[f64]| mesh(nodes, &[0.0, 8.0]);
        let even = of(&[0.0, 2.0, 4.0, 6.0, 8.0]);
        assert!(!even.hardly_differs_from(&even.halved()));
        assert!(even.hardly_differs_from(&of(&[0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 7.0, 8.0])));
        // Half as long as the longest one is long.
        let all_but_one = of(&[0.0, 1.0, 3.0, 5.0, 6.5, 8.0]);
        assert!(of(&[0.0, 1.0, 5.0, 8.0]).hardly_differs_from(&all_but_one));
        let short = of(&[0.0, 0.125, 4.0, 8.0]);
        assert!(!short.hardly_differs_from(&of(&[0.0, 0.125, 2.0, 4.0, 6.0, 8.0])));
    }

    /// Of seven cells four are before the node that must be, one between it and the next one, and two behind.
    #[test]
    fn parts_between_nodes_that_must_be_are_coarsened_apart() {
        let fixed = mesh(&[0.0, 4.0, 5.0, 9.0], &[0.0, 4.0, 5.0, 9.0]);
        let found = fixed.with(&[0.0, 1.0, 2.0, 3.0, 4.0 + 1e-9, 7.0, 9.0]);
        assert_eq!(found.nodes, [0.0, 1.0, 2.0, 3.0, 4.0 + 1e-9, 5.0, 7.0, 9.0]);
        assert_eq!(found.coarser().nodes, [0.0, 2.0, 4.0 + 1e-9, 5.0, 9.0]);
        assert_eq!(found.coarsening(), None);
        // A force and a moment that are close, and both within a cell.
        let close = mesh(&[0.0, 5.0, 5.001, 9.0], &[0.0, 5.0, 5.001, 9.0]).with(&[0.0, 3.0, 4.998, 9.0]);
        assert_eq!((close.nodes, close.fixed), (vec![0.0, 3.0, 4.998, 9.0], vec![0.0, 4.998, 9.0]));
        let quartered = found.quartered_parts();
        assert_eq!(quartered.nodes.len(), 11);
        assert!((quartered.nodes[6] - 4.5).abs() < 1e-9 && quartered.coarsening() == Some(2.0));
    }

    #[test]
    fn cells_are_shorter_towards_a_jump() {
        let graded = mesh(&[0.0, 4.0, 12.0, 16.0], &[0.0, 4.0, 16.0]).graded_towards(&[4.0]);
        assert_eq!(graded.nodes, [0.0, 2.0, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 12.0, 16.0]);
        let coarse = || mesh(&[0.0, 4.0, 12.0, 16.0], &[0.0, 4.0, 16.0]);
        assert_eq!(coarse().longest_beside(4.0), 8.0);
        let down = coarse().graded_down_to(4.0, 3.0);
        assert_eq!(down.nodes, [0.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0]);
        assert_eq!(down.clone().graded_down_to(4.0, 3.0), down);
        assert_eq!(coarse().graded_down_to(4.0, f64::INFINITY), coarse());
    }

    /// On the side of a notch that is 1000 times as soft as the rest.
    #[test]
    fn a_short_part_has_nodes_where_its_stiffness_changes() {
        let side = Along::Table { s: vec![2.0, 3.0], value: vec![1e-3, 1.0] };
        let nodes = graded(&Section::new(1.0, side.clone()), [2.0, 3.0]);
        assert!(nodes[0] == 2.0 && nodes.len() >= 8 && nodes.len().is_multiple_of(2), "{nodes:?}");
        for pair in [nodes, vec![3.0]].concat().windows(3).step_by(2) {
            let change = side.at(pair[2], 2.5) / side.at(pair[0], 2.5);
            assert!(pair.is_sorted() && change > 1.0 && change <= CHANGE, "{pair:?}: {change}");
        }
        assert_eq!(graded(&Section::new(1.0, 2.0), [2.0, 3.0]), [2.0, 2.5]);
    }

    #[test]
    fn even_nodes_are_said_to_be_even() {
        assert_eq!(mesh(&[0.0, 0.5, 1.0], &[0.0, 1.0]).places(), Nodes::Uniform(3));
        let uneven = [0.0, 0.25, 1.0];
        assert_eq!(mesh(&uneven, &[0.0, 1.0]).places(), Nodes::Given(uneven.into()));
        let with_a_force = mesh(&[0.0, 0.5, 1.0], &[0.0, 0.5, 1.0]);
        assert_eq!(with_a_force.places(), Nodes::Given(with_a_force.nodes.clone()));
    }

    /// Equal cells that err alike stay equal; twice as many for errors as if there were twice as
    /// many.
    #[test]
    fn cells_that_err_alike_stay_alike() {
        let even = mesh(&[0.0, 0.25, 0.5, 0.75, 1.0], &[0.0, 1.0]);
        let errors = CellErrors { squares: vec![3.0; 4], order: 2.0 };
        let found = refined(std::slice::from_ref(&even), &[Some(errors)], 2.0, 100);
        assert_eq!(found[0], even.halved());
        assert_eq!(refined(std::slice::from_ref(&even), &[None], 2.0, 100), [even]);
    }

    /// η² = C² h⁵ in the first of four cells, and nothing elsewhere: cells are small there, and grow
    /// from cell to cell by not much more than the factor of two between the densities.
    #[test]
    fn cells_go_where_errors_are() {
        let even = mesh(&[0.0, 0.25, 0.5, 0.75, 1.0], &[0.0, 1.0]);
        let errors = CellErrors { squares: vec![1.0, 1e-12, 1e-12, 1e-12], order: 2.0 };
        let found = refined(&[even], &[Some(errors)], 4.0, 100).remove(0).nodes;
        let cells: Vec<f64> = found.windows(2).map(|cell| cell[1] - cell[0]).collect();
        let growths: Vec<f64> = cells.windows(2).map(|pair| pair[1] / pair[0]).collect();
        assert!(cells[0] < 0.25 * cells[cells.len() - 1], "{found:?}");
        assert!(growths.iter().all(|growth| *growth > 0.99 && *growth < 2.6), "{found:?}");
        assert!(found.contains(&0.0) && found.contains(&1.0));
    }

    #[test]
    fn nodes_are_added_where_none_is_near() {
        let mesh = Mesh::of(&[0.0, 1.0, 3.0]).and(&[2.0, 0.995, 1.004, 0.0, 3.0, 0.5]);
        assert_eq!(mesh.nodes, [0.0, 0.5, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn places_are_round_numbers_of_their_cells() {
        assert_eq!(rounded(0.123_456_7, 0.1, [0.0, 1.0]), 0.1235);
        assert_eq!(rounded(1.234_567_89e-5, 1e-6, [0.0, 1.0]), 1.2346e-5);
        assert_eq!(rounded(123.456_7, 20.0, [0.0, 1000.0]), 123.46);
        // What ends at a place that is not round is so from both ends, and a middle is one.
        let third = 1.0 / 3.0;
        let part = [0.1, 0.1 + third];
        assert_eq!(rounded(0.223_456_7, 0.1, part), 0.2235);
        assert!((rounded(0.1 + third - 0.123_456_7, 0.1, part) - (0.1 + third - 0.1235)).abs() < 1e-13);
        assert!((rounded(0.1 + 0.5 * third + 4e-5, 0.1, part) - (0.1 + 0.5 * third)).abs() < 1e-13);
    }

    /// Of a part whose cells err as their mirror images do, at lengths that are not round; and halves of a beam whose
    /// shares of the cells are whole but for round-off.
    #[test]
    fn meshes_of_mirror_images_are_mirror_images() {
        let third = 1.0 / 3.0;
        let spread = |densities: [f64; 6], each: f64, fixed: &[f64]| {
            let nodes = even(0.0, third, 6).into_iter().chain([third]).collect::<Vec<_>>();
            mesh(&nodes, fixed).spread(&densities, each).nodes
        };
        for cells in 2..40 {
            let each = third / 6.0 * 22.0 / f64::from(cells);
            let nodes = spread([9.0, 1.0, 1.0, 1.0, 1.0, 9.0], each, &[0.0, third]);
            let mirrored: Vec<f64> = nodes.iter().rev().map(|s| third - s).collect();
            assert_eq!(nodes.len() - 1, cells as usize);
            assert!(
                nodes.iter().zip(&mirrored).all(|(a, b)| (a - b).abs() < 1e-11),
                "{nodes:?} {mirrored:?}"
            );
            let one = spread([9.0, 1.0, 1.0, 1.0, 1.0, 3.0], each, &[0.0, third]);
            let other = spread([3.0, 1.0, 1.0, 1.0, 1.0, 9.0], each, &[0.0, third]);
            let near = |(a, b): (&f64, &f64)| (a + b - third).abs() < 1e-11;
            assert!(one.iter().zip(other.iter().rev()).all(near), "{one:?} {other:?}");
        }
        // A force at what is nearly the middle: halves of four cells have two each.
        for middle in [0.5 - 1e-16, 0.5, 0.5 + 2e-16] {
            let text = format!(
                "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1 }}\n\
                 support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
                 effect.force = [{{ beam = 'arm', at = {middle:?}, value = [1, 0] }}]\nanalysis.static = {{}}\n"
            );
            let found = first(&text, 0, 1.0).remove(0).nodes;
            assert!(found.len() == 5 && found[2] == middle, "{found:?}");
        }
    }

    fn first(text: &str, waves: usize, times: f64) -> Vec<Mesh> {
        let scene = crate::scene::parse("scene", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        Mesh::first(scene.model(), waves, times)
    }

    /// Worked out by hand: four cells along the longest beam, even numbers of them between the places
    /// of forces and supports.
    #[test]
    fn first_meshes_have_cells_in_proportion_and_nodes_where_they_must_be() {
        let text = "beam.arm = { start = [0, 0], end = [4, 0], axial_stiffness = 1, bending_stiffness = 1 }\n\
                    beam.rod = { start = [0, 1], end = [2, 1], axial_stiffness = 1, bending_stiffness = 1 }\n\
                    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, \
                    { beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'arm', at = 1.0, fix = ['y'] }]\n\
                    effect.force = [{ beam = 'arm', at = 1.0, value = [1, 0] }, { beam = 'rod', at = 'end', value = [0, 1] }]\n\
                    analysis.static = {}\n";
        let meshes = first(text, 0, 1.0);
        assert_eq!(meshes[0].fixed, [0.0, 1.0, 4.0]);
        assert_eq!(meshes[0].nodes, [0.0, 0.5, 1.0, 1.75, 2.5, 3.25, 4.0]);
        assert_eq!(meshes[1].nodes, [0.0, 1.0, 2.0]);
        assert!(meshes[1].is_one_part() && !meshes[0].is_one_part() && meshes[0].length() == 4.0);
        let cells =
            |waves: usize, times: f64| first(text, waves, times).iter().map(Mesh::cells).collect::<Vec<_>>();
        // Six half-waves have 10½ cells, 2¾ and 8¼ of 11 of the parts, 5¼ of the other beam; twice four have 14.
        assert_eq!((cells(6, 1.0), cells(4, 2.0)), (vec![4 + 10, 6], vec![4 + 12, 8]));
        assert_eq!((cells(3, 1.0), cells(3, 0.1)), (vec![2 + 6, 4], vec![2 + 4, 2]));
        assert_eq!(cells(0, 4.0), [4 + 12, 8]);
    }

    /// An eighth of a turn in a cell at most, whichever way it goes.
    #[test]
    fn bent_centrelines_have_more_cells() {
        let bent = |to: f64| {
            let text = format!(
                "beam.arm = {{ arc = {{ center = [0, 0], radius = 2, from = 0.0, to = {to:?} }}, axial_stiffness = 1, bending_stiffness = 1 }}\n\
                 support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\nanalysis.static = {{}}\n"
            );
            first(&text, 0, 1.0)[0].cells()
        };
        // 3.9 rad are a little less than five eighths of a turn, 5 rad are more than six; numbers are even.
        assert_eq!([0.2, 3.9, -3.9, 5.0].map(bent), [4, 6, 6, 8]);
        let arc = |to: f64| crate::model::Centreline::Arc { center: [0.0; 2], radius: 2.0, from: 0.0, to };
        for turn in [3.9, -3.9] {
            let found = turning(&Curve::new(&arc(turn)).unwrap());
            assert!((found - 3.9).abs() < 1e-9, "{found}");
        }
        // A period of a sine turns by 45° four times, here and back. A natural spline has no curvature at
        // its ends, as the sine.
        let wave =
            (0..=60).map(|i| f64::from(i) * std::f64::consts::PI / 30.0).map(|x| [x, x.sin()]).collect();
        let found = turning(&Curve::new(&crate::model::Centreline::Points(wave)).unwrap());
        assert!((found - std::f64::consts::PI).abs() < 1e-2, "{found}");
    }

    #[test]
    fn densities_grow_by_two_from_cell_to_cell_and_are_never_too_small() {
        let cells = mesh(&[0.0, 1.0, 2.0, 4.0], &[0.0, 4.0]);
        // d = (∫ η² ds/h⁵)^{1/5}.
        let densities = |squares: [f64; 3], mean: f64| {
            cells.densities(&CellErrors { squares: squares.into(), order: 2.0 }, mean)
        };
        let near = |found: Vec<f64>, expected: [f64; 3]| {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?} {expected:?}");
        };
        near(densities([32.0, 1.0, 32.0], 0.0), [2.0, 1.0, 1.0]);
        near(densities([1024.0, 0.0, 0.0], 0.0), [4.0, 2.0, 1.0]);
        near(densities([0.0, 0.0, 32768.0], 0.0), [1.0, 2.0, 4.0]);
        near(densities([32.0, 1.0, 32.0], 5.0), [2.0, 1.5, 1.5]);
        assert_eq!(cells.integral(&[2.0, 1.0, 0.5]), 4.0);
        // Of a string, whose direction is of third order: (128/h⁷)^{1/7}.
        let string =
            mesh(&[0.0, 1.0], &[0.0, 1.0]).densities(&CellErrors { squares: vec![128.0], order: 3.0 }, 0.0);
        assert!((string[0] - 2.0).abs() < 1e-14, "{string:?}");
    }

    #[test]
    fn nodes_are_spread_by_density_between_those_that_must_be() {
        let cells = |fixed: &[f64]| mesh(&[0.0, 1.0, 2.0], fixed);
        let spread =
            |fixed: &[f64], densities: [f64; 2], each: f64| cells(fixed).spread(&densities, each).nodes;
        // Five cells with 1 = ∫ d ds each, three with 5/3, of which 0.4167 m and 0.8333 m are the ends.
        assert_eq!(spread(&[0.0, 2.0], [4.0, 1.0], 1.0), [0.0, 0.25, 0.5, 0.75, 1.0, 2.0]);
        assert_eq!(spread(&[0.0, 2.0], [4.0, 1.0], 2.0), [0.0, 0.4167, 0.8333, 2.0]);
        assert_eq!(spread(&[0.0, 2.0], [1.0, 4.0], 1.0), [0.0, 1.0, 1.25, 1.5, 1.75, 2.0]);
        // Two cells at least between nodes that must be; even ones where densities differ little.
        assert_eq!(spread(&[0.0, 1.0, 2.0], [4.0, 1.0], 1.0), [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0]);
        assert_eq!(spread(&[0.0, 2.0], [3.0, 1.0], 1.0), [0.0, 0.5, 1.0, 1.5, 2.0]);
    }

    #[test]
    fn numbers_of_cells_follow_from_the_errors_of_equal_shares() {
        let refined_to = |nodes: &[f64], squares: &[f64], times: f64, most: usize| {
            let errors = CellErrors { squares: squares.into(), order: 2.0 };
            refined(&[Mesh::of(nodes)], &[Some(errors)], times, most).remove(0).nodes
        };
        // Densities of 2 and 1: equal shares would make the sum (3/2)⁵/2⁴/(1 + 1/32) = 0.46 of what it is,
        // so that 0.46^{1/4}·8 = 6.6 cells err as eight of this kind would.
        let squares = [1.0, 1.0 / 32.0];
        assert_eq!(refined_to(&[0.0, 0.5, 1.0], &squares, 4.0, 100).len(), 1 + 7);
        assert_eq!(refined_to(&[0.0, 0.5, 1.0], &squares, 3.0, 100).len(), 1 + 5);
        assert_eq!(refined_to(&[0.0, 0.5, 1.0], &squares, 40.0, 8).len(), 1 + 8);
        // All in the first of eight cells: densities of 8, 4, 2, 1, and then three tenths of their mean,
        // 0.6. Twice the cells at once and no more, times (2.174⁵/8⁴/1.032)^{1/4}, are 5.2 cells, but there are to be
        // 8·√2 = 11.3 at least.
        let even: Vec<f64> = (0..9).map(|i| f64::from(i) / 8.0).collect();
        let found = refined_to(&even, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 4.0, 100);
        // ∫ d ds is 1, 1/2, 1/4, 1/8 and 0.0747 four times in the old cells, and 0.1812 in each new one.
        let expected = [
            0.0, 0.022_64, 0.045_29, 0.067_93, 0.090_58, 0.113_22, 0.146_73, 0.192_02, 0.2373, 0.315_19,
            0.436_52, 0.6969, 1.0,
        ];
        assert_eq!(found.len(), expected.len(), "{found:?}");
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        // Where nothing tells where, cells are cut in up to four.
        let cut = |times: f64| refined_to(&[0.0, 0.5, 1.0], &[0.0, 0.0], times, 100).len() - 1;
        assert_eq!([0.5, 2.0, 2.3, 9.0].map(cut), [2, 4, 6, 8]);
    }

    /// Of four cells the first errs, in which eight new ones are, and a second one that errs as much is
    /// halved: the mean is that of 8 and 2. A cell that reaches beyond an old one counts by its part.
    #[test]
    fn cells_are_smaller_by_what_they_are_where_errors_were() {
        let before = Mesh::of(&[0.0, 1.0, 2.0, 3.0, 4.0]);
        let now = Mesh::of(&[0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0, 4.0]);
        let finer = |squares: [f64; 4]| {
            let errors = CellErrors { squares: squares.into(), order: 2.0 };
            refinement(std::slice::from_ref(&before), &[errors], std::slice::from_ref(&now))
        };
        assert_eq!(finer([1.0, 0.0, 0.0, 0.0]), 8.0);
        assert_eq!(finer([1.0, 1.0, 0.0, 0.0]), 4.0);
        assert_eq!([finer([0.0, 0.0, 0.0, 1.0]), finer([0.0; 4])], [0.5, 1.0]);
        let gathered = Mesh::of(&[0.0, 3.0, 4.0])
            .gathered(&before, &CellErrors { squares: vec![1.0, 2.0, 4.0, 8.0], order: 3.0 });
        assert_eq!(gathered, CellErrors { squares: vec![7.0, 8.0], order: 3.0 });
    }

    /// Cells go to the beam that errs, from the one that does not.
    #[test]
    fn beams_share_cells_by_their_errors() {
        let even = Mesh::of(&[0.0, 0.25, 0.5, 0.75, 1.0]);
        let errors = |square: f64| Some(CellErrors { squares: vec![square; 4], order: 2.0 });
        let found = refined(&[even.clone(), even], &[errors(32.0), errors(1.0)], 2.0, 100);
        // Densities of 2 and 1 as above, of four cells each: 0.46^{1/4}·16 = 13.2 cells, two thirds of them here.
        assert_eq!([found[0].cells(), found[1].cells()], [9, 5]);
    }
}
