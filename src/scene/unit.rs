//! Units of measurement: text such as `kg/m^3` to a factor and a dimension.
//!
//! A unit is a product or quotient of named units, each with an optional SI prefix and an optional
//! whole power: `mm`, `N/mm`, `kN m`, `kg/m^3`, `m s^-2`, `cm²`, `kg/(m s^2)`. A slash divides by
//! the one factor (or bracket) that follows it; because readers disagree about `kg/m s`, that
//! spelling is refused.

use std::fmt;

/// Exponents of metre, kilogram, second, radian and ampere. Angles count as a dimension of their own, so
/// that `"3 m"` is no angle and `"90 deg"` no ratio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dimension {
    /// Exponent of the metre.
    pub metre: i16,
    /// Exponent of the kilogram.
    pub kilogram: i16,
    /// Exponent of the second.
    pub second: i16,
    /// Exponent of the radian.
    pub radian: i16,
    /// Exponent of the ampere.
    pub ampere: i16,
}

impl Dimension {
    /// m^`metre` kg^`kilogram` s^`second`.
    pub const fn new(metre: i16, kilogram: i16, second: i16) -> Self {
        Self { metre, kilogram, second, radian: 0, ampere: 0 }
    }

    /// The dimension of an angle.
    pub const ANGLE: Self = Self { metre: 0, kilogram: 0, second: 0, radian: 1, ampere: 0 };

    fn combine(self, other: Self, times: i16) -> Option<Self> {
        let sum = |a: i16, b: i16| b.checked_mul(times).and_then(|b| a.checked_add(b));
        Some(Self {
            metre: sum(self.metre, other.metre)?,
            kilogram: sum(self.kilogram, other.kilogram)?,
            second: sum(self.second, other.second)?,
            radian: sum(self.radian, other.radian)?,
            ampere: sum(self.ampere, other.ampere)?,
        })
    }
}

impl fmt::Display for Dimension {
    /// In base units: `kg m^-3`; `1` for a pure number.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut first = true;
        for (name, power) in [
            ("kg", self.kilogram),
            ("m", self.metre),
            ("s", self.second),
            ("rad", self.radian),
            ("A", self.ampere),
        ] {
            if power == 0 {
                continue;
            }
            if !first {
                f.write_str(" ")?;
            }
            first = false;
            f.write_str(name)?;
            if power != 1 {
                write!(f, "^{power}")?;
            }
        }
        if first { f.write_str("1") } else { Ok(()) }
    }
}

/// A unit of measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Multiply a number in this unit by it to have SI.
    pub factor: f64,
    /// The dimension that it measures.
    pub dimension: Dimension,
}

/// Named units: name, factor to SI, metre, kilogram, second, radian, ampere, whether SI prefixes apply.
/// An exact name wins over prefix and name: `min` is a minute, `ft` a foot, `Pa` a pascal.
#[rustfmt::skip]
const NAMED: &[(&str, f64, [i16; 5], bool)] = &[
    ("m",    1.0,                 [1, 0, 0, 0, 0],   true),
    ("g",    1e-3,                [0, 1, 0, 0, 0],   true),
    ("s",    1.0,                 [0, 0, 1, 0, 0],   true),
    ("rad",  1.0,                 [0, 0, 0, 1, 0],   true),
    ("N",    1.0,                 [1, 1, -2, 0, 0],  true),
    ("Pa",   1.0,                 [-1, 1, -2, 0, 0], true),
    ("J",    1.0,                 [2, 1, -2, 0, 0],  true),
    ("W",    1.0,                 [2, 1, -3, 0, 0],  true),
    ("Hz",   1.0,                 [0, 0, -1, 0, 0],  true),
    ("A",    1.0,                 [0, 0, 0, 0, 1],   true),
    ("V",    1.0,                 [2, 1, -3, 0, -1], true),
    ("F",    1.0,                 [-2, -1, 4, 0, 2], true),
    ("bar",  1e5,                 [-1, 1, -2, 0, 0], true),
    ("t",    1e3,                 [0, 1, 0, 0, 0],   false),
    ("min",  60.0,                [0, 0, 1, 0, 0],   false),
    ("h",    3600.0,              [0, 0, 1, 0, 0],   false),
    ("deg",  std::f64::consts::PI / 180.0, [0, 0, 0, 1, 0], false),
    ("°",    std::f64::consts::PI / 180.0, [0, 0, 0, 1, 0], false),
    ("turn", std::f64::consts::TAU, [0, 0, 0, 1, 0], false),
    ("rev",  std::f64::consts::TAU, [0, 0, 0, 1, 0], false),
    ("rpm",  std::f64::consts::TAU / 60.0, [0, 0, -1, 1, 0], false),
    ("in",   0.0254,              [1, 0, 0, 0, 0],   false),
    ("ft",   0.3048,              [1, 0, 0, 0, 0],   false),
    ("lb",   0.453_592_37,        [0, 1, 0, 0, 0],   false),
    ("lbf",  4.448_221_615_260_5, [1, 1, -2, 0, 0],  false),
    ("kgf",  9.806_65,            [1, 1, -2, 0, 0],  false),
    ("psi",  6_894.757_293_168_361, [-1, 1, -2, 0, 0], false),
];

