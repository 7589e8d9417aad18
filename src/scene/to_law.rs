//! Tables of laws → [`Law`].

use crate::model::{Expression, Law, Tabulated};

use super::error::Fault;
use super::file::{ExpressionTable, KinkedTable, LawTable, RampTable};
use super::value::Located;

const ONE: &str = "give one of `ramp = { duration = \"1 s\" }`, `smooth_ramp = { … }`, `step = { start = \"1 s\" }`, \
                   `harmonic = { frequency = \"2 Hz\" }`, `polynomial = [0, 1]`, `table = { times = [0, 1], values = [0, 1] }`, `sum = [{ … }, { … }]`, `product = [{ … }, { … }]`, `expression = \"sin(2*pi*t)\"`";

/// The law of a table `in_time`.
pub(super) fn law(located: &Located<LawTable>) -> Result<Law, Fault> {
    let LawTable { ramp, smooth_ramp, step, harmonic, polynomial, table, sum, product, expression } =
        located.get();
    let times = |ramp: &RampTable| (ramp.start.map_or(0.0, |start| start.si), ramp.duration.si);
    let mut laws = Vec::new();
    if let Some(ramp) = ramp {
        let (start, duration) = times(ramp);
        laws.push(Law::Ramp { start, duration });
    }
    if let Some(ramp) = smooth_ramp {
        let (start, duration) = times(ramp);
        laws.push(Law::SmoothRamp { start, duration });
    }
    if let Some(step) = step {
        laws.push(Law::Step { start: step.start.si });
    }
    if let Some(harmonic) = harmonic {
        let phase = harmonic.phase.map_or(0.0, |phase| phase.si);
        laws.push(Law::Harmonic { frequency: std::f64::consts::TAU * harmonic.frequency.si, phase });
    }
    if let Some(coefficients) = polynomial {
        laws.push(Law::Polynomial(coefficients.iter().map(|c| c.si).collect()));
    }
    if let Some(located) = table {
        let points = located.get();
        let times: Vec<f64> = points.times.iter().map(|t| t.si).collect();
        let values: Vec<f64> = points.values.iter().map(|v| v.si).collect();
        let (m, n) = (times.len(), values.len());
        let table = Tabulated::new(times, values, points.smooth).ok_or_else(|| {
            Fault::new(
                located.span(),
                format!("a law needs two points or more at increasing times; found {m} times and {n} values"),
            )
            .help("such as `table = { times = [0.0, \"1 s\", 2.5], values = [0.0, 1.0, 0.5] }`")
        })?;
        laws.push(Law::Table(table));
    }
    for (several, of) in [(sum, Law::Sum as fn(Vec<Law>) -> Law), (product, Law::Product)] {
        if let Some(several) = several {
            if several.is_empty() {
                return Err(Fault::new(located.span(), "a sum or a product of no law").help(ONE));
            }
            laws.push(of(several.iter().map(law).collect::<Result<_, _>>()?));
        }
    }
    if let Some(expression) = expression {
        let (text, kinks) = match expression.get() {
            ExpressionTable::Smooth(text) => (text, Vec::new()),
            ExpressionTable::Kinked(KinkedTable { of, kinks }) => (of, kinks.iter().map(|t| t.si).collect()),
        };
        let law = Expression::new(text, kinks).map_err(|reason| {
            Fault::new(expression.span(), format!("this expression cannot be read: {reason}"))
                .help("such as `expression = \"sin(2*pi*t)*(1-exp(-t/0.5))\"`, with t in seconds")
        })?;
        laws.push(Law::Expression(Box::new(law)));
    }
    match (laws.pop(), laws.is_empty()) {
        (Some(law), true) => Ok(law),
        (None, _) => Err(Fault::new(located.span(), "an empty `in_time`").help(ONE)),
        (Some(_), false) => Err(Fault::new(located.span(), "more than one law in `in_time`").help(ONE)),
    }
}
