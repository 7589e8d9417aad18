//! A source file with switches, and which mutant a compiler's message is about.

use std::ops::Range;

use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use crate::find::{Edit, Mutant};

/// The new text of a file.
pub struct Spliced {
    /// Sources in which all given mutants stand.
    pub text: String,
    /// The code that each mutant brought.
    regions: Vec<Region>,
}

/// A range of the new text, in bytes.
struct Region {
    mutant: usize,
    /// Whether it is the new code alone; otherwise it is the whole switch, with the old code.
    own: bool,
    range: Range<usize>,
}

/// Text put around a range of the old text.
struct Wrap {
    range: Range<usize>,
    /// Pieces before it; those of a mutant are its own.
    before: Vec<(Option<usize>, String)>,
    after: &'static str,
    mutants: Vec<usize>,
}

/// Puts mutants with their numbers into the text that they were found in. `on` is the path of the
/// function that tells whether a number is switched on.
pub fn splice(text: &str, mutants: &[(usize, &Mutant)], on: &str) -> Spliced {
    let mut wraps: Vec<Wrap> = Vec::new();
    for &(number, mutant) in mutants {
        let switch = format!("{on}({number})");
        match &mutant.edit {
            Edit::Expression { range, instead } => {
                let same = |w: &&mut Wrap| w.range == *range && w.after == " })";
                let known = wraps.iter_mut().find(same);
                let start = if known.is_some() { " else if " } else { "(if " };
                let pieces = [
                    (None, format!("{start}{switch} {{ ")),
                    (Some(number), instead.clone()),
                    (None, " }".to_owned()),
                ];
                match known {
                    Some(wrap) => {
                        wrap.before.extend(pieces);
                        wrap.mutants.push(number);
                    }
                    None => wraps.push(Wrap {
                        range: range.clone(),
                        before: pieces.into(),
                        after: " })",
                        mutants: vec![number],
                    }),
                }
            }
            Edit::Body { at, value } => {
                let value = value.as_ref().map_or_else(String::new, |v| format!(" {v}"));
                let piece = format!(" if {switch} {{ return{value}; }}");
                wraps.push(Wrap {
                    range: *at..*at,
                    before: vec![(Some(number), piece)],
                    after: "",
                    mutants: vec![number],
                });
            }
            Edit::Arm { at, guard } => {
                let (range, before, after) = match guard {
                    Some(guard) => (guard.clone(), format!("!{switch} && ("), ")"),
                    None => (*at..*at, format!(" if !{switch}"), ""),
                };
                let before = vec![(Some(number), before)];
                wraps.push(Wrap { range, before, after, mutants: vec![number] });
            }
        }
    }
    for wrap in wraps.iter_mut().filter(|w| w.after == " })") {
        wrap.before.push((None, " else { ".to_owned()));
    }
    // The outermost first; at one place, what is only inserted; around one range, the guard.
    wraps.sort_by_key(|w| (w.range.start, !w.range.is_empty(), usize::MAX - w.range.end, w.after.len()));
    let mut output = Spliced { text: String::new(), regions: Vec::new() };
    let mut rest = wraps.as_slice();
    output.write(text, 0..text.len(), &mut rest);
    output
}

impl Spliced {
    /// The old text of a range with the wraps that lie in it, which are taken from the list.
    fn write(&mut self, old: &str, range: Range<usize>, wraps: &mut &[Wrap]) {
        let mut at = range.start;
        while let Some((wrap, rest)) = wraps.split_first().filter(|(w, _)| w.range.end <= range.end) {
            *wraps = rest;
            self.text.push_str(&old[at..wrap.range.start]);
            let start = self.text.len();
            for (own, piece) in &wrap.before {
                let from = self.text.len();
                self.text.push_str(piece);
                if let Some(mutant) = *own {
                    self.regions.push(Region { mutant, own: true, range: from..self.text.len() });
                }
            }
            self.write(old, wrap.range.clone(), wraps);
            self.text.push_str(wrap.after);
            for &mutant in &wrap.mutants {
                self.regions.push(Region { mutant, own: false, range: start..self.text.len() });
            }
            at = wrap.range.end;
        }
        self.text.push_str(&old[at..range.end]);
    }

    /// Mutants that a message about some bytes of the new text is about: that whose code it is,
    /// otherwise those of the innermost switch around it, otherwise all in the same function.
    pub fn blame(&self, bytes: &Range<usize>) -> Vec<usize> {
        let around = |r: &&Region| r.range.start <= bytes.start && bytes.end <= r.range.end;
        for own in [true, false] {
            let found = self.regions.iter().filter(|r| r.own == own).filter(around);
            let Some(least) = found.clone().map(|r| r.range.len()).min() else { continue };
            return found.filter(|r| r.range.len() == least).map(|r| r.mutant).collect();
        }
        let Ok(parsed) = syn::parse_file(&self.text) else { return Vec::new() };
        let mut functions = Functions { around: bytes.clone(), innermost: None };
        functions.visit_file(&parsed);
        let Some(function) = functions.innermost else { return Vec::new() };
        let inside = |r: &&Region| function.start <= r.range.start && r.range.end <= function.end;
        self.regions.iter().filter(|r| !r.own).filter(inside).map(|r| r.mutant).collect()
    }
}

