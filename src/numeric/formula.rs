//! Formulas of given variables, such as `sin(2*pi*t)*(1-exp(-t/0.5))`, and their derivatives.
//!
//! A formula is a list of steps on a stack of numbers, and its derivatives are found by numbers that
//! carry them (hyper-dual numbers), exact to round-off. Nothing here calls itself, so that brackets
//! in brackets take no room on the stack of the thread. What has no one meaning is refused, such as
//! 2^3^2; −t² is −(t²), as mathematicians write it.
//!
//! The crate `exmex` differentiates symbols by functions that call themselves: the second derivative
//! of a sum of 24 terms overflows a stack of 2 MiB, which ends the process, and that of eight factors
//! takes 18 ms to find.

mod range;

use range::Course;
use std::f64::consts::{E, FRAC_PI_2, LOG2_E, LOG10_E, PI, TAU};
use std::fmt;
use std::sync::Arc;

/// A formula of some variables, or a derivative of one.
#[derive(Clone)]
pub struct Formula {
    text: String,
    variables: &'static [&'static str],
    steps: Arc<[Step]>,
    /// Numbers on the stack at most.
    room: usize,
    /// The variables by which it is differentiated, two at most.
    by: Vec<usize>,
}

/// One step of an evaluation: puts a number on the stack, or takes its operands from there.
#[derive(Clone, Copy, Debug)]
enum Step {
    Number(f64),
    Variable(usize),
    Call(&'static Function),
    Operator(char),
}

/// A function of one number.
#[derive(Debug)]
struct Function {
    name: &'static str,
    /// Its value, and its first and second derivative.
    at: fn(f64) -> [f64; 3],
    course: Course,
}

/// Numbers of any size.
const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

const fn rising(name: &'static str, [from, to]: [f64; 2], at: fn(f64) -> [f64; 3]) -> Function {
    Function { name, at, course: Course::Rising(from, to) }
}

/// Functions that may be used: all are smooth where they are defined.
static FUNCTIONS: [Function; 17] = [
    Function { name: "sin", course: Course::Wave(FRAC_PI_2), at: |x| [x.sin(), x.cos(), -x.sin()] },
    Function { name: "cos", course: Course::Wave(0.0), at: |x| [x.cos(), -x.sin(), -x.cos()] },
    Function {
        name: "tan",
        course: Course::Tangent,
        at: |x| {
            let (value, slope) = (x.tan(), 1.0 / (x.cos() * x.cos()));
            [value, slope, 2.0 * value * slope]
        },
    },
    rising("asin", [-1.0, 1.0], |x| {
        let square = 1.0 - x * x;
        [x.asin(), 1.0 / square.sqrt(), x / (square * square.sqrt())]
    }),
    Function {
        name: "acos",
        course: Course::Falling(-1.0, 1.0),
        at: |x| {
            let square = 1.0 - x * x;
            [x.acos(), -1.0 / square.sqrt(), -x / (square * square.sqrt())]
        },
    },
    rising("atan", ALL, |x| {
        let slope = 1.0 / (1.0 + x * x);
        [x.atan(), slope, -2.0 * x * slope * slope]
    }),
    rising("sinh", ALL, |x| [x.sinh(), x.cosh(), x.sinh()]),
    Function { name: "cosh", course: Course::Valley, at: |x| [x.cosh(), x.sinh(), x.cosh()] },
    rising("tanh", ALL, |x| {
        let (value, inverse) = (x.tanh(), 1.0 / x.cosh());
        let slope = inverse * inverse;
        [value, slope, -2.0 * value * slope]
    }),
    rising("asinh", ALL, |x| {
        let square = 1.0 + x * x;
        [x.asinh(), 1.0 / square.sqrt(), -x / (square * square.sqrt())]
    }),
    rising("acosh", [1.0, f64::INFINITY], |x| {
        let square = x * x - 1.0;
        [x.acosh(), 1.0 / square.sqrt(), -x / (square * square.sqrt())]
    }),
    rising("atanh", [-1.0, 1.0], |x| {
        let slope = 1.0 / (1.0 - x * x);
        [x.atanh(), slope, 2.0 * x * slope * slope]
    }),
    rising("exp", ALL, |x| [x.exp(); 3]),
    rising("sqrt", [0.0, f64::INFINITY], |x| {
        let root = x.sqrt();
        [root, 0.5 / root, -0.25 / (x * root)]
    }),
    rising("ln", [0.0, f64::INFINITY], |x| [x.ln(), 1.0 / x, -1.0 / (x * x)]),
    rising("log2", [0.0, f64::INFINITY], |x| [x.log2(), LOG2_E / x, -LOG2_E / (x * x)]),
    rising("log10", [0.0, f64::INFINITY], |x| [x.log10(), LOG10_E / x, -LOG10_E / (x * x)]),
];

/// Constants.
const CONSTANTS: [(&str, f64); 5] = [("pi", PI), ("π", PI), ("tau", TAU), ("τ", TAU), ("e", E)];

/// Numbers for which there is room without asking for memory.
const ROOM: usize = 16;

impl Formula {
    /// Reads `text`, a formula of `variables`.
    ///
    /// # Errors
    /// What was found and what is legal, in one sentence.
    pub fn new(text: &str, variables: &'static [&'static str]) -> Result<Self, String> {
        let steps = read(text, variables)?;
        let (mut depth, mut room) = (0_usize, 0);
        for step in &steps {
            match step {
                Step::Number(_) | Step::Variable(_) => depth += 1,
                Step::Call(_) => {}
                Step::Operator(_) => depth -= 1,
            }
            room = room.max(depth);
        }
        Ok(Self { text: text.to_owned(), variables, steps: steps.into(), room, by: Vec::new() })
    }

