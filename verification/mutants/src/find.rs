//! The mutants of a source file.
//!
//! | kind | what is put in |
//! |---|---|
//! | body | a function returns at once, with a constant or the default of what it returns |
//! | operator | another binary operator, also of an assignment; a unary minus or `!` is left out |
//! | arm | an arm of a match that has a wildcard is left out |
//! | number | 0 for 1, 1 for 0 and for 2, otherwise one more; so are indices exchanged |
//! | method | `max` for `min`, `cos` for `sin`, `last` for `first` and the like |
//!
//! Left out are: tests, constants, `const fn`, patterns, types and lengths, because no switch can
//! stand there; macros other than those that format text and make vectors; `Debug`, on which
//! nothing relies; the capacity of a collection, which has no effect on its contents.

use std::ops::Range;

use proc_macro2::Span;
use syn::parse::Parser;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, ExprLit, Lit, Token, UnOp};

use crate::Failure;
use crate::values;

/// One small fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mutant {
    /// Path in the repository, with `/`.
    pub file: String,
    /// Line from 1.
    pub line: usize,
    /// Column from 1.
    pub column: usize,
    /// In words: what is replaced with what, in which function.
    pub change: String,
    /// The change itself.
    pub edit: Edit,
}

/// A change of source text. Ranges and places are bytes of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edit {
    /// Another expression.
    Expression {
        /// The old one.
        range: Range<usize>,
        /// The new one.
        instead: String,
    },
    /// A return as the first statement.
    Body {
        /// After the opening brace.
        at: usize,
        /// With what.
        value: Option<String>,
    },
    /// An arm that does not match.
    Arm {
        /// End of the pattern.
        at: usize,
        /// The arm's guard.
        guard: Option<Range<usize>>,
    },
}

impl Mutant {
    /// File, place and change.
    pub fn name(&self) -> String {
        format!("{}:{}:{}: {}", self.file, self.line, self.column, self.change)
    }

    /// The part of `src` that it belongs to: `src/linear` of `src/linear/band.rs`, and of
    /// `src/linear.rs`.
    pub fn folder(&self) -> String {
        folder_of(&self.file)
    }
}

/// [`Mutant::folder`] of its file or its name.
pub fn folder_of(name: &str) -> String {
    let file = name.split(':').next().unwrap_or(name);
    let folder = file.split('/').take(2).collect::<Vec<_>>().join("/");
    folder.strip_suffix(".rs").unwrap_or(&folder).to_owned()
}

/// All mutants of a file, in the order of the source.
pub fn find(file: &str, text: &str) -> Result<Vec<Mutant>, Failure> {
    let parsed = syn::parse_file(text).map_err(|e| format!("{file}: {e}"))?;
    let mut finder = Finder { file, text, owner: None, function: Vec::new(), mutants: Vec::new() };
    finder.visit_file(&parsed);
    finder.mutants.sort_by_key(|m| (m.line, m.column));
    Ok(finder.mutants)
}

struct Finder<'a> {
    file: &'a str,
    text: &'a str,
    /// The type whose `impl`, or the trait, that this is in.
    owner: Option<String>,
    /// Functions from the outermost in.
    function: Vec<String>,
    mutants: Vec<Mutant>,
}

