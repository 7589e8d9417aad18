//! Formulas of given variables, such as `sin(2*pi*t)*(1-exp(-t/0.5))`, and their derivatives.
//!
//! The crate `exmex` parses and differentiates. Before it sees a text, numbers are written out, and
//! what it would read in another way than mathematicians do is brought into a form that has one
//! meaning, or refused: it takes −t² for (−t)², and 2^3^2 for (2^3)^2.

use exmex::{Differentiate, Express, FlatEx};
use std::fmt;

/// A formula of some variables.
#[derive(Clone)]
pub struct Formula {
    text: String,
    variables: &'static [&'static str],
    parsed: FlatEx<f64>,
}

/// Functions that may be used: all are smooth where they are defined.
const FUNCTIONS: [&str; 17] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp",
    "sqrt", "ln", "log2", "log10",
];

/// Constants, and their names in `exmex`.
const CONSTANTS: [(&str, &str); 5] = [("pi", "π"), ("π", "π"), ("tau", "τ"), ("τ", "τ"), ("e", "e")];

impl Formula {
    /// Reads `text`, a formula of `variables`, which are in alphabetical order.
    ///
    /// # Errors
    /// What was found and what is legal, in one sentence.
    pub fn new(text: &str, variables: &'static [&'static str]) -> Result<Self, String> {
        let normal = normal(text, variables)?;
        // Every variable takes part, so that values belong to all of them in this order.
        let all: String = variables.iter().map(|name| format!("+0*{name}")).collect();
        let parsed = exmex::parse(&format!("({normal}){all}")).map_err(|_| "it is no formula".to_owned())?;
        Ok(Self { text: text.to_owned(), variables, parsed })
    }

    /// The derivative by variable number `variable`.
    ///
    /// # Errors
    /// In one sentence, where there is none.
    pub fn derivative(&self, variable: usize) -> Result<Self, String> {
        let parsed = self.parsed.clone().partial(variable);
        let parsed = parsed.map_err(|_| "it cannot be differentiated".to_owned())?;
        Ok(Self { text: format!("∂{}({})", self.variables[variable], self.text), parsed, ..self.clone() })
    }

    /// Its value where the variables have these values; not a number where it has none.
    pub fn at(&self, values: &[f64]) -> f64 {
        self.parsed.eval_relaxed(values).unwrap_or(f64::NAN)
    }
}

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Formula").field(&self.text).finish()
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        (&self.text, self.variables) == (&other.text, other.variables)
    }
}

/// What stands before the next token, as far as it decides what a sign means.
#[derive(Clone, Copy, PartialEq)]
enum Before {
    /// The beginning, or an opening bracket.
    Open,
    /// An operator.
    Operator(char),
    /// A number, a variable, a constant, or a closing bracket.
    Value,
    /// A function.
    Function,
}

/// The formula as `exmex` reads it in the meaning that it has.
fn normal(text: &str, variables: &[&str]) -> Result<String, String> {
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
                _ if variables.contains(&word) => {
                    out.push_str(word);
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
                None => return Err(unknown(word, variables)),
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

fn unknown(word: &str, variables: &[&str]) -> String {
    let advice = match word {
        "log" => "`ln`, `log2` or `log10` says which logarithm is meant".to_owned(),
        "abs" | "min" | "max" | "floor" | "ceil" | "round" | "sign" | "signum" | "mod" => {
            "what has corners is a `table`, a `ramp` or a `step`, which `sum` and `product` combine with others".to_owned()
        }
        _ => format!("it knows {}, pi, tau, e, and {}", variables.join(", "), FUNCTIONS.join(", ")),
    };
    format!("it cannot contain `{word}`: {advice}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{E, PI, TAU};

    fn formula(text: &str) -> Result<Formula, String> {
        Formula::new(text, &["t"])
    }

    fn at(text: &str, t: f64) -> [f64; 3] {
        let read = || {
            let value = formula(text)?;
            let first = value.derivative(0)?;
            let second = first.derivative(0)?;
            Ok([value, first, second].map(|formula| formula.at(&[t])))
        };
        read().unwrap_or_else(|error: String| panic!("{text}: {error}"))
    }

    /// Would catch an expression that is read in another way than it is written.
    #[test]
    fn expressions_mean_what_mathematicians_mean() {
        type Function = fn(f64) -> f64;
        let all: [(&str, Function); 17] = [
            ("-t^2", |t| -t * t),
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

    /// Values belong to variables by their order, whether or not all of them take part.
    #[test]
    fn several_variables() {
        let of = |text: &str| Formula::new(text, &["x", "y"]).expect("a formula");
        let field = of("y^2 - 3*x*y");
        assert_eq!(field.at(&[2.0, 5.0]), -5.0);
        let [by_x, by_y] = [0, 1].map(|i| field.derivative(i).expect("smooth"));
        assert_eq!((by_x.at(&[2.0, 5.0]), by_y.at(&[2.0, 5.0])), (-15.0, 4.0));
        assert_eq!(by_x.derivative(1).expect("smooth").at(&[2.0, 5.0]), -3.0);
        let of_y = of("2*y");
        assert_eq!((of_y.at(&[7.0, 3.0]), of_y.derivative(0).expect("smooth").at(&[7.0, 3.0])), (6.0, 0.0));
        assert_eq!(
            (of("4").at(&[7.0, 3.0]), of("4").derivative(1).expect("smooth").at(&[7.0, 3.0])),
            (4.0, 0.0)
        );
        assert!(Formula::new("t", &["x", "y"]).is_err());
    }

    #[test]
    fn what_has_no_one_meaning_is_refused() {
        for (text, part) in [
            ("2^3^2", "a power of a power"),
            ("t*-2", "`-` follows `*`"),
            ("2 - -t", "`-` follows `-`"),
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
            let said = formula(text).expect_err(text);
            assert!(said.contains(part), "{text}: {said}");
        }
    }
}
