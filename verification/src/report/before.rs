//! An earlier report, to see what has changed since.

use std::collections::HashMap;
use std::path::Path;

use ancf_check::Outcome;
use serde::Deserialize;

use crate::Failure;

/// Errors of an earlier report.
pub struct Before {
    /// When it was made.
    pub date: String,
    errors: HashMap<Key, f64>,
}

/// Case, quantity, oracle and run: what stays the same when checks are reordered.
type Key = (String, String, Option<String>, String);

#[derive(Deserialize)]
struct Json {
    date: String,
    cases: Vec<JsonCase>,
}

#[derive(Deserialize)]
struct JsonCase {
    name: String,
    outcomes: Vec<JsonOutcome>,
}

#[derive(Deserialize)]
struct JsonOutcome {
    quantity: String,
    oracle: Option<String>,
    label: String,
    /// Infinities and NaN are `null`.
    error: Option<f64>,
}

/// Errors below this part of the allowed one count as equal to it: four digits of margin are left.
const QUIET: f64 = 1e-4;

impl Before {
    /// Reads a `report.json`.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let json: Json = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        let mut errors = HashMap::new();
        for case in json.cases {
            for outcome in case.outcomes {
                if let Some(error) = outcome.error {
                    errors
                        .insert((case.name.clone(), outcome.quantity, outcome.oracle, outcome.label), error);
                }
            }
        }
        Ok(Self { date: json.date, errors })
    }

    /// Decimal digits gained since, by the outcome that lost most; negative where digits were lost.
    pub fn gained<'a>(&self, case: &str, outcomes: impl Iterator<Item = &'a Outcome>) -> Option<f64> {
        outcomes
            .filter(|o| !o.is_rate())
            .filter_map(|outcome| {
                let key = (
                    case.to_owned(),
                    outcome.quantity.clone(),
                    outcome.oracle.clone(),
                    outcome.label.clone(),
                );
                let quiet = QUIET * outcome.verdict.allowed?;
                Some((self.errors.get(&key)?.max(quiet) / outcome.error.max(quiet)).log10())
            })
            .min_by(f64::total_cmp)
    }
}
