//! A beam's `basis` table → [`Discretization`] and Gauss points, with the bounds that keep memory
//! sane.

use crate::model::{
    ANCF_GAUSS_POINTS, Discretization, GaussPoints, Kernel, Nodes, RPIM_GAUSS_POINTS, RPIM_KERNEL,
    RPIM_NEIGHBOURS, RPIM_POLYNOMIAL_TERMS, RPIM_SIDE_CONDITION, STRING_GAUSS_POINTS, SideCondition,
};

use super::error::Fault;
use super::file::{
    AncfTable, BasisTable, GaussPointsTable, KernelTable, RpimTable, RuleName, SideConditionName, SpacingName,
};
use super::value::{Located, NodeList};

/// Most nodes of a scene.
pub const MAX_NODES: f64 = 1e7;
/// Most memory that tables and tangent of a scene may need \[GiB\].
pub const MAX_MEMORY: f64 = 64.0;
/// Most Gauss points in a cell.
pub const MAX_GAUSS_POINTS: u64 = 64;
/// Most neighbours on each side of a cell: moment matrices grow with the square of it.
pub const MAX_NEIGHBOURS: u64 = 16;

/// Nodes and memory that a discretisation will need, to be summed over the beams of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Size {
    pub nodes: f64,
    /// Memory of shape-function tables, the banded tangent and its factors [GiB].
    pub memory: f64,
}

/// The discretisation that `basis` asks for, on a beam of the given length \[m\], which may lock if
/// it resists both stretch and bending; without a `basis` it is to be chosen.
pub(super) fn discretization(
    beam: &str,
    basis: Option<&Located<BasisTable>>,
    length: f64,
    locks: bool,
) -> Result<(Discretization, GaussPoints, Size), Fault> {
    let Some(basis) = basis else {
        let gauss = if locks { ANCF_GAUSS_POINTS } else { STRING_GAUSS_POINTS };
        return Ok((Discretization::Open, gauss, Size::default()));
    };
    let table = basis.get();
    let (discretization, gauss, nodes, width) = match (&table.ancf, &table.rpim) {
        (Some(ancf), None) => {
            let (nodes, gauss) = ancf_table(beam, ancf, length, locks)?;
            let count = nodes.count() as f64;
            (Discretization::Ancf { nodes }, gauss, count, 4.0)
        }
        (None, Some(rpim)) => {
            let (discretization, gauss) = rpim_table(beam, rpim, length)?;
            let Discretization::Rpim { nodes, neighbours, .. } = &discretization else {
                return Err(Fault::new(rpim.span(), "internal: not an RPIM discretisation"));
            };
            let (count, width) = (nodes.count() as f64, 2.0 * (2 * neighbours + 2) as f64);
            (discretization, gauss, count, width)
        }
        (Some(_), Some(other)) => {
            return Err(Fault::new(other.span(), format!("beam `{beam}` has two bases, `ancf` and `rpim`"))
                .help(format!("keep one; to change it from outside, replace the whole table: --set 'beam.{beam}.basis={{ rpim = {{ nodes = 7 }} }}'")));
        }
        (None, None) => {
            return Err(Fault::new(basis.span(), format!("beam `{beam}` has an empty `basis`"))
                .help("give one kind: `[beam.NAME.basis.ancf]` with `elements = 10`, or `[beam.NAME.basis.rpim]` with `nodes = 11`"));
        }
    };
    // The two components share a table. The band of the tangent is stored with its fill-in: three
    // half bandwidths and the diagonal for each unknown.
    let tables = (nodes - 1.0) * (gauss.stretch + gauss.bend) as f64 * 3.0 * width * 8.0;
    let tangent = 4.0 * nodes * (3.0 * (2.0 * width - 1.0) + 1.0) * 8.0;
    let size = Size { nodes, memory: (tables + tangent) / 1024f64.powi(3) };
    Ok((discretization, gauss, size))
}

/// Refuses a scene that no computer of today could hold.
pub(super) fn check_size(total: Size, basis: &Located<BasisTable>) -> Result<(), Fault> {
    if total.nodes > MAX_NODES || total.memory > MAX_MEMORY {
        return Err(Fault::new(
            basis.span(),
            format!("the scene asks for {} nodes, which need about {:.3e} GiB", total.nodes, total.memory),
        )
        .help(format!("a scene may have up to {MAX_NODES:e} nodes and need up to {MAX_MEMORY} GiB")));
    }
    Ok(())
}

