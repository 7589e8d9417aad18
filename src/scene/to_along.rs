//! Quantities that may vary along a beam → [`Along`].

use std::ops::Range as ByteRange;

use crate::model::Along;

use super::error::Fault;
use super::file::{AlongBeam, AlongVector, PiecesTable, PlacesTable, VaryingTable};
use super::place::{Built, beam_index, place};
use super::quantity::{Measure, Quantity, Range};
use super::value::{At, Located};

const ONE: &str = "give a number, or one of `{ table = { s = [0.0, 0.5, 1.0], value = [3.0, 2.0, 1.0] } }`, \
                   `{ polynomial = [3.0, -2.0] }`, `{ pieces = { until = [0.5], value = [3.0, 2.0] } }`";

/// The stretch of a beam on which a part acts.
pub(super) struct Stretch {
    /// Index of the beam.
    pub(super) beam: usize,
    length: f64,
    /// From and to which arc length \[m\]; `None` for the whole beam.
    ends: Option<[f64; 2]>,
}

impl Stretch {
    /// The stretch of the beam `name` between `from` and `to`.
    pub(super) fn new(
        name: &Located<String>,
        from: Option<&Located<At>>,
        to: Option<&Located<At>>,
        built: &[Built],
    ) -> Result<Self, Fault> {
        let beam = beam_index(name, built)?;
        let length = built[beam].curve.length();
        let end = |at: Option<&Located<At>>, missing: f64| {
            at.map_or(Ok(missing), |at| place(name, at, built).map(|place| place.s))
        };
        let ends = [end(from, 0.0)?, end(to, length)?];
        if let (true, Some(at)) = (ends[1] - ends[0] <= At::ROUND_OFF * length, to.or(from)) {
            return Err(Fault::new(
                at.span(),
                format!("a stretch from {} m to {} m has no length", ends[0], ends[1]),
            )
            .help("`from` is an arc length before `to`"));
        }
        Ok(Self { beam, length, ends: (ends != [0.0, length]).then_some(ends) })
    }

    /// From and to which arc length \[m\], where it is not the whole beam.
    pub(super) fn part(&self) -> Option<[f64; 2]> {
        self.ends
    }

    /// From and to which arc length \[m\].
    pub(super) fn ends(&self) -> [f64; 2] {
        self.ends.unwrap_or([0.0, self.length])
    }

    /// 1 on this stretch, and 0 elsewhere.
    pub(super) fn indicator(&self) -> Along {
        match self.ends {
            Some(ends) => Along::Constant(1.0).within(ends),
            None => Along::Constant(1.0),
        }
    }

    /// The quantity `key` on this stretch.
    pub(super) fn quantity<M: Measure, R: Range>(
        &self,
        value: &Located<AlongBeam<M, R>>,
        key: &str,
    ) -> Result<Along, Fault> {
        let whole = along(value, key, self.length)?;
        Ok(match self.ends {
            Some(ends) if !whole.is_zero() => whole.within(ends),
            _ => whole,
        })
    }

    /// The quantity `key`, where it is given.
    pub(super) fn optional<M: Measure, R: Range>(
        &self,
        value: &Option<Located<AlongBeam<M, R>>>,
        key: &str,
    ) -> Result<Option<Along>, Fault> {
        value.as_ref().map(|value| self.quantity(value, key)).transpose()
    }

    /// The components of the vector `key` on this stretch.
    pub(super) fn vector<M: Measure>(&self, value: &AlongVector<M>, key: &str) -> Result<[Along; 2], Fault> {
        let [x, y] = &value.0;
        Ok([self.quantity(x, key)?, self.quantity(y, key)?])
    }
}

/// The quantity `key` of a beam of the given length \[m\].
pub(super) fn along<M: Measure, R: Range>(
    located: &Located<AlongBeam<M, R>>,
    key: &str,
    length: f64,
) -> Result<Along, Fault> {
    let varying = match located.get() {
        AlongBeam::Constant(value) => return Ok(Along::Constant(value.si)),
        AlongBeam::Varying(varying) => varying,
    };
    match varying {
        VaryingTable { table: Some(places), polynomial: None, pieces: None } => {
            let PlacesTable { s, value } = places.get();
            table(places.span(), s, si(value.get()), key, length)
        }
        VaryingTable { table: None, polynomial: Some(terms), pieces: None } => {
            let along = polynomial(si(terms.get()), terms.span(), key)?;
            within::<M, R>(along, terms.span(), key, length)
        }
        VaryingTable { table: None, polynomial: None, pieces: Some(of) } => {
            let PiecesTable { until, value } = of.get();
            pieces(of.span(), until, si(value.get()), key, length)
        }
        VaryingTable { table: None, polynomial: None, pieces: None } => {
            Err(Fault::new(located.span(), format!("`{key}` is an empty table")).help(ONE))
        }
        _ => Err(Fault::new(located.span(), format!("`{key}` varies in more than one way")).help(ONE)),
    }
}

