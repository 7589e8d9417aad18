//! Formulas in scenes, as text.

/// A formula with other terms in place of its variables.
pub fn with(text: &str, terms: &[(&str, String)]) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
        let end = if is_word(c) { rest.find(|c| !is_word(c)).unwrap_or(rest.len()) } else { c.len_utf8() };
        let (word, after) = rest.split_at(end);
        match terms.iter().find(|(name, _)| *name == word) {
            Some((_, term)) => out.push_str(&format!("({term})")),
            None => out.push_str(word),
        }
        rest = after;
    }
    out
}

/// A number as it may stand anywhere in a formula.
pub fn number(value: f64) -> String {
    if value < 0.0 { format!("({value:e})") } else { format!("{value:e}") }
}

/// A term times a number.
pub fn scaled(term: &str, factor: f64) -> String {
    format!("{}*{term}", number(factor))
}

/// A sum of terms with their factors.
pub fn sum(terms: &[(f64, &str)]) -> String {
    let parts: Vec<String> = terms
        .iter()
        .filter(|(factor, _)| *factor != 0.0)
        .map(|(factor, term)| scaled(term, *factor))
        .collect();
    if parts.is_empty() { "0".to_owned() } else { parts.join("+") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_are_whole_words() {
        let found = with("exp(x)-y2*y^2.5e1", &[("x", "1e0*t".into()), ("y", "(-2)*x".into())]);
        assert_eq!(found, "exp((1e0*t))-y2*((-2)*x)^2.5e1");
        assert_eq!(sum(&[(0.0, "x"), (-2.0, "y"), (0.5, "1")]), "(-2e0)*y+5e-1*1");
        assert_eq!(sum(&[(0.0, "x")]), "0");
    }
}