/// The innermost function around some bytes.
struct Functions {
    around: Range<usize>,
    innermost: Option<Range<usize>>,
}

impl Functions {
    fn look(&mut self, span: Span) {
        let range = span.byte_range();
        if range.start <= self.around.start && self.around.end <= range.end {
            self.innermost = Some(range);
        }
    }
}

impl<'ast> Visit<'ast> for Functions {
    fn visit_item_fn(&mut self, of: &'ast syn::ItemFn) {
        self.look(of.span());
        visit::visit_item_fn(self, of);
    }

    fn visit_impl_item_fn(&mut self, of: &'ast syn::ImplItemFn) {
        self.look(of.span());
        visit::visit_impl_item_fn(self, of);
    }

    fn visit_trait_item_fn(&mut self, of: &'ast syn::TraitItemFn) {
        self.look(of.span());
        visit::visit_trait_item_fn(self, of);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::find::find;

    /// All mutants of a text, put into it.
    fn all(text: &str) -> Spliced {
        let mutants = find("src/a.rs", text).expect("a source");
        let numbered: Vec<(usize, &Mutant)> = mutants.iter().enumerate().collect();
        splice(text, &numbered, "m::on")
    }

    /// The tokens of an expression with the mutant of which `change` is a part of the name.
    fn with(expression: &str, change: &str) -> String {
        let text = format!("fn f() {{ x = {expression}; }}");
        let mutants = find("src/a.rs", &text).expect("a source");
        let (number, mutant) = mutants
            .iter()
            .enumerate()
            .find(|(_, m)| m.change == format!("{change} in f"))
            .expect("such a mutant");
        let new = splice(&text, &[(number, mutant)], "m::on").text;
        let start = new.find(" { ").map_or(0, |brace| new[brace..].find("on(").map_or(0, |on| brace + on));
        let branch = &new[start..];
        let open = branch.find(" { ").map_or(0, |at| at + 3);
        let close = branch.find(" } else").expect("the old code");
        branch[open..close].to_owned()
    }

    /// Would catch an operator that takes other operands than the one that it replaces.
    #[test]
    fn the_new_operator_takes_the_operands_of_the_old() {
        assert_eq!(with("a - b + c", "replace + with *"), "(a - b) * (c)");
        assert_eq!(with("a + b * c", "replace + with *"), "(a) * (b * c)");
        assert_eq!(with("a as usize + b", "replace + with -"), "(a as usize) - (b)");
        assert_eq!(with("-a.abs()", "delete -"), "a.abs()");
        assert_eq!(with("a.b(c).min(d.max(e))", "replace min with max"), "a.b(c).max(d.max(e))");
    }

    /// Would catch switches within switches that break the text: of all sources of the solver, with
    /// all mutants at once.
    #[test]
    fn all_sources_with_all_their_mutants_are_rust() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let files = crate::copy::sources(&root).expect("the sources of the solver");
        assert!(files.len() > 100);
        let mut number = 0;
        for (file, text) in files {
            let mutants = find(&file, &text).expect("a source");
            number += mutants.len();
            let numbered: Vec<(usize, &Mutant)> = mutants.iter().enumerate().collect();
            let new = splice(&text, &numbered, "crate::mutant_switch::on").text;
            assert!(syn::parse_file(&new).is_ok(), "{file}");
            for n in 0..mutants.len() {
                assert_eq!(new.matches(&format!("::on({n})")).count(), 1, "{n} in {file}");
            }
        }
        assert!(number > 5_000, "{number}");
    }

    #[test]
    fn without_mutants_the_text_stays() {
        let text = "fn f() -> f64 { a + 1.0 }\n";
        assert_eq!(splice(text, &[], "m::on").text, text);
    }

    #[test]
    fn several_mutants_of_one_place_share_a_switch() {
        let text = all("fn f() { g(a < b); }").text;
        assert_eq!(
            text,
            "fn f() { if m::on(0) { return; } \
             g((if m::on(1) { (a) <= (b) } else if m::on(2) { (a) > (b) } else { a < b })); }"
        );
    }

    #[test]
    fn arms_are_switched_by_guards() {
        let text = all("fn f() { match a { A => g(), B if c && d => h(), _ => i() } }").text;
        assert_eq!(
            text,
            "fn f() { if m::on(0) { return; } match a { A if !m::on(1) => g(), \
             B if !m::on(2) && ((if m::on(3) { (c) || (d) } else { c && d })) => h(), _ => i() } }"
        );
    }

    /// Would catch a mutant that is blamed for another's error, and left out of the count for it.
    #[test]
    fn messages_are_about_the_mutant_whose_code_it_is() {
        let new = all("fn f() { g(a < b); }\nfn h() { i(c); }\n");
        let at = |part: &str| {
            let start = new.text.find(part).expect("it is there");
            new.blame(&(start..start + part.len()))
        };
        assert_eq!(at("(a) <= (b)"), [1]);
        assert_eq!(at("a < b"), [1, 2]);
        assert_eq!(at("g("), [0, 1, 2]);
        assert_eq!(at("i(c)"), [3]);
    }
}