/// A count that fits the machine; far larger ones are refused by [`check_size`] with the memory
/// they need.
fn to_usize(count: u64) -> usize {
    usize::try_from(count).unwrap_or(usize::MAX)
}

fn ancf_table(
    beam: &str,
    ancf: &Located<AncfTable>,
    length: f64,
    locks: bool,
) -> Result<(Nodes, GaussPoints), Fault> {
    let table = ancf.get();
    let spacing = table.spacing.as_ref();
    let nodes = match (&table.elements, &table.nodes) {
        (Some(elements), None) => counted(elements.get().0.saturating_add(1), spacing),
        (None, Some(nodes)) => node_places(beam, nodes, spacing, length)?,
        (Some(elements), Some(_)) => {
            return Err(Fault::new(
                elements.span(),
                format!("beam `{beam}` has both `elements` and `nodes`"),
            )
            .help("keep one of them; elements = nodes − 1"));
        }
        (None, None) => {
            return Err(Fault::new(ancf.span(), format!("beam `{beam}`: ancf needs `elements` or `nodes`"))
                .help("such as `elements = 10`, or `nodes = [0.0, \"45 cm\", 1.8]`"));
        }
    };
    let usual = if locks { ANCF_GAUSS_POINTS } else { STRING_GAUSS_POINTS };
    Ok((nodes, gauss_points(table.gauss_points.as_ref(), usual)?))
}

fn rpim_table(
    beam: &str,
    rpim: &Located<RpimTable>,
    length: f64,
) -> Result<(Discretization, GaussPoints), Fault> {
    let table = rpim.get();
    let nodes = node_places(beam, &table.nodes, table.spacing.as_ref(), length)?;
    let neighbours = match &table.neighbours {
        Some(n) if n.get().0 > MAX_NEIGHBOURS => {
            return Err(Fault::new(n.span(), format!("found {} neighbours on each side", n.get().0))
                .help(format!("from 0 to {MAX_NEIGHBOURS} are legal; 2 is the usual choice")));
        }
        Some(n) => to_usize(n.get().0),
        None => RPIM_NEIGHBOURS,
    };
    // Supports are clipped at the beam's ends; the smallest one decides how many terms it can
    // carry.
    let smallest = (nodes.count() as f64).min((2 + neighbours) as f64);
    let polynomial_terms = match &table.polynomial_terms {
        Some(m) if m.get().0 as f64 > 2.0 * smallest => {
            return Err(Fault::new(
                m.span(),
                format!("{} polynomial terms, but the smallest support has {smallest} nodes", m.get().0),
            )
            .help(format!(
                "{smallest} nodes with value and slope carry at most {} terms; 2 is the usual choice",
                2.0 * smallest
            )));
        }
        Some(m) => to_usize(m.get().0),
        None => RPIM_POLYNOMIAL_TERMS,
    };
    let discretization = Discretization::Rpim {
        nodes,
        kernel: table.kernel.as_ref().map_or(Ok(RPIM_KERNEL), kernel)?,
        polynomial_terms,
        side_condition: match table.side_condition {
            Some(SideConditionName::Plus) => SideCondition::Plus,
            Some(SideConditionName::Minus) => SideCondition::Minus,
            None => RPIM_SIDE_CONDITION,
        },
        neighbours,
    };
    Ok((discretization, gauss_points(table.gauss_points.as_ref(), RPIM_GAUSS_POINTS)?))
}

fn kernel(kernel: &Located<KernelTable>) -> Result<Kernel, Fault> {
    let KernelTable { multiquadric, exponential, thin_plate_spline, wendland } = kernel.get();
    match (multiquadric, exponential, thin_plate_spline, wendland) {
        (Some(mq), None, None, None) => {
            let q = mq.q.get().si;
            if q >= 0.0 && q.fract() == 0.0 {
                return Err(Fault::new(mq.q.span(), format!("multiquadric exponent q = {q}")).help(
                    "with q = 0, 1, 2, … the kernel is a polynomial and cannot interpolate; try 0.98 or 1.03",
                ));
            }
            Ok(Kernel::Multiquadric { q, shape: mq.shape.si })
        }
        (None, Some(exponential), None, None) => Ok(Kernel::Exponential { shape: exponential.shape.si }),
        (None, None, Some(spline), None) => {
            let exponent = spline.exponent.get().si;
            if exponent <= 3.0 {
                return Err(Fault::new(
                    spline.exponent.span(),
                    format!("thin plate spline exponent {exponent}"),
                )
                .help(
                    "it must be larger than 3, because three derivatives must exist at distance zero; try 5",
                ));
            }
            Ok(Kernel::ThinPlateSpline { exponent })
        }
        (None, None, None, Some(wendland)) => Ok(Kernel::Wendland { radius: wendland.radius.si }),
        _ => Err(Fault::new(kernel.span(), "`kernel` must name exactly one radial function").help(
            "one of `kernel.multiquadric = { q = 1.03, shape = 3.3 }`, `kernel.exponential = { shape = … }`, \
             `kernel.thin_plate_spline = { exponent = … }`, `kernel.wendland = { radius = … }`",
        )),
    }
}

