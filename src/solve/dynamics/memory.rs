//! What integration methods carry from step to step, in the form that a saved state stores.

use serde::{Deserialize, Serialize};

/// The memory of a method, by its kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Memory {
    /// No memory: no step has been taken.
    #[default]
    None,
    /// Of Gauss' and Radau's methods.
    Collocation(CollocationMemory),
    /// Of generalised-α.
    GeneralizedAlpha(GeneralizedAlphaMemory),
}

/// Data that Gauss' and Radau's methods carry.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CollocationMemory {
    /// Length of the last step \[s\]; 0 before the first.
    pub last_step: f64,
    /// Whether a polynomial predicts stages better than a mean.
    pub smooth: bool,
    /// Accelerations in the stages of the last step.
    pub accelerations: Vec<Vec<f64>>,
    /// Scaled multipliers in these stages.
    pub multipliers: Vec<Vec<f64>>,
    /// The tangent that is kept.
    pub tangent: Option<TangentMemory>,
    /// The step for which it is factorised \[s\].
    pub tangent_step: f64,
}

/// Data that generalised-α carries.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeneralizedAlphaMemory {
    /// Accelerations at the end of the last step.
    pub physical: Vec<f64>,
    /// The accelerations by which the method advances.
    pub algorithmic: Vec<f64>,
    /// Scaled multipliers.
    pub multipliers: Vec<f64>,
    /// Accelerations before the last step, and its length \[s\].
    pub before: Option<(Vec<f64>, f64)>,
    /// Whether the last step ended at a kink of loads or supports.
    #[serde(default)]
    pub passed: bool,
    /// The tangent that is kept.
    pub tangent: Option<TangentMemory>,
    /// c and d of the matrix K + dD + cM that is factorised with it; c is 0 where none is.
    pub factorized: [f64; 2],
}

/// Data from which a tangent is computed again.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TangentMemory {
    /// When it was taken \[s\].
    pub time: f64,
    /// Coordinates there.
    pub q: Vec<f64>,
    /// Velocities there.
    pub v: Vec<f64>,
    /// Scaled multipliers there.
    pub multipliers: Vec<f64>,
    /// The factor by which an iteration with it shrinks the increments.
    pub rate: f64,
}

impl Memory {
    /// Whether all its numbers are finite.
    pub fn is_finite(&self) -> bool {
        let all = |values: &[f64]| values.iter().all(|v| v.is_finite());
        let tangent = |tangent: &Option<TangentMemory>| {
            tangent.as_ref().is_none_or(|TangentMemory { time, q, v, multipliers, rate }| {
                all(&[*time, *rate]) && all(q) && all(v) && all(multipliers)
            })
        };
        match self {
            Self::None => true,
            Self::Collocation(memory) => {
                all(&[memory.last_step, memory.tangent_step])
                    && memory.accelerations.iter().chain(&memory.multipliers).all(|stage| all(stage))
                    && tangent(&memory.tangent)
            }
            Self::GeneralizedAlpha(memory) => {
                [&memory.physical, &memory.algorithmic, &memory.multipliers].into_iter().all(|v| all(v))
                    && memory.before.as_ref().is_none_or(|(before, step)| all(before) && step.is_finite())
                    && all(&memory.factorized)
                    && tangent(&memory.tangent)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tangent() -> TangentMemory {
        TangentMemory { time: 1.0, q: vec![1.0], v: vec![1.0], multipliers: vec![1.0], rate: 0.5 }
    }

    fn collocation() -> CollocationMemory {
        CollocationMemory {
            last_step: 0.1,
            smooth: true,
            accelerations: vec![vec![1.0, 2.0]; 2],
            multipliers: vec![vec![3.0]; 2],
            tangent: Some(tangent()),
            tangent_step: 0.1,
        }
    }

    fn generalized_alpha() -> GeneralizedAlphaMemory {
        GeneralizedAlphaMemory {
            physical: vec![1.0],
            algorithmic: vec![1.0],
            multipliers: vec![1.0],
            before: Some((vec![1.0], 0.1)),
            passed: true,
            tangent: Some(tangent()),
            factorized: [1.0, 2.0],
        }
    }

    /// Would catch a number that is not checked: each in turn is NaN.
    #[test]
    fn no_number_is_overlooked() {
        let of_tangent: [fn(&mut TangentMemory) -> &mut f64; 5] =
            [|t| &mut t.time, |t| &mut t.q[0], |t| &mut t.v[0], |t| &mut t.multipliers[0], |t| &mut t.rate];
        let of_collocation: [fn(&mut CollocationMemory) -> &mut f64; 4] = [
            |m| &mut m.last_step,
            |m| &mut m.accelerations[1][1],
            |m| &mut m.multipliers[1][0],
            |m| &mut m.tangent_step,
        ];
        let of_alpha: [fn(&mut GeneralizedAlphaMemory) -> &mut f64; 7] = [
            |m| &mut m.physical[0],
            |m| &mut m.algorithmic[0],
            |m| &mut m.multipliers[0],
            |m| &mut m.before.as_mut().unwrap().0[0],
            |m| &mut m.before.as_mut().unwrap().1,
            |m| &mut m.factorized[0],
            |m| &mut m.factorized[1],
        ];
        let altered = |number: &mut f64| *number = f64::NAN;
        let mut all = Vec::new();
        for of in of_collocation {
            let mut memory = collocation();
            altered(of(&mut memory));
            all.push(Memory::Collocation(memory));
        }
        for of in of_alpha {
            let mut memory = generalized_alpha();
            altered(of(&mut memory));
            all.push(Memory::GeneralizedAlpha(memory));
        }
        for of in of_tangent {
            let mut tangent = tangent();
            altered(of(&mut tangent));
            all.push(Memory::Collocation(CollocationMemory {
                tangent: Some(tangent.clone()),
                ..collocation()
            }));
            let memory = GeneralizedAlphaMemory { tangent: Some(tangent), ..generalized_alpha() };
            all.push(Memory::GeneralizedAlpha(memory));
        }
        assert!(all.iter().all(|memory| !memory.is_finite()), "{all:?}");
        for sound in
            [Memory::None, Memory::Collocation(collocation()), Memory::GeneralizedAlpha(generalized_alpha())]
        {
            assert!(sound.is_finite(), "{sound:?}");
        }
    }
}