impl Finder<'_> {
    fn source(&self, span: Span) -> &str {
        &self.text[span.byte_range()]
    }

    fn add(&mut self, span: Span, change: &str, edit: Edit) {
        let start = span.start();
        let place = self.function.join("::");
        // One line, as a name should be.
        let change = change.split_whitespace().collect::<Vec<_>>().join(" ");
        let change = if place.is_empty() { change } else { format!("{change} in {place}") };
        self.mutants.push(Mutant {
            file: self.file.to_owned(),
            line: start.line,
            column: start.column + 1,
            change,
            edit,
        });
    }

    fn expression(&mut self, of: Span, at: Span, change: &str, instead: String) {
        self.add(at, change, Edit::Expression { range: of.byte_range(), instead });
    }

    /// A function's body, and what is in it.
    fn body(&mut self, attributes: &[syn::Attribute], signature: &syn::Signature, block: &syn::Block) {
        if is_test(attributes) || signature.constness.is_some() || signature.unsafety.is_some() {
            return;
        }
        let own = signature.ident.to_string();
        let name = match (&self.owner, self.function.is_empty()) {
            (Some(owner), true) => format!("{owner}::{own}"),
            _ => own.clone(),
        };
        // `default` must not be replaced by a call of itself.
        let itself = own == "default" && signature.inputs.is_empty();
        if !itself && self.file != "src/main.rs" {
            let open = block.brace_token.span.open();
            let inside = open.byte_range().end..block.brace_token.span.close().byte_range().start;
            let old: String = self.text[inside].split_whitespace().collect();
            for value in values::of_return(&signature.output) {
                let new: String = value.iter().flat_map(|v| v.split_whitespace()).collect();
                if old == new {
                    continue;
                }
                let change = match &value {
                    Some(value) => format!("replace the body with {value}"),
                    None => "leave the body out".to_owned(),
                };
                self.function.push(name.clone());
                self.add(signature.ident.span(), &change, Edit::Body { at: open.byte_range().end, value });
                self.function.pop();
            }
        }
        self.function.push(name);
        let owner = self.owner.take();
        visit::visit_block(self, block);
        self.owner = owner;
        self.function.pop();
    }

    fn number(&mut self, literal: &Lit) {
        let (value, suffix) = match literal {
            Lit::Float(number) => {
                let Ok(x) = number.base10_parse::<f64>() else { return };
                let other = if x == 1.0 || x == 2.0 { x - 1.0 } else { x + 1.0 };
                (format!("{other:?}"), number.suffix().to_owned())
            }
            Lit::Int(number) => {
                let Ok(n) = number.base10_parse::<u64>() else { return };
                // A whole number with the suffix of a float is a float.
                let other = if n == 1 || n == 2 { n - 1 } else { n.saturating_add(1) };
                (other.to_string(), number.suffix().to_owned())
            }
            _ => return,
        };
        let span = literal.span();
        let change = format!("replace {} with {value}", self.source(span));
        self.expression(span, span, &change, format!("{value}{suffix}"));
    }

    /// Arguments of a macro that takes expressions. Others are left as they are.
    fn arguments(&mut self, tokens: &proc_macro2::TokenStream) {
        let list = Punctuated::<Expr, Token![,]>::parse_terminated;
        if let Ok(arguments) = list.parse2(tokens.clone()) {
            arguments.iter().for_each(|argument| self.visit_expr(argument));
        } else if let Ok(repeat) = syn::parse2::<Repeat>(tokens.clone()) {
            self.visit_expr(&repeat.value);
            self.visit_expr(&repeat.count);
        }
    }
}

/// `value; count`, of a vector.
struct Repeat {
    value: Expr,
    count: Expr,
}

