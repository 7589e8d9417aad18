//! Values that replace the body of a function, by the type that it returns.

use syn::{GenericArgument, Path, PathArguments, ReturnType, Type};

/// More values than these of one type say little more.
const MOST: usize = 4;

/// Values to return at once, as source text; `None` stands for a return without a value.
pub fn of_return(output: &ReturnType) -> Vec<Option<String>> {
    match output {
        ReturnType::Default => vec![None],
        ReturnType::Type(_, of) => of_type(of).into_iter().map(Some).collect(),
    }
}

/// Values of a type, none where none can be named.
fn of_type(of: &Type) -> Vec<String> {
    let mut values = match of {
        Type::Path(path) => of_path(&path.path),
        Type::Tuple(tuple) if tuple.elems.is_empty() => vec!["()".to_owned()],
        Type::Tuple(tuple) => of_tuple(&tuple.elems.iter().map(of_type).collect::<Vec<_>>()),
        Type::Array(array) => each(&array.elem, |v| format!("std::array::from_fn(|_| {v})")),
        Type::Reference(reference) if reference.mutability.is_none() => match &*reference.elem {
            Type::Path(path) if path.path.is_ident("str") => strings(["\"\"", "\"xyzzy\""]),
            Type::Slice(_) => strings(["&[]"]),
            _ => Vec::new(),
        },
        Type::Paren(inner) => of_type(&inner.elem),
        _ => Vec::new(),
    };
    values.truncate(MOST);
    values
}

fn of_path(path: &Path) -> Vec<String> {
    let Some(last) = path.segments.last() else { return Vec::new() };
    let argument = match &last.arguments {
        PathArguments::AngleBracketed(of) => of.args.iter().find_map(|argument| match argument {
            GenericArgument::Type(of) => Some(of),
            _ => None,
        }),
        _ => None,
    };
    match (last.ident.to_string().as_str(), argument) {
        ("f32" | "f64", _) => strings(["0.0", "1.0", "-1.0"]),
        ("bool", _) => strings(["true", "false"]),
        ("u8" | "u16" | "u32" | "u64" | "u128" | "usize", _) => strings(["0", "1"]),
        ("i8" | "i16" | "i32" | "i64" | "i128" | "isize", _) => strings(["0", "1", "-1"]),
        ("String", _) => strings(["String::new()", "\"xyzzy\".into()"]),
        ("Option", Some(of)) => {
            let some = each(of, |v| format!("Some({v})"));
            ["None".to_owned()].into_iter().chain(some).collect()
        }
        ("Vec", Some(of)) => {
            let one = each(of, |v| format!("vec![{v}]"));
            ["Vec::new()".to_owned()].into_iter().chain(one.into_iter().take(1)).collect()
        }
        ("Result", Some(of)) => each(of, |v| format!("Ok({v})")),
        ("Result", None) => strings(["Ok(())"]),
        ("Box", Some(Type::TraitObject(_))) => Vec::new(),
        ("Box", Some(of)) => each(of, |v| format!("Box::new({v})")),
        _ => strings(["Default::default()"]),
    }
}

fn strings<const N: usize>(values: [&str; N]) -> Vec<String> {
    values.map(str::to_owned).to_vec()
}

fn each(of: &Type, wrap: impl Fn(String) -> String) -> Vec<String> {
    of_type(of).into_iter().map(wrap).collect()
}

/// The first values of all members, then others of one member after the other.
fn of_tuple(members: &[Vec<String>]) -> Vec<String> {
    let Some(first) = members.iter().map(|m| m.first().cloned()).collect::<Option<Vec<String>>>() else {
        return Vec::new();
    };
    let tuple = |values: &[String]| format!("({},)", values.join(", "));
    let mut all = vec![tuple(&first)];
    for (i, member) in members.iter().enumerate() {
        for other in member.iter().skip(1) {
            let mut values = first.clone();
            values[i].clone_from(other);
            all.push(tuple(&values));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(of: &str) -> Vec<String> {
        of_type(&syn::parse_str(of).expect("a type"))
    }

    /// Would catch a type whose bodies are never replaced, or replaced by what cannot be returned.
    #[test]
    fn a_type_has_values_that_can_be_returned() {
        assert_eq!(values("f64"), ["0.0", "1.0", "-1.0"]);
        assert_eq!(values("Result<bool, Error>"), ["Ok(true)", "Ok(false)"]);
        assert_eq!(values("fmt::Result"), ["Ok(())"]);
        assert_eq!(values("Option<usize>"), ["None", "Some(0)", "Some(1)"]);
        assert_eq!(values("Vec<f64>"), ["Vec::new()", "vec![0.0]"]);
        assert_eq!(values("(bool, [f64; 2])")[0], "(true, std::array::from_fn(|_| 0.0),)");
        assert_eq!(values("&[f64]"), ["&[]"]);
        assert_eq!(values("Vector2<f64>"), ["Default::default()"]);
        for none in ["impl Iterator<Item = f64>", "&mut f64", "!", "Box<dyn Effect>"] {
            if let Ok(of) = syn::parse_str::<Type>(none) {
                assert!(of_type(&of).is_empty(), "{none}");
            }
        }
        let nothing: syn::Signature = syn::parse_str("fn f()").expect("a signature");
        assert_eq!(of_return(&nothing.output), [None]);
    }
}