    /// The derivative by variable number `variable`.
    ///
    /// # Errors
    /// In one sentence, where there is none: of a second derivative.
    pub fn derivative(&self, variable: usize) -> Result<Self, String> {
        if self.by.len() == 2 {
            return Err("it is differentiated twice at most".to_owned());
        }
        let mut derivative = self.clone();
        derivative.by.push(variable);
        derivative.text = format!("∂{}({})", self.variables[variable], self.text);
        Ok(derivative)
    }

    /// Whether it contains variable number `variable`.
    pub fn contains(&self, variable: usize) -> bool {
        self.steps.iter().any(|step| matches!(step, Step::Variable(of) if *of == variable))
    }

    /// Its value where the variables have these values; not a number where it has none.
    pub fn at(&self, values: &[f64]) -> f64 {
        let (mut few, mut many) = ([Jet::default(); ROOM], Vec::new());
        let stack = if self.room <= ROOM {
            &mut few[..]
        } else {
            many.resize(self.room, Jet::default());
            &mut many[..]
        };
        let result = self.evaluate(values, stack);
        match self.by.len() {
            0 => result.value,
            1 => result.first[0],
            _ => result.second,
        }
    }

    /// The round-off of the formula itself, not of a derivative: to first order, the sum of what each variable and each step may add,
    /// as the steps behind it enlarge that.
    pub fn round_off(&self, values: &[f64]) -> f64 {
        let mut stack: Vec<[f64; 2]> = Vec::with_capacity(self.room);
        for step in &*self.steps {
            let (value, error) = match *step {
                // What it stands for does not matter: it is the same number everywhere.
                Step::Number(value) => {
                    stack.push([value, 0.0]);
                    continue;
                }
                Step::Variable(variable) => (values[variable], 0.0),
                Step::Call(function) => {
                    let [x, error] = stack.pop().unwrap_or_default();
                    let [value, slope, _] = (function.at)(x);
                    (value, (slope * error).abs())
                }
                Step::Operator(operator) => {
                    let [[b, of_b], [a, of_a]] = [stack.pop(), stack.pop()].map(Option::unwrap_or_default);
                    let value = Jet::constant(a).with(operator, Jet::constant(b)).value;
                    let error = match operator {
                        '+' | '-' => of_a + of_b,
                        '*' => (a * of_b).abs() + (b * of_a).abs(),
                        '/' => (of_a + (value * of_b).abs()) / b.abs(),
                        _ if of_b == 0.0 => (b * a.powf(b - 1.0) * of_a).abs(),
                        _ => (b * a.powf(b - 1.0) * of_a).abs() + (value * a.ln() * of_b).abs(),
                    };
                    (value, error)
                }
            };
            stack.push([value, f64::EPSILON.mul_add(value.abs(), error)]);
        }
        stack.first().map_or(0.0, |[_, error]| *error)
    }