/// SI prefixes.
const PREFIXES: &[(&str, f64)] = &[
    ("da", 1e1),
    ("f", 1e-15),
    ("p", 1e-12),
    ("n", 1e-9),
    ("u", 1e-6),
    ("µ", 1e-6),
    ("μ", 1e-6),
    ("m", 1e-3),
    ("c", 1e-2),
    ("d", 1e-1),
    ("h", 1e2),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
    ("T", 1e12),
];

/// Powers beyond this have no use in mechanics and only invite overflow.
const LARGEST_POWER: i16 = 12;

/// Splits `"1.8 m"` into 1.8 and `m`; the unit may be empty.
///
/// # Errors
/// Where the text does not begin with a decimal number, or with one that no 64-bit float can hold.
pub fn split_number(text: &str) -> Result<(f64, &str), String> {
    let text = text.trim();
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let start = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let mut end = digits(start);
    let mut any = end > start;
    if bytes.get(end) == Some(&b'.') {
        let after = digits(end + 1);
        any |= after > end + 1;
        end = after;
    }
    if !any {
        return Err("it does not begin with a decimal number".into());
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let after = digits(end + 1 + sign);
        if after > end + 1 + sign {
            end = after;
        }
    }
    // Only ASCII was passed over, so `end` is a character boundary.
    let (number, unit) = text.split_at(end);
    let value: f64 = number.parse().map_err(|_| format!("`{number}` is not a decimal number"))?;
    if !value.is_finite() {
        return Err(format!("`{number}` is beyond the largest number, 1.8e308"));
    }
    Ok((value, unit.trim()))
}

/// Reads a unit.
///
/// # Errors
/// An unknown name, an ambiguous or incomplete product, or a power out of range, in words.
pub fn parse_unit(text: &str) -> Result<Unit, String> {
    let mut parser = Parser { rest: text.trim(), depth: 0 };
    let unit = parser.product().map_err(|reason| match with_powers(text) {
        Some(form) => format!("powers are written with `^`: `{form}`"),
        None => reason,
    })?;
    if !parser.rest.is_empty() {
        return Err(format!("`{}` in the unit `{text}` has no meaning there", parser.rest));
    }
    Ok(unit)
}

/// The text with `^` before digits that follow a letter, where it is a unit then: `kg/m3` was meant
/// to be `kg/m^3`.
fn with_powers(text: &str) -> Option<String> {
    let mut form = String::new();
    for c in text.trim().chars() {
        let power = c.is_ascii_digit() || c == '-';
        if power && form.ends_with(char::is_alphabetic) {
            form.push('^');
        }
        form.push(c);
    }
    (form != text.trim() && parse_unit(&form).is_ok()).then_some(form)
}

struct Parser<'a> {
    rest: &'a str,
    depth: usize,
}

