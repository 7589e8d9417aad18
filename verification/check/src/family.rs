//! A family of runs expands to its members: the product of its axes.

use indexmap::IndexMap;

use crate::case::{Family, Scalar};

/// The variable that names the point of an axis for the reader.
const LABEL: &str = "label";

/// One run of a family.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Per axis the names of its variables.
    pub axes: Vec<Vec<String>>,
    /// Variables of all axes.
    pub variables: IndexMap<String, String>,
    /// Per axis the number of its point.
    pub point: Vec<usize>,
    /// File in the case's folder.
    pub scene: String,
    /// Overrides `PATH=VALUE`.
    pub set: Vec<String>,
    /// See [`Family::interpolate`].
    pub interpolate: bool,
}

impl Member {
    /// Replaces every `{name}` by the variable's value, whose own variables are replaced in turn.
    pub fn fill(&self, template: &str) -> Result<String, String> {
        fill(template, &self.variables, 0)
    }

    /// The member in one line, such as `nodes = 4, RPIM`: of each axis its variable `label`, or
    /// else its first.
    pub fn label(&self) -> String {
        self.label_without("")
    }

    /// The label without the axis that has the variable `except`.
    pub fn label_without(&self, except: &str) -> String {
        let axes = self.axes.iter().filter(|names| !names.iter().any(|n| n == except));
        let parts: Vec<_> = axes
            .filter_map(|names| {
                let name = names.iter().find(|n| *n == LABEL).or(names.first())?;
                let value = self.variables.get(name)?;
                Some(if name == LABEL { value.clone() } else { format!("{name} = {value}") })
            })
            .collect();
        parts.join(", ")
    }

    /// Whether the member has these values.
    pub fn is(&self, only: &IndexMap<String, Scalar>) -> bool {
        only.iter().all(|(name, value)| self.variables.get(name).is_some_and(|v| *v == value.to_string()))
    }
}

fn fill(template: &str, variables: &IndexMap<String, String>, depth: usize) -> Result<String, String> {
    let mut out = String::new();
    let mut rest = template;
    while let Some(open) = rest.find('{') {
        let (before, after) = rest.split_at(open);
        out.push_str(before);
        // TOML's inline tables use braces too; a variable is a plain name between them
        let close = after
            .find('}')
            .filter(|&c| c > 1 && after[1..c].chars().all(|c| c.is_alphanumeric() || c == '_'));
        let Some(close) = close else {
            out.push('{');
            rest = &after[1..];
            continue;
        };
        let name = &after[1..close];
        let Some(value) = variables.get(name) else {
            return Err(format!(
                "`{template}` has no value for {{{name}}}; the variables here are {}",
                crate::case::list(variables.keys())
            ));
        };
        if depth > 8 {
            return Err(format!("the variable {{{name}}} stands for itself"));
        }
        out.push_str(&fill(value, variables, depth + 1)?);
        rest = &after[close + 1..];
    }
    out.push_str(rest);
    Ok(out)
}

/// All members, the last axis running fastest.
pub fn members(family: &Family) -> Result<Vec<Member>, String> {
    let mut lengths = Vec::new();
    let mut seen: Vec<&String> = Vec::new();
    for (name, axis) in &family.over {
        if let Some(twice) = axis.keys().find(|variable| seen.contains(variable)) {
            return Err(format!("the axis `{name}` has the variable `{twice}`, which another axis has too"));
        }
        seen.extend(axis.keys());
        let mut sizes = axis.values().map(Vec::len);
        let length = sizes.next().unwrap_or(0);
        if length == 0 || sizes.any(|s| s != length) {
            return Err(format!("the axis `{name}` needs lists of equal length, at least one value each"));
        }
        lengths.push(length);
    }
    let total: usize = lengths.iter().product();
    (0..total)
        .map(|index| {
            let mut rest = index;
            let mut point = vec![0; lengths.len()];
            for (p, length) in point.iter_mut().zip(&lengths).rev() {
                *p = rest % length;
                rest /= length;
            }
            let variables = family
                .over
                .values()
                .zip(&point)
                .flat_map(|(axis, &p)| {
                    axis.iter().filter_map(move |(k, v)| Some((k.clone(), v.get(p)?.to_string())))
                })
                .collect();
            let mut member = Member {
                axes: family.over.values().map(|axis| axis.keys().cloned().collect()).collect(),
                variables,
                point,
                scene: String::new(),
                set: Vec::new(),
                interpolate: family.interpolate,
            };
            member.scene = member.fill(&family.scene)?;
            member.set = family.set.iter().map(|s| member.fill(s)).collect::<Result<_, _>>()?;
            Ok(member)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn family(text: &str) -> Family {
        toml::from_str(text).expect("a family")
    }

    #[test]
    fn members_are_the_product_of_the_axes_with_nested_variables() {
        let family = family(
            r#"
            scene = "{file}.toml"
            set = ["a.{size}", "b = { q = 1.03, shape = {nodes} }"]
            over.n = { nodes = [4, 5], elements = [3, 4] }
            over.basis = { file = ["ancf", "rpim"], size = ["elements={elements}", "nodes={nodes}"] }
            "#,
        );
        let all = members(&family).expect("members");
        assert_eq!(all.len(), 4);
        assert_eq!(all[0].set, ["a.elements=3", "b = { q = 1.03, shape = 4 }"]);
        assert_eq!((all[3].scene.as_str(), all[3].set[0].as_str()), ("rpim.toml", "a.nodes=5"));
        assert_eq!(all[3].label(), "nodes = 5, file = rpim");
        assert_eq!(all[3].label_without("elements"), "file = rpim");
    }

    #[test]
    fn unknown_and_circular_variables_and_ragged_axes_are_refused() {
        assert!(members(&family(r#"set = ["{nowhere}"]"#)).is_err_and(|e| e.contains("{nowhere}")));
        assert!(
            members(&family("set = ['{a}']\nover.x = { a = ['{a}'] }")).is_err_and(|e| e.contains("itself"))
        );
        assert!(
            members(&family("over.x = { a = [1] }\nover.y = { a = [1] }"))
                .is_err_and(|e| e.contains("another axis"))
        );
        assert!(
            members(&family("over.x = { a = [1, 2], b = [1] }")).is_err_and(|e| e.contains("equal length"))
        );
    }
}