fn gauss_points(table: Option<&GaussPointsTable>, default: GaussPoints) -> Result<GaussPoints, Fault> {
    let Some(table) = table else { return Ok(default) };
    for count in [&table.stretch, &table.bend] {
        if count.get().0 > MAX_GAUSS_POINTS {
            return Err(Fault::new(count.span(), format!("found {} Gauss points in a cell", count.get().0))
                .help(format!("from 1 to {MAX_GAUSS_POINTS} are legal")));
        }
    }
    let rule = table.stretch_rule.as_ref().map(|rule| *rule.get()).unwrap_or_default();
    if rule == RuleName::Lobatto && table.stretch.get().0 < 2 {
        return Err(Fault::new(table.stretch.span(), "found 1 point by Lobatto's rule")
            .help("it has both ends of a cell among its points: give 2 or more"));
    }
    Ok(GaussPoints {
        stretch: to_usize(table.stretch.get().0),
        bend: to_usize(table.bend.get().0),
        lobatto: rule == RuleName::Lobatto,
    })
}

fn counted(count: u64, spacing: Option<&Located<SpacingName>>) -> Nodes {
    match spacing.map(|s| *s.get()).unwrap_or_default() {
        SpacingName::Uniform => Nodes::Uniform(to_usize(count)),
        SpacingName::Chebyshev => Nodes::Chebyshev(to_usize(count)),
    }
}

fn node_places(
    beam: &str,
    nodes: &Located<NodeList>,
    spacing: Option<&Located<SpacingName>>,
    length: f64,
) -> Result<Nodes, Fault> {
    let list = match nodes.get() {
        NodeList::Count(count) => return Ok(counted(*count, spacing)),
        NodeList::At(list) => list,
    };
    let example = format!("arc lengths must increase from 0 to the beam's length {length} m");
    if let Some(spacing) = spacing {
        return Err(Fault::new(spacing.span(), format!("beam `{beam}`: `spacing` beside a list of nodes"))
            .help("`spacing` goes with a number of nodes; leave it out, or give `nodes = N`"));
    }
    let (Some(first), Some(last), true) = (list.first(), list.last(), list.len() >= 2) else {
        return Err(
            Fault::new(nodes.span(), format!("expected 2 nodes or more, found {}", list.len())).help(example)
        );
    };
    for (index, pair) in list.windows(2).enumerate() {
        let [left, right] = pair else { continue };
        if right.get().si <= left.get().si {
            return Err(Fault::new(
                right.span(),
                format!(
                    "nodes out of order: node {} at {} m does not come after node {index} at {} m",
                    index + 1,
                    right.get().si,
                    left.get().si
                ),
            )
            .help(example));
        }
    }
    // Ends typed with fewer digits than L has are meant as the ends.
    let near = 1e-9 * length;
    if first.get().si.abs() > near {
        return Err(Fault::new(first.span(), format!("the first node is at {} m, not at 0", first.get().si))
            .help(example));
    }
    if (last.get().si - length).abs() > near {
        return Err(Fault::new(
            last.span(),
            format!("the last node is at {} m, not at the beam's end at {length} m", last.get().si),
        )
        .help(example));
    }
    let mut places: Vec<f64> = list.iter().map(|s| s.get().si).collect();
    if let Some(first) = places.first_mut() {
        *first = 0.0;
    }
    if let Some(last) = places.last_mut() {
        *last = length;
    }
    if !places.is_sorted_by(|a, b| a < b) {
        return Err(Fault::new(nodes.span(), "two nodes coincide at an end of the beam").help(example));
    }
    Ok(Nodes::Given(places))
}