impl<'a> Parser<'a> {
    fn skip_space(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn take(&mut self, signs: &[char]) -> bool {
        match self.rest.chars().next() {
            Some(c) if signs.contains(&c) => {
                self.rest = self.rest.get(c.len_utf8()..).unwrap_or_default();
                true
            }
            _ => false,
        }
    }

    /// factor { [* · /] factor }
    fn product(&mut self) -> Result<Unit, String> {
        let mut unit = self.factor()?;
        let mut divided = false;
        loop {
            self.skip_space();
            if self.rest.is_empty() || self.rest.starts_with(')') {
                return Ok(unit);
            }
            let times: i16 = if self.take(&['/']) {
                divided = true;
                -1
            } else {
                let explicit = self.take(&['*', '·', '⋅']);
                if divided && !explicit {
                    return Err("a product after `/` can be read in two ways: \
                                write `kg/(m s)`, `kg/m/s` or `kg/m*s`"
                        .into());
                }
                1
            };
            self.skip_space();
            let next = self.factor()?;
            unit = Unit {
                factor: unit.factor * next.factor.powi(i32::from(times)),
                dimension: unit.dimension.combine(next.dimension, times).ok_or("its powers are too large")?,
            };
        }
    }

    /// name or bracket, with a power
    fn factor(&mut self) -> Result<Unit, String> {
        let base = if self.take(&['(']) {
            // Nested brackets have no use here; the bound keeps hostile text off the call stack.
            if self.depth >= 8 {
                return Err("its brackets are nested too deeply".into());
            }
            self.depth += 1;
            self.skip_space();
            let inner = self.product()?;
            self.depth -= 1;
            if !self.take(&[')']) {
                return Err("a bracket is not closed".into());
            }
            inner
        } else if self.rest.starts_with("1/") {
            // As in `1/m`.
            self.rest = &self.rest[1..];
            return Ok(Unit { factor: 1.0, dimension: Dimension::default() });
        } else {
            let name = self.name();
            if name.is_empty() {
                return Err(match self.rest.chars().next() {
                    Some(c) => format!("a unit was expected where `{c}` stands"),
                    None => "a unit is missing at its end".into(),
                });
            }
            named(name)?
        };
        let power = self.power()?;
        Ok(Unit {
            factor: base.factor.powi(i32::from(power)),
            dimension: Dimension::default()
                .combine(base.dimension, power)
                .ok_or("its powers are too large")?,
        })
    }

    fn name(&mut self) -> &'a str {
        let rest = self.rest;
        let end = rest
            .find(|c: char| {
                !(c.is_alphabetic() || c == '°' || c == '%' || c == '_') || superscript(c).is_some()
            })
            .unwrap_or(rest.len());
        let (name, after) = rest.split_at(end);
        self.rest = after;
        name
    }

    fn power(&mut self) -> Result<i16, String> {
        let mut digits = String::new();
        if self.take(&['^']) || self.rest.starts_with("**") {
            self.rest = self.rest.strip_prefix("**").unwrap_or(self.rest);
            while let Some(c) =
                self.rest.chars().next().filter(|c| c.is_ascii_digit() || (digits.is_empty() && *c == '-'))
            {
                digits.push(c);
                self.take(&[c]);
            }
            if digits.is_empty() {
                return Err("a whole power such as `^2` was expected after `^`".into());
            }
        } else {
            while let Some((c, digit)) = self.rest.chars().next().and_then(|c| Some((c, superscript(c)?))) {
                digits.push(digit);
                self.take(&[c]);
            }
            if digits.is_empty() {
                return Ok(1);
            }
        }
        match digits.parse::<i16>() {
            Ok(power) if power.abs() <= LARGEST_POWER => Ok(power),
            _ => Err(format!("the power `{digits}` is not a whole number within ±{LARGEST_POWER}")),
        }
    }
}

fn superscript(c: char) -> Option<char> {
    "⁰0¹1²2³3⁴4⁵5⁶6⁷7⁸8⁹9⁻-"
        .chars()
        .collect::<Vec<_>>()
        .chunks(2)
        .find_map(|pair| (pair.first() == Some(&c)).then(|| pair.get(1).copied())?)
}

fn lookup(name: &str) -> Option<(f64, [i16; 5], bool)> {
    NAMED
        .iter()
        .find(|(known, ..)| *known == name)
        .map(|&(_, factor, powers, prefix)| (factor, powers, prefix))
}