impl syn::parse::Parse for Repeat {
    fn parse(input: syn::parse::ParseStream<'_>) -> syn::Result<Self> {
        let value = input.parse()?;
        input.parse::<Token![;]>()?;
        Ok(Self { value, count: input.parse()? })
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes = match item {
            syn::Item::Mod(of) => &of.attrs,
            syn::Item::Impl(of) => &of.attrs,
            syn::Item::Use(_)
            | syn::Item::Const(_)
            | syn::Item::Static(_)
            | syn::Item::Enum(_)
            | syn::Item::Struct(_)
            | syn::Item::Type(_)
            | syn::Item::Macro(_) => return,
            _ => return visit::visit_item(self, item),
        };
        if !is_test(attributes) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_impl(&mut self, of: &'ast syn::ItemImpl) {
        let debug = of.trait_.as_ref().and_then(|(_, path, _)| path.segments.last());
        if debug.is_some_and(|last| last.ident == "Debug") {
            return;
        }
        let own = self.source(of.self_ty.span()).to_owned();
        let outer = self.owner.replace(own);
        visit::visit_item_impl(self, of);
        self.owner = outer;
    }

    fn visit_item_trait(&mut self, of: &'ast syn::ItemTrait) {
        let outer = self.owner.replace(of.ident.to_string());
        visit::visit_item_trait(self, of);
        self.owner = outer;
    }

    fn visit_item_fn(&mut self, of: &'ast syn::ItemFn) {
        self.body(&of.attrs, &of.sig, &of.block);
    }

    fn visit_impl_item_fn(&mut self, of: &'ast syn::ImplItemFn) {
        self.body(&of.attrs, &of.sig, &of.block);
    }

    fn visit_trait_item_fn(&mut self, of: &'ast syn::TraitItemFn) {
        if let Some(block) = &of.default {
            self.body(&of.attrs, &of.sig, block);
        }
    }

    fn visit_expr_binary(&mut self, of: &'ast syn::ExprBinary) {
        if of.attrs.is_empty() && !contains_let(&of.left) && !contains_let(&of.right) {
            let [left, right] = [&of.left, &of.right].map(|e| self.source(e.span()).to_owned());
            for other in others(&of.op) {
                let change = format!("replace {} with {other}", self.source(of.op.span()));
                let instead = format!("({left}) {other} ({right})");
                self.expression(of.span(), of.op.span(), &change, instead);
            }
        }
        visit::visit_expr_binary(self, of);
    }

    fn visit_expr_unary(&mut self, of: &'ast syn::ExprUnary) {
        let sign = match of.op {
            UnOp::Neg(_) => Some("-"),
            UnOp::Not(_) => Some("!"),
            _ => None,
        };
        if let Some(sign) = sign.filter(|_| of.attrs.is_empty()) {
            let instead = self.source(of.expr.span()).to_owned();
            self.expression(of.span(), of.span(), &format!("delete {sign}"), instead);
        }
        visit::visit_expr_unary(self, of);
    }

    fn visit_expr_lit(&mut self, of: &'ast ExprLit) {
        if of.attrs.is_empty() {
            self.number(&of.lit);
        }
    }

    fn visit_expr_method_call(&mut self, of: &'ast syn::ExprMethodCall) {
        let other = exchanged(&of.method.to_string()).filter(|_| of.attrs.is_empty());
        if let Some(other) = other {
            let (whole, name) = (of.span().byte_range(), of.method.span().byte_range());
            let [before, after] =
                [whole.start..name.start, name.end..whole.end].map(|r| self.text[r].to_owned());
            let change = format!("replace {} with {other}", of.method);
            self.expression(of.span(), of.method.span(), &change, format!("{before}{other}{after}"));
        }
        self.visit_expr(&of.receiver);
        if !gives_room(&of.method) {
            of.args.iter().for_each(|argument| self.visit_expr(argument));
        }
    }

    fn visit_expr_call(&mut self, of: &'ast syn::ExprCall) {
        let name = match &*of.func {
            Expr::Path(path) => path.path.segments.last().map(|segment| &segment.ident),
            _ => None,
        };
        if !name.is_some_and(gives_room) {
            visit::visit_expr_call(self, of);
        }
    }

    fn visit_expr_path(&mut self, of: &'ast syn::ExprPath) {
        let Some(last) = of.path.segments.last().filter(|_| of.path.segments.len() == 2) else { return };
        if let Some(other) = exchanged(&last.ident.to_string()).filter(|_| of.attrs.is_empty()) {
            let owner = self.source(of.path.segments[0].span()).to_owned();
            let change = format!("replace {} with {other}", self.source(of.span()));
            self.expression(of.span(), of.span(), &change, format!("{owner}::{other}"));
        }
    }

    fn visit_expr_match(&mut self, of: &'ast syn::ExprMatch) {
        let wild = of.arms.iter().any(|arm| matches!(arm.pat, syn::Pat::Wild(_)) && arm.guard.is_none());
        for arm in &of.arms {
            let guard = arm.guard.as_ref().map(|(_, guard)| guard);
            let chained = guard.is_some_and(|guard| contains_let(guard));
            if !wild || chained || !arm.attrs.is_empty() || matches!(arm.pat, syn::Pat::Wild(_)) {
                continue;
            }
            let change = format!("delete the arm {}", self.source(arm.pat.span()));
            let at = arm.pat.span().byte_range().end;
            let guard = guard.map(|guard| guard.span().byte_range());
            self.add(arm.pat.span(), &change, Edit::Arm { at, guard });
        }
        visit::visit_expr_match(self, of);
    }

    fn visit_macro(&mut self, of: &'ast syn::Macro) {
        let takes = ["format", "write", "writeln", "vec", "print", "println", "eprint", "eprintln"];
        if of.path.get_ident().is_some_and(|name| takes.iter().any(|take| name == take)) {
            self.arguments(&of.tokens);
        }
    }

    fn visit_expr_repeat(&mut self, of: &'ast syn::ExprRepeat) {
        // The length is a constant.
        self.visit_expr(&of.expr);
    }

    fn visit_local(&mut self, of: &'ast syn::Local) {
        if !is_test(&of.attrs) {
            visit::visit_local(self, of);
        }
    }

    // No switch can stand in these.
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_path(&mut self, _: &'ast syn::Path) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
    fn visit_generics(&mut self, _: &'ast syn::Generics) {}
    fn visit_angle_bracketed_generic_arguments(&mut self, _: &'ast syn::AngleBracketedGenericArguments) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
}

/// `#[test]`, `#[cfg(test)]`, and any other condition, under which the text may not be compiled.
fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| attribute.path().is_ident("test") || attribute.path().is_ident("cfg"))
}

/// Whether a chain of conditions holds `let`, which no parentheses may enclose.
fn contains_let(expression: &Expr) -> bool {
    match expression {
        Expr::Let(_) => true,
        Expr::Binary(binary) => contains_let(&binary.left) || contains_let(&binary.right),
        _ => false,
    }
}

/// Operators put in for another.
fn others(operator: &BinOp) -> &'static [&'static str] {
    match operator {
        BinOp::Add(_) => &["-", "*"],
        BinOp::Sub(_) => &["+", "/"],
        BinOp::Mul(_) => &["+", "/"],
        BinOp::Div(_) => &["*", "%"],
        BinOp::Rem(_) => &["/", "+"],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        BinOp::BitXor(_) | BinOp::BitOr(_) => &["&"],
        BinOp::BitAnd(_) => &["|"],
        BinOp::Shl(_) => &[">>"],
        BinOp::Shr(_) => &["<<"],
        BinOp::Eq(_) => &["!="],
        BinOp::Ne(_) => &["=="],
        BinOp::Lt(_) => &["<=", ">"],
        BinOp::Le(_) => &["<", ">"],
        BinOp::Gt(_) => &[">=", "<"],
        BinOp::Ge(_) => &[">", "<"],
        BinOp::AddAssign(_) => &["-=", "*="],
        BinOp::SubAssign(_) => &["+=", "/="],
        BinOp::MulAssign(_) => &["+=", "/="],
        BinOp::DivAssign(_) => &["*=", "%="],
        BinOp::BitXorAssign(_) | BinOp::BitOrAssign(_) => &["&="],
        BinOp::BitAndAssign(_) => &["|="],
        _ => &[],
    }
}

/// Whether a function only reserves room in a collection.
fn gives_room(name: &syn::Ident) -> bool {
    ["with_capacity", "reserve", "reserve_exact"].iter().any(|other| name == other)
}

/// The method put in for another.
fn exchanged(method: &str) -> Option<&'static str> {
    const PAIRS: [[&str; 2]; 11] = [
        ["min", "max"],
        ["sin", "cos"],
        ["first", "last"],
        ["first_mut", "last_mut"],
        ["floor", "ceil"],
        ["any", "all"],
        ["take", "skip"],
        ["is_some", "is_none"],
        ["is_ok", "is_err"],
        ["min_by", "max_by"],
        ["take_while", "skip_while"],
    ];
    PAIRS.iter().find_map(|&[one, other]| match method {
        m if m == one => Some(other),
        m if m == other => Some(one),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changes(text: &str) -> Vec<String> {
        find("src/a.rs", text).expect("a source").into_iter().map(|m| m.change).collect()
    }

    /// Would catch a kind of fault that is no longer put in.
    #[test]
    fn a_small_source_has_these_mutants() {
        let text =
            "fn f(a: f64, v: &[f64]) -> f64 {\n    if a < v[0] { a.min(2.0) - 3.0 * a } else { -a }\n}\n";
        assert_eq!(
            changes(text),
            [
                "replace the body with 0.0 in f",
                "replace the body with 1.0 in f",
                "replace the body with -1.0 in f",
                "replace < with <= in f",
                "replace < with > in f",
                "replace 0 with 1 in f",
                "replace min with max in f",
                "replace 2.0 with 1.0 in f",
                "replace - with + in f",
                "replace - with / in f",
                "replace 3.0 with 4.0 in f",
                "replace * with + in f",
                "replace * with / in f",
                "delete - in f",
            ]
        );
        let mutants = find("src/a.rs", text).expect("a source");
        assert_eq!(mutants[3].name(), "src/a.rs:2:10: replace < with <= in f");
    }

    /// Would catch switches where the compiler wants a constant or a pattern, and faults in code
    /// that is not part of the product.
    #[test]
    fn no_mutants_where_no_switch_can_stand() {
        for text in [
            "const A: f64 = 1.0 + 2.0;",
            "static A: [f64; 1 + 1] = [0.0; 1 + 1];",
            "const fn f() -> f64 { 1.0 + 2.0 }",
            "#[cfg(test)] mod tests { fn f() -> f64 { 1.0 } }",
            "#[test] fn f() { assert!(1 + 1 == 2); }",
            "enum E { A = 1 + 1 }",
            "impl fmt::Debug for A { fn fmt(&self) -> bool { true } }",
            "struct A { a: [f64; 3] }",
            "impl A { const B: usize = 2; }",
        ] {
            assert_eq!(changes(text), Vec::<String>::new(), "{text}");
        }
        let inside = |body: &str| {
            let all = changes(&format!("fn f() {{ {body} }}"));
            all.into_iter().filter(|c| !c.starts_with("leave")).collect::<Vec<_>>()
        };
        assert_eq!(inside("let a: [f64; 3] = [x; 3];"), Vec::<String>::new());
        assert_eq!(inside("g::<3>(x);"), Vec::<String>::new());
        assert_eq!(inside("let a = Vec::with_capacity(2 * n); a.reserve(n + 1);"), Vec::<String>::new());
        assert_eq!(inside("if let Some(1) = x { g() }"), Vec::<String>::new());
        // No parentheses around `let`, but around what stands beside it.
        assert_eq!(inside("if a == b && let Some(c) = d { g() }"), ["replace == with != in f"]);
    }

    #[test]
    fn names_tell_type_and_function() {
        let text = "impl<'a> Band<'a> { fn row(&self) { let f = |x| x + y; } }\n\
                    trait T { fn g(&self) -> bool { true } }";
        assert_eq!(
            changes(text),
            [
                "leave the body out in Band<'a>::row",
                "replace + with - in Band<'a>::row",
                "replace + with * in Band<'a>::row",
                // A body that is the value already is no mutant.
                "replace the body with false in T::g",
            ]
        );
    }

    #[test]
    fn arms_are_deleted_beside_a_wildcard_only() {
        let arms = |text: &str| {
            let all = changes(&format!("fn f() {{ {text} }}"));
            all.into_iter().filter(|c| c.contains("arm")).collect::<Vec<_>>()
        };
        assert_eq!(
            arms("match a { A => g(), B if c => g(), _ => h() }"),
            ["delete the arm A in f", "delete the arm B in f"]
        );
        assert_eq!(arms("match a { A => g(), B => h() }"), Vec::<String>::new());
    }

    #[test]
    fn macros_that_format_are_looked_into() {
        assert_eq!(
            changes("fn f() { write!(g, \"{a} {}\", b / 2.0, c = 1); vec![d; 1]; matches!(e, 1 | 2); }")[1..],
            [
                "replace / with * in f",
                "replace / with % in f",
                "replace 2.0 with 1.0 in f",
                "replace 1 with 0 in f",
                "replace 1 with 0 in f",
            ]
        );
    }

    #[test]
    fn a_file_and_the_folder_of_its_name_are_one() {
        let mutant = |file: &str| find(file, "fn f() { g() }").expect("a source").remove(0);
        for (file, folder) in [
            ("src/linear/band.rs", "src/linear"),
            ("src/solve/eigen/mod.rs", "src/solve"),
            ("src/model.rs", "src/model"),
        ] {
            assert_eq!(mutant(file).folder(), folder);
        }
    }
}
