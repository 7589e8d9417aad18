//! Laws of time that are written as an expression, such as `sin(2*pi*t)*(1-exp(-t/0.5))`.
//!
//! The crate `exmex` parses and differentiates. Before it sees a text, numbers are written out, and
//! what it would read in another way than mathematicians do is brought into a form that has one
//! meaning, or refused: it takes −t² for (−t)², and 2^3^2 for (2^3)^2.

use exmex::{Differentiate, Express, FlatEx};
use std::fmt;

/// An expression in the time t \[s\], with its first two derivatives.
#[derive(Clone)]
pub struct Expression {
    text: String,
    /// Times at which it is not smooth, rising \[s\].
    kinks: Vec<f64>,
    /// The value and its derivatives.
    terms: [FlatEx<f64>; 3],
}

/// Functions that may be used: all are smooth where they are defined.
const FUNCTIONS: [&str; 17] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp",
    "sqrt", "ln", "log2", "log10",
];

/// Constants, and their names in `exmex`.
const CONSTANTS: [(&str, &str); 5] = [("pi", "π"), ("π", "π"), ("tau", "τ"), ("τ", "τ"), ("e", "e")];

impl Expression {
    /// Reads `text`, an expression in `t`; `kinks` are the times at which it is not smooth \[s\].
    ///
    /// # Errors
    /// What was found and what is legal, in one sentence.
    pub fn new(text: &str, mut kinks: Vec<f64>) -> Result<Self, String> {
        let normal = normal(text)?;
        let parsed: FlatEx<f64> = exmex::parse(&normal).map_err(|_| "it is no expression".to_owned())?;
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        let terms = match parsed.var_names() {
            [] => {
                let zero = || exmex::parse("0").map_err(|error| error.to_string());
                [parsed, zero()?, zero()?]
            }
            _ => {
                let derivative = |of: &FlatEx<f64>| {
                    of.clone().partial(0).map_err(|_| "it cannot be differentiated".to_owned())
                };
                let first = derivative(&parsed)?;
                let second = derivative(&first)?;
                [parsed, first, second]
            }
        };
        Ok(Self { text: text.to_owned(), kinks, terms })
    }

    /// Value and first two derivatives at the time `t` \[s\]; not a number where it has none.
    pub fn at(&self, t: f64) -> [f64; 3] {
        self.terms.each_ref().map(|term| term.eval_relaxed(&[t]).unwrap_or(f64::NAN))
    }

    /// Times at which it is not smooth \[s\].
    pub fn kinks(&self) -> &[f64] {
        &self.kinks
    }
}

impl fmt::Debug for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Expression").field("text", &self.text).field("kinks", &self.kinks).finish()
    }
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        (&self.text, &self.kinks) == (&other.text, &other.kinks)
    }
}

/// What stands before the next token, as far as it decides what a sign means.
#[derive(Clone, Copy, PartialEq)]
enum Before {
    /// The beginning, or an opening bracket.
    Open,
    /// An operator.
    Operator(char),
    /// A number, t, a constant, or a closing bracket.
    Value,
    /// A function.
    Function,
}

/// The expression as `exmex` reads it in the meaning that it has.
fn normal(text: &str) -> Result<String, String> {
    let mut out = String::new();
    let mut before = Before::Open;
    // Per open bracket, whether what is raised to a power there has one already.
    let mut powers = vec![false];
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        if c.is_whitespace() {
            rest = &rest[c.len_utf8()..];
            continue;
        }
        if before == Before::Function && c != '(' {
            return Err("a function needs its argument in brackets".to_owned());
        }
        let follows_value = |what: &str| format!("{what} follows a value: write `*` between them");
        if c.is_ascii_digit() || c == '.' {
            let end = number_end(rest);
            let value: f64 = rest[..end].parse().map_err(|_| format!("`{}` is no number", &rest[..end]))?;
            if before == Before::Value {
                return Err(follows_value(&format!("`{}`", &rest[..end])));
            }
            // Written out, for an exponent such as that of 1e-3 would be taken for a word.
            out.push_str(&format!("{value}"));
            (before, rest) = (Before::Value, &rest[end..]);
            continue;
        }
        if c.is_alphabetic() || c == '_' {
            let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
            let word = &rest[..end];
            if before == Before::Value {
                return Err(follows_value(&format!("`{word}`")));
            }
            let constant = CONSTANTS.iter().find(|(name, _)| *name == word);
            before = match constant {
                _ if word == "t" => {
                    out.push('t');
                    Before::Value
                }
                Some((_, name)) => {
                    out.push_str(name);
                    Before::Value
                }
                None if FUNCTIONS.contains(&word) => {
                    out.push_str(word);
                    Before::Function
                }
                None => return Err(unknown(word)),
            };
            rest = &rest[end..];
            continue;
        }
        match c {
            '(' if before == Before::Value => return Err(follows_value("`(`")),
            '(' => {
                out.push('(');
                powers.push(false);
                before = Before::Open;
            }
            ')' => {
                if powers.len() == 1 {
                    return Err("a bracket is closed that was not opened".to_owned());
                }
                if before != Before::Value {
                    return Err("something is missing before `)`".to_owned());
                }
                powers.pop();
                out.push(')');
            }
            '-' | '+' if before == Before::Open => {
                // −t² is −(t²), as 0 − t² is.
                out.push('0');
                out.push(c);
                before = Before::Operator(c);
            }
            '-' | '+' | '*' | '/' | '^' => {
                if let Before::Operator(first) = before {
                    return Err(format!(
                        "`{c}` follows `{first}`: put brackets about a negative number, such as `2*(-t)`"
                    ));
                }
                if before == Before::Open {
                    return Err(format!("something is missing before `{c}`"));
                }
                if let Some(power) = powers.last_mut() {
                    if c == '^' && *power {
                        return Err("a power of a power: put brackets about one of them".to_owned());
                    }
                    *power = c == '^';
                }
                out.push(c);
                before = Before::Operator(c);
            }
            other => return Err(format!("it cannot contain `{other}`")),
        }
        rest = &rest[c.len_utf8()..];
    }
    match before {
        Before::Value if powers.len() == 1 => Ok(out),
        Before::Value => Err("a bracket is not closed".to_owned()),
        Before::Open if out.is_empty() => Err("it is empty".to_owned()),
        _ => Err("it ends too early".to_owned()),
    }
}