fn named_alone(name: &str) -> Option<Unit> {
    let unit = |factor, [metre, kilogram, second, radian, ampere]: [i16; 5]| Unit {
        factor,
        dimension: Dimension { metre, kilogram, second, radian, ampere },
    };
    if let Some((factor, powers, _)) = lookup(name) {
        return Some(unit(factor, powers));
    }
    PREFIXES.iter().find_map(|(prefix, scale)| match name.strip_prefix(prefix).and_then(lookup)? {
        // kg is exactly one; other prefixes of the gram follow suit.
        (factor, powers, true) => Some(unit(if name == "kg" { 1.0 } else { scale * factor }, powers)),
        _ => None,
    })
}

fn named(name: &str) -> Result<Unit, String> {
    if let Some(unit) = named_alone(name) {
        return Ok(unit);
    }
    // Names that were run together: `Nm` is `N m`.
    let cuts = name.char_indices().skip(1).map(|(at, _)| name.split_at(at));
    let apart = cuts.into_iter().find(|(a, b)| named_alone(a).is_some() && named_alone(b).is_some());
    if let Some((a, b)) = apart {
        return Err(format!("`{name}` is no unit; a product is written with a space: `{a} {b}`"));
    }
    let known = NAMED.iter().map(|(name, ..)| *name).collect::<Vec<_>>().join(", ");
    Err(format!("`{name}` is no unit known here; there are {known}, with SI prefixes where usual"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(text: &str) -> (f64, String) {
        let (value, unit) = split_number(text).unwrap();
        let unit = parse_unit(unit).unwrap();
        (value * unit.factor, unit.dimension.to_string())
    }

    #[test]
    fn units_of_structural_mechanics() {
        for (text, value, dimension) in [
            ("1.8 m", 1.8, "m"),
            ("68.95 GPa", 68.95e9, "kg m^-1 s^-2"),
            ("2.5 cm^2", 2.5e-4, "m^2"),
            ("2.5cm²", 2.5e-4, "m^2"),
            ("0.130 cm^4", 0.130e-8, "m^4"),
            ("2766.67 kg/m^3", 2766.67, "kg m^-3"),
            ("1 g/cm^3", 1000.0, "kg m^-3"),
            ("10 ms", 0.01, "s"),
            ("0.5 1/m", 0.5, "m^-1"),
            ("3 1/ms", 3e3, "s^-1"),
            ("2 min", 120.0, "s"),
            ("-180 deg", -std::f64::consts::PI, "rad"),
            ("3 kN m", 3000.0, "kg m^2 s^-2"),
            ("3 kN*m", 3000.0, "kg m^2 s^-2"),
            ("5 N/mm", 5000.0, "kg s^-2"),
            ("9.81 m/s^2", 9.81, "m s^-2"),
            ("9.81 m s^-2", 9.81, "m s^-2"),
            ("9.81 m s⁻²", 9.81, "m s^-2"),
            ("1 kg/(m s^2)", 1.0, "kg m^-1 s^-2"),
            ("1e3 mm", 1.0, "m"),
            ("1 µm", 1e-6, "m"),
            ("1 ft", 0.3048, "m"),
            // Brackets that are closed count no more; eight may be open.
            ("2 (m)(m)(m)(m)(m)(m)(m)(m)(m)(m)", 2.0, "m^10"),
            ("2 ((((((((m))))))))", 2.0, "m"),
        ] {
            let (got, unit) = si(text);
            assert!((got - value).abs() <= 4.0 * f64::EPSILON * value.abs(), "{text}: {got}");
            assert_eq!(unit, dimension, "{text}");
        }
    }

    #[test]
    fn what_is_no_unit_is_refused() {
        for text in [
            "",
            "xyz",
            "m^",
            "m^1.5",
            "m^99",
            "kg/m s",
            "m)",
            "(m",
            "/s",
            "m//s",
            "m^^2",
            "kkm",
            "((((((((((m",
        ] {
            assert!(parse_unit(text).is_err(), "{text}");
        }
        for (text, form) in [
            ("cm2", "`cm^2`"),
            ("kg/m3", "`kg/m^3`"),
            ("N/mm2", "`N/mm^2`"),
            ("Nm", "`N m`"),
            ("kNm", "`kN m`"),
            ("m s-2", "`m s^-2`"),
        ] {
            let message = parse_unit(text).unwrap_err();
            assert!(message.contains(form), "{text}: {message}");
        }
        for text in ["", "m", "nan m", "inf", "1e999 m", ".", "-", "e5"] {
            assert!(split_number(text).is_err(), "{text}");
        }
    }
}