    fn evaluate(&self, values: &[f64], stack: &mut [Jet]) -> Jet {
        let mut top = 0;
        for step in &*self.steps {
            match *step {
                Step::Number(value) => {
                    stack[top] = Jet::constant(value);
                    top += 1;
                }
                Step::Variable(variable) => {
                    let mut jet = Jet::constant(values[variable]);
                    for (first, by) in jet.first.iter_mut().zip(&self.by) {
                        *first = f64::from(*by == variable);
                    }
                    jet.varies = jet.first != [0.0; 2];
                    stack[top] = jet;
                    top += 1;
                }
                Step::Call(function) => {
                    stack[top - 1] = stack[top - 1].through((function.at)(stack[top - 1].value))
                }
                Step::Operator(operator) => {
                    top -= 1;
                    stack[top - 1] = stack[top - 1].with(operator, stack[top]);
                }
            }
        }
        stack[0]
    }
}

/// A number with its derivatives by two variables, and by both of them.
#[derive(Clone, Copy, Debug, Default)]
struct Jet {
    value: f64,
    first: [f64; 2],
    second: f64,
    /// Whether it depends on any of them: infinite derivatives of what does not are none.
    varies: bool,
}

impl Jet {
    fn constant(value: f64) -> Self {
        Self { value, ..Self::default() }
    }

    /// A function of it, given its value and its first two derivatives.
    fn through(self, [value, first, second]: [f64; 3]) -> Self {
        if !self.varies {
            return Self::constant(value);
        }
        let [a, b] = self.first;
        Self {
            value,
            first: [first * a, first * b],
            second: first * self.second + second * (a * b),
            varies: true,
        }
    }

    fn with(self, operator: char, other: Self) -> Self {
        match operator {
            '+' => self.plus(1.0, other),
            '-' => self.plus(-1.0, other),
            '*' => self.times(other),
            '/' => {
                let inverse = 1.0 / other.value;
                let square = inverse * inverse;
                let inverse = other.through([inverse, -square, 2.0 * square * inverse]);
                Self { value: self.value / other.value, ..self.times(inverse) }
            }
            _ => self.power(other),
        }
    }

    fn plus(self, factor: f64, other: Self) -> Self {
        Self {
            value: self.value + factor * other.value,
            first: [0, 1].map(|i: usize| self.first[i] + factor * other.first[i]),
            second: self.second + factor * other.second,
            varies: self.varies || other.varies,
        }
    }

    fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        match (self.varies, other.varies) {
            (false, false) => Self::constant(value),
            (true, false) => self.through([value, other.value, 0.0]),
            (false, true) => other.through([value, self.value, 0.0]),
            (true, true) => Self {
                value,
                first: [0, 1].map(|i: usize| self.first[i] * other.value + self.value * other.first[i]),
                second: self.second * other.value
                    + self.first[0] * other.first[1]
                    + self.first[1] * other.first[0]
                    + self.value * other.second,
                varies: true,
            },
        }
    }

    fn power(self, exponent: Self) -> Self {
        let (x, n) = (self.value, exponent.value);
        let value = x.powf(n);
        if exponent.varies {
            // x^n = exp(n ln x).
            let logarithm = self.through([x.ln(), 1.0 / x, -1.0 / (x * x)]);
            return exponent.times(logarithm).through([value; 3]);
        }
        // Where a factor is zero there is no derivative, however large the power is.
        let term = |factor: f64, power: f64| if factor == 0.0 { 0.0 } else { factor * x.powf(power) };
        self.through([value, term(n, n - 1.0), term(n * (n - 1.0), n - 2.0)])
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

/// What waits for its right operand, or for its bracket to be closed.
#[derive(Clone, Copy)]
enum Waiting {
    Operator(char),
    Bracket,
    Function(&'static Function),
}

/// How tightly an operator binds.
fn rank(operator: char) -> u8 {
    match operator {
        '+' | '-' => 0,
        '*' | '/' => 1,
        _ => 2,
    }
}

/// Moves what waits and binds at least as tightly as `least` to the steps.
fn settle(waiting: &mut Vec<Waiting>, steps: &mut Vec<Step>, least: u8) {
    while let Some(Waiting::Operator(operator)) = waiting.last().copied().filter(|top| match top {
        Waiting::Operator(operator) => rank(*operator) >= least,
        _ => false,
    }) {
        steps.push(Step::Operator(operator));
        waiting.pop();
    }
}

/// The steps by which a formula is evaluated.
fn read(text: &str, variables: &[&str]) -> Result<Vec<Step>, String> {
    let (mut steps, mut waiting) = (Vec::new(), Vec::new());
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
            steps.push(Step::Number(value));
            (before, rest) = (Before::Value, &rest[end..]);
            continue;
        }
        if c.is_alphabetic() || c == '_' {
            let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
            let word = &rest[..end];
            if before == Before::Value {
                return Err(follows_value(&format!("`{word}`")));
            }
            let variable = variables.iter().position(|name| *name == word);
            let constant = CONSTANTS.iter().find(|(name, _)| *name == word);
            let function = FUNCTIONS.iter().find(|function| function.name == word);
            before = match (variable, constant, function) {
                (Some(variable), ..) => {
                    steps.push(Step::Variable(variable));
                    Before::Value
                }
                (None, Some((_, value)), _) => {
                    steps.push(Step::Number(*value));
                    Before::Value
                }
                (None, None, Some(function)) => {
                    waiting.push(Waiting::Function(function));
                    Before::Function
                }
                (None, None, None) => return Err(unknown(word, variables)),
            };
            rest = &rest[end..];
            continue;
        }
        match c {
            '(' if before == Before::Value => return Err(follows_value("`(`")),
            '(' => {
                waiting.push(Waiting::Bracket);
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
                settle(&mut waiting, &mut steps, 0);
                waiting.pop();
                if let Some(Waiting::Function(function)) = waiting.last() {
                    steps.push(Step::Call(function));
                    waiting.pop();
                }
                before = Before::Value;
            }
            '-' | '+' if before == Before::Open => {
                // −t² is −(t²), as 0 − t² is.
                steps.push(Step::Number(0.0));
                waiting.push(Waiting::Operator(c));
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
                settle(&mut waiting, &mut steps, rank(c));
                waiting.push(Waiting::Operator(c));
                before = Before::Operator(c);
            }
            other => return Err(format!("it cannot contain `{other}`")),
        }
        rest = &rest[c.len_utf8()..];
    }
    match before {
        Before::Value if powers.len() == 1 => {
            settle(&mut waiting, &mut steps, 0);
            Ok(steps)
        }
        Before::Value => Err("a bracket is not closed".to_owned()),
        Before::Open if steps.is_empty() && powers.len() == 1 => Err("it is empty".to_owned()),
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
        _ => format!("it knows {}, pi, tau, e, and {}", variables.join(", "), FUNCTIONS.each_ref().map(|function| function.name).join(", ")),
    };
    format!("it cannot contain `{word}`: {advice}")
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// The bound holds, and is not much larger than what one step after the other may add.
    #[test]
    fn round_off_is_bounded_and_not_by_much_more() {
        // Beside each formula the same without cancellation, and by how many units of the last digit of 1 it errs at most.
        type Pair = (&'static str, fn(f64) -> f64, [f64; 2]);
        let pairs: [Pair; 6] = [
            ("1 - cos(x)", |x| 2.0 * (0.5 * x).sin().powi(2), [1.0, 4.0]),
            ("(0 - x)^2 + 1 - x^2", |_| 1.0, [1.0, 4.0]),
            ("exp(x) - 1 - x", |x| x.exp_m1() - x, [1.0, 6.0]),
            ("(1 + x)^3 - 1", |x| x * (3.0 + x * (3.0 + x)), [1.0, 9.0]),
            ("2^(1 + x)/2 - 1", |x| (x * std::f64::consts::LN_2).exp_m1(), [1.0, 8.0]),
            ("sqrt(1 + x)*(1 - x) - 1", |x| (1.0 - x) * (0.5 * x.ln_1p()).exp_m1() - x, [1.0, 7.0]),
        ];
        for (text, exactly, [least, most]) in pairs {
            let formula = Formula::new(text, &["x"]).unwrap();
            for k in 0..200 {
                let x = 1e-6 * (1.0 + 0.731 * f64::from(k));
                let bound = formula.round_off(&[x]);
                let error = (formula.at(&[x]) - exactly(x)).abs();
                assert!(error <= bound, "{text} at {x}: {error:e}, {bound:e}");
                let units = bound / f64::EPSILON;
                assert!((least..=most).contains(&units), "{text} at {x}: {units}");
            }
        }
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

    /// A library that called itself for every bracket overflowed the stacks of threads by a dozen.
    #[test]
    fn brackets_in_brackets_take_no_stack() {
        let deep = |n: usize| format!("{}t{}", "(1+".repeat(n), ")".repeat(n));
        assert_eq!(at(&deep(100_000), 2.0), [100_002.0, 1.0, 0.0]);
        let nested = format!("{}t/2{}", "sin(".repeat(60), ")".repeat(60));
        let [value, first, _] = at(&nested, 1.0);
        let (mut v, mut slope) = (0.5_f64, 0.5);
        for _ in 0..60 {
            slope *= v.cos();
            v = v.sin();
        }
        assert!((value - v).abs() < 1e-15 && (first - slope).abs() < 1e-15, "{value}, {first}");
        // Operands that wait for the last one.
        let right = format!("{}t{}", "t*(2-".repeat(40), ")".repeat(40));
        let mut expected = [1.5_f64, 1.0, 0.0];
        for _ in 0..40 {
            let [v, d, s] = expected.map(|of| -of);
            expected = [1.5 * (2.0 + v), 2.0 + v + 1.5 * d, 2.0 * d + 1.5 * s];
        }
        let found = at(&right, 1.5);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} and {expected}");
        }
    }

    /// A derivative by one variable, and by two of them in turn, of everything that is not linear.
    #[test]
    fn mixed_derivatives_are_those_of_the_product_rule() {
        let of = |text: &str, by: &[usize], place: [f64; 2]| {
            let formula = Formula::new(text, &["x", "y"]).expect("a formula");
            by.iter().try_fold(formula, |formula, by| formula.derivative(*by)).expect("smooth").at(&place)
        };
        let (x, y) = (0.7_f64, 1.3_f64);
        type Function = fn(f64, f64) -> f64;
        let all: [(&str, Function); 6] = [
            ("x^3*y^2", |x, y| 6.0 * x * x * y),
            ("x/y", |_, y| -1.0 / (y * y)),
            ("x^y", |x, y| x.powf(y - 1.0) * (1.0 + y * x.ln())),
            ("exp(x*y)", |x, y| (x * y).exp() * (1.0 + x * y)),
            ("sin(x)*cos(y)", |x, y| -x.cos() * y.sin()),
            ("sqrt(x^2+y^2)", |x, y| -x * y / (x * x + y * y).powf(1.5)),
        ];
        for (text, expected) in all {
            for by in [[0, 1], [1, 0]] {
                let found = of(text, &by, [x, y]);
                assert!((found - expected(x, y)).abs() < 1e-14, "{text}: {found}");
            }
        }
        // What does not depend on a variable has no infinite derivative by it.
        assert_eq!(of("sqrt(x)*y", &[1], [0.0, 2.0]), 0.0);
        assert_eq!(of("x^2*y^1", &[0, 0], [0.0, 3.0]), 6.0);
        assert!(of("sqrt(x^2)", &[0], [0.0, 1.0]).is_nan(), "a corner has no slope");
        let thrice =
            Formula::new("x", &["x", "y"]).and_then(|f| f.derivative(0)?.derivative(0)?.derivative(0));
        assert!(thrice.is_err());
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

    /// t^t is e^{t ln t}, and (t²)^t is e^{2t ln t}.
    #[test]
    fn powers_with_varying_exponents_have_two_derivatives() {
        for (text, n) in [("t^t", 1.0), ("(t^2)^t", 2.0)] {
            let t = 1.5_f64;
            let (value, rate) = (t.powf(n * t), n * (t.ln() + 1.0));
            let expected = [value, value * rate, value * (rate * rate + n / t)];
            let found = at(text, t);
            let close = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14 * b);
            assert!(close, "{text}: {found:?} instead of {expected:?}");
        }
    }
}
