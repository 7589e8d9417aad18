//! Warnings on tendons that push, and on beams that are bent about a centre within the tendon.

use crate::assembly::TendonPath;
use crate::effect;
use crate::law::Law;
use crate::model::{Model, StrainMeasure};
use crate::numeric::plain;
use crate::results::{Shape, Tension};
use std::any::Any;

/// Share of the largest tension that counts as none.
const SLACK: f64 = 1e-6;

/// The tendons of a model, and what was seen of them.
#[derive(Clone)]
pub(super) struct Tendons<'m> {
    all: Vec<Tendon<'m>>,
}

#[derive(Clone)]
struct Tendon<'m> {
    beam: usize,
    name: &'m str,
    measure: StrainMeasure,
    path: &'m TendonPath,
    law: Option<&'m Law>,
    /// Whether its length is given, not its tension.
    held: bool,
    /// Whether it acts in full whatever the load factor is.
    standing: bool,
    /// The load factor or time at which it pushed most, and the factor of its tension there.
    pushed: Option<(f64, f64)>,
    /// For one of given length, the least tension \[N\] with the load factor or time of it, and the
    /// largest size of its tension.
    tensions: Option<(f64, f64, f64)>,
    /// Arc length \[m\] at which the beam was bent too far.
    folded: Option<f64>,
}

impl<'m> Tendons<'m> {
    /// Those of `model`; in statics, `is_static`, tensions grow with the load factor.
    pub(super) fn new(model: &'m Model, is_static: bool) -> Self {
        let tendon = |(number, part): (usize, &'m std::sync::Arc<dyn crate::assembly::Part>)| {
            let (beam, path, law) = part.tendon()?;
            let of = model.beams.get(beam)?;
            let part: &dyn Any = &**part;
            let held = part.downcast_ref::<effect::Tendon>().is_some_and(|of| of.shortening.is_some());
            let standing = !is_static || model.stands(number);
            let (name, measure) = (of.name.as_str(), of.strain);
            let (pushed, tensions, folded) = Default::default();
            Some(Tendon { beam, name, measure, path, law, held, standing, pushed, tensions, folded })
        };
        Self { all: model.parts.iter().enumerate().filter_map(tendon).collect() }
    }

    /// Whether there are any.
    pub(super) fn are_there(&self) -> bool {
        !self.all.is_empty()
    }

    /// Takes a load factor or a time into account.
    pub(super) fn see_factor(&mut self, parameter: f64) {
        for tendon in self.all.iter_mut().filter(|tendon| !tendon.held) {
            let factor = match tendon.law {
                Some(law) => law.at(parameter)[0],
                None if tendon.standing => 1.0,
                None => parameter,
            };
            if factor < tendon.pushed.map_or(0.0, |(_, least)| least) {
                tendon.pushed = Some((parameter, factor));
            }
        }
    }

    /// Takes into account the tensions \[N\] of the tendons of given length at a load factor or a time.
    pub(super) fn see_tensions(&mut self, parameter: f64, tensions: impl Iterator<Item = f64>) {
        for (tendon, tension) in self.all.iter_mut().filter(|tendon| tendon.held).zip(tensions) {
            let (at, least, size) = tendon.tensions.unwrap_or((parameter, tension, 0.0));
            let (at, least) = if tension < least { (parameter, tension) } else { (at, least) };
            tendon.tensions = Some((at, least, size.max(tension.abs())));
        }
    }

    /// Takes a state into account.
    pub(super) fn see(&mut self, shapes: &[Shape]) {
        for Tendon { beam, measure, path, folded, .. } in &mut self.all {
            let shape = &shapes[*beam];
            let [from, to] = path.ends;
            let strains = shape.strain.iter().zip(&shape.curvature);
            let bent = shape.s.iter().zip(strains).find(|(s, (strain, curvature))| {
                let along = measure.stretch(**strain) - path.offset.at(**s, **s) * **curvature;
                (from..=to).contains(*s) && along <= 0.0
            });
            *folded = folded.or(bent.map(|(s, _)| *s));
        }
    }

    /// The tensions of those of given length, of which `tensions` \[N\] are known.
    pub(super) fn tensions(&self, tensions: impl Iterator<Item = f64>) -> Vec<Tension> {
        let held = self.all.iter().filter(|tendon| tendon.held);
        held.zip(tensions)
            .map(|(tendon, tension)| Tension { beam: tendon.name.to_owned(), tension })
            .collect()
    }

    /// What to say of them.
    pub(super) fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        self.all.iter().flat_map(|Tendon { name, pushed, tensions, folded, .. }| {
            let slack = tensions.filter(|(_, least, size)| *least < -SLACK * size).map(|(at, least, _)| {
                format!(
                    "a tendon of beam `{name}`, whose length is given, pushes with {:.4e} N at {}, which no real tendon can: it would be \
                     slack there; shorten it more, or give it a `tension`",
                    -least,
                    plain(at, 6)
                )
            });
            let pushed = pushed.map(|(at, factor)| {
                format!(
                    "a tendon of beam `{name}` pushes with {:.4} times its tension at {}, which no real tendon can: let its law, or the load \
                     factor, not become negative",
                    -factor,
                    plain(at, 6)
                )
            });
            let folded = folded.map(|s| {
                format!(
                    "beam `{name}` is bent at s = {} m about a centre that lies between it and its tendon, where sections would cross: use a \
                     smaller `offset` or `tension`",
                    plain(s, 4)
                )
            });
            [pushed, slack, folded].into_iter().flatten()
        })
    }
}