fn si<M, R>(values: &[Quantity<M, R>]) -> Vec<f64> {
    values.iter().map(|value| value.si).collect()
}

fn table(
    span: ByteRange<usize>,
    places: &[Located<At>],
    values: Vec<f64>,
    key: &str,
    length: f64,
) -> Result<Along, Fault> {
    if places.len() != values.len() || places.len() < 2 {
        return Err(Fault::new(
            span,
            format!(
                "`{key}`: a table needs two places or more and a value for each; found {} places and {} values",
                places.len(),
                values.len()
            ),
        )
        .help("such as `table = { s = [0.0, 0.5, 1.0], value = [3.0, 2.0, 1.0] }`"));
    }
    let s = rising(places, key, length)?;
    let cover = |span: ByteRange<usize>, what: String| {
        Err(Fault::new(span, format!("`{key}`: {what} of the beam, which is {length} m long")).help(format!(
            "give values from s = 0 to s = {length} m, which is \"end\"; a value that goes on unchanged is written twice"
        )))
    };
    let (first, last) = (s[0], s[s.len() - 1]);
    if first > 0.0 {
        return cover(places[0].span(), format!("the table begins at {first} m, after the start"));
    }
    if last < length {
        return cover(places[s.len() - 1].span(), format!("the table ends at {last} m, before the end"));
    }
    Ok(Along::Table { s, value: values })
}

fn polynomial(terms: Vec<f64>, span: ByteRange<usize>, key: &str) -> Result<Along, Fault> {
    if terms.is_empty() {
        return Err(Fault::new(span, format!("`{key}`: a polynomial without coefficients"))
            .help("such as `polynomial = [3.0, -2.0]` for 3 − 2 s"));
    }
    Ok(Along::Polynomial(terms))
}

/// The polynomial, unless it leaves the range of its quantity on a beam of the given length.
fn within<M: Measure, R: Range>(
    along: Along,
    span: ByteRange<usize>,
    key: &str,
    length: f64,
) -> Result<Along, Fault> {
    let beyond = |bound: &f64| !R::contains(*bound) || !bound.is_finite();
    match along.bounds(length).into_iter().find(beyond) {
        None => Ok(along),
        Some(bad) => Err(Fault::new(
            span,
            format!(
                "`{key}`: this polynomial reaches {bad:.4e} {} on the beam, which is {length} m long",
                M::SI
            ),
        )
        .help(format!("it must be a {}{} from s = 0 to s = {length} m", R::WORD, M::NAME))),
    }
}

fn pieces(
    span: ByteRange<usize>,
    places: &[Located<At>],
    values: Vec<f64>,
    key: &str,
    length: f64,
) -> Result<Along, Fault> {
    let ends = rising(places, key, length)?;
    let inside: Vec<f64> = ends.iter().copied().take_while(|s| *s < length).collect();
    if let Some((place, _)) = places.iter().zip(&ends).next().filter(|(_, end)| **end <= 0.0) {
        return Err(Fault::new(place.span(), format!("`{key}`: the first piece has no length"))
            .help("`until` holds the arc length at which each piece ends"));
    }
    if let Some((beyond, end)) = places.iter().zip(&ends).nth(inside.len() + 1) {
        let message = format!(
            "`{key}`: a piece begins beyond the end of the beam, which is {length} m long, and ends at {end} m"
        );
        return Err(Fault::new(beyond.span(), message).help("leave it and its value out"));
    }
    if values.len() != inside.len() + 1 {
        return Err(Fault::new(
            span,
            format!(
                "`{key}`: {} pieces on the beam, which is {length} m long, and {} values",
                inside.len() + 1,
                values.len()
            ),
        )
        .help("each piece needs a value; the end of the last one may be left out: `pieces = { until = [0.5], value = [3.0, 2.0] }`"));
    }
    if inside.is_empty() {
        return Ok(Along::Constant(values[0]));
    }
    Ok(Along::Pieces { until: inside, value: values })
}

/// The arc lengths of `places` on a beam of the given length \[m\], which must rise.
fn rising(places: &[Located<At>], key: &str, length: f64) -> Result<Vec<f64>, Fault> {
    let s: Vec<f64> = places.iter().map(|place| place.get().on(length)).collect();
    match (1..s.len()).find(|k| s[*k] <= s[*k - 1]) {
        None => Ok(s),
        Some(k) => Err(Fault::new(
            places[k].span(),
            format!("`{key}`: arc lengths must rise; {} m follows {} m", s[k], s[k - 1]),
        )
        .help("for a jump use `pieces`")),
    }
}