/// Where the decimal number at the beginning of `text` ends.
fn number_end(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    end
}

fn unknown(word: &str) -> String {
    let advice = match word {
        "log" => "`ln`, `log2` or `log10` says which logarithm is meant".to_owned(),
        "abs" | "min" | "max" | "floor" | "ceil" | "round" | "sign" | "signum" | "mod" => {
            "what has corners is a `table`, a `ramp` or a `step`, which `sum` and `product` combine with others".to_owned()
        }
        _ => format!("it knows the time t, pi, tau, e, and {}", FUNCTIONS.join(", ")),
    };
    format!("it cannot contain `{word}`: {advice}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{E, PI, TAU};

    fn at(text: &str, t: f64) -> [f64; 3] {
        Expression::new(text, Vec::new()).unwrap_or_else(|error| panic!("{text}: {error}")).at(t)
    }

    /// Would catch an expression that is read in another way than it is written.
    #[test]
    fn expressions_mean_what_mathematicians_mean() {
        type Function = fn(f64) -> f64;
        let all: [(&str, Function); 18] = [
            ("-t^2", |t| -t * t),
            ("2 - -t", |_| f64::NAN),
            ("sin(2*pi*t)*(1-exp(-t/0.5))", |t| (TAU * t).sin() * (1.0 - (-t / 0.5).exp())),
            ("exp(-(t-1)^2/0.3)", |t| (-(t - 1.0).powi(2) / 0.3).exp()),
            ("-3*t^2+t", |t| -3.0 * t * t + t),
            ("1e-3*t + 2.5E2", |t| 1e-3 * t + 250.0),
            ("8/2/t", |t| 4.0 / t),
            ("2-3-t", |t| -1.0 - t),
            ("+t", |t| t),
            ("(2^3)^2*t", |t| 64.0 * t),
            ("2^3*2^2*t", |t| 32.0 * t),
            ("e^t", |t| E.powf(t)),
            ("tau*t - π", |t| TAU * t - PI),
            ("sqrt(t) + ln(t) + log2(t) + log10(t)", |t| t.sqrt() + t.ln() + t.log2() + t.log10()),
            ("sinh(t) - cosh(t) * tanh(t) + tan(t/9)", |t| t.sinh() - t.cosh() * t.tanh() + (t / 9.0).tan()),
            ("asin(t/9) + acos(t/9) * atan(t)", |t| (t / 9.0).asin() + (t / 9.0).acos() * t.atan()),
            ("asinh(t) + acosh(t+2) + atanh(t/9)", |t| t.asinh() + (t + 2.0).acosh() + (t / 9.0).atanh()),
            ("t^2.5", |t| t.powf(2.5)),
        ];
        for (text, expected) in all {
            if text == "2 - -t" {
                assert!(Expression::new(text, Vec::new()).is_err());
                continue;
            }
            for t in [0.3, 1.7, 2.9] {
                let [value, first, second] = at(text, t);
                let h = 1e-4;
                let [a, b] = [at(text, t - h), at(text, t + h)];
                assert!((value - expected(t)).abs() <= 1e-13 * (1.0 + value.abs()), "{text} at {t}: {value}");
                assert!(
                    ((b[0] - a[0]) / (2.0 * h) - first).abs() < 1e-5 * (1.0 + first.abs()),
                    "{text} at {t}"
                );
                assert!(
                    ((b[1] - a[1]) / (2.0 * h) - second).abs() < 1e-5 * (1.0 + second.abs()),
                    "{text} at {t}"
                );
            }
        }
        assert_eq!(at("3", 1.0), [3.0, 0.0, 0.0]);
        assert_eq!(at("0*t", 1.0), [0.0, 0.0, 0.0]);
    }

    #[test]
    fn what_has_no_one_meaning_is_refused() {
        for (text, part) in [
            ("2^3^2", "a power of a power"),
            ("t*-2", "`-` follows `*`"),
            ("2t", "`t` follows a value"),
            ("2 3", "`3` follows a value"),
            ("t(2)", "`(` follows a value"),
            ("sin t", "in brackets"),
            ("abs(t)", "what has corners"),
            ("log(t)", "which logarithm"),
            ("x+t", "it cannot contain `x`"),
            ("(t", "not closed"),
            ("t)", "not opened"),
            ("", "it is empty"),
            ("t+", "ends too early"),
            ("sin()", "missing before `)`"),
            ("*t", "missing before `*`"),
            ("t % 2", "it cannot contain `%`"),
            ("max(t, 1)", "what has corners"),
            ("1.2.3", "follows a value"),
        ] {
            let said = Expression::new(text, Vec::new()).expect_err(text);
            assert!(said.contains(part), "{text}: {said}");
        }
    }
}
