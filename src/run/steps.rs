//! Steps of fixed length that do not see what loads and supports do within them.

use crate::assembly::nodes;
use crate::effect::ForceField;
use crate::model::{Dynamic, Model, StepControl};
use crate::numeric::spread;
use crate::system::System;
use std::any::Any;
use std::f64::consts::PI;

/// Places, evenly spread over a motion, at which laws that may be anything are looked at …
const LOOKS: usize = 200;
/// … for so many steps, so that turns at their ends are seen …
const STEPS: usize = 4;
/// … at so many times.
const TIMES: usize = 64;
/// Changes of a law below this part of its largest value do not matter.
const STILL: f64 = 1e-3;

/// A message where a law of time goes through more than half a cycle in a step of fixed length: its values at the steps are then
/// those of a slower one. The motion is one from the state `begin` at the given time \[s\] to the time `end`.
pub(super) fn too_long(
    model: &Model,
    system: &System,
    settings: &Dynamic,
    (begin, q): (f64, &[f64]),
    end: f64,
) -> Option<String> {
    let StepControl::Fixed(step) = settings.integrator.step_control() else { return None };
    let turns = |law: &dyn Fn(f64) -> f64| turns_in_a_step(law, [begin, end], step);
    let of_laws = system.laws().map(|law| (law.fastest() * step / PI).max(turns(&|t| law.at(t)[0])));
    let of_fields = fields(model).flat_map(|field| {
        let part = &system.beams()[field.beam];
        let first = 4 * part.first_node;
        let nodes = nodes(&q[first..first + 4 * part.basis.nodes().len()]).map(|node| node.position);
        let at = nodes.collect::<Vec<_>>();
        let places = [at.first(), at.get(at.len() / 2), at.last()].into_iter().flatten().copied();
        let turns_at = |[x, y]: [f64; 2]| {
            (0..2).map(|axis| turns(&|t| field.field.at([x, y, t])[axis])).fold(0.0, f64::max)
        };
        places.map(turns_at).collect::<Vec<_>>()
    });
    let halves = of_laws.chain(of_fields).fold(0.0, f64::max);
    (halves > 1.0).then(|| {
        let cycles = 0.5 * halves;
        format!(
            "a load or a support follows a law of {:.3e} Hz or more, which goes through {cycles:.2} cycles in a step of {step:.3e} s: the motion is \
             that of a slower law; use steps below {:.1e} s, or a `tolerance`",
            cycles / step,
            0.1 * step / cycles
        )
    })
}

fn fields(model: &Model) -> impl Iterator<Item = &ForceField> {
    let fields =
        model.parts.iter().filter_map(|part| (part.as_ref() as &dyn Any).downcast_ref::<ForceField>());
    fields.filter(|field| field.field.depends_on_time())
}

/// How often a law turns back in a step, once in each half of a cycle, where it does so most often.
fn turns_in_a_step(law: &dyn Fn(f64) -> f64, [begin, end]: [f64; 2], step: f64) -> f64 {
    let steps = ((end - begin) / step).floor().max(1.0);
    let looks = LOOKS.min(steps as usize);
    let look = |look: usize| -> Vec<f64> {
        let start = begin + step * (look as f64 * steps / looks as f64).floor();
        spread(TIMES).map(|part| law(start + part * STEPS as f64 * step)).collect()
    };
    let values: Vec<Vec<f64>> = (0..looks).map(look).collect();
    // What is too small to matter beside the rest turns nothing.
    let largest = values.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
    let turns = |values: &Vec<f64>| {
        let changes = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|c| c.abs() > STILL * largest);
        let signs: Vec<bool> = changes.map(|change| change > 0.0).collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    values.iter().map(turns).max().unwrap_or(0) as f64 / STEPS as f64
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    #[test]
    fn laws_faster_than_the_steps_are_told() {
        let messages = |frequency: f64, steps: &str| {
            let text = format!(
                "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1e3, mass_per_length = 1, \
                 basis.ancf.elements = 1 }}\n\
                 effect.force = [{{ beam = 'rod', at = 'start', value = [1, 0], in_time.harmonic.frequency = {frequency} }}]\n\
                 analysis.dynamic = {{ duration = 0.02, generalized_alpha = {{ {steps} }} }}\n"
            );
            let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
            let results = scene.model().solve(scene.analysis()).expect("a motion");
            let told = results.run().warnings.iter().filter(|text| text.contains("a slower law"));
            told.cloned().collect::<Vec<_>>()
        };
        // Half a cycle a step of 1 ms is 500 Hz.
        assert_eq!([499.0, 501.0].map(|frequency| messages(frequency, "step = 1e-3").len()), [0, 1]);
        assert_eq!(messages(501.0, "tolerance = 1e-3"), [""; 0]);
        let told = messages(1500.0, "step = 1e-3").pop().expect("a warning");
        assert!(
            told.contains("a law of 1.500e3 Hz or more, which goes through 1.50 cycles in a step"),
            "{told}"
        );
        assert!(told.contains("use steps below 6.7e-5 s"), "{told}");
    }

    /// The same of laws by expression, alone and in a product, and of fields that change with time.
    #[test]
    fn laws_by_expression_are_looked_at() {
        let messages = |load: &str| {
            let text = format!(
                "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1e3, mass_per_length = 1, \
                 basis.ancf.elements = 1 }}\n{load}\nanalysis.dynamic = {{ duration = 0.05, generalized_alpha = {{ step = 1e-3 }} }}\n"
            );
            let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            let results = scene.model().solve(scene.analysis()).expect("a motion");
            results.run().warnings.iter().filter(|text| text.contains("a slower law")).count()
        };
        let force = |law: &str| {
            format!("effect.force = [{{ beam = 'rod', at = 'start', value = [1, 0], in_time.{law} }}]")
        };
        let field =
            |value: &str| format!("effect.force_field = [{{ beam = 'rod', value = ['0', '{value}'] }}]");
        for (frequency, told) in [(300, 0), (700, 1), (1000, 1)] {
            assert_eq!(
                messages(&force(&format!("expression = 'cos(2*pi*{frequency}*t)'"))),
                told,
                "{frequency}"
            );
            let product = format!(
                "product = [{{ expression = 'sin(2*pi*{frequency}*t)' }}, {{ ramp = {{ duration = 0.05 }} }}]"
            );
            assert_eq!(messages(&force(&product)), told, "{frequency} in a product");
            assert_eq!(messages(&field(&format!("cos(2*pi*{frequency}*t)"))), told, "{frequency} in a field");
        }
        // A single pulse within a step is no oscillation, nor is a constant.
        assert_eq!(messages(&force("expression = 'exp(-((t-0.0205)/2e-4)^2)'")), 0);
        assert_eq!(messages(&field("0.1*x")), 0);
    }
}
